/*
 * check writes down each place where an assertion has held, for the report of a
 * crash: more time than the assertion takes, in loops over tables. Here a place
 * is written down once in a while (the linker calls this: Makefile, marks).
 */
#include <check.h>

enum { PLACES = 64 };

void __real__mark_point(const char *file, int line);
void __wrap__mark_point(const char *file, int line);

void __wrap__mark_point(const char *file, int line) {
  static struct {
    const char *file;
    int line;
  } known[PLACES];
  const int k = line % PLACES;
  if (known[k].file == file && known[k].line == line) return;
  known[k].file = file;
  known[k].line = line;
  __real__mark_point(file, line);
}
