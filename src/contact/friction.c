/*
 * The list of friction laws and their common limit g = g0 + B p.
 */
#include "contact/friction.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>
#include <strings.h>

#define FRICTION_ROW(name) &name##_friction,
const friction_ops *const friction_list[] = {FRICTION_LIST(FRICTION_ROW) NULL};
const option friction_no_options[] = {OPTION_END};

const friction_ops *friction_find(const char *name) {
  for (int k = 0; friction_list[k] != NULL; ++k)
    if (strcasecmp(friction_list[k]->name, name) == 0) return friction_list[k];
  return NULL;
}

status friction_limit_new(int n, friction_limit *out) {
  memset(out, 0, sizeof *out);
  PASS_NEW(out->g0, n);
  return OK;
}

void friction_limit_free(friction_limit *limit) {
  if (limit == NULL) return;
  RELEASE(limit->g0, limit->in_zone);
  sparse_free(&limit->B);
  memset(limit, 0, sizeof *limit);
}

static void coordinates(const contact_surface *s, int i, double *x) {
  for (int c = 0; c < 3; ++c) x[c] = c < s->dim ? s->x[s->dim * i + c] : 0.0;
}

status friction_value(const friction_card *card, const contact_surface *s,
                      int i, double t, double *value) {
  double x[3];
  coordinates(s, i, x);
  *value = quantity_value(&card->value, x, t);
  if (!isfinite(*value) || *value < 0)
    RAISE(ERR_DECK,
          "*FRICTION: value %g at node %zu (%g, %g, %g), time %g; expected a "
          "number that is not negative",
          *value, s->node_no[i], x[0], x[1], x[2], t);
  return OK;
}

/* Entries of row i once the rows of part are in place. */
static int row_length(const sparse_rows *old, const sparse_rows *part, int row,
                      int i) {
  int n = old->start == NULL ? 0 : old->start[i + 1] - old->start[i];
  return n + (row < 0 ? 0 : part->start[row + 1] - part->start[row]);
}

static void copy_row(const sparse_rows *from, int row, sparse_rows *to, int i) {
  int n = from->start[row + 1] - from->start[row];
  for (int k = 0; k < n; ++k) {
    to->col[to->start[i] + k] = from->col[from->start[row] + k];
    to->val[to->start[i] + k] = from->val[from->start[row] + k];
  }
}

/* Put row k of part (columns: contact nodes) into row node[k] of B, which was
 * empty. */
static status add_rows(friction_limit *out, int n, const int *node,
                       const sparse_rows *part) {
  status st = OK;
  const sparse_rows *old = &out->B;
  sparse_rows all = {.n = n};
  int *row_of = NULL;
  NEW(row_of, n);
  for (int i = 0; i < n; ++i) row_of[i] = -1;
  for (int k = 0; k < part->n; ++k) row_of[node[k]] = k;
  NEW(all.start, n + 1);
  for (int i = 0; i < n; ++i)
    all.start[i + 1] = all.start[i] + row_length(old, part, row_of[i], i);
  NEW(all.col, all.start[n]);
  NEW(all.val, all.start[n]);
  for (int i = 0; i < n; ++i) {
    if (row_of[i] >= 0)
      copy_row(part, row_of[i], &all, i);
    else if (old->start != NULL)
      copy_row(old, i, &all, i);
  }
  sparse_free(&out->B);
  out->B = all;
  memset(&all, 0, sizeof all);
done:
  sparse_free(&all);
  memory_free(row_of);
  return st;
}

/* Entries of the average at node i, 1 without one. */
static int average_size(const sparse_rows *average, int i) {
  return average == NULL ? 1 : average->start[i + 1] - average->start[i];
}

/* mu times the average at node i, to place n of rows. */
static void add_average(const sparse_rows *average, int i, double mu,
                        sparse_rows *rows, int n) {
  if (average == NULL) {
    rows->col[n] = i;
    rows->val[n] = mu;
    return;
  }
  for (int e = average->start[i]; e < average->start[i + 1]; ++e, ++n) {
    rows->col[n] = average->col[e];
    rows->val[n] = mu * average->val[e];
  }
}

status friction_pressure_limit(const friction_card *card,
                               const contact_surface *s, int n_node,
                               const int *node, double t, friction_limit *out) {
  status st = OK;
  sparse_rows rows = {.n = n_node};
  NEW(rows.start, n_node + 1);
  for (int k = 0; k < n_node; ++k)
    rows.start[k + 1] =
        rows.start[k] + (surface_is_corner(s, node[k])
                             ? 0
                             : average_size(card->average, node[k]));
  NEW(rows.col, rows.start[n_node]);
  NEW(rows.val, rows.start[n_node]);
  for (int k = 0; k < n_node; ++k) {
    double mu;
    if (surface_is_corner(s, node[k])) continue;
    TRY(friction_value(card, s, node[k], t, &mu));
    add_average(card->average, node[k], mu, &rows, rows.start[k]);
  }
  TRY(add_rows(out, s->n, node, &rows));
done:
  sparse_free(&rows);
  return st;
}
