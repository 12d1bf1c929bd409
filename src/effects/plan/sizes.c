/*
 * What the expected work is told from: sizes of the body and of the contact,
 * increments, contact problems and matrices, before anything is solved.
 */
#include "effects/plan/rows.h"

#include <math.h>

enum { ADAPTED = 50 }; /* increments of a step with a tolerance, at most      */

static double increments_of(const step *s) {
  double n = step_increments(s);
  return s->tolerance > 0.0 ? fmin(n, ADAPTED) : n;
}

/* Increments that an output with this frequency shows. */
static double shown_of(const step *s, int frequency) {
  if (frequency < 0) return 0.0;
  return frequency == 0 ? 1.0 : ceil(increments_of(s) / frequency);
}

double sizes_shown(const model *m, int table) {
  double n = 0.0;
  for (int i = 0; i < m->n_step; ++i) {
    const step *s = &m->steps[i];
    double here = table != 0 ? 0.0 : shown_of(s, s->output_frequency);
    for (int k = 0; k < s->n_print; ++k)
      if (table == 0 || s->prints[k].table == table)
        here = fmax(here, shown_of(s, s->prints[k].frequency));
    n += here;
  }
  return n;
}

/* 1 if all laws that flow have a constant Jacobian. */
static int flows_linearly(const model *m) {
  for (int i = 0; i < m->n_section; ++i) {
    const law_card *law = &plan_material(m, i)->law;
    if (law->ops != NULL && !law->ops->linear) return 0;
  }
  return 1;
}

enum { NEWTON_STEPS = 4 }; /* of an implicit step of a law that is not linear */

/* Contact problems of an increment of a step. */
static double problems_of(const model *m, const step *s) {
  if (s->kind != STEP_VISCO || !(m->effects & EFFECT_INELASTIC)) return 1.0;
  const scheme *i = s->integrator;
  if (!i->has_theta && i->theta == 0.0 && !i->linear_only) return i->order;
  return flows_linearly(m) ? 1.0 : NEWTON_STEPS;
}

static double factors_of(const model *m, const step *s) {
  if (s->kind != STEP_VISCO || !(m->effects & EFFECT_INELASTIC)) return 0.0;
  const scheme *i = s->integrator;
  if (!i->has_theta && i->theta == 0.0 && !i->linear_only) return 0.0;
  if (flows_linearly(m)) return 1.0;
  return s->initial ? 0.0 : NEWTON_STEPS * increments_of(s);
}

static void count_increments(const model *m, plan_sizes *s) {
  s->factors = 1.0;
  s->flows_linearly = flows_linearly(m);
  for (int i = 0; i < m->n_step; ++i) {
    double n = increments_of(&m->steps[i]);
    s->increments += n;
    s->equilibria += n * problems_of(m, &m->steps[i]);
    s->factors += factors_of(m, &m->steps[i]);
  }
}

status sizes_find(const model *m, const mesh *msh, int n, plan_sizes *s) {
  status st = OK;
  double held, nodes;
  *s = (plan_sizes){.dim = m->dim, .ns = m->ns, .is_flat = m->dim < 3};
  count_increments(m, s);
  s->contact = n;
  if (msh != NULL) {
    s->nodes = msh->n_node;
    s->elements = msh->n_elem;
    TRY(items_held_unknowns(m, msh, &held, &nodes));
    s->unknowns = (double)msh->dim * msh->n_node - held;
    TRY(items_contact_nodes(m, msh, NULL, &s->contact));
  }
  if (m->effects & EFFECT_TANGENTS) s->tangents = (s->dim - 1) * s->contact;
done:
  return st;
}

/*
 * Above the peaks measured over the examples: the factor; the condensed matrix,
 * its factor and three matrices of a solver; OF_ELEMENT bytes for what
 * assembly, ordering and fields take; BUFFERS of the files. A law that flows
 * has a matrix of its own beside the elastic one, and the strains of the stages
 * of its steps.
 */
status plan_memory(const model *m, const mesh *msh, double nodes,
                   plan_bytes *b) {
  enum { MATRICES = 5, OF_ELEMENT = 500, STAGES = 24, BUFFERS = 2000000 };
  status st = OK;
  plan_sizes s;
  TRY(sizes_find(m, msh, 0, &s));
  double all = s.contact + s.tangents, real = sizeof(double);
  double dofs = nodes >= 0.0 && s.contact > 0.0 ? nodes / s.contact * all : all;
  double sets = s.factors > 1.0 ? 2.0 : 1.0;
  b->factor = sets * real * work_factor_entries(&s);
  b->contact = sets * MATRICES * real * dofs * dofs;
  b->rest = BUFFERS + s.elements * OF_ELEMENT;
  if (m->effects & EFFECT_INELASTIC)
    b->rest += s.elements * STAGES * real * s.ns;
done:
  return st;
}
