/*
 * The file of an archive: the seal, then HDF5 behind it (its user block):
 *   /list             text, a line "kind length name" per array, in order
 *   /data/NAME        the arrays
 * Written to a temporary file, sealed, synchronised and renamed, so that a kill
 * at any moment leaves a complete file under one of the two names. HDF5 opens a
 * file only if its seal is valid: damaged lengths inside can make it allocate
 * any amount of memory.
 */
#include "base/archive/dataset.h"
#include "base/archive/file.h"

#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"

#include <errno.h>
#include <hdf5.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static hid_t type_of(archive_kind kind) {
  return kind == ARCHIVE_REAL  ? H5T_NATIVE_DOUBLE
         : kind == ARCHIVE_INT ? H5T_NATIVE_INT
                               : H5T_NATIVE_UCHAR;
}

/* ---- writing ------------------------------------------------------------ */

static status list_items(const archive *a, char **out) {
  size_t size = (size_t)a->n * (ARCHIVE_NAME + 40) + 1, used = 0;
  char *list = memory_new(size, 1);
  if (list == NULL) RAISE(ERR_MEMORY, "memory exhausted: list of an archive");
  for (int i = 0; i < a->n; ++i)
    used +=
        (size_t)snprintf(list + used, size - used, "%d %zu %s\n",
                         (int)a->item[i].kind, a->item[i].n, a->item[i].name);
  *out = list;
  return OK;
}

static status put(hid_t file, const char *path, const char *name, hid_t type,
                  size_t n, const void *data) {
  status st = OK;
  hsize_t dims[1] = {n};
  hid_t space = H5Screate_simple(1, dims, NULL);
  hid_t links = H5Pcreate(H5P_LINK_CREATE),
        plain = H5Pcreate(H5P_DATASET_CREATE);
  hid_t set = -1;
  errno = 0;
  if (space >= 0 && links >= 0 && plain >= 0 &&
      H5Pset_create_intermediate_group(links, 1) >= 0 &&
      H5Pset_obj_track_times(plain, 0) >= 0)
    set = H5Dcreate2(file, name, type, space, links, plain, H5P_DEFAULT);
  if (set < 0 || H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0)
    TRY(text_failed(path, "write", errno));
done:
  if (set >= 0 && H5Dclose(set) < 0 && st == OK)
    st = text_failed(path, "write", errno);
  if (plain >= 0) H5Pclose(plain);
  if (links >= 0) H5Pclose(links);
  if (space >= 0) H5Sclose(space);
  return st;
}

static status put_items(const archive *a, hid_t file, const char *path) {
  OWNED char *list = NULL;
  char name[ARCHIVE_NAME + 8];
  PASS(list_items(a, &list));
  PASS(put(file, path, "/list", H5T_NATIVE_UCHAR, strlen(list) + 1, list));
  for (int i = 0; i < a->n; ++i) {
    const archive_item *it = &a->item[i];
    snprintf(name, sizeof name, "/data/%s", it->name);
    PASS(put(file, path, name, type_of(it->kind), it->n, it->data));
  }
  return OK;
}

static status make_file(const archive *a, const char *path) {
  status st = OK;
  hid_t file = -1, creation = H5Pcreate(H5P_FILE_CREATE);
  TRY(file_clear(path));
  errno = 0;
  if (creation >= 0 && H5Pset_userblock(creation, ARCHIVE_SEAL) >= 0)
    file = H5Fcreate(path, H5F_ACC_EXCL, creation, H5P_DEFAULT);
  if (file < 0) TRY(text_failed(path, "open for writing", errno));
  TRY(put_items(a, file, path));
  errno = 0;
  if (H5Fflush(file, H5F_SCOPE_GLOBAL) < 0)
    TRY(text_failed(path, "write", errno));
done:
  if (file >= 0 && H5Fclose(file) < 0 && st == OK)
    st = text_failed(path, "close", errno);
  if (creation >= 0) H5Pclose(creation);
  return st;
}

status archive_write(archive *a, const char *path, const char *before) {
  status st = OK;
  char *aside = text_path("", path, "tmp");
  if (aside == NULL) FAIL(ERR_MEMORY, "memory exhausted: name of a file");
  H5dont_atexit(); /* the exit handler crashes after a failed write */
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  TRY(make_file(a, aside));
  TRY(archive_seal(aside));
  if (rename(path, before) != 0 && errno != ENOENT)
    TRY(text_failed(before, "replace", errno));
  if (rename(aside, path) != 0) TRY(text_failed(path, "replace", errno));
  file_sync_folder(path);
done:
  if (st != OK && aside != NULL) unlink(aside);
  memory_free(aside);
  return st;
}

/* ---- reading ------------------------------------------------------------ */

static status damaged(const char *path, const char *why) {
  return status_fail(ERR_FILE, __func__, __LINE__, "%s: %s", path, why);
}

/* Length of a dataset of this type, or -1. */
static hssize_t length_of(hid_t set) {
  hid_t space = set >= 0 ? H5Dget_space(set) : -1;
  hssize_t n = space >= 0 ? H5Sget_simple_extent_npoints(space) : -1;
  if (space >= 0) H5Sclose(space);
  return n;
}

/* n items of "size" bytes into a new array; one byte more, zero. */
static status get(hid_t file, const char *path, const char *name, hid_t type,
                  size_t size, size_t *n, void **out) {
  status st = OK;
  const hdf5_source source = {.path = path, .file = file};
  hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
  hid_t stored = set >= 0 ? H5Dget_type(set) : -1;
  hssize_t length = length_of(set);
  *out = NULL;
  if (length < 0 || (*n > 0 && (size_t)length != *n) ||
      H5Tequal(stored, type) <= 0 ||
      H5Dget_storage_size(set) != size * (hsize_t)length)
    TRY(damaged(path, "the restart file is damaged: an array is missing"));
  if (dataset_check(&source, name, set, (hsize_t)length) != OK)
    TRY(damaged(path, "the restart file is damaged: an array is elsewhere"));
  *n = (size_t)length;
  *out = memory_new(*n * size + 1, 1);
  if (*out == NULL) FAIL(ERR_MEMORY, "memory exhausted: %s", path);
  if (H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, *out) < 0)
    TRY(damaged(path, "the restart file is damaged: an array is cut short"));
done:
  if (stored >= 0) H5Tclose(stored);
  if (set >= 0) H5Dclose(set);
  return st;
}

static status get_item(hid_t file, archive *a, const char *line) {
  static const size_t size[] = {sizeof(double), sizeof(int), 1};
  int kind;
  size_t n;
  char name[ARCHIVE_NAME], whole[ARCHIVE_NAME + 8];
  archive_item *i = NULL;
  if (sscanf(line, "%d %zu %199[^\n]", &kind, &n, name) != 3 || kind < 0 ||
      kind > ARCHIVE_BYTE || n == 0)
    PASS(damaged(a->path, "the restart file is damaged: its list"));
  PASS(archive_add(a, name, (archive_kind)kind, n, &i));
  snprintf(whole, sizeof whole, "/data/%s", name);
  PASS(get(file, a->path, whole, type_of(i->kind), size[kind], &n, &i->own));
  i->data = i->own;
  return OK;
}

static status get_items(hid_t file, archive *a) {
  size_t n = 0;
  OWNED void *list = NULL;
  PASS(get(file, a->path, "/list", H5T_NATIVE_UCHAR, 1, &n, &list));
  for (const char *line = list; *line != '\0'; ++line) {
    PASS(get_item(file, a, line));
    line = strchr(line, '\n');
    if (line == NULL) break;
  }
  return OK;
}

status archive_read(const char *path, archive **out) {
  status st = OK;
  archive *a = NULL;
  hid_t file = -1;
  *out = NULL;
  H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  H5Lunregister(H5L_TYPE_EXTERNAL);
  TRY(archive_check_seal(path));
  NEW(a, 1);
  a->path = memory_text(path);
  if (a->path == NULL) FAIL(ERR_MEMORY, "memory exhausted: name of a file");
  file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0) TRY(damaged(path, "this is no restart file of Protis"));
  TRY(get_items(file, a));
  *out = a;
  a = NULL;
done:
  if (file >= 0) H5Fclose(file);
  archive_free(a);
  return st;
}
