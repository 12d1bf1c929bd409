/*
 * Two partners of one component (joined through nodes) do not hide each other:
 * their projections have one sense. Where the partners are not joined, cover
 * more than there is, or are hidden by others, each loses what is covered by
 * nearer ones.
 */
#include "contact/mortar/partner.h"

#include "base/base.h"

status mortar_around(const mortar_input *in, int n, const int *face,
                     size_t **start, int **item) {
  const int dim = in->mesh->dim;
  OWNED_NEW(int, node, (size_t)dim *n);
  for (int i = 0; i < n; ++i)
    COPY(node + dim * i, mortar_nodes(in, face[i]), dim);
  return number_places(in->mesh->n_node, (size_t)dim * n, node, dim, start,
                       item);
}

/* Faces that are seen at less than this sine, from their edge, - . */
static const double edge_on = 1e-6;

/* Diagonal of the box round n faces, m; largest |coordinate| so far. */
static double extent(const mortar_input *in, int n, const int *face,
                     double *largest) {
  const int dim = in->mesh->dim;
  double low[3] = {0}, high[3] = {0};
  for (int i = 0; i < n * dim; ++i) {
    const double *x =
        mortar_place(in, mortar_nodes(in, face[i / dim])[i % dim]);
    for (int c = 0; c < dim; ++c) {
      low[c] = i == 0 ? x[c] : fmin(low[c], x[c]);
      high[c] = i == 0 ? x[c] : fmax(high[c], x[c]);
      *largest = fmax(*largest, fabs(x[c]));
    }
  }
  return distance_of(dim, high, low);
}

static status plant(const mortar_input *in, int n, const int *face,
                    box_tree *out) {
  const int dim = in->mesh->dim;
  const size_t size = (size_t)dim * dim;
  OWNED_NEW(double, corner, (size * n));
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < dim; ++k)
      COPY(corner + size * i + dim * k,
           mortar_place(in, mortar_nodes(in, face[i])[k]), dim);
  return box_tree_new(dim, n, dim, corner, out);
}

status partner_search_new(const mortar_input *in, partner_search *s) {
  const int n = in->n_master > in->n_slave ? in->n_master : in->n_slave;
  *s = (partner_search){.in = in};
  PASS_NEW_ALL(OF(s->master, in->n_master), OF(s->found, n),
               OF(s->group, in->mesh->n_node));
  for (int i = 0; i < in->mesh->n_node; ++i) s->group[i] = -1;
  for (int i = 0; i < in->n_master; ++i)
    if (facet_set(in->mesh->dim, mortar_nodes(in, in->master[i]), in->x,
                  &s->master[i]) != 0)
      s->master[i].measure = 0;
  s->reach = fmax(extent(in, in->n_slave, in->slave, &s->largest),
                  extent(in, in->n_master, in->master, &s->largest));
  PASS(plant(in, in->n_master, in->master, &s->masters));
  return plant(in, in->n_slave, in->slave, &s->slaves);
}

double partner_rounding(const partner_search *s, const facet *f) {
  const double size = f->dim == 2 ? f->measure : sqrt(f->measure);
  return 32 * DBL_EPSILON * (1 + s->largest / size);
}

/* The prism over f between two heights. */
static box_beam beam_of(const facet *f, double low, double high) {
  const int dim = f->dim;
  box_beam b = {.n_slab = dim};
  for (int a = 0; a < dim; ++a) {
    const double *axis = a < dim - 1 ? f->axis[a] : f->normal;
    double base = 0.0;
    for (int c = 0; c < dim; ++c) {
      b.axis[a][c] = axis[c];
      base += axis[c] * f->origin[c];
    }
    b.low[a] = a < dim - 1 ? HUGE_VAL : base + low;
    b.high[a] = a < dim - 1 ? -HUGE_VAL : base + high;
    for (int k = 0; k < dim && a < dim - 1; ++k) {
      b.low[a] = fmin(b.low[a], base + f->in_plane.at[k][a]);
      b.high[a] = fmax(b.high[a], base + f->in_plane.at[k][a]);
    }
  }
  return b;
}

/* Height of the partner above the middle of the cells, which is at x[dim]. */
static double middle_height(const facet *f, const partner *p, const cell *cells,
                            double *x) {
  const int dim = f->dim;
  double sum = 0.0, total = 0.0, middle[2] = {0, 0};
  for (int i = p->first; i < p->first + p->n; ++i) {
    double phi[3], at[2] = {0, 0};
    const double measure = cell_measure(dim, &cells[i]);
    for (int k = 0; k < dim; ++k)
      for (int c = 0; c < dim - 1; ++c) at[c] += cells[i].at[k][c] / dim;
    cell_functions(dim, &p->s.in_plane, at, phi);
    sum += measure * dot(dim, phi, p->s.height);
    add_scaled(dim - 1, measure, at, middle);
    total += measure;
  }
  COPY(x, f->origin, dim);
  for (int a = 0; a < dim - 1; ++a)
    add_scaled(dim, middle[a] / total, f->axis[a], x);
  return sum / total;
}

static double cells_measure(int dim, int n, const cell *cells) {
  double sum = 0.0;
  for (int i = 0; i < n; ++i) sum += cell_measure(dim, &cells[i]);
  return sum;
}

/* Clip with one face; it joins the list if something is in common. */
static status try_face(partner_search *s, int face, const facet *f, partner p) {
  double x[3];
  int is_behind = 0;
  cell common[CLIP_CELLS];
  facet_project(f, mortar_nodes(s->in, p.face), s->in->x, &p.s);
  p.n = cell_common(f->dim, &f->in_plane, &p.s.in_plane, common);
  const double negligible =
      partner_rounding(s, f) * fmin(f->measure, p.s.measure);
  if (!(cells_measure(f->dim, p.n, common) > negligible)) return OK;
  p.first = s->n_cell;
  for (int i = 0; i < p.n; ++i) {
    PASS_GROW(s->cells, s->n_cell, s->cell_capacity);
    s->cells[s->n_cell++] = common[i];
  }
  p.height = middle_height(f, &p, s->cells, x);
  if (fabs(p.height) > s->reach) return OK;
  if (p.hides == PARTNER && p.height < 0)
    PASS(partner_is_behind(s, face, f, x, &p, &is_behind));
  if (is_behind) return OK;
  PASS_GROW(s->list, s->n, s->capacity);
  s->list[s->n++] = p;
  return OK;
}

status face_sets_add(face_sets *a, int face) {
  PASS_GROW(a->face, a->n, a->capacity);
  PASS_GROW(a->set, a->n, a->set_capacity);
  a->set[a->n] = a->n;
  a->face[a->n++] = face;
  return OK;
}

int face_sets_join(partner_search *s, face_sets *a) {
  const int dim = s->in->mesh->dim;
  int n_set = a->n;
  for (int k = 0; k < a->n * dim; ++k) {
    int *at = &s->group[mortar_nodes(s->in, a->face[k / dim])[k % dim]];
    if (*at < 0) *at = k / dim;
    n_set -= forest_root(a->set, *at) != forest_root(a->set, k / dim);
    forest_join(a->set, *at, k / dim);
  }
  for (int k = 0; k < a->n * dim; ++k)
    s->group[mortar_nodes(s->in, a->face[k / dim])[k % dim]] = -1;
  return n_set <= 1;
}

static int share_node(int dim, const int *a, const int *b) {
  for (int i = 0; i < dim * dim; ++i)
    if (a[i / dim] == b[i % dim]) return 1;
  return 0;
}

/* Order of nearness, m. Bodies do not overlap by more than half of the slave's
 * thickness: its back counts at half the distance. */
static double distance(const partner *p) {
  const int is_back = p->hides == HIDING_SLAVE && p->height < 0;
  return (is_back ? 0.5 : 1) * fabs(p->height);
}

static int by_distance(const void *a, const void *b) {
  const partner *p = a, *q = b;
  const double near = distance(p), far = distance(q);
  if (near != far) return near < far ? -1 : 1;
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

/* 1: q, which is nearer, may hide a part of partner p. */
static int may_hide(const partner_search *s, int dim, const partner *q,
                    const partner *p) {
  if (q->hides) return (q->height < 0) == (p->height < 0);
  return !share_node(dim, mortar_nodes(s->in, p->face),
                     mortar_nodes(s->in, q->face));
}

/* The cells of partner i less what those before it in the list cover. */
static status uncover(partner_search *s, const facet *f, int i) {
  const int dim = f->dim;
  partner *p = &s->list[i];
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
    if (!may_hide(s, dim, q, p)) continue;
    const int n = cell_common(dim, &p->s.in_plane, &q->s.in_plane, common);
    if (cells_measure(dim, n, common) > negligible)
      PASS(take_out(s, dim, first, q, negligible));
  }
  p->first = first;
  p->n = s->n_cell - first;
  return OK;
}

/* Take the faces that hide none of the partners from the list: those farther
 * than all partners on their side. */
static void leave_hiding(partner_search *s) {
  double farthest[2] = {-1, -1};
  int n = 0;
  for (int i = 0; i < s->n; ++i) {
    double *side = &farthest[s->list[i].height < 0];
    if (!s->list[i].hides) *side = fmax(*side, fabs(s->list[i].height));
  }
  for (EACH(const partner, p, s->list, s->n))
    if (!p->hides || distance(p) < farthest[p->height < 0]) s->list[n++] = *p;
  s->n = n;
}

/* *is 1: no part is covered twice or hidden. */
static status find_single(partner_search *s, const facet *f, int *is) {
  double covered = 0.0;
  s->sets.n = 0;
  *is = 0;
  for (int i = 0; i < s->n; ++i) {
    if (s->list[i].hides) return OK;
    covered += cells_measure(f->dim, s->list[i].n, s->cells + s->list[i].first);
    PASS(face_sets_add(&s->sets, s->list[i].face));
  }
  *is = covered <= f->measure * (1 + s->n * partner_rounding(s, f)) &&
        face_sets_join(s, &s->sets);
  return OK;
}

/* Of faces one behind the other only the nearest is left. */
static status leave_nearest(partner_search *s, const facet *f) {
  int n = 0;
  qsort(s->list, s->n, sizeof *s->list, by_distance);
  for (int i = 1; i < s->n; ++i)
    if (!s->list[i].hides) PASS(uncover(s, f, i));
  for (int i = 0; i < s->n; ++i)
    if (!s->list[i].hides && s->list[i].n > 0) s->list[n++] = s->list[i];
  s->n = n;
  return OK;
}

/* Masters in the prism over f, those that oppose it and the others. */
static status add_masters(partner_search *s, int face, const facet *f) {
  const box_beam beam = beam_of(f, -s->reach, s->reach);
  const int n = box_tree_along(&s->masters, &beam, s->found);
  for (int i = 0; i < n; ++i) {
    const facet *m = &s->master[s->found[i]];
    const partner p = {.face = s->in->master[s->found[i]],
                       .hides = dot(f->dim, f->normal, m->normal) < -edge_on
                                    ? PARTNER
                                    : HIDING_MASTER,
                       .size = m->measure};
    if (m->measure > 0 && p.face != face) PASS(try_face(s, face, f, p));
  }
  return OK;
}

static int is_listed(const partner_search *s, int n, int face) {
  for (int i = 0; i < n; ++i)
    if (s->list[i].face == face) return 1;
  return 0;
}

/* Other faces of the slave that stand between f and its partners. */
static status add_slaves(partner_search *s, int face, const facet *f) {
  const int dim = f->dim, n_master = s->n;
  const int *node = mortar_nodes(s->in, face);
  double low = 0.0, high = 0.0;
  for (int i = 0; i < s->n; ++i) {
    low = fmin(low, s->list[i].height);
    high = fmax(high, s->list[i].height);
  }
  const box_beam beam = beam_of(f, 2 * low, high);
  const int n = box_tree_along(&s->slaves, &beam, s->found);
  for (int i = 0; i < n; ++i) {
    const partner p = {.face = s->in->slave[s->found[i]],
                       .hides = HIDING_SLAVE};
    if (share_node(dim, node, mortar_nodes(s->in, p.face))) continue;
    if (!is_listed(s, n_master, p.face)) PASS(try_face(s, face, f, p));
  }
  return OK;
}

status partner_find(partner_search *s, int face, const facet *f) {
  int is_single;
  s->n = s->n_cell = 0;
  PASS(add_masters(s, face, f));
  if (s->n > 0) PASS(add_slaves(s, face, f));
  leave_hiding(s);
  PASS(find_single(s, f, &is_single));
  return is_single ? OK : leave_nearest(s, f);
}
