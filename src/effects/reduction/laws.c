/*
 * Materials to try without their law: it flows too little, or it is always in
 * its final state, so that elastic constants replace it.
 */
#include "effects/reduction/parts.h"

#include <math.h>
#include <string.h>

static double visco_time(const model *m) {
  double t = 0.0;
  for (int i = 0; i < m->n.step; ++i)
    if (m->steps[i].kind == STEP_VISCO) t += m->steps[i].total;
  return t;
}

/* ---- inelastic strain --------------------------------------------------- */

/* 1: the rate at the start does not bound later ones. */
static int hardens(const law_point *p) {
  enum { NORTON_M = 2 };
  if (p->law->ops == &user_law) return 1;
  return p->law->ops == &norton_law && p->value[NORTON_M] != 0.0;
}

/* Largest rate of the law under a uniaxial stress, 1/s. */
static status uniaxial_rate(const material *mat, kinematics kin, double stress,
                            double *rate) {
  status st = OK;
  flow_kind kind = {0};
  law_elastic elastic;
  law_point p;
  double value[FLOW_VALUE_MAX], sigma[6] = {0.0, stress}, ei_rate[6] = {0.0};
  static const double zero[FLOW_VALUE_MAX];
  double alpha_rate[FLOW_VALUE_MAX];
  *rate = 0.0;
  TRY(law_elastic_read(&mat->elastic, 0.0, kin, &elastic));
  TRY(flow_new_kind(&kind, &mat->law, &elastic));
  TRY(flow_coefficients(&kind, 0.0, 0.0, value, &p));
  p.sigma = sigma;
  p.ei = p.alpha = zero;
  law_rate(&p, ei_rate, alpha_rate);
  for (int i = 0; i < elastic.ns; ++i) *rate = fmax(*rate, fabs(ei_rate[i]));
  if (isnan(ei_rate[0] + ei_rate[1]) || hardens(&p)) *rate = HUGE_VAL;
done:
  flow_kind_free(&kind);
  return st;
}

/* ---- below what matters -------------------------------------------------- */

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

/* ---- final state -----------------------------------------------------------
 */

/* The shortest increment if the law flows in all steps and the integrator damps
 * fast terms; else 0. */
static double damped_increment(const model *m) {
  double least = HUGE_VAL;
  for (int i = 0; i < m->n.step; ++i) {
    const step *s = &m->steps[i];
    if (s->kind != STEP_VISCO) return 0.0;
    if (!s->visco.integrator->linear_only && s->visco.theta != 1.0) return 0.0;
    least = fmin(least, s->dt);
  }
  return least;
}

/* R[ns*ns] of the law under the kinematics and its time; <= 0: it has none. */
static status relaxed_law(const material *mat, kinematics kin, double *R,
                          double *time) {
  status st = OK;
  flow_kind kind = {0};
  law_elastic elastic;
  law_point p;
  double value[FLOW_VALUE_MAX];
  *time = 0.0;
  if (mat->law.ops->relaxed == NULL) goto done;
  TRY(law_elastic_read(&mat->elastic, 0.0, kin, &elastic));
  TRY(flow_new_kind(&kind, &mat->law, &elastic));
  TRY(flow_coefficients(&kind, 0.0, 0.0, value, &p));
  *time = mat->law.ops->relaxed(&p, R) / p.speed;
done:
  flow_kind_free(&kind);
  return st;
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

status reduction_try_laws(model *m, const mesh *msh) {
  if (!(m->effects & EFFECT_INELASTIC) || reduction_has_initial(m)) return OK;
  for (int i = 0; i < m->n.material; ++i) PASS(try_law(m, msh, i));
  return reduction_try_threshold(m, msh);
}
