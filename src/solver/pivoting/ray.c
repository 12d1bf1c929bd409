/*
 * Rays: is the motion at the end of the path free in fact, and does the load do
 * more work on it than friction takes?
 */
#include "solver/pivoting/parts.h"

#include <math.h>
#include <string.h>

static const double RAY_DEFECT = 1e-8; /* -, forces a free motion may cause   */
static const double RAY_WORK = 0x1p-30; /* -, margin of the work of the load  */

/* 1: the motion w->ray causes no force, and the load does more work on it than
 * "resistance", N m. */
static int motion_is_free(lemke_run *s, double resistance) {
  const contact_problem *cp = s->cp;
  lemke_work *w = s->w;
  double force = 0.0, size = 0.0, work = 0.0;
  lemke_respond(s, w->ray, 0, w->raw);
  for (int dof = 0; dof < cp->m; ++dof) {
    size_t at = (size_t)dof * (size_t)cp->m + (size_t)dof;
    force = fmax(force, fabs(w->raw[dof]));
    size = fmax(size, cp->A[at] * fabs(w->ray[dof]));
    work += cp->f[dof] * w->ray[dof];
  }
  return force <= RAY_DEFECT * size && work > 0.0 &&
         work > resistance * (1.0 - RAY_WORK);
}

outcome lemke_judge_ray(lemke_run *s) {
  const contact_problem *cp = s->cp;
  lemke_work *w = s->w;
  double resistance = 0.0;
  if (!lemke_is_stiff(s)) return STOPPED_RAY;
  lcp_values(w->lcp, w->z);
  lemke_state_of(s, w->z, w->best_u);
  lemke_respond(s, w->best_u, 1, w->best_r);
  for (int i = 0; i < cp->n; ++i)
    w->best_r[i * cp->dim] = fmin(w->best_r[i * cp->dim], 0.0);
  lcp_ray(w->lcp, w->z);
  memset(w->ray, 0, (size_t)cp->m * sizeof *w->ray);
  lemke_add_motion(w, w->z, w->ray);
  lemke_settle_free(s, 0, w->ray);
  for (int i = 0; i < cp->n && cp->g0 != NULL; ++i) {
    const double *v = w->ray + i * cp->dim + 1;
    resistance += contact_node_limit(cp, w->best_r, i) *
                  (cp->dim == 3 ? hypot(v[0], v[1]) : fabs(v[0]));
  }
  w->has_ray = motion_is_free(s, resistance);
  return w->has_ray ? STOPPED_RAY : STOPPED_STAGNATION;
}

int lemke_load_is_held(lemke_run *s) {
  lemke_work *w = s->w;
  double worst = 0.0;
  if (w->n_free == 0 || !s->cp->floating) return 1;
  lemke_respond(s, w->base, 1, w->raw);
  memset(w->ray, 0, (size_t)s->cp->m * sizeof *w->ray);
  for (int k = 0; k < w->n_free; ++k) {
    int dof = w->free_id[k];
    w->ray[dof] = -w->raw[dof];
    worst = fmax(worst, fabs(w->raw[dof]));
  }
  if (!(worst > RAY_DEFECT * contact_scale(s->cp))) return 1;
  w->has_ray = motion_is_free(s, 0.0);
  return !w->has_ray;
}

const double *lemke_ray(const void *work) {
  const lemke_work *w = work;
  return w->has_ray ? w->ray : NULL;
}
