/* src/mesh/crack: meshes opened along cracks */
#include "mesh/crack/crack.h"
#include "support/grid.h"
#include "support/inner_group.h"
#include "support/mesh_file.h"
#include "support/unit.h"

/* ---- cracks on the lines of grids with cells of size 1 ---------------------
 */

/* Whether all nodes have lo <= x <= hi. */
static int inside(const mesh *m, const int *node, const double *lo,
                  const double *hi) {
  for (int i = 0; i < m->dim; ++i)
    for (int k = 0; k < m->dim; ++k) {
      double x = m->x[m->dim * node[i] + k];
      if (x < lo[k] || x > hi[k]) return 0;
    }
  return 1;
}

#define IN(...) inside(m, v, (const double[]){__VA_ARGS__},
#define TO(...) (const double[]){__VA_ARGS__})
#define TAKE(name, ...) \
  static int name(const mesh *m, const int *v) { return __VA_ARGS__; }

/* clang-format off */
TAKE(line,       IN(2, 4) TO(6, 4))
TAKE(upright,    IN(4, 2) TO(4, 6))
TAKE(edge,       IN(0, 4) TO(5, 4))
TAKE(kink,       IN(2, 4) TO(4, 4) || IN(4, 4) TO(4, 6))
TAKE(branch,     IN(2, 4) TO(6, 4) || IN(4, 4) TO(4, 7))
TAKE(sideways,   IN(4, 4) TO(6, 4) || upright(m, v))
TAKE(crossing,   line(m, v) || upright(m, v))
TAKE(through,    IN(0, 4) TO(8, 4))
TAKE(ring,       IN(2, 2) TO(6, 2) || IN(2, 6) TO(6, 6) ||
                 IN(2, 2) TO(2, 6) || IN(6, 2) TO(6, 6))
TAKE(short_line, IN(3, 4) TO(4, 4))
TAKE(foot,       IN(0, 0) TO(2, 0) || line(m, v))

TAKE(square,      IN(1, 1, 3) TO(5, 5, 3))
TAKE(wall,        IN(3, 1, 1) TO(3, 5, 5))
TAKE(deep,        IN(0, 0, 3) TO(3, 6, 3))
TAKE(corner,      IN(0, 0, 3) TO(3, 3, 3))
TAKE(plane,       IN(0, 0, 3) TO(6, 6, 3))
TAKE(crossed,     square(m, v) || wall(m, v))
TAKE(three_parts, plane(m, v) || IN(3, 0, 3) TO(3, 6, 6))
TAKE(bent,        IN(1, 1, 3) TO(3, 5, 3) || IN(3, 1, 3) TO(3, 5, 5))
/* clang-format on */

/* y = x + 4, along diagonals of the grid. */
static int on_diagonal(const mesh *m, const int *v) {
  for (int i = 0; i < 2; ++i)
    if (m->x[2 * v[i] + 1] != m->x[2 * v[i]] + 4 || m->x[2 * v[i]] > 2)
      return 0;
  return 1;
}
TAKE(forked_mouth, on_diagonal(m, v) || IN(0, 4) TO(3, 4))

/* Half a square upright, from the end of the front of a corner on; both fronts
 * start there. */
static int on_half(const mesh *m, const int *v) {
  for (int i = 0; i < 3; ++i) {
    const double *x = m->x + 3 * v[i];
    if (x[1] != 3 || x[2] - 3 < x[0]) return 0;
  }
  return 1;
}
TAKE(two_starts, corner(m, v) || on_half(m, v))

static mesh *grid(int dim) {
  mesh *m = dim == 2 ? make_grid_2d((const int[]){8, 8}, (const double[]){8, 8})
                     : make_grid_3d((const int[]){6, 6, 6},
                                    (const double[]){6, 6, 6});
  ck_assert_ptr_nonnull(m);
  return m;
}

typedef struct opened {
  mesh *m;
  mesh_crack crack[2];
  double *measure; /* of the elements before */
  int *elem;       /* before */
  int n_node;      /* before */
  status answer;
  char messages[2048];
} opened;

/* Take over the mesh and open its groups. */
static void open_groups(opened *o, mesh *m, int n, const char *const *names) {
  mesh_cut cut[2];
  OWNED message_log *log = NULL;
  const place at = {.file = "job.inp", .line_no = 7, .column_no = 1};
  size_t size = (size_t)((m->dim + 1) * m->n_elem) * sizeof(int);
  memset(o, 0, sizeof *o);
  o->m = m;
  o->n_node = m->n_node;
  o->elem = malloc(size);
  memcpy(o->elem, m->elem, size);
  o->measure = malloc((size_t)m->n_elem * sizeof *o->measure);
  for (int e = 0; e < m->n_elem; ++e) o->measure[e] = mesh_elem_measure(m, e);
  for (int k = 0; k < n; ++k)
    cut[k] = (mesh_cut){mesh_find_group(m, names[k]), &at};
  ck_assert_int_eq(message_log_new(&log), OK);
  o->answer = mesh_open(m, n, cut, log, o->crack);
  FILE *out = fmemopen(o->messages, sizeof o->messages - 1, "w");
  message_print(log, out);
  fclose(out);
}

static void close_opened(opened *o) {
  memory_free(o->m);
  free(o->elem);
  free(o->measure);
}

static void open_one(opened *o, int dim, take_side *take) {
  mesh *m = grid(dim);
  add_side_group(m, "CRACK", take);
  open_groups(o, m, 1, (const char *const[]){"CRACK"});
}

/* ---- what each opened mesh fulfils -----------------------------------------
 */

static void check_nodes(const opened *o) {
  const mesh *m = o->m;
  size_t last = 0;
  ck_assert_ptr_nonnull(m->origin);
  for (int i = 0; i < m->n_node; ++i) {
    int from = m->origin[i];
    if (i < o->n_node) {
      ck_assert_int_eq(from, i);
      last = m->node_no[i] > last ? m->node_no[i] : last;
      continue;
    }
    ck_assert_int_lt(from, o->n_node);
    for (int k = 0; k < m->dim; ++k)
      ck_assert(m->x[m->dim * i + k] == m->x[m->dim * from + k]);
    ck_assert_uint_gt(m->node_no[i], last);
    last = m->node_no[i];
  }
  for (int k = 0; k < (m->dim + 1) * m->n_elem; ++k)
    ck_assert_int_eq(m->origin[m->elem[k]], o->elem[k]);
  for (int e = 0; e < m->n_elem; ++e)
    ck_assert(mesh_elem_measure(m, e) == o->measure[e]);
}

static int has_nodes(const mesh *m, int elem, int n, const int *v) {
  int found = 0;
  for (int i = 0; i < n; ++i)
    for (int k = 0; k <= m->dim; ++k)
      found += v[i] == m->elem[(m->dim + 1) * elem + k];
  return found == n;
}

/* Elements with all these nodes, counted through all. */
static int count_elements(const mesh *m, int n, const int *v) {
  int count = 0;
  for (int e = 0; e < m->n_elem; ++e) count += has_nodes(m, e, n, v);
  return count;
}

/* Every face is the side of one or two elements and leaves its own. */
static void check_faces(const mesh *m) {
  for (int f = 0; f < m->n_face; ++f) {
    const int *v = m->face + m->dim * f;
    const int *w = m->elem + (m->dim + 1) * m->face_elem[f];
    double normal[3], toward = 0.0;
    ck_assert(has_nodes(m, m->face_elem[f], m->dim, v));
    ck_assert_int_eq(count_elements(m, m->dim, v),
                     m->face_other[f] < 0 ? 1 : 2);
    if (m->face_other[f] >= 0)
      ck_assert(has_nodes(m, m->face_other[f], m->dim, v));
    mesh_face_normal(m, f, normal);
    for (int c = 0; c <= m->dim; ++c)
      for (int k = 0; k < m->dim; ++k)
        toward +=
            normal[k] * (m->x[m->dim * w[c] + k] - m->x[m->dim * v[0] + k]);
    ck_assert_double_lt(toward, 0.0);
  }
}

/* Groups hold the nodes of their items, ascending. */
static void check_groups(const mesh *m) {
  FREED char *used = malloc((size_t)m->n_node);
  for (int i = 0; i < m->n_group; ++i) {
    const mesh_group *g = &m->group[i];
    int n = 0;
    for (int k = 1; k < g->n_node; ++k)
      ck_assert_int_lt(g->node_id[k - 1], g->node_id[k]);
    for (int k = 1; k < g->n_item; ++k)
      ck_assert_int_lt(g->item_id[k - 1], g->item_id[k]);
    if (g->dim < m->dim - 1) continue;
    memset(used, 0, (size_t)m->n_node);
    for (int k = 0; k < (g->dim + 1) * g->n_item; ++k) {
      int item = g->item_id[k / (g->dim + 1)], at = k % (g->dim + 1);
      used[g->dim == m->dim ? m->elem[(m->dim + 1) * item + at]
                            : m->face[m->dim * item + at]] = 1;
    }
    for (int k = 0; k < g->n_node; ++k) ck_assert(used[g->node_id[k]]);
    for (int k = 0; k < m->n_node; ++k) n += used[k];
    ck_assert_int_eq(n, g->n_node);
  }
}

static int at_front(const mesh_crack *c, int node) {
  for (int i = 0; i < c->front_start[c->n_front]; ++i)
    if (c->front_node[i] == node) return 1;
  return 0;
}

static void centre_of(const mesh *m, int n, const int *v, double *x) {
  for (int k = 0; k < m->dim; ++k) {
    x[k] = 0.0;
    for (int i = 0; i < n; ++i) x[k] += m->x[m->dim * v[i] + k] / n;
  }
}

/* Two faces at one place that look at each other and have only nodes of the
 * front in common. */
static void check_lips(const mesh *m, const mesh_crack *c) {
  for (int i = 0; i < c->n; ++i) {
    const int *v = m->face + m->dim * c->plus[i];
    const int *w = m->face + m->dim * c->minus[i];
    double up[3], down[3];
    int same = 0, common = 0;
    if (m->dim == 3) { /* the lowest node first, as in a mesh that is read */
      ck_assert(v[0] < v[1] && v[0] < v[2]);
      ck_assert(w[0] < w[1] && w[0] < w[2]);
    }
    ck_assert_int_eq(m->face_other[c->plus[i]], -1);
    ck_assert_int_eq(m->face_other[c->minus[i]], -1);
    for (int a = 0; a < m->dim; ++a)
      for (int b = 0; b < m->dim; ++b) {
        same += m->origin[v[a]] == m->origin[w[b]];
        common += v[a] == w[b];
        if (v[a] == w[b]) ck_assert(at_front(c, v[a]));
      }
    ck_assert_int_eq(same, m->dim);
    ck_assert_int_lt(common, m->dim);
    mesh_face_normal(m, c->plus[i], up);
    mesh_face_normal(m, c->minus[i], down);
    ck_assert_double_eq_tol(dot(m->dim, up, down), -1.0, 1e-14);
  }
}

/* Edges of a chain belong to both lips of their face, where the crack grows
 * outward, along e1 x e2. */
static void check_front(const mesh *m, const mesh_crack *c) {
  for (int chain = 0; chain < c->n_front; ++chain)
    for (int i = c->front_start[chain]; i < c->front_start[chain + 1]; ++i) {
      const int *a = c->front_node + i, face = c->front_face[i];
      const int last = i + 1 == c->front_start[chain + 1];
      double e1[3], e2[3], e3[3], x[3], middle[3];
      ck_assert_int_eq(m->dim == 3 && last, face < 0);
      if (face < 0) continue;
      ck_assert(has_nodes(m, m->face_elem[c->plus[face]], m->dim - 1, a));
      ck_assert(has_nodes(m, m->face_elem[c->minus[face]], m->dim - 1, a));
      if (m->dim == 2) continue;
      centre_of(m, 3, m->face + 3 * c->plus[face], middle);
      centre_of(m, 2, a, x);
      for (int k = 0; k < 3; ++k) {
        e1[k] = x[k] - middle[k];
        x[k] = m->x[3 * a[1] + k] - m->x[3 * a[0] + k];
      }
      mesh_face_normal(m, c->minus[face], e2);
      cross(e1, e2, e3);
      ck_assert_double_gt(dot(3, e3, x), 0.0);
    }
}

static void check_opened(const opened *o, int n) {
  ck_assert_msg(o->answer == OK, "%s", o->messages);
  check_nodes(o);
  check_faces(o->m);
  check_groups(o->m);
  for (int k = 0; k < n; ++k) {
    check_lips(o->m, &o->crack[k]);
    check_front(o->m, &o->crack[k]);
  }
}

/* ---- counts ----------------------------------------------------------------
 */

typedef struct crack_case {
  const char *name;
  int dim;
  take_side *take;
  int n_face;  /* that open */
  int n_copy;  /* nodes that are new */
  int n_front; /* tips or chains */
  int n_front_node;
  int n_body, most; /* bodies; nodes at one place, at most */
} crack_case;

/* Of the square of 4 x 4 cells one triangle at each of two corners has all
 * nodes on the front and stays closed. */
static const crack_case crack_cases[] = {
    {"inner line", 2, line, 4, 3, 2, 2, 1, 2},
    {"edge crack", 2, edge, 5, 5, 1, 1, 1, 2},
    {"kink", 2, kink, 4, 3, 2, 2, 1, 2},
    {"branch", 2, branch, 7, 4 + 2, 3, 3, 1, 3},
    {"crossing", 2, crossing, 8, 4 + 3, 4, 4, 1, 4},
    {"through", 2, through, 8, 9, 0, 0, 2, 2},
    {"ring", 2, ring, 16, 16, 0, 0, 2, 2},
    {"two cracks with one mouth", 2, forked_mouth, 5, 3 + 2, 2, 2, 1, 3},
    {"inner square", 3, square, 30, 9, 1, 15, 1, 2},
    {"to three surfaces", 3, deep, 36, 21, 1, 7, 1, 2},
    {"to two surfaces", 3, corner, 18, 9, 1, 7, 1, 2},
    {"plane", 3, plane, 72, 49, 0, 0, 2, 2},
    {"planes that cross", 3, crossed, 60, 12 + 3 * 3, 4, 32, 1, 4},
    {"branch in three parts", 3, three_parts, 108, 49 + 21 + 7, 0, 0, 3, 3},
    {"fronts from one node", 3, two_starts, 27, 15, 2, 11, 1, 2},
    {"bent square", 3, bent, 30, 9, 1, 15, 1, 2}};
enum { N_CRACK_CASE = sizeof crack_cases / sizeof *crack_cases };

static int most_copies(const mesh *m) {
  int *n = calloc((size_t)m->n_node, sizeof *n), most = 0;
  for (int i = 0; i < m->n_node; ++i) {
    ++n[m->origin[i]];
    most = n[m->origin[i]] > most ? n[m->origin[i]] : most;
  }
  free(n);
  return most;
}

TEST(cracks_of_all_kinds_open) {
  for (int i = 0; i < N_CRACK_CASE; ++i) {
    const crack_case *c = &crack_cases[i];
    opened o;
    open_one(&o, c->dim, c->take);
    check_opened(&o, 1);
    int n_body, *body = malloc((size_t)o.m->n_elem * sizeof *body);
    ck_assert_int_eq(mesh_bodies(o.m, &n_body, body), OK);
    const mesh_crack *k = &o.crack[0];
    ck_assert_msg(k->n == c->n_face && o.m->n_node - o.n_node == c->n_copy &&
                      k->n_front == c->n_front &&
                      k->front_start[k->n_front] == c->n_front_node &&
                      n_body == c->n_body && most_copies(o.m) == c->most,
                  "%s: %d faces, %d copies, %d fronts with %d nodes, %d "
                  "bodies, %d at one place",
                  c->name, k->n, o.m->n_node - o.n_node, k->n_front,
                  k->front_start[k->n_front], n_body, most_copies(o.m));
    const int branches = c->most > 2 && strstr(c->name, "mouth") == NULL;
    ck_assert_msg((strstr(o.messages, "P3056") != NULL) == branches, "%s: %s",
                  c->name, o.messages);
    free(body);
    close_opened(&o);
  }
}

/* Plus is above: by the last axis in which the normal has a part, of the mesh
 * and of that turned by 180 degrees. */
TEST(plus_is_above) {
  static const struct {
    int dim, axis;
    take_side *take;
  } cases[] = {{2, 1, line},     {2, 0, upright},  {2, 1, branch},
               {2, 1, sideways}, {2, 1, crossing}, {3, 2, square},
               {3, 0, wall},     {3, 2, crossed},  {3, 2, three_parts}};
  for (size_t i = 0; i < 2 * sizeof cases / sizeof *cases; ++i) {
    const int dim = cases[i / 2].dim;
    opened o;
    mesh *m = grid(dim);
    add_side_group(m, "CRACK", cases[i / 2].take);
    for (int k = 0; k < m->n_node && i % 2; ++k) {
      m->x[dim * k] *= -1;
      m->x[dim * k + dim - 1] *= -1;
    }
    open_groups(&o, m, 1, (const char *const[]){"CRACK"});
    for (int f = 0; f < o.crack[0].n; ++f) {
      double normal[3];
      mesh_face_normal(o.m, o.crack[0].minus[f], normal);
      double along = normal[cases[i / 2].axis];
      if (along == 0.0) along = normal[0]; /* the other crack of two */
      ck_assert_double_gt(along, 0.0);
    }
    close_opened(&o);
  }
}

/* Neighbours agree round a kink: from the left over the top to the right. */
TEST(lips_are_turned_alike_round_a_kink) {
  opened o;
  open_one(&o, 2, kink);
  const mesh_group *plus = mesh_find_group(o.m, "CRACK+");
  const mesh_group *minus = mesh_find_group(o.m, "CRACK-");
  ck_assert_int_eq(plus->n_item, 4);
  ck_assert_int_eq(minus->n_item, 4);
  /* (2, 4), (4, 4), (4, 6): the mean normal is (-1, 1) up. */
  for (int i = 0; i < 4; ++i) {
    double normal[2], x[2];
    mesh_face_normal(o.m, plus->item_id[i], normal);
    centre_of(o.m, 2, o.m->face + 2 * plus->item_id[i], x);
    ck_assert(x[0] < 4 ? normal[1] == -1.0 : normal[0] == 1.0);
  }
  /* A node of one lip only, but for the tips: 3 + 2. */
  ck_assert_int_eq(plus->n_node, 5);
  ck_assert_int_eq(minus->n_node, 5);
  ck_assert_int_eq(mesh_find_group(o.m, "CRACK")->n_item, 8);
  ck_assert_int_eq(mesh_find_group(o.m, "CRACK")->n_node, 8);
  ck_assert_int_ne(plus->tag, minus->tag);
  close_opened(&o);
}

/* ---- several cracks, other groups ------------------------------------------
 */

TEST(two_cracks_that_cross_have_fronts_of_their_own) {
  mesh *m = grid(3);
  opened o;
  add_side_group(m, "FLAT", square);
  add_side_group(m, "STEEP", wall);
  open_groups(&o, m, 2, (const char *const[]){"FLAT", "STEEP"});
  check_opened(&o, 2);
  ck_assert_int_eq(o.m->n_node - o.n_node, 12 + 3 * 3);
  for (int k = 0; k < 2; ++k) { /* one closed chain each */
    const mesh_crack *c = &o.crack[k];
    ck_assert_int_eq(c->n, 30);
    ck_assert_int_eq(c->n_front, 1);
    ck_assert_int_eq(c->front_start[1], 15);
    ck_assert_int_eq(c->front_node[0], c->front_node[14]);
  }
  close_opened(&o);
}

/* A crack that ends on another one has no tip there. */
TEST(crack_that_ends_on_another_has_one_tip) {
  mesh *m = grid(2);
  opened o;
  add_side_group(m, "SHORT", short_line);
  add_side_group(m, "LONG", upright);
  open_groups(&o, m, 2, (const char *const[]){"SHORT", "LONG"});
  check_opened(&o, 2);
  ck_assert_int_eq(o.m->n_node - o.n_node, 3 + 1);
  ck_assert_int_eq(o.crack[0].n_front, 1);
  ck_assert(o.m->x[2 * o.crack[0].front_node[0]] == 3.0);
  ck_assert_int_eq(o.crack[1].n_front, 2);
  close_opened(&o);
}

static int node_at(const mesh *m, double x, double y) {
  for (int i = 0; i < m->n_node; ++i)
    if (m->x[2 * i] == x && m->x[2 * i + 1] == y) return i;
  return -1;
}

/* Other faces stay with face_elem, groups of nodes get the copies. */
TEST(other_groups_follow) {
  mesh *m = grid(2);
  opened o;
  add_side_group(m, "CRACK", crossing);
  add_side_group(m, "LEVEL", through); /* 8 faces, 4 of them in the crack */
  const int nodes[] = {node_at(m, 3, 4), node_at(m, 4, 4), node_at(m, 2, 4),
                       node_at(m, 0, 0)};
  add_node_group(m, "POINTS", 4, nodes);
  open_groups(&o, m, 1, (const char *const[]){"CRACK"});
  check_opened(&o, 1);
  const mesh_group *level = mesh_find_group(m, "LEVEL");
  ck_assert_int_eq(level->n_item, 8);
  int inner = 0;
  for (int i = 0; i < 8; ++i) inner += m->face_other[level->item_id[i]] >= 0;
  ck_assert_int_eq(inner, 4);
  const mesh_group *points = mesh_find_group(m, "POINTS");
  ck_assert_int_eq(points->n_node, 4 + 1 + 3); /* (3, 4) and the crossing */
  ck_assert_ptr_null(points->item_id);
  ck_assert_int_eq(mesh_find_group(m, "BODY")->n_node, m->n_node);
  ck_assert_ptr_nonnull(
      strstr(o.messages,
             "job.inp:7:1: note P3055: group POINTS of points has 2 "
             "node(s) on a crack, and now all of their copies"));
  close_opened(&o);
}

TEST(supports_at_a_mouth_hold_both_sides) {
  opened o;
  open_one(&o, 2, edge);
  const mesh_group *left = mesh_find_group(o.m, "LEFT");
  ck_assert_int_eq(left->n_item, 8);
  ck_assert_int_eq(left->n_node, 10); /* the node at (0, 4) twice */
  close_opened(&o);
}

TEST(no_crack_leaves_the_mesh_alone) {
  OWNED mesh *m = grid(2);
  OWNED message_log *log = NULL;
  ck_assert_int_eq(message_log_new(&log), OK);
  ck_assert_int_eq(mesh_open(m, 0, NULL, log, NULL), OK);
  ck_assert_ptr_null(m->origin);
  ck_assert_int_eq(m->n_group, 5);
}

/* ---- a penny in a mesh of gmsh ---------------------------------------------
 */

static const char penny_geo[] =
    "SetFactory(\"OpenCASCADE\");\n"
    "Box(1) = {-2, -2, -2, 4, 4, 4};\n"
    "Disk(100) = {0, 0, 0.1, 1};\n"
    "BooleanFragments{ Volume{1}; Delete; }{ Surface{100}; Delete; }\n"
    "Mesh.MeshSizeMax = 0.5; Mesh.MeshSizeMin = 0.5;\n"
    "Physical Volume(\"BODY\") = {1};\n"
    "Physical Surface(\"PENNY\") = {100};\n";

TEST(penny_in_a_mesh_of_gmsh) {
  MESH_FILE f = mesh_file_open();
  opened o;
  mesh *m = mesh_file_text(&f, "penny.geo", penny_geo);
  ck_assert_msg(m != NULL && f.messages[0] == '\0', "%s", f.messages);
  open_groups(&o, m, 1, (const char *const[]){"PENNY"});
  check_opened(&o, 1);
  const mesh_crack *c = &o.crack[0];
  ck_assert_int_eq(c->n_front, 1);
  ck_assert_int_gt(c->front_start[1], 10);
  ck_assert_int_eq(c->front_node[0], c->front_node[c->front_start[1] - 1]);
  double turn = 0.0;
  for (int i = 0; i + 1 < c->front_start[1]; ++i) {
    const double *a = m->x + 3 * c->front_node[i];
    const double *b = m->x + 3 * c->front_node[i + 1];
    ck_assert_double_eq_tol(hypot(a[0], a[1]), 1.0, 1e-9);
    turn += atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
  }
  /* e1 outward, e2 up: e3 runs clockwise seen from above. */
  ck_assert_double_eq_tol(turn, -2.0 * M_PI, 1e-9);
  /* All nodes that are not on the front open. */
  ck_assert_int_eq(mesh_find_group(m, "PENNY")->n_node,
                   2 * (m->n_node - o.n_node) + c->front_start[1] - 1);
  close_opened(&o);
}

/* ---- errors ----------------------------------------------------------------
 */

/* Rectangles from low to high corner, each two cells wide: seven squares of a
 * closed band with a half twist (size 2, so that it has inner nodes). */
static int on_twisted_band(const mesh *m, const int *v) {
  static const double square_of[7][6] = {{2, 4, 2, 4, 6, 2}, {2, 4, 2, 4, 4, 4},
                                         {4, 2, 2, 4, 4, 4}, {4, 2, 4, 4, 4, 6},
                                         {4, 4, 4, 4, 6, 6}, {2, 6, 4, 4, 6, 6},
                                         {2, 6, 2, 4, 6, 4}};
  for (int i = 0; i < 7; ++i)
    if (inside(m, v, square_of[i], square_of[i] + 3)) return 1;
  return 0;
}

TAKE(part_of_band, on_twisted_band(m, v) && !(IN(2, 4, 2) TO(4, 6, 2)))

static mesh *band_grid(void) {
  return make_grid_3d((const int[]){6, 10, 8}, (const double[]){6, 10, 8});
}

TEST(band_with_a_half_twist_has_one_side) {
  opened o;
  mesh *m = band_grid();
  add_side_group(m, "BAND", on_twisted_band);
  open_groups(&o, m, 1, (const char *const[]){"BAND"});
  ck_assert_int_eq(o.answer, ERR_MESH);
  ck_assert_msg(strstr(o.messages,
                       "job.inp:7:1: error P3053: crack along BAND: above and "
                       "below cannot be told apart at") != NULL,
                "%s", o.messages);
  close_opened(&o);
  /* without one of its squares it is a strip with two sides */
  m = band_grid();
  add_side_group(m, "BAND", part_of_band);
  open_groups(&o, m, 1, (const char *const[]){"BAND"});
  check_opened(&o, 1);
  close_opened(&o);
}

TEST(each_error_is_told) {
  static const struct {
    int n;
    const char *names[2], *text;
  } cases[] = {
      {1,
       {"BODY"},
       "P2022: crack along BODY: the group is made of surfaces; curves are "
       "needed in 2-D"},
      {1,
       {"POINT"},
       "P2022: crack along POINT: the group is made of points; curves are "
       "needed in 2-D"},
      {1,
       {"FOOT"},
       "P3050: crack along FOOT: 2 face(s) lie on the boundary, of element 1 "
       "at (0.5, 0), 3 at (1.5, 0)"},
      {2,
       {"CROSS", "LINE"},
       "P3051: crack along LINE: 4 face(s) belong to another crack, of "
       "element"},
      {2, {"LINE", "LINE"}, "P3051: crack along LINE: 4 face(s)"},
      {1,
       {"SHORT"},
       "P3052: crack along SHORT: all nodes are at its front, none opens"},
      {1,
       {"EDGE"},
       "P3012: \"EDGE+\" names a group of the mesh and a lip of the crack "
       "along EDGE"}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
    mesh *m = grid(2);
    opened o;
    add_side_group(m, "LINE", line);
    add_side_group(m, "CROSS", crossing);
    add_side_group(m, "FOOT", foot);
    add_side_group(m, "SHORT", short_line);
    add_side_group(m, "EDGE", edge);
    add_side_group(m, "EDGE+", ring);
    add_node_group(m, "POINT", 1, (const int[]){0});
    open_groups(&o, m, cases[i].n, cases[i].names);
    ck_assert_int_eq(o.answer, ERR_MESH);
    ck_assert_msg(strstr(o.messages, cases[i].text) != NULL, "%s instead of %s",
                  o.messages, cases[i].text);
    close_opened(&o);
  }
}

TEST(closed_faces_are_told_and_leave_the_crack) {
  opened o;
  open_one(&o, 3, square);
  ck_assert_msg(strstr(o.messages,
                       "warning P3054: crack along CRACK: 2 face(s) have all "
                       "nodes on the front, of element") != NULL,
                "%s", o.messages);
  ck_assert_int_eq(mesh_find_group(o.m, "CRACK")->n_item, 60);
  ck_assert_int_eq(mesh_find_group(o.m, "CRACK")->n_node, 2 * 9 + 14);
  close_opened(&o);
}

TEST(each_refused_request_is_an_error_and_frees_all) {
  for (int dim = 2; dim <= 3; ++dim)
    for (long k = 1, refused = 1; refused; ++k) {
      size_t before = memory_in_use();
      mesh *m = grid(dim);
      mesh_crack crack;
      message_log *log;
      add_side_group(m, "CRACK", dim == 2 ? crossing : square);
      ck_assert_int_eq(message_log_new(&log), OK);
      const mesh_cut cut = {mesh_find_group(m, "CRACK"), NULL};
      long start = memory_requests();
      memory_refuse(k, 0);
      status st = mesh_open(m, 1, &cut, log, &crack);
      refused = k <= memory_requests() - start;
      memory_refuse(0, 0);
      if (!refused || st != OK) ck_assert_int_eq(st, refused ? ERR_MEMORY : OK);
      memory_free(log);
      memory_free(m);
      ck_assert_uint_eq(memory_in_use(), before);
    }
}

UNIT_MAIN("open")
