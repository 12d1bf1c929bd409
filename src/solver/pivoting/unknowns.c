/*
 * Unknowns of the contact problem and variables z of the complementarity
 * problem: which are kept, and what each one stands for.
 */
#include "solver/pivoting/parts.h"

#include <math.h>

static int has_friction(const contact_problem *cp, int node_id) {
  if (cp->g0 == NULL) return 0;
  if (contact_has_side(cp, node_id)) return 0;
  if (cp->g0[node_id] != 0.0) return 1;
  for (int k = cp->B == NULL ? 0 : cp->B->start[node_id];
       cp->B != NULL && k < cp->B->start[node_id + 1]; ++k)
    if (cp->B->val[k] != 0.0) return 1;
  return 0;
}

void lemke_sort_unknowns(lemke_run *s) {
  const contact_problem *cp = s->cp;
  lemke_work *w = s->w;
  w->n_kept = w->n_free = 0;
  for (int dof = 0; dof < cp->m; ++dof) {
    dof_kind kind = IS_FREE;
    if (contact_held(cp, dof))
      kind = IS_HELD;
    else if (contact_bound(cp, dof) < HUGE_VAL)
      kind = IS_BOUND;
    else if (has_friction(cp, dof / cp->dim))
      kind = IS_FRICTION;
    w->kind[dof] = (int)kind;
    if (kind == IS_FREE) w->free_id[w->n_free++] = dof;
    if (kind == IS_BOUND || kind == IS_FRICTION) w->kept[w->n_kept++] = dof;
  }
}

/* The directions of slip of a node whose first tangent is "dof". */
static void add_directions(lemke_work *w, int node_id, int dof, int tangents) {
  int count = tangents == 1 ? 2 : w->facets;
  const double full = 2.0 * acos(-1.0);
  w->slide[node_id] = w->n_var;
  w->n_slide[node_id] = count;
  if (tangents == 2) w->has_facets = 1;
  for (int j = 0; j < count; ++j) {
    int half = j % (count / 2);
    double sign = j < count / 2 ? 1.0 : -1.0, angle = full * half / count;
    variable v = {SLIDE, node_id, dof, {sign, 0.0}};
    if (tangents == 2) {
      v.e[0] = sign * cos(angle);
      v.e[1] = sign * sin(angle);
    }
    w->var[w->n_var++] = v;
  }
}

void lemke_list_variables(lemke_run *s) {
  lemke_work *w = s->w;
  int dim = s->cp->dim;
  w->n_var = w->has_facets = 0;
  for (int i = 0; i < s->cp->n; ++i) w->n_slide[i] = 0;
  for (int i = 0; i < w->n_kept; ++i) {
    int dof = w->kept[i], node_id = dof / dim;
    if (w->kind[dof] == IS_BOUND) {
      if (dof % dim == 0) w->normal[node_id] = w->n_var;
      w->var[w->n_var++] = (variable){BOUND, node_id, i, {-1.0, 0.0}};
    } else if (w->n_slide[node_id] == 0) {
      int two = i + 1 < w->n_kept && w->kept[i + 1] / dim == node_id;
      add_directions(w, node_id, i, two ? 2 : 1);
      if (!lemke_is_stiff(s))
        w->var[w->n_var++] = (variable){LIMIT, node_id, i, {0.0, 0.0}};
    }
  }
}
