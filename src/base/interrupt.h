/*
 * Requests to end the run early: SIGINT, SIGTERM, SIGHUP, SIGXCPU, SIGUSR1,
 * SIGUSR2, or a file. They only set a flag that the run reads between two
 * increments; the second SIGINT or SIGTERM ends the process at once.
 */
#pragma once

#include "base/status.h"

/* A write beyond the file size limit, or to a pipe without a reader, fails like
 * one on a full disk. */
void interrupt_spare_writes(void);
/* From now on requests are noted; stop_file is borrowed, NULL: no file is
 * looked for. One that exists already is a request only when it is touched. */
void interrupt_catch(const char *stop_file);
/* OK, or the status of the first request, ERR_INTERRUPTED of a file; that is
 * then removed if it was made during the run. */
status interrupt_asked(void);
/* "SIGINT" or the like or the name of the file; "" without a request. */
const char *interrupt_name(void);

/*
 * Ends by a fault: a signal of the processor inside the program or a library,
 * or a library that ends the process by itself, as HDF5 and OpenMP do when
 * memory is refused. From this call on such an end prints one line and exits
 * with code 7 (a signal) or 5 (a library); the result files are whole up to the
 * last line of JOB.sta. Under a sanitizer signals are left to it.
 */
void interrupt_crashes(void);
/* The program ends by itself now. */
void interrupt_over(void);
