/*
 * The factor of one body:
 *
 *   P K P' = L L',  contact unknowns at the end of P.
 *
 * The rows and columns of L at the contact unknowns form L_cc with
 * L_cc L_cc' = K_cc - K_ci inv(K_ii) K_ic. They are found by position, since
 * the postorder may move columns between them.
 */
#include "fem/factor.h"

#include "base/base.h"
#include "fem/supernodal/supernodal.h"

#include <lapacke.h>

enum { MOST_COLUMNS = 1024 }; /* of a supernode: with less the BLAS is slower */

/* Number the unknowns; contact nodes are met in descending order and their
 * components too, so that L_cc stands reversed in A (see condense). */
void body_factor_number(const stiffness *k, body_factor *f, long *number) {
  long n = 0;
  f->nc = 0;
  for (int q = 0; q < f->n_node; ++q) {
    const int i = f->node[q], last = q >= f->n_inner;
    for (int t = 0; t < k->dim; ++t) {
      const int c = last ? k->dim - 1 - t : t;
      long *at = &number[(size_t)k->dim * i + c];
      if (!f->whole && (contact_row(k, i, c) >= 0) != last) continue;
      *at = k->free[i] >> c & 1 ? n++ : -1;
      if (last && *at >= 0) ++f->nc;
    }
  }
  f->n = n;
}

static double diagonal(const stiffness *k, int node, int c) {
  const size_t size = k->dim * k->dim;
  return k->block[size * k->start[node] + c * (k->dim + 1)];
}

/* Largest diagonal entry of the body; NaN if one is not a number. */
static double largest_diagonal(const stiffness *k, const body_factor *f) {
  double most = 0;
  for (int q = 0; q < f->n_node; ++q) {
    const int i = f->node[q];
    for (int c = 0; c < k->dim; ++c) {
      const double v = diagonal(k, i, c);
      if (!(k->free[i] >> c & 1)) continue;
      if (!(v <= most)) most = v;
    }
  }
  return most;
}

double body_factor_spring(const stiffness *k, const body_factor *f,
                          long unknown) {
  const int node = (int)(unknown / k->dim), c = (int)(unknown % k->dim);
  const int row = contact_row(k, node, c);
  if (f->pinned == NULL || row < 0 || !f->pinned[row]) return 0;
  return ldexp(diagonal(k, node, c), -f->exponent);
}

typedef struct columns { /* lower triangle under construction */
  const stiffness *k;
  const body_factor *f;
  const long *number;
  double scale;
  SuiteSparse_long *start, *row;
  double *value;
} columns;

/* Entries of block p = (i, j) of the lower node graph: counted in start (row
 * NULL) or stored at start[column]++. */
static void put_block(columns *w, size_t p, int i, int j) {
  const int dim = w->k->dim;
  const double *b = w->k->block + dim * dim * p;
  const long *ni = w->number + (size_t)dim * i;
  const long *nj = w->number + (size_t)dim * j;
  for (int c = 0; c < dim; ++c) {
    if (nj[c] < 0) continue;
    for (int r = i == j ? c : 0; r < dim; ++r) {
      if (ni[r] < 0) continue;
      const long col = ni[r] < nj[c] ? ni[r] : nj[c];
      if (w->row == NULL) {
        ++w->start[col];
        continue;
      }
      const SuiteSparse_long at = w->start[col]++;
      w->row[at] = ni[r] < nj[c] ? nj[c] : ni[r];
      w->value[at] = w->scale * b[dim * c + r];
      if (i == j && r == c)
        w->value[at] += body_factor_spring(w->k, w->f, (long)dim * i + c);
    }
  }
}

static void put_blocks(columns *w) {
  for (int q = 0; q < w->f->n_own; ++q) {
    const int j = w->f->node[q];
    for (size_t p = w->k->start[j]; p < w->k->start[j + 1]; ++p)
      if (w->k->free[w->k->row[p]] != 0) put_block(w, p, w->k->row[p], j);
  }
}

/* Scaled lower triangle in elimination order, with f->pinned; *out is new. */
static status body_factor_matrix(const stiffness *k, const body_factor *f,
                                 const long *number, cholmod_common *cm,
                                 cholmod_sparse **out) {
  columns w = {
      .k = k, .f = f, .number = number, .scale = ldexp(1, -f->exponent)};
  long total = 0;
  OWNED_NEW(SuiteSparse_long, count, f->n + 1);
  w.start = count;
  put_blocks(&w);
  for (long c = 0; c < f->n; ++c) total += count[c];
  cholmod_sparse *a = *out =
      cholmod_l_allocate_sparse(f->n, f->n, total, 0, 1, -1, CHOLMOD_REAL, cm);
  if (a == NULL) RAISE(ERR_MEMORY, "memory exhausted: %ld unknowns", f->n);
  SuiteSparse_long *start = a->p;
  for (long c = 0; c < f->n; ++c) {
    start[c + 1] = start[c] + count[c];
    count[c] = start[c];
  }
  w.row = a->i;
  w.value = a->x;
  put_blocks(&w);
  return OK;
}

static status analyse(cholmod_sparse *a, cholmod_common *cm, body_factor *f) {
  cm->nmethods = 1;
  cm->method[0].ordering = CHOLMOD_NATURAL;
  cm->postorder = 1;
  cm->supernodal = CHOLMOD_SUPERNODAL;
  f->L = cholmod_l_analyze(a, cm);
  if (f->L == NULL || !supernodal_split(f->L, MOST_COLUMNS, cm))
    RAISE(ERR_MEMORY, "memory exhausted: symbolic factor of %ld unknowns",
          f->n);
  f->flops = cm->fl;
  return OK;
}

/* The node of an unknown by its number, for a message. */
static int node_of(const stiffness *k, const body_factor *f, const long *number,
                   long column) {
  for (int q = 0; q < f->n_node; ++q)
    for (int c = 0; c < k->dim; ++c)
      if (number[k->dim * f->node[q] + c] == column) return f->node[q];
  return f->node[0];
}

status body_factor_broke(body_factor *f, int node) {
  f->bad_node = node;
  RAISE(ERR_SINGULAR,
        "stiffness not positive definite to rounding; contrasts of "
        "stiffness, slivers, nu near 1/2 and weak supports lose digits");
}

static status factorise(const stiffness *k, const long *number,
                        cholmod_sparse *a, cholmod_common *cm, body_factor *f) {
  TIMED(STAGE_FACTOR);
  const int done_ok = cholmod_l_factorize(a, f->L, cm);
  if (!done_ok || cm->status < 0)
    RAISE(ERR_MEMORY, "memory exhausted: factor of %ld unknowns (%.3g bytes)",
          f->n, cm->lnz * sizeof(double));
  if (f->L->minor < (size_t)f->n) {
    const SuiteSparse_long *perm = f->L->Perm;
    return body_factor_broke(f, node_of(k, f, number, perm[f->L->minor]));
  }
  return OK;
}

/* Positions of the unknowns and of the contact ones in the factor. */
static status locate(const stiffness *k, const long *number, body_factor *f) {
  const SuiteSparse_long *perm = f->L->Perm;
  OWNED long *position = NULL;
  long q = 0;
  PASS_NEW_ALL(OF(position, f->n), OF(f->unknown, f->n),
               OF(f->contact_at, f->nc), OF(f->contact_id, f->nc));
  for (long p = 0; p < f->n; ++p) position[perm[p]] = p;
  for (int t = 0; t < f->n_node; ++t)
    for (int c = 0; c < k->dim; ++c) {
      const long id = (long)k->dim * f->node[t] + c;
      if (number[id] >= 0) f->unknown[position[number[id]]] = id;
    }
  for (long p = 0; p < f->n; ++p) {
    if (perm[p] < f->n - f->nc) continue;
    f->contact_at[q] = p;
    f->contact_id[q++] = contact_row(k, (int)(f->unknown[p] / k->dim),
                                     (int)(f->unknown[p] % k->dim));
  }
  if (f->nc > 0) {
    const long first = f->contact_at[0];
    PASS_NEW(f->rank, f->n - first);
    for (long p = first; p < f->n; ++p) f->rank[p - first] = -1;
    for (q = 0; q < f->nc; ++q) f->rank[f->contact_at[q] - first] = (int)q;
  }
  return OK;
}

/* The matrix, its symbolic factor and the places of the unknowns in that. */
static status begin(const stiffness *k, const long *number, cholmod_common *cm,
                    body_factor *f, cholmod_sparse **a) {
  const double most = largest_diagonal(k, f);
  if (!(most > 0 && isfinite(most)))
    RAISE(ERR_SINGULAR, "stiffness is zero or not a number");
  frexp(most, &f->exponent);
  PASS(body_factor_matrix(k, f, number, cm, a));
  PASS(analyse(*a, cm, f));
  PASS(locate(k, number, f));
  f->y = cholmod_l_zeros(f->n, 1, CHOLMOD_REAL, cm);
  f->work = cholmod_l_zeros(f->L->maxesize + 1, 1, CHOLMOD_REAL, cm);
  if (f->y == NULL || f->work == NULL)
    RAISE(ERR_MEMORY, "memory exhausted: solution of %ld unknowns", f->n);
  return OK;
}

status body_factor_analyse(const stiffness *k, const long *number,
                           cholmod_common *cm, body_factor *f) {
  cholmod_sparse *a = NULL;
  TIMED(STAGE_ORDERING);
  status st = begin(k, number, cm, f, &a);
  cholmod_l_free_sparse(&a, cm);
  return st;
}

status body_factor_build(const stiffness *k, const long *number,
                         cholmod_common *cm, body_factor *f) {
  cholmod_sparse *a = NULL;
  TIMED(STAGE_ORDERING);
  status st = begin(k, number, cm, f, &a);
  if (st == OK) st = factorise(k, number, a, cm, f);
  cholmod_l_free_sparse(&a, cm);
  return st;
}

void body_factor_release(body_factor *f, cholmod_common *cm) {
  cholmod_l_free_factor(&f->L, cm);
  cholmod_l_free_dense(&f->y, cm);
  cholmod_l_free_dense(&f->work, cm);
  RELEASE(f->node, f->unknown, f->contact_at, f->contact_id, f->rank);
  *f = (body_factor){0};
}

/* Column of L from its diagonal entry down. */
typedef struct factor_column {
  long n;
  const SuiteSparse_long *row; /* [n] positions */
  const double *value;         /* [n] */
} factor_column;

/* Column at position p; *super: search starts there and ends there. */
static factor_column column_at(const cholmod_factor *L, long p, long *super) {
  const SuiteSparse_long *first = L->super, *pi = L->pi, *px = L->px;
  while (first[*super + 1] <= p) ++*super;
  const long s = *super, n_row = pi[s + 1] - pi[s], skip = p - first[s];
  return (factor_column){n_row - skip,
                         (const SuiteSparse_long *)L->s + pi[s] + skip,
                         (const double *)L->x + px[s] + skip * n_row + skip};
}

/* out = L_cc in, or L_cc' in; vectors [nc] by rank. */
static void multiply_cc(const body_factor *f, int transposed, const double *in,
                        double *out) {
  long super = 0;
  CLEAR(out, f->nc);
  for (long q = 0; q < f->nc; ++q) {
    const factor_column c = column_at(f->L, f->contact_at[q], &super);
    double sum = 0;
    for (long t = 0; t < c.n; ++t) {
      const int r = f->rank[c.row[t] - f->contact_at[0]];
      if (r < 0) continue;
      if (transposed)
        sum += c.value[t] * in[r];
      else
        out[r] += c.value[t] * in[q];
    }
    if (transposed) out[q] = sum;
  }
}

/* U = L_cc in reversed order, so that U U' is the condensed matrix in the
 * same order: the upper triangle LAPACK's lauum multiplies in place. */
static void extract_reversed(const body_factor *f, double *U) {
  const size_t nc = f->nc;
  long super = 0;
  for (size_t q = 0; q < nc; ++q) {
    const factor_column c = column_at(f->L, f->contact_at[q], &super);
    double *to = U + nc * (nc - 1 - q);
    for (long t = 0; t < c.n; ++t) {
      const int r = f->rank[c.row[t] - f->contact_at[0]];
      if (r >= 0) to[nc - 1 - r] = c.value[t];
    }
  }
}

/* Are the reversed ranks the rows of A themselves? */
static int covers(const body_factor *f, int m) {
  if (f->nc != m) return 0;
  for (long q = 0; q < f->nc; ++q)
    if (f->contact_id[q] != m - 1 - (int)q) return 0;
  return 1;
}

void symmetric_fill(size_t n, double *A) {
  enum { TILE = 32 };
  for (size_t jb = 0; jb < n; jb += TILE)
    for (size_t ib = 0; ib <= jb; ib += TILE)
      for (size_t j = jb; j < n && j < jb + TILE; ++j)
        for (size_t i = ib; i < j && i < ib + TILE; ++i)
          A[j + n * i] = A[i + n * j];
}

status body_factor_condense(const stiffness *k, const body_factor *f, int m,
                            double *A) {
  const size_t nc = f->nc, stride = m;
  const int in_place = covers(f, m);
  const double scale = ldexp(1, f->exponent);
  OWNED double *U = NULL;
  double *S = A;
  if (nc == 0) return OK;
  if (!in_place) {
    PASS_NEW(U, nc * nc);
    S = U;
  }
  extract_reversed(f, S);
  if (LAPACKE_dlauum_work(LAPACK_COL_MAJOR, 'U', (lapack_int)nc, S,
                          (lapack_int)nc) != 0)
    RAISE(ERR_INTERNAL, "condensed matrix of order %zu not formed", nc);
  for (size_t j = 0; j < nc; ++j) {
    const long at = f->contact_at[nc - 1 - j];
    S[j * (nc + 1)] -= body_factor_spring(k, f, f->unknown[at]);
    for (size_t i = 0; i <= j; ++i) S[i + nc * j] *= scale;
  }
  symmetric_fill(nc, S);
  for (size_t j = 0; !in_place && j < nc; ++j) {
    double *to = A + stride * f->contact_id[nc - 1 - j];
    for (size_t i = 0; i < nc; ++i)
      to[f->contact_id[nc - 1 - i]] = S[i + nc * j];
  }
  return OK;
}

/* x becomes inv(L) x or, transposed, inv(L') x; by position. */
static status solve_lower(const body_factor *f, int transposed, double *x,
                          cholmod_common *cm) {
  const size_t n = f->n;
  cholmod_dense z = {n, 1, n, n, x, NULL, CHOLMOD_REAL, CHOLMOD_DOUBLE};
  if (!(transposed ? cholmod_l_super_ltsolve(f->L, &z, f->work, cm)
                   : cholmod_l_super_lsolve(f->L, &z, f->work, cm)))
    RAISE(ERR_INTERNAL, "%s solve of %ld unknowns failed",
          transposed ? "back" : "forward", f->n);
  return OK;
}

status body_factor_forward(body_factor *f, const double *load, double *f_c,
                           cholmod_common *cm) {
  OWNED double *in = NULL, *out = NULL;
  double *y = f->y->x;
  const double scale = ldexp(1, -f->exponent), back = ldexp(1, f->exponent);
  PASS_NEW_ALL(OF(in, f->nc), OF(out, f->nc));
  int any = 0;
  for (long p = 0; p < f->n; ++p) {
    y[p] = scale * load[f->unknown[p]];
    any |= y[p] != 0.0;
  }
  if (any) PASS(solve_lower(f, 0, y, cm));
  for (long q = 0; q < f->nc; ++q) in[q] = y[f->contact_at[q]];
  multiply_cc(f, 0, in, out);
  for (long q = 0; q < f->nc; ++q) f_c[f->contact_id[q]] = back * out[q];
  return OK;
}

double body_factor_least_pivot(const stiffness *k, const body_factor *f) {
  double least = 1;
  long super = 0;
  for (long p = 0; p < f->n; ++p) {
    const double pivot = column_at(f->L, p, &super).value[0];
    const int node = (int)(f->unknown[p] / k->dim);
    const double own =
        ldexp(diagonal(k, node, (int)(f->unknown[p] % k->dim)), -f->exponent);
    least = fmin(least, pivot * (pivot / own));
  }
  return least;
}

status body_factor_back(const body_factor *f, const double *u_c, double *u,
                        cholmod_common *cm) {
  OWNED double *in = NULL, *out = NULL, *x = NULL;
  PASS_NEW_ALL(OF(in, f->nc), OF(out, f->nc), OF(x, f->n));
  COPY(x, f->y->x, f->n);
  for (long q = 0; q < f->nc; ++q) in[q] = u_c[f->contact_id[q]];
  multiply_cc(f, 1, in, out);
  for (long q = 0; q < f->nc; ++q) x[f->contact_at[q]] = out[q];
  PASS(solve_lower(f, 1, x, cm));
  for (long p = 0; p < f->n; ++p) u[f->unknown[p]] = x[p];
  for (long q = 0; q < f->nc; ++q) u[f->unknown[f->contact_at[q]]] = in[q];
  return OK;
}

status body_factor_interior(const body_factor *f, const double *load, double *u,
                            cholmod_common *cm) {
  const double scale = ldexp(1, -f->exponent);
  OWNED_NEW(double, x, f->n);
  for (long p = 0; p < f->n; ++p) x[p] = scale * load[f->unknown[p]];
  for (long q = 0; q < f->nc; ++q) x[f->contact_at[q]] = 0;
  PASS(solve_lower(f, 0, x, cm));
  for (long q = 0; q < f->nc; ++q) x[f->contact_at[q]] = 0;
  PASS(solve_lower(f, 1, x, cm));
  for (long q = 0; q < f->nc; ++q) x[f->contact_at[q]] = 0;
  for (long p = 0; p < f->n; ++p) u[f->unknown[p]] += x[p];
  return OK;
}

status body_factor_energy(const body_factor *f, const double *d,
                          double *square) {
  double sum = 0;
  long super = 0;
  OWNED_NEW(double, x, f->nc);
  for (long q = 0; q < f->nc; ++q) x[q] = d[f->contact_id[q]];
  for (long q = 0; q < f->nc; ++q) {
    const factor_column c = column_at(f->L, f->contact_at[q], &super);
    x[q] /= c.value[0];
    for (long t = 1; t < c.n; ++t) {
      const int r = f->rank[c.row[t] - f->contact_at[0]];
      if (r >= 0) x[r] -= c.value[t] * x[q];
    }
    sum += x[q] * x[q];
  }
  *square += ldexp(sum, -f->exponent);
  return OK;
}

status body_factor_solve(const body_factor *f, const double *d, double *w,
                         double *square, cholmod_common *cm) {
  const double scale = ldexp(1, -f->exponent);
  double sum = 0;
  OWNED_NEW(double, x, f->n);
  for (long p = 0; p < f->n; ++p) x[p] = scale * d[f->unknown[p]];
  PASS(solve_lower(f, 0, x, cm));
  PASS(solve_lower(f, 1, x, cm));
  for (long p = 0; p < f->n; ++p) {
    w[f->unknown[p]] = x[p];
    sum += d[f->unknown[p]] * x[p];
  }
  *square += fmax(0, sum);
  return OK;
}

/*
 * Condition number of a factored body, its unknowns scaled to a unit diagonal:
 * that of inv(D) K inv(D), D^2 the diagonal. The rounding of a Cholesky factor
 * does not depend on such a scaling, so that contrasts of stiffness count only
 * where digits are lost. Two steps of inverse iteration and the largest row
 * sum: an estimate, a few times too large or too small.
 */

/* D of the scaled matrix at the unknowns: root[dim*n_node], 1 elsewhere. */
static void fill_roots(const stiffness *k, const body_factor *f, double *root) {
  const int dim = k->dim;
  const double scale = ldexp(1, -f->exponent);
  for (int q = 0; q < f->n_node; ++q) {
    const int i = f->node[q];
    const double *b = k->block + dim * dim * k->start[i];
    for (int c = 0; c < dim; ++c) {
      const double spring = body_factor_spring(k, f, (long)dim * i + c);
      root[(size_t)dim * i + c] =
          k->free[i] >> c & 1 ? sqrt(scale * b[c * (dim + 1)] + spring) : 1;
    }
  }
}

/* Add the magnitudes of the scaled block p = (i, j) to the sums of its rows and
 * columns. */
static void add_magnitudes(const stiffness *k, size_t p, int j,
                           const double *root, double *sum) {
  const int dim = k->dim, i = k->row[p];
  const double *b = k->block + dim * dim * p;
  for (int c = 0; c < dim; ++c)
    for (int r = 0; r < dim; ++r) {
      const size_t row = (size_t)dim * i + r;
      const size_t col = (size_t)dim * j + c;
      if (!(k->free[i] >> r & 1) || !(k->free[j] >> c & 1)) continue;
      if (row == col) continue;
      const double v = fabs(b[dim * c + r]) / (root[row] * root[col]);
      sum[row] += v;
      if (i != j) sum[col] += v;
    }
}

/* Largest sum of magnitudes in a row; sum[dim*n_node] is zero before. */
static double largest_row_sum(const stiffness *k, const body_factor *f,
                              const double *root, double *sum) {
  const double scale = ldexp(1, -f->exponent);
  double most = 0;
  for (int q = 0; q < f->n_own; ++q) {
    const int j = f->node[q];
    for (size_t p = k->start[j]; p < k->start[j + 1]; ++p)
      add_magnitudes(k, p, j, root, sum);
  }
  for (long p = 0; p < f->n; ++p) most = fmax(most, sum[f->unknown[p]]);
  return 1 + scale * most;
}

/* *growth = |D inv(K) D| by inverse iteration from ones with a ripple. */
static status inverse_norm(const body_factor *f, const double *root,
                           cholmod_common *cm, double *growth) {
  enum { PASSES = 2 };
  OWNED_NEW(double, x, f->n);
  for (long p = 0; p < f->n; ++p) x[p] = 1 + 0.25 * (double)(f->unknown[p] % 7);
  for (int pass = 0; pass < PASSES; ++pass) {
    const double size = norm((int)f->n, x);
    for (long p = 0; p < f->n; ++p) x[p] *= root[f->unknown[p]] / size;
    PASS(solve_lower(f, 0, x, cm));
    PASS(solve_lower(f, 1, x, cm));
    for (long p = 0; p < f->n; ++p) x[p] *= root[f->unknown[p]];
    *growth = norm((int)f->n, x);
  }
  return OK;
}

status body_factor_condition(const stiffness *k, const body_factor *f,
                             cholmod_common *cm, double *condition) {
  const size_t n = (size_t)k->dim * k->n_node;
  OWNED double *sum = NULL, *root = NULL;
  double growth = 0;
  PASS_NEW_ALL(OF(sum, n), OF(root, n));
  fill_roots(k, f, root);
  PASS(inverse_norm(f, root, cm, &growth));
  *condition = largest_row_sum(k, f, root, sum) * growth;
  return OK;
}
