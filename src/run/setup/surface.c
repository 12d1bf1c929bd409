/*
 * The contact surface of a step: made again where the supports change, with the
 * forces and displacements of the old surface in the frames of the new one.
 */
#include "run/setup/setup.h"

void run_free_surface(run *r) {
  effects_forget(r);
  run_forget_estimates(r);
  matrices_free(&r->elastic);
  memory_free(r->surface);
  r->solver = NULL;
  r->c = NULL;
  r->surface = NULL;
  double **owned[] = {
      &r->problem.f,       &r->problem.f_load,   &r->problem.f_before,
      &r->problem.gap,     &r->problem.side_gap, &r->result.slip,
      &r->result.open_gap, &r->old.uc,           &r->old.rc,
      &r->now.uc,          &r->now.rc,           &r->old.motion,
      &r->now.motion,      &r->problem.row[0],   &r->problem.row[1]};
  for (size_t i = 0; i < sizeof owned / sizeof *owned; ++i) FORGET(*owned[i]);
  RELEASE(r->result.contact, r->result.closed);
  r->result.contact = NULL;
  r->result.closed = NULL;
  active_free(&r->nodes.active);
  active_part_free(&r->problem.part);
  run_take_nodes(r);
}

static void node_bits(run *r) {
  for (int i = 0; i < r->msh->n_node; ++i) {
    unsigned bits = 0;
    for (int c = 0; c < r->msh->dim; ++c)
      bits |= (r->body.fixed[r->msh->dim * i + c] != 0) << c;
    r->faces.node_fixed[i] = (unsigned char)bits;
  }
  /* A tied node moves with others, wholly. */
  for (int q = 0; q < r->body.ties.n; ++q)
    r->faces.node_fixed[r->body.ties.node_id[q]] = 0xff;
}

static status build(run *r) {
  TIMED(STAGE_SURFACE);
  node_bits(r);
  if (model_has_pairs(r->m))
    PASS_TIMED(STAGE_COUPLING, pairs_couple(&r->faces.input, r->m->log));
  return surface_build(&r->faces.input, r->m->log, &r->surface);
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
  if (r->nodes.rows > 1) PASS_NEW(r->result.closed, r->nodes.n_c);
  PASS_NEW(r->result.slip, tangents);
  return OK;
}

/* Brings the old state into the frames of a new surface: u_c = frame u, and the
 * forces dual to it, r = basis' force (equal for an orthonormal frame). */
static status old_state_to_frames(run *r, double *force) {
  surface_relative(r->surface, r->old.u, r->old.uc);
  PASS(surface_forces(r->surface, r->msh->n_node, force, r->old.rc));
  /* The force of a node that supports take out of the contact goes to them. */
  int dim = r->msh->dim;
  if (r->surface->master != NULL)
    surface_spread(r->surface, -1.0, r->old.rc, force);
  for (int i = 0; i < r->nodes.n; ++i)
    for (int c = 0; c < dim; ++c) force[dim * r->surface->node_id[i] + c] = 0.0;
  for (size_t k = 0; k < r->n_dof; ++k) r->old.reaction[k] += force[k];
  return OK;
}

status run_build_surface(run *r) {
  OWNED_NEW(double, force, r->n_dof);
  if (r->surface != NULL) surface_spread(r->surface, 1.0, r->old.rc, force);
  run_free_surface(r);
  const status st = build(r);
  pairs_release(&r->faces.input); /* coupled for the surface alone */
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

/*
 * The nodes of *TIE: each moves with the master surface, but for the components
 * that supports hold. A node of several ties belongs to the first.
 */

void run_free_ties(run *r) {
  const node_links *to = &r->body.ties.to;
  RELEASE(r->body.ties.node_id, r->body.ties.tie_id, to->start, to->master,
          to->part);
  r->body.ties = (tie_set){0};
  r->body.d.ties = NULL;
}

static status couple(const run *r, const tie *t, const unsigned char *dropped,
                     mortar **out) {
  const mesh_group *slave = &r->msh->group[t->pair.slave_id],
                   *master = &r->msh->group[t->pair.master_id];
  PASS(surfaces_couple(&r->faces.input, r->msh->x, slave, master,
                       COUPLE_SLAVE_NORMAL | COUPLE_FLAT, dropped, out));
  const int alone = surfaces_held_alone(&r->faces.input, *out);
  if (alone > 0)
    message_add(r->m->log, P4032, &t->at,
                "*TIE %s: supports hold a component of %d of %d nodes of the "
                "slave %s, but not of the master %s: it is not tied there: "
                "SLAVE= takes the other surface, or the support holds both",
                t->name, alone, (*out)->n, slave->name, master->name);
  if ((*out)->n == 0)
    message_add(r->m->log, P4023, &t->at,
                "*TIE %s: no face of %s meets a face of %s along its normal",
                t->name, slave->name, master->name);
  else if ((*out)->n_uncovered + (*out)->n_scant > 0)
    message_add(r->m->log, P4025, &t->at,
                "*TIE %s: %d of %d nodes of %s have no partner on %s", t->name,
                (*out)->n_uncovered + (*out)->n_scant, slave->n_node,
                slave->name, master->name);
  return message_status(r->m->log, ERR_DECK);
}

/* Row of node q of m, the last of ties. */
static void add_node(const run *r, const mortar *m, int q, tie_set *t) {
  const int dim = r->msh->dim, row = t->n++;
  const size_t n = m->to.start[q + 1] - m->to.start[q];
  t->node_id[row] = m->node_id[q];
  t->to.start[row + 1] = t->to.start[row] + n;
  for (size_t e = 0; e < n; ++e) {
    const size_t from = m->to.start[q] + e, to = t->to.start[row] + e;
    t->to.master[to] = m->to.master[from];
    for (int c = 0; c < dim; ++c)
      t->to.part[dim * to + c] = r->body.fixed[dim * m->node_id[q] + c]
                                     ? 0.0
                                     : m->to.part[dim * from + c];
  }
}

/* The couplings of all ties as one set, by node. */
static status join(run *r, mortar *const *m) {
  const int n_tie = r->m->n.tie;
  tie_set *t = &r->body.ties;
  size_t n_row = 0, n_part = 0;
  OWNED_NEW(int, next, n_tie);
  for (int i = 0; i < n_tie; ++i) {
    n_row += m[i]->n;
    n_part += m[i]->to.start[m[i]->n];
  }
  PASS_NEW_ALL(OF(t->node_id, n_row), OF(t->tie_id, n_row),
               OF(t->to.start, n_row + 1), OF(t->to.master, n_part),
               OF(t->to.part, r->msh->dim * n_part));
  t->to.dim = r->msh->dim;
  while ((size_t)t->n < n_row) {
    int least = -1;
    for (int i = 0; i < n_tie; ++i)
      if (next[i] < m[i]->n &&
          (least < 0 ||
           m[i]->node_id[next[i]] < m[least]->node_id[next[least]]))
        least = i;
    t->tie_id[t->n] = least;
    add_node(r, m[least], next[least]++, t);
  }
  t->to.n = t->n;
  return OK;
}

status run_build_ties(run *r) {
  status st = OK;
  const int n = r->m->n.tie;
  mortar **m = NULL;
  unsigned char *dropped = NULL;
  run_free_ties(r);
  if (n == 0) return OK;
  node_bits(r);
  timer_enter(STAGE_COUPLING);
  NEW_ALL(OF(m, n), OF(dropped, r->msh->n_node));
  /* Nodes held in all components, or by an earlier tie, are left out. */
  const int dim = r->msh->dim;
  for (int i = 0; i < r->msh->n_node; ++i) {
    int all = 1;
    for (int c = 0; c < dim; ++c) all &= r->body.fixed[dim * i + c] != 0;
    dropped[i] |= (unsigned char)all;
  }
  for (int i = 0; i < n; ++i) {
    TRY(couple(r, &r->m->ties[i], dropped, &m[i]));
    for (int q = 0; q < m[i]->n; ++q) dropped[m[i]->node_id[q]] = 1;
  }
  TRY(join(r, m));
  r->body.d.ties = &r->body.ties;
done:
  timer_leave(STAGE_COUPLING);
  for (int i = 0; m != NULL && i < n; ++i) memory_free(m[i]);
  RELEASE(m, dropped);
  return st;
}
