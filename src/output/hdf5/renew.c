/*
 * A new JOB.h5 under the old name, of another size: made as a temporary file,
 * the data copied, renamed over the first one, so that at any moment JOB.h5
 * holds every reported increment.
 */
#include "output/hdf5/file.h"

#include "base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static status copy(const hdf5_file *h, off_t from, int fd, off_t to,
                   size_t bytes) {
  char chunk[CHUNK * 8];
  while (bytes > 0) {
    errno = 0;
    ssize_t n =
        pread(h->fd, chunk, bytes < sizeof chunk ? bytes : sizeof chunk, from);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) PASS(text_failed(h->path, "read back", errno));
    PASS(hdf5_put(fd, h->aside, chunk, (size_t)n, to));
    from += n;
    to += n;
    bytes -= (size_t)n;
  }
  return OK;
}

static status put_nan(int fd, const char *path, off_t offset, int n) {
  double chunk[CHUNK];
  for (int i = 0; i < CHUNK; ++i) chunk[i] = NAN;
  for (int i = 0; i < n; i += CHUNK) {
    int part = n - i < CHUNK ? n - i : CHUNK;
    PASS(hdf5_put(fd, path, chunk, sizeof(double) * (size_t)part,
                  offset + (off_t)sizeof(double) * i));
  }
  return OK;
}

int hdf5_time_field(const hdf5_file *h) {
  int i = 0;
  while (strcmp(h->fields[i].group, "/history") != 0 ||
         strcmp(h->fields[i].name, "time") != 0)
    ++i;
  return i;
}

static status put_fixed(hdf5_file *h, int fd, const hdf5_layout *l) {
  for (int i = 0; i < h->n_fixed; ++i) {
    const fixed_data *d = &h->fixed[i];
    if (d->rows == 0) continue;
    if (d->data != NULL)
      PASS(hdf5_put(fd, h->aside, d->data, fixed_bytes(d), l->fixed[i]));
    else
      PASS(copy(h, h->now.fixed[i], fd, l->fixed[i], fixed_bytes(d)));
  }
  return OK;
}

/* Those that follow each other in both files at once. */
static status copy_records(hdf5_file *h, int fd, const hdf5_layout *l) {
  off_t from = 0, to = 0;
  size_t bytes = 0;
  for (int i = 0; i < h->n_record; ++i)
    for (int k = 0; k < h->n_field; ++k) {
      const hdf5_field *f = &h->fields[k];
      if (hdf5_is_history(f)) continue;
      off_t old =
          h->now.record[(size_t)k * (size_t)h->now.n_record + (size_t)i];
      off_t new = l->record[(size_t)k * (size_t)l->n_record + (size_t)i];
      if (old != from + (off_t)bytes || new != to + (off_t)bytes) {
        PASS(copy(h, from, fd, to, bytes));
        from = old;
        to = new;
        bytes = 0;
      }
      bytes += sizeof(double) * (size_t)hdf5_items(h, f) * (size_t)f->n_part;
    }
  return copy(h, from, fd, to, bytes);
}

static status copy_results(hdf5_file *h, int fd, const hdf5_layout *l) {
  const size_t rows = sizeof(double) * (size_t)h->n_row;
  const size_t records = sizeof(double) * (size_t)h->n_record;
  for (int i = 0; i < h->n_field; ++i)
    if (hdf5_is_history(&h->fields[i]))
      PASS(copy(h, h->now.history[i], fd, l->history[i], rows));
  PASS(copy_records(h, fd, l));
  PASS(copy(h, h->now.record_time, fd, l->record_time, records));
  return copy(h, h->now.record_total, fd, l->record_total, records);
}

/* Reserve the space: a full disk is found now and not later. */
static status reserve(const hdf5_file *h, int fd) {
  struct stat info;
  if (fstat(fd, &info) != 0) PASS(text_failed(h->aside, "inspect", errno));
  int error_no = posix_fallocate(fd, 0, info.st_size);
  if (error_no != 0) PASS(text_failed(h->aside, "reserve space for", error_no));
  return OK;
}

static status fill_aside(hdf5_file *h, int fd, const hdf5_layout *l) {
  PASS(reserve(h, fd));
  PASS(put_nan(fd, h->aside, l->history[hdf5_time_field(h)], l->n_row));
  PASS(put_nan(fd, h->aside, l->record_time, l->n_record));
  PASS(put_fixed(h, fd, l));
  if (h->fd >= 0) PASS(copy_results(h, fd, l));
  if (fsync(fd) != 0) PASS(text_failed(h->aside, "write", errno));
  return OK;
}

status hdf5_renew(hdf5_file *h, int n_row, int n_record) {
  status st = OK;
  hdf5_layout l = {0};
  int fd = -1;
  TRY(hdf5_layout_make(h, n_row, n_record, &l));
  fd = open(h->aside, O_RDWR | O_CLOEXEC);
  if (fd < 0) TRY(text_failed(h->aside, "open", errno));
  TRY(fill_aside(h, fd, &l));
  if (rename(h->aside, h->path) != 0)
    TRY(text_failed(h->path, "replace", errno));
  file_sync_folder(h->path);
  if (h->fd >= 0) close(h->fd);
  hdf5_layout_free(&h->now);
  h->fd = fd;
  h->now = l;
done:
  if (st != OK) {
    if (fd >= 0) close(fd);
    hdf5_layout_free(&l);
    unlink(h->aside);
  }
  return st;
}
