/*
 * Values: expressions give numbers where steps begin and end, supports agree
 * where groups meet.
 */
#include "model/check/parts.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

static double step_time(const step *s, int end) {
  return end ? s->start + s->total : s->start;
}

/* A value of a contact that must be at least zero, as the cards say it. */
typedef struct contact_value {
  const char *card, *name; /* "FRICTION", "mu"; NULL: there is none           */
  const quantity *value;
  const place *at;
} contact_value;

/* That value at the nodes of the contact at t; 0 after a message. */
static int contact_finite(const model *m, const mesh *msh, const contact *c,
                          contact_value v, double t) {
  const mesh_group *g = &msh->group[c->group_id];
  for (int k = 0; k < g->n_node && v.name != NULL; ++k) {
    double x[3] = {0.0, 0.0, 0.0};
    size_t node = (size_t)g->node_id[k], dim = (size_t)msh->dim;
    memcpy(x, msh->x + dim * node, dim * sizeof *x);
    double value = quantity_value(v.value, x, t);
    if (isfinite(value) && value >= 0.0) continue;
    message_add(m->log, P2041, v.at,
                "*%s: %s is %s at node %zu (%g, %g, %g), time %g", v.card,
                v.name,
                isnan(value)  ? "not a number"
                : value < 0.0 ? "negative"
                              : "infinite",
                msh->node_no[node], x[0], x[1], x[2], t);
    return 0;
  }
  return 1;
}

static void check_contact_values(const model *m, const mesh *msh, int id) {
  const contact *c = &m->contacts[id];
  int good = 1, fine = 1;
  for (int k = 0; k < m->n_step; ++k) {
    double t = step_time(&m->steps[k], 1);
    const friction_rule *rule = friction_in_force(m, k, id);
    contact_value friction = {"FRICTION",
                              rule->law == NULL ? NULL : rule->law->value_name,
                              &rule->card.value, &rule->value_at};
    contact_value force = {"CONTACT FORCE", c->force.given ? "p" : NULL,
                           &c->force.value, &c->force.value_at};
    good = good && contact_finite(m, msh, c, friction, t);
    fine = fine && contact_finite(m, msh, c, force, t);
  }
}

static int motion_finite(const model *m, int obstacle_id, double t) {
  double d[3];
  obstacle_motion(&m->obstacles[obstacle_id], t, d);
  for (int c = 0; c < 3; ++c)
    if (!isfinite(d[c])) {
      message_add(m->log, P2041, &m->moves[obstacle_id].move_at,
                  "*OBSTACLE %s: component %d of MOVE is %s at time %g",
                  m->obstacles[obstacle_id].name, c + 1,
                  isnan(d[c]) ? "not a number" : "infinite", t);
      return 0;
    }
  double angle = obstacle_angle(&m->obstacles[obstacle_id], t);
  if (isfinite(angle)) return 1;
  message_add(m->log, P2041, &m->moves[obstacle_id].rotate_at,
              "*OBSTACLE %s: the angle of ROTATE is %s at time %g",
              m->obstacles[obstacle_id].name,
              isnan(angle) ? "not a number" : "infinite", t);
  return 0;
}

/* Contact acts along the normals of time 0: told at the first step end where a
 * plane has left them by more than a tenth. */
static void check_tilt(const model *m, int obstacle_id) {
  const obstacle *o = &m->obstacles[obstacle_id];
  for (int k = 0; k < m->n_step; ++k) {
    double t = step_time(&m->steps[k], 1), tilt = obstacle_tilt(o, t);
    if (!(tilt > 0.1)) continue;
    message_add(m->log, P2052, &m->moves[obstacle_id].rotate_at,
                "*OBSTACLE %s: ROTATE has tilted the plane by %.3g rad at time "
                "%g; contact acts along the normals of time 0",
                o->name, tilt, t);
    return;
  }
}

void check_values(const model *m, const mesh *msh) {
  for (int i = 0; i < m->n_obstacle; ++i) {
    int good = motion_finite(m, i, 0.0);
    for (int k = 0; k < m->n_step && good; ++k)
      good = motion_finite(m, i, step_time(&m->steps[k], 1));
    if (good) check_tilt(m, i);
  }
  for (int i = 0; i < m->n_contact; ++i) check_contact_values(m, msh, i);
  for (int i = 0; i < m->n_step; ++i)
    for (int k = 0; k < m->steps[i].loads.n; ++k)
      if (m->steps[i].loads.item[k].run != RUN_HELD)
        load_finite(m, msh, &m->steps[i], &m->steps[i].loads.item[k],
                    step_time(&m->steps[i], 1));
}

status check_agreement(const model *m, const mesh *msh, int step_id) {
  const step *s = &m->steps[step_id];
  OWNED int *owner = NULL;
  OWNED double *ud = NULL;
  size_t n_dof = (size_t)msh->dim * (size_t)msh->n_node;
  PASS_NEW(owner, n_dof);
  PASS_NEW(ud, n_dof);
  for (int i = 0; i < s->loads.n; ++i) {
    const load *l = &s->loads.item[i];
    const mesh_group *g = &msh->group[l->group_id];
    int told = 0;
    for (int k = 0; k < g->n_node && l->kind == LOAD_FIXING; ++k) {
      size_t node = (size_t)g->node_id[k];
      size_t dof = (size_t)msh->dim * node + (size_t)l->component;
      double value = load_at_node(l, msh, s, (int)node, step_time(s, 1));
      const load *first =
          owner[dof] > 0 ? &s->loads.item[owner[dof] - 1] : NULL;
      if (first != NULL && value != ud[dof] && !told++)
        message_add(m->log, P2038, &l->at,
                    "node %zu of group %s: component %d is %g here and %g on "
                    "line %d, group %s",
                    msh->node_no[node], l->group, l->component + 1, value,
                    ud[dof], first->at.line_no, first->group);
      owner[dof] = i + 1;
      ud[dof] = value;
    }
  }
  return OK;
}
