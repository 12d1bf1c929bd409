/*
 * A body of one material point for the integrators of src/material/scheme:
 * components of the strain that are held follow it in time, the others carry
 * given stresses.
 */
#pragma once

#include "base/memory.h"
#include "material/scheme/scheme.h"
#include "support/law_case.h"

/* What drives a point: held[i] = 1: strain i is e[i] + t e_rate[i], else
 * stress i is sigma[i] + t sigma_rate[i]. Shear strains are engineering. */
typedef struct point_drive {
  int held[6];
  double e[6], e_rate[6], sigma[6], sigma_rate[6];
} point_drive;

typedef struct point_body {
  law_case c;
  point_drive drive;
  flow x;
  flow_state now, old;
  scheme_work *work;
  char *parts;          /* owns all of them                                   */
  scheme_result result; /* of the last step                                   */
  int n_equilibrium, n_linear; /* asked for                                   */
} point_body;

typedef struct point_input {
  const char *law, *data; /* as in law_case_new                               */
  int words;
  double young, nu, t; /* t: of the start                                     */
} point_input;

void point_body_new(const point_input *in, const point_drive *drive,
                    point_body *b);
void point_body_free(point_body *b);
/* POINT_BODY b = ...: freed where the name ends. */
#define POINT_BODY ENDS_BY(point_body_free) point_body
/* n steps of one length up to time t; of estimates[n], if any, the errors. */
void point_body_run(point_body *b, const scheme *s, double theta, double t,
                    int n, double *estimates);
