/* The arrays of an archive in memory. */
#include "base/archive/file.h"

#include "base/memory.h"

#include <stdio.h>
#include <string.h>

enum { SHORT = 256 }; /* bytes, up to here an array is copied */

status archive_new(archive **out) {
  PASS_NEW(*out, 1);
  return OK;
}

void archive_free(archive *a) {
  if (a == NULL) return;
  for (int i = 0; i < a->n; ++i) memory_free(a->item[i].own);
  RELEASE(a->item, a->path, a);
}

void archive_leave_out_cpu(archive *a) { a->no_cpu = 1; }
int archive_has_cpu(const archive *a) { return !a->no_cpu; }

int archive_reads(const archive *a) { return a->path != NULL; }

void archive_enter(archive *a, const char *group) {
  size_t used = strlen(a->group);
  snprintf(a->group + used, sizeof a->group - used, "%s/", group);
}

void archive_leave(archive *a) {
  size_t used = strlen(a->group);
  if (used > 0) a->group[--used] = '\0';
  while (used > 0 && a->group[used - 1] != '/') a->group[--used] = '\0';
}

const char *archive_group(const archive *a) { return a->group; }

void archive_go(archive *a, const char *group) {
  snprintf(a->group, sizeof a->group, "%s", group);
}

static void full_name(const archive *a, const char *name,
                      char text[ARCHIVE_NAME]) {
  snprintf(text, ARCHIVE_NAME, "%s%s", a->group, name);
}

static archive_item *find(const archive *a, const char *name) {
  char text[ARCHIVE_NAME];
  full_name(a, name, text);
  for (int i = 0; i < a->n; ++i)
    if (strcmp(a->item[i].name, text) == 0) return &a->item[i];
  return NULL;
}

size_t archive_length(const archive *a, const char *name) {
  const archive_item *i = find(a, name);
  return i != NULL ? i->n : 0;
}

status archive_add(archive *a, const char *name, archive_kind kind, size_t n,
                   archive_item **out) {
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
  i->own = memory_new(bytes, 1);
  if (i->own == NULL) RAISE(ERR_MEMORY, "memory exhausted: array %s", name);
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

status archive_reals(archive *a, const char *name, double *v, size_t n) {
  return pass(a, name, ARCHIVE_REAL, v, n);
}

status archive_ints(archive *a, const char *name, int *v, size_t n) {
  return pass(a, name, ARCHIVE_INT, v, n);
}

status archive_bytes(archive *a, const char *name, void *v, size_t n) {
  return pass(a, name, ARCHIVE_BYTE, v, n);
}
