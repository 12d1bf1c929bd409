/*
 * *EFFECTS, MODE=AUTO: a run without effects that seem not to matter, and the
 * run with them if that is not confirmed (effects/reduction/reduction.h).
 */
#ifndef PROTIS_AUTO_H
#define PROTIS_AUTO_H

#include "program/job.h"

/* The job, solved and written; *unsettled as history_run. */
status auto_solve_job(const command *c, job_input *in, int *unsettled);

#endif
