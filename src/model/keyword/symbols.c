/*
 * Names of *PARAMETER and -D that nothing uses: misspelt ones, which leave the
 * value they were to change as it was. Those of an included file may serve
 * other decks.
 */
#include "model/keyword/parts.h"

#include "mesh/msh/geo.h"

/* The names of a deck but for one. */
typedef struct others {
  const deck *d;
  const symbol *but;
} others;

static const char *other_at(const void *ctx, int i) {
  const others *o = ctx;
  i += i >= o->but - o->d->symbols;
  return i < o->d->n_symbol ? o->d->symbols[i].name : NULL;
}

/* What may be meant: a name of the .geo but for upper and lower case, one of
 * the deck, one of the .geo. */
static const char *nearest_use(const model *m, const geo_text *g,
                               const symbol *s) {
  const char *word;
  for (int i = 0; (word = geo_name(g, i)) != NULL; ++i)
    if (same_word(s->name, word)) return word;
  const others o = {.d = m->deck, .but = s};
  word = nearest_word(s->name, other_at, &o);
  return word != NULL ? word : nearest_word(s->typed, geo_name, g);
}

static void tell_unused(const model *m, const geo_text *g, const symbol *s) {
  const place line = {.file = "command line"};
  const char *near = nearest_use(m, g, s);
  message_add(m->log, P2042, s->at.file != NULL ? &s->at : &line,
              "%s%s is used neither in the deck nor in a .geo%s%s%s",
              s->at.file != NULL ? "*PARAMETER " : "-D ", s->typed,
              near != NULL ? "; did you mean " : "", near != NULL ? near : "",
              near != NULL ? "?" : "");
}

status check_symbols(const model *m) {
  status st = OK;
  geo_text g = {0};
  if (m->mesh_file != NULL && mesh_is_program(m->mesh_file))
    TRY(geo_read(m->mesh_file, &g));
  for (int i = 1; i < g.n_file; ++i) TRY(deck_input_copy(m->deck, g.file[i]));
  for (int i = 0; i < m->deck->n_symbol; ++i) {
    symbol *s = &m->deck->symbols[i];
    s->in_geometry = geo_has(&g, s->typed);
    if (!s->used && !s->in_geometry && s->at.from == NULL)
      tell_unused(m, &g, s);
  }
done:
  geo_free(&g);
  return st;
}
