/*
 * Coulomb friction, local: |R_T| <= mu(x, t) p with the normal force p of the
 * same node, so that B is diagonal (CPR98, 2.6 with the identity for R).
 */
#include "contact/friction.h"

const friction_ops coulomb_friction = {
    .name = "COULOMB",
    .reference = "Cocu, Pratt, Raous 1998, (2.6) with R = identity",
    .help = "sliding limit mu(x, t) times the normal force of the node",
    .value_name = "mu",
    .value_unit = "-",
    .param_size = 0,
    .options = friction_no_options,
    .limit = friction_pressure_limit};
