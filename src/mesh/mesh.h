/*
 * The mesh: nodes, P1 elements (triangles or tetrahedra), faces and groups.
 *
 * Nodes and elements are stored in an order that keeps neighbours close in
 * memory; node_no and elem_no are the numbers of the mesh file, the only ones
 * shown to the user. Nodes that no element uses are not stored.
 */
#pragma once

#include "base/message.h"

#include <stddef.h>

typedef struct mesh_group {
  const char *name; /* physical name, case kept */
  int dim;          /* 0 points, 1 curves, 2 surfaces, 3 volumes */
  int tag;          /* physical tag */
  int n_item;       /* elements (dim = mesh dim) or faces (mesh dim - 1) */
  int *item_id;     /* [n_item] ascending elem or face ids; else NULL */
  int n_node;
  int *node_id; /* [n_node] ascending */
} mesh_group;

/* A crack along which the mesh was opened (mesh/crack/crack.h). Its front: tips
 * (2-D) or chains of nodes (3-D), each along e3 = e1 x e2, with e1 the
 * direction of growth and e2 the normal from minus to plus; a closed chain ends
 * with its first node. */
typedef struct mesh_crack {
  int n;            /* faces that are open */
  int *plus;        /* [n] face id of the lip above; face_elem: its element */
  int *minus;       /* [n] face id of the lip below */
  int n_front;      /* tips or chains */
  int *front_start; /* [n_front+1] */
  int *front_node;  /* [front_start[n_front]] */
  int *front_face;  /* [front_start[n_front]] face (0 .. n-1) of the crack at
                       the tip, or along the edge to the next node; -1: last
                       node of a chain */
} mesh_crack;

typedef struct mesh {
  int dim; /* 2 or 3 */
  int n_node, n_elem, n_face, n_group;
  double *x;         /* [dim*n_node] coordinates, length */
  size_t *node_no;   /* [n_node] of the mesh file; of copies: beyond them */
  int *origin;       /* [n_node] node it is a copy of; NULL: no crack */
  int *elem;         /* [(dim+1)*n_elem] node ids, positive orientation */
  size_t *elem_no;   /* [n_elem] number in the mesh file */
  int *face;         /* [dim*n_face] node ids of the faces of the groups; seen
                        from outside face_elem they turn so that the normal
                        (2-D: tangent turned by -90 degrees) points outward */
  int *face_elem;    /* [n_face] the element the face bounds */
  int *face_other;   /* [n_face] the element behind it, -1 on the boundary */
  mesh_group *group; /* [n_group] */
  int n_crack;
  mesh_crack *crack; /* [n_crack] */
  double z;          /* of the plane of a 2-D mesh, length */
  double size;       /* largest extent of the bounding box, length */
} mesh;

typedef struct mesh_number { /* a number handed to a .geo file */
  const char *name;
  double value;
  int in_deck; /* 1: the deck uses it too, the file may have its own */
} mesh_number;

/* Lengths of elements at the nodes of a mesh. */
typedef struct mesh_sizes {
  const mesh *of;
  const double *at; /* [of->n_node] length */
} mesh_sizes;

/* Where a mesh comes from. */
enum { MESH_SIZES = 2 };
typedef struct mesh_source {
  const char *file; /* .msh, or .geo to be meshed */
  double scale;     /* coordinates are multiplied by it, - */
  int n_number;
  const mesh_number *numbers; /* [n_number] for a .geo */
  /* A .geo meshed again: the lengths its elements shall have, the least of
   * those at the nodes of earlier meshes of it; NULL: those of the .geo. A .msh
   * is refined to the first of them (mesh/refine/refine.h). */
  mesh_sizes sizes[MESH_SIZES];
  int n_round;               /* groups of a .msh whose faces may be curved */
  const char *const *rounds; /* [n_round] their names */
  int meets; /* 1: its bodies meet, no warning where they touch or overlap */
} mesh_source;

/* 1: the file is a .geo, a program that gmsh runs; 0: it is read as data. */
int mesh_is_program(const char *file);
/* Read .msh (2.2, 4.1, ASCII, binary) or mesh a .geo. Faults of the mesh go to
 * the log with "at" (the *MESH card) as place and the status is ERR_MESH;
 * ERR_FILE if the file is missing, ERR_MEMORY. */
status mesh_read_gmsh(const mesh_source *source, const place *at,
                      message_log *log, mesh **out);
/* The library of gmsh into this process, once: each mesh is made in a process
 * of its own, which otherwise loads it again (0.2 s). Failures are not
 * reported. */
void mesh_gmsh_load(void);

/* "points", "curves", "surfaces", "volumes". */
extern const char *const mesh_words[4];

/* Nodes of an element and of a face, coordinates of a node. */
static inline int *mesh_elem_nodes(const mesh *m, int elem) {
  return m->elem + (ptrdiff_t)(m->dim + 1) * elem;
}
static inline int *mesh_face_nodes(const mesh *m, int face) {
  return m->face + (ptrdiff_t)m->dim * face;
}
static inline double *mesh_node_x(const mesh *m, int node) {
  return m->x + (ptrdiff_t)m->dim * node;
}

const mesh_group *mesh_find_group(const mesh *m,
                                  const char *name); /* or NULL */
/* Name of the nearest group for a message, or NULL. */
const char *mesh_nearest_group(const mesh *m, const char *name);
/* Area (2-D: length per unit thickness is the caller's) and outward normal of
 * a face: normal[dim] of unit length; returns the measure, length^(dim-1). */
double mesh_face_normal(const mesh *m, int face_id, double *normal);
/* A quadrature on faces: points in turn near each of the corners, the P1
 * functions of all others at[], - . */
typedef struct face_rule {
  int n;
  double at[2], part[2];
} face_rule;
/* Exact for degree 5 on a segment, 4 on a triangle. */
extern const face_rule mesh_face_rule[2];
/* P1 functions phi[dim] at point k; its part of the measure. */
double face_rule_point(const face_rule *r, int dim, int k, double *phi);
/* Area or volume of an element, > 0, length^dim. */
double mesh_elem_measure(const mesh *m, int elem_id);
/* Gradients g[dim*(dim+1)] of its P1 functions, 1/length, one after the other;
 * returns twice the area or six times the volume. */
double mesh_elem_gradients(const mesh *m, int elem_id, double *g);
/* Sets as trees: parent[i] = i before. The lower root wins, so that a set is
 * named by its first member. */
int forest_root(int *parent, int i);
void forest_join(int *parent, int a, int b);
/* Bodies: connected sets of elements. body[n_elem] 0..n_body-1. */
status mesh_bodies(const mesh *m, int *n_body, int *body);
/* Nodes v[dim] of side id = (dim+1)*elem + place of an element, turned outward,
 * in 3-D the lowest first. */
void mesh_side_nodes(const mesh *m, int id, int *v);
/* side[n], new: sides without an element behind. ERR_MEMORY. */
status mesh_border(const mesh *m, int *n, int **side);
/* Elements round each node: elem[start[i] .. start[i+1]). Both are new. */
status mesh_node_elements(const mesh *m, size_t **start, int **elem);
