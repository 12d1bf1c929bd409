/*
 * All solutions of a small plane problem: each node is open, sticks, or slides
 * in either direction (with a limit that does not need pressure, the last three
 * when open too), and each of the 4^n or 6^n combinations is one linear system
 * in the displacements that are free,
 *   open   rho_n = 0                            rho = A u - f
 *   free   rho_t = 0                            no friction
 *   slip   rho_t - s B rho_n + s g0 = 0         s = +1, -1 along the slip
 * followed depth first, so that the elimination of a node is shared by all that
 * follow it. States that satisfy the inequalities are solved again with
 * pivoting and checked by contact_residual. A singular system that has
 * solutions has a line of them, bounded by the inequalities: its ends are
 * reported as joined.
 */
#include "accuracy/accuracy.h"
#include "accuracy/solutions.h"

#include <lapacke.h>

enum {
  ROWS = 2 * ENUMERATED_NODES,
  LENGTH = ROWS + 1,
  SVD_WORK = 16 * ROWS,
  LABELS = 6,
  PATTERNS = 1 << 21 /* a few seconds */
};
static const double WEAK = 1e-7;      /* -, of a row: elimination not trusted */
static const double SINGULAR = 1e-11; /* -, of the stiffness: singular value */
static const double MARGIN = 1e-7;    /* -, of the scale: signs */

static const double LEVEL = 1e-9; /* -, of the stiffness: does not change */

/* Of a node: its normal, its tangent (FREE: no friction). */
typedef enum { FREE, STICK, AHEAD, BACK } tangent;
typedef struct label {
  int open;
  tangent t;
} label;

typedef struct search {
  const contact_problem *cp;
  double tol, force; /* -; scale, N */
  solution_set *out;
  double base[ROWS], rho0[ROWS]; /* u and rho without free unknowns */
  label now[ENUMERATED_NODES];
  /* Rows eliminated so far, right side last, and their pivots. */
  int n_row, weak;
  int column[ROWS];
  double row[ROWS][LENGTH];
} search;

static double sign_of(label l) { return l.t == AHEAD ? 1.0 : -1.0; }

static int slides(label l) { return l.t == AHEAD || l.t == BACK; }

static double stiffness(const search *s, int i, int j) {
  return s->cp->A[i + s->cp->m * j];
}

static double largest_stiffness(const search *s) {
  double most = 0.0;
  for (int i = 0; i < s->cp->m; ++i) most = fmax(most, stiffness(s, i, i));
  return most;
}

/* ---- one linear system -------------------------------------------------- */

/* The equation of unknown dof under the label of its node: y[m+1]. */
static void equation(const search *s, int dof, double *y) {
  const contact_problem *cp = s->cp;
  int m = cp->m, i = dof / 2;
  label l = s->now[i];
  for (int j = 0; j < m; ++j) y[j] = stiffness(s, dof, j);
  y[m] = -s->rho0[dof];
  if (dof % 2 == 0 || !slides(l)) return;
  double sign = sign_of(l);
  y[m] -= sign * cp->g0[i];
  if (cp->B == NULL) return;
  for (int k = cp->B->start[i]; k < cp->B->start[i + 1]; ++k) {
    int normal = 2 * cp->B->col[k];
    double mu = sign * cp->B->val[k];
    for (int j = 0; j < m; ++j) y[j] -= mu * stiffness(s, normal, j);
    y[m] += mu * s->rho0[normal];
  }
}

/* 1: the label leaves the unknown free. */
static int moves(const search *s, int dof) {
  label l = s->now[dof / 2];
  if (dof % 2 == 0) return l.open;
  return l.t != STICK && !contact_held(s->cp, dof);
}

/* Free unknowns of the whole pattern. */
static int free_unknowns(const search *s, int *dof) {
  int n = 0;
  for (int i = 0; i < s->cp->m; ++i)
    if (moves(s, i)) dof[n++] = i;
  return n;
}

/* ---- signs -------------------------------------------------------------- */

/* rho[m] = A x, plus rho0 times "given". */
static void forces(const search *s, const double *x, double given,
                   double *rho) {
  for (int i = 0; i < s->cp->m; ++i) rho[i] = given * s->rho0[i];
  for (int j = 0; j < s->cp->m; ++j)
    for (int i = 0; x[j] != 0.0 && i < s->cp->m; ++i)
      rho[i] += stiffness(s, i, j) * x[j];
}

/* g of the forces without the sign of the pressure; g0 times "given". */
static double linear_limit(const search *s, const double *rho, double given,
                           int i) {
  const sparse_rows *B = s->cp->B;
  double g = given * s->cp->g0[i];
  for (int k = row_begin(B, i); k < row_end(B, i); ++k)
    g -= B->val[k] * rho[2 * B->col[k]];
  return g;
}

enum { CONDITIONS = 2 };
/* The inequalities at node i, <= 0, N; linear in (x, given). */
static void conditions(const search *s, int i, const double *x,
                       const double *rho, double given, double *c) {
  label l = s->now[i];
  c[0] = l.open ? stiffness(s, 2 * i, 2 * i) * x[2 * i] : rho[2 * i];
  c[1] = c[0];
  if (slides(l))
    c[1] = -sign_of(l) * stiffness(s, 2 * i + 1, 2 * i + 1) * x[2 * i + 1];
  if (l.t != STICK) return;
  double g = linear_limit(s, rho, given, i);
  c[0] = fmax(c[0], rho[2 * i + 1] - g);
  c[1] = fmax(c[1], -rho[2 * i + 1] - g);
}

static int signs_hold(const search *s, const double *x) {
  double rho[ROWS], c[CONDITIONS], margin = MARGIN * s->force;
  for (int i = 0; i < s->cp->n; ++i)
    if (s->now[i].open && stiffness(s, 2 * i, 2 * i) * x[2 * i] > margin)
      return 0;
  forces(s, x, 1.0, rho);
  for (int i = 0; i < s->cp->n; ++i) {
    conditions(s, i, x, rho, 1.0, c);
    if (c[0] > margin || c[1] > margin) return 0;
  }
  return 1;
}

/* ---- solutions ---------------------------------------------------------- */

/* u and r of x, with the conditions of the labels enforced exactly. */
static void state_of(const search *s, const double *x, double *u, double *r) {
  for (int i = 0; i < s->cp->m; ++i) u[i] = s->base[i] + x[i];
  forces(s, x, 1.0, r);
  for (int i = 0; i < s->cp->n; ++i) {
    r[2 * i] = s->now[i].open ? 0.0 : fmin(r[2 * i], 0.0);
    if (s->now[i].t == FREE) r[2 * i + 1] = 0.0;
  }
  for (int i = 0; i < s->cp->n; ++i)
    if (slides(s->now[i]))
      r[2 * i + 1] = -sign_of(s->now[i]) * contact_node_limit(s->cp, r, i);
}

static status take(search *s, const double *x, int *no) {
  double u[ROWS], r[ROWS];
  state_of(s, x, u, r);
  return solution_set_add(s->cp, s->tol, u, r, s->out, no);
}

/* One condition at + a by <= 0 on the line, N. */
typedef struct linear_condition {
  double at, by;
} linear_condition;

/* The conditions of node i on the line x + a v; their number. */
static int line_conditions(const search *s, int i, const double *x,
                           const double *rho, const double *v,
                           const double *turn, linear_condition *c) {
  label l = s->now[i];
  int n = 0, t = 2 * i + 1;
  double K = stiffness(s, t - 1, t - 1);
  c[n++] = l.open ? (linear_condition){K * x[t - 1], K * v[t - 1]}
                  : (linear_condition){rho[t - 1], turn[t - 1]};
  if (slides(l)) {
    K = -sign_of(l) * stiffness(s, t, t);
    c[n++] = (linear_condition){K * x[t], K * v[t]};
  }
  if (l.t != STICK) return n;
  double g = linear_limit(s, rho, 1.0, i), dg = linear_limit(s, turn, 0.0, i);
  c[n++] = (linear_condition){rho[t] - g, turn[t] - dg};
  c[n++] = (linear_condition){-rho[t] - g, -turn[t] - dg};
  return n;
}

/* Part of the line x + a v on which the signs hold: [low, high]. */
static void cut_line(const search *s, const double *x, const double *v,
                     double *low, double *high) {
  double rho[ROWS], turn[ROWS], level = LEVEL * largest_stiffness(s);
  linear_condition c[4];
  *low = -HUGE_VAL;
  *high = HUGE_VAL;
  forces(s, x, 1.0, rho);
  forces(s, v, 0.0, turn);
  for (int i = 0; i < s->cp->n; ++i) {
    int n = line_conditions(s, i, x, rho, v, turn, c);
    for (int k = 0; k < n; ++k) {
      if (c[k].by > level) *high = fmin(*high, -c[k].at / c[k].by);
      if (c[k].by < -level) *low = fmax(*low, -c[k].at / c[k].by);
      if (fabs(c[k].by) <= level && c[k].at > MARGIN * s->force)
        *low = HUGE_VAL;
    }
  }
}

/* The ends of a line of solutions. */
static status take_line(search *s, const double *x, const double *v) {
  double low, high, y[ROWS];
  int first = 0, second = 0;
  cut_line(s, x, v, &low, &high);
  if (!(low <= high)) return OK;
  if (!(low > -HUGE_VAL && high < HUGE_VAL)) {
    ++s->out->n_undecided;
    return OK;
  }
  for (int i = 0; i < s->cp->m; ++i) y[i] = x[i] + low * v[i];
  PASS(take(s, y, &first));
  for (int i = 0; i < s->cp->m; ++i) y[i] = x[i] + high * v[i];
  PASS(take(s, y, &second));
  if (first == second || first == 0 || second == 0) return OK;
  int later = first > second ? first : second;
  s->out->found[later - 1].facts.joined = first + second - later;
  return OK;
}

/* Singular values of K[n*n] (destroyed), rank by a scale of K; x: least squares
 * of K x = b, v: last right vector; *rest: part of b outside the range. */
static int decompose(int n, double *K, const double *b, double scale, double *x,
                     double *v, double *rest) {
  double S[ROWS], U[ROWS * ROWS], V[ROWS * ROWS], work[SVD_WORK];
  int rank = 0;
  if (LAPACKE_dgesvd_work(LAPACK_COL_MAJOR, 'A', 'A', n, n, K, n, S, U, n, V, n,
                          work, SVD_WORK) != 0)
    return -1;
  while (rank < n && S[rank] > SINGULAR * scale) ++rank;
  *rest = 0.0;
  for (int j = 0; j < n; ++j) x[j] = 0.0;
  for (int k = 0; k < n; ++k) {
    double along = 0.0;
    for (int i = 0; i < n; ++i) along += U[i + n * k] * b[i];
    if (k >= rank) *rest = fmax(*rest, fabs(along));
    for (int j = 0; k < rank && j < n; ++j) x[j] += along / S[k] * V[k + n * j];
  }
  for (int j = 0; j < n; ++j) v[j] = V[n - 1 + n * j];
  return rank;
}

/* The whole system again, with pivoting. */
static status solve_again(search *s) {
  int dof[ROWS], n = free_unknowns(s, dof), no;
  double K[ROWS * ROWS], y[LENGTH], b[ROWS], xf[ROWS], vf[ROWS];
  double x[ROWS] = {0.0}, v[ROWS] = {0.0}, rest = 0.0;
  for (int i = 0; i < n; ++i) {
    equation(s, dof[i], y);
    for (int j = 0; j < n; ++j) K[i + n * j] = y[dof[j]];
    b[i] = y[s->cp->m];
  }
  int rank =
      n > 0 ? decompose(n, K, b, largest_stiffness(s), xf, vf, &rest) : 0;
  if (rank < 0 || rest > MARGIN * s->force) return OK;
  for (int i = 0; i < n; ++i) x[dof[i]] = xf[i];
  for (int i = 0; i < n; ++i) v[dof[i]] = vf[i];
  if (rank == n && signs_hold(s, x)) PASS(take(s, x, &no));
  if (rank == n - 1) PASS(take_line(s, x, v));
  if (rank < n - 1) ++s->out->n_undecided;
  return OK;
}

/* ---- depth first -------------------------------------------------------- */

/* One more row, eliminated; 1: its pivot is not trusted. */
static int add_row(search *s, int dof) {
  double *y = s->row[s->n_row];
  int m = s->cp->m;
  equation(s, dof, y);
  const double largest = largest_entry(m, y);
  for (int q = 0; q < s->n_row; ++q) {
    const double *old = s->row[q];
    double pivot = old[s->column[q]];
    double factor = pivot != 0.0 ? y[s->column[q]] / pivot : 0.0;
    if (factor == 0.0) continue;
    for (int j = 0; j <= m; ++j) y[j] -= factor * old[j];
    y[s->column[q]] = 0.0;
  }
  s->column[s->n_row++] = dof;
  return !(fabs(y[dof]) > WEAK * largest);
}

static status leaf(search *s) {
  double x[ROWS];
  ++s->out->n_pattern;
  if (s->weak > 0) return solve_again(s);
  CLEAR(x, s->cp->m);
  for (int q = s->n_row - 1; q >= 0; --q) {
    double sum = s->row[q][s->cp->m];
    for (int p = q + 1; p < s->n_row; ++p)
      sum -= s->row[q][s->column[p]] * x[s->column[p]];
    x[s->column[q]] = sum / s->row[q][s->column[q]];
  }
  return signs_hold(s, x) ? solve_again(s) : OK;
}

/* 1: the limit of a node can be above zero without pressure on it. */
static int rubs_open(const contact_problem *cp, int i) {
  if (cp->g0[i] > 0.0) return 1;
  for (int k = row_begin(cp->B, i); k < row_end(cp->B, i); ++k)
    if (cp->B->col[k] != i && cp->B->val[k] > 0.0) return 1;
  return 0;
}

/* The labels of node i; their number. */
static int labels_of(const contact_problem *cp, int i, label *list) {
  int n = 0;
  if (!accuracy_rubs(cp, 2 * i + 1)) {
    list[n++] = (label){1, FREE};
    list[n++] = (label){0, FREE};
    return n;
  }
  if (!rubs_open(cp, i)) list[n++] = (label){1, FREE};
  for (int open = 0; open <= rubs_open(cp, i); ++open)
    for (int t = STICK; t <= BACK; ++t) list[n++] = (label){open, (tangent)t};
  return n;
}

static status descend(search *s, int i) {
  label list[LABELS];
  if (i == s->cp->n) return leaf(s);
  int n = labels_of(s->cp, i, list);
  for (int k = 0; k < n; ++k) {
    int rows = s->n_row, weak = s->weak;
    s->now[i] = list[k];
    for (int dof = 2 * i; dof < 2 * i + 2; ++dof)
      if (moves(s, dof)) s->weak += add_row(s, dof);
    PASS(descend(s, i + 1));
    s->n_row = rows;
    s->weak = weak;
  }
  return OK;
}

status solutions_can_try(int dim, int n, int corner) {
  if (dim != 2 || n > ENUMERATED_NODES)
    RAISE(ERR_DECK,
          "all statuses can be tried for up to %d contact nodes in 2-D, the "
          "problem has %d in %d-D",
          ENUMERATED_NODES, n, dim);
  if (corner)
    RAISE(ERR_DECK,
          "all statuses cannot be tried where a contact node "
          "touches two obstacles");
  return OK;
}

/* 1: a node touches a second obstacle. */
static int has_corner(const contact_problem *cp) {
  for (int dof = 1; dof < cp->m && cp->dim == 2; dof += 2)
    if (contact_bound(cp, dof) < HUGE_VAL) return 1;
  return 0;
}

static status check_size(const contact_problem *cp) {
  PASS(solutions_can_try(cp->dim, cp->n, has_corner(cp)));
  if (!contact_has_stiffness(cp))
    RAISE(ERR_DECK,
          "all statuses can be tried where the stiffness is known; "
          "of this problem only the compliance is");
  double patterns = 1.0;
  label list[LABELS];
  for (int i = 0; i < cp->n; ++i) patterns *= labels_of(cp, i, list);
  if (patterns > PATTERNS)
    RAISE(ERR_DECK,
          "%.0f combinations of statuses are too many: the limit of friction "
          "needs no pressure here, and the statuses of open nodes count too",
          patterns);
  return OK;
}

status solutions_by_statuses(const contact_problem *cp, double tol,
                             const double *u, const double *r,
                             solution_set *out) {
  int no;
  PASS(check_size(cp));
  OWNED_NEW(search, s, 1);
  s->cp = cp;
  s->tol = tol;
  s->force = contact_scale(cp);
  s->out = out;
  for (int dof = 0; dof < cp->m; ++dof) {
    double stick = cp->ut0 != NULL ? cp->ut0[dof / 2] : 0.0;
    s->base[dof] = dof % 2 == 0 ? cp->gap[dof / 2] : stick;
    if (contact_held(s->cp, dof))
      s->base[dof] = cp->f[dof] / stiffness(s, dof, dof);
  }
  contact_reaction(cp, s->base, s->rho0);
  PASS(solution_set_add(cp, tol, u, r, out, &no));
  if (no > 0) out->found[no - 1].facts.patterns = 0;
  return descend(s, 0);
}
