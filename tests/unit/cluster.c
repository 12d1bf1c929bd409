/* src/fem/cluster and the averaged elements of src/fem. */
#include "fem/cluster/cluster.h"

#include "fem/fem.h"
#include "support/scene.h"
#include "support/unit.h"

#include <lapacke.h>

static const kinematics averaged_kinematics[] = {PLANE_STRAIN, AXISYMMETRIC,
                                                 SOLID_3D};
enum { KINDS = 3 };

static mesh *grid(kinematics kin, int n) {
  static const double unit[] = {1, 1, 1};
  return kin == SOLID_3D ? make_grid_3d((int[]){n, n, n}, unit)
                         : make_grid_2d((int[]){n, n}, unit);
}

static void set_nu(scene *s, double nu) {
  char why[160];
  ck_assert_ptr_null(
      elastic_matrix(ELASTIC_ISO, 2, (double[]){1, nu}, s->C, why, 160));
  elastic_reduce(s->C, s->kin[0], s->E);
}

/* A unit box from x = 0.5 on whose inner nodes are moved at random, of one
 * averaged section; "flows": the whole of its volume is averaged. */
static scene *averaged_box(kinematics kin, int n, double nu, int flows) {
  unsigned seed = 5;
  scene *s = scene_new(grid(kin, n), kin, 1);
  mesh *m = s->m;
  set_nu(s, nu);
  for (int i = 0; i < m->dim * m->n_node; ++i) {
    const double x = m->x[i];
    if (x > 0 && x < 1) m->x[i] += 0.2 / n * scene_random(&seed);
  }
  for (int i = 0; i < m->n_node; ++i) m->x[m->dim * i] += 0.5;
  const double share = cluster_share(s->d.ns, s->E, flows);
  const cluster_input in = {m, kin == AXISYMMETRIC, 1, s->section_id, &share};
  ck_assert_int_eq(cluster_new(&in, &s->d.cluster), OK);
  return s;
}

static void free_box(scene *s) {
  memory_free(s->d.cluster);
  scene_free(s);
}

/* 1 if the elements of a cluster hang together across faces. */
static int hangs_together(const mesh *m, const cluster_set *c, int k) {
  const int n = c->start[k + 1] - c->start[k], per = m->dim + 1;
  const int *elem = c->elem + c->start[k];
  int *reached = calloc((size_t)n, sizeof *reached), count = 1, grown = 1;
  reached[0] = 1;
  while (grown) {
    grown = 0;
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < n; ++b) {
        int common = 0;
        if (!reached[a] || reached[b]) continue;
        for (int p = 0; p < per * per; ++p)
          common += m->elem[per * elem[a] + p / per] ==
                    m->elem[per * elem[b] + p % per];
        if (common < m->dim) continue;
        reached[b] = grown = 1;
        ++count;
      }
  }
  free(reached);
  return count == n;
}

/* Sections are strips, or scattered elements that touch at their corners. */
TESTS(clusters_part_their_sections_and_hang_together, 2 * KINDS) {
  const kinematics kin = averaged_kinematics[_i / 2];
  SCENE *s = scene_new(grid(kin, 6), kin, 1);
  const mesh *m = s->m;
  const double share[] = {1, 0, 0.5};
  const int per = m->dim + 1;
  OWNED cluster_set *c = NULL;
  for (int e = 0; e < m->n_elem; ++e) {
    const double x = m->x[m->dim * m->elem[per * e]];
    s->section_id[e] = _i % 2 ? e % 3 : x < 0.3 ? 0 : x < 0.6 ? 1 : 2;
  }
  const cluster_input in = {m, 0, 3, s->section_id, share};
  ck_assert_int_eq(cluster_new(&in, &c), OK);
  for (int e = 0; e < m->n_elem; ++e)
    ck_assert_int_eq(c->of[e] >= 0, share[s->section_id[e]] > 0);
  for (int k = 0; k < c->n; ++k) {
    const int section = s->section_id[c->elem[c->start[k]]];
    double weight = 0;
    ck_assert_int_gt(c->start[k + 1], c->start[k]);
    for (int q = c->start[k]; q < c->start[k + 1]; ++q) {
      ck_assert_int_eq(c->of[c->elem[q]], k);
      ck_assert_int_eq(s->section_id[c->elem[q]], section);
      weight += c->weight[c->elem[q]];
    }
    ck_assert_double_eq_tol(weight, 1, 1e-14);
    ck_assert_double_eq(c->share[k], share[section]);
    for (int i = c->first[k]; i < c->first[k + 1]; ++i) /* each of them once */
      for (int j = c->first[k]; j < i; ++j)
        ck_assert_int_ne(c->node[i], c->node[j]);
    ck_assert(_i % 2 || hangs_together(m, c, k));
  }
}

TEST(no_clusters_where_the_option_does_nothing) {
  SCENE *s = scene_new(grid(PLANE_STRAIN, 2), PLANE_STRAIN, 1);
  cluster_set *c = (cluster_set *)s;
  set_nu(s, 0.39);
  const double share = cluster_share(4, s->E, 0);
  const cluster_input in = {s->m, 0, 1, s->section_id, &share};
  ck_assert(share == 0);
  ck_assert_int_eq(cluster_new(&in, &c), OK);
  ck_assert_ptr_null(c);
  set_nu(s, 0.4999);
  /* (1 - share)^2 K = 14/3 G with K/G = 2 (1 + nu)/(3 (1 - 2 nu)). */
  const double kept = 1 - cluster_share(4, s->E, 0);
  ck_assert_double_eq_tol(kept * kept * 2 * 1.4999 / (3 * 0.0002), 14.0 / 3,
                          1e-9);
  ck_assert(cluster_share(4, s->E, 1) == 1);
}

/* Displacements and forces of a domain. */
typedef struct solved {
  size_t n;
  double *u, *F, *rest, *sigma;
} solved;

static solved solved_new(const scene *s) {
  solved v = {.n = (size_t)(s->m->dim * s->m->n_node)};
  v.u = calloc(v.n, sizeof *v.u);
  v.F = calloc(v.n, sizeof *v.F);
  v.rest = calloc(v.n, sizeof *v.rest);
  v.sigma = calloc((size_t)(s->d.ns * s->m->n_elem), sizeof *v.sigma);
  return v;
}

static void solved_free(solved *v) {
  free(v->u);
  free(v->F);
  free(v->rest);
  free(v->sigma);
}

static void solve(scene *s, solved *v, const double *ud) {
  OWNED stiffness *k = NULL;
  condensed *c;
  ck_assert_int_eq(stiffness_assemble(&s->d, &k), OK);
  ck_assert_int_eq(condense(k, &s->d, &c), OK);
  ck_assert_int_eq(condense_load(c, v->F, ud, NULL), OK);
  ck_assert_int_eq(condense_recover(c, NULL, v->u), OK);
  condensed_free(c);
}

static void fix_all_round(scene *s) {
  static const char *const side[] = {"LEFT", "RIGHT", "BOTTOM",
                                     "TOP",  "FRONT", "BACK"};
  for (int k = 0; k < 2 * s->m->dim; ++k)
    for (int c = 0; c < s->m->dim; ++c) scene_fix(s, side[k], c);
}

/* Clusters couple so many nodes that the lists of a mesh grow. */
TESTS(every_refused_request_of_the_stiffness_is_told, KINDS) {
  scene *s = averaged_box(averaged_kinematics[_i], 6, 0.3, 1);
  stiffness *k;
  UNIT_REFUSED(0, stiffness_assemble(&s->d, &k), memory_free(k));
  free_box(s);
}

TESTS(uniform_strain_is_reproduced_at_4999, 2 * KINDS) {
  const kinematics kin = averaged_kinematics[_i / 2];
  scene *s = averaged_box(kin, 5, 0.4999, _i % 2);
  const int dim = s->m->dim;
  solved v = solved_new(s);
  FREED double *exact = calloc(v.n, sizeof *exact);
  for (size_t i = 0; i < v.n; ++i) { /* u_i = a_i x_i, sheared in x1 x2 */
    const double *x = s->m->x + (size_t)dim * (i / (size_t)dim);
    const size_t c = i % (size_t)dim;
    exact[i] = (c == 1 ? -0.7 : 0.3) * x[c];
    if (kin != AXISYMMETRIC && c == 0) exact[i] += 0.4 * x[1];
  }
  fix_all_round(s);
  solve(s, &v, exact);
  for (size_t i = 0; i < v.n; ++i)
    ck_assert_double_eq_tol(v.u[i], exact[i], 1e-10);
  solved_free(&v);
  free_box(s);
}

/* K of the assembly, the forces of the elements and the energy belong together:
 * K u = F, residual and B' sigma less F are zero inside, E = F'u / 2. */
TESTS(forces_energy_and_stiffness_agree, 2 * KINDS) {
  const kinematics kin = averaged_kinematics[_i / 2];
  scene *s = averaged_box(kin, 4, 0.49, _i % 2);
  unsigned seed = 3;
  solved v = solved_new(s);
  double work = 0, scale = 0;
  for (int c = 0; c < s->m->dim; ++c) scene_fix(s, "BOTTOM", c);
  for (size_t i = 0; i < v.n; ++i) v.F[i] = scene_random(&seed);
  solve(s, &v, NULL);
  domain_stress(&s->d, v.u, NULL, v.sigma);
  domain_internal_force(&s->d, v.sigma, v.rest);
  for (size_t i = 0; i < v.n; ++i) {
    work += 0.5 * v.F[i] * v.u[i];
    scale = fmax(scale, fabs(v.rest[i]));
    if (!s->fixed[i]) ck_assert_double_eq_tol(v.rest[i], v.F[i], 1e-11);
  }
  ck_assert_double_eq_tol(domain_strain_energy(&s->d, v.u), work, 1e-11 * work);
  solved_free(&v);
  free_box(s);
}

/* Strains without stress: what eigen_force adds is what stresses miss. */
TESTS(strains_without_stress_are_averaged_alike, KINDS) {
  const kinematics kin = averaged_kinematics[_i];
  scene *s = averaged_box(kin, 4, 0.49, 0);
  const int ns = s->d.ns, n = s->m->n_elem;
  unsigned seed = 9;
  solved v = solved_new(s);
  FREED double *e0 = calloc((size_t)(ns * n), sizeof *e0);
  int *id = calloc((size_t)n, sizeof *id);
  for (int e = 0; e < n; ++e) id[e] = e;
  for (int i = 0; i < ns * n; ++i) e0[i] = scene_random(&seed);
  const eigenstrain x = {n, id, e0};
  for (int c = 0; c < s->m->dim; ++c) scene_fix(s, "BOTTOM", c);
  eigen_force(&s->d, &x, v.F);
  solve(s, &v, NULL);
  s->d.eigen = &x;
  domain_stress(&s->d, v.u, NULL, v.sigma);
  domain_internal_force(&s->d, v.sigma, v.rest);
  for (size_t i = 0; i < v.n; ++i)
    if (!s->fixed[i]) ck_assert_double_eq_tol(v.rest[i], 0, 1e-11);
  /* The same forces from the stresses that are not averaged. */
  eigen_stress(&s->d, &x, v.u, NULL, v.sigma);
  memset(v.F, 0, v.n * sizeof *v.F);
  eigen_add_force(&s->d, n, id, v.sigma, v.F);
  for (size_t i = 0; i < v.n; ++i)
    ck_assert_double_eq_tol(v.rest[i], v.F[i], 1e-11);
  free(id);
  solved_free(&v);
  free_box(s);
}

/* Rows <tr B> V of the clusters over the unknowns: D[n*N]. */
static void divergence(const scene *s, size_t N, double *D, double *volume) {
  const int dim = s->m->dim, ns = s->d.ns;
  const cluster_set *c = s->d.cluster;
  double B[72];
  for (int e = 0; e < s->m->n_elem; ++e) {
    const double w = element_strain(&s->d, e, B);
    volume[c->of[e]] += w;
    for (int k = 0; k < dim * (dim + 1); ++k) {
      const int node = s->m->elem[(dim + 1) * e + k / dim];
      const size_t at = (size_t)(dim * node + k % dim);
      const double *b = B + ns * k;
      D[at + N * (size_t)c->of[e]] += w * (b[0] + b[1] + b[2]);
    }
  }
}

/* Smallest b of sup_v (q, div v) / |e(v)| >= b |q| over pressures q constant on
 * the clusters; BOTTOM, LEFT and RIGHT are fixed. */
static double inf_sup(scene *s) {
  const int dim = s->m->dim, n = s->d.cluster->n;
  const size_t N = (size_t)(dim * s->m->n_node);
  FREED double *K = calloc(N * N, sizeof *K);
  FREED double *D = calloc(N * (size_t)n, sizeof *D);
  FREED double *S = calloc((size_t)(n * n), sizeof *S),
               *lambda = calloc((size_t)n, 8);
  FREED double *volume = calloc((size_t)n, sizeof *volume);
  scene_dense(s, K);
  divergence(s, N, D, volume);
  for (size_t i = 0; i < N; ++i) {
    if (!s->fixed[i]) continue;
    for (size_t j = 0; j < N; ++j) K[i + N * j] = K[j + N * i] = i == j;
    for (size_t q = 0; q < (size_t)n; ++q) D[i + N * q] = 0;
  }
  /* D := inv(L) D, S = D' D over the volumes. */
  ck_assert_int_eq(LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', (int)N, K, (int)N), 0);
  ck_assert_int_eq(LAPACKE_dtrtrs(LAPACK_COL_MAJOR, 'L', 'N', 'N', (int)N, n, K,
                                  (int)N, D, (int)N),
                   0);
  for (int a = 0; a < n; ++a)
    for (int b = 0; b <= a; ++b) {
      double sum = 0;
      for (size_t i = 0; i < N; ++i)
        sum += D[i + N * (size_t)a] * D[i + N * (size_t)b];
      S[a + n * b] = sum / sqrt(volume[a] * volume[b]);
    }
  ck_assert_int_eq(LAPACKE_dsyev(LAPACK_COL_MAJOR, 'N', 'L', n, S, n, lambda),
                   0);
  return sqrt(fmax(lambda[0], 0));
}

/* The constant does not fall with the size of the elements: no spurious
 * pressures. */
TESTS(pressures_are_stable, KINDS) {
  static const int sizes[KINDS][3] = {{4, 8, 14}, {4, 8, 14}, {3, 4, 6}};
  for (int k = 0; k < 3; ++k) {
    scene *s = averaged_box(averaged_kinematics[_i], sizes[_i][k], 0.4, 1);
    set_nu(s, 0);
    for (int c = 0; c < s->m->dim; ++c) {
      scene_fix(s, "BOTTOM", c);
      scene_fix(s, "LEFT", c);
      scene_fix(s, "RIGHT", c);
    }
    ck_assert_double_gt(inf_sup(s), 0.5);
    free_box(s);
  }
}

UNIT_MAIN("cluster")
