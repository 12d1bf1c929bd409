/*
 * Decks with *CONDENSED PROBLEM: what may stand beside it.
 */
#include "model/keyword/parts.h"

#include "base/memory.h"

#include <string.h>

/* Cards that may stand beside *CONDENSED PROBLEM. */
static int goes_with_problem(const char *name) {
  static const char *const names[] = {
      "HEADING", "PARAMETER", "INCLUDE",  "LEGACY", "UNITS",  "STEP",
      "STATIC",  "SOLVER",    "ACCURACY", "PRINT",  "OUTPUT", "END STEP"};
  if (strcmp(name, "CONDENSED PROBLEM") == 0) return 1;
  for (size_t k = 0; k < sizeof names / sizeof *names; ++k)
    if (strcmp(name, names[k]) == 0) return 1;
  return 0;
}

static void check_problem_cards(const reading *r) {
  const model *m = r->m;
  for (int i = 0; i < m->deck->n_card; ++i) {
    const card *c = &m->deck->cards[i];
    const keyword *row = keyword_find(c->name);
    if (row != NULL && !goes_with_problem(c->name))
      message_add(m->log, P2034, &c->at,
                  "*%s has no place beside *CONDENSED PROBLEM, line %d",
                  c->name, m->problem_at.line_no);
  }
  for (int i = 1; i < m->n_step; ++i)
    message_add(m->log, P2034, &m->steps[i].at,
                "a condensed problem is solved in one step, this is number %d",
                i + 1);
}

static void check_problem_tables(const reading *r, const step *s) {
  for (int i = 0; i < s->n_print; ++i)
    if (s->prints[i].table != PRINT_CONTACT || s->prints[i].group != NULL)
      message_add(r->m->log, P2034, &s->prints[i].at,
                  "a condensed problem has no mesh: only *PRINT, CONTACT "
                  "without GROUP= has rows");
}

/* The bound of the error factors the matrix, which costs more than many
 * solutions: only on request. */
static void check_problem_accuracy(const reading *r, step *s) {
  int others = s->mesh_error || s->time_error || s->theorems ||
               r->m->target.percent > 0.0;
  if (!s->has_accuracy)
    s->no_solver_error = 1;
  else if (others)
    message_add(r->m->log, P2034, &s->accuracy_at,
                "a condensed problem has no mesh: of *ACCURACY only SOLVER= "
                "has a place beside it");
}

status model_finish_problem(reading *r) {
  check_problem_cards(r);
  step *s = &r->m->steps[0];
  check_problem_tables(r, s);
  check_problem_accuracy(r, s);
  s->kind = STEP_STATIC;
  if (!(s->total > 0.0)) s->total = 1.0;
  s->dt = s->dt_min = s->total;
  s->output_frequency = -1;
  s->restart_frequency = -1;
  if (s->n_print > 0) return OK;
  PASS_GROW(s->prints, s->n_print, s->cap_print);
  s->prints[s->n_print++] = (print_request){
      .table = PRINT_CONTACT, .group_id = -1, .frequency = 1, .at = s->at};
  return OK;
}
