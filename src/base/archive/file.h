/* What the files of this folder share. */
#ifndef PROTIS_ARCHIVE_FILE_H
#define PROTIS_ARCHIVE_FILE_H

#include "base/archive/archive.h"

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

/* A new item without data; its place may move with the next one. */
status archive_add(archive *a, const char *name, archive_kind kind, size_t n,
                   archive_item **out);

/* Bytes before those of HDF5. */
enum { ARCHIVE_SEAL = 512 };
/* Write the seal of a complete file and synchronise it. ERR_FILE. */
status archive_seal(const char *path);
/* ERR_FILE: not there, without a seal, of another layout, not as sealed. */
status archive_check_seal(const char *path);

#endif
