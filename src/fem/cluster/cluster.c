/*
 * Clusters are grown in three passes over each section: the stars of inner
 * nodes no two of which are neighbours; the remaining elements join, across a
 * face, the smallest neighbouring cluster; parts without inner nodes start with
 * stars of nodes on their boundary, or with an element.
 */
#include "fem/cluster/cluster.h"

#include "base/base.h"

/* The current section. */
typedef struct growth {
  const mesh *m;
  const int *section_id;
  int section, n;         /* n: clusters so far, of all sections */
  size_t *start;          /* [n_node+1] elements round the nodes */
  int *elem;              /* [start[n_node]] */
  int *of, *size;         /* [n_elem] cluster; elements of a cluster */
  unsigned char *outside; /* [n_node] 1: on the boundary of the section */
  unsigned char *taken;   /* [n_node] 1: root, or neighbour of one */
} growth;

static const int *corners(const growth *g, int e) {
  return g->m->elem + (size_t)(g->m->dim + 1) * e;
}

static int has_node(const growth *g, int e, int node) {
  const int *v = corners(g, e);
  for (int a = 0; a <= g->m->dim; ++a)
    if (v[a] == node) return 1;
  return 0;
}

/* The element of the section behind the face opposite to corner a, or -1. */
static int behind(const growth *g, int e, int a) {
  const int *v = corners(g, e), dim = g->m->dim, from = v[a == 0];
  for (size_t q = g->start[from]; q < g->start[from + 1]; ++q) {
    const int other = g->elem[q];
    int common = 0;
    if (other == e || g->section_id[other] != g->section) continue;
    for (int b = 0; b <= dim; ++b) common += b != a && has_node(g, other, v[b]);
    if (common == dim) return other;
  }
  return -1;
}

static void put(growth *g, int e, int cluster) {
  g->of[e] = cluster;
  ++g->size[cluster];
}

/* The free elements of the star of a node become a cluster. */
static void take_star(growth *g, int node) {
  int found = 0;
  for (size_t q = g->start[node]; q < g->start[node + 1]; ++q) {
    const int e = g->elem[q];
    if (g->section_id[e] != g->section || g->of[e] >= 0) continue;
    put(g, e, g->n);
    found = 1;
    for (int a = 0; a <= g->m->dim; ++a) g->taken[corners(g, e)[a]] = 1;
  }
  g->n += found;
}

static void take_stars(growth *g, int outside) {
  for (int i = 0; i < g->m->n_node; ++i)
    if (!g->taken[i] && g->outside[i] == outside) take_star(g, i);
}

/* The smallest cluster across a face, or -1. */
static int smallest_neighbour(const growth *g, int e) {
  int best = -1;
  for (int a = 0; a <= g->m->dim; ++a) {
    const int other = behind(g, e, a), c = other < 0 ? -1 : g->of[other];
    if (c >= 0 && (best < 0 || g->size[c] < g->size[best])) best = c;
  }
  return best;
}

/* Free elements join, ring by ring; the number of those that stay free. */
static int join_rest(growth *g) {
  int joined, rest;
  do {
    joined = rest = 0;
    for (int e = 0; e < g->m->n_elem; ++e) {
      if (g->section_id[e] != g->section || g->of[e] >= 0) continue;
      const int c = smallest_neighbour(g, e);
      if (c >= 0) put(g, e, c);
      joined += c >= 0;
      rest += c < 0;
    }
  } while (joined > 0 && rest > 0);
  return rest;
}

static void start_with_element(growth *g) {
  for (int e = 0; e < g->m->n_elem; ++e)
    if (g->section_id[e] == g->section && g->of[e] < 0) {
      put(g, e, g->n++);
      return;
    }
}

static void grow_section(growth *g, int section) {
  g->section = section;
  memset(g->outside, 0, g->m->n_node);
  memset(g->taken, 0, g->m->n_node);
  for (int e = 0; e < g->m->n_elem; ++e) {
    if (g->section_id[e] != g->section) continue;
    for (int a = 0; a <= g->m->dim; ++a)
      for (int b = 0; b <= g->m->dim && behind(g, e, a) < 0; ++b)
        if (b != a) g->outside[corners(g, e)[b]] = 1;
  }
  take_stars(g, 0);
  if (join_rest(g) == 0) return;
  take_stars(g, 1);
  while (join_rest(g) > 0) start_with_element(g);
}

/* ---- the finished set ---------------------------------------------------- */

static status list_nodes(const mesh *m, cluster_set *c) {
  const int per = m->dim + 1;
  int n = 0;
  OWNED_NEW(int, seen, m->n_node);
  PASS_NEW_ALL(OF(c->first, c->n + 1), OF(c->node, per * c->start[c->n]));
  for (int k = 0; k < c->n; ++k) {
    for (int q = c->start[k]; q < c->start[k + 1]; ++q)
      for (int a = 0; a < per; ++a) {
        const int i = m->elem[(size_t)per * c->elem[q] + a];
        if (seen[i] == k + 1) continue;
        seen[i] = k + 1;
        c->node[n++] = i;
      }
    c->first[k + 1] = n;
  }
  return OK;
}

/* Volume of an element but for a factor common to its section. */
static double volume(const cluster_input *in, int e) {
  const int *v = in->mesh->elem + (size_t)(in->mesh->dim + 1) * e;
  const double *x = in->mesh->x;
  double size = mesh_elem_measure(in->mesh, e);
  if (in->axisymmetric) size *= x[2 * v[0]] + x[2 * v[1]] + x[2 * v[2]];
  return size;
}

static status weigh(const cluster_input *in, cluster_set *c) {
  PASS_NEW_ALL(OF(c->share, c->n), OF(c->weight, in->mesh->n_elem));
  for (int f = CLUSTER_STRAIN; f <= CLUSTER_STRESS; ++f)
    PASS_NEW(c->mean[f], c->n);
  for (int k = 0; k < c->n; ++k) {
    double sum = 0;
    for (int q = c->start[k]; q < c->start[k + 1]; ++q)
      sum += c->weight[c->elem[q]] = volume(in, c->elem[q]);
    for (int q = c->start[k]; q < c->start[k + 1]; ++q)
      c->weight[c->elem[q]] /= sum;
    c->share[k] = in->share[in->section_id[c->elem[c->start[k]]]];
  }
  return OK;
}

static status grow(const cluster_input *in, cluster_set *c) {
  const mesh *m = in->mesh;
  PASS_NEW(c->of, m->n_elem);
  OWNED_NEW(growth, g, 1);
  OWNS(g);
  *g = (growth){.m = m, .section_id = in->section_id, .of = c->of};
  PASS(mesh_node_elements(m, &g->start, &g->elem));
  PASS_NEW_ALL(OF(g->size, m->n_elem), OF(g->outside, m->n_node),
               OF(g->taken, m->n_node));
  for (int e = 0; e < m->n_elem; ++e) g->of[e] = -1;
  for (int i = 0; i < in->n_section; ++i)
    if (in->share[i] > 0) grow_section(g, i);
  c->n = g->n;
  return OK;
}

status cluster_new(const cluster_input *in, cluster_set **out) {
  int wanted = 0;
  *out = NULL;
  for (int i = 0; i < in->n_section; ++i) wanted |= in->share[i] > 0;
  if (!wanted) return OK;
  MAKES(cluster_set, c, out);
  PASS(grow(in, c));
  PASS_NEW_ALL(OF(c->start, c->n + 2), OF(c->elem, in->mesh->n_elem));
  for (int e = 0; e < in->mesh->n_elem; ++e)
    if (c->of[e] >= 0) ++c->start[c->of[e] + 2];
  for (int k = 0; k < c->n; ++k) c->start[k + 2] += c->start[k + 1];
  for (int e = 0; e < in->mesh->n_elem; ++e)
    if (c->of[e] >= 0) c->elem[c->start[c->of[e] + 1]++] = e;
  PASS(list_nodes(in->mesh, c));
  return weigh(in, c);
}

double cluster_share(int ns, const double *E, int flows) {
  static const double kept = 14.0 / 3; /* bulk over shear modulus, nu = 0.4 */
  double bulk = 0, shear = E[(ns + 1) * 3];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) bulk += E[ns * j + i] / 9;
  for (int i = 4; i < ns; ++i) shear = fmin(shear, E[(ns + 1) * i]);
  if (flows) return 1;
  return fmax(0, 1 - sqrt(kept * shear / bulk));
}

void cluster_begin(cluster_set *c, cluster_field f) {
  if (c != NULL) CLEAR(c->mean[f], c->n);
}

void cluster_add(cluster_set *c, cluster_field f, int elem_id,
                 const double *t) {
  if (c == NULL || c->of[elem_id] < 0) return;
  c->mean[f][c->of[elem_id]] += c->weight[elem_id] * (t[0] + t[1] + t[2]);
}

void cluster_smooth(const cluster_set *c, cluster_field f, int elem_id,
                    double *t) {
  if (c == NULL || c->of[elem_id] < 0) return;
  const int k = c->of[elem_id];
  const double add = c->share[k] / 3 * (c->mean[f][k] - (t[0] + t[1] + t[2]));
  for (int i = 0; i < 3; ++i) t[i] += add;
}
