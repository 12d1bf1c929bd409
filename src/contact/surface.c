/*
 * The contact surface from the faces of the contact groups.
 *
 * Each node of each contact is a candidate: the sums over its faces of
 *   w = integral of its P1 function over the face,   area = sum w,
 *   normal ~ sum w n(face)   (the gradient of the volume with the node).
 * Candidates of one node are merged (one obstacle, smooth surface) or become
 * the rows of one frame (a corner on two obstacles).
 */

#include "base/base.h"
#include "contact/parts.h"

/* Rounding: of a depth of penetration over the size of the mesh, of the sum of
 * the normals of the faces around a node over their area. */
static const double rounding = 1e-9;
/* The sine of the angle between the normals of body and obstacle where they
 * touch that is worth a note. */
static const double told_sine = 1e-3;
/* 1 - the cosine of the angle between a contact with friction and what supports
 * hold that is worth a warning: 0.05 rad. */
static const double told_lean = 1.25e-3;

typedef struct candidate {
  int node_id, pair_id;
  int row; /* of a pair: in its coupling */
  int left_out;
  double normal[3]; /* [dim] sum of w n, then the unit normal */
  double across[3]; /* [dim] its part that supports leave, of unit length */
  int leans;        /* 1: they differ, not at a plane of symmetry */
  double area;      /* m2 */
  double gap;       /* at time 0, m */
  int also;         /* of a pair: another candidate, with another master side by
                       side, + 1; 0: none */
} candidate;

/* Messages given once per contact. */
typedef struct tally {
  /* nodes */
  int n_fixed, n_unreached, n_corner, n_kept;
  int n_stray; /* faces with a tied node that also moves others */
  int fixed_node, corner_node; /* the first of them */
  /* first node and pair */
  int n_dependent, dependent_node, dependent_on;
  int n_doubled; /* as near to another obstacle by the same faces */
  int deep_node;
  double depth; /* deepest penetration, m */
  int far_node;
  double far;      /* largest gap, m */
  int turned_node; /* where the normals of body and obstacle differ most */
  double sine;     /* of the angle between them */
  int held_node;   /* where supports hold most of the contact normal */
  double held;     /* 1 - the length that is left of it */
} tally;

typedef struct builder {
  const surface_input *in;
  message_log *log;
  int dim, n;
  mirrors mirrors;
  candidate *list;  /* [n] by node, then by contact */
  int *first;       /* [n_pair] its first candidate, while unsorted */
  tally *tallies;   /* [n_pair] */
  pair_links links; /* room for the masters of the surface */
  pair_row *rows;   /* [n_pair] of one node */
} builder;

/* Position of a node as text for a message. */
typedef struct node_text {
  char text[128];
} node_text;

static node_text describe(const mesh *m, int node_id) {
  node_text d;
  const double *x = &m->x[(size_t)m->dim * node_id];
  if (m->dim == 2)
    snprintf(d.text, sizeof d.text, "node %zu at (%g, %g)", m->node_no[node_id],
             x[0], x[1]);
  else
    snprintf(d.text, sizeof d.text, "node %zu at (%g, %g, %g)",
             m->node_no[node_id], x[0], x[1], x[2]);
  return d;
}

/* What a contact is with. */
static node_text partner(const contact_pair *p) {
  node_text d;
  snprintf(d.text, sizeof d.text, "%s %s",
           p->support != NULL ? "obstacle" : "surface",
           p->support != NULL ? p->support->name : p->master->name);
  return d;
}

/* The row of a candidate along its normal. */
static surface_row row_of(const builder *b, const candidate *c) {
  return (surface_row){.of = &b->in->pairs[c->pair_id],
                       .dim = b->dim,
                       .x = &b->in->mesh->x[(size_t)b->dim * c->node_id],
                       .normal = c->normal};
}

/* Integrals w[dim] of the P1 functions of the nodes of a face, times thickness
 * or once around the axis. */
static void face_shares(const surface_input *in, int face_id, double measure,
                        double *w) {
  const mesh *m = in->mesh;
  const int *node = &m->face[m->dim * face_id];
  double weight = measure * in->face_weight[face_id];
  for (int k = 0; k < m->dim; ++k) w[k] = weight / m->dim;
  if (in->axisymmetric) {
    double r0 = m->x[2 * (size_t)node[0]], r1 = m->x[2 * (size_t)node[1]];
    double around = 2 * acos(-1.0) * weight / 6;
    w[0] = around * (2 * r0 + r1);
    w[1] = around * (r0 + 2 * r1);
  }
}

/* The group consists of boundary faces; else a message. */
static void check_group(const builder *b, const contact_pair *p) {
  const mesh *m = b->in->mesh;
  const mesh_group *g = p->group;
  if (g->dim != m->dim - 1 || g->n_item == 0) {
    message_add(b->log, P4001, &p->at,
                "*CONTACT %s: group %s has dimension %d, expected faces of "
                "dimension %d",
                p->name, g->name, g->dim, m->dim - 1);
    return;
  }
  for (int k = 0; k < g->n_item; ++k) {
    int face_id = g->item_id[k];
    if (m->face_other[face_id] < 0) continue;
    message_add(b->log, P4001, &p->at,
                "*CONTACT %s: a face of group %s lies inside the body, at %s",
                p->name, g->name, describe(m, m->face[m->dim * face_id]).text);
    return;
  }
}

/* The circle of a sphere has its centre on the axis, that of a ring not. */
static void check_axis(const builder *b, const contact_pair *p) {
  const obstacle *o = p->support;
  if (!b->in->axisymmetric) return;
  if (o->shape == OBSTACLE_CYLINDER && o->point[0] == 0)
    message_add(b->log, P4009, &p->at,
                "*CONTACT %s: the circle of cylinder %s has its centre on the "
                "axis of symmetry, where it is a SPHERE; a shaft is a PLANE "
                "with the normal (1, 0)",
                p->name, o->name);
  if (o->shape == OBSTACLE_SPHERE && o->point[0] != 0)
    message_add(b->log, P4009, &p->at,
                "*CONTACT %s: centre of sphere %s at r = %g, expected 0",
                p->name, o->name, o->point[0]);
}

/* The candidate of a node that moves by itself, in a contact with an obstacle;
 * NULL: there is none. */
static candidate *find(const builder *b, int pair_id, int node_id) {
  const contact_pair *p = &b->in->pairs[pair_id];
  const mesh_group *g = p->group;
  const int at = p->support == NULL || surface_tied(b->in, node_id) >= 0
                     ? -1
                     : number_find(node_id, g->node_id, g->n_node);
  return at < 0 ? NULL : &b->list[b->first[pair_id] + at];
}

static void give(int dim, candidate *to, double w, const double *normal) {
  to->area += w;
  add_scaled(dim, w, normal, to->normal);
}

/* The candidate of a master that has parts of a contact: its own there, else
 * one with the same obstacle on a smooth surface, else with another obstacle
 * and nearly that normal. */
static candidate *find_near(const builder *b, int pair_id, int node_id,
                            const double *normal) {
  static const double near_cosine[] = {0.7071, 0.985}; /* 45, 10 degrees */
  const contact_pair *p = b->in->pairs;
  const int n = b->in->n_pair;
  candidate *c = find(b, pair_id, node_id);
  for (int k = 0; k < 2 * n && c == NULL; ++k) {
    const int other = p[k % n].support != p[pair_id].support;
    if (other == k / n) c = find(b, k % n, node_id);
    if (c != NULL &&
        !(dot(b->dim, c->normal, normal) >
          near_cosine[other] * sqrt(dot(b->dim, c->normal, c->normal))))
      c = NULL;
  }
  return c;
}

/* What a node of *TIE has of a face goes to the masters that are in a contact
 * there, by their parts along the normal; 0: none is. */
static int give_masters(const builder *b, int pair_id, int row, double w,
                        const double *normal) {
  const node_links *l = &b->in->ties->to;
  const int dim = l->dim;
  double sum = 0.0;
  for (int pass = 0; pass < 2; ++pass)
    for (size_t e = l->start[row]; e < l->start[row + 1]; ++e) {
      candidate *to = find_near(b, pair_id, l->master[e], normal);
      double part = 0.0;
      for (int c = 0; c < dim; ++c)
        part += normal[c] * normal[c] * l->part[dim * e + c];
      if (to == NULL || !(part > 0.0)) continue;
      if (pass == 0)
        sum += part;
      else
        give(dim, to, w * part / sum, normal);
    }
  b->tallies[pair_id].n_stray += sum > 0.0 && fabs(sum - 1.0) > rounding;
  return sum > 0.0;
}

/* A face of a contact: the parts of nodes of *TIE, tied = 1, go to their
 * masters, or to the others of the face; tied = 0: the parts of the others. */
static void add_face(const builder *b, int pair_id, int face_id, int tied) {
  const mesh *m = b->in->mesh;
  const int dim = b->dim, *node = &m->face[dim * face_id];
  candidate *own[3];
  double normal[3], w[3], left = 0.0;
  int n = 0;
  face_shares(b->in, face_id, mesh_face_normal(m, face_id, normal), w);
  for (int j = 0; j < dim; ++j) {
    own[j] = find(b, pair_id, node[j]);
    n += own[j] != NULL;
    if (own[j] != NULL && !tied)
      give(dim, own[j], w[j], normal);
    else if (own[j] == NULL && tied &&
             !give_masters(b, pair_id, surface_tied(b->in, node[j]), w[j],
                           normal))
      left += w[j];
  }
  for (int j = 0; j < dim && left > 0.0; ++j)
    if (own[j] != NULL) give(dim, own[j], left / n, normal);
}

/* The nodes of a contact with an obstacle. */
static int add_nodes(const builder *b, int pair_id, candidate *first) {
  const mesh_group *g = b->in->pairs[pair_id].group;
  for (int k = 0; k < g->n_node; ++k) {
    first[k].node_id = g->node_id[k];
    first[k].pair_id = pair_id;
    first[k].left_out = surface_tied(b->in, g->node_id[k]) >= 0;
  }
  return g->n_node;
}

/* The nodes that the coupling of a pair has. */
static int add_coupled(const builder *b, int pair_id, candidate *first) {
  const mortar *m = b->in->pairs[pair_id].coupled;
  for (int q = 0; q < m->n; ++q) {
    candidate *c = &first[q];
    *c = (candidate){.node_id = m->node_id[q], .pair_id = pair_id, .row = q};
    c->area = m->area[q];
    for (int d = 0; d < b->dim; ++d)
      c->normal[d] = c->area * m->normal[b->dim * q + d];
  }
  return m->n;
}

/* Order by node; the contacts of a node keep their order. */
static status sort_candidates(builder *b) {
  OWNED_NEW(int, start, b->in->mesh->n_node + 1);
  OWNED_NEW(candidate, sorted, b->n);
  for (int i = 0; i < b->n; ++i) ++start[b->list[i].node_id + 1];
  for (int k = 0; k < b->in->mesh->n_node; ++k) start[k + 1] += start[k];
  for (int i = 0; i < b->n; ++i)
    sorted[start[b->list[i].node_id]++] = b->list[i];
  memory_free(b->list);
  b->list = sorted;
  sorted = NULL;
  return OK;
}

static status collect(builder *b) {
  const surface_input *in = b->in;
  int n = 0;
  PASS_NEW_ALL(OF(b->tallies, in->n_pair), OF(b->rows, in->n_pair),
               OF(b->first, in->n_pair));
  for (int p = 0; p < in->n_pair; ++p) {
    n += in->pairs[p].group->n_node;
    if (in->pairs[p].coupled != NULL) continue;
    check_axis(b, &in->pairs[p]);
    check_group(b, &in->pairs[p]);
  }
  PASS(message_status(b->log, ERR_DECK));
  PASS_NEW(b->list, n);
  for (int p = 0; p < in->n_pair; ++p) {
    b->first[p] = b->n;
    b->n += in->pairs[p].coupled != NULL ? add_coupled(b, p, &b->list[b->n])
                                         : add_nodes(b, p, &b->list[b->n]);
  }
  /* Its faces; those of nodes of *TIE last, with all normals known. */
  for (int tied = 0; tied < 2; ++tied)
    for (int p = 0; p < in->n_pair; ++p)
      for (int k = 0;
           in->pairs[p].support != NULL && k < in->pairs[p].group->n_item; ++k)
        add_face(b, p, in->pairs[p].group->item_id[k], tied);
  return sort_candidates(b);
}

/* Do two contacts of one node belong to one smooth surface? */
static int is_smooth(const builder *b, const candidate *x, const candidate *y) {
  const contact_pair *p = b->in->pairs;
  return p[x->pair_id].support != NULL &&
         p[x->pair_id].support == p[y->pair_id].support &&
         frame_is_smooth(b->dim, x->normal, y->normal);
}

/* 1: the node acts on the masters of two pairs, side by side. */
static int is_shared(const builder *b, const candidate *x, const candidate *y) {
  const contact_pair *p = &b->in->pairs[x->pair_id],
                     *q = &b->in->pairs[y->pair_id];
  return p->coupled != NULL && q->coupled != NULL &&
         pair_same_normal(b->dim, p, x->row, q, y->row);
}

/* Candidates first..end are those of one node: move the faces of the later ones
 * to an earlier one with the same obstacle, or with masters side by side. */
static void merge(builder *b, int first, int end) {
  for (int i = first; i < end; ++i)
    for (int j = i + 1, last = i; j < end && !b->list[i].left_out; ++j) {
      candidate *x = &b->list[i], *y = &b->list[j];
      const int shared = is_shared(b, x, y);
      if (y->left_out || (!shared && !is_smooth(b, x, y))) continue;
      add_scaled(b->dim, 1.0, y->normal, x->normal);
      x->area += y->area;
      if (shared) b->list[last].also = j + 1;
      if (shared) last = j;
      y->left_out = 1;
      ++b->tallies[y->pair_id].n_kept;
    }
}

static const candidate *next_of(const builder *b, const candidate *c) {
  return c->also > 0 ? &b->list[c->also - 1] : NULL;
}

/* The normal of the obstacle instead of that of the body; 0 where the body does
 * not face the obstacle. */
static int take_obstacle_normal(const builder *b, candidate *c) {
  const surface_row at = row_of(b, c);
  double body[3];
  memcpy(body, c->normal, sizeof body);
  if (at.of->support != NULL)
    obstacle_normal(at.of->support, b->dim, at.x, c->normal);
  return dot(b->dim, body, c->normal) >
         PAIR_FIXED_SINE * sqrt(dot(b->dim, body, body));
}

/* Unit normal and its part orthogonal to the fixed components, or left out. */
static void orient(builder *b, candidate *c) {
  const contact_pair *p = &b->in->pairs[c->pair_id];
  tally *t = &b->tallies[c->pair_id];
  if (!(sqrt(dot(b->dim, c->normal, c->normal)) > rounding * c->area)) {
    message_add(b->log, P4008, &p->at, "%s %s: no outward normal at %s",
                p->card, p->name, describe(b->in->mesh, c->node_id).text);
    c->left_out = 1;
    return;
  }
  if (p->obstacle_normal && !take_obstacle_normal(b, c)) {
    c->left_out = 1;
    ++t->n_unreached;
    return;
  }
  unsigned fixed = b->in->fixed[c->node_id];
  frame_project(b->dim, 0, c->normal);
  COPY(c->across, c->normal, 3);
  const double left = frame_project(b->dim, fixed, c->across);
  double held = 0.0;
  for (int k = 0; k < b->dim; ++k)
    if (fixed >> k & 1) held = fmax(held, fabs(c->normal[k]));
  c->leans =
      held > rounding && !(mirrors_have(&b->mirrors, b->in, c->node_id) &&
                           !mirrors_lean(b->in, p, c->node_id, c->normal));
  if (!c->leans) COPY(c->normal, c->across, 3);
  if (left > PAIR_FIXED_SINE) return;
  c->left_out = 1;
  if (t->n_fixed++ == 0) t->fixed_node = c->node_id;
}

/* 1 - the length that supports leave of the normal: of the obstacle's, or of
 * the body's where the obstacle has none of its own. */
static void note_held(const builder *b, const candidate *c, double held) {
  tally *t = &b->tallies[c->pair_id];
  if (held > t->held) t->held = held, t->held_node = c->node_id;
}

/* The angle between the normals of body and obstacle where they touch. */
static void compare_normals(const builder *b, const candidate *c) {
  const contact_pair *p = &b->in->pairs[c->pair_id];
  tally *t = &b->tallies[c->pair_id];
  const surface_row at = row_of(b, c);
  double n[3], square = 0;
  if (p->support == NULL || !obstacle_normal(p->support, b->dim, at.x, n)) {
    if (c->leans) note_held(b, c, 1.0 - dot(b->dim, c->normal, c->across));
    return;
  }
  double across[3];
  memcpy(across, n, sizeof n);
  note_held(b, c,
            1.0 - frame_project(b->dim, b->in->fixed[c->node_id], across));
  if (!c->leans) memcpy(n, across, sizeof n);
  if (fabs(c->gap) > rounding * b->in->mesh->size) return;
  double cosine = dot(b->dim, n, c->normal);
  for (int k = 0; k < b->dim; ++k) {
    double d = n[k] - cosine * c->normal[k];
    square += d * d;
  }
  if (sqrt(square) <= t->sine) return;
  t->sine = sqrt(square);
  t->turned_node = c->node_id;
}

/* The gap of a pair at time 0, or of pairs side by side by their area. */
static double mean_apart(const builder *b, const candidate *c) {
  double sum = 0.0;
  for (const candidate *k = c; k != NULL; k = next_of(b, k)) {
    const contact_pair *p = &b->in->pairs[k->pair_id];
    sum += p->coupled->area[k->row] * pair_apart(b->in, p, k->row, c->normal);
  }
  return sum / c->area;
}

/* Gap at time 0, or left out. */
static void measure(builder *b, candidate *c) {
  const contact_pair *p = &b->in->pairs[c->pair_id];
  tally *t = &b->tallies[c->pair_id];
  const surface_row at = row_of(b, c);
  c->gap = p->coupled != NULL ? mean_apart(b, c) : pair_row_gap(&at, 0);
  if (isnan(c->gap) || c->gap == -HUGE_VAL) {
    message_add(b->log, P4007, &p->at, "%s %s: gap is %s at %s, time 0",
                p->card, p->name, isnan(c->gap) ? "not a number" : "-inf",
                describe(b->in->mesh, c->node_id).text);
    c->left_out = 1;
  } else if (c->gap == HUGE_VAL) {
    if (pair_moves(p)) {
      c->gap = SURFACE_UNMET * b->in->mesh->size;
    } else {
      c->left_out = 1;
      ++t->n_unreached;
    }
  } else if (-c->gap > t->depth) {
    t->depth = -c->gap;
    t->deep_node = c->node_id;
  } else if (c->gap > t->far) {
    t->far = c->gap;
    t->far_node = c->node_id;
  }
}

/* The normals of a corner are across what supports hold. */
static void stand_upright(candidate *c) {
  COPY(c->normal, c->across, 3);
  c->leans = 0;
}

/* 1: the body has its back to a cylinder or sphere. */
static int is_behind(const builder *b, const candidate *c) {
  const surface_row at = row_of(b, c);
  return at.of->support != NULL &&
         obstacle_lean(at.of->support, b->dim, at.x, c->normal) > acos(0.0);
}

/* 1: of two contacts along one normal the one behind the body is left out. */
static int leave_behind(builder *b, const candidate **other,
                        const candidate *c) {
  const int behind = is_behind(b, c);
  tally *t = &b->tallies[(behind ? c : *other)->pair_id];
  if (!behind && !is_behind(b, *other)) return 0;
  --t->n_kept, ++t->n_unreached;
  if (!behind) *other = c;
  return 1;
}

/* 1: along one normal two obstacles at rest bound a node as one, the nearer,
 * which takes the place of both; of two of which one is behind the body the
 * other does. Faces that both have count once. */
static int take_nearer(builder *b, const candidate **other,
                       const candidate *c) {
  candidate *x = &b->list[*other - b->list], *y = &b->list[c - b->list];
  const contact_pair *p = &b->in->pairs[x->pair_id],
                     *q = &b->in->pairs[y->pair_id];
  const int faces_apart = p->group->tag != q->group->tag;
  const double area = x->area + y->area;
  if (!frame_is_same(b->dim, x->across, y->across)) return 0;
  if (leave_behind(b, other, c)) return 1;
  if (p->support == NULL || q->support == NULL || pair_moves(p) ||
      pair_moves(q))
    return 0;
  if (!faces_apart && fabs(x->gap - y->gap) <= rounding * b->in->mesh->size) {
    tally *t = &b->tallies[y->pair_id];
    if (t->n_doubled++ + t->n_dependent == 0)
      t->dependent_node = y->node_id, t->dependent_on = x->pair_id;
    --t->n_kept;
  } else if (y->gap < x->gap) {
    *other = y;
  }
  if (faces_apart) x->area = y->area = area;
  return 1;
}

/* Move the candidates of one node that stay to kept[]; their number. */
static int gather(builder *b, int first, int end, const candidate **kept) {
  int n = 0;
  int n_oriented = 0;
  merge(b, first, end);
  for (int i = first; i < end; ++i) {
    if (!b->list[i].left_out) orient(b, &b->list[i]);
    n_oriented += !b->list[i].left_out;
  }
  for (int i = first; i < end; ++i) {
    candidate *c = &b->list[i];
    if (n_oriented > 1 && c->leans) stand_upright(c);
    if (!c->left_out) measure(b, c);
    if (c->left_out) continue;
    compare_normals(b, c);
    ++b->tallies[c->pair_id].n_kept;
    int one = 0;
    for (int k = 0; k < n && k < b->dim && !one; ++k)
      one = take_nearer(b, &kept[k], c);
    if (one) continue;
    if (n < b->dim) kept[n] = c;
    ++n;
  }
  return n;
}

/* The frame of contact node i from its n_kept contacts; 1 after an error. */
static int set_frame(builder *b, contact_surface *s, int i, int n_kept,
                     const candidate *const *kept) {
  int dim = b->dim, node_id = kept[0]->node_id, bad = n_kept > dim;
  double *frame = &s->frame[dim * dim * i];
  unsigned fixed = b->in->fixed[node_id] & ((1u << dim) - 1);
  for (int k = 0; k < n_kept && k < dim; ++k)
    COPY(frame + dim * k, kept[k]->across, dim);
  bad = bad || frame_complete(dim, n_kept, fixed, frame, &s->held[dim * i]) < 0;
  COPY(frame, kept[0]->normal, dim);
  tally *t = &b->tallies[kept[bad ? 1 : 0]->pair_id];
  if (bad && t->n_dependent++ == 0) {
    t->dependent_node = node_id;
    t->dependent_on = kept[0]->pair_id;
  }
  frame_invert(dim, (n_kept == 1 && !kept[0]->leans) || bad, frame,
               &s->basis[dim * dim * i]);
  return bad;
}

/* A corner has no friction: noted for each of its contacts. */
static void note_corner(builder *b, int n_kept, const candidate *const *kept) {
  int friction = 0;
  for (int k = 0; k < n_kept && k < b->dim; ++k)
    friction |= b->in->pairs[kept[k]->pair_id].friction;
  tally *t = &b->tallies[kept[0]->pair_id];
  if (n_kept > 1 && friction && t->n_corner++ == 0)
    t->corner_node = kept[0]->node_id;
}

/* What the rows of a node are relative to. */
static status couple_node(builder *b, contact_surface *s, int i, int n_kept,
                          const candidate *const *kept) {
  const int dim = b->dim;
  int n = 0;
  if (s->master == NULL) return OK;
  for (int k = 0; k < n_kept; ++k) {
    for (const candidate *c = kept[k]; c != NULL; c = next_of(b, c))
      b->rows[n++] = (pair_row){b->in->pairs[c->pair_id].coupled, c->row, k};
    if (b->in->pairs[kept[k]->pair_id].coupled != NULL)
      s->apart[dim * i + k] = kept[k]->gap;
  }
  PASS(pair_add_row(s, b->in, i, n_kept, n, b->rows, &b->links));
  for (int a = 0; a < dim; ++a)
    for (int c = 0; c < dim; ++c)
      s->basis[dim * (dim * i + a) + c] *= surface_share(s, i, a);
  return OK;
}

static status set_node(builder *b, contact_surface *s, int n_kept,
                       const candidate *const *kept) {
  OWNS(s);
  int dim = b->dim, i = s->n++;
  const candidate *c = kept[0];
  s->node_id[i] = c->node_id;
  s->node_no[i] = b->in->mesh->node_no[c->node_id];
  s->contact_id[i] = c->pair_id;
  for (int k = 0; k < dim - 1; ++k) {
    const candidate *side = k + 1 < n_kept ? kept[k + 1] : NULL;
    s->side_id[i * (dim - 1) + k] = side != NULL ? side->pair_id : -1;
    s->side_area[i * (dim - 1) + k] = side != NULL ? side->area : 0.0;
  }
  for (int k = 0; k < dim; ++k)
    s->x[dim * i + k] = b->in->mesh->x[(size_t)dim * c->node_id + k];
  s->area[i] = c->area;
  s->gap0[i] = c->gap;
  if (!set_frame(b, s, i, n_kept, kept)) note_corner(b, n_kept, kept);
  return couple_node(b, s, i, n_kept < dim ? n_kept : dim, kept);
}

/* The INTERFERENCE or CLEARANCE of a pair, m; 0: none, or a formula. */
static double added(const contact_pair *p) {
  return p->change == NULL || p->change->formula != NULL ? 0.0
                                                         : p->change->number;
}

/* What facets of a curved surface are off by, m. */
static double sagitta(const builder *b, const contact_pair *p) {
  static const double part = 0.05; /* -, of their size */
  double mean = 0.0, normal[3];
  for (int k = 0; k < p->group->n_item; ++k)
    mean += mesh_face_normal(b->in->mesh, p->group->item_id[k], normal) /
            p->group->n_item;
  return part * (b->dim == 2 ? mean : sqrt(mean));
}

/* A depth, or a gap, that is told, m: facets enter each other and gape, which
 * is no matter unless it counts next to what the deck adds. */
static double told_depth(const builder *b, const contact_pair *p) {
  static const double part = 0.1;
  const double size = b->in->mesh->size;
  if (p->support != NULL) return rounding * size;
  const double facets = sagitta(b, p);
  return added(p) == 0.0
             ? facets
             : fmin(facets, fmax(part * fabs(added(p)), rounding * size));
}

/* 1: the gaps of a pair are of facets alone, and are told. */
static int tells_gap(const builder *b, const contact_pair *p, const tally *t) {
  return p->support == NULL && added(p) != 0.0 && t->far <= sagitta(b, p) &&
         t->far > fmax(t->depth, told_depth(b, p));
}

/* ", 2 times the INTERFERENCE", what a depth is. */
static node_text share_of_added(const contact_pair *p, double depth) {
  node_text t = {""};
  if (added(p) != 0.0)
    snprintf(t.text, sizeof t.text, ", %.2g times the %s",
             depth / fabs(added(p)),
             p->change_sign < 0.0 ? "INTERFERENCE" : "CLEARANCE");
  return t;
}

static void say_distance(const builder *b, const contact_pair *p,
                         const tally *t) {
  const mesh *m = b->in->mesh;
  if (tells_gap(b, p, t))
    message_add(b->log, P4004, &p->at, "%s %s: %s is up to %.4g away%s, at %s",
                p->card, p->name, partner(p).text, t->far,
                share_of_added(p, t->far).text, describe(m, t->far_node).text);
  else if (t->depth > told_depth(b, p))
    message_add(b->log, P4004, &p->at,
                "%s %s: deepest penetration of %s is %.4g, %.2g of the "
                "size of the mesh%s, at %s",
                p->card, p->name, partner(p).text, t->depth, t->depth / m->size,
                share_of_added(p, t->depth).text,
                describe(m, t->deep_node).text);
}

static void say(const builder *b, int pair_id) {
  const contact_pair *p = &b->in->pairs[pair_id];
  const tally *t = &b->tallies[pair_id];
  const mesh *m = b->in->mesh;
  if (t->n_fixed > 0)
    message_add(b->log, P4002, &p->at,
                "*CONTACT %s: nodes of group %s are also fixed in the normal "
                "direction and left out of contact: %d, the first is %s",
                p->name, p->group->name, t->n_fixed,
                describe(m, t->fixed_node).text);
  if (t->n_stray > 0)
    message_add(b->log, P4035, &p->at,
                "%s %s: tied nodes of group %s move with masters that are not "
                "in the contact: forces next to the joint are wrong: SLAVE= of "
                "the *TIE takes the other surface, the finer one",
                p->card, p->name, p->group->name);
  if (t->n_unreached > 0 && t->n_kept > 0)
    message_add(b->log, P4003, &p->at,
                "*CONTACT %s: left out, as the normal there does not meet "
                "obstacle %s: %d of its nodes",
                p->name, p->support->name, t->n_unreached);
  say_distance(b, p, t);
  if (t->sine > told_sine)
    message_add(b->log, P4018, &p->at,
                "*CONTACT %s: the normals of the body differ from those of "
                "obstacle %s by up to %.2g rad, at %s: that share of the "
                "contact forces acts along the obstacle",
                p->name, p->support->name, asin(fmin(t->sine, 1)),
                describe(m, t->turned_node).text);
  if (p->friction && t->held > told_lean)
    message_add(b->log, P4022, &p->at,
                "%s %s: supports hold nodes in a direction that leans by %.2g "
                "rad from %s: friction, u_t and slip are along it, at %s",
                p->card, p->name, acos(fmax(1.0 - t->held, 0.0)),
                partner(p).text, describe(m, t->held_node).text);
  if (t->n_corner > 0)
    message_add(b->log, P4005, &p->at,
                "%s %s: %d node(s) may touch a second obstacle and have no "
                "friction, the first is %s",
                p->card, p->name, t->n_corner,
                describe(m, t->corner_node).text);
  const int n_bad = t->n_dependent + (t->n_kept == 0 ? t->n_doubled : 0);
  if (n_bad > 0)
    message_add(b->log, P4006, &p->at,
                "%s %s: its normal depends on that of %s %s at %d "
                "node%s, the first is %s",
                p->card, p->name, b->in->pairs[t->dependent_on].card,
                b->in->pairs[t->dependent_on].name, n_bad,
                n_bad == 1 ? "" : "s", describe(m, t->dependent_node).text);
  else if (t->n_kept == 0)
    message_add(b->log, P4010, &p->at,
                "%s %s: no node of group %s can touch %s", p->card, p->name,
                p->group->name, partner(p).text);
}

static int has_pair(const surface_input *in) {
  int any = 0;
  for (int p = 0; p < in->n_pair; ++p) any |= in->pairs[p].coupled != NULL;
  return any;
}

static status surface_new(int dim, int n, int pairs, contact_surface **out) {
  MAKES(contact_surface, s, out);
  s->dim = dim;
  PASS_NEW_ALL(OF(s->node_id, n), OF(s->node_no, n), OF(s->contact_id, n),
               OF(s->side_id, n * (dim - 1)), OF(s->side_area, n * (dim - 1)),
               OF(s->x, n * dim), OF(s->area, n), OF(s->frame, n * dim * dim),
               OF(s->basis, n * dim * dim), OF(s->gap0, n),
               OF(s->held, n * dim));
  if (pairs) {
    PASS_NEW_ALL(OF(s->apart, n * dim), OF(s->share, n * dim),
                 OF(s->covered, n), OF(s->lever, n * dim * dim),
                 OF(s->master, 1));
    s->master->dim = dim;
    PASS_NEW(s->master->start, n + 1);
  }
  return OK;
}

/* Normals are sides or areas, and are squared. */
static status check_range(const mesh *m) {
  const double normal = m->dim == 2 ? m->size : m->size * m->size;
  if (normal < NUMBER_MOST && normal > 1.0 / NUMBER_MOST) return OK;
  RAISE(ERR_MESH,
        "the mesh, %.3g long, is out of range: the squares of normals are no "
        "numbers above 0; use other units, or SCALE= of *MESH",
        m->size);
}

status surface_build(const surface_input *in, message_log *log,
                     contact_surface **out) {
  status st = OK;
  builder b = {.in = in, .log = log, .dim = in->mesh->dim};
  contact_surface *s = NULL;
  *out = NULL;
  TRY(check_range(in->mesh));
  TRY(collect(&b));
  mirrors_find(in, &b.mirrors);
  TRY(surface_new(b.dim, b.n, has_pair(in), &s));
  for (int first = 0, end; first < b.n; first = end) {
    const candidate *kept[3];
    for (end = first + 1; end < b.n; ++end)
      if (b.list[end].node_id != b.list[first].node_id) break;
    int n_kept = gather(&b, first, end, kept);
    if (n_kept > 0) TRY(set_node(&b, s, n_kept, kept));
  }
  for (int p = 0; p < in->n_pair; ++p) say(&b, p);
  TRY(message_status(log, ERR_DECK));
  *out = s;
  s = NULL;
done:
  RELEASE(s, b.list, b.first, b.tallies, b.rows);
  return st;
}

int surface_has_held(const contact_surface *s) {
  return memchr(s->held, 1, s->dim * s->n) != NULL;
}
