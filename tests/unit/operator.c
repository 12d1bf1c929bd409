/* src/fem: the condensed stiffness as an operator, against its entries. */
#include "fem/element.h"
#include "fem/fem.h"
#include "support/scene.h"
#include "support/unit.h"

#include <lapacke.h>

static scene *plain_2d(void) {
  scene *s = scene_new(make_grid_2d((int[]){6, 4}, (double[]){1.5, 1}),
                       PLANE_STRAIN, 7);
  scene_contact(s, "BOTTOM", (double[]){0, -1}, 0);
  scene_fix(s, "TOP", 0);
  scene_fix(s, "TOP", 1);
  return s;
}

/* The foot of the symmetry line is a contact node held along x. */
static scene *held_2d(void) {
  scene *s = scene_new(make_grid_2d((int[]){5, 4}, (double[]){1.5, 1}),
                       PLANE_STRESS, 7);
  scene_contact(s, "BOTTOM", (double[]){0, -1}, 0);
  scene_fix(s, "LEFT", 0);
  scene_fix_node(s, s->m->n_node - 1, 1);
  s->surface.held[1] = 1;
  return s;
}

static scene *normals_only(void) {
  scene *s = plain_2d();
  s->d.rows = 1;
  return s;
}

static scene *oblique_3d(void) {
  scene *s = scene_new(make_grid_3d((int[]){3, 2, 3}, (double[]){1, 1, 2}),
                       SOLID_3D, 5);
  scene_contact(s, "FRONT", (double[]){0, 0.6, -0.8}, 0.4);
  for (int c = 0; c < 3; ++c) scene_fix(s, "BACK", c);
  return s;
}

static scene *(*const scenes[])(void) = {plain_2d,         held_2d,
                                         normals_only,     oblique_3d,
                                         scene_two_bodies, scene_floating_3d};
enum {
  SCENES = sizeof scenes / sizeof *scenes,
  FLOATING = SCENES - 1,
  HELD = SCENES - 2 /* those that supports hold */
};

/* A scene, its condensed matrix, and the same as an operator. */
typedef struct both {
  scene *s;
  stiffness *k;
  condensed *dense, *sparse;
  const contact_operator *op;
  const double *A; /* [m*m] */
  int m, dim;      /* dim: unknowns of a contact node */
  size_t n;        /* components of all nodes */
  double size;     /* largest entry of A */
} both;

static both both_new(int i) {
  both b = {.s = scenes[i]()};
  domain d = b.s->d;
  ck_assert_int_eq(stiffness_assemble(&d, &b.k), OK);
  ck_assert_int_eq(condense(b.k, &d, &b.dense), OK);
  d.sparse = 1;
  ck_assert_int_eq(condense(b.k, &d, &b.sparse), OK);
  b.op = condensed_operator(b.sparse);
  b.A = condensed_matrix(b.dense);
  ck_assert_ptr_nonnull(b.op);
  ck_assert_ptr_null(condensed_matrix(b.sparse));
  ck_assert_ptr_null(condensed_operator(b.dense));
  b.dim = d.rows > 0 ? d.rows : b.s->m->dim;
  b.m = b.dim * b.s->surface.n;
  b.n = (size_t)(b.s->m->dim * b.s->m->n_node);
  for (int q = 0; q < b.m * b.m; ++q) b.size = fmax(b.size, fabs(b.A[q]));
  return b;
}

static void both_free(both *b) {
  condensed_free(b->dense);
  condensed_free(b->sparse);
  memory_free(b->k);
  scene_free(b->s);
}

static double *get(size_t n) { return calloc(n + 1, sizeof(double)); }

static double *numbers(size_t n, unsigned seed) {
  double *v = get(n);
  for (size_t i = 0; i < n; ++i) v[i] = scene_random(&seed);
  return v;
}

static int is_held(const both *b, int row) {
  return b->s->surface.held[b->s->m->dim * (row / b->dim) + row % b->dim];
}

static void same(size_t n, const double *a, const double *b, double tol) {
  for (size_t i = 0; i < n; ++i) ck_assert_double_eq_tol(a[i], b[i], tol);
}

/* Columns of A; the magnitudes are not below the sum. */
TESTS(products_have_the_entries, SCENES) {
  both b = both_new(_i);
  const size_t m = (size_t)b.m;
  FREED double *e = get(m), *column = get(m), *again = get(m), *size = get(m);
  for (size_t j = 0; j < m; ++j) {
    e[j] = 1;
    b.op->apply(b.op->ctx, e, column, NULL);
    b.op->apply(b.op->ctx, e, again, size);
    for (size_t i = 0; i < m; ++i) {
      ck_assert(column[i] == again[i]);
      ck_assert_double_ge(size[i] * (1 + 1e-12) + 1e-12 * b.size,
                          fabs(column[i]));
      if (is_held(&b, (int)i) && i == j) continue; /* any stiffness */
      ck_assert_double_eq_tol(column[i], b.A[i + m * j], 1e-13 * b.size);
    }
    if (!is_held(&b, (int)j))
      ck_assert_double_ge(b.op->diagonal[j], b.A[j * (m + 1)] * (1 - 1e-12));
    e[j] = 0;
  }
  both_free(&b);
}

/* (A + added) x = b at the free rows, x given at the others, by LAPACK. */
static void dense_solve(const both *b, const unsigned char *known,
                        const double *added, const double *rhs, double *x) {
  const size_t m = (size_t)b->m, dim = (size_t)b->dim;
  FREED double *M = get(m * m), *y = get(m);
  for (size_t j = 0; j < m; ++j)
    for (size_t i = 0; i < m; ++i)
      if (!known[i] && !known[j]) M[i + m * j] = b->A[i + m * j];
  for (size_t i = 0; i < m; ++i) {
    for (size_t k = 0; k < dim; ++k) {
      const size_t j = i / dim * dim + k;
      if (!known[i] && !known[j]) M[i + m * j] += added[dim * i + k];
    }
    y[i] = rhs[i];
    for (size_t j = 0; j < m; ++j)
      if (known[j]) y[i] -= b->A[i + m * j] * x[j];
    if (!known[i]) continue;
    M[i * (m + 1)] = 1;
    y[i] = x[i];
  }
  ck_assert_int_eq(
      LAPACKE_dposv(LAPACK_COL_MAJOR, 'L', b->m, 1, M, b->m, y, b->m), 0);
  memcpy(x, y, m * sizeof *x);
}

/* Stiffness at the free tangents of each node. */
static void add_turning(const both *b, const unsigned char *known,
                        double *added) {
  const size_t m = (size_t)b->m, dim = (size_t)b->dim;
  for (size_t i = 0; i < m; i += dim)
    for (size_t r = 1; r < dim; ++r)
      for (size_t c = 1; c < dim; ++c)
        if (!known[i + r] && !known[i + c])
          added[dim * (i + r) + c] = b->size * (r == c ? 1.5 : 0.4);
}

/* Several guesses of the states, one after the other. */
TESTS(solves_under_known_rows_are_those_of_the_entries, SCENES) {
  both b = both_new(_i);
  const size_t m = (size_t)b.m, dim = (size_t)b.dim;
  FREED double *x = get(m), *y = get(m), *Ax = get(m), *added = get(dim * m);
  OWNED unsigned char *known = memory_new(m, 1);
  for (int k = 0; k < 4; ++k) {
    const int every = k == 0 ? 2 : k + 1; /* 2 twice: other "added" */
    unsigned seed = 11;
    FREED double *rhs = numbers(m, 7), *Ay = get(m);
    int singular = 1;
    for (size_t i = 0; i < m; ++i) {
      known[i] =
          (int)(i / dim) % every == 0 || i / dim == 2 || is_held(&b, (int)i);
      x[i] = y[i] = known[i] && !is_held(&b, (int)i) ? scene_random(&seed) : 0;
    }
    memset(added, 0, dim * m * sizeof *added);
    if (k > 0) add_turning(&b, known, added);
    const known_rows rows = {known, added};
    ck_assert_int_eq(b.op->set_rows(b.op->ctx, &rows, &singular), OK);
    ck_assert_int_eq(singular, 0);
    b.op->solve(b.op->ctx, rhs, x, Ax);
    dense_solve(&b, known, added, rhs, y);
    same(m, x, y, 1e-11);
    b.op->apply(b.op->ctx, y, Ay, NULL);
    same(m, Ax, Ay, 1e-11 * b.size);
  }
  both_free(&b);
}

/* Normals of some nodes known, and the tangents of others. */
static void some_rows(const both *b, int every, unsigned char *known) {
  for (int i = 0; i < b->m; ++i)
    known[i] = (i / b->dim + i % b->dim) % every == 0 || i / b->dim == 2 ||
               is_held(b, i);
}

/* A factor of which a part was made again, from one without known rows or with
 * others, and one made at once. */
TESTS(factors_made_in_part_have_the_bits_of_whole_ones, SCENES) {
  both a = both_new(_i), b = both_new(_i);
  const size_t m = (size_t)a.m, dim = (size_t)a.dim;
  double *rhs = numbers(m, 7), *added = get(dim * m), *x[2], *Ax[2];
  OWNED unsigned char *known = memory_new(m, 1);
  const known_rows rows = {known, added};
  int singular;
  for (int every = 4; every > 1; --every) {
    some_rows(&a, every, known);
    memset(added, 0, dim * m * sizeof *added);
    if (every % 2 == 0) add_turning(&a, known, added);
    ck_assert_int_eq(a.op->set_rows(a.op->ctx, &rows, &singular), OK);
  }
  ck_assert_int_eq(b.op->set_rows(b.op->ctx, &rows, &singular), OK);
  both *of[2] = {&a, &b};
  for (int k = 0; k < 2; ++k) {
    x[k] = get(m);
    Ax[k] = get(m);
    of[k]->op->solve(of[k]->op->ctx, rhs, x[k], Ax[k]);
  }
  ck_assert(memcmp(x[0], x[1], m * sizeof *rhs) == 0);
  ck_assert(memcmp(Ax[0], Ax[1], m * sizeof *rhs) == 0);
  for (int k = 0; k < 2; ++k) {
    free(x[k]);
    free(Ax[k]);
    both_free(of[k]);
  }
  free(rhs);
  free(added);
}

/* Of some nodes, to forces at others. */
TESTS(responses_are_those_of_solves, SCENES) {
  both b = both_new(_i);
  const size_t m = (size_t)b.m, dim = (size_t)b.dim;
  FREED double *rhs = numbers(m, 7), *x = get(m), *Ax = get(m), *part = get(m),
               *moved = get(m);
  OWNED unsigned char *known = memory_new(m, 1), *at = memory_new(m, 1);
  const known_rows rows = {known, NULL};
  int singular, all = 0;
  some_rows(&b, 3, known);
  ck_assert_int_eq(b.op->set_rows(b.op->ctx, &rows, &singular), OK);
  for (size_t i = 0; i < m; ++i) {
    at[i] = known[i] && !is_held(&b, (int)i) && i > m / 2;
    all += at[i];
    if (known[i] || i < m / 3) rhs[i] = 0;
  }
  ck_assert_int_gt(all, 0);
  b.op->set_response(b.op->ctx, at);
  b.op->response(b.op->ctx, rhs, moved, part);
  b.op->solve(b.op->ctx, rhs, x, Ax);
  for (size_t i = 0; i < m; ++i)
    for (size_t j = i / dim * dim; j < (i / dim + 1) * dim && at[i]; ++j) {
      if (is_held(&b, (int)j)) continue;
      ck_assert_double_eq_tol(part[j], Ax[j], 1e-12);
      ck_assert_double_eq_tol(moved[j], x[j], 1e-12);
    }
  both_free(&b);
}

/* With too few rows known the body may move: said, not solved. */
TEST(rows_that_leave_a_motion_are_singular) {
  both b = both_new(FLOATING);
  OWNED unsigned char *known = memory_new((size_t)b.m, 1);
  const known_rows rows = {known, NULL};
  int singular = 0;
  for (int i = 0; i < b.m; i += 3) known[i] = 1; /* all normals */
  ck_assert_int_eq(b.op->set_rows(b.op->ctx, &rows, &singular), OK);
  ck_assert_int_eq(singular, 1);
  for (int i = 1; i < b.m; i += 3) { /* and a node: turns about it */
    known[i] = known[i + 1] = 1;
    ck_assert_int_eq(b.op->set_rows(b.op->ctx, &rows, &singular), OK);
    ck_assert_int_eq(singular, 1);
    known[i] = known[i + 1] = 0;
  }
  known[1] = known[2] = known[b.m - 1] = known[b.m - 2] = 1;
  ck_assert_int_eq(b.op->set_rows(b.op->ctx, &rows, &singular), OK);
  ck_assert_int_eq(singular, 0);
  ck_assert_int_eq(b.op->n_kernel, 6);
  both_free(&b);
}

/* Loads, recovery, energies and errors by both. */
TESTS(loads_and_recovery_are_the_same, SCENES) {
  both b = both_new(_i);
  const size_t n = b.n, m = (size_t)b.m;
  FREED double *F = numbers(n, 3), *ud = numbers(n, 4), *uc = numbers(m, 5);
  double *f[2] = {get(m), get(m)}, *u[2] = {get(n), get(n)};
  condensed *c[2] = {b.dense, b.sparse};
  for (int k = 0; k < 2; ++k) {
    ck_assert_int_eq(condense_load(c[k], F, ud, f[k]), OK);
    ck_assert_int_eq(condense_recover(c[k], uc, u[k]), OK);
  }
  for (size_t i = 0; i < m; ++i)
    if (!is_held(&b, (int)i))
      ck_assert_double_eq_tol(f[0][i], f[1][i], 1e-12 * b.size);
  same(n, u[0], u[1], 1e-12);
  ck_assert_int_eq(condensed_floating(b.sparse), condensed_floating(b.dense));
  const double apart =
      condensed_condition(b.sparse) / condensed_condition(b.dense);
  ck_assert(apart > 0.3 && apart < 3);
  for (int k = 0; k < 2; ++k) {
    free(f[k]);
    free(u[k]);
  }
  both_free(&b);
}

/* The error w of a residual, where the supports stay in place: the forces of
 * its strains are "rest" inside, and its energy that of them. */
static void check_error(const both *b, const double *rest, const double *w,
                        double square) {
  const domain *d = &b->s->d;
  const int dim = b->s->m->dim;
  FREED double *none = get(b->n), *left = get(b->n);
  OWNED char *touches = memory_new(b->n, 1);
  double energy = 0;
  for (int i = 0; i < b->s->surface.n; ++i)
    touches[b->s->surface.node_id[i]] = 1;
  domain_residual(d, w, none, left);
  for (size_t q = 0; q < b->n; ++q) {
    energy -= left[q] * w[q];
    if (touches[q / dim]) continue;
    ck_assert_double_eq_tol(d->fixed[q] ? w[q] : -left[q],
                            d->fixed[q] ? 0 : rest[q], 1e-10);
  }
  ck_assert_double_eq_tol(square / energy, 1, 1e-10);
}

/* Of bodies that supports hold: inv(A) d, its energy, errors of a residual,
 * whatever was prescribed before. */
TESTS(energies_and_errors_are_the_same, HELD) {
  both b = both_new(_i);
  const size_t n = b.n, m = (size_t)b.m;
  double *rest = numbers(n, 3), *d = numbers(m, 5), square[2][3];
  double *u[2] = {get(m), get(m)}, *w[2] = {get(n), get(n)},
         *v[2] = {get(n), get(n)};
  FREED double *f = get(m);
  OWNED unsigned char *held = memory_new(m, 1);
  condensed *c[2] = {b.dense, b.sparse};
  for (size_t i = 0; i < m; ++i) {
    held[i] = i % 3 == 0 || is_held(&b, (int)i);
    if (is_held(&b, (int)i)) d[i] = 0;
  }
  for (int k = 0; k < 2; ++k) {
    ck_assert_int_eq(condensed_force_energy(c[k], d, &square[k][0]), OK);
    ck_assert_int_eq(condensed_untouched(c[k], d, u[k]), OK);
    ck_assert_int_eq(condense_load(c[k], rest, rest, f), OK);
    ck_assert_int_eq(condensed_misfit(c[k], rest, d, w[k], &square[k][1]), OK);
    ck_assert_int_eq(
        condensed_misfit_held(c[k], rest, d, held, v[k], &square[k][2]), OK);
  }
  same(m, u[0], u[1], 1e-11);
  same(n, w[0], w[1], 1e-11);
  same(n, v[0], v[1], 1e-11);
  check_error(&b, rest, w[0], square[0][1]);
  check_error(&b, rest, v[0], square[0][2]);
  for (int q = 0; q < 3; ++q)
    ck_assert_double_eq_tol(square[0][q] / square[1][q], 1, 1e-11);
  free(rest);
  free(d);
  for (int k = 0; k < 2; ++k) {
    free(u[k]);
    free(w[k]);
    free(v[k]);
  }
  both_free(&b);
}

/* Rows that supports hold are solved too, and count in the energy f'inv(A)f. */
TESTS(held_rows_are_solved, HELD) {
  both b = both_new(_i);
  const size_t m = (size_t)b.m;
  double energy, work = 0;
  FREED double *f = numbers(m, 5), *u = get(m);
  for (size_t i = 0; i < m; ++i) f[i] *= b.A[i * (m + 1)];
  ck_assert_int_eq(condensed_untouched(b.dense, f, u), OK);
  ck_assert_int_eq(condensed_force_energy(b.dense, f, &energy), OK);
  for (size_t i = 0; i < m; ++i) {
    double sum = 0;
    for (size_t j = 0; j < m; ++j) sum += b.A[i + m * j] * u[j];
    ck_assert_double_eq_tol(sum, f[i], 1e-10 * b.size);
    work += f[i] * u[i];
  }
  ck_assert_double_eq_tol(energy / work, 1, 1e-10);
  both_free(&b);
}

/* A power of two in the moduli leaves every bit of a solve. */
TEST(power_of_two_in_the_moduli_leaves_every_bit) {
  double *found[2] = {NULL, NULL};
  for (int k = 0; k < 2; ++k) {
    SCENE *s = oblique_3d();
    OWNED stiffness *K = NULL;
    condensed *c = NULL;
    int singular;
    for (int i = 0; i < 36; ++i) s->E[i] = ldexp(s->E[i], 40 * k);
    s->d.sparse = 1;
    ck_assert_int_eq(stiffness_assemble(&s->d, &K), OK);
    ck_assert_int_eq(condense(K, &s->d, &c), OK);
    const contact_operator *op = condensed_operator(c);
    const size_t m = (size_t)(3 * s->surface.n);
    OWNED unsigned char *known = memory_new(m, 1);
    const known_rows rows = {known, NULL};
    FREED double *rhs = numbers(m, 9), *Ax = get(m);
    known[0] = known[4] = 1;
    for (size_t i = 0; i < m; ++i) rhs[i] = ldexp(rhs[i], 40 * k);
    found[k] = get(m);
    ck_assert_int_eq(op->set_rows(op->ctx, &rows, &singular), OK);
    op->solve(op->ctx, rhs, found[k], Ax);
    if (k == 1) ck_assert(memcmp(found[0], found[1], m * sizeof *rhs) == 0);
    condensed_free(c);
  }
  free(found[0]);
  free(found[1]);
}

static status whole_way(const scene *s) {
  domain d = s->d;
  FREED double *work = get(3 * (size_t)(s->m->dim * s->m->n_node));
  d.sparse = 1;
  return scene_whole_way(&d, work, NULL);
}

/* The solver may do without a block: nothing differs then. */
TEST(every_refused_request_is_survived) {
  SCENE *s = oblique_3d();
  const size_t before = memory_in_use();
  long r = 0, made;
  do {
    const long seen = memory_requests();
    memory_refuse(r + 1, r % 2 == 0);
    const status st = whole_way(s);
    memory_refuse(0, 0);
    made = memory_requests() - seen;
    if (st != OK) ck_assert_int_eq(st, ERR_MEMORY);
    ck_assert_uint_eq(memory_in_use(), before);
  } while (made > r++);
  ck_assert_int_eq(whole_way(s), OK);
}

/* Both factors: of thin slabs, most of whose unknowns are in contact or only
 * their normal ones. */
TEST(interior_is_expected_without_the_contact) {
  for (int rows = 1; rows <= 3; rows += 2) {
    const double real = sizeof(double);
    SCENE *s = scene_new(make_grid_3d((int[]){14, 14, 2}, (double[]){7, 7, 1}),
                         SOLID_3D, 5);
    OWNED stiffness *k = NULL;
    condensed *c = NULL;
    whole_order order;
    scene_contact(s, "FRONT", (double[]){0, 0, -1}, 0);
    scene_contact(s, "BACK", (double[]){0, 0, 1}, 0);
    scene_fix(s, "LEFT", 0);
    scene_fix(s, "LEFT", 1);
    s->d.rows = rows;
    s->d.sparse = 1;
    ck_assert_int_eq(stiffness_assemble(&s->d, &k), OK);
    ck_assert_int_eq(stiffness_order(k, s->m->x, &order), OK);
    s->d.order = &order;
    ck_assert_int_eq(condense(k, &s->d, &c), OK);
    const condense_info info = condensed_info(c);
    const double second =
        (double)info.bytes - real * (double)info.factor_entries;
    ck_assert_double_le(real * order.interior_entries, 1.2 * second);
    ck_assert_double_ge(real * order.interior_entries, 0.6 * second);
    ck_assert_double_le(order.interior_entries,
                        (rows == 1 ? 0.9 : 0.7) * order.contact_entries);
    memory_free(order.node);
    condensed_free(c);
  }
}

UNIT_MAIN("operator")
