/*
 * Estimated over true error of the mesh in the energy norm, for problems whose
 * solution *REFERENCE has in closed form, each on two meshes: in the plane, in
 * axisymmetry, in space, across an interface between materials, at the edge of
 * a contact, under sliding. Expected: between 0.7 and 1.5.
 *
 * Manufactured with nu = 0, E = 1000, a = -0.01: the body force is -div sigma,
 * the floor y = 0 (z = 0) carries p = -sigma_nn > 0.
 *   plane    u = a (sin x cos y, cos x sin y),
 *            sigma = E a (cos x cos y, cos x cos y, -sin x sin y)
 *   sliding  u_x + 2 mu a cos x sin y, which adds -mu p to sigma_xy at y = 0
 *   axi      u = a (r cos z, (1 + r^2) sin z)
 *   solid    u = a (sin x cos y cos z, ...)
 *   layers   sigma_yy = -10 cos y, E = 1000 below y = 1/2, 4000 above
 */
#include "support/job.h"
#include "support/unit.h"

typedef struct problem {
  const char *name, *mesh, *section, *friction, *reference, *step;
  int n[2];
} problem;

#define ALL(group, u_x, u_y) \
  group ", 1, 1, \"" u_x "\"\n" group ", 2, 2, \"" u_y "\"\n"
#define UX "A*sin(x)*cos(y)"
#define UY "A*cos(x)*sin(y)"
#define SLIDE UX " + 2*MU*A*cos(x)*sin(y)"
#define VX "A*sin(x)*cos(y)*cos(z)"
#define VY "A*cos(x)*sin(y)*cos(z)"
#define VZ "A*cos(x)*cos(y)*sin(z)"
#define BOX(g) \
  g ", 1, 1, \"" VX "\"\n" g ", 2, 2, \"" VY "\"\n" g ", 3, 3, \"" VZ "\"\n"
#define WR "A*x*cos(y)"
#define WZ "A*(1 + x^2)*sin(y)"

/* clang-format off */
static const problem problems[] = {
  {"plane", "square.geo", "", "",
   "u_x, \"" UX "\"\nu_y, \"" UY "\"\npressure, \"-E*A*cos(x)\"\n",
   ALL("LEFT", UX, UY) ALL("RIGHT", UX, UY) ALL("TOP", UX, UY)
   "*DLOAD\nBODY, BX, \"2*E*A*sin(x)*cos(y)\"\n"
   "BODY, BY, \"2*E*A*cos(x)*sin(y)\"\n", {8, 16}},
  {"plane stress", "square.geo", ", TYPE=CPS3", "",
   "stress_xx, \"E*A*cos(x)*cos(y)\"\nstress_yy, \"E*A*cos(x)*cos(y)\"\n"
   "stress_zz, 0\nstress_xy, \"-E*A*sin(x)*sin(y)\"\n",
   ALL("LEFT", UX, UY) ALL("RIGHT", UX, UY) ALL("TOP", UX, UY)
   "*DLOAD\nBODY, BX, \"2*E*A*sin(x)*cos(y)\"\n"
   "BODY, BY, \"2*E*A*cos(x)*sin(y)\"\n", {8, 16}},
  {"sliding", "square.geo", "",
   "*PARAMETER\nMU = 0.3\n*FRICTION, CONTACT=C, LAW=COULOMB\n<MU>\n",
   "u_x, \"" SLIDE "\"\nu_y, \"" UY "\"\npressure, \"-E*A*cos(x)\"\n",
   ALL("LEFT", SLIDE, UY) ALL("RIGHT", SLIDE, UY) ALL("TOP", SLIDE, UY)
   "*DLOAD\nBODY, BX, \"2*E*A*sin(x)*cos(y) + 3*MU*E*A*cos(x)*sin(y)\"\n"
   "BODY, BY, \"2*E*A*cos(x)*sin(y) + MU*E*A*sin(x)*cos(y)\"\n", {8, 16}},
  {"axisymmetry", "square.geo", ", TYPE=CAX3", "",
   "u_r, \"" WR "\"\nu_z, \"" WZ "\"\npressure, \"-E*A*(1 + x^2)\"\n",
   "LEFT, 1\n" ALL("RIGHT", WR, WZ) ALL("TOP", WR, WZ)
   "*DLOAD\nBODY, BX, \"-E*A*x*cos(y)/2\"\nBODY, BY, \"E*A*x^2*sin(y)\"\n",
   {8, 16}},
  {"space", "cube.geo", "", "",
   "u_x, \"" VX "\"\nu_y, \"" VY "\"\nu_z, \"" VZ "\"\n"
   "pressure, \"-E*A*cos(x)*cos(y)\"\n",
   BOX("LEFT") BOX("RIGHT") BOX("FRONT") BOX("BACK") BOX("TOP")
   "*DLOAD\nBODY, BX, \"3*E*" VX "\"\nBODY, BY, \"3*E*" VY "\"\n"
   "BODY, BZ, \"3*E*" VZ "\"\n", {4, 8}}};
/* clang-format on */

/* A line of the table. */
static void report(const char *name, int n, const job *j) {
  double estimate = job_told(j, "mesh_error_percent");
  double is = job_told(j, "true_error_percent"), ratio = estimate / is;
  printf("%-14s %4d %10.0f %12.3f %12.3f %12.2f\n", name, n,
         job_told(j, "unknowns"), is, estimate, ratio);
  fflush(stdout);
  ck_assert_msg(ratio > 0.7 && ratio < 1.5, "%s: effectivity %g", name, ratio);
}

TEST(head) {
  printf("%-14s %4s %10s %12s %12s %12s\n", "error of mesh", "N", "unknowns",
         "true[%]", "estimate[%]", "effectivity");
  fflush(stdout);
}

TESTS(manufactured, sizeof problems / sizeof *problems) {
  const problem *p = &problems[_i];
  for (int k = 0; k < 2; ++k) {
    JOB j = job_begin("verify");
    PRINTED(path, "tests/regression/mesh/%s", p->mesh);
    job_copy(&j, path);
    job_write(&j, "verify.inp",
              "*PARAMETER\nN = %d\nE = 1000.\nA = -0.01\n"
              "*MESH, FILE=%s\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n"
              "*SOLID SECTION, ELSET=BODY, MATERIAL=M%s\n"
              "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
              "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n%s*REFERENCE\n%s"
              "*STEP\n*STATIC\n*BOUNDARY\n%s*ACCURACY, MESH=YES\n*END STEP\n",
              p->n[k], p->mesh, p->section, p->friction, p->reference, p->step);
    int code = job_run(&j, "");
    ck_assert_msg(code == 0, "%s: exit %d: %s", p->name, code, j.errors);
    report(p->name, p->n[k], &j);
  }
}

TEST(interface) {
  for (int n = 8; n <= 16; n *= 2) {
    JOB j =
        job_with("verify", "tests/regression/mesh/layers.geo",
                 "*PARAMETER\nN = %d\n*MESH, FILE=layers.geo\n"
                 "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n"
                 "*MATERIAL, NAME=K\n*ELASTIC\n4000., 0.\n"
                 "*SOLID SECTION, ELSET=SOFT, MATERIAL=M\n"
                 "*SOLID SECTION, ELSET=HARD, MATERIAL=K\n"
                 "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
                 "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n*REFERENCE\n"
                 "stress_xx, 0\nstress_yy, \"-10*cos(y)\"\nstress_zz, 0\n"
                 "stress_xy, 0\npressure, 10\n*STEP\n*STATIC\n*BOUNDARY\n"
                 "LEFT, 1\n*DSLOAD\nTOP, TY, \"-10*cos(1)\"\n"
                 "*DLOAD\nSOFT, BY, \"-10*sin(y)\"\nHARD, BY, \"-10*sin(y)\"\n"
                 "*ACCURACY, MESH=YES\n*END STEP\n",
                 n);
    CK_EXIT(job_run(&j, ""), 0, j);
    report("interface", n, &j);
  }
}

TEST(contact_edge) {
  for (int n = 8; n <= 16; n *= 2) {
    JOB j = job_begin("hertz");
    PRINTED(words, "-D N=%d", n);
    ck_assert_int_eq(job_run_deck(&j, "input/hertz_line/hertz_exact", words),
                     0);
    report("contact edge", n, &j);
  }
}

UNIT_MAIN_FOR("effectivity", 300)
