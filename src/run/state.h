/*
 * Data of the loop over increments for the outputs: an accepted increment, the
 * facts before the first one, and the sinks.
 */
#pragma once

#include "accuracy/goal/goal.h"
#include "accuracy/solutions.h"
#include "run/start/start.h"
#include "accuracy/theorems/theorems.h"

struct run;

/* Of *REFERENCE, relative to the norm of the closed form, -; NAN: not
 * available. */
typedef struct true_error {
  int asked;
  double energy;       /* of the stresses, integral of s' inv(E) s; without
                          stresses in the card of E times all the strain */
  double displacement; /* L2 */
  double stress;       /* L2, all components of the tensor */
  double pressure;     /* L2 on the contact surface, of nodal values */
  double cpu;          /* s, CPU time for it so far */
} true_error;

/* Forces and moments of one contact: of the obstacle on the body. */
typedef struct contact_total {
  double force[3];              /* N, global components */
  double moment[3];             /* N m, about the origin; 2-D: [2] */
  double normal, tangential[2]; /* sums in the contact frame, N */
  double area;                  /* closed area, m2 */
  double pressure, penetration; /* the largest of its nodes, Pa, m; >= 0 */
  int n_open, n_slip, n_stick;
} contact_total;

/* A zone of one kind of one contact: in the plane and in axisymmetry a piece of
 * the contact line in the order of the tangent t, in 3-D all of that kind. */
typedef struct contact_zone {
  int contact_id;
  int kind;                      /* contact_status */
  int direction;                 /* sign of the slip along t, or 0; 3-D: 0 */
  double from[2], to[2], length; /* ends between the nodes, m; 3-D: 0 */
  double area;                   /* m2; times thickness, or around the axis */
} contact_zone;

typedef struct zone_list {
  int n, cap;
  contact_zone *zone; /* [n] owned */
} zone_list;

/* One contact as a loop of friction: force (in the totals) against motion. */
typedef struct contact_loop {
  double way[2];       /* mean motion of the obstacle, tangents, m */
  double mean_u_t[2];  /* mean tangential displacement of the nodes, m */
  double angle;        /* of the obstacle, rad */
  double friction;     /* J, dissipated so far, trapezoidal */
  double friction_end; /* J, the same with the limits at the increments' end */
  double start_end;    /* J, friction_end at the start of the step */
} contact_loop;

typedef struct energies {
  double strain;       /* J, now */
  double external;     /* J, work of loads and supports so far */
  double friction;     /* J, dissipated so far, trapezoidal */
  double friction_end; /* J, the same with the limits at the ends of the
                          increments; a static problem starts it again, from the
                          origin */
  double normal;       /* J, work of the normal contact forces so far: moving
                          obstacles, and by the trapezoidal rule gaps that open
                          or close within an increment */
  double thermal;      /* J, work of the stresses on thermal strain so far */
  double inelastic;    /* J, the same on inelastic strain, trapezoidal */
  double dissipated; /* J, of that lost, in the quadrature of the integrator */
  double stored;     /* J, of that stored by internal variables, now */
  double start;      /* J, strain energy the run starts with */
  double defect;     /* J, external + normal - friction - thermal - inelastic
                        - (strain - start) */
  double largest;    /* J, of the six so far: the scale of the defect */
  double rounding;   /* J, of the works in free motion so far */
} energies;

/* Bound of the error of the contact solver; where slip or strains of the
 * increments before have a part in this one, the bounds of all are added. */
typedef struct error_bound {
  int asked;
  double before;   /* sqrt(J), part of the increments before */
  double energy;   /* J, energy of the error at most; NAN: no bound */
  double relative; /* -, of that of the solution; NAN: no bound or no strain */
  double cpu;      /* s, CPU time for it so far */
  double rate;     /* contraction of the sliding limit, -; 0: none */
  const char *why; /* there is no bound; or NULL */
  double hidden;   /* -, of contact forces, by rounding of the motion */
} error_bound;

/* Rounding error of a solution (run/history/rounding.c). */
typedef struct rounding_loss {
  int found;     /* 0: not evaluated, there is no reason to */
  double norm;   /* sqrt(J), error in the energy norm */
  double energy; /* -, the same over the norm of the solution */
  double stress; /* -, error of the stresses over the largest */
  double u;      /* -, of the displacements over the largest */
} rounding_loss;

/* An estimate of an error at the end of an increment. */
typedef struct error_share {
  int asked;
  double relative; /* -, of the energy norm of the solution; NAN: unknown */
  double cpu;      /* s, CPU time for it so far */
  const char *why; /* why it is zero, unknown or too small; or NULL */
  double depth;    /* -, of the mesh: elements across the body; 0: it tells
                      nothing */
  double entered;  /* J, of what obstacles between the nodes would deform; of
                      that of the mesh */
} error_share;

/* 1: that of the mesh, which tells nothing. */
static inline int error_is_unseen(const error_share *e) {
  return e->why != NULL && e->depth < 1.0;
}

/* *SOLVER, TOL=BALANCED: where the solver stopped, and what that saved against
 * the tolerance of the default. */
typedef struct balance_report {
  int asked;
  double wanted; /* -, error of the solver that is enough; NAN: unknown */
  double tol;    /* -, residual required */
  int passes;    /* solves with ever smaller tolerances */
  double saved_iterations, saved_cpu; /* about, -; s */
} balance_report;

/* Its errors. */
typedef struct state_errors {
  error_bound error; /* of the contact solver */
  int in_doubt;      /* 1: its bound is above 10 % */
  int after_miss;    /* 1: after an increment that is not settled */
  rounding_loss rounding;
  error_share mesh_error, time_error; /* of the mesh, the increments */
  const double *elem_error; /* [n_elem] of that of the mesh, -; or NULL */
  int n_goal;
  const goal_result *goals; /* [n_goal] of *GOAL; NULL: none */
  const double
      *goal_products; /* [n_goal*n_elem] errors of solution times adjoint,
                         unit of the goal; zero: no estimate; or NULL */
  balance_report balance;
  true_error exact;              /* against *REFERENCE */
  int jumps;                     /* 1: no path of equilibria leads here */
  double jump_t;                 /* s, where the equilibrium jumps then */
  theorems_report theorems;      /* the theorems at work */
  const solution_set *solutions; /* of CHECK=; NULL: not required */
} state_errors;

typedef struct state_body {
  const double *u;               /* [dim*n_node] m */
  const double *strain, *stress; /* [ns*n_elem] -, Pa; NULL: not shown */
  const double *temperature;     /* [n_elem] or NULL: no thermal strain */
  const flow *flow;              /* elements whose law flows; NULL: none */
  const int *flow_elem;          /* [flow->n] ascending */
  const flow_state *inelastic;   /* their strains and internal variables */
  const double *reaction;        /* [dim*n_node] N, of the supports */
} state_body;

typedef struct state_contacts {
  const contact_problem *problem; /* as solved; NULL: no contact, LCP */
  const contact_surface
      *surface;          /* NULL: no contact; of a file: numbers only */
  const double *uc, *rc; /* [dim*n] contact frame, m, N */
  const double *gap;     /* [n] gap left open: gap0 - u_n, m */
  const double *slip;    /* [(dim-1)*n] of the increment; static: of all, m */
  const double *limit;   /* [n] sliding limit g, N; NULL: no friction */
  const contact_status *contact; /* [n] */
  const contact_total *totals;   /* [n_contact] */
  const double *distance;        /* [n] all slip so far, m; NULL: no friction */
  const double *torque;          /* [n_contact] about its axis, N m; or NULL */
  int n_open, n_slip, n_stick;
} state_contacts;

/* One accepted increment. Arrays are borrowed and valid until the next one. */
typedef struct state {
  int step_no, increment_no; /* from 1, increments counted within the step */
  int total_no;              /* increments since the start, from 1 */
  int attempt;               /* 1: not cut */
  double t, dt;              /* end of the increment, s */
  int end_of_step;
  int within; /* 1: t is a time point within the increment */
  state_body body;
  state_contacts contacts;
  state_errors errors;
  const struct effect_list *effects; /* of the run, or NULL */
  energies energy;
  solver_report report;
  const char *solver_log;
  const char *note;  /* lines about what jumps; "", NULL: none */
  double cpu;        /* of this increment, s */
  int settled;       /* 1: to its tolerance, and not in doubt */
  struct run *again; /* the run, for shadow_with; until the next one */
} state;

/* How the contact solver knows the condensed stiffness. */
typedef struct stiffness_row {
  double seconds, bytes; /* expected */
} stiffness_row;
typedef struct stiffness_choice {
  int sparse;                  /* 1: FACTOR, 0: DENSE */
  int exact;                   /* 1: the row of FACTOR is by its order, else it
                                  takes at least that */
  stiffness_row dense, factor; /* all-zero: no contact */
  char why[100];
} stiffness_choice;

/* Facts of the run before the first increment, for the listing. */
typedef struct setup_facts {
  stiffness_choice choice;
  condense_info info;
  double condition; /* - */
  double digits;    /* that it leaves */
  int floating;     /* contact alone holds a body */
  int n_contact_node;
  int n_left_out;         /* inactive ones: no unknowns of the problem */
  double average_entries; /* of the nonlocal averages */
} setup_facts;

/* Sinks of the run. Any function may be NULL. */
typedef struct history_sink {
  void *ctx;
  /* Contact nodes that will be condensed, before anything is assembled. */
  status (*expect)(void *ctx, int n_node, const stiffness_choice *choice);
  status (*ready)(void *ctx, const setup_facts *facts,
                  const contact_surface *surface);
  /* *INITIAL CONDITIONS, TYPE=DISPLACEMENT: u_0 and its defect. */
  status (*start)(void *ctx, const start_report *report);
  status (*increment)(void *ctx, const state *s);
  /* A time of *TIME POINTS within the increment reported next. */
  status (*between)(void *ctx, const state *s);
  void (*iteration)(void *ctx, const solver_step *s); /* for .cvg */
  /* An attempt that failed and is cut or abandoned. */
  status (*rejected)(void *ctx, const state *s, const char *why);
  /* A state for a restart, between two attempts: where *RESTART requires it,
   * and at an interruption. run_keep names all its arrays. */
  status (*checkpoint)(void *ctx, struct run *r);
} history_sink;
