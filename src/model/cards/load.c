/*
 * Supports and loads.
 */
#include "model/cards/cards.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

/* 0 also where an error was reported for the card. */
static int known_amplitude(const reading *r, const char *name) {
  for (int i = 0; i < r->m->n.amplitude; ++i)
    if (name != NULL && same_word(name, r->m->time.amplitudes[i].name))
      return 1;
  return 0;
}

/* A load of the step, or of the model part; NULL without memory. */
static load *new_load(reading *r, load_list *list, int kind,
                      const field *group) {
  status st = OK;
  GROW(list->item, list->n, list->cap);
  load *l = &list->item[list->n++];
  const card_options *p = r->param;
  memset(l, 0, sizeof *l);
  l->kind = kind;
  l->group = group->text;
  l->at = group->at;
  l->group_id = -1;
  l->amplitude_id = -1;
  if (!r->in_step || known_amplitude(r, p->amplitude))
    l->amplitude_name = p->amplitude;
  l->amplitude_at = *value_place(r, "AMPLITUDE");
  if (group->text[0] == '\0')
    message_add(r->m->log, P1037, &group->at,
                "empty field, name of a group expected");
  if (p->op == 1 && r->in_step) open_step(r)->renewed |= 1u << kind;
done:
  return st == OK ? &list->item[list->n - 1] : NULL;
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

static void read_line_amplitude(const field *f, load *l) {
  if (f->text[0] == '\0') return;
  l->amplitude_name = f->text;
  l->amplitude_at = f->at;
}

static const char boundary_line[] =
    "group, first dof [, last dof [, value [, amplitude]]]";

/* The numbers of one line of *BOUNDARY; 0 if fine. */
static int read_fixing(const reading *r, const record *line, int *first,
                       int *last, quantity *value) {
  const field *f = line->fields;
  if (record_fields(r, line, 2, 5, boundary_line) != 0) return -1;
  if (field_int(r, &f[1], 1, 3, "first dof", first) != 0) return -1;
  *last = *first;
  if (line->n_field > 2 && f[2].text[0] != '\0' &&
      field_int(r, &f[2], *first, 3, "last dof", last) != 0)
    return -1;
  if (line->n_field > 3 && f[3].text[0] != '\0' &&
      field_quantity(r, &f[3], value) != 0)
    return -1;
  if (r->in_step || (value->formula == NULL && value->number == 0.0)) return 0;
  message_add(r->m->log, P2010, &f[3].at,
              "*BOUNDARY before the first step holds at zero; prescribe a "
              "displacement in a step");
  return -1;
}

status apply_boundary(reading *r) {
  const card *c = r->card;
  load_list *list = r->in_step ? &open_step(r)->loads : &r->m->load.supports;
  renew(r, 1u << LOAD_FIXING, boundary_line);
  for (int i = 0; i < c->n_record; ++i) {
    const record *line = &c->records[i];
    const field *f = line->fields;
    int first, last;
    quantity value = {0};
    if (read_fixing(r, line, &first, &last, &value) != 0) continue;
    for (int k = first; k <= last; ++k) {
      load *l = new_load(r, list, LOAD_FIXING, &f[0]);
      if (l == NULL) RAISE(ERR_MEMORY, "memory exhausted: *BOUNDARY");
      l->component = k - 1;
      l->value = value;
      if (line->n_field > 4) read_line_amplitude(&f[4], l);
    }
  }
  return OK;
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

status apply_dsload(reading *r) {
  const card *c = r->card;
  static const char expected[] = "group, P or TX TY TZ, value [, amplitude]";
  renew(r, 1u << LOAD_PRESSURE | 1u << LOAD_TRACTION, expected);
  for (int i = 0; i < c->n_record; ++i) {
    const record *line = &c->records[i];
    const field *f = line->fields;
    quantity value;
    if (record_fields(r, line, 3, 4, expected) != 0) continue;
    int label = read_label(r, &f[1], "P|TX|TY|TZ");
    if (label < 0 || field_quantity(r, &f[2], &value) != 0) continue;
    load *l = new_load(r, &open_step(r)->loads,
                       label == 0 ? LOAD_PRESSURE : LOAD_TRACTION, &f[0]);
    if (l == NULL) RAISE(ERR_MEMORY, "memory exhausted: *DSLOAD");
    l->component = label == 0 ? 0 : label - 1;
    l->value = value;
    if (line->n_field > 3) read_line_amplitude(&f[3], l);
  }
  return OK;
}

/* GRAV, g, gx, gy [, gz [, amplitude]] */
static int read_gravity(const reading *r, const record *line, quantity *value,
                        double direction[3]) {
  const field *f = line->fields;
  if (record_fields(r, line, 5, 7,
                    "group, GRAV, g, gx, gy [, gz [, amplitude]]") != 0)
    return -1;
  if (field_quantity(r, &f[2], value) != 0) return -1;
  double length = 0.0;
  for (int k = 0; k < 3; ++k) {
    direction[k] = 0.0;
    if (3 + k < line->n_field && f[3 + k].text[0] != '\0' &&
        deck_real(&f[3 + k], r->m->log, &direction[k]) != 0)
      return -1;
    length = hypot(length, direction[k]);
  }
  if (length == 0.0) {
    message_add(r->m->log, P2027, &line->at,
                "GRAV: the direction gx, gy, gz is zero");
    return -1;
  }
  for (int k = 0; k < 3; ++k) direction[k] /= length;
  return 0;
}

status apply_dload(reading *r) {
  const card *c = r->card;
  static const char expected[] = "group, label, value ...";
  renew(r, 1u << LOAD_BODY | 1u << LOAD_GRAVITY, expected);
  for (int i = 0; i < c->n_record; ++i) {
    const record *line = &c->records[i];
    const field *f = line->fields;
    quantity value = {0};
    double direction[3] = {0.0, 0.0, 0.0};
    if (record_fields(r, line, 3, 7, expected) != 0) continue;
    int label = read_label(r, &f[1], "BX|BY|BZ|GRAV"), gravity = label == 3;
    if (label < 0) continue;
    if (gravity && read_gravity(r, line, &value, direction) != 0) continue;
    if (!gravity &&
        (record_fields(r, line, 3, 4, "group, BX BY BZ, value [, amplitude]") ||
         field_quantity(r, &f[2], &value) != 0))
      continue;
    load *l = new_load(r, &open_step(r)->loads,
                       gravity ? LOAD_GRAVITY : LOAD_BODY, &f[0]);
    if (l == NULL) RAISE(ERR_MEMORY, "memory exhausted: *DLOAD");
    l->component = gravity ? 0 : label;
    l->value = value;
    memcpy(l->direction, direction, sizeof direction);
    int at = gravity ? 6 : 3;
    if (line->n_field > at) read_line_amplitude(&f[at], l);
  }
  return OK;
}

status apply_cload(reading *r) {
  const card *c = r->card;
  static const char expected[] = "group, dof, value [, amplitude]";
  renew(r, 1u << LOAD_POINT, expected);
  for (int i = 0; i < c->n_record; ++i) {
    const record *line = &c->records[i];
    const field *f = line->fields;
    int dof;
    quantity value;
    if (record_fields(r, line, 3, 4, expected) != 0) continue;
    if (field_int(r, &f[1], 1, 3, "dof", &dof) != 0 ||
        field_quantity(r, &f[2], &value) != 0)
      continue;
    load *l = new_load(r, &open_step(r)->loads, LOAD_POINT, &f[0]);
    if (l == NULL) RAISE(ERR_MEMORY, "memory exhausted: *CLOAD");
    l->component = dof - 1;
    l->value = value;
    if (line->n_field > 3) read_line_amplitude(&f[3], l);
  }
  return OK;
}

/* One line of *TEMPERATURE: 0 if fine. */
static int read_temperature(const reading *r, const record *line, int file,
                            quantity *value) {
  const field *f = line->fields;
  *value = (quantity){.number = 1.0};
  if (record_fields(r, line, file ? 1 : 2, 3,
                    file ? "group of elements [, factor [, amplitude]]"
                         : "group of elements, value [, amplitude]") != 0)
    return -1;
  if (line->n_field < 2 || (file && f[1].text[0] == '\0')) return 0;
  return field_quantity(r, &f[1], value);
}

status apply_temperature(reading *r) {
  const card *c = r->card;
  const char *path;
  renew(r, 1u << LOAD_TEMPERATURE, "group of elements, value [, amplitude]");
  PASS(field_file(r, &path));
  for (int i = 0; i < c->n_record; ++i) {
    const record *line = &c->records[i];
    quantity value;
    if (read_temperature(r, line, path != NULL, &value) != 0) continue;
    load *l =
        new_load(r, &open_step(r)->loads, LOAD_TEMPERATURE, &line->fields[0]);
    if (l == NULL) RAISE(ERR_MEMORY, "memory exhausted: *TEMPERATURE");
    l->value = value;
    l->file = path;
    l->file_at = *value_place(r, "FILE");
    if (line->n_field > 2) read_line_amplitude(&line->fields[2], l);
  }
  return OK;
}
