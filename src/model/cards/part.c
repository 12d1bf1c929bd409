/* Cards of the model: title, units, mesh, sections, amplitudes, time points. */
#include "model/cards/cards.h"

#include "base/base.h"

status apply_heading(reading *r) {
  const card *c = r->card;
  if (c->n_record == 0) return OK;
  if (r->m->name.title[0] != '\0')
    message_add(r->m->log, P2011, &c->at, "a deck has one *HEADING card");
  r->m->name.title = c->records[0].raw;
  return OK;
}

status apply_units(reading *r) {
  const card_options *p = r->param;
  if (r->m->unit.given++)
    message_add(r->m->log, P2011, &r->card->at, "a deck has one *UNITS card");
  r->m->unit.length = p->units.length;
  r->m->unit.force = p->units.force;
  r->m->unit.time = p->units.time;
  return OK;
}

status apply_mesh(reading *r) {
  model *m = r->m;
  if (m->mesh.given) {
    message_add(m->log, P2015, &r->card->at, "a deck has one *MESH card");
    return OK;
  }
  m->mesh.given = 1;
  m->mesh.at = *value_place(r, "FILE");
  m->mesh.scale = r->param->body.scale;
  return field_file(r, &m->mesh.file);
}

status apply_condensed_problem(reading *r) {
  const card_options *p = r->param;
  model *m = r->m;
  if (m->problem.given) {
    message_add(m->log, P2011, &r->card->at,
                "a deck has one *CONDENSED PROBLEM card");
    return OK;
  }
  m->problem.given = 1;
  m->problem.at = *value_place(r, "FILE");
  m->problem.type = card_parameter(r->card, "TYPE") == NULL ? -1 : p->type;
  return field_file(r, &m->problem.file);
}

status apply_section(reading *r) {
  const card_options *p = r->param;
  model *m = r->m;
  ADDED(section, s, m->sections, m->n.section, m->cap.section);
  s->elset = p->body.elset == NULL ? "" : p->body.elset;
  s->material_name = p->body.material == NULL ? "" : p->body.material;
  s->at = r->card->at;
  s->elset_at = *value_place(r, "ELSET");
  s->material_at = *value_place(r, "MATERIAL");
  s->material_id = -1;
  s->group_id = -1;
  s->thickness = p->body.thickness;
  /* The words of Abaqus repeat the four kinematics. */
  s->kin = card_parameter(r->card, "TYPE") == NULL ? -1 : p->type % 4;
  s->averaged = p->body.formulation;
  s->has_thickness =
      r->card->n_record > 0 || card_parameter(r->card, "THICKNESS") != NULL;
  if (r->card->n_record > 0) {
    const record *line = &r->card->records[0];
    if (card_parameter(r->card, "THICKNESS") != NULL)
      message_add(m->log, P2011, &line->at,
                  "*SOLID SECTION: the thickness is given by THICKNESS= and by "
                  "a data line");
    else if (record_fields(r, line, 1, 1, "thickness") == 0)
      field_real(r, &line->fields[0], DBL_MIN, "thickness", &s->thickness);
  }
  return OK;
}

/* One pair: the same at all times. */
static status constant_table(double value, value_table *t) {
  PASS_NEW_REALS(1, &t->at, &t->value);
  t->value[0] = value;
  t->n = 1;
  return OK;
}

status apply_amplitude(reading *r) {
  const card_options *p = r->param;
  model *m = r->m;
  const card *c = r->card;
  for (int i = 0; i < m->n.amplitude; ++i)
    name_taken(r, p->name, m->time.amplitudes[i].name);
  ADDED(amplitude, a, m->time.amplitudes, m->n.amplitude, m->cap.amplitude);
  a->name = p->name == NULL ? "" : p->name;
  a->at = *value_place(r, "NAME");
  a->total_time = p->time;
  a->table.variable = TABLE_T;
  if (c->records[0].n_field == 1 && c->n_record == 1) {
    quantity q = {0};
    if (field_quantity(r, &c->records[0].fields[0], &q) != 0) return OK;
    a->table.formula = q.formula;
    if (q.formula == NULL && !c->records[0].fields[0].quoted)
      message_add(m->log, P2009, &c->records[0].at,
                  "*AMPLITUDE needs pairs t, a or one expression in quotes");
    else if (q.formula == NULL)
      PASS(constant_table(q.number, &a->table));
    else if (expression_variables(q.formula) & 7u)
      message_add(m->log, P2033, &c->records[0].at,
                  "*AMPLITUDE: the expression may depend on t only");
    return OK;
  }
  return read_pairs(r, TABLE_T, &a->table);
}

/* One more time, after the others; *right 0 if it is not. */
static status add_time(reading *r, const record *line, double t, time_points *p,
                       int *capacity, int *right) {
  *right = p->n == 0 || t > p->t[p->n - 1];
  if (!*right) {
    message_add(r->m->log, P2057, &line->at,
                "*TIME POINTS: %g after %g; expected times that ascend", t,
                p->t[p->n - 1]);
    return OK;
  }
  PASS_GROW(p->t, p->n, *capacity);
  p->t[p->n++] = t;
  return OK;
}

/* First, last, interval. */
static status read_range(reading *r, const record *line, time_points *p,
                         int *capacity) {
  enum { MOST = 1000000 };
  double v[3];
  int right = 1;
  if (record_fields(r, line, 3, 3, "first, last, interval") != 0) return OK;
  for (int i = 0; i < 3; ++i)
    if (deck_real(&line->fields[i], r->m->log, &v[i]) != 0) return OK;
  double n = floor((v[1] - v[0]) / v[2] * (1 + 1e-12) + 1e-9);
  if (!(n >= 0.0 && n < MOST && v[2] > 0.0)) {
    message_add(r->m->log, P2057, &line->at,
                "*TIME POINTS: from %g to %g by %g; expected a last time that "
                "is not before the first, and up to %d of them",
                v[0], v[1], v[2], MOST);
    return OK;
  }
  for (int i = 0; i <= (int)n && right; ++i)
    PASS(add_time(r, line, v[0] + i * v[2], p, capacity, &right));
  return OK;
}

static status read_times(reading *r, const record *line, time_points *p,
                         int *capacity) {
  int right = 1;
  for (int i = 0; i < line->n_field && right; ++i) {
    double t;
    if (deck_real(&line->fields[i], r->m->log, &t) != 0) return OK;
    PASS(add_time(r, line, t, p, capacity, &right));
  }
  return OK;
}

status apply_time_points(reading *r) {
  const card_options *p = r->param;
  model *m = r->m;
  int capacity = 0;
  for (int i = 0; i < m->n.points; ++i)
    name_taken(r, p->name, m->time.points[i].name);
  ADDED(time_points, own, m->time.points, m->n.points, m->cap.points);
  *own = (time_points){.name = p->name == NULL ? "" : p->name,
                       .total_time = p->time,
                       .at = *value_place(r, "NAME")};
  for (EACH(const record, line, r->card->records, r->card->n_record))
    PASS(p->type ? read_range(r, line, own, &capacity)
                 : read_times(r, line, own, &capacity));
  return OK;
}

status apply_effects(reading *r) {
  const card_options *p = r->param;
  if (r->m->reduction.given)
    message_add(r->m->log, P2011, &r->card->at,
                "a deck has one *EFFECTS card, this is its second");
  r->m->reduction.given = 1;
  r->m->reduction.is_auto = p->type;
  r->m->reduction.tol = p->tol;
  r->m->reduction.at = r->card->at;
  if (!p->type && p->tol != 1e-3) report_idle(r, "TOL", "MODE=AUTO");
  return OK;
}
