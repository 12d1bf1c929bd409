/*
 * Steps of the master below a node of the slave: of partners that are not
 * joined and lie at two heights, one has the node, the nearer. With both the
 * gap of the node were a mean, or less than either by the dual functions.
 */
#include "contact/mortar/partner.h"

#include "base/base.h"

/* -, of the largest face round the node: both sides of a higher step touch only
 * by a turn that is not small. */
static const double LEAST = 0.01;

status steps_see(step_search *t, int i, const partner_search *s) {
  for (int k = 0; k < s->n; ++k) {
    PASS_GROW(t->seen, t->n_seen, t->capacity);
    t->seen[t->n_seen++] = s->list[k].face;
  }
  t->first[i + 1] = t->n_seen;
  return OK;
}

static status add_face(step_node *a, int face) {
  for (int k = 0; k < a->n; ++k)
    if (a->face[k] == face) return OK;
  PASS_GROW(a->face, a->n, a->capacity);
  PASS_GROW(a->set, a->n, a->set_capacity);
  a->set[a->n] = a->n;
  a->face[a->n++] = face;
  return OK;
}

/* 1: they are joined through nodes. */
static int join(partner_search *s, step_node *a) {
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

/* How far x is beyond the plane of a face through "of", along the normal, m. */
static double height_over(const partner_search *s, const double *normal,
                          int face, const double *of, const double *x) {
  const int dim = s->in->mesh->dim;
  double d[3];
  facet f;
  if (facet_set(dim, mortar_nodes(s->in, face), s->in->x, &f) != 0) return 0.0;
  vector_of(dim, of, x, d);
  return dot(dim, d, f.normal) / dot(dim, normal, f.normal);
}

/* How much higher set b is than set a where they are nearest in the plane, m;
 * 0: not clear. */
static double step_to(const partner_search *s, const step_node *n, int a,
                      int b) {
  const int dim = s->in->mesh->dim, size = dim * n->n;
  double least = HUGE_VAL, step = 0.0;
  for (int i = 0; i < size; ++i) {
    if (forest_root(n->set, i / dim) != a) continue;
    const int face = n->face[i / dim];
    const double *x = mortar_place(s->in, mortar_nodes(s->in, face)[i % dim]);
    for (int j = 0; j < size; ++j) {
      if (forest_root(n->set, j / dim) != b) continue;
      const int other = n->face[j / dim];
      const double *y =
          mortar_place(s->in, mortar_nodes(s->in, other)[j % dim]);
      double d[3];
      vector_of(dim, x, y, d);
      const double height = dot(dim, d, n->normal);
      const double away = dot(dim, d, d) - height * height;
      if (!(away < least)) continue;
      least = away;
      const double over = height_over(s, n->normal, face, x, y);
      const double back = -height_over(s, n->normal, other, y, x);
      step = over * back > 0.0 ? copysign(fmin(fabs(over), fabs(back)), over)
                               : 0.0;
    }
  }
  return step;
}

/* 1: set b is beyond a step. */
static int is_beyond(const partner_search *s, const step_node *n, int b) {
  for (int a = 0; a < n->n; ++a)
    if (n->set[a] == a && a != b && step_to(s, n, a, b) > LEAST * n->size)
      return 1;
  return 0;
}

/* The parts of slave face i on partners beyond a step. */
static status leave(step_search *t, const step_node *n, int set, int i) {
  for (int e = t->first[i]; e < t->first[i + 1]; ++e)
    for (int k = 0; k < n->n; ++k) {
      if (n->face[k] != t->seen[e] || forest_root(n->set, k) != set) continue;
      PASS_GROW(t->left, t->n_left, t->left_capacity);
      t->left[t->n_left++] = (step_part){i, t->seen[e]};
    }
  return OK;
}

static status look_round(step_search *t, const partner_search *s, int n_face,
                         const int *slave_no) {
  const int dim = s->in->mesh->dim;
  step_node *n = &t->node;
  n->n = 0;
  n->size = 0.0;
  CLEAR(n->normal, 3);
  for (int k = 0; k < n_face; ++k) {
    const int i = slave_no[k];
    facet f;
    for (int e = t->first[i]; e < t->first[i + 1]; ++e)
      PASS(add_face(n, t->seen[e]));
    if (facet_set(dim, mortar_nodes(s->in, s->in->slave[i]), s->in->x, &f) != 0)
      continue;
    n->size = fmax(n->size, dim == 2 ? f.measure : sqrt(f.measure));
    add_scaled(dim, 1.0, f.normal, n->normal);
  }
  make_unit(dim, n->normal);
  return OK;
}

status steps_find(step_search *t, partner_search *s, int n_face,
                  const int *slave_no) {
  const step_node *n = &t->node;
  PASS(look_round(t, s, n_face, slave_no));
  if (n->n < 2 || join(s, &t->node)) return OK;
  for (int b = 0; b < n->n; ++b) {
    if (n->set[b] != b || !is_beyond(s, n, b)) continue;
    for (int k = 0; k < n_face; ++k) PASS(leave(t, n, b, slave_no[k]));
  }
  return OK;
}

void steps_leave(const step_search *t, int i, partner_search *s) {
  int n = 0;
  for (EACH(const partner, p, s->list, s->n)) {
    int is = 0;
    for (int k = 0; k < t->n_left && !is; ++k)
      is = t->left[k].slave_no == i && t->left[k].face == p->face;
    if (!is) s->list[n++] = *p;
  }
  s->n = n;
}
