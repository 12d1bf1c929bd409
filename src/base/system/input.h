/*
 * Files that are read: the deck and all it names. They are plain files; a
 * folder, a FIFO or a device is refused without waiting for it.
 *
 * With input_confine they are also below one folder, reached without symbolic
 * links: each folder of the path is opened from the one before, so that a
 * change in between cannot lead elsewhere.
 */
#pragma once

#include "base/status.h"

#include <stdio.h>

/* Descriptor for reading, or -1 and the reason. */
int input_open(const char *path, const char **why);
/* The same as a stream; NULL and the reason. */
FILE *input_stream(const char *path, const char **why);

/* From now on only what is below the folder, as paths that begin with its name;
 * NULL: no limit. ERR_FILE: it cannot be opened. */
status input_confine(const char *folder);
int input_is_confined(void);
