/*
 * The sliding limit of an increment: the friction law in force on each contact,
 * and where its value jumps in time. Existence theory asks for mu continuous in
 * time (CPR98, 3.2); a jump is allowed and told. Averages of nonlocal laws are
 * kept as long as surface and options stay; a law may be confined to the zone
 * that touches.
 */
#include "run/run.h"

#include "base/memory.h"
#include "base/timer.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { T_BIT = 8, HALVINGS = 40 };
static const double jump_share = 1e-3; /* of the larger value: below, none    */

static const friction_rule *rule_of(const run *r, int contact_id) {
  return friction_in_force(r->m, run_step_id(r), contact_id);
}

/* 1 if a friction value in force changes in time. */
static int limit_varies(const run *r) {
  for (int i = 0; i < r->m->n_contact; ++i)
    if (quantity_variables(&rule_of(r, i)->card.value) & T_BIT) return 1;
  return 0;
}

/* ---- jumps in time ------------------------------------------------------ */

/* Value of a rule at a contact node; 0 without friction. */
static double value_at(const run *r, const friction_rule *rule, int i,
                       double t) {
  double x[3] = {0.0, 0.0, 0.0};
  int dim = r->surface->dim;
  if (rule->law == NULL || rule->law->value_name == NULL) return 0.0;
  for (int c = 0; c < dim; ++c) x[c] = r->surface->x[dim * i + c];
  return quantity_value(&rule->card.value, x, t);
}

/* A change of value at a node, in time. */
typedef struct jump {
  int node_id; /* -1: none                                                   */
  double t, from, to;
} jump;

/* The largest difference between two rules, or two times, over the nodes. */
static jump largest_change(const run *r, int contact_id,
                           const friction_rule *before, double t0,
                           const friction_rule *now, double t1) {
  jump j = {.node_id = -1, .t = t1};
  for (int i = 0; i < r->nodes.n; ++i) {
    if (r->surface->contact_id[i] != contact_id) continue;
    double a = value_at(r, before, i, t0), b = value_at(r, now, i, t1);
    if (j.node_id >= 0 && !(fabs(b - a) > fabs(j.to - j.from))) continue;
    j.node_id = i;
    j.from = a;
    j.to = b;
  }
  if (!(fabs(j.to - j.from) > jump_share * fmax(j.from, j.to))) j.node_id = -1;
  return j;
}

/*
 * Halve the time between the two ends towards the larger change: what is
 * continuous vanishes, a jump stays and is found.
 */
static jump narrow(const run *r, const friction_rule *rule, jump j, double t0) {
  double t1 = j.t;
  for (int k = 0; k < HALVINGS; ++k) {
    double t = 0.5 * (t0 + t1), value = value_at(r, rule, j.node_id, t);
    if (fabs(value - j.from) > fabs(j.to - value)) {
      t1 = t;
      j.to = value;
    } else {
      t0 = t;
      j.from = value;
    }
  }
  j.t = t1;
  if (!(fabs(j.to - j.from) > jump_share * fmax(j.from, j.to))) j.node_id = -1;
  return j;
}

static void tell(run *r, const friction_rule *rule, int contact_id, jump j) {
  size_t used = strlen(r->course.note);
  if (j.node_id < 0) return;
  snprintf(r->course.note + used, sizeof r->course.note - used,
           "  %s of contact %s jumps at t = %.9g from %.6g to %.6g, node %zu\n",
           rule->law->value_name, r->m->contacts[contact_id].name, j.t, j.from,
           j.to, r->surface->node_no[j.node_id]);
}

static void tell_law(run *r, const friction_rule *before,
                     const friction_rule *now, int contact_id) {
  size_t used = strlen(r->course.note);
  snprintf(r->course.note + used, sizeof r->course.note - used,
           "  friction of contact %s changes at t = %.9g from %s to %s\n",
           r->m->contacts[contact_id].name, r->old.t,
           before->law == NULL ? "NONE" : before->law->name,
           now->law == NULL ? "NONE" : now->law->name);
}

/* What another *FRICTION changes at the start of a step. */
static void note_change(run *r, int contact_id) {
  int step_id = run_step_id(r);
  if (step_id == 0 || r->old.t > r->step->start) return;
  const friction_rule *now = rule_of(r, contact_id);
  const friction_rule *before =
      friction_in_force(r->m, step_id - 1, contact_id);
  if (now == before) return;
  if (now->law != before->law) {
    tell_law(r, before, now, contact_id);
    return;
  }
  if (now->law == NULL || now->law->value_name == NULL) return;
  tell(r, now, contact_id,
       largest_change(r, contact_id, before, r->old.t, now, r->old.t));
}

/* Expressions of t may jump; tables and amplitudes of pairs cannot. */
static void note_jump(run *r, int contact_id, double t) {
  const friction_rule *rule = rule_of(r, contact_id);
  const quantity *q = &rule->card.value;
  const expression *formula =
      q->factor != NULL && q->factor->n == 0 ? q->factor->formula : NULL;
  int varies = q->formula != NULL && (expression_variables(q->formula) & T_BIT);
  if (formula != NULL) varies |= (expression_variables(formula) & T_BIT) != 0;
  if (!varies || rule->law == NULL || rule->law->value_name == NULL) return;
  jump j = largest_change(r, contact_id, rule, r->old.t, rule, t);
  if (j.node_id >= 0) j = narrow(r, rule, j, r->old.t);
  tell(r, rule, contact_id, j);
}

static void note_jumps(run *r, double t) {
  r->course.note[0] = '\0';
  for (int i = 0; i < r->m->n_contact; ++i) {
    note_change(r, i);
    note_jump(r, i, t);
  }
}

double limit_coefficient(const run *r, int contact_id, double t) {
  const friction_rule *rule = rule_of(r, contact_id);
  double largest = 0.0;
  if (!rule_has_friction(rule) || strcmp(rule->law->value_unit, "-") != 0)
    return 0.0;
  for (int i = 0; i < r->nodes.n; ++i)
    if (r->surface->contact_id[i] == contact_id)
      largest = fmax(largest, value_at(r, rule, i, t));
  return largest;
}

/* ---- averages ---------------------------------------------------------- */

/* The average of one contact and the rule it was made for. */
struct friction_average {
  const friction_rule *rule; /* NULL: none                                   */
  sparse_rows rows;          /* [n*n] -                                      */
};

static int has_same_average(const friction_rule *a, const friction_rule *b) {
  if (a == NULL || a->law != b->law) return 0;
  return memcmp(a->card.param, b->card.param, a->law->param_size) == 0;
}

static status make_average(run *r, int contact_id, const friction_rule *rule) {
  status st = OK;
  friction_average *a = &r->friction.average[contact_id];
  if (has_same_average(a->rule, rule)) goto done;
  a->rule = NULL;
  sparse_free(&a->rows);
  TRY(rule->law->average(&rule->card, r->surface, &r->faces.input, contact_id,
                         &rule->at, r->m->log, &a->rows));
  a->rule = rule;
done:
  return st;
}

status limit_average(run *r) {
  status st = OK;
  int n = r->m->n_contact;
  if (!(r->m->effects & EFFECT_NONLOCAL)) return OK;
  timer_enter(STAGE_NONLOCAL);
  if (r->friction.average == NULL) NEW(r->friction.average, n);
  for (int i = 0; i < n; ++i) {
    const friction_rule *rule = friction_in_force(r->m, run_step_id(r), i);
    if (rule_has_average(rule)) TRY(make_average(r, i, rule));
  }
done:
  timer_leave(STAGE_NONLOCAL);
  return st;
}

double limit_average_entries(const run *r) {
  double n = 0.0;
  for (int i = 0; r->friction.average != NULL && i < r->m->n_contact; ++i)
    if (r->friction.average[i].rule != NULL)
      n += r->friction.average[i].rows.start[r->nodes.n];
  return n;
}

static void free_averages(run *r) {
  for (int i = 0; r->friction.average != NULL && i < r->m->n_contact; ++i)
    sparse_free(&r->friction.average[i].rows);
  memory_free(r->friction.average);
  r->friction.average = NULL;
}

/* ---- the zone ---------------------------------------------------------- */

/* Rows of the limit that are switched off where the body does not touch. */
struct friction_zone {
  unsigned char *off;      /* [n] no friction now                            */
  unsigned char *returned; /* [n] put on again in this increment: once only  */
  sparse_rows B;           /* start, col borrowed from the limit             */
  int room;                /* entries of B.val                               */
};

static void zone_free(friction_zone *z) {
  if (z == NULL) return;
  memory_free(z->off);
  memory_free(z->returned);
  memory_free(z->B.val);
  memory_free(z);
}

static void zone_apply(run *r) {
  const sparse_rows *B = &r->friction.limit.B;
  const friction_zone *z = r->friction.zone;
  for (int i = 0; i < B->n; ++i)
    for (int e = B->start[i]; e < B->start[i + 1]; ++e)
      z->B.val[e] = z->off[i] ? 0.0 : B->val[e];
}

static status zone_fit(run *r) {
  status st = OK;
  const sparse_rows *B = &r->friction.limit.B;
  if (r->friction.zone == NULL) {
    NEW(r->friction.zone, 1);
    NEW(r->friction.zone->off, r->nodes.n);
    NEW(r->friction.zone->returned, r->nodes.n);
  }
  friction_zone *z = r->friction.zone;
  if (z->B.val == NULL || z->room < B->start[B->n]) {
    memory_free(z->B.val);
    NEW(z->B.val, B->start[B->n]);
    z->room = B->start[B->n];
  }
  z->B = (sparse_rows){B->n, B->start, B->col, z->B.val};
done:
  return st;
}

static status zone_start(run *r) {
  status st = OK;
  int dim = r->msh->dim, touched = 0;
  if (r->friction.limit.in_zone == NULL) {
    zone_free(r->friction.zone);
    r->friction.zone = NULL;
    goto done;
  }
  TRY(zone_fit(r));
  for (int i = 0; i < r->nodes.n; ++i) touched |= r->old.rc[dim * i] < 0.0;
  for (int i = 0; i < r->nodes.n; ++i) {
    int open = !(r->old.rc[dim * i] < 0.0);
    r->friction.zone->off[i] = r->friction.limit.in_zone[i] && touched && open;
    r->friction.zone->returned[i] = 0;
  }
  zone_apply(r);
done:
  return st;
}

const sparse_rows *limit_matrix(const run *r) {
  if (r->friction.limit.B.start == NULL) return NULL;
  return r->friction.zone != NULL ? &r->friction.zone->B : &r->friction.limit.B;
}

/* 1 if a node does not touch; one with a given force touches by that. */
static int is_open(const run *r, int i) {
  const contact *c = &r->m->contacts[r->surface->contact_id[i]];
  if (c->force.given) return !(r->now.rc[r->msh->dim * i] < 0.0);
  return r->result.contact[i] == CONTACT_OPEN;
}

int limit_follow_zone(run *r) {
  friction_zone *z = r->friction.zone;
  int changes = 0;
  if (z == NULL || r->solving.report.outcome <= 0) return 0;
  contact_classify(&r->problem.cp, r->now.uc, r->now.rc, r->result.contact);
  for (int i = 0; i < r->nodes.n; ++i) {
    int open = is_open(r, i);
    if (!r->friction.limit.in_zone[i] || open == z->off[i] ||
        (!open && z->returned[i]))
      continue;
    if (!open) z->returned[i] = 1;
    z->off[i] = (unsigned char)open;
    ++changes;
  }
  if (changes > 0) zone_apply(r);
  return changes > 0;
}

/* ---- the limit ---------------------------------------------------------- */

/* The law of one contact on its nodes. */
static status add_law(run *r, int contact_id, double t, int *node) {
  status st = OK;
  const friction_rule *rule = rule_of(r, contact_id);
  int n = 0;
  if (rule->law == NULL) goto done;
  for (int i = 0; i < r->nodes.n; ++i)
    if (r->surface->contact_id[i] == contact_id) node[n++] = i;
  friction_card of = rule->card;
  if (rule_has_average(rule))
    of.average = &r->friction.average[contact_id].rows;
  st = rule->law->limit(&of, r->surface, n, node, t, &r->friction.limit);
  if (st == ERR_DECK) {
    char why[256];
    snprintf(why, sizeof why, "%s", status_message());
    message_add(r->m->log, P2041, &rule->value_at, "%s", why);
    FAIL(ERR_DECK, "%s:%d: %s", rule->value_at.file, rule->value_at.line_no,
         why);
  }
done:
  return st;
}

status limit_update(run *r, double t) {
  status st = OK;
  int *node = NULL;
  if (!(r->m->effects & EFFECT_FRICTION)) return OK;
  note_jumps(r, t);
  if (r->friction.known) return zone_start(r);
  timer_enter(STAGE_LIMIT);
  friction_limit_free(&r->friction.limit);
  TRY(friction_limit_new(r->nodes.n, &r->friction.limit));
  NEW(node, r->nodes.n);
  for (int i = 0; i < r->m->n_contact; ++i) TRY(add_law(r, i, t, node));
  r->friction.known = !limit_varies(r);
  if (!r->friction.known) known_rate_forget(&r->solving.rate);
  TRY(zone_start(r));
done:
  memory_free(node);
  timer_leave(STAGE_LIMIT);
  return st;
}

void limit_free_copy(run *r) {
  friction_limit_free(&r->friction.limit);
  zone_free(r->friction.zone);
  r->friction.zone = NULL;
}

void limit_free(run *r) {
  limit_free_copy(r);
  free_averages(r);
}
