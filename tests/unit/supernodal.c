/* src/fem/supernodal: factors of which parts are made again. */
#include "fem/supernodal/supernodal.h"
#include "support/unit.h"

/* A grid with unknowns that are coupled to the next ones, and its diagonal. */
enum { SIDE = 40, N = SIDE * SIDE };

typedef struct grid {
  cholmod_common cm;
  cholmod_factor *L;
  supernodal *s;
  supernodal_part all;
  double diagonal[N];
  long at[N]; /* place in the factor of an unknown, and back */
  long of[N];
  double *values, **x;
  unsigned char *mark;
} grid;

static double entry(const grid *g, long i, long j) {
  const long apart = labs(i - j);
  if (apart == 0) return g->diagonal[i];
  if (apart == SIDE) return -1;
  return apart == 1 && i / SIDE == j / SIDE ? -1 : 0;
}

static void fill(void *ctx, int q, const int *position, double *x) {
  const grid *g = ctx;
  const long rows = g->s->start[q + 1] - g->s->start[q];
  for (long c = g->s->first[q]; c < g->s->first[q + 1]; ++c)
    for (long i = 0; i < N; ++i)
      if (g->at[i] >= c && entry(g, i, g->of[c]) != 0)
        x[rows * (c - g->s->first[q]) + position[g->at[i]]] =
            entry(g, i, g->of[c]);
}

static cholmod_sparse *pattern(grid *g) {
  cholmod_triplet *t =
      cholmod_l_allocate_triplet(N, N, 3 * N, -1, CHOLMOD_REAL, &g->cm);
  long *i = t->i, *j = t->j;
  double *x = t->x;
  for (long a = 0; a < N; ++a)
    for (long b = a; b < N; ++b) {
      if (entry(g, a, b) == 0) continue;
      i[t->nnz] = b;
      j[t->nnz] = a;
      x[t->nnz++] = entry(g, a, b);
    }
  cholmod_sparse *A = cholmod_l_triplet_to_sparse(t, 0, &g->cm);
  cholmod_l_free_triplet(&t, &g->cm);
  return A;
}

/* most: columns of a supernode, 0: any. */
static grid *grid_new_of(int most) {
  grid *g = calloc(1, sizeof *g);
  for (int i = 0; i < N; ++i) g->diagonal[i] = 4.1 + 0.001 * (i % 7);
  cholmod_l_start(&g->cm);
  g->cm.supernodal = CHOLMOD_SUPERNODAL;
  cholmod_sparse *A = pattern(g);
  g->L = cholmod_l_analyze(A, &g->cm);
  cholmod_l_free_sparse(&A, &g->cm);
  if (most > 0) ck_assert_int_eq(supernodal_split(g->L, most, &g->cm), 1);
  const long *perm = g->L->Perm;
  for (long p = 0; p < N; ++p) {
    g->of[p] = perm[p];
    g->at[perm[p]] = p;
  }
  ck_assert_int_eq(supernodal_new(g->L, &g->s), OK);
  g->mark = malloc((size_t)g->s->count);
  memset(g->mark, 1, (size_t)g->s->count);
  g->all.list = malloc((size_t)g->s->count * sizeof *g->all.list);
  supernodal_list(g->s, g->mark, &g->all);
  g->values = calloc(g->L->xsize, sizeof *g->values);
  g->x = calloc((size_t)g->s->count, sizeof *g->x);
  double *next = g->values;
  for (int q = 0; q < g->s->count; ++q) {
    g->x[q] = next;
    next += supernodal_entries(g->s, q);
  }
  return g;
}

static grid *grid_new(void) { return grid_new_of(0); }

static void grid_free(grid *g) {
  memory_free(g->s);
  cholmod_l_free_factor(&g->L, &g->cm);
  cholmod_l_finish(&g->cm);
  free(g->mark);
  free(g->all.list);
  free(g->values);
  free(g->x);
  free(g);
}

/* Change the diagonal entry of an unknown, and the factor; the share of it that
 * was made again. */
static double change(grid *g, int i, double value) {
  double some = 0;
  g->diagonal[i] = value;
  memset(g->mark, 0, (size_t)g->s->count);
  g->mark[g->s->of[g->at[i]]] = 1;
  supernodal_close(g->s, g->mark);
  ck_assert_int_eq(supernodal_factor(g->s, g->mark, fill, g, g->x), -1);
  for (int q = 0; q < g->s->count; ++q) some += g->mark[q];
  return some / g->s->count;
}

static int factor_whole(grid *g) {
  memset(g->mark, 1, (size_t)g->s->count);
  return supernodal_factor(g->s, g->mark, fill, g, g->x);
}

/* Largest of A x - b for the solution x of b; unknowns without a place are
 * zero. */
static double left_by_solve(grid *g) {
  double v[N], x[N], worst = 0;
  for (int p = 0; p < N; ++p) v[p] = 1 + p % 3;
  supernodal_forward(g->s, g->x, &g->all, v);
  supernodal_back(g->s, g->x, &g->all, v);
  for (int i = 0; i < N; ++i) x[i] = g->at[i] >= 0 ? v[g->at[i]] : 0;
  for (int i = 0; i < N; ++i) {
    if (g->at[i] < 0) continue;
    double sum = g->diagonal[i] * x[i];
    if (i % SIDE > 0) sum -= x[i - 1];
    if (i % SIDE < SIDE - 1) sum -= x[i + 1];
    if (i >= SIDE) sum -= x[i - SIDE];
    if (i < N - SIDE) sum -= x[i + SIDE];
    worst = fmax(worst, fabs(sum - (double)(1 + g->at[i] % 3)));
  }
  return worst;
}

TEST(solves_leave_nothing_of_the_right_side) {
  grid *g = grid_new();
  int most = 0;
  ck_assert_int_eq(factor_whole(g), -1);
  ck_assert_double_le(left_by_solve(g), 1e-13);
  for (int q = 0; q < g->s->count; ++q) {
    const int n = (int)(g->s->first[q + 1] - g->s->first[q]);
    most = n > most ? n : most;
  }
  ck_assert_int_gt(most, 16); /* both ways of elimination */
  grid_free(g);
}

static size_t entries_of(const supernodal *s) {
  size_t sum = 0;
  for (int q = 0; q < s->count; ++q) sum += supernodal_entries(s, q);
  return sum;
}

/* Without the unknowns of some rows of the grid, or of all that a supernode
 * has: the factor of the rest, in less memory. */
TEST(restricted_factors_are_of_the_other_unknowns) {
  grid *g = grid_new();
  supernodal *whole = g->s;
  int number[N], n = 0, emptied = 0;
  for (int p = 0; p < N; ++p)
    number[p] = g->of[p] / SIDE % 4 == 1 || whole->of[p] % 9 == 2 ? -1 : n++;
  ck_assert_int_eq(supernodal_restrict(whole, number, &g->s), OK);
  ck_assert_int_eq(g->s->n, n);
  for (int i = 0; i < N; ++i) g->at[i] = number[g->at[i]];
  for (int i = 0; i < N; ++i)
    if (g->at[i] >= 0) g->of[g->at[i]] = i;
  ck_assert_double_lt((double)entries_of(g->s), 0.8 * (double)g->L->xsize);
  double *next = g->values;
  for (int q = 0; q < g->s->count; ++q) {
    emptied += supernodal_entries(g->s, q) == 0;
    g->x[q] = next;
    next += supernodal_entries(g->s, q);
  }
  ck_assert_int_gt(emptied, 0);
  ck_assert_int_eq(factor_whole(g), -1);
  ck_assert_double_le(left_by_solve(g), 1e-13);
  memory_free(g->s);
  g->s = whole;
  grid_free(g);
}

TEST(changes_reach_a_part_and_leave_the_bits_of_a_whole_factor) {
  grid *g = grid_new(), *h = grid_new();
  double share = 0;
  ck_assert_int_eq(factor_whole(g), -1);
  for (int i = 5; i < N; i += 199) {
    share = fmax(share, change(g, i, 5));
    h->diagonal[i] = 5;
  }
  ck_assert_int_eq(factor_whole(h), -1);
  ck_assert_double_le(share, 0.2);
  ck_assert(memcmp(g->values, h->values, g->L->xsize * sizeof(double)) == 0);
  ck_assert_double_le(left_by_solve(g), 1e-13);
  grid_free(g);
  grid_free(h);
}

/* Forces in one place and displacements in another need their parts alone. */
TEST(parts_give_what_the_whole_gives) {
  grid *g = grid_new();
  supernodal_part from = {0}, to = {0};
  double v[N] = {0}, w[N] = {0};
  const long force = 3 * SIDE, seen = N - 2;
  from.list = malloc((size_t)g->s->count * sizeof *from.list);
  to.list = malloc((size_t)g->s->count * sizeof *to.list);
  ck_assert_int_eq(factor_whole(g), -1);
  memset(g->mark, 0, (size_t)g->s->count);
  g->mark[g->s->of[g->at[force]]] = 1;
  supernodal_close(g->s, g->mark);
  supernodal_list(g->s, g->mark, &from);
  memset(g->mark, 0, (size_t)g->s->count);
  g->mark[g->s->of[g->at[seen]]] = 1;
  supernodal_close(g->s, g->mark);
  supernodal_list(g->s, g->mark, &to);
  ck_assert_int_lt(from.n + to.n, g->s->count);
  v[g->at[force]] = w[g->at[force]] = 1;
  supernodal_forward(g->s, g->x, &g->all, v);
  supernodal_back(g->s, g->x, &g->all, v);
  supernodal_forward(g->s, g->x, &from, w);
  supernodal_back(g->s, g->x, &to, w);
  ck_assert(v[g->at[seen]] > 0 && v[g->at[seen]] == w[g->at[seen]]);
  free(from.list);
  free(to.list);
  grid_free(g);
}

/* Parts of supernodes: the same factor in less memory, for CHOLMOD too. */
TEST(wide_supernodes_can_be_split) {
  grid *g = grid_new_of(5), *h = grid_new();
  ck_assert_int_gt(g->s->count, h->s->count);
  ck_assert_uint_lt(g->L->xsize, h->L->xsize);
  ck_assert_uint_lt(g->L->maxcsize, h->L->maxcsize);
  for (int q = 0; q < g->s->count; ++q)
    ck_assert_int_le(g->s->first[q + 1] - g->s->first[q], 5);
  ck_assert_int_eq(factor_whole(g), -1);
  ck_assert_double_le(left_by_solve(g), 1e-13);
  cholmod_sparse *A = pattern(g);
  ck_assert_int_eq(cholmod_l_factorize(A, g->L, &g->cm), 1);
  for (size_t i = 0; i < g->L->xsize; ++i)
    ck_assert_double_eq_tol(((double *)g->L->x)[i], g->values[i], 1e-14);
  cholmod_l_free_sparse(&A, &g->cm);
  grid_free(g);
  grid_free(h);
}

/* The place of the first pivot that is not positive. */
TEST(indefinite_matrices_are_told) {
  grid *g = grid_new();
  for (int k = 0; k < 2; ++k) {
    const long p = k == 0 ? 0 : N - 1;
    const double before = g->diagonal[g->of[p]];
    g->diagonal[g->of[p]] = -4;
    ck_assert_int_eq(factor_whole(g), p);
    g->diagonal[g->of[p]] = before;
  }
  ck_assert_int_eq(factor_whole(g), -1);
  grid_free(g);
}

UNIT_MAIN("supernodal")
