/*
 * Contact problems for the tests of the solvers: random ones, the condensed
 * block on a floor, and a check of the contact conditions that shares nothing
 * with the program.
 */
#ifndef PROTIS_TESTS_CONTACT_CASE_H
#define PROTIS_TESTS_CONTACT_CASE_H

#include "contact/contact.h"

/* A problem that owns its arrays; change them before it is solved. */
typedef struct contact_case {
  contact_problem cp; /* points to the arrays below                          */
  double *A, *f, *gap, *ut0, *g0, *side_gap;
  sparse_rows *B; /* [n*n] diagonal                                         */
  double *u, *r; /* [m] start and answer, zero at first                       */
} contact_case;

/* Uniform in [0, 1[, from a seed of one's own. */
double case_random(unsigned long long *seed);
/* n nodes, all zero, B = diag(mu); frictionless (g0, ut0, B NULL) if mu = 0. */
contact_case case_new(int dim, int n, double mu);
void case_free(contact_case *c);
/* kind 0: A = G G'/m + 0.2 I, G random; 1: a chain of springs with normal and
 * tangential motion coupled. Loads, gaps and stick positions random. */
contact_case case_any(int dim, int n, double mu, int kind,
                      unsigned long long seed);
/*
 * Block of columns x layers squares of size h (each two triangles, plane
 * strain, E = 1, nu given), on a floor with columns + 1 nodes, condensed layer
 * by layer. Clamped at its top unless "floating".
 */
contact_case case_block(int columns, int layers, double nu, double mu,
                        int floating);
/*
 * Largest violation of the conditions of contact.h by (u, r), relative to the
 * largest of |r|, |f|, diag(A) |u|: equation, signs, complementarity, friction
 * law with the slip direction.
 */
double case_violation(const contact_case *c, const double *u, const double *r);

#endif
