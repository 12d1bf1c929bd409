/*
 * Files: what one is, before it is opened, replaced or removed; text files
 * opened, written line by line, and checked.
 */
#include "base/file.h"

#include "base/memory.h"
#include "base/text.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdlib.h>
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
  if (stat(b, &other) != 0 || stat(a, &one) != 0)
    return errno == ENOENT || errno == ENOTDIR || errno == ELOOP ? 0 : -1;
  return one.st_dev == other.st_dev && one.st_ino == other.st_ino;
}

status file_may_go(const char *path) {
  struct stat about;
  const char *slash = strrchr(path, '/');
  if (strlen(slash == NULL ? path : slash + 1) > NAME_MAX)
    RAISE(ERR_FILE, "%s: its name is too long; name the deck otherwise", path);
  if (lstat(path, &about) != 0) {
    if (errno == ENOENT || errno == ENOTDIR) return OK;
    RAISE(ERR_FILE, "%s: cannot be replaced: %s", path, strerror(errno));
  }
  const int is_link = S_ISLNK(about.st_mode);
  if (is_link || (S_ISREG(about.st_mode) && (about.st_mode & 0222) != 0))
    return OK;
  RAISE(ERR_FILE,
        "%s: cannot be replaced: %s; move it away, name the deck otherwise, "
        "or use -o",
        path,
        S_ISREG(about.st_mode) ? "it is write-protected"
                               : kind_fault(about.st_mode));
}

status file_clear(const char *path) {
  PASS(file_may_go(path));
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

char *text_path(const char *dir, const char *name, const char *suffix) {
  const char *slash = "";
  if (dir == NULL) dir = "";
  if (dir[0] != '\0' && dir[strlen(dir) - 1] != '/') slash = "/";
  size_t size = strlen(dir) + strlen(name) + strlen(suffix) + 3;
  char *path = memory_new(size, 1);
  if (path != NULL) snprintf(path, size, "%s%s%s.%s", dir, slash, name, suffix);
  return path;
}

enum { BUFFER = 1 << 16 };

status text_failed(const char *path, const char *doing, int error_no) {
  status st = error_no == ENOMEM ? ERR_MEMORY : ERR_FILE;
  return status_fail(st, __func__, __LINE__, "%s: cannot %s: %s", path, doing,
                     error_no != 0 ? strerror(error_no) : "unknown reason");
}

status text_flush_output(void) {
  errno = 0;
  if (fflush(stdout) == 0 && !ferror(stdout)) return OK;
  if (errno != EPIPE) PASS(text_failed("standard output", "write", errno));
  clearerr(stdout); /* the next call does not know why */
  return OK;
}

static status take(text_file *t, const char *path, FILE *f, int by_line) {
  t->f = f;
  PASS_GET(t->path, memory_text(path));
  setvbuf(f, NULL, by_line ? _IOLBF : _IOFBF, BUFFER);
  return OK;
}

status text_open(text_file *t, const char *path, int by_line) {
  PASS(file_clear(path));
  errno = 0;
  FILE *f = fopen(path, "wx");
  if (f == NULL) PASS(text_failed(path, "open for writing", errno));
  return take(t, path, f, by_line);
}

status text_reopen(text_file *t, const char *path, int by_line, long length) {
  const char *why = NULL;
  FILE *f = NULL;
  int fd = file_descriptor(AT_FDCWD, path, O_RDWR | O_NOFOLLOW, &why);
  if (fd >= 0 && (f = fdopen(fd, "r+")) == NULL) {
    why = strerror(errno);
    close(fd);
  }
  if (f == NULL)
    RAISE(ERR_FILE, "%s: cannot open to go on with it: %s", path, why);
  PASS(take(t, path, f, by_line));
  long size = fseek(t->f, 0, SEEK_END) == 0 ? ftell(t->f) : -1;
  if (size < 0) PASS(text_failed(path, "read", errno));
  if (size < length)
    RAISE(ERR_FILE, "%s is shorter than when the restart file was written",
          path);
  if (ftruncate(fileno(t->f), length) != 0 ||
      fseek(t->f, length, SEEK_SET) != 0)
    PASS(text_failed(path, "cut", errno));
  return OK;
}

/* A write that failed inside fprintf has left no error number: repeat it. */
static int reason_again(FILE *f) {
  errno = 0;
  return write(fileno(f), "\n", 1) < 0 ? errno : 0;
}

status text_check(text_file *t) {
  if (t->f == NULL) return OK;
  int bad = ferror(t->f), error_no = 0;
  errno = 0;
  if (fflush(t->f) != 0) {
    bad = 1;
    error_no = errno;
  }
  if (!bad) return OK;
  if (error_no == 0) error_no = reason_again(t->f);
  return text_failed(t->path, "write", error_no);
}

status text_sync(text_file *t, long *length) {
  PASS(text_check(t));
  *length = t->f == NULL ? -1 : ftell(t->f);
  if (t->f != NULL && (*length < 0 || fsync(fileno(t->f)) != 0))
    PASS(text_failed(t->path, "write", errno));
  return OK;
}

status text_close(text_file *t) {
  status st = OK;
  if (t->f != NULL) {
    st = text_check(t);
    errno = 0;
    if (fclose(t->f) != 0 && st == OK)
      st = text_failed(t->path, "close", errno);
    t->f = NULL;
  }
  FORGET(t->path);
  return st;
}

status text_replace(const char *path, const void *what,
                    void (*write)(FILE *f, const void *what)) {
  status st = OK;
  text_file file = {0};
  char *aside = text_path("", path, "tmp");
  if (aside == NULL) FAIL(ERR_MEMORY, "memory exhausted: name of %s", path);
  TRY(text_open(&file, aside, 0));
  write(file.f, what);
  TRY(text_close(&file));
  if (rename(aside, path) != 0) TRY(text_failed(path, "replace", errno));
done:
  if (st != OK) {
    text_close(&file);
    if (aside != NULL) unlink(aside);
  }
  memory_free(aside);
  return st;
}

void file_leave(FILE **f) {
  if (*f != NULL) fclose(*f);
}

void descriptor_leave(const int *fd) {
  if (*fd >= 0) close(*fd);
}

/* Closing it does not say whether it could not grow before or now. */
int text_memory_end(FILE *f, char **text) {
  int whole = ferror(f) == 0;
  return fclose(f) == 0 && whole && *text != NULL;
}

status text_made(char **text, const void *what,
                 status (*write)(FILE *f, const void *what)) {
  char *held = NULL;
  size_t size = 0;
  FILE *f = open_memstream(&held, &size);
  status st = f == NULL ? ERR_MEMORY : write(f, what);
  int whole = f != NULL && text_memory_end(f, &held);
  if (whole && st == OK) *text = memory_text(held);
  free(held);
  if (!whole || (st == OK && *text == NULL))
    RAISE(ERR_MEMORY, "memory exhausted: a text");
  return st;
}

/* printf gives two digits of the exponent below 100. */
