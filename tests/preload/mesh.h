/* What mesh.c puts before the C library's: each calls the one it hides. */
#ifndef PROTIS_TESTS_PRELOAD_MESH_H
#define PROTIS_TESTS_PRELOAD_MESH_H

#include <stddef.h>
#include <sys/types.h>

/* Notes the descriptor that gets FD_CLOEXEC. */
int fcntl(int fd, int command, ...);
/* libgmsh: gives out the stream and ends, if it is kept. */
void *dlopen(const char *file, int flags);
/* Copies the stream. */
ssize_t write(int fd, const void *data, size_t n);
/* Keeps a stream that was sent to its end. */
void _exit(int code);

#endif
