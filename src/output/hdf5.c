/*
 * JOB.h5: what stands in it, and writing while the job runs (see hdf5.h).
 *
 *   /mesh      nodes, elements (ids from 0), node_no, elem_no, groups
 *   /contact   points, faces, ... and one group per field of the contact nodes
 *   /fields    time, total; one group per field of nodes and elements with
 *              one dataset per record (an increment whose fields were asked)
 *   /history   one row per increment, one dataset per column
 *   /totals    the same per contact
 *   /deck      the deck with all defaults
 *
 * More increments than foreseen (cut steps): a larger file is made aside, the
 * data copied, and renamed over the first one, so that at any moment JOB.h5
 * holds every increment told. At the end unused room is cut the same way.
 */
#include "output/hdf5.h"

#include "base/memory.h"
#include "base/timer.h"

#include <errno.h>
#include <fcntl.h>
#include <hdf5.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { CHUNK = 4096, MOST_RECORDS = 99999, MOST_ROWS = 10000000 };

int hdf5_is_history(const hdf5_field *f) {
  return f->of == PER_INCREMENT || f->of == PER_CONTACT;
}

int hdf5_items(const hdf5_file *h, const hdf5_field *f) {
  switch (f->of) {
    case PER_NODE:
      return h->msh->n_node;
    case PER_ELEMENT:
      return h->msh->n_elem;
    case PER_CONTACT_NODE:
      return h->n_contact_node;
    default:
      return 1;
  }
}

void hdf5_record_name(char *text, size_t size, int i) {
  snprintf(text, size, "%05d", i + 1);
}

size_t fixed_bytes(const fixed_data *d) {
  static const size_t size[] = {sizeof(double), sizeof(int), sizeof(size_t), 1};
  return size[d->type] * (size_t)d->rows * (size_t)d->columns;
}

/* ---- raw access, each call checked ------------------------------------ */

static status put(int fd, const char *path, const void *data, size_t bytes,
                  off_t offset) {
  const char *at = data;
  while (bytes > 0) {
    errno = 0;
    ssize_t n = pwrite(fd, at, bytes, offset);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return text_failed(path, "write", n < 0 ? errno : ENOSPC);
    at += n;
    offset += n;
    bytes -= (size_t)n;
  }
  return OK;
}

static status copy(const hdf5_file *h, off_t from, int fd, off_t to,
                   size_t bytes) {
  status st = OK;
  char chunk[CHUNK * 8];
  while (bytes > 0) {
    errno = 0;
    ssize_t n =
        pread(h->fd, chunk, bytes < sizeof chunk ? bytes : sizeof chunk, from);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) TRY(text_failed(h->path, "read back", errno));
    TRY(put(fd, h->aside, chunk, (size_t)n, to));
    from += n;
    to += n;
    bytes -= (size_t)n;
  }
done:
  return st;
}

static status put_nan(int fd, const char *path, off_t offset, int n) {
  status st = OK;
  double chunk[CHUNK];
  for (int i = 0; i < CHUNK; ++i) chunk[i] = NAN;
  for (int i = 0; i < n; i += CHUNK) {
    int part = n - i < CHUNK ? n - i : CHUNK;
    TRY(put(fd, path, chunk, sizeof(double) * (size_t)part,
            offset + (off_t)sizeof(double) * i));
  }
done:
  return st;
}

/* ---- a new file under the old name ------------------------------------ */

static int time_field(const hdf5_file *h) {
  int i = 0;
  while (strcmp(h->fields[i].group, "/history") != 0 ||
         strcmp(h->fields[i].name, "time") != 0)
    ++i;
  return i;
}

static status put_fixed(hdf5_file *h, int fd, const hdf5_layout *l) {
  status st = OK;
  for (int i = 0; i < h->n_fixed; ++i) {
    const fixed_data *d = &h->fixed[i];
    if (d->rows == 0) continue;
    if (d->data != NULL)
      TRY(put(fd, h->aside, d->data, fixed_bytes(d), l->fixed[i]));
    else
      TRY(copy(h, h->now.fixed[i], fd, l->fixed[i], fixed_bytes(d)));
  }
done:
  return st;
}

static status copy_records(hdf5_file *h, int field_id, int fd,
                           const hdf5_layout *l) {
  status st = OK;
  const hdf5_field *f = &h->fields[field_id];
  size_t bytes = sizeof(double) * (size_t)hdf5_items(h, f) * (size_t)f->n_part;
  for (int i = 0; i < h->n_record; ++i) {
    size_t from = (size_t)field_id * (size_t)h->now.n_record + (size_t)i;
    size_t to = (size_t)field_id * (size_t)l->n_record + (size_t)i;
    TRY(copy(h, h->now.record[from], fd, l->record[to], bytes));
  }
done:
  return st;
}

static status copy_results(hdf5_file *h, int fd, const hdf5_layout *l) {
  status st = OK;
  const size_t rows = sizeof(double) * (size_t)h->n_row;
  const size_t records = sizeof(double) * (size_t)h->n_record;
  for (int i = 0; i < h->n_field; ++i)
    if (hdf5_is_history(&h->fields[i]))
      TRY(copy(h, h->now.history[i], fd, l->history[i], rows));
    else
      TRY(copy_records(h, i, fd, l));
  TRY(copy(h, h->now.record_time, fd, l->record_time, records));
  TRY(copy(h, h->now.record_total, fd, l->record_total, records));
done:
  return st;
}

/* Reserve the space: a full disk is found now and not later. */
static status reserve(const hdf5_file *h, int fd) {
  status st = OK;
  struct stat info;
  if (fstat(fd, &info) != 0) TRY(text_failed(h->aside, "inspect", errno));
  int error_no = posix_fallocate(fd, 0, info.st_size);
  if (error_no != 0) TRY(text_failed(h->aside, "reserve space for", error_no));
done:
  return st;
}

/* The new name must survive a power failure as well; best effort. */
static void sync_folder(const char *path) {
  char folder[4096];
  snprintf(folder, sizeof folder, "%s", path);
  char *slash = strrchr(folder, '/');
  if (slash != NULL) slash[slash == folder ? 1 : 0] = '\0';
  int fd = open(slash != NULL ? folder : ".", O_RDONLY | O_CLOEXEC);
  if (fd < 0) return;
  if (fsync(fd) != 0) errno = 0;
  close(fd);
}

static status fill_aside(hdf5_file *h, int fd, const hdf5_layout *l) {
  status st = OK;
  TRY(reserve(h, fd));
  TRY(put_nan(fd, h->aside, l->history[time_field(h)], l->n_row));
  TRY(put_nan(fd, h->aside, l->record_time, l->n_record));
  TRY(put_fixed(h, fd, l));
  if (h->fd >= 0) TRY(copy_results(h, fd, l));
  if (fsync(fd) != 0) TRY(text_failed(h->aside, "write", errno));
done:
  return st;
}

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
  sync_folder(h->path);
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

/* ---- how many increments are foreseen --------------------------------- */

static double step_increments(const step *s) {
  if (s->kind == STEP_STATIC || !(s->dt > 0)) return 1;
  return fmax(1, ceil(s->total / s->dt * (1 - 1e-9)));
}

static double shown(double increments, int frequency) {
  if (frequency < 0) return 0;
  return frequency == 0 ? 1 : ceil(increments / frequency);
}

static int bounded(double n, int most) { return n < most ? (int)n : most; }

/* From step first_id on, plus "extra" increments of the step before it. */
static void forecast(const model *m, int first_id, double extra, int *n_row,
                     int *n_record) {
  double rows = extra, records = 0;
  if (first_id > 0)
    records = shown(extra, m->steps[first_id - 1].output_frequency);
  for (int i = first_id; i < m->n_step; ++i) {
    rows += step_increments(&m->steps[i]);
    records +=
        shown(step_increments(&m->steps[i]), m->steps[i].output_frequency);
  }
  *n_row = bounded(rows, MOST_ROWS);
  *n_record = bounded(records, MOST_RECORDS);
}

/* Room for what the rest of the run will need, and for half as many again as
 * there are, so that copying costs little on the whole. */
static status grow(hdf5_file *h, const state *s) {
  int rows, records;
  const step *now = &h->m->steps[s->step_no - 1];
  double left = (now->start + now->total - s->t) / fmax(s->dt, 1e-300);
  forecast(h->m, s->step_no, fmax(0, ceil(left * (1 - 1e-9))) + 1, &rows,
           &records);
  rows = h->n_row + (int)fmax(rows, 8 + h->n_row / 2);
  if (h->n_record < h->now.n_record)
    records = h->now.n_record;
  else
    records = h->n_record + (int)fmax(records, 4 + h->n_record / 2);
  return renew(h, rows, records);
}

/* ---- increments ------------------------------------------------------- */

static double part_value(const hdf5_field *f, const view *v, int id, int k) {
  const column *c = f->part[k];
  if (c == NULL) return 0;
  if (!column_ready(c, v->s)) return NAN;
  double value = c->value(v, id, c->part);
  return value == 0 ? 0.0 : value;
}

/* A contact node that is not in the surface now has no value. */
static double item_value(const hdf5_file *h, const hdf5_field *f, const view *v,
                         int id, int k) {
  if (f->of == PER_CONTACT_NODE) id = h->surface_id[id];
  return id < 0 ? NAN : part_value(f, v, id, k);
}

static status put_field(hdf5_file *h, const hdf5_field *f, const view *v,
                        off_t offset) {
  status st = OK;
  double chunk[CHUNK];
  int n = 0, items = hdf5_items(h, f);
  for (int id = 0; id < items; ++id) {
    for (int k = 0; k < f->n_part; ++k) chunk[n++] = item_value(h, f, v, id, k);
    if (n + 3 < CHUNK && id + 1 < items) continue;
    size_t bytes = sizeof(double) * (size_t)n;
    TRY(put(h->fd, h->path, chunk, bytes, offset));
    offset += (off_t)bytes;
    n = 0;
  }
done:
  return st;
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

static off_t slot(off_t offset, int i) {
  return offset + (off_t)sizeof(double) * i;
}

static status put_real(hdf5_file *h, double value, off_t offset, int i) {
  return put(h->fd, h->path, &value, sizeof value, slot(offset, i));
}

static status put_record(hdf5_file *h, const view *v) {
  status st = OK;
  GROW(h->times, h->n_record, h->cap_time);
  find_surface_ids(h, v->s->surface);
  for (int i = 0; i < h->n_field; ++i) {
    if (hdf5_is_history(&h->fields[i])) continue;
    size_t k = (size_t)i * (size_t)h->now.n_record + (size_t)h->n_record;
    TRY(put_field(h, &h->fields[i], v, h->now.record[k]));
  }
  TRY(put_real(h, v->s->total_no, h->now.record_total, h->n_record));
  TRY(put_real(h, v->s->t, h->now.record_time, h->n_record));
  h->times[h->n_record++] = v->s->t;
done:
  return st;
}

static status put_row(hdf5_file *h, const view *v) {
  status st = OK;
  int time_id = time_field(h);
  for (int i = 0; i < h->n_field; ++i) {
    const hdf5_field *f = &h->fields[i];
    if (!hdf5_is_history(f) || i == time_id) continue;
    TRY(put_real(h, part_value(f, v, f->id, 0), h->now.history[i], h->n_row));
  }
  TRY(put_real(h, v->s->t, h->now.history[time_id], h->n_row));
  ++h->n_row;
done:
  return st;
}

status hdf5_increment(hdf5_file *h, const state *s) {
  status st = OK;
  if (h == NULL) return OK;
  view v = {h->m, h->msh, s};
  int due = output_due(h->m->steps[s->step_no - 1].output_frequency, s);
  if (due && h->n_record == MOST_RECORDS) due = 0;
  if (h->n_row == h->now.n_row || (due && h->n_record == h->now.n_record))
    TRY(grow(h, s));
  if (due) TRY(put_record(h, &v));
  TRY(put_row(h, &v));
done:
  return st;
}

/* ---- what stands in the file ------------------------------------------ */

/* A name as a link of HDF5: "/" parts groups and "." is the group itself. */
static void link_name(char *text, size_t size, const char *name) {
  snprintf(text, size, "%s", name);
  for (char *c = text; *c != '\0'; ++c)
    if (*c == '/') *c = '|';
  if (strcmp(text, ".") == 0 || text[0] == '\0') snprintf(text, size, "_");
}

static const char *group_of(const column *c) {
  if (c->of == PER_INCREMENT) return "/history";
  return c->of == PER_CONTACT_NODE ? "/contact" : "/fields";
}

/* A column that shares its field with one before is its next component. */
static status add_field(hdf5_file *h, const column *c, const char *group,
                        int id) {
  status st = OK;
  for (int i = 0; i < h->n_field; ++i) {
    hdf5_field *f = &h->fields[i];
    if (strcmp(f->name, c->field) != 0 || strcmp(f->group, group) != 0)
      continue;
    f->n_part = 3;
    f->part[c->part] = c;
    return OK;
  }
  GROW(h->fields, h->n_field, h->cap_field);
  hdf5_field *f = &h->fields[h->n_field++];
  *f = (hdf5_field){.name = c->field, .of = c->of, .id = id, .n_part = 1};
  snprintf(f->group, sizeof f->group, "%s", group);
  f->part[0] = c;
done:
  return st;
}

static status choose_fields(hdf5_file *h) {
  status st = OK;
  char name[100], group[120];
  for (const column *c = column_next(NULL); c != NULL; c = column_next(c)) {
    if (c->field == NULL || !column_visible(c, h->m)) continue;
    if (c->of == PER_CONTACT_NODE && h->n_contact_node == 0) continue;
    if (c->of != PER_CONTACT) {
      TRY(add_field(h, c, group_of(c), 0));
      continue;
    }
    for (int i = 0; i < h->m->n_contact; ++i) {
      link_name(name, sizeof name, h->m->contacts[i].name);
      snprintf(group, sizeof group, "/totals/%s", name);
      TRY(add_field(h, c, group, i));
    }
  }
done:
  return st;
}

/* Takes own over, also when it fails. */
static status add_fixed(hdf5_file *h, const char *path, data_type type,
                        int rows, int columns, const void *data, void *own) {
  status st = OK;
  GROW(h->fixed, h->n_fixed, h->cap_fixed);
  fixed_data *d = &h->fixed[h->n_fixed++];
  *d = (fixed_data){.type = type,
                    .rows = rows,
                    .columns = columns,
                    .data = own != NULL ? own : data,
                    .own = own};
  snprintf(d->path, sizeof d->path, "%s", path);
  own = NULL;
done:
  memory_free(own);
  return st;
}

/* Points of some nodes (NULL: all), with 3 components. */
static status add_points(hdf5_file *h, const char *path, int n,
                         const int *node_id) {
  status st = OK;
  size_t dim = (size_t)h->msh->dim;
  double *own = NULL;
  NEW(own, 3 * (size_t)n);
  for (size_t i = 0; i < (size_t)n; ++i)
    for (size_t k = 0; k < dim; ++k)
      own[3 * i + k] =
          h->msh->x[dim * (node_id != NULL ? (size_t)node_id[i] : i) + k];
  return add_fixed(h, path, DATA_REAL, n, 3, NULL, own);
done:
  return st;
}

static int path_known(const hdf5_file *h, const char *path) {
  for (int i = 0; i < h->n_fixed; ++i)
    if (strcmp(h->fixed[i].path, path) == 0) return 1;
  return 0;
}

static status add_group(hdf5_file *h, const mesh_group *g) {
  status st = OK;
  char name[100], path[200];
  link_name(name, sizeof name, g->name);
  snprintf(path, sizeof path, "/mesh/groups/%s/nodes", name);
  if (path_known(h, path)) /* one name in two dimensions                     */
    snprintf(name + strlen(name), sizeof name - strlen(name), "_%d", g->dim);
  snprintf(path, sizeof path, "/mesh/groups/%s/nodes", name);
  if (path_known(h, path)) return OK;
  TRY(add_fixed(h, path, DATA_INT, g->n_node, 1, g->node_id, NULL));
  snprintf(path, sizeof path, "/mesh/groups/%s/%s", name,
           g->dim == h->msh->dim ? "elements" : "faces");
  if (g->item_id != NULL)
    TRY(add_fixed(h, path, DATA_INT, g->n_item, 1, g->item_id, NULL));
done:
  return st;
}

static status add_mesh(hdf5_file *h) {
  status st = OK;
  const mesh *s = h->msh;
  TRY(add_points(h, "/mesh/nodes", s->n_node, NULL));
  TRY(add_fixed(h, "/mesh/elements", DATA_INT, s->n_elem, s->dim + 1, s->elem,
                NULL));
  TRY(add_fixed(h, "/mesh/node_no", DATA_NUMBER, s->n_node, 1, s->node_no,
                NULL));
  TRY(add_fixed(h, "/mesh/elem_no", DATA_NUMBER, s->n_elem, 1, s->elem_no,
                NULL));
  TRY(add_fixed(h, "/mesh/faces", DATA_INT, s->n_face, s->dim, s->face, NULL));
  for (int i = 0; i < s->n_group; ++i) TRY(add_group(h, &s->group[i]));
done:
  return st;
}

static const mesh_group *contact_group(const hdf5_file *h, int contact_id) {
  return &h->msh->group[h->m->contacts[contact_id].group_id];
}

/* The faces of the contact groups, as places in contact_node. */
static status add_faces(hdf5_file *h, const int *place_of) {
  status st = OK;
  const mesh *s = h->msh;
  size_t dim = (size_t)s->dim, n = 0, most = 0;
  int *faces = NULL;
  for (int c = 0; c < h->m->n_contact; ++c)
    most += (size_t)contact_group(h, c)->n_item;
  NEW(faces, dim * most);
  for (int c = 0; c < h->m->n_contact; ++c) {
    const mesh_group *g = contact_group(h, c);
    if (g->dim != s->dim - 1 || g->item_id == NULL) continue;
    for (int i = 0; i < g->n_item; ++i)
      for (size_t k = 0; k < dim; ++k)
        faces[n++] = place_of[s->face[dim * (size_t)g->item_id[i] + k]];
  }
  h->n_contact_face = (int)(n / dim);
  return add_fixed(h, "/contact/faces", DATA_INT, h->n_contact_face, s->dim,
                   NULL, faces);
done:
  return st;
}

/* place_of[n_node]: place in contact_node; contact_of[n_node]: the first
 * contact of a node, from 1; 0: none. */
static status list_contact_nodes(hdf5_file *h, int *place_of, int *contact_of) {
  status st = OK;
  int n = 0;
  for (int c = h->m->n_contact - 1; c >= 0; --c)
    for (int i = 0; i < contact_group(h, c)->n_node; ++i)
      contact_of[contact_group(h, c)->node_id[i]] = c + 1;
  for (int i = 0; i < h->msh->n_node; ++i) n += contact_of[i] > 0;
  NEW(h->contact_node, n);
  NEW(h->surface_id, n);
  h->n_contact_node = n;
  n = 0;
  for (int i = 0; i < h->msh->n_node; ++i) {
    if (contact_of[i] == 0) continue;
    place_of[i] = n;
    h->contact_node[n++] = i;
  }
done:
  return st;
}

/* Number of the node and of its contact, and the place itself (points of a
 * viewer that draws no faces). */
static status add_contact_numbers(hdf5_file *h, const int *contact_of) {
  status st = OK;
  size_t *no = NULL;
  int *numbers = NULL, n = h->n_contact_node;
  NEW(no, n);
  for (int i = 0; i < n; ++i) no[i] = h->msh->node_no[h->contact_node[i]];
  TRY(add_fixed(h, "/contact/node_no", DATA_NUMBER, n, 1, NULL, no));
  NEW(numbers, n);
  for (int i = 0; i < n; ++i) numbers[i] = contact_of[h->contact_node[i]];
  TRY(add_fixed(h, "/contact/contact_no", DATA_INT, n, 1, NULL, numbers));
  NEW(numbers, n);
  for (int i = 0; i < n; ++i) numbers[i] = i;
  TRY(add_fixed(h, "/contact/index", DATA_INT, n, 1, NULL, numbers));
done:
  return st;
}

static status add_contact(hdf5_file *h) {
  status st = OK;
  int *place_of = NULL, *contact_of = NULL;
  NEW(place_of, h->msh->n_node);
  NEW(contact_of, h->msh->n_node);
  TRY(list_contact_nodes(h, place_of, contact_of));
  if (h->n_contact_node == 0) goto done;
  TRY(add_points(h, "/contact/points", h->n_contact_node, h->contact_node));
  TRY(add_fixed(h, "/contact/node", DATA_INT, h->n_contact_node, 1,
                h->contact_node, NULL));
  TRY(add_contact_numbers(h, contact_of));
  TRY(add_faces(h, place_of));
done:
  memory_free(place_of);
  memory_free(contact_of);
  return st;
}

static status add_deck(hdf5_file *h) {
  status st = OK;
  char *text = NULL, *own = NULL;
  size_t size = 0;
  if (h->m->deck == NULL) return OK;
  FILE *f = open_memstream(&text, &size);
  if (f == NULL) FAIL(ERR_MEMORY, "memory exhausted: text of the deck");
  model_echo(h->m, f);
  if (fclose(f) != 0) FAIL(ERR_MEMORY, "memory exhausted: text of the deck");
  NEW(own, size + 1);
  memcpy(own, text, size);
  st = add_fixed(h, "/deck", DATA_TEXT, (int)size + 1, 1, NULL, own);
done:
  free(text);
  return st;
}

/* ---- open and close --------------------------------------------------- */

static void release(hdf5_file *h) {
  if (h->fd >= 0) close(h->fd);
  for (int i = 0; i < h->n_fixed; ++i) memory_free(h->fixed[i].own);
  hdf5_layout_free(&h->now);
  memory_free(h->fields);
  memory_free(h->fixed);
  memory_free(h->contact_node);
  memory_free(h->surface_id);
  memory_free(h->times);
  memory_free(h->path);
  memory_free(h->aside);
  memory_free(h);
}

/* The mesh may stay, what was copied for the first file goes. */
static void drop_copies(hdf5_file *h) {
  for (int i = 0; i < h->n_fixed; ++i) {
    memory_free(h->fixed[i].own);
    h->fixed[i].own = NULL;
    h->fixed[i].data = NULL;
  }
}

/* The file of the run that is gone on with: what it holds beyond "before" is
 * written again. */
static status earlier_file(hdf5_file *h, const hdf5_count *before) {
  status st = OK;
  TRY(hdf5_layout_read(h, &h->now));
  if (h->now.n_row < before->rows || h->now.n_record < before->records)
    FAIL(ERR_FILE, "%s holds less than when the restart file was written",
         h->path);
  h->fd = open(h->path, O_RDWR | O_CLOEXEC);
  if (h->fd < 0) TRY(text_failed(h->path, "open", errno));
  h->n_row = before->rows;
  h->n_record = h->cap_time = before->records;
  size_t bytes = (size_t)h->n_record * sizeof *h->times;
  NEW(h->times, h->n_record);
  errno = 0;
  if (bytes > 0 &&
      pread(h->fd, h->times, bytes, h->now.record_time) != (ssize_t)bytes)
    TRY(text_failed(h->path, "read back", errno));
done:
  return st;
}

static status first_file(hdf5_file *h, const hdf5_count *before) {
  status st = OK;
  int rows, records;
  TRY(add_mesh(h));
  if (h->m->effects & EFFECT_CONTACT) TRY(add_contact(h));
  TRY(add_deck(h));
  TRY(choose_fields(h));
  forecast(h->m, 0, 0, &rows, &records);
  if (before != NULL) {
    TRY(earlier_file(h, before));
    if (rows < before->rows) rows = before->rows;
    if (records < before->records) records = before->records;
  }
  TRY(renew(h, rows, records));
  drop_copies(h);
done:
  return st;
}

static int fields_asked(const model *m) {
  for (int i = 0; i < m->n_step; ++i)
    if (m->steps[i].output_frequency >= 0) return 1;
  return 0;
}

status hdf5_open(const model *m, const mesh *msh, const output_options *o,
                 const hdf5_count *before, hdf5_file **out) {
  status st = OK;
  hdf5_file *h = NULL;
  *out = NULL;
  if (!fields_asked(m)) return OK;
  H5dont_atexit(); /* the exit handler crashes after a failed write          */
  NEW(h, 1);
  h->fd = -1;
  h->m = m;
  h->msh = msh;
  h->o = o;
  h->path = text_path(o->dir, m->job, "h5");
  if (h->path != NULL) h->aside = text_path("", h->path, "tmp");
  if (h->aside == NULL) FAIL(ERR_MEMORY, "memory exhausted: name of JOB.h5");
  TRY(first_file(h, before));
  *out = h;
done:
  if (st != OK && h != NULL) release(h);
  return st;
}

status hdf5_sync(hdf5_file *h, hdf5_count *n) {
  status st = OK;
  *n = (hdf5_count){0, 0};
  if (h == NULL) return OK;
  *n = (hdf5_count){h->n_row, h->n_record};
  if (fsync(h->fd) != 0) TRY(text_failed(h->path, "write", errno));
done:
  return st;
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
      renew(h, h->n_row, h->n_record) != OK)
    status_clear(); /* no room for the copy: the file stays as it is         */
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
