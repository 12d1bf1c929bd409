/*
 * The files of a run. Every writer is a sink of history_run; the columns of
 * all tables and fields stand once, in src/output/columns.
 */
#pragma once

#include "output/listing/job.h"

typedef struct output output;

/* A file that the run writes or removes: ERR_DECK if it is one that its deck
 * reads, under whatever name, ERR_FILE if it is protected or no file. Before
 * anything is touched. */
status output_spare(const model *m, const char *dir);
/* The files of a pass of TARGET= go to DIR/JOB.pass until those of the next one
 * are whole, ERR_FILE; that is removed, as far as it can be. */
status output_set_aside(const model *m, const char *dir);
void output_drop_aside(const model *m, const char *dir);
/* Open all files of the job: the text files, flushed line by line, and JOB.h5
 * with space for the estimated number of increments. JOB.xdmf, JOB.json and
 * condensed problems of an earlier run, and its restart files, are removed.
 * ERR_FILE names the file. The options are copied, their strings borrowed. */
status output_open(const model *m, const mesh *msh, const output_options *o,
                   output **out);
history_sink output_sink(output *o);
/* Restart data of the files, into an archive that is written before the next
 * increment; all files are synchronised. */
status output_keep(output *o, archive *a);
/* The passes so far, for listing and JSON, with the forecast of a tenth of the
 * error. Its arrays are borrowed until output_close. */
void output_passes(output *o, const pass_table *passes);
/*
 * Close with the outcome of the run; writes the closing tables and JOB.json,
 * frees o (NULL: nothing to do). Returns the status of the whole: run if it
 * failed; else the failure of a file; else ERR_UNSETTLED if increments did not
 * converge to their tolerance; else OK. The record has the message of run.
 */
status output_close(output *o, status run, int unsettled);
