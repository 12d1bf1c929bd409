/* The model against the mesh, after all cards are read. */
#pragma once

#include "model/model.h"

/* Compare with the mesh: groups, sections, dimensions; fill the _id fields and
 * the effects. Errors go to the log: ERR_DECK or ERR_MESH. */
status model_check(model *m, const mesh *msh, effect_finder *find);

/* Open the mesh along the cracks, once, before model_check: their lips are
 * groups then. ERR_DECK, ERR_MESH with errors in the log; ERR_MEMORY. */
status model_open_cracks(model *m, mesh *msh);

/* Relative error of displacements to expect of P1 elements that lock at nu, n
 * of them across a wall. */
double model_locking_error(double nu, double n);
/* nu of a section whose elements lock by it; else 0. */
double model_locking_nu(const model *m, const section *s);

/* 1 if the integrator of a *VISCO step can be unstable or ring. */
int step_has_limit(const step *s);
/* The fastest rate, 1/s, with which an increment dt to t is stable: as
 * step_level, less the rounding of both. */
double step_fastest(const step *s, double t, double dt);
/*
 * What the fastest rate of the laws means for an increment dt of a *VISCO step
 * from t on: the level of 2^level pieces that keep it stable, > 0 with
 * SUBSTEPS=AUTO only; -1 after a message that it is not. "notify": report if
 * parts of the stress will ring.
 */
int step_level(const model *m, const step *s, double t, double dt, double rate,
               int notify);
