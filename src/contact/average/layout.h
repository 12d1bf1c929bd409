/*
 * Where the distances of an average are measured: the patch itself, or its
 * lines laid out straight. Inside src/contact/average only.
 */
#ifndef PROTIS_AVERAGE_LAYOUT_H
#define PROTIS_AVERAGE_LAYOUT_H

#include "contact/average/average.h"

typedef struct layout {
  int dim, n_face, n_rim;
  double *x;      /* [dim*n_node] place of a node, m */
  double *corner; /* [dim*dim*n_face] corners of the faces, m */
  double *loop;   /* [n_node] length of the closed line of a node laid out
                     straight, 0: none; or NULL */
  double *rim;    /* [dim*(dim-1)*n_rim] end points (edges) of the patch that
                     lie on no mirror, m */
  int has_mirror[3];
  double mirror[3]; /* place of the mirrors by axis, m */
  double near;      /* nearer to a mirror is on it, m */
} layout;

status layout_new(const average_patch *patch, const average_rule *rule,
                  layout *out);
void layout_free(layout *l); /* accepts all-zero */

#endif
