/*
 * The contact surface of a step: made again where the supports change, with the
 * forces and displacements of the old surface in the frames of the new one.
 */
#include "run/setup/setup.h"

#include "base/memory.h"

void run_free_surface(run *r) {
  effects_forget(r);
  run_forget_estimates(r);
  matrices_free(&r->elastic);
  surface_free(r->surface);
  r->solver = NULL;
  r->c = NULL;
  r->surface = NULL;
  double **owned[] = {
      &r->problem.f,       &r->problem.f_load,   &r->problem.f_before,
      &r->problem.gap,     &r->problem.side_gap, &r->result.slip,
      &r->result.open_gap, &r->old.uc,           &r->old.rc,
      &r->now.uc,          &r->now.rc,           &r->old.motion,
      &r->now.motion,      &r->problem.row[0],   &r->problem.row[1]};
  for (size_t i = 0; i < sizeof owned / sizeof *owned; ++i) {
    memory_free(*owned[i]);
    *owned[i] = NULL;
  }
  memory_free(r->result.contact);
  r->result.contact = NULL;
  reach_free(&r->nodes.reach);
  reach_part_free(&r->problem.part);
  run_take_nodes(r);
}

static void node_bits(run *r) {
  int dim = r->msh->dim;
  for (int i = 0; i < r->msh->n_node; ++i) {
    unsigned bits = 0;
    for (int c = 0; c < dim; ++c)
      bits |= (unsigned)(r->body.fixed[dim * i + c] != 0) << c;
    r->faces.node_fixed[i] = (unsigned char)bits;
  }
  /* A tied node moves with others, wholly. */
  for (int q = 0; q < r->body.ties.n; ++q)
    r->faces.node_fixed[r->body.ties.node_id[q]] = (unsigned char)0xff;
}

/* Pairs of this run are coupled for the surface alone. */
static status build(run *r) {
  status st = OK;
  if (model_has_pairs(r->m)) {
    timer_enter(STAGE_COUPLING);
    st = pairs_couple(&r->faces.input, r->m->log);
    timer_leave(STAGE_COUPLING);
  }
  if (st == OK) st = surface_build(&r->faces.input, r->m->log, &r->surface);
  pairs_release(&r->faces.input);
  return st;
}

static status new_contact_arrays(run *r) {
  int tangents = r->nodes.n * (r->msh->dim - 1);
  PASS_NEW_REALS(r->nodes.n_row, &r->problem.f, &r->problem.f_load,
                 &r->problem.f_before);
  PASS_NEW(r->problem.gap, r->nodes.n);
  PASS_NEW_REALS(r->nodes.n_c, &r->old.uc, &r->now.uc, &r->old.rc, &r->now.rc);
  PASS_NEW(r->result.open_gap, r->nodes.n);
  PASS_NEW(r->result.contact, r->nodes.n);
  if (r->nodes.rows > 1) PASS_NEW(r->problem.side_gap, tangents);
  PASS_NEW(r->result.slip, tangents);
  return OK;
}

/* The force of a node that supports take out of the contact goes to them. */
static void leave_forces(run *r, double *force) {
  int dim = r->msh->dim;
  if (r->surface->master != NULL)
    surface_spread(r->surface, -1.0, r->old.rc, force);
  for (int i = 0; i < r->nodes.n; ++i)
    for (int c = 0; c < dim; ++c) force[dim * r->surface->node_id[i] + c] = 0.0;
  for (size_t k = 0; k < r->n_dof; ++k) r->old.reaction[k] += force[k];
}

/* Brings the old state into the frames of a new surface: u_c = frame u, and the
 * forces dual to it, r = basis' force (equal for an orthonormal frame). */
static status old_state_to_frames(run *r, double *force) {
  surface_relative(r->surface, r->old.u, r->old.uc);
  PASS(surface_forces(r->surface, r->msh->n_node, force, r->old.rc));
  leave_forces(r, force);
  return OK;
}

status run_build_surface(run *r) {
  OWNED double *force = NULL;
  PASS_NEW(force, r->n_dof);
  if (r->surface != NULL) surface_spread(r->surface, 1.0, r->old.rc, force);
  run_free_surface(r);
  timer_enter(STAGE_SURFACE);
  node_bits(r);
  const status st = build(r);
  timer_leave(STAGE_SURFACE);
  PASS(st);
  r->nodes.n = r->surface->n;
  r->nodes.n_c = r->msh->dim * r->nodes.n;
  r->body.d.rows = r->nodes.rows =
      r->m->effects & EFFECT_TANGENTS ? r->msh->dim : 1;
  r->nodes.n_row = r->nodes.rows * r->nodes.n;
  PASS(new_contact_arrays(r));
  PASS(run_room_for_part(r));
  PASS(old_state_to_frames(r, force));
  return surface_gap(r->surface, &r->faces.input, r->old.t, r->problem.gap,
                     r->problem.side_gap);
}
