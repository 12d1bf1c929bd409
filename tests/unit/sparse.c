/* src/base/matrix/sparse.c: products with blocks against those with all
 * entries. */
#include "base/sparse.h"
#include "support/contact_case.h"
#include "support/unit.h"

enum { N = 7, MOST = 3 * N };

/* Random entries, each in two parts, some zero; M[m*m] column major. */
static sparse_blocks *make(int dim, unsigned long long seed, double *M) {
  int m = dim * N, row[2 * MOST], col[2 * MOST];
  double val[2 * MOST];
  sparse_blocks *b = NULL;
  memset(M, 0, sizeof *M * MOST * MOST);
  for (int k = 0; k < 2 * m; k += 2) {
    row[k] = row[k + 1] = (int)(m * case_random(&seed));
    col[k] = col[k + 1] = (int)(m * case_random(&seed));
    val[k] = k % 6 == 0 ? 0.0 : case_random(&seed) - 0.5;
    val[k + 1] = 0.5 * val[k];
    M[row[k] + m * col[k]] += val[k] + val[k + 1];
  }
  ck_assert_int_eq(sparse_blocks_new(dim, N, 2 * m, row, col, val, &b), OK);
  return b;
}

TEST(products_are_those_of_all_entries) {
  for (int k = 0; k < 30; ++k) {
    int d = 1 + k % 3, m = d * N;
    unsigned long long seed = 7u + (unsigned)k;
    double M[MOST * MOST], D[MOST * MOST], x[MOST], y[MOST], z[MOST], row[3];
    OWNED sparse_blocks *b = make(d, seed, M);
    sparse_blocks_dense(b, D);
    for (int i = 0; i < m * m; ++i) ck_assert(fabs(D[i] - M[i]) <= 1e-15);
    for (int i = 0; i < m; ++i) x[i] = i / d == 2 ? 0.0 : case_random(&seed);
    sparse_blocks_product(b, x, y);
    sparse_blocks_bound(b, x, z);
    for (int i = 0; i < m; ++i) {
      double sum = 0.0, size = 0.0;
      for (int j = 0; j < m; ++j) sum += M[i + m * j] * x[j];
      for (int j = 0; j < m; ++j) size += fabs(M[i + m * j]) * x[j];
      sparse_blocks_row(b, i / d, x, row);
      ck_assert(fabs(y[i] - sum) <= 1e-14);
      ck_assert(fabs(z[i] - size) <= 1e-14);
      ck_assert(fabs(row[i % d] - sum) <= 1e-14);
      ck_assert(sparse_blocks_own(b, i / d)[i % d * (d + 1)] == D[i * (m + 1)]);
    }
  }
}

TEST(rows_ascend_and_hold_what_is_not_zero) {
  for (int k = 0; k < 12; ++k) {
    int d = 1 + k % 3, m = d * N, count = 0;
    double M[MOST * MOST];
    OWNED sparse_blocks *b = make(d, 70u + (unsigned)k, M);
    sparse_rows rows = {0};
    ck_assert_int_eq(sparse_blocks_rows(b, &rows), OK);
    ck_assert_int_eq(rows.n, m);
    for (int i = 0; i < m * m; ++i) count += M[i] != 0.0;
    ck_assert_int_eq(rows.start[m], count);
    for (int i = 0; i < m; ++i)
      for (int e = rows.start[i]; e < rows.start[i + 1]; ++e) {
        ck_assert(e == rows.start[i] || rows.col[e] > rows.col[e - 1]);
        ck_assert(fabs(rows.val[e] - M[i + m * rows.col[e]]) <= 1e-15);
      }
    sparse_free(&rows);
  }
}

UNIT_MAIN("sparse")
