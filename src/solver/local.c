/*
 * One node: the states open, stick and slip are computed in turn; the first
 * that satisfies its inequalities is the answer (local.h).
 */
#include "solver/local.h"

#include "base/memory.h"

#include <cblas.h>
#include <math.h>
#include <string.h>

enum { ROOT_STEPS = 100, DRIFT_SWEEPS = 20 };
static const double RIGID = 0x1p-5; /* -, of a drift: counts as no strain  */

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

/* ---- friction in the plane --------------------------------------------- */

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

/* ---- states ------------------------------------------------------------ */

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

/* ---- visits of the nodes
 * ---------------------------------------------------*/

struct node_blocks {
  double *K;          /* [dim*dim*n] stiffness of each node, N/m              */
  local_state *state; /* [n] state found at the last visit                    */
};

void node_blocks_free(node_blocks *b) {
  if (b == NULL) return;
  memory_free(b->K);
  memory_free(b->state);
  memory_free(b);
}

/* Inverse of a d*d block by elimination with complete symmetric pivoting left
 * out: the block is positive definite, else a share of "lift" is added to its
 * diagonal (the iteration then keeps its fixed point). */
static void invert_block(int d, const double *block, double lift, double *K) {
  double M[9];
  memcpy(M, block, (size_t)(d * d) * sizeof *M);
  for (int k = 0; k < d; ++k)
    if (!(M[k + d * k] > 0x1p-30 * lift)) M[k + d * k] += 0x1p-20 * lift;
  for (int k = 0; k < d; ++k) {
    double pivot = M[k + d * k];
    if (!(pivot > 0x1p-40 * lift)) pivot = 0x1p-20 * lift;
    M[k + d * k] = 1.0;
    for (int j = 0; j < d; ++j) M[k + d * j] /= pivot;
    for (int i = 0; i < d; ++i) {
      if (i == k) continue;
      double l = M[i + d * k];
      M[i + d * k] = 0.0;
      for (int j = 0; j < d; ++j) M[i + d * j] -= l * M[k + d * j];
    }
  }
  for (int i = 0; i < d; ++i)
    for (int j = 0; j < d; ++j)
      K[i + d * j] = 0.5 * (M[i + d * j] + M[j + d * i]);
}

status node_blocks_new(const contact_problem *cp, node_blocks **out) {
  status st = OK;
  node_blocks *b = NULL;
  const double *M = cp->A != NULL ? cp->A : cp->W;
  int d = cp->dim;
  NEW(b, 1);
  NEW(b->K, cp->n * d * d);
  NEW(b->state, cp->n);
  double lift = 0.0;
  for (size_t i = 0; i < (size_t)cp->m; ++i)
    lift = fmax(lift, M[i * (size_t)cp->m + i]);
  for (int node_id = 0; node_id < cp->n; ++node_id) {
    double block[9], *K = b->K + node_id * d * d;
    size_t first = (size_t)(node_id * d);
    for (int j = 0; j < d; ++j)
      for (int i = 0; i < d; ++i)
        block[i + d * j] =
            M[first + (size_t)i + (first + (size_t)j) * (size_t)cp->m];
    if (cp->A != NULL)
      memcpy(K, block, (size_t)(d * d) * sizeof *K);
    else
      invert_block(d, block, lift, K);
  }
  *out = b;
  b = NULL;
done:
  node_blocks_free(b);
  return st;
}

/* Where x = 0 of a node is: gap and stick position, m. */
static double origin(const contact_problem *cp, int node_id, int k) {
  if (k == 0) return cp->gap[node_id];
  return contact_stick(cp, node_id * cp->dim + k);
}

/* The problem of a node: unknowns not held, listed in id[]; x[] now. */
static void local_of(const relaxation *s, int node_id, local_problem *lp,
                     int *id, double *x) {
  const contact_problem *cp = s->cp;
  const double *K = s->blocks->K + node_id * cp->dim * cp->dim;
  int first = node_id * cp->dim;
  lp->dim = lp->bounded = 0;
  for (int k = 0; k < cp->dim; ++k) {
    if (contact_held(cp, first + k)) continue;
    double bound = HUGE_VAL;
    if (k > 0 && cp->side_gap != NULL)
      bound = cp->side_gap[node_id * (cp->dim - 1) + k - 1];
    id[lp->dim] = k;
    x[lp->dim] = s->u[first + k] - origin(cp, node_id, k);
    lp->bound[lp->dim] = k == 0 ? 0.0 : bound - origin(cp, node_id, k);
    if (bound < HUGE_VAL) lp->bounded = 1;
    ++lp->dim;
  }
  for (int i = 0; i < lp->dim; ++i) {
    lp->b[i] = -s->r[first + id[i]];
    for (int j = 0; j < lp->dim; ++j) {
      lp->K[i + lp->dim * j] = K[id[i] + cp->dim * id[j]];
      lp->b[i] += lp->K[i + lp->dim * j] * x[j];
    }
  }
  lp->g0 = cp->g0 == NULL ? 0.0 : cp->g0[node_id];
  lp->mu = 0.0;
  if (cp->B == NULL) return;
  for (int k = cp->B->start[node_id]; k < cp->B->start[node_id + 1]; ++k) {
    int j = cp->B->col[k];
    double p = -s->r[(size_t)j * (size_t)cp->dim];
    if (j == node_id)
      lp->mu = cp->B->val[k];
    else if (p > 0.0)
      lp->g0 += cp->B->val[k] * p;
  }
}

/* Go on past the solution x of the node by omega - 1 times the way from old,
 * if the state stayed and the kink of friction is not crossed. */
static void relax(const relaxation *s, const local_problem *lp, local_state now,
                  const double *old, double *x) {
  double further[3], dot = 0.0, more = s->omega - 1.0;
  int first = now == LOCAL_OPEN ? 0 : 1;
  if (lp->bounded || now == LOCAL_STICK) return;
  for (int k = 1; k < lp->dim; ++k) {
    further[k] = x[k] + more * (x[k] - old[k]);
    dot += further[k] * x[k];
  }
  if (first == 0) x[0] = fmin(0.0, x[0] + more * (x[0] - old[0]));
  if ((lp->g0 != 0.0 || lp->mu != 0.0) && !(dot > 0.0) &&
      !(now == LOCAL_OPEN && lp->g0 == 0.0))
    return;
  for (int k = 1; k < lp->dim; ++k) x[k] = further[k];
}

/* The same for the forces, back onto their cone. */
static void relax_forces(const relaxation *s, const local_problem *lp,
                         const double *old, double *r) {
  double size = 0.0, more = s->omega - 1.0;
  if (lp->bounded) return;
  r[0] = fmin(0.0, r[0] + more * (r[0] - old[0]));
  double g = fmax(0.0, lp->g0 - lp->mu * r[0]);
  for (int k = 1; k < lp->dim; ++k) {
    r[k] += more * (r[k] - old[k]);
    size += r[k] * r[k];
  }
  size = sqrt(size);
  for (int k = 1; k < lp->dim && size > g; ++k) r[k] *= g / size;
}

/* Step of the node's displacement, along the way found, m. */
static void displacement_step(const relaxation *s, int node_id,
                              const local_problem *lp, const int *id,
                              const double *way, double *step) {
  const contact_problem *cp = s->cp;
  size_t first = (size_t)(node_id * cp->dim), m = (size_t)cp->m;
  for (int k = 0; k < lp->dim; ++k) step[id[k]] = way[k];
  for (int k = 1; k < cp->dim; ++k) {
    size_t dof = first + (size_t)k;
    if (contact_held(cp, (int)dof)) step[k] = -s->r[dof] / cp->A[dof * m + dof];
  }
}

/* Solve the node; step[dim]: change of its displacement (of its force in
 * compliance form). */
static void node_step(relaxation *s, int node_id, double *step) {
  const contact_problem *cp = s->cp;
  local_problem lp;
  int id[3] = {0, 0, 0};
  double old[3], x[3], r[3];
  local_of(s, node_id, &lp, id, old);
  local_state before = s->blocks->state[node_id];
  local_state now = local_solve(&lp, before, x, r);
  s->blocks->state[node_id] = now;
  s->turned += now != before;
  if (cp->A != NULL) {
    if (now == before) relax(s, &lp, now, old, x);
    for (int k = 0; k < lp.dim; ++k) x[k] -= old[k];
    displacement_step(s, node_id, &lp, id, x, step);
    return;
  }
  double force[3] = {0.0, 0.0, 0.0};
  for (int k = 0; k < lp.dim; ++k) force[k] = s->r[node_id * cp->dim + id[k]];
  if (now == before) relax_forces(s, &lp, force, r);
  for (int k = 0; k < lp.dim; ++k) step[id[k]] = r[k] - force[k];
}

static void visit(relaxation *s, int node_id) {
  const contact_problem *cp = s->cp;
  const double *M = cp->A != NULL ? cp->A : cp->W;
  double *unknown = cp->A != NULL ? s->u : s->r, step[3] = {0.0, 0.0, 0.0};
  size_t first = (size_t)(node_id * cp->dim), m = (size_t)cp->m;
  int moved = 0;
  node_step(s, node_id, step);
  for (int k = 0; k < cp->dim; ++k) {
    double weight = M[(first + (size_t)k) * m + first + (size_t)k];
    moved = moved || step[k] != 0.0;
    unknown[first + (size_t)k] += step[k];
    s->change += weight * step[k] * step[k];
  }
  if (moved)
    cblas_dgemv(CblasColMajor, CblasNoTrans, cp->m, cp->dim, 1.0, M + first * m,
                cp->m, step, 1, 1.0, cp->A != NULL ? s->r : s->u, 1);
}

void relaxation_sweep(relaxation *s, int backward) {
  s->change = 0.0;
  s->turned = 0;
  for (int i = 0; i < s->cp->n; ++i) visit(s, backward ? s->cp->n - 1 - i : i);
}

int state_watch_returns(state_watch *w, const relaxation *s) {
  uint64_t hash = 14695981039346656037u; /* FNV-1a                            */
  int met = 0, kept = w->n < PATTERNS ? w->n : PATTERNS;
  for (int i = 0; i < s->cp->n; ++i)
    hash = (hash ^ (uint64_t)s->blocks->state[i]) * 1099511628211u;
  if (w->n > 0 && w->seen[(w->n - 1) % PATTERNS] == hash) return 0;
  for (int k = 0; k < kept; ++k) met = met || w->seen[k] == hash;
  w->seen[w->n++ % PATTERNS] = hash;
  return met;
}

void relaxation_refresh(const relaxation *s) {
  if (s->cp->A != NULL) {
    contact_reaction(s->cp, s->u, s->r);
    return;
  }
  contact_product(s->cp->m, s->cp->W, s->r, s->u);
  for (int i = 0; i < s->cp->m; ++i) s->u[i] += s->cp->f[i];
}

void relaxation_start(const relaxation *s) {
  const contact_problem *cp = s->cp;
  for (int i = 0; i < cp->n; ++i) {
    int first = i * cp->dim;
    double slip = 0.0;
    for (int k = 1; k < cp->dim; ++k)
      slip += fabs(s->u[first + k] - origin(cp, i, k));
    s->blocks->state[i] = s->u[first] < cp->gap[i] ? LOCAL_OPEN
                          : slip > 0.0             ? LOCAL_SLIP
                                                   : LOCAL_STICK;
  }
}

int relaxation_drifts(relaxation *s, double *from) {
  const contact_problem *cp = s->cp;
  size_t m = (size_t)cp->m;
  double *d = s->u, *Ad = s->r, work = 0.0, stiff = 0.0, left = 0.0;
  double most = 0.0;
  int falls = 0;
  if (!cp->floating || cp->A == NULL) return 0;
  memcpy(from, s->u, m * sizeof *from);
  s->omega = 1.0;
  for (int k = 0; k < DRIFT_SWEEPS; ++k) relaxation_sweep(s, 0);
  for (size_t i = 0; i < m; ++i) d[i] -= from[i];
  contact_product(cp->m, cp->A, d, Ad);
  for (size_t i = 0; i < m; ++i) {
    work += cp->f[i] * d[i];
    left = fmax(left, fabs(Ad[i]));
    stiff = fmax(stiff, cp->A[i * m + i] * fabs(d[i]));
    most = fmax(most, fabs(d[i]));
  }
  for (size_t i = 0; i < m; ++i) {
    double bound = contact_bound(cp, (int)i), room = bound - from[i] - d[i];
    if (bound < HUGE_VAL && d[i] > RIGID * most && room > RIGID * most)
      falls = 1;
  }
  return work > 0.0 && left < RIGID * stiff && !falls;
}
