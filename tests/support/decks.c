/*
 * Decks in a folder of their own, and the cards read as one line of text.
 */
#include "support/decks.h"

#include "support/folder.h"
#include "support/unit.h"

#include <unistd.h>

static char text[60000]; /* messages of the last deck */

void decks_write_bytes(const char *name, const void *bytes, size_t n) {
  FILE *f = fopen(name, "wb");
  ck_assert_ptr_nonnull(f);
  ck_assert_uint_eq(fwrite(bytes, 1, n, f), n);
  fclose(f);
}

void decks_write(const char *name, const char *content) {
  decks_write_bytes(name, content, strlen(content));
}

/* The tests run in a folder of their own. */
void decks_enter(void) {
  char folder[64];
  folder_new(folder);
  ck_assert_int_eq(chdir(folder), 0);
}

void decks_leave(void) {
  char folder[200];
  ck_assert_ptr_nonnull(getcwd(folder, sizeof folder));
  ck_assert_int_eq(chdir("/"), 0);
  folder_remove(folder);
}

char *decks_messages(void) { return text; }

void decks_print(const message_log *log) {
  memset(text, 0, sizeof text);
  FILE *f = fmemopen(text, sizeof text - 1, "w");
  message_print(log, f);
  fclose(f);
}

read_deck decks_read(const char *file, int n, const char *const *define) {
  read_deck r = {NULL, NULL, OK};
  ck_assert_int_eq(message_log_new(&r.log), OK);
  r.st = deck_read(file, n, define, r.log, &r.d);
  decks_print(r.log);
  return r;
}

void decks_done(read_deck *r) {
  memory_free(r->d);
  memory_free(r->log);
}

read_deck decks_read_text(const char *content) {
  decks_write("a.inp", content);
  return decks_read("a.inp", 0, NULL);
}

/* A deck that must be read without a message. */
read_deck decks_read_good(const char *content) {
  read_deck r = decks_read_text(content);
  ck_assert_msg(r.st == OK && text[0] == '\0', "%s", text);
  return r;
}

static void add(char *out, const char *before, const char *what,
                const char *after) {
  size_t used = strlen(out);
  snprintf(out + used, 4096 - used, "%s%s%s", before, what, after);
}

static void add_record(char *out, const record *r) {
  add(out, "[", "", "");
  for (int k = 0; k < r->n_field; ++k) {
    const char *mark = r->fields[k].quoted ? "\"" : "";
    add(out, k > 0 ? "|" : "", mark, r->fields[k].text);
    add(out, mark, "", "");
  }
  add(out, "]", "", "");
}

const char *decks_shape(const deck *d) {
  static char out[4096];
  out[0] = '\0';
  for (int i = 0; i < d->n_card; ++i) {
    const card *c = &d->cards[i];
    add(out, "*", c->name, "");
    for (int k = 0; k < c->n_parameter; ++k) {
      const parameter *p = &c->parameters[k];
      add(out, "{", p->name, p->has_value ? "=" : "}");
      if (p->has_value) add(out, "", p->value.text, "}");
    }
    for (int k = 0; k < c->n_record; ++k) add_record(out, &c->records[k]);
  }
  return out;
}
