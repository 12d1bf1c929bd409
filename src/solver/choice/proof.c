/* Proof that a problem has no solution (choice.h). */
#include "solver/choice/choice.h"

#include "solver/lcp/lcp.h"
#include "solver/lcp/lcp_solve.h"

#include <cblas.h>

enum { PASSES = 400 /* columns tried */ };
static const double DEFECT = 0x1p-26;   /* -, force of a motion without any */
static const double ROUNDING = 0x1p-44; /* -, of a sum, of its terms */
static const double MARGIN = 0x1p-40;   /* -, of the work */
static const double LOAD_ROUNDING = 0x1p-48; /* -, of the loads */
static const double BALANCED = 0x1p-36;      /* -, of the load */

/* ---- the inequality ------------------------------------------------------ */

/* Length of the tangential part at a node that friction acts on; 0 else. */
static double slip_of(const contact_problem *cp, const double *v, int node_id) {
  double sum = 0.0;
  if (cp->g0 == NULL || contact_has_side(cp, node_id)) return 0.0;
  for (int k = 1; k < cp->dim; ++k) {
    int dof = node_id * cp->dim + k;
    if (!contact_held(cp, dof)) sum += v[dof] * v[dof];
  }
  return sqrt(sum);
}

static double held_by_limit(const contact_problem *cp, const double *slip) {
  double h = 0.0;
  for (int i = 0; cp->g0 != NULL && i < cp->n; ++i) h += cp->g0[i] * slip[i];
  return h;
}

/* Largest c, at least 0; NaN: a number is missing. v[m]; sets c[m], slip[n]. */
static double largest_growth(const contact_problem *cp, const double *v,
                             double *c, double *slip) {
  double most = 0.0;
  for (int i = 0; i < cp->n; ++i) slip[i] = slip_of(cp, v, i);
  /* c of every unknown with a bound, 0 at the others. c[m], slip[n] */
  const sparse_rows *B = cp->B;
  for (int dof = 0; dof < cp->m; ++dof)
    c[dof] = contact_bound(cp, dof) < HUGE_VAL ? v[dof] : 0.0;
  for (int i = 0; B != NULL && i < cp->n; ++i)
    for (int k = B->start[i]; k < B->start[i + 1]; ++k)
      c[B->col[k] * cp->dim] += B->val[k] * slip[i];
  for (int dof = 0; dof < cp->m; ++dof)
    if (!(c[dof] <= most)) most = c[dof];
  return most;
}

/* Largest force of A v, which should be zero, over its terms; workspace[m]. */
static double force_of(const contact_problem *cp, const double *v,
                       double *workspace) {
  double force = 0.0;
  contact_apply(cp, v, workspace);
  for (int i = 0; i < cp->m; ++i) force = fmax(force, fabs(workspace[i]));
  return force > 0.0 ? force / contact_resistance(cp, v, DEFECT) : 0.0;
}

static int motion_is_proof(const contact_problem *cp, const double *v,
                           double *workspace) {
  double work = 0.0, terms = 0.0, most = 0.0, noise = 0.0;
  double *slip = workspace + cp->m;
  if (!cp->floating || !(force_of(cp, v, workspace) <= DEFECT)) return 0;
  for (int i = 0; i < cp->m; ++i) {
    most = fmax(most, fabs(v[i]));
    work += cp->f[i] * v[i];
    terms += fabs(cp->f[i] * v[i]);
    noise += LOAD_ROUNDING *
             fmax(cp->load, contact_diagonal(cp, i) * cp->moved) * fabs(v[i]);
  }
  if (!(largest_growth(cp, v, workspace, slip) <= ROUNDING * most)) return 0;
  return work - held_by_limit(cp, slip) > fmax(MARGIN * terms, noise);
}

/* v = W'l with the sum of |terms| of its largest entry; column[m]: work. */
static double respond(const contact_problem *cp, const double *l, double *v,
                      double *column) {
  double most = 0.0;
  for (size_t j = 0, m = cp->m; j < m; ++j) {
    double terms = 0.0;
    contact_column(cp, (int)j, column);
    v[j] = 0.0;
    for (size_t i = 0; i < m; ++i) {
      v[j] += column[i] * l[i];
      terms += fabs(column[i] * l[i]);
    }
    most = fmax(most, terms);
  }
  return most;
}

static int forces_are_proof(const contact_problem *cp, const double *l,
                            double *workspace) {
  double work = 0.0, terms = 0.0, *v = workspace, *c = workspace + cp->m;
  for (int dof = 0; dof < cp->m; ++dof) {
    double bound = contact_bound(cp, dof);
    if (l[dof] < 0.0 || (l[dof] > 0.0 && !(bound < HUGE_VAL))) return 0;
    if (!(l[dof] > 0.0)) continue;
    work += l[dof] * (cp->f[dof] - bound);
    terms += l[dof] * (fabs(cp->f[dof]) + fabs(bound));
  }
  double *slip = c + cp->m;
  double size = respond(cp, l, v, c);
  if (!(largest_growth(cp, v, c, slip) <= ROUNDING * cp->m * size)) return 0;
  return work - held_by_limit(cp, slip) > MARGIN * terms;
}

int proof_holds(const contact_problem *cp, const double *v, double *workspace) {
  return contact_has_stiffness(cp) ? motion_is_proof(cp, v, workspace)
                                   : forces_are_proof(cp, v, workspace);
}

/* ---- stiffness: forces nearest to balance --------------------------------
 * In the modes R the load b = R'f must be a sum of columns with factors >= 0:
 * of a normal force with its friction; of the friction g0, with factor 1, for
 * which an entry is added to all columns and to b (lcp_solve.h). Where no
 * column does work on the rest, it is v. */

typedef struct balance {
  const contact_problem *cp;
  const anchor *an;
  nonnegative sum; /* rows: modes + 1 */
  double unit;     /* of the limit g0 */
  double *v, *c;   /* [m], [3*m] with slip */
  double *force;   /* [m] */
  double *lift;    /* [m] set_lift */
} balance;

/* Friction of node i against v, times "limit", added to the force. */
static void add_friction(const balance *s, int i, double limit) {
  const contact_problem *cp = s->cp;
  double slip = slip_of(cp, s->v, i);
  for (int k = 1; k < cp->dim && slip > 0.0; ++k) {
    int dof = i * cp->dim + k;
    if (!contact_held(cp, dof)) s->force[dof] += limit * s->v[dof] / slip;
  }
}

/* The column with the largest work on the rest, into to[rows]; its work, <= 0:
 * none. */
static double best_column(balance *s, double *to) {
  const contact_problem *cp = s->cp;
  int m = cp->m, k = s->an->n_mode, best = 0;
  double *slip = s->c + m;
  cblas_dgemv(CblasColMajor, CblasNoTrans, m, k, 1.0, s->an->R, m, s->sum.rest,
              1, 0.0, s->v, 1);
  largest_growth(cp, s->v, s->c, slip);
  for (int dof = 1; dof < m; ++dof)
    if (s->c[dof] > s->c[best]) best = dof;
  double of_limit = held_by_limit(cp, slip) / s->unit + s->sum.rest[k];
  int limit = of_limit > s->c[best];
  CLEAR(s->force, m);
  if (!limit) {
    /* The normal force of an unknown with a bound, 1, and its friction. */
    s->force[best] = 1.0;
    for (int i = 0; cp->B != NULL && i < cp->n; ++i)
      for (int e = cp->B->start[i]; e < cp->B->start[i + 1]; ++e)
        if (cp->B->col[e] * cp->dim == best) add_friction(s, i, cp->B->val[e]);
  }
  for (int i = 0; limit && cp->g0 != NULL && i < cp->n; ++i)
    add_friction(s, i, cp->g0[i] / s->unit);
  cblas_dgemv(CblasColMajor, CblasTrans, m, k, 1.0, s->an->R, m, s->force, 1,
              0.0, to, 1);
  to[k] = limit;
  return fmax(s->c[best], of_limit);
}

/* The motion that lifts all nodes most evenly; *gain: the least decrease of c
 * per unit of it, 0: none. */
static void set_lift(balance *s, double *gain) {
  const contact_problem *cp = s->cp;
  int m = cp->m, k = s->an->n_mode;
  for (int dof = 0; dof < m; ++dof)
    s->c[dof] = contact_bound(cp, dof) < HUGE_VAL ? -1.0 : 0.0;
  cblas_dgemv(CblasColMajor, CblasTrans, m, k, 1.0, s->an->R, m, s->c, 1, 0.0,
              s->sum.y, 1);
  cblas_dgemv(CblasColMajor, CblasNoTrans, m, k, 1.0, s->an->R, m, s->sum.y, 1,
              0.0, s->lift, 1);
  largest_growth(cp, s->lift, s->c, s->c + m);
  *gain = HUGE_VAL;
  for (int dof = 0; dof < m; ++dof)
    if (contact_bound(cp, dof) < HUGE_VAL) *gain = fmin(*gain, -s->c[dof]);
  if (!(*gain > MARGIN)) *gain = 0.0;
}

/* 1: v is a proof, after a lift by its rounding. */
static int is_proof(balance *s, double gain) {
  double growth = largest_growth(s->cp, s->v, s->c, s->c + s->cp->m);
  if (growth > 0.0 && gain > 0.0)
    cblas_daxpy(s->cp->m, 2.0 * growth / gain, s->lift, 1, s->v, 1);
  return proof_holds(s->cp, s->v, s->c);
}

/* *proved: the load on the modes cannot be balanced. */
static status find_motion(const contact_problem *cp, const anchor *an,
                          int *proved) {
  SCRATCH;
  balance s = {.cp = cp, .an = an};
  double *column, *b, size, gain, before = HUGE_VAL;
  size_t m = s.cp->m;
  PASS(nonnegative_new(s.an->n_mode + 1, &s.sum));
  PASS_NEW_ALL(OF(s.v, m), OF(s.c, 3 * m), OF(s.force, m), OF(s.lift, m));
  b = s.sum.b;
  cblas_dgemv(CblasColMajor, CblasTrans, cp->m, an->n_mode, 1.0, an->R, cp->m,
              cp->f, 1, 0.0, b, 1);
  size = cblas_dnrm2(an->n_mode, b, 1);
  if (!(size > 0.0 && size < HUGE_VAL)) return OK;
  s.unit = b[an->n_mode] = size;
  set_lift(&s, &gain);
  nonnegative_begin(&s.sum);
  for (int k = 0; k < PASSES; ++k) {
    double left = cblas_dnrm2(s.sum.rows, s.sum.rest, 1);
    if (!(left > BALANCED * size && left <= before)) break;
    before = left;
    column = nonnegative_next(&s.sum);
    if (column == NULL) break;
    double does = best_column(&s, column);
    *proved = is_proof(&s, gain);
    if (*proved || !(does > 0.0) || !nonnegative_take(&s.sum)) break;
  }
  return OK;
}

/* ---- compliance ---------------------------------------------------------- */

/* The final forces of complementary pivoting without friction. */
static status find_forces(const contact_problem *cp, int *proved) {
  OWNED double *M = NULL, *q = NULL, *y = NULL, *l = NULL, *work = NULL;
  int n = 0;
  size_t m = cp->m;
  lcp_report rep;
  OWNED_NEW(int, id, m);
  for (int dof = 0; dof < cp->m; ++dof)
    if (contact_bound(cp, dof) < HUGE_VAL) id[n++] = dof;
  PASS_NEW_ALL(OF(M, (size_t)n * n), OF(q, n), OF(y, n), OF(l, m),
               OF(work, 3 * m));
  for (int j = 0; j < n; ++j) {
    contact_column(cp, id[j], work);
    for (int i = 0; i < n; ++i) M[i + (size_t)n * j] = work[id[i]];
  }
  for (int i = 0; i < n; ++i) q[i] = contact_bound(cp, id[i]) - cp->f[id[i]];
  PASS(lcp_lemke(n, M, q, 0, y, &rep));
  if (rep.outcome != STOPPED_RAY) return OK;
  for (int i = 0; i < n; ++i) l[id[i]] = y[i];
  *proved = proof_holds(cp, l, work);
  return OK;
}

status proof_find(const contact_problem *cp, anchor *an, int *proved) {
  *proved = 0;
  if (cp->m == 0) return OK;
  if (!contact_has_stiffness(cp)) {
    PASS(find_forces(cp, proved));
  } else if (cp->floating) {
    PASS(anchor_modes(cp, an));
    if (an->n_mode > 0) PASS(find_motion(cp, an, proved));
  }
  return OK;
}
