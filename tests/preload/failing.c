/*
 * Calls that fail when told.
 */
#include "preload/failing.h"

#include "base/interrupt.h"
#include "base/memory.h"

#include <check.h>
#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>

enum { POINTS = 1 << 14, SEEN = 1 << 16, DEPTH = 100 };

typedef enum failing_mode { OFF, WATCHED, FAILING } failing_mode;

static struct shared {
  failing_mode mode;
  int n;
  failing_point at;
  failing_end end;
  long count[FAILING_CALLS];
  failing_point list[POINTS];
  void *seen[SEEN]; /* return addresses: a hash table                         */
} * all;
static char kept_meshes[200]; /* folder                                       */
static int in_run;            /* 1: this process is the program              */

/* 1 if the address is new. */
static int take(void *address) {
  size_t k = ((size_t)address * 0x9E3779B97F4A7C15u >> 48) % SEEN;
  while (all->seen[k] != NULL && all->seen[k] != address) k = (k + 1) % SEEN;
  int is_new = all->seen[k] == NULL;
  all->seen[k] = address;
  return is_new;
}

static void look(failing_call call) {
  void *frame[DEPTH];
  int is_new = 0, n = backtrace(frame, DEPTH);
  for (int i = 0; i < n; ++i) is_new |= take(frame[i]);
  if (is_new && all->n < POINTS)
    all->list[all->n++] = (failing_point){call, all->count[call]};
}

/* For who wants to know where a point is. */
static void tell_stack(void) {
  void *frame[DEPTH];
  backtrace_symbols_fd(frame, backtrace(frame, DEPTH), STDERR_FILENO);
}

static int fails(failing_call call) {
  if (!in_run || all->mode == OFF) return 0;
  ++all->count[call];
  if (all->mode == WATCHED) look(call);
  if (all->mode == WATCHED || call != all->at.call ||
      all->count[call] != all->at.number)
    return 0;
  all->end.reached = 1;
  if (getenv("FAILING_STACK") != NULL) tell_stack();
  errno = failing_kind_of(call) == FAILING_MEMORY ? ENOMEM : EIO;
  return 1;
}

#define CALL(name, type, answer, parameters, arguments)              \
  type __real_##name parameters;                                     \
  type __wrap_##name parameters;                                     \
  type __wrap_##name parameters {                                    \
    return fails(FAILING_##name) ? answer : __real_##name arguments; \
  }
FAILING_LIST(CALL)

#define CALL_LATE(name, answer, parameters, arguments) \
  int __real_##name parameters;                        \
  int __wrap_##name parameters;                        \
  int __wrap_##name parameters {                       \
    int failed = fails(FAILING_##name);                \
    int error = errno, real = __real_##name arguments; \
    if (failed) errno = error;                         \
    return failed ? answer : real;                     \
  }
FAILING_LATE_LIST(CALL_LATE)

/* An archive that is read has not the array. */
#define CALL_ARCHIVE(name, type)                                           \
  status __real_##name(archive *, const char *, type *, size_t);           \
  status __wrap_##name(archive *a, const char *array, type *v, size_t n) { \
    if (!archive_reads(a) || n == 0 || !fails(FAILING_##name))             \
      return __real_##name(a, array, v, n);                                \
    return __real_##name(a, "that is not there", v, n);                    \
  }
CALL_ARCHIVE(archive_reals, double)
CALL_ARCHIVE(archive_ints, int)
CALL_ARCHIVE(archive_bytes, void)

double __real_expression_value(const expression *e, const double x[3],
                               double t);
double __wrap_expression_value(const expression *e, const double x[3],
                               double t) {
  return fails(FAILING_expression_value) ? NAN
                                         : __real_expression_value(e, x, t);
}

status __real_interrupt_asked(void);
status __wrap_interrupt_asked(void) {
  return fails(FAILING_interrupt_asked) ? ERR_INTERRUPTED
                                        : __real_interrupt_asked();
}

int __real_open(const char *path, int flags, ...);
int __wrap_open(const char *path, int flags, ...) {
  va_list args;
  va_start(args, flags);
  int mode = flags & O_CREAT ? va_arg(args, int) : 0;
  va_end(args);
  return fails(FAILING_open) ? -1 : __real_open(path, flags, mode);
}

/* ---- the mesh reader ----------------------------------------------------- */

/* The copy first: the program kills its reader at the last record. */
static void copy(int from, int other, int to) {
  static char part[1 << 16];
  ssize_t n;
  while ((n = read(from, part, sizeof part)) > 0)
    if ((other >= 0 && write(other, part, (size_t)n) != n) ||
        write(to, part, (size_t)n) != n)
      _exit(98);
}

void __real_child_run(const raw_request *request, int fd, int error_fd);
static uint64_t mix(uint64_t key, const void *data, size_t n) {
  for (const unsigned char *p = data; n > 0; ++p, --n)
    key = (key ^ *p) * 1099511628211u;
  return key;
}

/* Of what makes the mesh, but not the folder of its file. */
static uint64_t request_key(const raw_request *request) {
  const mesh_source *s = request->source;
  const char *slash = strrchr(s->file, '/'), *file = slash ? slash : s->file;
  uint64_t key = mix(14695981039346656037u, file, strlen(file));
  for (int i = 0; i < s->n_number; ++i)
    key = mix(key, &s->numbers[i].value, sizeof s->numbers[i].value);
  for (int k = 0; k < MESH_SIZES && s->sizes[k].of != NULL; ++k)
    key = mix(key, s->sizes[k].at,
              (size_t)s->sizes[k].of->n_node * sizeof *s->sizes[k].at);
  return key;
}

void __wrap_child_run(const raw_request *request, int fd, int error_fd) {
  char path[300];
  int ends[2];
  in_run = 0;
  snprintf(path, sizeof path, "%s/%016" PRIx64, kept_meshes,
           request_key(request));
  int kept = __real_open(path, O_RDONLY);
  if (kept >= 0) {
    copy(kept, -1, fd);
    _exit(0);
  }
  if (pipe(ends) != 0) _exit(98);
  if (fork() == 0) {
    close(ends[0]);
    in_run = 1;
    __real_child_run(request, ends[1], error_fd);
  }
  close(ends[1]);
  copy(ends[0], __real_open(path, O_WRONLY | O_CREAT | O_TRUNC, 0666), fd);
  _exit(0);
}

/* ---- runs ---------------------------------------------------------------- */

void failing_setup(const char *meshes) {
  void *frame[1];
  all = mmap(NULL, sizeof *all, PROT_READ | PROT_WRITE,
             MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  ck_assert_ptr_ne(all, MAP_FAILED);
  snprintf(kept_meshes, sizeof kept_meshes, "%s", meshes);
  backtrace(frame, 1); /* loads what it needs                                */
  /* The program shall not start again with another kernel. */
  setenv("OPENBLAS_CORETYPE", "Haswell", 0);
}

static void become(int argc, char **argv, const char *printed) {
  int to = __real_open(printed, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (dup2(to, STDERR_FILENO) < 0 || dup2(to, STDOUT_FILENO) < 0) _exit(99);
  size_t before = memory_in_use();
  in_run = 1;
  int code = protis_main(argc, argv);
  in_run = 0;
  all->end.held = memory_in_use() - before;
  all->end.opened = H5Fget_obj_count((hid_t)H5F_OBJ_ALL, H5F_OBJ_ALL);
  fflush(NULL);
  _exit(code);
}

int failing_run(int argc, char **argv, const char *printed, failing_end *end) {
  int code;
  all->end = (failing_end){0};
  memset(all->count, 0, sizeof all->count);
  fflush(NULL);
  pid_t pid = fork();
  ck_assert_int_ge(pid, 0);
  if (pid == 0) become(argc, argv, printed);
  ck_assert_int_eq(waitpid(pid, &code, 0), pid);
  *end = all->end;
  return WIFEXITED(code) ? WEXITSTATUS(code) : 1000 + WTERMSIG(code);
}

void failing_watch(void) {
  all->mode = WATCHED;
  all->n = 0;
}

int failing_points(const failing_point **list) {
  *list = all->list;
  return all->n;
}

void failing_at(const failing_point *p) {
  all->mode = p == NULL ? OFF : FAILING;
  if (p != NULL) all->at = *p;
}

#define NAME(name, ...) [FAILING_##name] = #name,
#define NAME_OWN(name) [FAILING_##name] = #name,

const char *failing_name(failing_call c) {
  static const char *const names[] = {FAILING_LIST(NAME) FAILING_LATE_LIST(NAME)
                                          FAILING_OWN_LIST(NAME_OWN)};
  return names[c];
}

failing_kind failing_kind_of(failing_call c) {
  if (c == FAILING_expression_value) return FAILING_VALUE;
  if (c == FAILING_interrupt_asked) return FAILING_SIGNAL;
  return c == FAILING_calloc || c == FAILING_open_memstream ? FAILING_MEMORY
                                                            : FAILING_FILE;
}
