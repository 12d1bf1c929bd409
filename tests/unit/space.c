/*
 * src/accuracy/space.c: the estimate against the true error in the energy norm
 * for displacements that solve Navier's equation without body force: gradients
 * of harmonic functions, and bending of two layers. Prescribed all round, the
 * nodes inside moved at random.
 */
#include "accuracy/space.h"
#include "support/scene.h"
#include "support/unit.h"

/* Displacement and its gradient at a point: u[dim], G[3*3] row major. In
 * axisymmetry x = r, y = z and G[8] = u_r / r. */
typedef void field(const double *x, double *u, double *G);

/* grad of Re (x + i y)^3 / 3 */
static void plane_cubic(const double *x, double *u, double *G) {
  u[0] = x[0] * x[0] - x[1] * x[1];
  u[1] = -2 * x[0] * x[1];
  G[0] = 2 * x[0];
  G[1] = G[3] = -2 * x[1];
  G[4] = -2 * x[0];
}

/* grad of log r, away from the centre (Lame's cylinder) */
static void plane_log(const double *x, double *u, double *G) {
  const double a = x[0] + 0.3, b = x[1] + 0.4, q = a * a + b * b;
  u[0] = a / q;
  u[1] = b / q;
  G[0] = (b * b - a * a) / (q * q);
  G[1] = G[3] = -2 * a * b / (q * q);
  G[4] = -G[0];
}

/* grad of Re z^(3/2), a stress like r^(-1/2) at the corner */
static void plane_root(const double *x, double *u, double *G) {
  const double r = hypot(x[0], x[1]), t = atan2(x[1], x[0]);
  u[0] = 1.5 * sqrt(r) * cos(t / 2);
  u[1] = -1.5 * sqrt(r) * sin(t / 2);
  G[0] = 0.75 / sqrt(r) * cos(t / 2);
  G[1] = G[3] = 0.75 / sqrt(r) * sin(t / 2);
  G[4] = -G[0];
}

/* grad of z^3 - 3/2 z r^2 */
static void turned_cubic(const double *x, double *u, double *G) {
  u[0] = -3 * x[0] * x[1];
  u[1] = 3 * x[1] * x[1] - 1.5 * x[0] * x[0];
  G[0] = -3 * x[1];
  G[1] = G[3] = -3 * x[0];
  G[4] = 6 * x[1];
  G[8] = -3 * x[1];
}

/* Lame's long tube, inner radius TUBE */
static const double TUBE = 0.3;
static void tube(const double *x, double *u, double *G) {
  u[0] = 1 / x[0];
  u[1] = G[1] = G[3] = G[4] = 0;
  G[8] = 1 / (x[0] * x[0]);
  G[0] = -G[8];
}

/* grad of 1/R from a point of the axis outside */
static void turned_pole(const double *x, double *u, double *G) {
  const double z = x[1] + 0.6, q = x[0] * x[0] + z * z, c = q * sqrt(q);
  u[0] = -x[0] / c;
  u[1] = -z / c;
  G[0] = (3 * x[0] * x[0] / q - 1) / c;
  G[1] = G[3] = 3 * x[0] * z / q / c;
  G[4] = (3 * z * z / q - 1) / c;
  G[8] = -1 / c;
}

/* grad of x^3 - 3 x y^2 + 2 x y z + z^3 - 3 z y^2 */
static void solid_cubic(const double *x, double *u, double *G) {
  u[0] = 3 * x[0] * x[0] - 3 * x[1] * x[1] + 2 * x[1] * x[2];
  u[1] = -6 * x[0] * x[1] + 2 * x[0] * x[2] - 6 * x[2] * x[1];
  u[2] = 2 * x[0] * x[1] + 3 * x[2] * x[2] - 3 * x[1] * x[1];
  G[0] = 6 * x[0];
  G[1] = G[3] = -6 * x[1] + 2 * x[2];
  G[2] = G[6] = 2 * x[1];
  G[4] = -6 * x[0] - 6 * x[2];
  G[5] = G[7] = 2 * x[0] - 6 * x[1];
  G[8] = 6 * x[2];
}

/* grad of 1/R from a point outside */
static void solid_pole(const double *x, double *u, double *G) {
  const double p[3] = {x[0] + 0.6, x[1] + 0.5, x[2] + 0.7};
  const double q = p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
  for (int i = 0; i < 3; ++i) {
    u[i] = -p[i] / (q * sqrt(q));
    for (int j = 0; j < 3; ++j)
      G[3 * i + j] = (3 * p[i] * p[j] / q - (i == j ? 1 : 0)) / (q * sqrt(q));
  }
}

/* Bending of layers of any stiffness with nu = 0: s_xx = E x y alone. */
static void bending(const double *x, double *u, double *G) {
  const double y = x[1] - 0.5;
  u[0] = x[0] * y;
  u[1] = -0.5 * x[0] * x[0];
  G[0] = y;
  G[1] = x[0];
  G[3] = -x[0];
  G[4] = 0;
}

static void uniform(const double *x, double *u, double *G) {
  u[0] = 0.2 * x[0] + 0.1 * x[1];
  u[1] = 0.3 * x[0] - 0.4 * x[1];
  G[0] = 0.2;
  G[1] = 0.1;
  G[3] = 0.3;
  G[4] = -0.4;
}

typedef struct problem {
  const char *name;
  kinematics kin;
  field *exact;
  int layers; /* 1: the upper half 100 times stiffer, nu = 0                  */
  double low, high; /* of estimate over true error                           */
  double nu;
} problem;

/* clang-format off */
static const problem problems[] = {
  {"cubic, plane strain",  PLANE_STRAIN, plane_cubic,  0, 0.9, 1.1, 0.3},
  {"cubic, plane stress",  PLANE_STRESS, plane_cubic,  0, 0.9, 1.1, 0.3},
  {"Lame cylinder",        PLANE_STRAIN, plane_log,    0, 0.9, 1.1, 0.3},
  {"corner r^(-1/2)",      PLANE_STRAIN, plane_root,   0, 0.7, 1.5, 0.3},
  {"axisymmetric cubic",   AXISYMMETRIC, turned_cubic, 0, 0.8, 1.2, 0.3},
  {"axisymmetric pole",    AXISYMMETRIC, turned_pole,  0, 0.9, 1.1, 0.3},
  {"Lame tube, nu = 0.45", AXISYMMETRIC, tube,  0, 0.9, 1.1, 0.45},
  {"pole, nu = 0.45",  AXISYMMETRIC, turned_pole,  0, 0.9, 1.1, 0.45},
  {"solid cubic",          SOLID_3D,     solid_cubic,  0, 0.8, 1.2, 0.3},
  {"solid pole",           SOLID_3D,     solid_pole,   0, 0.7, 1.3, 0.3},
  {"two layers in bending", PLANE_STRESS, bending,     1, 0.9, 1.1, 0},
};
/* clang-format on */
enum { N_PROBLEM = sizeof problems / sizeof *problems };

static int inside(const mesh *m, int node, const double *length) {
  for (int c = 0; c < m->dim; ++c) {
    const double x = m->x[m->dim * node + c];
    if (x == 0 || x == length[c]) return 0;
  }
  return 1;
}

/* A box of n cells a side, its nodes inside moved; all round prescribed. */
static scene *box(kinematics kin, int n, int layers) {
  static const double length[] = {1, 1, 1};
  unsigned seed = 3;
  mesh *m = kin == SOLID_3D ? make_grid_3d((int[]){n, n, n}, length)
                            : make_grid_2d((int[]){n, n}, length);
  scene *s = scene_new(m, kin, 3);
  for (int i = 0; i < m->n_node; ++i)
    for (int c = 0; c < m->dim; ++c)
      if (!inside(m, i, length))
        scene_fix_node(s, i, c);
      else if (!layers)
        m->x[m->dim * i + c] += 0.15 / n * scene_random(&seed);
  return s;
}

/* Two sections with nu = 0, the upper half 100 times stiffer. */
static void make_layers(scene *s, double *E, double *C, kinematics *kin,
                        double *thickness) {
  char why[160];
  const mesh *m = s->m;
  for (int k = 0; k < 2; ++k) {
    ck_assert_ptr_null(elastic_matrix(
        ELASTIC_ISO, 2, (double[]){k == 0 ? 3 : 300, 0}, C + 36 * k, why, 160));
    elastic_reduce(C + 36 * k, s->kin[0], E + 16 * k);
    kin[k] = s->kin[0];
    thickness[k] = 1;
  }
  for (int e = 0; e < m->n_elem; ++e) {
    double y = 0;
    for (int a = 0; a < 3; ++a) y += m->x[2 * m->elem[3 * e + a] + 1] / 3;
    s->section_id[e] = y > 0.5;
  }
  s->d.E = E;
  s->d.C = C;
  s->d.kin = kin;
  s->d.thickness = thickness;
}

/* Exact stress at x: sigma[ns]; material by Hooke's law written out. */
static void exact_stress(const problem *p, const double *x, double *sigma) {
  double u[3], G[9] = {0};
  p->exact(x, u, G);
  const double E = p->layers && x[1] > 0.5 ? 300 : 3, nu = p->nu;
  const double mu = E / (2 * (1 + nu));
  double lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
  if (p->kin == PLANE_STRESS) lambda = 2 * lambda * mu / (lambda + 2 * mu);
  const double zz = p->kin == SOLID_3D || p->kin == AXISYMMETRIC ? G[8] : 0;
  const double trace = G[0] + G[4] + zz;
  sigma[0] = lambda * trace + 2 * mu * G[0];
  sigma[1] = lambda * trace + 2 * mu * G[4];
  sigma[2] = p->kin == PLANE_STRESS ? 0 : lambda * trace + 2 * mu * zz;
  sigma[3] = mu * (G[1] + G[3]);
  if (p->kin != SOLID_3D) return;
  sigma[4] = mu * (G[5] + G[7]);
  sigma[5] = mu * (G[2] + G[6]);
}

/* 2 x the density of elastic energy of a stress, Hooke's law inverted. */
static double density(const problem *p, double E, const double *t) {
  const double nu = p->nu;
  double sum = 0, shear = 0;
  for (int i = 0; i < 3; ++i) sum += t[i] * t[i];
  shear = t[3] * t[3];
  if (p->kin == SOLID_3D) shear += t[4] * t[4] + t[5] * t[5];
  const double mixed = t[0] * t[1] + t[1] * t[2] + t[2] * t[0];
  return (sum - 2 * nu * mixed + 2 * (1 + nu) * shear) / E;
}

/* What the hoop strain of u, varying in an axisymmetric element, has at x more
 * than at the centroid adds to the stress: Hooke's law. */
static void add_hoop(const problem *p, const mesh *m, int elem, const double *x,
                     const double *phi, const double *u, double *t) {
  const double nu = p->nu, mu = 3 / (2 * (1 + nu));
  const double lambda = 3 * nu / ((1 + nu) * (1 - 2 * nu));
  double at = 0, mean = 0, r = 0;
  for (int a = 0; a < 3; ++a) {
    at += phi[a] * u[2 * m->elem[3 * elem + a]];
    mean += u[2 * m->elem[3 * elem + a]] / 3;
    r += m->x[2 * m->elem[3 * elem + a]] / 3;
  }
  const double more = at / x[0] - mean / r;
  for (int i = 0; i < 3; ++i) t[i] += lambda * more + (i == 2) * 2 * mu * more;
}

/* Square of the true error, J, by four (3-D) or three points an element. */
static double true_error(const problem *p, const scene *s, const double *sigma,
                         const double *u) {
  const mesh *m = s->m;
  const int v = m->dim + 1;
  const double b = m->dim == 2 ? 1.0 / 6 : (5 - sqrt(5)) / 20;
  double total = 0;
  for (int e = 0; e < m->n_elem; ++e)
    for (int q = 0; q < v; ++q) {
      double x[3] = {0}, phi[4], exact[6], t[6] = {0}, share = 1;
      for (int a = 0; a < v; ++a) {
        phi[a] = a == q ? 1 - m->dim * b : b;
        for (int c = 0; c < m->dim; ++c)
          x[c] += phi[a] * m->x[m->dim * m->elem[v * e + a] + c];
      }
      exact_stress(p, x, exact);
      for (int i = 0; i < s->d.ns; ++i) t[i] = sigma[s->d.ns * e + i];
      if (p->kin == AXISYMMETRIC) {
        add_hoop(p, m, e, x, phi, u, t);
        share = 2 * M_PI * x[0] * mesh_elem_measure(m, e) /
                element_weight(&s->d, e);
      }
      for (int i = 0; i < s->d.ns; ++i) t[i] = exact[i] - t[i];
      total += share * element_weight(&s->d, e) / v *
               density(p, p->layers && x[1] > 0.5 ? 300 : 3, t);
    }
  return total;
}

/* Solve and estimate; effectivity, and what the caller wants to see. */
static double effectivity(const problem *p, int n, space_error *found) {
  double E[32], C[72], thickness[2];
  kinematics kin[2];
  scene *s = box(p->kin, n, p->layers);
  const mesh *m = s->m;
  const size_t N = (size_t)(m->dim * m->n_node);
  OWNED stiffness *k = NULL;
  condensed *c;
  OWNED space_recovery *recovery = NULL;
  double *F = calloc(N, sizeof *F), *u = calloc(N, sizeof *u), G[9] = {0};
  double *exact = calloc(N, sizeof *exact), sum = 0;
  FREED double *sigma = calloc((size_t)(s->d.ns * m->n_elem), sizeof *sigma);
  FREED double *eta = calloc((size_t)m->n_elem, sizeof *eta);
  if (p->layers) {
    make_layers(s, E, C, kin, thickness);
  } else {
    char why[160];
    ck_assert_ptr_null(elastic_matrix(ELASTIC_ISO, 2, (double[]){3, p->nu},
                                      s->C, why, sizeof why));
    elastic_reduce(s->C, p->kin, s->E);
  }
  for (int i = 0; i < m->n_node; ++i)
    if (p->exact == tube) s->m->x[2 * i] += TUBE;
  for (int i = 0; i < m->n_node; ++i)
    p->exact(m->x + m->dim * i, exact + m->dim * i, G);
  ck_assert_int_eq(stiffness_assemble(&s->d, &k), OK);
  ck_assert_int_eq(condense(k, &s->d, &c), OK);
  ck_assert_int_eq(condense_load(c, F, exact, NULL), OK);
  ck_assert_int_eq(condense_recover(c, NULL, u), OK);
  domain_stress(&s->d, u, NULL, sigma);
  ck_assert_int_eq(space_recovery_new(&s->d, &recovery), OK);
  ck_assert_int_eq(space_estimate(recovery, sigma, eta, found), OK);
  for (int e = 0; e < m->n_elem; ++e) sum += eta[e] * eta[e];
  ck_assert_double_eq_tol(sqrt(sum), found->error, 1e-12 * found->error);
  ck_assert_double_eq_tol(found->norm, sqrt(2 * domain_strain_energy(&s->d, u)),
                          1e-10 * found->norm);
  const double right = sqrt(true_error(p, s, sigma, u));
  condensed_free(c);
  scene_free(s);
  free(F);
  free(u);
  free(exact);
  return found->error / right;
}

TESTS(estimate_is_near_the_true_error, N_PROBLEM) {
  const problem *p = &problems[_i];
  space_error coarse, fine;
  const int n = p->kin == SOLID_3D ? 5 : 10;
  const double a = effectivity(p, n, &coarse);
  const double b = effectivity(p, 2 * n, &fine);
  printf("%-24s effectivity %.3f, %.3f; error %.2f %%, %.2f %%\n", p->name, a,
         b, 100 * coarse.relative, 100 * fine.relative);
  ck_assert_double_ge(b, p->low);
  ck_assert_double_le(b, p->high);
  ck_assert_double_ge(a, 0.7);
  ck_assert_double_le(a, 1.5);
}

TESTS(uniform_stress_has_no_error, 2) {
  const problem p = {
      "uniform", _i == 0 ? PLANE_STRAIN : PLANE_STRESS, uniform, 0, 0, 0, 0.3};
  space_error found;
  effectivity(&p, 6, &found);
  ck_assert_double_le(found.relative, 1e-12);
}

/* A linear stress is recovered at every node of any mesh, closed patch or open:
 * the estimate is the true error of the stress at the centroids. */
TESTS(linear_stress_is_recovered, 3) {
  const kinematics kin =
      (kinematics[]){PLANE_STRAIN, PLANE_STRESS, SOLID_3D}[_i];
  const problem p = {
      "linear", kin, kin == SOLID_3D ? solid_cubic : plane_cubic, 0, 0, 0, 0.3};
  SCENE *s = box(kin, 4, 0);
  const mesh *m = s->m;
  FREED double *sigma = calloc((size_t)(s->d.ns * m->n_elem), sizeof *sigma);
  OWNED space_recovery *recovery = NULL;
  space_error found;
  for (int e = 0; e < m->n_elem; ++e) {
    double x[3] = {0};
    for (int a = 0; a <= m->dim; ++a)
      for (int c = 0; c < m->dim; ++c)
        x[c] += m->x[m->dim * m->elem[(m->dim + 1) * e + a] + c] / (m->dim + 1);
    exact_stress(&p, x, sigma + s->d.ns * e);
  }
  ck_assert_int_eq(space_recovery_new(&s->d, &recovery), OK);
  ck_assert_int_eq(space_estimate(recovery, sigma, NULL, &found), OK);
  ck_assert_double_eq_tol(found.error / sqrt(true_error(&p, s, sigma, NULL)), 1,
                          1e-10);
}

/* Stresses of hoop strains alone, which jump from element to element, of a
 * material with three moduli. */
TEST(hoop_strains_have_no_error) {
  static const double length[] = {1, 1};
  static const double E[16] = {8, 1, 2, 0, 1, 7, 3, 0, 2, 3, 6, 0, 0, 0, 0, 1};
  unsigned seed = 7;
  SCENE *s = scene_new(make_grid_2d((int[]){4, 4}, length), AXISYMMETRIC, 3);
  FREED double *sigma = calloc((size_t)(4 * s->m->n_elem), sizeof *sigma);
  OWNED space_recovery *recovery = NULL;
  space_error found;
  s->d.E = E;
  for (int e = 0; e < s->m->n_elem; ++e) {
    const double hoop = scene_random(&seed);
    for (int i = 0; i < 4; ++i) sigma[4 * e + i] = E[8 + i] * hoop;
  }
  ck_assert_int_eq(space_recovery_new(&s->d, &recovery), OK);
  ck_assert_int_eq(space_estimate(recovery, sigma, NULL, &found), OK);
  ck_assert_double_gt(found.norm, 0.1);
  ck_assert_double_le(found.relative, 1e-7);
}

TEST(one_layer_of_elements_has_an_estimate) {
  static const double length[] = {4, 1};
  SCENE *s = scene_new(make_grid_2d((int[]){1, 1}, length), PLANE_STRAIN, 3);
  OWNED space_recovery *recovery = NULL;
  space_error found;
  const double sigma[8] = {1, 0, 0.3, 0, 3, 0, 0.9, 0};
  ck_assert_int_eq(space_recovery_new(&s->d, &recovery), OK);
  ck_assert_int_eq(space_estimate(recovery, sigma, NULL, &found), OK);
  /* Two triangles, mean (2, 0, .6, 0): d = (+-1, 0, +-.3, 0) everywhere. */
  const double square = 4 * (1 + 0.09 - 2 * 0.3 * 0.3) / 3;
  ck_assert_double_eq_tol(found.error, sqrt(square), 1e-12);
  /* moduli that follow the temperature: those of now count */
  double hot[16];
  for (int i = 0; i < 16; ++i) hot[i] = 4 * s->d.E[i];
  s->d.E = hot;
  ck_assert_int_eq(space_estimate(recovery, sigma, NULL, &found), OK);
  ck_assert_double_eq_tol(found.error, sqrt(square / 4), 1e-12);
}

/* As many elements as a linear stress has coefficients: their mean, not what
 * they would give exactly. dim + 1 elements of a box of edges 2, 1, ... */
TESTS(stresses_that_just_determine_a_fit_are_averaged, 2) {
  const int dim = 2 + _i;
  static const double length[] = {2, 1, 1};
  mesh *m = dim == 2 ? make_grid_2d((int[]){2, 1}, length)
                     : make_grid_3d((int[]){1, 1, 1}, length);
  SCENE *s = scene_new(m, dim == 2 ? PLANE_STRAIN : SOLID_3D, 3);
  OWNED space_recovery *recovery = NULL;
  space_error found;
  double sigma[24] = {0}, square = 0;
  m->n_elem = dim + 1;
  for (int e = 0; e < m->n_elem; ++e) {
    const double x = 2 * e - dim, volume = dim == 2 ? 0.5 : 2 / 6.0;
    sigma[s->d.ns * e] = x;
    if (dim == 2) sigma[s->d.ns * e + 2] = 0.3 * x;
    square += volume * x * x * (dim == 2 ? 1 - 0.3 * 0.3 : 1) / 3;
  }
  ck_assert_int_eq(space_recovery_new(&s->d, &recovery), OK);
  ck_assert_int_eq(space_estimate(recovery, sigma, NULL, &found), OK);
  ck_assert_double_eq_tol(found.error, sqrt(square), 1e-12);
}

/* Where fewer than nine elements are along an edge. */
TESTS(few_nodes_inside_are_told, 2) {
  for (int n = 8; n <= 10; n += 2) {
    SCENE *s = box(_i == 0 ? PLANE_STRAIN : SOLID_3D, n, 0);
    OWNED space_recovery *recovery = NULL;
    ck_assert_int_eq(space_recovery_new(&s->d, &recovery), OK);
    for (int again = 0; again < 2; ++again)
      ck_assert_double_eq_tol(space_depth(recovery), n, 1e-12 * n);
    ck_assert_int_eq(space_is_coarse(space_depth(recovery)), n < 9);
  }
}

static int shares_node(const mesh *m, int a, int b) {
  const int v = m->dim + 1;
  for (int i = 0; i < v; ++i)
    for (int k = 0; k < v; ++k)
      if (m->elem[v * a + i] == m->elem[v * b + k]) return 1;
  return 0;
}

/* Inside a body a node has the stress of the elements that meet there: one
 * element of another stress is an error of those it shares a node with. */
TESTS(inner_nodes_see_the_elements_that_meet_there, 2) {
  const int dim = 2 + _i;
  static const double length[] = {1, 1, 1};
  mesh *m = dim == 3 ? make_grid_3d((int[]){7, 7, 7}, length)
                     : make_grid_2d((int[]){7, 7}, length);
  SCENE *s = scene_new(m, dim == 3 ? SOLID_3D : PLANE_STRAIN, 3);
  FREED double *sigma = calloc((size_t)(s->d.ns * m->n_elem), sizeof *sigma);
  FREED double *eta = calloc((size_t)m->n_elem, sizeof *eta);
  const int other = m->n_elem / 2;
  OWNED space_recovery *recovery = NULL;
  space_error found;
  sigma[s->d.ns * other] = 1;
  ck_assert_int_eq(space_recovery_new(&s->d, &recovery), OK);
  ck_assert_int_eq(space_estimate(recovery, sigma, eta, &found), OK);
  for (int e = 0; e < m->n_elem; ++e)
    if (shares_node(m, e, other))
      ck_assert_double_gt(eta[e], 1e-6 * found.error);
    else
      ck_assert_double_le(eta[e], 1e-12 * found.error);
}

/* Stresses may jump from body to body: of other elasticity, thickness or kind.
 * Two halves of one stress each have no error then. */
TESTS(stress_jumps_between_unlike_sections, 4) {
  static const double length[] = {1, 1};
  SCENE *s = scene_new(make_grid_2d((int[]){4, 4}, length), PLANE_STRAIN, 3);
  double E[32], C[72], thickness[2] = {1, _i == 1 ? 2 : 1};
  kinematics kin[2] = {PLANE_STRAIN, _i == 2 ? PLANE_STRESS : PLANE_STRAIN};
  FREED double *sigma = calloc((size_t)(4 * s->m->n_elem), sizeof *sigma);
  OWNED space_recovery *recovery = NULL;
  space_error found;
  for (int k = 0; k < 2; ++k) {
    memcpy(C + 36 * k, s->C, 36 * sizeof *C);
    for (int i = 0; i < 16; ++i)
      E[16 * k + i] = s->E[i] * (k == 1 && _i == 3 ? 2 : 1);
  }
  s->d.E = E;
  s->d.C = C;
  s->d.kin = kin;
  s->d.thickness = thickness;
  for (int e = 0; e < s->m->n_elem; ++e) {
    double y = 0;
    for (int a = 0; a < 3; ++a) y += s->m->x[2 * s->m->elem[3 * e + a] + 1] / 3;
    s->section_id[e] = y > 0.5;
    sigma[4 * e] = 1 + (y > 0.5);
  }
  ck_assert_int_eq(space_recovery_new(&s->d, &recovery), OK);
  ck_assert_int_eq(space_estimate(recovery, sigma, NULL, &found), OK);
  if (_i == 0)
    ck_assert_double_gt(found.relative, 0.01);
  else
    ck_assert_double_le(found.relative, 1e-12);
}

/* Sections of one material, one of moduli that another one has, and elements
 * whose moduli follow their temperature are of the region of their material. */
TEST(regions_are_those_of_the_materials) {
  static const int origin[] = {0, 1, 2, 3, 2, 3, 1, 7},
                   wanted[] = {0, 0, 1, 2, 1, 2, 0, 1},
                   factor[] = {1, 1, 2, 1, 7, 8, 9, 2};
  enum { SECTIONS = sizeof origin / sizeof *origin };
  SCENE *s =
      scene_new(make_grid_2d((int[]){4, 4}, (double[]){1, 1}), PLANE_STRAIN, 3);
  double E[16 * SECTIONS], C[36 * SECTIONS], thickness[SECTIONS];
  kinematics kin[SECTIONS];
  OWNED space_recovery *recovery = NULL;
  for (int k = 0; k < SECTIONS; ++k) {
    kin[k] = PLANE_STRAIN;
    thickness[k] = origin[k] == 3 ? 2 : 1;
    memcpy(C + 36 * k, s->C, 36 * sizeof *C);
    for (int i = 0; i < 16; ++i) E[16 * k + i] = s->E[i] * factor[k];
  }
  s->d.E = E;
  s->d.C = C;
  s->d.kin = kin;
  s->d.thickness = thickness;
  s->d.origin = origin;
  for (int e = 0; e < s->m->n_elem; ++e) s->section_id[e] = e % SECTIONS;
  ck_assert_int_eq(space_recovery_new(&s->d, &recovery), OK);
  ck_assert_int_eq(space_regions(recovery), 3);
  for (int e = 0; e < s->m->n_elem; ++e)
    ck_assert_int_eq(space_region(recovery, e), wanted[e % SECTIONS]);
}

/* Even errors 4 times the target: an error eta r for each element, r = 1/4,
 * with the edge of a regular triangle of the same area. One element whose error
 * is large: sizes grow from there by no more than 0.4 of the distance. */
TEST(sizes_give_the_target_and_grow_slowly) {
  static const double length[] = {1, 1};
  OWNED mesh *m = make_grid_2d((int[]){8, 8}, length);
  FREED double *eta = calloc((size_t)m->n_elem, sizeof *eta);
  FREED double *size = calloc((size_t)m->n_node, sizeof *size);
  const double edge = sqrt(4 / sqrt(3.0) / 128);
  for (int e = 0; e < m->n_elem; ++e) eta[e] = 0.4 / sqrt(m->n_elem);
  space_sizes(m, eta, 0.1, size);
  for (int i = 0; i < m->n_node; ++i)
    ck_assert_double_eq_tol(size[i], edge / 4, 1e-12);
  for (int e = 0; e < m->n_elem; ++e) eta[e] = e == 71 ? 0.2 : 1e-6;
  space_sizes(m, eta, 0.1, size);
  double least = 1, most = 0;
  for (int e = 0; e < m->n_elem; ++e)
    for (int a = 0; a < 3; ++a) {
      const int i = m->elem[3 * e + a], k = m->elem[3 * e + (a + 1) % 3];
      const double d =
          hypot(m->x[2 * i] - m->x[2 * k], m->x[2 * i + 1] - m->x[2 * k + 1]);
      ck_assert_double_le(fabs(size[i] - size[k]), 0.4 * d + 1e-12);
      least = fmin(least, size[i]);
      most = fmax(most, size[i]);
    }
  ck_assert_double_gt(most, 1.9 * edge);
  ck_assert_double_lt(least, 0.6 * edge);
}

TEST(an_estimate_has_no_unit) {
  static const double length[] = {1, 1};
  SCENE *s = scene_new(make_grid_2d((int[]){4, 4}, length), PLANE_STRAIN, 3);
  const size_t T = (size_t)(4 * s->m->n_elem);
  FREED double *sigma = calloc(T, sizeof *sigma);
  unsigned seed = 5;
  space_recovery *recovery;
  space_error a, b;
  for (size_t i = 0; i < T; ++i) sigma[i] = scene_random(&seed);
  ck_assert_int_eq(space_recovery_new(&s->d, &recovery), OK);
  ck_assert_int_eq(space_estimate(recovery, sigma, NULL, &a), OK);
  memory_free(recovery);
  for (int i = 0; i < 2 * s->m->n_node; ++i) s->m->x[i] = ldexp(s->m->x[i], 30);
  for (int i = 0; i < 16; ++i) s->E[i] = ldexp(s->E[i], 40);
  for (size_t i = 0; i < T; ++i) sigma[i] = ldexp(sigma[i], -20);
  ck_assert_int_eq(space_recovery_new(&s->d, &recovery), OK);
  ck_assert_int_eq(space_estimate(recovery, sigma, NULL, &b), OK);
  ck_assert_double_eq(a.relative, b.relative);
  ck_assert_double_gt(a.relative, 0);
  memory_free(recovery);
}

UNIT_MAIN("space")
