/* src/base/memory.c, status.c, timer.c */
#include "support/unit.h"

#include <SuiteSparse_config.h>
#include <sys/wait.h>
#include <unistd.h>

TEST(bytes_in_use_return_to_the_start) {
  size_t before = memory_in_use();
  double *a = memory_new(100, sizeof *a);
  ck_assert_ptr_nonnull(a);
  ck_assert_uint_eq(memory_in_use(), before + 100 * sizeof *a);
  for (int i = 0; i < 100; ++i) ck_assert(a[i] == 0.0);
  memory_free(a);
  memory_free(NULL);
  ck_assert_uint_eq(memory_in_use(), before);
}

/* Sparse factors count and can be refused like any other block. */
TEST(blocks_of_suitesparse_are_counted) {
  size_t before = memory_in_use();
  int moved;
  memory_count_suitesparse();
  double *a = SuiteSparse_malloc(3, sizeof *a);
  ck_assert_uint_eq(memory_in_use(), before + 3 * sizeof *a);
  a[2] = 7.0;
  a = SuiteSparse_realloc(5, 3, sizeof *a, a, &moved);
  ck_assert(moved && a[2] == 7.0);
  ck_assert_uint_eq(memory_in_use(), before + 5 * sizeof *a);
  memory_refuse(1, 0);
  ck_assert_ptr_null(SuiteSparse_calloc(1, 1));
  SuiteSparse_free(a);
  ck_assert_uint_eq(memory_in_use(), before);
}

/* The signal that ends a process in which a[n] is written. */
static int signal_behind(double *a, size_t n) {
  int code;
  const pid_t pid = fork();
  if (pid == 0) {
    fclose(stderr);
    a[n] = 1.0;
    memory_free(a);
    _exit(0);
  }
  ck_assert_int_eq(waitpid(pid, &code, 0), pid);
  memory_free(a);
  return WIFSIGNALED(code) ? WTERMSIG(code) : 0;
}

/* In the tests: what lies behind a block is no number, and stays as it is; once
 * it is known who makes the blocks of src, it cannot be touched
 * (tests/preload/guard.c). */
TEST(blocks_are_guarded) {
  const char *loaded = getenv("LD_PRELOAD");
  volatile size_t n = 3;
  if (loaded == NULL || strstr(loaded, "mesh.so") == NULL) return;
  for (int k = 0; k < 2; ++k) {
    double *a = memory_new(n, sizeof *a);
    ck_assert_ptr_nonnull(a);
    if (k == 0) ck_assert(isnan(a[n]));
    ck_assert_int_eq(signal_behind(a, n), k == 0 ? SIGABRT : SIGSEGV);
  }
}

TEST(overflowing_request_is_refused) {
  ck_assert_ptr_null(memory_new((size_t)-1 / 4, 8));
}

TEST(kth_request_is_refused_once_or_for_good) {
  memory_refuse(2, 0);
  void *a = memory_new(1, 1), *b = memory_new(1, 1), *c = memory_new(1, 1);
  ck_assert(a != NULL && b == NULL && c != NULL);
  memory_refuse(1, 1);
  ck_assert_ptr_null(memory_new(1, 1));
  ck_assert_ptr_null(memory_new(1, 1));
  memory_refuse(0, 0);
  memory_free(a);
  memory_free(c);
}

/* What is above the limit is refused, and can be asked before. */
TEST(limit_is_kept_and_expected) {
  memory_limit(memory_in_use() + 1000, "a test");
  ck_assert_double_eq(memory_left(), 1000.0);
  ck_assert_ptr_null(memory_new(1001, 1));
  OWNED void *a = memory_new(600, 1);
  ck_assert_ptr_nonnull(a);
  ck_assert_ptr_null(memory_new(401, 1));
  ck_assert_int_eq(memory_require(400.0, "a run"), OK);
  ck_assert_int_eq(memory_require(401.0, "a run"), ERR_MEMORY);
  ck_assert_ptr_nonnull(strstr(status_message(), "a test leaves"));
  memory_limit(SIZE_MAX, "nothing");
  ck_assert_int_eq(memory_require(1e300, "a run"), OK);
}

static status fails_inside(void) {
  status st = OK;
  FAIL(ERR_MESH, "element %d", 7);
done:
  return st;
}

static status passes_up(void) {
  status st = OK;
  TRY(fails_inside());
done:
  return st;
}

TEST(failure_keeps_message_and_path) {
  ck_assert_int_eq(passes_up(), ERR_MESH);
  ck_assert_str_eq(status_message(), "element 7");
  ck_assert_ptr_nonnull(strstr(status_path(), "fails_inside"));
  ck_assert_ptr_nonnull(strstr(status_path(), "passes_up"));
  ck_assert_int_eq(status_exit_code(ERR_MESH), 3);
  ck_assert_str_eq(status_name(ERR_MESH), "ERR_MESH");
}

TEST(stage_is_charged_for_itself_only) {
  timer_reset();
  timer_enter(STAGE_LOAD);
  OWNED void *outer = memory_new(1000, 1);
  timer_enter(STAGE_STRESS);
  OWNED void *inner = memory_new(50, 1);
  timer_leave(STAGE_STRESS);
  timer_leave(STAGE_LOAD);
  ck_assert_int_eq(timer_cost(STAGE_LOAD).calls, 1);
  ck_assert_uint_eq(timer_cost(STAGE_LOAD).bytes, 1000);
  ck_assert_uint_eq(timer_cost(STAGE_STRESS).bytes, 50);
  ck_assert_int_eq(timer_cost(STAGE_MESH).calls, 0);
}

UNIT_MAIN("memory")
