/* Kernel and threads of BLAS. */
#pragma once

/* BLAS kernel: see blas.c. Called first in main; may replace the process. */
void blas_choose_kernel(char **argv);
const char *blas_kernel(void); /* core name, "SkylakeX" */
int blas_kernel_changed(void); /* 1: changed at start-up */
/* Threads of BLAS and CHOLMOD; blas_choose_kernel sets 1. The environment
 * (OPENBLAS_NUM_THREADS and similar) has no effect. */
void blas_set_threads(int n);
/* The dense matrices from here on have so many rows: small ones are left to one
 * thread. INT_MAX, as at the start: any. The number before. */
int blas_rows(int rows);
