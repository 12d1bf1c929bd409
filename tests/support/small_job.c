/*
 * Small jobs for runs that are killed, starved and disturbed.
 */
#include "support/small_job.h"

#include <string.h>

/* Those of the step, unless the cards say which. */
static const char *fields_of(const char *cards) {
  return strstr(cards, "*OUTPUT") == NULL ? "*OUTPUT\n" : "";
}

job small_flat(double mu, const char *cards, const char *method) {
  job j =
      job_with("block", "input/greco/greco.geo",
               "*PARAMETER\nN = 8\n*MESH, FILE=greco.geo\n*MATERIAL, NAME=M\n"
               "*ELASTIC\n130.D3, 0.2\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
               "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
               "*CONTACT, NAME=C, GROUP=CONTACT, OBSTACLE=O\n"
               "*FRICTION, CONTACT=C, LAW=COULOMB\n%g\n*STEP\n*QUASISTATIC\n"
               "0.25, 1.\n*BOUNDARY\nTOP, 2, 2, -0.02\nTOP, 1, 1, 0.02\n"
               "*SOLVER, METHOD=%s\n*PRINT, CONTACT, LOOP\n%s%s"
               "*END STEP\n*STEP\n*QUASISTATIC\n0.25, 1.\n"
               "*BOUNDARY\nTOP, 1, 1, -0.01\n*END STEP\n",
               mu, method, fields_of(cards), cards);
  return j;
}

job small_solid(double mu, const char *cards, const char *method) {
  job j =
      job_with("solid", "input/block_shear_3d/block_shear_3d.geo",
               "*PARAMETER\nN = 4\nNZ = 2\n*MESH, FILE=block_shear_3d.geo\n"
               "*MATERIAL, NAME=M\n*ELASTIC\n210.D3, 0.3\n"
               "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
               "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0., 0.\n0., 0., 1.\n"
               "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
               "*FRICTION, CONTACT=C, LAW=COULOMB\n%g\n*STEP\n*QUASISTATIC\n"
               "0.5, 1.\n*BOUNDARY\nTOP, 1, 1, 0.03\nTOP, 2, 2, 0.\n"
               "TOP, 3, 3, -0.02\n*SOLVER, METHOD=%s\n*PRINT, CONTACT\n%s"
               "%s*END STEP\n*STEP\n*QUASISTATIC\n0.25, 1.\n*BOUNDARY\n"
               "TOP, 2, 2, 0.05\n*END STEP\n",
               mu, method, fields_of(cards), cards);
  return j;
}

job small_creep(double mu, const char *cards, const char *method) {
  job j =
      job_with("creep", "input/creep_block/creep_block.geo",
               "*PARAMETER\nN = 8\n*MESH, FILE=creep_block.geo\n"
               "*MATERIAL, NAME=M\n*ELASTIC\n130.D3, 0.2\n"
               "*INELASTIC, LAW=MAXWELL\n4.\n"
               "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
               "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
               "*CONTACT, NAME=C, GROUP=CONTACT, OBSTACLE=O\n"
               "*FRICTION, CONTACT=C, LAW=COULOMB\n%g\n*STEP\n*QUASISTATIC\n"
               "0.5, 1.\n*BOUNDARY\nSYMMETRY, 1\n*DSLOAD\nTOP, P, 50.\n"
               "LEFT, P, 150.\n*PRINT, CONTACT, ENERGY\n%s%s*END STEP\n"
               "*STEP\n*VISCO, %s\n0.5, 4.\n*ACCURACY, TIME=YES\n*END STEP\n",
               mu, fields_of(cards), cards, method);
  return j;
}
