/*
 * The error budget of a run: mesh, increments, contact solver, each with the
 * CPU seconds of the stages whose work decides it.
 */
#include "base/timer.h"
#include "output/writers.h"

#include <math.h>

static const stage mesh_stages[] = {STAGE_MESH,     STAGE_SURFACE,
                                    STAGE_ASSEMBLY, STAGE_ORDERING,
                                    STAGE_FACTOR,   STAGE_CONDENSE};
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
static error_share solver_share(const increment_summary *i) {
  const error_bound *e = &i->error;
  return (error_share){e->asked, e->relative, e->cpu, e->why};
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
  {"solver", "solver", solver_share, STAGES(solver_stages)}};
/* clang-format on */

int job_budget(const job *j, budget_row rows[BUDGET_ROWS]) {
  int n = 0;
  for (int k = 0; k < BUDGET_ROWS; ++k) {
    rows[n] = (budget_row){
        .name = budget_table[k].name,
        .json = budget_table[k].json,
        .reached = cpu_of(budget_table[k].stages, budget_table[k].n_stage)};
    n += collect(j->run, budget_table[k].of, &rows[n]);
    if (n == BUDGET_ROWS) break;
  }
  return n;
}
