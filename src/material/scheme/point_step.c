/*
 * A point over a step of the theta-method (newton.c): for a given strain e the
 * unknowns y = (e^i, alpha) follow from a local Newton iteration with (M from
 * the Jacobian of the law, sigma = E (e - e^i))
 *   M = I - theta dt [J_ee - J_es E, J_ea; -J_as E, J_aa],
 * and the consistent tangent is D = E (I - [inv(M) theta dt (J_es; J_as) E]_e).
 * What the laws make of a change ds of the stresses of a step, in the norms of
 * energy (CPR98, Theorem 3.2): |Q ds|_E <= q |ds|_inv(E) with the largest
 * singular value q of R Q R, R R = E.
 */
#include "material/scheme/point_step.h"

#include "base/memory.h"

#include <lapacke.h>
#include <math.h>
#include <string.h>

enum { MOST_LOCAL = 60, MOST_PARTS = 1000 };
static const double point_tol = 1e-13, alpha_tol = 1e-10; /* - */

status point_step_new(const flow *x, point_step *l) {
  int ns = x->ns, na = x->most_alpha, n = ns + na;
  memset(l, 0, sizeof *l);
  PASS_NEW(l->pivot, n);
  PASS_NEW(l->work,
           na + 5 * n + n * n + n * ns + 2 * ns * ns + 2 * ns * na + na * na);
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

void point_step_free(point_step *l) { RELEASE(l->work, l->pivot); }

/* Point k with its start values; coefficients at the theta-point. */
status point_step_begin(const flow *x, const scheme_step *p, int k,
                        const flow_state *old, const flow_state *now,
                        point_step *l) {
  const double th = p->theta;
  size_t at = (size_t)x->ns * (size_t)k;
  flow_kind *kind = &x->kind[x->kind_id[k]];
  double T = (1 - th) * old->temperature[k] + th * now->temperature[k];
  PASS(flow_heat(kind, now->temperature[k]));
  memcpy(l->E, kind->elastic.E, (size_t)(x->ns * x->ns) * sizeof *l->E);
  PASS(flow_coefficients(kind, old->t + th * p->dt, T, l->value, &l->p));
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
  return OK;
}

/* The theta-point of y; sigma_old[ns]. */
void point_step_place(const scheme_step *p, const double *sigma_old,
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

/* f = old + dt rates - y at the point of y; largest magnitude of its strains.
 */
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
  memset(l->X, 0, (size_t)(n * ns) * sizeof *l->X);
  memset(l->M, 0, (size_t)(n * n) * sizeof *l->M);
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
    memcpy(l->y, l->trial, (size_t)l->n * sizeof *l->y);
    *residual = left;
    return 1;
  }
  return 0;
}

/* Largest current strain, the scale of the residual. */
static double point_scale(const point_step *l) {
  double scale = 0.0;
  for (int i = 0; i < l->ns; ++i)
    scale = fmax(scale, fmax(fabs(l->e[i]), fabs(l->old[i])));
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
  const double enough = point_tol * point_scale(l);
  for (int k = 0; k < MOST_LOCAL; ++k) {
    if (residual <= enough && alpha_misfit(l) <= alpha_tol) return 1;
    double before = residual;
    point_matrix(p, l->E, l);
    memcpy(l->trial, l->f, (size_t)l->n * sizeof *l->f);
    if (LAPACKE_dgesv(LAPACK_COL_MAJOR, l->n, 1, l->M, l->n, l->pivot, l->trial,
                      l->n) != 0)
      break;
    memcpy(l->X, l->trial, (size_t)l->n * sizeof *l->X);
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
  const size_t bytes = (size_t)l->n * sizeof *l->y;
  scheme_step part = *p;
  double grow = 10.0, done = 0.0;
  memcpy(l->y, l->old, bytes);
  double first = point_residual(p, sigma_old, l->y, l, l->f);
  if (!(first < HUGE_VAL)) return 0;
  part.dt *= fmin(1.0, 0.01 * point_scale(l) / first);
  for (int k = 0; k < MOST_PARTS && grow > 1.01; ++k) {
    memcpy(l->kept, l->y, bytes);
    if (point_newton(&part, sigma_old, l)) {
      if (part.dt == p->dt) return 1;
      done = part.dt;
    } else {
      memcpy(l->y, l->kept, bytes);
      grow = sqrt(grow);
    }
    part.dt = done > 0.0 ? fmin(p->dt, grow * done) : part.dt / 10.0;
  }
  return 0;
}

void point_step_solve(const scheme_step *p, const double *sigma_old,
                      point_step *l, int *solved) {
  if (!point_newton(p, sigma_old, l) && !point_follow(p, sigma_old, l))
    *solved = 0;
}

/* 1: no rate at the theta-point of the old e^i and alpha, which are then the
 * new ones, and D = E: exactly what the iteration would end with. */
int point_step_rests(const flow *x, const scheme_step *p,
                     const double *sigma_old, point_step *l) {
  point_step_place(p, sigma_old, l->old, l);
  return isfinite(tensor_dot(l->ns, l->sigma, l->sigma)) &&
         !flow_goes_on(x, &l->p);
}

/* D[ns*ns] at the solution. */
status point_step_tangent(const scheme_step *p, point_step *l, double *D) {
  const int ns = l->ns, n = l->n;
  const double *E = l->E;
  point_matrix(p, l->E, l);
  if (LAPACKE_dgesv(LAPACK_COL_MAJOR, n, ns, l->M, n, l->pivot, l->X, n) != 0)
    RAISE(ERR_SINGULAR, "the step of an inelastic law has no solution");
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
  return OK;
}

/* Q[ns*ns] = d(e^i)/d(sigma) at the end of a step that has been made, for
 * given stresses: with J at the theta-point (0 where nothing flows)
 *   Q = [inv(I - theta dt J_yy) theta dt J_ys]_e.   ERR_SINGULAR */
static status compliance_at(const flow *x, const scheme_step *p, int k,
                            const flow_state *old, const flow_state *now,
                            point_step *l, double *Q) {
  const size_t at = (size_t)x->ns * (size_t)k;
  PASS(point_step_begin(x, p, k, old, now, l));
  const int ns = l->ns, n = l->n;
  memset(Q, 0, (size_t)(ns * ns) * sizeof *Q);
  memcpy(l->y, now->ei + at, (size_t)ns * sizeof *l->y);
  memcpy(l->y + ns, now->alpha + x->alpha_at[k], (size_t)l->na * sizeof *l->y);
  point_step_place(p, old->sigma + at, l->y, l);
  if (!law_flows(&l->p)) return OK;
  point_matrix(p, NULL, l);
  if (LAPACKE_dgesv(LAPACK_COL_MAJOR, n, ns, l->M, n, l->pivot, l->X, n) != 0)
    RAISE(ERR_SINGULAR, "the step of an inelastic law has no solution");
  for (int j = 0; j < ns; ++j)
    memcpy(Q + ns * j, l->X + n * j, (size_t)ns * sizeof *Q);
  return OK;
}

/* R[n*n] with R R = E, symmetric and positive semidefinite. */
static int square_root(int n, const double *E, double *R) {
  double V[36], w[6], work[36];
  memcpy(V, E, (size_t)(n * n) * sizeof *V);
  memset(R, 0, (size_t)(n * n) * sizeof *R);
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
  status st = OK;
  const size_t square = (size_t)(x->ns * x->ns);
  point_step l = {0};
  *largest = 0.0;
  TRY(point_step_new(x, &l));
  for (int k = 0; k < x->n; ++k) {
    double size = 0.0, *own = Q + square * (size_t)k;
    TRY(compliance_at(x, p, k, old, now, &l, own));
    TRY(energy_size(x->ns, l.E, own, &size));
    *largest = fmax(*largest, size);
  }
done:
  point_step_free(&l);
  return st;
}
