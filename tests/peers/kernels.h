/* Kernels of Siconos that need no other product. */
#pragma once

#include <Friction_cst.h>
#include <SolverOptions.h>
#include <lcp_cst.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

typedef enum { LCP, PLANE, SOLID } problem_kind;

/* Kernels that need no other product; inner: local solver of NSGS, or 0; large:
 * tries large problems too. */
/* clang-format off */
static const struct kernel {
  const char *name;
  problem_kind kind;
  int id, inner, large;
} kernels[] = {
  {"lemke",   LCP,   SICONOS_LCP_LEMKE,              0, 1},
  {"pivot",   LCP,   SICONOS_LCP_PIVOT,              0, 0},
  {"bard",    LCP,   SICONOS_LCP_BARD,               0, 0},
  {"murty",   LCP,   SICONOS_LCP_MURTY,              0, 1},
  {"pgs",     LCP,   SICONOS_LCP_PGS,                0, 0},
  {"psor",    LCP,   SICONOS_LCP_PSOR,               0, 1},
  {"cpg",     LCP,   SICONOS_LCP_CPG,                0, 0},
  {"newton",  LCP,   SICONOS_LCP_NEWTONMIN,          0, 0},
  {"fb",      LCP,   SICONOS_LCP_NEWTON_FB_FBLSA,    0, 0},
  {"min",     LCP,   SICONOS_LCP_NEWTON_MIN_FBLSA,   0, 1},
  {"caof",    LCP,   SICONOS_LCP_AVI_CAOFERRIS,      0, 0},
  {"nsgs",    PLANE, SICONOS_FRICTION_2D_NSGS,       0, 1},
  {"cpg",     PLANE, SICONOS_FRICTION_2D_CPG,        0, 1},
  {"lemke",   PLANE, SICONOS_FRICTION_2D_LEMKE,      0, 1},
  {"nsgs",    SOLID, SICONOS_FRICTION_3D_NSGS,       0, 0},
  {"nsgs_ac", SOLID, SICONOS_FRICTION_3D_NSGS,
   SICONOS_FRICTION_3D_ONECONTACT_NSN, 1},
  {"nsgs_p",  SOLID, SICONOS_FRICTION_3D_NSGS,
   SICONOS_FRICTION_3D_ONECONTACT_ProjectionOnCone, 1},
  {"nsgs_pl", SOLID, SICONOS_FRICTION_3D_NSGS,
   SICONOS_FRICTION_3D_ONECONTACT_ProjectionOnConeWithLocalIteration, 0},
  {"nsgs_q",  SOLID, SICONOS_FRICTION_3D_NSGS,
   SICONOS_FRICTION_3D_ONECONTACT_QUARTIC, 0},
  {"nsn_ac",  SOLID, SICONOS_FRICTION_3D_NSN_AC,     0, 1},
  {"nsn_act", SOLID, SICONOS_FRICTION_3D_NSN_AC_TEST, 0, 0},
  {"nsn_fb",  SOLID, SICONOS_FRICTION_3D_NSN_FB,     0, 0},
  {"nsn_nm",  SOLID, SICONOS_FRICTION_3D_NSN_NM,     0, 0},
  {"admm",    SOLID, SICONOS_FRICTION_3D_ADMM,       0, 0},
  {"prox",    SOLID, SICONOS_FRICTION_3D_PROX,       0, 0},
  {"tfp",     SOLID, SICONOS_FRICTION_3D_TFP,        0, 0},
  {"aclmfp",  SOLID, SICONOS_FRICTION_3D_ACLMFP,     0, 0},
  {"soclcp",  SOLID, SICONOS_FRICTION_3D_SOCLCP,     0, 0}};
/* clang-format on */
enum { N_KERNEL = sizeof kernels / sizeof *kernels };

/* With the tolerance of the kernel's own measure. */
static inline SolverOptions *kernel_options(const struct kernel *k,
                                            double tol) {
  SolverOptions *o = solver_options_create(k->id);
  if (k->inner) solver_options_update_internal(o, 0, k->inner);
  o->dparam[SICONOS_DPARAM_TOL] = tol;
  o->iparam[SICONOS_IPARAM_MAX_ITER] = 100000;
  return o;
}

typedef struct result {
  double cpu, measure; /* s, HUGE_VAL: no answer; residual or natural map, - */
} result;

typedef result kernel_try(const struct kernel *k, double most);

/* CPU of this thread, s: the kernels have one, and the clock of a process under
 * a limit moves by ticks. */
static inline double cpu(void) {
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* A kernel that crashes or never ends takes only its own process with it. */
static inline result kernel_apart(kernel_try *attempt, const struct kernel *k,
                                  double most) {
  int ends[2];
  result a = {HUGE_VAL, HUGE_VAL};
  fflush(stdout);
  if (pipe(ends) != 0) exit(EXIT_FAILURE);
  pid_t child = fork();
  if (child == 0) {
    rlim_t s = (rlim_t)(2.0 + 4.0 * most);
    struct rlimit time = {s, s}, core = {0, 0};
    setrlimit(RLIMIT_CPU, &time);
    setrlimit(RLIMIT_CORE, &core);
    if (freopen("/dev/null", "w", stdout) == NULL ||
        freopen("/dev/null", "w", stderr) == NULL)
      _exit(1);
    a = attempt(k, most);
    _exit(write(ends[1], &a, sizeof a) != sizeof a);
  }
  close(ends[1]);
  if (child < 0 || read(ends[0], &a, sizeof a) != sizeof a)
    a = (result){HUGE_VAL, NAN};
  close(ends[0]);
  if (child > 0) waitpid(child, NULL, 0);
  return a;
}
