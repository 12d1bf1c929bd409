/*
 * What is derived from an equilibrium: stresses, reactions of the supports,
 * resultants of the contacts, energies and their balance.
 */
#include "base/base.h"
#include "run/run.h"

int run_finds_mesh_error(const run *r) {
  const int at = r->step->accuracy.mesh;
  return at == MESH_ERROR_YES || (at == MESH_ERROR_END && r->at.last);
}

/* Reactions: internal forces less loads less contact forces, where fixed; those
 * of tied nodes act on their masters.
 * known: r->result.stress is that of r->now already. */
static void find_reactions(run *r, int known) {
  double *reaction = r->now.reaction;
  const domain *d = &r->body.d;
  const int everywhere = d->cluster != NULL || r->body.ties.n > 0;
  TIMED(STAGE_REACTION);
  if (!known && everywhere) domain_stress(d, r->now.u, NULL, r->result.stress);
  if (known || everywhere)
    domain_internal_force(d, r->result.stress, reaction);
  else
    domain_held_force(d, r->now.u, r->body.fixed, reaction);
  for (size_t i = 0; i < r->n_dof; ++i) reaction[i] -= r->now.F[i];
  if (r->nodes.n > 0) surface_spread(r->surface, -1.0, r->now.rc, reaction);
  ties_share(&r->body.ties, reaction);
  for (size_t i = 0; i < r->n_dof; ++i)
    if (!r->body.fixed[i]) reaction[i] = 0.0;
}

double run_motion_over(const run *r, int k) {
  return (r->now.uc[k] - r->old.uc[k]) -
         (run_drift(&r->now, k) - run_drift(&r->old, k));
}

void run_slide(const run *r, int i, int a, int from_origin, double *v) {
  const contact_surface *s = r->surface;
  const int dim = s->dim;
  const double *row = &s->frame[dim * (dim * i + a)];
  const obstacle *o = r->faces.pairs[surface_contact_of(s, i, a)].support;
  double before[3] = {0.0, 0.0, 0.0}, drift[3] = {0.0, 0.0, 0.0};
  surface_motion(s, r->now.u, i, a, v);
  if (!from_origin) surface_motion(s, r->old.u, i, a, before);
  if (o != NULL)
    obstacle_drift(o, dim, s->x + dim * i, row, from_origin ? 0.0 : r->old.t,
                   r->now.t, drift);
  for (int c = 0; c < dim; ++c) v[c] -= before[c] + drift[c];
  add_scaled(dim, -dot(dim, row, v), row, v);
}

/* In a static problem friction opposes the motion from the origin (CPR98, P2),
 * else that of the increment. */
static int is_from_origin(const run *r) {
  return r->step->kind == STEP_STATIC && !r->course.relaxing;
}

/* Motion that friction opposes. */
static double slip_of(const run *r, int k) {
  if (is_from_origin(r)) return r->now.uc[k] - run_drift(&r->now, k);
  return run_motion_over(r, k);
}

/* The same of a node along its tangents. At a corner rows are other normals. */
static void find_slip(const run *r, int i) {
  const int dim = r->msh->dim;
  double v[3], t[3], *slip = &r->result.slip[(dim - 1) * i];
  if (!surface_is_corner(r->surface, i)) {
    for (int a = 1; a < dim; ++a) slip[a - 1] = slip_of(r, dim * i + a);
    return;
  }
  run_slide(r, i, 0, is_from_origin(r), v);
  for (int a = 1; a < dim; ++a) {
    surface_tangent(r->surface, i, a, t);
    slip[a - 1] = dot(dim, t, v);
  }
}

/* 1: supports hold node i along its contact, whatever it touches there. */
static int is_carried(const contact_surface *s, int i) {
  for (int a = 1; a < s->dim; ++a)
    if (!s->held[s->dim * i + a] || !surface_is_mutual(s, i, a)) return 0;
  return 1;
}

/* Slip of such a node, m; 0 where it is rounding of what moves. */
static double carried_slip(const run *r, int k, double still,
                           const double *slip) {
  double length = 0.0, moves = 0.0;
  for (int a = 0; a < r->msh->dim - 1; ++a) {
    length = hypot(length, slip[a]);
    moves += fabs(r->now.uc[k + a]) + fabs(r->old.uc[k + a]) +
             fabs(run_drift(&r->now, k + a)) + fabs(run_drift(&r->old, k + a));
  }
  return length > still + RUN_ROUNDING * moves ? length : 0.0;
}

/*
 * Friction on a node that supports hold along its contact is no unknown of the
 * contact problem, but a force on the supports: against their motion, or what
 * it was, within the limit, where nothing moves.
 */
static void find_carried(run *r, int i, double still) {
  const int tangents = r->msh->dim - 1, k = r->msh->dim * i + 1;
  const int fresh = is_from_origin(r);
  const double *slip = &r->result.slip[tangents * i], g = r->result.g[i];
  const double length = carried_slip(r, k, still, slip);
  double *force = &r->now.rc[k], size = 0.0;
  for (int a = 0; a < tangents; ++a) {
    force[a] = length > 0.0 ? -slip[a] : fresh ? 0.0 : r->old.rc[k + a];
    size = hypot(size, force[a]);
  }
  for (int a = 0; a < tangents && (length > 0.0 || size > g); ++a)
    force[a] *= g / size;
  if (length > 0.0 && r->result.contact[i] == CONTACT_STICK)
    r->result.contact[i] = CONTACT_SLIP;
}

double run_still(const run *r) {
  return RUN_ROUNDING * largest_entry(r->n_dof, r->now.u) +
         4.0 * DBL_EPSILON * r->msh->size;
}

/* Forces of contact nodes that are no unknowns, as supports bear them. */
static void find_borne(run *r) {
  const int rubs = r->result.g != NULL && surface_has_held(r->surface);
  const double still = rubs ? run_still(r) : 0.0;
  for (int i = 0; i < r->nodes.n && rubs; ++i)
    if (is_carried(r->surface, i)) find_carried(r, i, still);
}

/* Slip against the obstacle, gap left, status. */
static void find_contact(run *r) {
  for (int i = 0; i < r->nodes.n; ++i) {
    r->result.open_gap[i] = r->problem.gap[i] - r->now.uc[r->msh->dim * i];
    find_slip(r, i);
  }
  if (r->result.g != NULL) {
    contact_limit(&r->problem.cp, run_rows(r, 1, r->now.rc), r->result.g);
    active_spread(&r->nodes.active, r->nodes.n, r->result.g);
  }
  contact_classify(&r->problem.cp, run_rows(r, 0, r->now.uc),
                   run_rows(r, 1, r->now.rc), r->result.contact);
  if (r->problem.cp.side_gap != NULL)
    contact_stops(&r->problem.cp, r->now.uc, r->now.rc, 1, NULL,
                  r->result.closed);
  for (int i = r->nodes.n - 1, k = r->nodes.active.n_in - 1;
       r->nodes.active.in != NULL && i >= 0; --i)
    r->result.contact[i] = k >= 0 && r->nodes.active.in[k] == i
                               ? r->result.contact[k--]
                               : CONTACT_OPEN;
  find_borne(r);
}

/* Force and moment of one row of a contact node. */
static void add_row(const run *r, int i, int a, contact_total *t) {
  const contact_surface *s = r->surface;
  int dim = s->dim;
  const double *at = surface_place(s, i, a);
  double force[3] = {0.0}, x[3] = {0.0}, moment[3];
  for (int c = 0; c < dim; ++c) {
    x[c] = at[c];
    force[c] = s->frame[dim * dim * i + dim * a + c] * r->now.rc[dim * i + a];
    t->force[c] += force[c];
  }
  cross(x, force, moment);
  add_scaled(3, 1.0, moment, t->moment);
}

/* What the force of a normal closes of its contact, and presses on it. */
static void add_normal(double rc, double area, int closed, contact_total *t) {
  t->normal += rc;
  if (closed) t->area += area;
  if (area > 0) t->pressure = fmax(t->pressure, -rc / area);
}

/* Row a of node i is the normal of another contact than its first. */
static void add_side(const run *r, int i, int a, contact_total *t) {
  const contact_surface *s = r->surface;
  const int k = s->dim * i + a, at = (s->dim - 1) * i + a - 1;
  const double rc = r->now.rc[k];
  const int closed = r->result.closed[k];
  add_normal(rc, s->side_area[at], closed, t);
  t->n_open += !closed;
  t->n_slip += closed;
  if (r->problem.side_gap != NULL)
    t->penetration =
        fmax(t->penetration, r->now.uc[k] - r->problem.side_gap[at]);
}

static void add_node(const run *r, int i) {
  const contact_surface *s = r->surface;
  const contact_status now = r->result.contact[i];
  contact_total *own = &r->result.totals[s->contact_id[i]];
  for (int a = 0; a < s->dim; ++a) {
    contact_total *t = &r->result.totals[surface_contact_of(s, i, a)];
    const double rc = r->now.rc[s->dim * i + a];
    add_row(r, i, a, t);
    if (a == 0)
      add_normal(rc, s->area[i], now != CONTACT_OPEN, t);
    else if (surface_normal_of(s, i, a) >= 0)
      add_side(r, i, a, t);
    else
      t->tangential[a - 1] += rc;
  }
  own->n_open += now == CONTACT_OPEN;
  own->n_slip += now == CONTACT_SLIP;
  own->n_stick += now == CONTACT_STICK;
  own->penetration = fmax(own->penetration, -r->result.open_gap[i]);
}

static void find_totals(run *r) {
  CLEAR(r->result.totals, r->m->n.contact);
  for (int i = 0; i < r->nodes.n; ++i) add_node(r, i);
}

/* Torque of the contacts about their axes; one taken from an obstacle is where
 * MOVE has brought it. */
static void find_torques(run *r) {
  for (int i = 0; i < r->m->n.contact && r->result.torque != NULL; ++i) {
    const contact *c = &r->m->contacts[i];
    const contact_total *t = &r->result.totals[i];
    const double *f = t->force;
    double x[3], d[3] = {0.0, 0.0, 0.0};
    if (c->axis_of_obstacle)
      obstacle_motion(r->faces.pairs[i].support, r->now.t, d);
    for (int k = 0; k < 3; ++k) x[k] = c->axis_point[k] + d[k];
    r->result.torque[i] =
        c->axis[0] * (t->moment[0] - x[1] * f[2] + x[2] * f[1]) +
        c->axis[1] * (t->moment[1] - x[2] * f[0] + x[0] * f[2]) +
        c->axis[2] * (t->moment[2] - x[0] * f[1] + x[1] * f[0]);
  }
}

/* Energy of the springs of laws that elastic constants represent, J: the part
 * 1/2 sigma R sigma of their strain energy (model.h). */
static status relaxed_energy(const run *r, double *kept) {
  const int ns = r->m->ns;
  int any = 0;
  *kept = 0.0;
  for (int i = 0; i < r->m->n.material; ++i)
    any |= r->m->materials[i].is_relaxed;
  if (!any) return OK;
  OWNED_NEW(double, sigma, (size_t)ns * r->msh->n_elem);
  domain_stress(&r->body.d, r->now.u, NULL, sigma);
  for (int e = 0; e < r->msh->n_elem; ++e) {
    const material *mat = run_material(r, e);
    double strain[6];
    const double *own = sigma + (size_t)ns * e;
    if (!mat->is_relaxed) continue;
    tensor_product(ns, mat->relaxed, own, strain);
    *kept += 0.5 * element_weight(&r->body.d, e) * dot(ns, own, strain);
  }
  return OK;
}

/*
 * Energies of the increment. The trapezoidal works balance to rounding for a
 * linear elastic body, whatever the increment: with K symmetric
 *   E - E_old = 1/2 (Ku + Ku_old)'(u - u_old),
 * and with strains e0 that carry no stress 1/2 (s + s_old)'(e0 - e0_old) less.
 */
static status find_energies(run *r) {
  const equilibrium *a = &r->old, *b = &r->now;
  energies e = a->energy;
  double kept;
  int dim = r->msh->dim;
  for (size_t i = 0; i < r->n_dof; ++i)
    e.external += 0.5 * (a->F[i] + b->F[i]) * (b->u[i] - a->u[i]);
  for (size_t i = 0; i < r->n_dof && (r->m->effects & EFFECT_REACTION); ++i)
    e.external += 0.5 * (a->reaction[i] + b->reaction[i]) * (b->u[i] - a->u[i]);
  double work = 0.0, friction = 0.0;
  if (r->step->kind == STEP_STATIC) e.friction_end = 0.0;
  for (int i = 0; i < r->nodes.n; ++i) {
    for (int c = 0; c < dim; ++c) {
      int k = dim * i + c;
      work += 0.5 * (a->rc[k] + b->rc[k]) * (b->uc[k] - a->uc[k]);
      /* The side of a corner is a second obstacle, no friction. */
      if (c == 0 || r->surface->side_id[(dim - 1) * i + c - 1] >= 0) continue;
      friction -= 0.5 * (a->rc[k] + b->rc[k]) * run_motion_over(r, k);
      e.friction_end -= b->rc[k] * slip_of(r, k);
    }
  }
  e.friction += friction;
  e.normal += work + friction;
  e.stored -= a->kept;
  strains_work(r, &e);
  if (r->strains.visco != NULL) PASS(visco_energies(r, &e));
  PASS(relaxed_energy(r, &kept));
  e.strain = strains_energy(r) - kept;
  e.inelastic += kept - a->kept;
  e.stored += kept;
  e.defect = e.external + e.normal - e.friction - e.thermal - e.inelastic -
             (e.strain - e.start);
  const double part[] = {e.external, e.normal,    e.friction,
                         e.thermal,  e.inelastic, e.strain};
  for (int k = 0; k < 6; ++k) e.largest = fmax(e.largest, fabs(part[k]));
  r->now.energy = e;
  r->now.kept = kept;
  return OK;
}

status result_evaluate(run *r, int due) {
  unsigned effects = r->m->effects;
  int shown = (effects & EFFECT_STRESS) && due;
  int needed = run_finds_mesh_error(r) || r->m->accuracy.ref.has_stress;
  if (shown || needed) {
    /* Stresses that an output or an error estimate needs. */
    stage s = run_finds_mesh_error(r) ? STAGE_MESH_ERROR : STAGE_REFERENCE;
    TIMED(shown ? STAGE_STRESS : s);
    domain_stress(&r->body.d, r->now.u, r->result.strain, r->result.stress);
  }
  if (r->nodes.n > 0) find_contact(r);
  if (effects & EFFECT_REACTION) find_reactions(r, shown || needed);
  if (r->m->n.contact > 0) find_totals(r);
  find_torques(r);
  if (r->course.relaxing)
    result_start(r, &r->now);
  else
    PASS(find_energies(r));
  return OK;
}

void result_start(run *r, equilibrium *e) {
  strains_start(r, e);
  double strain = domain_strain_energy(&r->body.d, e->u);
  e->energy = (energies){.strain = strain, .start = strain, .largest = strain};
}

status result_accept(run *r) {
  if (r->nodes.n > 0) COPY(r->problem.f_before, r->problem.f, r->nodes.n_row);
  r->problem.n_before = r->nodes.n_row;
  equilibrium e = r->old;
  r->course.note[0] = '\0';
  r->old = r->now;
  r->now = e;
  return r->strains.visco == NULL ? OK : visco_accept(r);
}
