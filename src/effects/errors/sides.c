/*
 * Sides of the border of the bodies: what loads give there, and what the stress
 * across those that nothing holds or touches has more or less. A mesh of few
 * elements may have one and the same stress everywhere, as that of a layer
 * between plates: what is recovered from it is the same too and tells no error,
 * but those sides do. Nor does it tell of an obstacle between the nodes.
 */
#include "base/base.h"
#include "effects/shared.h"

#include <cblas.h>

/* Side of an element that is a face of the mesh. */
static int side_of(const mesh *m, int face) {
  const int dim = m->dim, first = (dim + 1) * m->face_elem[face];
  int id = first - 1, same = 0;
  while (same < dim && ++id < first + dim + 1) {
    int v[3];
    mesh_side_nodes(m, id, v);
    same = 0;
    for (int i = 0; i < dim; ++i)
      for (int k = 0; k < dim; ++k) same += v[i] == m->face[dim * face + k];
  }
  return id;
}

/* to[dim] of a side. */
static void add_load(const run *r, const load *l, int side, side_load *to) {
  int v[3];
  mesh_side_nodes(r->msh, side, v);
  for (int a = 0; a < r->msh->dim; ++a) {
    const double value = load_at_node(l, r->msh, r->step, v[a], r->now.t);
    *(l->kind == LOAD_PRESSURE ? &to[a].pressure
                               : &to[a].traction[l->component]) += value;
  }
}

status side_loads_new(const run *r, int n, const int *side, side_load **out) {
  const mesh *m = r->msh;
  const int dim = m->dim;
  OWNED_NEW(int, row, (dim + 1) * m->n_elem);
  PASS_NEW(*out, dim * n);
  for (int k = 0; k < n; ++k) row[side[k]] = k + 1;
  for (EACH(const load, l, r->step->loads.item, r->step->loads.n)) {
    const mesh_group *g = &m->group[l->group_id];
    if (l->kind != LOAD_PRESSURE && l->kind != LOAD_TRACTION) continue;
    for (int k = 0; k < g->n_item; ++k) {
      const int of = side_of(m, g->item_id[k]), at = row[of];
      if (at > 0) add_load(r, l, of, *out + dim * (at - 1));
    }
  }
  return OK;
}

/* ---- free sides ---------------------------------------------------------- */

/* Sides with all nodes in the group are none. */
static status take(const mesh *m, int group_id, int n, const int *side,
                   unsigned char *taken) {
  if (group_id < 0) return OK;
  const mesh_group *g = &m->group[group_id];
  OWNED_NEW(unsigned char, in, m->n_node);
  for (int k = 0; k < g->n_node; ++k) in[g->node_id[k]] = 1;
  for (int k = 0; k < n; ++k) {
    int v[3], inside = 0;
    mesh_side_nodes(m, side[k], v);
    for (int a = 0; a < m->dim; ++a) inside += in[v[a]];
    if (inside == m->dim) taken[k] = 1;
  }
  return OK;
}

static status take_pair(const mesh *m, const surface_pair *p, int n,
                        const int *side, unsigned char *taken) {
  PASS(take(m, p->slave_id, n, side, taken));
  return take(m, p->master_id, n, side, taken);
}

static status take_all(const run *r, int n, const int *side,
                       unsigned char *taken) {
  const mesh *m = r->msh;
  for (EACH(const load, l, r->step->loads.item, r->step->loads.n))
    if (l->kind == LOAD_FIXING || l->kind == LOAD_POINT)
      PASS(take(m, l->group_id, n, side, taken));
  for (EACH(const contact, c, r->m->contacts, r->m->n.contact))
    PASS(c->is_pair ? take_pair(m, &c->pair, n, side, taken)
                    : take(m, c->group_id, n, side, taken));
  for (EACH(const tie, t, r->m->ties, r->m->n.tie))
    PASS(take_pair(m, &t->pair, n, side, taken));
  return OK;
}

/* Its outward normal n[dim], which falls from the node across at the greatest
 * rate; 0 on the axis. */
static void normal_of(const run *r, int side, double n[3]) {
  const mesh *m = r->msh;
  const int dim = m->dim, elem = side / (dim + 1);
  const int *w = m->elem + (dim + 1) * elem;
  double g[12], from_axis = 0.0;
  int v[3], far = 0, sum = 0;
  mesh_side_nodes(m, side, v);
  for (int a = 0; a <= dim; ++a) sum += w[a];
  for (int a = 0; a < dim; ++a) {
    sum -= v[a];
    from_axis = fmax(from_axis, fabs(m->x[dim * v[a]]));
  }
  while (w[far] != sum) ++far;
  mesh_elem_gradients(m, elem, g);
  for (int c = 0; c < dim; ++c) n[c] = -g[dim * far + c];
  const int on_axis =
      r->body.d.kin[r->body.d.section_id[elem]] == AXISYMMETRIC &&
      from_axis == 0.0;
  cblas_dscal(dim, on_axis ? 0.0 : 1.0 / cblas_dnrm2(dim, n, 1), n, 1);
}

/* Square of the stress across a side less its mean load, Pa^2. */
static double across(const run *r, int side, const side_load *loads) {
  static const int voigt[2][3][3] = {{{0, 3}, {3, 1}},
                                     {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}}};
  const int dim = r->msh->dim;
  const double *sigma =
      r->result.stress + (size_t)r->m->ns * (side / (dim + 1));
  double n[3], square = 0.0;
  normal_of(r, side, n);
  for (int i = 0; i < dim; ++i) {
    double t = 0.0;
    for (int j = 0; j < dim; ++j) t += sigma[voigt[dim - 2][i][j]] * n[j];
    for (int a = 0; a < dim; ++a)
      t -= (loads[a].traction[i] - loads[a].pressure * n[i]) / dim;
    square += t * t;
  }
  return square;
}

status free_sides_energy(const run *r, int n, const int *side, double *energy) {
  const domain *d = &r->body.d;
  OWNED_NEW(unsigned char, taken, n);
  OWNED_OF(side_load, loads, side_loads_new(r, n, side, &loads));
  *energy = 0.0;
  PASS(take_all(r, n, side, taken));
  for (int k = 0; k < n; ++k) {
    const int elem = side[k] / (r->msh->dim + 1);
    const double *E = d->E + (size_t)d->ns * d->ns * d->section_id[elem];
    if (!taken[k])
      *energy += across(r, side[k], loads + r->msh->dim * k) / E[0] *
                 element_weight(d, elem);
  }
  return OK;
}

/* ---- curved surfaces ----------------------------------------------------- */

static const double SMOOTH = 0.86; /* -, cosine between faces of a surface */

status smooth_faces_new(const mesh *m, smooth_faces *r) {
  return number_places(m->n_node, (size_t)m->dim * m->n_face, m->face, m->dim,
                       &r->start, &r->face);
}

void smooth_mirror(int dim, const unsigned char *held, const double *own,
                   double *n) {
  int n_held = 0;
  for (int c = 0; c < dim; ++c) n_held += held[c];
  for (int c = 0; c < dim && n_held < dim; ++c)
    if (held[c] && 1.0 - 2.0 * own[c] * own[c] >= SMOOTH) n[c] = 0.0;
}

/* Sets plane[dim] of the normals of the planes that hold a node which its own
 * surface holds too, by their faces. */
static void find_planes(const run *r, const smooth_faces *rings, int node,
                        unsigned char *plane) {
  const mesh *m = r->msh;
  const int dim = m->dim;
  for (size_t k = rings->start[node]; k < rings->start[node + 1]; ++k) {
    const int face = rings->face[k];
    double n[3];
    int held[3] = {1, 1, 1}, n_held = 0;
    if (m->face_other[face] >= 0) continue;
    mesh_face_normal(m, face, n);
    for (int c = 0; c < dim; ++c) {
      for (int i = 0; i < dim; ++i)
        held[c] &= r->body.d.fixed[dim * m->face[dim * face + i] + c];
      n_held += held[c];
    }
    for (int c = 0; n_held < dim && c < dim; ++c)
      plane[c] |= held[c] && 1.0 - fabs(n[c]) < 1e-9;
  }
}

void smooth_normal(const run *r, const smooth_faces *rings, int node,
                   const double *own, double *n) {
  const mesh *m = r->msh;
  const unsigned char *held = r->body.d.fixed + m->dim * node;
  unsigned char plane[3] = {0};
  int n_held = 0;
  CLEAR(n, 3);
  for (int c = 0; c < m->dim; ++c) n_held += held[c];
  if (n_held == m->dim) {
    find_planes(r, rings, node, plane);
    held = plane;
  }
  for (size_t k = rings->start[node]; k < rings->start[node + 1]; ++k) {
    const int face = rings->face[k];
    double other[3] = {0.0};
    if (m->face_other[face] >= 0) continue;
    const double measure = mesh_face_normal(m, face, other);
    /* exact for a circle; its triangles are alike */
    if (dot(m->dim, own, other) >= SMOOTH)
      add_scaled(m->dim, m->dim == 2 ? 1.0 / measure : measure, other, n);
  }
  smooth_mirror(m->dim, held, own, n);
  make_unit(m->dim, n);
}

void smooth_bulge(const run *r, const smooth_faces *rings, int face,
                  const int *v, double *out) {
  const mesh *m = r->msh;
  double own[3] = {0.0}, n[2][3], turn = 0.0, chord = 0.0, size = 0.0;
  mesh_face_normal(m, face, own);
  for (int k = 0; k < 2; ++k) smooth_normal(r, rings, v[k], own, n[k]);
  for (int c = 0; c < m->dim; ++c) {
    const double d = m->x[m->dim * v[1] + c] - m->x[m->dim * v[0] + c];
    turn += 0.5 * (n[1][c] - n[0][c]) * d;
    chord = hypot(chord, d);
    out[c] = n[0][c] + n[1][c];
    size = hypot(size, out[c]);
  }
  turn /= chord; /* the sine of half the angle of an arc */
  const double height =
      0.5 * chord * turn / (1.0 + sqrt(fmax(0.0, 1.0 - turn * turn)));
  for (int c = 0; c < m->dim; ++c)
    out[c] *= fabs(turn) > 1e-9 && size > 0.0 ? height / size : 0.0;
}

/* ---- obstacles between the nodes ----------------------------------------- */

/* A face of a contact; of its nodes: */
typedef struct entered_face {
  const run *r;
  const contact_pair *p;
  const double *x[3], *u[3]; /* borrowed */
  double out[3][3];          /* of edges a, b to a surface, at a + b - 1, m */
  double n[3][3];            /* normals */
  double more[3];            /* the gap has more than the obstacle gives, m */
  double deep[3];            /* they are in the obstacle, m */
  int moves;                 /* 1: contact alone holds one along its normal */
} entered_face;

/* How deep the obstacle is at the point of b[dim] beyond that at nodes, m. */
static double depth_at(const entered_face *f, const double *b) {
  const int dim = f->r->msh->dim;
  double x[3] = {0.0}, n[3] = {0.0}, free = 0.0;
  for (int i = 0; i < dim; ++i) {
    add_scaled(dim, b[i], f->x[i], x);
    for (int k = 0; k < i; ++k)
      add_scaled(dim, 4.0 * b[i] * b[k], f->out[i + k - 1], x);
    add_scaled(dim, b[i], f->n[i], n);
    free += b[i] * (f->more[i] + f->deep[i] - dot(dim, f->n[i], f->u[i]));
  }
  make_unit(dim, n);
  return -obstacle_gap(f->p->support, dim, x, n, f->r->now.t) - free;
}

/* Where it is deepest, from the best point of a lattice on, m. */
static double deepest(const entered_face *f) {
  enum { PIECES = 8, HALVINGS = 24 };
  const int dim = f->r->msh->dim;
  double b[3] = {0.0}, most = -HUGE_VAL, size = 1.0 / PIECES;
  for (int i = 0; i <= PIECES; ++i)
    for (int j = 0; j <= (dim == 3 ? PIECES - i : 0); ++j) {
      const double rest = size * (PIECES - i - j);
      const double at[] = {size * i, dim == 3 ? size * j : rest, rest};
      const double depth = depth_at(f, at);
      if (!(depth > most)) continue;
      most = depth;
      COPY(b, at, dim);
    }
  for (int k = 0; k < HALVINGS; ++k, size *= 0.5)
    for (int axis = 0; axis < dim * dim; ++axis) {
      double at[] = {b[0], b[1], b[2]};
      at[axis % dim] -= size;
      at[axis / dim] += size;
      const double depth = at[axis % dim] < 0.0 ? most : depth_at(f, at);
      if (!(depth > most)) continue;
      most = depth;
      COPY(b, at, dim);
    }
  return most;
}

/* 1: contact alone holds contact node q along its normal. */
static int is_free(const run *r, int q) {
  const double *R;
  const contact_problem *cp = &r->problem.cp;
  const int k = condensed_motions(r->c, &R);
  for (int c = 0; c < k && q < r->nodes.n; ++c)
    if (fabs(R[cp->dim * q + (size_t)cp->m * c]) > CONTACT_NO_LEVER) return 1;
  return 0;
}

/* Bulges of the face, which the gap of a formula is at; 1: an obstacle that
 * the surface of a hollow may pass is not seen by its chords. */
static int is_hollow(const smooth_faces *rings, int face, const double *own,
                     entered_face *f) {
  const mesh *m = f->r->msh;
  const int *v = m->face + m->dim * face;
  const int formula = f->p->support->shape == OBSTACLE_GAP;
  for (int i = 0; i < m->dim; ++i)
    for (int k = 0; k < i; ++k) {
      const int ends[2] = {v[k], v[i]};
      double *out = f->out[i + k - 1];
      smooth_bulge(f->r, rings, face, ends, out);
      if (formula) continue;
      if (dot(m->dim, out, own) < 0.0) return 1;
      CLEAR(out, 3);
    }
  return 0;
}

/* where[n_node] of contact nodes, or -1. */
static void set_face(const run *r, int id, int face, const int *where,
                     const double *own, entered_face *f) {
  const mesh *m = r->msh;
  const int dim = m->dim, *v = m->face + dim * face;
  for (int i = 0; i < dim; ++i) {
    const int q = where[v[i]];
    const int is = q >= 0 && r->surface->contact_id[q] == id;
    f->moves |= is && is_free(r, q);
    f->x[i] = m->x + dim * v[i];
    f->u[i] = r->now.u + dim * v[i];
    COPY(f->n[i], is ? r->surface->frame + dim * dim * q : own, dim);
    const double gap =
        obstacle_gap(f->p->support, dim, f->x[i], f->n[i], r->now.t);
    if (is && q < r->nodes.n && isfinite(gap))
      f->more[i] = r->problem.gap[q] - gap;
    f->deep[i] = fmax(0.0, dot(dim, f->n[i], f->u[i]) - gap - f->more[i]);
  }
}

/* A rigid body that enters a half space by a depth over a length in the plane,
 * or over a square in space. */
static double energy_of(const run *r, int face, double depth) {
  const mesh *m = r->msh;
  const domain *d = &r->body.d;
  const int elem = m->face_elem[face], *v = m->face + m->dim * face;
  double normal[3];
  double width = r->faces.face_weight[face];
  const double measure = mesh_face_normal(m, face, normal);
  if (m->dim == 3) width *= sqrt(measure);
  if (r->faces.input.axisymmetric)
    width *= M_PI * (m->x[2 * v[0]] + m->x[2 * v[1]]);
  return 0.5 * d->E[(size_t)d->ns * d->ns * d->section_id[elem]] * width *
         depth * depth;
}

/* 1: it may be between nodes that it does not touch. */
static int may_enter(const run *r, int id) {
  const obstacle *o = r->faces.pairs[id].support;
  return o != NULL && !r->m->contacts[id].force.given &&
         o->shape != OBSTACLE_PLANE && o->shape != OBSTACLE_CONFORMING &&
         (o->shape != OBSTACLE_GAP || (quantity_variables(&o->gap) & 7u) != 0);
}

/* Adds those of a contact; force: the sum of all, N. */
static void add_entered(const run *r, int id, double force, const int *where,
                        const smooth_faces *rings, double *energy) {
  const mesh *m = r->msh;
  const mesh_group *g = r->faces.pairs[id].group;
  for (int i = 0; i < g->n_item; ++i) {
    const int face = g->item_id[i];
    entered_face f = {.r = r, .p = &r->faces.pairs[id]};
    double own[3] = {0.0};
    mesh_face_normal(m, face, own);
    if (is_hollow(rings, face, own, &f)) continue;
    set_face(r, id, face, where, own, &f);
    const double depth = deepest(&f);
    if (depth > 16 * DBL_EPSILON * m->size)
      energy[m->face_elem[face]] +=
          fmin(energy_of(r, face, depth), f.moves ? force * depth : HUGE_VAL);
  }
}

status entered_energy(const run *r, double *energy) {
  const mesh *m = r->msh;
  double force = 0.0;
  int any = 0;
  for (int k = 0; k < r->m->n.contact && r->surface != NULL; ++k)
    any |= may_enter(r, k);
  if (!any) return OK;
  OWNED_NEW(int, where, m->n_node);
  OWNED_PARTS(smooth_faces, rings, smooth_faces_new(m, &rings));
  for (int i = 0; i < m->n_node; ++i) where[i] = -1;
  for (int q = 0; q < r->surface->n; ++q) where[r->surface->node_id[q]] = q;
  for (int q = 0; q < r->nodes.n; ++q) force += fabs(r->now.rc[m->dim * q]);
  for (int k = 0; k < r->m->n.contact; ++k)
    if (may_enter(r, k)) add_entered(r, k, force, where, &rings, energy);
  return OK;
}
