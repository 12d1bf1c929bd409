/*
 * One P1 element: gradients of its shape functions and its stiffness. Private
 * to src/fem.
 */
#pragma once

#include "fem/fem.h"

/* E of an element with what is averaged over its cluster taken out: R'E R,
 * R = I - share/3 m m', m the unit tensor; m_E[ns] = R'E m, *bulk = m'E m. */
void element_rest(const domain *d, int elem_id, double *E, double *m_E,
                  double *bulk);
/* Blocks K_ab = w B_a' E B_b [dim*dim], column major, of the vertex pairs
 * a >= b in the order (0,0), (1,0), (1,1), (2,0), ... N/m. In a
 * cluster with the E of element_rest(): what its average adds is not there. */
void element_stiffness(const domain *d, int elem_id, double *blocks);
/* rest = F - sum B' E B u w, global components [dim*n_node]. The strains of
 * each element are formed first: so digits of a soft part next to a stiff one
 * are not lost. */
void domain_residual(const domain *d, const double *u, const double *F,
                     double *rest);
