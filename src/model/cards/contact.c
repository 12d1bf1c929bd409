/* Cards of the contact: rigid obstacles, contact pairs, friction laws. */
#include "model/cards/cards.h"

#include "base/base.h"

static int read_point(const reading *r, const record *line, const char *what,
                      double x[3]) {
  if (record_fields(r, line, 2, 3, what) != 0) return -1;
  for (int c = 0; c < line->n_field; ++c)
    if (deck_real(&line->fields[c], r->m->log, &x[c]) != 0) return -1;
  return 0;
}

/* Make a direction of any length, read from "line", a unit vector. */
static int normalise(const reading *r, const record *line, const char *what,
                     double d[3]) {
  double largest = fmax(fabs(d[0]), fmax(fabs(d[1]), fabs(d[2])));
  if (largest == 0.0) {
    message_add(r->m->log, P2027, &line->at, "*%s: the %s is zero",
                r->card->name, what);
    return -1;
  }
  for (int c = 0; c < 3; ++c) d[c] /= largest;
  double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  for (int c = 0; c < 3; ++c) d[c] /= length;
  return 0;
}

/* A component of MOVE or the angle of ROTATE. */
static int read_course(const reading *r, const record *line, int k,
                       quantity *q) {
  const field *f = &line->fields[k];
  if (field_quantity(r, f, q) != 0) return -1;
  if ((quantity_variables(q) & 7u) == 0) return 0;
  message_add(r->m->log, P2033, &f->at,
              "%s may depend on t only: the obstacle is rigid",
              same_word(line->fields[0].text, "MOVE") ? "MOVE" : "ROTATE");
  return -1;
}

/* MOVE, dx, dy[, dz] */
static int read_move(const reading *r, const record *line, obstacle *o) {
  if (record_fields(r, line, 3, 4, "MOVE, dx, dy [, dz]") != 0) return -1;
  for (int c = 1; c < line->n_field; ++c)
    if (read_course(r, line, c, &o->motion[c - 1]) != 0) return -1;
  return 0;
}

/* Point and direction from the second field on: x, y (along z) or x, y, z, ax,
 * ay, az. */
static int read_axis(const reading *r, const record *line, int solid,
                     double *point, double *axis) {
  const char *what = same_word(line->fields[0].text, "AXIS")
                         ? "direction of the axis of the torque"
                         : "direction of the axis of ROTATE";
  for (int c = 0; c < (solid ? 3 : 2); ++c) {
    const field *f = &line->fields[1 + c];
    if (deck_real(f, r->m->log, &point[c]) != 0) return -1;
    if (solid && deck_real(f + 3, r->m->log, &axis[c]) != 0) return -1;
  }
  if (!solid) axis[2] = 1.0;
  return normalise(r, line, what, axis);
}

/* ROTATE, x, y, angle: about an axis along z; ROTATE, x, y, z, ax, ay, az,
 * angle: point and direction of the axis. */
static int read_rotate(const reading *r, const record *line, obstacle *o) {
  int n = line->n_field, solid = n == 8;
  if (n != 4 && n != 8) {
    message_add(r->m->log, P2009, &line->at,
                "%d field%s on this line of *OBSTACLE; expected: ROTATE, x, y, "
                "angle or ROTATE, x, y, z, ax, ay, az, angle",
                n, n == 1 ? "" : "s");
    return -1;
  }
  if (read_axis(r, line, solid, o->pivot, o->axis) != 0) return -1;
  o->turns = 1;
  return read_course(r, line, n - 1, &o->angle);
}

static int starts_with(const record *line, const char *word) {
  return line->n_field > 0 && same_word(line->fields[0].text, word);
}

/* MOVE and ROTATE close the lines of the obstacle in any order. Returns the
 * number of lines before them, -1 after an error. */
static int read_course_lines(const reading *r, struct move *m, obstacle *o) {
  const card *c = r->card;
  int n = c->n_record, moves = 0;
  for (; n > 0; --n) {
    const record *line = &c->records[n - 1];
    int shifts = starts_with(line, "MOVE");
    if (!shifts && !starts_with(line, "ROTATE")) break;
    if (shifts ? moves++ > 0 : o->turns) {
      message_add(r->m->log, P2008, &line->at, "*OBSTACLE has two lines %s",
                  shifts ? "MOVE" : "ROTATE");
      return -1;
    }
    if (shifts) m->move_at = line->at;
    if (!shifts) m->rotate_at = line->at;
    if ((shifts ? read_move(r, line, o) : read_rotate(r, line, o)) != 0)
      return -1;
  }
  return n;
}

/* The lines before MOVE and ROTATE, as the shape requires them. */
static void read_shape(const reading *r, int n_line, obstacle *o) {
  const record *line = r->card->records;
  static const char *const wanted[] = {
      "no geometry lines",
      "a line with a point, then one with the normal towards the body",
      "a line with a point of the axis, then in 3-D one with its direction",
      "a line with the centre",
      "the gap: a number or an expression of x y z t"};
  static const int least[] = {0, 2, 1, 1, 1}, most[] = {0, 2, 2, 1, 1};
  if (n_line < least[o->shape] || n_line > most[o->shape]) {
    message_add(r->m->log, n_line < least[o->shape] ? P2007 : P2008,
                n_line > 0 ? &line[n_line - 1].at : &r->card->at,
                "*OBSTACLE: this type needs: %s", wanted[o->shape]);
    return;
  }
  switch ((obstacle_shape)o->shape) {
    case OBSTACLE_CONFORMING:
      break;
    case OBSTACLE_PLANE:
    case OBSTACLE_CYLINDER:
    case OBSTACLE_SPHERE:
      if (read_point(r, &line[0], "x, y [, z]", o->point) != 0) return;
      if (n_line == 2 &&
          read_point(r, &line[1], "nx, ny [, nz]", o->direction) == 0)
        normalise(r, &line[1], "direction", o->direction);
      break;
    case OBSTACLE_GAP:
      if (record_fields(r, &line[0], 1, 1, wanted[o->shape]) == 0)
        field_quantity(r, &line[0].fields[0], &o->gap);
      break;
  }
}

/* Parameters of a cylinder or a sphere only. */
static void check_round(const reading *r, const card_options *p) {
  message_log *log = r->m->log;
  const parameter *radius = card_parameter(r->card, "RADIUS");
  int round = p->type == OBSTACLE_CYLINDER || p->type == OBSTACLE_SPHERE;
  if (r->misread) return;
  if (round && radius == NULL)
    message_add(log, P2005, &r->card->at,
                "*OBSTACLE: this type needs the parameter RADIUS=");
  if (!round && radius != NULL)
    message_add(log, P2004, &radius->at,
                "*OBSTACLE: RADIUS= belongs to CYLINDER and SPHERE only");
  if (!round && p->surface.side)
    message_add(log, P2004, value_place(r, "SIDE"),
                "*OBSTACLE: SIDE=INSIDE belongs to CYLINDER and SPHERE only");
}

status apply_obstacle(reading *r) {
  const card_options *p = r->param;
  model *m = r->m;
  const card *c = r->card;
  for (int i = 0; i < m->n.obstacle; ++i)
    name_taken(r, p->name, m->obstacles[i].name);
  int n = m->n.obstacle, capacity = m->cap.obstacle;
  PASS_GROW(m->moves, n, capacity);
  PASS_GROW(m->obstacles, n, m->cap.obstacle);
  obstacle *o = &m->obstacles[m->n.obstacle++];
  o->name = p->name == NULL ? "" : p->name;
  o->shape = p->type;
  o->inside = p->surface.side;
  o->radius = p->radius;
  m->moves[n].amplitude_name = p->amplitude;
  m->moves[n].at = c->at;
  m->moves[n].move_at = c->at;
  m->moves[n].rotate_at = c->at;
  m->moves[n].amplitude_at = *value_place(r, "AMPLITUDE");
  check_round(r, p);
  if (r->misread && card_parameter(c, "TYPE") == NULL) return OK;
  int lines = read_course_lines(r, &m->moves[n], o);
  if (lines < 0) return OK;
  if (lines == c->n_record && p->amplitude != NULL)
    message_add(m->log, P2007, &c->at,
                "*OBSTACLE: AMPLITUDE= needs a line MOVE, dx, dy [, dz] or "
                "ROTATE");
  /* A point or direction of two numbers: not enough in 3-D. */
  move *of = &r->m->moves[o - r->m->obstacles];
  for (int i = 0; i < lines && o->shape != OBSTACLE_GAP; ++i)
    if (r->card->records[i].n_field == 2 && of->short_at.file == NULL)
      of->short_at = r->card->records[i].at;
  read_shape(r, lines, o);
  return OK;
}

/* AXIS, x, y or AXIS, x, y, z, ax, ay, az */
static void read_torque_axis(const reading *r, const record *line, contact *c) {
  int n = line->n_field;
  if (!starts_with(line, "AXIS") || (n != 3 && n != 7)) {
    message_add(r->m->log, P2009, &line->at,
                "this line of *%s is not: AXIS, x, y or AXIS, x, y, z, ax, ay, "
                "az",
                r->card->name);
    return;
  }
  c->axis_at = line->at;
  c->has_axis = read_axis(r, line, n == 7, c->axis_point, c->axis) == 0;
}

/* The next contact, with its name. */
static status new_contact(const reading *r, const char *name, contact **out) {
  model *m = r->m;
  for (int i = 0; i < m->n.contact; ++i)
    shown_name_taken(r, name, m->contacts[i].name);
  ADDED(contact, c, m->contacts, m->n.contact, m->cap.contact);
  c->name = name == NULL ? "" : name;
  c->at = r->card->at;
  c->obstacle_id = c->group_id = -1;
  *out = c;
  return OK;
}

status apply_contact(reading *r) {
  const card_options *p = r->param;
  contact *c = NULL;
  PASS(new_contact(r, p->name, &c));
  c->group = p->group == NULL ? "" : p->group;
  c->obstacle_name = p->surface.obstacle == NULL ? "" : p->surface.obstacle;
  c->group_at = *value_place(r, "GROUP");
  c->obstacle_at = *value_place(r, "OBSTACLE");
  c->obstacle_normal =
      card_parameter(r->card, "NORMAL") == NULL ? -1 : p->surface.normal;
  if (r->card->n_record > 0) read_torque_axis(r, r->card->records, c);
  return OK;
}

/* ---- two surfaces of the mesh ------------------------------------------- */

/* The line with the two surfaces. */
static void read_surfaces(const reading *r, int choice, int adjust,
                          surface_pair *p) {
  const record *line = r->card->records;
  *p = (surface_pair){.group = {"", ""},
                      .choice = choice,
                      .adjust = adjust,
                      .slave_id = -1,
                      .master_id = -1};
  p->group_at[0] = p->group_at[1] = r->card->at;
  if (r->card->n_record == 0 ||
      record_fields(r, line, 2, 2, "surface, surface") != 0)
    return;
  for (int k = 0; k < 2; ++k) {
    p->group[k] = line->fields[k].text;
    p->group_at[k] = line->fields[k].at;
  }
}

/* CLEARANCE, value or INTERFERENCE, value */
static void read_change(const reading *r, const record *line, gap_change *c) {
  const int interferes = starts_with(line, "INTERFERENCE");
  if (c->given) {
    message_add(r->m->log, P2008, &line->at,
                "*CONTACT PAIR has two lines CLEARANCE or INTERFERENCE");
    return;
  }
  if (record_fields(r, line, 2, 2, "CLEARANCE or INTERFERENCE, value") != 0 ||
      field_quantity(r, &line->fields[1], &c->value) != 0)
    return;
  c->given = 1;
  c->interferes = interferes;
  c->at = line->fields[1].at;
}

static void read_lines(const reading *r, contact *c) {
  for (int i = 1; i < r->card->n_record; ++i) {
    const record *line = &r->card->records[i];
    if (starts_with(line, "CLEARANCE") || starts_with(line, "INTERFERENCE"))
      read_change(r, line, &c->change);
    else if (starts_with(line, "AXIS"))
      read_torque_axis(r, line, c);
    else
      message_add(r->m->log, P2009, &line->at,
                  "this line of *CONTACT PAIR is not CLEARANCE, INTERFERENCE "
                  "or AXIS");
  }
}

status apply_contact_pair(reading *r) {
  const card_options *p = r->param;
  contact *c = NULL;
  PASS(new_contact(r, p->name, &c));
  c->is_pair = 1;
  c->slave_normal = p->surface.normal;
  c->update = p->surface.update;
  read_surfaces(r, p->surface.slave, p->surface.adjust, &c->pair);
  c->group = c->pair.group[0];
  c->group_at = c->pair.group_at[0];
  c->obstacle_name = c->pair.group[1];
  c->obstacle_at = c->pair.group_at[1];
  c->change.amplitude_name = p->amplitude;
  c->change.amplitude_at = *value_place(r, "AMPLITUDE");
  read_lines(r, c);
  if (p->amplitude != NULL && !c->change.given)
    message_add(r->m->log, P2007, &c->at,
                "*CONTACT PAIR: AMPLITUDE= needs a line CLEARANCE or "
                "INTERFERENCE");
  return OK;
}

status apply_tie(reading *r) {
  const card_options *p = r->param;
  model *m = r->m;
  for (int i = 0; i < m->n.tie; ++i) name_taken(r, p->name, m->ties[i].name);
  ADDED(tie, t, m->ties, m->n.tie, m->cap.tie);
  t->name = p->name == NULL ? "" : p->name;
  t->at = r->card->at;
  read_surfaces(r, p->surface.slave, p->surface.adjust, &t->pair);
  return OK;
}

/* The name of the group of a lip; NULL without memory. */
static char *lip_name(const char *group, char sign) {
  const size_t n = strlen(group);
  char *name = memory_new(n + 2, 1);
  if (name == NULL) return NULL;
  memcpy(name, group, n);
  name[n] = sign;
  return name;
}

status apply_crack(reading *r) {
  const card_options *p = r->param;
  model *m = r->m;
  contact *c = NULL;
  PASS(new_contact(r, p->name, &c));
  ADDED(crack, k, m->mesh.cracks, m->n.crack, m->cap.crack);
  k->name = c->name;
  k->group = p->group == NULL ? "" : p->group;
  k->at = c->at;
  k->group_at = *value_place(r, "GROUP");
  k->contact_id = m->n.contact - 1;
  PASS_GET(k->lip[0], lip_name(k->group, '-'));
  PASS_GET(k->lip[1], lip_name(k->group, '+'));
  c->is_pair = c->is_crack = 1;
  c->pair = (surface_pair){.slave_id = -1, .master_id = -1};
  for (int i = 0; i < 2; ++i) {
    c->pair.group[i] = k->group[0] == '\0' ? "" : k->lip[i];
    c->pair.group_at[i] = k->group_at;
  }
  c->group = c->pair.group[0];
  c->obstacle_name = c->pair.group[1];
  c->group_at = c->obstacle_at = k->group_at;
  return OK;
}

/* ---- what a contact has -------------------------------------------------- */

plugin names_law(const reading *r) {
  const card_options *p = r->param;
  const parameter *law = card_parameter(r->card, "LAW");
  plugin none = {NULL, 0, "LAW", NULL};
  if (p->law == NULL || law == NULL) return none;
  const friction_ops *ops = friction_find(p->law);
  if (ops != NULL)
    return (plugin){ops->options, ops->param_size, "LAW", ops->name};
  unknown_word(r->m->log, P2012, &law->value.at,
               "*FRICTION: there is no LAW=", p->law, candidate_name,
               LISTED(friction_list));
  return none;
}

int find_contact(const reading *r, const char *name) {
  const name_list *names = NAMES(r->m->contacts, r->m->n.contact);
  const int i = rank_of_name(names, name);
  if (i >= 0 || (r->is_lost != NULL && r->is_lost(r->m, name))) return i;
  unknown_word(r->m->log, P2012, value_place(r, "CONTACT"),
               text_of("*%s: before this card there is no *CONTACT, NAME=",
                       r->card->name),
               name, candidate_name, names);
  return -1;
}

/* The value lines: one quantity, or pairs with TABLE=. Not negative. */
static status read_value(reading *r, const char *what, int variable,
                         quantity *q, value_table *pairs) {
  const card *c = r->card;
  const record *line = c->records;
  if (card_parameter(c, "TABLE") != NULL) {
    if (c->n_record == 0)
      message_add(r->m->log, P2007, &c->at, "*%s, TABLE= needs lines of pairs",
                  c->name);
    PASS(read_pairs(r, variable, pairs));
    /* Values of a table that must not be negative. */
    for (int i = 0; i < pairs->n; ++i)
      if (!(pairs->value[i] >= 0.0))
        message_add(r->m->log, P2010, &pair_field(r->card, i, 1)->at,
                    "*%s: %s = %.15g in the table is negative", r->card->name,
                    what, pairs->value[i]);
    q->number = 1.0;
    q->factor = pairs; /* set again by model_resolve */
    return OK;
  }
  if (c->n_record != 1) {
    int none = c->n_record < 1;
    message_add(r->m->log, none ? P2007 : P2008, none ? &c->at : &line[1].at,
                "*%s needs one line with %s", c->name, what);
    return OK;
  }
  if (record_fields(r, line, 1, 1, what) != 0) return OK;
  if (field_quantity(r, &line->fields[0], q) != 0) return OK;
  if (q->formula == NULL && !(q->number >= 0.0))
    message_add(r->m->log, P2010, &line->fields[0].at,
                "*%s: %s = %s is negative", c->name, what,
                line->fields[0].text);
  return OK;
}

/* The rule a *FRICTION card fills: of the contact, or of the step for it; NULL
 * after a message. */
static status new_rule(const reading *r, int contact_id, friction_rule **out) {
  contact *c = &r->m->contacts[contact_id];
  friction_rule *rule = &c->friction;
  const friction_rule *old = rule->law == NULL ? NULL : rule;
  if (r->in_step) {
    step *s = &r->m->steps[r->m->n.step - 1];
    old = NULL;
    for (int k = 0; k < s->friction.n; ++k)
      if (s->friction.changes[k].contact_id == contact_id)
        old = &s->friction.changes[k].rule;
    PASS_GROW(s->friction.changes, s->friction.n, s->friction.cap);
    rule = &s->friction.changes[s->friction.n].rule;
    s->friction.changes[s->friction.n].contact_id = contact_id;
    s->friction.n += old == NULL;
  }
  *out = old == NULL ? rule : NULL;
  if (old != NULL)
    message_add(r->m->log, P2032, &r->card->at,
                "contact %s has its *FRICTION already, at line %d", c->name,
                old->at.line_no);
  return OK;
}

static status copy_options(const reading *r, const friction_ops *law,
                           const void **out) {
  if (law->param_size == 0) return OK;
  void *param = memory_new(1, law->param_size);
  if (param == NULL) RAISE(ERR_MEMORY, "memory exhausted: friction options");
  memcpy(param, r->plugin, law->param_size);
  *out = param;
  return OK;
}

status apply_friction(reading *r) {
  const card_options *p = r->param;
  const card *c = r->card;
  const friction_ops *law = p->law == NULL ? NULL : friction_find(p->law);
  if (law == NULL || p->contact == NULL) return OK;
  const int id = find_contact(r, p->contact);
  friction_rule *rule = NULL;
  if (id < 0) return OK;
  PASS(new_rule(r, id, &rule));
  if (rule == NULL) return OK;
  rule->law = law;
  rule->amplitude_name = p->amplitude;
  rule->at = c->at;
  rule->value_at = c->n_record > 0 ? c->records[0].at : c->at;
  rule->amplitude_at = *value_place(r, "AMPLITUDE");
  PASS(copy_options(r, law, &rule->card.param));
  if (law->value_name != NULL)
    PASS(read_value(r, law->value_name, p->surface.table, &rule->card.value,
                    &rule->position));
  else if (c->n_record > 0)
    message_add(r->m->log, P2008, &c->records[0].at,
                "*FRICTION, LAW=%s has no data lines", p->law);
  return OK;
}

status apply_contact_force(reading *r) {
  const card_options *p = r->param;
  const card *c = r->card;
  if (p->contact == NULL) return OK;
  int id = find_contact(r, p->contact);
  if (id < 0) return OK;
  given_force *f = &r->m->contacts[id].force;
  if (f->given) {
    message_add(r->m->log, P2011, &c->at,
                "contact %s has its *CONTACT FORCE already, at line %d",
                p->contact, f->at.line_no);
    return OK;
  }
  f->given = 1;
  f->amplitude_name = p->amplitude;
  f->at = c->at;
  f->value_at = c->n_record > 0 ? c->records[0].at : c->at;
  f->amplitude_at = *value_place(r, "AMPLITUDE");
  return read_value(r, "p", p->surface.table, &f->value, &f->position);
}

status apply_effect(reading *r) {
  model *m = r->m;
  const card_options *p = r->param;
  int id = p->contact == NULL ? -1 : find_contact(r, p->contact);
  if (p->contact != NULL && id < 0) return OK;
  const effect_card *first = model_effect_card(m, r->card->name, id);
  if (first != NULL) {
    message_add(
        m->log, P2011, &r->card->at, "%s%s has its *%s already, at line %d",
        p->contact == NULL ? "the deck" : "contact ",
        p->contact == NULL ? "" : p->contact, r->card->name, first->at.line_no);
    return OK;
  }
  ADDED(effect_card, c, m->effect_cards, m->n.effect_card, m->cap.effect_card);
  *c = (effect_card){r->card->name, id, {0}, r->card->at};
  memcpy(c->value, p->value, sizeof c->value);
  return OK;
}
