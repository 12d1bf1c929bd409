/* Fixed point on the sliding limit, with Anderson mixing (fixed_point.h). */
#include "solver/fixed_point.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

enum { DEPTH = 4, PASSES = 200 };
static const double RATE_MARGIN = 0x1p-24; /* -, of |g|: shorter differences
                                              are rounding                  */
static const double SHORTEST_STEP = 1.0 / 32.0; /* -, of G(g) - g             */

struct fixed_point {
  int n, kept;             /* nodes; differences now kept                   */
  double *g, *image;       /* [n] limit of the pass and G(g), N             */
  double *best_g, *best_G; /* [n] pass with the lowest residual             */
  double *dg, *dG;         /* [n*DEPTH] differences of passes, newest first */
};

status fixed_point_new(int n, fixed_point **out) {
  status st = OK;
  fixed_point *fp = NULL;
  NEW(fp, 1);
  fp->n = n;
  NEW(fp->g, n);
  NEW(fp->image, n);
  NEW(fp->best_g, n);
  NEW(fp->best_G, n);
  NEW(fp->dg, n * DEPTH);
  NEW(fp->dG, n * DEPTH);
  *out = fp;
  fp = NULL;
done:
  fixed_point_free(fp);
  return st;
}

void fixed_point_free(fixed_point *fp) {
  if (fp == NULL) return;
  memory_free(fp->g);
  memory_free(fp->image);
  memory_free(fp->best_g);
  memory_free(fp->best_G);
  memory_free(fp->dg);
  memory_free(fp->dG);
  memory_free(fp);
}

static double norm(int n, const double *x) {
  double sum = 0.0;
  for (int i = 0; i < n; ++i) sum += x[i] * x[i];
  return sqrt(sum);
}

/* Shift the differences and put those of the last two passes in front; the
 * ratio of their lengths is the rate. */
static double keep_difference(fixed_point *fp, const double *g,
                              const double *image) {
  size_t n = (size_t)fp->n;
  memmove(fp->dg + n, fp->dg, n * (DEPTH - 1) * sizeof *fp->dg);
  memmove(fp->dG + n, fp->dG, n * (DEPTH - 1) * sizeof *fp->dG);
  for (size_t i = 0; i < n; ++i) {
    fp->dg[i] = fp->g[i] - g[i];
    fp->dG[i] = fp->image[i] - image[i];
  }
  if (fp->kept < DEPTH) ++fp->kept;
  double length = norm(fp->n, fp->dg);
  int above_rounding = length > RATE_MARGIN * norm(fp->n, fp->image);
  return above_rounding ? norm(fp->n, fp->dG) / length : 0.0;
}

/* Least squares |F - dF x| of the defects F = G(g) - g by elimination on the
 * kept differences (dependent ones are left out); x[DEPTH]. */
static void mixing_weights(const fixed_point *fp, double *x) {
  int n = fp->n, k = fp->kept;
  double N[DEPTH][DEPTH + 1];
  for (int a = 0; a < k; ++a)
    for (int b = 0; b <= k; ++b) {
      N[a][b] = 0.0;
      for (int i = 0; i < n; ++i) {
        double fa = fp->dG[a * n + i] - fp->dg[a * n + i];
        double fb = b < k ? fp->dG[b * n + i] - fp->dg[b * n + i]
                          : fp->image[i] - fp->g[i];
        N[a][b] += fa * fb;
      }
    }
  int used = 0;
  double first[DEPTH];
  for (int a = 0; a < k; ++a) first[a] = N[a][a];
  for (int p = 0; p < k && N[p][p] > 0x1p-30 * first[p]; ++p, ++used)
    for (int a = p + 1; a < k; ++a) {
      double l = N[a][p] / N[p][p];
      for (int b = p; b <= k; ++b) N[a][b] -= l * N[p][b];
    }
  for (int a = 0; a < DEPTH; ++a) x[a] = 0.0;
  for (int a = used - 1; a >= 0; --a) {
    x[a] = N[a][k];
    for (int b = a + 1; b < used; ++b) x[a] -= N[a][b] * x[b];
    x[a] /= N[a][a];
  }
}

/* Next limit: g + step (G - g), mixed with the kept differences. */
static void next_limit(const fixed_point *fp, double step, int mixed,
                       double *g) {
  double x[DEPTH] = {0.0};
  int n = fp->n;
  if (mixed) mixing_weights(fp, x);
  for (int i = 0; i < n; ++i) {
    double to = fp->g[i] + step * (fp->image[i] - fp->g[i]);
    for (int a = 0; mixed && a < fp->kept; ++a) {
      double dF = fp->dG[a * n + i] - fp->dg[a * n + i];
      to -= x[a] * (fp->dg[a * n + i] + step * dF);
    }
    g[i] = to > 0.0 ? to : 0.0;
  }
}

/* One pass: the Tresca problem with limit g. */
typedef struct pass {
  const solver_ops *inner;
  const void *par;
  void *work;
  solver_control control;
} pass;

static status run_pass(const pass *p, const contact_problem *cp,
                       const double *g, double *u, double *r,
                       solver_report *rep) {
  contact_problem tresca = *cp;
  solver_report inner = {.outcome = RUNNING};
  tresca.g0 = g;
  tresca.B = NULL;
  status st =
      p->inner->solve(&tresca, p->par, p->work, &p->control, u, r, &inner);
  rep->iterations += inner.iterations;
  rep->outcome = inner.outcome;
  return st;
}

static double relative_change(const fixed_point *fp) {
  double change = 0.0, size = 0.0;
  for (int i = 0; i < fp->n; ++i) {
    double d = fabs(fp->image[i] - fp->g[i]);
    if (d > change) change = d;
    if (fp->image[i] > size) size = fp->image[i];
  }
  return size > 0.0 ? change / size : change > 0.0 ? 1.0 : 0.0;
}

static void tell(const solver_control *control, const solver_report *rep,
                 double change) {
  const solver_listener *l = control->listener;
  if (l == NULL || l->step == NULL) return;
  solver_step s = {.solver = "limit",
                   .iteration = rep->iterations,
                   .limit_update = rep->limit_updates,
                   .residual = rep->residual,
                   .limit_change = change,
                   .status_changes = -1};
  l->step(l->ctx, &s);
}

/* How the passes go on: length of the step, and the lowest residual so far. */
typedef struct course {
  double step, best;
  int mixed, failures;
} course;

/* Judge the pass just made; choose the limit of the next one into fp->g.
 * 0: no way on. */
static int advance(fixed_point *fp, course *c, double residual, double *rate) {
  size_t bytes = (size_t)fp->n * sizeof *fp->g;
  if (residual < c->best || c->best == HUGE_VAL) {
    double seen = 0.0;
    if (c->best < HUGE_VAL) seen = keep_difference(fp, fp->best_g, fp->best_G);
    if (seen > 0.0) *rate = seen;
    c->best = residual;
    memcpy(fp->best_g, fp->g, bytes);
    memcpy(fp->best_G, fp->image, bytes);
    c->mixed = 1;
    c->failures = 0;
  } else {
    double seen = keep_difference(fp, fp->best_g, fp->best_G);
    if (seen > 0.0) *rate = seen;
    memcpy(fp->g, fp->best_g, bytes);
    memcpy(fp->image, fp->best_G, bytes);
    if (c->failures >= 1) {
      c->step *= 0.5;
      fp->kept = 0;
    }
    c->mixed = c->failures++ == 0 && fp->kept > 1;
  }
  if (c->step < SHORTEST_STEP) return 0;
  next_limit(fp, c->step, c->mixed && fp->kept > 0, fp->g);
  return 1;
}

status fixed_point_solve(fixed_point *fp, const contact_problem *cp,
                         const solver_ops *inner, const void *par, void *work,
                         const solver_control *control, double *u, double *r,
                         solver_report *rep) {
  status st = OK;
  pass p = {inner, par, work, *control};
  course c = {1.0, HUGE_VAL, 0, 0};
  int passes = control->limit_max_iter > 0 ? control->limit_max_iter : PASSES;
  double change = 1.0;
  fp->kept = 0;
  *rep = (solver_report){.outcome = STOPPED_ITERATIONS};
  contact_limit(cp, r, fp->g);
  for (int k = 1; k <= passes; ++k) {
    rep->limit_updates = p.control.limit_update = k;
    p.control.tol = fmax(0.1 * control->tol, fmin(1e-3, 1e-2 * change));
    TRY(run_pass(&p, cp, fp->g, u, r, rep));
    if (rep->outcome == STOPPED_NAN || rep->outcome == STOPPED_RAY ||
        rep->outcome == STOPPED_SINGULAR)
      goto done;
    outcome inner_outcome = rep->outcome;
    contact_limit(cp, r, fp->image);
    rep->residual = contact_residual(cp, u, r);
    change = relative_change(fp);
    tell(control, rep, change);
    rep->outcome = CONVERGED;
    if (rep->residual <= control->tol) goto done;
    rep->outcome = inner_outcome < 0 ? inner_outcome : STOPPED_STAGNATION;
    if (!advance(fp, &c, rep->residual, &rep->rate)) goto done;
  }
  if (rep->outcome == STOPPED_STAGNATION) rep->outcome = STOPPED_ITERATIONS;
done:
  return st;
}
