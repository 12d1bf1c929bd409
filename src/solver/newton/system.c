/* A step: by an updated factor, or by a new one (system.h). */
#include "solver/newton/system.h"

#include "base/number.h"
#include "solver/newton/dense.h"

#include <cblas.h>
#include <lapacke.h>

enum {
  CHUNK = 32, /* rows gathered at a time */
  READ = 8    /* solves whose arithmetic takes the time of reading the factor */
};

struct newton_system {
  const contact_problem *cp; /* of the last fit */
  size_t n_node;
  int m, symmetric; /* symmetric: -1: not yet tested */
  double power;     /* of two: A*power has a diagonal of order 1 */
  dense K;          /* factor of the base */
  pattern base;     /* its guess */
  int has_base;
  uint64_t friction; /* hash of B in it */
  double spent;      /* on updates of the base, operations */
  int updated;       /* the last step came from an update */
  int n_free;        /* of the last step */
  int solves;        /* with the factor in it */
  struct {
    int capacity, n;  /* columns of X: most, made */
    int *column;      /* [m] of X, -1: not made */
    double *X;        /* [m*capacity] inv(M0) e_j */
    double *C;        /* [capacity*capacity] small system */
    int *small_pivot; /* [capacity] */
  } inverse;
  double *rows;       /* [m*CHUNK] */
  double *product;    /* [CHUNK*capacity] */
  int n_changed;      /* rows in which the guess differs from the base */
  int *changed;       /* [m] */
  double *b, *x, *du; /* [m] */
  double *z, *weight; /* [capacity], [capacity] */
};

/* ---- the matrix of a guess of the states, and its factor ----------------- */

static const double SPRING = 0x1p-36; /* -, of the diagonal */

/* ---- the matrix ---------------------------------------------------------- */

/* 1: under the guess friction of the node follows pressure: M is not symmetric.
 */
static int couples(const newton_system *s, const pattern *p, int node_id) {
  const sparse_rows *B = s->cp->B;
  if (p->mode[node_id] != SLIP) return 0;
  for (int k = row_begin(B, node_id); k < row_end(B, node_id); ++k)
    if (B->val[k] != 0.0 && p->closed[B->col[k] * s->cp->dim]) return 1;
  return 0;
}

/* 1: the guess puts friction into the rows of the node. */
static int newton_bends(const newton_system *s, const pattern *p, int node_id) {
  if (s->cp->dim == 3) return p->mode[node_id] == SLIP;
  return couples(s, p, node_id);
}

/* 1: M needs LU under the guess. */
static int newton_needs_lu(const newton_system *s, const pattern *p) {
  int full = !s->symmetric;
  for (int i = 0; i < s->cp->n && !full; ++i) full = couples(s, p, i);
  return full;
}

/* Rows of slipping nodes in one column of M: e (B A_n) of the closed nodes is
 * added; column[m] of A, to[n_free]. */
static void newton_limit_rows(const newton_system *s, const pattern *p,
                              const double *column, double *to) {
  const sparse_rows *B = s->cp->B;
  int dim = s->cp->dim;
  for (int node_id = 0; B != NULL && node_id < s->cp->n; ++node_id) {
    if (p->mode[node_id] != SLIP) continue;
    double sum = 0.0;
    for (int k = B->start[node_id]; k < B->start[node_id + 1]; ++k)
      if (p->closed[B->col[k] * dim])
        sum += B->val[k] * column[B->col[k] * dim];
    for (int k = 0; k < dim - 1; ++k) {
      int i = p->place[node_id * dim + 1 + k];
      if (i >= 0) to[i] += s->power * p->e[node_id * (dim - 1) + k] * sum;
    }
  }
}

static void fill(newton_system *s, double spring) {
  const pattern *p = &s->base;
  size_t ld = p->n_free, m = s->m;
  for (size_t j = 0; j < ld; ++j) {
    const double *column = s->cp->A + m * p->free_id[j];
    double *to = s->K.a + ld * j;
    for (size_t i = s->K.full ? 0 : j; i < ld; ++i)
      to[i] = s->power * column[p->free_id[i]];
    to[j] += spring * to[j];
    if (s->K.full) newton_limit_rows(s, p, column, to);
  }
  for (int node_id = 0; s->cp->dim == 3 && node_id < s->cp->n; ++node_id) {
    if (p->mode[node_id] != SLIP) continue;
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b) {
        int i = p->place[3 * node_id + 1 + a],
            j = p->place[3 * node_id + 1 + b];
        if (i >= 0 && j >= 0)
          s->K.a[i + ld * j] += s->power * pattern_turning(p, node_id, a, b);
      }
  }
}

/* Row of a free unknown under the guess, all columns, times power. to[m] */
static void newton_row(const newton_system *s, const pattern *p, int dof,
                       double *to) {
  const contact_problem *cp = s->cp;
  const sparse_rows *B = cp->B;
  int m = s->m, step = s->symmetric ? 1 : m, node_id = dof / cp->dim,
      tangents = cp->dim - 1, k = dof % cp->dim - 1;
  size_t stride = s->symmetric ? (size_t)m : 1u;
  CLEAR(to, m);
  cblas_daxpy(m, s->power, cp->A + stride * dof, step, to, 1);
  if (k < 0 || p->mode[node_id] != SLIP) return;
  for (int j = row_begin(B, node_id); j < row_end(B, node_id); ++j) {
    int n = B->col[j] * cp->dim;
    double a = s->power * p->e[node_id * tangents + k] * B->val[j];
    if (p->closed[n]) cblas_daxpy(m, a, cp->A + stride * n, step, to, 1);
  }
  for (int a = 0; tangents == 2 && a < 2; ++a)
    to[node_id * 3 + 1 + a] += s->power * pattern_turning(p, node_id, k, a);
}

/* ---- new factor ---------------------------------------------------------- */

/* Operations of a new factor. */
static double newton_cost(int n, int full) {
  double size = n;
  return (full ? 2.0 : 1.0) / 3.0 * size * size * size + READ * size * size;
}

/* Factor of the base; 0: singular to rounding. The condition number is computed
 * only where the matrix can be singular for valid data. */
static int newton_factor(newton_system *s) {
  fill(s, 0.0);
  return dense_factor(&s->K, s->K.full || s->cp->floating);
}

/* x[n_free, n_rhs], distance m, from the right sides, by the factor. */
static void newton_back(newton_system *s, int n_rhs, double *x) {
  s->solves += n_rhs;
  dense_solve(&s->K, n_rhs, x, s->m);
}

/* From the free unknowns of the base to all, in place; x[m]. */
static void newton_expand(const newton_system *s, double *x) {
  for (int dof = s->m - 1; dof >= 0; --dof) {
    int i = s->base.place[dof];
    x[dof] = i >= 0 ? x[i] : 0.0;
  }
}

/* du of the base's own matrix. */
static void newton_plain_step(newton_system *s) {
  for (int i = 0; i < s->base.n_free; ++i) s->du[i] = s->b[s->base.free_id[i]];
  newton_back(s, 1, s->du);
  newton_expand(s, s->du);
}

static void pattern_copy(int dim, int n, const pattern *from, pattern *to) {
  size_t nodes = n, m = nodes * dim;
  COPY(to->closed, from->closed, m);
  COPY(to->mode, from->mode, nodes);
  COPY(to->e, from->e, (m - nodes));
  COPY(to->kappa, from->kappa, nodes);
  COPY(to->free_id, from->free_id, m);
  COPY(to->place, from->place, m);
  to->n_free = from->n_free;
}

/* The guess becomes the base, without a factor yet. */
static void newton_begin(newton_system *s, const pattern *p, int full) {
  pattern_copy(s->cp->dim, s->cp->n, p, &s->base);
  s->K.n = p->n_free;
  s->K.full = full;
  s->spent = 0.0;
  s->inverse.n = 0;
  for (int i = 0; i < s->m; ++i) s->inverse.column[i] = -1;
}

/* du with springs, where the system is singular; leaves no base. */
static void newton_spring_step(newton_system *s, const pattern *p) {
  newton_begin(s, p, 1);
  fill(s, SPRING);
  dense_factor(&s->K, 0);
  newton_plain_step(s);
  s->has_base = 0;
}

/* ---- rows exchanged by an update of the factor -------------------------- */

static const double DRIFT = 0x1p-3; /* -, change of a slip direction or turning
                                       stiffness that the base allows (3-D) */

/* 1: the node slips in another direction than in the base; in 3-D a small
 * change is allowed. */
static int turned(const newton_system *s, const pattern *p, int dof) {
  int node_id = dof / s->cp->dim, tangents = s->cp->dim - 1;
  double change = 0.0, now = p->kappa[node_id], old = s->base.kappa[node_id];
  for (int k = node_id * tangents; k < (node_id + 1) * tangents; ++k)
    change = fmax(change, fabs(p->e[k] - s->base.e[k]));
  if (tangents == 1) return change != 0.0;
  double stiffness = contact_diagonal(s->cp, dof);
  return change > DRIFT || fabs(now - old) > DRIFT * (stiffness + old);
}

/* 1: the row of the unknown in the base is the one under the guess. */
static int same_row(const newton_system *s, const pattern *p, int dof) {
  const pattern *base = &s->base;
  const sparse_rows *B = s->cp->B;
  int node_id = dof / s->cp->dim;
  int free_now = p->place[dof] >= 0;
  if (free_now != (base->place[dof] >= 0)) return 0;
  if (!free_now || dof % s->cp->dim == 0) return 1;
  int now = newton_bends(s, p, node_id),
      before = newton_bends(s, base, node_id);
  if (!now || !before) return now == before;
  if (turned(s, p, dof)) return 0;
  for (int k = row_begin(B, node_id); k < row_end(B, node_id); ++k) {
    int n = B->col[k] * s->cp->dim;
    if (p->closed[n] != base->closed[n]) return 0;
  }
  return 1;
}

/* List the rows in which the guess differs from the base; returns what an
 * update costs, operations. */
static double newton_list_changes(newton_system *s, const pattern *p) {
  double fresh = 0.0, equations = 0.0, n = s->base.n_free, m = s->m;
  s->n_changed = 0;
  for (int dof = 0; dof < s->m; ++dof) {
    if (same_row(s, p, dof)) continue;
    s->changed[s->n_changed++] = dof;
    fresh += s->inverse.column[dof] < 0;
    equations += p->place[dof] >= 0;
  }
  double columns = s->inverse.n + fresh, k = s->n_changed;
  if (columns > s->inverse.capacity) return HUGE_VAL;
  return 2.0 * n * n * (fresh + 1.0 + READ) + 2.0 * m * equations * columns +
         2.0 / 3.0 * k * k * k;
}

/* Columns of X for the rows that have none. */
static void make_columns(newton_system *s) {
  size_t m = s->m;
  const pattern *p = &s->base;
  int first = s->inverse.n;
  for (int a = 0; a < s->n_changed; ++a) {
    int dof = s->changed[a];
    if (s->inverse.column[dof] >= 0) continue;
    s->inverse.column[dof] = s->inverse.n++;
    double *x = s->inverse.X + m * s->inverse.column[dof];
    CLEAR(x, m);
    if (p->place[dof] >= 0) {
      x[p->place[dof]] = 1.0;
      continue;
    }
    const double *column = s->cp->A + m * dof;
    for (int i = 0; i < p->n_free; ++i) x[i] = s->power * column[p->free_id[i]];
    if (s->K.full) newton_limit_rows(s, p, column, x);
    for (int i = 0; i < p->n_free; ++i) x[i] = -x[i];
  }
  newton_back(s, s->inverse.n - first, s->inverse.X + m * first);
  for (int c = first; c < s->inverse.n; ++c)
    newton_expand(s, s->inverse.X + m * c);
  for (int a = 0; a < s->n_changed; ++a) {
    int dof = s->changed[a];
    if (s->inverse.column[dof] >= first && p->place[dof] < 0)
      s->inverse.X[m * s->inverse.column[dof] + dof] = 1.0;
  }
}

/* Rows a .. a + n of the small system. id: places among the changed. */
static void equation_rows(newton_system *s, const pattern *p, int n,
                          const int *id) {
  int k = s->n_changed;
  for (int i = 0; i < n; ++i)
    newton_row(s, p, s->changed[id[i]], s->rows + (size_t)i * s->m);
  cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, n, s->inverse.n, s->m,
              1.0, s->rows, s->m, s->inverse.X, s->m, 0.0, s->product, CHUNK);
  for (int i = 0; i < n; ++i) {
    for (int b = 0; b < k; ++b)
      s->inverse.C[id[i] + (size_t)k * b] =
          s->product[i + CHUNK * s->inverse.column[s->changed[b]]];
    s->z[id[i]] = s->b[s->changed[id[i]]] -
                  cblas_ddot(s->m, s->rows + (size_t)i * s->m, 1, s->x, 1);
  }
}

/* The small system: matrix C, right side z. */
static void small_system(newton_system *s, const pattern *p) {
  int id[CHUNK], n = 0, k = s->n_changed;
  for (int a = 0; a < k; ++a) {
    int dof = s->changed[a];
    if (p->place[dof] >= 0) {
      id[n++] = a;
    } else {
      for (int b = 0; b < k; ++b)
        s->inverse.C[a + (size_t)k * b] =
            s->inverse.X[(size_t)s->m * s->inverse.column[s->changed[b]] + dof];
      s->z[a] = -s->x[dof];
    }
    if (n == CHUNK) {
      equation_rows(s, p, n, id);
      n = 0;
    }
  }
  if (n > 0) equation_rows(s, p, n, id);
}

/* du by exchange of the listed rows; 0: the small system is singular. */
static int newton_exchange(newton_system *s, const pattern *p) {
  int k = s->n_changed;
  make_columns(s);
  COPY(s->x, s->b, s->m);
  for (int a = 0; a < k; ++a) s->x[s->changed[a]] = 0.0;
  for (int i = 0; i < s->base.n_free; ++i) s->du[i] = s->x[s->base.free_id[i]];
  newton_back(s, 1, s->du);
  newton_expand(s, s->du);
  if (k == 0) return 1;
  COPY(s->x, s->du, s->m);
  small_system(s, p);
  if (LAPACKE_dgesv_work(LAPACK_COL_MAJOR, k, 1, s->inverse.C, k,
                         s->inverse.small_pivot, s->z, k) != 0)
    return 0;
  CLEAR(s->weight, s->inverse.n);
  for (int a = 0; a < k; ++a)
    s->weight[s->inverse.column[s->changed[a]]] = s->z[a];
  cblas_dgemv(CblasColMajor, CblasNoTrans, s->m, s->inverse.n, 1.0,
              s->inverse.X, s->m, s->weight, 1, 1.0, s->du, 1);
  for (int dof = 0; dof < s->m; ++dof)
    if (p->place[dof] < 0) s->du[dof] = 0.0;
  return 1;
}

enum { SHARE = 4 }; /* rows exchanged: at most 1/SHARE of the unknowns */
static const double SYMMETRIC = 0x1p-41; /* -, of the largest diagonal */
static const double DEFECT = 0x1p-20;   /* -, of the right side: a good solve */
static const double ROUNDING = 0x1p-44; /* -, of the forces */
static const double CHORD =
    0x1p-4; /* -, of it: residual allowed after a 3-D update */

status pattern_new(int dim, int n, pattern *p) {
  PASS_NEW_ALL(OF(p->closed, dim * n), OF(p->mode, n), OF(p->e, n * (dim - 1)),
               OF(p->kappa, n), OF(p->free_id, dim * n), OF(p->place, dim * n));
  return OK;
}

status newton_system_new(const contact_problem *cp, newton_system **out) {
  size_t m = cp->m, capacity = m / SHARE + 1;
  MAKES(newton_system, s, out);
  s->m = cp->m;
  s->n_node = cp->n;
  s->inverse.capacity = (int)capacity;
  PASS(dense_new(cp->m, &s->K));
  PASS(pattern_new(cp->dim, cp->n, &s->base));
  PASS_NEW_ALL(OF(s->inverse.column, m), OF(s->inverse.X, m * capacity),
               OF(s->inverse.C, capacity * capacity), OF(s->rows, m * CHUNK),
               OF(s->product, CHUNK * capacity), OF(s->changed, m), OF(s->b, m),
               OF(s->x, m), OF(s->du, m), OF(s->z, capacity),
               OF(s->weight, capacity), OF(s->inverse.small_pivot, capacity));
  s->power = dense_power(cp->m, cp->A);
  s->symmetric = -1;
  return OK;
}

/* 0: none. */
static uint64_t friction_hash(const sparse_rows *B) {
  if (B == NULL) return 0;
  const size_t n = B->start[B->n];
  uint64_t h = number_hash(HASH_START, B->start, (B->n + 1) * sizeof *B->start);
  h = number_hash(h, B->col, n * sizeof *B->col);
  return number_hash(h, B->val, n * sizeof *B->val);
}

void newton_system_fit(newton_system *s, const contact_problem *cp) {
  uint64_t friction = friction_hash(cp->B);
  if (s->K.full && friction != s->friction) s->has_base = 0;
  s->friction = friction;
  s->cp = cp;
}

void newton_slip(const contact_problem *cp, const double *u, int node_id,
                 double *slip) {
  slip[1] = 0.0;
  for (int k = 1; k < cp->dim; ++k) {
    int dof = node_id * cp->dim + k;
    slip[k - 1] = contact_held(cp, dof) ? 0.0 : u[dof] - contact_stick(cp, dof);
  }
}

/* ---- right side ---------------------------------------------------------- */

/* Value of a known unknown of the guess, m. */
static double known_value(const contact_problem *cp, const pattern *p,
                          int dof) {
  if (contact_held(cp, dof)) return cp->f[dof] / contact_diagonal(cp, dof);
  return p->closed[dof] ? contact_bound(cp, dof) : contact_stick(cp, dof);
}

int newton_list_known(const contact_problem *cp, pattern *p, const double *u,
                      double *du) {
  int moved = 0;
  p->n_free = 0;
  for (int dof = 0; dof < cp->m; ++dof) {
    const int known = contact_held(cp, dof) || p->closed[dof] ||
                      (dof % cp->dim > 0 && p->mode[dof / cp->dim] == STICK);
    p->place[dof] = known ? -1 : p->n_free;
    if (!known) p->free_id[p->n_free++] = dof;
    du[dof] = known ? known_value(cp, p, dof) - u[dof] : 0.0;
    moved += du[dof] != 0.0;
  }
  return moved;
}

void newton_take_known(const contact_problem *cp, const pattern *p, double *u) {
  for (int dof = 0; dof < cp->m; ++dof)
    if (p->place[dof] < 0) u[dof] = known_value(cp, p, dof);
}

/* The known unknowns into u, raw following. */
static void set_known(newton_system *s, pattern *p, double *u, double *raw) {
  const contact_problem *cp = s->cp;
  const size_t m = cp->m;
  int moved = newton_list_known(cp, p, u, s->du);
  newton_take_known(cp, p, u);
  if (SHARE * moved > cp->m) {
    contact_reaction(cp, u, raw);
    return;
  }
  for (size_t dof = 0; dof < m; ++dof)
    if (s->du[dof] != 0.0)
      cblas_daxpy(cp->m, s->du[dof], cp->A + m * dof, 1, raw, 1);
}

/* Limit under the guess, linear in the forces of the closed nodes, N. */
static double linear_limit(const contact_problem *cp, const pattern *p,
                           const double *raw, int node_id) {
  double g = cp->g0[node_id];
  if (cp->B == NULL) return g;
  for (int k = cp->B->start[node_id]; k < cp->B->start[node_id + 1]; ++k) {
    int dof = cp->B->col[k] * cp->dim;
    if (p->closed[dof]) g -= cp->B->val[k] * raw[dof];
  }
  return g;
}

double newton_load(const contact_problem *cp, const pattern *p, double power,
                   const double *u, const double *raw, double *b) {
  int dim = cp->dim;
  double largest = 0.0;
  for (int dof = 0; dof < cp->m; ++dof)
    b[dof] = p->place[dof] < 0 ? 0.0 : -raw[dof];
  for (int node_id = 0; node_id < cp->n; ++node_id) {
    if (p->mode[node_id] != SLIP) continue;
    const double *e = p->e + node_id * (dim - 1);
    double slip[2], g = linear_limit(cp, p, raw, node_id);
    newton_slip(cp, u, node_id, slip);
    const double along = dot(dim - 1, e, slip);
    for (int k = 0; k < dim - 1; ++k) {
      int dof = node_id * dim + 1 + k;
      if (p->place[dof] < 0) continue;
      b[dof] += g * e[k] - p->kappa[node_id] * (slip[k] - along * e[k]);
    }
  }
  for (int dof = 0; dof < cp->m; ++dof) {
    b[dof] *= power;
    if (!(fabs(b[dof]) <= largest)) largest = fabs(b[dof]);
  }
  return largest;
}

/* ---- a step -------------------------------------------------------------- */

/* u moved by du; raw there. */
static void move(const newton_system *s, double *u, double *raw) {
  cblas_daxpy(s->m, 1.0, s->du, 1, u, 1);
  contact_reaction(s->cp, u, raw);
}

/* Largest of |f| and diag(A) |u|, times power. */
static double force_size(const newton_system *s, const double *u) {
  double size = 0.0;
  for (size_t i = 0, m = s->m; i < m; ++i)
    size = fmax(size, fmax(fabs(s->cp->f[i]),
                           fabs(contact_diagonal(s->cp, (int)i) * u[i])));
  return s->power * size;
}

/* Move u by an update; 0: not accurate enough, u and raw are unchanged. */
static int try_update(newton_system *s, const pattern *p, double before,
                      double *u, double *raw) {
  if (!newton_exchange(s, p)) return 0;
  move(s, u, raw);
  double left = newton_load(s->cp, p, s->power, u, raw, s->b),
         may = s->cp->dim == 3 ? CHORD : DEFECT;
  if (left <= may * before + ROUNDING * force_size(s, u)) return 1;
  cblas_daxpy(s->m, -1.0, s->du, 1, u, 1);
  contact_reaction(s->cp, u, raw);
  newton_load(s->cp, p, s->power, u, raw, s->b);
  return 0;
}

/* Rows of the guess that hold friction. */
static int bent_rows(const newton_system *s, const pattern *p) {
  int n = 0;
  for (int i = 0; i < s->cp->n; ++i)
    if (newton_bends(s, p, i)) n += s->cp->dim - 1;
  return n;
}

/* The base becomes the symmetric part of the guess, where that is cheaper; 0:
 * it is not, or not positive definite. */
static int symmetric_base(newton_system *s, const pattern *p) {
  int bent = bent_rows(s, p);
  double n = p->n_free, m = s->m, k = bent;
  double update =
      2.0 * n * n * (k + 1.0 + READ) + 2.0 * m * k * k + 2.0 / 3.0 * k * k * k;
  if (!s->symmetric || bent > s->inverse.capacity ||
      newton_cost(p->n_free, 0) + update > newton_cost(p->n_free, 1))
    return 0;
  newton_begin(s, p, 0);
  for (int i = 0; i < s->cp->n; ++i)
    if (s->base.mode[i] == SLIP) s->base.mode[i] = FREE;
  s->has_base = newton_factor(s);
  return s->has_base;
}

/* Step by a new factor; 1: singular. */
static int fresh_step(newton_system *s, const pattern *p, double before,
                      double *u, double *raw) {
  int full = newton_needs_lu(s, p);
  if (full && symmetric_base(s, p)) {
    newton_list_changes(s, p);
    if (try_update(s, p, before, u, raw)) return 0;
  }
  newton_begin(s, p, full);
  s->has_base = newton_factor(s);
  if (s->has_base)
    newton_plain_step(s);
  else
    newton_spring_step(s, p);
  move(s, u, raw);
  return !s->has_base;
}

int newton_system_step(newton_system *s, pattern *p, double *u, double *raw) {
  set_known(s, p, u, raw);
  s->updated = 0;
  s->n_free = p->n_free;
  s->solves = 0;
  if (p->n_free == 0) return 0;
  if (s->symmetric < 0)
    s->symmetric = dense_is_symmetric(s->m, s->cp->A, SYMMETRIC / s->power);
  double before = newton_load(s->cp, p, s->power, u, raw, s->b);
  double cost = s->has_base ? newton_list_changes(s, p) : HUGE_VAL;
  if (s->spent + cost <= newton_cost(p->n_free, newton_needs_lu(s, p))) {
    s->spent += cost;
    s->updated = try_update(s, p, before, u, raw);
    if (s->updated) return 0;
  }
  return fresh_step(s, p, before, u, raw);
}

/* Matrix and guess of the base. */
static status keep_base(newton_system *s, archive *a) {
  pattern *p = &s->base;
  size_t m = s->m, n = s->n_node, e = m - n;
  PASS(archive_bytes(a, "closed", p->closed, m * sizeof *p->closed));
  PASS(archive_bytes(a, "mode", p->mode, n * sizeof *p->mode));
  PASS(archive_reals(a, "e", p->e, e));
  PASS(archive_reals(a, "kappa", p->kappa, n));
  PASS(archive_ints(a, "free_id", p->free_id, m));
  return archive_ints(a, "place", p->place, m);
}

status newton_system_keep(newton_system *s, archive *a) {
  pattern *p = &s->base;
  size_t m = s->m;
  PASS(archive_ints(a, "has_base", &s->has_base, 1));
  if (!s->has_base) return OK;
  PASS(archive_ints(a, "full", &s->K.full, 1));
  PASS(archive_ints(a, "n_column", &s->inverse.n, 1));
  PASS(archive_ints(a, "n_free", &p->n_free, 1));
  if (p->n_free < 0 || p->n_free > s->m || s->inverse.n < 0 ||
      s->inverse.n > s->inverse.capacity)
    RAISE(ERR_FILE, "the restart file is damaged: a factor has other sizes");
  PASS(archive_bytes(a, "friction", &s->friction, sizeof s->friction));
  PASS(archive_reals(a, "spent", &s->spent, 1));
  PASS(keep_base(s, a));
  s->K.n = p->n_free;
  PASS(archive_reals(a, "K", s->K.a, (size_t)p->n_free * p->n_free));
  PASS(archive_ints(a, "pivot", s->K.pivot, p->n_free));
  PASS(archive_ints(a, "column", s->inverse.column, m));
  return archive_reals(a, "X", s->inverse.X, m * s->inverse.n);
}

int newton_system_refresh(newton_system *s) {
  int updated = s != NULL && s->updated;
  if (updated) s->has_base = 0;
  return updated;
}

linear_work newton_system_work(const newton_system *s) {
  const double n = s->K.n;
  return (linear_work){.unknowns = s->n_free,
                       .entries = s->K.full ? n * n : n * (n + 1.0) / 2.0,
                       .solves = s->solves};
}
