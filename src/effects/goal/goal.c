/*
 * *GOAL: quantities of the solution with their errors. For each of them the
 * contact problem linearised at the solution is solved once more, transposed: a
 * solve with the shared dense factor, one with that of the body.
 *
 * Friction that remembers: a node sticks at the place where the increment
 * before has left it, which is in error too. With s the derivative of J by the
 * positions of stick and e the errors of the nodes after the increment before,
 *
 *   J(u) - J(u_h) = estimate of this increment + s'e.
 *
 * e is found forwards, by the same linearised problem under the forces of what
 * u is in the bubbles, at the positions of stick that are e of the increment
 * before further: one solve an increment for all goals at all times, the
 * transpose of a chain of adjoints backwards through the increments.
 */
#include "effects/goal/parts.h"
#include "effects/plan/effect.h"
#include "model/check/check.h"
#include "run/history/loop.h"

#include <cblas.h>

static const double DIGITS = 1e-13;   /* -, of the terms: their rounding; that
                                         of the solution, whose condition goes
                                         like the nodes in the plane, besides */
static const double ROUNDING = 1e-12; /* -, of the value: no error at all */
static const double TURN = 1e-9;      /* -, of directions: they are the same */
/* Measured on strips whose crack has 0.1 to 0.7 of their width: what the
 * estimate of a factor lacks is up to 0.12 of it and this times the error of
 * the mesh in the energy norm. */
static const double COARSE = 4.0; /* - */

/* Errors that friction remembers, after the last increment. */
typedef struct goal_history {
  double *u;    /* [dim*n_node] of the nodes, m; NULL: none is needed */
  double *edge; /* [dim*n_edge] u in the bubbles of contact edges, m; NULL: 0 */
  int n_edge;
  goal_estimate *sum; /* [n] of goals that are sums over the increments */
  int lost;           /* 1: an increment before was not covered */
  int missed;         /* 1: goal_surface.is_missed of one */
} goal_history;

typedef struct goal_state {
  int n;
  goal_result *result;      /* [n] */
  double *product;          /* [n*n_elem] of goal_estimate_find, or NULL */
  space_recovery *recovery; /* its own; NULL: not needed so far */
  long elastic_no;          /* of the run, that it is made of */
  goal_border border;
  mesh bordered; /* the mesh with faces for all its border */
  goal_history before;
} goal_state;

static status goals_new(run *r, void **self) {
  goal_state *own = *self;
  own->n = r->m->n.goal;
  PASS(goal_border_new(r->msh, &own->border));
  PASS(goal_add_faces(r->msh, &own->border, &own->bordered));
  PASS_NEW(own->result, own->n);
  if (r->m->accuracy.goal_products)
    PASS_NEW(own->product, (size_t)own->n * r->msh->n_elem);
  PASS_NEW(own->before.sum, own->n);
  if (!effect_is_on(&slip_history_effect, r->m)) return OK;
  PASS_NEW(own->before.u, r->n_dof);
  return OK;
}

/* ---- what the estimate covers -------------------------------------------- */

/* 1: of pairs there are cracks alone, each within one material. */
static int has_cracks_alone(const run *r) {
  int all = r->m->n.tie == 0;
  for (int i = 0; i < r->m->n.contact; ++i) {
    const contact *c = &r->m->contacts[i];
    all &= !c->is_pair || (c->is_crack && !model_is_interface(r->m, r->msh, i));
  }
  return all;
}

static int is_covered(const run *r) {
  return has_cracks_alone(r) && r->body.d.cluster == NULL &&
         r->strains.visco == NULL && !effects_sum_up(r) &&
         r->problem.given == NULL && r->m->mesh.corner_id < 0 &&
         (r->nodes.n == 0 || contact_has_stiffness(&r->problem.cp)) &&
         r->solving.report.outcome > 0;
}

/* ---- the increments before ----------------------------------------------- */

/* 1: the positions of stick are those of the increment before. */
static int remembers(const run *r, const goal_state *own) {
  return own->before.u != NULL && r->nodes.n > 0 && run_remembers(r);
}

/* A static problem starts from the origin. */
static void forget(const run *r, goal_history *h, int n) {
  if (r->step->kind != STEP_STATIC || r->course.relaxing) return;
  if (h->edge != NULL) CLEAR(h->edge, (size_t)r->msh->dim * h->n_edge);
  CLEAR(h->sum, n);
  h->lost = h->missed = 0;
}

/* ---- an increment -------------------------------------------------------- */

/* What all goals of the increment share. */
typedef struct shared {
  goal_surface surface;
  goal_estimator *estimator;
  contact_adjoint *adjoint; /* NULL: no contact, or singular */
  goal_form form;
  double *y;                    /* [dim*n_node] */
  double *j, *more, *psi, *y_c; /* [n_row] */
  double *lacks;                /* [dim*n_node] of boundary.c, heat.c, N */
  double *rest;                 /* [3*n_elem] of goal_add_thermal, or NULL */
  double *moved; /* [n_row] errors of the positions of stick, m */
} shared;

/* That of the error of the mesh, or its own. */
static status recover(const run *r, goal_state *own, space_recovery **out) {
  PASS(mesh_recovery(r, out));
  if (*out != NULL) return OK;
  if (own->recovery == NULL || own->elastic_no != r->body.elastic_no) {
    FORGET(own->recovery);
    OWNS(own);
    PASS(space_recovery_new(&r->body.d, &own->recovery));
    own->elastic_no = r->body.elastic_no;
  }
  *out = own->recovery;
  return OK;
}

static status set_moved(const run *r, goal_state *own, shared *s) {
  if (!remembers(r, own)) return OK;
  OWNED_NEW(double, at, r->nodes.n_c);
  surface_relative(r->surface, own->before.u, at);
  run_take_rows(r, at, s->moved);
  return OK;
}

static int has_goal_of(const model *m, goal_quantity of) {
  for (int i = 0; i < m->n.goal; ++i)
    if (m->accuracy.goals[i].quantity == of) return 1;
  return 0;
}

/* 1: displacements of groups. */
static int has_mean(const model *m) {
  int any = 0;
  for (int i = 0; i < m->n.goal; ++i)
    any |= m->accuracy.goals[i].quantity == GOAL_DISPLACEMENT &&
           (m->accuracy.goals[i].group_id >= 0 ||
            m->accuracy.goals[i].from_id >= 0);
  return any;
}

/* 1: nodes slip, and their friction follows the pressures. */
static int rubs(const run *r) {
  for (int i = 0; i < r->nodes.n && r->problem.B != NULL; ++i)
    if (goal_slides(r, i) && r->result.g[i] > 0.0) return 1;
  return 0;
}

static status prepare(run *r, goal_state *own, shared *s) {
  space_recovery *recovery;
  PASS(recover(r, own, &recovery));
  PASS(goal_surface_new(r, &own->border, recovery, &s->surface));
  const size_t dim = r->msh->dim;
  for (int k = 0; k < s->surface.n_edge && own->before.edge != NULL; ++k)
    COPY(s->surface.edge[k].stick, own->before.edge + dim * k, dim);
  const goal_solution found = {.d = &r->body.d,
                               .u = r->now.u,
                               .sigma = r->result.stress,
                               .surface = &s->surface,
                               .has_flux = has_goal_of(r->m, GOAL_SIF),
                               .has_mean = has_mean(r->m),
                               .has_energy = has_goal_of(r->m, GOAL_ENERGY),
                               .rubs = rubs(r)};
  PASS(goal_estimator_new(&found, recovery, &s->estimator));
  PASS_NEW_REALS(r->n_dof, &s->y, &s->lacks);
  PASS(goal_add_boundary(r, s->lacks));
  PASS(goal_add_interfaces(r, recovery, s->lacks, &s->form.of_all));
  PASS(goal_add_thermal(r, s->lacks, &s->rest));
  s->form.of_all.rest = s->rest;
  PASS_NEW_REALS(r->nodes.n_row, &s->j, &s->more, &s->psi, &s->y_c, &s->moved);
  if (r->nodes.n_row == 0) return OK;
  PASS(set_moved(r, own, s));
  return contact_adjoint_new(&r->problem.cp, run_rows(r, 0, r->now.uc),
                             run_rows(r, 1, r->now.rc), &s->adjoint);
}

/* Friction of sliding nodes that supports hold is no unknown: psi of it on the
 * normal forces that its limit follows. */
static void spread_held(const run *r, double *psi) {
  const sparse_rows *B = r->problem.B;
  const int dim = r->msh->dim;
  for (int i = 0; B != NULL && i < r->nodes.n; ++i) {
    double along = 0.0;
    if (!goal_slides(r, i) || !(r->result.g[i] > 0.0)) continue;
    for (int k = dim * i + 1; k < dim * (i + 1); ++k)
      if (r->surface->held[k]) along += psi[k] * r->now.rc[k] / r->result.g[i];
    for (int e = B->start[i]; e < B->start[i + 1]; ++e)
      psi[dim * B->col[e]] -= along * B->val[e];
  }
}

/* The adjoint of s->form: s->y, *solver. */
static status solve(run *r, shared *s, double *solver) {
  *solver = 0.0;
  PASS(condense_load(r->c, s->form.load, NULL, s->j));
  if (s->adjoint != NULL) {
    run_take_rows(r, s->form.rows, s->more);
    OWNED_NEW(double, psi, r->nodes.n_c);
    COPY(psi, s->form.psi, r->nodes.n_c);
    spread_held(r, psi);
    run_take_rows(r, psi, s->psi);
    for (int k = 0; k < r->nodes.n_row; ++k) s->j[k] += s->more[k];
    PASS(contact_adjoint_solve(s->adjoint, s->j, s->psi, s->y_c, solver));
  }
  return condense_recover(r->c, s->y_c, s->y);
}

/* s'e of the head of this file, and the sum of its magnitudes. */
static double of_sticks(const run *r, const goal_state *own, const shared *s,
                        double *size) {
  double sum = 0.0;
  *size = 0.0;
  if (s->adjoint == NULL || !remembers(r, own)) return 0.0;
  const double *by = contact_adjoint_stick(s->adjoint);
  for (int k = 0; k < r->nodes.n_row; ++k) {
    const double part =
        (by[k] - (s->form.sums ? s->more[k] : 0.0)) * s->moved[k];
    sum += part;
    *size += fabs(part);
  }
  return sum;
}

/* Work of friction that u in the bubbles of the contact does. */
static status of_slip(const run *r, const shared *s, double *sum) {
  const int dim = r->msh->dim;
  const double *now = goal_estimator_edges(s->estimator);
  *sum = 0.0;
  OWNED_OF(int, where, goal_places(r, &where));
  for (int k = 0; k < s->surface.n_edge; ++k, now += dim) {
    const contact_edge *e = &s->surface.edge[k];
    const int q[2] = {where[e->a], where[e->b]};
    if (!e->closed || e->stuck) continue;
    for (int end = 0; end < 2; ++end)
      for (int a = 1; a < dim && q[end] >= 0; ++a) {
        const double *t = r->surface->frame + dim * dim * q[end] + dim * a;
        const double traction =
            r->now.rc[dim * q[end] + a] / r->surface->area[q[end]];
        for (int c = 0; c < dim; ++c)
          *sum -= 0.5 * e->weight * traction * t[c] * (now[c] - e->stick[c]);
      }
  }
  return OK;
}

/* [n_elem] of a goal, or NULL. */
static double *product_of(const run *r, const goal_state *own, int id) {
  return own->product == NULL ? NULL
                              : own->product + (size_t)r->msh->n_elem * id;
}

/* What a stress intensity factor has by the bubbles, and by its integral at
 * more points than the centroids. */
static double of_factor(const run *r, const shared *s) {
  const fracture_linear *f = &s->form.factor;
  const goal_flux flux = {f->n, f->elem, fracture_corner(r->msh->dim), f->flux};
  double sum = goal_estimator_flux(s->estimator, &flux) - f->turned;
  for (size_t k = 0; k < r->n_dof; ++k) sum -= f->by_u[k] * r->now.u[k];
  return sum;
}

/* What contact forces do between the nodes: to the adjoint, and to what they
 * are summed with; and where friction turns back. */
static status of_contact(const run *r, const shared *s, double *product,
                         double *sum, double *doubt) {
  const int dim = r->msh->dim;
  double turn, area, value;
  OWNED_NEW(double, z, r->n_dof);
  OWNED_NEW(double, F, r->n_dof);
  COPY(z, s->y, r->n_dof);
  for (int k = 0; k < dim * r->nodes.n; ++k)
    for (int c = 0; c < dim; ++c)
      z[dim * r->surface->node_id[k / dim] + c] +=
          s->form.psi[k] * r->surface->basis[dim * k + c];
  PASS(goal_work_between(r, &s->surface, s->form.is_field ? z : s->y, z,
                         s->form.spin, &turn, &area));
  PASS(goal_value_between(r, &s->surface, z, &value));
  *sum = turn + area + value;
  goal_estimator_adjoint_force(s->estimator, F);
  cblas_daxpy((int)r->n_dof, -1.0, s->form.load, 1, F, 1);
  return goal_add_doubts(r, &s->surface, z, F, product, doubt);
}

/* What the residual of the elements has not. */
static status complete(const run *r, const shared *s, double *product,
                       goal_estimate *e) {
  const goal_form *f = &s->form;
  double along = 0.0, doubt = 0.0;
  PASS(of_contact(r, s, product, &along, &doubt));
  if (f->factor.n > 0) e->error += of_factor(r, s);
  const double beyond = cblas_ddot((int)r->n_dof, s->lacks, 1, s->y, 1);
  const double between = goal_mean_bubbles(r, s->estimator, f);
  e->error += f->curved + along + beyond + between;
  e->magnitude += fmax(fabs(f->curved), f->beyond) + fabs(along) +
                  fabs(beyond) + fabs(between) + doubt;
  e->product += doubt;
  e->ends += doubt;
  e->error += e->hoop;
  if (f->sums) {
    double slips;
    PASS(of_slip(r, s, &slips));
    e->error += slips;
    e->magnitude += fabs(slips);
  }
  if (f->is_square) e->hoop = 0.0;
  return OK;
}

/* What the estimate of a factor in the plane may lack on a coarse mesh. */
static double of_coarseness(const run *r, const shared *s,
                            const goal_estimate *e) {
  const double energy = 2.0 * r->now.energy.strain;
  if (s->form.factor.n == 0 || r->msh->dim == 3 || !(energy > 0.0)) return 0.0;
  return COARSE * sqrt(goal_estimator_energy(s->estimator) / energy) *
         fabs(e->error);
}

/* By what the form of a goal knows. */
static goal_verdict verdict_of(const goal_form *f, const goal_estimate *e,
                               goal_verdict found) {
  if (found != GOAL_RELIABLE) return found;
  if (f->is_coarse) return f->factor.n > 0 ? GOAL_FEW_ELEMENTS : GOAL_FEW_NODES;
  if (f->held > 0.5 * fabs(e->error)) return GOAL_SUPPORT_END;
  return f->is_front ? GOAL_FRONT : found;
}

/* In a corner of the border in the plane, where recovered gradients are
 * extrapolated along both sides: there displacements were in error by 0.7
 * to 1.2 of the estimate; in axisymmetric bodies by 0.5 to 1.3 on a plane of
 * symmetry too. */
static double of_corner(const run *r, const goal_state *own, int id,
                        double error) {
  static const double CORNER = 2.6, PART = 0.5; /* rad, - */
  const goal_card *g = &r->m->accuracy.goals[id];
  const int node[2] = {g->node_id, g->from_node_id}, c = g->component;
  if (g->quantity != GOAL_DISPLACEMENT || r->msh->dim == 3) return 0.0;
  for (int k = 0; k < 2; ++k) {
    if (node[k] < 0 || !(own->border.angle[node[k]] < CORNER)) continue;
    const unsigned char *fixed = r->body.d.fixed + 2 * node[k];
    if (!fixed[c] && (!fixed[1 - c] || model_is_axisymmetric(r->m)))
      return PART * fabs(error);
  }
  return 0.0;
}

/* Half of the error may be missing. */
static status doubt_of_mesh(run *r, goal_state *own, goal_result *out) {
  space_recovery *recovery;
  PASS(recover(r, own, &recovery));
  if (!space_is_coarse(space_depth(recovery))) return OK;
  if (out->verdict == GOAL_RELIABLE) out->verdict = GOAL_COARSE;
  out->band += fabs(out->error);
  return OK;
}

/* Closed nodes of the contact of a goal, or of all. */
static int closed_of(const run *r, const shared *s, int id) {
  const int of = r->m->accuracy.goals[id].contact_id;
  return of >= 0 ? s->surface.closed[of] : s->surface.n_closed;
}

/* Elements that lock do not show how much: the goal may be as much too small as
 * displacements are, or twice that, unless its adjoint strains nothing. */
static status doubt_of_locking(run *r, goal_state *own, const shared *s, int id,
                               const goal_estimate *e) {
  static const double RIGID = 1e-9; /* -, of the value */
  goal_result *out = &own->result[id];
  const int closed = closed_of(r, s, id);
  const double size = fmax(fabs(s->form.value), s->form.size);
  space_recovery *recovery;
  double most = 0.0;
  PASS(recover(r, own, &recovery));
  double n = space_depth(recovery);
  if (closed > 0) n = fmin(n, 0.5 * (r->msh->dim == 3 ? sqrt(closed) : closed));
  for (EACH(const section, of, r->m->sections, r->m->n.section)) {
    const double nu = model_locking_nu(r->m, of);
    if (nu > 0.0) most = fmax(most, model_locking_error(nu, n));
  }
  const double lack = 2.0 * most / (1.0 - most) * size;
  if (!(lack > 0.0) || e->product <= RIGID * size) return OK;
  if (out->verdict == GOAL_RELIABLE || lack > out->band)
    out->verdict = GOAL_LOCKED;
  out->band += lack;
  return OK;
}

/* v[3]: what J changes by a unit force on contact node i, less that by it as a
 * contact force. */
static void influence_of(const run *r, const shared *s, int i, double *v) {
  const contact_surface *on = r->surface;
  const int dim = on->dim;
  CLEAR(v, 3);
  COPY(v, s->y + dim * on->node_id[i], dim);
  for (int k = dim * i; k < dim * (i + 1); ++k)
    add_scaled(dim, s->form.psi[k], on->basis + dim * k, v);
}

/* 1: the same force of the obstacle on another node would change J: where few
 * nodes have the forces, it is what their places make it. Radial forces are
 * those of the place too. */
static int turns(const run *r, const shared *s) {
  const contact_surface *on = r->surface;
  const int dim = r->msh->dim, last = r->problem.ut0 != NULL ? dim : 1;
  double size = largest_entry(r->n_dof, s->y), most = 0.0;
  for (int i = 0; i < r->nodes.n; ++i) {
    double z[3];
    influence_of(r, s, i, z);
    for (int c = 0; c < dim; ++c) {
      const double own = z[c] - s->y[dim * on->node_id[i] + c];
      size = fmax(size, fabs(own));
      if (c > 0 || !r->faces.input.axisymmetric) continue;
      for (int k = dim * i; k < dim * i + last; ++k)
        most = fmax(most, fabs(own * on->frame[dim * k]));
    }
    for (int k = dim * i; k < dim * i + last; ++k)
      if (!on->held[k])
        most = fmax(most, fabs(dot(dim, on->frame + dim * k, z)));
  }
  return most > TURN * size;
}

/* By what J changes if the force of node q[0] is on q[1], along its normal. */
static double moved_by(const run *r, const shared *s, const int *q) {
  const contact_surface *on = r->surface;
  const int dim = on->dim;
  double v[2][3], sum = 0.0;
  for (int k = 0; k < 2; ++k) influence_of(r, s, q[k], v[k]);
  for (int a = 0; a < dim; ++a) {
    const double *own = on->frame + dim * (dim * q[0] + a);
    const double *to = a == 0 ? on->frame + dim * dim * q[1] : own;
    sum +=
        r->now.rc[dim * q[0] + a] * (dot(dim, to, v[1]) - dot(dim, own, v[0]));
  }
  return fabs(sum);
}

/* The force of a node may be half an edge from it. */
static status doubt_of_places(const run *r, const shared *s, double *sum) {
  OWNED_OF(int, where, goal_places(r, &where));
  OWNED_NEW(double, most, r->nodes.n);
  for (EACH(const contact_edge, e, s->surface.edge, s->surface.n_edge))
    for (int k = 0; k < 2; ++k) {
      const int q[2] = {where[k == 0 ? e->a : e->b],
                        where[k == 0 ? e->b : e->a]};
      if (e->other[0] < 0)
        most[q[0]] = fmax(most[q[0]], 0.5 * moved_by(r, s, q));
    }
  for (int i = 0; i < r->nodes.n; ++i) *sum += most[i];
  return OK;
}

/* 1: few closed nodes, or nodes in a line on a surface in space: of the contact
 * of a goal, or of all. */
static int has_few(const run *r, const shared *s, int id) {
  enum { FEW = 3 };
  const int of = r->m->accuracy.goals[id].contact_id;
  const int n = closed_of(r, s, id);
  int whole = 0;
  for (int k = 0; k < r->m->n.contact; ++k)
    if (of < 0 || of == k) whole += s->surface.whole[k];
  return n > 0 && (n <= FEW || whole == 0);
}

/* exact: without an error but rounding. Nothing is known about a contact that
 * its nodes miss, or missed while a sum grew. */
static status doubt_of_nodes(const run *r, const shared *s, int id, int exact,
                             int missed, goal_result *out) {
  const int is_few = has_few(r, s, id);
  const int few = (out->verdict == GOAL_FEW_NODES || is_few) && turns(r, s);
  if (few && is_few) PASS(doubt_of_places(r, s, &out->band));
  if (exact) out->verdict = few ? GOAL_FEW_NODES : GOAL_RELIABLE;
  const int none = s->surface.n_closed == 0 && out->verdict < GOAL_NO_HISTORY;
  if ((s->surface.is_missed || (s->form.sums && missed)) &&
      (out->verdict == GOAL_RELIABLE || none))
    out->verdict = GOAL_FEW_NODES;
  return OK;
}

static status estimate(run *r, goal_state *own, shared *s, int id) {
  const goal_form *f = &s->form;
  goal_result *out = &own->result[id];
  const double value = f->value, cpu = out->cpu;
  goal_estimate e;
  double solver;
  PASS(solve(r, s, &solver));
  PASS(goal_estimate_find(s->estimator, s->y, f->has_tau ? f->tau : NULL,
                          f->is_square, product_of(r, own, id), &e));
  if (!isfinite(e.error)) return OK;
  PASS(complete(r, s, product_of(r, own, id), &e));
  e.error += of_sticks(r, own, s, &e.history);
  e.magnitude = fmax(e.magnitude, fabs(e.error));
  if (f->factor.n > 0) e.near = 0.0;
  e.few = has_few(r, s, id) ? fabs(e.error) : 0.0;
  if (f->sums) {
    goal_estimate_add(&e, &own->before.sum[id]);
    e = own->before.sum[id];
  }
  *out = goal_evaluate(&e);
  out->value = value;
  out->solver = solver;
  out->cpu = cpu;
  out->radius = f->radius;
  out->size = f->factors;
  out->band +=
      f->rough + f->held + of_coarseness(r, s, &e) +
      of_corner(r, own, id, e.error) +
      (DIGITS + DBL_EPSILON * r->msh->n_node) * fmax(f->size, fabs(value));
  out->verdict = verdict_of(f, &e, out->verdict);
  PASS(doubt_of_mesh(r, own, out));
  PASS(doubt_of_locking(r, own, s, id, &e));
  const int exact = e.magnitude <= ROUNDING * fabs(value);
  PASS(doubt_of_nodes(r, s, id, exact, own->before.missed, out));
  if (f->is_still && s->surface.n_closed > 0) out->verdict = GOAL_NO_SLIP;
  /* what would touch or slip on a finer mesh has no part in the estimate */
  if (exact && (out->verdict == GOAL_NO_SLIP ||
                (out->verdict == GOAL_FEW_NODES && closed_of(r, s, id) == 0)))
    out->error = out->band = NAN;
  if (remembers(r, own) && own->before.lost) out->verdict = GOAL_NO_HISTORY;
  return OK;
}

/* ---- the errors that the next increment remembers ------------------------ */

static status remember(run *r, goal_state *own, shared *s) {
  goal_history *h = &own->before;
  const int is_last = r->at.last && run_step_id(r) == r->m->n.step - 1;
  if (h->u == NULL || is_last) return OK;
  h->missed |= s->surface.is_missed;
  if (s->estimator == NULL || (r->nodes.n_row > 0 && s->adjoint == NULL)) {
    h->lost = 1;
    return OK;
  }
  if (h->edge == NULL) {
    OWNS(own);
    h->n_edge = s->surface.n_edge;
    PASS_NEW(h->edge, r->msh->dim * h->n_edge);
  }
  COPY(h->edge, goal_estimator_edges(s->estimator),
       (size_t)r->msh->dim * h->n_edge);
  /* Errors of the nodes by the bubbles and by the positions of stick. */
  goal_estimator_force(s->estimator, s->y);
  cblas_daxpy((int)r->n_dof, 1.0, s->lacks, 1, s->y, 1);
  PASS(condense_load(r->c, s->y, NULL, s->j));
  if (s->adjoint != NULL)
    PASS(contact_adjoint_change(s->adjoint, s->j, s->moved, s->y_c));
  return condense_recover(r->c, s->y_c, own->before.u);
}

static status find_goal(run *r, goal_state *own, shared *s, int id) {
  goal_result *out = &own->result[id];
  double *product = product_of(r, own, id);
  if (product != NULL) CLEAR(product, r->msh->n_elem);
  PASS(goal_form_set(r, &r->m->accuracy.goals[id], &s->form));
  *out = (goal_result){.value = s->form.value,
                       .error = NAN,
                       .solver = NAN,
                       .band = NAN,
                       .ends = NAN,
                       .cpu = out->cpu,
                       .verdict = s->form.why};
  if (s->form.why != GOAL_RELIABLE) return OK;
  out->verdict = GOAL_NOT_COVERED;
  if (s->estimator == NULL || (r->nodes.n_row > 0 && s->adjoint == NULL))
    return OK;
  return estimate(r, own, s, id);
}

/* The time that all share counts with the first. */
static status find_all(run *r, goal_state *own) {
  SCRATCH;
  shared s = {.estimator = NULL};
  double cpu = timer_cpu();
  PASS(goal_form_new(r, &s.form));
  forget(r, &own->before, own->n);
  if (!run_finds_mesh_error(r))
    domain_stress(&r->body.d, r->now.u, NULL, r->result.stress);
  if (is_covered(r)) PASS(prepare(r, own, &s));
  for (int k = 0; k < own->n; ++k) {
    PASS(find_goal(r, own, &s, k));
    own->result[k].cpu += timer_cpu() - cpu;
    cpu = timer_cpu();
  }
  PASS(remember(r, own, &s));
  own->result[0].cpu += timer_cpu() - cpu;
  return OK;
}

/* What is curved need not be in a group. */
static status find_goals(run *r, void *self) {
  goal_state *own = self;
  const mesh *msh = r->msh;
  r->msh = &own->bordered;
  const status found = find_all(r, own);
  r->msh = msh;
  return found;
}

static status keep(run *r, void *self, archive *a) {
  goal_state *own = self;
  goal_history *h = &own->before;
  int made = own->recovery != NULL;
  PASS(archive_ints(a, "recovery", &made, 1));
  if (archive_reads(a) && made) {
    space_recovery *recovery;
    PASS(recover(r, own, &recovery));
  }
  if (h->u == NULL) return OK;
  PASS(archive_ints(a, "lost", &h->lost, 1));
  PASS(archive_ints(a, "missed", &h->missed, 1));
  PASS(archive_ints(a, "edges", &h->n_edge, 1));
  OWNS(own);
  if (h->edge == NULL && h->n_edge > 0)
    PASS_NEW(h->edge, r->msh->dim * h->n_edge);
  PASS(archive_reals(a, "edge", h->edge, (size_t)r->msh->dim * h->n_edge));
  PASS(archive_reals(a, "u", h->u, r->n_dof));
  return archive_reals(a, "sum", (double *)h->sum,
                       own->n * sizeof *h->sum / sizeof(double));
}

/* With the errors that friction remembers, of the start of the increment. */
static status goals_copy(const run *r, const void *of, run *copy, void **self) {
  const goal_history *from = &((const goal_state *)of)->before;
  goal_state *own = *self;
  PASS(goals_new(copy, self));
  goal_history *h = &own->before;
  const size_t edges = (size_t)r->msh->dim * from->n_edge;
  h->lost = from->lost;
  h->missed = from->missed;
  h->n_edge = from->n_edge;
  COPY(h->sum, from->sum, own->n);
  if (h->u != NULL) COPY(h->u, from->u, r->n_dof);
  if (from->edge == NULL) return OK;
  PASS_NEW(h->edge, edges);
  COPY(h->edge, from->edge, edges);
  return OK;
}

static int goals_due(const run *r) {
  return !r->course.shadow || table_is_due_now(r, PRINT_GOALS);
}

static void show(const void *self, state *s) {
  const goal_state *own = self;
  s->errors.n_goal = own->n;
  s->errors.goals = own->result;
  s->errors.goal_products = own->product;
}

/* Factor of the contact; passes over the elements and solves of all, of each
 * goal, and of the errors that friction remembers. */
static effect_work expected(const plan_sizes *s) {
  const double m = plan_contact_unknowns(s), n = s->m->n.goal;
  const double passes = s->is_flat ? 6.0 : 12.0;
  const double factor = m * m * m / 3.0 / PLAN_DENSE;
  const double pass = s->elements * passes * plan_element_work(s);
  const double solve = 2.0 * work_factor_entries(s) + 4.0 * m * m;
  const int history = effect_is_on(&slip_history_effect, s->m);
  return (effect_work){
      n, "goals", s->increments,
      s->increments * (factor + (1.0 + n) * pass + (n + history) * solve)};
}

static int requires_goals(const model *m, const reason *why) {
  if (m->n.goal == 0) return plan_says(0, why, "no *GOAL card");
  return plan_at(why, &m->accuracy.goals[0].at, "*GOAL, NAME=%s",
                 m->accuracy.goals[0].name);
}

#include "run/column_row.h"

static const goal_result *result_of(const view *v, int id) {
  return &v->s->errors.goals[id];
}

VALUE(goal_no, id + 1)
VALUE(goal_value, result_of(v, id)->value)
VALUE(goal_error, result_of(v, id)->error)
VALUE(goal_corrected, result_of(v, id)->value + result_of(v, id)->error)
VALUE(goal_band, result_of(v, id)->band)
VALUE(goal_solver, result_of(v, id)->solver)
VALUE(goal_ends, 100 * result_of(v, id)->ends)

WORD_OF(goal_name, v->m->accuracy.goals[id].name)
WORD_OF(goal_unit_word, model_goal_unit(v->m, id))
WORD_OF(goal_word, goal_verdict_word(result_of(v, id)->verdict))
/* clang-format off */
#define GOAL PER_GOAL, AS_REAL, PRINT_GOALS, 0, SCENE_ALL, 0, NULL, 0
#define WORD PER_GOAL, AS_WORD, PRINT_GOALS, 0, SCENE_ALL, 0, NULL, 0
#define OWN "unit"
static const column columns[] = {
{"goal", "-", WORD, goal_no, goal_name, "NAME= of the *GOAL"},
{"unit", "-", WORD, goal_no, goal_unit_word, "of the values of the row"},
{"value", OWN, GOAL, goal_value, NULL, "on this mesh"},
{"error", OWN, GOAL, goal_error, NULL,
 "by the mesh, with its sign: estimate of the exact value less that on this "
 "mesh"},
{"corrected", OWN, GOAL, goal_corrected, NULL, "value + error"},
{"band", OWN, GOAL, goal_band, NULL,
 "the exact value is within it round the corrected one"},
{"solver_error", OWN, GOAL, goal_solver, NULL,
 "by the contact solver, with its sign"},
{"contact_ends", "%", GOAL, goal_ends, NULL,
 "share of the elements where the contact ends or changes between slip and "
 "stick, or a support ends, or in an inner corner"},
{"verdict", "-", WORD, goal_no, goal_word,
 "reliable, or why not"}};

const effect_ops goals_effect = {
  .name = "errors of goals", .bit = NO_BIT, .required = requires_goals,
  .expected = expected, .table = {PRINT_GOALS, PER_GOAL},
  .size = sizeof(goal_state), .items = offsetof(goal_state, n),
  .on = {.create = goals_new, .due = goals_due, .accept = find_goals,
         .show = show, .keep = keep, .copy = goals_copy},
  COLUMNS_OF(columns)};
/* clang-format on */
