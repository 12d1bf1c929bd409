/*
 * Rate of the fixed point g -> g0 + B p(g) on the sliding limit, linearised at
 * a state: the limit of the sliding nodes changes by dg, the free unknowns by
 *   K du = e dg,   K = A_FF + kappa (I - e e') on slip (3-D),
 * the forces of the closed nodes by A du, and the limit by -B (A du)_n. The
 * map is applied a few times; the rate is the largest ratio of two energy
 * norms du' K du that follow each other.
 */
#include "accuracy/accuracy.h"

#include <cblas.h>
#include <float.h>
#include <lapacke.h>

enum { PASSES = 12, LONG_RUN = 90, AVERAGED = 30 };

struct linear_contact {
  linear_states at;
  double *K;  /* [n_free^2] factor */
  double *x;  /* [m] change of the free unknowns */
  double *P;  /* [n_free*n_closed] columns of A of the normal unknowns
                 of closed nodes */
  double *dg; /* [n] N */
  double *b, *full, *Ax; /* of an operator, in the place of K and P: [m] right
                            side; x at all unknowns; A x, N */
};

static status map_new(const contact_problem *cp, const double *u,
                      const double *r, int rests, linear_contact **out) {
  MAKES(linear_contact, s, out);
  PASS(linear_states_new(cp, u, r, rests, &s->at));
  PASS_NEW_ALL(OF(s->x, cp->m), OF(s->dg, cp->n));
  if (cp->op != NULL) PASS_NEW_REALS(cp->m, &s->b, &s->full, &s->Ax);
  return OK;
}

/* kappa (I - e e') of the sliding nodes. */
static void add_turning(linear_contact *s) {
  const linear_states *at = &s->at;
  for (int a = 0; a < at->cp->m; ++a)
    for (int t = 1; a % 3 > 0 && at->slip[a / 3] && t < 3; ++t) {
      const int b = a - a % 3 + t;
      if (at->place[a] < 0 || at->place[b] < 0) continue;
      s->K[at->place[a] + (size_t)at->n_free * at->place[b]] +=
          linear_turn(at, a, b);
    }
}

/* K and its factor; *good 0: not positive definite. */
static status factor(linear_contact *s, int *good) {
  int singular = 0;
  if (s->at.cp->op != NULL) {
    PASS(linear_set_rows(&s->at, &singular));
    *good = !singular;
    return OK;
  }
  size_t ld = s->at.n_free, m = s->at.cp->m;
  OWNS(s);
  PASS_NEW(s->K, ld * ld);
  for (size_t j = 0; j < ld; ++j) {
    const double *column = s->at.cp->A + m * s->at.free_id[j];
    for (size_t i = j; i < ld; ++i) s->K[i + ld * j] = column[s->at.free_id[i]];
  }
  if (s->at.cp->dim == 3) add_turning(s);
  *good = ld == 0 || (LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', s->at.n_free,
                                          s->K, s->at.n_free) == 0 &&
                      linear_is_regular(&s->at, s->K, 1));
  return OK;
}

/* x[n_free] = inv(K) x by the operator, A x too; returns x' K x. */
static double solve(linear_contact *s) {
  const contact_operator *op = s->at.cp->op;
  double energy = 0.0;
  CLEAR(s->full, s->at.cp->m);
  CLEAR(s->b, s->at.cp->m);
  for (int a = 0; a < s->at.n_free; ++a) s->b[s->at.free_id[a]] = s->x[a];
  op->solve(op->ctx, s->b, s->full, s->Ax);
  for (int a = 0; a < s->at.n_free; ++a) {
    energy += s->x[a] * s->full[s->at.free_id[a]];
    s->x[a] = s->full[s->at.free_id[a]];
  }
  return fmax(energy, 0.0);
}

/* x = inv(K) e dg; the energy x' K x. */
static double move(linear_contact *s) {
  const contact_problem *cp = s->at.cp;
  double energy = 0.0;
  for (int a = 0; a < s->at.n_free; ++a) {
    int dof = s->at.free_id[a], i = dof / cp->dim;
    int rubs = dof % cp->dim > 0 && s->at.slip[i];
    s->x[a] = rubs ? s->at.e[dof] * s->dg[i] : 0.0;
  }
  if (cp->op != NULL) return solve(s);
  LAPACKE_dtrtrs_work(LAPACK_COL_MAJOR, 'L', 'N', 'N', s->at.n_free, 1, s->K,
                      s->at.n_free, s->x, s->at.n_free);
  for (int a = 0; a < s->at.n_free; ++a) energy += s->x[a] * s->x[a];
  LAPACKE_dtrtrs_work(LAPACK_COL_MAJOR, 'L', 'T', 'N', s->at.n_free, 1, s->K,
                      s->at.n_free, s->x, s->at.n_free);
  return energy;
}

static status gather_columns(linear_contact *s) {
  if (s->at.cp->op != NULL) return OK;
  OWNS(s);
  PASS_NEW(s->P, (size_t)s->at.n_free * s->at.n_closed);
  double *to = s->P;
  for (int i = 0; i < s->at.cp->n; ++i) {
    if (!s->at.closed[i]) continue;
    const double *column =
        s->at.cp->A + (size_t)(i * s->at.cp->dim) * s->at.cp->m;
    for (int a = 0; a < s->at.n_free; ++a) *to++ = column[s->at.free_id[a]];
  }
  return OK;
}

/* Changes of the normal forces, N; dn[n], 0 at open nodes. */
static void push(const linear_contact *s, double *dn) {
  int c = s->at.n_closed;
  if (s->at.cp->op != NULL) {
    for (int i = 0; i < s->at.cp->n; ++i)
      dn[i] = s->at.closed[i] ? s->Ax[i * s->at.cp->dim] : 0.0;
    return;
  }
  if (c > 0)
    cblas_dgemv(CblasColMajor, CblasTrans, s->at.n_free, c, 1.0, s->P,
                s->at.n_free, s->x, 1, 0.0, dn, 1);
  for (int i = s->at.cp->n - 1; i >= 0; --i)
    dn[i] = s->at.closed[i] ? dn[--c] : 0.0;
}

/* dg = -B (A x)_n on the sliding nodes; dn[n] workspace. */
static void change_limit(linear_contact *s, double *dn) {
  const contact_problem *cp = s->at.cp;
  const sparse_rows *B = cp->B;
  push(s, dn);
  for (int i = 0; i < cp->n; ++i) {
    s->dg[i] = 0.0;
    for (int k = B->start[i]; s->at.slip[i] && k < B->start[i + 1]; ++k)
      s->dg[i] -= B->val[k] * dn[B->col[k]];
  }
}

/* The first change: the limit itself, different at neighbours. */
static void first_change(linear_contact *s, const double *r) {
  for (int i = 0; i < s->at.cp->n; ++i)
    s->dg[i] = s->at.slip[i] ? contact_node_limit(s->at.cp, r, i) *
                                   (1.0 + 0.5 * sin(1.0 + 2.0 * i))
                             : 0.0;
}

/* Largest entry of columns [from, k[ of R, in rows that are known or rub, or in
 * all. */
static double find_pivot(const linear_contact *s, const double *R, int from,
                         int all, int *row, int *column) {
  const contact_problem *cp = s->at.cp;
  double most = 0.0;
  for (int i = 0; i < cp->m; ++i) {
    if (!all && s->at.place[i] >= 0 &&
        !(i % cp->dim > 0 && s->at.slip[i / cp->dim]))
      continue;
    for (int c = from; c < cp->n_motion; ++c)
      if (fabs(R[i + (size_t)cp->m * c]) > most) {
        most = fabs(R[i + (size_t)cp->m * c]);
        *row = i;
        *column = c;
      }
  }
  return most;
}

/* Motions of bodies that nothing known and no slip takes part in, as those of
 * one that has left the others, keep their place: no force and no energy
 * changes by that. */
static status hold_idle(linear_contact *s) {
  const contact_problem *cp = s->at.cp;
  const int m = cp->m, k = cp->n_motion;
  int row = 0, column = 0;
  OWNED_NEW(double, R, (size_t)m *k);
  if (k > 0) COPY(R, cp->motion, (size_t)m * k);
  for (int done = 0, all = 0; all < 2; ++all)
    for (; done < k &&
           find_pivot(s, R, done, all, &row, &column) > CONTACT_NO_LEVER;
         ++done) {
      double *by = R + (size_t)m * done;
      cblas_dswap(m, by, 1, R + (size_t)m * column, 1);
      for (int c = done + 1; c < k; ++c)
        cblas_daxpy(m, -R[row + (size_t)m * c] / by[row], by, 1,
                    R + (size_t)m * c, 1);
      if (all) s->at.place[row] = -1;
    }
  s->at.n_free = 0;
  for (int i = 0; i < m; ++i) {
    if (s->at.place[i] < 0) continue;
    s->at.place[i] = s->at.n_free;
    s->at.free_id[s->at.n_free++] = i;
  }
  return OK;
}

static status measure(linear_contact *s, const double *r, double *rate) {
  double last;
  int good = 0;
  *rate = 0.0;
  if (s->at.n_slip == 0) return OK;
  OWNED_NEW(double, dn, s->at.cp->n);
  *rate = HUGE_VAL;
  PASS(hold_idle(s));
  PASS(factor(s, &good));
  if (!good) return OK;
  PASS(gather_columns(s));
  *rate = 0.0;
  first_change(s, r);
  last = move(s);
  for (int k = 1; k <= PASSES && last > 0.0; ++k) {
    change_limit(s, dn);
    double energy = move(s);
    if (k > 1) *rate = fmax(*rate, sqrt(energy / last));
    last = energy;
  }
  if (*rate <= DBL_EPSILON) *rate = 0.0; /* the rounding of A x */
  return OK;
}

/* ---- stored rates ----------------------------------------------- */

void known_rate_forget(known_rate *k) {
  if (k == NULL) return;
  memory_free(k->state);
  *k = (known_rate){0};
}

/* 0 known, 1 free, 2 and 3 sliding one way and the other. */
static signed char state_of(const linear_contact *s, int dof) {
  int moves = s->at.place[dof] >= 0, i = dof / s->at.cp->dim;
  if (!moves || dof % s->at.cp->dim == 0 || !s->at.slip[i])
    return (signed char)moves;
  return s->at.e[dof] > 0.0 ? 3 : 2;
}

/* The known rate of these states comes first, *same = 1; or they replace the
 * least recently used rate. */
static status compare(const linear_contact *s, known_rate *k, int *same) {
  const size_t m = s->at.cp->m;
  int at = 0;
  if (k->state == NULL || k->m != s->at.cp->m) {
    known_rate_forget(k);
    PASS_NEW(k->state, KNOWN_RATES * m);
    k->m = s->at.cp->m;
  }
  OWNED_NEW(signed char, now, m);
  for (int dof = 0; dof < s->at.cp->m; ++dof) now[dof] = state_of(s, dof);
  while (at < k->n && memcmp(k->state + m * at, now, m) != 0) ++at;
  *same = at < k->n;
  if (!*same && k->n < KNOWN_RATES) ++k->n;
  if (at == KNOWN_RATES) --at;
  double rate = k->rate[at];
  memmove(k->state + m, k->state, m * at);
  memmove(k->rate + 1, k->rate, at * sizeof *k->rate);
  memcpy(k->state, now, m);
  k->rate[0] = rate;
  return OK;
}

/* Mean factor of the last passes of many, independent of the start. */
static status measure_limit(linear_contact *s, const double *r, double *rate) {
  double last, grown = 0.0;
  OWNED_NEW(double, dn, s->at.cp->n);
  first_change(s, r);
  last = move(s);
  for (int k = 1; k <= LONG_RUN && last > 0.0; ++k) {
    for (int i = 0; i < s->at.cp->n; ++i) s->dg[i] /= sqrt(last);
    for (int a = 0; a < s->at.n_free; ++a) s->x[a] /= sqrt(last);
    for (int i = 0; s->Ax != NULL && i < s->at.cp->m; ++i)
      s->Ax[i] /= sqrt(last);
    change_limit(s, dn);
    last = move(s);
    if (k > LONG_RUN - AVERAGED) grown += 0.5 * log(last);
  }
  *rate = last > 0.0 ? exp(grown / AVERAGED) : 0.0;
  return OK;
}

status contraction_limit(const contact_problem *cp, const double *u,
                         const double *r, double *rate) {
  OWNED_OF(linear_contact, s, map_new(cp, u, r, 0, &s));
  PASS(measure(s, r, rate));
  if (*rate > 0.0 && *rate < HUGE_VAL) PASS(measure_limit(s, r, rate));
  return OK;
}

status contraction_rate(const contact_problem *cp, const double *u,
                        const double *r, known_rate *known, double *rate) {
  int same = 0;
  OWNED_OF(linear_contact, s, map_new(cp, u, r, 0, &s));
  if (known != NULL) PASS(compare(s, known, &same));
  if (same) {
    *rate = known->rate[0];
    return OK;
  }
  const status st = measure(s, r, rate);
  if (known != NULL) known->rate[0] = *rate;
  if (st != OK) known_rate_forget(known);
  return st;
}

status linear_contact_new(const contact_problem *cp, const double *u,
                          const double *r, linear_contact **out) {
  int good = 0;
  PASS(map_new(cp, u, r, 1, out));
  PASS(factor(*out, &good));
  if (!good) FORGET(*out);
  return OK;
}

status linear_contact_move(linear_contact *s, const double *df, double *du) {
  const linear_states *at = &s->at;
  int singular = 0;
  for (int a = 0; a < at->n_free; ++a) s->x[a] = df[at->free_id[a]];
  if (at->cp->op != NULL) {
    PASS(linear_set_rows(&s->at, &singular));
    solve(s);
  } else if (at->n_free > 0) {
    LAPACKE_dpotrs_work(LAPACK_COL_MAJOR, 'L', at->n_free, 1, s->K, at->n_free,
                        s->x, at->n_free);
  }
  for (int k = 0; k < at->cp->m; ++k)
    du[k] = at->place[k] >= 0 ? s->x[at->place[k]] : 0.0;
  return OK;
}
