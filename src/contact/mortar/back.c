/*
 * The back of a slave face: where a line through the face leaves its body on
 * the other side.
 */
#include "contact/mortar/partner.h"

#include "base/base.h"

/* 1: all nodes of the element but the one at "corner" are among w[n]. */
static int has_side(const mesh *m, int elem, int corner, int n, const int *w) {
  const int *v = mesh_elem_nodes(m, elem);
  int shared = 0;
  for (int k = 0; k < (m->dim + 1) * n; ++k)
    shared += k / n != corner && v[k / n] == w[k % n];
  return shared == m->dim;
}

/* Element behind the side of elem opposite to its node "corner", or -1. */
static int element_behind(const partner_search *s, int elem, int corner) {
  const mesh *m = s->in->mesh;
  const int node = mesh_elem_nodes(m, elem)[corner == 0];
  for (size_t i = s->around[node]; i < s->around[node + 1]; ++i) {
    const int other = s->around_elem[i];
    if (other != elem &&
        has_side(m, elem, corner, m->dim + 1, mesh_elem_nodes(m, other)))
      return other;
  }
  return -1;
}

/* The side, by its opposite node, through which the line from x along d leaves
 * an element; how far from x, of the length of d. */
static int leaving_side(const partner_search *s, int elem, const double *x,
                        const double *d, double *far) {
  const int dim = s->in->mesh->dim, *v = mesh_elem_nodes(s->in->mesh, elem);
  mesh now = *s->in->mesh;
  double g[12];
  int corner = -1;
  now.x = (double *)s->in->x;
  mesh_elem_gradients(&now, elem, g);
  for (int a = 0; a <= dim; ++a) {
    const double rate = dot(dim, g + dim * a, d);
    double w[3];
    vector_of(dim, mortar_place(s->in, v[a]), x, w);
    const double at = (1.0 + dot(dim, g + dim * a, w)) / -rate;
    if (!(rate < 0.0) || (corner >= 0 && at >= *far)) continue;
    *far = at;
    corner = a;
  }
  return corner;
}

status partner_is_behind(partner_search *s, int from, const facet *f,
                         const double *x, const partner *p, int *is) {
  const mesh *m = s->in->mesh;
  double d[3], far = 0.0;
  *is = 0;
  if (m->n_elem == 0) return OK;
  for (int c = 0; c < m->dim; ++c) d[c] = p->height * f->normal[c];
  for (int elem = m->face_elem[from], n = 0; n < m->n_elem; ++n) {
    const int corner = leaving_side(s, elem, x, d, &far);
    if (corner < 0 || far > 1.5) return OK; /* p is at 1 */
    *is = has_side(m, elem, corner, m->dim, mesh_face_nodes(m, p->face));
    if (*is) return OK;
    if (s->around == NULL)
      PASS(mesh_node_elements(m, &s->around, &s->around_elem));
    elem = element_behind(s, elem, corner);
    if (elem < 0) {
      *is = far < 1.0;
      return OK;
    }
  }
  return OK;
}
