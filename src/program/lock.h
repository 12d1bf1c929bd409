/*
 * One job of a name in a folder at a time: JOB.lock, held by flock(), which the
 * system releases however the process ends. A file left behind is no lock.
 */
#ifndef PROTIS_LOCK_H
#define PROTIS_LOCK_H

#include "base/status.h"

typedef struct job_lock {
  char *path; /* owned; NULL: none held */
  int fd;
} job_lock;

/* Make the folder if it is not there, and take the lock. ERR_FILE: another
 * process holds it, or the file cannot be made. */
status job_lock_take(const char *dir, const char *job, job_lock *l);
void job_lock_release(job_lock *l); /* accepts one never taken */

#endif
