/*
 * Where a surface has no smooth stress: planes of symmetry, corners of loads
 * and of gaps.
 *
 * Loads of sides that meet: the tractions t, t' of two sides with the normals
 * n, n' belong to one stress where t.n' = t'.n, on a smooth side where t = t'.
 * Elsewhere the stress is another from each direction, or infinite as the
 * logarithm of the distance, and recovered gradients miss it: where a load
 * ends, where a shear ends in a corner.
 *
 * A gap that turns by an angle presses, over an edge of the mesh and in each
 * part of it again, by E/(1 - nu^2)/(2 pi) of the angle more.
 */
#include "base/base.h"
#include "effects/goal/parts.h"

/* Beyond rounding. */
static const double SAME = 1e-6; /* -, of the tractions */

/* Its traction along m[dim], on a side with the normal n[dim]. */
static double along(int dim, const side_load *p, const double *n,
                    const double *m) {
  return dot(dim, p->traction, m) - p->pressure * dot(dim, n, m);
}

int goal_is_torn(int dim, const side_load *p, const double *n,
                 const side_load *q, const double *m, int smooth) {
  double jump = 0.0, size = hypot(p->pressure, q->pressure);
  for (int c = 0; c < dim; ++c) {
    size = hypot(size, hypot(p->traction[c], q->traction[c]));
    jump = hypot(jump, p->traction[c] - q->traction[c]);
  }
  jump = smooth ? hypot(jump, p->pressure - q->pressure)
                : fabs(along(dim, p, n, m) - along(dim, q, m, n));
  return jump > SAME * size;
}

/* ---- planes of symmetry -------------------------------------------------- */

/* 1: a face at a node in the plane is held along its normal, as the node is. */
static int has_held_face(const run *r, int node) {
  const mesh *m = r->msh;
  for (int f = 0; f < m->n_face; ++f) {
    const int *v = m->face + 2 * f;
    if ((v[0] != node && v[1] != node) || m->face_other[f] >= 0) continue;
    for (int c = 0; c < 2; ++c)
      if (r->body.d.fixed[2 * v[0] + c] && r->body.d.fixed[2 * v[1] + c] &&
          fabs(m->x[2 * v[0] + c] - m->x[2 * v[1] + c]) <= 1e-9 * m->size)
        return 1;
  }
  return 0;
}

int goal_is_mirrored(const run *r, int i) {
  const int dim = r->msh->dim;
  int any = 0;
  if (r->faces.input.axisymmetric &&
      r->surface->x[dim * i] <= 1e-9 * r->msh->size)
    return 1;
  for (int a = 1; a < dim; ++a) any |= r->surface->held[dim * i + a];
  return any && (dim == 3 || has_held_face(r, r->surface->node_id[i]));
}

/* ---- corners of the gap -------------------------------------------------- */

/* Of the contact nodes in the plane. */
typedef struct turns {
  double *by;         /* [n] what they press by their corner, Pa */
  double *near, *far; /* [n] sums of its size next to them, and next to these */
  int *edges, *open;  /* [n] of them; those that are */
  double *more;       /* [n] at an end of the surface 2 in a plane of symmetry,
                         which has an edge behind it, or 0; else 1 */
} turns;

/* E/(1 - nu^2) of the plane of an element, Pa. */
static double modulus_of(const domain *d, int elem_id) {
  const double *E = d->E + (size_t)(d->ns * d->ns) * d->section_id[elem_id];
  return E[0] - E[1] * E[1] / E[d->ns + 1];
}

/* An edge between contact nodes q[2]: its slope, then what is at its ends, and
 * next to them. */
static void add_slope(const run *r, const int *q, double modulus, turns *t) {
  const double *x = r->surface->x + 2 * q[0], *y = r->surface->x + 2 * q[1];
  const double slope = (r->problem.gap[q[1]] - r->problem.gap[q[0]]) /
                       hypot(y[0] - x[0], y[1] - x[1]);
  for (int k = 0; k < 2; ++k) {
    t->by[q[k]] += (k == 0 ? slope : -slope) * modulus / (2.0 * M_PI);
    ++t->edges[q[k]];
    t->open[q[k]] += r->result.contact[q[1 - k]] == CONTACT_OPEN;
  }
}

static void mirror(const run *r, int contact_id, turns *t) {
  for (int q = 0; q < r->nodes.n; ++q) {
    if (r->surface->contact_id[q] != contact_id) continue;
    t->more[q] = t->edges[q] > 1 ? 1.0 : goal_is_mirrored(r, q) ? 2.0 : 0.0;
    t->by[q] *= t->more[q];
  }
}

static void add_turn(const int *q, int pass, turns *t) {
  for (int k = 0; k < 2; ++k)
    if (pass == 1)
      t->near[q[k]] += fabs(t->by[q[1 - k]]) * fmax(1.0, t->more[q[k]]);
    else
      t->far[q[k]] += (t->near[q[1 - k]] - fabs(t->by[q[k]])) * t->more[q[k]];
}

static void add_edges(const run *r, const int *where, int contact_id, int pass,
                      turns *t) {
  const mesh_group *of = r->faces.pairs[contact_id].group;
  for (int i = 0; i < of->n_item && !r->m->contacts[contact_id].is_pair; ++i) {
    const int face = of->item_id[i], *v = r->msh->face + 2 * face;
    const int q[2] = {where[v[0]], where[v[1]]};
    if (q[0] < 0 || q[1] < 0) continue;
    if (pass == 0)
      add_slope(r, q, modulus_of(&r->body.d, r->msh->face_elem[face]), t);
    else
      add_turn(q, pass, t);
  }
}

/* 1: closed, with closed edges on both sides, and far sharper than where a few
 * edges away; at an end of the surface by[q] is 0. */
static int is_corner(const run *r, const turns *t, int q) {
  static const double SHARP = 3.0; /* -, of a smooth gap 1, at its bends 2 */
  return r->result.contact[q] != CONTACT_OPEN && t->open[q] == 0 &&
         2.0 * fabs(t->by[q]) > SHARP * t->far[q];
}

status goal_corners(const run *r, const int *where, double *corner) {
  const contact_surface *s = r->surface;
  const int n = r->msh->dim == 2 ? r->nodes.n : 0;
  OWNED_NEW(double, values, 4 * n);
  OWNED_NEW(int, counts, 2 * n);
  turns t = {values, values + n, values + 2 * n,
             counts, counts + n, values + 3 * n};
  for (int k = 0; k < r->m->n.contact && n > 0; ++k) {
    double largest = 0.0;
    for (int pass = 0; pass < 3; ++pass) {
      add_edges(r, where, k, pass, &t);
      if (pass == 0) mirror(r, k, &t);
    }
    for (int q = 0; q < n; ++q)
      if (s->contact_id[q] == k && s->area[q] > 0.0)
        largest = fmax(largest, -r->now.rc[2 * q] / s->area[q]);
    for (int q = 0; q < n && largest > 0.0; ++q)
      if (s->contact_id[q] == k && is_corner(r, &t, q))
        corner[q] = t.by[q] / largest;
  }
  return OK;
}

status goal_sharpest(const run *r, int contact_id, const double *x,
                     double radius, double *most) {
  const contact_surface *s = r->surface;
  *most = 0.0;
  OWNED_OF(int, where, goal_places(r, &where));
  OWNED_NEW(double, corner, r->nodes.n);
  PASS(goal_corners(r, where, corner));
  for (int q = 0; q < r->nodes.n; ++q)
    if (s->contact_id[q] == contact_id && corner[q] > GOAL_CORNER &&
        distance_of(s->dim, x, s->x + s->dim * q) < radius)
      *most = fmax(*most, corner[q]);
  return OK;
}
