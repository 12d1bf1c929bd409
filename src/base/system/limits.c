/*
 * Limits of the system. Memory is the least of what the machine has left
 * (MemAvailable and swap), the control groups (version 1 and 2) up to their
 * root, and the limits of the process (ulimit -v, -d). Pages of files count as
 * free in a group: they can be reclaimed.
 */
#define _GNU_SOURCE /* sched_getaffinity, sched_getcpu */
#include "base/system/limits.h"

#include "base/base.h"

#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

enum { PATH = 4096, LINE = 4096 };

/* The number behind a word at the start of a line ("": the first number) of the
 * file, or "none". */
static double number_in(const char *file, const char *word, double none) {
  char line[LINE];
  double value = none;
  size_t n = strlen(word);
  FILE *f = fopen(file, "r");
  while (f != NULL && fgets(line, sizeof line, f) != NULL) {
    char *end;
    if (strncmp(line, word, n) != 0) continue;
    double x = strtod(line + n, &end);
    if (end == line + n) continue;
    value = x;
    break;
  }
  if (f != NULL) fclose(f);
  return value;
}

static void lower(limits *l, double memory, const char *who) {
  if (!(memory < l->memory)) return;
  l->memory = fmax(memory, 0.0);
  l->who = who;
}

/* The limits of one group, by its folder. */
typedef void group_limit(const char *folder, limits *l);

static double group_number(const char *folder, const char *file,
                           const char *word, double none) {
  char path[PATH + 40];
  snprintf(path, sizeof path, "%s/%s", folder, file);
  return number_in(path, word, none);
}

static const double NO_LIMIT = 1e18; /* more bytes than any limit is */

/* The names of its files, and the word before what files hold of it, which
 * takes the kernel longer to add up than all else here to read. */
static void memory_of_group(const char *folder, const char *limit,
                            const char *usage, const char *word, limits *l) {
  const double most = group_number(folder, limit, "", INFINITY);
  if (most > NO_LIMIT) return;
  const double used = group_number(folder, usage, "", 0.0);
  if (most - used >= l->memory) return;
  const double files = group_number(folder, "memory.stat", word, 0.0);
  lower(l, most - fmax(used - files, 0.0), "its control group");
}

static void memory_of_group_1(const char *folder, limits *l) {
  memory_of_group(folder, "memory.limit_in_bytes", "memory.usage_in_bytes",
                  "total_cache ", l);
}

static void lower_cores(double quota, double period, limits *l) {
  if (!(quota > 0.0 && period > 0.0) || quota / period > 1e6) return;
  int cores = (int)ceil(quota / period);
  if (cores < l->cores) l->cores = cores;
}

static void cores_of_group_1(const char *folder, limits *l) {
  lower_cores(group_number(folder, "cpu.cfs_quota_us", "", -1.0),
              group_number(folder, "cpu.cfs_period_us", "", -1.0), l);
}

static void cores_of_group_2(const char *folder, limits *l) {
  char path[PATH + 40];
  double quota, period;
  snprintf(path, sizeof path, "%s/cpu.max", folder);
  FILE *f = fopen(path, "r");
  if (f == NULL) return;
  if (fscanf(f, "%lf %lf", &quota, &period) == 2) lower_cores(quota, period, l);
  fclose(f);
}

static void of_group_2(const char *folder, limits *l) {
  memory_of_group(folder, "memory.max", "memory.current", "file ", l);
  cores_of_group_2(folder, l);
}

/* A group and all above it. In a container the path may be that of the host,
 * of which only the root is seen. */
static void climb(const char *root, const char *mount, const char *group,
                  group_limit *limit, limits *l) {
  char folder[PATH];
  int n = snprintf(folder, sizeof folder, "%s%s", root, mount);
  if (n < 0 || n + strlen(group) >= sizeof folder) return;
  strcpy(folder + n, group);
  for (;;) {
    limit(folder, l);
    char *slash = strrchr(folder + n, '/');
    if (slash == NULL) break;
    *slash = '\0';
  }
}

/* A line of /proc/self/cgroup: NUMBER:CONTROLLERS:GROUP. */
static void read_group(const char *root, char *line, limits *l) {
  line[strcspn(line, "\n")] = '\0';
  char *kind = strchr(line, ':');
  char *group = kind != NULL ? strchr(kind + 1, ':') : NULL;
  if (group == NULL) return;
  *group++ = '\0';
  ++kind;
  if (*kind == '\0') climb(root, "/sys/fs/cgroup", group, of_group_2, l);
  for (char *rest = NULL, *c = strtok_r(kind, ",", &rest); c != NULL;
       c = strtok_r(NULL, ",", &rest)) {
    if (strcmp(c, "memory") == 0)
      climb(root, "/sys/fs/cgroup/memory", group, memory_of_group_1, l);
    if (strcmp(c, "cpu") == 0)
      climb(root, "/sys/fs/cgroup/cpu", group, cores_of_group_1, l);
  }
}

static void read_machine(const char *root, limits *l) {
  char path[PATH];
  snprintf(path, sizeof path, "%s/proc/meminfo", root);
  double kilo = number_in(path, "MemAvailable:", INFINITY) +
                number_in(path, "SwapFree:", 0.0);
  lower(l, 1024.0 * kilo, "the machine");
}

/* Column k of /proc/self/statm in bytes. */
static double held(int k) {
  double pages[7] = {0};
  FILE *f = fopen("/proc/self/statm", "r");
  for (int i = 0; f != NULL && i < 7; ++i)
    if (fscanf(f, "%lf", &pages[i]) != 1) break;
  if (f != NULL) fclose(f);
  return pages[k] * (double)sysconf(_SC_PAGESIZE);
}

enum { ALL_PAGES = 0, RESIDENT = 1, DATA_PAGES = 5 };

static void read_process(limits *l) {
  static const struct {
    unsigned resource;
    int column;
    const char *who;
  } rows[] = {{RLIMIT_AS, ALL_PAGES, "ulimit -v"},
              {RLIMIT_DATA, DATA_PAGES, "ulimit -d"}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
    struct rlimit r;
    if (getrlimit(rows[i].resource, &r) != 0 || r.rlim_cur == RLIM_INFINITY)
      continue;
    lower(l, (double)r.rlim_cur - held(rows[i].column), rows[i].who);
  }
}

static int allowed_cores(void) {
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) == 0) return CPU_COUNT(&set);
  long n = sysconf(_SC_NPROCESSORS_ONLN); /* more than the set can hold */
  return n > 0 ? (int)n : 1;
}

void limits_read(const char *root, limits *l) {
  *l = (limits){allowed_cores(), INFINITY, "nothing"};
  read_machine(root, l);
  char path[PATH], line[LINE];
  snprintf(path, sizeof path, "%s/proc/self/cgroup", root);
  FILE *f = fopen(path, "r");
  while (f != NULL && fgets(line, sizeof line, f) != NULL)
    read_group(root, line, l);
  if (f != NULL) fclose(f);
  read_process(l);
}

double limits_held(void) { return held(RESIDENT); }

static cpu_set_t processors; /* of the process; none: not changed */

/* OpenBLAS starts a thread for each processor when it is loaded. Each waits
 * actively for tens of milliseconds and takes a stack and a buffer; without
 * room for them (ulimit -v) the process ends. So the process has one processor
 * until the first call of limits_release_processors. */
static void take_one_processor(void) {
  cpu_set_t one;
  const int current = sched_getcpu();
  if (current < 0 || current >= CPU_SETSIZE ||
      sched_getaffinity(0, sizeof processors, &processors) != 0)
    return;
  CPU_ZERO(&one);
  CPU_SET(current, &one);
  sched_setaffinity(0, sizeof one, &one);
}

/* Called before the constructors of the libraries. */
static void (*const before_libraries)(void)
    __attribute__((section(".preinit_array"), used)) = take_one_processor;

void limits_release_processors(void) {
  if (CPU_COUNT(&processors) > 0)
    sched_setaffinity(0, sizeof processors, &processors);
  CPU_ZERO(&processors);
}
