/*
 * The BLAS kernel. OpenBLAS chooses it when the library is loaded, by a table
 * of processors; an unknown one gets a kernel for SSE3 that takes three times
 * the time. The choice can only be changed by the environment of a new process:
 * set it and run the same program again, once.
 */

#include "base/system/blas.h"

#include "base/base.h"
#include "base/system/limits.h"

#include <cblas.h>
#include <dlfcn.h>
#include <limits.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

char *openblas_get_corename(void);
void openblas_set_num_threads(int n);

/* Bytes of a buffer of OpenBLAS and a little; MB of addresses for the program,
 * its libraries and one buffer. */
enum { BUFFER = 130 << 20, NEEDED = 230 };

static const char choice[] = "OPENBLAS_CORETYPE";
static const char guard[] = "PROTIS_BLAS_KERNEL";

const char *blas_kernel(void) { return openblas_get_corename(); }

int blas_kernel_changed(void) { return getenv(guard) != NULL; }

/* Instruction set a kernel uses: 0 SSE, 1 AVX, 2 AVX2, 3 AVX-512 or one that
 * is not known here, which is left alone. */
static int kernel_level(const char *name) {
  static const char *const known[3][16] = {
      {"Prescott", "Core2", "Penryn", "Dunnington", "Nehalem", "Atom", "Katmai",
       "Coppermine", "Northwood", "Banias", "Opteron", "Opteron_SSE3",
       "Barcelona", "Bobcat", "Nano", "Athlon"},
      {"Sandybridge", "Bulldozer", "Piledriver", "Steamroller"},
      {"Haswell", "Zen", "Excavator"}};
  for (int level = 0; level < 3; ++level)
    for (int i = 0; i < 16 && known[level][i] != NULL; ++i)
      if (strcmp(name, known[level][i]) == 0) return level;
  return 3;
}

/* The best kernel this processor can run, or NULL. */
static const char *best_kernel(int *level) {
  *level = 0;
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma"))
    return NULL;
  *level = 2;
  if (!__builtin_cpu_supports("avx512f") ||
      !__builtin_cpu_supports("avx512dq") ||
      !__builtin_cpu_supports("avx512bw") ||
      !__builtin_cpu_supports("avx512vl") ||
      !__builtin_cpu_supports("avx512cd"))
    return "HASWELL";
  *level = 3;
  return "SKYLAKEX";
#else
  return NULL;
#endif
}

/* CHOLMOD's parallel regions take OMP_THREADS threads in any case; level 0
 * makes them run on one. The OpenMP library is looked up, not linked. */
enum { OMP_THREADS = 4 };

static void limit_openmp(int levels) {
  union {
    void *object;
    void (*call)(int);
  } set;
  void *self = dlopen(NULL, RTLD_LAZY);
  if (self == NULL) return;
  set.object = dlsym(self, "omp_set_max_active_levels");
  if (set.object != NULL) set.call(levels);
  dlclose(self);
}

/* Rows from which a factorization gains by a second thread; with fewer the
 * threads synchronize longer than they calculate, on a busy machine a hundred
 * times as long. */
enum { SHARED_ROWS = 800 };

static int threads = 1, rows_now = INT_MAX;

void blas_set_threads(int n) {
  limits_release_processors();
  threads = n;
  blas_rows(rows_now);
  limit_openmp(n >= OMP_THREADS ? 1 : 0);
}

int blas_rows(int rows) {
  const int before = rows_now;
  rows_now = rows;
  openblas_set_num_threads(rows < SHARED_ROWS ? 1 : threads);
  return before;
}

/* OpenBLAS requests its buffers until it gets them: it takes that of this
 * thread now, or the process ends. */
static void fit_address_space(void) {
  struct rlimit limit;
  if (!(getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY))
    return;
  void *buffer = mmap(NULL, BUFFER, PROT_READ | PROT_WRITE,
                      MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (buffer == MAP_FAILED) {
    dprintf(STDERR_FILENO,
            "protis: error: memory exhausted: the limit of addresses (ulimit "
            "-v) is %.0f MB, the linear algebra needs %d MB to start; raise "
            "it\n",
            (double)limit.rlim_cur / 1048576.0, NEEDED);
    _exit(status_exit_code(ERR_MEMORY));
  }
  munmap(buffer, BUFFER);
  /* A product that is large enough to be made in the buffer of the thread: of
   * up to 100 rows the kernels for AVX-512 make without. */
  enum { SIDE = 128 };
  double a[SIDE * SIDE] = {0}, b[SIDE * SIDE];
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, SIDE, SIDE, SIDE, 1.0,
              a, SIDE, a, SIDE, 0.0, b, SIDE);
}

void blas_choose_kernel(char **argv) {
  int level;
  fit_address_space();
  const char *best = best_kernel(&level);
  blas_set_threads(1);
  if (best == NULL || kernel_level(blas_kernel()) >= level) return;
  if (getenv(choice) != NULL || getenv(guard) != NULL) return;
  if (setenv(choice, best, 1) != 0 || setenv(guard, best, 1) != 0) return;
  execv("/proc/self/exe", argv);
  unsetenv(choice);
  unsetenv(guard);
}
