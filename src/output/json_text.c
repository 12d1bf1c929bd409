/*
 * JSON as text: RFC 8259, UTF-8; numbers that are not finite are null.
 */
#include "output/json_text.h"

#include "base/text.h"

#include <math.h>
#include <string.h>

static void json_text(FILE *f, const char *text) {
  char piece[PIECE_SIZE];
  fputc('"', f);
  for (;;) {
    for (; *text == '\n'; ++text) fputs("\\n", f);
    if (text_piece(&text, piece) == 0) break;
    for (const char *p = piece; *p != '\0'; ++p) {
      if (strchr("\t\"\\", *p) != NULL) fputc('\\', f);
      fputc(*p == '\t' ? 't' : *p, f);
    }
  }
  fputc('"', f);
}

static void json_line(const json *w) {
  fputc('\n', w->f);
  for (int k = 0; k < w->depth; ++k) fputs("  ", w->f);
}

static void json_next(json *w, const char *name) {
  if (w->filled[w->depth]++ > 0) fputc(',', w->f);
  json_line(w);
  if (name == NULL) return;
  fputc('"', w->f);
  fputs(name, w->f);
  fputs("\": ", w->f);
}

void json_open(json *w, const char *name, char bracket) {
  if (w->depth > 0) json_next(w, name);
  fputc(bracket, w->f);
  w->filled[++w->depth] = 0;
}

void json_close(json *w, char bracket) {
  --w->depth;
  json_line(w);
  fputc(bracket, w->f);
}

void json_string(json *w, const char *name, const char *text) {
  json_next(w, name);
  json_text(w->f, text != NULL ? text : "");
}

void json_real(json *w, const char *name, double value) {
  json_next(w, name);
  if (isfinite(value))
    fprintf(w->f, "%.17g", value == 0 ? 0.0 : value);
  else
    fputs("null", w->f);
}

void json_count(json *w, const char *name, double value) {
  json_next(w, name);
  fprintf(w->f, "%.0f", value);
}

void json_flag(json *w, const char *name, int value) {
  json_next(w, name);
  fputs(value ? "true" : "false", w->f);
}

void json_named_count(json *w, const char *name, double value) {
  char word[80];
  text_word(word, sizeof word, name);
  json_count(w, word, value);
}
