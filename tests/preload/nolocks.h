/* What nolocks.c puts in the place of the C library's: locks fail. */
#pragma once

#include <sys/types.h>

/* sys/file.h. */
int flock(int fd, int how);
/* unistd.h. */
int lockf(int fd, int how, off_t bytes);
/* Locks fail, other commands go to the C library. */
int fcntl(int fd, int command, ...);
