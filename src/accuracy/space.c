/*
 * Stress recovery: round each node a linear polynomial is fitted to the
 * stresses at the centroids of the elements of one material; inside a body to
 * those that meet at the node, at its boundary to those of the next ring too,
 * for what lies on one side only must be extrapolated. With d the recovered
 * less the element's stress at the vertices,
 *
 *   eta^2 = integral of d' inv(E) d = w / ((dim+1)(dim+2))
 *           (sum_a d_a' S d_a + (sum_a d_a)' S (sum_a d_a)),   S = inv(E).
 *
 * The hoop strain u_r / r of axisymmetry, though taken at the centroid, varies
 * in an element and has an error of the order h^2: with c the hoop strain of
 * S d, the energy is that of S d without it, as the law sees it, which averages
 * a share of the change of volume: without c v, v of cluster_hoop(),
 *
 *   d' S d - 2 c v' d + c^2 v' E v.
 */
#include "accuracy/space.h"

#include "base/base.h"

#include <lapacke.h>

/*
 * Sizes for a new mesh from the errors of the elements of an old one. An
 * element made smaller by the factor r has r^(-dim) parts with the error
 * eta r together (P1: order 1 in the energy norm). The fewest elements with
 * sum (eta r)^2 = target^2 have
 *
 *   r = c eta^(-2/(2+dim)),   c^2 = target^2 / sum eta^(2 dim/(2+dim))
 *
 * (Zienkiewicz, Zhu 1992; the optimum of a sum under one condition). A pass
 * changes no length by more than a factor of four (ten, if the error is within
 * a factor of eight of the target: the mesh that reaches it), and sizes grow
 * slowly from node to node, so that gmsh can follow them.
 */

static const double FINEST = 0.25, COARSEST = 2.0; /* -, in one pass */
/* Near the target the errors determine all sizes of the last mesh. */
static const double REACH = 8.0, FINEST_LAST = 0.1; /* - */
static const double GROWTH = 0.4; /* -, change of the size over a distance */
enum { SWEEPS = 20 };

/* Length of the edge of a regular element of the same measure. */
static double element_length(const mesh *m, int elem_id) {
  double measure = mesh_elem_measure(m, elem_id);
  return m->dim == 2 ? sqrt(measure * 4.0 / sqrt(3.0))
                     : cbrt(measure * 6.0 * sqrt(2.0));
}

/* c of the head of this file. */
static double common_factor(const mesh *m, const double *eta, double target) {
  double sum = 0.0, power = 2.0 * m->dim / (2.0 + m->dim);
  for (int e = 0; e < m->n_elem; ++e) sum += pow(eta[e], power);
  return sum > 0.0 ? target / sqrt(sum) : HUGE_VAL;
}

static double finest(const mesh *m, const double *eta, double target) {
  double sum = 0.0;
  for (int e = 0; e < m->n_elem; ++e) sum += eta[e] * eta[e];
  return sqrt(sum) <= REACH * target ? FINEST_LAST : FINEST;
}

/* The smallest size required by the elements round a node. */
static void sizes_at_nodes(const mesh *m, const double *eta, double target,
                           double *size) {
  double c = common_factor(m, eta, target), least = finest(m, eta, target);
  for (int i = 0; i < m->n_node; ++i) size[i] = HUGE_VAL;
  for (int e = 0; e < m->n_elem; ++e) {
    double r = eta[e] > 0.0 ? c * pow(eta[e], -2.0 / (2.0 + m->dim)) : COARSEST;
    double h = element_length(m, e) * fmin(fmax(r, least), COARSEST);
    for (int a = 0; a <= m->dim; ++a) {
      double *at = &size[m->elem[(m->dim + 1) * e + a]];
      *at = fmin(*at, h);
    }
  }
}

/* One sweep over the edges; 1 if a size changed. */
static int limit_growth(const mesh *m, double *size) {
  int changed = 0;
  for (int e = 0; e < m->n_elem; ++e)
    for (int a = 0; a <= m->dim; ++a)
      for (int b = 0; b <= m->dim; ++b) {
        int i = m->elem[(m->dim + 1) * e + a];
        int j = m->elem[(m->dim + 1) * e + b];
        double most = size[j] + GROWTH * distance_of(m->dim, mesh_node_x(m, i),
                                                     mesh_node_x(m, j));
        if (!(size[i] > most)) continue;
        size[i] = most;
        changed = 1;
      }
  return changed;
}

void space_sizes(const mesh *m, const double *eta, double target,
                 double *size) {
  sizes_at_nodes(m, eta, target, size);
  for (int k = 0; k < SWEEPS && limit_growth(m, size); ++k) continue;
}

void space_lengths(const mesh *m, double *size) {
  for (int i = 0; i < m->n_node; ++i) size[i] = HUGE_VAL;
  for (int e = 0; e < m->n_elem; ++e)
    for (int a = 0; a <= m->dim; ++a) {
      double *at = &size[m->elem[(m->dim + 1) * e + a]];
      *at = fmin(*at, element_length(m, e));
    }
}

double space_growth(const mesh *m, const double *size) {
  double sum = 0.0;
  for (int e = 0; e < m->n_elem; ++e) {
    double mean = 0.0;
    for (int a = 0; a <= m->dim; ++a)
      mean += size[m->elem[(m->dim + 1) * e + a]] / (m->dim + 1);
    sum += pow(element_length(m, e) / mean, m->dim);
  }
  return sum / m->n_elem;
}

/* Parts r^(-dim) of all elements, by c of the head of this file. */
double space_growth_to(const mesh *m, const double *eta, double target) {
  const double c = common_factor(m, eta, target);
  return target * target / pow(c, m->dim + 2) / m->n_elem;
}

/* Measured on cubes and squares of known solutions: estimates of meshes with
 * less elements along an edge had 0.55 to 0.95 of the error. */
static const double DEEP = 9.0;

enum { MAX_BASIS = 4, MAX_NS = 6 };
static const double FLAT = 1e-6; /* -, pivot of a fit without enough points */

/* The values at the nodes of a region as sums over elements. */
typedef struct fit_weights {
  int *start;     /* [n_node+1] */
  int *elem;      /* [start[n_node]] */
  double *weight; /* the same, - */
} fit_weights;

struct space_recovery {
  const domain *d;
  int n_section, n_region;
  int *region;        /* [n_elem] elements of one material, and of one zone of
                         temperatures, have one */
  double *compliance; /* [ns*ns*n_section] 1/Pa, inv(E) of the estimate */
  double *of_error;   /* the same without the hoop strains */
  size_t *start;      /* of mesh_node_elements */
  int *elem;
  int *patch, *stamp; /* [n_elem] elements of a patch; mark of the last patch */
  double *weight;     /* [n_elem] of the elements of a patch, - */
  int *seen;          /* [n_node] mark of the last patch */
  int last;           /* mark */
  double *centroid;   /* [dim*n_elem] m */
  double *measure;    /* [n_elem] element_weight */
  fit_weights *kept;  /* [n_region] after space_keep, else NULL */
  double *recovered;  /* [ns*n_node] of the current region, Pa */
  double depth;       /* elements along the edge of a cube or square that has
                         the same share of nodes inside; 0: not known */
};

/* ---- set-up -------------------------------------------------------------- */

/* 1 if the stress of a solution may be continuous across two sections. */
static int same_material(const domain *d, int a, int b) {
  size_t size = d->ns * d->ns;
  return d->kin[a] == d->kin[b] && d->thickness[a] == d->thickness[b] &&
         memcmp(d->E + size * a, d->E + size * b, size * sizeof *d->E) == 0;
}

/* of[n_section]: the first section of the same material. */
static void find_materials(const space_recovery *s, int *of) {
  const int *origin = s->d->origin;
  for (int i = 0; i < s->n_section; ++i) {
    int first = 0;
    if (origin != NULL && origin[i] < i) {
      of[i] = of[origin[i]];
      continue;
    }
    while (first < i && !same_material(s->d, first, i)) ++first;
    of[i] = first < i ? of[first] : i;
  }
}

static status find_regions(space_recovery *s) {
  const domain *d = s->d;
  int n_zone = 1;
  for (int k = 0; k < d->mesh->n_elem && d->zone != NULL; ++k)
    if (d->zone[k] >= n_zone) n_zone = d->zone[k] + 1;
  OWNED_NEW(int, material, s->n_section);
  OWNED_NEW(int, region, ((size_t)s->n_section * n_zone));
  find_materials(s, material);
  for (int k = 0; k < d->mesh->n_elem; ++k) {
    int *at = &region[material[d->section_id[k]] * n_zone +
                      (d->zone != NULL ? d->zone[k] : 0)];
    if (*at == 0) *at = ++s->n_region;
    s->region[k] = *at - 1;
  }
  return OK;
}

status space_compliance(const domain *d, int section, double *S) {
  int ns = d->ns, n = 0, active[MAX_NS];
  const double *E = d->E + (size_t)(ns * ns) * section;
  double M[MAX_NS * MAX_NS];
  for (int i = 0; i < ns; ++i)
    if (i != 2 || d->kin[section] != PLANE_STRESS) active[n++] = i;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) M[i + n * j] = E[active[i] + ns * active[j]];
  if (LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', n, M, n) != 0 ||
      LAPACKE_dpotri_work(LAPACK_COL_MAJOR, 'L', n, M, n) != 0)
    RAISE(ERR_INTERNAL, "elasticity of section %d is not positive definite",
          section + 1);
  for (int j = 0; j < n; ++j)
    for (int i = j; i < n; ++i) {
      S[active[i] + ns * active[j]] = M[i + n * j];
      S[active[j] + ns * active[i]] = M[i + n * j];
    }
  return OK;
}

static void find_centroids(const mesh *m, double *x) {
  for (int e = 0; e < m->n_elem; ++e)
    for (int c = 0; c < m->dim; ++c, ++x) {
      for (int a = 0; a <= m->dim; ++a)
        *x += m->x[m->dim * m->elem[(m->dim + 1) * e + a] + c];
      *x /= m->dim + 1;
    }
}

status space_recovery_new(const domain *d, space_recovery **out) {
  const mesh *m = d->mesh;
  MAKES(space_recovery, s, out);
  s->d = d;
  for (int k = 0; k < m->n_elem; ++k)
    if (d->section_id[k] >= s->n_section) s->n_section = d->section_id[k] + 1;
  PASS_NEW_ALL(
      OF(s->region, m->n_elem), OF(s->compliance, d->ns * d->ns * s->n_section),
      OF(s->of_error, d->ns * d->ns * s->n_section), OF(s->patch, m->n_elem),
      OF(s->stamp, m->n_elem), OF(s->weight, m->n_elem), OF(s->seen, m->n_node),
      OF(s->recovered, (size_t)d->ns * m->n_node),
      OF(s->centroid, m->dim * m->n_elem), OF(s->measure, m->n_elem));
  find_centroids(m, s->centroid);
  for (int k = 0; k < m->n_elem; ++k) s->measure[k] = element_weight(d, k);
  PASS(find_regions(s));
  return mesh_node_elements(m, &s->start, &s->elem);
}

/* ---- patches ------------------------------------------------------------- */

/* Add the elements of a region round a node to the patch of n; new size. */
static int add_ring(space_recovery *s, int node, int region, int n) {
  for (size_t k = s->start[node]; k < s->start[node + 1]; ++k) {
    int e = s->elem[k];
    if (s->stamp[e] == s->last || s->region[e] != region) continue;
    s->stamp[e] = s->last;
    s->patch[n++] = e;
  }
  return n;
}

/*
 * 1 if the n elements of the patch close round their common node. By Euler's
 * formula for the surface they form: V neighbours and n elements are V = n in
 * the plane, 2 (V - 2) = n in space, and fewer elements where it is open.
 */
static int is_closed(space_recovery *s, int node, int n) {
  const mesh *m = s->d->mesh;
  int neighbours = 0, vertices = m->dim + 1;
  s->seen[node] = s->last;
  for (int k = 0; k < n; ++k)
    for (int a = 0; a < vertices; ++a) {
      int v = m->elem[vertices * s->patch[k] + a];
      if (s->seen[v] == s->last) continue;
      s->seen[v] = s->last;
      ++neighbours;
    }
  return m->dim == 2 ? neighbours == n : 2 * (neighbours - 2) == n;
}

/* The patch of a node; its size, 0 if the node has no element in the region. */
static int gather(space_recovery *s, int node, int region) {
  const mesh *m = s->d->mesh;
  ++s->last;
  int n = add_ring(s, node, region, 0), inner = n;
  if (n == 0 || is_closed(s, node, n)) return n;
  for (int k = 0; k < inner; ++k)
    for (int a = 0; a <= m->dim; ++a)
      n = add_ring(s, m->elem[(m->dim + 1) * s->patch[k] + a], region, n);
  return n;
}

/* 1: the elements of one region close round the node. */
static int is_inside(space_recovery *s, int node) {
  const size_t first = s->start[node], count = s->start[node + 1] - first;
  if (count == 0) return 0;
  ++s->last;
  const int n = add_ring(s, node, space_region(s, s->elem[first]), 0);
  return (size_t)n == count && is_closed(s, node, n);
}

double space_depth(space_recovery *s) {
  const mesh *m = s->d->mesh;
  int inside = 0;
  if (s->depth == 0.0) {
    for (int i = 0; i < m->n_node; ++i) inside += is_inside(s, i);
    const double side = pow((double)inside / m->n_node, 1.0 / m->dim);
    s->depth = (1.0 + side) / (1.0 - side);
  }
  return s->depth;
}

int space_is_coarse(double depth) { return depth < DEEP; }

/* ---- the fit ------------------------------------------------------------- */

/* Half the extent of the patch round the node, length. */
static double patch_size(const space_recovery *s, int node, int n) {
  const mesh *m = s->d->mesh;
  double size = 0.0;
  for (int k = 0; k < n; ++k) {
    const double *x = s->centroid + m->dim * s->patch[k];
    for (int c = 0; c < m->dim; ++c) {
      double far = fabs(x[c] - m->x[m->dim * node + c]);
      if (far > size) size = far;
    }
  }
  return size;
}

/* Basis of the fit at element k of the patch, of the given size. */
static void basis_at(const space_recovery *s, int node, int k, double size,
                     double *basis) {
  const mesh *m = s->d->mesh;
  const double *x = s->centroid + m->dim * s->patch[k];
  basis[0] = 1.0;
  for (int c = 0; c < m->dim; ++c)
    basis[c + 1] = (x[c] - m->x[m->dim * node + c]) / size;
}

/* Matrix of the normal equations of the fit, the lower triangle: G[p*p]. */
static void normal_equations(const space_recovery *s, int node, int n,
                             double size, double *G) {
  const int p = s->d->mesh->dim + 1;
  double basis[MAX_BASIS];
  CLEAR(G, p * p);
  for (int k = 0; k < n; ++k) {
    basis_at(s, node, k, size, basis);
    for (int j = 0; j < p; ++j)
      for (int i = j; i < p; ++i) G[i + p * j] += basis[i] * basis[j];
  }
}

/* L[p*p] = G = L L', p <= MAX_BASIS; 1 if the points of the fit span the space.
 * For so small a matrix a library call costs more than the arithmetic. */
static int factor(int p, const double *G, double *L) {
  for (int j = 0; j < p; ++j)
    for (int i = j; i < p; ++i) {
      double sum = G[i + p * j];
      for (int k = 0; k < j; ++k) sum -= L[i + p * k] * L[j + p * k];
      if (i == j && !(sum > FLAT * G[i + p * i])) return 0;
      L[i + p * j] = i == j ? sqrt(sum) : sum / L[j + p * j];
    }
  return 1;
}

/* g[p], G g = (1, 0, ...): the value at the node is g'rhs. */
static void value_weights(int p, const double *L, double *g) {
  for (int i = 0; i < p; ++i) {
    g[i] = i == 0 ? 1.0 : 0.0;
    for (int k = 0; k < i; ++k) g[i] -= L[i + p * k] * g[k];
    g[i] /= L[i + p * i];
  }
  for (int i = p; i-- > 0;) {
    for (int k = i + 1; k < p; ++k) g[i] -= L[k + p * i] * g[k];
    g[i] /= L[i + p * i];
  }
}

/* weight[n]: the value at the node is the sum of weights times those of its
 * patch of n elements; the mean if the fit is not determined. */
static void fit(const space_recovery *s, int node, int n, double *weight) {
  const int p = s->d->mesh->dim + 1;
  const double size = patch_size(s, node, n);
  double G[MAX_BASIS * MAX_BASIS], L[MAX_BASIS * MAX_BASIS];
  double g[MAX_BASIS] = {1.0 / n}, basis[MAX_BASIS];
  normal_equations(s, node, n, size, G);
  if (n > p && factor(p, G, L)) value_weights(p, L, g);
  for (int k = 0; k < n; ++k) {
    weight[k] = 0.0;
    basis_at(s, node, k, size, basis);
    for (int j = 0; j < p; ++j) weight[k] += g[j] * basis[j];
  }
}

/* Sum over n elements; q[nq*n_elem], value[nq]. */
static void add_up(int n, const int *elem, const double *weight, int nq,
                   const double *q, double *value) {
  for (int i = 0; i < nq; ++i) value[i] = 0.0;
  for (int k = 0; k < n; ++k) {
    const double *t = q + (size_t)nq * elem[k];
    for (int i = 0; i < nq; ++i) value[i] += weight[k] * t[i];
  }
}

/* Room for n elements; *have so far. */
static status grow(fit_weights *w, size_t *have, size_t n) {
  const size_t all = n + n / 2;
  int *elem = memory_resize(w->elem, *have, all, sizeof *elem);
  if (elem == NULL) RAISE(ERR_MEMORY, "memory exhausted: %zu patches", all);
  w->elem = elem;
  double *weight = memory_resize(w->weight, *have, all, sizeof *weight);
  if (weight == NULL) RAISE(ERR_MEMORY, "memory exhausted: %zu patches", all);
  w->weight = weight;
  *have = all;
  return OK;
}

/* The patch and weights of a region. */
static status keep_region(space_recovery *s, int region, fit_weights *w) {
  size_t have = 0;
  PASS_NEW(w->start, s->d->mesh->n_node + 1);
  for (int i = 0; i < s->d->mesh->n_node; ++i) {
    const int n = gather(s, i, region);
    const size_t at = w->start[i], next = at + n;
    if (next > have) PASS(grow(w, &have, next));
    w->start[i + 1] = (int)next;
    if (n == 0) continue;
    COPY(w->elem + at, s->patch, n);
    fit(s, i, n, w->weight + at);
  }
  return OK;
}

status space_keep(space_recovery *s) {
  if (s->kept != NULL) return OK;
  OWNS(s);
  PASS_NEW(s->kept, s->n_region);
  for (int k = 0; k < s->n_region; ++k) PASS(keep_region(s, k, &s->kept[k]));
  return OK;
}

int space_regions(const space_recovery *s) { return s->n_region; }

int space_region(const space_recovery *s, int elem_id) {
  return s->region[elem_id];
}

void space_recover(space_recovery *s, int region, int nq, const double *q,
                   double *value) {
  const fit_weights *w = s->kept != NULL ? &s->kept[region] : NULL;
  for (int i = 0; i < s->d->mesh->n_node; ++i, value += nq) {
    const int n =
        w != NULL ? w->start[i + 1] - w->start[i] : gather(s, i, region);
    if (n == 0) continue;
    if (w == NULL) fit(s, i, n, s->weight);
    add_up(n, w != NULL ? w->elem + w->start[i] : s->patch,
           w != NULL ? w->weight + w->start[i] : s->weight, nq, q, value);
  }
}

/* ---- the estimate -------------------------------------------------------- */

static double energy_product(int ns, const double *S, const double *a,
                             const double *b) {
  double sum = 0.0;
  for (int j = 0; j < ns; ++j)
    for (int i = 0; i < ns; ++i) sum += a[i] * S[i + ns * j] * b[j];
  return sum;
}

static size_t at_section(const space_recovery *s, int elem_id) {
  return (size_t)(s->d->ns * s->d->ns) * s->d->section_id[elem_id];
}

const double *space_compliance_of(const space_recovery *s, int elem_id) {
  return s->compliance + at_section(s, elem_id);
}

/* Adds a S b and b S b. */
static inline void add_products(int ns, const double *S, const double *a,
                                const double *b, double *sum) {
  for (int j = 0; j < ns; ++j) {
    double t = 0.0;
    for (int i = 0; i < ns; ++i) t += S[i + ns * j] * b[i];
    sum[0] += t * a[j];
    sum[1] += t * b[j];
  }
}

/* d[ns] of a field at node v less that of the element; added to all[ns]. */
static inline void difference(int ns, const space_field *f, int elem_id, int v,
                              double *d, double *all) {
  const double *node = f->node + (size_t)ns * v;
  const double *own = f->element + (size_t)ns * elem_id;
  for (int i = 0; i < ns; ++i) {
    d[i] = node[i] - own[i];
    all[i] += d[i];
  }
}

/* sum[2] += the products at n vertices and of their sums; n, ns constant. */
static inline void find_products(const space_recovery *s, const double *S,
                                 int elem_id, const space_field *a,
                                 const space_field *b, const int n,
                                 double *sum) {
  const int ns = n == 3 ? 4 : 6, *v = s->d->mesh->elem + n * elem_id;
  double da[MAX_NS], db[MAX_NS];
  double all_a[MAX_NS] = {0.0}, all_b[MAX_NS] = {0.0};
  for (int k = 0; k < n; ++k) {
    difference(ns, a, elem_id, v[k], da, all_a);
    difference(ns, b, elem_id, v[k], db, all_b);
    add_products(ns, S, da, db, sum);
  }
  add_products(ns, S, all_a, all_b, sum);
}

static double product_by(const space_recovery *s, const double *S, int elem_id,
                         const space_field *a, const space_field *b,
                         double *square) {
  const int vertices = s->d->mesh->dim + 1;
  const double share = s->measure[elem_id] / (vertices * (vertices + 1));
  double sum[2] = {0.0};
  if (vertices == 3)
    find_products(s, S, elem_id, a, b, 3, sum);
  else
    find_products(s, S, elem_id, a, b, 4, sum);
  *square = share * sum[1];
  return share * sum[0];
}

double space_product(const space_recovery *s, int elem_id, const space_field *a,
                     const space_field *b, double *square) {
  return product_by(s, space_compliance_of(s, elem_id), elem_id, a, b, square);
}

/* The part of the change of volume that is averaged in a section, -. */
static double share_in(const domain *d, int section) {
  const cluster_set *c = d->cluster;
  for (int k = 0; c != NULL && k < c->n; ++k)
    if (d->section_id[c->elem[c->start[k]]] == section) return c->share[k];
  return 0.0;
}

/* S[16] of the elasticity E[16] without c v of the head of this file. */
static void leave_hoop(const double *E, double share, double *S) {
  double c[4], v[4];
  cluster_hoop(share, v);
  const double size = energy_product(4, E, v, v);
  COPY(c, S + 8, 4);
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i)
      S[i + 4 * j] += size * c[i] * c[j] - v[i] * c[j] - c[i] * v[j];
}

status space_moduli(space_recovery *s) {
  const int square = s->d->ns * s->d->ns;
  for (int i = 0; i < s->n_section; ++i)
    PASS(space_compliance(s->d, i, s->compliance + square * i));
  COPY(s->of_error, s->compliance, square * s->n_section);
  for (int i = 0; i < s->n_section; ++i)
    if (s->d->kin[i] == AXISYMMETRIC)
      leave_hoop(s->d->E + 16 * i, share_in(s->d, i), s->of_error + 16 * i);
  return OK;
}

/* Squares of error and norm of one region added to out; eta or NULL. */
static void add_region(space_recovery *s, int region, const double *sigma,
                       double *eta, space_error *out) {
  const domain *d = s->d;
  const space_field own = {sigma, s->recovered};
  space_recover(s, region, d->ns, sigma, s->recovered);
  for (int e = 0; e < d->mesh->n_elem; ++e) {
    const double *t = sigma + (size_t)d->ns * e;
    if (space_region(s, e) != region) continue;
    double square;
    product_by(s, s->of_error + at_section(s, e), e, &own, &own, &square);
    square = fmax(square, 0.0);
    out->error += square;
    out->norm +=
        s->measure[e] * energy_product(d->ns, space_compliance_of(s, e), t, t);
    if (eta != NULL) eta[e] = sqrt(square);
  }
}

status space_estimate(space_recovery *s, const double *sigma, double *eta,
                      space_error *out) {
  *out = (space_error){0.0, 0.0, 0.0};
  PASS(space_moduli(s));
  for (int region = 0; region < s->n_region; ++region)
    add_region(s, region, sigma, eta, out);
  double total = out->error + out->norm;
  out->relative = total > 0.0 ? sqrt(out->error / total) : 0.0;
  out->error = sqrt(out->error);
  out->norm = sqrt(out->norm);
  return OK;
}
