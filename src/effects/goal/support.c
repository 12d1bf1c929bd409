/*
 * Supports as the estimate sees them: what they prescribe between the nodes,
 * and where stresses may be infinite by them: at the end of a support, at a
 * point that is held, in an inner corner. By the angle of the body at a node,
 * in space at an edge, and what its two faces there are (Williams 1952, J Appl
 * Mech 19, 526-528): between the clamp and a free face from 45 degrees on,
 * between two of a kind from 180, else from 90.
 *
 * The same where two materials, or zones of temperature, meet at the border
 * (Bogy 1971, J Appl Mech 38, 377-386), unless it is a plane of symmetry that
 * their interface is normal to, and where their interface turns within; where
 * loads end (jumps.c), under the force on a node, and on the axis of bodies of
 * revolution whose material is not the same round it.
 */
#include "base/base.h"
#include "effects/goal/parts.h"

/* Of a face that is a chord of a smooth surface, rad: half of what it turns. */
static const double SLACK = 0.27;
static const double TURN = 1e-6; /* rad, of a border that is straight */

/* ---- what supports prescribe between the nodes --------------------------- */

/* Edge v[2] of a support whose value varies, which it has on the surface. */
static given_edge edge_of(const run *r, const goal_surface *s, const load *l,
                          const int *v) {
  const number_pair is = number_pair_of(v[0], v[1]);
  given_edge e = {.a = is.a, .b = is.b};
  const mesh *m = r->msh;
  const bent_edge *bent = PAIR_FIND(s->bent, s->n_bent, v[0], v[1]);
  const double flat[3] = {0.0}, *out = bent != NULL ? bent->out : flat;
  double d[GOAL_PIECES + 1], rough;
  for (int k = 0; k <= GOAL_PIECES; ++k) {
    double x[3];
    goal_point_of(m->dim, m->x + m->dim * v[0], m->x + m->dim * v[1], out, k,
                  x);
    d[k] = load_at_point(l, r->step, x, r->now.t);
  }
  goal_take_line(d);
  const double bend = goal_parabola(d, &rough);
  if (isfinite(bend)) e.bend[l->component] = bend;
  return e;
}

/* Edges of the elements with both ends in[n_node] the group of a load; counts
 * them where e is NULL. */
static int edges_in(const run *r, const goal_surface *s, const load *l,
                    const unsigned char *in, given_edge *e) {
  const mesh *m = r->msh;
  int n = 0;
  for (int k = 0; k < m->n_elem; ++k) {
    const int *v = m->elem + (m->dim + 1) * k;
    for (int a = 0; a < m->dim; ++a)
      for (int b = a + 1; b <= m->dim; ++b) {
        const int ends[2] = {v[a], v[b]};
        if (!in[v[a]] || !in[v[b]]) continue;
        if (e != NULL) e[n] = edge_of(r, s, l, ends);
        ++n;
      }
  }
  return n;
}

/* Each edge once. */
static int unite(given_edge *e, int n) {
  int kept = 0;
  PAIR_SORT(e, n);
  for (int k = 0; k < n; ++k) {
    if (kept == 0 || number_pair_order(&e[kept - 1], &e[k]) != 0) {
      e[kept++] = e[k];
      continue;
    }
    for (int c = 0; c < 3; ++c)
      if (fabs(e[k].bend[c]) > 0.0) e[kept - 1].bend[c] = e[k].bend[c];
  }
  return kept;
}

/* Writes the edges of all loads to e, or counts them. */
static status given_edges(const run *r, const goal_surface *s, given_edge *e,
                          int *n) {
  OWNED unsigned char *in = NULL;
  *n = 0;
  for (EACH(const load, l, r->step->loads.item, r->step->loads.n)) {
    if (l->kind != LOAD_FIXING || !goal_load_varies(l)) continue;
    const mesh_group *g = &r->msh->group[l->group_id];
    if (in == NULL) PASS_NEW(in, r->msh->n_node);
    for (int k = 0; k < g->n_node; ++k) in[g->node_id[k]] = 1;
    *n += edges_in(r, s, l, in, e == NULL ? NULL : e + *n);
    for (int k = 0; k < g->n_node; ++k) in[g->node_id[k]] = 0;
  }
  return OK;
}

status goal_add_given(const run *r, goal_surface *s) {
  int n;
  PASS(given_edges(r, s, NULL, &n));
  if (n == 0) return OK;
  PASS_NEW(s->given, n);
  PASS(given_edges(r, s, s->given, &n));
  s->n_given = unite(s->given, n);
  return OK;
}

/* ---- materials that meet ------------------------------------------------- */

/* Regions at a node in the plane. */
typedef struct joint {
  int n, first, second; /* how many, of three or more 3; from 1 */
  double angle;         /* of the first, rad */
} joint;

static void add_region(int region, double angle, joint *j) {
  if (j->n == 0) j->first = region;
  if (region == j->first) {
    j->angle += angle;
    j->n = j->n == 0 ? 1 : j->n;
    return;
  }
  if (j->n == 1) j->second = region;
  j->n = region == j->second ? (j->n == 1 ? 2 : j->n) : 3;
}

/* 1: stresses are infinite where regions meet: all of the body or its half are
 * in the angle "whole". */
static int is_bent(int n, double angle, double whole) {
  return n > 2 || fabs(angle - 0.5 * whole) > 2.0 * SLACK;
}

/* GOAL_HOLLOW, and whether edges are few, where the border turns inwards by
 * this angle, rad. */
static unsigned char hollow_bits(double turn) {
  static const double FEW = M_PI / 12.0;
  if (!(turn > TURN)) return 0;
  return turn > FEW ? GOAL_HOLLOW | GOAL_FEW_EDGES : GOAL_HOLLOW;
}

/* The same at a node; inside, where the interface of two regions turns. */
static unsigned char hollow_at(double angle, const joint *j) {
  if (angle < 2.0 * M_PI - TURN) return hollow_bits(angle - M_PI);
  return j->n == 2 ? hollow_bits(fabs(j->angle - M_PI)) : 0;
}

/* ---- where they end, in the plane ---------------------------------------- */

typedef enum { FREE, CLAMPED, ROLLER, ACROSS, SLANTED } kind;

/* The body at a node. */
typedef struct corner {
  double angle;                   /* rad */
  int n;                          /* faces */
  kind of[2];                     /* the first of them */
  unsigned char held[2];          /* components that some face holds */
  unsigned char support, contact; /* 1: some face is held, closed */
  const side_load *pull[2];       /* of the first faces */
  double normal[2][2];            /* outward, the same */
} corner;

static double angle_at(const mesh *m, const int *v, int k) {
  double a[2], b[2];
  vector_of(2, m->x + 2 * v[k], m->x + 2 * v[(k + 1) % 3], a);
  vector_of(2, m->x + 2 * v[k], m->x + 2 * v[(k + 2) % 3], b);
  return atan2(fabs(a[0] * b[1] - a[1] * b[0]), a[0] * b[0] + a[1] * b[1]);
}

/* By the one component of an edge that is held. */
static kind held_kind(const mesh *m, const number_pair *e, int component) {
  const double d[2] = {fabs(m->x[2 * e->b] - m->x[2 * e->a]),
                       fabs(m->x[2 * e->b + 1] - m->x[2 * e->a + 1])};
  if (d[component] <= 1e-6 * d[1 - component]) return ROLLER;
  return d[1 - component] <= 1e-6 * d[component] ? ACROSS : SLANTED;
}

static kind contact_kind(const goal_surface *s, const number_pair *e) {
  const contact_edge *found = PAIR_FIND(s->edge, s->n_edge, e->a, e->b);
  if (found == NULL || !found->closed) return FREE;
  return found->stuck ? CLAMPED : ROLLER;
}

/* Of side v[2], turned outward. */
static void add_pull(const mesh *m, const int *v, const side_load *pull,
                     corner *c) {
  const double *a = m->x + 2 * v[0], *b = m->x + 2 * v[1];
  double n[2] = {b[1] - a[1], a[0] - b[0]};
  goal_make_unit(2, n);
  for (int k = 0; k < 2; ++k) {
    corner *at = &c[v[k]];
    if (at->n >= 2) continue;
    at->pull[at->n] = pull + k;
    COPY(at->normal[at->n], n, 2);
  }
}

static void add_border(const run *r, const goal_surface *s,
                       const number_pair *e, corner *c) {
  const unsigned char *fixed = r->body.d.fixed;
  const int held[2] = {fixed[2 * e->a] && fixed[2 * e->b],
                       fixed[2 * e->a + 1] && fixed[2 * e->b + 1]};
  const int support = held[0] || held[1];
  const kind of = held[0] && held[1] ? CLAMPED
                  : support          ? held_kind(r->msh, e, held[1])
                                     : contact_kind(s, e);
  corner *at[2] = {&c[e->a], &c[e->b]};
  for (int k = 0; k < 2; ++k) {
    if (at[k]->n < 2) at[k]->of[at[k]->n] = of;
    ++at[k]->n;
    if (support) at[k]->support = 1;
    if (!support && of != FREE) at[k]->contact = 1;
    for (int i = 0; i < 2; ++i)
      if (held[i]) at[k]->held[i] = 1;
  }
}

/* 1: contact alone meets what is free; the end of stick is singular. */
static int is_smooth(const corner *c, kind a, kind b) {
  if (!c->contact || c->support) return 0;
  return a != FREE || b != CLAMPED || c->angle > M_PI - SLACK;
}

/* 1: stresses are infinite at a node of the border. */
static int is_singular(const corner *c) {
  const kind a = c->of[0] < c->of[1] ? c->of[0] : c->of[1];
  const kind b = c->of[0] < c->of[1] ? c->of[1] : c->of[0];
  if (is_smooth(c, a, b)) return 0;
  if (c->n != 2) return c->n > 2;
  if (a == b && fabs(c->angle - M_PI) < 2.0 * SLACK) return 0;
  if (b == SLANTED) return 1;
  if (a == b && b <= CLAMPED) return c->angle > M_PI;
  return c->angle > (a == FREE && b == CLAMPED ? M_PI / 4 : M_PI / 2 + SLACK);
}

/* 1: the same by loads, where the other side is free, or a roller of a body
 * that goes on behind it: its pressure is unknown, and has no part across. */
static int is_torn(int dim, const corner *c, const side_load *const *pull,
                   const double *n, const double *m) {
  const int free_too = c->of[0] == FREE && c->of[1] == FREE;
  const int mirrored = (c->of[0] == FREE || c->of[1] == FREE) &&
                       (c->of[0] == ROLLER || c->of[1] == ROLLER) &&
                       fabs(c->angle - M_PI / 2) < SLACK;
  return c->n == 2 && !c->contact && (free_too || mirrored) &&
         goal_is_torn(dim, pull[0], n, pull[1], m,
                      fabs(c->angle - M_PI) < 2.0 * SLACK);
}

/* 1: the same by the regions that meet at a node. */
static int is_singular_joint(const corner *c, const joint *j) {
  const int mirrored = c->n == 2 && c->of[0] == ROLLER && c->of[1] == ROLLER &&
                       fabs(c->angle - M_PI) < SLACK;
  if (j->n < 2) return 0;
  if (c->n == 0) return is_bent(j->n, j->angle, 2.0 * M_PI);
  return !mirrored || is_bent(j->n, j->angle, M_PI);
}

/* 1: a support holds the node and no edge at it. */
static int is_point(const unsigned char *fixed, const corner *c) {
  return (fixed[0] && !c->held[0]) || (fixed[1] && !c->held[1]);
}

/* ---- where they end, in space -------------------------------------------- */

/* An edge of a face of the border; a < b. */
typedef struct rim {
  int a, b, other; /* the third node of the face */
  int region;
  kind of;
  int support;
  double n[3];              /* outward normal */
  const side_load *pull[2]; /* of the face at a and b */
} rim;

/* v[3]: turned outward. */
static void outward(const mesh *m, const int *v, double *n) {
  double d[2][3];
  for (int i = 0; i < 2; ++i)
    vector_of(3, m->x + 3 * v[0], m->x + 3 * v[i + 1], d[i]);
  cross(d[0], d[1], n);
  make_unit(3, n);
}

/* By n_held components of a face, the last of them "component". */
static kind side_kind(const double *n, int n_held, int component) {
  const double along = fabs(n[component]);
  if (n_held > 1) return CLAMPED;
  if (along >= 1.0 - 1e-9) return ROLLER;
  return along <= 1e-6 ? ACROSS : SLANTED;
}

static kind side_contact(const goal_surface *s, const int *v) {
  kind of = CLAMPED;
  for (int k = 0; k < 3; ++k) {
    const number_pair e = number_pair_of(v[k], v[(k + 1) % 3]);
    const kind at = contact_kind(s, &e);
    if (at == FREE) return FREE;
    if (at == ROLLER) of = ROLLER;
  }
  return of;
}

/* The three edges of a face; held[3*n_node] += what it holds. */
static void add_side(const run *r, const goal_surface *s, const int *v,
                     const side_load *pull, unsigned char *held, rim *e) {
  const unsigned char *fixed = r->body.d.fixed;
  int n_held = 0, component = 0;
  double n[3];
  outward(r->msh, v, n);
  for (int c = 0; c < 3; ++c) {
    if (!fixed[3 * v[0] + c] || !fixed[3 * v[1] + c] || !fixed[3 * v[2] + c])
      continue;
    ++n_held;
    component = c;
    for (int k = 0; k < 3; ++k) held[3 * v[k] + c] = 1;
  }
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3, turn = v[i] > v[j];
    e[k] = (rim){
        .a = v[turn ? j : i],
        .b = v[turn ? i : j],
        .other = v[k],
        .pull = {pull + (turn ? j : i), pull + (turn ? i : j)},
        .of = n_held > 0 ? side_kind(n, n_held, component) : side_contact(s, v),
        .support = n_held > 0,
        .n = {n[0], n[1], n[2]}};
  }
}

/* The body at an edge of two faces, rad. */
static double angle_of(const mesh *m, const rim *e) {
  double across = 0.0;
  for (int c = 0; c < 3; ++c)
    across += e[0].n[c] * (m->x[3 * e[1].other + c] - m->x[3 * e[0].a + c]);
  const double turn = acos(fmax(-1.0, fmin(1.0, dot(3, e[0].n, e[1].n))));
  return M_PI + (across > 0.0 ? turn : -turn);
}

/* 1: stresses are infinite along an edge of "count" faces. */
static int is_singular_edge(const mesh *m, const rim *e, int count) {
  if (count != 2) return count > 2;
  corner at = {.angle = angle_of(m, e), .n = 2};
  for (int k = 0; k < 2; ++k) {
    at.of[k] = e[k].of;
    if (e[k].support) at.support = 1;
    if (!e[k].support && e[k].of != FREE) at.contact = 1;
  }
  if (e[0].region != e[1].region)
    return at.of[0] != ROLLER || at.of[1] != ROLLER ||
           fabs(at.angle - M_PI) > SLACK;
  for (int k = 0; k < 2; ++k) {
    const side_load *const pull[2] = {e[0].pull[k], e[1].pull[k]};
    if (is_torn(3, &at, pull, e[0].n, e[1].n)) return 1;
  }
  return is_singular(&at);
}

static void mark_edges(const mesh *m, rim *e, int n, goal_surface *s) {
  PAIR_SORT(e, n);
  for (int i = 0, last; i < n; i = last) {
    last = PAIR_END(e, n, i);
    if (s->front != NULL && s->front[e[i].a] && s->front[e[i].b]) continue;
    unsigned char bits = 0;
    if (is_singular_edge(m, e + i, last - i)) bits = GOAL_END_OF_SUPPORT;
    if (last == i + 2) bits |= hollow_bits(angle_of(m, e + i) - M_PI);
    s->ends[e[i].a] |= bits;
    s->ends[e[i].b] |= bits;
  }
}

/* An edge of an element between nodes where regions meet; a < b. */
typedef struct inner {
  int a, b, region;
  double angle; /* rad */
} inner;

/* Between the two faces of an element at its edge from corner i to k. */
static double angle_between(const mesh *m, const int *v, int i, int k) {
  double d[3], away[2][3], square = 0.0;
  int n = 0;
  vector_of(3, m->x + 3 * v[i], m->x + 3 * v[k], d);
  square = dot(3, d, d);
  for (int l = 0; l < 4; ++l) {
    if (l == i || l == k) continue;
    vector_of(3, m->x + 3 * v[i], m->x + 3 * v[l], away[n]);
    const double along = dot(3, away[n], d) / square;
    for (int c = 0; c < 3; ++c) away[n][c] -= along * d[c];
    ++n;
  }
  return acos(fmax(-1.0, fmin(1.0, dot(3, away[0], away[1]) /
                                       sqrt(dot(3, away[0], away[0]) *
                                            dot(3, away[1], away[1])))));
}

/* Writes them, or counts them. */
static int inner_edges(const mesh *m, const space_recovery *of, const joint *at,
                       inner *to) {
  int n = 0;
  for (int e = 0; e < m->n_elem; ++e) {
    const int *v = m->elem + 4 * e;
    for (int i = 0; i < 3; ++i)
      for (int k = i + 1; k < 4; ++k) {
        if (at[v[i]].n < 2 || at[v[k]].n < 2) continue;
        const number_pair is = number_pair_of(v[i], v[k]);
        if (to != NULL)
          to[n] = (inner){is.a, is.b, space_region(of, e) + 1,
                          angle_between(m, v, i, k)};
        ++n;
      }
  }
  return n;
}

/* Where the interface turns within the body. */
static status mark_inner(const mesh *m, const space_recovery *of,
                         const joint *at, unsigned char *ends) {
  const int n = inner_edges(m, of, at, NULL);
  if (n == 0) return OK;
  OWNED_NEW(inner, e, n);
  inner_edges(m, of, at, e);
  PAIR_SORT(e, n);
  for (int i = 0, last; i < n; i = last) {
    joint j = {.n = 0};
    double whole = 0.0;
    last = PAIR_END(e, n, i);
    for (int k = i; k < last; ++k) {
      add_region(e[k].region, e[k].angle, &j);
      whole += e[k].angle;
    }
    if (j.n < 2 || whole < 2.0 * M_PI - SLACK || !is_bent(j.n, j.angle, whole))
      continue;
    ends[e[i].a] |= GOAL_END_OF_SUPPORT;
    ends[e[i].b] |= GOAL_END_OF_SUPPORT;
  }
  return OK;
}

static status mark_space(const run *r, const goal_border *border,
                         const space_recovery *of, const joint *at,
                         goal_surface *s) {
  const mesh *m = r->msh;
  OWNED_NEW(rim, e, 3 * border->n);
  OWNED_NEW(unsigned char, held, 3 * m->n_node);
  OWNED_OF(side_load, pull, side_loads_new(r, border->n, border->side, &pull));
  for (int k = 0; k < border->n; ++k) {
    int v[3];
    mesh_side_nodes(m, border->side[k], v);
    add_side(r, s, v, pull + 3 * k, held, e + 3 * k);
    for (int i = 0; i < 3; ++i)
      e[3 * k + i].region = space_region(of, border->side[k] / 4);
  }
  mark_edges(m, e, 3 * border->n, s);
  for (int k = 0; k < 3 * m->n_node; ++k)
    if (r->body.d.fixed[k] && !held[k]) s->ends[k / 3] |= GOAL_END_OF_SUPPORT;
  return mark_inner(m, of, at, s->ends);
}

static status mark_plane(const run *r, const goal_border *border,
                         const joint *at, goal_surface *s) {
  const mesh *m = r->msh;
  OWNED_NEW(corner, c, m->n_node);
  OWNED_OF(side_load, pull, side_loads_new(r, border->n, border->side, &pull));
  for (int i = 0; i < m->n_node; ++i) c[i].angle = border->angle[i];
  for (int k = 0; k < border->n; ++k) {
    int v[2];
    mesh_side_nodes(m, border->side[k], v);
    const number_pair e = number_pair_of(v[0], v[1]);
    add_pull(m, v, pull + 2 * k, c);
    add_border(r, s, &e, c);
  }
  for (int i = 0; i < m->n_node; ++i)
    if ((s->front == NULL || !s->front[i]) &&
        (is_singular(&c[i]) ||
         is_torn(2, &c[i], c[i].pull, c[i].normal[0], c[i].normal[1]) ||
         is_point(r->body.d.fixed + 2 * i, &c[i]) ||
         is_singular_joint(&c[i], &at[i])))
      s->ends[i] |= GOAL_END_OF_SUPPORT;
  for (int i = 0; i < m->n_node; ++i)
    s->ends[i] |= hollow_at(border->angle[i], &at[i]);
  return OK;
}

status goal_border_new(const mesh *m, goal_border *b) {
  PASS(mesh_border(m, &b->n, &b->side));
  if (m->dim == 3) return OK;
  PASS_NEW(b->angle, m->n_node);
  for (int k = 0; k < 3 * m->n_elem; ++k)
    b->angle[m->elem[k]] += angle_at(m, m->elem + k - k % 3, k % 3);
  return OK;
}

/* Under a force on a node the displacement is infinite. */
static void mark_forces(const run *r, unsigned char *ends) {
  for (EACH(const load, l, r->step->loads.item, r->step->loads.n)) {
    const mesh_group *g = &r->msh->group[l->group_id];
    for (int k = 0; l->kind == LOAD_POINT && k < g->n_node; ++k) {
      const int i = g->node_id[k];
      if (!r->body.d.fixed[r->msh->dim * i + l->component] &&
          load_at_node(l, r->msh, r->step, i, r->now.t) != 0.0)
        ends[i] |= GOAL_END_OF_SUPPORT;
    }
  }
}

/* All of an element on the axis: what is infinite there reaches beyond it. */
static void mark_on_axis(const mesh *m, int elem_id, unsigned char *ends) {
  const int *v = m->elem + 3 * elem_id;
  const double away =
      fmin(m->x[2 * v[0]], fmin(m->x[2 * v[1]], m->x[2 * v[2]]));
  for (int a = 0; a < 3 && away <= 1e-9 * m->size; ++a)
    ends[v[a]] |= GOAL_END_OF_SUPPORT;
}

/* Stresses are infinite on the axis where the hoop is softer than the radius
 * (Lekhnitskii 1968), or the two expand by heat as they would not alone. */
static void mark_axis(const run *r, unsigned char *ends) {
  static const double SAME = 1e-9;
  const domain *d = &r->body.d;
  if (d->kin[0] != AXISYMMETRIC) return;
  for (int e = 0; e < r->msh->n_elem; ++e) {
    const double *E = d->E + 16 * d->section_id[e];
    if (E[10] < (1.0 - SAME) * E[0]) mark_on_axis(r->msh, e, ends);
  }
  for (int k = 0; k < r->strains.eigen.n && r->now.thermal != NULL; ++k) {
    const double *e0 = r->now.thermal + 4 * (size_t)k;
    if (fabs(e0[0] - e0[2]) > SAME * fabs(e0[0] + e0[2]))
      mark_on_axis(r->msh, r->strains.elem[k], ends);
  }
}

/* What is infinite at a node is so steep beyond its elements that recovered
 * gradients lack it there too, and at the front of a crack. */
static void mark_near(const mesh *m, const unsigned char *front,
                      unsigned char *ends) {
  const int n = m->dim + 1;
  for (int i = 0; i < m->n_node && front != NULL; ++i)
    if (front[i]) ends[i] |= GOAL_NEAR_SUPPORT;
  for (int e = 0; e < m->n_elem; ++e) {
    int near = 0;
    for (int a = 0; a < n; ++a) near |= ends[m->elem[n * e + a]];
    for (int a = 0; a < n && (near & GOAL_END_OF_SUPPORT) != 0; ++a)
      ends[m->elem[n * e + a]] |= GOAL_NEAR_SUPPORT;
  }
}

status goal_mark_supports(const run *r, const goal_border *border,
                          const space_recovery *of, goal_surface *s) {
  const mesh *m = r->msh;
  const int n = m->dim + 1;
  OWNED_NEW(joint, at, m->n_node);
  for (int k = 0; k < n * m->n_elem; ++k)
    add_region(space_region(of, k / n) + 1,
               m->dim == 2 ? angle_at(m, m->elem + k - k % n, k % n) : 0.0,
               &at[m->elem[k]]);
  mark_forces(r, s->ends);
  mark_axis(r, s->ends);
  PASS(m->dim == 2 ? mark_plane(r, border, at, s)
                   : mark_space(r, border, of, at, s));
  mark_near(m, s->front, s->ends);
  return OK;
}
