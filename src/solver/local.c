/*
 * One node: the states open, stick and slip are computed in turn; the first
 * that satisfies its inequalities is the answer (local.h).
 */
#include "solver/local.h"

#include <math.h>

enum { ROOT_STEPS = 100 };

/* A state computed, and by how much it misses its inequalities, N. */
typedef struct candidate {
  double x[3], r[3], miss;
} candidate;

static double positive(double a) { return a > 0.0 ? a : 0.0; }

static double size_of(const local_problem *lp, const double *v) {
  double sum = 0.0;
  for (int k = 1; k < lp->dim; ++k) sum += v[k] * v[k];
  return sqrt(sum);
}

/* K x - b */
static void reaction(const local_problem *lp, const double *x, double *r) {
  for (int i = 0; i < lp->dim; ++i) {
    r[i] = -lp->b[i];
    for (int j = 0; j < lp->dim; ++j) r[i] += lp->K[i + lp->dim * j] * x[j];
  }
}

/* Solve the rows and columns in "free" (bit k: unknown k) of K x = b. */
static void solve_free(const local_problem *lp, unsigned free_set, double *x) {
  double L[9], y[3];
  int id[3], n = 0;
  for (int k = 0; k < lp->dim; ++k)
    if (free_set >> k & 1u) id[n++] = k;
  for (int i = 0; i < n; ++i) {
    y[i] = lp->b[id[i]];
    for (int k = 0; k < lp->dim; ++k)
      if (!(free_set >> k & 1u)) y[i] -= lp->K[id[i] + lp->dim * k] * x[k];
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
    x[id[k]] = y[k];
  }
}

/* S s = c + t, |t| <= g, t = -g s/|s| on slip, g = max(0, ga + gb . s): one or
 * two tangents. */
typedef struct disc_problem {
  int n;
  double S[4], c[2], ga, gb[2];
} disc_problem;

/* Largest slope mu K_tn that keeps a one-dimensional slip unique is S itself:
 * s = (c + e ga)/(S - e gb), e = -sign(s). */
static void slip_line(const disc_problem *dp, double *s) {
  double e = dp->c[0] > 0.0 ? -1.0 : 1.0;
  double stiffness = dp->S[0] - e * dp->gb[0];
  s[0] = (dp->c[0] + e * dp->ga) / stiffness;
  if (!(stiffness > 0.0) || e * s[0] > 0.0) s[0] = 0.0;
}

/* Slip for a given flexibility nu = |s|/|t|:  q = (nu S + I)^-1 c = -t and
 * s = nu q; returns |q| - g(s), and its derivative. */
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

/* The root of slip_excess by Newton steps from stick (nu = 0, where Tresca
 * friction makes them monotone), kept inside a bracket. */
static void slip_disc(const disc_problem *dp, double *s) {
  double low = 0.0, high = HUGE_VAL, nu = 0.0, q[2], slope;
  double start = 1.0 / (dp->S[0] + dp->S[3]);
  for (int k = 0; k < ROOT_STEPS; ++k) {
    double excess = slip_excess(dp, nu, q, &slope);
    if (excess > 0.0)
      low = nu;
    else
      high = nu;
    if (excess == 0.0) break;
    double next = slope < 0.0 ? nu - excess / slope : HUGE_VAL;
    if (!(next > low && next < high)) {
      if (high < HUGE_VAL)
        next = low + 0.5 * (high - low);
      else
        next = 4.0 * (low > 0.0 ? low : start);
    }
    if (fabs(next - nu) <= 0x1p-52 * nu || !(next < HUGE_VAL)) break;
    nu = next;
  }
  slip_excess(dp, nu, q, &slope);
  s[0] = nu * q[0];
  s[1] = nu * q[1];
}

/* s and t = S s - c; 1 if it slips. */
static int disc_solve(const disc_problem *dp, double *s, double *t) {
  double size = dp->n == 1 ? fabs(dp->c[0])
                           : sqrt(dp->c[0] * dp->c[0] + dp->c[1] * dp->c[1]);
  s[0] = s[1] = 0.0;
  for (int k = 0; k < dp->n; ++k) t[k] = -dp->c[k];
  if (size <= positive(dp->ga)) return 0;
  if (dp->n == 1) {
    slip_line(dp, s);
    t[0] = dp->S[0] * s[0] - dp->c[0];
    return 1;
  }
  slip_disc(dp, s);
  t[0] = dp->S[0] * s[0] + dp->S[1] * s[1] - dp->c[0];
  t[1] = dp->S[2] * s[0] + dp->S[3] * s[1] - dp->c[1];
  return 1;
}

/* r_n = 0: the normal unknown eliminated, friction only by g0. */
static void try_open(const local_problem *lp, candidate *c) {
  int d = lp->dim;
  disc_problem dp = {.n = d - 1, .ga = positive(lp->g0)};
  for (int i = 1; i < d; ++i) {
    dp.c[i - 1] = lp->b[i] - lp->K[i] * lp->b[0] / lp->K[0];
    for (int j = 1; j < d; ++j)
      dp.S[i - 1 + (d - 1) * (j - 1)] =
          lp->K[i + d * j] - lp->K[i] * lp->K[d * j] / lp->K[0];
  }
  if (dp.ga == 0.0) {
    solve_free(lp, (1u << d) - 1u, c->x);
    c->r[0] = c->r[1] = c->r[2] = 0.0;
  } else {
    disc_solve(&dp, c->x + 1, c->r + 1);
    solve_free(lp, 1u, c->x);
    c->r[0] = 0.0;
  }
  c->miss = lp->K[0] * positive(c->x[0]);
}

static void try_stick(const local_problem *lp, candidate *c) {
  for (int k = 0; k < lp->dim; ++k) {
    c->x[k] = 0.0;
    c->r[k] = -lp->b[k];
  }
  double over = size_of(lp, c->r) - positive(lp->g0 - lp->mu * c->r[0]);
  c->miss = positive(over) + positive(c->r[0]);
}

static void try_slip(const local_problem *lp, candidate *c) {
  int d = lp->dim;
  disc_problem dp = {.n = d - 1, .ga = lp->g0 + lp->mu * lp->b[0]};
  for (int i = 1; i < d; ++i) {
    dp.c[i - 1] = lp->b[i];
    dp.gb[i - 1] = -lp->mu * lp->K[d * i];
    for (int j = 1; j < d; ++j)
      dp.S[i - 1 + (d - 1) * (j - 1)] = lp->K[i + d * j];
  }
  c->x[0] = 0.0;
  if (lp->g0 == 0.0 && lp->mu == 0.0)
    solve_free(lp, (1u << d) - 2u, c->x);
  else
    disc_solve(&dp, c->x + 1, c->r + 1);
  reaction(lp, c->x, c->r);
  if (lp->g0 == 0.0 && lp->mu == 0.0)
    for (int k = 1; k < d; ++k) c->r[k] = 0.0;
  double g = positive(lp->g0 - lp->mu * c->r[0]), dot = 0.0;
  for (int k = 1; k < d; ++k) dot += c->r[k] * c->x[k];
  c->miss = positive(c->r[0]) + fabs(size_of(lp, c->r) - g);
  if (dot > 0.0) c->miss += size_of(lp, c->r);
}

/* A frictionless node at two or three obstacles: every set of closed ones. */
static local_state solve_bounded(const local_problem *lp, double *x,
                                 double *r) {
  double best = HUGE_VAL;
  unsigned n_set = 1u << lp->dim, chosen = 0;
  for (unsigned closed = 0; closed < n_set; ++closed) {
    candidate c = {.miss = 0.0};
    int possible = 1;
    for (int k = 0; k < lp->dim; ++k)
      if (closed >> k & 1u) {
        c.x[k] = lp->bound[k];
        possible = possible && lp->bound[k] < HUGE_VAL;
      }
    if (!possible) continue;
    solve_free(lp, ~closed & (n_set - 1u), c.x);
    reaction(lp, c.x, c.r);
    for (int k = 0; k < lp->dim; ++k)
      if (closed >> k & 1u) {
        c.miss += positive(c.r[k]);
      } else {
        c.r[k] = 0.0;
        c.miss += lp->K[k + lp->dim * k] * positive(c.x[k] - lp->bound[k]);
      }
    if (!(c.miss < best)) continue;
    best = c.miss;
    chosen = closed;
    for (int k = 0; k < lp->dim; ++k) {
      x[k] = c.x[k];
      r[k] = c.r[k];
    }
  }
  return chosen & 1u ? LOCAL_SLIP : LOCAL_OPEN;
}

local_state local_solve(const local_problem *lp, local_state before, double *x,
                        double *r) {
  static void (*const attempt[])(const local_problem *, candidate *) = {
      try_open, try_stick, try_slip};
  static const local_state order[3][3] = {
      {LOCAL_OPEN, LOCAL_STICK, LOCAL_SLIP},
      {LOCAL_STICK, LOCAL_SLIP, LOCAL_OPEN},
      {LOCAL_SLIP, LOCAL_STICK, LOCAL_OPEN}};
  if (lp->bounded) return solve_bounded(lp, x, r);
  int frictionless = lp->g0 == 0.0 && lp->mu == 0.0;
  double best = HUGE_VAL, force = fabs(lp->b[0]) + size_of(lp, lp->b);
  local_state found = before;
  for (int i = 0; i < 3; ++i) {
    candidate c = {.miss = 0.0};
    if (frictionless && order[before][i] == LOCAL_STICK) continue;
    attempt[order[before][i]](lp, &c);
    if (!(c.miss < best) && i > 0) continue;
    best = c.miss;
    found = order[before][i];
    for (int k = 0; k < lp->dim; ++k) {
      x[k] = c.x[k];
      r[k] = c.r[k];
    }
    if (best <= 0x1p-46 * force) break;
  }
  return found;
}
