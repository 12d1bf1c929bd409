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
#include "material/scheme/work.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

/* q1 of EXPONENTIAL: z/2 - z^2/6 + ... where 1 - a/z would cancel. */
double relaxing_late_share(double z) {
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
static void remains(const law_elastic *el, const linear_map *m, double *D) {
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
  const law_point point = {.law = k->law,
                           .elastic = &k->elastic,
                           .value = k->value,
                           .speed = k->speed};
  OWNED double *W = NULL, *rate = NULL;
  PASS_NEW(W, ns * ns * terms);
  PASS_NEW(rate, terms);
  for (int i = 0; i < terms; ++i)
    rate[i] = k->speed * k->law->ops->relaxing(&point, i, W + ns * ns * i);
  memset(m->P, 0, (size_t)(n * n) * sizeof *m->P);
  memset(m->Q0, 0, (size_t)(n * ns) * sizeof *m->Q0);
  memset(m->Q1, 0, (size_t)(n * ns) * sizeof *m->Q1);
  for (int i = 0; i < ns; ++i) m->P[i + n * i] = 1.0;
  for (int i = 0; i < terms; ++i) {
    double q0, q1;
    relaxed_shares(p, exact, rate[i], &q0, &q1);
    term_rows(ns, i, q0, q1, W, m);
  }
  for (int i = 0; i < terms; ++i) add_rows(ns, i, W + ns * ns * i, m);
  remains(&k->elastic, m, D);
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
  memset(column, 0, (size_t)n * sizeof *column);
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
  memset(column, 0, (size_t)n * sizeof *column);
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
  OWNED double *row = NULL;
  if (!(D[ZZ + el->ns * ZZ] > 0.0))
    RAISE(ERR_SINGULAR, "the step of an inelastic law has no solution");
  PASS_NEW(row, m->n);
  eliminate_old(el, m);
  eliminate_new(el, D, m, row);
  condense(el->ns, D);
  return OK;
}
