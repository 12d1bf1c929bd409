/*
 * Friction: the sliding limit of an increment, from the friction law in force
 * on each contact, and where its value jumps in time; the position of stick,
 * which is the history of slip; all slip so far. Existence theory requires mu
 * continuous in time (CPR98, 3.2); a jump is allowed and reported.
 *
 * Any increment may be cut, so that each is one of several: the position of
 * stick is always found from the last equilibrium.
 */
#include "effects/plan/effect.h"
#include "effects/shared.h"

#include "run/column_row.h"

typedef struct friction {
  friction_limit limit;
  int known;        /* 1: limit holds for all times of the step */
  double *stick;    /* [n*(dim-1)] m */
  double *g;        /* [n] limit of r->now, N */
  double *distance; /* [n] all slip so far, m */
  double *left;     /* [n_node] that of a released surface, m */
  int *told;        /* [n.contact] 1: friction of held nodes is left out */
} friction;

enum { T_BIT = 8, HALVINGS = 40 };
static const double jump_share = 1e-3; /* of the larger value: below, none */

static const friction_rule *rule_of(const run *r, int contact_id) {
  return friction_in_force(r->m, run_step_id(r), contact_id);
}

/* 1 if a friction value in force changes in time. */
static int limit_varies(const run *r) {
  for (int i = 0; i < r->m->n.contact; ++i)
    if (quantity_variables(&rule_of(r, i)->card.value) & T_BIT) return 1;
  return 0;
}

/* ---- jumps in time ------------------------------------------------------ */

/* Value of a rule at a contact node; 0 without friction. */
static double value_at(const run *r, const friction_rule *rule, int i,
                       double t) {
  double x[3] = {0.0, 0.0, 0.0};
  if (rule->law == NULL || rule->law->value_name == NULL) return 0.0;
  int dim = r->surface->dim;
  COPY(x, r->surface->x + dim * i, dim);
  return quantity_value(&rule->card.value, x, t);
}

/* A change of value at a node, in time. */
typedef struct jump {
  int node_id; /* -1: none */
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
 * Halve the time between the two ends towards the larger change: a continuous
 * change vanishes, a jump remains and is found.
 */
static jump narrow(const run *r, const friction_rule *rule, jump j, double t0) {
  const double least = jump_share * fmax(j.from, j.to);
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
  if (!(fabs(j.to - j.from) > least)) j.node_id = -1;
  return j;
}

static void notify(run *r, const friction_rule *rule, int contact_id, jump j) {
  if (j.node_id < 0) return;
  RUN_NOTE(r,
           "  %s of contact %s jumps at t = %.9g from %.6g to %.6g, node %zu\n",
           rule->law->value_name, r->m->contacts[contact_id].name, j.t, j.from,
           j.to, r->surface->node_no[j.node_id]);
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
    RUN_NOTE(r, "  friction of contact %s changes at t = %.9g from %s to %s\n",
             r->m->contacts[contact_id].name, r->old.t,
             before->law == NULL ? "NONE" : before->law->name,
             now->law == NULL ? "NONE" : now->law->name);
    return;
  }
  if (now->law == NULL || now->law->value_name == NULL) return;
  notify(r, now, contact_id,
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
  notify(r, rule, contact_id, j);
}

/* ---- the limit ---------------------------------------------------------- */

/* The law of one contact on its nodes. */
static status add_law(run *r, friction *own, int contact_id, double t,
                      int *node) {
  const friction_rule *rule = rule_of(r, contact_id);
  int n = 0;
  if (rule->law == NULL) return OK;
  for (int i = 0; i < r->nodes.n; ++i)
    if (r->surface->contact_id[i] == contact_id) node[n++] = i;
  friction_card of = rule->card;
  if (rule_has_average(rule)) of.average = nonlocal_average(r, contact_id);
  status st = rule->law->limit(&of, r->surface, n, node, t, &own->limit);
  if (st == ERR_DECK) {
    message_add(r->m->log, P2041, &rule->value_at, "%s", status_message());
    RAISE(ERR_DECK, "%s:%d: %s", rule->value_at.file, rule->value_at.line_no,
          status_message());
  }
  return st;
}

static status find_limit(run *r, friction *own, double t) {
  TIMED(STAGE_LIMIT);
  OWNS(own);
  friction_limit_free(&own->limit);
  PASS(friction_limit_new(r->nodes.n, &own->limit));
  OWNED_NEW(int, node, r->nodes.n);
  for (int i = 0; i < r->m->n.contact; ++i) PASS(add_law(r, own, i, t, node));
  own->known = !limit_varies(r);
  if (!own->known) run_forget_estimates(r);
  return OK;
}

static status update_limit(run *r, friction *own, double t) {
  r->course.note[0] = '\0';
  for (int i = 0; i < r->m->n.contact; ++i) {
    note_change(r, i);
    note_jump(r, i, t);
  }
  if (!own->known) PASS(find_limit(r, own, t));
  r->problem.limit = &own->limit;
  r->problem.B = own->limit.B.start == NULL ? NULL : &own->limit.B;
  return OK;
}

/* ---- the history of slip ------------------------------------------------ */

static double held_value(const run *r, const double *ud, int i, int a) {
  return surface_prescribed(r->surface, r->body.fixed, ud, i, a);
}

/* 1 if the sliding limit of a node can be above zero. */
static int can_stick(const friction_limit *limit, int i) {
  const sparse_rows *B = &limit->B;
  if (limit->g0[i] > 0.0) return 1;
  for (int e = row_begin(B, i); e < row_end(B, i); ++e)
    if (B->val[e] > 0.0) return 1;
  return 0;
}

/* The *BOUNDARY that holds contact node i most along its axis a, or NULL. */
static const load *holder(const run *r, int i, int a) {
  const contact_surface *s = r->surface;
  const double *axis = &s->frame[s->dim * s->dim * i + s->dim * a];
  const load *best = NULL;
  for (EACH(const load, l, r->step->loads.item, r->step->loads.n)) {
    const mesh_group *g = &r->msh->group[l->group_id];
    if (l->kind != LOAD_FIXING ||
        number_find(s->node_id[i], g->node_id, g->n_node) < 0)
      continue;
    if (best == NULL || fabs(axis[l->component]) > fabs(axis[best->component]))
      best = l;
  }
  return best;
}

/* 1: axis a of node i is held, the other tangent is not. */
static int is_half_held(const contact_surface *s, int i, int a) {
  return s->dim == 3 && s->held[3 * i + a] && !s->held[3 * i + 3 - a];
}

/*
 * Friction along t2 where t1 is made to move: the slip direction would depend
 * on the prescribed motion, which the condensed problem does not contain.
 */
static status refuse_held(const run *r, int i, int a) {
  const load *l = holder(r, i, a);
  message_add(r->m->log, P4015, l == NULL ? &r->step->at : &l->at,
              "contact node %zu has one prescribed tangential displacement "
              "while friction acts in the other direction",
              r->surface->node_no[i]);
  RAISE(ERR_DECK, "*BOUNDARY moves contact node %zu against friction",
        r->surface->node_no[i]);
}

/* 1: the support of axis a of node i, held alone, moves it from one place to
 * the other against friction; still: the part of rounding of all. */
static int is_rubbed(const run *r, const friction *own, int i, int a,
                     double still, double from, double to) {
  return is_half_held(r->surface, i, a) &&
         fabs(to - from) > still + RUN_ROUNDING * (fabs(to) + fabs(from)) &&
         can_stick(&own->limit, i);
}

/*
 * Position of stick: the tangential displacement at the last equilibrium, moved
 * along by the obstacle (CPR98 S_i^n); for one static problem the origin (P2).
 * A prescribed unknown sticks where it is put: its force is the support's.
 */
static status find_stick(run *r, friction *own) {
  int dim = r->msh->dim;
  int fresh = r->step->kind == STEP_STATIC && !r->course.relaxing;
  const double still =
      dim == 3 && surface_has_held(r->surface) ? run_still(r) : 0.0;
  for (int i = 0; i < r->nodes.n; ++i)
    for (int a = 1; a < dim; ++a) {
      int k = dim * i + a;
      double from = fresh ? 0.0 : r->old.uc[k] - run_drift(&r->old, k);
      double stick = from + run_drift(&r->now, k);
      if (r->surface->held[k]) {
        double to = held_value(r, r->loads.ud, i, a);
        if (is_rubbed(r, own, i, a, still, stick, to))
          return refuse_held(r, i, a);
        stick = to;
      }
      own->stick[(dim - 1) * i + a - 1] = stick;
    }
  return OK;
}

/* ---- before the run ------------------------------------------------------ */

/* Supports ud[dim*n_node] before and at t, drift[dim*n] of the obstacles in
 * between. What is not known is NaN and moves nothing. */
typedef struct travel {
  double t, still, *before, *now, *drift; /* still: run_still */
} travel;

static int is_moved(const run *r, const travel *x, int i, int a) {
  const double from = held_value(r, x->before, i, a);
  const double to = held_value(r, x->now, i, a);
  const double drift = x->drift[r->msh->dim * i + a];
  return fabs(to - from - drift) >
         x->still + RUN_ROUNDING * (fabs(to) + fabs(from) + fabs(drift));
}

static status check_travel(const run *r, const travel *x) {
  const contact_surface *s = r->surface;
  for (int k = 0; k < 2 * s->n; ++k) {
    const int i = k / 2, a = 1 + k % 2;
    if (is_half_held(s, i, a) && !surface_is_corner(s, i) &&
        is_moved(r, x, i, a) &&
        value_at(r, rule_of(r, s->contact_id[i]), i, x->t) > 0.0)
      return refuse_held(r, i, a);
  }
  return OK;
}

/* From one of up to MOST times of the step to the next; of one static problem
 * from the origin to its end. */
static status check_travels(const run *r, travel *x, const double *none) {
  enum { MOST = 64 };
  const step *s = r->step;
  const int fresh = s->kind == STEP_STATIC;
  const int n = fresh ? 1 : (int)fmin(MOST, ceil(step_increments(s)));
  x->t = fresh ? 0.0 : s->start;
  COPY(x->before, fresh ? none : r->loads.start, r->n_dof);
  for (int k = 1; k <= n; ++k) {
    const double t = s->start + s->total * k / n, before = x->t;
    x->t = k < n ? t : s->start + s->total;
    CLEAR(x->drift, r->nodes.n_c);
    surface_drift(r->surface, &r->faces.input, before, x->t, x->drift);
    PASS(load_prescribed(r->m, r->msh, s, x->t, r->loads.start, x->now));
    PASS(check_travel(r, x));
    COPY(x->before, x->now, r->n_dof);
  }
  return OK;
}

static status check_step(run *r, void *self) {
  int any = 0;
  OWNED double *before = NULL, *now = NULL, *drift = NULL, *none = NULL;
  for (int k = 0; k < 2 * r->nodes.n && r->msh->dim == 3; ++k)
    any |= is_half_held(r->surface, k / 2, 1 + k % 2);
  if (!any) return OK;
  PASS_NEW_REALS(r->n_dof, &before, &now, &none);
  PASS_NEW(drift, r->nodes.n_c);
  return check_travels(r, &(travel){0.0, run_still(r), before, now, drift},
                       none);
}

/* The stage of the history, where there is one. */
static stage history_of(const run *r) {
  return effect_is_on(&slip_history_effect, r->m)
             ? effect_stage(&slip_history_effect)
             : STAGE_NONE;
}

static status pose(run *r, void *self, double t) {
  friction *own = self;
  PASS(update_limit(r, own, t));
  TIMED(history_of(r));
  return find_stick(r, own);
}

/* ---- friction of held nodes that is left out ----------------------------- */

/* Of the largest motion of a master against a slave node, and of the largest
 * displacement: below, what slides is a plane of symmetry, or rounding. */
static const double least_slide = 0.3, least_motion = 1e-9;

/* Motion along d that friction opposes: that of the increment, or of a static
 * problem from the origin, m. */
static double motion_along(const run *r, const double *d, int node_id) {
  const int dim = r->msh->dim;
  const int fresh = r->step->kind == STEP_STATIC && !r->course.relaxing;
  const size_t at = (size_t)dim * node_id;
  const double now = dot(dim, d, &r->now.u[at]);
  return fresh ? now : now - dot(dim, d, &r->old.u[at]);
}

/* 1: node i, which is held along row a, and the surface of its masters, which
 * are not, or not all, slide on each other, by more than least, m. */
static int masters_slide(const run *r, int i, int a, double least) {
  const contact_surface *s = r->surface;
  const node_links *l = s->master;
  const double *d = &s->frame[s->dim * (s->dim * i + a)];
  const double own = motion_along(r, d, s->node_id[i]);
  double mean = 0.0, most = 0.0;
  for (size_t e = l->start[i]; e < l->start[i + 1]; ++e) {
    const double by = motion_along(r, d, l->master[e]) - own;
    mean += l->part[s->dim * e] * by;
    most = fmax(most, fabs(by));
  }
  return fabs(mean) > least_slide * most && most > least;
}

static void tell_held(const run *r, friction *own, int i, int a) {
  const load *l = holder(r, i, a);
  const int id = r->surface->contact_id[i];
  own->told[id] = 1;
  message_add(r->m->log, P4036, l == NULL ? &r->step->at : &l->at,
              "contact %s: supports hold node %zu of the slave along the "
              "contact, but not the master, which slides on it: the friction "
              "of such nodes is left out, also of the reactions",
              r->m->contacts[id].name, r->surface->node_no[i]);
}

/* Once for each contact. */
static void check_masters(const run *r, friction *own) {
  const contact_surface *s = r->surface;
  if (s->master == NULL || !surface_has_held(s)) return;
  const double least = least_motion * largest_entry(r->n_dof, r->now.u);
  for (int k = 0; k < r->nodes.n * (s->dim - 1); ++k) {
    const int i = k / (s->dim - 1), a = 1 + k % (s->dim - 1);
    if (s->held[s->dim * i + a] && !surface_is_mutual(s, i, a) &&
        !surface_is_corner(s, i) && !own->told[s->contact_id[i]] &&
        r->result.contact[i] != CONTACT_OPEN && own->g[i] > 0.0 &&
        masters_slide(r, i, a, least))
      tell_held(r, own, i, a);
  }
}

/* Slip is summed while a node is closed. */
static status accept(run *r, void *self) {
  friction *own = self;
  int dim = r->msh->dim;
  TIMED(history_of(r));
  for (int i = 0; i < r->nodes.n; ++i) {
    double s[3] = {run_motion_over(r, dim * i + 1), 0.0, 0.0};
    if (dim == 3) s[1] = run_motion_over(r, dim * i + 2);
    if (surface_is_corner(r->surface, i)) run_slide(r, i, 0, 0, s);
    if (r->result.contact[i] == CONTACT_SLIP)
      own->distance[i] += hypot(hypot(s[0], s[1]), s[2]);
  }
  check_masters(r, own);
  return OK;
}

static void use_arrays(const friction *own, run *r) {
  r->problem.ut0 = own->stick;
  r->result.g = own->g;
  r->result.distance = own->distance;
}

static status new_arrays(const run *r, friction *own) {
  OWNS(own);
  PASS_NEW(own->stick, r->nodes.n * (r->msh->dim - 1));
  PASS_NEW_REALS(r->nodes.n, &own->g, &own->distance);
  return OK;
}

static status friction_new(run *r, void **self) {
  friction *own = *self;
  PASS_NEW_ALL(OF(own->left, r->msh->n_node), OF(own->told, r->m->n.contact));
  return OK;
}

static status prepare(run *r, void *self) {
  friction *own = self;
  own->known = 0;
  if (own->stick != NULL) return OK;
  PASS(new_arrays(r, own));
  for (int i = 0; i < r->nodes.n; ++i)
    own->distance[i] = own->left[r->surface->node_id[i]];
  use_arrays(own, r);
  return OK;
}

static void forget(run *r, void *self) {
  friction *own = self;
  if (own->distance == NULL) return;
  CLEAR(own->left, r->msh->n_node);
  for (int i = 0; i < r->nodes.n; ++i)
    own->left[r->surface->node_id[i]] = own->distance[i];
  friction_limit_free(&own->limit);
  RELEASE(own->stick, own->g, own->distance);
  *own = (friction){.left = own->left, .told = own->told};
  use_arrays(own, r);
}

static status friction_copy(const run *r, const void *of, run *copy,
                            void **self) {
  friction *own = *self;
  const double *distance = ((const friction *)of)->distance;
  PASS(new_arrays(r, own));
  OWNS(own);
  PASS_NEW(own->told, r->m->n.contact);
  COPY(own->told, ((const friction *)of)->told, r->m->n.contact);
  COPY(own->distance, distance, r->nodes.n);
  use_arrays(own, copy);
  return OK;
}

/* A limit that holds for all times of the step is made now, so that the costs
 * counted from here on are those of the other run. */
static status keep(run *r, void *self, archive *a) {
  friction *own = self;
  int known = own->known;
  PASS(archive_ints(a, "limit_known", &known, 1));
  PASS(archive_ints(a, "held_told", own->told, r->m->n.contact));
  PASS(archive_reals(a, "distance", own->distance, r->nodes.n));
  if (archive_reads(a) && known) PASS(update_limit(r, own, r->old.t));
  return OK;
}

static effect_work expected(const plan_sizes *s) {
  return (effect_work){s->friction, "nodes", 1.0, 100.0 * s->friction};
}

static effect_work expected_history(const plan_sizes *s) {
  double times = s->equilibria + s->increments;
  return (effect_work){s->friction, "nodes", times, 20.0 * times * s->friction};
}

static int requires_friction(const model *m, const reason *why) {
  return plan_requires_rule(m, rule_has_friction,
                            m->n.contact == 0
                                ? "no *CONTACT card"
                                : "no *FRICTION card with a value above zero",
                            why);
}

/* More than one increment: slip and load have a history. */
static int requires_history(const model *m, const reason *why) {
  if (!requires_friction(m, NULL)) return plan_says(0, why, "no friction");
  if (m->n.step == 0 ||
      (m->n.step == 1 && !(m->steps[0].dt < m->steps[0].total)))
    return plan_says(0, why, "one increment only");
  return plan_at(why, &m->steps[0].at, "friction over more than one increment");
}

/* ---- columns ------------------------------------------------------------ */

#define SURFACE (v->s->contacts.surface)
VALUE(limit_updates, v->s->report.limit_updates)
VALUE(friction_work, v->s->energy.friction)
VALUE(friction_end, v->s->energy.friction_end)
VALUE(contact_slip, view_opening(v, id, part + 1) *
                        v->s->contacts.slip[at(SURFACE->dim - 1, id, part)])
VALUE(slip_distance, view_opening(v, id, 1) * v->s->contacts.distance[id])
VALUE(sliding_limit, v->s->contacts.limit[id])

/* Component of the slip in global directions. */
static double slide_of(const view *v, int id, int part) {
  const double *slip = v->s->contacts.slip + at(SURFACE->dim - 1, id, 0);
  double sum = 0, t[3];
  for (int k = 1; k < SURFACE->dim; ++k) {
    surface_tangent(SURFACE, id, k, t);
    sum += t[part] * slip[k - 1];
  }
  return sum;
}

VALUE(contact_slide, view_opening(v, id, 1) * slide_of(v, id, part))

/* Unit vector of the slip, global components; 0 where the node does not slip */
static double slip_direction(const view *v, int id, int part) {
  const int tangents = SURFACE->dim - 1;
  const double *slip = v->s->contacts.slip + at(tangents, id, 0);
  const double length = tangents == 1 ? fabs(slip[0]) : hypot(slip[0], slip[1]);
  if (v->s->contacts.contact[id] != CONTACT_SLIP || !(length > 0)) return 0;
  return slide_of(v, id, part) / length;
}

/* clang-format off */
#define CON   PER_CONTACT_NODE, AS_REAL
#define SLIP(name, scene, part) \
  {name, "length", CON, PRINT_CONTACT | AT(1), F, scene, NEEDS_SURFACE, name, \
   part, contact_slip, NULL, "slip of the increment; *STATIC: from the origin"}
#define SLIDE(name, scene, part) \
  {name, "length", CON, AT(2), F, scene, NEEDS_PLACE, "slip_vector", part, \
   contact_slide, NULL, "slip of the increment in global components"}
#define DIRECTION(name, scene, part) \
  {name, "-", CON, PRINT_CONTACT | AT(2), F, scene, NEEDS_PLACE, NULL, part, \
   slip_direction, NULL, "direction of the slip, 0 where there is none"}
static const column columns[] = {
{"limit_updates", "-", PER_INCREMENT, AS_COUNT, AT(1), F, ANY,
 "limit_updates", 0, limit_updates, NULL,
 "passes of the fixed point on the sliding limit"},
{"friction_work", J, INC, PRINT_ENERGY | AT(3), F, ANY, "friction_work", 0,
 friction_work, NULL, "dissipated by friction so far, trapezoidal"},
{"friction_work_end", J, INC, PRINT_ENERGY | AT(3), F, ANY,
 "friction_work_end", 0, friction_end, NULL,
 "the same with the forces at the end of increments"},
SLIP("slip", SCENE_FLAT, 0),
SLIP("slip_1", SCENE_SOLID, 0), SLIP("slip_2", SCENE_SOLID, 1),
{"slip_distance", "length", CON, PRINT_CONTACT | AT(1), F, SCENE_ALL,
 NEEDS_DISTANCE, "slip_distance", 0, slip_distance, NULL,
 "length of all slip so far"},
SLIDE("slip_x", CART, 0), SLIDE("slip_r", SCENE_AXI, 0),
SLIDE("slip_y", CART, 1), SLIDE("slip_z", SCENE_AXI, 1),
SLIDE("slip_z", SCENE_SOLID, 2),
DIRECTION("slip_dir_x", CART, 0), DIRECTION("slip_dir_r", SCENE_AXI, 0),
DIRECTION("slip_dir_y", CART, 1), DIRECTION("slip_dir_z", SCENE_AXI, 1),
DIRECTION("slip_dir_z", SCENE_SOLID, 2),
{"limit", "force", CON, PRINT_CONTACT | AT(2), F, SCENE_ALL,
 NEEDS_SURFACE | NEEDS_LIMIT, "limit", 0, sliding_limit, NULL,
 "sliding limit"}};

const effect_ops friction_effect = {
  .name = "friction", .bit = EFFECT_BIT_FRICTION, .required = requires_friction,
  .expected = expected, .own = STAGE_LIMIT, .inside = 1, .of_state = 1,
  .size = sizeof(friction),
  .on = {.create = friction_new, .check = check_step, .prepare = prepare,
         .pose = pose,
         .accept = accept, .forget = forget, .keep = keep,
         .copy = friction_copy},
  COLUMNS_OF(columns)};
/* clang-format on */

/* Its hooks are those of friction. */
const effect_ops slip_history_effect = {.name = "history of slip",
                                        .bit = EFFECT_BIT_HISTORY,
                                        .required = requires_history,
                                        .expected = expected_history};
