/* src/fem: condensation against dense elimination, recovery, bits. */
#include "fem/fem.h"
#include "support/scene.h"
#include "support/unit.h"

#include <lapacke.h>

static scene *square(kinematics kin) {
  scene *s = scene_new(make_grid_2d((int[]){5, 4}, (double[]){1.5, 1}), kin, 7);
  scene_contact(s, "BOTTOM", (double[]){0, -1}, 0);
  return s;
}

static scene *plain_2d(void) {
  scene *s = square(PLANE_STRAIN);
  scene_fix(s, "TOP", 0);
  scene_fix(s, "TOP", 1);
  return s;
}

static scene *oblique_2d(void) {
  scene *s =
      scene_new(make_grid_2d((int[]){4, 6}, (double[]){1, 1}), AXISYMMETRIC, 3);
  scene_contact(s, "BOTTOM", (double[]){0.6, -0.8}, 0.3);
  scene_contact(s, "RIGHT", (double[]){0.8, 0.6}, 0);
  scene_fix(s, "TOP", 1);
  return s;
}

/* The foot of the symmetry line is a contact node held along x. */
static scene *held_2d(void) {
  scene *s = square(PLANE_STRESS);
  scene_fix(s, "LEFT", 0);
  scene_fix_node(s, s->m->n_node - 1, 1);
  s->surface.held[1] = 1;
  return s;
}

static scene *oblique_3d(void) {
  scene *s = scene_new(make_grid_3d((int[]){3, 2, 3}, (double[]){1, 1, 2}),
                       SOLID_3D, 5);
  scene_contact(s, "FRONT", (double[]){0, 0.6, -0.8}, 0.4);
  scene_contact(s, "LEFT", (double[]){-1, 0, 0}, 0);
  for (int c = 0; c < 3; ++c) scene_fix(s, "BACK", c);
  for (int q = 0; q < s->surface.n; ++q) {
    const double *n = s->surface.frame + 9 * q;
    if (n[2] == 0 && s->m->x[3 * s->surface.node_id[q] + 2] == 2)
      s->surface.held[3 * q + 1] = s->surface.held[3 * q + 2] = 1;
  }
  return s;
}

/* Contact on all nodes of a row of cells: nothing interior. */
static scene *all_contact(void) {
  scene *s = scene_new(make_grid_2d((int[]){4, 1}, (double[]){1, 0.3}),
                       PLANE_STRAIN, 1);
  scene_contact(s, "BODY", (double[]){0, -1}, 0);
  return s;
}

/* Contact nodes cut the body in two: the factor's trailing block has gaps. */
static scene *cut_by_contact(void) {
  scene *s =
      scene_new(make_grid_2d((int[]){6, 6}, (double[]){1, 1}), PLANE_STRAIN, 1);
  mesh_group *g = &s->m->group[0];
  g->n_node = 0;
  for (int i = 0; i < s->m->n_node; ++i)
    if (i % 7 == 3) g->node_id[g->n_node++] = i;
  scene_contact(s, "BODY", (double[]){0, -1}, 0);
  scene_fix(s, "LEFT", 0);
  scene_fix(s, "RIGHT", 1);
  return s;
}

/* A block on rollers that contact alone holds against the load. */
static scene *roller_2d(void) {
  scene *s = scene_new(make_grid_2d((int[]){5, 3}, (double[]){1, 0.5}),
                       PLANE_STRAIN, 1);
  scene_contact(s, "BOTTOM", (double[]){0, -1}, 0);
  scene_fix(s, "LEFT", 0);
  return s;
}

static scene *no_contact(void) {
  scene *s =
      scene_new(make_grid_2d((int[]){6, 6}, (double[]){1, 1}), PLANE_STRAIN, 1);
  scene_fix(s, "LEFT", 0);
  scene_fix(s, "LEFT", 1);
  return s;
}

static scene *(*const scenes[])(void) = {
    plain_2d,         oblique_2d,        held_2d,
    scene_two_bodies, scene_floating_3d, oblique_3d,
    all_contact,      cut_by_contact,    no_contact};
enum { SCENES = sizeof scenes / sizeof *scenes };

/* Those that stand without tangential contact. */
static scene *(*const frictionless[])(void) = {
    plain_2d, oblique_2d, held_2d, oblique_3d, cut_by_contact, roller_2d};
enum { FRICTIONLESS = sizeof frictionless / sizeof *frictionless };

/* Number i of the scenes, then of the frictionless ones whose tangents count
 * in the interior. */
static scene *take(int i) {
  if (i < SCENES) return scenes[i]();
  scene *s = frictionless[i - SCENES]();
  s->d.rows = 1;
  return s;
}

static int rows_of(const scene *s) {
  return s->d.rows > 0 ? s->d.rows : s->m->dim;
}

static int is_held(const scene *s, int row) {
  return s->surface.held[s->m->dim * (row / rows_of(s)) + row % rows_of(s)];
}

/* Lists of unknowns by their place in the dense matrix. */
typedef struct parts {
  int N, m, ni, nc;
  double *K;
  unsigned char *unknown;
  int *inner, *contact, *row; /* row: of A, for contact[] */
} parts;

static void *get(size_t n) { return calloc(n + 1, sizeof(double)); }

static parts split(const scene *s) {
  const int dim = s->m->dim, rows = rows_of(s);
  parts p = {.N = dim * s->m->n_node, .m = rows * s->surface.n};
  const size_t N = (size_t)p.N;
  p.K = get(N * N);
  p.unknown = get(N);
  p.inner = get(N);
  p.contact = get(N);
  p.row = get(N);
  FREED int *of = get(N);
  scene_dense(s, p.K);
  scene_unknowns(s, p.unknown);
  for (int q = 0; q < p.m; ++q)
    of[dim * s->surface.node_id[q / rows] + q % rows] = q + 1;
  for (int i = 0; i < p.N; ++i) {
    if (!p.unknown[i]) continue;
    if (of[i] == 0) {
      p.inner[p.ni++] = i;
    } else {
      p.row[p.nc] = of[i] - 1;
      p.contact[p.nc++] = i;
    }
  }
  return p;
}

static void release(parts *p) {
  free(p->K);
  free(p->unknown);
  free(p->inner);
  free(p->contact);
  free(p->row);
}

/* A[m*m] by dense elimination; rows of prescribed unknowns stay zero. */
static void naive_schur(const parts *p, double *A) {
  const size_t N = (size_t)p->N, ni = (size_t)p->ni, m = (size_t)p->m;
  FREED double *Kii = get(ni * ni), *Kic = get(ni * (size_t)p->nc);
  for (size_t j = 0; j < ni; ++j)
    for (size_t i = 0; i < ni; ++i)
      Kii[i + ni * j] = p->K[(size_t)p->inner[i] + N * (size_t)p->inner[j]];
  for (size_t j = 0; j < (size_t)p->nc; ++j)
    for (size_t i = 0; i < ni; ++i)
      Kic[i + ni * j] = p->K[(size_t)p->inner[i] + N * (size_t)p->contact[j]];
  if (ni > 0)
    ck_assert_int_eq(LAPACKE_dposv(LAPACK_COL_MAJOR, 'L', p->ni, p->nc, Kii,
                                   p->ni, Kic, p->ni),
                     0);
  for (int j = 0; j < p->nc; ++j)
    for (int i = 0; i < p->nc; ++i) {
      double v = p->K[(size_t)p->contact[i] + N * (size_t)p->contact[j]];
      for (size_t k = 0; k < ni; ++k)
        v -= p->K[(size_t)p->contact[i] + N * (size_t)p->inner[k]] *
             Kic[k + ni * (size_t)j];
      A[(size_t)p->row[i] + m * (size_t)p->row[j]] = v;
    }
}

static double largest(size_t n, const double *v) {
  double most = 0;
  for (size_t i = 0; i < n; ++i) most = fmax(most, fabs(v[i]));
  return most;
}

static void solve(const scene *s, stiffness **k, condensed **c) {
  ck_assert_int_eq(stiffness_assemble(&s->d, k), OK);
  ck_assert_msg(condense(*k, &s->d, c) == OK, "%s", status_message());
}

static void end(scene *s, stiffness *k, condensed *c) {
  condensed_free(c);
  memory_free(k);
  scene_free(s);
}

TESTS(condensed_matrix_is_the_schur_complement, SCENES + FRICTIONLESS) {
  scene *s = take(_i);
  stiffness *k;
  condensed *c;
  parts p = split(s);
  const size_t m = (size_t)p.m;
  FREED double *A = get(m * m);
  const double *B;
  naive_schur(&p, A);
  solve(s, &k, &c);
  B = condensed_matrix(c);
  const double scale = largest(m * m, A);
  for (size_t j = 0; j < m; ++j)
    for (size_t i = 0; i < m; ++i) {
      ck_assert(B[i + m * j] == B[j + m * i]);
      if (!is_held(s, (int)i) && !is_held(s, (int)j))
        ck_assert_double_eq_tol(B[i + m * j], A[i + m * j], 2e-14 * scale);
      else if (i != j)
        ck_assert(B[i + m * j] == 0);
      else
        ck_assert(B[i + m * j] > 0 && B[i + m * j] <= scale * (1 + 1e-12));
    }
  const condense_info info = condensed_info(c);
  ck_assert_int_eq((int)info.unknowns, p.ni + p.nc);
  /* Reals of the matrix and the factor, whose places take no more than they. */
  const double reals = (double)(m * m), factor = (double)info.factor_entries;
  ck_assert_double_ge((double)info.bytes, 8 * (reals + factor));
  ck_assert_double_le((double)info.bytes, 8 * (reals + 2 * factor));
  ck_assert_double_gt(condensed_condition(c), 1);
  release(&p);
  end(s, k, c);
}

/* Prescribed local components from the global ones, as fem.h defines them. */
static void local_prescribed(const scene *s, const double *ud, double *a) {
  const int dim = s->m->dim;
  for (int i = 0; i < dim * s->m->n_node; ++i) a[i] = s->fixed[i] ? ud[i] : 0;
  for (int q = 0; q < s->surface.n; ++q) {
    const int at = dim * s->surface.node_id[q];
    double v[3] = {0};
    for (int r = 0; r < dim; ++r)
      for (int t = 0; t < dim; ++t)
        if (s->fixed[at + t])
          v[r] += s->surface.frame[dim * (dim * q + r) + t] * ud[at + t];
    for (int r = 0; r < dim; ++r)
      a[at + r] = s->surface.held[dim * q + r] ? v[r] : 0;
  }
}

/* Contact nodes of v (global) in their frame; forces turn by the basis. */
static void to_local(const scene *s, int force, const double *v, double *a) {
  const int dim = s->m->dim;
  memcpy(a, v, (size_t)(dim * s->m->n_node) * sizeof *a);
  for (int q = 0; q < s->surface.n; ++q) {
    const int at = dim * s->surface.node_id[q];
    const double *T = (force ? s->surface.basis : s->surface.frame) +
                      dim * dim * q; /* columns of basis, rows of frame */
    for (int i = 0; i < dim; ++i) {
      a[at + i] = 0;
      for (int j = 0; j < dim; ++j) a[at + i] += T[dim * i + j] * v[at + j];
    }
  }
}

/* Row of A u_c - f_c over the contact unknowns that are not held. */
static double contact_force(const scene *s, const condensed *c, int row,
                            const double *uc, const double *fc) {
  const int m = rows_of(s) * s->surface.n;
  const double *A = condensed_matrix(c);
  double sum = -fc[row];
  for (int j = 0; j < m; ++j)
    if (!is_held(s, j)) sum += A[(size_t)row + (size_t)m * (size_t)j] * uc[j];
  return sum;
}

/*
 * For a load, prescribed displacements and any contact displacement u_c, the
 * recovered interior must be in equilibrium (rows of the dense matrix) and
 * A u_c - f_c must be the force of the contact rows; prescribed components
 * keep their value.
 */
TESTS(load_and_recovery_agree_with_dense_equilibrium, SCENES + FRICTIONLESS) {
  scene *s = take(_i);
  stiffness *k;
  condensed *c;
  parts p = split(s);
  const int dim = s->m->dim, rows = rows_of(s);
  const size_t N = (size_t)p.N, m = (size_t)p.m;
  unsigned seed = 5;
  double *F = get(N), *ud = get(N), *fc = get(m), *uc = get(m), *u = get(N);
  double *a = get(N), *f = get(N), *given = get(N);
  for (size_t i = 0; i < N; ++i) F[i] = scene_random(&seed);
  for (size_t i = 0; i < N; ++i) ud[i] = scene_random(&seed);
  for (size_t i = 0; i < m; ++i) uc[i] = scene_random(&seed);
  solve(s, &k, &c);
  ck_assert_int_eq(condense_load(c, F, ud, fc), OK);
  ck_assert_int_eq(condense_recover(c, uc, u), OK);
  to_local(s, 0, u, a);
  to_local(s, 1, F, f);
  local_prescribed(s, ud, given);
  const double tol = 1e-12 * largest(N * N, p.K);
  for (size_t i = 0; i < N; ++i) {
    if (!p.unknown[i]) ck_assert_double_eq_tol(a[i], given[i], 1e-14);
    f[i] = -f[i];
    for (size_t j = 0; j < N; ++j) f[i] += p.K[i + N * j] * a[j];
  }
  for (int q = 0; q < p.ni; ++q) ck_assert_double_eq_tol(f[p.inner[q]], 0, tol);
  for (int q = 0; q < p.nc; ++q) {
    ck_assert_double_eq_tol(a[p.contact[q]], uc[p.row[q]], 1e-14);
    ck_assert_double_eq_tol(contact_force(s, c, p.row[q], uc, fc),
                            f[p.contact[q]], tol);
  }
  for (int i = 0; i < p.m; ++i)
    if (is_held(s, i))
      ck_assert_double_eq_tol(
          fc[i] / condensed_matrix(c)[(size_t)i * (m + 1)],
          given[dim * s->surface.node_id[i / rows] + i % rows], 1e-14);
  double *all[] = {F, ud, fc, uc, u, a, f, given};
  for (size_t i = 0; i < sizeof all / sizeof *all; ++i) free(all[i]);
  release(&p);
  end(s, k, c);
}

TEST(floating_body_has_the_rigid_motions_as_null_space) {
  scene *s = scene_floating_3d();
  stiffness *k;
  condensed *c;
  solve(s, &k, &c);
  ck_assert_int_eq(condensed_floating(c), 1);
  const int n = s->surface.n;
  const size_t m = (size_t)(3 * n);
  const double *A = condensed_matrix(c);
  for (int mode = 0; mode < 6; ++mode) {
    FREED double *v = get(m);
    for (int q = 0; q < n; ++q) {
      const double *x = s->surface.x + 3 * q, *f = s->surface.frame + 9 * q;
      double u[3] = {0};
      if (mode < 3) {
        u[mode] = 1;
      } else {
        const int i = (mode + 1) % 3, j = (mode + 2) % 3;
        u[i] = -x[j];
        u[j] = x[i];
      }
      for (int r = 0; r < 3; ++r)
        for (int t = 0; t < 3; ++t) v[3 * q + r] += f[3 * r + t] * u[t];
    }
    for (size_t i = 0; i < m; ++i) {
      double sum = 0;
      for (size_t j = 0; j < m; ++j) sum += A[i + m * j] * v[j];
      ck_assert_double_eq_tol(sum, 0, 1e-13 * largest(m * m, A));
    }
  }
  end(s, k, c);
}

/* Smallest eigenvalue over the largest of the dense matrix of the unknowns,
 * scaled to a unit diagonal; inverted. */
static double dense_condition(const parts *p) {
  const int n = p->ni + p->nc;
  const size_t N = (size_t)p->N;
  FREED double *a = get((size_t)(n * n)), *w = get((size_t)n);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const size_t r =
          (size_t)(i < p->ni ? p->inner[i] : p->contact[i - p->ni]);
      const size_t c =
          (size_t)(j < p->ni ? p->inner[j] : p->contact[j - p->ni]);
      a[i + n * j] =
          p->K[r + N * c] / sqrt(p->K[r * (N + 1)] * p->K[c * (N + 1)]);
    }
  ck_assert_int_eq(LAPACKE_dsyev(LAPACK_COL_MAJOR, 'N', 'L', n, a, n, w), 0);
  return w[n - 1] / w[0];
}

static scene *sliver(void) {
  scene *s = no_contact();
  for (int i = 0; i < s->m->n_node; ++i) s->m->x[2 * i] *= 100;
  return s;
}

/* Two pins close together hold the whole body. */
static scene *weakly_held(void) {
  scene *s =
      scene_new(make_grid_2d((int[]){6, 6}, (double[]){1, 1}), PLANE_STRAIN, 1);
  for (int j = 0; j < 7; ++j) s->m->x[2 * (7 * j + 1)] = 1e-3;
  scene_fix_node(s, 0, 0);
  scene_fix_node(s, 0, 1);
  scene_fix_node(s, 1, 1);
  return s;
}

/* One node is free: the estimate is that of a matrix of two rows. */
static scene *one_node(void) {
  scene *s =
      scene_new(make_grid_2d((int[]){1, 1}, (double[]){1, 1}), PLANE_STRAIN, 1);
  for (int i = 0; i < 4; ++i)
    for (int c = 0; c < 2 && i != 1; ++c) scene_fix_node(s, i, c);
  return s;
}

TEST(condition_is_near_that_of_the_scaled_dense_matrix) {
  static scene *(*const make[])(void) = {plain_2d,   oblique_2d,     held_2d,
                                         oblique_3d, cut_by_contact, no_contact,
                                         sliver,     weakly_held,    one_node};
  for (size_t q = 0; q < sizeof make / sizeof *make; ++q) {
    scene *s = make[q]();
    stiffness *k;
    condensed *c;
    parts p = split(s);
    solve(s, &k, &c);
    const double exact = dense_condition(&p), found = condensed_condition(c);
    const int small = make[q] == one_node;
    ck_assert_msg(found > (small ? 0.95 : 0.3) * exact &&
                      found < (small ? 1.001 : 5) * exact,
                  "scene %zu: %g for %g", q, found, exact);
    /* Half an epsilon times the condition is lost. */
    ck_assert_double_eq_tol(condensed_digits(c) + log10(found), 53 * log10(2.0),
                            1e-10);
    release(&p);
    end(s, k, c);
  }
}

/* u for moduli and loads times 2^power. */
static double *scaled_solution(scene *(*make)(void), int power, double *A0) {
  scene *s = make();
  stiffness *k;
  condensed *c;
  const size_t N = (size_t)(s->m->dim * s->m->n_node);
  const size_t m = (size_t)(s->m->dim * s->surface.n);
  double *F = get(N), *ud = get(N), *fc = get(m), *u = get(N);
  unsigned seed = 3;
  for (int i = 0; i < 36; ++i) s->E[i] = ldexp(s->E[i], power);
  for (size_t i = 0; i < N; ++i) {
    F[i] = ldexp(scene_random(&seed), power);
    ud[i] = scene_random(&seed);
  }
  solve(s, &k, &c);
  ck_assert_int_eq(condense_load(c, F, ud, fc), OK);
  for (size_t i = 0; i < m; ++i) {
    fc[i] = ldexp(fc[i], -power);
    A0[i] = ldexp(condensed_matrix(c)[i * (m + 1)], -power);
  }
  ck_assert_int_eq(condense_recover(c, fc, u), OK);
  free(F);
  free(ud);
  free(fc);
  end(s, k, c);
  return u;
}

TESTS(power_of_two_in_the_moduli_leaves_every_bit, SCENES) {
  SCENE *s = scenes[_i]();
  const size_t N = (size_t)(s->m->dim * s->m->n_node);
  static const int power[] = {40, -40, 13, 1};
  double A[2][400];
  FREED double *u = scaled_solution(scenes[_i], 0, A[0]);
  for (int q = 0; q < 4; ++q) {
    FREED double *v = scaled_solution(scenes[_i], power[q], A[1]);
    ck_assert(memcmp(u, v, N * sizeof *u) == 0);
  }
}

/* The solver may do without a block: nothing differs then. */
TESTS(every_refused_request_is_survived, SCENES) {
  SCENE *s = scenes[_i]();
  const size_t n = 3 * (size_t)(s->m->dim * s->m->n_node) + 1;
  FREED double *whole = get(n), *work = get(n);
  long r = 0, made;
  ck_assert_int_eq(scene_whole_way(&s->d, whole, &whole[n - 1]), OK);
  const size_t before = memory_in_use();
  do {
    const long seen = memory_requests();
    memset(work, 0, n * sizeof *work);
    memory_refuse(r + 1, r % 2 == 0);
    status st = scene_whole_way(&s->d, work, &work[n - 1]);
    memory_refuse(0, 0);
    made = memory_requests() - seen;
    ck_assert_uint_eq(memory_in_use(), before);
    if (st == OK)
      ck_assert_mem_eq(work, whole, n * sizeof *work);
    else
      ck_assert_msg(st == ERR_MEMORY && made > r, "request %ld: %s: %s", r + 1,
                    status_name(st), status_message());
  } while (made > r++);
  ck_assert_int_gt(r, 50);
}

static void is_singular(scene *s, const char *part) {
  OWNED stiffness *k = NULL;
  condensed *c;
  ck_assert_int_eq(stiffness_assemble(&s->d, &k), OK);
  ck_assert_int_eq(condense(k, &s->d, &c), ERR_SINGULAR);
  ck_assert_ptr_null(c);
  ck_assert_msg(strstr(status_message(), part) != NULL, "%s", status_message());
  scene_free(s);
}

TEST(stiffness_that_is_not_definite_is_refused_with_its_place) {
  scene *s = no_contact();
  s->E[15] = -s->E[15];
  is_singular(s, "with node");
  s = plain_2d();
  s->E[0] = NAN;
  is_singular(s, "not a number");
  s = plain_2d();
  for (int i = 0; i < 16; ++i) s->E[i] = 0;
  is_singular(s, "zero");
}

UNIT_MAIN("condensation")
