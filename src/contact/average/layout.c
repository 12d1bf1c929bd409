/*
 * The straight layout copies the patch. The geodesic one follows the lines and
 * lays each out on a row of its own, the rows too far apart to interact.
 */
#include "contact/average/layout.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

/* A node this near to the axis, over the largest radius, is on it. */
static const double ON_AXIS = 1e-9;
static const double ON_MIRROR = 1e-9; /* over the radius of the average */

/* Faces around the nodes of a patch. */
typedef struct fans {
  int *start, *face; /* [n_node+1], [dim*n_face] */
} fans;

static void fans_free(fans *f) { RELEASE(f->start, f->face); }

static status fans_new(const average_patch *p, fans *f) {
  int n = p->dim * p->n_face;
  PASS_NEW_ALL(OF(f->start, p->n_node + 2), OF(f->face, n));
  for (int k = 0; k < n; ++k) ++f->start[p->face[k] + 2];
  for (int i = 0; i < p->n_node; ++i) f->start[i + 2] += f->start[i + 1];
  for (int k = 0; k < n; ++k) f->face[f->start[p->face[k] + 1]++] = k / p->dim;
  return OK;
}

static int fan_size(const fans *f, int node) {
  return f->start[node + 1] - f->start[node];
}

static const double *node_at(const average_patch *p, int node) {
  return p->x + (size_t)p->dim * (size_t)node;
}

static int on_axis(const average_patch *p, int node) {
  double largest = 0.0;
  if (!p->axisymmetric) return 0;
  for (int i = 0; i < p->n_node; ++i) largest = fmax(largest, node_at(p, i)[0]);
  return node_at(p, node)[0] <= ON_AXIS * largest;
}

static status new_arrays(const average_patch *p, layout *l) {
  size_t dim = (size_t)p->dim;
  l->dim = p->dim;
  l->n_face = p->n_face;
  PASS_NEW(l->x, dim * (size_t)p->n_node);
  PASS_NEW(l->corner, dim * dim * (size_t)p->n_face);
  PASS_NEW(l->rim, dim * dim * dim * (size_t)(p->n_face + 1));
  return OK;
}

void layout_free(layout *l) {
  RELEASE(l->x, l->corner, l->loop, l->rim);
  memset(l, 0, sizeof *l);
}

/* 1 if all corners lie on one mirror. */
static int on_mirror(const layout *l, int corners,
                     const double *const *corner) {
  for (int c = 0; c < l->dim; ++c) {
    int n = 0;
    for (int k = 0; k < corners && l->has_mirror[c]; ++k)
      n += fabs(corner[k][c] - l->mirror[c]) <= l->near;
    if (n == corners) return 1;
  }
  return 0;
}

static void add_rim(layout *l, int corners, const double *const *corner) {
  size_t dim = (size_t)l->dim;
  if (on_mirror(l, corners, corner)) return;
  double *to = l->rim + (dim - 1) * dim * (size_t)l->n_rim++;
  for (int k = 0; k < corners; ++k)
    memcpy(to + dim * (size_t)k, corner[k], dim * sizeof *to);
}

/* Least or largest coordinate of the patch. */
static double mirror_place(const average_patch *p, int axis,
                           average_mirror which) {
  double place = node_at(p, 0)[axis];
  for (int i = 1; i < p->n_node; ++i) {
    double x = node_at(p, i)[axis];
    place = which == MIRROR_MIN ? fmin(place, x) : fmax(place, x);
  }
  return place;
}

static void set_mirrors(const average_patch *p, const average_rule *rule,
                        layout *l) {
  l->near = ON_MIRROR * rule->radius;
  for (int c = 0; c < p->dim && p->n_node > 0; ++c) {
    l->has_mirror[c] = rule->mirror[c] != MIRROR_NONE;
    if (l->has_mirror[c]) l->mirror[c] = mirror_place(p, c, rule->mirror[c]);
  }
}

/* ---- straight ---------------------------------------------------------- */

/* Faces around node a that hold node b too. */
static int shared(const average_patch *p, const fans *f, int a, int b) {
  int n = 0;
  for (int k = f->start[a]; k < f->start[a + 1]; ++k)
    for (int c = 0; c < p->dim; ++c) n += p->face[p->dim * f->face[k] + c] == b;
  return n;
}

static void lay_as_is(const average_patch *p, const fans *f, layout *l) {
  size_t dim = (size_t)p->dim;
  memcpy(l->x, p->x, dim * (size_t)p->n_node * sizeof *l->x);
  for (int k = 0; k < p->dim * p->n_face; ++k) {
    int a = p->face[k];
    int b = k % p->dim == p->dim - 1 ? p->face[k + 1 - p->dim] : p->face[k + 1];
    const double *ends[2] = {node_at(p, a), node_at(p, b)};
    memcpy(l->corner + dim * (size_t)k, ends[0], dim * sizeof *l->corner);
    if (p->dim == 2 && fan_size(f, a) == 1 && !on_axis(p, a))
      add_rim(l, 1, ends);
    if (p->dim == 3 && shared(p, f, a, b) == 1) add_rim(l, 2, ends);
  }
}

/* ---- along the lines --------------------------------------------------- */

/* Traversal of one line. */
typedef struct walk {
  const average_patch *p;
  const fans *f;
  layout *l;
  unsigned char *done; /* [n_face] */
  double row;          /* second coordinate of this line, m */
} walk;

static void put(double *to, double along, double row) {
  to[0] = along;
  to[1] = row;
}

/* A face around the node that has not been traversed, or -1. */
static int next_face(const walk *w, int node) {
  for (int k = w->f->start[node]; k < w->f->start[node + 1]; ++k)
    if (!w->done[w->f->face[k]]) return w->f->face[k];
  return -1;
}

/* From a node on to the end of its line, or around. */
static void lay_line(walk *w, int first) {
  const average_patch *p = w->p;
  double along = 0.0;
  int node = first, face;
  put(w->l->x + 2 * first, along, w->row);
  while ((face = next_face(w, node)) >= 0) {
    int turned = p->face[2 * face] != node;
    int next = p->face[2 * face + !turned];
    const double *a = node_at(p, node), *b = node_at(p, next);
    w->done[face] = 1;
    put(w->l->corner + 4 * face + 2 * turned, along, w->row);
    along += hypot(b[0] - a[0], b[1] - a[1]);
    put(w->l->corner + 4 * face + 2 * !turned, along, w->row);
    node = next;
    if (node == first || fan_size(w->f, node) != 2) break;
    put(w->l->x + 2 * node, along, w->row);
  }
  if (node == first) return;
  const double start[2] = {0.0, w->row}, end[2] = {along, w->row};
  const double *ends[2] = {start, end};
  put(w->l->x + 2 * node, along, w->row);
  add_rim(w->l, 1, ends);
  add_rim(w->l, 1, ends + 1);
}

/* The length of a closed line to its nodes. */
static void close_loop(const walk *w, int first) {
  const average_patch *p = w->p;
  double length = 0.0;
  int node = first, face = w->f->face[w->f->start[first]];
  do {
    int next = p->face[2 * face + (p->face[2 * face] == node)];
    const double *a = node_at(p, node), *b = node_at(p, next);
    const int *fan = w->f->face + w->f->start[next];
    length += hypot(b[0] - a[0], b[1] - a[1]);
    face = fan[fan[0] == face];
    node = next;
  } while (node != first);
  do {
    int next = p->face[2 * face + (p->face[2 * face] == node)];
    const int *fan = w->f->face + w->f->start[next];
    w->l->loop[node] = length;
    face = fan[fan[0] == face];
    node = next;
  } while (node != first);
}

static status lay_straight(const average_patch *p, const fans *f, double apart,
                           layout *l) {
  status st = OK;
  walk w = {.p = p, .f = f, .l = l};
  NEW_ALL(OF(w.done, p->n_face), OF(l->loop, p->n_node));
  /* Lines with ends first; what is left is closed. */
  for (int i = 0; i < p->n_node; ++i)
    while (fan_size(f, i) != 2 && next_face(&w, i) >= 0) {
      lay_line(&w, i);
      w.row += apart;
    }
  for (int i = 0; i < p->n_node; ++i)
    if (next_face(&w, i) >= 0) {
      lay_line(&w, i);
      close_loop(&w, i);
      w.row += apart;
    }
done:
  memory_free(w.done);
  return st;
}

status layout_new(const average_patch *patch, const average_rule *rule,
                  layout *out) {
  status st = OK;
  fans f = {0};
  memset(out, 0, sizeof *out);
  TRY(fans_new(patch, &f));
  TRY(new_arrays(patch, out));
  set_mirrors(patch, rule, out);
  if (rule->geodesic)
    TRY(lay_straight(patch, &f, 4.0 * rule->radius, out));
  else
    lay_as_is(patch, &f, out);
done:
  fans_free(&f);
  if (st != OK) layout_free(out);
  return st;
}
