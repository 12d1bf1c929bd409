/* What refuse.c puts in the place of the C library's. */
#pragma once

#include <stddef.h>

/* stdlib.h: NULL with ENOMEM, or ENOMEM, if the request is refused. */
void *malloc(size_t n);
/* As malloc. */
void *calloc(size_t n, size_t size);
/* As malloc. */
void *realloc(void *p, size_t n);
/* As malloc. */
void *memalign(size_t alignment, size_t n);
/* As malloc. */
void *aligned_alloc(size_t alignment, size_t n);
/* As malloc; answers ENOMEM. */
int posix_memalign(void **p, size_t alignment, size_t n);
/* stdlib.h. */
void free(void *p);
/* Calls main, with the counting begun. */
int __libc_start_main(int (*f)(int, char **, char **), int argc, char **argv,
                      void (*init)(void), void (*fini)(void), void (*end)(void),
                      void *stack);
