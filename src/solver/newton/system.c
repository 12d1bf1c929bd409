/* A step: by the kept factor, or by a new one (system.h). */
#include "solver/newton/parts.h"

#include "base/memory.h"

#include <cblas.h>
#include <math.h>
#include <string.h>

enum { SHARE = 4 }; /* rows exchanged: at most 1/SHARE of the unknowns */
static const double SYMMETRIC = 0x1p-41; /* -, of the largest diagonal        */
static const double DEFECT = 0x1p-20;   /* -, of the right side: a good solve */
static const double ROUNDING = 0x1p-44; /* -, of the forces                   */
static const double CHORD = 0x1p-4; /* -, of it: what a 3-D update may leave  */

status pattern_new(int dim, int n, pattern *p) {
  PASS_NEW(p->closed, dim * n);
  PASS_NEW(p->mode, n);
  PASS_NEW(p->e, n * (dim - 1));
  PASS_NEW(p->kappa, n);
  PASS_NEW(p->free_id, dim * n);
  PASS_NEW(p->place, dim * n);
  return OK;
}

void pattern_free(pattern *p) {
  RELEASE(p->closed, p->mode, p->e, p->kappa, p->free_id, p->place);
}

void pattern_copy(int dim, int n, const pattern *from, pattern *to) {
  size_t nodes = (size_t)n, m = nodes * (size_t)dim;
  memcpy(to->closed, from->closed, m * sizeof *to->closed);
  memcpy(to->mode, from->mode, nodes * sizeof *to->mode);
  memcpy(to->e, from->e, (m - nodes) * sizeof *to->e);
  memcpy(to->kappa, from->kappa, nodes * sizeof *to->kappa);
  memcpy(to->free_id, from->free_id, m * sizeof *to->free_id);
  memcpy(to->place, from->place, m * sizeof *to->place);
  to->n_free = from->n_free;
}

void newton_system_free(newton_system *s) {
  if (s == NULL) return;
  void *const blocks[] = {s->column,  s->X,       s->C,      s->rows,
                          s->product, s->changed, s->b,      s->x,
                          s->du,      s->z,       s->weight, s->small_pivot};
  for (size_t i = 0; i < sizeof blocks / sizeof *blocks; ++i)
    memory_free(blocks[i]);
  dense_free(&s->K);
  pattern_free(&s->base);
  memory_free(s);
}

status newton_system_new(const contact_problem *cp, newton_system **out) {
  status st = OK;
  newton_system *s = NULL;
  size_t m = (size_t)cp->m, room = m / SHARE + 1;
  NEW(s, 1);
  s->m = cp->m;
  s->n_node = (size_t)cp->n;
  s->room = (int)room;
  TRY(dense_new(cp->m, &s->K));
  TRY(pattern_new(cp->dim, cp->n, &s->base));
  NEW(s->column, m);
  NEW(s->X, m * room);
  NEW(s->C, room * room);
  NEW(s->rows, m * CHUNK);
  NEW(s->product, CHUNK * room);
  NEW(s->changed, m);
  NEW(s->b, m);
  NEW(s->x, m);
  NEW(s->du, m);
  NEW(s->z, room);
  NEW(s->weight, room);
  NEW(s->small_pivot, room);
  s->power = dense_power(cp->m, cp->A);
  s->symmetric = -1;
  *out = s;
  s = NULL;
done:
  newton_system_free(s);
  return st;
}

/* FNV-1a of B; 0: none. */
static uint64_t friction_hash(const contact_problem *cp) {
  const sparse_rows *B = cp->B;
  uint64_t h = 1469598103934665603u, bits;
  if (B == NULL) return 0;
  for (int i = 0; i < B->n; ++i) {
    h = (h ^ (uint64_t)B->start[i + 1]) * 1099511628211u;
    for (int k = B->start[i]; k < B->start[i + 1]; ++k) {
      memcpy(&bits, &B->val[k], sizeof bits);
      h = (h ^ (uint64_t)B->col[k]) * 1099511628211u;
      h = (h ^ (bits ^ bits >> 32)) * 1099511628211u;
    }
  }
  return h;
}

void newton_system_fit(newton_system *s, const contact_problem *cp) {
  uint64_t friction = friction_hash(cp);
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

/* The known unknowns into u, raw following; the free ones are listed. */
static void set_known(newton_system *s, pattern *p, double *u, double *raw) {
  const contact_problem *cp = s->cp;
  size_t m = (size_t)cp->m;
  int moved = 0;
  p->n_free = 0;
  for (int dof = 0; dof < cp->m; ++dof) {
    int known = 1;
    double to = u[dof];
    if (contact_held(cp, dof))
      to = cp->f[dof] / cp->A[(size_t)dof * m + (size_t)dof];
    else if (p->closed[dof])
      to = contact_bound(cp, dof);
    else if (dof % cp->dim > 0 && p->mode[dof / cp->dim] == STICK)
      to = contact_stick(cp, dof);
    else
      known = 0;
    p->place[dof] = known ? -1 : p->n_free;
    if (!known) p->free_id[p->n_free++] = dof;
    s->du[dof] = to - u[dof];
    moved += s->du[dof] != 0.0;
    u[dof] = to;
  }
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

/* b, times power: minus what each free row misses at the present u. Returns the
 * largest. */
static double load(newton_system *s, const pattern *p, const double *u,
                   const double *raw) {
  const contact_problem *cp = s->cp;
  int dim = cp->dim;
  double largest = 0.0;
  for (int dof = 0; dof < cp->m; ++dof)
    s->b[dof] = p->place[dof] < 0 ? 0.0 : -raw[dof];
  for (int node_id = 0; node_id < cp->n; ++node_id) {
    if (p->mode[node_id] != SLIP) continue;
    const double *e = p->e + node_id * (dim - 1);
    double slip[2], along = 0.0, g = linear_limit(cp, p, raw, node_id);
    newton_slip(cp, u, node_id, slip);
    for (int k = 0; k < dim - 1; ++k) along += e[k] * slip[k];
    for (int k = 0; k < dim - 1; ++k) {
      int dof = node_id * dim + 1 + k;
      if (p->place[dof] < 0) continue;
      s->b[dof] += g * e[k] - p->kappa[node_id] * (slip[k] - along * e[k]);
    }
  }
  for (int dof = 0; dof < cp->m; ++dof) {
    s->b[dof] *= s->power;
    if (!(fabs(s->b[dof]) <= largest)) largest = fabs(s->b[dof]);
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
  for (size_t i = 0, m = (size_t)s->m; i < m; ++i)
    size =
        fmax(size, fmax(fabs(s->cp->f[i]), fabs(s->cp->A[i * m + i] * u[i])));
  return s->power * size;
}

/* Move u by an update; 0: not good enough, u and raw are as before. */
static int try_update(newton_system *s, const pattern *p, double before,
                      double *u, double *raw) {
  if (!newton_exchange(s, p)) return 0;
  move(s, u, raw);
  double left = load(s, p, u, raw), may = s->cp->dim == 3 ? CHORD : DEFECT;
  if (left <= may * before + ROUNDING * force_size(s, u)) return 1;
  cblas_daxpy(s->m, -1.0, s->du, 1, u, 1);
  contact_reaction(s->cp, u, raw);
  load(s, p, u, raw);
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
  if (!s->symmetric || bent > s->room ||
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
  const contact_problem *cp = s->cp;
  set_known(s, p, u, raw);
  s->updated = 0;
  if (p->n_free == 0) return 0;
  if (s->symmetric < 0)
    s->symmetric = dense_is_symmetric(s->m, cp->A, SYMMETRIC / s->power);
  double before = load(s, p, u, raw);
  double cost = s->has_base ? newton_list_changes(s, p) : HUGE_VAL;
  if (s->spent + cost <= newton_cost(p->n_free, newton_needs_lu(s, p))) {
    s->spent += cost;
    s->updated = try_update(s, p, before, u, raw);
    if (s->updated) return 0;
  }
  return fresh_step(s, p, before, u, raw);
}

/* What the base was made for. */
static status keep_base(newton_system *s, archive *a) {
  pattern *p = &s->base;
  size_t m = (size_t)s->m, n = s->n_node, e = m - n;
  PASS(archive_bytes(a, "closed", p->closed, m * sizeof *p->closed));
  PASS(archive_bytes(a, "mode", p->mode, n * sizeof *p->mode));
  PASS(archive_reals(a, "e", p->e, e));
  PASS(archive_reals(a, "kappa", p->kappa, n));
  PASS(archive_ints(a, "free_id", p->free_id, m));
  return archive_ints(a, "place", p->place, m);
}

status newton_system_keep(newton_system *s, archive *a) {
  pattern *p = &s->base;
  size_t m = (size_t)s->m;
  PASS(archive_ints(a, "has_base", &s->has_base, 1));
  if (!s->has_base) return OK;
  PASS(archive_ints(a, "full", &s->K.full, 1));
  PASS(archive_ints(a, "n_column", &s->n_column, 1));
  PASS(archive_ints(a, "n_free", &p->n_free, 1));
  if (p->n_free < 0 || p->n_free > s->m || s->n_column < 0 ||
      s->n_column > s->room)
    RAISE(ERR_FILE, "the restart file is damaged: a factor has other sizes");
  PASS(archive_bytes(a, "friction", &s->friction, sizeof s->friction));
  PASS(archive_reals(a, "spent", &s->spent, 1));
  PASS(keep_base(s, a));
  s->K.n = p->n_free;
  PASS(archive_reals(a, "K", s->K.a, (size_t)p->n_free * (size_t)p->n_free));
  PASS(archive_ints(a, "pivot", s->K.pivot, (size_t)p->n_free));
  PASS(archive_ints(a, "column", s->column, m));
  return archive_reals(a, "X", s->X, m * (size_t)s->n_column);
}

int newton_system_refresh(newton_system *s) {
  int updated = s != NULL && s->updated;
  if (updated) s->has_base = 0;
  return updated;
}
