/*
 * Loaded before the program (LD_PRELOAD): a file system without locks. Every
 * lock of a file fails with the error number in NOLOCKS; its first use is
 * told by the file NOLOCKS_SEEN.
 */
#define _GNU_SOURCE
#include "nolocks.h"

#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

static int refused(void) {
  const char *number = getenv("NOLOCKS"), *seen = getenv("NOLOCKS_SEEN");
  if (seen != NULL) close(open(seen, O_WRONLY | O_CREAT, 0666));
  errno = number == NULL ? ENOLCK : atoi(number);
  return -1;
}

int flock(int fd, int how) {
  (void)fd, (void)how;
  return refused();
}

int lockf(int fd, int how, off_t bytes) {
  (void)fd, (void)how, (void)bytes;
  return refused();
}

int fcntl(int fd, int command, ...) {
  static int (*next)(int, int, ...);
  void *found = next == NULL ? dlsym(RTLD_NEXT, "fcntl") : NULL;
  va_list args;
  va_start(args, command);
  long value = va_arg(args, long);
  va_end(args);
  if (found != NULL) memcpy(&next, &found, sizeof next);
  if (command == F_SETLK || command == F_SETLKW || command == F_OFD_SETLK ||
      command == F_OFD_SETLKW)
    return refused();
  return next(fd, command, value);
}
