/*
 * Initial displacements from the deck: *INITIAL CONDITIONS, TYPE=DISPLACEMENT.
 */
#include "run/start/start.h"

#include "base/memory.h"
#include "run/start/end_state.h"

#include <math.h>
#include <string.h>

status start_report_new(const mesh *msh, start_report *report) {
  PASS_NEW(report->defect, msh->n_node);
  PASS_NEW(report->kind, msh->n_node);
  return OK;
}

void start_report_free(start_report *report) {
  memory_free(report->defect);
  memory_free(report->kind);
  memset(report, 0, sizeof *report);
}

static status set_line(const model *m, const mesh *msh, const initial *line,
                       double *u) {
  const mesh_group *g = &msh->group[line->group_id];
  size_t dim = (size_t)msh->dim;
  for (int k = 0; k < g->n_node; ++k) {
    size_t node = (size_t)g->node_id[k];
    double x[3] = {0.0, 0.0, 0.0};
    memcpy(x, msh->x + dim * node, dim * sizeof *x);
    double value = quantity_value(&line->value, x, 0.0);
    u[dim * node + (size_t)line->component] = value;
    if (isfinite(value)) continue;
    message_add(m->log, P2041, &line->at,
                "*INITIAL CONDITIONS: component %d is %g at node %zu (%g, %g, "
                "%g)",
                line->component + 1, value, msh->node_no[node], x[0], x[1],
                x[2]);
    RAISE(ERR_DECK, "an initial displacement is no number");
  }
  return OK;
}

status start_displacements(const model *m, const mesh *msh, double *u,
                           start_report *report) {
  const start_card *asked = &m->initial.start;
  if (asked->file != NULL) {
    PASS(end_state_read(asked->file, msh, &asked->file_at, m->log, u,
                        &report->source_time));
    report->source = asked->file_name;
  }
  for (int i = 0; i < m->n.initial; ++i)
    if (m->initial.lines[i].type == INITIAL_DISPLACEMENT)
      PASS(set_line(m, msh, &m->initial.lines[i], u));
  return OK;
}
