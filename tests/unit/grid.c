/* tests/support/grid.c: the meshes the other tests rest on. */
#include "support/grid.h"

#include "support/unit.h"

static double elem_measure(const mesh *m, int e) {
  const int *v = m->elem + (m->dim + 1) * e;
  double d[3][3] = {{0}};
  for (int k = 0; k < m->dim; ++k)
    for (int c = 0; c < m->dim; ++c)
      d[k][c] = m->x[m->dim * v[k + 1] + c] - m->x[m->dim * v[0] + c];
  if (m->dim == 2) return (d[0][0] * d[1][1] - d[0][1] * d[1][0]) / 2;
  return (d[0][0] * (d[1][1] * d[2][2] - d[1][2] * d[2][1]) -
          d[0][1] * (d[1][0] * d[2][2] - d[1][2] * d[2][0]) +
          d[0][2] * (d[1][0] * d[2][1] - d[1][1] * d[2][0])) /
         6;
}

static void measures_add_up(const mesh *m, double expected) {
  double sum = 0;
  for (int e = 0; e < m->n_elem; ++e) {
    ck_assert(elem_measure(m, e) > 0);
    sum += elem_measure(m, e);
  }
  ck_assert_double_eq_tol(sum, expected, 1e-12);
}

TEST(elements_fill_the_box_with_positive_measure) {
  OWNED mesh *a = make_grid_2d((int[]){3, 4}, (double[]){2, 5});
  OWNED mesh *b = make_grid_3d((int[]){2, 3, 4}, (double[]){1, 2, 3});
  measures_add_up(a, 10);
  measures_add_up(b, 6);
  ck_assert_double_eq(b->size, 3);
}

/* Normal of a face times its measure, turned as mesh.h says. */
static void face_vector(const mesh *m, int f, double *n) {
  const int *v = m->face + m->dim * f;
  const double *p = m->x + m->dim * v[0], *q = m->x + m->dim * v[1];
  if (m->dim == 2) {
    n[0] = q[1] - p[1];
    n[1] = -(q[0] - p[0]);
    return;
  }
  const double *r = m->x + 3 * v[2];
  for (int c = 0; c < 3; ++c) {
    int i = (c + 1) % 3, j = (c + 2) % 3;
    n[c] = ((q[i] - p[i]) * (r[j] - p[j]) - (q[j] - p[j]) * (r[i] - p[i])) / 2;
  }
}

TEST(side_faces_point_outward_and_have_the_area_of_the_side) {
  mesh *m[] = {make_grid_2d((int[]){3, 4}, (double[]){2, 5}),
               make_grid_3d((int[]){2, 3, 4}, (double[]){2, 5, 3})};
  const double length[] = {2, 5, 3};
  for (int k = 0; k < 2; ++k) {
    for (int g = 1; g < m[k]->n_group; ++g) {
      const mesh_group *side = &m[k]->group[g];
      const int axis = (g - 1) / 2;
      double sum[3] = {0}, n[3], area = 1;
      for (int i = 0; i < side->n_item; ++i) {
        face_vector(m[k], side->item_id[i], n);
        for (int c = 0; c < m[k]->dim; ++c) sum[c] += n[c];
      }
      for (int c = 0; c < m[k]->dim; ++c)
        if (c != axis) area *= length[c];
      for (int c = 0; c < m[k]->dim; ++c)
        ck_assert_double_eq_tol(sum[c],
                                c != axis ? 0
                                : g % 2   ? -area
                                          : area,
                                1e-12);
    }
    memory_free(m[k]);
  }
}

TEST(joined_meshes_keep_both_bodies_apart) {
  OWNED mesh *a = make_grid_2d((int[]){2, 2}, (double[]){1, 1});
  OWNED mesh *m = grid_join(a, a, (double[]){3, 0});
  ck_assert_int_eq(m->n_node, 18);
  ck_assert_double_eq(m->x[2 * 9], 3);
  measures_add_up(m, 2);
  for (int e = 8; e < 16; ++e)
    for (int k = 0; k < 3; ++k) ck_assert_int_ge(m->elem[3 * e + k], 9);
}

UNIT_MAIN("grid")
