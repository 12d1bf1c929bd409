/* Answers of a plane problem by trying all states (state_list.h). */
#include "support/state_list.h"

#include "base/base.h"

#include <lapacke.h>

enum { STATES = 4, MOST = 2 * MOST_LISTED_NODES };
typedef enum { OPEN, STICK, SLIP_UP, SLIP_DOWN } node_state;
static const double SINGULAR = 1e-10, VALID = 1e-11, SAME = 1e-9;

static int state_of(int set, int node) {
  for (int i = 0; i < node; ++i) set /= STATES;
  return set % STATES;
}

/* K u = b: two equations for every node, from its state. */
static void equations(const contact_case *c, int set, double *K, double *b) {
  int m = c->cp.m;
  memset(K, 0, sizeof *K * (size_t)(m * m));
  for (int i = 0; i < c->cp.n; ++i) {
    int n = 2 * i, t = n + 1, state = state_of(set, i);
    double stick = c->cp.ut0 == NULL ? 0.0 : c->ut0[i];
    double g0 = c->cp.g0 == NULL ? 0.0 : c->g0[i];
    double sign = state == SLIP_UP ? 1.0 : state == SLIP_DOWN ? -1.0 : 0.0;
    if (state != OPEN) {
      K[n + m * n] = 1.0;
      b[n] = c->gap[i];
    } else {
      for (int j = 0; j < m; ++j) K[n + m * j] = c->A[n + m * j];
      b[n] = c->f[n];
    }
    if (state == STICK) {
      K[t + m * t] = 1.0;
      b[t] = stick;
      continue;
    }
    /* r_t = -sign g: friction against the slip; g from all pressures, those of
     * open nodes are zero. An open node slides as its limit says. */
    double mu = c->cp.B == NULL ? 0.0 : c->B->val[i];
    int from = c->cp.B == NULL ? 0 : 2 * c->B->col[i];
    for (int j = 0; j < m; ++j)
      K[t + m * j] = c->A[t + m * j] - sign * mu * c->A[from + m * j];
    b[t] = c->f[t] - sign * g0 - sign * mu * c->f[from];
  }
}

/* 1: solved; 0: singular. */
static int solve(int m, double *K, double *b) {
  int pivot[MOST], iwork[MOST];
  double work[4 * MOST], rcond = 0.0;
  double norm = LAPACKE_dlange(LAPACK_COL_MAJOR, '1', m, m, K, m);
  if (LAPACKE_dgetrf(LAPACK_COL_MAJOR, m, m, K, m, pivot) != 0) return 0;
  LAPACKE_dgecon_work(LAPACK_COL_MAJOR, '1', m, K, m, norm, &rcond, work,
                      iwork);
  LAPACKE_dgetrs(LAPACK_COL_MAJOR, 'N', m, 1, K, m, pivot, b, m);
  return rcond > SINGULAR;
}

static int is_new(const state_list *list, int m, const double *u) {
  for (int k = 0; k < list->n; ++k) {
    double most = 0.0, size = 0.0;
    for (int j = 0; j < m; ++j) {
      most = fmax(most, fabs(u[j] - list->u[k * m + j]));
      size = fmax(size, fabs(u[j]));
    }
    if (most <= SAME * size) return 0;
  }
  return 1;
}

int state_list_new(const contact_case *c, state_list *list) {
  int n = c->cp.n, m = c->cp.m, sets = 1;
  double K[MOST * MOST], u[MOST], r[MOST];
  *list = (state_list){0};
  if (c->cp.dim != 2 || n > MOST_LISTED_NODES || c->cp.A == NULL) return 0;
  for (int i = 0; i < n; ++i) sets *= STATES;
  list->u = calloc((size_t)(sets * m), sizeof *list->u);
  for (int set = 0; set < sets; ++set) {
    equations(c, set, K, u);
    if (!solve(m, K, u)) {
      list->n = 0;
      return 0;
    }
    for (int i = 0; i < m; ++i) {
      r[i] = -c->f[i];
      for (int j = 0; j < m; ++j) r[i] += c->A[i + m * j] * u[j];
    }
    if (case_violation(c, u, r) > VALID || !is_new(list, m, u)) continue;
    memcpy(list->u + list->n++ * m, u, sizeof *u * (size_t)m);
  }
  return list->n > 0;
}

void state_list_free(state_list *list) { free(list->u); }
