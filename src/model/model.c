/*
 * From cards to the model: the driver over the keyword table, and the helpers
 * for data lines (number of fields, values in range, pairs).
 */
#include "model/keyword.h"

#include "base/memory.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

int same_word(const char *a, const char *b) { return strcasecmp(a, b) == 0; }

int record_fields(const reading *r, const record *line, int min, int max,
                  const char *expected) {
  if (line->n_field >= min && line->n_field <= max) return 0;
  message_add(r->m->log, P2009, &line->at,
              "%d field%s on this line of *%s; expected: %s", line->n_field,
              line->n_field == 1 ? "" : "s", r->card->name, expected);
  return -1;
}

int field_real(const reading *r, const field *f, double min, double max,
               const char *what, double *out) {
  if (deck_real(f, r->m->log, out) != 0) return -1;
  if (*out >= min && *out <= max) return 0;
  char why[128];
  range_text(*out, min, max, why, sizeof why);
  message_add(r->m->log, P2010, &f->at, "*%s: %s = %s", r->card->name, what,
              why);
  return -1;
}

int field_int(const reading *r, const field *f, int min, int max,
              const char *what, int *out) {
  if (deck_int(f, r->m->log, out) != 0) return -1;
  if (*out >= min && *out <= max) return 0;
  message_add(r->m->log, P2010, &f->at, "*%s: %s = %s outside [%d, %d]",
              r->card->name, what, f->text, min, max);
  return -1;
}

const place *value_place(const reading *r, const char *name) {
  const parameter *p = card_parameter(r->card, name);
  return p == NULL ? &r->card->at : &p->value.at;
}

int name_taken(const reading *r, const char *name, const char *old) {
  if (name == NULL || old == NULL || !same_word(name, old)) return 0;
  message_add(r->m->log, P2011, value_place(r, "NAME"),
              "*%s, NAME=%s is defined twice", r->card->name, name);
  return 1;
}

void unknown_word(message_log *log, message_id id, const place *at,
                  const char *text, const char *word,
                  const char *(*next)(const void *ctx, int i),
                  const void *ctx) {
  const char *near =
      message_wanted(log, ERROR) ? nearest_word(word, next, ctx) : NULL;
  message_add(log, id, at, "%s%s%s%s%s", text, word,
              near == NULL ? "" : "; did you mean ", near == NULL ? "" : near,
              near == NULL ? "" : "?");
}

int field_quantity(const reading *r, const field *f, quantity *out) {
  return deck_quantity(r->m->deck, f, r->m->log, out);
}

/* Field of pair number i of the lines of a card, from first_line on. */
const field *pair_field(const card *c, int first_line, int i, int second) {
  const record *line = &c->records[first_line];
  for (; i >= line->n_field / 2; ++line) i -= line->n_field / 2;
  return &line->fields[2 * i + second];
}

/* 0 if the pairs ascend; else the log has it. */
static int pairs_ascend(const reading *r, int first_line,
                        const value_table *t) {
  for (int i = 1; i < t->n; ++i)
    if (!(t->at[i] > t->at[i - 1])) {
      message_add(r->m->log, P2029, &pair_field(r->card, first_line, i, 0)->at,
                  "*%s: the table must ascend, but %.15g follows %.15g",
                  r->card->name, t->at[i], t->at[i - 1]);
      return -1;
    }
  return 0;
}

status read_pairs(reading *r, int first_line, int variable, value_table *out) {
  status st = OK;
  const card *c = r->card;
  int total = 0;
  for (int i = first_line; i < c->n_record; ++i) {
    if (c->records[i].n_field % 2 != 0 || c->records[i].n_field == 0) {
      message_add(r->m->log, P2009, &c->records[i].at,
                  "%d field%s on this line of *%s; expected pairs",
                  c->records[i].n_field, c->records[i].n_field == 1 ? "" : "s",
                  c->name);
      goto done;
    }
    total += c->records[i].n_field / 2;
  }
  NEW(out->at, total);
  NEW(out->value, total);
  out->variable = variable;
  int n = 0;
  for (int i = first_line; i < c->n_record; ++i)
    for (int k = 0; k + 1 < c->records[i].n_field; k += 2, ++n) {
      const field *f = &c->records[i].fields[k];
      if (deck_real(&f[0], r->m->log, &out->at[n]) != 0) goto done;
      if (deck_real(&f[1], r->m->log, &out->value[n]) != 0) goto done;
    }
  out->n = n;
  if (pairs_ascend(r, first_line, out) != 0) out->n = 0;
done:
  return st;
}

static const char *keyword_name(const void *ctx, int i) {
  (void)ctx;
  return keyword_table[i].name;
}

static const char *option_name(const void *ctx, int i) {
  return ((const option *)ctx)[i].name;
}

/* Name of row i of two tables one after the other. */
typedef struct two_tables {
  const option *first, *second;
} two_tables;

static const char *either_name(const void *ctx, int i) {
  const two_tables *t = ctx;
  for (const option *o = t->first; o != NULL && o->name != NULL; ++o)
    if (i-- == 0) return o->name;
  return t->second == NULL ? NULL : option_name(t->second, i);
}

/* Read one parameter into the struct its row belongs to. */
static void read_parameter(reading *r, const option *row, const parameter *p,
                           void *into) {
  char why[256];
  if (option_read(row, p->has_value ? p->value.text : NULL, into, why,
                  sizeof why) == 0)
    return;
  r->misread = 1;
  message_add(r->m->log, P2004, p->has_value ? &p->value.at : &p->at,
              "*%s, %s: %s", r->card->name, p->name, why);
}

/* A name that no row has: not reported after a law or method that is not
 * known, whose option it may be. */
static void unknown_parameter(reading *r, const parameter *p,
                              const two_tables *all, const plugin *named) {
  char text[256], of[128] = "";
  r->misread = 1;
  if (named->parameter != NULL && named->name == NULL) return;
  if (named->parameter != NULL)
    snprintf(of, sizeof of, ", %s=%.80s", named->parameter, named->name);
  snprintf(text, sizeof text, "*%.80s%s has no parameter ", r->card->name, of);
  unknown_word(r->m->log, P2003, &p->at, text, p->name, either_name, all);
}

/* Nothing is missing where something was not understood: it may be that. */
static void report_missing(const reading *r, const option *table) {
  if (r->misread) return;
  for (const option *o = table; o != NULL && o->name != NULL; ++o)
    if (o->initial == NULL && card_parameter(r->card, o->name) == NULL)
      message_add(r->m->log, P2005, &r->card->at,
                  "*%s needs the parameter %s= (%s)", r->card->name, o->name,
                  o->help);
}

void keyword_parameters(const keyword *row, reading *r, void *param,
                        void *plugin_param) {
  const card *c = r->card;
  memset(param, 0, PARAM_SIZE);
  memset(plugin_param, 0, PARAM_SIZE);
  r->param = param;
  r->plugin = NULL;
  if (row->options != NULL) option_defaults(row->options, param);
  r->misread = c->damaged;
  for (int i = 0; i < c->n_parameter; ++i) {
    const option *o = option_find(row->options, c->parameters[i].name);
    if (o != NULL) read_parameter(r, o, &c->parameters[i], param);
  }
  plugin named = {NULL, 0, NULL, NULL};
  if (row->names != NULL) {
    named = row->names(r);
    r->plugin_size = named.size;
    if (named.options != NULL) option_defaults(named.options, plugin_param);
    if (named.size > 0) r->plugin = plugin_param;
  }
  two_tables all = {row->options, named.options};
  for (int i = 0; i < c->n_parameter; ++i) {
    const parameter *p = &c->parameters[i];
    if (option_find(row->options, p->name) != NULL) continue;
    const option *o = option_find(named.options, p->name);
    if (o != NULL)
      read_parameter(r, o, p, plugin_param);
    else
      unknown_parameter(r, p, &all, &named);
  }
  report_missing(r, row->options);
  report_missing(r, named.options);
}

/* 1 if the card may stand here; opens and closes the blocks. */
static int right_place(reading *r, const keyword *row) {
  message_log *log = r->m->log;
  const card *c = r->card;
  if (r->in_step) {
    if (row->where & IN_STEP) return 1;
    message_add(log, P2006, &c->at,
                "*%s does not belong inside a step; end the step first with "
                "*END STEP",
                c->name);
    return 0;
  }
  if (row->where & IN_MATERIAL) {
    if (r->material_id >= 0) return 1;
    message_add(log, P2006, &c->at, "*%s must follow its *MATERIAL card",
                c->name);
    return 0;
  }
  r->material_id = -1;
  if (row->where & IN_MODEL) {
    if (r->m->n_step == 0 || strcmp(row->name, "STEP") == 0) return 1;
    message_add(log, P2006, &c->at, "*%s must stand before the first *STEP",
                c->name);
    return 0;
  }
  message_add(log, P2006, &c->at, "*%s belongs between *STEP and *END STEP",
              c->name);
  return 0;
}

static int right_lines(const reading *r, const keyword *row) {
  const card *c = r->card;
  if (c->n_record < row->min_line) {
    message_add(r->m->log, P2007, &c->at, "*%s needs %d data line%s: %s",
                c->name, row->min_line, row->min_line == 1 ? "" : "s",
                row->data);
    return 0;
  }
  if (row->max_line < 0 || c->n_record <= row->max_line) return 1;
  if (row->max_line == 0)
    message_add(r->m->log, P2008, &c->records[0].at, "*%s has no data lines",
                c->name);
  else
    message_add(r->m->log, P2008, &c->records[row->max_line].at,
                "*%s has at most %d data line%s: %s", c->name, row->max_line,
                row->max_line == 1 ? "" : "s", row->data);
  return 0;
}

static void unknown_card(const reading *r) {
  const card *c = r->card;
  const char *near = message_wanted(r->m->log, ERROR)
                         ? nearest_word(c->name, keyword_name, NULL)
                         : NULL;
  message_add(r->m->log, P1003, &c->at, "unknown card *%s%s%s%s", c->name,
              near == NULL ? "" : "; did you mean *", near == NULL ? "" : near,
              near == NULL ? "" : "?");
}

static status read_card(reading *r) {
  status st = OK;
  _Alignas(16) char param[PARAM_SIZE], plugin_param[PARAM_SIZE];
  const keyword *row = keyword_find(r->card->name);
  if (row == NULL) unknown_card(r);
  if (row != NULL && row->where & LANGUAGE) goto done;
  if (row == NULL || !right_place(r, row)) {
    r->lost = 1;
    goto done;
  }
  keyword_parameters(row, r, param, plugin_param);
  r->lost |= r->misread;
  /* A card that has no lines means the same with some. */
  if (right_lines(r, row) || row->max_line == 0)
    TRY(row->apply(r));
  else
    r->lost = 1;
done:
  return st;
}

/* Name of the job: the file without folder and .inp. */
static status name_job(model *m) {
  status st = OK;
  const char *slash = strrchr(m->deck->file, '/');
  const char *base = slash == NULL ? m->deck->file : slash + 1;
  m->job = memory_text(base);
  if (m->job == NULL) FAIL(ERR_MEMORY, "memory exhausted: name of the job");
  size_t length = strlen(m->job);
  if (length > 4 && same_word(m->job + length - 4, ".inp"))
    m->job[length - 4] = '\0';
done:
  return st;
}

/* What the deck lacks, at its end; not after a card was lost, which may be
 * the one. */
static void report_absent(const reading *r) {
  const model *m = r->m;
  place at = {.file = m->deck->file};
  if (r->lost) return;
  if (m->deck->n_card > 0) at = m->deck->cards[m->deck->n_card - 1].at;
  if (!m->has_mesh && !m->has_problem)
    message_add(m->log, P2015, &at, "the deck has no *MESH card");
  if (m->n_section == 0 && !m->has_problem)
    message_add(m->log, P2016, &at,
                "the deck has no *SOLID SECTION: nothing says what the "
                "elements are made of");
  if (m->n_step == 0 && !m->has_problem)
    message_add(m->log, P2017, &at, "the deck has no *STEP: nothing to solve");
  if (r->in_step)
    message_add(m->log, P2019, &m->steps[m->n_step - 1].at,
                "this *STEP is not closed by *END STEP");
}

/* A problem from a file needs no *STEP. */
static status default_step(model *m) {
  status st = OK;
  GROW(m->steps, m->n_step, m->cap_step);
  m->steps[m->n_step++] = (step){.name = "", .at = m->problem_at};
done:
  return st;
}

status model_from_deck(deck *d, message_log *log, model **out) {
  status st = OK;
  model *m = NULL;
  NEW(m, 1);
  *out = m;
  m->deck = d;
  m->log = log;
  m->title = "";
  TRY(name_job(m));
  reading r = {
      .m = m, .material_id = -1, .lost = message_count(log, ERROR) > 0};
  for (int i = 0; i < d->n_card; ++i) {
    r.card = &d->cards[i];
    TRY(read_card(&r));
  }
  report_absent(&r);
  if (m->has_problem && m->n_step == 0) TRY(default_step(m));
  TRY(model_resolve(m, r.lost));
  if (m->has_problem) TRY(model_finish_problem(&r));
  TRY(message_status(log, ERR_DECK));
done:
  return st;
}

/* Ends of increments are sums: equal to rounding. */
static int same_time(const step *s, double a, double b) {
  return fabs(a - b) <= 1e-12 * (fabs(s->start) + s->total);
}

double print_next(const print_request *p, const step *s, double after,
                  double before) {
  const time_points *q = p->points;
  for (int i = 0; q != NULL && i < q->n; ++i) {
    double t = q->total_time ? q->t[i] : s->start + q->t[i];
    if (t > after && t < before && !same_time(s, t, after) &&
        !same_time(s, t, before))
      return t;
  }
  return HUGE_VAL;
}

int print_shows(const print_request *p, const step *s, double t,
                int increment_no, int last) {
  const time_points *q = p->points;
  if (q == NULL)
    return last || (increment_no >= 0 && p->frequency > 0 &&
                    increment_no % p->frequency == 0);
  for (int i = 0; i < q->n; ++i)
    if (same_time(s, q->total_time ? q->t[i] : s->start + q->t[i], t)) return 1;
  return 0;
}

static void table_release(value_table *t) {
  memory_free(t->at);
  memory_free(t->value);
}

static void rule_release(friction_rule *rule) {
  table_release(&rule->position);
  memory_free((void *)rule->card.param);
}

void model_free(model *m) {
  if (m == NULL) return;
  table_release(&m->first_step);
  for (int i = 0; i < m->n_amplitude; ++i)
    table_release(&m->amplitudes[i].table);
  for (int i = 0; i < m->n_points; ++i) memory_free(m->points[i].t);
  for (int i = 0; i < m->n_contact; ++i) {
    rule_release(&m->contacts[i].friction);
    table_release(&m->contacts[i].force.position);
  }
  for (int i = 0; i < m->n_material; ++i)
    for (int k = 0; k < 3; ++k) table_release(&m->materials[i].expand.alpha[k]);
  for (int i = 0; i < m->n_step; ++i) {
    memory_free(m->steps[i].loads.item);
    memory_free(m->steps[i].prints);
    for (int k = 0; k < m->steps[i].n_change; ++k)
      rule_release(&m->steps[i].changes[k].rule);
    memory_free(m->steps[i].changes);
    memory_free(m->steps[i].solver_param);
  }
  memory_free(m->supports.item);
  memory_free(m->initials);
  for (int i = 0; i < m->n_field; ++i) memory_free(m->fields[i].value);
  memory_free(m->fields);
  for (int i = 0; i < m->n_material; ++i) {
    law_card_free(&m->materials[i].law);
    elastic_table_free(&m->materials[i].elastic);
  }
  memory_free(m->amplitudes);
  memory_free(m->points);
  memory_free(m->materials);
  memory_free(m->sections);
  memory_free(m->obstacles);
  memory_free(m->moves);
  memory_free(m->contacts);
  memory_free(m->steps);
  memory_free(m->still);
  memory_free(m->elem_section);
  memory_free(m->job);
  memory_free(m);
}
