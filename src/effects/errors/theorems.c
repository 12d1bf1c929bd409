/*
 * The theorems of CPR98 at accepted increments (theorems.h). That of inelastic
 * strains (3.2) is evaluated on the body with its current contacts, the sliding
 * limit and given normal forces being given (problem Q3): a change of the
 * stresses of the points changes their e^i by the law over the increment, that
 * is a load on the elastic body, whose motion changes the stresses again.
 */
#include "effects/plan/effect.h"
#include "run/visco.h"

typedef struct checked {
  theorems *at_work;
  theorems_report report;
} checked;

/* Largest friction coefficient of the nodes of a contact now, -; 0 for laws
 * without one. */
static status largest_mu(const run *r, int contact_id, double *mu) {
  const friction_rule *rule =
      friction_in_force(r->m, run_step_id(r), contact_id);
  double own;
  *mu = 0.0;
  if (!rule_has_friction(rule) || strcmp(rule->law->value_unit, "-") != 0)
    return OK;
  for (int i = 0; i < r->nodes.n; ++i) {
    if (r->surface->contact_id[i] != contact_id) continue;
    PASS(friction_value(&rule->card, r->surface, i, r->now.t, &own));
    *mu = fmax(*mu, own);
  }
  return OK;
}

/* The current problem with a solution; mu[n_contact], given[n] are new. */
static status theorems_scene_new(run *r, const equilibrium *e,
                                 theorems_scene *s, double **mu,
                                 unsigned char **given) {
  PASS_NEW_ALL(OF(*mu, r->m->n.contact), OF(*given, r->nodes.n));
  for (int c = 0; c < r->m->n.contact; ++c) PASS(largest_mu(r, c, &(*mu)[c]));
  for (int i = 0; i < r->nodes.n; ++i)
    (*given)[i] = r->m->contacts[r->surface->contact_id[i]].force.given != 0;
  *s = (theorems_scene){
      .cp = &r->problem.cp,
      .u = e->uc,
      .r = e->rc,
      .n_contact = r->m->n.contact,
      .contact_id = r->surface->contact_id,
      .mu = *mu,
      .given = *given,
      .alone = r->step->kind == STEP_STATIC || r->course.relaxing,
      .tol = r->solving.tol};
  return OK;
}

typedef struct body_map {
  run *r;
  condensed *c; /* of the elastic body, borrowed */
  frozen_problem problem;
  linear_contact *contact;
  double *Q;          /* [ns*ns*n] of the points, 1/Pa */
  double *e0, *sigma; /* [ns*eigen.n] de^i, -; ds, Pa */
  double *F, *u;      /* [n_dof] */
  double *f, *du;     /* [m] */
  int begun;          /* 0: e0 is there */
} body_map;

/* own: where those of the run are of other moduli. */
static status elastic_body(run *r, matrices *own) {
  if (!r->body.stale) return OK;
  PASS(stiffness_assemble(&r->body.d, &own->k));
  return condense(own->k, &r->body.d, &own->c);
}

/* The contact of the elastic body, limit given, in the present states. */
static status linear_body(run *r, const unsigned char *given, body_map *b) {
  contact_problem cp = r->problem.cp;
  OWNED_NEW(unsigned char, none, r->nodes.n);
  cp.A = condensed_matrix(b->c);
  cp.op = condensed_operator(b->c);
  PASS(frozen_new(&cp, run_rows(r, 1, r->now.rc), none, given, &b->problem));
  return linear_contact_new(&b->problem.cp, run_rows(r, 0, r->now.uc),
                            b->problem.r, &b->contact);
}

static status body_map_new(run *r, const unsigned char *given, condensed *c,
                           body_map *b) {
  const visco *v = r->strains.visco;
  const size_t ns = r->m->ns, n = v->x.n;
  b->r = r;
  b->c = c;
  PASS_NEW(b->Q, ns * ns * n);
  PASS_NEW_REALS(ns * r->strains.eigen.n, &b->e0, &b->sigma);
  PASS_NEW_REALS(r->n_dof, &b->F, &b->u);
  PASS_NEW_REALS(r->nodes.n_c, &b->f, &b->du);
  PASS(linear_body(r, given, b));
  for (int k = 0; k < v->x.n; ++k)
    for (size_t i = 0; i < ns; ++i)
      b->e0[visco_at(r, v->place[k]) + i] =
          sin(1.0 + 2.0 * (double)(visco_at(r, k) + i));
  return OK;
}

/* e0 = Q sigma of all points. */
static void flow_by_law(body_map *b) {
  const visco *v = b->r->strains.visco;
  const int ns = b->r->m->ns;
  for (int k = 0; k < v->x.n; ++k) {
    size_t at = visco_at(b->r, v->place[k]);
    tensor_product(ns, b->Q + visco_at(b->r, ns * k), b->sigma + at,
                   b->e0 + at);
  }
}

/* sigma of e0 over its size, in the energy of the points. */
static status answer_of_body(void *ctx, double *size) {
  body_map *b = ctx;
  run *r = b->r;
  const visco *v = r->strains.visco;
  const eigenstrain x = {r->strains.eigen.n, r->strains.elem, b->e0};
  double square = 0.0;
  if (b->begun) flow_by_law(b);
  b->begun = 1;
  CLEAR(b->F, r->n_dof);
  eigen_force(&r->body.d, &x, b->F);
  PASS(condense_load(b->c, b->F, NULL, b->f));
  PASS(linear_contact_move(b->contact, b->f, b->du));
  PASS(condense_recover(b->c, b->du, b->u));
  double *elastic = v->stress;
  eigen_stress(&r->body.d, &x, b->u, elastic, b->sigma);
  for (int k = 0; k < v->x.n; ++k) {
    size_t at = visco_at(r, v->place[k]);
    square += v->x.weight[k] * dot(r->m->ns, elastic + at, b->sigma + at);
  }
  *size = sqrt(fmax(square, 0.0));
  for (size_t i = 0; *size > 0.0 && i < visco_at(r, r->strains.eigen.n); ++i)
    b->sigma[i] /= *size;
  return OK;
}

/* theta of the rule: an integrator without takes the middle of the step. */
static double theta_of(const step *s) {
  const int own =
      s->visco.integrator->has_theta || s->visco.integrator->theta > 0.0;
  return own ? s->visco.theta : 0.5;
}

/* Theorem 3.2 over the increment. */
static status see_path(run *r, const unsigned char *given, checked *own) {
  visco *v = r->strains.visco;
  theorems_path *out = &own->report.path;
  ENDS_BY(matrices_free) matrices elastic = {0};
  if (v == NULL || r->step->kind != STEP_VISCO) return OK;
  const scheme_step p = {
      .t = r->now.t, .dt = r->now.t - r->old.t, .theta = theta_of(r->step)};
  *out = (theorems_path){.asked = 1};
  PASS(elastic_body(r, &elastic));
  OWNED_PARTS(
      body_map, b,
      body_map_new(r, given, r->body.stale ? elastic.c : r->elastic.c, &b));
  const stress_map map = {&b, answer_of_body};
  PASS(flow_compliance(&v->x, &p, &v->old, &v->now, b.Q, &out->bound));
  if (b.contact == NULL)
    out->why = "nothing holds what is free under given friction";
  else if (out->bound > 0.0)
    PASS(theorems_path_rate(&map, &out->rate));
  theorems_path_learn(own->at_work, p.theta, p.dt, r->now.t - r->step->start,
                      out);
  own->report.violated |= out->violated;
  return OK;
}

static status check_theorems(run *r, checked *own, int at_start) {
  theorems_scene s;
  OWNED double *mu = NULL;
  OWNED unsigned char *given = NULL;
  own->report = (theorems_report){0};
  PASS(theorems_scene_new(r, at_start ? &r->old : &r->now, &s, &mu, &given));
  if (at_start)
    PASS(theorems_start(own->at_work, &s));
  else
    PASS(theorems_check(own->at_work, &s, &own->report));
  if (!at_start) PASS(see_path(r, given, own));
  r->at.violated = own->report.violated;
  return OK;
}

static status see_increment(run *r, void *own) {
  return check_theorems(r, own, 0);
}

static status see_start(run *r, void *own) { return check_theorems(r, own, 1); }

static int is_checked(const step *s) { return s->accuracy.theorems; }

static int requires_theorems(const model *m, const reason *why) {
  if (facts_first_step(m, is_checked) != NULL && m->n.contact == 0)
    return plan_says(0, why, "no *CONTACT card");
  return plan_requires_accuracy(m, "THEORY", is_checked, why);
}

static effect_work expected(const plan_sizes *s) {
  double m = plan_contact_unknowns(s), n = s->contact;
  return (effect_work){n, "nodes", s->increments,
                       m * m * m + s->increments * 80.0 * (m * m + 100.0 * n)};
}

static status checked_new(run *r, void **self) {
  return theorems_new(&((checked *)*self)->at_work);
}

static int due(const run *r) {
  return r->nodes.n > 0 && r->step->accuracy.theorems;
}

static void show(const void *self, state *s) {
  s->errors.theorems = ((const checked *)self)->report;
}

/* clang-format off */
const effect_ops theorems_effect = {
  .name = "theory checks", .bit = EFFECT_BIT_THEORY,
  .required = requires_theorems, .expected = expected, .own = STAGE_THEORY,
  .shadow = 1, .size = sizeof(checked),
  .on = {.create = checked_new, .due = due, .initial = see_start,
         .accept = see_increment, .show = show}};
/* clang-format on */
