/*
 * Candidates for a trial: criteria from the deck alone. The estimates of
 * measure.c decide afterwards, so that a wrong candidate costs only time.
 *
 *   nonlocal average   RADIUS below the shortest distance of two contact nodes:
 *                      each node then is its own average, the solution the same
 *   thermal strain     alpha |T - T_I| below SHARE * TOL times the strain of
 *                      the loads
 *   inelastic strain   of a material: its rate under the largest load, over all
 *                      *VISCO steps, below the same; zero where that load is
 *                      below the threshold of the law
 *   friction           mu times the increments below (2 SHARE TOL)^2, which the
 *                      bound may confirm if slip stores a tenth of the energy,
 *                      or no lateral expansion (nu = 0), where no motion of a
 *                      body is held by friction
 */
#include "effects/plan/effect.h"
#include "effects/reduction/parts.h"

/*
 * Materials to try without their law: it flows too little, or it is always in
 * its final state, so that elastic constants replace it; and elements of a
 * material with a threshold (its rate is exactly zero below) that stay below
 * it. For these a run of the elastic bodies over the same loads, in few
 * increments, gives the stresses; elements below the threshold with a margin
 * are tried without the law, since flow elsewhere redistributes stresses. The
 * run itself checks it: the rate of the law at these elements must be zero, or
 * adds to the bound as any other.
 */

static double visco_time(const model *m) {
  double t = 0.0;
  for (int i = 0; i < m->n.step; ++i)
    if (m->steps[i].kind == STEP_VISCO) t += m->steps[i].total;
  return t;
}

/* 1: the rate at the start does not bound later ones. */
static int hardens(const law_point *p) {
  enum { NORTON_M = 2 };
  if (p->law->ops == &user_law) return 1;
  return p->law->ops == &norton_law && p->value[NORTON_M] != 0.0;
}

/* Largest rate of the law under a uniaxial stress, 1/s. */
static status uniaxial_rate(const material *mat, kinematics kin, double stress,
                            double *rate) {
  ENDS_BY(law_sample_free) law_sample x = {0};
  double sigma[6] = {0.0, stress}, ei_rate[6] = {0.0};
  double alpha_rate[FLOW_VALUE_MAX], most = 0.0;
  PASS(law_sample_at(&mat->elastic, &mat->law, kin, 0.0, &x));
  x.p.sigma = sigma;
  law_rate(&x.p, ei_rate, alpha_rate);
  for (int i = 0; i < x.kind.elastic.ns; ++i)
    most = fmax(most, fabs(ei_rate[i]));
  const int unknown = isnan(ei_rate[0] + ei_rate[1]) || hardens(&x.p);
  *rate = unknown ? HUGE_VAL : most;
  return OK;
}

/* *tried: 1 if there is a row. */
static status try_small(model *m, const mesh *msh, int id, int *tried) {
  material *mat = &m->materials[id];
  double rate, young = reduction_young(mat);
  *tried = 0;
  double stress = reduction_load_stress(m, msh, young);
  if (!(stress > 0.0)) return OK;
  PASS(uniaxial_rate(mat, (kinematics)reduction_kinematics(m, id), stress,
                     &rate));
  double share = rate * visco_time(m) * young / stress;
  if (!(share <= reduction_share * m->reduction.tol)) return OK;
  omitted *row = reduction_row(m, EFFECT_BIT_INELASTIC, id);
  if (row == NULL) return OK;
  *tried = 1;
  if (rate > 0.0)
    snprintf(row->why, sizeof row->why,
             "material %s: %.1e of the strain of the loads in all *VISCO steps",
             mat->name, share);
  else
    snprintf(row->why, sizeof row->why,
             "material %s: the loads are below the threshold of %s", mat->name,
             mat->law.ops->name);
  return OK;
}

/* The shortest increment if the law flows in all steps and the integrator damps
 * fast terms; else 0. */
static double damped_increment(const model *m) {
  double least = HUGE_VAL;
  for (EACH(const step, s, m->steps, m->n.step)) {
    if (s->kind != STEP_VISCO) return 0.0;
    if (!s->visco.integrator->linear_only && s->visco.theta != 1.0) return 0.0;
    least = fmin(least, s->dt);
  }
  return least;
}

/* R[ns*ns] of the law under the kinematics and its time; <= 0: it has none. */
static status relaxed_law(const material *mat, kinematics kin, double *R,
                          double *time) {
  ENDS_BY(law_sample_free) law_sample x = {0};
  *time = 0.0;
  if (mat->law.ops->relaxed == NULL) return OK;
  PASS(law_sample_at(&mat->elastic, &mat->law, kin, 0.0, &x));
  *time = mat->law.ops->relaxed(&x.p, R);
  return OK;
}

/* E and nu that go with the compliance S + R[6*6]. */
static void relaxed_constants(const elastic_constants *from, const double *R,
                              elastic_constants *to) {
  const double young = from->constant[0], nu = from->constant[1];
  *to = *from;
  to->constant[0] = 1.0 / (1.0 / young + R[0]);
  to->constant[1] = (nu / young - R[1]) * to->constant[0];
}

static status try_relaxed(model *m, int id) {
  material *mat = &m->materials[id];
  double R[36], time, dt = damped_increment(m);
  if (!(dt > 0.0) || mat->elastic.type != ELASTIC_ISO) return OK;
  PASS(relaxed_law(mat, SOLID_3D, R, &time));
  if (!(time > 0.0) || !(time <= reduction_share * m->reduction.tol * dt))
    return OK;
  omitted *row = reduction_row(m, EFFECT_BIT_INELASTIC, id);
  if (row == NULL) return OK;
  row->time = time;
  relaxed_constants(&mat->elastic.set[0], R, &mat->elastic_aside);
  PASS(relaxed_law(mat, (kinematics)reduction_kinematics(m, id), mat->relaxed,
                   &time));
  snprintf(row->why, sizeof row->why,
           "material %s: %s ends within %.3g, %.1e of an increment; E = %.6g, "
           "nu = %.6g replace it",
           mat->name, mat->law.ops->name, time, time / dt,
           mat->elastic_aside.constant[0], mat->elastic_aside.constant[1]);
  return OK;
}

static status try_law(model *m, const mesh *msh, int id) {
  const material *mat = &m->materials[id];
  int tried;
  if (mat->law.ops == NULL || reduction_kinematics(m, id) < 0 ||
      mat->elastic.n != 1 || law_varies(&mat->law) != 0)
    return OK;
  PASS(try_small(m, msh, id, &tried));
  if (!tried) PASS(try_relaxed(m, id));
  return OK;
}

static const double margin = 1.5; /* of stresses, - */
enum {
  PIECES = 8,
  WORTH = 4
}; /* increments of a step; the run has so many
      times those of the elastic one */

typedef struct preview {
  reduction *n;
  unsigned char *flows; /* [n_elem] 1: near its threshold */
  status st;
} preview;

static int is_tried(const model *m, int id) {
  for (int k = 0; k < m->reduction.n; ++k)
    if (m->reduction.row[k].bit == EFFECT_BIT_INELASTIC &&
        m->reduction.row[k].id == id)
      return 1;
  return 0;
}

static int has_threshold(const model *m, int id) {
  const material *mat = &m->materials[id];
  return mat->law.ops != NULL && mat->law.ops->flows != NULL &&
         mat->elastic.n == 1 && law_varies(&mat->law) == 0 &&
         reduction_kinematics(m, id) >= 0 && !is_tried(m, id);
}

static double short_step(const step *s) {
  return fmax(s->dt, s->total / PIECES);
}

/* 1: the elastic run is short compared with the other. */
static int is_worth_it(const model *m) {
  double few = 0.0, all = 0.0;
  int any = 0;
  for (int i = 0; i < m->n.material; ++i) any |= has_threshold(m, i);
  for (int i = 0; i < m->n.step; ++i) {
    few += reduction_increments(&m->steps[i], short_step(&m->steps[i]));
    all += reduction_increments(&m->steps[i], m->steps[i].dt);
  }
  return any && all >= WORTH * few;
}

/* Elements of one material whose law flows under the margin of the stresses. */
static status see_material(preview *p, int id, double t) {
  const reduction *n = p->n;
  const model *m = n->m;
  const material *mat = &m->materials[id];
  law_card law = mat->law;
  ENDS_BY(law_sample_free) law_sample x = {0};
  double sigma[6];
  law.ops = mat->law_aside;
  PASS(law_sample_at(&mat->elastic, &law,
                     (kinematics)reduction_kinematics(m, id), t, &x));
  x.p.sigma = sigma;
  for (int e = 0; e < n->msh->n_elem; ++e) {
    if (p->flows[e] || reduction_material(n, e) != mat) continue;
    for (int i = 0; i < m->ns; ++i) sigma[i] = margin * n->sigma[m->ns * e + i];
    p->flows[e] = (unsigned char)law_flows(&x.p);
  }
  return OK;
}

static status see_increment(void *ctx, const state *s) {
  preview *p = ctx;
  const model *m = p->n->m;
  p->st = reduction_stress(p->n, s);
  for (int i = 0; i < m->n.material && p->st == OK; ++i)
    if (m->materials[i].law_aside != NULL &&
        m->materials[i].law_aside->flows != NULL)
      p->st = see_material(p, i, s->t);
  return p->st;
}

/* The elastic run; *seen 1 if it came to its end. */
static status run_elastic(model *m, const mesh *msh, unsigned char *flows,
                          int *seen) {
  preview p = {.flows = flows};
  const history_sink sink = {.ctx = &p, .increment = see_increment};
  int unsettled = 0;
  OWNED_NEW(double, dt, m->n.step);
  for (int i = 0; i < m->n.step; ++i) dt[i] = m->steps[i].dt;
  for (int i = 0; i < m->n.material; ++i) {
    m->materials[i].law_aside = m->materials[i].law.ops;
    m->materials[i].law.ops = NULL;
  }
  for (int i = 0; i < m->n.step; ++i) m->steps[i].dt = short_step(&m->steps[i]);
  m->effects = effects_required(m);
  const message_mark before = message_now(m->log);
  p.st = reduction_new(m, msh, &p.n);
  *seen =
      p.st == OK && history_run(m, msh, effect_table, &sink, &unsettled) == OK;
  message_forget(m->log, before);
  for (int i = 0; i < m->n.step; ++i) m->steps[i].dt = dt[i];
  reduction_restore(m);
  memory_free(p.n);
  return p.st;
}

static void add_rows(model *m, const mesh *msh, const unsigned char *flows) {
  for (int i = 0; i < m->n.material; ++i) {
    int n = 0, all = 0;
    if (!has_threshold(m, i)) continue;
    for (int e = 0; e < msh->n_elem; ++e) {
      if (m->sections[m->elem_section[e]].material_id != i) continue;
      ++all;
      m->reduction.still[e] = !flows[e];
      n += m->reduction.still[e];
    }
    omitted *row = n > 0 ? reduction_row(m, EFFECT_BIT_INELASTIC, i) : NULL;
    if (row == NULL) continue;
    row->some = n < all ? n : 0;
    snprintf(row->why, sizeof row->why,
             "material %s: %d of %d elements stay below the threshold of %s",
             m->materials[i].name, n, all, m->materials[i].law.ops->name);
  }
}

static status try_threshold(model *m, const mesh *msh) {
  int seen = 0;
  if (!is_worth_it(m)) return OK;
  OWNED_NEW(unsigned char, flows, msh->n_elem);
  PASS(run_elastic(m, msh, flows, &seen));
  if (!seen) return OK;
  OWNS(m);
  if (m->reduction.still == NULL) PASS_NEW(m->reduction.still, msh->n_elem);
  add_rows(m, msh, flows);
  return OK;
}

static status reduction_try_laws(model *m, const mesh *msh) {
  if (!(m->effects & EFFECT_INELASTIC) || reduction_has_initial(m)) return OK;
  for (int i = 0; i < m->n.material; ++i) PASS(try_law(m, msh, i));
  return try_threshold(m, msh);
}

/* Largest temperature the deck gives as a number; HUGE_VAL: by other means. */
static double largest_temperature(const model *m) {
  double most = 0.0;
  for (int i = 0; i < m->n.step; ++i)
    for (EACH(const load, l, m->steps[i].loads.item, m->steps[i].loads.n)) {
      if (l->kind != LOAD_TEMPERATURE) continue;
      if (l->value.formula != NULL || l->file != NULL) return HUGE_VAL;
      most = fmax(most, fabs(l->value.number));
    }
  for (int i = 0; i < m->n.initial; ++i)
    if (m->initial.lines[i].type == INITIAL_TEMPERATURE) return HUGE_VAL;
  return most;
}

/* *jumps 1: a *VISCO step starts with other temperatures than were there
 * before, to which a body that creeps responds at once, by an increment. */
static status find_jump(const model *m, const mesh *msh, int *jumps) {
  OWNED double *T0 = NULL, *before = NULL, *T = NULL;
  *jumps = 0;
  PASS_NEW_REALS(msh->n_elem, &T0, &before, &T);
  PASS(load_temperature_initial(m, msh, T0));
  COPY(before, T0, msh->n_elem);
  for (EACH(const step, s, m->steps, m->n.step)) {
    PASS(load_temperature(m, msh, s, s->start, T0, T));
    for (int e = 0; e < msh->n_elem && s->kind == STEP_VISCO; ++e)
      *jumps |= fabs(T[e] - before[e]) > 1e-12 * fabs(T[e]);
    PASS(load_temperature(m, msh, s, s->start + s->total, T0, before));
  }
  return OK;
}

/* The largest thermal strain over that of the loads; HUGE_VAL: not known. */
static double thermal_part(const model *m, const mesh *msh) {
  double T = largest_temperature(m), worst = 0.0;
  if (!(T < HUGE_VAL)) return HUGE_VAL;
  for (EACH(const material, mat, m->materials, m->n.material)) {
    double e[3];
    if (!mat->used) continue;
    if (mat->elastic.n > 1 ||
        (mat->law.ops != NULL &&
         (law_varies(&mat->law) & LAW_VARIES_TEMPERATURE)))
      return HUGE_VAL;
    double strain = reduction_load_stress(m, msh, reduction_young(mat)) /
                    reduction_young(mat);
    if (!mat->expand.given) continue;
    expansion_strain(&mat->expand, T, 0.0, e);
    for (int k = 0; k < 3; ++k) worst = fmax(worst, fabs(e[k]) / strain);
  }
  return worst;
}

static status try_thermal(model *m, const mesh *msh) {
  int jumps;
  if (!(m->effects & EFFECT_THERMAL)) return OK;
  double worst = thermal_part(m, msh);
  if (!(worst <= reduction_share * m->reduction.tol)) return OK;
  if (m->effects & EFFECT_INELASTIC) {
    PASS(find_jump(m, msh, &jumps));
    if (jumps) return OK;
  }
  omitted *row = reduction_row(m, EFFECT_BIT_THERMAL, -1);
  if (row == NULL) return OK;
  snprintf(row->why, sizeof row->why, "at most %.1e of the strain of the loads",
           worst);
  return OK;
}

/* Shortest distance of two nodes of a contact, length. */
static double least_distance(const mesh *msh, const mesh_group *g) {
  double least = HUGE_VAL;
  for (int i = 0; i < g->n_node; ++i)
    for (int k = 0; k < i; ++k)
      least = fmin(least, distance_of(msh->dim, mesh_node_x(msh, g->node_id[i]),
                                      mesh_node_x(msh, g->node_id[k])));
  return least;
}

/* Value of an option of a law by name; NAN: it has none of that type. */
static double option_value(const friction_rule *rule, const char *name) {
  for (const option *o = rule->law->options; o->name != NULL; ++o) {
    const char *at = (const char *)rule->card.param + o->offset;
    if (strcmp(o->name, name) != 0) continue;
    if (o->type == OPT_REAL) return *(const double *)(const void *)at;
    return *(const int *)(const void *)at;
  }
  return NAN;
}

/* 1: each node has none but itself within the radius, and friction acts on the
 * whole surface. */
static int is_local(const friction_rule *rule, double least) {
  static const char *const plain[] = {"ZONE", "MIRROR_X", "MIRROR_Y",
                                      "MIRROR_Z"};
  for (int k = 0; k < 4; ++k) {
    double value = option_value(rule, plain[k]);
    if (!isnan(value) && value != 0.0) return 0;
  }
  return option_value(rule, "RADIUS") < (1.0 - 1e-6) * least;
}

static void try_average(model *m, const mesh *msh) {
  int any = 0;
  double least = HUGE_VAL;
  for (int i = 0; i < m->n.contact; ++i) {
    double own = -1.0;
    for (int k = 0; k < m->n.step; ++k) {
      const friction_rule *rule = friction_in_force(m, k, i);
      if (!rule_has_average(rule)) continue;
      if (own < 0.0)
        own = least_distance(msh, &msh->group[m->contacts[i].group_id]);
      if (!is_local(rule, own)) return;
      least = fmin(least, own);
      any = 1;
    }
  }
  omitted *row = any ? reduction_row(m, EFFECT_BIT_NONLOCAL, -1) : NULL;
  if (row != NULL)
    snprintf(row->why, sizeof row->why,
             "RADIUS is below %.3g, the least distance of contact nodes: the "
             "same as LAW=COULOMB",
             least);
}

static double all_increments(const model *m) {
  double n = 0.0;
  for (int i = 0; i < m->n.step; ++i)
    n += reduction_increments(&m->steps[i], m->steps[i].dt);
  return n;
}

/* The largest mu given as a number; HUGE_VAL: otherwise, or another law. */
static double largest_mu(const model *m) {
  double most = 0.0;
  for (int i = 0; i < m->n.contact; ++i)
    for (int k = 0; k < m->n.step; ++k) {
      const friction_rule *rule = friction_in_force(m, k, i);
      if (!rule_has_friction(rule)) continue;
      if (rule->law != &coulomb_friction || rule->card.value.formula != NULL)
        return HUGE_VAL;
      most = fmax(most, rule->card.value.number);
    }
  return most;
}

/* 1: no material expands across its load. */
static int has_no_coupling(const model *m) {
  for (EACH(const material, mat, m->materials, m->n.material)) {
    double most = reduction_young(mat);
    for (int k = 0; k < 9 && mat->used; ++k)
      if (k % 4 != 0 && fabs(mat->C[6 * (k / 3) + k % 3]) > 1e-12 * most)
        return 0;
  }
  return 1;
}

/* 1 if friction holds a body in some step. */
static status friction_holds(const model *m, const mesh *msh, int *holds) {
  OWNED free_motion *list = NULL;
  *holds = 0;
  for (int i = 0; i < m->n.step && !*holds; ++i) {
    int n = 0;
    PASS(history_motions(m, msh, effect_table, i, &n, &list));
    for (int k = 0; k < n; ++k) *holds |= list[k].held_by == HELD_BY_FRICTION;
    FORGET(list);
  }
  return OK;
}

static status try_friction(model *m, const mesh *msh) {
  double mu = largest_mu(m), part = 2.0 * reduction_share * m->reduction.tol;
  int holds = 0, small = mu * all_increments(m) <= part * part;
  if (!(m->effects & EFFECT_FRICTION) || (m->effects & EFFECT_GIVEN) ||
      !(mu < HUGE_VAL) || reduction_has_initial(m))
    return OK;
  if (!small && !has_no_coupling(m)) return OK;
  PASS(friction_holds(m, msh, &holds));
  if (holds) return OK;
  omitted *row = reduction_row(m, EFFECT_BIT_FRICTION, -1);
  if (row == NULL) return OK;
  if (small)
    snprintf(row->why, sizeof row->why, "mu is at most %.1e", mu);
  else
    snprintf(row->why, sizeof row->why,
             "no material expands across its load: no slip expected");
  return OK;
}

/* 1: needs the problem itself, not its solution, or moves on its own. */
static int must_stay(const model *m) {
  for (EACH(const step, s, m->steps, m->n.step))
    if (s->check != CHECK_NONE || s->accuracy.theorems ||
        s->output.condensed >= 0 || s->form == FORM_VELOCITY ||
        s->restart.frequency >= 0 || s->visco.tolerance > 0.0 ||
        s->accuracy.time_balanced)
      return 1;
  for (int i = 0; i < m->n.section; ++i)
    if (m->sections[i].averaged) return 1;
  if (m->n.points > 0) return 1;
  return model_has_target(m);
}

status reduction_choose(model *m, const mesh *msh) {
  m->reduction.n = 0;
  if (must_stay(m)) return OK;
  try_average(m, msh);
  PASS(try_thermal(m, msh));
  PASS(reduction_try_laws(m, msh));
  return try_friction(m, msh);
}
