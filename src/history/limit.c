/*
 * The sliding limit of an increment: the friction law in force on each contact,
 * and where its value jumps in time. Existence theory asks for mu continuous in
 * time (CPR98, 3.2); a jump is allowed and told.
 */
#include "history/run.h"

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

/* The law of one contact on its nodes. */
static status add_law(run *r, int contact_id, double t, int *node) {
  status st = OK;
  const friction_rule *rule = rule_of(r, contact_id);
  int n = 0;
  if (rule->law == NULL) goto done;
  for (int i = 0; i < r->n; ++i)
    if (r->surface->contact_id[i] == contact_id) node[n++] = i;
  st = rule->law->limit(&rule->card, r->surface, n, node, t, &r->limit);
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
  for (int i = 0; i < r->n; ++i) {
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
  size_t used = strlen(r->note);
  if (j.node_id < 0) return;
  snprintf(r->note + used, sizeof r->note - used,
           "  %s of contact %s jumps at t = %.9g from %.6g to %.6g, node %zu\n",
           rule->law->value_name, r->m->contacts[contact_id].name, j.t, j.from,
           j.to, r->surface->node_no[j.node_id]);
}

static void tell_law(run *r, const friction_rule *before,
                     const friction_rule *now, int contact_id) {
  size_t used = strlen(r->note);
  snprintf(r->note + used, sizeof r->note - used,
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
  r->note[0] = '\0';
  for (int i = 0; i < r->m->n_contact; ++i) {
    note_change(r, i);
    note_jump(r, i, t);
  }
}

/* ---- the limit ---------------------------------------------------------- */

status limit_update(run *r, double t) {
  status st = OK;
  int *node = NULL;
  if (!(r->m->effects & EFFECT_FRICTION)) return OK;
  note_jumps(r, t);
  if (r->limit_known) return OK;
  timer_enter(STAGE_LIMIT);
  friction_limit_free(&r->limit);
  TRY(friction_limit_new(r->n, &r->limit));
  NEW(node, r->n);
  for (int i = 0; i < r->m->n_contact; ++i) TRY(add_law(r, i, t, node));
  r->limit_known = !limit_varies(r);
done:
  memory_free(node);
  timer_leave(STAGE_LIMIT);
  return st;
}
