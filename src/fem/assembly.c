/*
 * Assembly in three passes without triplets: elements round the nodes, the
 * lower node graph, the values. Cost and memory are linear in the elements.
 */
#include "base/base.h"
#include "fem/element.h"
#include "fem/stiffness.h"

/* The lower node graph, grown column by column. */
typedef struct node_graph {
  stiffness *k; /* gets start and row */
  size_t n, capacity;
  int *seen; /* [n_node] last column that has the node, + 1 */
} node_graph;

/* Nodes of a list that come after j into column j. */
static status add_rows(node_graph *g, int j, int n_more, const int *node) {
  const size_t most = n_more;
  if (g->n + most > g->capacity) {
    const size_t more = g->capacity / 2 + most;
    int *grown =
        memory_resize(g->k->row, g->n, g->capacity + more, sizeof *grown);
    if (grown == NULL) RAISE(ERR_MEMORY, "memory exhausted: node graph");
    g->k->row = grown;
    g->capacity += more;
  }
  for (int a = 0; a < n_more; ++a) {
    if (node[a] < j || g->seen[node[a]] == j + 1) continue;
    g->seen[node[a]] = j + 1;
    g->k->row[g->n++] = node[a];
  }
  return OK;
}

/* The same with the nodes that those move with. */
static status add_moved_rows(node_graph *g, int j, int n, const int *node) {
  const coupling *c = g->k->moved;
  PASS(add_rows(g, j, n, node));
  for (int a = 0; c != NULL && a < n; ++a) {
    const int row = c->of[node[a]];
    for (size_t t = row < 0 ? 0 : c->start[row];
         row >= 0 && t < c->start[row + 1]; ++t)
      PASS(add_rows(g, j, 1, &c->part[t].node));
  }
  return OK;
}

/* Nodes of an element, or of the cluster it belongs to, couple. */
static status add_element_rows(node_graph *g, const domain *d, int j, int e) {
  const int per = d->mesh->dim + 1;
  const cluster_set *c = d->cluster;
  if (c == NULL || c->of[e] < 0)
    return add_moved_rows(g, j, per, d->mesh->elem + (size_t)per * e);
  const int q = c->of[e];
  return add_moved_rows(g, j, c->first[q + 1] - c->first[q],
                        c->node + c->first[q]);
}

/* The rows whose nodes move with node j: nodes[start[j] .. start[j+1]). */
static status find_followers(const coupling *c, size_t **start, int **node) {
  size_t *s = NULL;
  int *list = NULL;
  PASS_NEW(s, c->n_node + 2);
  *start = s;
  PASS_NEW(list, c->start[c->n]);
  *node = list;
  for (size_t t = 0; t < c->start[c->n]; ++t) ++s[c->part[t].node + 2];
  for (int i = 0; i < c->n_node; ++i) s[i + 2] += s[i + 1];
  for (int q = 0; q < c->n; ++q)
    for (size_t t = c->start[q]; t < c->start[q + 1]; ++t)
      list[s[c->part[t].node + 1]++] = c->node[q];
  return OK;
}

static status find_graph(const domain *d, stiffness *k) {
  const mesh *m = d->mesh;
  node_graph g = {.k = k,
                  .capacity = (size_t)m->n_node * (m->dim == 2 ? 5 : 9)};
  OWNED size_t *from = NULL, *first = NULL;
  OWNED int *elem = NULL, *follower = NULL, *seen = NULL;
  PASS(mesh_node_elements(m, &from, &elem));
  if (k->moved != NULL) PASS(find_followers(k->moved, &first, &follower));
  PASS_NEW_ALL(OF(seen, m->n_node), OF(k->start, m->n_node + 1),
               OF(k->row, g.capacity));
  g.seen = seen;
  for (int j = 0; j < m->n_node; ++j) {
    PASS(add_rows(&g, j, 1, &j)); /* the diagonal first */
    for (size_t q = from[j]; q < from[j + 1]; ++q)
      PASS(add_element_rows(&g, d, j, elem[q]));
    for (size_t t = first == NULL ? 0 : first[j];
         first != NULL && t < first[j + 1]; ++t)
      for (size_t q = from[follower[t]]; q < from[follower[t] + 1]; ++q)
        PASS(add_element_rows(&g, d, j, elem[q]));
    k->start[j + 1] = g.n;
  }
  return OK;
}

static status check_element(const domain *d, int e) {
  const mesh *m = d->mesh;
  const int per = m->dim + 1;
  if (d->kin[d->section_id[e]] == AXISYMMETRIC)
    for (int a = 0; a < per; ++a)
      if (m->x[2 * m->elem[per * e + a]] < 0)
        RAISE(ERR_MESH, "element %zu: node %zu has a negative radius",
              m->elem_no[e], m->node_no[m->elem[per * e + a]]);
  if (!(element_weight(d, e) > 0))
    RAISE(ERR_MESH, "element %zu: weight %g is not positive", m->elem_no[e],
          element_weight(d, e));
  return OK;
}

static void add_block(stiffness *k, int i, int j, const double *b) {
  const int dim = k->dim, nb = dim * dim;
  const int low = i < j ? i : j, high = i < j ? j : i;
  size_t p = k->start[low];
  while (k->row[p] != high) ++p;
  double *to = k->block + nb * p;
  if (i >= j)
    for (int c = 0; c < nb; ++c) to[c] += b[c];
  else
    for (int c = 0; c < dim; ++c)
      for (int r = 0; r < dim; ++r) to[dim * r + c] += b[dim * c + r];
}

/* t = X' b Y; NULL: unit matrix. */
static void turn_both(int dim, const double *X, const double *Y,
                      const double *b, double *t) {
  double half[9];
  for (int s = 0; s < dim; ++s)
    for (int r = 0; r < dim; ++r) {
      half[dim * s + r] = Y == NULL ? b[dim * s + r] : 0;
      for (int q = 0; Y != NULL && q < dim; ++q)
        half[dim * s + r] += b[dim * q + r] * Y[dim * s + q];
    }
  for (int s = 0; s < dim; ++s)
    for (int r = 0; r < dim; ++r) {
      t[dim * s + r] = X == NULL ? half[dim * s + r] : 0;
      for (int q = 0; X != NULL && q < dim; ++q)
        t[dim * s + r] += X[dim * r + q] * half[dim * s + q];
    }
}

/* A node (p = 0) and those it moves with. */
static int part_of(const coupling *c, int node, size_t p, const double **X) {
  if (p == 0) {
    *X = NULL;
    return node;
  }
  const coupled_part *x = &c->part[c->start[c->of[node]] + p - 1];
  *X = x->block;
  return x->node;
}

static size_t parts_of(const coupling *c, int node) {
  const int row = c->of[node];
  return row < 0 ? 1 : 1 + c->start[row + 1] - c->start[row];
}

/* T'b T of the block of nodes i and j, the lower triangle. */
static void add_moved(stiffness *k, int i, int j, const double *b) {
  const coupling *c = k->moved;
  const int dim = k->dim;
  const size_t n_i = parts_of(c, i), n_j = parts_of(c, j);
  for (size_t p = 0; p < n_i; ++p)
    for (size_t q = 0; q < (i == j ? p + 1 : n_j); ++q) {
      const double *X, *Y;
      double t[9], across[9];
      const int to_i = part_of(c, i, p, &X), to_j = part_of(c, j, q, &Y);
      turn_both(dim, X, Y, b, t);
      add_block(k, to_i, to_j, t);
      if (to_i != to_j || i == j) continue;
      for (int s = 0; s < dim; ++s)
        for (int r = 0; r < dim; ++r) across[dim * s + r] = t[dim * r + s];
      add_block(k, to_i, to_j, across);
    }
}

/* The block of two nodes as the unknowns have it. */
static void put_block(stiffness *k, int i, int j, const double *b) {
  const coupling *c = k->moved;
  if (c == NULL || (c->of[i] < 0 && c->of[j] < 0))
    add_block(k, i, j, b);
  else
    add_moved(k, i, j, b);
}

static status add_elements(const domain *d, stiffness *k) {
  const int dim = k->dim, nb = dim * dim;
  double blocks[10 * 9];
  PASS_NEW(k->block, nb * k->start[k->n_node]);
  for (int e = 0; e < d->mesh->n_elem; ++e) {
    const int *v = d->mesh->elem + (size_t)(dim + 1) * e;
    PASS(check_element(d, e));
    element_stiffness(d, e, blocks);
    const double *b = blocks;
    for (int a = 0; a <= dim; ++a)
      for (int c = 0; c <= a; ++c, b += nb) put_block(k, v[a], v[c], b);
  }
  return OK;
}

/* Rows over the nodes of a cluster: t = <tr B>, r = sum w m'E R B. */
typedef struct cluster_rows {
  int *place;    /* [n_node] of a node in the rows */
  double *t, *r; /* [dim * most nodes] 1/m; N/m */
  double bulk;   /* sum w m'E m, N m */
} cluster_rows;

/* Add one element; its volume is w, its part of the cluster "part". */
static void add_to_rows(const domain *d, int e, cluster_rows *x) {
  const int dim = d->mesh->dim, ns = d->ns;
  const int *v = d->mesh->elem + (size_t)(dim + 1) * e;
  double E[36], m_E[6], B[72], bulk;
  const double w = element_strain(d, e, B), part = d->cluster->weight[e];
  element_rest(d, e, E, m_E, &bulk);
  x->bulk += w * bulk;
  for (int k = 0; k < dim * (dim + 1); ++k) {
    const double *b = B + ns * k;
    const int at = dim * x->place[v[k / dim]] + k % dim;
    x->t[at] += part * (b[0] + b[1] + b[2]);
    for (int i = 0; i < ns; ++i) x->r[at] += w * m_E[i] * b[i];
  }
}

/* K += share/3 (r t' + t r') + (share/3)^2 bulk t t'. */
static void add_cluster(const domain *d, int q, cluster_rows *x, stiffness *k) {
  const cluster_set *c = d->cluster;
  const int dim = k->dim, *node = c->node + c->first[q];
  const int n = c->first[q + 1] - c->first[q];
  const double part = c->share[q] / 3;
  CLEAR(x->t, dim * n);
  CLEAR(x->r, dim * n);
  x->bulk = 0;
  for (int a = 0; a < n; ++a) x->place[node[a]] = a;
  for (int p = c->start[q]; p < c->start[q + 1]; ++p)
    add_to_rows(d, c->elem[p], x);
  for (int i = 0; i < dim * n; ++i)
    x->r[i] = part * (x->r[i] + 0.5 * part * x->bulk * x->t[i]);
  for (int a = 0; a < n; ++a)
    for (int b = 0; b <= a; ++b) {
      double block[9];
      for (int s = 0; s < dim; ++s)
        for (int r = 0; r < dim; ++r)
          block[dim * s + r] = x->r[dim * a + r] * x->t[dim * b + s] +
                               x->t[dim * a + r] * x->r[dim * b + s];
      put_block(k, node[a], node[b], block);
    }
}

static status add_clusters(const domain *d, stiffness *k) {
  const cluster_set *c = d->cluster;
  OWNED int *at = NULL;
  OWNED double *t = NULL, *r = NULL;
  int most = 0;
  for (int q = 0; c != NULL && q < c->n; ++q)
    if (c->first[q + 1] - c->first[q] > most)
      most = c->first[q + 1] - c->first[q];
  if (most == 0) return OK;
  PASS_NEW_ALL(OF(at, k->n_node), OF(t, k->dim * most), OF(r, k->dim * most));
  cluster_rows x = {.place = at, .t = t, .r = r};
  for (int q = 0; q < c->n; ++q) add_cluster(d, q, &x, k);
  return OK;
}

/* b <- Ti' b Tj with the bases of the contact nodes (NULL: unit matrix). */
static void turn_block(int dim, const double *Ti, const double *Tj, double *b) {
  double t[9];
  if (Tj != NULL) {
    for (int c = 0; c < dim; ++c)
      for (int r = 0; r < dim; ++r) {
        t[dim * c + r] = 0;
        for (int q = 0; q < dim; ++q)
          t[dim * c + r] += b[dim * q + r] * Tj[dim * c + q];
      }
    COPY(b, t, dim * dim);
  }
  if (Ti != NULL) {
    for (int c = 0; c < dim; ++c)
      for (int r = 0; r < dim; ++r) {
        t[dim * c + r] = 0;
        for (int q = 0; q < dim; ++q)
          t[dim * c + r] += Ti[dim * r + q] * b[dim * c + q];
      }
    COPY(b, t, dim * dim);
  }
}

int contact_row(const stiffness *k, int i, int c) {
  return k->first_row[i] >= 0 && c < k->rows ? k->first_row[i] + c : -1;
}

/* The rows of the condensed matrix. */
static status number_rows(const domain *d, stiffness *k) {
  const contact_surface *s = d->surface;
  PASS_NEW(k->first_row, k->n_node);
  for (int i = 0; i < k->n_node; ++i) k->first_row[i] = -1;
  const int n = s == NULL ? 0 : d->in != NULL ? d->n_in : s->n;
  for (int q = 0; q < n; ++q)
    k->first_row[s->node_id[d->in != NULL ? d->in[q] : q]] = k->rows * q;
  k->n_row = k->rows * n;
  return OK;
}

/* Which components are unknown; contact nodes from the surface. */
static status mark_unknowns(const domain *d, stiffness *k) {
  const int dim = k->dim, all = (1 << dim) - 1;
  const contact_surface *s = d->surface;
  PASS_NEW_ALL(OF(k->free, k->n_node), OF(k->contact, k->n_node));
  for (int i = 0; i < k->n_node; ++i) {
    k->contact[i] = -1;
    k->free[i] = (unsigned char)all;
    for (int c = 0; c < dim; ++c)
      if (d->fixed[(size_t)dim * i + c]) k->free[i] &= (unsigned char)~(1 << c);
  }
  for (int q = 0; d->ties != NULL && q < d->ties->n; ++q)
    k->free[d->ties->node_id[q]] = 0;
  for (int q = 0; s != NULL && q < s->n; ++q) {
    const int i = s->node_id[q];
    k->contact[i] = q;
    k->free[i] = (unsigned char)all;
    for (int c = 0; c < dim; ++c)
      if (s->held[dim * q + c]) k->free[i] &= (unsigned char)~(1 << c);
  }
  return number_rows(d, k);
}

/* Contact nodes count in their frame. */
static void turn_blocks(const domain *d, stiffness *k) {
  const int nb = k->dim * k->dim;
  if (d->surface == NULL || d->surface->n == 0) return;
  for (int j = 0; j < k->n_node; ++j)
    for (size_t p = k->start[j]; p < k->start[j + 1]; ++p) {
      const int ci = k->contact[k->row[p]], cj = k->contact[j];
      if (ci < 0 && cj < 0) continue;
      turn_block(k->dim, ci >= 0 ? d->surface->basis + nb * ci : NULL,
                 cj >= 0 ? d->surface->basis + nb * cj : NULL,
                 k->block + nb * p);
    }
}

/* Does the block couple an unknown with a prescribed component? */
static int couples(const stiffness *k, int i, int j) {
  const int all = (1 << k->dim) - 1;
  return (k->free[i] != all || k->free[j] != all) &&
         (k->free[i] != 0 || k->free[j] != 0);
}

static status list_coupling(stiffness *k) {
  size_t n = 0;
  for (int j = 0; j < k->n_node; ++j)
    for (size_t p = k->start[j]; p < k->start[j + 1]; ++p)
      n += couples(k, k->row[p], j);
  PASS_NEW_ALL(OF(k->coupling, n), OF(k->coupling_column, n));
  for (int j = 0; j < k->n_node; ++j)
    for (size_t p = k->start[j]; p < k->start[j + 1]; ++p)
      if (couples(k, k->row[p], j)) {
        k->coupling[k->n_coupling] = p;
        k->coupling_column[k->n_coupling++] = j;
      }
  return OK;
}

status stiffness_assemble(const domain *d, stiffness **out) {
  *out = NULL;
  TIMED(STAGE_ASSEMBLY);
  OWNED_NEW(stiffness, k, 1);
  OWNS(k);
  k->dim = d->mesh->dim;
  k->rows = d->rows > 0 ? d->rows : k->dim;
  k->n_node = d->mesh->n_node;
  PASS(coupling_new(d, &k->moved));
  PASS(find_graph(d, k));
  PASS(add_elements(d, k));
  PASS(add_clusters(d, k));
  PASS(mark_unknowns(d, k));
  turn_blocks(d, k);
  PASS(list_coupling(k));
  *out = k;
  k = NULL;
  return OK;
}
