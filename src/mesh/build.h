/*
 * From the raw mesh to the mesh, in steps that check what they use: groups,
 * nodes, elements, faces, then the contents of the groups. Inside src/mesh.
 *
 * "Top" elements are those of the dimension of the mesh, "low" ones those of
 * one dimension less: each in the order of the file, block after block.
 */
#pragma once

#include "mesh/raw.h"

enum { MAX_ITEMS = 500000000, SHOWN = 5 };

typedef struct number_table {
  int bits;
  int *slot;        /* [2^bits] index + 1, 0: none */
  const size_t *no; /* borrowed */
} number_table;

typedef struct builder {
  const raw_mesh *raw; /* borrowed */
  double scale;
  const place *at; /* borrowed */
  message_log *log;
  int errors; /* errors of the log before */
  mesh *m;
  number_table by_no; /* raw nodes */
  int *node_id;       /* [raw->n_node] mesh node, -1 if not used */
  int n_top, n_low;   /* elements of the mesh dimension, one dimension less */
  int *corner;        /* [(dim+1)*n_top] raw nodes */
  int *elem_of_top;   /* [n_top] element id */
  int *face_of_low;   /* [n_low] face id */
  int *first;         /* [raw->n_block] its first top or low element */
} builder;

/* The first few faulty items, for a message. */
typedef struct faults {
  int n;
  char text[480];
} faults;
void fault_add(faults *c, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
/* Mean place x[3] of n nodes, for a message. */
void fault_centre(const mesh *m, int n, const int *v, double *x);
/* " no. 17 at (0.5, 2)" for a number and raw or mesh coordinates. */
void fault_at(faults *c, int dim, size_t no, const double *x);
/* "no. 17 and 18 at (0.5, 2)". */
void fault_pair(faults *c, int dim, size_t one, size_t two, const double *x);

/* ERR_MESH if errors were added to the log since the start. */
status build_check(const builder *b);

/* Two items with one number are reported, but not two with one id. */
status numbers_check(builder *b, const char *what, int n, const size_t *no,
                     const int *id);

status nodes_index(builder *b);              /* raw node by number */
int nodes_find(const builder *b, size_t no); /* raw node or -1 */
status nodes_order(builder *b);              /* ids, coordinates, numbers */
status nodes_coincident(builder *b);
status elements_gather(builder *b); /* types; corners as raw nodes */
status elements_finish(builder *b); /* orientation, order, repeated ones */
status faces_finish(builder *b);    /* ids, elements on both sides */
status overlap_check(builder *b);   /* across faces, anywhere */
