/*
 * Sparse matrices by rows.
 */
#include "base/sparse.h"

#include "base/memory.h"

#include <string.h>

void sparse_free(sparse_rows *rows) {
  memory_free(rows->start);
  memory_free(rows->col);
  memory_free(rows->val);
  memset(rows, 0, sizeof *rows);
}
