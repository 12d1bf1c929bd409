#include "support/same_json.h"

#include <check.h>
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Two files, read side by side; the last text is the name of a number. */
typedef struct reader {
  const char *at[2], *line[2], *name;
  double tol, least; /* of numbers; tol 0: their bits */
} reader;

/* Behind the text that starts at p; *digits: it has some. */
static const char *text_end(const char *p, int *digits) {
  *digits = 0;
  for (++p; *p != '"' && *p != '\0'; ++p) {
    *digits |= isdigit((unsigned char)*p) != 0;
    if (*p == '\\') ++p;
  }
  return *p == '"' ? p + 1 : p;
}

static int same_text(reader *r) {
  const char *p = r->at[0], *q = r->at[1];
  int digits[2];
  for (int k = 0; k < 2; ++k) r->at[k] = text_end(r->at[k], &digits[k]);
  r->name = p;
  if (digits[0] || digits[1]) return digits[0] && digits[1];
  return r->at[0] - p == r->at[1] - q &&
         memcmp(p, q, (size_t)(r->at[0] - p)) == 0;
}

static int is_compared(const char *name) {
  static const char *const names[] = {"\"value\"", "\"error\"", "\"corrected\"",
                                      "\"band\"", "\"mesh_error_percent\""};
  for (size_t k = 0; k < sizeof names / sizeof *names; ++k)
    if (strncmp(name, names[k], strlen(names[k])) == 0) return 1;
  return 0;
}

static int same_number(reader *r) {
  double x[2];
  for (int k = 0; k < 2; ++k) {
    char *end;
    x[k] = strtod(r->at[k], &end);
    r->at[k] = end;
  }
  if (r->tol == 0.0) {
    int unused;
    return frexp(x[0], &unused) == frexp(x[1], &unused);
  }
  if (r->name == NULL || !is_compared(r->name)) return 1;
  return fabs(x[0] - x[1]) <= r->tol * fmax(fabs(x[0]), fabs(x[1])) + r->least;
}

static int same(const job *a, const job *b, reader *r, char *where,
                size_t size) {
  char *of[2] = {job_file(a, "json"), job_file(b, "json")};
  int is = 1;
  ck_assert(of[0] != NULL && of[1] != NULL);
  for (int k = 0; k < 2; ++k) r->at[k] = r->line[k] = of[k];
  while (is && *r->at[0] != '\0') {
    const char first = *r->at[0], second = *r->at[1];
    if (first == '"' && second == '"') {
      is = same_text(r);
    } else if (isdigit((unsigned char)first) || first == '-') {
      is = same_number(r);
    } else {
      is = first == second;
      for (int k = 0; k < 2; ++k)
        if (*r->at[k]++ == '\n') r->line[k] = r->at[k];
    }
  }
  if (!is)
    snprintf(where, size, "%.*s, not %.*s", (int)strcspn(r->line[0], "\n"),
             r->line[0], (int)strcspn(r->line[1], "\n"), r->line[1]);
  free(of[0]);
  free(of[1]);
  return is;
}

int same_json_bits(const job *a, const job *b, char *where, size_t size) {
  reader r = {.tol = 0.0};
  return same(a, b, &r, where, size);
}

int same_json_errors(const job *a, const job *b, double tol, double least,
                     char *where, size_t size) {
  reader r = {.tol = tol, .least = least};
  return same(a, b, &r, where, size);
}
