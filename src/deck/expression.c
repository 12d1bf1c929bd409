/*
 * Expressions: one pass over the text with a stack of waiting operators
 * (Dijkstra's shunting yard) gives reverse Polish code. Both stacks are
 * bounded, so that the cost of the compiler and the evaluation is bounded for
 * any text.
 */
#include "deck/expression.h"

#include "base/base.h"
#include "base/option.h"

enum { STACK = 64, WAITING = 128, NAME_SIZE = 64 };

typedef double unary_fn(double a);
typedef double binary_fn(double a, double b);

typedef enum { NUMBER, VARIABLE, UNARY, BINARY, CHOICE } item_kind;

typedef struct item {
  item_kind kind;
  double number;
  int variable; /* 0..3: x y z t */
  unary_fn *unary;
  binary_fn *binary;
} item;

struct expression {
  int n, capacity;
  item *code; /* [n] reverse Polish */
  unsigned variables;
};

static double negative(double a) { return -a; }
static double sign(double a) { return a > 0 ? 1 : a < 0 ? -1 : a; }
static double step(double a) { return a >= 0 ? 1 : a < 0 ? 0 : a; }
static double add(double a, double b) { return a + b; }
static double subtract(double a, double b) { return a - b; }
static double multiply(double a, double b) { return a * b; }
static double divide(double a, double b) { return a / b; }
/* Small whole powers are products: bits stay in units that differ by powers of
 * two, which pow rounds otherwise. */
static double power(double a, double b) {
  double product = a;
  if (b != 2 && b != 3 && b != 4) return pow(a, b);
  for (int k = 1; k < b; ++k) product *= a;
  return product;
}
static double modulo(double a, double b) { return a - b * floor(a / b); }
static double smaller(double a, double b) { return b < a || b != b ? b : a; }
static double larger(double a, double b) { return b > a || b != b ? b : a; }
static double less(double a, double b) { return a < b; }
static double less_equal(double a, double b) { return a <= b; }
static double greater(double a, double b) { return a > b; }
static double greater_equal(double a, double b) { return a >= b; }
static double equal(double a, double b) { return a == b; }
static double not_equal(double a, double b) { return a != b; }
static double both(double a, double b) { return a != 0 && b != 0; }
static double either(double a, double b) { return a != 0 || b != 0; }

typedef struct function {
  const char *name;
  int n_min, n_max; /* arguments; n_max 0: any number */
  unary_fn *unary;
  binary_fn *binary; /* both NULL: if(a, b, c) */
} function;

typedef struct operator_row {
  const char *sign;
  int precedence, right;
  binary_fn *apply; /* NULL: not to be used, the name is in "hint" */
  const char *hint;
} operator_row;

/* clang-format off */
static const function functions[] = {
  {"SIN",   1, 1, sin,   NULL},   {"COS",   1, 1, cos,   NULL},
  {"TAN",   1, 1, tan,   NULL},   {"ASIN",  1, 1, asin,  NULL},
  {"ACOS",  1, 1, acos,  NULL},   {"ATAN",  1, 1, atan,  NULL},
  {"SINH",  1, 1, sinh,  NULL},   {"COSH",  1, 1, cosh,  NULL},
  {"TANH",  1, 1, tanh,  NULL},   {"EXP",   1, 1, exp,   NULL},
  {"LOG",   1, 1, log,   NULL},   {"LOG10", 1, 1, log10, NULL},
  {"SQRT",  1, 1, sqrt,  NULL},   {"ABS",   1, 1, fabs,  NULL},
  {"SIGN",  1, 1, sign,  NULL},   {"STEP",  1, 1, step,  NULL},
  {"FLOOR", 1, 1, floor, NULL},   {"CEIL",  1, 1, ceil,  NULL},
  {"ATAN2", 2, 2, NULL,  atan2},  {"MOD",   2, 2, NULL,  modulo},
  {"MIN",   2, 0, NULL,  smaller},{"MAX",   2, 0, NULL,  larger},
  {"IF",    3, 3, NULL,  NULL},
};

/* Longer signs before those they start with. */
static const operator_row operators[] = {
  {"**", 0, 0, NULL,          "a power is written ^"},
  {"&&", 0, 0, NULL,          "and is written &"},
  {"||", 0, 0, NULL,          "or is written |"},
  {"|",  1, 0, either,        NULL}, {"&",  2, 0, both,      NULL},
  {"==", 3, 0, equal,         NULL}, {"!=", 3, 0, not_equal, NULL},
  {"<=", 4, 0, less_equal,    NULL}, {"<",  4, 0, less,      NULL},
  {">=", 4, 0, greater_equal, NULL}, {">",  4, 0, greater,   NULL},
  {"=",  0, 0, NULL,          "equality is written =="},
  {"+",  5, 0, add,           NULL}, {"-",  5, 0, subtract,  NULL},
  {"*",  6, 0, multiply,      NULL}, {"/",  6, 0, divide,    NULL},
  {"^",  8, 1, power,         NULL},
};
/* clang-format on */

enum {
  N_FUNCTION = sizeof functions / sizeof *functions,
  N_OPERATOR = sizeof operators / sizeof *operators,
  MINUS_PRECEDENCE = 7 /* of the sign: -2^2 = -4, 2*-3 = -6 */
};

/* Operators that wait for their right operand or closing parenthesis. */
typedef struct waiting {
  enum { WAIT_SIGN, WAIT_OPERATOR, WAIT_PARENTHESIS, WAIT_CALL } kind;
  const operator_row *operation;
  const function *called;
  int n_argument; /* complete ones of the call */
  int column;
} waiting;

typedef struct compiler {
  const char *text, *p;
  const char *const *names; /* [4] of the variables */
  symbol_value_fn *symbol;
  const void *ctx;
  expression *e;
  int depth; /* values on the stack after the code so far */
  int n_waiting;
  waiting stack[WAITING];
  int column; /* of the error */
} compiler;

static int is_digit(char c) { return c >= '0' && c <= '9'; }

static int is_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
         is_digit(c);
}

static void skip_blanks(compiler *c) {
  while (*c->p == ' ' || *c->p == '\t') ++c->p;
}

static void mark(compiler *c, const char *p) { c->column = (int)(p - c->text); }

static double apply(const item *op, const double *a) {
  if (op->kind == UNARY) return op->unary(a[0]);
  if (op->kind == BINARY) return op->binary(a[0], a[1]);
  return a[0] != 0 ? a[1] : a[2];
}

static int operands(const item *op) {
  return op->kind == UNARY ? 1 : op->kind == BINARY ? 2 : 3;
}

/* Operation on numbers alone: computed now. */
static int fold(expression *e, const item *op) {
  double a[3];
  int k = operands(op);
  for (int i = 0; i < k; ++i) {
    const item *number = &e->code[e->n - k + i];
    if (number->kind != NUMBER) return 0;
    a[i] = number->number;
  }
  e->n -= k;
  e->code[e->n++] = (item){.kind = NUMBER, .number = apply(op, a)};
  return 1;
}

static status emit_value(compiler *c, const item *value) {
  expression *e = c->e;
  if (++c->depth > STACK) RAISE(ERR_DECK, "nested too deeply");
  PASS_GROW(e->code, e->n, e->capacity);
  e->code[e->n++] = *value;
  return OK;
}

static status emit_operation(compiler *c, const item *op) {
  expression *e = c->e;
  c->depth -= operands(op) - 1;
  if (fold(e, op)) return OK;
  PASS_GROW(e->code, e->n, e->capacity);
  e->code[e->n++] = *op;
  return OK;
}

static status emit_waiting(compiler *c, const waiting *w) {
  item op = {.kind = BINARY};
  if (w->kind == WAIT_SIGN) {
    op.kind = UNARY;
    op.unary = negative;
  } else {
    op.binary = w->operation->apply;
  }
  return emit_operation(c, &op);
}

static int precedence(const waiting *w) {
  if (w->kind == WAIT_SIGN) return MINUS_PRECEDENCE;
  return w->kind == WAIT_OPERATOR ? w->operation->precedence : 0;
}

/* Emit operators of at least precedence "level", down to a parenthesis. */
static status emit_down_to(compiler *c, int level) {
  while (c->n_waiting > 0 && precedence(&c->stack[c->n_waiting - 1]) >= level) {
    PASS(emit_waiting(c, &c->stack[c->n_waiting - 1]));
    --c->n_waiting;
  }
  return OK;
}

static status push(compiler *c, const waiting *w) {
  if (c->n_waiting == WAITING) RAISE(ERR_DECK, "nested too deeply");
  c->stack[c->n_waiting++] = *w;
  return OK;
}

/* Upper case name at c->p, which moves on; cut if longer than any known. */
static void read_name(compiler *c, char name[NAME_SIZE]) {
  int n = 0;
  for (; is_name(*c->p); ++c->p)
    if (n < NAME_SIZE - 1)
      name[n++] =
          *c->p >= 'a' && *c->p <= 'z' ? (char)(*c->p - 'a' + 'A') : *c->p;
  name[n] = '\0';
}

static const function *find_function(const char *name) {
  for (int i = 0; i < N_FUNCTION; ++i)
    if (strcmp(functions[i].name, name) == 0) return &functions[i];
  return NULL;
}

static status read_call(compiler *c, const char *name) {
  waiting w = {.kind = WAIT_CALL, .called = find_function(name)};
  w.column = c->column;
  if (w.called == NULL) {
    const char *near =
        nearest_word(name, candidate_name, NAMES(functions, N_FUNCTION));
    if (near != NULL)
      RAISE(ERR_DECK, "unknown function %s; did you mean %s?", name, near);
    RAISE(ERR_DECK, "unknown function %s", name);
  }
  ++c->p; /* the parenthesis */
  return push(c, &w);
}

static int find_variable(const compiler *c, const char *name) {
  for (int i = 0; i < 4; ++i)
    if (choice_rank(c->names[i], name) >= 0) return i;
  return -1;
}

/* Variable, constant or name of the caller. */
static status read_named_value(compiler *c, const char *name) {
  item value = {.kind = NUMBER};
  int variable = find_variable(c, name);
  if (variable >= 0) {
    value.kind = VARIABLE;
    value.variable = variable;
    c->e->variables |= 1u << variable;
  } else if (strcmp(name, "PI") == 0) {
    value.number = 3.14159265358979323846;
  } else if (c->symbol == NULL || !c->symbol(c->ctx, name, &value.number)) {
    RAISE(ERR_DECK, "unknown name %s", name);
  }
  return emit_value(c, &value);
}

/* One past the last character of a number; an exponent needs its letter. */
static const char *number_end(const char *p) {
  while (is_digit(*p) || *p == '.') ++p;
  if (*p != '\0' && strchr("eEdD", *p) != NULL) {
    ++p;
    if (*p == '+' || *p == '-') ++p;
  }
  while (is_name(*p) || *p == '.') ++p;
  return p;
}

static status read_number(compiler *c) {
  char shown[NAME_SIZE];
  item value = {.kind = NUMBER};
  const char *end = number_end(c->p);
  size_t length = end - c->p;
  snprintf(shown, sizeof shown, "%.*s", (int)length, c->p);
  OWNED_NEW(char, text, length + 1);
  memcpy(text, c->p, length);
  const char *wrong = number_real(text, &value.number);
  if (wrong != NULL) RAISE(ERR_DECK, "%s: '%s'", wrong, shown);
  c->p = end;
  return emit_value(c, &value);
}

static status missing_value(compiler *c) {
  if (*c->p == '\0') RAISE(ERR_DECK, "a value is missing at the end");
  if ((unsigned char)*c->p > ' ' && (unsigned char)*c->p < 127)
    RAISE(ERR_DECK, "a value is missing before '%c'", *c->p);
  RAISE(ERR_DECK, "a character that has no meaning here");
}

/* Where a value must start. *complete: 1 if it is there, 0 if after a sign,
 * a parenthesis or a function name it is still to come. */
static status read_operand(compiler *c, int *complete) {
  char name[NAME_SIZE];
  waiting w = {.kind = *c->p == '(' ? WAIT_PARENTHESIS : WAIT_SIGN};
  *complete = 0;
  w.column = c->column;
  if (*c->p == '+') {
    ++c->p;
  } else if (*c->p == '-' || *c->p == '(') {
    ++c->p;
    PASS(push(c, &w));
  } else if (is_digit(*c->p) || *c->p == '.') {
    *complete = 1;
    PASS(read_number(c));
  } else if (is_name(*c->p)) {
    read_name(c, name);
    skip_blanks(c);
    *complete = *c->p != '(';
    PASS(*complete ? read_named_value(c, name) : read_call(c, name));
  } else {
    PASS(missing_value(c));
  }
  return OK;
}

/* An argument of the call on top of the stack is complete. */
static status end_argument(compiler *c, waiting *w) {
  item op = {.kind = BINARY, .binary = w->called->binary};
  ++w->n_argument;
  if (w->called->n_max == 0 && w->n_argument > 1) return emit_operation(c, &op);
  return OK;
}

static status end_call(compiler *c, waiting *w) {
  const function *f = w->called;
  item op = {CHOICE, 0, 0, f->unary, f->binary};
  PASS(end_argument(c, w));
  int n = w->n_argument;
  if (n < f->n_min || (f->n_max > 0 && n > f->n_max)) {
    c->column = w->column;
    RAISE(ERR_DECK, "%s takes %d argument%s%s, not %d", f->name, f->n_min,
          f->n_min == 1 ? "" : "s", f->n_max == 0 ? " or more" : "", n);
  }
  if (f->n_max == 0) return OK;
  if (f->unary != NULL) op.kind = UNARY;
  if (f->binary != NULL) op.kind = BINARY;
  return emit_operation(c, &op);
}

static status read_closing(compiler *c) {
  PASS(emit_down_to(c, 1));
  if (c->n_waiting == 0) RAISE(ERR_DECK, "')' without '('");
  waiting *w = &c->stack[c->n_waiting - 1];
  if (w->kind == WAIT_CALL) PASS(end_call(c, w));
  --c->n_waiting;
  ++c->p;
  return OK;
}

static const operator_row *find_operator(const char *p) {
  for (int i = 0; i < N_OPERATOR; ++i)
    if (strncmp(operators[i].sign, p, strlen(operators[i].sign)) == 0)
      return &operators[i];
  return NULL;
}

static status read_operator(compiler *c) {
  waiting w = {.kind = WAIT_OPERATOR, .operation = find_operator(c->p)};
  if (w.operation == NULL) {
    if ((unsigned char)*c->p > ' ' && (unsigned char)*c->p < 127)
      RAISE(ERR_DECK, "an operator is missing before '%c'", *c->p);
    RAISE(ERR_DECK, "a character that has no meaning here");
  }
  if (w.operation->apply == NULL) RAISE(ERR_DECK, "%s", w.operation->hint);
  PASS(emit_down_to(c, w.operation->precedence + w.operation->right));
  w.column = c->column;
  PASS(push(c, &w));
  c->p += strlen(w.operation->sign);
  return OK;
}

static status compile(compiler *c) {
  int complete = 0; /* a value stands to the left */
  for (;;) {
    skip_blanks(c);
    mark(c, c->p);
    if (!complete) {
      PASS(read_operand(c, &complete));
      continue;
    }
    if (*c->p == '\0') break;
    if (*c->p == ')') {
      PASS(read_closing(c));
    } else if (*c->p == ',') {
      PASS(emit_down_to(c, 1));
      waiting *w = c->n_waiting > 0 ? &c->stack[c->n_waiting - 1] : NULL;
      if (w == NULL || w->kind != WAIT_CALL)
        RAISE(ERR_DECK, "a comma outside the arguments of a function");
      PASS(end_argument(c, w));
      ++c->p;
      complete = 0;
    } else {
      PASS(read_operator(c));
      complete = 0;
    }
  }
  PASS(emit_down_to(c, 1));
  if (c->n_waiting > 0) {
    c->column = c->stack[c->n_waiting - 1].column;
    RAISE(ERR_DECK, "'(' is not closed");
  }
  return OK;
}

status expression_compile(const char *text, symbol_value_fn *symbol,
                          const void *ctx, expression **out, int *column) {
  static const char *const names[] = {"X", "Y", "Z", "T"};
  return expression_compile_in(text, names, symbol, ctx, out, column);
}

status expression_compile_in(const char *text, const char *const names[4],
                             symbol_value_fn *symbol, const void *ctx,
                             expression **out, int *column) {
  status st = OK;
  compiler c = {
      .text = text, .p = text, .names = names, .symbol = symbol, .ctx = ctx};
  *out = NULL;
  *column = 0;
  PASS_NEW(c.e, 1);
  OWNS(c.e);
  TRY(compile(&c));
  *out = c.e;
  c.e = NULL;
done:
  *column = c.column;
  memory_free(c.e);
  return st;
}

double expression_value(const expression *e, const double x[3], double t) {
  double stack[STACK];
  int n = 0;
  for (EACH(const item, op, e->code, e->n)) {
    if (op->kind == NUMBER) {
      stack[n++] = op->number;
    } else if (op->kind == VARIABLE) {
      stack[n++] = op->variable == 3 ? t : x[op->variable];
    } else {
      n -= operands(op);
      stack[n] = apply(op, &stack[n]);
      ++n;
    }
  }
  return stack[0];
}

unsigned expression_variables(const expression *e) { return e->variables; }

/* ---- quantities: number or expression, times a table --------------------- */

double table_value(const value_table *p, const double x[3], double t) {
  if (p->n == 0)
    return p->formula == NULL ? 1.0 : expression_value(p->formula, x, t);
  double s = p->variable == TABLE_T ? t : x[p->variable];
  if (s <= p->at[0]) return p->value[0];
  int last = p->n - 1;
  if (s >= p->at[last]) return p->value[last];
  int low = 0, high = last;
  while (high - low > 1) {
    int middle = (low + high) / 2;
    if (p->at[middle] <= s)
      low = middle;
    else
      high = middle;
  }
  double w = (s - p->at[low]) / (p->at[high] - p->at[low]);
  return (1.0 - w) * p->value[low] + w * p->value[high];
}

double quantity_value(const quantity *q, const double x[3], double t) {
  double v =
      q->formula == NULL ? q->number : expression_value(q->formula, x, t);
  if (q->factor == NULL) return v;
  return v * table_value(q->factor, x, t - q->factor_start);
}

static unsigned table_variables(const value_table *p) {
  if (p->n > 0) return 1u << p->variable;
  return p->formula == NULL ? 0u : expression_variables(p->formula);
}

unsigned quantity_variables(const quantity *q) {
  unsigned v = q->formula == NULL ? 0u : expression_variables(q->formula);
  return q->factor == NULL ? v : v | table_variables(q->factor);
}
