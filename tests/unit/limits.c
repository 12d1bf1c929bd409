/* src/base/system/limits.c: groups of a folder that stands for the root. */
#include "base/system/limits.h"

#include "support/folder.h"
#include "support/unit.h"

#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>

static char root[64];

/* A file below the root with the folders above it. */
static void put(const char *name, const char *text) {
  char path[512];
  int n = snprintf(path, sizeof path, "%s%s", root, name);
  for (char *p = path + strlen(root) + 1; p < path + n; ++p) {
    if (*p != '/') continue;
    *p = '\0';
    mkdir(path, 0777);
    *p = '/';
  }
  FILE *f = fopen(path, "w");
  ck_assert_ptr_nonnull(f);
  fputs(text, f);
  fclose(f);
}

static limits read_limits(void) {
  limits l;
  limits_read(root, &l);
  return l;
}

static void begin(void) {
  folder_new(root);
  put("/proc/meminfo",
      "MemTotal: 9000 kB\nMemAvailable: 8000 kB\n"
      "SwapFree: 1000 kB\n");
}

TEST(machine_counts_what_is_available) {
  begin();
  limits l = read_limits();
  ck_assert_double_eq(l.memory, 9000.0 * 1024.0);
  ck_assert_str_eq(l.who, "the machine");
  ck_assert_int_ge(l.cores, 1);
  folder_remove(root);
}

/* The least of a group and all above it; pages of files are free. */
TEST(groups_of_version_2_are_climbed) {
  begin();
  put("/proc/self/cgroup", "0::/a/b\n");
  put("/sys/fs/cgroup/a/b/memory.max", "max\n");
  put("/sys/fs/cgroup/a/b/cpu.max", "max 100000\n");
  ck_assert_double_eq(read_limits().memory, 9000.0 * 1024.0);
  put("/sys/fs/cgroup/a/memory.max", "10000000\n");
  put("/sys/fs/cgroup/a/memory.current", "9000000\n");
  put("/sys/fs/cgroup/a/memory.stat", "anon 1\nfile 1500000\nslab 3\n");
  put("/sys/fs/cgroup/a/cpu.max", "50000 100000\n");
  limits l = read_limits();
  ck_assert_double_eq(l.memory, 2500000.0);
  ck_assert_str_eq(l.who, "its control group");
  ck_assert_int_eq(l.cores, 1);
  folder_remove(root);
}

/* In a container the path is that of the host, and only the root is seen. */
TEST(groups_of_version_1_count_too) {
  begin();
  put("/proc/self/cgroup", "3:cpu,cpuacct:/docker/x\n2:memory:/docker/x\n");
  put("/sys/fs/cgroup/memory/memory.limit_in_bytes", "3000000\n");
  put("/sys/fs/cgroup/memory/memory.usage_in_bytes", "1000000\n");
  put("/sys/fs/cgroup/memory/memory.stat", "cache 9\ntotal_cache 400000\n");
  put("/sys/fs/cgroup/cpu/cpu.cfs_quota_us", "-1\n");
  put("/sys/fs/cgroup/cpu/cpu.cfs_period_us", "100000\n");
  limits l = read_limits();
  ck_assert_double_eq(l.memory, 2400000.0);
  int cores = l.cores;
  put("/sys/fs/cgroup/cpu/cpu.cfs_quota_us", "90000\n");
  ck_assert_int_eq(read_limits().cores, 1);
  ck_assert_int_ge(cores, 1);
  folder_remove(root);
}

/* What the process holds already is no longer there. */
TEST(limits_of_the_process_count) {
#if defined(__SANITIZE_ADDRESS__)
  return; /* the sanitiser holds terabytes */
#endif
  struct rlimit old, less;
  begin();
  put("/proc/meminfo", "");
  ck_assert(isinf(read_limits().memory));
  ck_assert_int_eq(getrlimit(RLIMIT_AS, &old), 0);
  less = old;
  less.rlim_cur = (rlim_t)64 << 30;
  ck_assert_int_eq(setrlimit(RLIMIT_AS, &less), 0);
  limits l = read_limits();
  setrlimit(RLIMIT_AS, &old);
  ck_assert_double_lt(l.memory, (double)less.rlim_cur);
  ck_assert_double_gt(l.memory, 0.5 * (double)less.rlim_cur);
  ck_assert_str_eq(l.who, "ulimit -v");
  ck_assert_double_gt(limits_held(), 1e5);
  folder_remove(root);
}

/* "ulimit -d" counts no address space that a file or nothing fills. */
TEST(limit_of_the_data_counts_data_alone) {
#if defined(__SANITIZE_ADDRESS__)
  return; /* the sanitiser holds terabytes */
#endif
  const size_t size = (size_t)48 << 30;
  struct rlimit old, less;
  begin();
  put("/proc/meminfo", "");
  void *p = mmap(NULL, size, PROT_NONE,
                 MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  ck_assert(p != MAP_FAILED);
  ck_assert_int_eq(getrlimit(RLIMIT_DATA, &old), 0);
  less = old;
  less.rlim_cur = (rlim_t)64 << 30;
  ck_assert_int_eq(setrlimit(RLIMIT_DATA, &less), 0);
  limits l = read_limits();
  setrlimit(RLIMIT_DATA, &old);
  munmap(p, size);
  ck_assert_double_lt(l.memory, (double)less.rlim_cur);
  ck_assert_double_gt(l.memory, 0.5 * (double)less.rlim_cur);
  ck_assert_str_eq(l.who, "ulimit -d");
  folder_remove(root);
}

UNIT_MAIN("limits")
