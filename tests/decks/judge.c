/*
 * The judgement of a run, increment by increment.
 */
#include "decks/judge.h"

#include "base/base.h"

const char *const check_name[CHECKS] = {[OF_TEMPERATURE] = "temperature",
                                        [OF_STRAIN] = "strain",
                                        [OF_STRESS] = "stress",
                                        [OF_BALANCE] = "balance",
                                        [OF_SUPPORT] = "support",
                                        [OF_FRAME] = "frame",
                                        [OF_GAP] = "gap",
                                        [OF_NORMAL] = "normal",
                                        [OF_LIMIT] = "limit",
                                        [OF_AVERAGE] = "average",
                                        [OF_MEAN] = "mean",
                                        [OF_SLIP] = "slip",
                                        [OF_FRICTION] = "friction",
                                        [OF_TOTAL] = "total",
                                        [OF_ENERGY] = "energy"};

/* Of the scale. */
static const double tolerance[CHECKS] = {
    [OF_TEMPERATURE] = 1e-10, [OF_STRAIN] = 1e-8,   [OF_STRESS] = 1e-8,
    [OF_BALANCE] = 1e-8,      [OF_SUPPORT] = 1e-10, [OF_FRAME] = 1e-8,
    [OF_GAP] = 1e-7,          [OF_NORMAL] = 1e-6,   [OF_LIMIT] = 1e-8,
    [OF_AVERAGE] = 5e-3,      [OF_MEAN] = 5e-2,     [OF_SLIP] = 1e-6,
    [OF_FRICTION] = 1e-6,     [OF_TOTAL] = 1e-8,    [OF_ENERGY] = 1e-6};

void judge_note(judgement *q, check_kind kind, double miss, double scale,
                const snapshot *s, int no) {
  double ratio = miss == 0 ? 0 : fabs(miss) / (scale * tolerance[kind]);
  if (isnan(miss) || isnan(ratio)) ratio = HUGE_VAL;
  if (ratio <= q->worst[kind]) return;
  q->worst[kind] = ratio;
  snprintf(q->where[kind], sizeof *q->where,
           "step %d increment %d t %g, number %d: %.3g of %.3g", s->step,
           s->increment, s->t, no, miss, scale);
}

/* Displacements of a table; u_0 of the deck without one. */
static void take_displacements(const random_deck *d, const snapshot *s,
                               double *u) {
  int dim = d->mesh.dim;
  if (s == NULL) {
    for (int i = 0; i < d->mesh.n_node * dim; ++i) u[i] = d->start[i % dim];
    return;
  }
  const table *t = &s->of[T_NODES];
  int col = table_column(t, d->kind == AXISYMMETRIC_ ? "u_r" : "u_x");
  for (int i = 0; i < d->mesh.n_node * dim; ++i) u[i] = NAN;
  for (int row = 0; row < t->n_row; ++row)
    for (int c = 0; c < dim && col >= 0; ++c)
      u[dim * ((int)table_at(t, row, 0) - 1) + c] = table_at(t, row, col + c);
}

static double *vector(int n) {
  double *v = calloc((size_t)n + 1, sizeof *v);
  if (v == NULL) abort();
  return v;
}

static void judge_one(const random_deck *d, const snapshot *first,
                      const snapshot *now, const double residual[2],
                      judgement *q) {
  const snapshot *before = now == first ? NULL : now - 1;
  int n = d->mesh.n_node, dof = d->mesh.dim * n;
  judged x = {.d = d,
              .first = first,
              .now = now,
              .before = before,
              .residual = residual[1],
              .old_residual = residual[0],
              .step = now->step - 1,
              .q = q};
  x.u = vector(dof);
  x.old_u = vector(dof);
  x.force = vector(dof);
  x.size = vector(n);
  x.stiffness = vector(n);
  take_displacements(d, now, x.u);
  take_displacements(d, before, x.old_u);
  judge_body(&x);
  judge_contacts(&x);
  free(x.u);
  free(x.old_u);
  free(x.force);
  free(x.size);
  free(x.stiffness);
}

/* Residual in JOB.sta of the attempt that an increment ended with. */
static double residual_of(const char *sta, const snapshot *s) {
  double found = 0;
  for (const char *line = sta; line != NULL; line = strchr(line, '\n')) {
    int step, increment, n = 0;
    double value;
    line += *line == '\n';
    if (sscanf(line, "%d %d %*d %*s %*s %*d %*d %*d %*s %*d %n", &step,
               &increment, &n) == 2 &&
        n > 0 && step == s->step && increment == s->increment &&
        sscanf(line + n, "%lf", &value) == 1)
      found = value;
  }
  return found;
}

void judge(const random_deck *d, const tables *t, const char *sta,
           judgement *q) {
  memset(q, 0, sizeof *q);
  double residual[2] = {0, 0};
  for (int i = 0; i < t->n; ++i, residual[0] = residual[1]) {
    residual[1] = residual_of(sta, &t->at[i]);
    judge_one(d, t->at, &t->at[i], residual, q);
  }
}
