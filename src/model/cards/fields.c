/*
 * Helpers for the data lines: number of fields, values in range, pairs, names.
 */
#include "model/cards/cards.h"

#include "base/base.h"

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

int field_real(const reading *r, const field *f, double min, const char *what,
               double *out) {
  if (deck_real(f, r->m->log, out) != 0) return -1;
  if (*out >= min && *out <= DBL_MAX) return 0;
  char why[128];
  range_text(*out, min, DBL_MAX, why, sizeof why);
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

void report_idle(const reading *r, const char *name, const char *with) {
  message_add(r->m->log, P2037, value_place(r, name),
              "*%s: %s= counts with %s only", r->card->name, name, with);
}

int name_taken(const reading *r, const char *name, const char *old) {
  if (name == NULL || old == NULL || !same_word(name, old)) return 0;
  message_add(r->m->log, P2011, value_place(r, "NAME"),
              "*%s, NAME=%s is defined twice", r->card->name, name);
  return 1;
}

/* 1: the tables, where a blank is "_", show both as one. */
static int same_shown(const char *a, const char *b) {
  char first[160], second[160];
  text_word(first, sizeof first, a);
  text_word(second, sizeof second, b);
  return same_word(first, second);
}

void shown_name_taken(const reading *r, const char *name, const char *old) {
  if (name_taken(r, name, old) || name == NULL || old == NULL) return;
  if (same_shown(name, old))
    message_add(r->m->log, P2011, value_place(r, "NAME"),
                "*%s, NAME=%s: the tables show it and %s as one name",
                r->card->name, name, old);
}

void unknown_word(message_log *log, message_id id, const place *at,
                  const char *text, const char *word,
                  const char *(*next)(const void *ctx, int i),
                  const void *ctx) {
  char all[400] = "";
  const int wanted = message_wanted(log);
  const char *near = wanted ? nearest_word(word, next, ctx) : NULL, *one;
  size_t used = 0;
  for (int i = 0; wanted && near == NULL && (one = next(ctx, i)) != NULL; ++i)
    if (used < sizeof all - 70)
      used += (size_t)snprintf(all + used, sizeof all - used, "%s%.60s",
                               i == 0 ? "; the names are " : ", ", one);
  if (near != NULL) snprintf(all, sizeof all, "; did you mean %.300s?", near);
  message_add(log, id, at, "%s%s%s", text, word, all);
}

const char *const *axisymmetric_names(const deck *d) {
  static const char *const names[] = {"X|R", "Y|Z", "", "T"};
  static const char *const r_taken[] = {"X", "Y|Z", "", "T"};
  int found = 0;
  for (int i = 0; i < d->n_card && !found; ++i) {
    const parameter *type = card_parameter(&d->cards[i], "TYPE");
    if (type == NULL || !type->has_value) continue;
    if (strcmp(d->cards[i].name, "SOLID SECTION") != 0) continue;
    found = choice_rank(KINEMATICS_WORDS, type->value.text) % 4 == AXISYMMETRIC;
  }
  if (!found) return NULL;
  for (int i = 0; i < d->n_symbol; ++i)
    if (strcmp(d->symbols[i].name, "R") == 0) return r_taken;
  return names;
}

int field_quantity(const reading *r, const field *f, quantity *out) {
  return deck_quantity(r->m->deck, f, r->axisymmetric, r->m->log, out);
}

const field *pair_field(const card *c, int i, int second) {
  const record *line = c->records;
  for (; i >= line->n_field / 2; ++line) i -= line->n_field / 2;
  return &line->fields[2 * i + second];
}

/* 0 if the pairs ascend; else the log has it. */
static int pairs_ascend(const reading *r, const value_table *t) {
  for (int i = 1; i < t->n; ++i)
    if (!(t->at[i] > t->at[i - 1])) {
      message_add(r->m->log, P2029, &pair_field(r->card, i, 0)->at,
                  "*%s: the table must ascend, but %.15g follows %.15g",
                  r->card->name, t->at[i], t->at[i - 1]);
      return -1;
    }
  return 0;
}

status field_file(const reading *r, const char **path) {
  const parameter *file = card_parameter(r->card, "FILE");
  *path = NULL;
  if (file == NULL || !file->has_value) return OK;
  *path = deck_path(r->m->deck, &file->value);
  if (*path == NULL)
    RAISE(ERR_MEMORY, "memory exhausted: file of *%s", r->card->name);
  return OK;
}

status read_pairs(reading *r, int variable, value_table *out) {
  const card *c = r->card;
  int total = 0;
  if (r->axisymmetric != NULL && variable == TABLE_Z) variable = TABLE_Y;
  for (int i = 0; i < c->n_record; ++i) {
    if (c->records[i].n_field % 2 != 0 || c->records[i].n_field == 0) {
      message_add(r->m->log, P2009, &c->records[i].at,
                  "%d field%s on this line of *%s; expected pairs",
                  c->records[i].n_field, c->records[i].n_field == 1 ? "" : "s",
                  c->name);
      return OK;
    }
    total += c->records[i].n_field / 2;
  }
  PASS_NEW_REALS(total, &out->at, &out->value);
  out->variable = variable;
  int n = 0;
  for (int i = 0; i < c->n_record; ++i)
    for (int k = 0; k + 1 < c->records[i].n_field; k += 2, ++n) {
      const field *f = &c->records[i].fields[k];
      if (deck_real(&f[0], r->m->log, &out->at[n]) != 0) return OK;
      if (deck_real(&f[1], r->m->log, &out->value[n]) != 0) return OK;
    }
  out->n = n;
  if (pairs_ascend(r, out) != 0) out->n = 0;
  return OK;
}

int rank_of_name(const name_list *names, const char *name) {
  const char *word;
  for (int i = 0; (word = candidate_name(names, i)) != NULL; ++i)
    if (same_word(word, name)) return i;
  return -1;
}

int find_name(const model *m, const char *name, const char *title,
              const name_list *names, const place *at) {
  const int i = rank_of_name(names, name);
  if (i >= 0) return i;
  unknown_word(m->log, P2012, at, text_of("there is no *%s, NAME=", title),
               name, candidate_name, names);
  return -1;
}

int find_amplitude(const model *m, const char *name, const place *at) {
  int i = find_name(m, name, "AMPLITUDE",
                    NAMES(m->time.amplitudes, m->n.amplitude), at);
  if (i >= 0) m->time.amplitudes[i].used = 1;
  return i;
}

step *open_step(const reading *r) { return &r->m->steps[r->m->n.step - 1]; }
