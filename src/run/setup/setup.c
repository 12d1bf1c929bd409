/*
 * A run before its first step: arrays that persist during the run, from the
 * model and the mesh.
 */
#include "run/setup/setup.h"

static status new_equilibrium(const run *r, equilibrium *e) {
  PASS_NEW_REALS(r->n_dof, &e->u, &e->F, &e->reaction);
  return OK;
}

/* Clusters of the sections with FORMULATION=AVERAGED. Sections with variable
 * moduli are averaged like those that flow. */
static status new_clusters(run *r) {
  const model *m = r->m;
  int averaged = 0;
  for (int i = 0; i < m->n.section; ++i) averaged |= m->sections[i].averaged;
  if (!averaged) return OK;
  TIMED(STAGE_CLUSTER);
  OWNED_NEW(double, share, m->n.section);
  for (int i = 0; i < m->n.section; ++i) {
    const section *s = &m->sections[i];
    const material *mat = &m->materials[s->material_id];
    if (s->averaged && s->kin != PLANE_STRESS)
      share[i] =
          cluster_share(m->ns, r->body.moduli.E + (size_t)(m->ns * m->ns) * i,
                        mat->law.ops != NULL || mat->elastic.n > 1);
  }
  const cluster_input in = {r->msh, m->sections[0].kin == AXISYMMETRIC,
                            m->n.section, m->elem_section, share};
  return cluster_new(&in, &r->body.d.cluster);
}

status setup_face_weights(const model *m, const mesh *msh, double **weight) {
  PASS_NEW(*weight, msh->n_face);
  for (int i = 0; i < msh->n_face; ++i)
    (*weight)[i] = m->sections[m->elem_section[msh->face_elem[i]]].thickness;
  return OK;
}

/* What a contact is with: an obstacle, or another surface. */
static status set_partner(const run *r, const contact *c, contact_pair *p) {
  OWNS(r->faces.pairs);
  if (!c->is_pair) {
    p->support = &r->m->obstacles[c->obstacle_id];
    p->obstacle_normal = c->obstacle_normal;
    return setup_facing(r, p);
  }
  p->master = &r->msh->group[c->pair.master_id];
  p->how = (c->slave_normal ? COUPLE_SLAVE_NORMAL : 0) |
           (c->pair.adjust || c->is_crack ? COUPLE_FLAT : 0);
  p->update = c->update;
  p->change = c->change.given ? &c->change.value : NULL;
  p->change_sign = c->change.interferes ? -1.0 : 1.0;
  return OK;
}

static status new_pairs(run *r) {
  const model *m = r->m;
  const mesh *msh = r->msh;
  PASS_NEW(r->faces.pairs, m->n.contact);
  PASS_NEW(r->result.totals, m->n.contact);
  if (model_has_axis(m)) PASS_NEW(r->result.torque, m->n.contact);
  for (int i = 0; i < m->n.contact; ++i) {
    const contact *c = &m->contacts[i];
    r->faces.pairs[i].card = contact_card(c);
    r->faces.pairs[i].name = c->name;
    r->faces.pairs[i].group = &msh->group[c->group_id];
    for (int k = 0; k < m->n.step; ++k) {
      const friction_ops *law = friction_in_force(m, k, i)->law;
      r->faces.pairs[i].friction |= law != NULL && law->value_name != NULL;
    }
    r->faces.pairs[i].at = c->at;
    PASS(set_partner(r, c, &r->faces.pairs[i]));
  }
  r->faces.input.n_pair = m->n.contact;
  r->faces.input.pairs = r->faces.pairs;
  return OK;
}

status run_new(run *r, const effect_ops *const *effects) {
  PASS_NEW(r->owner, 0);
  OWNS(r->owner);
  r->n_dof = (size_t)r->msh->dim * r->msh->n_node;
  r->solving.known_key = RUN_NO_KEY;
  r->body.d.mesh = r->msh;
  PASS_NEW(r->body.fixed, r->n_dof);
  r->body.d.fixed = r->body.fixed;
  PASS(new_equilibrium(r, &r->old));
  PASS(new_equilibrium(r, &r->now));
  PASS_NEW_REALS(r->n_dof, &r->loads.ud, &r->loads.start);
  PASS(effects_create(r, effects));
  PASS(strains_new(r));
  PASS(setup_flow(r));
  PASS(new_clusters(r));
  if ((r->m->effects & EFFECT_CONTACT) || r->m->n.tie > 0) {
    /* What contact and ties know of the faces. */
    PASS(setup_face_weights(r->m, r->msh, &r->faces.face_weight));
    PASS_NEW(r->faces.node_fixed, r->msh->n_node);
    r->faces.input.fixed = r->faces.node_fixed;
    r->faces.input.ties = &r->body.ties;
    r->faces.input.mesh = r->msh;
    r->faces.input.face_weight = r->faces.face_weight;
    r->faces.input.axisymmetric = r->m->sections[0].kin == AXISYMMETRIC;
  }
  if (r->m->effects & EFFECT_CONTACT) PASS(new_pairs(r));
  if (r->m->n.goal > 0 ||
      (r->m->effects & (EFFECT_STRESS | EFFECT_REACTION | EFFECT_MESH_ERROR |
                        EFFECT_REFERENCE)) != 0)
    PASS_NEW(r->result.stress, (size_t)r->m->ns * r->msh->n_elem);
  if (r->m->effects & EFFECT_STRESS)
    PASS_NEW(r->result.strain, (size_t)r->m->ns * r->msh->n_elem);
  return OK;
}

void run_free(run *r) {
  run_free_surface(r);
  run_free_ties(r);
  memory_free(r->body.order.node);
  memory_free(r->owner);
}
