/*
 * The budget of the errors: each with the stages that determine it, its cost,
 * the saving by stopping early; the goals; the passes towards the targets of
 * *ACCURACY and *GOAL; which error to improve next, and its price.
 */
#include "output/listing/job.h"

#include "effects/rows.h"

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

double job_worse(double a, double b) { return isnan(a) || a >= b ? a : b; }

typedef error_share share_of(const increment_summary *i);

static error_share mesh_share(const increment_summary *i) {
  return i->mesh_error;
}

static error_share time_share(const increment_summary *i) {
  return i->time_error;
}

static error_share true_share(const increment_summary *i) {
  int asked = i->exact.asked && !isnan(i->exact.energy);
  return (error_share){
      .asked = asked, .relative = i->exact.energy, .cpu = i->exact.cpu};
}

static error_share solver_share(const increment_summary *i) {
  const error_bound *e = &i->error;
  return (error_share){
      .asked = e->asked, .relative = e->relative, .cpu = e->cpu, .why = e->why};
}

/* 1: the error of the steps may be other than zero. */
static int path_counts(const model *m) {
  const unsigned path = EFFECT_HISTORY | EFFECT_INELASTIC;
  int sums = 0;
  for (int k = 0; effect_table[k] != NULL; ++k)
    sums |= effect_table[k]->sums_up && effect_is_on(effect_table[k], m);
  return sums || (m->effects & path) != 0;
}

/* Last and largest of the increments that were asked; 0 if none was. */
static int collect(const run_summary *run, share_of *of, budget_row *row) {
  int n = 0;
  for (int k = 0; k < run->n_increment; ++k) {
    error_share e = of(&run->increments[k]);
    if (!e.asked) continue;
    row->last = 100 * e.relative;
    row->worst = n++ == 0 ? row->last : job_worse(row->worst, row->last);
    row->estimated = e.cpu;
  }
  return n > 0;
}

static const struct {
  const char *name, *json;
  share_of *of;
  const stage *stages;
  size_t n_stage;
} budget_table[BUDGET_ROWS] = {
    {"mesh", "mesh", mesh_share, STAGES(mesh_stages)},
    {"steps", "time", time_share, STAGES(time_stages)},
    {"solver", "solver", solver_share, STAGES(solver_stages)},
    {"true, by *REFERENCE", "true", true_share, NULL, 0}};

int job_budget(const job *j, budget_row rows[BUDGET_ROWS]) {
  const int steps_are_exact =
      j->run->n_increment > 0 && !j->m->problem.given && !path_counts(j->m);
  int n = 0;
  for (int k = 0; k < BUDGET_ROWS; ++k) {
    rows[n] = (budget_row){
        .name = budget_table[k].name,
        .json = budget_table[k].json,
        .reached = cpu_of(budget_table[k].stages, budget_table[k].n_stage)};
    n += collect(j->run, budget_table[k].of, &rows[n]) ||
         (budget_table[k].of == time_share && steps_are_exact);
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
  for (EACH(const increment_summary, s, j->run->increments,
            j->run->n_increment)) {
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
  for (EACH(const step, s, j->m->steps, j->m->n.step))
    if (s->accuracy.time_balanced) sum += ceil(s->total / s->dt - 1e-9);
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
          "%.0f iteration%s",
          sum.saved_iterations, sum.iterations + sum.saved_iterations,
          sum.iterations + sum.saved_iterations == 1 ? "" : "s");
  if (!j->o->no_timing) fprintf(f, ", %.3f s of CPU", sum.saved_cpu);
  fputs(" (to residual 1E-10)\n", f);
}

static void print_budget(const job *j, FILE *f) {
  budget_row rows[BUDGET_ROWS];
  int n = job_budget(j, rows), cost = !j->o->no_timing;
  budget_row none;
  const int not_asked = j->run->n_increment > 0 && path_counts(j->m) &&
                        !(j->m->effects & EFFECT_TIME_ERROR) &&
                        !collect(j->run, time_share, &none);
  if (n == 0 && !not_asked) return;
  fprintf(f, "\n  %-26s %12s %12s", "error in the energy norm", "last[%]",
          "largest[%]");
  fprintf(f, cost ? " %13s %15s\n" : "\n", "work cpu[s]", "estimate cpu[s]");
  for (int i = 0; i < n; ++i) {
    fprintf(f, "  %-26s %12s %12s", rows[i].name, text_number(rows[i].last, 2),
            text_number(rows[i].worst, 2));
    if (cost && rows[i].reached > 0)
      fprintf(f, " %13.3f", rows[i].reached);
    else if (cost)
      fprintf(f, " %13s", "");
    if (cost) fprintf(f, " %15.3f", rows[i].estimated);
    fputc('\n', f);
  }
  if (not_asked)
    fprintf(f, "  %-26s unknown without *ACCURACY, TIME=YES\n", "steps");
  double effectivity = job_effectivity(j);
  if (!isnan(effectivity))
    fprintf(f, "  estimated over true error: %.2f\n", effectivity);
  print_saved(j, f);
}

/* Elements of half the length have half the error where no edge is singular;
 * their unknowns are 2^dim times as many, and the CPU seconds grow like a power
 * of them, 1.2 in the plane and 1.75 in space (target.c), at most: meshing and
 * output grow less. Increments of half the length: half the error or less. */
static const double GROWTH_2D = 1.2, GROWTH_3D = 1.75; /* -, of the CPU */
static const double EXACT = 1e-3; /* -, of the others: far more than needed */
static const double WORTH = 0.05; /* -, of the CPU */
static const double NONE = 1e-10; /* %, error that is rounding */

/* The row of that name: its last error, %, NAN: none or unknown. */
static double last_of(const budget_row *rows, int n, const char *name) {
  for (int i = 0; i < n; ++i)
    if (strcmp(rows[i].name, name) == 0) return rows[i].last;
  return NAN;
}

static int is_balanced(const model *m) {
  int any = 0;
  for (int i = 0; i < m->n.step; ++i) any |= m->steps[i].balanced;
  return any;
}

/* What the solver does in vain. */
static void add_solver(const job *j, double others, double solver, char *text,
                       size_t size) {
  if (!(solver >= 0.0 && solver < EXACT * others) || is_balanced(j->m)) return;
  if (solver > 0.0)
    text_add(text, size, "; the solver is %.0e times more exact",
             others / solver);
  else
    text_add(text, size, "; the solver is exact");
  if (j->o->no_timing || j->m->n.contact == 0) return;
  double share = timer_cost(STAGE_CONTACT).cpu / timer_cpu();
  if (share >= WORTH)
    text_add(text, size, ", TOL=BALANCED saves up to %.0f %% of the CPU",
             ceil(100 * share));
}

/* The last estimate of the mesh says that it sees nothing. */
static int mesh_is_unseen(const job *j) {
  int k = j->run->n_increment;
  while (k > 0 && !j->run->increments[k - 1].mesh_error.asked) --k;
  return k > 0 && error_is_unseen(&j->run->increments[k - 1].mesh_error);
}

void job_advice(const job *j, char *text, size_t size) {
  budget_row rows[BUDGET_ROWS];
  const int n = job_budget(j, rows);
  const double in_mesh = last_of(rows, n, "mesh");
  const double in_steps = last_of(rows, n, "steps");
  text[0] = '\0';
  if (j->run->n_increment == 0 || isnan(in_mesh)) return;
  if (mesh_is_unseen(j))
    text_add(text, size,
             "the mesh: the estimate of its error sees nothing, half the "
             "length of the elements may");
  else if (isgreater(in_steps, fmax(in_mesh, NONE)))
    text_add(text, size,
             "the increments: half their length gives %.2g %% or less of %.2g "
             "%% for 2 times the CPU",
             0.5 * in_steps, in_steps);
  else if (in_mesh > NONE)
    text_add(text, size,
             "the mesh: half the length of the elements gives about %.2g %% "
             "for up to %.0f times the CPU",
             0.5 * in_mesh,
             j->m->dim < 3 ? pow(4.0, GROWTH_2D) : pow(8.0, GROWTH_3D));
  else
    return;
  add_solver(j, fmax(in_mesh, in_steps), last_of(rows, n, "solver"), text,
             size);
  if (isnan(in_steps) && path_counts(j->m))
    text_add(text, size, "; the error of the steps is unknown");
}

static void print_advice(const job *j, FILE *f) {
  char advice[ADVICE_SIZE], *at = advice, *end;
  job_advice(j, advice, sizeof advice);
  if (advice[0] == '\0') return;
  fputs("  improve next: ", f);
  for (; (end = strstr(at, "; ")) != NULL; at = end + 2)
    fprintf(f, "%.*s;\n    ", (int)(end - at), at);
  fprintf(f, "%s\n", at);
}

const goal_result *job_goal(const job *j, int id) {
  const run_summary *run = j->run;
  if (run->n_increment == 0 || run->goals == NULL) return NULL;
  const int last = run->increments[run->n_increment - 1].step_no - 1;
  return &run->goals[last * j->m->n.goal + id];
}

static void print_goal(const job *j, int id, const goal_result *g, int cost,
                       FILE *f) {
  fprintf(f, "  %-16s %14s", j->m->accuracy.goals[id].name,
          text_number(g->value, 6));
  if (!isnan(g->error))
    fprintf(f, " %12s %14s %10s %10s %6.2g", text_number(g->error, 3),
            text_number(g->value + g->error, 6), text_number(g->band, 1),
            text_number(g->solver, 1), 100 * g->ends);
  else
    fprintf(f, " %12s %14s %10s %10s %6s", "-", "-", "-", "-", "-");
  if (cost) fprintf(f, " %9.3f", g->cpu);
  fprintf(f, "  %s; %s\n", model_goal_unit(j->m, id),
          goal_verdict_text(g->verdict));
}

static void print_heading(int cost, FILE *f) {
  fprintf(f, "  %-16s %14s %12s %14s %10s %10s %6s", "goal", "value", "error",
          "corrected", "band", "solver", "ends%");
  if (cost) fprintf(f, " %9s", "cpu[s]");
  fputs("  unit; verdict\n", f);
}

void listing_goals_now(const job *j, const state *s, FILE *f) {
  if (s->errors.goals == NULL) return;
  print_heading(0, f);
  for (int i = 0; i < s->errors.n_goal; ++i)
    print_goal(j, i, &s->errors.goals[i], 0, f);
}

static void print_goals(const job *j, FILE *f) {
  const int cost = !j->o->no_timing;
  if (j->m->n.goal == 0 || job_goal(j, 0) == NULL) return;
  fputc('\n', f);
  print_heading(cost, f);
  for (int i = 0; i < j->m->n.goal; ++i)
    print_goal(j, i, job_goal(j, i), cost, f);
}

/* Of a goal, %: of its value, or where its target is not in %. */
double pass_goal_percent(const pass_goal *g) {
  return 100.0 * g->off / fabs(g->found.value + g->found.error);
}

static int is_absolute(const goal_card *g) {
  return g->target > 0.0 && !g->in_percent;
}

/* The width of its column. */
static int goal_head(const model *m, int id, char *text, size_t size) {
  const goal_card *g = &m->accuracy.goals[id];
  const int width = snprintf(text, size, "%s[%s]", g->name,
                             is_absolute(g) ? model_goal_unit(m, id) : "%");
  return width > 10 ? width : 10;
}

void passes_goal_heads(const model *m, FILE *f) {
  for (int i = 0; i < m->n.goal; ++i) {
    char head[80];
    goal_head(m, i, head, sizeof head);
    fprintf(f, " %10s", head);
  }
}

static const char *known(double error) {
  return isnan(error) ? "-" : text_number(error, 2);
}

void passes_goals(const model *m, const pass_goal *goals, int pass, FILE *f) {
  for (int i = 0; i < m->n.goal; ++i) {
    const pass_goal *g = &goals[pass * m->n.goal + i];
    char head[80];
    const int absolute = is_absolute(&m->accuracy.goals[i]);
    const int width = goal_head(m, i, head, sizeof head);
    fprintf(f, " %*s", width, known(absolute ? g->off : pass_goal_percent(g)));
  }
}

/* Errors in the energy norm, where they have a target. */
static void print_norm(const pass_row *r, int is_pass, FILE *f) {
  if (is_pass)
    fprintf(f, " %10s %10s %10s", known(r->mesh), known(r->time),
            known(r->solver));
  else
    fprintf(f, " %10s %10s %10s", "", "", "");
  fprintf(f, " %10s", known(r->total));
}

/* no 0: the forecast. */
static void print_pass(const job *j, const pass_row *r, int no, FILE *f) {
  const pass_table *t = &j->run->passes;
  char head[80];
  fprintf(f, "  %-10s %10.0f", no > 0 ? text_of("%d", no) : "next digit",
          r->unknowns);
  if (t->target > 0.0) print_norm(r, no > 0, f);
  if (t->goals != NULL && no > 0) passes_goals(j->m, t->goals, no - 1, f);
  for (int i = 0; t->goals != NULL && no == 0 && i < j->m->n.goal; ++i)
    fprintf(f, " %*s", goal_head(j->m, i, head, sizeof head), "");
  if (!j->o->no_timing) fprintf(f, " %9.3g", r->cpu);
  fprintf(f, "  %s\n", no > 0 ? r->change : "forecast");
}

/* "target 1 % of the energy norm, 2 % of PEAK: reached" */
static void print_targets(const job *j, FILE *f) {
  const pass_table *t = &j->run->passes;
  const char *comma = "";
  fprintf(f, "\n  target ");
  if (t->target > 0.0) {
    fprintf(f, "%g %% of the energy norm", t->target);
    comma = ", ";
  }
  for (int i = 0; i < j->m->n.goal; ++i) {
    const goal_card *g = &j->m->accuracy.goals[i];
    if (!(g->target > 0.0)) continue;
    fprintf(f, "%s%g %s %s", comma, g->target,
            g->in_percent ? "% of" : model_goal_unit(j->m, i), g->name);
    comma = ", ";
  }
  fprintf(f, ": %s\n", t->why[0] == '\0' ? "reached" : "missed");
}

static void print_passes(const job *j, FILE *f) {
  const pass_table *t = &j->run->passes;
  if (t->n == 0) return;
  print_targets(j, f);
  fprintf(f, "  %-10s %10s", "pass", "unknowns");
  if (t->target > 0.0)
    fprintf(f, " %10s %10s %10s %10s", "mesh[%]", "steps[%]", "solver[%]",
            "total[%]");
  if (t->goals != NULL) passes_goal_heads(j->m, f);
  if (!j->o->no_timing) fprintf(f, " %9s", "cpu[s]");
  fprintf(f, "  next pass\n");
  for (int i = 0; i < t->n; ++i) print_pass(j, &t->rows[i], i + 1, f);
  if (t->forecast != NULL) print_pass(j, t->forecast, 0, f);
  if (t->goals != NULL)
    fputs(
        "  of goals: |error| + band + |error of the solver|, the first two "
        "twice where\n  the estimate is not reliable for the contact ends\n",
        f);
}

void listing_accuracy(const job *j, FILE *f) {
  print_budget(j, f);
  print_goals(j, f);
  print_advice(j, f);
  print_passes(j, f);
}
