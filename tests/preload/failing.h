/*
 * Linked in front of what the sources call of the C library and of HDF5
 * (--wrap; the list is read by the Makefile): each of these calls can be told
 * to fail. In one process that forks: the counts are shared with its children,
 * which run the program as protis_main.
 *
 * A point is the n-th call of one function. Those worth a try come from a run
 * that is only watched: the stack of each call is looked at, and a point is
 * kept if a return address is in it that no point had before, so that every
 * way on which a failure can be handed up is gone once.
 */
#pragma once

#include "base/archive/archive.h"
#include "deck/expression.h"
#include "mesh/raw.h"

#include <dirent.h>
#include <hdf5.h>
#include <stddef.h>
#include <stdio.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

/* clang-format off */
/* X(function, answer, answer of a failure, parameters, arguments): the call is
 * not made. */
#define FAILING_LIST(X)                                                       \
  X(calloc, void *, NULL, (size_t n, size_t size), (n, size))                 \
  X(H5Fcreate, hid_t, -1, (const char *p, unsigned f, hid_t a, hid_t b),      \
    (p, f, a, b))                                                             \
  X(H5Fopen, hid_t, -1, (const char *p, unsigned f, hid_t a), (p, f, a))      \
  X(H5Fflush, herr_t, -1, (hid_t f, H5F_scope_t s), (f, s))                   \
  X(H5Fis_hdf5, htri_t, -1, (const char *p), (p))                             \
  X(H5Dcreate2, hid_t, -1, (hid_t f, const char *s, hid_t t, hid_t e,         \
    hid_t a, hid_t b, hid_t c), (f, s, t, e, a, b, c))                        \
  X(H5Dopen2, hid_t, -1, (hid_t f, const char *s, hid_t a), (f, s, a))        \
  X(H5Dwrite, herr_t, -1, (hid_t d, hid_t t, hid_t a, hid_t b, hid_t c,       \
    const void *v), (d, t, a, b, c, v))                                       \
  X(H5Dread, herr_t, -1, (hid_t d, hid_t t, hid_t a, hid_t b, hid_t c,        \
    void *v), (d, t, a, b, c, v))                                             \
  X(H5Dget_offset, haddr_t, HADDR_UNDEF, (hid_t d), (d))                      \
  X(H5Dget_space, hid_t, -1, (hid_t d), (d))                                  \
  X(H5Dget_type, hid_t, -1, (hid_t d), (d))                                   \
  X(H5Dget_storage_size, hsize_t, 0, (hid_t d), (d))                          \
  X(H5Screate, hid_t, -1, (H5S_class_t c), (c))                               \
  X(H5Screate_simple, hid_t, -1, (int n, const hsize_t *a, const hsize_t *b), \
    (n, a, b))                                                                \
  X(H5Sget_simple_extent_npoints, hssize_t, -1, (hid_t s), (s))               \
  X(H5Pcreate, hid_t, -1, (hid_t c), (c))                                     \
  X(H5Pset_userblock, herr_t, -1, (hid_t p, hsize_t n), (p, n))               \
  X(H5Pset_layout, herr_t, -1, (hid_t p, H5D_layout_t l), (p, l))             \
  X(H5Pset_alloc_time, herr_t, -1, (hid_t p, H5D_alloc_time_t t), (p, t))     \
  X(H5Pset_fill_time, herr_t, -1, (hid_t p, H5D_fill_time_t t), (p, t))       \
  X(H5Pset_obj_track_times, herr_t, -1, (hid_t p, hbool_t t), (p, t))         \
  X(H5Pset_create_intermediate_group, herr_t, -1, (hid_t p, unsigned n),      \
    (p, n))                                                                   \
  X(H5Tcopy, hid_t, -1, (hid_t t), (t))                                       \
  X(H5Tset_size, herr_t, -1, (hid_t t, size_t n), (t, n))                     \
  X(H5Tset_strpad, herr_t, -1, (hid_t t, H5T_str_t s), (t, s))                \
  X(H5Acreate2, hid_t, -1, (hid_t f, const char *s, hid_t t, hid_t e,         \
    hid_t a, hid_t b), (f, s, t, e, a, b))                                    \
  X(H5Awrite, herr_t, -1, (hid_t a, hid_t t, const void *v), (a, t, v))       \
  X(H5Gcreate2, hid_t, -1, (hid_t f, const char *s, hid_t a, hid_t b,         \
    hid_t c), (f, s, a, b, c))                                                \
  X(H5Gopen2, hid_t, -1, (hid_t f, const char *s, hid_t a), (f, s, a))        \
  X(fopen, FILE *, NULL, (const char *p, const char *m), (p, m))              \
  X(fdopen, FILE *, NULL, (int fd, const char *m), (fd, m))                   \
  X(open_memstream, FILE *, NULL, (char **p, size_t *n), (p, n))              \
  X(fsync, int, -1, (int f), (f))                                             \
  X(fflush, int, EOF, (FILE *f), (f))                                         \
  X(ferror, int, 1, (FILE *f), (f))                                           \
  X(rename, int, -1, (const char *a, const char *b), (a, b))                  \
  X(mkdir, int, -1, (const char *p, mode_t m), (p, m))                        \
  X(pwrite, ssize_t, -1, (int f, const void *v, size_t n, off_t at),          \
    (f, v, n, at))                                                            \
  X(pread, ssize_t, -1, (int f, void *v, size_t n, off_t at), (f, v, n, at))  \
  X(ftruncate, int, -1, (int f, off_t n), (f, n))                             \
  X(fstat, int, -1, (int f, struct stat *s), (f, s))                          \
  X(stat, int, -1, (const char *p, struct stat *s), (p, s))                   \
  X(lstat, int, -1, (const char *p, struct stat *s), (p, s))                  \
  X(opendir, DIR *, NULL, (const char *p), (p))                               \
  X(fseek, int, -1, (FILE *f, long at, int from), (f, at, from))              \
  X(ftell, long, -1, (FILE *f), (f))                                          \
  X(flock, int, -1, (int f, int how), (f, how))                               \
  X(pipe, int, -1, (int *p), (p))

/* X(function, answer of a failure, parameter, argument): made, then answered
 * by a failure. */
#define FAILING_LATE_LIST(X)                                                  \
  X(H5Fclose, -1, (hid_t f), (f))                                             \
  X(H5Dclose, -1, (hid_t d), (d))                                             \
  X(fclose, EOF, (FILE *f), (f))                                              \
  X(close, -1, (int f), (f))

/* X(function): of the sources themselves, where something comes from outside:
 * an array that a restart file has not, an expression that is NaN, a signal. */
#define FAILING_OWN_LIST(X)                                                   \
  X(archive_reals)                                                            \
  X(archive_ints)                                                             \
  X(archive_bytes)                                                            \
  X(expression_value)                                                         \
  X(interrupt_asked)                                                          \
  X(open)
/* clang-format on */

#define FAILING_ENUM(name, ...) FAILING_##name,
#define FAILING_ENUM_OWN(name) FAILING_##name,
typedef enum failing_call {
  FAILING_LIST(FAILING_ENUM) FAILING_LATE_LIST(FAILING_ENUM)
      FAILING_OWN_LIST(FAILING_ENUM_OWN) FAILING_CALLS
} failing_call;

typedef enum failing_kind {
  FAILING_MEMORY,
  FAILING_FILE,
  FAILING_VALUE,
  FAILING_SIGNAL
} failing_kind;

typedef struct failing_point {
  failing_call call;
  long number; /* from 1                                                 */
} failing_point;

/* How a run ended, besides its code. */
typedef struct failing_end {
  int reached;    /* 1: the point was met                                   */
  size_t held;    /* bytes not released                                     */
  ssize_t opened; /* objects of HDF5 not closed                             */
} failing_end;

/* In the place of the last list and of the mesh reader; the others are made
 * from the lists. */
status __wrap_archive_reals(archive *a, const char *name, double *v, size_t n);
status __wrap_archive_ints(archive *a, const char *name, int *v, size_t n);
status __wrap_archive_bytes(archive *a, const char *name, void *v, size_t n);
double __wrap_expression_value(const expression *e, const double x[3],
                               double t);
status __wrap_interrupt_asked(void);
int __wrap_open(const char *path, int flags, ...);
void __wrap_child_run(const raw_request *request, int fd, int error_fd);

/* The program, its main under another name. */
int protis_main(int argc, char **argv);

/* Before all else; check fails if there is no room. Meshes are read once: what
 * the reader sends is kept in this folder. */
void failing_setup(const char *meshes);
/* Run the program in a child process and wait for its end: exit code, or 1000 +
 * signal. What it prints goes to a file. */
int failing_run(int argc, char **argv, const char *printed, failing_end *end);
/* The next runs are watched, one of them alone, for points not known so far:
 * the number of these. */
void failing_watch(void);
int failing_points(const failing_point **list);
/* The next runs fail there; NULL: nowhere. */
void failing_at(const failing_point *p);
const char *failing_name(failing_call c);
failing_kind failing_kind_of(failing_call c);
