/* src/contact/mortar: polygons in common and the dual basis. Expected values:
 * closed forms, counted points, and the conditions that define the basis. */
#include "contact/mortar/clip.h"
#include "support/unit.h"

static unsigned seed = 1;

static double noise(void) {
  seed = seed * 1103515245u + 12345u;
  return ((seed >> 8) & 0xffff) / 65535.0 - 0.5;
}

/* ---- polygons ------------------------------------------------------------ */

static int is_inside(const cell *c, const double *y) {
  double phi[3];
  cell_functions(3, c, y, phi);
  return phi[0] >= 0 && phi[1] >= 0 && phi[2] >= 0;
}

static double measure_of(int n, const cell *c) {
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += cell_measure(3, &c[i]);
  return sum;
}

TEST(common_part_of_triangles_is_that_of_closed_forms) {
  const double h = sqrt(3.0) / 2;
  const cell up = {{{-0.5, -h / 3}, {0.5, -h / 3}, {0, 2 * h / 3}}};
  const cell down = {{{-0.5, h / 3}, {0.5, h / 3}, {0, -2 * h / 3}}};
  const cell unit = {{{0, 0}, {1, 0}, {0, 1}}};
  const cell above = {{{0, 0}, {0, 1}, {1, 1}}}; /* clockwise */
  const cell away = {{{2, 0}, {3, 0}, {2, 1}}};
  const cell corner = {{{0.5, 0}, {1.5, 0}, {0.5, 1}}};
  cell c[CLIP_REST];
  /* A hexagon: two thirds of either. */
  int n = cell_common(3, &up, &down, c);
  ck_assert_int_eq(n, 4);
  ck_assert_double_eq_tol(measure_of(n, c), h / 3, 1e-15);
  n = cell_without(3, &up, &down, c);
  ck_assert_double_eq_tol(measure_of(n, c), h / 6, 1e-15);
  n = cell_common(3, &unit, &above, c);
  ck_assert_double_eq_tol(measure_of(n, c), 0.25, 1e-15);
  n = cell_common(3, &unit, &corner, c);
  ck_assert_double_eq_tol(measure_of(n, c), 0.125, 1e-15);
  n = cell_common(3, &unit, &unit, c);
  ck_assert_double_eq_tol(measure_of(n, c), 0.5, 1e-15);
  n = cell_common(3, &unit, &away, c);
  ck_assert_double_eq(measure_of(n, c), 0);
  n = cell_without(3, &unit, &away, c);
  ck_assert_double_eq_tol(measure_of(n, c), 0.5, 1e-15);
}

/* What of 0..4, in either direction, another segment leaves: one end, both, all
 * or nothing. */
TEST(common_part_of_segments_is_between_their_ends) {
  static const struct {
    double at[2], rest[2][2]; /* ends of both rests; no length: none */
  } rows[] = {{{1, 2}, {{0, 1}, {2, 4}}},  {{3, 1}, {{0, 1}, {3, 4}}},
              {{-1, 1}, {{1, 4}, {0, 0}}}, {{3, 7}, {{0, 3}, {0, 0}}},
              {{-1, 5}, {{0, 0}, {0, 0}}}, {{5, 6}, {{0, 4}, {0, 0}}},
              {{-2, -1}, {{0, 4}, {0, 0}}}};
  for (int turned = 0; turned < 2; ++turned)
    for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
      const cell a = {{{turned ? 4 : 0, 0}, {turned ? 0 : 4, 0}}};
      const cell b = {{{rows[k].at[0], 0}, {rows[k].at[1], 0}}};
      cell both[CLIP_CELLS], rest[CLIP_REST];
      double left = 0;
      const int n = cell_without(2, &a, &b, rest);
      int wanted = 0;
      for (int i = 0; i < 2; ++i) {
        const double *end = rows[k].rest[i];
        left += end[1] - end[0];
        if (!(end[1] > end[0])) continue;
        ck_assert_int_lt(wanted, n);
        ck_assert_double_eq(rest[wanted].at[0][0], end[0]);
        ck_assert_double_eq(rest[wanted++].at[1][0], end[1]);
      }
      ck_assert_int_eq(n, wanted);
      const int n_both = cell_common(2, &a, &b, both);
      ck_assert_int_eq(n_both, left < 4);
      if (n_both > 0) ck_assert_double_eq(cell_measure(2, both), 4 - left);
    }
}

/* Points of a fine grid, counted: the error of the area is below the length of
 * the outline times the spacing. */
TEST(common_part_of_triangles_is_what_is_inside_both) {
  enum { GRID = 200 };
  for (int t = 0; t < 40; ++t) {
    cell a, b, both[CLIP_CELLS], rest[CLIP_REST];
    for (int i = 0; i < 6; ++i) {
      a.at[i / 2][i % 2] = noise();
      b.at[i / 2][i % 2] = noise();
    }
    if (cell_measure(3, &a) < 0.02 || cell_measure(3, &b) < 0.02) continue;
    const int n = cell_common(3, &a, &b, both);
    const int n_rest = cell_without(3, &a, &b, rest);
    int count[2] = {0, 0}, covered[2] = {0, 0};
    for (int k = 0; k < GRID * GRID; ++k) {
      const double y[2] = {(k / GRID + 0.5) / GRID - 0.5,
                           (k % GRID + 0.5) / GRID - 0.5};
      const int in_b = is_inside(&b, y);
      if (!is_inside(&a, y)) continue;
      ++count[!in_b];
      for (int i = 0; i < n; ++i) covered[0] += in_b && is_inside(&both[i], y);
      for (int i = 0; i < n_rest; ++i)
        covered[1] += !in_b && is_inside(&rest[i], y);
    }
    for (int k = 0; k < 2; ++k) {
      const double area = measure_of(k ? n_rest : n, k ? rest : both);
      ck_assert_double_eq_tol(area, (double)count[k] / (GRID * GRID), 8e-3);
      ck_assert_int_ge(covered[k], count[k]); /* sides count twice */
      ck_assert_int_le(covered[k], count[k] + 8);
    }
    ck_assert_double_eq_tol(measure_of(n, both) + measure_of(n_rest, rest),
                            cell_measure(3, &a), 1e-15);
  }
}

/* ---- dual basis ---------------------------------------------------------- */

/* Random points with random weights stand for a covered part: the sums hold for
 * any of them. */
static int random_part(int dim, const cell *face, double size, sample *p,
                       cell *corner) {
  enum { N = 12 };
  double ref[2] = {0.3 + 0.2 * noise(), 0.3 + 0.2 * noise()};
  for (int k = 0; k < N; ++k) {
    double at[2] = {0};
    p[k] = (sample){.weight = size * (1.1 + noise())};
    for (int a = 0; a < dim - 1; ++a) {
      p[k].offset[a] = size * noise();
      at[a] = ref[a] + p[k].offset[a];
    }
    cell_functions(dim, face, at, p[k].phi);
  }
  *corner = *face;
  for (int k = 0; k < dim; ++k)
    for (int a = 0; a < dim - 1; ++a) corner->at[k][a] -= ref[a];
  return N;
}

static void check_dual(int dim, const int *kept, int n, const sample *p,
                       const double *d, double tolerance) {
  int n_kept = 0;
  double total = 0;
  for (int j = 0; j < dim; ++j) n_kept += kept[j];
  for (int k = 0; k < n; ++k) total += p[k].weight;
  for (int k = 0; k < n && n_kept > 0; ++k)
    ck_assert_double_eq_tol(p[k].psi[0] + p[k].psi[1] + p[k].psi[2], 1,
                            tolerance);
  for (int j = 0; j < dim; ++j)
    for (int i = 0; i < dim; ++i) {
      double sum = 0;
      for (int k = 0; k < n; ++k)
        sum += p[k].weight * p[k].psi[j] * p[k].phi[i];
      if (kept[i])
        ck_assert_double_eq_tol(sum / total, i == j ? d[j] / total : 0,
                                tolerance);
      if (!kept[j]) ck_assert_double_eq(sum, 0);
    }
}

TEST(dual_functions_are_biorthogonal_and_sum_to_one) {
  static const cell segment = {{{0, 0}, {1, 0}, {0, 0}}};
  static const cell triangle = {{{0, 0}, {1, 0}, {0.2, 0.9}}};
  for (int dim = 2; dim <= 3; ++dim)
    for (int bits = 0; bits < 1 << dim; ++bits)
      for (int t = 0; t < 20; ++t) {
        const int kept[3] = {bits & 1, bits >> 1 & 1, bits >> 2 & 1};
        /* A part of 1e-6 of the face has psi of 1e6: rounding grows alike. */
        const double size = t % 2 ? 0.2 : 1e-6;
        sample p[16];
        cell corner;
        double d[3];
        const int n =
            random_part(dim, dim == 2 ? &segment : &triangle, size, p, &corner);
        dual_basis(dim, &corner, kept, n, p, d);
        check_dual(dim, kept, n, p, d, 1e-14 / size);
      }
}

UNIT_MAIN("mortar_face")
