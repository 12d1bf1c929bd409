/*
 * The matrix M of the complementarity problem, never formed: V' S V of the
 * directions V, and the rows with the sliding limit.
 */
#include "solver/pivoting/parts.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <string.h>

/* ---- unknowns of the contact problem and variables z of the complementarity
 * problem: which are kept, and what each one stands for. */

static int has_friction(const contact_problem *cp, int node_id) {
  if (cp->g0 == NULL) return 0;
  if (contact_has_side(cp, node_id)) return 0;
  if (cp->g0[node_id] != 0.0) return 1;
  for (int k = cp->B == NULL ? 0 : cp->B->start[node_id];
       cp->B != NULL && k < cp->B->start[node_id + 1]; ++k)
    if (cp->B->val[k] != 0.0) return 1;
  return 0;
}

void lemke_sort_unknowns(lemke_run *s) {
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

void lemke_list_variables(lemke_run *s) {
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
    const double *from = s->M + (size_t)col[j] * (size_t)s->cp->m;
    double *column = to + (size_t)j * (size_t)n_row;
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
  size_t ld = (size_t)n;
  gather(s, n, w->reduced.free_id, n, w->reduced.free_id, w->spare);
  if (LAPACKE_dsyev_work(LAPACK_COL_MAJOR, 'V', 'L', n, w->spare, n, w->t,
                         w->work, 4 * w->m + 4) != 0)
    return 0;
  memset(w->reduced.inner, 0, ld * ld * sizeof *w->reduced.inner);
  for (size_t k = 0; k < ld; ++k)
    if (w->t[k] > SINGULAR * w->t[n - 1])
      cblas_dger(CblasColMajor, n, n, 1.0 / w->t[k], w->spare + k * ld, 1,
                 w->spare + k * ld, 1, w->reduced.inner, n);
  return 1;
}

int lemke_reduce(lemke_run *s) {
  lemke_work *w = s->w;
  int nk = w->reduced.n_kept, nf = w->reduced.n_free;
  gather(s, nk, w->reduced.kept, nk, w->reduced.kept, w->reduced.S);
  if (!lemke_is_stiff(s)) w->reduced.n_free = nf = 0;
  if (nf == 0) return 1;
  if (!(s->cp->floating ? pseudo_invert_free(s) : invert_free(s))) return 0;
  double *X = w->reduced.inner + (size_t)nf * (size_t)nf;
  for (int j = 0; j < nk; ++j) {
    gather(s, nf, w->reduced.free_id, 1, &w->reduced.kept[j], w->t);
    contact_product(nf, w->reduced.inner, w->t, X + (size_t)j * (size_t)nf);
  }
  for (int k = 0; k < nf; ++k) {
    gather(s, nk, w->reduced.kept, 1, &w->reduced.free_id[k], w->t);
    cblas_dger(CblasColMajor, nk, nk, -1.0, w->t, 1, X + k, nf, w->reduced.S,
               nk);
  }
  return 1;
}

void lemke_scale(lemke_run *s) {
  lemke_work *w = s->w;
  int dim = s->cp->dim, nk = w->reduced.n_kept, top = 0;
  double largest = 0.0;
  for (int i = 0; i < s->cp->n; ++i) w->reduced.D[i] = 0.0;
  for (int i = 0; i < nk; ++i) {
    double a = w->reduced.S[(size_t)i * (size_t)nk + (size_t)i];
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
      w->reduced.S[(size_t)j * (size_t)nk + (size_t)i] *=
          w->unit * w->reduced.D[w->reduced.kept[i] / dim] *
          w->reduced.D[w->reduced.kept[j] / dim];
}

/* Entries of a row of B: from *first to *last - 1. */
static void limit_range(const lemke_run *s, int node_id, int *first,
                        int *last) {
  const sparse_rows *B = s->cp->B;
  *first = B == NULL ? 0 : B->start[node_id];
  *last = B == NULL ? 0 : B->start[node_id + 1];
}

/* Entry of B between the scaled limits and pressures of two nodes. */
static double limit_entry(const lemke_run *s, int node_id, int k) {
  const lemke_work *w = s->w;
  double from = w->reduced.D[s->cp->B->col[k]], to = w->reduced.D[node_id];
  return s->cp->B->val[k] * (lemke_is_stiff(s) ? to / from : from / to);
}

/* sum of B_ik p_k of one node; p: values by variable. */
static double limit_sum(const lemke_run *s, int node_id, const double *p) {
  int first, last;
  double sum = 0.0;
  limit_range(s, node_id, &first, &last);
  for (int k = first; k < last; ++k)
    sum += limit_entry(s, node_id, k) * p[s->w->node.normal[s->cp->B->col[k]]];
  return sum;
}

void lemke_tame_limits(lemke_run *s) {
  for (int i = 0; i < s->cp->n; ++i) {
    int first, last, exponent;
    double sum = 1.0;
    limit_range(s, i, &first, &last);
    for (int k = first; k < last; ++k) sum += limit_entry(s, i, k);
    frexp(sum, &exponent);
    s->w->reduced.tame[i] = ldexp(1.0, 1 - exponent);
  }
}

int lemke_has_limit(const lemke_run *s, const variable *v) {
  return v->type == (lemke_is_stiff(s) ? SLIDE : LIMIT);
}

void lemke_add_limits(const lemke_run *s, const double *z, double *y) {
  const lemke_work *w = s->w;
  int stiff = lemke_is_stiff(s);
  for (int a = 0; a < w->reduced.n_var; ++a) {
    const variable *v = w->var + a;
    if (!lemke_has_limit(s, v)) continue;
    int first = w->node.slide[v->node_id],
        last = first + w->node.n_slide[v->node_id];
    y[a] += limit_sum(s, v->node_id, stiff ? y : z);
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
  memset(v, 0, (size_t)s->w->reduced.n_kept * sizeof *v);
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
  memset(t, 0, (size_t)n * sizeof *t);
  for (int i = 0; i < n; ++i)
    if (v[i] != 0.0)
      cblas_daxpy(n, v[i], w->reduced.S + (size_t)i * (size_t)n, 1, t, 1);
}

void lemke_product(const void *ctx, int n_id, const int *id, const double *x,
                   double *y) {
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
      if (w->node.normal[s->cp->B->col[e]] == id[k])
        to[k] += limit_entry(s, v->node_id, e);
  }
}

void lemke_row(const void *ctx, int i, int n_id, const int *id, double *to) {
  const lemke_run *s = ctx;
  const lemke_work *w = s->w;
  const variable *v = w->var + i;
  int first, last, n = w->reduced.n_kept, stiff = lemke_is_stiff(s);
  limit_range(s, v->node_id, &first, &last);
  memset(w->t, 0, (size_t)w->reduced.n_kept * sizeof *w->t);
  for (int k = 0; k < 2; ++k)
    if (v->e[k] != 0.0)
      cblas_daxpy(n, v->e[k], w->reduced.S + v->dof + k, n, w->t, 1);
  for (int k = first; k < last && stiff && v->type == SLIDE; ++k)
    cblas_daxpy(n, -limit_entry(s, v->node_id, k),
                w->reduced.S + w->var[w->node.normal[s->cp->B->col[k]]].dof, n,
                w->t, 1);
  for (int k = 0; k < n_id; ++k)
    to[k] = w->var[id[k]].type == LIMIT ? 0.0 : along(w->var + id[k], w->t);
  if (!stiff) add_limit_row(s, v, n_id, id, to);
  if (lemke_has_limit(s, v))
    cblas_dscal(n_id, w->reduced.tame[v->node_id], to, 1);
}
