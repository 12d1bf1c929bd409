/* src/fem/element.c: patch tests, forces, energy. */
#include "fem/fem.h"
#include "run/start/start.h"
#include "support/scene.h"
#include "support/unit.h"

static const kinematics all_kinematics[] = {PLANE_STRAIN, PLANE_STRESS,
                                            AXISYMMETRIC, SOLID_3D};

static int on_boundary(const mesh *m, int node, const double *length) {
  for (int c = 0; c < m->dim; ++c) {
    const double x = m->x[m->dim * node + c];
    if (x == (c == 0 ? 0.5 : 0) || x == length[c]) return 1;
  }
  return 0;
}

/* A box from x = 0.5 on, its interior nodes moved at random, fixed all round.
 */
static scene *patch(kinematics kin) {
  static const double length[] = {2.5, 1, 1.5};
  const double from_zero[] = {2, 1, 1.5};
  unsigned seed = 7;
  mesh *m = kin == SOLID_3D ? make_grid_3d((int[]){4, 3, 3}, from_zero)
                            : make_grid_2d((int[]){6, 5}, from_zero);
  scene *s = scene_new(m, kin, 3);
  for (int i = 0; i < m->n_node; ++i) {
    m->x[m->dim * i] += 0.5;
    const int fixed = on_boundary(m, i, length);
    for (int c = 0; c < m->dim; ++c)
      if (fixed)
        scene_fix_node(s, i, c);
      else
        m->x[m->dim * i + c] += 0.05 * scene_random(&seed);
  }
  return s;
}

static const double G[3][3] = {{.3, -.2, .5}, {.7, .4, -.6}, {.1, .9, -.8}};

/* Linear displacement; turned bodies u_r = a r, u_z = b z (the only uniform
 * stress in equilibrium). */
static void linear(const mesh *m, kinematics kin, int node, double *u) {
  const double *x = m->x + m->dim * node;
  for (int r = 0; r < m->dim; ++r) {
    u[r] = 0;
    for (int c = 0; c < m->dim; ++c)
      if (kin != AXISYMMETRIC || r == c) u[r] += G[r][c] * x[c];
  }
}

/* The strain of "linear": xx yy zz xy yz zx. */
static void linear_strain(kinematics kin, double *e) {
  const double solid[6] = {.3, .4, -.8, -.2 + .7, -.6 + .9, .1 + .5};
  memcpy(e, solid, sizeof solid);
  if (kin == SOLID_3D) return;
  e[2] = kin == PLANE_STRAIN ? 0 : kin == AXISYMMETRIC ? .3 : -0.3 / 0.7 * .7;
  if (kin == AXISYMMETRIC) e[3] = 0;
}

TESTS(patch_of_constant_strain_is_reproduced, 4) {
  const kinematics kin = all_kinematics[_i];
  SCENE *s = patch(kin);
  OWNED stiffness *k = NULL;
  condensed *c;
  const int dim = s->m->dim, ns = s->d.ns;
  const size_t N = (size_t)(dim * s->m->n_node);
  const size_t T = (size_t)(ns * s->m->n_elem);
  FREED double *F = calloc(N, sizeof *F), *u = calloc(N, sizeof *u);
  FREED double *exact = calloc(N, sizeof *exact);
  double *e = calloc(T, sizeof *e), *t = calloc(T, sizeof *t), strain[6];
  for (int i = 0; i < s->m->n_node; ++i) linear(s->m, kin, i, exact + dim * i);
  ck_assert_int_eq(stiffness_assemble(&s->d, &k), OK);
  ck_assert_int_eq(condense(k, &s->d, &c), OK);
  ck_assert_int_eq((int)condensed_info(c).contact_unknowns, 0);
  ck_assert_int_eq(condense_load(c, F, exact, NULL), OK);
  ck_assert_int_eq(condense_recover(c, NULL, u), OK);
  for (size_t i = 0; i < N; ++i) ck_assert_double_eq_tol(u[i], exact[i], 1e-12);
  domain_stress(&s->d, u, e, t);
  linear_strain(kin, strain);
  for (size_t i = 0; i < T; ++i) {
    const size_t row = i % (size_t)ns;
    double sigma = 0;
    ck_assert_double_eq_tol(e[i], strain[row], 1e-12);
    for (size_t q = 0; q < (size_t)ns; ++q)
      sigma += s->E[row + (size_t)ns * q] * strain[q];
    ck_assert_double_eq_tol(t[i], sigma, 1e-11);
    if (kin == PLANE_STRESS && row == 2) ck_assert(t[i] == 0);
  }
  /* No force inside: the uniform stress is in equilibrium. */
  domain_internal_force(&s->d, t, F);
  for (size_t i = 0; i < N; ++i)
    if (!s->fixed[i]) ck_assert_double_eq_tol(F[i], 0, 1e-12);
  /* A strain without stress in the last element: the whole strain stays. */
  const int last = s->m->n_elem - 1;
  const double e0[6] = {1e-3, 2e-3, 3e-3, 4e-3, 5e-3, 6e-3};
  s->d.eigen = &(eigenstrain){.n = 1, .elem_id = &last, .e0 = e0};
  domain_stress(&s->d, u, e, t);
  for (size_t i = T - (size_t)ns; i < T; ++i) {
    const size_t row = i % (size_t)ns;
    double sigma = 0;
    for (size_t q = 0; q < (size_t)ns; ++q)
      sigma += s->E[row + (size_t)ns * q] * (strain[q] - e0[q]);
    ck_assert_double_eq_tol(t[i], sigma, 1e-11);
    if (kin != PLANE_STRESS || row != 2)
      ck_assert_double_eq_tol(e[i], strain[row], 1e-12);
  }
  free(e);
  free(t);
  condensed_free(c);
}

static double det(double A[3][3]) {
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    sum += A[0][i] * (A[1][j] * A[2][k] - A[1][k] * A[2][j]);
  }
  return sum;
}

/* Half the size of the curl, of G (1.5, 0.4, 0.9). */
static double turned(kinematics kin) {
  if (kin == SOLID_3D) return sqrt(0.805);
  return kin == AXISYMMETRIC ? 0 : 0.45;
}

TESTS(deformation_is_that_of_the_gradient, 4) {
  const kinematics kin = all_kinematics[_i];
  SCENE *s = patch(kin);
  const int dim = s->m->dim;
  FREED double *u = calloc((size_t)(dim * s->m->n_node), sizeof *u);
  for (int sign = -1; sign <= 1; sign += 2) {
    deformation x;
    double A[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, e[6], square = 0;
    for (int i = 0; i < s->m->n_node; ++i) {
      linear(s->m, kin, i, u + dim * i);
      for (int c = 0; c < dim; ++c) u[dim * i + c] *= 2 * sign;
    }
    for (int r = 0; r < dim; ++r)
      for (int c = 0; c < dim; ++c)
        if (kin != AXISYMMETRIC || r == c) A[r][c] += 2 * sign * G[r][c];
    if (kin == AXISYMMETRIC) A[2][2] = A[0][0];
    linear_strain(kin, e);
    if (kin == PLANE_STRESS) e[2] = 0; /* of the elastic law alone */
    for (int k = 0; k < (dim == 3 ? 6 : 4); ++k)
      square += 4 * (k < 3 ? 1 : 0.5) * e[k] * e[k];
    domain_deformation(&s->d, u, &x);
    ck_assert_double_eq_tol(x.strain, sqrt(square), 1e-12);
    ck_assert_double_eq_tol(x.volume, fmin(1, det(A)), 1e-12);
    ck_assert_double_eq_tol(x.rotation, 2 * turned(kin), 1e-12);
  }
}

TESTS(differences_bound_the_gradient, 4) {
  SCENE *s = patch(all_kinematics[_i]);
  const int m = s->m->dim * s->m->n_node;
  double *u = calloc((size_t)m, sizeof *u), steepest = 0;
  deformation x;
  for (int own = 0; own < m; ++own) {
    for (int i = 0; i < m; ++i) u[i] = (i - own) % s->m->dim == 0 ? -1 : 0;
    u[own] = 1;
    domain_deformation(&s->d, u, &x);
    const double bound = x.gain * domain_spread(&s->d, u);
    ck_assert_double_le(hypot(x.strain, sqrt(2) * x.rotation), bound);
    steepest = fmax(steepest, x.strain / bound);
  }
  ck_assert_double_gt(steepest, 0.1);
  free(u);
}

TESTS(weights_add_up_to_the_volume, 4) {
  const kinematics kin = all_kinematics[_i];
  SCENE *s = patch(kin);
  double sum = 0;
  s->thickness[0] = kin == PLANE_STRAIN || kin == PLANE_STRESS ? 0.25 : 1;
  for (int e = 0; e < s->m->n_elem; ++e) sum += element_weight(&s->d, e);
  /* 2 x 1 plane; ring of radii 0.5 and 2.5, height 1; box 2 x 1 x 1.5. */
  const double volume = kin == SOLID_3D       ? 3
                        : kin == AXISYMMETRIC ? acos(-1) * (6.25 - 0.25)
                                              : 0.5;
  ck_assert_double_eq_tol(sum, volume, 1e-12 * volume);
}

TESTS(internal_force_is_stiffness_times_displacement, 4) {
  SCENE *s = patch(all_kinematics[_i]);
  const int dim = s->m->dim;
  const size_t N = (size_t)(dim * s->m->n_node);
  FREED double *K = calloc(N * N, sizeof *K), *u = calloc(N, sizeof *u);
  FREED double *t = calloc((size_t)(s->d.ns * s->m->n_elem), sizeof *t);
  double *F = calloc(N, sizeof *F), energy = 0, scale = 0;
  unsigned seed = 11;
  for (size_t i = 0; i < N; ++i) u[i] = scene_random(&seed);
  scene_dense(s, K);
  domain_stress(&s->d, u, NULL, t);
  domain_internal_force(&s->d, t, F);
  for (size_t i = 0; i < N; ++i) scale = fmax(scale, fabs(F[i]));
  for (size_t i = 0; i < N; ++i) {
    double sum = 0;
    for (size_t j = 0; j < N; ++j) sum += K[i + N * j] * u[j];
    ck_assert_double_eq_tol(F[i], sum, 1e-13 * scale);
    energy += 0.5 * u[i] * sum;
  }
  ck_assert_double_eq_tol(domain_strain_energy(&s->d, u), energy,
                          1e-13 * energy);
  free(F);
}

/* Hand-derived: triangle (1,0) (3,0) (1,2), centroid radius 5/3. */
TEST(strain_matrix_of_one_turned_triangle) {
  mesh *m = make_grid_2d((int[]){1, 1}, (double[]){1, 1});
  const double x[] = {1, 0, 3, 0, 1, 2, 3, 2};
  memcpy(m->x, x, sizeof x);
  memcpy(m->elem, (int[]){0, 1, 2}, 3 * sizeof(int));
  SCENE *s = scene_new(m, AXISYMMETRIC, 1);
  double B[4 * 6];
  const double h = 1.0 / 5; /* N / r_c */
  const double expected[4][6] = {{-.5, 0, .5, 0, 0, 0},
                                 {0, -.5, 0, 0, 0, .5},
                                 {h, 0, h, 0, h, 0},
                                 {-.5, -.5, 0, .5, .5, 0}};
  const double weight = element_strain(&s->d, 0, B);
  ck_assert_double_eq_tol(weight, 2 * acos(-1) * 5 / 3 * 2, 1e-13);
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 6; ++c)
      ck_assert_double_eq_tol(B[r + 4 * c], expected[r][c], 1e-15);
}

TEST(element_beyond_the_axis_is_refused_by_number) {
  scene *s = patch(AXISYMMETRIC);
  stiffness *k;
  s->m->x[0] = -0.25;
  ck_assert_int_eq(stiffness_assemble(&s->d, &k), ERR_MESH);
  ck_assert_ptr_null(k);
  ck_assert_ptr_nonnull(strstr(status_message(), "element 1: node 1"));
  scene_free(s);
  s = patch(PLANE_STRAIN);
  s->m->x[2] = s->m->x[0]; /* the first triangle collapses */
  ck_assert_int_eq(stiffness_assemble(&s->d, &k), ERR_MESH);
  ck_assert_ptr_nonnull(strstr(status_message(), "element 1"));
  scene_free(s);
}

/* The diagonal of the stiffness is the force at an unknown that moves alone. */
TESTS(diagonal_is_the_force_of_a_unit_motion, 4) {
  SCENE *s = patch(all_kinematics[_i]);
  const mesh *m = s->m;
  const size_t n_dof = (size_t)(m->dim * m->n_node);
  FREED double *u = calloc(n_dof, sizeof *u), *f = calloc(n_dof, sizeof *f),
               *diagonal = calloc(n_dof, sizeof *diagonal),
               *sigma = calloc((size_t)(s->d.ns * m->n_elem), sizeof *sigma);
  start_stiffness(&s->d, diagonal);
  for (size_t k = 0; k < n_dof; ++k) {
    u[k] = 1;
    domain_stress(&s->d, u, NULL, sigma);
    domain_internal_force(&s->d, sigma, f);
    ck_assert_double_eq_tol(diagonal[k] / f[k], 1, 1e-12);
    u[k] = 0;
  }
}

UNIT_MAIN("stress")
