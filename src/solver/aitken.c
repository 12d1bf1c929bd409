/*
 * Gauss-Seidel sweeps over the nodes (local.h), accelerated (CPR98, 3.3).
 *
 * With G(x) the iterate after a sweep from x and F = G(x) - x its defect, the
 * next sweep starts from the combination
 *
 *   x+ = G_k - sum_j gamma_j (G_j+1 - G_j),
 *   gamma minimises |F_k - sum_j gamma_j (F_j+1 - F_j)|_D,
 *
 * D the diagonal of the matrix. With one difference, taken after plain sweeps,
 * it is Aitken's process in the vector form of Irons and Tuck (1969):
 *
 *   x+ = G_k - F_k (F_k . dF) / (dF . dF),   dF = F_k - F_k-1,
 *
 * which for one unknown is Aitken's delta-square formula; with DEPTH
 * differences and after every sweep it is Anderson's mixing (1965; Walker, Ni
 * 2011). The weights add up to one, so r = A u - f (or u = W r + q) is carried
 * along by the same combination without a product.
 *
 * A combination after which a sweep moves farther than before is rejected.
 */
#include "solver/local.h"

#include <cblas.h>

typedef enum { BY_AITKEN, BY_ANDERSON, BY_NOTHING } acceleration_kind;

typedef struct aitken {
  int acceleration; /* acceleration_kind */
} aitken;

OPTIONS(aitken_options, OPTION_CHOICE(aitken, acceleration, "ACCELERATION",
                                      "AITKEN|ANDERSON|NONE", "AITKEN",
                                      "how the sweeps are combined"));

enum {
  SWEEPS = 20000, /* default limit */
  DEPTH = 12,     /* differences of Anderson's mixing */
  PLAIN = 6,      /* sweeps from one step of Aitken to the next */
  REFRESH = 64,   /* sweeps from one product to the next */
  UNSEEN = 8,     /* sweeps of few products without a check of the residual */
  FIRST = 3,      /* of them that is checked */
  PATIENCE = 400, /* sweeps without a lower residual before a remedy */
  OFTEN = 20      /* one old pattern in so many sweeps is a cycle */
};
static const double FARTHER = 4.0;     /* -, growth of |F|^2 that is accepted */
static const double DEPENDENT = 1e-14; /* -, of |dF|^2: adds nothing */

typedef struct aitken_work {
  node_blocks *blocks;
  best_iterate best;
  double *before;            /* [m] x before the sweep */
  double *x, *y;             /* [m] G of the sweep before, and its Y */
  double *defect;            /* [m] F of the sweep before, then of this one */
  double *diagonal;          /* [m] of the matrix */
  double *dx, *dy, *df;      /* [m*depth] differences, a ring */
  double gram[DEPTH][DEPTH]; /* (dF_i . dF_j)_D by place in the ring */
} aitken_work;

static status aitken_setup(const contact_problem *cp, const void *par,
                           void *work) {
  aitken_work *w = work;
  const aitken *p = par;
  size_t m = cp->m;
  size_t depth = p->acceleration == BY_ANDERSON ? DEPTH : 1;
  PASS(node_blocks_new(cp, &w->blocks));
  PASS(best_iterate_new(cp->m, &w->best));
  PASS_NEW_REALS(m, &w->before, &w->x, &w->y, &w->defect, &w->diagonal);
  PASS_NEW_REALS(m * depth, &w->dx, &w->dy, &w->df);
  for (int i = 0; i < cp->m; ++i) w->diagonal[i] = contact_diagonal(cp, i);
  return OK;
}

/* A run: the sweeps and their stored data. */
typedef struct run {
  relaxation sweep;
  aitken_work *w;
  double *x, *y; /* unknown and what is carried: u and r, or r and u */
  int m, depth, period;
  int kept, newest; /* differences; place of the newest */
  int started;      /* w->x, w->y, w->defect are valid */
  int combined;     /* the sweep started from a combination */
  double moved;     /* |F|^2 of the sweep before */
  double mark;      /* residual at the last progress */
  int since, cures; /* sweeps since; remedies tried */
  int checked;      /* sweep of the last check of the residual */
  double per_move;  /* residual over the size of the sweep there */
  int circling;     /* of these sweeps those that left an old pattern */
  state_watch watch;
  int symmetric; /* every other sweep backward */
  int plain;     /* sweeps before the first that is combined */
} run;

/* ---- combination --------------------------------------------------------- */

static double weighted_dot(const run *s, const double *a, const double *b) {
  double sum = 0.0;
  for (int i = 0; i < s->m; ++i) sum += s->w->diagonal[i] * a[i] * b[i];
  return sum;
}

/* F into w->defect, the differences to the sweep before into the ring. */
static void keep(run *s) {
  aitken_work *w = s->w;
  int at = (s->newest + 1) % s->depth;
  size_t m = s->m, offset = m * at;
  double *dx = w->dx + offset, *dy = w->dy + offset, *df = w->df + offset;
  for (size_t i = 0; i < m; ++i) {
    double f = s->x[i] - w->before[i];
    dx[i] = s->x[i] - w->x[i];
    dy[i] = s->y[i] - w->y[i];
    df[i] = f - w->defect[i];
    w->x[i] = s->x[i];
    w->y[i] = s->y[i];
    w->defect[i] = f;
  }
  if (!s->started) {
    s->started = 1;
    return;
  }
  s->newest = at;
  if (s->kept < s->depth) ++s->kept;
  for (int j = 0; j < s->kept; ++j) {
    int other = (at + s->depth - j) % s->depth;
    w->gram[at][other] = w->gram[other][at] =
        weighted_dot(s, df, w->df + m * other);
  }
}

/* gamma[kept], newest first, by elimination; a difference that depends on the
 * newer ones is left out. */
static void weights(const run *s, double *gamma) {
  double N[DEPTH][DEPTH + 1], first[DEPTH];
  int n = s->kept, place[DEPTH];
  for (int a = 0; a < n; ++a) place[a] = (s->newest + s->depth - a) % s->depth;
  for (int a = 0; a < n; ++a) {
    for (int b = 0; b < n; ++b) N[a][b] = s->w->gram[place[a]][place[b]];
    N[a][n] = weighted_dot(s, s->w->df + (size_t)s->m * place[a], s->w->defect);
    first[a] = N[a][a];
  }
  for (int p = 0; p < n; ++p) {
    if (!(N[p][p] > DEPENDENT * first[p])) continue;
    for (int a = p + 1; a < n; ++a) {
      double l = N[a][p] / N[p][p];
      for (int b = p; b <= n; ++b) N[a][b] -= l * N[p][b];
    }
  }
  for (int a = n - 1; a >= 0; --a) {
    gamma[a] = 0.0;
    if (!(N[a][a] > DEPENDENT * first[a])) continue;
    gamma[a] = N[a][n];
    for (int b = a + 1; b < n; ++b) gamma[a] -= N[a][b] * gamma[b];
    gamma[a] /= N[a][a];
  }
}

static void combine(run *s) {
  double gamma[DEPTH];
  weights(s, gamma);
  for (int a = 0; a < s->kept; ++a) {
    size_t offset = (size_t)s->m * ((s->newest + s->depth - a) % s->depth);
    cblas_daxpy(s->m, -gamma[a], s->w->dx + offset, 1, s->x, 1);
    cblas_daxpy(s->m, -gamma[a], s->w->dy + offset, 1, s->y, 1);
  }
  s->combined = 1;
}

static void forget(run *s) { s->kept = s->started = s->combined = 0; }

/* After a sweep: start of the next one. */
static void accelerate(run *s, int k) {
  double moved = s->sweep.change;
  if (s->combined && !(moved <= FARTHER * s->moved)) {
    COPY(s->x, s->w->x, s->m);
    COPY(s->y, s->w->y, s->m);
    forget(s);
    return;
  }
  s->moved = moved;
  s->combined = 0;
  keep(s);
  if (s->kept > 0 && k % s->period == 0) combine(s);
}

/* ---- control ------------------------------------------------------------ */

/* No progress for long: alternate forward and backward sweeps, then shorter
 * steps. 0: no remedy left. */
static int cure(run *s) {
  static const double shorter[] = {1.0, 0.6, 0.3};
  forget(s);
  s->since = s->circling = 0;
  s->mark = HUGE_VAL;
  s->symmetric = 1;
  if (s->cures == (int)(sizeof shorter / sizeof *shorter)) return 0;
  s->sweep.omega = shorter[s->cures++];
  return 1;
}

/* A body in free motion to its obstacles is not extrapolated. */
static void steer(run *s, int k) {
  int flies = k % PLAIN == 0 ? relaxation_fly(&s->sweep, s->w->before) : 0;
  if (flies > 1) s->since = s->circling = 0;
  if (flies) {
    s->plain = s->depth > 1 ? k + REFRESH : k;
    forget(s);
  } else if (s->depth > 0 && k >= s->plain) {
    accelerate(s, k);
  }
}

/* 1: the residual is worked out: a sweep of sparse blocks costs less than that,
 * which is left out until the size of the sweeps promises an answer. */
static int is_checked(const run *s, int k, int limit, double tol) {
  const relaxation *z = &s->sweep;
  if (z->cp->blocks == NULL || k == limit || k - s->checked >= UNSEEN) return 1;
  if (s->checked == 0) return k == FIRST;
  return !(s->per_move * sqrt(z->change) > tol);
}

static outcome sweeps(run *s, const solver_control *control,
                      solver_report *rep) {
  relaxation *z = &s->sweep;
  int limit = control->max_iter > 0 ? control->max_iter : SWEEPS;
  double scale = contact_scale(z->cp);
  for (int k = 1; k <= limit; ++k) {
    rep->iterations = k;
    if (k % REFRESH == 1) relaxation_refresh(z);
    COPY(s->w->before, s->x, s->m);
    relaxation_sweep(z, s->symmetric && k % 2 == 0);
    ++s->since;
    if (!is_checked(s, k, limit, control->tol)) {
      s->circling += state_watch_returns(&s->watch, z);
      steer(s, k);
      continue;
    }
    double residual = contact_mismatch(z->cp, scale, z->u, z->r, NULL);
    s->checked = k;
    s->per_move = residual / sqrt(z->change);
    if (residual <= control->tol) {
      relaxation_refresh(z);
      residual = contact_mismatch(z->cp, scale, z->u, z->r, NULL);
    }
    solver_keep_best(&s->w->best, s->m, residual, z->u, z->r);
    int cycle = state_watch_returns(&s->watch, z);
    solver_report_states(control, "aitken", k, residual, z->turned, cycle);
    if (isnan(residual)) return STOPPED_NAN;
    if (residual <= control->tol) return CONVERGED;
    if (!solver_promises(control->promise, k, residual, control->tol))
      return STOPPED_ITERATIONS;
    s->circling += cycle;
    if (solver_progresses(&s->mark, residual)) s->since = s->circling = 0;
    int circles = OFTEN * s->circling > s->since;
    if (s->since > PATIENCE && !cure(s))
      return circles ? STOPPED_CYCLE : STOPPED_STAGNATION;
    steer(s, k);
  }
  return STOPPED_ITERATIONS;
}

static status aitken_solve(const contact_problem *cp, const void *par,
                           void *work, const solver_control *control, double *u,
                           double *r, solver_report *rep) {
  const aitken *p = par;
  aitken_work *w = work;
  int by_anderson = p->acceleration == BY_ANDERSON;
  run s = {
      .sweep = {.cp = cp, .blocks = w->blocks, .u = u, .r = r, .omega = 1.0},
      .w = w,
      .x = contact_has_stiffness(cp) ? u : r,
      .y = contact_has_stiffness(cp) ? r : u,
      .m = cp->m,
      .depth = by_anderson ? DEPTH : p->acceleration == BY_AITKEN,
      .period = by_anderson ? 1 : PLAIN,
      .plain = by_anderson && cp->floating ? REFRESH : 0,
      .mark = HUGE_VAL};
  *rep = (solver_report){.outcome = RUNNING};
  w->best.residual = HUGE_VAL;
  relaxation_start(&s.sweep);
  rep->outcome = sweeps(&s, control, rep);
  relaxation_end(&s.sweep, &w->best, w->before, rep);
  return OK;
}

const solver_ops aitken_solver = {
    SOLVER_OF(aitken), .family = "relaxation",
    .handles = SOLVES_TRESCA | SOLVES_COULOMB | SOLVES_3D | SOLVES_FLOATING |
               SPARSE_COMPLIANCE,
    .entries = "METHOD=AITKEN, which relaxes row by row,"};
