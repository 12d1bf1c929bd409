/* Linear complementarity problems (lcp_case.h). */
#include "support/lcp_case.h"

#include "base/base.h"
#include "support/contact_case.h"

typedef struct maker {
  lcp_case *c;
  unsigned long long *seed;
} maker;

static double *entry(const maker *m, int i, int j) {
  return &m->c->M[(size_t)i + (size_t)m->c->n * (size_t)j];
}

static double number(const maker *m) {
  return 2.0 * case_random(m->seed) - 1.0;
}

/* M += G G', G[n*rank] */
static void add_square(const maker *m, int rank) {
  int n = m->c->n;
  double *G = calloc((size_t)(n * rank), sizeof *G);
  for (int k = 0; k < n * rank; ++k) G[k] = number(m);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < rank; ++k)
        *entry(m, i, j) += G[i + n * k] * G[j + n * k];
  free(G);
}

/* q so that a random complementary pair solves the problem. */
static void plant(const maker *m) {
  int n = m->c->n;
  for (int i = 0; i < n; ++i) {
    m->c->z[i] = fmax(0.0, number(m));
    m->c->q[i] = m->c->z[i] > 0.0 ? 0.0 : case_random(m->seed);
  }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) m->c->q[i] -= *entry(m, i, j) * m->c->z[j];
}

static void fill(const maker *m, double value) {
  for (int i = 0; i < m->c->n; ++i) m->c->q[i] = value;
}

static void make_triangles(const maker *m, lcp_family family) {
  int n = m->c->n;
  if (family != LCP_TRIANGULAR) fill(m, -1.0);
  for (int i = 0; i < n; ++i) {
    *entry(m, i, i) = family == LCP_FATHI ? 4.0 * i + 1.0 : 1.0;
    if (family == LCP_TIES_IN_TURN && n > 1) *entry(m, i, (i + 1) % n) = 2.0;
    for (int j = 0; j < i; ++j) {
      if (family == LCP_MURTY) *entry(m, i, j) = 2.0;
      if (family == LCP_TRIANGULAR) *entry(m, i, j) = number(m);
      if (family == LCP_FATHI)
        *entry(m, i, j) = *entry(m, j, i) = 4.0 * j + 2.0;
    }
  }
}

static void make_squares(const maker *m, lcp_family family) {
  int n = m->c->n;
  add_square(m, family == LCP_DEFINITE || family == LCP_SCALED ? n : n / 2 + 1);
  for (int i = 0; i < n && family == LCP_COPOSITIVE; ++i)
    for (int j = 0; j < i; ++j) {
      double skew = number(m);
      *entry(m, i, j) += skew;
      *entry(m, j, i) -= skew;
    }
  if (family == LCP_SEMIDEFINITE || family == LCP_COPOSITIVE) plant(m);
  for (int i = 0; i < n && family == LCP_SCALED; ++i) {
    double unit = pow(10.0, 4.0 * sin(3.0 * i));
    m->c->q[i] *= unit;
    for (int j = 0; j < n; ++j) {
      *entry(m, i, j) *= unit;
      *entry(m, j, i) *= unit;
    }
  }
}

static void make_halves(const maker *m, lcp_family family) {
  int n = m->c->n;
  for (int i = 0; i < n / 2; ++i)
    for (int j = n / 2; j < n; ++j) {
      double a =
          family == LCP_BIMATRIX ? 1.0 + case_random(m->seed) : number(m);
      *entry(m, i, j) = a;
      *entry(m, j, i) =
          family == LCP_BIMATRIX ? 1.0 + case_random(m->seed) : -a;
    }
  if (family == LCP_BIMATRIX)
    fill(m, -1.0);
  else
    plant(m);
}

static void make_lines(const maker *m, lcp_family family) {
  int n = m->c->n;
  for (int i = 0; i < n; ++i) {
    *entry(m, i, i) = family == LCP_OBSTACLE ? 2.0 : 1.0;
    for (int j = 0; j < n; ++j) {
      if (family == LCP_OBSTACLE && abs(i - j) == 1) *entry(m, i, j) = -1.0;
      if (family == LCP_Z_MATRIX && i != j)
        *entry(m, i, j) = -1.5 * case_random(m->seed) / n;
    }
    if (family == LCP_OBSTACLE)
      m->c->q[i] = 0.01 * (1.0 - 3.0 * fabs(sin(7.0 * i / n)));
  }
}

static void make_random(const maker *m, lcp_family family) {
  int n = m->c->n;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) *entry(m, i, j) = number(m);
  for (int i = 0; i < n && family == LCP_NEGATIVE; ++i)
    *entry(m, i, i) = -3.0 * case_random(m->seed);
  if (family != LCP_INFEASIBLE) {
    plant(m);
    return;
  }
  for (int j = 0; j < n; ++j) *entry(m, 0, j) = -case_random(m->seed);
  m->c->q[0] = -1.0;
}

/* w_i = -1 + g_i g'z with g of both signs. */
static void make_flat(const maker *m, lcp_family family) {
  int n = m->c->n;
  for (int i = 0; i < n; ++i)
    m->c->z[i] = i == 0 ? 1.0 : i == n - 1 ? -1.0 : number(m);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) *entry(m, i, j) = m->c->z[i] * m->c->z[j];
  fill(m, -1.0);
}

/* Contacts with (p, b+, b-, y) each, W of rank n/4 of n/2, mu = 0.7. */
static void make_friction(const maker *m, lcp_family family) {
  int n = m->c->n, contacts = n / 4, rank = contacts;
  double *H = calloc((size_t)(2 * contacts * rank) + 1, sizeof *H);
  for (int k = 0; k < 2 * contacts * rank; ++k) H[k] = number(m);
  fill(m, 0.0);
  for (int k = 0; k < rank; ++k) {
    double v = number(m);
    for (int a = 0; a < 3 * contacts; ++a) {
      int row = 4 * (a / 3) + a % 3;
      double sign_a = a % 3 == 2 ? -1.0 : 1.0;
      double ha = sign_a * H[2 * (a / 3) + (a % 3 > 0) + 2 * contacts * k];
      m->c->q[row] += ha * v;
      for (int b = 0; b < 3 * contacts; ++b) {
        double sign_b = b % 3 == 2 ? -1.0 : 1.0;
        double hb = sign_b * H[2 * (b / 3) + (b % 3 > 0) + 2 * contacts * k];
        *entry(m, row, 4 * (b / 3) + b % 3) += ha * hb;
      }
    }
  }
  for (int a = 0; a < contacts; ++a)
    for (int k = 0; k < 3; ++k) {
      *entry(m, 4 * a + k, 4 * a + 3) = k > 0;
      *entry(m, 4 * a + 3, 4 * a + k) = k > 0 ? -1.0 : 0.7;
    }
  for (int i = 4 * contacts; i < n; ++i) *entry(m, i, i) = m->c->q[i] = 1.0;
  free(H);
}

lcp_case lcp_make(lcp_family family, int n, unsigned long long seed) {
  size_t size = (size_t)n;
  lcp_case c = {n, calloc(size * size + 1, sizeof(double)),
                calloc(size + 1, sizeof(double)),
                calloc(size + 1, sizeof(double)),
                calloc(size + 1, sizeof(double))};
  maker m = {&c, &seed};
  seed = seed * 2654435761u + 88172645463325252u;
  for (int i = 0; i < 20; ++i) case_random(&seed);
  for (int i = 0; i < n; ++i) c.q[i] = number(&m);
  static void (*const make[])(const maker *, lcp_family) = {
      [LCP_TIES_IN_TURN] = make_triangles,
      [LCP_MURTY] = make_triangles,
      [LCP_FATHI] = make_triangles,
      [LCP_DEFINITE] = make_squares,
      [LCP_SEMIDEFINITE] = make_squares,
      [LCP_COPOSITIVE] = make_squares,
      [LCP_BIMATRIX] = make_halves,
      [LCP_TRIANGULAR] = make_triangles,
      [LCP_OBSTACLE] = make_lines,
      [LCP_PROGRAM] = make_halves,
      [LCP_SCALED] = make_squares,
      [LCP_Z_MATRIX] = make_lines,
      [LCP_FRICTION] = make_friction,
      [LCP_INDEFINITE] = make_random,
      [LCP_NEGATIVE] = make_random,
      [LCP_INFEASIBLE] = make_random,
      [LCP_FLAT] = make_flat};
  make[family](&m, family);
  memset(c.z, 0, size * sizeof *c.z);
  return c;
}

void lcp_case_free(lcp_case *c) {
  free(c->M);
  free(c->q);
  free(c->z);
  free(c->w);
}

const char *lcp_name(lcp_family family) {
  static const char *const names[LCP_FAMILIES] = {
      "ties in turn", "Murty",    "Fathi",      "definite",   "semidefinite",
      "copositive",   "bimatrix", "triangular", "obstacle",   "program",
      "scaled",       "Z-matrix", "friction",   "indefinite", "negative",
      "infeasible",   "flat"};
  return names[family];
}

double lcp_violation(const lcp_case *c, const double *z) {
  double worst = 0.0, size_q = 0.0, size_M = 0.0;
  for (int i = 0; i < c->n; ++i) {
    size_q = fmax(size_q, fabs(c->q[i]));
    for (int j = 0; j < c->n; ++j)
      size_M = fmax(size_M, fabs(c->M[i + c->n * j]));
  }
  for (int i = 0; i < c->n; ++i) {
    double w = c->q[i];
    for (int j = 0; j < c->n; ++j) w += c->M[i + c->n * j] * z[j];
    if (!(fabs(fmin(w, size_M * z[i])) <= worst))
      worst = fabs(fmin(w, size_M * z[i]));
  }
  return size_q > 0.0 ? worst / size_q : worst;
}
