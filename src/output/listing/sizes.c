/*
 * Sizes of model and equations.
 */
#include "output/listing/job.h"

int job_sizes(const job *j, size_row rows[SIZE_ROWS]) {
  const condense_info *info = &j->run->facts.info;
  int n = 0;
  rows[n++] = (size_row){"dimension", j->m->dim};
  if (!j->m->problem.given) {
    rows[n++] = (size_row){"nodes", j->msh->n_node};
    rows[n++] = (size_row){"elements", j->msh->n_elem};
    rows[n++] = (size_row){"groups", j->msh->n_group};
    rows[n++] = (size_row){"materials", j->m->n.material};
    rows[n++] = (size_row){"sections", j->m->n.section};
    rows[n++] = (size_row){"contacts", j->m->n.contact};
  }
  rows[n++] = (size_row){"steps", j->m->n.step};
  int model_rows = n;
  if (j->run->facts_known) {
    if (!j->m->problem.given) rows[n++] = (size_row){"bodies", info->bodies};
    rows[n++] = (size_row){"unknowns", (double)info->unknowns};
    rows[n++] = (size_row){"contact nodes", j->run->facts.n_contact_node};
    if (j->run->facts.n_left_out > 0)
      rows[n++] = (size_row){"  out of reach", j->run->facts.n_left_out};
    rows[n++] = (size_row){"contact unknowns", (double)info->contact_unknowns};
    if (!j->m->problem.given)
      rows[n++] = (size_row){"factor entries", (double)info->factor_entries};
    if (j->m->effects & EFFECT_NONLOCAL)
      rows[n++] = (size_row){"average entries", j->run->facts.average_entries};
  }
  rows[n] = (size_row){NULL, 0};
  return model_rows;
}
