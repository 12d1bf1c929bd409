/*
 * Contacts, their obstacles and their friction laws against the mesh.
 */
#include "model/check/parts.h"

/* A group meets an obstacle once: twice would count its areas twice. */
static void check_twice(const model *m, int contact_id) {
  const contact *c = &m->contacts[contact_id];
  for (int i = 0; i < contact_id; ++i)
    if (c->group_id >= 0 && m->contacts[i].group_id == c->group_id &&
        m->contacts[i].obstacle_id == c->obstacle_id) {
      message_add(m->log, P2011, &c->group_at,
                  "contact %s has the group and the obstacle of contact %s",
                  c->name, m->contacts[i].name);
      return;
    }
}

/* In the plane an obstacle turns in the plane, and not about r = 0. */
static void check_turn(const model *m, int dim, int obstacle_id) {
  const obstacle *o = &m->obstacles[obstacle_id];
  const place *at = &m->moves[obstacle_id].rotate_at;
  if (!o->turns || dim == 3) return;
  if (m->n_section > 0 && m->sections[0].kin == AXISYMMETRIC)
    message_add(m->log, P2043, at,
                "*OBSTACLE %s: an axisymmetric model has no displacement "
                "around its axis that could follow ROTATE",
                o->name);
  else if (o->axis[0] != 0.0 || o->axis[1] != 0.0)
    message_add(m->log, P2043, at,
                "*OBSTACLE %s: the axis of ROTATE is (%g, %g, %g); in a plane "
                "model it is along z",
                o->name, o->axis[0], o->axis[1], o->axis[2]);
}

static void check_torque_axis(const model *m, int dim, const contact *c) {
  if (!c->has_axis || c->axis_of_obstacle || dim == 3) return;
  if (m->n_section > 0 && m->sections[0].kin == AXISYMMETRIC)
    message_add(m->log, P2037, &c->axis_at,
                "*CONTACT %s: AXIS counts for plane models and in 3-D only",
                c->name);
  else if (c->axis[0] != 0.0 || c->axis[1] != 0.0)
    message_add(m->log, P2037, &c->axis_at,
                "*CONTACT %s: forces in the plane have a torque about z only",
                c->name);
}

/* Options of a friction law that are not for every model. */
static void check_law(const model *m, const char *contact_name,
                      const friction_rule *rule) {
  int axisymmetric = m->n_section > 0 && m->sections[0].kin == AXISYMMETRIC;
  if (rule->law == NULL || rule->law->misfit == NULL) return;
  const char *why = rule->law->misfit(rule->card.param, m->dim, axisymmetric);
  if (why != NULL)
    message_add(m->log, P2045, &rule->at, "*FRICTION, LAW=%s on contact %s: %s",
                rule->law->name, contact_name, why);
}

void check_laws(const model *m) {
  for (int i = 0; i < m->n_contact; ++i)
    check_law(m, m->contacts[i].name, &m->contacts[i].friction);
  for (int k = 0; k < m->n_step; ++k)
    for (int i = 0; i < m->steps[k].n_change; ++i) {
      const friction_change *f = &m->steps[k].changes[i];
      check_law(m, m->contacts[f->contact_id].name, &f->rule);
    }
}

/* Points and directions of an obstacle in 3-D have three numbers; a sphere of
 * an axisymmetric model stays on the axis. */
static void check_obstacle_fields(const model *m, const mesh *msh, int id) {
  const obstacle *o = &m->obstacles[id];
  const quantity *radial = &o->motion[0];
  if (msh->dim == 3 && m->moves[id].short_at.file != NULL)
    message_add(m->log, P2009, &m->moves[id].short_at,
                "2 numbers on this line of *OBSTACLE; a mesh in 3-D needs 3");
  if (m->n_section > 0 && m->sections[0].kin == AXISYMMETRIC &&
      o->shape == OBSTACLE_SPHERE &&
      (radial->formula != NULL || radial->number != 0.0))
    message_add(m->log, P4009, &m->moves[id].move_at,
                "*OBSTACLE %s: MOVE leads the sphere off the axis of symmetry",
                o->name);
}

void check_contacts(model *m, const mesh *msh) {
  for (int i = 0; i < m->n_contact; ++i) {
    contact *c = &m->contacts[i];
    c->group_id = check_group_of(m, msh, c->group, msh->dim - 1, &c->group_at);
    check_twice(m, i);
    if (c->obstacle_id < 0) continue;
    const obstacle *o = &m->obstacles[c->obstacle_id];
    int no_axis = o->direction[0] == 0.0 && o->direction[1] == 0.0 &&
                  o->direction[2] == 0.0;
    check_obstacle_fields(m, msh, c->obstacle_id);
    if (msh->dim == 3 && o->shape == OBSTACLE_CYLINDER && no_axis)
      message_add(m->log, P2007, &m->moves[c->obstacle_id].at,
                  "*OBSTACLE: a cylinder in 3-D needs a line with the "
                  "direction of its axis");
    if (msh->dim == 2 && o->shape == OBSTACLE_PLANE && o->direction[0] == 0.0 &&
        o->direction[1] == 0.0)
      message_add(m->log, P2027, &m->moves[c->obstacle_id].at,
                  "*OBSTACLE: the normal has no part in the plane of the mesh");
    check_turn(m, msh->dim, c->obstacle_id);
    check_torque_axis(m, msh->dim, c);
  }
}
