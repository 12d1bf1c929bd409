/* A step from the compliance (compliance.h). */
#include "solver/newton/forces.h"

#include "base/memory.h"

#include <cblas.h>
#include <math.h>
#include <string.h>

enum { REFINEMENTS = 3, SHARE = 4 };    /* 1/SHARE: most forces freed         */
static const double ROUNDING = 0x1p-44; /* -, of the displacements           */
static const double DEFECT = 0x1p-20;   /* -, of the right side: a good solve */
static const double SYMMETRIC = 0x1p-41; /* -, of the largest diagonal        */

status compliance_system_new(const contact_problem *cp,
                             compliance_system **out) {
  status st = OK;
  compliance_system *s = NULL;
  size_t m = (size_t)cp->m;
  int room = cp->g0 == NULL && cp->side_gap == NULL ? cp->n : cp->m;
  NEW(s, 1);
  NEW(s->list, m);
  NEW(s->place, cp->n);
  NEW(s->turn, cp->n);
  NEW(s->dof, m);
  NEW(s->x, m);
  NEW(s->y, m);
  NEW(s->base, m);
  NEW(s->in_base, m);
  NEW(s->column, m);
  s->room = room / SHARE + 1;
  NEW(s->X, room * s->room);
  NEW(s->freed, s->room);
  NEW(s->C, s->room * s->room);
  NEW(s->z, s->room);
  NEW(s->pivot, s->room);
  TRY(dense_new(room, &s->K));
  s->power = dense_power(cp->m, cp->W);
  *out = s;
  s = NULL;
done:
  compliance_system_free(s);
  return st;
}

void compliance_system_free(compliance_system *s) {
  if (s == NULL) return;
  void *const blocks[] = {s->list,  s->dof,  s->place,   s->turn,   s->x,
                          s->y,     s->base, s->in_base, s->column, s->X,
                          s->freed, s->C,    s->z,       s->pivot};
  for (size_t i = 0; i < sizeof blocks / sizeof *blocks; ++i)
    memory_free(blocks[i]);
  dense_free(&s->K);
  memory_free(s);
}

void compliance_displace(const contact_problem *cp, const double *r,
                         double *raw) {
  size_t m = (size_t)cp->m;
  memcpy(raw, cp->f, m * sizeof *raw);
  for (int k = 0; k < cp->dim; ++k) {
    int any = 0;
    for (int i = k; i < cp->m; i += cp->dim) any = any || r[i] != 0.0;
    if (any)
      cblas_dgemv(CblasColMajor, CblasNoTrans, cp->m, cp->n, 1.0,
                  cp->W + m * (size_t)k, cp->m * cp->dim, r + k, cp->dim, 1.0,
                  raw, 1);
  }
}

/* ---- unknowns ------------------------------------------------------------ */

/* 1: force along d is unknown: slip in both tangents of 3-D. */
static int turns(const compliance_system *s, int node_id) {
  int first = node_id * s->cp->dim;
  return s->cp->dim == 3 && s->p->mode[node_id] == SLIP &&
         !contact_held(s->cp, first + 1) && !contact_held(s->cp, first + 2);
}

static void add_unknown(compliance_system *s, int dof) {
  s->dof[s->n] = dof;
  s->list[s->n++] = (unknown){.dof = dof, .d = {1.0, 0.0}};
}

static void list_unknowns(compliance_system *s) {
  const contact_problem *cp = s->cp;
  const pattern *p = s->p;
  s->n = s->n_turn = 0;
  for (int i = 0; i < cp->n; ++i) {
    int first = i * cp->dim;
    s->place[i] = p->closed[first] ? s->n : -1;
    for (int dof = first; dof < first + cp->dim; ++dof) {
      int stick = dof > first && p->mode[i] == STICK;
      if (!contact_held(cp, dof) && (p->closed[dof] || stick))
        add_unknown(s, dof);
    }
    s->turn[i] = turns(s, i) ? s->n : -1;
    if (s->turn[i] < 0) continue;
    ++s->n_turn;
    s->dof[s->n] = first + 1;
    s->list[s->n++] = (unknown){
        .dof = first + 1, .turns = 1, .d = {-p->e[2 * i + 1], p->e[2 * i]}};
  }
}

/* What an unknown of the list takes of a vector over all. */
static double part(const unknown *a, const double *of) {
  return a->turns ? a->d[0] * of[a->dof] + a->d[1] * of[a->dof + 1]
                  : of[a->dof];
}

/* ---- matrix -------------------------------------------------------------- */

/* to += a W_dof, rows of the unknowns, times power */
static void add_column(const compliance_system *s, int dof, double a,
                       double *to) {
  const double *column = s->cp->W + (size_t)s->cp->m * (size_t)dof;
  a *= s->power;
  for (int i = 0; i < s->n; ++i) to[i] += a * part(&s->list[i], column);
}

/* Limits follow the pressure: returns 1 if one does. */
static int add_limits(compliance_system *s) {
  const sparse_rows *B = s->cp->B;
  const pattern *p = s->p;
  size_t n = (size_t)s->n;
  int found = 0, dim = s->cp->dim;
  for (int i = 0; B != NULL && i < s->cp->n; ++i) {
    if (p->mode[i] != SLIP) continue;
    int made = 0;
    for (int k = B->start[i]; k < B->start[i + 1]; ++k) {
      int j = s->place[B->col[k]];
      if (j < 0 || B->val[k] == 0.0) continue;
      if (!made) {
        memset(s->x, 0, n * sizeof *s->x);
        for (int t = 0; t < dim - 1; ++t)
          add_column(s, i * dim + 1 + t, p->e[i * (dim - 1) + t], s->x);
      }
      found = made = 1;
      cblas_daxpy(s->n, -B->val[k], s->x, 1, s->K.a + n * (size_t)j, 1);
    }
  }
  return found;
}

static void fill(compliance_system *s) {
  size_t n = (size_t)s->n, m = (size_t)s->cp->m;
  for (size_t j = 0; j < n; ++j) {
    const unknown *a = &s->list[j];
    const double *column = s->cp->W + m * (size_t)a->dof;
    double *to = s->K.a + n * j, first = s->power * a->d[0];
    for (size_t i = 0; i < n; ++i) to[i] = first * column[s->dof[i]];
    for (size_t i = 0; i < n && s->n_turn > 0; ++i)
      if (s->list[i].turns) to[i] = first * part(&s->list[i], column);
    if (!a->turns) continue;
    add_column(s, a->dof + 1, a->d[1], to);
    to[j] += s->power / s->p->kappa[a->dof / 3];
  }
  s->K.n = s->n;
  s->K.full = add_limits(s) || !dense_is_symmetric(s->n, s->K.a, SYMMETRIC);
}

/* ---- right side ---------------------------------------------------------- */

/* Force of a slipping node from the normal ones; s: along d. */
static void set_slip(const compliance_system *s, int node_id, double along,
                     double *r) {
  const contact_problem *cp = s->cp;
  const sparse_rows *B = cp->B;
  const double *e = s->p->e + node_id * (cp->dim - 1);
  double g = cp->g0[node_id], *t = r + node_id * cp->dim + 1;
  for (int k = B == NULL ? 0 : B->start[node_id];
       B != NULL && k < B->start[node_id + 1]; ++k)
    if (s->place[B->col[k]] >= 0) g -= B->val[k] * r[B->col[k] * cp->dim];
  for (int k = 0; k < cp->dim - 1; ++k) t[k] = g * e[k];
  if (!turns(s, node_id)) return;
  t[0] -= along * e[1];
  t[1] += along * e[0];
}

/* Forces the guess knows, and those that follow from others, into r. */
static void settle(const compliance_system *s, double *r) {
  const contact_problem *cp = s->cp;
  for (int i = 0; i < cp->n; ++i) {
    int first = i * cp->dim;
    if (s->place[i] < 0) r[first] = 0.0;
    for (int dof = first + 1; dof < first + cp->dim; ++dof)
      if (contact_held(cp, dof) ||
          (s->p->mode[i] == FREE && !s->p->closed[dof]))
        r[dof] = 0.0;
  }
  for (int i = 0; i < cp->n; ++i) {
    if (s->p->mode[i] != SLIP) continue;
    const double *e = s->p->e + i * (cp->dim - 1), *t = r + i * cp->dim + 1;
    set_slip(s, i, turns(s, i) ? t[1] * e[0] - t[0] * e[1] : 0.0, r);
  }
}

/* x, times power: what each row misses; returns the largest. */
static double load(compliance_system *s, const double *r, const double *raw) {
  const contact_problem *cp = s->cp;
  double largest = 0.0;
  for (int i = 0; i < s->n; ++i) {
    const unknown *a = &s->list[i];
    double b = -part(a, raw);
    if (a->turns)
      b += a->d[0] * contact_stick(cp, a->dof) +
           a->d[1] * contact_stick(cp, a->dof + 1) -
           part(a, r) / s->p->kappa[a->dof / 3];
    else
      b += s->p->closed[a->dof] ? contact_bound(cp, a->dof)
                                : contact_stick(cp, a->dof);
    s->x[i] = s->power * b;
    if (!(fabs(s->x[i]) <= largest)) largest = fabs(s->x[i]);
  }
  return largest;
}

/* ---- factor -------------------------------------------------------------- */

/* The new factor becomes the base if there is no slip in it. */
static void keep_base(compliance_system *s) {
  s->spent = 0.0;
  s->n_column = s->n_base = 0;
  for (int i = 0; i < s->cp->n; ++i)
    if (s->p->mode[i] == SLIP) return;
  if (s->K.full) return;
  for (int i = 0; i < s->cp->m; ++i) s->in_base[i] = -1;
  for (; s->n_base < s->n; ++s->n_base) {
    s->base[s->n_base] = s->list[s->n_base].dof;
    s->in_base[s->base[s->n_base]] = s->n_base;
    s->column[s->n_base] = -1;
  }
}

/* 1: a new factor of n unknowns costs more than the kept one. */
static int base_pays(compliance_system *s) {
  double n = s->n, cost = freed_cost(s), fresh;
  int slips = 0;
  for (int i = 0; i < s->cp->n; ++i) slips = slips || s->p->mode[i] == SLIP;
  fresh = (slips ? 2.0 : 1.0) / 3.0 * n * n * n;
  if (s->spent + cost > fresh) return 0;
  s->spent += cost;
  return 1;
}

/* 0: singular. */
static int new_factor(compliance_system *s) {
  s->n_base = 0;
  fill(s);
  if (!dense_factor(&s->K, 1)) return 0;
  keep_base(s);
  return 1;
}

/* ---- step ---------------------------------------------------------------- */

/* Add the solved x to the forces. */
static void add_forces(const compliance_system *s, double *r) {
  for (int i = 0; i < s->n; ++i) {
    const unknown *a = &s->list[i];
    r[a->dof] += s->x[i] * a->d[0];
    if (a->turns) r[a->dof + 1] += s->x[i] * a->d[1];
  }
}

/* Largest of |q| and diag(W) |r|, times power. */
static double size_of(const compliance_system *s, const double *r) {
  const contact_problem *cp = s->cp;
  double size = 0.0;
  for (size_t i = 0, m = (size_t)cp->m; i < m; ++i)
    size = fmax(size, fmax(fabs(cp->f[i]), fabs(cp->W[i * m + i] * r[i])));
  return s->power * size;
}

/* Back onto the friction disc, from its tangent. */
static int project(const compliance_system *s, double *r) {
  int moved = 0;
  for (int i = 0; i < s->cp->n; ++i) {
    if (!turns(s, i)) continue;
    double *t = r + 3 * i + 1, size = hypot(t[0], t[1]);
    double g = contact_node_limit(s->cp, r, i);
    if (!(g > 0.0 && size > 0.0 && size != g)) continue;
    for (int k = 0; k < 2; ++k) t[k] *= g / size;
    moved = 1;
  }
  return moved;
}

/* Forces of the guess by the kept factor (freed) or the new one; 0: not solved.
 */
static int solve(compliance_system *s, int by_base, double *r, double *raw) {
  double left = load(s, r, raw), before = HUGE_VAL, first = left;
  for (int k = 0; k < REFINEMENTS && left < 0.5 * before; ++k) {
    if (!by_base)
      dense_solve(&s->K, 1, s->x, s->n);
    else if (!freed_solve(s))
      return 0;
    add_forces(s, r);
    settle(s, r);
    compliance_displace(s->cp, r, raw);
    before = left;
    left = load(s, r, raw);
    if (left <= ROUNDING * size_of(s, r)) return 1;
  }
  return left <= DEFECT * first;
}

int compliance_system_step(compliance_system *s, const contact_problem *cp,
                           const pattern *p, double *r, double *raw) {
  s->cp = cp;
  s->p = p;
  list_unknowns(s);
  settle(s, r);
  compliance_displace(cp, r, raw);
  if (!base_pays(s) || !solve(s, 1, r, raw)) {
    if (!new_factor(s)) return 1;
    solve(s, 0, r, raw);
  }
  if (project(s, r)) compliance_displace(cp, r, raw);
  return 0;
}
