/*
 * Inelastic laws for the tests: cards from the example line of a row, points,
 * and the history of a material point under given strains and stresses.
 */
#pragma once

#include "material/law/law.h"

enum { LAW_ALPHA_MAX = 256, LAW_VALUE_MAX = 64 };

typedef struct law_case {
  law_card card;
  expression *formula; /* of the card, owned                                  */
  law_elastic elastic;
  double value[LAW_VALUE_MAX];
  int ns, n_alpha;
  /* State */
  double t, dt, temperature;
  double sigma[6], ei[6], alpha[LAW_ALPHA_MAX];
  double e[6]; /* total strain                                                */
} law_case;

/* Words number "words" of the card (0: the defaults; every combination of the
 * choices has a number), data lines from "data" or, if NULL, the example; 0
 * if there are not so many combinations. Exits the test on wrong data. */
int law_case_new(const law_ops *ops, int words, const char *data, double young,
                 double nu, kinematics kin, law_case *c);
void law_case_free(law_case *c);
/* The point of the state; values and speed are made for its t and T. */
law_point law_case_point(law_case *c);

/* What drives a material point: held[i] = 1: strain component i follows
 * e_rate, else stress component i follows sigma_rate, both from their present
 * values. */
typedef struct law_drive {
  int held[6];
  double e_rate[6], sigma_rate[6];
} law_drive;
/* Jump of the driven components at once (elastic). */
void law_case_jump(law_case *c, const law_drive *d);
/* n steps of the classical Runge-Kutta method of order 4 over "time". */
void law_case_run(law_case *c, const law_drive *d, double time, int n);
