/*
 * protis JOB --estimate-cost: what an error would cost, from two coarse runs.
 */
#ifndef PROTIS_FORECAST_H
#define PROTIS_FORECAST_H

#include "program/job.h"

/* Run the job twice without results, on a mesh twice as coarse as that of the
 * deck and on that, and print estimated unknowns, CPU seconds and memory for
 * finer meshes and for errors from 10 % to 0.1 %. ERR_DECK: no .geo to mesh
 * again; the errors of history_run. */
status forecast_print(const command *c, job_input *in);

#endif
