/* Matrix of a step of the proximal point iteration (system.h). */
#include "solver/newton/system.h"

#include <lapacke.h>
#include <umfpack.h>

struct step_matrix {
  int m, k;                       /* unknowns; of them in the system */
  sparse_rows own;                /* rows of W where the set has none */
  const sparse_rows *W;           /* the one or the other */
  int *place;                     /* [m] in the system, -1: eliminated */
  double *line;                   /* [m] the current row */
  int n_touched, *touched;        /* [m] its entries; all of a dense W */
  unsigned char *is_touched;      /* [m] */
  const double *d;                /* [m] borrowed */
  double *rhs, *x;                /* [m] */
  double *full;                   /* [m*m] rows of the system, one after the
                                     other */
  int *pivot;                     /* [m] */
  sparse_rows rows;               /* the same where W is sparse */
  int col_capacity, val_capacity; /* entries of rows */
  double control[UMFPACK_CONTROL];
};

static int is_sparse(const step_matrix *s) { return s->full == NULL; }

status step_matrix_new(const contact_problem *cp, const force_set *set,
                       step_matrix **out) {
  size_t m = cp->m;
  MAKES(step_matrix, s, out);
  s->m = cp->m;
  s->W = &set->rows;
  PASS_NEW_ALL(OF(s->place, m), OF(s->line, m), OF(s->touched, m),
               OF(s->is_touched, m), OF(s->rhs, m), OF(s->x, m));
  memory_count_suitesparse();
  umfpack_di_defaults(s->control);
  s->control[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_SYMMETRIC;
  s->control[UMFPACK_IRSTEP] = 0;
  if (set->rows.start != NULL) {
    PASS_NEW(s->rows.start, m + 1);
  } else {
    PASS(compliance_rows(cp, &s->own));
    s->W = &s->own;
    PASS_NEW_ALL(OF(s->full, m * m), OF(s->pivot, m));
    for (int i = 0; i < s->m; ++i) step_matrix_add(s, i, 0.0);
  }
  return OK;
}

void step_matrix_begin(step_matrix *s, const unsigned char *acts,
                       const double *d) {
  s->k = 0;
  s->d = d;
  s->rows.n = 0;
  for (int i = 0; i < s->m; ++i) s->place[i] = acts[i] ? s->k++ : -1;
}

void step_matrix_add(step_matrix *s, int j, double value) {
  s->line[j] += value;
  if (s->is_touched[j]) return;
  s->is_touched[j] = 1;
  s->touched[s->n_touched++] = j;
}

void step_matrix_add_row(step_matrix *s, int j, double share) {
  const sparse_rows *W = s->W;
  for (int k = W->start[j]; k < W->start[j + 1]; ++k)
    if (is_sparse(s))
      step_matrix_add(s, W->col[k], share * W->val[k]);
    else
      s->line[W->col[k]] += share * W->val[k];
}

/* The entries of the current row in ascending order; the rows of W that they
 * come from ascend. */
static void sort_touched(step_matrix *s) {
  for (int a = 1; a < s->n_touched; ++a) {
    int j = s->touched[a], b = a;
    for (; b > 0 && s->touched[b - 1] > j; --b)
      s->touched[b] = s->touched[b - 1];
    s->touched[b] = j;
  }
}

/* Contribution of the eliminated unknowns to the right side; their entries of
 * the line are cleared. */
static double take_out(step_matrix *s, int i) {
  double rhs = s->d[i];
  for (int a = 0; a < s->n_touched; ++a) {
    const int j = s->touched[a];
    if (s->place[j] >= 0) continue;
    rhs -= s->line[j] * s->d[j];
    s->line[j] = 0.0;
  }
  return rhs;
}

static status put_sparse(step_matrix *s, int row) {
  int n = s->rows.start[row];
  OWNS(s);
  for (int a = 0; a < s->n_touched; ++a) {
    const int j = s->touched[a];
    if (s->line[j] == 0.0) continue;
    PASS_GROW(s->rows.col, n, s->col_capacity);
    PASS_GROW(s->rows.val, n, s->val_capacity);
    s->rows.col[n] = s->place[j];
    s->rows.val[n++] = s->line[j];
  }
  s->rows.start[row + 1] = n;
  for (int a = 0; a < s->n_touched; ++a) {
    s->line[s->touched[a]] = 0.0;
    s->is_touched[s->touched[a]] = 0;
  }
  s->n_touched = 0;
  return OK;
}

static void put_dense(step_matrix *s, int row) {
  double *to = s->full + (size_t)row * s->k;
  for (int j = 0; j < s->m; ++j)
    if (s->place[j] >= 0) to[s->place[j]] = s->line[j];
  CLEAR(s->line, s->m);
}

status step_matrix_put(step_matrix *s, int i) {
  const int row = s->place[i];
  if (is_sparse(s)) sort_touched(s);
  s->rhs[row] = take_out(s, i);
  if (is_sparse(s)) return put_sparse(s, row);
  put_dense(s, row);
  return OK;
}

/* The rows one after the other are the transpose by columns. */
static int solve_dense(step_matrix *s) {
  int k = s->k;
  COPY(s->x, s->rhs, k);
  if (LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, k, k, s->full, k, s->pivot) != 0)
    return 0;
  LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, 'T', k, 1, s->full, k, s->pivot, s->x,
                      k);
  return 1;
}

static status solve_sparse(step_matrix *s, int *singular) {
  double info[UMFPACK_INFO];
  void *symbolic = NULL, *numeric = NULL;
  const sparse_rows *a = &s->rows;
  int k = s->k;
  int end = umfpack_di_symbolic(k, k, a->start, a->col, a->val, &symbolic,
                                s->control, info);
  if (end == UMFPACK_OK)
    end = umfpack_di_numeric(a->start, a->col, a->val, symbolic, &numeric,
                             s->control, info);
  if (end == UMFPACK_OK)
    end = umfpack_di_solve(UMFPACK_At, a->start, a->col, a->val, s->x, s->rhs,
                           numeric, s->control, info);
  umfpack_di_free_symbolic(&symbolic);
  umfpack_di_free_numeric(&numeric);
  *singular = end != UMFPACK_OK;
  if (end == UMFPACK_ERROR_out_of_memory)
    RAISE(ERR_MEMORY, "memory exhausted: factor of %d sparse rows", k);
  return OK;
}

status step_matrix_solve(step_matrix *s, double *d, int *singular) {
  *singular = 0;
  if (s->k == 0) return OK;
  if (is_sparse(s))
    PASS(solve_sparse(s, singular));
  else
    *singular = !solve_dense(s);
  for (int i = 0; i < s->m && !*singular; ++i)
    if (s->place[i] >= 0) d[i] = s->x[s->place[i]];
  return OK;
}
