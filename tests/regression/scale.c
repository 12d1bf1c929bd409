/*
 * Units: the same scene in other units gives the same answer; powers of two in
 * the forces or the lengths leave every bit. Bodies of one scene may differ by
 * any power of ten.
 */
#include "scenes/mesh.h"
#include "support/job.h"
#include "support/unit.h"

const int job_without_fields = 1;

/* Half block pressed from above and from the side, mu = 1, in four increments:
 * open, slipping and sticking nodes. Length unit: 1/length of the base unit;
 * force unit likewise. */
static job run_scaled(double length, double force, const char *extra) {
  double stress = force / (length * length);
  job j = job_with("scale", "tests/regression/mesh/square.geo",
                   "*PARAMETER\nN = 12\nLX = 40\nLY = 40\n"
                   "*MESH, FILE=square.geo, SCALE=%.17g\n"
                   "*MATERIAL, NAME=M\n*ELASTIC\n%.17g, 0.2\n"
                   "*SOLID SECTION, ELSET=BODY, MATERIAL=M, THICKNESS=%.17g\n"
                   "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
                   "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
                   "*FRICTION, CONTACT=C, LAW=COULOMB\n1.0\n"
                   "*STEP\n*QUASISTATIC\n0.25, 1.0\n*BOUNDARY\nRIGHT, 1\n"
                   "*DSLOAD\nTOP, P, %.17g\nLEFT, P, %.17g\n%s"
                   "*PRINT, CONTACT, ENERGY, ZONES\n*END STEP\n",
                   length, 130000.0 * stress, length, 50.0 * stress,
                   150.0 * stress, extra);
  CK_EXIT(job_run(&j, "--no-timing"), 0, j);
  return j;
}

static const char *const methods[] = {"*SOLVER, METHOD=AUTO\n",
                                      "*SOLVER, METHOD=NEWTON\n",
                                      "*SOLVER, METHOD=SOR, TOL=1E-11\n"};

/* Columns of b are those of a times a factor, to a relative tolerance. */
static void compare(const job *a, const job *b, double length, double force,
                    double tol) {
  static const struct {
    const char *name;
    int lengths, forces;
  } column[] = {{"u_n", 1, 0}, {"u_t", 1, 0},  {"gap", 1, 0}, {"f_n", 0, 1},
                {"f_t", 0, 1}, {"slip", 1, 0}, {"x", 1, 0},   {"limit", 0, 1}};
  for (int block = 0; block < 4; ++block) {
    dat p = job_table(a, "CONTACT", block), q = job_table(b, "CONTACT", block);
    ck_assert_int_eq(p.n_row, q.n_row);
    for (size_t c = 0; c < sizeof column / sizeof *column; ++c) {
      double factor =
          (column[c].lengths ? length : 1.0) * (column[c].forces ? force : 1.0);
      double scale = dat_max(&p, column[c].name);
      for (int i = 0; i < p.n_row; ++i) {
        double expected = dat_at(&p, i, column[c].name) * factor;
        double found = dat_at(&q, i, column[c].name);
        ck_assert_msg(fabs(found - expected) <= tol * scale * factor,
                      "%s: %.17g for %.17g", column[c].name, found, expected);
      }
    }
    for (int i = 0; i < p.n_row; ++i)
      ck_assert_double_eq(dat_at(&p, i, "status"), dat_at(&q, i, "status"));
    dat_free(&p);
    dat_free(&q);
    p = job_table(a, "ZONES", block), q = job_table(b, "ZONES", block);
    ck_assert_int_eq(p.n_row, q.n_row);
    for (int i = 0; i < p.n_row; ++i)
      ck_assert_double_le(
          fabs(dat_at(&q, i, "extent") / length / dat_at(&p, i, "extent") - 1),
          100 * tol);
    dat_free(&p);
    dat_free(&q);
  }
}

TEST(five_units_of_length) {
  /* mm is the base: m, um, inch, cm. */
  static const double length[] = {1e-3, 1e3, 1.0 / 25.4, 0.1};
  for (int s = 0; s < 3; ++s) {
    JOB base = run_scaled(1.0, 1.0, methods[s]);
    for (int k = 0; k < 4; ++k) {
      JOB other = run_scaled(length[k], 1.0, methods[s]);
      compare(&base, &other, length[k], 1.0, 1e-8);
    }
  }
}

TEST(powers_of_two_leave_every_bit) {
  static const double factor[][2] = {{1.0, 0x1p40},   {1.0, 0x1p-300},
                                     {1.0, 0x1p400},  {1024.0, 1.0},
                                     {0x1p-160, 1.0}, {0x1p160, 1.0}};
  for (int s = 0; s < 3; ++s) {
    JOB base = run_scaled(1.0, 1.0, methods[s]);
    for (int k = s == 0 ? 0 : s; k < 6; k += s == 0 ? 1 : 3) {
      JOB other = run_scaled(factor[k][0], factor[k][1], methods[s]);
      /* 17 digits identify a double: zero tolerance is bit for bit. */
      compare(&base, &other, factor[k][0], factor[k][1], 0.0);
    }
  }
}

TEST(loads_of_any_size) {
  static const double force[] = {1e-12, 1e6};
  JOB base = run_scaled(1.0, 1.0, methods[0]);
  for (int k = 0; k < 2; ++k) {
    JOB other = run_scaled(1.0, force[k], methods[0]);
    compare(&base, &other, 1.0, force[k], 1e-9);
  }
}

TEST(equal_runs_give_equal_bytes) {
  static const char *const files[] = {"lst", "dat", "sta", "cvg", "xdmf"};
  JOB a = run_scaled(1.0, 1.0, "*OUTPUT, FREQUENCY=1\n");
  JOB b = run_scaled(1.0, 1.0, "*OUTPUT, FREQUENCY=1\n");
  for (size_t k = 0; k < sizeof files / sizeof *files; ++k) {
    FREED char *p = job_file(&a, files[k]), *q = job_file(&b, files[k]);
    ck_assert_msg(p != NULL && q != NULL, "no %s", files[k]);
    ck_assert_msg(strcmp(p, q) == 0, "%s differs", files[k]);
    ck_assert_uint_gt(strlen(p), 20);
  }
  PRINTED(command, "cmp %s/scale.h5 %s/scale.h5", a.dir, b.dir);
  ck_assert_int_eq(system(command), 0);
}

/* Loads and moduli of 2^400 leave every bit, of 2^600 are refused; so small
 * ones. */
TEST(forces_beyond_the_range_are_refused) {
  JOB base = run_scaled(1.0, 1.0, methods[0]);
  for (int sign = -1; sign <= 1; sign += 2) {
    job j = run_scaled(1.0, ldexp(1.0, 400 * sign), methods[0]);
    compare(&base, &j, 1.0, ldexp(1.0, 400 * sign), 0.0);
    char words[64];
    job_end(&j);
    j = job_begin("range");
    job_copy(&j, "tests/regression/mesh/square.geo");
    snprintf(words, sizeof words, "-D F=1E%d", 180 * sign);
    job_write(&j, "range.inp",
              "*PARAMETER\nF = 1\nN = 2\n*MESH, FILE=square.geo\n"
              "*MATERIAL, NAME=M\n*ELASTIC\n1E5, 0.2\n"
              "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
              "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
              "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
              "*FRICTION, CONTACT=C, LAW=COULOMB\n1.0\n"
              "*STEP\n*STATIC\n*BOUNDARY\nRIGHT, 1\n"
              "*DSLOAD\nTOP, P, <F>\n*END STEP\n");
    const size_t n = strlen(words);
    for (int check = 0; check < 2; ++check) {
      if (check) snprintf(words + n, sizeof words - n, " --check");
      ck_assert_int_eq(job_run(&j, words), 2);
      ck_assert_ptr_nonnull(strstr(j.errors, "the largest nodal load is"));
    }
    job_end(&j);
  }
}

/* A job in each of these ways: exit 0 has numbers alone, 6 says why. */
TEST(motions_and_strains_beyond_the_range_are_no_answer) {
  static const char *const cards[] = {
      "*BOUNDARY\nRIGHT, 1, 1, %s\n", "*BOUNDARY\nRIGHT, 1\nTOP, 2, 2, -%s\n",
      "*BOUNDARY\nRIGHT, 1\n*TEMPERATURE\nBODY, %s\n",
      "*BOUNDARY\nRIGHT, 1\nTOP, 1, 1, \"%s*t\"\n"};
  static const char *const sizes[] = {"1E90", "1E140", "1E155", "1E165",
                                      "1E290"};
  for (int k = 0; k < 4 * 5; ++k) {
    JOB j = job_begin("range");
    PRINTED(card, cards[k / 5], sizes[k % 5]);
    job_copy(&j, "tests/regression/mesh/square.geo");
    job_write(&j, "range.inp",
              "*PARAMETER\nN = 2\n*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n"
              "*ELASTIC\n1E5, 0.2\n*EXPANSION\n1.\n"
              "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
              "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
              "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
              "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n"
              "*STEP\n*QUASISTATIC\n0.5, 1.\n%s"
              "*PRINT, CONTACT, ENERGY, NODES, ELEMENTS\n*END STEP\n",
              card);
    int code = job_run(&j, "");
    /* without a force of contact rounding may decide which gaps are open */
    const int fits = k % 5 < 2, expected = fits && k / 5 % 3 > 0 ? 0 : 6;
    ck_assert_msg(code == expected || (code == 0 && fits), "%s: exit %d: %s",
                  card, code, j.errors);
    const char *says = strstr(j.errors, "protis: error: ");
    ck_assert_msg(code == 0 || strstr(says, "range of the numbers") ||
                      strstr(says, "rounding leaves no correct digit"),
                  "%s: %s", card, j.errors);
    if (code == 6 && strstr(says, "the energies of displacements"))
      ck_assert_ptr_nonnull(strstr(says, "error: step 1, time 0.5: "));
    ck_assert_msg(code == 0 || (!strstr(says, "inf") && !strstr(says, "nan")),
                  "%s: %s", card, j.errors);
    FREED char *text = job_file(&j, "dat");
    ck_assert_ptr_null(strstr(text, "NaN"));
    ck_assert_ptr_null(strstr(text, "Inf"));
    /* strains and temperatures that no card gives are not seen ahead */
    if (k / 5 != 2 && k % 5 > 2) ck_assert_int_eq(job_run(&j, "--check"), 6);
  }
}

/* Between its ends the load of the first step is one of any other job; in the
 * second next to nothing is left of it. */
TEST(a_pulse_that_decays_to_next_to_nothing_is_a_load) {
  double normal[2];
  for (int k = 0; k < 2; ++k) {
    JOB j =
        job_with("pulse", "tests/regression/mesh/square.geo",
                 "*PARAMETER\nN = 2\nE0 = %s\n*MESH, FILE=square.geo\n"
                 "*MATERIAL, NAME=M\n*ELASTIC\n1E5, 0.2\n"
                 "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
                 "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
                 "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
                 "*FRICTION, CONTACT=C, LAW=COULOMB\n1.0\n"
                 "*AMPLITUDE, NAME=P\n0., <E0>\n1., 1.\n2., <E0>\n3., <E0>\n"
                 "*STEP\n*QUASISTATIC\n0.5, 2.\n*BOUNDARY\nRIGHT, 1\n"
                 "*DSLOAD, AMPLITUDE=P\nTOP, P, 50.\nLEFT, P, 150.\n"
                 "*PRINT, TOTALS\n*END STEP\n"
                 "*STEP\n*QUASISTATIC\n0.5, 1.\n*END STEP\n",
                 k == 0 ? "1E-12" : "1E-200");
    CK_EXIT(job_run(&j, "--no-timing"), 0, j);
    DAT peak = job_table(&j, "TOTALS", 1), end = job_table(&j, "TOTALS", -1);
    normal[k] = dat_at(&peak, 0, "normal");
    ck_assert_double_le(dat_at(&end, 0, "normal"), 1e-10 * normal[k]);
  }
  ck_assert_double_eq_tol(normal[1], normal[0], 1e-9 * normal[0]);
}

/* Two blocks that contact alone holds, the second "ratio" times as stiff and
 * loaded "load" times as much: by 1 downwards, 0.2 to the side. */
static job run_two(const char *method, double ratio, double load) {
  const mesh_change as_it_is = {.map = {NULL}};
  FREED int *number = NULL;
  job j = job_begin("two");
  PRINTED(path, "%s/two.msh", j.dir);
  FILE *f = fopen(path, "w");
  ck_assert_ptr_nonnull(f);
  ck_assert_int_eq(scene_mesh_write(f, "rect 3 3 1 1 + rect 3 3 1 1 at 2 0",
                                    &as_it_is, &number),
                   1);
  fclose(f);
  job_write(&j, "two.inp",
            "*MESH, FILE=two.msh\n*MATERIAL, NAME=S\n*ELASTIC\n1000., 0.3\n"
            "*MATERIAL, NAME=H\n*ELASTIC\n%.17g, 0.3\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=S\n"
            "*SOLID SECTION, ELSET=BODY2, MATERIAL=H\n"
            "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n"
            "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
            "*CONTACT, NAME=C2, GROUP=BOTTOM2, OBSTACLE=O\n"
            "*FRICTION, CONTACT=C, LAW=COULOMB\n0.5\n"
            "*FRICTION, CONTACT=C2, LAW=COULOMB\n0.5\n*STEP\n*STATIC\n"
            "*DSLOAD\nTOP, P, 1.\nTOP2, P, %.17g\nLEFT, TX, 0.2\n"
            "LEFT2, TX, %.17g\n*SOLVER, METHOD=%s\n*PRINT, TOTALS\n"
            "*END STEP\n",
            1000 * ratio, load, 0.2 * load, method);
  int code = job_run(&j, "");
  ck_assert_msg(code == 0, "%s, %g: exit %d: %s", method, ratio, code,
                j.errors);
  return j;
}

static const char *const all[] = {"AUTO",   "NEWTON",   "LEMKE",
                                  "SOR",    "AITKEN",   "PCG",
                                  "AUGLAG", "LAGRANGE", "PROXIMAL"};

TEST(two_bodies_of_any_ratio) {
  static const double ratios[] = {1e6, 1e9, 1e12, 1e-9};
  for (size_t m = 0; m < sizeof all / sizeof *all; ++m)
    for (int k = 0; k < 8; ++k) {
      const double ratio = ratios[k / 2], load = k % 2 == 0 ? 1.0 : ratio;
      JOB j = run_two(all[m], ratio, load);
      DAT t = job_table(&j, "TOTALS", -1);
      for (int c = 0; c < 2; ++c) {
        const double of = c == 0 ? 1.0 : load;
        ck_assert_double_eq_tol(dat_at(&t, c, "normal"), of, 1e-8 * of);
        ck_assert_double_eq_tol(dat_at(&t, c, "force_x"), -0.2 * of, 1e-8 * of);
      }
    }
}

/* A block pressed by 1 on a floor that passes below it. */
TESTS(floor_that_travels_far, 3) {
  static const double way[] = {1.0, 1e6, 1e8};
  for (size_t m = 0; m < sizeof all / sizeof *all; ++m) {
    JOB j =
        job_with("belt", "tests/regression/mesh/square.geo",
                 "*PARAMETER\nN = 3\n*MESH, FILE=square.geo\n"
                 "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
                 "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
                 "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n"
                 "MOVE, %.17g, 0.\n*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
                 "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n*STEP\n*QUASISTATIC\n"
                 "0.5, 1.\n*BOUNDARY\nTOP, 1\n*DSLOAD\nTOP, P, 1.\n"
                 "*SOLVER, METHOD=%s\n*PRINT, TOTALS\n*END STEP\n",
                 way[_i], all[m]);
    int code = job_run(&j, "");
    ck_assert_msg(code == 0, "%s, %g: exit %d", all[m], way[_i], code);
    DAT t = job_table(&j, "TOTALS", -1);
    ck_assert_double_eq_tol(dat_at(&t, 0, "normal"), 1.0, 1e-8);
    ck_assert_double_eq_tol(dat_at(&t, 0, "force_x"), 0.3, 1e-8);
  }
}

UNIT_MAIN("scale")
