/*
 * JSON as text: RFC 8259, UTF-8; what is no finite number is null.
 */
#include "output/json_text.h"

#include "base/text.h"

#include <math.h>

/* Well-formed UTF-8: first byte, and what the second may be (Unicode 3.9,
 * table 3-7); the bytes after those are 80..BF. */
static const struct {
  unsigned char first, last, low, high, length;
} utf8[] = {{0x00, 0x7F, 0x00, 0x00, 1}, {0xC2, 0xDF, 0x80, 0xBF, 2},
            {0xE0, 0xE0, 0xA0, 0xBF, 3}, {0xE1, 0xEC, 0x80, 0xBF, 3},
            {0xED, 0xED, 0x80, 0x9F, 3}, {0xEE, 0xEF, 0x80, 0xBF, 3},
            {0xF0, 0xF0, 0x90, 0xBF, 4}, {0xF1, 0xF3, 0x80, 0xBF, 4},
            {0xF4, 0xF4, 0x80, 0x8F, 4}};

/* Length of the sequence at s; 0: none there. */
static int utf8_length(const unsigned char *s) {
  for (size_t i = 0; i < sizeof utf8 / sizeof *utf8; ++i) {
    if (s[0] < utf8[i].first || s[0] > utf8[i].last) continue;
    int n = utf8[i].length;
    if (n > 1 && (s[1] < utf8[i].low || s[1] > utf8[i].high)) return 0;
    for (int k = 2; k < n; ++k)
      if ((s[k] & 0xC0) != 0x80) return 0;
    return n;
  }
  return 0;
}

/* A byte that is no UTF-8 is taken as Latin-1, so that the file stays valid. */
static void json_text(FILE *f, const char *text) {
  fputc('"', f);
  for (const unsigned char *s = (const unsigned char *)text; *s != '\0';) {
    int n = utf8_length(s);
    if (*s == '"' || *s == '\\')
      fprintf(f, "\\%c", *s);
    else if (*s == '\n')
      fputs("\\n", f);
    else if (*s < 0x20 || n == 0 || *s == 0x7F)
      fprintf(f, "\\u%04x", *s);
    else
      fwrite(s, 1, (size_t)n, f);
    s += n > 0 ? n : 1;
  }
  fputc('"', f);
}

static void json_next(json *w, const char *name) {
  if (w->filled[w->depth]++ > 0) fputc(',', w->f);
  fprintf(w->f, "\n%*s", 2 * w->depth, "");
  if (name == NULL) return;
  json_text(w->f, name);
  fputs(": ", w->f);
}

void json_open(json *w, const char *name, char bracket) {
  if (w->depth > 0) json_next(w, name);
  fputc(bracket, w->f);
  w->filled[++w->depth] = 0;
}

void json_close(json *w, char bracket) {
  --w->depth;
  fprintf(w->f, "\n%*s%c", 2 * w->depth, "", bracket);
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
