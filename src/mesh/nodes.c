/*
 * Nodes: found by number, ordered along a Hilbert curve, checked.
 *
 * The order depends on coordinates (on numbers where nodes coincide). Curve: J.
 * Skilling, Programming the Hilbert curve, AIP Conf. Proc. 707 (2004) 381.
 */
#include "base/base.h"
#include "mesh/build.h"
#include "mesh/sort.h"

enum { CURVE_BITS = 20 };

/* Two nodes closer than this part of the extent of the mesh are one place. */
static const double same_place = 1e-10;
/* z may vary by this part of the extent in a plane mesh (ASCII digits). */
static const double plane_digits = 1e-9;

/* Numbers without gaps index a table directly; others are hashed. */
static size_t slot_of(const number_table *t, size_t no) {
  size_t mask = ((size_t)1 << t->bits) - 1, upper = no >> t->bits;
  size_t s = (no + upper * 0x9E3779B97F4A7C15u) & mask;
  while (t->slot[s] != 0 && t->no[t->slot[s] - 1] != no) s = (s + 1) & mask;
  return s;
}

static status numbers_index(number_table *t, int n, const size_t *no) {
  t->no = no;
  while (((size_t)1 << t->bits) < 2 * (size_t)n + 2) ++t->bits;
  PASS_NEW(t->slot, (size_t)1 << t->bits);
  for (int i = 0; i < n; ++i) {
    size_t s = slot_of(t, no[i]);
    if (t->slot[s] == 0) t->slot[s] = i + 1;
  }
  return OK;
}

/* The first of the items with the number, -1: none; numbers may repeat. */
static int numbers_find(const number_table *t, size_t no) {
  return t->slot[slot_of(t, no)] - 1;
}

static int ascend(int n, const size_t *no) {
  for (int i = 1; i < n; ++i)
    if (no[i] <= no[i - 1]) return 0;
  return 1;
}

status numbers_check(builder *b, const char *what, int n, const size_t *no,
                     const int *id) {
  faults bad = {0};
  if (ascend(n, no)) return OK;
  OWNED_PARTS(number_table, t, numbers_index(&t, n, no));
  for (int i = 0; i < n; ++i) {
    int j = numbers_find(&t, no[i]);
    if (j != i && (id == NULL || id[j] != id[i])) fault_add(&bad, "%zu", no[i]);
  }
  if (bad.n > 0)
    message_add(b->log, P3029, b->at,
                "%d %s(s) have the number of another one: %s", bad.n, what,
                bad.text);
  return build_check(b);
}

status nodes_index(builder *b) {
  const raw_mesh *raw = b->raw;
  PASS(numbers_index(&b->by_no, (int)raw->n_node, raw->node_no));
  return numbers_check(b, "node", (int)raw->n_node, raw->node_no, NULL);
}

int nodes_find(const builder *b, size_t no) {
  return numbers_find(&b->by_no, no);
}

/* Bit b of x to place dim*b of the key. */
static uint64_t spread(uint32_t x, int dim) {
  uint64_t key = 0;
  for (int bit = 0; bit < CURVE_BITS; ++bit)
    key |= (uint64_t)((x >> bit) & 1) << (dim * bit);
  return key;
}

/* Position on the curve that fills the square or cube of side 2^bits. */
static uint64_t on_curve(uint32_t *x, int dim) {
  for (int bit = CURVE_BITS - 1; bit > 0; --bit) {
    const uint32_t low = ((uint32_t)1 << bit) - 1;
    for (int i = 0; i < dim;
         ++i) { /* without a branch, which would be mispredicted */
      uint32_t is_set = 0 - ((x[i] >> bit) & 1), t = (x[0] ^ x[i]) & low;
      x[0] ^= (is_set & low) | (~is_set & t);
      x[i] ^= ~is_set & t;
    }
  }
  for (int i = 1; i < dim; ++i) x[i] ^= x[i - 1];
  uint32_t t = x[dim - 1] >> 1; /* parity of the bits above each */
  for (int shift = 1; shift < 32; shift *= 2) t ^= t >> shift;
  uint64_t key = 0;
  for (int i = 0; i < dim; ++i) key |= spread(x[i] ^ t, dim) << (dim - 1 - i);
  return key;
}

/* Bounding box of the used nodes; others than finite are reported. */
static status find_box(builder *b, double lo[3], double hi[3]) {
  faults bad = {0};
  for (int k = 0; k < 3; ++k) {
    lo[k] = HUGE_VAL;
    hi[k] = -HUGE_VAL;
  }
  for (size_t i = 0; i < b->raw->n_node; ++i) {
    const double *x = b->raw->xyz + 3 * i;
    if (b->node_id[i] < 0) continue;
    int finite = 1;
    for (int k = 0; k < 3; ++k) {
      double v = x[k] * b->scale;
      finite &= isfinite(v) != 0;
      lo[k] = fmin(lo[k], v);
      hi[k] = fmax(hi[k], v);
    }
    if (!finite) fault_at(&bad, 3, b->raw->node_no[i], x);
  }
  if (bad.n > 0)
    message_add(b->log, P3023, b->at,
                "%d node(s) without finite coordinates: %s", bad.n, bad.text);
  return build_check(b);
}

static status check_plane(builder *b, const double lo[3], const double hi[3]) {
  double size = fmax(hi[0] - lo[0], hi[1] - lo[1]);
  double digits =
      64.0 * 2.2204460492503131e-16 * fmax(fabs(lo[2]), fabs(hi[2]));
  if (b->m->dim == 3 || hi[2] - lo[2] <= plane_digits * size + digits)
    return OK;
  int k = hi[0] - lo[0] == 0.0 ? 0 : hi[1] - lo[1] == 0.0 ? 1 : -1;
  const char *volumes = b->raw->n_entity[3] > 0
                            ? "; the volumes of the file are in no group"
                            : "";
  if (k >= 0)
    message_add(b->log, P3024, b->at,
                "the surfaces lie in the plane %c = %.6g, not in z = const%s",
                "xy"[k], lo[k], volumes);
  else
    message_add(b->log, P3024, b->at,
                "the surfaces are not plane: z runs from %.6g to %.6g%s", lo[2],
                hi[2], volumes);
  return build_check(b);
}

/* Nodes in one cell of the curve. */
static int by_coordinates(const void *ctx, int a, int b) {
  const raw_mesh *raw = ctx;
  const double *x = raw->xyz + 3 * (size_t)a, *y = raw->xyz + 3 * (size_t)b;
  for (int k = 0; k < 3; ++k)
    if (x[k] != y[k]) return x[k] < y[k] ? -1 : 1;
  return (raw->node_no[a] > raw->node_no[b]) -
         (raw->node_no[a] < raw->node_no[b]);
}

/* The cells are shifted by odd fractions: round coordinates, which many
 * nodes share up to the last bit, are inside of cells and not between. */
static void fill_keys(const builder *b, const double lo[3], sort_item *item) {
  static const double shift[3] = {0.1321, 0.1732, 0.1579};
  const double cells = 1 << CURVE_BITS, share = 0.7071;
  int n = 0;
  for (size_t i = 0; i < b->raw->n_node; ++i) {
    if (b->node_id[i] < 0) continue;
    uint32_t cell[3];
    for (int k = 0; k < b->m->dim; ++k) {
      double part = b->raw->xyz[3 * i + k] * b->scale - lo[k];
      cell[k] = (uint32_t)((shift[k] + share * (part / b->m->size)) * cells);
    }
    item[n++] = (sort_item){on_curve(cell, b->m->dim), (int)i};
  }
}

static status store_nodes(builder *b, const sort_item *item) {
  mesh *m = b->m;
  size_t dim = m->dim;
  PASS_NEW_ALL(OF(m->x, dim * m->n_node), OF(m->node_no, m->n_node));
  for (int i = 0; i < m->n_node; ++i) {
    size_t r = item[i].id;
    for (size_t k = 0; k < dim; ++k)
      m->x[dim * i + k] = b->raw->xyz[3 * r + k] * b->scale;
    if (dim == 2) m->z = b->raw->xyz[3 * r + 2] * b->scale;
    m->node_no[i] = b->raw->node_no[r];
    b->node_id[r] = i;
  }
  return OK;
}

/* The nodes of the top elements get their ids. */
status nodes_order(builder *b) {
  mesh *m = b->m;
  double lo[3], hi[3];
  for (size_t i = 0; i < b->raw->n_node; ++i) m->n_node += b->node_id[i] >= 0;
  PASS(find_box(b, lo, hi));
  PASS(check_plane(b, lo, hi));
  for (int k = 0; k < m->dim; ++k) m->size = fmax(m->size, hi[k] - lo[k]);
  OWNED_NEW(sort_item, item, m->n_node);
  if (m->size ==
      0.0) { /* all in one point: the check of the elements reports it */
    for (size_t i = 0, n = 0; i < b->raw->n_node; ++i)
      if (b->node_id[i] >= 0) item[n++].id = (int)i;
  } else {
    fill_keys(b, lo, item);
  }
  PASS(sort_items(m->n_node, item, by_coordinates, b->raw));
  PASS(store_nodes(b, item));
  size_t unused = b->raw->n_node - m->n_node;
  if (unused > 0 && !b->raw->made)
    message_add(b->log, P3040, b->at,
                "%zu node(s) of the file are in no element", unused);
  return OK;
}

static int coincide(const mesh *m, int a, int c) {
  size_t dim = m->dim;
  double square = 0.0, near = same_place * m->size;
  for (size_t k = 0; k < dim; ++k) {
    double d = m->x[dim * a + k] - m->x[dim * c + k];
    square += d * d / near / near; /* no overflow in any unit */
  }
  return square <= 1.0;
}

static status body_of_nodes(const mesh *m, int *body_of) {
  int n_body, corners = m->dim + 1;
  OWNED_NEW(int, body, m->n_elem);
  PASS(mesh_bodies(m, &n_body, body));
  for (size_t i = 0; i < (size_t)corners * m->n_elem; ++i)
    body_of[m->elem[i]] = body[i / corners];
  return OK;
}

/* Nodes at one place follow each other along the curve. */
status nodes_coincident(builder *b) {
  const mesh *m = b->m;
  faults slit = {0}, touch = {0};
  OWNED int *body_of = NULL;
  for (int i = 1; i < m->n_node; ++i) {
    if (!coincide(m, i - 1, i)) continue;
    if (body_of == NULL) {
      PASS_NEW(body_of, m->n_node);
      PASS(body_of_nodes(m, body_of));
    }
    fault_at(body_of[i - 1] == body_of[i] ? &slit : &touch, m->dim,
             m->node_no[i], mesh_node_x(m, i));
  }
  if (slit.n > 0)
    message_add(b->log, P3041, b->at,
                "%d node(s) lie on another node of the same body: %s", slit.n,
                slit.text);
  if (touch.n > 0 && !b->raw->meets)
    message_add(b->log, P3042, b->at,
                "%d node(s) lie on a node of another body: %s", touch.n,
                touch.text);
  return OK;
}
