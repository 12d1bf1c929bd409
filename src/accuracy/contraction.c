/*
 * Rate of the fixed point g -> g0 + B p(g) on the sliding limit, linearised at
 * a state: the limit of the sliding nodes changes by dg, the free unknowns by
 *   K du = e dg,   K = A_FF + kappa (I - e e') on slip (3-D),
 * the forces of the closed nodes by A du, and the limit by -B (A du)_n. The
 * map is applied a few times; the rate is the largest ratio of two energy
 * norms du' K du that follow each other.
 */
#include "accuracy/accuracy.h"

#include "base/base.h"
#include "contact/parts.h"

#include <cblas.h>
#include <lapacke.h>

enum { PASSES = 12, LONG_RUN = 90, AVERAGED = 30 };

typedef struct linear_map {
  const contact_problem *cp;
  int n_free, n_slip;
  int *free_id, *place;         /* [m] free unknowns; their place or -1 */
  unsigned char *closed, *slip; /* [n] */
  double *e;                    /* [m] direction of the friction force on
                                   slip */
  double *kappa;                /* [n] N/m */
  double *K;                    /* [n_free^2] factor */
  double *x;                    /* [m] change of the free unknowns */
  int n_closed;                 /* closed nodes */
  double *P;                    /* [n_free*n_closed] columns of A of their
                                   normal unknowns */
  double *dg;                   /* [n] N */
  /* Where the stiffness is an operator, in the place of K and P: */
  unsigned char *known;  /* [m] */
  double *added;         /* [dim*m] known_rows.added */
  double *b, *full, *Ax; /* [m] right side; x at all unknowns; A x, N */
} linear_map;

int accuracy_rubs(const contact_problem *cp, int dof) {
  int node_id = dof / cp->dim;
  if (cp->g0 == NULL || dof % cp->dim == 0 || contact_held(cp, dof)) return 0;
  return !contact_has_side(cp, node_id);
}

node_stiffness accuracy_stiffness(const contact_problem *cp, int node_id) {
  const double n = contact_diagonal(cp, node_id * cp->dim);
  const double t = contact_tangent_diagonal(cp, node_id, n);
  if (contact_has_stiffness(cp)) return (node_stiffness){n, t};
  return (node_stiffness){1.0 / n, 1.0 / t};
}

static status map_new(const contact_problem *cp, linear_map *s) {
  s->cp = cp;
  PASS_NEW_ALL(OF(s->free_id, cp->m), OF(s->place, cp->m), OF(s->closed, cp->n),
               OF(s->slip, cp->n), OF(s->e, cp->m), OF(s->kappa, cp->n),
               OF(s->x, cp->m), OF(s->dg, cp->n));
  if (cp->op == NULL) return OK;
  PASS_NEW_ALL(OF(s->known, cp->m), OF(s->added, cp->dim * cp->m));
  PASS_NEW_REALS(cp->m, &s->b, &s->full, &s->Ax);
  return OK;
}

static void map_free(linear_map *s) {
  RELEASE(s->free_id, s->place, s->closed, s->slip, s->e, s->kappa, s->K, s->x,
          s->P, s->dg, s->known, s->added, s->b, s->full, s->Ax);
}

/* Direction and turning stiffness of a node that friction acts on. */
static void set_friction(linear_map *s, const double *u, const double *r,
                         int i) {
  const contact_problem *cp = s->cp;
  double size = 0.0, g = contact_node_limit(cp, r, i);
  double c = accuracy_stiffness(cp, i).t;
  int first = i * cp->dim;
  for (int k = 1; k < cp->dim; ++k) {
    int dof = first + k;
    if (!accuracy_rubs(cp, dof)) continue;
    s->e[dof] = r[dof] - c * (u[dof] - contact_stick(cp, dof));
    size = hypot(size, s->e[dof]);
  }
  s->slip[i] = size > g && g > 0.0;
  for (int k = 1; k < cp->dim && size > 0.0; ++k) s->e[first + k] /= size;
  if (s->slip[i]) s->kappa[i] = c * g / (size - g);
  s->n_slip += s->slip[i];
}

/* 1: the unknown can move. */
static int is_free(const linear_map *s, const double *u, const double *r,
                   int dof) {
  const contact_problem *cp = s->cp;
  int i = dof / cp->dim;
  node_stiffness c = accuracy_stiffness(cp, i);
  double bound = contact_bound(cp, dof);
  if (bound < HUGE_VAL) {
    double step = dof % cp->dim == 0 ? c.n : c.t;
    return !(r[dof] - step * (u[dof] - bound) < 0.0);
  }
  if (!accuracy_rubs(cp, dof)) return !contact_held(cp, dof);
  return s->slip[i] || contact_node_limit(cp, r, i) == 0.0;
}

static void set_state(linear_map *s, const double *u, const double *r) {
  const contact_problem *cp = s->cp;
  for (int i = 0; i < cp->n; ++i) set_friction(s, u, r, i);
  for (int dof = 0; dof < cp->m; ++dof) {
    int moves = is_free(s, u, r, dof);
    s->place[dof] = moves ? s->n_free : -1;
    if (moves) s->free_id[s->n_free++] = dof;
    if (dof % cp->dim > 0) continue;
    s->closed[dof / cp->dim] = !moves;
    s->n_closed += !moves;
  }
}

/* kappa (I - e e') of the sliding nodes. */
static void add_turning(linear_map *s) {
  const contact_problem *cp = s->cp;
  size_t ld = (size_t)s->n_free;
  for (int i = 0; i < cp->n; ++i)
    for (int a = 1; s->slip[i] && a < cp->dim; ++a)
      for (int b = 1; b < cp->dim; ++b) {
        int ia = i * cp->dim + a, ib = i * cp->dim + b;
        double part =
            s->kappa[i] * ((a == b ? 1.0 : 0.0) - s->e[ia] * s->e[ib]);
        if (s->added != NULL) s->added[cp->dim * ia + b] = part;
        if (s->added != NULL || s->place[ia] < 0 || s->place[ib] < 0) continue;
        s->K[(size_t)s->place[ia] + ld * (size_t)s->place[ib]] += part;
      }
}

/* Factor of the operator; it keeps one, so again before each use. */
static status set_rows(linear_map *s, int *good) {
  const contact_operator *op = s->cp->op;
  const known_rows rows = {s->known, s->added};
  int singular = 0;
  for (int i = 0; i < s->cp->m; ++i) s->known[i] = s->place[i] < 0;
  if (s->cp->dim == 3) add_turning(s);
  PASS(op->set_rows(op->ctx, &rows, &singular));
  *good = !singular;
  return OK;
}

/* K and its factor; *good 0: not positive definite. */
static status factor(linear_map *s, int *good) {
  if (s->cp->op != NULL) return set_rows(s, good);
  size_t ld = (size_t)s->n_free, m = (size_t)s->cp->m;
  PASS_NEW(s->K, ld * ld);
  for (size_t j = 0; j < ld; ++j) {
    const double *column = s->cp->A + m * (size_t)s->free_id[j];
    for (size_t i = j; i < ld; ++i) s->K[i + ld * j] = column[s->free_id[i]];
  }
  if (s->cp->dim == 3) add_turning(s);
  *good = ld == 0 || LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', s->n_free, s->K,
                                         s->n_free) == 0;
  return OK;
}

/* x[n_free] = inv(K) x by the operator, A x too; returns x' K x. */
static double solve(linear_map *s) {
  const contact_operator *op = s->cp->op;
  double energy = 0.0;
  memset(s->full, 0, (size_t)s->cp->m * sizeof *s->full);
  memset(s->b, 0, (size_t)s->cp->m * sizeof *s->b);
  for (int a = 0; a < s->n_free; ++a) s->b[s->free_id[a]] = s->x[a];
  op->solve(op->ctx, s->b, s->full, s->Ax);
  for (int a = 0; a < s->n_free; ++a) {
    energy += s->x[a] * s->full[s->free_id[a]];
    s->x[a] = s->full[s->free_id[a]];
  }
  return fmax(energy, 0.0);
}

/* x = inv(K) e dg; the energy x' K x. */
static double move(linear_map *s) {
  const contact_problem *cp = s->cp;
  double energy = 0.0;
  for (int a = 0; a < s->n_free; ++a) {
    int dof = s->free_id[a], i = dof / cp->dim;
    int rubs = dof % cp->dim > 0 && s->slip[i];
    s->x[a] = rubs ? s->e[dof] * s->dg[i] : 0.0;
  }
  if (cp->op != NULL) return solve(s);
  LAPACKE_dtrtrs_work(LAPACK_COL_MAJOR, 'L', 'N', 'N', s->n_free, 1, s->K,
                      s->n_free, s->x, s->n_free);
  for (int a = 0; a < s->n_free; ++a) energy += s->x[a] * s->x[a];
  LAPACKE_dtrtrs_work(LAPACK_COL_MAJOR, 'L', 'T', 'N', s->n_free, 1, s->K,
                      s->n_free, s->x, s->n_free);
  return energy;
}

static status gather_columns(linear_map *s) {
  if (s->cp->op != NULL) return OK;
  PASS_NEW(s->P, (size_t)s->n_free * (size_t)s->n_closed);
  double *to = s->P;
  for (int i = 0; i < s->cp->n; ++i) {
    if (!s->closed[i]) continue;
    const double *column =
        s->cp->A + (size_t)(i * s->cp->dim) * (size_t)s->cp->m;
    for (int a = 0; a < s->n_free; ++a) *to++ = column[s->free_id[a]];
  }
  return OK;
}

/* Changes of the normal forces, N; dn[n], 0 at open nodes. */
static void push(const linear_map *s, double *dn) {
  int c = s->n_closed;
  if (s->cp->op != NULL) {
    for (int i = 0; i < s->cp->n; ++i)
      dn[i] = s->closed[i] ? s->Ax[i * s->cp->dim] : 0.0;
    return;
  }
  if (c > 0)
    cblas_dgemv(CblasColMajor, CblasTrans, s->n_free, c, 1.0, s->P, s->n_free,
                s->x, 1, 0.0, dn, 1);
  for (int i = s->cp->n - 1; i >= 0; --i) dn[i] = s->closed[i] ? dn[--c] : 0.0;
}

/* dg = -B (A x)_n on the sliding nodes; dn[n] workspace. */
static void change_limit(linear_map *s, double *dn) {
  const contact_problem *cp = s->cp;
  const sparse_rows *B = cp->B;
  push(s, dn);
  for (int i = 0; i < cp->n; ++i) {
    s->dg[i] = 0.0;
    for (int k = B->start[i]; s->slip[i] && k < B->start[i + 1]; ++k)
      s->dg[i] -= B->val[k] * dn[B->col[k]];
  }
}

/* The first change: the limit itself, different at neighbours. */
static void first_change(linear_map *s, const double *r) {
  for (int i = 0; i < s->cp->n; ++i)
    s->dg[i] = s->slip[i] ? contact_node_limit(s->cp, r, i) *
                                (1.0 + 0.5 * sin(1.0 + 2.0 * i))
                          : 0.0;
}

static status measure(linear_map *s, const double *r, double *rate) {
  OWNED double *dn = NULL;
  double last;
  int good = 0;
  *rate = 0.0;
  if (s->n_slip == 0) return OK;
  PASS_NEW(dn, s->cp->n);
  *rate = HUGE_VAL;
  PASS(factor(s, &good));
  if (!good) return OK;
  PASS(gather_columns(s));
  *rate = 0.0;
  first_change(s, r);
  last = move(s);
  for (int k = 1; k <= PASSES && last > 0.0; ++k) {
    change_limit(s, dn);
    double energy = move(s);
    if (k > 1 || s->cp->n == 1) *rate = fmax(*rate, sqrt(energy / last));
    last = energy;
  }
  return OK;
}

/* ---- stored rates ----------------------------------------------- */

void known_rate_forget(known_rate *k) {
  if (k == NULL) return;
  memory_free(k->state);
  *k = (known_rate){0};
}

/* 0 known, 1 free, 2 and 3 sliding one way and the other. */
static signed char state_of(const linear_map *s, int dof) {
  int moves = s->place[dof] >= 0, i = dof / s->cp->dim;
  if (!moves || dof % s->cp->dim == 0 || !s->slip[i]) return (signed char)moves;
  return s->e[dof] > 0.0 ? 3 : 2;
}

/* The known rate of these states comes first, *same = 1; or they replace the
 * least recently used rate. */
static status compare(const linear_map *s, known_rate *k, int *same) {
  const size_t m = (size_t)s->cp->m;
  OWNED signed char *now = NULL;
  int at = 0;
  if (k->state == NULL || k->m != s->cp->m) {
    known_rate_forget(k);
    PASS_NEW(k->state, KNOWN_RATES * m);
    k->m = s->cp->m;
  }
  PASS_NEW(now, m);
  for (int dof = 0; dof < s->cp->m; ++dof) now[dof] = state_of(s, dof);
  while (at < k->n && memcmp(k->state + m * (size_t)at, now, m) != 0) ++at;
  *same = at < k->n;
  if (!*same && k->n < KNOWN_RATES) ++k->n;
  if (at == KNOWN_RATES) --at;
  double rate = k->rate[at];
  memmove(k->state + m, k->state, m * (size_t)at);
  memmove(k->rate + 1, k->rate, (size_t)at * sizeof *k->rate);
  memcpy(k->state, now, m);
  k->rate[0] = rate;
  return OK;
}

/* Mean factor of the last passes of many, independent of the start. */
static status measure_limit(linear_map *s, const double *r, double *rate) {
  OWNED double *dn = NULL;
  double last, grown = 0.0;
  PASS_NEW(dn, s->cp->n);
  first_change(s, r);
  last = move(s);
  for (int k = 1; k <= LONG_RUN && last > 0.0; ++k) {
    for (int i = 0; i < s->cp->n; ++i) s->dg[i] /= sqrt(last);
    for (int a = 0; a < s->n_free; ++a) s->x[a] /= sqrt(last);
    for (int i = 0; s->Ax != NULL && i < s->cp->m; ++i) s->Ax[i] /= sqrt(last);
    change_limit(s, dn);
    last = move(s);
    if (k > LONG_RUN - AVERAGED) grown += 0.5 * log(last);
  }
  *rate = last > 0.0 ? exp(grown / AVERAGED) : 0.0;
  return OK;
}

status contraction_limit(const contact_problem *cp, const double *u,
                         const double *r, double *rate) {
  ENDS_BY(map_free) linear_map s = {0};
  PASS(map_new(cp, &s));
  set_state(&s, u, r);
  PASS(measure(&s, r, rate));
  if (*rate > 0.0 && *rate < HUGE_VAL) PASS(measure_limit(&s, r, rate));
  return OK;
}

status contraction_rate(const contact_problem *cp, const double *u,
                        const double *r, known_rate *known, double *rate) {
  status st = OK;
  linear_map s = {0};
  int same = 0;
  TRY(map_new(cp, &s));
  set_state(&s, u, r);
  if (known != NULL) TRY(compare(&s, known, &same));
  if (same)
    *rate = known->rate[0];
  else
    TRY(measure(&s, r, rate));
  if (known != NULL) known->rate[0] = *rate;
done:
  if (st != OK) known_rate_forget(known);
  map_free(&s);
  return st;
}

/* ---- a change of the load ------------------------------------------------ */

struct linear_contact {
  linear_map map;
};

void linear_contact_free(linear_contact *c) {
  if (c == NULL) return;
  map_free(&c->map);
  memory_free(c);
}

status linear_contact_new(const contact_problem *cp, const double *u,
                          const double *r, linear_contact **out) {
  int good = 0;
  PASS_NEW(*out, 1);
  linear_contact *c = *out;
  linear_map *s = &c->map;
  PASS(map_new(cp, s));
  set_state(s, u, r);
  PASS(factor(s, &good));
  if (good) return OK;
  linear_contact_free(c);
  *out = NULL;
  return OK;
}

status linear_contact_move(linear_contact *c, const double *df, double *du) {
  linear_map *s = &c->map;
  int good = 0;
  for (int a = 0; a < s->n_free; ++a) s->x[a] = df[s->free_id[a]];
  if (s->cp->op != NULL) {
    PASS(set_rows(s, &good));
    solve(s);
  } else if (s->n_free > 0) {
    LAPACKE_dpotrs_work(LAPACK_COL_MAJOR, 'L', s->n_free, 1, s->K, s->n_free,
                        s->x, s->n_free);
  }
  for (int k = 0; k < s->cp->m; ++k)
    du[k] = s->place[k] >= 0 ? s->x[s->place[k]] : 0.0;
  return OK;
}
