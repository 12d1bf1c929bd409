/* src/mesh: what is read, in every format, and its geometry */
#include "mesh/raw.h"
#include "support/mesh_file.h"
#include "support/unit.h"

#include <sys/resource.h>
#include <time.h>

/* A disc of radius 1 glued into a square of side 4: two bodies, one mesh. */
static const char disc_geo[] =
    "DefineConstant[ N = 3 ];\n"
    "h = 1/N;\n"
    "Point(1) = {0, 0, 2.5, h}; Point(2) = {1, 0, 2.5, h};\n"
    "Point(3) = {0, 1, 2.5, h}; Point(4) = {-1, 0, 2.5, h};\n"
    "Point(5) = {0, -1, 2.5, h};\n"
    "Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4};\n"
    "Circle(3) = {4, 1, 5}; Circle(4) = {5, 1, 2};\n"
    "Point(6) = {-2, -2, 2.5, 1}; Point(7) = {2, -2, 2.5, 1};\n"
    "Point(8) = {2, 2, 2.5, 1}; Point(9) = {-2, 2, 2.5, 1};\n"
    "Line(5) = {6, 7}; Line(6) = {7, 8}; Line(7) = {8, 9}; Line(8) = {9, 6};\n"
    "Curve Loop(1) = {1:4}; Curve Loop(2) = {5:8};\n"
    "Plane Surface(1) = {1}; Plane Surface(2) = {2, 1};\n"
    "Point{1} In Surface{1};\n"
    "Physical Surface(\"DISC\") = {1}; Physical Surface(\"FRAME\") = {-2};\n"
    "Physical Curve(\"RIM\") = {-1, 2, -3, 4};\n"
    "Physical Curve(12) = {5, -6, 7, -8};\n"
    "Physical Point(\"CENTRE\") = {1};\n";

/* Two unit cubes on each other, a face between them, an edge and a corner. */
static const char cubes_geo[] =
    "DefineConstant[ N = 2 ];\n"
    "Point(1) = {0,0,0}; Point(2) = {1,0,0}; Point(3) = {1,1,0};\n"
    "Point(4) = {0,1,0};\n"
    "Line(1) = {1,2}; Line(2) = {2,3}; Line(3) = {3,4}; Line(4) = {4,1};\n"
    "Curve Loop(1) = {1:4}; Plane Surface(1) = {1};\n"
    "Transfinite Curve{1:4} = N+1;\n"
    "a[] = Extrude{0,0,1}{ Surface{1}; Layers{N}; };\n"
    "b[] = Extrude{0,0,1}{ Surface{a[0]}; Layers{N}; };\n"
    "Physical Volume(\"LOW\") = {a[1]}; Physical Volume(\"HIGH\") = {b[1]};\n"
    "Physical Surface(\"FOOT\") = {1}; Physical Surface(\"MID\") = {-a[0]};\n"
    "Physical Surface(\"HEAD\") = {b[0]};\n"
    "Physical Surface(\"SIDES\") = {a[2], a[3], -a[4], a[5], b[2], b[3],\n"
    "  -b[4], b[5]};\n"
    "Physical Curve(\"EDGE\") = {1}; Physical Point(\"CORNER\") = {1};\n";

static size_t at(const mesh *m, int node) {
  return (size_t)m->dim * (size_t)node;
}

static double group_measure(const mesh *m, const char *name) {
  const mesh_group *g = mesh_find_group(m, name);
  ck_assert_msg(g != NULL, "no group %s", name);
  double sum = 0.0, normal[3];
  for (int i = 0; i < g->n_item; ++i)
    sum += g->dim == m->dim ? mesh_elem_measure(m, g->item_id[i])
                            : mesh_face_normal(m, g->item_id[i], normal);
  return sum;
}

/* Over the boundary: sum n*area = 0 and sum x.n*area = dim*volume; x at the
 * centre of a face is exact as x.n is constant on it. Faces between elements
 * must not be in the groups named. */
static void check_closed(const mesh *m, int n, const char *const *names,
                         double volume) {
  double sum[3] = {0.0, 0.0, 0.0}, flux = 0.0, total = 0.0;
  for (int k = 0; k < n; ++k) {
    const mesh_group *g = mesh_find_group(m, names[k]);
    for (int i = 0; i < g->n_item; ++i) {
      double normal[3], area = mesh_face_normal(m, g->item_id[i], normal);
      const int *v = m->face + at(m, g->item_id[i]);
      ck_assert_int_eq(m->face_other[g->item_id[i]], -1);
      for (int d = 0; d < m->dim; ++d) {
        sum[d] += normal[d] * area;
        for (int c = 0; c < m->dim; ++c)
          flux += m->x[at(m, v[c]) + (size_t)d] / m->dim * normal[d] * area;
      }
      total += area;
    }
  }
  for (int d = 0; d < m->dim; ++d)
    ck_assert_double_le(fabs(sum[d]), 1e-13 * total);
  ck_assert_double_eq_tol(flux, m->dim * volume, 1e-12 * volume);
}

/* Every face is a side of face_elem and its normal leaves that element. */
static void check_outward(const mesh *m) {
  for (int f = 0; f < m->n_face; ++f) {
    const int *v = m->face + at(m, f);
    const int *w = m->elem + (size_t)(m->dim + 1) * (size_t)m->face_elem[f];
    double normal[3], toward = 0.0;
    int found = 0, inner = -1;
    for (int i = 0; i <= m->dim; ++i) {
      int in_face = 0;
      for (int j = 0; j < m->dim; ++j) in_face |= v[j] == w[i];
      found += in_face;
      if (!in_face) inner = w[i];
    }
    ck_assert_int_eq(found, m->dim);
    mesh_face_normal(m, f, normal);
    for (int d = 0; d < m->dim; ++d)
      toward += normal[d] * (m->x[at(m, inner) + (size_t)d] -
                             m->x[at(m, v[0]) + (size_t)d]);
    ck_assert_double_lt(toward, 0.0);
  }
}

static void check_order(const mesh *m) {
  for (int i = 0; i < m->n_group; ++i) {
    const mesh_group *g = &m->group[i];
    for (int k = 1; k < g->n_item; ++k)
      ck_assert_int_lt(g->item_id[k - 1], g->item_id[k]);
    for (int k = 1; k < g->n_node; ++k)
      ck_assert_int_lt(g->node_id[k - 1], g->node_id[k]);
  }
  for (int e = 0; e < m->n_elem; ++e)
    ck_assert_double_gt(mesh_elem_measure(m, e), 0.0);
}

/* Once for all tests, which are processes of their own. */
__attribute__((constructor)) static void load(void) { mesh_gmsh_load(); }

TEST(disc_in_frame_has_its_areas_normals_and_groups) {
  MESH_FILE f = mesh_file_open();
  OWNED mesh *m = mesh_file_text(&f, "disc.geo", disc_geo);
  ck_assert_msg(f.answer == OK && f.messages[0] == '\0', "%s", f.messages);
  ck_assert_int_eq(m->dim, 2);
  ck_assert_int_eq(m->n_group, 5);
  ck_assert_double_eq_tol(m->size, 4.0, 1e-15);
  /* the rim is a polygon of n equal chords */
  const mesh_group *rim = mesh_find_group(m, "RIM");
  int n = rim->n_item;
  double polygon = 0.5 * n * sin(2.0 * M_PI / n);
  ck_assert_int_eq(rim->n_node, n);
  ck_assert_double_eq_tol(group_measure(m, "DISC"), polygon, 1e-10);
  ck_assert_double_eq_tol(group_measure(m, "FRAME"), 16.0 - polygon, 1e-10);
  ck_assert_double_eq_tol(group_measure(m, "RIM"), 2 * n * sin(M_PI / n),
                          1e-10);
  ck_assert_double_eq_tol(group_measure(m, "12"), 16.0, 1e-12);
  for (int i = 0; i < n; ++i)
    ck_assert_int_ge(m->face_other[rim->item_id[i]], 0);
  const mesh_group *centre = mesh_find_group(m, "CENTRE");
  ck_assert_int_eq(centre->n_node, 1);
  ck_assert_int_eq(centre->n_item, 0);
  ck_assert_ptr_null(centre->item_id);
  ck_assert(m->x[at(m, centre->node_id[0])] == 0.0);
  check_closed(m, 1, (const char *[]){"12"}, 16.0);
  check_outward(m);
  check_order(m);
}

TEST(cubes_have_their_volumes_normals_and_groups) {
  MESH_FILE f = mesh_file_open();
  OWNED mesh *m = mesh_file_text(&f, "cubes.geo", cubes_geo);
  ck_assert_msg(f.answer == OK && f.messages[0] == '\0', "%s", f.messages);
  ck_assert_int_eq(m->dim, 3);
  ck_assert_double_eq_tol(group_measure(m, "LOW"), 1.0, 1e-13);
  ck_assert_double_eq_tol(group_measure(m, "HIGH"), 1.0, 1e-13);
  ck_assert_double_eq_tol(group_measure(m, "MID"), 1.0, 1e-13);
  ck_assert_double_eq_tol(group_measure(m, "SIDES"), 8.0, 1e-12);
  const mesh_group *mid = mesh_find_group(m, "MID");
  const mesh_group *low = mesh_find_group(m, "LOW");
  for (int i = 0; i < mid->n_item; ++i) { /* one side in each cube */
    int e = m->face_elem[mid->item_id[i]], o = m->face_other[mid->item_id[i]];
    int in_low = 0;
    for (int k = 0; k < low->n_item; ++k)
      in_low += (low->item_id[k] == e) + (low->item_id[k] == o);
    ck_assert_int_eq(in_low, 1);
  }
  const mesh_group *edge = mesh_find_group(m, "EDGE");
  ck_assert_int_eq(edge->n_node, 3);
  for (int i = 0; i < 3; ++i) {
    const double *x = m->x + at(m, edge->node_id[i]);
    ck_assert(x[1] == 0.0 && x[2] == 0.0);
  }
  ck_assert_int_eq(mesh_find_group(m, "CORNER")->n_node, 1);
  check_closed(m, 3, (const char *[]){"FOOT", "HEAD", "SIDES"}, 2.0);
  check_outward(m);
  check_order(m);
}

/* gmsh itself writes the other formats, from the very mesh it made. */
static void check_formats(const char *geo) {
  static const char *const name[] = {"a22.msh", "b22.msh", "a41.msh",
                                     "b41.msh"};
  static char text[8192];
  MESH_FILE f = mesh_file_open();
  int n = snprintf(text, sizeof text, "%s\nMesh %d;\n", geo,
                   strstr(geo, "Volume") != NULL ? 3 : 2);
  for (int i = 0; i < 4; ++i)
    n += snprintf(text + n, sizeof text - (size_t)n,
                  "Mesh.MshFileVersion = %s; Mesh.Binary = %d;\n"
                  "Save \"%s/%s\";\n",
                  i < 2 ? "2.2" : "4.1", i % 2, f.folder, name[i]);
  OWNED mesh *direct = mesh_file_text(&f, "direct.geo", text);
  OWNED mesh *plain = mesh_file_text(&f, "plain.geo", geo);
  ck_assert_msg(direct != NULL && plain != NULL, "%s", f.messages);
  const char *what;
  ck_assert_msg(mesh_same(direct, plain, 0.0, &what), "meshed by us: %s", what);
  for (int i = 0; i < 4; ++i) {
    OWNED mesh *m = mesh_file_read(&f, name[i], 1.0, 0, NULL);
    ck_assert_msg(m != NULL, "%s: %s", name[i], f.messages);
    ck_assert_msg(mesh_same(direct, m, i % 2 ? 0.0 : 1e-15, &what), "%s: %s",
                  name[i], what);
  }
}

TEST(all_formats_give_the_same_mesh_2d) { check_formats(disc_geo); }

TEST(all_formats_give_the_same_mesh_3d) { check_formats(cubes_geo); }

/* The process that meshes counts as the program's own. */
static void check_time(void) {
  struct rusage child;
  const double own = (double)clock() / CLOCKS_PER_SEC;
  ck_assert_int_eq(getrusage(RUSAGE_CHILDREN, &child), 0);
  ck_assert_double_ge(
      timer_cpu(),
      own + 1e-6 * (double)(child.ru_utime.tv_usec + child.ru_stime.tv_usec));
}

TEST(meshing_twice_gives_the_same_bytes) {
  MESH_FILE f = mesh_file_open();
  const mesh_number n = {"N", 7.0, 0};
  mesh_file_write(&f, "d.geo", disc_geo, strlen(disc_geo));
  OWNED mesh *a = mesh_file_read(&f, "d.geo", 1.0, 1, &n);
  OWNED mesh *b = mesh_file_read(&f, "d.geo", 1.0, 1, &n);
  OWNED mesh *coarse = mesh_file_read(&f, "d.geo", 1.0, 0, NULL);
  const char *what;
  ck_assert_msg(mesh_same(a, b, 0.0, &what), "%s", what);
  ck_assert_mem_eq(a->elem_no, b->elem_no,
                   (size_t)a->n_elem * sizeof *a->elem_no);
  ck_assert_int_gt(a->n_node, coarse->n_node);
  check_time();
}

/* Numbers of the deck: by name, to full precision, also if the .geo gives the
 * constant a label; other names are of no effect. */
TEST(numbers_reach_the_geometry) {
  MESH_FILE f = mesh_file_open();
  static const char geo[] =
      "DefineConstant[ W = {1, Name \"Shape/W\"}, H = 1 ];\n"
      "Point(1) = {0,0,0}; Point(2) = {W,0,0}; Point(3) = {W,H,0};\n"
      "Point(4) = {0,H,0}; Line(1) = {1,2}; Line(2) = {2,3};\n"
      "Line(3) = {3,4}; Line(4) = {4,1}; Curve Loop(1) = {1:4};\n"
      "Plane Surface(1) = {1}; Physical Surface(\"B\") = {1};\n";
  const mesh_number n[] = {
      {"W", 1.0 / 3.0, 0}, {"UNUSED", 9.0, 0}, {"H", 2e-5, 0}};
  mesh_file_write(&f, "r.geo", geo, sizeof geo - 1);
  OWNED mesh *m = mesh_file_read(&f, "r.geo", 1.0, 3, n);
  ck_assert_msg(m != NULL, "%s", f.messages);
  double top[2] = {0.0, 0.0};
  for (int i = 0; i < m->n_node; ++i)
    for (int k = 0; k < 2; ++k) top[k] = fmax(top[k], m->x[2 * i + k]);
  ck_assert(top[0] == 1.0 / 3.0 && top[1] == 2e-5);
}

/* Sizes 0.05 in the quarter x, y < 0, 0.5 elsewhere, lengths scaled by 10. */
TEST(sizes_reach_the_geometry) {
  MESH_FILE f = mesh_file_open();
  mesh_file_write(&f, "d.geo", disc_geo, strlen(disc_geo));
  OWNED mesh *old = mesh_file_read(&f, "d.geo", 10.0, 0, NULL);
  ck_assert_msg(old != NULL, "%s", f.messages);
  double *size = calloc((size_t)old->n_node, sizeof *size), area[2] = {0, 0};
  for (int i = 0; i < old->n_node; ++i)
    size[i] = old->x[2 * i] < 0 && old->x[2 * i + 1] < 0 ? 0.5 : 5;
  const mesh_source source = {
      .file = mesh_file_path(&f, "d.geo"), .scale = 10, .sizes = {{old, size}}};
  OWNED mesh *m = mesh_file_from(&f, &source);
  ck_assert_msg(m != NULL, "%s", f.messages);
  int n[2] = {0, 0};
  for (int e = 0; e < m->n_elem; ++e) {
    double x = 0, y = 0;
    for (int a = 0; a < 3; ++a) {
      x += m->x[2 * m->elem[3 * e + a]] / 3;
      y += m->x[2 * m->elem[3 * e + a] + 1] / 3;
    }
    /* Well inside either part. */
    int part = x < -4 && y < -4 ? 0 : x > 7 || y > 7 ? 1 : -1;
    if (part < 0) continue;
    ++n[part];
    area[part] += mesh_elem_measure(m, e);
  }
  for (int part = 0; part < 2; ++part) {
    const double h = sqrt(area[part] / n[part] * 4 / sqrt(3));
    ck_assert_double_gt(h, (part == 0 ? 0.5 : 5) * 0.6);
    ck_assert_double_lt(h, (part == 0 ? 0.5 : 5) * 1.3);
  }
  ck_assert_int_eq(m->n_group, old->n_group);
  free(size);
}

TEST(scale_by_a_power_of_two_changes_no_digit) {
  MESH_FILE f = mesh_file_open();
  mesh_file_write(&f, "c.geo", cubes_geo, strlen(cubes_geo));
  OWNED mesh *a = mesh_file_read(&f, "c.geo", 1.0, 0, NULL);
  for (int power = -300; power <= 300; power += 150) {
    double scale = ldexp(1.0, power);
    OWNED mesh *b = mesh_file_read(&f, "c.geo", scale, 0, NULL);
    ck_assert_msg(b != NULL, "2^%d: %s", power, f.messages);
    for (int i = 0; i < 3 * a->n_node; ++i)
      ck_assert(b->x[i] == a->x[i] * scale);
    ck_assert_mem_eq(a->elem, b->elem, 4 * (size_t)a->n_elem * sizeof(int));
    ck_assert_mem_eq(a->face, b->face, 3 * (size_t)a->n_face * sizeof(int));
    ck_assert(b->size == a->size * scale);
  }
}

/* 20 x 20 cells of a square; node (i, j) has number renumber(...), elements
 * are listed and turned as pass says. */
static char *square_text(int pass) {
  enum { N = 20, NODES = (N + 1) * (N + 1) };
  static char text[200000];
  int n = sprintf(text, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n",
                  NODES);
#define NUMBER(i, j) \
  (pass == 0 ? (i) + (N + 1) * (j) + 1 : ((i)*86 + (j)*5003) % 32749 + 3)
  for (int j = 0; j <= N; ++j)
    for (int i = 0; i <= N; ++i)
      n += sprintf(text + n, "%d %.17g %.17g 0\n", NUMBER(i, j), i / 7.0,
                   j / 3.0);
  n += sprintf(text + n, "$EndNodes\n$Elements\n%d\n", 2 * N * N);
  for (int k = 0; k < N * N; ++k) {
    int e = pass == 0 ? k : N * N - 1 - k, i = e % N, j = e / N;
    int a = NUMBER(i, j), b = NUMBER(i + 1, j), c = NUMBER(i + 1, j + 1),
        d = NUMBER(i, j + 1);
    if (pass == 0)
      n += sprintf(text + n, "%d 2 2 1 1 %d %d %d\n%d 2 2 1 1 %d %d %d\n",
                   2 * k + 1, a, b, c, 2 * k + 2, a, c, d);
    else /* one triangle turned, both begin elsewhere */
      n += sprintf(text + n, "%d 2 2 1 1 %d %d %d\n%d 2 2 1 1 %d %d %d\n",
                   2 * k + 1, c, d, a, 2 * k + 2, b, a, c);
  }
  sprintf(text + n, "$EndElements\n");
  return text;
}

TEST(order_does_not_depend_on_the_numbers_of_the_file) {
  MESH_FILE f = mesh_file_open();
  OWNED mesh *a = mesh_file_text(&f, "a.msh", square_text(0));
  OWNED mesh *b = mesh_file_text(&f, "b.msh", square_text(1));
  ck_assert_msg(a != NULL && b != NULL, "%s", f.messages);
  ck_assert_int_eq(a->n_node, 441);
  ck_assert_mem_eq(a->x, b->x, 2 * 441 * sizeof(double));
  ck_assert_mem_eq(a->elem, b->elem, 3 * (size_t)a->n_elem * sizeof(int));
  ck_assert(memcmp(a->node_no, b->node_no, 441 * sizeof(size_t)) != 0);
}

/* Two nodes so close that they share a cell of the curve. */
TEST(order_of_close_nodes_is_that_of_their_coordinates) {
  MESH_FILE f = mesh_file_open();
  OWNED mesh *a = mesh_file_text(
      &f, "a.msh",
      MSH("1\n2 1 \"B\"\n", "4\n1 0 0 0\n2 1e-8 0 0\n3 1 0 0\n4 0 1 0\n",
          "2\n1 2 2 1 1 1 2 4\n2 2 2 1 1 2 3 4\n"));
  OWNED mesh *b = mesh_file_text(
      &f, "b.msh",
      MSH("1\n2 1 \"B\"\n", "4\n1 1e-8 0 0\n2 0 0 0\n3 1 0 0\n4 0 1 0\n",
          "2\n1 2 2 1 1 2 1 4\n2 2 2 1 1 1 3 4\n"));
  ck_assert_msg(a != NULL && b != NULL, "%s", f.messages);
  ck_assert_mem_eq(a->x, b->x, 8 * sizeof(double));
  ck_assert_mem_eq(a->elem, b->elem, 6 * sizeof(int));
}

/* gmsh leaves flat triangles between the nodes of a straight line, some on each
 * other: the triangle beyond them is cut instead. */
TEST(flat_triangles_on_a_line_are_cut) {
  MESH_FILE f = mesh_file_open();
  mesh *m = mesh_file_text(
      &f, "a.msh",
      MSH("1\n2 1 \"B\"\n",
          "6\n1 0 0 0\n2 1 0 0\n3 2 0 0\n4 3 0 0\n5 1.5 2 0\n6 1.5 -1 0\n",
          "6\n1 2 2 1 1 1 2 6\n2 2 2 1 1 2 3 6\n3 2 2 1 1 3 4 6\n"
          "4 2 2 1 1 2 3 4\n5 2 2 1 1 1 2 4\n6 2 2 1 1 1 4 5\n"));
  ck_assert_msg(m != NULL, "%s", f.messages);
  ck_assert_int_eq(m->n_elem, 6);
  double area = 0.0;
  for (int e = 0; e < m->n_elem; ++e) {
    ck_assert_double_gt(mesh_elem_measure(m, e), 0.4);
    area += mesh_elem_measure(m, e);
  }
  ck_assert_double_eq_tol(area, 4.5, 1e-14);
  memory_free(m);
  /* Not across the border between two groups. */
  m = mesh_file_text(
      &f, "b.msh",
      MSH("2\n2 1 \"B\"\n2 2 \"C\"\n",
          "5\n1 0 0 0\n2 1 0 0\n3 2 0 0\n4 1 1 0\n5 1 -1 0\n",
          "4\n1 2 2 1 1 1 2 5\n2 2 2 1 1 2 3 5\n3 2 2 1 1 1 2 3\n"
          "4 2 2 2 2 1 3 4\n"));
  ck_assert(m == NULL);
  ck_assert_ptr_nonnull(strstr(f.messages, "P3022"));
}

/* Neighbours along the curve are near: the mean jump between elements that
 * follow each other is a few nodes, against some 100 row by row. */
TEST(neighbours_are_close_in_memory) {
  MESH_FILE f = mesh_file_open();
  const mesh_number n = {"N", 30.0, 0};
  mesh_file_write(&f, "d.geo", disc_geo, strlen(disc_geo));
  OWNED mesh *m = mesh_file_read(&f, "d.geo", 1.0, 1, &n);
  double jump = 0.0;
  for (int e = 0; e < m->n_elem; ++e) {
    const int *v = m->elem + 3 * e;
    int lo = v[0] < v[1] ? v[0] : v[1], hi = v[0] > v[1] ? v[0] : v[1];
    jump += (v[2] > hi ? v[2] : hi) - (v[2] < lo ? v[2] : lo);
    if (e > 0) ck_assert_int_ge(v[0], m->elem[3 * e - 3]); /* lowest first */
    ck_assert_int_eq(v[0], lo < v[2] ? lo : v[2]);
  }
  ck_assert_int_gt(m->n_node, 2000);
  ck_assert_double_lt(jump / m->n_elem, 0.06 * m->n_node);
}

TEST(bodies_are_the_connected_parts) {
  MESH_FILE f = mesh_file_open();
  OWNED mesh *m = mesh_file_text(
      &f, "two.msh",
      MSH("1\n2 1 \"B\"\n",
          "8\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 3 0 0\n6 4 0 0\n7 3 1 0\n"
          "8 4 1 0\n",
          "4\n1 2 2 1 1 1 2 3\n2 2 2 1 1 5 6 7\n3 2 2 1 1 1 3 4\n"
          "4 2 2 1 1 6 8 7\n"));
  ck_assert_msg(m != NULL, "%s", f.messages);
  int n_body, body[4];
  ck_assert_int_eq(mesh_bodies(m, &n_body, body), OK);
  ck_assert_int_eq(n_body, 2);
  for (int e = 0; e < 4; ++e) {
    int left = m->elem_no[e] == 1 || m->elem_no[e] == 3;
    for (int o = 0; o < 4; ++o) {
      int other = m->elem_no[o] == 1 || m->elem_no[o] == 3;
      ck_assert_int_eq(body[e] == body[o], left == other);
    }
  }
}

TEST(groups_are_found_by_name_and_the_nearest_is_offered) {
  MESH_FILE f = mesh_file_open();
  OWNED mesh *m = mesh_file_text(&f, "disc.geo", disc_geo);
  ck_assert_ptr_null(mesh_find_group(m, "FRAMES"));
  ck_assert_ptr_null(mesh_find_group(m, "rim"));
  ck_assert_str_eq(mesh_nearest_group(m, "FRAMES"), "FRAME");
  ck_assert_str_eq(mesh_nearest_group(m, "CENTER"), "CENTRE");
  ck_assert_ptr_null(mesh_nearest_group(m, "QUITE_DIFFERENT"));
  memory_free(NULL);
}

static const char small_msh[] =
    MSH("3\n0 5 \"P\"\n1 1 \"F\"\n2 2 \"B\"\n",
        "5\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n9 1 1 0\n",
        "5\n1 2 2 2 1 1 2 3\n2 2 2 2 1 1 9 4\n3 1 2 1 1 1 2\n"
        "4 1 2 1 1 2 1\n5 15 2 5 1 4\n");

/* Parent and child go on counting: each request is refused on one side. */
TEST(reader_gives_back_all_when_refused) {
  static const char merge[] = "Merge \"m.msh\";\n";
  MESH_FILE f = mesh_file_open();
  mesh_file_write(&f, "m.msh", small_msh, sizeof small_msh - 1);
  mesh_file_write(&f, "m.geo", merge, sizeof merge - 1);
  const mesh_source source = {.file = mesh_file_path(&f, "m.geo"), .scale = 1};
  const raw_request request = {&source, 0};
  raw_mesh *raw;
  UNIT_REFUSED(15, raw_read(&request, &raw), memory_free(raw));
}

TEST(builder_gives_back_all_when_refused) {
  MESH_FILE f = mesh_file_open();
  mesh_file_write(&f, "m.msh", small_msh, sizeof small_msh - 1);
  OWNED raw_mesh *raw = NULL;
  ck_assert_int_eq(msh_read(mesh_file_path(&f, "m.msh"), &raw), OK);
  long first = memory_requests(), n = 0;
  for (long k = 0; k <= 2 * n; ++k) { /* 0: none; then each, once or for good */
    message_log *log;
    mesh *m;
    size_t before = memory_in_use();
    ck_assert_int_eq(message_log_new(&log), OK);
    if (k == 0) first = memory_requests();
    memory_refuse(k > n ? k - n : k, k > n);
    status st = build_mesh(raw, 1.0, NULL, log, &m);
    memory_refuse(0, 0);
    if (k == 0) n = memory_requests() - first;
    if (st == OK) st = message_status(log, ERR_MESH); /* a message was lost */
    ck_assert_int_eq(st, k == 0 ? OK : ERR_MEMORY);
    memory_free(m);
    memory_free(log);
    ck_assert_uint_eq(memory_in_use(), before);
  }
  ck_assert_int_gt(n, 20);
}

TEST(bodies_give_back_all_when_refused) {
  MESH_FILE f = mesh_file_open();
  OWNED mesh *m = mesh_file_text(&f, "m.msh", small_msh);
  ck_assert_ptr_nonnull(m);
  size_t before = memory_in_use();
  int n_body, body[2];
  for (int k = 1; k <= 2; ++k) {
    memory_refuse(k, 0);
    ck_assert_int_eq(mesh_bodies(m, &n_body, body), ERR_MEMORY);
    ck_assert_uint_eq(memory_in_use(), before);
  }
  memory_refuse(0, 0);
}

/* Means of phi_0^a phi_1^b: a! b!/(a + b + 1)! on a segment, twice a! b!/(a + b
 * + 2)! on a triangle. */
TEST(face_rules_are_exact_to_their_degree) {
  for (int dim = 2; dim <= 3; ++dim)
    for (int a = 0; a <= 7 - dim; ++a)
      for (int b = 0; a + b <= 7 - dim; ++b) {
        const face_rule *r = &mesh_face_rule[dim - 2];
        const double is =
            tgamma(dim) * tgamma(a + 1) * tgamma(b + 1) / tgamma(a + b + dim);
        double sum = 0.0, phi[3];
        for (int k = 0; k < r->n; ++k) {
          const double part = face_rule_point(r, dim, k, phi);
          sum += part * pow(phi[0], a) * pow(phi[1], b);
        }
        ck_assert_double_eq_tol(sum, is, 1e-15);
      }
}

UNIT_MAIN("mesh")
