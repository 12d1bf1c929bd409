/*
 * Cards of a material: elasticity, density, thermal strain.
 */
#include "model/cards/cards.h"

#include "base/memory.h"

#include <float.h>

status apply_material(reading *r) {
  const card_options *p = r->param;
  model *m = r->m;
  for (int i = 0; i < m->n.material; ++i)
    name_taken(r, p->name, m->materials[i].name);
  PASS_GROW(m->materials, m->n.material, m->cap.material);
  r->material_id = m->n.material++;
  m->materials[r->material_id].name = p->name == NULL ? "" : p->name;
  m->materials[r->material_id].at = *value_place(r, "NAME");
  return OK;
}

status apply_elastic(reading *r) {
  const card_options *p = r->param;
  const card *c = r->card;
  material *mat = &r->m->materials[r->material_id];
  char text[256];
  if (mat->has_elastic++) {
    message_add(r->m->log, P2011, &c->at, "material %s has *ELASTIC twice",
                mat->name);
    return OK;
  }
  mat->moduli = card_parameter(c, "MODULI") == NULL ? -1 : p->moduli;
  PASS(elastic_table_read(c, (elastic_type)p->type, mat->name, r->m->log,
                          &mat->elastic));
  if (mat->elastic.n > 0)
    (void)elastic_at(&mat->elastic, 0.0, mat->C, text, (int)sizeof text);
  return OK;
}

status apply_density(reading *r) {
  material *mat = &r->m->materials[r->material_id];
  const record *line = &r->card->records[0];
  if (mat->has_density)
    message_add(r->m->log, P2011, &r->card->at,
                "material %s has *DENSITY twice", mat->name);
  if (record_fields(r, line, 1, 1, "rho") != 0) return OK;
  if (field_real(r, &line->fields[0], 0.0, DBL_MAX, "rho", &mat->density) == 0)
    mat->has_density = 1;
  return OK;
}

/* One line of *EXPANSION into place i of the tables; 0 if fine. */
static int read_expansion(const reading *r, const record *line, int i,
                          expansion *x) {
  static const char *const expected[] = {
      "alpha [, temperature]", "alpha1, alpha2, alpha3 [, temperature]"};
  int n = x->type == EXPANSION_ORTHO ? 3 : 1, several = r->card->n_record > 1;
  double T = 0.0;
  if (record_fields(r, line, n + several, n + 1, expected[x->type]) != 0)
    return -1;
  if (line->n_field > n && field_real(r, &line->fields[n], -DBL_MAX, DBL_MAX,
                                      "temperature", &T) != 0)
    return -1;
  for (int c = 0; c < n; ++c) {
    if (deck_real(&line->fields[c], r->m->log, &x->alpha[c].value[i]) != 0)
      return -1;
    x->alpha[c].at[i] = T;
  }
  if (i == 0 || T > x->alpha[0].at[i - 1]) return 0;
  message_add(r->m->log, P2029, &line->fields[n].at,
              "*EXPANSION: the table must ascend, but %.15g follows %.15g", T,
              x->alpha[0].at[i - 1]);
  return -1;
}

status apply_expansion(reading *r) {
  const card_options *p = r->param;
  expansion *x = &r->m->materials[r->material_id].expand;
  int n = r->card->n_record, lines = 0;
  if (x->given++) {
    message_add(r->m->log, P2011, &r->card->at,
                "material %s has *EXPANSION twice",
                r->m->materials[r->material_id].name);
    return OK;
  }
  x->type = p->type;
  x->zero = p->zero;
  for (int c = 0; c < 3; ++c) {
    x->alpha[c].variable = TABLE_T;
    PASS_NEW(x->alpha[c].at, n);
    PASS_NEW(x->alpha[c].value, n);
  }
  while (lines < n &&
         read_expansion(r, &r->card->records[lines], lines, x) == 0)
    ++lines;
  for (int c = 0; c < 3; ++c) x->alpha[c].n = lines;
  return OK;
}
