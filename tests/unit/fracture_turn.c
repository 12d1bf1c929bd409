/* src/fracture: bodies that turn, and the sides of a crack */
#include "fracture/parts.h"
#include "support/crack_fields.h"
#include "support/grid.h"
#include "support/inner_group.h"
#include "support/unit.h"

static const fracture_material steel = {1000, 0.3, 0};
static const double G = 1000 / 2.6;

/* 1: a side in the middle of the height, from "low" on to low + 0.5. */
static int in_middle(const mesh *m, const int *v, double low) {
  int all = 1;
  for (int i = 0; i < m->dim; ++i) {
    const double *x = m->x + m->dim * v[i];
    all &= fabs(x[m->dim - 1] - 0.5) < 1e-9 && x[0] > low - 1e-9 &&
           x[0] < low + 0.5 + 1e-9;
  }
  return all;
}

static int left(const mesh *m, const int *v) { return in_middle(m, v, 0); }

static int right(const mesh *m, const int *v) { return in_middle(m, v, 0.5); }

/* A field, or its mirror image in x = tip[0], on a body that turns; y and z as
 * in crack_field. */
typedef struct moved_field {
  tip_field tip;
  int mirrored;
  double turn[3]; /* axis and angle, - */
} moved_field;

static void moved_displacement(const void *field, const double *y, int side,
                               double *u) {
  const moved_field *f = field;
  const double *t = f->turn, sign = f->mirrored ? -1 : 1;
  const double x[3] = {f->tip.tip[0] + sign * (y[0] - f->tip.tip[0]), y[1],
                       y[2]};
  tip_displacement(&f->tip, x, side, u);
  u[0] = sign * u[0] + t[1] * y[2] - t[2] * y[1];
  u[1] += t[2] * y[0] - t[0] * y[2];
  u[2] += t[0] * y[1] - t[1] * y[0];
}

/* Nodes off their regular places, but those of the crack, the front and the
 * surface. */
static void shake(mesh *m, int n) {
  for (int i = 0; i < m->n_node; ++i)
    for (int c = 0; c < m->dim; ++c) {
      const double *x = m->x + m->dim * i;
      int inside = fabs(x[m->dim - 1] - 0.5) > 1e-9;
      for (int k = 0; k < m->dim; ++k) inside &= x[k] > 0.05 && x[k] < 0.95;
      if (inside) m->x[m->dim * i + c] += 0.2 / n * sin(7.0 * i + 3.0 * c);
    }
}

static void start_shaken(crack_scene *s, int dim, take_side *take) {
  const int n = dim == 2 ? 16 : 8;
  mesh *m = dim == 2 ? make_grid_2d((const int[]){n, n}, (const double[]){1, 1})
                     : make_grid_3d((const int[]){n, n, n},
                                    (const double[]){1, 1, 1});
  ck_assert_ptr_nonnull(m);
  add_side_group(m, "CRACK", take);
  shake(m, n);
  scene_start(s, m, 0.5, &steel, NULL);
}

static moved_field field_of(int dim) {
  return (moved_field){.tip = {.dim = dim,
                               .K = {1.0, 0.5, dim == 3 ? 0.3 : 0},
                               .kappa = 1.8,
                               .G = G,
                               .tip = {0.5, 0.5},
                               .stress = {-3, 1}}};
}

/* K is by_u'u + by_traction't. */
static void check_derivative(const crack_scene *s, int point, const double *K) {
  const fracture_body body = {s->m, 1, &s->crack, s->section, s->material};
  const fracture_state state = {s->u, s->sigma, s->traction, 0.5, NULL, NULL};
  OWNED fracture *f = NULL;
  ck_assert_int_eq(fracture_new(&body, &f), OK);
  for (int mode = 0; mode < s->m->dim; ++mode) {
    fracture_linear l;
    double sum = 0;
    ck_assert_int_eq(fracture_derive(f, &state, point, mode, &l), OK);
    for (int k = 0; k < s->m->dim * s->m->n_node; ++k)
      sum += l.by_u[k] * s->u[k] + l.by_traction[k] * s->traction[k];
    ck_assert_double_eq_tol(sum, K[mode], 1e-11);
    fracture_linear_free(&l);
  }
}

/* The same stresses in a body that is turned: the same K and J, with tractions
 * on the lips too, and the same derivative. */
TEST(factors_do_not_see_how_the_body_turns) {
  for (int dim = 2; dim <= 3; ++dim) {
    CRACK_SCENE s;
    moved_field f = field_of(dim);
    start_shaken(&s, dim, left);
    scene_load(&s, tip_traction, &f.tip);
    scene_move(&s, moved_displacement, &f);
    const answer still = ask(&s);
    for (int k = 0; k < 3; ++k)
      f.turn[k] = dim == 3 || k == 2 ? 0.1 * k + 0.1 : 0;
    scene_move(&s, moved_displacement, &f);
    answer a = ask(&s);
    for (int i = 0; i < a.n; ++i) {
      if (isnan(still.at[i].J)) continue;
      for (int k = 0; k < dim; ++k)
        ck_assert_double_eq_tol(a.at[i].K[k], still.at[i].K[k], 1e-10);
      ck_assert_double_eq_tol(a.at[i].J, still.at[i].J, 1e-10 * still.at[i].J);
      check_derivative(&s, i, a.at[i].K);
    }
    free(still.at);
    free(still.point);
    drop(&a);
  }
}

/* K_II > 0: the plus lip, which is above, moves ahead, wherever that is; in the
 * plane as in space. */
TEST(sliding_is_that_of_the_plus_lip) {
  for (int dim = 2; dim <= 3; ++dim)
    for (int mirrored = 0; mirrored < 2; ++mirrored) {
      CRACK_SCENE s;
      moved_field f = field_of(dim);
      f.tip.stress[0] = f.tip.stress[1] = f.tip.K[2] = 0;
      f.mirrored = mirrored;
      start_shaken(&s, dim, mirrored ? right : left);
      scene_move(&s, moved_displacement, &f);
      answer a = ask(&s);
      const int i = a.n / 2; /* the middle of a front */
      ck_assert_double_eq_tol(a.at[i].K[0], 1, 0.1);
      ck_assert_double_eq_tol(a.at[i].K[1], 0.5, 0.1);
      ck_assert_double_eq(a.point[i].frame[0], mirrored ? -1 : 1);
      ck_assert_double_eq(a.point[i].frame[3 + dim - 1], 1);
      drop(&a);
    }
}

UNIT_MAIN("fracture_turn")
