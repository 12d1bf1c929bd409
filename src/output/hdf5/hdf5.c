/*
 * JOB.h5, open and closed (see file.h).
 *
 *   /mesh      nodes, elements (ids from 0), node_no, elem_no, groups
 *   /contact   points, faces, ... and one group per field of the contact nodes
 *   /fields    time, total; one group per field of nodes and elements with
 *              one dataset per record (an increment whose fields were
 * requested) /history   one row per increment, one dataset per column /totals
 * the same per contact /deck      the deck with all defaults
 *
 * More increments than estimated (cut steps): a larger file replaces it. At the
 * end unused space is cut the same way.
 */
#include "output/hdf5/file.h"

#include "base/file.h"
#include "base/memory.h"

#include <errno.h>
#include <fcntl.h>
#include <hdf5.h>
#include <math.h>
#include <stdio.h>
#include <unistd.h>

static double shown(double increments, int frequency) {
  if (frequency < 0) return 0;
  return frequency == 0 ? 1 : ceil(increments / frequency);
}

static int bounded(double n, int most) { return n < most ? (int)n : most; }

void hdf5_forecast(const model *m, int first_id, double extra, int *n_row,
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

static void release(hdf5_file *h) {
  if (h->fd >= 0) close(h->fd);
  for (int i = 0; i < h->n_fixed; ++i) memory_free(h->fixed[i].own);
  hdf5_layout_free(&h->now);
  RELEASE(h->fields, h->fixed, h->contact_node, h->surface_id, h->times,
          h->path, h->aside, h);
}

/* The mesh is kept, the copies for the first file are freed. */
static void drop_copies(hdf5_file *h) {
  for (int i = 0; i < h->n_fixed; ++i) {
    memory_free(h->fixed[i].own);
    h->fixed[i].own = NULL;
    h->fixed[i].data = NULL;
  }
}

/* The file of the continued run: its contents beyond "before" are written
 * again. */
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
  size_t bytes = (size_t)h->n_record * sizeof *h->times;
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
  hdf5_forecast(h->m, 0, 0, &rows, &records);
  if (before != NULL) {
    PASS(earlier_file(h, before));
    if (rows < before->rows) rows = before->rows;
    if (records < before->records) records = before->records;
  }
  PASS(hdf5_renew(h, rows, records));
  drop_copies(h);
  return OK;
}

static int fields_asked(const model *m) {
  for (int i = 0; i < m->n.step; ++i)
    if (m->steps[i].output.frequency >= 0) return 1;
  return 0;
}

status hdf5_open(const model *m, const mesh *msh, const output_options *o,
                 const hdf5_count *before, hdf5_file **out) {
  status st = OK;
  hdf5_file *h = NULL;
  *out = NULL;
  if (!fields_asked(m)) return OK;
  H5dont_atexit(); /* the exit handler crashes after a failed write */
  NEW(h, 1);
  h->fd = -1;
  h->m = m;
  h->msh = msh;
  h->o = o;
  h->path = text_path(o->dir, m->name.job, "h5");
  if (h->path != NULL) h->aside = text_path("", h->path, "tmp");
  if (h->aside == NULL) FAIL(ERR_MEMORY, "memory exhausted: name of JOB.h5");
  TRY(first_file(h, before));
  *out = h;
done:
  if (st != OK && h != NULL) release(h);
  return st;
}

status hdf5_sync(hdf5_file *h, hdf5_count *n) {
  *n = (hdf5_count){0, 0};
  if (h == NULL) return OK;
  *n = (hdf5_count){h->n_row, h->n_record};
  if (fsync(h->fd) != 0) PASS(text_failed(h->path, "write", errno));
  return OK;
}

void hdf5_shape_of(const hdf5_file *h, hdf5_shape *shape) {
  *shape = (hdf5_shape){.path = h->path,
                        .n_node = h->msh->n_node,
                        .n_elem = h->msh->n_elem,
                        .corners = h->msh->dim + 1,
                        .n_contact_node = h->n_contact_node,
                        .n_contact_face = h->n_contact_face,
                        .face_corners = h->msh->dim,
                        .n_field = h->n_field,
                        .n_record = h->n_record,
                        .fields = h->fields,
                        .times = h->times};
}

status hdf5_close(hdf5_file *h, int finished) {
  status st = OK;
  int spare;
  if (h == NULL) return OK;
  spare = h->n_row < h->now.n_row || h->n_record < h->now.n_record;
  if (finished && spare && h->n_row > 0 &&
      hdf5_renew(h, h->n_row, h->n_record) != OK)
    status_clear(); /* no space for the copy: the file is unchanged */
  if (fsync(h->fd) != 0) TRY(text_failed(h->path, "write", errno));
  if (close(h->fd) != 0) {
    h->fd = -1;
    TRY(text_failed(h->path, "close", errno));
  }
  h->fd = -1;
done:
  release(h);
  return st;
}
