/* Datasets of an HDF5 file that others wrote, each call checked. */
#pragma once

#include "base/status.h"

#include <hdf5.h>

typedef struct hdf5_source {
  const char *path; /* of the file, for messages */
  hid_t file;
  int fd;            /* by which it was opened */
  H5E_auto2_t print; /* error output of the library before */
  void *print_data;
} hdf5_source;

/* HELD hid_t a = ...: closed where the name ends, whatever it is of. */
#define HELD __attribute__((cleanup(dataset_leave)))
void dataset_leave(hid_t *id); /* accepts an invalid one */

/* Largest number of items where nothing else bounds it. */
enum { MOST_ITEMS = 1 << 30 };

/* Open for reading (base/system/input.h), the library silent until
 * dataset_close, which is called in any case. Links into other files are not
 * followed. */
status dataset_open(const char *path, hdf5_source *s);
void dataset_close(hdf5_source *s);

/* The data of an open dataset are stored in this file, with no filter but
 * deflate (without --safe also shuffle and fletcher32), and its "items" are
 * possible with the bytes there. ERR_DECK. */
status dataset_check(const hdf5_source *s, const char *name, hid_t set,
                     hsize_t items);

/* 1 if there is a link of that absolute name that can be opened. */
int source_has(const hdf5_source *s, const char *name);
/* One integer. */
status source_int(const hdf5_source *s, const char *name, int *value);
/* All items of a dataset: *n of them, at most "most", new. Absent: error,
 * unless "optional"; then *n = 0. Integers must fit an int, reals must be
 * finite. */
status source_ints(const hdf5_source *s, const char *name, int optional,
                   long most, long *n, int **value);
status source_reals(const hdf5_source *s, const char *name, int optional,
                    long most, long *n, double **value);
