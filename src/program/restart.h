/*
 * JOB.rst.h5: what a run goes on from with --restart, to the result of the run
 * that was not interrupted, bit for bit.
 *
 * All that an increment starts from is kept (run_keep): the last equilibrium,
 * slip so far, inelastic strains, the place in the grid of increments. Data of
 * the contact solver that persist from increment to increment (factors and
 * exchanged rows) are saved as well (contact_solver_keep), because a new factor
 * has other last digits; matrices, surfaces and averages are made again, for
 * they depend on the deck and the mesh alone. Of the files their lengths are
 * kept: what was written after the restart file is cut and written again. One
 * of them, JOB.rst.inc, has the summaries of the increments for the end of the
 * run.
 *
 * The last two are there: JOB.rst.h5, and JOB.rst.old.h5 in case the first
 * cannot be read.
 */
#ifndef PROTIS_RESTART_H
#define PROTIS_RESTART_H

#include "program/job.h"

/* Input of a restart file. */
typedef struct restart_writer {
  const command *c;
  const job_input *in;
  output *out;
  char *files; /* restart_files when the run was started */
} restart_writer;

/* Contents of the files that the cards of the deck name, new. ERR_FILE. */
status restart_files(const job_input *in, char **text);

/* history_sink.checkpoint; ctx is a restart_writer. */
status restart_write(void *ctx, const run_memory *memory);

/*
 * The restart file of a job, found to fit its deck and mesh. ERR_DECK: no
 * restart for such a job, or cards have changed that must not; ERR_FILE: no
 * restart file, damaged, of another version or mesh. Other threads or another
 * kernel: a warning on stderr. *out is to be freed after a failure too.
 */
status restart_read(const command *c, const job_input *in, archive **out);

#endif
