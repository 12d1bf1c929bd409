/*
 * Steps: procedure, increments and integrator; what they are solved by and what
 * they write: solver, accuracy, tables, fields.
 */
#include "base/base.h"
#include "model/cards/cards.h"

status apply_step(reading *r) {
  const card_options *p = r->param;
  model *m = r->m;
  ADDED(step, s, m->steps, m->n.step, m->cap.step);
  s->name = p->name == NULL ? "" : p->name;
  s->at = r->card->at;
  r->in_step = 1;
  return OK;
}

status apply_end_step(reading *r) {
  const step *s = open_step(r);
  if (s->kind == STEP_NONE && !r->m->problem.given && !r->lost)
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
    if (record_fields(r, line, 1, 1, "duration") != 0 ||
        field_real(r, &line->fields[0], DBL_MIN, "duration", &s->total) != 0)
      s->total = 1.0;
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
  if (s->visco.tolerance == 0.0 && s->total / s->dt > 1e8)
    message_add(log, P2020, &f[0].at,
                "%.3g increments; at most 1e8 are possible", s->total / s->dt);
}

/* dt, total [, dt_min [, dt_max]] of a step; -1: refused. */
static int take_increments(const reading *r, step *s) {
  const record *line = &r->card->records[0];
  if (record_fields(r, line, 2, 4, "dt, total [, dt_min [, dt_max]]") != 0)
    return -1;
  const field *f = line->fields;
  if (field_real(r, &f[0], DBL_MIN, "dt", &s->dt) != 0 ||
      field_real(r, &f[1], DBL_MIN, "total", &s->total) != 0)
    return -1;
  if (line->n_field > 3 &&
      field_real(r, &f[3], DBL_MIN, "dt_max", &s->dt_max) != 0)
    return -1;
  s->dt_min = s->dt / 16.0;
  if (line->n_field > 2 && f[2].text[0] != '\0' &&
      field_real(r, &f[2], DBL_MIN, "dt_min", &s->dt_min) != 0)
    return -1;
  check_increments(r, f, s);
  return 0;
}

/* Of a step whose line was refused nothing more is to be said. */
static void read_increments(const reading *r, step *s) {
  s->dt_max = HUGE_VAL;
  if (take_increments(r, s) == 0) return;
  s->dt = s->total = s->dt_min = 1.0;
  s->dt_max = HUGE_VAL;
}

status apply_quasistatic(reading *r) {
  step *s = open_step(r);
  if (second_procedure(r)) return OK;
  s->kind = STEP_QUASISTATIC;
  s->form = r->param->type;
  read_increments(r, s);
  return OK;
}

/* THETA=, ITERATION= and SUBSTEPS= where they have no effect; the defaults,
 * which the echo writes, are accepted. */
static void check_visco(const reading *r, const scheme *s) {
  const card_options *p = r->param;
  if (!s->has_theta && p->visco.theta != 0.5)
    message_add(r->m->log, P2037, value_place(r, "THETA"),
                "*VISCO: THETA= counts for INTEGRATOR=THETA only");
  if (s->limit == 0.0 && !s->has_theta && p->visco.substeps)
    report_idle(r, "SUBSTEPS", "an explicit INTEGRATOR=");
  if (s->limit > 0.0 && p->visco.iteration != 0)
    message_add(r->m->log, P2037, value_place(r, "ITERATION"),
                "*VISCO: INTEGRATOR=%s does not iterate", s->name);
}

static int gives_dt_min(const reading *r) {
  const record *line = &r->card->records[0];
  return line->n_field > 2 && line->fields[2].text[0] != '\0';
}

status apply_visco(reading *r) {
  step *s = open_step(r);
  const card_options *p = r->param;
  if (second_procedure(r)) return OK;
  s->kind = STEP_VISCO;
  s->visco.tolerance = p->visco.tolerance;
  read_increments(r, s);
  s->visco.integrator =
      p->visco.integrator == NULL ? NULL : scheme_find(p->visco.integrator);
  if (s->visco.integrator == NULL) {
    if (p->visco.integrator != NULL)
      unknown_word(r->m->log, P2012, value_place(r, "INTEGRATOR"),
                   "*VISCO: this version has no INTEGRATOR=",
                   p->visco.integrator, candidate_name, LISTED(scheme_list));
    return OK;
  }
  check_visco(r, s->visco.integrator);
  s->visco.theta = s->visco.integrator->has_theta ? p->visco.theta
                                                  : s->visco.integrator->theta;
  s->visco.initial = p->visco.iteration == 1;
  s->visco.substeps = p->visco.substeps == 1 || p->visco.tolerance > 0.0;
  if (p->visco.tolerance > 0.0 && !gives_dt_min(r)) s->dt_min = 1e-6 * s->dt;
  return OK;
}

/* ---- solver, accuracy, output ------------------------------------------- */

static const char *solver_name(const void *ctx, int i) {
  if (i == 0) return "AUTO";
  return solver_list[i - 1] == NULL ? NULL : solver_list[i - 1]->name;
}

plugin names_solver(const reading *r) {
  const card_options *p = r->param;
  const parameter *method = card_parameter(r->card, "METHOD");
  if (method == NULL || same_word(p->solver.method, "AUTO"))
    return (plugin){NULL, 0, "METHOD", "AUTO"};
  const solver_ops *ops = solver_find(p->solver.method);
  if (ops != NULL)
    return (plugin){ops->options, ops->param_size, "METHOD", ops->name};
  if (method->has_value)
    unknown_word(r->m->log, P2012, &method->value.at,
                 "*SOLVER: this version has no METHOD=", p->solver.method,
                 solver_name, NULL);
  return (plugin){NULL, 0, "METHOD", NULL};
}

/* Of a solver that is to be balanced with errors that are zero. */
static const double TOL_DEFAULT = 1e-10;

/* 1: the step has one already; else it is given, at this place. */
static int second_in_step(const reading *r, int *given, place *at) {
  if (*given)
    message_add(r->m->log, P2011, &r->card->at,
                "a step has one *%s card, this is its second", r->card->name);
  else
    *at = r->card->at;
  return (*given)++;
}

status apply_solver(reading *r) {
  const card_options *p = r->param;
  step *s = open_step(r);
  int given = s->solver_at.file != NULL;
  if (second_in_step(r, &given, &s->solver_at)) return OK;
  s->solver.ops = solver_find(p->solver.method);
  s->balanced = p->tol < 0.0;
  s->share = p->solver.share;
  s->solver.tol = s->balanced ? TOL_DEFAULT : p->tol;
  s->solver.max_iter = p->solver.max_iter;
  s->solver.limit_max_iter = p->solver.limit_max_iter;
  s->solver.stiffness = p->solver.stiffness;
  s->solver.max_memory = p->max_memory;
  if (p->solver.stiffness != STIFFNESS_AUTO && p->max_memory > 0.0)
    report_idle(r, "MAX_MEMORY", "STIFFNESS=AUTO");
  /* The first increment starts from a coarser mesh of a geometry. */
  const char *file = r->m->mesh.file;
  if (p->solver.nested) {
    s->nested = s == r->m->steps && file != NULL && mesh_is_program(file);
    if (!s->nested)
      report_idle(r, "NESTED", "the first step and a .geo in *MESH");
  }
  s->check = p->solver.check;
  if (!s->balanced && p->solver.share != 0.05)
    report_idle(r, "SHARE", "TOL=BALANCED");
  if (r->plugin == NULL) return OK;
  PASS_GET(s->solver_param, memory_new(1, r->plugin_size));
  memcpy(s->solver_param, r->plugin, r->plugin_size);
  s->solver.param = s->solver_param;
  return OK;
}

/* Its limits count with a target of the energy norm, or of a *GOAL. */
static void take_target(const reading *r, const card_options *p) {
  accuracy_target *t = &r->m->accuracy.target;
  const int limited = p->accuracy.max_cpu > 0.0 || p->max_memory > 0.0 ||
                      p->accuracy.max_passes != MAX_PASSES_DEFAULT;
  if (p->accuracy.target > 0.0 ||
      (limited && model_targeted_goal(r->m) != NULL)) {
    const double percent =
        p->accuracy.target > 0.0 ? p->accuracy.target : t->percent;
    *t = (accuracy_target){percent, p->accuracy.max_cpu, p->max_memory,
                           p->accuracy.max_passes};
    return;
  }
  if (p->accuracy.max_cpu > 0.0) report_idle(r, "MAX_CPU", "TARGET=");
  if (p->max_memory > 0.0) report_idle(r, "MAX_MEMORY", "TARGET=");
  if (p->accuracy.max_passes != MAX_PASSES_DEFAULT)
    report_idle(r, "MAX_PASSES", "TARGET=");
}

status apply_accuracy(reading *r) {
  const card_options *p = r->param;
  step *s = open_step(r);
  if (second_in_step(r, &s->accuracy.given, &s->accuracy.at)) return OK;
  s->accuracy.no_solver = !p->accuracy.solver;
  s->accuracy.mesh = p->accuracy.mesh;
  s->accuracy.time = p->time > 0 || p->accuracy.target > 0.0;
  s->accuracy.time_balanced = p->time == TIME_BALANCED;
  s->accuracy.time_share = p->accuracy.time_share;
  if (s->accuracy.time_balanced || p->accuracy.target > 0.0)
    s->accuracy.mesh = MESH_ERROR_YES;
  s->accuracy.theorems = p->accuracy.theorems;
  if (!s->accuracy.time_balanced && p->accuracy.time_share != 0.1)
    report_idle(r, "TIME_SHARE", "TIME=BALANCED");
  take_target(r, p);
  return OK;
}

#define PRINT_WORD(name, help) " " #name
status apply_print(reading *r) {
  const card_options *p = r->param;
  step *s = open_step(r);
  int any = 0;
  for (int i = 0; i < PRINT_COUNT; ++i) {
    const int named = card_parameter(r->card, print_word(1 << i)) != NULL;
    any |= named;
    if (named && !p->output.print[i]) s->print.ended |= 1 << i;
    if (!p->output.print[i]) continue;
    s->print.given = 1;
    ADDED(print_request, q, s->print.requests, s->print.n, s->print.cap);
    q->table = 1 << i;
    q->group = p->group;
    q->frequency = p->frequency;
    q->points_name = p->output.points;
    q->points_at = *value_place(r, "TIME POINTS");
    q->at = *value_place(r, "GROUP");
    if (p->group != NULL &&
        (q->table & (PRINT_NODES | PRINT_ELEMENTS | PRINT_REACTIONS)) == 0)
      message_add(r->m->log, P2037, &q->at,
                  "GROUP= counts for NODES, ELEMENTS and REACTIONS only");
  }
  if (p->output.points != NULL && p->frequency != 1)
    report_idle(r, "FREQUENCY", "no TIME POINTS=");
  if (!any && !r->misread)
    message_add(r->m->log, P2005, &r->card->at,
                "*PRINT names no table:" PRINT_LIST(PRINT_WORD));
  return OK;
}

status apply_output(reading *r) {
  const card_options *p = r->param;
  step *s = open_step(r);
  if (second_in_step(r, &s->output.given, &s->output.at)) return OK;
  s->output.frequency = p->output.hdf5 ? p->frequency : -1;
  s->output.condensed = p->output.condensed == 1 ? p->frequency : -1;
  if (!p->output.hdf5 && p->output.condensed != 1 && p->frequency != 1)
    report_idle(r, "FREQUENCY", "HDF5=YES or CONDENSED=FCLIB");
  return OK;
}

status apply_restart(reading *r) {
  step *s = open_step(r);
  if (second_in_step(r, &s->restart.given, &s->restart.at)) return OK;
  s->restart.frequency = r->param->frequency;
  return OK;
}
