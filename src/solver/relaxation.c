/*
 * Relaxation: nodes in turn, each solved with the others held (local.h).
 */
#include "base/number.h"
#include "solver/local.h"

enum { DRIFT_SWEEPS = 20 };
static const double RIGID = 0x1p-5;     /* -, of a drift: counts as no strain */
static const double SOFT = 0x1p-20;     /* -, of the stiffness: none */
static const double ROUNDING = 0x1p-46; /* -, of stiffness times distance */

struct node_blocks {
  double *K;          /* [dim*dim*n] stiffness of each node, N/m */
  local_state *state; /* [n] state found at the last visit */
  int plain; /* 1: forces are unknown, limits follow the node's own pressure */
  double *weight;          /* [m] diagonal of the matrix */
  double *step, *strained; /* [m] of a sweep, m; A times it, N */
};

/* Inverse of a d*d block by elimination without pivoting: the block is positive
 * definite, else a share of "lift" is added to its diagonal (the fixed point of
 * the iteration is unchanged). */
static void invert_block(int d, const double *block, double lift, double *K) {
  double M[9];
  COPY(M, block, d * d);
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

/* The block, increased where a motion of the body makes it singular: the fixed
 * point of the iteration is unchanged. */
static void lift_block(int d, const double *block, double lift, double *K) {
  double M[9], own = SOFT * lift;
  COPY(M, block, d * d);
  COPY(K, block, d * d);
  for (int k = 0; k < d; ++k) own = fmax(own, block[k + d * k]);
  for (int k = 0; k < d; ++k) {
    if (!(M[k + d * k] > 0x1p-40 * own)) {
      M[k + d * k] += SOFT * own;
      K[k + d * k] += SOFT * own;
    }
    for (int i = k + 1; i < d; ++i)
      for (int j = k + 1; j < d; ++j)
        M[i + d * j] -= M[i + d * k] * M[k + d * j] / M[k + d * k];
  }
}

status node_blocks_new(const contact_problem *cp, node_blocks **out) {
  int d = cp->dim;
  MAKES(node_blocks, b, out);
  PASS_NEW_REALS(cp->m, &b->weight, &b->step, &b->strained);
  PASS_NEW_ALL(OF(b->K, cp->n * d * d), OF(b->state, cp->n));
  double lift = 0.0;
  for (int i = 0; i < cp->m; ++i) {
    b->weight[i] = contact_diagonal(cp, i);
    lift = fmax(lift, b->weight[i]);
  }
  for (int node_id = 0; node_id < cp->n; ++node_id) {
    double block[9], *K = b->K + node_id * d * d;
    contact_block(cp, node_id, block);
    if (contact_has_stiffness(cp))
      lift_block(d, block, lift, K);
    else
      invert_block(d, block, lift, K);
  }
  return OK;
}

/* Where x = 0 of a node is: gap and stick position, m. */
static double origin(const contact_problem *cp, int node_id, int k) {
  if (k == 0) return cp->gap[node_id];
  return contact_stick(cp, node_id * cp->dim + k);
}

/* The problem of a node: unknowns not held, listed in id[]. */
static void local_of(const relaxation *s, int node_id, local_problem *lp,
                     int *id) {
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
    lp->at[lp->dim] = s->u[first + k] - origin(cp, node_id, k);
    lp->bound[lp->dim] = k == 0 ? 0.0 : bound - origin(cp, node_id, k);
    if (bound < HUGE_VAL) lp->bounded = 1;
    ++lp->dim;
  }
  for (int i = 0; i < lp->dim; ++i) {
    lp->b[i] = -s->r[first + id[i]];
    for (int j = 0; j < lp->dim; ++j)
      lp->K[i + lp->dim * j] = K[id[i] + cp->dim * id[j]];
  }
  lp->g0 = cp->g0 == NULL ? 0.0 : cp->g0[node_id];
  lp->mu = 0.0;
  if (cp->B == NULL) return;
  for (int k = cp->B->start[node_id]; k < cp->B->start[node_id + 1]; ++k) {
    int j = cp->B->col[k];
    double p = -s->r[(size_t)j * cp->dim];
    if (j == node_id)
      lp->mu = cp->B->val[k];
    else if (p > 0.0)
      lp->g0 += cp->B->val[k] * p;
  }
}

/* Over-relaxation by omega - 1 times the step d, if the state stayed and the
 * kink of friction is not crossed. */
static void relax(const relaxation *s, const local_problem *lp, local_state now,
                  double *d) {
  double dot = 0.0;
  if (lp->bounded || now == LOCAL_STICK) return;
  for (int k = 1; k < lp->dim; ++k)
    dot += (lp->at[k] + s->omega * d[k]) * (lp->at[k] + d[k]);
  if (now == LOCAL_OPEN) d[0] = fmin(-lp->at[0], s->omega * d[0]);
  if ((lp->g0 != 0.0 || lp->mu != 0.0) && !(dot > 0.0) &&
      !(now == LOCAL_OPEN && lp->g0 == 0.0))
    return;
  for (int k = 1; k < lp->dim; ++k) d[k] *= s->omega;
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

/* 1: an open node without force that stays so: nothing moves. */
static int rests(const relaxation *s, int node_id) {
  const contact_problem *cp = s->cp;
  const int first = node_id * cp->dim;
  if (contact_has_stiffness(cp) || s->blocks->state[node_id] != LOCAL_OPEN ||
      s->u[first] > cp->gap[node_id] || cp->side_gap != NULL)
    return 0;
  for (int k = 0; k < cp->dim; ++k)
    if (s->r[first + k] != 0.0) return 0;
  if (s->blocks->plain) return cp->g0 == NULL || cp->g0[node_id] <= 0.0;
  return contact_node_limit(cp, s->r, node_id) == 0.0;
}

/* Solve the node; step[dim]: change of its displacement (of its force in
 * compliance form). */
static void node_step(relaxation *s, int node_id, double *step) {
  const contact_problem *cp = s->cp;
  local_problem lp;
  int id[3] = {0, 0, 0};
  double d[3], r[3];
  local_of(s, node_id, &lp, id);
  local_state before = s->blocks->state[node_id];
  local_state now = local_solve(&lp, before, d, r);
  s->blocks->state[node_id] = now;
  s->turned += now != before;
  if (contact_has_stiffness(cp)) {
    if (now == before) relax(s, &lp, now, d);
    /* Step of the node's displacement, of the unknowns not held d[], m. */
    for (int k = 0; k < lp.dim; ++k) step[id[k]] = d[k];
    for (int k = 1; k < cp->dim; ++k) {
      const int dof = node_id * cp->dim + k;
      if (contact_held(cp, dof))
        step[k] = -s->r[dof] / contact_diagonal(cp, dof);
    }
    return;
  }
  double force[3] = {0.0, 0.0, 0.0};
  for (int k = 0; k < lp.dim; ++k) force[k] = s->r[node_id * cp->dim + id[k]];
  if (now == before) relax_forces(s, &lp, force, r);
  for (int k = 0; k < lp.dim; ++k) step[id[k]] = r[k] - force[k];
}

/* The same where the blocks are plain. */
static void plain_step(relaxation *s, int node_id, double *step) {
  const contact_problem *cp = s->cp;
  const int d = cp->dim, first = node_id * d;
  const double *r = s->r + first, *u = s->u + first;
  const double *K = s->blocks->K + first * d;
  const double *ut0 = cp->ut0 == NULL ? NULL : cp->ut0 + node_id * (d - 1) - 1;
  local_problem lp = {.dim = d};
  double to[3], force[3];
  for (int k = 0; k < d * d; ++k) lp.K[k] = K[k];
  for (int k = 0; k < d; ++k) {
    lp.b[k] = -r[k];
    lp.at[k] = k == 0 ? u[0] - cp->gap[node_id] : u[k] - (ut0 ? ut0[k] : 0.0);
  }
  lp.g0 = cp->g0 == NULL ? 0.0 : cp->g0[node_id];
  lp.mu = cp->B == NULL ? 0.0 : cp->B->val[node_id];
  local_state before = s->blocks->state[node_id];
  local_state now = local_solve(&lp, before, to, force);
  s->blocks->state[node_id] = now;
  s->turned += now != before;
  if (now == before) relax_forces(s, &lp, r, force);
  for (int k = 0; k < d; ++k) step[k] = force[k] - r[k];
}

static void visit(relaxation *s, int node_id) {
  const contact_problem *cp = s->cp;
  double *unknown = contact_has_stiffness(cp) ? s->u : s->r,
         step[3] = {0.0, 0.0, 0.0};
  int first = node_id * cp->dim, moved = 0;
  if (rests(s, node_id)) return;
  if (s->blocks->plain)
    plain_step(s, node_id, step);
  else
    node_step(s, node_id, step);
  for (int k = 0; k < cp->dim; ++k) {
    double weight = s->blocks->weight[first + k];
    moved = moved || step[k] != 0.0;
    unknown[first + k] += step[k];
    s->change += weight * step[k] * step[k];
  }
  if (moved)
    contact_add_columns(cp, node_id, step,
                        contact_has_stiffness(cp) ? s->r : s->u);
}

void relaxation_sweep(relaxation *s, int backward) {
  s->change = 0.0;
  s->turned = 0;
  for (int i = 0; i < s->cp->n; ++i) visit(s, backward ? s->cp->n - 1 - i : i);
}

int state_watch_returns(state_watch *w, const relaxation *s) {
  const uint64_t hash =
      number_hash(HASH_START, s->blocks->state,
                  (size_t)s->cp->n * sizeof *s->blocks->state);
  int met = 0, kept = w->n < PATTERNS ? w->n : PATTERNS;
  if (w->n > 0 && w->seen[(w->n - 1) % PATTERNS] == hash) return 0;
  for (int k = 0; k < kept; ++k) met = met || w->seen[k] == hash;
  w->seen[w->n++ % PATTERNS] = hash;
  return met;
}

void relaxation_refresh(const relaxation *s) {
  if (contact_has_stiffness(s->cp)) {
    contact_reaction(s->cp, s->u, s->r);
    return;
  }
  contact_apply(s->cp, s->r, s->u);
  for (int i = 0; i < s->cp->m; ++i) s->u[i] += s->cp->f[i];
}

/* 1: plain_step does. */
static int is_plain(const contact_problem *cp) {
  const sparse_rows *B = cp->B;
  if (cp->A != NULL || cp->held != NULL || cp->side_gap != NULL) return 0;
  for (int i = 0; i < cp->n && B != NULL; ++i)
    if (B->start[i + 1] != i + 1 || B->col[i] != i) return 0;
  return 1;
}

void relaxation_start(const relaxation *s) {
  const contact_problem *cp = s->cp;
  s->blocks->plain = is_plain(cp);
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

/* A body in a sweep, moved by its load only. */
typedef struct flight {
  double work;        /* of the load on the step, N m */
  double most;        /* largest step of an unknown, m */
  double stiff, left; /* forces of the steps alone, of the strain of all, N */
  double load, least; /* largest load; rounding of "left", N */
  double steps;       /* that lead to a bound, or to a stick position */
} flight;

static int is_of(const contact_problem *cp, int node_id, int body_id) {
  return cp->bodies == NULL || cp->bodies->of[node_id] == body_id;
}

static void add_unknown(const relaxation *s, int dof, const double *d,
                        flight *f) {
  const contact_problem *cp = s->cp;
  double k = contact_diagonal(cp, dof);
  f->work += cp->f[dof] * d[dof];
  f->most = fmax(f->most, fabs(d[dof]));
  f->stiff = fmax(f->stiff, k * fabs(d[dof]));
  f->left = fmax(f->left, fabs(s->blocks->strained[dof]));
  f->load = fmax(f->load, fabs(cp->f[dof]));
  f->least = fmax(f->least, ROUNDING * k * fabs(s->u[dof]));
}

/* Distance of a node to its bound or stick position over its step; HUGE_VAL:
 * the step leads to neither. */
static double steps_of(const relaxation *s, int node_id, const double *d,
                       double most) {
  const contact_problem *cp = s->cp;
  int first = node_id * cp->dim, last = first + cp->dim;
  double steps = HUGE_VAL, distance = 0.0, size = 0.0;
  for (int i = first; i < last; ++i) {
    double bound = contact_bound(cp, i);
    if (bound < HUGE_VAL && d[i] > RIGID * most)
      steps = fmin(steps, (bound - s->u[i]) / d[i]);
  }
  if (cp->ut0 == NULL || !(contact_node_limit(cp, s->r, node_id) > 0.0))
    return steps;
  for (int i = first + 1; i < last; ++i) {
    distance += d[i] * (contact_stick(cp, i) - s->u[i]);
    size += d[i] * d[i];
  }
  if (distance > 0.0 && sqrt(size) > RIGID * most)
    steps = fmin(steps, distance / size);
  return steps;
}

static flight flight_of(const relaxation *s, int body_id, const double *d) {
  const contact_problem *cp = s->cp;
  flight f = {.steps = HUGE_VAL};
  for (int i = 0; i < cp->n; ++i)
    for (int k = 0; k < cp->dim && is_of(cp, i, body_id); ++k)
      add_unknown(s, i * cp->dim + k, d, &f);
  for (int i = 0; i < cp->n; ++i)
    if (is_of(cp, i, body_id))
      f.steps = fmin(f.steps, steps_of(s, i, d, f.most));
  return f;
}

/* 0: it is not in free motion, 1: it waits, 2: it was moved. */
static int fly_body(const relaxation *s, int body_id, const double *d) {
  const contact_problem *cp = s->cp;
  flight f = flight_of(s, body_id, d);
  if (!(f.work > 0.0 && f.left < RIGID * f.stiff && f.steps < HUGE_VAL))
    return 0;
  if (f.steps * f.left > f.load && f.left > f.least) return 1;
  if (!(f.steps > 1.0)) return 0;
  for (int i = 0; i < cp->m; ++i)
    if (is_of(cp, i / cp->dim, body_id)) s->u[i] += f.steps * d[i];
  return 2;
}

int relaxation_fly(relaxation *s, const double *from) {
  const contact_problem *cp = s->cp;
  int bodies = cp->bodies == NULL ? 1 : cp->bodies->n, most = 0;
  double *d = s->blocks->step;
  if (!cp->floating || !contact_has_stiffness(cp) || s->turned > 0) return 0;
  for (int i = 0; i < cp->m; ++i) d[i] = s->u[i] - from[i];
  contact_product(cp->m, cp->A, d, s->blocks->strained);
  for (int b = 0; b < bodies; ++b) {
    int now = fly_body(s, b, d);
    most = now > most ? now : most;
  }
  if (most == 2) relaxation_refresh(s);
  return most;
}

/* 1: a body that contact alone holds drifts off: a few more sweeps make a rigid
 * motion on which the load does work and that leads to no obstacle. The iterate
 * is overwritten. from[m]: work. */
static int drifts(relaxation *s, double *from) {
  const contact_problem *cp = s->cp;
  size_t m = cp->m;
  double *d = s->u, *Ad = s->r, work = 0.0, left = 0.0, most = 0.0;
  int falls = 0;
  if (!cp->floating || !contact_has_stiffness(cp)) return 0;
  COPY(from, s->u, m);
  s->omega = 1.0;
  for (int k = 0; k < DRIFT_SWEEPS; ++k) relaxation_sweep(s, 0);
  for (size_t i = 0; i < m; ++i) d[i] -= from[i];
  contact_product(cp->m, cp->A, d, Ad);
  for (size_t i = 0; i < m; ++i) {
    work += cp->f[i] * d[i];
    left = fmax(left, fabs(Ad[i]));
    most = fmax(most, fabs(d[i]));
  }
  for (size_t i = 0; i < m; ++i) {
    double bound = contact_bound(cp, (int)i), rest = bound - from[i] - d[i];
    if (bound < HUGE_VAL && d[i] > RIGID * most && rest > RIGID * most)
      falls = 1;
  }
  return work > 0.0 && left < RIGID * contact_resistance(cp, d, RIGID) &&
         !falls;
}

void relaxation_end(relaxation *s, const best_iterate *best, double *work,
                    solver_report *rep) {
  int gave_up =
      rep->outcome == STOPPED_STAGNATION || rep->outcome == STOPPED_CYCLE;
  rep->residual = best->residual;
  if (gave_up && drifts(s, work)) rep->outcome = STOPPED_RAY;
  solver_take_best(best, s->cp->m, s->u, s->r);
}
