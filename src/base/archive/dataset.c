/*
 * Datasets of an HDF5 file from outside: nothing in it is trusted. The
 * library's own error stack stays silent; messages name the file and the
 * dataset.
 */
#include "base/archive/dataset.h"

#include "base/base.h"
#include "base/system/input.h"

#include <unistd.h>

enum {
  MOST_BYTES = 16,     /* of one number */
  MOST_PACKED = 1100,  /* times its bytes in the file; deflate reaches 1032 */
  LARGE_PART = 1 << 20 /* items */
};

void dataset_leave(hid_t *id) {
  if (*id >= 0) H5Idec_ref(*id);
}

/* By the descriptor: the name may refer to another file by now. */
status dataset_open(const char *path, hdf5_source *s) {
  const char *why = NULL;
  char name[40];
  *s = (hdf5_source){.path = path, .file = -1};
  H5Eget_auto2(H5E_DEFAULT, &s->print, &s->print_data);
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  H5dont_atexit();
  H5Lunregister(H5L_TYPE_EXTERNAL);
  s->fd = input_open(path, &why);
  if (s->fd < 0) RAISE(ERR_FILE, "%s: cannot be read: %s", path, why);
  snprintf(name, sizeof name, "/proc/self/fd/%d", s->fd);
  htri_t is_hdf5 = H5Fis_hdf5(name);
  if (is_hdf5 < 0) RAISE(ERR_FILE, "%s: cannot be read", path);
  if (is_hdf5 == 0) RAISE(ERR_FILE, "%s is no HDF5 file, or cut short", path);
  s->file = H5Fopen(name, H5F_ACC_RDONLY, H5P_DEFAULT);
  if (s->file < 0)
    RAISE(ERR_FILE, "%s cannot be read: the HDF5 file is damaged or cut short",
          path);
  return OK;
}

void dataset_close(hdf5_source *s) {
  if (s->file >= 0) H5Fclose(s->file);
  if (s->fd >= 0) close(s->fd);
  H5Eset_auto2(H5E_DEFAULT, s->print, s->print_data);
}

/* Every group of the path must exist before the library is called. */
int source_has(const hdf5_source *s, const char *name) {
  char part[256];
  size_t length = strlen(name);
  if (length >= sizeof part) return 0;
  for (size_t k = 1; k <= length; ++k) {
    if (name[k] != '/' && name[k] != '\0') continue;
    memcpy(part, name, k);
    part[k] = '\0';
    if (H5Lexists(s->file, part, H5P_DEFAULT) <= 0 ||
        H5Oexists_by_name(s->file, part, H5P_DEFAULT) <= 0)
      return 0;
  }
  return 1;
}

/* The library allocates buffers of the size that a damaged type states. */
static status check_type(const hdf5_source *s, const char *name, int real,
                         hid_t set) {
  HELD hid_t type = H5Dget_type(set);
  H5T_class_t kind = H5Tget_class(type);
  if (kind != H5T_INTEGER && !(real && kind == H5T_FLOAT))
    RAISE(ERR_DECK, "%s: %s does not hold %s", s->path, name,
          real ? "real numbers" : "integers");
  if (H5Tget_size(type) > MOST_BYTES)
    RAISE(ERR_DECK, "%s: %s has numbers of %zu bytes", s->path, name,
          H5Tget_size(type));
  return OK;
}

static int may_pack(H5Z_filter_t filter) {
  return filter == H5Z_FILTER_DEFLATE ||
         (!input_is_confined() &&
          (filter == H5Z_FILTER_SHUFFLE || filter == H5Z_FILTER_FLETCHER32));
}

/* Items of a chunk; 0: not chunked. */
static hsize_t part_items(hid_t made) {
  hsize_t size[H5S_MAX_RANK], items = 1;
  if (H5Pget_layout(made) != H5D_CHUNKED) return 0;
  int rank = H5Pget_chunk(made, H5S_MAX_RANK, size);
  for (int k = 0; k < rank; ++k) items *= size[k];
  return items;
}

/* Where the data are stored, and their filters. */
static status check_storage(const hdf5_source *s, const char *name, hid_t set,
                            hsize_t items) {
  HELD hid_t made = H5Dget_create_plist(set);
  if (made < 0) RAISE(ERR_DECK, "%s: %s is damaged", s->path, name);
  if (H5Pget_layout(made) == H5D_VIRTUAL || H5Pget_external_count(made) != 0)
    RAISE(ERR_DECK, "%s: the data of %s stand in other files", s->path, name);
  hsize_t part = part_items(made);
  if (part > items && part > LARGE_PART)
    RAISE(ERR_DECK, "%s: %s has %llu items, but parts of %llu", s->path, name,
          (unsigned long long)items, (unsigned long long)part);
  for (int k = 0; k < H5Pget_nfilters(made); ++k) {
    unsigned flags, info;
    size_t n = 0;
    H5Z_filter_t filter =
        H5Pget_filter2(made, k, &flags, &n, NULL, 0, NULL, &info);
    if (!may_pack(filter))
      RAISE(ERR_DECK, "%s: %s is packed by filter %d; only deflate is read",
            s->path, name, (int)filter);
  }
  return OK;
}

/* The number of items must be possible with the bytes of the file: a dataset
 * that was never written, or is damaged, would be any number of zeros. */
status dataset_check(const hdf5_source *s, const char *name, hid_t set,
                     hsize_t items) {
  HELD hid_t type = H5Dget_type(set);
  hsize_t size = 0, stored = H5Dget_storage_size(set);
  hsize_t bytes = items * (hsize_t)H5Tget_size(type);
  PASS(check_storage(s, name, set, items));
  if (H5Fget_filesize(s->file, &size) < 0 || stored > size ||
      bytes / MOST_PACKED > stored)
    RAISE(ERR_DECK, "%s: %s has %llu items, and %llu bytes in the file",
          s->path, name, (unsigned long long)items, (unsigned long long)stored);
  return OK;
}

/* The dataset opened, its kind and number of items checked; *set (-1 before)
 * stays if it is not there and may be missing. */
static status open_set(const hdf5_source *s, const char *name, int optional,
                       int real, long most, hid_t *set, long *n) {
  *n = 0;
  if (!source_has(s, name)) {
    if (optional) return OK;
    RAISE(ERR_DECK, "%s: there is no dataset %s in this file", s->path, name);
  }
  *set = H5Dopen2(s->file, name, H5P_DEFAULT);
  if (*set < 0)
    RAISE(ERR_DECK, "%s: %s is no dataset, or damaged", s->path, name);
  PASS(check_type(s, name, real, *set));
  HELD hid_t space = H5Dget_space(*set);
  hssize_t items = H5Sget_simple_extent_npoints(space);
  if (items < 0)
    RAISE(ERR_DECK, "%s: %s has a size that cannot be used", s->path, name);
  if (items > most)
    RAISE(ERR_DECK, "%s: %s has %lld items, expected at most %ld", s->path,
          name, (long long)items, most);
  PASS(dataset_check(s, name, *set, (hsize_t)items));
  *n = (long)items;
  return OK;
}

static status read_set(const hdf5_source *s, const char *name, hid_t set,
                       hid_t as, void *into) {
  if (H5Dread(set, as, H5S_ALL, H5S_ALL, H5P_DEFAULT, into) < 0)
    RAISE(ERR_FILE, "%s: %s cannot be read; the file is damaged or cut short",
          s->path, name);
  return OK;
}

status source_ints(const hdf5_source *s, const char *name, int optional,
                   long most, long *n, int **value) {
  HELD hid_t set = -1;
  *value = NULL;
  PASS(open_set(s, name, optional, 0, most, &set, n));
  OWNED_NEW(long long, wide, *n);
  if (*n > 0) PASS(read_set(s, name, set, H5T_NATIVE_LLONG, wide));
  for (long k = 0; k < *n; ++k)
    if (wide[k] < INT_MIN || wide[k] > INT_MAX)
      RAISE(ERR_DECK, "%s: %s, item %ld = %lld is too large", s->path, name, k,
            wide[k]);
  PASS_NEW(*value, *n);
  for (long k = 0; k < *n; ++k) (*value)[k] = (int)wide[k];
  return OK;
}

status source_int(const hdf5_source *s, const char *name, int *value) {
  long n = 0;
  OWNED_OF(int, all, source_ints(s, name, 0, MOST_ITEMS, &n, &all));
  if (n != 1)
    RAISE(ERR_DECK, "%s: %s has %ld items, expected one integer", s->path, name,
          n);
  *value = all[0];
  return OK;
}

status source_reals(const hdf5_source *s, const char *name, int optional,
                    long most, long *n, double **value) {
  HELD hid_t set = -1;
  *value = NULL;
  PASS(open_set(s, name, optional, 1, most, &set, n));
  OWNED_NEW(double, v, *n);
  if (*n > 0) PASS(read_set(s, name, set, H5T_NATIVE_DOUBLE, v));
  for (long k = 0; k < *n; ++k)
    if (!isfinite(v[k]))
      RAISE(ERR_DECK, "%s: %s, item %ld is not a finite number", s->path, name,
            k);
  *value = v;
  v = NULL;
  return OK;
}
