/*
 * One node: the states open, stick and slip are computed in turn; the first
 * that satisfies its inequalities is the answer (local.h).
 */
#include "solver/local.h"

#include "base/vector.h"

enum { ROOT_STEPS = 100 };
static const double LAST_STEP = 0x1p-27; /* -, of a root found by Newton steps:
                                            the next is its square */

/* A state computed, and the violation of its inequalities, N. */
typedef struct candidate {
  double d[3], r[3], violation;
} candidate;

static double positive(double a) { return a > 0.0 ? a : 0.0; }

/* Of the tangents. */
static double size_of(const local_problem *lp, const double *v) {
  return norm(lp->dim - 1, v + 1);
}

/* K d - b */
static void reaction(const local_problem *lp, const double *d, double *r) {
  for (int i = 0; i < lp->dim; ++i) {
    r[i] = -lp->b[i];
    for (int j = 0; j < lp->dim; ++j) r[i] += lp->K[i + lp->dim * j] * d[j];
  }
}

/* Solve the rows and columns in "free" (bit k: unknown k) of K d = b. */
static void solve_free(const local_problem *lp, unsigned free_set, double *d) {
  double L[9], y[3];
  int id[3], n = 0;
  for (int k = 0; k < lp->dim; ++k)
    if (free_set >> k & 1u) id[n++] = k;
  for (int i = 0; i < n; ++i) {
    y[i] = lp->b[id[i]];
    for (int k = 0; k < lp->dim; ++k)
      if (!(free_set >> k & 1u)) y[i] -= lp->K[id[i] + lp->dim * k] * d[k];
    for (int j = 0; j < n; ++j) L[i + 3 * j] = lp->K[id[i] + lp->dim * id[j]];
  }
  for (int k = 0; k < n; ++k)
    for (int i = k + 1; i < n; ++i) {
      double l = L[i + 3 * k] / L[k + 3 * k];
      for (int j = k; j < n; ++j) L[i + 3 * j] -= l * L[k + 3 * j];
      y[i] -= l * y[k];
    }
  for (int k = n - 1; k >= 0; --k) {
    for (int j = k + 1; j < n; ++j) y[k] -= L[k + 3 * j] * y[j];
    y[k] /= L[k + 3 * k];
    d[id[k]] = y[k];
  }
}

/* S d = c + t, s = at + d, |t| <= g, t = -g s/|s| on slip,
 * g = max(0, ga + gb . d): one or two tangents. */
typedef struct disc_problem {
  int n;
  double S[4], c[2], ga, gb[2], at[2];
} disc_problem;

/* Posed in s (at = 0), slip for a given flexibility nu = |s|/|t|:  q = (nu S +
 * I)^-1 c = -t and s = nu q; returns |q| - g(s), and its derivative. */
static double slip_excess(const disc_problem *dp, double nu, double *q,
                          double *slope) {
  double a = nu * dp->S[0] + 1.0, b = nu * dp->S[1], d = nu * dp->S[3] + 1.0;
  double det = a * d - b * b;
  q[0] = (d * dp->c[0] - b * dp->c[1]) / det;
  q[1] = (a * dp->c[1] - b * dp->c[0]) / det;
  double v0 = dp->S[0] * q[0] + dp->S[1] * q[1];
  double v1 = dp->S[1] * q[0] + dp->S[3] * q[1];
  double dq0 = -(d * v0 - b * v1) / det, dq1 = -(a * v1 - b * v0) / det;
  double size = sqrt(q[0] * q[0] + q[1] * q[1]);
  double g = dp->ga + nu * (dp->gb[0] * q[0] + dp->gb[1] * q[1]);
  double dg = dp->gb[0] * (q[0] + nu * dq0) + dp->gb[1] * (q[1] + nu * dq1);
  *slope = (size > 0.0 ? (q[0] * dq0 + q[1] * dq1) / size : 0.0) -
           (g > 0.0 ? dg : 0.0);
  return size - (g > 0.0 ? g : 0.0);
}

/* The root of slip_excess by Newton steps from nu, of the last visit or of
 * stick (0, where Tresca friction makes them monotone), kept inside a
 * bracket. */
static void slip_disc(const disc_problem *dp, double nu, double *s) {
  double low = 0.0, high = HUGE_VAL, q[2], slope;
  double start = 1.0 / (dp->S[0] + dp->S[3]);
  for (int k = 0; k < ROOT_STEPS; ++k) {
    double excess = slip_excess(dp, nu, q, &slope);
    if (excess > 0.0)
      low = nu;
    else
      high = nu;
    if (excess == 0.0) break;
    double next = slope < 0.0 ? nu - excess / slope : HUGE_VAL;
    double enough = LAST_STEP;
    if (!(next > low && next < high)) {
      enough = 0x1p-52;
      if (high < HUGE_VAL)
        next = low + 0.5 * (high - low);
      else
        next = 4.0 * (low > 0.0 ? low : start);
    }
    if (!(next < HUGE_VAL)) break;
    const double moved = fabs(next - nu);
    nu = next;
    if (moved <= enough * nu) break;
  }
  slip_excess(dp, nu, q, &slope);
  s[0] = nu * q[0];
  s[1] = nu * q[1];
}

/* The same in steps, where the slip s found is so long that errors of its
 * direction n fade: (S + n gb') d = c - ga n. */
static void slip_step(const disc_problem *dp, const double *s, double *d) {
  double size = norm(2, s), n[2], y[2], M[4];
  for (int i = 0; i < 2; ++i) {
    d[i] = s[i] - dp->at[i];
    n[i] = s[i] / size;
  }
  double g = dp->ga + dp->gb[0] * d[0] + dp->gb[1] * d[1];
  if (!(g > 0.0 && g < fmin(dp->S[0], dp->S[3]) * size)) return;
  for (int i = 0; i < 2; ++i) {
    y[i] = dp->c[i] - dp->ga * n[i];
    for (int j = 0; j < 2; ++j)
      M[i + 2 * j] = dp->S[i + 2 * j] + n[i] * dp->gb[j];
  }
  double det = M[0] * M[3] - M[1] * M[2];
  if (!(det > 0.0)) return;
  d[0] = (M[3] * y[0] - M[2] * y[1]) / det;
  d[1] = (M[0] * y[1] - M[1] * y[0]) / det;
}

/* d and t = S d - c; 1 if it slips. */
static int disc_solve(const disc_problem *dp, double *d, double *t) {
  disc_problem held = *dp; /* posed in s */
  double size = 0.0, s[2];
  for (int i = 0; i < dp->n; ++i) {
    for (int j = 0; j < dp->n; ++j)
      held.c[i] += dp->S[i + dp->n * j] * dp->at[j];
    held.ga -= dp->gb[i] * dp->at[i];
    size += held.c[i] * held.c[i];
    d[i] = -dp->at[i];
    t[i] = -held.c[i];
  }
  if (sqrt(size) <= positive(held.ga)) return 0;
  if (dp->n == 1) {
    /* Largest slope mu K_tn that keeps a one-dimensional slip unique is S
     * itself: d = (c + e ga)/(S - e gb), e = -sign(s), the sign of less the
     * force that would hold it, "held". */
    double e = held.c[0] > 0.0 ? -1.0 : 1.0;
    double stiffness = dp->S[0] - e * dp->gb[0];
    d[0] = (dp->c[0] + e * dp->ga) / stiffness;
    if (!(stiffness > 0.0) || e * (dp->at[0] + d[0]) > 0.0) d[0] = -dp->at[0];
  } else {
    double flexibility = norm(2, dp->at) / norm(2, dp->c);
    slip_disc(&held, flexibility < HUGE_VAL ? flexibility : 0.0, s);
    slip_step(dp, s, d);
  }
  for (int i = 0; i < dp->n; ++i) {
    t[i] = -dp->c[i];
    for (int j = 0; j < dp->n; ++j) t[i] += dp->S[i + dp->n * j] * d[j];
  }
  return 1;
}

/* r_n = 0: the normal unknown eliminated, friction only by g0. */
static void try_open(const local_problem *lp, candidate *c) {
  int d = lp->dim;
  disc_problem dp = {.n = d - 1, .ga = positive(lp->g0)};
  for (int i = 1; i < d; ++i) {
    dp.at[i - 1] = lp->at[i];
    dp.c[i - 1] = lp->b[i] - lp->K[i] * lp->b[0] / lp->K[0];
    for (int j = 1; j < d; ++j)
      dp.S[i - 1 + (d - 1) * (j - 1)] =
          lp->K[i + d * j] - lp->K[i] * lp->K[d * j] / lp->K[0];
  }
  if (dp.ga == 0.0) {
    solve_free(lp, (1u << d) - 1u, c->d);
    c->r[0] = c->r[1] = c->r[2] = 0.0;
  } else {
    disc_solve(&dp, c->d + 1, c->r + 1);
    solve_free(lp, 1u, c->d);
    c->r[0] = 0.0;
  }
  c->violation = lp->K[0] * positive(lp->at[0] + c->d[0]);
}

static void try_stick(const local_problem *lp, candidate *c) {
  for (int k = 0; k < lp->dim; ++k) c->d[k] = -lp->at[k];
  reaction(lp, c->d, c->r);
  double over = size_of(lp, c->r) - positive(lp->g0 - lp->mu * c->r[0]);
  c->violation = positive(over) + positive(c->r[0]);
}

static void try_slip(const local_problem *lp, candidate *c) {
  int d = lp->dim;
  double pressed = lp->b[0] + lp->K[0] * lp->at[0];
  disc_problem dp = {.n = d - 1, .ga = lp->g0 + lp->mu * pressed};
  for (int i = 1; i < d; ++i) {
    dp.at[i - 1] = lp->at[i];
    dp.c[i - 1] = lp->b[i] + lp->K[i] * lp->at[0];
    dp.gb[i - 1] = -lp->mu * lp->K[d * i];
    for (int j = 1; j < d; ++j)
      dp.S[i - 1 + (d - 1) * (j - 1)] = lp->K[i + d * j];
  }
  c->d[0] = -lp->at[0];
  if (lp->g0 == 0.0 && lp->mu == 0.0)
    solve_free(lp, (1u << d) - 2u, c->d);
  else
    disc_solve(&dp, c->d + 1, c->r + 1);
  reaction(lp, c->d, c->r);
  if (lp->g0 == 0.0 && lp->mu == 0.0)
    for (int k = 1; k < d; ++k) c->r[k] = 0.0;
  double g = positive(lp->g0 - lp->mu * c->r[0]), dot = 0.0;
  for (int k = 1; k < d; ++k) dot += c->r[k] * (lp->at[k] + c->d[k]);
  c->violation = positive(c->r[0]) + fabs(size_of(lp, c->r) - g);
  if (dot > 0.0) c->violation += size_of(lp, c->r);
}

/* A frictionless node at two or three obstacles: every set of closed ones. */
static local_state solve_bounded(const local_problem *lp, double *d,
                                 double *r) {
  double best = HUGE_VAL;
  unsigned n_set = 1u << lp->dim, chosen = 0;
  for (unsigned closed = 0; closed < n_set; ++closed) {
    candidate c = {.violation = 0.0};
    int possible = 1;
    for (int k = 0; k < lp->dim; ++k)
      if (closed >> k & 1u) {
        c.d[k] = lp->bound[k] - lp->at[k];
        possible = possible && lp->bound[k] < HUGE_VAL;
      }
    if (!possible) continue;
    solve_free(lp, ~closed & (n_set - 1u), c.d);
    reaction(lp, c.d, c.r);
    for (int k = 0; k < lp->dim; ++k)
      if (closed >> k & 1u) {
        c.violation += positive(c.r[k]);
      } else {
        c.r[k] = 0.0;
        c.violation += lp->K[k + lp->dim * k] *
                       positive(lp->at[k] + c.d[k] - lp->bound[k]);
      }
    if (!(c.violation < best)) continue;
    best = c.violation;
    chosen = closed;
    for (int k = 0; k < lp->dim; ++k) {
      d[k] = c.d[k];
      r[k] = c.r[k];
    }
  }
  return chosen & 1u ? LOCAL_SLIP : LOCAL_OPEN;
}

local_state local_solve(const local_problem *lp, local_state before, double *d,
                        double *r) {
  static void (*const attempt[])(const local_problem *, candidate *) = {
      try_open, try_stick, try_slip};
  static const local_state order[3][3] = {
      {LOCAL_OPEN, LOCAL_STICK, LOCAL_SLIP},
      {LOCAL_STICK, LOCAL_SLIP, LOCAL_OPEN},
      {LOCAL_SLIP, LOCAL_STICK, LOCAL_OPEN}};
  if (lp->bounded) return solve_bounded(lp, d, r);
  int frictionless = lp->g0 == 0.0 && lp->mu == 0.0;
  double best = HUGE_VAL;
  double force =
      fabs(lp->b[0]) + size_of(lp, lp->b) + fabs(lp->K[0] * lp->at[0]);
  local_state found = before;
  for (int i = 0; i < 3; ++i) {
    candidate c = {.violation = 0.0};
    if (frictionless && order[before][i] == LOCAL_STICK) continue;
    attempt[order[before][i]](lp, &c);
    if (!(c.violation < best) && i > 0) continue;
    best = c.violation;
    found = order[before][i];
    for (int k = 0; k < lp->dim; ++k) {
      d[k] = c.d[k];
      r[k] = c.r[k];
    }
    if (best <= 0x1p-46 * force) break;
  }
  return found;
}
