/*
 * Tables over the time in increments that the program chooses: what a table
 * does between the times at which an increment takes it, a pulse or a corner,
 * no estimate of an error sees. A smooth course is close to the polynomial of
 * degree 4 through its values at five times of the increment; an increment
 * ends at a point of a table where a longer one would miss another course.
 */
#include "run/history/loop.h"

static const double APART = 0x1p-40; /* -, of the time: points of their own */

/* A table at times of the run. */
typedef struct course {
  const value_table *table;
  double start; /* s, time at which its time is zero */
} course;

static double value_at(const course *c, double t) {
  static const double nowhere[3] = {0.0};
  return table_value(c->table, nowhere, t - c->start);
}

/* What an increment takes of a table: its values at the start, the quarters and
 * the end; the polynomial through them at s in [0, 1]. */
enum { SEEN = 5 };

static double polynomial(const double v[SEEN], double s) {
  double sum = 0.0;
  for (int i = 0; i < SEEN; ++i) {
    double factor = v[i];
    for (int k = 0; k < SEEN; ++k)
      if (k != i) factor *= (s * (SEEN - 1) - k) / (i - k);
    sum += factor;
  }
  return sum;
}

/* The largest magnitude over the step. */
static double largest_of(const course *c, const step *s) {
  const double end = s->start + s->total;
  double most = fmax(fabs(value_at(c, s->start)), fabs(value_at(c, end)));
  for (int k = 0; k < c->table->n; ++k) {
    const double t = c->table->at[k] + c->start;
    if (t > s->start && t < end) most = fmax(most, fabs(c->table->value[k]));
  }
  return most;
}

/* Points of the table from "after" to before t: the first; *n of them. */
static int points_within(const course *c, double after, double t, int *n) {
  const double least = APART * fmax(fabs(after), fabs(t));
  int first = 0;
  while (first < c->table->n && c->table->at[first] + c->start <= after + least)
    ++first;
  *n = 0;
  while (first + *n < c->table->n &&
         c->table->at[first + *n] + c->start < t - least)
    ++*n;
  return first;
}

/* 1: from t0 to t, with n points from "first" on between them, the table is the
 * polynomial but for "most"; compared there and halfway between. */
static int is_seen(const course *c, double t0, double t, int first, int n,
                   double most) {
  double v[SEEN];
  for (int i = 0; i < SEEN && n > 0; ++i)
    v[i] = value_at(c, t0 + (t - t0) * i / (SEEN - 1));
  double before = t0;
  for (int k = 0; k <= n && n > 0; ++k) {
    const double at = k < n ? c->table->at[first + k] + c->start : t;
    const double both[2] = {0.5 * (before + at), at};
    for (int i = 0; i < 2; ++i)
      if (fabs(value_at(c, both[i]) -
               polynomial(v, (both[i] - t0) / (t - t0))) > most)
        return 0;
    before = at;
  }
  return 1;
}

/* The last point of a table that may end the increment to t, or t; found by
 * bisection: no point is between the start and the first. */
static double end_by(const run *r, const quantity *q, double t, double share) {
  const course c = {q->factor, q->factor_start};
  int n, low = 0;
  if (c.table == NULL || c.table->n == 0 || c.table->variable != TABLE_T)
    return t;
  if (q->formula == NULL && q->number == 0.0) return t;
  const double t0 = r->old.t;
  const int first = points_within(&c, t0, t, &n);
  if (n == 0) return t;
  const double most = share * largest_of(&c, r->step);
  if (is_seen(&c, t0, t, first, n, most)) return t;
  for (int high = n; high - low > 1;) {
    const int middle = (low + high) / 2;
    const double at = c.table->at[first + middle] + c.start;
    if (is_seen(&c, t0, at, first, middle, most))
      low = middle;
    else
      high = middle;
  }
  return c.table->at[first + low] + c.start;
}

/* The same by all tables in force. */
static double end_by_all(const run *r, double t, double share) {
  const model *m = r->m;
  const load_list *loads = &r->step->loads;
  for (int i = 0; i < loads->n; ++i)
    if (loads->item[i].run == RUN_DIRECT)
      t = end_by(r, &loads->item[i].value, t, share);
  for (int i = 0; i < m->n.obstacle; ++i) {
    for (int k = 0; k < 3; ++k)
      t = end_by(r, &m->obstacles[i].motion[k], t, share);
    t = end_by(r, &m->obstacles[i].angle, t, share);
  }
  for (int i = 0; i < m->n.contact; ++i) {
    const friction_rule *rule = friction_in_force(m, run_step_id(r), i);
    t = end_by(r, &rule->card.value, t, share);
    t = end_by(r, &m->contacts[i].change.value, t, share);
    t = end_by(r, &m->contacts[i].force.value, t, share);
  }
  return t;
}

double loop_end(const run *r, double t, double share) {
  double end = t;
  do {
    t = end;
    end = end_by_all(r, t, share);
  } while (end < t);
  return end;
}
