/*
 * One test program per file: UNIT_MAIN(name, test, ...) runs the tests named,
 * each START_TEST of check, and ends with check's closing line; UNIT_LOOP(name,
 * test, times) runs one test for _i = 0, 1, ...
 */
#pragma once

#include "base/memory.h"
#include "base/system/blas.h"

#include <check.h>
#include <stdlib.h>

/* A case may take this long under the sanitisers on a loaded machine. */
enum { UNIT_SECONDS = 600 };

/* 1: make stability, which leaves out nothing that make test does. */
static inline int unit_whole(void) { return getenv("PROTIS_PROBLEMS") != NULL; }

/* Bytes that were requested before a test. */
static size_t unit_before;

static inline void unit_start(void) { unit_before = memory_in_use(); }

/* All is given back. */
static inline void unit_end(void) {
  ck_assert_uint_eq(memory_in_use(), unit_before);
}

/* Run the suite of one case; exit code of the program. */
static inline int unit_run(const char *name, TCase *tests) {
  Suite *suite = suite_create(name);
  suite_add_tcase(suite, tests);
  tcase_add_checked_fixture(tests, unit_start, unit_end);
  blas_set_threads(1); /* as the program does */
  SRunner *runner = srunner_create(suite);
  srunner_run_all(runner, CK_NORMAL);
  int failed = srunner_ntests_failed(runner);
  srunner_free(runner);
  return failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

#define UNIT_MAIN(name, ...)                                       \
  int main(void) {                                                 \
    const TTest *const tests_[] = {__VA_ARGS__};                   \
    TCase *case_ = tcase_create(name);                             \
    tcase_set_timeout(case_, UNIT_SECONDS);                        \
    for (size_t i_ = 0; i_ < sizeof tests_ / sizeof *tests_; ++i_) \
      tcase_add_test(case_, tests_[i_]);                           \
    return unit_run(name, case_);                                  \
  }

/* One test run for _i = 0 .. times - 1, each a check of its own. */
#define UNIT_LOOP(name, test, times)              \
  int main(void) {                                \
    TCase *case_ = tcase_create(name);            \
    tcase_set_timeout(case_, 10 * UNIT_SECONDS);  \
    tcase_add_loop_test(case_, test, 0, (times)); \
    return unit_run(name, case_);                 \
  }
