/* Files that are read. */
#define _GNU_SOURCE /* O_PATH */
#include "base/system/input.h"

#include "base/base.h"
#include "base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <unistd.h>

enum { DEEPEST = 64 }; /* folders below the one of the deck */

static int confined; /* descriptor of that folder + 1; 0: no limit */
static char *folder; /* its name with a slash, "" for "."; owned */

static const int FOLDER = O_PATH | O_DIRECTORY | O_CLOEXEC;

static const char *const outside = "it is not below the folder of the deck";

/* The names between the slashes of a path, "." and ".." resolved; *path is cut.
 * Their number, or -1 if the path leads out. */
static int split(char *path, const char *part[DEEPEST]) {
  int n = 0;
  char *rest = NULL;
  for (char *p = strtok_r(path, "/", &rest); p != NULL;
       p = strtok_r(NULL, "/", &rest)) {
    if (strcmp(p, ".") == 0) continue;
    if (strcmp(p, "..") == 0)
      --n;
    else if (n < DEEPEST)
      part[n++] = p;
    else
      n = -1;
    if (n < 0) break;
  }
  return n;
}

/* From folder to folder, none of them a link. */
static int open_below(char *path, const char **why) {
  const char *part[DEEPEST];
  int n = split(path, part), at = confined - 1;
  *why = outside;
  if (n < 1) return -1;
  for (int i = 0; i < n - 1 && at >= 0; ++i) {
    int next = openat(at, part[i], FOLDER | O_NOFOLLOW);
    if (next < 0)
      *why = errno == ENOTDIR ? "a part of its path is no folder, or a link"
                              : strerror(errno);
    if (at != confined - 1) close(at);
    at = next;
  }
  if (at < 0) return -1;
  int fd = file_descriptor(at, part[n - 1], O_RDONLY | O_NOFOLLOW, why);
  if (at != confined - 1) close(at);
  return fd;
}

int input_open(const char *path, const char **why) {
  if (!confined) return file_descriptor(AT_FDCWD, path, O_RDONLY, why);
  size_t skip = strlen(folder);
  *why = outside;
  if (strncmp(path, folder, skip) != 0) return -1;
  if (skip == 0 && path[0] == '/') return -1;
  *why = "memory exhausted";
  char *rest = memory_text(path + skip);
  if (rest == NULL) return -1;
  int fd = open_below(rest, why);
  memory_free(rest);
  return fd;
}

FILE *input_stream(const char *path, const char **why) {
  int fd = input_open(path, why);
  if (fd < 0) return NULL;
  FILE *f = fdopen(fd, "rb");
  if (f != NULL) return f;
  *why = strerror(errno);
  close(fd);
  return NULL;
}

status input_confine(const char *name) {
  if (confined) close(confined - 1);
  confined = 0;
  FORGET(folder);
  if (name == NULL) return OK;
  int here = strcmp(name, ".") == 0;
  size_t n = strlen(name), slash = n > 0 && name[n - 1] == '/' ? 0 : 1;
  PASS_NEW(folder, n + 2);
  if (!here) {
    memcpy(folder, name, n);
    memcpy(folder + n, "/", slash);
  }
  int fd = open(name, FOLDER);
  if (fd < 0) PASS(text_failed(name, "open", errno));
  confined = fd + 1;
  return OK;
}

int input_is_confined(void) { return confined > 0; }
