/*
 * Choice of the method for a linear complementarity problem, and the proof if
 * none finds a solution (lcp_solve.h).
 */
#include "solver/lcp/lcp_solve.h"

#include "base/memory.h"
#include "contact/contact.h"
#include "solver/lcp/lcp.h"

#include <cblas.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/*
 * Principal transform of a linear complementarity problem (lcp_solve.h): z_i
 * and w_i change places for a set of unknowns that grows by single ones with a
 * good pivot on the diagonal, or by pairs with two next to it.
 */

static const double GOOD = 0x1p-7; /* -, of the largest entry of the row */

static double entry(int n, const double *M, int i, int j) {
  return M[(size_t)i + (size_t)n * (size_t)j];
}

/* y_r and x_c of y = q + M x change places. row[n] */
static void exchange(int n, int r, int c, double *M, double *q, double *row) {
  size_t ld = (size_t)n;
  double *column = M + ld * (size_t)c, pivot = column[r], q_r = q[r];
  cblas_dcopy(n, M + r, n, row, 1);
  cblas_dscal(n, 1.0 / pivot, column, 1);
  for (int j = 0; j < n; ++j)
    if (j != c) cblas_daxpy(n, -row[j], column, 1, M + ld * (size_t)j, 1);
  cblas_daxpy(n, -q_r, column, 1, q, 1);
  for (int j = 0; j < n; ++j) M[(size_t)r + ld * (size_t)j] = -row[j] / pivot;
  column[r] = 1.0 / pivot;
  q[r] = -q_r / pivot;
}

static int is_good(int n, const double *M, int i, int j) {
  double largest = fabs(entry(n, M, i, (int)cblas_idamax(n, M + i, n)));
  return fabs(entry(n, M, i, j)) > GOOD * largest;
}

static int draw(unsigned *seed, int count) {
  *seed = *seed * 1664525u + 1013904223u;
  return (int)((double)(*seed >> 8) * 0x1p-24 * count);
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
  size_t ld = (size_t)n;
  exchange(n, i, j, M, q, row);
  exchange(n, j, i, M, q, row);
  double keep = q[i];
  q[i] = q[j];
  q[j] = keep;
  cblas_dswap(n, M + i, n, M + j, n);
  cblas_dswap(n, M + ld * (size_t)i, 1, M + ld * (size_t)j, 1);
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

static status run_new(run *s) {
  size_t n = (size_t)s->p->n;
  PASS_NEW_ALL(OF(s->try_z, n), OF(s->y, 2 * n), OF(s->cover, n),
               OF(s->size, n), OF(s->M, n * n), OF(s->q, n), OF(s->work, n),
               OF(s->turned, n));
  return OK;
}

static void run_free(run *s) {
  RELEASE(s->try_z, s->y, s->cover, s->size, s->M, s->q, s->work, s->turned);
}

static void note(lcp_verdict *v, const char *who, outcome o) {
  size_t used = strlen(v->log);
  snprintf(v->log + used, LCP_LOG - used, "%s%s: %s", used > 0 ? ", " : "", who,
           outcome_text(o));
  v->method = who;
}

/* Keep the attempt if it is better; 1: it solves the problem. */
static int keep(run *s) {
  size_t bytes = (size_t)s->p->n * sizeof *s->z;
  double residual = lcp_residual(s->p, s->try_z, s->w);
  if (residual < s->v->residual || isnan(s->v->residual)) {
    s->v->residual = residual;
    memcpy(s->z, s->try_z, bytes);
  }
  return residual <= s->control->tol;
}

/* ---- pivoting ------------------------------------------------------------ */

/* Positive numbers of a fixed series, [0.25, 4). */
static double cover(unsigned *seed) {
  *seed = *seed * 1664525u + 1013904223u;
  return ldexp(1.0 + (double)(*seed >> 8) * 0x1p-24,
               (int)(*seed >> 6 & 3u) - 2);
}

/* Units that bring the diagonal to one, or the largest of row and column. */
static double natural_unit(const lcp_data *p, size_t i) {
  size_t n = (size_t)p->n;
  double largest = fabs(p->M[i + n * i]);
  for (size_t j = 0; j < n && largest == 0.0; ++j)
    largest = fmax(largest, fmax(fabs(p->M[i + n * j]), fabs(p->M[j + n * i])));
  return largest > 0.0 ? 1.0 / sqrt(largest) : 1.0;
}

/* Attempt k: plain; in natural units; then with other covering vectors and
 * from other vertices. */
static void choose(run *s, int k) {
  size_t n = (size_t)s->p->n;
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

/* 0: the limit of the method. Where others follow the first attempts are short.
 */
static int pivots_allowed(const run *s) {
  int most = s->control->max_iter, left = most - s->v->iterations;
  int few = FEW_PIVOTS + PIVOTS_A_ROW * s->p->n;
  if (!s->is_first || s->control->pivoting_only) return most > 0 ? left : 0;
  return most > 0 && left < few ? left : few;
}

/* Lemke's method with a covering vector d is that of the rows over d with a
 * vector of ones. On a ray of the given problem y is its direction. */
static status pivot_once(run *s, lcp_report *rep) {
  size_t n = (size_t)s->p->n;
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
  size_t n = (size_t)p->n;
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
  size_t n = (size_t)s->p->n, m = 2 * n;
  OWNED double *K = NULL, *k = NULL, *ray = NULL;
  lcp_report rep;
  PASS_NEW_ALL(OF(K, m * m), OF(k, m), OF(ray, m));
  for (size_t j = 0; j < n; ++j)
    for (size_t i = 0; i < n; ++i) {
      double a = s->p->M[i + n * j];
      K[n + i + m * j] = a;
      K[j + m * (n + i)] = -a;
    }
  memcpy(k + n, s->p->q, n * sizeof *k);
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
  ENDS_BY(run_free)
  run s = {.p = p, .control = control, .v = v, .z = z, .w = w, .seed = 1};
  *v = (lcp_verdict){.outcome = CONVERGED, .method = "lemke"};
  v->residual = lcp_residual(p, z, w);
  if (v->residual <= control->tol) return OK;
  PASS(run_new(&s));
  PASS(follow(&s));
  v->residual = lcp_residual(p, z, w);
  return OK;
}
