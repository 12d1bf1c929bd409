/*
 * What a run keeps as long as the supports stay the same: elasticity of the
 * sections, contact surface, condensed stiffness, solver.
 */
#include "run/run.h"

#include "base/memory.h"
#include "base/timer.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static status new_equilibrium(const run *r, equilibrium *e) {
  status st = OK;
  NEW(e->u, r->n_dof);
  NEW(e->F, r->n_dof);
  NEW(e->reaction, r->n_dof);
done:
  return st;
}

static void free_equilibrium(equilibrium *e) {
  memory_free(e->u);
  memory_free(e->F);
  memory_free(e->reaction);
  memory_free(e->uc);
  memory_free(e->rc);
  memory_free(e->motion);
  memory_free(e->temperature);
  memory_free(e->thermal);
  memory_free(e->e0);
  memory_free(e->elastic);
  memory_free(e->sigma);
}

/* Clusters of the sections with FORMULATION=AVERAGED. What may change its
 * moduli is averaged as what flows. */
static status new_clusters(run *r) {
  status st = OK;
  const model *m = r->m;
  double *share = NULL;
  int averaged = 0;
  for (int i = 0; i < m->n_section; ++i) averaged |= m->sections[i].averaged;
  if (!averaged) return OK;
  timer_enter(STAGE_CLUSTER);
  NEW(share, m->n_section);
  for (int i = 0; i < m->n_section; ++i) {
    const section *s = &m->sections[i];
    const material *mat = &m->materials[s->material_id];
    if (s->averaged && s->kin != PLANE_STRESS)
      share[i] = cluster_share(
          m->ns, r->moduli.E + (size_t)(m->ns * m->ns) * (size_t)i,
          mat->law.ops != NULL || mat->elastic.n > 1);
  }
  const cluster_input in = {r->msh, m->sections[0].kin == AXISYMMETRIC,
                            m->n_section, m->elem_section, share};
  TRY(cluster_new(&in, &r->d.cluster));
done:
  timer_leave(STAGE_CLUSTER);
  memory_free(share);
  return st;
}

static status new_pairs(run *r) {
  status st = OK;
  const model *m = r->m;
  const mesh *msh = r->msh;
  NEW(r->pairs, m->n_contact);
  NEW(r->node_fixed, msh->n_node);
  NEW(r->face_weight, msh->n_face);
  NEW(r->totals, m->n_contact);
  if (model_has_axis(m)) NEW(r->torque, m->n_contact);
  if (model_prints(m, PRINT_LOOP)) NEW(r->loops, m->n_contact);
  for (int i = 0; i < m->n_contact; ++i) {
    const contact *c = &m->contacts[i];
    r->pairs[i].name = c->name;
    r->pairs[i].group = &msh->group[c->group_id];
    r->pairs[i].support = &m->obstacles[c->obstacle_id];
    for (int k = 0; k < m->n_step; ++k) {
      const friction_ops *law = friction_in_force(m, k, i)->law;
      r->pairs[i].friction |= law != NULL && law->value_name != NULL;
    }
    r->pairs[i].obstacle_normal = c->obstacle_normal;
    r->pairs[i].at = c->at;
  }
  for (int i = 0; i < msh->n_face; ++i)
    r->face_weight[i] =
        m->sections[m->elem_section[msh->face_elem[i]]].thickness;
  r->input.mesh = msh;
  r->input.n_pair = m->n_contact;
  r->input.pairs = r->pairs;
  r->input.fixed = r->node_fixed;
  r->input.face_weight = r->face_weight;
  r->input.axisymmetric = m->sections[0].kin == AXISYMMETRIC;
done:
  return st;
}

int run_step_id(const run *r) { return (int)(r->step - r->m->steps); }

status run_new(run *r) {
  status st = OK;
  r->n_dof = (size_t)r->msh->dim * (size_t)r->msh->n_node;
  r->known_key = RUN_NO_KEY;
  r->d.mesh = r->msh;
  NEW(r->fixed, r->n_dof);
  r->d.fixed = r->fixed;
  TRY(new_equilibrium(r, &r->old));
  TRY(new_equilibrium(r, &r->now));
  NEW(r->ud, r->n_dof);
  NEW(r->start, r->n_dof);
  TRY(strains_new(r));
  TRY(new_clusters(r));
  if (r->m->effects & EFFECT_CONTACT) TRY(new_pairs(r));
  if (r->m->effects & EFFECT_MESH_ERROR) NEW(r->elem_error, r->msh->n_elem);
  if (r->m->effects &
      (EFFECT_STRESS | EFFECT_REACTION | EFFECT_MESH_ERROR | EFFECT_REFERENCE))
    NEW(r->stress, (size_t)r->m->ns * (size_t)r->msh->n_elem);
  if (r->m->effects & EFFECT_STRESS)
    NEW(r->strain, (size_t)r->m->ns * (size_t)r->msh->n_elem);
done:
  return st;
}

void matrices_free(matrices *m) {
  contact_solver_free(m->solver);
  condensed_free(m->c);
  stiffness_free(m->k);
  *m = (matrices){0};
}

/* What the estimates know of the matrix in use. */
static void forget_estimates(run *r) {
  known_rate_forget(&r->rate);
  solution_set_free(&r->solutions);
}

static status new_solver(const run *r, matrices *m) {
  status st = OK;
  TRY(contact_solver_new(&r->step->solver, &m->solver));
  if (m->from == NULL) goto done;
  archive_go(m->from, m->group);
  st = contact_solver_keep(m->solver, m->from);
  archive_go(m->from, "");
  m->from = NULL;
done:
  return st;
}

status matrices_keep(matrices *m, archive *a, const char *group) {
  status st = OK;
  int there = m->solver != NULL;
  archive_enter(a, group);
  TRY(archive_ints(a, "solver", &there, 1));
  if (archive_reads(a) && there && m->solver == NULL) {
    m->from = a;
    snprintf(m->group, sizeof m->group, "%s", archive_group(a));
  } else if (there) {
    TRY(contact_solver_keep(m->solver, a));
  }
done:
  archive_leave(a);
  return st;
}

/* The elastic matrix of the moduli at hand. */
static status renew_elastic(run *r) {
  status st = OK;
  r->stale = 0;
  r->c = NULL;
  space_recovery_free(r->recovery);
  r->recovery = NULL;
  matrices_free(&r->elastic);
  TRY(stiffness_assemble(&r->d, &r->elastic.k));
  TRY(condense(r->elastic.k, &r->d, &r->elastic.c));
done:
  return st;
}

status run_use(run *r, matrices *m) {
  status st = OK;
  if (m == &r->elastic && r->stale) TRY(renew_elastic(r));
  if (m->solver == NULL) TRY(new_solver(r, m));
  int read = r->known_key != RUN_NO_KEY;
  if (read ? r->known_key != m->key : r->c != m->c) forget_estimates(r);
  if (r->c != m->c && r->forms != NULL) TRY(forms_new(r));
  r->c = m->c;
  r->solver = m->solver;
  r->known_key = RUN_NO_KEY;
done:
  return st;
}

/* The contact nodes of r->cp are those of r->reach. */
static void take_nodes(run *r) {
  r->d.in = r->reach.in;
  r->d.n_in = r->reach.n_in;
  r->n_row = r->rows * reach_count(&r->reach, r->n);
}

/* Room for the part of them and of their unknowns. */
static status room_for_part(run *r) {
  status st = OK;
  for (int k = 0; k < 2 && r->n_row < r->n_c && r->row[k] == NULL; ++k)
    NEW(r->row[k], r->rows * r->n);
  if (r->reach.in != NULL && r->part.gap == NULL)
    TRY(reach_part_new(r->n, r->rows, &r->part));
done:
  return st;
}

static void free_surface(run *r) {
  forget_estimates(r);
  matrices_free(&r->elastic);
  visco_forget(r);
  surface_free(r->surface);
  r->solver = NULL;
  r->c = NULL;
  r->surface = NULL;
  double **owned[] = {
      &r->f,        &r->f_before, &r->gap,        &r->side_gap,   &r->ut0,
      &r->open_gap, &r->slip,     &r->g,          &r->old.uc,     &r->old.rc,
      &r->now.uc,   &r->now.rc,   &r->old.motion, &r->now.motion, &r->distance,
      &r->row[0],   &r->row[1]};
  for (size_t i = 0; i < sizeof owned / sizeof *owned; ++i) {
    memory_free(*owned[i]);
    *owned[i] = NULL;
  }
  memory_free(r->contact);
  r->contact = NULL;
  reach_free(&r->reach);
  reach_part_free(&r->part);
  take_nodes(r);
  limit_free(r);
  forms_free(r->forms);
  r->forms = NULL;
  path_restart(r);
}

void run_free(run *r) {
  start_report_free(&r->first);
  free_surface(r);
  space_recovery_free(r->recovery);
  memory_free(r->elem_error);
  free_equilibrium(&r->old);
  free_equilibrium(&r->now);
  strains_free(r);
  theory_free(r->theory);
  moduli_free(&r->moduli);
  cluster_free(r->d.cluster);
  memory_free(r->fixed);
  memory_free(r->pairs);
  memory_free(r->node_fixed);
  memory_free(r->face_weight);
  memory_free(r->totals);
  memory_free(r->torque);
  memory_free(r->loops);
  memory_free(r->zones);
  memory_free(r->ud);
  memory_free(r->start);
  memory_free(r->strain);
  memory_free(r->stress);
}

static void node_bits(run *r) {
  int dim = r->msh->dim;
  for (int i = 0; i < r->msh->n_node; ++i) {
    unsigned bits = 0;
    for (int c = 0; c < dim; ++c)
      bits |= (unsigned)(r->fixed[dim * i + c] != 0) << c;
    r->node_fixed[i] = (unsigned char)bits;
  }
}

static status new_contact_arrays(run *r) {
  status st = OK;
  int tangents = r->n * (r->msh->dim - 1);
  NEW(r->f, r->n_row);
  NEW(r->f_before, r->n_row);
  NEW(r->gap, r->n);
  NEW(r->old.uc, r->n_c);
  NEW(r->now.uc, r->n_c);
  NEW(r->old.rc, r->n_c);
  NEW(r->now.rc, r->n_c);
  NEW(r->old.motion, r->n_c);
  NEW(r->now.motion, r->n_c);
  NEW(r->open_gap, r->n);
  NEW(r->contact, r->n);
  if (r->rows > 1) NEW(r->side_gap, tangents);
  NEW(r->slip, tangents);
  if (r->m->effects & EFFECT_FRICTION) {
    NEW(r->ut0, tangents);
    NEW(r->g, r->n);
    NEW(r->distance, r->n);
  }
done:
  return st;
}

/* a = frame u, and the forces dual to it: r = basis' force (equal for an
 * orthonormal frame). Brings the old state into the frames of a new surface. */
static void old_state_to_frames(run *r, const double *force) {
  const contact_surface *s = r->surface;
  int dim = s->dim;
  for (int i = 0; i < s->n; ++i)
    for (int a = 0; a < dim; ++a) {
      double u = 0.0, rc = 0.0;
      for (int c = 0; c < dim; ++c) {
        size_t dof = (size_t)(dim * s->node_id[i] + c);
        u += s->frame[dim * dim * i + dim * a + c] * r->old.u[dof];
        rc += s->basis[dim * dim * i + dim * a + c] * force[dof];
      }
      r->old.uc[dim * i + a] = u;
      r->old.rc[dim * i + a] = rc;
    }
}

/* Contact forces of the old surface in global components, [dim*n_node]. */
static void forces_to_global(const run *r, double *force) {
  const contact_surface *s = r->surface;
  if (s == NULL) return;
  int dim = s->dim;
  for (int i = 0; i < s->n; ++i)
    for (int c = 0; c < dim; ++c)
      for (int a = 0; a < dim; ++a)
        force[dim * s->node_id[i] + c] +=
            s->frame[dim * dim * i + dim * a + c] * r->old.rc[dim * i + a];
}

/* Slip so far of the nodes that stay in contact, [n_node]: to_nodes 1 from
 * r->distance, 0 back. */
static void carry_distance(run *r, int to_nodes, double *at_node) {
  for (int i = 0; i < r->n && r->distance != NULL; ++i) {
    double *node = &at_node[r->surface->node_id[i]];
    if (to_nodes)
      *node = r->distance[i];
    else
      r->distance[i] = *node;
  }
}

/* A node that supports take out of the contact leaves its force to them. */
static void leave_forces(run *r, double *force) {
  int dim = r->msh->dim;
  for (int i = 0; i < r->n; ++i)
    for (int c = 0; c < dim; ++c) force[dim * r->surface->node_id[i] + c] = 0.0;
  for (size_t k = 0; k < r->n_dof; ++k) r->old.reaction[k] += force[k];
}

static status build_surface(run *r) {
  status st = OK;
  double *force = NULL, *distance = NULL;
  NEW(force, r->n_dof);
  NEW(distance, r->msh->n_node);
  forces_to_global(r, force);
  carry_distance(r, 1, distance);
  free_surface(r);
  timer_enter(STAGE_SURFACE);
  node_bits(r);
  st = surface_build(&r->input, r->m->log, &r->surface);
  timer_leave(STAGE_SURFACE);
  TRY(st);
  r->n = r->surface->n;
  r->n_c = r->msh->dim * r->n;
  r->d.rows = r->rows = r->m->effects & EFFECT_TANGENTS ? r->msh->dim : 1;
  r->n_row = r->rows * r->n;
  TRY(new_contact_arrays(r));
  TRY(room_for_part(r));
  TRY(forms_new(r));
  old_state_to_frames(r, force);
  leave_forces(r, force);
  carry_distance(r, 0, distance);
  TRY(surface_gap(r->surface, &r->input, r->old.t, r->gap, r->side_gap));
  surface_drift(r->surface, &r->input, 0.0, r->old.t, r->old.motion);
done:
  memory_free(force);
  memory_free(distance);
  return st;
}

/* Name of the section an element belongs to, by the element's number. */
static const char *body_name(const run *r, size_t elem_no) {
  for (int e = 0; e < r->msh->n_elem; ++e)
    if (r->msh->elem_no[e] == elem_no)
      return r->m->sections[r->m->elem_section[e]].elset;
  return "?";
}

/* 1 if a contact with friction acts on the body of an element. */
static status has_body_friction(const run *r, int elem_id, int *answer) {
  status st = OK;
  const model *m = r->m;
  const mesh *msh = r->msh;
  int *body = NULL, n = 0;
  *answer = 0;
  NEW(body, msh->n_elem);
  TRY(mesh_bodies(msh, &n, body));
  for (int i = 0; i < m->n_contact; ++i) {
    const contact *c = &m->contacts[i];
    const mesh_group *g = &msh->group[c->group_id];
    if (!rule_has_friction(friction_in_force(m, run_step_id(r), i))) continue;
    for (int k = 0; k < g->n_item; ++k)
      *answer |= body[msh->face_elem[g->item_id[k]]] == body[elem_id];
  }
done:
  memory_free(body);
  return st;
}

/* 1 if nothing resists: no contact there, or tangential contact of a body
 * without friction. */
static status is_unheld(const run *r, const free_motion *f, int *unheld) {
  status st = OK;
  int friction = 0;
  *unheld = f->held_by == HELD_BY_NOTHING;
  if (f->held_by != HELD_BY_FRICTION) goto done;
  for (int e = 0; e < r->msh->n_elem; ++e)
    if (r->msh->elem_no[e] == f->elem_no)
      TRY(has_body_friction(r, e, &friction));
  *unheld = !friction;
done:
  return st;
}

/* Motions that nothing resists go to the log and are ERR_SINGULAR. */
static status refuse_unheld(const run *r, int n, const free_motion *list) {
  status st = OK;
  int unheld = 0, step_no = run_step_id(r) + 1;
  for (int i = 0; i < n; ++i) {
    int free;
    TRY(is_unheld(r, &list[i], &free));
    if (!free) continue;
    ++unheld;
    message_add(r->m->log, P4011, &r->step->at,
                "step %d: body %d (%s, element %zu) is free to move: %s; "
                "neither *BOUNDARY nor %s holds it",
                step_no, list[i].body_id + 1, body_name(r, list[i].elem_no),
                list[i].elem_no, list[i].text,
                list[i].held_by == HELD_BY_FRICTION ? "frictionless contact"
                                                    : "contact");
  }
  if (unheld > 0)
    FAIL(ERR_SINGULAR, "step %d: a body is free to move", step_no);
done:
  return st;
}

/* Bodies without enough supports are refused before anything is solved;
 * *n_motion: those that contact alone holds. */
static status check_supports(const run *r, int *n_motion) {
  status st = OK;
  free_motion *list = NULL;
  TRY(domain_free_motions(&r->d, n_motion, &list));
  TRY(refuse_unheld(r, *n_motion, list));
done:
  memory_free(list);
  return st;
}

/* ---- nodes out of reach ------------------------------------------------- */

/*
 * Contact nodes whose gap is wider than what the step can close are left out of
 * the condensed problem: they are free nodes of the interior, without force.
 * After each solution none of them may be beyond its gap; where one is, or
 * where no equilibrium was found, more nodes are taken and the problem is
 * solved again. The answer is thus that of all nodes; only its price depends on
 * the estimate of the reach.
 */
enum { FEWEST = 16 };               /* contact nodes                         */
static const double GENEROUS = 4.0; /* -, of what loads move a compact body  */

/* 1: no force on a node that does not touch, nothing but loads and supports
 * moves the body, and the problem at hand is that of all increments. */
static int may_leave_out(const run *r, int n_motion) {
  const unsigned effects = r->m->effects;
  const unsigned no = EFFECT_GIVEN | EFFECT_START | EFFECT_INELASTIC |
                      EFFECT_THERMAL | EFFECT_BODY;
  if ((effects & EFFECT_TANGENTS) &&
      (!model_rubs_locally(r->m) || (effects & EFFECT_TIME_ERROR)))
    return 0;
  return n_motion == 0 && r->n >= FEWEST && !(effects & no) &&
         r->m->n_points == 0 && r->m->n_neglected == 0;
}

/* Least diagonal entry of the moduli, Pa, times the section's thickness or the
 * size of the mesh: a body of that size gives way by force over this, N/m. */
static double least_stiffness(const run *r) {
  const domain *d = &r->d;
  const int ns = d->ns, flat = d->mesh->dim == 2;
  double least = HUGE_VAL;
  for (int e = 0; e < d->mesh->n_elem; ++e) {
    const int s = d->section_id[e];
    const double *E = d->E + (size_t)(ns * ns) * (size_t)s;
    double size =
        flat && d->kin[s] != AXISYMMETRIC ? d->thickness[s] : d->mesh->size;
    for (int c = 0; c < d->mesh->dim; ++c)
      least = fmin(least, E[c * (ns + 1)] * size);
  }
  return least;
}

/* Way of the contact nodes in the step, generously, m. */
static status find_reach(run *r) {
  status st = OK;
  double force = 0.0, way = 0.0, end = r->step->start + r->step->total;
  TRY(load_forces(r->m, r->msh, r->step, end, r->now.F));
  TRY(load_prescribed(r->m, r->msh, r->step, end, r->start, r->ud));
  for (size_t k = 0; k < r->n_dof; ++k) {
    force += fabs(r->now.F[k]);
    way = fmax(way, fabs(r->old.u[k]));
    if (r->fixed[k]) way = fmax(way, fabs(r->ud[k]));
  }
  r->reach.way = 2.0 * way + GENEROUS * force / least_stiffness(r);
done:
  return st;
}

/* The nodes within reach at the start or the end of the step. */
static status choose_nodes(run *r, int n_motion) {
  status st = OK;
  double *gap = NULL;
  r->reach.passes = 0;
  if (!may_leave_out(r, n_motion)) return OK;
  timer_enter(STAGE_SURFACE);
  NEW(gap, r->n);
  TRY(find_reach(r));
  TRY(surface_gap(r->surface, &r->input, r->step->start + r->step->total, gap,
                  NULL));
  for (int i = 0; i < r->n; ++i) gap[i] = fmin(gap[i], r->gap[i]);
  TRY(reach_choose(&r->reach, r->n, gap));
  take_nodes(r);
  TRY(room_for_part(r));
done:
  timer_leave(STAGE_SURFACE);
  memory_free(gap);
  return st;
}

int run_misses_nodes(const run *r) {
  if (r->reach.in == NULL) return 0;
  return r->report.outcome <= 0 ||
         reach_misses(&r->reach, r->n, r->gap, r->now.uc, r->msh->dim);
}

/* A matrix and a solver for the nodes that r->reach now has. */
static status renew_nodes(run *r) {
  status st = OK;
  r->c = NULL;
  matrices_free(&r->elastic);
  take_nodes(r);
  TRY(room_for_part(r));
  TRY(renew_elastic(r));
  TRY(run_use(r, &r->elastic));
done:
  return st;
}

status run_add_nodes(run *r) {
  status st = OK;
  TRY(reach_extend(&r->reach, r->n, r->gap, r->now.uc, r->msh->dim,
                   r->report.outcome <= 0));
  TRY(renew_nodes(r));
done:
  return st;
}

/* The nodes of a run that goes on. */
static status keep_nodes(run *r, archive *a) {
  status st = OK;
  contact_reach x = r->reach;
  x.in = NULL;
  TRY(archive_reals(a, "reach", &x.way, 1));
  TRY(archive_ints(a, "reach_passes", &x.passes, 1));
  TRY(archive_ints(a, "nodes_in", &x.n_in, 1));
  if (!archive_reads(a))
    return archive_ints(a, "in", r->reach.in, (size_t)x.n_in);
  if (x.n_in > 0) NEW(x.in, r->n);
  TRY(archive_ints(a, "in", x.in, (size_t)x.n_in));
  r->reach.way = x.way;
  r->reach.passes = x.passes;
  if (reach_is_same(&x, &r->reach)) goto done;
  contact_reach old = r->reach;
  r->reach = x;
  x = old;
  TRY(renew_nodes(r));
done:
  reach_free(&x);
  return st;
}

static status report_ready(run *r) {
  if (r->sink->ready == NULL) return OK;
  setup_facts facts = {.info = condensed_info(r->c),
                       .condition = condensed_condition(r->c),
                       .digits = condensed_digits(r->c),
                       .floating = condensed_floating(r->c),
                       .n_contact_node = r->n,
                       .n_left_out = r->n - reach_count(&r->reach, r->n),
                       .average_entries = limit_average_entries(r)};
  return r->sink->ready(r->sink->ctx, &facts, r->surface);
}

status run_prepare(run *r) {
  status st = OK;
  int fresh = 0, motions = 0;
  unsigned char *fixed = NULL;
  NEW(fixed, r->n_dof);
  load_fixed(r->m, r->msh, r->step, fixed);
  memcpy(r->start, r->old.u, r->n_dof * sizeof *r->start);
  r->limit_known = 0;
  for (int i = 0; i < r->m->n_contact && r->loops != NULL; ++i)
    r->loops[i].start_end = r->loops[i].friction_end;
  if (r->elastic.c == NULL || memcmp(fixed, r->fixed, r->n_dof) != 0) {
    memcpy(r->fixed, fixed, r->n_dof);
    if (r->m->effects & EFFECT_CONTACT)
      TRY(build_surface(r));
    else
      free_surface(r);
    r->d.surface = r->surface;
    TRY(check_supports(r, &motions));
    TRY(choose_nodes(r, motions));
    r->n_before = r->n_row;
    r->n_told = reach_count(&r->reach, r->n);
    TRY(renew_elastic(r));
    r->c = r->elastic.c;
    fresh = 1;
  }
  TRY(limit_average(r));
  if (fresh) TRY(report_ready(r));
  contact_solver_free(r->elastic.solver);
  r->elastic.solver = NULL;
  visco_new_solvers(r);
  r->tol = r->step->solver.tol;
  TRY(run_use(r, &r->elastic));
done:
  memory_free(fixed);
  return st;
}

/* ---- what a run goes on from -------------------------------------------- */

static status keep_equilibrium(const run *r, equilibrium *e, archive *a) {
  status st = OK;
  size_t m = (size_t)r->n_c, strains = strains_kept(r);
  size_t elements = e->temperature == NULL ? 0 : (size_t)r->msh->n_elem;
  TRY(archive_reals(a, "t", &e->t, 1));
  TRY(archive_reals(a, "u", e->u, r->n_dof));
  TRY(archive_reals(a, "F", e->F, r->n_dof));
  TRY(archive_reals(a, "reaction", e->reaction, r->n_dof));
  TRY(archive_reals(a, "uc", e->uc, m));
  TRY(archive_reals(a, "rc", e->rc, m));
  TRY(archive_reals(a, "motion", e->motion, m));
  TRY(archive_reals(a, "temperature", e->temperature, elements));
  TRY(archive_reals(a, "thermal", e->thermal, strains));
  TRY(archive_reals(a, "e0", e->e0, strains));
  TRY(archive_reals(a, "sigma", e->sigma, strains));
  TRY(archive_reals(a, "elastic_strain", e->elastic,
                    e->elastic == NULL ? 0 : strains));
  TRY(archive_bytes(a, "energy", &e->energy, sizeof e->energy));
  TRY(archive_reals(a, "peak_energy", &e->peak_energy, 1));
  TRY(archive_reals(a, "peak_stress", &e->peak_stress, 1));
done:
  return st;
}

/* Temperatures of the moduli, and whether the elastic matrix is theirs. */
static status keep_moduli(run *r, archive *a) {
  status st = OK;
  int stale = r->stale, changed = 0;
  size_t n = r->moduli.n_own == 0 ? 0 : (size_t)r->msh->n_elem;
  double *T = r->now.temperature;
  for (int k = 0; k < r->moduli.n_own && !archive_reads(a); ++k)
    T[r->moduli.elem_id[k]] = r->moduli.at[k];
  TRY(archive_ints(a, "stale", &stale, 1));
  TRY(archive_reals(a, "moduli_temperature", T, n));
  if (!archive_reads(a) || n == 0) goto done;
  TRY(moduli_heat(&r->moduli, r->m, T, &changed));
  r->stale = stale || changed;
  if (!stale) TRY(run_use(r, &r->elastic));
done:
  return st;
}

/* The rate of contraction that is known belongs to the matrix in use. */
static status keep_rate(run *r, archive *a) {
  status st = OK;
  known_rate *k = &r->rate;
  int m = k->state == NULL ? 0 : k->m;
  TRY(archive_ints(a, "rate_size", &m, 1));
  if (archive_reads(a)) known_rate_forget(k);
  if (m == 0) goto done;
  if (archive_reads(a)) NEW(k->state, m);
  k->m = m;
  TRY(archive_bytes(a, "rate_states", k->state, (size_t)m));
  TRY(archive_reals(a, "rate", &k->rate, 1));
done:
  return st;
}

static status keep_contact(run *r, archive *a) {
  status st = OK;
  size_t contacts = r->loops == NULL ? 0 : (size_t)r->m->n_contact;
  TRY(keep_nodes(r, a));
  TRY(archive_reals(a, "f_before", r->f_before, (size_t)r->n_row));
  r->n_before = r->n_row;
  r->n_told = reach_count(&r->reach, r->n);
  TRY(archive_reals(a, "distance", r->distance,
                    r->distance == NULL ? 0 : (size_t)r->n));
  TRY(archive_bytes(a, "loops", r->loops, contacts * sizeof *r->loops));
  TRY(keep_rate(r, a));
  TRY(matrices_keep(&r->elastic, a, "elastic"));
done:
  return st;
}

static status keep_counts(run *r, archive *a) {
  status st = OK;
  TRY(archive_bytes(a, "at", &r->at, sizeof r->at));
  TRY(archive_ints(a, "total_no", &r->total_no, 1));
  TRY(archive_ints(a, "unsettled", &r->unsettled, 1));
  TRY(archive_ints(a, "jumps", &r->jumps, 1));
  TRY(archive_reals(a, "jump_t", &r->jump_t, 1));
  TRY(archive_reals(a, "start", r->start, r->n_dof));
done:
  return st;
}

/* A limit that holds for all times of the step is made now, so that what is
 * counted from here on is what the other run counts. */
static status keep_limit(run *r, archive *a) {
  status st = OK;
  int known = r->limit_known;
  TRY(archive_ints(a, "limit_known", &known, 1));
  if (archive_reads(a) && known) TRY(limit_update(r, r->old.t));
done:
  return st;
}

/* As the limit: the nodal averages of the error of the mesh are made now. */
static status keep_recovery(run *r, archive *a) {
  status st = OK;
  int made = r->recovery != NULL;
  TRY(archive_ints(a, "recovery", &made, 1));
  if (archive_reads(a) && made) TRY(space_recovery_new(&r->d, &r->recovery));
done:
  return st;
}

static status keep_costs(run *r, archive *a) {
  status st = OK;
  for (int i = 0; i < STAGE_COUNT; ++i) r->costs[i] = timer_cost((stage)i);
  TRY(archive_bytes(a, "costs", r->costs, sizeof r->costs));
  if (archive_reads(a)) timer_resume(r->costs);
done:
  return st;
}

status run_keep(run *r, archive *a) {
  status st = OK;
  archive_enter(a, "run");
  TRY(keep_counts(r, a));
  TRY(keep_equilibrium(r, &r->old, a));
  TRY(keep_moduli(r, a));
  if (r->n > 0) TRY(keep_contact(r, a));
  TRY(path_keep(r, a));
  if (r->visco != NULL) TRY(visco_keep(r, a));
  TRY(keep_limit(r, a));
  TRY(keep_recovery(r, a));
  TRY(keep_costs(r, a));
done:
  archive_leave(a);
  return st;
}

status run_motions(run *r, int *n, free_motion **list) {
  status st = OK;
  load_fixed(r->m, r->msh, r->step, r->fixed);
  if (r->m->effects & EFFECT_CONTACT) TRY(build_surface(r));
  r->d.surface = r->surface;
  TRY(domain_free_motions(&r->d, n, list));
  TRY(refuse_unheld(r, *n, *list));
  TRY(limit_average(r));
done:
  return st;
}
