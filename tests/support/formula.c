/* Quantities of expressions. */
#include "support/formula.h"

#include "base/base.h"
#include "deck/expression.h"

#include <check.h>

void formula_compile(quantity *q, const char *text) {
  expression *e = NULL;
  int column;
  ck_assert_int_eq(expression_compile(text, NULL, NULL, &e, &column), OK);
  q->formula = e;
}

void formula_release(quantity *q) {
  memory_free((expression *)q->formula);
  q->formula = NULL;
}
