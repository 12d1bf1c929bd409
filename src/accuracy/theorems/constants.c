/* Norms in the energy of A, and the constants of friction in them. */
#include "accuracy/theorems/theorems.h"

#include <cblas.h>
#include <lapacke.h>

enum { STEPS = 160, EVERY = 8 };
static const double CLOSE = 1e-10; /* -, residual of Lanczos over the value */

/* H from its columns, then dsyevr for the last eigenvalue. */
static status dense_largest(const symmetric_map *map, double *largest) {
  OWNED int *iwork = NULL;
  int n = map->n, found, support[2];
  size_t ld = n;
  OWNED double *H = NULL, *x = NULL, *w = NULL, *work = NULL;
  PASS_NEW(H, ld * ld);
  PASS_NEW_REALS(ld, &x, &w);
  PASS_NEW_ALL(OF(work, 26 * ld), OF(iwork, 10 * ld));
  for (size_t j = 0; j < ld; ++j) {
    x[j] = 1.0;
    map->apply(map->ctx, x, H + ld * j);
    x[j] = 0.0;
  }
  if (LAPACKE_dsyevr_work(LAPACK_COL_MAJOR, 'N', 'I', 'L', n, H, n, 0.0, 0.0, n,
                          n, 0.0, &found, w, NULL, 1, support, work, 26 * n,
                          iwork, 10 * n) != 0)
    RAISE(ERR_INTERNAL, "eigenvalue of order %d not found", n);
  *largest = fmax(w[0], 0.0);
  return OK;
}

typedef struct lanczos {
  int n, k;             /* order; vectors so far */
  double *Q;            /* [n*STEPS] */
  double *alpha, *beta; /* [STEPS] the tridiagonal matrix */
  double *d, *e, *Z,
      *work; /* [STEPS], [STEPS], [STEPS^2], [2*STEPS] workspace */
} lanczos;

/* Largest eigenvalue of the tridiagonal matrix, and its residual added. */
static double ritz(lanczos *s, double *residual) {
  int k = s->k;
  COPY(s->d, s->alpha, k);
  COPY(s->e, s->beta, k);
  LAPACKE_dstev_work(LAPACK_COL_MAJOR, 'V', k, s->d, s->e, s->Z, k, s->work);
  *residual = s->beta[k - 1] * fabs(s->Z[(size_t)(k * k) - 1]);
  return s->d[k - 1];
}

/* The next vector: H q less what lies along the vectors so far, twice. */
static void lanczos_step(const symmetric_map *map, lanczos *s, double *v) {
  const double *q = s->Q + (size_t)s->n * s->k;
  map->apply(map->ctx, q, v);
  s->alpha[s->k] = cblas_ddot(s->n, q, 1, v, 1);
  ++s->k;
  for (int twice = 0; twice < 2; ++twice) {
    cblas_dgemv(CblasColMajor, CblasTrans, s->n, s->k, 1.0, s->Q, s->n, v, 1,
                0.0, s->work, 1);
    cblas_dgemv(CblasColMajor, CblasNoTrans, s->n, s->k, -1.0, s->Q, s->n,
                s->work, 1, 1.0, v, 1);
  }
  s->beta[s->k - 1] = cblas_dnrm2(s->n, v, 1);
}

/*
 * Added at the end: the residual, or what the last half of the steps added if
 * more. Where eigenvalues crowd at the top, as those of springs in a row, the
 * error falls with the square of the steps and is a third of it.
 */
static status lanczos_run(const symmetric_map *map, lanczos *s, double *v,
                          double *largest) {
  double residual = 0.0, history[STEPS / EVERY + 1] = {0.0};
  int last = s->n < STEPS ? s->n : STEPS;
  *largest = 0.0;
  for (int i = 0; i < s->n; ++i) s->Q[i] = 1.0 + 0.5 * sin(1.0 + 2.0 * i);
  cblas_dscal(s->n, 1.0 / cblas_dnrm2(s->n, s->Q, 1), s->Q, 1);
  for (;;) {
    lanczos_step(map, s, v);
    double beta = s->beta[s->k - 1];
    int stop = s->k == last || !(beta > 1e-14 * s->alpha[0]);
    if (stop || s->k % EVERY == 0) {
      *largest = history[s->k / EVERY] = ritz(s, &residual);
      if (stop || !(residual > CLOSE * *largest)) break;
    }
    double *next = s->Q + (size_t)s->n * s->k;
    for (int i = 0; i < s->n; ++i) next[i] = v[i] / beta;
  }
  if (residual > CLOSE * *largest)
    residual = fmax(residual, *largest - history[s->k / EVERY / 2]);
  if (s->k < s->n) *largest += residual;
  return OK;
}

status lanczos_largest(const symmetric_map *map, double *largest) {
  double *v;
  OWNED_NEW(lanczos, s, 1);
  OWNS(s);
  s->n = map->n;
  PASS_NEW(s->Q, (size_t)map->n * STEPS);
  PASS_NEW_REALS(STEPS, &s->alpha, &s->beta, &s->d, &s->e);
  PASS_NEW_ALL(OF(s->Z, STEPS * STEPS), OF(s->work, 2 * STEPS), OF(v, map->n));
  return lanczos_run(map, s, v, largest);
}

status largest_eigenvalue(const symmetric_map *map, double *largest) {
  return map->n <= DENSE_ORDER ? dense_largest(map, largest)
                               : lanczos_largest(map, largest);
}

static const double MOVES = 1e-8; /* -, of the largest part of a motion */

status energy_norm_new(int m, const double *A, energy_norm *out) {
  *out = (energy_norm){.m = m, .A = A};
  PASS_NEW_REALS(m, &out->x, &out->y);
  PASS(dense_inverse_new(m, A, &out->inverse));
  if (out->inverse != NULL) out->dual = dense_inverse_energy(out->inverse);
  return OK;
}

void energy_norm_free(energy_norm *e) {
  RELEASE(e->inverse, e->x, e->y);
  *e = (energy_norm){0};
}

double energy_norm_of(energy_norm *e, const double *v) {
  contact_product(e->m, e->A, v, e->y);
  return sqrt(fmax(0.0, cblas_ddot(e->m, v, 1, e->y, 1)));
}

double energy_norm_dual(energy_norm *e, const double *f) {
  double square = NAN;
  if (e->dual.square(e->dual.ctx, f, &square) != OK) return NAN;
  return sqrt(square);
}

/* The unknowns that a map acts on. */
typedef struct block {
  const contact_problem *cp;
  energy_norm *e;
  int n, *dof; /* [n] of the block */
} block;

static void scatter(const block *b, const double *x, double *full) {
  CLEAR(full, b->cp->m);
  for (int k = 0; k < b->n; ++k) full[b->dof[k]] = x[k];
}

static void gather(const block *b, const double *full, double *y) {
  for (int k = 0; k < b->n; ++k) y[k] = full[b->dof[k]];
}

/* A_nn */
static void apply_stiffness(void *ctx, const double *x, double *y) {
  const block *b = ctx;
  scatter(b, x, b->e->x);
  contact_product(b->cp->m, b->cp->A, b->e->x, b->e->y);
  gather(b, b->e->y, y);
}

/* inv(A)_tt */
static void apply_inverse(void *ctx, const double *x, double *y) {
  const block *b = ctx;
  energy_norm *e = b->e;
  scatter(b, x, e->y);
  dense_inverse_solve(e->inverse, e->y, e->y);
  gather(b, e->y, y);
}

/* B A_nn B'; the block holds the normal unknowns of the rows. */
static void apply_limit(void *ctx, const double *x, double *y) {
  const block *b = ctx;
  const contact_problem *cp = b->cp;
  const sparse_rows *B = cp->B;
  CLEAR(b->e->x, cp->m);
  for (int k = 0; k < b->n; ++k) {
    int i = b->dof[k] / cp->dim;
    for (int e = B->start[i]; e < B->start[i + 1]; ++e)
      b->e->x[cp->dim * B->col[e]] += B->val[e] * x[k];
  }
  contact_product(cp->m, cp->A, b->e->x, b->e->y);
  for (int k = 0; k < b->n; ++k) {
    int i = b->dof[k] / cp->dim;
    y[k] = 0.0;
    for (int e = B->start[i]; e < B->start[i + 1]; ++e)
      y[k] += B->val[e] * b->e->y[cp->dim * B->col[e]];
  }
}

static int has_row(const contact_problem *cp, int i) {
  const sparse_rows *B = cp->B;
  for (int e = row_begin(B, i); e < row_end(B, i); ++e)
    if (B->val[e] != 0.0) return 1;
  return 0;
}

static status largest_of(const block *b,
                         void (*apply)(void *ctx, const double *x, double *y),
                         double *largest) {
  symmetric_map map = {b->n, (void *)b, apply};
  *largest = 0.0;
  return b->n == 0 ? OK : largest_eigenvalue(&map, largest);
}

/* 1: a motion without energy moves the block: nothing bounds it. A motion that
 * does not, as of a body that lies on its obstacle, adds nothing to |v_t|. */
static int is_loose(const block *b) {
  if (b->e->inverse == NULL) return 1;
  for (int c = 0; c < b->e->dual.n_kernel; ++c) {
    const double *z = b->e->dual.kernel + (size_t)c * b->cp->m;
    double most = largest_entry(b->cp->m, z), part = 0.0;
    for (int k = 0; k < b->n; ++k) part = fmax(part, fabs(z[b->dof[k]]));
    if (part > MOVES * most) return 1;
  }
  return 0;
}

static status tangential_constant(block *b, int limits, double *largest) {
  const contact_problem *cp = b->cp;
  b->n = 0;
  for (int i = 0; i < cp->n && cp->g0 != NULL; ++i) {
    if (!has_row(cp, i) && !(limits && cp->g0[i] > 0.0)) continue;
    for (int k = 1; k < cp->dim; ++k)
      if (!contact_held(cp, cp->dim * i + k)) b->dof[b->n++] = cp->dim * i + k;
  }
  *largest = HUGE_VAL;
  return is_loose(b) ? OK : largest_of(b, apply_inverse, largest);
}

status friction_constants(const contact_problem *cp, energy_norm *e, int limits,
                          theorems_contact *out) {
  double product = 0.0;
  OWNED_NEW(int, dof, cp->m);
  OWNED_NEW(unsigned char, pressed, cp->n);
  block b = {.cp = cp, .e = e, .dof = dof};
  /* Nodes whose pressure moves a limit: pressed[n]. */
  const sparse_rows *B = cp->B;
  for (int k = 0; B != NULL && k < B->start[B->n]; ++k)
    if (B->val[k] != 0.0) pressed[B->col[k]] = 1;
  for (int i = 0; i < cp->n; ++i)
    if (pressed[i]) b.dof[b.n++] = cp->dim * i;
  PASS(largest_of(&b, apply_stiffness, &out->normal));
  b.n = 0;
  for (int i = 0; i < cp->n; ++i)
    if (has_row(cp, i)) b.dof[b.n++] = cp->dim * i;
  PASS(largest_of(&b, apply_limit, &product));
  PASS(tangential_constant(&b, limits, &out->tangent));
  out->factor = product > 0.0 ? sqrt(product) * sqrt(out->tangent) : 0.0;
  return OK;
}
