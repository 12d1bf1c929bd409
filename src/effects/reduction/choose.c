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
#include "effects/reduction/parts.h"
#include "effects/rows.h"

#include "base/memory.h"
#include "fem/fem.h"

#include <math.h>
#include <string.h>

/* Largest temperature the deck gives as a number; HUGE_VAL: by other means. */
static double largest_temperature(const model *m) {
  double most = 0.0;
  for (int i = 0; i < m->n.step; ++i)
    for (int k = 0; k < m->steps[i].loads.n; ++k) {
      const load *l = &m->steps[i].loads.item[k];
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
  const size_t bytes = (size_t)msh->n_elem * sizeof *T;
  *jumps = 0;
  PASS_NEW_REALS(msh->n_elem, &T0, &before, &T);
  PASS(load_temperature_initial(m, msh, T0));
  memcpy(before, T0, bytes);
  for (int i = 0; i < m->n.step; ++i) {
    const step *s = &m->steps[i];
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
  for (int i = 0; i < m->n.material; ++i) {
    const material *mat = &m->materials[i];
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
  int dim = msh->dim;
  for (int i = 0; i < g->n_node; ++i)
    for (int k = 0; k < i; ++k) {
      double square = 0.0;
      for (int c = 0; c < dim; ++c) {
        double d =
            msh->x[dim * g->node_id[i] + c] - msh->x[dim * g->node_id[k] + c];
        square += d * d;
      }
      least = fmin(least, square);
    }
  return sqrt(least);
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
  for (int i = 0; i < m->n.material; ++i) {
    const material *mat = &m->materials[i];
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
    memory_free(list);
    list = NULL;
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
  for (int i = 0; i < m->n.step; ++i) {
    const step *s = &m->steps[i];
    if (s->check != CHECK_NONE || s->accuracy.theorems ||
        s->output.condensed >= 0 || s->form == FORM_VELOCITY ||
        s->restart.frequency >= 0 || s->visco.tolerance > 0.0 ||
        s->accuracy.time_balanced)
      return 1;
  }
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
