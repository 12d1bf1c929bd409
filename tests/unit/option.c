/* src/base/option.c: option tables and the nearest word. */
#include "base/option.h"
#include "support/unit.h"

typedef struct sample {
  int count, symmetric, kind;
  double omega, tol;
  const char *name;
} sample;

/* clang-format off */
static const option table[] = {
  OPTION_INT(sample, count, "COUNT", 1, 100, "20", "-", "number of things"),
  OPTION_REAL(sample, omega, "OMEGA", 0, 2, "1.5", "-", "relaxation"),
  OPTION_REAL(sample, tol, "TOL", 1e-16, DBL_MAX, "1.D-8", "-", "tolerance"),
  OPTION_FLAG(sample, symmetric, "SYMMETRIC", "YES", "a flag"),
  OPTION_CHOICE(sample, kind, "KIND", "ISO|ORTHO|INELASTIC STRAIN", "ISO", "k"),
  OPTION_NAME(sample, name, "NAME", OPTION_ABSENT, "a name"),
  OPTION_END
};
/* clang-format on */

TEST(rows_are_found_by_their_full_name) {
  ck_assert_ptr_eq(option_find(table, "OMEGA"), &table[1]);
  ck_assert_ptr_null(option_find(table, "OMEG"));
  ck_assert_ptr_null(option_find(table, "OMEGAS"));
  ck_assert_ptr_null(option_find(table, "omega"));
  ck_assert_ptr_null(option_find(NULL, "OMEGA"));
}

TEST(defaults_are_stored) {
  sample s;
  memset(&s, 0, sizeof s);
  option_defaults(table, &s);
  ck_assert_int_eq(s.count, 20);
  ck_assert(s.omega == 1.5 && s.tol == 1e-8);
  ck_assert_int_eq(s.symmetric, 1);
  ck_assert_int_eq(s.kind, 0);
  ck_assert_ptr_null(s.name);
  option_defaults(NULL, &s);
}

/* What each wrong value is answered with. */
TEST(wrong_values_are_refused_with_the_range_or_the_words) {
  static const struct {
    const char *name, *text, *why;
  } cases[] = {
      {"OMEGA", "2.5", "2.5 outside [0, 2]"},
      {"OMEGA", "-1D-3", "-0.001 outside [0, 2]"},
      {"OMEGA", "x", "not a number: 'x'"},
      {"OMEGA", "nan", "not a number: 'nan'"},
      {"OMEGA", "1.5m", "letters after the number: '1.5m'"},
      {"OMEGA", NULL, "a value is needed"},
      {"OMEGA", "", "a value is needed"},
      {"TOL", "0", "0 below 1e-16"},
      {"COUNT", "101", "101 outside [1, 100]"},
      {"COUNT", "2.0", "not an integer: '2.0'"},
      {"COUNT", "99999999999", "too large: '99999999999'"},
      {"SYMMETRIC", "MAYBE", "'MAYBE' is neither YES nor NO"},
      {"KIND", "ORTO",
       "'ORTO' is none of ISO|ORTHO|INELASTIC STRAIN; did you mean ORTHO?"},
      {"KIND", "ZZZ", "'ZZZ' is none of ISO|ORTHO|INELASTIC STRAIN"},
      {"KIND", NULL, "a value is needed"},
      {"NAME", "", "a value is needed"},
      {"NAME", NULL, "a value is needed"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
    sample s, before;
    char why[200] = "";
    memset(&s, 0x55, sizeof s);
    before = s;
    const option *row = option_find(table, cases[i].name);
    ck_assert_int_eq(option_read(row, cases[i].text, &s, why, sizeof why), -1);
    ck_assert_str_eq(why, cases[i].why);
    ck_assert_int_eq(memcmp(&s, &before, sizeof s), 0);
  }
}

TEST(right_values_are_read) {
  sample s;
  char why[100];
  memset(&s, 0, sizeof s);
  ck_assert_int_eq(
      option_read(&table[4], "inelastic   strain", &s, why, sizeof why), 0);
  ck_assert_int_eq(s.kind, 2);
  ck_assert_int_eq(option_read(&table[3], NULL, &s, why, sizeof why), 0);
  ck_assert_int_eq(s.symmetric, 1);
  ck_assert_int_eq(option_read(&table[3], "no", &s, why, sizeof why), 0);
  ck_assert_int_eq(s.symmetric, 0);
  ck_assert_int_eq(option_read(&table[1], "2.D0", &s, why, sizeof why), 0);
  ck_assert(s.omega == 2);
  ck_assert_int_eq(option_read(&table[5], "Steel", &s, why, sizeof why), 0);
  ck_assert_str_eq(s.name, "Steel");
}

TEST(a_long_wrong_value_does_not_overrun_the_message) {
  sample s = {0, 0, 0, 0, 0, NULL};
  char text[5000], why[20];
  memset(text, 'A', sizeof text - 1);
  text[sizeof text - 1] = '\0';
  for (const option *row = table; row->type != OPT_NAME; ++row) {
    memset(why, '#', sizeof why);
    ck_assert_int_eq(option_read(row, text, &s, why, sizeof why - 1), -1);
    ck_assert_int_eq(why[sizeof why - 1], '#');
  }
}

TEST(what_is_written_is_read_back) {
  sample s = {17, 1, 2, 1.0 / 3, 1e-9 / 7, "Steel 7"}, back;
  memset(&back, 0, sizeof back);
  for (const option *row = table; row->name != NULL; ++row) {
    char text[100], why[100];
    option_write(row, &s, text, sizeof text);
    if (row->type == OPT_NAME)
      ck_assert_str_eq(text, "Steel 7");
    else
      ck_assert_int_eq(option_read(row, text, &back, why, sizeof why), 0);
  }
  ck_assert(back.omega == s.omega && back.tol == s.tol);
  ck_assert(back.count == 17 && back.symmetric == 1 && back.kind == 2);
  char none[] = "none";
  s.name = NULL;
  option_write(&table[5], &s, none, sizeof none);
  ck_assert_str_eq(none, "");
}

TEST(words_of_a_choice_have_their_rank) {
  char text[20];
  ck_assert_int_eq(choice_rank("A|BB|C", "bb"), 1);
  ck_assert_int_eq(choice_rank("A|BB|C", "B"), -1);
  ck_assert_int_eq(choice_rank("A|BB|C", "BBB"), -1);
  ck_assert_int_eq(choice_rank("A|BB|C", ""), -1);
  ck_assert_int_eq(choice_rank("A|BB|C", "A|BB"), -1);
  ck_assert_int_eq(choice_rank("A|BB|C", " C "), 2);
  choice_word("A|BB|C", 1, text, sizeof text);
  ck_assert_str_eq(text, "BB");
  choice_word("A|BB|C", 2, text, sizeof text);
  ck_assert_str_eq(text, "C");
}

static const char *const cards[] = {
    "HEADING", "FRICTION", "CONTACT", "MATERIAL", "ELASTIC", "SOLID SECTION",
    "STEP",    "END STEP", "N",       "DLOAD",    "DSLOAD",  NULL};

static const char *next_card(const void *ctx, int i) {
  return ((const char *const *)ctx)[i];
}

TEST(nearest_word_is_found_if_it_is_near) {
  static const struct {
    const char *word, *near;
  } cases[] = {{"FRICTON", "FRICTION"},
               {"FRCITION", "FRICTION"},
               {"friction", "FRICTION"},
               {"HAEDING", "HEADING"},
               {"MATERIALS", "MATERIAL"},
               {"ELASTIK", "ELASTIC"},
               {"SOLID", "SOLID SECTION"},
               {"SOLIDSECTION", "SOLID SECTION"},
               {"STPE", "STEP"},
               {"DLAOD", "DLOAD"},
               {"DSLAOD", "DSLOAD"},
               {"QQQQQQQ", NULL},
               {"X", NULL},
               {"", NULL},
               {"M", NULL},
               {"TEMPERATURE", NULL}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
    const char *near = nearest_word(cases[i].word, next_card, cards);
    if (cases[i].near == NULL)
      ck_assert_msg(near == NULL, "%s: %s", cases[i].word, near);
    else
      ck_assert_msg(near != NULL && strcmp(near, cases[i].near) == 0, "%s: %s",
                    cases[i].word, near != NULL ? near : "none");
  }
}

/* Two letters exchanged are one error, nearer than two others. */
TEST(exchanged_letters_count_once) {
  static const char *const words[] = {"ABXY", "ABCD", NULL};
  ck_assert_str_eq(nearest_word("ABDC", next_card, words), "ABCD");
  ck_assert_ptr_null(nearest_word("", next_card, words));
}

TEST(no_word_is_near_where_there_are_no_rows) {
  const option *none = NULL;
  ck_assert_ptr_null(nearest_word("TOL", candidate_name, NAMES(none, 0)));
}

TEST(a_value_that_is_not_finite_is_said_to_be_so) {
  char why[120];
  range_text(INFINITY, DBL_MIN, DBL_MAX, why, sizeof why);
  ck_assert_str_eq(why, "inf is not a finite number");
  range_text(-INFINITY, DBL_MIN, DBL_MAX, why, sizeof why);
  ck_assert_str_eq(why, "-inf is not a finite number");
  range_text(NAN, 0, 1, why, sizeof why);
  ck_assert_str_eq(why, "nan is not a finite number");
}

TEST(a_very_long_word_is_near_to_none) {
  char word[10000];
  memset(word, 'A', sizeof word - 1);
  word[sizeof word - 1] = '\0';
  ck_assert_ptr_null(nearest_word(word, next_card, cards));
}

UNIT_MAIN("option")
