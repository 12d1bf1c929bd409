/*
 * Obstacles that move: what passes the contact nodes tangentially, and moves
 * along their normals, since time 0 (contact/obstacle.h). The arrays are part
 * of the two equilibria of the run; without a moving obstacle they are NULL.
 */
#include "effects/plan/effect.h"

/* Those of a new surface. */
static status prepare(run *r, void *self) {
  if (r->nodes.n_c == 0 || r->old.motion != NULL) return OK;
  PASS_NEW_REALS(r->nodes.n_c, &r->old.motion, &r->now.motion);
  surface_drift(r->surface, &r->faces.input, 0.0, r->old.t, r->old.motion);
  return OK;
}

static status pose(run *r, void *self, double t) {
  for (int i = 0; i < r->m->n.contact; ++i) {
    const int id = r->m->contacts[i].obstacle_id;
    if (id >= 0 && facts_leaves_axis(r->m, id, t))
      RAISE(ERR_DECK,
            "%s:%d: *OBSTACLE %s: MOVE leads the sphere off the axis of "
            "symmetry at time %g",
            PLACE(r->m->moves[id].move_at), r->m->obstacles[id].name, t);
  }
  COPY(r->now.motion, r->old.motion, r->nodes.n_c);
  surface_drift(r->surface, &r->faces.input, r->old.t, t, r->now.motion);
  return OK;
}

static effect_work expected(const plan_sizes *s) {
  return (effect_work){s->contact, "nodes", s->equilibria,
                       100.0 * s->equilibria * s->contact};
}

static int requires_motion(const model *m, const reason *why) {
  for (int i = 0; i < m->n.contact; ++i) {
    const int id = m->contacts[i].obstacle_id;
    if (id < 0 || !obstacle_moves(&m->obstacles[id])) continue;
    const move *of = &m->moves[id];
    const place *at = &of->at;
    if (of->rotate_at.file != NULL) at = &of->rotate_at;
    if (of->move_at.file != NULL) at = &of->move_at;
    return plan_at(why, at, "motion of *OBSTACLE, NAME=%s",
                   m->obstacles[id].name);
  }
  return plan_says(0, why, "no *OBSTACLE moves");
}

/* clang-format off */
const effect_ops moving_obstacle_effect = {
  .name = "moving obstacle", .bit = NO_BIT, .required = requires_motion,
  .expected = expected,
  .on = {.prepare = prepare, .pose = pose}};
/* clang-format on */
