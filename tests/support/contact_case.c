/* Contact problems for the tests of the solvers. */
#include "support/contact_case.h"

#include "base/base.h"

#include <cblas.h>
#include <lapacke.h>

double case_random(unsigned long long *seed) {
  *seed ^= *seed << 13;
  *seed ^= *seed >> 7;
  *seed ^= *seed << 17;
  return (double)(*seed >> 11) * 0x1p-53;
}

static double *zeros(int n) { return calloc((size_t)n + 1, sizeof(double)); }

contact_case case_new(int dim, int n, double mu) {
  contact_case c;
  memset(&c, 0, sizeof c);
  int m = dim * n;
  c.A = calloc((size_t)m * (size_t)m + 1, sizeof *c.A);
  c.f = zeros(m);
  c.gap = zeros(n);
  c.ut0 = zeros(m - n);
  c.g0 = zeros(n);
  c.u = zeros(m);
  c.r = zeros(m);
  c.B = calloc(1, sizeof *c.B);
  c.B->n = n;
  c.B->start = calloc((size_t)n + 1, sizeof *c.B->start);
  c.B->col = calloc((size_t)n + 1, sizeof *c.B->col);
  c.B->val = zeros(n);
  for (int i = 0; i < n; ++i) {
    c.B->start[i + 1] = i + 1;
    c.B->col[i] = i;
    c.B->val[i] = mu;
  }
  c.cp.dim = dim;
  c.cp.n = n;
  c.cp.m = m;
  c.cp.A = c.A;
  c.cp.f = c.f;
  c.cp.gap = c.gap;
  if (mu > 0.0) {
    c.cp.ut0 = c.ut0;
    c.cp.g0 = c.g0;
    c.cp.B = c.B;
  }
  return c;
}

static void unit(int n, const double *x, int power) {
  double *own = (double *)x; /* of the case, or of the test */
  for (int i = 0; own != NULL && i < n; ++i) own[i] = ldexp(own[i], power);
}

void case_units(contact_case *c, int length, int force) {
  const contact_problem *cp = &c->cp;
  const int m = cp->m, sides = m - cp->n, alone = cp->W == c->A;
  const int stiffness = force - length;
  unit(m * m, c->A, alone ? -stiffness : stiffness);
  unit(m, c->f, alone ? length : force);
  if (!alone) unit(m * m, cp->W, -stiffness);
  if (cp->f != c->f) unit(m, cp->f, length);
  unit(cp->n, c->gap, length);
  unit(sides, c->ut0, length);
  unit(cp->n, c->g0, force);
  unit(sides, c->side_gap, length);
  unit(m, c->u, length);
  unit(m, c->r, force);
  c->cp.load = ldexp(cp->load, force);
}

void case_free(contact_case *c) {
  free(c->A);
  free(c->f);
  free(c->gap);
  free(c->ut0);
  free(c->g0);
  free(c->side_gap);
  free(c->held);
  free(c->u);
  free(c->r);
  free(c->B->start);
  free(c->B->col);
  free(c->B->val);
  free(c->B);
}

void case_average(contact_case *c, int reach, double mu) {
  int n = c->cp.n, full = (reach + 1) * (reach + 1), e = 0;
  sparse_rows *B = c->B;
  free(B->col);
  free(B->val);
  B->col = calloc((size_t)(n * (2 * reach + 1)), sizeof *B->col);
  B->val = zeros(n * (2 * reach + 1));
  for (int i = 0; i < n; ++i) {
    for (int j = i - reach; j <= i + reach; ++j) {
      if (j < 0 || j >= n) continue;
      B->col[e] = j;
      B->val[e++] =
          (j < i ? 0.6 : 1.0) * mu * (reach + 1 - abs(i - j)) / full;
    }
    B->start[i + 1] = e;
  }
}

static void fill_spd(contact_case *c, unsigned long long *seed) {
  int m = c->cp.m;
  double *G = zeros(m * m);
  for (int i = 0; i < m * m; ++i) G[i] = case_random(seed) - 0.5;
  for (int i = 0; i < m; ++i) c->A[i + m * i] = 0.2;
  cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, m, m, 12.0 / m, G, m,
              1.0, c->A, m);
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < i; ++j) c->A[j + m * i] = c->A[i + m * j];
  free(G);
}

/* Neighbours joined by springs in random directions. */
static void fill_chain(contact_case *c, unsigned long long *seed) {
  int m = c->cp.m, d = c->cp.dim, n = c->cp.n;
  for (int i = 0; i < n; ++i)
    for (int s = 0; s < 3 * d; ++s) {
      double v[3], stiffness = 0.1 + case_random(seed);
      int other = i + 1 + (int)(3.0 * case_random(seed));
      for (int k = 0; k < d; ++k) v[k] = case_random(seed) - 0.5;
      for (int a = 0; a < d; ++a)
        for (int b = 0; b < d; ++b) {
          double k = stiffness * v[a] * v[b] + (a == b && s == 0 ? 0.05 : 0.0);
          c->A[i * d + a + m * (i * d + b)] += k;
          if (other >= n) continue;
          c->A[other * d + a + m * (other * d + b)] += k;
          c->A[i * d + a + m * (other * d + b)] -= k;
          c->A[other * d + a + m * (i * d + b)] -= k;
        }
    }
}

contact_case case_any(int dim, int n, double mu, int kind,
                      unsigned long long seed) {
  contact_case c = case_new(dim, n, mu);
  seed = seed * 2654435761u + 88172645463325252u; /* never zero              */
  for (int i = 0; i < 20; ++i) case_random(&seed);
  if (kind == 0)
    fill_spd(&c, &seed);
  else
    fill_chain(&c, &seed);
  double push = 2.0 * case_random(&seed) - 0.6;
  double gaps = case_random(&seed) < 0.5 ? 0.0 : 0.3;
  double moved = case_random(&seed) < 0.5 ? 0.0 : 0.5;
  for (int i = 0; i < n; ++i) {
    c.gap[i] = gaps * (case_random(&seed) - 0.2);
    for (int k = 0; k < dim; ++k)
      c.f[i * dim + k] = 2.0 * case_random(&seed) - 1.0 + (k == 0 ? push : 0.0);
    for (int k = 0; k < dim - 1; ++k)
      c.ut0[i * (dim - 1) + k] = moved * (case_random(&seed) - 0.5);
  }
  return c;
}

/* K of C from the gradient g of its shape function:
 * area ((lambda + G) g g' + G |g|^2 I); contact frame n = -y, t = x. */
contact_case case_triangle(double nu, double mu, double fx, double fy) {
  double A[2] = {-1, 1}, B[2] = {1, 3};
  double lambda = nu / ((1 + nu) * (1 - 2 * nu)), G = 0.5 / (1 + nu);
  double twice = fabs(A[0] * B[1] - A[1] * B[0]);
  double gx = (A[1] - B[1]) / twice, gy = (B[0] - A[0]) / twice;
  contact_case c = case_new(2, 1, mu);
  double square = G * (gx * gx + gy * gy);
  c.A[0] = 0.5 * twice * ((lambda + G) * gy * gy + square);
  c.A[3] = 0.5 * twice * ((lambda + G) * gx * gx + square);
  c.A[1] = c.A[2] = -0.5 * twice * (lambda + G) * gx * gy;
  c.f[0] = -fy;
  c.f[1] = fx;
  return c;
}

/* ---- block ------------------------------------------------------------- */

int case_inverse(int m, const double *A, double *W) {
  size_t n = (size_t)m;
  memcpy(W, A, n * n * sizeof *W);
  if (LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', m, W, m) != 0) return 0;
  if (LAPACKE_dpotri(LAPACK_COL_MAJOR, 'L', m, W, m) != 0) return 0;
  for (size_t j = 0; j < n; ++j)
    for (size_t i = 0; i < j; ++i) W[i + n * j] = W[j + n * i];
  return 1;
}

/* Stiffness of a triangle with corners x[3][2], plane strain, E = 1. */
static void triangle(double nu, double x[3][2], double K[6][6]) {
  double lambda = nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), G = 0.5 / (1.0 + nu);
  double twice = (x[1][0] - x[0][0]) * (x[2][1] - x[0][1]) -
                 (x[2][0] - x[0][0]) * (x[1][1] - x[0][1]);
  double g[3][2];
  for (int a = 0; a < 3; ++a) {
    const double *p = x[(a + 1) % 3], *q = x[(a + 2) % 3];
    g[a][0] = (p[1] - q[1]) / twice;
    g[a][1] = (q[0] - p[0]) / twice;
  }
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) {
      double dot = g[a][0] * g[b][0] + g[a][1] * g[b][1];
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j)
          K[2 * a + i][2 * b + j] =
              0.5 * twice *
              (lambda * g[a][i] * g[b][j] + G * g[a][j] * g[b][i] +
               (i == j ? G * dot : 0.0));
    }
}

/* Stiffness of one row of squares between two lines of nodes: low 0..n-1, high
 * n..2n-1; unknowns x, y. K[(4n)^2] */
static void row_stiffness(int columns, double nu, double *K) {
  int n = columns + 1, size = 4 * n;
  memset(K, 0, (size_t)size * (size_t)size * sizeof *K);
  for (int c = 0; c < columns; ++c)
    for (int half = 0; half < 2; ++half) {
      /* the diagonal alternates */
      int flip = c % 2;
      int quad[4] = {c, c + 1, n + c + 1, n + c};
      static const int corners[2][2][3] = {{{0, 1, 2}, {0, 2, 3}},
                                           {{0, 1, 3}, {1, 2, 3}}};
      double x[3][2], k[6][6];
      int id[3];
      for (int a = 0; a < 3; ++a) {
        id[a] = quad[corners[flip][half][a]];
        x[a][0] = id[a] % n;
        x[a][1] = id[a] / n;
      }
      triangle(nu, x, k);
      for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j)
          K[2 * id[i / 2] + i % 2 + size * (2 * id[j / 2] + j % 2)] += k[i][j];
    }
}

/* Unknowns along x of the last column: decoupled, with a stiffness of 1. */
static void hold_column(int n, int lines, double *K) {
  int size = 2 * n * lines;
  for (int line = 0; line < lines; ++line) {
    int dof = 2 * (line * n + n - 1);
    for (int i = 0; i < size; ++i) K[dof + size * i] = K[i + size * dof] = 0.0;
    K[dof + size * dof] = 1.0;
  }
}

/* Add constant tractions on the faces of one row of squares: f of the upper
 * line [2n] and of the lower line [2n]. */
static void row_load(const case_block_data *d, int is_top, double *upper,
                     double *lower) {
  int n = d->columns + 1, last = 2 * d->columns;
  for (int k = 0; k < 2; ++k) {
    upper[k] += 0.5 * d->left[k];
    lower[k] += 0.5 * d->left[k];
    upper[last + k] += 0.5 * d->right[k];
    lower[last + k] += 0.5 * d->right[k];
    for (int i = 0; is_top && i < n; ++i)
      upper[2 * i + k] += (i == 0 || i == n - 1 ? 0.5 : 1.0) * d->top[k];
  }
  if (d->symmetric) upper[last] = lower[last] = 0.0;
}

/* Global x, y of the lowest line to the contact frame: normal -y, tangent x. */
static void to_frame(contact_case *c, const double *S, const double *f) {
  int s = c->cp.m;
  for (int j = 0; j < s; ++j) {
    int b = j % 2 == 0 ? j + 1 : j - 1;
    c->f[b] = j % 2 == 1 ? -f[j] : f[j];
    for (int i = 0; i < s; ++i) {
      int a = i % 2 == 0 ? i + 1 : i - 1;
      double v = 0.5 * (S[i + s * j] + S[j + s * i]);
      c->A[a + s * b] = i % 2 != j % 2 ? -v : v;
    }
  }
}

contact_case case_block(const case_block_data *d) {
  int n = d->columns + 1, s = 2 * n, size = 4 * n;
  contact_case c = case_new(2, n, d->mu);
  double *K = zeros(size * size), *S = zeros(s * s), *X = zeros(s * (s + 1));
  double *upper = zeros(s), *lower = zeros(s);
  row_stiffness(d->columns, d->nu, K);
  if (d->symmetric) hold_column(n, 2, K);
  for (int layer = 0; layer < d->layers; ++layer) {
    int clamped = layer == 0 && d->clamped;
    memcpy(upper, lower, (size_t)s * sizeof *upper);
    memset(lower, 0, (size_t)s * sizeof *lower);
    row_load(d, layer == 0, upper, lower);
    /* S is the stiffness of what lies above the upper line, seen from it */
    for (int j = 0; j < s; ++j)
      for (int i = 0; i < s; ++i) {
        S[i + s * j] += K[s + i + size * (s + j)];
        X[i + s * j] = K[s + i + size * j];
      }
    memcpy(X + s * s, upper, (size_t)s * sizeof *X);
    if (clamped)
      memset(X, 0, (size_t)(s * (s + 1)) * sizeof *X);
    else
      LAPACKE_dposv(LAPACK_COL_MAJOR, 'L', s, s + 1, S, s, X, s);
    /* S = K_ll - K_lu X, lower -= K_lu x */
    for (int j = 0; j < s; ++j)
      memcpy(S + s * j, K + size * j, (size_t)s * sizeof *S);
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, s, s, s, -1.0,
                K + size * s, size, X, s, 1.0, S, s);
    cblas_dgemv(CblasColMajor, CblasNoTrans, s, s, -1.0, K + size * s, size,
                X + s * s, 1, 1.0, lower, 1);
  }
  to_frame(&c, S, lower);
  c.cp.floating = !d->clamped;
  if (d->symmetric) {
    c.held = calloc((size_t)s, 1);
    c.held[s - 1] = 1;
    c.cp.held = c.held;
  }
  free(K);
  free(S);
  free(X);
  free(upper);
  free(lower);
  return c;
}

contact_case case_published(int columns, double mu) {
  case_block_data d = {.columns = columns,
                       .layers = columns,
                       .symmetric = 1,
                       .nu = 0.2,
                       .mu = mu,
                       .top = {0, -50.0 / 130e3},
                       .left = {150.0 / 130e3, 0}};
  return case_block(&d);
}

/* ---- independent check ------------------------------------------------- */

static double worse(double a, double b) { return !(b <= a) ? b : a; }

/* Sliding limit of a node from the normal forces, N. */
static double node_limit(const contact_problem *cp, const double *r, int i) {
  double g = cp->g0[i];
  for (int e = 0; cp->B != NULL && e < cp->B->start[i + 1]; ++e)
    if (e >= cp->B->start[i])
      g += cp->B->val[e] * fmax(0.0, -r[cp->B->col[e] * cp->dim]);
  return g;
}

static double node_violation(const contact_case *c, const double *u,
                             const double *r, int i) {
  const contact_problem *cp = &c->cp;
  int d = cp->dim, m = cp->m, first = i * d;
  double k = c->A[(size_t)first * (size_t)m + (size_t)first];
  double open = cp->gap[i] - u[first], push = -r[first], g = 0.0;
  double bad = worse(worse(0.0, -push), -k * open);
  bad = worse(bad, fmin(fmax(push, 0.0), fmax(k * open, 0.0)));
  if (cp->g0 != NULL) g = node_limit(cp, r, i);
  double t = 0.0, s = 0.0, dot = 0.0, cross = 0.0;
  for (int a = 1; a < d; ++a) {
    if (cp->held != NULL && cp->held[first + a]) {
      bad = worse(bad, fabs(r[first + a]));
      continue;
    }
    double slip = u[first + a] - (cp->ut0 ? cp->ut0[i * (d - 1) + a - 1] : 0.0);
    t += r[first + a] * r[first + a];
    s += slip * slip;
    dot += slip * r[first + a];
  }
  t = sqrt(t);
  s = sqrt(s);
  if (cp->g0 == NULL) return worse(bad, t);
  if (d == 3)
    cross = fabs(
        (u[first + 1] - (cp->ut0 ? cp->ut0[2 * i] : 0.0)) * r[first + 2] -
        (u[first + 2] - (cp->ut0 ? cp->ut0[2 * i + 1] : 0.0)) * r[first + 1]);
  bad = worse(bad, t - g);
  /* slip only at the limit, and opposite */
  bad = worse(bad, fmin(k * s, fmax(g - t, 0.0)));
  if (s > 0.0) bad = worse(bad, fmin(k * s, fmax(0.0, dot / s + t)));
  /* the one turned into the line of the other: the cheaper of the two */
  if (cross > 0.0) bad = worse(bad, fmin(k * s / t, 1.0) * (cross / s));
  return bad;
}

double case_violation(const contact_case *c, const double *u, const double *r) {
  const contact_problem *cp = &c->cp;
  size_t m = (size_t)cp->m;
  double scale = 0.0, bad = 0.0;
  for (size_t i = 0; i < m; ++i) {
    double sum = -cp->f[i] - r[i];
    for (size_t j = 0; j < m; ++j) sum += c->A[i + m * j] * u[j];
    bad = worse(bad, fabs(sum));
    scale = worse(scale, fabs(r[i]));
    scale = worse(scale, fabs(cp->f[i]));
    scale = worse(scale, c->A[i + m * i] * fabs(u[i]));
  }
  for (int i = 0; i < cp->n; ++i) bad = worse(bad, node_violation(c, u, r, i));
  return scale > 0.0 ? bad / scale : bad;
}
