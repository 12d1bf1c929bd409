/*
 * Problems that come without a mesh (*CONDENSED PROBLEM): one solve, passed to
 * the outputs as one increment.
 */
#ifndef PROTIS_DISCRETE_DISCRETE_H
#define PROTIS_DISCRETE_DISCRETE_H

#include "exchange/exchange.h"
#include "run/history/history.h"

/*
 * One increment, no mesh, no stiffness. The state has the unknowns in the signs
 * of contact.h, of a plain LCP w in uc and z in rc. Errors: as history_run.
 */
status condensed_run(const model *m, const exchange_problem *p,
                     const history_sink *sink, int *unsettled);

#endif
