/*
 * The error of a goal is at most off = |error| + band + |error of the solver|,
 * the first two twice where too much of them comes from the ends of contact
 * (at those of supports the band is wide enough): a
 * pass reaches its target if off is below it.
 *
 * The band goes like the sum of m = |e_u| |e_y| over the elements, which is of
 * the second order in their length: the sizes are those of space_sizes with
 * sqrt(m) in the place of eta, those for the energy norm where there is no m
 * yet. Meshes for the energy norm need 1.2 to 3 times the unknowns for the same
 * error, for the friction force of the block too (measured with |error| +
 * band), so none is taken for its cancelling. The mesh of the next pass has the
 * smallest size that any goal requires.
 */
#include "program/job.h"

static const double AIM = 0.93;  /* -, of the target */
static const double GAIN = 0.95; /* -, of the error, or a mesh had no effect */
static const double BLIND = 0.5; /* -, of the error, without an estimate */
static const double FAR = 0.1;   /* -, of the error, or it is near */
static const double NEAR = 0.5;  /* -, the same: nothing becomes coarser */
static const double TIP = 3.0, FEW = 0.1; /* -, see least_length */
static const double ROUNDING = 1e-9;      /* -, of the error */
enum { GROWN = 3 };                       /* -, of the nodes: a mesh is finer */
enum { BLIND_PASSES = 3 };                /* without one at all, at most */
static const double ENDS = 2.0; /* -, of an estimate that is not reliable for
                                   the ends of contact */

struct aims {
  int n, n_pass; /* goals */
  int all;       /* 1: goals without a target count too */
  int counts;    /* 1: some goal counts; 0: they are only shown */
  double least;  /* -, largest off over its target, least of all passes */
  int in_vain;   /* passes since */
  int nodes, least_nodes;  /* of the mesh, of that with the least */
  int closed, most_closed; /* contact nodes; before */
  pass_goal *rows;         /* [MAX_PASS_ROWS*n] */
  double *product;         /* [n*n_elem] of the last increment */
  int *contact;            /* [n_node] 1 + its contact, 0: none; there */
  double *gap;             /* [n_node] m, negative: closed; there */
};

status aims_new(const model *m, int all, aims **out) {
  *out = NULL;
  if (m->n.goal == 0) return OK;
  MAKES(aims, a, out);
  a->all = all;
  a->counts = all || model_targeted_goal(m) != NULL;
  a->n = m->n.goal;
  a->least = HUGE_VAL;
  PASS_NEW(a->rows, MAX_PASS_ROWS * a->n);
  return OK;
}

static pass_goal *last_row(const aims *a, int i) {
  return &a->rows[(a->n_pass - 1) * a->n + i];
}

const pass_goal *aims_rows(const aims *a) { return a != NULL ? a->rows : NULL; }

status aims_begin(aims *a, const mesh *msh) {
  if (a == NULL) return OK;
  OWNS(a);
  FORGET(a->product);
  FORGET(a->contact);
  FORGET(a->gap);
  ++a->n_pass;
  a->nodes = msh->n_node;
  if (a->closed > a->most_closed) a->most_closed = a->closed;
  if (!a->counts) return OK;
  PASS_NEW_ALL(OF(a->product, (size_t)a->n * msh->n_elem),
               OF(a->contact, msh->n_node), OF(a->gap, msh->n_node));
  return OK;
}

static void see_contact(aims *a, const state_contacts *c) {
  const contact_surface *s = c->surface;
  a->closed = c->n_slip + c->n_stick;
  for (int i = 0; s != NULL && i < s->n; ++i) {
    a->contact[s->node_id[i]] = 1 + s->contact_id[i];
    a->gap[s->node_id[i]] = c->contact[i] != CONTACT_OPEN ? -1.0 : c->gap[i];
  }
}

void aims_see(aims *a, const mesh *msh, const state *s) {
  if (a == NULL) return;
  for (int i = 0; i < a->n; ++i) last_row(a, i)->found = s->errors.goals[i];
  if (!a->counts) return;
  COPY(a->product, s->errors.goal_products, (size_t)a->n * msh->n_elem);
  see_contact(a, &s->contacts);
}

int aims_count(const aims *a) { return a != NULL && a->counts; }

static int is_at_end(const pass_goal *g) {
  return g->found.verdict == GOAL_CONTACT_END ||
         g->found.verdict == GOAL_SUPPORT_END;
}

static int is_estimate(const pass_goal *g) {
  return g->found.verdict == GOAL_RELIABLE ||
         g->found.verdict == GOAL_CANCELS || g->found.verdict == GOAL_FRONT ||
         g->found.verdict == GOAL_FEW_ELEMENTS ||
         g->found.verdict == GOAL_COARSE || g->found.verdict == GOAL_LOCKED ||
         is_at_end(g);
}

/* 1: a finer mesh may have an estimate. */
static int may_have_estimate(const pass_goal *g) {
  return is_estimate(g) || g->found.verdict == GOAL_FEW_NODES ||
         g->found.verdict == GOAL_NO_SLIP || g->found.verdict == GOAL_NO_ZONE ||
         g->found.verdict == GOAL_NO_FACTOR;
}

static int is_met(const goal_card *goal, const pass_goal *g) {
  return !(goal->target > 0.0) || (is_estimate(g) && g->off <= g->allowed);
}

int aims_are_met(const aims *a, const model *m) {
  int met = 1;
  for (int i = 0; a != NULL && i < a->n; ++i)
    met &= is_met(&m->accuracy.goals[i], last_row(a, i));
  return met;
}

static double sum_of(const goal_result *r, double factor) {
  return factor * (fabs(r->error) + r->band) + fabs(r->solver);
}

void aims_evaluate(aims *a, const model *m) {
  double most = 0.0;
  if (a == NULL) return;
  for (int i = 0; i < a->n; ++i) {
    const goal_card *goal = &m->accuracy.goals[i];
    pass_goal *g = last_row(a, i);
    const goal_result *r = &g->found;
    g->off = sum_of(r, r->verdict == GOAL_CONTACT_END ? ENDS : 1.0);
    g->allowed = goal->in_percent
                     ? goal->target / 100.0 * fabs(r->value + r->error)
                     : goal->target;
    if (goal->target > 0.0)
      most = fmax(most, isnan(g->off) ? HUGE_VAL : g->off / g->allowed);
  }
  /* Zones that nodes come to have an estimate in the end. */
  const int grows =
      isinf(most) && 2 * a->closed >= 3 * a->most_closed && a->closed > 0;
  a->in_vain = most >= GAIN * a->least && !grows ? a->in_vain + 1 : 0;
  if (a->in_vain == 0) a->least_nodes = a->nodes;
  a->least = fmin(a->least, most);
}

/* One pass tells nothing, nor do those of a mesh that has hardly grown. */
int aims_stand_still(const aims *a) {
  if (!aims_count(a) || a->in_vain < 2) return 0;
  if (a->in_vain > BLIND_PASSES) return 1;
  return isfinite(a->least) && a->nodes >= GROWN * a->least_nodes;
}

void aims_check(const aims *a, const model *m, int last, char *why,
                size_t size) {
  why[0] = '\0';
  for (int i = 0; a != NULL && i < a->n && why[0] == '\0'; ++i) {
    const goal_card *goal = &m->accuracy.goals[i];
    const pass_goal *g = last_row(a, i);
    const double value = fabs(g->found.value + g->found.error);
    if (!(goal->target > 0.0)) continue;
    if (last ? !is_estimate(g) : !may_have_estimate(g))
      snprintf(why, size, "%s: %s", goal->name,
               goal_verdict_text(g->found.verdict));
    else if (goal->in_percent && a->n_pass > 1 && is_estimate(g - a->n) &&
             g->off >= value)
      snprintf(why, size,
               "%s is zero within its error: give its TARGET= in its unit",
               goal->name);
  }
}

/* At the tip of a crack an element adds to a factor about a tenth of its length
 * over the radius of the domain, of all factors. Where the lips are closed
 * elements much smaller than the target needs are worse: the stress grows
 * towards the tip, its error with it, until nodes there open and close by
 * turns. */
static double least_length(const pass_goal *g) {
  const goal_result *r = &g->found;
  if (!(r->radius > 0.0) || !(r->size > 0.0) || !is_estimate(g)) return 0.0;
  return r->radius * fmin(TIP * g->allowed / r->size, FEW);
}

/* Part of the error that the next pass aims at, <= 1: there the estimate is
 * expected to be reliable. From where the ends of contact are not resolved the
 * error falls faster than by its order: far from the target a pass between. */
static double part_of(const pass_goal *g) {
  const double once = sum_of(&g->found, 1.0);
  const double from = once > g->allowed ? once : g->off;
  if (!is_estimate(g)) return BLIND;
  const double part = from > 0.0 ? fmin(AIM * g->allowed / from, 1.0) : 1.0;
  return is_at_end(g) && part < FAR ? sqrt(part) : part;
}

size_t aims_name(const aims *a, const model *m, char *text, size_t size) {
  size_t used = 0;
  for (int i = 0; a != NULL && i < a->n && used < size; ++i)
    if (!is_met(&m->accuracy.goals[i], last_row(a, i)))
      used += snprintf(text + used, size - used, "%s %s",
                       used > 0 ? "," : " for", m->accuracy.goals[i].name);
  return used < size ? used : size;
}

double aims_solver(const aims *a, const model *m, double share) {
  double most = 0.0;
  for (int i = 0; a != NULL && i < a->n; ++i) {
    const pass_goal *g = last_row(a, i);
    if (m->accuracy.goals[i].target > 0.0 && g->allowed > 0.0)
      most = fmax(most, fabs(g->found.solver) / (share * g->allowed));
  }
  return most;
}

void aims_ask(aims *a, double part) {
  for (int i = 0; i < a->n; ++i) {
    pass_goal *g = last_row(a, i);
    g->allowed = part / AIM * sum_of(&g->found, 1.0);
  }
}

/* size[n_node] for the errors own[n_elem] of which that part is left. */
static void find_sizes(const mesh *msh, const double *own, double part,
                       double *size) {
  double square = 0.0;
  for (int e = 0; e < msh->n_elem; ++e) square += own[e] * own[e];
  space_sizes(msh, own, sqrt(part * square), size);
}

/* own[n_elem] of goal i; 1: there are some, beyond rounding: an adjoint that is
 * linear has none, and the error is one of the gap. */
static int find_own(const aims *a, const mesh *msh, int i, double *own) {
  const double *product = a->product + (size_t)i * msh->n_elem;
  double sum = 0.0;
  for (int e = 0; e < msh->n_elem; ++e) {
    own[e] = sqrt(product[e]);
    sum += product[e];
  }
  return sum > ROUNDING * fabs(last_row(a, i)->found.error);
}

status aims_share(const aims *a, const mesh *msh, int i, double *share) {
  OWNED double *own = NULL, *size = NULL;
  PASS_NEW_ALL(OF(own, msh->n_elem), OF(size, msh->n_node));
  *share = 1.0;
  if (!find_own(a, msh, i, own)) return OK;
  find_sizes(msh, own, 1.0, size);
  *share = space_growth(msh, size);
  return OK;
}

/* Where a mesh of the passes is near the target nothing becomes coarser: errors
 * scatter from mesh to mesh by more than is missing. length[n_node]: of the
 * mesh. */
static void limit_sizes(const aims *a, const pass_goal *g, int n_node,
                        const double *length, double *size) {
  const int near = a->n_pass > 1 && part_of(g) > NEAR;
  const double least = least_length(g);
  for (int k = 0; k < n_node; ++k) {
    if (near) size[k] = fmin(size[k], length[k]);
    size[k] = fmax(size[k], least);
  }
}

/* The gap at a node of contact number "of", 0: of any, m; else HUGE_VAL. */
static double gap_at(const aims *a, int node, int of) {
  const int is = a->contact[node];
  return is != 0 && (of == 0 || is == of) ? a->gap[node] : HUGE_VAL;
}

/* Too few nodes for an estimate: half the length round the closed ones of the
 * contact, or the nearest to it. length[n_node]: of the mesh. */
static void halve_zone(const aims *a, const mesh *msh, int of,
                       const double *length, double *size) {
  const int corners = msh->dim + 1;
  double least = HUGE_VAL;
  for (int i = 0; i < msh->n_node; ++i) least = fmin(least, gap_at(a, i, of));
  for (int k = 0; k < corners * msh->n_elem && least < HUGE_VAL; ++k) {
    const int *v = msh->elem + k / corners * corners;
    if (gap_at(a, msh->elem[k], of) > least) continue;
    for (int b = 0; b < corners; ++b)
      size[v[b]] = fmin(size[v[b]], BLIND * length[v[b]]);
  }
}

status aims_sizes(aims *a, const model *m, const mesh *msh, const double *eta,
                  double *size) {
  OWNED double *own = NULL, *more = NULL, *length = NULL;
  PASS_NEW_ALL(OF(own, msh->n_elem), OF(more, msh->n_node),
               OF(length, msh->n_node));
  space_lengths(msh, length);
  /* What gained nothing was too little. */
  const int tries = isfinite(a->least) ? a->in_vain : 0;
  for (int i = 0; i < a->n; ++i) {
    const double part = ldexp(part_of(last_row(a, i)), -tries);
    if (!a->all && !(m->accuracy.goals[i].target > 0.0)) continue;
    const int any = find_own(a, msh, i, own);
    if (any || eta != NULL)
      find_sizes(msh, any ? own : eta, part, more);
    else
      COPY(more, size, msh->n_node);
    limit_sizes(a, last_row(a, i), msh->n_node, length, more);
    if (!any && !is_estimate(last_row(a, i)))
      halve_zone(a, msh, 1 + m->accuracy.goals[i].contact_id, length, more);
    for (int k = 0; k < msh->n_node; ++k) size[k] = fmin(size[k], more[k]);
  }
  return OK;
}
