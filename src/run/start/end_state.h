/*
 * The end of an earlier run from its JOB.h5.
 */
#ifndef PROTIS_START_END_STATE_H
#define PROTIS_START_END_STATE_H

#include "base/message.h"
#include "mesh/mesh.h"

/*
 * Displacements u[dim*n_node] (m) of the last record, its time *t (s). ERR_FILE
 * or ERR_DECK with an error in the log at "at": the file cannot be read, has no
 * record, was cut short, or has another mesh (nodes are compared in number and
 * place).
 */
status end_state_read(const char *path, const mesh *msh, const place *at,
                      message_log *log, double *u, double *t);

#endif
