/*
 * Reading and testing what is expected.
 */
#include "scenes/expect.h"

#include "base/base.h"
#include "deck/expression.h"

typedef struct expectation {
  char table[16], column[40], key[16], value[200];
  int block, has_key;
  double at, tol;
} expectation;

static double row_value(const dat *d, int row, const char *name) {
  return dat_has(d, name) ? dat_at(d, row, name) : 0.0;
}

/* One alternative, "< 3", "> 0" or an expression. */
static int one_holds(const char *text, double found, const double *x,
                     double tol) {
  expression *e = NULL;
  int column;
  while (*text == ' ') ++text;
  char relation = *text == '<' || *text == '>' ? *text++ : '=';
  if (expression_compile(text, NULL, NULL, &e, &column) != OK) return 0;
  double value = expression_value(e, x, 0.0);
  memory_free(e);
  if (relation == '<') return found <= value + tol;
  if (relation == '>') return found >= value - tol;
  return fabs(found - value) <= tol;
}

static int value_holds(const expectation *t, double found, const double *x) {
  char text[sizeof t->value];
  snprintf(text, sizeof text, "%s", t->value);
  for (char *p = text; p != NULL;) {
    char *next = strstr(p, " or ");
    if (next != NULL) *next = '\0';
    if (one_holds(p, found, x, t->tol)) return 1;
    p = next == NULL ? NULL : next + 4;
  }
  return 0;
}

static int row_holds(const expectation *t, const dat *d, int row, char *why) {
  double x[3] = {row_value(d, row, "x"), row_value(d, row, "y"),
                 row_value(d, row, "z")};
  double found = dat_at(d, row, t->column);
  if (value_holds(t, found, x)) return 1;
  snprintf(why, WHY, "%s %s at (%g, %g, %g): %.12g instead of %s ~ %g",
           t->table, t->column, x[0], x[1], x[2], found, t->value, t->tol);
  return 0;
}

static int table_holds(const expectation *t, const dat *d, char *why) {
  static const double origin[3];
  if (t->column[0] == '+' || t->column[0] == '^') {
    double found = t->column[0] == '+' ? dat_sum(d, t->column + 1)
                                       : dat_max(d, t->column + 1);
    if (value_holds(t, found, origin)) return 1;
    snprintf(why, WHY, "%s %s: %.12g instead of %s ~ %g", t->table, t->column,
             found, t->value, t->tol);
    return 0;
  }
  if (t->has_key) return row_holds(t, d, dat_row_near(d, t->key, t->at), why);
  for (int i = 0; i < d->n_row; ++i)
    if (!row_holds(t, d, i, why)) return 0;
  return d->n_row > 0;
}

/* One of the words with | between them. */
static int has_words(const char *text, const char *words) {
  char list[WHY], *save = NULL;
  snprintf(list, sizeof list, "%s", words);
  for (char *one = strtok_r(list, "|", &save); one != NULL;
       one = strtok_r(NULL, "|", &save))
    if (strstr(text, one) != NULL) return 1;
  return 0;
}

static int words_hold(const job *j, const char *file, int wanted,
                      const char *words, char *why) {
  char *text = strcmp(file, "errors") == 0
                   ? strdup(j->errors == NULL ? "" : j->errors)
                   : job_file(j, file);
  int has = text != NULL && has_words(text, words);
  free(text);
  if (has == wanted) return 1;
  snprintf(why, WHY, "%s %s '%s'", file, has ? "has" : "lacks", words);
  return 0;
}

/* 0 if the text is no test. */
static int read_test(const char *text, expectation *t) {
  char head[120];
  *t = (expectation){.block = -1};
  const char *equals = strstr(text, " = "), *tilde = strrchr(text, '~');
  if (equals == NULL || tilde == NULL || tilde < equals) return 0;
  snprintf(head, sizeof head, "%.*s", (int)(equals - text), text);
  snprintf(t->value, sizeof t->value, "%.*s", (int)(tilde - equals - 3),
           equals + 3);
  t->tol = atof(tilde + 1);
  char *key = strchr(head, '@');
  if (key != NULL) {
    *key = '\0';
    t->has_key = sscanf(key + 1, "%15[^=]=%lf", t->key, &t->at) == 2;
    if (!t->has_key) return 0;
  }
  if (sscanf(head, "%15s %39s", t->table, t->column) != 2) return 0;
  char *dot = strchr(t->table, '.');
  if (dot != NULL) {
    *dot = '\0';
    t->block = atoi(dot + 1);
  }
  return 1;
}

static int test_holds(const job *j, const char *text, char *why) {
  static const char *const verb[] = {" lacks ", " has "};
  expectation t;
  for (int wanted = 0; wanted < 2; ++wanted) {
    const char *at = strstr(text, verb[wanted]);
    if (at == NULL) continue;
    char file[16];
    snprintf(file, sizeof file, "%.*s", (int)(at - text), text);
    return words_hold(j, file, wanted, at + strlen(verb[wanted]), why);
  }
  if (!read_test(text, &t)) {
    snprintf(why, WHY, "no test: %s", text);
    return 0;
  }
  dat d = job_table(j, t.table, t.block);
  snprintf(why, WHY, "%s is empty", t.table);
  int good = table_holds(&t, &d, why);
  dat_free(&d);
  return good;
}

int expect_all(const job *j, const char *tests, char *why) {
  char *text = strdup(tests), *save = NULL;
  int good = 1;
  for (char *p = strtok_r(text, ";", &save); p != NULL && good;
       p = strtok_r(NULL, ";", &save)) {
    while (*p == ' ' || *p == '\n') ++p;
    if (*p != '\0') good = test_holds(j, p, why);
  }
  free(text);
  return good;
}

static double tangential(const dat *d, int row) {
  if (dat_has(d, "f_t")) return fabs(dat_at(d, row, "f_t"));
  return hypot(row_value(d, row, "f_t1"), row_value(d, row, "f_t2"));
}

/* Displacement and force that the run is about: the largest displacement of
 * its nodes; the energy over it, or a larger force of contact. */
static void find_scales(const job *j, const dat *contact, double *length,
                        double *force) {
  dat u = job_table(j, "NODES", -1), e = job_table(j, "ENERGY", -1);
  *length = fmax(dat_max(&u, "u_x"), dat_max(&u, "u_y"));
  if (dat_has(&u, "u_z")) *length = fmax(*length, dat_max(&u, "u_z"));
  *force = dat_max(contact, "f_n");
  if (*length > 0.0)
    *force = fmax(*force, dat_max(&e, "strain_energy") / *length);
  dat_free(&u);
  dat_free(&e);
}

int expect_laws(const job *j, char *why) {
  enum { NO_PULL, NO_ENTRY, ONE_ZERO, WITHIN };
  static const char *const law[] = {"pulls", "penetrates", "pushes from afar",
                                    "exceeds its limit"};
  dat d = job_table(j, "CONTACT", -1);
  double force, length;
  int bad = -1, row = 0;
  find_scales(j, &d, &length, &force);
  for (row = 0; row < d.n_row && bad < 0; ++row) {
    double f = dat_at(&d, row, "f_n"), gap = dat_at(&d, row, "gap");
    if (!(f >= -1e-8 * force)) bad = NO_PULL;
    if (!(gap >= -1e-8 * length)) bad = NO_ENTRY;
    if (f > 1e-8 * force && gap > 1e-8 * length) bad = ONE_ZERO;
    if (tangential(&d, row) > row_value(&d, row, "limit") + 1e-7 * force)
      bad = WITHIN;
  }
  if (bad >= 0) {
    int i = row - 1;
    snprintf(why, WHY, "node %g %s: f_n %g, gap %g, f_t %g, limit %g",
             dat_at(&d, i, "node_no"), law[bad], dat_at(&d, i, "f_n"),
             dat_at(&d, i, "gap"), tangential(&d, i),
             row_value(&d, i, "limit"));
  }
  dat_free(&d);
  return bad < 0;
}
