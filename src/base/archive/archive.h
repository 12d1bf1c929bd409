/*
 * Named arrays saved in a file and read back bit for bit: the state from which
 * a run is continued. One function of a module serves both directions: it names
 * each of its arrays once, and archive_reads() says whether they are read or
 * saved.
 *
 * The file is HDF5 with one dataset per array, a list of them in the order they
 * were named, and a checksum of all.
 */
#pragma once

#include "base/status.h"

#include <stddef.h>

typedef struct archive archive;

status archive_new(archive **out); /* empty, for writing */
void archive_free(archive **a);    /* accepts that of NULL */
/* 1: the archive was read from a file. */
int archive_reads(const archive *a);

/* CPU seconds are left out: equal runs give equal bytes. */
void archive_leave_out_cpu(archive *a);
int archive_has_cpu(const archive *a);

/* IN_GROUP(a, group): names are those of a group, from here to the end of the
 * block; names of groups nest. */
#define IN_GROUP(a, group)                                                   \
  archive *const in_group_ __attribute__((cleanup(archive_leave), unused)) = \
      archive_enter(a, group)
archive *archive_enter(archive *a, const char *group);
void archive_leave(archive *const *a);
/* The full name of the present group, to return to: "" at first. */
const char *archive_group(const archive *a);
void archive_go(archive *a, const char *group);
/* All arrays of a group of an archive from a file into one to be filled, under
 * the same names, but those it has; borrowed from it until archive_write.
 * ERR_MEMORY. */
status archive_pass_on(const archive *from, const char *group, archive *to);

/*
 * One array. Writing: v[n] is borrowed until archive_write, except short
 * arrays, which are copied. Reading: into v[n]; ERR_FILE if there is none of
 * that kind and length. n = 0: nothing to do.
 */
status archive_reals(archive *a, const char *name, double *v, size_t n);
status archive_ints(archive *a, const char *name, int *v, size_t n);
status archive_bytes(archive *a, const char *name, void *v, size_t n);
/* Bytes read as a new text. */
status archive_text(archive *a, const char *name, char **text);

/* Written to a temporary file, synchronised, renamed; the file that was at
 * "path" becomes "before". ERR_FILE names the file. */
status archive_write(archive *a, const char *path, const char *before);
/* ERR_FILE: missing, not a file of Protis, of another layout, damaged. */
status archive_read(const char *path, archive **out);
/* Bytes of the seal, before those of HDF5. */
enum { ARCHIVE_SEAL = 512 };
/* Write the seal of a complete file and synchronise it. ERR_FILE. */
status archive_seal(const char *path);
