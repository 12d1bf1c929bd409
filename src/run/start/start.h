/*
 * The initial state: displacements u_0, and whether they are compatible, that
 * is in equilibrium with the loads at time 0 under the unilateral condition and
 * the friction condition of a body at rest (CPR98, 3.3 and 3.8, both with >=):
 *
 *   interior   K u_0 = F                     supports   u_0 as prescribed
 *   contact    r = K u_0 - F: u_n <= gap, r_n <= 0, r_n (u_n - gap) = 0,
 *              |r_t| <= g
 */
#pragma once

#include "fem/fem.h"
#include "model/model.h"

/* Largest ratio of a compatible start, -. */
extern const double start_tolerance;

typedef enum {
  DEFECT_NONE,
  DEFECT_INTERIOR, /* internal forces and loads do not balance */
  DEFECT_SUPPORT,  /* not where *BOUNDARY holds it */
  DEFECT_NORMAL,   /* penetrates, pulls, or pushes across a gap */
  DEFECT_SLIDING   /* more tangential force than the sliding limit */
} defect_kind;
const char *defect_text(defect_kind kind);

typedef struct start_input {
  const mesh *mesh;
  const unsigned char *fixed;     /* [dim*n_node] */
  const double *u, *ud, *R;       /* [dim*n_node] m, prescribed m; K u - F, N */
  const double *stiffness;        /* [dim*n_node] force of a unit displacement
                                     of a support, N/m */
  const contact_surface *surface; /* NULL: no contact */
  const tie_set *ties;            /* NULL: none; R is that of their masters */
  const contact_problem *cp;      /* of time 0, stick at u_0 */
  const double *uc;               /* [m] m */
  const double *given;            /* [n] given normal force, N; < 0: none; NULL
                                     all none */
  double load;                    /* largest force of loads and elements, N */
} start_input;

typedef struct start_report {
  double *defect;      /* [n_node] N */
  unsigned char *kind; /* [n_node] defect_kind */
  double worst, scale; /* largest defect and force, N */
  double ratio;        /* worst over scale, - */
  int node_id, n_bad;  /* of the worst; nodes above start_tolerance */
  int relaxed;         /* 1: replaced by the equilibrium of time 0 */
  const char *source;  /* file it came from, or NULL */
  double source_time;  /* s */
} start_report;

/* u_0 of the deck: the end of another run, then the lines; u[dim*n_node].
 * Errors in the log: ERR_FILE, ERR_DECK. */
status start_displacements(const model *m, const mesh *msh, double *u,
                           start_report *report);
/* Diagonal of K in global components, diagonal[dim*n_node], N/m. */
void start_stiffness(const domain *d, double *diagonal);
/* Compatibility: fills rc[m] with the contact forces of the start (N),
 * reaction[dim*n_node] with those of the supports, and the report, whose arrays
 * are there. Either array is NULL without contact or use. */
status start_test(const start_input *in, double *rc, double *reaction,
                  start_report *report);
