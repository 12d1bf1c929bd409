#include "fem/stiffness.h"

#include "base/base.h"

/* What a node that moves with others has: its row of links, its frame. */
typedef struct source {
  const node_links *links; /* NULL: none */
  int row;
  const double *frame, *basis; /* NULL: unit matrices */
  const double *share;         /* [dim] of contact_surface; NULL: 1 */
} source;

typedef struct builder {
  coupling *c;
  source *of; /* [n_node] */
  int *place; /* [n_node] of a node in the row that is made, + 1 */
  size_t n_part, capacity;
} builder;

static int has_masters(const source *s) {
  return s->links != NULL &&
         s->links->start[s->row + 1] > s->links->start[s->row];
}

/* The sources of all nodes; how many have masters. */
static int find_sources(const domain *d, source *of) {
  const contact_surface *s = d->surface;
  const int nb = d->mesh->dim * d->mesh->dim;
  int n = 0;
  for (int q = 0; s != NULL && s->master != NULL && q < s->n; ++q) {
    source *x = &of[s->node_id[q]];
    *x = (source){s->master, q, s->frame + nb * q, s->basis + nb * q,
                  s->share == NULL ? NULL : s->share + s->dim * q};
    n += has_masters(x);
  }
  for (int q = 0; d->ties != NULL && q < d->ties->n; ++q) {
    source *x = &of[d->ties->node_id[q]];
    *x = (source){&d->ties->to, q, NULL, NULL, NULL};
    n += has_masters(x);
  }
  return n;
}

/* C of the master at place e of the links. */
static void find_block(const source *s, int dim, size_t e, double *C) {
  CLEAR(C, 9);
  for (int c = 0; c < dim; ++c) {
    double part = s->links->part[dim * e + c];
    if (s->frame == NULL) {
      C[c * (dim + 1)] = part;
      continue;
    }
    if (s->share != NULL) part /= s->share[c];
    for (int j = 0; j < dim; ++j)
      for (int i = 0; i < dim; ++i)
        C[dim * j + i] += s->basis[dim * c + i] * part * s->frame[dim * c + j];
  }
}

/* The block of a node in the last row: one that is there, or a new one. */
static status part_of(builder *b, size_t first, int node, coupled_part **out) {
  coupling *c = b->c;
  const size_t at = b->place[node];
  if (at > first) {
    *out = &c->part[at - 1];
    return OK;
  }
  if (b->n_part == b->capacity) {
    const size_t more = b->capacity / 2 + 64;
    coupled_part *grown =
        memory_resize(c->part, b->capacity, b->capacity + more, sizeof *grown);
    if (grown == NULL) RAISE(ERR_MEMORY, "memory exhausted: coupled nodes");
    c->part = grown;
    b->capacity += more;
  }
  *out = &c->part[b->n_part++];
  memset(*out, 0, sizeof **out);
  (*out)->node = node;
  b->place[node] = (int)b->n_part;
  return OK;
}

/* to += A B, or A where B is NULL. */
static void add_product(int dim, const double *A, const double *B, double *to) {
  for (int j = 0; j < dim; ++j)
    for (int i = 0; i < dim; ++i) {
      double sum = B == NULL ? A[dim * j + i] : 0;
      for (int k = 0; B != NULL && k < dim; ++k)
        sum += A[dim * k + i] * B[dim * j + k];
      to[dim * j + i] += sum;
    }
}

/* The row of a node, all of whose masters have theirs. */
static status add_row(builder *b, int node) {
  coupling *c = b->c;
  const source *s = &b->of[node];
  const size_t first = b->n_part;
  for (size_t e = s->links->start[s->row]; e < s->links->start[s->row + 1];
       ++e) {
    const int master = s->links->master[e], row = c->of[master];
    double C[9];
    coupled_part *p;
    find_block(s, c->dim, e, C);
    PASS(part_of(b, first, master, &p));
    add_product(c->dim, C, NULL, p->block);
    for (size_t t = row < 0 ? 0 : c->start[row];
         row >= 0 && t < c->start[row + 1]; ++t) {
      PASS(part_of(b, first, c->part[t].node, &p));
      add_product(c->dim, C, c->part[t].block, p->block);
    }
  }
  c->node[c->n] = node;
  c->of[node] = c->n++;
  c->start[c->n] = b->n_part;
  return OK;
}

/* 1: no master of the node waits for its own row. */
static int is_ready(const builder *b, int node) {
  const source *s = &b->of[node];
  for (size_t e = s->links->start[s->row]; e < s->links->start[s->row + 1]; ++e)
    if (has_masters(&b->of[s->links->master[e]]) &&
        b->c->of[s->links->master[e]] < 0)
      return 0;
  return 1;
}

/* Rows of the nodes that are ready, until all are made; n of them. */
static status add_rows(const domain *d, builder *b, int n) {
  while (b->c->n < n) {
    const int before = b->c->n;
    int left = -1;
    for (int i = 0; i < b->c->n_node; ++i) {
      if (!has_masters(&b->of[i]) || b->c->of[i] >= 0) continue;
      if (is_ready(b, i))
        PASS(add_row(b, i));
      else
        left = i;
    }
    if (b->c->n == before)
      RAISE(ERR_MESH,
            "node %zu moves with the master surface of its pair or tie, which "
            "moves with the node: choose the other side with SLAVE=",
            d->mesh->node_no[left]);
  }
  return OK;
}

status coupling_new(const domain *d, coupling **out) {
  const int n_node = d->mesh->n_node;
  OWNED source *of = NULL;
  OWNED int *at = NULL;
  *out = NULL;
  if ((d->surface == NULL || d->surface->master == NULL) && d->ties == NULL)
    return OK;
  PASS_NEW_ALL(OF(of, n_node), OF(at, n_node), OF(*out, 1));
  coupling *c = *out;
  OWNS(c);
  const int n = find_sources(d, of);
  PASS_NEW_ALL(OF(c->of, n_node), OF(c->node, n), OF(c->start, n + 1));
  c->dim = d->mesh->dim;
  c->n_node = n_node;
  for (int i = 0; i < n_node; ++i) c->of[i] = -1;
  return add_rows(d, &(builder){.c = c, .of = of, .place = at}, n);
}

/* A row is taken before what it gets of later ones, which have it in theirs. */
void coupling_load(const coupling *c, double *F) {
  const size_t dim = c->dim;
  for (int q = 0; q < c->n; ++q) {
    const double *own = F + dim * c->node[q];
    for (size_t t = c->start[q]; t < c->start[q + 1]; ++t) {
      double *to = F + dim * c->part[t].node;
      for (size_t j = 0; j < dim; ++j)
        for (size_t i = 0; i < dim; ++i)
          to[j] += c->part[t].block[dim * j + i] * own[i];
    }
  }
}

/* From the last row on: those it needs are still v. */
void coupling_move(const coupling *c, double *v) {
  const size_t dim = c->dim;
  for (int q = c->n - 1; q >= 0; --q) {
    double *to = v + dim * c->node[q];
    for (size_t t = c->start[q]; t < c->start[q + 1]; ++t) {
      const double *from = v + dim * c->part[t].node;
      for (size_t j = 0; j < dim; ++j)
        for (size_t i = 0; i < dim; ++i)
          to[i] += c->part[t].block[dim * j + i] * from[j];
    }
  }
}
