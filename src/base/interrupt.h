/*
 * Requests to end the run early: SIGINT, SIGTERM, SIGHUP, SIGXCPU, SIGUSR1,
 * SIGUSR2, or a file. They only leave a note that the run reads between two
 * increments; the second SIGINT or SIGTERM ends the process at once.
 */
#ifndef PROTIS_BASE_INTERRUPT_H
#define PROTIS_BASE_INTERRUPT_H

#include "base/status.h"

/* A write beyond the file size limit, or to a pipe that nobody reads, fails
 * like one on a full disk. */
void interrupt_spare_writes(void);
/* From now on requests are noted; stop_file is borrowed, NULL: no file is
 * looked for. One that is there already is no request, but for being touched.
 */
void interrupt_catch(const char *stop_file);
/* OK, or the status of the first request, ERR_INTERRUPTED of a file; that is
 * then removed if it was made during the run. */
status interrupt_asked(void);
/* "SIGINT" or the like or the name of the file; "" if nothing was asked. */
const char *interrupt_name(void);

/*
 * Ends that nobody chose: a signal of the processor inside the program or a
 * library, or a library that ends the process by itself, as HDF5 and OpenMP do
 * when memory is refused. From here on such an end prints one clear line and
 * leaves with exit code 7 (a signal) or 5 (a library); the result files are
 * whole up to the last line of JOB.sta. Under a sanitizer signals stay its own.
 */
void interrupt_crashes(void);
/* The program ends by itself now. */
void interrupt_over(void);

#endif
