/*
 * Maps of implicit steps of linear laws with constant coefficients. With
 * y = (e^i, alpha) and the strain e (less the thermal one) of a point,
 *   y' = L y + G e,   sigma = E (e - e^i),
 * a step is
 *   y_new = P y_old + Q0 e_old + Q1 e_new
 * with matrices that depend on the law and dt alone, so that the body has the
 * constant elasticity D = E (I - Q1_ei) and needs one equilibrium:
 *   THETA        y_new = y_old + dt (L y_th + G e_th),
 *                x_th = (1-theta) x_old + theta x_new
 *   EXPONENTIAL  the exact solution for e linear in time over the step:
 *                exp(dt L), dt phi_1(dt L) G, dt phi_2(dt L) G
 */
#include "material/scheme/work.h"

#include "base/base.h"

#include <lapacke.h>

/* C[n*m] += a A[n*k] B[k*m], column major */
static void multiply(int n, int k, int m, double a, const double *A,
                     const double *B, double *C) {
  for (int j = 0; j < m; ++j)
    for (int q = 0; q < k; ++q) {
      double factor = a * B[q + k * j];
      for (int i = 0; i < n && factor != 0.0; ++i)
        C[i + n * j] += factor * A[i + n * q];
    }
}

static void put_block(int rows, int columns, const double *A, double *M,
                      int ld) {
  for (int j = 0; j < columns; ++j)
    for (int i = 0; i < rows; ++i) M[i + ld * j] += A[i + rows * j];
}

/* Blocks of the Jacobian of the point p in one array, new. */
static status new_jacobian(const law_point *p, int na, law_jacobian *j) {
  int ns = p->elastic->ns;
  PASS_NEW(j->ei_sigma, 2 * ns * ns + 2 * ns * na + na * na);
  j->ei_ei = j->ei_sigma + ns * ns;
  j->ei_alpha = j->ei_ei + ns * ns;
  j->alpha_sigma = j->ei_alpha + ns * na;
  j->alpha_alpha = j->alpha_sigma + na * ns;
  law_jacobian_at(p, j);
  return OK;
}

/* y' = L y + G e of a linear law, L[n*n], G[n*ns]. */
static status linear_law(const flow_kind *k, double *L, double *G) {
  const int ns = k->elastic.ns, na = k->n_alpha, n = ns + na;
  law_point p = flow_kind_point(k);
  OWNED double *zero = NULL, *top = NULL;
  PASS_NEW_ALL(OF(zero, n), OF(top, n * ns));
  p.sigma = p.ei = p.alpha = zero;
  OWNED_PARTS(law_jacobian, j, new_jacobian(&p, na, &j));
  put_block(ns, ns, j.ei_sigma, top, n);
  put_block(na, ns, j.alpha_sigma, top + ns, n);
  multiply(n, ns, ns, 1.0, top, k->elastic.E, G);
  for (int i = 0; i < n * ns; ++i) L[i] = -G[i];
  put_block(ns, ns, j.ei_ei, L, n);
  put_block(ns, na, j.ei_alpha, L + n * ns, n);
  put_block(na, na, j.alpha_alpha, L + n * ns + ns, n);
  return OK;
}

static status theta_map(const flow_kind *k, const scheme_step *p,
                        const double *L, const double *G, linear_map *m) {
  const int n = m->n, ns = k->elastic.ns, columns = n + 2 * ns;
  const double in = p->theta * p->dt, out = (1.0 - p->theta) * p->dt;
  OWNED double *M = NULL, *X = NULL;
  PASS_NEW_ALL(OF(M, n * n), OF(X, n * columns));
  for (int i = 0; i < n * n; ++i) {
    double one = i % (n + 1) == 0;
    M[i] = one - in * L[i];
    X[i] = one + out * L[i];
  }
  for (int i = 0; i < n * ns; ++i) {
    X[n * n + i] = out * G[i];
    X[n * (n + ns) + i] = in * G[i];
  }
  /* X[n*m] := inv(M) X; M is destroyed. */
  OWNED_NEW(int, pivot, n);
  if (LAPACKE_dgesv(LAPACK_COL_MAJOR, n, columns, M, n, pivot, X, n) != 0)
    RAISE(ERR_SINGULAR, "the step of an inelastic law has no solution");
  COPY(m->P, X, n * n);
  COPY(m->Q0, X + n * n, n * ns);
  COPY(m->Q1, X + n * (n + ns), n * ns);
  return OK;
}

/* X = exp(A) - I for A[n*n] with an entry of 1 or more: Taylor below 2^-6, then
 * squaring in the form X <- 2 X + X X, which preserves slow rates next to fast
 * ones. */
static status exponential_less_one(int n, const double *A, double *X) {
  enum { TERMS = 12 };
  OWNED double *power = NULL, *next = NULL;
  double largest = 0.0;
  size_t square = (size_t)n * n;
  int halvings = 0;
  PASS_NEW_ALL(OF(power, square), OF(next, square));
  for (int i = 0; i < n; ++i) {
    double row = 0.0;
    for (int j = 0; j < n; ++j) row += fabs(A[i + n * j]);
    largest = fmax(largest, row);
  }
  frexp(largest * 64.0, &halvings);
  for (size_t i = 0; i < square; ++i) X[i] = power[i] = ldexp(A[i], -halvings);
  for (int k = 2; k <= TERMS; ++k) {
    CLEAR(next, square);
    multiply(n, n, n, ldexp(1.0 / k, -halvings), A, power, next);
    for (size_t i = 0; i < square; ++i) X[i] += power[i] = next[i];
  }
  for (; halvings > 0; --halvings) {
    for (size_t i = 0; i < square; ++i) next[i] = 2.0 * X[i];
    multiply(n, n, n, 1.0, X, X, next);
    COPY(X, next, square);
  }
  return OK;
}

/* exp of [dt L, dt G, 0; 0, 0, I; 0, 0, 0]: its first row is exp(dt L),
 * dt phi_1 G, dt phi_2 G. */
static status exponential_map(const flow_kind *k, const scheme_step *p,
                              const double *L, const double *G, linear_map *m) {
  const int n = m->n, ns = k->elastic.ns, N = n + 2 * ns;
  OWNED double *A = NULL, *X = NULL;
  PASS_NEW_ALL(OF(A, N * N), OF(X, N * N));
  put_block(n, n, L, A, N);
  put_block(n, ns, G, A + N * n, N);
  for (int i = 0; i < N * N; ++i) A[i] *= p->dt;
  for (int i = 0; i < ns; ++i) A[n + i + N * (n + ns + i)] = 1.0;
  PASS(exponential_less_one(N, A, X));
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) m->P[i + n * j] = X[i + N * j] + (i == j);
  for (int j = 0; j < ns; ++j)
    for (int i = 0; i < n; ++i) {
      m->Q1[i + n * j] = X[i + N * (n + ns + j)];
      m->Q0[i + n * j] = X[i + N * (n + j)] - m->Q1[i + n * j];
    }
  return OK;
}

/* The general case: from L and G. */
status general_map(const flow_kind *k, const scheme_step *p, int exact,
                   linear_map *m, double *D) {
  OWNED double *L = NULL, *G = NULL;
  PASS_NEW_ALL(OF(L, m->n * m->n), OF(G, m->n * k->elastic.ns));
  PASS(linear_law(k, L, G));
  PASS(exact ? exponential_map(k, p, L, G, m) : theta_map(k, p, L, G, m));
  /* D = E (I - Q1) with the rows of e^i. */
  const int ns = k->elastic.ns;
  double top[36];
  for (int j = 0; j < ns; ++j)
    for (int i = 0; i < ns; ++i) top[i + ns * j] = m->Q1[i + m->n * j];
  COPY(D, k->elastic.E, ns * ns);
  multiply(ns, ns, ns, -1.0, k->elastic.E, top, D);
  return OK;
}

/*
 * Maps of laws of springs and dashpots in series (MAXWELL, ZENER, KELVIN,
 * BURGERS). Each part of the strain (all of it, or deviator and mean by
 * themselves) has scalar equations for the strains v_k of its units,
 *   d(v_k)/dt = f_k (e - sum_j v_j - m_k v_k),   e^i = v_0 + v_1 + ...
 * The matrices of the general case mix the parts and add all rates up in e^i:
 * of rates that differ by more than 16 decades the slow ones are lost. Here,
 * with h_k = f_k dt and the change D of a step,
 *   THETA   D v_k = b_k (x - m_k v_k),  b_k = 1/(1/h_k + theta m_k),
 *           x = (e_th - sum_j v_j/(1 + theta h_j m_j))/(1 + theta sum_j b_j)
 *   EXPONENTIAL  exact for e linear over the step: in closed form if one unit
 *           moves, else by the exponential of the matrix. If a unit is faster
 *           than MODERATE there, e - e^i is taken as linear over the step, or
 *           as that of its end for dashpots so fast: order 2 for the others.
 * All numbers are of the size of 1 for every rate.
 */
/*
 * Maps of laws whose terms follow the strain each by itself (PRONY),
 *   d(v_k)/dt = (e - w - v_k) r_k,   e^i = w + sum_k W_k v_k,   w constant.
 * The matrices of the general case contain all rates r_k: of rates that differ
 * by more than 16 decades the slow ones are lost. Here
 *   v_k,new - v_k = q0_k e_old + q1_k e_new - a_k (w + v_k),
 *   a_k = q0_k + q1_k,  z = r_k dt,
 *   THETA        q0 = (1 - theta) z/(1 + theta z),  q1 = theta z/(1 + theta z)
 *   EXPONENTIAL  a = 1 - exp(-z),  q1 = 1 - a/z     (e linear over the step)
 * are of the size of 1 for every rate.
 *
 * And the maps of linear laws in plane stress: e_zz is no unknown of the body;
 * sigma_zz = 0 at both ends of the step eliminates it, so that EXPONENTIAL
 * takes e_zz too as linear over the step.
 */

/* q1 of EXPONENTIAL, 1 - (1 - exp(-z))/z: by its series where that cancels. */
static double relaxing_late_share(double z) {
  double sum = 0.0, term = z / 2;
  if (z > 0.1) return 1.0 + expm1(-z) / z;
  for (int k = 3; k < 12; ++k) {
    sum += term;
    term *= -z / k;
  }
  return sum;
}

static void relaxed_shares(const scheme_step *p, int exact, double rate,
                           double *q0, double *q1) {
  const double z = rate * p->dt;
  if (exact) {
    *q1 = relaxing_late_share(z);
    *q0 = -expm1(-z) - *q1;
    return;
  }
  /* z/(1 + theta z) for any z > 0, also one that overflows. */
  const double a = 1.0 / (1.0 / z + p->theta);
  *q0 = (1.0 - p->theta) * a;
  *q1 = p->theta * a;
}

/* All zero, but 1 in the first n_kept of the diagonal of P. */
static void clear_map(int ns, int n_kept, linear_map *m) {
  const size_t n = m->n, bytes = n * ns * sizeof *m->Q0;
  CLEAR(m->P, n * n);
  memset(m->Q0, 0, bytes);
  memset(m->Q1, 0, bytes);
  for (int i = 0; i < n_kept; ++i) m->P[i + m->n * i] = 1.0;
}

/* Rows of term k: from y = (e^i, v), e_old and e_new. */
static void term_rows(int ns, int k, double q0, double q1, const double *W,
                      linear_map *m) {
  const int n = m->n, first = ns * (k + 1), terms = n / ns - 1;
  const double a = q0 + q1;
  for (int i = 0; i < ns; ++i) {
    m->P[first + i + n * i] = -a;
    m->P[first + i + n * (first + i)] += 1.0 - a;
    m->Q0[first + i + n * i] = q0;
    m->Q1[first + i + n * i] = q1;
  }
  for (int l = 0; l < terms; ++l)
    for (int j = 0; j < ns; ++j)
      for (int i = 0; i < ns; ++i)
        m->P[first + i + n * (ns * (l + 1) + j)] +=
            a * W[ns * ns * l + i + ns * j];
}

/* Rows of e^i: W_k times what v_k changes by. */
static void add_rows(int ns, int k, const double *W_k, linear_map *m) {
  const int n = m->n, first = ns * (k + 1);
  for (int q = 0; q < ns; ++q)
    for (int i = 0; i < ns; ++i) {
      const double w = W_k[i + ns * q];
      const int row = first + q;
      for (int j = 0; j < n; ++j)
        m->P[i + n * j] += w * (m->P[row + n * j] - (row == j));
      for (int j = 0; j < ns; ++j) {
        m->Q0[i + n * j] += w * m->Q0[row + n * j];
        m->Q1[i + n * j] += w * m->Q1[row + n * j];
      }
    }
}

/* D = C (I - Q1) with the rows of e^i. */
static void remains_of_terms(const law_elastic *el, const linear_map *m,
                             double *D) {
  const int ns = el->ns;
  for (int j = 0; j < ns; ++j) {
    double left[6];
    for (int i = 0; i < ns; ++i) left[i] = (i == j) - m->Q1[i + m->n * j];
    tensor_product(ns, el->C, left, D + ns * j);
  }
}

status relaxing_map(const flow_kind *k, const scheme_step *p, int exact,
                    linear_map *m, double *D) {
  const int ns = k->elastic.ns, n = m->n, terms = n / ns - 1;
  const law_point point = flow_kind_point(k);
  OWNED double *W = NULL, *rate = NULL;
  PASS_NEW_ALL(OF(W, ns * ns * terms), OF(rate, terms));
  for (int i = 0; i < terms; ++i)
    rate[i] = k->speed * k->law->ops->relaxing(&point, i, W + ns * ns * i);
  clear_map(ns, ns, m);
  for (int i = 0; i < terms; ++i) {
    double q0, q1;
    relaxed_shares(p, exact, rate[i], &q0, &q1);
    term_rows(ns, i, q0, q1, W, m);
  }
  for (int i = 0; i < terms; ++i) add_rows(ns, i, W + ns * ns * i, m);
  remains_of_terms(&k->elastic, m, D);
  return OK;
}

/* column[n] of a matrix times row[columns] over pivot goes to A[n*columns]. */
static void add_outer(int n, int columns, const double *column,
                      const double *row, double pivot, double *A) {
  for (int j = 0; j < columns; ++j)
    for (int i = 0; i < n; ++i) A[i + n * j] += column[i] * row[j] / pivot;
}

enum { ZZ = 2 };

/* e_zz of the old state out of the map: c (e - e^i) = 0, c the row of C for
 * sigma_zz. */
static void eliminate_old(const law_elastic *el, linear_map *m) {
  const int ns = el->ns, n = m->n;
  double *column = m->Q0 + n * ZZ, of_e[6], of_ei[6];
  for (int j = 0; j < ns; ++j) {
    of_ei[j] = el->C[ZZ + ns * j];
    of_e[j] = j == ZZ ? 0.0 : -of_ei[j];
  }
  add_outer(n, ns, column, of_ei, of_ei[ZZ], m->P);
  add_outer(n, ns, column, of_e, of_ei[ZZ], m->Q0);
  CLEAR(column, n);
}

/* row[columns] = c A for the rows of e^i of A[n*columns]. */
static void stress_row(const law_elastic *el, const double *A, int n,
                       int columns, double *row) {
  for (int j = 0; j < columns; ++j) {
    row[j] = 0.0;
    for (int i = 0; i < el->ns; ++i)
      row[j] += el->C[ZZ + el->ns * i] * A[i + n * j];
  }
}

/* e_zz of the new state: d e - c (P y + Q0 e_old) = 0 in the rows of e^i, d the
 * row of D; row[n] is workspace. */
static void eliminate_new(const law_elastic *el, const double *D, linear_map *m,
                          double *row) {
  const int ns = el->ns, n = m->n;
  const double pivot = D[ZZ + ns * ZZ];
  double *column = m->Q1 + n * ZZ, of_e[6];
  for (int j = 0; j < ns; ++j) of_e[j] = j == ZZ ? 0.0 : -D[ZZ + ns * j];
  stress_row(el, m->P, n, n, row);
  add_outer(n, n, column, row, pivot, m->P);
  stress_row(el, m->Q0, n, ns, row);
  add_outer(n, ns, column, row, pivot, m->Q0);
  add_outer(n, ns, column, of_e, pivot, m->Q1);
  CLEAR(column, n);
}

/* D of the other components. */
static void condense(int ns, double *D) {
  double column[6] = {0}, row[6] = {0};
  for (int i = 0; i < ns; ++i) {
    column[i] = D[i + ns * ZZ];
    row[i] = -D[ZZ + ns * i];
  }
  add_outer(ns, ns, column, row, column[ZZ], D);
  for (int i = 0; i < ns; ++i) D[i + ns * ZZ] = D[ZZ + ns * i] = 0.0;
}

status plane_stress_map(const law_elastic *el, linear_map *m, double *D) {
  if (!(D[ZZ + el->ns * ZZ] > 0.0))
    RAISE(ERR_SINGULAR, "the step of an inelastic law has no solution");
  OWNED_NEW(double, row, m->n);
  eliminate_old(el, m);
  eliminate_new(el, D, m, row);
  condense(el->ns, D);
  return OK;
}

static const double MODERATE = 1e6, MOST = 1e200; /* of h, - */

/* A part with n units, and its map of them: D v = U v + u0 e_old + u1 e_new;
 * kept = 1 - sum of u1. */
typedef struct series {
  int n;
  double *h, *m;       /* [n] - */
  double *U, *u0, *u1; /* [n*n], [n], [n] */
  double kept;
  double *work;
} series;

static status series_new(int n, series *s) {
  *s = (series){.n = n};
  PASS_NEW(s->work, n * (n + 4));
  s->h = s->work;
  s->m = s->h + n;
  s->u0 = s->m + n;
  s->u1 = s->u0 + n;
  s->U = s->u1 + n;
  return OK;
}

/* All units of a part; LAW_NO_PART: there is none. */
static int units_of(const law_point *p, int part, double dt, series *s) {
  int of = LAW_NO_PART;
  for (int k = 0; k < s->n; ++k) {
    law_unit unit = {0};
    of = p->law->ops->series(p, part, k, &unit);
    s->h[k] = fmin(p->speed * unit.flow * dt, MOST);
    s->m[k] = unit.spring;
  }
  return of;
}

static void by_theta(double theta, series *s) {
  double sum = 0.0;
  for (int k = 0; k < s->n; ++k)
    sum += s->h[k] > 0.0 ? 1.0 / (1.0 / s->h[k] + theta * s->m[k]) : 0.0;
  s->kept = 1.0 / (1.0 + theta * sum);
  for (int k = 0; k < s->n; ++k) {
    const double b =
        s->h[k] > 0.0 ? 1.0 / (1.0 / s->h[k] + theta * s->m[k]) : 0.0;
    for (int j = 0; j < s->n; ++j)
      s->U[k + s->n * j] = -b * s->kept / (1.0 + theta * s->h[j] * s->m[j]) -
                           (j == k ? b * s->m[k] : 0.0);
    s->u0[k] = (1.0 - theta) * b * s->kept;
    s->u1[k] = theta * b * s->kept;
  }
}

/* (1 - exp(-z))/z */
static double mean_of_decay(double z) { return z > 0.0 ? -expm1(-z) / z : 1.0; }

/* The unit q alone moves. */
static void by_one(int q, series *s) {
  const double stiff = 1.0 + s->m[q], z = s->h[q] * stiff, a = -expm1(-z);
  for (int j = 0; j < s->n; ++j) s->U[q + s->n * j] = j == q ? -a : -a / stiff;
  s->u1[q] = relaxing_late_share(z) / stiff;
  s->u0[q] = a / stiff - s->u1[q];
  s->kept = (s->m[q] + mean_of_decay(z)) / stiff;
}

static status by_matrix(series *s) {
  const int n = s->n, N = n + 2;
  OWNED double *A = NULL, *X = NULL;
  PASS_NEW_ALL(OF(A, N * N), OF(X, N * N));
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) A[k + N * j] = -s->h[k];
    A[k + N * k] -= s->h[k] * s->m[k];
    A[k + N * n] = s->h[k];
  }
  A[n + N * (n + 1)] = 1.0;
  PASS(exponential_less_one(N, A, X));
  s->kept = 1.0;
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) s->U[k + n * j] = X[k + N * j];
    s->u1[k] = X[k + N * (n + 1)];
    s->u0[k] = X[k + N * n] - s->u1[k];
    s->kept -= s->u1[k];
  }
  return OK;
}

/* D v = -a v + b0 x_old + b1 x_new of a unit, x = e - e^i. */
static void term_shares(double h, double m, double *a, double *b0, double *b1) {
  const double z = h * m;
  *a = -expm1(-z);
  *b0 = 0.0;
  *b1 = h;
  if (h > MODERATE && z < 1.0) return;
  *b1 = z > 0.0 ? h / z * relaxing_late_share(z) : h / 2;
  *b0 = h * mean_of_decay(z) - *b1;
}

static void by_stress(series *s) {
  double sum0 = 0.0, sum1 = 0.0, a, b0, b1;
  for (int k = 0; k < s->n; ++k) {
    term_shares(s->h[k], s->m[k], &a, &b0, &b1);
    sum0 += b0;
    sum1 += b1;
  }
  s->kept = 1.0 / (1.0 + sum1);
  for (int k = 0; k < s->n; ++k) {
    term_shares(s->h[k], s->m[k], &a, &b0, &b1);
    s->u1[k] = b1 * s->kept;
    s->u0[k] = b0 - s->u1[k] * sum0;
    for (int j = 0; j < s->n; ++j)
      s->U[k + s->n * j] =
          -s->u0[k] - s->u1[k] * exp(-s->h[j] * s->m[j]) - (j == k ? a : 0.0);
  }
}

static status by_exponential(series *s) {
  int moving = 0, last = 0;
  double fastest = 0.0;
  for (int k = 0; k < s->n; ++k) {
    if (!(s->h[k] > 0.0)) continue;
    ++moving;
    last = k;
    fastest = fmax(fastest, s->h[k] * (1.0 + s->m[k]));
  }
  if (moving <= 1)
    by_one(last, s);
  else if (fastest <= MODERATE)
    PASS(by_matrix(s));
  else
    by_stress(s);
  return OK;
}

/* Entry (i, j) of the projector on a part of the strain. */
static double projector(int of, int i, int j) {
  const double mean = i < 3 && j < 3 ? 1.0 / 3 : 0.0, one = i == j;
  return of == LAW_WHOLE ? one : of == LAW_MEAN ? mean : one - mean;
}

/* A row of the map gets a part of the change of unit k: from column j of each
 * tensor; v_0 is e^i less the other units. */
static void add_row(const series *s, int k, int ns, int row, int j, double part,
                    linear_map *m) {
  const int n = m->n;
  const double *U = s->U + k;
  m->P[row + n * j] += part * U[0];
  for (int q = 1; q < s->n; ++q)
    m->P[row + n * (ns * q + j)] += part * (U[s->n * q] - U[0]);
  m->Q0[row + n * j] += part * s->u0[k];
  m->Q1[row + n * j] += part * s->u1[k];
}

/* e^i gets the change of all units, alpha that of the units from 1 on. */
static void add_part(const series *s, int of, int ns, linear_map *m) {
  for (int j = 0; j < ns; ++j)
    for (int i = 0; i < ns; ++i) {
      const double part = projector(of, i, j);
      for (int k = 0; k < s->n && part != 0.0; ++k) {
        add_row(s, k, ns, i, j, part, m);
        if (k > 0) add_row(s, k, ns, ns * k + i, j, part, m);
      }
    }
}

/* D[ns*ns] = C (what is left of each part). */
static void remaining_stiffness(const law_elastic *el, const double kept[3],
                                int whole, double *D) {
  const int ns = el->ns;
  for (int j = 0; j < ns; ++j) {
    double column[6];
    for (int i = 0; i < ns; ++i)
      column[i] = whole ? kept[LAW_WHOLE] * projector(LAW_WHOLE, i, j)
                        : kept[LAW_DEVIATOR] * projector(LAW_DEVIATOR, i, j) +
                              kept[LAW_MEAN] * projector(LAW_MEAN, i, j);
    tensor_product(ns, el->C, column, D + ns * j);
  }
}

status series_map(const flow_kind *k, const scheme_step *p, int exact,
                  linear_map *m, double *D) {
  const int ns = k->elastic.ns, n = m->n;
  const law_point point = flow_kind_point(k);
  double kept[3] = {1.0, 1.0, 1.0};
  OWNED_PARTS(series, s, series_new(n / ns, &s));
  clear_map(ns, n, m);
  int of = LAW_NO_PART, whole = 0;
  for (int part = 0; (of = units_of(&point, part, p->dt, &s)) != LAW_NO_PART;
       ++part) {
    CLEAR(s.u0, s.n * (s.n + 2));
    if (exact)
      PASS(by_exponential(&s));
    else
      by_theta(p->theta, &s);
    add_part(&s, of, ns, m);
    kept[of] = s.kept;
    whole |= of == LAW_WHOLE;
  }
  remaining_stiffness(&k->elastic, kept, whole, D);
  return OK;
}
