/*
 * src/output/hdf5/records.c: groups of many records, read with the library:
 * every name once, in order, found, with the data where the offsets say.
 */
#include "output/hdf5/file.h"
#include "support/folder.h"
#include "support/unit.h"

#include <hdf5.h>
#include <fcntl.h>
#include <unistd.h>

static char dir[64], path[100];
enum { VALUES = 3 };

/* Address of the header of an object. */
static uint64_t address_of(hid_t file, const char *name) {
  hobj_ref_t reference;
  ck_assert_int_ge(H5Rcreate(&reference, file, name, H5R_OBJECT, -1), 0);
  return reference;
}

/* A group with its first record; the header of one with many attributes
 * goes on elsewhere. */
static record_group make_group(hid_t file, const char *name, int attributes,
                               off_t *offset) {
  char text[32];
  const hsize_t dims[1] = {VALUES};
  hid_t space = H5Screate_simple(1, dims, NULL),
        plain = H5Pcreate(H5P_DATASET_CREATE);
  hid_t group = H5Gcreate2(file, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  for (int i = 0; i < attributes; ++i) {
    snprintf(text, sizeof text, "attribute %d", i);
    H5Aclose(H5Acreate2(group, text, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT,
                        H5P_DEFAULT));
  }
  H5Pset_alloc_time(plain, H5D_ALLOC_TIME_EARLY);
  hid_t set = H5Dcreate2(group, "00001", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT,
                         plain, H5P_DEFAULT);
  ck_assert_int_ge(set, 0);
  offset[0] = (off_t)H5Dget_offset(set);
  H5Dclose(set);
  H5Gclose(group);
  H5Pclose(plain);
  H5Sclose(space);
  PRINTED(first, "%s/00001", name);
  return (record_group){address_of(file, name), address_of(file, first),
                        VALUES * sizeof(double), offset};
}

static hid_t create_file(H5F_libver_t low) {
  folder_new(dir);
  snprintf(path, sizeof path, "%s/records.h5", dir);
  hid_t formats = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_libver_bounds(formats, low, H5F_LIBVER_LATEST);
  hid_t file = H5Fcreate(path, H5F_ACC_EXCL, H5P_DEFAULT, formats);
  ck_assert_int_ge(file, 0);
  H5Pclose(formats);
  return file;
}

/* Number i of a record in it, in those that are read again. */
static void put_values(int n, int every, const off_t *offset) {
  int fd = open(path, O_WRONLY);
  ck_assert_int_ge(fd, 0);
  for (int i = 0; i < n; ++i) {
    const double x[VALUES] = {i, 0.5 * i, -1.0};
    if (i % every != 0 && i != n - 1) continue;
    ck_assert_int_eq(pwrite(fd, x, sizeof x, offset[i]), sizeof x);
  }
  close(fd);
}

typedef struct walk {
  int n, wrong;
  char before[40];
} walk;

static herr_t next_name(hid_t group, const char *name, const H5L_info_t *info,
                        void *ctx) {
  walk *w = ctx;
  w->wrong += info->type != H5L_TYPE_HARD || strcmp(name, w->before) <= 0;
  snprintf(w->before, sizeof w->before, "%s", name);
  ++w->n;
  return 0;
}

static void check_record(hid_t group, int i, const off_t *offset) {
  char name[40];
  double x[VALUES] = {0.0};
  hdf5_record_name(name, sizeof name, i);
  hid_t set = H5Dopen2(group, name, H5P_DEFAULT);
  ck_assert_msg(set >= 0, "no record %s", name);
  ck_assert_int_eq((off_t)H5Dget_offset(set), offset[i]);
  ck_assert_int_ge(
      H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, x), 0);
  ck_assert(x[0] == i && x[1] == 0.5 * i && x[2] == -1.0);
  H5Dclose(set);
}

static void check_group(hid_t file, const char *name, int n, int every,
                        const off_t *offset) {
  walk w = {0};
  hid_t group = H5Gopen2(file, name, H5P_DEFAULT);
  ck_assert_int_ge(group, 0);
  ck_assert_int_ge(
      H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, NULL, next_name, &w), 0);
  ck_assert_int_eq(w.n, n);
  ck_assert_int_eq(w.wrong, 0);
  for (int i = 0; i < n; i += every) check_record(group, i, offset);
  check_record(group, n - 1, offset);
  ck_assert_int_le(H5Lexists(group, "00000", H5P_DEFAULT), 0);
  ck_assert_int_le(H5Lexists(group, "99999x", H5P_DEFAULT), 0);
  H5Gclose(group);
}

/* A program that goes on with the file may add to the group. */
static void add_one(int n) {
  hid_t file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
  ck_assert_int_ge(
      H5Lcreate_soft("/a/00001", file, "/a/00001b", H5P_DEFAULT, H5P_DEFAULT),
      0);
  ck_assert_int_ge(H5Ldelete(file, "/a/00002", H5P_DEFAULT), 0);
  H5G_info_t info;
  H5Gget_info_by_name(file, "/a", &info, H5P_DEFAULT);
  ck_assert_int_eq((int)info.nlinks, n);
  ck_assert_int_ge(H5Fclose(file), 0);
}

/* Sizes round those of a node (8), of a root over nodes (256) and over trees
 * (8192), and of names of six digits. */
TESTS(records_of_any_number_are_found, 12) {
  static const int sizes[] = {2,    8,    9,    255,  256,    257,
                              2100, 8191, 8192, 8193, 100012, 262200};
  const int n = sizes[_i];
  if (n == 100012 && !unit_whole()) return; /* 262200 has six digits, too  */
  off_t *offset[2];
  for (int k = 0; k < 2; ++k) offset[k] = calloc((size_t)n, sizeof(off_t));
  hid_t file = create_file(H5F_LIBVER_EARLIEST);
  const record_group groups[3] = {make_group(file, "a", 0, offset[0]),
                                  {0},
                                  make_group(file, "b", 30, offset[1])};
  ck_assert_int_ge(H5Fclose(file), 0);
  ck_assert_int_eq(hdf5_records_make(path, n, 3, groups), OK);
  const int every[2] = {1 + n / 3000, 1 + n / 500};
  for (int k = 0; k < 2; ++k) put_values(n, every[k], offset[k]);
  file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  ck_assert_int_ge(file, 0);
  check_group(file, "a", n, every[0], offset[0]);
  check_group(file, "b", n, every[1], offset[1]);
  ck_assert_int_ge(H5Fclose(file), 0);
  add_one(n);
  for (int k = 0; k < 2; ++k) free(offset[k]);
  folder_remove(dir);
}

/* Groups as later versions of HDF5 make them. */
TEST(another_format_is_told) {
  off_t offset[4] = {0};
  hid_t file = create_file(H5F_LIBVER_LATEST);
  const record_group group = make_group(file, "a", 0, offset);
  H5Fclose(file);
  ck_assert_int_eq(hdf5_records_make(path, 4, 1, &group), ERR_FILE);
  ck_assert_ptr_nonnull(strstr(status_message(), "version of HDF5"));
  folder_remove(dir);
}

int main(void) {
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  return unit_run("records", UNIT_SECONDS);
}
