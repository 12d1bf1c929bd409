/*
 * Bodies that nothing or contact alone holds: equilibrium where there is one,
 * a verdict with exit 6 where there is none, never numbers.
 */
#include "solver/solver.h"
#include "support/fclib_file.h"
#include "support/job.h"
#include "support/unit.h"

const int job_without_fields = 1;

/* Unit square on a floor with friction mu, no *BOUNDARY; the cards of the step
 * and what stands before it. */
static job run_free(double mu, const char *before, const char *loads,
                    int expected) {
  job j = job_with("free", "tests/regression/mesh/square.geo",
                   "*PARAMETER\nN = 5\n*MESH, FILE=square.geo\n"
                   "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
                   "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n%s"
                   "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
                   "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
                   "*FRICTION, CONTACT=C, LAW=COULOMB\n%g\n"
                   "*STEP\n*QUASISTATIC\n0.5, 1.\n%s"
                   "*PRINT, TOTALS, CONTACT\n*END STEP\n",
                   before, mu, loads);
  int code = job_run(&j, "");
  ck_assert_msg(code == expected, "exit %d, expected %d: %s", code, expected,
                j.errors);
  return j;
}

/* Pressed by 10 and pushed by 2 on the left: resultants and moment of the
 * floor about the origin follow from statics. */
TEST(resultants_are_those_of_statics) {
  JOB j = run_free(0.5, "", "*DSLOAD\nTOP, P, 10.\nLEFT, P, 2.\n", 0);
  DAT t = job_table(&j, "TOTALS", -1);
  ck_assert_double_eq_tol(dat_at(&t, 0, "force_y"), 10.0, 1e-9);
  ck_assert_double_eq_tol(dat_at(&t, 0, "force_x"), -2.0, 1e-9);
  /* 10 down at x = 1/2: -5; 2 to the right at y = 1/2: -1. */
  ck_assert_double_eq_tol(dat_at(&t, 0, "moment_z"), 6.0, 1e-9);
}

/* Soft layer below, hard one above (nu = 0), unit pressure on the top: the
 * floor carries 1, the top moves by 1/2 + 1/(2 contrast). Free along x too in
 * the second round: the moment about the origin is then 1/2. */
TEST(layers_of_any_contrast_weigh_the_same) {
  static const double contrast[] = {1e6, 1e8};
  for (int k = 0; k < 4; ++k) {
    JOB j = job_with(
        "layers", "tests/regression/mesh/layers.geo",
        "*PARAMETER\nN = 8\n*MESH, FILE=layers.geo\n"
        "*MATERIAL, NAME=S\n*ELASTIC\n1., 0.\n"
        "*MATERIAL, NAME=H\n*ELASTIC\n%g, 0.\n"
        "*SOLID SECTION, ELSET=SOFT, MATERIAL=S\n"
        "*SOLID SECTION, ELSET=HARD, MATERIAL=H\n"
        "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
        "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n%s*STEP\n*STATIC\n"
        "%s*DSLOAD\nTOP, P, 1.\n*PRINT, TOTALS, NODES\n*END STEP\n",
        contrast[k % 2],
        k < 2 ? "" : "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n",
        k < 2 ? "*BOUNDARY\nLEFT, 1\n" : "");
    ck_assert_int_eq(job_run(&j, ""), 0);
    DAT t = job_table(&j, "TOTALS", -1), u = job_table(&j, "NODES", -1);
    ck_assert_double_eq_tol(dat_at(&t, 0, "normal"), 1, 1e-14);
    ck_assert_double_eq_tol(dat_at(&t, 0, "moment_z"), 0.5, 1e-13);
    ck_assert_double_eq_tol(dat_max(&u, "u_y"), 0.5 + 0.5 / contrast[k % 2],
                            1e-12);
  }
}

/* Exit 6 says which nodes move, which load drives them, what it sums up to at
 * the time reached (1/32 of the step) and which state was the last. */
TEST(no_equilibrium_is_a_verdict) {
  static const struct {
    double mu;
    const char *loads, *nodes, *motion, *load, *sum;
  } scene[] = {
      {0.5, "*DSLOAD\nTOP, P, -10.\n", "contact nodes ", " separate",
       "driven by *DSLOAD on TOP (line ", "all loads (0, 0.3125)"}, /* lifted */
      {0.5, "*DSLOAD\nTOP, P, 10.\nLEFT, P, 6.\n", " nodes 1 at (0, 0), ",
       " slide", "driven by *DSLOAD on LEFT (line ",
       "all loads (0.1875, -0.3125)"}, /* pushed too hard                     */
      {9.0, "*DSLOAD\nTOP, P, 10.\nLEFT, P, 12.\n",
       "contact nodes 1 at (0, 0), 5 at (0.2, 0), ", "8 at (0.8, 0) separate",
       "driven by *DSLOAD on LEFT (line ",
       "all loads (0.375, -0.3125)"}, /* tips over                            */
      {0.5, "*DSLOAD\nTOP, P, \"120*x-50\"\n",
       "contact nodes 1 at (0, 0), 5 at (0.2, 0), ", "8 at (0.8, 0) separate",
       "driven by *DSLOAD on TOP (line ",
       "all loads (0, -0.3125)"}}; /* resultant outside                       */
  for (size_t k = 0; k < sizeof scene / sizeof *scene; ++k) {
    JOB j = run_free(scene[k].mu, "", scene[k].loads, 6);
    const char *const words[] = {"no equilibrium",
                                 scene[k].nodes,
                                 scene[k].motion,
                                 scene[k].load,
                                 scene[k].sum,
                                 "written is that of time 0",
                                 "a *BOUNDARY or another load can hold it"};
    for (size_t w = 0; w < sizeof words / sizeof *words; ++w)
      ck_assert_msg(strstr(j.errors, words[w]) != NULL, "no '%s' in %s",
                    words[w], j.errors);
  }
}

/* A triangle on two nodes, a tetrahedron on three: each node moves along its
 * normal without force, turning the body, but for rounding. */
TEST(body_on_one_face_is_lifted) {
  static const char *const body[] = {
      "4\n1 0 0 0\n2 1 0 0\n3 0.3 1 0\n4 9 9 0\n$EndNodes\n$Elements\n2\n"
      "1 1 2 1 1 1 2\n2 2 2 2 2 1 2 3\n",
      "4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0.3 0.3 1\n$EndNodes\n$Elements\n"
      "2\n1 2 2 1 1 1 2 3\n2 4 2 2 2 1 2 3 4\n"};
  for (int k = 0; k < 2; ++k) {
    JOB j = job_begin("face");
    job_write(&j, "face.msh",
              "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n"
              "%d 1 \"FOOT\"\n%d 2 \"BODY\"\n$EndPhysicalNames\n$Nodes\n%s"
              "$EndElements\n",
              k + 1, k + 2, body[k]);
    job_write(&j, "face.inp",
              "*MESH, FILE=face.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
              "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
              "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
              "*CONTACT, NAME=C, GROUP=FOOT, OBSTACLE=O\n"
              "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n*STEP\n*STATIC\n"
              "*DLOAD\nBODY, B%c, 1.\n*END STEP\n",
              "YZ"[k]);
    CK_EXIT(job_run(&j, ""), 6, j);
    ck_assert_msg(strstr(j.errors, " separate") != NULL, "%s", j.errors);
  }
}

/* A tetrahedron of weight 1 on three nodes, 1 from its axis: a body force
 * k (-y, x) twists it by 3 k/20, the nodes hold mu, each along its own circle,
 * which is no corner of a polygon of friction. */
TEST(a_twist_beyond_the_limit_has_a_verdict) {
  static const double share[] = {0.999, 1.006, 1.02};
  for (int k = 0; k < 3; ++k) {
    JOB j = job_begin("twist");
    job_write(&j, "twist.msh",
              "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n"
              "2 1 \"FOOT\"\n3 2 \"BODY\"\n$EndPhysicalNames\n$Nodes\n4\n"
              "1 0 1 0\n2 -0.8660254037844386 -0.5 0\n"
              "3 0.8660254037844386 -0.5 0\n4 0 0 1\n$EndNodes\n$Elements\n2\n"
              "1 2 2 1 1 1 2 3\n2 4 2 2 2 1 2 3 4\n$EndElements\n");
    job_write(&j, "twist.inp",
              "*MESH, FILE=twist.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
              "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
              "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
              "*CONTACT, NAME=C, GROUP=FOOT, OBSTACLE=O\n"
              "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n*STEP\n*STATIC\n"
              "*DLOAD\nBODY, BZ, -1.\nBODY, BX, \"-%g*y\"\nBODY, BY, \"%g*x\"\n"
              "*END STEP\n",
              2 * share[k], 2 * share[k]);
    const int code = job_run(&j, "");
    ck_assert_msg(code == (share[k] > 1 ? 6 : 0), "%g of the limit: exit %d",
                  share[k], code);
    ck_assert_msg(code == 0 || strstr(j.errors, " slide") != NULL, "%s",
                  j.errors);
  }
}

/* Without any contact or support the free motions are named. */
TEST(free_motions_are_named) {
  static const struct {
    const char *cards, *motion;
  } scene[] = {{"*BOUNDARY\nBOTTOM, 2\n", "translation along x"},
               {"*BOUNDARY\nLEFT, 1\n", "translation along y"},
               {"", "free to move"}};
  for (size_t k = 0; k < sizeof scene / sizeof *scene; ++k) {
    JOB j = job_with(
        "free", "tests/regression/mesh/square.geo",
        "*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
        "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n*STEP\n*STATIC\n%s"
        "*DSLOAD\nTOP, P, 1.\n*END STEP\n",
        scene[k].cards);
    for (int check = 0; check < 2; ++check) {
      ck_assert_int_eq(job_run(&j, check ? "--check" : ""), 6);
      ck_assert_ptr_nonnull(strstr(j.errors, scene[k].motion));
    }
  }
}

/* Methods that need the compliance hold the body of
 * resultants_are_those_of_statics, and none holds one that is pushed too hard.
 */
TEST(every_method_holds_the_body_or_says_that_none_can) {
  for (int i = 0; solver_list[i] != NULL; ++i)
    for (int hopeless = 0; hopeless < 2; ++hopeless) {
      if (!hopeless && (solver_list[i]->handles & SOLVES_FLOATING)) continue;
      PRINTED(cards, "*SOLVER, METHOD=%s\n*DSLOAD\nTOP, P, 10.\nLEFT, P, %d.\n",
              solver_list[i]->name, hopeless ? 6 : 2);
      JOB j = run_free(0.5, "", cards, hopeless ? 6 : 0);
      if (hopeless) {
        ck_assert_ptr_nonnull(strstr(j.errors, " slide"));
        ck_assert_ptr_nonnull(strstr(j.errors, "driven by *DSLOAD on LEFT"));
        ck_assert_ptr_nonnull(strstr(j.errors, "hold it; the last state"));
      } else {
        DAT t = job_table(&j, "TOTALS", -1);
        ck_assert_double_eq_tol(dat_at(&t, 0, "force_y"), 10.0, 1e-8);
        ck_assert_double_eq_tol(dat_at(&t, 0, "force_x"), -2.0, 1e-8);
        ck_assert_double_eq_tol(dat_at(&t, 0, "moment_z"), 6.0, 1e-8);
      }
    }
}

/* A square that stands on a corner, loaded above it: it rolls freely, and all
 * forces are known. */
TEST(body_balanced_on_a_corner_rests) {
  static const char *const mu[] = {"0.1", "1."};
  for (int i = 0; i < 4; ++i) {
    JOB j = job_begin("corner");
    job_write(
        &j, "corner.geo",
        "Point(1) = {0, 0, 0, 0.25}; Point(2) = {1, 1, 0, 0.25};\n"
        "Point(3) = {0, 2, 0, 0.25}; Point(4) = {-1, 1, 0, 0.25};\n"
        "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4};\n"
        "Line(4) = {4, 1}; Curve Loop(1) = {1, 2, 3, 4};\n"
        "Plane Surface(1) = {1}; Physical Surface(\"BODY\") = {1};\n"
        "Physical Curve(\"FOOT\") = {1, 4}; Physical Point(\"TIP\") = 3;\n");
    job_write(
        &j, "corner.inp",
        "*MESH, FILE=corner.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
        "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
        "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n"
        "*CONTACT, NAME=C, GROUP=FOOT, OBSTACLE=O, NORMAL=OBSTACLE\n"
        "*FRICTION, CONTACT=C, LAW=COULOMB\n%s\n*STEP\n*STATIC\n"
        "*SOLVER, METHOD=%s\n*CLOAD\nTIP, 2, -1.\n*PRINT, TOTALS\n"
        "*END STEP\n",
        mu[i % 2], i < 2 ? "NEWTON" : "AUTO");
    ck_assert_int_eq(job_run(&j, ""), 0);
    ck_assert_double_eq_tol(job_value(&j, "TOTALS", -1, "force_y"), 1.0, 1e-8);
  }
}

/* A triangle pressed on its slanted side: the resultant meets the floor at one
 * corner, which alone bears, whatever the body turns about it. */
static int run_corner(job *j, double E, double mu, double p, const char *step,
                      const char *method) {
  *j = job_begin("corner");
  job_write(j, "corner.msh",
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n"
            "1 1 \"BOTTOM\"\n1 2 \"TOP\"\n2 3 \"BODY\"\n$EndPhysicalNames\n"
            "$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n$Elements\n3\n"
            "1 1 2 1 1 1 2\n2 1 2 2 2 2 3\n3 2 2 3 3 1 2 3\n$EndElements\n");
  job_write(j, "corner.inp",
            "*MESH, FILE=corner.msh\n*MATERIAL, NAME=M\n*ELASTIC\n%g, .3\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
            "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
            "*FRICTION, CONTACT=C, LAW=COULOMB\n%g\n"
            "*STEP\n%s\n*DSLOAD\nTOP, P, %g\n"
            "*SOLVER, METHOD=%s\n*PRINT, TOTALS\n*END STEP\n",
            E, mu, step, p, method);
  return job_run(j, "");
}

/* What rounding leaves of a moment is nothing that friction of the one node
 * could bear. */
TEST(resultant_through_the_only_node_that_touches) {
  static const char *const methods[] = {"AUTO",
                                        "NEWTON",
                                        "LEMKE",
                                        "SOR",
                                        "PCG",
                                        "AUGLAG",
                                        "AITKEN",
                                        "LAGRANGE",
                                        "PROXIMAL",
                                        "PCG, STIFFNESS=FACTOR",
                                        "AUGLAG, STIFFNESS=FACTOR",
                                        "PROXIMAL, STIFFNESS=FACTOR"};
  enum { METHODS = sizeof methods / sizeof *methods };
  static const struct {
    double E, mu, p;
    const char *step;
  } made[] = {{1000., 2., 1., "*QUASISTATIC\n.1, 1."},
              {1., 3., 1e-5, "*STATIC"},
              {1., 10., 1e-5, "*QUASISTATIC\n.5, 1."}};
  for (int k = 0; k < 3 * METHODS; ++k) {
    const double p = made[k / METHODS].p;
    JOB j;
    int code = run_corner(&j, made[k / METHODS].E, made[k / METHODS].mu, p,
                          made[k / METHODS].step, methods[k % METHODS]);
    ck_assert_msg(code == 0, "%s: %s", methods[k % METHODS], j.errors);
    DAT t = job_table(&j, "TOTALS", -1);
    ck_assert_double_eq_tol(dat_at(&t, 0, "force_x"), p, 1e-8 * p);
    ck_assert_double_eq_tol(dat_at(&t, 0, "force_y"), p, 1e-8 * p);
  }
}

/* A method that finds no equilibrium knows of no touch either way. */
TEST(what_is_not_solved_is_not_said_to_be_apart) {
  JOB j;
  const int code =
      run_corner(&j, 1., 3., 1e-5, "*STATIC", "AUGLAG, VARIANT=UZAWA");
  ck_assert(code == 0 || code == 1);
  ck_assert_ptr_null(strstr(j.errors, "no node touched"));
}

/* The same under a block that is pressed down and lifted, of either side. */
TEST(body_under_another_that_is_lifted_stays) {
  static const char *const sides[] = {"TOP 1, BOTTOM 2", "BOTTOM 2, TOP 1"};
  for (int k = 0; k < 4; ++k) {
    JOB j = job_with(
        "pile", "tests/regression/mesh/stack.geo",
        "*PARAMETER\nNB = 2\n*MESH, FILE=stack.geo\n*MATERIAL, NAME=M\n"
        "*ELASTIC\n%s, 0.3\n*SOLID SECTION, ELSET=BLOCKS, MATERIAL=M\n"
        "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n"
        "*CONTACT, NAME=C, GROUP=BOTTOM 1, OBSTACLE=O\n"
        "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n"
        "*CONTACT PAIR, NAME=P\n%s\n"
        "*FRICTION, CONTACT=P, LAW=COULOMB\n0.3\n"
        "*STEP\n*QUASISTATIC\n0.5, 1.\n"
        "*BOUNDARY\nTOP 2, 1, 1, 0.001\nTOP 2, 2, 2, -0.01\n*END STEP\n"
        "*STEP\n*QUASISTATIC\n0.5, 1.\n"
        "*BOUNDARY\nTOP 2, 1, 1, 0.\nTOP 2, 2, 2, 0.01\n"
        "*PRINT, NODES, FREQUENCY=0\n*END STEP\n",
        k < 2 ? "1." : "3.", sides[k % 2]);
    CK_EXIT(job_run(&j, ""), 0, j);
    DAT d = job_table(&j, "NODES", -1);
    for (int i = 0; i < d.n_row; ++i) {
      const int lower = dat_at(&d, i, "u_y") < 0.005;
      ck_assert(lower || dat_at(&d, i, "y") > 0.999);
      ck_assert_double_eq_tol(dat_at(&d, i, "u_y"), lower ? 0 : 0.01, 1e-10);
      ck_assert_double_eq_tol(dat_at(&d, i, "u_x"), 0, lower ? 1e-3 : 1e-10);
    }
  }
}

/* Friction on the floor alone leaves the upper of two blocks free, that between
 * them alone both. */
TEST(block_on_one_that_rubs_is_free) {
  static const char *const rubs[] = {
      "", "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n",
      "*FRICTION, CONTACT=P, LAW=COULOMB\n0.3\n",
      "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n*FRICTION, CONTACT=P, "
      "LAW=COULOMB\n0.3\n"};
  for (int k = 0; k < 4; ++k) {
    JOB j = job_with(
        "rubs", "tests/regression/mesh/stack.geo",
        "*PARAMETER\nNB = 2\n*MESH, FILE=stack.geo\n*MATERIAL, NAME=M\n"
        "*ELASTIC\n1., 0.3\n*SOLID SECTION, ELSET=BLOCKS, MATERIAL=M\n"
        "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n"
        "*CONTACT, NAME=C, GROUP=BOTTOM 1, OBSTACLE=O\n"
        "*CONTACT PAIR, NAME=P\nTOP 1, BOTTOM 2\n%s"
        "*STEP\n*STATIC\n*BOUNDARY\nTOP 2, 2, 2, -0.01\n"
        "*ACCURACY, TARGET=50 %%\n*END STEP\n",
        rubs[k]);
    ck_assert_int_eq(job_run(&j, k == 1 ? "" : "--check"), k < 3 ? 6 : 0);
    ck_assert_int_eq(strstr(j.errors, "free to move: translation") != NULL,
                     k < 3);
  }
}

/* A free body that a turning block pushes before it goes where the motions say,
 * whatever the modulus. */
TEST(body_that_is_pushed_along_goes_one_way) {
  static const double E[] = {1., 3., 7., 1e3, 2e5, 1e9};
  double first[2] = {0};
  for (int k = 0; k < 6; ++k) {
    JOB j = job_with(
        "push", "tests/regression/mesh/stack.geo",
        "*PARAMETER\nNB = 2\n*MESH, FILE=stack.geo\n*MATERIAL, NAME=M\n"
        "*ELASTIC\n%g, 0.3\n*SOLID SECTION, ELSET=BLOCKS, MATERIAL=M\n"
        "*OBSTACLE, NAME=O, TYPE=PLANE\n0., -0.1\n0., 1.\n"
        "*CONTACT, NAME=C, GROUP=BOTTOM 1, OBSTACLE=O\n"
        "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n"
        "*CONTACT PAIR, NAME=P\nTOP 1, BOTTOM 2\n"
        "*FRICTION, CONTACT=P, LAW=COULOMB\n0.3\n"
        "*STEP\n*QUASISTATIC\n0.5, 1.\n"
        "*BOUNDARY\nTOP 2, 1, 1, 0.01\nTOP 2, 2, 2, \"-0.02-0.01*x\"\n"
        "*PRINT, NODES, FREQUENCY=0\n*END STEP\n",
        E[k]);
    int code = job_run(&j, "");
    ck_assert_msg(code == 0, "E = %g: exit %d: %s", E[k], code, j.errors);
    dat d = job_table(&j, "NODES", -1);
    const double u[] = {dat_at(&d, 0, "u_x"), dat_at(&d, 0, "u_y")};
    if (k == 0) memcpy(first, u, sizeof u);
    ck_assert_double_lt(first[1], -0.01);
    for (int c = 0; c < 2; ++c)
      ck_assert_msg(fabs(u[c] - first[c]) < 1e-10, "E = %g: u[%d] = %g for %g",
                    E[k], c, u[c], first[c]);
    dat_free(&d);
  }
}

/* The middle of three blocks, of which a support holds the lowest, which stands
 * on an obstacle too, is pushed with more than the friction below it, 2, can
 * hold. */
TEST(block_between_others_slides_away) {
  static const double push[] = {1.5, 2.2, 4., 6.}, E[] = {300., 1000., 2500.};
  for (int k = 0; k < 12; ++k) {
    job j = job_with("push", "tests/regression/mesh/stack.geo",
                     "*PARAMETER\nNB = 3\n*MESH, FILE=stack.geo\n"
                     "*MATERIAL, NAME=M\n*ELASTIC\n%g, 0.3\n"
                     "*SOLID SECTION, ELSET=BLOCKS, MATERIAL=M\n"
                     "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n"
                     "*CONTACT, NAME=F, GROUP=BOTTOM 1, OBSTACLE=O\n"
                     "*FRICTION, CONTACT=F, LAW=TRESCA\n4.\n"
                     "*CONTACT PAIR, NAME=P\nTOP 1, BOTTOM 2\n"
                     "*FRICTION, CONTACT=P, LAW=TRESCA\n2.\n"
                     "*CONTACT PAIR, NAME=Q\nTOP 2, BOTTOM 3\n"
                     "*FRICTION, CONTACT=Q, LAW=TRESCA\n3.\n"
                     "*STEP\n*STATIC\n*BOUNDARY\nLEFT 1, 1, 2\n"
                     "*DSLOAD\nTOP 3, P, 14.4\nLEFT 2, P, %g\n*END STEP\n",
                     E[k / 4], push[k % 4]);
    const int wanted = push[k % 4] > 2 ? 6 : 0, code = job_run(&j, "");
    ck_assert_msg(code == wanted, "%g: exit %d: %s", push[k % 4], code,
                  j.errors);
    job_end(&j);
  }
}

/* Clamped by 0.01 between rigid planes, N = 0.01 E/(1 - nu^2) = 11 on each, the
 * block bears less than 2 mu N = 6.6: more is no proof, since N may grow as it
 * tilts, but what happens is said. */
TEST(clamped_block_that_slides_away_is_named) {
  static const char ceiling[] =
      "*OBSTACLE, NAME=T, TYPE=PLANE\n0., 0.99\n0., -1.\n"
      "*CONTACT, NAME=T, GROUP=TOP, OBSTACLE=T\n"
      "*FRICTION, CONTACT=T, LAW=COULOMB\n0.3\n";
  job j = run_free(0.3, ceiling, "*DSLOAD\nLEFT, TX, 8.\n", 1);
  ck_assert_ptr_nonnull(
      strstr(j.errors, "P4040: step 1, increment 2, time 1:"));
  ck_assert_ptr_nonnull(strstr(j.errors, " slide, driven by *DSLOAD on LEFT"));
  ck_assert_ptr_nonnull(
      strstr(j.errors, "the last equilibrium is that of time 0.5\n"));
  job_end(&j);
  j = run_free(0.3, ceiling, "*DSLOAD\nLEFT, TX, 6.\n", 0);
  job_end(&j);
}

/* A block that creeps on a floor that rises and is unloaded at once lies on it
 * without force: no node is closed by rounding, whatever modulus and time. */
TEST(touch_without_force_is_open) {
  static const double E[] = {1000, 1700, 3000, 7777, 2e5};
  for (int k = 0; k < 10; ++k) {
    const char *tau = k % 2 ? "1E9" : "1.";
    JOB j = job_with("rest", "tests/regression/mesh/square.geo",
                     "*PARAMETER\nN = 6\nTAU = %s\nH = 0.3*TAU\n"
                     "*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n"
                     "*ELASTIC\n%g, 0.3\n*INELASTIC, LAW=MAXWELL\n<TAU>\n"
                     "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
                     "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n"
                     "MOVE, \"0.001*sin(3*t/%s)\", \"1e-4*t/%s\"\n"
                     "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
                     "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n"
                     "*AMPLITUDE, NAME=S, TIME=STEP TIME\n0., 0., %s, 1.\n"
                     "*STEP\n*QUASISTATIC\n<H>, <TAU>\n*BOUNDARY\nLEFT, 1\n"
                     "*DSLOAD\nTOP, P, 10.\n*END STEP\n"
                     "*STEP\n*VISCO, INTEGRATOR=BACKWARD\n<H>, <TAU>\n"
                     "*DSLOAD\nTOP, P, 10., S\n*PRINT, TOTALS\n*END STEP\n",
                     tau, E[k / 2], tau, tau, tau);
    CK_EXIT(job_run(&j, ""), 0, j);
    DAT t = job_table(&j, "TOTALS", 0);
    ck_assert_msg(dat_at(&t, 0, "open") == 7.0, "E = %g, times %s: %g open",
                  E[k / 2], tau, dat_at(&t, 0, "open"));
  }
}

/* A square on rollers, pressed by 0.1 from the side, swells by nu (1 + nu) 0.1
 * = 0.039; no force holds it up or down. It stays where its mean was, or rests
 * on the floor. */
TEST(swelling_body_has_its_place_by_every_method) {
  static const char *const methods[] = {"NEWTON", "LEMKE",  "PCG",  "SOR",
                                        "AITKEN", "AUGLAG", "AUTO", "LAGRANGE"};
  for (int k = 0; k < 16; ++k) {
    const double floor_at = k % 2 ? -0.05 : -0.01;
    JOB j = job_with(
        "swelling", "tests/regression/bad/square.msh",
        "*MESH, FILE=square.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1., 0.3\n"
        "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=CPE3\n"
        "*OBSTACLE, NAME=O, TYPE=PLANE\n0, %g\n0, 1\n"
        "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
        "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n*STEP\n*QUASISTATIC\n"
        "1., 1.\n*BOUNDARY\nLEFT, 1\n*DSLOAD\nRIGHT, TX, -0.1\n"
        "*SOLVER, METHOD=%s\n*PRINT, CONTACT\n*END STEP\n",
        floor_at, methods[k / 2]);
    ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
    DAT c = job_table(&j, "CONTACT", -1);
    for (int i = 0; i < c.n_row; ++i) {
      ck_assert_double_eq_tol(dat_at(&c, i, "gap"),
                              fmax(0.0, -floor_at - 0.039 / 2), 1e-9);
      ck_assert_double_eq_tol(dat_at(&c, i, "f_n"), 0, 1e-11);
    }
  }
}

/* N of a wedge of half the angle between two planes, pressed in by 10 and
 * unloaded to p. */
static double unload(double angle, double mu, const char *law, const char *kind,
                     double p) {
  const double a = angle * M_PI / 180.0;
  JOB j = job_begin("wedge");
  job_write(&j, "wedge.geo",
            "Point(1) = {-.5, 0, 0}; Point(2) = {.5, 0, 0};\n"
            "Point(3) = {%.17g, 1, 0}; Point(4) = {-%.17g, 1, 0};\n"
            "For i In {1:4}\n  Line(i) = {i, i %% 4 + 1};\n"
            "  Transfinite Curve{i} = i %% 2 ? 9 : 7;\nEndFor\n"
            "Curve Loop(1) = {1:4}; Plane Surface(1) = {1};\n"
            "Transfinite Surface{1};\nPhysical Curve(\"RIGHT\") = {2};\n"
            "Physical Curve(\"TOP\") = {3};\nPhysical Curve(\"LEFT\") = {4};\n"
            "Physical Surface(\"BODY\") = {1};\n",
            0.5 + tan(a), 0.5 + tan(a));
  job_write(&j, "wedge.inp",
            "*PARAMETER\nC = %.17g\nS = %.17g\nMU = %g\n*MESH, FILE=wedge.geo\n"
            "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n%s"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=L, TYPE=PLANE\n-0.5, 0.\n<C>, <S>\n"
            "*OBSTACLE, NAME=R, TYPE=PLANE\n0.5, 0.\n\"-C\", <S>\n"
            "*CONTACT, NAME=CL, GROUP=LEFT, OBSTACLE=L\n"
            "*CONTACT, NAME=CR, GROUP=RIGHT, OBSTACLE=R\n"
            "*FRICTION, CONTACT=CL, LAW=COULOMB\n<MU>\n"
            "*FRICTION, CONTACT=CR, LAW=COULOMB\n<MU>\n"
            "*STEP\n*QUASISTATIC\n0.1, 1.\n*DSLOAD\nTOP, P, 10.\n*END STEP\n"
            "*STEP\n*%s\n0.1, 1.\n*DSLOAD\nTOP, P, %g\n"
            "*PRINT, TOTALS\n*END STEP\n",
            cos(a), sin(a), mu, law, kind, p);
  ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
  return job_value(&j, "TOTALS", -1, "normal");
}

/* Without load a wedge is in equilibrium jammed as well as free of contact: it
 * stays as it is under next to no load, where friction holds it at all. */
TESTS(jammed_wedge_stays_where_it_was, 6) {
  static const char creeps[] = "*INELASTIC, LAW=MAXWELL\n2000.\n";
  static const struct {
    double angle, mu;
    const char *law, *kind;
  } cases[] = {{25, 0.5, "", "QUASISTATIC"},
               {27, 0.6, "", "QUASISTATIC"},
               {25, 0.5, "", "QUASISTATIC, FORM=VELOCITY"},
               {25, 0.5, creeps, "VISCO, INTEGRATOR=BACKWARD"},
               {25, 0.5, creeps, "VISCO, INTEGRATOR=EULER"},
               {20, 0.3, "", "QUASISTATIC"}};
  const double angle = cases[_i].angle, mu = cases[_i].mu;
  const double rest = unload(angle, mu, cases[_i].law, cases[_i].kind, 1e-9);
  const double none = unload(angle, mu, cases[_i].law, cases[_i].kind, 0);
  ck_assert_double_eq_tol(none, rest, 1e-6);
  ck_assert(mu > tan(angle * M_PI / 180) ? none > 0.5 : none < 1e-9);
}

/* Columns of two cells, their inner side but the last cracked; the groups FOOT,
 * SIDE, LINE, BODY. */
static void write_cracked(const job *j, int columns) {
  char text[4000] = "", *end = text;
  const int n = columns + 1;
#define ADD(...) end += sprintf(end, __VA_ARGS__)
  for (int k = 0; k < 3 * n; ++k)
    ADD("%d %g %g 0\n", k + 1, 0.37 * (k % n),
        0.3 * (k / n) + (k / n == 1 ? 0.01 * (k * k % 7) : 0));
  ADD("$EndNodes\n$Elements\n%d\n", 6 * columns + 1);
  for (int k = 1; k <= columns; ++k) ADD("%d 1 2 1 1 %d %d\n", k, k, k + 1);
  for (int k = 0; k < 2; ++k)
    ADD("%d 1 2 2 2 %d %d\n", columns + 1 + k, k * n + 1, k * n + n + 1);
  for (int k = 1; k < columns; ++k)
    ADD("%d 1 2 3 3 %d %d\n", columns + 2 + k, n + k, n + k + 1);
  for (int k = 0; k < 2 * columns; ++k) {
    const int a = k / columns * n + k % columns + 1, b = a + n + 1;
    ADD("%d 2 2 4 4 %d %d %d\n", 2 * columns + 2 * k + 2, a, a + 1, b);
    ADD("%d 2 2 4 4 %d %d %d\n", 2 * columns + 2 * k + 3, a, b, b - 1);
  }
#undef ADD
  job_write(j, "cracked.msh",
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n4\n"
            "1 1 \"FOOT\"\n1 2 \"SIDE\"\n1 3 \"LINE\"\n2 4 \"BODY\"\n"
            "$EndPhysicalNames\n$Nodes\n%d\n%s$EndElements\n",
            3 * n, text);
}

/* A body that lies on a floor is raised, and left there by the floor and by its
 * weight: its crack, which does not move against itself, has no part in that.
 */
TEST(cracked_body_that_is_left_stays) {
  for (int columns = 5; columns <= 8; ++columns) {
    JOB j = job_begin("cracked");
    write_cracked(&j, columns);
    job_write(&j, "cracked.inp",
              "*MESH, FILE=cracked.msh\n*MATERIAL, NAME=M\n*ELASTIC\n"
              "1000., 0.3\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
              "*AMPLITUDE, NAME=UP\n0., 0., 1., 1., 2., 0.\n"
              "*OBSTACLE, NAME=O, TYPE=PLANE, AMPLITUDE=UP\n0., 0.\n0., 1.\n"
              "MOVE, 0., 0.26\n*CONTACT, NAME=C, GROUP=FOOT, OBSTACLE=O\n"
              "*CRACK, NAME=SLIT, GROUP=LINE\n*STEP\n*QUASISTATIC\n1., 2.\n"
              "*BOUNDARY\nSIDE, 1\n*DLOAD\nBODY, BY, \"-(t < 1.5)\"\n"
              "*PRINT, NODES, FREQUENCY=0\n*END STEP\n");
    CK_EXIT(job_run(&j, ""), 0, j);
    DAT d = job_table(&j, "NODES", -1);
    for (int i = 0; i < d.n_row; ++i)
      ck_assert_double_eq_tol(dat_at(&d, i, "u_y"), 0.26, 2e-3);
  }
}

/* Two feet joined by 2^52, of loads 1 and 1.5, both at 1/3: what rounding makes
 * of the forces is no solution. */
TESTS(forces_below_the_rounding_of_a_file_are_no_solution, 4) {
  static const char *const method[] = {"AUTO", "PCG", "LAGRANGE", "PROXIMAL"};
  const double K = 0x1p52, f[] = {-1.0, 0.0, -1.5, 0.0}, mu[] = {0.1, 0.1};
  const double w[] = {1.0 / 3.0, 0.0, 1.0 / 3.0, 0.0};
  const double M[] = {K, 0, -K, 0, 0, K, 0, 0, -K, 0, K, 0, 0, 0, 0, K};
  const double H[] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  JOB j = job_begin("feet");
  PRINTED(path, "%s/problem.h5", j.dir);
  fclib_global(path, STORE_COLUMNS,
               &(fclib_global_data){2, 2, 4, M, H, f, w, mu});
  job_write(&j, "feet.inp",
            "*CONDENSED PROBLEM, FILE=problem.h5\n*STEP\n"
            "*SOLVER, METHOD=%s\n*PRINT, CONTACT\n*END STEP\n",
            method[_i]);
  const int code = job_run(&j, "");
  ck_assert_msg(code == 1 || code == 0, "exit %d: %s", code, j.errors);
  if (code == 0) {
    DAT t = job_table(&j, "CONTACT", -1);
    for (int i = 0; i < 2; ++i)
      ck_assert_double_eq_tol(-dat_at(&t, i, "f_n") / f[2 * i], 1, 0.1);
  }
}

/* Seventeen blocks near incompressibility have 51 free motions: what they are
 * bent by is no drift, as of one alone. */
TEST(many_free_bodies_are_solved_as_one_is) {
  JOB j = job_begin("row");
  job_write(&j, "row.geo",
            "foot[] = {}; top[] = {}; body[] = {};\n"
            "For b In {0 : 16}\n  p = newp; l = newl;\n  For i In {0 : 3}\n"
            "    Point(p + i) = {2 * b + (i == 1 || i == 2), i > 1, 0};\n"
            "  EndFor\n  For i In {0 : 3}\n"
            "    Line(l + i) = {p + i, p + (i + 1) %% 4};\n"
            "    Transfinite Curve{l + i} = 4;\n  EndFor\n"
            "  Curve Loop(l) = {l : l + 3}; Plane Surface(l) = {l};\n"
            "  Transfinite Surface{l} Alternated;\n"
            "  foot[] += l; top[] += l + 2; body[] += l;\nEndFor\n"
            "Physical Curve(\"FOOT\") = {foot[]};\n"
            "Physical Curve(\"TOP\") = {top[]};\n"
            "Physical Surface(\"BODY\") = {body[]};\n");
  job_write(&j, "row.inp",
            "*MESH, FILE=row.geo\n*MATERIAL, NAME=M\n*ELASTIC\n"
            "1., 0.49999999\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n"
            "*CONTACT, NAME=C, GROUP=FOOT, OBSTACLE=O\n"
            "*FRICTION, CONTACT=C, LAW=COULOMB\n1.E-4\n*STEP\n*STATIC\n"
            "*SOLVER, METHOD=NEWTON\n*DSLOAD\nTOP, P, 0.005\n"
            "*PRINT, TOTALS\n*END STEP\n");
  ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
  ck_assert_double_eq_tol(job_value(&j, "TOTALS", -1, "normal"), 17 * 0.005,
                          1e-9);
}

/* The gap of a tie that varies resists a turn of the bodies by its square. */
TEST(blocks_tied_across_a_thin_wedge_stand_on_the_floor) {
  static const double gaps[] = {1e-3, 1e-5, 1e-7, 1e-9};
  for (int k = 0; k < 12; ++k) {
    JOB j = job_with("wedge", "tests/regression/mesh/pair.geo",
                     "*PARAMETER\nL = %g\n*MESH, FILE=pair.geo\n"
                     "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
                     "*MATERIAL, NAME=H\n*ELASTIC\n%g, 0.3\n"
                     "*SOLID SECTION, ELSET=LOWER, MATERIAL=M\n"
                     "*SOLID SECTION, ELSET=UPPER, MATERIAL=H\n"
                     "*TIE, NAME=T\nUNDER, OVER\n"
                     "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n"
                     "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
                     "*FRICTION, CONTACT=C, LAW=COULOMB\n0.5\n"
                     "*STEP\n*STATIC\n*SOLVER, STIFFNESS=%s\n"
                     "*DSLOAD\nTOP, P, 10.\nTOP, TX, 1.\n"
                     "*PRINT, TOTALS\n*END STEP\n",
                     gaps[k / 3], k % 3 == 0 ? 1e3 : 1e9,
                     k % 3 == 2 ? "FACTOR" : "DENSE");
    CK_EXIT(job_run(&j, ""), 0, j);
    ck_assert(job_told(&j, "condition") > 1 / (gaps[k / 3] * gaps[k / 3]));
    ck_assert_double_eq_tol(job_value(&j, "TOTALS", -1, "force_x"), -1, 1e-8);
    ck_assert_double_eq_tol(job_value(&j, "TOTALS", -1, "force_y"), 10, 1e-12);
    ck_assert_double_eq_tol(job_value(&j, "TOTALS", -1, "moment_z"), 7,
                            3 * gaps[k / 3] + 1e-8);
  }
}

UNIT_MAIN("floating")
