/*
 * The deck of the creeping block and its runs.
 */
#include "support/creep_case.h"

#include "support/job.h"
#include "support/unit.h"

#include <math.h>

/* Displacements at the end. */
static dat slide(const char *law, const char *integrator, int n) {
  job j = job_begin("creep");
  job_copy(&j, "tests/regression/mesh/square.geo");
  job_write(&j, "creep.inp",
            "*PARAMETER\nN = 2\n*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n"
            "*ELASTIC\n1000., 0.3\n%s"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=CPE3\n"
            "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
            "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
            "*FRICTION, CONTACT=C, LAW=COULOMB\n0.1\n"
            "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\n*DSLOAD\nTOP, P, 10.\n"
            "*END STEP\n*STEP\n*VISCO, INTEGRATOR=%s\n%.17g, 2.\n"
            "*SOLVER, METHOD=NEWTON, TOL=1E-14\n"
            "*PRINT, NODES, CONTACT, FREQUENCY=0\n*OUTPUT, HDF5=NO\n"
            "*END STEP\n",
            law, integrator, 2.0 / n);
  int code = job_run(&j, "--no-timing"), slips = 0;
  ck_assert_msg(code == 0, "%s: exit %d: %s", integrator, code, j.errors);
  dat c = job_table(&j, "CONTACT", -1);
  for (int i = 0; i < c.n_row; ++i) slips += dat_at(&c, i, "status") == 1;
  ck_assert_int_eq(slips, c.n_row - 1);
  dat_free(&c);
  dat u = job_table(&j, "NODES", -1);
  job_end(&j);
  return u;
}

static double distance(const dat *a, const dat *b) {
  double sum = 0;
  for (int i = 0; i < a->n_row; ++i) {
    sum += pow(dat_at(a, i, "u_x") - dat_at(b, i, "u_x"), 2);
    sum += pow(dat_at(a, i, "u_y") - dat_at(b, i, "u_y"), 2);
  }
  return sqrt(sum);
}

double creep_case_order(const char *law, const char *integrator, int n) {
  dat u[3];
  for (int k = 0; k < 3; ++k) u[k] = slide(law, integrator, n << k);
  double order = log2(distance(&u[0], &u[1]) / distance(&u[1], &u[2]));
  for (int k = 0; k < 3; ++k) dat_free(&u[k]);
  return order;
}
