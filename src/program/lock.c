/* The lock of a job; the file shows the number of the process. */
#include "program/job.h"

#include <errno.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

static const char head[] = "protis process ";

/* The first line, "" for an empty file; 0 if it cannot be read. */
static int read_owner(int fd, char text[64]) {
  ssize_t n = pread(fd, text, 63, 0);
  text[n > 0 ? n : 0] = '\0';
  text[strcspn(text, "\n")] = '\0';
  return n >= 0;
}

/* What is not a lock of Protis stays as it is. */
static status check_content(const char *path, int fd) {
  char text[64];
  struct stat about;
  if (fstat(fd, &about) != 0) PASS(text_failed(path, "inspect", errno));
  int plain = S_ISREG(about.st_mode);
  if (plain && !read_owner(fd, text)) PASS(text_failed(path, "read", errno));
  if (!plain || (text[0] != '\0' && strncmp(text, head, sizeof head - 1) != 0))
    RAISE(
        ERR_FILE,
        "%s is no lock of Protis, and a run would overwrite it: move it away, "
        "or use -o",
        path);
  return OK;
}

/* Is the file at the path the one that was opened? A run that ended between the
 * two has removed it. */
static status check_current(const char *path, int fd, int *current) {
  struct stat one, other;
  *current = 0;
  if (stat(path, &one) != 0) {
    if (errno == ENOENT) return OK;
    PASS(text_failed(path, "inspect", errno));
  }
  if (fstat(fd, &other) != 0) PASS(text_failed(path, "inspect", errno));
  *current = one.st_ino == other.st_ino && one.st_dev == other.st_dev;
  return OK;
}

static status refuse(const char *path, int fd, const char *name) {
  char text[64];
  read_owner(fd, text);
  return status_fail(
      ERR_FILE, __func__, __LINE__,
      "%s is held: job %s is running in this folder (%s). Wait until it has "
      "ended, end it, or give this run another folder with -o. The lock goes "
      "with its process: a file left behind by a kill does not block, it may "
      "be removed",
      path, name, text[0] != '\0' ? text : "process unknown");
}

/* A file system without locks runs without. *held: the file is ours, to be
 * removed in the end. */
static status hold(const char *path, const char *name, int *fd, int *held) {
  const int flags = O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK;
  for (int current = 0; !current;) {
    if (*fd >= 0) close(*fd);
    *fd = open(path, flags | O_EXCL, 0666);
    int made = *fd >= 0;
    if (!made && errno == EEXIST) *fd = open(path, flags, 0666);
    if (*fd < 0) PASS(text_failed(path, "open for writing", errno));
    if (!made) PASS(check_content(path, *fd));
    if (flock(*fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
      PASS(refuse(path, *fd, name));
    *held = 1;
    PASS(check_current(path, *fd, &current));
    *held = current;
  }
  return OK;
}

status job_lock_take(const char *dir, const char *name, job_lock *l) {
  status st = OK;
  int fd = -1, held = 0;
  char *path = text_path(dir, name, "lock");
  if (path == NULL) FAIL(ERR_MEMORY, "memory exhausted: name of the lock");
  if (mkdir(dir, 0777) != 0 && errno != EEXIST)
    FAIL(ERR_FILE, "cannot make the folder %s: %s", dir, strerror(errno));
  TRY(hold(path, name, &fd, &held));
  if (ftruncate(fd, 0) != 0 || dprintf(fd, "%s%ld\n", head, (long)getpid()) < 0)
    TRY(text_failed(path, "write", errno));
  *l = (job_lock){path, fd};
done:
  if (st != OK) {
    if (held) unlink(path);
    if (fd >= 0) close(fd);
    memory_free(path);
  }
  return st;
}

void job_lock_release(job_lock *l) {
  if (l->path == NULL) return;
  unlink(l->path);
  close(l->fd);
  memory_free(l->path);
  *l = (job_lock){0};
}
