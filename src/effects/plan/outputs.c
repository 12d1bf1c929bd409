/*
 * Tables, fields and files: the cards that require them, their expected work.
 */
#include "effects/plan/plan.h"
#include "effects/rows.h"

#include <math.h>

static const double TEXT = 250.0; /* operations to write a number */

double plan_rows(const plan_sizes *s, int table, double items) {
  double most = 0.0;
  for (int i = 0; i < s->m->n.step && s->msh != NULL; ++i)
    for (int k = 0; k < s->m->steps[i].print.n; ++k) {
      const print_request *p = &s->m->steps[i].print.requests[k];
      if (p->table != table) continue;
      if (p->group_id < 0) return items;
      const mesh_group *g = &s->msh->group[p->group_id];
      most = fmax(most, table == PRINT_ELEMENTS ? g->n_item : g->n_node);
    }
  return most > 0.0 ? fmin(items, most) : items;
}

effect_work plan_table(const plan_sizes *s, int table, double all) {
  double n = plan_rows(s, table, all), shown = plan_shown(s->m, table);
  return (effect_work){n, "rows", shown, shown * n * 10.0 * TEXT};
}

int plan_requires_table(const model *m, int table, char *why, size_t size) {
  for (int i = 0; i < m->n.step; ++i)
    for (int q = 0; q < m->steps[i].print.n; ++q) {
      const print_request *p = &m->steps[i].print.requests[q];
      if (p->table != table) continue;
      snprintf(why, size, "*PRINT, %s, %s:%d", print_word(table), PLACE(p->at));
      return 1;
    }
  snprintf(why, size, "no *PRINT, %s", print_word(table));
  return 0;
}

static status held_rows(const plan_sizes *s, effect_work *w) {
  double unknowns, nodes = 0.0;
  status st = s->msh == NULL ? OK : plan_held(s, &unknowns, &nodes);
  *w = plan_table(s, PRINT_REACTIONS, nodes);
  return st;
}

#define TABLE_ROWS(name, bit, all)                                 \
  static status name##_rows(const plan_sizes *s, effect_work *w) { \
    *w = plan_table(s, bit, all);                                  \
    return OK;                                                     \
  }
TABLE_ROWS(contact, PRINT_CONTACT, s->contact)
TABLE_ROWS(totals, PRINT_TOTALS, s->m->n.contact)
TABLE_ROWS(nodes, PRINT_NODES, s->nodes)
TABLE_ROWS(elements, PRINT_ELEMENTS, s->elements)
TABLE_ROWS(energy, PRINT_ENERGY, 1.0)

#define TABLE(row, text, bit_, of_, rows_)                            \
  static int requires_##row(const model *m, char *why, size_t size) { \
    return plan_requires_table(m, bit_, why, size);                   \
  }                                                                   \
  const effect_ops row##_effect = {.name = text,                      \
                                   .bit = NO_BIT,                     \
                                   .required = requires_##row,        \
                                   .expected = rows_,                 \
                                   .table = {bit_, of_}};
TABLE(contact_table, "table of contact nodes", PRINT_CONTACT, PER_CONTACT_NODE,
      contact_rows)
TABLE(totals_table, "table of resultants", PRINT_TOTALS, PER_CONTACT,
      totals_rows)
TABLE(nodes_table, "table of nodes", PRINT_NODES, PER_NODE, nodes_rows)
TABLE(elements_table, "table of elements", PRINT_ELEMENTS, PER_ELEMENT,
      elements_rows)
TABLE(energy_table, "table of energies", PRINT_ENERGY, PER_INCREMENT,
      energy_rows)
TABLE(reactions_table, "table of reactions", PRINT_REACTIONS, PER_NODE,
      held_rows)

static int requires_fields(const model *m, char *why, size_t size) {
  for (int i = 0; i < m->n.step; ++i) {
    const step *s = &m->steps[i];
    if (s->output.frequency < 0) continue;
    if (s->output.given)
      snprintf(why, size, "*OUTPUT, %s:%d", PLACE(s->output.at));
    else
      snprintf(why, size, "default; *OUTPUT, HDF5=NO leaves them out");
    return 1;
  }
  snprintf(why, size, "*OUTPUT, HDF5=NO");
  return 0;
}

static int requires_condensed(const model *m, char *why, size_t size) {
  for (int i = 0; i < m->n.step; ++i) {
    const step *s = &m->steps[i];
    if (s->output.condensed < 0) continue;
    snprintf(why, size, "*OUTPUT, CONDENSED=FCLIB, %s:%d", PLACE(s->output.at));
    return 1;
  }
  snprintf(why, size, "no *OUTPUT, CONDENSED=FCLIB");
  return 0;
}

static int requires_restart(const model *m, char *why, size_t size) {
  for (int i = 0; i < m->n.step; ++i) {
    const step *s = &m->steps[i];
    if (s->restart.frequency < 0) continue;
    snprintf(why, size, "*RESTART, %s:%d", PLACE(s->restart.at));
    return 1;
  }
  snprintf(why, size, "no *RESTART card");
  return 0;
}

static int requires_always(const model *m, char *why, size_t size) {
  (void)m;
  snprintf(why, size, "always");
  return 1;
}

static status fields(const plan_sizes *s, effect_work *w) {
  *w = (effect_work){s->nodes, "nodes", -1.0,
                     4e6 + s->shown * (4e5 + 20.0 * s->nodes)};
  return OK;
}

static status condensed_problems(const plan_sizes *s, effect_work *w) {
  double m = plan_contact_unknowns(s);
  *w = (effect_work){s->contact, "nodes", -1.0,
                     s->increments * (1e6 + 3.0 * m * m)};
  return OK;
}

static status restart(const plan_sizes *s, effect_work *w) {
  *w = (effect_work){s->nodes, "nodes", -1.0,
                     s->increments * (1e6 + 50.0 * s->nodes)};
  return OK;
}

static status listing(const plan_sizes *s, effect_work *w) {
  *w = (effect_work){1.0, NULL, -1.0, 2e5 + s->increments * 60.0 * TEXT};
  return OK;
}

/* clang-format off */
/* clang-format off */
const effect_ops fields_effect = {
  .name = "fields in JOB.h5", .bit = NO_BIT, .required = requires_fields,
  .expected = fields, .own = STAGE_HDF5};

const effect_ops condensed_problems_effect = {
  .name = "condensed problems", .bit = NO_BIT, .required = requires_condensed,
  .expected = condensed_problems, .own = STAGE_FCLIB};

const effect_ops restart_effect = {
  .name = "restart", .bit = NO_BIT, .required = requires_restart,
  .expected = restart, .own = STAGE_RESTART};

const effect_ops listing_effect = {
  .name = "listing, .sta, .cvg", .bit = NO_BIT, .required = requires_always,
  .expected = listing, .own = STAGE_LISTING};
/* clang-format on */
