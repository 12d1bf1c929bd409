/*
 * *ACCURACY, TARGET= against brute force: the true error of what it reaches is
 * below the target, and its CPU time, all passes, beside that of the cheapest
 * uniform mesh (N segments more and more), increment and tolerance whose true
 * error is below it too.
 * Then the forecast of --estimate-cost beside the passes that reach the levels.
 *
 * True errors: of Hertz's half plane by *REFERENCE; of the block of greco by
 * its strain energy, sqrt(1 - E/108.2577), with the limit of E over meshes of
 * 64 to 512 segments (N mm). CPU seconds depend on the machine: expected are
 * their ratios, 1.5 at most beside brute force, 2 beside the forecast; small
 * meshes, whose time is that of starting gmsh, are shown too.
 */
#include "support/job.h"
#include "support/unit.h"

static const double greco_energy = 108.2577;

/* CPU seconds of the run: the last "cpu" of the part "cost". */
static double cpu_of(const job *j) {
  char *json = job_file(j, "json"), *cost = strstr(json, "\"peak_bytes\"");
  char *at = cost;
  while (at > json && strncmp(at, "\"cpu\": ", 7) != 0) --at;
  double value = atof(at + 7);
  free(json);
  return value;
}

typedef struct example {
  const char *name, *folder;
  int energy; /* 1: the true error by the strain energy                       */
  int increments; /* 1: DT is a parameter of the deck                         */
} example;

static const example hertz = {"hertz_exact", "hertz_line", 0, 0};
static const example greco = {"greco", "greco", 1, 1};
static const example line = {"hertz_line", "hertz_line", 0, 0};
static const example creep = {"creep_block", "creep_block", 0, 0};
static const example shear = {"block_shear_3d", "block_shear_3d", 0, 0};

/* The deck with another *ACCURACY (NULL: as it is) in each step. */
static int run(job *j, const example *e, const char *accuracy,
               const char *words) {
  PRINTED(path, "input/%s/%s", e->folder, e->name);
  PRINTED(card, "%s%s", accuracy != NULL ? accuracy : "",
          accuracy != NULL ? "\n" : "");
  return job_run_with(j, path, card, accuracy != NULL, words);
}

/* %, of the energy norm. */
static double true_error(const job *j, const example *e) {
  if (!e->energy) return job_told(j, "true_error_percent");
  double energy = job_value(j, "ENERGY", -1, "strain_energy");
  return 100 * sqrt(fabs(1 - energy / greco_energy));
}

/* A choice of brute force. */
typedef struct choice {
  int n;
  const char *dt, *tol; /* "" : as in the deck                                */
  double cpu;
} choice;

static const char *const tolerances[] = {"", "1e-2", "1e-4"};
static const char *const lengths[] = {"", "-D DT=1"};

/* One run; its CPU if the true error is below the target, else HUGE_VAL. */
static double try_choice(const example *e, double target, const choice *c) {
  JOB j;
  PRINTED(words, "-D N=%d %s", c->n, c->dt);
  PRINTED(card, "*ACCURACY, SOLVER=NO%s%s",
          c->tol[0] != '\0' ? "\n*SOLVER, TOL=" : "", c->tol);
  ck_assert_int_eq(run(&j, e, card, words), 0);
  double error = true_error(&j, e), cpu = cpu_of(&j);
  return error <= target ? cpu : HUGE_VAL;
}

/* The cheapest uniform mesh, increments and tolerance below the target: N in
 * steps of 1.1 until the increments and the tolerance of the deck meet it, then
 * the others with that mesh. */
static choice brute_force(const example *e, double target, int from) {
  choice best = {.n = from, .cpu = HUGE_VAL};
  for (int n = from; best.cpu == HUGE_VAL; n = n * 11 / 10 + 1) {
    ck_assert_int_lt(n, 2000);
    for (int k = 0; k < 6; ++k) {
      if (k / 3 > 0 && !e->increments) continue;
      choice c = {n, lengths[k / 3], tolerances[k % 3], 0};
      c.cpu = try_choice(e, target, &c);
      if (k == 0 && c.cpu == HUGE_VAL) break;
      if (c.cpu < best.cpu) best = c;
    }
  }
  return best;
}

static void check_target(const example *e, double target, int from) {
  JOB j;
  PRINTED(card, "*ACCURACY, TARGET=%g", target);
  ck_assert_int_eq(run(&j, e, card, ""), 0);
  double error = true_error(&j, e), cpu = cpu_of(&j);
  choice c = brute_force(e, target, from);
  printf("%-16s %9g %9.3f %9.2f %9d %8s %8s %8.2f %7.2f\n", e->name, target,
         error, cpu, c.n, c.dt[0] != '\0' ? c.dt + 6 : "deck's",
         c.tol[0] != '\0' ? c.tol : "deck's", c.cpu, cpu / c.cpu);
  fflush(stdout);
  ck_assert_msg(error <= target, "%s: true error %g", e->name, error);
}

TEST(targets) {
  printf("%-16s %9s %9s %9s %9s %8s %8s %8s %7s\n", "TARGET=", "wanted[%]",
         "true[%]", "cpu[s]", "uniform N", "DT", "TOL", "cpu[s]", "ratio");
  check_target(&greco, 1, 54);
  check_target(&greco, 0.3, 180);
  check_target(&hertz, 1, 42);
  check_target(&hertz, 0.3, 150);
}

/* Unknowns, CPU seconds and MB expected for an error in %; 0: no such row. */
static int expected(const job *j, double level, double row[3]) {
  double found, times;
  for (const char *at = j->text; at != NULL; at = strchr(at, '\n')) {
    at += *at == '\n';
    if (sscanf(at, "%lf %lf %lf %lf %lf", &found, &row[0], &times, &row[1],
               &row[2]) == 5 &&
        found == level)
      return 1;
    if (*at == '\0') break;
  }
  return 0;
}

static void check_forecast(const example *e, const double *levels, int n) {
  JOB plan;
  ck_assert_int_eq(run(&plan, e, NULL, "--estimate-cost"), 0);
  for (int i = 0; i < n; ++i) {
    double row[3];
    JOB j;
    ck_assert(expected(&plan, levels[i], row));
    PRINTED(card, "*ACCURACY, TARGET=%g", levels[i]);
    ck_assert_int_eq(run(&j, e, card, ""), 0);
    double cpu = cpu_of(&j), unknowns = job_unknowns(&j);
    double bytes = job_told(&j, "peak_bytes") / 1048576;
    printf("%-16s %8g %9.0f %9.0f %8.2f %8.2f %9.2f %9.2f %7.2f %7.2f\n",
           e->name, levels[i], row[0], unknowns, row[1], cpu, row[2], bytes,
           cpu / row[1], bytes / row[2]);
    fflush(stdout);
    ck_assert_msg(unknowns < 2 * row[0] && row[0] < 2 * unknowns, "%s: %g",
                  e->name, unknowns);
  }
}

TEST(forecasts) {
  static const double fine[] = {1, 0.3, 0.1}, coarse[] = {3, 1, 0.3},
                      solid[] = {10, 7};
  printf("%-16s %8s %9s %9s %8s %8s %9s %9s %7s %7s\n", "--estimate-cost",
         "error[%]", "unknowns", "real", "cpu[s]", "real", "mem[MB]", "real",
         "cpu /", "mem /");
  check_forecast(&greco, fine, 3);
  check_forecast(&line, coarse, 3);
  check_forecast(&creep, fine, 3);
  check_forecast(&shear, solid, 2);
}

UNIT_MAIN_FOR("target", 1800)
