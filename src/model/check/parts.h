/*
 * The parts of model_check that are in values.c. Errors go to the log; a status
 * is of memory. Private to src/model/check.
 */
#pragma once

#include "model/check/check.h"

/* Id of a group, or -1 and an error with the nearest name. */
int check_group(const model *m, const mesh *msh, const char *name,
                const place *at);
/* The same, of a wanted dimension. */
int check_group_of(const model *m, const mesh *msh, const char *name, int dim,
                   const place *at);
/* Groups and components. */
void check_initials(model *m, const mesh *msh);
/* The loads and tables of all steps, each card once. */
void check_steps(model *m, const mesh *msh);
/* The fields of FILE= of *TEMPERATURE, each read once. */
status check_fields(model *m, const mesh *msh);
/* Where each step begins and ends, what the expressions give is a number; in
 * between it is checked when needed. */
void check_values(const model *m, const mesh *msh);
/* Two groups that share nodes prescribe the same displacement there. */
status check_agreement(const model *m, const mesh *msh, int step_id);
/* Warnings of input without effect. */
void check_no_effect(const model *m, const mesh *msh);
/* Increments of *VISCO steps against the laws that do not change. */
status check_visco(const model *m);

/* field.c: the file of the start is there before any result is, which may have
 * its name. */
status check_start_file(const model *m);
/* A value at each node of a mesh, from the file of another program. */
/*
 * *value[n_node] is new (memory_free), NULL on failure. The file is a .msh of
 * gmsh (2.2 or 4.1, ASCII or binary) whose last $NodeData counts, or HDF5 with
 * the datasets /node_no and /temperature. Nodes go by their number in the mesh
 * file; numbers that the mesh does not have are skipped; a .msh that has places
 * too, times the scale, has them where the mesh has them. ERR_FILE: it cannot
 * be read; ERR_DECK: no field of one component, a node of the mesh without
 * value or at another place, a value that is not finite.
 */
status nodal_field_read(const char *path, const mesh *msh, double scale,
                        double **value);
