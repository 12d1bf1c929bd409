/*
 * Contact by complementary pivoting: the whole problem as one linear
 * complementarity problem, without a fixed point on the sliding limit.
 *
 * Stiffness form. Slip is s = sum of e_j l_j over given directions e_j of the
 * tangent plane (2-D: +1 and -1, exact; 3-D: the corners of a regular polygon),
 *   x = gap - u_n >= 0              p = -r_n >= 0               x p = 0
 *   l_j >= 0                        h_j = g + e_j r_t >= 0      l_j h_j = 0
 * with A u = f + r, g = g0 + B p: w = (p, h) is affine in z = (x, l), and z = 0
 * is the body at stick. The covering vector is a pressure d on every node with
 * the limit it brings, (d, B d + d). A ray then is a motion v with v'A v <= 0
 * that opens or slides and on which the load does more work than the friction
 * of the state reached: with A positive definite there is none, whatever the
 * friction, and the method always ends with a solution.
 *
 * Compliance form (A not known; W may be singular or slightly unsymmetric): r_t
 * = sum of e_j b_j, slip speed y (Stewart, Trinkle 1996),
 *   p >= 0      gap - u_n >= 0       b_j >= 0      e_j s + y >= 0
 *   y >= 0      g0 + B p - sum b_j >= 0.
 *
 * Tangential unknowns without friction are eliminated first. In 3-D the state
 * found is the start of a solver with the exact disc of friction.
 */
#include "solver/pivoting/lemke.h"

#include "solver/lcp/lcp.h"
#include "solver/solver.h"

#include <cblas.h>
#include <lapacke.h>

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
    double *tame;              /* [n] of rows with the limit, power of two */
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
    void *param[N_CORRECTOR], *work[N_CORRECTOR]; /* NULL: not used yet */
  } corrector;
  contact_problem of; /* at set-up, where saved data are read */
} lemke_work;

typedef struct lemke_run {
  const contact_problem *cp;
  lemke_work *w;
  const solver_control *control;
  const double *M; /* A or W */
} lemke_run;

/* 1: stiffness form; 0: compliance form. */
static int lemke_is_stiff(const lemke_run *s) {
  return contact_has_stiffness(s->cp);
}

/* ---- unknowns of the contact problem and variables z of the complementarity
 * problem: which are kept, and what each one stands for. */

static int has_friction(const contact_problem *cp, int node_id) {
  if (cp->g0 == NULL || contact_has_side(cp, node_id)) return 0;
  if (cp->g0[node_id] != 0.0) return 1;
  for (int k = row_begin(cp->B, node_id); k < row_end(cp->B, node_id); ++k)
    if (cp->B->val[k] != 0.0) return 1;
  return 0;
}

/* Sort the unknowns; those kept (bounded or with friction) come in order. */
static void lemke_sort_unknowns(lemke_run *s) {
  const contact_problem *cp = s->cp;
  lemke_work *w = s->w;
  w->reduced.n_kept = w->reduced.n_free = 0;
  for (int dof = 0; dof < cp->m; ++dof) {
    dof_kind kind = IS_FREE;
    if (contact_held(cp, dof))
      kind = IS_HELD;
    else if (contact_bound(cp, dof) < HUGE_VAL)
      kind = IS_BOUND;
    else if (has_friction(cp, dof / cp->dim))
      kind = IS_FRICTION;
    w->kind[dof] = (int)kind;
    if (kind == IS_FREE) w->reduced.free_id[w->reduced.n_free++] = dof;
    if (kind == IS_BOUND || kind == IS_FRICTION)
      w->reduced.kept[w->reduced.n_kept++] = dof;
  }
}

/* The directions of slip of a node whose first tangent is "dof". */
static void add_directions(lemke_work *w, int node_id, int dof, int tangents) {
  int count = tangents == 1 ? 2 : w->facets;
  const double full = 2.0 * acos(-1.0);
  w->node.slide[node_id] = w->reduced.n_var;
  w->node.n_slide[node_id] = count;
  for (int j = 0; j < count; ++j) {
    int half = j % (count / 2);
    double sign = j < count / 2 ? 1.0 : -1.0, angle = full * half / count;
    variable v = {SLIDE, node_id, dof, {sign, 0.0}};
    if (tangents == 2) {
      v.e[0] = sign * cos(angle);
      v.e[1] = sign * sin(angle);
    }
    w->var[w->reduced.n_var++] = v;
  }
}

/* The variables of the unknowns kept, in their order. */
static void lemke_list_variables(lemke_run *s) {
  lemke_work *w = s->w;
  int dim = s->cp->dim;
  w->reduced.n_var = 0;
  for (int i = 0; i < s->cp->n; ++i) w->node.n_slide[i] = 0;
  for (int i = 0; i < w->reduced.n_kept; ++i) {
    int dof = w->reduced.kept[i], node_id = dof / dim;
    if (w->kind[dof] == IS_BOUND) {
      if (dof % dim == 0) w->node.normal[node_id] = w->reduced.n_var;
      w->var[w->reduced.n_var++] = (variable){BOUND, node_id, i, {-1.0, 0.0}};
    } else if (w->node.n_slide[node_id] == 0) {
      int two =
          i + 1 < w->reduced.n_kept && w->reduced.kept[i + 1] / dim == node_id;
      add_directions(w, node_id, i, two ? 2 : 1);
      if (!lemke_is_stiff(s))
        w->var[w->reduced.n_var++] = (variable){LIMIT, node_id, i, {0.0, 0.0}};
    }
  }
}

/* ---- the matrix of the unknowns kept: the tangents without friction
 * eliminated, node by node scaled. */

static const double SINGULAR = 1e-13; /* -, of the largest eigenvalue */

static void gather(const lemke_run *s, int n_row, const int *row, int n_col,
                   const int *col, double *to) {
  for (int j = 0; j < n_col; ++j) {
    const double *from = s->M + (size_t)col[j] * s->cp->m;
    double *column = to + (size_t)j * n_row;
    for (int i = 0; i < n_row; ++i) column[i] = from[row[i]];
  }
}

/* inner = inv(A_FF); 0: singular. */
static int invert_free(lemke_run *s) {
  lemke_work *w = s->w;
  int n = w->reduced.n_free;
  gather(s, n, w->reduced.free_id, n, w->reduced.free_id, w->reduced.inner);
  return LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, n, n, w->reduced.inner, n,
                             w->pivot) == 0 &&
         LAPACKE_dgetri_work(LAPACK_COL_MAJOR, n, w->reduced.inner, n, w->pivot,
                             w->work, 4 * w->m) == 0;
}

/* inner = pseudo-inverse of A_FF: motions without resistance are left out. */
static int pseudo_invert_free(lemke_run *s) {
  lemke_work *w = s->w;
  int n = w->reduced.n_free;
  size_t ld = n;
  gather(s, n, w->reduced.free_id, n, w->reduced.free_id, w->spare);
  if (LAPACKE_dsyev_work(LAPACK_COL_MAJOR, 'V', 'L', n, w->spare, n, w->t,
                         w->work, 4 * w->m + 4) != 0)
    return 0;
  CLEAR(w->reduced.inner, ld * ld);
  for (size_t k = 0; k < ld; ++k)
    if (w->t[k] > SINGULAR * w->t[n - 1])
      cblas_dger(CblasColMajor, n, n, 1.0 / w->t[k], w->spare + k * ld, 1,
                 w->spare + k * ld, 1, w->reduced.inner, n);
  return 1;
}

/* S = A_KK - A_KF inv(A_FF) A_FK (W_KK in the compliance form); 0: A_FF is
 * singular. */
static int lemke_reduce(lemke_run *s) {
  lemke_work *w = s->w;
  int nk = w->reduced.n_kept, nf = w->reduced.n_free;
  gather(s, nk, w->reduced.kept, nk, w->reduced.kept, w->reduced.S);
  if (!lemke_is_stiff(s)) w->reduced.n_free = nf = 0;
  if (nf == 0) return 1;
  if (!(s->cp->floating ? pseudo_invert_free(s) : invert_free(s))) return 0;
  double *X = w->reduced.inner + (size_t)nf * nf;
  for (int j = 0; j < nk; ++j) {
    gather(s, nf, w->reduced.free_id, 1, &w->reduced.kept[j], w->t);
    contact_product(nf, w->reduced.inner, w->t, X + (size_t)j * nf);
  }
  for (int k = 0; k < nf; ++k) {
    gather(s, nk, w->reduced.kept, 1, &w->reduced.free_id[k], w->t);
    cblas_dger(CblasColMajor, nk, nk, -1.0, w->t, 1, X + k, nf, w->reduced.S,
               nk);
  }
  return 1;
}

/* Powers of two that bring the diagonal of S to order 1, one per node. */
static void lemke_scale(lemke_run *s) {
  lemke_work *w = s->w;
  int dim = s->cp->dim, nk = w->reduced.n_kept, top = 0;
  double largest = 0.0;
  for (int i = 0; i < s->cp->n; ++i) w->reduced.D[i] = 0.0;
  for (int i = 0; i < nk; ++i) {
    double a = w->reduced.S[(size_t)i * nk + i];
    double *D = w->reduced.D + w->reduced.kept[i] / dim;
    *D = fmax(*D, a);
    largest = fmax(largest, a);
  }
  if (largest > 0.0 && largest < HUGE_VAL) frexp(largest, &top);
  w->unit = ldexp(1.0, -top);
  for (int i = 0; i < s->cp->n; ++i) {
    int exponent = top;
    if (w->reduced.D[i] > 0x1p-60 * largest) frexp(w->reduced.D[i], &exponent);
    w->reduced.D[i] = ldexp(1.0, (top - exponent) / 2);
  }
  for (int j = 0; j < nk; ++j)
    for (int i = 0; i < nk; ++i)
      w->reduced.S[(size_t)j * nk + i] *=
          w->unit * w->reduced.D[w->reduced.kept[i] / dim] *
          w->reduced.D[w->reduced.kept[j] / dim];
}

/* Entry of B between the scaled limits and pressures of two nodes. */
static double limit_entry(const lemke_run *s, int node_id, int k) {
  const lemke_work *w = s->w;
  double from = w->reduced.D[s->cp->B->col[k]], to = w->reduced.D[node_id];
  return s->cp->B->val[k] * (lemke_is_stiff(s) ? to / from : from / to);
}

/* sum of B_ik p_k of one node; p: values by variable. */
static double limit_sum(const lemke_run *s, int node_id, const double *p) {
  const sparse_rows *B = s->cp->B;
  double sum = 0.0;
  for (int k = row_begin(B, node_id); k < row_end(B, node_id); ++k)
    sum += limit_entry(s, node_id, k) * p[s->w->node.normal[s->cp->B->col[k]]];
  return sum;
}

/* The rows with the limit grow with mu: a factor for each. */
static void lemke_tame_limits(lemke_run *s) {
  for (int i = 0; i < s->cp->n; ++i) {
    int exponent;
    double sum = 1.0;
    for (int k = row_begin(s->cp->B, i); k < row_end(s->cp->B, i); ++k)
      sum += limit_entry(s, i, k);
    frexp(sum, &exponent);
    s->w->reduced.tame[i] = ldexp(1.0, 1 - exponent);
  }
}

/* 1: the row of this variable holds the limit. */
static int lemke_has_limit(const lemke_run *s, const variable *v) {
  return v->type == (lemke_is_stiff(s) ? SLIDE : LIMIT);
}

/* What friction adds to the rows y of V' S V z: with z (and y before) in the
 * compliance form, the pressures in y else. */
static void lemke_add_limits(const lemke_run *s, const double *z, double *y) {
  const lemke_work *w = s->w;
  int stiff = lemke_is_stiff(s);
  int node_id = -1; /* of the sum */
  double sum = 0.0;
  for (int a = 0; a < w->reduced.n_var; ++a) {
    const variable *v = w->var + a;
    if (!lemke_has_limit(s, v)) continue;
    int first = w->node.slide[v->node_id],
        last = first + w->node.n_slide[v->node_id];
    if (v->node_id != node_id) sum = limit_sum(s, v->node_id, stiff ? y : z);
    node_id = v->node_id;
    y[a] += sum;
    for (int j = first; j < last && !stiff; ++j) {
      y[a] -= z[j];
      y[j] += z[a];
    }
    y[a] *= w->reduced.tame[v->node_id];
  }
}

/* v[n_kept] = sum of x V(:, id) */
static void spread(const lemke_run *s, int n_id, const int *id, const double *x,
                   double *v) {
  CLEAR(v, s->w->reduced.n_kept);
  for (int k = 0; k < n_id; ++k) {
    const variable *a = s->w->var + id[k];
    if (a->type == LIMIT) continue;
    v[a->dof] += a->e[0] * x[k];
    if (a->e[1] != 0.0) v[a->dof + 1] += a->e[1] * x[k];
  }
}

static double along(const variable *a, const double *t) {
  double sum = a->e[0] * t[a->dof];
  return a->e[1] != 0.0 ? sum + a->e[1] * t[a->dof + 1] : sum;
}

/* t = S v, by columns where v has few entries. */
static void multiply(const lemke_run *s, const double *v, double *t) {
  const lemke_work *w = s->w;
  int n = w->reduced.n_kept, filled = 0;
  for (int i = 0; i < n; ++i) filled += v[i] != 0.0;
  if (2 * filled > n) {
    contact_product(n, w->reduced.S, v, t);
    return;
  }
  CLEAR(t, n);
  for (int i = 0; i < n; ++i)
    if (v[i] != 0.0)
      cblas_daxpy(n, v[i], w->reduced.S + (size_t)i * n, 1, t, 1);
}

/* product and row of lcp_problem; ctx: a lemke_run. */
static void lemke_product(const void *ctx, int n_id, const int *id,
                          const double *x, double *y) {
  const lemke_run *s = ctx;
  const lemke_work *w = s->w;
  spread(s, n_id, id, x, w->v);
  multiply(s, w->v, w->t);
  for (int a = 0; a < w->reduced.n_var; ++a)
    y[a] = w->var[a].type == LIMIT ? 0.0 : along(&w->var[a], w->t);
  for (int a = 0; a < w->reduced.n_var && !lemke_is_stiff(s); ++a)
    w->dz[a] = 0.0;
  for (int k = 0; k < n_id && !lemke_is_stiff(s); ++k) w->dz[id[k]] = x[k];
  lemke_add_limits(s, w->dz, y);
}

/* What friction adds to a row at the columns id (compliance form). */
static void add_limit_row(const lemke_run *s, const variable *v, int n_id,
                          const int *id, double *to) {
  const sparse_rows *B = s->cp->B;
  for (int k = 0; k < n_id; ++k) {
    const variable *a = s->w->var + id[k];
    int same = a->node_id == v->node_id;
    if (v->type == SLIDE && a->type == LIMIT && same) to[k] += 1.0;
    if (v->type != LIMIT) continue;
    if (a->type == SLIDE && same) to[k] -= 1.0;
    for (int e = row_begin(B, v->node_id); e < row_end(B, v->node_id); ++e)
      if (s->w->node.normal[B->col[e]] == id[k])
        to[k] += limit_entry(s, v->node_id, e);
  }
}

static void lemke_row(const void *ctx, int i, int n_id, const int *id,
                      double *to) {
  const lemke_run *s = ctx;
  const lemke_work *w = s->w;
  const variable *v = w->var + i;
  const int stiff = lemke_is_stiff(s);
  const sparse_rows *B = stiff && v->type == SLIDE ? s->cp->B : NULL;
  int n = w->reduced.n_kept;
  CLEAR(w->t, n);
  for (int k = 0; k < 2; ++k)
    if (v->e[k] != 0.0)
      cblas_daxpy(n, v->e[k], w->reduced.S + v->dof + k, n, w->t, 1);
  for (int k = row_begin(B, v->node_id); k < row_end(B, v->node_id); ++k)
    cblas_daxpy(n, -limit_entry(s, v->node_id, k),
                w->reduced.S + w->var[w->node.normal[B->col[k]]].dof, n, w->t,
                1);
  for (int k = 0; k < n_id; ++k)
    to[k] = w->var[id[k]].type == LIMIT ? 0.0 : along(w->var + id[k], w->t);
  if (!stiff) add_limit_row(s, v, n_id, id, to);
  if (lemke_has_limit(s, v))
    cblas_dscal(n_id, w->reduced.tame[v->node_id], to, 1);
}

/* ---- states of the body: at z = 0, at a given z, and at the end, where the
 * conditions of the basis are enforced exactly. */

enum { POLISH = 3 /* passes */ };

/* raw = A u - f, or W r + q; load 0: without f or q. */
static void lemke_respond(const lemke_run *s, const double *x, int load,
                          double *raw) {
  double sign = lemke_is_stiff(s) ? -1.0 : 1.0;
  contact_product(s->cp->m, s->M, x, raw);
  if (load) cblas_daxpy(s->cp->m, sign, s->cp->f, 1, raw, 1);
}

/* The free unknowns in equilibrium with the others. */
static void lemke_settle_free(const lemke_run *s, int load, double *u) {
  const lemke_work *w = s->w;
  int n = w->reduced.n_free;
  for (int pass = 0; pass < 2 && n > 0; ++pass) {
    lemke_respond(s, u, load, w->raw);
    for (int k = 0; k < n; ++k) w->v[k] = -w->raw[w->reduced.free_id[k]];
    contact_product(n, w->reduced.inner, w->v, w->t);
    for (int k = 0; k < n; ++k) u[w->reduced.free_id[k]] += w->t[k];
  }
}

/* base[m] of the work: the state at z = 0. */
static void lemke_set_base(lemke_run *s) {
  const contact_problem *cp = s->cp;
  lemke_work *w = s->w;
  CLEAR(w->reduced.base, cp->m);
  if (!lemke_is_stiff(s)) return;
  for (int dof = 0; dof < cp->m; ++dof) {
    if (w->kind[dof] == IS_BOUND) w->reduced.base[dof] = contact_bound(cp, dof);
    if (w->kind[dof] == IS_FRICTION)
      w->reduced.base[dof] = contact_stick(cp, dof);
    if (w->kind[dof] == IS_HELD)
      w->reduced.base[dof] = cp->f[dof] / contact_diagonal(cp, dof);
  }
  lemke_settle_free(s, 1, w->reduced.base);
}

/* w of every variable from raw, scaled as the matrix is; z: scaled, for the
 * compliance form. */
static void slacks(const lemke_run *s, const double *raw, const double *z,
                   double *to) {
  const contact_problem *cp = s->cp;
  const lemke_work *w = s->w;
  int stiff = lemke_is_stiff(s);
  for (int a = 0; a < w->reduced.n_var; ++a) {
    const variable *v = w->var + a;
    double unit = w->unit * w->reduced.D[v->node_id], g0 = 0.0;
    int dof = w->reduced.kept[v->dof];
    if (v->type == BOUND)
      to[a] = unit * (stiff ? -raw[dof] : contact_bound(cp, dof) - raw[dof]);
    if (lemke_has_limit(s, v)) g0 = cp->g0[v->node_id];
    if (v->type == LIMIT) to[a] = g0 / w->reduced.D[v->node_id];
    if (v->type != SLIDE) continue;
    double sum =
        g0 + v->e[0] * (raw[dof] - (stiff ? 0.0 : contact_stick(cp, dof)));
    if (v->e[1] != 0.0)
      sum +=
          v->e[1] * (raw[dof + 1] - (stiff ? 0.0 : contact_stick(cp, dof + 1)));
    to[a] = unit * sum;
  }
  lemke_add_limits(s, z, to);
}

/* x += the motion (forces) of z on the unknowns kept, unscaled. */
static void lemke_add_motion(const lemke_work *w, const double *z, double *x) {
  for (int a = 0; a < w->reduced.n_var; ++a) {
    const variable *v = w->var + a;
    double size = w->reduced.D[v->node_id] * z[a];
    if (v->type == LIMIT || size == 0.0) continue;
    x[w->reduced.kept[v->dof]] += v->e[0] * size;
    if (v->e[1] != 0.0) x[w->reduced.kept[v->dof + 1]] += v->e[1] * size;
  }
}

/* x = the state at z. */
static void lemke_state_of(const lemke_run *s, const double *z, double *x) {
  COPY(x, s->w->reduced.base, s->cp->m);
  lemke_add_motion(s->w, z, x);
  lemke_settle_free(s, 1, x);
}

/* Correct z by the residual of the final basis, the given matrix. */
static void polish(lemke_run *s, double *x) {
  lemke_work *w = s->w;
  lcp_values(w->lcp, w->z);
  lemke_state_of(s, w->z, x);
  for (int pass = 0; pass < POLISH; ++pass) {
    lemke_respond(s, x, 1, w->raw);
    slacks(s, w->raw, w->z, w->q);
    lcp_correction(w->lcp, w->q, w->dz);
    for (int a = 0; a < w->reduced.n_var; ++a)
      w->z[a] = fmax(0.0, w->z[a] + w->dz[a]);
    lemke_state_of(s, w->z, x);
  }
  lemke_respond(s, x, 1, w->raw);
}

/* Stiffness form: r from raw with the conditions of the basis enforced
 * exactly. */
static void clean_forces(const lemke_run *s, double *r) {
  const lemke_work *w = s->w;
  for (int dof = 0; dof < s->cp->m; ++dof)
    r[dof] = w->kind[dof] == IS_FRICTION ? w->raw[dof] : 0.0;
  for (int a = 0; a < w->reduced.n_var; ++a) {
    int dof = w->reduced.kept[w->var[a].dof];
    if (w->var[a].type == BOUND && !lcp_row_is_tight(w->lcp, a))
      r[dof] = fmin(w->raw[dof], 0.0);
  }
  for (int a = 0; a < w->reduced.n_var; ++a) {
    const variable *v = w->var + a;
    int dof = w->reduced.kept[v->dof];
    if (v->type != SLIDE || w->node.n_slide[v->node_id] != 2) continue;
    double g = contact_node_limit(s->cp, r, v->node_id);
    if (lcp_row_is_tight(w->lcp, a) || v->e[0] * r[dof] < -g)
      r[dof] = -g * v->e[0];
  }
}

/* Compliance form: u from raw, closed and sticking nodes put in place. */
static void clean_motion(const lemke_run *s, double *u) {
  const contact_problem *cp = s->cp;
  const lemke_work *w = s->w;
  COPY(u, w->raw, cp->m);
  for (int a = 0; a < w->reduced.n_var; ++a) {
    const variable *v = w->var + a;
    int dof = w->reduced.kept[v->dof],
        closed = w->z[w->node.normal[v->node_id]] > 0.0;
    if (v->type == BOUND)
      u[dof] = w->z[a] > 0.0 ? contact_bound(cp, dof)
                             : fmin(u[dof], contact_bound(cp, dof));
    if (v->type != LIMIT || w->z[a] > 0.0 || !closed) continue;
    u[dof] = contact_stick(cp, dof);
    if (w->var[a - 1].e[1] != 0.0) u[dof + 1] = contact_stick(cp, dof + 1);
  }
}

/* u[m], r[m] of the final basis. */
static void lemke_set_solution(lemke_run *s, double *u, double *r) {
  if (lemke_is_stiff(s)) {
    polish(s, u);
    clean_forces(s, r);
  } else {
    polish(s, r);
    clean_motion(s, u);
  }
}

/* u[m], r[m] at stick, where the path begins. */
static void lemke_take_base(const lemke_run *s, double *u, double *r) {
  const lemke_work *w = s->w;
  COPY(u, w->reduced.base, s->cp->m);
  lemke_respond(s, u, 1, w->raw);
  for (int dof = 0; dof < s->cp->m; ++dof) {
    r[dof] = w->kind[dof] == IS_FRICTION ? w->raw[dof] : 0.0;
    if (w->kind[dof] == IS_BOUND) r[dof] = fmin(w->raw[dof], 0.0);
  }
}

/* ---- rays: is the motion at the end of the path free, and does the load do
 * more work on it than friction takes. */

static const double RAY_DEFECT = 1e-8;  /* -, forces a free motion may cause */
static const double RAY_WORK = 0x1p-30; /* -, margin of the work of the load */
static const double LOAD_ROUNDING = 0x1p-48; /* -, of the loads */

/* 1: w->ray causes no force, and load more work than "resistance", N m. */
static int motion_is_free(lemke_run *s, double resistance) {
  const contact_problem *cp = s->cp;
  lemke_work *w = s->w;
  double force = 0.0, work = 0.0, noise = 0.0;
  lemke_respond(s, w->ray, 0, w->raw);
  for (int dof = 0; dof < cp->m; ++dof) {
    force = fmax(force, fabs(w->raw[dof]));
    work += cp->f[dof] * w->ray[dof];
    noise += LOAD_ROUNDING * cp->load * fabs(w->ray[dof]);
  }
  return force <= RAY_DEFECT * contact_resistance(cp, w->ray, RAY_DEFECT) &&
         work > noise && work > resistance * (1.0 - RAY_WORK);
}

/* STOPPED_RAY if the ray is a free motion, against the limits of the state it
 * starts from. */
static outcome lemke_check_ray(lemke_run *s) {
  const contact_problem *cp = s->cp;
  lemke_work *w = s->w;
  double resistance = 0.0;
  if (!lemke_is_stiff(s)) return STOPPED_RAY;
  lcp_values(w->lcp, w->z);
  lemke_state_of(s, w->z, w->best_u);
  lemke_respond(s, w->best_u, 1, w->best_r);
  for (int i = 0; i < cp->n; ++i)
    w->best_r[i * cp->dim] = fmin(w->best_r[i * cp->dim], 0.0);
  lcp_ray(w->lcp, w->z);
  CLEAR(w->ray, cp->m);
  lemke_add_motion(w, w->z, w->ray);
  lemke_settle_free(s, 0, w->ray);
  for (int i = 0; i < cp->n && cp->g0 != NULL; ++i) {
    const double *v = w->ray + i * cp->dim + 1;
    resistance += contact_node_limit(cp, w->best_r, i) *
                  (cp->dim == 3 ? hypot(v[0], v[1]) : fabs(v[0]));
  }
  w->has_ray = motion_is_free(s, resistance);
  return w->has_ray ? STOPPED_RAY : STOPPED_STAGNATION;
}

/* 0: a load on free unknowns that nothing resists: the ray is its direction. */
static int lemke_load_is_held(lemke_run *s) {
  lemke_work *w = s->w;
  double worst = 0.0;
  if (w->reduced.n_free == 0 || !s->cp->floating) return 1;
  lemke_respond(s, w->reduced.base, 1, w->raw);
  CLEAR(w->ray, s->cp->m);
  for (int k = 0; k < w->reduced.n_free; ++k) {
    int dof = w->reduced.free_id[k];
    w->ray[dof] = -w->raw[dof];
    worst = fmax(worst, fabs(w->raw[dof]));
  }
  if (!(worst > RAY_DEFECT * contact_scale(s->cp))) return 1;
  w->has_ray = motion_is_free(s, 0.0);
  return !w->has_ray;
}

const double *lemke_ray(const void *work) {
  const lemke_work *w = work;
  return w->has_ray ? w->ray : NULL;
}

typedef struct lemke {
  int facets; /* of the friction polygon, 3-D; 0: 8 */
} lemke;

OPTIONS(
    lemke_options,
    OPTION_INT(lemke, facets, "FACETS", 4, 64, "8", "-",
               "facets of the friction cone of the first stage in 3-D; even"));

static const solver_ops *const correctors[N_CORRECTOR] = {&newton_solver,
                                                          &sor_solver};

/* What a solution first requires it for; the saved data of one need it too. */
static status set_up_corrector(const contact_problem *cp, lemke_work *w,
                               int i) {
  const solver_ops *ops = correctors[i];
  char *param = NULL;
  OWNS(w);
  if (w->corrector.work[i] != NULL) return OK;
  PASS_NEW(param, ops->param_size + 1);
  w->corrector.param[i] = param;
  option_defaults(ops->options, param);
  return solver_set_up(ops, cp, param, &w->corrector.work[i]);
}

static status lemke_setup(const contact_problem *cp, const void *par,
                          void *work) {
  lemke_work *w = work;
  const lemke *p = par;
  size_t m = cp->m;
  w->of = *cp;
  w->m = cp->m;
  w->facets = p->facets >= 4 ? p->facets + p->facets % 2 : 8;
  int n_var = cp->n * (cp->dim == 2 ? 4 : w->facets + 2);
  PASS_NEW_REALS(m, &w->reduced.base, &w->raw, &w->v, &w->t, &w->ray,
                 &w->best_u, &w->best_r);
  PASS_NEW_REALS(n_var, &w->q, &w->d, &w->z, &w->dz);
  PASS_NEW_ALL(
      OF(w->reduced.kept, 2 * m), OF(w->reduced.free_id, 2 * m),
      OF(w->pivot, 2 * m), OF(w->kind, 2 * m), OF(w->node.normal, 2 * m),
      OF(w->node.slide, 2 * m), OF(w->node.n_slide, 2 * m),
      OF(w->reduced.S, m * m), OF(w->reduced.inner, m * m),
      OF(w->spare, cp->floating ? m * m : 0), OF(w->work, 4 * m + 4),
      OF(w->reduced.D, cp->n), OF(w->reduced.tame, cp->n), OF(w->var, n_var));
  return lcp_new(n_var, contact_has_stiffness(cp) ? cp->m : cp->m + 2 * cp->n,
                 &w->lcp);
}

/* The outcome; from the state of a polygon to that of the disc, and from
 * rounding where obstacles travel far, by a solver of the problem itself. */
static status correct(lemke_run *s, double *u, double *r, solver_report *rep) {
  lemke_work *w = s->w;
  rep->residual = contact_residual(s->cp, u, r);
  if (rep->residual <= s->control->tol) return OK;
  rep->outcome = STOPPED_STAGNATION;
  COPY(w->best_u, u, s->cp->m);
  COPY(w->best_r, r, s->cp->m);
  for (int i = 0; i < N_CORRECTOR && rep->outcome != CONVERGED; ++i) {
    const solver_ops *ops = correctors[i];
    solver_report inner = {.outcome = RUNNING};
    if ((ops->handles & NEEDS_STIFFNESS) && !lemke_is_stiff(s)) continue;
    PASS(set_up_corrector(s->cp, w, i));
    COPY(u, w->best_u, s->cp->m);
    COPY(r, w->best_r, s->cp->m);
    PASS(ops->solve(s->cp, w->corrector.param[i], w->corrector.work[i],
                    s->control, u, r, &inner));
    rep->iterations += inner.iterations;
    rep->residual = contact_residual(s->cp, u, r);
    rep->outcome = rep->residual <= s->control->tol ? CONVERGED : inner.outcome;
  }
  return OK;
}

static void report_pivot(const void *ctx, int pivot, double z0) {
  const lemke_run *s = ctx;
  solver_report_states(s->control, "lemke", pivot, z0, 1, 0);
}

static int prepare(lemke_run *s) {
  lemke_sort_unknowns(s);
  lemke_list_variables(s);
  if (!lemke_reduce(s)) return 0;
  lemke_scale(s);
  lemke_tame_limits(s);
  lemke_set_base(s);
  return 1;
}

static outcome follow(lemke_run *s, int *count) {
  lemke_work *w = s->w;
  lcp_report rep;
  /* q and d of the complementarity problem. */
  CLEAR(w->z, w->reduced.n_var);
  lemke_respond(s, w->reduced.base, 1, w->raw);
  slacks(s, w->raw, w->z, w->q);
  for (int a = 0; a < w->reduced.n_var; ++a) w->d[a] = 1.0;
  if (lemke_is_stiff(s)) lemke_add_limits(s, w->z, w->d);
  const lcp_problem p = {
      w->reduced.n_var, w->q,      w->d,         s->control->max_iter,
      lemke_product,    lemke_row, report_pivot, s};
  lcp_run(w->lcp, &p, &rep);
  *count += rep.pivots;
  return rep.outcome == STOPPED_RAY ? lemke_check_ray(s) : rep.outcome;
}

static status lemke_solve(const contact_problem *cp, const void *par,
                          void *work, const solver_control *control, double *u,
                          double *r, solver_report *rep) {
  lemke_work *w = work;
  lemke_run s = {cp, w, control, contact_matrix(cp)};
  *rep = (solver_report){.outcome = STOPPED_SINGULAR};
  w->has_ray = 0;
  if (!prepare(&s)) return OK;
  rep->outcome = STOPPED_RAY;
  if (!lemke_load_is_held(&s)) return OK;
  rep->outcome = follow(&s, &rep->iterations);
  if (rep->outcome == CONVERGED)
    lemke_set_solution(&s, u, r);
  else if (rep->outcome == STOPPED_STAGNATION && lemke_is_stiff(&s))
    lemke_take_base(&s, u, r); /* the pivots followed rounding */
  else
    return OK;
  rep->outcome = CONVERGED;
  return correct(&s, u, r, rep);
}

static status lemke_keep(void *work, archive *a) {
  lemke_work *w = work;
  for (int i = 0; i < N_CORRECTOR; ++i) {
    const solver_ops *ops = correctors[i];
    int used = w->corrector.work[i] != NULL;
    if (ops->keep == NULL) continue;
    IN_GROUP(a, ops->name);
    PASS(archive_ints(a, "used", &used, 1));
    if (!used) continue;
    PASS(set_up_corrector(&w->of, w, i));
    PASS(ops->keep(w->corrector.work[i], a));
  }
  return OK;
}

const solver_ops lemke_solver = {
    SOLVER_OF(lemke), .family = "pivoting",
    .handles = SOLVES_TRESCA | SOLVES_COULOMB | SOLVES_3D | SOLVES_FLOATING,
    .entries = "METHOD=LEMKE, which pivots on columns,", .keep = lemke_keep};
