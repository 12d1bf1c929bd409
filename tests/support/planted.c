#include "support/planted.h"

#include "base/base.h"
#include "support/contact_case.h"

#include <check.h>

static double *numbers(int n) {
  double *x = calloc((size_t)n + 1, sizeof *x);
  ck_assert_ptr_nonnull(x);
  return x;
}

/* W of contacts i between the bodies i/per and i/per + 1, "per" to a pair. */
static void fill_compliance(planted *p, planted_kind kind,
                            unsigned long long *seed) {
  int d = p->cp.dim, m = p->cp.m, f = d == 2 ? 3 : 6;
  int per = kind == PLANTED_REGULAR ? 1 : kind == PLANTED_CROWDED ? p->cp.n : 3;
  int bodies = p->cp.n / per + 2;
  double *H = numbers(m * bodies * f);
  for (int b = 0; b < bodies; ++b) {
    double mass = kind == PLANTED_SCALED ? pow(10.0, 8.0 * case_random(seed))
                                         : 1.0 + case_random(seed);
    for (int i = 0; i < m; ++i)
      for (int k = 0; k < f; ++k)
        if (i / d / per == b || i / d / per + 1 == b)
          H[i + m * (f * b + k)] = (case_random(seed) - 0.5) / sqrt(mass);
  }
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < m; ++i)
      for (int k = 0; k < f * bodies; ++k)
        p->W[i + m * j] += H[i + m * k] * H[j + m * k];
  free(H);
}

/* Forces and displacements of contact i: open, slip, stick in turn. */
static void plant(planted *p, int i, double mu, unsigned long long *seed) {
  int d = p->cp.dim, first = i * d;
  double *u = p->u + first, *r = p->r + first, length = 0.0, e[2];
  double own = p->W[(first) * (p->cp.m + 1)];
  for (int k = 0; k < d - 1; ++k) e[k] = case_random(seed) - 0.5;
  for (int k = 0; k < d - 1; ++k) length = hypot(length, e[k]);
  double force = 0.5 + case_random(seed),
         move = own * (0.5 + case_random(seed));
  u[0] = i % 3 == 0 ? -move : 0.0;
  r[0] = i % 3 == 0 ? 0.0 : -force;
  for (int k = 1; k < d; ++k) {
    double share = e[k - 1] / length;
    u[k] = i % 3 == 2 ? 0.0 : move * share;
    r[k] = i % 3 == 0 ? 0.0 : -mu * force * share * (i % 3 == 2 ? 0.5 : 1.0);
  }
}

static void give_blocks(planted *p) {
  int m = p->cp.m;
  int *row = calloc((size_t)(m * m), sizeof *row);
  int *col = calloc((size_t)(m * m), sizeof *col);
  for (int k = 0; k < m * m; ++k) {
    row[k] = k % m;
    col[k] = k / m;
  }
  ck_assert_int_eq(sparse_blocks_new(p->cp.dim, p->cp.n, (long)m * m, row, col,
                                     p->W, &p->blocks),
                   OK);
  free(row);
  free(col);
}

planted planted_new(planted_kind kind, int dim, int n, double mu,
                    unsigned long long seed) {
  int m = dim * n;
  planted p = {.cp = {.dim = dim, .n = n, .m = m},
               .W = numbers(m * m),
               .q = numbers(m),
               .gap = numbers(n),
               .ut0 = numbers(m),
               .g0 = numbers(n),
               .u = numbers(m),
               .r = numbers(m)};
  seed = 2685821657736338717u * (seed + 1u);
  fill_compliance(&p, kind, &seed);
  p.B = malloc(sizeof *p.B);
  *p.B = (sparse_rows){n, calloc((size_t)n + 1, sizeof(int)),
                       calloc((size_t)n, sizeof(int)), numbers(n)};
  for (int i = 0; i < n; ++i) {
    plant(&p, i, mu, &seed);
    p.B->start[i + 1] = i + 1;
    p.B->col[i] = i;
    p.B->val[i] = mu;
  }
  for (int i = 0; i < m; ++i) {
    p.q[i] = p.u[i];
    for (int j = 0; j < m; ++j) p.q[i] -= p.W[i + m * j] * p.r[j];
  }
  give_blocks(&p);
  p.cp.blocks = p.blocks;
  p.cp.f = p.q;
  p.cp.gap = p.gap;
  p.cp.ut0 = p.ut0;
  p.cp.g0 = p.g0;
  p.cp.B = p.B;
  return p;
}

void planted_free(planted *p) {
  double *const arrays[] = {p->W,  p->q, p->gap, p->ut0,
                            p->g0, p->u, p->r,   p->B->val};
  for (size_t i = 0; i < sizeof arrays / sizeof *arrays; ++i) free(arrays[i]);
  free(p->B->start);
  free(p->B->col);
  free(p->B);
  memory_free(p->blocks);
}

/* Natural map of a contact, in metres: the error of its forces over the step.
 */
static double map_of(const planted *p, int i, const double *x,
                     const double *r) {
  int d = p->cp.dim, m = p->cp.m, first = i * d;
  double z[3], length = 0.0, worst = 0.0, t = 0.0;
  double step = p->W[first * (m + 1)];
  for (int k = 1; k < d; ++k) t += p->W[(first + k) * (m + 1)] / (d - 1);
  z[0] = fmin(0.0, r[first] - x[first] / step);
  worst = step * fabs(r[first] - z[0]);
  for (int k = 1; k < d; ++k) {
    z[k] = r[first + k] - x[first + k] / t;
    length = hypot(length, z[k]);
  }
  double g = p->B->val[i] * fmax(0.0, -r[first]);
  for (int k = 1; k < d; ++k)
    worst = fmax(
        worst, t * fabs(r[first + k] - (length > g ? g / length : 1.0) * z[k]));
  return worst;
}

double planted_map(const planted *p, const double *u, const double *r) {
  int m = p->cp.m;
  double *x = numbers(m), worst = 0.0, size = 0.0;
  for (int i = 0; i < m; ++i) {
    x[i] = p->q[i];
    for (int j = 0; j < m; ++j) x[i] += p->W[i + m * j] * r[j];
    worst = fmax(worst, fabs(x[i] - u[i]));
    size = fmax(size, fabs(p->q[i]));
  }
  for (int i = 0; i < p->cp.n; ++i) worst = fmax(worst, map_of(p, i, x, r));
  free(x);
  return worst / size;
}
