/*
 * Projected preconditioned conjugate gradients for the forces of contact with a
 * given sliding limit (CPR98, 3.3; Dostal 2009, MPRGP; Kucera 2008).
 *
 * The reciprocal problem: with the compliance W and x = W r + q - o the
 * displacement from the origin o (gap, stick position, second obstacle),
 *
 *   min J(r) = 1/2 r'W r + (q - o)'r,   r_n <= 0,  |r_t| <= g,   J' = x.
 *
 * At a feasible r the gradient x splits into the part along the face of the
 * constraints that are active, and the part that leads off the face inward:
 *
 *   r_n < 0       phi = x               r_n = 0      beta = max(x, 0)
 *   |r_t| < g     phi = x               |r_t| = g    phi = (I - e e') x,
 *                                                    beta = max(x.e, 0) e
 *
 * with e = r_t/g. r solves the problem if both vanish. While beta is not larger
 * than phi, conjugate gradients minimise on the face; a step that leaves the
 * set is projected back onto it, which closes many constraints at once. Else
 * one step along -beta releases the constraints. On the rim of a disc (3-D) the
 * face is a circle: its curvature |x.e|/g joins W, and r is brought back onto
 * the rim after a few steps.
 *
 * Face preconditioner: the block A_FF of the stiffness. inv(W_FF) is that block
 * less the compliance of the other unknowns, so the two differ by a bounded
 * factor except at the ends of the face. Without A: the diagonal of W. Of an
 * operator a product with W is a solve with the factor of all rows, and a
 * product with A one with that of the interior.
 */
#include "contact/force_set.h"
#include "solver/solver.h"

#include <cblas.h>

typedef struct pcg {
  int preconditioner; /* preconditioner_kind */
} pcg;

typedef enum { BY_FACE, BY_DIAGONAL } preconditioner_kind;

OPTIONS(pcg_options,
        OPTION_CHOICE(pcg, preconditioner, "PRECONDITIONER", "FACE|DIAGONAL",
                      "FACE", "of the conjugate gradients on a face"));

enum {
  STEPS = 20000,  /* default limit */
  PATIENCE = 500, /* steps without a lower residual */
  HALVINGS = 3    /* of a projected step that does not descend */
};
static const double ON_THE_RIM = 0x1p-20; /* -, of g: counts as |r_t| = g */
static const double ROUNDING = 0x1p-48;   /* -, of the terms of J */
static const double ENOUGH =
    0.1; /* -, of phi: the direction on the circle has changed */

typedef struct pcg_work {
  force_set *set;
  double *x;          /* [m] m */
  double *phi, *beta; /* [m] m */
  double *z, *p, *v;  /* [m] */
  double *r0, *x0;    /* [m] where the phase began */
  double *e, *turn;   /* [m] unit radius of a rim, [n] |x.e|/g, m/N */
  best_iterate best;
} pcg_work;

static status pcg_setup(const contact_problem *cp, const void *par,
                        void *work) {
  pcg_work *w = work;
  PASS(force_set_new(cp, &w->set));
  PASS_NEW_REALS(cp->m, &w->x, &w->phi, &w->beta, &w->z, &w->p, &w->v, &w->r0,
                 &w->x0, &w->e);
  PASS_NEW(w->turn, cp->n);
  return best_iterate_new(cp->m, &w->best);
}

/* ---- the set ------------------------------------------------------------- */

typedef struct run {
  const contact_problem *cp;
  pcg_work *w;
  const solver_control *control;
  double *u, *r;
  double scale, residual, mark; /* now; at the last progress */
  double phi2, beta2;           /* |phi|^2, |beta|^2 in the metric D */
  int by_face, bent;            /* 1: a rim with two tangents is on the face */
  int steps, limit, since;
  int refreshed; /* x was made again: begin a new phase */
} run;

/* Radii of the rims, and the curvature of J by the circles. */
static void directions(run *s) {
  const contact_problem *cp = s->cp;
  pcg_work *w = s->w;
  s->bent = 0;
  for (int i = 0; i < cp->n; ++i) {
    int first = i * cp->dim, tangents = 0;
    double g = cp->g0 == NULL ? 0.0 : cp->g0[i], along = 0.0;
    for (int k = 1; k < cp->dim && w->set->rim[i]; ++k) {
      if (w->set->part[first + k] != IN_DISC) continue;
      w->e[first + k] = s->r[first + k] / g;
      along += w->e[first + k] * w->x[first + k];
      ++tangents;
    }
    w->turn[i] = along < 0.0 ? -along / g : 0.0;
    s->bent = s->bent || tangents == 2;
  }
}

/* a . e of a node */
static double along_rim(const run *s, int node_id, const double *a) {
  double sum = 0.0;
  int first = node_id * s->cp->dim;
  for (int k = 1; k < s->cp->dim; ++k)
    if (s->w->set->part[first + k] == IN_DISC)
      sum += a[first + k] * s->w->e[first + k];
  return sum;
}

/* The part of a along the face: b (may be a). */
static void onto_face(const run *s, const double *a, double *b) {
  const contact_problem *cp = s->cp;
  const pcg_work *w = s->w;
  for (int i = 0; i < cp->n; ++i) {
    int first = i * cp->dim;
    double along = w->set->rim[i] ? along_rim(s, i, a) : 0.0;
    for (int k = 0; k < cp->dim; ++k) {
      force_part kind = (force_part)w->set->part[first + k];
      b[first + k] = a[first + k];
      if (kind == NO_FORCE || (kind == PUSH && !(s->r[first + k] < 0.0)))
        b[first + k] = 0.0;
      if (kind == IN_DISC && w->set->rim[i])
        b[first + k] -= along * w->e[first + k];
      if (kind == IN_DISC && w->set->rim[i] && !s->bent) b[first + k] = 0.0;
    }
  }
}

/* phi and beta from x. */
static void split(run *s) {
  const contact_problem *cp = s->cp;
  pcg_work *w = s->w;
  onto_face(s, w->x, w->phi);
  s->phi2 = s->beta2 = 0.0;
  for (int i = 0; i < cp->n; ++i) {
    int first = i * cp->dim;
    double inward = w->set->rim[i] ? fmax(along_rim(s, i, w->x), 0.0) : 0.0;
    for (int k = 0; k < cp->dim; ++k) {
      int dof = first + k;
      w->beta[dof] = 0.0;
      if (w->set->part[dof] == PUSH && !(s->r[dof] < 0.0))
        w->beta[dof] = fmax(w->x[dof], 0.0);
      if (w->set->part[dof] == IN_DISC && w->set->rim[i])
        w->beta[dof] = inward * w->e[dof];
      s->phi2 += w->set->D[dof] * w->phi[dof] * w->phi[dof];
      s->beta2 += w->set->D[dof] * w->beta[dof] * w->beta[dof];
    }
  }
}

/* Longest a for which the disc of a node holds r - a p. */
static double longest_in_disc(const run *s, int node_id, const double *p) {
  const contact_problem *cp = s->cp;
  int first = node_id * cp->dim;
  double pp = 0.0, rp = 0.0, rr = 0.0,
         g = cp->g0 == NULL ? 0.0 : cp->g0[node_id];
  for (int k = 1; k < cp->dim; ++k) {
    if (s->w->set->part[first + k] != IN_DISC) continue;
    pp += p[first + k] * p[first + k];
    rp += s->r[first + k] * p[first + k];
    rr += s->r[first + k] * s->r[first + k];
  }
  if (pp == 0.0) return HUGE_VAL;
  double rest = fmax(g * g - rr, 0.0);
  return (rp + sqrt(rp * rp + pp * rest)) / pp;
}

/* Longest a for which r - a p stays in the set; rims turn freely. */
static double longest(const run *s, const double *p, int rims_too) {
  double a = HUGE_VAL;
  for (int dof = 0; dof < s->cp->m; ++dof)
    if (s->w->set->part[dof] == PUSH && p[dof] < 0.0)
      a = fmin(a, s->r[dof] / p[dof]);
  for (int i = 0; i < s->cp->n; ++i)
    if (rims_too || !s->w->set->rim[i]) a = fmin(a, longest_in_disc(s, i, p));
  return a;
}

/* ---- steps --------------------------------------------------------------- */

/* u and x again from r. */
static void refresh(run *s) {
  force_set_displacement(s->w->set, s->r, s->u);
  for (int i = 0; i < s->cp->m; ++i)
    s->w->x[i] = s->u[i] - s->w->set->origin[i];
}

/* Residual at (r, x), reported and checked; RUNNING: continue. */
static outcome check(run *s) {
  const contact_problem *cp = s->cp;
  for (int i = 0; i < cp->m; ++i) s->u[i] = s->w->x[i] + s->w->set->origin[i];
  s->residual = contact_mismatch(cp, s->scale, s->u, s->r, NULL);
  if (s->residual <= s->control->tol) {
    refresh(s);
    s->refreshed = 1;
    s->residual = contact_mismatch(cp, s->scale, s->u, s->r, NULL);
  }
  solver_keep_best(&s->w->best, cp->m, s->residual, s->u, s->r);
  solver_report_step(s->control, "pcg", s->steps, s->residual);
  if (isnan(s->residual)) return STOPPED_NAN;
  if (s->residual <= s->control->tol) return CONVERGED;
  if (solver_progresses(&s->mark, s->residual)) s->since = s->steps;
  if (s->steps - s->since > PATIENCE) return STOPPED_STAGNATION;
  return s->steps >= s->limit ? STOPPED_ITERATIONS : RUNNING;
}

/* z from phi. */
static void precondition(run *s) {
  const contact_problem *cp = s->cp;
  pcg_work *w = s->w;
  if (s->by_face && cp->op != NULL)
    contact_apply(cp, w->phi, w->z);
  else if (s->by_face)
    cblas_dsymv(CblasColMajor, CblasLower, cp->m, 1.0, cp->A, cp->m, w->phi, 1,
                0.0, w->z, 1);
  else
    for (int i = 0; i < cp->m; ++i) w->z[i] = w->set->D[i] * w->phi[i];
  onto_face(s, w->z, w->z);
}

/* v = W p, with the curvature of the circles. */
static void curvature_product(run *s) {
  const contact_problem *cp = s->cp;
  const int dim = cp->dim;
  pcg_work *w = s->w;
  force_set_product(w->set, w->p, w->v);
  ++s->steps;
  for (int i = 0; s->bent && i < cp->n; ++i)
    for (int j = i * dim + 1; w->set->rim[i] && j < (i + 1) * dim; ++j)
      w->v[j] += w->turn[i] * w->p[j];
}

/* r to r0 + share*(v - r0) and into the set; x there. 1: J has not grown but by
 * rounding. */
static int arrive(run *s, double share, const double *aim) {
  pcg_work *w = s->w;
  int m = s->cp->m;
  double fall = 0.0, terms = 0.0;
  for (int i = 0; i < m; ++i) s->r[i] = w->r0[i] + share * (aim[i] - w->r0[i]);
  force_set_project(w->set, 0.0, s->r);
  for (int i = 0; i < m; ++i) w->p[i] = s->r[i] - w->r0[i];
  force_set_product(w->set, w->p, w->x);
  ++s->steps;
  for (int i = 0; i < m; ++i) {
    fall -= w->p[i] * (w->x[i] + 2.0 * w->x0[i]);
    terms += fabs(s->r[i] * w->x0[i]);
    w->x[i] += w->x0[i];
  }
  return fall > -ROUNDING * terms;
}

/* The step of plain gradient projection from r0, which always descends. */
static void gradient_step(run *s) {
  pcg_work *w = s->w;
  for (int i = 0; i < s->cp->m; ++i)
    w->z[i] = w->r0[i] - w->set->step * w->set->D[i] * w->x0[i];
  arrive(s, 1.0, w->z);
}

static void remember(run *s) {
  COPY(s->w->r0, s->r, s->cp->m);
  memcpy(s->w->x0, s->w->x, s->cp->m * sizeof *s->r);
}

/* The phase ended outside the set: go back along its step. */
static void come_back(run *s) {
  pcg_work *w = s->w;
  double share = 1.0;
  COPY(w->z, s->r, s->cp->m);
  for (int k = 0; k <= HALVINGS; ++k, share *= 0.5) {
    COPY(s->r, w->r0, s->cp->m);
    if (arrive(s, share, w->z)) return;
  }
  gradient_step(s);
}

/* One step along -D beta: constraints are released. */
static void let_go(run *s) {
  const contact_problem *cp = s->cp;
  pcg_work *w = s->w;
  double slope = 0.0;
  for (int i = 0; i < cp->m; ++i) {
    w->p[i] = w->set->D[i] * w->beta[i];
    slope += w->p[i] * w->beta[i];
  }
  force_set_product(w->set, w->p, w->v);
  ++s->steps;
  double bend = cblas_ddot(cp->m, w->p, 1, w->v, 1);
  double a = bend > 0.0 ? slope / bend : w->set->step;
  a = fmin(a, longest(s, w->p, 1));
  cblas_daxpy(cp->m, -a, w->p, 1, s->r, 1);
  cblas_daxpy(cp->m, -a, w->v, 1, w->x, 1);
  for (int i = 0; i < cp->n; ++i)
    for (int k = 1; k < cp->dim; ++k)
      if (w->p[i * cp->dim + k] != 0.0) w->set->rim[i] = 0;
}

/* r and x to the minimum along -p, rho = phi.z. LEFT_SET: that lies outside;
 * FLAT: there is no minimum. */
typedef enum { INSIDE, LEFT_SET, FLAT } arrival;
static arrival line_step(run *s, double rho) {
  pcg_work *w = s->w;
  int m = s->cp->m;
  double bend = cblas_ddot(m, w->p, 1, w->v, 1), reach = longest(s, w->p, 0);
  double a = bend > 0.0 ? rho / bend : 2.0 * reach;
  if (!(a < HUGE_VAL)) return FLAT;
  cblas_daxpy(m, -a, w->p, 1, s->r, 1);
  cblas_daxpy(m, -a, w->v, 1, w->x, 1);
  return a > reach ? LEFT_SET : INSIDE;
}

/* 1: nothing more to gain on this face, or (on circles) in this plane. */
static int face_is_done(const run *s, double before) {
  if (s->beta2 > s->phi2 || s->refreshed || s->steps >= s->limit) return 1;
  return s->bent && s->phi2 <= ENOUGH * ENOUGH * before;
}

/* Conjugate gradients on the face until the set is left, the face is solved, or
 * (on circles) the linearisation is no longer valid. */
static outcome phase(run *s) {
  pcg_work *w = s->w;
  int m = s->cp->m;
  double before = s->phi2;
  outcome o;
  arrival where;
  s->refreshed = 0;
  remember(s);
  precondition(s);
  COPY(w->p, w->z, m);
  double rho = cblas_ddot(m, w->phi, 1, w->z, 1);
  for (;;) {
    curvature_product(s);
    where = line_step(s, rho);
    if (where == FLAT) return isnan(rho) ? STOPPED_NAN : STOPPED_SINGULAR;
    if (where == LEFT_SET) break;
    split(s);
    if (!s->bent && (o = check(s)) != RUNNING) return o;
    if (face_is_done(s, before)) break;
    precondition(s);
    double next = cblas_ddot(m, w->phi, 1, w->z, 1);
    for (int i = 0; i < m; ++i) w->p[i] = w->z[i] + next / rho * w->p[i];
    rho = next;
  }
  if (s->bent || where == LEFT_SET) come_back(s);
  return RUNNING;
}

static outcome phases(run *s) {
  outcome o;
  force_set_project(s->w->set, ON_THE_RIM, s->r);
  refresh(s);
  if ((o = check(s)) != RUNNING) return o;
  remember(s);
  gradient_step(s);
  while ((o = check(s)) == RUNNING) {
    directions(s);
    split(s);
    if (!(s->phi2 > 0.0) && !(s->beta2 > 0.0)) {
      if (s->refreshed) return STOPPED_STAGNATION;
      refresh(s);
      s->refreshed = 1;
    } else if (s->beta2 > s->phi2) {
      s->refreshed = 0;
      let_go(s);
    } else if ((o = phase(s)) != RUNNING) {
      return o;
    }
  }
  return o;
}

static status pcg_solve(const contact_problem *cp, const void *par, void *work,
                        const solver_control *control, double *u, double *r,
                        solver_report *rep) {
  const pcg *p = par;
  pcg_work *w = work;
  run s = {.cp = cp,
           .w = w,
           .control = control,
           .u = u,
           .r = r,
           .scale = contact_scale(cp),
           .mark = HUGE_VAL,
           .by_face = contact_has_stiffness(cp) && p->preconditioner == BY_FACE,
           .limit = control->max_iter > 0 ? control->max_iter : STEPS};
  *rep = (solver_report){.outcome = RUNNING};
  w->best.residual = HUGE_VAL;
  PASS(force_set_fit(w->set, cp));
  rep->outcome = phases(&s);
  rep->iterations = s.steps;
  rep->residual = solver_take_best(&w->best, cp->m, u, r);
  return OK;
}

const solver_ops pcg_solver = {SOLVER_OF(pcg), .family = "projection",
                               .handles = SOLVES_TRESCA | SOLVES_3D |
                                          NEEDS_COMPLIANCE | SPARSE_COMPLIANCE};
