/*
 * One slave face in its plane, master faces projected into it, and what both
 * have in common. Inside src/contact/mortar only.
 */
#pragma once

/* A segment or triangle in the plane of the slave face; 2-D: at[.][0] alone. */
typedef struct cell {
  double at[3][2]; /* corners, m */
} cell;

/* A face with a frame: the axes span its plane. */
typedef struct facet {
  int dim;
  double origin[3], normal[3];
  double axis[2][3]; /* [dim-1] */
  cell in_plane;     /* counterclockwise seen against the normal */
  double measure;    /* length or area, m, m2 */
} facet;

/* A face projected along the normal of a facet. */
typedef struct shadow {
  cell in_plane;
  double height[3]; /* of its corners above the plane, m */
  double measure;   /* of the projection */
} shadow;

/* Triangles: two have at most 6 corners in common, but for the two more that
 * each line may add by rounding where one is seen from its edge; what is left
 * of one without the other is three such pieces. */
enum { CLIP_CELLS = 10, CLIP_REST = 3 * CLIP_CELLS };

/* node[dim] of a face, x[dim*n_node]. 0; -1: the corners are (nearly) on one
 * line, or one point. */
int facet_set(int dim, const int *node, const double *x, facet *f);
void facet_project(const facet *f, const int *node, const double *x, shadow *s);
double cell_measure(int dim, const cell *c);
/* The values at y of the P1 functions of a cell that is not degenerate. */
void cell_functions(int dim, const cell *c, const double *y, double *phi);
/* What two cells have in common as cells; their number. */
int cell_common(int dim, const cell *a, const cell *b, cell *out);
/* What is left of a without b; the number of cells. */
int cell_without(int dim, const cell *a, const cell *b, cell *out);

/* ---- the dual basis on the covered part of one slave face ---- */

/* A point of the quadrature. */
typedef struct sample {
  double offset[2]; /* [dim-1] from the reference point, m */
  double weight;    /* > 0, m2 */
  double phi[3];    /* [dim] P1 functions of the slave */
  double psi[3];    /* [dim] dual functions, 0 of nodes that are not kept */
  double other[3];  /* [dim] P1 functions of the master */
  int partner;
} sample;

/*
 * psi of each point for the nodes with kept[dim] != 0, from the weights, so
 * that sum psi = 1 and sum weight psi_j phi_k = delta_jk d_j for kept j, k; d
 * [dim] is the sum of weight phi. corner: nodes of the face less the reference
 * point. The formula is exact whatever the part is that the points stand for;
 * the offsets are what keeps it so on a small one.
 */
void dual_basis(int dim, const cell *corner, const int *kept, int n,
                sample *points, double *d);
