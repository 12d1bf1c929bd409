/* The report on an increment from its parts (theorems.h). */
#include "accuracy/theorems/theorems.h"

/*
 * The variational inequality S_i^n of CPR98 over random test fields. The convex
 * K and the functional j of a frozen limit are sums over the nodes, so fields
 * on one node at a time suffice; fields on all nodes are tried as well.
 */

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
  double *rounding;    /* [n] of r, N */
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

/* u_n, u_t without the initial penetration, which no test field can undo. */
static double lifted(const trial *s, int dof) {
  return s->u[dof] - fmin(contact_bound(s->cp, dof), 0.0);
}

static void set_scales(trial *s) {
  const contact_problem *cp = s->cp;
  double push = 0.0, f2 = 0.0, r2 = 0.0, u2 = 0.0;
  contact_product(cp->m, cp->A, s->u, s->r);
  for (int k = 0; k < cp->m; ++k) {
    double a = contact_diagonal(cp, k), v = lifted(s, k);
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

/* The inequality of node i, as far as rounding of its forces does not decide;
 * |w - u|^2 of the diagonal is added. */
static double part(const trial *s, int i, double *square) {
  const contact_problem *cp = s->cp;
  double sum = 0.0;
  for (int k = 0; k < cp->dim; ++k) {
    int dof = cp->dim * i + k;
    double d = s->w[dof] - s->u[dof];
    sum += s->r[dof] * d + s->rounding[i] * fabs(d);
    *square += contact_diagonal(cp, dof) * d * d;
  }
  if (cp->g0 != NULL && !contact_has_side(cp, i))
    sum += contact_node_limit(cp, s->r, i) *
           (contact_slip_of(cp, s->w, i) - contact_slip_of(cp, s->u, i));
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
  for (int i = 0; i < s->cp->n; ++i)
    for (int k = 0; k < FIELDS_A_NODE; ++k) {
      double square = 0.0;
      set_node(s, i, moves[k % PATTERNS]);
      double value = part(s, i, &square);
      count(s, value, square);
    }
}

/* u itself must be in K. */
static void test_penetration(trial *s) {
  const contact_problem *cp = s->cp;
  for (int k = 0; k < cp->m; ++k) {
    double deep = s->u[k] - contact_bound(cp, k);
    if (contact_held(cp, k) || !(deep > 0.0)) continue;
    deep *= sqrt(contact_diagonal(cp, k));
    s->least = fmin(s->least, -deep / fmax(s->whole, deep));
  }
}

status inequality_least(const contact_problem *cp, const double *u,
                        double *least, int *fields) {
  OWNED double *r = NULL, *w = NULL, *rounding = NULL;
  *least = 0.0;
  *fields = 0;
  if (cp->m == 0) return OK;
  PASS_NEW_REALS(cp->m, &r, &w);
  PASS_NEW(rounding, cp->n);
  trial s = {.cp = cp, .u = u, .r = r, .w = w, .least = HUGE_VAL, .seed = 1998};
  s.rounding = rounding;
  COPY(w, u, cp->m);
  set_scales(&s);
  contact_roundings(cp, u, r, rounding);
  try_nodes(&s);
  for (int k = 0; k < FIELDS_OF_ALL; ++k) {
    double value = 0.0, square = 0.0;
    for (int i = 0; i < s.cp->n; ++i) {
      set_node(&s, i, moves[(i + k) % PATTERNS]);
      value += part(&s, i, &square);
    }
    count(&s, value, square);
  }
  test_penetration(&s);
  *least = s.least < HUGE_VAL ? s.least : 0.0;
  *fields = s.n;
  return OK;
}

struct theorems {
  energy_norm norm;
  double *diagonal;   /* [m] of A, to recognise it */
  double *entries;    /* [n_entry] of B, the same */
  int n_entry, fresh; /* fresh: the eigenvalues are not known */
  state_before before;
  int seen;                   /* 1: a state has been evaluated */
  int n_contact;              /* rows of the report */
  theorems_contact *contacts; /* [n_contact] the last one is all */
  double start;
  int has_start;
  double fastest; /* L of the step so far, 1/s */
};

static const double ROUNDING = 1e-8; /* -, of times and factors */

const char *mu_regime_text(mu_regime regime) {
  static const char *const text[] = {
      "above 1/C_h; nothing slides", "unique: under 1/C_h",
      "between: above 1/C_h, contracts", "above both: does not contract"};
  return text[regime];
}

status theorems_new(theorems **out) {
  PASS_NEW(*out, 1);
  return OK;
}

static void forget_friction(theorems *t) {
  RELEASE(t->entries, t->contacts);
  t->entries = NULL;
  t->contacts = NULL;
  t->n_entry = t->n_contact = 0;
}

static int same_matrix(const theorems *t, const contact_problem *cp) {
  if (t->diagonal == NULL || t->norm.m != cp->m || t->norm.A != cp->A) return 0;
  for (int i = 0; i < cp->m; ++i)
    if (t->diagonal[i] != contact_diagonal(cp, i)) return 0;
  return 1;
}

static status know_matrix(theorems *t, const contact_problem *cp) {
  t->fresh = !same_matrix(t, cp);
  if (!t->fresh) return OK;
  energy_norm_free(&t->norm);
  FORGET(t->diagonal);
  forget_friction(t);
  state_before_free(&t->before);
  PASS_NEW(t->diagonal, cp->m);
  for (int i = 0; i < cp->m; ++i) t->diagonal[i] = contact_diagonal(cp, i);
  return energy_norm_new(cp->m, cp->A, &t->norm);
}

static int count_entries(const contact_problem *cp) {
  return cp->B == NULL ? 0 : cp->B->start[cp->n];
}

static int same_friction(const theorems *t, const contact_problem *cp) {
  size_t size = count_entries(cp) * sizeof *t->entries;
  if (t->contacts == NULL || t->n_entry != count_entries(cp)) return 0;
  return size == 0 || memcmp(t->entries, cp->B->val, size) == 0;
}

/* 1 if a node of the contact has a limit that follows pressure; keep[n] marks
 * its nodes. */
static int mark_contact(const theorems_scene *s, const contact_problem *cp,
                        int contact_id, unsigned char *keep) {
  int any = 0;
  for (int i = 0; i < cp->n; ++i) {
    keep[i] = s->contact_id[i] == contact_id;
    if (!keep[i] || cp->B == NULL) continue;
    for (int e = cp->B->start[i]; e < cp->B->start[i + 1]; ++e)
      any |= cp->B->val[e] != 0.0;
  }
  return any;
}

static void set_limit(theorems_contact *row) {
  row->limit = row->mu > 0.0 ? row->mu / row->factor : NAN;
}

/* Constants of every contact with friction, and of all. */
static status know_friction(theorems *t, const theorems_scene *s,
                            const frozen_problem *p) {
  theorems_contact all = {.contact_id = -1};
  if (same_friction(t, &p->cp)) return OK;
  OWNED_NEW(unsigned char, keep, p->cp.n);
  forget_friction(t);
  t->n_entry = count_entries(&p->cp);
  PASS_NEW_ALL(OF(t->entries, t->n_entry), OF(t->contacts, s->n_contact + 1));
  if (t->n_entry > 0) COPY(t->entries, p->cp.B->val, t->n_entry);
  PASS(friction_constants(&p->cp, &t->norm, 1, &all));
  for (int c = 0; c < s->n_contact; ++c) {
    theorems_contact row = {.contact_id = c, .mu = s->mu[c]};
    if (!mark_contact(s, &p->cp, c, keep)) continue;
    all.mu = fmax(all.mu, row.mu);
    OWNED_PARTS(frozen_problem, part,
                frozen_new(&p->cp, p->r, keep, NULL, &part));
    PASS(friction_constants(&part.cp, &t->norm, 0, &row));
    set_limit(&row);
    t->contacts[t->n_contact++] = row;
  }
  set_limit(&all);
  t->contacts[t->n_contact++] = all;
  return OK;
}

static mu_regime regime_of(const theorems_contact *row) {
  if (row->factor < 1.0) return MU_UNDER;
  if (row->rate == 0.0) return MU_FREE;
  return row->rate < 1.0 ? MU_BETWEEN : MU_ABOVE;
}

/* The measured rate of one row, the limits of other contacts fixed. */
static status measure(const theorems_scene *s, const frozen_problem *p,
                      unsigned char *keep, theorems_contact *row) {
  row->rate = 0.0;
  memset(keep, 1, p->cp.n);
  if (row->contact_id >= 0) mark_contact(s, &p->cp, row->contact_id, keep);
  OWNED_PARTS(frozen_problem, part,
              frozen_new(&p->cp, p->r, keep, NULL, &part));
  if (p->cp.B != NULL)
    PASS(contraction_limit(&part.cp, s->u, p->r, &row->rate));
  row->suggested = row->rate > 0.0 ? row->mu / row->rate : HUGE_VAL;
  row->regime = regime_of(row);
  return OK;
}

/* With one contact the row of all contacts is the same. */
static status measure_contacts(theorems *t, const theorems_scene *s,
                               const frozen_problem *p) {
  OWNED_NEW(unsigned char, keep, p->cp.n);
  for (int k = 0; k < t->n_contact; ++k) {
    if (t->n_contact == 2 && k == 0) continue;
    PASS(measure(s, p, keep, &t->contacts[k]));
  }
  if (t->n_contact == 2) {
    theorems_contact *only = t->contacts, *all = t->contacts + 1;
    only->rate = all->rate;
    only->suggested = all->suggested;
    only->regime = regime_of(only);
  }
  return OK;
}

static status check_bounds(theorems *t, const theorems_scene *s,
                           const frozen_problem *p, theorems_report *out) {
  const theorems_contact *all = &t->contacts[t->n_contact - 1];
  const char *why = NULL;
  if (t->norm.inverse == NULL || t->norm.dual.n_kernel > 0)
    why = "contact alone holds a body, loads have no norm";
  else if (!(all->factor < 1.0))
    why = "mu is not under 1/C_h";
  out->total.why = out->change.why = why;
  if (why != NULL) return OK;
  PASS(bound_total(&p->cp, s->u, all, &t->norm, &out->total));
  if (s->alone)
    out->change.why = "no increment";
  else if (t->before.known == 0)
    out->change.why = "the matrix is new";
  else
    PASS(bound_change(&p->cp, s->u, &t->before, all, &t->norm, &out->change));
  return OK;
}

status theorems_start(theorems *t, const theorems_scene *s) {
  OWNS(t);
  int fields;
  OWNED_PARTS(frozen_problem, p, frozen_new(s->cp, s->r, NULL, s->given, &p));
  PASS(know_matrix(t, s->cp));
  PASS(inequality_least(&p.cp, s->u, &t->start, &fields));
  PASS(state_before_keep(&p.cp, s->u, p.r, &t->before));
  t->has_start = t->seen = 1;
  return OK;
}

status theorems_check(theorems *t, const theorems_scene *s,
                      theorems_report *out) {
  OWNS(t);
  *out = (theorems_report){.asked = 1, .has_start = t->has_start};
  OWNED_PARTS(frozen_problem, p, frozen_new(s->cp, s->r, NULL, s->given, &p));
  PASS(know_matrix(t, s->cp));
  if (!t->seen) t->before.known = -1;
  out->fresh = t->contacts == NULL;
  PASS(know_friction(t, s, &p));
  PASS(measure_contacts(t, s, &p));
  PASS(check_bounds(t, s, &p, out));
  PASS(inequality_least(&p.cp, s->u, &out->inequality, &out->n_field));
  out->inequality_violated = !(out->inequality >= -s->tol);
  out->start = t->start;
  out->contacts = t->contacts;
  out->n_contact = t->n_contact == 2 ? 1 : t->n_contact;
  if (t->contacts[t->n_contact - 1].factor == 0.0) out->n_contact = 0;
  out->violated =
      out->total.violated || out->change.violated || out->inequality_violated;
  PASS(state_before_keep(&p.cp, s->u, p.r, &t->before));
  t->seen = 1;
  return OK;
}

void theorems_path_learn(theorems *t, double theta, double dt, double span,
                         theorems_path *p) {
  p->speed = p->bound / (theta * dt);
  p->longest = p->speed > 0.0 ? 1.0 / (theta * p->speed) : HUGE_VAL;
  p->span = span;
  if (!(span > dt * (1.0 + ROUNDING))) t->fastest = 0.0;
  t->fastest = fmax(t->fastest, p->speed);
  p->passes = theorems_passes(t->fastest * span);
  p->violated = p->why == NULL && !(p->rate <= p->bound * (1.0 + ROUNDING));
}
