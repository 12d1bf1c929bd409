/*
 * Input of the expected work: sizes of the body and of the contact, increments,
 * contact problems and matrices, before anything is solved.
 *
 * An operation is about a nanosecond of one core: one multiplication and
 * addition of scattered data, PLAN_SPARSE of them in a supernode of the sparse
 * factor, PLAN_DENSE of them in a product of dense matrices, and the move of
 * one double that is read in passing. Nested dissection leaves 7 n log2 n
 * entries and 60 n^1.5 operations in the factor in the plane, 25 n^(4/3) and 28
 * n^2 in space; a solve goes through the entries twice; the condensed matrix is
 * dense. Constants were fitted to the examples; they are good to a factor of
 * two or three, as is the number of iterations that a contact problem needs.
 */
#include "effects/plan/plan.h"

/* Increments that an output with this frequency shows. */
static double shown_of(const step *s, int frequency) {
  if (frequency < 0) return 0.0;
  return frequency == 0 ? 1.0 : ceil(step_increments(s) / frequency);
}

double plan_shown(const model *m, int table) {
  double n = 0.0;
  for (EACH(const step, s, m->steps, m->n.step)) {
    double here = table != 0 ? 0.0 : shown_of(s, s->output.frequency);
    for (int k = 0; k < s->print.n; ++k)
      if (table == 0 || s->print.requests[k].table == table)
        here = fmax(here, shown_of(s, s->print.requests[k].frequency));
    n += here;
  }
  return n;
}

/* 1 if all laws that flow have a constant Jacobian. */
static int flows_linearly(const model *m) {
  for (int i = 0; i < m->n.section; ++i) {
    const law_card *law = &plan_material(m, i)->law;
    if (law->ops != NULL && !law->ops->linear) return 0;
  }
  return 1;
}

enum { NEWTON_STEPS = 4 }; /* of an implicit step of a law that is not linear */

/* Contact problems of an increment of a step. */
static double problems_of(const model *m, const step *s) {
  if (s->kind != STEP_VISCO || !(m->effects & EFFECT_INELASTIC)) return 1.0;
  const scheme *i = s->visco.integrator;
  if (!i->has_theta && i->theta == 0.0 && !i->linear_only) return i->order;
  return flows_linearly(m) ? 1.0 : NEWTON_STEPS;
}

static double factors_of(const model *m, const step *s) {
  if (s->kind != STEP_VISCO || !(m->effects & EFFECT_INELASTIC)) return 0.0;
  const scheme *i = s->visco.integrator;
  if (!i->has_theta && i->theta == 0.0 && !i->linear_only) return 0.0;
  if (flows_linearly(m)) return 1.0;
  return s->visco.initial ? 0.0 : NEWTON_STEPS * step_increments(s);
}

static void count_increments(const model *m, plan_sizes *s) {
  s->factors = 1.0;
  s->flows_linearly = flows_linearly(m);
  for (int i = 0; i < m->n.step; ++i) {
    double n = step_increments(&m->steps[i]);
    s->increments += n;
    s->equilibria += n * problems_of(m, &m->steps[i]);
    s->factors += factors_of(m, &m->steps[i]);
  }
}

/* Nodes of the contacts with a rule that "is", each once; NULL: of all. */
static status contact_nodes(const plan_sizes *s,
                            int (*is)(const friction_rule *rule), double *n) {
  const model *m = s->m;
  const mesh *msh = s->msh;
  *n = 0.0;
  OWNED_NEW(unsigned char, seen, msh->n_node);
  for (int i = 0; i < m->n.contact; ++i) {
    const mesh_group *g = &msh->group[m->contacts[i].group_id];
    int counts = is == NULL;
    for (int k = 0; k < m->n.step && !counts; ++k)
      counts = is(friction_in_force(m, k, i));
    for (int k = 0; k < g->n_node && counts; ++k) {
      *n += !seen[g->node_id[k]];
      seen[g->node_id[k]] = 1;
    }
  }
  return OK;
}

/* Displacements that supports hold in the first step, and their nodes. */
static status count_held(const plan_sizes *s, double *unknowns, double *nodes) {
  const model *m = s->m;
  const mesh *msh = s->msh;
  int dim = msh->dim;
  *unknowns = *nodes = 0.0;
  OWNED_NEW(unsigned char, fixed, dim * msh->n_node);
  if (m->n.step > 0) load_fixed(msh, &m->steps[0], fixed);
  for (int i = 0; i < msh->n_node; ++i) {
    int any = 0;
    for (int c = 0; c < dim; ++c) any += fixed[dim * i + c] != 0;
    *unknowns += any;
    *nodes += any > 0;
  }
  return OK;
}

const material *plan_material(const model *m, int section_id) {
  static const material unknown;
  int id = m->sections[section_id].material_id;
  return id >= 0 ? &m->materials[id] : &unknown;
}

double plan_section_elements(const plan_sizes *s, int id) {
  double n = 0.0;
  for (int e = 0; e < s->msh->n_elem; ++e) n += s->m->elem_section[e] == id;
  return n;
}

double plan_contact_unknowns(const plan_sizes *s) {
  return s->contact + s->tangents;
}

double work_factor_flops(const plan_sizes *s) {
  double n = s->unknowns;
  return s->is_flat ? 60.0 * pow(n, 1.5) : 28.0 * n * n;
}

double work_factor_entries(const plan_sizes *s) {
  double n = fmax(2.0, s->unknowns);
  return s->is_flat ? 7.0 * n * log2(n) : 25.0 * n * cbrt(n);
}

double plan_element_work(const plan_sizes *s) {
  return s->is_flat ? 60.0 : 200.0;
}

double plan_contact_work(const plan_sizes *s, double m) {
  double condense = m * m * m / 3.0 / PLAN_DENSE + 4.0 * m * m;
  double factor = m * m * m / 3.0 / PLAN_DENSE;
  return s->factors * condense +
         s->equilibria * (PLAN_STEPS * 2.0 * m * m + 0.5 * factor);
}

status plan_sizes_find(const model *m, const mesh *msh, int n, plan_sizes *s) {
  double held;
  *s = (plan_sizes){.m = m,
                    .msh = msh,
                    .dim = m->dim,
                    .ns = m->ns,
                    .is_flat = m->dim < 3,
                    .shown = plan_shown(m, 0)};
  count_increments(m, s);
  s->contact = s->friction = n;
  if (msh != NULL) {
    s->nodes = msh->n_node;
    s->elements = msh->n_elem;
    PASS(count_held(s, &held, &s->held));
    s->unknowns = (double)msh->dim * msh->n_node - held;
    PASS(contact_nodes(s, NULL, &s->contact));
    PASS(contact_nodes(s, rule_has_friction, &s->friction));
    PASS(contact_nodes(s, rule_has_average, &s->averages));
  }
  if (m->effects & EFFECT_TANGENTS) s->tangents = (s->dim - 1) * s->contact;
  return OK;
}

/*
 * Above the peaks measured over the examples: the factor; the condensed matrix,
 * its factor and three matrices of a solver; OF_ELEMENT bytes for what
 * assembly, ordering and fields take; BUFFERS of the files. A law that flows
 * has a matrix in addition to the elastic one, and the strains of the stages of
 * its steps.
 */
status plan_memory(const model *m, const mesh *msh, double nodes,
                   const stiffness_choice *choice, plan_bytes *b) {
  enum { MATRICES = 5, OF_ELEMENT = 500, STAGES = 24, BUFFERS = 2000000 };
  plan_sizes s;
  PASS(plan_sizes_find(m, msh, 0, &s));
  double all = s.contact + s.tangents, real = sizeof(double);
  double dofs = nodes >= 0.0 && s.contact > 0.0 ? nodes / s.contact * all : all;
  double sets = s.factors > 1.0 ? 2.0 : 1.0;
  b->factor = sets * real * work_factor_entries(&s);
  b->contact = sets * MATRICES * real * dofs * dofs;
  if (choice != NULL && choice->sparse) {
    b->factor = sets * choice->factor.bytes;
    b->contact = 0.0;
  }
  b->rest = BUFFERS + s.elements * OF_ELEMENT;
  if (m->effects & EFFECT_INELASTIC)
    b->rest += s.elements * STAGES * real * s.ns;
  return OK;
}

status plan_expect(const model *m, const mesh *msh, int n,
                   const stiffness_choice *choice) {
  plan_bytes b;
  PASS(plan_memory(m, msh, n, choice, &b));
  return memory_require(b.factor + b.contact + b.rest, "the run");
}
