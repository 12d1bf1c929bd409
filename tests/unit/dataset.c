/* src/base/archive: what an HDF5 file may not do, and what it may. */
#include "base/archive/archive.h"
#include "base/archive/dataset.h"
#include "base/system/input.h"
#include "support/folder.h"
#include "support/unit.h"

#include <unistd.h>

enum { N = 1000 };

static char folder[64], path[128], other[128];

static void begin(void) {
  folder_new(folder);
  snprintf(path, sizeof path, "%s/a.h5", folder);
  snprintf(other, sizeof other, "%s/b.h5", folder);
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
}

static void end(void) {
  ck_assert_int_eq(input_confine(NULL), OK);
  folder_remove(folder);
}

/* /x of n zeros as "made" says; N of them are written. */
static void put_set(const char *file, hsize_t n, hid_t made) {
  static const double zero[N];
  hid_t f = H5Fcreate(file, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hsize_t any = H5S_UNLIMITED, few = n < N ? n : N, at = 0;
  int in_parts = made != H5P_DEFAULT && H5Pget_layout(made) == H5D_CHUNKED;
  hid_t space = H5Screate_simple(1, &n, in_parts ? &any : NULL);
  hid_t set = H5Dcreate2(f, "x", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, made,
                         H5P_DEFAULT);
  ck_assert_msg(set >= 0, "%s", file);
  hid_t part = H5Screate_simple(1, &few, NULL);
  H5Sselect_hyperslab(space, H5S_SELECT_SET, &at, NULL, &few, NULL);
  ck_assert(H5Dwrite(set, H5T_NATIVE_DOUBLE, part, space, H5P_DEFAULT, zero) >=
            0);
  H5Sclose(part);
  H5Sclose(space);
  H5Dclose(set);
  H5Fclose(f);
}

static hid_t parts(hsize_t size) {
  hid_t made = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_chunk(made, 1, &size);
  return made;
}

/* Read /x; what is said if it is refused, else "". */
static const char *read_x(long most) {
  static char text[1024];
  hdf5_source s;
  OWNED double *x = NULL;
  long n = 0;
  text[0] = '\0';
  size_t before = memory_allocated();
  status st = dataset_open(path, &s);
  if (st == OK) st = source_reals(&s, "/x", 0, most, &n, &x);
  dataset_close(&s);
  if (st != OK) {
    snprintf(text, sizeof text, "%s", status_message());
    ck_assert_uint_lt(memory_allocated() - before, 1 << 16);
  }
  return text;
}

static void must_say(long most, const char *wanted) {
  const char *text = read_x(most);
  if (wanted[0] == '\0')
    ck_assert_str_eq(text, "");
  else
    ck_assert_msg(strstr(text, wanted) != NULL, "'%s', not: %s", text, wanted);
}

TEST(data_of_other_files_are_refused) {
  begin();
  put_set(other, N, H5P_DEFAULT);
  hid_t f = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  H5Lcreate_external("b.h5", "/x", f, "x", H5P_DEFAULT, H5P_DEFAULT);
  H5Fclose(f);
  must_say(N, "no dataset /x in this file");
  f = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
  H5Lmove(f, "x", f, "y", H5P_DEFAULT, H5P_DEFAULT);
  H5Lcreate_soft("/y", f, "x", H5P_DEFAULT, H5P_DEFAULT);
  H5Fclose(f);
  must_say(N, "no dataset /x in this file");
  hid_t made = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_external(made, other, 0, N * sizeof(double));
  put_set(path, N, made);
  must_say(N, "the data of /x stand in other files");
  H5Pclose(made);
  const hsize_t n = N;
  hid_t space = H5Screate_simple(1, &n, NULL);
  put_set(other, N, H5P_DEFAULT);
  made = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_virtual(made, space, other, "x", space);
  f = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  H5Dclose(H5Dcreate2(f, "x", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, made,
                      H5P_DEFAULT));
  H5Fclose(f);
  H5Pclose(made);
  H5Sclose(space);
  must_say(N, "the data of /x stand in other files");
  end();
}

TEST(links_inside_the_file_are_followed) {
  begin();
  put_set(path, N, H5P_DEFAULT);
  hid_t f = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
  H5Lmove(f, "x", f, "y", H5P_DEFAULT, H5P_DEFAULT);
  H5Lcreate_soft("/y", f, "x", H5P_DEFAULT, H5P_DEFAULT);
  H5Fclose(f);
  must_say(N, "");
  end();
}

/* Deflate alone with --safe; without also what loses nothing. */
TEST(packing_is_deflate) {
  begin();
  for (int safe = 0; safe < 2; ++safe) {
    ck_assert_int_eq(input_confine(safe ? folder : NULL), OK);
    hid_t made = parts(100);
    H5Pset_deflate(made, 9);
    put_set(path, N, made);
    must_say(N, "");
    H5Pset_shuffle(made);
    put_set(path, N, made);
    must_say(N, safe ? "packed by filter 2" : "");
    H5Pclose(made);
    made = parts(100);
    H5Pset_nbit(made);
    put_set(path, N, made);
    must_say(N, "packed by filter 5");
    H5Pclose(made);
  }
  end();
}

/* Nothing is allocated for what cannot be there or is not wanted. */
TEST(sizes_are_compared_first) {
  begin();
  hid_t made = parts(1 << 16);
  H5Pset_deflate(made, 9);
  put_set(path, N, made);
  must_say(N - 1, "1000 items, expected at most 999");
  put_set(path, 1 << 27, made);
  must_say(1 << 27, "134217728 items, and ");
  H5Pclose(made);
  made = parts(1 << 24);
  H5Pset_deflate(made, 9);
  put_set(path, N, made);
  must_say(N, "parts of 16777216");
  H5Pclose(made);
  end();
}

/* ---- restart files ------------------------------------------------------- */

enum { WHOLE, ELSEWHERE, LINKED, VIRTUAL, NEVER_WRITTEN, WIDE, FORGED };

/* A restart file with a whole seal whose array x of n numbers is what "kind"
 * says. */
static void put_archive(int kind, hsize_t n) {
  char list[80];
  const hsize_t length = 1 + (hsize_t)snprintf(list, sizeof list, "0 %llu x\n",
                                               (unsigned long long)n);
  hid_t room = H5Pcreate(H5P_FILE_CREATE), made = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_userblock(room, ARCHIVE_SEAL);
  hid_t f = H5Fcreate(path, H5F_ACC_TRUNC, room, H5P_DEFAULT);
  hid_t space = H5Screate_simple(1, &length, NULL);
  hid_t set = H5Dcreate2(f, "list", H5T_NATIVE_UCHAR, space, H5P_DEFAULT,
                         H5P_DEFAULT, H5P_DEFAULT);
  H5Dwrite(set, H5T_NATIVE_UCHAR, H5S_ALL, H5S_ALL, H5P_DEFAULT, list);
  H5Dclose(set);
  H5Sclose(space);
  space = H5Screate_simple(1, &n, NULL);
  H5Gclose(H5Gcreate2(f, "data", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  hid_t type = H5Tcopy(H5T_NATIVE_DOUBLE);
  if (kind == ELSEWHERE) H5Pset_external(made, other, 0, n * sizeof(double));
  if (kind == VIRTUAL) H5Pset_virtual(made, space, other, "x", space);
  if (kind == FORGED) {
    H5Pset_alloc_time(made, H5D_ALLOC_TIME_EARLY);
    H5Pset_fill_time(made, H5D_FILL_TIME_NEVER);
  }
  if (kind == WIDE) type = H5Tarray_create2(H5T_NATIVE_DOUBLE, 1, &n);
  if (kind == LINKED) {
    H5Lcreate_external("b.h5", "/x", f, "data/x", H5P_DEFAULT, H5P_DEFAULT);
  } else {
    set = H5Dcreate2(f, "data/x", type, space, H5P_DEFAULT, made, H5P_DEFAULT);
    ck_assert_int_ge(set, 0);
    if (kind == WHOLE) {
      double x[N] = {0};
      H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, x);
    }
    H5Dclose(set);
  }
  H5Tclose(type);
  H5Sclose(space);
  H5Pclose(made);
  H5Pclose(room);
  H5Fclose(f);
  /* The file ends before its data. */
  if (kind == FORGED) ck_assert_int_eq(truncate(path, 4096), 0);
  ck_assert_int_eq(archive_seal(path), OK);
}

/* Nothing is allocated for arrays that do not stand in it. */
TEST(restart_files_are_not_believed) {
  static const struct {
    int kind;
    hsize_t n;
  } rows[] = {{WHOLE, N},       {ELSEWHERE, 1 << 20},     {LINKED, N},
              {VIRTUAL, N},     {NEVER_WRITTEN, 1 << 28}, {WIDE, N},
              {FORGED, 1 << 24}};
  for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
    archive *a = NULL;
    begin();
    put_set(other, N, H5P_DEFAULT);
    put_archive(rows[k].kind, rows[k].n);
    size_t before = memory_allocated();
    status st = archive_read(path, &a);
    ck_assert_msg(st == (rows[k].kind == WHOLE ? OK : ERR_FILE),
                  "row %zu: status %d", k, (int)st);
    ck_assert_uint_lt(memory_allocated() - before, 1 << 16);
    archive_free(&a);
    end();
  }
}

UNIT_MAIN("dataset")
