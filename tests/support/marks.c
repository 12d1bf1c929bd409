#include "support/marks.h"

enum { PLACES = 64 };

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
