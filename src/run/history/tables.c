/*
 * Tables over the time in increments that the program chooses: what a table
 * does between the times at which an increment takes it, a pulse or a corner,
 * no estimate of an error sees. A smooth course is close to the polynomial of
 * degree 4 through its values at five times of the increment; an increment
 * ends at a point of a table where a longer one would miss another course.
 */
#include "run/history/loop.h"

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

static double value_at(const course *c, double t) {
  static const double nowhere[3] = {0.0};
  return table_value(c->value->factor, nowhere, t - c->value->factor_start);
}

static double point_at(const course *c, int k) {
  return c->value->factor->at[k] + c->value->factor_start;
}

/* The largest magnitude over the step. */
static double largest_of(const course *c) {
  const double start = c->s->start, end = step_end(c->s);
  double most = fmax(fabs(value_at(c, start)), fabs(value_at(c, end)));
  for (int k = 0; k < c->value->factor->n; ++k) {
    const double t = point_at(c, k);
    if (t > start && t < end)
      most = fmax(most, fabs(c->value->factor->value[k]));
  }
  return most;
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
    const double at = k < n ? point_at(c, first + k) : t;
    const double both[2] = {0.5 * (before + at), at};
    for (int i = 0; i < 2; ++i)
      if (fabs(value_at(c, both[i]) -
               polynomial(v, (both[i] - t0) / (t - t0))) > most)
        return 0;
    before = at;
  }
  return 1;
}

/* The last point of its table that may end the increment to t, or t; found by
 * bisection: no point is between the start and the first. */
static double end_by(const run *r, const course *c, double t, double share) {
  int n, low = 0;
  if (c->value->formula == NULL && c->value->number == 0.0) return t;
  const double t0 = r->old.t;
  const int first = course_points(c, t0, t, &n);
  if (n == 0) return t;
  const double most = share * largest_of(c);
  if (is_seen(c, t0, t, first, n, most)) return t;
  for (int high = n; high - low > 1;) {
    const int middle = (low + high) / 2;
    if (is_seen(c, t0, point_at(c, first + middle), first, middle, most))
      low = middle;
    else
      high = middle;
  }
  return point_at(c, first + low);
}

/* The same by all tables in force. */
static double end_by_all(const run *r, double t, double share) {
  course c;
  for (int k = 0; k < course_count(r->m, r->step); ++k)
    if (course_at(r->m, r->msh, r->step, k, &c)) t = end_by(r, &c, t, share);
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
