/*
 * Helpers for the data lines of cards: number of fields, values in range,
 * pairs.
 */
#include "model/keyword.h"

#include "base/memory.h"

#include <math.h>

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
  message_add(r->m->log, P2010, &f->at, "*%s: %s = %s outside [%g, %g]",
              r->card->name, what, f->text, min, max);
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

int field_quantity(const reading *r, const field *f, quantity *out) {
  return deck_quantity(r->m->deck, f, r->m->log, out);
}

/* 0 if the pairs ascend; else the log has it. */
static int pairs_ascend(const reading *r, int first_line,
                        const value_table *t) {
  for (int i = 1; i < t->n; ++i)
    if (!(t->at[i] > t->at[i - 1])) {
      message_add(r->m->log, P2029, &r->card->records[first_line].at,
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
