/*
 * Datasets of an HDF5 file that others wrote, each call checked.
 */
#ifndef PROTIS_EXCHANGE_DATASET_H
#define PROTIS_EXCHANGE_DATASET_H

#include "base/status.h"

#include <hdf5.h>

typedef struct hdf5_source {
  const char *path; /* of the file, for messages                             */
  hid_t file;
  H5E_auto2_t print; /* how the library told its errors before               */
  void *print_data;
} hdf5_source;

/* Open for reading, the library silent until dataset_close, which is called in
 * any case. "none" ends the message where there is no HDF5 file. */
status dataset_open(const char *path, const char *none, hdf5_source *s);
void dataset_close(hdf5_source *s);

/* 1 if there is a link of that absolute name that can be opened. */
int source_has(const hdf5_source *s, const char *name);
/* One integer. */
status source_int(const hdf5_source *s, const char *name, int *value);
/* All items of a dataset: *n of them, new. Absent: error, unless "optional";
 * then *n = 0. Integers must fit an int, reals must be finite. */
status source_ints(const hdf5_source *s, const char *name, int optional,
                   long *n, int **value);
status source_reals(const hdf5_source *s, const char *name, int optional,
                    long *n, double **value);

#endif
