/* JOB.h5 and JOB.xdmf: mesh, fields and histories for viewers and programs. */
#pragma once

#include "output/listing/job.h"

typedef struct hdf5_file hdf5_file;

/* A field of JOB.h5: one dataset per record under GROUP/NAME, or one row per
 * increment in GROUP/NAME. */
typedef struct hdf5_field {
  const char *name;
  char group[200]; /* "/fields", "/contact", "/history", "/totals/NAME" */
  entity of;
  int id;                /* of the contact for "/totals" */
  int n_part;            /* 1, 3 or 6: xx, xy, xz, yy, yz, zz */
  const column *part[6]; /* NULL: zero */
} hdf5_field;

typedef struct hdf5_count { /* what has been written */
  int rows, records;
} hdf5_count;
/* NULL in *out if no step requires fields. before: continue the file after
 * these; NULL: a new one. */
status hdf5_open(const model *m, const mesh *msh, const output_options *o,
                 const hdf5_count *before, hdf5_file **out);
/* Synchronise; h NULL: nothing. */
status hdf5_sync(hdf5_file *h, hdf5_count *n);
/* The increment is in the file when this returns OK. */
status hdf5_increment(hdf5_file *h, const state *s);
/* Cut what was not used if "finished"; frees h; accepts NULL. */
status hdf5_close(hdf5_file *h, int finished);

int hdf5_records(const hdf5_file *h); /* written so far */
/* Name of record i (from 0) below GROUP/NAME. */
void hdf5_record_name(char *text, size_t size, int i);

/* JOB.xdmf; written to a temporary file and renamed. */
status xdmf_write(const hdf5_file *h, const char *path);
/* The last record of the body or of the contact alone, the same way; nothing if
 * there is none. */
status xdmf_write_last(const hdf5_file *h, int of_contact, const char *path);
