/*
 * The linear complementarity problem as equations (De Luca, Facchinei, Kanzow
 * 1996): with the function of Fischer and Burmeister
 *
 *   phi_i = sqrt(z_i^2 + w_i^2) - z_i - w_i,   w = q + M z,
 *
 * phi = 0 says z, w >= 0, z_i w_i = 0. Newton's direction where it descends on
 * |phi|^2/2, that of Levenberg and Marquardt where not; a step may raise it
 * above the last values but not above their largest. The basis z_i > w_i of an
 * iterate is tried: its solution is exact; of a singular basis the solution
 * nearest to the iterate. Then the iterate itself.
 */
#include "base/memory.h"
#include "contact/contact.h"
#include "solver/lcp/lcp_solve.h"
#include "solver/lcp/nonnegative.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <string.h>

/* ---- Least squares without negative factors ----------------------------- */

status nonnegative_new(int rows, nonnegative *s) {
  size_t n = (size_t)rows;
  *s = (nonnegative){.rows = rows};
  PASS_NEW_ALL(OF(s->b, n), OF(s->rest, n), OF(s->G, n * n), OF(s->Q, n * n),
               OF(s->x, n), OF(s->y, n), OF(s->work, 4 * n));
  return OK;
}

void nonnegative_free(nonnegative *s) {
  RELEASE(s->b, s->rest, s->G, s->Q, s->x, s->y, s->work);
}

void nonnegative_begin(nonnegative *s) {
  s->n = 0;
  memcpy(s->rest, s->b, (size_t)s->rows * sizeof *s->rest);
}

double *nonnegative_next(const nonnegative *s) {
  return s->n < s->rows ? s->G + (size_t)s->rows * (size_t)s->n : NULL;
}

/* y[n]: factors of the columns for b[rows] by least squares; 0: not possible.
 */
static int fit(nonnegative *s, const double *b) {
  int rows = s->rows;
  memcpy(s->Q, s->G, (size_t)rows * (size_t)s->n * sizeof *s->Q);
  memcpy(s->y, b, (size_t)rows * sizeof *s->y);
  return LAPACKE_dgels_work(LAPACK_COL_MAJOR, 'N', rows, s->n, 1, s->Q, rows,
                            s->y, rows, s->work, 4 * rows) == 0;
}

static void drop(nonnegative *s, int j) {
  size_t rows = (size_t)s->rows;
  --s->n;
  memmove(s->G + rows * (size_t)j, s->G + rows * (size_t)(j + 1),
          rows * (size_t)(s->n - j) * sizeof *s->G);
  memmove(s->x + j, s->x + j + 1, (size_t)(s->n - j) * sizeof *s->x);
}

/* From x towards y while no factor is negative; factors that become zero are
 * dropped. 1: y is reached. */
static int go(nonnegative *s) {
  double share = 1.0;
  int end = -1;
  for (int j = 0; j < s->n; ++j) {
    double may = s->y[j] < 0.0 ? s->x[j] / (s->x[j] - s->y[j]) : 1.0;
    if (!(s->y[j] < 0.0) || (end >= 0 && !(may < share))) continue;
    share = may;
    end = j;
  }
  for (int j = 0; j < s->n; ++j) s->x[j] += share * (s->y[j] - s->x[j]);
  if (end < 0) return 1;
  drop(s, end);
  return s->n == 0;
}

static void subtract(nonnegative *s, const double *x) {
  cblas_dgemv(CblasColMajor, CblasNoTrans, s->rows, s->n, -1.0, s->G, s->rows,
              x, 1, 1.0, s->rest, 1);
}

/* The rest is made normal to the columns twice, for its direction where little
 * is left. */
int nonnegative_take(nonnegative *s) {
  if (s->n == s->rows) return 0;
  s->x[s->n++] = 0.0;
  do {
    if (!fit(s, s->b)) return 0;
  } while (!go(s));
  memcpy(s->rest, s->b, (size_t)s->rows * sizeof *s->rest);
  subtract(s, s->x);
  if (s->n > 0 && fit(s, s->rest)) subtract(s, s->y);
  return 1;
}

double lcp_residual(const lcp_data *p, const double *z, double *w) {
  double c = 0.0, scale = 0.0, worst = 0.0;
  size_t n = (size_t)p->n;
  contact_product(p->n, p->M, z, w);
  for (size_t k = 0; k < n * n; ++k) c = fmax(c, fabs(p->M[k]));
  for (size_t i = 0; i < n; ++i) {
    w[i] += p->q[i];
    scale = fmax(scale, fabs(p->q[i]));
    double violation = fabs(fmin(c * z[i], w[i]));
    if (!(violation <= worst)) worst = violation;
    if (isnan(w[i]) || isnan(z[i])) return NAN;
  }
  if (scale > 0.0) return worst / scale;
  return worst > 0.0 ? HUGE_VAL : 0.0;
}

enum {
  STEPS = 100, /* from a start */
  LEAST_STARTS = 24,
  MOST_STARTS = 3000,
  MEMORY = 5,    /* last values a step is compared with */
  HALVINGS = 30, /* of a step */
  PERIOD = 5     /* steps from one basis that is tried to the next */
};
static const double WORK = 1e10;      /* operations of all starts */
static const double RANK = 0x1p-40;   /* -, of a singular basis */
static const double DESCENT = 1e-9;   /* -, of |g| |d| */
static const double MARGIN = 0x1p-30; /* -, of a vector that separates */
static const double ENOUGH = 1e-4;    /* -, of the slope (Armijo) */

typedef struct run {
  const lcp_data *p;
  double tol;
  int most;                    /* steps, all starts; 0: no limit */
  double unit;                 /* of z: largest |q| over largest |M| */
  double *size;                /* [n] units: M and q below have diagonal 1, |q|
                                  <= 1 */
  double *M, *q;               /* [n*n], [n] */
  double *z, *w;               /* [n] in these units */
  double *phi, *a, *b, *d, *g; /* [n] */
  double *J;                   /* [n*n] */
  int *pivot, *basis;          /* [n] */
  double *N;                   /* [n*n] normal equations */
  double *work;                /* [lwork] of LAPACK */
  int lwork;
  double *answer, *slack; /* [n] in the units of the problem */
} run;

static status run_new(run *s) {
  size_t n = (size_t)s->p->n;
  PASS_NEW_REALS(n, &s->size, &s->q, &s->z, &s->w, &s->phi, &s->a, &s->b, &s->d,
                 &s->g, &s->answer, &s->slack);
  PASS_NEW_ALL(OF(s->M, n * n), OF(s->J, n * n), OF(s->pivot, n),
               OF(s->basis, n), OF(s->N, n * n));
  s->lwork = 64 * (s->p->n + 1);
  PASS_NEW(s->work, s->lwork);
  return OK;
}

static void run_free(run *s) {
  RELEASE(s->size, s->q, s->z, s->w, s->phi, s->a, s->b, s->d, s->g, s->answer,
          s->slack, s->M, s->J, s->pivot, s->basis, s->N, s->work);
}

/* Units that bring the largest of each row and column near one. */
static void scale(run *s) {
  size_t n = (size_t)s->p->n;
  double most = 0.0;
  for (size_t i = 0; i < n; ++i) {
    double largest = fabs(s->p->M[i + n * i]);
    for (size_t j = 0; j < n && largest == 0.0; ++j)
      largest = fmax(largest,
                     fmax(fabs(s->p->M[i + n * j]), fabs(s->p->M[j + n * i])));
    s->size[i] = largest > 0.0 ? 1.0 / sqrt(largest) : 1.0;
    most = fmax(most, fabs(s->p->q[i]) * s->size[i]);
  }
  s->unit = most > 0.0 ? most : 1.0;
  for (size_t j = 0; j < n; ++j) {
    s->q[j] = s->p->q[j] * s->size[j] / s->unit;
    for (size_t i = 0; i < n; ++i)
      s->M[i + n * j] = s->p->M[i + n * j] * s->size[i] * s->size[j];
  }
}

/* ---- a basis ------------------------------------------------------------- */

static int solves(run *s) {
  return lcp_residual(s->p, s->answer, s->slack) <= s->tol;
}

/* M of the basis (1: z_i free) into s->J; its size. */
static int gather_basis(run *s) {
  size_t n = (size_t)s->p->n, to = 0;
  int k = 0;
  for (size_t j = 0; j < n; ++j) {
    k += s->basis[j];
    for (size_t i = 0; i < n && s->basis[j]; ++i)
      if (s->basis[i]) s->J[to++] = s->p->M[i + n * j];
  }
  return k;
}

/* z of the basis: M_BB z_B = -q_B. 1: it solves the problem; s->answer then is
 * z. */
static int basis_solves(run *s) {
  int n = s->p->n, k = gather_basis(s);
  for (int i = 0, row = 0; i < n; ++i)
    if (s->basis[i]) s->d[row++] = -s->p->q[i];
  if (k > 0 && LAPACKE_dgesv_work(LAPACK_COL_MAJOR, k, 1, s->J, k, s->pivot,
                                  s->d, k) != 0)
    return 0;
  for (int i = 0, row = 0; i < n; ++i)
    s->answer[i] = s->basis[i] ? s->d[row++] : 0.0;
  return solves(s);
}

/* The same by the least change of s->answer, for a singular M_BB. */
static int nearest_solves(run *s) {
  int n = s->p->n, k, rank;
  for (int i = 0; i < n; ++i)
    s->answer[i] =
        s->basis[i] ? fmax(0.0, s->z[i] * s->size[i] * s->unit) : 0.0;
  if (solves(s)) return 1;
  k = gather_basis(s);
  if (k == 0) return 0;
  for (int i = 0, row = 0; i < n; ++i)
    if (s->basis[i]) s->d[row++] = -s->slack[i];
  memset(s->pivot, 0, (size_t)k * sizeof *s->pivot);
  if (LAPACKE_dgelsy_work(LAPACK_COL_MAJOR, k, k, 1, s->J, k, s->d, k, s->pivot,
                          RANK, &rank, s->work, s->lwork) != 0)
    return 0;
  for (int i = 0, row = 0; i < n; ++i)
    if (s->basis[i]) s->answer[i] = fmax(0.0, s->answer[i] + s->d[row++]);
  return solves(s);
}

static int basis_of_iterate_solves(run *s) {
  for (int i = 0; i < s->p->n; ++i) s->basis[i] = s->z[i] > s->w[i];
  return basis_solves(s) || nearest_solves(s);
}

/* ---- Newton -------------------------------------------------------------- */

/* w and phi at z; returns |phi|^2/2. */
static double evaluate(run *s) {
  int n = s->p->n;
  memcpy(s->w, s->q, (size_t)n * sizeof *s->w);
  cblas_dgemv(CblasColMajor, CblasNoTrans, n, n, 1.0, s->M, n, s->z, 1, 1.0,
              s->w, 1);
  for (int i = 0; i < n; ++i) {
    double sum = s->z[i] + s->w[i], length = hypot(s->z[i], s->w[i]);
    /* without cancellation where both are positive */
    s->phi[i] =
        sum > 0.0 ? -2.0 * s->z[i] * s->w[i] / (length + sum) : length - sum;
  }
  return 0.5 * cblas_ddot(n, s->phi, 1, s->phi, 1);
}

/* d = -inv(J'J + |phi| I) g, else -g. */
static void regular_direction(run *s) {
  int n = s->p->n;
  double size = cblas_dnrm2(n, s->phi, 1);
  for (int i = 0; i < n; ++i) s->d[i] = -s->g[i];
  cblas_dsyrk(CblasColMajor, CblasLower, CblasTrans, n, n, 1.0, s->J, n, 0.0,
              s->N, n);
  for (int i = 0; i < n; ++i) s->N[(size_t)i * (size_t)(n + 1)] += size;
  LAPACKE_dposv_work(LAPACK_COL_MAJOR, 'L', n, 1, s->N, n, s->d, n);
}

/* J = diag(a) + diag(b) M, g = J'phi, d = -inv(J) phi or as above. Returns
 * g.d. */
static double direction(run *s) {
  int n = s->p->n;
  size_t ld = (size_t)n;
  for (int i = 0; i < n; ++i) {
    double length = hypot(s->z[i], s->w[i]);
    s->a[i] = (length > 0.0 ? s->z[i] / length : sqrt(0.5)) - 1.0;
    s->b[i] = (length > 0.0 ? s->w[i] / length : sqrt(0.5)) - 1.0;
    s->d[i] = -s->phi[i];
  }
  for (size_t j = 0; j < ld; ++j) {
    for (size_t i = 0; i < ld; ++i)
      s->J[i + ld * j] = s->b[i] * s->M[i + ld * j];
    s->J[j + ld * j] += s->a[j];
  }
  cblas_dgemv(CblasColMajor, CblasTrans, n, n, 1.0, s->J, n, s->phi, 1, 0.0,
              s->g, 1);
  memcpy(s->N, s->J, ld * ld * sizeof *s->N);
  int fails = LAPACKE_dgesv_work(LAPACK_COL_MAJOR, n, 1, s->N, n, s->pivot,
                                 s->d, n) != 0;
  double slope = cblas_ddot(n, s->g, 1, s->d, 1);
  double sizes = cblas_dnrm2(n, s->g, 1) * cblas_dnrm2(n, s->d, 1);
  if (!fails && slope < -DESCENT * sizes) return slope;
  regular_direction(s);
  return cblas_ddot(n, s->g, 1, s->d, 1);
}

/* Along d; "bound": the largest of the last values. 0: no step descends. */
static int line_search(run *s, double bound, double slope, double *value) {
  double t = 1.0, taken = 0.0;
  for (int k = 0; k < HALVINGS; ++k, t *= 0.5) {
    cblas_daxpy(s->p->n, t - taken, s->d, 1, s->z, 1);
    taken = t;
    *value = evaluate(s);
    if (*value <= bound + ENOUGH * t * slope) return 1;
  }
  return 0;
}

/* From z; 1: solved. */
static int descend(run *s, int *steps) {
  double last[MEMORY], value = evaluate(s);
  for (int k = 0; k < MEMORY; ++k) last[k] = value;
  for (int k = 0; k < STEPS && !(s->most > 0 && *steps >= s->most); ++k) {
    double bound = 0.0;
    if (k % PERIOD == 0 && basis_of_iterate_solves(s)) return 1;
    double slope = direction(s);
    for (int i = 0; i < MEMORY; ++i) bound = fmax(bound, last[i]);
    ++*steps;
    if (!(slope < 0.0) || !line_search(s, bound, slope, &value)) break;
    last[k % MEMORY] = value;
    if (value <= s->tol * s->tol) break;
  }
  return basis_of_iterate_solves(s);
}

/* Start k: zero, max(-q, 0), then a fixed series of sparse vectors of growing
 * size. */
static void start(run *s, int k, unsigned *seed) {
  double size = ldexp(1.0, k / 3 % 10 - 2);
  for (int i = 0; i < s->p->n; ++i) {
    *seed = *seed * 1664525u + 1013904223u;
    double random = (double)(*seed >> 8) * 0x1p-24;
    s->z[i] = k == 0   ? 0.0
              : k == 1 ? fmax(0.0, -s->q[i])
                       : fmax(0.0, size * (2.0 * random - 1.0));
  }
}

status lcp_newton(const lcp_data *p, const lcp_control *control, double *z,
                  int *steps, int *found) {
  ENDS_BY(run_free)
  run s = {.p = p, .tol = control->tol, .most = control->max_iter};
  unsigned seed = 7;
  *found = 0;
  PASS(run_new(&s));
  scale(&s);
  double n = p->n, most = WORK / (n * n * n * STEPS);
  int starts = (int)fmin(MOST_STARTS, fmax(LEAST_STARTS, most));
  for (int k = 0; k < starts && !*found; ++k) {
    if (s.most > 0 && *steps >= s.most) break;
    start(&s, k, &seed);
    *found = descend(&s, steps);
  }
  if (*found) memcpy(z, s.answer, (size_t)p->n * sizeof *z);
  return OK;
}

/* Column j of a basis: of w_j, or of z_j, in q = w - M z. */
static void column_of(const run *s, int j, double *to) {
  size_t n = (size_t)s->p->n;
  for (size_t i = 0; i < n; ++i)
    to[i] = s->basis[j] ? -s->M[i + n * (size_t)j] : (int)i == j;
}

/* 1: q is no sum of the columns of the basis, by a margin: a vector separates
 * it from them. */
static int excludes(run *s, nonnegative *sum) {
  int n = s->p->n;
  double *column, *rest = sum->rest, before = HUGE_VAL;
  memcpy(sum->b, s->q, (size_t)n * sizeof *sum->b);
  nonnegative_begin(sum);
  while ((column = nonnegative_next(sum)) != NULL) {
    double left = cblas_dnrm2(n, rest, 1), most = 0.0;
    if (!(left > MARGIN && left < before)) return 0;
    before = left;
    int best = -1;
    for (int j = 0; j < n; ++j) {
      column_of(s, j, column);
      double size = cblas_dnrm2(n, column, 1);
      double does = size > 0.0 ? cblas_ddot(n, column, 1, rest, 1) / size : 0.0;
      if (does > most) best = j;
      most = fmax(most, does);
    }
    if (best < 0 || most <= MARGIN * left) return 1;
    column_of(s, best, column);
    if (!nonnegative_take(sum)) return 0;
  }
  return 0;
}

static void set_basis(run *s, int set) {
  for (int i = 0; i < s->p->n; ++i) s->basis[i] = set >> i & 1;
}

status lcp_all_bases(const lcp_data *p, double tol, double *z, outcome *end) {
  ENDS_BY(run_free) run s = {.p = p, .tol = tol};
  ENDS_BY(nonnegative_free) nonnegative sum = {0};
  int found = 0, excluded = 1, n_set = 1 << p->n;
  *end = STOPPED_STAGNATION;
  PASS(run_new(&s));
  PASS(nonnegative_new(p->n, &sum));
  for (int set = 0; set < n_set && !found; ++set) {
    set_basis(&s, set);
    found = basis_solves(&s);
  }
  if (found) {
    *end = CONVERGED;
    memcpy(z, s.answer, (size_t)p->n * sizeof *z);
    return OK;
  }
  scale(&s);
  for (int set = 0; set < n_set && excluded; ++set) {
    set_basis(&s, set);
    excluded = excludes(&s, &sum);
  }
  if (excluded) *end = STOPPED_RAY;
  return OK;
}
