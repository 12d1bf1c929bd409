/*
 * Errors of goals: what a quantity J of the solution, a force, a peak, a
 * displacement, is in error by the mesh and by the contact solver, with its
 * sign (Becker, Rannacher 2001, Acta Numerica 10, 1-102; Blum, Suttmeier 2000,
 * Calcolo 37, 65-77, for contact). The adjoint is that of the contact problem
 * linearised at its solution, with the unsymmetric rows of Coulomb's law.
 */
#pragma once

#include "accuracy/space.h"
#include "contact/contact.h"

/* What an estimate is worth. */
typedef enum {
  GOAL_RELIABLE,
  GOAL_CONTACT_END,  /* the mesh is too coarse where the contact ends */
  GOAL_SUPPORT_END,  /* the same of a support, or in an inner corner */
  GOAL_NO_SLIP,      /* work of friction, where no node slips so far */
  GOAL_FEW_NODES,    /* three closed nodes or less */
  GOAL_FEW_ELEMENTS, /* round the tip of a crack */
  GOAL_COARSE,       /* few nodes of the mesh are inside the body */
  GOAL_LOCKED,       /* elements lock near nu = 1/2 */
  GOAL_FRONT,        /* an integral round the front of a crack in space */
  GOAL_CANCELS,      /* parts of opposite sign, of which little is left */
  GOAL_NO_HISTORY,   /* errors of the increments before are not in it */
  GOAL_NOT_COVERED,  /* by the estimate; the value stands */
  GOAL_NO_PEAK,  /* the largest pressure is at an edge: it may be infinite */
  GOAL_NO_END,   /* the contact reaches the end of its surface */
  GOAL_NO_ZONE,  /* nothing is closed, or too few nodes */
  GOAL_NO_FACTOR /* no space for a domain at the front of the crack */
} goal_verdict;
const char *goal_verdict_word(goal_verdict v); /* one word */
const char *goal_verdict_text(goal_verdict v);

/* A goal and its errors, in its unit; NAN: none. */
typedef struct goal_result {
  double value;  /* J_h */
  double error;  /* signed, of the mesh: J less J_h */
  double solver; /* the same of the contact solver */
  double band;   /* half of it, round value + error */
  double ends;   /* -, share of elements where the contact or a support ends */
  double cpu;    /* s, CPU time for it so far */
  double radius; /* m, of the domain of a factor in the plane; 0: of none */
  double size;   /* of all factors there */
  goal_verdict verdict;
} goal_result;
/* Reals alone; of a sum over the increments the sums of theirs. */
typedef struct goal_estimate {
  double error;     /* J of the solution less J_h, of the mesh, unit of J */
  double magnitude; /* sum of the magnitudes of the parts of elements */
  double product;   /* sum over the elements of |e_u| |e_y| */
  double ends;      /* the same where the contact or a support ends */
  double supports;  /* of that what is not at contact ends */
  double sharp;     /* of ends what GOAL_END_OF_SUPPORT has */
  double near;      /* the same of the elements next to those of sharp */
  double twice;   /* by recovered stresses of both less error, round hollows */
  double hollow;  /* sum of the magnitudes of that where edges are few */
  double history; /* sum of the magnitudes by the increments before */
  double hoop;    /* by the hoop strains of axisymmetric elements, which the
                     stiffness takes at their mean radius */
  double few;     /* |error| of increments with few closed nodes */
} goal_estimate;
/* *sum += *e. */
void goal_estimate_add(const goal_estimate *e, goal_estimate *sum);
/* The result of an estimate but for value, solver and cpu. */
goal_result goal_evaluate(const goal_estimate *e);

/*
 * The linearised problem of (u, r): nodes closed, stuck and sliding remain so.
 * On the free unknowns F it is M du_F = df_F,
 *
 *   M = A_FF + e B A_nF + kappa (I - e e')   (the last two on slip),
 *
 * e the direction of the friction force, kappa = g/|slip| in 3-D. With j and
 * psi the derivatives of J by displacements and contact forces,
 *
 *   M' w = (j + A psi)_F,   y = w - psi,   w_n = B' (e.w_t) on closed nodes.
 */
typedef struct contact_adjoint contact_adjoint;
/* *out is new; NULL if the matrix is singular. cp, u, r [m] are borrowed; cp
 * has its matrix or operator. ERR_MEMORY. */
status contact_adjoint_new(const contact_problem *cp, const double *u,
                           const double *r, contact_adjoint **out);
/* y[m] of j[m], psi[m]; psi counts where a force can change. *solver: J of the
 * discrete solution less J of (u, r), to first order. NAN: not solved. */
status contact_adjoint_solve(contact_adjoint *a, const double *j,
                             const double *psi, double *y, double *solver);
/* [m] derivative of the J solved last by the positions of stick. */
const double *contact_adjoint_stick(const contact_adjoint *a);
/* du[m]: the change of u by loads df[m] and by positions of stick that are
 * stick[m] further. */
status contact_adjoint_change(contact_adjoint *a, const double *df,
                              const double *stick, double *du);

/* An edge of the contact surface, node ids a < b. */
typedef struct contact_edge {
  int a, b;
  int closed, stuck; /* both ends are */
  double n[3];       /* unit normal, the mean of its ends */
  double out[3];     /* from its middle to the surface of the body, m */
  double excess;     /* what u along n is there more than the mean of its ends,
                        m */
  double rough;      /* how the gap differs from the parabola of excess, m */
  double stick[3];   /* what u was in its bubble where it began to stick, m */
  double weight;     /* integral of its bubble over the surface, m2 */
  int other[2];      /* nodes of the opposite lip of a crack, in the order of a,
                        b; -1: on an obstacle */
} contact_edge;

/* An edge of the border of the body that is curved, node ids a < b. */
typedef struct bent_edge {
  int a, b;
  double out[3]; /* from its middle to the surface of the body, m */
} bent_edge;

/* An edge that a support holds, node ids a < b, whose displacement is no linear
 * function along it. */
typedef struct given_edge {
  int a, b;
  double bend[3]; /* in its middle less the mean of its ends, m */
} given_edge;

/* A derivative by displacement gradients, of a crack (fracture.h); borrowed. */
typedef struct goal_flux {
  int n;
  const int *elem;  /* [n] */
  double corner;    /* barycentric coordinate of point k in corner k, - */
  const double *at; /* [n*(dim+1)*dim*dim] at point k, unit of J per volume */
} goal_flux;

/* Next to a node the contact changes its status; stresses are infinite, by a
 * support, an inner corner, or the border of a contact that sticks. */
enum {
  GOAL_END_OF_CONTACT = 1,
  GOAL_END_OF_SUPPORT = 2,
  GOAL_NEAR_SUPPORT = 4, /* of an element with such a node */
  GOAL_HOLLOW = 8,    /* of a hollow of the border, or, in the plane, a curved
                         interface */
  GOAL_FEW_EDGES = 16 /* the same, less than 24 of them round a circle */
};

/* What the surface of the body does at the solution. */
typedef struct goal_surface {
  int n_edge;
  contact_edge *edge;  /* [n_edge] sorted by a, b */
  unsigned char *ends; /* [n_node] bits */
  int n_given;
  int n_bent;
  bent_edge *bent;      /* [n_bent] sorted by a, b */
  given_edge *given;    /* [n_given] the same; NULL: none */
  unsigned char *front; /* [n_node] 1: of the front of a crack, round which u
                           goes like the root of the distance; NULL: no crack */
  int *closed, *whole;  /* [n_contact] closed nodes; faces with them alone */
  int n_closed;         /* of all contacts */
  int is_missed; /* 1: no node of a contact is closed, but its gap may end
                    between nodes */
} goal_surface;

/* The solution. All is borrowed. */
typedef struct goal_solution {
  const domain *d;
  const double *u;     /* [dim*n_node] m */
  const double *sigma; /* [ns*n_elem] Pa */
  const goal_surface *surface;
  int has_flux;   /* 1: some J has a flux */
  int has_mean;   /* 1: some J may be a mean of displacements */
  int has_energy; /* 1: some J is the energy */
  int rubs;       /* 1: nodes slip whose friction follows pressures */
} goal_solution;

typedef struct goal_estimator goal_estimator;
/* Recovers what belongs to the solution; s and all in it are borrowed until
 * memory_free. ERR_MEMORY, ERR_INTERNAL as space_estimate. */
status goal_estimator_new(const goal_solution *s, space_recovery *recovery,
                          goal_estimator **out);
double goal_estimator_energy(const goal_estimator *e); /* |e_u|^2, J */
/* [dim*n_edge] what u is in the bubbles of the contact edges, m; of a crack,
 * less the mean of both lips. */
const double *goal_estimator_edges(const goal_estimator *e);
/* d[dim] what u is in the bubble of the edge from node a to b of an element, m;
 * has_mean. */
void goal_estimator_bubble(const goal_estimator *e, int elem_id, int a, int b,
                           double *d);
/* J of u, what u is in the bubbles too, by its derivative f. */
double goal_estimator_flux(const goal_estimator *e, const goal_flux *f);
/* F[dim*n_node]: forces that what u is in the bubbles exerts on the mesh; under
 * them the nodes move by their error. */
void goal_estimator_force(goal_estimator *e, double *F);
/* F[dim*n_node] of the stress of the adjoint of goal_estimate_find. */
void goal_estimator_adjoint_force(const goal_estimator *e, double *F);
/*
 * The error by the adjoint y[dim*n_node] of a J with the derivative integral of
 * tau : e(v), tau[ns*n_elem] (or NULL: zero), besides values at nodes:
 *
 *   sum over edges of R d,   R = integral of (tau - sigma(y)) : e(b),
 *
 * b = 4 la lb the bubble of the edge and d the part of u in it, from recovered
 * gradients; on closed edges d_n is that of the gap, and d_t where they
 * stick what it was when they began to. In axisymmetric elements at points, as
 * strains vary within them. of_u: J is the energy, tau the stress of u, and the
 * error has its square. product[n_elem] or NULL: the share of each element in
 * out->product.
 */
status goal_estimate_find(goal_estimator *e, const double *y, const double *tau,
                          int of_u, double *product, goal_estimate *out);
