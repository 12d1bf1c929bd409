/* A step by the operator (system.h). */
#include "solver/newton/system.h"

#include "solver/newton/dense.h"

#include <cblas.h>

enum {
  DIRECTIONS = 60, /* of GMRES, without a new start */
  REPEATS = 3      /* steps on the same rows that may still mend one */
};
/* What GMRES may leave of the right side, -: few digits while more than a share
 * of the rows still change. */
static const double ROUGH = 1e-3, ENOUGH = 1e-10, FEW = 1e-3;
static const double SPRING = 0x1p-36;    /* -, of the diagonal */
static const double EXHAUSTED = 0x1p-50; /* -, a direction of rounding */

struct operated_system {
  int m;
  double power;         /* of two: the diagonal times it is of order 1 */
  double *b, *x, *Ax;   /* [m] */
  double *added;        /* [dim*m] known_rows.added, of this step or before */
  int drifts;           /* 1: it may be apart */
  int exhausted;        /* 1: the last step had springs, or GMRES left more
                           than it should: not again with its factor */
  unsigned char *known; /* [m] of the last step */
  unsigned char *held;  /* [m] 1: stiffness was added to its row */
  int repeated;         /* steps on the same rows before the last one */
  int stepped;          /* 1: there was a last step */
  double enough;        /* -, of the right side, left by GMRES */
  int solves;           /* with the factor in the last step */
  struct {
    int n, *dof;            /* [m] those in which friction follows pressure */
    double *x;              /* [m] displacements by a direction */
    double *load;           /* [m] forces there, zero elsewhere */
    unsigned char *pressed; /* [m] 1: the pressure it follows */
  } slip;
  struct {
    size_t capacity; /* numbers that there is room for */
    int n;           /* directions made */
    double *V;     /* [slip.n*(n+1)] orthonormal forces in the slipping rows */
    double *H;     /* [(DIRECTIONS+1)*DIRECTIONS] Hessenberg, then its R */
    double *c, *s; /* [DIRECTIONS] rotations */
    double *g;     /* [DIRECTIONS+1] */
  } krylov;
};

status operated_system_new(const contact_problem *cp, operated_system **out) {
  const size_t m = cp->m;
  MAKES(operated_system, s, out);
  s->m = cp->m;
  s->power = power_to_one(largest_entry(m, cp->op->diagonal));
  PASS_NEW_REALS(m, &s->b, &s->x, &s->Ax);
  PASS_NEW_ALL(OF(s->added, cp->dim * m), OF(s->known, m), OF(s->held, m),
               OF(s->slip.dof, m), OF(s->slip.x, m), OF(s->slip.load, m),
               OF(s->slip.pressed, m),
               OF(s->krylov.H, (DIRECTIONS + 1) * DIRECTIONS),
               OF(s->krylov.c, DIRECTIONS), OF(s->krylov.s, DIRECTIONS),
               OF(s->krylov.g, DIRECTIONS + 1));
  return OK;
}

void operated_system_fit(operated_system *s) { s->stepped = 0; }

/* ---- friction that follows pressure -------------------------------------- */

/* What the factor has less of the turning of a slipping node. */
static double missing(const operated_system *s, const pattern *p, int node,
                      int a, int b) {
  return pattern_turning(p, node, a, b) -
         s->added[9 * node + 3 * (1 + a) + 1 + b];
}

/* Rows that differ from those of the factor: friction follows pressure in them,
 * or turns otherwise: s->slip. */
static void list_slip(operated_system *s, const contact_problem *cp,
                      const pattern *p) {
  const sparse_rows *B = cp->B;
  s->slip.n = 0;
  memset(s->slip.pressed, 0, s->m);
  for (int i = 0; i < cp->n; ++i) {
    int any = s->drifts;
    if (p->mode[i] != SLIP) continue;
    s->slip.pressed[i * cp->dim + 1] = (unsigned char)any;
    for (int k = row_begin(B, i); k < row_end(B, i); ++k) {
      const int dof = B->col[k] * cp->dim;
      if (!p->closed[dof] || B->val[k] == 0.0) continue;
      s->slip.pressed[dof] = 1;
      any = 1;
    }
    for (int dof = i * cp->dim + 1; any && dof < (i + 1) * cp->dim; ++dof)
      if (p->place[dof] >= 0) s->slip.dof[s->slip.n++] = dof;
  }
}

/* y[slip.n] += N x: e (B (A x)_n) of the closed nodes, and what the factor has
 * not of the turning. */
static void add_friction(const operated_system *s, const contact_problem *cp,
                         const pattern *p, const double *x, const double *Ax,
                         double *y) {
  const sparse_rows *B = cp->B;
  for (int t = 0; t < s->slip.n; ++t) {
    const int i = s->slip.dof[t] / cp->dim, c = s->slip.dof[t] % cp->dim - 1;
    double sum = 0.0;
    for (int k = row_begin(B, i); k < row_end(B, i); ++k) {
      const int dof = B->col[k] * cp->dim;
      if (p->closed[dof]) sum += B->val[k] * Ax[dof];
    }
    y[t] += p->e[i * (cp->dim - 1) + c] * sum;
    for (int b = 0; b < 2 && s->drifts; ++b)
      y[t] += missing(s, p, i, c, b) * x[3 * i + 1 + b];
  }
}

/* ---- GMRES --------------------------------------------------------------- */

/* Room for the directions made and two more. */
static status grow(operated_system *s) {
  const size_t n = s->slip.n, have = s->krylov.capacity;
  OWNS(s);
  if (n * (s->krylov.n + 2) <= have) return OK;
  const size_t want = n * (s->krylov.n + 10);
  double *more = memory_resize(s->krylov.V, have, want, sizeof *more);
  if (more == NULL)
    RAISE(ERR_MEMORY, "memory exhausted: %zu numbers of GMRES", want);
  s->krylov.V = more;
  s->krylov.capacity = want;
  return OK;
}

static double *direction(const operated_system *s, int j) {
  return s->krylov.V + (size_t)s->slip.n * j;
}

static double *column(const operated_system *s, int j) {
  return s->krylov.H + (size_t)j * (DIRECTIONS + 1);
}

/* w orthogonal to v[0..j]; column j of H. */
static void orthogonalise(operated_system *s, int j, double *w) {
  double *h = column(s, j);
  CLEAR(h, (DIRECTIONS + 1));
  for (int i = 0; i <= j; ++i) {
    const double *v = direction(s, i);
    h[i] = cblas_ddot(s->slip.n, v, 1, w, 1);
    cblas_daxpy(s->slip.n, -h[i], v, 1, w, 1);
  }
  h[j + 1] = cblas_dnrm2(s->slip.n, w, 1);
}

/* The combination of the directions that leaves least is added to the load, and
 * that solved for. */
static void combine(operated_system *s, const contact_problem *cp) {
  const int n = s->krylov.n;
  double *sum = direction(s, n);
  cblas_dtrsv(CblasColMajor, CblasUpper, CblasNoTrans, CblasNonUnit, n,
              s->krylov.H, DIRECTIONS + 1, s->krylov.g, 1);
  cblas_dgemv(CblasColMajor, CblasNoTrans, s->slip.n, n, 1.0, s->krylov.V,
              s->slip.n, s->krylov.g, 1, 0.0, sum, 1);
  for (int t = 0; t < s->slip.n; ++t) s->b[s->slip.dof[t]] += sum[t];
  cp->op->solve(cp->op->ctx, s->b, s->x, s->Ax);
}

/* (x, Ax), which solves the symmetric part for the right side b of size
 * "size", becomes the step: what the friction of x leaves is solved for, in the
 * slipping rows, which alone have any. */
static status gmres(operated_system *s, const contact_problem *cp,
                    const pattern *p, double size) {
  const size_t n = s->slip.n;
  double left;
  s->krylov.n = 0;
  PASS(grow(s));
  double *v = s->krylov.V;
  CLEAR(v, n);
  add_friction(s, cp, p, s->x, s->Ax, v);
  left = cblas_dnrm2(s->slip.n, v, 1);
  CLEAR(s->krylov.g, (DIRECTIONS + 1));
  size = fmax(size, left); /* a body that known rows alone move has no load */
  if (!(left > s->enough * size)) return OK;
  s->krylov.g[0] = -left;
  for (size_t i = 0; i < n; ++i) v[i] /= left;
  cp->op->set_response(cp->op->ctx, s->slip.pressed);
  CLEAR(s->slip.load, s->m);
  for (double next = 1.0; left > s->enough * size && next > EXHAUSTED &&
                          s->krylov.n < DIRECTIONS;) {
    PASS(grow(s));
    v = direction(s, s->krylov.n);
    double *w = direction(s, s->krylov.n + 1);
    for (int t = 0; t < s->slip.n; ++t) s->slip.load[s->slip.dof[t]] = v[t];
    cp->op->response(cp->op->ctx, s->slip.load, s->slip.x, s->Ax);
    COPY(w, v, n);
    add_friction(s, cp, p, s->slip.x, s->Ax, w);
    orthogonalise(s, s->krylov.n, w);
    next = cblas_dnrm2(s->slip.n, w, 1);
    left = dense_rotate(s->krylov.n, column(s, s->krylov.n), s->krylov.c,
                        s->krylov.s, s->krylov.g);
    ++s->krylov.n;
    for (size_t i = 0; i < n && next > EXHAUSTED; ++i) w[i] /= next;
  }
  if (left > s->enough * size) s->exhausted = 1;
  combine(s, cp);
  return OK;
}

/* ---- a step -------------------------------------------------------------- */

/* Stiffness that the guess adds at a node, block[dim*dim]. */
static void wanted(const contact_problem *cp, const operated_rows *rows,
                   int node, double *block) {
  const int dim = cp->dim;
  CLEAR(block, dim * dim);
  for (int a = 0; a < 2 && dim == 3 && rows->p->mode[node] == SLIP; ++a)
    for (int b = 0; b < 2; ++b)
      block[3 * (1 + a) + 1 + b] = pattern_turning(rows->p, node, a, b);
  for (int a = 0; a < dim && rows->hold != NULL; ++a)
    block[(dim + 1) * a] += rows->hold[dim * node + a];
}

/* 1: the factor has what the guess adds at a node; of one that slips only the
 * turning may be another. */
static int has_block(const operated_system *s, const operated_rows *rows,
                     int node, const double *block) {
  for (int i = 0; i < 9; ++i) {
    const int turns = i / 3 > 0 && i % 3 > 0;
    if (turns && rows->p->mode[node] == SLIP) continue;
    if (s->added[9 * node + i] != block[i]) return 0;
  }
  return 1;
}

static int is_held(const operated_rows *rows, int dof) {
  return rows->hold != NULL && rows->hold[dof] > 0.0;
}

/* 1: the same rows are known and held as in the last step, and slip in space
 * turns at most otherwise, which GMRES can add. */
static int has_rows(const operated_system *s, const contact_problem *cp,
                    const operated_rows *rows) {
  double block[9];
  if (!s->stepped || s->exhausted || cp->dim < 3) return 0;
  for (int i = 0; i < s->m; ++i)
    if (s->known[i] != (rows->p->place[i] < 0) ||
        s->held[i] != is_held(rows, i))
      return 0;
  for (int i = 0; i < cp->n; ++i) {
    wanted(cp, rows, i, block);
    if (!has_block(s, rows, i, block)) return 0;
  }
  return 1;
}

/* The rows of the guess, in which slip may turn otherwise; spring: share of the
 * diagonal. */
static status set_rows(operated_system *s, const contact_problem *cp,
                       const operated_rows *rows, double spring,
                       int *singular) {
  const known_rows known = {s->known, s->added};
  int changed = s->stepped ? 0 : s->m;
  s->drifts = spring == 0.0 && has_rows(s, cp, rows);
  for (int i = 0; i < cp->n && !s->drifts; ++i) {
    double *added = s->added + cp->dim * cp->dim * i;
    wanted(cp, rows, i, added);
    for (int a = 0; a < cp->dim; ++a)
      added[(cp->dim + 1) * a] +=
          spring * contact_diagonal(cp, cp->dim * i + a);
  }
  for (int i = 0; i < s->m; ++i) {
    const unsigned char now = rows->p->place[i] < 0;
    const unsigned char held = (unsigned char)is_held(rows, i);
    changed += s->known[i] != now || s->held[i] != held;
    s->known[i] = now;
    s->held[i] = held;
  }
  s->repeated = changed > 0 ? 0 : s->repeated + 1;
  s->enough = changed > FEW * s->m ? ROUGH : ENOUGH;
  return cp->op->set_rows(cp->op->ctx, &known, singular);
}

/* Size of the right side where the stiffness added does not carry it. */
static double size_of_load(const operated_system *s, const contact_problem *cp,
                           const double *hold) {
  double sum = 0.0;
  if (hold == NULL) return cblas_dnrm2(s->m, s->b, 1);
  for (int i = 0; i < s->m; ++i) {
    const double own = contact_diagonal(cp, i);
    sum += pow(s->b[i] * own / (own + hold[i]), 2);
  }
  return sqrt(sum);
}

/* s->x, s->Ax for the right side s->b. */
static status solve_rows(operated_system *s, const contact_problem *cp,
                         const operated_rows *rows, int *singular) {
  int held = 0;
  *singular = 0;
  PASS(set_rows(s, cp, rows, 0.0, singular));
  if (*singular) PASS(set_rows(s, cp, rows, SPRING, &held));
  s->stepped = 1;
  s->exhausted = *singular;
  cp->op->solve(cp->op->ctx, s->b, s->x, s->Ax);
  list_slip(s, cp, rows->p);
  s->krylov.n = 0;
  if (s->slip.n > 0)
    PASS(gmres(s, cp, rows->p, size_of_load(s, cp, rows->hold)));
  s->solves = 1 + s->krylov.n + (s->krylov.n > 0);
  return OK;
}

status operated_system_step(operated_system *s, const contact_problem *cp,
                            pattern *p, double *u, double *raw, int *singular) {
  const operated_rows rows = {p, NULL, s->b};
  newton_list_known(cp, p, u, s->x);
  newton_load(cp, p, s->power, u, raw, s->b);
  cblas_dscal(s->m, s->power, s->x, 1);
  PASS(solve_rows(s, cp, &rows, singular));
  cblas_daxpy(s->m, 1.0 / s->power, s->x, 1, u, 1);
  newton_take_known(cp, p, u);
  /* Steps from afar leave their rounding in a sum. */
  if (s->repeated > 0)
    contact_reaction(cp, u, raw);
  else
    cblas_daxpy(s->m, 1.0 / s->power, s->Ax, 1, raw, 1);
  return OK;
}

status operated_system_direction(operated_system *s, const contact_problem *cp,
                                 const operated_rows *rows, double *du,
                                 double *Adu, int *singular) {
  for (int i = 0; i < s->m; ++i) {
    s->b[i] = s->power * rows->b[i];
    s->x[i] = s->power * du[i];
  }
  PASS(solve_rows(s, cp, rows, singular));
  for (int i = 0; i < s->m; ++i) {
    du[i] = s->x[i] / s->power;
    Adu[i] = s->Ax[i] / s->power;
  }
  return OK;
}

int operated_system_sums(const operated_system *s) {
  return s != NULL && s->repeated == 0;
}

int operated_system_refresh(operated_system *s) {
  return s != NULL && s->repeated < REPEATS;
}

linear_work operated_system_work(const operated_system *s,
                                 const contact_problem *cp) {
  return (linear_work){.unknowns = cp->op->unknowns,
                       .entries = cp->op->entries,
                       .solves = s->solves};
}
