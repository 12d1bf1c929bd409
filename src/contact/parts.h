/* What the files of the contact problem share. */
#ifndef PROTIS_CONTACT_PARTS_H
#define PROTIS_CONTACT_PARTS_H

#include "contact/contact.h"

enum { CHUNK = 64 }; /* rows and columns of a product kept on the stack */

/* The larger, the smaller of two, NaN if one is. */
double larger(double a, double b);
double smaller(double a, double b);
/* The largest diagonal entry. */
double contact_largest_diagonal(const contact_problem *cp);
/* Stiffness of a node along its normal and in its tangent plane, N/m; the
 * largest diagonal where it has none. */
typedef struct node_step {
  double n, t;
} node_step;
node_step contact_step(const contact_problem *cp, int node_id,
                       double largest_diagonal);
/* Length of v[n], n = 0, 1 or 2. */
double contact_length(int n, const double *v);

#endif
