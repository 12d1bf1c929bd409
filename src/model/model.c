/* The model: what belongs to it, and what its tables show. */
#include "model/model.h"

#include <strings.h>

int has_card(const model *m, const char *name) {
  for (int i = 0; i < m->deck->n_card; ++i)
    if (strcmp(m->deck->cards[i].name, name) == 0) return 1;
  return 0;
}

/* Ends of increments are sums: equal to rounding. */
static int same_time(const step *s, double a, double b) {
  return fabs(a - b) <= 1e-12 * (fabs(s->start) + s->total);
}

double print_next(const print_request *p, const step *s, double after,
                  double before) {
  const time_points *q = p->points;
  for (int i = 0; q != NULL && i < q->n; ++i) {
    double t = q->total_time ? q->t[i] : s->start + q->t[i];
    if (t > after && t < before && !same_time(s, t, after) &&
        !same_time(s, t, before))
      return t;
  }
  return HUGE_VAL;
}

enum { ADAPTED = 50 }; /* increments of a step with a tolerance, at most */

static double increments_of(double time, double dt) {
  return fmax(0.0, ceil(time / fmax(dt, 1e-300) * (1.0 - 1e-9)));
}

double step_increments(const step *s) {
  if (s->kind == STEP_STATIC || !(s->dt > 0.0)) return 1.0;
  const double n = fmax(1.0, increments_of(s->total, s->dt));
  return s->visco.tolerance > 0.0 ? fmin(n, ADAPTED) : n;
}

double step_increments_left(const step *s, double t, double dt, int n_done) {
  const double n = increments_of(s->start + s->total - t, fmax(dt, s->dt_min));
  if (!(s->visco.tolerance > 0.0)) return n;
  return fmin(n, ceil(fmax(ADAPTED - n_done, 0.5 * n_done)));
}

int frequency_shows(int frequency, int increment_no, int last) {
  if (frequency < 0) return 0;
  return last ||
         (frequency > 0 && increment_no >= 0 && increment_no % frequency == 0);
}

const char *print_word(int table) {
#define PRINT_WORD(name, help) #name,
  static const char *const words[] = {PRINT_LIST(PRINT_WORD)};
  int k = 0;
  while (1 << k != table) ++k;
  return words[k];
}

int print_shows(const print_request *p, const step *s, double t,
                int increment_no, int last) {
  const time_points *q = p->points;
  if (q == NULL) return frequency_shows(p->frequency, increment_no, last);
  for (int i = 0; i < q->n; ++i)
    if (same_time(s, q->total_time ? q->t[i] : s->start + q->t[i], t)) return 1;
  return 0;
}

void model_fit_problem(model *m, int dim, int friction, effect_finder *find) {
  m->dim = dim;
  m->problem.friction = friction;
  m->effects = EFFECT_CONTACT | (friction ? EFFECT_FRICTION : 0u);
  if (dim == 1) {
    const solver_ops *ops = m->steps[0].solver.ops;
    if (ops != NULL && strcasecmp(ops->name, "lemke") != 0)
      message_add(m->log, P2004, &m->steps[0].solver_at,
                  "*SOLVER, METHOD=%s does not solve a plain linear "
                  "complementarity problem; use LEMKE or AUTO",
                  ops->name);
  }
  if (dim > 1) m->effects |= find(m) & EFFECT_ESTIMATES;
}
