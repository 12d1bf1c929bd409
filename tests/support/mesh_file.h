/*
 * Mesh files for the tests: texts written to a folder of their own, read with
 * mesh_read_gmsh, and the messages as one text.
 */
#pragma once

#include "base/memory.h"
#include "mesh/mesh.h"

/* A .msh of version 2.2 in ASCII from the lines of its three parts. */
#define MSH(names, nodes, elements)                                     \
  "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n" names        \
  "$EndPhysicalNames\n$Nodes\n" nodes "$EndNodes\n$Elements\n" elements \
  "$EndElements\n"

/* Its parts for a unit square of two triangles. */
#define SQUARE "4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n"
#define BODY "1\n2 1 \"BODY\"\n"
#define TWO "1 2 2 1 1 1 2 3\n2 2 2 1 1 1 3 4\n"
/* A .geo of a unit square with its upper side outside of everything. */
#define PLATE                                                               \
  "Point(1)={0,0,0}; Point(2)={1,0,0}; Point(3)={1,1,0}; Point(4)={0,1,0};" \
  "Line(1)={1,2}; Line(2)={2,3}; Line(3)={3,4}; Line(4)={4,1};"             \
  "Curve Loop(1)={1:4}; Plane Surface(1)={1}; Transfinite Curve{1:4}=2;\n"

typedef struct mesh_file {
  char folder[64];
  char messages[4096]; /* of the last reading, without source lines       */
  status answer;       /* of the last reading                              */
  int n_error;         /* errors of the last reading                       */
} mesh_file;

mesh_file mesh_file_open(void);     /* new folder                           */
void mesh_file_close(mesh_file *f); /* removed with all in it               */
/* MESH_FILE f = ...: closed where the name ends. */
#define MESH_FILE ENDS_BY(mesh_file_close) mesh_file
/* FOLDER/NAME; the same buffer at every call. */
const char *mesh_file_path(const mesh_file *f, const char *name);
void mesh_file_write(const mesh_file *f, const char *name, const void *data,
                     size_t size);
/* Read FOLDER/NAME with the numbers; the answer and messages go to f. */
mesh *mesh_file_read(mesh_file *f, const char *name, double scale, int n_number,
                     const mesh_number *numbers);
/* The same from a source that names its file itself. */
mesh *mesh_file_from(mesh_file *f, const mesh_source *source);
/* Write the text as FOLDER/NAME, then read it. */
mesh *mesh_file_text(mesh_file *f, const char *name, const char *text);
/* 1 if both are the same in everything but the element numbers (version 2.2
 * numbers them again), coordinates to digits*size (ASCII files have 16 digits);
 * "what" tells the first difference. */
int mesh_same(const mesh *a, const mesh *b, double digits, const char **what);
