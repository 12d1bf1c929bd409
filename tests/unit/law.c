/*
 * Every inelastic law, by its row: what any law must satisfy. The states come
 * from random histories of stress, so that alpha is one that can be reached.
 */
#include "support/law_case.h"
#include "support/unit.h"

#include <lapacke.h>

static const double young = 1e5, nu = 0.3, stress = 150;

/* In ]-1, 1[ (Knuth's linear congruential generator). */
static double random_number(unsigned long long *seed) {
  *seed = *seed * 6364136223846793005ULL + 1442695040888963407ULL;
  return (double)(*seed >> 11) / 4503599627370496.0 - 1;
}

/* v = R v R': stress (shear 1) or strain (shear 2) in Voigt components. */
static void rotate(int ns, const double R[9], double shear, double *v) {
  static const int row[6] = {0, 1, 2, 0, 1, 2}, col[6] = {0, 1, 2, 1, 2, 0};
  double A[9] = {0}, B[9] = {0};
  for (int i = 0; i < ns; ++i)
    A[row[i] + 3 * col[i]] = A[col[i] + 3 * row[i]] =
        i < 3 ? v[i] : v[i] / shear;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l)
          B[i + 3 * j] += R[i + 3 * k] * A[k + 3 * l] * R[j + 3 * l];
  for (int i = 0; i < ns; ++i)
    v[i] = (i < 3 ? 1 : shear) * B[row[i] + 3 * col[i]];
}

/* About z, and in 3-D then about x. */
static void rotation(int ns, double R[9]) {
  const double c = cos(0.7), s = sin(0.7), C = cos(1.9), S = sin(1.9);
  const double plane[9] = {c, s, 0, -s, c, 0, 0, 0, 1};
  const double solid[9] = {c, s * C, s * S, -s, c * C, c * S, 0, -S, C};
  memcpy(R, ns == 4 ? plane : solid, 9 * sizeof *R);
}

/* A history of random stresses, each rotated by R; the last stays. Explicit
 * steps well below the limit of stability. */
static void random_history(law_case *c, int n_in_plane, const double *R,
                           unsigned long long seed) {
  double ei_rate[6];
  static double alpha_rate[LAW_ALPHA_MAX];
  for (int k = 0; k < 12; ++k) {
    double limit;
    memset(c->sigma, 0, sizeof c->sigma);
    for (int i = 0; i < 6; ++i) {
      const double x = stress * random_number(&seed);
      if (i < n_in_plane) c->sigma[i] = x;
    }
    if (c->elastic.plane_stress) c->sigma[2] = 0;
    if (R != NULL) rotate(c->ns, R, 1, c->sigma);
    law_point p = law_case_point(c);
    ck_assert_int_eq(law_fastest_rate(&p, &limit), OK);
    if (k == 11) break;
    c->dt = 0.1 / (1 + limit);
    p.dt = c->dt;
    law_rate(&p, ei_rate, alpha_rate);
    c->t += c->dt;
    for (int i = 0; i < c->ns; ++i) c->ei[i] += c->dt * ei_rate[i];
    for (int i = 0; i < c->n_alpha; ++i) c->alpha[i] += c->dt * alpha_rate[i];
  }
}

typedef void check_fn(law_case *c);

/* Call for every law, word and kinematics, over some histories. */
static void for_words(const law_ops *ops, int first, const char *data,
                      int n_history, check_fn *check) {
  static const kinematics kin[] = {PLANE_STRAIN, PLANE_STRESS, AXISYMMETRIC,
                                   SOLID_3D};
  static law_case c;
  for (int w = first; law_case_new(ops, w, data, young, nu, PLANE_STRAIN, &c);
       ++w) {
    law_case_free(&c);
    for (int k = 0; k < 4; ++k)
      for (int h = 0; h < n_history; ++h) {
        law_case_new(ops, w, data, young, nu, kin[k], &c);
        random_history(&c, c.ns, NULL, 1u + (unsigned)h);
        check(&c);
        law_case_free(&c);
      }
  }
}

static void for_all_of(const law_ops *ops, int n_history, check_fn *check) {
  for_words(ops, 0, NULL, n_history, check);
}

/* All laws; fields that their examples leave out. */
static void for_all(int n_history, check_fn *check) {
  for_words(law_find("MAXWELL"), 1, "2., 0.8", n_history, check);
  for_words(law_find("MAXWELL"), 1, "2., 7.", n_history, check);
  for_words(law_find("NORTON"), 0, "1E-15, 5.", n_history, check);
  for (int k = 0; law_list[k] != NULL; ++k)
    for_all_of(law_list[k], n_history, check);
}

static double largest(const double *x, int n) {
  double m = 0;
  for (int i = 0; i < n; ++i) m = fmax(m, fabs(x[i]));
  return m;
}

static void same(const law_case *c, const double *a, const double *b, int n,
                 double tol, const char *what) {
  const double scale = fmax(largest(a, n), largest(b, n));
  for (int i = 0; i < n; ++i)
    ck_assert_msg(fabs(a[i] - b[i]) <= tol * scale,
                  "%s, ns %d: %s, component %d: %.12g and %.12g",
                  c->card.ops->name, c->ns, what, i, a[i], b[i]);
}

/* Rates of (e^i, alpha) in one vector. */
static void rates(law_case *c, double *out) {
  law_point p = law_case_point(c);
  law_rate(&p, out, out + c->ns);
}

static void check_rest(law_case *c) {
  double out[6 + LAW_ALPHA_MAX], limit;
  memset(c->sigma, 0, sizeof c->sigma);
  memset(c->ei, 0, sizeof c->ei);
  memset(c->alpha, 0, sizeof c->alpha);
  rates(c, out);
  for (int i = 0; i < c->ns + c->n_alpha; ++i)
    ck_assert_msg(out[i] == 0, "%s: rate %d at rest", c->card.ops->name, i);
  law_point p = law_case_point(c);
  ck_assert(law_dissipation(&p) == 0);
  ck_assert(law_stored(&p) == 0);
  ck_assert_int_eq(law_fastest_rate(&p, &limit), OK);
  ck_assert(isfinite(limit));
}

TEST(nothing_happens_at_rest) { for_all(1, check_rest); }

static void check_dissipation(law_case *c) {
  double out[6 + LAW_ALPHA_MAX];
  law_point p = law_case_point(c);
  const double lost = law_dissipation(&p);
  rates(c, out);
  double scale = 0;
  for (int i = 0; i < c->ns; ++i) scale += fabs(c->sigma[i] * out[i]);
  ck_assert_msg(lost >= -1e-13 * scale, "%s: dissipation %g", c->card.ops->name,
                lost);
  if (law_flows(&p)) ck_assert(lost > 0 && isfinite(lost));
}

TEST(dissipation_is_not_negative) { for_all(20, check_dissipation); }

/* State moved along its rates by h: the energy kept. */
static double stored_at(law_case *c, const double *out, double h) {
  static law_case moved;
  moved = *c;
  for (int i = 0; i < c->ns; ++i) moved.ei[i] += h * out[i];
  for (int i = 0; i < c->n_alpha; ++i) moved.alpha[i] += h * out[c->ns + i];
  law_point p = law_case_point(&moved);
  return law_stored(&p);
}

static void check_power(law_case *c) {
  double out[6 + LAW_ALPHA_MAX], power = 0, scale = 0;
  rates(c, out);
  for (int i = 0; i < c->ns; ++i) power += c->sigma[i] * out[i];
  law_point p = law_case_point(c);
  const double lost = law_dissipation(&p), fast = largest(out, c->ns);
  if (!(fast > 0)) return;
  const double h = 1e-2 * largest(c->ei, c->ns) / fast;
  const double kept = (8 * (stored_at(c, out, h) - stored_at(c, out, -h)) -
                       stored_at(c, out, 2 * h) + stored_at(c, out, -2 * h)) /
                      (12 * h);
  scale = fmax(fabs(power), fmax(fabs(lost), law_stored(&p) / h));
  ck_assert_msg(fabs(power - lost - kept) <= 1e-8 * scale,
                "%s: power %.12g, lost %.12g, kept %.12g", c->card.ops->name,
                power, lost, kept);
}

TEST(power_is_lost_or_kept) { for_all(10, check_power); }

/* Column of d(rates)/d(*x) by central differences of order 4. */
static void difference(law_case *c, double *x, double h, double *column) {
  static double far[2][6 + LAW_ALPHA_MAX], near[2][6 + LAW_ALPHA_MAX];
  const double keep = *x;
  *x = keep + h;
  rates(c, near[0]);
  *x = keep - h;
  rates(c, near[1]);
  *x = keep + 2 * h;
  rates(c, far[0]);
  *x = keep - 2 * h;
  rates(c, far[1]);
  *x = keep;
  for (int i = 0; i < c->ns + c->n_alpha; ++i)
    column[i] =
        (8 * (near[0][i] - near[1][i]) - (far[0][i] - far[1][i])) / (12 * h);
}

enum { ROOM = (6 + LAW_ALPHA_MAX) * (6 + LAW_ALPHA_MAX) };

/* Step for a number of alpha: a part of it, and not lost against the largest.
 */
static double alpha_step(const law_case *c, int i) {
  const double scale = fmax(largest(c->alpha, c->n_alpha), 1e-6);
  return fmax(1e-4 * fabs(c->alpha[i]), 1e-5 * scale);
}

/* Block J[rows * columns] against D[n * ...] from its place on. */
static void same_block(const law_case *c, const double *J, int rows,
                       int columns, const double *D, const char *what) {
  static double by[ROOM];
  for (int j = 0; j < columns; ++j)
    for (int i = 0; i < rows; ++i)
      by[i + rows * j] = D[i + (c->ns + c->n_alpha) * j];
  same(c, J, by, rows * columns, 1e-7, what);
}

static void check_jacobian(law_case *c) {
  static double room[5][ROOM], D[2 * ROOM];
  law_jacobian j = {room[0], room[1], room[2], room[3], room[4]};
  const int ns = c->ns, na = c->n_alpha, n = ns + na;
  law_point p = law_case_point(c);
  law_jacobian_at(&p, &j);
  for (int k = 0; k < ns; ++k) {
    difference(c, &c->sigma[k], 1e-4 * stress, D + n * k);
    difference(c, &c->ei[k], 1e-6, D + n * (ns + k));
  }
  for (int k = 0; k < na; ++k)
    difference(c, &c->alpha[k], alpha_step(c, k), D + n * (2 * ns + k));
  same_block(c, j.ei_sigma, ns, ns, D, "d(e^i')/d(sigma)");
  same_block(c, j.ei_ei, ns, ns, D + n * ns, "d(e^i')/d(e^i)");
  same_block(c, j.ei_alpha, ns, na, D + n * 2 * ns, "d(e^i')/d(alpha)");
  same_block(c, j.alpha_sigma, na, ns, D + ns, "d(alpha')/d(sigma)");
  same_block(c, j.alpha_alpha, na, na, D + n * 2 * ns + ns,
             "d(alpha')/d(alpha)");
  if (!c->card.ops->uses_ei) ck_assert(largest(j.ei_ei, ns * ns) == 0);
}

TEST(jacobian_agrees_with_differences) { for_all(5, check_jacobian); }

/* Creep whose rate is a multiple of a small stress has that slope at rest. */
TEST(slope_of_creep_at_rest) {
  static const char *const data[][2] = {{"NORTON", "1E-9, 1."},
                                        {"HYPERBOLIC", "1E-3, 1E-6, 1."}};
  static law_case c;
  for (int i = 0; i < 2; ++i) {
    ck_assert_int_eq(law_case_new(law_find(data[i][0]), 0, data[i][1], young,
                                  nu, SOLID_3D, &c),
                     1);
    check_jacobian(&c);
    law_case_free(&c);
  }
}

/* The coupled matrix from differences of the rates under held strain. */
static void check_fastest(law_case *c) {
  static double M[ROOM], column[6 + LAW_ALPHA_MAX], re[2][6 + LAW_ALPHA_MAX];
  const int ns = c->ns, na = c->n_alpha, n = ns + na;
  double limit, radius = 0;
  memset(M, 0, sizeof M);
  for (int k = 0; k < ns; ++k) { /* sigma = E (e - e^i)                       */
    difference(c, &c->sigma[k], 1e-4 * stress, column);
    for (int j = 0; j < ns; ++j)
      for (int i = 0; i < n; ++i)
        M[i + n * j] -= column[i] * c->elastic.E[k + ns * j];
    difference(c, &c->ei[k], 1e-6, column);
    for (int i = 0; i < n; ++i) M[i + n * k] += column[i];
  }
  for (int k = 0; k < na; ++k)
    difference(c, &c->alpha[k], alpha_step(c, k), M + n * (ns + k));
  ck_assert_int_eq(LAPACKE_dgeev(LAPACK_COL_MAJOR, 'N', 'N', n, M, n, re[0],
                                 re[1], NULL, 1, NULL, 1),
                   0);
  for (int i = 0; i < n; ++i) radius = fmax(radius, hypot(re[0][i], re[1][i]));
  law_point p = law_case_point(c);
  ck_assert_int_eq(law_fastest_rate(&p, &limit), OK);
  same(c, &limit, &radius, 1, 1e-6, "fastest rate");
}

/* Where the rate rises less than the stress, or falls, a change of direction is
 * the fastest. */
TEST(change_of_direction_may_be_fastest) {
  static const struct {
    const char *law, *data;
    int words;
    double p;
  } of[] = {{"USER", "\"1E-3\"", 0, 0.1},
            {"NORTON", "1E-9, 1., 1.", 1, 1.0},
            {"PERZYNA", "10., 1E4, 0., 1., -1E4, 20.", 0, 0.001}};
  static law_case c;
  for (int i = 0; i < 3; ++i) {
    ck_assert(law_case_new(law_find(of[i].law), of[i].words, of[i].data, young,
                           nu, SOLID_3D, &c));
    for (int q = 0; q < 6; ++q) c.sigma[q] = stress * (q - 2.2);
    c.alpha[0] = of[i].p;
    ck_assert_int_eq(c.n_alpha, 1);
    check_fastest(&c);
    law_case_free(&c);
  }
}

TEST(fastest_rate_is_the_largest_eigenvalue) { for_all(5, check_fastest); }

/* The same history seen from a turned frame gives turned rates. */
static void check_frame(law_case *c) {
  static law_case turned;
  double R[9], one[6 + LAW_ALPHA_MAX], two[6 + LAW_ALPHA_MAX];
  if (c->elastic.plane_stress && c->ns == 6) return;
  rotation(c->ns, R);
  rates(c, one);
  turned = *c;
  memset(turned.ei, 0, sizeof turned.ei);
  memset(turned.alpha, 0, sizeof turned.alpha);
  turned.t = 0;
  turned.dt = 0.1;
  random_history(&turned, c->ns, R, 1);
  rates(&turned, two);
  rotate(c->ns, R, 2, one);
  same(c, one, two, c->ns, 1e-11, "rate in a turned frame");
}

TEST(a_turned_stress_gives_turned_rates) { for_all(1, check_frame); }

/* Plane strain and axisymmetric components are those of 3-D. */
static void check_plane(law_case *c) {
  static law_case solid;
  double one[6 + LAW_ALPHA_MAX], two[6 + LAW_ALPHA_MAX];
  if (c->ns == 6 || c->elastic.plane_stress) return;
  rates(c, one);
  solid = *c;
  double C6[36];
  char text[100];
  elastic_matrix(ELASTIC_ISO, 2, (double[]){young, nu}, C6, text, sizeof text);
  law_elastic_set(C6, ELASTIC_ISO, SOLID_3D, &solid.elastic);
  solid.ns = 6;
  solid.n_alpha = law_n_alpha(&solid.card, 6);
  memset(solid.ei, 0, sizeof solid.ei);
  memset(solid.alpha, 0, sizeof solid.alpha);
  solid.t = 0;
  solid.dt = 0.1;
  random_history(&solid, 4, NULL, 1);
  rates(&solid, two);
  same(c, one, two, 4, 1e-11, "plane and 3-D");
  ck_assert(two[4] == 0 && two[5] == 0);
}

TEST(plane_rates_are_those_of_3d) { for_all(1, check_plane); }

/* Uniaxial stress along x: y and z flow alike, so zz is carried. */
static void check_lateral(law_case *c) {
  double out[6 + LAW_ALPHA_MAX];
  memset(c->sigma, 0, sizeof c->sigma);
  memset(c->ei, 0, sizeof c->ei);
  memset(c->alpha, 0, sizeof c->alpha);
  c->sigma[0] = 2 * stress;
  rates(c, out);
  ck_assert_msg(out[0] > 0 && out[2] < 0, "%s", c->card.ops->name);
  ck_assert_double_eq_tol(out[1], out[2], 1e-14 * out[0]);
}

TEST(lateral_directions_flow_alike) { for_all(1, check_lateral); }

/* The terms of a series have no order: rates of e^i, what is lost and kept, the
 * fastest rate, the law at its end. */
TEST(terms_have_no_order) {
  static const char *const data[][3] = {
      {"PRONY", "0.3, 0.1, 0.5\n0.2, 0., 10.\n0.25, 0.3, 200.",
       "0.25, 0.3, 200.\n0.2, 0., 10.\n0.3, 0.1, 0.5"},
      {"KELVIN", "5E4, 1E5\n2E5, 3E6", "2E5, 3E6\n5E4, 1E5"}};
  static law_case c;
  for (int i = 0; i < 2; ++i) {
    double out[2][6 + LAW_ALPHA_MAX], told[2][4], R[2][36];
    const law_ops *ops = law_find(data[i][0]);
    for (int k = 0; k < 2; ++k) {
      law_case_new(ops, 0, data[i][1 + k], young, nu, SOLID_3D, &c);
      for (int q = 0; q < 6; ++q) c.sigma[q] = stress * (q - 2.2);
      rates(&c, out[k]);
      law_point p = law_case_point(&c);
      told[k][0] = law_dissipation(&p);
      told[k][1] = law_stored(&p);
      told[k][2] = ops->relaxed(&p, R[k]);
      ck_assert_int_eq(law_fastest_rate(&p, &told[k][3]), OK);
      if (k == 1) same(&c, out[0], out[1], 6, 1e-12, "rate");
      for (int q = 0; k == 1 && q < 4; ++q)
        same(&c, &told[0][q], &told[1][q], 1, 1e-12, "loss, kept, end, rate");
      if (k == 1) same(&c, R[0], R[1], 36, 1e-12, "end");
      law_case_free(&c);
    }
  }
}

/* Temperatures are from absolute zero: 20 over -273.15 is 293.15 over 0. */
TEST(arrhenius_has_absolute_temperatures) {
  static const double T[] = {20, 293.15, 20}, zero[] = {-273.15, 0, 0};
  static law_case c;
  double out[3][6];
  law_case_new(law_find("HYPERBOLIC"), 0, "1E-3, 0.02, 3., 1E4", young, nu,
               SOLID_3D, &c);
  c.sigma[0] = stress;
  for (int k = 0; k < 3; ++k) {
    c.temperature = T[k];
    c.card.shift.zero = zero[k];
    rates(&c, out[k]);
  }
  law_case_free(&c);
  ck_assert_double_eq_tol(out[0][0] / out[1][0], 1, 1e-14);
  ck_assert_double_eq_tol(log(out[2][0] / out[1][0]),
                          1e4 / 8.314462618 * (1 / 293.15 - 1 / 20.), 1e-10);
}

/* R = sigma to e^i at the end over 1/E along the stress, the time to it. */
TEST(end_of_a_series_is_in_closed_form) {
  static const struct {
    const char *law, *data;
    double time, R;
  } of[] = {{"ZENER", "5E4, 1E5", 2.0, 2.0},
            {"KELVIN", "5E4, 1E5\n2E5, 6E5\n1E5, 1E5", 3.0, 3.5},
            {"KELVIN", "5E4, 1E5\n0., 1E5", -1.0, 0.0},
            {"BURGERS", "2E6, 5E4, 1E5", -1.0, 0.0},
            {"PRONY", "0.1, 0.6, 2.", 5.0, 0.0},
            {"PRONY", "0.6, 0.1, 2.", 5.0, 0.0},
            {"PRONY", "0.3, 1., 2.", -1.0, 0.0}};
  static law_case c;
  for (int i = 0; i < 7; ++i) {
    const law_ops *ops = law_find(of[i].law);
    double R[36];
    law_case_new(ops, 0, of[i].data, young, nu, SOLID_3D, &c);
    law_point p = law_case_point(&c);
    ck_assert_double_eq_tol(ops->relaxed(&p, R), of[i].time, 1e-13);
    if (of[i].R > 0) ck_assert_double_eq_tol(R[0] * young, of[i].R, 1e-13);
    law_case_free(&c);
  }
}

/* The inelastic strain of its units, and the only one from that: without the
 * part that it has not. */
TEST(only_unit_follows_from_the_strain) {
  static const char *const data[][2] = {{"PRONY", "0.3, 0.1, 0.5"},
                                        {"PRONY", "0.3, 0., 0.5"},
                                        {"PRONY", "0., 0.1, 0.5"},
                                        {"KELVIN", "5E4, 1E5"}};
  static law_case c;
  for (int i = 0; i < 4; ++i) {
    const law_ops *ops = law_find(data[i][0]);
    double only[6], sum[6] = {0};
    law_case_new(ops, 0, data[i][1], young, nu, SOLID_3D, &c);
    for (int q = 0; q < 6; ++q) c.alpha[q] = 1e-3 * (q - 2.2);
    law_point p = law_case_point(&c);
    ck_assert_int_eq(ops->units(&p, NULL, sum), 0);
    const double mean = (c.alpha[0] + c.alpha[1] + c.alpha[2]) / 3;
    memcpy(c.ei, sum, sizeof sum);
    ops->units(&p, only, sum);
    for (int q = 0; q < 6; ++q) {
      const double part = q < 3 ? mean : 0;
      const double want = i == 1   ? c.alpha[q] - part
                          : i == 2 ? part
                                   : c.alpha[q];
      ck_assert_double_eq_tol(only[q], want, 1e-17);
    }
    law_case_free(&c);
  }
}

/* Linear rows: rates are the Jacobian times the state. */
static void check_linear(law_case *c) {
  static double room[5][ROOM];
  double out[6 + LAW_ALPHA_MAX], sum[6 + LAW_ALPHA_MAX] = {0};
  law_jacobian j = {room[0], room[1], room[2], room[3], room[4]};
  const int ns = c->ns, na = c->n_alpha;
  if (!c->card.ops->linear) return;
  law_point p = law_case_point(c);
  law_jacobian_at(&p, &j);
  rates(c, out);
  for (int i = 0; i < ns; ++i) {
    for (int k = 0; k < ns; ++k)
      sum[i] +=
          j.ei_sigma[i + ns * k] * c->sigma[k] + j.ei_ei[i + ns * k] * c->ei[k];
    for (int k = 0; k < na; ++k) sum[i] += j.ei_alpha[i + ns * k] * c->alpha[k];
  }
  for (int i = 0; i < na; ++i) {
    for (int k = 0; k < ns; ++k)
      sum[ns + i] += j.alpha_sigma[i + na * k] * c->sigma[k];
    for (int k = 0; k < na; ++k)
      sum[ns + i] += j.alpha_alpha[i + na * k] * c->alpha[k];
  }
  same(c, out, sum, ns + na, 1e-12, "linear law");
}

TEST(a_linear_law_is_its_jacobian) { for_all(5, check_linear); }

/* All others flow under a deviator, and without volume. */
static void check_deviator(law_case *c) {
  double out[6 + LAW_ALPHA_MAX], pressed[6 + LAW_ALPHA_MAX];
  if (c->card.ops->linear) return;
  rates(c, out);
  ck_assert_double_le(fabs(out[0] + out[1] + out[2]),
                      1e-14 * largest(out, c->ns));
  for (int i = 0; i < 3 && !c->elastic.plane_stress; ++i) c->sigma[i] -= stress;
  rates(c, pressed);
  same(c, pressed, out, c->ns + c->n_alpha, 1e-9, "pressure");
}

TEST(a_law_that_is_not_linear_has_no_pressure) { for_all(5, check_deviator); }

static void check_flows(law_case *c) {
  double out[6 + LAW_ALPHA_MAX];
  for (int k = 0; k < 40; ++k) {
    for (int i = 0; i < c->ns; ++i) c->sigma[i] *= 0.8;
    law_point p = law_case_point(c);
    rates(c, out);
    ck_assert_int_eq(law_flows(&p), largest(out, c->ns + c->n_alpha) > 0);
  }
}

TEST(a_law_flows_where_a_rate_is_not_zero) { for_all(5, check_flows); }

/*
 * A law that is not in the table: a dashpot of cubic viscosity with a recovery
 * of its own, d(e^i)/dt = A (1 + J^2/S^2) 3/2 s, d(w)/dt = J(e^i') - w/tau,
 * and a pair that swings faster than all else, d(a)/dt = k b, d(b)/dt = w - k
 * a.
 */
typedef struct trial_value {
  double A, S, tau;
} trial_value;

OPTIONS(trial_fields,
        OPTION_REAL(trial_value, A, "A", 0, 1e9, NULL, "1/(stress time)",
                    "factor"),
        OPTION_REAL(trial_value, S, "S", 1e-9, 1e9, NULL, "stress", "scale"),
        OPTION_REAL(trial_value, tau, "tau", 1e-9, 1e9, "5", "time",
                    "recovery"));

static int trial_n_alpha(const law_card *law, int ns) { return 3; }

static const double swing = 100; /* k tau */

/* J and dp/dt = A (J + J^3/S^2), with its slope. */
static double trial_flow(const law_point *p, double *n, double *q,
                         double *slope) {
  const trial_value *v = (const void *)p->value;
  double s[6];
  tensor_deviator(p->elastic->ns, p->sigma, s);
  *q = tensor_mises(p->elastic->ns, s);
  for (int i = 0; i < p->elastic->ns; ++i) n[i] = 0;
  if (*q > 0) tensor_direction(p->elastic->ns, s, *q, n);
  const double x = *q / v->S;
  *slope = v->A * (1 + 3 * x * x);
  return v->A * (1 + x * x) * *q;
}

static void trial_rate(const law_point *p, double *ei_rate,
                       double *alpha_rate) {
  double n[6], q, slope;
  const double rate = trial_flow(p, n, &q, &slope);
  for (int i = 0; i < p->elastic->ns; ++i) ei_rate[i] = rate * n[i];
  const double tau = ((const double *)p->value)[2], *alpha = p->alpha;
  alpha_rate[0] = rate - alpha[0] / tau;
  alpha_rate[1] = swing / tau * alpha[2];
  alpha_rate[2] = alpha[0] - swing / tau * alpha[1];
}

static void trial_jacobian(const law_point *p, law_jacobian *j) {
  const int ns = p->elastic->ns;
  double n[6], q, slope;
  const double rate = trial_flow(p, n, &q, &slope);
  tensor_add_flow(ns, n, q > 0 ? rate / q : slope, slope, j->ei_sigma, ns);
  const double tau = ((const double *)p->value)[2];
  for (int i = 0; i < ns; ++i) j->alpha_sigma[3 * i] = slope * n[i];
  j->alpha_alpha[0] = -1 / tau;
  j->alpha_alpha[2] = 1;
  j->alpha_alpha[5] = -swing / tau;
  j->alpha_alpha[7] = swing / tau;
}

static double trial_dissipation(const law_point *p) {
  double n[6], q, slope;
  const double rate = trial_flow(p, n, &q, &slope);
  return rate * q;
}

static const law_ops trial_law = {.name = "TRIAL",
                                  .reference = "none",
                                  .help = "for this test",
                                  .fields = trial_fields,
                                  .example = "1E-6, 80.",
                                  .n_alpha = trial_n_alpha,
                                  .rate = trial_rate,
                                  .jacobian = trial_jacobian,
                                  .dissipation = trial_dissipation};

TEST(a_trial_law_passes) {
  static check_fn *const checks[] = {
      check_rest,  check_dissipation, check_power,   check_jacobian,
      check_frame, check_fastest,     check_lateral, check_linear,
      check_plane, check_flows};
  for (size_t i = 0; i < sizeof checks / sizeof *checks; ++i)
    for_all_of(&trial_law, 1, checks[i]);
}

UNIT_MAIN("law")
