/* src/exchange/reduce.c: global problems whose bodies touch few others. */
#include "base/sparse.h"
#include "exchange/exchange.h"
#include "support/contact_case.h"
#include "support/decks.h"
#include "support/fclib_file.h"
#include "support/folder.h"
#include "support/unit.h"

static char folder[64], path[128];

static exchange_problem *read_problem(void) {
  exchange_problem *p = NULL;
  OWNED message_log *log = NULL;
  const place at = {.file = "a.inp", .line_no = 1};
  ck_assert_int_eq(message_log_new(&log), OK);
  status st = exchange_read(path, EXCHANGE_FCLIB, &at, log, &p);
  ck_assert_msg(st == OK, "%s", status_message());
  return p;
}

static void enter(void) {
  folder_new(folder);
  snprintf(path, sizeof path, "%s/problem.h5", folder);
}

static void leave(exchange_problem *p) {
  memory_free(p);
  folder_remove(folder);
}

enum {
  BODIES = 40,
  CONTACTS = BODIES - 1,
  ROWS = 2 * BODIES,
  M = 2 * CONTACTS
};

typedef struct row_of_bodies {
  double mass[ROWS * ROWS], H[ROWS * M], f[ROWS], w[M], mu[CONTACTS];
  double W[M * M], q[M]; /* by hand: sums over the bodies */
} row_of_bodies;

/* Of a body of rows 2 b and 2 b + 1, by the inverse of its mass. */
static void add_body(row_of_bodies *t, int b) {
  const double *m = t->mass + 2 * b + ROWS * 2 * b;
  const double det = m[0] * m[ROWS + 1] - m[1] * m[ROWS];
  const double inverse[4] = {m[ROWS + 1] / det, -m[1] / det, -m[ROWS] / det,
                             m[0] / det};
  for (int j = 0; j <= M; ++j) {
    const double *x = j < M ? t->H + ROWS * j + 2 * b : t->f + 2 * b;
    double v[2];
    for (int a = 0; a < 2; ++a)
      v[a] = inverse[a] * x[0] + inverse[a + 2] * x[1];
    for (int i = 0; i < M; ++i) {
      const double *h = t->H + ROWS * i + 2 * b;
      double *to = j < M ? &t->W[i + M * j] : &t->q[i];
      *to += h[0] * v[0] + h[1] * v[1];
    }
  }
}

/* Full masses of two unknowns; a contact between the last of each body and the
 * first of the next: what joins contacts is in the masses alone. */
static void make_row(row_of_bodies *t) {
  unsigned long long seed = 23;
  memset(t, 0, sizeof *t);
  for (int b = 0; b < BODIES; ++b) {
    double *m = t->mass + 2 * b + ROWS * 2 * b;
    m[0] = 1.0 + case_random(&seed);
    m[ROWS + 1] = 1.0 + case_random(&seed);
    m[1] = m[ROWS] = 1.6 * case_random(&seed) - 0.8;
  }
  for (int j = 0; j < M; ++j)
    for (int i = 1; i < 3; ++i)
      t->H[ROWS * j + j / 2 * 2 + i] = 2.0 * case_random(&seed) - 1.0;
  for (int i = 0; i < ROWS; ++i) t->f[i] = case_random(&seed);
  for (int i = 0; i < M; ++i) t->q[i] = t->w[i] = case_random(&seed);
  for (int i = 0; i < CONTACTS; ++i) t->mu[i] = 0.3;
  for (int b = 0; b < BODIES; ++b) add_body(t, b);
}

TEST(bodies_apart_are_condensed_in_blocks) {
  static row_of_bodies t;
  for (int triangle = 0; triangle < 2; ++triangle) {
    double have[M * M];
    enter();
    make_row(&t);
    for (int b = 0; triangle && b < BODIES; ++b)
      t.mass[2 * b + 1 + ROWS * 2 * b] = 0.0;
    fclib_global(
        path, STORE_TRIPLET,
        &(fclib_global_data){2, CONTACTS, ROWS, t.mass, t.H, t.f, t.w, t.mu});
    exchange_problem *p = read_problem();
    ck_assert_ptr_nonnull(p->cp.blocks);
    ck_assert_int_eq(p->cp.blocks->start[CONTACTS], 3 * CONTACTS - 2);
    contact_dense(&p->cp, have);
    for (int j = 0; j < M; ++j) {
      const double turn = j % 2 ? 1.0 : -1.0;
      ck_assert_double_eq_tol(p->cp.f[j], turn * t.q[j], 1e-13);
      for (int i = 0; i < M; ++i) {
        ck_assert_double_eq_tol(have[i + M * j],
                                (i % 2 ? turn : -turn) * t.W[i + M * j], 1e-13);
        ck_assert_double_eq(have[i + M * j], have[j + M * i]);
      }
    }
    leave(p);
  }
}

/* A matrix group with 1 in the diagonal and, where not zero, "below" two rows
 * under it. */
static void write_band(hid_t file, const char *group, int rows, int columns,
                       double below) {
  static const char *const items[] = {"m", "n", "nz", "nzmax"};
  const size_t n = (size_t)columns, all = below != 0.0 ? 2 * n : n;
  const int counts[] = {rows, columns, (int)all, (int)all};
  FREED int *across = calloc(all, sizeof *across),
            *down = calloc(all, sizeof *down);
  FREED double *x = calloc(all, sizeof *x);
  char name[60];
  for (size_t k = 0; k < all; ++k) {
    across[k] = (int)(k % n);
    down[k] = across[k] + (k < n ? 0 : 2);
    x[k] = k < n ? 1.0 : below;
  }
  for (int k = 0; k < 4; ++k) {
    snprintf(name, sizeof name, "%s/%s", group, items[k]);
    fclib_int(file, name, counts[k]);
  }
  snprintf(name, sizeof name, "%s/p", group);
  fclib_ints(file, name, (int)all, across);
  snprintf(name, sizeof name, "%s/i", group);
  fclib_ints(file, name, (int)all, down);
  snprintf(name, sizeof name, "%s/x", group);
  fclib_reals(file, name, (int)all, x);
}

/* Unit masses in a row, more contacts than a matrix of all entries may have:
 * blocks 2 and -1. */
TEST(many_bodies_need_no_dense_matrix) {
  enum { MANY = 20000, ALL = 2 * MANY + 2 };
  FREED double *zero = calloc(ALL, sizeof *zero);
  enter();
  hid_t file = fclib_begin(path);
  fclib_int(file, "/fclib_global/spacedim", 2);
  write_band(file, "/fclib_global/M", ALL, ALL, 0.0);
  write_band(file, "/fclib_global/H", ALL, 2 * MANY, -1.0);
  fclib_reals(file, "/fclib_global/vectors/f", ALL, zero);
  fclib_reals(file, "/fclib_global/vectors/w", 2 * MANY, zero);
  fclib_reals(file, "/fclib_global/vectors/mu", MANY, zero);
  fclib_end(file);
  exchange_problem *p = read_problem();
  const sparse_blocks *b = p->cp.blocks;
  ck_assert_ptr_nonnull(b);
  ck_assert_int_eq(b->start[MANY], 3 * MANY - 2);
  for (int j = 0; j < MANY; ++j)
    for (int k = b->start[j]; k < b->start[j + 1]; ++k)
      for (int e = 0; e < 4; ++e)
        ck_assert_double_eq(b->val[4 * k + e], e % 3 != 0       ? 0.0
                                               : b->row[k] == j ? 2.0
                                                                : -1.0);
  leave(p);
}

UNIT_MAIN("reduce")
