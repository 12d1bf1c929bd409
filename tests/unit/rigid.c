/* src/fem/rigid.c and the refinement of condensation.c: bodies with a contrast
 * of moduli. Where contact alone holds them, no force for a rigid motion and
 * the resultants of the loads kept; solutions to rounding everywhere. */
#include "fem/fem.h"
#include "support/scene.h"
#include "support/stack.h"
#include "support/unit.h"

/* A scene of two moduli and the rigid motions that its supports leave. */
typedef struct layers {
  scene *s;
  double E[72], thickness[2];
  kinematics kin[2];
  int n_motion;
  void (*motion)(const double *x, int k, double *u);
  stack *blocks;       /* has s; NULL: one body */
  int set[STACK_MOST]; /* motions 3*set .. +2 move these blocks; -1: none do */
} layers;

static void plane_motion(const double *x, int k, double *u) {
  u[0] = k == 0 ? 1 : k == 2 ? -x[1] : 0;
  u[1] = k == 1 ? 1 : k == 2 ? x[0] : 0;
}

static void lift(const double *x, int k, double *u) {
  u[0] = 0;
  u[1] = 1;
}

/* Fourth: the upper square turns about the corner (1, 1). */
static void hinged_motion(const double *x, int k, double *u) {
  plane_motion(x, k, u);
  if (k == 3 && x[0] >= 1 && x[1] >= 1) {
    u[0] = -(x[1] - 1);
    u[1] = x[0] - 1;
  }
}

static void solid_motion(const double *x, int k, double *u) {
  for (int c = 0; c < 3; ++c) u[c] = k == c;
  if (k < 3) return;
  const int i = (k + 1) % 3, j = (k + 2) % 3;
  u[i] = -x[j];
  u[j] = x[i];
}

/* Young's modulus "contrast" in the part on the far side of the plane. */
static void two_moduli(layers *l, double contrast, const double *plane) {
  scene *s = l->s;
  const int dim = s->m->dim, ns = s->d.ns;
  for (int e = 0; e < s->m->n_elem; ++e) {
    double side = -plane[dim];
    for (int a = 0; a <= dim; ++a)
      for (int c = 0; c < dim; ++c)
        side += plane[c] * s->m->x[dim * s->m->elem[(dim + 1) * e + a] + c] /
                (dim + 1);
    s->section_id[e] = side > 0;
  }
  for (int i = 0; i < ns * ns; ++i) {
    l->E[i] = s->E[i];
    l->E[ns * ns + i] = contrast * s->E[i];
  }
  for (int i = 0; i < 2; ++i) {
    l->kin[i] = s->kin[0];
    l->thickness[i] = 1;
  }
  s->d.E = l->E;
  s->d.kin = l->kin;
  s->d.thickness = l->thickness;
}

static void column(layers *l, double contrast) {
  l->s =
      scene_new(make_grid_2d((int[]){7, 8}, (double[]){1, 1}), PLANE_STRAIN, 1);
  scene_fix(l->s, "LEFT", 0);
  scene_contact(l->s, "BOTTOM", (double[]){0, -1}, 0);
  l->s->surface.held[1] = 1;
  l->n_motion = 1;
  l->motion = lift;
  two_moduli(l, contrast, (double[]){0, 1, 0.5});
}

static void block(layers *l, double contrast) {
  l->s = scene_new(make_grid_2d((int[]){6, 5}, (double[]){1.3, 1}),
                   PLANE_STRESS, 3);
  scene_contact(l->s, "BOTTOM", (double[]){0.6, -0.8}, 0.3);
  l->n_motion = 3;
  l->motion = plane_motion;
  two_moduli(l, contrast, (double[]){0.3, 1, 0.6});
}

static void stiff_foot(layers *l, double contrast) {
  block(l, contrast);
  two_moduli(l, contrast, (double[]){0.3, -1, -0.6});
}

static void disc(layers *l, double contrast) {
  l->s =
      scene_new(make_grid_2d((int[]){6, 6}, (double[]){1, 1}), AXISYMMETRIC, 1);
  scene_fix(l->s, "LEFT", 0);
  scene_contact(l->s, "BOTTOM", (double[]){0, -1}, 0);
  l->s->surface.held[1] = 1;
  scene_contact(l->s, "RIGHT", (double[]){0.8, -0.6}, 0);
  l->n_motion = 1;
  l->motion = lift;
  two_moduli(l, contrast, (double[]){0, 1, 0.5});
}

static void hinged(layers *l, double contrast) {
  OWNED mesh *a = make_grid_2d((int[]){3, 3}, (double[]){1, 1});
  mesh *m = grid_join(a, a, (double[]){1, 1});
  const int contact[] = {0, 1, 2, 3, 17, 18, 19}; /* feet of both */
  for (int k = 3 * a->n_elem; k < 3 * m->n_elem; ++k)
    if (m->elem[k] == 16) m->elem[k] = 15;
  m->group[0].n_node = 7;
  memcpy(m->group[0].node_id, contact, sizeof contact);
  l->s = scene_new(m, PLANE_STRAIN, 1);
  scene_contact(l->s, "BODY", (double[]){0, -1}, 0);
  for (int c = 0; c < 2; ++c) scene_fix_node(l->s, 16, c); /* left over */
  l->n_motion = 4;
  l->motion = hinged_motion;
  two_moduli(l, contrast, (double[]){1, 1, 1.5});
}

/* Two contact nodes close together and far from the origin. */
static void small_foot(layers *l, double contrast) {
  mesh *m = make_grid_2d((int[]){5, 5}, (double[]){1, 1});
  for (int j = 0; j < 6; ++j) m->x[2 * (6 * j + 1)] = 1e-3;
  for (int i = 0; i < m->n_node; ++i) m->x[2 * i] += 1;
  m->group[0].n_node = 2;
  l->s = scene_new(m, PLANE_STRAIN, 1);
  scene_contact(l->s, "BODY", (double[]){0, -1}, 0);
  l->n_motion = 3;
  l->motion = plane_motion;
  two_moduli(l, contrast, (double[]){0, 1, 0.5});
}

/* A single contact node. */
static void one_foot(layers *l, double contrast) {
  mesh *m = make_grid_2d((int[]){5, 5}, (double[]){1, 1});
  m->group[0].n_node = 1;
  m->group[0].node_id[0] = 3;
  l->s = scene_new(m, PLANE_STRAIN, 1);
  for (int j = 0; j < 6; ++j) scene_fix_node(l->s, 6 * j, 0);
  scene_contact(l->s, "BODY", (double[]){0, -1}, 0);
  l->n_motion = 1;
  l->motion = lift;
  two_moduli(l, contrast, (double[]){0, 1, 0.5});
}

static void brick(layers *l, double contrast) {
  l->s = scene_new(make_grid_3d((int[]){3, 4, 4}, (double[]){1, 1.2, 2}),
                   SOLID_3D, 5);
  scene_contact(l->s, "FRONT", (double[]){0, 0.6, -0.8}, 0.4);
  l->n_motion = 6;
  l->motion = solid_motion;
  two_moduli(l, contrast, (double[]){0.2, 0, 1, 1});
}

/* About the edge x = 0, z = 2. */
static void swing(const double *x, int k, double *u) {
  u[0] = x[2] - 2;
  u[1] = 0;
  u[2] = -x[0];
}

/* Supports along an edge leave a turn about it. */
static void door(layers *l, double contrast) {
  brick(l, contrast);
  for (int i = 0; i < l->s->m->n_node; ++i)
    for (int c = 0; c < 3; ++c)
      if (l->s->m->x[3 * i] == 0 && l->s->m->x[3 * i + 2] == 2)
        scene_fix_node(l->s, i, c);
  l->n_motion = 1;
  l->motion = swing;
}

static void stacked(layers *l, const char *joints, const int *cells,
                    const int *set, double contrast) {
  l->blocks = stack_new(joints, cells, 0);
  l->s = l->blocks->s;
  memcpy(l->set, set, (size_t)l->blocks->n_block * sizeof *set);
  l->motion = plane_motion;
  l->n_motion = 0;
  for (int b = 0; b < l->blocks->n_block; ++b)
    if (3 * (set[b] + 1) > l->n_motion) l->n_motion = 3 * (set[b] + 1);
  if (set[0] < 0)
    for (int c = 0; c < 2; ++c) stack_fix(l->blocks, c);
  two_moduli(l, contrast, (double[]){0, 1, 1});
}

/* On a supported body, which is the master; the slave. */
static void upper_slave(layers *l, double contrast) {
  stacked(l, "-P", (int[]){3, 4}, (int[]){-1, 0}, contrast);
}

static void lower_slave(layers *l, double contrast) {
  stacked(l, "-M", (int[]){3, 4}, (int[]){-1, 0}, contrast);
}

/* A pair above a contact, another tied to it, a third on that. */
static void tower(layers *l, double contrast) {
  stacked(l, "OPTP", (int[]){3, 3, 2, 4}, (int[]){0, 1, 1, 2}, contrast);
}

/* A master of two slaves is between. */
static void sandwich(layers *l, double contrast) {
  stacked(l, "OMP", (int[]){4, 3, 5}, (int[]){0, 1, 2}, contrast);
}

/* A gap that varies: tied nodes follow a turn of the lower body, where they
 * are above it, by different displacements, which strain the upper one. */
static void gap_of_a_tie(layers *l, double contrast) {
  stacked(l, "OT", (int[]){3, 4}, (int[]){0, 0}, contrast);
  l->s->m->x[2 * l->blocks->first[1] + 1] += 1.0 / 16;
  l->n_motion = 2;
}

/* Each on an obstacle of its own. */
static void apart(layers *l, double contrast) {
  stacked(l, "OO", (int[]){3, 4}, (int[]){0, 1}, contrast);
}

static void (*const scenes[])(layers *, double) = {
    column,     block,    stiff_foot,   disc,        hinged,
    small_foot, one_foot, brick,        upper_slave, lower_slave,
    tower,      sandwich, gap_of_a_tie, apart,       door};
static const double contrasts[] = {1, 1e6, 1e8};
enum { SCENES = sizeof scenes / sizeof *scenes, CASES = 3 * SCENES };

static void *get(size_t n) { return calloc(n + 1, sizeof(double)); }

static void solve(const layers *l, stiffness **k, condensed **c) {
  ck_assert_int_eq(stiffness_assemble(&l->s->d, k), OK);
  ck_assert_msg(condense(*k, &l->s->d, c) == OK, "%s", status_message());
}

static void drop(layers *l) {
  if (l->blocks != NULL)
    stack_free(l->blocks);
  else
    scene_free(l->s);
}

static void end(layers *l, stiffness *k, condensed *c) {
  condensed_free(c);
  memory_free(k);
  drop(l);
}

/* Displacements of motion "mode": u[dim*n_node]. */
static void displace(const layers *l, int mode, double *u) {
  const mesh *m = l->s->m;
  for (int i = 0, b = 0; i < m->n_node; ++i) {
    while (l->blocks != NULL && i >= l->blocks->first[b + 1]) ++b;
    if (l->blocks == NULL || l->set[b] == mode / 3)
      l->motion(m->x + m->dim * i, l->blocks == NULL ? mode : mode % 3,
                u + m->dim * i);
  }
}

/* Contact components of motion "mode", 0 where held. */
static void contact_part(const layers *l, int mode, double *v) {
  const contact_surface *s = &l->s->surface;
  FREED double *u = get((size_t)(s->dim * l->s->m->n_node));
  displace(l, mode, u);
  surface_relative(s, u, v);
  for (int i = 0; i < s->dim * s->n; ++i)
    if (s->held[i]) v[i] = 0;
}

TESTS(rigid_motion_needs_no_force, CASES) {
  layers l = {0};
  stiffness *k;
  condensed *c;
  scenes[_i / 3](&l, contrasts[_i % 3]);
  solve(&l, &k, &c);
  const size_t m = (size_t)(l.s->m->dim * l.s->surface.n);
  const double *A = condensed_matrix(c), *kernel;
  FREED double *v = get(m);
  ck_assert_int_eq(condensed_kernel(c, &kernel), l.n_motion);
  for (int mode = 0; mode < l.n_motion; ++mode) {
    double worst = 0, most = 0, arm = 0;
    contact_part(&l, mode, v);
    for (size_t i = 0; i < m; ++i) {
      double sum = 0, size = 0;
      for (size_t j = 0; j < m; ++j) {
        ck_assert(A[i + m * j] == A[j + m * i]);
        sum += A[i + m * j] * v[j];
        size += fabs(A[i + m * j]);
      }
      worst = fmax(worst, fabs(sum));
      most = fmax(most, size);
      arm = fmax(arm, fabs(v[i]));
    }
    ck_assert_msg(worst <= 1e-15 * arm * most, "motion %d: %g", mode,
                  worst / (arm * most));
  }
  end(&l, k, c);
}

/* Resultants and moments of loads at all nodes, with prescribed displacements
 * that move nothing rigidly. */
TESTS(condensed_load_has_the_resultants_of_the_load, CASES) {
  layers l = {0};
  stiffness *k;
  condensed *c;
  scenes[_i / 3](&l, contrasts[_i % 3]);
  solve(&l, &k, &c);
  const int dim = l.s->m->dim;
  const size_t N = (size_t)(dim * l.s->m->n_node);
  const size_t m = (size_t)(dim * l.s->surface.n);
  FREED double *F = get(N), *ud = get(N), *u = get(N), *f = get(m), *v = get(m);
  unsigned seed = 11;
  for (size_t i = 0; i < N; ++i) F[i] = l.s->fixed[i] ? 0 : scene_random(&seed);
  for (size_t i = 0; i < N; ++i) ud[i] = scene_random(&seed);
  for (int held = 0; held < 2; ++held) {
    ck_assert_int_eq(condense_load(c, F, held ? ud : NULL, f), OK);
    for (int mode = 0; mode < l.n_motion; ++mode) {
      double given = 0, kept = 0, forces = 0, arm = 0;
      contact_part(&l, mode, v);
      for (size_t i = 0; i < m; ++i) {
        kept += v[i] * f[i];
        forces += fabs(f[i]);
        arm = fmax(arm, fabs(v[i]));
      }
      memset(u, 0, N * sizeof *u);
      displace(&l, mode, u);
      for (size_t i = 0; i < N; ++i) given += u[i] * F[i];
      ck_assert_msg(fabs(kept - given) <= 1e-15 * arm * forces,
                    "motion %d: %.17g for %.17g", mode, kept, given);
    }
  }
  end(&l, k, c);
}

/* Diagonal of A and f for lengths times 2^power, stiffness per length kept. */
static void scaled(void (*make)(layers *, double), int power, double *out) {
  layers l = {0};
  stiffness *k;
  condensed *c;
  make(&l, 1e6);
  const int dim = l.s->m->dim;
  const size_t N = (size_t)(dim * l.s->m->n_node);
  const size_t m = (size_t)(dim * l.s->surface.n);
  const int axisymmetric = l.s->kin[0] == AXISYMMETRIC;
  for (size_t i = 0; i < N; ++i) l.s->m->x[i] = ldexp(l.s->m->x[i], power);
  solve(&l, &k, &c);
  FREED double *F = get(N);
  unsigned seed = 2;
  for (size_t i = 0; i < N; ++i) F[i] = scene_random(&seed);
  ck_assert_int_eq(condense_load(c, F, NULL, out), OK);
  for (size_t i = 0; i < m * m; ++i)
    out[m + i] =
        ldexp(condensed_matrix(c)[i], -power * (axisymmetric + dim - 2));
  end(&l, k, c);
}

TESTS(power_of_two_in_the_lengths_leaves_every_bit, SCENES) {
  static const int power[] = {40, -13, 1};
  enum { ROOM = 60 * 61 };
  FREED double *a = get(ROOM), *b = get(ROOM);
  scaled(scenes[_i], 0, a);
  for (int q = 0; q < 3; ++q) {
    scaled(scenes[_i], power[q], b);
    ck_assert(memcmp(a, b, ROOM * sizeof *a) == 0);
  }
}

/* A motion that a support resists, however little, stays a force. */
TEST(supported_body_keeps_its_stiffness) {
  layers l = {0};
  stiffness *k;
  condensed *c;
  block(&l, 1e6);
  scene_fix_node(l.s, l.s->m->n_node - 1, 0);
  solve(&l, &k, &c);
  const size_t m = (size_t)(2 * l.s->surface.n);
  const double *A = condensed_matrix(c);
  FREED double *v = get(m);
  for (int mode = 0; mode < 3; ++mode) {
    double work = 0, size = 0;
    contact_part(&l, mode, v);
    for (size_t i = 0; i < m; ++i)
      for (size_t j = 0; j < m; ++j) {
        work += v[i] * A[i + m * j] * v[j];
        size += fabs(v[i] * A[i + m * j] * v[j]);
      }
    if (mode == 1)
      ck_assert_double_le(fabs(work), 1e-15 * size);
    else
      ck_assert_double_ge(work, 1e-4 * size);
  }
  end(&l, k, c);
}

/* No lateral contraction: uniform stress has a closed form. */
static scene *uniaxial(void) {
  char why[160];
  scene *s =
      scene_new(make_grid_2d((int[]){7, 8}, (double[]){1, 1}), PLANE_STRAIN, 1);
  elastic_matrix(ELASTIC_ISO, 2, (double[]){1, 0}, s->C, why, 160);
  elastic_reduce(s->C, PLANE_STRAIN, s->E);
  return s;
}

/* Weight of a node of a side cut in 7. */
static double share(const scene *s, int i) {
  const double x = s->m->x[2 * i];
  return x == 0 || x == 1 ? 1.0 / 14 : 1.0 / 7;
}

/* Unit pressure on a hard layer over a soft one that stands on contact nodes:
 * held at zero they carry it by their shares, u_y = -y below. */
TESTS(contrast_costs_no_digits_of_a_floating_column, 3) {
  layers l = {.s = uniaxial()};
  stiffness *k;
  condensed *c;
  scene *s = l.s;
  scene_fix(s, "LEFT", 0);
  scene_contact(s, "BOTTOM", (double[]){0, -1}, 0);
  s->surface.held[1] = 1;
  two_moduli(&l, contrasts[_i], (double[]){0, 1, 0.5});
  solve(&l, &k, &c);
  const int m = 2 * s->surface.n, n = s->m->n_node;
  FREED double *F = get(2 * (size_t)n), *f = get((size_t)m),
               *u = get(2 * (size_t)n);
  for (int i = n - 8; i < n; ++i) F[2 * i + 1] = -share(s, i);
  ck_assert_int_eq(condense_load(c, F, NULL, f), OK);
  for (int q = 0; q < m / 2; ++q)
    ck_assert_double_eq_tol(f[2 * q], share(s, s->surface.node_id[q]), 1e-14);
  memset(f, 0, (size_t)m * sizeof *f);
  ck_assert_int_eq(condense_recover(c, f, u), OK);
  for (int i = 0; i < n; ++i) {
    const double y = s->m->x[2 * i + 1];
    const double exact = y < 0.5 ? y : 0.5 + (y - 0.5) / contrasts[_i];
    ck_assert_double_eq_tol(u[2 * i], 0, 1e-13);
    ck_assert_double_eq_tol(u[2 * i + 1], -exact, 1e-13);
  }
  end(&l, k, c);
}

/* Condition for a contrast of 1e8; the upper or the lower half is hard. */
static double condition_of(const char *support, int hard_above,
                           double *digits) {
  layers l = {.s = uniaxial()};
  stiffness *k;
  condensed *c;
  for (int i = 0; i < 2; ++i) scene_fix(l.s, support, i);
  two_moduli(&l, 1e8,
             hard_above ? (double[]){0, 1, 0.5} : (double[]){0, -1, -0.5});
  solve(&l, &k, &c);
  const double condition = condensed_condition(c);
  *digits = condensed_digits(c);
  ck_assert(condensed_condition(c) == condition);
  end(&l, k, c);
  return condition;
}

/* A hard part on a soft one costs the digits of the contrast, a soft part on a
 * hard one none. */
TEST(condition_tells_where_contrast_costs_digits) {
  double digits;
  ck_assert_double_ge(condition_of("BOTTOM", 1, &digits), 1e9);
  ck_assert_double_le(digits, 7);
  ck_assert_double_ge(digits, 3);
  ck_assert_double_le(condition_of("TOP", 1, &digits), 1e4);
  ck_assert_double_ge(digits, 12);
  ck_assert_double_le(condition_of("BOTTOM", 0, &digits), 1e4);
}

TESTS(every_refused_request_is_survived, SCENES) {
  layers l = {0};
  scenes[_i](&l, 1e8);
  FREED double *work = get(3 * (size_t)(l.s->m->dim * l.s->m->n_node));
  const size_t before = memory_in_use();
  for (long r = 1;; ++r) {
    const long seen = memory_requests();
    memory_refuse(r, (int)(r % 2));
    const status st = scene_whole_way(&l.s->d, work, NULL);
    memory_refuse(0, 0);
    ck_assert_uint_eq(memory_in_use(), before);
    ck_assert_msg(st == OK || st == ERR_MEMORY, "request %ld: %s", r,
                  status_message());
    ck_assert_int_lt((int)r, 5000);
    if (memory_requests() - seen < r) break;
  }
  drop(&l);
}

UNIT_MAIN("rigid")
