/*
 * *INITIAL CONDITIONS.
 */
#include "model/cards/cards.h"

#include "base/memory.h"

static const char temperature_line[] = "group of elements, value";

static const char displacement_line[] = "group, dof, value";

/* One line of each type into *c; 0 if fine. */
static int read_temperature_line(const reading *r, const record *line,
                                 initial *c) {
  if (record_fields(r, line, 2, 2, temperature_line) != 0) return -1;
  return field_quantity(r, &line->fields[1], &c->value);
}

static int read_displacement_line(const reading *r, const record *line,
                                  initial *c) {
  int dof = 1;
  if (record_fields(r, line, 3, 3, displacement_line) != 0 ||
      field_int(r, &line->fields[1], 1, 3, "dof", &dof) != 0)
    return -1;
  c->component = dof - 1;
  return field_quantity(r, &line->fields[2], &c->value);
}

static const char strain_line[] =
    "group of elements, component (xx yy zz xy yz zx: 1 to 6), value";

static const char internal_line[] =
    "group of elements, number of the internal variable, value";

static int read_numbered(const reading *r, const record *line, int most,
                         const char *expected, initial *c) {
  int number = 1;
  if (record_fields(r, line, 3, 3, expected) != 0 ||
      field_int(r, &line->fields[1], 1, most, "component", &number) != 0)
    return -1;
  c->component = number - 1;
  return field_quantity(r, &line->fields[2], &c->value);
}

static int read_strain_line(const reading *r, const record *line, initial *c) {
  return read_numbered(r, line, 6, strain_line, c);
}

static int read_internal_line(const reading *r, const record *line,
                              initial *c) {
  return read_numbered(r, line, FLOW_VALUE_MAX, internal_line, c);
}

/* By initial_type. */
static const struct {
  const char *line; /* what a line holds */
  int (*read)(const reading *r, const record *line, initial *c);
  int starts; /* 1: FILE= and INCOMPATIBLE= count, lines need not be there */
} initial_rows[] = {
    [INITIAL_TEMPERATURE] = {temperature_line, read_temperature_line, 0},
    [INITIAL_DISPLACEMENT] = {displacement_line, read_displacement_line, 1},
    [INITIAL_STRAIN] = {strain_line, read_strain_line, 0},
    [INITIAL_INTERNAL] = {internal_line, read_internal_line, 0}};

/* Parameters of the card besides TYPE=. */
static status open_initial(reading *r) {
  const card_options *p = r->param;
  model *m = r->m;
  const parameter *file = card_parameter(r->card, "FILE");
  if (!initial_rows[p->type].starts) {
    if (file != NULL || p->incompatible)
      message_add(m->log, P2004, &r->card->at,
                  "*INITIAL CONDITIONS: FILE= and INCOMPATIBLE= belong to "
                  "TYPE=DISPLACEMENT");
    if (r->card->n_record == 0)
      message_add(m->log, P2007, &r->card->at,
                  "*INITIAL CONDITIONS needs a data line: %s",
                  initial_rows[p->type].line);
    return OK;
  }
  if (m->initial.start.given)
    message_add(m->log, P2011, &r->card->at,
                "a deck has one *INITIAL CONDITIONS, TYPE=DISPLACEMENT; the "
                "other is at line %d",
                m->initial.start.at.line_no);
  m->initial.start.given = 1;
  m->initial.start.relax = p->incompatible;
  m->initial.start.at = r->card->at;
  if (file == NULL || !file->has_value) return OK;
  m->initial.start.file_at = file->value.at;
  m->initial.start.file_name = p->file;
  return field_file(r, &m->initial.start.file);
}

status apply_initial(reading *r) {
  const card_options *p = r->param;
  model *m = r->m;
  if (r->misread) return OK;
  PASS(open_initial(r));
  for (int i = 0; i < r->card->n_record; ++i) {
    const record *line = &r->card->records[i];
    initial c = {.type = p->type, .group_id = -1};
    if (initial_rows[p->type].read(r, line, &c) != 0) continue;
    c.group = line->fields[0].text;
    c.at = line->fields[0].at;
    if (quantity_variables(&c.value) & 8u)
      message_add(m->log, P2033, &line->fields[line->n_field - 1].at,
                  "*INITIAL CONDITIONS: the expression must not depend on t");
    PASS_GROW(m->initial.lines, m->n.initial, m->cap.initial);
    m->initial.lines[m->n.initial++] = c;
  }
  return OK;
}
