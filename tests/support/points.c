/*
 * Points of torture.
 */
#include "support/points.h"

#include "base/base.h"

#include <check.h>
#include <stdarg.h>

int points_all(void) { return getenv("PROTIS_POINTS") != NULL; }

long points_number(long few, double share) {
  const char *text = getenv("PROTIS_POINTS");
  if (text == NULL) return few;
  long n = (long)(strtod(text, NULL) * share + 0.5);
  return n < 1 ? 1 : n;
}

long points_spread(long k, long n, long all) {
  if (n >= all) return k % all + 1;
  if (n == 1) return (all + 1) / 2;
  return 1 + (long)((double)k * (double)(all - 1) / (double)(n - 1));
}

void points_try(points *t) { ++t->tried; }

void points_lose(points *t, const char *format, ...) {
  va_list args;
  char text[sizeof t->first];
  va_start(args, format);
  vsnprintf(text, sizeof text, format, args);
  va_end(args);
  if (t->lost++ == 0) memcpy(t->first, text, sizeof text);
  printf("lost: %s: %s\n", t->kind, text);
}

void points_end(const points *t) {
  printf("TALLY %s | %ld | %ld | %ld\n", t->kind, t->tried, t->tried - t->lost,
         t->lost);
  fflush(stdout);
  ck_assert_int_gt(t->tried, 0);
  ck_assert_msg(t->lost == 0, "%s: %ld of %ld lost, first: %s", t->kind,
                t->lost, t->tried, t->first);
}
