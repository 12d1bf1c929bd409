/* Folders and files of the tests (folder.h), without processes of their own. */
#define _GNU_SOURCE /* nftw */
#include "support/folder.h"

#include "base/base.h"

#include <check.h>
#include <ftw.h>
#include <sys/stat.h>
#include <unistd.h>

char *folder_new(char path[64]) {
  const char *base = getenv("TMPDIR");
  int n =
      snprintf(path, 64, "%s/protis-test-XXXXXX", base != NULL ? base : "/tmp");
  ck_assert_int_lt(n, 64);
  ck_assert_ptr_nonnull(mkdtemp(path));
  return path;
}

/* Folders that cannot be written are in some tests. */
static int allow(const char *path, const struct stat *is, int kind,
                 struct FTW *at) {
  return kind == FTW_D || kind == FTW_DNR ? chmod(path, is->st_mode | 0700) : 0;
}

static int discard(const char *path, const struct stat *is, int kind,
                   struct FTW *at) {
  (void)is, (void)kind, (void)at;
  return remove(path);
}

void folder_remove(const char *path) {
  ck_assert_int_eq(nftw(path, allow, 8, FTW_PHYS), 0);
  ck_assert_int_eq(nftw(path, discard, 8, FTW_PHYS | FTW_DEPTH), 0);
}

void folder_leave(char (*path)[64]) { folder_remove(*path); }

char *file_read(const char *path, size_t *size) {
  FILE *f = fopen(path, "rb");
  if (f == NULL) return NULL;
  fseek(f, 0, SEEK_END);
  const long n = ftell(f);
  rewind(f);
  char *text = calloc((size_t)n + 1, 1);
  ck_assert_ptr_nonnull(text);
  ck_assert_uint_eq(fread(text, 1, (size_t)n, f), (size_t)n);
  fclose(f);
  if (size != NULL) *size = (size_t)n;
  return text;
}

char *folder_file(const char *path, const char *name, size_t *size) {
  char full[256];
  snprintf(full, sizeof full, "%s/%s", path, name);
  return file_read(full, size);
}

void folder_copy(const char *path, const char *file) {
  char copy[512];
  size_t size;
  const char *slash = strrchr(file, '/');
  char *bytes = file_read(file, &size);
  ck_assert_msg(bytes != NULL, "%s is not there", file);
  snprintf(copy, sizeof copy, "%s/%s", path, slash != NULL ? slash + 1 : file);
  FILE *f = fopen(copy, "wb");
  ck_assert_msg(f != NULL, "%s cannot be written", copy);
  ck_assert_uint_eq(fwrite(bytes, 1, size, f), size);
  ck_assert_int_eq(fclose(f), 0);
  free(bytes);
}
