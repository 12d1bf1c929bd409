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
  if (s->kind == STEP_NONE && !r->m->has_problem && !r->lost)
    message_add(r->m->log, P2018, &s->at,
                "this step has no procedure: *STATIC, *QUASISTATIC or *VISCO");
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

/* Increments that fit together and into the step; those of a TOLERANCE= may
 * grow by any factor. */
static void check_increments(const reading *r, const field *f, const step *s) {
  message_log *log = r->m->log;
  if (s->dt > s->total * (1.0 + 1e-12))
    message_add(log, P2020, &f[0].at,
                "the increment dt = %s is longer than the step, %s", f[0].text,
                f[1].text);
  else if (s->dt > s->dt_max)
    message_add(log, P2020, &f[0].at,
                "the increment dt = %s is longer than dt_max = %s", f[0].text,
                f[3].text);
  else if (s->dt < s->dt_min)
    message_add(log, P2020, &f[0].at,
                "the increment dt = %s is shorter than dt_min = %s", f[0].text,
                f[2].text);
  if (s->tolerance == 0.0 && s->total / s->dt > 1e8)
    message_add(log, P2020, &f[0].at,
                "%.3g increments; at most 1e8 are possible", s->total / s->dt);
}

/* dt, total [, dt_min [, dt_max]] of a step. */
static void read_increments(const reading *r, step *s) {
  const record *line = &r->card->records[0];
  s->dt = s->total = s->dt_min = 1.0;
  s->dt_max = HUGE_VAL;
  if (record_fields(r, line, 2, 4, "dt, total [, dt_min [, dt_max]]") != 0)
    return;
  const field *f = line->fields;
  if (field_real(r, &f[0], DBL_MIN, DBL_MAX, "dt", &s->dt) != 0 ||
      field_real(r, &f[1], DBL_MIN, DBL_MAX, "total", &s->total) != 0)
    return;
  if (line->n_field > 3 &&
      field_real(r, &f[3], DBL_MIN, DBL_MAX, "dt_max", &s->dt_max) != 0)
    return;
  s->dt_min = s->dt / 16.0;
  if (line->n_field > 2 && f[2].text[0] != '\0' &&
      field_real(r, &f[2], DBL_MIN, DBL_MAX, "dt_min", &s->dt_min) != 0)
    return;
  check_increments(r, f, s);
}

status apply_quasistatic(reading *r) {
  step *s = open_step(r);
  const quasistatic_param *p = r->param;
  if (second_procedure(r)) return OK;
  s->kind = STEP_QUASISTATIC;
  s->form = p->form;
  read_increments(r, s);
  return OK;
}

static const char *scheme_name(const void *ctx, int i) {
  (void)ctx;
  return scheme_list[i] == NULL ? NULL : scheme_list[i]->name;
}

/* THETA= and ITERATION= where they mean nothing; the defaults, which the echo
 * writes, say nothing. */
static void check_visco(const reading *r, const scheme *s) {
  const visco_param *p = r->param;
  if (!s->has_theta && p->theta != 0.5)
    message_add(r->m->log, P2037, value_place(r, "THETA"),
                "*VISCO: THETA= counts for INTEGRATOR=THETA only");
  if (s->limit > 0.0 && p->iteration != 0)
    message_add(r->m->log, P2037, value_place(r, "ITERATION"),
                "*VISCO: INTEGRATOR=%s does not iterate", s->name);
}

static int gives_dt_min(const reading *r) {
  const record *line = &r->card->records[0];
  return line->n_field > 2 && line->fields[2].text[0] != '\0';
}

status apply_visco(reading *r) {
  step *s = open_step(r);
  const visco_param *p = r->param;
  if (second_procedure(r)) return OK;
  s->kind = STEP_VISCO;
  s->tolerance = p->tolerance;
  read_increments(r, s);
  s->integrator = p->integrator == NULL ? NULL : scheme_find(p->integrator);
  if (s->integrator == NULL) {
    if (p->integrator != NULL)
      unknown_word(r->m->log, P2012, value_place(r, "INTEGRATOR"),
                   "*VISCO: this version has no INTEGRATOR=", p->integrator,
                   scheme_name, NULL);
    return OK;
  }
  check_visco(r, s->integrator);
  s->theta = s->integrator->has_theta ? p->theta : s->integrator->theta;
  s->initial = p->iteration == 1;
  s->substeps = p->substeps == 1 || p->tolerance > 0.0;
  if (p->tolerance > 0.0 && !gives_dt_min(r)) s->dt_min = 1e-6 * s->dt;
  return OK;
}

/* 0 as well for one that the card has been told about. */
static int known_amplitude(const reading *r, const char *name) {
  for (int i = 0; i < r->m->n_amplitude; ++i)
    if (name != NULL && same_word(name, r->m->amplitudes[i].name)) return 1;
  return 0;
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

/* Without data lines the card says OP=NEW and no more. */
static void renew(const reading *r, unsigned kinds, const char *expected) {
  const load_param *p = r->param;
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
  status st = OK;
  const card *c = r->card;
  load_list *list = r->in_step ? &open_step(r)->loads : &r->m->supports;
  renew(r, 1u << LOAD_FIXING, boundary_line);
  for (int i = 0; i < c->n_record; ++i) {
    const record *line = &c->records[i];
    const field *f = line->fields;
    int first, last;
    quantity value = {0};
    if (read_fixing(r, line, &first, &last, &value) != 0) continue;
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
    if (l == NULL) FAIL(ERR_MEMORY, "memory exhausted: *CLOAD");
    l->component = dof - 1;
    l->value = value;
    if (line->n_field > 3) read_line_amplitude(&f[3], l);
  }
done:
  return st;
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
  status st = OK;
  const card *c = r->card;
  const parameter *file = card_parameter(c, "FILE");
  const char *path = NULL;
  renew(r, 1u << LOAD_TEMPERATURE, "group of elements, value [, amplitude]");
  if (file != NULL && file->has_value) {
    path = deck_path(r->m->deck, &file->value);
    if (path == NULL) FAIL(ERR_MEMORY, "memory exhausted: *TEMPERATURE");
  }
  for (int i = 0; i < c->n_record; ++i) {
    const record *line = &c->records[i];
    quantity value;
    if (read_temperature(r, line, path != NULL, &value) != 0) continue;
    load *l =
        new_load(r, &open_step(r)->loads, LOAD_TEMPERATURE, &line->fields[0]);
    if (l == NULL) FAIL(ERR_MEMORY, "memory exhausted: *TEMPERATURE");
    l->value = value;
    l->file = path;
    l->file_at = *value_place(r, "FILE");
    if (line->n_field > 2) read_line_amplitude(&line->fields[2], l);
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
  if (method == NULL || same_word(p->method, "AUTO"))
    return (plugin){NULL, 0, "METHOD", "AUTO"};
  const solver_ops *ops = solver_find(p->method);
  if (ops != NULL)
    return (plugin){ops->options, ops->param_size, "METHOD", ops->name};
  if (method->has_value)
    unknown_word(r->m->log, P2012, &method->value.at,
                 "*SOLVER: this version has no METHOD=", p->method, solver_name,
                 NULL);
  return (plugin){NULL, 0, "METHOD", NULL};
}

/* Of a solver that is to be balanced with errors that are zero. */
static const double TOL_DEFAULT = 1e-10;

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
  s->balanced = p->tol < 0.0;
  s->share = p->share;
  s->solver.tol = s->balanced ? TOL_DEFAULT : p->tol;
  s->solver.max_iter = p->max_iter;
  s->solver.limit_max_iter = p->limit_max_iter;
  s->check = p->check;
  if (r->plugin == NULL) goto done;
  s->solver_param = memory_new(1, r->plugin_size);
  if (s->solver_param == NULL)
    FAIL(ERR_MEMORY, "memory exhausted: solver options");
  memcpy(s->solver_param, r->plugin, r->plugin_size);
  s->solver.param = s->solver_param;
done:
  return st;
}

status apply_accuracy(reading *r) {
  const accuracy_param *p = r->param;
  step *s = open_step(r);
  if (s->has_accuracy)
    message_add(r->m->log, P2011, &r->card->at,
                "a step has one *ACCURACY card, this is its second");
  s->has_accuracy = 1;
  s->accuracy_at = r->card->at;
  s->no_solver_error = !p->solver;
  s->mesh_error = p->mesh || p->target > 0.0;
  s->time_error = p->time > 0 || p->target > 0.0;
  s->time_balanced = p->time == TIME_BALANCED;
  s->time_share = p->time_share;
  s->mesh_error |= s->time_balanced;
  s->theory = p->theory;
  if (p->target > 0.0)
    r->m->target =
        (accuracy_target){p->target, p->max_cpu, p->max_memory, p->max_passes};
  return OK;
}

/* One more time, after the others; *right 0 if it is not. */
static status add_time(reading *r, const record *line, double t, time_points *p,
                       int *room, int *right) {
  status st = OK;
  *right = p->n == 0 || t > p->t[p->n - 1];
  if (!*right) {
    message_add(r->m->log, P2057, &line->at,
                "*TIME POINTS: %g after %g; expected times that ascend", t,
                p->t[p->n - 1]);
    goto done;
  }
  GROW(p->t, p->n, *room);
  p->t[p->n++] = t;
done:
  return st;
}

/* First, last, interval. */
static status read_range(reading *r, const record *line, time_points *p,
                         int *room) {
  status st = OK;
  enum { MOST = 1000000 };
  double v[3];
  int right = 1;
  if (record_fields(r, line, 3, 3, "first, last, interval") != 0) goto done;
  for (int i = 0; i < 3; ++i)
    if (deck_real(&line->fields[i], r->m->log, &v[i]) != 0) goto done;
  double n = floor((v[1] - v[0]) / v[2] * (1 + 1e-12) + 1e-9);
  if (!(n >= 0.0 && n < MOST && v[2] > 0.0)) {
    message_add(r->m->log, P2057, &line->at,
                "*TIME POINTS: from %g to %g by %g; expected a last time that "
                "is not before the first, and up to %d of them",
                v[0], v[1], v[2], MOST);
    goto done;
  }
  for (int i = 0; i <= (int)n && right; ++i)
    TRY(add_time(r, line, v[0] + i * v[2], p, room, &right));
done:
  return st;
}

static status read_times(reading *r, const record *line, time_points *p,
                         int *room) {
  status st = OK;
  int right = 1;
  for (int i = 0; i < line->n_field && right; ++i) {
    double t;
    if (deck_real(&line->fields[i], r->m->log, &t) != 0) goto done;
    TRY(add_time(r, line, t, p, room, &right));
  }
done:
  return st;
}

status apply_time_points(reading *r) {
  status st = OK;
  const points_param *p = r->param;
  model *m = r->m;
  int room = 0;
  for (int i = 0; i < m->n_points; ++i)
    name_taken(r, p->name, m->points[i].name);
  GROW(m->points, m->n_points, m->cap_points);
  time_points *own = &m->points[m->n_points++];
  *own = (time_points){.name = p->name == NULL ? "" : p->name,
                       .total_time = p->time,
                       .at = *value_place(r, "NAME")};
  for (int i = 0; i < r->card->n_record; ++i) {
    const record *line = &r->card->records[i];
    TRY(p->generate ? read_range(r, line, own, &room)
                    : read_times(r, line, own, &room));
  }
done:
  return st;
}

status apply_effects(reading *r) {
  const effects_param *p = r->param;
  if (r->m->has_effects)
    message_add(r->m->log, P2011, &r->card->at,
                "a deck has one *EFFECTS card, this is its second");
  r->m->has_effects = 1;
  r->m->effects_auto = p->mode;
  r->m->effects_tol = p->tol;
  r->m->effects_at = r->card->at;
  return OK;
}

status apply_print(reading *r) {
  status st = OK;
  const print_param *p = r->param;
  step *s = open_step(r);
  const int asked[] = {p->contact, p->totals,    p->nodes, p->elements,
                       p->energy,  p->reactions, p->zones, p->loop};
  int any = 0;
  s->has_print = 1;
  for (int i = 0; i < 8; ++i) {
    if (!asked[i]) continue;
    any = 1;
    GROW(s->prints, s->n_print, s->cap_print);
    print_request *q = &s->prints[s->n_print++];
    q->table = 1 << i;
    q->group = p->group;
    q->group_id = -1;
    q->frequency = p->frequency;
    q->points_name = p->points;
    q->points_at = *value_place(r, "TIME POINTS");
    q->at = *value_place(r, "GROUP");
    if (p->group != NULL &&
        (q->table & (PRINT_NODES | PRINT_ELEMENTS | PRINT_REACTIONS)) == 0)
      message_add(r->m->log, P2037, &q->at,
                  "GROUP= counts for NODES, ELEMENTS and REACTIONS only");
  }
  if (!any && !r->misread)
    message_add(r->m->log, P2005, &r->card->at,
                "*PRINT names no table: CONTACT, TOTALS, NODES, ELEMENTS, "
                "ENERGY, REACTIONS, ZONES or LOOP");
done:
  return st;
}

status apply_output(reading *r) {
  const output_param *p = r->param;
  step *s = open_step(r);
  s->has_output = 1;
  s->output_at = r->card->at;
  s->output_frequency = p->hdf5 ? p->frequency : -1;
  s->condensed_frequency = p->condensed == 1 ? p->frequency : -1;
  return OK;
}

status apply_restart(reading *r) {
  const restart_param *p = r->param;
  step *s = open_step(r);
  s->has_restart = 1;
  s->restart_at = r->card->at;
  s->restart_frequency = p->frequency;
  return OK;
}
