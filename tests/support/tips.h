/*
 * Jobs of two bodies of one contact node each: triangles of area 1 that are
 * clamped at the height 1, nu = 0.3, tips at x = 0 and 4. Stiffness of a tip: G
 * along the obstacle, 3.5 G across, not coupled.
 *
 * Groups: CLAMPED, TIPS (nodes), FOOT1 and FOOT2 (one edge each), SIDE1 (the
 * other edge of the first), BODY.
 */
#pragma once

#include "support/job.h"

/* The deck tips.inp and its mesh: parameters of *MESH (", SCALE=2", or ""),
 * cards from *OBSTACLE on. */
job tips_new(double G, const char *mesh, const char *cards);
/* Cards below *MATERIAL of that deck. */
void tips_material(const job *j, const char *cards);
