/*
 * Loaded before the program (LD_PRELOAD): an invalid operation, a division by
 * zero or an overflow of floating point ends it by SIGFPE. Children that gmsh
 * makes meshes in are left alone.
 */
#define _GNU_SOURCE
#include <fenv.h>
#include <pthread.h>

static void traps_off(void) { fedisableexcept(FE_ALL_EXCEPT); }

static void traps_on(void) __attribute__((constructor));

static void traps_on(void) {
  feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
  pthread_atfork(NULL, NULL, traps_off);
}
