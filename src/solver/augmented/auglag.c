/*
 * Augmented Lagrangian of Alart and Curnier (1991; CPR98, 3.3). With
 * x = u - o the displacement from the gap and the stick position and
 *
 *   F(z) = (min(z_n, 0), P_g(z_t)),   z = lambda - rho x,
 *
 * P_g the projection on the disc |.| <= g, contact with friction is
 *
 *   A u - f - F = 0,   lambda = F,   g = g0 - B F_n.
 *
 * VARIANT=NEWTON: generalised Newton method for both equations at once. The
 * first is linear, so lambda = A u - f is put into the second,
 *
 *   Phi(u) = A u - f - F(A u - f - rho x) = 0,
 *   (A - F'(A - rho)) du = -Phi,
 *
 * F' with the limit following the pressure. Rows of closed and of sticking
 * unknowns hold rho alone and are eliminated. The step is shortened until
 * |Phi| falls. Should it stop, the other variant goes on.
 *
 * VARIANT=UZAWA: u minimises the augmented Lagrangian for fixed lambda and g,
 *
 *   A u - f - F(lambda - rho x) = 0,
 *
 * a convex function with a continuous gradient, by Newton's method with the
 * matrix A + F' rho and a search along the step for a zero of the slope; then
 * lambda <- F. The error falls by about lmax(A)/rho a multiplier step. The
 * limit is updated around it (CPR98, 2.3).
 *
 * rho is a multiple of the diagonal of A, equal in the tangents of a node.
 */
#include "solver/augmented/parts.h"
#include "base/memory.h"

#include <math.h>

typedef struct auglag {
  int variant; /* variant_way                                                */
} auglag;

typedef enum { BY_NEWTON, BY_UZAWA } variant_way;

/* clang-format off */
static const option auglag_options[] = {
  OPTION_CHOICE(auglag, variant, "VARIANT", "NEWTON|UZAWA", "NEWTON",
                "both equations at once, or multiplier after displacement"),
  OPTION_END
};
/* clang-format on */

static const double SOFT = 0x1p-20; /* -, of the stiffness: none         */

enum { UZAWA_STEPS = 1000 /* Newton steps of all multiplier steps */ };

static void auglag_release(void *work) {
  auglag_work *w = work;
  if (w == NULL) return;
  RELEASE(w->part, w->closed, w->mode, w->state, w->origin, w->diagonal,
          w->lambda, w->z, w->F, w->y, w->du, w->dy, w->e, w->share, w->bonded,
          w->K, w->pivot, w->free_id);
  fixed_point_free(w->fixed);
  best_iterate_free(&w->best);
  memory_free(w);
}

/* Of A, also where a motion of the whole body leaves nothing. */
static void take_diagonal(const contact_problem *cp, double *diagonal) {
  size_t m = (size_t)cp->m;
  int d = cp->dim;
  double largest = 0.0;
  for (size_t i = 0; i < m; ++i) {
    diagonal[i] = cp->A[i * m + i];
    largest = fmax(largest, diagonal[i]);
  }
  for (int i = 0; i < cp->n; ++i) {
    double mean = 0.0, *own = diagonal + i * d;
    for (int k = 1; k < d; ++k) mean += own[k] / (d - 1);
    for (int k = 1; k < d; ++k) own[k] = mean;
    double least = SOFT * fmax(fmax(own[0], mean), SOFT * largest);
    for (int k = 0; k < d; ++k) own[k] = fmax(own[k], least);
  }
}

static status auglag_setup(const contact_problem *cp, const void *par,
                           void **work) {
  status st = OK;
  auglag_work *w = NULL;
  size_t m = (size_t)cp->m;
  (void)par;
  NEW(w, 1);
  w->m = cp->m;
  NEW(w->part, m);
  NEW(w->closed, m);
  NEW(w->mode, cp->n);
  NEW(w->state, m);
  NEW(w->origin, m);
  NEW(w->diagonal, m);
  NEW(w->lambda, m);
  NEW(w->z, m);
  NEW(w->F, m);
  NEW(w->y, m);
  NEW(w->du, m);
  NEW(w->dy, m);
  NEW(w->e, m);
  NEW(w->share, cp->n);
  NEW(w->bonded, cp->n);
  NEW(w->K, m * m);
  NEW(w->pivot, m);
  NEW(w->free_id, m);
  TRY(fixed_point_new(cp->n, &w->fixed));
  TRY(best_iterate_new(cp->m, &w->best));
  take_diagonal(cp, w->diagonal);
  double largest = 0.0;
  int exponent = 0;
  for (size_t i = 0; i < m; ++i) largest = fmax(largest, w->diagonal[i]);
  if (largest > 0.0 && largest < HUGE_VAL) frexp(largest, &exponent);
  w->power = ldexp(1.0, -exponent);
  *work = w;
  w = NULL;
done:
  auglag_release(w);
  return st;
}

/* The other variant, the limit updated around it. */
static status follow_limit(auglag_run *s, solver_report *rep) {
  static const auglag uzawa = {BY_UZAWA};
  inner_solver self = {&auglag_solver, &uzawa, s->w};
  solver_control rest = *s->control;
  int bounded = s->control->max_iter > 0;
  if (!bounded || s->steps < s->limit) auglag_start_bonded(s);
  rest.max_iter = bounded ? s->limit - s->steps : 0;
  int before = s->steps;
  rep->outcome = STOPPED_ITERATIONS;
  rep->iterations = before;
  if (bounded && rest.max_iter == 0) return OK;
  PASS(fixed_point_solve(s->w->fixed, s->cp, &self, &rest, s->u, s->r, rep));
  rep->iterations += before;
  return OK;
}

/* 1: the other variant ended by itself, without progress: that the first one
 * cycled says more. */
static int made_no_way(const solver_control *control,
                       const solver_report *rep) {
  int bounded = control->max_iter > 0 && rep->iterations >= control->max_iter;
  return rep->outcome == STOPPED_STAGNATION ||
         (rep->outcome == STOPPED_ITERATIONS && !bounded);
}

static status auglag_solve(const contact_problem *cp, const void *par,
                           void *work, const solver_control *control, double *u,
                           double *r, solver_report *rep) {
  status st = OK;
  const auglag *p = par;
  auglag_work *w = work;
  auglag_run s = {
      .cp = cp,
      .w = w,
      .control = control,
      .u = u,
      .r = r,
      .scale = contact_scale(cp),
      .limit = control->max_iter > 0 ? control->max_iter : UZAWA_STEPS};
  *rep = (solver_report){.outcome = RUNNING};
  w->best.residual = HUGE_VAL;
  force_parts(cp, w->part, w->origin);
  if (p->variant == BY_NEWTON) rep->outcome = auglag_newton(&s);
  int done_well = rep->outcome == CONVERGED || rep->outcome == STOPPED_NAN;
  int cycled = rep->outcome == STOPPED_CYCLE;
  if (!done_well && cp->B == NULL) rep->outcome = auglag_uzawa(&s);
  rep->iterations = s.steps;
  rep->residual = w->best.residual;
  solver_take_best(&w->best, cp->m, u, r);
  if (!done_well && cp->B != NULL) TRY(follow_limit(&s, rep));
  if (cycled && made_no_way(control, rep)) rep->outcome = STOPPED_CYCLE;
done:
  return st;
}

/* Changes of state are told against the step before. */
static status auglag_keep(void *work, archive *a) {
  auglag_work *w = work;
  return archive_bytes(a, "state", w->state, (size_t)w->m);
}

/* clang-format off */
const solver_ops auglag_solver = {
  .name = "auglag",
  .reference = "CPR98, 3.3; Alart, Curnier 1991",
  .family = "multipliers",
  .help =
    "Augmented Lagrangian of Alart and Curnier: the forces of contact are F\n"
    "= P(lambda - rho (u - o)), P the projection on r_n <= 0 and on the\n"
    "disc |r_t| <= g. VARIANT=NEWTON solves A u = f + F and lambda = F by\n"
    "the generalised Newton method, the limit following the pressure, the\n"
    "step shortened until the equations are met better; should it stop, the\n"
    "other variant goes on. VARIANT=UZAWA minimises over u for fixed\n"
    "multipliers, a convex problem solved by Newton's method with a search\n"
    "along the step, then sets lambda to F; the limit is updated around it\n"
    "(CPR98, 2.3). rho is a multiple of the diagonal of A and never asked\n"
    "for. A step costs one dense factorisation. Choose it where NEWTON\n"
    "cycles, and UZAWA for a body that contact alone holds.",
  .handles = SOLVES_TRESCA | SOLVES_COULOMB | SOLVES_3D | NEEDS_STIFFNESS |
             SOLVES_FLOATING,
  .param_size = sizeof(auglag),
  .options = auglag_options,
  .setup = auglag_setup,
  .solve = auglag_solve,
  .release = auglag_release,
  .keep = auglag_keep
};
/* clang-format on */
