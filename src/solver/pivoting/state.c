/*
 * States of the body: at z = 0, at a given z, and at the end, where what the
 * basis says is put in exactly.
 */
#include "solver/pivoting/parts.h"

#include <cblas.h>
#include <math.h>
#include <string.h>

enum { POLISH = 3 /* passes */ };

void lemke_respond(const lemke_run *s, const double *x, int load, double *raw) {
  double sign = lemke_is_stiff(s) ? -1.0 : 1.0;
  contact_product(s->cp->m, s->M, x, raw);
  if (load) cblas_daxpy(s->cp->m, sign, s->cp->f, 1, raw, 1);
}

void lemke_settle_free(const lemke_run *s, int load, double *u) {
  const lemke_work *w = s->w;
  int n = w->n_free;
  for (int pass = 0; pass < 2 && n > 0; ++pass) {
    lemke_respond(s, u, load, w->raw);
    for (int k = 0; k < n; ++k) w->v[k] = -w->raw[w->free_id[k]];
    contact_product(n, w->inner, w->v, w->t);
    for (int k = 0; k < n; ++k) u[w->free_id[k]] += w->t[k];
  }
}

void lemke_set_base(lemke_run *s) {
  const contact_problem *cp = s->cp;
  lemke_work *w = s->w;
  memset(w->base, 0, (size_t)cp->m * sizeof *w->base);
  if (!lemke_is_stiff(s)) return;
  for (int dof = 0; dof < cp->m; ++dof) {
    size_t at = (size_t)dof * (size_t)cp->m + (size_t)dof;
    if (w->kind[dof] == IS_BOUND) w->base[dof] = contact_bound(cp, dof);
    if (w->kind[dof] == IS_FRICTION) w->base[dof] = contact_stick(cp, dof);
    if (w->kind[dof] == IS_HELD) w->base[dof] = cp->f[dof] / cp->A[at];
  }
  lemke_settle_free(s, 1, w->base);
}

/* w of every variable from raw, scaled as the matrix is; z: scaled, for the
 * compliance form. */
static void slacks(const lemke_run *s, const double *raw, const double *z,
                   double *to) {
  const contact_problem *cp = s->cp;
  const lemke_work *w = s->w;
  int stiff = lemke_is_stiff(s);
  for (int a = 0; a < w->n_var; ++a) {
    const variable *v = w->var + a;
    double unit = w->unit * w->D[v->node_id], g0 = 0.0;
    int dof = w->kept[v->dof];
    if (v->type == BOUND)
      to[a] = unit * (stiff ? -raw[dof] : contact_bound(cp, dof) - raw[dof]);
    if (lemke_has_limit(s, v)) g0 = cp->g0[v->node_id];
    if (v->type == LIMIT) to[a] = g0 / w->D[v->node_id];
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

void lemke_add_motion(const lemke_work *w, const double *z, double *x) {
  for (int a = 0; a < w->n_var; ++a) {
    const variable *v = w->var + a;
    double size = w->D[v->node_id] * z[a];
    if (v->type == LIMIT || size == 0.0) continue;
    x[w->kept[v->dof]] += v->e[0] * size;
    if (v->e[1] != 0.0) x[w->kept[v->dof + 1]] += v->e[1] * size;
  }
}

void lemke_state_of(const lemke_run *s, const double *z, double *x) {
  memcpy(x, s->w->base, (size_t)s->cp->m * sizeof *x);
  lemke_add_motion(s->w, z, x);
  lemke_settle_free(s, 1, x);
}

void lemke_set_vectors(lemke_run *s) {
  lemke_work *w = s->w;
  memset(w->z, 0, (size_t)w->n_var * sizeof *w->z);
  lemke_respond(s, w->base, 1, w->raw);
  slacks(s, w->raw, w->z, w->q);
  for (int a = 0; a < w->n_var; ++a) w->d[a] = 1.0;
  if (lemke_is_stiff(s)) lemke_add_limits(s, w->z, w->d);
}

/* Take what the rows of the final basis miss, measured with the given matrix,
 * out of z. */
static void polish(lemke_run *s, double *x) {
  lemke_work *w = s->w;
  lcp_values(w->lcp, w->z);
  lemke_state_of(s, w->z, x);
  for (int pass = 0; pass < POLISH; ++pass) {
    lemke_respond(s, x, 1, w->raw);
    slacks(s, w->raw, w->z, w->q);
    lcp_correction(w->lcp, w->q, w->dz);
    for (int a = 0; a < w->n_var; ++a) w->z[a] = fmax(0.0, w->z[a] + w->dz[a]);
    lemke_state_of(s, w->z, x);
  }
  lemke_respond(s, x, 1, w->raw);
}

/* Stiffness form: r from raw with what the basis says put in exactly. */
static void clean_forces(const lemke_run *s, double *r) {
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
static void clean_motion(const lemke_run *s, double *u) {
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

void lemke_set_solution(lemke_run *s, double *u, double *r) {
  if (lemke_is_stiff(s)) {
    polish(s, u);
    clean_forces(s, r);
  } else {
    polish(s, r);
    clean_motion(s, u);
  }
}
