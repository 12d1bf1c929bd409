/*
 * The theorems of CPR98 evaluated on a solved increment. With the energy norms
 *   |v|^2 = v' A v  of displacements,   |f|_*^2 = f' inv(A) f  of loads
 * (so that m = M = 1), and g = g0 + B p, p = -r_n,
 *
 *   sum_i (B dp)_i |dv_t,i| <= q |dv| |dr|_*,
 *   q^2 = lmax(B A_nn B') lmax(inv(A)_tt).
 *
 * One coefficient mu and local friction give q = mu C_h, C_h^2 = lmax(A_nn)
 * lmax(inv(A)_tt). If q < 1 the fixed point on the sliding limit contracts with
 * q (Theorem 2.3: the solution is unique), and an increment obeys
 *
 *   (3.9)   |u - w|  <= (|f - A w|_* + c)/(1 - q),
 *   (3.10)  |du - e| <= (|df - A e|_* + c)/(1 - q).
 *
 * w: the initial penetration taken back, u_n = min(gap, 0); e: how the gaps and
 * the positions of stick change. c = |dg| sqrt(lmax(inv(A)_tt)), dg what the
 * limit has or changes that no pressure explains (g0, a change of mu): 0 for
 * Coulomb friction with a constant mu.
 *
 * Theorem 3.2, inelastic laws with given friction (problem Q3): the stress s of
 * a body whose inelastic strains follow from another stress s* is a
 * contraction. With |e^i|^2 the energy of E e^i and |s|^2 that of s, on the
 * whole body, |ds| <= |de^i| <= q |ds*|,   q = theta dt L for a step of the
 * rule of THETA: the first because the equilibrium with a given limit is a
 * projection, the second from the laws, whose constant is L. Over a time T the
 * path of s contracts after k maps if (L T)^k/k! < 1.
 */
#pragma once

#include "accuracy/accuracy.h"

/* A problem and its solution. */
typedef struct theorems_scene {
  const contact_problem *cp; /* with A */
  const double *u, *r;       /* [m] its solution, m, N */
  int n_contact;
  const int *contact_id;      /* [n] */
  const double *mu;           /* [n_contact] largest of its nodes, - */
  const unsigned char *given; /* [n] 1: the normal force is given; NULL: none */
  int alone;                  /* 1: (3.10) has no meaning: a static problem, a
                                 start */
  double tol;                 /* residual the solver was to reach, - */
} theorems_scene;

/* mu is below the guaranteed bound; between it and the measured one; above
 * both; the measured one is unknown, as nothing slides. */
typedef enum { MU_FREE, MU_UNDER, MU_BETWEEN, MU_ABOVE } mu_regime;
const char *mu_regime_text(mu_regime regime);

/* Friction of one contact, the limits of all others being given, or of all. */
typedef struct theorems_contact {
  int contact_id;   /* -1: all together */
  double mu;        /* largest, - */
  double factor;    /* q, -; HUGE_VAL: none, friction alone resists a motion */
  double limit;     /* unique for mu below it: mu/q = 1/C_h, -; NAN: mu = 0 */
  double rate;      /* contraction of the fixed point measured at the solution,
                       - */
  double suggested; /* mu/rate, -; HUGE_VAL: nothing slides */
  double normal;    /* lmax(A_nn), N/m; of the contact */
  double tangent;   /* lmax(inv(A)_tt), m/N */
  mu_regime regime;
} theorems_contact;

typedef struct theorems_bound {
  double left, right; /* sqrt(J) */
  int violated;
  const char *why; /* NULL, or why there is none */
} theorems_bound;

/* Theorem 3.2 over an increment. */
typedef struct theorems_path {
  int asked;       /* 1: laws flow in the step */
  const char *why; /* NULL, or why there is no rate */
  double rate;     /* of the map linearised at the solution, asymptotic, - */
  double bound;    /* q, - */
  double speed;    /* L, 1/s */
  double longest;  /* s, increments below it contract; HUGE_VAL: nothing
                      flows */
  double span;     /* T, since the start of the step, s */
  double passes;   /* least k over T, with the largest L so far, - */
  int violated;    /* rate > bound */
} theorems_path;

typedef struct theorems_report {
  int asked;
  int fresh;                        /* 1: the matrix is new */
  int n_contact;                    /* rows: contacts with friction on their own
                                       pressure, then all of them if there are
                                       more than one */
  const theorems_contact *contacts; /* [n_contact] borrowed */
  theorems_bound total, change;     /* (3.9), (3.10) */
  double inequality;                /* least of S_i^n over the test fields, - */
  int n_field;                      /* fields tried */
  int inequality_violated;
  int has_start; /* 1: start is that of the initial state,
                    (3.8) */
  double start;  /* least of (3.8) over the test fields, - */
  theorems_path path;
  int violated; /* any of them */
} theorems_report;

typedef struct theorems theorems;
status theorems_new(theorems **out); /* ERR_MEMORY */
/* The initial state: (3.8), and where the first increment starts. */
status theorems_start(theorems *t, const theorems_scene *s);
/*
 * The report for a solution. Eigenvalues are found when matrix or B are new.
 * Cost: a factor of A when it is new; products and solves with it; of the
 * measured rate that of contraction_rate for each contact. ERR_MEMORY.
 */
status theorems_check(theorems *t, const theorems_scene *s,
                      theorems_report *out);

/* A map of stresses into themselves; |y| of the result. ERR_* of its own. */
typedef struct stress_map {
  void *ctx;
  status (*apply)(void *ctx, double *size);
} stress_map;
/* From where the context stands: the factor that passes end with, 0 if nothing
 * is left. Each pass starts from the last result over its norm. */
status theorems_path_rate(const stress_map *map, double *rate);
/* Constants from bound = q of a step dt by theta, after "span" since "start"
 * of a step. */
void theorems_path_learn(theorems *t, double theta, double dt, double span,
                         theorems_path *p);
/* Least k with x^k/k! < 1. */
double theorems_passes(double x);

/* A and its inverse: the norms. */
typedef struct energy_norm {
  int m;
  const double *A;        /* [m*m] borrowed */
  dense_inverse *inverse; /* owned; NULL: A is not positive semidefinite */
  inverse_energy dual;    /* its kernel: motions without energy */
  double *x, *y;          /* [m] owned, room */
} energy_norm;
status energy_norm_new(int m, const double *A, energy_norm *out);
void energy_norm_free(energy_norm *e);                  /* accepts all-zero */
double energy_norm_of(energy_norm *e, const double *v); /* |v|, sqrt(J) */
/* |f|_*; defined without motions that have no energy only. */
double energy_norm_dual(energy_norm *e, const double *f);

/* y = H x with a symmetric positive semidefinite H[n*n]. */
typedef struct symmetric_map {
  int n;
  void *ctx;
  void (*apply)(void *ctx, const double *x, double *y);
} symmetric_map;
/*
 * Largest eigenvalue: LAPACK on the matrix up to DENSE_ORDER, beyond by Lanczos
 * with its residual added, so that it is not below. n > 0. ERR_MEMORY.
 */
enum { DENSE_ORDER = 256 };
status largest_eigenvalue(const symmetric_map *map, double *largest);
status lanczos_largest(const symmetric_map *map, double *largest);

/*
 * cp with the limit of some nodes frozen at the normal forces r: rows of the
 * nodes with keep_row[i] = 0 (NULL: all kept) and columns of those given[i] = 1
 * (NULL: none) go from B to g0. Nodes with given force have no gap there and
 * their force is part of the load. Borrows from cp.
 */
typedef struct frozen_problem {
  contact_problem cp;
  sparse_rows B;
  double *f, *gap, *g0, *r; /* [m], [n], [n], [m] owned */
} frozen_problem;
status frozen_new(const contact_problem *cp, const double *r,
                  const unsigned char *keep_row, const unsigned char *given,
                  frozen_problem *out);

/*
 * normal, tangent and factor of the friction that the rows of cp->B say; with
 * "limits", tangent counts nodes with g0 > 0 as well. ERR_MEMORY.
 */
status friction_constants(const contact_problem *cp, energy_norm *e, int limits,
                          theorems_contact *out);

/* The state an increment starts from; frozen where normal forces are given. */
typedef struct state_before {
  int known;                   /* 0: nothing; 1: the arrays; -1: no load, no
                                  displacement */
  double *u, *r, *f, *gap, *g; /* [m] of all unknowns, [n] owned */
} state_before;
status state_before_keep(const contact_problem *cp, const double *u,
                         const double *r, state_before *b);
void state_before_free(state_before *b); /* accepts all-zero */
/* (3.9) and (3.10) for a factor q < 1; "all" has q and tangent. */
status bound_total(const contact_problem *cp, const double *u,
                   const theorems_contact *all, energy_norm *e,
                   theorems_bound *b);
status bound_change(const contact_problem *cp, const double *u,
                    const state_before *before, const theorems_contact *all,
                    energy_norm *e, theorems_bound *b);

/*
 * Least value over random admissible test fields w in K (on one node, and on
 * all at once) of
 *   a(u, w - u) - (f, w - u) + j(w) - j(u),  j(v) = sum g_i |v_t,i - ut0_i|,
 * over (|f|+|r|)(|w - u|+|u|) in the norms of the diagonal of A, or less the
 * penetration of u itself, if that is worse. 0 or above for a solution; *fields
 * counts them. The series is the same for all problems of a size. ERR_MEMORY.
 */
status inequality_least(const contact_problem *cp, const double *u,
                        double *least, int *fields);
