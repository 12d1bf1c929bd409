/*
 * FORMULATION=AVERAGED near nu = 1/2, on unstructured meshes each half as fine
 * as the next, beside STANDARD, which locks:
 *   a tube under pressure (Lame; radii 1 and 2), u at the inner radius and the
 *     mean stress in the wall, which is uniform
 *   Cook's membrane, E = 1, force 1: mean displacement of the loaded side,
 *     against a program of quadratic displacements and linear pressures
 *   a half plane pressed against a parabola (Hertz), with contact
 */
#include "support/job.h"
#include "support/unit.h"

enum { MESHES = 4 };
static const char *const form[] = {"STANDARD", "AVERAGED"};

static double order_of(const double *error) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (int k = 0; k < MESHES; ++k) {
    double x = -k * log(2.0), y = log(fabs(error[k]));
    sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  return (MESHES * sxy - sx * sy) / (MESHES * sxx - sx * sx);
}

/* A line of the table; the averaged form must come near to its order. */
static void report(const char *what, const char *nu, int averaged,
                   const double *error, double expected) {
  printf("%-22s %-8s %-9s", what, nu, form[averaged]);
  for (int k = 0; k < MESHES; ++k) printf(" %10.2e", error[k]);
  printf("  %5.2f", order_of(error));
  if (averaged)
    printf("  %5.2f\n", expected);
  else
    printf("\n");
  fflush(stdout);
  if (averaged)
    ck_assert_msg(order_of(error) > 0.7 * expected, "%s, nu = %s: order %.2f",
                  what, nu, order_of(error));
}

/* Run k of a deck with its mesh; N doubles from mesh to mesh. */
static job run_mesh(const char *geo, const char *deck, int coarsest, int k,
                    const char *nu, int averaged) {
  job j = job_begin("verify");
  job_write(&j, "body.geo",
            "DefineConstant[ N = 8 ];\nMesh.MeshSizeMin = 1/N;\n"
            "Mesh.MeshSizeMax = 1/N;\n%s",
            geo);
  job_write(&j, "verify.inp",
            "*PARAMETER\nN = 8\nNU = 0.3\n*MESH, FILE=body.geo\n"
            "*MATERIAL, NAME=M\n*ELASTIC\n1., <NU>\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M, FORMULATION=%s\n%s",
            form[averaged], deck);
  PRINTED(words, "-D N=%d -D NU=%s", coarsest << k, nu);
  CK_EXIT(job_run(&j, words), 0, j);
  return j;
}

/* ---- tube -------------------------------------------------------------- */

static const char tube_geo[] =
    "Point(1) = {1, 0, 0}; Point(2) = {2, 0, 0}; Point(3) = {0, 2, 0};\n"
    "Point(4) = {0, 1, 0}; Point(5) = {0, 0, 0};\n"
    "Line(1) = {1, 2}; Circle(2) = {2, 5, 3}; Line(3) = {3, 4};\n"
    "Circle(4) = {4, 5, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};\n"
    "Physical Surface(\"BODY\") = {1}; Physical Curve(\"INSIDE\") = {4};\n"
    "Physical Curve(\"ALONG_X\") = {1}; Physical Curve(\"ALONG_Y\") = {3};\n";
static const char tube_deck[] =
    "*STEP\n*STATIC\n*BOUNDARY\nALONG_X, 2\nALONG_Y, 1\n*DSLOAD\n"
    "INSIDE, P, 1.\n*PRINT, NODES, ELEMENTS\n*END STEP\n";

/* Errors of u at the inner radius and of the mean stress, E = p = 1. */
static void tube_errors(const job *j, double nu, double *u_error,
                        double *p_error) {
  dat u = job_table(j, "NODES", -1), t = job_table(j, "ELEMENTS", -1);
  /* u_r = (1 + nu)/3 ((1 - 2 nu) r + 4/r), mean stress 2 (1 + nu)/9. */
  double exact = (1 + nu) / 3 * (5 - 2 * nu), sum = 0, square = 0;
  int n = 0;
  for (int i = 0; i < u.n_row; ++i) {
    double x = dat_at(&u, i, "x"), y = dat_at(&u, i, "y"), r = hypot(x, y);
    if (r > 1 + 1e-6) continue;
    sum += (x * dat_at(&u, i, "u_x") + y * dat_at(&u, i, "u_y")) / r;
    ++n;
  }
  *u_error = sum / n / exact - 1;
  for (int i = 0; i < t.n_row; ++i) {
    double mean = (dat_at(&t, i, "stress_xx") + dat_at(&t, i, "stress_yy") +
                   dat_at(&t, i, "stress_zz")) /
                  3;
    square += pow(mean - 2 * (1 + nu) / 9, 2);
  }
  *p_error = sqrt(square / t.n_row);
  dat_free(&u);
  dat_free(&t);
}

static const char *const ratios[] = {"0.3", "0.49", "0.499", "0.4999",
                                     "0.49999"};

TEST(tube) {
  for (int i = 0; i < 5; ++i)
    for (int averaged = 0; averaged < 2; ++averaged) {
      double u[MESHES], p[MESHES];
      for (int k = 0; k < MESHES; ++k) {
        job j = run_mesh(tube_geo, tube_deck, 8, k, ratios[i], averaged);
        tube_errors(&j, atof(ratios[i]), &u[k], &p[k]);
        job_end(&j);
      }
      report("tube, u at r = 1", ratios[i], averaged, u, 2);
      report("tube, mean stress", ratios[i], averaged, p, 1);
    }
}

/* ---- Cook's membrane ---------------------------------------------------- */

static const char cook_geo[] =
    "Mesh.MeshSizeMin = 16/N; Mesh.MeshSizeMax = 16/N;\n"
    "Point(1) = {0, 0, 0}; Point(2) = {48, 44, 0}; Point(3) = {48, 60, 0};\n"
    "Point(4) = {0, 44, 0}; Line(1) = {1, 2}; Line(2) = {2, 3};\n"
    "Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1:4};\n"
    "Plane Surface(1) = {1}; Physical Surface(\"BODY\") = {1};\n"
    "Physical Curve(\"RIGHT\") = {2}; Physical Curve(\"LEFT\") = {4};\n";
static const char cook_deck[] =
    "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1, 2\n*DSLOAD\nRIGHT, TY, 0.0625\n"
    "*PRINT, ENERGY\n*END STEP\n";
/* Twice the energy, from quadratic displacements and linear pressures on
 * meshes graded to the upper left corner, the last change 3e-4. */
static const double cook_4999 = 18.567;

TEST(cook) {
  for (int averaged = 0; averaged < 2; ++averaged) {
    double error[MESHES];
    for (int k = 0; k < MESHES; ++k) {
      job j = run_mesh(cook_geo, cook_deck, 4, k, "0.4999", averaged);
      dat e = job_table(&j, "ENERGY", -1);
      error[k] = 2 * dat_at(&e, 0, "strain_energy") / cook_4999 - 1;
      dat_free(&e);
      job_end(&j);
    }
    report("Cook, mean u_y", "0.4999", averaged, error, 1);
  }
}

/* ---- Hertz --------------------------------------------------------------- */

static const char hertz_deck[] =
    "*PARAMETER\nR = 10.\nP = 1000.\nE = 210.D3\nNU = 0.3\n"
    "A = \"sqrt(4*P*R*(1 - NU^2)/(pi*E))\"\nSIZE = 100\nNC = 8\n"
    "GROWTH = 0.12\n*MESH, FILE=hertz_block.geo\n*MATERIAL, NAME=M\n*ELASTIC\n"
    "<E>, <NU>\n*SOLID SECTION, ELSET=BODY, MATERIAL=M, FORMULATION=%s\n"
    "*OBSTACLE, NAME=O, TYPE=GAP\n\"x^2/(2*R)\"\n"
    "*CONTACT, NAME=C, GROUP=CONTACT, OBSTACLE=O\n*STEP\n*STATIC\n"
    "*BOUNDARY\nSYMMETRY, 1, 1, 0.\n*DSLOAD\nTOP, P, \"P/(2*SIZE*A)\"\n"
    "*PRINT, CONTACT\n*END STEP\n";

/* Root mean square error of the pressure up to 0.95 a, over p0. */
static double hertz_error(const job *j, double nu) {
  dat c = job_table(j, "CONTACT", -1);
  double pi = acos(-1.0), square = 0;
  double a = sqrt(4 * 1000 * 10 * (1 - nu * nu) / (pi * 210e3));
  int n = 0;
  for (int i = 0; i < c.n_row; ++i) {
    double x = dat_at(&c, i, "x") / a;
    if (x > 0.95) continue;
    double p = dat_at(&c, i, "pressure") * pi * a / 2000;
    square += pow(p - sqrt(1 - x * x), 2);
    ++n;
  }
  dat_free(&c);
  return sqrt(square / n);
}

TEST(hertz) {
  for (int i = 0; i < 5; i += 3)
    for (int averaged = 0; averaged < 2; ++averaged) {
      double error[MESHES];
      for (int k = 0; k < MESHES; ++k) {
        int n = 8 << k;
        job j = job_with("verify", "input/hertz_line/hertz_block.geo",
                         hertz_deck, form[averaged]);
        PRINTED(words, "-D NU=%s -D NC=%d -D GROWTH=%g", ratios[i], n, 2.0 / n);
        CK_EXIT(job_run(&j, words), 0, j);
        error[k] = hertz_error(&j, atof(ratios[i]));
        job_end(&j);
      }
      report("Hertz, pressure", ratios[i], averaged, error, 1);
    }
}

int main(void) {
  printf("%-22s %-8s %-9s %-43s  order  expected\n", "error of", "nu", "form",
         " on four meshes");
  fflush(stdout);
  return unit_run("incompressible", UNIT_SECONDS);
}
