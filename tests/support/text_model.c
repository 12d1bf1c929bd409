/*
 * A model from the text of a deck, checked against a mesh made in memory.
 */
#include "base/base.h"
#include "effects/rows.h"
#include "support/text_model.h"

#include <check.h>
#include <unistd.h>

text_model text_model_read(const char *text, mesh *msh) {
  char name[] = "/tmp/protis-model-XXXXXX";
  text_model s = {.msh = msh};
  int fd = mkstemp(name);
  ck_assert_int_ge(fd, 0);
  ck_assert_int_eq(write(fd, text, strlen(text)), (ssize_t)strlen(text));
  close(fd);
  ck_assert_int_eq(message_log_new(&s.log), OK);
  ck_assert_int_eq(deck_read(name, 0, NULL, s.log, &s.d), OK);
  s.st = model_from_deck(s.d, s.log, &s.m);
  if (s.st == OK && msh != NULL) s.st = model_check(s.m, msh, effects_required);
  if (s.st != OK) message_print(s.log, stdout);
  unlink(name);
  return s;
}

void text_model_close(text_model *s) {
  memory_free(s->m);
  memory_free(s->d);
  memory_free(s->log);
  memory_free(s->msh);
}
