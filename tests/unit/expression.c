/* src/deck/expression.c against the same formulas written in C. */
#include "deck/expression.h"
#include "support/unit.h"

static const double X = 0.7, Y = -1.3, Z = 2.5, T = 0.4;

static int symbol(const void *ctx, const char *name, double *value) {
  if (strcmp(name, "H") == 0) *value = 0.05;
  if (strcmp(name, "LONG_NAME_2") == 0) *value = 7;
  return strcmp(name, "H") == 0 || strcmp(name, "LONG_NAME_2") == 0;
}

static double value_of(const char *text) {
  expression *e;
  int column;
  const double x[3] = {X, Y, Z};
  status st = expression_compile(text, symbol, NULL, &e, &column);
  ck_assert_msg(st == OK, "%s: %s", text, status_message());
  double v = expression_value(e, x, T);
  memory_free(e);
  return v;
}

#define PI 3.14159265358979323846

TEST(values_agree_with_c) {
  const struct {
    const char *text;
    double value;
  } cases[] = {
      {"1", 1},
      {" 1.5D+03 ", 1500},
      {"1.5+03", 4.5},
      {"1+2*3", 7},
      {"(1+2)*3", 9},
      {"2^3^2", 512},
      {"-2^2", -4},
      {"(-2)^2", 4},
      {"2^-1", 0.5},
      {"2^-3^2", pow(2, -9)},
      {"(1024*340.6645864337725)^2 - 2^20*340.6645864337725^2", 0},
      {"2*-3", -6},
      {"2--3", 5},
      {"-+-3", 3},
      {"8/4/2", 1},
      {"8-4-2", 2},
      {"1-2+3", 2},
      {"2*3/4", 1.5},
      {"x+y*z-t", X + Y * Z - T},
      {"X*Y", X * Y},
      {"1<2", 1},
      {"2<=1", 0},
      {"x>y", 1},
      {"x>=0.7", 1},
      {"x==0.7", 1},
      {"x!=0.7", 0},
      {"1<2&2<3", 1},
      {"1<2&3<2|1", 1},
      {"0|0", 0},
      {"5&0", 0},
      {"1+1==2", 1},
      {"-1<0", 1},
      {"if(x>0,t,2)", T},
      {"if(x<0,t,2)", 2},
      {"if(-x,t,2)", T},
      {"if(0,1/0,3)", 3},
      {"sin(x)", sin(X)},
      {"COS(x)", cos(X)},
      {"Tan( x )", tan(X)},
      {"asin(x)", asin(X)},
      {"acos(x)", acos(X)},
      {"atan(z)", atan(Z)},
      {"atan2(y,x)", atan2(Y, X)},
      {"sinh(x)", sinh(X)},
      {"cosh(x)", cosh(X)},
      {"tanh(x)", tanh(X)},
      {"exp(x)", exp(X)},
      {"log(z)", log(Z)},
      {"log10(z)", log10(Z)},
      {"sqrt(z)", sqrt(Z)},
      {"abs(y)", 1.3},
      {"sign(y)", -1},
      {"sign(0)", 0},
      {"sign(z)", 1},
      {"min(x,y)", Y},
      {"max(x,y)", X},
      {"max(1,x,z,y,2)", Z},
      {"min(1,x,z,y,2)", Y},
      {"floor(y)", -2},
      {"ceil(y)", -1},
      {"mod(7,3)", 1},
      {"mod(-1,3)", 2},
      {"step(x)", 1},
      {"step(0)", 1},
      {"step(y)", 0},
      {"pi", PI},
      {"2*PI", 2 * PI},
      {"H*2", 0.1},
      {"h", 0.05},
      {"long_name_2", 7},
      {"sin(cos(min(x,max(y,z))))", sin(cos(X))},
      {"((((((((x))))))))", X},
      {"1e3*x", 1000 * X},
      {"2.*x", 2 * X},
      {".5*x", .5 * X},
      {"1E-3+1", 1.001},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
    double v = value_of(cases[i].text);
    /* The compiler may round the functions of a constant better.            */
    ck_assert_msg(fabs(v - cases[i].value) <= 4e-16 * fabs(cases[i].value),
                  "%s: %.17g, not %.17g", cases[i].text, v, cases[i].value);
  }
}

TEST(what_is_not_defined_is_not_hidden) {
  ck_assert(isnan(value_of("log(y)")));
  ck_assert(isinf(value_of("1/(x-x)")));
  ck_assert(isnan(value_of("max(1,sqrt(y))")));
  ck_assert(isnan(value_of("max(sqrt(y),1)")));
  ck_assert(isnan(value_of("min(sqrt(y),1)")));
  ck_assert(isnan(value_of("step(sqrt(y))")));
  ck_assert(isnan(value_of("sign(sqrt(y))")));
}

TEST(wrong_texts_are_refused_where_they_are_wrong) {
  static const struct {
    const char *text, *why;
    int column;
  } cases[] = {
      {"", "a value is missing at the end", 0},
      {"   ", "a value is missing at the end", 3},
      {"1+", "a value is missing at the end", 2},
      {"1 2", "an operator is missing before '2'", 2},
      {"2x", "letters after the number: '2x'", 0},
      {"2 x", "an operator is missing before 'x'", 2},
      {"*2", "a value is missing before '*'", 0},
      {"2**3", "a power is written ^", 1},
      {"1&&2", "and is written &", 1},
      {"1||2", "or is written |", 1},
      {"1=2", "equality is written ==", 1},
      {"(1+2", "'(' is not closed", 0},
      {"1+(2*(3)", "'(' is not closed", 2},
      {"1)", "')' without '('", 1},
      {"()", "a value is missing before ')'", 1},
      {"sin()", "a value is missing before ')'", 4},
      {"sin(1,2)", "SIN takes 1 argument, not 2", 0},
      {"1+atan2(1)", "ATAN2 takes 2 arguments, not 1", 2},
      {"max(1)", "MAX takes 2 arguments or more, not 1", 0},
      {"if(1,2)", "IF takes 3 arguments, not 2", 0},
      {"if(1,2,3,4)", "IF takes 3 arguments, not 4", 0},
      {"sin 1", "unknown name SIN", 0},
      {"sin(1", "'(' is not closed", 0},
      {"sine(1)", "unknown function SINE; did you mean SIN?", 0},
      {"foo(1)", "unknown function FOO", 0},
      {"qwertz(1)", "unknown function QWERTZ", 0},
      {"1+foo", "unknown name FOO", 2},
      {"1,2", "a comma outside the arguments of a function", 1},
      {"(1,2)", "a comma outside the arguments of a function", 2},
      {"max(1,)", "a value is missing before ')'", 6},
      {"max(,1)", "a value is missing before ','", 4},
      {"1E", "exponent without digits: '1E'", 0},
      {"1.2.3", "characters after the number: '1.2.3'", 0},
      {"1E999", "too large: '1E999'", 0},
      {"0x10", "hexadecimal is not accepted: '0x10'", 0},
      {"nan", "unknown name NAN", 0},
      {"inf", "unknown name INF", 0},
      {"x<H>", "a value is missing at the end", 4},
      {"1 $ 2", "an operator is missing before '$'", 2},
      {"$", "a value is missing before '$'", 0},
      {"\x01", "a character that has no meaning here", 0},
      {"1 \xC3\xA4", "a character that has no meaning here", 2},
      {"!1", "a value is missing before '!'", 0},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
    expression *e = (expression *)&e;
    int column = -1;
    status st = expression_compile(cases[i].text, symbol, NULL, &e, &column);
    ck_assert_msg(st == ERR_DECK, "'%s' accepted", cases[i].text);
    ck_assert_ptr_null(e);
    ck_assert_msg(strcmp(status_message(), cases[i].why) == 0, "'%s': %s",
                  cases[i].text, status_message());
    ck_assert_msg(column == cases[i].column, "'%s': column %d", cases[i].text,
                  column);
  }
}

TEST(variables_are_those_that_occur) {
  static const struct {
    const char *text;
    unsigned bits;
  } cases[] = {{"1", 0}, {"x", 1},      {"Y", 2},        {"z", 4},
               {"t", 8}, {"x*t+z", 13}, {"exp(1)+h", 0}, {"if(1,2,y)", 2}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
    OWNED expression *e = NULL;
    int column;
    ck_assert_int_eq(
        expression_compile(cases[i].text, symbol, NULL, &e, &column), OK);
    ck_assert_uint_eq(expression_variables(e), cases[i].bits);
  }
}

/* n times "open", then 1, then n times "close". */
static status compile_nested(const char *open, const char *close, int n) {
  size_t a = strlen(open), b = strlen(close), size = (a + b) * (size_t)n + 2;
  char *text = malloc(size), *p = text;
  for (int i = 0; i < n; ++i, p += a) memcpy(p, open, a);
  *p++ = '1';
  for (int i = 0; i < n; ++i, p += b) memcpy(p, close, b);
  *p = '\0';
  expression *e;
  int column;
  const double x[3] = {0, 0, 0};
  status st = expression_compile(text, NULL, NULL, &e, &column);
  if (st == OK) (void)expression_value(e, x, 0);
  memory_free(e);
  free(text);
  return st;
}

TEST(nesting_is_bounded) {
  static const char *const pairs[][2] = {
      {"(", ")"},   {"sin(", ")"},   {"-", ""},        {"2^", ""},
      {"x+(", ")"}, {"max(x,", ")"}, {"if(x,y,", ")"}, {"x^", ""}};
  for (size_t i = 0; i < sizeof pairs / sizeof *pairs; ++i) {
    ck_assert_int_eq(compile_nested(pairs[i][0], pairs[i][1], 20), OK);
    ck_assert_int_eq(compile_nested(pairs[i][0], pairs[i][1], 100000),
                     ERR_DECK);
    ck_assert_str_eq(status_message(), "nested too deeply");
  }
}

/* The value stack holds 64: x^(x^(...^1)) needs one more for each level. */
TEST(values_on_the_stack_are_bounded) {
  for (int n = 1; n < 300; ++n)
    ck_assert_int_eq(compile_nested("x^", "", n), n < 64 ? OK : ERR_DECK);
  for (int n = 1; n < 300; ++n)
    ck_assert_int_eq(compile_nested("if(x,y,", ")", n),
                     2 * n < 64 ? OK : ERR_DECK);
  /* what is worked out takes one place */
  for (int n = 1; n < 300; ++n)
    ck_assert_int_eq(compile_nested("if(-x*x,y,", ")", n),
                     2 * n < 64 ? OK : ERR_DECK);
}

TEST(long_flat_expressions_are_no_matter) {
  ck_assert_int_eq(compile_nested("1+", "", 100000), OK);
  ck_assert_int_eq(compile_nested("x*2-", "", 100000), OK);
  ck_assert_int_eq(compile_nested("", "+max(1,2,3,4)", 10000), OK);
}

TEST(a_refused_request_leaves_nothing_behind) {
  expression *e;
  int column;
  UNIT_REFUSED(1,
               expression_compile("max(x,1.5,t*2)+sin(y)^2-if(x<y,x,y*z+1)",
                                  NULL, NULL, &e, &column),
               memory_free(e));
  memory_free(NULL);
}

UNIT_MAIN("expression")
