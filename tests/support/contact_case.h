/*
 * Contact problems for the tests of the solvers: random ones, the condensed
 * block on a floor, and a check of the contact conditions that shares nothing
 * with the program.
 */
#pragma once

#include "base/memory.h"
#include "contact/contact.h"

/* A problem that owns its arrays; change them before it is solved. */
typedef struct contact_case {
  contact_problem cp; /* points to the arrays below                          */
  double *A, *f, *gap, *ut0, *g0, *side_gap;
  unsigned char *held;
  sparse_rows *B; /* [n*n] diagonal, or as case_average makes it             */
  double *u, *r; /* [m] start and answer, zero at first                       */
} contact_case;

/* Uniform in [0, 1[, from a seed of one's own. */
double case_random(unsigned long long *seed);
/* The problem, u and r in units of length and force that are powers of two. */
void case_units(contact_case *c, int length, int force);
/* n nodes, all zero, B = diag(mu); frictionless (g0, ut0, B NULL) if mu = 0. */
contact_case case_new(int dim, int n, double mu);
void case_free(contact_case *c);
/* CONTACT_CASE c = ...: freed where the name ends. */
#define CONTACT_CASE ENDS_BY(case_free) contact_case
/* kind 0: A = G G'/m + 0.2 I, G random; 1: a chain of springs with normal and
 * tangential motion coupled. Loads, gaps and stick positions random. */
contact_case case_any(int dim, int n, double mu, int kind,
                      unsigned long long seed);
/* B becomes mu times an average over the nodes up to "reach" numbers away, the
 * nearer the more; it loses what lies beyond the ends. */
void case_average(contact_case *c, int reach, double mu);
/* A block of columns x layers unit squares (two triangles each), plane strain,
 * E = 1, on a floor with columns + 1 nodes. */
typedef struct case_block_data {
  int columns, layers;
  int clamped;   /* 1: the top line is fixed; 0: only contact holds the body  */
  int symmetric; /* 1: u_x = 0 on the right face (its contact node is held)   */
  double nu, mu;
  double top[2], left[2], right[2]; /* tractions x, y                         */
} case_block_data;
/* The block condensed layer by layer. Contact frame: normal -y, tangent x. */
contact_case case_block(const case_block_data *d);
/*
 * One triangle, E = 1, corners (-1, 1) and (1, 3) clamped, (0, 0) on a floor,
 * pushed by (fx, fy); mu_crit = 1.8 for nu = 0.3.
 */
contact_case case_triangle(double nu, double mu, double fx, double fy);
/* The published block: 40 mm, E = 130 GPa, 50 MPa on the top, 150 on the side;
 * u_x at x = 0, 5, 11.25 mm is 28.60, 22.86, 15.41 um for mu = 1, and u_x(0) =
 * 40.615 um without friction (P1, 32 squares: to 0.3 %). */
contact_case case_published(int columns, double mu);
/* W = inv(A) of a positive definite A[m*m]; 0: it is not. */
int case_inverse(int m, const double *A, double *W);
/*
 * Largest violation of the conditions of contact.h by (u, r), relative to the
 * largest of |r|, |f|, diag(A) |u|: equation, signs, complementarity, friction
 * law with the slip direction.
 */
double case_violation(const contact_case *c, const double *u, const double *r);
