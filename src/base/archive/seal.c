/*
 * The seal of an archive, text before the bytes of HDF5:
 *   Protis restart, layout 3
 *   BYTES CHECKSUM       of what follows the seal: their number; FNV-1a, 64
 * bits
 */
#include "base/archive/file.h"

#include "base/file.h"
#include "base/text.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { PART = 1 << 16 };

static const char mark[] = "Protis restart, layout ";
static const char layout[] = "3\n";

typedef struct content {
  uint64_t bytes, checksum;
} content;

/* What follows the seal; ERR_FILE if it cannot be read. */
static status sum_up(int fd, const char *path, content *c) {
  unsigned char part[PART];
  ssize_t n;
  *c = (content){0, 14695981039346656037u};
  while ((n = pread(fd, part, PART, (off_t)(ARCHIVE_SEAL + c->bytes))) > 0) {
    for (ssize_t i = 0; i < n; ++i)
      c->checksum = (c->checksum ^ part[i]) * 1099511628211u;
    c->bytes += (uint64_t)n;
  }
  if (n < 0) PASS(text_failed(path, "read", errno));
  return OK;
}

static void write_text(const content *c, char text[ARCHIVE_SEAL]) {
  memset(text, 0, ARCHIVE_SEAL);
  snprintf(text, ARCHIVE_SEAL, "%s%s%" PRIu64 " %016" PRIx64 "\n", mark, layout,
           c->bytes, c->checksum);
}

static status write_whole(int fd, const char *path, const char *text) {
  size_t at = 0;
  while (at < ARCHIVE_SEAL) {
    ssize_t n = pwrite(fd, text + at, ARCHIVE_SEAL - at, (off_t)at);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) PASS(text_failed(path, "write", errno));
    at += (size_t)n;
  }
  return OK;
}

status archive_seal(const char *path) {
  status st = OK;
  content c;
  char text[ARCHIVE_SEAL];
  int fd = open(path, O_RDWR | O_CLOEXEC);
  if (fd < 0) TRY(text_failed(path, "open", errno));
  TRY(sum_up(fd, path, &c));
  write_text(&c, text);
  TRY(write_whole(fd, path, text));
  if (fsync(fd) != 0) TRY(text_failed(path, "write", errno));
done:
  if (fd >= 0) close(fd);
  return st;
}

static status refuse(const char *path, const char *why) {
  return status_fail(ERR_FILE, __func__, __LINE__, "%s: %s", path, why);
}

status archive_check_seal(const char *path) {
  status st = OK;
  content c;
  char text[ARCHIVE_SEAL], wanted[ARCHIVE_SEAL];
  const char *why;
  int fd = file_descriptor(AT_FDCWD, path, O_RDONLY, &why);
  if (fd < 0) FAIL(ERR_FILE, "%s: cannot read: %s", path, why);
  memset(text, 0, sizeof text);
  if (pread(fd, text, sizeof text, 0) < 0)
    TRY(text_failed(path, "read", errno));
  if (strncmp(text, mark, strlen(mark)) != 0)
    TRY(refuse(path, "this is no restart file of Protis"));
  if (strncmp(text + strlen(mark), layout, strlen(layout)) != 0)
    TRY(refuse(path,
               "the restart file has the layout of another version of Protis; "
               "go on with that one, or start the run without --restart"));
  TRY(sum_up(fd, path, &c));
  write_text(&c, wanted);
  if (memcmp(text, wanted, sizeof text) != 0)
    TRY(refuse(path, "the restart file is damaged: wrong checksum"));
done:
  if (fd >= 0) close(fd);
  return st;
}
