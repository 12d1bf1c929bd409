/*
 * *REFERENCE: the components of a closed form. *GOAL: a quantity whose error is
 * wanted.
 */
#include "base/base.h"
#include "model/cards/cards.h"

static const struct {
  const char *name;
  int plane, axisymmetric, solid; /* place in "value"; -1: none */
} components[] = {{"u_x", 0, -1, 0},        {"u_y", 1, -1, 1},
                  {"u_r", -1, 0, -1},       {"u_z", -1, 1, 2},
                  {"stress_xx", 3, -1, 3},  {"stress_yy", 4, -1, 4},
                  {"stress_zz", 5, 4, 5},   {"stress_xy", 6, -1, 6},
                  {"stress_yz", -1, -1, 7}, {"stress_zx", -1, -1, 8},
                  {"stress_rr", -1, 3, -1}, {"stress_tt", -1, 5, -1},
                  {"stress_rz", -1, 6, -1}, {"pressure", 9, 9, 9}};

enum { N_COMPONENT = sizeof components / sizeof *components };

int reference_place(const char *name, int dim, int axisymmetric) {
  const int i = rank_of_name(NAMES(components, N_COMPONENT), name);
  if (i < 0 || dim == 3) return i < 0 ? -1 : components[i].solid;
  return axisymmetric ? components[i].axisymmetric : components[i].plane;
}

status apply_reference(reading *r) {
  closed_form *ref = &r->m->accuracy.ref;
  message_log *log = r->m->log;
  if (ref->n > 0)
    message_add(log, P2011, &r->card->at,
                "a deck has one *REFERENCE, the first is in line %d",
                ref->at.line_no);
  ref->at = r->card->at;
  for (EACH(const record, line, r->card->records, r->card->n_record)) {
    const field *f = line->fields;
    quantity value = {0};
    if (record_fields(r, line, 2, 2, "name, value") != 0) continue;
    if (rank_of_name(NAMES(components, N_COMPONENT), f[0].text) < 0) {
      unknown_word(log, P2012, &f[0].at, "*REFERENCE: there is no component ",
                   f[0].text, candidate_name, NAMES(components, N_COMPONENT));
      continue;
    }
    if (field_quantity(r, &f[1], &value) != 0) continue;
    for (int k = 0; k < ref->n; ++k)
      if (same_word(ref->line[k].name, f[0].text))
        message_add(log, P2011, &f[0].at, "%s is given twice", f[0].text);
    if (ref->n < REFERENCE_SIZE)
      ref->line[ref->n++] = (reference_line){f[0].text, value, f[0].at};
  }
  return OK;
}

/* What a quantity takes, as bits. */
enum {
  ON_CONTACT = 1,
  IN_GROUP = 2,
  AT_POINT = 4,
  HAS_RADIUS = 8,
  FROM = 16,        /* a difference */
  NEEDS_POINT = 32, /* with AT_POINT */
  ON_CRACK = 64
};
static const struct {
  const char *word;
  int takes, least, most; /* components, from 0; most < 0: none */
} quantities[] = {
    [GOAL_FORCE] = {"FORCE", ON_CONTACT, 0, GOAL_TANGENT},
    [GOAL_PRESSURE] = {"PRESSURE", ON_CONTACT | AT_POINT | HAS_RADIUS, 0, -1},
    [GOAL_WIDTH] = {"WIDTH", ON_CONTACT, 0, -1},
    [GOAL_DISPLACEMENT] = {"DISPLACEMENT", IN_GROUP | AT_POINT | FROM, 0, 2},
    [GOAL_STRESS] = {"STRESS", IN_GROUP, GOAL_TENSOR, GOAL_TENSOR + 5},
    [GOAL_ENERGY] = {"ENERGY", 0, 0, -1},
    [GOAL_FRICTION] = {"FRICTION WORK", 0, 0, -1},
    [GOAL_MOMENT] = {"MOMENT", ON_CONTACT | AT_POINT | NEEDS_POINT, 0, 2},
    [GOAL_SIF] = {"SIF", ON_CRACK | AT_POINT, 0, 2}};

static int is_given(const reading *r, const char *name) {
  return card_parameter(r->card, name) != NULL;
}

/* A parameter that the quantity takes and lacks, or does not take. */
static void check_parameter(const reading *r, const goal_card *g,
                            const char *name, int takes, int needs) {
  const char *word = quantities[g->quantity].word;
  if (needs && !is_given(r, name))
    message_add(r->m->log, P2007, &r->card->at,
                "*GOAL, QUANTITY=%s needs %s=", word, name);
  if (!takes && is_given(r, name))
    message_add(r->m->log, P2037, value_place(r, name),
                "*GOAL: %s= has no effect with QUANTITY=%s", name, word);
}

static void check_component(const reading *r, goal_card *g) {
  const int least = quantities[g->quantity].least;
  const int most = quantities[g->quantity].most;
  check_parameter(
      r, g, "COMPONENT", most >= 0,
      most >= 0 && g->quantity != GOAL_FORCE && g->quantity != GOAL_MOMENT);
  if (!is_given(r, "COMPONENT")) {
    g->component = GOAL_NORMAL;
    return;
  }
  if (most >= 0 && (g->component < least || g->component > most))
    message_add(r->m->log, P2010, value_place(r, "COMPONENT"),
                "*GOAL, QUANTITY=%s has no such component",
                quantities[g->quantity].word);
}

/* Line k of the card, a point. */
static void read_point(const reading *r, int k, goal_card *g) {
  const record *line = &r->card->records[k];
  const int takes = quantities[g->quantity].takes;
  g->point_at[k] = line->at;
  if (!(takes & AT_POINT))
    message_add(r->m->log, P2037, &line->at,
                "*GOAL: a point counts with PRESSURE, DISPLACEMENT, MOMENT and "
                "SIF only");
  else if (k > 0 && !(takes & FROM))
    message_add(r->m->log, P2037, &line->at,
                "*GOAL: a second point counts with DISPLACEMENT only");
  if (record_fields(r, line, 2, 3, "x, y[, z]") != 0) return;
  for (int c = 0; c < line->n_field; ++c)
    if (field_real(r, &line->fields[c], -DBL_MAX, "a coordinate",
                   &g->point[k][c]) != 0)
      return;
}

static void read_points(const reading *r, goal_card *g) {
  const int needs = quantities[g->quantity].takes & NEEDS_POINT;
  const int n = r->card->n_record;
  g->n_point = n < 2 ? n : 2;
  for (int k = 0; k < g->n_point; ++k) read_point(r, k, g);
  if (needs && n == 0)
    message_add(r->m->log, P2007, &r->card->at,
                "*GOAL, QUANTITY=%s needs a line with a point",
                quantities[g->quantity].word);
}

/* A number with % or one in the unit of the goal. */
static void read_target(const reading *r, const char *text, goal_card *g) {
  static const option row =
      OPTION_REAL(goal_card, target, "TARGET", DBL_MIN, DBL_MAX, NULL, "%", "");
  char why[200];
  if (text == NULL) return;
  g->in_percent = text[strlen(text) - 1] == '%';
  if (option_read(&row, text, g, why, sizeof why) != 0)
    message_add(r->m->log, P2004, value_place(r, "TARGET"), "*GOAL, TARGET: %s",
                why);
}

static int find_crack(const reading *r, const char *name) {
  const name_list *names = NAMES(r->m->mesh.cracks, r->m->n.crack);
  const int i = rank_of_name(names, name);
  if (i >= 0) return i;
  unknown_word(r->m->log, P2012, value_place(r, "CRACK"),
               "*GOAL: before this card there is no *CRACK, NAME=", name,
               candidate_name, names);
  return -1;
}

status apply_goal(reading *r) {
  const card_options *p = r->param;
  model *m = r->m;
  if (r->misread || p->name == NULL || !is_given(r, "QUANTITY")) return OK;
  for (int i = 0; i < m->n.goal; ++i)
    shown_name_taken(r, p->name, m->accuracy.goals[i].name);
  ADDED(goal_card, g, m->accuracy.goals, m->n.goal, m->cap.goal);
  *g = (goal_card){.name = p->name,
                   .quantity = (goal_quantity)p->goal.quantity,
                   .contact_id = -1,
                   .crack_id = -1,
                   .group = p->group,
                   .group_id = -1,
                   .node_id = -1,
                   .from = p->goal.from,
                   .from_id = -1,
                   .from_node_id = -1,
                   .component = p->goal.component,
                   .radius = p->radius,
                   .at = r->card->at,
                   .group_at = *value_place(r, "GROUP"),
                   .from_at = *value_place(r, "FROM")};
  const int takes = quantities[g->quantity].takes;
  read_points(r, g);
  read_target(r, p->goal.target, g);
  m->accuracy.goal_products |= g->target > 0.0;
  check_parameter(r, g, "CONTACT", takes & ON_CONTACT, takes & ON_CONTACT);
  check_parameter(r, g, "CRACK", takes & ON_CRACK, takes & ON_CRACK);
  check_parameter(r, g, "GROUP", takes & IN_GROUP,
                  (takes & IN_GROUP) && !(takes & AT_POINT && g->n_point > 0));
  check_parameter(r, g, "FROM", takes & FROM, 0);
  check_parameter(r, g, "RADIUS", takes & HAS_RADIUS, 0);
  check_component(r, g);
  if (p->contact != NULL) g->contact_id = find_contact(r, p->contact);
  if (p->goal.crack != NULL) g->crack_id = find_crack(r, p->goal.crack);
  return OK;
}
