/*
 * Choice of the method for a linear complementarity problem, and the proof if
 * none finds a solution (lcp_solve.h).
 */
#include "solver/lcp/lcp_solve.h"

#include "base/text.h"
#include "contact/contact.h"
#include "solver/lcp/lcp.h"

#include <cblas.h>
#include <lapacke.h>

/*
 * Principal transform of a linear complementarity problem (lcp_solve.h): z_i
 * and w_i change places for a set of unknowns that grows by single ones with a
 * good pivot on the diagonal, or by pairs with two next to it.
 */

static const double GOOD = 0x1p-7; /* -, of the largest entry of the row */

static double entry(int n, const double *M, int i, int j) {
  return M[i + (size_t)n * j];
}

/* y_r and x_c of y = q + M x change places. row[n] */
static void exchange(int n, int r, int c, double *M, double *q, double *row) {
  size_t ld = n;
  double *column = M + ld * c, pivot = column[r], q_r = q[r];
  cblas_dcopy(n, M + r, n, row, 1);
  cblas_dscal(n, 1.0 / pivot, column, 1);
  for (int j = 0; j < n; ++j)
    if (j != c) cblas_daxpy(n, -row[j], column, 1, M + ld * j, 1);
  cblas_daxpy(n, -q_r, column, 1, q, 1);
  for (int j = 0; j < n; ++j) M[r + ld * j] = -row[j] / pivot;
  column[r] = 1.0 / pivot;
  q[r] = -q_r / pivot;
}

static int is_good(int n, const double *M, int i, int j) {
  double largest = fabs(entry(n, M, i, (int)cblas_idamax(n, M + i, n)));
  return fabs(entry(n, M, i, j)) > GOOD * largest;
}

static int draw(unsigned *seed, int count) {
  *seed = *seed * 1664525u + 1013904223u;
  return (int)((*seed >> 8) * 0x1p-24 * count);
}

/* Column to exchange with row i: i itself, or the partner j for which both
 * entries are good, drawn at random; -1: none. */
static int partner(int n, int i, unsigned *seed, const double *M,
                   const unsigned char *turned) {
  int found = -1, count = 0;
  if (is_good(n, M, i, i)) return i;
  for (int j = 0; j < n; ++j) {
    if (j == i || turned[j] || !is_good(n, M, i, j) || !is_good(n, M, j, i))
      continue;
    if (draw(seed, ++count) == 0) found = j;
  }
  return found;
}

/* z_i, z_j with w_i, w_j by the entries next to the diagonal. */
static void exchange_pair(int n, int i, int j, double *M, double *q,
                          double *row) {
  size_t ld = n;
  exchange(n, i, j, M, q, row);
  exchange(n, j, i, M, q, row);
  double keep = q[i];
  q[i] = q[j];
  q[j] = keep;
  cblas_dswap(n, M + i, n, M + j, n);
  cblas_dswap(n, M + ld * i, 1, M + ld * j, 1);
}

void lcp_turn(int n, int want, unsigned *seed, double *M, double *q,
              unsigned char *turned, double *row) {
  for (int k = 0; k < want; ++k) {
    int i = draw(seed, n);
    if (turned[i]) continue;
    int j = partner(n, i, seed, M, turned);
    if (j < 0) continue;
    if (j == i)
      exchange(n, i, i, M, q, row);
    else
      exchange_pair(n, i, j, M, q, row);
    turned[i] = turned[j] = 1;
  }
}

/* ---- Least squares without negative factors ----------------------------- */

status nonnegative_new(int rows, nonnegative *s) {
  size_t n = rows;
  *s = (nonnegative){.rows = rows};
  PASS_NEW_ALL(OF(s->b, n), OF(s->rest, n), OF(s->G, n * n), OF(s->Q, n * n),
               OF(s->x, n), OF(s->y, n), OF(s->work, 4 * n));
  return OK;
}

void nonnegative_begin(nonnegative *s) {
  s->n = 0;
  COPY(s->rest, s->b, s->rows);
}

double *nonnegative_next(const nonnegative *s) {
  return s->n < s->rows ? s->G + (size_t)s->rows * s->n : NULL;
}

/* y[n]: factors of the columns for b[rows] by least squares; 0: impossible. */
static int fit(nonnegative *s, const double *b) {
  int rows = s->rows;
  COPY(s->Q, s->G, (size_t)rows * s->n);
  COPY(s->y, b, rows);
  return LAPACKE_dgels_work(LAPACK_COL_MAJOR, 'N', rows, s->n, 1, s->Q, rows,
                            s->y, rows, s->work, 4 * rows) == 0;
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
  size_t rows = s->rows;
  --s->n;
  memmove(s->G + rows * end, s->G + rows * (end + 1),
          rows * (s->n - end) * sizeof *s->G);
  memmove(s->x + end, s->x + end + 1, (s->n - end) * sizeof *s->x);
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
  COPY(s->rest, s->b, s->rows);
  subtract(s, s->x);
  if (s->n > 0 && fit(s, s->rest)) subtract(s, s->y);
  return 1;
}

/* ---- The problem as equations (De Luca, Facchinei, Kanzow 1996): with the
 * function of Fischer and Burmeister
 *
 *   phi_i = sqrt(z_i^2 + w_i^2) - z_i - w_i,   w = q + M z,
 *
 * phi = 0 says z, w >= 0, z_i w_i = 0. Newton's direction where it descends on
 * |phi|^2/2, that of Levenberg and Marquardt where not; a step may raise it
 * above the last values but not above their largest. The basis z_i > w_i of an
 * iterate is tried: its solution is exact; of a singular basis the solution
 * nearest to the iterate. Then the iterate itself.
 */

/* Units that bring the diagonal to one, or the largest of row and column. */
static double natural_unit(const lcp_data *p, size_t i) {
  size_t n = p->n;
  double largest = fabs(p->M[i + n * i]);
  for (size_t j = 0; j < n && largest == 0.0; ++j)
    largest = fmax(largest, fmax(fabs(p->M[i + n * j]), fabs(p->M[j + n * i])));
  return largest > 0.0 ? 1.0 / sqrt(largest) : 1.0;
}

enum { LCP_MOST_BASES = 14 /* unknowns of which all bases are tried */ };

/* Residual of z, -: largest of |min(z_i c, w_i)| over the rows, c the largest
 * |M|, over the largest |q|. w[n] = q + M z. NaN if one is. */
static double residual_of(const lcp_data *p, const double *z, double *w) {
  double c = 0.0, scale = 0.0, worst = 0.0;
  size_t n = p->n;
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

typedef struct newton_run {
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
} newton_run;

static status newton_new(newton_run *s) {
  size_t n = s->p->n;
  PASS_NEW_REALS(n, &s->size, &s->q, &s->z, &s->w, &s->phi, &s->a, &s->b, &s->d,
                 &s->g, &s->answer, &s->slack);
  PASS_NEW_ALL(OF(s->M, n * n), OF(s->J, n * n), OF(s->pivot, n),
               OF(s->basis, n), OF(s->N, n * n));
  s->lwork = 64 * (s->p->n + 1);
  PASS_NEW(s->work, s->lwork);
  return OK;
}

/* Units that bring the largest of each row and column near one. */
static void scale_problem(newton_run *s) {
  size_t n = s->p->n;
  double most = 0.0;
  for (size_t i = 0; i < n; ++i) {
    s->size[i] = natural_unit(s->p, i);
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

static int solves(newton_run *s) {
  return residual_of(s->p, s->answer, s->slack) <= s->tol;
}

/* M of the basis (1: z_i free) into s->J; its size. */
static int gather_basis(newton_run *s) {
  size_t n = s->p->n, to = 0;
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
static int basis_solves(newton_run *s) {
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
static int nearest_solves(newton_run *s) {
  int n = s->p->n, k, rank;
  for (int i = 0; i < n; ++i)
    s->answer[i] =
        s->basis[i] ? fmax(0.0, s->z[i] * s->size[i] * s->unit) : 0.0;
  if (solves(s)) return 1;
  k = gather_basis(s);
  if (k == 0) return 0;
  for (int i = 0, row = 0; i < n; ++i)
    if (s->basis[i]) s->d[row++] = -s->slack[i];
  CLEAR(s->pivot, k);
  if (LAPACKE_dgelsy_work(LAPACK_COL_MAJOR, k, k, 1, s->J, k, s->d, k, s->pivot,
                          RANK, &rank, s->work, s->lwork) != 0)
    return 0;
  for (int i = 0, row = 0; i < n; ++i)
    if (s->basis[i]) s->answer[i] = fmax(0.0, s->answer[i] + s->d[row++]);
  return solves(s);
}

static int basis_of_iterate_solves(newton_run *s) {
  for (int i = 0; i < s->p->n; ++i) s->basis[i] = s->z[i] > s->w[i];
  return basis_solves(s) || nearest_solves(s);
}

/* ---- Newton -------------------------------------------------------------- */

/* w and phi at z; returns |phi|^2/2. */
static double evaluate(newton_run *s) {
  int n = s->p->n;
  COPY(s->w, s->q, n);
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
static void regular_direction(newton_run *s) {
  int n = s->p->n;
  double size = cblas_dnrm2(n, s->phi, 1);
  for (int i = 0; i < n; ++i) s->d[i] = -s->g[i];
  cblas_dsyrk(CblasColMajor, CblasLower, CblasTrans, n, n, 1.0, s->J, n, 0.0,
              s->N, n);
  for (int i = 0; i < n; ++i) s->N[(size_t)i * (n + 1)] += size;
  LAPACKE_dposv_work(LAPACK_COL_MAJOR, 'L', n, 1, s->N, n, s->d, n);
}

/* J = diag(a) + diag(b) M, g = J'phi, d = -inv(J) phi or as above. Returns
 * g.d. */
static double direction(newton_run *s) {
  int n = s->p->n;
  size_t ld = n;
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
  COPY(s->N, s->J, ld * ld);
  int fails = LAPACKE_dgesv_work(LAPACK_COL_MAJOR, n, 1, s->N, n, s->pivot,
                                 s->d, n) != 0;
  double slope = cblas_ddot(n, s->g, 1, s->d, 1);
  double sizes = cblas_dnrm2(n, s->g, 1) * cblas_dnrm2(n, s->d, 1);
  if (!fails && slope < -DESCENT * sizes) return slope;
  regular_direction(s);
  return cblas_ddot(n, s->g, 1, s->d, 1);
}

/* Along d; "bound": the largest of the last values. 0: no step descends. */
static int line_search(newton_run *s, double bound, double slope,
                       double *value) {
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
static int descend(newton_run *s, int *steps) {
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
static void start(newton_run *s, int k, unsigned *seed) {
  double size = ldexp(1.0, k / 3 % 10 - 2);
  for (int i = 0; i < s->p->n; ++i) {
    *seed = *seed * 1664525u + 1013904223u;
    double random = (*seed >> 8) * 0x1p-24;
    s->z[i] = k == 0   ? 0.0
              : k == 1 ? fmax(0.0, -s->q[i])
                       : fmax(0.0, size * (2.0 * random - 1.0));
  }
}

/* Attempts by Newton's method from many starts. 1 in *found: z is a solution to
 * tol. *steps grows. */
static status lcp_newton(const lcp_data *p, const lcp_control *control,
                         double *z, int *steps, int *found) {
  SCRATCH;
  newton_run s = {.p = p, .tol = control->tol, .most = control->max_iter};
  unsigned seed = 7;
  *found = 0;
  PASS(newton_new(&s));
  scale_problem(&s);
  double n = p->n, most = WORK / (n * n * n * STEPS);
  int starts = (int)fmin(MOST_STARTS, fmax(LEAST_STARTS, most));
  for (int k = 0; k < starts && !*found; ++k) {
    if (s.most > 0 && *steps >= s.most) break;
    start(&s, k, &seed);
    *found = descend(&s, steps);
  }
  if (*found) COPY(z, s.answer, p->n);
  return OK;
}

/* Column j of a basis: of w_j, or of z_j, in q = w - M z. */
static void column_of(const newton_run *s, int j, double *to) {
  size_t n = s->p->n;
  for (size_t i = 0; i < n; ++i)
    to[i] = s->basis[j] ? -s->M[i + n * j] : (int)i == j;
}

/* 1: q is no sum of the columns of the basis, by a margin: a vector separates
 * it from them. */
static int excludes(newton_run *s, nonnegative *sum) {
  int n = s->p->n;
  double *column, *rest = sum->rest, before = HUGE_VAL;
  COPY(sum->b, s->q, n);
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

static void set_basis(newton_run *s, int set) {
  for (int i = 0; i < s->p->n; ++i) s->basis[i] = set >> i & 1;
}

/* All bases: CONVERGED, z is a solution to tol; STOPPED_RAY: each is excluded,
 * there is none; STOPPED_STAGNATION: not known. */
static status lcp_all_bases(const lcp_data *p, double tol, double *z,
                            outcome *end) {
  SCRATCH;
  newton_run s = {.p = p, .tol = tol};
  nonnegative sum;
  int found = 0, excluded = 1, n_set = 1 << p->n;
  *end = STOPPED_STAGNATION;
  PASS(newton_new(&s));
  PASS(nonnegative_new(p->n, &sum));
  for (int set = 0; set < n_set && !found; ++set) {
    set_basis(&s, set);
    found = basis_solves(&s);
  }
  if (found) {
    *end = CONVERGED;
    COPY(z, s.answer, p->n);
    return OK;
  }
  scale_problem(&s);
  for (int set = 0; set < n_set && excluded; ++set) {
    set_basis(&s, set);
    excluded = excludes(&s, &sum);
  }
  if (excluded) *end = STOPPED_RAY;
  return OK;
}

/* ---- the choice --------------------------------------------------------- */

enum { FIRST = 2, ATTEMPTS = 100, FEW_PIVOTS = 50, PIVOTS_A_ROW = 5 };
static const double PROOF = 0x1p-26;    /* -, least work of a certificate */
static const double ROUNDING = 0x1p-44; /* -, of the terms of M'y */

/* ---- a solve ------------------------------------------------------------- */

typedef struct run {
  const lcp_data *p;
  const lcp_control *control;
  lcp_verdict *v;
  double *z, *w;         /* [n] the best so far */
  double *try_z, *y;     /* [n] attempt; [2n] ray, certificate */
  double *cover;         /* [n] covering vector */
  double *size;          /* [n] unit of z_i (and 1/w_i) */
  double *M, *q, *work;  /* [n*n], [n], [n]: in these units, over the cover */
  unsigned char *turned; /* [n] 1: z_i and w_i have changed places */
  unsigned seed;
  int is_first; /* 1: one of the first tries */
} run;

static void note(lcp_verdict *v, const char *who, outcome o) {
  text_add(v->log, LCP_LOG, "%s%s: %s", v->log[0] != '\0' ? ", " : "", who,
           outcome_text(o));
  v->method = who;
}

/* Keep the attempt if it is better; 1: it solves the problem. */
static int keep(run *s) {
  double residual = residual_of(s->p, s->try_z, s->w);
  if (residual < s->v->residual || isnan(s->v->residual)) {
    s->v->residual = residual;
    COPY(s->z, s->try_z, s->p->n);
  }
  return residual <= s->control->tol;
}

/* ---- pivoting ------------------------------------------------------------ */

/* Positive numbers of a fixed series, [0.25, 4). */
static double cover(unsigned *seed) {
  *seed = *seed * 1664525u + 1013904223u;
  return ldexp(1.0 + (*seed >> 8) * 0x1p-24, (int)(*seed >> 6 & 3u) - 2);
}

/* Attempt k: plain; in natural units; other covering vectors, vertices. */
static void choose(run *s, int k) {
  size_t n = s->p->n;
  for (size_t i = 0; i < n; ++i) {
    s->size[i] = k == 0 ? 1.0 : natural_unit(s->p, i);
    s->cover[i] = k < FIRST ? 1.0 : cover(&s->seed);
  }
  for (size_t j = 0; j < n; ++j)
    for (size_t i = 0; i < n; ++i)
      s->M[i + n * j] = s->p->M[i + n * j] * s->size[i] * s->size[j];
  for (size_t i = 0; i < n; ++i) s->q[i] = s->p->q[i] * s->size[i];
  memset(s->turned, 0, n);
  if (k >= FIRST && k % 4 != 0)
    lcp_turn(s->p->n, k % 2 ? 1 : 1 + k / 8, &s->seed, s->M, s->q, s->turned,
             s->work);
}

/* 0: the limit of the method. Where others follow, first attempts are short. */
static int pivots_allowed(const run *s) {
  int most = s->control->max_iter, left = most - s->v->iterations;
  int few = FEW_PIVOTS + PIVOTS_A_ROW * s->p->n;
  if (!s->is_first || s->control->pivoting_only) return most > 0 ? left : 0;
  return most > 0 && left < few ? left : few;
}

/* Lemke's method with a covering vector d is that of the rows over d with a
 * vector of ones. On a ray of the given problem y is its direction. */
static status pivot_once(run *s, lcp_report *rep) {
  size_t n = s->p->n;
  double *slack = s->y + n;
  for (size_t i = 0; i < n; ++i) {
    cblas_dscal((int)n, 1.0 / s->cover[i], s->M + i, (int)n);
    s->q[i] /= s->cover[i];
  }
  PASS(lcp_lemke((int)n, s->M, s->q, pivots_allowed(s), s->try_z, rep));
  contact_product((int)n, s->M, s->try_z, slack);
  for (size_t i = 0; i < n; ++i) {
    if (s->turned[i])
      s->try_z[i] = fmax(0.0, (slack[i] + s->q[i]) * s->cover[i]);
    s->try_z[i] *= s->size[i];
    s->y[i] = s->try_z[i];
  }
  return OK;
}

/* 1: no more pivots and steps are allowed. */
static int is_spent(const run *s) {
  int most = s->control->max_iter;
  return most > 0 && s->v->iterations >= most;
}

/* Attempts number first to last - 1; *o: how the last one ended. */
static status pivot(run *s, int first, int last, outcome *o) {
  lcp_report rep = {.outcome = RUNNING};
  *o = STOPPED_ITERATIONS;
  for (int k = first; k < last && !is_spent(s); ++k) {
    choose(s, k);
    s->is_first = k < FIRST;
    PASS(pivot_once(s, &rep));
    s->v->iterations += rep.pivots;
    *o = CONVERGED;
    if (rep.outcome != STOPPED_RAY && keep(s)) break;
    *o = rep.outcome == CONVERGED ? STOPPED_STAGNATION : rep.outcome;
  }
  return OK;
}

/* ---- proof --------------------------------------------------------------- */

/* 1: y >= 0, M'y <= 0, q'y < 0: for no z >= 0 is w >= 0, since
 * y'w = q'y + (M'y)'z < 0. */
static int is_certificate(const lcp_data *p, const double *y) {
  size_t n = p->n;
  double work = 0.0, size = 0.0;
  for (size_t j = 0; j < n; ++j) {
    work += p->q[j] * y[j];
    size += fabs(p->q[j]) * y[j];
  }
  if (!(work < -PROOF * size)) return 0;
  for (size_t j = 0; j < n; ++j) {
    double sum = 0.0, terms = 0.0;
    for (size_t i = 0; i < n; ++i) {
      sum += p->M[i + n * j] * y[i];
      terms += fabs(p->M[i + n * j]) * y[i];
    }
    if (y[j] < 0.0 || !(sum <= ROUNDING * terms)) return 0;
  }
  return 1;
}

/* Is there any z >= 0 with w >= 0? *proved = 1: no. The ray of the skew problem
 * is (z, y) with y the certificate. */
static status look_for_proof(run *s, int *proved) {
  size_t n = s->p->n, m = 2 * n;
  OWNED double *K = NULL, *k = NULL, *ray = NULL;
  lcp_report rep;
  PASS_NEW_ALL(OF(K, m * m), OF(k, m), OF(ray, m));
  for (size_t j = 0; j < n; ++j)
    for (size_t i = 0; i < n; ++i) {
      double a = s->p->M[i + n * j];
      K[n + i + m * j] = a;
      K[j + m * (n + i)] = -a;
    }
  COPY(k + n, s->p->q, n);
  PASS(lcp_lemke((int)m, K, k, 0, ray, &rep));
  s->v->iterations += rep.pivots;
  *proved = rep.outcome == STOPPED_RAY && is_certificate(s->p, ray + n);
  return OK;
}

/* ---- the solve -------------------------------------------------------- */

/* All bases of few unknowns. */
static status try_bases(run *s, outcome *o) {
  *o = STOPPED_STAGNATION;
  if (s->p->n > LCP_MOST_BASES) return OK;
  PASS(lcp_all_bases(s->p, s->control->tol, s->try_z, o));
  if (*o == CONVERGED && !keep(s)) *o = STOPPED_STAGNATION;
  note(s->v, "all bases", *o);
  return OK;
}

static status try_newton(run *s, outcome *o) {
  int found = 0;
  PASS(lcp_newton(s->p, s->control, s->try_z, &s->v->iterations, &found));
  *o = found && keep(s) ? CONVERGED
       : is_spent(s)    ? STOPPED_ITERATIONS
                        : STOPPED_STAGNATION;
  note(s->v, "newton", *o);
  return OK;
}

/* The methods after pivoting. */
static status other_methods(run *s, outcome *o) {
  PASS(try_bases(s, o));
  if (*o == STOPPED_STAGNATION) PASS(try_newton(s, o));
  return OK;
}

/* Outcome STOPPED_RAY if it is proved that there is no solution. */
static status prove(run *s, int *looked, int *proved) {
  *looked = 1;
  *proved = s->v->outcome == STOPPED_RAY && is_certificate(s->p, s->y);
  if (!*proved && !is_spent(s)) PASS(look_for_proof(s, proved));
  if (*proved) s->v->outcome = STOPPED_RAY;
  return OK;
}

static status follow(run *s) {
  outcome first = RUNNING, o = RUNNING;
  int proved = 0, looked = 0;
  PASS(pivot(s, 0, FIRST, &first));
  s->v->outcome = first;
  if (first == CONVERGED || first == STOPPED_NAN) return OK;
  note(s->v, "lemke", first);
  if (first == STOPPED_RAY) PASS(prove(s, &looked, &proved));
  if (proved) return OK;
  if (!s->control->pivoting_only) {
    PASS(other_methods(s, &o));
    s->v->outcome = o;
    if (o == CONVERGED || o == STOPPED_RAY) return OK;
  }
  /* Short first tries may have ended before a ray. */
  if (!looked) PASS(prove(s, &looked, &proved));
  if (proved) return OK;
  PASS(pivot(s, FIRST, ATTEMPTS, &o));
  note(s->v, "lemke from other vertices", o);
  s->v->outcome = o == CONVERGED ? CONVERGED
                  : first == STOPPED_ITERATIONS || is_spent(s)
                      ? STOPPED_ITERATIONS
                      : STOPPED_STAGNATION;
  return OK;
}

status lcp_solve(const lcp_data *p, const lcp_control *control, double *z,
                 double *w, lcp_verdict *v) {
  SCRATCH;
  run s = {.p = p, .control = control, .v = v, .z = z, .w = w, .seed = 1};
  *v = (lcp_verdict){.outcome = CONVERGED, .method = "lemke"};
  v->residual = residual_of(p, z, w);
  if (v->residual <= control->tol) return OK;
  size_t n = s.p->n;
  PASS_NEW_ALL(OF(s.try_z, n), OF(s.y, 2 * n), OF(s.cover, n), OF(s.size, n),
               OF(s.M, n * n), OF(s.q, n), OF(s.work, n), OF(s.turned, n));
  PASS(follow(&s));
  v->residual = residual_of(p, z, w);
  return OK;
}
