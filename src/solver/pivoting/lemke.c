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
 * Compliance form (A not known; W may be singular or slightly unsymmetric): r_t
 * = sum of e_j b_j, slip speed y (Stewart, Trinkle 1996),
 *   p >= 0      gap - u_n >= 0       b_j >= 0      e_j s + y >= 0
 *   y >= 0      g0 + B p - sum b_j >= 0.
 *
 * Tangential unknowns without friction are eliminated first. In 3-D the state
 * found is the start of a solver with the exact disc of friction.
 */
#include "base/memory.h"
#include "solver/pivoting/parts.h"

#include <cblas.h>
#include <math.h>
#include <string.h>

/* ---- states of the body: at z = 0, at a given z, and at the end, where the
 * conditions of the basis are enforced exactly. */

enum { POLISH = 3 /* passes */ };

/* raw = A u - f, or W r + q; load 0: without f or q. */
static void lemke_respond(const lemke_run *s, const double *x, int load,
                          double *raw) {
  double sign = lemke_is_stiff(s) ? -1.0 : 1.0;
  contact_product(s->cp->m, s->M, x, raw);
  if (load) cblas_daxpy(s->cp->m, sign, s->cp->f, 1, raw, 1);
}

/* The free unknowns in equilibrium with the others. */
static void lemke_settle_free(const lemke_run *s, int load, double *u) {
  const lemke_work *w = s->w;
  int n = w->reduced.n_free;
  for (int pass = 0; pass < 2 && n > 0; ++pass) {
    lemke_respond(s, u, load, w->raw);
    for (int k = 0; k < n; ++k) w->v[k] = -w->raw[w->reduced.free_id[k]];
    contact_product(n, w->reduced.inner, w->v, w->t);
    for (int k = 0; k < n; ++k) u[w->reduced.free_id[k]] += w->t[k];
  }
}

/* base[m] of the work: the state at z = 0. */
static void lemke_set_base(lemke_run *s) {
  const contact_problem *cp = s->cp;
  lemke_work *w = s->w;
  memset(w->reduced.base, 0, (size_t)cp->m * sizeof *w->reduced.base);
  if (!lemke_is_stiff(s)) return;
  for (int dof = 0; dof < cp->m; ++dof) {
    if (w->kind[dof] == IS_BOUND) w->reduced.base[dof] = contact_bound(cp, dof);
    if (w->kind[dof] == IS_FRICTION)
      w->reduced.base[dof] = contact_stick(cp, dof);
    if (w->kind[dof] == IS_HELD)
      w->reduced.base[dof] = cp->f[dof] / contact_diagonal(cp, dof);
  }
  lemke_settle_free(s, 1, w->reduced.base);
}

/* w of every variable from raw, scaled as the matrix is; z: scaled, for the
 * compliance form. */
static void slacks(const lemke_run *s, const double *raw, const double *z,
                   double *to) {
  const contact_problem *cp = s->cp;
  const lemke_work *w = s->w;
  int stiff = lemke_is_stiff(s);
  for (int a = 0; a < w->reduced.n_var; ++a) {
    const variable *v = w->var + a;
    double unit = w->unit * w->reduced.D[v->node_id], g0 = 0.0;
    int dof = w->reduced.kept[v->dof];
    if (v->type == BOUND)
      to[a] = unit * (stiff ? -raw[dof] : contact_bound(cp, dof) - raw[dof]);
    if (lemke_has_limit(s, v)) g0 = cp->g0[v->node_id];
    if (v->type == LIMIT) to[a] = g0 / w->reduced.D[v->node_id];
    if (v->type != SLIDE) continue;
    double sum =
        g0 + v->e[0] * (raw[dof] - (stiff ? 0.0 : contact_stick(cp, dof)));
    if (v->e[1] != 0.0)
      sum +=
          v->e[1] * (raw[dof + 1] - (stiff ? 0.0 : contact_stick(cp, dof + 1)));
    to[a] = unit * sum;
  }
  lemke_add_limits(s, z, to);
}

/* x += the motion (forces) of z on the unknowns kept, unscaled. */
static void lemke_add_motion(const lemke_work *w, const double *z, double *x) {
  for (int a = 0; a < w->reduced.n_var; ++a) {
    const variable *v = w->var + a;
    double size = w->reduced.D[v->node_id] * z[a];
    if (v->type == LIMIT || size == 0.0) continue;
    x[w->reduced.kept[v->dof]] += v->e[0] * size;
    if (v->e[1] != 0.0) x[w->reduced.kept[v->dof + 1]] += v->e[1] * size;
  }
}

/* x = the state at z. */
static void lemke_state_of(const lemke_run *s, const double *z, double *x) {
  memcpy(x, s->w->reduced.base, (size_t)s->cp->m * sizeof *x);
  lemke_add_motion(s->w, z, x);
  lemke_settle_free(s, 1, x);
}

/* q and d of the complementarity problem. */
static void lemke_set_vectors(lemke_run *s) {
  lemke_work *w = s->w;
  memset(w->z, 0, (size_t)w->reduced.n_var * sizeof *w->z);
  lemke_respond(s, w->reduced.base, 1, w->raw);
  slacks(s, w->raw, w->z, w->q);
  for (int a = 0; a < w->reduced.n_var; ++a) w->d[a] = 1.0;
  if (lemke_is_stiff(s)) lemke_add_limits(s, w->z, w->d);
}

/* Correct z by the residual of the rows of the final basis with the given
 * matrix. */
static void polish(lemke_run *s, double *x) {
  lemke_work *w = s->w;
  lcp_values(w->lcp, w->z);
  lemke_state_of(s, w->z, x);
  for (int pass = 0; pass < POLISH; ++pass) {
    lemke_respond(s, x, 1, w->raw);
    slacks(s, w->raw, w->z, w->q);
    lcp_correction(w->lcp, w->q, w->dz);
    for (int a = 0; a < w->reduced.n_var; ++a)
      w->z[a] = fmax(0.0, w->z[a] + w->dz[a]);
    lemke_state_of(s, w->z, x);
  }
  lemke_respond(s, x, 1, w->raw);
}

/* Stiffness form: r from raw with the conditions of the basis enforced
 * exactly. */
static void clean_forces(const lemke_run *s, double *r) {
  const contact_problem *cp = s->cp;
  const lemke_work *w = s->w;
  for (int dof = 0; dof < cp->m; ++dof)
    r[dof] = w->kind[dof] == IS_FRICTION ? w->raw[dof] : 0.0;
  for (int a = 0; a < w->reduced.n_var; ++a) {
    int dof = w->reduced.kept[w->var[a].dof];
    if (w->var[a].type == BOUND && !lcp_row_is_tight(w->lcp, a))
      r[dof] = fmin(w->raw[dof], 0.0);
  }
  for (int a = 0; a < w->reduced.n_var; ++a) {
    const variable *v = w->var + a;
    int dof = w->reduced.kept[v->dof];
    if (v->type != SLIDE || w->node.n_slide[v->node_id] != 2) continue;
    double g = contact_node_limit(cp, r, v->node_id);
    if (lcp_row_is_tight(w->lcp, a) || v->e[0] * r[dof] < -g)
      r[dof] = -g * v->e[0];
  }
}

/* Compliance form: u from raw, closed and sticking nodes put in place. */
static void clean_motion(const lemke_run *s, double *u) {
  const contact_problem *cp = s->cp;
  const lemke_work *w = s->w;
  memcpy(u, w->raw, (size_t)cp->m * sizeof *u);
  for (int a = 0; a < w->reduced.n_var; ++a) {
    const variable *v = w->var + a;
    int dof = w->reduced.kept[v->dof],
        closed = w->z[w->node.normal[v->node_id]] > 0.0;
    if (v->type == BOUND)
      u[dof] = w->z[a] > 0.0 ? contact_bound(cp, dof)
                             : fmin(u[dof], contact_bound(cp, dof));
    if (v->type != LIMIT || w->z[a] > 0.0 || !closed) continue;
    u[dof] = contact_stick(cp, dof);
    if (w->var[a - 1].e[1] != 0.0) u[dof + 1] = contact_stick(cp, dof + 1);
  }
}

/* u[m], r[m] of the final basis. */
static void lemke_set_solution(lemke_run *s, double *u, double *r) {
  if (lemke_is_stiff(s)) {
    polish(s, u);
    clean_forces(s, r);
  } else {
    polish(s, r);
    clean_motion(s, u);
  }
}

/* ---- rays: is the motion at the end of the path free, and does the load do
 * more work on it than friction takes. */

static const double RAY_DEFECT = 1e-8;  /* -, forces a free motion may cause */
static const double RAY_WORK = 0x1p-30; /* -, margin of the work of the load */

/* 1: the motion w->ray causes no force, and the load does more work on it than
 * "resistance", N m. */
static int motion_is_free(lemke_run *s, double resistance) {
  const contact_problem *cp = s->cp;
  lemke_work *w = s->w;
  double force = 0.0, size = 0.0, work = 0.0;
  lemke_respond(s, w->ray, 0, w->raw);
  for (int dof = 0; dof < cp->m; ++dof) {
    force = fmax(force, fabs(w->raw[dof]));
    size = fmax(size, contact_diagonal(cp, dof) * fabs(w->ray[dof]));
    work += cp->f[dof] * w->ray[dof];
  }
  return force <= RAY_DEFECT * size && work > 0.0 &&
         work > resistance * (1.0 - RAY_WORK);
}

/* STOPPED_RAY if the ray is a free motion, against the limits of the state it
 * starts from. */
static outcome lemke_check_ray(lemke_run *s) {
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

/* 0: a load on free unknowns that nothing resists: the ray is its direction. */
static int lemke_load_is_held(lemke_run *s) {
  lemke_work *w = s->w;
  double worst = 0.0;
  if (w->reduced.n_free == 0 || !s->cp->floating) return 1;
  lemke_respond(s, w->reduced.base, 1, w->raw);
  memset(w->ray, 0, (size_t)s->cp->m * sizeof *w->ray);
  for (int k = 0; k < w->reduced.n_free; ++k) {
    int dof = w->reduced.free_id[k];
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

typedef struct lemke {
  int facets; /* of the friction polygon, 3-D; 0: 8 */
} lemke;

/* clang-format off */
static const option lemke_options[] = {
  OPTION_INT(lemke, facets, "FACETS", 4, 64, "8", "-",
             "facets of the friction cone of the first stage in 3-D; even"),
  OPTION_END
};
/* clang-format on */

static const solver_ops *const correctors[N_CORRECTOR] = {&newton_solver,
                                                          &sor_solver};

static void lemke_release(void *work) {
  lemke_work *w = work;
  if (w == NULL) return;
  for (int i = 0; i < N_CORRECTOR; ++i) {
    if (w->corrector.ops[i] != NULL)
      w->corrector.ops[i]->release(w->corrector.work[i]);
    memory_free(w->corrector.param[i]);
  }
  lcp_free(w->lcp);
  RELEASE(w->reduced.S, w->reduced.inner, w->spare, w->reduced.D,
          w->reduced.tame, w->reduced.base, w->raw, w->v, w->t, w->ray, w->work,
          w->best_u, w->best_r, w->reduced.kept, w->reduced.free_id, w->pivot,
          w->kind, w->node.normal, w->node.slide, w->node.n_slide, w->var, w->q,
          w->d, w->z, w->dz, w);
}

static status set_up_correctors(const contact_problem *cp, lemke_work *w) {
  for (int i = 0; i < N_CORRECTOR; ++i) {
    const solver_ops *ops = correctors[i];
    if ((ops->handles & NEEDS_STIFFNESS) && !contact_has_stiffness(cp))
      continue;
    char *param = NULL;
    PASS_NEW(param, ops->param_size + 1);
    w->corrector.param[i] = param;
    w->corrector.ops[i] = ops;
    option_defaults(ops->options, param);
    PASS(ops->setup(cp, param, &w->corrector.work[i]));
  }
  return OK;
}

static status lemke_setup(const contact_problem *cp, const void *par,
                          void **work) {
  lemke_work *w;
  const lemke *p = par;
  size_t m = (size_t)cp->m;
  PASS_NEW(w, 1);
  *work = w;
  w->m = cp->m;
  w->facets = p->facets >= 4 ? p->facets + p->facets % 2 : 8;
  int n_var = cp->n * (cp->dim == 2 ? 4 : w->facets + 2);
  PASS_NEW_REALS(m, &w->reduced.base, &w->raw, &w->v, &w->t, &w->ray,
                 &w->best_u, &w->best_r);
  PASS_NEW_REALS(n_var, &w->q, &w->d, &w->z, &w->dz);
  PASS_NEW_ALL(OF(w->reduced.kept, 2 * m), OF(w->reduced.free_id, 2 * m),
               OF(w->pivot, 2 * m), OF(w->kind, 2 * m),
               OF(w->node.normal, 2 * m), OF(w->node.slide, 2 * m),
               OF(w->node.n_slide, 2 * m));
  PASS_NEW_ALL(OF(w->reduced.S, m * m), OF(w->reduced.inner, m * m),
               OF(w->spare, cp->floating ? m * m : 0));
  PASS_NEW_ALL(OF(w->work, 4 * m + 4), OF(w->reduced.D, cp->n),
               OF(w->reduced.tame, cp->n), OF(w->var, n_var));
  PASS(lcp_new(n_var, contact_has_stiffness(cp) ? cp->m : cp->m + 2 * cp->n,
               &w->lcp));
  PASS(set_up_correctors(cp, w));
  return OK;
}

/* The outcome; from the state of a polygon to that of the disc, and from
 * rounding where obstacles travel far, by a solver of the problem itself. */
static status correct(lemke_run *s, double *u, double *r, solver_report *rep) {
  lemke_work *w = s->w;
  size_t bytes = (size_t)s->cp->m * sizeof *u;
  rep->residual = contact_residual(s->cp, u, r);
  if (rep->residual <= s->control->tol) return OK;
  rep->outcome = STOPPED_STAGNATION;
  memcpy(w->best_u, u, bytes);
  memcpy(w->best_r, r, bytes);
  for (int i = 0; i < N_CORRECTOR && rep->outcome != CONVERGED; ++i) {
    solver_report inner = {.outcome = RUNNING};
    if (w->corrector.ops[i] == NULL) continue;
    memcpy(u, w->best_u, bytes);
    memcpy(r, w->best_r, bytes);
    PASS(w->corrector.ops[i]->solve(s->cp, w->corrector.param[i],
                                    w->corrector.work[i], s->control, u, r,
                                    &inner));
    rep->iterations += inner.iterations;
    rep->residual = contact_residual(s->cp, u, r);
    rep->outcome = rep->residual <= s->control->tol ? CONVERGED : inner.outcome;
  }
  return OK;
}

static void report_pivot(const void *ctx, int pivot, double z0) {
  const lemke_run *s = ctx;
  solver_report_states(s->control, "lemke", pivot, z0, 1, 0);
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
  lcp_problem p = {.n = w->reduced.n_var, .q = w->q, .d = w->d, .ctx = s};
  p.max_pivots = s->control->max_iter;
  p.product = lemke_product;
  p.row = lemke_row;
  p.each = report_pivot;
  lcp_run(w->lcp, &p, &rep);
  *count += rep.pivots;
  return rep.outcome == STOPPED_RAY ? lemke_check_ray(s) : rep.outcome;
}

static status lemke_solve(const contact_problem *cp, const void *par,
                          void *work, const solver_control *control, double *u,
                          double *r, solver_report *rep) {
  lemke_work *w = work;
  lemke_run s = {cp, w, control, contact_matrix(cp)};
  (void)par;
  *rep = (solver_report){.outcome = STOPPED_SINGULAR};
  w->has_ray = 0;
  if (!prepare(&s)) return OK;
  rep->outcome = STOPPED_RAY;
  if (!lemke_load_is_held(&s)) return OK;
  rep->outcome = follow(&s, &rep->iterations);
  if (rep->outcome != CONVERGED) return OK;
  lemke_set_solution(&s, u, r);
  PASS(correct(&s, u, r, rep));
  return OK;
}

static status lemke_keep(void *work, archive *a) {
  status st = OK;
  lemke_work *w = work;
  for (int i = 0; i < N_CORRECTOR && st == OK; ++i) {
    if (w->corrector.ops[i] == NULL || w->corrector.ops[i]->keep == NULL)
      continue;
    archive_enter(a, w->corrector.ops[i]->name);
    st = w->corrector.ops[i]->keep(w->corrector.work[i], a);
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
    "motion that proves there is none. In 3-D the cone has FACETS facets. A\n"
    "state that misses the tolerance, as that of facets does, is corrected by\n"
    "NEWTON or SOR. For up to some hundred contact nodes, and where other\n"
    "methods disagree or fail.",
  .handles = SOLVES_TRESCA | SOLVES_COULOMB | SOLVES_3D | SOLVES_FLOATING,
  .entries = "METHOD=LEMKE, which pivots on columns,",
  .param_size = sizeof(lemke),
  .options = lemke_options,
  .setup = lemke_setup,
  .solve = lemke_solve,
  .release = lemke_release,
  .keep = lemke_keep
};
/* clang-format on */
