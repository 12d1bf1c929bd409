/*
 * Stress intensity factors of the cracks (src/fracture): at the tips, in space
 * at the nodes of the fronts, by domain integrals, and at tips also from the
 * opening and sliding of the lips behind them (Williams 1957), a check that is
 * good to some percent.
 */
#include "effects/plan/effect.h"
#include "effects/shared.h"
#include "run/history/loop.h"

enum { MODES = 3 };

/* A row of the table. */
typedef struct tip {
  fracture_factors found;
  double creep, creep_scatter; /* C(t), W/m2; NAN: nothing creeps there */
  double jump[2];              /* K_I, K_II of the lips behind it, Pa m^(1/2) */
} tip;

typedef struct crack_state {
  fracture *of;
  fracture_material *materials; /* [n_section] */
  int n;
  const fracture_point *points; /* [n] of "of" */
  tip *tips;                    /* [n] */
  fracture_factors *found;      /* [n] of the last increment that needed them */
  double *times;                /* [n] G over its integral, - */
  int step_id;                  /* of that increment; -1: none */
  double t;                     /* its end, s */
  int flows;                    /* 1: there are strains without stress */
  double *rate;     /* [dim*n_node] of the displacements, m/s, or NULL */
  double *elastic;  /* [dim*n_node] displacements of an elastic body under the
                       same forces, m; NULL: none flows */
  double *sigma;    /* [ns*n_elem] Pa */
  double *traction; /* [dim*n_node] on the lips, Pa */
  double *lumped;   /* [dim*n_node] workspace: traction, Pa; thickness, m */
  double *force;    /* [dim*n_elem] on the elements, N/m3; NULL: none */
  double *point;    /* [dim*n_node] at nodes, by *CLOAD, loads on faces inside
                       and supports, 2-D: over the thickness, N (N/m) */
  double *held;     /* [dim*n_node] workspace of find_points, N */
  double *area;     /* [n_node] of the lips, m2; 0 at the fronts */
  double *shift;    /* [dim*n_node] from a node to where the force of a uniform
                       traction acts that it takes, m */
} crack_state;

/* ---- what stays ---------------------------------------------------------- */

/* Elastic constants of the sections; not those of anisotropic ones. */
static status new_materials(const run *r, crack_state *own) {
  const model *m = r->m;
  PASS_NEW(own->materials, m->n.section);
  for (int i = 0; i < m->n.section; ++i) {
    const elastic_table *e = &m->materials[m->sections[i].material_id].elastic;
    fracture_material *to = &own->materials[i];
    to->plane_stress = m->sections[i].kin == PLANE_STRESS;
    if (e->type != ELASTIC_ISO || e->n != 1) continue; /* E(T): no K */
    to->E = e->set[0].constant[0];
    to->nu = e->set[0].constant[1];
  }
  return OK;
}

/* The area of a lip face. */
static double area_of(const run *r, int face) {
  double normal[3];
  return mesh_face_normal(r->msh, face, normal) *
         model_thickness(r->m, r->msh->face_elem[face]);
}

/* Lip k of a crack, the plus lips first. */
static int lip_of(const mesh_crack *c, int k) {
  return k < c->n ? c->plus[k] : c->minus[k - c->n];
}

/* Half of each lip face to its nodes (a third in space). */
static void add_areas(const run *r, const mesh_crack *c, crack_state *own) {
  const mesh *m = r->msh;
  const int dim = m->dim;
  for (int i = 0; i < 2 * c->n; ++i) {
    const int *v = m->face + dim * lip_of(c, i);
    const double share = area_of(r, lip_of(c, i)) / dim;
    for (int a = 0; a < dim; ++a) {
      own->area[v[a]] += share;
      for (int k = 0; k < dim * dim; ++k)
        own->shift[dim * v[a] + k % dim] +=
            share / (dim + 1) *
            (m->x[dim * v[k / dim] + k % dim] - m->x[dim * v[a] + k % dim]);
    }
  }
}

/* forces[n_node]: bits of the components in which supports or *CLOAD of a step
 * act. */
static void mark_forces(const run *r, unsigned char *forces) {
  for (int i = 0; i < r->m->n.step; ++i)
    for (EACH(const load, l, r->m->steps[i].loads.item,
              r->m->steps[i].loads.n)) {
      if (l->kind != LOAD_FIXING && l->kind != LOAD_POINT) continue;
      const mesh_group *g = &r->msh->group[l->group_id];
      for (int k = 0; k < g->n_node; ++k)
        forces[g->node_id[k]] |= (unsigned char)(1u << l->component);
    }
}

/* 1: such forces act on a point in its plane. */
static int has_force(const fracture_point *p, const unsigned char *forces) {
  for (int c = 0; c < 3; ++c)
    if (forces[p->node] >> c & 1u && hypot(p->frame[c], p->frame[3 + c]) > 1e-6)
      return 1;
  return 0;
}

static int front_size(const run *r, int crack_id) {
  const mesh_crack *c = &r->msh->crack[crack_id];
  return c->front_start[c->n_front];
}

/* Points of a front without factors, and why. */
static void tell_points(const run *r, int id, const fracture_point *p,
                        const unsigned char *forces) {
  const crack *c = &r->m->mesh.cracks[id];
  const int n = front_size(r, id);
  int two = 0, crowded = 0, forced = 0, two_at = 0, crowded_at = 0,
      forced_at = 0;
  for (int i = 0; i < n; ++i) {
    if (p[i].section < 0 && two++ == 0) two_at = p[i].node;
    if (!(p[i].radius > 0.0) && crowded++ == 0) crowded_at = p[i].node;
    if (p[i].radius > 0.0 && has_force(&p[i], forces) && forced++ == 0)
      forced_at = p[i].node;
  }
  if (two > 0)
    message_add(r->m->log, P4028, &c->at,
                "*CRACK %s ends between two materials at %d of %d nodes, the "
                "first is %zu: no stress intensity factors there, the energy "
                "release rate alone",
                c->name, two, n, r->msh->node_no[two_at]);
  if (crowded > 0)
    message_add(r->m->log, P4029, &c->at,
                "*CRACK %s: %d of %d nodes of its front are nearer than two "
                "elements to another boundary, kink or crack, the first is "
                "%zu: no factors there",
                c->name, crowded, n, r->msh->node_no[crowded_at]);
  if (forced > 0)
    message_add(r->m->log, P4043, &c->at,
                "*CRACK %s: supports or *CLOAD act on %d of %d nodes of its "
                "front, the first is %zu: no factors where their force is in a "
                "domain",
                c->name, forced, n, r->msh->node_no[forced_at]);
}

static status new_cracks(run *r, crack_state *own) {
  const mesh *m = r->msh;
  const fracture_body body = {m, m->n_crack, m->crack, r->m->elem_section,
                              own->materials};
  OWNED_NEW(unsigned char, forces, m->n_node);
  PASS(fracture_new(&body, &own->of));
  own->n = fracture_count(own->of);
  own->points = fracture_points(own->of);
  for (int i = 0; i < m->n_crack; ++i) add_areas(r, &m->crack[i], own);
  for (int k = 0; k < m->dim * m->n_node; ++k)
    if (own->area[k / m->dim] > 0.0) own->shift[k] /= own->area[k / m->dim];
  for (int i = 0; i < m->n_crack; ++i)
    for (int k = 0; k < m->crack[i].front_start[m->crack[i].n_front]; ++k)
      own->area[m->crack[i].front_node[k]] = 0.0;
  PASS_NEW_ALL(OF(own->tips, own->n), OF(own->found, own->n),
               OF(own->times, own->n));
  mark_forces(r, forces);
  for (int i = 0, n = 0; i < m->n_crack; n += front_size(r, i++))
    tell_points(r, i, own->points + n, forces);
  return OK;
}

static status cracks_new(run *r, void **self) {
  crack_state *own = *self;
  PASS_NEW(own->sigma, (size_t)r->m->ns * r->msh->n_elem);
  PASS_NEW_REALS(r->n_dof, &own->traction, &own->lumped, &own->point,
                 &own->held);
  PASS_NEW_ALL(OF(own->area, r->msh->n_node), OF(own->shift, r->n_dof));
  if (load_has_body(r->m))
    PASS_NEW(own->force, (size_t)r->msh->dim * r->msh->n_elem);
  own->step_id = -1;
  own->flows =
      facts_has_inelastic(r->m) || (r->m->effects & EFFECT_THERMAL) != 0;
  if (own->flows) PASS_NEW(own->elastic, r->n_dof);
  if (own->flows) PASS_NEW(own->rate, r->n_dof);
  PASS(new_materials(r, own));
  return new_cracks(r, own);
}

/* ---- an increment -------------------------------------------------------- */

/* The gradient of P1 function "node" along the shift of another, -. */
static double along_shift(const run *r, const crack_state *own, int elem_id,
                          int node, int other) {
  const mesh *m = r->msh;
  const int *v = m->elem + (m->dim + 1) * elem_id;
  double g[12], sum = 0.0;
  int at = 0;
  while (v[at] != node) ++at;
  mesh_elem_gradients(m, elem_id, g);
  for (int c = 0; c < m->dim; ++c)
    sum += g[m->dim * at + c] * own->shift[m->dim * other + c];
  return sum;
}

/* A force over its area is the traction at the shifted place: to[dim*n_node]
 * gets what it is less at the node, by its mean slope on the faces there but
 * those at the front; or the transpose of that. */
static void shift_back(const run *r, const crack_state *own, int face,
                       int transposed, const double *from, double *to) {
  const int dim = r->msh->dim, *v = r->msh->face + dim * face;
  const double share = area_of(r, face) / dim;
  for (int a = 0; a < dim; ++a)
    if (!(own->area[v[a]] > 0.0)) return;
  for (int a = 0; a < dim; ++a)
    for (int b = 0; b < dim; ++b) {
      const double part =
          share / own->area[v[a]] *
          along_shift(r, own, r->msh->face_elem[face], v[b], v[a]);
      const int get = transposed ? v[a] : v[b], put = transposed ? v[b] : v[a];
      for (int c = 0; c < dim; ++c)
        to[dim * put + c] -= part * from[dim * get + c];
    }
}

static void shift_all(const run *r, const crack_state *own, int transposed,
                      double *t) {
  const mesh *m = r->msh;
  COPY(own->lumped, t, r->n_dof);
  for (int i = 0; i < m->n_crack; ++i)
    for (int k = 0; k < 2 * m->crack[i].n; ++k)
      shift_back(r, own, lip_of(&m->crack[i], k), transposed, own->lumped, t);
}

static void over_areas(const run *r, const crack_state *own, double *t) {
  const int dim = r->msh->dim;
  for (int k = 0; k < dim * r->msh->n_node; ++k)
    t[k] *= own->area[k / dim] > 0.0 ? 1.0 / own->area[k / dim] : 0.0;
}

void cracks_by_forces(const run *r, double *by) {
  const crack_state *own = effect_state(&r->effects, &cracks_effect);
  shift_all(r, own, 1, by);
  over_areas(r, own, by);
}

/* Sums of a line K + slope * distance by least squares. */
typedef struct fit {
  double n, x, xx, y, xy;
} fit;

static double fit_at_zero(const fit *f) {
  const double det = f->n * f->xx - f->x * f->x;
  return f->n < 2.0 || !(det > 0.0) ? NAN : (f->xx * f->y - f->x * f->xy) / det;
}

/* K of one node behind the tip at the distance x: a jump d of the lips is 8
 * K/E' sqrt(x/(2 pi)). */
static void add_jump(fit *f, double x, double jump, double modulus) {
  const double K = modulus / 8.0 * jump * sqrt(2.0 * acos(-1.0) / x);
  *f = (fit){f->n + 1.0, f->x + x, f->xx + x * x, f->y + K, f->xy + x * K};
}

/* From nodes within half of the largest domain, not next to the tip. */
static void find_jumps(const run *r, const crack_state *own,
                       const fracture_point *p, tip *t) {
  enum { NEAR = 2 };
  const contact_surface *s = r->surface;
  fit found[2] = {{.n = 0.0}, {.n = 0.0}};
  t->jump[0] = t->jump[1] = NAN;
  if (r->msh->dim == 3 || p->section < 0) return;
  const fracture_material *mat = &own->materials[p->section];
  if (!(mat->E > 0.0)) return;
  const double modulus =
      mat->plane_stress ? mat->E : mat->E / (1.0 - mat->nu * mat->nu);
  for (int i = 0; i < r->nodes.n; ++i) {
    if (s->contact_id[i] != r->m->mesh.cracks[p->crack].contact_id) continue;
    const double d[2] = {s->x[2 * i] - p->origin[0],
                         s->x[2 * i + 1] - p->origin[1]};
    const double x = hypot(d[0], d[1]);
    if (x < NEAR * p->size || x > p->radius / 2.0) continue;
    for (int k = 0; k < 2; ++k) { /* opening along e2, sliding along e1 */
      const double *e = &p->frame[k == 0 ? 3 : 0];
      double jump = 0.0, side = 0.0;
      for (int a = 0; a < 2; ++a) {
        const double *row = &s->frame[4 * i + 2 * a];
        jump += r->now.uc[2 * i + a] * (row[0] * e[0] + row[1] * e[1]);
      }
      side = s->frame[4 * i] * p->frame[3] + s->frame[4 * i + 1] * p->frame[4];
      add_jump(&found[k], x, side > 0.0 ? -jump : jump, modulus);
    }
  }
  for (int k = 0; k < 2; ++k) t->jump[k] = fit_at_zero(&found[k]);
}

/* What creeps keeps the stresses of an elastic body: the integrals take its
 * displacements under the same loads and contact forces. NAN where supports
 * move, or contact alone holds a body: those are not forces. */
static status find_elastic(const run *r, double *u) {
  OWNED double *f = NULL, *uc = NULL;
  condensed *c = r->elastic.c;
  const int n = r->nodes.n_row;
  if (condensed_floating(c) || largest_entry(r->n_dof, r->loads.ud) > 0.0) {
    for (size_t k = 0; k < r->n_dof; ++k) u[k] = NAN;
    return OK;
  }
  PASS_NEW_REALS(n, &f, &uc);
  PASS(condense_load(c, r->now.F, NULL, f));
  const double *rc = run_rows(r, 1, r->now.rc);
  for (int k = 0; k < n; ++k) f[k] += rc[k];
  if (n > 0) PASS(condensed_untouched(c, f, uc));
  return condense_recover(c, uc, u);
}

/* The power of the stress with which the material of a tip creeps; NAN: no
 * power law. */
static double exponent_of(const run *r, const fracture_point *p) {
  enum { NORTON_N = 1 };
  if (p->section < 0) return NAN;
  const law_card *law =
      &r->m->materials[r->m->sections[p->section].material_id].law;
  if (law->ops == NULL) return NAN;
  if (law->ops->linear) return 1.0;
  return strcmp(law->ops->name, "NORTON") == 0 ? law->value[NORTON_N].number
                                               : NAN;
}

/* C(t) by the rates of the increment, of laws linear in the stress as many
 * times its integral as G is. */
static status find_creep(const run *r, crack_state *own) {
  const double dt = r->now.t - r->old.t;
  fracture_state s = {own->rate, own->sigma, own->traction,
                      NAN,       own->force, own->point};
  for (EACH(tip, t, own->tips, own->n)) t->creep = t->creep_scatter = NAN;
  if (!own->flows || r->step->kind != STEP_VISCO || !(dt > 0.0)) return OK;
  OWNED_NEW(fracture_factors, found, own->n);
  for (size_t k = 0; k < r->n_dof; ++k)
    own->rate[k] = (r->now.u[k] - r->old.u[k]) / dt;
  for (int i = 0; i < own->n; ++i) {
    const double n = exponent_of(r, &own->points[i]), share = n / (n + 1.0);
    if (isnan(n)) continue;
    if (s.share != share) {
      s.share = share;
      fracture_find(own->of, &s, found);
    }
    const double times = n > 1.0 ? 1.0 : own->times[i];
    own->tips[i].creep = times * found[i].J;
    own->tips[i].creep_scatter = times * found[i].J_scatter;
  }
  return OK;
}

/* Where the stresses are not those of u, as in creep that is no multiple of the
 * elastic strain, or by heat that varies, u becomes NAN: there is no K. Within
 * "near" they are: Poisson's ratio may change in plane strain. */
static status check_elastic(const run *r, const crack_state *own, double *u) {
  static const double near = 0.02;
  const size_t ns = r->m->ns, n = ns * r->msh->n_elem;
  domain d = r->body.d;
  double most = 0.0, largest = 0.0;
  OWNED_NEW(double, sigma, n);
  d.eigen = NULL;
  domain_stress(&d, u, NULL, sigma);
  for (size_t k = 0; k < n; ++k) {
    if (ns != 6 && k % ns == 2) continue; /* of a plane body in its plane */
    most = fmax(most, fabs(sigma[k] - own->sigma[k]));
    largest = fmax(largest, fabs(own->sigma[k]));
  }
  if (most > near * largest)
    for (size_t k = 0; k < r->n_dof; ++k) u[k] = NAN;
  return OK;
}

static fracture_state state_of(const run *r, const crack_state *own) {
  return (fracture_state){own->flows ? own->elastic : r->now.u,
                          own->sigma,
                          own->traction,
                          0.5,
                          own->force,
                          own->point};
}

/* Of an isotropic body the factors give the energy release rate. Its integral,
 * of squares of the stresses, falls short by the squares of their errors too,
 * as much again in space. Returns how many times larger the rate is, 1 where
 * there are no factors. */
static double rate_of(const fracture_material *x, fracture_factors *f) {
  const double plane = (x->plane_stress ? 1.0 : 1.0 - x->nu * x->nu) / x->E;
  const double part[MODES] = {plane, plane, (1.0 + x->nu) / x->E};
  double rate = 0.0, scatter = 0.0;
  for (int k = 0; k < MODES; ++k) {
    rate += part[k] * f->K[k] * f->K[k];
    scatter += 2.0 * part[k] * fabs(f->K[k]) * f->K_scatter[k];
  }
  const double times = rate / f->J;
  if (isnan(rate)) return 1.0;
  f->J = rate;
  f->J_scatter = scatter;
  return times > 0.5 && times < 2.0 ? times : 1.0; /* else: rounding */
}

static void find_rates(const crack_state *own) {
  for (int k = 0; k < own->n; ++k) {
    const int id = own->points[k].section;
    const fracture_material *x = id < 0 ? NULL : &own->materials[id];
    own->times[k] = x != NULL && x->E > 0.0 ? rate_of(x, &own->found[k]) : 1.0;
  }
}

/* Internal forces less loads and contact forces, of what supports hold; those
 * of tied nodes act on their masters. In own->held. */
static void find_held(const run *r, const crack_state *own) {
  domain_internal_force(&r->body.d, own->sigma, own->held);
  for (size_t k = 0; k < r->n_dof; ++k) own->held[k] -= r->now.F[k];
  if (r->nodes.n > 0) surface_spread(r->surface, -1.0, r->now.rc, own->held);
  ties_share(&r->body.ties, own->held);
  for (size_t k = 0; k < r->n_dof; ++k)
    if (!r->body.fixed[k]) own->held[k] = 0.0;
}

/* Loads own->traction that are on no lip, *CLOAD and what supports hold become
 * own->point. */
static status find_points(const run *r, const crack_state *own) {
  const mesh *m = r->msh;
  const int dim = m->dim;
  PASS(load_points(r->m, m, r->step, r->now.t, own->point));
  for (size_t k = 0; k < r->n_dof; ++k) own->traction[k] -= own->point[k];
  for (int i = 0; i < m->n_crack; ++i) {
    const mesh_crack *c = &m->crack[i];
    for (int k = 0; k < c->front_start[c->n_front]; ++k)
      CLEAR(own->traction + dim * c->front_node[k], dim);
  }
  find_held(r, own);
  for (int i = 0; i < (dim + 1) * m->n_elem; ++i)
    own->lumped[m->elem[i]] = model_thickness(r->m, i / (dim + 1));
  for (size_t k = 0; k < r->n_dof; ++k) {
    own->point[k] += own->held[k];
    if (!(own->area[k / dim] > 0.0)) own->point[k] += own->traction[k];
    own->point[k] /= own->lumped[k / dim];
  }
  return OK;
}

/* own->found of r->now, once an increment. */
static status find_all(run *r, crack_state *own) {
  const int step_id = run_step_id(r);
  if (own->step_id == step_id && !(own->t < r->now.t)) return OK;
  domain_stress(&r->body.d, r->now.u, NULL, own->sigma);
  /* Of contact forces and loads at the lips. */
  COPY(own->traction, r->now.F, r->n_dof);
  if (own->force != NULL) {
    PASS(load_body(r->m, r->msh, r->step, r->now.t, own->lumped, own->force));
    for (size_t k = 0; k < r->n_dof; ++k) own->traction[k] -= own->lumped[k];
  }
  PASS(find_points(r, own));
  if (r->nodes.n > 0) surface_spread(r->surface, 1.0, r->now.rc, own->traction);
  over_areas(r, own, own->traction);
  shift_all(r, own, 0, own->traction);
  if (own->flows) PASS(find_elastic(r, own->elastic));
  if (own->flows) PASS(check_elastic(r, own, own->elastic));
  const fracture_state s = state_of(r, own);
  fracture_find(own->of, &s, own->found);
  find_rates(own);
  own->step_id = step_id;
  own->t = r->now.t;
  return OK;
}

static int first_point(const run *r, int crack_id) {
  int first = 0;
  for (int i = 0; i < crack_id; ++i) first += front_size(r, i);
  return first;
}

status cracks_factors(run *r, int crack_id, crack_factors *out) {
  crack_state *own = effect_state(&r->effects, &cracks_effect);
  const int first = first_point(r, crack_id);
  PASS(find_all(r, own));
  *out = (crack_factors){front_size(r, crack_id), own->points + first,
                         own->found + first, !own->flows};
  return OK;
}

status cracks_derive(const run *r, int crack_id, int point, int mode,
                     fracture_linear *out) {
  const crack_state *own = effect_state(&r->effects, &cracks_effect);
  const fracture_state s = state_of(r, own);
  return fracture_derive(own->of, &s, first_point(r, crack_id) + point, mode,
                         out);
}

static status find_factors(run *r, void *self) {
  crack_state *own = self;
  PASS(find_all(r, own));
  for (int i = 0; i < own->n; ++i) {
    own->tips[i].found = own->found[i];
    find_jumps(r, own, &own->points[i], &own->tips[i]);
  }
  return find_creep(r, own);
}

static int requires_factors(const model *m, const reason *why) {
  for (int i = 0; i < m->n.goal; ++i)
    if (m->accuracy.goals[i].quantity == GOAL_SIF)
      return plan_at(why, &m->accuracy.goals[i].at, "*GOAL, QUANTITY=SIF");
  return plan_requires_table(m, PRINT_SIF, why);
}

static effect_work expected(const plan_sizes *s) {
  const double shown = plan_shown(s->m, PRINT_SIF);
  return (effect_work){s->elements, "elements", shown,
                       shown * s->elements * plan_element_work(s)};
}

static int factors_due(const run *r) { return table_is_due_now(r, PRINT_SIF); }

static const tip *tip_of(const view *v, int id) {
  const crack_state *own = effect_state(v->s->effects, &cracks_effect);
  return &own->tips[id];
}

static const fracture_point *point_of(const view *v, int id) {
  const crack_state *own = effect_state(v->s->effects, &cracks_effect);
  return &own->points[id];
}

static double tip_rate(const view *v, int id, int part) {
  const fracture_factors *f = &tip_of(v, id)->found;
  return part == 0 ? f->J : f->J_scatter;
}

#include "run/column_row.h"

VALUE(crack_no, point_of(v, id)->crack + 1)
VALUE(tip_node, v->msh->node_no[point_of(v, id)->node])
VALUE(tip_x, point_of(v, id)->origin[part])
VALUE(tip_K, tip_of(v, id)->found.K[part])
VALUE(tip_scatter, tip_of(v, id)->found.K_scatter[part])
VALUE(tip_jump, tip_of(v, id)->jump[part])
VALUE(tip_creep, tip_of(v, id)->creep)
VALUE(tip_creep_scatter, tip_of(v, id)->creep_scatter)
VALUE(tip_radius, point_of(v, id)->radius)

WORD_OF(crack_word, v->m->mesh.cracks[point_of(v, id)->crack].name)
/* clang-format off */
#define TIP PER_TIP, AS_REAL, PRINT_SIF, 0
#define STRESS_ROOT "force/length^1.5"
static const char scatter_help[] = "half of what the domains differ by: no "
                                   "bound of its error";
static const char jump_help[] = "from the jump of the lips behind the tip, a "
                                "check; NaN: fewer than two nodes between two "
                                "elements and half the radius from it";
static const column columns[] = {
{"crack", "-", PER_TIP, AS_WORD, PRINT_SIF, 0, SCENE_ALL, 0, NULL, 0, crack_no,
 crack_word, "name of the *CRACK"},
{"node_no", "-", PER_TIP, AS_COUNT, PRINT_SIF, 0, SCENE_ALL, 0, NULL, 0,
 tip_node, NULL, "node of the tip, in space of the front"},
{"x", "length", TIP, CART, 0, NULL, 0, tip_x, NULL, "its coordinate"},
{"y", "length", TIP, CART, 0, NULL, 1, tip_x, NULL, "its coordinate"},
{"z", "length", TIP, SCENE_SOLID, 0, NULL, 2, tip_x, NULL, "its coordinate"},
{"K_I", STRESS_ROOT, TIP, CART, 0, NULL, 0, tip_K, NULL,
 "stress intensity factor, opening"},
{"K_II", STRESS_ROOT, TIP, CART, 0, NULL, 1, tip_K, NULL,
 "the same, sliding; > 0: the plus lip (that of the group GROUP+) moves ahead, "
 "so that under one shear both ends of a crack differ in sign"},
{"K_III", STRESS_ROOT, TIP, SCENE_SOLID, 0, NULL, 2, tip_K, NULL,
 "the same, tearing; > 0: the plus lip moves along the growth times the normal "
 "from the minus lip to it"},
{"G", "force/length", TIP, CART, 0, NULL, 0, tip_rate, NULL,
 "energy release rate"},
{"K_I_scatter", STRESS_ROOT, TIP, CART, 0, NULL, 0, tip_scatter, NULL,
 scatter_help},
{"K_II_scatter", STRESS_ROOT, TIP, CART, 0, NULL, 1, tip_scatter, NULL,
 scatter_help},
{"K_III_scatter", STRESS_ROOT, TIP, SCENE_SOLID, 0, NULL, 2, tip_scatter, NULL,
 scatter_help},
{"G_scatter", "force/length", TIP, CART, 0, NULL, 1, tip_rate, NULL,
 scatter_help},
{"C_t", "force/length/time", PER_TIP, AS_REAL, PRINT_SIF, ON(INELASTIC), CART,
 0, NULL, 0, tip_creep, NULL, "C(t), the integral of G with the rates of the "
 "increment: in *VISCO steps, of laws linear in the stress and of NORTON"},
{"C_t_scatter", "force/length/time", PER_TIP, AS_REAL, PRINT_SIF,
 ON(INELASTIC), CART, 0, NULL, 0, tip_creep_scatter, NULL, scatter_help},
{"K_I_jump", STRESS_ROOT, TIP, SCENE_PLANE, 0, NULL, 0, tip_jump, NULL,
 jump_help},
{"K_II_jump", STRESS_ROOT, TIP, SCENE_PLANE, 0, NULL, 1, tip_jump, NULL,
 jump_help},
{"radius", "length", TIP, CART, 0, NULL, 0, tip_radius, NULL,
 "of the largest domain"}};

const effect_ops cracks_effect = {
  .name = "stress intensity factors", .bit = NO_BIT,
  .required = requires_factors, .expected = expected,
  .table = {PRINT_SIF, PER_TIP}, .size = sizeof(crack_state),
  .items = offsetof(crack_state, n), .copy_as = COPY_IS_NEW,
  .on = {.create = cracks_new, .due = factors_due, .accept = find_factors},
  COLUMNS_OF(columns)};
/* clang-format on */
