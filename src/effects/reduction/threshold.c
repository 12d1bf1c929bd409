/*
 * Elements of a material with a threshold (its rate is exactly zero below) that
 * stay below it. A run of the elastic bodies over the same loads, in few
 * increments, gives the stresses; elements below the threshold with a margin
 * are tried without the law, since flow elsewhere redistributes stresses. The
 * run itself checks it: the rate of the law at these elements must be zero, or
 * adds to the bound as any other.
 */
#include "effects/reduction/parts.h"
#include "effects/rows.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

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
  status st = OK;
  const reduction *n = p->n;
  const model *m = n->m;
  const material *mat = &m->materials[id];
  law_card law = mat->law;
  law_elastic elastic;
  flow_kind kind = {0};
  law_point point;
  double value[FLOW_VALUE_MAX], sigma[6];
  static const double zero[FLOW_VALUE_MAX];
  law.ops = mat->law_aside;
  TRY(law_elastic_read(&mat->elastic, 0.0,
                       (kinematics)reduction_kinematics(m, id), &elastic));
  TRY(flow_new_kind(&kind, &law, &elastic));
  TRY(flow_coefficients(&kind, t, 0.0, value, &point));
  point.sigma = sigma;
  point.ei = point.alpha = zero;
  for (int e = 0; e < n->msh->n_elem; ++e) {
    if (p->flows[e] || reduction_material(n, e) != mat) continue;
    for (int i = 0; i < m->ns; ++i) sigma[i] = margin * n->sigma[m->ns * e + i];
    p->flows[e] = (unsigned char)law_flows(&point);
  }
done:
  flow_kind_free(&kind);
  return st;
}

static status see_increment(void *ctx, const state *s) {
  status st = OK;
  preview *p = ctx;
  const model *m = p->n->m;
  TRY(reduction_stress(p->n, s));
  for (int i = 0; i < m->n.material; ++i)
    if (m->materials[i].law_aside != NULL &&
        m->materials[i].law_aside->flows != NULL)
      TRY(see_material(p, i, s->t));
done:
  p->st = st;
  return st;
}

/* Without any law, in few increments. */
static void make_elastic(model *m) {
  for (int i = 0; i < m->n.material; ++i) {
    m->materials[i].law_aside = m->materials[i].law.ops;
    m->materials[i].law.ops = NULL;
  }
  for (int i = 0; i < m->n.step; ++i) m->steps[i].dt = short_step(&m->steps[i]);
  m->effects = effects_required(m);
}

/* The elastic run; *seen 1 if it came to its end. */
static status run_elastic(model *m, const mesh *msh, unsigned char *flows,
                          int *seen) {
  status st = OK;
  preview p = {.flows = flows};
  const history_sink sink = {.ctx = &p, .increment = see_increment};
  double *dt = NULL;
  int unsettled = 0;
  NEW(dt, m->n.step);
  for (int i = 0; i < m->n.step; ++i) dt[i] = m->steps[i].dt;
  make_elastic(m);
  TRY(reduction_new(m, msh, &p.n));
  *seen = history_run(m, msh, effect_table, &sink, &unsettled) == OK;
  st = p.st;
done:
  for (int i = 0; i < m->n.step && dt != NULL; ++i) m->steps[i].dt = dt[i];
  reduction_restore(m);
  reduction_free(p.n);
  memory_free(dt);
  return st;
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

status reduction_try_threshold(model *m, const mesh *msh) {
  OWNED unsigned char *flows = NULL;
  int seen = 0;
  if (!is_worth_it(m)) return OK;
  PASS_NEW(flows, msh->n_elem);
  PASS(run_elastic(m, msh, flows, &seen));
  if (!seen) return OK;
  if (m->reduction.still == NULL) PASS_NEW(m->reduction.still, msh->n_elem);
  add_rows(m, msh, flows);
  return OK;
}
