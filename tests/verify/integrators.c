/*
 * Observed orders of the integrators of inelastic strains: every law of the
 * table with each of its words, in every kind of section, for a block that
 * creeps on a floor where a part of it sticks and the rest slides
 * (creep_case.h). Laws, words and coefficients come from their rows (example).
 *
 * The order is that of the errors of the displacements at the end with n and
 * 2 n increments, against RK4 with many: all integrators approach one answer.
 * Where the solution is smooth it must be that of the row of the integrator
 * within 0.1. Then come cases that allow no more than some order, each with the
 * reason: there it is the slope of the errors over four octaves of n, for it
 * depends on where in its increment a kink falls.
 */
#include "material/scheme/scheme.h"
#include "support/creep_case.h"
#include "support/law_case.h"
#include "support/unit.h"

enum { N_ROW = 7, FINE = 128, FINEST = 2048, OCTAVES = 4 };
/* clang-format off */
static const struct {
  const char *shown, *integrator;
  int order, n, linear_only;
} rows[N_ROW] = {{"EULER", "EULER", 1, 32, 0},
                 {"HEUN", "HEUN", 2, 32, 0},
                 {"RK4", "RK4", 4, 16, 0},
                 {"TH 3/4", "THETA, THETA=0.75", 1, 32, 0},
                 {"MIDPNT", "MIDPOINT", 2, 32, 0},
                 {"BACKWD", "BACKWARD", 1, 32, 0},
                 {"EXPON", "EXPONENTIAL", 2, 32, 1}};
/* clang-format on */

static int wrong; /* lines that are not as expected                           */

static void begin(const creep_case *c, const char *name) {
  printf("%-4s %-32s", c->section, name);
}

/* INTEGRATOR=EXPONENTIAL is not for every law. */
static int refused(int row, int constant_linear) {
  return rows[row].linear_only && !constant_linear;
}

static void end_of_line(int ok) {
  printf("  %s\n", ok ? "ok" : "NO");
  fflush(stdout);
  wrong += !ok;
}

static void show_smooth(const char *name, const creep_case *c,
                        int constant_linear) {
  const creep_end fine = creep_case_run(c, "RK4", FINE);
  int ok = fine.n_slip > 0 && fine.n_stick > 0;
  begin(c, name);
  for (int i = 0; i < N_ROW; ++i) {
    if (refused(i, constant_linear)) {
      printf("      -");
      continue;
    }
    const int n = rows[i].n;
    const creep_end a = creep_case_run(c, rows[i].integrator, n);
    const creep_end b = creep_case_run(c, rows[i].integrator, 2 * n);
    const double order =
        log2(creep_distance(&a, &fine) / creep_distance(&b, &fine));
    printf(" %6.3f", order);
    ok &= fabs(order - rows[i].order) <= 0.1 && a.changes == 0;
  }
  end_of_line(ok);
}

/* Slope of the logarithms of the errors for n = 12 to 192. */
static double slope_of(const creep_case *c, const char *integrator,
                       const creep_end *fine) {
  enum { N = 4 * OCTAVES + 1 };
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (int k = 0; k < N; ++k) {
    const int n = (int)lround(12 * exp2(k / 4.0));
    const creep_end e = creep_case_run(c, integrator, n);
    const double x = -log(n), y = log(creep_distance(&e, fine));
    sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  return (N * sxy - sx * sy) / (N * sxx - sx * sx);
}

/* Expected: the order of the row, but not more than "most". */
static void show_limited(const char *name, const creep_case *c,
                         int constant_linear, double most, const char *why) {
  const creep_end fine = creep_case_run(c, "RK4", FINEST);
  int ok = fine.n_slip > 0 && fine.n_stick > 0;
  begin(c, name);
  for (int i = 0; i < N_ROW; ++i) {
    if (refused(i, constant_linear)) {
      printf("      -");
      continue;
    }
    const double order = slope_of(c, rows[i].integrator, &fine);
    printf(" %6.3f", order);
    ok &= fabs(order - fmin(most, rows[i].order)) <= 0.3;
  }
  end_of_line(ok);
  printf("     at most %g: %s\n", most, why);
}

/* ", TYPE=DEVIATORIC" for the choices of a card. */
static void words_of(const law_card *law, char *text, size_t size) {
  text[0] = '\0';
  for (const option *o = law->ops->options; o != NULL && o->name != NULL; ++o) {
    char word[40];
    int rank;
    if (o->type != OPT_CHOICE) continue;
    memcpy(&rank, (const char *)law->param + o->offset, sizeof rank);
    choice_word(o->choices, rank, word, sizeof word);
    const size_t used = strlen(text);
    snprintf(text + used, size - used, ", %s=%s", o->name, word);
  }
}

/* The law under a part of a pressure. */
static law_point pressed(law_case *l, double pressure) {
  memset(l->sigma, 0, sizeof l->sigma);
  l->sigma[1] = -pressure;
  l->t = 1;
  return law_case_point(l);
}

/* A pressure at which all of the block flows, and a time in which it relaxes
 * by a part. */
static void choose_load(law_case *l, creep_case *c) {
  double rate;
  law_point p = pressed(l, 0.6 * (c->pressure = 100));
  for (; !law_flows(&p); p = pressed(l, 0.6 * c->pressure)) c->pressure *= 2;
  p = pressed(l, c->pressure);
  ck_assert_int_eq(law_fastest_rate(&p, &rate), OK);
  c->total = fmin(1, 1 / rate);
}

static const creep_case block = {.elastic = "1.E5, 0.3",
                                 .model = "",
                                 .step = "",
                                 .section = "CPE3",
                                 .friction = STICK_AND_SLIP,
                                 .pressure = 100,
                                 .growth = 0.3,
                                 .total = 1};

static void show_law(law_case *l, const char *section) {
  const law_ops *ops = l->card.ops;
  char words[80];
  words_of(&l->card, words, sizeof words);
  PRINTED(name, "%s%s", ops->name, words);
  PRINTED(law, "*INELASTIC, LAW=%s\n%s\n", name, ops->example);
  creep_case c = block;
  c.law = law;
  c.section = section;
  choose_load(l, &c);
  /* It begins with an infinite rate, as is shown below: from later on. */
  if (strstr(words, "HARDENING=STRAIN") != NULL)
    c.model = "*INITIAL CONDITIONS, TYPE=INTERNAL\nBODY, 1, 1E-7\n";
  show_smooth(name, &c, ops->linear);
}

TEST(head) {
  printf("order of                             ");
  for (int i = 0; i < N_ROW; ++i) printf(" %6s", rows[i].shown);
  printf("\nexpected                             ");
  for (int i = 0; i < N_ROW; ++i) printf(" %6d", rows[i].order);
  printf("\n");
  fflush(stdout);
}

TEST(every_law_in_every_section) {
  static const char *const section[] = {"CPE3", "CPS3", "CAX3", "C3D4"};
  static law_case l;
  for (int s = 0; s < 4; ++s)
    for (int k = 0; law_list[k] != NULL; ++k)
      for (int w = 0;
           law_case_new(law_list[k], w, NULL, 1e5, 0.3, PLANE_STRAIN, &l);
           ++w) {
        show_law(&l, section[s]);
        law_case_free(&l);
      }
  ck_assert_msg(wrong == 0, "%d laws are not within 0.1", wrong);
}

#define HEATED "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nBODY, 20.\n"

TEST(coefficients_that_vary) {
  creep_case c = block;
  c.law = "*INELASTIC, LAW=MAXWELL, TYPE=DEVIATORIC\n\"2 + sin(3*t)\"\n";
  show_smooth("MAXWELL, tau = 2 + sin(3 t)", &c, 0);
  c.model = HEATED;
  c.step = "*TEMPERATURE\nBODY, 21.\n";
  c.law =
      "*INELASTIC, LAW=PRONY, SHIFT=WLF, T_REF=20., C1=17.44, C2=51.6\n"
      "0.5, 0.2, 2.\n";
  show_smooth("PRONY by WLF, heated", &c, 0);
  c.elastic = "1.E5, 0.3, 0.\n8.E4, 0.35, 50.";
  c.law =
      "*EXPANSION\n1E-5\n*INELASTIC, LAW=NORTON\n2E-11, 3., 0., 0.\n"
      "5E-11, 3.5, 0., 50.\n";
  show_smooth("NORTON, E(T), A(T), n(T), heated", &c, 0);
  ck_assert_msg(wrong == 0, "%d laws are not within 0.1", wrong);
}

TEST(where_there_is_less_to_show) {
  creep_case c = block;
  printf("EXPONENTIAL is for linear laws with constant coefficients (-)\n");
  c.law = "*INELASTIC, LAW=BINGHAM\n100., 1.E4\n";
  c.pressure = 80;
  c.growth = 0.8;
  c.total = 0.2;
  show_limited("BINGHAM, threshold is crossed", &c, 0, 2,
               "rates have a kink where an element begins to flow");
  c = block;
  c.law = "*INELASTIC, LAW=NORTON, HARDENING=STRAIN\n1E-15, 5., -0.5\n";
  show_limited("NORTON from no strain, m = -0.5", &c, 0, 0.5,
               "the strain begins like t^(1 + m), with an infinite rate");
  c = block;
  c.law = "*INELASTIC, LAW=MAXWELL, TYPE=DEVIATORIC\n2.\n";
  c.pressure = 200;
  c.total = 4;
  c.growth = 0;
  c.friction = "0.25";
  show_limited("MAXWELL, a node begins to slip", &c, 1, 2,
               "rates have a kink where a node changes its status");
  c = block;
  c.law = "*INELASTIC, LAW=MAXWELL, TYPE=DEVIATORIC\n2.\n";
  c.section = "C3D4";
  c.free = 1;
  c.total = 2;
  show_limited("MAXWELL, slip that turns", &c, 1, 1,
               "friction is along the slip of the increment, not of its end");
  ck_assert_msg(wrong == 0, "%d cases are not within 0.3", wrong);
}

UNIT_MAIN("integrators")
