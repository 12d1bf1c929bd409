/*
 * What the body and its loads are more than linear between the nodes. A
 * surface is curved where the faces at a node are smooth: it is beyond a face,
 * by the normals at its corners, by
 *
 *   o = 4 sum over edges of la lb B_ab,  B_ab = (n_b - n_a).(x_b - x_a)/8,
 *
 * and loads given by a formula have their value there. In space the rim of a
 * loaded surface is curved where its edges at a node are smooth: by their
 * outward normals along the surface a part of the area 2/3 B_ab |x_b - x_a|
 * lies beyond an edge. The forces
 *
 *   dF v = F(v) - F_h(v) - integral of sigma : e(v) over the part beyond
 *
 * are in no residual at the nodes: a goal with the adjoint y lacks dF y.
 */
#include "base/base.h"
#include "effects/goal/parts.h"

static const double SMOOTH = 0.86; /* -, cosine between faces of a surface */

/* A face, or an element for a load in the body. */
typedef struct patch {
  int n, node[4]; /* its corners */
  int elem;       /* of a face */
  double weight;  /* measure times thickness */
  double normal[3];
  double of[4][3]; /* of the surface at its corners, if it is curved */
  double B[3][3];  /* of the edges of a face, m */
  double g[4][3];  /* gradients of the P1 functions along a face, 1/m */
  int is_curved;
} patch;

/* A point of a patch and of the surface beyond it. */
typedef struct spot {
  double b[4], x[3], on[3]; /* barycentric; of the patch; of the surface */
  double beyond, slope[3];  /* o, m; its gradient along the face */
  double area[3];           /* of the surface over that of the patch, outward */
  double weight;            /* of the patch */
} spot;

/* Gauss points, n of a simplex with n corners, of degree 3 on a line, else 2:
 * barycentric coordinate of point k in corner k. */
static const double AT[5] = {
    [2] = 0.78867513459481288, [3] = 2.0 / 3.0, [4] = 0.58541019662496847};

/* Barycentric coordinates of the corners of piece number k of a simplex with n
 * corners, halved again and again, where pieces = 2^i. */
static void piece_of(int n, int k, int pieces, double corner[4][4]) {
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) corner[i][j] = i == j;
  for (; pieces > 1; pieces /= 2, k /= 2) {
    double middle[4];
    for (int j = 0; j < n; ++j)
      middle[j] = 0.5 * (corner[0][j] + corner[n - 1][j]);
    if (k % 2 == 1) COPY(corner[0], corner[n - 1], n);
    for (int i = n - 1; i > 1; --i) COPY(corner[i], corner[i - 1], n);
    COPY(corner[1], middle, n);
  }
}

void goal_rule_point(int n, int k, int pieces, double *b) {
  double corner[4][4];
  piece_of(n, k / n, pieces, corner);
  CLEAR(b, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      b[i] += corner[j][i] * (j == k % n ? AT[n] : (1.0 - AT[n]) / (n - 1));
}

/* s->area of a curved patch. In space the surface is o beyond it along the
 * normals of its corners, which meet those of the patches around: along its own
 * there would be gaps between, of as much area as o makes. */
static void set_area(const mesh *m, const patch *p, spot *s) {
  double side[2][3];
  for (int c = 0; c < 3; ++c) s->area[c] = p->normal[c] - s->slope[c];
  if (m->dim == 2 || !p->is_curved) return;
  for (int a = 0; a < 2; ++a) {
    const double *x[2] = {m->x + 3 * p->node[0], m->x + 3 * p->node[a + 1]};
    double along = 0.0;
    for (int c = 0; c < 3; ++c) along += s->slope[c] * (x[1][c] - x[0][c]);
    for (int c = 0; c < 3; ++c) {
      double normal = 0.0;
      for (int i = 0; i < 3; ++i) normal += s->b[i] * p->of[i][c];
      side[a][c] = x[1][c] - x[0][c] + along * normal +
                   s->beyond * (p->of[a + 1][c] - p->of[0][c]);
    }
  }
  double flat[2][3], whole[3];
  for (int a = 0; a < 2; ++a)
    vector_of(3, m->x + 3 * p->node[0], m->x + 3 * p->node[a + 1], flat[a]);
  cross(flat[0], flat[1], whole);
  cross(side[0], side[1], s->area);
  const double twice = dot(3, whole, p->normal);
  for (int c = 0; c < 3; ++c) s->area[c] /= twice;
}

/* Point k of a patch in pieces. */
static spot spot_in(const mesh *m, const patch *p, int k, int pieces) {
  spot s = {.weight = p->weight / p->n / pieces};
  goal_rule_point(p->n, k, pieces, s.b);
  for (int i = 0; i < p->n; ++i)
    for (int c = 0; c < m->dim; ++c)
      s.x[c] += s.b[i] * m->x[m->dim * p->node[i] + c];
  for (int i = 0; i < p->n && p->is_curved; ++i)
    for (int j = i + 1; j < p->n; ++j) {
      s.beyond += 4.0 * s.b[i] * s.b[j] * p->B[i][j];
      for (int c = 0; c < m->dim; ++c)
        s.slope[c] +=
            4.0 * p->B[i][j] * (s.b[i] * p->g[j][c] + s.b[j] * p->g[i][c]);
    }
  for (int c = 0; c < 3; ++c) s.on[c] = s.x[c] + s.beyond * p->normal[c];
  set_area(m, p, &s);
  return s;
}

static spot spot_at(const mesh *m, const patch *p, int k) {
  return spot_in(m, p, k, 1);
}

/* ---- faces --------------------------------------------------------------- */

/* 1: a face of the mesh has the nodes v[dim] of a side of its element. */
static int has_face(const mesh *m, const size_t *start, const int *at,
                    const int *v) {
  int any = 0;
  for (size_t k = start[v[0]]; k < start[v[0] + 1]; ++k)
    any |= memcmp(m->face + m->dim * at[k], v, m->dim * sizeof *v) == 0;
  return any;
}

status goal_add_faces(const mesh *m, const goal_border *b, mesh *out) {
  const int dim = m->dim, most = m->n_face + b->n;
  OWNED_PARTS(smooth_faces, rings, smooth_faces_new(m, &rings));
  *out = *m;
  PASS_NEW_ALL(OF(out->face, dim * most), OF(out->face_elem, most),
               OF(out->face_other, most));
  COPY(out->face, m->face, dim * m->n_face);
  COPY(out->face_elem, m->face_elem, m->n_face);
  COPY(out->face_other, m->face_other, m->n_face);
  for (int k = 0; k < b->n; ++k) {
    int *v = out->face + dim * out->n_face;
    mesh_side_nodes(m, b->side[k], v);
    if (has_face(m, rings.start, rings.face, v)) continue;
    out->face_elem[out->n_face] = b->side[k] / (dim + 1);
    out->face_other[out->n_face++] = -1;
  }
  return OK;
}

/* The edges of face f that are curved, to e; their number. */
static int bent_edges(const run *r, const smooth_faces *rings, int f,
                      bent_edge *e) {
  const int dim = r->msh->dim, *node = r->msh->face + dim * f;
  int n = 0;
  for (int a = 0; a < dim; ++a)
    for (int b = a + 1; b < dim; ++b) {
      const int first = node[a] < node[b] ? a : b;
      const int v[2] = {node[first], node[a + b - first]};
      bent_edge now = {.a = v[0], .b = v[1]};
      smooth_bulge(r, rings, f, v, now.out);
      if (largest_entry(dim, now.out) > 0.0) e[n++] = now;
    }
  return n;
}

/* Of both faces of an edge: the mean of one surface; where two meet, the edge
 * is on both. */
static void join_bent(bent_edge *e, const bent_edge *other) {
  const double share = fabs(dot(3, e->out, other->out)) <
                               SMOOTH * sqrt(dot(3, e->out, e->out) *
                                             dot(3, other->out, other->out))
                           ? 1.0
                           : 0.5;
  for (int c = 0; c < 3; ++c) e->out[c] = share * (e->out[c] + other->out[c]);
}

status goal_add_bent(const run *r, const smooth_faces *rings, goal_surface *s) {
  const mesh *m = r->msh;
  int kept = 0, n = 0;
  PASS_NEW(s->bent, m->n_face * (m->dim == 3 ? 3 : 1));
  for (int f = 0; f < m->n_face; ++f)
    if (m->face_other[f] < 0) n += bent_edges(r, rings, f, s->bent + n);
  PAIR_SORT(s->bent, n);
  for (int k = 0; k < n; ++k)
    if (kept == 0 || number_pair_order(&s->bent[kept - 1], &s->bent[k]) != 0)
      s->bent[kept++] = s->bent[k];
    else
      join_bent(&s->bent[kept - 1], &s->bent[k]);
  s->n_bent = kept;
  return OK;
}

static void set_bulges(const run *r, const smooth_faces *rings, patch *p) {
  const mesh *m = r->msh;
  double length = 0.0, most = 0.0;
  for (int i = 0; i < p->n; ++i)
    smooth_normal(r, rings, p->node[i], p->normal, p->of[i]);
  for (int i = 0; i < p->n; ++i)
    for (int j = i + 1; j < p->n; ++j) {
      for (int c = 0; c < m->dim; ++c) {
        const double d =
            m->x[m->dim * p->node[j] + c] - m->x[m->dim * p->node[i] + c];
        p->B[i][j] += (p->of[j][c] - p->of[i][c]) * d / 8.0;
        length = fmax(length, fabs(d));
      }
      most = fmax(most, fabs(p->B[i][j]));
    }
  p->is_curved = most > 1e-9 * length;
}

static patch face_patch(const run *r, const smooth_faces *rings, int face) {
  const mesh *m = r->msh;
  patch p = {.n = m->dim, .elem = m->face_elem[face]};
  const int *v = m->elem + (m->dim + 1) * m->face_elem[face];
  double g[12];
  COPY(p.node, m->face + m->dim * face, m->dim);
  p.weight = mesh_face_normal(m, face, p.normal) *
             model_thickness(r->m, m->face_elem[face]);
  if (m->face_other[face] >= 0) return p;
  set_bulges(r, rings, &p);
  if (!p.is_curved) return p;
  mesh_elem_gradients(m, m->face_elem[face], g);
  for (int i = 0; i < p.n; ++i)
    for (int a = 0; a <= m->dim; ++a) {
      if (v[a] != p.node[i]) continue;
      const double along = dot(m->dim, g + m->dim * a, p.normal);
      for (int c = 0; c < m->dim; ++c)
        p.g[i][c] = g[m->dim * a + c] - along * p.normal[c];
    }
  return p;
}

static double turn_of(const run *r, double radius) {
  return model_is_axisymmetric(r->m) ? 2.0 * M_PI * radius : 1.0;
}

/* What lies beyond a face, m3. */
static double volume_beyond(const run *r, const patch *p) {
  double volume = 0.0;
  for (int k = 0; k < p->n && p->is_curved; ++k) {
    const spot s = spot_at(r->msh, p, k);
    volume += s.weight * s.beyond * turn_of(r, s.x[0]);
  }
  return volume;
}

status goal_volumes_beyond(const run *r, double *volume) {
  OWNED_PARTS(smooth_faces, rings, smooth_faces_new(r->msh, &rings));
  for (int f = 0; f < r->msh->n_face; ++f) {
    const patch p = face_patch(r, &rings, f);
    volume[r->msh->face_elem[f]] += volume_beyond(r, &p);
  }
  return OK;
}

status goal_places(const run *r, int **where) {
  PASS_NEW(*where, r->msh->n_node);
  for (int i = 0; i < r->msh->n_node; ++i) (*where)[i] = -1;
  for (int q = 0; q < r->nodes.n; ++q) (*where)[r->surface->node_id[q]] = q;
  return OK;
}

/* T less its traction on the face along a direction a, along which the motion
 * of the surface is prescribed: T:grad y without y beyond the face. */
static void take_traction(int dim, const double *n, const double *a,
                          double T[3][3]) {
  double traction = 0.0;
  for (int c = 0; c < dim; ++c)
    for (int k = 0; k < dim; ++k) traction += a[c] * T[c][k] * n[k];
  for (int c = 0; c < dim; ++c)
    for (int k = 0; k < dim; ++k) T[c][k] -= traction * a[c] * n[k];
}

/* Of the supports and the closed contact of a face; where[n_node]. */
static void take_given(const run *r, const patch *p, const int *where,
                       double T[3][3]) {
  const int dim = r->msh->dim;
  int closed = 1;
  for (int c = 0; c < dim; ++c) {
    double a[3] = {c == 0, c == 1, c == 2};
    int held = 1;
    for (int i = 0; i < p->n; ++i)
      held &= r->body.d.fixed[dim * p->node[i] + c];
    if (held) take_traction(dim, p->normal, a, T);
  }
  for (int i = 0; i < p->n; ++i) {
    const int q = where[p->node[i]];
    closed &= q >= 0 && r->result.contact[q] != CONTACT_OPEN;
  }
  for (int c = 0; c < dim && closed; ++c)
    take_traction(dim, p->normal, (double[3]){c == 0, c == 1, c == 2}, T);
}

/* Less the stress of the element times the strains beyond a face. */
static void add_part_beyond(const run *r, const patch *p, int face,
                            const int *where, double *dF) {
  const mesh *m = r->msh;
  const int dim = m->dim, e = m->face_elem[face], *v = m->elem + (dim + 1) * e;
  const double *t = r->result.stress + (size_t)r->body.d.ns * e;
  double T[3][3] = {{t[0], t[3], dim == 3 ? t[5] : 0.0},
                    {t[3], t[1], dim == 3 ? t[4] : 0.0},
                    {dim == 3 ? t[5] : 0.0, dim == 3 ? t[4] : 0.0, t[2]}};
  const double volume = volume_beyond(r, p);
  double g[12];
  take_given(r, p, where, T);
  mesh_elem_gradients(m, e, g);
  for (int k = 0; k < p->n && model_is_axisymmetric(r->m); ++k) {
    const spot s = spot_at(m, p, k);
    for (int i = 0; i < p->n; ++i)
      dF[2 * p->node[i]] -= s.weight * s.beyond * 2.0 * M_PI * s.b[i] * t[2];
  }
  for (int a = 0; a <= dim; ++a)
    for (int c = 0; c < dim; ++c)
      for (int k = 0; k < dim; ++k)
        dF[dim * v[a] + c] -= volume * T[c][k] * g[dim * a + k];
}

/* ---- loads --------------------------------------------------------------- */

int goal_load_varies(const load *l) {
  return (quantity_variables(&l->value) & 7u) != 0 ||
         (l->has_before && (quantity_variables(&l->before) & 7u) != 0);
}

/* Direction of a load on the patch, and beyond it with a ratio of areas. */
static void directions(const load *l, int dim, const patch *p, const spot *s,
                       double *flat, double *bent) {
  const double area = p->is_curved ? sqrt(dot(dim, s->area, s->area)) : 1.0;
  for (int c = 0; c < dim; ++c) {
    const double along = c == l->component;
    flat[c] = l->kind == LOAD_PRESSURE ? -p->normal[c] : along;
    bent[c] = l->kind == LOAD_PRESSURE ? -s->area[c] : along * area;
  }
}

/* A force at the surface beyond a point of a curved patch: the functions of all
 * nodes of its element have changed from the patch on. */
static void add_beyond(const mesh *m, const patch *p, const spot *s,
                       const double *force, double *dF) {
  const int *v = m->elem + (m->dim + 1) * p->elem;
  double g[12];
  if (!p->is_curved) return;
  mesh_elem_gradients(m, p->elem, g);
  for (int a = 0; a <= m->dim; ++a)
    for (int c = 0; c < m->dim; ++c)
      dF[m->dim * v[a] + c] +=
          force[c] * s->beyond * dot(m->dim, g + m->dim * a, p->normal);
}

static void add_load(const run *r, const load *l, const patch *p, double *dF) {
  const mesh *m = r->msh;
  double value[4], flat[3], bent[3], force[3];
  if (!p->is_curved && !goal_load_varies(l)) return;
  const int pieces = goal_load_varies(l) ? GOAL_PIECES : 1;
  for (int i = 0; i < p->n; ++i)
    value[i] = load_at_node(l, m, r->step, p->node[i], r->now.t);
  for (int k = 0; k < p->n * pieces; ++k) {
    const spot s = spot_in(m, p, k, pieces);
    const double linear = dot(p->n, s.b, value);
    const double there = load_at_point(l, r->step, s.on, r->now.t);
    if (!isfinite(there)) continue;
    directions(l, m->dim, p, &s, flat, bent);
    for (int c = 0; c < m->dim; ++c)
      force[c] = s.weight * there * bent[c] * turn_of(r, s.on[0]);
    add_beyond(m, p, &s, force, dF);
    for (int c = 0; c < m->dim; ++c) {
      const double more =
          force[c] - s.weight * linear * flat[c] * turn_of(r, s.x[0]);
      for (int i = 0; i < p->n; ++i)
        dF[m->dim * p->node[i] + c] += s.b[i] * more;
    }
  }
}

/* ---- the rim of a loaded surface in space -------------------------------- */

typedef struct rim_edge {
  int v[2]; /* ascending */
  int face;
  double length, out[3]; /* m; unit normal along the face, outward */
} rim_edge;

/* The edge of a face opposite to corner k. */
static rim_edge edge_of(const mesh *m, int face, int k) {
  const int *v = m->face + 3 * face, a = v[(k + 1) % 3], b = v[(k + 2) % 3];
  rim_edge e = {{a < b ? a : b, a < b ? b : a}, face, 0.0, {0.0}};
  double along[3];
  for (int c = 0; c < 3; ++c) {
    along[c] = m->x[3 * b + c] - m->x[3 * a + c];
    e.out[c] = m->x[3 * a + c] - m->x[3 * v[k] + c];
    e.length = hypot(e.length, along[c]);
  }
  const double part = dot(3, e.out, along) / (e.length * e.length);
  for (int c = 0; c < 3; ++c) e.out[c] -= part * along[c];
  goal_make_unit(3, e.out);
  return e;
}

/* e[*n] sorted: edges of one face of the group; new. */
static status rim_new(const mesh *m, const mesh_group *g, rim_edge **e,
                      int *n) {
  int kept = 0;
  *n = 3 * g->n_item;
  PASS_NEW(*e, *n);
  for (int i = 0; i < *n; ++i) (*e)[i] = edge_of(m, g->item_id[i / 3], i % 3);
  PAIR_SORT(*e, *n);
  for (int i = 0, last; i < *n; i = last) {
    last = PAIR_END(*e, *n, i);
    if (last == i + 1) (*e)[kept++] = (*e)[i];
  }
  *n = kept;
  return OK;
}

/* Of the rim at end k of an edge, as smooth_normal, along the surface that is
 * smooth there; next[2*n] the other end with the same node in a ring. */
static void out_at(const run *r, const smooth_faces *rings, const rim_edge *e,
                   const int *next, int k, double *out) {
  const rim_edge *own = e + k / 2;
  const unsigned char *held = r->body.d.fixed + 3 * own->v[k % 2];
  int at = k;
  CLEAR(out, 3);
  do {
    const rim_edge *other = e + at / 2;
    for (int c = 0; c < 3 && dot(3, own->out, other->out) >= SMOOTH; ++c)
      out[c] += other->length * other->out[c];
    at = next[at];
  } while (at != k);
  smooth_mirror(3, held, own->out, out);
  double face[3], normal[3];
  mesh_face_normal(r->msh, own->face, face);
  smooth_normal(r, rings, own->v[k % 2], face, normal);
  add_scaled(3, -dot(3, out, normal), normal, out);
  goal_make_unit(3, out);
}

static void add_beyond_edge(const run *r, const load *l, const rim_edge *e,
                            const double *turn, double *dF) {
  const mesh *m = r->msh;
  double x[3], normal[3], bulge = 0.0;
  for (int c = 0; c < 3; ++c) {
    const double *a = m->x + 3 * e->v[0], *b = m->x + 3 * e->v[1];
    bulge += turn[c] * (b[c] - a[c]) / 8.0;
    x[c] = 0.5 * (a[c] + b[c]);
  }
  const double value = load_at_point(l, r->step, x, r->now.t);
  if (!(fabs(bulge) > 1e-9 * e->length) || !isfinite(value)) return;
  mesh_face_normal(m, e->face, normal);
  for (int c = 0; c < 3; ++c)
    for (int k = 0; k < 2; ++k)
      dF[3 * e->v[k] + c] +=
          bulge * e->length / 3.0 * value *
          (l->kind == LOAD_PRESSURE ? -normal[c] : c == l->component);
}

static status add_rim(const run *r, const smooth_faces *rings, const load *l,
                      double *dF) {
  const mesh *m = r->msh;
  OWNED int *next = NULL, *last = NULL;
  int n;
  OWNED_OF(rim_edge, e, rim_new(m, &m->group[l->group_id], &e, &n));
  PASS_NEW_ALL(OF(next, 2 * n), OF(last, m->n_node));
  for (int k = 0; k < 2 * n; ++k) {
    int *at = &last[e[k / 2].v[k % 2]];
    next[k] = *at > 0 ? next[*at - 1] : k;
    if (*at > 0) next[*at - 1] = k;
    *at = k + 1;
  }
  for (int i = 0; i < n; ++i) {
    double out[2][3];
    for (int k = 0; k < 2; ++k) out_at(r, rings, e, next, 2 * i + k, out[k]);
    for (int c = 0; c < 3; ++c) out[1][c] -= out[0][c];
    add_beyond_edge(r, l, e + i, out[1], dF);
  }
  return OK;
}

static patch element_patch(const run *r, int e) {
  const mesh *m = r->msh;
  patch p = {.n = m->dim + 1};
  COPY(p.node, m->elem + p.n * e, p.n);
  p.weight = mesh_elem_measure(m, e) * model_thickness(r->m, e);
  return p;
}

/* A load on bodies on what lies beyond the faces of its elements. */
static status add_body_beyond(const run *r, const smooth_faces *rings,
                              const load *l, double *dF) {
  const mesh *m = r->msh;
  const mesh_group *g = &m->group[l->group_id];
  OWNED_NEW(unsigned char, in, m->n_elem);
  for (int k = 0; k < g->n_item; ++k) in[g->item_id[k]] = 1;
  for (int f = 0; f < m->n_face; ++f) {
    if (m->face_other[f] >= 0 || !in[m->face_elem[f]]) continue;
    const patch p = face_patch(r, rings, f);
    double force[3];
    load_per_value(r->m, l, m->face_elem[f], force);
    for (int k = 0; k < p.n && p.is_curved; ++k) {
      const spot s = spot_at(m, &p, k);
      const double value = load_at_point(l, r->step, s.on, r->now.t);
      if (!isfinite(value)) continue;
      for (int i = 0; i < p.n * m->dim; ++i)
        dF[m->dim * p.node[i / m->dim] + i % m->dim] +=
            s.weight * s.beyond * turn_of(r, s.x[0]) * s.b[i / m->dim] * value *
            force[i % m->dim];
    }
  }
  return OK;
}

static status add_loads(const run *r, const smooth_faces *rings, double *dF) {
  for (EACH(const load, l, r->step->loads.item, r->step->loads.n)) {
    const int on_faces = l->kind == LOAD_PRESSURE || l->kind == LOAD_TRACTION;
    if (l->kind == LOAD_BODY || l->kind == LOAD_GRAVITY)
      PASS(add_body_beyond(r, rings, l, dF));
    if (!on_faces && (l->kind != LOAD_BODY || !goal_load_varies(l))) continue;
    const mesh_group *g = &r->msh->group[l->group_id];
    for (int k = 0; k < g->n_item; ++k) {
      const patch p = on_faces ? face_patch(r, rings, g->item_id[k])
                               : element_patch(r, g->item_id[k]);
      add_load(r, l, &p, dF);
    }
    if (on_faces && r->msh->dim == 3) PASS(add_rim(r, rings, l, dF));
  }
  return OK;
}

status goal_add_boundary(const run *r, double *dF) {
  OWNED_PARTS(smooth_faces, rings, smooth_faces_new(r->msh, &rings));
  OWNED_OF(int, where, goal_places(r, &where));
  for (int f = 0; f < r->msh->n_face; ++f) {
    const patch p = face_patch(r, &rings, f);
    if (p.is_curved) add_part_beyond(r, &p, f, where, dF);
  }
  return add_loads(r, &rings, dF);
}

/* ---- interfaces ---------------------------------------------------------- */

static double slope_of(const mesh *m, int elem, const double *u, int component,
                       const double *along) {
  const int *v = m->elem + (m->dim + 1) * elem;
  double g[12], sum = 0.0;
  mesh_elem_gradients(m, elem, g);
  for (int a = 0; a <= m->dim; ++a)
    for (int c = 0; c < m->dim; ++c)
      sum += u[m->dim * v[a] + component] * g[m->dim * a + c] * along[c];
  return sum;
}

/* Sides between elements of several parts: m with these faces alone, of the
 * lower part[n_elem], as if they were free; back[n_face] the elements behind,
 * new. */
static status between_parts(const mesh *m, const int *part, mesh *out,
                            int **back) {
  const int dim = m->dim, n = (dim + 1) * m->n_elem;
  OWNED size_t *start = NULL;
  OWNED int *elem = NULL;
  PASS(mesh_node_elements(m, &start, &elem));
  *out = *m;
  out->n_face = 0;
  PASS_NEW_ALL(OF(out->face, dim * n), OF(out->face_elem, n),
               OF(out->face_other, n), OF(*back, n));
  for (int side = 0; side < n; ++side) {
    int *v = out->face + dim * out->n_face;
    mesh_side_nodes(m, side, v);
    for (size_t k = start[v[0]]; k < start[v[0] + 1]; ++k) {
      int met = 0;
      for (int i = 0; i < dim * (dim + 1); ++i)
        met += m->elem[(dim + 1) * elem[k] + i / dim] == v[i % dim];
      if (met < dim || part[elem[k]] <= part[side / (dim + 1)]) continue;
      (*back)[out->n_face] = elem[k];
      out->face_other[out->n_face] = -1;
      out->face_elem[out->n_face++] = side / (dim + 1);
      break;
    }
  }
  return OK;
}

static void tensor_of(int dim, const double *t, double T[3][3]) {
  const double all[3][3] = {
      {t[0], t[3], dim == 3 ? t[5] : 0.0},
      {t[3], t[1], dim == 3 ? t[4] : 0.0},
      {dim == 3 ? t[5] : 0.0, dim == 3 ? t[4] : 0.0, t[2]}};
  memcpy(T, all, sizeof all);
}

/* e[6]: the strains of the gradient jump n'. */
static void strain_of(int dim, const double *n, const double *jump, double *e) {
  CLEAR(e, 6);
  for (int c = 0; c < 3; ++c) e[c] = jump[c] * n[c];
  for (int c = 0; c < (dim == 3 ? 3 : 1); ++c)
    e[3 + c] = jump[c] * n[(c + 1) % 3] + jump[(c + 1) % 3] * n[c];
}

/* What of dF the elements on[2] on both sides of an interface beyond its chord
 * by a volume have, the first that within: the traction t[3] is the same on
 * both sides, what the gradient along n has more on the first has the strains
 * e[6]. */
static void add_shifted(const run *r, const patch *p, const int *on,
                        const double *t, const double *e, double *dF) {
  const mesh *m = r->msh;
  const int dim = m->dim;
  const double volume = volume_beyond(r, p);
  double hoop = 0.0;
  for (int side = 0; side < 2; ++side) {
    const int *v = m->elem + (dim + 1) * on[side];
    const double *sigma = r->result.stress + (size_t)r->body.d.ns * on[side];
    const double sign = side == 0 ? 1.0 : -1.0;
    double T[3][3], g[12], more[6];
    element_stress(&r->body.d, on[side], e, more);
    for (int k = 0; k < r->body.d.ns; ++k)
      more[k] = 0.5 * more[k] - sign * sigma[k];
    hoop += more[2];
    tensor_of(dim, more, T);
    mesh_elem_gradients(m, on[side], g);
    for (int a = 0; a <= dim; ++a)
      for (int c = 0; c < dim; ++c)
        dF[dim * v[a] + c] +=
            volume * (sign * t[c] * dot(dim, p->normal, g + dim * a) +
                      dot(dim, T[c], g + dim * a));
  }
  for (int k = 0; k < p->n && model_is_axisymmetric(r->m); ++k) {
    const spot s = spot_at(m, p, k);
    for (int i = 0; i < p->n; ++i)
      dF[2 * p->node[i]] += s.weight * s.beyond * 2.0 * M_PI * s.b[i] * hoop;
  }
}

static void add_interface(const run *r, const patch *p, int back,
                          const goal_shared *to, double *dF) {
  const int dim = r->msh->dim, ns = r->body.d.ns, on[2] = {p->elem, back};
  const double volume = volume_beyond(r, p);
  double t[3] = {0.0}, n[3] = {0.0}, jump[3] = {0.0}, T[3][3], e[6];
  COPY(n, p->normal, dim);
  for (int side = 0; side < 2; ++side) {
    const double sign = side == 0 ? 1.0 : -1.0;
    tensor_of(dim, r->result.stress + (size_t)ns * on[side], T);
    for (int c = 0; c < dim; ++c) {
      t[c] += 0.5 * dot(dim, T[c], n);
      jump[c] += sign * slope_of(r->msh, on[side], r->now.u, c, n);
    }
    to->volume[on[side]] += sign * volume;
  }
  strain_of(dim, n, jump, e);
  for (int side = 0; side < 2; ++side)
    add_scaled(ns, -0.5 * volume, e, to->strain + (size_t)ns * on[side]);
  add_shifted(r, p, on, t, e, dF);
}

status goal_add_interfaces(const run *r, const space_recovery *of, double *dF,
                           goal_shared *to) {
  run seen = *r;
  mesh sides;
  int *back;
  if (space_regions(of) < 2) return OK;
  PASS_NEW_ALL(OF(to->volume, r->msh->n_elem), OF(to->region, r->msh->n_elem),
               OF(to->strain, (size_t)r->m->ns * r->msh->n_elem));
  for (int e = 0; e < r->msh->n_elem; ++e) to->region[e] = space_region(of, e);
  SCRATCH;
  PASS(between_parts(r->msh, to->region, &sides, &back));
  seen.msh = &sides;
  OWNED_PARTS(smooth_faces, rings, smooth_faces_new(&sides, &rings));
  for (int f = 0; f < sides.n_face; ++f) {
    const patch p = face_patch(&seen, &rings, f);
    if (p.is_curved) add_interface(r, &p, back[f], to, dF);
  }
  return OK;
}

status goal_volumes_of(const run *r, const mesh_group *g, const int *region,
                       double *volume) {
  run seen = *r;
  mesh sides;
  int *back;
  SCRATCH;
  OWNED_NEW(int, part, r->msh->n_elem);
  for (int k = 0; k < g->n_item; ++k) part[g->item_id[k]] = -1;
  PASS(between_parts(r->msh, part, &sides, &back));
  seen.msh = &sides;
  OWNED_PARTS(smooth_faces, rings, smooth_faces_new(&sides, &rings));
  for (int f = 0; f < sides.n_face; ++f) {
    const int e = sides.face_elem[f];
    const patch p = face_patch(&seen, &rings, f);
    if (region == NULL || region[e] == region[back[f]])
      volume[e] += volume_beyond(r, &p);
  }
  return OK;
}

/* ---- means --------------------------------------------------------------- */

/* The integral of u less its mean over the surface less that over a face; of a
 * volume, over what is beyond it. */
static double beyond_face(const run *r, const patch *p, const goal_mean *w,
                          double mean) {
  const mesh *m = r->msh;
  const int of_faces = m->group[w->group_id].dim < m->dim;
  const double rise = slope_of(m, p->elem, r->now.u, w->component, p->normal);
  double sum = 0.0;
  for (int k = 0; k < p->n; ++k) {
    const spot s = spot_at(m, p, k);
    double u = -mean;
    for (int i = 0; i < p->n; ++i)
      u += s.b[i] * r->now.u[m->dim * p->node[i] + w->component];
    const double more =
        sqrt(dot(m->dim, s.area, s.area)) * turn_of(r, s.on[0]) -
        turn_of(r, s.x[0]);
    sum +=
        s.weight * (of_faces ? u * more + s.beyond * rise * turn_of(r, s.x[0])
                             : u * s.beyond * turn_of(r, s.x[0]));
  }
  return sum;
}

/* Of the curved faces in[], or all. */
static status beyond_faces(const run *r, const unsigned char *in,
                           const goal_mean *w, double mean, double *sum) {
  const mesh *m = r->msh;
  const int of_faces = m->group[w->group_id].dim < m->dim;
  *sum = 0.0;
  OWNED_PARTS(smooth_faces, rings, smooth_faces_new(m, &rings));
  for (int f = 0; f < m->n_face; ++f) {
    if (m->face_other[f] >= 0 ||
        (in != NULL && !in[of_faces ? f : m->face_elem[f]]))
      continue;
    const patch p = face_patch(r, &rings, f);
    if (p.is_curved) *sum += w->factor * beyond_face(r, &p, w, mean);
  }
  return OK;
}

/* m with the faces of a group between two elements alone, of each of both, as
 * if they were free. */
static status inner_faces(const mesh *m, const mesh_group *g, mesh *out) {
  const int dim = m->dim, n = 2 * g->n_item;
  *out = *m;
  out->n_face = 0;
  PASS_NEW_ALL(OF(out->face, dim * n), OF(out->face_elem, n),
               OF(out->face_other, n));
  for (int k = 0; k < n; ++k) {
    const int f = g->item_id[k / 2], to = out->n_face;
    if (m->face_other[f] < 0) continue;
    COPY(out->face + dim * to, m->face + dim * f, dim);
    for (int i = 0; i < 2 && k % 2 == 1; ++i)
      out->face[dim * to + i] = m->face[dim * f + 1 - i];
    out->face_other[to] = -1;
    out->face_elem[to] = k % 2 == 0 ? m->face_elem[f] : m->face_other[f];
    ++out->n_face;
  }
  return OK;
}

status goal_beyond_mean(const run *r, const goal_mean *w, double mean,
                        double *sum) {
  const mesh *m = r->msh;
  const mesh_group *g = &m->group[w->group_id];
  const int of_faces = g->dim < m->dim;
  run seen = *r;
  mesh sides;
  int *back;
  double inside;
  SCRATCH;
  OWNED_NEW(unsigned char, in, m->n_face + m->n_elem);
  OWNED_NEW(int, part, m->n_elem);
  for (int k = 0; k < g->n_item; ++k) in[g->item_id[k]] = 1;
  PASS(beyond_faces(r, in, w, mean, sum));
  for (int e = 0; e < m->n_elem; ++e) part[e] = -in[e];
  PASS(of_faces ? inner_faces(m, g, &sides)
                : between_parts(m, part, &sides, &back));
  seen.msh = &sides;
  PASS(beyond_faces(&seen, NULL, w, mean, &inside));
  *sum += of_faces ? 0.5 * inside : inside;
  return OK;
}
