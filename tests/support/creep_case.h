/*
 * A block that creeps under a pressure that grows, on a rough floor, for the
 * orders of integrators: unit square, cylinder or cube, symmetric about x = 0,
 * pressed at once at t = 1, then left to creep. The cube is held in y, so that
 * its slip keeps its direction, unless it is said to be free. Run in memory.
 */
#pragma once

typedef struct creep_case {
  const char *elastic;  /* line of *ELASTIC                                   */
  const char *law;      /* cards of the law below it                          */
  const char *model;    /* cards before the first step, or ""                 */
  const char *step;     /* cards of the step of creep, or ""                  */
  const char *section;  /* TYPE=                                              */
  const char *friction; /* line of *FRICTION                                  */
  double pressure;      /* at the start                                       */
  double growth; /* of the pressure: 1 + growth sin(time/total)               */
  double total;  /* time of the creep                                         */
  int free;      /* of the cube: held on one side in y only                   */
} creep_case;

/* It sticks for x < 0.3 and slides beyond. */
#define STICK_AND_SLIP "\"if(x < 0.3, 100, 0.1)\""

typedef struct creep_end {
  double u[256]; /* [n_dof] displacements                                     */
  int n_dof, n_slip, n_stick;
  int changes; /* increments that changed the status of a node                */
} creep_end;

/* integrator: as in INTEGRATOR=, further words of *VISCO may follow; n
 * increments. Check fails if a contact problem does not converge. */
creep_end creep_case_run(const creep_case *c, const char *integrator, int n);
/* |a - b| of the displacements. */
double creep_distance(const creep_end *a, const creep_end *b);
/* Order from the displacements with n, 2 n, 4 n increments; check fails where
 * nodes do not stick and slip, all of them as they did at the start. */
double creep_case_order(const creep_case *c, const char *integrator, int n);
