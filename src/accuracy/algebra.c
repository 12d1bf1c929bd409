/*
 * Error of the solver in the energy norm, from the duality gap.
 *
 * For a given limit g the solution minimises J over the displacements without
 * penetration, and for every admissible pair, v_n <= gap, q_n <= 0, |q_t| <= g,
 * with d = A v - f - q and D the dual functional,
 *
 *   J(v) - D(q) = C(v, q) + 1/2 d' inv(A) d,
 *   C = sum q_n (v_n - gap) + g |v_t - ut0| + q_t (v_t - ut0) >= 0.
 *
 * The pair is made from the solution (u, r) by one step of the natural map,
 *   q = P(r - c (u - reference)),   v = u + (q - r)/c,
 * with C = 0 exactly, and
 *
 *   |v - u*|_A <= |d|_inv(A),   |q - r*|_inv(A) <= |d|_inv(A)
 *
 * as q - r* and v - u* have a product that is not positive. So
 *   |u - u*|_A <= |u - v|_A + |d|_inv(A) + rounding:
 * two products with A and one solve. For Coulomb friction g is frozen at q. The
 * limit then is off by at most |B (q - r*)|, and a contraction with rate k
 * gives |v - u*|_A <= |d|_inv(A)/(1 - k).
 *
 * Where contact alone holds a body, A is singular: the forces q are first
 * brought into equilibrium with the load (balance.c), so that d has an energy;
 * the bound is that of the deformation, without the rigid motion.
 *
 * Compliance form: W, r in the place of A, u; d = v - W q - load. Two states
 * that satisfy the equation have the same distance in r by W as in u by A, so
 * that the rate is the same.
 */
#include "accuracy/accuracy.h"
#include "base/base.h"

#include <cblas.h>
#include <lapacke.h>

/*
 * Equilibrium of a body that contact alone holds: its stiffness has motions R
 * without energy, and the energy of d is finite only if R' d = 0. The forces
 * change by dq = Z y, Z = W R with the forces as weights (which keep their
 * sign), on sliding nodes by the limit of the new pressure; R' Z y = R' d. Of
 * motions that no force resists, as those of a body that has left the others,
 * rounding alone may be left.
 */

/* Largest change of the force of an unknown, N; 0: it is given. */
static double slack(const contact_problem *cp, const pair *p, int dof) {
  int i = dof / cp->dim;
  if (contact_bound(cp, dof) < HUGE_VAL) return -p->q[dof];
  if (!accuracy_rubs(cp, dof) || p->slides[i]) return 0.0;
  double g = contact_node_limit(cp, p->q, i), size = 0.0;
  for (int k = 1; k < cp->dim; ++k) size = hypot(size, p->q[i * cp->dim + k]);
  return fmax(g - size, 0.0);
}

/* Change of q_t on sliding nodes with the limit, in one column z[m]. */
static void follow_limit(const contact_problem *cp, const pair *p, double *z) {
  for (int i = 0; i < cp->n && cp->B != NULL; ++i) {
    double change = 0.0, g = contact_node_limit(cp, p->q, i);
    if (!p->slides[i] || !(g > 0.0)) continue;
    for (int k = cp->B->start[i]; k < cp->B->start[i + 1]; ++k)
      change -= cp->B->val[k] * z[cp->B->col[k] * cp->dim];
    for (int k = 1; k < cp->dim; ++k) {
      int dof = i * cp->dim + k;
      if (accuracy_rubs(cp, dof)) z[dof] = change * (p->q[dof] / g);
    }
  }
}

/* 1: the changed forces are admissible. */
static int admissible(const contact_problem *cp, const pair *p) {
  for (int i = 0; i < cp->n; ++i) {
    double size = 0.0, g = contact_node_limit(cp, p->q, i);
    for (int k = 0; k < cp->dim; ++k) {
      int dof = i * cp->dim + k;
      if (contact_bound(cp, dof) < HUGE_VAL && !(p->q[dof] <= 0.0)) return 0;
      if (accuracy_rubs(cp, dof)) size = hypot(size, p->q[dof]);
    }
    if (!p->slides[i] && size > g) return 0;
  }
  return 1;
}

/* Unit diagonal of G[k k]; rows and columns without one: 0. */
static void scale_balance(int k, double *G, double *root) {
  for (int a = 0; a < k; ++a) {
    root[a] = 1.0 / sqrt(fabs(G[a + k * a]));
    if (!(root[a] < HUGE_VAL)) root[a] = 0.0;
  }
  for (int c = 0; c < k; ++c)
    for (int a = 0; a < k; ++a) G[a + k * c] *= root[a] * root[c];
}

/* Motions that forces resist, on which the others depend: the first of order[k]
 * (from 1 on). G[k k] is lost, root[3 k] workspace. */
static int find_resisted(int k, double *G, double *root, int *order) {
  int rank = 0;
  scale_balance(k, G, root);
  LAPACKE_dpstrf_work(LAPACK_COL_MAJOR, 'L', k, G, k, order, &rank,
                      CONTACT_NO_LEVER, root + k);
  return rank;
}

/* y of G y = b in place of b[k]; 0: some motion has no force against it, or
 * only one with a lever arm of rounding. root[5 k], pivot[2 k]: workspace. */
static int solve_balance(int k, double *G, double *b, double *root,
                         int *pivot) {
  double norm, condition = 0.0;
  scale_balance(k, G, root);
  norm = LAPACKE_dlange_work(LAPACK_COL_MAJOR, '1', k, k, G, k, NULL);
  if (LAPACKE_dgetrf(LAPACK_COL_MAJOR, k, k, G, k, pivot) != 0) return 0;
  LAPACKE_dgecon_work(LAPACK_COL_MAJOR, '1', k, G, k, norm, &condition,
                      root + k, pivot + k);
  if (!(condition > CONTACT_NO_LEVER)) return 0;
  for (int a = 0; a < k; ++a) b[a] *= root[a];
  LAPACKE_dgetrs(LAPACK_COL_MAJOR, 'N', k, 1, G, k, pivot, b, k);
  for (int a = 0; a < k; ++a) b[a] *= root[a];
  return 1;
}

/* y = R' d, where rounding alone leaves a part of it: 0. 1: all of it is. */
static int find_resultants(const contact_problem *cp,
                           const inverse_energy *inverse, const pair *p,
                           double *y) {
  int none = 1;
  for (int c = 0; c < inverse->n_kernel; ++c) {
    const double *motion = inverse->kernel + (size_t)cp->m * c;
    double least = 0.0;
    for (int i = 0; i < cp->m; ++i) least += fabs(motion[i]) * p->rounding[i];
    y[c] = cblas_ddot(cp->m, motion, 1, p->d, 1);
    if (fabs(y[c]) <= least) y[c] = 0.0;
    none = none && y[c] == 0.0;
  }
  return none;
}

/* z[m] = W R of a motion, without lever arms of rounding. */
static void weigh(const contact_problem *cp, const pair *p,
                  const double *motion, double *z) {
  const double least = CONTACT_NO_LEVER * largest_entry(cp->m, motion);
  for (int dof = 0; dof < cp->m; ++dof)
    z[dof] = fabs(motion[dof]) > least ? slack(cp, p, dof) * motion[dof] : 0.0;
}

status pair_balance(const contact_problem *cp, const inverse_energy *inverse,
                    pair *p, int *done) {
  const int m = cp->m, k = inverse->n_kernel;
  const double *R = inverse->kernel;
  OWNED double *Z = NULL, *G = NULL, *y = NULL, *b = NULL, *root = NULL;
  OWNED int *order = NULL, *pivot = NULL;
  PASS_NEW_ALL(OF(Z, (size_t)m * k), OF(G, (size_t)k * k), OF(y, k), OF(b, k),
               OF(root, 5 * k), OF(order, k), OF(pivot, 2 * k));
  if ((*done = find_resultants(cp, inverse, p, y))) return OK;
  for (int c = 0; c < k; ++c)
    weigh(cp, p, R + (size_t)m * c, Z + (size_t)m * c);
  cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, k, k, m, 1.0, R, m, Z, m,
              0.0, G, k);
  const int rank = find_resisted(k, G, root, order);
  if (rank == 0) return OK;
  for (int c = 0; c < rank; ++c) {
    double *z = Z + (size_t)m * c;
    weigh(cp, p, R + (size_t)m * (order[c] - 1), z);
    follow_limit(cp, p, z);
    cblas_dgemv(CblasColMajor, CblasTrans, m, k, 1.0, R, m, z, 1, 0.0, root, 1);
    for (int a = 0; a < rank; ++a) G[a + rank * c] = root[order[a] - 1];
    b[c] = y[order[c] - 1];
  }
  if (!solve_balance(rank, G, b, root, pivot)) return OK;
  cblas_dgemv(CblasColMajor, CblasNoTrans, m, rank, 1.0, Z, m, b, 1, 0.0, p->t,
              1);
  for (int dof = 0; dof < m; ++dof) {
    p->q[dof] += p->t[dof];
    p->d[dof] -= p->t[dof];
    p->rounding[dof] += DBL_EPSILON * fabs(p->t[dof]);
  }
  find_resultants(cp, inverse, p, y);
  *done = admissible(cp, p);
  for (int c = rank; c < k; ++c) *done = *done && y[order[c] - 1] == 0.0;
  return OK;
}

/* ---- the admissible pair ------------------------------------------------ */

status pair_new(int n, int m, pair *p) {
  PASS_NEW_REALS(m, &p->v, &p->q, &p->d, &p->t, &p->rounding);
  PASS_NEW(p->slides, n);
  return OK;
}

/* Unilateral unknowns, and those without any force. */
static void pair_normal(const contact_problem *cp, const double *u,
                        const double *r, pair *p) {
  for (int dof = 0; dof < cp->m; ++dof) {
    double bound = contact_bound(cp, dof);
    node_stiffness c = accuracy_stiffness(cp, dof / cp->dim);
    double step = dof % cp->dim == 0 ? c.n : c.t, z = 0.0;
    if (bound < HUGE_VAL) z = r[dof] - step * (u[dof] - bound);
    p->q[dof] = fmin(z, 0.0);
    p->v[dof] = z < 0.0 ? bound : fmin(u[dof] - r[dof] / step, bound);
  }
}

/* Friction: disc of the limit of q_n. */
static void pair_friction(const contact_problem *cp, const double *u,
                          const double *r, pair *p) {
  for (int i = 0; i < cp->n; ++i) {
    double z[3] = {0.0}, size = 0.0, g = contact_node_limit(cp, p->q, i);
    double c = accuracy_stiffness(cp, i).t;
    for (int k = 1; k < cp->dim; ++k) {
      int dof = i * cp->dim + k;
      if (!accuracy_rubs(cp, dof)) continue;
      z[k] = r[dof] - c * (u[dof] - contact_stick(cp, dof));
      size = hypot(size, z[k]);
    }
    p->slides[i] = size > g * (1.0 - CONTACT_NO_LEVER);
    for (int k = 1; k < cp->dim; ++k) {
      int dof = i * cp->dim + k;
      if (!accuracy_rubs(cp, dof)) continue;
      p->q[dof] = size <= g ? z[k] : z[k] * (g / size);
      p->v[dof] = size <= g ? contact_stick(cp, dof)
                            : u[dof] + (p->q[dof] - r[dof]) / c;
    }
  }
}

/* The rows of d are sums of m products. */
static void row_roundings(const contact_problem *cp, pair *p) {
  const double *M = contact_matrix(cp);
  const double *x = contact_has_stiffness(cp) ? p->v : p->q;
  for (int i = 0; i < cp->m; ++i)
    p->rounding[i] =
        fabs(cp->f[i]) + fabs(contact_has_stiffness(cp) ? p->q[i] : p->v[i]);
  if (cp->op != NULL) { /* workspace[m..] is free between two products */
    double *size = cp->op->workspace + cp->m;
    cp->op->apply(cp->op->ctx, x, cp->op->workspace, size);
    for (int i = 0; i < cp->m; ++i) p->rounding[i] += size[i];
  }
  for (int j = 0; cp->op == NULL && j < cp->m; ++j) {
    const double *column = M + (size_t)j * cp->m;
    double size = fabs(x[j]);
    for (int i = 0; size > 0.0 && i < cp->m; ++i)
      p->rounding[i] += size * fabs(column[i]);
  }
  cblas_dscal(cp->m, 0.5 * DBL_EPSILON * (2.0 + sqrt(cp->m)), p->rounding, 1);
}

void pair_set(const contact_problem *cp, const double *u, const double *r,
              pair *p) {
  pair_normal(cp, u, r, p);
  pair_friction(cp, u, r, p);
  row_roundings(cp, p);
}

/* |u - v|_A or |r - q|_W. */
static double pair_distance(const contact_problem *cp, const double *u,
                            const double *r, pair *p, double *move) {
  const double *from = contact_has_stiffness(cp) ? u : r;
  const double *to = contact_has_stiffness(cp) ? p->v : p->q;
  int moved = 0;
  for (int i = 0; i < cp->m; ++i) {
    move[i] = from[i] - to[i];
    moved = moved || move[i] != 0.0;
  }
  if (!moved) return 0.0;
  contact_apply(cp, move, p->t);
  return sqrt(fmax(0.0, cblas_ddot(cp->m, move, 1, p->t, 1)));
}

static const double NO_PIVOT = 0x1p-44; /* -, of the largest diagonal */

/*
 * Largest |e|_inv(M) of what rounding can have put into d. x' inv(M) x <=
 * condition * sum x_i^2/D_ii, D the diagonal of M or of what M is condensed
 * from: where the body moves without energy, or its forces follow from statics,
 * M_ii may be rounding itself.
 */
static double pair_rounding(const contact_problem *cp,
                            const inverse_energy *inverse, const pair *p) {
  double sum = 0.0, least = 0.0;
  for (int i = 0; i < cp->m && inverse->n_kernel > 0; ++i)
    least = fmax(least, NO_PIVOT * contact_diagonal(cp, i));
  for (int i = 0; i < cp->m; ++i) {
    const double own = inverse->diagonal != NULL ? inverse->diagonal[i] : 0.0;
    const double of = fmax(fmax(contact_diagonal(cp, i), least), own);
    sum += p->rounding[i] * (p->rounding[i] / of);
  }
  return sqrt(inverse->condition * sum);
}

/* ---- the bound ---------------------------------------------------------- */

static void no_bound(solver_error *e, const char *why) {
  e->norm = NAN;
  e->why = why;
}

/* Rate of the sliding limit; 0: there is no bound. */
static status find_rate(const contact_problem *cp,
                        const contact_problem *stiffness, const double *u,
                        const double *r, known_rate *known, solver_error *e) {
  const contact_problem *of = contact_has_stiffness(cp) ? cp : stiffness;
  if (cp->B == NULL) return OK;
  if (of == NULL) {
    no_bound(e, "Coulomb friction, and the compliance is singular");
    return OK;
  }
  PASS(contraction_rate(of, u, r, known, &e->rate));
  if (!(e->rate < 1.0)) no_bound(e, "the sliding limit does not contract here");
  return OK;
}

status solver_error_bound(const contact_problem *cp,
                          const inverse_energy *inverse, const double *u,
                          const double *r, known_rate *known,
                          solver_error *error) {
  double square = 0.0;
  int balanced = 1;
  *error = (solver_error){0};
  if (cp->m == 0) return OK;
  PASS(find_rate(cp, inverse->stiffness, u, r, known, error));
  if (error->why != NULL) return OK;
  if (inverse->condition > 1.0 / DBL_EPSILON) {
    no_bound(error, "without contact the body is weakly held");
    return OK;
  }
  OWNED_PARTS(pair, p, pair_new(cp->n, cp->m, &p));
  pair_set(cp, u, r, &p);
  /* d = M x - load - y, x the unknown multiplied by M. */
  const double *x = contact_has_stiffness(cp) ? p.v : p.q;
  contact_apply(cp, x, p.d);
  for (int i = 0; i < cp->m; ++i)
    p.d[i] = contact_has_stiffness(cp) ? p.d[i] - cp->f[i] - p.q[i]
                                       : p.v[i] - p.d[i] - cp->f[i];
  if (inverse->n_kernel > 0) {
    PASS(pair_balance(cp, inverse, &p, &balanced));
    if (!balanced) {
      no_bound(error, "the contact forces do not balance the load");
      return OK;
    }
  }
  PASS(inverse->square(inverse->ctx, p.d, &square));
  error->norm = sqrt(square) + pair_rounding(cp, inverse, &p);
  error->norm /= 1.0 - error->rate;
  error->norm += pair_distance(cp, u, r, &p, p.d);
  if (!(error->norm < HUGE_VAL)) no_bound(error, "the answer is not a number");
  return OK;
}
