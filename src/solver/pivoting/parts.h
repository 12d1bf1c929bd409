/*
 * Parts of METHOD=LEMKE: unknowns, variables, the reduced matrix and the matrix
 * of the complementarity problem as lcp_run requires it (matrix.c); the two
 * forms of the problem, states of the body, rays (lemke.c). Private to
 * src/solver/pivoting.
 */
#ifndef PROTIS_PIVOTING_PARTS_H
#define PROTIS_PIVOTING_PARTS_H

#include "solver/lcp/lcp.h"
#include "solver/pivoting/lemke.h"
#include "solver/solver.h"

enum { N_CORRECTOR = 2 };

/* What an unknown z of the complementarity problem is. */
typedef enum { BOUND, SLIDE, LIMIT } variable_type;

typedef struct variable {
  variable_type type;
  int node_id, dof; /* dof: of the reduced matrix, the first of two tangents */
  double e[2];      /* direction; the second is 0 in 2-D */
} variable;

typedef enum { IS_BOUND, IS_FRICTION, IS_FREE, IS_HELD } dof_kind;

typedef struct lemke_work {
  int m, facets;
  double unit; /* of two: S = unit D A D has diagonal <= 1 */
  lcp_work *lcp;
  struct {
    int n_kept, n_free, n_var; /* reduced unknowns, eliminated ones, z */
    int *kept, *free_id;       /* [m] */
    double *S;                 /* [n_kept^2] reduced and scaled matrix */
    double *inner;             /* [n_free^2] inverse of A_FF, then
                                  [n_free*n_kept] that times A_FK */
    double *base;              /* [m] u (r) at z = 0 */
    double *D;                 /* [n] scale of a node, power of two */
    double *tame;              /* [n] factor of the rows with the limit, power
                                  of two */
  } reduced;
  struct {
    int *normal, *slide, *n_slide; /* [n] variable of u_n; first SLIDE */
  } node;
  double *spare;                  /* [m*m] or NULL: for the pseudo-inverse */
  double *raw;                    /* [m] A u - f (W r + q) */
  double *v, *t;                  /* [m] */
  double *ray;                    /* [m] motion of the last ray */
  double *best_u, *best_r, *work; /* [m], [m], [4m] */
  int has_ray;
  int *pivot, *kind;      /* [m] */
  variable *var;          /* [n_var] */
  double *q, *d, *z, *dz; /* [n_var] */
  struct {
    const solver_ops *ops[N_CORRECTOR];
    void *param[N_CORRECTOR], *work[N_CORRECTOR];
  } corrector;
} lemke_work;

typedef struct lemke_run {
  const contact_problem *cp;
  lemke_work *w;
  const solver_control *control;
  const double *M; /* A or W */
} lemke_run;

/* 1: stiffness form; 0: compliance form. */
static inline int lemke_is_stiff(const lemke_run *s) {
  return contact_has_stiffness(s->cp);
}

/* ---- matrix.c ---- */

/* Sort the unknowns; those kept (bounded or with friction) come in order. */
void lemke_sort_unknowns(lemke_run *s);
/* The variables of the unknowns kept, in their order. */
void lemke_list_variables(lemke_run *s);

/* S = A_KK - A_KF inv(A_FF) A_FK (W_KK in the compliance form); 0: A_FF is
 * singular. */
int lemke_reduce(lemke_run *s);
/* Powers of two that bring the diagonal of S to order 1, one per node. */
void lemke_scale(lemke_run *s);

/* The rows with the limit grow with mu: a factor for each. */
void lemke_tame_limits(lemke_run *s);
/* 1: the row of this variable holds the limit. */
int lemke_has_limit(const lemke_run *s, const variable *v);
/* What friction adds to the rows y of V' S V z: with z (and y before) in the
 * compliance form, the pressures in y else. */
void lemke_add_limits(const lemke_run *s, const double *z, double *y);
/* product and row of lcp_problem; ctx: a lemke_run. */
void lemke_product(const void *ctx, int n_id, const int *id, const double *x,
                   double *y);
void lemke_row(const void *ctx, int i, int n_id, const int *id, double *to);

#endif
