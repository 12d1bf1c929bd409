/*
 * The dual basis on the covered part of one slave face. Inside
 * src/contact/mortar only.
 */
#ifndef PROTIS_MORTAR_DUAL_H
#define PROTIS_MORTAR_DUAL_H

#include "contact/mortar/clip.h"

/* A point of the quadrature. */
typedef struct sample {
  double offset[2]; /* [dim-1] from the reference point, m */
  double weight;    /* > 0, m2 */
  double phi[3];    /* [dim] P1 functions of the slave */
  double psi[3];    /* [dim] dual functions, 0 of nodes that are not kept */
  double other[3];  /* [dim] P1 functions of the master */
  int partner;
} sample;

/*
 * psi of each point for the nodes with kept[dim] != 0, from the weights, so
 * that sum psi = 1 and sum weight psi_j phi_k = delta_jk d_j for kept j, k; d
 * [dim] is the sum of weight phi. corner: nodes of the face less the reference
 * point. The formula is exact whatever the part is that the points stand for;
 * the offsets are what keeps it so on a small one.
 */
void dual_basis(int dim, const cell *corner, const int *kept, int n,
                sample *points, double *d);

#endif
