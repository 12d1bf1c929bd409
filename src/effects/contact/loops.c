/*
 * *PRINT, LOOP: each contact as a loop of friction, force against motion: mean
 * motions of obstacle and nodes, and what friction dissipates.
 */
#include "effects/plan/effect.h"

#include "run/column_row.h"

static int requires_loops(const model *m, const reason *why) {
  return plan_requires_table(m, PRINT_LOOP, why);
}

static effect_work expected(const plan_sizes *s) {
  return plan_table(s, PRINT_LOOP, s->m->n.contact);
}

static size_t contacts_of(const run *r) { return r->m->n.contact; }

static status begin_step(run *r, void *self) {
  contact_loop *loops = self;
  for (int i = 0; i < r->m->n.contact; ++i)
    loops[i].start_end = loops[i].friction_end;
  return OK;
}

/* Motions of the contacts, and what friction dissipates in each. */
static status find_loops(run *r, void *self) {
  contact_loop *loops = self;
  const contact_surface *s = r->surface;
  for (int i = 0; i < r->m->n.contact; ++i) {
    contact_loop *l = &loops[i];
    double weight = 0.0, apart = 0.0; /* of all nodes, of those at no corner */
    memset(l->way, 0, sizeof l->way);
    memset(l->mean_u_t, 0, sizeof l->mean_u_t);
    if (r->faces.pairs[i].support != NULL)
      l->angle = obstacle_angle(r->faces.pairs[i].support, r->now.t);
    for (int k = 0; k < r->nodes.n; ++k) {
      if (s->contact_id[k] != i) continue;
      weight += s->area[k];
      if (!surface_is_corner(s, k)) apart += s->area[k];
      for (int a = 0; a < r->msh->dim - 1; ++a) {
        int c = r->msh->dim * k + a + 1;
        const double u_t = surface_along(s, r->now.u, r->now.uc, k, a + 1);
        l->mean_u_t[a] += s->area[k] * (u_t - l->mean_u_t[a]) / weight;
        if (surface_is_corner(s, k)) continue;
        l->way[a] += s->area[k] * (run_drift(&r->now, c) - l->way[a]) / apart;
        const double mean = 0.5 * (r->old.rc[c] + r->now.rc[c]);
        l->friction -= mean * run_motion_over(r, c);
        l->friction_end -= r->now.rc[c] * run_motion_over(r, c);
      }
    }
  }
  return OK;
}

static status keep(run *r, void *self, archive *a) {
  return archive_bytes(a, "loops", self, contacts_of(r) * sizeof(contact_loop));
}

static const contact_loop *loop_of(const view *v, int id) {
  const contact_loop *loops = effect_state(v->s->effects, &loops_effect);
  return &loops[id];
}

VALUE(loop_time, v->s->t)
VALUE(loop_way, loop_of(v, id)->way[part])
VALUE(loop_u_t, loop_of(v, id)->mean_u_t[part])
VALUE(loop_angle, loop_of(v, id)->angle)
VALUE(loop_friction, loop_of(v, id)->friction)
VALUE(loop_friction_end, loop_of(v, id)->friction_end)
VALUE(loop_area, loop_of(v, id)->friction_end - loop_of(v, id)->start_end)

/* clang-format off */
#define LOOP PER_CONTACT, AS_REAL, PRINT_LOOP, C
#define WAY(name, scene, part) \
  {name, "length", LOOP, scene, 0, NULL, part, loop_way, NULL, \
   "mean displacement of the obstacle at the nodes"}
#define MEAN(name, scene, part) \
  {name, "length", LOOP, scene, 0, NULL, part, loop_u_t, NULL, \
   "mean tangential displacement of the contact nodes"}
static const column columns[] = {
{"time", "time", LOOP, SCENE_ALL, 0, NULL, 0, loop_time, NULL,
 "end of the increment"},
WAY("way", SCENE_FLAT, 0), WAY("way_1", SCENE_SOLID, 0),
WAY("way_2", SCENE_SOLID, 1),
{"angle", "rad", LOOP, CART, NEEDS_TORQUE, NULL, 0, loop_angle,
 NULL, "angle of the obstacle"},
MEAN("mean_u_t", SCENE_FLAT, 0), MEAN("mean_u_t1", SCENE_SOLID, 0),
MEAN("mean_u_t2", SCENE_SOLID, 1),
{"friction_work", J, LOOP, SCENE_ALL, 0, NULL, 0, loop_friction, NULL,
 "dissipated by friction so far, trapezoidal"},
{"friction_work_end", J, LOOP, SCENE_ALL, 0, NULL, 0,
 loop_friction_end, NULL, "the same with the forces at the end of increments"},
{"loop_area", J, LOOP, SCENE_ALL, 0, NULL, 0, loop_area, NULL,
 "friction_work_end since the step began: the area of a loop that closes"}};

const effect_ops loops_effect = {
  .name = "table of loops", .bit = NO_BIT, .required = requires_loops,
  .expected = expected, .table = {PRINT_LOOP, PER_CONTACT},
  .size = sizeof(contact_loop), .count = contacts_of, .copy_as = COPY_IS_EQUAL,
  .on = {.begin_step = begin_step, .accept = find_loops, .keep = keep},
  COLUMNS_OF(columns)};
/* clang-format on */
