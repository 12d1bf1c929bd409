/*
 * Steps and their procedures: increments, integrators.
 */
#include "model/cards/cards.h"

#include "base/memory.h"

#include <float.h>
#include <math.h>

status apply_step(reading *r) {
  const card_options *p = r->param;
  model *m = r->m;
  PASS_GROW(m->steps, m->n.step, m->cap.step);
  step *s = &m->steps[m->n.step++];
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
  if (s->visco.tolerance == 0.0 && s->total / s->dt > 1e8)
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
  const card_options *p = r->param;
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

/* THETA=, ITERATION= and SUBSTEPS= where they have no effect; the defaults,
 * which the echo writes, are accepted. */
static void check_visco(const reading *r, const scheme *s) {
  const card_options *p = r->param;
  if (!s->has_theta && p->theta != 0.5)
    message_add(r->m->log, P2037, value_place(r, "THETA"),
                "*VISCO: THETA= counts for INTEGRATOR=THETA only");
  if (s->limit == 0.0 && !s->has_theta && p->substeps)
    report_idle(r, "SUBSTEPS", "an explicit INTEGRATOR=");
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
  const card_options *p = r->param;
  if (second_procedure(r)) return OK;
  s->kind = STEP_VISCO;
  s->visco.tolerance = p->tolerance;
  read_increments(r, s);
  s->visco.integrator =
      p->integrator == NULL ? NULL : scheme_find(p->integrator);
  if (s->visco.integrator == NULL) {
    if (p->integrator != NULL)
      unknown_word(r->m->log, P2012, value_place(r, "INTEGRATOR"),
                   "*VISCO: this version has no INTEGRATOR=", p->integrator,
                   scheme_name, NULL);
    return OK;
  }
  check_visco(r, s->visco.integrator);
  s->visco.theta =
      s->visco.integrator->has_theta ? p->theta : s->visco.integrator->theta;
  s->visco.initial = p->iteration == 1;
  s->visco.substeps = p->substeps == 1 || p->tolerance > 0.0;
  if (p->tolerance > 0.0 && !gives_dt_min(r)) s->dt_min = 1e-6 * s->dt;
  return OK;
}
