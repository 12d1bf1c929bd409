/*
 * Indentation of a half space: flat punches, pressure and stiffness without
 * friction and bonded (friction that always sticks), plane and axisymmetric, in
 * closed form; a ball with friction (Spence).
 */
#include "support/job.h"
#include "support/unit.h"

const int job_without_fields = 1;

static const double young = 1000;

/* Half disc of radius 30 (plane) or quarter of 60 (axisymmetric); the punch is
 * |x| <= 1, elements grow from its edges. */
static const char plane_geo[] =
    "L = 30; h = 0.004;\n"
    "Point(1) = {0, 0, 0}; Point(2) = {-L, 0, 0}; Point(3) = {-1, 0, 0};\n"
    "Point(4) = {1, 0, 0}; Point(5) = {L, 0, 0}; Point(6) = {0, L, 0};\n"
    "Line(1) = {2, 3}; Line(2) = {3, 1}; Line(3) = {1, 4}; Line(4) = {4, 5};\n"
    "Circle(5) = {5, 1, 6}; Circle(6) = {6, 1, 2};\n"
    "Curve Loop(1) = {1 ... 6}; Plane Surface(1) = {1};\n"
    "Transfinite Curve{5, 6} = 41;\n"
    "Physical Curve(\"FAR\") = {5, 6}; Physical Curve(\"PUNCH\") = {2, 3};\n";
static const char axial_geo[] =
    "L = 60; h = 0.004;\n"
    "Point(1) = {0, 0, 0}; Point(4) = {1, 0, 0}; Point(5) = {L, 0, 0};\n"
    "Point(6) = {0, L, 0};\nLine(3) = {1, 4}; Line(4) = {4, 5};\n"
    "Circle(5) = {5, 1, 6}; Line(6) = {6, 1};\n"
    "Curve Loop(1) = {3, 4, 5, 6}; Plane Surface(1) = {1};\n"
    "Physical Curve(\"FAR\") = {5}; Physical Curve(\"PUNCH\") = {3};\n"
    "Physical Curve(\"AXIS\") = {6};\n";
static const char sizes[] =
    "Field[1] = MathEval;\n"
    "Field[1].F = Sprintf(\"%%g + 0.08 * Sqrt((Abs(x) - 1)^2 + y^2)\", h);\n"
    "Background Field = 1; Mesh.MeshSizeExtendFromBoundary = 0;\n"
    "Mesh.MeshSizeFromPoints = 0; Physical Surface(\"BODY\") = {1};\n";

static job run_punch(const char *geo, const char *type, double nu, double mu,
                     const char *motion, const char *step) {
  job j = job_begin("punch");
  PRINTED(text, "%s%s", geo, sizes);
  job_write(&j, "punch.geo", text, 0);
  job_write(&j, "punch.inp",
            "*MESH, FILE=punch.geo\n*MATERIAL, NAME=M\n*ELASTIC\n%g, %g\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=%s\n"
            "*OBSTACLE, NAME=O, TYPE=CONFORMING\n%s"
            "*CONTACT, NAME=C, GROUP=PUNCH, OBSTACLE=O\n"
            "*FRICTION, CONTACT=C, LAW=COULOMB\n%g\n*STEP\n*STATIC\n1.\n%s"
            "*PRINT, CONTACT, TOTALS\n*END STEP\n",
            young, nu, type, motion, mu, step);
  CK_EXIT(job_run(&j, ""), 0, j);
  return j;
}

/*
 * P = 1 per thickness on |x| <= 1; far away the field of a point load. Without
 * friction p = P/(pi sqrt(1 - x^2)); bonded, with eta = ln(3 - 4 nu)/(2 pi)
 * and w = eta ln((1 + x)/(1 - x)), p = b cos w, |q| = b |sin w|,
 * b = 2 (1 - nu)/sqrt(3 - 4 nu) P/(pi sqrt(1 - x^2)) (Johnson 2.69).
 */
TEST(plane_punch_has_its_tractions) {
  static const double nu[] = {0.3, 0.3, 0.0, 0.45}, mu[] = {0, 1e6, 1e6, 1e6};
  const double pi = acos(-1.0);
  for (int i = 0; i < 4; ++i) {
    PRINTED(step,
            "*BOUNDARY\nFAR, 1, 1, "
            "\"(1+%g)/(pi*%g)*(x*y/900-(1-2*%g)*atan2(x,y))\"\n"
            "*DSLOAD\nFAR, TY, \"-2/(pi*30^3)*y^2\"\n",
            nu[i], young, nu[i]);
    JOB j = run_punch(plane_geo, "CPE3", nu[i], mu[i], "", step);
    DAT c = job_table(&j, "CONTACT", -1), t = job_table(&j, "TOTALS", -1);
    double P = dat_at(&t, 0, "normal"), eta = log(3 - 4 * nu[i]) / (2 * pi);
    int compared = 0;
    if (nu[i] == 0.3) ck_assert_double_eq_tol(eta, 0.09354915, 1e-8);
    ck_assert_double_eq_tol(P, 1, 1e-3);
    for (int k = 0; k < c.n_row; ++k) {
      double x = dat_at(&c, k, "x");
      if (fabs(x) > 0.95) continue;
      double b = P / (pi * sqrt(1 - x * x)), w = eta * log((1 + x) / (1 - x));
      double p = dat_at(&c, k, "pressure"), q = dat_at(&c, k, "traction_t");
      if (mu[i] > 0) b *= 2 * (1 - nu[i]) / sqrt(3 - 4 * nu[i]);
      if (mu[i] <= 0) w = 0;
      ck_assert_double_eq_tol(p, b * cos(w), 0.03 * b);
      ck_assert_double_eq_tol(fabs(q), b * fabs(sin(w)), 0.03 * b);
      ++compared;
    }
    ck_assert_int_gt(compared, 30);
  }
}

/* Circular punch: P = 2 E* a delta without friction, bonded greater by
 * ln(3 - 4 nu) (1 - nu)/(1 - 2 nu). The fixed half ball of radius 60 takes
 * P/(pi E* 60) off the approach. */
TEST(circular_punch_has_its_stiffness) {
  static const double nu[] = {0.3, 0.0, 0.4},
                      known[] = {1.02862666, 1.09861229, 1.00941671};
  for (int i = 0; i < 3; ++i) {
    double P[2], Es = young / (1 - nu[i] * nu[i]);
    for (int bonded = 0; bonded < 2; ++bonded) {
      JOB j =
          run_punch(axial_geo, "CAX3", nu[i], bonded ? 1e6 : 0,
                    "MOVE, 0., 0.01\n", "*BOUNDARY\nFAR, 1, 2\nAXIS, 1, 1\n");
      P[bonded] = job_value(&j, "TOTALS", -1, "normal");
    }
    double ratio = log(3 - 4 * nu[i]) * (1 - nu[i]) / (1 - 2 * nu[i]);
    ck_assert_double_eq_tol(ratio, known[i], 1e-8);
    ck_assert_double_eq_tol(P[0], 2 * Es * 0.01, 0.03 * P[0]);
    ck_assert_double_eq_tol(P[1] / P[0], ratio, 3e-3);
  }
}

/* Half space and ball, the load grows in proportion to the approach: stick up
 * to c/a for nu, mu (Spence, axisymmetric, full coupling, to 3e-4). */
TEST(ball_sticks_in_the_middle) {
  static const double cases[][3] = {{0.3, 0.2, 0.698}, {0.0, 0.3, 0.5031}};
  for (int i = 0; i < 2; ++i) {
    JOB j =
        job_with("ball", "input/spence/spence.geo",
                 "*PARAMETER\nA = 0.25\nNC = 30\nSIZE = 40\n"
                 "*MESH, FILE=spence.geo\n*MATERIAL, NAME=M\n*ELASTIC\n"
                 "%g, %g\n*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=CAX3\n"
                 "*OBSTACLE, NAME=O, TYPE=GAP\n\"x^2/20\"\n"
                 "MOVE, 0., \"t*A^2/10\"\n"
                 "*CONTACT, NAME=C, GROUP=CONTACT, OBSTACLE=O\n"
                 "*FRICTION, CONTACT=C, LAW=COULOMB\n%g\n*STEP\n"
                 "*QUASISTATIC\n0.05, 1.\n*BOUNDARY\nSYMMETRY, 1\nFAR, 1, 2\n"
                 "*PRINT, ZONES, FREQUENCY=0\n*END STEP\n",
                 young, cases[i][0], cases[i][1]);
    CK_EXIT(job_run(&j, ""), 0, j);
    DAT z = job_table(&j, "ZONES", -1);
    ck_assert_double_eq(dat_at(&z, 0, "zone"), 2.0);
    ck_assert_double_eq(dat_at(&z, 1, "zone"), 1.0);
    double c = dat_at(&z, 0, "r_to"), a = dat_at(&z, 1, "r_to");
    ck_assert_double_eq_tol(c / a, cases[i][2], 0.015);
    ck_assert_double_eq_tol(dat_at(&z, 0, "area"), acos(-1.0) * c * c,
                            1e-9 * c * c);
  }
}

UNIT_MAIN("punch")
