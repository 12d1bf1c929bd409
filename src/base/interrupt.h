/*
 * Requests to end the run early: SIGINT, SIGTERM, or a file. They only leave a
 * note that the run reads between two increments; a second SIGINT or SIGTERM
 * ends the process at once.
 */
#ifndef PROTIS_BASE_INTERRUPT_H
#define PROTIS_BASE_INTERRUPT_H

#include "base/status.h"

/* A write beyond the file size limit fails like one on a full disk. */
void interrupt_spare_writes(void);
/* From now on requests are noted; stop_file is borrowed, and removed if it is
 * there from an earlier run. NULL: no file is looked for. */
void interrupt_catch(const char *stop_file);
/* OK, or ERR_INTERRUPTED (SIGINT, the file) or ERR_TERMINATED (SIGTERM); the
 * file is then removed. */
status interrupt_asked(void);
/* "SIGINT", "SIGTERM" or the name of the file; "" if nothing was asked. */
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
