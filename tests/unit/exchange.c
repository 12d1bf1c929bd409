/* src/exchange: problems of every storage, files of every defect. */
#include "exchange/exchange.h"
#include "support/contact_case.h"
#include "support/decks.h"
#include "support/fclib_file.h"
#include "support/folder.h"
#include "support/unit.h"

#include <unistd.h>

static char folder[64], path[128];

static void enter(void) {
  folder_new(folder);
  snprintf(path, sizeof path, "%s/problem.h5", folder);
}

static void leave(void) { folder_remove(folder); }

/* The file read; the message if it is refused. */
typedef struct answer {
  exchange_problem *p;
  status st;
  char text[1024];
} answer;

static answer read_as(exchange_type type) {
  answer a = {0};
  OWNED message_log *log = NULL;
  const place at = {.file = "a.inp", .line_no = 1};
  ck_assert_int_eq(message_log_new(&log), OK);
  a.st = exchange_read(path, type, &at, log, &a.p);
  ck_assert((a.st == OK) == (a.p != NULL));
  if (a.st != OK) snprintf(a.text, sizeof a.text, "%s", status_message());
  if (a.st == ERR_DECK || a.st == ERR_FILE)
    ck_assert_int_eq(message_count(log, ERROR), 1);
  return a;
}

static void random_matrix(int n, double *a, unsigned long long *seed) {
  for (int k = 0; k < n; ++k) a[k] = 2.0 * case_random(seed) - 1.0;
}

/* a = b b' + d I, n columns of b. */
static void random_spd(int m, int n, double d, double *a,
                       unsigned long long *seed) {
  FREED double *b = calloc((size_t)(m * n), sizeof *b);
  random_matrix(m * n, b, seed);
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < m; ++j) {
      double sum = i == j ? d : 0.0;
      for (int k = 0; k < n; ++k) sum += b[i + m * k] * b[j + m * k];
      a[i + m * j] = sum;
    }
}

/* The problem read, against W and q of FCLIB: normal signs turned. */
static void check_local(const exchange_problem *p, int dim, int n,
                        const double *W, const double *q, const double *mu,
                        double tol) {
  int m = dim * n;
  FREED double *have = calloc((size_t)(m * m), sizeof *have);
  contact_dense(&p->cp, have);
  ck_assert_int_eq(p->dim, dim);
  ck_assert_int_eq(p->n, n);
  ck_assert_ptr_null(p->cp.A);
  for (int j = 0; j < m; ++j) {
    double s = j % dim == 0 ? -1.0 : 1.0;
    ck_assert_double_eq_tol(p->cp.f[j], s * q[j], tol);
    for (int i = 0; i < m; ++i) {
      double t = i % dim == 0 ? -s : s;
      ck_assert_double_eq_tol(have[i + m * j], t * W[i + m * j], tol);
    }
  }
  for (int i = 0; i < n; ++i) {
    ck_assert_double_eq(p->cp.B->val[i], mu[i]);
    ck_assert_double_eq(p->cp.gap[i], 0.0);
  }
}

static const int stores[] = {STORE_TRIPLET, STORE_COLUMNS, STORE_ROWS};

/* Three of 16 blocks off the diagonal, unsymmetric. */
static void few_blocks(int dim, double *W, unsigned long long *seed) {
  int m = 4 * dim;
  random_matrix(m * m, W, seed);
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < m; ++i) {
      int a = i / dim, b = j / dim;
      int there = a == b || (a == 2 && b == 0) || (a + b == 4 && a * b == 3);
      if (!there) W[i + m * j] = 0.0;
    }
}

TEST(compliance_of_few_blocks_is_kept_in_them) {
  enter();
  for (int dim = 2; dim <= 3; ++dim) {
    unsigned long long seed = 5;
    double W[144], q[12], mu[4] = {0.5, 0.0, 1.5, 0.3};
    random_matrix(12, q, &seed);
    for (int few = 0; few < 2; ++few) {
      few_blocks(dim, W, &seed);
      if (!few) random_matrix(16 * dim * dim, W, &seed);
      fclib_local(path, STORE_ROWS, dim, 4, W, q, mu);
      answer a = read_as(EXCHANGE_FCLIB);
      ck_assert_msg(a.st == OK, "%s", a.text);
      ck_assert_int_eq(a.p->cp.blocks != NULL, few);
      ck_assert_int_eq(a.p->cp.W == NULL, few);
      check_local(a.p, dim, 4, W, q, mu, 1e-15);
      memory_free(a.p);
    }
  }
  leave();
}

/* An unsymmetric matrix with zeros, so that rows and columns are told apart. */
TEST(every_storage_gives_the_same_problem) {
  enter();
  for (int dim = 2; dim <= 3; ++dim)
    for (int k = 0; k < 3; ++k) {
      unsigned long long seed = 3;
      double W[81], q[9], mu[3] = {0.5, 0.0, 1.5};
      random_matrix(81, W, &seed);
      random_matrix(9, q, &seed);
      for (int i = 0; i < 81; i += 4) W[i] = 0.0;
      fclib_local(path, stores[k], dim, 3, W, q, mu);
      answer a = read_as(k == 0 ? EXCHANGE_BY_CONTENT : EXCHANGE_FCLIB);
      ck_assert_msg(a.st == OK, "%s", a.text);
      check_local(a.p, dim, 3, W, q, mu, 1e-15);
      memory_free(a.p);
    }
  leave();
}

/* b = H' inv(M) [H f], by elimination without pivots; M is SPD. */
static void condense_dense(int n, int m, const double *M_in, const double *H,
                           const double *f, double *W, double *q) {
  int c = m + 1;
  FREED double *M = malloc(sizeof *M * (size_t)(n * n));
  FREED double *B = malloc(sizeof *B * (size_t)(n * c));
  memcpy(M, M_in, sizeof *M * (size_t)(n * n));
  memcpy(B, H, sizeof *B * (size_t)(n * m));
  memcpy(B + n * m, f, sizeof *B * (size_t)n);
  for (int k = 0; k < n; ++k)
    for (int i = 0; i < n; ++i) {
      if (i == k) continue;
      double ratio = M[i + n * k] / M[k + n * k];
      for (int j = k; j < n; ++j) M[i + n * j] -= ratio * M[k + n * j];
      for (int j = 0; j < c; ++j) B[i + n * j] -= ratio * B[k + n * j];
    }
  for (int j = 0; j < c; ++j)
    for (int i = 0; i < m; ++i) {
      double sum = 0.0;
      for (int k = 0; k < n; ++k)
        sum += H[k + n * i] * B[k + n * j] / M[k + n * k];
      if (j < m)
        W[i + m * j] = sum;
      else
        q[i] += sum;
    }
}

enum { NV = 40, NC = 3 };
typedef struct global_case {
  double M[NV * NV], H[NV * 3 * NC], f[NV], w[3 * NC], mu[NC];
  double W[9 * NC * NC], q[3 * NC]; /* condensed                             */
  fclib_global_data data;
} global_case;

static void global_make(global_case *g, int dim) {
  unsigned long long seed = 11;
  int m = dim * NC;
  random_spd(NV, NV, 0.5, g->M, &seed);
  /* Units that differ by 1e6, as masses and moments of inertia do. */
  for (int i = 0; i < NV; ++i)
    for (int j = 0; j < NV; ++j)
      g->M[i + NV * j] *= (i % 2 ? 1e-3 : 1.0) * (j % 2 ? 1e-3 : 1.0);
  random_matrix(NV * m, g->H, &seed);
  for (int k = 0; k < NV * m; k += 3) g->H[k] = 0.0;
  for (int k = 1; k < NV * m; k += 2) g->H[k] *= 1e-3;
  random_matrix(NV, g->f, &seed);
  random_matrix(m, g->w, &seed);
  for (int i = 0; i < NC; ++i) g->mu[i] = 0.3 * (i + 1);
  memcpy(g->q, g->w, sizeof g->q);
  condense_dense(NV, m, g->M, g->H, g->f, g->W, g->q);
  g->data = (fclib_global_data){.dim = dim, .n = NC, .n_v = NV};
  g->data.M = g->M;
  g->data.H = g->H;
  g->data.f = g->f;
  g->data.w = g->w;
  g->data.mu = g->mu;
}

/* keep: 0 all of M, 1 the upper, -1 the lower triangle only. */
static void keep_triangle(double *M, int keep) {
  for (int i = 0; i < NV; ++i)
    for (int j = 0; j < NV; ++j)
      if (keep * (j - i) < 0) M[i + NV * j] = 0.0;
}

TEST(global_problem_is_its_local_condensation) {
  FREED global_case *g = malloc(sizeof *g);
  enter();
  for (int dim = 2; dim <= 3; ++dim)
    for (int k = 0; k < 3; ++k)
      for (int keep = -1; keep <= 1; ++keep) {
        global_make(g, dim);
        keep_triangle(g->M, keep);
        fclib_global(path, stores[k], &g->data);
        answer a = read_as(EXCHANGE_FCLIB);
        ck_assert_msg(a.st == OK, "%s", a.text);
        ck_assert_int_eq(a.p->unknowns, NV);
        check_local(a.p, dim, NC, g->W, g->q, g->mu, 1e-9);
        memory_free(a.p);
      }
  leave();
}

/* Not symmetric, or with a negative mass, of one triangle or all: regular, by
 * elimination. */
TEST(unsymmetric_mass_is_eliminated_too) {
  FREED global_case *g = malloc(sizeof *g);
  enter();
  for (int k = 0; k < 4; ++k) {
    global_make(g, 2);
    if (k > 0) g->M[NV * NV - 1] *= -1.0;
    for (int i = 0; i < NV * NV && k == 0; ++i)
      if (i % NV < i / NV) g->M[i] *= 1.01;
    memcpy(g->q, g->w, sizeof g->q);
    condense_dense(NV, 2 * NC, g->M, g->H, g->f, g->W, g->q);
    if (k > 0) keep_triangle(g->M, k - 2);
    fclib_global(path, STORE_TRIPLET, &g->data);
    answer a = read_as(EXCHANGE_FCLIB);
    ck_assert_msg(a.st == OK, "%s", a.text);
    check_local(a.p, 2, NC, g->W, g->q, g->mu, 1e-8);
    memory_free(a.p);
  }
  leave();
}

/* Unknown 5 has no mass, nor a row of H if it is not touched. */
static void make_massless(global_case *g, int touched) {
  global_make(g, 3);
  for (int i = 0; i < NV; ++i) g->M[i + NV * 5] = g->M[5 + NV * i] = 0.0;
  for (int k = 0; k < 3 * NC && !touched; ++k) g->H[5 + NV * k] = 0.0;
}

/* Unknowns 5 and 7 move as one: no pivot is zero but for rounding. */
static void make_dependent(global_case *g) {
  global_make(g, 3);
  for (int i = 0; i < NV; ++i) g->M[i + NV * 7] = g->M[i + NV * 5];
  for (int i = 0; i < NV; ++i) g->M[7 + NV * i] = g->M[5 + NV * i];
  for (int k = 0; k < 3 * NC; ++k) g->H[7 + NV * k] = g->H[5 + NV * k];
}

TEST(singular_mass_that_contact_does_not_hold_is_refused) {
  FREED global_case *g = malloc(sizeof *g);
  enter();
  for (int k = 0; k < 2; ++k) {
    k == 0 ? make_massless(g, 0) : make_dependent(g);
    fclib_global(path, STORE_TRIPLET, &g->data);
    answer a = read_as(EXCHANGE_FCLIB);
    ck_assert_int_eq(a.st, ERR_SINGULAR);
    ck_assert_ptr_nonnull(strstr(a.text, "/fclib_global/M"));
  }
  leave();
}

/* C = A B, all [m*m] column major. */
static void multiply(int m, const double *A, const double *B, double *C) {
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < m; ++j) {
      C[i + m * j] = 0.0;
      for (int k = 0; k < m; ++k) C[i + m * j] += A[i + m * k] * B[k + m * j];
    }
}

enum { MASSLESS = 3 * NC };
/* y = W0 r + q0 + h v with h'r + f = 0 for the unknown v without mass, h its
 * row of H: A y = r + F has A h = 0, A W0 A = A, trace(A W0) = m - 1, h'F = f,
 * A W0 F = A q0. */
static void check_massless(const exchange_problem *p, const double *W0,
                           const double *q0, const double *h, double f) {
  int m = MASSLESS;
  double A[MASSLESS * MASSLESS], AW[MASSLESS * MASSLESS];
  double AWA[MASSLESS * MASSLESS], trace = 0.0, along = 0.0, size = 0.0;
  double F[MASSLESS];
  for (int i = 0; i < m; ++i) {
    F[i] = p->cp.f[i] * (i % 3 ? 1.0 : -1.0);
    for (int j = 0; j < m; ++j)
      A[i + m * j] =
          p->cp.A[i + m * j] * (i % 3 ? 1.0 : -1.0) * (j % 3 ? 1.0 : -1.0);
    for (int j = 0; j < m; ++j) size = fmax(size, fabs(A[i + m * j]));
  }
  multiply(m, A, W0, AW);
  multiply(m, AW, A, AWA);
  for (int i = 0; i < m; ++i) {
    double null = 0.0, one = 0.0, other = 0.0;
    for (int j = 0; j < m; ++j) {
      ck_assert_double_le(fabs(AWA[i + m * j] - A[i + m * j]), 1e-8 * size);
      null += A[i + m * j] * h[j];
      one += AW[i + m * j] * F[j];
      other += A[i + m * j] * q0[j];
    }
    ck_assert_double_le(fabs(null), 1e-8 * size);
    ck_assert_double_le(fabs(one - other), 1e-8 * size);
    trace += AW[i + m * i];
    along += h[i] * F[i];
  }
  ck_assert_double_eq_tol(trace, m - 1, 1e-8);
  ck_assert_double_eq_tol(along, f, 1e-8 * fabs(f));
}

TEST(singular_mass_that_contact_holds_is_a_stiffness) {
  FREED global_case *g = malloc(sizeof *g);
  double h[MASSLESS], f, W0[MASSLESS * MASSLESS], q0[MASSLESS] = {0.0};
  enter();
  for (int keep = -1; keep <= 1; ++keep) {
    make_massless(g, 1);
    keep_triangle(g->M, keep);
    fclib_global(path, STORE_TRIPLET, &g->data);
    make_massless(g, 1);
    f = g->f[5];
    for (int k = 0; k < MASSLESS; ++k) h[k] = g->H[5 + NV * k];
    for (int k = 0; k < MASSLESS; ++k) g->H[5 + NV * k] = 0.0;
    g->f[5] = 0.0;
    g->M[5 + NV * 5] = 1.0;
    memset(q0, 0, sizeof q0);
    condense_dense(NV, MASSLESS, g->M, g->H, g->f, W0, q0);
    answer a = read_as(EXCHANGE_FCLIB);
    ck_assert_msg(a.st == OK, "%s", a.text);
    ck_assert(a.p->cp.floating);
    check_massless(a.p, W0, q0, h, f);
    for (int i = 0; i < NC; ++i)
      ck_assert_double_eq(a.p->cp.gap[i], g->w[3 * i]);
    memory_free(a.p);
  }
  leave();
}

/* The last entry of H comes in two halves: A = inv(H) M inv(H), M whole or a
 * triangle; H with an entry more is no diagonal: W = H' inv(M) H. */
TEST(entries_of_a_diagonal_given_twice_are_added) {
  const double f[] = {6.0, 20.0}, w[] = {0.25, 0.5}, mu[] = {0.3};
  enter();
  for (int k = 0; k < 4; ++k) {
    const double M[] = {8.0, k < 2 ? 2.0 : 0.0, k % 2 ? 0.0 : 2.0, 16.0};
    const double H[] = {2.0, 0.0, k == 3 ? 1.0 : 0.0, 4.0};
    const fclib_global_data g = {2, 1, 2, M, H, f, w, mu};
    fclib_global(path, STORE_TRIPLET, &g);
    answer a = read_as(EXCHANGE_FCLIB);
    ck_assert_msg(a.st == OK, "%s", a.text);
    ck_assert_int_eq(a.p->cp.A != NULL, k < 3);
    for (int i = 0; i < 4; ++i) {
      const double A[] = {2.0, -0.25, -0.25, 1.0};
      const double W[] = {0.5, -0.25, -0.25, 1.125};
      ck_assert_double_eq_tol((k < 3 ? a.p->cp.A : a.p->cp.W)[i],
                              (k < 3 ? A : W)[i], 1e-14);
    }
    ck_assert_double_eq_tol(a.p->cp.f[0], k < 3 ? -3.0 : -1.75, 1e-14);
    ck_assert_double_eq_tol(a.p->cp.f[1], k < 3 ? 5.0 : 6.25, 1e-14);
    memory_free(a.p);
  }
  leave();
}

TEST(no_contact_is_a_problem) {
  const double M[] = {2.0, 0.0, 0.0, 1.0}, f[] = {1.0, 1.0};
  const fclib_global_data g = {.dim = 2, .n_v = 2, .M = M, .f = f};
  enter();
  for (int k = 0; k < 6; ++k) {
    if (k < 3)
      fclib_local(path, stores[k], 3, 0, NULL, NULL, NULL);
    else
      fclib_global(path, stores[k - 3], &g);
    answer a = read_as(EXCHANGE_FCLIB);
    ck_assert_msg(a.st == OK, "%s", a.text);
    ck_assert_int_eq(a.p->m, 0);
    memory_free(a.p);
  }
  leave();
}

/* ---- defects ---- */

static void replace(const char *name, int real, int n, double value) {
  double x[16];
  int i[16];
  hid_t file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
  ck_assert(file >= 0);
  ck_assert_msg(H5Ldelete(file, name, H5P_DEFAULT) >= 0, "%s", name);
  for (int k = 0; k < 16; ++k) i[k] = (int)(x[k] = isfinite(value) ? value : 0);
  if (!isfinite(value)) x[n - 1] = value;
  if (n >= 0 && real) fclib_reals(file, name, n, x);
  if (n >= 0 && !real) fclib_ints(file, name, n, i);
  fclib_end(file);
}

/* n items "value" in the place of a dataset (the last one if it is not
 * finite); n = -1: taken away. */
static const struct defect {
  const char *name;
  int real, n;
  double value;
} defects[] = {{"spacedim", 0, -1, 0},
               {"spacedim", 0, 1, 4},
               {"spacedim", 0, 2, 2},
               {"spacedim", 1, 1, 2},
               {"W", 0, -1, 0},
               {"W", 1, 3, 0},
               {"W/m", 0, -1, 0},
               {"W/m", 0, 1, 3},
               {"W/m", 0, 1, -4},
               {"W/n", 0, 1, 6},
               {"W/n", 0, 1, 1000000000},
               {"W/nz", 0, 1, -3},
               {"W/nz", 0, 1, 100},
               {"W/nz", 0, 0, 0},
               {"W/p", 0, -1, 0},
               {"W/p", 0, 4, 0},
               {"W/p", 0, 5, 1},
               {"W/p", 1, 5, 0},
               {"W/i", 0, -1, 0},
               {"W/i", 0, 3, 0},
               {"W/i", 0, 16, 4},
               {"W/i", 0, 16, -1},
               {"W/x", 1, -1, 0},
               {"W/x", 1, 3, 0},
               {"W/x", 1, 16, NAN},
               {"W/x", 1, 16, HUGE_VAL},
               {"vectors/q", 1, -1, 0},
               {"vectors/q", 1, 3, 0},
               {"vectors/q", 1, 5, 0},
               {"vectors/q", 1, 4, NAN},
               {"vectors/q", 1, 4, -HUGE_VAL},
               {"vectors/mu", 1, -1, 0},
               {"vectors/mu", 1, 1, 0},
               {"vectors/mu", 1, 2, NAN},
               {"vectors/mu", 1, 2, -0.1},
               {"vectors", 0, -1, 0}};

TEST(defect_names_file_and_dataset) {
  unsigned long long seed = 5;
  double W[16], q[4] = {1, 2, 3, 4}, mu[2] = {0.1, 0.2};
  random_matrix(16, W, &seed);
  enter();
  for (size_t k = 0; k < sizeof defects / sizeof *defects; ++k) {
    const struct defect *d = &defects[k];
    fclib_local(path, STORE_ROWS, 2, 2, W, q, mu);
    PRINTED(name, "/fclib_local/%s", d->name);
    replace(name, d->real, d->n, d->value);
    answer a = read_as(EXCHANGE_FCLIB);
    ck_assert_msg(a.st == ERR_DECK, "%s, row %zu: %d", d->name, k, a.st);
    char *slash = strrchr(name, '/');
    if (strncmp(d->name, "W/", 2) == 0 || strcmp(d->name, "W") == 0) *slash = 0;
    ck_assert_msg(strstr(a.text, "problem.h5") != NULL &&
                      strstr(a.text, "/fclib_local") != NULL,
                  "%s: %s", name, a.text);
  }
  leave();
}

/* Indices of a matrix of triplets, which no line of "p" counts. */
TEST(defects_of_triplets_are_named) {
  static const struct {
    const char *item;
    int n, value;
    const char *told;
  } wrong[] = {{"p", 4, 0, "W/p has 4"},
               {"p", 5, 2, "W/p, item 0 = 2"},
               {"p", 5, -1, "W/p, item 0 = -1"},
               {"i", 4, 0, "W/i has 4"},
               {"i", 5, 2, "W/i, item 0 = 2"}};
  double W[4] = {2, 1, 1, 2}, q[2] = {1, 1}, mu[1] = {0.3};
  enter();
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) {
    fclib_local(path, STORE_TRIPLET, 2, 1, W, q, mu);
    PRINTED(name, "/fclib_local/W/%s", wrong[k].item);
    replace(name, 0, wrong[k].n, wrong[k].value);
    answer a = read_as(EXCHANGE_FCLIB);
    ck_assert_int_eq(a.st, ERR_DECK);
    ck_assert_msg(strstr(a.text, wrong[k].told) != NULL, "%s: %s", name,
                  a.text);
  }
  leave();
}

TEST(what_is_not_available_is_said) {
  static const char *const names[] = {"/fclib_local_rolling/spacedim",
                                      "/fclib_global_rolling/spacedim"};
  double W[4] = {1, 0, 0, 1}, q[2] = {1, 1}, mu[1] = {0.3};
  enter();
  for (size_t k = 0; k < sizeof names / sizeof *names; ++k) {
    fclib_local(path, STORE_ROWS, 2, 1, W, q, mu);
    hid_t file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
    fclib_int(file, names[k], 3);
    fclib_end(file);
    answer a = read_as(EXCHANGE_FCLIB);
    ck_assert_int_eq(a.st, ERR_DECK);
    ck_assert_ptr_nonnull(strstr(a.text, "not available"));
  }
  for (int k = 0; k < 3; ++k) {
    double half[4] = {1, k == 1, k == 2, 1};
    fclib_local(path, STORE_ROWS, 2, 1, half, q, mu);
    if (k == 0) replace("/fclib_local/spacedim", 0, 1, 3);
    answer a = read_as(EXCHANGE_FCLIB);
    ck_assert_int_eq(a.st, ERR_DECK);
    ck_assert_ptr_nonnull(strstr(a.text, k == 0 ? "no multiple" : "triangle"));
  }
  leave();
}

/* ---- equality constraints ---- */

enum { LINKS = 3 };

static hid_t reopen(void) { return H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT); }

/* u = W r + V l + q with the l that meets the constraints, for a given r, is
 * what the problem read says. */
static void check_links(const exchange_problem *p, int m, const double *W,
                        const double *q, const double *V, const double *l,
                        const double *r) {
  for (int i = 0; i < m; ++i) {
    double turn = i % p->dim == 0 ? -1.0 : 1.0;
    double want = q[i], got = p->cp.f[i];
    for (int j = 0; j < m; ++j) {
      want += W[i + m * j] * r[j];
      got += p->cp.W[i + m * j] * (j % p->dim == 0 ? -r[j] : r[j]);
    }
    for (int k = 0; k < LINKS; ++k) want += V[i + m * k] * l[k];
    ck_assert_double_eq_tol(turn * got, want, 1e-9);
  }
}

/* s from r and l. twice: the last constraint repeats the first. */
TEST(local_constraints_are_eliminated) {
  enter();
  for (int dim = 2; dim <= 3; ++dim)
    for (int twice = 0; twice <= 1; ++twice) {
      unsigned long long seed = 17;
      int n = 2, m = dim * n;
      double W[36], V[6 * LINKS], R[LINKS * LINKS], q[6], s[LINKS] = {0.0};
      double l[LINKS], r[6], mu[2] = {0.3, 0.4};
      random_spd(m, m, 1.0, W, &seed);
      random_spd(LINKS, LINKS, 1.0, R, &seed);
      random_matrix(m * LINKS, V, &seed);
      random_matrix(m, q, &seed);
      random_matrix(m, r, &seed);
      random_matrix(LINKS, l, &seed);
      R[1] += 0.25; /* not symmetric                                          */
      for (int k = 0; k < LINKS && twice; ++k) R[k + 2 * LINKS] = R[k];
      for (int k = 0; k < LINKS && twice; ++k) R[2 + LINKS * k] = R[LINKS * k];
      for (int i = 0; i < m && twice; ++i) V[i + 2 * m] = V[i];
      for (int k = 0; k < LINKS; ++k) {
        for (int i = 0; i < m; ++i) s[k] -= V[i + m * k] * r[i];
        for (int j = 0; j < LINKS; ++j) s[k] -= R[k + LINKS * j] * l[j];
      }
      fclib_local(path, stores[dim - 1], dim, n, W, q, mu);
      hid_t file = reopen();
      fclib_matrix(file, "/fclib_local/V", stores[dim - 2], m, LINKS, V);
      fclib_matrix(file, "/fclib_local/R", STORE_COLUMNS, LINKS, LINKS, R);
      fclib_reals(file, "/fclib_local/vectors/s", LINKS, s);
      fclib_end(file);
      answer a = read_as(EXCHANGE_FCLIB);
      ck_assert_msg(a.st == OK, "%s", a.text);
      ck_assert_int_eq(a.p->unknowns, m + LINKS);
      check_links(a.p, m, W, q, V, l, r);
      memory_free(a.p);
      if (!twice) continue;
      s[2] += 1.0;
      file = reopen();
      hid_t set = H5Dopen2(file, "/fclib_local/vectors/s", H5P_DEFAULT);
      H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, s);
      H5Dclose(set);
      fclib_end(file);
      a = read_as(EXCHANGE_FCLIB);
      ck_assert_int_eq(a.st, ERR_SINGULAR);
      ck_assert_ptr_nonnull(strstr(a.text, "contradict"));
    }
  leave();
}

/* v, r and l are planted: M v = H r + G l + f, G'v + b = 0, u = H'v + w. In
 * the second round one unknown has no mass: the constraints hold it. */
TEST(global_constraints_are_eliminated) {
  FREED global_case *g = malloc(sizeof *g);
  enter();
  for (int k = 0; k < 4; ++k) {
    unsigned long long seed = 23;
    const int dim = 2 + k % 2, m = dim * NC;
    double G[NV * LINKS], l[LINKS], r[3 * NC], b[LINKS] = {0.0}, v[NV];
    global_make(g, dim);
    for (int i = 0; i < NV && k > 1; ++i)
      g->M[i + NV * 5] = g->M[5 + NV * i] = 0.0;
    random_matrix(NV * LINKS, G, &seed);
    random_matrix(m, r, &seed);
    random_matrix(LINKS, l, &seed);
    random_matrix(NV, v, &seed);
    for (int i = 0; i < NV; ++i) {
      g->f[i] = 0.0;
      for (int j = 0; j < NV; ++j) g->f[i] += g->M[i + NV * j] * v[j];
      for (int j = 0; j < m; ++j) g->f[i] -= g->H[i + NV * j] * r[j];
      for (int j = 0; j < LINKS; ++j) {
        g->f[i] -= G[i + NV * j] * l[j];
        b[j] -= G[i + NV * j] * v[i];
      }
    }
    fclib_global(path, stores[dim - 1], &g->data);
    hid_t file = reopen();
    fclib_matrix(file, "/fclib_global/G", STORE_TRIPLET, NV, LINKS, G);
    fclib_reals(file, "/fclib_global/vectors/b", LINKS, b);
    fclib_end(file);
    answer a = read_as(EXCHANGE_FCLIB);
    ck_assert_msg(a.st == OK, "%s", a.text);
    ck_assert_int_eq(a.p->unknowns, NV + LINKS);
    for (int i = 0; i < m; ++i) {
      double want = g->w[i], got = a.p->cp.f[i];
      for (int j = 0; j < NV; ++j) want += g->H[j + NV * i] * v[j];
      for (int j = 0; j < m; ++j)
        got += a.p->cp.W[i + m * j] * (j % dim == 0 ? -r[j] : r[j]);
      ck_assert_double_eq_tol(i % dim == 0 ? -got : got, want, 1e-8);
    }
    memory_free(a.p);
  }
  leave();
}

/* Bytes of the problem file, as they stand. */
static char *bytes_of_file(size_t *size) {
  return folder_file(folder, "problem.h5", size);
}

static void write_bytes(const char *bytes, size_t n) {
  FILE *f = fopen(path, "wb");
  ck_assert_ptr_nonnull(f);
  ck_assert_uint_eq(fwrite(bytes, 1, n, f), n);
  fclose(f);
}

TEST(file_cut_short_is_refused) {
  double W[4] = {1, 0, 0, 1}, q[2] = {1, 1}, mu[1] = {0.3};
  size_t size = 0;
  enter();
  fclib_local(path, STORE_ROWS, 2, 1, W, q, mu);
  FREED char *bytes = bytes_of_file(&size);
  for (size_t n = 0; n < size; n += 97) {
    write_bytes(bytes, n);
    answer a = read_as(EXCHANGE_FCLIB);
    ck_assert_msg(a.st == ERR_FILE, "%zu of %zu bytes: %d", n, size, a.st);
    ck_assert_ptr_nonnull(strstr(a.text, "problem.h5"));
  }
  unlink(path);
  answer a = read_as(EXCHANGE_BY_CONTENT);
  ck_assert_int_eq(a.st, ERR_FILE);
  leave();
}

/* A gigabyte of numbers that nobody wrote: zeros as far as HDF5 is asked. */
TEST(numbers_that_are_not_in_the_file_are_refused) {
  double W[4] = {1, 0, 0, 1}, q[2] = {1, 1}, mu[1] = {0.3};
  const hsize_t n[1] = {(hsize_t)1 << 27};
  enter();
  fclib_local(path, STORE_ROWS, 2, 1, W, q, mu);
  replace("/fclib_local/W/x", 1, -1, 0);
  hid_t file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
  hid_t space = H5Screate_simple(1, n, NULL);
  hid_t set = H5Dcreate2(file, "/fclib_local/W/x", H5T_NATIVE_DOUBLE, space,
                         H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  ck_assert(set >= 0);
  H5Dclose(set);
  H5Sclose(space);
  H5Fclose(file);
  const size_t before = memory_allocated();
  answer a = read_as(EXCHANGE_FCLIB);
  ck_assert_int_eq(a.st, ERR_DECK);
  ck_assert_msg(strstr(a.text, "x has 134217728 items, and 0 bytes") != NULL,
                "%s", a.text);
  ck_assert_uint_lt(memory_allocated() - before, 1 << 20);
  leave();
}

/* ---- text ---- */

static answer read_text(const char *text) {
  write_bytes(text, strlen(text));
  return read_as(EXCHANGE_BY_CONTENT);
}

TEST(text_is_read_by_rows) {
  enter();
  answer a =
      read_text("\xEF\xBB\xBF# two unknowns\r\n2\n1, 2.5D0;-3 4e0 # M\n 5\n6");
  ck_assert_msg(a.st == OK, "%s", a.text);
  const double M[] = {1.0, -3.0, 2.5, 4.0};
  ck_assert_int_eq(a.p->dim, 1);
  ck_assert_mem_eq(a.p->matrix, M, sizeof M);
  ck_assert_double_eq(a.p->load[0], 5.0);
  ck_assert_double_eq(a.p->load[1], 6.0);
  memory_free(a.p);
  a = read_text("0\n");
  ck_assert_int_eq(a.st, OK);
  memory_free(a.p);
  leave();
}

TEST(defect_of_text_is_named) {
  static const char *const wrong[][2] = {{"", "number of unknowns"},
                                         {"x\n", "number of unknowns"},
                                         {"-1\n", "number of unknowns"},
                                         {"2.5\n", "number of unknowns"},
                                         {"99999999\n", "number of unknowns"},
                                         {"2\n1 2 3\n", "row 2"},
                                         {"2\n1 2 3 4\n5\n", "q, item 2"},
                                         {"1\n1 2 3\n", "follows"},
                                         {"1\nnan 2\n", "row 1"},
                                         {"1\n1\n\ninf\n", ":4: q, item 1"},
                                         {"1\n1 1e999\n", "q, item 1"},
                                         {"1\n1 2x\n", "q, item 1"},
                                         {"1\n1 -1-1\n", "q, item 1: a sum"},
                                         {"20000\n1 2\n", "4 characters"}};
  enter();
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) {
    answer a = read_text(wrong[k][0]);
    ck_assert_int_eq(a.st, ERR_DECK);
    ck_assert_msg(strstr(a.text, wrong[k][1]) != NULL, "%s", a.text);
    ck_assert_ptr_nonnull(strstr(a.text, "problem.h5"));
  }
  leave();
}

/* ---- memory ---- */

static void refuse_all(void) {
  const place at = {.file = "a.inp", .line_no = 1};
  OWNED message_log *log = NULL;
  ck_assert_int_eq(message_log_new(&log), OK);
  exchange_problem *p;
  UNIT_REFUSED(3, exchange_read(path, EXCHANGE_BY_CONTENT, &at, log, &p),
               ck_assert((p == NULL) == refused);
               memory_free(p));
}

TEST(every_refused_request_is_reported) {
  FREED global_case *g = malloc(sizeof *g);
  enter();
  global_make(g, 2);
  fclib_local(path, STORE_TRIPLET, 2, NC, g->W, g->q, g->mu);
  refuse_all();
  fclib_global(path, STORE_COLUMNS, &g->data);
  refuse_all();
  g->M[1] *= 1.1; /* the dense way */
  fclib_global(path, STORE_COLUMNS, &g->data);
  refuse_all();
  write_bytes("2 1 2 3 4 5 6", 13);
  refuse_all();
  leave();
}

UNIT_MAIN("exchange")
