/* Fixed point on the sliding limit, with Anderson mixing (fixed_point.h). */
#include "solver/fixed_point.h"

#include "base/vector.h"

enum {
  MOST = 200000, /* iterations of all passes, by default */
  DEPTH = 4,     /* differences mixed */
  PASSES = 200,  /* default limit */
  PATIENCE = 30, /* passes without a lower residual */
  IDLE = 2       /* iterations of a pass without effect */
};
static const double FINEST = 0.1; /* -, of the tolerance: enough for a pass */
static const double COARSE = 0.9; /* -, of it: enough where passes stagnate */
static const double MIXING_RATE = 0.2;     /* -, slower: mix */
static const double RATE_MARGIN = 0x1p-24; /* -, of |g|: shorter differences
                                              are rounding */
static const double SHORTEST_STEP = 1.0 / 32.0; /* -, of G(g) - g */

struct fixed_point {
  int n, kept;             /* nodes; differences now stored */
  double *g, *image;       /* [n] limit of the pass and G(g), N */
  double *last_g, *last_G; /* [n] pass accepted last */
  double *dg, *dG;         /* [n*DEPTH] differences of passes, newest first */
};

status fixed_point_new(int n, fixed_point **out) {
  MAKES(fixed_point, fp, out);
  fp->n = n;
  PASS_NEW_REALS(n, &fp->g, &fp->image, &fp->last_g, &fp->last_G);
  PASS_NEW_ALL(OF(fp->dg, n * DEPTH), OF(fp->dG, n * DEPTH));
  return OK;
}

/* Shift the differences and put those of the last two passes in front; the
 * ratio of their lengths is the rate. */
static double keep_difference(fixed_point *fp, const double *g,
                              const double *image) {
  size_t n = fp->n;
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
 * stored differences (dependent ones are left out); x[DEPTH]. */
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

/* Next limit: g + step (G - g), mixed with the stored differences. */
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

/* The iterations left to the next pass; 0: no bound. Returns 0: none left. */
static int iterations_left(const solver_control *control,
                           const solver_report *rep, int *left) {
  *left = 0;
  if (control->max_iter <= 0) return rep->iterations < MOST;
  *left = control->max_iter - rep->iterations;
  return *left > 0;
}

/* One pass of the solver. */
typedef struct pass {
  const inner_solver *inner;
  solver_control control;
} pass;

static status run_pass(const pass *p, const contact_problem *cp, double *u,
                       double *r, solver_report *rep) {
  solver_report inner = {.outcome = RUNNING};
  status st = p->inner->ops->solve(cp, p->inner->par, p->inner->work,
                                   &p->control, u, r, &inner);
  rep->iterations += inner.iterations;
  rep->outcome = inner.outcome;
  rep->residual = inner.residual;
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

static void report_pass(const solver_control *control, const solver_report *rep,
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

/* State of the passes. */
typedef struct course {
  double step;      /* share of G(g) - g taken */
  double defect;    /* |G(g) - g| of the last accepted pass, N */
  double rate;      /* last one measured */
  double lowest;    /* residual at the last progress */
  int mixed;        /* the pass just made came from a mixed step */
  int grown, since; /* passes with a growing defect; since the last progress */
} course;

/* Accept the pass just made. */
static void accept(fixed_point *fp, course *c, double defect, int first) {
  double seen = first ? 0.0 : keep_difference(fp, fp->last_g, fp->last_G);
  if (seen > 0.0) c->rate = seen;
  c->defect = defect;
  COPY(fp->last_g, fp->g, fp->n);
  COPY(fp->last_G, fp->image, fp->n);
}

/* Check the pass just made; set the limit of the next one in fp->g. 0: no
 * further pass. */
static int advance(fixed_point *fp, course *c, double residual, int first) {
  double defect = 0.0;
  for (int i = 0; i < fp->n; ++i)
    defect += (fp->image[i] - fp->g[i]) * (fp->image[i] - fp->g[i]);
  defect = sqrt(defect);
  ++c->since;
  if (solver_progresses(&c->lowest, residual)) c->since = 0;
  if (c->since > PATIENCE) return 0;
  int grew = !first && !(defect < c->defect);
  if (c->mixed && grew) {
    COPY(fp->g, fp->last_g, fp->n);
    COPY(fp->image, fp->last_G, fp->n);
    fp->kept = 0;
    c->mixed = 0;
  } else {
    accept(fp, c, defect, first);
    c->grown = grew ? c->grown + 1 : 0;
    if (c->grown >= 3) {
      c->grown = 0;
      c->step = fmax(0.5 * c->step, SHORTEST_STEP);
    }
    c->mixed = fp->kept > 0 && !grew && c->rate > MIXING_RATE;
  }
  next_limit(fp, c->step, c->mixed, fp->g);
  return 1;
}

/* Limits of the first pass: those of the start. A body that contact alone holds
 * may be free without friction: if nothing pushes yet, more than any load can
 * overcome, so that the first pass finds the pressures of the body at stick. */
static void first_limit(const contact_problem *cp, const double *r, double *g) {
  double load = 0.0, most = 0.0;
  contact_limit(cp, r, g);
  for (int i = 0; i < cp->n; ++i) most = fmax(most, g[i]);
  if (!cp->floating || most > 0.0) return;
  for (int i = 0; i < cp->m; ++i) load += fabs(cp->f[i]);
  for (int i = 0; i < cp->n; ++i)
    for (int k = cp->B->start[i]; k < cp->B->start[i + 1]; ++k)
      g[i] += cp->B->val[k] > 0.0 ? load : 0.0;
}

status fixed_point_solve(fixed_point *fp, const contact_problem *cp,
                         const inner_solver *inner,
                         const solver_control *control, double *u, double *r,
                         solver_report *rep) {
  pass p = {inner, *control};
  course c = {.step = 1.0, .lowest = HUGE_VAL};
  contact_problem tresca = *cp;
  int passes = control->limit_max_iter > 0 ? control->limit_max_iter : PASSES;
  double change = 1.0, rounding = 0.0; /* lowest residual of a pass */
  int before = 0;
  fp->kept = 0;
  *rep = (solver_report){.outcome = STOPPED_ITERATIONS};
  first_limit(cp, r, fp->g);
  tresca.g0 = fp->g;
  tresca.B = NULL;
  for (int k = 1; k <= passes; ++k) {
    if (!iterations_left(control, rep, &p.control.max_iter)) {
      rep->outcome = STOPPED_ITERATIONS;
      return OK;
    }
    rep->limit_updates = p.control.limit_update = k;
    /* not finer than the accuracy of the limit; finer if the last pass had no
     * effect */
    int idle = rep->iterations - before <= IDLE;
    double wanted = fmin(1e-2 * change, idle ? 0.1 * c.lowest : HUGE_VAL);
    before = rep->iterations;
    wanted = fmax(wanted, fmin(rounding, COARSE * control->tol));
    p.control.tol = fmax(FINEST * control->tol, fmin(1e-3, wanted));
    PASS(run_pass(&p, &tresca, u, r, rep));
    if (rep->outcome == STOPPED_STAGNATION)
      rounding = fmax(rounding, 2.0 * rep->residual);
    if (rep->outcome == STOPPED_NAN || rep->outcome == STOPPED_RAY ||
        rep->outcome == STOPPED_SINGULAR)
      return OK;
    outcome inner_outcome = rep->outcome;
    contact_limit(cp, r, fp->image);
    rep->residual = contact_residual(cp, u, r);
    change = relative_change(fp);
    report_pass(control, rep, change);
    rep->outcome = CONVERGED;
    if (rep->residual <= control->tol) return OK;
    rep->outcome = inner_outcome < 0 ? inner_outcome : STOPPED_STAGNATION;
    int on = advance(fp, &c, rep->residual, k == 1);
    rep->rate = c.rate;
    if (!on) return OK;
  }
  if (rep->outcome == STOPPED_STAGNATION) rep->outcome = STOPPED_ITERATIONS;
  return OK;
}

/* ---- friction path ----------------------------------------------------- */

enum { STAGES = 200 };
static const double FIRST_MU = 0.25;      /* -, largest mu of the first share */
static const double GROWTH = 2.0;         /* -, of the share per stage */
static const double LEAST_GROWTH = 1.004; /* - */

struct friction_path {
  double *g0, *val;        /* [n], [entries of B] with the share */
  double *good_u, *good_r; /* [m] of the last share solved */
};

status friction_path_new(const contact_problem *cp, friction_path **out) {
  MAKES(friction_path, path, out);
  PASS_NEW_ALL(OF(path->g0, cp->n),
               OF(path->val, cp->B != NULL ? cp->B->start[cp->n] : 0),
               OF(path->good_u, cp->m), OF(path->good_r, cp->m));
  return OK;
}

/* One stage: the problem with that share of the limit. */
static status solve_share(friction_path *path, const pass *p,
                          const contact_problem *cp, double share, double *u,
                          double *r, solver_report *rep) {
  contact_problem less = *cp;
  sparse_rows B = *cp->B;
  for (int i = 0; i < cp->n; ++i) path->g0[i] = share * cp->g0[i];
  for (int k = 0; k < B.start[cp->n]; ++k) path->val[k] = share * cp->B->val[k];
  B.val = path->val;
  less.g0 = path->g0;
  less.B = &B;
  return run_pass(p, share < 1.0 ? &less : cp, u, r, rep);
}

status friction_path_solve(friction_path *path, const contact_problem *cp,
                           const inner_solver *inner,
                           const solver_control *control, double *u, double *r,
                           solver_report *rep) {
  pass p = {inner, *control};
  double mu = largest_row_sum(cp->B, cp->n), growth = GROWTH, good = 0.0;
  double share = mu > FIRST_MU ? FIRST_MU / mu : 1.0;
  *rep = (solver_report){.outcome = STOPPED_ITERATIONS};
  for (int k = 1; k <= STAGES; ++k) {
    if (!iterations_left(control, rep, &p.control.max_iter)) {
      rep->outcome = STOPPED_ITERATIONS;
      return OK;
    }
    p.control.no_restart = good > 0.0;
    p.control.limit_update = k;
    PASS(solve_share(path, &p, cp, share, u, r, rep));
    if (rep->outcome == CONVERGED) {
      if (share == 1.0) return OK;
      COPY(path->good_u, u, cp->m);
      COPY(path->good_r, r, cp->m);
      good = share;
      growth = fmin(GROWTH, growth * growth);
    } else {
      if (good == 0.0) return OK;
      growth = sqrt(growth);
      COPY(u, path->good_u, cp->m);
      COPY(r, path->good_r, cp->m);
      if (growth < LEAST_GROWTH) return OK;
    }
    share = fmin(1.0, good * growth);
  }
  return OK;
}
