/*
 * The mesh file block.msh of a rectangle: n[0] by n[1] squares, each of two
 * triangles, diagonals alternating, from (0, 0) to (length[0], length[1]).
 * Groups: CONTACT (below), TOP, LEFT, SYMMETRY (right), BODY; with "two" the
 * upper half of the elements is UPPER instead.
 */
#pragma once

#include "support/job.h"

/* Into the folder of the job. */
void block_file_write(const job *j, const int n[2], const double length[2],
                      int two);
