/*
 * A step from the compliance (system.h).
 *
 * A factor without slip is kept as the base, of the plain forces N. Where a
 * later guess frees some of them, C, by opening or slip, the displacements of C
 * become unknowns z, and with X = inv(W_NN) E_C the change of the forces is
 *
 *   dr = x0 + X z,   W_NN x0 = b without C,
 *
 * z from the conditions on the forces of C: zero where open, on the limit where
 * slipping. These rows have few entries; X is kept.
 */
#include "solver/newton/system.h"

#include "solver/newton/dense.h"

#include <cblas.h>
#include <lapacke.h>

/* An unknown force: of one degree of freedom, or along d in the tangent plane
 * of a slipping node. */
typedef struct unknown {
  int dof;     /* of d: the first tangent */
  int turns;   /* 1: along d */
  double d[2]; /* -; {1, 0} of a single one */
} unknown;

struct compliance_system {
  const contact_problem *cp; /* of this step */
  const pattern *p;          /* of this step */
  double power;              /* of two: W*power has a diagonal of order 1 */
  unknown *list;             /* [m] */
  int *dof;                  /* [m] of each */
  int *place;                /* [n] of the normal force in the list, or -1 */
  int *turn;                 /* [n] of the unknown along d, or -1 */
  int n, n_turn;             /* unknowns; of them along d */
  dense K;                   /* their matrix, times power; factor of the base */
  double *x, *y;             /* [m] */
  int n_base;                /* unknowns of the base, 0: none */
  int *base, *in_base;       /* [m], [m] its unknowns; their place, -1: not */
  double spent;              /* on freed forces since it was made, operations */
  int capacity, n_column;    /* columns of X: most, made */
  int *column;               /* [m] of X, of unknowns of the base, -1: none */
  double *X;                 /* [m*capacity] */
  int n_freed, *freed;       /* [capacity] unknowns of the base */
  double *C, *z;             /* [capacity*capacity], [capacity] small system */
  int *pivot;                /* [capacity] */
};

/* ---- forces freed by an update of the factor ---------------------------- */

/* Solves whose arithmetic takes the time of reading the factor. */
enum { READ = 8 };

/* 1: the forces of a slipping node are unknowns of the base. */
static int slip_in_base(const compliance_system *s, int node_id) {
  int first = node_id * s->cp->dim;
  for (int k = 1; k < s->cp->dim; ++k)
    if (!contact_held(s->cp, first + k) && s->in_base[first + k] < 0) return 0;
  return 1;
}

static int base_has_all(const compliance_system *s) {
  for (int i = 0; i < s->n; ++i)
    if (!s->list[i].turns && s->in_base[s->list[i].dof] < 0) return 0;
  for (int i = 0; i < s->cp->n; ++i)
    if (s->p->mode[i] == SLIP && !slip_in_base(s, i)) return 0;
  return 1;
}

/* List what the guess frees; the operations of a step with it, or HUGE_VAL if
 * there is no base or the guess has forces that are not in it. */
static double freed_cost(compliance_system *s) {
  double fresh = 0.0, n = s->n_base;
  if (s->n_base == 0 || !base_has_all(s)) return HUGE_VAL;
  /* Mark the plain unknowns of the guess in y. */
  CLEAR(s->y, s->n_base);
  for (int i = 0; i < s->n; ++i)
    if (!s->list[i].turns) s->y[s->in_base[s->list[i].dof]] = 1.0;
  s->n_freed = 0;
  for (int a = 0; a < s->n_base; ++a) {
    if (s->y[a] != 0.0) continue;
    if (s->n_freed == s->capacity) return HUGE_VAL;
    s->freed[s->n_freed++] = a;
    fresh += s->column[a] < 0;
  }
  double columns = s->n_column + fresh, k = s->n_freed;
  if (columns > s->capacity) return HUGE_VAL;
  return 2.0 * n * n * (fresh + 1.0 + READ) + 2.0 * n * columns +
         2.0 / 3.0 * k * k * k;
}

static void make_columns(compliance_system *s) {
  size_t n = s->n_base;
  int first = s->n_column;
  for (int c = 0; c < s->n_freed; ++c) {
    int a = s->freed[c];
    if (s->column[a] >= 0) continue;
    s->column[a] = s->n_column++;
    double *x = s->X + n * s->column[a];
    CLEAR(x, n);
    x[a] = 1.0;
  }
  dense_solve(&s->K, s->n_column - first, s->X + n * first, s->n_base);
}

/* Direction of friction at a slipping node, the first of its two rows in 3-D:
 * the excess of the forces y over the limit. */
static double on_limit(const compliance_system *s, int node_id,
                       const double *y) {
  const sparse_rows *B = s->cp->B;
  int dim = s->cp->dim, first = node_id * dim + 1;
  double sum = 0.0;
  for (int k = 0; k < dim - 1; ++k)
    if (s->in_base[first + k] >= 0)
      sum += s->p->e[node_id * (dim - 1) + k] * y[s->in_base[first + k]];
  for (int k = row_begin(B, node_id); k < row_end(B, node_id); ++k)
    if (s->place[B->col[k]] >= 0)
      sum += B->val[k] * y[s->in_base[B->col[k] * dim]];
  return sum;
}

/* Product of the row of a freed force with forces y. */
static double row_of(const compliance_system *s, int a, const double *y) {
  int dof = s->base[a], dim = s->cp->dim, node_id = dof / dim;
  if (dof % dim == 0 || s->p->mode[node_id] != SLIP) return y[a];
  if (s->turn[node_id] < 0 || dof % dim == 1) return on_limit(s, node_id, y);
  /* The second row: the force across over its stiffness. */
  const unknown *d = &s->list[s->turn[node_id]];
  double sum = 0.0;
  for (int k = 0; k < 2; ++k) sum += d->d[k] * y[s->in_base[d->dof + k]];
  return sum * s->power / s->p->kappa[node_id];
}

/* Its product with the displacement of another freed one. */
static double displacement_part(const compliance_system *s, int a, int other) {
  int dof = s->base[a], node_id = dof / s->cp->dim;
  if (s->turn[node_id] < 0 || dof % 3 != 2) return 0.0;
  const unknown *d = &s->list[s->turn[node_id]];
  int k = s->base[other] - d->dof;
  return k == 0 || k == 1 ? d->d[k] : 0.0;
}

static void small_system(compliance_system *s) {
  size_t n = s->n_base, k = s->n_freed;
  for (size_t i = 0; i < k; ++i) {
    int a = s->freed[i], node_id = s->base[a] / s->cp->dim;
    int second = s->turn[node_id] >= 0 && s->base[a] % 3 == 2;
    for (size_t j = 0; j < k; ++j) {
      const double *X = s->X + n * s->column[s->freed[j]];
      s->C[i + k * j] = row_of(s, a, X) + displacement_part(s, a, s->freed[j]);
    }
    s->z[i] = (second ? s->x[s->turn[node_id]] : 0.0) - row_of(s, a, s->y);
  }
}

/* x, by place in the list, from the right sides to the change of the forces.
 * 0: the small system is singular. */
static int freed_solve(compliance_system *s) {
  int k = s->n_freed;
  make_columns(s);
  CLEAR(s->y, s->n_base);
  for (int i = 0; i < s->n; ++i)
    if (!s->list[i].turns) s->y[s->in_base[s->list[i].dof]] = s->x[i];
  dense_solve(&s->K, 1, s->y, s->n_base);
  if (k > 0) {
    small_system(s);
    if (LAPACKE_dgesv_work(LAPACK_COL_MAJOR, k, 1, s->C, k, s->pivot, s->z,
                           k) != 0)
      return 0;
    for (int c = 0; c < k; ++c)
      cblas_daxpy(s->n_base, s->z[c],
                  s->X + (size_t)s->n_base * s->column[s->freed[c]], 1, s->y,
                  1);
  }
  for (int i = 0; i < s->n; ++i) {
    const unknown *a = &s->list[i];
    s->x[i] = a->turns ? a->d[0] * s->y[s->in_base[a->dof]] +
                             a->d[1] * s->y[s->in_base[a->dof + 1]]
                       : s->y[s->in_base[a->dof]];
  }
  return 1;
}

enum { REFINEMENTS = 3, SHARE = 4 };    /* 1/SHARE: most forces freed */
static const double ROUNDING = 0x1p-44; /* -, of the displacements */
static const double DEFECT = 0x1p-20;   /* -, of the right side: a good solve */
static const double SYMMETRIC = 0x1p-41; /* -, of the largest diagonal */

status compliance_system_new(const contact_problem *cp,
                             compliance_system **out) {
  size_t m = cp->m;
  int capacity = cp->g0 == NULL && cp->side_gap == NULL ? cp->n : cp->m;
  MAKES(compliance_system, s, out);
  PASS_NEW_ALL(OF(s->list, m), OF(s->place, cp->n), OF(s->turn, cp->n),
               OF(s->dof, m), OF(s->x, m), OF(s->y, m), OF(s->base, m),
               OF(s->in_base, m), OF(s->column, m));
  s->capacity = capacity / SHARE + 1;
  PASS_NEW_ALL(OF(s->X, capacity * s->capacity), OF(s->freed, s->capacity),
               OF(s->C, s->capacity * s->capacity), OF(s->z, s->capacity),
               OF(s->pivot, s->capacity));
  PASS(dense_new(capacity, &s->K));
  s->power = dense_power(cp->m, cp->W);
  return OK;
}

void compliance_displace(const contact_problem *cp, const double *r,
                         double *raw) {
  size_t m = cp->m;
  COPY(raw, cp->f, m);
  for (int k = 0; k < cp->dim; ++k) {
    int any = 0;
    for (int i = k; i < cp->m; i += cp->dim) any = any || r[i] != 0.0;
    if (any)
      cblas_dgemv(CblasColMajor, CblasNoTrans, cp->m, cp->n, 1.0, cp->W + m * k,
                  cp->m * cp->dim, r + k, cp->dim, 1.0, raw, 1);
  }
}

/* ---- unknowns ------------------------------------------------------------ */

/* 1: force along d is unknown: slip in both tangents of 3-D. */
static int turns(const compliance_system *s, int node_id) {
  int first = node_id * s->cp->dim;
  return s->cp->dim == 3 && s->p->mode[node_id] == SLIP &&
         !contact_held(s->cp, first + 1) && !contact_held(s->cp, first + 2);
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
      if (!contact_held(cp, dof) && (p->closed[dof] || stick)) {
        s->dof[s->n] = dof;
        s->list[s->n++] = (unknown){.dof = dof, .d = {1.0, 0.0}};
      }
    }
    s->turn[i] = turns(s, i) ? s->n : -1;
    if (s->turn[i] < 0) continue;
    ++s->n_turn;
    s->dof[s->n] = first + 1;
    s->list[s->n++] = (unknown){
        .dof = first + 1, .turns = 1, .d = {-p->e[2 * i + 1], p->e[2 * i]}};
  }
}

/* Component of a full vector for an unknown of the list. */
static double part(const unknown *a, const double *of) {
  return a->turns ? a->d[0] * of[a->dof] + a->d[1] * of[a->dof + 1]
                  : of[a->dof];
}

/* ---- matrix -------------------------------------------------------------- */

/* to += a W_dof, rows of the unknowns, times power */
static void add_column(const compliance_system *s, int dof, double a,
                       double *to) {
  const double *column = s->cp->W + (size_t)s->cp->m * dof;
  a *= s->power;
  for (int i = 0; i < s->n; ++i) to[i] += a * part(&s->list[i], column);
}

/* Limits follow the pressure: returns 1 if one does. */
static int add_limits(compliance_system *s) {
  const sparse_rows *B = s->cp->B;
  size_t n = s->n;
  int found = 0, dim = s->cp->dim;
  for (int i = 0; B != NULL && i < s->cp->n; ++i) {
    if (s->p->mode[i] != SLIP) continue;
    int made = 0;
    for (int k = B->start[i]; k < B->start[i + 1]; ++k) {
      int j = s->place[B->col[k]];
      if (j < 0 || B->val[k] == 0.0) continue;
      if (!made) {
        CLEAR(s->x, n);
        for (int t = 0; t < dim - 1; ++t)
          add_column(s, i * dim + 1 + t, s->p->e[i * (dim - 1) + t], s->x);
      }
      found = made = 1;
      cblas_daxpy(s->n, -B->val[k], s->x, 1, s->K.a + n * j, 1);
    }
  }
  return found;
}

static void fill(compliance_system *s) {
  size_t n = s->n, m = s->cp->m;
  for (size_t j = 0; j < n; ++j) {
    const unknown *a = &s->list[j];
    const double *column = s->cp->W + m * a->dof;
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
  for (int k = row_begin(B, node_id); k < row_end(B, node_id); ++k)
    if (s->place[B->col[k]] >= 0) g -= B->val[k] * r[B->col[k] * cp->dim];
  for (int k = 0; k < cp->dim - 1; ++k) t[k] = g * e[k];
  if (!turns(s, node_id)) return;
  t[0] -= along * e[1];
  t[1] += along * e[0];
}

/* Known forces of the guess, and those that follow from others, into r. */
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

/* x, times power: the residual of each row; returns the largest. */
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

/* 1: a new factor of n unknowns costs more than the update. */
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

/* Largest of |q| and diag(W) |r|, times power. */
static double size_of(const compliance_system *s, const double *r) {
  const contact_problem *cp = s->cp;
  double size = 0.0;
  for (size_t i = 0, m = cp->m; i < m; ++i)
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

/* Forces of the guess by the updated factor (freed) or a new one; 0: not
 * solved. */
static int solve(compliance_system *s, int by_base, double *r, double *raw) {
  double left = load(s, r, raw), before = HUGE_VAL, first = left;
  for (int k = 0; k < REFINEMENTS && left < 0.5 * before; ++k) {
    if (!by_base)
      dense_solve(&s->K, 1, s->x, s->n);
    else if (!freed_solve(s))
      return 0;
    /* Add the solved x to the forces. */
    for (int i = 0; i < s->n; ++i) {
      const unknown *a = &s->list[i];
      r[a->dof] += s->x[i] * a->d[0];
      if (a->turns) r[a->dof + 1] += s->x[i] * a->d[1];
    }
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
