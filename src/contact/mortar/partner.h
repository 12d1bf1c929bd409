/*
 * The partners of a slave face among the master faces, and the parts of it that
 * each covers (the rule stands in mortar.h). Inside src/contact/mortar only.
 */
#pragma once

#include "base/box_tree.h"
#include "contact/mortar/clip.h"
#include "contact/mortar/mortar.h"

/* Nodes of a face; place of a node, m. */
static inline const int *mortar_nodes(const mortar_input *in, int face) {
  return mesh_face_nodes(in->mesh, face);
}
static inline const double *mortar_place(const mortar_input *in, int node) {
  return in->x + (size_t)in->mesh->dim * (size_t)node;
}

/* number_places of the nodes of faces face[n]. */
status mortar_around(const mortar_input *in, int n, const int *face,
                     size_t **start, int **item);

/* A face over or below the slave face: a partner, or one that hides what is
 * behind it, a master that does not oppose or a face of the slave. */
enum { PARTNER = 0, HIDING_MASTER, HIDING_SLAVE };

typedef struct partner {
  int face;      /* id in the mesh */
  int hides;     /* of the enum */
  shadow s;      /* in the plane of the slave face */
  double size;   /* area of the face, m2 */
  double height; /* along the normal, at the middle of the covered part, m */
  int first, n;  /* cells */
} partner;

/* Faces, and which are joined through nodes. */
typedef struct face_sets {
  int *face, *set; /* [n] of the mesh; place of one that it is joined with */
  int n, capacity, set_capacity;
} face_sets;

typedef struct partner_search {
  const mortar_input *in;
  box_tree masters, slaves;
  double reach;   /* extent of the larger surface, m */
  double largest; /* largest coordinate, m */
  facet *master;  /* [n_master], measure 0: degenerate */
  int *found;     /* [n_master or n_slave] */
  int *group;     /* [n_node] -1, workspace */
  face_sets sets; /* workspace */
  partner *list;  /* [n] of the current slave face */
  int n, capacity;
  cell *cells; /* [n_cell] */
  int n_cell, cell_capacity;
  cell *rest; /* workspace */
  int rest_capacity;
  size_t *around;   /* [n_node+1] elements around a node: */
  int *around_elem; /* [around[n_node]]; or NULL, not needed so far */
} partner_search;

status partner_search_new(const mortar_input *in, partner_search *s);
/* Relative size of what is only rounding of the coordinates in the plane of f,
 * of the size of f, - . */
double partner_rounding(const partner_search *s, const facet *f);
/* list and cells of this slave face. */
status partner_find(partner_search *s, int face, const facet *f);
status face_sets_add(face_sets *a, int face);
/* 1: all are joined. */
int face_sets_join(partner_search *s, face_sets *a);
/* back.c: 1: partner p, below the face "from", is the back of its body or is
 * behind that, on the line through x, a point of the face that p covers. */
status partner_is_behind(partner_search *s, int from, const facet *f,
                         const double *x, const partner *p, int *is);

/* step.c: partners of a node that lie beyond a step of the master. */
typedef struct step_node {
  face_sets of;           /* partners of the slave faces round a node */
  double normal[3], size; /* of the slave; of its largest face, m */
} step_node;

typedef struct step_part {
  int slave_no, face; /* slave face, by its number; master, of the mesh */
} step_part;

typedef struct step_search {
  int *first, *seen; /* [n_slave+1]; [first[n_slave]] partners, of the mesh */
  int n_seen, capacity;
  step_part *left; /* [n_left] beyond a step */
  int n_left, left_capacity;
  step_node node; /* workspace */
} step_search;

/* Slave face number i, in their order: what partner_find has found. */
status steps_see(step_search *t, int i, const partner_search *s);
/* Of a node, by the numbers of its slave faces; ERR_MEMORY. */
status steps_find(step_search *t, partner_search *s, int n_face,
                  const int *slave_no);
/* Takes those beyond a step from the list of slave face number i. */
void steps_leave(const step_search *t, int i, partner_search *s);

/*
 * bulge.c: heights of a curved surface over its flat faces, m, outwards, at
 * rest.
 * bulge[edges*n_face], 1 edge of a face in 2-D, 3 in 3-D, is zero and gets
 * those of the n faces of a surface. ERR_MEMORY.
 */
status bulge_find(const mortar_input *in, int n, const int *face,
                  double *bulge);
/* Of a face where its P1 functions are phi[dim]. */
double bulge_height(int dim, const double *bulge, int face, const double *phi);
