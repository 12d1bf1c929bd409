/*
 * *ACCURACY, TARGET=: passes with a finer mesh, shorter increments and a
 * tighter solver until the estimated error is reached, or a limit of the deck.
 */
#ifndef PROTIS_TARGET_H
#define PROTIS_TARGET_H

#include "program/job.h"

/*
 * Repeat the job in passes; *in holds the first pass, then the last. The files
 * are those of the last pass. ERR_UNSETTLED: the target is missed, the record
 * says why; the errors of job_solve.
 */
status target_reach(const command *c, job_input *in, int *unsettled);

#endif
