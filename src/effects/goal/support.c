/*
 * Supports as the estimate sees them: what they prescribe between the nodes,
 * and where stresses may be infinite by them: at the end of a support, at a
 * point that is held, in an inner corner. By the angle of the body at a node,
 * in space at an edge, and what its two faces there are (Williams 1952, J Appl
 * Mech 19, 526-528): between the clamp and a free face from 45 degrees on,
 * between two of a kind from 180, else from 90.
 */
#include "base/memory.h"
#include "base/number.h"
#include "base/vector.h"
#include "effects/goal/parts.h"

#include <math.h>
#include <stdlib.h>

static const double PI = 3.14159265358979323846;
/* Of a face that is a chord of a smooth surface, rad: half of what it turns. */
static const double SLACK = 0.27;

/* ---- what supports prescribe between the nodes --------------------------- */

static double middle_of(const run *r, const load *l, const int *v) {
  const mesh *m = r->msh;
  double x[3] = {0.0};
  for (int c = 0; c < m->dim; ++c)
    x[c] = 0.5 * (m->x[m->dim * v[0] + c] + m->x[m->dim * v[1] + c]);
  return load_at_point(l, r->step, x, r->now.t);
}

/* Edge v[2] of a support whose value varies. */
static given_edge edge_of(const run *r, const load *l, const int *v) {
  given_edge e = {.a = v[0] < v[1] ? v[0] : v[1],
                  .b = v[0] < v[1] ? v[1] : v[0]};
  double bend = middle_of(r, l, v);
  for (int k = 0; k < 2; ++k)
    bend -= 0.5 * load_at_node(l, r->msh, r->step, v[k], r->now.t);
  if (isfinite(bend)) e.bend[l->component] = bend;
  return e;
}

/* Edges of the elements with both ends in[n_node] the group of a load; counts
 * them where e is NULL. */
static int edges_in(const run *r, const load *l, const unsigned char *in,
                    given_edge *e) {
  const mesh *m = r->msh;
  int n = 0;
  for (int k = 0; k < m->n_elem; ++k) {
    const int *v = m->elem + (m->dim + 1) * k;
    for (int a = 0; a < m->dim; ++a)
      for (int b = a + 1; b <= m->dim; ++b) {
        const int ends[2] = {v[a], v[b]};
        if (!in[v[a]] || !in[v[b]]) continue;
        if (e != NULL) e[n] = edge_of(r, l, ends);
        ++n;
      }
  }
  return n;
}

/* Each edge once. */
static int unite(given_edge *e, int n) {
  int kept = 0;
  if (n > 0) qsort(e, (size_t)n, sizeof *e, number_pair_order);
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

static int bends(const load *l) {
  return l->kind == LOAD_FIXING &&
         ((quantity_variables(&l->value) & 7u) != 0 ||
          (l->has_before && (quantity_variables(&l->before) & 7u) != 0));
}

/* Writes the edges of all loads to e, or counts them. */
static status given_edges(const run *r, given_edge *e, int *n) {
  OWNED unsigned char *in = NULL;
  *n = 0;
  for (int i = 0; i < r->step->loads.n; ++i) {
    const load *l = &r->step->loads.item[i];
    if (!bends(l)) continue;
    const mesh_group *g = &r->msh->group[l->group_id];
    if (in == NULL) PASS_NEW(in, r->msh->n_node);
    for (int k = 0; k < g->n_node; ++k) in[g->node_id[k]] = 1;
    *n += edges_in(r, l, in, e == NULL ? NULL : e + *n);
    for (int k = 0; k < g->n_node; ++k) in[g->node_id[k]] = 0;
  }
  return OK;
}

status goal_add_given(const run *r, goal_surface *s) {
  int n;
  PASS(given_edges(r, NULL, &n));
  if (n == 0) return OK;
  PASS_NEW(s->given, n);
  PASS(given_edges(r, s->given, &n));
  s->n_given = unite(s->given, n);
  return OK;
}

/* ---- where they end, in the plane ---------------------------------------- */

typedef enum { FREE, CLAMPED, ROLLER, ACROSS, SLANTED } kind;

/* An edge of the border; a < b. */
typedef struct border {
  int a, b;
} border;

/* The body at a node. */
typedef struct corner {
  double angle;                   /* rad */
  int n;                          /* faces */
  kind of[2];                     /* the first of them */
  unsigned char held[2];          /* components that some face holds */
  unsigned char support, contact; /* 1: some face is held, closed */
} corner;

static double angle_at(const mesh *m, const int *v, int k) {
  const double *x = m->x + 2 * v[k], *y = m->x + 2 * v[(k + 1) % 3];
  const double *z = m->x + 2 * v[(k + 2) % 3];
  const double a[2] = {y[0] - x[0], y[1] - x[1]};
  const double b[2] = {z[0] - x[0], z[1] - x[1]};
  return atan2(fabs(a[0] * b[1] - a[1] * b[0]), a[0] * b[0] + a[1] * b[1]);
}

static int is_inside(const corner *c) { return c->angle > 2.0 * PI - 1e-6; }

/* *out: edges of one element alone; new. */
static status border_new(const mesh *m, const corner *c, border **out, int *n) {
  int kept = 0;
  *n = 0;
  PASS_NEW(*out, 3 * m->n_elem);
  border *e = *out;
  for (int k = 0; k < 3 * m->n_elem; ++k) {
    const int a = m->elem[k], b = m->elem[k - k % 3 + (k + 1) % 3];
    if (is_inside(&c[a]) || is_inside(&c[b])) continue;
    e[(*n)++] = (border){a < b ? a : b, a < b ? b : a};
  }
  if (*n > 0) qsort(e, (size_t)*n, sizeof *e, number_pair_order);
  for (int i = 0, last; i < *n; i = last) {
    for (last = i + 1; last < *n && number_pair_order(e + i, e + last) == 0;)
      ++last;
    if (last == i + 1) e[kept++] = e[i];
  }
  *n = kept;
  return OK;
}

/* By the one component of an edge that is held. */
static kind held_kind(const mesh *m, const border *e, int component) {
  const double d[2] = {fabs(m->x[2 * e->b] - m->x[2 * e->a]),
                       fabs(m->x[2 * e->b + 1] - m->x[2 * e->a + 1])};
  if (d[component] <= 1e-6 * d[1 - component]) return ROLLER;
  return d[1 - component] <= 1e-6 * d[component] ? ACROSS : SLANTED;
}

static kind contact_kind(const goal_surface *s, const border *e) {
  const contact_edge *found = s->n_edge == 0
                                  ? NULL
                                  : bsearch(e, s->edge, (size_t)s->n_edge,
                                            sizeof *s->edge, number_pair_order);
  if (found == NULL || !found->closed) return FREE;
  return found->stuck ? CLAMPED : ROLLER;
}

static void add_border(const run *r, const goal_surface *s, const border *e,
                       corner *c) {
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

/* 1: contact alone meets what is free; of it only the end of stick is singular
 * by its angle. */
static int is_smooth(const corner *c, kind a, kind b) {
  if (!c->contact || c->support) return 0;
  return a != FREE || b != CLAMPED || c->angle > PI - SLACK;
}

/* 1: stresses are infinite at a node of the border. */
static int is_singular(const corner *c) {
  const kind a = c->of[0] < c->of[1] ? c->of[0] : c->of[1];
  const kind b = c->of[0] < c->of[1] ? c->of[1] : c->of[0];
  if (is_smooth(c, a, b)) return 0;
  if (c->n != 2) return c->n > 2;
  if (a == b && fabs(c->angle - PI) < 2.0 * SLACK) return 0;
  if (b == SLANTED) return 1;
  if (a == b && b <= CLAMPED) return c->angle > PI;
  return c->angle > (a == FREE && b == CLAMPED ? PI / 4 : PI / 2 + SLACK);
}

/* 1: a support holds the node and no edge at it. */
static int is_point(const unsigned char *fixed, const corner *c) {
  return (fixed[0] && !c->held[0]) || (fixed[1] && !c->held[1]);
}

/* ---- where they end, in space -------------------------------------------- */

/* A face of the border, v ascending; the node of its element behind it. */
typedef struct side {
  int v[3], behind;
} side;

/* An edge of a face of the border; a < b. */
typedef struct rim {
  int a, b, other; /* the third node of the face */
  kind of;
  int support;
  double n[3]; /* outward normal */
} rim;

/* A tetrahedron as its node k sees it, steradian (Van Oosterom, Strackee
 * 1983). */
static double solid_angle(const mesh *m, const int *v, int k) {
  double d[3][3], l[3];
  for (int i = 0; i < 3; ++i) {
    for (int c = 0; c < 3; ++c)
      d[i][c] = m->x[3 * v[(k + i + 1) % 4] + c] - m->x[3 * v[k] + c];
    l[i] = sqrt(dot(3, d[i], d[i]));
  }
  double n[3];
  cross(d[1], d[2], n);
  return 2.0 * atan2(fabs(dot(3, d[0], n)),
                     l[0] * l[1] * l[2] + dot(3, d[0], d[1]) * l[2] +
                         dot(3, d[0], d[2]) * l[1] + dot(3, d[1], d[2]) * l[0]);
}

static int side_order(const void *a, const void *b) {
  const int *p = ((const side *)a)->v, *q = ((const side *)b)->v;
  for (int k = 0; k < 3; ++k)
    if (p[k] != q[k]) return p[k] < q[k] ? -1 : 1;
  return 0;
}

static side side_of(const int *v, int k) {
  side f = {.behind = v[k]};
  for (int i = 0, n = 0; i < 4; ++i) {
    if (i == k) continue;
    int at = n++;
    for (; at > 0 && f.v[at - 1] > v[i]; --at) f.v[at] = f.v[at - 1];
    f.v[at] = v[i];
  }
  return f;
}

/* *out: faces of one element alone; new. round[n_node]: solid angles. */
static status sides_new(const mesh *m, const double *round, side **out,
                        int *n) {
  const double inside = 4.0 * PI - 1e-6;
  int kept = 0;
  *n = 0;
  PASS_NEW(*out, 4 * m->n_elem);
  side *f = *out;
  for (int k = 0; k < 4 * m->n_elem; ++k) {
    f[*n] = side_of(m->elem + k - k % 4, k % 4);
    const int *v = f[*n].v;
    *n += round[v[0]] < inside && round[v[1]] < inside && round[v[2]] < inside;
  }
  if (*n > 0) qsort(f, (size_t)*n, sizeof *f, side_order);
  for (int i = 0, last; i < *n; i = last) {
    for (last = i + 1; last < *n && side_order(f + i, f + last) == 0;) ++last;
    if (last == i + 1) f[kept++] = f[i];
  }
  *n = kept;
  return OK;
}

static void outward(const mesh *m, const side *f, double *n) {
  double d[3][3];
  for (int c = 0; c < 3; ++c) {
    const double x = m->x[3 * f->v[0] + c];
    d[0][c] = m->x[3 * f->v[1] + c] - x;
    d[1][c] = m->x[3 * f->v[2] + c] - x;
    d[2][c] = m->x[3 * f->behind + c] - x;
  }
  cross(d[0], d[1], n);
  const double size = sqrt(dot(3, n, n)) * (dot(3, n, d[2]) > 0.0 ? -1.0 : 1.0);
  for (int c = 0; c < 3; ++c) n[c] /= size;
}

/* By n_held components of a face, the last of them "component". */
static kind side_kind(const double *n, int n_held, int component) {
  const double along = fabs(n[component]);
  if (n_held > 1) return CLAMPED;
  if (along >= 1.0 - 1e-9) return ROLLER;
  return along <= 1e-6 ? ACROSS : SLANTED;
}

static kind side_contact(const goal_surface *s, const side *f) {
  kind of = CLAMPED;
  for (int k = 0; k < 3; ++k) {
    const border e = {f->v[k == 2], f->v[k == 0 ? 1 : 2]};
    const kind at = contact_kind(s, &e);
    if (at == FREE) return FREE;
    if (at == ROLLER) of = ROLLER;
  }
  return of;
}

/* The three edges of a face; held[3*n_node] += what it holds. */
static void add_side(const run *r, const goal_surface *s, const side *f,
                     unsigned char *held, rim *e) {
  const unsigned char *fixed = r->body.d.fixed;
  int n_held = 0, component = 0;
  double n[3];
  outward(r->msh, f, n);
  for (int c = 0; c < 3; ++c) {
    if (!fixed[3 * f->v[0] + c] || !fixed[3 * f->v[1] + c] ||
        !fixed[3 * f->v[2] + c])
      continue;
    ++n_held;
    component = c;
    for (int k = 0; k < 3; ++k) held[3 * f->v[k] + c] = 1;
  }
  for (int k = 0; k < 3; ++k)
    e[k] = (rim){
        .a = f->v[k == 0],
        .b = f->v[k == 2 ? 1 : 2],
        .other = f->v[k],
        .of = n_held > 0 ? side_kind(n, n_held, component) : side_contact(s, f),
        .support = n_held > 0,
        .n = {n[0], n[1], n[2]}};
}

/* 1: stresses are infinite along an edge of "count" faces. */
static int is_singular_edge(const mesh *m, const rim *e, int count) {
  if (count != 2) return count > 2;
  double across = 0.0;
  for (int c = 0; c < 3; ++c)
    across += e[0].n[c] * (m->x[3 * e[1].other + c] - m->x[3 * e[0].a + c]);
  const double turn = acos(fmax(-1.0, fmin(1.0, dot(3, e[0].n, e[1].n))));
  corner at = {.angle = PI + (across > 0.0 ? turn : -turn), .n = 2};
  for (int k = 0; k < 2; ++k) {
    at.of[k] = e[k].of;
    if (e[k].support) at.support = 1;
    if (!e[k].support && e[k].of != FREE) at.contact = 1;
  }
  return is_singular(&at);
}

static void mark_edges(const mesh *m, rim *e, int n, goal_surface *s) {
  if (n > 0) qsort(e, (size_t)n, sizeof *e, number_pair_order);
  for (int i = 0, last; i < n; i = last) {
    for (last = i + 1; last < n && number_pair_order(e + i, e + last) == 0;)
      ++last;
    if (s->front != NULL && s->front[e[i].a] && s->front[e[i].b]) continue;
    if (!is_singular_edge(m, e + i, last - i)) continue;
    s->ends[e[i].a] |= GOAL_END_OF_SUPPORT;
    s->ends[e[i].b] |= GOAL_END_OF_SUPPORT;
  }
}

static status mark_space(const run *r, goal_surface *s) {
  const mesh *m = r->msh;
  OWNED double *round = NULL;
  OWNED side *f = NULL;
  OWNED rim *e = NULL;
  OWNED unsigned char *held = NULL;
  int n;
  PASS_NEW_ALL(OF(round, m->n_node), OF(held, 3 * m->n_node));
  for (int k = 0; k < 4 * m->n_elem; ++k)
    round[m->elem[k]] += solid_angle(m, m->elem + k - k % 4, k % 4);
  PASS(sides_new(m, round, &f, &n));
  PASS_NEW(e, 3 * n);
  for (int k = 0; k < n; ++k) add_side(r, s, &f[k], held, e + 3 * k);
  mark_edges(m, e, 3 * n, s);
  for (int k = 0; k < 3 * m->n_node; ++k)
    if (r->body.d.fixed[k] && !held[k]) s->ends[k / 3] |= GOAL_END_OF_SUPPORT;
  return OK;
}

static status mark_plane(const run *r, goal_surface *s) {
  const mesh *m = r->msh;
  OWNED corner *c = NULL;
  OWNED border *e = NULL;
  int n;
  PASS_NEW(c, m->n_node);
  for (int k = 0; k < 3 * m->n_elem; ++k)
    c[m->elem[k]].angle += angle_at(m, m->elem + k - k % 3, k % 3);
  PASS(border_new(m, c, &e, &n));
  for (int k = 0; k < n; ++k) add_border(r, s, &e[k], c);
  for (int i = 0; i < m->n_node; ++i)
    if ((s->front == NULL || !s->front[i]) &&
        (is_singular(&c[i]) || is_point(r->body.d.fixed + 2 * i, &c[i])))
      s->ends[i] |= GOAL_END_OF_SUPPORT;
  return OK;
}

status goal_mark_supports(const run *r, goal_surface *s) {
  return r->msh->dim == 2 ? mark_plane(r, s) : mark_space(r, s);
}
