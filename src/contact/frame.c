/*
 * Contact frames: tangents, fixed directions, oblique frames of corners.
 */
#include "contact/parts.h"

#include "base/base.h"

/* Sine of the angle below which normals count as dependent: the condition of
 * the oblique frame is its inverse. */
static const double dependent_sine = 1e-3;

static double normalise(int dim, double *v) {
  double length = sqrt(dot(dim, v, v));
  for (int c = 0; c < dim; ++c) v[c] = length > 0 ? v[c] / length : 0.0;
  return length;
}

double frame_project(int dim, unsigned fixed, double *v) {
  double before = normalise(dim, v);
  if (before <= 0) return 0;
  for (int c = 0; c < dim; ++c)
    if (fixed >> c & 1) v[c] = 0;
  return normalise(dim, v);
}

void frame_tangents(int dim, double *frame) {
  const double *n = frame;
  double *t1 = frame + dim;
  if (dim == 2) {
    t1[0] = -n[1];
    t1[1] = n[0];
    return;
  }
  int axis = fabs(n[0]) > 0.9;
  for (int c = 0; c < dim; ++c) t1[c] = (c == axis) - n[axis] * n[c];
  normalise(dim, t1);
  cross(n, t1, frame + 2 * dim);
}

/* Turn the tangents so that the one nearest to axis c is that axis; its row. */
static int align_tangent(int dim, int c, double *frame) {
  if (dim == 2) return 1;
  double *t1 = frame + dim, *t2 = frame + 2 * dim;
  int row = fabs(t1[c]) >= fabs(t2[c]) ? 1 : 2;
  double *held = frame + row * dim, sign = held[c] < 0 ? -1.0 : 1.0;
  for (int k = 0; k < dim; ++k) held[k] = k == c ? sign : 0.0;
  if (row == 1)
    cross(frame, t1, t2);
  else
    cross(t2, frame, t1);
  return row;
}

static double volume(int dim, const double *m) {
  if (dim == 2) return m[0] * m[3] - m[1] * m[2];
  double c[3];
  cross(m + 3, m + 6, c);
  return dot(3, m, c);
}

int frame_complete(int dim, int n_normal, unsigned fixed, double *frame,
                   unsigned char *held) {
  for (int k = 0; k < dim; ++k) held[k] = 0;
  if (n_normal == 1) {
    frame_tangents(dim, frame);
    for (int c = 0; c < dim; ++c)
      if (fixed >> c & 1) held[align_tangent(dim, c, frame)] = 1;
    return 0;
  }
  if (n_normal < dim) {
    cross(frame, frame + dim, frame + 2 * dim);
    if (normalise(dim, frame + 2 * dim) < dependent_sine) return -1;
    held[2] = fixed != 0;
  }
  return fabs(volume(dim, frame)) < dependent_sine ? -1 : 0;
}

/* Normals nearer than this (45 degrees) are those of one smooth surface. */
static const double smooth_cosine = 0.70710678;

int frame_is_smooth(int dim, const double *a, const double *b) {
  const double cosine = dot(dim, a, b) / sqrt(dot(dim, a, a) * dot(dim, b, b));
  return cosine > smooth_cosine;
}

int frame_is_same(int dim, const double *a, const double *b) {
  return distance_of(dim, a, b) < dependent_sine;
}

void frame_invert(int dim, int orthonormal, const double *frame,
                  double *basis) {
  if (orthonormal) {
    for (int k = 0; k < dim * dim; ++k) basis[k] = frame[k];
    return;
  }
  double det = volume(dim, frame);
  if (dim == 2) {
    basis[0] = frame[3] / det;
    basis[1] = -frame[2] / det;
    basis[2] = -frame[1] / det;
    basis[3] = frame[0] / det;
    return;
  }
  for (int k = 0; k < 3; ++k) {
    cross(frame + 3 * ((k + 1) % 3), frame + 3 * ((k + 2) % 3), basis + 3 * k);
    for (int c = 0; c < 3; ++c) basis[3 * k + c] /= det;
  }
}

/* ---- planes of symmetry ------------------------------------------------- */

/* Of the size of the mesh. */
static const double rounding = 1e-9;

/* Nodes of the mesh in the plane x_c = at, a node not held in it: -1. */
static int held_in_plane(const surface_input *in, int c, double at) {
  const mesh *m = in->mesh;
  int n = 0;
  for (int i = 0; i < m->n_node; ++i) {
    if (fabs(m->x[in->mesh->dim * i + c] - at) > rounding * m->size) continue;
    if (!(in->fixed[i] >> c & 1)) return -1;
    ++n;
  }
  return n;
}

void mirrors_find(const surface_input *in, mirrors *out) {
  const mesh *m = in->mesh;
  for (int c = 0; c < in->mesh->dim; ++c) {
    unsigned all = 1u << c;
    out->low[c] = HUGE_VAL, out->high[c] = -HUGE_VAL;
    for (int i = 0; i < m->n_node; ++i) {
      all &= in->fixed[i];
      out->low[c] = fmin(out->low[c], m->x[in->mesh->dim * i + c]);
      out->high[c] = fmax(out->high[c], m->x[in->mesh->dim * i + c]);
    }
    if (all != 0) continue;
    if (held_in_plane(in, c, out->low[c]) >= in->mesh->dim)
      out->planes |= 1u << 2 * c;
    if (held_in_plane(in, c, out->high[c]) >= in->mesh->dim)
      out->planes |= 2u << 2 * c;
  }
}

/* Length of what is fixed of a unit normal. */
static double fixed_part(int dim, unsigned fixed, const double *n) {
  double square = 0.0;
  for (int c = 0; c < dim; ++c)
    if (fixed >> c & 1) square += n[c] * n[c];
  return sqrt(square);
}

static int has_node(const mesh *m, int face_id, int node_id) {
  for (int k = 0; k < m->dim; ++k)
    if (m->face[m->dim * face_id + k] == node_id) return 1;
  return 0;
}

/* The most that faces at the nodes of a face lean. */
static double most_around(const mesh *m, const mesh_group *g, int face_id,
                          unsigned fixed) {
  double most = 0.0, n[3];
  for (int k = 0; k < g->n_item; ++k)
    for (int a = 0; a < m->dim; ++a) {
      if (!has_node(m, g->item_id[k], m->face[m->dim * face_id + a])) continue;
      mesh_face_normal(m, g->item_id[k], n);
      most = fmax(most, fixed_part(m->dim, fixed, n));
    }
  return most;
}

int mirrors_bend(const mesh *m, const mesh_group *g, int node_id,
                 unsigned fixed, const double *n) {
  /* 2 on a curve of equal edges, 1 on a plane */
  static const double bent = 1.5;
  double most = 0.0;
  for (int k = 0; k < g->n_item; ++k)
    if (has_node(m, g->item_id[k], node_id))
      most = fmax(most, most_around(m, g, g->item_id[k], fixed));
  return most >= bent * fixed_part(m->dim, fixed, n);
}

int mirrors_lean(const surface_input *in, const contact_pair *p, int node_id,
                 const double *normal) {
  static const double told = 1e-6; /* -, of its length: an angle of 1.4e-3 */
  const mesh *m = in->mesh;
  const unsigned fixed = in->fixed[node_id];
  double n[3];
  if (p->support == NULL ||
      !obstacle_normal(p->support, m->dim, &m->x[m->dim * node_id], n))
    return !mirrors_bend(m, p->group, node_id, fixed, normal);
  return 1.0 - frame_project(m->dim, fixed, n) > told;
}

/* Bit c: a plane across direction c has the node. */
static unsigned planes_at(const mirrors *s, const surface_input *in,
                          int node_id) {
  const double *x = &in->mesh->x[(size_t)in->mesh->dim * node_id];
  const double near = rounding * in->mesh->size;
  unsigned at = 0;
  for (int c = 0; c < in->mesh->dim; ++c)
    if (((s->planes >> 2 * c & 1) && x[c] - s->low[c] <= near) ||
        ((s->planes >> 2 * c & 2) && s->high[c] - x[c] <= near))
      at |= 1u << c;
  return at;
}

int mirrors_have(const mirrors *s, const surface_input *in, int node_id) {
  const unsigned held = in->fixed[node_id] & ((1u << in->mesh->dim) - 1);
  return (held & ~planes_at(s, in, node_id)) == 0;
}

void mirrors_mark(const surface_input *in, unsigned char *at) {
  mirrors s = {0};
  mirrors_find(in, &s);
  for (int i = 0; i < in->mesh->n_node; ++i)
    at[i] = (unsigned char)planes_at(&s, in, i);
}
