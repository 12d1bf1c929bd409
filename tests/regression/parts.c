/*
 * Parts of what is told as a sum or as the largest: the shares of a target, the
 * tables in a forecast, the bounds of effects left out under loads that rise
 * and fall, zones of a ring, each component of a stress in the true error.
 */
#include "support/block_file.h"
#include "support/grid.h"
#include "support/tips.h"
#include "support/turned_mesh.h"
#include "support/unit.h"

const int job_without_fields = 1;

static const double G = 500;

static void run(job *j) { CK_EXIT(job_run(j, ""), 0, *j); }

/* ---- a target ------------------------------------------------------------ */

/* Figures of an increment, %: mesh, steps, solver (JOB.sta). */
static void errors_of(const job *j, int increment, double error[3]) {
  char *sta = job_file(j, "sta"), *line = sta, *word[16];
  for (int no = -1; no != increment;) {
    line = strchr(line, '\n') + 1;
    ck_assert(line[0] != '\0');
    sscanf(line, "%*d %d", &no);
  }
  word[0] = strtok(line, " \n");
  for (int k = 1; k < 16; ++k) word[k] = strtok(NULL, " \n");
  for (int k = 0; k < 3; ++k) error[k] = atof(word[11 + k]);
  free(sta);
}

/* The load rises to its largest at the second increment and falls. */
TEST(target_counts_all_errors_of_the_largest_increment) {
  JOB j = job_begin("block");
  double error[3], largest[3] = {0}, worst[3] = {0}, most = 0, sum = 0;
  int at = 0;
  block_file_write(&j, (int[]){16, 12}, (double[]){40.0, 30.0}, 0);
  job_write(&j, "block.inp",
            "*MESH, FILE=block.msh\n*MATERIAL, NAME=M\n*ELASTIC\n130.D3, 0.2\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*AMPLITUDE, NAME=A\n0., 0., 0.5, 1., 1., 0.3\n"
            "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
            "*CONTACT, NAME=C, GROUP=CONTACT, OBSTACLE=O\n"
            "*FRICTION, CONTACT=C, LAW=COULOMB\n0.5\n*STEP\n*QUASISTATIC\n"
            "0.25, 1.\n*BOUNDARY\nSYMMETRY, 1\n*DSLOAD\nTOP, P, 50., A\n"
            "LEFT, P, \"100*t\", A\n*SOLVER, METHOD=SOR, TOL=1E-3\n"
            "*ACCURACY, TARGET=90\n*PRINT, ENERGY\n*END STEP\n");
  run(&j);
  for (int k = 0; k < 4; ++k) {
    DAT e = job_table(&j, "ENERGY", k);
    errors_of(&j, k + 1, error);
    for (int i = 0; i < 3; ++i) worst[i] = fmax(worst[i], error[i]);
    if (dat_at(&e, 0, "strain_energy") > most) {
      most = dat_at(&e, 0, "strain_energy");
      memcpy(largest, error, sizeof largest);
      at = k;
    }
  }
  ck_assert(at > 0 && at < 3);
  static const char *const of[] = {"mesh_error_worst_percent",
                                   "time_error_worst_percent",
                                   "solver_error_worst_percent"};
  for (int k = 0; k < 3; ++k)
    ck_assert_double_eq_tol(job_told(&j, of[k]), worst[k], 0.06 * worst[k]);
  ck_assert_double_gt(job_told(&j, of[0]), job_told(&j, "mesh_error_percent"));
  char *json = job_file(&j, "json"), *pass = strstr(json, "\"passes\"");
  static const char *const name[] = {
      "\"mesh_error_percent\": ", "\"time_error_percent\": ",
      "\"solver_error_percent\": ", "\"total_error_percent\": "};
  for (int k = 0; k < 3; ++k) {
    double told = atof(strstr(pass, name[k]) + strlen(name[k]));
    ck_assert_msg(fabs(told - largest[k]) <= 0.06 * largest[k], "%s%g, not %g",
                  name[k], told, largest[k]);
    ck_assert_double_gt(told, 1e-4);
    sum += told;
  }
  double total = atof(strstr(pass, name[3]) + strlen(name[3]));
  ck_assert_double_eq_tol(total, sum, 1e-5 * sum);
  free(json);
}

/* Unknowns, increments, CPU seconds and memory of that error, and the factors
 * that the last two are expected within. */
static void forecast_row(const job *j, double level, double row[6]) {
  double found;
  for (const char *at = j->text; at != NULL; at = strchr(at + 1, '\n'))
    if (sscanf(at, "%lf %lf %lf %lf %lf %lf %lf", &found, &row[0], &row[1],
               &row[2], &row[3], &row[4], &row[5]) == 7 &&
        found == level)
      return;
  ck_abort_msg("no row for %g: %s", level, j->text);
}

/* Increments make 0.093 of an error, by their first order; the mesh what is
 * left of it, by the order that is told, and little less. Seconds go with
 * unknowns, or their power 1.25, times increments, but for what is paid once,
 * memory with a power 1.05; of both, less is known of the smaller error. */
TEST(forecast_of_a_flow_is_that_of_its_errors) {
  double by_time, order, fitted, of, row[2][6];
  JOB j = job_begin("block");
  block_file_write(&j, (int[]){8, 6}, (double[]){4.0, 3.0}, 0);
  job_write(&j, "block.inp",
            "*MESH, FILE=block.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
            "*INELASTIC, LAW=MAXWELL\n2.\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n*STEP\n"
            "*VISCO, INTEGRATOR=BACKWARD\n0.2, 1.\n*BOUNDARY\n"
            "CONTACT, 1, 2\n*DSLOAD\nTOP, P, \"1+x\"\n"
            "*OUTPUT, HDF5=NO\n*END STEP\n");
  ck_assert_int_eq(job_run(&j, "--estimate-cost"), 0);
  const char *deck = strstr(j.text, "increments: ");
  const char *fit = strstr(j.text, "error ~ unknowns^(-");
  ck_assert(deck != NULL && fit != NULL);
  ck_assert_int_eq(sscanf(deck, "increments: %lf", &by_time), 1);
  ck_assert_int_eq(
      sscanf(fit,
             "error ~ unknowns^(-%lf) (%*[^)]), fitted to %*f %% with %*f "
             "and %lf %% with %lf",
             &order, &fitted, &of),
      3);
  for (int k = 0; k < 2; ++k) {
    const double level = k == 0 ? 0.3 : 0.1;
    forecast_row(&j, level, row[k]);
    ck_assert_double_eq_tol(row[k][1], by_time / (0.093 * level),
                            0.01 * row[k][1]);
    const double left = fitted * pow(of / row[k][0], order) / level;
    ck_assert_msg(left > 0.6 && left < 0.95, "%g of %g %%", left, level);
  }
  const double more = row[1][0] / row[0][0], times = row[1][1] / row[0][1];
  const double longer = row[1][2] / row[0][2], held = row[1][3] / row[0][3];
  ck_assert_msg(
      longer > 0.5 * more * times && longer < 1.1 * pow(more, 1.25) * times,
      "%g times the seconds", longer);
  ck_assert_double_eq_tol(held, pow(more, 1.05), 0.02 * held);
  for (int k = 4; k < 6; ++k) ck_assert_double_gt(row[1][k], 1.5 * row[0][k]);
}

/* A number of a table takes 250 ns, a row ten of them: 63 nodes and 96 elements
 * in 100 increments. */
TEST(tables_count_in_the_forecast) {
  double cpu[2], row[6];
  for (int k = 0; k < 2; ++k) {
    JOB j = job_begin("block");
    block_file_write(&j, (int[]){8, 6}, (double[]){4.0, 3.0}, 0);
    job_write(
        &j, "block.inp",
        "*MESH, FILE=block.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
        "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n*STEP\n*QUASISTATIC\n"
        "0.01, 1.\n*BOUNDARY\nCONTACT, 2\nSYMMETRY, 1\n*DSLOAD\nTOP, P, 1.\n"
        "*OUTPUT, HDF5=NO\n%s*END STEP\n",
        k ? "*PRINT, NODES, ELEMENTS\n" : "");
    ck_assert_int_eq(job_run(&j, "--estimate-cost"), 0);
    forecast_row(&j, 10, row);
    cpu[k] = row[2];
  }
  ck_assert_msg(cpu[1] > cpu[0] + 0.5 * 100 * (63 + 96) * 10 * 250e-9,
                "%g, %g s", cpu[0], cpu[1]);
}

/* The answer follows the load down to 1e-10: so does the error, over the norm
 * that was the largest. */
TEST(error_of_an_unloaded_body_is_over_the_largest) {
  JOB j = job_begin("block");
  double full[3], left[3];
  block_file_write(&j, (int[]){8, 6}, (double[]){40.0, 30.0}, 0);
  job_write(&j, "block.inp",
            "*MESH, FILE=block.msh\n*MATERIAL, NAME=M\n*ELASTIC\n130.D3, 0.2\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*AMPLITUDE, NAME=A\n0., 0., 0.5, 1., 1., 1E-10\n*STEP\n"
            "*QUASISTATIC\n0.5, 1.\n*BOUNDARY\nSYMMETRY, 1\nCONTACT, 1, 2\n"
            "*DSLOAD\nTOP, P, 50., A\n*ACCURACY, MESH=YES\n*PRINT, ELEMENTS\n"
            "*END STEP\n");
  run(&j);
  errors_of(&j, 1, full);
  errors_of(&j, 2, left);
  ck_assert_double_gt(full[0], 1);
  ck_assert_double_eq_tol(1e10 * left[0] / full[0], 1, 0.06);
  ck_assert_double_eq_tol(job_told(&j, "mesh_error_worst_percent") / full[0], 1,
                          0.06);
  ck_assert_double_eq_tol(job_told(&j, "mesh_error_percent") / left[0], 1,
                          0.06);
  for (int k = 0; k < 2; ++k) {
    DAT e = job_table(&j, "ELEMENTS", k);
    double square = 0;
    for (int i = 0; i < e.n_row; ++i)
      square += pow(dat_at(&e, i, "mesh_error"), 2);
    ck_assert_double_eq_tol(sqrt(square) / (k == 0 ? full : left)[0], 1, 0.06);
  }
}

/* The bound of the solver, sqrt(2 J) over sqrt(2 W) of the largest load, where
 * that is left and where nothing is left of it. */
TEST(bound_of_the_solver_is_over_the_largest_energy) {
  static const char *const left[] = {"1.", "1E-10"};
  for (int k = 0; k < 2; ++k) {
    JOB j = job_begin("block");
    block_file_write(&j, (int[]){8, 6}, (double[]){40.0, 30.0}, 0);
    job_write(
        &j, "block.inp",
        "*MESH, FILE=block.msh\n*MATERIAL, NAME=M\n*ELASTIC\n130.D3, 0.2\n"
        "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
        "*AMPLITUDE, NAME=A\n0., 0., 0.5, 1., 1., %s\n"
        "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
        "*CONTACT, NAME=C, GROUP=CONTACT, OBSTACLE=O\n*STEP\n"
        "*QUASISTATIC\n0.5, 1.\n*BOUNDARY\nSYMMETRY, 1\nTOP, 1, 1\n"
        "*DSLOAD\nTOP, P, \"50 + x\", A\n*SOLVER, METHOD=SOR, TOL=1E-3\n"
        "*PRINT, ENERGY\n*END STEP\n",
        left[k]);
    run(&j);
    DAT e = job_table(&j, "ENERGY", 0);
    const double bound = job_told(&j, "solver_error_energy");
    ck_assert_double_gt(bound, 0);
    ck_assert_double_eq_tol(
        job_told(&j, "solver_error_percent") /
            (100 * sqrt(bound / dat_at(&e, 0, "strain_energy"))),
        1, 1e-6);
  }
}

/* The error of a coarse mesh: the squares of the shares add up to its own. */
TEST(shares_of_the_elements_make_up_the_error) {
  job j = job_begin("block");
  block_file_write(&j, (int[]){4, 3}, (double[]){40.0, 30.0}, 0);
  job_write(&j, "block.inp",
            "*MESH, FILE=block.msh\n*MATERIAL, NAME=M\n*ELASTIC\n130.D3, 0.2\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n*STEP\n*STATIC\n"
            "*BOUNDARY\nCONTACT, 1, 2\n*DSLOAD\nTOP, TX, 50.\n"
            "*ACCURACY, MESH=YES\n*PRINT, ELEMENTS\n*END STEP\n");
  run(&j);
  DAT e = job_table(&j, "ELEMENTS", -1);
  double sum = 0, whole = job_told(&j, "mesh_error_percent");
  for (int i = 0; i < e.n_row; ++i) sum += pow(dat_at(&e, i, "mesh_error"), 2);
  ck_assert_double_gt(whole, 20);
  ck_assert_double_eq_tol(sqrt(sum) / whole, 1, 1e-9);
  job_end(&j);
}

/* ---- effects left out -----------------------------------------------------
 */

/* Loads times 0, 1/2, 1, 5/8, 1/4 at t = 0, 1/4, ...: what adds up outlives
 * the energy of the answer. */
static const double level[] = {0, 0.5, 1, 0.625, 0.25};
#define RISES "*AMPLITUDE, NAME=A, TIME=TOTAL TIME\n0., 0., 0.5, 1., 1., 0.25\n"

static double bound_of(const char *material, const char *cards,
                       const char *procedure, const char *loads, double *energy,
                       double *local) {
  PRINTED(text,
          RISES
          "%s*EFFECTS, MODE=AUTO\n*STEP\n%s0.25, 1.\n"
          "*BOUNDARY\nCLAMPED, 1, 2\n%s*PRINT, ENERGY\n*END STEP\n",
          cards, procedure, loads);
  JOB j = tips_new(G, "", text);
  tips_material(&j, material);
  run(&j);
  FREED char *lst = job_file(&j, "lst");
  ck_assert_ptr_nonnull(strstr(lst, "left out: "));
  ck_assert_ptr_null(strstr(lst, "not left out: "));
  double bound = job_told(&j, "bound");
  local[0] = job_told(&j, "stress");
  local[1] = job_told(&j, "change");
  for (int k = 0; k < 4; ++k) {
    DAT e = job_table(&j, "ENERGY", k);
    energy[k + 1] = dat_at(&e, 0, "strain_energy");
  }
  return bound;
}

/* The largest of sum[k] / level[k], twice. */
static double worst_of(const double *sum) {
  double most = 0;
  for (int k = 1; k < 5; ++k) most = fmax(most, 2 * sum[k] / level[k]);
  return most;
}

/* Rates sigma/tau: the larger of both ends of each increment adds up, of *VISCO
 * alone. */
TEST(bound_of_creep_under_a_load_that_falls) {
  static const char *const loads[] = {
      "TIPS, 2, 2, -0.001, A\n",
      "TIPS, 2, 2, -0.001, A\n*END STEP\n*STEP\n*QUASISTATIC\n0.25, 1.\n"};
  double sum[5] = {0}, energy[5], local[2];
  for (int k = 1; k < 5; ++k)
    sum[k] = sum[k - 1] + 0.25 * fmax(level[k - 1], level[k]) / 1e7;
  for (int i = 0; i < 2; ++i) {
    double told =
        bound_of("*INELASTIC, LAW=MAXWELL\n1E7\n", "",
                 "*VISCO, INTEGRATOR=EULER\n", loads[i], energy, local);
    ck_assert_double_eq_tol(told / worst_of(sum), 1, 1e-6);
    ck_assert_double_eq_tol(local[0] / worst_of(sum), 1, 1e-6);
  }
}

/* Rates sigma/tau under forces: the displacement grows by their trapezia. */
TEST(change_by_creep_under_a_force_that_falls) {
  double sum = 0, most[5] = {0}, worst = 0, energy[5], local[2];
  for (int k = 1; k < 5; ++k) {
    most[k] = most[k - 1] + 0.25 * fmax(level[k - 1], level[k]) / 1e7;
    sum += 0.25 * 0.5 * (level[k - 1] + level[k]) / 1e7;
    worst = fmax(worst, sum / level[k]);
  }
  bound_of("*INELASTIC, LAW=MAXWELL\n1E7\n", "", "*VISCO, INTEGRATOR=EULER\n",
           "*DSLOAD\nFOOT1, P, 10., A\nFOOT2, P, 10., A\nFOOT1, TX, 30., A\n",
           energy, local);
  ck_assert_double_eq_tol(local[0] / worst_of(most), 1, 1e-6);
  ck_assert_double_eq_tol(local[1] / worst, 1, 1e-6);
}

/* A pull along the floor of 1, mu N s: square roots add up. */
TEST(bound_of_friction_under_a_pull_that_falls) {
  const double mu = 1e-13, N = 10, size = sqrt(2 / G);
  double sum[5] = {0}, energy[5], local[2];
  for (int k = 1; k < 5; ++k)
    sum[k] = sum[k - 1] +
             sqrt(2 * mu * N * fabs(level[k] - level[k - 1]) / G) / size;
  double told =
      bound_of("",
               "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n"
               "*CONTACT, NAME=A, GROUP=FOOT1, OBSTACLE=O, NORMAL=OBSTACLE\n"
               "*CONTACT, NAME=B, GROUP=FOOT2, OBSTACLE=O, NORMAL=OBSTACLE\n"
               "*FRICTION, CONTACT=A, LAW=COULOMB\n1E-13\n"
               "*FRICTION, CONTACT=B, LAW=COULOMB\n1E-13\n*AMPLITUDE, NAME=ON\n"
               "0., 1., 1., 1.\n",
               "*QUASISTATIC\n", "*CLOAD\nTIPS, 1, 1., A\nTIPS, 2, -10., ON\n",
               energy, local);
  ck_assert_double_eq_tol(told / worst_of(sum), 1, 1e-6);
}

/* Thermal strain alpha (T - 0), 3 sqrt(K) of it in the energy of each body:
 * under friction all changes add up, twice; without it is that of now. */
TEST(bound_of_heat_that_falls) {
  static const char *const friction[] = {
      "", "*FRICTION, CONTACT=A, LAW=COULOMB\n0.3\n"};
  const double K = 2.6 * G / (3 * (1 - 0.6)), alpha_T = 1e-8;
  const double whole = 3 * sqrt(2 * K) * alpha_T;
  for (int k = 0; k < 2; ++k) {
    double added = 0, worst = 0, energy[5], local[2];
    PRINTED(cards,
            "*OBSTACLE, NAME=O, TYPE=PLANE\n0., -1.\n0., 1.\n"
            "*CONTACT, NAME=A, GROUP=FOOT1, OBSTACLE=O, NORMAL=OBSTACLE\n%s",
            friction[k]);
    double told = bound_of("*EXPANSION\n1E-5\n", cards, "*QUASISTATIC\n",
                           "*DSLOAD\nFOOT1, P, 10.\nFOOT2, P, 10.\n"
                           "*TEMPERATURE, AMPLITUDE=A\nBODY, 1E-3\n",
                           energy, local);
    for (int i = 1; i < 5; ++i) {
      added += 2 * whole * fabs(level[i] - level[i - 1]);
      worst = fmax(worst,
                   (k == 0 ? whole * level[i] : added) / sqrt(2 * energy[i]));
    }
    ck_assert_double_eq_tol(told / worst, 1, 1e-9);
  }
}

/* ---- a ring ---------------------------------------------------------------
 */

/* A flat foot of a body of revolution, radius 2, on a ground that falls off
 * with the radius; it is squeezed and creeps outwards over the ground. Each
 * zone is the ring between its ends. */
TEST(zones_of_revolution_are_rings) {
  const turn none = {{0, 0, 1}, 0};
  int seen[3] = {0};
  JOB j = job_begin("turned");
  OWNED mesh *m = make_grid_2d((int[]){12, 4}, (double[]){2, 1});
  turned_mesh_write(&j, m, &none);
  job_write(&j, "turned.inp",
            "*MESH, FILE=turned.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=CAX3\n"
            "*OBSTACLE, NAME=O, TYPE=GAP\n\"2E-3*x^2\"\n"
            "*CONTACT, NAME=C, GROUP=FOOT, OBSTACLE=O\n"
            "*FRICTION, CONTACT=C, LAW=COULOMB\n0.1\n"
            "*STEP\n*QUASISTATIC\n0.25, 1.\n*BOUNDARY\nHEAD, 2, 2, -0.005\n"
            "*PRINT, ZONES, CONTACT\n*END STEP\n");
  run(&j);
  const double pi = acos(-1.0);
  for (int k = 0; k < 4; ++k) {
    DAT z = job_table(&j, "ZONES", k), c = job_table(&j, "CONTACT", k);
    double end = 0;
    for (int i = 0; i < z.n_row; ++i) {
      double a = dat_at(&z, i, "r_from"), b = dat_at(&z, i, "r_to");
      const int kind = (int)dat_at(&z, i, "zone");
      ck_assert_double_eq_tol(a, end, 1e-12);
      ck_assert_double_eq_tol(dat_at(&z, i, "extent"), b - a, 1e-12);
      ck_assert_double_eq_tol(dat_at(&z, i, "area"), pi * (b * b - a * a),
                              1e-10);
      end = b;
      ++seen[kind];
      for (int q = 0; q < c.n_row; ++q) {
        double r = dat_at(&c, q, "r");
        if (r <= a || r >= b) continue;
        ck_assert_double_eq(dat_at(&c, q, "status"), kind);
        if (kind == 1)
          ck_assert_double_gt(
              dat_at(&z, i, "direction") * dat_at(&c, q, "slip"), 0);
      }
    }
    ck_assert_double_eq_tol(end, 2, 1e-12);
  }
  ck_assert(seen[0] > 0 && seen[1] > 0 && seen[2] > 0);
}

/* An even stress; next to no friction lets the foot slip by k (x - 0.37), to
 * both sides of where it does not, between two nodes. */
TEST(directions_of_slip_part_where_there_is_none) {
  const turn none = {{0, 0, 1}, 0};
  JOB j = job_begin("turned");
  OWNED mesh *m = make_grid_2d((int[]){8, 4}, (double[]){2, 1});
  turned_mesh_write(&j, m, &none);
  job_write(&j, "turned.inp",
            "*MESH, FILE=turned.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.25\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
            "*CONTACT, NAME=C, GROUP=FOOT, OBSTACLE=O\n"
            "*FRICTION, CONTACT=C, LAW=COULOMB\n1E-9\n*STEP\n*QUASISTATIC\n"
            "1., 1.\n*BOUNDARY\nHEAD, 1, 1, \"1E-3*(x - 0.37)\"\n"
            "HEAD, 2, 2, -0.003\n*PRINT, ZONES\n*END STEP\n");
  run(&j);
  DAT z = job_table(&j, "ZONES", -1);
  ck_assert_int_eq(z.n_row, 2);
  ck_assert_double_eq(dat_at(&z, 0, "zone") + dat_at(&z, 1, "zone"), 2);
  ck_assert_double_eq(dat_at(&z, 0, "direction"), -dat_at(&z, 1, "direction"));
  const double part = dat_at(&z, 0, "x_from") == 0 ? dat_at(&z, 0, "x_to")
                                                   : dat_at(&z, 1, "x_to");
  ck_assert_double_eq_tol(part, 0.37, 1e-6);
}

/* ---- true errors -----------------------------------------------------------
 */

/* One tetrahedron under the strain of u = H x; the closed form says each stress
 * otherwise by its own part of 1: the norm of a stress counts shears twice. */
TEST(true_stress_error_counts_every_component) {
  static const char tetrahedron[] =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n"
      "2 1 \"ALL\"\n3 2 \"BODY\"\n$EndPhysicalNames\n$Nodes\n4\n"
      "1 0 0 0\n2 1 0.2 0.1\n3 0.3 1.1 0\n4 0.2 0.1 0.9\n$EndNodes\n"
      "$Elements\n5\n1 2 2 1 1 1 2 3\n2 2 2 1 1 1 2 4\n3 2 2 1 1 1 3 4\n"
      "4 2 2 1 1 2 3 4\n5 4 2 2 1 1 2 3 4\n$EndElements\n";
  static const char *const name[] = {"xx", "yy", "zz", "xy", "yz", "zx"};
  const double H[3][3] = {
      {1e-3, 4e-4, -2e-4}, {1e-4, -8e-4, 5e-4}, {7e-4, -3e-4, 2e-3}};
  const double E = 1000, nu = 0.3, mu = E / 2.6, lambda = mu * 0.6 / 0.4;
  for (int other = 0; other < 6; ++other) {
    double sigma[6], square = 0, all = 0;
    char lines[800] = "";
    for (int i = 0; i < 6; ++i) {
      const int a = i % 3, b = i < 3 ? a : (i + 1) % 3;
      sigma[i] = mu * (H[a][b] + H[b][a]);
      if (i < 3) sigma[i] += lambda * (H[0][0] + H[1][1] + H[2][2]);
      double exact = sigma[i] * (i == other ? 1.5 : 1);
      square += (i < 3 ? 1 : 2) * pow(exact - sigma[i], 2);
      all += (i < 3 ? 1 : 2) * exact * exact;
      snprintf(lines + strlen(lines), 60, "stress_%s, %.17g\n", name[i], exact);
    }
    JOB j = job_begin("truth");
    job_write(&j, "truth.msh", "%s", tetrahedron);
    job_write(&j, "truth.inp",
              "*MESH, FILE=truth.msh\n*MATERIAL, NAME=M\n*ELASTIC\n%g, %g\n"
              "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n*REFERENCE\n"
              "u_x, \"%.17g*x + %.17g*y + %.17g*z\"\n"
              "u_y, \"%.17g*x + %.17g*y + %.17g*z\"\n"
              "u_z, \"%.17g*x + %.17g*y + %.17g*z\"\n%s"
              "*STEP\n*STATIC\n*BOUNDARY\n"
              "ALL, 1, 1, \"%.17g*x + %.17g*y + %.17g*z\"\n"
              "ALL, 2, 2, \"%.17g*x + %.17g*y + %.17g*z\"\n"
              "ALL, 3, 3, \"%.17g*x + %.17g*y + %.17g*z\"\n*END STEP\n",
              E, nu, H[0][0], H[0][1], H[0][2], H[1][0], H[1][1], H[1][2],
              H[2][0], H[2][1], H[2][2], other < 5 ? lines : "", H[0][0],
              H[0][1], H[0][2], H[1][0], H[1][1], H[1][2], H[2][0], H[2][1],
              H[2][2]);
    run(&j);
    ck_assert_double_le(job_told(&j, "true_displacement_error_percent"), 1e-9);
    if (other < 5)
      ck_assert_double_eq_tol(job_told(&j, "true_stress_error_percent"),
                              100 * sqrt(square / all), 1e-7);
    else /* strains by differences of the displacements */
      ck_assert_double_le(job_told(&j, "true_error_percent"), 1e-6);
  }
}

/* The same of displacements alone in a ring and in the plane. */
TEST(true_error_of_a_ring_counts_the_hoop) {
  static const char triangle[] =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n"
      "1 1 \"ALL\"\n2 2 \"BODY\"\n$EndPhysicalNames\n$Nodes\n3\n1 1 0 0\n"
      "2 2 0.1 0\n3 1.3 0.9 0\n$EndNodes\n$Elements\n4\n1 1 2 1 1 1 2\n"
      "2 1 2 1 1 2 3\n3 1 2 1 1 3 1\n4 2 2 2 1 1 2 3\n$EndElements\n";
  for (int ring = 0; ring < 2; ++ring) {
    JOB j = job_begin("truth");
    job_write(&j, "truth.msh", "%s", triangle);
    job_write(&j, "truth.inp",
              "*MESH, FILE=truth.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
              "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=%s\n*REFERENCE\n"
              "u_%s, \"1E-3*x\"\nu_%s, \"4E-4*x - 7E-4*y\"\n*STEP\n*STATIC\n"
              "*BOUNDARY\nALL, 1, 1, \"1E-3*x\"\n"
              "ALL, 2, 2, \"4E-4*x - 7E-4*y\"\n*END STEP\n",
              ring ? "CAX3" : "CPE3", ring ? "r" : "x", ring ? "z" : "y");
    run(&j);
    ck_assert_double_le(job_told(&j, "true_error_percent"), 1e-6);
  }
}

UNIT_MAIN("parts")
