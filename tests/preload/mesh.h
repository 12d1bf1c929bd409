/* What mesh.c puts before the C library's: each calls the one it hides; and
 * before those of libgmsh, which it stands for until they are needed. */
#pragma once

#include "mesh/raw.h"

#include <stddef.h>
#include <sys/types.h>

/* Notes the descriptor that gets FD_CLOEXEC. */
int fcntl(int fd, int command, ...);
/* libgmsh: gives out the stream and ends, if it is kept. */
void *dlopen(const char *file, int flags);
/* Keeps the stream: a copy, renamed at its last record. */
ssize_t write(int fd, const void *data, size_t n);

/* gmshc.h: the numbers. */
void gmshInitialize(int argc, char **argv, int ignored, int *error);
/* gmshc.h: nothing. */
void gmshLoggerStart(int *error);
/* gmshc.h: an option. */
void gmshOptionSetNumber(const char *name, double value, int *error);
/* gmshc.h: the file. */
void gmshOpen(const char *name, int *error);
/* gmshc.h: the mesh has sizes. */
void gmshModelMeshRemoveConstraints(int *tags, size_t n, int *error);
/* gmshc.h: an empty file. */
void gmshWrite(const char *name, int *error);
/* gmshc.h: the sizes; the other calls that set them do nothing. */
void gmshViewAddListData(int tag, const char *kind, int n_elem, double *data,
                         size_t n, int *error);
void gmshClear(int *error);
int gmshViewAdd(const char *name, int tag, int *error);
int gmshModelMeshFieldAdd(const char *kind, int tag, int *error);
void gmshModelMeshFieldSetNumber(int tag, const char *option, double value,
                                 int *error);
void gmshModelMeshFieldSetNumbers(int tag, const char *option, double *values,
                                  size_t n, int *error);
void gmshModelMeshFieldSetAsBackgroundMesh(int tag, int *error);
/* gmshc.h: never returns; the stream is given out, or its name told. */
void gmshModelGetPhysicalGroups(void);

/* All others: gmsh itself must do it. */
#define NEVER_DECLARE(name) void gmsh##name(void);
GMSH_CALLS(NEVER_DECLARE)
