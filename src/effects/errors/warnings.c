/*
 * Warnings about a solution of the equations that may be meaningless: strains
 * or rotations that are not small, elements turned inside out by the
 * displacements, bodies that slip farther than the faces where they touch are
 * long, past another body or along an obstacle that is not straight, bodies
 * pressed on another one beyond its end, a contact that no node ever touched.
 * Each is reported once a run.
 */
#include "effects/plan/effect.h"
#include "run/history/loop.h"

typedef struct warnings {
  int strain, rotation, folded; /* 1: told */
  double gain;                  /* 1/m, of a deformation; 0: not known */
  int *touched;                 /* [n_contact] bits */
  double *least; /* [n_contact] m, gap now, if none has touched */
  double *edge;  /* [n_contact] m, longest of its faces; 0: forces are given */
} warnings;

/* Of warnings.touched: a node has touched; slip, friction of an open node, a
 * resultant beyond the master is told. */
enum { TOUCHED = 1, SLIP_TOLD = 2, OPEN_TOLD = 4, BEYOND_TOLD = 8 };

static const double LARGE = 0.05; /* -, strain, change of a gap */
static const double FAR = 0.1;    /* rad, rotation */
static const double CLOSE = 1e-3; /* -, of a face: not told to be beyond */

static const char *section_of(const run *r, int elem_id) {
  return r->m->sections[r->m->elem_section[elem_id]].elset;
}

/* Told once: "the strain of", an element, what it is. */
static void tell_element(run *r, int *told, message_id id, const char *what,
                         int elem_id, const char *is) {
  *told = 1;
  message_add(r->m->log, id, &r->step->at,
              "step %d, increment %d, time %g: the %s element %zu (group %s) "
              "%s",
              run_step_id(r) + 1, r->at.increment_no, r->now.t, what,
              r->msh->elem_no[elem_id], section_of(r, elem_id), is);
}

/* 1: nothing is to be told of the elements, or too small. */
static int is_slight(const run *r, const warnings *reported) {
  if (reported->strain && reported->folded) return 1;
  return reported->gain > 0.0 &&
         reported->gain * domain_spread(&r->body.d, r->now.u) <
             (reported->strain ? 1.0 : LARGE);
}

static void warn_deformation(run *r, warnings *reported) {
  deformation x;
  char is[80];
  if (is_slight(r, reported)) return;
  domain_deformation(&r->body.d, r->now.u, &x);
  reported->gain = x.gain;
  if (!reported->strain && x.strain > LARGE) {
    snprintf(is, sizeof is, "is %.3g %%; strains are taken as small",
             100.0 * x.strain);
    tell_element(r, &reported->strain, P4019, "strain of", x.strain_elem, is);
  }
  if (!reported->strain && !reported->rotation && x.rotation > FAR) {
    snprintf(is, sizeof is, "is %.3g rad; rotations are taken as small",
             x.rotation);
    tell_element(r, &reported->rotation, P4039, "rotation of", x.rotation_elem,
                 is);
  }
  if (!reported->folded && x.volume <= 0.0)
    tell_element(r, &reported->folded, P4020, "displacements turn",
                 x.volume_elem, "inside out");
}

/* Which contacts touch; the listing reports the first contact. */
static void note_touches(run *r, warnings *reported) {
  for (int i = 0; i < r->m->n.contact; ++i) {
    const contact_total *t = &r->result.totals[i];
    if ((reported->touched[i] & TOUCHED) || t->n_slip + t->n_stick == 0)
      continue;
    reported->touched[i] |= TOUCHED;
    if (r->course.total_no > 1)
      RUN_NOTE(r, "  contact %s touches for the first time\n",
               r->m->contacts[i].name);
  }
}

static double longest_edge(const mesh *m, const mesh_group *g) {
  double longest = 0.0;
  for (int k = 0; k < g->n_item; ++k) {
    const int *v = m->face + (size_t)m->dim * g->item_id[k];
    for (int a = 0; a < m->dim; ++a) {
      const double *x = mesh_node_x(m, v[a]),
                   *y = mesh_node_x(m, v[(a + 1) % m->dim]);
      double square = 0.0;
      for (int c = 0; c < m->dim; ++c) square = hypot(square, x[c] - y[c]);
      longest = fmax(longest, square);
    }
  }
  return longest;
}

/* Largest less least gap of the pressed nodes of a contact, m. */
static double gaps_apart(const run *r, int contact_id) {
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (int i = 0; i < r->nodes.n; ++i) {
    if (r->surface->contact_id[i] != contact_id ||
        !(r->now.rc[r->msh->dim * i] < 0.0))
      continue;
    least = fmin(least, r->problem.gap[i]);
    most = fmax(most, r->problem.gap[i]);
  }
  return most - least;
}

/* 1: where node i has slipped to, its gap to the obstacle is another. */
static int leaves_gap(const run *r, int i, double slip) {
  const int dim = r->msh->dim, id = r->surface->contact_id[i];
  const obstacle *o = r->faces.pairs[id].support;
  const double *u = r->now.u + dim * r->surface->node_id[i],
               *n = r->surface->frame + dim * dim * i,
               *x = r->surface->x + dim * i;
  const double along = dot(dim, n, u);
  double to[3] = {0.0};
  for (int c = 0; c < dim; ++c) to[c] = x[c] + u[c] - along * n[c];
  const double change = obstacle_gap(o, dim, to, n, r->now.t) -
                        obstacle_gap(o, dim, x, n, r->now.t);
  return fabs(change) > rounding_of_gaps(r) + 16 * DBL_EPSILON * slip &&
         fabs(change) > LARGE * gaps_apart(r, id);
}

/* Contact node i, pressed after it has moved by u[dim] against its partners
 * since they were found. */
static void warn_slip(run *r, int i, const double *u, warnings *reported) {
  const int dim = r->msh->dim, id = r->surface->contact_id[i];
  const contact *c = &r->m->contacts[id];
  const double slip = dim == 3 ? hypot(u[1], u[2]) : fabs(u[1]);
  if ((reported->touched[id] & SLIP_TOLD) || !(reported->edge[id] > 0.0) ||
      !(r->now.rc[dim * i] < 0.0) || slip <= reported->edge[id] ||
      (!c->is_pair && !leaves_gap(r, i, slip)))
    return;
  message_add(r->m->log, P4038, &c->at,
              "step %d, increment %d, time %g: %s %s: node %zu has slipped by "
              "%.3g, faces are up to %.3g long: it is still pressed on what it "
              "met at %s",
              run_step_id(r) + 1, r->at.increment_no, r->now.t, contact_card(c),
              c->name, r->surface->node_no[i], slip, reported->edge[id],
              c->update ? "the start of the step" : "time 0");
  reported->touched[id] |= SLIP_TOLD;
}

/* Slip since time 0, of UPDATE=STEP since the start of the step. */
static status look_at_slip(run *r, warnings *reported) {
  const double *from = r->faces.input.u;
  OWNED double *moved = NULL, *since = NULL;
  if (from != NULL) {
    PASS_NEW_ALL(OF(moved, r->n_dof), OF(since, r->nodes.n_c));
    for (size_t k = 0; k < r->n_dof; ++k) moved[k] = r->now.u[k] - from[k];
    surface_relative(r->surface, moved, since);
  }
  for (int i = 0; i < r->nodes.n; ++i) {
    const int updated =
        from != NULL && r->m->contacts[r->surface->contact_id[i]].update;
    warn_slip(r, i, (updated ? since : r->now.uc) + r->msh->dim * i, reported);
  }
  return OK;
}

/* The least gap left of a contact, m; HUGE_VAL: no node has one. */
static double least_gap(const run *r, int contact_id) {
  double least = HUGE_VAL;
  for (int i = 0; i < r->nodes.n; ++i)
    if (r->surface->contact_id[i] == contact_id &&
        surface_meets(r->surface, r->faces.pairs, i, r->now.t))
      least = fmin(least, r->result.open_gap[i]);
  return least;
}

/* A given limit of friction, and a gap. */
static void warn_open(run *r, warnings *reported) {
  const friction_limit *limit = r->problem.limit;
  for (int i = 0; i < r->nodes.n && limit != NULL; ++i) {
    const int id = r->surface->contact_id[i];
    const contact *c = &r->m->contacts[id];
    if ((reported->touched[id] & OPEN_TOLD) || c->force.given ||
        !(limit->g0[i] > 0.0) || r->result.contact[i] != CONTACT_OPEN ||
        !(r->result.open_gap[i] > rounding_of_gaps(r)))
      continue;
    reported->touched[id] |= OPEN_TOLD;
    message_add(r->m->log, P4041, &c->at,
                "step %d, increment %d, time %g: %s %s: node %zu is open by "
                "%.3g and has friction: its limit is given",
                run_step_id(r) + 1, r->at.increment_no, r->now.t,
                contact_card(c), c->name, r->surface->node_no[i],
                r->result.open_gap[i]);
  }
}

/* Where the resultant of the pressures of a pair acts on the master, m, of
 * UPDATE=STEP at the start of the step, since[n_c] the motion relative to the
 * master till then; 0: none does. */
static int find_middle(const run *r, int id, const double *since, double *x) {
  const int dim = r->msh->dim;
  const contact_surface *s = r->surface;
  const double *from = since == NULL ? NULL : r->faces.input.u;
  double force = 0.0;
  for (int i = 0; i < s->n; ++i) {
    const double f = -r->now.rc[dim * i];
    if (s->contact_id[i] != id || !(f > 0.0)) continue;
    const double gap = s->gap0[i] - (from != NULL ? since[dim * i] : 0.0);
    for (int c = 0; c < dim; ++c)
      x[c] += f * (s->x[dim * i + c] + gap * s->frame[dim * dim * i + c] +
                   (from != NULL ? from[dim * s->node_id[i] + c] : 0.0));
    force += f;
  }
  for (int c = 0; c < dim; ++c) x[c] /= force;
  return force > 0.0;
}

/* From node k of a group, moved by u[n_dof] if that is not NULL, to x. */
static void from_node(const mesh *m, const mesh_group *g, const double *u,
                      int k, const double *x, double *v) {
  vector_of(m->dim, mesh_node_x(m, g->node_id[k]), x, v);
  if (u != NULL) add_scaled(m->dim, -1.0, u + m->dim * g->node_id[k], v);
}

/* v = x less the nearest point of the convex hull of the nodes of a group
 * (Gilbert, SIAM J. Control 4 (1966)); how far they are apart along v, m, where
 * that is not less than "close". */
static double beyond_hull(const mesh *m, const mesh_group *g, const double *u,
                          const double *x, double close, double *v) {
  enum { STEPS = 100 };
  const int dim = m->dim;
  double apart = 0.0;
  from_node(m, g, u, 0, x, v);
  for (int turn = 0; turn < STEPS && dot(dim, v, v) > close * close; ++turn) {
    double least = HUGE_VAL, p[3], to[3], near[3] = {0.0};
    for (int k = 0; k < g->n_node; ++k) {
      from_node(m, g, u, k, x, p);
      if (dot(dim, v, p) >= least) continue;
      least = dot(dim, v, p);
      COPY(near, p, dim);
    }
    apart = least / sqrt(dot(dim, v, v));
    vector_of(dim, v, near, to);
    const double square = dot(dim, to, to);
    if (!(square > 0.0)) break;
    add_scaled(dim, fmin(1.0, -dot(dim, v, to) / square), to, v);
  }
  return apart;
}

/* 1: the direction v is along the surface at all nodes with pressure. */
static int is_along(const run *r, int id, const double *v) {
  static const double leans = 0.1; /* -, sine */
  const int dim = r->msh->dim;
  const double most = leans * sqrt(dot(dim, v, v));
  int along = 1;
  for (int i = 0; i < r->nodes.n; ++i)
    if (r->surface->contact_id[i] == id && r->now.rc[dim * i] < 0.0)
      along &= fabs(dot(dim, v, r->surface->frame + dim * dim * i)) <= most;
  return along;
}

/* 1: no node of a pair is in another one, whose master may bear it too. */
static int is_alone(const run *r, int id) {
  const mesh_group *own = r->faces.pairs[id].group;
  for (int p = 0; p < r->m->n.contact; ++p) {
    const mesh_group *g = r->faces.pairs[p].group;
    for (int k = 0; k < own->n_node && p != id; ++k)
      if (number_find(own->node_id[k], g->node_id, g->n_node) >= 0) return 0;
  }
  return 1;
}

/* Pressures at nodes beyond the end of the master, whose faces it covers in
 * part, hold a body that has tipped over its end. */
static void warn_beyond(run *r, int id, const double *since,
                        warnings *reported) {
  const contact *c = &r->m->contacts[id];
  double x[3] = {0.0}, v[3];
  if (!c->is_pair || c->is_crack || (reported->touched[id] & BEYOND_TOLD) ||
      !find_middle(r, id, c->update ? since : NULL, x))
    return;
  const mesh_group *g = &r->msh->group[c->pair.master_id];
  const double close = CLOSE * reported->edge[id],
               far = beyond_hull(
                   r->msh, g,
                   c->update && since != NULL ? r->faces.input.u : NULL, x,
                   close, v);
  if (!(far > close) || !is_along(r, id, v) || !is_alone(r, id)) return;
  reported->touched[id] |= BEYOND_TOLD;
  message_add(r->m->log, P4042, &c->at,
              "step %d, increment %d, time %g: %s %s: the resultant of the "
              "pressures acts %.3g beyond the end of the master %s, where no "
              "pressure can act",
              run_step_id(r) + 1, r->at.increment_no, r->now.t, contact_card(c),
              c->name, far, g->name);
}

static status look_beyond(run *r, warnings *reported) {
  const double *from = r->faces.input.u;
  OWNED double *since = NULL;
  if (from != NULL) PASS_NEW(since, r->nodes.n_c);
  if (from != NULL) surface_relative(r->surface, from, since);
  for (int i = 0; i < r->m->n.contact; ++i) warn_beyond(r, i, since, reported);
  return OK;
}

static status look(run *r, void *self) {
  warnings *own = self;
  note_touches(r, own);
  for (int i = 0; i < r->m->n.contact; ++i)
    if (!(own->touched[i] & TOUCHED)) own->least[i] = least_gap(r, i);
  if (r->solving.report.outcome <= 0) return OK;
  warn_deformation(r, own);
  warn_open(r, own);
  PASS(look_beyond(r, own));
  return look_at_slip(r, own);
}

/* Where an increment is not solved, what touched in it is not known. */
static void end(run *r, void *self) {
  const warnings *reported = self;
  for (int i = 0; i < r->m->n.contact && r->course.unsettled == 0; ++i) {
    const contact *c = &r->m->contacts[i];
    if ((reported->touched[i] & TOUCHED) || c->force.given || c->is_crack)
      continue;
    char gap[80] = "at its end no normal of a node meets it";
    if (reported->least[i] < HUGE_VAL)
      snprintf(gap, sizeof gap, "the least gap at its end is %.3g",
               reported->least[i]);
    message_add(r->m->log, P4021, &c->at,
                "%s %s: no node touched %s %s in the run; %s", contact_card(c),
                c->name, c->is_pair ? "surface" : "obstacle", c->obstacle_name,
                gap);
  }
}

static status warnings_new(run *r, void **self) {
  warnings *own = *self;
  PASS_NEW_ALL(OF(own->touched, r->m->n.contact),
               OF(own->least, r->m->n.contact), OF(own->edge, r->m->n.contact));
  for (int i = 0; i < r->m->n.contact; ++i) {
    const contact *c = &r->m->contacts[i];
    const mesh_group *g = r->msh->group;
    if (c->force.given) continue;
    own->edge[i] = longest_edge(r->msh, &g[c->group_id]);
    if (c->is_pair)
      own->edge[i] =
          fmax(own->edge[i], longest_edge(r->msh, &g[c->pair.master_id]));
  }
  return OK;
}

static status keep(run *r, void *self, archive *a) {
  warnings *own = self;
  PASS(archive_ints(a, "told_strain", &own->strain, 1));
  PASS(archive_ints(a, "told_rotation", &own->rotation, 1));
  PASS(archive_ints(a, "told_folded", &own->folded, 1));
  PASS(archive_ints(a, "touched", own->touched, r->m->n.contact));
  return archive_reals(a, "least_gap", own->least, r->m->n.contact);
}

static int requires_warnings(const model *m, const reason *why) {
  return !m->problem.given;
}

/* clang-format off */
const effect_ops warnings_effect = {
  .name = "warnings", .bit = NO_BIT, .required = requires_warnings,
  .own = STAGE_NONE, .size = sizeof(warnings),
  .on = {.create = warnings_new, .accept = look, .end = end, .keep = keep}};
/* clang-format on */
