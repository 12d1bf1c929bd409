/* Elasticity of the elements at their temperatures. */
#include "run/run.h"

static const material *material_of(const model *m, int section_id) {
  return &m->materials[m->sections[section_id].material_id];
}

int moduli_follows(const model *m, int elem_id) {
  return (m->effects & EFFECT_THERMAL) &&
         material_of(m, m->elem_section[elem_id])->elastic.n > 1;
}

/* C, which is of the size of an entry, into entry i. */
static void put_entry(moduli *x, const model *m, int i, const double C[36]) {
  COPY(x->C + 36 * (size_t)i, C, 36);
  elastic_reduce(C, x->kin[i], x->E + (size_t)(m->ns * m->ns) * i);
}

/* Entry n_section + k at the temperature T; 1 in *changed if it is new. */
static status heat_entry(moduli *x, const model *m, int k, double T,
                         int *changed) {
  const int i = x->n - x->n_own + k, e = x->elem_id[k];
  const material *mat = material_of(m, m->elem_section[e]);
  double C[36] = {0};
  char text[256];
  const char *wrong = elastic_at(&mat->elastic, T, C, text, (int)sizeof text);
  x->at[k] = T;
  if (wrong != NULL)
    RAISE(ERR_DECK, "%s:%d: material %s at the temperature %g: %s",
          PLACE(mat->at), mat->name, T, wrong);
  if (memcmp(C, x->C + 36 * (size_t)i, sizeof C) == 0) return OK;
  put_entry(x, m, i, C);
  *changed = 1;
  return OK;
}

/* Elements that follow their temperature get entries behind the sections. */
static status own_entries(moduli *x, const model *m, const mesh *msh) {
  int n = 0;
  PASS_NEW_ALL(OF(x->section_id, msh->n_elem), OF(x->elem_id, x->n_own),
               OF(x->at, x->n_own));
  for (int e = 0; e < msh->n_elem; ++e) {
    x->section_id[e] = m->elem_section[e];
    if (!moduli_follows(m, e)) continue;
    const int own = m->n.section + n;
    x->origin[own] = m->elem_section[e];
    x->kin[own] = x->kin[m->elem_section[e]];
    x->thickness[own] = x->thickness[m->elem_section[e]];
    x->section_id[e] = own;
    x->elem_id[n++] = e;
  }
  return OK;
}

status moduli_new(const model *m, const mesh *msh, const double *T, moduli *x) {
  int changed = 0;
  for (int e = 0; e < msh->n_elem && T != NULL; ++e)
    x->n_own += moduli_follows(m, e);
  x->n = m->n.section + x->n_own;
  PASS_NEW_ALL(OF(x->origin, x->n), OF(x->kin, x->n), OF(x->thickness, x->n),
               OF(x->E, (size_t)(m->ns * m->ns) * x->n),
               OF(x->C, 36 * (size_t)x->n));
  for (int i = 0; i < m->n.section; ++i) {
    x->origin[i] = i;
    x->kin[i] = (kinematics)m->sections[i].kin;
    x->thickness[i] = m->sections[i].thickness;
    put_entry(x, m, i, material_of(m, i)->C);
  }
  if (x->n_own == 0) return OK;
  PASS(own_entries(x, m, msh));
  for (int k = 0; k < x->n_own; ++k)
    PASS(heat_entry(x, m, k, T[x->elem_id[k]], &changed));
  return OK;
}

status moduli_heat(moduli *x, const model *m, const double *T, int *changed) {
  *changed = 0;
  for (int k = 0; k < x->n_own; ++k)
    if (T[x->elem_id[k]] != x->at[k])
      PASS(heat_entry(x, m, k, T[x->elem_id[k]], changed));
  return OK;
}

void moduli_domain(const moduli *x, const model *m, domain *d) {
  d->ns = m->ns;
  d->section_id = x->section_id != NULL ? x->section_id : m->elem_section;
  d->origin = x->origin;
  d->kin = x->kin;
  d->thickness = x->thickness;
  d->E = x->E;
  d->C = x->C;
}
