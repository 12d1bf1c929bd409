/*
 * The theta-method for any law, one equilibrium at the end of the step:
 *   y_new = y_old + dt f(x_th),   x_th = (1 - theta) x_old + theta x_new,
 * x = (sigma, e^i, alpha) and the time and temperature likewise. For a given
 * strain e the unknowns e^i, alpha of a point follow from a local Newton
 * iteration with (M from the Jacobian of the law, sigma = E (e - e^i))
 *   M = I - theta dt [J_ee - J_es E, J_ea; -J_as E, J_aa],
 * and the consistent tangent is D = E (I - [inv(M) theta dt (J_es; J_as) E]_e).
 * The body is solved with D until the stresses of the points are those of the
 * linear law: quadratic convergence; or with D = E, never factored again.
 */
#include "scheme/work.h"

#include "base/memory.h"

#include <lapacke.h>
#include <math.h>
#include <string.h>

enum { MOST_LOCAL = 60, MOST_TANGENT = 40, MOST_INITIAL = 2000 };
static const double local_tol = 1e-13;

/* Room for one point, n = ns + most_alpha unknowns. */
typedef struct local {
  int ns, na, n;
  double e[6], sigma[6], ei[6]; /* at the theta-point; e of the end         */
  double *alpha;                /* [na] at the theta-point                   */
  double *y, *old, *f, *trial;  /* [n] e^i and alpha                         */
  double *M, *X;                /* [n*n], [n*ns]                             */
  int *pivot;                   /* [n]                                       */
  double E[36]; /* [ns*ns] at the end of the step, Pa                         */
  law_jacobian j;
  double value[FLOW_VALUE_MAX];
  law_point p;
  double *room;
} local;

static status local_new(const flow *x, local *l) {
  status st = OK;
  int ns = x->ns, na = x->most_alpha, n = ns + na;
  memset(l, 0, sizeof *l);
  NEW(l->pivot, n);
  NEW(l->room,
      na + 4 * n + n * n + n * ns + 2 * ns * ns + 2 * ns * na + na * na);
  l->alpha = l->room;
  l->y = l->alpha + na;
  l->old = l->y + n;
  l->f = l->old + n;
  l->trial = l->f + n;
  l->M = l->trial + n;
  l->X = l->M + n * n;
  l->j.ei_sigma = l->X + n * ns;
  l->j.ei_ei = l->j.ei_sigma + ns * ns;
  l->j.ei_alpha = l->j.ei_ei + ns * ns;
  l->j.alpha_sigma = l->j.ei_alpha + ns * na;
  l->j.alpha_alpha = l->j.alpha_sigma + na * ns;
done:
  return st;
}

static void local_free(local *l) {
  memory_free(l->room);
  memory_free(l->pivot);
}

/* Point k with its start values; coefficients at the theta-point. */
static status local_begin(const flow *x, const scheme_step *p, int k,
                          const flow_state *old, const flow_state *now,
                          local *l) {
  status st = OK;
  const double th = p->theta;
  size_t at = (size_t)x->ns * (size_t)k;
  flow_kind *kind = &x->kind[x->kind_id[k]];
  double T = (1 - th) * old->temperature[k] + th * now->temperature[k];
  TRY(flow_heat(kind, now->temperature[k]));
  memcpy(l->E, kind->elastic.E, (size_t)(x->ns * x->ns) * sizeof *l->E);
  TRY(flow_coefficients(kind, old->t + th * p->dt, T, l->value, &l->p));
  l->p.dt = p->dt;
  l->ns = x->ns;
  l->na = kind->n_alpha;
  l->n = l->ns + l->na;
  l->p.sigma = l->sigma;
  l->p.ei = l->ei;
  l->p.alpha = l->alpha;
  memcpy(l->e, now->e + at, (size_t)l->ns * sizeof *l->e);
  memcpy(l->old, old->ei + at, (size_t)l->ns * sizeof *l->old);
  memcpy(l->old + l->ns, old->alpha + x->alpha_at[k],
         (size_t)l->na * sizeof *l->old);
  memcpy(l->y, l->old, (size_t)l->n * sizeof *l->y);
done:
  return st;
}

/* The theta-point of y; sigma_old[ns]. */
static void local_place(const scheme_step *p, const double *sigma_old,
                        const double *y, local *l) {
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

/* f = old + dt rates - y at the point of y; largest magnitude of its strains.
 */
static double local_residual(const scheme_step *p, const double *sigma_old,
                             const double *y, local *l, double *f) {
  double worst = 0.0;
  local_place(p, sigma_old, y, l);
  law_rate(&l->p, f, f + l->ns);
  for (int i = 0; i < l->n; ++i) {
    f[i] = l->old[i] + p->dt * f[i] - y[i];
    if (i < l->ns) worst = fmax(worst, fabs(f[i]));
    if (!isfinite(f[i])) return HUGE_VAL;
  }
  return worst;
}

/* M[n*n] and X[n*ns] = theta dt (J_es; J_as) E at the point. */
static void local_matrix(const scheme_step *p, local *l) {
  const double h = p->theta * p->dt, *E = l->E;
  const int ns = l->ns, na = l->na, n = l->n;
  law_jacobian_at(&l->p, &l->j);
  memset(l->X, 0, (size_t)(n * ns) * sizeof *l->X);
  memset(l->M, 0, (size_t)(n * n) * sizeof *l->M);
  for (int c = 0; c < ns; ++c)
    for (int q = 0; q < ns; ++q) {
      double factor = h * E[q + ns * c];
      for (int i = 0; i < ns; ++i)
        l->X[i + n * c] += l->j.ei_sigma[i + ns * q] * factor;
      for (int i = 0; i < na; ++i)
        l->X[ns + i + n * c] += l->j.alpha_sigma[i + na * q] * factor;
    }
  for (int c = 0; c < ns; ++c) {
    for (int i = 0; i < n; ++i) l->M[i + n * c] = l->X[i + n * c];
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
static int local_update(const scheme_step *p, const double *sigma_old,
                        const double *f, double *residual, local *l) {
  for (double part = 1.0; part > 1e-4; part /= 2) {
    for (int i = 0; i < l->n; ++i) l->trial[i] = l->y[i] + part * f[i];
    double left = local_residual(p, sigma_old, l->trial, l, l->f);
    if (left > *residual && part > 2e-4) continue;
    if (!isfinite(left)) return 0;
    memcpy(l->y, l->trial, (size_t)l->n * sizeof *l->y);
    *residual = left;
    return 1;
  }
  return 0;
}

/* Largest strain at hand, the scale of the residual. */
static double local_scale(const local *l) {
  double scale = 0.0;
  for (int i = 0; i < l->ns; ++i)
    scale = fmax(scale, fmax(fabs(l->e[i]), fabs(l->old[i])));
  return scale;
}

/* Newton iteration of one point; *solved = 0 if it fails. */
static void local_solve(const scheme_step *p, const double *sigma_old, local *l,
                        int *solved) {
  double residual = local_residual(p, sigma_old, l->y, l, l->f);
  const double enough = local_tol * local_scale(l);
  for (int k = 0; k < MOST_LOCAL && residual > enough; ++k) {
    double before = residual;
    local_matrix(p, l);
    memcpy(l->trial, l->f, (size_t)l->n * sizeof *l->f);
    if (LAPACKE_dgesv(LAPACK_COL_MAJOR, l->n, 1, l->M, l->n, l->pivot, l->trial,
                      l->n) != 0)
      break;
    memcpy(l->X, l->trial, (size_t)l->n * sizeof *l->X);
    if (!local_update(p, sigma_old, l->X, &residual, l)) break;
    /* Rounding: no progress at a level that is as good as nothing. */
    if (residual >= before && residual <= 1e3 * enough) break;
  }
  if (residual > 1e4 * enough) *solved = 0;
}

/* 1: no rate at the theta-point of the old e^i and alpha, which are then the
 * new ones, and D = E: exactly what the iteration would end with. */
static int local_rests(const scheme_step *p, const double *sigma_old,
                       local *l) {
  local_place(p, sigma_old, l->old, l);
  return isfinite(tensor_dot(l->ns, l->sigma, l->sigma)) && !law_flows(&l->p);
}

/* D[ns*ns] at the solution. */
static status local_tangent(const scheme_step *p, local *l, double *D) {
  status st = OK;
  const int ns = l->ns, n = l->n;
  const double *E = l->E;
  local_matrix(p, l);
  if (LAPACKE_dgesv(LAPACK_COL_MAJOR, n, ns, l->M, n, l->pivot, l->X, n) != 0)
    FAIL(ERR_SINGULAR, "the step of an inelastic law has no solution");
  for (int j = 0; j < ns; ++j)
    for (int i = 0; i < ns; ++i) {
      double sum = E[i + ns * j];
      for (int q = 0; q < ns; ++q) sum -= E[i + ns * q] * l->X[q + n * j];
      D[i + ns * j] = sum;
    }
  /* The stiffness is symmetric: so is what the iteration takes. */
  for (int j = 0; j < ns; ++j)
    for (int i = 0; i < j; ++i)
      D[i + ns * j] = D[j + ns * i] = 0.5 * (D[i + ns * j] + D[j + ns * i]);
done:
  return st;
}

/* All points for now->e: ei, alpha, sigma, the power of the step; w->D[ns*ns*n]
 * unless the iteration is that of initial stresses. */
static status solve_points(const scheme_call *a, local *l) {
  status st = OK;
  const flow *x = a->x;
  const size_t ns = (size_t)x->ns;
  a->out->dissipated = 0.0;
  for (int k = 0; k < x->n; ++k) {
    const size_t at = ns * (size_t)k;
    double elastic[6];
    TRY(local_begin(x, a->p, k, a->old, a->now, l));
    int rests = local_rests(a->p, a->old->sigma + at, l);
    if (!rests) local_solve(a->p, a->old->sigma + at, l, &a->out->settled);
    if (!a->out->settled) goto done;
    local_place(a->p, a->old->sigma + at, l->y, l);
    a->out->dissipated += a->p->dt * x->weight[k] * law_dissipation(&l->p);
    memcpy(a->now->ei + at, l->y, ns * sizeof *l->y);
    memcpy(a->now->alpha + x->alpha_at[k], l->y + ns,
           (size_t)l->na * sizeof *l->y);
    for (size_t i = 0; i < ns; ++i) elastic[i] = l->e[i] - l->y[i];
    tensor_product(x->ns, l->E, elastic, a->now->sigma + at);
    if (a->p->initial) continue;
    if (rests)
      memcpy(a->w->D + ns * at, l->E, ns * ns * sizeof *l->E);
    else
      TRY(local_tangent(a->p, l, a->w->D + ns * at));
  }
done:
  return st;
}

/* Stresses of the linear law at now->e: linear[ns*n]; the scale of their
 * misfit, from them and from the elastic stresses of the strains. */
static status linear_stress(const flow *x, const flow_tangent *law,
                            const flow_state *now, double *linear,
                            double *scale) {
  status st = OK;
  const int ns = x->ns;
  double sum = 0.0;
  for (int k = 0; k < x->n; ++k) {
    const size_t at = (size_t)ns * (size_t)k;
    flow_kind *kind = &x->kind[x->kind_id[k]];
    TRY(flow_heat(kind, now->temperature[k]));
    const double *E = kind->elastic.E;
    const double *D = law->elastic ? E : law->D + (size_t)ns * at;
    double step[6], change[6], whole[6];
    for (size_t i = 0; i < (size_t)ns; ++i)
      step[i] = now->e[at + i] - law->e[at + i];
    tensor_product(ns, D, step, change);
    tensor_product(ns, E, now->e + at, whole);
    add_scaled((size_t)ns, law->sigma + at, 1.0, change, linear + at);
    sum += x->weight[k] * (tensor_dot(ns, whole, whole) +
                           tensor_dot(ns, linear + at, linear + at));
  }
  *scale = sqrt(sum);
done:
  return st;
}

/* Misfit of the stresses and of those of the linear law, over the scale. */
static double misfit(const flow *x, const flow_state *now, const double *linear,
                     double scale) {
  double sum = 0.0;
  for (int k = 0; k < x->n; ++k)
    for (size_t i = 0; i < (size_t)x->ns; ++i) {
      size_t at = (size_t)x->ns * (size_t)k + i;
      double d = now->sigma[at] - linear[at];
      sum += x->weight[k] * d * d;
    }
  return scale > 0.0 ? sqrt(sum) / scale : 0.0;
}

static status need_room(const flow *x, const scheme_step *p, scheme_work *w) {
  status st = OK;
  size_t n = (size_t)x->ns * (size_t)x->n;
  TRY(need(&w->sigma_k, n));
  TRY(need(&w->e_k, n));
  TRY(need(&w->linear, n));
  if (!p->initial) TRY(need(&w->D, n * (size_t)x->ns));
done:
  return st;
}

status newton_advance(const scheme_call *a) {
  status st = OK;
  const flow *x = a->x;
  const scheme_step *p = a->p;
  const size_t bytes = (size_t)x->ns * (size_t)x->n * sizeof(double);
  const int most = p->initial ? MOST_INITIAL : MOST_TANGENT;
  scheme_work *w = a->w;
  scheme_result *out = a->out;
  local l = {0};
  TRY(local_new(x, &l));
  TRY(need_room(x, p, w));
  a->now->t = p->t;
  TRY(a->b->begin(a->b->ctx, a->now));
  memcpy(a->now->e, a->old->e, bytes);
  flow_tangent law = {
      .elastic = p->initial, .D = w->D, .sigma = w->sigma_k, .e = w->e_k};
  TRY(solve_points(a, &l));
  while (out->settled && out->iterations < most) {
    memcpy(w->sigma_k, a->now->sigma, bytes);
    memcpy(w->e_k, a->now->e, bytes);
    TRY(a->b->linear(a->b->ctx, &law, a->now, &out->settled));
    ++out->iterations;
    if (!out->settled) goto done;
    double scale = 0.0;
    TRY(linear_stress(x, &law, a->now, w->linear, &scale));
    TRY(solve_points(a, &l));
    if (!out->settled || misfit(x, a->now, w->linear, scale) <= p->tol)
      goto done;
  }
  out->settled = 0;
done:
  local_free(&l);
  return st;
}
