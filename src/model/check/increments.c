/*
 * Increments of *VISCO steps against the laws: stability, ringing, integrators
 * that are exact for some laws only, creep that locks.
 */
#include "model/check/parts.h"

#include "model/cards/cards.h"

#include <math.h>

int step_has_limit(const step *s) {
  return !s->visco.integrator->linear_only && s->visco.theta < 1.0;
}

/* THETA < 1 turns the sign of what is much faster than dt at each step. */
static void report_ringing(const model *m, const step *s, double t, double dt,
                           double rate) {
  double theta = s->visco.theta, z = rate * dt;
  if (s->visco.integrator->limit > 0.0 || (1.0 - theta) * z <= 1.0) return;
  message_add(m->log, P2051, &s->at,
              "step %d, time %g: dt = %.6g is %.4g times the shortest "
              "relaxation time: THETA = %g multiplies what relaxes so fast by "
              "%.4f at each increment",
              (int)(s - m->steps) + 1, t, dt, z, theta,
              (1.0 - (1.0 - theta) * z) / (1.0 + theta * z));
}

int step_level(const model *m, const step *s, double t, double dt, double rate,
               int notify) {
  enum { DEEPEST = 30 };
  int level = 0;
  double limit = scheme_limit(s->visco.integrator, s->visco.theta) / rate;
  /* Ends of increments are sums: dt is known to the rounding of the time. */
  double rounding = 4e-16 * (fabs(t) + dt);
  if (notify) report_ringing(m, s, t, dt, rate);
  while (ldexp(dt, -level) > limit + rounding && level < DEEPEST) ++level;
  if (level == 0 || (s->visco.substeps && level < DEEPEST)) return level;
  message_add(m->log, P2050, &s->at,
              "step %d, time %g: %s is stable up to dt = %.9g (fastest rate "
              "%.9g), not with dt = %.9g%s; give a smaller dt, %sor "
              "INTEGRATOR=BACKWARD",
              (int)(s - m->steps) + 1, t, s->visco.integrator->name, limit,
              rate, dt, s->visco.substeps ? ", nor in 2^29 parts of it" : "",
              s->visco.substeps ? "" : "SUBSTEPS=AUTO, ");
  return -1;
}

static int is_constant(const material *mat) {
  return mat->law.ops->linear && law_varies(&mat->law) == 0 &&
         mat->elastic.n == 1;
}

/* Laws of the bodies under an integrator that is exact for constant ones. */
static void check_exact(const model *m, int step_id) {
  const step *s = &m->steps[step_id];
  for (int i = 0; i < m->n.section; ++i) {
    const material *mat = &m->materials[m->sections[i].material_id];
    const law_card *law = &mat->law;
    if (law->ops == NULL || is_constant(mat)) continue;
    message_add(m->log, P2054, &s->at,
                "step %d: INTEGRATOR=%s, but %s of material %s %s", step_id + 1,
                s->visco.integrator->name, law->ops->name, mat->name,
                !law->ops->linear ? "is not linear"
                : law_varies(law) & LAW_VARIES_TIME
                    ? "has coefficients that vary in time"
                : law_varies(law) != 0 ? "depends on temperature"
                                       : "has moduli that do");
  }
}

/* The fastest rate of the laws whose Jacobian is the same for ever, 1/s. */
static status constant_rate(const model *m, double *fastest) {
  status st = OK;
  static const double zero[FLOW_VALUE_MAX];
  flow_kind kind = {0};
  *fastest = 0.0;
  for (int i = 0; i < m->n.section; ++i) {
    const material *mat = &m->materials[m->sections[i].material_id];
    law_elastic elastic;
    law_point p;
    double rate;
    if (mat->law.ops == NULL || !is_constant(mat)) continue;
    TRY(law_elastic_read(&mat->elastic, 0.0, (kinematics)m->sections[i].kin,
                         &elastic));
    TRY(flow_new_kind(&kind, &mat->law, &elastic));
    TRY(flow_coefficients(&kind, 0.0, 0.0, NULL, &p));
    p.sigma = p.ei = p.alpha = zero;
    TRY(law_fastest_rate(&p, &rate));
    *fastest = fmax(*fastest, rate);
    flow_kind_free(&kind);
  }
done:
  flow_kind_free(&kind);
  return st;
}

/* 1: a mean stress alone makes nothing flow, as far as a shear does. */
static status keeps_volume(const section *s, const material *mat, int *answer) {
  status st = OK;
  static const double zero[FLOW_VALUE_MAX];
  double value[FLOW_VALUE_MAX], alpha_rate[FLOW_VALUE_MAX], ei_rate[6];
  flow_kind kind = {0};
  law_elastic elastic;
  law_point p;
  TRY(law_elastic_read(&mat->elastic, 0.0, (kinematics)s->kin, &elastic));
  TRY(flow_new_kind(&kind, &mat->law, &elastic));
  TRY(flow_coefficients(&kind, 0.0, 0.0, value, &p));
  const double size = 1e-3 * elastic.young;
  const double mean[6] = {size, size, size}, shear[6] = {0, 0, 0, size};
  p.ei = p.alpha = zero;
  p.speed = 1.0; /* whatever the temperature */
  p.sigma = mean;
  law_rate(&p, ei_rate, alpha_rate);
  double swelling = fabs(tensor_trace(ei_rate));
  p.sigma = shear;
  law_rate(&p, ei_rate, alpha_rate);
  *answer = swelling <= 1e-9 * fabs(ei_rate[3]);
done:
  flow_kind_free(&kind);
  return st;
}

/* Bodies that creep at constant volume become incompressible. */
static status check_creep(const model *m) {
  for (int i = 0; i < m->n.section; ++i) {
    const section *s = &m->sections[i];
    const material *mat = &m->materials[s->material_id];
    int locks = 0;
    if (mat->law.ops == NULL || s->kin == PLANE_STRESS || s->averaged) continue;
    PASS(keeps_volume(s, mat, &locks));
    if (locks)
      message_add(m->log, P2055, &s->at,
                  "law %s of material %s creeps at constant volume: where its "
                  "strains outgrow the elastic ones, linear elements lock",
                  mat->law.ops->name, mat->name);
  }
  return OK;
}

status check_visco(const model *m) {
  double rate;
  if (!(m->effects & EFFECT_INELASTIC)) return OK;
  PASS(constant_rate(m, &rate));
  if (has_card(m, "VISCO")) PASS(check_creep(m));
  for (int i = 0; i < m->n.step; ++i) {
    const step *s = &m->steps[i];
    if (s->kind != STEP_VISCO) continue;
    if (s->visco.integrator->linear_only) check_exact(m, i);
    if (step_has_limit(s) && rate > 0.0)
      step_level(m, s, s->start, s->dt, rate, 1);
  }
  return OK;
}
