/*
 * Given sliding limit (Tresca): |sigma_T| <= g(x, t), per node g times the
 * tributary area. The problem of one pass of the fixed point (CPR98, 2.3).
 */
#include "contact/friction.h"

static status tresca_limit(const friction_card *card, const contact_surface *s,
                           int n_node, const int *node, double t,
                           friction_limit *out) {
  status st = OK;
  for (int k = 0; k < n_node; ++k) {
    int i = node[k];
    double g;
    if (surface_is_corner(s, i)) continue;
    TRY(friction_value(card, s, i, t, &g));
    out->g0[i] = g * s->area[i];
  }
done:
  return st;
}

const friction_ops tresca_friction = {
    .name = "TRESCA",
    .reference = "Cocu, Pratt, Raous 1998, problem (2.14) with given g",
    .help = "given sliding limit g(x, t), whatever the pressure",
    .value_name = "g",
    .value_unit = "force/length^2",
    .param_size = 0,
    .options = friction_no_options,
    .limit = tresca_limit};
