/*
 * What a step is solved by and what it writes: solver, accuracy, tables,
 * fields.
 */
#include "model/cards/cards.h"

#include "base/memory.h"

#include <string.h>

static const char *solver_name(const void *ctx, int i) {
  (void)ctx;
  if (i == 0) return "AUTO";
  return solver_list[i - 1] == NULL ? NULL : solver_list[i - 1]->name;
}

plugin names_solver(const reading *r) {
  const card_options *p = r->param;
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

/* The first increment starts from a coarser mesh of a geometry. */
static void take_nested(const reading *r, const card_options *p, step *s) {
  const char *file = r->m->mesh.file;
  if (!p->nested) return;
  s->nested = s == r->m->steps && file != NULL && mesh_is_program(file);
  if (!s->nested)
    report_idle(r, "NESTED", "the first step and a .geo in *MESH");
}

status apply_solver(reading *r) {
  const card_options *p = r->param;
  step *s = open_step(r);
  if (s->solver_at.file != NULL) {
    message_add(r->m->log, P2011, &r->card->at,
                "a step has one *SOLVER card, this is its second");
    return OK;
  }
  s->solver_at = r->card->at;
  s->solver.ops = solver_find(p->method);
  s->balanced = p->tol < 0.0;
  s->share = p->share;
  s->solver.tol = s->balanced ? TOL_DEFAULT : p->tol;
  s->solver.max_iter = p->max_iter;
  s->solver.limit_max_iter = p->limit_max_iter;
  s->solver.stiffness = p->stiffness;
  s->solver.max_memory = p->max_memory;
  if (p->stiffness != STIFFNESS_AUTO && p->max_memory > 0.0)
    report_idle(r, "MAX_MEMORY", "STIFFNESS=AUTO");
  take_nested(r, p, s);
  s->check = p->check;
  if (!s->balanced && p->share != 0.05) report_idle(r, "SHARE", "TOL=BALANCED");
  if (r->plugin == NULL) return OK;
  PASS_GET(s->solver_param, memory_new(1, r->plugin_size));
  memcpy(s->solver_param, r->plugin, r->plugin_size);
  s->solver.param = s->solver_param;
  return OK;
}

/* Its limits count with a target of the energy norm, or of a *GOAL. */
static void take_target(const reading *r, const card_options *p) {
  accuracy_target *t = &r->m->accuracy.target;
  const int limited = p->max_cpu > 0.0 || p->max_memory > 0.0 ||
                      p->max_passes != MAX_PASSES_DEFAULT;
  if (p->target > 0.0 || (limited && model_targeted_goal(r->m) != NULL)) {
    const double percent = p->target > 0.0 ? p->target : t->percent;
    *t = (accuracy_target){percent, p->max_cpu, p->max_memory, p->max_passes};
    return;
  }
  if (p->max_cpu > 0.0) report_idle(r, "MAX_CPU", "TARGET=");
  if (p->max_memory > 0.0) report_idle(r, "MAX_MEMORY", "TARGET=");
  if (p->max_passes != MAX_PASSES_DEFAULT)
    report_idle(r, "MAX_PASSES", "TARGET=");
}

status apply_accuracy(reading *r) {
  const card_options *p = r->param;
  step *s = open_step(r);
  if (s->accuracy.given)
    message_add(r->m->log, P2011, &r->card->at,
                "a step has one *ACCURACY card, this is its second");
  s->accuracy.given = 1;
  s->accuracy.at = r->card->at;
  s->accuracy.no_solver = !p->solver;
  s->accuracy.mesh = p->mesh;
  s->accuracy.time = p->time > 0 || p->target > 0.0;
  s->accuracy.time_balanced = p->time == TIME_BALANCED;
  s->accuracy.time_share = p->time_share;
  if (s->accuracy.time_balanced || p->target > 0.0)
    s->accuracy.mesh = MESH_ERROR_YES;
  s->accuracy.theorems = p->theorems;
  if (!s->accuracy.time_balanced && p->time_share != 0.1)
    report_idle(r, "TIME_SHARE", "TIME=BALANCED");
  take_target(r, p);
  return OK;
}

#define PRINT_WORD(name, help) " " #name
status apply_print(reading *r) {
  const card_options *p = r->param;
  step *s = open_step(r);
  int any = 0;
  s->print.given = 1;
  for (int i = 0; i < PRINT_COUNT; ++i) {
    if (!p->print[i]) continue;
    any = 1;
    PASS_GROW(s->print.requests, s->print.n, s->print.cap);
    print_request *q = &s->print.requests[s->print.n++];
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
  if (p->points != NULL && p->frequency != 1)
    report_idle(r, "FREQUENCY", "no TIME POINTS=");
  if (!any && !r->misread)
    message_add(r->m->log, P2005, &r->card->at,
                "*PRINT names no table:" PRINT_LIST(PRINT_WORD));
  return OK;
}

status apply_output(reading *r) {
  const card_options *p = r->param;
  step *s = open_step(r);
  s->output.given = 1;
  s->output.at = r->card->at;
  s->output.frequency = p->hdf5 ? p->frequency : -1;
  s->output.condensed = p->condensed == 1 ? p->frequency : -1;
  if (!p->hdf5 && p->condensed != 1 && p->frequency != 1)
    report_idle(r, "FREQUENCY", "HDF5=YES or CONDENSED=FCLIB");
  return OK;
}

status apply_restart(reading *r) {
  const card_options *p = r->param;
  step *s = open_step(r);
  s->restart.given = 1;
  s->restart.at = r->card->at;
  s->restart.frequency = p->frequency;
  return OK;
}
