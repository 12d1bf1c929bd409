/*
 * One point over a step of the theta-method: what newton.c and point_step.c
 * share. Private to src/material/scheme.
 */
#ifndef PROTIS_SCHEME_POINT_STEP_H
#define PROTIS_SCHEME_POINT_STEP_H

#include "material/scheme/scheme.h"

/* Workspace of one point, n = ns + most_alpha unknowns. */
typedef struct point_step {
  int ns, na, n;
  double e[6], sigma[6], ei[6];       /* at the theta-point; e of the end */
  double *alpha;                      /* [na] at the theta-point */
  double *y, *old, *f, *trial, *kept; /* [n] e^i and alpha */
  double *M, *X;                      /* [n*n], [n*ns] */
  int *pivot;                         /* [n] */
  double E[36];                       /* [ns*ns] at the end of the step, Pa */
  law_jacobian j;
  double value[FLOW_VALUE_MAX];
  law_point p;
  double *work;
} point_step;

status point_step_new(const flow *x, point_step *l); /* ERR_MEMORY */
void point_step_free(point_step *l); /* accepts an all-zero one */
/* Point k with its start values; coefficients at the theta-point. */
status point_step_begin(const flow *x, const scheme_step *p, int k,
                        const flow_state *old, const flow_state *now,
                        point_step *l);
/* The theta-point of y[n]; sigma_old[ns]. */
void point_step_place(const scheme_step *p, const double *sigma_old,
                      const double *y, point_step *l);
/* Newton iteration of one point for l->e, from and into l->y; *solved = 0 if
 * it fails. */
void point_step_solve(const scheme_step *p, const double *sigma_old,
                      point_step *l, int *solved);
/* 1: no rate at the theta-point of the old e^i and alpha, which are then the
 * new ones, and D = E: exactly what the iteration would end with. */
int point_step_rests(const flow *x, const scheme_step *p,
                     const double *sigma_old, point_step *l);
/* D[ns*ns] at the solution. */
status point_step_tangent(const scheme_step *p, point_step *l, double *D);

#endif
