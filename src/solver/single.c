/* All states of a single node (single.h). */
#include "solver/single.h"

#include "base/base.h"

#include <lapacke.h>

enum {
  ANGLES = 256, /* of slip, searched; there are at most 6 roots */
  HALVINGS = 60,
  WORK = 32
};
static const double RANK = 0x1p-40; /* -, of a singular matrix */
static const double GOLDEN = 0.6180339887498949;

typedef struct single {
  const contact_problem *cp;
  double scale, tol;
  double u0[3], r0[3];         /* the start */
  double P[9], Q[9], c[3];     /* [m*m], [m*m], [m] */
  double to_one[3];            /* powers of two for columns of P, Q and c */
  int m, n_rub, rub[2];        /* tangents with friction */
  double ut0[2], g0, mu;       /* m, N, - */
  contact_status start;        /* its status */
  double u[3], r[3], residual; /* the best solution so far */
  double distance;             /* of it; HUGE_VAL: none */
  int like;                    /* 1: with the status of the start */
} single;

static void set_problem(single *s) {
  const contact_problem *cp = s->cp;
  int m = s->m = cp->m;
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < m; ++j) {
      s->P[i + m * j] = contact_has_stiffness(cp) ? cp->A[i + m * j] : i == j;
      s->Q[i + m * j] =
          contact_has_stiffness(cp) ? -(i == j) : -cp->W[i + m * j];
    }
    s->c[i] = cp->f[i];
  }
  if (cp->g0 == NULL || contact_has_side(cp, 0)) return;
  s->g0 = cp->g0[0];
  s->mu = row_sum(cp->B, 0);
  for (int k = 1; k < m; ++k) {
    if (contact_held(cp, k)) continue;
    s->ut0[s->n_rub] = contact_stick(cp, k);
    s->rub[s->n_rub++] = k;
  }
  const double P = largest_entry(m * m, s->P);
  const double Q = largest_entry(m * m, s->Q);
  const double u = fmax(fabs(cp->gap[0]), largest_entry(2, s->ut0));
  const double c = largest_entry(m, s->c);
  s->to_one[0] = power_to_one(P);
  s->to_one[1] = power_to_one(Q);
  s->to_one[2] = power_to_one(fmax(c, fmax(P * u, Q * s->g0)));
}

/* Store a candidate if it is a solution and nearer to the start. */
static void check(single *s, const double *u, const double *r) {
  double apart = 0.0;
  contact_status state;
  double residual = contact_residual_at(s->cp, s->scale, u, r);
  if (!(residual <= s->tol)) return;
  contact_classify(s->cp, u, r, &state);
  int like = state == s->start;
  for (int i = 0; i < s->m; ++i)
    apart = hypot(apart, contact_has_stiffness(s->cp) ? u[i] - s->u0[i]
                                                      : r[i] - s->r0[i]);
  if (like < s->like || (like == s->like && !(apart < s->distance))) return;
  s->like = like;
  COPY(s->u, u, s->m);
  COPY(s->r, r, s->m);
  s->distance = apart;
  s->residual = residual;
}

/* ---- states that are linear ---------------------------------------------- */

/* The state with u_i = u[i] of the unknowns in "fixed" (bit i), r_i = 0 of the
 * others. */
static void try_linear(single *s, unsigned fixed, const double *at) {
  double M[9], b[3], u[3], r[3], power[3], work[WORK];
  int m = s->m, pivot[3] = {0, 0, 0}, rank;
  for (int i = 0; i < m; ++i) {
    b[i] = s->c[i];
    for (int j = 0; j < m; ++j) {
      int is_fixed = fixed >> j & 1u;
      M[i + m * j] = is_fixed ? s->Q[i + m * j] : s->P[i + m * j];
      if (is_fixed) b[i] -= s->P[i + m * j] * at[j];
    }
  }
  for (int j = 0; j < m; ++j) {
    power[j] = power_to_one(largest_entry(m, M + m * j));
    for (int i = 0; i < m; ++i) M[i + m * j] *= power[j];
  }
  if (LAPACKE_dgelsy_work(LAPACK_COL_MAJOR, m, m, 1, M, m, b, m, pivot, RANK,
                          &rank, work, WORK) != 0)
    return;
  for (int j = 0; j < m; ++j) {
    int is_fixed = fixed >> j & 1u;
    u[j] = is_fixed ? at[j] : power[j] * b[j];
    r[j] = is_fixed ? power[j] * b[j] : 0.0;
  }
  check(s, u, r);
}

/* Every set of closed unknowns, with and without stick. */
static void try_all_linear(single *s) {
  unsigned bounded = 0u, rubs = 0u;
  double at[3] = {0.0, 0.0, 0.0};
  for (int i = 0; i < s->m; ++i) {
    double bound = contact_bound(s->cp, i);
    if (bound < HUGE_VAL) bounded |= 1u << i;
    at[i] = bound < HUGE_VAL ? bound : contact_stick(s->cp, i);
  }
  for (int k = 0; k < s->n_rub; ++k) rubs |= 1u << s->rub[k];
  for (unsigned closed = 0u; closed < 1u << s->m; ++closed) {
    if (closed & ~bounded) continue;
    try_linear(s, closed, at);
    if (rubs != 0u) try_linear(s, closed | rubs, at);
  }
}

/* ---- slip ---------------------------------------------------------------- */

/* y += x times column j of M. */
static void add(const single *s, const double *M, int j, double x, double *y) {
  for (int i = 0; i < s->m; ++i) y[i] += x * M[i + s->m * j];
}

static void scale(double *x, double factor) {
  for (int i = 0; i < 3; ++i) x[i] *= factor;
}

/* Columns of s and of p (u_n if open), right side, for slip along e, each times
 * its power of two. Rows of unknowns that are held stay zero in all. */
static void set_slip(const single *s, int closed, const double *e, double *a,
                     double *b, double *c) {
  for (int i = 0; i < 3; ++i) {
    a[i] = b[i] = 0.0;
    c[i] = i < s->m && !contact_held(s->cp, i) ? s->c[i] : 0.0;
  }
  add(s, closed ? s->Q : s->P, 0, closed ? -1.0 : 1.0, b);
  if (closed) add(s, s->P, 0, -s->cp->gap[0], c);
  for (int k = 0; k < s->n_rub; ++k) {
    add(s, s->P, s->rub[k], e[k], a);
    add(s, s->P, s->rub[k], -s->ut0[k], c);
    add(s, s->Q, s->rub[k], s->g0 * e[k], c);
    if (closed) add(s, s->Q, s->rub[k], -s->mu * e[k], b);
  }
  scale(a, s->to_one[0]);
  scale(b, s->to_one[closed]);
  scale(c, s->to_one[2]);
}

/* Determinant for slip at an angle. */
static double misfit(const single *s, int closed, double angle) {
  double a[3], b[3], c[3], n[3], e[2] = {cos(angle), sin(angle)};
  set_slip(s, closed, e, a, b, c);
  cross(a, b, n);
  return dot(3, n, c);
}

static void try_slip(single *s, int closed, double angle) {
  double a[3], b[3], c[3], n[3], x[3], y[3], u[3] = {0.0}, r[3] = {0.0};
  double e[2] = {cos(angle), sin(angle)};
  if (s->n_rub == 1) e[0] = e[0] > 0.0 ? 1.0 : -1.0;
  set_slip(s, closed, e, a, b, c);
  cross(a, b, n);
  double size = dot(3, n, n);
  if (!(size > 0.0)) return;
  cross(c, b, x);
  cross(a, c, y);
  double slip = dot(3, x, n) / size * (s->to_one[0] / s->to_one[2]);
  double other = dot(3, y, n) / size * (s->to_one[closed] / s->to_one[2]);
  double g = s->g0 + (closed ? s->mu * other : 0.0);
  for (int i = 0; i < s->m; ++i) u[i] = s->c[i] / s->P[i + s->m * i];
  u[0] = closed ? s->cp->gap[0] : other;
  r[0] = closed ? -other : 0.0;
  for (int k = 0; k < s->n_rub; ++k) {
    u[s->rub[k]] = s->ut0[k] + slip * e[k];
    r[s->rub[k]] = -g * e[k];
  }
  check(s, u, r);
}

/* The root between two angles, by bisection. */
static double root(const single *s, int closed, double from, double to) {
  double sign = misfit(s, closed, from);
  for (int k = 0; k < HALVINGS; ++k) {
    double middle = 0.5 * (from + to);
    if ((misfit(s, closed, middle) > 0.0) == (sign > 0.0))
      from = middle;
    else
      to = middle;
  }
  return 0.5 * (from + to);
}

/* Where the size of the determinant is least between two angles. */
static double least(const single *s, int closed, double from, double to) {
  for (int k = 0; k < HALVINGS; ++k) {
    double left = to - GOLDEN * (to - from),
           right = from + GOLDEN * (to - from);
    if (fabs(misfit(s, closed, left)) < fabs(misfit(s, closed, right)))
      to = right;
    else
      from = left;
  }
  return 0.5 * (from + to);
}

static void try_all_slips(single *s, int closed) {
  double step = 2.0 * acos(-1.0) / ANGLES, before, here, after;
  if (s->n_rub == 1) {
    try_slip(s, closed, 0.0);
    try_slip(s, closed, 0.5 * step * ANGLES);
    return;
  }
  before = misfit(s, closed, -step);
  here = misfit(s, closed, 0.0);
  for (int k = 0; k < ANGLES; ++k) {
    after = misfit(s, closed, (k + 1) * step);
    if ((here > 0.0) != (after > 0.0))
      try_slip(s, closed, root(s, closed, k * step, (k + 1) * step));
    else if (fabs(here) <= fabs(before) && fabs(here) <= fabs(after))
      try_slip(s, closed, least(s, closed, (k - 1) * step, (k + 1) * step));
    before = here;
    here = after;
  }
}

int single_solve(const contact_problem *cp, double scale, double tol, double *u,
                 double *r, double *residual) {
  single s = {.cp = cp, .scale = scale, .tol = tol, .distance = HUGE_VAL};
  COPY(s.u0, u, cp->m);
  COPY(s.r0, r, cp->m);
  contact_classify(cp, u, r, &s.start);
  set_problem(&s);
  try_all_linear(&s);
  if (s.n_rub > 0 && (s.g0 != 0.0 || s.mu != 0.0)) {
    try_all_slips(&s, 1);
    if (s.g0 > 0.0) try_all_slips(&s, 0);
  }
  if (!(s.distance < HUGE_VAL)) return 0;
  COPY(u, s.u, cp->m);
  COPY(r, s.r, cp->m);
  *residual = s.residual;
  return 1;
}
