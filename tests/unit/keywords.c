/*
 * src/model/keyword/keywords.c, and the options and coefficients of solvers,
 * friction laws and inelastic laws: ranges and defaults as the manual and
 * physics demand, in a list of their own.
 */
#include "contact/friction.h"
#include "material/law/law.h"
#include "model/keyword/keyword.h"
#include "solver/solver.h"
#include "support/text_model.h"
#include "support/unit.h"

#define ANY DBL_MAX
#define POSITIVE DBL_MIN
#define ABSENT OPTION_ABSENT

/* Of a card or a law, in its order. A flag has 0 and 1, a word 0 and 0; names
 * without a default are left out. */
/* clang-format off */
static const struct {
  const char *card, *name;
  double least, most;
  const char *initial;
} rows[] = {
  {"MESH", "SCALE", POSITIVE, ANY, "1"},
  {"CONDENSED PROBLEM", "TYPE", 0, 0, ABSENT},
  {"ELASTIC", "TYPE", 0, 0, "ISO"},
  {"ELASTIC", "MODULI", 0, 0, ABSENT},
  {"INELASTIC", "SHIFT", 0, 0, "NONE"},
  {"INELASTIC", "T_REF", -ANY, ANY, ABSENT},
  {"INELASTIC", "C1", 0, ANY, ABSENT},
  {"INELASTIC", "C2", POSITIVE, ANY, ABSENT},
  {"INELASTIC", "ACTIVATION", 0, ANY, ABSENT},
  {"INELASTIC", "T_ZERO", -ANY, ANY, ABSENT},
  {"CREEP", "LAW", 0, 0, "STRAIN"},
  {"CREEP", "SHIFT", 0, 0, "NONE"},
  {"CREEP", "T_REF", -ANY, ANY, ABSENT},
  {"CREEP", "C1", 0, ANY, ABSENT},
  {"CREEP", "C2", POSITIVE, ANY, ABSENT},
  {"CREEP", "ACTIVATION", 0, ANY, ABSENT},
  {"CREEP", "T_ZERO", -ANY, ANY, ABSENT},
  {"VISCOELASTIC", "TIME", 0, 0, NULL},
  {"VISCOELASTIC", "SHIFT", 0, 0, "NONE"},
  {"VISCOELASTIC", "T_REF", -ANY, ANY, ABSENT},
  {"VISCOELASTIC", "C1", 0, ANY, ABSENT},
  {"VISCOELASTIC", "C2", POSITIVE, ANY, ABSENT},
  {"VISCOELASTIC", "ACTIVATION", 0, ANY, ABSENT},
  {"VISCOELASTIC", "T_ZERO", -ANY, ANY, ABSENT},
  {"TRS", "DEFINITION", 0, 0, "WLF"},
  {"EXPANSION", "TYPE", 0, 0, "ISO"},
  {"EXPANSION", "ZERO", -ANY, ANY, "0"},
  {"SOLID SECTION", "TYPE", 0, 0, ABSENT},
  {"SOLID SECTION", "THICKNESS", POSITIVE, ANY, "1"},
  {"SOLID SECTION", "FORMULATION", 0, 0, "STANDARD"},
  {"AMPLITUDE", "TIME", 0, 0, "STEP TIME"},
  {"TIME POINTS", "TIME", 0, 0, "STEP TIME"},
  {"TIME POINTS", "GENERATE", 0, 1, "NO"},
  {"OBSTACLE", "TYPE", 0, 0, NULL},
  {"OBSTACLE", "RADIUS", POSITIVE, ANY, ABSENT},
  {"OBSTACLE", "SIDE", 0, 0, "OUTSIDE"},
  {"CONTACT", "NORMAL", 0, 0, ABSENT},
  {"CONTACT PAIR", "SLAVE", 0, 0, "AUTO"},
  {"CONTACT PAIR", "NORMAL", 0, 0, "MEAN"},
  {"CONTACT PAIR", "ADJUST", 0, 0, "NO"},
  {"CONTACT PAIR", "UPDATE", 0, 0, "NO"},
  {"CONTACT PAIR", "TYPE", 0, 0, "SURFACE TO SURFACE"},
  {"TIE", "SLAVE", 0, 0, "AUTO"},
  {"TIE", "ADJUST", 0, 0, "NO"},
  {"FRICTION", "TABLE", 0, 0, ABSENT},
  {"INITIAL CONDITIONS", "TYPE", 0, 0, NULL},
  {"INITIAL CONDITIONS", "INCOMPATIBLE", 0, 0, "REFUSE"},
  {"CONTACT FORCE", "TABLE", 0, 0, ABSENT},
  {"WEAR", "COEFFICIENT", 0, ANY, NULL},
  {"QUASISTATIC", "FORM", 0, 0, "DISPLACEMENT"},
  {"VISCO", "THETA", POSITIVE, 1, "0.5"},
  {"VISCO", "TOLERANCE", 1e-12, 1, ABSENT},
  {"VISCO", "ITERATION", 0, 0, "TANGENT"},
  {"VISCO", "SUBSTEPS", 0, 0, "NO"},
  {"BOUNDARY", "OP", 0, 0, "MOD"},
  {"DSLOAD", "OP", 0, 0, "MOD"},
  {"DLOAD", "OP", 0, 0, "MOD"},
  {"CLOAD", "OP", 0, 0, "MOD"},
  {"TEMPERATURE", "OP", 0, 0, "MOD"},
  {"SOLVER", "METHOD", 0, 0, "AUTO"},
  {"SOLVER", "TOL", 1e-14, 0.1, "1E-10"},
  {"SOLVER", "SHARE", 0.001, 1, "0.05"},
  {"SOLVER", "MAX_ITER", 0, 1e8, "0"},
  {"SOLVER", "LIMIT_MAX_ITER", 1, 1e6, "1000"},
  {"SOLVER", "CHECK", 0, 0, "NO"},
  {"SOLVER", "STIFFNESS", 0, 0, "AUTO"},
  {"SOLVER", "MAX_MEMORY", 0, 1e12, "0"},
  {"SOLVER", "NESTED", 0, 1, "NO"},
  {"ACCURACY", "MESH", 0, 0, "END"},
  {"ACCURACY", "TIME", 0, 0, "NO"},
  {"ACCURACY", "TIME_SHARE", 0.001, 1, "0.1"},
  {"ACCURACY", "SOLVER", 0, 1, "YES"},
  {"ACCURACY", "THEORY", 0, 1, "NO"},
  {"ACCURACY", "TARGET", 0, 100, "0"},
  {"ACCURACY", "MAX_CPU", 0, 1e12, "0"},
  {"ACCURACY", "MAX_MEMORY", 0, 1e12, "0"},
  {"ACCURACY", "MAX_PASSES", 1, 20, "8"},
  {"GOAL", "QUANTITY", 0, 0, NULL},
  {"GOAL", "COMPONENT", 0, 0, ABSENT},
  {"GOAL", "RADIUS", POSITIVE, ANY, ABSENT},
  {"EFFECTS", "MODE", 0, 0, "CALLED"},
  {"EFFECTS", "TOL", POSITIVE, 0.1, "1e-3"},
  {"PRINT", "CONTACT", 0, 1, "NO"},
  {"PRINT", "TOTALS", 0, 1, "NO"},
  {"PRINT", "NODES", 0, 1, "NO"},
  {"PRINT", "ELEMENTS", 0, 1, "NO"},
  {"PRINT", "ENERGY", 0, 1, "NO"},
  {"PRINT", "REACTIONS", 0, 1, "NO"},
  {"PRINT", "ZONES", 0, 1, "NO"},
  {"PRINT", "LOOP", 0, 1, "NO"},
  {"PRINT", "WEAR", 0, 1, "NO"},
  {"PRINT", "SIF", 0, 1, "NO"},
  {"PRINT", "GOALS", 0, 1, "NO"},
  {"PRINT", "FREQUENCY", 0, 1e9, "1"},
  {"OUTPUT", "HDF5", 0, 1, "YES"},
  {"OUTPUT", "FREQUENCY", 0, 1e9, "1"},
  {"OUTPUT", "CONDENSED", 0, 0, "NO"},
  {"RESTART", "FREQUENCY", 0, 1e9, "1"},
  {"newton", "STEPS", 0, 10000, "0"},
  {"lemke", "FACETS", 4, 64, "8"},
  {"sor", "OMEGA", 0, 1.999, "0"},
  {"sor", "SWEEP", 0, 0, "FORWARD"},
  {"sor", "FRICTION", 0, 0, "DIRECT"},
  {"pcg", "PRECONDITIONER", 0, 0, "FACE"},
  {"auglag", "VARIANT", 0, 0, "NEWTON"},
  {"aitken", "ACCELERATION", 0, 0, "AITKEN"},
  {"lagrange", "ACCELERATION", 0, 0, "NESTEROV"},
  {"NONLOCAL", "RADIUS", POSITIVE, ANY, NULL},
  {"NONLOCAL", "KERNEL", 0, 0, "BUMP"},
  {"NONLOCAL", "EDGE", 0, 0, "FREE"},
  {"NONLOCAL", "ZONE", 0, 0, "SURFACE"},
  {"NONLOCAL", "DISTANCE", 0, 0, "STRAIGHT"},
  {"NONLOCAL", "MIRROR_X", 0, 0, "NONE"},
  {"NONLOCAL", "MIRROR_Y", 0, 0, "NONE"},
  {"NONLOCAL", "MIRROR_Z", 0, 0, "NONE"},
  {"MAXWELL", "TYPE", 0, 0, "PROPORTIONAL"},
  {"MAXWELL", "tau", POSITIVE, ANY, NULL},
  {"MAXWELL", "tau_bulk", 0, ANY, ABSENT},
  {"ZENER", "TYPE", 0, 0, "PROPORTIONAL"},
  {"ZENER", "E1", 0, ANY, NULL},
  {"ZENER", "eta1", POSITIVE, ANY, NULL},
  {"KELVIN", "TYPE", 0, 0, "PROPORTIONAL"},
  {"KELVIN", "E_k", 0, ANY, NULL},
  {"KELVIN", "eta_k", POSITIVE, ANY, NULL},
  {"BURGERS", "TYPE", 0, 0, "PROPORTIONAL"},
  {"BURGERS", "eta_M", POSITIVE, ANY, NULL},
  {"BURGERS", "E_K", 0, ANY, NULL},
  {"BURGERS", "eta_K", POSITIVE, ANY, NULL},
  {"PRONY", "g_i", 0, 1, "0"},
  {"PRONY", "k_i", 0, 1, "0"},
  {"PRONY", "tau_i", POSITIVE, ANY, NULL},
  {"NORTON", "HARDENING", 0, 0, "TIME"},
  {"NORTON", "A", 0, ANY, NULL},
  {"NORTON", "n", 1, 1000, NULL},
  {"NORTON", "m", -0.99, 1, "0"},
  {"HYPERBOLIC", "A", 0, ANY, NULL},
  {"HYPERBOLIC", "B", POSITIVE, ANY, NULL},
  {"HYPERBOLIC", "n", 1, 1000, NULL},
  {"HYPERBOLIC", "dH", 0, ANY, "0"},
  {"HYPERBOLIC", "R", POSITIVE, ANY, "8.314462618"},
  {"PERZYNA", "sigma_y", 0, ANY, NULL},
  {"PERZYNA", "eta", POSITIVE, ANY, NULL},
  {"PERZYNA", "H", 0, ANY, "0"},
  {"PERZYNA", "n", 1, 1000, "1"},
  {"PERZYNA", "Q", -ANY, ANY, "0"},
  {"PERZYNA", "b", 0, ANY, "0"},
  {"BINGHAM", "sigma_y", 0, ANY, NULL},
  {"BINGHAM", "eta", POSITIVE, ANY, NULL},
  {"CHABOCHE", "sigma_y", 0, ANY, NULL},
  {"CHABOCHE", "K", POSITIVE, ANY, NULL},
  {"CHABOCHE", "n", 1, 1000, NULL},
  {"CHABOCHE", "Q", -ANY, ANY, "0"},
  {"CHABOCHE", "b", 0, ANY, "0"},
  {"CHABOCHE", "C_k", 0, ANY, NULL},
  {"CHABOCHE", "gamma_k", 0, ANY, "0"}
};
/* clang-format on */

enum { N_ROW = sizeof rows / sizeof *rows };

static int same_text(const char *a, const char *b) {
  return a == b || (a != NULL && b != NULL && strcmp(a, b) == 0);
}

static void compare(const char *of, const option *table, int *n) {
  for (const option *o = table; o != NULL && o->name != NULL; ++o) {
    if (o->type == OPT_NAME && (!o->initial || !strcmp(o->initial, ABSENT)))
      continue;
    const int i = (*n)++;
    ck_assert_int_lt(i, N_ROW);
    ck_assert_msg(
        strcmp(rows[i].card, of) == 0 && strcmp(rows[i].name, o->name) == 0,
        "%s, %s: the list has %s, %s", of, o->name, rows[i].card, rows[i].name);
    ck_assert_msg(rows[i].least == o->min && rows[i].most == o->max,
                  "%s, %s: [%g, %g], expected [%g, %g]", of, o->name, o->min,
                  o->max, rows[i].least, rows[i].most);
    ck_assert_msg(same_text(rows[i].initial, o->initial),
                  "%s, %s: default %s, expected %s", of, o->name, o->initial,
                  rows[i].initial);
  }
}

TEST(ranges_and_defaults_are_those_of_the_manual) {
  int n = 0;
  for (const keyword *k = keyword_table; k->name != NULL; ++k)
    compare(k->name, k->options, &n);
  for (int i = 0; solver_list[i] != NULL; ++i)
    compare(solver_list[i]->name, solver_list[i]->options, &n);
  for (int i = 0; friction_list[i] != NULL; ++i)
    compare(friction_list[i]->name, friction_list[i]->options, &n);
  for (int i = 0; law_list[i] != NULL; ++i) {
    compare(law_list[i]->name, law_list[i]->options, &n);
    compare(law_list[i]->name, law_list[i]->fields, &n);
    compare(law_list[i]->name, law_list[i]->terms, &n);
  }
  ck_assert_int_eq(n, N_ROW);
}

/* 1: the message with that number is told of the cards. */
static int is_told(const char *number, const char *cards) {
  FREED char *told = NULL;
  size_t size;
  TEXT_MODEL s = text_model_read(cards, NULL);
  FILE *out = open_memstream(&told, &size);
  message_print(s.log, out);
  fclose(out);
  return strstr(told, number) != NULL;
}

#define BODY "*MATERIAL, NAME=M\n*ELASTIC\n9., 0.3\n"
#define RELAXING "*VISCOELASTIC, TIME=PRONY\n0.5, 0., 1.\n"
#define POINTS "*TIME POINTS, NAME=P, GENERATE\n"

/* Fields of data lines, which have no table. */
TEST(numbers_of_data_lines_have_their_ranges) {
  static const struct {
    const char *number, *cards; /* of the message; %s: the field */
    const char *right[2], *wrong[2];
  } rows_of_data[] = {
      {"P2010", BODY "*DENSITY\n%s\n", {"0.", "1E-9"}, {"-1E-9"}},
      {"P2010", BODY RELAXING "*TRS\n20., %s, 50.\n", {"0."}, {"-1E-9"}},
      {"P2010", BODY RELAXING "*TRS\n20., 17., %s\n", {"1E-9"}, {"0."}},
      {"P2010",
       BODY "*SOLID SECTION, ELSET=B, MATERIAL=M\n%s\n",
       {"1E-9"},
       {"0.", "-1E-9"}},
      {"P2010", "*STEP\n*STATIC\n%s\n", {"1E-9"}, {"0.", "-1E-9"}},
      {"P2010", "*STEP\n*QUASISTATIC\n%s, 1.\n", {"1E-8"}, {"0.", "-1."}},
      {"P2020", "*STEP\n*QUASISTATIC\n%s, 1.\n", {"1E-8", "1."}, {"1.001"}},
      {"P2010", "*STEP\n*QUASISTATIC\n0.5, %s\n", {"0.5"}, {"0.", "-1."}},
      {"P2010", "*STEP\n*QUASISTATIC\n0.5, 1., %s\n", {"1E-9"}, {"0."}},
      {"P2020", "*STEP\n*QUASISTATIC\n0.5, 1., %s\n", {"0.5"}, {"0.501"}},
      {"P2010", "*STEP\n*QUASISTATIC\n1., 2., .1, %s\n", {"1."}, {"0."}},
      {"P2020", "*STEP\n*QUASISTATIC\n1., 2., .1, %s\n", {"1."}, {"0.99"}},
      {"P2057", POINTS "1., %s, 1.\n", {"1.", "9E5"}, {"0.9", "1000001."}},
      {"P2057", POINTS "1., 2., %s\n", {"1E-5", "3."}, {"0.", "-1."}},
  };
  for (size_t i = 0; i < sizeof rows_of_data / sizeof *rows_of_data; ++i)
    for (int k = 0; k < 4; ++k) {
      const char *text =
          k < 2 ? rows_of_data[i].right[k] : rows_of_data[i].wrong[k - 2];
      if (text == NULL) continue;
      PRINTED(cards, rows_of_data[i].cards, text);
      ck_assert_msg(is_told(rows_of_data[i].number, cards) == (k >= 2), "%s",
                    cards);
    }
}

UNIT_MAIN("keywords")
