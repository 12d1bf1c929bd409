/* The condensed stiffness as an operator (operator.h). */
#include "fem/operator.h"

#include "base/memory.h"
#include "base/timer.h"

#include <math.h>
#include <string.h>

static const double NO_PIVOT = 0x1p-42; /* -, of the diagonal: singular */

static size_t all_unknowns(const stiffness *k) {
  return (size_t)k->dim * (size_t)k->n_node;
}

/* Block p of node j times part of x into y; size: magnitudes, or NULL. */
static void add_block(const stiffness *k, size_t p, int j, const double *x,
                      double *y, double *size) {
  const size_t dim = (size_t)k->dim, a = dim * (size_t)k->row[p],
               b = dim * (size_t)j;
  const double *block = k->block + dim * dim * p;
  for (size_t c = 0; c < dim; ++c)
    for (size_t r = 0; r < dim; ++r) {
      const double e = block[dim * c + r];
      y[a + r] += e * x[b + c];
      if (a != b) y[b + c] += e * x[a + r];
      if (size == NULL) continue;
      size[a + r] += fabs(e * x[b + c]);
      if (a != b) size[b + c] += fabs(e * x[a + r]);
    }
}

/* y = K x, x zero at prescribed components; what y has there means nothing. */
static void product(const stiffness *k, const double *x, double *y,
                    double *size) {
  memset(y, 0, all_unknowns(k) * sizeof *y);
  if (size != NULL) memset(size, 0, all_unknowns(k) * sizeof *size);
  for (int j = 0; j < k->n_node; ++j)
    for (size_t p = k->start[j]; k->free[j] && p < k->start[j + 1]; ++p)
      if (k->free[k->row[p]]) add_block(k, p, j, x, y, size);
}

/* v = inv(K_ii) v_i, zero elsewhere. */
static void solve_interior(sparse_operator *o, double *v) {
  for (int q = 0; q < o->k->n_row; ++q) v[o->unknown[q]] = 0.0;
  body_factor_plain_solve(&o->f, o->inner, v, o->cm);
}

/* ---- what the contact problem sees ----------------------------------------
 */

/* v -= Q Q'v: no force by a rigid motion, no motion of forces. */
static void project(const sparse_operator *o, double *v) {
  const rigid_motions *r = o->rigid;
  const size_t m = (size_t)o->k->n_row;
  for (int c = 0; c < r->k; ++c) {
    const double *q = r->Q + m * (size_t)c;
    double sum = 0.0;
    for (size_t i = 0; i < m; ++i) sum += q[i] * v[i];
    for (size_t i = 0; i < m; ++i) v[i] -= sum * q[i];
  }
}

/* o->v: u at the contact unknowns, Au[m] its projection, and the interior that
 * follows. */
static void follow(sparse_operator *o, const double *u, double *Au) {
  const int m = o->k->n_row;
  memcpy(Au, u, (size_t)m * sizeof *Au);
  project(o, Au);
  memset(o->v, 0, all_unknowns(o->k) * sizeof *o->v);
  for (int q = 0; q < m; ++q)
    if (!o->held[q]) o->v[o->unknown[q]] = Au[q];
  product(o->k, o->v, o->w, NULL);
  solve_interior(o, o->w);
  for (long p = 0; p < o->f.n; ++p)
    o->v[o->f.unknown[p]] -= o->w[o->f.unknown[p]];
}

/* Forces o->w at the contact unknowns. */
static void gather(sparse_operator *o, const double *u, double *Au) {
  for (int q = 0; q < o->k->n_row; ++q)
    Au[q] = o->held[q] ? o->diagonal[q] * u[q] : o->w[o->unknown[q]];
  project(o, Au);
}

static void apply(void *ctx, const double *u, double *Au) {
  sparse_operator *o = ctx;
  follow(o, u, Au);
  product(o->k, o->v, o->w, NULL);
  gather(o, u, Au);
}

static void apply_sizes(void *ctx, const double *u, double *Au, double *size) {
  sparse_operator *o = ctx;
  follow(o, u, Au);
  product(o->k, o->v, o->w, o->sizes);
  gather(o, u, Au);
  for (int q = 0; q < o->k->n_row; ++q)
    size[q] = o->held[q] ? fabs(Au[q]) : o->sizes[o->unknown[q]];
}

/* 1: the factor is of these rows. */
static int is_ready(const sparse_operator *o, const known_rows *rows) {
  const size_t m = (size_t)o->k->n_row, size = (size_t)o->k->rows * m;
  if (o->state != OF_ROWS || memcmp(o->known, rows->known, m) != 0) return 0;
  for (size_t i = 0; i < size; ++i)
    if (o->added[i] != (rows->added != NULL ? rows->added[i] : 0.0)) return 0;
  return 1;
}

static void take_rows(sparse_operator *o, const known_rows *rows) {
  const size_t m = (size_t)o->k->n_row, size = (size_t)o->k->rows * m;
  memcpy(o->known, rows->known, m);
  if (rows->added != NULL)
    memcpy(o->added, rows->added, size * sizeof *o->added);
  else
    memset(o->added, 0, size * sizeof *o->added);
  o->f.known = o->known;
  o->f.added = o->added;
  o->f.pinned = NULL;
}

static status set_rows(void *ctx, const known_rows *rows, int *singular) {
  sparse_operator *o = ctx;
  *singular = 0;
  if (rows->known == NULL) return sparse_operator_all_rows(o);
  if (is_ready(o, rows)) return OK;
  take_rows(o, rows);
  o->state = NO_FACTOR;
  status st = body_factor_renew(o->k, o->number, o->cm, &o->f);
  if (st == ERR_SINGULAR) {
    status_clear();
    *singular = 1;
    return OK;
  }
  PASS(st);
  *singular =
      o->rigid->n_set > 0 && !(body_factor_least_pivot(o->k, &o->f) > NO_PIVOT);
  if (!*singular) o->state = OF_ROWS;
  return OK;
}

static int is_known(const sparse_operator *o, int row) {
  return o->state == OF_ROWS && o->known[row];
}

static void solve(void *ctx, const double *b, double *x, double *Ax) {
  sparse_operator *o = ctx;
  const int m = o->k->n_row;
  int moved = 0;
  memset(o->v, 0, all_unknowns(o->k) * sizeof *o->v);
  for (int q = 0; q < m; ++q) {
    if (!is_known(o, q) || o->held[q]) continue;
    o->v[o->unknown[q]] = x[q];
    moved |= x[q] != 0.0;
  }
  if (moved)
    product(o->k, o->v, o->w, NULL);
  else
    memset(o->w, 0, all_unknowns(o->k) * sizeof *o->w);
  for (long p = 0; p < o->f.n; ++p)
    o->w[o->f.unknown[p]] = -o->w[o->f.unknown[p]];
  for (int q = 0; q < m; ++q)
    if (!o->held[q])
      o->w[o->unknown[q]] = is_known(o, q) ? 0.0 : b[q] + o->w[o->unknown[q]];
  body_factor_plain_solve(&o->f, o->f.L, o->w, o->cm);
  for (long p = 0; p < o->f.n; ++p)
    o->v[o->f.unknown[p]] += o->w[o->f.unknown[p]];
  for (int q = 0; q < m; ++q)
    if (!o->held[q]) x[q] = o->v[o->unknown[q]];
  product(o->k, o->v, o->w, NULL);
  gather(o, x, Ax);
}

/* ---- loads and recovery ---------------------------------------------------
 */

void sparse_operator_forward(sparse_operator *o, const double *load,
                             double *f_c) {
  memcpy(o->y, load, all_unknowns(o->k) * sizeof *o->y);
  solve_interior(o, o->y);
  for (int i = 0; i < o->k->n_node; ++i)
    for (int c = 0; c < o->k->dim; ++c)
      if (!(o->k->free[i] >> c & 1)) o->y[o->k->dim * i + c] = 0.0;
  product(o->k, o->y, o->w, NULL);
  for (int q = 0; q < o->k->n_row; ++q)
    if (!o->held[q]) f_c[q] = load[o->unknown[q]] - o->w[o->unknown[q]];
}

void sparse_operator_back(sparse_operator *o, const double *u_c, double *u) {
  memset(o->v, 0, all_unknowns(o->k) * sizeof *o->v);
  for (int q = 0; q < o->k->n_row; ++q)
    if (!o->held[q]) o->v[o->unknown[q]] = u_c[q];
  product(o->k, o->v, o->w, NULL);
  solve_interior(o, o->w);
  for (long p = 0; p < o->f.n; ++p) {
    const long id = o->f.unknown[p];
    u[id] = o->y[id] + o->v[id] - o->w[id];
  }
}

void sparse_operator_interior(sparse_operator *o, const double *load,
                              double *u) {
  memcpy(o->w, load, all_unknowns(o->k) * sizeof *o->w);
  solve_interior(o, o->w);
  for (long p = 0; p < o->f.n; ++p) u[o->f.unknown[p]] += o->w[o->f.unknown[p]];
}

status sparse_operator_all_rows(sparse_operator *o) {
  if (o->state == OF_ALL) return OK;
  o->state = NO_FACTOR;
  o->f.known = NULL;
  o->f.added = NULL;
  o->f.pinned = o->pinned;
  PASS(body_factor_renew(o->k, o->number, o->cm, &o->f));
  o->state = OF_ALL;
  return OK;
}

/* ---- building --------------------------------------------------------------
 */

status stiffness_order(const stiffness *k, const double *x, whole_order *o) {
  status st = OK;
  graph g = {0};
  cholmod_common cm;
  const double dim = k->dim;
  *o = (whole_order){0};
  memory_count_suitesparse();
  cholmod_l_start(&cm);
  cm.print = 0;
  timer_enter(STAGE_ORDERING);
  TRY(graph_of_unknowns(k, &g));
  NEW(o->node, k->n_node);
  for (int i = 0; i < k->n_node; ++i)
    if (k->free[i] != 0) o->node[o->n++] = i;
  TRY(order_nodes(&g, k->dim, x, o->n, o->node, &cm, &o->name));
  TRY(order_flops(&g, o->n, o->node, &cm, &o->flops));
  o->flops *= dim * dim * dim;
  o->entries = cm.lnz * dim * dim;
done:
  timer_leave(STAGE_ORDERING);
  graph_release(&g);
  cholmod_l_finish(&cm);
  return st;
}

/* All nodes with unknowns, in the order given or a new one. */
static status order_whole(sparse_operator *o, const double *x,
                          const whole_order *given, const char **ordering) {
  whole_order own = {0};
  body_factor *f = &o->f;
  if (given == NULL) {
    status st = stiffness_order(o->k, x, &own);
    f->node = own.node;
    PASS(st);
    f->n_node = own.n;
    *ordering = own.name;
  } else {
    PASS_NEW(f->node, given->n);
    memcpy(f->node, given->node, (size_t)given->n * sizeof *f->node);
    f->n_node = given->n;
    *ordering = given->name;
  }
  f->n_own = f->n_inner = f->n_node;
  f->whole = 1;
  return OK;
}

/* The factor of the interior; f.L is without a factor afterwards if st. */
static status factor_interior(sparse_operator *o) {
  cholmod_factor *own = o->f.L;
  memset(o->all, 1, (size_t)o->k->n_row);
  o->f.known = o->all;
  o->f.added = NULL;
  o->f.pinned = NULL;
  o->f.L = o->inner;
  status st = body_factor_renew(o->k, o->number, o->cm, &o->f);
  o->inner = o->f.L;
  o->f.L = own;
  return st;
}

static status new_arrays(sparse_operator *o) {
  const size_t m = (size_t)o->k->n_row, n = all_unknowns(o->k);
  PASS_NEW(o->number, n);
  PASS_NEW(o->unknown, m);
  PASS_NEW(o->all, m);
  PASS_NEW(o->held, m);
  PASS_NEW(o->known, m);
  PASS_NEW(o->added, (size_t)o->k->rows * m);
  PASS_NEW(o->v, n);
  PASS_NEW(o->w, n);
  PASS_NEW(o->sizes, n);
  PASS_NEW(o->y, n);
  PASS_NEW(o->diagonal, m);
  PASS_NEW(o->room, 2 * m);
  PASS_NEW(o->body, m);
  return OK;
}

/* Held unknowns get the largest diagonal entry of their node, or of all. */
static void fill_diagonal(sparse_operator *o) {
  const stiffness *k = o->k;
  const size_t dim = (size_t)k->dim;
  double most = 0.0;
  for (int q = 0; q < k->n_row; ++q) {
    const size_t at = o->unknown[q];
    const double *block = k->block + dim * dim * k->start[at / dim];
    o->diagonal[q] = o->held[q] ? 0.0 : block[at % dim * (dim + 1)];
    most = fmax(most, o->diagonal[q]);
  }
  for (int q = 0; q < k->n_row; ++q) {
    double own = 0.0;
    if (!o->held[q]) continue;
    for (int t = q / k->rows * k->rows; t < (q / k->rows + 1) * k->rows; ++t)
      if (!o->held[t]) own = fmax(own, o->diagonal[t]);
    o->diagonal[q] = own > 0.0 ? own : most > 0.0 ? most : 1.0;
  }
}

static void number_rows(sparse_operator *o) {
  for (int i = 0; i < o->k->n_node; ++i)
    for (int c = 0; c < o->k->dim; ++c)
      if (contact_row(o->k, i, c) >= 0)
        o->unknown[contact_row(o->k, i, c)] = (size_t)(o->k->dim * i + c);
}

/* Unknowns numbered by their place in the factor: its matrix then needs no
 * permutation each time. */
static void renumber(sparse_operator *o) {
  SuiteSparse_long *perm = o->f.L->Perm;
  for (long p = 0; p < o->f.n; ++p) {
    o->number[o->f.unknown[p]] = p;
    perm[p] = p;
  }
  o->f.L->ordering = CHOLMOD_NATURAL;
}

static status factor_both(sparse_operator *o) {
  o->f.pinned = o->pinned;
  body_factor_number(o->k, &o->f, o->number);
  PASS(body_factor_analyse(o->k, o->number, o->cm, &o->f));
  renumber(o);
  o->inner = cholmod_l_copy_factor(o->f.L, o->cm);
  if (o->inner == NULL)
    RAISE(ERR_MEMORY, "memory exhausted: factor of %ld unknowns", o->f.n);
  PASS(sparse_operator_all_rows(o));
  return factor_interior(o);
}

status sparse_operator_new(const operator_data *d, const char **ordering,
                           sparse_operator **out) {
  status st = OK;
  const stiffness *k = d->k;
  sparse_operator *o = NULL;
  NEW(o, 1);
  *out = o;
  o->k = k;
  o->rigid = d->rigid;
  o->cm = d->cm;
  o->pinned = d->pinned;
  TRY(new_arrays(o));
  memcpy(o->held, d->held, (size_t)k->n_row);
  memcpy(o->body, d->body, (size_t)(k->n_row / k->rows) * sizeof *o->body);
  number_rows(o);
  fill_diagonal(o);
  TRY(order_whole(o, d->x, d->order, ordering));
  TRY(factor_both(o));
  o->seen = (contact_operator){.ctx = o,
                               .diagonal = o->diagonal,
                               .body = o->body,
                               .n_body = d->n_body,
                               .kernel = d->rigid->Q,
                               .n_kernel = d->rigid->k,
                               .room = o->room,
                               .apply = apply,
                               .apply_sizes = apply_sizes,
                               .set_rows = set_rows,
                               .solve = solve};
done:
  return st;
}

void sparse_operator_free(sparse_operator *o) {
  if (o == NULL) return;
  cholmod_l_free_factor(&o->inner, o->cm);
  body_factor_release(&o->f, o->cm);
  RELEASE(o->number, o->unknown, o->all, o->held, o->known, o->added, o->v,
          o->w, o->sizes, o->y, o->diagonal, o->room, o->body, o);
}
