/*
 * One test program per file: UNIT_MAIN(name, test, ...) runs the tests named,
 * each START_TEST of check, and ends with check's closing line.
 */
#ifndef PROTIS_TESTS_UNIT_H
#define PROTIS_TESTS_UNIT_H

#include "fem/fem.h"

#include <check.h>
#include <stdlib.h>

/* A case may take this long under the sanitisers on a loaded machine. */
enum { UNIT_SECONDS = 600 };

#define UNIT_MAIN(name, ...)                                       \
  int main(void) {                                                 \
    const TTest *const tests_[] = {__VA_ARGS__};                   \
    blas_set_threads(1); /* as the program does */                 \
    Suite *suite_ = suite_create(name);                            \
    TCase *case_ = tcase_create(name);                             \
    tcase_set_timeout(case_, UNIT_SECONDS);                        \
    for (size_t i_ = 0; i_ < sizeof tests_ / sizeof *tests_; ++i_) \
      tcase_add_test(case_, tests_[i_]);                           \
    suite_add_tcase(suite_, case_);                                \
    SRunner *runner_ = srunner_create(suite_);                     \
    srunner_run_all(runner_, CK_NORMAL);                           \
    int failed_ = srunner_ntests_failed(runner_);                  \
    srunner_free(runner_);                                         \
    return failed_ == 0 ? EXIT_SUCCESS : EXIT_FAILURE;             \
  }

#endif
