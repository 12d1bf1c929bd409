/*
 * On how many nodes, elements or rows of the mesh an effect works.
 */
#include "effects/plan/rows.h"

#include "base/memory.h"

#include <math.h>

status items_contact_nodes(const model *m, const mesh *msh,
                           int (*is)(const friction_rule *rule), double *n) {
  status st = OK;
  unsigned char *seen = NULL;
  *n = 0.0;
  NEW(seen, msh->n_node);
  for (int i = 0; i < m->n_contact; ++i) {
    const mesh_group *g = &msh->group[m->contacts[i].group_id];
    int counts = is == NULL;
    for (int k = 0; k < m->n_step && !counts; ++k)
      counts = is(friction_in_force(m, k, i));
    for (int k = 0; k < g->n_node && counts; ++k) {
      *n += !seen[g->node_id[k]];
      seen[g->node_id[k]] = 1;
    }
  }
done:
  memory_free(seen);
  return st;
}

static double given_nodes(const model *m, const mesh *msh) {
  double n = 0.0;
  for (int i = 0; i < m->n_contact; ++i)
    if (m->contacts[i].force.given)
      n += msh->group[m->contacts[i].group_id].n_node;
  return n;
}

/* Elements of a section. */
static double section_elements(const model *m, const mesh *msh, int id) {
  double n = 0.0;
  for (int e = 0; e < msh->n_elem; ++e) n += m->elem_section[e] == id;
  return n;
}

const material *plan_material(const model *m, int section_id) {
  static const material unknown;
  int id = m->sections[section_id].material_id;
  return id >= 0 ? &m->materials[id] : &unknown;
}

static double heated_elements(const model *m, const mesh *msh) {
  double n = 0.0;
  for (int i = 0; i < m->n_section; ++i) {
    const material *mat = plan_material(m, i);
    if (mat->expand.given || (mat->law.ops != NULL &&
                              (law_varies(&mat->law) & LAW_VARIES_TEMPERATURE)))
      n += section_elements(m, msh, i);
  }
  return n;
}

static double loaded_elements(const model *m, const mesh *msh) {
  double n = 0.0;
  for (int i = 0; i < m->n_step; ++i) {
    double here = 0.0;
    const load_list *l = &m->steps[i].loads;
    for (int k = 0; k < l->n; ++k)
      if (l->item[k].kind == LOAD_BODY || l->item[k].kind == LOAD_GRAVITY)
        here += msh->group[l->item[k].group_id].n_item;
    n = fmax(n, here);
  }
  return n;
}

status items_held_unknowns(const model *m, const mesh *msh, double *unknowns,
                           double *nodes) {
  status st = OK;
  int dim = msh->dim;
  unsigned char *fixed = NULL;
  *unknowns = *nodes = 0.0;
  NEW(fixed, dim * msh->n_node);
  if (m->n_step > 0) load_fixed(m, msh, &m->steps[0], fixed);
  for (int i = 0; i < msh->n_node; ++i) {
    int any = 0;
    for (int c = 0; c < dim; ++c) any += fixed[dim * i + c] != 0;
    *unknowns += any;
    *nodes += any > 0;
  }
done:
  memory_free(fixed);
  return st;
}

static status of_elements(const model *m, const mesh *msh, const plan_sizes *s,
                          double *n) {
  (void)m;
  (void)msh;
  *n = s->elements;
  return OK;
}

static status of_nodes(const model *m, const mesh *msh, const plan_sizes *s,
                       double *n) {
  (void)m;
  (void)msh;
  *n = s->nodes;
  return OK;
}

static status of_contact(const model *m, const mesh *msh, const plan_sizes *s,
                         double *n) {
  (void)m;
  (void)msh;
  *n = s->contact;
  return OK;
}

static status of_tangents(const model *m, const mesh *msh, const plan_sizes *s,
                          double *n) {
  (void)m;
  (void)msh;
  *n = s->tangents;
  return OK;
}

static status of_friction(const model *m, const mesh *msh, const plan_sizes *s,
                          double *n) {
  *n = s->contact;
  return msh == NULL ? OK : items_contact_nodes(m, msh, rule_has_friction, n);
}

static status of_average(const model *m, const mesh *msh, const plan_sizes *s,
                         double *n) {
  (void)s;
  *n = 0.0;
  return msh == NULL ? OK : items_contact_nodes(m, msh, rule_has_average, n);
}

static status of_given(const model *m, const mesh *msh, const plan_sizes *s,
                       double *n) {
  (void)s;
  *n = msh == NULL ? 0.0 : given_nodes(m, msh);
  return OK;
}

static status of_heated(const model *m, const mesh *msh, const plan_sizes *s,
                        double *n) {
  (void)s;
  *n = msh == NULL ? 0.0 : heated_elements(m, msh);
  return OK;
}

static status of_loaded(const model *m, const mesh *msh, const plan_sizes *s,
                        double *n) {
  (void)s;
  *n = msh == NULL ? 0.0 : loaded_elements(m, msh);
  return OK;
}

static status of_held(const model *m, const mesh *msh, const plan_sizes *s,
                      double *n) {
  double unknowns;
  (void)s;
  *n = 0.0;
  return msh == NULL ? OK : items_held_unknowns(m, msh, &unknowns, n);
}

static status of_contacts(const model *m, const mesh *msh, const plan_sizes *s,
                          double *n) {
  (void)msh;
  (void)s;
  *n = m->n_contact;
  return OK;
}

static status of_one(const model *m, const mesh *msh, const plan_sizes *s,
                     double *n) {
  (void)m;
  (void)msh;
  (void)s;
  *n = 1.0;
  return OK;
}

status items_of(items_kind kind, const model *m, const mesh *msh,
                const plan_sizes *s, double *n) {
  static status (*const of[])(const model *m, const mesh *msh,
                              const plan_sizes *s, double *n) = {
      [OF_ELEMENTS] = of_elements, [OF_NODES] = of_nodes,
      [OF_CONTACT] = of_contact,   [OF_TANGENTS] = of_tangents,
      [OF_FRICTION] = of_friction, [OF_AVERAGE] = of_average,
      [OF_GIVEN] = of_given,       [OF_HEATED] = of_heated,
      [OF_LOADED] = of_loaded,     [OF_HELD] = of_held,
      [OF_CONTACTS] = of_contacts, [OF_ONE] = of_one};
  return of[kind](m, msh, s, n);
}
