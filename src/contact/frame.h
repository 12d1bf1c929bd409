/*
 * The contact frame of one node: rows n, t1[, t2] in two or three dimensions,
 * with the directions that *BOUNDARY fixes as tangents, and with the normals
 * of a second and third obstacle in place of tangents at a corner.
 */
#ifndef PROTIS_CONTACT_FRAME_H
#define PROTIS_CONTACT_FRAME_H

/* Take the fixed components (bit c: component c) out of v[dim] and make it a
 * unit vector. Returns the length that was left over the length before; 0 and
 * v = 0 if nothing was left. */
double frame_project(int dim, unsigned fixed, double *v);

/*
 * Complete a frame whose first n_normal rows are unit normals orthogonal to the
 * fixed components. held[dim] is set to 1 for the rows that are fixed
 * directions. Frames of one normal are orthonormal and, but for two fixed
 * components, right handed. 0; -1 if the normals and the fixed directions are
 * (nearly) dependent.
 */
int frame_complete(int dim, int n_normal, unsigned fixed, double *frame,
                   unsigned char *held);

/* basis[dim*dim], column major: inverse of frame (rows). An orthonormal frame
 * is its own inverse, transposed: no arithmetic then. */
void frame_invert(int dim, int orthonormal, const double *frame, double *basis);

#endif
