/* What leave.c puts in the place of the C library's; names of the linker. */
#pragma once

/* Writes the counts; of the compiler. */
void __gcov_dump(void);
/* _exit of the C library. */
void __real__exit(int code) __attribute__((noreturn));
/* _exit, with the counts written first. */
void __wrap__exit(int code) __attribute__((noreturn));
