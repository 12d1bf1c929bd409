/*
 * JOB.h5 while the job runs (see file.h).
 *
 *   /mesh      nodes, elements (ids from 0), node_no, elem_no, groups
 *   /contact   points, faces, ... and one group per field of the contact nodes
 *   /fields    time, total; one group per field of nodes and elements with
 *              one dataset per record (an increment with fields)
 *   /history   one row per increment, one dataset per column
 *   /totals    the same per contact
 *   /deck      the deck with all defaults
 *
 * More increments than estimated (cut steps): a larger file replaces it. At the
 * end unused space is cut the same way.
 */
#include "output/hdf5/file.h"

#include "base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <hdf5.h>
#include <sys/stat.h>
#include <unistd.h>

static double shown(double increments, int frequency) {
  if (frequency < 0) return 0;
  return frequency == 0 ? 1 : ceil(increments / frequency);
}

static int bounded(double n, int most) { return n < most ? (int)n : most; }

/* Rows and records from step first_id on, plus "extra" increments of the step
 * before it. */
static void forecast(const model *m, int first_id, double extra, int *n_row,
                     int *n_record) {
  double rows = extra, records = 0;
  if (first_id > 0)
    records = shown(extra, m->steps[first_id - 1].output.frequency);
  for (int i = first_id; i < m->n.step; ++i) {
    rows += step_increments(&m->steps[i]);
    records +=
        shown(step_increments(&m->steps[i]), m->steps[i].output.frequency);
  }
  *n_row = bounded(rows, MOST_ROWS);
  *n_record = bounded(records, MOST_RECORDS);
}

static status copy(const hdf5_file *h, off_t from, int fd, off_t to,
                   size_t bytes) {
  char chunk[CHUNK * 8];
  while (bytes > 0) {
    errno = 0;
    ssize_t n =
        pread(h->fd, chunk, bytes < sizeof chunk ? bytes : sizeof chunk, from);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) PASS(text_failed(h->path, "read back", errno));
    PASS(hdf5_put(fd, h->aside, chunk, n, to));
    from += n;
    to += n;
    bytes -= n;
  }
  return OK;
}

static status put_nan(int fd, const char *path, off_t offset, int n) {
  double chunk[CHUNK];
  for (int i = 0; i < CHUNK; ++i) chunk[i] = NAN;
  for (int i = 0; i < n; i += CHUNK) {
    int part = n - i < CHUNK ? n - i : CHUNK;
    PASS(hdf5_put(fd, path, chunk, sizeof(double) * part,
                  offset + (off_t)sizeof(double) * i));
  }
  return OK;
}

static int time_field(const hdf5_file *h) {
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
      off_t old = h->now.record[(size_t)k * h->now.n_record + i];
      off_t new = l->record[(size_t)k * l->n_record + i];
      if (old != from + (off_t)bytes || new != to + (off_t)bytes) {
        PASS(copy(h, from, fd, to, bytes));
        from = old;
        to = new;
        bytes = 0;
      }
      bytes += sizeof(double) * hdf5_items(h, f) * f->n_part;
    }
  return copy(h, from, fd, to, bytes);
}

static status copy_results(hdf5_file *h, int fd, const hdf5_layout *l) {
  const size_t rows = sizeof(double) * h->n_row;
  const size_t records = sizeof(double) * h->n_record;
  for (int i = 0; i < h->n_field; ++i)
    if (hdf5_is_history(&h->fields[i]))
      PASS(copy(h, h->now.history[i], fd, l->history[i], rows));
  PASS(copy_records(h, fd, l));
  PASS(copy(h, h->now.record_time, fd, l->record_time, records));
  return copy(h, h->now.record_total, fd, l->record_total, records);
}

static status fill_aside(hdf5_file *h, int fd, const hdf5_layout *l) {
  /* Reserve the space: a full disk is found now and not later. */
  struct stat info;
  if (fstat(fd, &info) != 0) PASS(text_failed(h->aside, "inspect", errno));
  int error_no = posix_fallocate(fd, 0, info.st_size);
  if (error_no != 0) PASS(text_failed(h->aside, "reserve space for", error_no));
  PASS(put_nan(fd, h->aside, l->history[time_field(h)], l->n_row));
  PASS(put_nan(fd, h->aside, l->record_time, l->n_record));
  PASS(put_fixed(h, fd, l));
  if (h->fd >= 0) PASS(copy_results(h, fd, l));
  if (fsync(fd) != 0) PASS(text_failed(h->aside, "write", errno));
  return OK;
}

/* The file with space for rows and records, and with its former contents, under
 * the old name: made as a temporary file, renamed over the first one, so that
 * at any moment JOB.h5 holds every reported increment. */
static status renew(hdf5_file *h, int n_row, int n_record) {
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

/* Space for the rest of the run, and for half as many again as there are, so
 * that copying costs little in total. */
static status grow(hdf5_file *h, const state *s) {
  int rows, records;
  const step *now = &h->m->steps[s->step_no - 1];
  double left = step_increments_left(now, s->t, s->dt, s->increment_no);
  forecast(h->m, s->step_no, left + 1, &rows, &records);
  rows = h->n_row + (int)fmax(rows, 8 + h->n_row / 2);
  if (h->n_record < h->now.n_record)
    records = h->now.n_record;
  else
    records = h->n_record + (int)fmax(records, 4 + h->n_record / 2);
  return renew(h, rows, records);
}

static double ready_value(const column *c, const view *v, int id) {
  const double value = c->value(v, id, c->part);
  return value == 0 ? 0.0 : value;
}

static double part_value(const hdf5_field *f, const view *v, int id, int k) {
  const column *c = f->part[k];
  if (c == NULL) return 0;
  return column_ready(c, v->s) ? ready_value(c, v, id) : NAN;
}

/* The item of a column that stands in place id of its field: a contact node
 * that is not in the surface now (-1) has displacements, but no other
 * value. */
static int item_of(const hdf5_file *h, const hdf5_field *f, int id) {
  if (f->of != PER_CONTACT_NODE) return id;
  return f->part[0]->of == PER_NODE ? h->contact_node[id] : h->surface_id[id];
}

static off_t slot(off_t offset, int i) {
  return offset + (off_t)sizeof(double) * i;
}

/* Values that follow each other in the file, to be written at once. */
typedef struct burst {
  off_t at;
  int n;
  double value[CHUNK];
} burst;

static status put_burst(hdf5_file *h, burst *b) {
  const int n = b->n;
  const off_t at = b->at;
  b->n = 0;
  b->at = slot(at, n);
  return hdf5_put(h->fd, h->path, b->value, sizeof *b->value * n, at);
}

static status put_field(hdf5_file *h, const hdf5_field *f, const view *v,
                        off_t offset, burst *b) {
  const int items = hdf5_items(h, f);
  int ready[6];
  for (int k = 0; k < f->n_part; ++k)
    ready[k] = f->part[k] != NULL && column_ready(f->part[k], v->s);
  if (slot(b->at, b->n) != offset) {
    PASS(put_burst(h, b));
    b->at = offset;
  }
  for (int i = 0; i < items; ++i) {
    const int id = item_of(h, f, i);
    for (int k = 0; k < f->n_part; ++k) {
      if (b->n == CHUNK) PASS(put_burst(h, b));
      double value = f->part[k] == NULL && id >= 0 ? 0 : NAN;
      if (ready[k] && id >= 0) value = ready_value(f->part[k], v, id);
      b->value[b->n++] = value;
    }
  }
  return OK;
}

/* Both lists ascend. */
static void find_surface_ids(hdf5_file *h, const contact_surface *s) {
  int k = 0;
  for (int i = 0; i < h->n_contact_node; ++i) {
    while (s != NULL && k < s->n && s->node_id[k] < h->contact_node[i]) ++k;
    int there = s != NULL && k < s->n && s->node_id[k] == h->contact_node[i];
    h->surface_id[i] = there ? k : -1;
  }
}

static status put_real(hdf5_file *h, double value, off_t offset, int i) {
  return hdf5_put(h->fd, h->path, &value, sizeof value, slot(offset, i));
}

static status put_record(hdf5_file *h, const view *v) {
  burst b = {.n = 0};
  PASS_GROW(h->times, h->n_record, h->cap_time);
  find_surface_ids(h, v->s->contacts.surface);
  for (int i = 0; i < h->n_field; ++i) {
    if (hdf5_is_history(&h->fields[i])) continue;
    size_t k = (size_t)i * h->now.n_record + h->n_record;
    PASS(put_field(h, &h->fields[i], v, h->now.record[k], &b));
  }
  PASS(put_burst(h, &b));
  PASS(put_real(h, v->s->total_no, h->now.record_total, h->n_record));
  PASS(put_real(h, v->s->t, h->now.record_time, h->n_record));
  h->times[h->n_record++] = v->s->t;
  return OK;
}

static status put_row(hdf5_file *h, const view *v) {
  int time_id = time_field(h);
  for (int i = 0; i < h->n_field; ++i) {
    const hdf5_field *f = &h->fields[i];
    if (!hdf5_is_history(f) || i == time_id) continue;
    PASS(put_real(h, part_value(f, v, f->id, 0), h->now.history[i], h->n_row));
  }
  PASS(put_real(h, v->s->t, h->now.history[time_id], h->n_row));
  ++h->n_row;
  return OK;
}

status hdf5_increment(hdf5_file *h, const state *s) {
  if (h == NULL) return OK;
  view v = {h->m, h->msh, s};
  int due = frequency_shows(h->m->steps[s->step_no - 1].output.frequency,
                            s->increment_no, s->end_of_step);
  if (h->n_row == h->now.n_row || (due && h->n_record == h->now.n_record))
    PASS(grow(h, s));
  if (due) PASS(put_record(h, &v));
  return put_row(h, &v);
}

static void release(hdf5_file *h) {
  if (h->fd >= 0) close(h->fd);
  for (int i = 0; i < h->n_fixed; ++i) memory_free(h->fixed[i].own);
  hdf5_layout_free(&h->now);
  RELEASE(h->fields, h->fixed, h->contact_node, h->surface_id, h->times,
          h->path, h->aside, h);
}

/* The file of the continued run is written again beyond "before". */
static status earlier_file(hdf5_file *h, const hdf5_count *before) {
  const char *why;
  h->fd = file_descriptor(AT_FDCWD, h->path, O_RDWR, &why);
  if (h->fd < 0) RAISE(ERR_FILE, "%s: cannot go on with it: %s", h->path, why);
  PASS(hdf5_layout_read(h, &h->now));
  if (h->now.n_row < before->rows || h->now.n_record < before->records)
    RAISE(ERR_FILE, "%s holds less than when the restart file was written",
          h->path);
  h->n_row = before->rows;
  h->n_record = h->cap_time = before->records;
  size_t bytes = h->n_record * sizeof *h->times;
  PASS_NEW(h->times, h->n_record);
  errno = 0;
  if (bytes > 0 &&
      pread(h->fd, h->times, bytes, h->now.record_time) != (ssize_t)bytes)
    PASS(text_failed(h->path, "read back", errno));
  return OK;
}

static status first_file(hdf5_file *h, const hdf5_count *before) {
  int rows, records;
  PASS(hdf5_content(h));
  forecast(h->m, 0, 0, &rows, &records);
  if (before != NULL) {
    PASS(earlier_file(h, before));
    if (rows < before->rows) rows = before->rows;
    if (records < before->records) records = before->records;
  }
  PASS(renew(h, rows, records));
  /* The mesh is kept, the copies for the first file are freed. */
  for (int i = 0; i < h->n_fixed; ++i) {
    FORGET(h->fixed[i].own);
    h->fixed[i].data = NULL;
  }
  return OK;
}

static status open_new(hdf5_file *h, const hdf5_count *before) {
  PASS_GET(h->path, text_path(h->o->dir, h->m->name.job, "h5"));
  PASS_GET(h->aside, text_path("", h->path, "tmp"));
  return first_file(h, before);
}

status hdf5_open(const model *m, const mesh *msh, const output_options *o,
                 const hdf5_count *before, hdf5_file **out) {
  hdf5_file *h = NULL;
  *out = NULL;
  if (!model_writes_fields(m)) return OK;
  H5dont_atexit(); /* the exit handler crashes after a failed write */
  PASS_NEW(h, 1);
  *h = (hdf5_file){.m = m, .msh = msh, .o = o, .fd = -1};
  status st = open_new(h, before);
  if (st != OK)
    release(h);
  else
    *out = h;
  return st;
}

status hdf5_sync(hdf5_file *h, hdf5_count *n) {
  *n = (hdf5_count){0, 0};
  if (h == NULL) return OK;
  *n = (hdf5_count){h->n_row, h->n_record};
  if (fsync(h->fd) != 0) PASS(text_failed(h->path, "write", errno));
  return OK;
}

int hdf5_records(const hdf5_file *h) { return h->n_record; }

static status end_file(hdf5_file *h, int finished) {
  int spare = h->n_row < h->now.n_row || h->n_record < h->now.n_record;
  if (finished && spare && h->n_row > 0 &&
      renew(h, h->n_row, h->n_record) != OK)
    status_clear(); /* no space for the copy: the file is unchanged */
  if (fsync(h->fd) != 0) return text_failed(h->path, "write", errno);
  const int fd = h->fd;
  h->fd = -1;
  return close(fd) != 0 ? text_failed(h->path, "close", errno) : OK;
}

status hdf5_close(hdf5_file *h, int finished) {
  if (h == NULL) return OK;
  status st = end_file(h, finished);
  release(h);
  return st;
}
