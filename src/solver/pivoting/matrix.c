/*
 * The matrix M of the complementarity problem, never formed: V' S V of the
 * directions V, and the rows with the sliding limit.
 */
#include "solver/pivoting/parts.h"

#include <cblas.h>
#include <math.h>
#include <string.h>

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
  double from = w->D[s->cp->B->col[k]], to = w->D[node_id];
  return s->cp->B->val[k] * (lemke_is_stiff(s) ? to / from : from / to);
}

/* sum of B_ik p_k of one node; p: values by variable. */
static double limit_sum(const lemke_run *s, int node_id, const double *p) {
  int first, last;
  double sum = 0.0;
  limit_range(s, node_id, &first, &last);
  for (int k = first; k < last; ++k)
    sum += limit_entry(s, node_id, k) * p[s->w->normal[s->cp->B->col[k]]];
  return sum;
}

void lemke_tame_limits(lemke_run *s) {
  for (int i = 0; i < s->cp->n; ++i) {
    int first, last, exponent;
    double sum = 1.0;
    limit_range(s, i, &first, &last);
    for (int k = first; k < last; ++k) sum += limit_entry(s, i, k);
    frexp(sum, &exponent);
    s->w->tame[i] = ldexp(1.0, 1 - exponent);
  }
}

int lemke_has_limit(const lemke_run *s, const variable *v) {
  return v->type == (lemke_is_stiff(s) ? SLIDE : LIMIT);
}

void lemke_add_limits(const lemke_run *s, const double *z, double *y) {
  const lemke_work *w = s->w;
  int stiff = lemke_is_stiff(s);
  for (int a = 0; a < w->n_var; ++a) {
    const variable *v = w->var + a;
    if (!lemke_has_limit(s, v)) continue;
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
static void spread(const lemke_run *s, int n_id, const int *id, const double *x,
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
static void multiply(const lemke_run *s, const double *v, double *t) {
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

void lemke_product(const void *ctx, int n_id, const int *id, const double *x,
                   double *y) {
  const lemke_run *s = ctx;
  const lemke_work *w = s->w;
  spread(s, n_id, id, x, w->v);
  multiply(s, w->v, w->t);
  for (int a = 0; a < w->n_var; ++a)
    y[a] = w->var[a].type == LIMIT ? 0.0 : along(&w->var[a], w->t);
  for (int a = 0; a < w->n_var && !lemke_is_stiff(s); ++a) w->dz[a] = 0.0;
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
      if (w->normal[s->cp->B->col[e]] == id[k])
        to[k] += limit_entry(s, v->node_id, e);
  }
}

void lemke_row(const void *ctx, int i, int n_id, const int *id, double *to) {
  const lemke_run *s = ctx;
  const lemke_work *w = s->w;
  const variable *v = w->var + i;
  int first, last, n = w->n_kept, stiff = lemke_is_stiff(s);
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
  if (lemke_has_limit(s, v)) cblas_dscal(n_id, w->tame[v->node_id], to, 1);
}
