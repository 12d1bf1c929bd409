/*
 * The steps of mesh_open. Inside src/mesh/crack.
 *
 * "Near" elements have a node of a crack. Their sides and corners are numbered
 * per * place + k with per = dim + 1, place the one in "elem" and k the side or
 * corner of the element.
 */
#ifndef PROTIS_MESH_CRACK_OPENING_H
#define PROTIS_MESH_CRACK_OPENING_H

#include "mesh/build.h"
#include "mesh/crack/crack.h"

typedef struct opening {
  mesh *m;             /* borrowed */
  int n;               /* cracks */
  const mesh_cut *cut; /* [n] borrowed, its groups until they are changed */
  message_log *log;    /* borrowed */
  int errors;          /* of the log before */
  mesh_crack *crack;   /* [n] borrowed */
  int *group_id;       /* [n] */
  int n_face;
  int *first;        /* [n+1] faces of each crack */
  int *face;         /* [n_face] face ids */
  int *lip;          /* [2*n_face] sides in face_elem and face_other */
  signed char *sign; /* [n_face] 1: face_elem is below, -1: above */
  char *on_crack;    /* [n_node] 1: node of a crack */
  int n_elem;        /* near elements */
  int *elem;         /* [n_elem] ascending */
  int *place;        /* [n_elem of the mesh] in elem; -1 */
  int *across;       /* [per*n_elem] the side behind a side with a node of a
                        crack; -1: boundary or crack */
  int *node;         /* [per*n_elem] node of a corner after the opening, -1: no
                        node of a crack */
  int n_copy;
  int *copy_of; /* [n_copy] */
} opening;

/* Nodes of an element and of a face, coordinates of a node. */
static inline int *elem_nodes(const mesh *m, int elem) {
  return m->elem + (ptrdiff_t)(m->dim + 1) * elem;
}
static inline int *face_nodes(const mesh *m, int face) {
  return m->face + (ptrdiff_t)m->dim * face;
}
static inline const double *node_x(const mesh *m, int node) {
  return m->x + (ptrdiff_t)m->dim * node;
}

/* groups.c: ERR_MESH if errors were added to the log since the start. */
status opening_check(const opening *o);
/* Add element and centre of a face to a message. */
void opening_note(const opening *o, int face_id, faults *bad);

/* sign of each face: a walk over each crack. */
status lips_orient(opening *o);
/* Nodes, elements and faces of the mesh; plus and minus of the cracks. */
status lips_store(opening *o);
/* Contents of the groups, and those of the lips. */
status groups_open(opening *o);
/* The fronts, from the opened mesh. */
status fronts_find(opening *o);

#endif
