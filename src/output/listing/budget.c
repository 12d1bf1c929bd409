/*
 * The budget of the errors: each with the stages that determine it, its cost,
 * the saving by stopping early.
 */
#include "base/timer.h"
#include "effects/rows.h"
#include "output/listing/parts.h"

#include <math.h>
#include <string.h>

static const stage mesh_stages[] = {
    STAGE_MESH,     STAGE_SURFACE, STAGE_COUPLING, STAGE_ASSEMBLY,
    STAGE_ORDERING, STAGE_FACTOR,  STAGE_CONDENSE};

static const stage time_stages[] = {
    STAGE_LOAD,   STAGE_LIMIT,  STAGE_NONLOCAL,  STAGE_VELOCITY, STAGE_RECOVERY,
    STAGE_STRESS, STAGE_ENERGY, STAGE_INELASTIC, STAGE_THERMAL};

static const stage solver_stages[] = {STAGE_CONTACT};

static double cpu_of(const stage *list, size_t n) {
  double cpu = 0;
  for (size_t i = 0; i < n; ++i) cpu += timer_cost(list[i]).cpu;
  return cpu;
}

#define STAGES(list) list, sizeof list / sizeof *list

/* NAN, an increment without estimate, stays. */
static double worse(double a, double b) { return isnan(a) || a >= b ? a : b; }

typedef error_share share_of(const increment_summary *i);

static error_share mesh_share(const increment_summary *i) {
  return i->mesh_error;
}

static error_share time_share(const increment_summary *i) {
  return i->time_error;
}

static error_share true_share(const increment_summary *i) {
  int asked = i->exact.asked && !isnan(i->exact.energy);
  return (error_share){asked, i->exact.energy, i->exact.cpu, NULL};
}

static error_share solver_share(const increment_summary *i) {
  const error_bound *e = &i->error;
  return (error_share){e->asked, e->relative, e->cpu, e->why};
}

int job_path_counts(const model *m) {
  const unsigned path = EFFECT_HISTORY | EFFECT_INELASTIC;
  int sums = 0;
  for (int k = 0; effect_table[k] != NULL; ++k)
    sums |=
        effect_table[k]->sums_up != NULL && effect_is_on(effect_table[k], m);
  return sums || (m->effects & path) != 0;
}

/* Last and largest of the increments that were asked; 0 if none was. */
static int collect(const run_summary *run, share_of *of, budget_row *row) {
  int n = 0;
  for (int k = 0; k < run->n_increment; ++k) {
    error_share e = of(&run->increments[k]);
    if (!e.asked) continue;
    row->last = 100 * e.relative;
    row->worst = n++ == 0 ? row->last : worse(row->worst, row->last);
    row->estimated = e.cpu;
  }
  return n > 0;
}

/* clang-format off */
static const struct {
  const char *name, *json;
  share_of *of;
  const stage *stages;
  size_t n_stage;
} budget_table[BUDGET_ROWS] = {
  {"mesh",   "mesh",   mesh_share,   STAGES(mesh_stages)},
  {"steps",  "time",   time_share,   STAGES(time_stages)},
  {"solver", "solver", solver_share, STAGES(solver_stages)},
  {"true, by *REFERENCE", "true", true_share, NULL, 0}};
/* clang-format on */

/* 1: the steps make no error, whoever asked. */
static int is_zero(const job *j, share_of *const *of) {
  return *of == time_share && j->run->n_increment > 0 && !j->m->problem.given &&
         !job_path_counts(j->m);
}

int job_budget(const job *j, budget_row rows[BUDGET_ROWS]) {
  int n = 0;
  for (int k = 0; k < BUDGET_ROWS; ++k) {
    rows[n] = (budget_row){
        .name = budget_table[k].name,
        .json = budget_table[k].json,
        .reached = cpu_of(budget_table[k].stages, budget_table[k].n_stage)};
    n += collect(j->run, budget_table[k].of, &rows[n]) ||
         is_zero(j, &budget_table[k].of);
    if (n == BUDGET_ROWS) break;
  }
  return n;
}

double job_effectivity(const job *j) {
  budget_row rows[BUDGET_ROWS];
  int n = job_budget(j, rows);
  double sum = 0;
  if (n < 2 || strcmp(rows[0].json, "mesh") != 0 ||
      strcmp(rows[n - 1].json, "true") != 0)
    return NAN;
  for (int i = 0; i < n - 1; ++i) sum += rows[i].last;
  return rows[n - 1].last > 0 ? sum / rows[n - 1].last : NAN;
}

balance_sum job_balance(const job *j) {
  balance_sum sum = {0};
  for (int i = 0; i < j->run->n_increment; ++i) {
    const increment_summary *s = &j->run->increments[i];
    if (!s->balance.asked) continue;
    sum.asked = 1;
    sum.iterations += s->iterations;
    sum.saved_iterations += s->balance.saved_iterations;
    sum.saved_cpu += s->balance.saved_cpu;
  }
  return sum;
}

double job_increments_of_deck(const job *j, int *made) {
  double sum = 0;
  *made = 0;
  for (int i = 0; i < j->m->n.step; ++i) {
    const step *s = &j->m->steps[i];
    if (s->accuracy.time_balanced) sum += ceil(s->total / s->dt - 1e-9);
  }
  for (int i = 0; i < j->run->n_increment; ++i)
    *made +=
        j->m->steps[j->run->increments[i].step_no - 1].accuracy.time_balanced;
  return sum;
}

static void print_saved(const job *j, FILE *f) {
  balance_sum sum = job_balance(j);
  int made;
  double of_deck = job_increments_of_deck(j, &made);
  if (of_deck > 0)
    fprintf(f,
            "  increments balanced with the error of the mesh: %d in the "
            "place of %.0f of the deck\n",
            made, of_deck);
  if (!sum.asked) return;
  fprintf(f,
          "  stopping balanced with the other errors saved about %.0f of "
          "%.0f iterations",
          sum.saved_iterations, sum.iterations + sum.saved_iterations);
  if (!j->o->no_timing) fprintf(f, ", %.3f s of CPU", sum.saved_cpu);
  fputs(" (to residual 1E-10)\n", f);
}

void listing_budget(const job *j, FILE *f) {
  char last[NUMBER_SIZE], worst[NUMBER_SIZE];
  budget_row rows[BUDGET_ROWS];
  int n = job_budget(j, rows), cost = !j->o->no_timing;
  if (n == 0) return;
  fprintf(f, "\n  %-26s %12s %12s", "error in the energy norm", "last[%]",
          "largest[%]");
  fprintf(f, cost ? " %13s %15s\n" : "\n", "work cpu[s]", "estimate cpu[s]");
  for (int i = 0; i < n; ++i) {
    fprintf(f, "  %-26s %12s %12s", rows[i].name,
            text_number(last, rows[i].last, 2),
            text_number(worst, rows[i].worst, 2));
    if (cost && rows[i].reached > 0)
      fprintf(f, " %13.3f", rows[i].reached);
    else if (cost)
      fprintf(f, " %13s", "");
    if (cost) fprintf(f, " %15.3f", rows[i].estimated);
    fputc('\n', f);
  }
  double effectivity = job_effectivity(j);
  if (!isnan(effectivity))
    fprintf(f, "  estimated over true error: %.2f\n", effectivity);
  print_saved(j, f);
}
