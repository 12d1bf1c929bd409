/* Kernels of Siconos that need no other product. */
#ifndef PROTIS_PEERS_KERNELS_H
#define PROTIS_PEERS_KERNELS_H

#include <Friction_cst.h>
#include <SolverOptions.h>
#include <lcp_cst.h>

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

#endif
