/*
 * Patches that P1 elements reproduce exactly on every mesh: uniform stress over
 * unilateral contact with and without friction. Expected values are the
 * closed forms of homogeneous elasticity (E = 1000, load 10), derived below.
 */
#include "support/folder.h"
#include "support/job.h"
#include "support/unit.h"

const int job_without_fields = 1;

static const double E = 1000.0;

/* u_c = k[c][0] + k[c][1] x + k[c][2] y + k[c][3] z */
typedef double field[3][4];

/* Largest |u - exact| over the largest |u| of the NODES table. */
static double field_error(const dat *d, int dim, field k) {
  static const char *const x[] = {"x", "y", "z"};
  static const char *const u[] = {"u_x", "u_y", "u_z"};
  double worst = 0.0, scale = 0.0;
  for (int i = 0; i < d->n_row; ++i)
    for (int c = 0; c < dim; ++c) {
      double exact = k[c][0];
      for (int a = 0; a < dim; ++a) exact += k[c][a + 1] * dat_at(d, i, x[a]);
      worst = fmax(worst, fabs(dat_at(d, i, u[c]) - exact));
      scale = fmax(scale, fabs(exact));
    }
  return worst / scale;
}

/* Deck of a block on a conforming floor. */
typedef struct block {
  const char *geo;     /* mesh file                                           */
  const char *numbers; /* lines for *PARAMETER                                */
  double nu;
  const char *section, *floor, *friction, *step;
  int averaged; /* 1: the whole of the volume, for the material might flow    */
} block;

#define AVERAGED ", FORMULATION=AVERAGED"

static job run_block(const block *b, const char *words, int expected) {
  job j = job_begin("patch");
  PRINTED(path, "tests/regression/mesh/%s", b->geo);
  job_copy(&j, path);
  job_write(&j, "patch.inp",
            "*PARAMETER\n%s\n*MESH, FILE=%s\n*MATERIAL, NAME=M\n*ELASTIC\n"
            "1000., %.17g\n%s*SOLID SECTION, ELSET=BODY, MATERIAL=M%s%s\n"
            "*OBSTACLE, NAME=O, TYPE=CONFORMING\n%s%s*STEP\n%s"
            "*PRINT, NODES, CONTACT, TOTALS, ENERGY\n*END STEP\n",
            b->numbers, b->geo, b->nu,
            b->averaged ? "*INELASTIC, LAW=MAXWELL\n1.\n" : "", b->section,
            b->averaged ? AVERAGED : "", b->floor, b->friction, b->step);
  CK_EXIT(job_run(&j, words), expected, j);
  return j;
}

#define FLOOR "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
#define COULOMB(mu) "*FRICTION, CONTACT=C, LAW=COULOMB\n" #mu "\n"

static const char *const meshes[] = {"N = 1\nKIND = 1", "N = 3\nKIND = 0",
                                     "N = 4\nKIND = 2", "N = 7\nKIND = 0"};
enum { MESHES = sizeof meshes / sizeof *meshes };

/* (a) nu = 0 pressed by 10: u_y = -10 y / E, node forces 10 times their
 * tributary lengths, no shear; any friction. */
TESTS(pressed_block_without_poisson, 2) {
  static const char *const friction[] = {"", COULOMB(0.0), COULOMB(0.3),
                                         COULOMB(1.0e6)};
  for (int k = _i; k < MESHES; k += 1 + _i)
    for (int f = 0; f < 4; ++f) {
      block b = {"square.geo",
                 meshes[k],
                 0.0,
                 "",
                 FLOOR,
                 friction[f],
                 "*STATIC\n*BOUNDARY\nLEFT, 1\n*DSLOAD\nTOP, P, 10.\n",
                 _i};
      JOB j = run_block(&b, "", 0);
      DAT u = job_table(&j, "NODES", -1), c = job_table(&j, "CONTACT", -1);
      field exact = {{0}, {0, 0, -10.0 / E}};
      ck_assert_double_le(field_error(&u, 2, exact), 1e-10);
      int n = c.n_row - 1; /* segments of equal length */
      for (int i = 0; i <= n; ++i) {
        double x = dat_at(&c, i, "x");
        int end = x < 1e-9 || x > 1 - 1e-9;
        ck_assert_double_eq_tol(dat_at(&c, i, "f_n"),
                                10.0 / n * (end ? 0.5 : 1.0), 1e-9);
        ck_assert_double_le(fabs(dat_at(&c, i, "f_t")), 1e-9);
      }
    }
}

/* (b) frictionless with nu = 0.3: uniaxial stress -10, free to widen. */
TESTS(widening_block_in_all_kinematics, 2) {
  const double nu = 0.3, p = 10.0;
  const struct {
    const char *section;
    double ex, ey;
  } kind[] = {{", TYPE=CPE3", nu * (1 + nu) * p / E, -(1 - nu * nu) * p / E},
              {", TYPE=CPS3", nu * p / E, -p / E},
              {", TYPE=PLANE STRESS, THICKNESS=0.25", nu * p / E, -p / E}};
  for (int k = _i; k < MESHES; k += 1 + _i)
    for (int s = 0; s < 3; ++s) {
      block b = {"square.geo",
                 meshes[k],
                 nu,
                 kind[s].section,
                 FLOOR,
                 "",
                 "*STATIC\n*BOUNDARY\nLEFT, 1\n*DSLOAD\nTOP, P, 10.\n",
                 _i};
      JOB j = run_block(&b, "", 0);
      DAT u = job_table(&j, "NODES", -1);
      field exact = {{0, kind[s].ex, 0}, {0, 0, kind[s].ey}};
      ck_assert_double_le(field_error(&u, 2, exact), 1e-10);
      FREED char *lst = job_file(&j, "lst"); /* all errors are rounding */
      ck_assert_ptr_null(strstr(lst, "improve next"));
    }
}

TESTS(widening_cylinder, 2) {
  const double nu = 0.3, p = 10.0;
  for (int k = _i; k < MESHES; k += 1 + _i) {
    block b = {"square.geo",
               meshes[k],
               nu,
               ", TYPE=AXISYMMETRIC",
               FLOOR,
               "",
               "*STATIC\n*BOUNDARY\nLEFT, 1\n*DSLOAD\nTOP, P, 10.\n",
               _i};
    JOB j = run_block(&b, "", 0);
    DAT u = job_table(&j, "NODES", -1), t = job_table(&j, "TOTALS", -1);
    for (int i = 0; i < u.n_row; ++i) {
      double r = dat_at(&u, i, "r"), z = dat_at(&u, i, "z");
      ck_assert_double_eq_tol(dat_at(&u, i, "u_r"), nu * p / E * r, 1e-12);
      ck_assert_double_eq_tol(dat_at(&u, i, "u_z"), -p / E * z, 1e-12);
    }
    /* p times the area of the disc of radius 1. */
    ck_assert_double_eq_tol(dat_at(&t, 0, "normal"), p * acos(-1.0), 1e-9);
  }
}

TESTS(widening_cube, 2) {
  const double nu = 0.3, p = 10.0;
  block b = {"cube.geo",
             "N = 3",
             nu,
             "",
             FLOOR,
             "",
             "*STATIC\n*BOUNDARY\nLEFT, 1\nFRONT, 2\n*DSLOAD\nTOP, P, 10.\n",
             _i};
  JOB j = run_block(&b, "", 0);
  DAT u = job_table(&j, "NODES", -1);
  field exact = {
      {0, nu * p / E, 0, 0}, {0, 0, nu * p / E, 0}, {0, 0, 0, -p / E}};
  ck_assert_double_le(field_error(&u, 3, exact), 1e-10);
}

/* (c) floor and wall, both unilateral: the corner node touches two obstacles.
 * Plane strain under px on x = 1 and py on y = 1. */
TESTS(redundant_corner, 2) {
  const double nu = 0.3, py = 10.0;
  for (int k = _i; k < MESHES; k += 1 + _i)
    for (int pushed = 0; pushed < 2; ++pushed) {
      double px = pushed ? 4.0 : 0.0;
      PRINTED(step, "*STATIC\n*DSLOAD\nRIGHT, P, %g\nTOP, P, %g\n", px, py);
      block b = {"square.geo",
                 meshes[k],
                 nu,
                 "",
                 FLOOR "*CONTACT, NAME=W, GROUP=LEFT, OBSTACLE=O\n",
                 "",
                 step,
                 _i};
      JOB j = run_block(&b, "", 0);
      DAT u = job_table(&j, "NODES", -1), t = job_table(&j, "TOTALS", -1);
      double ex = -(1 + nu) / E * ((1 - nu) * px - nu * py);
      double ey = -(1 + nu) / E * ((1 - nu) * py - nu * px);
      field exact = {{0, ex, 0}, {0, 0, ey}};
      ck_assert_double_le(field_error(&u, 2, exact), 1e-10);
      ck_assert_double_eq_tol(dat_at(&t, 0, "force_y"), py, 1e-9);
      ck_assert_double_eq_tol(
          dat_at(&t, 0, "force_x") + dat_at(&t, 1, "force_x"), px, 1e-9);
    }
}

/* (d) as (a) with no Dirichlet at all; without friction nothing holds x. */
TESTS(contact_alone_holds_the_block, 2) {
  static const char *const friction[] = {COULOMB(0.01), COULOMB(0.3),
                                         COULOMB(10.0)};
  for (int k = _i; k < MESHES; k += 1 + _i) {
    for (int f = 0; f < 3; ++f) {
      block b = {"square.geo",
                 meshes[k],
                 0.0,
                 "",
                 FLOOR,
                 friction[f],
                 "*STATIC\n*DSLOAD\nTOP, P, 10.\n",
                 _i};
      JOB j = run_block(&b, "", 0);
      DAT u = job_table(&j, "NODES", -1);
      field exact = {{0}, {0, 0, -10.0 / E}};
      ck_assert_double_le(field_error(&u, 2, exact), 1e-10);
    }
    block b = {"square.geo",
               meshes[k],
               0.0,
               "",
               FLOOR,
               "",
               "*STATIC\n*DSLOAD\nTOP, P, 10.\n",
               _i};
    JOB j = run_block(&b, "", 6);
    ck_assert_ptr_nonnull(strstr(j.errors, "translation along x"));
  }
}

/* Elements of aspect 1e4: the same patches to 1e-6. */
TESTS(slivers_keep_the_patch, 2) {
  block b = {"square.geo",
             "N = 4\nKIND = 1\nLY = 1.E-4",
             0.3,
             "",
             FLOOR,
             "",
             "*STATIC\n*BOUNDARY\nLEFT, 1\n*DSLOAD\nTOP, P, 10.\n",
             _i};
  JOB j = run_block(&b, "", 0);
  DAT u = job_table(&j, "NODES", -1);
  field exact = {{0, 0.3 * 1.3 * 10 / E, 0}, {0, 0, -0.91 * 10 / E}};
  ck_assert_double_le(field_error(&u, 2, exact), 1e-6);
}

/*
 * Slip patch: nu = 0, top moved by Ux and pressed down by p H / E, shear mu p
 * on the sides. Then sigma_xy = mu p, u_x = Ux + (mu p / G)(y - H), and the
 * foot slips by Ux - mu p H / G = 0.004 for Ux = 0.01, mu = 0.3, p = 10.
 */
TESTS(slip_patch_in_the_plane, 2) {
  for (int k = _i; k < MESHES; k += 1 + _i) {
    block b = {"square.geo",
               meshes[k],
               0.0,
               "",
               FLOOR,
               COULOMB(0.3),
               "*QUASISTATIC\n1., 1.\n*BOUNDARY\nTOP, 1, 1, 0.01\n"
               "TOP, 2, 2, -0.01\n*DSLOAD\nRIGHT, TY, 3.\nLEFT, TY, -3.\n",
               _i};
    JOB j = run_block(&b, "", 0);
    DAT u = job_table(&j, "NODES", -1), c = job_table(&j, "CONTACT", -1);
    field exact = {{0.004, 0, 0.006}, {0, 0, -0.01}};
    ck_assert_double_le(field_error(&u, 2, exact), 1e-10);
    for (int i = 0; i < c.n_row; ++i) {
      ck_assert_double_eq_tol(dat_at(&c, i, "f_x"), -0.3 * dat_at(&c, i, "f_n"),
                              1e-9);
      ck_assert_double_eq_tol(fabs(dat_at(&c, i, "slip")), 0.004, 1e-12);
      ck_assert_double_eq(dat_at(&c, i, "status"), 1.0);
    }
  }
}

/* The same held by friction: Ux = 0.005 < mu p H / G, shear G Ux / H. */
TESTS(stick_patch_in_the_plane, 2) {
  block b = {"square.geo",
             meshes[1],
             0.0,
             "",
             FLOOR,
             COULOMB(0.3),
             "*QUASISTATIC\n0.25, 1.\n*BOUNDARY\nTOP, 1, 1, 0.005\n"
             "TOP, 2, 2, -0.01\n*DSLOAD\nRIGHT, TY, 2.5\nLEFT, TY, -2.5\n",
             _i};
  JOB j = run_block(&b, "", 0);
  DAT u = job_table(&j, "NODES", -1), c = job_table(&j, "CONTACT", -1);
  field exact = {{0, 0, 0.005}, {0, 0, -0.01}};
  ck_assert_double_le(field_error(&u, 2, exact), 1e-10);
  for (int i = 0; i < c.n_row; ++i)
    ck_assert_double_eq(dat_at(&c, i, "status"), 2.0);
}

/* In 3-D along any direction: the cone is exact, no facets. */
TESTS(slip_patch_at_any_angle, 2) {
  static const double degrees[] = {0.0, 17.0, 45.0, 100.0, 211.0};
  for (int k = _i; k < 5; k += 1 + 3 * _i) {
    double a = degrees[k] * acos(-1.0) / 180.0, c = cos(a), s = sin(a);
    PRINTED(step,
            "*QUASISTATIC\n1., 1.\n*BOUNDARY\nTOP, 1, 1, %.17g\n"
            "TOP, 2, 2, %.17g\nTOP, 3, 3, -0.01\n*DSLOAD\nRIGHT, TZ, %.17g\n"
            "LEFT, TZ, %.17g\nBACK, TZ, %.17g\nFRONT, TZ, %.17g\n",
            0.01 * c, 0.01 * s, 3 * c, -3 * c, 3 * s, -3 * s);
    block b = {"cube.geo", "N = 3", 0.0, "", FLOOR, COULOMB(0.3), step, _i};
    JOB j = run_block(&b, "", 0);
    DAT u = job_table(&j, "NODES", -1), t = job_table(&j, "CONTACT", -1);
    field exact = {{0.004 * c, 0, 0, 0.006 * c},
                   {0.004 * s, 0, 0, 0.006 * s},
                   {0, 0, 0, -0.01}};
    ck_assert_double_le(field_error(&u, 3, exact), 1e-10);
    for (int i = 0; i < t.n_row; ++i) {
      double n = dat_at(&t, i, "f_n");
      ck_assert_double_eq_tol(dat_at(&t, i, "f_x"), -0.3 * c * n, 1e-10);
      ck_assert_double_eq_tol(dat_at(&t, i, "f_y"), -0.3 * s * n, 1e-10);
    }
  }
}

/* What *ELASTIC alone averages near nu = 1/2: (b) in all kinematics. */
TEST(nearly_incompressible_patches) {
  const double nu = 0.4999, p = 10.0;
  static const char *const step =
      "*STATIC\n*BOUNDARY\nLEFT, 1\n*DSLOAD\nTOP, P, 10.\n";
  for (int k = 1; k < MESHES; k += 2)
    for (int turned = 0; turned < 2; ++turned) {
      block b = {"square.geo", meshes[k],
                 nu,           turned ? ", TYPE=CAX3" AVERAGED : AVERAGED,
                 FLOOR,        "",
                 step,         0};
      JOB j = run_block(&b, "", 0);
      DAT u = job_table(&j, "NODES", -1);
      for (int i = 0; i < u.n_row; ++i) {
        double wide = turned ? nu * p / E : nu * (1 + nu) * p / E;
        double deep = turned ? p / E : (1 - nu * nu) * p / E;
        double x = dat_at(&u, i, turned ? "r" : "x");
        double y = dat_at(&u, i, turned ? "z" : "y");
        ck_assert_double_eq_tol(dat_at(&u, i, turned ? "u_r" : "u_x"), wide * x,
                                1e-11);
        ck_assert_double_eq_tol(dat_at(&u, i, turned ? "u_z" : "u_y"),
                                -deep * y, 1e-11);
      }
    }
  block b = {"cube.geo",
             "N = 4",
             nu,
             AVERAGED,
             FLOOR,
             "",
             "*STATIC\n*BOUNDARY\nLEFT, 1\nFRONT, 2\n*DSLOAD\nTOP, P, 10.\n",
             0};
  JOB j = run_block(&b, "", 0);
  DAT u = job_table(&j, "NODES", -1);
  field exact = {
      {0, nu * p / E, 0, 0}, {0, 0, nu * p / E, 0}, {0, 0, 0, -p / E}};
  ck_assert_double_le(field_error(&u, 3, exact), 1e-9);
}

/* Whole, by tests/preload/mesh.so where these programs have it: else each run
 * loads gmsh, and the suite takes twice its time. */
TEST(a_mesh_is_kept_for_later_runs) {
  if (getenv("PROTIS_MESH") == NULL || getenv("PROTIS_MESH")[0] == '\0') return;
  FOLDER(folder);
  setenv("MESH_KEPT", folder, 1);
  block b = {"square.geo",
             meshes[0],
             0.0,
             "",
             FLOOR,
             "",
             "*STATIC\n*BOUNDARY\nLEFT, 1\n*DSLOAD\nTOP, P, 10.\n",
             0};
  JOB j = run_block(&b, "", 0);
  PRINTED(command, "ls %s | grep -vc '[.]'", folder);
  ck_assert_int_eq(job_shell(&j, command), 0);
  ck_assert_str_eq(j.text, "1\n");
}

UNIT_MAIN("patch")
