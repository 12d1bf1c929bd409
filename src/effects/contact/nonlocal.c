/*
 * Nonlocal friction: the limit of a node from an average of the pressure around
 * it (CPR98, 2.7), and friction confined to the nodes that touch. Averages are
 * kept while surface and options are unchanged.
 */
#include "effects/plan/effect.h"

/* The average of one contact and the rule it was made for. */
typedef struct friction_average {
  const friction_rule *rule; /* NULL: none */
  sparse_rows rows;          /* [n*n] - */
} friction_average;

/* Rows of the limit that are switched off where the body does not touch. */
typedef struct friction_zone {
  unsigned char *off; /* [n] no friction now; NULL: no law has a zone */
  unsigned char
      *returned; /* [n] switched on again in this increment: once only */
  sparse_rows B; /* start, col borrowed from the limit */
  int capacity;  /* entries of B.val */
} friction_zone;

typedef struct nonlocal {
  friction_average *average; /* [n_contact] */
  int borrowed;              /* 1: that of another state */
  friction_zone zone;
} nonlocal;

static int has_same_average(const friction_rule *a, const friction_rule *b) {
  if (a == NULL || a->law != b->law) return 0;
  return memcmp(a->card.param, b->card.param, a->law->param_size) == 0;
}

static status make_average(run *r, friction_average *a, int contact_id,
                           const friction_rule *rule) {
  if (has_same_average(a->rule, rule)) return OK;
  a->rule = NULL;
  sparse_free(&a->rows);
  PASS(rule->law->average(&rule->card, r->surface, &r->faces.input, contact_id,
                          &rule->at, r->m->log, &a->rows));
  a->rule = rule;
  return OK;
}

static status make_averages(run *r, void *self) {
  nonlocal *own = self;
  TIMED(STAGE_NONLOCAL);
  for (int i = 0; i < r->m->n.contact; ++i) {
    const friction_rule *rule = friction_in_force(r->m, run_step_id(r), i);
    if (rule_has_average(rule))
      PASS(make_average(r, &own->average[i], i, rule));
  }
  return OK;
}

const sparse_rows *nonlocal_average(const run *r, int contact_id) {
  const nonlocal *own = effect_state(&r->effects, &nonlocal_effect);
  return &own->average[contact_id].rows;
}

static void count_entries(const run *r, const void *self, setup_facts *f) {
  const nonlocal *own = self;
  for (int i = 0; i < r->m->n.contact; ++i)
    if (own->average[i].rule != NULL)
      f->average_entries += own->average[i].rows.start[r->nodes.n];
}

static void zone_free(friction_zone *z) {
  RELEASE(z->off, z->returned, z->B.val);
  *z = (friction_zone){0};
}

static void zone_apply(const friction_limit *limit, const friction_zone *z) {
  const sparse_rows *B = &limit->B;
  for (int i = 0; i < B->n; ++i)
    for (int e = B->start[i]; e < B->start[i + 1]; ++e)
      z->B.val[e] = z->off[i] ? 0.0 : B->val[e];
}

static status zone_fit(const run *r, const sparse_rows *B, friction_zone *z) {
  if (z->off == NULL)
    PASS_NEW_ALL(OF(z->off, r->nodes.n), OF(z->returned, r->nodes.n));
  if (z->B.val == NULL || z->capacity < B->start[B->n]) {
    memory_free(z->B.val);
    PASS_NEW(z->B.val, B->start[B->n]);
    z->capacity = B->start[B->n];
  }
  z->B = (sparse_rows){B->n, B->start, B->col, z->B.val};
  return OK;
}

/* At the start of an increment those that touched, all if none did. */
static status zone_start(run *r, void *self, double t) {
  friction_zone *z = &((nonlocal *)self)->zone;
  const friction_limit *limit = r->problem.limit;
  int dim = r->msh->dim, touched = 0;
  if (limit->in_zone == NULL) {
    zone_free(z);
    return OK;
  }
  OWNS(self);
  PASS(zone_fit(r, &limit->B, z));
  for (int i = 0; i < r->nodes.n; ++i) touched |= r->old.rc[dim * i] < 0.0;
  for (int i = 0; i < r->nodes.n; ++i) {
    int open = !(r->old.rc[dim * i] < 0.0);
    z->off[i] = limit->in_zone[i] && touched && open;
    z->returned[i] = 0;
  }
  zone_apply(limit, z);
  r->problem.B = &z->B;
  return OK;
}

/* 1 if a node does not touch; one with a given force touches by that. */
static int is_open(const run *r, int i) {
  const contact *c = &r->m->contacts[r->surface->contact_id[i]];
  if (c->force.given) return !(r->now.rc[r->msh->dim * i] < 0.0);
  return r->result.contact[i] == CONTACT_OPEN;
}

/* After a solution of r->problem.cp, whose B is that of the zone. */
static status follow_zone(run *r, void *self, int *again) {
  friction_zone *z = &((nonlocal *)self)->zone;
  const friction_limit *limit = r->problem.limit;
  int changes = 0;
  if (z->off == NULL || r->solving.report.outcome <= 0) return OK;
  contact_classify(&r->problem.cp, run_rows(r, 0, r->now.uc),
                   run_rows(r, 1, r->now.rc), r->result.contact);
  for (int i = 0; i < r->nodes.n; ++i) {
    int open = is_open(r, i);
    if (!limit->in_zone[i] || open == z->off[i] || (!open && z->returned[i]))
      continue;
    if (!open) z->returned[i] = 1;
    z->off[i] = (unsigned char)open;
    ++changes;
  }
  if (changes > 0) zone_apply(limit, z);
  *again = changes > 0;
  return OK;
}

static status nonlocal_new(run *r, void **self) {
  nonlocal *own = *self;
  PASS_NEW(own->average, r->m->n.contact);
  return OK;
}

static void forget(run *r, void *self) {
  nonlocal *own = self;
  for (int i = 0; i < r->m->n.contact && own->average != NULL; ++i) {
    sparse_free(&own->average[i].rows);
    own->average[i].rule = NULL;
  }
  zone_free(&own->zone);
}

static status nonlocal_copy(const run *r, const void *of, run *copy,
                            void **self) {
  *(nonlocal *)*self = (nonlocal){((const nonlocal *)of)->average, 1, {0}};
  return OK;
}

static effect_work expected(const plan_sizes *s) {
  const double n = s->averages;
  return (effect_work){n, "nodes", 1.0, 1000.0 * n + n * n};
}

static int requires_average(const model *m, const reason *why) {
  return plan_requires_rule(m, rule_has_average,
                            "no friction law with an average", why);
}

/* clang-format off */
const effect_ops nonlocal_effect = {
  .name = "nonlocal average", .bit = EFFECT_BIT_NONLOCAL,
  .required = requires_average, .expected = expected, .own = STAGE_NONLOCAL,
  .inside = 1, .size = sizeof(nonlocal),
  .on = {.create = nonlocal_new, .prepare = make_averages,
         .describe = count_entries, .pose = zone_start, .found = follow_zone,
         .forget = forget, .copy = nonlocal_copy}};
/* clang-format on */
