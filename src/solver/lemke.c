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
 * Compliance form (A not known; W may be singular or slightly unsymmetric):
 * r_t = sum of e_j b_j, slip speed y (Stewart, Trinkle 1996),
 *   p >= 0      gap - u_n >= 0       b_j >= 0      e_j s + y >= 0
 *   y >= 0      g0 + B p - sum b_j >= 0.
 *
 * Tangential unknowns without friction are eliminated first. In 3-D the state
 * found is the start of a solver with the exact disc of friction.
 */
#include "base/memory.h"
#include "lcp/lcp.h"
#include "solver/solver.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <string.h>

typedef struct lemke {
  int facets; /* of the friction polygon, 3-D; 0: 8                           */
} lemke;

/* clang-format off */
static const option lemke_options[] = {
  OPTION_INT(lemke, facets, "FACETS", 4, 64, "8", "-",
             "facets of the friction cone of the first stage in 3-D; even"),
  OPTION_END
};
/* clang-format on */

static const double SINGULAR = 1e-13; /* -, of the largest eigenvalue         */
static const double RAY_DEFECT = 1e-8; /* -, forces a free motion may cause   */
static const double RAY_WORK = 0x1p-30; /* -, margin of the work of the load  */
enum { POLISH = 3, N_CORRECTOR = 2 };
static const char *const corrector_name[N_CORRECTOR] = {"newton", "sor"};

/* What an unknown z of the complementarity problem is. */
typedef enum { BOUND, SLIDE, LIMIT } variable_type;
typedef struct variable {
  variable_type type;
  int node_id, dof; /* dof: of the reduced matrix, the first of two tangents  */
  double e[2];      /* direction; the second is 0 in 2-D                      */
} variable;
typedef enum { IS_BOUND, IS_FRICTION, IS_FREE, IS_HELD } dof_kind;

typedef struct lemke_work {
  int m, facets;
  int n_kept, n_free, n_var; /* reduced unknowns, eliminated ones, z          */
  double unit;               /* of two: S = unit D A D has diagonal <= 1      */
  lcp_work *lcp;
  double *S;     /* [n_kept^2] reduced and scaled matrix                      */
  double *inner; /* [n_free^2] inverse of A_FF, then [n_free*n_kept] that
                    times A_FK                                                */
  double *spare; /* [m*m] or NULL: for the pseudo-inverse                     */
  double *D;     /* [n] scale of a node, power of two                         */
  double *tame;  /* [n] factor of the rows with the limit, power of two      */
  double *base;  /* [m] u (r) at z = 0                                        */
  double *raw;   /* [m] A u - f (W r + q)                                     */
  double *v, *t; /* [m]                                                       */
  double *ray;   /* [m] motion of the last ray                                */
  double *best_u, *best_r, *work; /* [m], [m], [4m]                           */
  int has_ray, has_facets;
  int *kept, *free_id, *pivot, *kind; /* [m]                                  */
  int *normal, *slide, *n_slide;      /* [n] variable of u_n; first SLIDE     */
  variable *var;          /* [n_var]                                         */
  double *q, *d, *z, *dz; /* [n_var]                                         */
  const solver_ops *corrector[N_CORRECTOR];
  void *corrector_param[N_CORRECTOR], *corrector_work[N_CORRECTOR];
} lemke_work;

static void lemke_release(void *work) {
  lemke_work *w = work;
  if (w == NULL) return;
  for (int i = 0; i < N_CORRECTOR; ++i) {
    if (w->corrector[i] != NULL) w->corrector[i]->release(w->corrector_work[i]);
    memory_free(w->corrector_param[i]);
  }
  lcp_free(w->lcp);
  void *const blocks[] = {w->S,     w->inner,  w->spare,  w->D,     w->tame,
                          w->base,  w->raw,    w->v,      w->t,     w->ray,
                          w->work,  w->best_u, w->best_r, w->kept,  w->free_id,
                          w->pivot, w->kind,   w->normal, w->slide, w->n_slide,
                          w->var,   w->q,      w->d,      w->z,     w->dz};
  for (size_t i = 0; i < sizeof blocks / sizeof *blocks; ++i)
    memory_free(blocks[i]);
  memory_free(w);
}

static status set_up_correctors(const contact_problem *cp, lemke_work *w) {
  status st = OK;
  for (int i = 0; i < N_CORRECTOR && cp->dim == 3; ++i) {
    const solver_ops *ops = solver_find(corrector_name[i]);
    if (ops == NULL || !(ops->handles & SOLVES_3D)) continue;
    if ((ops->handles & NEEDS_STIFFNESS) && cp->A == NULL) continue;
    char *param = NULL;
    NEW(param, ops->param_size + 1);
    w->corrector_param[i] = param;
    w->corrector[i] = ops;
    option_defaults(ops->options, param);
    TRY(ops->setup(cp, param, &w->corrector_work[i]));
  }
done:
  return st;
}

static status lemke_setup(const contact_problem *cp, const void *par,
                          void **work) {
  status st = OK;
  lemke_work *w = NULL;
  const lemke *p = par;
  size_t m = (size_t)cp->m;
  NEW(w, 1);
  w->m = cp->m;
  w->facets = p->facets >= 4 ? p->facets + p->facets % 2 : 8;
  int n_var = cp->n * (cp->dim == 2 ? 4 : w->facets + 2);
  double **by_unknown[] = {&w->base, &w->raw,    &w->v,     &w->t,
                           &w->ray,  &w->best_u, &w->best_r};
  double **by_variable[] = {&w->q, &w->d, &w->z, &w->dz};
  int **by_place[] = {&w->kept,   &w->free_id, &w->pivot,  &w->kind,
                      &w->normal, &w->slide,   &w->n_slide};
  for (size_t i = 0; i < sizeof by_unknown / sizeof *by_unknown; ++i)
    NEW(*by_unknown[i], m);
  for (size_t i = 0; i < sizeof by_variable / sizeof *by_variable; ++i)
    NEW(*by_variable[i], n_var);
  for (size_t i = 0; i < sizeof by_place / sizeof *by_place; ++i)
    NEW(*by_place[i], 2 * m);
  NEW(w->S, m * m);
  NEW(w->inner, m * m);
  if (cp->floating) NEW(w->spare, m * m);
  NEW(w->work, 4 * m + 4);
  NEW(w->D, cp->n);
  NEW(w->tame, cp->n);
  NEW(w->var, n_var);
  TRY(lcp_new(n_var, cp->A != NULL ? cp->m : cp->m + 2 * cp->n, &w->lcp));
  TRY(set_up_correctors(cp, w));
  *work = w;
  w = NULL;
done:
  lemke_release(w);
  return st;
}

/* ---- a run --------------------------------------------------------------- */

typedef struct run {
  const contact_problem *cp;
  lemke_work *w;
  const solver_control *control;
  const double *M; /* A or W                                                  */
} run;

static int stiffness_form(const run *s) { return s->cp->A != NULL; }

static int has_friction(const contact_problem *cp, int node_id) {
  if (cp->g0 == NULL) return 0;
  if (contact_has_side(cp, node_id)) return 0;
  if (cp->g0[node_id] != 0.0) return 1;
  for (int k = cp->B == NULL ? 0 : cp->B->start[node_id];
       cp->B != NULL && k < cp->B->start[node_id + 1]; ++k)
    if (cp->B->val[k] != 0.0) return 1;
  return 0;
}

/* Sort the unknowns; those kept (bounded or with friction) come in order. */
static void sort_unknowns(run *s) {
  const contact_problem *cp = s->cp;
  lemke_work *w = s->w;
  w->n_kept = w->n_free = 0;
  for (int dof = 0; dof < cp->m; ++dof) {
    dof_kind kind = IS_FREE;
    if (contact_held(cp, dof))
      kind = IS_HELD;
    else if (contact_bound(cp, dof) < HUGE_VAL)
      kind = IS_BOUND;
    else if (has_friction(cp, dof / cp->dim))
      kind = IS_FRICTION;
    w->kind[dof] = (int)kind;
    if (kind == IS_FREE) w->free_id[w->n_free++] = dof;
    if (kind == IS_BOUND || kind == IS_FRICTION) w->kept[w->n_kept++] = dof;
  }
}

/* The directions of slip of a node whose first tangent is "dof". */
static void add_directions(lemke_work *w, int node_id, int dof, int tangents) {
  int count = tangents == 1 ? 2 : w->facets;
  const double full = 2.0 * acos(-1.0);
  w->slide[node_id] = w->n_var;
  w->n_slide[node_id] = count;
  if (tangents == 2) w->has_facets = 1;
  for (int j = 0; j < count; ++j) {
    int half = j % (count / 2);
    double sign = j < count / 2 ? 1.0 : -1.0, angle = full * half / count;
    variable v = {SLIDE, node_id, dof, {sign, 0.0}};
    if (tangents == 2) {
      v.e[0] = sign * cos(angle);
      v.e[1] = sign * sin(angle);
    }
    w->var[w->n_var++] = v;
  }
}

static void list_variables(run *s) {
  lemke_work *w = s->w;
  int dim = s->cp->dim;
  w->n_var = w->has_facets = 0;
  for (int i = 0; i < s->cp->n; ++i) w->n_slide[i] = 0;
  for (int i = 0; i < w->n_kept; ++i) {
    int dof = w->kept[i], node_id = dof / dim;
    if (w->kind[dof] == IS_BOUND) {
      if (dof % dim == 0) w->normal[node_id] = w->n_var;
      w->var[w->n_var++] = (variable){BOUND, node_id, i, {-1.0, 0.0}};
    } else if (w->n_slide[node_id] == 0) {
      int two = i + 1 < w->n_kept && w->kept[i + 1] / dim == node_id;
      add_directions(w, node_id, i, two ? 2 : 1);
      if (!stiffness_form(s))
        w->var[w->n_var++] = (variable){LIMIT, node_id, i, {0.0, 0.0}};
    }
  }
}

/* ---- reduced matrix ------------------------------------------------------ */

static void gather(const run *s, int n_row, const int *row, int n_col,
                   const int *col, double *to) {
  for (int j = 0; j < n_col; ++j) {
    const double *from = s->M + (size_t)col[j] * (size_t)s->cp->m;
    double *column = to + (size_t)j * (size_t)n_row;
    for (int i = 0; i < n_row; ++i) column[i] = from[row[i]];
  }
}

/* inner = inv(A_FF); 0: singular. */
static int invert_free(run *s) {
  lemke_work *w = s->w;
  int n = w->n_free;
  gather(s, n, w->free_id, n, w->free_id, w->inner);
  return LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, n, n, w->inner, n, w->pivot) ==
             0 &&
         LAPACKE_dgetri_work(LAPACK_COL_MAJOR, n, w->inner, n, w->pivot,
                             w->work, 4 * w->m) == 0;
}

/* inner = pseudo-inverse of A_FF: motions that nothing resists stay out. */
static int pseudo_invert_free(run *s) {
  lemke_work *w = s->w;
  int n = w->n_free;
  size_t ld = (size_t)n;
  gather(s, n, w->free_id, n, w->free_id, w->spare);
  if (LAPACKE_dsyev_work(LAPACK_COL_MAJOR, 'V', 'L', n, w->spare, n, w->t,
                         w->work, 4 * w->m + 4) != 0)
    return 0;
  memset(w->inner, 0, ld * ld * sizeof *w->inner);
  for (size_t k = 0; k < ld; ++k)
    if (w->t[k] > SINGULAR * w->t[n - 1])
      cblas_dger(CblasColMajor, n, n, 1.0 / w->t[k], w->spare + k * ld, 1,
                 w->spare + k * ld, 1, w->inner, n);
  return 1;
}

/* S = A_KK - A_KF inv(A_FF) A_FK (W_KK in the compliance form). */
static int reduce(run *s) {
  lemke_work *w = s->w;
  int nk = w->n_kept, nf = w->n_free;
  gather(s, nk, w->kept, nk, w->kept, w->S);
  if (!stiffness_form(s)) w->n_free = nf = 0;
  if (nf == 0) return 1;
  if (!(s->cp->floating ? pseudo_invert_free(s) : invert_free(s))) return 0;
  double *X = w->inner + (size_t)nf * (size_t)nf;
  for (int j = 0; j < nk; ++j) {
    gather(s, nf, w->free_id, 1, &w->kept[j], w->t);
    contact_product(nf, w->inner, w->t, X + (size_t)j * (size_t)nf);
  }
  for (int k = 0; k < nf; ++k) {
    gather(s, nk, w->kept, 1, &w->free_id[k], w->t);
    cblas_dger(CblasColMajor, nk, nk, -1.0, w->t, 1, X + k, nf, w->S, nk);
  }
  return 1;
}

/* Powers of two that bring the diagonal of S to order 1, one per node. */
static void scale(run *s) {
  lemke_work *w = s->w;
  int dim = s->cp->dim, nk = w->n_kept, top = 0;
  double largest = 0.0;
  for (int i = 0; i < s->cp->n; ++i) w->D[i] = 0.0;
  for (int i = 0; i < nk; ++i) {
    double a = w->S[(size_t)i * (size_t)nk + (size_t)i];
    double *D = w->D + w->kept[i] / dim;
    *D = fmax(*D, a);
    largest = fmax(largest, a);
  }
  if (largest > 0.0 && largest < HUGE_VAL) frexp(largest, &top);
  w->unit = ldexp(1.0, -top);
  for (int i = 0; i < s->cp->n; ++i) {
    int exponent = top;
    if (w->D[i] > 0x1p-60 * largest) frexp(w->D[i], &exponent);
    w->D[i] = ldexp(1.0, (top - exponent) / 2);
  }
  for (int j = 0; j < nk; ++j)
    for (int i = 0; i < nk; ++i)
      w->S[(size_t)j * (size_t)nk + (size_t)i] *=
          w->unit * w->D[w->kept[i] / dim] * w->D[w->kept[j] / dim];
}

/* ---- the matrix of the complementarity problem --------------------------- */

/* Entries of a row of B: from *first to *last - 1. */
static void limit_range(const run *s, int node_id, int *first, int *last) {
  const sparse_rows *B = s->cp->B;
  *first = B == NULL ? 0 : B->start[node_id];
  *last = B == NULL ? 0 : B->start[node_id + 1];
}

/* Entry of B between the scaled limits and pressures of two nodes. */
static double limit_entry(const run *s, int node_id, int k) {
  const lemke_work *w = s->w;
  double from = w->D[s->cp->B->col[k]], to = w->D[node_id];
  return s->cp->B->val[k] * (stiffness_form(s) ? to / from : from / to);
}

/* sum of B_ik p_k of one node; p: values by variable. */
static double limit_sum(const run *s, int node_id, const double *p) {
  int first, last;
  double sum = 0.0;
  limit_range(s, node_id, &first, &last);
  for (int k = first; k < last; ++k)
    sum += limit_entry(s, node_id, k) * p[s->w->normal[s->cp->B->col[k]]];
  return sum;
}

/* The rows with the limit grow with mu: a factor for each. */
static void tame_limits(run *s) {
  for (int i = 0; i < s->cp->n; ++i) {
    int first, last, exponent;
    double sum = 1.0;
    limit_range(s, i, &first, &last);
    for (int k = first; k < last; ++k) sum += limit_entry(s, i, k);
    frexp(sum, &exponent);
    s->w->tame[i] = ldexp(1.0, 1 - exponent);
  }
}

/* 1: the row of this variable holds the limit. */
static int has_limit(const run *s, const variable *v) {
  return v->type == (stiffness_form(s) ? SLIDE : LIMIT);
}

/* What friction adds to the rows y of V' S V z: with z (and y before) in the
 * compliance form, the pressures in y else. */
static void add_limits(const run *s, const double *z, double *y) {
  const lemke_work *w = s->w;
  int stiff = stiffness_form(s);
  for (int a = 0; a < w->n_var; ++a) {
    const variable *v = w->var + a;
    if (!has_limit(s, v)) continue;
    int first = w->slide[v->node_id], last = first + w->n_slide[v->node_id];
    y[a] += limit_sum(s, v->node_id, stiff ? y : z);
    for (int j = first; j < last && !stiff; ++j) {
      y[a] -= z[j];
      y[j] += z[a];
    }
    y[a] *= w->tame[v->node_id];
  }
}

/* v[n_kept] = sum of x V(:, id) */
static void spread(const run *s, int n_id, const int *id, const double *x,
                   double *v) {
  memset(v, 0, (size_t)s->w->n_kept * sizeof *v);
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
static void multiply(const run *s, const double *v, double *t) {
  const lemke_work *w = s->w;
  int n = w->n_kept, filled = 0;
  for (int i = 0; i < n; ++i) filled += v[i] != 0.0;
  if (2 * filled > n) {
    contact_product(n, w->S, v, t);
    return;
  }
  memset(t, 0, (size_t)n * sizeof *t);
  for (int i = 0; i < n; ++i)
    if (v[i] != 0.0)
      cblas_daxpy(n, v[i], w->S + (size_t)i * (size_t)n, 1, t, 1);
}

static void product(const void *ctx, int n_id, const int *id, const double *x,
                    double *y) {
  const run *s = ctx;
  const lemke_work *w = s->w;
  spread(s, n_id, id, x, w->v);
  multiply(s, w->v, w->t);
  for (int a = 0; a < w->n_var; ++a)
    y[a] = w->var[a].type == LIMIT ? 0.0 : along(&w->var[a], w->t);
  for (int a = 0; a < w->n_var && !stiffness_form(s); ++a) w->dz[a] = 0.0;
  for (int k = 0; k < n_id && !stiffness_form(s); ++k) w->dz[id[k]] = x[k];
  add_limits(s, w->dz, y);
}

/* What friction adds to a row at the columns id (compliance form). */
static void add_limit_row(const run *s, const variable *v, int n_id,
                          const int *id, double *to) {
  const lemke_work *w = s->w;
  int first, last;
  limit_range(s, v->node_id, &first, &last);
  for (int k = 0; k < n_id; ++k) {
    const variable *a = w->var + id[k];
    int same = a->node_id == v->node_id;
    if (v->type == SLIDE && a->type == LIMIT && same) to[k] += 1.0;
    if (v->type != LIMIT) continue;
    if (a->type == SLIDE && same) to[k] -= 1.0;
    for (int e = first; e < last; ++e)
      if (w->normal[s->cp->B->col[e]] == id[k])
        to[k] += limit_entry(s, v->node_id, e);
  }
}

static void row(const void *ctx, int i, int n_id, const int *id, double *to) {
  const run *s = ctx;
  const lemke_work *w = s->w;
  const variable *v = w->var + i;
  int first, last, n = w->n_kept, stiff = stiffness_form(s);
  limit_range(s, v->node_id, &first, &last);
  memset(w->t, 0, (size_t)w->n_kept * sizeof *w->t);
  for (int k = 0; k < 2; ++k)
    if (v->e[k] != 0.0) cblas_daxpy(n, v->e[k], w->S + v->dof + k, n, w->t, 1);
  for (int k = first; k < last && stiff && v->type == SLIDE; ++k)
    cblas_daxpy(n, -limit_entry(s, v->node_id, k),
                w->S + w->var[w->normal[s->cp->B->col[k]]].dof, n, w->t, 1);
  for (int k = 0; k < n_id; ++k)
    to[k] = w->var[id[k]].type == LIMIT ? 0.0 : along(w->var + id[k], w->t);
  if (!stiff) add_limit_row(s, v, n_id, id, to);
  if (has_limit(s, v)) cblas_dscal(n_id, w->tame[v->node_id], to, 1);
}

/* ---- vectors ------------------------------------------------------------- */

/* raw = A u - f, or W r + q; load 0: without f or q. */
static void respond(const run *s, const double *x, int load, double *raw) {
  double sign = stiffness_form(s) ? -1.0 : 1.0;
  contact_product(s->cp->m, s->M, x, raw);
  if (load) cblas_daxpy(s->cp->m, sign, s->cp->f, 1, raw, 1);
}

/* The free unknowns in equilibrium with the others. */
static void settle_free(const run *s, int load, double *u) {
  const lemke_work *w = s->w;
  int n = w->n_free;
  for (int pass = 0; pass < 2 && n > 0; ++pass) {
    respond(s, u, load, w->raw);
    for (int k = 0; k < n; ++k) w->v[k] = -w->raw[w->free_id[k]];
    contact_product(n, w->inner, w->v, w->t);
    for (int k = 0; k < n; ++k) u[w->free_id[k]] += w->t[k];
  }
}

/* State at z = 0. */
static void set_base(run *s) {
  const contact_problem *cp = s->cp;
  lemke_work *w = s->w;
  memset(w->base, 0, (size_t)cp->m * sizeof *w->base);
  if (!stiffness_form(s)) return;
  for (int dof = 0; dof < cp->m; ++dof) {
    size_t at = (size_t)dof * (size_t)cp->m + (size_t)dof;
    if (w->kind[dof] == IS_BOUND) w->base[dof] = contact_bound(cp, dof);
    if (w->kind[dof] == IS_FRICTION) w->base[dof] = contact_stick(cp, dof);
    if (w->kind[dof] == IS_HELD) w->base[dof] = cp->f[dof] / cp->A[at];
  }
  settle_free(s, 1, w->base);
}

/* w of every variable from raw, scaled as the matrix is; z: scaled, for the
 * compliance form. */
static void slacks(const run *s, const double *raw, const double *z,
                   double *to) {
  const contact_problem *cp = s->cp;
  const lemke_work *w = s->w;
  int stiff = stiffness_form(s);
  for (int a = 0; a < w->n_var; ++a) {
    const variable *v = w->var + a;
    double unit = w->unit * w->D[v->node_id], g0 = 0.0;
    int dof = w->kept[v->dof];
    if (v->type == BOUND)
      to[a] = unit * (stiff ? -raw[dof] : contact_bound(cp, dof) - raw[dof]);
    if (has_limit(s, v)) g0 = cp->g0[v->node_id];
    if (v->type == LIMIT) to[a] = g0 / w->D[v->node_id];
    if (v->type != SLIDE) continue;
    double sum =
        g0 + v->e[0] * (raw[dof] - (stiff ? 0.0 : contact_stick(cp, dof)));
    if (v->e[1] != 0.0)
      sum +=
          v->e[1] * (raw[dof + 1] - (stiff ? 0.0 : contact_stick(cp, dof + 1)));
    to[a] = unit * sum;
  }
  add_limits(s, z, to);
}

/* x += the motion (forces) of z on the unknowns kept, unscaled. */
static void add_motion(const lemke_work *w, const double *z, double *x) {
  for (int a = 0; a < w->n_var; ++a) {
    const variable *v = w->var + a;
    double size = w->D[v->node_id] * z[a];
    if (v->type == LIMIT || size == 0.0) continue;
    x[w->kept[v->dof]] += v->e[0] * size;
    if (v->e[1] != 0.0) x[w->kept[v->dof + 1]] += v->e[1] * size;
  }
}

/* x = the state at z. */
static void state_of(const run *s, const double *z, double *x) {
  memcpy(x, s->w->base, (size_t)s->cp->m * sizeof *x);
  add_motion(s->w, z, x);
  settle_free(s, 1, x);
}

/* ---- solution ------------------------------------------------------------ */

static void set_vectors(run *s) {
  lemke_work *w = s->w;
  memset(w->z, 0, (size_t)w->n_var * sizeof *w->z);
  respond(s, w->base, 1, w->raw);
  slacks(s, w->raw, w->z, w->q);
  for (int a = 0; a < w->n_var; ++a) w->d[a] = 1.0;
  if (stiffness_form(s)) add_limits(s, w->z, w->d);
}

/* Take what the rows of the final basis miss, measured with the given matrix,
 * out of z. */
static void polish(run *s, double *x) {
  lemke_work *w = s->w;
  lcp_values(w->lcp, w->z);
  state_of(s, w->z, x);
  for (int pass = 0; pass < POLISH; ++pass) {
    respond(s, x, 1, w->raw);
    slacks(s, w->raw, w->z, w->q);
    lcp_correction(w->lcp, w->q, w->dz);
    for (int a = 0; a < w->n_var; ++a) w->z[a] = fmax(0.0, w->z[a] + w->dz[a]);
    state_of(s, w->z, x);
  }
  respond(s, x, 1, w->raw);
}

/* Stiffness form: r from raw with what the basis says put in exactly. */
static void clean_forces(const run *s, double *r) {
  const contact_problem *cp = s->cp;
  const lemke_work *w = s->w;
  for (int dof = 0; dof < cp->m; ++dof)
    r[dof] = w->kind[dof] == IS_FRICTION ? w->raw[dof] : 0.0;
  for (int a = 0; a < w->n_var; ++a) {
    int dof = w->kept[w->var[a].dof];
    if (w->var[a].type == BOUND && !lcp_row_is_tight(w->lcp, a))
      r[dof] = fmin(w->raw[dof], 0.0);
  }
  for (int a = 0; a < w->n_var; ++a) {
    const variable *v = w->var + a;
    int dof = w->kept[v->dof];
    if (v->type != SLIDE || w->n_slide[v->node_id] != 2) continue;
    double g = contact_node_limit(cp, r, v->node_id);
    if (lcp_row_is_tight(w->lcp, a) || v->e[0] * r[dof] < -g)
      r[dof] = -g * v->e[0];
  }
}

/* Compliance form: u from raw, closed and sticking nodes put in place. */
static void clean_motion(const run *s, double *u) {
  const contact_problem *cp = s->cp;
  const lemke_work *w = s->w;
  memcpy(u, w->raw, (size_t)cp->m * sizeof *u);
  for (int a = 0; a < w->n_var; ++a) {
    const variable *v = w->var + a;
    int dof = w->kept[v->dof], closed = w->z[w->normal[v->node_id]] > 0.0;
    if (v->type == BOUND)
      u[dof] = w->z[a] > 0.0 ? contact_bound(cp, dof)
                             : fmin(u[dof], contact_bound(cp, dof));
    if (v->type != LIMIT || w->z[a] > 0.0 || !closed) continue;
    u[dof] = contact_stick(cp, dof);
    if (w->var[a - 1].e[1] != 0.0) u[dof + 1] = contact_stick(cp, dof + 1);
  }
}

static void set_solution(run *s, double *u, double *r) {
  if (stiffness_form(s)) {
    polish(s, u);
    clean_forces(s, r);
  } else {
    polish(s, r);
    clean_motion(s, u);
  }
}

/* ---- ray ----------------------------------------------------------------- */

/* 1: the motion w->ray causes no force, and the load does more work on it than
 * "resistance", N m. */
static int motion_is_free(run *s, double resistance) {
  const contact_problem *cp = s->cp;
  lemke_work *w = s->w;
  double force = 0.0, size = 0.0, work = 0.0;
  respond(s, w->ray, 0, w->raw);
  for (int dof = 0; dof < cp->m; ++dof) {
    size_t at = (size_t)dof * (size_t)cp->m + (size_t)dof;
    force = fmax(force, fabs(w->raw[dof]));
    size = fmax(size, cp->A[at] * fabs(w->ray[dof]));
    work += cp->f[dof] * w->ray[dof];
  }
  return force <= RAY_DEFECT * size && work > 0.0 &&
         work > resistance * (1.0 - RAY_WORK);
}

/* STOPPED_RAY if the ray is a free motion in fact, against the limits of the
 * state it starts from. */
static outcome judge_ray(run *s) {
  const contact_problem *cp = s->cp;
  lemke_work *w = s->w;
  double resistance = 0.0;
  if (!stiffness_form(s)) return STOPPED_RAY;
  lcp_values(w->lcp, w->z);
  state_of(s, w->z, w->best_u);
  respond(s, w->best_u, 1, w->best_r);
  for (int i = 0; i < cp->n; ++i)
    w->best_r[i * cp->dim] = fmin(w->best_r[i * cp->dim], 0.0);
  lcp_ray(w->lcp, w->z);
  memset(w->ray, 0, (size_t)cp->m * sizeof *w->ray);
  add_motion(w, w->z, w->ray);
  settle_free(s, 0, w->ray);
  for (int i = 0; i < cp->n && cp->g0 != NULL; ++i) {
    const double *v = w->ray + i * cp->dim + 1;
    resistance += contact_node_limit(cp, w->best_r, i) *
                  (cp->dim == 3 ? hypot(v[0], v[1]) : fabs(v[0]));
  }
  w->has_ray = motion_is_free(s, resistance);
  return w->has_ray ? STOPPED_RAY : STOPPED_STAGNATION;
}

/* 0: a load on free unknowns that nothing resists: the ray is its direction. */
static int free_load_is_held(run *s) {
  lemke_work *w = s->w;
  double worst = 0.0;
  if (w->n_free == 0 || !s->cp->floating) return 1;
  respond(s, w->base, 1, w->raw);
  memset(w->ray, 0, (size_t)s->cp->m * sizeof *w->ray);
  for (int k = 0; k < w->n_free; ++k) {
    int dof = w->free_id[k];
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

/* ---- 3-D ----------------------------------------------------------------- */

/* The verdict; from the state of the polygon to that of the disc by a solver
 * that knows it. */
static status correct(run *s, double *u, double *r, solver_report *rep) {
  status st = OK;
  lemke_work *w = s->w;
  size_t bytes = (size_t)s->cp->m * sizeof *u;
  rep->residual = contact_residual(s->cp, u, r);
  if (rep->residual <= s->control->tol) goto done;
  rep->outcome = STOPPED_STAGNATION;
  if (!w->has_facets) goto done;
  memcpy(w->best_u, u, bytes);
  memcpy(w->best_r, r, bytes);
  for (int i = 0; i < N_CORRECTOR && rep->outcome != CONVERGED; ++i) {
    solver_report inner = {.outcome = RUNNING};
    if (w->corrector[i] == NULL) continue;
    memcpy(u, w->best_u, bytes);
    memcpy(r, w->best_r, bytes);
    TRY(w->corrector[i]->solve(s->cp, w->corrector_param[i],
                               w->corrector_work[i], s->control, u, r, &inner));
    rep->iterations += inner.iterations;
    rep->residual = contact_residual(s->cp, u, r);
    rep->outcome = rep->residual <= s->control->tol ? CONVERGED : inner.outcome;
  }
done:
  return st;
}

/* ---- solver -------------------------------------------------------------- */

static void tell(const void *ctx, int pivot, double z0) {
  const run *s = ctx;
  solver_tell_states(s->control, "lemke", pivot, z0, 1, 0);
}

static int prepare(run *s) {
  sort_unknowns(s);
  list_variables(s);
  if (!reduce(s)) return 0;
  scale(s);
  tame_limits(s);
  set_base(s);
  return 1;
}

static outcome follow(run *s, int *count) {
  lemke_work *w = s->w;
  lcp_report rep;
  set_vectors(s);
  lcp_problem p = {.n = w->n_var, .q = w->q, .d = w->d, .ctx = s};
  p.max_pivots = s->control->max_iter;
  p.product = product;
  p.row = row;
  p.each = tell;
  lcp_run(w->lcp, &p, &rep);
  *count += rep.pivots;
  return rep.outcome == STOPPED_RAY ? judge_ray(s) : rep.outcome;
}

static status lemke_solve(const contact_problem *cp, const void *par,
                          void *work, const solver_control *control, double *u,
                          double *r, solver_report *rep) {
  status st = OK;
  lemke_work *w = work;
  run s = {cp, w, control, cp->A != NULL ? cp->A : cp->W};
  (void)par;
  *rep = (solver_report){.outcome = STOPPED_SINGULAR};
  w->has_ray = 0;
  if (!prepare(&s)) goto done;
  rep->outcome = STOPPED_RAY;
  if (!free_load_is_held(&s)) goto done;
  rep->outcome = follow(&s, &rep->iterations);
  if (rep->outcome != CONVERGED) goto done;
  set_solution(&s, u, r);
  TRY(correct(&s, u, r, rep));
done:
  return st;
}

static status lemke_keep(void *work, archive *a) {
  status st = OK;
  lemke_work *w = work;
  for (int i = 0; i < N_CORRECTOR && st == OK; ++i) {
    if (w->corrector[i] == NULL || w->corrector[i]->keep == NULL) continue;
    archive_enter(a, w->corrector[i]->name);
    st = w->corrector[i]->keep(w->corrector_work[i], a);
    archive_leave(a);
  }
  return st;
}

/* clang-format off */
const solver_ops lemke_solver = {
  .name = "lemke",
  .reference = "Lemke 1965; Cottle, Pang, Stone 1992; Klarbring 1986",
  .family = "pivoting",
  .help =
    "Complementary pivoting with the lexicographic rule. The frictionless\n"
    "and the 2-D frictional problem are each one linear complementarity\n"
    "problem, without a fixed point on the sliding limit: from a body pressed\n"
    "into stick to the real load, one change of state a pivot. It never\n"
    "cycles, has a solution for every friction coefficient if the body is\n"
    "supported; a body held by contact alone ends in equilibrium or in a\n"
    "motion that proves there is none. In 3-D the cone has FACETS facets; the\n"
    "state is then corrected to the exact cone by NEWTON or SOR. For up to\n"
    "some hundred contact nodes, and where other methods disagree or fail.",
  .handles = SOLVES_TRESCA | SOLVES_COULOMB | SOLVES_3D | SOLVES_FLOATING,
  .param_size = sizeof(lemke),
  .options = lemke_options,
  .setup = lemke_setup,
  .solve = lemke_solve,
  .release = lemke_release,
  .keep = lemke_keep
};
/* clang-format on */
