/*
 * Edges of the contact surface: closed, stuck, curved; where its status
 * changes, or it is closed at its border, where stresses may be infinite. Its
 * nodes along a line.
 */
#include "base/base.h"
#include "effects/goal/parts.h"

/* Integral of the bubble of an edge over a face. */
static double bubble_weight(const run *r, int face) {
  const mesh *m = r->msh;
  const int *v = m->face + m->dim * face;
  double normal[3];
  const double weight =
      mesh_face_normal(m, face, normal) * r->faces.face_weight[face];
  if (m->dim == 3) return weight / 3.0;
  if (!r->faces.input.axisymmetric) return weight * 2.0 / 3.0;
  return weight * 2.0 / 3.0 * M_PI * (m->x[2 * v[0]] + m->x[2 * v[1]]);
}

/* Gradients of the gap along the surface. */
typedef struct gap_slopes {
  double *of;  /* [3*n] at contact nodes, - */
  int *n_face; /* [n] of them round each */
} gap_slopes;

/* g[3] of the linear gap on a face between contact nodes q[dim]; returns its
 * weight, exact for a parabola in the plane; 0: a gap out of reach. */
static double face_slope(const run *r, int face, const int *q, double *g) {
  const mesh *m = r->msh;
  const int dim = m->dim, e = m->face_elem[face], *v = m->elem + (dim + 1) * e;
  double shape[12], normal[3] = {0.0};
  const double measure = mesh_face_normal(m, face, normal);
  CLEAR(g, 3);
  mesh_elem_gradients(m, e, shape);
  for (int i = 0; i < dim; ++i) {
    if (!(r->problem.gap[q[i]] < m->size)) return 0.0;
    for (int a = 0; a <= dim; ++a)
      for (int c = 0; c < dim && v[a] == r->surface->node_id[q[i]]; ++c)
        g[c] += shape[dim * a + c] * r->problem.gap[q[i]];
  }
  add_scaled(dim, -dot(dim, g, normal), normal, g);
  return dim == 2 ? 1.0 / measure : measure;
}

static status gap_slopes_new(const run *r, const int *where, gap_slopes *out) {
  const int dim = r->msh->dim;
  OWNED_NEW(double, weight, r->nodes.n);
  PASS_NEW_ALL(OF(out->of, 3 * r->nodes.n), OF(out->n_face, r->nodes.n));
  for (int k = 0; k < r->m->n.contact && r->nodes.n > 0; ++k) {
    const mesh_group *of = r->faces.pairs[k].group;
    for (int i = 0; i < of->n_item && !r->m->contacts[k].is_pair; ++i) {
      int q[3], all = 1;
      double g[3];
      for (int c = 0; c < dim; ++c) {
        q[c] = where[r->msh->face[dim * of->item_id[i] + c]];
        all = all && q[c] >= 0;
      }
      const double by = all ? face_slope(r, of->item_id[i], q, g) : 0.0;
      for (int c = 0; c < dim && by > 0.0; ++c) {
        weight[q[c]] += by;
        ++out->n_face[q[c]];
        for (int a = 0; a < 3; ++a) out->of[3 * q[c] + a] += by * g[a];
      }
    }
  }
  for (int a = 0; a < 3 * r->nodes.n; ++a)
    if (weight[a / 3] > 0.0) out->of[a] /= weight[a / 3];
  return OK;
}

/* What the gap in the middle of an edge of contact nodes q[2] is more than the
 * mean of its ends: by the gaps of the nodes around, where bodies that fit each
 * other have none that their curvature, which is not known as well, would hide.
 * Beyond an end of the surface in the plane the curvature goes on. */
static double gap_between(const run *r, const gap_slopes *slopes,
                          const int *q) {
  const contact_surface *s = r->surface;
  const int dim = s->dim;
  double d[3], at[2];
  vector_of(dim, s->x + dim * q[0], s->x + dim * q[1], d);
  const double rise = r->problem.gap[q[1]] - r->problem.gap[q[0]];
  for (int k = 0; k < 2; ++k) at[k] = dot(dim, slopes->of + 3 * q[k], d);
  for (int k = 0; k < 2 && dim == 2; ++k)
    if (slopes->n_face[q[k]] == 1) at[k] = 2.0 * rise - at[1 - k];
  return (at[0] - at[1]) / 8.0;
}

/* d[GOAL_PIECES + 1]: the gap along an edge of contact nodes q[2] to an
 * obstacle, along e->n or the normal of the obstacle, less the line through its
 * ends; 0 where it is out of reach, and of a curved body on a smooth obstacle,
 * which hides it. */
static void gap_along(const run *r, const int *q, const contact_edge *e,
                      double *d) {
  const contact_surface *s = r->surface;
  const contact_pair *p = &r->faces.pairs[s->contact_id[q[0]]];
  const int dim = s->dim;
  int finite = 1;
  for (int k = 0; k <= GOAL_PIECES; ++k) {
    double x[3], n[3];
    goal_point_of(dim, s->x + dim * q[0], s->x + dim * q[1], e->out, k, x);
    COPY(n, e->n, 3);
    if (p->obstacle_normal) obstacle_normal(p->support, dim, x, n);
    d[k] = obstacle_gap(p->support, dim, x, n, r->now.t);
    finite &= isfinite(d[k]);
  }
  goal_take_line(d);
  for (int c = 0; c < dim && p->support->shape != OBSTACLE_GAP; ++c)
    finite &= !(fabs(e->out[c]) > 0.0);
  if (!finite) CLEAR(d, GOAL_PIECES + 1);
}

/* Normal of an edge between contact nodes q[2], and its gap at the surface of
 * the body: in the middle, what the gap is else as a parabola. */
static void set_middle(const run *r, const gap_slopes *slopes, const int *q,
                       contact_edge *e) {
  const contact_surface *s = r->surface;
  const contact_pair *p = &r->faces.pairs[s->contact_id[q[0]]];
  const int dim = s->dim;
  double x[3] = {0.0}, d[GOAL_PIECES + 1];
  for (int c = 0; c < dim; ++c) {
    x[c] = 0.5 * (s->x[dim * q[0] + c] + s->x[dim * q[1] + c]);
    e->n[c] = s->frame[dim * dim * q[0] + c] + s->frame[dim * dim * q[1] + c];
  }
  goal_make_unit(dim, e->n);
  if (p->obstacle_normal) obstacle_normal(p->support, dim, x, e->n);
  double out = 0.0;
  for (int c = 0; c < dim; ++c) out = hypot(out, e->out[c]);
  gap_along(r, q, e, d);
  const double more = goal_parabola(d, &e->rough) - d[GOAL_PIECES / 2];
  e->excess = out > 0.0 ? 0.5 * (r->problem.gap[q[0]] + r->problem.gap[q[1]]) +
                              gap_between(r, slopes, q)
                        : obstacle_gap(p->support, dim, x, e->n, r->now.t);
  e->excess += more;
  for (int c = 0; c < dim; ++c)
    e->excess -=
        0.5 * e->n[c] * (r->now.u[dim * e->a + c] + r->now.u[dim * e->b + c]);
  if (!isfinite(e->excess)) e->excess = 0.0;
}

/* The status, and whether and in which sense friction lets the node slide,
 * which a given limit does at open nodes too. */
static int state_of(const run *r, int q) {
  enum { NONE, ONE, OTHER, SENSES };
  const int turned = r->msh->dim == 2 && r->result.slip[q] < 0.0;
  const int sense = !goal_slides(r, q) ? NONE : turned ? OTHER : ONE;
  return SENSES * (int)r->result.contact[q] + sense;
}

/* 1: all nodes v[dim] of a face are closed, or at the front of a crack. */
static int is_whole(const run *r, const int *where, const int *v) {
  int closed = 0, open = 0;
  for (int k = 0; k < r->msh->dim; ++k) {
    const int q = where[v[k]];
    if (q >= 0) ++*(r->result.contact[q] != CONTACT_OPEN ? &closed : &open);
  }
  return closed > 0 && open == 0;
}

/* Edge v[2] of a face. */
static void add_edge(const run *r, const smooth_faces *rings,
                     const gap_slopes *slopes, int face, const int *v,
                     const int *where, goal_surface *s) {
  const number_pair is = number_pair_of(v[0], v[1]);
  const int q[2] = {where[v[0]], where[v[1]]};
  if (q[0] < 0 || q[1] < 0) return;
  contact_edge e = {.a = is.a,
                    .b = is.b,
                    .weight = bubble_weight(r, face),
                    .other = {-1, -1}};
  const contact_status a = r->result.contact[q[0]], b = r->result.contact[q[1]];
  e.closed = a != CONTACT_OPEN && b != CONTACT_OPEN;
  e.stuck = a == CONTACT_STICK && b == CONTACT_STICK;
  smooth_bulge(r, rings, face, v, e.out);
  if (e.closed) set_middle(r, slopes, q, &e);
  if (state_of(r, q[0]) != state_of(r, q[1]))
    s->ends[is.a] = s->ends[is.b] = GOAL_END_OF_CONTACT;
  s->edge[s->n_edge++] = e;
}

/* An edge of a lip between nodes v[2], opposite other[2], of which each has
 * half of the motion: the weight counts twice on one of them; n_q of its nodes
 * are contact nodes q: the others are at the front, where both lips are one. */
static void add_lip_edge(const run *r, const int *v, const int *other, int n_q,
                         const int *q, double weight, goal_surface *s) {
  const int dim = r->msh->dim, turn = v[0] > v[1];
  contact_edge e = {.a = v[turn],
                    .b = v[!turn],
                    .weight = weight,
                    .closed = 1,
                    .stuck = 1,
                    .other = {other[turn], other[!turn]}};
  for (int k = 0; k < n_q; ++k) {
    e.closed &= r->result.contact[q[k]] != CONTACT_OPEN;
    e.stuck &= r->result.contact[q[k]] == CONTACT_STICK;
    for (int c = 0; c < dim; ++c)
      e.n[c] += r->surface->frame[dim * dim * q[k] + c];
  }
  goal_make_unit(dim, e.n);
  s->edge[s->n_edge++] = e;
  if (n_q < 2 || state_of(r, q[0]) == state_of(r, q[1])) return;
  s->ends[e.a] = s->ends[e.b] = GOAL_END_OF_CONTACT;
}

/* Edge a, b of two faces that lie on each other, v[dim] with the contact nodes,
 * w[dim], node by node. */
static void add_lip_edges(const run *r, const int *where, const int *v,
                          const int *w, double weight, goal_surface *s) {
  for (int a = 0; a < r->msh->dim; ++a)
    for (int b = a + 1; b < r->msh->dim; ++b) {
      const int near[2] = {v[a], v[b]}, far[2] = {w[a], w[b]};
      int q[2], n = 0;
      for (int k = 0; k < 2; ++k)
        if (where[near[k]] >= 0) q[n++] = where[near[k]];
      if (n == 0) continue;
      add_lip_edge(r, near, far, n, q, 2.0 * weight, s);
      add_lip_edge(r, far, near, n, q, 0.0, s);
    }
}

static void add_crack(const run *r, int id, const int *where, goal_surface *s) {
  const mesh *m = r->msh;
  const mesh_crack *c = &m->crack[id];
  const contact *of = &r->m->contacts[r->m->mesh.cracks[id].contact_id];
  for (int k = 0; k < c->n; ++k) {
    const int near = (of->pair.slave ? c->plus : c->minus)[k];
    const int *v = m->face + m->dim * near;
    const int *to = m->face + m->dim * (of->pair.slave ? c->minus : c->plus)[k];
    int w[3];
    for (int a = 0; a < m->dim; ++a)
      for (int b = 0; b < m->dim; ++b)
        if (m->origin[v[a]] == m->origin[to[b]]) w[a] = to[b];
    s->whole[r->m->mesh.cracks[id].contact_id] += is_whole(r, where, v);
    add_lip_edges(r, where, v, w, bubble_weight(r, near), s);
  }
}

/* 1: edge k of the sorted edges of all faces is of one face, and not on a plane
 * of symmetry. */
static int is_border(const run *r, const int *where, const goal_surface *s,
                     int k) {
  const contact_edge *e = &s->edge[k];
  if (k > 0 && number_pair_order(e - 1, e) == 0) return 0;
  if (k < s->n_edge - 1 && number_pair_order(e, e + 1) == 0) return 0;
  return where[e->a] < 0 || where[e->b] < 0 ||
         !goal_is_mirrored(r, where[e->a]) || !goal_is_mirrored(r, where[e->b]);
}

/* The border where it is closed: ends of a line, edges of one face.
 * seen[n_node] zero. */
static void mark_border(const run *r, const int *where, int *seen,
                        goal_surface *s) {
  const int flat = r->msh->dim == 2;
  for (int k = 0; k < s->n_edge; ++k) {
    if (!flat && !is_border(r, where, s, k)) continue;
    ++seen[s->edge[k].a];
    ++seen[s->edge[k].b];
  }
  for (int q = 0; q < r->nodes.n; ++q) {
    const int i = r->surface->node_id[q];
    const int border = flat ? seen[i] == 1 && !goal_is_mirrored(r, q) : seen[i];
    if (border && r->result.contact[q] != CONTACT_OPEN)
      s->ends[i] = GOAL_END_OF_CONTACT;
  }
}

static status mark_front(const mesh *m, goal_surface *s) {
  if (m->n_crack == 0) return OK;
  PASS_NEW(s->front, m->n_node);
  for (int i = 0; i < m->n_crack; ++i)
    for (int k = 0; k < m->crack[i].front_start[m->crack[i].n_front]; ++k)
      s->front[m->crack[i].front_node[k]] = 1;
  return OK;
}

/* Gap of contact node q. */
static double gap_at(const run *r, int q) {
  const contact_surface *s = r->surface;
  return r->problem.gap[q] - dot(s->dim, s->frame + s->dim * s->dim * q,
                                 r->now.u + s->dim * s->node_id[q]);
}

/* 1: the gap along an edge of open nodes, a parabola through its ends and
 * middle, may be below zero: one of its coefficients is. */
static int may_close(const run *r, const int *q, double middle) {
  const double ends = 0.5 * (gap_at(r, q[0]) + gap_at(r, q[1]));
  return 2.0 * middle < ends;
}

/* 1: an obstacle is in the body between open nodes. */
static int is_entered(const run *r, const int *q, const contact_edge *e) {
  double d[GOAL_PIECES + 1], least = HUGE_VAL;
  const double first = gap_at(r, q[0]), rise = gap_at(r, q[1]) - first;
  gap_along(r, q, e, d);
  for (int k = 0; k <= GOAL_PIECES; ++k)
    least = fmin(least, d[k] + first + rise * k / GOAL_PIECES);
  return least < 0.0;
}

/* s->is_missed. */
static void find_missed(const run *r, const gap_slopes *slopes,
                        const int *where, goal_surface *s) {
  for (int k = 0; k < s->n_edge && !s->is_missed; ++k) {
    contact_edge e = s->edge[k];
    const int q[2] = {where[e.a], where[e.b]};
    if (e.other[0] >= 0 || r->result.contact[q[0]] != CONTACT_OPEN ||
        r->result.contact[q[1]] != CONTACT_OPEN)
      continue;
    set_middle(r, slopes, q, &e);
    s->is_missed = is_entered(r, q, &e);
    if (s->closed[r->surface->contact_id[q[0]]] == 0)
      s->is_missed |= may_close(r, q, e.excess);
  }
}

/* Each edge once. */
static void unite_edges(goal_surface *s) {
  int n = 0;
  for (int k = 0; k < s->n_edge; ++k)
    if (n == 0 || number_pair_order(&s->edge[n - 1], &s->edge[k]) != 0)
      s->edge[n++] = s->edge[k];
    else
      s->edge[n - 1].weight += s->edge[k].weight;
  s->n_edge = n;
}

/* The edges of a contact on an obstacle. */
static void add_group(const run *r, const smooth_faces *rings,
                      const gap_slopes *slopes, int id, const int *where,
                      goal_surface *s) {
  const int dim = r->msh->dim;
  const mesh_group *g = r->faces.pairs[id].group;
  for (int i = 0; i < g->n_item; ++i) {
    const int *v = r->msh->face + dim * g->item_id[i];
    s->whole[id] += is_whole(r, where, v);
    for (int a = 0; a < dim; ++a)
      for (int b = a + 1; b < dim; ++b) {
        const int ends[2] = {v[a], v[b]};
        add_edge(r, rings, slopes, g->item_id[i], ends, where, s);
      }
  }
}

/* At a corner of the gap stresses go like the logarithm of the distance. */
static status mark_corners(const run *r, const int *where, goal_surface *s) {
  OWNED_NEW(double, corner, r->nodes.n);
  PASS(goal_corners(r, where, corner));
  for (int q = 0; q < r->nodes.n; ++q)
    if (fabs(corner[q]) > GOAL_CORNER)
      s->ends[r->surface->node_id[q]] |= GOAL_END_OF_CONTACT;
  return OK;
}

status goal_surface_new(const run *r, const goal_border *border,
                        const space_recovery *of, goal_surface *s) {
  const mesh *m = r->msh;
  OWNED int *where = NULL, *seen = NULL;
  int n = 0;
  OWNED_PARTS(smooth_faces, rings, smooth_faces_new(m, &rings));
  PASS_NEW_ALL(OF(s->ends, m->n_node), OF(seen, m->n_node),
               OF(s->closed, r->m->n.contact), OF(s->whole, r->m->n.contact));
  PASS(goal_places(r, &where));
  OWNED_PARTS(gap_slopes, slopes, gap_slopes_new(r, where, &slopes));
  for (int k = 0; k < r->m->n.contact && r->nodes.n > 0; ++k)
    if (!r->m->contacts[k].is_pair) n += r->faces.pairs[k].group->n_item;
  for (int k = 0; k < m->n_crack; ++k) n += 2 * m->crack[k].n;
  PASS_NEW(s->edge, n * (m->dim == 3 ? 3 : 1));
  for (int k = 0; k < r->m->n.contact && r->nodes.n > 0; ++k)
    if (!r->m->contacts[k].is_pair) add_group(r, &rings, &slopes, k, where, s);
  for (int k = 0; k < m->n_crack && r->nodes.n > 0; ++k)
    add_crack(r, k, where, s);
  PAIR_SORT(s->edge, s->n_edge);
  mark_border(r, where, seen, s);
  PASS(mark_front(m, s));
  PASS(mark_corners(r, where, s));
  unite_edges(s);
  for (int q = 0; q < r->nodes.n; ++q)
    s->closed[r->surface->contact_id[q]] +=
        r->result.contact[q] != CONTACT_OPEN;
  for (int k = 0; k < r->m->n.contact; ++k) s->n_closed += s->closed[k];
  find_missed(r, &slopes, where, s);
  PASS(goal_add_bent(r, &rings, s));
  PASS(goal_add_given(r, s));
  return goal_mark_supports(r, border, of, s);
}

/* ---- nodes along a line -------------------------------------------------- */

/* next[2*n]: the contact nodes next to each node of the line, or -1. */
static status find_next(const run *r, const goal_card *g, int *next) {
  const mesh_group *of = r->faces.pairs[g->contact_id].group;
  OWNED_OF(int, where, goal_places(r, &where));
  for (int k = 0; k < 2 * r->nodes.n; ++k) next[k] = -1;
  for (int k = 0; k < of->n_item; ++k) {
    const int *v = r->msh->face + 2 * of->item_id[k];
    for (int a = 0; a < 2; ++a) {
      const int q = where[v[a]], other = where[v[1 - a]];
      if (q >= 0 && other >= 0) next[2 * q + (next[2 * q] >= 0)] = other;
    }
  }
  return OK;
}

/* From the second node on to the third, m; 0: none, or round a corner. */
static double edge_on(const run *r, const int *v) {
  static const double CORNER = 0.64; /* cosine, of 50 degrees */
  const double *x = r->surface->x;
  double d[2], e[2];
  if (v[2] < 0) return 0.0;
  vector_of(2, x + 2 * v[0], x + 2 * v[1], d);
  vector_of(2, x + 2 * v[1], x + 2 * v[2], e);
  const double to = norm(2, e);
  return v[0] != v[1] && dot(2, d, e) < CORNER * norm(2, d) * to ? 0.0 : to;
}

/* Goes on from the peak on both sides in turn, so that a closed curve has its
 * ends opposite to the peak. */
static void follow(const run *r, const int *next, int peak, goal_line *l) {
  const double *x = r->surface->x, *t = r->surface->frame + 4 * peak + 2;
  const int *first = next + 2 * peak;
  int v[2][3], end[2] = {r->nodes.n, r->nodes.n};
  double d[2] = {0.0};
  if (first[0] >= 0) vector_of(2, x + 2 * peak, x + 2 * first[0], d);
  for (int k = 0; k < 2; ++k)
    memcpy(v[k], (int[]){peak, peak, first[(dot(2, d, t) > 0.0) ^ k]},
           sizeof v[k]);
  l->at[l->node[end[0]] = peak] = 0.0;
  for (int k = 0; v[0][2] >= 0 || v[1][2] >= 0; k = 1 - k) {
    int *u = v[k];
    const double to = edge_on(r, u);
    if (!(to > 0.0) || !isnan(l->at[u[2]])) {
      u[2] = -1;
      continue;
    }
    end[k] += k == 0 ? -1 : 1;
    l->node[end[k]] = u[2];
    l->at[u[2]] = l->at[u[1]] + (k == 0 ? -to : to);
    u[0] = u[1];
    u[1] = u[2];
    u[2] = next[2 * u[1] + (next[2 * u[1]] == u[0])];
  }
  l->n = end[1] - end[0] + 1;
  l->peak = r->nodes.n - end[0];
  memmove(l->node, l->node + end[0], l->n * sizeof *l->node);
}

status goal_line_new(const run *r, const goal_card *g, int peak, goal_line *l) {
  const int n = r->nodes.n;
  if (r->msh->dim == 3) return OK;
  OWNED_NEW(int, next, 2 * n);
  PASS_NEW_ALL(OF(l->node, 2 * n + 1), OF(l->s, n), OF(l->at, n));
  PASS(find_next(r, g, next));
  for (int q = 0; q < n; ++q) l->at[q] = NAN;
  follow(r, next, peak, l);
  for (int k = 0; k < l->n; ++k) l->s[k] = l->at[l->node[k]];
  return OK;
}
