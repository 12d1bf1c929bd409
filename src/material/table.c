/*
 * Constants of *ELASTIC over the temperature: read from the data lines, linear
 * between two temperatures, constant outside.
 */
#include "material/table.h"

#include "base/memory.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Number of constants of each elastic_type. */
static const int constants_of[] = {2, 9, 21};

/* Reading the lines of a card. */
typedef struct lines {
  const card *c;
  message_log *log;
  elastic_table *table;
  double set[ELASTIC_MAX + 1]; /* of the current set */
  int n;                       /* in it */
  int has_temperature;         /* the first set ends with one; all do, then */
  int capacity;                /* of the table */
  int wrong;                   /* an error is in the log */
} lines;

static void count_error(lines *r, const place *at, const char *found) {
  message_add(r->log, P2009, at, "*ELASTIC: %d constants expected%s, %s",
              r->table->n_constant,
              r->has_temperature ? " and a temperature" : "", found);
  r->wrong = 1;
}

/* One set is whole: its constants and temperature into the table. */
static status close_set(lines *r, const place *at) {
  elastic_table *t = r->table;
  const int n = t->n_constant, has = r->n == n + 1;
  const double T = has ? r->set[n] : 0.0;
  if (t->n == 0) r->has_temperature = has;
  if (has != r->has_temperature || (t->n > 0 && !has)) {
    count_error(r, at,
                "more found: several sets each end with their temperature");
    return OK;
  }
  if (t->n > 0 && !(T > t->set[t->n - 1].temperature)) {
    message_add(r->log, P2029, at,
                "*ELASTIC: the temperatures must ascend, but %.15g follows "
                "%.15g",
                T, t->set[t->n - 1].temperature);
    r->wrong = 1;
    return OK;
  }
  PASS_GROW(t->set, t->n, r->capacity);
  memcpy(t->set[t->n].constant, r->set, (size_t)n * sizeof *r->set);
  t->set[t->n++].temperature = T;
  r->n = 0;
  return OK;
}

/* A line goes on with the current set; one that fills it ends it. */
static status add_line(lines *r, const record *line) {
  const int n = r->table->n_constant;
  for (int k = 0; k < line->n_field && !r->wrong; ++k) {
    const field *f = &line->fields[k];
    if (r->n == n + 1)
      count_error(r, &f->at, "more found: a set begins on a line of its own");
    else
      r->wrong |= deck_real(f, r->log, &r->set[r->n++]) != 0;
  }
  if (!r->wrong && r->n >= n) PASS(close_set(r, &line->at));
  return OK;
}

/* Every set alone is an elasticity. */
static void check_sets(lines *r, const char *material_name) {
  double C[36];
  char text[256];
  const elastic_table *t = r->table;
  for (int i = 0; i < t->n; ++i) {
    const char *wrong = elastic_matrix(
        t->type, t->n_constant, t->set[i].constant, C, text, (int)sizeof text);
    if (wrong == NULL) continue;
    message_add(r->log, P2013, &r->c->records[0].at, "material %s: %s",
                material_name, wrong);
    return;
  }
}

status elastic_table_read(const card *c, elastic_type type,
                          const char *material_name, message_log *log,
                          elastic_table *table) {
  status st = OK;
  lines r = {.c = c, .log = log, .table = table};
  table->type = type;
  table->n_constant = constants_of[type];
  for (int i = 0; i < c->n_record && !r.wrong; ++i)
    TRY(add_line(&r, &c->records[i]));
  if (!r.wrong && r.n > 0) {
    char found[32];
    snprintf(found, sizeof found, "%d found", r.n);
    count_error(&r, table->n == 0 ? &c->at : &c->records[c->n_record - 1].at,
                found);
  }
  if (r.wrong)
    elastic_table_free(table);
  else
    check_sets(&r, material_name);
done:
  return st;
}

/* E, nu of G/(1 - relaxed[0]), K/(1 - relaxed[1]). */
static void make_whole(const double relaxed[2], double *constant) {
  const double E = constant[0], nu = constant[1];
  const double G = E / (2 * (1 + nu)) / (1 - relaxed[0]);
  const double K = E / (3 * (1 - 2 * nu)) / (1 - relaxed[1]);
  constant[0] = 9 * K * G / (3 * K + G);
  constant[1] = (3 * K - 2 * G) / (2 * (3 * K + G));
}

/* What is given is linear between the sets, so that they stay as they are. */
void elastic_table_relaxed(elastic_table *t, const double relaxed[2]) {
  if (t->n == 1)
    make_whole(relaxed, t->set[0].constant);
  else
    memcpy(t->relaxed, relaxed, sizeof t->relaxed);
}

const char *elastic_at(const elastic_table *t, double T, double C[36],
                       char *text, int text_size) {
  double constant[ELASTIC_MAX];
  int k = 0;
  while (k + 1 < t->n && T >= t->set[k + 1].temperature) ++k;
  const elastic_constants *low = &t->set[k];
  memcpy(constant, low->constant, sizeof constant);
  if (k + 1 < t->n && T > low->temperature) {
    const elastic_constants *high = &t->set[k + 1];
    const double part =
        (T - low->temperature) / (high->temperature - low->temperature);
    for (int i = 0; i < t->n_constant; ++i)
      constant[i] += part * (high->constant[i] - low->constant[i]);
  }
  if (t->relaxed[0] > 0 || t->relaxed[1] > 0) make_whole(t->relaxed, constant);
  return elastic_matrix(t->type, t->n_constant, constant, C, text, text_size);
}

double elastic_table_most(const elastic_table *t, int i) {
  double most = -HUGE_VAL;
  for (int k = 0; k < t->n; ++k) {
    double constant[ELASTIC_MAX];
    memcpy(constant, t->set[k].constant, sizeof constant);
    if (t->relaxed[0] > 0 || t->relaxed[1] > 0)
      make_whole(t->relaxed, constant);
    most = fmax(most, constant[i]);
  }
  return most;
}

void elastic_table_free(elastic_table *t) {
  memory_free(t->set);
  *t = (elastic_table){0};
}
