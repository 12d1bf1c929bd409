/*
 * Two partners of one component (joined through nodes) do not hide each other:
 * their projections have one sense. Where the partners are not joined, or cover
 * more than there is, each loses what nearer ones cover.
 */
#include "contact/mortar/partner.h"

#include "base/memory.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Faces that are seen at less than this sine, from their edge, - . */
static const double edge_on = 1e-6;

static const int *face_nodes(const mortar_input *in, int face) {
  return in->mesh->face + (size_t)in->mesh->dim * (size_t)face;
}

static const double *place_of(const mortar_input *in, int node) {
  return in->x + (size_t)in->mesh->dim * (size_t)node;
}

/* Diagonal of the box round n faces, m; largest |coordinate| so far. */
static double extent(const mortar_input *in, int n, const int *face,
                     double *largest) {
  const int dim = in->mesh->dim;
  double low[3] = {0}, high[3] = {0}, sum = 0.0;
  for (int i = 0; i < n * dim; ++i) {
    const double *x = place_of(in, face_nodes(in, face[i / dim])[i % dim]);
    for (int c = 0; c < dim; ++c) {
      low[c] = i == 0 ? x[c] : fmin(low[c], x[c]);
      high[c] = i == 0 ? x[c] : fmax(high[c], x[c]);
      *largest = fmax(*largest, fabs(x[c]));
    }
  }
  for (int c = 0; c < dim; ++c) sum += (high[c] - low[c]) * (high[c] - low[c]);
  return sqrt(sum);
}

static status plant(partner_search *s) {
  const mortar_input *in = s->in;
  const int dim = in->mesh->dim;
  OWNED double *corner = NULL;
  PASS_NEW(corner, (size_t)(dim * dim) * (size_t)in->n_master);
  for (int i = 0; i < in->n_master; ++i) {
    const int *node = face_nodes(in, in->master[i]);
    double *at = corner + (size_t)(dim * dim) * (size_t)i;
    for (int k = 0; k < dim; ++k)
      memcpy(at + dim * k, place_of(in, node[k]), (size_t)dim * sizeof *at);
    if (facet_set(dim, node, in->x, &s->master[i]) != 0)
      s->master[i].measure = 0;
  }
  return box_tree_new(dim, in->n_master, dim, corner, &s->tree);
}

status partner_search_new(const mortar_input *in, partner_search *s) {
  *s = (partner_search){.in = in};
  PASS_NEW(s->master, in->n_master);
  PASS_NEW(s->found, in->n_master);
  PASS_NEW(s->group, in->mesh->n_node);
  for (int i = 0; i < in->mesh->n_node; ++i) s->group[i] = -1;
  s->reach = fmax(extent(in, in->n_slave, in->slave, &s->largest),
                  extent(in, in->n_master, in->master, &s->largest));
  return plant(s);
}

void partner_search_release(partner_search *s) {
  box_tree_free(&s->tree);
  RELEASE(s->master, s->found, s->group, s->list, s->cells, s->rest);
  *s = (partner_search){0};
}

double partner_rounding(const partner_search *s, const facet *f) {
  const double size = f->dim == 2 ? f->measure : sqrt(f->measure);
  return 32 * DBL_EPSILON * (1 + s->largest / size);
}

/* The prism over f as far as partners are looked for. */
static box_beam beam_of(const partner_search *s, const facet *f) {
  const int dim = f->dim;
  box_beam b = {.n_slab = dim};
  for (int a = 0; a < dim; ++a) {
    const double *axis = a < dim - 1 ? f->axis[a] : f->normal;
    double base = 0.0;
    for (int c = 0; c < dim; ++c) {
      b.axis[a][c] = axis[c];
      base += axis[c] * f->origin[c];
    }
    b.low[a] = a < dim - 1 ? HUGE_VAL : base - s->reach;
    b.high[a] = a < dim - 1 ? -HUGE_VAL : base + s->reach;
    for (int k = 0; k < dim && a < dim - 1; ++k) {
      b.low[a] = fmin(b.low[a], base + f->in_plane.at[k][a]);
      b.high[a] = fmax(b.high[a], base + f->in_plane.at[k][a]);
    }
  }
  return b;
}

static int faces_oppose(const facet *f, const facet *m) {
  double product = 0.0;
  for (int c = 0; c < f->dim; ++c) product += f->normal[c] * m->normal[c];
  return product < -edge_on;
}

/* Height of the partner above the middle of the cells. */
static double middle_height(int dim, const partner *p, const cell *cells) {
  double sum = 0.0, total = 0.0;
  for (int i = p->first; i < p->first + p->n; ++i) {
    double phi[3], at[2] = {0, 0}, height = 0.0;
    const double measure = cell_measure(dim, &cells[i]);
    for (int k = 0; k < dim; ++k)
      for (int c = 0; c < dim - 1; ++c) at[c] += cells[i].at[k][c] / dim;
    cell_functions(dim, &p->s.in_plane, at, phi);
    for (int k = 0; k < dim; ++k) height += phi[k] * p->s.height[k];
    sum += measure * height;
    total += measure;
  }
  return sum / total;
}

static double cells_measure(int dim, int n, const cell *cells) {
  double sum = 0.0;
  for (int i = 0; i < n; ++i) sum += cell_measure(dim, &cells[i]);
  return sum;
}

/* Clip with one master; a partner if something is in common. */
static status try_master(partner_search *s, const facet *f, int of) {
  const int dim = f->dim;
  const facet *m = &s->master[of];
  partner p = {.face = s->in->master[of], .of = of, .size = m->measure};
  cell common[CLIP_CELLS];
  if (!(m->measure > 0) || !faces_oppose(f, m)) return OK;
  facet_project(f, face_nodes(s->in, p.face), s->in->x, &p.s);
  ++s->clips;
  p.n = cell_common(dim, &f->in_plane, &p.s.in_plane, common);
  const double negligible =
      partner_rounding(s, f) * fmin(f->measure, p.s.measure);
  if (!(cells_measure(dim, p.n, common) > negligible)) return OK;
  p.first = s->n_cell;
  for (int i = 0; i < p.n; ++i) {
    PASS_GROW(s->cells, s->n_cell, s->cell_capacity);
    s->cells[s->n_cell++] = common[i];
  }
  p.distance = fabs(middle_height(dim, &p, s->cells));
  if (p.distance > s->reach) return OK;
  PASS_GROW(s->list, s->n, s->capacity);
  s->list[s->n++] = p;
  return OK;
}

static int root(partner *list, int i) {
  while (list[i].of != i) i = list[i].of = list[list[i].of].of;
  return i;
}

/* 1: the partners are joined through nodes. Uses "of" of the partners. */
static int are_joined(partner_search *s, int dim) {
  int n_group = s->n;
  for (int i = 0; i < s->n; ++i) s->list[i].of = i;
  for (int i = 0; i < s->n * dim; ++i) {
    const int node = face_nodes(s->in, s->list[i / dim].face)[i % dim];
    const int a = root(s->list, i / dim);
    if (s->group[node] < 0) s->group[node] = a;
    const int b = root(s->list, s->group[node]);
    if (a == b) continue;
    s->list[a].of = b;
    --n_group;
  }
  for (int i = 0; i < s->n * dim; ++i)
    s->group[face_nodes(s->in, s->list[i / dim].face)[i % dim]] = -1;
  return n_group <= 1;
}

static int share_node(int dim, const int *a, const int *b) {
  for (int i = 0; i < dim * dim; ++i)
    if (a[i / dim] == b[i % dim]) return 1;
  return 0;
}

static int by_distance(const void *a, const void *b) {
  const partner *p = a, *q = b;
  if (p->distance != q->distance) return p->distance < q->distance ? -1 : 1;
  return (p->face > q->face) - (p->face < q->face);
}

/* Take the shadow of a nearer partner out of the cells from "first" on. */
static status take_out(partner_search *s, int dim, int first,
                       const partner *nearer, double negligible) {
  int n = 0;
  for (int i = first; i < s->n_cell; ++i) {
    cell left[CLIP_REST];
    const int n_left =
        cell_without(dim, &s->cells[i], &nearer->s.in_plane, left);
    for (int k = 0; k < n_left; ++k) {
      if (!(cell_measure(dim, &left[k]) > negligible)) continue;
      PASS_GROW(s->rest, n, s->rest_capacity);
      s->rest[n++] = left[k];
    }
  }
  s->n_cell = first;
  for (int i = 0; i < n; ++i) {
    PASS_GROW(s->cells, s->n_cell, s->cell_capacity);
    s->cells[s->n_cell++] = s->rest[i];
  }
  return OK;
}

/* The cells of partner i less what those before it in the list cover. */
static status uncover(partner_search *s, const facet *f, int i) {
  const int dim = f->dim;
  partner *p = &s->list[i];
  const int *node = face_nodes(s->in, p->face);
  const int first = s->n_cell;
  const double negligible =
      partner_rounding(s, f) * fmin(f->measure, p->s.measure);
  for (int k = p->first; k < p->first + p->n; ++k) {
    PASS_GROW(s->cells, s->n_cell, s->cell_capacity);
    s->cells[s->n_cell++] = s->cells[k];
  }
  for (int k = 0; k < i && s->n_cell > first; ++k) {
    cell common[CLIP_CELLS];
    const partner *q = &s->list[k];
    if (share_node(dim, node, face_nodes(s->in, q->face))) continue;
    const int n = cell_common(dim, &p->s.in_plane, &q->s.in_plane, common);
    if (cells_measure(dim, n, common) > negligible)
      PASS(take_out(s, dim, first, q, negligible));
  }
  p->first = first;
  p->n = s->n_cell - first;
  return OK;
}

/* Of partners one behind the other only the nearest is left. */
static status leave_nearest(partner_search *s, const facet *f) {
  double covered = 0.0;
  for (int i = 0; i < s->n; ++i)
    covered += cells_measure(f->dim, s->list[i].n, s->cells + s->list[i].first);
  const double most = f->measure * (1 + s->n * partner_rounding(s, f));
  if (are_joined(s, f->dim) && covered <= most) return OK;
  qsort(s->list, (size_t)s->n, sizeof *s->list, by_distance);
  for (int i = 1; i < s->n; ++i) PASS(uncover(s, f, i));
  return OK;
}

status partner_find(partner_search *s, int face, const facet *f) {
  const box_beam beam = beam_of(s, f);
  const int n = box_tree_along(&s->tree, &beam, s->found);
  s->n = s->n_cell = 0;
  for (int i = 0; i < n; ++i)
    if (s->in->master[s->found[i]] != face) PASS(try_master(s, f, s->found[i]));
  return s->n > 1 ? leave_nearest(s, f) : OK;
}
