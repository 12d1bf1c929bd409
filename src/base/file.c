/* What a file is, before it is opened, replaced or removed. */
#include "base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char *kind_fault(mode_t mode) {
  return S_ISDIR(mode) ? "it is a folder" : "it is no plain file";
}

/* O_NONBLOCK: a FIFO without writer does not wait. */
int file_descriptor(int folder, const char *path, int flags, const char **why) {
  struct stat about;
  int fd = openat(folder, path, flags | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (fd < 0) {
    int is_link = (flags & O_NOFOLLOW) && errno == ELOOP;
    *why = is_link ? "it is a symbolic link" : strerror(errno);
    return -1;
  }
  int known = fstat(fd, &about) == 0;
  if (known && S_ISREG(about.st_mode)) return fd;
  *why = known ? kind_fault(about.st_mode) : strerror(errno);
  close(fd);
  return -1;
}

int file_same(const char *a, const char *b) {
  struct stat one, other;
  if (a == NULL) return 0;
  if (stat(a, &one) != 0 || stat(b, &other) != 0)
    return errno == ENOENT || errno == ENOTDIR || errno == ELOOP ? 0 : -1;
  return one.st_dev == other.st_dev && one.st_ino == other.st_ino;
}

status file_clear(const char *path) {
  struct stat about;
  if (lstat(path, &about) != 0) {
    if (errno == ENOENT) return OK;
    RAISE(ERR_FILE, "%s: cannot be replaced: %s", path, strerror(errno));
  }
  if (!S_ISREG(about.st_mode) && !S_ISLNK(about.st_mode))
    RAISE(ERR_FILE,
          "%s: cannot be replaced: %s; move it away, name the deck otherwise, "
          "or use -o",
          path, kind_fault(about.st_mode));
  if (unlink(path) != 0 && errno != ENOENT)
    RAISE(ERR_FILE, "%s: cannot remove the earlier: %s", path, strerror(errno));
  return OK;
}

void file_sync_folder(const char *path) {
  char folder[4096];
  snprintf(folder, sizeof folder, "%s", path);
  char *slash = strrchr(folder, '/');
  if (slash != NULL) slash[slash == folder ? 1 : 0] = '\0';
  int fd = open(slash != NULL ? folder : ".", O_RDONLY | O_CLOEXEC);
  if (fd < 0) return;
  if (fsync(fd) != 0) errno = 0;
  close(fd);
}
