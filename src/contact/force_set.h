/*
 * Admissible contact forces of a problem whose compliance is known, by its
 * entries or by solves with an operator: common parts of the methods for them.
 */
#pragma once

#include "contact/contact.h"

/*
 * Compliance form with a given limit g: the forces are sought in the convex set
 *   r_n <= 0,  |r_t| <= g,  r = 0 where nothing acts,
 * and x = W r + q - origin is the gradient of the energy they minimise. D is a
 * diagonal metric, equal in the tangents of a node, so that the projection on
 * the set in this metric is the plain one node by node.
 */
typedef enum { NO_FORCE, PUSH, IN_DISC } force_part;
/* Where a force can act, and the displacement it acts from, m: gap, stick
 * position or second obstacle. part[m], origin[m]. */
void force_parts(const contact_problem *cp, unsigned char *part,
                 double *origin);
typedef struct force_set {
  const contact_problem *cp; /* of the last fit */
  double *D;                 /* [m] 1/W_ii, of an operator its diagonal; the
                                mean in a tangent plane, N/m */
  double step;               /* -, 1/bound of the spectrum of D W */
  double *origin;            /* [m] gap, stick position, second obstacle, m */
  unsigned char *part;       /* [m] force_part */
  unsigned char *rim;        /* [n] 1: the last force projected has |r_t| = g */
  int symmetric;             /* W is, but for rounding */
  sparse_rows rows;          /* of W if most of it is zero, else all zero */
  double *load, *defect;     /* [m] work */
  double *image;             /* [m] the same, of an operator */
} force_set;
status force_set_new(const contact_problem *cp, force_set **out);
/* Parts and origins of a problem with the same W; an operator is prepared for
 * products until its rows are set otherwise. Errors: ERR_MEMORY. */
status force_set_fit(force_set *s, const contact_problem *cp);
/* Into the set; a force deeper than g by less than the share "margin" counts
 * as lying on the rim. */
void force_set_project(const force_set *s, double margin, double *r);
void force_set_product(const force_set *s, const double *r,
                       double *u); /* W r */
/* Largest eigenvalue of D W, from below by the power method. v, z[m]: work. */
double force_set_spectrum(const force_set *s, double *v, double *z);
/* All entries of W that are not zero. */
status compliance_rows(const contact_problem *cp, sparse_rows *rows);
/* u = W (r + f), mended once by A; without A: u = W r + q. */
void force_set_displacement(const force_set *s, const double *r, double *u);
