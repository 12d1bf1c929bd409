/*
 * Sparse matrices by rows, and vectors.
 */
#include "base/sparse.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

void sparse_free(sparse_rows *rows) {
  memory_free(rows->start);
  memory_free(rows->col);
  memory_free(rows->val);
  memset(rows, 0, sizeof *rows);
}

double largest_entry(size_t n, const double *v) {
  double most = 0.0;
  for (size_t i = 0; i < n; ++i) most = fmax(most, fabs(v[i]));
  return most;
}
