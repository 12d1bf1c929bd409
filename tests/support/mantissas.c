#include "support/mantissas.h"

#include <check.h>
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Behind the text that starts at p; *digits: it has some. */
static const char *text_end(const char *p, int *digits) {
  *digits = 0;
  for (++p; *p != '"' && *p != '\0'; ++p) {
    *digits |= isdigit((unsigned char)*p) != 0;
    if (*p == '\\') ++p;
  }
  return *p == '"' ? p + 1 : p;
}

/* The number, text or sign at both places, and behind it; 0: not the same. */
static int step(const char **p, const char **q) {
  const char *from[2] = {*p, *q};
  int digits[2], unused;
  if (**p == '"' && **q == '"') {
    *p = text_end(*p, &digits[0]);
    *q = text_end(*q, &digits[1]);
    return digits[0] ? digits[1]
                     : *p - from[0] == *q - from[1] &&
                           memcmp(from[0], from[1], *p - from[0]) == 0;
  }
  if (isdigit((unsigned char)**p) || **p == '-') {
    char *end[2];
    const double x = frexp(strtod(*p, &end[0]), &unused);
    const double y = frexp(strtod(*q, &end[1]), &unused);
    *p = end[0];
    *q = end[1];
    return x == y;
  }
  return *(*p)++ == *(*q)++;
}

int mantissas_are_same(const job *a, const job *b, char *where, size_t size) {
  char *of[2] = {job_file(a, "json"), job_file(b, "json")};
  ck_assert(of[0] != NULL && of[1] != NULL);
  const char *p = of[0], *q = of[1], *line = p, *other = q;
  int same = 1;
  while (same && *p != '\0') {
    if (*p == '\n') line = p + 1, other = q + 1;
    same = step(&p, &q);
  }
  snprintf(where, size, "%.*s, not %.*s", (int)strcspn(line, "\n"), line,
           (int)strcspn(other, "\n"), other);
  free(of[0]);
  free(of[1]);
  return same;
}
