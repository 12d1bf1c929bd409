/*
 * Coefficients of a law: read from the data lines of its card; their values at
 * a time and temperature (numbers or expressions of t, linear between the
 * temperatures of the table and constant outside); the time-temperature shifts.
 */
#include "material/law/law.h"

#include "base/base.h"

int law_n_field(const option *table) {
  int n = 0;
  if (table == NULL) return 0;
  while (table[n].name != NULL) ++n;
  return n;
}

int law_n_value(const law_card *law) {
  return law_n_field(law->ops->fields) +
         law->n_term * law_n_field(law->ops->terms);
}

/* Number of rows that must be given. */
static int needed(const option *table) {
  int n = 0;
  for (int i = 0; table[i].name != NULL; ++i)
    if (table[i].initial == NULL) n = i + 1;
  return n;
}

const char *law_line_text(const option *table, char *text, size_t size) {
  const int n = needed(table);
  text[0] = '\0';
  for (int i = 0; table[i].name != NULL; ++i)
    text_add(text, size, i < n ? "%s%s" : " [%s%s]", i == 0 ? "" : ", ",
             table[i].name);
  text_add(text, size, " [, temperature]");
  return text;
}

/* Reading the lines of a card. */
typedef struct lines {
  deck *d;
  const card *c;
  message_log *log;
  law_card *law;
  int n_line;  /* of a set: equal for all */
  int n_value; /* read so far */
  int capacity, set_capacity;
  int has_temperature; /* the first line ends with one; all do, then */
  int in_set;          /* lines of the current set */
  int wrong;           /* an error is in the log */
} lines;

/* One coefficient: a number in range, or an expression of t. */
static int read_value(const lines *r, const field *f, const option *row,
                      quantity *out) {
  char why[128];
  if (deck_quantity(r->d, f, NULL, r->log, out) != 0) return -1;
  if (out->formula != NULL) {
    if ((expression_variables(out->formula) & 7u) == 0) return 0;
    message_add(r->log, P2033, &f->at,
                "*%s: %s may depend on t only, not on x, y, z", r->c->name,
                row->name);
    return -1;
  }
  if (out->number >= row->min && out->number <= row->max) return 0;
  range_text(out->number, row->min, row->max, why, sizeof why);
  message_add(r->log, P2010, &f->at, "*%s: %s = %s", r->c->name, row->name,
              why);
  return -1;
}

static void wrong_count(const lines *r, const record *line,
                        const option *table) {
  char text[256];
  message_add(r->log, P2009, &line->at,
              "%d field%s on this line of *%s; expected: %s", line->n_field,
              line->n_field == 1 ? "" : "s", r->c->name,
              law_line_text(table, text, sizeof text));
}

/* The values of a line; an empty field or none has its initial value. */
static status read_line(lines *r, const record *line, const option *table) {
  double initial;
  const int n = law_n_field(table);
  if (line->n_field < needed(table) || line->n_field > n + 1) {
    wrong_count(r, line, table);
    r->wrong = 1;
  }
  for (int i = 0; i < n && !r->wrong; ++i) {
    const field *f = i < line->n_field ? &line->fields[i] : NULL;
    ADDED(quantity, q, r->law->value, r->n_value, r->capacity);
    const int absent = f == NULL || (f->text[0] == '\0' && !f->quoted);
    if (!absent || table[i].initial == NULL)
      r->wrong |= read_value(r, f, &table[i], q) != 0;
    else if (strcmp(table[i].initial, OPTION_ABSENT) != 0 &&
             number_real(table[i].initial, &initial) == NULL)
      q->number = initial;
  }
  return OK;
}

/* Temperature of a line into T; 0: it has none. */
static int line_temperature(lines *r, const record *line, const option *table,
                            double *T) {
  const int n = law_n_field(table);
  if (line->n_field != n + 1) return 0;
  r->wrong |= deck_real(&line->fields[n], r->log, T) != 0;
  return 1;
}

/* Open a set for a line whose temperature is not that of the last one. */
static status open_set(lines *r, const record *line, double T) {
  law_card *law = r->law;
  if (law->n_set > 0 && !(T > law->temperature[law->n_set - 1])) {
    message_add(r->log, P2029, &line->at,
                "*%s: the temperatures must ascend, but %.15g follows %.15g",
                r->c->name, T, law->temperature[law->n_set - 1]);
    r->wrong = 1;
  }
  PASS_GROW(law->temperature, law->n_set, r->set_capacity);
  law->temperature[law->n_set++] = T;
  r->in_set = 0;
  return OK;
}

/* The lines of the set that just ended are as many as those of the first. */
static void close_set(lines *r, const place *at) {
  const int n_line = r->in_set;
  if (r->wrong) return;
  if (r->law->n_set == 1) r->n_line = n_line;
  if (n_line == r->n_line) return;
  message_add(r->log, P2009, at,
              "*%s: %d line%s for this temperature, %d for the first",
              r->c->name, n_line, n_line == 1 ? "" : "s", r->n_line);
  r->wrong = 1;
}

/* The table that line number i of a set is read by; NULL: one too many. */
static const option *table_of(const law_ops *ops, int i) {
  return i == 0 && ops->fields != NULL ? ops->fields : ops->terms;
}

/* What a line is read by, its temperature T, and whether it opens a set; NULL
 * after an error. */
static const option *place_line(lines *r, const record *line, double *T,
                                int *opens) {
  const law_card *law = r->law;
  const int first = law->n_set == 0;
  const option *table = table_of(law->ops, r->in_set);
  int has = table != NULL && line_temperature(r, line, table, T);
  *opens = first || !has || *T != law->temperature[law->n_set - 1];
  if (first) r->has_temperature = has;
  if (!r->has_temperature) *opens = first;
  if (!first && *opens) { /* the next temperature begins */
    table = table_of(law->ops, 0);
    has = line_temperature(r, line, table, T);
  }
  if (table == NULL)
    message_add(r->log, P2008, &line->at,
                "*%s, LAW=%s has one line, more only with temperatures",
                r->c->name, law->ops->name);
  /* Too few or too many: read_line reports it. */
  if (table == NULL || has == r->has_temperature ||
      line->n_field < needed(table) || line->n_field > law_n_field(table) + 1)
    return table;
  message_add(r->log, P2009, &line->at,
              "*%s: a temperature ends every line or none", r->c->name);
  return NULL;
}

/* A line goes on with the current set, or opens the next. */
static status add_line(lines *r, const record *line) {
  double T = 0;
  int opens;
  const option *table = place_line(r, line, &T, &opens);
  r->wrong |= table == NULL;
  if (r->wrong) return OK;
  PASS(read_line(r, line, table));
  if (opens) {
    if (r->law->n_set > 0) close_set(r, &line[-1].at);
    PASS(open_set(r, line, T));
  }
  ++r->in_set;
  return OK;
}

/* The one line of a law that is a formula. */
static void read_formula(const lines *r) {
  const card *c = r->c;
  const record *line = &c->records[0];
  if (c->n_record > 1)
    message_add(r->log, P2008, &c->records[1].at,
                "*%s, LAW=%s has one line: a formula", c->name,
                r->law->ops->name);
  if (line->n_field != 1) {
    message_add(r->log, P2009, &line->at,
                "%d fields on this line of *%s; expected: one formula of q, p, "
                "temp and t in quotes",
                line->n_field, c->name);
    return;
  }
  if (deck_formula(r->d, &line->fields[0], law_formula_names, r->log,
                   &r->law->formula) != 0)
    return;
  if ((expression_variables(r->law->formula) & 1u) == 0)
    message_add(r->log, P2033, &line->at,
                "*%s: the rate of creep does not depend on q (a *PARAMETER "
                "named q, p or temp hides the variable)",
                c->name);
}

status law_card_read(deck *d, const card *c, message_log *log, law_card *law) {
  lines r = {.d = d, .c = c, .log = log, .law = law};
  if (law->ops->needs_formula) {
    PASS_NEW(law->temperature, 1);
    law->n_set = 1;
    read_formula(&r);
    return OK;
  }
  for (int i = 0; i < c->n_record && !r.wrong; ++i)
    PASS(add_line(&r, &c->records[i]));
  if (c->n_record > 0) close_set(&r, &c->records[c->n_record - 1].at);
  law->n_term = r.wrong ? 0 : r.n_line - (law->ops->fields != NULL);
  if (r.wrong) law->n_set = 0;
  return OK;
}

/* Row of value number i, and the term it belongs to (from 1; 0: none). */
static const option *row_of(const law_card *law, int i, int *term) {
  const int n_field = law_n_field(law->ops->fields);
  const int n_term = law_n_field(law->ops->terms);
  *term = i < n_field ? 0 : 1 + (i - n_field) / n_term;
  return i < n_field ? &law->ops->fields[i]
                     : &law->ops->terms[(i - n_field) % n_term];
}

/* Set below the temperature and weight of the one above. */
static int find_set(const law_card *law, double temperature, double *weight) {
  const double *T = law->temperature;
  const int last = law->n_set - 1;
  int k = 0;
  *weight = 0;
  if (last == 0 || temperature <= T[0]) return 0;
  if (temperature >= T[last]) return last;
  while (temperature >= T[k + 1]) ++k;
  *weight = (temperature - T[k]) / (T[k + 1] - T[k]);
  return k;
}

/* The values; what is wrong with one, or NULL. */
static const char *find_values(const law_card *law, double t,
                               double temperature, double *value) {
  static const double origin[3] = {0, 0, 0};
  const int n = law_n_value(law);
  double weight;
  const quantity *low =
      law->value + (size_t)n * find_set(law, temperature, &weight);
  for (int i = 0; i < n; ++i) {
    int term;
    const option *row = row_of(law, i, &term);
    value[i] = quantity_value(&low[i], origin, t);
    if (weight > 0)
      value[i] += weight * (quantity_value(&low[n + i], origin, t) - value[i]);
    if (value[i] >= row->min && value[i] <= row->max) continue;
    char why[128];
    range_text(value[i], row->min, row->max, why, sizeof why);
    return text_of("%s = %s at time %g (data line %d of the law)", row->name,
                   why, t, term + (law->ops->fields != NULL));
  }
  return NULL;
}

status law_card_check(const law_card *law, elastic_type type,
                      message_log *log) {
  char text[256];
  if (law->ops->check == NULL) return OK;
  OWNED_NEW(double, value, law_n_value(law));
  for (int i = 0; i < law->n_set; ++i) {
    const char *wrong = find_values(law, 0, law->temperature[i], value);
    if (wrong == NULL)
      wrong = law->ops->check(law, type, value, text, sizeof text);
    if (wrong == NULL) continue;
    message_add(log, P2046, &law->at, "law %s: %s", law->ops->name, wrong);
    break;
  }
  return OK;
}

status law_values(const law_card *law, double t, double temperature,
                  double *value) {
  const char *wrong = find_values(law, t, temperature, value);
  if (wrong != NULL) RAISE(ERR_DECK, LAW_FORM "%s", LAW_ARGS(law), wrong);
  return OK;
}

double law_speed(const law_card *law, double temperature) {
  const law_shift *s = &law->shift;
  const double over = temperature - s->reference;
  if (s->kind == SHIFT_WLF) {
    if (!(s->c2 + over > 0)) return 0; /* below the glass: no flow */
    return pow(10, s->c1 * over / (s->c2 + over));
  }
  if (s->kind == SHIFT_ARRHENIUS)
    return exp(s->activation * over /
               ((temperature - s->zero) * (s->reference - s->zero)));
  return 1;
}

const char *law_too_cold(const law_card *law, double temperature) {
  const law_shift *s = &law->shift;
  const int absolute = (s->kind == SHIFT_ARRHENIUS && s->activation > 0) ||
                       (law->ops->is_warm != NULL && law->ops->is_warm(law));
  if (!absolute || temperature > s->zero) return NULL;
  return text_of(
      "the temperature %.9g is not above absolute zero, T_ZERO = "
      "%.9g",
      temperature, s->zero);
}

unsigned law_varies(const law_card *law) {
  unsigned bits = 0;
  const int n = law->n_set * law_n_value(law);
  for (int i = 0; i < n; ++i)
    if (quantity_variables(&law->value[i]) != 0) bits |= LAW_VARIES_TIME;
  if (law->formula != NULL && expression_variables(law->formula) & 8u)
    bits |= LAW_VARIES_TIME;
  if (law->n_set > 1 || law->shift.kind != SHIFT_NONE ||
      (law->ops->is_warm != NULL && law->ops->is_warm(law)) ||
      (law->formula != NULL && expression_variables(law->formula) & 4u))
    bits |= LAW_VARIES_TEMPERATURE;
  return bits;
}
