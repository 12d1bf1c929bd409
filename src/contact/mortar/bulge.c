/*
 * What a curved surface has beyond its flat faces, m: over a face the quadratic
 *   sum over edges ij of 4 phi_i phi_j s_ij,
 * s the height of an arc over the edge, h^2/8R for a circle or sphere. Its
 * slope is the smaller one of those of the tangent planes at the ends.
 * The tangent plane at a node is that of the quadratic nearest to the nodes
 * around it, and to their images behind planes of symmetry. A surface of flat
 * parts stays flat at its kinks: no edge bends next to a flat node, nor one
 * alone. All is that of the mesh at rest: what bends a plane is a displacement,
 * which is linear over a face.
 */
#include "base/base.h"
#include "contact/mortar/partner.h"

#include <lapacke.h>

/* Slopes, -, from which on an edge is no edge of a curve; of rounding. */
static const double sharp = 0.3, flat = 1e-9;

/* Coefficients of a quadratic, by dimension; most nodes to fit. */
enum { TERMS = 5, MOST = 60, ROWS = 2 * MOST, STEPS = 3 * ROWS };
enum { FITS = 1, FLAT = 2, AT_FLAT = 4 };
static const int terms_of[4] = {0, 0, 2, TERMS};

typedef struct shape {
  const mortar_input *in;
  const int *face;      /* faces of the surface */
  double *normal;       /* [dim*n_node] */
  unsigned char *state; /* [n_node] of the enum */
  int *bends;           /* [n_node] edges there that bend */
  double *bulge;        /* of bulge_find */
  size_t *start;        /* of mortar_around */
  int *around;
  int ring[MOST], n; /* the nodes around one, itself first */
} shape;

static const int *nodes_of(const shape *s, int k) {
  return mortar_nodes(s->in, s->face[k]);
}

static int face_plane(const shape *s, int k, facet *f) {
  return facet_set(s->in->mesh->dim, nodes_of(s, k), s->in->mesh->x, f) == 0;
}

static void step(const shape *s, int from, int to, double *e) {
  const mesh *m = s->in->mesh;
  vector_of(m->dim, m->x + m->dim * from, m->x + m->dim * to, e);
}

static status find_around(shape *s, int n) {
  const int dim = s->in->mesh->dim, n_node = s->in->mesh->n_node;
  PASS_NEW_ALL(OF(s->normal, dim * n_node), OF(s->state, n_node),
               OF(s->bends, n_node));
  return mortar_around(s->in, n, s->face, &s->start, &s->around);
}

static void add_to_ring(shape *s, int node) {
  for (int i = 0; i < s->n; ++i)
    if (s->ring[i] == node) return;
  if (s->n < MOST) s->ring[s->n++] = node;
}

/* Bit c: a plane of symmetry across direction c has the node. */
static unsigned planes_of(const shape *s, int node) {
  return s->in->mirrored == NULL ? 0 : s->in->mirrored[node];
}

/* Steps from ring[0] to the others, and to their images behind the planes of
 * symmetry there: d[STEPS]; their number. */
static int find_steps(const shape *s, double *d) {
  const int dim = s->in->mesh->dim;
  int n = 0;
  for (int i = 1; i < s->n; ++i) {
    const unsigned planes =
        planes_of(s, s->ring[0]) & ~planes_of(s, s->ring[i]);
    for (unsigned image = 0; image < 1u << dim && n < ROWS; ++image) {
      if ((image & ~planes) != 0) continue;
      double *e = d + 3 * n++;
      step(s, s->ring[0], s->ring[i], e);
      for (int c = 0; c < dim; ++c)
        if (image >> c & 1) e[c] = -e[c];
    }
  }
  return n;
}

/* The mean normal of the faces at a node, for a start, with axes across it in
 * f; 0: one of them is too far from it. */
static int start_normal(const shape *s, int node, facet *f) {
  const int dim = s->in->mesh->dim;
  double mean[3] = {0.0, 0.0, 0.0};
  for (int pass = 0; pass < 2; ++pass) {
    for (size_t a = s->start[node]; a < s->start[node + 1]; ++a) {
      if (!face_plane(s, s->around[a], f)) return 0;
      if (pass == 0)
        add_scaled(dim, f->measure, f->normal, mean);
      else if (dot(dim, mean, f->normal) <
               cos(atan(sharp)) * sqrt(dot(dim, mean, mean)))
        return 0;
    }
    for (int c = 0; c < dim; ++c)
      if (planes_of(s, node) >> c & 1) mean[c] = 0.0;
  }
  memcpy(f->normal, mean, sizeof mean);
  return 1;
}

static void add_faces_of(shape *s, int node) {
  const int dim = s->in->mesh->dim;
  for (size_t a = s->start[node]; a < s->start[node + 1]; ++a)
    for (int k = 0; k < dim; ++k) add_to_ring(s, nodes_of(s, s->around[a])[k]);
}

/* The nodes of the faces around a node; in space, where they are too few for a
 * fit, of those around them too, not across sharp edges. */
static void find_ring(shape *s, int node) {
  double steps[STEPS];
  s->n = 0;
  add_to_ring(s, node);
  add_faces_of(s, node);
  if (s->in->mesh->dim == 2 || find_steps(s, steps) > TERMS) return;
  for (int i = 1, end = s->n; i < end; ++i) {
    facet f;
    if (start_normal(s, s->ring[i], &f)) add_faces_of(s, s->ring[i]);
  }
}

/* Slopes of the surface at ring[0] over the axes of f; 0: none is found; -1: it
 * is flat but for rounding. */
static int fit_slopes(const shape *s, const facet *f, double *slope) {
  const int dim = f->dim, n = terms_of[dim];
  double A[ROWS * TERMS], b[ROWS], work[20 * TERMS], steps[STEPS];
  double most = 0.0, size = 0.0;
  lapack_int rank, pivot[TERMS] = {0};
  const int m = find_steps(s, steps);
  for (int i = 0; i < m; ++i)
    size += sqrt(dot(dim, steps + 3 * i, steps + 3 * i)) / m;
  for (int i = 0; i < m; ++i) {
    double x[2] = {0.0, 0.0};
    const double *d = steps + 3 * i;
    const double length = sqrt(dot(dim, d, d)), part = length / size;
    for (int a = 0; a < dim - 1; ++a) x[a] = dot(dim, f->axis[a], d) / length;
    const double row[TERMS] = {x[0], dim == 2 ? x[0] * x[0] * part : x[1],
                               x[0] * x[0] * part, x[0] * x[1] * part,
                               x[1] * x[1] * part};
    for (int k = 0; k < n; ++k) A[m * k + i] = row[k];
    b[i] = dot(dim, f->normal, d) / length;
    most = fmax(most, fabs(b[i]));
  }
  if (m < n) return 0;
  if (!(most > flat)) return -1;
  if (LAPACKE_dgelsy_work(LAPACK_COL_MAJOR, m, n, 1, A, m, b, m, pivot, 1e-6,
                          &rank, work, 20 * TERMS) != 0)
    return 0;
  COPY(slope, b, (dim - 1));
  return rank == n;
}

/* v less its parts along the unit vectors of a base, of length 1. */
static void straighten(int dim, int n, double *const *base, double *v) {
  for (int k = 0; k < n; ++k)
    add_scaled(dim, -dot(dim, base[k], v), base[k], v);
  make_unit(dim, v);
}

/* The normal at a node: that of the quadratic over the plane across itself. */
static void find_normal(shape *s, int node) {
  enum { PASSES = 4 };
  const int dim = s->in->mesh->dim;
  double slope[2];
  facet f;
  if (!start_normal(s, node, &f)) return;
  find_ring(s, node);
  double *const base[] = {f.normal, f.axis[0], f.axis[1]};
  for (int pass = 0; pass < PASSES; ++pass) {
    for (int k = 0; k < dim; ++k) straighten(dim, k, base, base[k]);
    const int found = fit_slopes(s, &f, slope);
    if (pass == 0) s->state[node] = found == 1 ? FITS : found == -1 ? FLAT : 0;
    for (int a = 0; a < dim - 1 && found == 1; ++a)
      add_scaled(dim, -slope[a], f.axis[a], f.normal);
    if (found != 1) break;
  }
  straighten(dim, 0, base, f.normal);
  COPY(s->normal + (size_t)dim * node, f.normal, dim);
}

/* Slope of the surface at a node over its edge e in a face of normal f. */
static double rise(const shape *s, int node, const double *e, const double *f) {
  const int dim = s->in->mesh->dim;
  const double *n = s->normal + (size_t)dim * node;
  const double up = dot(dim, n, f);
  const double t =
      up > 0.0 ? -dot(dim, n, e) / (up * sqrt(dot(dim, e, e))) : 0.0;
  return fabs(t) > flat && fabs(t) < sharp ? t : 0.0;
}

/* Of a circle whose slope over a chord is t at its ends. */
static double arc_height(double chord, double t) {
  return 0.5 * chord * t / (1.0 + sqrt(1.0 + t * t));
}

/* s of edge k of a face. First those whose ends have fits that bend the same
 * way are counted at their nodes; second, an edge has it if another one at one
 * of its nodes bends, and an end without a fit has the slope of the other. */
static void set_edge(shape *s, int face, int k, const double *f, int second) {
  const int dim = s->in->mesh->dim, *v = nodes_of(s, face);
  const int i = v[k], j = v[(k + 1) % dim];
  const int i_fits = s->state[i] & FITS, j_fits = s->state[j] & FITS;
  double e[3], back[3];
  if ((s->state[i] | s->state[j]) & (FLAT | AT_FLAT)) return;
  step(s, i, j, e);
  step(s, j, i, back);
  double a = i_fits ? rise(s, i, e, f) : 0.0,
         b = j_fits ? rise(s, j, back, f) : 0.0;
  const int bends = a * b > 0.0, own = bends ? dim - 1 : 0;
  if (!second) {
    s->bends[i] += bends;
    s->bends[j] += bends;
    return;
  }
  if (!i_fits) a = b;
  if (!j_fits) b = a;
  if (a * b > 0.0 && (s->bends[i] > own || s->bends[j] > own))
    s->bulge[(dim == 2 ? 1 : 3) * s->face[face] + k] =
        arc_height(sqrt(dot(dim, e, e)), copysign(fmin(fabs(a), fabs(b)), a));
}

status bulge_find(const mortar_input *in, int n, const int *face,
                  double *bulge) {
  SCRATCH;
  shape s = {.in = in, .face = face, .bulge = bulge};
  const int dim = in->mesh->dim, edges = dim == 2 ? 1 : 3;
  PASS(find_around(&s, n));
  for (int i = 0; i < in->mesh->n_node; ++i)
    if (s.start[i + 1] > s.start[i]) find_normal(&s, i);
  /* Nodes that are fitted to a flat one: at kinks, or at ends of a curve. */
  for (int i = 0; i < s.in->mesh->n_node; ++i) {
    if (!(s.state[i] & FITS)) continue;
    find_ring(&s, i);
    for (int k = 1; k < s.n; ++k)
      if (s.state[s.ring[k]] & FLAT) s.state[i] |= AT_FLAT;
  }
  for (int second = 0; second < 2; ++second)
    for (int i = 0; i < n; ++i) {
      facet f;
      for (int k = 0; k < edges && face_plane(&s, i, &f); ++k)
        set_edge(&s, i, k, f.normal, second);
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
