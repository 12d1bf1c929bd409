/*
 * Contact problems in the layout of FCLIB: signs turned to those of contact.h
 * (exchange.h), everything checked.
 */
#include "base/base.h"
#include "exchange/parts.h"

#define LOCAL "/fclib_local"
#define GLOBAL "/fclib_global"

static const double SPARSE_SHARE = 0.5; /* -, of the blocks, and of entries */

/* ---- what both kinds have ------------------------------------------------ */

static double sign_of(int dim, int dof) { return dof % dim == 0 ? -1.0 : 1.0; }

static status new_arrays(exchange_problem *p) {
  PASS_NEW_ALL(OF(p->load, p->m), OF(p->gap, p->n),
               OF(p->ut0, (size_t)p->n * (p->dim - 1)), OF(p->g0, p->n),
               OF(p->B.start, p->n + 1), OF(p->B.col, p->n),
               OF(p->B.val, p->n));
  return OK;
}

/* Dimension and unknowns are known: sizes of the problem. */
static status set_size(const hdf5_source *s, const char *root, int m,
                       exchange_problem *p) {
  char name[64];
  snprintf(name, sizeof name, "%s/spacedim", root);
  PASS(source_int(s, name, &p->dim));
  if (p->dim != 2 && p->dim != 3)
    RAISE(ERR_DECK, "%s: %s = %d; expected 2 or 3", s->path, name, p->dim);
  if (m % p->dim != 0)
    RAISE(ERR_DECK, "%s: %s has %d unknowns, no multiple of spacedim = %d",
          s->path, root, m, p->dim);
  p->m = m;
  p->n = m / p->dim;
  return OK;
}

/* A matrix of all entries, zero. */
static status new_matrix(const hdf5_source *s, const char *root,
                         exchange_problem *p) {
  const size_t m = p->m;
  if (p->m > MOST_UNKNOWNS)
    RAISE(ERR_DECK, "%s: %s has %d unknowns; at most %d can be solved", s->path,
          root, p->m, (int)MOST_UNKNOWNS);
  PASS(require_problem_memory(p->m));
  PASS_NEW(p->matrix, m * m);
  return OK;
}

/* A vector of exactly n items. */
static status read_vector(const hdf5_source *s, const char *name, int n,
                          double **value) {
  long items = 0;
  PASS(source_reals(s, name, n == 0, n, &items, value));
  if (items != n)
    RAISE(ERR_DECK, "%s: %s has %ld items, expected %d", s->path, name, items,
          n);
  return OK;
}

static status read_friction(const hdf5_source *s, const char *name,
                            exchange_problem *p) {
  OWNED double *mu = NULL;
  int any = 0;
  PASS(read_vector(s, name, p->n, &mu));
  p->B.n = p->n;
  for (int i = 0; i < p->n; ++i) {
    if (mu[i] < 0.0)
      RAISE(ERR_DECK, "%s: %s, item %d = %g is negative", s->path, name, i,
            mu[i]);
    any = any || mu[i] > 0.0;
    p->B.start[i + 1] = i + 1;
    p->B.col[i] = i;
    p->B.val[i] = mu[i];
  }
  p->cp.g0 = any ? p->g0 : NULL;
  p->cp.B = any ? &p->B : NULL;
  p->cp.ut0 = any ? p->ut0 : NULL;
  return OK;
}

static status refuse_group(const hdf5_source *s, const char *name,
                           const char *what) {
  if (source_has(s, name))
    RAISE(ERR_DECK, "%s: %s: %s are not available in this version", s->path,
          name, what);
  return OK;
}

/* W, q of FCLIB into the signs of contact.h, in place. */
static void turn_signs(const exchange_problem *p) {
  const sparse_blocks *b = p->blocks;
  const int d = p->dim;
  for (int j = 0; j < p->m; ++j) p->load[j] *= sign_of(d, j);
  for (int j = 0; p->matrix != NULL && j < p->m; ++j)
    for (int i = 0; i < p->m; ++i)
      p->matrix[i + (size_t)p->m * j] *= sign_of(d, i) * sign_of(d, j);
  for (int k = 0; b != NULL && k < b->start[p->n]; ++k)
    for (int e = 0; e < d * d; ++e)
      b->val[(size_t)k * (d * d) + e] *= sign_of(d, e % d) * sign_of(d, e / d);
}

/* 1: so few of "all" that sparse products are faster. */
static int are_few(double count, double all) {
  return count <= SPARSE_SHARE * all * all;
}

/* W into p->blocks, or NULL: too many are not zero. */
static status take_blocks(exchange_problem *p, const triplets *W) {
  if (p->n == 0 || !are_few((double)W->n, p->m)) return OK;
  PASS(sparse_blocks_new(p->dim, p->n, W->n, W->row, W->column, W->value,
                         &p->blocks));
  if (are_few(p->blocks->start[p->n], p->n)) return OK;
  FORGET(p->blocks);
  return OK;
}

/* W in blocks, where most of it is zero, in the place of the matrix. */
static status thin_out(exchange_problem *p) {
  const size_t m = p->m;
  long n = 0;
  for (size_t k = 0; k < m * m; ++k) n += p->matrix[k] != 0.0;
  OWNED int *row = NULL, *column = NULL;
  OWNED double *value = NULL;
  if (!are_few((double)n, p->m)) return OK;
  PASS_NEW_ALL(OF(row, n), OF(column, n), OF(value, n));
  triplets W = {p->m, p->m, 0, row, column, value};
  for (size_t k = 0; k < m * m; ++k) {
    if (p->matrix[k] == 0.0) continue;
    row[W.n] = (int)(k % m);
    column[W.n] = (int)(k / m);
    value[W.n++] = p->matrix[k];
  }
  PASS(take_blocks(p, &W));
  if (p->blocks == NULL) return OK;
  FORGET(p->matrix);
  return OK;
}

static void set_problem(exchange_problem *p, int stiffness, int floating) {
  p->cp.dim = p->dim;
  p->cp.n = p->n;
  p->cp.m = p->m;
  p->cp.A = stiffness ? p->matrix : NULL;
  p->cp.W = stiffness ? NULL : p->matrix;
  p->cp.blocks = p->blocks;
  p->cp.f = p->load;
  p->cp.gap = p->gap;
  p->cp.floating = floating;
}

/* ---- local --------------------------------------------------------------- */

/* A matrix of given size, dense. */
static status read_dense(const hdf5_source *s, const char *name, int rows,
                         int columns, double **a) {
  OWNED_PARTS(triplets, t, triplets_read(s, name, &t));
  if (t.rows != rows || t.columns != columns)
    RAISE(ERR_DECK, "%s: %s is %d x %d, expected %d x %d", s->path, name,
          t.rows, t.columns, rows, columns);
  PASS_NEW(*a, (size_t)rows * columns);
  triplets_dense(&t, *a);
  return OK;
}

/* V, R and s, both matrices or none. */
static status read_constraints(const hdf5_source *s, int m, constraints *c) {
  int has_V = source_has(s, LOCAL "/V"), has_R = source_has(s, LOCAL "/R");
  if (!has_V && !has_R) return OK;
  if (!has_V || !has_R)
    RAISE(ERR_DECK,
          "%s: equality constraints need both " LOCAL "/V and " LOCAL
          "/R; one is missing",
          s->path);
  PASS(source_int(s, LOCAL "/R/m", &c->p));
  if (c->p < 0 || c->p > MOST_UNKNOWNS)
    RAISE(ERR_DECK, "%s: " LOCAL "/R has %d rows; at most %d can be eliminated",
          s->path, c->p, (int)MOST_UNKNOWNS);
  PASS(read_dense(s, LOCAL "/V", m, c->p, &c->V));
  PASS(read_dense(s, LOCAL "/R", c->p, c->p, &c->R));
  return read_vector(s, LOCAL "/vectors/s", c->p, &c->s);
}

static status read_local(const hdf5_source *s, exchange_problem *p) {
  triplets size = {0};
  p->form = "FCLIB, local";
  PASS(triplets_size(s, LOCAL "/W", &size));
  if (size.rows != size.columns)
    RAISE(ERR_DECK, "%s: " LOCAL "/W is not square: %d x %d", s->path,
          size.rows, size.columns);
  PASS(set_size(s, LOCAL, size.rows, p));
  OWNED_PARTS(triplets, W, triplets_read(s, LOCAL "/W", &W));
  if (triplets_triangle(&W) != 0)
    RAISE(ERR_DECK,
          "%s: only one triangle of " LOCAL "/W is there; expected all of it",
          s->path);
  PASS(new_arrays(p));
  OWNED_OF(double, q, read_vector(s, LOCAL "/vectors/q", p->m, &q));
  PASS(read_friction(s, LOCAL "/vectors/mu", p));
  COPY(p->load, q, p->m);
  OWNED_PARTS(constraints, c, read_constraints(s, p->m, &c));
  if (c.p == 0) PASS(take_blocks(p, &W));
  if (p->blocks == NULL) {
    PASS(new_matrix(s, LOCAL, p));
    triplets_dense(&W, p->matrix);
    PASS(constraints_eliminate(s->path, p->m, &c, p->matrix, p->load));
  }
  turn_signs(p);
  p->unknowns = p->m + c.p;
  set_problem(p, 0, 0);
  return OK;
}

/* ---- global -------------------------------------------------------------- */

typedef struct global {
  triplets M, H, G;  /* G: equality constraints, or none */
  double *f, *w, *b; /* [M.rows], [H.columns], [G.columns] */
  double *h;         /* diagonal of H, or NULL */
} global;

static status read_matrices(const hdf5_source *s, global *g) {
  PASS(triplets_read(s, GLOBAL "/M", &g->M));
  PASS(triplets_read(s, GLOBAL "/H", &g->H));
  if (source_has(s, GLOBAL "/G")) PASS(triplets_read(s, GLOBAL "/G", &g->G));
  if (g->G.columns > 0 && g->G.rows != g->M.rows)
    RAISE(ERR_DECK, "%s: " GLOBAL "/G has %d rows, M has %d", s->path,
          g->G.rows, g->M.rows);
  if (g->M.rows != g->M.columns)
    RAISE(ERR_DECK, "%s: " GLOBAL "/M is not square: %d x %d", s->path,
          g->M.rows, g->M.columns);
  if (g->H.rows != g->M.rows)
    RAISE(ERR_DECK, "%s: " GLOBAL "/H has %d rows, M has %d", s->path,
          g->H.rows, g->M.rows);
  return OK;
}

/* H square and diagonal without a zero: g->h gets it. */
static status find_diagonal(global *g) {
  if (g->H.rows != g->H.columns) return OK;
  PASS_NEW(g->h, g->H.rows);
  int diagonal = 1;
  for (long k = 0; k < g->H.n; ++k)
    if (g->H.row[k] == g->H.column[k])
      g->h[g->H.row[k]] += g->H.value[k];
    else
      diagonal = diagonal && g->H.value[k] == 0.0;
  for (int i = 0; i < g->H.rows; ++i) diagonal = diagonal && g->h[i] != 0.0;
  if (diagonal) return OK;
  FORGET(g->h);
  return OK;
}

/* 1: M is symmetric to the accuracy that a stiffness needs. Dense a[m*m]. */
static int is_symmetric(int m, const double *a) {
  double largest = 0.0, skew = 0.0;
  for (size_t j = 0; j < (size_t)m; ++j)
    for (size_t i = 0; i <= j; ++i) {
      double one = a[i + m * j], other = a[j + m * i];
      largest = fmax(largest, fabs(one));
      skew = fmax(skew, fabs(one - other));
    }
  return skew <= 1e-10 * largest;
}

/* The unknowns are H'v, counted from -w: gap and position of stick. */
static void set_origin(exchange_problem *p, const double *w) {
  for (int j = 0; j < p->m; ++j)
    if (j % p->dim == 0)
      p->gap[j / p->dim] = w[j];
    else
      p->ut0[j / p->dim * (p->dim - 1) + j % p->dim - 1] = -w[j];
}

/* With H = diag(h) the unknowns are v themselves: A = inv(H) M inv(H), which
 * may be singular. *done = 0: not possible. */
static void take_stiffness(exchange_problem *p, const global *g, int floating,
                           int *done) {
  size_t m = p->m;
  double *a = p->matrix;
  CLEAR(a, m * m);
  triplets_dense(&g->M, a);
  const int one = triplets_triangle(&g->M) != 0;
  for (size_t j = 0; j < m && one; ++j)
    for (size_t i = 0; i < j; ++i)
      a[i + m * j] = a[j + m * i] = a[i + m * j] + a[j + m * i];
  *done = is_symmetric(p->m, a);
  if (!*done) return;
  for (size_t j = 0; j < m; ++j) {
    p->load[j] = g->f[j] / g->h[j];
    for (size_t i = 0; i < m; ++i) a[i + m * j] /= g->h[i] * g->h[j];
  }
  turn_signs(p);
  set_origin(p, g->w);
  set_problem(p, 1, floating);
}

/* (H, G) as one matrix. */
static status join(const global *g, triplets *all) {
  all->rows = g->H.rows;
  all->columns = g->H.columns + g->G.columns;
  all->n = g->H.n + g->G.n;
  PASS_NEW_ALL(OF(all->row, all->n), OF(all->column, all->n),
               OF(all->value, all->n));
  for (long k = 0; k < all->n; ++k) {
    const triplets *from = k < g->H.n ? &g->H : &g->G;
    long at = k < g->H.n ? k : k - g->H.n;
    all->row[k] = from->row[at];
    all->column[k] = from->column[at] + (k < g->H.n ? 0 : g->H.columns);
    all->value[k] = from->value[at];
  }
  return OK;
}

/* The condensed matrix of (H, G) [size*size] and its vector, in their parts. */
static status part(const double *all, const double *vector, int size, int m,
                   exchange_problem *p, constraints *c) {
  size_t ld = size, rows = m, n = size - m;
  c->p = size - m;
  PASS_NEW_ALL(OF(c->V, rows * n), OF(c->R, n * n), OF(c->s, n));
  for (size_t j = 0; j < rows; ++j) {
    p->load[j] = vector[j];
    COPY(p->matrix + rows * j, all + ld * j, rows);
  }
  for (size_t k = 0; k < n; ++k) {
    const double *column = all + ld * (rows + k);
    COPY(c->V + rows * k, column, rows);
    COPY(c->R + n * k, column + rows, n);
    c->s[k] = vector[rows + k];
  }
  return OK;
}

/* With s G (G'v + b) = 0 added, which makes M definite where the constraints
 * hold the bodies; l takes up s G b. */
static status reduce_held(const hdf5_source *s, const global *g,
                          const triplets *joined, double *all, double *vector) {
  int usable = 0;
  double stiff = 0.0;
  PASS(reduce_global(&g->M, joined, g->f, all, vector, &usable));
  if (usable) return OK;
  OWNED_PARTS(triplets, held, springs_add(&g->M, &g->G, &stiff, &held));
  PASS(reduce_global(&held, joined, g->f, all, vector, &usable));
  if (!usable) PASS(reduce_any(s->path, &g->M, joined, g->f, all, vector));
  return OK;
}

/* M v = H r + G l + f, G'v + b = 0: v is eliminated with (H, G) in the place of
 * H, which leaves constraints on r and l. */
static status condense_constrained(const hdf5_source *s, const global *g,
                                   exchange_problem *p) {
  OWNED double *all = NULL, *vector = NULL;
  int size = p->m + g->G.columns;
  if (size > MOST_UNKNOWNS)
    RAISE(ERR_DECK,
          "%s: " GLOBAL
          " has %d unknowns and constraints; at most %d "
          "can be solved",
          s->path, size, (int)MOST_UNKNOWNS);
  OWNED_PARTS(triplets, joined, join(g, &joined));
  PASS_NEW_ALL(OF(all, (size_t)size * size), OF(vector, size));
  COPY(vector, g->w, p->m);
  COPY(vector + p->m, g->b, g->G.columns);
  PASS(reduce_held(s, g, &joined, all, vector));
  OWNED_PARTS(constraints, c, part(all, vector, size, p->m, p, &c));
  PASS(constraints_eliminate(s->path, p->m, &c, p->matrix, p->load));
  turn_signs(p);
  set_problem(p, 0, 0);
  return OK;
}

/* W in blocks and q without a matrix of all entries; p->blocks NULL: not
 * possible, or most of it is not zero. */
static status condense_bodies(const global *g, exchange_problem *p) {
  int usable = 0;
  COPY(p->load, g->w, p->m);
  OWNED_PARTS(
      triplets, W,
      reduce_bodies(&g->M, &g->H, g->f, SPARSE_SHARE, &W, p->load, &usable));
  if (usable) PASS(take_blocks(p, &W));
  return OK;
}

/* W and q, or, of a symmetric and singular M, A and f of the same size. */
static status condense_global(const hdf5_source *s, global *g,
                              exchange_problem *p) {
  int definite = 0, taken = 0;
  size_t size = (size_t)p->m * p->m;
  COPY(p->load, g->w, p->m);
  PASS(reduce_global(&g->M, &g->H, g->f, p->matrix, p->load, &definite));
  if (g->h != NULL) take_stiffness(p, g, !definite, &taken);
  if (taken) return OK;
  if (!definite)
    PASS(springs_condense(&g->M, &g->H, g->f, p->matrix, p->load, &taken));
  if (!definite && !taken) {
    CLEAR(p->matrix, size);
    COPY(p->load, g->w, p->m);
    PASS(reduce_any(s->path, &g->M, &g->H, g->f, p->matrix, p->load));
  }
  if (!taken) PASS(thin_out(p));
  turn_signs(p);
  if (taken) set_origin(p, g->w);
  set_problem(p, taken, taken);
  return OK;
}

/* All but the friction; of H alone the size is known before. */
static status read_parts(const hdf5_source *s, exchange_problem *p, global *g) {
  PASS(triplets_size(s, GLOBAL "/H", &g->H));
  PASS(set_size(s, GLOBAL, g->H.columns, p));
  PASS(read_matrices(s, g));
  PASS(read_vector(s, GLOBAL "/vectors/f", g->M.rows, &g->f));
  PASS(read_vector(s, GLOBAL "/vectors/w", p->m, &g->w));
  if (g->G.columns > 0)
    PASS(read_vector(s, GLOBAL "/vectors/b", g->G.columns, &g->b));
  return find_diagonal(g);
}

static status read_global(const hdf5_source *s, exchange_problem *p) {
  p->form = "FCLIB, global";
  OWNED_PARTS(global, g, read_parts(s, p, &g));
  PASS(new_arrays(p));
  PASS(read_friction(s, GLOBAL "/vectors/mu", p));
  p->unknowns = g.M.rows + g.G.columns;
  if (g.h == NULL && g.G.columns == 0) PASS(condense_bodies(&g, p));
  if (p->blocks != NULL) {
    turn_signs(p);
    set_problem(p, 0, 0);
    return OK;
  }
  PASS(new_matrix(s, GLOBAL, p));
  if (g.G.columns > 0) return condense_constrained(s, &g, p);
  return condense_global(s, &g, p);
}

/* ---- file ---------------------------------------------------------------- */

static status read_source(const hdf5_source *s, exchange_problem *p) {
  const char *rolling = "rolling friction and its moments";
  PASS(refuse_group(s, "/fclib_global_rolling", rolling));
  PASS(refuse_group(s, "/fclib_local_rolling", rolling));
  if (source_has(s, LOCAL))
    PASS(read_local(s, p));
  else if (source_has(s, GLOBAL))
    PASS(read_global(s, p));
  else
    RAISE(ERR_DECK, "%s has neither a group " LOCAL " nor " GLOBAL, s->path);
  return OK;
}

status fclib_read(const char *path, exchange_problem *p) {
  ENDS_BY(dataset_close) hdf5_source s = {0};
  PASS(dataset_open(path, &s));
  return read_source(&s, p);
}
