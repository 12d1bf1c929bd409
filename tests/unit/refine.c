/*
 * src/mesh/refine: bisection of meshes of a .msh. Its meshes are conforming, of
 * the same measure where they are polyhedra, on circles and spheres where they
 * were, and no worse in shape than half of the smallest angle.
 */
#include "accuracy/space.h"
#include "base/base.h"
#include "mesh/refine/parts.h"
#include "support/grid.h"
#include "support/mesh_file.h"
#include "support/msh_write.h"
#include "support/unit.h"

/* ---- scenes -----------------------------------------------------------------
 */

/* The mesh again with elements of "size" at the nodes of m; NULL: of m itself.
 */
static mesh *read_again(mesh_file *f, const mesh *m, const double *size) {
  static const char *const rounds[] = {"BOTTOM", "RIGHT", "FRONT", "LEFT"};
  const mesh_source source = {.file = mesh_file_path(f, "grid.msh"),
                              .scale = 1.0,
                              .sizes = {{size == NULL ? NULL : m, size}},
                              .n_round = 2,
                              .rounds = rounds + (m->dim == 2 ? 0 : 2)};
  mesh *out = mesh_file_from(f, &source);
  ck_assert_msg(out != NULL, "%s", f->messages);
  return out;
}

typedef double size_at(const double *x);

static mesh *refine(mesh_file *f, const mesh *m, size_at *wanted) {
  FREED double *size = calloc((size_t)m->n_node, sizeof *size);
  for (int i = 0; i < m->n_node; ++i) size[i] = wanted(m->x + m->dim * i);
  mesh *out = read_again(f, m, size);
  return out;
}

static double near_origin(const double *x) {
  return 0.02 + 0.2 * hypot(x[0], x[1]);
}
static double finer_there(const double *x) {
  return 0.003 + 0.1 * hypot(x[0], x[1]);
}
static double near_in_space(const double *x) {
  return 0.15 + 0.2 * hypot(x[0], hypot(x[1], x[2]));
}
static double finer_in_space(const double *x) {
  return 0.02 + 0.2 * hypot(x[0], hypot(x[1], x[2]));
}
static double fine(const double *x) { return 0.03; }
static double large(const double *x) { return 9.0; }
static double slightly_finer(const double *x) { return 0.25; }

/* ---- what holds of every mesh ----------------------------------------------
 */

static int by_nodes(const void *a_, const void *b_) {
  const int *a = a_, *b = b_;
  for (int k = 0; k < 3; ++k)
    if (a[k] != b[k]) return a[k] < b[k] ? -1 : 1;
  return 0;
}

/* Sides of one element are all in groups of the border: no node hangs. */
static void check_conforming(const mesh *m) {
  const int n = m->n_elem * (m->dim + 1);
  int(*side)[3] = calloc((size_t)n, sizeof *side), single = 0, border = 0;
  for (int e = 0; e < m->n_elem; ++e)
    for (int a = 0; a <= m->dim; ++a) {
      int *s = side[e * (m->dim + 1) + a], used = 0;
      s[2] = -1;
      for (int b = 0; b <= m->dim; ++b)
        if (b != a) s[used++] = m->elem[(m->dim + 1) * e + b];
      for (int p = 0; p < m->dim; ++p)
        for (int q = 0; q < m->dim - 1; ++q)
          if (s[q] > s[q + 1]) {
            const int swap = s[q];
            s[q] = s[q + 1];
            s[q + 1] = swap;
          }
    }
  qsort(side, (size_t)n, sizeof *side, by_nodes);
  for (int k = 0; k < n;) {
    int same = 1;
    while (k + same < n && by_nodes(side[k], side[k + same]) == 0) ++same;
    ck_assert_int_le(same, 2);
    single += same == 1;
    k += same;
  }
  free(side);
  for (int k = 0; k < m->n_face; ++k) border += m->face_other[k] < 0;
  ck_assert_int_eq(single, border);
}

static double measure(const mesh *m) {
  double sum = 0.0;
  for (int e = 0; e < m->n_elem; ++e) sum += mesh_elem_measure(m, e);
  return sum;
}

static double measure_of(const mesh *m, const char *name) {
  const mesh_group *g = mesh_find_group(m, name);
  double sum = 0.0, normal[3];
  ck_assert_ptr_nonnull(g);
  for (int k = 0; k < g->n_item; ++k)
    sum += mesh_face_normal(m, g->item_id[k], normal);
  return sum;
}

/* Smallest angle of the triangles. */
static double sharpest(const mesh *m) {
  double least = 4.0;
  for (int e = 0; e < m->n_elem; ++e)
    for (int a = 0; a < 3; ++a) {
      const int *v = m->elem + 3 * e;
      const double *o = m->x + 2 * v[a], *p = m->x + 2 * v[(a + 1) % 3],
                   *q = m->x + 2 * v[(a + 2) % 3];
      const double c[2] = {p[0] - o[0], p[1] - o[1]};
      const double d[2] = {q[0] - o[0], q[1] - o[1]};
      least = fmin(least, atan2(fabs(c[0] * d[1] - c[1] * d[0]),
                                c[0] * d[0] + c[1] * d[1]));
    }
  return least;
}

/* The least quality of tetrahedra, 1 of a regular one: measure over that of the
 * same sum of squared edges. */
static double worst_shape(const mesh *m) {
  double least = 1.0;
  for (int e = 0; e < m->n_elem; ++e) {
    double squares = 0.0;
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < a; ++b)
        for (int c = 0; c < 3; ++c) {
          const int *v = m->elem + 4 * e;
          const double d = m->x[3 * v[a] + c] - m->x[3 * v[b] + c];
          squares += d * d;
        }
    least = fmin(least, mesh_elem_measure(m, e) * 6.0 * sqrt(2.0) /
                            pow(squares / 6.0, 1.5));
  }
  return least;
}

/* ---- tests ------------------------------------------------------------------
 */

TEST(square_is_refined_to_its_sizes) {
  MESH_FILE f = mesh_file_open();
  OWNED mesh *grid = make_grid_2d((int[]){4, 3}, (double[]){1.0, 0.8});
  msh_write(mesh_file_path(&f, "grid.msh"), grid);
  OWNED mesh *m = read_again(&f, grid, NULL),
             *once = refine(&f, m, near_origin);
  OWNED mesh *twice = refine(&f, once, finer_there);
  const mesh *all[] = {once, twice};
  for (int k = 0; k < 2; ++k) {
    const mesh *r = all[k];
    check_conforming(r);
    ck_assert_double_eq_tol(measure(r), 0.8, 1e-14);
    ck_assert_double_eq_tol(measure_of(r, "LEFT"), 0.8, 1e-14);
    ck_assert_double_eq_tol(measure_of(r, "TOP"), 1.0, 1e-14);
    ck_assert_double_ge(sharpest(r), 0.5 * sharpest(m) - 1e-12);
    for (int e = 0; e < r->n_elem; ++e) {
      double x[2] = {0.0, 0.0};
      for (int a = 0; a < 3; ++a)
        for (int c = 0; c < 2; ++c)
          x[c] += r->x[2 * r->elem[3 * e + a] + c] / 3.0;
      const double length = sqrt(mesh_elem_measure(r, e) * 4.0 / sqrt(3.0));
      ck_assert_double_le(length,
                          1.3 * (k == 0 ? near_origin : finer_there)(x));
    }
  }
  ck_assert_int_gt(twice->n_elem, 2 * once->n_elem);
  ck_assert_int_lt(twice->n_elem, 4000);
  /* Nodes that were there keep number and place. */
  for (int i = 0; i < m->n_node; ++i) {
    int k = 0;
    while (k < twice->n_node && twice->node_no[k] != m->node_no[i]) ++k;
    ck_assert_int_lt(k, twice->n_node);
    ck_assert_double_eq(twice->x[2 * k], m->x[2 * i]);
    ck_assert_double_eq(twice->x[2 * k + 1], m->x[2 * i + 1]);
  }
}

/* The neighbours of elements that are bisected are bisected at their longest
 * edge first, or they would get ever sharper. */
TEST(angles_keep_half_of_the_smallest) {
  MESH_FILE f = mesh_file_open();
  OWNED mesh *grid = make_grid_2d((int[]){3, 12}, (double[]){1.0, 0.8});
  for (int i = 0; i < grid->n_node; ++i)
    grid->x[2 * i] += 0.9 * grid->x[2 * i + 1];
  msh_write(mesh_file_path(&f, "grid.msh"), grid);
  OWNED mesh *m = read_again(&f, grid, NULL), *r = refine(&f, m, finer_there);
  OWNED mesh *more = refine(&f, r, finer_there);
  check_conforming(more);
  ck_assert_double_ge(sharpest(more), 0.5 * sharpest(m) - 1e-12);
}

/* Nor is a mesh whose elements, of 0.277, are all a little too large kept. */
TEST(nothing_gets_larger) {
  MESH_FILE f = mesh_file_open();
  const char *what = NULL;
  OWNED mesh *grid = make_grid_2d((int[]){4, 3}, (double[]){1.0, 0.8});
  msh_write(mesh_file_path(&f, "grid.msh"), grid);
  OWNED mesh *m = read_again(&f, grid, NULL), *same = refine(&f, m, large);
  ck_assert_msg(mesh_same(m, same, 0.0, &what), "%s", what);
  OWNED mesh *more = refine(&f, m, slightly_finer);
  ck_assert_int_ge(more->n_elem, 2 * m->n_elem);
}

TEST(box_is_refined) {
  MESH_FILE f = mesh_file_open();
  OWNED mesh *grid = make_grid_3d((int[]){2, 3, 2}, (double[]){1.0, 1.2, 0.7});
  msh_write(mesh_file_path(&f, "grid.msh"), grid);
  OWNED mesh *m = read_again(&f, grid, NULL),
             *once = refine(&f, m, near_in_space);
  OWNED mesh *twice = refine(&f, once, finer_in_space);
  check_conforming(once);
  check_conforming(twice);
  ck_assert_double_eq_tol(measure(twice), 0.84, 1e-13);
  ck_assert_double_eq_tol(measure_of(twice, "FRONT"), 1.2, 1e-13);
  ck_assert_double_eq_tol(measure_of(twice, "LEFT"), 0.84, 1e-13);
  ck_assert_int_gt(twice->n_elem, 2 * once->n_elem);
  ck_assert_double_ge(worst_shape(twice), 0.2 * worst_shape(m));
}

/* In that unit. */
static mesh *refine_in(double unit, int dim) {
  MESH_FILE f = mesh_file_open();
  OWNED mesh *grid =
      dim == 2 ? make_grid_2d((int[]){4, 3}, (double[]){1.0, 0.8})
               : make_grid_3d((int[]){2, 2, 2}, (double[]){1.0, 0.9, 0.7});
  for (int i = 0; i < dim * grid->n_node; ++i) grid->x[i] *= unit;
  msh_write(mesh_file_path(&f, "grid.msh"), grid);
  mesh *m = read_again(&f, grid, NULL);
  FREED double *size = calloc((size_t)m->n_node, sizeof *size);
  space_lengths(m, size);
  for (int i = 0; i < m->n_node; ++i)
    size[i] *= dim == 2 ? 0.125 : m->x[3 * i] < 0.6 * unit ? 0.25 : 1.0;
  mesh *r = read_again(&f, m, size);
  memory_free(m);
  return r;
}

/* Halves of right triangles have equal edges, and elements may be as large as
 * required: rounding, which is another in other units, does not choose. */
TEST(units_change_no_mesh) {
  static const double units[] = {1.0 / 3.0, 25.4e-3, 7e5, 1e-9};
  for (int dim = 2; dim <= 3; ++dim) {
    OWNED mesh *first = refine_in(1.0, dim);
    for (int k = 0; k < 4; ++k) {
      OWNED mesh *m = refine_in(units[k], dim);
      ck_assert_int_eq(m->n_elem, first->n_elem);
      ck_assert_mem_eq(m->elem, first->elem,
                       (size_t)((dim + 1) * m->n_elem) * sizeof *m->elem);
    }
  }
}

/* Below x = 1 the bottom of the square becomes an arc of the radius 2 that goes
 * over into a straight line. */
static void bend(mesh *m) {
  for (int i = 0; i < m->n_node; ++i) {
    double *x = m->x + 2 * i;
    const double turn = fmin(x[0] - 1.0, 0.0) / 2.0, up = x[1];
    const double low[2] = {x[0] < 1.0 ? 1.0 + 2.0 * sin(turn) : x[0],
                           2.0 - 2.0 * cos(turn)};
    x[0] = low[0];
    x[1] = low[1] + up * (1.0 - low[1]);
  }
}

/* New nodes are on the arc; what is straight and the corner to the group RIGHT,
 * which may be curved too, stay. */
TEST(surfaces_in_contact_are_followed) {
  MESH_FILE f = mesh_file_open();
  OWNED mesh *grid = make_grid_2d((int[]){8, 4}, (double[]){2.0, 1.0});
  bend(grid);
  msh_write(mesh_file_path(&f, "grid.msh"), grid);
  OWNED mesh *m = read_again(&f, grid, NULL), *r = refine(&f, m, fine);
  const mesh_group *low = mesh_find_group(r, "BOTTOM");
  const mesh_group *side = mesh_find_group(r, "RIGHT");
  double worst = 0.0;
  check_conforming(r);
  ck_assert_int_gt(low->n_node, 40);
  for (int k = 0; k < low->n_node; ++k) {
    const double *x = r->x + 2 * low->node_id[k];
    if (x[0] < 1.0)
      worst = fmax(worst, fabs(hypot(x[0] - 1.0, x[1] - 2.0) - 2.0));
    else
      ck_assert_double_eq(x[1], 0.0);
  }
  ck_assert_double_le(worst, 1e-5);
  for (int k = 0; k < side->n_node; ++k)
    ck_assert_double_eq(r->x[2 * side->node_id[k]], 2.0);
  /* The line, not in a group that may be curved, is what it was. */
  ck_assert_double_eq_tol(measure_of(r, "LEFT"), measure_of(m, "LEFT"), 1e-14);
}

/* The area between the sides of the border. */
static double enclosed(const mesh *m) {
  double sum = 0.0, normal[3];
  for (int k = 0; k < m->n_face; ++k) {
    if (m->face_other[k] >= 0) continue;
    const double length = mesh_face_normal(m, k, normal);
    const double *p = m->x + 2 * m->face[2 * k];
    sum += 0.5 * length * (p[0] * normal[0] + p[1] * normal[1]);
  }
  return sum;
}

/* Along a hump of the radius 2 lie elements a quarter as high as it is over
 * their sides: new nodes on it would turn them over. */
TEST(thin_elements_are_not_turned_over) {
  MESH_FILE f = mesh_file_open();
  OWNED mesh *grid = make_grid_2d((int[]){8, 4}, (double[]){2.0, 1.0});
  for (int i = 0; i < grid->n_node; ++i) {
    double *x = grid->x + 2 * i;
    const double low = sqrt(4.0 - (x[0] - 1.0) * (x[0] - 1.0)) - sqrt(3.0);
    x[1] = low + pow(x[1], 5.0) * (1.0 - low);
  }
  msh_write(mesh_file_path(&f, "grid.msh"), grid);
  OWNED mesh *r = refine(&f, grid, fine);
  check_conforming(r);
  ck_assert_double_eq_tol(measure(r), enclosed(r), 1e-12);
}

/* Every other face of a group has its nodes in the other order. */
static void turn_faces(mesh *m, const char *group) {
  const mesh_group *g = mesh_find_group(m, group);
  for (int k = 0; k < g->n_item; k += 2) {
    int *v = m->face + 3 * g->item_id[k], first = v[0];
    v[0] = v[1];
    v[1] = first;
  }
}

static double height(int twisted, const double *x) {
  return twisted ? x[0] * (x[0] / 3.0 + x[1] / 4.0)
                 : 2.0 - sqrt(4.0 - x[0] * x[0] - x[1] * x[1]);
}

/* A quarter of a cap of the radius 2 with the planes x = 0 and y = 0, and a
 * saddle, whose normals at the border are those of its curves. */
TEST(curved_surfaces_are_followed) {
  for (int twisted = 0; twisted < 2; ++twisted) {
    MESH_FILE f = mesh_file_open();
    OWNED mesh *grid =
        make_grid_3d((int[]){4, 4, 2}, (double[]){0.8, 0.8, 0.6});
    for (int i = 0; i < grid->n_node; ++i) {
      double *x = grid->x + 3 * i;
      const double low = height(twisted, x);
      x[2] = low + x[2] / 0.6 * (0.6 - low);
    }
    turn_faces(grid, "FRONT");
    msh_write(mesh_file_path(&f, "grid.msh"), grid);
    OWNED mesh *m = read_again(&f, grid, NULL),
               *r = refine(&f, m, finer_in_space);
    const mesh_group *low = mesh_find_group(r, "FRONT");
    const mesh_group *plane = mesh_find_group(r, "LEFT");
    double worst = 0.0, chord = 0.2 * 0.2 / 16.0;
    check_conforming(r);
    for (int k = 0; k < low->n_node; ++k) {
      const double *x = r->x + 3 * low->node_id[k];
      worst = fmax(worst, fabs(x[2] - height(twisted, x)));
    }
    ck_assert_int_gt(low->n_node, 60);
    ck_assert_double_le(worst, (twisted ? 0.3 : 0.01) * chord);
    for (int k = 0; k < plane->n_node; ++k)
      ck_assert_double_eq_tol(r->x[3 * plane->node_id[k]], 0.0, 1e-15);
  }
}

TEST(each_refused_request_is_an_error_and_frees_all) {
  MESH_FILE f = mesh_file_open();
  OWNED mesh *grid = make_grid_2d((int[]){2, 2}, (double[]){1.0, 1.0});
  msh_write(mesh_file_path(&f, "grid.msh"), grid);
  OWNED mesh *m = read_again(&f, grid, NULL);
  double size[9];
  for (int i = 0; i < 9; ++i) size[i] = 0.4;
  const mesh_source source = {.file = mesh_file_path(&f, "grid.msh"),
                              .scale = 1.0,
                              .sizes = {{m, size}}};
  OWNED message_log *log = NULL;
  const place at = {.file = "job.inp", .line_no = 1, .column_no = 1};
  ck_assert_int_eq(message_log_new(&log), OK);
  mesh *r;
  UNIT_REFUSED(0, mesh_read_gmsh(&source, &at, log, &r),
               ck_assert((r == NULL) == refused);
               memory_free(r));
}

/* Inside linear; beyond an element of the corners on that side alone; where
 * there is none, any. */
TEST(sizes_are_those_of_the_nearest_corners) {
  static const double x[] = {0.0, 0.0, 1.0, 0.0, 0.0, 1.0}, at[] = {1, 2, 4};
  static const double in[] = {0.25, 0.25}, out[] = {1.5, 0.5};
  static const int elem[] = {0, 1, 2};
  const size_t before = memory_in_use();
  for (int n = 0; n < 2; ++n) {
    size_grid *g;
    ck_assert_int_eq(size_grid_new(&(refine_sizes){2, n, x, elem, at}, &g), OK);
    ck_assert_double_eq(size_grid_at(g, in), n ? 2.0 : HUGE_VAL);
    ck_assert_double_eq(size_grid_at(g, out), n ? 2.5 : HUGE_VAL);
    memory_free(g);
  }
  ck_assert_uint_eq(memory_in_use(), before);
}

UNIT_MAIN("refine")
