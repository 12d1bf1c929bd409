/*
 * Loaded before the C library of a program under test (LD_PRELOAD): counts the
 * requests for memory from the start of main, of every library, and refuses
 * some.
 *
 *   REFUSE_AT      number of the request to refuse, from 1; 0: none
 *   REFUSE_ALWAYS  1: and every later one
 *   REFUSE_CHILD   1: count and refuse in processes it forks, not in itself
 *   REFUSE_OWN     1: count and refuse only those of the program itself and of
 *                  the solvers of its linear systems
 *   REFUSE_LIBRARY  first and last address of a library that is linked into the
 *                  program, from where it is loaded
 *   REFUSE_TOLD    path: PATH.by gets who was refused first, P: the program
 *                  itself or a solver of its linear systems, L: any other
 *                  library; PATH.end at the end of the process "requests
 *                  leaked", leaked: blocks P never released
 */
#define _GNU_SOURCE
#include "refuse.h"

#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <link.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { SLOTS = 1 << 20, RANGES = 16 };

void *__libc_malloc(size_t);
void *__libc_calloc(size_t, size_t);
void *__libc_realloc(void *, size_t);
void *__libc_memalign(size_t, size_t);
void __libc_free(void *);

static long count, at;
static int always, in_child, own, armed, n_range, lock;
static pid_t main_process;
static const char *told;
static void *blocks[SLOTS]; /* judged blocks: a hash table, (void *)1: freed */
static struct { const char *from, *to; } ranges[RANGES], library;

static int counts_here(void) {
  return armed && (getpid() != main_process) == in_child;
}

static int is_judged(const void *caller) {
  if ((const char *)caller >= library.from && (const char *)caller < library.to)
    return 0;
  for (int i = 0; i < n_range; ++i)
    if ((const char *)caller >= ranges[i].from &&
        (const char *)caller < ranges[i].to)
      return 1;
  return 0;
}

static void write_told(const char *suffix, const char *text) {
  char path[4096];
  if (told == NULL) return;
  snprintf(path, sizeof path, "%s.%s", told, suffix);
  int fd = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (fd < 0 || write(fd, text, strlen(text)) < 0) _exit(98);
  close(fd);
}

static int refused(const void *caller) {
  if (!counts_here() || (own && !is_judged(caller))) return 0;
  long n = __atomic_add_fetch(&count, 1, __ATOMIC_RELAXED);
  if (at == 0 || n < at || (n > at && !always)) return 0;
  if (n == at) write_told("by", is_judged(caller) ? "P\n" : "L\n");
  errno = ENOMEM;
  return 1;
}

static size_t slot_of(const void *p) {
  return ((size_t)p >> 4) * 0x9E3779B97F4A7C15u >> 44;
}

static void take_lock(void) {
  while (__atomic_test_and_set(&lock, __ATOMIC_ACQUIRE)) continue;
}

static void *note(void *p, const void *caller) {
  if (p == NULL || !armed || in_child || !is_judged(caller)) return p;
  take_lock();
  size_t k = slot_of(p);
  while (blocks[k] != NULL && blocks[k] != (void *)1) k = (k + 1) % SLOTS;
  blocks[k] = p;
  __atomic_clear(&lock, __ATOMIC_RELEASE);
  return p;
}

static void forget(const void *p) {
  if (p == NULL || !armed || in_child) return;
  take_lock();
  size_t k = slot_of(p);
  while (blocks[k] != NULL && blocks[k] != p) k = (k + 1) % SLOTS;
  if (blocks[k] == p) blocks[k] = (void *)1;
  __atomic_clear(&lock, __ATOMIC_RELEASE);
}

void *malloc(size_t n) {
  return refused(__builtin_return_address(0))
             ? NULL
             : note(__libc_malloc(n), __builtin_return_address(0));
}

void *calloc(size_t n, size_t size) {
  return refused(__builtin_return_address(0))
             ? NULL
             : note(__libc_calloc(n, size), __builtin_return_address(0));
}

void *realloc(void *p, size_t n) {
  if (refused(__builtin_return_address(0))) return NULL;
  forget(p);
  return note(__libc_realloc(p, n), __builtin_return_address(0));
}

void *memalign(size_t alignment, size_t n) {
  return refused(__builtin_return_address(0))
             ? NULL
             : note(__libc_memalign(alignment, n), __builtin_return_address(0));
}

void *aligned_alloc(size_t alignment, size_t n) {
  return refused(__builtin_return_address(0))
             ? NULL
             : note(__libc_memalign(alignment, n), __builtin_return_address(0));
}

int posix_memalign(void **p, size_t alignment, size_t n) {
  if (refused(__builtin_return_address(0))) return ENOMEM;
  void *block = __libc_memalign(alignment, n);
  if (block == NULL) return ENOMEM;
  *p = note(block, __builtin_return_address(0));
  return 0;
}

void free(void *p) {
  forget(p);
  __libc_free(p);
}

static int add_range(struct dl_phdr_info *info, size_t size, void *ignored) {
  static const char *const judged[] = {"libcholmod", "libsuitesparseconfig",
                                       "libcamd", "liblapacke"};
  (void)size, (void)ignored;
  int mine = info->dlpi_name[0] == '\0' && n_range == 0;
  unsigned long from, to;
  const char *place = mine ? getenv("REFUSE_LIBRARY") : NULL;
  if (place != NULL && sscanf(place, "%lx %lx", &from, &to) == 2) {
    library.from = (const char *)(info->dlpi_addr + from);
    library.to = (const char *)(info->dlpi_addr + to);
  }
  for (size_t i = 0; i < sizeof judged / sizeof *judged; ++i)
    mine |= strstr(info->dlpi_name, judged[i]) != NULL;
  for (int i = 0; mine && i < info->dlpi_phnum && n_range < RANGES; ++i) {
    const ElfW(Phdr) *h = &info->dlpi_phdr[i];
    if (h->p_type != PT_LOAD || (h->p_flags & PF_X) == 0) continue;
    ranges[n_range].from = (const char *)(info->dlpi_addr + h->p_vaddr);
    ranges[n_range].to = ranges[n_range].from + h->p_memsz;
    ++n_range;
  }
  return 0;
}

static long number_of(const char *name) {
  const char *text = getenv(name);
  return text == NULL ? 0 : strtol(text, NULL, 10);
}

static int (*real_main)(int, char **, char **);

static int counted_main(int argc, char **argv, char **env) {
  dl_iterate_phdr(add_range, NULL);
  at = number_of("REFUSE_AT");
  always = number_of("REFUSE_ALWAYS") != 0;
  in_child = number_of("REFUSE_CHILD") != 0;
  own = number_of("REFUSE_OWN") != 0;
  told = getenv("REFUSE_TOLD");
  main_process = getpid();
  armed = 1;
  return real_main(argc, argv, env);
}

/* The C library calls main through this. */
int __libc_start_main(int (*f)(int, char **, char **), int argc, char **argv,
                      void (*init)(void), void (*fini)(void), void (*end)(void),
                      void *stack) {
  int (*start)(int (*)(int, char **, char **), int, char **, void (*)(void),
               void (*)(void), void (*)(void), void *);
  void *found = dlsym(RTLD_NEXT, "__libc_start_main");
  memcpy(&start, &found, sizeof start);
  real_main = f;
  return start(counted_main, argc, argv, init, fini, end, stack);
}

static void tell(void) __attribute__((destructor));
static void tell(void) {
  if (!counts_here() || told == NULL) return;
  long leaked = 0;
  char text[64];
  armed = 0;
  for (size_t k = 0; k < SLOTS; ++k)
    leaked += blocks[k] != NULL && blocks[k] != (void *)1;
  snprintf(text, sizeof text, "%ld %ld\n", count, leaked);
  write_told("end", text);
}
