/*
 * The integrals face by face; then the faces of each node are put together. A
 * node turns out to be hardly covered when all faces are done: its faces are
 * done again without it.
 */
#include "contact/mortar/mortar.h"

#include "base/base.h"
#include "contact/mortar/partner.h"

/* Least part of its area that gives a node a multiplier, - . */
static const double scant = 0.01;
/* Part of a face with, or without, a partner that is more than rounding. */
static const double seen = 1e-9;

enum { CARRIES = 0, NO_SLAVE, DROPPED, SCANT, UNCOVERED };

/* int psi_j phi of one node, for the nodes j of a slave face. */
typedef struct entry {
  int node;
  double part[3]; /* [dim] m2 */
} entry;

typedef struct link {
  int master;
  double part; /* - */
} link;

/* What one slave face gives. */
typedef struct face_part {
  size_t first, end; /* entries */
  double normal[3];
  double size;     /* m */
  double rounding; /* relative size of rounding, - */
  double share[3]; /* [dim] int phi_j over the whole face, m2 */
  double d[3];     /* [dim] over the covered part, m2 */
  double thin;     /* thickness of that over its own, - */
  double masters;  /* int size of the master faces, m3 */
  double more[3];  /* [dim] int psi_j phi of the nodes without multiplier, m2 */
  double lever[9]; /* [dim*dim] the same times their places, m3 */
  double bulge[3]; /* [dim] int psi_j times what both surfaces have beyond their
                      faces, m3 */
} face_part;

typedef struct builder {
  const mortar_input *in;
  partner_search search;
  step_search steps;
  unsigned char *state; /* [n_node] of the enum */
  face_part *face;      /* [n_slave] */
  entry *entries;
  int n_entry, entry_capacity;
  sample *points;
  int n_point, point_capacity;
  int *slot;      /* [n_node] -1, or place among the entries of a face or row */
  double *normal; /* [dim*n_node] of the masters and dropped nodes */
  double *bulge;  /* of bulge_find, both surfaces; NULL: none */
  size_t *start;  /* of mortar_around */
  int *around;
  unsigned char *met; /* [mesh->n_face] 1: partner of a slave face */
  link *links;        /* of all rows */
  int n_link, link_capacity;
  mortar *out;
} builder;

/* Weight of the area of a slave face where its P1 functions are phi. */
static double thickness(const builder *b, int face, const double *phi) {
  const double w = b->in->face_weight[face];
  if (!b->in->axisymmetric) return w;
  const int *node = mortar_nodes(b->in, face);
  return 2 * acos(-1.0) * w *
         (phi[0] * mortar_place(b->in, node[0])[0] +
          phi[1] * mortar_place(b->in, node[1])[0]);
}

/* Thickness that a slave face and its partner number k share, over its own. */
static double thinner(const builder *b, int face, int k) {
  const double *w = b->in->face_weight;
  return fmin(1.0, w[b->search.list[k].face] / w[face]);
}

/* Exact for degree 3 on a segment, 2 on a triangle. */
static const face_rule plain[] = {{2, {0.21132486540518708}, {0.5}},
                                  {3, {1. / 6}, {1. / 3}}};

/* A better one where surfaces bulge. */
static const face_rule *rule_of(const builder *b) {
  const int space = b->in->mesh->dim == 3;
  const int bulges = b->bulge != NULL && (space || b->in->axisymmetric);
  return bulges ? &mesh_face_rule[space] : &plain[space];
}

static double face_size(int dim, double measure) {
  return dim == 2 ? measure : sqrt(measure);
}

/* Quadrature of one cell; the reference of the offsets is ref. */
static status add_points(builder *b, int face, const facet *f, int of,
                         const cell *c, const double *ref) {
  const int dim = f->dim;
  const face_rule *r = rule_of(b);
  for (int k = 0; k < r->n; ++k) {
    sample s = {.partner = of};
    double bary[3], at[2] = {0, 0};
    s.weight = cell_measure(dim, c) * face_rule_point(r, dim, k, bary);
    for (int i = 0; i < dim; ++i)
      for (int a = 0; a < dim - 1; ++a) {
        s.offset[a] += bary[i] * (c->at[i][a] - ref[a]);
        at[a] += bary[i] * c->at[i][a];
      }
    cell_functions(dim, &f->in_plane, at, s.phi);
    cell_functions(dim, &b->search.list[of].s.in_plane, at, s.other);
    s.weight *= thickness(b, face, s.phi) * thinner(b, face, of);
    if (!(s.weight > 0)) continue;
    PASS_GROW(b->points, b->n_point, b->point_capacity);
    b->points[b->n_point++] = s;
  }
  return OK;
}

/* Points of all cells of a face; corner: its nodes less the reference. */
static status set_points(builder *b, int face, const facet *f, cell *corner) {
  const partner_search *s = &b->search;
  const double *ref = NULL;
  b->n_point = 0;
  for (int i = 0; i < s->n; ++i) {
    const partner *p = &s->list[i];
    for (int k = p->first; k < p->first + p->n; ++k) {
      if (ref == NULL) ref = s->cells[k].at[0];
      PASS(add_points(b, face, f, i, &s->cells[k], ref));
    }
  }
  *corner = f->in_plane;
  for (int k = 0; k < f->dim && ref != NULL; ++k)
    for (int a = 0; a < f->dim - 1; ++a) corner->at[k][a] -= ref[a];
  return OK;
}

static status entry_of(builder *b, const face_part *part, int node,
                       entry **out) {
  if (b->slot[node] < (int)part->first) {
    PASS_GROW(b->entries, b->n_entry, b->entry_capacity);
    b->slot[node] = b->n_entry;
    b->entries[b->n_entry++] = (entry){.node = node};
  }
  *out = &b->entries[b->slot[node]];
  return OK;
}

/* Nodes without multiplier are in P among the masters. */
static status add_dropped(builder *b, int face, face_part *part,
                          const int *kept) {
  const int dim = b->in->mesh->dim;
  const int *node = mortar_nodes(b->in, face);
  for (int z = 0; z < dim; ++z) {
    entry *e;
    if (kept[z]) continue;
    PASS(entry_of(b, part, node[z], &e));
    for (int j = 0; j < dim; ++j) {
      double sum = 0.0;
      for (int k = 0; k < b->n_point; ++k)
        sum += b->points[k].weight * b->points[k].psi[j] * b->points[k].phi[z];
      e->part[j] -= sum;
      part->more[j] += sum;
      add_scaled(dim, sum, mortar_place(b->in, node[z]), part->lever + dim * j);
    }
  }
  return OK;
}

static status add_masters(builder *b, face_part *part) {
  const int dim = b->in->mesh->dim;
  for (EACH(const sample, p, b->points, b->n_point)) {
    const partner *m = &b->search.list[p->partner];
    const int *node = mortar_nodes(b->in, m->face);
    b->met[m->face] = 1;
    part->masters += p->weight * face_size(dim, m->size);
    for (int l = 0; l < dim; ++l) {
      entry *e;
      PASS(entry_of(b, part, node[l], &e));
      for (int j = 0; j < dim; ++j)
        e->part[j] += p->weight * p->psi[j] * p->other[l];
    }
  }
  return OK;
}

/* Height of the curve of a partner above its face, along the normal of the
 * slave face f: over a point of it that lies to the side, as the face leans. */
static double other_bulge(const builder *b, const facet *f, const sample *p) {
  const partner *m = &b->search.list[p->partner];
  const cell *c = &m->s.in_plane;
  const int dim = f->dim;
  double at[2] = {0, 0}, slope[2] = {0, 0}, origin[3], phi[3];
  cell_functions(dim, c, at, origin);
  for (int a = 0; a < dim - 1; ++a) {
    const double unit[2] = {a == 0, a == 1};
    cell_functions(dim, c, unit, phi);
    for (int k = 0; k < dim; ++k) {
      slope[a] += m->s.height[k] * (phi[k] - origin[k]);
      at[a] += p->phi[k] * f->in_plane.at[k][a];
    }
  }
  const double steep = sqrt(1.0 + dot(dim - 1, slope, slope));
  const double height = bulge_height(dim, b->bulge, m->face, p->other);
  for (int a = 0; a < dim - 1; ++a) at[a] -= height * slope[a] / steep;
  cell_functions(dim, c, at, phi);
  return steep * bulge_height(dim, b->bulge, m->face, phi);
}

/* Of surfaces that are one in truth both heights cancel. */
static void add_bulges(const builder *b, int face, const facet *f,
                       face_part *part) {
  for (int k = 0; k < b->n_point && b->bulge != NULL; ++k) {
    const sample *p = &b->points[k];
    const double own = bulge_height(b->in->mesh->dim, b->bulge, face, p->phi),
                 other = other_bulge(b, f, p);
    if (fabs(own + other) <= seen * (fabs(own) + fabs(other))) continue;
    for (int j = 0; j < b->in->mesh->dim; ++j)
      part->bulge[j] += p->weight * p->psi[j] * (own + other);
  }
}

/* int phi_j over the whole face. */
static void set_shares(const builder *b, int face, const facet *f,
                       double *share) {
  const int dim = f->dim;
  CLEAR(share, 3);
  for (int k = 0; k < dim; ++k) {
    double phi[3];
    const double part = face_rule_point(&plain[dim - 2], dim, k, phi);
    const double w = part * f->measure * thickness(b, face, phi);
    for (int j = 0; j < dim; ++j) share[j] += w * phi[j];
  }
}

/* The integrals of slave face number i. */
static status do_face(builder *b, int i) {
  const int face = b->in->slave[i];
  face_part *part = &b->face[i];
  facet f;
  cell corner;
  int kept[3];
  memset(part, 0, sizeof *part);
  part->first = part->end = b->n_entry;
  b->search.n = 0;
  if (facet_set(b->in->mesh->dim, mortar_nodes(b->in, face), b->in->x, &f) != 0)
    return OK;
  memcpy(part->normal, f.normal, sizeof part->normal);
  part->size = face_size(f.dim, f.measure);
  part->rounding = partner_rounding(&b->search, &f);
  set_shares(b, face, &f, part->share);
  PASS(partner_find(&b->search, face, &f));
  steps_leave(&b->steps, i, &b->search);
  PASS(set_points(b, face, &f, &corner));
  const int *node = mortar_nodes(b->in, face);
  int n_kept = 0;
  for (int k = 0; k < b->in->mesh->dim; ++k)
    n_kept += kept[k] = b->state[node[k]] == CARRIES;
  if (b->n_point == 0) return OK;
  /* Mean of thinner over the points of a face. */
  double both = 0.0, own = 0.0;
  for (int k = 0; k < b->n_point; ++k) {
    both += b->points[k].weight;
    own += b->points[k].weight / thinner(b, face, b->points[k].partner);
  }
  part->thin = both / own;
  dual_basis(f.dim, &corner, kept, b->n_point, b->points, part->d);
  if (n_kept == 0) return OK;
  PASS(add_masters(b, part));
  PASS(add_dropped(b, face, part, kept));
  add_bulges(b, face, &f, part);
  part->end = b->n_entry;
  return OK;
}

static void set_states(builder *b) {
  const mortar_input *in = b->in;
  const int dim = in->mesh->dim;
  for (int i = 0; i < in->mesh->n_node; ++i) {
    const int is_slave = b->start[i + 1] > b->start[i];
    const int is_dropped = in->dropped != NULL && in->dropped[i];
    b->state[i] = !is_slave ? NO_SLAVE : is_dropped ? DROPPED : CARRIES;
  }
  for (int i = 0; i < in->n_master * dim; ++i) {
    const int node = mortar_nodes(b->in, in->master[i / dim])[i % dim];
    if (b->state[node] == CARRIES) b->state[node] = DROPPED;
  }
}

/* Place of a node among those of a slave face. */
static int corner_of(const builder *b, int i, int node) {
  const int *v = mortar_nodes(b->in, b->in->slave[i]);
  int k = 0;
  while (v[k] != node) ++k;
  return k;
}

/* D of a node, and what it were if all were covered as thick. */
static double node_area(const builder *b, int node, double *whole) {
  double sum = 0.0, own = 0.0;
  *whole = 0.0;
  for (size_t a = b->start[node]; a < b->start[node + 1]; ++a) {
    const face_part *f = &b->face[b->around[a]];
    const int k = corner_of(b, b->around[a], node);
    sum += f->d[k];
    if (f->thin > 0.0) own += f->d[k] / f->thin;
    *whole += f->share[k];
  }
  if (own > 0.0) *whole *= sum / own;
  return sum;
}

/* Nodes without enough area; n_redo: those that faces are to do without. */
static void leave_out(builder *b) {
  mortar *m = b->out;
  for (int i = 0; i < b->in->mesh->n_node; ++i) {
    double whole;
    m->n_dropped += b->state[i] == DROPPED;
    if (b->state[i] != CARRIES) continue;
    const double area = node_area(b, i, &whole);
    if (area >= scant * whole && area > 0) {
      ++m->n;
      continue;
    }
    b->state[i] = area > 0 ? SCANT : UNCOVERED;
    m->n_uncovered += area > 0 ? 0 : 1;
    m->n_scant += area > 0 ? 1 : 0;
  }
}

/* Again the faces with parts beyond a step. */
static status do_steps(builder *b) {
  for (int i = 0; i < b->in->mesh->n_node; ++i)
    if (b->start[i + 1] > b->start[i])
      PASS(steps_find(&b->steps, &b->search,
                      (int)(b->start[i + 1] - b->start[i]),
                      b->around + b->start[i]));
  for (int k = 0, last = -1; k < b->steps.n_left; ++k) {
    const int i = b->steps.left[k].slave_no;
    if (i != last) PASS(do_face(b, i));
    last = i;
  }
  return OK;
}

static status do_faces(builder *b) {
  const int dim = b->in->mesh->dim;
  for (int i = 0; i < b->in->n_slave; ++i) {
    PASS(do_face(b, i));
    PASS(steps_see(&b->steps, i, &b->search));
  }
  PASS(do_steps(b));
  leave_out(b);
  for (int i = 0; i < b->in->n_slave; ++i) {
    const int *node = mortar_nodes(b->in, b->in->slave[i]);
    int redo = 0;
    for (int k = 0; k < dim; ++k) redo |= b->state[node[k]] == SCANT;
    if (redo) PASS(do_face(b, i));
  }
  return OK;
}

/* ---- normals ------------------------------------------------------------- */

/* Normals at the nodes of the masters, from faces that are partners (no sides
 * at an edge); where a node of the slave is in P, the opposite of its own. */
static status set_node_normals(builder *b) {
  const mortar_input *in = b->in;
  const int dim = in->mesh->dim;
  const size_t n = in->mesh->n_node;
  PASS_NEW(b->normal, dim * n);
  for (int i = 0; i < in->n_master * dim; ++i) {
    const facet *f = &b->search.master[i / dim];
    const int node = mortar_nodes(b->in, in->master[i / dim])[i % dim];
    b->slot[node] = 0;
    if (b->met[in->master[i / dim]])
      add_scaled(dim, f->measure, f->normal, b->normal + (size_t)dim * node);
  }
  for (int i = 0; i < in->n_slave * dim; ++i) {
    const int node = mortar_nodes(b->in, in->slave[i / dim])[i % dim];
    const face_part *f = &b->face[i / dim];
    if (b->slot[node] != 0)
      add_scaled(dim, -f->share[i % dim], f->normal,
                 b->normal + (size_t)dim * node);
  }
  for (size_t i = 0; i < n; ++i) make_unit(dim, b->normal + dim * i);
  return OK;
}

static void set_normal(builder *b, int q) {
  const int dim = b->in->mesh->dim, node = b->out->node_id[q];
  const node_links *l = &b->out->to;
  double *normal = b->out->normal + (size_t)dim * q;
  double other[3] = {0};
  for (size_t a = b->start[node]; a < b->start[node + 1]; ++a) {
    const face_part *f = &b->face[b->around[a]];
    add_scaled(dim, f->d[corner_of(b, b->around[a], node)], f->normal, normal);
  }
  make_unit(dim, normal);
  if (b->in->slave_normal) return;
  for (size_t e = l->start[q]; e < l->start[q + 1]; ++e)
    add_scaled(dim, l->part[dim * e], b->normal + (size_t)dim * l->master[e],
               other);
  make_unit(dim, other);
  add_scaled(dim, -1, other, normal);
  make_unit(dim, normal);
}

/* ---- rows ---------------------------------------------------------------- */

static int by_node(const void *a, const void *b) {
  const int p = ((const entry *)a)->node, q = ((const entry *)b)->node;
  return (p > q) - (p < q);
}

/* Entries of a node from all its faces, in row[]; part[0] is P. */
static int gather(builder *b, int node, double area, entry *row,
                  double *rounding) {
  int n = 0;
  *rounding = 0.0;
  for (size_t a = b->start[node]; a < b->start[node + 1]; ++a) {
    const face_part *f = &b->face[b->around[a]];
    const int k = corner_of(b, b->around[a], node);
    *rounding = fmax(*rounding, f->rounding);
    for (size_t e = f->first; e < f->end; ++e) {
      int *slot = &b->slot[b->entries[e].node];
      if (*slot < 0) {
        *slot = n;
        row[n++] = (entry){.node = b->entries[e].node};
      }
      row[*slot].part[0] += b->entries[e].part[k] / area;
    }
  }
  for (int i = 0; i < n; ++i) b->slot[row[i].node] = -1;
  return n;
}

/* Parts that are only rounding go to the largest one. Returns what is left. */
static int leave_rounding(entry *row, int n, double rounding) {
  int most = 0, left = 0;
  double lost = 0.0;
  for (int i = 1; i < n; ++i)
    if (fabs(row[i].part[0]) > fabs(row[most].part[0])) most = i;
  for (int i = 0; i < n; ++i)
    if (fabs(row[i].part[0]) <= rounding) lost += row[i].part[0];
  row[most].part[0] += lost;
  for (int i = 0; i < n; ++i)
    if (fabs(row[i].part[0]) > rounding) row[left++] = row[i];
  return left;
}

static size_t longest_row(const builder *b) {
  size_t most = 0;
  for (int i = 0; i < b->in->mesh->n_node; ++i) {
    size_t n = 0;
    for (size_t a = b->start[i]; a < b->start[i + 1]; ++a)
      n += b->face[b->around[a]].end - b->face[b->around[a]].first;
    if (n > most) most = n;
  }
  return most;
}

/* What the slave gets of the multiplier of a node: D_j at the node, and what
 * it carries for neighbours without a multiplier; the gap is their mean. */
static void set_resultant(builder *b, int q) {
  mortar *m = b->out;
  const int dim = b->in->mesh->dim, node = m->node_id[q];
  const double own = m->area[q];
  double *lever = m->lever + (size_t)dim * q;
  add_scaled(dim, own, mortar_place(b->in, node), lever);
  for (size_t a = b->start[node]; a < b->start[node + 1]; ++a) {
    const face_part *f = &b->face[b->around[a]];
    const int k = corner_of(b, b->around[a], node);
    m->area[q] += f->more[k];
    add_scaled(dim, 1.0, f->lever + dim * k, lever);
  }
  m->share[q] = m->area[q] / own;
  for (int c = 0; c < dim; ++c) {
    lever[c] /= m->area[q];
    m->gap[dim * q + c] /= m->share[q];
  }
}

/* Row of one node, into links. */
static status add_row(builder *b, int q, entry *row) {
  mortar *m = b->out;
  const int node = m->node_id[q];
  double rounding;
  m->area[q] = node_area(b, node, &m->whole[q]);
  int n = gather(b, node, m->area[q], row, &rounding);
  n = leave_rounding(row, n, rounding);
  qsort(row, n, sizeof *row, by_node);
  for (int i = 0; i < n; ++i) {
    PASS_GROW(b->links, b->n_link, b->link_capacity);
    b->links[b->n_link++] = (link){row[i].node, row[i].part[0]};
  }
  m->to.start[q + 1] = b->n_link;
  return OK;
}

static status set_links(builder *b) {
  node_links *l = &b->out->to;
  const size_t dim = l->dim;
  OWNS(b->out);
  PASS_NEW_ALL(OF(l->master, b->n_link), OF(l->part, dim * b->n_link));
  for (size_t e = 0; e < (size_t)b->n_link; ++e) {
    l->master[e] = b->links[e].master;
    for (size_t c = 0; c < dim; ++c) l->part[dim * e + c] = b->links[e].part;
  }
  return OK;
}

static void set_gap(builder *b, int q) {
  const int dim = b->in->mesh->dim, node = b->out->node_id[q];
  const node_links *l = &b->out->to;
  const double *x = mortar_place(b->in, node);
  double *gap = b->out->gap + (size_t)dim * q;
  for (size_t e = l->start[q]; e < l->start[q + 1]; ++e)
    for (int c = 0; c < dim; ++c)
      gap[c] +=
          l->part[dim * e] * (mortar_place(b->in, l->master[e])[c] - x[c]);
  for (size_t a = b->start[node]; a < b->start[node + 1]; ++a) {
    const face_part *f = &b->face[b->around[a]];
    add_scaled(dim,
               -f->bulge[corner_of(b, b->around[a], node)] / b->out->area[q],
               f->normal, gap);
  }
}

static status new_nodes(mortar *m, int dim) {
  OWNS(m);
  m->to.dim = dim;
  m->to.n = m->n;
  PASS_NEW_REALS(dim * m->n, &m->lever, &m->normal, &m->gap);
  PASS_NEW_ALL(OF(m->node_id, m->n), OF(m->area, m->n), OF(m->whole, m->n),
               OF(m->share, m->n), OF(m->to.start, m->n + 1));
  return OK;
}

static status set_nodes(builder *b) {
  mortar *m = b->out;
  int n = 0;
  PASS(new_nodes(m, b->in->mesh->dim));
  for (int i = 0; i < b->in->mesh->n_node; ++i)
    if (b->state[i] == CARRIES) m->node_id[n++] = i;
  OWNED_NEW(entry, row, longest_row(b));
  for (int q = 0; q < b->out->n; ++q) PASS(add_row(b, q, row));
  PASS(set_links(b));
  PASS(set_node_normals(b));
  for (int q = 0; q < m->n; ++q) {
    set_normal(b, q);
    set_gap(b, q);
    set_resultant(b, q);
  }
  return OK;
}

/* What messages need. */
static status sum_up(builder *b) {
  mortar *m = b->out;
  double masters = 0.0, slaves = 0.0;
  OWNS(m);
  PASS_NEW(m->cut, b->in->n_slave);
  for (int i = 0; i < b->in->n_slave; ++i) {
    const face_part *f = &b->face[i];
    double area = 0.0, whole = 0.0;
    for (int k = 0; k < b->in->mesh->dim; ++k) {
      whole += f->share[k];
      if (f->thin > 0.0) area += f->d[k] / f->thin;
    }
    m->covered += area;
    if (area > seen * whole && area < (1.0 - seen) * whole)
      m->cut[m->n_cut++] = b->in->slave[i];
    m->n_bare += area > 0 && f->end == f->first;
    masters += f->masters;
    slaves += f->end > f->first ? area * f->size : 0;
  }
  m->size_ratio = slaves > 0 ? masters / slaves : 0;
  return OK;
}

static status builder_new(const mortar_input *in, mortar *out, builder *b) {
  const size_t n = in->mesh->n_node;
  *b = (builder){.in = in, .out = out};
  PASS_NEW_ALL(OF(b->state, n), OF(b->face, in->n_slave),
               OF(b->met, in->mesh->n_face), OF(b->slot, n),
               OF(b->steps.first, in->n_slave + 1));
  for (size_t i = 0; i < n; ++i) b->slot[i] = -1;
  PASS(mortar_around(b->in, b->in->n_slave, b->in->slave, &b->start,
                     &b->around));
  set_states(b);
  if (!in->flat) {
    PASS_NEW(b->bulge, 3 * in->mesh->n_face);
    PASS(bulge_find(in, in->n_slave, in->slave, b->bulge));
    PASS(bulge_find(in, in->n_master, in->master, b->bulge));
    if (largest_entry(3 * (size_t)in->mesh->n_face, b->bulge) == 0)
      b->bulge = NULL;
  }
  return partner_search_new(in, &b->search);
}

status mortar_couple(const mortar_input *in, mortar **out) {
  builder b;
  PASS_NEW(*out, 1);
  SCRATCH;
  PASS(builder_new(in, *out, &b));
  PASS(do_faces(&b));
  for (int i = 0; i < in->mesh->n_node; ++i) b.slot[i] = -1;
  PASS(set_nodes(&b));
  return sum_up(&b);
}

/* ---- links ---- */

/* Component c of row q; 1: there was something to move. */
static int share(const tie_set *t, int q, int c, double *F) {
  const node_links *l = &t->to;
  double *own = F + (ptrdiff_t)l->dim * t->node_id[q] + c, f = *own;
  int moves = 0;
  for (size_t e = l->start[q]; e < l->start[q + 1] && f != 0.0; ++e) {
    const double part = l->part[l->dim * e + c];
    F[(ptrdiff_t)l->dim * l->master[e] + c] += part * f;
    moves |= part != 0.0;
  }
  if (moves) *own = 0.0;
  return moves;
}

/* Masters that are tied themselves pass it on: a pass for each link. */
void ties_share(const tie_set *t, double *F) {
  for (int more = 1; more;) {
    more = 0;
    for (int k = 0; k < t->to.dim * t->n; ++k)
      more |= share(t, k / t->to.dim, k % t->to.dim, F);
  }
}
