/*
 * No friction: the sliding limit is zero.
 */
#include "contact/friction.h"

static status no_limit(const friction_card *card, const contact_surface *s,
                       int n_node, const int *node, double t,
                       friction_limit *out) {
  (void)card, (void)s, (void)n_node, (void)node, (void)t, (void)out;
  return OK;
}

const friction_ops none_friction = {
    .name = "NONE",
    .reference = "Cocu, Pratt, Raous 1998, (2.6) with F_T = 0",
    .help = "frictionless: the obstacle carries no tangential force",
    .value_name = NULL,
    .value_unit = NULL,
    .param_size = 0,
    .options = friction_no_options,
    .limit = no_limit};
