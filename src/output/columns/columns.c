/*
 * The columns one after another, which of them a model and a state have, and
 * their units.
 */
#include "output/columns/columns.h"
#include "run/column_row.h"
#include "effects/rows.h"

#include <stdio.h>
#include <string.h>

extern const column increment_columns[], node_columns[], element_columns[],
    contact_node_columns[], contact_columns[];
static const column zone_columns[] = {OF_EFFECTS(0), NO_COLUMN};
static const column tip_columns[] = {OF_EFFECTS(0), NO_COLUMN};
static const column goal_columns[] = {OF_EFFECTS(0), NO_COLUMN};

static const struct {
  entity of;
  const column *column;
} parts[] = {{PER_INCREMENT, increment_columns},
             {PER_NODE, node_columns},
             {PER_ELEMENT, element_columns},
             {PER_CONTACT_NODE, contact_node_columns},
             {PER_ZONE, zone_columns},
             {PER_TIP, tip_columns},
             {PER_GOAL, goal_columns},
             {PER_CONTACT, contact_columns}};

enum { N_PART = sizeof parts / sizeof *parts };

/* The next of the effects at a place in the list of an entity, or NULL. */
static const column *next_of_effects(column_walk *w, int nth) {
  for (; effect_table[w->effect] != NULL; ++w->effect, w->k = 0)
    while (w->k < effect_table[w->effect]->n_column) {
      const column *c = &effect_table[w->effect]->columns[w->k++];
      if (c->of == parts[w->part].of && (int)(c->tables >> COLUMN_PLACE) == nth)
        return c;
    }
  w->effect = 0;
  return NULL;
}

column_walk columns_of(entity of) {
  column_walk w = {0};
  while (parts[w.part].of != of) ++w.part;
  return w;
}

const column *column_next(column_walk *w) {
  const column *c = NULL;
  while (c == NULL && w->part < N_PART) {
    const column *own = &parts[w->part].column[w->at];
    if (own->name == NULL) {
      ++w->part;
      w->at = 0;
      continue;
    }
    c = own->name[0] != '\0' ? own : next_of_effects(w, own->part);
    if (c == own || c == NULL) ++w->at;
  }
  return c;
}

unsigned scene_of(const model *m) {
  if (m->dim == 3) return SCENE_SOLID;
  if (m->dim == 1) return SCENE_LCP;
  for (int i = 0; i < m->n.section; ++i)
    if (m->sections[i].kin % 4 == AXISYMMETRIC) return SCENE_AXI;
  return SCENE_PLANE;
}

/* The most internal variables that a law of the model has. */
static int most_internal(const model *m) {
  int most = 0;
  for (int i = 0; i < m->n.material; ++i) {
    const law_card *law = &m->materials[i].law;
    if (!m->materials[i].used || law->ops == NULL) continue;
    int n = law_n_alpha(law, m->ns);
    if (n > most) most = n;
  }
  return most;
}

/* 1: the model has what it is of. */
static int is_asked(const column *c, const model *m) {
  if ((c->needs & NEEDS_TORQUE) != 0 && !model_has_axis(m)) return 0;
  if ((c->needs & NEEDS_SEVERAL) != 0 && m->n.contact < 2) return 0;
  if ((c->needs & NEEDS_ALPHA) != 0 && c->part >= most_internal(m)) return 0;
  return 1;
}

int column_visible(const column *c, const model *m) {
  const effect_ops *e = effect_of_column(c);
  if (e != NULL && !effect_is_on(e, m)) return 0;
  return is_asked(c, m) && (c->effects & ~m->effects) == 0 &&
         (c->scenes & scene_of(m)) != 0;
}

static unsigned if_there(const void *p, unsigned bits) {
  return p != NULL ? bits : 0;
}

int column_ready(const column *c, const state *s) {
  const effect_ops *e = effect_of_column(c);
  unsigned have = 0;
  if (e != NULL && e->on.create != NULL && !e->of_state &&
      effect_state(s->effects, e) == NULL)
    return 0;
  have |= if_there(s->body.strain, NEEDS_STRAIN);
  have |= if_there(s->body.stress, NEEDS_STRESS);
  have |= if_there(s->body.reaction, NEEDS_REACTION);
  have |= if_there(s->contacts.surface, NEEDS_SURFACE);
  if (s->contacts.surface != NULL && s->contacts.surface->x != NULL)
    have |= NEEDS_PLACE | NEEDS_SEVERAL;
  have |= if_there(s->contacts.limit, NEEDS_LIMIT);
  have |= if_there(s->contacts.totals, NEEDS_TOTALS);
  have |= if_there(s->contacts.distance, NEEDS_DISTANCE);
  have |= if_there(s->contacts.torque, NEEDS_TORQUE);
  have |= if_there(s->errors.elem_error, NEEDS_ELEM_ERROR);
  have |= if_there(s->body.flow, NEEDS_FLOW | NEEDS_ALPHA);
  return (c->needs & ~have) == 0;
}

int column_items(const column *c, const view *v) {
  const effect_ops *e = effect_of_column(c);
  switch (c->of) {
    case PER_NODE:
      return v->msh->n_node;
    case PER_ELEMENT:
      return v->msh->n_elem;
    case PER_CONTACT_NODE:
      return v->s->contacts.surface != NULL ? v->s->contacts.surface->n : 0;
    case PER_CONTACT:
      return v->m->n.contact;
    case PER_ZONE:
    case PER_TIP:
    case PER_GOAL:
      return e->items(effect_state(v->s->effects, e));
    default:
      return 1;
  }
}

void column_unit(const char *unit, const model *m, char *text, size_t size) {
  const char *const words[] = {"length", "force", "time"};
  const char *const labels[] = {m->unit.length, m->unit.force, m->unit.time};
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
