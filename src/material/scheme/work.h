/*
 * Workspace of the integrators and what their files share. Private to
 * src/material/scheme.
 */
#pragma once

#include "material/scheme/scheme.h"

enum { STAGES = 4 };

/* Step of a linear law with constant coefficients, y = (e^i, alpha):
 * y_new = P y_old + Q0 e_old + Q1 e_new. */
typedef struct linear_map {
  int n;           /* ns + n_alpha */
  double *P;       /* [n*n] */
  double *Q0, *Q1; /* [n*ns] */
  double *Q;       /* [n*ns] Q0 + Q1: of strains that stay */
} linear_map;

/* What the maps of a step depend on besides the laws. */
typedef struct linear_key {
  double dt, theta; /* dt = 0: there are none */
  int exact;        /* 1: EXPONENTIAL, 0: THETA */
} linear_key;

struct scheme_work {
  /* [ns*n], [alpha_at[n]] */
  double *ei_rate[STAGES], *alpha_rate[STAGES];
  double *sigma_k, *e_k, *linear; /* [ns*n] when first needed */
  double *D;                      /* [ns*ns*n] the same */
  linear_key made;                /* what map[] and D_kind are for */
  linear_map *map;                /* [n_kind] */
  double *D_kind;                 /* [ns*ns*n_kind] Pa */
};

/* The law of a kind at its values; stress and state are to be set. */
static inline law_point flow_kind_point(const flow_kind *k) {
  return (law_point){.law = k->law,
                     .elastic = &k->elastic,
                     .value = k->value,
                     .speed = k->speed};
}
/* y = x + a v over n components */
void sum_scaled(size_t n, const double *x, double a, const double *v,
                double *y);
/* Allocate an array of w if NULL. */
status need(scheme_work *w, double **array, size_t n);

/* linear_step.c: room for a map of at most n = ns + n_alpha; the map of a kind
 * and its D[ns*ns]. */
status linear_map_new(int ns, size_t n, linear_map *m);
status linear_map_make(const flow_kind *k, const scheme_step *p, int exact,
                       linear_map *m, double *D);
/* y[m->n] of point k from the old state for the new strain e */
void linear_at(const flow *x, const linear_map *m, int k, const flow_state *old,
               const double *e, double *y);
status linear_advance(const scheme_call *a, int exact);
status exponential_between(const scheme_call *a, flow_state *mid);
/* newton.c */
status newton_advance(const scheme_call *a);
/* linear.c: by the Jacobian of the law. */
status general_map(const flow_kind *k, const scheme_step *p, int exact,
                   linear_map *m, double *D);
/* For laws with "series", "relaxing"; m->P, Q0, Q1 are there, D as if e_zz of
 * plane stress were given. */
status series_map(const flow_kind *k, const scheme_step *p, int exact,
                  linear_map *m, double *D);
status relaxing_map(const flow_kind *k, const scheme_step *p, int exact,
                    linear_map *m, double *D);
/* The map and D for the strains in the plane, sigma_zz = 0.
 * ERR_SINGULAR: nothing resists e_zz. */
status plane_stress_map(const law_elastic *el, linear_map *m, double *D);
