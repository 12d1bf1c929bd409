/*
 * The columns one after another, which of them a model and a state have, their
 * units; those with one value an increment; tables as text.
 */
#include "output/columns/columns.h"

#include "base/text.h"
#include "effects/rows.h"
#include "run/column_row.h"

#include <stdio.h>
#include <string.h>

VALUE(step_no, v->s->step_no)
VALUE(increment_no, v->s->increment_no)
VALUE(total_no, v->s->total_no)
VALUE(attempt, v->s->attempt)
VALUE(time_now, v->s->t)
VALUE(time_step, v->s->dt)
VALUE(settled, v->s->settled)
VALUE(n_open, v->s->contacts.n_open)
VALUE(n_slip, v->s->contacts.n_slip)
VALUE(n_stick, v->s->contacts.n_stick)
VALUE(iterations, v->s->report.iterations)
VALUE(residual, v->s->report.residual)
VALUE(strain_energy, v->s->energy.strain)
VALUE(external_work, v->s->energy.external)
VALUE(normal_work, v->s->energy.normal)
VALUE(energy_defect, v->s->energy.defect)

double energy_defect_relative(const energies *e) {
  return e->largest > 0 ? e->defect / e->largest : 0;
}
VALUE(defect_relative, energy_defect_relative(&v->s->energy))

/* clang-format off */
#define COUNT(name, tables, effects, value, help)                           \
  {name, "-", PER_INCREMENT, AS_COUNT, tables, effects, ANY, name, 0, value, \
   NULL, help}
#define ENERGY(name, unit, effects, value, help) \
  {name, unit, INC, PRINT_ENERGY, effects, ANY, name, 0, value, NULL, help}
static const column increment_columns[] = {
COUNT("step", PRINT_ENERGY, 0, step_no, "number of the step"),
COUNT("increment", PRINT_ENERGY, 0, increment_no, "increment within the step"),
COUNT("total", 0, 0, total_no, "increments since the start"),
COUNT("attempt", 0, 0, attempt, "1: the increment was not cut"),
ENERGY("time", "time", 0, time_now, "end of the increment"),
{"dt", "time", INC, 0, 0, ANY, "dt", 0, time_step, NULL, "time step"},
COUNT("settled", 0, 0, settled, "1: the increment reached its tolerance"),
COUNT("open", 0, C, n_open, "open nodes"),
COUNT("slip", 0, C, n_slip, "slipping nodes"),
COUNT("stick", 0, C, n_stick, "sticking nodes"),
COUNT("iterations", 0, C, iterations, "iterations of the contact solver"),
OF_EFFECTS(1),
{"residual", "-", INC, 0, C, ANY, "residual", 0, residual, NULL,
 "residual of the contact problem"},
OF_EFFECTS(0),
OF_EFFECTS(2),
ENERGY("strain_energy", J, 0, strain_energy, "elastic energy stored"),
ENERGY("external_work", J, 0, external_work,
       "work of loads and supports so far"),
OF_EFFECTS(3),
ENERGY("normal_work", J, C, normal_work,
       "work of the normal contact forces so far, trapezoidal: "
       "moving obstacles, and gaps that open or close within an increment"),
OF_EFFECTS(4),
OF_EFFECTS(5),
ENERGY("energy_defect", J, 0, energy_defect,
       "external + normal - friction - thermal - inelastic work - strain"),
ENERGY("energy_defect_relative", "-", 0, defect_relative,
       "the defect over the largest of the energies so far"),
NO_COLUMN};
/* clang-format on */

extern const column node_columns[], element_columns[], contact_node_columns[],
    contact_columns[];
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
  if (e != NULL && (e->on.create != NULL || e->size > 0) && !e->of_state &&
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

const char *column_unit(const char *unit, const model *m) {
  const char *const words[] = {"length", "force", "time"};
  const char *const labels[] = {m->unit.length, m->unit.force, m->unit.time};
  enum { LABEL = 80 };
  char *text = text_room();
  size_t used = 0;
  text[0] = '\0';
  while (*unit != '\0' && used + 1 < LABEL) {
    int k = 0;
    while (k < 3 && strncmp(unit, words[k], strlen(words[k])) != 0) ++k;
    int known = k < 3 && labels[k] != NULL;
    int n = known ? snprintf(text + used, LABEL - used, "%s", labels[k])
                  : snprintf(text + used, LABEL - used, "%c", *unit);
    unit += known ? strlen(words[k]) : 1;
    used += (size_t)n;
  }
  return text;
}

enum { COLUMNS = sizeof((table *)0)->col / sizeof(column *) };

static int larger(int a, int b) { return a > b ? a : b; }

static void cell_name(const column *c, const model *m, char *text,
                      size_t size) {
  snprintf(text, size, "%s[%s]", c->name, column_unit(c->unit, m));
}

/* Sign, point, E and three digits of the exponent: digits + 8. */
static int cell_width(const column *c, const model *m, int digits) {
  char name[160];
  cell_name(c, m, name, sizeof name);
  int width = c->form == AS_REAL ? digits + 8 : 11;
  return larger(width, (int)strlen(name)) + 1;
}

void table_choose(table *t, entity of, unsigned print_bit, const view *v,
                  int digits) {
  t->n = 0;
  t->of = of;
  t->digits = digits;
  const column *c;
  for (column_walk w = columns_of(of);
       (c = column_next(&w)) != NULL && c->of == of;) {
    if ((c->tables & print_bit) == 0) continue;
    if (!column_visible(c, v->m) || !column_ready(c, v->s)) continue;
    if (t->n == COLUMNS) break;
    t->width[t->n] = cell_width(c, v->m, digits);
    t->col[t->n++] = c;
  }
}

void table_header(const table *t, const model *m, const char *lead, FILE *f) {
  fputs(lead, f);
  for (int k = 0; k < t->n; ++k) {
    char name[160];
    cell_name(t->col[k], m, name, sizeof name);
    text_cell(f, name, t->width[k]);
  }
  fputc('\n', f);
}

static void row_cell(const table *t, int k, const view *v, int id, FILE *f) {
  const column *c = t->col[k];
  char word[160];
  if (c->form == AS_WORD) {
    text_word(word, sizeof word, c->word(v, id));
    text_cell(f, word, t->width[k]);
    return;
  }
  double value = c->value(v, id, c->part);
  if (c->form == AS_COUNT) snprintf(word, sizeof word, "%.0f", value);
  text_cell(f, c->form == AS_COUNT ? word : text_number(value, t->digits),
            t->width[k]);
}

void table_row(const table *t, const view *v, int id, FILE *f) {
  fputc(' ', f);
  for (int k = 0; k < t->n; ++k) row_cell(t, k, v, id, f);
  fputc('\n', f);
}
