/*
 * *GOAL: values and estimates against closed forms (Hertz's half plane cut out
 * with its tractions; the axisymmetric and the whole sphere; a bar) and against
 * a block on a rough floor whose force is known from meshes of 54,000 nodes,
 * pushed once, and to and fro (144 times the nodes).
 */
#include "base/base.h"
#include "support/goal_body.h"
#include "support/unit.h"

const int job_without_fields = 1;

/* A row of the table GOALS, the last one of the job. */
typedef struct told {
  double value, error, band, ends;
} told;

static told told_of(const job *j, int row) {
  dat t = job_table(j, "GOALS", -1);
  const told g = {dat_at(&t, row, "value"), dat_at(&t, row, "error"),
                  dat_at(&t, row, "band"), dat_at(&t, row, "contact_ends")};
  if (!isnan(g.error))
    ck_assert_double_eq_tol(dat_at(&t, row, "corrected"), g.value + g.error,
                            1e-12 * fabs(g.value));
  dat_free(&t);
  return g;
}

/* The estimate is that part of the true error; the truth is in "wide" bands. */
static void check_goal(const job *j, int row, double exact, double least,
                       double most, double wide) {
  const told g = told_of(j, row);
  const double ratio = g.error / (exact - g.value);
  ck_assert_msg(ratio > least && ratio < most,
                "goal %d: %.9g, exact %.9g, estimate %g is %g of the error",
                row, g.value, exact, g.error, ratio);
  ck_assert_msg(fabs(exact - g.value - g.error) <= wide * g.band,
                "goal %d: %g off, band %g", row, exact - g.value - g.error,
                g.band);
}

/* The deck of an example with cards before its first step and *PRINT, GOALS in
 * it. */
static job with_goals(const char *deck, const char *cards, const char *words) {
  const char *name = strrchr(deck, '/') + 1;
  char file[80], *text = job_deck_text(deck);
  job j = job_begin(name);
  job_copy_meshes(&j, deck);
  char *at = strstr(text, "\n*STEP"), *end = strstr(text, "\n*END STEP");
  ck_assert(at != NULL && end != NULL);
  snprintf(file, sizeof file, "%s.inp", name);
  job_write(&j, file, "%.*s\n%s%.*s\n*PRINT, GOALS%s", (int)(at - text), text,
            cards, (int)(end - at - 1), at + 1, end);
  free(text);
  CK_EXIT(job_run(&j, words), 0, j);
  return j;
}

static const char hertz_goals[] =
    "*PARAMETER\nHALF = \"A/2\"\nL = \"SIZE*A\"\n"
    "*GOAL, NAME=PEAK, QUANTITY=PRESSURE, CONTACT=LINE, RADIUS=<HALF>\n0., 0.\n"
    "*GOAL, NAME=TOP, QUANTITY=DISPLACEMENT, COMPONENT=2\n0., <L>\n"
    "*GOAL, NAME=SIDE, QUANTITY=DISPLACEMENT, COMPONENT=1\n<L>, 0.\n"
    "*GOAL, NAME=WIDE, QUANTITY=WIDTH, CONTACT=LINE\n"
    "*GOAL, NAME=MOST, QUANTITY=PRESSURE, CONTACT=LINE\n";

/* A mesh fine at the contact: the closed forms of the half plane for these
 * means, and for the displacements of the corners of the block. */
TEST(goals_of_the_half_plane_of_hertz) {
  static const double a = 0.2348908547, p0 = 2710.278943;
  const double length = a * p0 * 200.0 / 210e3;
  JOB j = with_goals("input/hertz_line/hertz_exact", hertz_goals, "-D N=16");
  check_goal(&j, 1, -0.00857071821 * length, 0.7, 1.4, 1.0);
  check_goal(&j, 2, -0.00204203522 * length, 0.7, 1.4, 1.0);
  check_goal(&j, 0, 1.00026235 * p0, 0.2, 2.0, 1.0);
  check_goal(&j, 3, 1.00157562 * a, 0.5, 2.5, 1.0);
  ck_assert(goal_has_verdict(&j, "WIDE", "contact_end"));
  const told peak = told_of(&j, 0), most = told_of(&j, 4);
  ck_assert_double_eq_tol(most.value, peak.value, 1e-3 * p0);
}

/* The unsymmetric rows: the force of a contact that slips in part. */
TEST(friction_force_of_the_block) {
  JOB j = job_with(
      "side", "input/greco/greco.geo",
      "*PARAMETER\nN = 64\nSTRUCTURED = 0\n*MESH, FILE=greco.geo\n"
      "*MATERIAL, NAME=M\n*ELASTIC\n130.D3, 0.2\n"
      "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=CPE3\n"
      "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
      "*CONTACT, NAME=FOOT, GROUP=CONTACT, OBSTACLE=O\n"
      "*FRICTION, CONTACT=FOOT, LAW=COULOMB\n1.\n"
      "*GOAL, NAME=GRIP, QUANTITY=FORCE, CONTACT=FOOT, COMPONENT=1\n"
      "*GOAL, NAME=UY, QUANTITY=DISPLACEMENT, COMPONENT=2\n0., 40.\n"
      "*GOAL, NAME=PRESSED, QUANTITY=FORCE, CONTACT=FOOT\n"
      "*GOAL, NAME=TURN, QUANTITY=MOMENT, CONTACT=FOOT\n"
      "0., 0.\n"
      "*GOAL, NAME=ABOUT, QUANTITY=MOMENT, CONTACT=FOOT, COMPONENT=3\n"
      "10., 5.\n"
      "*GOAL, NAME=FOOT, QUANTITY=DISPLACEMENT, GROUP=CONTACT, "
      "COMPONENT=2\n"
      "*GOAL, NAME=PLAY, QUANTITY=DISPLACEMENT, COMPONENT=2\n"
      "0., 40.\n40., 0.\n"
      "*GOAL, NAME=LIFT, QUANTITY=DISPLACEMENT, COMPONENT=2, "
      "FROM=CONTACT\n0., 40.\n"
      "*STEP\n*STATIC\n*BOUNDARY\nSYMMETRY, 1, 1, 0.\n*DSLOAD\n"
      "TOP, P, 50.\nLEFT, P, 150.\n*PRINT, GOALS, TOTALS\n*END STEP\n");
  ck_assert_int_eq(job_run(&j, ""), 0);
  check_goal(&j, 0, -1405.346, 0.8, 1.1, 1.0);
  check_goal(&j, 1, -2.27666e-4, 0.5, 2.0, 1.5);
  DAT t = job_table(&j, "TOTALS", -1);
  ck_assert_double_eq_tol(told_of(&j, 0).value, dat_at(&t, 0, "force_x"), 1e-9);
  ck_assert_double_eq_tol(told_of(&j, 2).value, dat_at(&t, 0, "normal"), 1e-9);
  /* About another point the moment is less by its arm times the force, and so
   * is its error; displacements and their errors are subtracted. */
  const told fx = told_of(&j, 0), fy = told_of(&j, 2);
  const told turn = told_of(&j, 3), about = told_of(&j, 4);
  ck_assert_double_eq_tol(turn.value, dat_at(&t, 0, "moment_z"), 1e-6);
  ck_assert_double_eq_tol(about.value,
                          turn.value - 10.0 * fy.value + 5.0 * fx.value, 1e-6);
  ck_assert_double_gt(fabs(turn.error), 1.0);
  ck_assert_double_eq_tol(about.error,
                          turn.error - 10.0 * fy.error + 5.0 * fx.error, 1e-6);
  const told uy = told_of(&j, 1), foot = told_of(&j, 5), lift = told_of(&j, 7);
  ck_assert_double_eq_tol(lift.value, uy.value - foot.value, 1e-15);
  ck_assert_double_eq_tol(lift.error, uy.error - foot.error, 1e-15);
  ck_assert_double_eq_tol(told_of(&j, 6).error, uy.error, 1e-12);
  /* Equilibrium gives the normal force whatever the mesh. */
  ck_assert_double_lt(fabs(told_of(&j, 2).error), 1e-9);
  ck_assert(goal_has_verdict(&j, "PRESSED", "reliable"));
}

/* A slice of that block in space: what friction does between the plane of
 * symmetry and the nodes next to it is in no force, but in the error. */
TEST(friction_force_of_a_slice) {
  JOB j = job_begin("slice");
  job_write(&j, "slice.geo",
            "Point(1) = {0, 0, 0, 1.25}; Point(2) = {40, 0, 0, 1.25};\n"
            "Point(3) = {40, 40, 0, 5}; Point(4) = {0, 40, 0, 5};\n"
            "For k In {1 : 4}\n  Line(k) = {k, k %% 4 + 1};\nEndFor\n"
            "Curve Loop(1) = {1 ... 4};\nPlane Surface(1) = {1};\n"
            "e[] = Extrude {0, 0, 2} { Surface{1}; };\n"
            "Physical Volume(\"BODY\") = {e[1]};\n"
            "Physical Surface(\"CONTACT\") = {e[2]};\n"
            "Physical Surface(\"SYMMETRY\") = {e[3]};\n"
            "Physical Surface(\"TOP\") = {e[4]};\n"
            "Physical Surface(\"LEFT\") = {e[5]};\n"
            "Physical Surface(\"FACES\") = {1, e[0]};\n");
  job_write(&j, "slice.inp",
            "*MESH, FILE=slice.geo\n*MATERIAL, NAME=M\n*ELASTIC\n130.D3, 0.2\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
            "*CONTACT, NAME=FOOT, GROUP=CONTACT, OBSTACLE=O\n"
            "*FRICTION, CONTACT=FOOT, LAW=COULOMB\n1.\n"
            "*GOAL, NAME=GRIP, QUANTITY=FORCE, CONTACT=FOOT, COMPONENT=1\n"
            "*STEP\n*STATIC\n*BOUNDARY\nSYMMETRY, 1\nFACES, 3\n*DSLOAD\n"
            "TOP, P, 50.\nLEFT, P, 150.\n*PRINT, GOALS\n*END STEP\n");
  ck_assert_int_eq(job_run(&j, ""), 0);
  check_goal(&j, 0, 2.0 * -1405.346, 0.85, 1.1, 1.0);
}

/* The block pressed, pushed, pulled back and pushed again; its stiffness formed
 * or not. */
static job to_and_fro(const char *kind) {
  job j =
      job_with("fro", "input/greco/greco.geo",
               "*PARAMETER\nN = 32\nSTRUCTURED = 0\n*MESH, FILE=greco.geo\n"
               "*MATERIAL, NAME=M\n*ELASTIC\n130.D3, 0.2\n"
               "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=CPE3\n"
               "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
               "*CONTACT, NAME=FOOT, GROUP=CONTACT, OBSTACLE=O\n"
               "*FRICTION, CONTACT=FOOT, LAW=COULOMB\n0.4\n"
               "*GOAL, NAME=GRIP, QUANTITY=FORCE, CONTACT=FOOT, COMPONENT=1\n"
               "*GOAL, NAME=UY, QUANTITY=DISPLACEMENT, COMPONENT=2\n0., 40.\n"
               "*GOAL, NAME=WORK, QUANTITY=FRICTION WORK\n"
               "*GOAL, NAME=E, QUANTITY=ENERGY\n"
               "*AMPLITUDE, NAME=PRESS\n0., 0., 1., 1., 4., 1.\n"
               "*AMPLITUDE, NAME=FRO\n0., 0., 1., 0., 2., 1., 3., -.4, 4., .4\n"
               "*STEP\n*QUASISTATIC\n1., 4.\n*BOUNDARY\nSYMMETRY, 1, 1, 0.\n"
               "*DSLOAD, AMPLITUDE=PRESS\nTOP, P, 50.\n"
               "*DSLOAD, AMPLITUDE=FRO\nLEFT, P, 70.\n*PRINT, GOALS\n"
               "*SOLVER, STIFFNESS=%s\n*END STEP\n",
               kind);
  ck_assert_msg(job_run(&j, "--no-timing") == 0, "%s", j.errors);
  return j;
}

/* Where nodes stick, they do so in error: without that the ratios of the last
 * increment are 0.43, 3.2, 0.01. */
TEST(errors_of_earlier_increments_are_in_it) {
  JOB j = to_and_fro("AUTO");
  check_goal(&j, 0, -205.785, 0.8, 1.2, 1.0);
  check_goal(&j, 1, -0.012159874, 0.8, 1.25, 1.0);
  check_goal(&j, 2, 5.204, 0.5, 1.1, 1.0);
  check_goal(&j, 3, 14.9095, 0.8, 1.25, 1.0);
  ck_assert(goal_has_verdict(&j, "UY", "reliable"));
  /* All of the base sticks: it ends at the corner alone. */
  ck_assert_double_gt(job_value(&j, "GOALS", 0, "contact_ends"), 3.0);
}

/* The zone of stick grows with the load: what its edges were when they began
 * to stick counts, and the work that they do before. Reference: meshes
 * of make verify. */
TEST(work_of_a_zone_of_stick_that_grows) {
  JOB j = with_goals("input/spence/spence",
                     "*PARAMETER\nHALF = \"A/2\"\n"
                     "*GOAL, NAME=WORK, QUANTITY=FRICTION WORK\n"
                     "*GOAL, NAME=PEAK, QUANTITY=PRESSURE, CONTACT=LINE, "
                     "RADIUS=<HALF>\n0., 0.\n"
                     "*GOAL, NAME=DRAG, QUANTITY=FORCE, CONTACT=LINE, "
                     "COMPONENT=1\n",
                     "-D DT=0.1 -D NC=40");
  check_goal(&j, 0, 4.42286e-3, 0.65, 1.2, 1.0);
  check_goal(&j, 1, 2902.717, 0.6, 1.2, 1.0);
  check_goal(&j, 2, 84.261, 0.6, 1.4, 1.0);
}

/* A corner that has slid sticks where it is while a part of the load goes: it
 * keeps its displacement, and the error of that. */
static void check_stays(const char *type) {
  JOB j =
      job_with("stays", "tests/regression/mesh/square.geo",
               "*PARAMETER\nN = 5\n*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n"
               "*ELASTIC\n1000., 0.3\n*SOLID SECTION, ELSET=BODY, MATERIAL=M, "
               "TYPE=%s\n*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
               "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
               "*FRICTION, CONTACT=C, LAW=COULOMB\n0.2\n*GOAL, NAME=CORNER, "
               "QUANTITY=DISPLACEMENT, COMPONENT=1\n1., 0.\n"
               "*STEP\n*QUASISTATIC\n1., 2.\n*BOUNDARY\nLEFT, 1\n*DSLOAD\n"
               "TOP, P, \"10*min(t,1)\"\nRIGHT, TX, \"if(t<1.5, 10, 9)\"\n"
               "*PRINT, GOALS, CONTACT\n*END STEP\n",
               type);
  ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
  double value[2], error[2];
  for (int k = 0; k < 2; ++k) {
    DAT t = job_table(&j, "GOALS", k), c = job_table(&j, "CONTACT", k);
    const int corner = dat_row_near(&c, "node_no", 2);
    ck_assert_double_eq(dat_at(&c, corner, "status"), k == 0 ? 1.0 : 2.0);
    value[k] = dat_at(&t, 0, "value");
    error[k] = dat_at(&t, 0, "error");
  }
  ck_assert_double_eq_tol(value[1], value[0], 1e-12);
  ck_assert_double_gt(fabs(error[0]), 1e-3 * fabs(value[0]));
  ck_assert_double_eq_tol(error[1], error[0], 1e-9 * fabs(error[0]));
}

TEST(node_that_stays_where_it_slid_keeps_its_error) {
  check_stays("CPE3");
  check_stays("CPS3");
  check_stays("CAX3");
}

/* The condensed stiffness is formed, or known by products and solves. */
TEST(both_kinds_of_stiffness_give_the_same) {
  JOB dense = to_and_fro("DENSE"), factor = to_and_fro("FACTOR");
  for (int k = 0; k < 4; ++k) {
    const told a = told_of(&dense, k), b = told_of(&factor, k);
    ck_assert_double_eq_tol(b.value, a.value, 1e-9 * fabs(a.value));
    ck_assert_double_eq_tol(b.error, a.error, 1e-9 * fabs(a.error));
    ck_assert_double_eq_tol(b.band, a.band, 1e-9 * fabs(a.band));
    ck_assert_double_eq_tol(b.ends, a.ends, 1e-9 * a.ends);
  }
}

/* On the axis, and in space: 3 P/(2 pi a^2), a = (3 P R/(4 E*))^(1/3). */
TEST(peak_and_width_of_the_sphere) {
  static const char goals[] =
      "*GOAL, NAME=PEAK, QUANTITY=PRESSURE, CONTACT=POLE\n"
      "*GOAL, NAME=WIDE, QUANTITY=WIDTH, CONTACT=POLE\n"
      "*PARAMETER\nR3 = \"0.3*A\"\nR1 = \"0.1*A\"\n"
      "*GOAL, NAME=AT, QUANTITY=PRESSURE, CONTACT=POLE\n<R3>, 0.\n"
      "*GOAL, NAME=NEXT, QUANTITY=PRESSURE, CONTACT=POLE\n<R1>, 0.\n"
      "*GOAL, NAME=CUT, QUANTITY=PRESSURE, CONTACT=POLE, RADIUS=<R3>\n"
      "<R1>, 0.\n";
  job j = with_goals("input/hertz_sphere/hertz_sphere", goals, "-D NC=16");
  check_goal(&j, 0, 4688.3, 0.7, 1.5, 1.0);
  check_goal(&j, 1, 1.0016 * 0.31913, 0.5, 2.0, 1.0);
  const told at = told_of(&j, 2), next = told_of(&j, 3);
  ck_assert_double_eq_tol(at.value + at.error, 4688.3 * sqrt(1.0 - 0.09), 40.0);
  ck_assert_double_eq_tol(next.value + next.error, 4688.3 * sqrt(1.0 - 0.01),
                          40.0);
  ck_assert(goal_has_verdict(&j, "CUT", "no_end"));
  job_end(&j);
  j = with_goals("input/hertz_sphere/hertz_sphere_3d", goals, "");
  check_goal(&j, 0, 4688.3, 0.3, 2.0, 1.0);
  ck_assert(isnan(told_of(&j, 1).value));
  ck_assert(goal_has_verdict(&j, "WIDE", "not_covered"));
  job_end(&j);
}

/* The largest pressure of a node is some edges away from the pole, the largest
 * mean is not. */
TEST(largest_mean_in_space_is_at_the_pole) {
  JOB j = with_goals("input/hertz_sphere/hertz_sphere_3d",
                     "*GOAL, NAME=MOST, QUANTITY=PRESSURE, CONTACT=POLE\n"
                     "*GOAL, NAME=AT, QUANTITY=PRESSURE, CONTACT=POLE\n"
                     "0., 0., 0.\n",
                     "-D NC=9");
  const told most = told_of(&j, 0), at = told_of(&j, 1);
  ck_assert_double_eq_tol(most.value, at.value, 1e-3 * at.value);
  ck_assert_double_eq_tol(most.error, at.error, 1e-3 * at.value);
}

/* A bar under its weight, held at its foot: the displacement of a node is exact
 * (closed form at the top rho g L^2/(2 E)), the energy is not: per area it is
 * (rho g)^2 L^3/(6 E), less by its error in the energy norm. */
TEST(energy_of_a_bar_under_its_weight) {
  JOB j = job_with(
      "bar", "input/greco/greco.geo",
      "*PARAMETER\nN = 8\nSTRUCTURED = 1\n*MESH, FILE=greco.geo\n"
      "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n"
      "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=CPE3\n"
      "*GOAL, NAME=U, QUANTITY=DISPLACEMENT, GROUP=TOP, COMPONENT=2\n"
      "*GOAL, NAME=E, QUANTITY=ENERGY\n"
      "*GOAL, NAME=S, QUANTITY=STRESS, GROUP=BODY, COMPONENT=YY\n"
      "*STEP\n*STATIC\n*BOUNDARY\nCONTACT, 1, 2, 0.\nSYMMETRY, 1, 1, 0.\n"
      "LEFT, 1, 1, 0.\n*DLOAD\nBODY, BY, -1.\n*PRINT, GOALS\n"
      "*ACCURACY, MESH=NO\n"
      "*END STEP\n");
  CK_EXIT(job_run(&j, ""), 0, j);
  check_goal(&j, 1, 40.0 * 40.0 * 40.0 * 40.0 / 6000.0, 0.8, 1.2, 10.0);
  long bytes;
  ck_assert_int_eq(job_stage(&j, "error of mesh", &bytes), 0);
  ck_assert_int_eq(job_stage(&j, "errors of goals", &bytes), 2); /* table */
  const told u = told_of(&j, 0), s = told_of(&j, 2);
  ck_assert_double_eq_tol(u.value + u.error, -40.0 * 40.0 / 2000.0, 2e-3 * 0.8);
  ck_assert_double_eq_tol(s.value + s.error, -20.0, 0.02);
}

/* What the estimate does not cover has its value and says so. */
TEST(goals_that_are_not_covered_say_so) {
  job j = with_goals("input/greco/greco",
                     "*GOAL, NAME=GRIP, QUANTITY=FORCE, CONTACT=FOOT, "
                     "COMPONENT=1\n*GOAL, NAME=WORK, QUANTITY=FRICTION WORK\n",
                     "-D N=8");
  ck_assert(!goal_has_verdict(&j, "GRIP", "no_history"));
  ck_assert(isfinite(told_of(&j, 1).error));
  job_end(&j);
  j = with_goals("input/creep_block/creep_block",
                 "*GOAL, NAME=E, QUANTITY=ENERGY\n", "-D N=8");
  ck_assert(goal_has_verdict(&j, "E", "not_covered"));
  ck_assert(isfinite(told_of(&j, 0).value) && isnan(told_of(&j, 0).error));
  FREED char *lst = job_file(&j, "lst");
  ck_assert_ptr_nonnull(strstr(lst, "no estimate: not covered"));
  job_end(&j);
}

/* A block of two parts side by side, 4 x 2, with "goals" and a contact. */
static void write_block(job *j, double size, double young, const char *right,
                        const char *goals) {
  job_write(j, "block.geo",
            "h = %g;\nPoint(1) = {0, 0, 0, h};\nPoint(2) = {2, 0, 0, h};\n"
            "Point(3) = {4, 0, 0, h};\nPoint(4) = {4, 2, 0, 8*h};\n"
            "Point(5) = {2, 2, 0, 8*h};\nPoint(6) = {0, 2, 0, 8*h};\n"
            "For k In {1 : 5}\n  Line(k) = {k, k + 1};\nEndFor\n"
            "Line(6) = {6, 1};\nLine(7) = {2, 5};\n"
            "Curve Loop(1) = {1, 7, 5, 6};\nPlane Surface(1) = {1};\n"
            "Curve Loop(2) = {2, 3, 4, -7};\nPlane Surface(2) = {2};\n"
            "Physical Surface(\"LEFT\") = {1};\n"
            "Physical Surface(\"RIGHT\") = {2};\n"
            "Physical Surface(\"ALL\") = {1, 2};\n"
            "Physical Point(\"CORNERS\") = {4, 6};\n"
            "Physical Point(\"END\") = {1};\n"
            "Physical Curve(\"FOOT\") = {1, 2};\n"
            "Physical Curve(\"TOP\") = {4, 5};\n"
            "Physical Curve(\"SIDE\") = {6};\n",
            size);
  job_write(j, "block.inp",
            "*MESH, FILE=block.geo\n*MATERIAL, NAME=M\n*ELASTIC\n%g, 0.3\n"
            "*SOLID SECTION, ELSET=LEFT, MATERIAL=M\n"
            "*SOLID SECTION, ELSET=RIGHT, MATERIAL=M%s\n%s"
            "*END STEP\n",
            young, right, goals);
  CK_EXIT(job_run(j, ""), 0, *j);
}

/* Two parabolas below a soft block: the zone of the larger pressure, from the
 * first to the last closed node of it but for one element. */
TEST(width_is_that_of_one_zone) {
  JOB j = job_begin("block");
  write_block(
      &j, 0.025, 1e-3, "",
      "*OBSTACLE, NAME=O, TYPE=GAP\n"
      "\"min((x - 1)^2/8 + 0.008, (x - 3.01)^2/4)\"\n"
      "*CONTACT, NAME=FOOT, GROUP=FOOT, OBSTACLE=O\n"
      "*GOAL, NAME=WIDE, QUANTITY=WIDTH, CONTACT=FOOT\n"
      "*GOAL, NAME=PEAK, QUANTITY=PRESSURE, CONTACT=FOOT, RADIUS=0.15\n"
      "*GOAL, NAME=AT, QUANTITY=PRESSURE, CONTACT=FOOT, RADIUS=0.15\n3.01, 0.\n"
      "*GOAL, NAME=WHOLE, QUANTITY=PRESSURE, CONTACT=FOOT, RADIUS=1.05\n1., "
      "0.\n"
      "*STEP\n*STATIC\n"
      "*BOUNDARY\nTOP, 1\nTOP, 2, 2, -0.05\n*PRINT, GOALS, ZONES\n");
  DAT z = job_table(&j, "ZONES", -1);
  ck_assert_int_eq(z.n_row, 5);
  ck_assert_double_gt(dat_at(&z, 1, "extent"), 0.2);
  ck_assert_double_eq_tol(told_of(&j, 0).value, dat_at(&z, 3, "extent"), 0.025);
  ck_assert(!goal_has_verdict(&j, "WHOLE", "no_end")); /* an open one */
  const told peak = told_of(&j, 1), at = told_of(&j, 2);
  ck_assert_double_eq_tol(peak.value + peak.error, at.value + at.error,
                          3e-4 * at.value);
}

/* Materials in any order: estimates are the same but for rounding. */
TEST(order_of_materials_changes_no_estimate) {
  static const char soft[] = "*SOLID SECTION, ELSET=SOFT, MATERIAL=S\n",
                    hard[] = "*SOLID SECTION, ELSET=HARD, MATERIAL=H\n";
  told is[2][3];
  for (int k = 0; k < 2; ++k) {
    JOB j = job_with(
        "layers", "tests/regression/mesh/layers.geo",
        "*MESH, FILE=layers.geo\n*MATERIAL, NAME=S\n*ELASTIC\n100., 0.3\n"
        "*MATERIAL, NAME=H\n*ELASTIC\n1000., 0.3\n%s%s"
        "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n"
        "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
        "*GOAL, NAME=P, QUANTITY=PRESSURE, CONTACT=C, RADIUS=0.2\n0.5, 0.\n"
        "*GOAL, NAME=U, QUANTITY=DISPLACEMENT, COMPONENT=1, GROUP=HARD\n"
        "*GOAL, NAME=E, QUANTITY=ENERGY\n"
        "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\nTOP, 2, 2, -0.01\n"
        "*DSLOAD\nTOP, TX, 2.\n*PRINT, GOALS\n*END STEP\n",
        k == 0 ? soft : hard, k == 0 ? hard : soft);
    CK_EXIT(job_run(&j, ""), 0, j);
    for (int i = 0; i < 3; ++i) is[k][i] = told_of(&j, i);
  }
  for (int i = 0; i < 3; ++i) {
    ck_assert_double_gt(fabs(is[0][i].error), 0);
    ck_assert_double_eq_tol(is[1][i].error, is[0][i].error,
                            1e-7 * fabs(is[0][i].error));
    ck_assert_double_eq_tol(is[1][i].band, is[0][i].band, 1e-7 * is[0][i].band);
  }
}

/* A uniform pressure, by means that an end of the surface cuts, that are
 * shorter than an edge, off the surface, and of two thicknesses; a node, or an
 * end of the surface, at the very radius counts as beyond it, whatever rounding
 * says of 0.1. */
TEST(means_of_a_pressure_lie_on_its_surface) {
  static const char *cards =
      "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n"
      "*CONTACT, NAME=FOOT, GROUP=FOOT, OBSTACLE=O\n"
      "*GOAL, NAME=MIRROR, QUANTITY=PRESSURE, CONTACT=FOOT, RADIUS=1.\n"
      "0.5, 0.\n"
      "*GOAL, NAME=CUT, QUANTITY=PRESSURE, CONTACT=FOOT, RADIUS=0.51\n3.5, 0.\n"
      "*GOAL, NAME=WHOLE, QUANTITY=PRESSURE, CONTACT=FOOT, RADIUS=0.49\n"
      "3.5, 0.\n"
      "*GOAL, NAME=SHORT, QUANTITY=PRESSURE, CONTACT=FOOT, RADIUS=0.09\n"
      "1.5, 0.\n"
      "*GOAL, NAME=FEW, QUANTITY=PRESSURE, CONTACT=FOOT, RADIUS=0.15\n"
      "1.5, 0.\n"
      "*GOAL, NAME=OFF, QUANTITY=PRESSURE, CONTACT=FOOT, RADIUS=0.5\n"
      "2., 1.\n"
      "*GOAL, NAME=EDGE, QUANTITY=PRESSURE, CONTACT=FOOT, RADIUS=0.1\n"
      "1.3, 0.\n"
      "*GOAL, NAME=TWO, QUANTITY=PRESSURE, CONTACT=FOOT, RADIUS=0.2\n"
      "1.3, 0.\n"
      "*GOAL, NAME=END, QUANTITY=PRESSURE, CONTACT=FOOT, RADIUS=0.3\n"
      "3.7, 0.\n*GOAL, NAME=WIDE, QUANTITY=WIDTH, CONTACT=FOOT\n"
      "*STEP\n*STATIC\n*BOUNDARY\nSIDE, 1\n*DSLOAD\nTOP, P, 10.\n"
      "*PRINT, GOALS\n";
  JOB j = job_begin("block");
  write_block(&j, 0.1, 1000., "", cards);
  ck_assert(goal_has_verdict(&j, "MIRROR", "reliable"));
  ck_assert(goal_has_verdict(&j, "CUT", "no_end"));
  ck_assert(goal_has_verdict(&j, "WHOLE", "reliable"));
  ck_assert(goal_has_verdict(&j, "SHORT", "no_zone"));
  ck_assert(goal_has_verdict(&j, "FEW", "few_nodes"));
  ck_assert(goal_has_verdict(&j, "OFF", "no_zone"));
  ck_assert(goal_has_verdict(&j, "EDGE", "few_nodes"));
  ck_assert(goal_has_verdict(&j, "TWO", "reliable"));
  ck_assert(goal_has_verdict(&j, "END", "reliable"));
  for (int k = 0; k < 3; k += 2)
    ck_assert_double_eq_tol(told_of(&j, k).value, 10.0, 0.05);
  write_block(&j, 0.1, 1000., ", THICKNESS=2.", cards);
  ck_assert(goal_has_verdict(&j, "MIRROR", "not_covered"));
  ck_assert(goal_has_verdict(&j, "WIDE", "not_covered"));
  ck_assert(isnan(told_of(&j, 0).value));
}

/* The mean stress under a weight is that of its moment, whatever the mesh, so
 * that the errors of its halves are opposite, and the mean of two displacements
 * has the mean of their errors. */
TEST(means_are_of_volumes_and_of_nodes) {
  JOB j = job_begin("block");
  write_block(&j, 0.1, 1000., "",
              "*GOAL, NAME=S, QUANTITY=STRESS, GROUP=ALL, COMPONENT=YY\n"
              "*GOAL, NAME=L, QUANTITY=DISPLACEMENT, COMPONENT=2\n0., 2.\n"
              "*GOAL, NAME=R, QUANTITY=DISPLACEMENT, COMPONENT=2\n4., 2.\n"
              "*GOAL, NAME=BOTH, QUANTITY=DISPLACEMENT, GROUP=CORNERS, "
              "COMPONENT=2\n"
              "*GOAL, NAME=SL, QUANTITY=STRESS, GROUP=LEFT, COMPONENT=YY\n"
              "*GOAL, NAME=SR, QUANTITY=STRESS, GROUP=RIGHT, COMPONENT=YY\n"
              "*STEP\n*STATIC\n*BOUNDARY\nFOOT, 1, 2\n*DLOAD\n"
              "LEFT, BY, -1.\nRIGHT, BY, -3.\n*PRINT, GOALS\n");
  ck_assert_double_eq_tol(told_of(&j, 0).value, -2.0, 1e-9);
  const told l = told_of(&j, 1), r = told_of(&j, 2), both = told_of(&j, 3);
  ck_assert_double_eq_tol(both.value, 0.5 * (l.value + r.value),
                          1e-9 * fabs(l.value));
  ck_assert_double_gt(fabs(l.error), 1e-3 * fabs(l.value));
  ck_assert_double_eq_tol(both.error, 0.5 * (l.error + r.error),
                          1e-6 * fabs(l.error));
  const told sl = told_of(&j, 4), sr = told_of(&j, 5);
  ck_assert_double_gt(fabs(sl.error), 1e-5 * fabs(sl.value));
  ck_assert_double_eq_tol(sl.error, -sr.error, 1e-6 * fabs(sl.error));
}

/* A pressed block without friction to speak of slips to both sides from its
 * middle, or, carried along, to one: the elements of the middle are an end. */
TEST(slip_that_changes_its_sense_is_an_end) {
  double ends[2];
  for (int k = 0; k < 2; ++k) {
    PRINTED(cards,
            "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n"
            "*CONTACT, NAME=FOOT, GROUP=FOOT, OBSTACLE=O\n"
            "*FRICTION, CONTACT=FOOT, LAW=COULOMB\n1.E-5\n"
            "*GOAL, NAME=E, QUANTITY=ENERGY\n*STEP\n*STATIC\n"
            "*BOUNDARY\nTOP, 1, 1, %d.\n*DSLOAD\nTOP, P, \"10. + x\"\n"
            "*PRINT, GOALS, TOTALS\n",
            k);
    JOB j = job_begin("block");
    write_block(&j, 0.2, 1000., "", cards);
    DAT t = job_table(&j, "TOTALS", -1);
    ck_assert_double_eq(dat_at(&t, 0, "open") + dat_at(&t, 0, "stick"), 0.0);
    ends[k] = told_of(&j, 0).ends;
  }
  ck_assert_double_gt(ends[0], 1.02 * ends[1]);
}

/* A tube under a pressure from inside (Lame), in plane strain: energy,
 * displacement, mean radial stress. Its elements vary in hoop strain and turn:
 * with their means alone the last two estimates are 1.7 and -0.9 of the error.
 * On coarse ones the band has what is left. */
static void check_ring(double h) {
  const int fine = h < 0.2;
  static const double widens = 1.3 / 1000.0 * 10.0 / 3.0 * (0.4 + 4.0);
  JOB j = job_begin("ring");
  job_write(&j, "ring.geo",
            "h = %g;\nPoint(1) = {1, 0, 0, h};\nPoint(2) = {2, 0, 0, h};\n"
            "Point(3) = {2, 1, 0, h};\nPoint(4) = {1, 1, 0, h};\n"
            "For k In {1 : 4}\n  Line(k) = {k, k %% 4 + 1};\nEndFor\n"
            "Curve Loop(1) = {1 ... 4};\nPlane Surface(1) = {1};\n"
            "Physical Surface(\"TUBE\") = {1};\n"
            "Physical Curve(\"INSIDE\") = {4};\n"
            "Physical Curve(\"FACES\") = {1, 3};\n",
            h);
  job_write(&j, "ring.inp",
            "*MESH, FILE=ring.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
            "*SOLID SECTION, ELSET=TUBE, MATERIAL=M, TYPE=CAX3\n"
            "*GOAL, NAME=E, QUANTITY=ENERGY\n"
            "*GOAL, NAME=U, QUANTITY=DISPLACEMENT, GROUP=INSIDE, COMPONENT=1\n"
            "*GOAL, NAME=S, QUANTITY=STRESS, GROUP=TUBE, COMPONENT=XX\n"
            "*STEP\n*STATIC\n*BOUNDARY\nFACES, 2\n*DSLOAD\nINSIDE, P, 10.\n"
            "*PRINT, GOALS\n*END STEP\n");
  CK_EXIT(job_run(&j, ""), 0, j);
  check_goal(&j, 1, widens, fine ? 0.7 : h < 0.4 ? 0.2 : 0.05, 1.3, 1.0);
  if (h < 0.4) check_goal(&j, 0, 10.0 * acos(-1.0) * widens, 0.8, 1.5, 1.0);
  check_goal(&j, 2, 10.0 / 3.0 * (1.0 - 8.0 / 3.0 * log(2.0)), fine ? 0.7 : 0.5,
             fine ? 1.3 : 1.5, 1.2);
  ck_assert_double_lt(told_of(&j, 1).band, 0.01 * widens);
}

TEST(goals_of_a_ring_count_the_hoop) {
  check_ring(0.1);
  check_ring(0.25);
  check_ring(0.5);
}

/* A body of 2 x 2 x 1 on a plane. */
static void write_cube(job *j, const char *cards) {
  job_write(j, "cube.geo",
            "h = 0.25;\nPoint(1) = {0, 0, 0, h};\nPoint(2) = {2, 0, 0, h};\n"
            "Point(3) = {2, 2, 0, h};\nPoint(4) = {0, 2, 0, h};\n"
            "Point(5) = {1, 1, 0, h};\n"
            "For k In {1 : 4}\n  Line(k) = {k, k %% 4 + 1};\nEndFor\n"
            "Curve Loop(1) = {1 ... 4};\nPlane Surface(1) = {1};\n"
            "Point{5} In Surface{1};\n"
            "e[] = Extrude {0, 0, 1} { Surface{1}; };\n"
            "Physical Volume(\"BODY\") = {e[1]};\n"
            "Physical Surface(\"FOOT\") = {1};\n"
            "Physical Surface(\"TOP\") = {e[0]};\n"
            "Physical Surface(\"YS\") = {e[2]};\n"
            "Physical Surface(\"YE\") = {e[4]};\n"
            "Physical Surface(\"XS\") = {e[5]};\n"
            "Physical Point(\"PIN\") = {5};\n");
  job_write(j, "cube.inp",
            "*MESH, FILE=cube.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0., 0.\n0., 0., 1.\n"
            "*CONTACT, NAME=FOOT, GROUP=FOOT, OBSTACLE=O\n%s*END STEP\n",
            cards);
  CK_EXIT(job_run(j, ""), 0, *j);
}

/* The mean of a pressure in space goes on behind planes of symmetry, and a node
 * that a support holds in the middle is on none; planes are normal to any axis.
 */
TEST(means_in_space_go_on_behind_planes_of_symmetry) {
  JOB j = job_begin("cube");
  write_cube(&j,
             "*GOAL, NAME=PIN, QUANTITY=PRESSURE, CONTACT=FOOT, RADIUS=0.9\n"
             "1., 1., 0.\n"
             "*GOAL, NAME=NEAR, QUANTITY=PRESSURE, CONTACT=FOOT, RADIUS=0.9\n"
             "0.5, 0.4, 0.\n"
             "*GOAL, NAME=CORNER, QUANTITY=PRESSURE, CONTACT=FOOT, RADIUS=0.9\n"
             "0., 0., 0.\n"
             "*GOAL, NAME=CUT, QUANTITY=PRESSURE, CONTACT=FOOT, RADIUS=0.9\n"
             "1.5, 1., 0.\n"
             "*STEP\n*STATIC\n*BOUNDARY\nXS, 1\nYS, 2\nPIN, 1, 2\n*DSLOAD\n"
             "TOP, P, 10.\n*PRINT, GOALS\n");
  for (int k = 0; k < 3; ++k) {
    const told g = told_of(&j, k);
    ck_assert_double_eq_tol(g.value, 10.0, 0.5);
    ck_assert_double_eq_tol(g.value + g.error, 10.0, 0.1);
  }
  ck_assert(goal_has_verdict(&j, "CUT", "no_end"));
  write_cube(&j,
             "*OBSTACLE, NAME=W, TYPE=PLANE\n0., 2., 0.\n0., -1., 0.\n"
             "*CONTACT, NAME=WALL, GROUP=YE, OBSTACLE=W\n"
             "*GOAL, NAME=SIDE, QUANTITY=PRESSURE, CONTACT=WALL, RADIUS=0.9\n"
             "0., 2., 1.\n"
             "*STEP\n*STATIC\n*BOUNDARY\nXS, 1\nTOP, 3\n*DSLOAD\n"
             "YS, P, 10.\n*PRINT, GOALS\n");
  ck_assert_double_eq_tol(told_of(&j, 0).value, 10.0, 0.5);
}

/* A support that holds the end of a contact, and no more, is no plane of
 * symmetry: neither mean nor zone goes on behind it. */
TEST(ends_that_a_point_holds_are_ends) {
  static const char *const hold[] = {"END", "SIDE"};
  for (int k = 0; k < 2; ++k) {
    JOB j = job_begin("block");
    PRINTED(cards,
            "*OBSTACLE, NAME=O, TYPE=GAP\n\"x^2/100\"\n"
            "*CONTACT, NAME=FOOT, GROUP=FOOT, OBSTACLE=O\n"
            "*GOAL, NAME=AT, QUANTITY=PRESSURE, CONTACT=FOOT, RADIUS=0.3\n"
            "0., 0.\n*GOAL, NAME=WIDE, QUANTITY=WIDTH, CONTACT=FOOT\n"
            "*STEP\n*STATIC\n*BOUNDARY\n%s, 1\nTOP, 2, 2, -0.05\n"
            "*PRINT, GOALS\n",
            hold[k]);
    write_block(&j, 0.1, 1000., "", cards);
    ck_assert_int_eq(isnan(told_of(&j, 0).value), k == 0);
    ck_assert_int_eq(goal_has_verdict(&j, "WIDE", "no_end"), k == 0);
  }
}

/* A ring in a wider hole: the contact is all of its outer circle, or the lower
 * half: what lies above the zone is no part of it. */
TEST(zones_of_closed_curves_are_those_of_an_arc) {
  told g[2][2];
  for (int k = 0; k < 2; ++k) {
    JOB j = job_begin("ring");
    job_write(&j, "ring.geo",
              "h = 0.01; Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0, 0.2};\n"
              "Point(3) = {0, 1, 0, 0.2}; Point(4) = {-1, 0, 0, 0.2};\n"
              "Point(5) = {0, -1, 0, h}; Point(6) = {0.4, 0, 0, 0.2};\n"
              "Point(7) = {0, 0.4, 0, 0.2}; Point(8) = {-0.4, 0, 0, 0.2};\n"
              "Point(9) = {0, -0.4, 0, 0.2};\n"
              "For k In {0 : 3}\n"
              "  Circle(k + 1) = {2 + k, 1, 2 + (k + 1) %% 4};\n"
              "  Circle(k + 5) = {6 + k, 1, 6 + (k + 1) %% 4};\nEndFor\n"
              "Curve Loop(1) = {1:4}; Curve Loop(2) = {5:8};\n"
              "Plane Surface(1) = {1, 2}; Physical Surface(\"BODY\") = {1};\n"
              "Physical Curve(\"OUTER\") = {%s};\n"
              "Physical Curve(\"HOLE\") = {5:8};\n",
              k == 0 ? "1:4" : "3, 4");
    job_write(&j, "ring.inp",
              "*MESH, FILE=ring.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
              "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=CPE3\n"
              "*OBSTACLE, NAME=O, TYPE=GAP\n\"0.2*(1 + y)\"\n"
              "*CONTACT, NAME=C, GROUP=OUTER, OBSTACLE=O\n"
              "*GOAL, NAME=PEAK, QUANTITY=PRESSURE, CONTACT=C\n"
              "*GOAL, NAME=WIDE, QUANTITY=WIDTH, CONTACT=C\n"
              "*STEP\n*STATIC\n*BOUNDARY\nHOLE, 1\nHOLE, 2, 2, -0.02\n"
              "*PRINT, GOALS\n*END STEP\n");
    ck_assert_int_eq(job_run(&j, ""), 0);
    for (int i = 0; i < 2; ++i) g[k][i] = told_of(&j, i);
  }
  for (int i = 0; i < 2; ++i) {
    ck_assert_double_gt(g[1][i].value, 0.1);
    ck_assert_double_eq_tol(g[0][i].value, g[1][i].value, 1e-6 * g[1][i].value);
    ck_assert_double_eq_tol(g[0][i].error, g[1][i].error, 1e-4 * g[1][i].value);
  }
}

TEST(tangential_force_in_space_is_the_first) {
  JOB j = job_begin("cube");
  write_cube(&j,
             "*FRICTION, CONTACT=FOOT, LAW=COULOMB\n0.3\n"
             "*GOAL, NAME=T, QUANTITY=FORCE, CONTACT=FOOT, COMPONENT=TANGENT\n"
             "*STEP\n*STATIC\n*BOUNDARY\nTOP, 1, 1, 0.004\nTOP, 2, 2, 0.002\n"
             "*DSLOAD\nTOP, P, 10.\n*PRINT, GOALS, TOTALS\n");
  DAT t = job_table(&j, "TOTALS", -1);
  ck_assert_double_gt(fabs(dat_at(&t, 0, "tangential_2")), 1.0);
  ck_assert_double_eq_tol(told_of(&j, 0).value, dat_at(&t, 0, "tangential_1"),
                          1e-9);
}

/* A clamped block with a round foot, turned as a whole. */
static told of_turned_block(double angle) {
  static const char foot[] = "y + 0.05*(1 - y)*(x - 1)^2";
  const mesh_change change = {.map = {NULL, foot, NULL}, .turn = angle};
  FREED int *number = NULL;
  JOB j = job_begin("turned");
  PRINTED(path, "%s/turned.msh", j.dir);
  FILE *f = fopen(path, "w");
  ck_assert_ptr_nonnull(f);
  ck_assert(scene_mesh_write(f, "rect 8 4 2 1", &change, &number));
  fclose(f);
  job_write(&j, "turned.inp",
            "*MESH, FILE=turned.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n%.17g, %.17g\n"
            "*CONTACT, NAME=FOOT, GROUP=BOTTOM, OBSTACLE=O\n"
            "*GOAL, NAME=N, QUANTITY=FORCE, CONTACT=FOOT\n*STEP\n*STATIC\n"
            "*BOUNDARY\nRIGHT, 1, 2\n*DSLOAD\nTOP, P, 100.\n*PRINT, GOALS\n"
            "*END STEP\n",
            -sin(angle), cos(angle));
  ck_assert_int_eq(job_run(&j, ""), 0);
  const told g = told_of(&j, 0);
  return g;
}

TEST(errors_do_not_depend_on_the_axes) {
  const told a = of_turned_block(0.0), b = of_turned_block(0.5);
  ck_assert_double_eq_tol(a.value, b.value, 1e-9 * fabs(a.value));
  ck_assert_double_eq_tol(a.error, b.error, 1e-6 * fabs(a.error));
  ck_assert_double_eq_tol(a.band, b.band, 1e-6 * fabs(a.band));
}

UNIT_MAIN("goals")
