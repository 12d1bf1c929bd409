/*
 * Cards of a step: procedure, supports, loads, solver, output.
 */
#include "model/keyword.h"

#include "base/memory.h"

#include <float.h>
#include <math.h>
#include <string.h>

static step *open_step(const reading *r) {
  return &r->m->steps[r->m->n_step - 1];
}

status apply_step(reading *r) {
  status st = OK;
  const name_param *p = r->param;
  model *m = r->m;
  GROW(m->steps, m->n_step, m->cap_step);
  step *s = &m->steps[m->n_step++];
  s->name = p->name == NULL ? "" : p->name;
  s->at = r->card->at;
  r->in_step = 1;
done:
  return st;
}

status apply_end_step(reading *r) {
  const step *s = open_step(r);
  if (s->kind == STEP_NONE && !r->m->has_problem)
    message_add(r->m->log, P2018, &s->at,
                "this step has no procedure: *STATIC or *QUASISTATIC");
  r->in_step = 0;
  return OK;
}

/* 1 if the step has its procedure already. */
static int second_procedure(const reading *r) {
  if (open_step(r)->kind == STEP_NONE) return 0;
  message_add(r->m->log, P2018, &r->card->at,
              "a step has one procedure, this is its second");
  return 1;
}

status apply_static(reading *r) {
  step *s = open_step(r);
  if (second_procedure(r)) return OK;
  s->kind = STEP_STATIC;
  s->total = 1.0;
  if (r->card->n_record > 0) {
    const record *line = &r->card->records[0];
    if (record_fields(r, line, 1, 1, "duration") == 0)
      field_real(r, &line->fields[0], DBL_MIN, DBL_MAX, "duration", &s->total);
  }
  s->dt = s->total;
  s->dt_min = s->total;
  return OK;
}

status apply_quasistatic(reading *r) {
  step *s = open_step(r);
  const quasistatic_param *p = r->param;
  const record *line = &r->card->records[0];
  double dt_max = HUGE_VAL;
  if (second_procedure(r)) return OK;
  s->kind = STEP_QUASISTATIC;
  s->dt = s->total = s->dt_min = 1.0;
  if (p->form != 0)
    message_add(r->m->log, P2002, &card_parameter(r->card, "FORM")->value.at,
                "FORM=VELOCITY is not available in this version");
  if (record_fields(r, line, 2, 4, "dt, total [, dt_min [, dt_max]]") != 0)
    return OK;
  const field *f = line->fields;
  if (field_real(r, &f[0], DBL_MIN, DBL_MAX, "dt", &s->dt) != 0 ||
      field_real(r, &f[1], DBL_MIN, DBL_MAX, "total", &s->total) != 0)
    return OK;
  if (line->n_field > 3 &&
      field_real(r, &f[3], DBL_MIN, DBL_MAX, "dt_max", &dt_max) != 0)
    return OK;
  if (s->dt > s->total * (1.0 + 1e-12))
    message_add(r->m->log, P2020, &f[0].at,
                "the increment dt = %s is longer than the step, %s", f[0].text,
                f[1].text);
  if (s->total / s->dt > 1e8)
    message_add(r->m->log, P2020, &f[0].at,
                "%.3g increments; at most 1e8 are possible", s->total / s->dt);
  s->dt = fmin(s->dt, dt_max);
  s->dt_min = s->dt / 16.0;
  if (line->n_field > 2 && f[2].text[0] != '\0' &&
      field_real(r, &f[2], DBL_MIN, s->dt, "dt_min", &s->dt_min) != 0)
    return OK;
  return OK;
}

/* A load of the step, or of the model part; NULL without memory. */
static load *new_load(reading *r, load_list *list, int kind,
                      const field *group) {
  status st = OK;
  GROW(list->item, list->n, list->cap);
  load *l = &list->item[list->n++];
  const load_param *p = r->param;
  memset(l, 0, sizeof *l);
  l->kind = kind;
  l->group = group->text;
  l->at = group->at;
  l->group_id = -1;
  l->amplitude_id = -1;
  l->amplitude_name = p->amplitude;
  if (p->op == 1 && r->in_step) open_step(r)->renewed |= 1u << kind;
done:
  return st == OK ? &list->item[list->n - 1] : NULL;
}

/* OP=NEW also without data lines. */
static void renew(const reading *r, unsigned kinds) {
  const load_param *p = r->param;
  if (p->op == 1 && r->in_step) open_step(r)->renewed |= kinds;
}

static void read_line_amplitude(const field *f, load *l) {
  if (f->text[0] != '\0') l->amplitude_name = f->text;
}

status apply_boundary(reading *r) {
  status st = OK;
  const card *c = r->card;
  load_list *list = r->in_step ? &open_step(r)->loads : &r->m->supports;
  renew(r, 1u << LOAD_FIXING);
  for (int i = 0; i < c->n_record; ++i) {
    const record *line = &c->records[i];
    const field *f = line->fields;
    int first, last;
    quantity value = {0};
    if (record_fields(r, line, 2, 5,
                      "group, first dof [, last dof [, value [, amplitude]]]"))
      continue;
    if (field_int(r, &f[1], 1, 3, "first dof", &first) != 0) continue;
    last = first;
    if (line->n_field > 2 && f[2].text[0] != '\0' &&
        field_int(r, &f[2], first, 3, "last dof", &last) != 0)
      continue;
    if (line->n_field > 3 && f[3].text[0] != '\0' &&
        field_quantity(r, &f[3], &value) != 0)
      continue;
    if (!r->in_step && (value.formula != NULL || value.number != 0.0)) {
      message_add(r->m->log, P2010, &f[3].at,
                  "*BOUNDARY before the first step holds at zero; prescribe "
                  "a displacement in a step");
      continue;
    }
    for (int k = first; k <= last; ++k) {
      load *l = new_load(r, list, LOAD_FIXING, &f[0]);
      if (l == NULL) FAIL(ERR_MEMORY, "memory exhausted: *BOUNDARY");
      l->component = k - 1;
      l->value = value;
      if (line->n_field > 4) read_line_amplitude(&f[4], l);
    }
  }
done:
  return st;
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
  status st = OK;
  const card *c = r->card;
  renew(r, 1u << LOAD_PRESSURE | 1u << LOAD_TRACTION);
  for (int i = 0; i < c->n_record; ++i) {
    const record *line = &c->records[i];
    const field *f = line->fields;
    quantity value;
    if (record_fields(r, line, 3, 4,
                      "group, P or TX TY TZ, value [, amplitude]") != 0)
      continue;
    int label = read_label(r, &f[1], "P|TX|TY|TZ");
    if (label < 0 || field_quantity(r, &f[2], &value) != 0) continue;
    load *l = new_load(r, &open_step(r)->loads,
                       label == 0 ? LOAD_PRESSURE : LOAD_TRACTION, &f[0]);
    if (l == NULL) FAIL(ERR_MEMORY, "memory exhausted: *DSLOAD");
    l->component = label == 0 ? 0 : label - 1;
    l->value = value;
    if (line->n_field > 3) read_line_amplitude(&f[3], l);
  }
done:
  return st;
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
  status st = OK;
  const card *c = r->card;
  renew(r, 1u << LOAD_BODY | 1u << LOAD_GRAVITY);
  for (int i = 0; i < c->n_record; ++i) {
    const record *line = &c->records[i];
    const field *f = line->fields;
    quantity value = {0};
    double direction[3] = {0.0, 0.0, 0.0};
    if (record_fields(r, line, 3, 7, "group, label, value ...") != 0) continue;
    int label = read_label(r, &f[1], "BX|BY|BZ|GRAV"), gravity = label == 3;
    if (label < 0) continue;
    if (gravity && read_gravity(r, line, &value, direction) != 0) continue;
    if (!gravity &&
        (record_fields(r, line, 3, 4, "group, BX BY BZ, value [, amplitude]") ||
         field_quantity(r, &f[2], &value) != 0))
      continue;
    load *l = new_load(r, &open_step(r)->loads,
                       gravity ? LOAD_GRAVITY : LOAD_BODY, &f[0]);
    if (l == NULL) FAIL(ERR_MEMORY, "memory exhausted: *DLOAD");
    l->component = gravity ? 0 : label;
    l->value = value;
    memcpy(l->direction, direction, sizeof direction);
    int at = gravity ? 6 : 3;
    if (line->n_field > at) read_line_amplitude(&f[at], l);
  }
done:
  return st;
}

status apply_cload(reading *r) {
  status st = OK;
  const card *c = r->card;
  renew(r, 1u << LOAD_POINT);
  for (int i = 0; i < c->n_record; ++i) {
    const record *line = &c->records[i];
    const field *f = line->fields;
    int dof;
    quantity value;
    if (record_fields(r, line, 3, 4, "group, dof, value [, amplitude]") != 0)
      continue;
    if (field_int(r, &f[1], 1, 3, "dof", &dof) != 0 ||
        field_quantity(r, &f[2], &value) != 0)
      continue;
    load *l = new_load(r, &open_step(r)->loads, LOAD_POINT, &f[0]);
    if (l == NULL) FAIL(ERR_MEMORY, "memory exhausted: *CLOAD");
    l->component = dof - 1;
    l->value = value;
    if (line->n_field > 3) read_line_amplitude(&f[3], l);
  }
done:
  return st;
}

static const char *solver_name(const void *ctx, int i) {
  (void)ctx;
  if (i == 0) return "AUTO";
  return solver_list[i - 1] == NULL ? NULL : solver_list[i - 1]->name;
}

plugin names_solver(const reading *r) {
  const solver_param *p = r->param;
  const parameter *method = card_parameter(r->card, "METHOD");
  plugin none = {NULL, 0};
  if (method == NULL || same_word(p->method, "AUTO")) return none;
  const solver_ops *ops = solver_find(p->method);
  if (ops != NULL) return (plugin){ops->options, ops->param_size};
  const char *near = nearest_word(p->method, solver_name, NULL);
  message_add(r->m->log, P2012, &method->value.at,
              "*SOLVER: there is no METHOD=%s in this version%s%s%s", p->method,
              near == NULL ? "" : "; did you mean ", near == NULL ? "" : near,
              near == NULL ? "" : "?");
  return none;
}

status apply_solver(reading *r) {
  status st = OK;
  const solver_param *p = r->param;
  step *s = open_step(r);
  if (s->solver_at.file != NULL) {
    message_add(r->m->log, P2011, &r->card->at,
                "a step has one *SOLVER card, this is its second");
    goto done;
  }
  s->solver_at = r->card->at;
  s->solver.ops = solver_find(p->method);
  s->solver.tol = p->tol;
  s->solver.max_iter = p->max_iter;
  s->solver.limit_max_iter = p->limit_max_iter;
  if (r->plugin == NULL) goto done;
  s->solver_param = memory_new(1, r->plugin_size);
  if (s->solver_param == NULL)
    FAIL(ERR_MEMORY, "memory exhausted: solver options");
  memcpy(s->solver_param, r->plugin, r->plugin_size);
  s->solver.param = s->solver_param;
done:
  return st;
}

status apply_print(reading *r) {
  status st = OK;
  const print_param *p = r->param;
  step *s = open_step(r);
  const int asked[] = {p->contact,  p->totals, p->nodes,
                       p->elements, p->energy, p->reactions};
  int any = 0;
  s->has_print = 1;
  for (int i = 0; i < 6; ++i) {
    if (!asked[i]) continue;
    any = 1;
    GROW(s->prints, s->n_print, s->cap_print);
    print_request *q = &s->prints[s->n_print++];
    q->table = 1 << i;
    q->group = p->group;
    q->group_id = -1;
    q->frequency = p->frequency;
    q->at = r->card->at;
  }
  if (!any)
    message_add(r->m->log, P2005, &r->card->at,
                "*PRINT names no table: CONTACT, TOTALS, NODES, ELEMENTS, "
                "ENERGY or REACTIONS");
done:
  return st;
}

status apply_output(reading *r) {
  const output_param *p = r->param;
  step *s = open_step(r);
  s->has_output = 1;
  s->output_frequency = p->hdf5 ? p->frequency : -1;
  s->condensed_frequency = p->condensed == 1 ? p->frequency : -1;
  return OK;
}
