/*
 * The contact of a run on a coarser mesh of the same deck, increment by
 * increment: where the contact problems of a finer mesh may start.
 */
#pragma once

#include "contact/contact.h"
#include "contact/surface.h"

typedef struct coarser coarser;

/* *out is new (memory_free). */
status coarser_new(coarser **out);

/* An increment, of the contact frames of a surface of n nodes. */
typedef struct contact_view {
  double t;                      /* s, its end */
  const double *rc;              /* [dim*n] N */
  const double *gap;             /* [n] left open, m */
  const double *slip;            /* [n*(dim-1)] m */
  const contact_status *contact; /* [n] */
} contact_view;

/* Appends it. ERR_MEMORY. */
status coarser_add(coarser *c, const contact_surface *s, const contact_view *v);
/* The increment that ends at t, or NULL; if "next" else the first one after t.
 * Valid until the next coarser_add. */
typedef struct coarser_state coarser_state;
const coarser_state *coarser_at(const coarser *c, double t, int next);
double coarser_time(const coarser_state *x); /* s, its end */
int coarser_nodes(const coarser_state *x);

/* nearest[s->n]: of each node the nearest of the same contact, -1: there is
 * none. ERR_MEMORY. */
status coarser_match(const coarser_state *x, const contact_surface *s,
                     int *nearest);
/* State of a node; -1: open. */
contact_status coarser_contact(const coarser_state *x, int node);
/* A node, in the frame of node i of s. */
typedef struct coarser_node {
  double gap;         /* left open, m; 0 where closed */
  double traction[3]; /* force over area, N/m2; 0 where open */
  double slip[2];     /* m; 0 where it sticks */
} coarser_node;
void coarser_read(const coarser_state *x, int node, const contact_surface *s,
                  int i, coarser_node *out);
