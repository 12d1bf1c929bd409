/*
 * P1 triangles and tetrahedra: stiffness, strains, stresses, internal forces
 * and strain energy of a displacement. The strain is constant in an element
 * except for the hoop strain u_r / r of axisymmetry, taken at the centroid; the
 * weight there is 2 pi r_c area (one whole turn).
 */
#include "fem/element.h"

#include "base/base.h"
#include "material/voigt.h"

typedef struct element_shape {
  double grad[12]; /* [dim*(dim+1)] gradient of each shape function, 1/m */
  double hoop;     /* shape function over radius at the centroid, 1/m; 0 unless
                      axisymmetric */
  double weight;   /* volume, thickness or 2 pi r included, m3 */
} element_shape;

static void shape_at(const domain *d, int elem_id, element_shape *s) {
  const mesh *m = d->mesh;
  const int section = d->section_id[elem_id];
  const double determinant = mesh_elem_gradients(m, elem_id, s->grad);
  s->weight = (m->dim == 2 ? 0.5 * determinant : determinant / 6) *
              d->thickness[section];
  s->hoop = 0;
  if (d->kin[section] != AXISYMMETRIC) return;
  const int *v = m->elem + 3 * elem_id;
  const double three_r = m->x[2 * v[0]] + m->x[2 * v[1]] + m->x[2 * v[2]];
  s->hoop = 1 / three_r;
  s->weight *= 2.0 * M_PI * (three_r / 3);
}

/* E B_b of one vertex, columns of ns: the stress of its unit displacements. */
static void stress_2d(const double *E, const double *g, double hoop,
                      double *S) {
  for (int i = 0; i < 4; ++i) {
    S[i] = E[i] * g[0] + E[8 + i] * hoop + E[12 + i] * g[1];
    S[4 + i] = E[4 + i] * g[1] + E[12 + i] * g[0];
  }
}

static void stress_3d(const double *E, const double *g, double *S) {
  for (int i = 0; i < 6; ++i) {
    S[i] = E[i] * g[0] + E[18 + i] * g[1] + E[30 + i] * g[2];
    S[6 + i] = E[6 + i] * g[1] + E[18 + i] * g[0] + E[24 + i] * g[2];
    S[12 + i] = E[12 + i] * g[2] + E[24 + i] * g[1] + E[30 + i] * g[0];
  }
}

static void block_2d(const double *g, double hoop, double w, const double *S,
                     double *k) {
  for (int c = 0; c < 2; ++c) {
    const double *s = S + 4 * c;
    k[2 * c] = w * (g[0] * s[0] + hoop * s[2] + g[1] * s[3]);
    k[2 * c + 1] = w * (g[1] * s[1] + g[0] * s[3]);
  }
}

static void block_3d(const double *g, double w, const double *S, double *k) {
  for (int c = 0; c < 3; ++c) {
    const double *s = S + 6 * c;
    k[3 * c] = w * (g[0] * s[0] + g[1] * s[3] + g[2] * s[5]);
    k[3 * c + 1] = w * (g[1] * s[1] + g[0] * s[3] + g[2] * s[4]);
    k[3 * c + 2] = w * (g[2] * s[2] + g[1] * s[4] + g[0] * s[5]);
  }
}

void element_rest(const domain *d, int elem_id, double *E, double *m_E,
                  double *bulk) {
  const size_t ns = d->ns;
  const int k = d->cluster == NULL ? -1 : d->cluster->of[elem_id];
  const double part = k < 0 ? 0 : d->cluster->share[k] / 3;
  COPY(E, d->E + ns * ns * d->section_id[elem_id], ns * ns);
  if (k < 0) return;
  for (size_t i = 0; i < ns; ++i) m_E[i] = E[i] + E[ns + i] + E[2 * ns + i];
  *bulk = m_E[0] + m_E[1] + m_E[2];
  for (size_t j = 0; j < ns; ++j)
    for (size_t i = 0; i < ns; ++i)
      E[ns * j + i] -= part * ((j < 3) * m_E[i] + (i < 3) * m_E[j]) -
                       (i < 3 && j < 3) * part * part * *bulk;
  for (size_t i = 0; i < 3; ++i) m_E[i] -= part * *bulk;
}

void element_stiffness(const domain *d, int elem_id, double *blocks) {
  const int dim = d->mesh->dim;
  element_shape s;
  double E[36], S[18], m_E[6], bulk;
  element_rest(d, elem_id, E, m_E, &bulk);
  shape_at(d, elem_id, &s);
  for (int b = 0; b <= dim; ++b) {
    const double *gb = s.grad + dim * b;
    if (dim == 2)
      stress_2d(E, gb, s.hoop, S);
    else
      stress_3d(E, gb, S);
    for (int a = b; a <= dim; ++a) {
      double *k = blocks + dim * dim * (a * (a + 1) / 2 + b);
      if (dim == 2)
        block_2d(s.grad + 2 * a, s.hoop, s.weight, S, k);
      else
        block_3d(s.grad + 3 * a, s.weight, S, k);
    }
  }
}

double element_strain(const domain *d, int elem_id, double *B) {
  static const int shear[3][2] = {{0, 1}, {1, 2}, {2, 0}};
  const int dim = d->mesh->dim, ns = d->ns;
  element_shape s;
  shape_at(d, elem_id, &s);
  CLEAR(B, ns * dim * (dim + 1));
  for (int a = 0; a <= dim; ++a) {
    const double *g = s.grad + dim * a;
    double *b = B + ns * dim * a;
    for (int c = 0; c < dim; ++c) b[ns * c + c] = g[c];
    if (dim == 2) b[2] = s.hoop;
    for (int k = 0; k < (dim == 2 ? 1 : 3); ++k) {
      b[ns * shear[k][0] + 3 + k] = g[shear[k][1]];
      b[ns * shear[k][1] + 3 + k] = g[shear[k][0]];
    }
  }
  return s.weight;
}

double element_weight(const domain *d, int elem_id) {
  element_shape s;
  shape_at(d, elem_id, &s);
  return s.weight;
}

static void strain_2d(const int *v, const double *u, const element_shape *s,
                      double *e) {
  double xx = 0, yy = 0, zz = 0, xy = 0;
  for (int a = 0; a < 3; ++a) {
    const double *g = s->grad + 2 * a, *ua = u + 2 * (size_t)v[a];
    xx += g[0] * ua[0];
    yy += g[1] * ua[1];
    zz += s->hoop * ua[0];
    xy += g[1] * ua[0] + g[0] * ua[1];
  }
  e[0] = xx;
  e[1] = yy;
  e[2] = zz;
  e[3] = xy;
}

static void strain_3d(const int *v, const double *u, const element_shape *s,
                      double *e) {
  for (int i = 0; i < 6; ++i) e[i] = 0;
  for (int a = 0; a < 4; ++a) {
    const double *g = s->grad + 3 * a, *ua = u + 3 * (size_t)v[a];
    e[0] += g[0] * ua[0];
    e[1] += g[1] * ua[1];
    e[2] += g[2] * ua[2];
    e[3] += g[1] * ua[0] + g[0] * ua[1];
    e[4] += g[2] * ua[1] + g[1] * ua[2];
    e[5] += g[2] * ua[0] + g[0] * ua[2];
  }
}

/* Strain of one element: e[ns]. */
static void strain_at(const domain *d, int elem_id, const double *u,
                      const element_shape *s, double *e) {
  if (d->mesh->dim == 2)
    strain_2d(d->mesh->elem + 3 * (size_t)elem_id, u, s, e);
  else
    strain_3d(d->mesh->elem + 4 * (size_t)elem_id, u, s, e);
}

void element_stress(const domain *d, int elem_id, const double *e,
                    double *sigma) {
  const size_t square = d->ns * d->ns;
  voigt_product(d->ns, d->E + square * d->section_id[elem_id], e, sigma);
}

/* Means over clusters of the strains of n elements (NULL: the first n). */
static void mean_strains(const domain *d, int n, const int *elem_id,
                         const double *u) {
  if (d->cluster == NULL) return;
  cluster_begin(d->cluster, CLUSTER_STRAIN);
  for (int k = 0; k < n; ++k) {
    const int id = elem_id == NULL ? k : elem_id[k];
    element_shape s;
    double e[6];
    shape_at(d, id, &s);
    strain_at(d, id, u, &s, e);
    cluster_add(d->cluster, CLUSTER_STRAIN, id, e);
  }
}

/* Strain of one element after mean_strains. */
static void averaged_strain(const domain *d, int elem_id, const double *u,
                            const element_shape *s, double *e) {
  strain_at(d, elem_id, u, s, e);
  if (d->cluster != NULL)
    cluster_smooth(d->cluster, CLUSTER_STRAIN, elem_id, e);
}

/* e0 of an element, or NULL; *next runs along with ascending elem_id. */
static const double *eigen_at(const domain *d, int elem_id, int *next) {
  const eigenstrain *x = d->eigen;
  if (x == NULL || *next >= x->n || x->elem_id[*next] != elem_id) return NULL;
  return x->e0 + (size_t)d->ns * (*next)++;
}

/* e[ns] becomes the elastic strain; e0 may be NULL. */
static void take_eigen(const domain *d, const double *e0, double *e) {
  for (int i = 0; e0 != NULL && i < d->ns; ++i) e[i] -= e0[i];
}

void domain_stress(const domain *d, const double *u, double *e, double *sigma) {
  const size_t ns = d->ns;
  int next = 0;
  mean_strains(d, d->mesh->n_elem, NULL, u);
  for (int k = 0; k < d->mesh->n_elem; ++k) {
    const double *e0 = eigen_at(d, k, &next);
    element_shape s;
    double strain[6];
    shape_at(d, k, &s);
    averaged_strain(d, k, u, &s, strain);
    take_eigen(d, e0, strain);
    if (sigma != NULL) element_stress(d, k, strain, sigma + ns * k);
    if (e == NULL) continue;
    /* Plane stress: the elastic strain e gets its zz, then e0 is put back. */
    if (d->kin[d->section_id[k]] == PLANE_STRESS && d->C != NULL)
      elastic_zz_strain(d->C + (size_t)36 * d->section_id[k], strain);
    for (int i = 0; e0 != NULL && i < d->ns; ++i) strain[i] += e0[i];
    COPY(e + ns * k, strain, ns);
  }
  if (sigma != NULL && d->cluster != NULL) {
    cluster_begin(d->cluster, CLUSTER_STRESS);
    for (int k = 0; k < d->mesh->n_elem; ++k)
      cluster_add(d->cluster, CLUSTER_STRESS, k, sigma + ns * k);
    for (int k = 0; k < d->mesh->n_elem; ++k)
      cluster_smooth(d->cluster, CLUSTER_STRESS, k, sigma + ns * k);
  }
}

void eigen_stress(const domain *d, const eigenstrain *x, const double *u,
                  double *e, double *sigma) {
  const size_t ns = d->ns;
  mean_strains(d, x->n, x->elem_id, u);
  for (int k = 0; k < x->n; ++k) {
    element_shape s;
    double strain[6];
    shape_at(d, x->elem_id[k], &s);
    averaged_strain(d, x->elem_id[k], u, &s, strain);
    if (x->e0 != NULL) take_eigen(d, x->e0 + ns * k, strain);
    if (e != NULL) COPY(e + ns * k, strain, ns);
    if (sigma != NULL) element_stress(d, x->elem_id[k], strain, sigma + ns * k);
  }
}

static void force_2d(const int *v, const element_shape *s, const double *t,
                     double w, double *F) {
  for (int a = 0; a < 3; ++a) {
    const double *g = s->grad + 2 * a;
    double *f = F + 2 * (size_t)v[a];
    f[0] += w * (g[0] * t[0] + s->hoop * t[2] + g[1] * t[3]);
    f[1] += w * (g[1] * t[1] + g[0] * t[3]);
  }
}

static void force_3d(const int *v, const element_shape *s, const double *t,
                     double w, double *F) {
  for (int a = 0; a < 4; ++a) {
    const double *g = s->grad + 3 * a;
    double *f = F + 3 * (size_t)v[a];
    f[0] += w * (g[0] * t[0] + g[1] * t[3] + g[2] * t[5]);
    f[1] += w * (g[1] * t[1] + g[0] * t[3] + g[2] * t[4]);
    f[2] += w * (g[2] * t[2] + g[1] * t[4] + g[0] * t[5]);
  }
}

/* F += scale B' sigma w of one element; sigma[ns]. */
static void add_force(const domain *d, int elem_id, const element_shape *s,
                      const double *sigma, double scale, double *F) {
  if (d->mesh->dim == 2)
    force_2d(d->mesh->elem + 3 * (size_t)elem_id, s, sigma, scale * s->weight,
             F);
  else
    force_3d(d->mesh->elem + 4 * (size_t)elem_id, s, sigma, scale * s->weight,
             F);
}

void domain_internal_force(const domain *d, const double *sigma, double *F) {
  CLEAR(F, (size_t)d->mesh->dim * d->mesh->n_node);
  for (int k = 0; k < d->mesh->n_elem; ++k) {
    element_shape s;
    shape_at(d, k, &s);
    add_force(d, k, &s, sigma + (size_t)d->ns * k, 1, F);
  }
}

/* 1: a degree of freedom of the element is in held[dim*n_node]. */
static int has_held(const mesh *m, int elem_id, const unsigned char *held) {
  const int *v = m->elem + (m->dim + 1) * (size_t)elem_id;
  for (int a = 0; a <= m->dim; ++a)
    for (int c = 0; c < m->dim; ++c)
      if (held[m->dim * (size_t)v[a] + c]) return 1;
  return 0;
}

void domain_held_force(const domain *d, const double *u,
                       const unsigned char *held, double *F) {
  int next = 0;
  CLEAR(F, (size_t)d->mesh->dim * d->mesh->n_node);
  for (int k = 0; k < d->mesh->n_elem; ++k) {
    const double *e0 = eigen_at(d, k, &next);
    element_shape s;
    double e[6], t[6];
    if (!has_held(d->mesh, k, held)) continue;
    shape_at(d, k, &s);
    averaged_strain(d, k, u, &s, e);
    take_eigen(d, e0, e);
    element_stress(d, k, e, t);
    add_force(d, k, &s, t, 1, F);
  }
}

void eigen_force(const domain *d, const eigenstrain *x, double *F) {
  double t[6];
  cluster_begin(d->cluster, CLUSTER_STRESS);
  for (int k = 0; k < x->n && d->cluster != NULL; ++k) {
    element_stress(d, x->elem_id[k], x->e0 + (size_t)d->ns * k, t);
    cluster_add(d->cluster, CLUSTER_STRESS, x->elem_id[k], t);
  }
  for (int k = 0; k < x->n; ++k) {
    element_shape s;
    shape_at(d, x->elem_id[k], &s);
    element_stress(d, x->elem_id[k], x->e0 + (size_t)d->ns * k, t);
    cluster_smooth(d->cluster, CLUSTER_STRESS, x->elem_id[k], t);
    add_force(d, x->elem_id[k], &s, t, 1, F);
  }
}

void eigen_add_force(const domain *d, int n, const int *elem_id,
                     const double *sigma, double *F) {
  const size_t ns = d->ns;
  cluster_begin(d->cluster, CLUSTER_STRESS);
  for (int k = 0; k < n; ++k)
    cluster_add(d->cluster, CLUSTER_STRESS, elem_id[k], sigma + ns * k);
  for (int k = 0; k < n; ++k) {
    element_shape s;
    double t[6];
    COPY(t, sigma + ns * k, ns);
    shape_at(d, elem_id[k], &s);
    cluster_smooth(d->cluster, CLUSTER_STRESS, elem_id[k], t);
    add_force(d, elem_id[k], &s, t, 1, F);
  }
}

/* E A e of one element after mean_strains. */
static void stress_of(const domain *d, int elem_id, const double *u,
                      const element_shape *s, double *t) {
  double e[6];
  averaged_strain(d, elem_id, u, s, e);
  element_stress(d, elem_id, e, t);
}

void domain_residual(const domain *d, const double *u, const double *F,
                     double *rest) {
  const int n = d->mesh->n_elem;
  element_shape s;
  double t[6];
  COPY(rest, F, (size_t)d->mesh->dim * d->mesh->n_node);
  mean_strains(d, n, NULL, u);
  cluster_begin(d->cluster, CLUSTER_STRESS);
  for (int k = 0; k < n && d->cluster != NULL; ++k) {
    shape_at(d, k, &s);
    stress_of(d, k, u, &s, t);
    cluster_add(d->cluster, CLUSTER_STRESS, k, t);
  }
  for (int k = 0; k < n; ++k) {
    shape_at(d, k, &s);
    stress_of(d, k, u, &s, t);
    cluster_smooth(d->cluster, CLUSTER_STRESS, k, t);
    add_force(d, k, &s, t, -1, rest);
  }
}

double domain_energy_without(const domain *d, int n, const int *elem_id,
                             const double *u) {
  double sum = 0;
  int next = 0, skip = 0;
  if (n == d->mesh->n_elem) return 0;
  TIMED(STAGE_ENERGY);
  mean_strains(d, d->mesh->n_elem, NULL, u);
  for (int k = 0; k < d->mesh->n_elem; ++k) {
    const double *e0 = eigen_at(d, k, &next);
    element_shape s;
    double e[6], t[6];
    if (skip < n && elem_id[skip] == k) {
      ++skip;
      continue;
    }
    shape_at(d, k, &s);
    averaged_strain(d, k, u, &s, e);
    take_eigen(d, e0, e);
    element_stress(d, k, e, t);
    sum += 0.5 * s.weight * voigt_dot(d->ns, e, t);
  }
  return sum;
}

double domain_strain_energy(const domain *d, const double *u) {
  return domain_energy_without(d, 0, NULL, u);
}

/* det(1 + G) of a gradient, G[3*3] row by row. */
static double volume_ratio(const double *G) {
  const double a = 1 + G[0], e = 1 + G[4], i = 1 + G[8];
  return a * (e * i - G[5] * G[7]) - G[1] * (G[3] * i - G[5] * G[6]) +
         G[2] * (G[3] * G[7] - e * G[6]);
}

/* Displacement gradient G[3*3] of an element, that of the hoop in G[8]; returns
 * the sum of the squares of the gradients of its shape functions, 1/m2. */
static inline double gradient_at(const domain *d, int dim, int elem_id,
                                 const double *u, double *G) {
  const int *v = d->mesh->elem + (dim + 1) * elem_id;
  element_shape s;
  shape_at(d, elem_id, &s);
  double sum = (dim + 1) * s.hoop * s.hoop;
  CLEAR(G, 9);
  for (int a = 0; a <= dim; ++a) {
    const double *u_a = u + (size_t)dim * v[a];
    for (int i = 0; i < dim; ++i)
      for (int c = 0; c < dim; ++c)
        G[3 * i + c] += u_a[i] * s.grad[dim * a + c];
    if (dim == 2) G[8] += u_a[0] * s.hoop;
    for (int c = 0; c < dim; ++c)
      sum += s.grad[dim * a + c] * s.grad[dim * a + c];
  }
  return sum;
}

/* Sum of the squares of the strains of a gradient. */
static double strain_square(const double *G) {
  const double yz = G[5] + G[7], zx = G[2] + G[6], xy = G[1] + G[3];
  return G[0] * G[0] + G[4] * G[4] + G[8] * G[8] +
         0.5 * (yz * yz + zx * zx + xy * xy);
}

/* Square of the angle of a small rotation, the skew part of a gradient. */
static double rotation_square(const double *G) {
  const double yz = G[7] - G[5], zx = G[2] - G[6], xy = G[3] - G[1];
  return 0.25 * (yz * yz + zx * zx + xy * xy);
}

/* Of one element, at least "most". */
static inline double spread_at(const domain *d, int dim, int elem_id,
                               const double *u, double most) {
  const int *v = d->mesh->elem + (size_t)(dim + 1) * elem_id;
  const int hoop = d->kin[d->section_id[elem_id]] == AXISYMMETRIC;
  for (int c = 0; c < dim; ++c) {
    const double own = hoop ? 0.0 : u[(size_t)dim * v[0] + c];
    for (int a = 0; a <= dim; ++a) {
      const double by = fabs(u[(size_t)dim * v[a] + c] - own);
      if (by > most) most = by;
    }
  }
  return most;
}

double domain_spread(const domain *d, const double *u) {
  double most = 0.0;
  for (int e = 0; e < d->mesh->n_elem; ++e)
    most = d->mesh->dim == 2 ? spread_at(d, 2, e, u, most)
                             : spread_at(d, 3, e, u, most);
  return most;
}

/* Least sum of the squares of a gradient, a singular value of 1, that turns an
 * element inside out. */
static const double FOLDS = 1.0;

void domain_deformation(const domain *d, const double *u, deformation *out) {
  const int dim = d->mesh->dim;
  double largest = 0.0, farthest = 0.0, gain = 0.0;
  *out = (deformation){.volume = 1};
  for (int e = 0; e < d->mesh->n_elem; ++e) {
    double G[9];
    /* loops of a length that the compiler knows */
    const double slope =
        dim == 2 ? gradient_at(d, 2, e, u, G) : gradient_at(d, 3, e, u, G);
    const double square = strain_square(G), turn = rotation_square(G);
    if (turn > farthest) {
      farthest = turn;
      out->rotation_elem = e;
    }
    if (square > largest) {
      largest = square;
      out->strain_elem = e;
    }
    if (slope > gain) gain = slope;
    if (square + 2.0 * turn < FOLDS) continue;
    const double volume = volume_ratio(G);
    if (volume < out->volume) {
      out->volume = volume;
      out->volume_elem = e;
    }
  }
  out->strain = sqrt(largest);
  out->rotation = sqrt(farthest);
  out->gain = sqrt(dim * (dim + 1) * gain);
}
