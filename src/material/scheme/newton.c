/*
 * The theta-method for any law, one equilibrium at the end of the step:
 *   y_new = y_old + dt f(x_th),   x_th = (1 - theta) x_old + theta x_new,
 * x = (sigma, e^i, alpha) and the time and temperature likewise. The points
 * follow their strains; the body is solved with their consistent
 * tangents until the stresses of the points are those of the linear law:
 * quadratic convergence; or with D = E, never factored again. Points of linear
 * laws whose coefficients vary have the map of the step instead (linear.c) with
 * those of the theta-point, unless their elasticity varies too.
 */
#include "base/base.h"
#include "material/scheme/work.h"

#include <lapacke.h>

/*
 * A point: for a given strain e the unknowns y = (e^i, alpha) follow from a
 * local Newton iteration with (M from the Jacobian of the law, sigma = E (e -
 * e^i)) M = I - theta dt [J_ee - J_es E, J_ea; -J_as E, J_aa], and the
 * consistent tangent is D = E (I - [inv(M) theta dt (J_es; J_as) E]_e). What
 * the laws make of a change ds of the stresses of a step, in the norms of
 * energy (CPR98, Theorem 3.2): |Q ds|_E <= q |ds|_inv(E) with the largest
 * singular value q of R Q R, R R = E.
 */
enum { MOST_LOCAL = 60, MOST_PARTS = 1000 };
static const double point_tol = 1e-13, alpha_tol = 1e-10; /* - */

/* Workspace of one point, n = ns + most_alpha unknowns. */
typedef struct point_step {
  int ns, na, n;
  double e[6], sigma[6], ei[6];       /* at the theta-point; e of the end */
  double *alpha;                      /* [na] at the theta-point */
  double *y, *old, *f, *trial, *kept; /* [n] e^i and alpha */
  double *M, *X;                      /* [n*n], [n*ns] */
  int *pivot;                         /* [n] */
  double E[36], bulk;                 /* of point_elasticity(), [ns*ns], Pa */
  law_jacobian j;
  double value[FLOW_VALUE_MAX];
  law_point p;
  double *work;
} point_step;

static status point_step_new(const flow *x, point_step *l) {
  int ns = x->ns, na = x->most_alpha, n = ns + na;
  PASS_NEW_ALL(OF(l->pivot, n),
               OF(l->work, na + 5 * n + n * n + n * ns + 2 * ns * ns +
                               2 * ns * na + na * na));
  l->alpha = l->work;
  l->y = l->alpha + na;
  l->old = l->y + n;
  l->f = l->old + n;
  l->trial = l->f + n;
  l->kept = l->trial + n;
  l->M = l->kept + n;
  l->X = l->M + n * n;
  l->j.ei_sigma = l->X + n * ns;
  l->j.ei_ei = l->j.ei_sigma + ns * ns;
  l->j.ei_alpha = l->j.ei_ei + ns * ns;
  l->j.alpha_sigma = l->j.ei_alpha + ns * na;
  l->j.alpha_alpha = l->j.alpha_sigma + na * ns;
  return OK;
}

/* The elasticity at the end of the step as l->E + l->bulk m m', m = (1, 1, 1,
 * 0, ...), with Lame's constants diag(2 G) + lambda m m': near nu = 1/2 the
 * rounding of the bulk part would hide what flows under a deviator. */
static void point_elasticity(const flow_kind *kind, point_step *l) {
  const law_elastic *el = &kind->elastic;
  const int ns = el->ns;
  COPY(l->E, el->E, ns * ns);
  l->bulk = 0.0;
  if (kind->law->ops->linear || el->plane_stress) return;
  l->bulk = el->E[1];
  for (int k = 0; k < 9; ++k) l->E[k % 3 + ns * (k / 3)] -= l->bulk;
}

/* Point k with its start values; coefficients at the theta-point. */
static status point_step_begin(const flow *x, const scheme_step *p, int k,
                               const flow_state *old, const flow_state *now,
                               point_step *l) {
  const double th = p->theta;
  size_t at = (size_t)x->ns * k;
  flow_kind *kind = &x->kind[x->kind_id[k]];
  double T = (1 - th) * old->temperature[k] + th * now->temperature[k];
  PASS(flow_heat(kind, now->temperature[k]));
  point_elasticity(kind, l);
  PASS(flow_at_point(kind, old->t + th * p->dt, T, l->value, &l->p));
  l->p.dt = p->dt;
  l->ns = x->ns;
  l->na = kind->n_alpha;
  l->n = l->ns + l->na;
  l->p.sigma = l->sigma;
  l->p.ei = l->ei;
  l->p.alpha = l->alpha;
  COPY(l->e, now->e + at, l->ns);
  COPY(l->old, old->ei + at, l->ns);
  COPY(l->old + l->ns, old->alpha + x->alpha_at[k], l->na);
  COPY(l->y, l->old, l->n);
  return OK;
}

/* The theta-point of y, its stress without the bulk part; sigma_old[ns]. */
static void point_step_place(const scheme_step *p, const double *sigma_old,
                             const double *y, point_step *l) {
  const double th = p->theta;
  double elastic[6], sigma[6];
  for (int i = 0; i < l->ns; ++i) elastic[i] = l->e[i] - y[i];
  tensor_product(l->ns, l->E, elastic, sigma);
  for (int i = 0; i < l->ns; ++i) {
    l->sigma[i] = (1 - th) * sigma_old[i] + th * sigma[i];
    l->ei[i] = (1 - th) * l->old[i] + th * y[i];
  }
  for (int i = 0; i < l->na; ++i)
    l->alpha[i] = (1 - th) * l->old[l->ns + i] + th * y[l->ns + i];
}

/* f = old + dt rates - y at y; largest magnitude of its strains. */
static double point_residual(const scheme_step *p, const double *sigma_old,
                             const double *y, point_step *l, double *f) {
  double worst = 0.0;
  point_step_place(p, sigma_old, y, l);
  law_rate(&l->p, f, f + l->ns);
  for (int i = 0; i < l->n; ++i) {
    f[i] = l->old[i] + p->dt * f[i] - y[i];
    if (i < l->ns) worst = fmax(worst, fabs(f[i]));
    if (!isfinite(f[i])) return HUGE_VAL;
  }
  return worst;
}

/* M[n*n] and X[n*ns] = theta dt (J_es; J_as) E at the point; E NULL: the same
 * where the stress is given, not the strain. */
static void point_matrix(const scheme_step *p, const double *E, point_step *l) {
  const double h = p->theta * p->dt;
  const int ns = l->ns, na = l->na, n = l->n;
  law_jacobian_at(&l->p, &l->j);
  CLEAR(l->X, n * ns);
  CLEAR(l->M, n * n);
  for (int c = 0; c < ns; ++c)
    for (int q = 0; q < ns; ++q) {
      double factor = h * (E != NULL ? E[q + ns * c] : q == c);
      for (int i = 0; i < ns; ++i)
        l->X[i + n * c] += l->j.ei_sigma[i + ns * q] * factor;
      for (int i = 0; i < na; ++i)
        l->X[ns + i + n * c] += l->j.alpha_sigma[i + na * q] * factor;
    }
  for (int c = 0; c < ns; ++c) {
    for (int i = 0; i < n && E != NULL; ++i) l->M[i + n * c] = l->X[i + n * c];
    for (int i = 0; i < ns; ++i) l->M[i + n * c] -= h * l->j.ei_ei[i + ns * c];
  }
  for (int c = 0; c < na; ++c) {
    for (int i = 0; i < ns; ++i)
      l->M[i + n * (ns + c)] = -h * l->j.ei_alpha[i + ns * c];
    for (int i = 0; i < na; ++i)
      l->M[ns + i + n * (ns + c)] = -h * l->j.alpha_alpha[i + na * c];
  }
  for (int i = 0; i < n; ++i) l->M[i + n * i] += 1.0;
}

/* The step along f, cut until the residual is not larger; 0 if none is. */
static int point_update(const scheme_step *p, const double *sigma_old,
                        const double *f, double *residual, point_step *l) {
  for (double part = 1.0; part > 1e-4; part /= 2) {
    for (int i = 0; i < l->n; ++i) l->trial[i] = l->y[i] + part * f[i];
    double left = point_residual(p, sigma_old, l->trial, l, l->f);
    if (left > *residual && part > 2e-4) continue;
    if (!isfinite(left)) return 0;
    COPY(l->y, l->trial, l->n);
    *residual = left;
    return 1;
  }
  return 0;
}

/* Largest current strain, the scale of the residual: that of y where an old
 * stress flows and the strain is zero. */
static double point_scale(const point_step *l) {
  double scale = 0.0;
  for (int i = 0; i < l->ns; ++i)
    scale =
        fmax(scale, fmax(fabs(l->e[i]), fmax(fabs(l->old[i]), fabs(l->y[i]))));
  return scale;
}

/* Largest misfit of alpha in l->f over the largest alpha. */
static double alpha_misfit(const point_step *l) {
  double worst = 0.0, scale = 0.0;
  for (int i = l->ns; i < l->n; ++i) {
    worst = fmax(worst, fabs(l->f[i]));
    scale = fmax(scale, fmax(fabs(l->y[i]), fabs(l->old[i])));
  }
  return worst > 0.0 ? worst / scale : 0.0;
}

/* Newton iteration of one point from l->y; 0 if it fails. */
static int point_newton(const scheme_step *p, const double *sigma_old,
                        point_step *l) {
  double residual = point_residual(p, sigma_old, l->y, l, l->f);
  double enough = 0.0;
  for (int k = 0; k < MOST_LOCAL; ++k) {
    enough = point_tol * point_scale(l);
    if (residual <= enough && alpha_misfit(l) <= alpha_tol) return 1;
    double before = residual;
    point_matrix(p, l->E, l);
    COPY(l->trial, l->f, l->n);
    if (LAPACKE_dgesv(LAPACK_COL_MAJOR, l->n, 1, l->M, l->n, l->pivot, l->trial,
                      l->n) != 0)
      break;
    COPY(l->X, l->trial, l->n);
    if (!point_update(p, sigma_old, l->X, &residual, l)) break;
    /* Rounding: no progress at a negligible level. */
    if (residual >= before && residual <= 1e3 * enough) break;
  }
  return residual <= 1e4 * enough && alpha_misfit(l) <= 1e4 * alpha_tol;
}

/*
 * Rates that are high powers of the stress: Newton's method takes one power of
 * e off the rate with each iteration, or fails. The same for steps dt, growing
 * from one that changes little, each from the solution of the last.
 */
static int point_follow(const scheme_step *p, const double *sigma_old,
                        point_step *l) {
  scheme_step part = *p;
  double grow = 10.0, done = 0.0;
  COPY(l->y, l->old, l->n);
  double first = point_residual(p, sigma_old, l->y, l, l->f);
  if (!(first < HUGE_VAL)) return 0;
  part.dt *= fmin(1.0, 0.01 * point_scale(l) / first);
  for (int k = 0; k < MOST_PARTS && grow > 1.01; ++k) {
    COPY(l->kept, l->y, l->n);
    if (point_newton(&part, sigma_old, l)) {
      if (part.dt == p->dt) return 1;
      done = part.dt;
    } else {
      COPY(l->y, l->kept, l->n);
      grow = sqrt(grow);
    }
    part.dt = done > 0.0 ? fmin(p->dt, grow * done) : part.dt / 10.0;
  }
  return 0;
}

/* Newton iteration of one point for l->e, from and into l->y, without the
 * volume that its tolerance leaves; *solved = 0 if it fails. */
static void point_step_solve(const scheme_step *p, const double *sigma_old,
                             point_step *l, int *solved) {
  if (!point_newton(p, sigma_old, l) && !point_follow(p, sigma_old, l))
    *solved = 0;
  const double volume = tensor_trace(l->y) - tensor_trace(l->old);
  for (int i = 0; i < 3 && !l->p.law->ops->linear; ++i) l->y[i] -= volume / 3.0;
}

/* 1: no rate at the theta-point of the old e^i and alpha, which are then the
 * new ones, and D = E: exactly what the iteration would end with. */
static int point_step_rests(const flow *x, const scheme_step *p,
                            const double *sigma_old, point_step *l) {
  point_step_place(p, sigma_old, l->old, l);
  return isfinite(dot(l->ns, l->sigma, l->sigma)) && !flow_goes_on(x, &l->p);
}

/* D[ns*ns] at the solution. */
static status point_step_tangent(const scheme_step *p, point_step *l,
                                 double *D) {
  const int ns = l->ns, n = l->n;
  point_matrix(p, l->E, l);
  if (LAPACKE_dgesv(LAPACK_COL_MAJOR, n, ns, l->M, n, l->pivot, l->X, n) != 0)
    RAISE(ERR_SINGULAR, "the step of an inelastic law has no solution");
  for (int j = 0; j < ns; ++j)
    for (int i = 0; i < ns; ++i) {
      double sum = l->E[i + ns * j] + (i < 3 && j < 3 ? l->bulk : 0.0);
      for (int q = 0; q < ns; ++q) sum -= l->E[i + ns * q] * l->X[q + n * j];
      D[i + ns * j] = sum;
    }
  /* The stiffness is symmetric: so is what the iteration takes. */
  for (int j = 0; j < ns; ++j)
    for (int i = 0; i < j; ++i)
      D[i + ns * j] = D[j + ns * i] = 0.5 * (D[i + ns * j] + D[j + ns * i]);
  return OK;
}

/* Q[ns*ns] = d(e^i)/d(sigma) at the end of a step that has been made, for
 * given stresses: with J at the theta-point (0 where nothing flows)
 *   Q = [inv(I - theta dt J_yy) theta dt J_ys]_e.   ERR_SINGULAR */
static status compliance_at(const flow *x, const scheme_step *p, int k,
                            const flow_state *old, const flow_state *now,
                            point_step *l, double *Q) {
  const size_t at = (size_t)x->ns * k;
  PASS(point_step_begin(x, p, k, old, now, l));
  const int ns = l->ns, n = l->n;
  CLEAR(Q, ns * ns);
  COPY(l->y, now->ei + at, ns);
  COPY(l->y + ns, now->alpha + x->alpha_at[k], l->na);
  point_step_place(p, old->sigma + at, l->y, l);
  if (!law_flows(&l->p)) return OK;
  point_matrix(p, NULL, l);
  if (LAPACKE_dgesv(LAPACK_COL_MAJOR, n, ns, l->M, n, l->pivot, l->X, n) != 0)
    RAISE(ERR_SINGULAR, "the step of an inelastic law has no solution");
  for (int j = 0; j < ns; ++j) COPY(Q + ns * j, l->X + n * j, ns);
  return OK;
}

/* R[n*n] with R R = E, symmetric and positive semidefinite. */
static int square_root(int n, const double *E, double *R) {
  double V[36], w[6], work[36];
  COPY(V, E, n * n);
  CLEAR(R, n * n);
  if (LAPACKE_dsyev_work(LAPACK_COL_MAJOR, 'V', 'U', n, V, n, w, work, 36) != 0)
    return 0;
  for (int q = 0; q < n; ++q)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        R[i + n * j] += V[i + n * q] * sqrt(fmax(w[q], 0.0)) * V[j + n * q];
  return 1;
}

/* The largest singular value of R Q R. */
static status energy_size(int n, const double *E, const double *Q,
                          double *size) {
  double R[36], QR[36], N[36], w[6], work[36];
  int known = square_root(n, E, R);
  for (int j = 0; j < n; ++j) tensor_product(n, Q, R + n * j, QR + n * j);
  for (int j = 0; j < n; ++j) tensor_product(n, R, QR + n * j, N + n * j);
  if (!known || LAPACKE_dgesvd_work(LAPACK_COL_MAJOR, 'N', 'N', n, n, N, n, w,
                                    NULL, 1, NULL, 1, work, 36) != 0)
    RAISE(ERR_SINGULAR, "the compliance of an inelastic law is no number");
  *size = w[0];
  return OK;
}

status flow_compliance(const flow *x, const scheme_step *p,
                       const flow_state *old, const flow_state *now, double *Q,
                       double *largest) {
  const size_t square = x->ns * x->ns;
  OWNED_PARTS(point_step, l, point_step_new(x, &l));
  *largest = 0.0;
  for (int k = 0; k < x->n; ++k) {
    double size = 0.0, *own = Q + square * k;
    PASS(compliance_at(x, p, k, old, now, &l, own));
    PASS(energy_size(x->ns, x->kind[x->kind_id[k]].elastic.E, own, &size));
    *largest = fmax(*largest, size);
  }
  return OK;
}

enum { MOST_TANGENT = 40, MOST_INITIAL = 2000 };
enum { PATIENCE = 5 }; /* iterations that come no nearer */
/* -, of the stresses, whatever TOL= of the contact: no estimate has this error,
 * and the last iterations of Newton's method are the cheapest. */
static const double stress_tol = 1e-10;

/* Workspace of one point. */
typedef struct point_work {
  point_step l;
  linear_map map; /* of a linear law */
  double D[36];   /* [ns*ns] that it leaves, Pa */
} point_work;

static status point_work_new(const flow *x, point_work *r) {
  PASS(point_step_new(x, &r->l));
  return linear_map_new(x->ns, x->ns + x->most_alpha, &r->map);
}

static int has_map(const flow *x, int k) {
  const flow_kind *kind = &x->kind[x->kind_id[k]];
  return kind->law->ops->linear && kind->elastic.table == NULL;
}

/* Point k by the map: r->l.y and r->D. */
static status follow_map(const scheme_call *a, int k, point_work *r) {
  const flow *x = a->x;
  point_step *l = &r->l;
  flow_kind now = x->kind[x->kind_id[k]];
  if (now.varies != 0) {
    now.value = l->value;
    now.speed = l->p.speed;
  }
  PASS(linear_map_make(&now, a->p, 0, &r->map, r->D));
  linear_at(x, &r->map, k, a->old, l->e, l->y);
  return OK;
}

/* Point k for now->e: r->l.y, and into D[ns*ns] unless it is NULL. */
static status follow_point(const scheme_call *a, int k, point_work *r,
                           double *D) {
  const size_t ns = a->x->ns, bytes = ns * ns * sizeof *D;
  const double *sigma_old = a->old->sigma + ns * k;
  const flow_kind *kind = &a->x->kind[a->x->kind_id[k]];
  point_step *l = &r->l;
  PASS(point_step_begin(a->x, a->p, k, a->old, a->now, l));
  const int maps = has_map(a->x, k);
  const int rests = !maps && point_step_rests(a->x, a->p, sigma_old, l);
  if (maps)
    PASS(follow_map(a, k, r));
  else if (!rests)
    point_step_solve(a->p, sigma_old, l, &a->out->settled);
  a->out->stuck = a->out->settled ? 0 : k + 1;
  if (!a->out->settled) return OK;
  point_step_place(a->p, sigma_old, l->y, l);
  if (D == NULL) return OK;
  if (maps || rests)
    memcpy(D, maps ? r->D : kind->elastic.E, bytes);
  else
    PASS(point_step_tangent(a->p, l, D));
  return OK;
}

/* All points for now->e: ei, alpha, sigma, the power of the step; w->D[ns*ns*n]
 * unless the iteration is that of initial stresses. */
static status solve_points(const scheme_call *a, point_work *r) {
  const flow *x = a->x;
  const size_t ns = x->ns;
  point_step *l = &r->l;
  a->out->dissipated = 0.0;
  for (int k = 0; k < x->n; ++k) {
    const size_t at = ns * k;
    double elastic[6];
    PASS(follow_point(a, k, r, a->p->initial ? NULL : a->w->D + ns * at));
    if (!a->out->settled) return OK;
    a->out->dissipated += a->p->dt * x->weight[k] * law_dissipation(&l->p);
    COPY(a->now->ei + at, l->y, ns);
    COPY(a->now->alpha + x->alpha_at[k], l->y + ns, l->na);
    for (size_t i = 0; i < ns; ++i) elastic[i] = l->e[i] - l->y[i];
    tensor_product(x->ns, l->E, elastic, a->now->sigma + at);
    for (int i = 0; i < 3; ++i)
      a->now->sigma[at + i] += l->bulk * tensor_trace(elastic);
  }
  return OK;
}

/* Stresses of the linear law at now->e: linear[ns*n]; the scale of their
 * misfit, from them and from the elastic stresses of the strains. */
static status linear_stress(const flow *x, const flow_tangent *law,
                            const flow_state *now, double *linear,
                            double *scale) {
  const int ns = x->ns;
  double sum = 0.0;
  for (int k = 0; k < x->n; ++k) {
    const size_t at = (size_t)ns * k;
    flow_kind *kind = &x->kind[x->kind_id[k]];
    PASS(flow_heat(kind, now->temperature[k]));
    const double *D = law->elastic ? kind->elastic.E : law->D + ns * at;
    double step[6], change[6], whole[6];
    for (size_t i = 0; i < (size_t)ns; ++i)
      step[i] = now->e[at + i] - law->e[at + i];
    tensor_product(ns, D, step, change);
    tensor_product(ns, kind->elastic.E, now->e + at, whole);
    sum_scaled(ns, law->sigma + at, 1.0, change, linear + at);
    sum += x->weight[k] *
           (dot(ns, whole, whole) + dot(ns, linear + at, linear + at));
  }
  *scale = sqrt(sum);
  return OK;
}

/* Misfit of the stresses and of those of the linear law, over the scale;
 * *energy: no more than what it stores, by the trace of E, J. */
static double misfit(const flow *x, const flow_state *now, const double *linear,
                     double scale, double *energy) {
  double sum = 0.0;
  *energy = 0.0;
  for (int k = 0; k < x->n; ++k) {
    const double *E = x->kind[x->kind_id[k]].elastic.E;
    double square = 0.0, trace = 0.0;
    for (int i = 0; i < x->ns; ++i) {
      const size_t at = (size_t)x->ns * k + i;
      const double d = now->sigma[at] - linear[at];
      square += d * d;
      trace += E[i + x->ns * i];
    }
    sum += x->weight[k] * square;
    *energy += x->weight[k] * square / (2.0 * trace);
  }
  return scale > 0.0 ? sqrt(sum) / scale : 0.0;
}

status newton_advance(const scheme_call *a) {
  const flow *x = a->x;
  const scheme_step *p = a->p;
  const int most = p->initial ? MOST_INITIAL : MOST_TANGENT;
  const double enough = fmin(p->tol, stress_tol);
  double least = HUGE_VAL;
  int stalled = 0;
  scheme_work *w = a->w;
  scheme_result *out = a->out;
  OWNED_PARTS(point_work, r, point_work_new(x, &r));
  size_t n = (size_t)x->ns * x->n;
  PASS(need(w, &w->sigma_k, n));
  PASS(need(w, &w->e_k, n));
  PASS(need(w, &w->linear, n));
  if (!p->initial) PASS(need(w, &w->D, n * x->ns));
  a->now->t = p->t;
  PASS(a->b->begin(a->b->ctx, a->now));
  COPY(a->now->e, a->old->e, (size_t)x->ns * x->n);
  flow_tangent law = {
      .elastic = p->initial, .D = w->D, .sigma = w->sigma_k, .e = w->e_k};
  PASS(solve_points(a, &r));
  while (out->settled && out->iterations < most) {
    COPY(w->sigma_k, a->now->sigma, (size_t)x->ns * x->n);
    COPY(w->e_k, a->now->e, (size_t)x->ns * x->n);
    PASS(a->b->linear(a->b->ctx, &law, a->now, &out->settled));
    ++out->iterations;
    if (!out->settled) return OK;
    double scale = 0.0, energy = 0.0;
    PASS(linear_stress(x, &law, a->now, w->linear, &scale));
    PASS(solve_points(a, &r));
    const double left = misfit(x, a->now, w->linear, scale, &energy);
    if (!out->settled || left <= enough) return OK;
    if (energy <= a->b->rounding(a->b->ctx)) return OK;
    stalled = left < least ? 0 : stalled + 1;
    least = fmin(least, left);
    /* The contact solver leaves too much. */
    if (stalled >= PATIENCE) law.tol = enough;
  }
  out->settled = 0;
  return OK;
}
