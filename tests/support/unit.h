/*
 * One test program per file: TEST(name) {...} is a test of it, a case of check;
 * TESTS(name, times) {...} one for each _i = 0, 1, ... below times, a check of
 * its own. UNIT_MAIN(name) runs those of the file, in their order there, and
 * ends with check's closing line.
 */
#pragma once

#include "base/base.h"
#include "base/system/blas.h"

#include <check.h>
#include <stdarg.h>

/* A case may take this long under the sanitisers on a loaded machine. */
enum { UNIT_SECONDS = 600 };

/* 1: make stability, which leaves out nothing that make test does. */
static inline int unit_whole(void) { return getenv("PROTIS_PROBLEMS") != NULL; }

/* FREED double *a = ...: free(a) where the name ends. */
#define FREED ENDS_BY(unit_free)
static inline void unit_free(void *p) {
  void *block;
  memcpy(&block, p, sizeof block);
  free(block);
}

/* PRINTED(text, "format", ...): char text[], as by snprintf, whole. */
#define PRINTED(name, ...) \
  char name[8192];         \
  unit_print(name, sizeof name, __VA_ARGS__)
__attribute__((format(printf, 3, 4))) static inline void unit_print(
    char *to, size_t size, const char *format, ...) {
  va_list args;
  va_start(args, format);
  const int n = vsnprintf(to, size, format, args);
  va_end(args);
  ck_assert(n >= 0 && (size_t)n < size);
}

/* Bytes that were requested before a test. */
static size_t unit_before;

static inline void unit_start(void) { unit_before = memory_in_use(); }

/* All is given back. */
static inline void unit_end(void) {
  ck_assert_uint_eq(memory_in_use(), unit_before);
}

typedef struct unit_test {
  TTest of;
  int times;
  struct unit_test *next;
} unit_test;

/* The tests of the file. */
static unit_test *unit_first, **unit_last = &unit_first;

static inline void unit_join(unit_test *t, int times) {
  t->times = times;
  *unit_last = t;
  unit_last = &t->next;
}

/* Run them; a case may take so many seconds. Exit code of the program. */
static inline int unit_run(const char *name, double seconds) {
  Suite *suite = suite_create(name);
  TCase *tests = tcase_create(name);
  tcase_set_timeout(tests, seconds);
  for (const unit_test *t = unit_first; t != NULL; t = t->next)
    tcase_add_loop_test(tests, &t->of, 0, t->times);
  suite_add_tcase(suite, tests);
  tcase_add_checked_fixture(tests, unit_start, unit_end);
  blas_set_threads(1); /* as the program does */
  SRunner *runner = srunner_create(suite);
  srunner_run_all(runner, CK_NORMAL);
  int failed = srunner_ntests_failed(runner);
  srunner_free(runner);
  return failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

#define TEST(name) TESTS(name, 1)
#define TESTS(name, times)                                                \
  static void name(int _i);                                               \
  __attribute__((constructor)) static void name##_joins(void) {           \
    static unit_test self = {{#name, name, __FILE__, __LINE__}, 0, NULL}; \
    unit_join(&self, (int)(times));                                       \
  }                                                                       \
  static void name(int _i __attribute__((unused)))

#define UNIT_MAIN(name) UNIT_MAIN_FOR(name, UNIT_SECONDS)
#define UNIT_MAIN_FOR(name, seconds) \
  int main(void) { return unit_run(name, seconds); }

/* Of a run, an expression of a status, request k = 1, 2, ... is refused until
 * there are no so many; each refusal is told, and all is given back by "after",
 * a statement, where refused is 1 but for the last. More than "least" runs. */
#define UNIT_REFUSED(least, run, after)                       \
  do {                                                        \
    long k_ = 0;                                              \
    for (status st_ = ERR_MEMORY; st_ != OK;) {               \
      const size_t bytes_ = memory_in_use();                  \
      const long start_ = memory_requests();                  \
      memory_refuse(++k_, 0);                                 \
      st_ = (run);                                            \
      const int refused = st_ != OK;                          \
      const long made_ = memory_requests() - start_;          \
      memory_refuse(0, 0);                                    \
      (void)refused;                                          \
      after;                                                  \
      ck_assert_msg(refused ? st_ == ERR_MEMORY : made_ < k_, \
                    "request %ld: %s", k_, status_message()); \
      ck_assert_uint_eq(memory_in_use(), bytes_);             \
    }                                                         \
    ck_assert_int_gt(k_, least);                              \
  } while (0)
