/*
 * Assembly in three passes without triplets: elements round the nodes, the
 * lower node graph, the values. Cost and memory are linear in the elements.
 */
#include "base/memory.h"
#include "base/timer.h"
#include "fem/element.h"
#include "fem/stiffness.h"

#include <string.h>

status node_elements(const mesh *m, size_t **start, int **elem) {
  status st = OK;
  const size_t per = (size_t)m->dim + 1, n = per * (size_t)m->n_elem;
  size_t *s = NULL;
  int *e = NULL;
  NEW(s, m->n_node + 2);
  NEW(e, n);
  for (size_t k = 0; k < n; ++k) ++s[m->elem[k] + 2];
  for (int i = 0; i < m->n_node; ++i) s[i + 2] += s[i + 1];
  for (size_t k = 0; k < n; ++k) e[s[m->elem[k] + 1]++] = (int)(k / per);
done:
  if (st != OK) {
    memory_free(s);
    memory_free(e);
    s = NULL;
    e = NULL;
  }
  *start = s;
  *elem = e;
  return st;
}

/* Columns of the lower node graph, grown as they are found. */
static status node_graph(const mesh *m, stiffness *k) {
  status st = OK;
  const int per = m->dim + 1;
  size_t *from = NULL, n = 0, room = (size_t)m->n_node * (m->dim == 2 ? 5 : 9);
  int *elem = NULL, *seen = NULL;
  TRY(node_elements(m, &from, &elem));
  NEW(seen, m->n_node);
  NEW(k->start, m->n_node + 1);
  NEW(k->row, room);
  for (int j = 0; j < m->n_node; ++j) {
    const size_t most = (from[j + 1] - from[j]) * (size_t)m->dim + 1;
    if (n + most > room) {
      int *grown =
          memory_resize(k->row, n, room + room / 2 + most, sizeof *grown);
      if (grown == NULL) FAIL(ERR_MEMORY, "memory exhausted: node graph");
      k->row = grown;
      room += room / 2 + most;
    }
    k->row[n++] = j;
    for (size_t q = from[j]; q < from[j + 1]; ++q)
      for (int a = 0; a < per; ++a) {
        const int i = m->elem[(size_t)per * (size_t)elem[q] + (size_t)a];
        if (i <= j || seen[i] == j + 1) continue;
        seen[i] = j + 1;
        k->row[n++] = i;
      }
    k->start[j + 1] = n;
  }
done:
  memory_free(from);
  memory_free(elem);
  memory_free(seen);
  return st;
}

static status check_element(const domain *d, int e) {
  status st = OK;
  const mesh *m = d->mesh;
  const int per = m->dim + 1;
  if (d->kin[d->section_id[e]] == AXISYMMETRIC)
    for (int a = 0; a < per; ++a)
      if (m->x[2 * m->elem[per * e + a]] < 0)
        FAIL(ERR_MESH, "element %zu: node %zu has a negative radius",
             m->elem_no[e], m->node_no[m->elem[per * e + a]]);
  if (!(element_weight(d, e) > 0))
    FAIL(ERR_MESH, "element %zu: weight %g is not positive", m->elem_no[e],
         element_weight(d, e));
done:
  return st;
}

static void add_block(stiffness *k, int i, int j, const double *b) {
  const int dim = k->dim, nb = dim * dim;
  const int low = i < j ? i : j, high = i < j ? j : i;
  size_t p = k->start[low];
  while (k->row[p] != high) ++p;
  double *to = k->block + (size_t)nb * p;
  if (i >= j)
    for (int c = 0; c < nb; ++c) to[c] += b[c];
  else
    for (int c = 0; c < dim; ++c)
      for (int r = 0; r < dim; ++r) to[dim * r + c] += b[dim * c + r];
}

static status add_elements(const domain *d, stiffness *k) {
  status st = OK;
  const int dim = k->dim, nb = dim * dim;
  double blocks[10 * 9];
  NEW(k->block, (size_t)nb * k->start[k->n_node]);
  for (int e = 0; e < d->mesh->n_elem; ++e) {
    const int *v = d->mesh->elem + (size_t)(dim + 1) * (size_t)e;
    TRY(check_element(d, e));
    element_stiffness(d, e, blocks);
    const double *b = blocks;
    for (int a = 0; a <= dim; ++a)
      for (int c = 0; c <= a; ++c, b += nb) add_block(k, v[a], v[c], b);
  }
done:
  return st;
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
    memcpy(b, t, (size_t)(dim * dim) * sizeof *b);
  }
  if (Ti != NULL) {
    for (int c = 0; c < dim; ++c)
      for (int r = 0; r < dim; ++r) {
        t[dim * c + r] = 0;
        for (int q = 0; q < dim; ++q)
          t[dim * c + r] += Ti[dim * r + q] * b[dim * c + q];
      }
    memcpy(b, t, (size_t)(dim * dim) * sizeof *b);
  }
}

/* Which components are unknown; contact nodes from the surface. */
static status mark_unknowns(const domain *d, stiffness *k) {
  status st = OK;
  const int dim = k->dim, all = (1 << dim) - 1;
  const contact_surface *s = d->surface;
  NEW(k->free, k->n_node);
  NEW(k->contact, k->n_node);
  for (int i = 0; i < k->n_node; ++i) {
    k->contact[i] = -1;
    k->free[i] = (unsigned char)all;
    for (int c = 0; c < dim; ++c)
      if (d->fixed[(size_t)dim * (size_t)i + (size_t)c])
        k->free[i] &= (unsigned char)~(1 << c);
  }
  for (int q = 0; s != NULL && q < s->n; ++q) {
    const int i = s->node_id[q];
    k->contact[i] = q;
    k->free[i] = (unsigned char)all;
    for (int c = 0; c < dim; ++c)
      if (s->held[dim * q + c]) k->free[i] &= (unsigned char)~(1 << c);
  }
done:
  return st;
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
                 k->block + (size_t)nb * p);
    }
}

/* Does the block couple an unknown with a prescribed component? */
static int couples(const stiffness *k, int i, int j) {
  const int all = (1 << k->dim) - 1;
  return (k->free[i] != all || k->free[j] != all) &&
         (k->free[i] != 0 || k->free[j] != 0);
}

static status list_coupling(stiffness *k) {
  status st = OK;
  size_t n = 0;
  for (int j = 0; j < k->n_node; ++j)
    for (size_t p = k->start[j]; p < k->start[j + 1]; ++p)
      n += (size_t)couples(k, k->row[p], j);
  NEW(k->coupling, n);
  NEW(k->coupling_column, n);
  for (int j = 0; j < k->n_node; ++j)
    for (size_t p = k->start[j]; p < k->start[j + 1]; ++p)
      if (couples(k, k->row[p], j)) {
        k->coupling[k->n_coupling] = p;
        k->coupling_column[k->n_coupling++] = j;
      }
done:
  return st;
}

status stiffness_assemble(const domain *d, stiffness **out) {
  status st = OK;
  stiffness *k = NULL;
  timer_enter(STAGE_ASSEMBLY);
  NEW(k, 1);
  k->dim = d->mesh->dim;
  k->n_node = d->mesh->n_node;
  TRY(node_graph(d->mesh, k));
  TRY(add_elements(d, k));
  TRY(mark_unknowns(d, k));
  turn_blocks(d, k);
  TRY(list_coupling(k));
done:
  timer_leave(STAGE_ASSEMBLY);
  if (st != OK) {
    stiffness_free(k);
    k = NULL;
  }
  *out = k;
  return st;
}

void stiffness_free(stiffness *k) {
  if (k == NULL) return;
  memory_free(k->start);
  memory_free(k->row);
  memory_free(k->block);
  memory_free(k->free);
  memory_free(k->contact);
  memory_free(k->coupling);
  memory_free(k->coupling_column);
  memory_free(k);
}

long stiffness_unknowns(const stiffness *k) {
  long n = 0;
  for (int i = 0; i < k->n_node; ++i)
    for (int c = 0; c < k->dim; ++c) n += k->free[i] >> c & 1;
  return n;
}
