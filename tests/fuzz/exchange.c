/*
 * libFuzzer: contact problems and complementarity problems of others. By the
 * first byte the rest is a text, or it chooses the datasets of a file in the
 * layout of FCLIB: which are there, their lengths and values, and bytes of the
 * file to be damaged then. It is refused with an error or read, and then all is
 * finite.
 */
#include "base/memory.h"
#include "exchange/exchange.h"
#include "support/fuzz.h"
#include "support/fuzz_file.h"

#include <hdf5.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { MOST = 60 };

static const char *const roots[] = {"fclib_local", "fclib_global"};
static const char *const matrices[] = {"W", "V", "R", "M", "H", "G"};
static const char *const parts[] = {"m", "n", "nz", "nzmax", "p", "i", "x"};
static const char *const vectors[] = {"q", "s", "mu", "f", "w", "b"};

static void put(hid_t file, const char *name, fuzz_bytes *b, int is_real) {
  int n = fuzz_below(b, 8) == 0 ? fuzz_below(b, MOST) : 1 + fuzz_below(b, 9);
  double real[MOST];
  int whole[MOST];
  hsize_t size[1] = {(hsize_t)n};
  for (int k = 0; k < n; ++k) {
    whole[k] = fuzz_int(b);
    real[k] = fuzz_real(b);
  }
  hid_t links = H5Pcreate(H5P_LINK_CREATE);
  hid_t space = H5Screate_simple(1, size, NULL);
  hid_t type = is_real ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT;
  H5Pset_create_intermediate_group(links, 1);
  hid_t set =
      H5Dcreate2(file, name, type, space, links, H5P_DEFAULT, H5P_DEFAULT);
  if (set >= 0) {
    const void *data = is_real ? (const void *)real : whole;
    H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data);
    H5Dclose(set);
  }
  H5Sclose(space);
  H5Pclose(links);
}

static void put_matrix(hid_t file, const char *group, fuzz_bytes *b) {
  char name[80];
  for (size_t k = 0; k < sizeof parts / sizeof *parts; ++k) {
    if (fuzz_below(b, 16) == 0) continue;
    snprintf(name, sizeof name, "%s/%s", group, parts[k]);
    put(file, name, b, parts[k][0] == 'x');
  }
}

/* A file of choices; the name of it. */
static const char *make_file(fuzz_bytes *b) {
  const char *path = fuzz_file("h5", NULL, 0);
  const char *root = roots[fuzz_below(b, 2)];
  char name[80];
  hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  if (file < 0) abort();
  snprintf(name, sizeof name, "/%s/spacedim", root);
  put(file, name, b, 0);
  for (size_t k = 0; k < sizeof matrices / sizeof *matrices; ++k) {
    snprintf(name, sizeof name, "/%s/%s", root, matrices[k]);
    if (fuzz_below(b, 3) > 0) put_matrix(file, name, b);
  }
  for (size_t k = 0; k < sizeof vectors / sizeof *vectors; ++k) {
    snprintf(name, sizeof name, "/%s/vectors/%s", root, vectors[k]);
    if (fuzz_below(b, 8) > 0) put(file, name, b, 1);
  }
  H5Fclose(file);
  return path;
}

static void use(const exchange_problem *p) {
  size_t m = (size_t)p->m;
  for (size_t k = 0; k < m * m; ++k)
    if (!isfinite(p->matrix[k])) abort();
  for (size_t k = 0; k < m; ++k)
    if (!isfinite(p->load[k])) abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  fuzz_bytes b = {data, size};
  exchange_problem *p = NULL;
  message_log *log;
  if (message_log_new(&log) != OK) abort();
  unsigned kind = fuzz_byte(&b) % 8;
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  const char *path = kind == 0   ? fuzz_file("dat", b.at, b.left)
                     : kind == 1 ? fuzz_file("h5", b.at, b.left)
                                 : make_file(&b);
  status st =
      exchange_read(path, EXCHANGE_BY_CONTENT, &(place){.file = "d"}, log, &p);
  if ((st == OK) != (p != NULL)) abort();
  if (st != OK && message_count(log, ERROR) == 0 && st != ERR_SINGULAR) abort();
  if (p != NULL) use(p);
  memory_free(p);
  memory_free(log);
  status_clear();
  if (memory_in_use() != 0) abort();
  return 0;
}
