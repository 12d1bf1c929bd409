/*
 * Coulomb friction, local: |R_T| <= mu(x, t) p with the normal force p of the
 * same node, so that B is diagonal (CPR98, 2.6 with the identity for R).
 */
#include "base/memory.h"
#include "contact/friction.h"

static status coulomb_limit(const friction_card *card, const contact_surface *s,
                            int n_node, const int *node, double t,
                            friction_limit *out) {
  status st = OK;
  sparse_rows rows = {.n = n_node};
  int n_entry = 0;
  NEW(rows.start, n_node + 1);
  NEW(rows.col, n_node);
  NEW(rows.val, n_node);
  for (int k = 0; k < n_node; ++k) {
    if (!surface_is_corner(s, node[k])) {
      TRY(friction_value(card, s, node[k], t, &rows.val[n_entry]));
      rows.col[n_entry++] = node[k];
    }
    rows.start[k + 1] = n_entry;
  }
  TRY(friction_add_rows(out, s->n, node, &rows));
done:
  memory_free(rows.start);
  memory_free(rows.col);
  memory_free(rows.val);
  return st;
}

const friction_ops coulomb_friction = {
    .name = "COULOMB",
    .reference = "Cocu, Pratt, Raous 1998, (2.6) with R = identity",
    .help = "sliding limit mu(x, t) times the normal force of the node",
    .value_name = "mu",
    .value_unit = "-",
    .param_size = 0,
    .options = friction_no_options,
    .limit = coulomb_limit};
