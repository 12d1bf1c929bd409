/* Pairs of two surfaces of the mesh in a contact surface: what their nodes are
 * relative to. */
#include "base/base.h"
#include "contact/parts.h"

/* ---- couplings ---------------------------------------------------------- */

/* Slave nodes left out: by supports, by an earlier pair. */
enum { HELD = 1, TAKEN };
/* Of places over the size of the mesh; of forces over the first of a chain. */
static const double rounding = 1e-9;

int surface_tied(const surface_input *in, int node_id) {
  const tie_set *t = in->ties;
  return t == NULL ? -1 : number_find(node_id, t->node_id, t->n);
}

/* Bit c: supports hold component c; of a tied node none. */
static unsigned held_bits(const surface_input *in, int node_id) {
  return surface_tied(in, node_id) < 0 ? in->fixed[node_id] : 0u;
}

/* 1: the pair is coupled where the bodies are now. */
static int is_moved(const surface_input *in, const contact_pair *p) {
  return p->update && in->u != NULL;
}

/* 1: supports hold node q of the coupling along its normal. */
static int is_held(const surface_input *in, const mortar *m, int q) {
  const int dim = in->mesh->dim;
  double n[3];
  COPY(n, m->normal + (size_t)dim * q, dim);
  return !(frame_project(dim, in->fixed[m->node_id[q]], n) > PAIR_FIXED_SINE);
}

int pair_same_normal(int dim, const contact_pair *a, int q,
                     const contact_pair *b, int r) {
  const double *m = a->coupled->normal + dim * q;
  const double *n = b->coupled->normal + dim * r;
  double frame[9];
  unsigned char held[3] = {0};
  if (a->group == b->group && frame_is_smooth(dim, m, n)) return 1;
  COPY(frame, m, dim);
  COPY(frame + dim, n, dim);
  return frame_complete(dim, 2, 0, frame, held) < 0;
}

/* 1: an earlier pair has node q with (nearly) the same normal. */
static int is_taken(const surface_input *in, int pair_id, int q) {
  const contact_pair *now = &in->pairs[pair_id];
  for (const contact_pair *p = in->pairs; p < now; ++p) {
    const mortar *old = p->coupled;
    if (old == NULL) continue;
    const int at = number_find(now->coupled->node_id[q], old->node_id, old->n);
    if (at >= 0 && pair_same_normal(in->mesh->dim, p, at, now, q)) return 1;
  }
  return 0;
}

/* 1: CLEARANCE or INTERFERENCE of two pairs are one, or none. */
static int same_change(const contact_pair *a, const contact_pair *b) {
  if (a->change == NULL || b->change == NULL) return a->change == b->change;
  return a->change->formula == NULL && b->change->formula == NULL &&
         a->change->factor == b->change->factor &&
         a->change_sign * a->change->number ==
             b->change_sign * b->change->number;
}

/* 1: nodes of two surfaces coincide: no step is between them. */
static int surfaces_meet(const mesh *m, const mesh_group *a,
                         const mesh_group *b) {
  const size_t dim = m->dim;
  for (int i = 0; i < a->n_node; ++i)
    for (int k = 0; k < b->n_node; ++k) {
      const double *x = m->x + dim * a->node_id[i];
      const double *y = m->x + dim * b->node_id[k];
      double far = 0.0;
      for (size_t c = 0; c < dim; ++c) far = fmax(far, fabs(x[c] - y[c]));
      if (far <= rounding * m->size) return 1;
    }
  return 0;
}

/* 1: an earlier pair with the same slave may share nodes with this one. */
static int has_other_master(const surface_input *in, int pair_id) {
  const contact_pair *now = &in->pairs[pair_id];
  int any = 0;
  for (const contact_pair *p = in->pairs; p < now && !any; ++p)
    any = p->coupled != NULL && p->group == now->group && same_change(p, now) &&
          surfaces_meet(in->mesh, p->master, now->master);
  return any;
}

/* Where two masters meet within a face of the slave its nodes act on both: the
 * nodes of such faces that an earlier pair has are shared; how many are new. */
static int share_nodes(const surface_input *in, int pair_id,
                       unsigned char *dropped, unsigned char *shared) {
  const mesh *m = in->mesh;
  const mortar *now = in->pairs[pair_id].coupled;
  int more = 0;
  if (now->n_cut == 0 || !has_other_master(in, pair_id)) return 0;
  for (int k = 0; k < now->n_cut; ++k)
    for (int c = 0; c < m->dim; ++c) {
      const int node = m->face[m->dim * now->cut[k] + c];
      if (dropped[node] != TAKEN) continue;
      dropped[node] = 0;
      shared[node] = 1;
      ++more;
    }
  return more;
}

status surfaces_couple(const surface_input *in, const double *x,
                       const mesh_group *slave, const mesh_group *master,
                       unsigned how, const unsigned char *dropped,
                       mortar **out) {
  OWNED_NEW(unsigned char, mirrored, in->mesh->n_node);
  const mortar_input of = {.mesh = in->mesh,
                           .n_slave = slave->n_item,
                           .n_master = master->n_item,
                           .slave = slave->item_id,
                           .master = master->item_id,
                           .x = x,
                           .face_weight = in->face_weight,
                           .axisymmetric = in->axisymmetric,
                           .slave_normal = (how & COUPLE_SLAVE_NORMAL) != 0,
                           .flat = (how & COUPLE_FLAT) != 0,
                           .dropped = dropped,
                           .mirrored = mirrored};
  if (!of.flat) mirrors_mark(in, mirrored);
  FORGET(*out);
  return mortar_couple(&of, out);
}

/* Couple without nodes that cannot carry a multiplier, until all can. */
static status couple_kept(const surface_input *in, int pair_id, int *n_held,
                          int *n_shared) {
  contact_pair *p = &in->pairs[pair_id];
  const size_t n = (size_t)in->mesh->dim * in->mesh->n_node;
  OWNED unsigned char *dropped = NULL, *shared = NULL;
  int more = 1;
  OWNED_NEW(double, x, n);
  for (size_t k = 0; k < n; ++k)
    x[k] = in->mesh->x[k] + (is_moved(in, p) ? in->u[k] : 0.0);
  PASS_NEW_ALL(OF(dropped, in->mesh->n_node), OF(shared, in->mesh->n_node));
  *n_held = *n_shared = 0;
  while (more > 0) {
    more = 0;
    PASS(surfaces_couple(in, x, p->group, p->master, p->how, dropped,
                         &p->coupled));
    for (int q = 0; q < p->coupled->n; ++q) {
      const int node = p->coupled->node_id[q];
      const int held = is_held(in, p->coupled, q);
      if (!held && (shared[node] || !is_taken(in, pair_id, q))) continue;
      dropped[node] = held ? HELD : TAKEN;
      *n_held += held;
      ++more;
    }
    if (more == 0)
      *n_shared += more = share_nodes(in, pair_id, dropped, shared);
  }
  return OK;
}

/* 1: the normals of the slave differ. */
static int is_curved(int dim, const mortar *m) {
  for (int q = 1; q < m->n; ++q)
    for (int c = 0; c < dim; ++c)
      if (fabs(m->normal[dim * q + c] - m->normal[c]) > PAIR_FIXED_SINE)
        return 1;
  return 0;
}

/* 1: a support holds a component of slave node q that it holds of none of its
 * masters. */
static int is_held_alone(const surface_input *in, const mortar *m, int q) {
  unsigned masters = 0;
  for (size_t e = m->to.start[q]; e < m->to.start[q + 1]; ++e)
    masters |= held_bits(in, m->to.master[e]);
  return (held_bits(in, m->node_id[q]) & ~masters) != 0;
}

int surfaces_held_alone(const surface_input *in, const mortar *m) {
  int n = 0;
  for (int q = 0; q < m->n; ++q) n += is_held_alone(in, m, q);
  return n;
}

/* Faces of the slave all of whose nodes are tied. */
static int tied_faces(const surface_input *in, const contact_pair *p) {
  const int dim = in->mesh->dim;
  int n = 0;
  for (int k = 0; k < p->group->n_item; ++k) {
    const int *node = &in->mesh->face[dim * p->group->item_id[k]];
    int tied = 0;
    for (int c = 0; c < dim; ++c) tied += surface_tied(in, node[c]) >= 0;
    n += tied == dim;
  }
  return n;
}

static void tell(const surface_input *in, const contact_pair *p, int n_held,
                 message_log *log) {
  enum { CURVED = 2, FLAT = 4 };
  const mortar *m = p->coupled;
  const int alone = surfaces_held_alone(in, m), tied = tied_faces(in, p);
  if (n_held > 0)
    message_add(log, P4002, &p->at,
                "%s %s: nodes of group %s are also fixed in the "
                "normal direction, or tied, and left out of contact: %d",
                p->card, p->name, p->group->name, n_held);
  if (2 * alone > m->n)
    message_add(log, P4031, &p->at,
                "%s %s: supports hold %d of %d nodes of the slave %s along a "
                "direction in which they do not hold the master %s: the motion "
                "of the master along it and friction are left out there; "
                "SLAVE= takes the other surface",
                p->card, p->name, alone, m->n, p->group->name, p->master->name);
  if (tied > 0)
    message_add(
        log, P4033, &p->at,
        "%s %s: %d of %d faces of the slave %s have only tied nodes: no "
        "contact there",
        p->card, p->name, tied, p->group->n_item, p->group->name);
  if (m->n == 0 && m->covered == 0.0)
    message_add(log, P4023, &p->at,
                "%s %s: no face of %s meets a face of %s along its "
                "normal",
                p->card, p->name, p->group->name, p->master->name);
  else if (m->n == 0)
    message_add(log, P4010, &p->at,
                "%s %s: no node of group %s can touch surface %s", p->card,
                p->name, p->group->name, p->master->name);
  if (m->n > 0 && m->size_ratio > (is_curved(in->mesh->dim, m) ? CURVED : FLAT))
    message_add(log, P4024, &p->at,
                "%s %s: the faces of the master %s are %.2g times "
                "those of the slave %s",
                p->card, p->name, p->master->name, m->size_ratio,
                p->group->name);
}

status pairs_couple(const surface_input *in, message_log *log) {
  for (int p = 0; p < in->n_pair; ++p) {
    int n_held = 0, n_shared = 0;
    if (in->pairs[p].support != NULL) continue;
    PASS(couple_kept(in, p, &n_held, &n_shared));
    if (n_shared > 0)
      message_add(
          log, P4034, &in->pairs[p].at,
          "%s %s: the master %s and that of an earlier pair meet within "
          "faces of the slave %s: contact with the mean of both at %d node%s",
          in->pairs[p].card, in->pairs[p].name, in->pairs[p].master->name,
          in->pairs[p].group->name, n_shared, n_shared == 1 ? "" : "s");
    tell(in, &in->pairs[p], n_held, log);
  }
  return message_status(log, ERR_DECK);
}

void pairs_release(const surface_input *in) {
  for (int p = 0; p < in->n_pair; ++p) FORGET(in->pairs[p].coupled);
}

/* ---- rows of the surface ------------------------------------------------ */

/* 1: supports hold all masters of node i, which has one normal, along the axis
 * that component c is, if it is held. */
static int masters_held(const contact_surface *s, const surface_input *in,
                        int i, int c, int m, const pair_row *rows) {
  const int dim = s->dim;
  unsigned all = (1u << dim) - 1, axis = 0;
  for (int e = 0; e < m; ++e) {
    const node_links *l = rows[e].of == NULL ? NULL : &rows[e].of->to;
    if (l == NULL) continue;
    for (size_t k = l->start[rows[e].row]; k < l->start[rows[e].row + 1]; ++k)
      all &= held_bits(in, l->master[k]);
  }
  for (int b = 0; b < dim; ++b)
    if (fabs(s->frame[dim * (dim * i + c) + b]) > 0.5) axis |= 1u << b;
  return (all & axis) == axis;
}

/* Which normal of the node component c is relative to as: -1 none. */
static int source_of(const contact_surface *s, const surface_input *in, int i,
                     int n, int c, int m, const pair_row *rows) {
  if (c < n) return c;
  if (n > 1) return -1;
  return s->held[s->dim * i + c] && !masters_held(s, in, i, c, m, rows) ? -1
                                                                        : 0;
}

/* The place of a master in the row that starts at "first", new if need be. */
static status place_of(node_links *l, int first, int master, pair_links *links,
                       int *at) {
  for (*at = first; *at < links->n; ++*at)
    if (l->master[*at] == master) return OK;
  PASS_GROW(l->master, links->n, links->capacity);
  for (int c = 0; c < l->dim; ++c) {
    PASS_GROW(l->part, links->n_part, links->part_capacity);
    l->part[links->n_part++] = 0.0;
  }
  l->master[links->n++] = master;
  return OK;
}

/* Area of the node of a coupling, less what it carries for neighbours, m2. */
static double own_area(const pair_row *row) {
  return row->of->area[row->row] / row->of->share[row->row];
}

/* Resultant of row c: of its couplings, or of a force at the node. */
static void set_resultant(contact_surface *s, int i, int c, int normal, int m,
                          const pair_row *rows) {
  const int dim = s->dim, k = dim * i + c;
  double area = 0.0, own = 0.0, whole = 0.0, lever[3] = {0.0, 0.0, 0.0};
  for (int e = 0; e < m; ++e) {
    const mortar *of = rows[e].of;
    if (rows[e].normal != normal || of == NULL) continue;
    const int q = rows[e].row;
    area += of->area[q];
    own += own_area(&rows[e]);
    whole = fmax(whole, of->whole[q]);
    add_scaled(dim, of->area[q], of->lever + dim * q, lever);
  }
  s->share[k] = own > 0.0 ? area / own : 1.0;
  if (c == 0) s->covered[i] = whole > 0.0 ? fmin(1.0, area / whole) : 1.0;
  for (int a = 0; a < dim; ++a)
    s->lever[dim * k + a] = area > 0.0 ? lever[a] / area : s->x[dim * i + a];
}

/* Part of a row in those of its normal. */
static double weight_of(const pair_row *row, int m, const pair_row *rows) {
  double sum = 0.0;
  for (int e = 0; e < m; ++e)
    if (rows[e].normal == row->normal) sum += own_area(&rows[e]);
  return own_area(row) / sum;
}

status pair_add_row(contact_surface *s, const surface_input *in, int i, int n,
                    int m, const pair_row *rows, pair_links *links) {
  node_links *l = s->master;
  const int dim = s->dim, first = links->n;
  int source[3];
  for (int c = 0; c < dim; ++c) source[c] = source_of(s, in, i, n, c, m, rows);
  for (int k = 0; k < m; ++k) {
    if (rows[k].of == NULL) continue;
    const node_links *to = &rows[k].of->to;
    const double by = weight_of(&rows[k], m, rows);
    for (size_t e = to->start[rows[k].row]; e < to->start[rows[k].row + 1];
         ++e) {
      int at;
      PASS(place_of(l, first, to->master[e], links, &at));
      for (int c = 0; c < dim; ++c)
        if (source[c] == rows[k].normal)
          l->part[dim * at + c] += by * to->part[dim * e];
    }
  }
  for (int c = 0; c < dim; ++c) set_resultant(s, i, c, source[c], m, rows);
  l->n = i + 1;
  l->start[i + 1] = links->n;
  return OK;
}

/* The gap that was measured at x + u is that of time 0 and what the bodies have
 * moved since, along n. */
double pair_apart(const surface_input *in, const contact_pair *p, int row,
                  const double *n) {
  const mortar *m = p->coupled;
  const size_t dim = in->mesh->dim;
  const int moved = is_moved(in, p);
  double gap = 0.0;
  for (size_t c = 0; c < dim; ++c) {
    double by = moved ? in->u[dim * m->node_id[row] + c] : 0.0;
    for (size_t e = m->to.start[row]; moved && e < m->to.start[row + 1]; ++e)
      by -= m->to.part[dim * e] * in->u[dim * m->to.master[e] + c];
    gap += (m->gap[dim * row + c] + by / m->share[row]) * n[c];
  }
  return gap;
}

/* Gap of the row of a pair with what CLEARANCE or INTERFERENCE adds, m. */
static double pair_gap(const surface_row *at, double t) {
  const contact_pair *p = at->of;
  double x[3] = {0.0, 0.0, 0.0};
  if (p->change == NULL) return at->apart;
  COPY(x, at->x, at->dim);
  return at->apart + p->change_sign * quantity_value(p->change, x, t);
}

/* ---- motions and forces of the rows -------------------------------------- */

void surface_relative(const contact_surface *s, const double *u, double *w) {
  const int dim = s->dim;
  const node_links *l = s->master;
  for (int q = 0; q < s->n; ++q)
    for (int a = 0; a < dim; ++a) {
      const double *row = &s->frame[dim * (dim * q + a)];
      double sum = dot(dim, row, u + (size_t)dim * s->node_id[q]);
      for (size_t e = l == NULL ? 0 : l->start[q];
           l != NULL && e < l->start[q + 1]; ++e)
        sum -= l->part[dim * e + a] *
               dot(dim, row, u + (size_t)dim * l->master[e]);
      w[dim * q + a] = sum / surface_share(s, q, a);
    }
}

void surface_motion(const contact_surface *s, const double *u, int q, int a,
                    double *v) {
  const int dim = s->dim;
  const node_links *l = s->master;
  for (int c = 0; c < dim; ++c) {
    v[c] = u[(size_t)dim * s->node_id[q] + c];
    for (size_t e = l == NULL ? 0 : l->start[q];
         l != NULL && e < l->start[q + 1]; ++e)
      v[c] -= l->part[dim * e + a] * u[(size_t)dim * l->master[e] + c];
    v[c] /= surface_share(s, q, a);
  }
}

void surface_tangent(const contact_surface *s, int q, int a, double *t) {
  double frame[9];
  COPY(frame, s->frame + s->dim * s->dim * q, s->dim * s->dim);
  if (surface_is_corner(s, q)) frame_tangents(s->dim, frame);
  COPY(t, frame + s->dim * a, s->dim);
}

double surface_along(const contact_surface *s, const double *u, const double *w,
                     int q, int a) {
  double v[3], t[3];
  if (!surface_is_corner(s, q)) return w[s->dim * q + a];
  surface_motion(s, u, q, 0, v);
  surface_tangent(s, q, a, t);
  return dot(s->dim, t, v);
}

double surface_prescribed(const contact_surface *s, const unsigned char *fixed,
                          const double *ud, int q, int a) {
  const int dim = s->dim;
  const node_links *l = s->master;
  const double *row = &s->frame[dim * (dim * q + a)];
  const size_t at = (size_t)dim * s->node_id[q];
  double sum = 0.0;
  for (int c = 0; c < dim; ++c)
    if (fixed[at + c]) sum += row[c] * ud[at + c];
  for (size_t e = l == NULL ? 0 : l->start[q]; l != NULL && e < l->start[q + 1];
       ++e)
    sum -=
        l->part[dim * e + a] * dot(dim, row, ud + (size_t)dim * l->master[e]);
  return sum / surface_share(s, q, a);
}

int surface_is_mutual(const contact_surface *s, int q, int a) {
  const node_links *l = s->master;
  if (l == NULL || l->start[q] == l->start[q + 1]) return 1;
  for (size_t e = l->start[q]; e < l->start[q + 1]; ++e)
    if (l->part[s->dim * e + a] != 0.0) return 1;
  return 0;
}

void surface_spread_row(const contact_surface *s, int q, int a, double force,
                        double *F) {
  const int dim = s->dim;
  const node_links *l = s->master;
  const double *row = &s->frame[dim * (dim * q + a)];
  force /= surface_share(s, q, a);
  add_scaled(dim, force, row, F + (size_t)dim * s->node_id[q]);
  for (size_t e = l == NULL ? 0 : l->start[q]; l != NULL && e < l->start[q + 1];
       ++e)
    add_scaled(dim, -force * l->part[dim * e + a], row,
               F + (size_t)dim * l->master[e]);
}

void surface_spread(const contact_surface *s, double factor, const double *r,
                    double *F) {
  for (int k = 0; k < s->dim * s->n; ++k)
    surface_spread_row(s, k / s->dim, k % s->dim, factor * r[k], F);
}

/* r += basis' F; the largest addition. */
static double add_forces(const contact_surface *s, const double *F, double *r) {
  const int dim = s->dim;
  double most = 0;
  for (int q = 0; q < s->n; ++q)
    for (int a = 0; a < dim; ++a) {
      const double more = dot(dim, &s->basis[dim * (dim * q + a)],
                              F + (size_t)dim * s->node_id[q]);
      r[dim * q + a] += more;
      most = fmax(most, fabs(more));
    }
  return most;
}

/* Slave nodes that are masters of other pairs have the forces of those too:
 * each pass finds those of the next pair in a chain. */
status surface_forces(const contact_surface *s, int n_node, const double *F,
                      double *r) {
  enum { LONGEST = 100 };
  const size_t n = (size_t)s->dim * n_node;
  CLEAR(r, s->dim * s->n);
  const double first = add_forces(s, F, r);
  double more = first;
  if (s->master == NULL) return OK;
  OWNED_NEW(double, rest, n);
  for (int k = 0; k < LONGEST && more > rounding * first; ++k) {
    COPY(rest, F, n);
    surface_spread(s, -1, r, rest);
    more = add_forces(s, rest, r);
  }
  return OK;
}

/* ---- gaps and motions over time ---------------------------------------- */

double pair_row_gap(const surface_row *at, double t) {
  if (at->of->support == NULL) return pair_gap(at, t);
  return obstacle_gap(at->of->support, at->dim, at->x, at->normal, t);
}

int pair_moves(const contact_pair *p) {
  return p->support != NULL && obstacle_moves(p->support);
}

/* Gap of contact node i along row k; reach where no obstacle is met. */
static status row_gap(const contact_surface *s, const contact_pair *p, int i,
                      int k, double t, double reach, double *gap) {
  int dim = s->dim;
  const surface_row at = {p, dim, &s->x[dim * i],
                          &s->frame[dim * dim * i + dim * k],
                          s->apart == NULL ? 0.0 : s->apart[dim * i + k]};
  *gap = pair_row_gap(&at, t);
  if (isnan(*gap) || *gap == -HUGE_VAL)
    RAISE(ERR_DECK, "%s:%d: *CONTACT %s: gap is %g at node %zu, time %g",
          p->at.file != NULL ? p->at.file : "", p->at.line_no, p->name, *gap,
          s->node_no[i], t);
  if (*gap == HUGE_VAL) *gap = reach;
  return OK;
}

int surface_meets(const contact_surface *s, const contact_pair *pairs, int i,
                  double t) {
  const obstacle *o = pairs[s->contact_id[i]].support;
  return o == NULL ||
         obstacle_gap(o, s->dim, &s->x[s->dim * i],
                      &s->frame[s->dim * s->dim * i], t) < HUGE_VAL;
}

status surface_gap(const contact_surface *s, const surface_input *in, double t,
                   double *gap, double *side_gap) {
  const contact_pair *pairs = in->pairs;
  for (int i = 0; i < s->n; ++i) {
    PASS(row_gap(s, &pairs[s->contact_id[i]], i, 0, t,
                 SURFACE_UNMET * in->mesh->size, &gap[i]));
    for (int k = 1; k < s->dim && side_gap != NULL; ++k) {
      int at = i * (s->dim - 1) + k - 1, side = s->side_id[at];
      side_gap[at] = HUGE_VAL;
      if (side < 0) continue;
      PASS(row_gap(s, &pairs[side], i, k, t, HUGE_VAL, &side_gap[at]));
    }
  }
  return OK;
}

/* Row k of the frame of node i meets the obstacle of its own contact. */
static void row_drift(const contact_surface *s, const contact_pair *pairs,
                      int i, int k, const double times[2], double *motion) {
  int dim = s->dim;
  int side = k > 0 ? s->side_id[i * (dim - 1) + k - 1] : -1;
  const contact_pair *p = &pairs[side >= 0 ? side : s->contact_id[i]];
  const double *frame = &s->frame[dim * dim * i], *row = frame + dim * k;
  double drift[3];
  if (!pair_moves(p)) return;
  obstacle_drift(p->support, dim, &s->x[dim * i], side >= 0 ? row : frame,
                 times[0], times[1], drift);
  *motion += dot(dim, row, drift);
}

void surface_drift(const contact_surface *s, const surface_input *in, double t0,
                   double t, double *motion) {
  const double times[2] = {t0, t};
  for (int i = 0; i < s->n; ++i)
    for (int k = 0; k < s->dim; ++k)
      row_drift(s, in->pairs, i, k, times, &motion[s->dim * i + k]);
}
