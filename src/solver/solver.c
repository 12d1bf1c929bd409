/* Functions common to the solvers (solver.h). */
#include "solver/solver.h"

static const double FEW_DIGITS = 1e-4; /* -, tolerance */

int solver_few_digits(double tol) { return tol >= FEW_DIGITS; }

int solver_progresses(double *mark, double residual) {
  if (!(residual < 0.9 * *mark)) return 0;
  *mark = residual;
  return 1;
}

void solver_report_all(const solver_control *control, const solver_step *s) {
  const solver_listener *l = control->listener;
  solver_step step = *s;
  if (l == NULL || l->step == NULL) return;
  step.limit_update = control->limit_update;
  step.limit_change = NAN;
  l->step(l->ctx, &step);
}

void solver_report_states(const solver_control *control, const char *solver,
                          int iteration, double residual, int changes,
                          int cycle) {
  solver_report_all(control, &(solver_step){.solver = solver,
                                            .iteration = iteration,
                                            .residual = residual,
                                            .status_changes = changes,
                                            .cycle = cycle});
}

void solver_report_step(const solver_control *control, const char *solver,
                        int iteration, double residual) {
  solver_report_states(control, solver, iteration, residual, -1, 0);
}

int solver_promises(sweep_promise *p, int k, double residual, double tol) {
  if (p == NULL) return 1;
  if (!(p->best > 0.0 && p->best < residual)) p->best = residual;
  if (k - p->from < p->every) return 1;
  const double fall = p->before > 0.0 ? log(p->before / p->best) : HUGE_VAL;
  const double left = log(p->best / tol) / fall * (k - p->from);
  p->before = p->best;
  p->from = k;
  return k + left <= p->most;
}

status solver_set_up(const solver_ops *ops, const contact_problem *cp,
                     const void *par, void **work) {
  *work = NULL;
  OWNED_NEW(char, own, ops->work_size);
  OWNS(own);
  PASS(ops->setup(cp, par, own));
  *work = own;
  own = NULL;
  return OK;
}

status best_iterate_new(int m, best_iterate *best) {
  best->residual = HUGE_VAL;
  PASS_NEW_ALL(OF(best->u, m), OF(best->r, m));
  return OK;
}

void solver_keep_best(best_iterate *best, int m, double residual,
                      const double *u, const double *r) {
  if (!(residual < best->residual)) return;
  best->residual = residual;
  COPY(best->u, u, m);
  COPY(best->r, r, m);
}

double solver_take_best(const best_iterate *best, int m, double *u, double *r) {
  if (best->residual < HUGE_VAL) {
    COPY(u, best->u, m);
    COPY(r, best->r, m);
  }
  return best->residual;
}
