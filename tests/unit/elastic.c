/* src/material/elastic.c against numbers derived by hand or by inversion. */
#include "material/material.h"

#include "support/unit.h"

static char why[200];

static const char *matrix(elastic_type type, int n, const double *c,
                          double C[36]) {
  return elastic_matrix(type, n, c, C, why, (int)sizeof why);
}

/* To 12 digits of numbers up to some hundreds. */
static void near(double a, double b) {
  ck_assert_double_eq_tol(a, b, 1e-12 * (1 + fabs(b)));
}

TEST(isotropic_matrix_has_lame_entries) {
  /* E = 260, nu = 0.3: lambda = 150, G = 100. */
  double C[36];
  ck_assert_ptr_null(matrix(ELASTIC_ISO, 2, (double[]){260, 0.3}, C));
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      near(C[i + 6 * j], i < 3 && j < 3 ? (i == j ? 350 : 150)
                         : i == j       ? 100
                                        : 0);
}

/* Columns of the inverse must be the strains of unit stresses. */
TEST(orthotropic_matrix_inverts_the_compliance) {
  const double k[] = {200, 100, 50, 0.3, 0.2, 0.25, 40, 30, 20};
  const double E1 = 200, E2 = 100, E3 = 50;
  const double S[36] = {
      1 / E1,    -0.3 / E1,  -0.2 / E1,  0,       0,       0,
      -0.3 / E1, 1 / E2,     -0.25 / E2, 0,       0,       0,
      -0.2 / E1, -0.25 / E2, 1 / E3,     0,       0,       0,
      0,         0,          0,          1. / 40, 0,       0,
      0,         0,          0,          0,       1. / 20, 0,
      0,         0,          0,          0,       0,       1. / 30};
  double C[36];
  ck_assert_ptr_null(matrix(ELASTIC_ORTHO, 9, k, C));
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      double sum = 0;
      for (int q = 0; q < 6; ++q) sum += C[i + 6 * q] * S[q + 6 * j];
      near(sum, i == j);
    }
}

TEST(orthotropic_with_equal_moduli_is_isotropic) {
  const double G = 260 / 2.6;
  double C[36], D[36];
  matrix(ELASTIC_ISO, 2, (double[]){260, 0.3}, C);
  ck_assert_ptr_null(matrix(ELASTIC_ORTHO, 9,
                            (double[]){260, 260, 260, .3, .3, .3, G, G, G}, D));
  for (int i = 0; i < 36; ++i) near(D[i], C[i]);
}

/* D1111 = 101, D1122 = 102, ... numbered in Abaqus's order, made definite by
 * a large diagonal. */
TEST(anisotropic_constants_stand_where_abaqus_puts_them) {
  double k[21], C[36];
  static const char *const ours[] = {"11", "22", "33", "12", "23", "13"};
  static const char *const order[] = {
      "1111", "1122", "2222", "1133", "2233", "3333", "1112",
      "2212", "3312", "1212", "1113", "2213", "3313", "1213",
      "1313", "1123", "2223", "3323", "1223", "1323", "2323"};
  for (int q = 0; q < 21; ++q)
    k[q] = 1 + q + (strncmp(order[q], order[q] + 2, 2) == 0 ? 1000 : 0);
  ck_assert_ptr_null(matrix(ELASTIC_ANISO, 21, k, C));
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      double expected = 0;
      PRINTED(one, "%s%s", ours[i], ours[j]);
      PRINTED(two, "%s%s", ours[j], ours[i]);
      for (int q = 0; q < 21; ++q)
        if (strcmp(order[q], one) == 0 || strcmp(order[q], two) == 0)
          expected = k[q];
      ck_assert_double_gt(expected, 0);
      ck_assert_double_eq(C[i + 6 * j], expected);
    }
}

static void refused(elastic_type type, int n, const double *c,
                    const char *part) {
  double C[36];
  const char *text = matrix(type, n, c, C);
  ck_assert_msg(text != NULL && strstr(text, part) != NULL, "%s: %s", part,
                text == NULL ? "accepted" : text);
}

TEST(constants_that_are_not_elliptic_are_refused) {
  const double nan_ = nan("");
  refused(ELASTIC_ISO, 2, (double[]){0, 0.3}, "E = 0");
  refused(ELASTIC_ISO, 2, (double[]){-1, 0.3}, "E = -1");
  refused(ELASTIC_ISO, 2, (double[]){1, 0.5}, "nu = 0.5 outside ]-1, 0.5[");
  refused(ELASTIC_ISO, 2, (double[]){1, -1}, "nu = -1 outside");
  refused(ELASTIC_ISO, 2, (double[]){1, nan_}, "constant 2");
  refused(ELASTIC_ISO, 1, (double[]){1}, "1 constants, 2 expected");
  refused(ELASTIC_ORTHO, 9, (double[]){1, 1, 1, .3, .3, .3, 1, 0, 1},
          "G13 = 0");
  refused(ELASTIC_ORTHO, 9, (double[]){1, -2, 1, .3, .3, .3, 1, 1, 1},
          "E2 = -2");
  /* |nu12| < sqrt(E1/E2) = 2 */
  refused(ELASTIC_ORTHO, 9, (double[]){4, 1, 1, 2.1, 0, 0, 1, 1, 1}, "nu12");
  refused(ELASTIC_ORTHO, 9, (double[]){1, 4, 1, .51, 0, 0, 1, 1, 1}, "nu12");
  /* Each pair is fine, all three are not. */
  refused(ELASTIC_ORTHO, 9, (double[]){1, 1, 1, .6, .6, .6, 1, 1, 1},
          "2 nu21 nu32 nu13");
  double k[21] = {1, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0,
                  0, 0, 0, 1, 0, 0, 0, 0, 0, 1};
  double C[36];
  ck_assert_ptr_null(matrix(ELASTIC_ANISO, 21, k, C));
  k[1] = 1; /* D1122 = D1111 = D2222: singular */
  refused(ELASTIC_ANISO, 21, k, "order 2");
  k[1] = 0;
  k[20] = -1; /* D2323 */
  refused(ELASTIC_ANISO, 21, k, "order 5");
  k[20] = 1;
  k[19] = 1.5; /* D1323 */
  refused(ELASTIC_ANISO, 21, k, "order 6");
  k[19] = 0;
  k[0] = 1e20; /* D1111: each is compared with its own stiffness */
  ck_assert_ptr_null(matrix(ELASTIC_ANISO, 21, k, C));
}

TEST(plane_strain_and_axisymmetry_keep_four_rows) {
  double C[36], E[16];
  matrix(ELASTIC_ISO, 2, (double[]){260, 0.3}, C);
  for (int kin = 0; kin < 2; ++kin) {
    elastic_reduce(C, kin ? AXISYMMETRIC : PLANE_STRAIN, E);
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j)
        near(E[i + 4 * j], i < 3 && j < 3 ? (i == j ? 350 : 150)
                           : i == j       ? 100
                                          : 0);
  }
}

TEST(plane_stress_has_the_closed_form_of_isotropy) {
  /* E/(1 - nu^2) = 260/0.91, nu times it, G = 100. */
  double C[36], E[16];
  const double a = 260 / 0.91;
  const double expected[16] = {a, .3 * a, 0, 0, .3 * a, a, 0, 0,
                               0, 0,      0, 0, 0,      0, 0, 100};
  matrix(ELASTIC_ISO, 2, (double[]){260, 0.3}, C);
  elastic_reduce(C, PLANE_STRESS, E);
  for (int i = 0; i < 16; ++i) near(E[i], expected[i]);
  double e[4] = {1, 2, 7, 0.5};
  elastic_zz_strain(C, e);
  near(e[2], -0.3 / 0.7 * 3); /* -nu/(1-nu) (exx + eyy) */
}

/* With coupling of everything: sigma_zz = sigma_yz = sigma_zx = 0 by solving
 * the full matrix against the strains of the reduced one. */
TEST(plane_stress_of_a_full_matrix_leaves_the_plane_free) {
  double k[21], C[36], E[16], e[4] = {0.3, -0.7, 0, 0.4};
  for (int q = 0; q < 21; ++q) k[q] = 1 + 0.3 * (q % 5);
  static const int diagonal[] = {0, 2, 5, 9, 14, 20};
  for (int q = 0; q < 6; ++q) k[diagonal[q]] += 10;
  ck_assert_ptr_null(matrix(ELASTIC_ANISO, 21, k, C));
  elastic_reduce(C, PLANE_STRESS, E);
  elastic_zz_strain(C, e);
  /* yz and zx from the last two rows with e_zz known. */
  const double b[2] = {
      -(C[4] * e[0] + C[10] * e[1] + C[16] * e[2] + C[22] * e[3]),
      -(C[5] * e[0] + C[11] * e[1] + C[17] * e[2] + C[23] * e[3])};
  const double det = C[28] * C[35] - C[34] * C[29];
  const double full[6] = {e[0],
                          e[1],
                          e[2],
                          e[3],
                          (b[0] * C[35] - b[1] * C[34]) / det,
                          (C[28] * b[1] - C[29] * b[0]) / det};
  static const int plane[4] = {0, 1, 2, 3};
  for (int i = 0; i < 6; ++i) {
    double s = 0, reduced = 0;
    for (int j = 0; j < 6; ++j) s += C[i + 6 * j] * full[j];
    if (i == 2 || i > 3) ck_assert_double_eq_tol(s, 0, 1e-12);
    if (i > 3) continue;
    for (int j = 0; j < 4; ++j) reduced += E[plane[i] + 4 * j] * e[j];
    ck_assert_double_eq_tol(s, reduced, 1e-12);
  }
}

TEST(power_of_two_scales_every_entry_exactly) {
  const double k[] = {207, 101, 53, 0.31, 0.21, 0.27, 41, 31, 23};
  double scaled[9], C[36], D[36], E[16], G[16];
  for (int i = 0; i < 9; ++i)
    scaled[i] = i < 3 || i > 5 ? ldexp(k[i], 41) : k[i];
  matrix(ELASTIC_ORTHO, 9, k, C);
  matrix(ELASTIC_ORTHO, 9, scaled, D);
  for (int i = 0; i < 36; ++i) ck_assert(D[i] == ldexp(C[i], 41));
  elastic_reduce(C, PLANE_STRESS, E);
  elastic_reduce(D, PLANE_STRESS, G);
  for (int i = 0; i < 16; ++i) ck_assert(G[i] == ldexp(E[i], 41));
}

UNIT_MAIN("elastic")
