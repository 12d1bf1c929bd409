/*
 * JOB.h5 inside this folder.
 *
 * All groups and datasets are made before the first increment (contiguous,
 * allocated at once, no fill, no object times) and the space is reserved. From
 * then on HDF5 is not called: raw numbers are written at the offsets of the
 * datasets, so that no metadata ever changes and the file is readable after a
 * kill at any moment. The time of a row or record is NaN until all of it is
 * written.
 */
#pragma once

#include "output/hdf5/hdf5.h"

#include <stdint.h>
#include <sys/types.h>

/* Values written at once; records and rows allocated at first: a longer run
 * allocates more when needed. */
enum { CHUNK = 4096, MOST_RECORDS = 100000, MOST_ROWS = 10000000 };

typedef enum { DATA_REAL, DATA_INT, DATA_NUMBER, DATA_TEXT } data_type;

typedef struct fixed_data { /* written once */
  char path[240];
  data_type type;
  int rows, columns; /* columns 1: a vector; DATA_TEXT: rows bytes */
  const void *data;  /* NULL once the first file is written */
  void *own;         /* what to free then */
} fixed_data;

typedef struct hdf5_layout {
  int n_row, n_record;             /* room for */
  off_t *fixed;                    /* [n_fixed] offset in the file, bytes; 0: no
                                      dataset */
  off_t *history;                  /* [n_field] of PER_INCREMENT, PER_CONTACT */
  off_t *record;                   /* [n_field * n_record] of the others, field
                                      by field */
  off_t record_time, record_total; /* of "/fields/time" and "/fields/total" */
} hdf5_layout;

/* A group of records of which HDF5 has made the first. */
typedef struct record_group {
  uint64_t group, set; /* addresses of their headers; 0: it has no records */
  size_t bytes;        /* of a record */
  off_t *offset;       /* [n_record] of the records in the file */
} record_group;

struct hdf5_file {
  const model *m;
  const mesh *msh;
  const output_options *o;
  char *path, *aside;
  int fd; /* -1: not open */
  int n_field, cap_field, n_fixed, cap_fixed;
  hdf5_field *fields;
  fixed_data *fixed;
  int n_contact_node, n_contact_face;
  int *contact_node; /* [n_contact_node] ids of the nodes of all
                        contact groups, ascending: they stay when
                        the surface changes */
  int *surface_id;   /* [n_contact_node] place in the surface, or
                        -1 */
  hdf5_layout now;
  int n_row, n_record, cap_time; /* written */
  double *times;                 /* [n_record] */
};

/* content.c: fixed data and fields, into h. */
status hdf5_content(hdf5_file *h);
/* The times stand in "/history/time". */
int hdf5_is_history(const hdf5_field *f);
/* Items of a field in one record; 1 for histories. */
int hdf5_items(const hdf5_file *h, const hdf5_field *f);
size_t fixed_bytes(const fixed_data *d);

/* layout.c: make the temporary file "aside" with space for rows and records; l
 * gets the offsets. */
status hdf5_layout_make(const hdf5_file *h, int n_row, int n_record,
                        hdf5_layout *l);
/* records.c: all of data at an offset of the file "path". */
status hdf5_put(int fd, const char *path, const void *data, size_t bytes,
                off_t offset);
/* Records 2 to n > 1 of all groups and their offsets; the file is
 * closed. ERR_FILE, ERR_MEMORY. */
status hdf5_records_make(const char *path, int n, int n_group,
                         const record_group *groups);
/* That of the file "path"; without the fixed data. */
status hdf5_layout_read(const hdf5_file *h, hdf5_layout *l);
void hdf5_layout_free(hdf5_layout *l);
