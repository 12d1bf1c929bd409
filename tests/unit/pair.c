/* src/contact/pair.c: which nodes of two surfaces are in a pair, what the rows
 * of the contact surface are relative to, messages. Surfaces without bodies. */
#include "support/faces.h"
#include "support/unit.h"

/* The node at a place, new if there is none. */
static int node_at(face_scene *c, const double *at) {
  const int dim = c->m.dim;
  for (int i = 0; i < c->m.n_node; ++i) {
    double far = 0;
    for (int k = 0; k < dim; ++k) far += fabs(c->x[dim * i + k] - at[k]);
    if (far < 1e-9) return i;
  }
  double x[3] = {0};
  memcpy(x, at, (size_t)dim * sizeof *x);
  return faces_node(c, x[0], x[1], x[2]);
}

/* n edges; the body is on the left of the way from a to b. */
static void add_line(face_scene *c, int n, const double *a, const double *b) {
  int v[2] = {node_at(c, a), 0};
  for (int i = 1; i <= n; ++i) {
    const double s = (double)i / n;
    v[1] = node_at(
        c, (double[]){(1 - s) * a[0] + s * b[0], (1 - s) * a[1] + s * b[1]});
    faces_face(c, v[0], v[1], 0);
    v[0] = v[1];
  }
}

/* n x n squares of two triangles on the sides a, b; normal a x b. */
static void add_square(face_scene *c, int n, const double *at, const double *a,
                       const double *b) {
  for (int k = 0; k < n * n; ++k) {
    int v[4];
    for (int q = 0; q < 4; ++q) {
      const double s = (double)(k % n + (q == 1 || q == 2)) / n;
      const double t = (double)(k / n + q / 2) / n;
      double x[3];
      for (int d = 0; d < 3; ++d) x[d] = at[d] + s * a[d] + t * b[d];
      v[q] = node_at(c, x);
    }
    faces_face(c, v[0], v[1], v[2]);
    faces_face(c, v[0], v[2], v[3]);
  }
}

/* The faces since "first" as a group. */
static mesh_group *group_from(face_scene *c, const char *name, int first) {
  const int id = c->m.n_group++;
  mesh_group *g = &c->group[id];
  char used[FACES_MAX] = {0};
  ck_assert_int_lt(id, FACES_GROUPS);
  *g = (mesh_group){.name = name, .dim = c->m.dim - 1};
  g->item_id = c->item[id];
  g->node_id = c->group_node[id];
  for (int f = first; f < c->m.n_face; ++f) {
    g->item_id[g->n_item++] = f;
    for (int k = 0; k < c->m.dim; ++k) used[c->face[c->m.dim * f + k]] = 1;
  }
  for (int i = 0; i < c->m.n_node; ++i)
    if (used[i]) g->node_id[g->n_node++] = i;
  return g;
}

/* master NULL: the wall. */
static contact_pair *add_pair(face_scene *c, const mesh_group *slave,
                              const mesh_group *master) {
  contact_pair *p = &c->pair[c->in.n_pair++];
  c->support[0] = (obstacle){.name = "WALL", .shape = OBSTACLE_CONFORMING};
  *p = (contact_pair){.card = "*CONTACT PAIR",
                      .name = "P",
                      .group = slave,
                      .master = master,
                      .support = master == NULL ? c->support : NULL};
  return p;
}

static status build(face_scene *c) {
  const status st = pairs_couple(&c->in, c->log);
  return st != OK ? st : surface_build(&c->in, c->log, &c->s);
}

static double noise(unsigned *seed) {
  *seed = *seed * 1103515245u + 12345u;
  return ((*seed >> 8) & 0xffff) / 65535.0 - 0.5;
}

/* The sum of the parts of component k of contact node q: 1, or 0 of none. */
static double part_sum(const face_scene *c, int q, int k) {
  const node_links *l = c->s->master;
  double sum = 0;
  for (size_t e = l->start[q]; e < l->start[q + 1]; ++e)
    sum += l->part[(size_t)l->dim * e + (size_t)k];
  return sum;
}

/* Forces on both sides do the work of the relative displacements, and are found
 * again from their sums at the nodes. */
static void check_forces(const contact_surface *s, int n_node) {
  double u[3 * FACES_MAX], w[3 * FACES_MAX], r[3 * FACES_MAX],
      F[3 * FACES_MAX] = {0};
  double again[3 * FACES_MAX], work = 0;
  const int n = s->dim * s->n, dim = s->dim;
  unsigned char fixed[3 * FACES_MAX];
  unsigned seed = 1;
  for (int i = 0; i < s->dim * n_node; ++i) u[i] = noise(&seed);
  for (int i = 0; i < n; ++i) r[i] = noise(&seed);
  surface_relative(s, u, w);
  surface_spread(s, 1, r, F);
  for (int i = 0; i < s->dim * n_node; ++i) work -= F[i] * u[i];
  for (int i = 0; i < n; ++i) work += r[i] * w[i];
  ck_assert_double_eq_tol(work, 0, 1e-13);
  ck_assert_int_eq(surface_forces(s, n_node, F, again), OK);
  for (int i = 0; i < n; ++i) ck_assert_double_eq_tol(again[i], r[i], 1e-13);
  /* row by row; what supports prescribe of it */
  for (int i = 0; i < n; ++i) {
    const int q = i / dim, a = i % dim;
    const double *row = s->frame + dim * i;
    double v[3], along = 0, own = 0;
    surface_motion(s, u, q, a, v);
    for (int k = 0; k < dim; ++k) {
      along += row[k] * v[k];
      own += row[k] * u[dim * s->node_id[q] + k] / surface_share(s, q, a);
    }
    ck_assert_double_eq_tol(along, w[i], 1e-13);
    for (int held = 0; held < 2; ++held) {
      memset(fixed, held, sizeof fixed);
      ck_assert_double_eq_tol(surface_prescribed(s, fixed, u, q, a),
                              held ? w[i] : w[i] - own, 1e-13);
    }
    ck_assert(surface_is_mutual(s, q, a) ||
              s->master->start[q] < s->master->start[q + 1]);
  }
}

/* ---- nodes --------------------------------------------------------------- */

/* Pairs side by side: a common node is of the earlier one. The displacements
 * (x, 2 x) move all alike. */
TEST(node_of_two_pairs_is_of_the_first) {
  FACE_SCENE c;
  faces_begin(&c, 2);
  for (int p = 0; p < 3; ++p) {
    int first = c.m.n_face;
    add_line(&c, 3, (double[]){p, 0}, (double[]){p + 1, 0});
    const mesh_group *slave = group_from(&c, "SLAVE", first);
    first = c.m.n_face;
    add_line(&c, 4, (double[]){p + 1, -0.1}, (double[]){p, -0.1});
    add_pair(&c, slave, group_from(&c, "MASTER", first));
  }
  ck_assert_int_eq(build(&c), OK);
  ck_assert_int_eq(c.s->n, 10);
  double u[2 * FACES_MAX], w[2 * FACES_MAX];
  for (int i = 0; i < c.m.n_node; ++i)
    for (int k = 0; k < 2; ++k) u[2 * i + k] = (k + 1) * c.x[2 * i];
  surface_relative(c.s, u, w);
  for (int q = 0; q < 10; ++q) {
    ck_assert_int_eq(c.s->side_id[q], -1);
    ck_assert_int_eq(c.s->contact_id[q],
                     (int)fmax(0, ceil(c.s->x[2 * q] - 1.001)));
    for (int k = 0; k < 2; ++k) {
      ck_assert_double_eq_tol(part_sum(&c, q, k), 1, 1e-13);
      ck_assert_double_eq_tol(w[2 * q + k], 0, 1e-13);
    }
  }
  for (int p = 1; p < 3; ++p) ck_assert_int_eq(c.pair[p].coupled->n, 3);
}

/* Three masters below one node, whose joints lie within its faces: its gap is
 * the mean of theirs by area, 1/8, 3/4, 1/8 of 1; also where the middle one
 * leans a little, not where it has
 * another clearance: then no node is left to it. */
TESTS(node_above_three_masters_has_the_mean_gap, 4) {
  static const double end[] = {1.5, 0.5, -0.5, -1.5}, lean[] = {0, 0, 1e-2, 0};
  const quantity change = {.number = 0.1};
  const int differs = _i == 1, held = _i == 3;
  FACE_SCENE c;
  faces_begin(&c, 2);
  add_line(&c, 2, (double[]){-1, 0}, (double[]){1, 0});
  c.fixed[0] = held ? 2 : 0;
  const mesh_group *slave = group_from(&c, "SLAVE", 0);
  for (int p = 0; p < 3; ++p) {
    const int first = c.m.n_face;
    add_line(&c, 1, (double[]){end[p], p == 2 ? lean[_i] - 0.1 : -0.1},
             (double[]){end[p + 1], p == 1 ? lean[_i] - 0.1 : -0.1});
    contact_pair *pair = add_pair(&c, slave, group_from(&c, "MASTER", first));
    pair->change = &change;
    pair->change_sign = differs && p == 1 ? 1 : -1;
  }
  ck_assert_int_eq(build(&c), differs ? ERR_DECK : OK);
  ck_assert_int_eq(faces_said(&c, "P4034") > 0, !differs);
  ck_assert_int_eq(faces_said(&c, "P4010") > 0, differs);
  ck_assert(differs || c.s->n == (held ? 2 : 3));
  for (int q = 0; !differs && q < c.s->n; ++q) {
    ck_assert_int_eq(c.s->side_id[q], -1);
    ck_assert_double_eq_tol(part_sum(&c, q, 0), 1, 1e-14);
    if (_i > 0) continue;
    ck_assert_double_eq_tol(c.s->gap0[q], 0.1, 1e-14);
    ck_assert_double_eq_tol(c.s->area[q], q == 1 ? 1.0 : 0.5, 1e-14);
  }
}

/* The normal that counts is that of the common node, at the other end of a bent
 * slave. */
TEST(normals_are_compared_where_the_pairs_meet) {
  FACE_SCENE c;
  faces_begin(&c, 2);
  add_line(&c, 4, (double[]){0, 1}, (double[]){0, 0});
  add_line(&c, 4, (double[]){0, 0}, (double[]){1, 0});
  const mesh_group *bent = group_from(&c, "BENT", 0);
  add_line(&c, 3, (double[]){-0.1, 0}, (double[]){-0.1, 1});
  add_line(&c, 3, (double[]){1, -0.1}, (double[]){0, -0.1});
  add_pair(&c, bent, group_from(&c, "ROUND", 8));
  add_line(&c, 4, (double[]){1, 0}, (double[]){2, 0});
  const mesh_group *flat = group_from(&c, "FLAT", 14);
  add_line(&c, 3, (double[]){2, -0.1}, (double[]){1, -0.1});
  add_pair(&c, flat, group_from(&c, "BELOW", 18));
  ck_assert_int_eq(build(&c), OK);
  ck_assert_int_eq(c.pair[1].coupled->n, 4);
  for (int q = 0; q < c.s->n; ++q) ck_assert_int_eq(c.s->side_id[q], -1);
}

/* Four edges on three. */
static void flat_pair(face_scene *c) {
  faces_begin(c, 2);
  add_line(c, 4, (double[]){0, 0}, (double[]){1, 0});
  const mesh_group *slave = group_from(c, "SLAVE", 0);
  add_line(c, 3, (double[]){1, -0.1}, (double[]){0, -0.1});
  add_pair(c, slave, group_from(c, "MASTER", 4));
}

TEST(nodes_held_along_the_normal_are_left_to_their_neighbours) {
  FACE_SCENE c;
  flat_pair(&c);
  c.fixed[0] = c.fixed[4] = 2;
  ck_assert_int_eq(build(&c), OK);
  ck_assert(faces_said(&c, "P4002"));
  ck_assert(faces_said(&c, "left out of contact: 2"));
  ck_assert_int_eq(c.pair[0].coupled->n, 3);
  ck_assert_int_eq(c.s->n, 3);
  double area = 0;
  for (int q = 0; q < 3; ++q) {
    ck_assert_int_eq(c.s->node_id[q], q + 1);
    ck_assert_double_eq_tol(part_sum(&c, q, 0), 1, 1e-14);
    area += c.s->area[q];
  }
  ck_assert_double_eq_tol(area, 1, 1e-14);
  ck_assert_int_eq(c.pair[0].coupled->n_dropped, 2);
  check_forces(c.s, c.m.n_node);
}

/* The slave moved by (1/2, 1/16): coupled there with UPDATE, three of its nodes
 * meet the master; the gap is that of time 0 all the same. */
TEST(moved_slave_has_the_gap_of_its_start) {
  for (int update = 0; update < 2; ++update) {
    FACE_SCENE c;
    double u[2 * FACES_MAX] = {0}, w[2 * FACES_MAX];
    flat_pair(&c);
    for (int i = 0; i < 5; ++i) u[2 * i] = 0.5, u[2 * i + 1] = 0.0625;
    c.fixed[0] = 2;
    c.in.u = u;
    c.pair[0].update = update;
    ck_assert_int_eq(build(&c), OK);
    ck_assert_int_eq(c.s->n, update ? 2 : 4);
    surface_relative(c.s, u, w);
    for (int q = 0; q < c.s->n; ++q) {
      ck_assert_double_eq_tol(c.s->gap0[q], 0.1, 1e-14);
      ck_assert_double_eq_tol(w[2 * q], -0.0625, 1e-14);
    }
  }
}

/* ---- rows ---------------------------------------------------------------- */

/* It is where supports hold the masters too, and do not tie them. */
TEST(held_tangent_is_relative_to_none) {
  for (int k = 0; k < 3; ++k) { /* masters are free, held, tied */
    FACE_SCENE c;
    int tied[FACES_MAX];
    flat_pair(&c);
    c.fixed[0] = 1;
    tie_set ties = {.node_id = tied};
    for (int i = 5; i < c.m.n_node && k > 0; ++i) {
      c.fixed[i] = k == 1 ? 1 : 0xff;
      if (k == 2) tied[ties.n++] = i;
    }
    c.in.ties = &ties;
    ck_assert_int_eq(build(&c), OK);
    ck_assert_int_eq(c.s->n, 5);
    for (int q = 0; q < 5; ++q) {
      ck_assert_int_eq(c.s->held[2 * q + 1], q == 0);
      ck_assert_double_eq_tol(part_sum(&c, q, 0), 1, 1e-14);
      ck_assert_double_eq_tol(part_sum(&c, q, 1), q != 0 || k == 1, 1e-14);
    }
  }
}

static const double lean[3] = {-0.3, 0, 1};

/* The edge along y of a floor, which begins at x = "from", and a leaning wall
 * or an obstacle in its place. The first node of the floor, of the wall. */
static void build_edge(face_scene *c, int with_wall, double from,
                       int first[2]) {
  static const double ex[3] = {1, 0, 0}, ey[3] = {0, 1, 0};
  faces_begin(c, 3);
  add_square(c, 2, (double[]){0, 0, 0}, ey, ex);
  const mesh_group *below = group_from(c, "BELOW", 0);
  add_square(c, 2, (double[]){0, 0, 0}, lean, ey);
  const mesh_group *side = group_from(c, "SIDE", 8);
  first[0] = c->m.n_node;
  add_square(c, 3, (double[]){from, 0, -0.1}, ex, ey);
  add_pair(c, below, group_from(c, "FLOOR", 16));
  first[1] = c->m.n_node;
  add_square(c, 3, (double[]){-0.2, 0, 0}, ey, lean);
  const mesh_group *beside = group_from(c, "WALL", 34);
  add_pair(c, side, with_wall ? beside : NULL);
  ck_assert_int_eq(build(c), OK);
}

/* Each normal has its own partner, the tangent along the edge none. */
TESTS(rows_at_an_edge_are_relative_to_their_own_partner, 2) {
  static const double floor[3] = {1, 2, 3}, wall[3] = {4, 5, 6};
  const double length = sqrt(1.09);
  const int with_wall = _i;
  int first[2];
  FACE_SCENE c;
  build_edge(&c, with_wall, 0, first);
  double u[3 * FACES_MAX] = {0}, w[3 * FACES_MAX];
  for (int i = first[0]; i < c.m.n_node; ++i)
    memcpy(u + 3 * i, i < first[1] ? floor : wall, sizeof floor);
  surface_relative(c.s, u, w);
  int n_edge = 0;
  for (int q = 0; q < c.s->n; ++q) {
    if (c.s->side_id[2 * q] < 0) continue;
    ++n_edge;
    ck_assert_double_eq_tol(part_sum(&c, q, 0), 1, 1e-14);
    ck_assert_double_eq_tol(part_sum(&c, q, 1), with_wall, 1e-14);
    ck_assert_double_eq_tol(part_sum(&c, q, 2), 0, 1e-14);
    ck_assert_double_eq_tol(w[3 * q], 3, 1e-13);
    ck_assert_double_eq_tol(w[3 * q + 1],
                            with_wall ? (4 + 0.3 * 6) / length : 0, 1e-13);
    ck_assert_double_eq_tol(w[3 * q + 2], 0, 1e-13);
    ck_assert_double_eq_tol(c.s->apart[3 * q], 0.1, 1e-14);
    ck_assert_double_eq_tol(c.s->apart[3 * q + 1], with_wall ? 0.2 / length : 0,
                            1e-14);
  }
  ck_assert_int_eq(n_edge, 3);
  check_forces(c.s, c.m.n_node);
}

/* What the floor covers of a node, and where the force of its row acts, are the
 * same with a wall beside it. */
TEST(floor_covers_what_it_does_without_a_wall) {
  face_scene c[2];
  int first[2], n_edge = 0;
  for (int k = 0; k < 2; ++k) build_edge(&c[k], k, 0.25, first);
  ck_assert_int_eq(c[0].s->n, c[1].s->n);
  for (int q = 0; q < c[0].s->n; ++q) {
    const contact_surface *a = c[0].s, *b = c[1].s;
    ck_assert_int_eq(a->node_id[q], b->node_id[q]);
    if (a->side_id[2 * q] < 0 || b->side_id[2 * q] < 0) continue;
    ++n_edge;
    ck_assert_double_lt(a->covered[q], 0.9);
    ck_assert_double_eq_tol(a->covered[q], b->covered[q], 1e-14);
    ck_assert_double_eq_tol(a->share[3 * q], b->share[3 * q], 1e-14);
    for (int x = 0; x < 3; ++x)
      ck_assert_double_eq_tol(a->lever[9 * q + x], b->lever[9 * q + x], 1e-14);
  }
  ck_assert_int_eq(n_edge, 3);
  for (int k = 0; k < 2; ++k) faces_end(&c[k]);
}

TESTS(normal_is_the_mean_or_that_of_the_slave, 2) {
  const double slope = 0.1, angle = _i ? atan(slope) : 0.5 * atan(slope);
  FACE_SCENE c;
  faces_begin(&c, 2);
  add_line(&c, 4, (double[]){0, 0.1}, (double[]){1, 0.1 + slope});
  const mesh_group *slave = group_from(&c, "SLAVE", 0);
  add_line(&c, 5, (double[]){1.1, 0}, (double[]){-0.1, 0});
  add_pair(&c, slave, group_from(&c, "MASTER", 4))->how =
      _i ? COUPLE_SLAVE_NORMAL : 0;
  ck_assert_int_eq(build(&c), OK);
  ck_assert_int_eq(c.s->n, 5);
  for (int q = 0; q < 5; ++q) {
    ck_assert_double_eq_tol(c.s->frame[4 * q], sin(angle), 1e-14);
    ck_assert_double_eq_tol(c.s->frame[4 * q + 1], -cos(angle), 1e-14);
  }
}

/* ---- messages ------------------------------------------------------------ */

/* n edges on one; in two that meet at an angle where the slave is curved. */
TESTS(coarse_masters_are_told, 4) {
  static const struct {
    int n;
    double bend;
    int told;
  } cases[] = {{3, 0, 0}, {5, 0, 1}, {3, 0.1, 1}, {1, 0.1, 0}};
  FACE_SCENE c;
  faces_begin(&c, 2);
  const double y = cases[_i].bend;
  add_line(&c, cases[_i].n, (double[]){0, y}, (double[]){1, 0});
  add_line(&c, cases[_i].n, (double[]){1, 0}, (double[]){2, y});
  const mesh_group *slave = group_from(&c, "SLAVE", 0);
  const int first = c.m.n_face;
  add_line(&c, 1, (double[]){2, y - 0.1}, (double[]){1, -0.1});
  add_line(&c, 1, (double[]){1, -0.1}, (double[]){0, y - 0.1});
  add_pair(&c, slave, group_from(&c, "MASTER", first));
  ck_assert_int_eq(build(&c), OK);
  ck_assert_int_eq(faces_said(&c, "P4024"), cases[_i].told);
}

/* Two meshes of a curve that is the steeper the farther from x = 0, where a
 * support makes a plane of symmetry: the end bends as its other half does. */
TEST(curves_go_on_behind_planes_of_symmetry) {
  double apart[2];
  for (int held = 0; held < 2; ++held) {
    FACE_SCENE c;
    faces_begin(&c, 2);
    add_line(&c, 4, (double[]){0, 0}, (double[]){1, 0});
    const mesh_group *slave = group_from(&c, "SLAVE", 0);
    add_line(&c, 7, (double[]){1, -0.1}, (double[]){0, -0.1});
    add_pair(&c, slave, group_from(&c, "MASTER", 4));
    for (int i = 0; i < c.m.n_node; ++i) {
      const double x = c.x[2 * i];
      c.x[2 * i + 1] = x * x * (0.25 + 0.1 * x * x);
      c.fixed[i] = (unsigned char)(held && x == 0);
    }
    ck_assert_int_eq(build(&c), OK);
    ck_assert_int_eq(c.s->node_id[0], 0);
    apart[held] = fabs(c.s->gap0[0]);
  }
  ck_assert_double_le(apart[1], 0.3 * apart[0]);
}

TEST(surfaces_that_do_not_meet_are_an_error) {
  FACE_SCENE c;
  faces_begin(&c, 2);
  add_line(&c, 4, (double[]){0, 0}, (double[]){1, 0});
  const mesh_group *slave = group_from(&c, "SLAVE", 0);
  add_line(&c, 3, (double[]){3, -0.1}, (double[]){2, -0.1});
  add_pair(&c, slave, group_from(&c, "MASTER", 4));
  ck_assert_int_eq(build(&c), ERR_DECK);
  ck_assert(faces_said(&c, "P4023"));
}

TEST(pair_whose_nodes_are_all_held_is_an_error) {
  FACE_SCENE c;
  flat_pair(&c);
  memset(c.fixed, 2, 5);
  ck_assert_int_eq(build(&c), ERR_DECK);
  ck_assert(faces_said(&c, "P4010"));
  ck_assert(!faces_said(&c, "P4023"));
}

UNIT_MAIN("pair")
