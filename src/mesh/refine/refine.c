/*
 * Bisection in rounds. A round marks the longest edges of the cells that are
 * too long, and of all cells that have a marked edge, until nothing is new.
 * Then every cell, of every dimension, is split at its longest marked edge, and
 * its parts again: a face is split alike from both sides, as the order of its
 * marked edges is one of the edges alone, by length and node numbers.
 */
#include "mesh/refine/parts.h"

#include "base/base.h"

enum { ROUNDS = 100, EDGES = 6 };
/* Elements are bisected whose length over that required is above the middle of
 * 1 and what the parts have; where none is, those above 1. */
static const double MIDDLE[] = {1.0, 1.0, 1.189207115002721, 1.122462048309373};
static const double SHARE = 0.2; /* -, least measure of a part on a curved edge
                                    over what a straight one gives */

typedef struct cell {
  int v[4];
  int block;
  size_t no;
} cell;

typedef struct cell_list {
  int n, cap;
  cell *item;
} cell_list;

typedef struct bisection {
  const refine_request *q;
  raw_mesh *raw;
  int dim, n_node;
  double *x;               /* [3*n_node] m */
  double square;           /* m2, so that no ratio to it is a round number */
  size_t *no;              /* [n_node] */
  cell_list cells[4];      /* by dimension, from 1 */
  unsigned char *is_round; /* [n_block] */
  size_t last_no;          /* of elements */
  key_table by_no;         /* of the elements that were split */
  key_table parts;         /* second parts, by the first's and the new node */
  key_table marked;        /* edges of a round */
  int first_mid;           /* node of the first of them */
  unsigned char *bent;     /* [marked.n] 1: not the mean of its ends */
  size_grid *sizes;
  round_surface *surface;
} bisection;

/* ---- from the raw mesh --------------------------------------------------- */

/* 1: only what is bisected here, points apart. */
static int is_simple(const raw_mesh *raw) {
  static const int type[] = {15, 1, 2, 4};
  for (EACH(const raw_block, p, raw->block, raw->n_block))
    if (p->dim < 0 || p->dim > 3 || p->type != type[p->dim]) return 0;
  return 1;
}

static int is_named(const bisection *b, const raw_block *p) {
  for (EACH(const raw_group, g, b->raw->group, b->raw->n_group))
    for (int k = 0; k < p->n_physical; ++k)
      if (g->dim == p->dim && g->tag == p->physical[k])
        for (int j = 0; j < b->q->n_round; ++j)
          if (strcmp(g->name, b->q->rounds[j]) == 0) return 1;
  return 0;
}

static status add_cell(cell_list *to, const cell *c) {
  PASS_GROW(to->item, to->n, to->cap);
  to->item[to->n++] = *c;
  return OK;
}

/* ERR_MESH: an element has a node that is not there. */
static status take_block(bisection *b, int block, const key_table *nodes) {
  const raw_block *p = &b->raw->block[block];
  b->is_round[block] = p->dim == b->dim - 1 && is_named(b, p) ? 1 : 0;
  for (size_t i = 0; i < p->n; ++i) {
    cell c = {.block = block, .no = p->no[i]};
    for (size_t k = 0; k < p->n_per; ++k) {
      c.v[k] = table_find(nodes, (uint64_t)p->node[p->n_per * i + k]);
      if (c.v[k] < 0) RAISE(ERR_MESH, "no node %zu", p->node[p->n_per * i + k]);
    }
    if (p->no[i] > b->last_no) b->last_no = p->no[i];
    if (p->dim > 0) PASS(add_cell(&b->cells[p->dim], &c));
  }
  return OK;
}

static status take(bisection *b) {
  const raw_mesh *raw = b->raw;
  ENDS_BY(table_free) key_table nodes = {0};
  int id;
  for (int i = 0; i < raw->n_block; ++i)
    if (raw->block[i].dim > b->dim) b->dim = raw->block[i].dim;
  b->n_node = (int)raw->n_node;
  PASS_NEW_ALL(OF(b->x, 3 * raw->n_node), OF(b->no, raw->n_node),
               OF(b->is_round, raw->n_block));
  for (int i = 0; i < b->n_node; ++i) {
    PASS(table_add(&nodes, (uint64_t)raw->node_no[i], &id));
    if (id != i) RAISE(ERR_MESH, "node %zu is there twice", raw->node_no[i]);
    b->no[i] = raw->node_no[i];
    for (int k = 0; k < 3; ++k)
      b->x[3 * i + k] = b->q->scale * raw->xyz[3 * i + k];
  }
  for (int i = 0; i < raw->n_block; ++i) PASS(take_block(b, i, &nodes));
  for (int k = 0; k < 3 * b->n_node; ++k)
    b->square = fmax(b->square, fabs(b->x[k] - b->x[k % 3]));
  b->square *= M_PI * b->square;
  return OK;
}

/* ---- lengths ------------------------------------------------------------- */

static void vector(const bisection *b, int from, int to, double *e) {
  for (int k = 0; k < 3; ++k) e[k] = b->x[3 * to + k] - b->x[3 * from + k];
}

/* Of fewer digits: what is equal but for rounding is so in all units. */
static float square_of(const bisection *b, int i, int k) {
  double e[3];
  vector(b, i < k ? i : k, i < k ? k : i, e);
  return (float)(dot(3, e, e) / b->square);
}

/* Signed area of a triangle in the plane, volume of a tetrahedron. */
static double measure_of(const bisection *b, const int *v) {
  double e[3][3];
  for (int k = 0; k < b->dim; ++k) vector(b, v[0], v[k + 1], e[k]);
  return determinant(b->dim, e) / (b->dim == 2 ? 2.0 : 6.0);
}

/* Length over that required, of fewer digits. */
static float excess_of(const bisection *b, const cell *c) {
  const double size = fabs(measure_of(b, c->v));
  double x[3] = {0.0};
  for (int a = 0; a <= b->dim; ++a)
    for (int k = 0; k < 3; ++k) x[k] += b->x[3 * c->v[a] + k] / (b->dim + 1);
  const double length =
      b->dim == 2 ? sqrt(size * 4.0 / sqrt(3.0)) : cbrt(size * 6.0 * sqrt(2.0));
  return (float)(length / size_grid_at(b->sizes, x));
}

/* Ends of a longer edge first; of equal ones by the numbers of their nodes. */
static int is_before(const bisection *b, const int *e, const int *f) {
  const float d = square_of(b, e[0], e[1]), g = square_of(b, f[0], f[1]);
  const size_t p[2] = {b->no[e[0]], b->no[e[1]]};
  const size_t q[2] = {b->no[f[0]], b->no[f[1]]};
  const int pl = p[0] > p[1], ql = q[0] > q[1];
  if (d > g || d < g) return d > g;
  return p[pl] != q[ql] ? p[pl] < q[ql] : p[!pl] < q[!ql];
}

/* The longest edge of a cell of that dimension, of the marked ones or of all;
 * end[2] its places there. 0: none. */
static int longest_of(const bisection *b, const int *v, int dim, int all,
                      int *end) {
  int found = 0;
  end[0] = end[1] = 0;
  for (int i = 0; i < dim; ++i)
    for (int k = i + 1; k <= dim; ++k) {
      const int edge[2] = {v[i], v[k]};
      const int best[2] = {v[found ? end[0] : i], v[found ? end[1] : k]};
      if (!all && table_find(&b->marked, key_of(v[i], v[k])) < 0) continue;
      if (found && !is_before(b, edge, best)) continue;
      end[0] = i;
      end[1] = k;
      found = 1;
    }
  return found;
}

/* ---- a round ------------------------------------------------------------- */

static status mark_longest(bisection *b, const cell *c, int *more) {
  int end[2], id, before = b->marked.n;
  longest_of(b, c->v, b->dim, 1, end);
  PASS(table_add(&b->marked, key_of(c->v[end[0]], c->v[end[1]]), &id));
  *more |= b->marked.n > before;
  return OK;
}

/* Marks edges of the cells beyond the limit; *worst: the largest excess. */
static status mark_long(bisection *b, double limit, double *worst) {
  const cell_list *top = &b->cells[b->dim];
  int more = 0;
  *worst = 0.0;
  for (int i = 0; i < top->n; ++i) {
    const float excess = excess_of(b, &top->item[i]);
    *worst = fmax(*worst, excess);
    if (excess > limit) PASS(mark_longest(b, &top->item[i], &more));
  }
  return OK;
}

static status mark_neighbours(bisection *b) {
  const cell_list *top = &b->cells[b->dim];
  int more = 1, end[2];
  while (more) {
    more = 0;
    for (int i = 0; i < top->n; ++i)
      if (longest_of(b, top->item[i].v, b->dim, 0, end))
        PASS(mark_longest(b, &top->item[i], &more));
  }
  return OK;
}

/* The faces that may be curved, as nodes: new. */
static status find_surface(bisection *b) {
  const cell_list *low = &b->cells[b->dim - 1];
  surface_faces f = {.n_node = b->dim};
  OWNED_NEW(int, node, b->dim * low->n);
  for (int i = 0; i < low->n; ++i) {
    if (!b->is_round[low->item[i].block]) continue;
    for (int k = 0; k < b->dim; ++k) node[b->dim * f.n + k] = low->item[i].v[k];
    ++f.n;
  }
  f.node = node;
  FORGET(b->surface);
  return round_surface_new(&f, b->n_node, b->x, &b->surface);
}

/* Space for the middles of all marked edges; numbers beyond all others. */
static status grow(bisection *b) {
  const size_t n = b->n_node, all = n + b->marked.n;
  OWNED double *x = b->x;
  OWNED size_t *no = b->no;
  size_t last = 0;
  b->x = NULL;
  b->no = NULL;
  PASS_NEW_ALL(OF(b->x, 3 * all), OF(b->no, all));
  COPY(b->x, x, 3 * n);
  COPY(b->no, no, n);
  for (size_t i = 0; i < n; ++i) last = no[i] > last ? no[i] : last;
  for (size_t i = n; i < all; ++i) b->no[i] = ++last;
  FORGET(b->bent);
  PASS_NEW(b->bent, b->marked.n);
  return OK;
}

/* The middle of edge id is the mean of its ends. */
static void straighten(bisection *b, int id, int p, int q) {
  double *x = b->x + 3 * (b->first_mid + id);
  for (int k = 0; k < 3; ++k) x[k] = 0.5 * (b->x[3 * p + k] + b->x[3 * q + k]);
  b->bent[id] = 0;
}

/* A new node for each marked edge, in the order of marking. */
static status add_middles(bisection *b) {
  PASS(grow(b));
  PASS(find_surface(b));
  OWNED_NEW(uint64_t, key, b->marked.n);
  for (size_t k = 0; k < b->marked.n_slot; ++k)
    if (b->marked.id[k] > 0) key[b->marked.id[k] - 1] = b->marked.key[k];
  b->first_mid = b->n_node;
  for (int id = 0; id < b->marked.n; ++id) {
    const int p = (int)(key[id] >> 32), q = (int)(uint32_t)key[id];
    straighten(b, id, p, q);
    b->bent[id] = (unsigned char)round_surface_middle(
        b->surface, p, q, b->x + 3 * (b->n_node + id));
  }
  b->n_node += b->marked.n;
  return OK;
}

/* Splits v into parts[2*4] at the edge with these places. */
static void halve(const bisection *b, const int *v, const int *end,
                  int *parts) {
  const int first = v[end[0]] < v[end[1]] ? 0 : 1;
  const int mid =
      b->first_mid + table_find(&b->marked, key_of(v[end[0]], v[end[1]]));
  COPY(parts, v, 4);
  COPY(parts + 4, v, 4);
  parts[end[!first]] = mid;
  parts[4 + end[first]] = mid;
}

/* 1: all parts of a cell have their share of its measure. */
static int is_sound(const bisection *b, const int *v, double whole) {
  int end[2], parts[8];
  if (!longest_of(b, v, b->dim, 0, end))
    return measure_of(b, v) / whole > SHARE;
  halve(b, v, end, parts);
  return is_sound(b, parts, 0.5 * whole) && is_sound(b, parts + 4, 0.5 * whole);
}

/* Middles go back to their edges where parts would be turned over. */
static void check_middles(bisection *b) {
  const cell_list *top = &b->cells[b->dim];
  for (int again = 1; again;) {
    again = 0;
    for (int i = 0; i < top->n; ++i) {
      const int *v = top->item[i].v;
      int bent[EDGES], n = 0, end[EDGES][2];
      for (int p = 0; p < b->dim; ++p)
        for (int q = p + 1; q <= b->dim; ++q) {
          const int id = table_find(&b->marked, key_of(v[p], v[q]));
          if (id < 0 || !b->bent[id]) continue;
          end[n][0] = v[p];
          end[n][1] = v[q];
          bent[n++] = id;
        }
      if (n == 0 || is_sound(b, v, measure_of(b, v))) continue;
      for (int k = 0; k < n; ++k) straighten(b, bent[k], end[k][0], end[k][1]);
      again = 1;
    }
  }
}

/* The number of the second part: one of an element listed twice. */
static status number_part(bisection *b, size_t no, int mid, size_t *out) {
  int of, part;
  PASS(table_add(&b->by_no, (uint64_t)no, &of));
  PASS(table_add(&b->parts, table_key(of, mid), &part));
  *out = b->last_no + 1 + (size_t)part;
  return OK;
}

static status split(bisection *b, int dim, const cell *c, cell_list *to) {
  int end[2], parts[8];
  if (!longest_of(b, c->v, dim, 0, end)) return add_cell(to, c);
  halve(b, c->v, end, parts);
  cell part = *c;
  memcpy(part.v, parts, sizeof part.v);
  PASS(split(b, dim, &part, to));
  memcpy(part.v, parts + 4, sizeof part.v);
  const int mid =
      b->first_mid + table_find(&b->marked, key_of(c->v[end[0]], c->v[end[1]]));
  PASS(number_part(b, c->no, mid, &part.no));
  return split(b, dim, &part, to);
}

/* *done: no element is too long. */
static status run_round(bisection *b, double *limit, int *done) {
  double worst;
  table_free(&b->marked);
  PASS(mark_long(b, *limit, &worst));
  if (b->marked.n == 0 && b->first_mid == 0 && worst > 1.0) {
    *limit = 1.0;
    PASS(mark_long(b, *limit, &worst));
  }
  *done = b->marked.n == 0;
  if (*done) return OK;
  PASS(mark_neighbours(b));
  PASS(add_middles(b));
  check_middles(b);
  for (int d = 1; d <= b->dim; ++d) {
    cell_list next = {0};
    for (int i = 0; i < b->cells[d].n; ++i)
      PASS(split(b, d, &b->cells[d].item[i], &next));
    memory_free(b->cells[d].item);
    b->cells[d] = next;
  }
  return OK;
}

/* ---- back to the raw mesh ------------------------------------------------ */

static status give_block(const bisection *b, raw_block *p, int block) {
  const cell_list *from = &b->cells[p->dim];
  size_t n = 0;
  for (int i = 0; i < from->n; ++i) n += from->item[i].block == block;
  RELEASE(p->no, p->node);
  p->no = p->node = NULL;
  p->n = 0;
  PASS_NEW_ALL(OF(p->no, n), OF(p->node, p->n_per * n));
  for (EACH(const cell, c, from->item, from->n)) {
    if (c->block != block) continue;
    p->no[p->n] = c->no;
    for (size_t k = 0; k < p->n_per; ++k)
      p->node[p->n_per * p->n + k] = b->no[c->v[k]];
    ++p->n;
  }
  return OK;
}

static status give(const bisection *b) {
  raw_mesh *raw = b->raw;
  const size_t n = b->n_node, before = raw->n_node;
  OWNED double *old = raw->xyz;
  OWNS(raw);
  FORGET(raw->node_no);
  raw->xyz = NULL;
  raw->n_node = 0;
  PASS_NEW_ALL(OF(raw->node_no, n), OF(raw->xyz, 3 * n));
  raw->n_node = n;
  COPY(raw->node_no, b->no, n);
  for (size_t k = 0; k < 3 * n; ++k) raw->xyz[k] = b->x[k] / b->q->scale;
  COPY(raw->xyz, old, 3 * before);
  for (int i = 0; i < raw->n_block; ++i)
    if (raw->block[i].dim > 0) PASS(give_block(b, &raw->block[i], i));
  return OK;
}

status raw_refine(raw_mesh *raw, const refine_request *q) {
  bisection b = {.q = q, .raw = raw};
  int done = 0;
  if (!is_simple(raw)) return OK;
  SCRATCH;
  PASS(take(&b));
  if (b.dim < 2) return OK;
  PASS(size_grid_new(&q->sizes, &b.sizes));
  double limit = MIDDLE[b.dim];
  for (int round = 0; round < ROUNDS && !done; ++round)
    PASS(run_round(&b, &limit, &done));
  if (b.first_mid > 0) PASS(give(&b));
  return OK;
}
