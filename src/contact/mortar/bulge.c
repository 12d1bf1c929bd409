/*
 * What a curved surface has beyond its flat faces, m: over a face the quadratic
 *   sum over edges ij of 4 phi_i phi_j s_ij,   s_ij = length (t_i + t_j)/8,
 * t the angles of the edge with the tangent planes at its ends, up to which the
 * surface rises: h^2/8R in the middle of an edge on a circle or sphere, whose
 * normals at the nodes the weights give exactly (Max, J. Graphics Tools 4
 * (1999) 1). The smaller angle counts for both, so that a surface of flat parts
 * stays flat at its kinks. All is that of the mesh at rest: what bends a plane
 * is a displacement, which is linear over a face.
 */
#include "base/base.h"
#include "contact/mortar/partner.h"

/* Angles, -, from which on an edge is no edge of a curve; of rounding. */
static const double sharp = 0.3, flat = 1e-9;

typedef struct shape {
  const mortar_input *in;
  int n;
  const int *face;     /* [n] */
  double *normal;      /* [dim*n_node], no unit vectors */
  long *open;          /* [n_node] 0: its faces go all the way round it */
  unsigned char *bent; /* [n_node] 1: an edge is curved there */
  double *bulge;       /* s of the edges from node k of a face to the next, by
                          face */
} shape;

static void along(const shape *s, int from, int to, double *e) {
  const mesh *m = s->in->mesh;
  for (int c = 0; c < m->dim; ++c)
    e[c] = m->x[m->dim * to + c] - m->x[m->dim * from + c];
}

static void add_normals(const shape *s, int face) {
  const int dim = s->in->mesh->dim, *v = mortar_nodes(s->in, face);
  for (int k = 0; k < dim; ++k) {
    const int next = v[(k + 1) % dim], last = v[(k + 2) % dim];
    double a[3], b[3], n[3];
    along(s, v[k], next, a);
    along(s, v[k], last, b);
    const double size = dot(dim, a, a);
    if (dim == 3) {
      cross(a, b, n);
      s->open[v[k]] += next - last;
    } else {
      n[0] = k == 0 ? a[1] : -a[1];
      n[1] = k == 0 ? -a[0] : a[0];
      s->open[v[k]] += k == 0 ? 1 : -1;
    }
    add_scaled(dim, 1.0 / (dim == 3 ? size * dot(dim, b, b) : size), n,
               s->normal + (size_t)dim * (size_t)v[k]);
  }
}

/* Tangent of the angle by which the surface at a node rises over the edge e
 * that leaves it, in a face with the normal f. */
static double rise(const shape *s, int node, const double *e, const double *f) {
  const int dim = s->in->mesh->dim;
  const double *n = s->normal + (size_t)dim * (size_t)node;
  const double up = dot(dim, n, f);
  const double t =
      up > 0.0 ? -dot(dim, n, e) / (up * sqrt(dot(dim, e, e))) : 0.0;
  return fabs(t) > flat && fabs(t) < sharp ? t : 0.0;
}

/* The edge from node k of a face: curved where both ends are within the
 * surface; at its rim (second) as far as the other end, if that is bent. */
static void set_edge(const shape *s, int face, int k, const double *f,
                     int second) {
  const int dim = s->in->mesh->dim, *v = mortar_nodes(s->in, face);
  const int i = v[k], j = v[(k + 1) % dim];
  const int at_rim = (s->open[i] != 0) + (s->open[j] != 0);
  double e[3], back[3];
  along(s, i, j, e);
  along(s, j, i, back);
  double a = rise(s, i, e, f), b = rise(s, j, back, f);
  if (second != (at_rim == 1) || (dim == 2 && at_rim == 2)) return;
  if (second && s->open[i] != 0) a = s->bent[j] ? b : 0.0;
  if (second && s->open[j] != 0) b = s->bent[i] ? a : 0.0;
  const double least = a * b > 0.0 ? fmin(fabs(a), fabs(b)) : 0.0;
  s->bulge[(dim == 2 ? 1 : 3) * face + k] =
      copysign(0.25 * sqrt(dot(dim, e, e)) * least, a);
  if (!second && least > 0.0) s->bent[i] = s->bent[j] = 1;
}

static void shape_release(shape *s) { RELEASE(s->normal, s->open, s->bent); }

status bulge_find(const mortar_input *in, int n, const int *face,
                  double *bulge) {
  ENDS_BY(shape_release)
  shape s = {.in = in, .n = n, .face = face, .bulge = bulge};
  const int dim = in->mesh->dim, edges = dim == 2 ? 1 : 3;
  PASS_NEW_ALL(OF(s.normal, dim * in->mesh->n_node),
               OF(s.open, in->mesh->n_node), OF(s.bent, in->mesh->n_node));
  for (int i = 0; i < n; ++i) {
    facet f;
    if (facet_set(dim, mortar_nodes(in, face[i]), in->mesh->x, &f) == 0)
      add_normals(&s, face[i]);
  }
  for (int second = 0; second < 2; ++second)
    for (int k = 0; k < edges * n; ++k) {
      facet f;
      if (facet_set(dim, mortar_nodes(in, face[k / edges]), in->mesh->x, &f) ==
          0)
        set_edge(&s, face[k / edges], k % edges, f.normal, second);
    }
  return OK;
}

double bulge_height(int dim, const double *bulge, int face, const double *phi) {
  if (dim == 2) return 4.0 * phi[0] * phi[1] * bulge[face];
  double sum = 0.0;
  for (int k = 0; k < 3; ++k)
    sum += 4.0 * phi[k] * phi[(k + 1) % 3] * bulge[3 * face + k];
  return sum;
}
