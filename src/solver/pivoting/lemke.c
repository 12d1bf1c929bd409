/*
 * Contact by complementary pivoting: the whole problem as one linear
 * complementarity problem, without a fixed point on the sliding limit.
 *
 * Stiffness form. Slip is s = sum of e_j l_j over given directions e_j of the
 * tangent plane (2-D: +1 and -1, exact; 3-D: the corners of a regular polygon),
 *   x = gap - u_n >= 0              p = -r_n >= 0               x p = 0
 *   l_j >= 0                        h_j = g + e_j r_t >= 0      l_j h_j = 0
 * with A u = f + r, g = g0 + B p: w = (p, h) is affine in z = (x, l), and z = 0
 * is the body at stick. The covering vector is a pressure d on every node with
 * the limit it brings, (d, B d + d). A ray then is a motion v with v'A v <= 0
 * that opens or slides and on which the load does more work than the friction
 * of the state reached: with A positive definite there is none, whatever the
 * friction, and the method always ends with a solution.
 *
 * Compliance form (A not known; W may be singular or slightly unsymmetric):
 * r_t = sum of e_j b_j, slip speed y (Stewart, Trinkle 1996),
 *   p >= 0      gap - u_n >= 0       b_j >= 0      e_j s + y >= 0
 *   y >= 0      g0 + B p - sum b_j >= 0.
 *
 * Tangential unknowns without friction are eliminated first. In 3-D the state
 * found is the start of a solver with the exact disc of friction.
 */
#include "base/memory.h"
#include "solver/pivoting/parts.h"

#include <string.h>

typedef struct lemke {
  int facets; /* of the friction polygon, 3-D; 0: 8                           */
} lemke;

/* clang-format off */
static const option lemke_options[] = {
  OPTION_INT(lemke, facets, "FACETS", 4, 64, "8", "-",
             "facets of the friction cone of the first stage in 3-D; even"),
  OPTION_END
};
/* clang-format on */

static const char *const corrector_name[N_CORRECTOR] = {"newton", "sor"};

static void lemke_release(void *work) {
  lemke_work *w = work;
  if (w == NULL) return;
  for (int i = 0; i < N_CORRECTOR; ++i) {
    if (w->corrector[i] != NULL) w->corrector[i]->release(w->corrector_work[i]);
    memory_free(w->corrector_param[i]);
  }
  lcp_free(w->lcp);
  void *const blocks[] = {w->S,     w->inner,  w->spare,  w->D,     w->tame,
                          w->base,  w->raw,    w->v,      w->t,     w->ray,
                          w->work,  w->best_u, w->best_r, w->kept,  w->free_id,
                          w->pivot, w->kind,   w->normal, w->slide, w->n_slide,
                          w->var,   w->q,      w->d,      w->z,     w->dz};
  for (size_t i = 0; i < sizeof blocks / sizeof *blocks; ++i)
    memory_free(blocks[i]);
  memory_free(w);
}

static status set_up_correctors(const contact_problem *cp, lemke_work *w) {
  for (int i = 0; i < N_CORRECTOR && cp->dim == 3; ++i) {
    const solver_ops *ops = solver_find(corrector_name[i]);
    if (ops == NULL || !(ops->handles & SOLVES_3D)) continue;
    if ((ops->handles & NEEDS_STIFFNESS) && cp->A == NULL) continue;
    char *param = NULL;
    PASS_NEW(param, ops->param_size + 1);
    w->corrector_param[i] = param;
    w->corrector[i] = ops;
    option_defaults(ops->options, param);
    PASS(ops->setup(cp, param, &w->corrector_work[i]));
  }
  return OK;
}

static status lemke_setup(const contact_problem *cp, const void *par,
                          void **work) {
  status st = OK;
  lemke_work *w = NULL;
  const lemke *p = par;
  size_t m = (size_t)cp->m;
  NEW(w, 1);
  w->m = cp->m;
  w->facets = p->facets >= 4 ? p->facets + p->facets % 2 : 8;
  int n_var = cp->n * (cp->dim == 2 ? 4 : w->facets + 2);
  double **by_unknown[] = {&w->base, &w->raw,    &w->v,     &w->t,
                           &w->ray,  &w->best_u, &w->best_r};
  double **by_variable[] = {&w->q, &w->d, &w->z, &w->dz};
  int **by_place[] = {&w->kept,   &w->free_id, &w->pivot,  &w->kind,
                      &w->normal, &w->slide,   &w->n_slide};
  for (size_t i = 0; i < sizeof by_unknown / sizeof *by_unknown; ++i)
    NEW(*by_unknown[i], m);
  for (size_t i = 0; i < sizeof by_variable / sizeof *by_variable; ++i)
    NEW(*by_variable[i], n_var);
  for (size_t i = 0; i < sizeof by_place / sizeof *by_place; ++i)
    NEW(*by_place[i], 2 * m);
  NEW(w->S, m * m);
  NEW(w->inner, m * m);
  if (cp->floating) NEW(w->spare, m * m);
  NEW(w->work, 4 * m + 4);
  NEW(w->D, cp->n);
  NEW(w->tame, cp->n);
  NEW(w->var, n_var);
  TRY(lcp_new(n_var, cp->A != NULL ? cp->m : cp->m + 2 * cp->n, &w->lcp));
  TRY(set_up_correctors(cp, w));
  *work = w;
  w = NULL;
done:
  lemke_release(w);
  return st;
}

/* The verdict; from the state of the polygon to that of the disc by a solver
 * that knows it. */
static status correct(lemke_run *s, double *u, double *r, solver_report *rep) {
  lemke_work *w = s->w;
  size_t bytes = (size_t)s->cp->m * sizeof *u;
  rep->residual = contact_residual(s->cp, u, r);
  if (rep->residual <= s->control->tol) return OK;
  rep->outcome = STOPPED_STAGNATION;
  if (!w->has_facets) return OK;
  memcpy(w->best_u, u, bytes);
  memcpy(w->best_r, r, bytes);
  for (int i = 0; i < N_CORRECTOR && rep->outcome != CONVERGED; ++i) {
    solver_report inner = {.outcome = RUNNING};
    if (w->corrector[i] == NULL) continue;
    memcpy(u, w->best_u, bytes);
    memcpy(r, w->best_r, bytes);
    PASS(w->corrector[i]->solve(s->cp, w->corrector_param[i],
                                w->corrector_work[i], s->control, u, r,
                                &inner));
    rep->iterations += inner.iterations;
    rep->residual = contact_residual(s->cp, u, r);
    rep->outcome = rep->residual <= s->control->tol ? CONVERGED : inner.outcome;
  }
  return OK;
}

static void tell(const void *ctx, int pivot, double z0) {
  const lemke_run *s = ctx;
  solver_tell_states(s->control, "lemke", pivot, z0, 1, 0);
}

static int prepare(lemke_run *s) {
  lemke_sort_unknowns(s);
  lemke_list_variables(s);
  if (!lemke_reduce(s)) return 0;
  lemke_scale(s);
  lemke_tame_limits(s);
  lemke_set_base(s);
  return 1;
}

static outcome follow(lemke_run *s, int *count) {
  lemke_work *w = s->w;
  lcp_report rep;
  lemke_set_vectors(s);
  lcp_problem p = {.n = w->n_var, .q = w->q, .d = w->d, .ctx = s};
  p.max_pivots = s->control->max_iter;
  p.product = lemke_product;
  p.row = lemke_row;
  p.each = tell;
  lcp_run(w->lcp, &p, &rep);
  *count += rep.pivots;
  return rep.outcome == STOPPED_RAY ? lemke_judge_ray(s) : rep.outcome;
}

static status lemke_solve(const contact_problem *cp, const void *par,
                          void *work, const solver_control *control, double *u,
                          double *r, solver_report *rep) {
  status st = OK;
  lemke_work *w = work;
  lemke_run s = {cp, w, control, cp->A != NULL ? cp->A : cp->W};
  (void)par;
  *rep = (solver_report){.outcome = STOPPED_SINGULAR};
  w->has_ray = 0;
  if (!prepare(&s)) goto done;
  rep->outcome = STOPPED_RAY;
  if (!lemke_load_is_held(&s)) goto done;
  rep->outcome = follow(&s, &rep->iterations);
  if (rep->outcome != CONVERGED) goto done;
  lemke_set_solution(&s, u, r);
  TRY(correct(&s, u, r, rep));
done:
  return st;
}

static status lemke_keep(void *work, archive *a) {
  status st = OK;
  lemke_work *w = work;
  for (int i = 0; i < N_CORRECTOR && st == OK; ++i) {
    if (w->corrector[i] == NULL || w->corrector[i]->keep == NULL) continue;
    archive_enter(a, w->corrector[i]->name);
    st = w->corrector[i]->keep(w->corrector_work[i], a);
    archive_leave(a);
  }
  return st;
}

/* clang-format off */
const solver_ops lemke_solver = {
  .name = "lemke",
  .reference = "Lemke 1965; Cottle, Pang, Stone 1992; Klarbring 1986",
  .family = "pivoting",
  .help =
    "Complementary pivoting with the lexicographic rule. The frictionless\n"
    "and the 2-D frictional problem are each one linear complementarity\n"
    "problem, without a fixed point on the sliding limit: from a body pressed\n"
    "into stick to the real load, one change of state a pivot. It never\n"
    "cycles, has a solution for every friction coefficient if the body is\n"
    "supported; a body held by contact alone ends in equilibrium or in a\n"
    "motion that proves there is none. In 3-D the cone has FACETS facets; the\n"
    "state is then corrected to the exact cone by NEWTON or SOR. For up to\n"
    "some hundred contact nodes, and where other methods disagree or fail.",
  .handles = SOLVES_TRESCA | SOLVES_COULOMB | SOLVES_3D | SOLVES_FLOATING,
  .param_size = sizeof(lemke),
  .options = lemke_options,
  .setup = lemke_setup,
  .solve = lemke_solve,
  .release = lemke_release,
  .keep = lemke_keep
};
/* clang-format on */
