/* src/base/number.c: the number forms of the deck, correctly rounded, in any
 * locale. Expected values are literals of the compiler. */
#include "support/unit.h"

#include <locale.h>

typedef struct good_real {
  const char *text;
  double value;
} good_real;

/* clang-format off */
static const good_real good_reals[] = {
  {"1", 1.0}, {"1.", 1.0}, {".5", 0.5}, {"1.5E3", 1500.0},
  {"1.5e3", 1500.0}, {"1.5D+03", 1500.0}, {"1.5d3", 1500.0},
  {"1.5+03", 1500.0}, {"-.15-003", -0.00015}, {"-2", -2.0}, {"+2", 2.0},
  {"-.25D-1", -0.025}, {"0", 0.0}, {"000", 0.0}, {"0.0E5", 0.0},
  {"  7\t", 7.0}, {"\t7 ", 7.0}, {"0.1", 0.1}, {"0.3", 0.3},
  {"00012.500", 12.5}, {"1.D-10", 1e-10}, {"130.D3", 130e3},
  {"1.7976931348623157E308", DBL_MAX},
  {"2.2250738585072014E-308", DBL_MIN},
  {"4.9406564584124654E-324", 4.9406564584124654E-324},
  {"1E-400", 0.0}, {"1E-99999999999999999999", 0.0},
  {"0E99999999999999999999", 0.0},
  /* Half way between 2^53 and 2^53 + 2: to even; a digit more: up. */
  {"9007199254740993", 9007199254740992.0},
  {"9007199254740993.00000000000000000000000000000001", 9007199254740994.0},
  {"9007199254740995", 9007199254740996.0},
  {"2.2250738585072011e-308", 2.2250738585072011e-308},
  {"6.2230152778611417071440640537801242405902521687211671331011166147896988340"
   "35383441183944823125713616956966589555122482124716043472290625E-0001",
   0.62230152778611417071440640537801242},
};

static const good_real wrong_reals[] = { /* value: 0, reason */
  {"", 0}, {" ", 0}, {"nan", 0}, {"NaN", 0}, {"inf", 0}, {"-Infinity", 0},
  {"0x10", 0}, {"-0X1p3", 0}, {"1.5x", 0}, {"1.5 mm", 0}, {"1.5.", 0},
  {"1,5", 0}, {"1E", 0}, {"1D+", 0}, {"1+", 0}, {".", 0}, {"-", 0}, {"+-1", 0},
  {"E5", 0}, {"1E5.0", 0}, {"1E309", 0}, {"-1.8E308", 0}, {"1.+999", 0},
  {"1 2", 0}, {"1e5e5", 0}, {"<H>", 0}, {"1em", 0}, {"--1", 0},
  {"0.5-1", 0}, {"10-03", 0}, {"2+3", 0},
  {"10\302\240", 0}, {"1. \302\240", 0}, {"\342\210\22210", 0},
};
static const char *const reasons[] = {
  "empty", "empty", "not a number", "not a number", "not a number",
  "not a number", "hexadecimal is not accepted", "hexadecimal is not accepted",
  "letters after the number", "letters after the number",
  "characters after the number", "characters after the number",
  "exponent without digits", "exponent without digits",
  "characters after the number", "not a number", "not a number",
  "not a number", "not a number", "characters after the number", "too large",
  "too large", "too large", "characters after the number",
  "letters after the number", "not a number", "letters after the number",
  "not a number", "a sum, or an exponent without E",
  "a sum, or an exponent without E", "a sum, or an exponent without E",
  "characters beyond ASCII after the number",
  "characters beyond ASCII after the number", "characters beyond ASCII",
};
/* clang-format on */

TEST(every_form_of_a_real_is_read_exactly) {
  for (size_t i = 0; i < sizeof good_reals / sizeof *good_reals; ++i) {
    double x = -77;
    const char *wrong = number_real(good_reals[i].text, &x);
    ck_assert_msg(wrong == NULL, "%s: %s", good_reals[i].text, wrong);
    ck_assert_msg(x == good_reals[i].value, "%s: %.17g", good_reals[i].text, x);
  }
}

TEST(what_is_no_real_is_refused_with_a_reason) {
  size_t n = sizeof wrong_reals / sizeof *wrong_reals;
  ck_assert_uint_eq(n, sizeof reasons / sizeof *reasons);
  for (size_t i = 0; i < n; ++i) {
    double x = -77;
    const char *wrong = number_real(wrong_reals[i].text, &x);
    ck_assert_msg(wrong != NULL, "'%s' accepted", wrong_reals[i].text);
    ck_assert_msg(strcmp(wrong, reasons[i]) == 0, "'%s': %s",
                  wrong_reals[i].text, wrong);
    ck_assert(x == -77);
  }
}

/* The sign of zero is kept. */
TEST(minus_zero_keeps_its_sign) {
  double x = 1;
  ck_assert_ptr_null(number_real("-0.", &x));
  ck_assert(x == 0 && signbit(x));
}

/* 2^-1074 and the number half way above it have 751 digits and more: digits
 * far behind decide. 1 + 2^-53 is half way between 1 and the next double. */
TEST(digits_far_behind_decide_the_rounding) {
  char text[3000] = "1.00000000000000011102230246251565404236316680908203125";
  double x;
  ck_assert_ptr_null(number_real(text, &x));
  ck_assert(x == 1.0);
  size_t n = strlen(text);
  memset(text + n, '0', 2000);
  strcpy(text + n + 2000, "1");
  ck_assert_ptr_null(number_real(text, &x));
  ck_assert(x == 1.0 + DBL_EPSILON);
  strcpy(text + n + 2000, "0");
  ck_assert_ptr_null(number_real(text, &x));
  ck_assert(x == 1.0);
}

TEST(thousands_of_digits_before_the_point) {
  char text[2100];
  double x;
  memset(text, '0', sizeof text);
  text[0] = '1';
  strcpy(text + 2001, "E-2000");
  ck_assert_ptr_null(number_real(text, &x));
  ck_assert(x == 1.0);
  memcpy(text, "0.", 2);
  memset(text + 2, '0', 2000);
  strcpy(text + 2000, "5E1999");
  ck_assert_ptr_null(number_real(text, &x));
  ck_assert(x == 5.0);
}

TEST(integers_are_whole_and_in_range) {
  static const struct {
    const char *text, *wrong;
    int value;
  } cases[] = {
      {"0", NULL, 0},
      {"-7", NULL, -7},
      {"+12 ", NULL, 12},
      {"2147483647", NULL, INT_MAX},
      {"-2147483648", NULL, INT_MIN},
      {"0007", NULL, 7},
      {"2147483648", "too large", -77},
      {"-2147483649", "too large", -77},
      {"99999999999999999999999999", "too large", -77},
      {"1.0", "not an integer", -77},
      {"1E3", "not an integer", -77},
      {"1-3", "not an integer", -77},
      {"x", "not an integer", -77},
      {"-", "not an integer", -77},
      {"", "empty", -77},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
    int n = -77;
    const char *wrong = number_int(cases[i].text, &n);
    if (cases[i].wrong == NULL)
      ck_assert_msg(wrong == NULL, "%s: %s", cases[i].text, wrong);
    else
      ck_assert_str_eq(wrong, cases[i].wrong);
    ck_assert_int_eq(n, cases[i].value);
  }
}

TEST(column_may_have_any_exponent_without_letter) {
  double x = 0;
  ck_assert_ptr_null(number_column("1.5-3", &x));
  ck_assert(x == 0.0015);
  ck_assert_ptr_null(number_column(" 15+2", &x));
  ck_assert(x == 1500.0);
}

TEST(exponent_without_letter_is_known) {
  ck_assert_int_eq(number_bare_exponent("1.5+03"), 1);
  ck_assert_int_eq(number_bare_exponent(" 32-1"), 1);
  ck_assert_int_eq(number_bare_exponent("1.5E+03"), 0);
  ck_assert_int_eq(number_bare_exponent("-1.5"), 0);
  ck_assert_int_eq(number_bare_exponent("1.5+x"), 0);
}

TEST(written_numbers_come_back_exactly) {
  char text[NUMBER_TEXT_SIZE];
  unsigned long long state = 88172645463325252ULL;
  for (int i = 0; i < 60000; ++i) {
    double x, back;
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    memcpy(&x, &state, sizeof x);
    if (!isfinite(x)) continue;
    number_text(x, text);
    ck_assert_msg(number_real(text, &back) == NULL && back == x, "%s", text);
  }
}

TEST(written_numbers_are_short) {
  static const struct {
    double x;
    const char *text;
  } cases[] = {{0.1, "0.1"},
               {32, "32"},
               {0.05 / 2, "0.025"},
               {1e6, "1000000"},
               {-1.5, "-1.5"},
               {1e-10, "1e-10"},
               {2e5 / 3, "66666.66666666667"}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
    char text[NUMBER_TEXT_SIZE];
    number_text(cases[i].x, text);
    ck_assert_str_eq(text, cases[i].text);
  }
}

/* A locale with a decimal comma, if the machine has one. */
TEST(the_locale_has_no_say) {
  static const char *const names[] = {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.utf8",
                                      "de_DE",       "nl_NL.utf8", "C.UTF-8"};
  char text[NUMBER_TEXT_SIZE];
  double x = 0;
  for (size_t i = 0; i < sizeof names / sizeof *names; ++i) {
    if (setlocale(LC_ALL, names[i]) == NULL) continue;
    ck_assert_ptr_null(number_real("1.5E3", &x));
    ck_assert(x == 1500.0);
    ck_assert_ptr_nonnull(number_real("1,5", &x));
    number_text(0.25, text);
    ck_assert_str_eq(text, "0.25");
  }
  setlocale(LC_ALL, "C");
}

UNIT_MAIN("number")
