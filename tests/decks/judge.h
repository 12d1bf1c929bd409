/*
 * Is the answer of a random deck one? All is recomputed from the tables and
 * the data of the deck, by P1 elements and contact geometry of the test.
 */
#pragma once

#include "decks/deck.h"
#include "decks/tables.h"

/* Loads of the decks are near 1: what is below is none. */
#define LEAST_FORCE 1e-2

/* What is compared, each over a scale of its own. */
typedef enum {
  OF_TEMPERATURE, /* element temperatures, of the largest                   */
  OF_STRAIN,      /* strains of u, of the largest                           */
  OF_STRESS,      /* E (e - e0), of the largest product                     */
  OF_BALANCE,     /* forces of the nodes, of the largest                    */
  OF_SUPPORT,     /* prescribed displacements                               */
  OF_FRAME,       /* u_n, areas, components of the contact forces           */
  OF_GAP,         /* gap to the obstacle                                    */
  OF_NORMAL,      /* unilateral condition, or the given force               */
  OF_LIMIT,       /* sliding limits                                         */
  OF_AVERAGE,     /* those of nonlocal friction, to the test's quadrature   */
  OF_MEAN,        /* the same with KERNEL=CONSTANT, which jumps             */
  OF_SLIP,        /* slip printed                                           */
  OF_FRICTION,    /* friction condition                                     */
  OF_TOTAL,       /* resultant of the contacts                              */
  OF_ENERGY,      /* energies and works, of the magnitudes in their sums    */
  CHECKS
} check_kind;
extern const char *const check_name[CHECKS];

typedef struct judgement {
  double worst[CHECKS]; /* over the tolerance: above 1 is a fault      */
  char where[CHECKS][120];
  int touching, slipping, sticking; /* contact nodes over all increments    */
} judgement;

/* Keep the worst; what is no number is a fault. */
void judge_note(judgement *q, check_kind kind, double miss, double scale,
                const snapshot *s, int no);

/* An increment with what its equilibrium is checked against. */
typedef struct judged {
  const random_deck *d;
  const snapshot *first, *now, *before; /* before: NULL for the first       */
  double residual, old_residual; /* that the program reached, -           */
  double largest;                /* sum of force magnitudes at a node        */
  int step;                      /* from 0                                   */
  judgement *q;
  double *u, *old_u;    /* [dim*n_node]                             */
  double *force, *size; /* [dim*n_node]; [n_node] sum of magnitudes */
  double *stiffness;    /* [n_node] of the node against a motion    */
} judged;

/* sta: text of JOB.sta. */
void judge(const random_deck *d, const tables *t, const char *sta,
           judgement *q);
void judge_body(judged *x);
void judge_contacts(judged *x);

/* Gauss points of a simplex of n nodes: weights (sum 1) and barycentric
 * coordinates; their number. */
enum { GAUSS_MOST = 27 };
int simplex_gauss(int n, double weight[GAUSS_MOST], double at[GAUSS_MOST][4]);
/* Outward normal times the measure of a face. */
void face_vector(const solid *s, int face, double v[3]);
/* Integrals of the P1 functions over a face, thickness or turn included. */
void face_shares(const random_deck *d, int face, double w[3]);

/* Nodes of a contact that carry pressures p under nonlocal friction. */
typedef struct averaged_contact {
  const random_deck *d;
  const deck_friction *f;
  int group, n;
  const int *node; /* [n]                                                   */
  const double *p; /* [n]                                                   */
} averaged_contact;
/* R(p) by the definition of the average; open[i] = 1: the disc just meets the
 * edge of the contact. */
void judge_average(const averaged_contact *in, double *mean,
                   unsigned char *open);
