/*
 * Integrators of src/material/scheme on a material point: every row of
 * scheme_list. What a step makes of a held strain, orders, the estimate of
 * HEUN, the theta-method at 1/2 and 1, exact steps of linear laws, limits,
 * states within a step, and that the state a step starts from stays. E = 1000,
 * nu = 0.3.
 */
#include "support/point_body.h"
#include "support/unit.h"

static point_body b;

/* All strains held from the start on, or growing. */
static const point_drive held = {.held = {1, 1, 1, 1, 1, 1},
                                 .e = {1e-3, -4e-4, 2e-4, 5e-4, 1e-4, -3e-4}};
static const point_drive growing = {
    .held = {1, 1, 1, 1, 1, 1},
    .e = {1e-3, -4e-4, 2e-4, 5e-4, 1e-4, -3e-4},
    .e_rate = {5e-4, 1e-4, -2e-4, 0, 3e-4, 1e-4}};
/* A bar that is pulled. */
static const point_drive pulled = {.held = {1}, .e = {1e-3}, .e_rate = {2e-3}};

static void start(const char *law, const char *data, const point_drive *d) {
  const point_input in = {law, data, 0, 1000, 0.3, 0};
  point_body_new(&in, d, &b);
}

static double theta_of(const scheme *s) {
  return s->theta > 0 ? s->theta : 0.75;
}

/* Stress after a step of a held strain over that before, z = dt/tau. */
static double factor_of(const scheme *s, double z) {
  const double th = theta_of(s);
  if (s->linear_only) return exp(-z);
  if (s->limit == 0) return (1 - (1 - th) * z) / (1 + th * z);
  double sum = 1, term = 1;
  for (int k = 1; k <= s->order; ++k) sum += term *= -z / k;
  return sum;
}

TEST(held_stress_has_the_factor_of_its_row) {
  for (int i = 0; scheme_list[i] != NULL; ++i) {
    const scheme *s = scheme_list[i];
    start("MAXWELL", "2.", &held);
    const double before = b.old.sigma[0], shear = b.old.sigma[3];
    point_body_run(&b, s, theta_of(s), 1.5, 1, NULL);
    const double factor = factor_of(s, 0.75);
    ck_assert_double_eq_tol(b.now.sigma[0], factor * before, 1e-14);
    ck_assert_double_eq_tol(b.now.sigma[3], factor * shear, 1e-14);
    point_body_free(&b);
  }
}

static double energy(const flow_state *s) {
  double sum = 0;
  for (int i = 0; i < 6; ++i) sum += 0.5 * s->sigma[i] * (s->e[i] - s->ei[i]);
  return sum;
}

/* What is lost of a held stress is what its elastic energy falls by, which the
 * quadrature of a row has with its order; halved steps. */
TEST(loss_has_the_order_of_its_row) {
  for (int i = 0; scheme_list[i] != NULL; ++i) {
    const scheme *s = scheme_list[i];
    double error[2];
    for (int k = 0; k < 2; ++k) {
      const int n = 8 << k;
      double lost = 0;
      start("MAXWELL", "2.", &held);
      const double before = energy(&b.old);
      for (int step = 1; step <= n; ++step) {
        point_body_run(&b, s, theta_of(s), 1.5 * step / n, 1, NULL);
        lost += b.result.dissipated;
      }
      error[k] = fabs(lost / (before * (1 - exp(-1.5))) - 1);
      point_body_free(&b);
    }
    ck_assert_double_le(error[0], 0.2);
    ck_assert_msg(error[1] <= 1.25 * ldexp(error[0], -s->order) + 1e-13,
                  "%s: %g, then %g", s->name, error[0], error[1]);
  }
}

/* At its limit a step leaves the magnitude as it is; there is none for rows
 * that damp everything. */
TEST(limits_are_where_the_factor_is_one) {
  for (int i = 0; scheme_list[i] != NULL; ++i) {
    const scheme *s = scheme_list[i];
    const double limit = scheme_limit(s, theta_of(s));
    if (isfinite(limit))
      ck_assert_double_eq_tol(fabs(factor_of(s, limit)), 1, 1e-12);
    else
      ck_assert_double_le(fabs(factor_of(s, 1e6)), 1);
  }
  ck_assert_double_eq_tol(scheme_limit(scheme_find("THETA"), 0.25), 4, 1e-14);
}

/* Stress that grows; strains are no linear function of time. */
static const point_drive loaded = {.sigma = {1}, .sigma_rate = {1}};

/* e^i after n steps, of a linear law for the row that wants one. */
static double pulled_bar(const scheme *s, int n) {
  if (s->linear_only)
    start("ZENER", "500., 1500.", &loaded);
  else
    start("USER", "\"0.5E-3*q^2/(1 + 50*p)\"", &pulled);
  point_body_run(&b, s, theta_of(s), 1, n, NULL);
  const double ei = b.now.ei[0];
  point_body_free(&b);
  return ei;
}

TEST(rows_have_their_order) {
  for (int i = 0; scheme_list[i] != NULL; ++i) {
    const scheme *s = scheme_list[i];
    const int n = s->order == 1 ? 100 : s->order == 2 ? 40 : 10;
    double e[3];
    for (int k = 0; k < 3; ++k) e[k] = pulled_bar(s, n << k);
    const double order = log2((e[0] - e[1]) / (e[1] - e[2]));
    ck_assert_msg(fabs(order - s->order) <= 0.1, "%s: order %.3f", s->name,
                  order);
  }
}

/* The difference of both ends, root of e:e with engineering shears. */
TEST(heun_estimates_by_euler) {
  double ei[2][6], estimate[1], sum = 0;
  for (int k = 0; k < 2; ++k) {
    const scheme *s = scheme_find(k == 0 ? "EULER" : "HEUN");
    start("USER", "\"0.5E-3*q^2/(1 + 50*p)\"", &growing);
    point_body_run(&b, s, 0, 0.2, 1, estimate);
    memcpy(ei[k], b.now.ei, sizeof ei[k]);
    ck_assert_int_eq(s->estimates, k);
    point_body_free(&b);
  }
  for (int i = 0; i < 6; ++i)
    sum += (i < 3 ? 1.0 : 0.5) * pow(ei[0][i] - ei[1][i], 2);
  ck_assert_double_gt(sum, 0);
  ck_assert_double_eq_tol(estimate[0], sqrt(sum), 1e-12 * sqrt(sum));
}

TEST(midpoint_and_backward_are_theta) {
  static const char *const name[] = {"MIDPOINT", "BACKWARD"};
  static const double theta[] = {0.5, 1};
  static const char *const law[][2] = {{"BURGERS", "8000., 500., 3000."},
                                       {"NORTON", "1E-3, 2."}};
  for (int i = 0; i < 4; ++i) {
    double ei[2];
    for (int k = 0; k < 2; ++k) {
      start(law[i / 2][0], law[i / 2][1], &growing);
      point_body_run(&b, scheme_find(k == 0 ? name[i % 2] : "THETA"),
                     theta[i % 2], 1, 3, NULL);
      ei[k] = b.now.ei[0];
      point_body_free(&b);
    }
    ck_assert_double_eq(ei[0], ei[1]);
    ck_assert_double_ne(ei[0], 0);
  }
}

/* Under strains that are linear in time one step is as good as many, for all
 * linear laws. */
TEST(exponential_is_exact_for_linear_laws) {
  const scheme *s = scheme_find("EXPONENTIAL");
  int laws = 0;
  for (int i = 0; law_list[i] != NULL; ++i) {
    if (!law_list[i]->linear) continue;
    double ei[2][6];
    for (int k = 0; k < 2; ++k) {
      start(law_list[i]->name, NULL, &growing);
      point_body_run(&b, s, 0.5, 7, k == 0 ? 1 : 8, NULL);
      memcpy(ei[k], b.now.ei, sizeof ei[k]);
      ck_assert_int_eq(b.n_linear, k == 0 ? 1 : 8);
      point_body_free(&b);
    }
    for (int c = 0; c < 6; ++c)
      ck_assert_double_eq_tol(ei[0][c], ei[1][c], 1e-15);
    ++laws;
  }
  ck_assert_int_ge(laws, 5);
}

/* From rest at a constant rate, z = dt/tau: e^i = e (1 - (1 - exp(-z))/z) by
 * its series, to the last digits of steps of any length. */
TEST(exponential_keeps_its_digits) {
  static const double z[] = {1e-8, 0.05, 3};
  static const point_drive from_rest = {.held = {1, 1, 1, 1, 1, 1},
                                        .e_rate = {0, 0, 0, 1}};
  for (int k = 0; k < 3; ++k) {
    long double sum = 0, term = z[k] / 2;
    for (int i = 3; i < 40; term *= -z[k] / i++) sum += term;
    start("MAXWELL", "2.", &from_rest);
    point_body_run(&b, scheme_find("EXPONENTIAL"), 0.5, 2 * z[k], 1, NULL);
    const double exact = (double)(2 * z[k] * sum);
    ck_assert_double_eq_tol(b.now.ei[3], exact, 1e-14 * exact);
    point_body_free(&b);
  }
  /* Two units, far below both times: e^i = (E/8000 + E/3000) e t/2. */
  start("BURGERS", "8000., 500., 3000.", &from_rest);
  point_body_run(&b, scheme_find("EXPONENTIAL"), 0.5, 1e-8, 1, NULL);
  const double early = (1 / 8. + 1 / 3.) * 1e-8 * 1e-8 / 2;
  ck_assert_double_eq_tol(b.now.ei[3], early, 1e-7 * early);
  point_body_free(&b);
}

/* The equations of any elasticity give what those of an isotropic one do, of
 * the whole stress and of its deviator. */
TEST(steps_of_any_elasticity_are_those_of_an_isotropic_one) {
  static const char *const law[] = {"MAXWELL", "ZENER", "KELVIN", "BURGERS"};
  static const double theta[] = {0.5, 0.6, 1, 1}; /* the last EXPONENTIAL */
  for (int i = 0; i < 32; ++i) {
    const point_input in = {law[i % 4], NULL, i / 4 % 2, 1000, 0.3, 0};
    const scheme *s = scheme_find(i / 8 < 3 ? "THETA" : "EXPONENTIAL");
    double ei[2][6];
    for (int k = 0; k < 2; ++k) {
      point_body_new(&in, &growing, &b);
      if (k == 1) b.x.kind[0].elastic.isotropic = 0;
      point_body_run(&b, s, theta[i / 8], 1, 3, NULL);
      memcpy(ei[k], b.now.ei, sizeof ei[k]);
      point_body_free(&b);
    }
    for (int c = 0; c < 6; ++c)
      ck_assert_msg(fabs(ei[0][c] - ei[1][c]) <= 1e-12 * fabs(ei[0][0]),
                    "%s %d: %g, %g", law[i % 4], i, ei[0][c], ei[1][c]);
  }
}

enum { TERMS = 20 };
static int decade(int k) { return -15 + 30 * k / (TERMS - 1); }

/* Relaxation times from 1e-15 to 1e15 under a held strain: every term keeps its
 * exp(-t/tau), or with n steps of BACKWARD (1 + dt/tau)^-n. */
TEST(thirty_decades_in_one_body) {
  char data[1000];
  size_t used = 0;
  for (int k = 0; k < TERMS; ++k)
    used += (size_t)snprintf(data + used, sizeof data - used,
                             "%s0.04, 0., 1E%d", k == 0 ? "" : "\n", decade(k));
  static const double time[] = {1e-14, 1e-6, 1, 1e7, 1e14};
  for (int i = 0; i < 10; ++i) {
    const int exact = i % 2, n = 3;
    const double t = time[i / 2], G = 1000 / 2.6;
    double modulus = 1 - TERMS * 0.04;
    for (int k = 0; k < TERMS; ++k) {
      const double z = t * pow(10, -decade(k));
      modulus += 0.04 * (exact ? exp(-z) : pow(1 + z / n, -n));
    }
    start("PRONY", data, &held);
    point_body_run(&b, scheme_find(exact ? "EXPONENTIAL" : "BACKWARD"), 1, t, n,
                   NULL);
    ck_assert_double_eq_tol(b.now.sigma[3], G * held.e[3] * modulus,
                            1e-14 * G * held.e[3]);
    point_body_free(&b);
  }
}

/* Stress of a bar that one step of BACKWARD, dt = 0.1, strains by 0.02, where
 * dp = e - stress/E: Q (1 - exp(-b dp)) + C dp/(1 + g dp) + K (dp/dt)^(1/n). */
static double one_step(double K, double n, double Q, double C) {
  double low = 0, high = 0.02 * 1e5;
  for (int k = 0; k < 200; ++k) {
    const double stress = 0.5 * (low + high), dp = 0.02 - stress / 1e5;
    const double law = Q * (1 - exp(-50 * dp)) + C * dp / (1 + 100 * dp) +
                       K * pow(dp / 0.1, 1 / n);
    if (stress < law)
      low = stress;
    else
      high = stress;
  }
  return low;
}

/* No threshold, and rates of up to 1E290 at the strain of the end. */
TEST(high_powers_without_a_threshold_are_solved) {
  static const double n[] = {1, 3, 10, 24, 80}, K[] = {150, 1, 0.5};
  static const point_drive bar = {.held = {1}, .e_rate = {0.2}};
  for (int i = 0; i < 30; ++i) {
    const double Q = i % 2 * 20, C = i % 2 * 2e4;
    PRINTED(data, "0., %g, %g, %g, 50.\n%g, 100.", K[i / 2 % 3], n[i / 6], Q,
            C);
    const point_input in = {"CHABOCHE", data, 0, 1e5, 0.3, 0};
    const double expected = one_step(K[i / 2 % 3], n[i / 6], Q, C);
    point_body_new(&in, &bar, &b);
    point_body_run(&b, scheme_find("BACKWARD"), 1, 0.1, 1, NULL);
    ck_assert_double_eq_tol(b.now.sigma[0], expected, 1e-8 * 200);
    point_body_free(&b);
  }
}

/* An old stress, as rounding leaves it, flows in a step without any strain. */
TEST(stresses_flow_where_no_strain_is) {
  static const point_drive still = {.held = {1, 1, 1, 1, 1, 1}};
  const double G = 1000 / 2.6, z = 3 * G * 4e-4;
  start("NORTON", "4e-4, 1.", &still);
  b.old.sigma[3] = 1e-17;
  point_body_run(&b, scheme_find("THETA"), 0.5, 1, 1, NULL);
  ck_assert_double_eq_tol(b.now.ei[3], 0.5 * z / (1 + 0.5 * z) * 1e-17 / G,
                          1e-12 * 1e-17 / G);
  point_body_free(&b);
}

/* An attempt that is thrown away: the state it started from is as it was, and
 * the next attempt gives the bytes of a first one. */
TEST(a_rejected_step_leaves_nothing_behind) {
  for (int i = 0; scheme_list[i] != NULL; ++i) {
    const scheme *s = scheme_list[i];
    const char *law = s->linear_only ? "ZENER" : "CHABOCHE";
    double ei[2][6];
    for (int k = 0; k < 2; ++k) {
      start(law, NULL, &growing);
      if (k == 1) {
        OWNS(b.parts);
        flow_state keep = {0};
        ck_assert_int_eq(flow_state_new(&b.x, &keep), OK);
        flow_state_copy(&b.x, &b.old, &keep);
        point_body_run(&b, s, theta_of(s), 0.4, 1, NULL);
        flow_state_copy(&b.x, &keep, &b.old); /* thrown away                  */
      }
      point_body_run(&b, s, theta_of(s), 0.1, 1, NULL);
      memcpy(ei[k], b.now.ei, sizeof ei[k]);
      point_body_free(&b);
    }
    ck_assert_mem_eq(ei[0], ei[1], sizeof ei[0]);
  }
}

/* Hermite's cubic at 0.3 of a step, of values u, v and slopes du, dv there. */
static double cubic(double u, double v, double du, double dv) {
  const double s = 0.3;
  return u + s * s * (3 - 2 * s) * (v - u) + s * (1 - s) * (1 - s) * du -
         s * s * (1 - s) * dv;
}

/* A held stress that relaxes, by its factor and its rates at both ends; where
 * steps are exact, exactly. What is lost by its power there. */
TEST(states_within_a_step_have_its_rates_at_both_ends) {
  const double dt = 0.4, z = 0.2;
  for (int i = 0; scheme_list[i] != NULL; ++i) {
    const scheme *s = scheme_list[i];
    start("MAXWELL", "2.", &held);
    OWNS(b.parts);
    flow_state old = {0}, mid = {0};
    ck_assert_int_eq(flow_state_new(&b.x, &old), OK);
    ck_assert_int_eq(flow_state_new(&b.x, &mid), OK);
    flow_state_copy(&b.x, &b.old, &old);
    point_body_run(&b, s, theta_of(s), dt, 1, NULL);
    const scheme_step p = {.t = dt, .dt = dt, .theta = theta_of(s)};
    const scheme_call call = {&b.x, &p, NULL, b.work, &old, &b.now, &b.result};
    double lost;
    mid.t = 0.3 * dt;
    ck_assert_int_eq(s->between(&call, &mid), OK);
    ck_assert_int_eq(scheme_dissipated(&call, mid.t, &lost), OK);
    const double f = factor_of(s, z), first = 2 * z * energy(&old);
    const double g = s->linear_only ? exp(-0.3 * z) : cubic(1, f, -z, -f * z);
    for (int c = 0; c < 6; ++c) {
      ck_assert_double_eq_tol(mid.ei[c], held.e[c] * (1 - g), 1e-16);
      if (s->linear_only)
        ck_assert_double_eq_tol(mid.sigma[c], g * old.sigma[c], 1e-14);
    }
    ck_assert_double_eq_tol(
        lost, cubic(0, b.result.dissipated, first, f * f * first), 1e-15);
    point_body_free(&b);
  }
}

/* Units of laws side by side: places in one list, and the most of any point. */
TEST(points_have_room_for_the_units_of_their_law) {
  flow_kind kind[] = {{.n_alpha = 4}, {.n_alpha = 7}, {.n_alpha = 1}};
  OWNED char *parts = memory_new(1, 1);
  OWNS(parts);
  flow x = {.kind = kind};
  ck_assert_int_eq(flow_new_points(&x, 4, (const int[]){0, 1, 2, 0}), OK);
  static const size_t at[] = {0, 4, 11, 12, 16};
  for (int k = 0; k <= 4; ++k) ck_assert_uint_eq(x.alpha_at[k], at[k]);
  ck_assert_int_eq(x.most_alpha, 7);
}

UNIT_MAIN("scheme")
