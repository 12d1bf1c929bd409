/*
 * Energy of a material point, every row of law_list with all its words by every
 * row of scheme_list: a bar whose lateral stresses are zero is stretched at a
 * constant rate, so that its work is that rate times the integral of the axial
 * stress, here by Simpson's rule over the steps.
 *   - the laws lose energy, or none, in every step
 *   - work = change of the strain energy + lost + change of what is stored, to
 *     the order of the integrator
 */
#include "support/point_body.h"
#include "support/unit.h"

/* Beyond all thresholds of the examples; past t = 0, as for the hardening. */
static const double STRAIN = 2e-3, START = 1.0, YOUNG = 1e5;

static point_body b;

static void start(const law_ops *law, int words, double rate) {
  const point_input in = {law->name, NULL, words, YOUNG, 0.3, START};
  const point_drive d = {
      .held = {1}, .e = {STRAIN - START * rate}, .e_rate = {rate}};
  point_body_new(&in, &d, &b);
}

/* 1: the card can have these words. */
static int has_words(const law_ops *law, int words) {
  law_case c;
  if (!law_case_new(law, words, NULL, YOUNG, 0.3, SOLID_3D, &c)) return 0;
  law_case_free(&c);
  return 1;
}

/* Time in which the fastest part of the law decays to a tenth and a half. */
static double span_of(const law_ops *law, int words) {
  double rate = 0.0;
  start(law, words, 0.0);
  ck_assert_int_eq(flow_fastest(&b.x, &b.old, 1.0, &rate), OK);
  point_body_free(&b);
  ck_assert_msg(rate > 0.0, "%s does not flow", law->name);
  return 2.0 / rate;
}

static double energy_now(void) {
  double e[6], stored = 0.0;
  tensor_product(6, b.c.elastic.S, b.old.sigma, e);
  ck_assert_int_eq(flow_add_stored(&b.x, &b.old, 0, 1, &stored), OK);
  return 0.5 * dot(6, b.old.sigma, e) + stored;
}

static double theta_of(const scheme *s) {
  return s->theta > 0.0 ? s->theta : 0.75;
}

/* Work less what is kept and lost, over the strain energy of the start; n is
 * even. The start is one where hardening has begun, whose rate may be infinite
 * before. */
static double defect(const scheme *s, const law_ops *law, int words, int n) {
  const double span = span_of(law, words), rate = 0.5 * STRAIN / span;
  const double begin = START + span / 8.0;
  double work = 0.0, lost = 0.0;
  start(law, words, rate);
  point_body_run(&b, scheme_find("RK4"), 0.0, begin, 32, NULL);
  const double first = energy_now();
  for (int k = 0; k <= n; ++k) {
    const double weight = k == 0 || k == n ? 1.0 : k % 2 == 0 ? 2.0 : 4.0;
    if (k > 0) {
      point_body_run(&b, s, theta_of(s), begin + span * k / n, 1, NULL);
      ck_assert_msg(b.result.dissipated >= 0.0, "%s, %s: step %d of %d: %g",
                    law->name, s->name, k, n, b.result.dissipated);
      lost += b.result.dissipated;
    }
    work += weight / 3.0 * span / n * rate * b.old.sigma[0];
  }
  const double left = work - lost - (energy_now() - first);
  ck_assert_double_gt(lost, 0.0);
  point_body_free(&b);
  return left / first;
}

static void check_order(const scheme *s, const law_ops *law, int words) {
  const int n = s->order == 4 ? 32 : 64;
  const double coarse = defect(s, law, words, n);
  const double fine = defect(s, law, words, 2 * n);
  const double seen = log2(fabs(coarse / fine));
  ck_assert_msg(fabs(seen - s->order) <= 0.15,
                "%s, words %d, %s: defects %g, %g: order %.2f", law->name,
                words, s->name, coarse, fine, seen);
  ck_assert_msg(fabs(fine) < 0.05, "%s, %s: %g", law->name, s->name, fine);
}

TEST(energy_is_lost_and_balanced_to_the_order) {
  int n = 0;
  for (int l = 0; law_list[l] != NULL; ++l)
    for (int words = 0; has_words(law_list[l], words); ++words)
      for (int i = 0; scheme_list[i] != NULL; ++i) {
        if (scheme_list[i]->linear_only && !law_list[l]->linear) continue;
        check_order(scheme_list[i], law_list[l], words);
        ++n;
      }
  ck_assert_int_ge(n, 11 * 6);
}

UNIT_MAIN("energy")
