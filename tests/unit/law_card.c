/*
 * Data of inelastic laws from the deck: every law's example, every field of
 * every law wrong in turn, tables over temperature, expressions of time, the
 * spellings of Abaqus, moduli after all terms have relaxed.
 */
#include "support/law_case.h"
#include "support/text_model.h"
#include "support/unit.h"

enum { TEXT = 4000, VALUES = 64 };

/* Deck with a material of E = 1000, nu = 0.3 and the cards given. */
static void read_deck(text_model *s, const char *elastic, const char *cards) {
  PRINTED(text,
          "*MESH, FILE=none.msh\n*MATERIAL, NAME=M\n*ELASTIC%s\n1000., 0.3\n"
          "%s\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n*STEP\n*STATIC\n"
          "*END STEP\n",
          elastic, cards);
  *s = text_model_read(text, NULL);
}

static const law_card *law_of(const text_model *s) {
  return &s->m->materials[0].law;
}

static void values_at(const text_model *s, double t, double T, double *value) {
  ck_assert_int_le(law_n_value(law_of(s)), VALUES);
  ck_assert_int_eq(law_values(law_of(s), t, T, value), OK);
}

static void near(double a, double b) {
  ck_assert_msg(fabs(a - b) <= 1e-13 * fabs(b), "%.16g, expected %.16g", a, b);
}

TEST(every_example_reads_as_it_is) {
  for (int i = 0; law_list[i] != NULL; ++i) {
    static law_case c;
    double value[VALUES];
    TEXT_MODEL s;
    PRINTED(cards, "*INELASTIC, LAW=%s\n%s", law_list[i]->name,
            law_list[i]->example);
    read_deck(&s, "", cards);
    ck_assert_msg(s.st == OK, "%s", cards);
    ck_assert_int_eq(law_case_new(law_list[i], 0, NULL, 1000, .3, SOLID_3D, &c),
                     1);
    ck_assert(law_of(&s)->ops == law_list[i]);
    ck_assert_int_eq(law_of(&s)->n_term, c.card.n_term);
    ck_assert_uint_eq(law_varies(law_of(&s)), 0);
    ck_assert_int_eq(law_of(&s)->formula != NULL, c.card.formula != NULL);
    values_at(&s, 0, 0, value);
    (void)law_case_point(&c);
    for (int k = 0; k < law_n_value(law_of(&s)); ++k)
      ck_assert(value[k] == c.value[k]);
    law_case_free(&c);
  }
}

/* Word number k of a line, "" behind its end. */
static const char *word_of(const char *line, int k, int *length) {
  const char *end = line + strcspn(line, "\n");
  for (; k > 0; --k) {
    line += strcspn(line, ",\n");
    if (line < end) ++line;
  }
  *length = (int)strcspn(line, ",\n");
  return line;
}

/* The example with field "at" of line "row" (n fields) replaced. */
static void replace_field(const char *example, int row, int n, int at,
                          const char *with, char *out, size_t size) {
  size_t used = 0;
  const char *line = example;
  for (int i = 0; *line != '\0'; ++i) {
    const int whole = (int)strcspn(line, "\n");
    int length;
    for (int k = 0; k < n && i == row; ++k) {
      const char *word = word_of(line, k, &length);
      used += (size_t)snprintf(
          out + used, size - used, "%s%.*s", k == 0 ? "" : ",",
          k == at ? (int)strlen(with) : length, k == at ? with : word);
    }
    if (i != row)
      used += (size_t)snprintf(out + used, size - used, "%.*s", whole, line);
    used += (size_t)snprintf(out + used, size - used, "\n");
    line += whole + (line[whole] == '\n');
  }
  ck_assert_uint_lt(used, size);
}

/* The deck with that data must give the message. */
static void refused(const law_ops *ops, const char *data, const char *number,
                    const char *words) {
  FREED char *told = NULL;
  size_t size;
  TEXT_MODEL s;
  PRINTED(cards, "*INELASTIC, LAW=%s\n%s", ops->name, data);
  read_deck(&s, "", cards);
  FILE *out = open_memstream(&told, &size);
  message_print(s.log, out);
  fclose(out);
  ck_assert_msg(s.st == ERR_DECK, "%s", cards);
  ck_assert_msg(strstr(told, number) != NULL && strstr(told, words) != NULL,
                "%s\n%s %s expected, told\n%s", cards, number, words, told);
}

static void check_line(const law_ops *ops, const option *table, int row) {
  char data[TEXT];
  const int n = law_n_field(table);
  for (int k = 0; table[k].name != NULL; ++k) {
    replace_field(ops->example, row, n, k, " much", data, sizeof data);
    refused(ops, data, "P1024", "much");
    if (table[k].min > -1e300) {
      replace_field(ops->example, row, n, k, " -1E300", data, sizeof data);
      refused(ops, data, "P2010", table[k].name);
    }
    if (table[k].initial != NULL) continue;
    replace_field(ops->example, row, n, k, " \"\"", data, sizeof data);
    refused(ops, data, "P1037", "empty");
  }
}

TEST(every_field_is_checked) {
  for (int i = 0; law_list[i] != NULL; ++i) {
    const law_ops *ops = law_list[i];
    int row = 0;
    if (ops->fields != NULL) check_line(ops, ops->fields, row++);
    if (ops->terms != NULL) check_line(ops, ops->terms, row);
  }
}

TEST(a_threshold_may_fall) {
  static const char *const cards[] = {
      "*INELASTIC, LAW=PERZYNA\n60., 150., 0., 3., -20., 5.",
      "*INELASTIC, LAW=CHABOCHE\n60., 150., 3., -20., 5.\n2E4, 100."};
  for (int i = 0; i < 2; ++i) {
    TEXT_MODEL s;
    read_deck(&s, "", cards[i]);
    ck_assert_msg(s.st == OK, "%s", cards[i]);
  }
}

TEST(tables_are_linear_in_temperature) {
  double value[VALUES];
  TEXT_MODEL s;
  read_deck(&s, "",
            "*INELASTIC, LAW=CHABOCHE\n60., 150., 3., , , 20.\n2E4, 100., 20.\n"
            "40., 100., 4., , , 60.\n1E4, 200., 60.");
  ck_assert_int_eq(s.st, OK);
  ck_assert_uint_eq(law_varies(law_of(&s)), LAW_VARIES_TEMPERATURE);
  ck_assert_int_eq(law_of(&s)->n_term, 1);
  values_at(&s, 0, 30, value);
  near(value[0], 55);
  near(value[2], 3.25);
  near(value[5], 1.75e4);
  near(value[6], 125);
  values_at(&s, 0, -1000, value);
  near(value[1], 150);
  values_at(&s, 0, 1000, value);
  near(value[6], 200);
}

TEST(coefficients_may_vary_in_time) {
  double value[VALUES];
  text_model s;
  read_deck(&s, "", "*INELASTIC, LAW=MAXWELL\n\"2 + sin(t)\"");
  ck_assert_int_eq(s.st, OK);
  ck_assert_uint_eq(law_varies(law_of(&s)), LAW_VARIES_TIME);
  values_at(&s, 1.5, 0, value);
  near(value[0], 2 + sin(1.5));
  text_model_close(&s);
  read_deck(&s, "", "*INELASTIC, LAW=MAXWELL\n\"2 - t\"");
  ck_assert_int_eq(s.st, OK);
  ck_assert_int_eq(law_values(law_of(&s), 3, 0, value), ERR_DECK);
  ck_assert_ptr_nonnull(strstr(status_message(), "tau = -1 is not positive"));
  text_model_close(&s);
  read_deck(&s, "", "*INELASTIC, LAW=HYPERBOLIC\n1E-3, .02, 3., \"1E4*t\"");
  ck_assert_int_eq(s.st, OK);
  ck_assert_uint_eq(law_varies(law_of(&s)),
                    LAW_VARIES_TIME | LAW_VARIES_TEMPERATURE);
  text_model_close(&s);
  for (unsigned bits = 0; bits < 4; ++bits) {
    PRINTED(cards, "*INELASTIC, LAW=USER\n\"1E-9*q%s%s\"",
            bits & LAW_VARIES_TIME ? "*(1 + t)" : "",
            bits & LAW_VARIES_TEMPERATURE ? "*exp(temp)" : "");
    read_deck(&s, "", cards);
    ck_assert_int_eq(s.st, OK);
    ck_assert_uint_eq(law_varies(law_of(&s)), bits);
    text_model_close(&s);
  }
}

/* Rate of e^i along x at t = 4 under 100 along x. */
static double creep_rate(const char *cards, double w, double dt) {
  static law_case c;
  double ei_rate[6], alpha_rate[LAW_ALPHA_MAX], value[VALUES];
  TEXT_MODEL s;
  read_deck(&s, "", cards);
  ck_assert_int_eq(s.st, OK);
  law_case_new(&norton_law, 0, NULL, 1000, .3, SOLID_3D, &c);
  law_point p = law_case_point(&c);
  values_at(&s, 4, 0, value);
  p.law = law_of(&s);
  p.value = value;
  p.t = 4;
  c.sigma[0] = 100;
  p.dt = dt;
  c.alpha[0] = w;
  law_rate(&p, ei_rate, alpha_rate);
  law_case_free(&c);
  return ei_rate[0];
}

/* The factor is 1E-9, 100 cubed 1e6; time hardening with 4^(-1/2) = 1/2. Strain
 * hardening keeps p squared, here 1/4: (1e-3)^2 over half of p = 1/2. */
TEST(creep_cards_of_abaqus) {
  near(creep_rate("*CREEP, LAW=TIME\n1E-9, 3., -0.5", 0.25, 1), 5e-4);
  near(creep_rate("*CREEP, LAW=NORTON\n1E-9, 3.", 0.25, 1), 1e-3);
  near(creep_rate("*CREEP\n1E-9, 3., -0.5", 0.25, 1), 1e-6 / 0.25);
  static const char strain[] =
      "*INELASTIC, LAW=NORTON, HARDENING=STRAIN\n1E-9, 3., -0.5";
  near(creep_rate(strain, 0.25, 1), 1e-6 / 0.25);
  /* From p = 0: p = 2e-3 sqrt(t), its mean rate over 4. */
  near(creep_rate(strain, 0, 4), 1e-3);
}

/* C_xy,xy and the bulk modulus of the matrix the elements get. */
static void check_moduli(const char *elastic, const char *cards, double shear,
                         double bulk) {
  TEXT_MODEL s;
  read_deck(&s, elastic, cards);
  ck_assert_int_eq(s.st, OK);
  const double *C = s.m->materials[0].C;
  near(C[21], shear);
  near((C[0] + 2 * C[6]) / 3, bulk);
}

/* The long-term constants are those that are linear between the sets. */
TEST(long_term_moduli_between_two_sets) {
  TEXT_MODEL s;
  double C[36];
  char text[256];
  const double E = 1500, nu = 0.2, G = E / (2 + 2 * nu), K = E / (3 - 6 * nu);
  read_deck(&s,
            "\n2000., 0.1, 0.\n1000., 0.3, 100.\n900., 0.2, 200.\n"
            "*VISCOELASTIC, TIME=PRONY\n.3, .1, 2.\n.2, .15, 9.\n"
            "*MATERIAL, NAME=N\n*ELASTIC",
            "");
  ck_assert_int_eq(s.st, OK);
  ck_assert_ptr_null(
      elastic_at(&s.m->materials[0].elastic, 50.0, C, text, sizeof text));
  near(C[21], G / .5);
  near((C[0] + 2 * C[6]) / 3, K / .75);
  /* the largest Poisson number of all: of the second, G = E/2.6, K = E/1.2 */
  near(elastic_table_most(&s.m->materials[0].elastic, 1),
       (3 / (1.2 * .75) - 2 / (2.6 * .5)) / (6 / (1.2 * .75) + 2 / (2.6 * .5)));
}

TEST(moduli_after_all_terms_have_relaxed) {
  const double G = 1000 / 2.6, K = 1000 / 1.2;
  const char *abaqus = "*VISCOELASTIC, TIME=PRONY\n.3, .1, 2.\n.2, .15, 9.";
  const char *shear = "*VISCOELASTIC, TIME=PRONY\n.3, , 2.\n.2, , 9.";
  const char *own = "*INELASTIC, LAW=PRONY\n.3, .1, 2.\n.2, .15, 9.";
  check_moduli("", abaqus, G / .5, K / .75);
  check_moduli("", shear, G / .5, K);
  check_moduli(", MODULI=LONG TERM", own, G / .5, K / .75);
  check_moduli(", MODULI=INSTANTANEOUS", abaqus, G, K);
  check_moduli("", own, G, K);
}

/* The k-th request of memory fails, for all k: told, and nothing is lost. */
TEST(every_refused_request_is_reported) {
  static const char *const cards[] = {
      "*INELASTIC, LAW=PRONY\n.3, .1, 2., 20.\n.2, .1, \"3 + t\", 60.",
      "*INELASTIC, LAW=USER\n\"1E-9*q^3\""};
  for (int i = 0; i < 2; ++i) {
    int refused = 0;
    for (long k = 1;; ++k) {
      const size_t before = memory_in_use();
      text_model s;
      read_deck(&s, "", cards[i]);
      memory_free(s.m);
      s.m = NULL;
      memory_refuse(k, 0);
      s.st = model_from_deck(s.d, s.log, &s.m);
      memory_refuse(0, 0);
      ck_assert(s.st == OK || s.st == ERR_MEMORY);
      const int done = s.st == OK;
      refused += !done;
      text_model_close(&s);
      ck_assert_uint_eq(memory_in_use(), before);
      if (done) break;
    }
    ck_assert_int_gt(refused, 5);
  }
}

UNIT_MAIN("law_card")
