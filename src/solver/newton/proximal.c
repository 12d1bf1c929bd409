/*
 * Proximal point iteration on the forces of contact, for a compliance that may
 * be semidefinite or unsymmetric (Rockafellar 1976; Alart, Curnier 1991). With
 * x = W r + q - o the displacement from the gap or stick position, D the
 * inverse diagonal of W, c the centre of the pass and a its share,
 *
 *   z = r - s (D x + a (r - c)),
 *   F_n = r_n - min(z_n, 0),      F_t = r_t - P_g(z_t),   g = g0 + B p,
 *
 * P_g the projection on the disc |.| <= g. A pass finds r with F = 0
 * approximately, by Newton's method with the exact derivative; r is the next
 * centre. At r = c F does not depend on a, and F = 0 is the contact problem.
 * The share makes the problem regular where forces are not unique or W is
 * unsymmetric; it falls while passes converge in few steps and rises otherwise,
 * and stays above the one that was hard lately.
 * A step may raise |F| above its last value but not above the largest of the
 * last ones. Where passes converge slowly, with a steady drift of forces in
 * equilibrium with one another, the centre is extrapolated along the last
 * change of r (Guler 1992). The stretch s > 0 affects the convergence, not the
 * solutions.
 *
 * Of an operator u is moved along with r = A u - f, and the step is that of
 * NEWTON (system.h) with stiffness added where a force acts: with dr = A du,
 * inv(W) = A, e = z_t/|z_t|, P = I - e e' and t = g/|z_t|,
 *
 *   no force      (A du)_i = -F_i
 *   push, stick   (A du)_i + D/a du_i = -F_i/(s a)
 *   slip          (A du)_t + t s D/q P du_t + e B (A du)_n = -F_t + (1 - 1/q)
 *                 P F_t,                          q = 1 - (1 - s a) t.
 *
 * A body that contact alone holds needs no compliance so.
 */
#include "solver/newton/system.h"

#include <cblas.h>

static const option proximal_options[] = {OPTION_END};

enum {
  STEPS = 7200,   /* Newton steps, all trials */
  TRIAL = 1800,   /* of a trial */
  TRIALS = 4,     /* one after the other */
  PASS = 40,      /* of a pass */
  EASY = 5,       /* a pass with so few: the share falls */
  HARD = 15,      /* with more: it rises */
  PATIENCE = 100, /* passes without a lower residual */
  MEMORY = 8,     /* last values a step is compared with */
  HALVINGS = 10   /* of a step */
};
static const double PASS_GAIN =
    0x1p-2; /* |F|^2 after a pass, over that before, - */
static const double SLOPE = 0x1p-12; /* of the descent required, - */
static const double CREEP = 0.75;    /* residual after a pass, - */
static const double FORGET = 0.9;    /* of the share that was hard, a pass */
static const double LEAST_SHARE = 0x1p-40; /* - */
static const double MOST_SHARE = 0x1p10;

/* Settings of the trials: stretch s, share a at the start. The last starts with
 * all gaps closed (start_closed; its stretch is 1). */
static const struct {
  double stretch, share;
} settings[TRIALS] = {
    {1.0, 0x1p-7}, {4.0, 0x1p-7}, {4.0, 0x1p-10}, {1.0, 0x1p-20}};

typedef struct proximal_work {
  force_set *set;
  best_iterate best;
  step_matrix *J;
  unsigned char *acts;       /* [m] 1: a row of J not of the unit matrix */
  double *x, *F, *d, *z;     /* [m] */
  double *weight;            /* [m] of F, m/N */
  double *start, *centre;    /* [m] force at the start; of the pass */
  double *before;            /* [m] end of the last pass */
  struct {                   /* of an operator */
    operated_system *system; /* NULL: J */
    pattern guess;           /* nodes that slip; pressures */
    double *hold, *b;        /* [m] N/m, N */
    double *du;              /* [m] m, with d */
    double *start, *centre, *before; /* [m] displacements of those forces */
  } by;
} proximal_work;

/* Workspace of the steps of an operator. */
static status new_steps(const contact_problem *cp, proximal_work *w) {
  const size_t m = cp->m;
  PASS(operated_system_new(cp, &w->by.system));
  PASS(pattern_new(cp->dim, cp->n, &w->by.guess));
  PASS_NEW_REALS(m, &w->by.hold, &w->by.b, &w->by.du, &w->by.start,
                 &w->by.centre, &w->by.before);
  return OK;
}

static status proximal_setup(const contact_problem *cp, const void *par,
                             void *work) {
  proximal_work *w = work;
  size_t m = cp->m;
  PASS(force_set_new(cp, &w->set));
  PASS(best_iterate_new(cp->m, &w->best));
  if (cp->op != NULL)
    PASS(new_steps(cp, w));
  else
    PASS(step_matrix_new(cp, w->set, &w->J));
  PASS_NEW_ALL(OF(w->x, m), OF(w->F, m), OF(w->d, m), OF(w->z, m),
               OF(w->weight, m), OF(w->start, m), OF(w->centre, m),
               OF(w->before, m), OF(w->acts, m));
  return OK;
}

typedef struct run {
  const contact_problem *cp;
  proximal_work *w;
  const solver_control *control;
  double *u, *r;
  double scale;          /* contact_scale */
  double stretch, share; /* s and a */
  double hard;           /* the share with which a pass was hard lately */
  int steps;
} run;

/* ---- the equations ------------------------------------------------------- */

/* inv(D); friction counts in the pressures that its limit takes, or a limit
 * that grows by far more than they would dominate. */
static void set_weights(proximal_work *w, const contact_problem *cp) {
  for (int i = 0; i < cp->m; ++i) {
    const double mu = i % cp->dim == 0 ? 0.0 : row_sum(cp->B, i / cp->dim);
    w->weight[i] = 1.0 / (w->set->D[i] * fmax(1.0, mu * mu));
  }
}

/* Length of z in the tangents of a node where friction acts; their number. */
static double tangent_length(const run *s, int node_id, int *count) {
  double sum = 0.0;
  *count = 0;
  for (int k = 1; k < s->cp->dim; ++k) {
    int dof = node_id * s->cp->dim + k;
    if (s->w->set->part[dof] != IN_DISC) continue;
    sum += s->w->z[dof] * s->w->z[dof];
    ++*count;
  }
  return sqrt(sum);
}

/* F at r; returns its size in the metric of the weights, squared. */
static double evaluate(run *s) {
  const contact_problem *cp = s->cp;
  proximal_work *w = s->w;
  const force_set *set = w->set;
  double sum = 0.0;
  int count;
  if (cp->op == NULL) force_set_displacement(set, s->r, s->u);
  for (int i = 0; i < cp->m; ++i) {
    w->x[i] = s->u[i] - set->origin[i];
    w->z[i] = s->r[i] - s->stretch * (set->D[i] * w->x[i] +
                                      s->share * (s->r[i] - w->centre[i]));
    w->F[i] = s->r[i] - (set->part[i] == PUSH ? fmin(w->z[i], 0.0) : 0.0);
  }
  for (int i = 0; i < cp->n; ++i) {
    double length = tangent_length(s, i, &count);
    if (count == 0) continue;
    double g = contact_node_limit(cp, s->r, i);
    double share = length <= g ? 1.0 : g / length;
    for (int k = 1; k < cp->dim; ++k) {
      int dof = i * cp->dim + k;
      if (set->part[dof] == IN_DISC) w->F[dof] = s->r[dof] - share * w->z[dof];
    }
  }
  for (int i = 0; i < cp->m; ++i) sum += w->weight[i] * w->F[i] * w->F[i];
  return sum;
}

/* Into the current row: minus "share" times that of z_j. */
static void add_row(const run *s, int j, double share) {
  step_matrix_add_row(s->w->J, j, share * s->stretch * s->w->set->D[j]);
  step_matrix_add(s->w->J, j, -share * (1.0 - s->stretch * s->share));
}

/* Row of tangent a of a node that slips: g e turns with z and grows with the
 * pressures. */
static void add_slip(const run *s, int node_id, int a, double length) {
  const contact_problem *cp = s->cp;
  const proximal_work *w = s->w;
  double g = contact_node_limit(cp, s->r, node_id);
  int first = node_id * cp->dim;
  double e_a = w->z[first + a] / length;
  for (int b = 1; b < cp->dim; ++b) {
    if (w->set->part[first + b] != IN_DISC) continue;
    double e_b = w->z[first + b] / length;
    double turn = g / length * ((a == b ? 1.0 : 0.0) - e_a * e_b);
    if (turn != 0.0) add_row(s, first + b, turn);
  }
  if (cp->B == NULL) return;
  for (int k = cp->B->start[node_id]; k < cp->B->start[node_id + 1]; ++k) {
    int normal = cp->B->col[k] * cp->dim;
    if (s->r[normal] < 0.0 || w->z[normal] < 0.0)
      step_matrix_add(w->J, normal, cp->B->val[k] * e_a);
  }
}

/* 1: an open node, whose tangents carry no force in this step. */
static int is_idle(const run *s, int node_id) {
  const sparse_rows *B = s->cp->B;
  if (contact_node_limit(s->cp, s->r, node_id) > 0.0) return 0;
  for (int k = row_begin(B, node_id); k < row_end(B, node_id); ++k) {
    int normal = B->col[k] * s->cp->dim;
    if (s->r[normal] < 0.0 || s->w->z[normal] < 0.0) return 0;
  }
  return 1;
}

static void mark_rows(const run *s) {
  const contact_problem *cp = s->cp;
  const proximal_work *w = s->w;
  for (int i = 0; i < cp->n; ++i)
    for (int k = 0, idle = is_idle(s, i); k < cp->dim; ++k) {
      int dof = i * cp->dim + k;
      if (w->set->part[dof] == PUSH) w->acts[dof] = w->z[dof] < 0.0;
      if (w->set->part[dof] == IN_DISC) w->acts[dof] = !idle;
      if (w->set->part[dof] == NO_FORCE) w->acts[dof] = 0;
    }
}

static status fill_matrix(const run *s) {
  const contact_problem *cp = s->cp;
  const proximal_work *w = s->w;
  int count;
  mark_rows(s);
  step_matrix_begin(w->J, w->acts, w->d);
  for (int dof = 0; dof < cp->m; ++dof) {
    int node_id = dof / cp->dim;
    if (!w->acts[dof]) continue;
    double length = tangent_length(s, node_id, &count);
    step_matrix_add(w->J, dof, 1.0);
    if (w->set->part[dof] == PUSH ||
        length <= contact_node_limit(cp, s->r, node_id))
      add_row(s, dof, 1.0);
    else
      add_slip(s, node_id, dof % cp->dim, length);
    PASS(step_matrix_put(w->J, dof));
  }
  return OK;
}

/* ---- the equations of a step of an operator ------------------------------ */

/* Tangents of a node that slips: its turning stiffness and the load. */
static void put_slip(const run *s, int node_id, double length) {
  const contact_problem *cp = s->cp;
  const proximal_work *w = s->w;
  const pattern *p = &w->by.guess;
  const int first = node_id * cp->dim;
  double *e = p->e + node_id * (cp->dim - 1) - 1, along = 0.0;
  const double t = contact_node_limit(cp, s->r, node_id) / length;
  const double q = 1.0 - (1.0 - s->stretch * s->share) * t;
  p->mode[node_id] = SLIP;
  p->kappa[node_id] = t * s->stretch * w->set->D[first + 1] / q;
  for (int k = 1; k < cp->dim; ++k) {
    e[k] = w->set->part[first + k] == IN_DISC ? w->z[first + k] / length : 0.0;
    along += e[k] * w->F[first + k];
  }
  for (int k = 1; k < cp->dim; ++k)
    w->by.b[first + k] = -(e[k] * along + (w->F[first + k] - e[k] * along) / q);
}

/* Row of an unknown that does not slip; fixed: its force is z. */
static void put_row(const run *s, int dof, int fixed) {
  const contact_problem *cp = s->cp;
  const proximal_work *w = s->w;
  const double scale = fixed ? s->stretch * s->share : 1.0;
  w->by.guess.place[dof] = dof;
  w->by.guess.closed[dof] =
      w->set->part[dof] == PUSH && (s->r[dof] < 0.0 || w->z[dof] < 0.0);
  w->by.hold[dof] = fixed ? w->set->D[dof] / s->share : 0.0;
  w->by.b[dof] = -w->F[dof] / scale;
  w->by.du[dof] = contact_held(cp, dof)
                      ? cp->f[dof] / contact_diagonal(cp, dof) - s->u[dof]
                      : 0.0;
}

static void put_node(const run *s, int node_id) {
  const contact_problem *cp = s->cp;
  const proximal_work *w = s->w;
  int count;
  const double length = tangent_length(s, node_id, &count);
  const int slips = count > 0 && !is_idle(s, node_id) &&
                    length > contact_node_limit(cp, s->r, node_id);
  w->by.guess.mode[node_id] = FREE;
  for (int dof = node_id * cp->dim; dof < (node_id + 1) * cp->dim; ++dof)
    put_row(s, dof, w->acts[dof] && (w->set->part[dof] == PUSH || !slips));
  if (slips) put_slip(s, node_id, length);
}

/* d and du of the rows that act. Forces that are to vanish do so exactly. */
static status solve_operator(const run *s, int *singular) {
  proximal_work *w = s->w;
  const operated_rows rows = {&w->by.guess, w->by.hold, w->by.b};
  PASS(operated_system_direction(w->by.system, s->cp, &rows, w->by.du, w->d,
                                 singular));
  *singular = 0;
  for (int i = 0; i < s->cp->m; ++i)
    if (!w->acts[i]) w->d[i] = -w->F[i];
  return OK;
}

/* ---- steps --------------------------------------------------------------- */

/* r and, of an operator, u by a part of the step. */
static void move(run *s, double part) {
  cblas_daxpy(s->cp->m, part, s->w->d, 1, s->r, 1);
  if (s->cp->op != NULL) cblas_daxpy(s->cp->m, part, s->w->by.du, 1, s->u, 1);
}

/* Along d, shortened while |F|^2 is above "bound"; the last trial is taken. */
static double search(run *s, double bound) {
  double t = 1.0, taken = 0.0, value = HUGE_VAL;
  for (int k = 0; k < HALVINGS; ++k, t *= 0.5) {
    move(s, t - taken);
    taken = t;
    value = evaluate(s);
    if (value <= bound * (1.0 - SLOPE * t)) break;
  }
  return value;
}

/* d of the equations at r. */
static status direction(run *s, int *singular) {
  proximal_work *w = s->w;
  if (s->cp->op != NULL) {
    mark_rows(s);
    for (int i = 0; i < s->cp->n; ++i) put_node(s, i);
    return solve_operator(s, singular);
  }
  for (int i = 0; i < s->cp->m; ++i) w->d[i] = -w->F[i];
  PASS(fill_matrix(s));
  return step_matrix_solve(w->J, w->d, singular);
}

/* One step of Newton's method; *value NAN if there is none. */
static status newton_step(run *s, double bound, double *value) {
  int singular = 0;
  *value = NAN;
  ++s->steps;
  PASS(direction(s, &singular));
  if (!singular) *value = search(s, bound);
  return OK;
}

/* From the centre, where |F|^2 = value, until PASS_GAIN of it is left. *steps:
 * more than PASS: not found. */
static status pass(run *s, double value, int *steps) {
  double last[MEMORY], wanted = PASS_GAIN * value;
  for (int k = 0; k < MEMORY; ++k) last[k] = value;
  *steps = PASS + 1;
  for (int k = 0; k < PASS; ++k) {
    double bound = 0.0;
    for (int i = 0; i < MEMORY; ++i) bound = fmax(bound, last[i]);
    PASS(newton_step(s, bound, &value));
    if (isnan(value)) break;
    if (value <= wanted) {
      *steps = k + 1;
      break;
    }
    last[k % MEMORY] = value;
  }
  return OK;
}

/* The share for the next pass, after one of so many steps. */
static void set_share(run *s, int steps) {
  double factor = 1.0;
  if (steps <= EASY) factor = fmax(0.25, fmin(2.0 * s->hard / s->share, 1.0));
  if (steps > HARD) factor = 2.0;
  if (steps > PASS) factor = 8.0;
  s->hard = FORGET * (steps > HARD ? s->share : s->hard);
  s->share = fmax(LEAST_SHARE, fmin(MOST_SHARE, factor * s->share));
}

/* The forces that close every gap and let nothing slip, for limits so large
 * that no step from zero leads there. */
static status close_operator(run *s) {
  const contact_problem *cp = s->cp;
  const proximal_work *w = s->w;
  int singular;
  CLEAR(w->centre, cp->m);
  evaluate(s);
  for (int i = 0; i < cp->n; ++i) w->by.guess.mode[i] = FREE;
  for (int i = 0; i < cp->m; ++i) {
    w->acts[i] = w->set->part[i] != NO_FORCE;
    w->F[i] = w->acts[i] ? s->r[i] - w->z[i] : s->r[i];
    put_row(s, i, w->acts[i]);
  }
  PASS(solve_operator(s, &singular));
  move(s, 1.0);
  return OK;
}

static status start_closed(run *s) {
  proximal_work *w = s->w;
  int m = s->cp->m, singular = 0;
  if (s->cp->op != NULL) return close_operator(s);
  CLEAR(s->r, m);
  CLEAR(w->centre, m);
  evaluate(s);
  for (int i = 0; i < m; ++i) {
    w->acts[i] = w->set->part[i] != NO_FORCE;
    w->d[i] = w->acts[i] ? -w->set->D[i] * w->x[i] : 0.0;
  }
  step_matrix_begin(w->J, w->acts, w->d);
  for (int i = 0; i < m; ++i) {
    if (!w->acts[i]) continue;
    step_matrix_add(w->J, i, 1.0);
    add_row(s, i, 1.0);
    PASS(step_matrix_put(w->J, i));
  }
  PASS(step_matrix_solve(w->J, w->d, &singular));
  if (!singular) COPY(s->r, w->d, m);
  return OK;
}

/* The centre of the next pass: r, or after slow passes an extrapolation. */
static void set_centre(run *s, int creeps) {
  proximal_work *w = s->w;
  double ahead = creeps > 1 ? creeps / (creeps + 3.0) : 0.0;
  for (int i = 0; i < s->cp->m; ++i) {
    double now = s->r[i];
    s->r[i] += ahead * (now - w->before[i]);
    w->before[i] = now;
    w->centre[i] = s->r[i];
  }
  for (int i = 0; s->cp->op != NULL && i < s->cp->m; ++i) {
    double now = s->u[i];
    s->u[i] += ahead * (now - w->by.before[i]);
    w->by.before[i] = now;
    w->by.centre[i] = s->u[i];
  }
}

/* The pass failed: where it began. */
static void return_to_centre(run *s) {
  COPY(s->r, s->w->centre, s->cp->m);
  if (s->cp->op != NULL) COPY(s->u, s->w->by.centre, s->cp->m);
}

/* The start forces, of an operator with their displacements; of a body that
 * contact alone holds the start displacements with their forces. */
static status begin(run *s) {
  const contact_problem *cp = s->cp;
  const proximal_work *w = s->w;
  COPY(s->r, w->start, cp->m);
  if (cp->op == NULL) return OK;
  operated_system_fit(w->by.system);
  if (cp->floating) {
    COPY(s->u, w->by.start, cp->m);
    contact_reaction(cp, s->u, s->r);
    return OK;
  }
  PASS(force_set_fit(w->set, cp));
  force_set_displacement(w->set, s->r, s->u);
  return OK;
}

/* Residual at r; an operator's r and A u - f have drifted apart by rounding. */
static double residual_of(const run *s) {
  const contact_problem *cp = s->cp;
  double *raw = cp->op != NULL ? s->w->by.b : NULL;
  if (raw != NULL) contact_reaction(cp, s->u, raw);
  return contact_mismatch(cp, s->scale, s->u, s->r, raw);
}

/* Passes from the start forces. */
static status trial(run *s, int limit, int closed, outcome *end) {
  proximal_work *w = s->w;
  double lowest = HUGE_VAL, before = HUGE_VAL;
  int steps = 0, creeps = 0;
  s->hard = 0.0;
  PASS(begin(s));
  if (closed) PASS(start_closed(s));
  *end = STOPPED_STAGNATION;
  for (int idle = 0; idle < PATIENCE; ++idle) {
    COPY(w->centre, s->r, s->cp->m);
    evaluate(s);
    double residual = residual_of(s);
    solver_keep_best(&w->best, s->cp->m, residual, s->u, s->r);
    solver_report_step(s->control, "proximal", s->steps, residual);
    *end = residual <= s->control->tol ? CONVERGED
           : isnan(residual)           ? STOPPED_NAN
           : s->steps >= limit         ? STOPPED_ITERATIONS
                                       : STOPPED_STAGNATION;
    if (*end != STOPPED_STAGNATION) break;
    if (solver_progresses(&lowest, residual)) idle = 0;
    creeps = residual > CREEP * before && steps <= HARD ? creeps + 1 : 0;
    before = residual;
    set_centre(s, creeps);
    PASS(pass(s, evaluate(s), &steps));
    if (steps > PASS && s->share >= MOST_SHARE) break; /* would be repeated */
    if (steps > PASS) return_to_centre(s);
    set_share(s, steps);
  }
  return OK;
}

static status proximal_solve(const contact_problem *cp, const void *par,
                             void *work, const solver_control *control,
                             double *u, double *r, solver_report *rep) {
  proximal_work *w = work;
  run s = {.cp = cp, .w = w, .control = control, .u = u, .r = r};
  int limit = control->max_iter > 0 ? control->max_iter : STEPS;
  s.scale = contact_scale(cp);
  *rep = (solver_report){.outcome = RUNNING};
  w->best.residual = HUGE_VAL;
  PASS(force_set_fit(w->set, cp));
  set_weights(w, cp);
  COPY(w->start, r, cp->m);
  if (cp->op != NULL) COPY(w->by.start, u, cp->m);
  for (int k = 0; k < TRIALS && rep->outcome != CONVERGED; ++k) {
    if (k > 0 && (s.steps >= limit || control->no_restart)) break;
    int until = s.steps + TRIAL;
    s.stretch = settings[k].stretch;
    s.share = settings[k].share;
    PASS(trial(&s, until < limit ? until : limit, k == TRIALS - 1,
               &rep->outcome));
    if (rep->outcome == STOPPED_NAN) break;
  }
  if (rep->outcome == STOPPED_ITERATIONS && s.steps < limit)
    rep->outcome = STOPPED_STAGNATION;
  rep->iterations = s.steps;
  rep->residual = solver_take_best(&w->best, cp->m, u, r);
  return OK;
}

const solver_ops proximal_solver = {
    .name = "proximal",
    .family = "Newton",
    .handles = SOLVES_TRESCA | SOLVES_COULOMB | SOLVES_3D | NEEDS_COMPLIANCE |
               SPARSE_COMPLIANCE | FLOATS_BY_OPERATOR,
    .work_size = sizeof(proximal_work),
    .options = proximal_options,
    .setup = proximal_setup,
    .solve = proximal_solve};
