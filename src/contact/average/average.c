/*
 * Rows of the kernel against the P1 functions, then the symmetric matrix with
 * the exact mass (average.h).
 */
#include "contact/average/average.h"

#include "base/base.h"
#include "base/box_tree.h"

/* ---- where distances are measured: on the patch itself, or on its lines laid
 * out straight. The straight layout copies the patch; the geodesic one follows
 * the lines and lays each out on its own row, too far apart to interact. ----
 */

typedef struct layout {
  int dim, n_face, n_rim;
  double *x;      /* [dim*n_node] place of a node, m */
  double *corner; /* [dim*dim*n_face] corners of the faces, m */
  double *loop;   /* [n_node] length of the closed line of a node laid out
                     straight, 0: none; or NULL */
  double *rim;    /* [dim*(dim-1)*n_rim] end points (edges) of the patch that
                     lie on no mirror, m */
  int has_mirror[3];
  double mirror[3]; /* place of the mirrors by axis, m */
  double near;      /* nearer to a mirror is on it, m */
} layout;

/* A node this near to the axis, over the largest radius, is on it. */
static const double ON_AXIS = 1e-9;
static const double ON_MIRROR = 1e-9; /* over the radius of the average */

/* Faces around the nodes of a patch. */
typedef struct fans {
  size_t *start; /* of number_places */
  int *face;
} fans;

static status fans_new(const average_patch *p, fans *f) {
  return number_places(p->n_node, (size_t)p->dim * p->n_face, p->face, p->dim,
                       &f->start, &f->face);
}

static size_t fan_size(const fans *f, int node) {
  return f->start[node + 1] - f->start[node];
}

static const double *node_at(const average_patch *p, int node) {
  return p->x + (size_t)p->dim * node;
}

static int on_axis(const average_patch *p, int node) {
  double largest = 0.0;
  if (!p->axisymmetric) return 0;
  for (int i = 0; i < p->n_node; ++i) largest = fmax(largest, node_at(p, i)[0]);
  return node_at(p, node)[0] <= ON_AXIS * largest;
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
  size_t dim = l->dim;
  if (on_mirror(l, corners, corner)) return;
  double *to = l->rim + (dim - 1) * dim * l->n_rim++;
  for (int k = 0; k < corners; ++k) COPY(to + dim * k, corner[k], dim);
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
  for (size_t k = f->start[a]; k < f->start[a + 1]; ++k)
    for (int c = 0; c < p->dim; ++c) n += p->face[p->dim * f->face[k] + c] == b;
  return n;
}

static void lay_as_is(const average_patch *p, const fans *f, layout *l) {
  size_t dim = p->dim;
  COPY(l->x, p->x, dim * p->n_node);
  for (int k = 0; k < p->dim * p->n_face; ++k) {
    int a = p->face[k];
    int b = k % p->dim == p->dim - 1 ? p->face[k + 1 - p->dim] : p->face[k + 1];
    const double *ends[2] = {node_at(p, a), node_at(p, b)};
    COPY(l->corner + dim * k, ends[0], dim);
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
  for (size_t k = w->f->start[node]; k < w->f->start[node + 1]; ++k)
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
  OWNED_NEW(unsigned char, done, p->n_face);
  walk w = {.p = p, .f = f, .l = l, .done = done};
  PASS_NEW(l->loop, p->n_node);
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
  return OK;
}

static status layout_new(const average_patch *patch, const average_rule *rule,
                         layout *out) {
  memset(out, 0, sizeof *out);
  OWNED_PARTS(fans, f, fans_new(patch, &f));
  size_t dim = patch->dim;
  out->dim = patch->dim;
  out->n_face = patch->n_face;
  PASS_NEW_ALL(OF(out->x, dim * patch->n_node),
               OF(out->corner, dim * dim * patch->n_face),
               OF(out->rim, dim * dim * dim * (patch->n_face + 1)));
  set_mirrors(patch, rule, out);
  if (rule->geodesic)
    PASS(lay_straight(patch, &f, 4.0 * rule->radius, out));
  else
    lay_as_is(patch, &f, out);
  return OK;
}

/* ---- the builder ---- */

/* Of the radius: lengths that differ by less are equal. */
static const double ROUNDING = 1e-9;

typedef struct builder {
  const average_patch *p;
  const average_rule *rule;
  mollifier m;
  layout at;
  box_tree faces, rim;
  double *share;              /* [n_node] l_i: integral of phi_i, m or m2 */
  double *mass;               /* [n_node] W_i, - */
  sparse_rows raw, by_column; /* g_ij and its transpose, - */
  unsigned char *alone;       /* [n_node] no other node within the radius */
  double *part;               /* [n_node] share of its pairs its mass allows */
  int *found;                 /* [faces or rim] */
  int *touched, n_touched;    /* [n_node] columns of the current row */
  double *row;                /* [n_node] its values */
  int neighbours;             /* other active nodes within the radius */
  int cut;                    /* 1: a face with a node left out is within it */
} builder;

static status builder_new(builder *b) {
  int n = b->p->n_node, dim = b->p->dim;
  int line = dim == 2 && !b->p->axisymmetric;
  b->m = mollifier_make(b->rule->kernel, b->rule->radius, line ? 1 : 2);
  PASS(layout_new(b->p, b->rule, &b->at));
  PASS(box_tree_new(dim, b->at.n_face, dim, b->at.corner, &b->faces));
  PASS(box_tree_new(dim, b->at.n_rim, dim - 1, b->at.rim, &b->rim));
  PASS_NEW_ALL(OF(b->share, n), OF(b->mass, n), OF(b->raw.start, n + 1));
  b->raw.n = n;
  PASS_NEW_ALL(OF(b->alone, n), OF(b->part, n),
               OF(b->found, b->at.n_face + b->at.n_rim), OF(b->touched, n),
               OF(b->row, n));
  return OK;
}

/* ---- the patch --------------------------------------------------------- */

/* Integrals of the P1 functions. */
static void find_shares(builder *b) {
  const average_patch *p = b->p;
  for (int f = 0; f < p->n_face; ++f) {
    const double *x = b->at.corner + (size_t)(p->dim * p->dim) * f;
    const int *node = p->face + p->dim * f;
    double n[3], size = p->dim == 3 ? 0.5 * triangle_normal(x, n)
                                    : distance_of(2, x, x + 2);
    for (int k = 0; k < p->dim; ++k) {
      double weight = 1.0 / p->dim;
      if (p->axisymmetric) weight = (2.0 * x[2 * k] + x[2 * !k]) / 6.0;
      b->share[node[k]] += weight * size;
    }
  }
}

/* Lengths of the edges against the radius. */
static void find_facts(const builder *b, average_facts *facts,
                       unsigned char *coarse) {
  const average_patch *p = b->p;
  memset(facts, 0, sizeof *facts);
  for (int k = 0; k < p->dim * p->n_face; ++k) {
    int next = k % p->dim == p->dim - 1 ? k + 1 - p->dim : k + 1;
    double length = distance_of(p->dim, b->at.corner + p->dim * k,
                                b->at.corner + p->dim * next);
    facts->longest = fmax(facts->longest, length);
    if (4.0 * length > b->rule->radius * (1.0 + ROUNDING))
      coarse[p->face[k]] = coarse[p->face[next]] = 1;
  }
  for (int i = 0; i < p->n_node; ++i) {
    if (!p->active[i]) continue;
    ++facts->n_active;
    facts->n_coarse += coarse[i];
    facts->n_local += b->alone[i];
  }
}

/* ---- rows of the kernel ------------------------------------------------ */

/* 1 if a face with a node that carries no pressure lies within the disc. */
static int cuts(const builder *b, int face, const double *x, double reach) {
  const average_patch *p = b->p;
  const double *corner = b->at.corner + (size_t)(p->dim * p->dim) * face;
  int left_out = 0;
  for (int k = 0; k < p->dim; ++k)
    left_out |= !p->active[p->face[p->dim * face + k]];
  return left_out &&
         face_distance(p->dim, corner, x) < reach * (1.0 - ROUNDING);
}

static void add_face(builder *b, int i, int face, const double *x,
                     double reach) {
  const average_patch *p = b->p;
  const double *corner = b->at.corner + (size_t)(p->dim * p->dim) * face;
  double weight[3];
  b->cut |= cuts(b, face, x, reach);
  if (p->dim == 3)
    face_triangle(&b->m, corner, x, weight);
  else if (p->axisymmetric)
    face_ring(&b->m, reach, corner, x, weight);
  else
    face_line(&b->m, reach, corner, x, weight);
  for (int k = 0; k < p->dim; ++k) {
    int j = p->face[p->dim * face + k];
    if (j != i && p->active[j] &&
        distance_of(p->dim, x, corner + p->dim * k) < reach * (1.0 - ROUNDING))
      ++b->neighbours;
    if (!(weight[k] > 0.0)) continue;
    if (b->row[j] == 0.0) b->touched[b->n_touched++] = j;
    b->row[j] += weight[k];
  }
}

/* Entries of a node from one place; a closed line laid out straight is treated
 * from three. */
static void look_from(builder *b, int i, const double *x, double reach) {
  int n = box_tree_near(&b->faces, x, reach, b->found);
  for (int k = 0; k < n; ++k) add_face(b, i, b->found[k], x, reach);
}

/* The images of a place in the mirrors, and in two or three one after the
 * other. */
static void look_from_images(builder *b, int i, const double *x, double reach) {
  for (int mask = 1; mask < 1 << b->p->dim; ++mask) {
    double image[3];
    int there = 1;
    for (int c = 0; c < b->p->dim; ++c) {
      int turned = mask >> c & 1;
      image[c] = turned ? 2.0 * b->at.mirror[c] - x[c] : x[c];
      there = there && (!turned || b->at.has_mirror[c]);
    }
    if (there) look_from(b, i, image, reach);
  }
}

static void look_around(builder *b, int i) {
  const double *x = b->at.x + (size_t)b->p->dim * i;
  double length = b->at.loop == NULL ? 0.0 : b->at.loop[i];
  double reach = b->rule->radius;
  b->n_touched = b->neighbours = b->cut = 0;
  if (length > 0.0) {
    const double before[2] = {x[0] - length, x[1]};
    const double after[2] = {x[0] + length, x[1]};
    reach = fmin(reach, 0.5 * length);
    look_from(b, i, before, reach);
    look_from(b, i, after, reach);
  }
  look_from(b, i, x, reach);
  look_from_images(b, i, x, reach);
}

/* 1 if the disc around node i reaches beyond the patch. */
static int meets_rim(builder *b, int i) {
  int dim = b->p->dim, corners = dim - 1;
  const double *x = b->at.x + (size_t)dim * i;
  int n = box_tree_near(&b->rim, x, b->rule->radius, b->found);
  for (int k = 0; k < n; ++k) {
    const double *a = b->at.rim + (size_t)(dim * corners) * b->found[k];
    double d = corners == 1 ? distance_of(dim, a, x)
                            : face_segment_distance(dim, a, a + dim, x);
    if (d < b->rule->radius * (1.0 - ROUNDING)) return 1;
  }
  return 0;
}

static status add_entry(sparse_rows *rows, int *n, int cap[2], int col,
                        double val) {
  PASS_GROW(rows->col, *n, cap[0]);
  PASS_GROW(rows->val, *n, cap[1]);
  rows->col[*n] = col;
  rows->val[(*n)++] = val;
  return OK;
}

/* Row i of raw from these entries, scaled to its mass. */
static status keep_row(builder *b, int i, int cap[2]) {
  double seen = 0.0;
  int n = b->raw.start[i];
  qsort(b->touched, b->n_touched, sizeof *b->touched, number_order);
  for (int k = 0; k < b->n_touched; ++k) {
    int j = b->touched[k];
    if (b->p->active[j]) seen += b->row[j];
  }
  b->alone[i] = b->neighbours == 0;
  int whole = !b->cut && !meets_rim(b, i);
  b->mass[i] = whole || b->alone[i] ? 1.0 : fmin(1.0, seen);
  for (int k = 0; k < b->n_touched; ++k) {
    int j = b->touched[k];
    double value = b->row[j] * (b->mass[i] / seen);
    b->row[j] = 0.0;
    if (b->p->active[j]) PASS(add_entry(&b->raw, &n, cap, j, value));
  }
  b->raw.start[i + 1] = n;
  return OK;
}

static status transpose(const sparse_rows *a, sparse_rows *out) {
  OWNED_NEW(int, start, a->n + 2);
  PASS_NEW_ALL(OF(out->col, a->start[a->n]), OF(out->val, a->start[a->n]));
  for (int k = 0; k < a->start[a->n]; ++k) ++start[a->col[k] + 2];
  for (int i = 0; i < a->n; ++i) start[i + 2] += start[i + 1];
  for (int i = 0; i < a->n; ++i)
    for (int k = a->start[i]; k < a->start[i + 1]; ++k) {
      int to = start[a->col[k] + 1]++;
      out->col[to] = i;
      out->val[to] = a->val[k];
    }
  out->n = a->n;
  out->start = start;
  start = NULL;
  return OK;
}

/* ---- the symmetric matrix ---------------------------------------------- */

/* l_i G_ij of a pair, so that no node gives away more than its mass. */
static double pair_value(const builder *b, int i, int j, double ij, double ji) {
  double one = b->share[i] * ij, other = b->share[j] * ji;
  double part = b->part[i] < b->part[j] ? b->part[i] : b->part[j];
  return 0.5 * (one + other) * part;
}

/* Row i of G into col, val; returns the number of its entries. *left is what
 * the diagonal gets, times l_i. */
static int merge_row(const builder *b, int i, int *col, double *val,
                     double *left) {
  const sparse_rows *r = &b->raw, *c = &b->by_column;
  int k = r->start[i], end = r->start[i + 1], n = 0, place = -1;
  int h = c->start[i], last = c->start[i + 1];
  *left = b->share[i] * b->mass[i];
  while (!b->alone[i] && (k < end || h < last)) {
    int jk = k < end ? r->col[k] : b->p->n_node;
    int jh = h < last ? c->col[h] : b->p->n_node, j = jk < jh ? jk : jh;
    double ij = jk == j ? r->val[k++] : 0.0, ji = jh == j ? c->val[h++] : 0.0;
    if (b->alone[j]) continue;
    col[n] = j;
    if (j == i) place = n;
    val[n] = j == i ? 0.0 : pair_value(b, i, j, ij, ji);
    *left -= val[n++];
  }
  if (place < 0) col[place = n++] = i;
  val[place] = fmax(*left, 0.0);
  return n;
}

/* Row val[n] of nodes col[n] for a pressure on parts of their faces; normalised
 * it keeps a constant pressure. */
static void cut_row(const builder *b, int n, const int *col, double *val) {
  double whole = 0.0, left = 0.0;
  if (b->p->part == NULL) return;
  for (int k = 0; k < n; ++k) {
    whole += val[k];
    if (!b->alone[col[k]]) val[k] *= b->p->part[col[k]];
    left += val[k];
  }
  for (int k = 0; k < n && b->rule->normalized && left > 0.0; ++k)
    val[k] *= whole / left;
}

static status symmetrise(builder *b, sparse_rows *out) {
  const average_patch *p = b->p;
  OWNED double *part = NULL;
  double left;
  PASS_NEW_ALL(OF(part, p->n_node), OF(out->start, p->n_node + 1));
  out->n = p->n_node;
  for (int i = 0; i < p->n_node; ++i) b->part[i] = 1.0;
  for (int i = 0; i < p->n_node; ++i) {
    int n = p->active[i] ? merge_row(b, i, b->touched, b->row, &left) : 0;
    out->start[i + 1] = out->start[i] + n;
    double all = b->share[i] * b->mass[i];
    part[i] = n > 0 && left < 0.0 ? all / (all - left) : 1.0;
  }
  COPY(b->part, part, p->n_node);
  PASS_NEW(out->col, out->start[p->n_node]);
  PASS_NEW(out->val, out->start[p->n_node]);
  for (int i = 0; i < p->n_node; ++i) {
    int first = out->start[i], n = out->start[i + 1] - first;
    double by = b->share[i];
    if (n == 0) continue;
    if (b->rule->normalized && b->mass[i] > 0.0) by *= b->mass[i];
    merge_row(b, i, out->col + first, out->val + first, &left);
    for (int k = first; k < first + n; ++k) out->val[k] /= by;
    cut_row(b, n, out->col + first, out->val + first);
  }
  return OK;
}

static status set_rows(builder *b) {
  OWNS(b);
  PASS(builder_new(b));
  find_shares(b);
  int cap[2] = {0, 0};
  for (int i = 0; i < b->p->n_node; ++i) {
    b->raw.start[i + 1] = b->raw.start[i];
    if (!b->p->active[i]) continue;
    look_around(b, i);
    PASS(keep_row(b, i, cap));
  }
  return transpose(&b->raw, &b->by_column);
}

status average_build(const average_patch *patch, const average_rule *rule,
                     sparse_rows *out, average_facts *facts) {
  memset(out, 0, sizeof *out);
  OWNED_NEW(builder, b, 1);
  *b = (builder){.p = patch, .rule = rule};
  PASS(set_rows(b));
  PASS(symmetrise(b, out));
  OWNED_NEW(unsigned char, coarse, patch->n_node);
  find_facts(b, facts, coarse);
  return OK;
}
