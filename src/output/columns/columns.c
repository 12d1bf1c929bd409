/*
 * The columns one after another, which of them a model and a state have, and
 * their units.
 */
#include "output/columns/rows.h"

#include <stdio.h>
#include <string.h>

static const column *const parts[] = {increment_columns, node_columns,
                                      element_columns,   contact_node_columns,
                                      zone_columns,      contact_columns};
enum { N_PART = sizeof parts / sizeof *parts };

const column *column_next(const column *c) {
  int k = 0;
  if (c != NULL && c[1].name != NULL) return c + 1;
  if (c != NULL)
    while (parts[k++]->of != c->of) continue;
  return k < N_PART ? parts[k] : NULL;
}

const char *status_word(unsigned k) {
  static const char *const words[] = {"OPEN", "SLIP", "STICK"};
  return k < 3 ? words[k] : "?";
}

unsigned scene_of(const model *m) {
  if (m->dim == 3) return SCENE_SOLID;
  if (m->dim == 1) return SCENE_LCP;
  for (int i = 0; i < m->n_section; ++i)
    if (m->sections[i].kin % 4 == AXISYMMETRIC) return SCENE_AXI;
  return SCENE_PLANE;
}

/* The most internal variables that a law of the model has. */
static int most_internal(const model *m) {
  int most = 0;
  for (int i = 0; i < m->n_material; ++i) {
    const law_card *law = &m->materials[i].law;
    if (!m->materials[i].used || law->ops == NULL) continue;
    int n = law_n_alpha(law, m->ns);
    if (n > most) most = n;
  }
  return most;
}

/* 1 unless its tables are ones that only *PRINT brings about. */
static int is_asked(const column *c, const model *m) {
  const unsigned extra = PRINT_ZONES | PRINT_LOOP;
  if ((c->needs & NEEDS_TORQUE) != 0 && !model_has_axis(m)) return 0;
  if ((c->needs & NEEDS_SEVERAL) != 0 && m->n_contact < 2) return 0;
  if ((c->needs & NEEDS_ALPHA) != 0 && c->part >= most_internal(m)) return 0;
  if (c->tables == 0 || (c->tables & ~extra) != 0) return 1;
  return model_prints(m, (int)c->tables);
}

int column_visible(const column *c, const model *m) {
  return is_asked(c, m) && (c->effects & ~m->effects) == 0 &&
         (c->scenes & scene_of(m)) != 0;
}

static unsigned if_there(const void *p, unsigned bits) {
  return p != NULL ? bits : 0;
}

int column_ready(const column *c, const state *s) {
  unsigned have = 0;
  have |= if_there(s->strain, NEEDS_STRAIN);
  have |= if_there(s->stress, NEEDS_STRESS);
  have |= if_there(s->reaction, NEEDS_REACTION);
  have |= if_there(s->surface, NEEDS_SURFACE);
  if (s->surface != NULL && s->surface->x != NULL)
    have |= NEEDS_PLACE | NEEDS_SEVERAL;
  have |= if_there(s->limit, NEEDS_LIMIT);
  have |= if_there(s->totals, NEEDS_TOTALS);
  have |= if_there(s->distance, NEEDS_DISTANCE);
  have |= if_there(s->torque, NEEDS_TORQUE);
  have |= if_there(s->loops, NEEDS_LOOP);
  have |= if_there(s->zones, NEEDS_ZONES);
  have |= if_there(s->elem_error, NEEDS_ELEM_ERROR);
  have |= if_there(s->flow, NEEDS_FLOW | NEEDS_ALPHA);
  return (c->needs & ~have) == 0;
}

int column_items(entity of, const view *v) {
  switch (of) {
    case PER_NODE:
      return v->msh->n_node;
    case PER_ELEMENT:
      return v->msh->n_elem;
    case PER_CONTACT_NODE:
      return v->s->surface != NULL ? v->s->surface->n : 0;
    case PER_CONTACT:
      return v->m->n_contact;
    case PER_ZONE:
      return v->s->n_zone;
    default:
      return 1;
  }
}

void column_unit(const char *unit, const model *m, char *text, size_t size) {
  const char *const words[] = {"length", "force", "time"};
  const char *const labels[] = {m->length_unit, m->force_unit, m->time_unit};
  size_t used = 0;
  text[0] = '\0';
  while (*unit != '\0' && used + 1 < size) {
    int k = 0;
    while (k < 3 && strncmp(unit, words[k], strlen(words[k])) != 0) ++k;
    int known = k < 3 && labels[k] != NULL;
    int n = known ? snprintf(text + used, size - used, "%s", labels[k])
                  : snprintf(text + used, size - used, "%c", *unit);
    unit += known ? strlen(words[k]) : 1;
    used += (size_t)n;
  }
}
