/*
 * The empty JOB.h5: groups, datasets, units; HDF5 calls only. Each call is
 * checked: on a full disk H5Fflush fails and H5Fclose does not.
 */
#include "output/hdf5/file.h"

#include "base/archive/dataset.h"
#include "base/file.h"

#include <errno.h>

/* The file while it is made. */
typedef struct maker {
  const char *path;
  hid_t file, with_groups, plain;
} maker;

static status maker_failed(const maker *k, const char *doing) {
  return text_failed(k->path, doing, errno);
}

/* The formats that records.c writes, not those of later versions. */
static status create_file(maker *k) {
  HELD hid_t formats = H5Pcreate(H5P_FILE_ACCESS);
  errno = 0;
  if (formats >= 0 && H5Pset_libver_bounds(formats, H5F_LIBVER_EARLIEST,
                                           H5F_LIBVER_LATEST) >= 0)
    k->file = H5Fcreate(k->path, H5F_ACC_EXCL, H5P_DEFAULT, formats);
  return k->file < 0 ? maker_failed(k, "create") : OK;
}

static status open_maker(maker *k) {
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  PASS(file_clear(k->path));
  PASS(create_file(k));
  k->with_groups = H5Pcreate(H5P_LINK_CREATE);
  k->plain = H5Pcreate(H5P_DATASET_CREATE);
  if (k->with_groups < 0 || k->plain < 0 ||
      H5Pset_create_intermediate_group(k->with_groups, 1) < 0 ||
      H5Pset_layout(k->plain, H5D_CONTIGUOUS) < 0 ||
      H5Pset_alloc_time(k->plain, H5D_ALLOC_TIME_EARLY) < 0 ||
      H5Pset_fill_time(k->plain, H5D_FILL_TIME_NEVER) < 0 ||
      H5Pset_obj_track_times(k->plain, 0) < 0)
    PASS(maker_failed(k, "set up"));
  return OK;
}

static status close_maker(maker *k, int flush) {
  int bad = 0;
  errno = 0;
  if (flush && H5Fflush(k->file, H5F_SCOPE_GLOBAL) < 0) bad = 1;
  if (k->plain >= 0) H5Pclose(k->plain);
  if (k->with_groups >= 0) H5Pclose(k->with_groups);
  if (k->file >= 0 && H5Fclose(k->file) < 0) bad = 1;
  return bad ? maker_failed(k, "write") : OK;
}

/* *type is new (H5Tclose), -1 after a failure. */
static status text_type(const maker *k, size_t size, hid_t *type) {
  *type = H5Tcopy(H5T_C_S1);
  if (*type < 0 || H5Tset_size(*type, size) < 0 ||
      H5Tset_strpad(*type, H5T_STR_NULLPAD) < 0)
    return maker_failed(k, "set up");
  return OK;
}

/* An attribute of any type; type is closed. */
static status attribute(const maker *k, hid_t object, const char *name,
                        hid_t type, const void *value) {
  HELD hid_t space = H5Screate(H5S_SCALAR);
  HELD hid_t a =
      H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
  if (a < 0 || H5Awrite(a, type, value) < 0)
    return maker_failed(k, "write an attribute of");
  return OK;
}

static status attribute_text(const maker *k, hid_t object, const char *name,
                             const char *value) {
  HELD hid_t type = -1;
  if (value == NULL) value = "";
  PASS(text_type(k, strlen(value) + 1, &type));
  return attribute(k, object, name, type, value);
}

static status column_attributes(const maker *k, hid_t object, const column *c,
                                const model *m) {
  PASS(attribute_text(k, object, "unit", model_unit(m, c->unit)));
  return attribute_text(k, object, "help", c->help);
}

/* A group and those above it. */
static status make_group(const maker *k, const char *path, hid_t *group) {
  errno = 0;
  *group = H5Gcreate2(k->file, path, k->with_groups, H5P_DEFAULT, H5P_DEFAULT);
  if (*group < 0) PASS(maker_failed(k, "make a group of"));
  return OK;
}

static status make_dataset(const maker *k, const char *path, hid_t type,
                           const hsize_t dims[2], const column *described,
                           const model *m, off_t *offset) {
  errno = 0;
  HELD hid_t space = H5Screate_simple(dims[1] > 1 ? 2 : 1, dims, NULL);
  HELD hid_t set = H5Dcreate2(k->file, path, type, space, k->with_groups,
                              k->plain, H5P_DEFAULT);
  if (set < 0) return maker_failed(k, "make a dataset of");
  if (described != NULL) PASS(column_attributes(k, set, described, m));
  haddr_t address = H5Dget_offset(set);
  if (address == HADDR_UNDEF) return maker_failed(k, "reserve a dataset of");
  *offset = (off_t)address;
  return OK;
}

static status make_fixed(const maker *k, const hdf5_file *h, hdf5_layout *l) {
  const hid_t types[] = {H5T_NATIVE_DOUBLE, H5T_NATIVE_INT, H5T_NATIVE_ULLONG};
  for (int i = 0; i < h->n_fixed; ++i) {
    const fixed_data *d = &h->fixed[i];
    hsize_t dims[2] = {(hsize_t)d->rows, (hsize_t)d->columns};
    HELD hid_t text = -1;
    if (d->rows == 0) continue;
    if (d->type == DATA_TEXT) {
      PASS(text_type(k, d->rows, &text));
      dims[0] = 1;
    }
    PASS(make_dataset(k, d->path, text >= 0 ? text : types[d->type], dims, NULL,
                      h->m, &l->fixed[i]));
  }
  return OK;
}

/* Where the header of an object stands: references are addresses. */
static status find_address(const maker *k, const char *path,
                           uint64_t *address) {
  hobj_ref_t reference;
  if (H5Rcreate(&reference, k->file, path, H5R_OBJECT, -1) < 0)
    PASS(maker_failed(k, "make a group of"));
  *address = reference;
  return OK;
}

/* The group and its first record; records.c makes the others. */
static status make_records(const maker *k, const hdf5_file *h, int field_id,
                           hdf5_layout *l, record_group *g) {
  const hdf5_field *f = &h->fields[field_id];
  char path[400], name[40], first[441];
  HELD hid_t group = -1;
  hsize_t dims[2] = {(hsize_t)hdf5_items(h, f), (hsize_t)f->n_part};
  snprintf(path, sizeof path, "%s/%s", f->group, f->name);
  PASS(make_group(k, path, &group));
  PASS(column_attributes(k, group, f->part[0], h->m));
  if (dims[0] == 0 || l->n_record == 0) return OK;
  hdf5_record_name(name, sizeof name, 0);
  snprintf(first, sizeof first, "%s/%s", path, name);
  g->offset = &l->record[(size_t)field_id * l->n_record];
  g->bytes = sizeof(double) * dims[0] * dims[1];
  PASS(make_dataset(k, first, H5T_NATIVE_DOUBLE, dims, NULL, NULL, g->offset));
  PASS(find_address(k, path, &g->group));
  return find_address(k, first, &g->set);
}

static status make_history(const maker *k, const hdf5_file *h, int field_id,
                           hdf5_layout *l) {
  const hdf5_field *f = &h->fields[field_id];
  char path[400];
  hsize_t dims[2] = {(hsize_t)l->n_row, 1};
  if (l->n_row == 0) return OK;
  snprintf(path, sizeof path, "%s/%s", f->group, f->name);
  return make_dataset(k, path, H5T_NATIVE_DOUBLE, dims, f->part[0], h->m,
                      &l->history[field_id]);
}

static status root_attributes(const maker *k, const hdf5_file *h) {
  const model *m = h->m;
  const struct {
    const char *name, *text;
    const int *number; /* NULL: a text */
  } row[] = {
      {"program", "protis", NULL},
      {"version", h->o->version, NULL},
      {"job", m->name.job, NULL},
      {"title", m->name.title, NULL},
      {"blas_kernel", h->o->kernel, NULL},
      {"threads", NULL, &h->o->threads},
      {"dimension", NULL, &m->dim},
      {"length_unit", m->unit.length, NULL},
      {"force_unit", m->unit.force, NULL},
      {"time_unit", m->unit.time, NULL},
      {"note", "rows and records whose time is NaN were not reached", NULL}};
  HELD hid_t root = H5Gopen2(k->file, "/", H5P_DEFAULT);
  if (root < 0) return maker_failed(k, "write an attribute of");
  for (size_t i = 0; i < sizeof row / sizeof *row; ++i)
    if (row[i].number != NULL)
      PASS(attribute(k, root, row[i].name, H5T_NATIVE_INT, row[i].number));
    else
      PASS(attribute_text(k, root, row[i].name, row[i].text));
  return OK;
}

static status alloc_layout(const hdf5_file *h, int n_row, int n_record,
                           hdf5_layout *l) {
  *l = (hdf5_layout){.n_row = n_row, .n_record = n_record};
  PASS_NEW_ALL(OF(l->fixed, h->n_fixed), OF(l->history, h->n_field),
               OF(l->record, (size_t)h->n_field * n_record));
  return OK;
}

static status make_all(maker *k, const hdf5_file *h, hdf5_layout *l,
                       record_group *groups) {
  PASS(open_maker(k));
  PASS(root_attributes(k, h));
  PASS(make_fixed(k, h, l));
  for (int i = 0; i < h->n_field; ++i)
    if (hdf5_is_history(&h->fields[i]))
      PASS(make_history(k, h, i, l));
    else
      PASS(make_records(k, h, i, l, &groups[i]));
  hsize_t dims[2] = {(hsize_t)l->n_record, 1};
  if (l->n_record == 0) return OK;
  PASS(make_dataset(k, "/fields/time", H5T_NATIVE_DOUBLE, dims, NULL, h->m,
                    &l->record_time));
  return make_dataset(k, "/fields/total", H5T_NATIVE_DOUBLE, dims, NULL, h->m,
                      &l->record_total);
}

status hdf5_layout_make(const hdf5_file *h, int n_row, int n_record,
                        hdf5_layout *l) {
  maker k = {h->aside, -1, -1, -1};
  OWNED_NEW(record_group, groups, h->n_field);
  status st = alloc_layout(h, n_row, n_record, l);
  if (st == OK) st = make_all(&k, h, l, groups);
  status closed = close_maker(&k, st == OK);
  if (st == OK) st = closed;
  if (st == OK && n_record > 1)
    st = hdf5_records_make(h->aside, n_record, h->n_field, groups);
  if (st != OK) hdf5_layout_free(l);
  return st;
}

/* ---- a file that is there ------------------------------------------------ */

/* Offset of a dataset of that many numbers; *n = 0: any, then as it is, 0 if
 * there is no such dataset. */
static status read_offset(const hdf5_file *h, hid_t file, const char *path,
                          hsize_t *n, off_t *offset) {
  hsize_t wanted = *n;
  HELD hid_t set = H5Dopen2(file, path, H5P_DEFAULT);
  haddr_t address = set >= 0 ? H5Dget_offset(set) : HADDR_UNDEF;
  *n = 0;
  if (set < 0 && wanted == 0) return OK;
  if (set >= 0) *n = H5Dget_storage_size(set) / sizeof(double);
  if (address == HADDR_UNDEF || (wanted > 0 && *n != wanted))
    RAISE(ERR_FILE, "%s: %s is not that of the run to go on with", h->path,
          path);
  *offset = (off_t)address;
  return OK;
}

static status read_records(const hdf5_file *h, hid_t file, int field_id,
                           hdf5_layout *l) {
  const hdf5_field *f = &h->fields[field_id];
  char path[400], name[40];
  for (int i = 0; i < l->n_record && hdf5_items(h, f) > 0; ++i) {
    hsize_t n = (hsize_t)(hdf5_items(h, f) * f->n_part);
    size_t slot = (size_t)field_id * l->n_record + i;
    hdf5_record_name(name, sizeof name, i);
    snprintf(path, sizeof path, "%s/%s/%s", f->group, f->name, name);
    PASS(read_offset(h, file, path, &n, &l->record[slot]));
  }
  return OK;
}

static status read_fields(const hdf5_file *h, hid_t file, hdf5_layout *l) {
  char path[400];
  hsize_t rows = 0, records = 0;
  off_t offset = 0;
  PASS(read_offset(h, file, "/history/time", &rows, &offset));
  PASS(read_offset(h, file, "/fields/time", &records, &offset));
  PASS(alloc_layout(h, (int)rows, (int)records, l));
  l->record_time = offset;
  PASS(read_offset(h, file, "/fields/total", &records, &l->record_total));
  for (int i = 0; i < h->n_field; ++i) {
    const hdf5_field *f = &h->fields[i];
    snprintf(path, sizeof path, "%s/%s", f->group, f->name);
    if (!hdf5_is_history(f))
      PASS(read_records(h, file, i, l));
    else if (rows > 0)
      PASS(read_offset(h, file, path, &rows, &l->history[i]));
  }
  return OK;
}

status hdf5_layout_read(const hdf5_file *h, hdf5_layout *l) {
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  errno = 0;
  HELD hid_t file = H5Fopen(h->path, H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0) RAISE(ERR_FILE, "%s: cannot be read to go on with it", h->path);
  status st = read_fields(h, file, l);
  if (st != OK) hdf5_layout_free(l);
  return st;
}

void hdf5_layout_free(hdf5_layout *l) {
  RELEASE(l->fixed, l->history, l->record);
  *l = (hdf5_layout){0};
}
