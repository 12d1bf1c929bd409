/* Supports, loads and initial conditions. */
#include "model/cards/cards.h"

/* 0 also where an error was reported for the card. */
static int known_amplitude(const model *m, const char *name) {
  return name != NULL &&
         rank_of_name(NAMES(m->time.amplitudes, m->n.amplitude), name) >= 0;
}

/* Without data lines the card has OP=NEW only. */
static void renew(const reading *r, unsigned kinds, const char *expected) {
  const card_options *p = r->param;
  if (p->op == 1 && r->in_step) open_step(r)->renewed |= kinds;
  /* Lines that name their own amplitude leave this one unread. */
  if (p->amplitude != NULL && r->in_step)
    find_amplitude(r->m, p->amplitude, value_place(r, "AMPLITUDE"));
  if (p->op == 1 && !r->in_step)
    message_add(r->m->log, P2004, value_place(r, "OP"),
                "*%s: OP=NEW belongs in a step", r->card->name);
  if (r->card->n_record == 0 && p->op != 1 && !r->misread)
    message_add(r->m->log, P2007, &r->card->at, "*%s needs a data line: %s",
                r->card->name, expected);
}

/* Reads a data line into *l, with components from l->component to *last;
 * returns the field of its amplitude, -1 if the line is refused. */
typedef int line_reader(const reading *r, const record *line, load *l,
                        int *last);

/* A load of the step, or of the model part. */
static status add_load(reading *r, const record *line, int own_field,
                       const load *from) {
  load_list *list = r->in_step ? &open_step(r)->loads : &r->m->load.supports;
  ADDED(load, l, list->item, list->n, list->cap);
  const char *name = r->param->amplitude;
  *l = *from;
  l->group = line->fields[0].text;
  l->at = line->fields[0].at;
  l->group_id = l->amplitude_id = -1;
  if (!r->in_step || known_amplitude(r->m, name)) l->amplitude_name = name;
  l->amplitude_at = *value_place(r, "AMPLITUDE");
  if (l->group[0] == '\0')
    message_add(r->m->log, P1037, &l->at,
                "empty field, name of a group expected");
  if (r->param->op == 1 && r->in_step) open_step(r)->renewed |= 1u << l->kind;
  if (line->n_field <= own_field) return OK;
  const field *own = &line->fields[own_field];
  if (own->text[0] == '\0') return OK;
  l->amplitude_name = own->text;
  l->amplitude_at = own->at;
  return OK;
}

/* The data lines of a card of loads of some kinds, as bits. */
static status read_loads(reading *r, unsigned kinds, const char *expected,
                         const char *file, line_reader *read) {
  renew(r, kinds, expected);
  for (EACH(const record, line, r->card->records, r->card->n_record)) {
    load l = {.file = file};
    int last = 0, own_field = read(r, line, &l, &last);
    for (; own_field >= 0 && l.component <= last; ++l.component)
      PASS(add_load(r, line, own_field, &l));
  }
  return OK;
}

static const char boundary_line[] =
    "group, first dof [, last dof [, value [, amplitude]]]";

static int read_fixing(const reading *r, const record *line, load *l,
                       int *last) {
  const field *f = line->fields;
  int first;
  l->kind = LOAD_FIXING;
  if (record_fields(r, line, 2, 5, boundary_line) != 0) return -1;
  if (field_int(r, &f[1], 1, 3, "first dof", &first) != 0) return -1;
  *last = first;
  if (line->n_field > 2 && f[2].text[0] != '\0' &&
      field_int(r, &f[2], first, 3, "last dof", last) != 0)
    return -1;
  if (line->n_field > 3 && f[3].text[0] != '\0' &&
      field_quantity(r, &f[3], &l->value) != 0)
    return -1;
  l->component = first - 1;
  --*last;
  if (r->in_step || (l->value.formula == NULL && l->value.number == 0.0))
    return 4;
  message_add(r->m->log, P2010, &f[3].at,
              "*BOUNDARY before the first step holds at zero; prescribe a "
              "displacement in a step");
  return -1;
}

status apply_boundary(reading *r) {
  return read_loads(r, 1u << LOAD_FIXING, boundary_line, NULL, read_fixing);
}

/* Rank of a label among words, or -1 and the error. */
static int read_label(const reading *r, const field *f, const char *words) {
  int rank = choice_rank(words, f->text);
  if (rank < 0)
    message_add(r->m->log, P2028, &f->at,
                "*%s: unknown load label %s; expected one of %s", r->card->name,
                f->text, words);
  return rank;
}

static const char dsload_line[] = "group, P or TX TY TZ, value [, amplitude]";

static int read_traction(const reading *r, const record *line, load *l,
                         int *last) {
  if (record_fields(r, line, 3, 4, dsload_line) != 0) return -1;
  const int label = read_label(r, &line->fields[1], "P|TX|TY|TZ");
  if (label < 0 || field_quantity(r, &line->fields[2], &l->value) != 0)
    return -1;
  l->kind = label == 0 ? LOAD_PRESSURE : LOAD_TRACTION;
  l->component = *last = label == 0 ? 0 : label - 1;
  return 3;
}

status apply_dsload(reading *r) {
  return read_loads(r, 1u << LOAD_PRESSURE | 1u << LOAD_TRACTION, dsload_line,
                    NULL, read_traction);
}

/* GRAV, g, gx, gy [, gz [, amplitude]] */
static int read_gravity(const reading *r, const record *line, load *l) {
  const field *f = line->fields;
  if (record_fields(r, line, 5, 7,
                    "group, GRAV, g, gx, gy [, gz [, amplitude]]") != 0)
    return -1;
  if (field_quantity(r, &f[2], &l->value) != 0) return -1;
  double length = 0.0;
  for (int k = 0; k < 3; ++k) {
    if (3 + k < line->n_field && f[3 + k].text[0] != '\0' &&
        deck_real(&f[3 + k], r->m->log, &l->direction[k]) != 0)
      return -1;
    length = hypot(length, l->direction[k]);
  }
  if (length == 0.0) {
    message_add(r->m->log, P2027, &line->at,
                "GRAV: the direction gx, gy, gz is zero");
    return -1;
  }
  for (int k = 0; k < 3; ++k) l->direction[k] /= length;
  return 0;
}

static const char dload_line[] = "group, label, value ...";

static int read_body(const reading *r, const record *line, load *l, int *last) {
  if (record_fields(r, line, 3, 7, dload_line) != 0) return -1;
  const int label = read_label(r, &line->fields[1], "BX|BY|BZ|GRAV");
  if (label < 0) return -1;
  l->kind = label == 3 ? LOAD_GRAVITY : LOAD_BODY;
  if (label == 3) return read_gravity(r, line, l) == 0 ? 6 : -1;
  if (record_fields(r, line, 3, 4, "group, BX BY BZ, value [, amplitude]") ||
      field_quantity(r, &line->fields[2], &l->value) != 0)
    return -1;
  l->component = *last = label;
  return 3;
}

status apply_dload(reading *r) {
  return read_loads(r, 1u << LOAD_BODY | 1u << LOAD_GRAVITY, dload_line, NULL,
                    read_body);
}

static const char cload_line[] = "group, dof, value [, amplitude]";

static int read_force(const reading *r, const record *line, load *l,
                      int *last) {
  int dof;
  l->kind = LOAD_POINT;
  if (record_fields(r, line, 3, 4, cload_line) != 0 ||
      field_int(r, &line->fields[1], 1, 3, "dof", &dof) != 0 ||
      field_quantity(r, &line->fields[2], &l->value) != 0)
    return -1;
  l->component = *last = dof - 1;
  return 3;
}

status apply_cload(reading *r) {
  return read_loads(r, 1u << LOAD_POINT, cload_line, NULL, read_force);
}

static const char temperature_line[] = "group of elements, value [, amplitude]";

static int read_temperature(const reading *r, const record *line, load *l,
                            int *last) {
  const field *f = line->fields;
  const int file = l->file != NULL;
  *last = 0;
  l->kind = LOAD_TEMPERATURE;
  l->value.number = 1.0;
  l->file_at = *value_place(r, "FILE");
  if (record_fields(r, line, file ? 1 : 2, 3,
                    file ? "group of elements [, factor [, amplitude]]"
                         : temperature_line) != 0)
    return -1;
  if (line->n_field < 2 || (file && f[1].text[0] == '\0')) return 2;
  return field_quantity(r, &f[1], &l->value) == 0 ? 2 : -1;
}

status apply_temperature(reading *r) {
  const char *path;
  PASS(field_file(r, &path));
  return read_loads(r, 1u << LOAD_TEMPERATURE, temperature_line, path,
                    read_temperature);
}

/* By initial_type. */
static const struct {
  const char *line; /* what a line holds */
  int most;         /* number of the component at most, 0: there is none */
  const char *what; /* the component */
  int starts; /* 1: FILE= and INCOMPATIBLE= count, lines need not be there */
} initial_rows[] = {
    [INITIAL_TEMPERATURE] = {"group of elements, value", 0, NULL, 0},
    [INITIAL_DISPLACEMENT] = {"group, dof, value", 3, "dof", 1},
    [INITIAL_STRAIN] = {"group of elements, component (xx yy zz xy yz zx: 1 to "
                        "6), value",
                        6, "component", 0},
    [INITIAL_INTERNAL] = {"group of elements, number of the internal variable, "
                          "value",
                          FLOW_VALUE_MAX, "component", 0}};

/* One line into *c; 0 if fine. */
static int read_initial(const reading *r, const record *line, initial *c) {
  const int most = initial_rows[c->type].most, n = most > 0 ? 3 : 2;
  int number = 1;
  if (record_fields(r, line, n, n, initial_rows[c->type].line) != 0) return -1;
  if (most > 0 && field_int(r, &line->fields[1], 1, most,
                            initial_rows[c->type].what, &number) != 0)
    return -1;
  c->component = number - 1;
  return field_quantity(r, &line->fields[n - 1], &c->value);
}

/* Parameters of the card besides TYPE=. */
static status open_initial(reading *r) {
  const card_options *p = r->param;
  model *m = r->m;
  const parameter *file = card_parameter(r->card, "FILE");
  if (!initial_rows[p->type].starts) {
    if (file != NULL || p->body.incompatible)
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
  m->initial.start.relax = p->body.incompatible;
  m->initial.start.at = r->card->at;
  if (file == NULL || !file->has_value) return OK;
  m->initial.start.file_at = file->value.at;
  m->initial.start.file_name = p->file;
  return field_file(r, &m->initial.start.file);
}

status apply_initial(reading *r) {
  model *m = r->m;
  if (r->misread) return OK;
  PASS(open_initial(r));
  for (EACH(const record, line, r->card->records, r->card->n_record)) {
    initial c = {.type = r->param->type, .group_id = -1};
    if (read_initial(r, line, &c) != 0) continue;
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
