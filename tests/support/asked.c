/*
 * Decks that ask for other tables, fields and estimates.
 */
#include "support/asked.h"

#include "base/base.h"

#include <check.h>

static const char *const prints[] = {NULL,       "",          "CONTACT, TOTALS",
                                     "ELEMENTS", "REACTIONS", "ZONES, LOOP",
                                     "ENERGY"};
static const char *const outputs[] = {NULL, "HDF5=NO"};
static const char *const accuracies[] = {NULL, "", "SOLVER=NO",
                                         "MESH=YES, TIME=YES"};
enum { PRINTS = 7, OUTPUTS = 2, ACCURACIES = 4 };

int asked_count(void) { return PRINTS * OUTPUTS * ACCURACIES; }

asked asked_number(int k) {
  return (asked){prints[k % PRINTS], outputs[k / PRINTS % OUTPUTS],
                 accuracies[k / PRINTS / OUTPUTS % ACCURACIES]};
}

void asked_text(const asked *a, char text[200]) {
  snprintf(text, 200, "*PRINT %s; *OUTPUT %s; *ACCURACY %s",
           a->print == NULL ? "of the deck" : a->print,
           a->output == NULL ? "of the deck" : a->output,
           a->accuracy == NULL ? "of the deck" : a->accuracy);
}

static int is_card(const char *line, const char *name) {
  const size_t n = strlen(name);
  return strncmp(line, name, n) == 0 && strchr(" ,\r\n", line[n]) != NULL;
}

/* The line after this one and those that it goes on with. */
static const char *next_card(const char *line) {
  const char *end = line;
  do {
    end = strchr(end, '\n');
    if (end == NULL) return line + strlen(line);
    ++end;
  } while (end - line > 1 && end[-2] == ',');
  return end;
}

static void put_card(FILE *f, const char *name, const char *words) {
  if (words != NULL && words[0] != '\0') fprintf(f, "%s, %s\n", name, words);
}

char *asked_deck(const char *deck, const asked *a) {
  char *text = NULL;
  size_t size = 0;
  FILE *f = open_memstream(&text, &size);
  ck_assert_ptr_nonnull(f);
  for (const char *line = deck, *next; *line != '\0'; line = next) {
    next = next_card(line);
    if ((a->print != NULL && is_card(line, "*PRINT")) ||
        (a->output != NULL && is_card(line, "*OUTPUT")) ||
        (a->accuracy != NULL && is_card(line, "*ACCURACY")))
      continue;
    if (is_card(line, "*END STEP")) {
      put_card(f, "*PRINT", a->print);
      put_card(f, "*OUTPUT", a->output);
      put_card(f, "*ACCURACY", a->accuracy);
    }
    fprintf(f, "%.*s", (int)(next - line), line);
  }
  ck_assert_int_eq(fclose(f), 0);
  return text;
}

/* 1: a line of JOB.json that does not depend on what is asked for. */
static int is_answer(const char *line) {
  static const char *const names[] = {
      "time",       "dt",       "open",          "slip",   "stick",
      "iterations", "residual", "energy_defect", "outcome"};
  for (size_t i = 0; i < sizeof names / sizeof *names; ++i) {
    const size_t n = strlen(names[i]);
    if (strncmp(line, names[i], n) == 0 && line[n] == '"') return 1;
  }
  return 0;
}

char *asked_answer(const job *j) {
  char *json = job_file(j, "json"), *text = NULL;
  size_t size = 0;
  if (json == NULL) return NULL;
  FILE *f = open_memstream(&text, &size);
  ck_assert_ptr_nonnull(f);
  const char *at = strstr(json, "\"increments\": [");
  for (; at != NULL; at = strchr(at, '\n')) {
    while (*at == '\n' || *at == ' ') ++at;
    if (*at == '"' && is_answer(at + 1))
      fprintf(f, "%.*s\n", (int)strcspn(at, ",\n"), at);
  }
  ck_assert_int_eq(fclose(f), 0);
  free(json);
  return text;
}

int asked_keeps(const char *deck, const asked *a) {
  if (a->accuracy == NULL) return 1;
  return strstr(a->accuracy, "TIME") == NULL &&
         strstr(deck, "BALANCED") == NULL && strstr(deck, "TARGET") == NULL &&
         strstr(deck, "TIME=YES") == NULL;
}
