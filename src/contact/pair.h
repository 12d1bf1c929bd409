/*
 * Pairs of two surfaces of the mesh in a contact surface: what their nodes are
 * relative to. Private to src/contact.
 */
#ifndef PROTIS_CONTACT_PAIR_H
#define PROTIS_CONTACT_PAIR_H

#include "contact/surface.h"

/* Part of the unit normal that must be left when the fixed components are
 * taken out of it. */
#define PAIR_FIXED_SINE 1e-3

/* The coupling of which a normal of a node is, and its row there. */
typedef struct pair_row {
  const mortar *of; /* NULL: of an obstacle */
  int row;
} pair_row;

/* Entries of the rows so far, and room for them; all-zero before. */
typedef struct pair_links {
  int n, n_part, capacity, part_capacity;
} pair_links;

/* The row of contact node i, of the last ones before: rows[n] of its normals.
 * Its tangents are relative to the master of the first, if it has no other;
 * those that supports hold, and those at corners, to none. ERR_MEMORY. */
status pair_add_row(contact_surface *s, int i, int n, const pair_row *rows,
                    pair_links *room);
/* ERR_DECK with an error in the log if slave nodes of pairs move with
 * each other in a circle; ERR_MEMORY. */
status pairs_check_circles(const contact_surface *s, const surface_input *in,
                           message_log *log);
/* Gap of a row of the coupling along n[dim], at time 0, m. */
double pair_gap(const surface_input *in, const contact_pair *p, int row,
                const double *n);
/* What CLEARANCE or INTERFERENCE adds to the gap at x[dim] and t, m. */
double pair_change(const contact_pair *p, int dim, const double *x, double t);

#endif
