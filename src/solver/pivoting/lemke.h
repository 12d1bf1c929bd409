/*
 * METHOD=LEMKE: interface besides the row of the solver.
 */
#pragma once

/*
 * work: of its setup. The motion [m] that ended the last solve with
 * STOPPED_RAY: no elastic force, no penetration, and the load does more work on
 * it than friction. NULL: the last solve ended otherwise.
 */
const double *lemke_ray(const void *work);
