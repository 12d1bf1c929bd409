/*
 * Times within an increment at which what acts on the body turns, between a
 * maximum and the way back: what friction and flow make of a load depends on
 * all that it has been, and an increment sees its ends alone. Loads and
 * supports that turn at other times each by themselves may turn together: each
 * contact force of a body that does not slip is followed through each half of
 * the increment by a parabola.
 */
#include "run/history/loop.h"
#include "run/visco.h"

static const double FLAT = 1e-3; /* -, of the largest entry: no turn */

/* The contact forces of a body that keeps to its obstacles without slip, from
 * time t0 to t, but for what it has at t0; without new inelastic strains. */
static status held_at(run *r, double t0, double t, double *f) {
  PASS(increment_begin(r, t));
  PASS(condense_load(r->c, strains_load(r), r->loads.ud, f));
  if (r->now.motion == NULL) return OK;
  OWNED double *moved = NULL, *force = NULL;
  PASS_NEW_REALS(r->nodes.n_c, &moved, &force);
  surface_drift(r->surface, &r->faces.input, t0, t, moved);
  condensed_product(r->c, run_rows(r, 0, moved), force);
  for (int i = 0; i < r->nodes.n_row; ++i) f[i] -= force[i];
  return OK;
}

/* What a parabola through v at 0, 1/2, 1 reaches beyond its ends; *s: where. */
static double beyond(const double v[3], double *s) {
  const double bend = 2.0 * (v[0] - 2.0 * v[1] + v[2]), rate = v[2] - v[0];
  *s = bend != 0.0 ? 0.5 - 0.5 * rate / bend : 0.0;
  if (!(*s > 0.0 && *s < 1.0)) return 0.0;
  const double d = *s - 0.5, top = v[1] + d * (rate + d * bend);
  return bend < 0.0 ? top - fmax(v[0], v[2]) : fmin(v[0], v[2]) - top;
}

/* Adds the time from t0 to t of the force that turns most, of f[3*n]. */
static int add_force(int n, const double *f, double t0, double t,
                     turn_list *list) {
  double most = 0.0, where = 0.0, s;
  for (int k = 0; k < n; ++k) {
    const double over =
        beyond((const double[]){f[k], f[n + k], f[2 * n + k]}, &s);
    if (over <= most) continue;
    most = over;
    where = s;
  }
  return most > FLAT * largest_entry((size_t)3 * n, f)
             ? turns_add(list, t0 + where * (t - t0))
             : 1;
}

/* Of the forces at all quarters of the increment, by both halves. */
static status add_forces(run *r, double t0, double t, turn_list *list,
                         int *all) {
  const int n = r->nodes.n_row;
  const double middle = 0.5 * (t0 + t);
  OWNED_NEW(double, f, (size_t)5 * n);
  visco_rest(r);
  PASS(run_use(r, &r->elastic));
  for (int i = 0; i < 5; ++i)
    PASS(held_at(r, t0, t0 + 0.25 * i * (t - t0), f + (size_t)i * n));
  *all = add_force(n, f, t0, middle, list) &
         add_force(n, f + (size_t)2 * n, middle, t, list);
  return OK;
}

status loop_turns(run *r, double t0, double t, turn_list *list, int *all) {
  int varying = 0, bent = 0;
  course c;
  *list = (turn_list){1, {0.5 * (t0 + t)}};
  *all = 1;
  for (int k = 0; k < course_count(r->m, r->step) && *all; ++k) {
    if (!course_at(r->m, r->msh, r->step, k, &c)) continue;
    const int found = course_turns(&c, t0, t, list);
    varying += found != 0;
    bent |= found > 1;
    *all = found >= 0;
  }
  if (!*all || !bent || varying < 2 || r->nodes.n_row == 0) return OK;
  return add_forces(r, t0, t, list, all);
}
