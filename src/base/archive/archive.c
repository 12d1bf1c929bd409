/* The arrays of an archive in memory. */
#include "base/archive/archive.h"

#include "base/archive/dataset.h"
#include "base/base.h"
#include "base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <unistd.h>

enum { ARCHIVE_NAME = 200 };
typedef enum { ARCHIVE_REAL, ARCHIVE_INT, ARCHIVE_BYTE } archive_kind;

typedef struct archive_item {
  char name[ARCHIVE_NAME];
  archive_kind kind;
  size_t n;
  const void *data; /* [n] of the kind */
  void *own;        /* it, if it is to be freed */
} archive_item;

struct archive {
  char *path;               /* owned; of the file it comes from, or NULL */
  char group[ARCHIVE_NAME]; /* present one with its last slash, or "" */
  int no_cpu;               /* 1: see archive_leave_out_cpu */
  int n, capacity;
  archive_item *item; /* [n] in the order they were named */
};

/*
 * The seal of an archive, text before the bytes of HDF5:
 *   Protis restart, layout 3
 *   BYTES CHECKSUM       of what follows the seal: their number; FNV-1a, 64
 * bits
 */

enum { SHORT = 256 }; /* bytes, up to here an array is copied */

status archive_new(archive **out) {
  PASS_NEW(*out, 1);
  return OK;
}

void archive_free(archive **p) {
  archive *a = *p;
  if (a == NULL) return;
  for (int i = 0; i < a->n; ++i) memory_free(a->item[i].own);
  RELEASE(a->item, a->path, a);
}

void archive_leave_out_cpu(archive *a) { a->no_cpu = 1; }
int archive_has_cpu(const archive *a) { return !a->no_cpu; }

int archive_reads(const archive *a) { return a->path != NULL; }

archive *archive_enter(archive *a, const char *group) {
  text_add(a->group, sizeof a->group, "%s/", group);
  return a;
}

void archive_leave(archive *const *a) {
  char *group = (*a)->group;
  size_t used = strlen(group);
  if (used > 0) group[--used] = '\0';
  while (used > 0 && group[used - 1] != '/') group[--used] = '\0';
}

const char *archive_group(const archive *a) { return a->group; }

void archive_go(archive *a, const char *group) {
  snprintf(a->group, sizeof a->group, "%s", group);
}

static void full_name(const archive *a, const char *name,
                      char text[ARCHIVE_NAME]) {
  snprintf(text, ARCHIVE_NAME, "%s%s", a->group, name);
}

static archive_item *find_whole(const archive *a, const char *text) {
  for (int i = 0; i < a->n; ++i)
    if (strcmp(a->item[i].name, text) == 0) return &a->item[i];
  return NULL;
}

static archive_item *find(const archive *a, const char *name) {
  char text[ARCHIVE_NAME];
  full_name(a, name, text);
  return find_whole(a, text);
}

/* A new item without data; its place may move with the next one. */
static status archive_add(archive *a, const char *name, archive_kind kind,
                          size_t n, archive_item **out) {
  PASS_GROW(a->item, a->n, a->capacity);
  *out = &a->item[a->n++];
  **out = (archive_item){.kind = kind, .n = n};
  snprintf((*out)->name, sizeof(*out)->name, "%s", name);
  return OK;
}

static size_t item_bytes(const archive_item *i) {
  static const size_t size[] = {sizeof(double), sizeof(int), 1};
  return size[i->kind] * i->n;
}

static status put(archive *a, const char *name, archive_kind kind, void *v,
                  size_t n) {
  archive_item *i = NULL;
  char text[ARCHIVE_NAME];
  full_name(a, name, text);
  PASS(archive_add(a, text, kind, n, &i));
  i->data = v;
  size_t bytes = item_bytes(i);
  if (bytes > SHORT) return OK;
  PASS_GET(i->own, memory_new(bytes, 1));
  memcpy(i->own, v, bytes);
  i->data = i->own;
  return OK;
}

static status take(const archive *a, const char *name, archive_kind kind,
                   void *v, size_t n) {
  const archive_item *i = find(a, name);
  if (i == NULL || i->kind != kind || i->n != n)
    RAISE(ERR_FILE, "%s: no array %s%s of %zu values: it is of another model",
          a->path, a->group, name, n);
  memcpy(v, i->data, item_bytes(i));
  return OK;
}

static status pass(archive *a, const char *name, archive_kind kind, void *v,
                   size_t n) {
  if (n == 0) return OK;
  return archive_reads(a) ? take(a, name, kind, v, n)
                          : put(a, name, kind, v, n);
}

status archive_pass_on(const archive *from, const char *group, archive *to) {
  for (EACH(const archive_item, x, from->item, from->n)) {
    archive_item *i = NULL;
    if (strncmp(x->name, group, strlen(group)) != 0) continue;
    if (find_whole(to, x->name) != NULL) continue;
    PASS(archive_add(to, x->name, x->kind, x->n, &i));
    i->data = x->data;
  }
  return OK;
}

status archive_reals(archive *a, const char *name, double *v, size_t n) {
  return pass(a, name, ARCHIVE_REAL, v, n);
}

status archive_ints(archive *a, const char *name, int *v, size_t n) {
  return pass(a, name, ARCHIVE_INT, v, n);
}

status archive_bytes(archive *a, const char *name, void *v, size_t n) {
  return pass(a, name, ARCHIVE_BYTE, v, n);
}

status archive_text(archive *a, const char *name, char **text) {
  const archive_item *i = find(a, name);
  const size_t n = i != NULL ? i->n : 0;
  PASS_NEW(*text, n + 1);
  return archive_bytes(a, name, *text, n);
}

/*
 * The file of an archive: the seal, then HDF5 behind it (its user block):
 *   /list             text, a line "kind length name" per array, in order
 *   /data/NAME        the arrays
 * Written to a temporary file, sealed, synchronised and renamed, so that a kill
 * at any moment leaves a complete file under one of the two names. HDF5 opens a
 * file only if its seal is valid: damaged lengths inside can make it allocate
 * any amount of memory.
 */

enum { PART = 1 << 16 };

static const char mark[] = "Protis restart, layout ";
static const char layout[] = "3\n";

typedef struct content {
  uint64_t bytes, checksum;
} content;

/* What follows the seal; ERR_FILE if it cannot be read. */
static status sum_up(int fd, const char *path, content *c) {
  unsigned char part[PART];
  ssize_t n;
  *c = (content){0, 14695981039346656037u};
  while ((n = pread(fd, part, PART, (off_t)(ARCHIVE_SEAL + c->bytes))) > 0) {
    for (ssize_t i = 0; i < n; ++i)
      c->checksum = (c->checksum ^ part[i]) * 1099511628211u;
    c->bytes += (uint64_t)n;
  }
  if (n < 0) PASS(text_failed(path, "read", errno));
  return OK;
}

static void write_text(const content *c, char text[ARCHIVE_SEAL]) {
  memset(text, 0, ARCHIVE_SEAL);
  snprintf(text, ARCHIVE_SEAL, "%s%s%" PRIu64 " %016" PRIx64 "\n", mark, layout,
           c->bytes, c->checksum);
}

static status write_whole(int fd, const char *path, const char *text) {
  size_t at = 0;
  while (at < ARCHIVE_SEAL) {
    ssize_t n = pwrite(fd, text + at, ARCHIVE_SEAL - at, (off_t)at);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) PASS(text_failed(path, "write", errno));
    at += n;
  }
  return OK;
}

status archive_seal(const char *path) {
  content c;
  char text[ARCHIVE_SEAL];
  ENDS_BY(descriptor_leave) int fd = open(path, O_RDWR | O_CLOEXEC);
  if (fd < 0) PASS(text_failed(path, "open", errno));
  PASS(sum_up(fd, path, &c));
  write_text(&c, text);
  PASS(write_whole(fd, path, text));
  if (fsync(fd) != 0) PASS(text_failed(path, "write", errno));
  return OK;
}

static status refuse(const char *path, const char *why) {
  return status_fail(ERR_FILE, __func__, __LINE__, "%s: %s", path, why);
}

/* ERR_FILE: not there, without a seal, of another layout, not as sealed. */
static status archive_check_seal(const char *path) {
  content c;
  char text[ARCHIVE_SEAL] = "", wanted[ARCHIVE_SEAL];
  const char *why;
  ENDS_BY(descriptor_leave)
  int fd = file_descriptor(AT_FDCWD, path, O_RDONLY, &why);
  if (fd < 0) RAISE(ERR_FILE, "%s: cannot read: %s", path, why);
  if (pread(fd, text, sizeof text, 0) < 0)
    PASS(text_failed(path, "read", errno));
  if (strncmp(text, mark, strlen(mark)) != 0)
    PASS(refuse(path, "this is no restart file of Protis"));
  if (strncmp(text + strlen(mark), layout, strlen(layout)) != 0)
    PASS(refuse(path,
                "the restart file has the layout of another version of Protis; "
                "continue with that one, or start the run without --restart"));
  PASS(sum_up(fd, path, &c));
  write_text(&c, wanted);
  if (memcmp(text, wanted, sizeof text) != 0)
    PASS(refuse(path, "the restart file is damaged: wrong checksum"));
  return OK;
}

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
    used += snprintf(list + used, size - used, "%d %zu %s\n",
                     (int)a->item[i].kind, a->item[i].n, a->item[i].name);
  *out = list;
  return OK;
}

static status write_dataset(hid_t file, const char *path, const char *name,
                            hid_t type, size_t n, const void *data) {
  hsize_t dims[1] = {n};
  HELD hid_t space = H5Screate_simple(1, dims, NULL);
  HELD hid_t links = H5Pcreate(H5P_LINK_CREATE);
  HELD hid_t plain = H5Pcreate(H5P_DATASET_CREATE);
  hid_t set = -1;
  errno = 0;
  if (space >= 0 && links >= 0 && plain >= 0 &&
      H5Pset_create_intermediate_group(links, 1) >= 0 &&
      H5Pset_obj_track_times(plain, 0) >= 0)
    set = H5Dcreate2(file, name, type, space, links, plain, H5P_DEFAULT);
  int bad =
      set < 0 || H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0;
  int why = errno;
  if (set >= 0 && H5Dclose(set) < 0 && !bad) {
    bad = 1;
    why = errno;
  }
  return bad ? text_failed(path, "write", why) : OK;
}

static status put_items(const archive *a, hid_t file, const char *path) {
  char name[ARCHIVE_NAME + 8];
  OWNED_OF(char, list, list_items(a, &list));
  PASS(write_dataset(file, path, "/list", H5T_NATIVE_UCHAR, strlen(list) + 1,
                     list));
  for (EACH(const archive_item, it, a->item, a->n)) {
    snprintf(name, sizeof name, "/data/%s", it->name);
    PASS(write_dataset(file, path, name, type_of(it->kind), it->n, it->data));
  }
  return OK;
}

static status make_file(const archive *a, const char *path) {
  status st = OK;
  hid_t file = -1;
  HELD hid_t creation = H5Pcreate(H5P_FILE_CREATE);
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

/* Length of a dataset of this type, or -1. */
static hssize_t length_of(hid_t set) {
  HELD hid_t space = set >= 0 ? H5Dget_space(set) : -1;
  return space >= 0 ? H5Sget_simple_extent_npoints(space) : -1;
}

/* n items of "size" bytes into a new array; one byte more, zero. */
static status get(hid_t file, const char *path, const char *name, hid_t type,
                  size_t size, size_t *n, void **out) {
  const hdf5_source source = {.path = path, .file = file};
  HELD hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
  HELD hid_t stored = set >= 0 ? H5Dget_type(set) : -1;
  hssize_t length = length_of(set);
  *out = NULL;
  if (length < 0 || (*n > 0 && (size_t)length != *n) ||
      H5Tequal(stored, type) <= 0 ||
      H5Dget_storage_size(set) != size * (hsize_t)length)
    return refuse(path, "the restart file is damaged: an array is missing");
  if (dataset_check(&source, name, set, (hsize_t)length) != OK)
    return refuse(path, "the restart file is damaged: an array is elsewhere");
  *n = (size_t)length;
  PASS_GET(*out, memory_new(*n * size + 1, 1));
  if (H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, *out) < 0)
    return refuse(path, "the restart file is damaged: an array is cut short");
  return OK;
}

static status get_item(hid_t file, archive *a, const char *line) {
  static const size_t size[] = {sizeof(double), sizeof(int), 1};
  int kind;
  size_t n;
  char name[ARCHIVE_NAME], whole[ARCHIVE_NAME + 8];
  archive_item *i = NULL;
  if (sscanf(line, "%d %zu %199[^\n]", &kind, &n, name) != 3 || kind < 0 ||
      kind > ARCHIVE_BYTE || n == 0)
    PASS(refuse(a->path, "the restart file is damaged: its list"));
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
  HELD hid_t file = -1;
  H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  H5Lunregister(H5L_TYPE_EXTERNAL);
  *out = NULL;
  PASS(archive_check_seal(path));
  PASS_NEW(*out, 1);
  archive *a = *out;
  PASS_GET(a->path, memory_text(path));
  file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0) PASS(refuse(path, "this is no restart file of Protis"));
  return get_items(file, a);
}
