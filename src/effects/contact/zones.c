/*
 * Zones of stick, slip and separation with their ends between the nodes.
 *
 * At the edge of a closed zone the pressure p goes to zero like the root of the
 * distance d (Hertz). At the edge of a zone of stick so does what is left of
 * the sliding limit, w = (g - |r_t|)/area, when a shear grows (Cattaneo,
 * Mindlin), but like d^(3/2) when the zone grows under a pressure (Spence). So
 * p^2, and w^2 or w^(2/3), are linear there: the squares are extended from the
 * last node of the zone to zero over its neighbour inside (in 3-D along the
 * gradient over the faces inside). w^(2/3) stays linear over several elements:
 * a line of least squares removes the scatter of the nodes and of the
 * increments; the power with the smaller misfit is taken. Without a neighbour
 * inside, or with values that grow outwards, the end is put half way to the
 * next node.
 */
#include "effects/plan/effect.h"
#include "run/history/loop.h"

#include "run/column_row.h"

/* Nodes that a line is fitted through; with more the curvature matters. */
enum { FIT_NODES = 8 };

/* A set of contact nodes and the traction that vanishes at its edge. */
typedef struct level {
  unsigned char *in; /* [n] */
  double *square;    /* [n] its square, over a power of two */
  double *slope;     /* [dim*n] 3-D: its gradient over the faces inside */
  double *weight;    /* [n] 3-D: area of these faces */
} level;

/* The contact nodes as a chain along the tangent t, plane and axisymmetric. */
typedef struct finder {
  run *r;
  zone_list *out;
  int dim;
  int *index; /* [n_node] contact node of a mesh node, or -1 */
  level closed, stick;
  int *next, *next_face; /* [n] along the chain, -1: none */
  int *before;           /* [n] the node before, -1: none */
} finder;

static status level_new(int dim, int n, level *l) {
  PASS_NEW_ALL(OF(l->in, n), OF(l->square, n), OF(l->slope, dim * n),
               OF(l->weight, n));
  return OK;
}

static status finder_new(run *r, finder *z) {
  const contact_surface *s = r->surface;
  z->r = r;
  z->dim = s->dim;
  PASS_NEW(z->index, r->msh->n_node);
  for (int i = 0; i < r->msh->n_node; ++i) z->index[i] = -1;
  for (int i = 0; i < s->n; ++i) z->index[s->node_id[i]] = i;
  PASS(level_new(z->dim, s->n, &z->closed));
  PASS(level_new(z->dim, s->n, &z->stick));
  PASS_NEW_ALL(OF(z->next, s->n), OF(z->next_face, s->n), OF(z->before, s->n));
  return OK;
}

static double tangential(const run *r, int i) {
  const double *rt = &r->now.rc[r->msh->dim * i + 1];
  return r->msh->dim == 2 ? fabs(rt[0]) : hypot(rt[0], rt[1]);
}

/* Values of any size to squares whose largest is about 1. */
static void level_square(level *l, int n) {
  int power;
  frexp(largest_entry(n, l->square), &power);
  for (int i = 0; i < n; ++i) {
    const double w = ldexp(l->square[i], -power);
    l->square[i] = w * w;
  }
}

static void set_levels(finder *z) {
  const run *r = z->r;
  for (int i = 0; i < r->nodes.n; ++i) {
    double area = r->surface->area[i], scale = area > 0.0 ? 1.0 / area : 0.0;
    z->closed.in[i] = r->result.contact[i] != CONTACT_OPEN;
    z->stick.in[i] = r->result.contact[i] == CONTACT_STICK;
    z->closed.square[i] = -scale * r->now.rc[z->dim * i];
    z->stick.square[i] =
        r->result.g == NULL ? 0.0 : scale * (r->result.g[i] - tangential(r, i));
  }
  level_square(&z->closed, r->nodes.n);
  level_square(&z->stick, r->nodes.n);
}

/* Contact nodes of a face, node[dim]; 0 if one of them is not in contact. */
static int face_nodes(const finder *z, int face_id, int *node) {
  int all = 1;
  for (int k = 0; k < z->dim; ++k) {
    node[k] = z->index[z->r->msh->face[z->dim * face_id + k]];
    all &= node[k] >= 0;
  }
  return all;
}

static void difference(const finder *z, int from, int to, double *d) {
  const double *x = z->r->surface->x;
  d[2] = 0.0;
  vector_of(z->dim, x + z->dim * from, x + z->dim * to, d);
}

/* Gradient of the P1 function with the values w at the nodes of a triangle,
 * times its area, into g[3]; the area. */
static double face_gradient(const finder *z, const int *node, const double *w,
                            double *g) {
  double a[3], b[3], normal[3], part[3];
  CLEAR(g, 3);
  difference(z, node[0], node[1], a);
  difference(z, node[0], node[2], b);
  cross(a, b, normal);
  double twice = sqrt(dot(3, normal, normal));
  for (int k = 0; k < 3; ++k) {
    difference(z, node[(k + 1) % 3], node[(k + 2) % 3], a);
    cross(normal, a, part);
    for (int c = 0; c < 3; ++c) g[c] += part[c] / twice * w[node[k]] / 2;
  }
  return twice / 2;
}

static void add_slopes(const finder *z, const mesh_group *group, level *l) {
  for (int f = 0; f < group->n_item; ++f) {
    int node[3] = {0}, inside = 1;
    double g[3];
    if (!face_nodes(z, group->item_id[f], node)) continue;
    for (int k = 0; k < z->dim; ++k) inside &= l->in[node[k]];
    if (!inside) continue;
    double measure = face_gradient(z, node, l->square, g);
    for (int k = 0; k < z->dim; ++k) {
      l->weight[node[k]] += measure;
      for (int c = 0; c < z->dim; ++c) l->slope[z->dim * node[k] + c] += g[c];
    }
  }
}

/* Part of the distance from node i of the set to node j outside. */
static double face_reach(const finder *z, const level *l, int i, int j) {
  double apart[3], fall = 0.0;
  if (l->weight[i] <= 0.0) return 0.5;
  difference(z, i, j, apart);
  for (int c = 0; c < z->dim; ++c)
    fall -= apart[c] * l->slope[z->dim * i + c] / l->weight[i];
  return fall > 0.0 ? fmin(1.0, l->square[i] / fall) : 0.5;
}

static double distance(const finder *z, int i, int j) {
  double apart[3] = {0};
  difference(z, i, j, apart);
  return sqrt(dot(3, apart, apart));
}

/* Nodes of the zone from node i at its edge inwards, away from j: as many as
 * the fit may use, at most half the zone. */
static int edge_nodes(const finder *z, const level *l, int i, int j,
                      int node[FIT_NODES]) {
  const int *inwards = z->next[i] == j ? z->before : z->next;
  int n = 0;
  for (int k = i; k >= 0 && l->in[k] && n < 2 * FIT_NODES; k = inwards[k]) {
    if (n < FIT_NODES) node[n] = k;
    ++n;
  }
  return n <= 6 ? (n < 3 ? n : 3) : n / 2;
}

/* Where the square to a power extends to zero, by least squares through n nodes
 * that go inwards: length from node[0] outwards, HUGE_VAL if it does not fall.
 * *misfit, in [0, 1], measures the distance of the nodes from it. */
static double extend(const finder *z, const level *l, int n, const int *node,
                     double power, double *misfit) {
  double s[FIT_NODES] = {0}, y[FIT_NODES], ms = 0.0, my = 0.0;
  double ss = 0.0, sy = 0.0, yy = 0.0;
  for (int k = 0; k < n; ++k) {
    if (k > 0) s[k] = s[k - 1] + distance(z, node[k - 1], node[k]);
    y[k] = pow(l->square[node[k]], power);
    ms += s[k] / n;
    my += y[k] / n;
  }
  for (int k = 0; k < n; ++k) {
    ss += (s[k] - ms) * (s[k] - ms);
    sy += (s[k] - ms) * (y[k] - my);
    yy += (y[k] - my) * (y[k] - my);
  }
  *misfit = yy > 0.0 ? 1.0 - sy / ss * sy / yy : 1.0;
  return sy > 0.0 ? fmax(0.0, my * (ss / sy) - ms) : HUGE_VAL;
}

static double line_reach(const finder *z, const level *l, int i, int j) {
  int node[FIT_NODES], n = edge_nodes(z, l, i, j, node);
  double root_misfit, other_misfit, length = distance(z, i, j);
  if (n < 2) return 0.5;
  double end = extend(z, l, 2, node, 1.0, &root_misfit);
  if (n >= 3 && l == &z->stick) {
    double other = extend(z, l, n, node, 1.0 / 3, &other_misfit);
    extend(z, l, n, node, 1.0, &root_misfit);
    if (other_misfit < root_misfit) end = other;
  }
  return end < HUGE_VAL ? fmin(1.0, end / length) : 0.5;
}

static double level_reach(const finder *z, const level *l, int i, int j) {
  return z->dim == 3 ? face_reach(z, l, i, j) : line_reach(z, l, i, j);
}

/* The same; a zone of stick ends at the latest where the contact does. */
static double reach(const finder *z, const level *l, int i, int j) {
  const double part = level_reach(z, l, i, j);
  return z->closed.in[j] ? part : fmin(part, level_reach(z, &z->closed, i, j));
}

/* ---- in three dimensions: areas ------------------------------------------ */

/* Area of the part of a triangle that belongs to the set. */
static double part_of_face(const finder *z, const level *l, const int *node) {
  double w[3], unused[3];
  int n = 0, odd = 0;
  for (int k = 0; k < 3; ++k) n += l->in[node[k]];
  if (n == 0) return 0.0;
  double area = face_gradient(z, node, l->square, unused);
  if (n == 3) return area;
  for (int k = 0; k < 3; ++k)
    if (l->in[node[k]] == (n == 1)) odd = k;
  for (int k = 1; k < 3; ++k) {
    int other = node[(odd + k) % 3];
    w[k] = n == 1 ? reach(z, l, node[odd], other)
                  : 1.0 - reach(z, l, other, node[odd]);
  }
  return n == 1 ? area * w[1] * w[2] : area * (1.0 - w[1] * w[2]);
}

static status add_zone(zone_list *out, const contact_zone *zone) {
  OWNS(out);
  PASS_GROW(out->zone, out->n, out->cap);
  out->zone[out->n++] = *zone;
  return OK;
}

static status find_areas(const finder *z, int contact_id) {
  const mesh_group *group = z->r->faces.pairs[contact_id].group;
  double whole = 0.0, closed = 0.0, stick = 0.0;
  contact_zone zone = {.contact_id = contact_id};
  for (int f = 0; f < group->n_item; ++f) {
    int node[3];
    double unused[3];
    if (!face_nodes(z, group->item_id[f], node)) continue;
    whole += face_gradient(z, node, z->closed.square, unused);
    closed += part_of_face(z, &z->closed, node);
    stick += part_of_face(z, &z->stick, node);
  }
  const double area[] = {whole - closed, closed - stick, stick};
  for (int kind = CONTACT_OPEN; kind <= CONTACT_STICK; ++kind) {
    zone.kind = kind;
    zone.area = area[kind];
    PASS(add_zone(z->out, &zone));
  }
  return OK;
}

/* ---- in the plane: along the contact line -------------------------------- */

/* Direction of the slip along t; 0 without friction or slip, as at a corner. */
static int slip_sign(const finder *z, int i) {
  if (z->r->result.contact[i] != CONTACT_SLIP ||
      surface_is_corner(z->r->surface, i))
    return 0;
  double rt = z->r->now.rc[2 * i + 1];
  return (rt < 0.0) - (rt > 0.0);
}

/* Part of the distance from node i to the next one, j, where the zone ends. */
static double zone_end(const finder *z, int i, int j) {
  const level *l = &z->closed;
  if (z->closed.in[i] && z->closed.in[j]) l = &z->stick;
  if (z->r->result.contact[i] != z->r->result.contact[j])
    return l->in[i] ? reach(z, l, i, j) : 1.0 - reach(z, l, j, i);
  double a = fabs(z->r->result.slip[i]), b = fabs(z->r->result.slip[j]);
  return a + b > 0.0 ? a / (a + b) : 0.5;
}

static int same_zone(const finder *z, int i, int j) {
  return z->r->result.contact[i] == z->r->result.contact[j] &&
         slip_sign(z, i) == slip_sign(z, j);
}

/* Of the piece after node i; bodies of a pair touch over the smaller one. */
static double thickness_at(const finder *z, int i) {
  const run *r = z->r;
  const mesh_group *g = r->faces.pairs[r->surface->contact_id[i]].master;
  double w = r->faces.face_weight[z->next_face[i]];
  for (int k = 0; g != NULL && k < g->n_item; ++k)
    w = fmin(w, r->faces.face_weight[g->item_id[k]]);
  return w;
}

/* Add the piece from part a to b of the distance from node i to the next. */
static void add_piece(const finder *z, int i, double a, double b,
                      contact_zone *zone) {
  double apart[3];
  const run *r = z->r;
  difference(z, i, z->next[i], apart);
  double length = distance(z, i, z->next[i]) * (b - a);
  double radius = r->surface->x[2 * i] + 0.5 * (a + b) * apart[0];
  zone->length += length;
  zone->area += length * (r->faces.input.axisymmetric ? 2 * acos(-1.0) * radius
                                                      : thickness_at(z, i));
}

static void set_point(const finder *z, int i, double part, double *x) {
  double apart[3] = {0.0, 0.0, 0.0};
  if (part > 0.0) difference(z, i, z->next[i], apart);
  for (int c = 0; c < 2; ++c)
    x[c] = z->r->surface->x[2 * i + c] + part * apart[c];
}

/* The zone that begins with node j: half a piece before it, where the line is a
 * ring and another zone ends between i and j, -1 at the end of a line. */
static contact_zone first_zone(const finder *z, int contact_id, int i, int j) {
  contact_zone zone = {.contact_id = contact_id,
                       .kind = (int)z->r->result.contact[j],
                       .direction = slip_sign(z, j)};
  if (i < 0 || same_zone(z, i, j)) {
    set_point(z, j, 0.0, zone.from);
    return zone;
  }
  double begin = zone_end(z, i, j);
  set_point(z, i, begin, zone.from);
  add_piece(z, i, begin, 1.0, &zone);
  return zone;
}

static status walk(const finder *z, int contact_id, int start) {
  int i = start;
  contact_zone zone = first_zone(z, contact_id, z->before[start], start);
  for (int j; (j = z->next[i]) >= 0; i = j) {
    if (same_zone(z, i, j)) {
      add_piece(z, i, 0.0, 1.0, &zone);
    } else {
      double end = zone_end(z, i, j);
      add_piece(z, i, 0.0, end, &zone);
      set_point(z, i, end, zone.to);
      PASS(add_zone(z->out, &zone));
      if (j == start) return OK;
      zone = first_zone(z, contact_id, i, j);
    }
    if (j == start) break;
  }
  set_point(z, z->next[i] == start ? start : i, 0.0, zone.to);
  return add_zone(z->out, &zone);
}

/* Where to cut a closed line: before a node that begins a zone. */
static int cut_ring(const finder *z, int start) {
  for (int i = start;; i = z->next[i]) {
    if (!same_zone(z, i, z->next[i])) return z->next[i];
    if (z->next[i] == start) return start;
  }
}

static status find_lines(finder *z, int contact_id) {
  const mesh_group *group = z->r->faces.pairs[contact_id].group;
  int n = z->r->nodes.n, node[3];
  for (int i = 0; i < n; ++i) z->next[i] = z->before[i] = -1;
  for (int f = 0; f < group->n_item; ++f) {
    if (!face_nodes(z, group->item_id[f], node)) continue;
    z->next[node[0]] = node[1];
    z->next_face[node[0]] = group->item_id[f];
    z->before[node[1]] = node[0];
  }
  for (int pass = 0; pass < 2; ++pass)
    for (int i = 0; i < n; ++i) {
      if (z->next[i] < 0 || (pass == 0 && z->before[i] >= 0)) continue;
      int start = pass == 0 ? i : cut_ring(z, i);
      PASS(walk(z, contact_id, start));
      for (int k = start, next; k >= 0; k = next) {
        next = z->next[k];
        z->next[k] = -1;
      }
    }
  return OK;
}

static status find_zones(run *r, void *self) {
  SCRATCH;
  finder z = {.out = self};
  z.out->n = 0;
  PASS(finder_new(r, &z));
  set_levels(&z);
  for (int i = 0; i < r->m->n.contact && z.dim == 3; ++i) {
    add_slopes(&z, r->faces.pairs[i].group, &z.closed);
    add_slopes(&z, r->faces.pairs[i].group, &z.stick);
  }
  for (int i = 0; i < r->m->n.contact; ++i)
    PASS(z.dim == 3 ? find_areas(&z, i) : find_lines(&z, i));
  return OK;
}

static int requires_zones(const model *m, const reason *why) {
  return plan_requires_table(m, PRINT_ZONES, why);
}

static effect_work expected(const plan_sizes *s) {
  const double n = plan_rows(s, PRINT_ZONES, s->contact);
  const double shown = plan_shown(s->m, PRINT_ZONES);
  return (effect_work){n, "nodes", shown, shown * n * 100.0};
}

static int zones_due(const run *r) {
  return r->nodes.n > 0 && table_is_due_now(r, PRINT_ZONES);
}

static const contact_zone *zone_of(const view *v, int id) {
  const zone_list *own = effect_state(v->s->effects, &zones_effect);
  return &own->zone[id];
}

VALUE(zone_kind, zone_of(v, id)->kind)
VALUE(zone_contact_no, zone_of(v, id)->contact_id + 1)
VALUE(zone_direction, zone_of(v, id)->direction)
VALUE(zone_from, zone_of(v, id)->from[part])
VALUE(zone_to, zone_of(v, id)->to[part])
VALUE(zone_length, zone_of(v, id)->length)
VALUE(zone_area, zone_of(v, id)->area)

WORD_OF(zone_word, status_word(zone_of(v, id)->kind))
WORD_OF(zone_contact_name, v->m->contacts[zone_of(v, id)->contact_id].name)
/* clang-format off */
#define ZONE PER_ZONE, AS_REAL, PRINT_ZONES, C
#define EDGE(name, scene, part, at, help) \
  {name, "length", ZONE, scene, 0, NULL, part, at, NULL, help}
static const column columns[] = {
{"contact", "-", PER_ZONE, AS_WORD, PRINT_ZONES, C, SCENE_ALL, 0,
 NULL, 0, zone_contact_no, zone_contact_name, "name of the *CONTACT"},
{"zone", "-", PER_ZONE, AS_WORD, PRINT_ZONES, C, SCENE_ALL, 0, NULL,
 0, zone_kind, zone_word, "OPEN, SLIP, STICK; as number 0, 1, 2"},
{"direction", "-", PER_ZONE, AS_COUNT, PRINT_ZONES, F, SCENE_FLAT, 0,
 NULL, 0, zone_direction, NULL, "sign of the slip along the tangent"},
EDGE("x_from", SCENE_PLANE, 0, zone_from, "where the zone begins"),
EDGE("y_from", SCENE_PLANE, 1, zone_from, "where the zone begins"),
EDGE("x_to", SCENE_PLANE, 0, zone_to, "where the zone ends"),
EDGE("y_to", SCENE_PLANE, 1, zone_to, "where the zone ends"),
EDGE("r_from", SCENE_AXI, 0, zone_from, "where the zone begins"),
EDGE("z_from", SCENE_AXI, 1, zone_from, "where the zone begins"),
EDGE("r_to", SCENE_AXI, 0, zone_to, "where the zone ends"),
EDGE("z_to", SCENE_AXI, 1, zone_to, "where the zone ends"),
{"extent", "length", ZONE, SCENE_FLAT, 0, NULL, 0, zone_length, NULL,
 "length along the contact line"},
{"area", "length^2", ZONE, SCENE_ALL, 0, NULL, 0, zone_area, NULL,
 "area of the zone, of the whole turn in axisymmetry"}};

const effect_ops zones_effect = {
  .name = "table of zones", .bit = NO_BIT, .required = requires_zones,
  .expected = expected, .own = STAGE_ZONES, .table = {PRINT_ZONES, PER_ZONE},
  .items = offsetof(zone_list, n), .size = sizeof(zone_list),
  .copy_as = COPY_IS_NEW, .on = {.due = zones_due, .accept = find_zones},
  COLUMNS_OF(columns)};
/* clang-format on */
