/*
 * The variational inequality S_i^n of CPR98 over random test fields. The convex
 * K and the functional j of a frozen limit are sums over the nodes, so fields
 * on one node at a time suffice; fields on all nodes are tried as well.
 */
#include "accuracy/theorems/theorems.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

enum { FIELDS_OF_ALL = 32 };

/* Components that a test field changes at a node. Where friction or pressure
 * dominate, a defect of the other shows only if the dominant one is
 * unchanged. */
typedef enum { ALONG_N, ONTO_BOUND, ALONG_T, TO_REST, ANYWHERE } move;
static const move moves[] = {ONTO_BOUND, ALONG_N,  ALONG_N,  ALONG_N,
                             ALONG_N,    TO_REST,  ALONG_T,  ALONG_T,
                             ALONG_T,    ALONG_T,  ALONG_T,  ANYWHERE,
                             ANYWHERE,   ANYWHERE, ANYWHERE, ANYWHERE};
enum { PATTERNS = sizeof moves / sizeof *moves, FIELDS_A_NODE = 80 };

typedef struct trial {
  const contact_problem *cp;
  const double *u;
  double *r, *w;       /* [m] A u - f; test field */
  double size;         /* of test fields, m */
  double force, whole; /* (|f| + |r|), |u|: norms of the diagonal */
  unsigned long long seed;
  double least;
  int n;
} trial;

/* Uniform in [-1, 1[: the multiplier of Knuth (MMIX), upper bits. */
static double any(trial *s) {
  s->seed = s->seed * 6364136223846793005ULL + 1442695040888963407ULL;
  return ldexp((double)(s->seed >> 11), -52) - 1.0;
}

static double diagonal(const contact_problem *cp, int dof) {
  return contact_diagonal(cp, dof);
}

/* u_n, u_t without the initial penetration, which no test field can undo. */
static double lifted(const trial *s, int dof) {
  return s->u[dof] - fmin(contact_bound(s->cp, dof), 0.0);
}

static void set_scales(trial *s) {
  const contact_problem *cp = s->cp;
  double push = 0.0, f2 = 0.0, r2 = 0.0, u2 = 0.0;
  contact_product(cp->m, cp->A, s->u, s->r);
  for (int k = 0; k < cp->m; ++k) {
    double a = diagonal(cp, k), v = lifted(s, k);
    s->r[k] -= cp->f[k];
    f2 += cp->f[k] * cp->f[k] / a;
    r2 += s->r[k] * s->r[k] / a;
    u2 += v * v * a;
    s->size = fmax(s->size, fabs(v));
    push = fmax(push, fabs(cp->f[k]) / a);
  }
  if (!(s->size > 0.0)) s->size = push;
  s->force = sqrt(f2) + sqrt(r2);
  s->whole = sqrt(u2);
}

/* |v_t - ut0| of a node with friction. */
static double slip_size(const contact_problem *cp, const double *v, int i) {
  double size = 0.0;
  for (int k = 1; k < cp->dim; ++k) {
    int dof = cp->dim * i + k;
    if (!contact_held(cp, dof))
      size = hypot(size, v[dof] - contact_stick(cp, dof));
  }
  return size;
}

/* A field in K at a node. Sizes spread over four powers of ten: along a disc of
 * friction a small defect shows in small motions only. */
static void set_node(trial *s, int i, move how) {
  const contact_problem *cp = s->cp;
  double size = s->size * exp(5.0 * (any(s) - 1.0));
  for (int k = 0; k < cp->dim; ++k) {
    int dof = cp->dim * i + k;
    double bound = contact_bound(cp, dof), w = s->u[dof] + size * any(s);
    int tangential = k > 0 && !(bound < HUGE_VAL);
    s->w[dof] = s->u[dof];
    if (contact_held(cp, dof)) continue;
    if (tangential ? how < ALONG_T : how == ALONG_T || how == TO_REST) {
      s->w[dof] = fmin(bound, s->u[dof]);
      continue;
    }
    if (how == ONTO_BOUND && bound < HUGE_VAL) w = bound;
    if (how == TO_REST && cp->g0 != NULL) w = contact_stick(cp, dof);
    s->w[dof] = fmin(bound, w);
  }
}

/* The inequality of node i; |w - u|^2 of the diagonal is added. */
static double part(const trial *s, int i, double *square) {
  const contact_problem *cp = s->cp;
  double sum = 0.0;
  for (int k = 0; k < cp->dim; ++k) {
    int dof = cp->dim * i + k;
    double d = s->w[dof] - s->u[dof];
    sum += s->r[dof] * d;
    *square += diagonal(cp, dof) * d * d;
  }
  if (cp->g0 != NULL && !contact_has_side(cp, i))
    sum += contact_node_limit(cp, s->r, i) *
           (slip_size(cp, s->w, i) - slip_size(cp, s->u, i));
  return sum;
}

static void count(trial *s, double value, double square) {
  double scale = s->force * (sqrt(square) + s->whole);
  ++s->n;
  if (isnan(value) || isnan(scale))
    s->least = -HUGE_VAL;
  else if (scale > 0.0)
    s->least = fmin(s->least, value / scale);
}

static void try_nodes(trial *s) {
  const contact_problem *cp = s->cp;
  for (int i = 0; i < cp->n; ++i)
    for (int k = 0; k < FIELDS_A_NODE; ++k) {
      double square = 0.0;
      set_node(s, i, moves[k % PATTERNS]);
      double value = part(s, i, &square);
      count(s, value, square);
    }
}

static void try_all(trial *s) {
  for (int k = 0; k < FIELDS_OF_ALL; ++k) {
    double value = 0.0, square = 0.0;
    for (int i = 0; i < s->cp->n; ++i) {
      set_node(s, i, moves[(i + k) % PATTERNS]);
      value += part(s, i, &square);
    }
    count(s, value, square);
  }
}

/* u itself must be in K. */
static void test_penetration(trial *s) {
  const contact_problem *cp = s->cp;
  for (int k = 0; k < cp->m; ++k) {
    double deep = s->u[k] - contact_bound(cp, k);
    if (contact_held(cp, k) || !(deep > 0.0)) continue;
    deep *= sqrt(diagonal(cp, k));
    s->least = fmin(s->least, -deep / fmax(s->whole, deep));
  }
}

status inequality_least(const contact_problem *cp, const double *u,
                        double *least, int *fields) {
  OWNED double *r = NULL, *w = NULL;
  *least = 0.0;
  *fields = 0;
  if (cp->m == 0) return OK;
  PASS_NEW_REALS(cp->m, &r, &w);
  trial s = {.cp = cp, .u = u, .r = r, .w = w, .least = HUGE_VAL, .seed = 1998};
  memcpy(w, u, (size_t)cp->m * sizeof *u);
  set_scales(&s);
  try_nodes(&s);
  try_all(&s);
  test_penetration(&s);
  *least = s.least < HUGE_VAL ? s.least : 0.0;
  *fields = s.n;
  return OK;
}
