/*
 * Scanner of a file of gmsh: lines of words in ASCII, numbers of fixed size in
 * binary sections. Every number is checked, every count is compared with the
 * bytes that follow it. A failure names the file and the line, or the byte
 * where the file is binary. For src/mesh/msh and src/model/check.
 *
 * Sections stand between $Name and $EndName, each on a line of its own.
 */
#pragma once

#include "base/status.h"

#include <stddef.h>

typedef struct scan {
  const char *path; /* borrowed */
  status wrong;     /* code of what is wrong in the file */
  char *data;       /* [size+1] the file and a zero */
  size_t size, at;  /* bytes; of them read */
  double version;   /* of $MeshFormat; 0: not read yet */
  int binary_file;  /* as $MeshFormat says */
  int binary;       /* what is read now */
  int swapped;      /* bytes of binary numbers come in the other order */
} scan;

enum { SCAN_NAME = 64 };

/* The whole file into memory. ERR_FILE if it cannot be read or is no plain
 * file, ERR_MEMORY. */
status scan_open(scan *s, const char *path, status wrong);
void scan_close(scan *s); /* accepts one never opened */
/* s->wrong, with the place and the text in the record. */
status scan_fail(const scan *s, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* The next section; *name = "" at the end of the file. $MeshFormat, which
 * comes before all that depends on it, is read on the way. */
status scan_section(scan *s, char name[SCAN_NAME]);
status scan_skip(scan *s, const char *name); /* to the end of the section */
/* $EndName must follow: "what" of the section are complete. */
status scan_end(scan *s, const char *name, const char *what);
/* Numbers of a section are binary from here on, if the file is. */
void scan_start_binary(scan *s);

status scan_int(scan *s, int *value);     /* binary: 4 bytes */
status scan_size(scan *s, size_t *value); /* binary: 8 bytes */
status scan_real(scan *s, double *value); /* binary: 8 bytes */
status scan_line(scan *s);                /* end of a line, none in binary */
/* A number of things that take at least so many bytes each, in a file of either
 * kind; they must fit into the rest of the file. */
status scan_fits(const scan *s, size_t n, size_t text_bytes,
                 size_t binary_bytes, const char *what);
/* "text" to the end of the line, without the quotes; borrowed. */
status scan_quoted(scan *s, const char **text, size_t *length);
