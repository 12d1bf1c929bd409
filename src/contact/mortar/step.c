/*
 * Steps of the master below a node of the slave: of partners that are not
 * joined and lie at two heights, one has the node, the nearer. With both the
 * gap of the node were a mean, or less than either by the dual functions.
 */
#include "contact/mortar/partner.h"

#include "base/base.h"

/* -, of the largest face round the node: strains close a lower step. */
static const double LEAST = 0.001;

status steps_see(step_search *t, int i, const partner_search *s) {
  for (int k = 0; k < s->n; ++k) {
    PASS_GROW(t->seen, t->n_seen, t->capacity);
    t->seen[t->n_seen++] = s->list[k].face;
  }
  t->first[i + 1] = t->n_seen;
  return OK;
}

static status add_face(step_node *a, int face) {
  for (int k = 0; k < a->of.n; ++k)
    if (a->of.face[k] == face) return OK;
  return face_sets_add(&a->of, face);
}

/* How much higher face b is than face a, d[dim] from a node of a to one of b,
 * "away" in the plane, m: the less of what either plane says, less what their
 * tilt may make of it; 0: not clear. */
static double height_of(const partner_search *s, const double *normal, int a,
                        int b, const double *d, double away) {
  const int dim = s->in->mesh->dim;
  facet f, g;
  if (facet_set(dim, mortar_nodes(s->in, a), s->in->x, &f) != 0 ||
      facet_set(dim, mortar_nodes(s->in, b), s->in->x, &g) != 0)
    return 0.0;
  const double over = dot(dim, d, f.normal) / dot(dim, normal, f.normal);
  const double back = dot(dim, d, g.normal) / dot(dim, normal, g.normal);
  const double tilt = distance_of(dim, f.normal, g.normal);
  const double least = fmin(fabs(over), fabs(back)) - tilt * away;
  return over * back > 0.0 && least > 0.0 ? copysign(least, over) : 0.0;
}

/* How much higher set b is than a where they are nearest in the plane, m. */
static double step_to(const partner_search *s, const step_node *n, int a,
                      int b) {
  const int dim = s->in->mesh->dim, size = dim * n->of.n;
  double least = HUGE_VAL, step = 0.0;
  for (int i = 0; i < size; ++i) {
    if (forest_root(n->of.set, i / dim) != a) continue;
    const int face = n->of.face[i / dim];
    const double *x = mortar_place(s->in, mortar_nodes(s->in, face)[i % dim]);
    for (int j = 0; j < size; ++j) {
      if (forest_root(n->of.set, j / dim) != b) continue;
      const int other = n->of.face[j / dim];
      const double *y =
          mortar_place(s->in, mortar_nodes(s->in, other)[j % dim]);
      double d[3];
      vector_of(dim, x, y, d);
      const double height = dot(dim, d, n->normal);
      const double away = dot(dim, d, d) - height * height;
      if (!(away < least)) continue;
      least = away;
      step = height_of(s, n->normal, face, other, d, sqrt(fmax(0.0, away)));
    }
  }
  return step;
}

/* 1: set b is beyond a step; of two sets one is. */
static int is_beyond(const partner_search *s, const step_node *n, int b) {
  for (int a = 0; a < n->of.n; ++a) {
    if (n->of.set[a] != a || a == b) continue;
    const double step = a < b ? step_to(s, n, a, b) : -step_to(s, n, b, a);
    if (step > LEAST * n->size) return 1;
  }
  return 0;
}

/* The parts of slave face i on partners beyond a step. */
static status leave(step_search *t, const step_node *n, int set, int i) {
  for (int e = t->first[i]; e < t->first[i + 1]; ++e)
    for (int k = 0; k < n->of.n; ++k) {
      if (n->of.face[k] != t->seen[e] || forest_root(n->of.set, k) != set)
        continue;
      PASS_GROW(t->left, t->n_left, t->left_capacity);
      t->left[t->n_left++] = (step_part){i, t->seen[e]};
    }
  return OK;
}

static status look_round(step_search *t, const partner_search *s, int n_face,
                         const int *slave_no) {
  const int dim = s->in->mesh->dim;
  step_node *n = &t->node;
  n->of.n = 0;
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
  if (face_sets_join(s, &t->node.of)) return OK;
  for (int b = 0; b < n->of.n; ++b) {
    if (n->of.set[b] != b || !is_beyond(s, n, b)) continue;
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
