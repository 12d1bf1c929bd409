/* src/base/system/blas.c: a lesser kernel is replaced once, the user's choice
 * stays; threads of the environment do not count. */
#include "support/unit.h"

#include <unistd.h>

int openblas_get_num_threads(void);

/* This program runs itself in one of the roles below and reads what it says:
 * "forget": the library was loaded with the kernel of the environment, which
 * is then forgotten as if the library had chosen it; "keep": it stays set. */
static int play(const char *role, char **argv) {
  if (strcmp(role, "forget") == 0 && !blas_kernel_changed())
    unsetenv("OPENBLAS_CORETYPE");
  blas_choose_kernel(argv);
  printf("%s %d %s %d\n", blas_kernel(), blas_kernel_changed(), argv[1],
         openblas_get_num_threads());
  return 0;
}

static void run_self(const char *role, char *answer, int size) {
  char path[1024];
  const ssize_t n = readlink("/proc/self/exe", path, sizeof path - 1);
  ck_assert_int_gt((int)n, 0);
  path[n] = '\0';
  PRINTED(command, "OPENBLAS_NUM_THREADS=2 OPENBLAS_CORETYPE=Prescott '%s' %s",
          path, role);
  FILE *pipe = popen(command, "r");
  ck_assert_ptr_nonnull(pipe);
  ck_assert_ptr_nonnull(fgets(answer, size, pipe));
  ck_assert_int_eq(pclose(pipe), 0);
}

static const char *best(void) {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq"))
    return "SkylakeX 1 forget 1\n";
  if (__builtin_cpu_supports("avx2")) return "Haswell 1 forget 1\n";
#endif
  return "Prescott 0 forget 1\n";
}

TEST(lesser_kernel_is_replaced_by_the_best_the_processor_runs) {
  char answer[100];
  run_self("forget", answer, sizeof answer);
  ck_assert_str_eq(answer, best());
}

TEST(kernel_the_user_asked_for_stays) {
  char answer[100];
  run_self("keep", answer, sizeof answer);
  ck_assert_str_eq(answer, "Prescott 0 keep 1\n");
}

TEST(small_matrices_are_left_to_one_thread) {
  blas_set_threads(2);
  ck_assert_int_eq(openblas_get_num_threads(), 2);
  const int before = blas_rows(20);
  ck_assert_int_eq(openblas_get_num_threads(), 1);
  ck_assert_int_eq(blas_rows(before), 20);
  ck_assert_int_eq(openblas_get_num_threads(), 2);
}

int main(int argc, char **argv) {
  if (argc == 2) return play(argv[1], argv);
  return unit_run("blas", UNIT_SECONDS);
}
