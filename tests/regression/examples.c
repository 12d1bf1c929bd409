/*
 * Every deck of input/ against the table of its folder, reference.txt: values
 * of closed forms, of statics, of publications and of finer meshes. Its effect
 * plan against plans/NAME.txt, the section EFFECTS of JOB.lst without heading.
 * All its numbers against their sums, sums/NAME.txt: whatever changes a number
 * of an output is seen here. PROTIS_SUMS=update writes plans and sums again.
 * The runs end at the first invalid operation, division by zero or overflow of
 * floating point (tests/preload).
 */
#include "support/job.h"
#include "support/sums.h"
#include "support/unit.h"

#include <glob.h>
#include <unistd.h>

enum { MAX = 64 };

/* Decks that run with fewer segments than they say, for the time they take:
 * make reference runs them as they are. */
static const char *const coarser[][2] = {
    {"lee_radok", "-D NC=20"},
    {"nonlocal_hertz", "-D NC=16"},
    {"roller", "-D N1=10 -D N2=14"},
    {"torsion_sphere_3d", "-D NC=6"},
    {"two_rollers", "-D N1=10 -D N2=14"},
};

static const char *words_of(const char *path) {
  const char *name = strrchr(path, '/') + 1;
  for (size_t i = 0; i < sizeof coarser / sizeof *coarser; ++i)
    if (strcmp(coarser[i][0], name) == 0) return coarser[i][1];
  return "";
}

typedef struct line {
  char deck[32], table[16], row[32], column[32];
  double value, tolerance;
} line;

static int read_lines(const char *path, line *lines) {
  char text[256];
  int n = 0;
  FILE *file = fopen(path, "r");
  ck_assert_msg(file != NULL, "%s cannot be read", path);
  while (fgets(text, sizeof text, file) != NULL) {
    line *l = &lines[n];
    if (text[0] == '#') continue;
    ck_assert_int_lt(n, MAX);
    int found = sscanf(text, "%31s %15s %31s %31s %lf %lf", l->deck, l->table,
                       l->row, l->column, &l->value, &l->tolerance);
    ck_assert_msg(found == 6, "%s: '%s'", path, text);
    ++n;
  }
  fclose(file);
  return n;
}

/* "first", or "x=1.25": the nearest. */
static int find_row(const dat *d, const char *row) {
  char name[32];
  double at;
  if (strcmp(row, "first") == 0) return 0;
  ck_assert_int_eq(sscanf(row, "%31[a-z_]=%lf", name, &at), 2);
  return dat_row_near(d, name, at);
}

static void compare(const job *j, const line *l) {
  dat d = job_table(j, l->table, -1);
  double found = dat_at(&d, find_row(&d, l->row), l->column);
  ck_assert_msg(fabs(found - l->value) <= l->tolerance * fabs(l->value),
                "%s %s %s %s: %.9g, expected %.9g to %g", l->deck, l->table,
                l->row, l->column, found, l->value, l->tolerance);
  dat_free(&d);
}

/* Energies balance at every increment, in parts of the largest so far. */
static void check_balance(const job *j, const char *path) {
  static const char key[] = "\"energy_defect_worst\":";
  char *text = job_file(j, "json"), *at = strstr(text, key);
  ck_assert_msg(at != NULL, "%s: no %s", path, key);
  double worst = strtod(at + strlen(key), NULL);
  ck_assert_msg(worst <= 1e-10, "%s: energy defect %.3g", path, worst);
  free(text);
}

/* The section of the listing under a heading, up to the next blank line; the
 * caller frees. */
static char *section(const job *j, const char *heading) {
  char key[64], *text = job_file(j, "lst");
  snprintf(key, sizeof key, "\n%s\n", heading);
  char *at = strstr(text, key);
  ck_assert_msg(at != NULL, "no %s", heading);
  at = strchr(at + strlen(key), '\n') + 1;
  char *end = strstr(at, "\n\n");
  ck_assert_ptr_nonnull(end);
  memmove(text, at, (size_t)(end + 1 - at));
  text[end + 1 - at] = '\0';
  return text;
}

/* 1: what the runs give is to be written, not compared. */
static int updates(void) { return getenv("PROTIS_SUMS") != NULL; }

static void write_plan(const char *path, const char *text) {
  FILE *file = fopen(path, "w");
  ck_assert_msg(file != NULL, "%s cannot be written", path);
  fputs(text, file);
  ck_assert_int_eq(fclose(file), 0);
}

/* The effect plan, to the letter. */
static void compare_plan(const job *j, const char *name) {
  char expected[8192];
  FREED char *found = section(j, "EFFECTS");
  PRINTED(path, "tests/regression/plans/%s.txt", name);
  if (updates()) write_plan(path, found);
  FILE *file = fopen(path, "r");
  ck_assert_msg(file != NULL, "%s cannot be read", path);
  size_t n = fread(expected, 1, sizeof expected - 1, file);
  fclose(file);
  expected[n] = '\0';
  ck_assert_msg(strcmp(found, expected) == 0, "%s: the plan is now\n%s", path,
                found);
}

/* What is off has neither run nor allocated. */
static void check_off(const job *j, const char *name) {
  FREED char *text = section(j, "COST OF THE EFFECTS");
  int n = 0;
  for (char *at = strtok(text, "\n"); at != NULL; at = strtok(NULL, "\n")) {
    double share = 1.0, cpu = 1.0;
    long calls = 1, bytes = 1;
    if (strncmp(at + 29, "off", 3) != 0) continue;
    ck_assert_int_eq(
        sscanf(at + 32, "%lf %ld %lf %ld", &share, &calls, &cpu, &bytes), 4);
    ck_assert_msg(calls == 0 && bytes == 0 && share == 0.0, "%s: %s", name, at);
    ++n;
  }
  ck_assert_int_gt(n, 5);
}

/* Meshes and results are the same on every x86-64: kernels of OpenBLAS and of
 * the C library that all of them have. */
static void set_kernels(void) {
  setenv("OPENBLAS_CORETYPE", "Nehalem", 1);
  setenv("GLIBC_TUNABLES", "glibc.cpu.hwcaps=-AVX2,-AVX512F,-FMA,-FMA4", 1);
}

#ifdef __x86_64__
/* Tolerances of sums: what other kernels of OpenBLAS make of the same run,
 * those that this machine has. */
static void spread(sums *s, const char *path) {
  static const char *const kernels[] = {"Prescott", "Sandybridge", "Haswell",
                                        "SkylakeX"};
  const size_t n = __builtin_cpu_supports("avx512f") ? 4 : 3;
  for (size_t i = 0; i < n; ++i) {
    setenv("OPENBLAS_CORETYPE", kernels[i], 1);
    JOB j = job_deck(path, words_of(path));
    sums other = sums_of(&j);
    sums_spread(s, &other);
    sums_free(&other);
  }
  set_kernels();
}

static void compare_sums(const job *j, const char *path) {
  PRINTED(file, "tests/regression/sums/%s.txt", j->name);
  sums s = sums_of(j);
  if (updates()) {
    spread(&s, path);
    sums_write(&s, file);
  }
  sums_check(&s, file);
  sums_free(&s);
}
#else
static void compare_sums(const job *j, const char *path) {
  (void)j, (void)path;
}
#endif

/* Tags of JOB.xdmf close in the order they open; cells have the rows and
 * columns that their topology says. */
static void check_xml(const job *j, const char *path) {
  char *text = job_file(j, "xdmf"), *open[16], *end, type[16], of[8] = "";
  int depth = 0, n, rows, columns;
  for (char *at = strchr(text, '<'); at != NULL; at = strchr(end, '<')) {
    end = at + 1 + strcspn(at + 1, "<>");
    ck_assert_msg(*end == '>', "%s: %.60s", path, at);
    if (at[1] == '/') {
      ck_assert_msg(--depth >= 0 && strncmp(open[depth] + 1, at + 2,
                                            (size_t)(end - at - 2)) == 0,
                    "%s: %.60s", path, at);
    } else if (at[1] != '?' && end[-1] != '/') {
      ck_assert_int_lt(depth, 16);
      open[depth++] = at;
    }
    if (strncmp(at, "<Topology", 9) != 0) continue;
    columns = 1;
    ck_assert_int_ge(sscanf(at,
                            "<Topology TopologyType=\"%15[A-Za-z]\" "
                            "NumberOfElements=\"%d\" %7[A-Za-z]",
                            type, &n, of),
                     2);
    sscanf(strstr(end, "Dimensions"), "Dimensions=\"%d %d", &rows, &columns);
    const int corners = strcmp(type, "Triangle") == 0      ? 3
                        : strcmp(type, "Tetrahedron") == 0 ? 4
                        : strcmp(type, "Polyline") == 0    ? 2
                                                           : 1;
    ck_assert_msg(rows == n && columns == corners &&
                      (corners > 2 || strcmp(of, "NodesPe") == 0),
                  "%s: %.120s", path, at);
  }
  ck_assert_int_eq(depth, 0);
  free(text);
}

/* ---- over time: closed forms, and differential equations that SciPy solved
 * to 1e-8 or better -------------------------------------------------------- */

/* First row of table number k. */
static double first_of(const job *j, const char *table, int k,
                       const char *column) {
  DAT d = job_table(j, table, k);
  return dat_at(&d, 0, column);
}

/* Half-width of the contact, a^2 = 4 P R (1 + t/tau)/(pi E*), 40 increments of
 * 0.25 after the press. */
static void lee_radok(const job *j) {
  static const struct {
    int table;
    double a;
  } at[] = {
      {1, 0.1141700}, {4, 0.1318321652}, {8, 0.1522266722}, {40, 0.2636643304}};
  for (size_t i = 0; i < sizeof at / sizeof *at; ++i)
    ck_assert_double_eq_tol(first_of(j, "ZONES", at[i].table, "x_to"), at[i].a,
                            0.01 * at[i].a);
}

/* Steady stresses of a power law at every radius; their scale is p. */
static void steady_tube(const job *j, double n) {
  DAT d = job_table(j, "ELEMENTS", -1);
  const double p = 100, down = pow(2, 2 / n) - 1;
  for (int i = 0; i < d.n_row; ++i) {
    double power = pow(2 / dat_at(&d, i, "r"), 2 / n);
    double rr = -p * (power - 1) / down;
    double tt = p * (1 - (1 - 2 / n) * power) / down;
    ck_assert_double_eq_tol(dat_at(&d, i, "stress_rr"), rr, 0.01 * p);
    ck_assert_double_eq_tol(dat_at(&d, i, "stress_tt"), tt, 0.01 * p);
    ck_assert_double_eq_tol(dat_at(&d, i, "stress_zz"), 0.5 * (rr + tt),
                            0.01 * p);
  }
  ck_assert_int_gt(d.n_row, 79);
}

static void norton_ring(const job *j) { steady_tube(j, 5); }

static void norton_ring_3(const job *j) { steady_tube(j, 3); }

/* 80 increments a cycle: peaks of the first and the tenth, and ends. */
static void chaboche_cycle(const job *j) {
  static const struct {
    int table;
    double stress, p;
  } at[] = {{19, 158.206082382848, 0.00341793917617152},
            {59, -173.5536836491167, 0.010170287760614367},
            {79, 95.7920336668121, 0.012547822224613},
            {339, 177.70981177721313, 0.05612988793031968},
            {779, -179.04055116891456, 0.12758889382413002},
            {799, 107.33080676002308, 0.12979617764350623}};
  double high = 0, low = 0;
  for (size_t i = 0; i < sizeof at / sizeof *at; ++i) {
    ck_assert_double_eq_tol(first_of(j, "ELEMENTS", at[i].table, "stress_yy"),
                            at[i].stress, 1e-3 * 180);
    ck_assert_double_eq_tol(first_of(j, "ELEMENTS", at[i].table, "alpha_1"),
                            at[i].p, 1e-3 * at[i].p);
  }
  for (int k = 720; k < 800; ++k) {
    double stress = first_of(j, "ELEMENTS", k, "stress_yy");
    high = fmax(high, stress), low = fmin(low, stress);
  }
  ck_assert_double_eq_tol(high, 184.34035916957623, 1e-3 * 180);
  ck_assert_double_eq_tol(low, -184.4860144136457, 1e-3 * 180);
}

enum { PERIOD = 64, PERIODS = 20 };

/* Largest change of the pressure from a period to the next. */
static double change(const double *f, int period) {
  double largest = 0;
  for (int i = 1; i <= PERIOD; ++i)
    largest = fmax(largest,
                   fabs(f[period * PERIOD + i] - f[(period - 1) * PERIOD + i]));
  return largest;
}

/* What differs from the cycle falls by exp(-x) in a period, x the integral of
 * 1/tau over the time of contact, 0.52828 of it: 0.3665. The cycle counts as
 * reached at 1e-6 of the largest pressure; it is that of SciPy. */
static void periodic_viscous(const job *j) {
  double f[PERIODS * PERIOD + 1] = {0}, largest = 0;
  int reached = 0, open = 0;
  for (int k = 1; k <= PERIODS * PERIOD; ++k) {
    f[k] = first_of(j, "TOTALS", k - 1, "normal");
    if (k <= (PERIODS - 1) * PERIOD) continue;
    largest = fmax(largest, f[k]);
    open += f[k] == 0;
  }
  for (int n = 1; n < PERIODS && reached == 0; ++n)
    if (change(f, n) <= 1e-6 * largest) reached = n;
  ck_assert_int_ge(reached, 13);
  ck_assert_int_le(reached, 16);
  ck_assert_double_eq_tol(change(f, 9) / change(f, 8), 0.3665, 0.02 * 0.3665);
  ck_assert_double_eq_tol(largest, 3.2950371, 1e-3 * 3.3);
  ck_assert_double_eq_tol(f[19 * PERIOD + PERIOD / 2], 0.7856917309,
                          1e-3 * 3.3);
  ck_assert_double_eq_tol(f[19 * PERIOD + 3 * PERIOD / 4], 3.2171948813,
                          1e-3 * 3.3);
  ck_assert_double_eq_tol(open / (double)PERIOD, 0.47172, 1.0 / PERIOD);
}

/* Stress left in the middle of the strip over its height, profile.txt. */
static void tempered_strip(const job *j) {
  double y[64], stress[64], scale = 0;
  int n = 0;
  char text[96];
  FILE *file = fopen("input/tempered_strip/profile.txt", "r");
  ck_assert_ptr_nonnull(file);
  while (n < 64 && fgets(text, sizeof text, file) != NULL)
    if (text[0] != '#' && sscanf(text, "%lf %lf", &y[n], &stress[n]) == 2) ++n;
  fclose(file);
  ck_assert_int_eq(n, 41);
  for (int i = 0; i < n; ++i) scale = fmax(scale, fabs(stress[i]));
  DAT d = job_table(j, "ELEMENTS", -1);
  for (int i = 0; i < d.n_row; ++i) {
    double at = dat_at(&d, i, "y") * (n - 1);
    int k = (int)at;
    double expected = stress[k] + (at - k) * (stress[k + 1] - stress[k]);
    ck_assert_double_eq_tol(dat_at(&d, i, "stress_xx"), expected, 0.01 * scale);
  }
  ck_assert_int_ge(d.n_row, 40);
}

static const struct {
  const char *deck;
  void (*check)(const job *j);
} over_time[] = {
    {"norton_ring", norton_ring},
    {"chaboche_cycle", chaboche_cycle},
    {"periodic_viscous", periodic_viscous},
    {"tempered_strip", tempered_strip},
};

/* Run one deck (path without .inp) and compare its lines. */
static void run_deck(const char *path, int n, const line *lines) {
  const char *name = strrchr(path, '/') + 1;
  int compared = 0;
  JOB j = job_begin(name);
  int code = job_run_deck(&j, path, words_of(path));
  ck_assert_msg(code == 0, "%s: exit %d: %s", path, code, j.errors);
  check_balance(&j, path);
  compare_plan(&j, name);
  check_off(&j, name);
  if (job_has(&j, "xdmf")) check_xml(&j, path);
  compare_sums(&j, path);
  for (int k = 0; k < n; ++k) {
    if (strcmp(lines[k].deck, name) != 0) continue;
    compare(&j, &lines[k]);
    ++compared;
  }
  ck_assert_msg(compared > 0, "no line for %s in reference.txt", path);
  for (size_t k = 0; k < sizeof over_time / sizeof *over_time; ++k)
    if (strcmp(over_time[k].deck, name) == 0) over_time[k].check(&j);
}

/* The sanitisers must be the first that is loaded: no traps then. */
static void set_traps(void) {
#ifndef __SANITIZE_ADDRESS__
  job_preload("traps");
  int code = system("awk 'BEGIN { print log(-1) }' > /dev/null 2>&1");
  ck_assert_msg(code != 0, "traps are not set");
#endif
}

TEST(every_example_gives_the_values_of_its_table) {
  glob_t decks;
  set_traps();
  set_kernels();
  ck_assert_int_eq(glob("input/*/*.inp", 0, NULL, &decks), 0);
  for (size_t i = 0; i < decks.gl_pathc; ++i) {
    line lines[MAX];
    PRINTED(deck, "%s", decks.gl_pathv[i]);
    *strrchr(deck, '.') = '\0';
    int folder = (int)(strrchr(deck, '/') - deck);
    PRINTED(table, "%.*s/reference.txt", folder, deck);
    run_deck(deck, read_lines(table, lines), lines);
  }
  globfree(&decks);
}

/* With other numbers than in the table. */
static void run_other(const char *name, const char *words,
                      void (*check)(const job *j)) {
  JOB j = job_begin(name);
  PRINTED(deck, "input/%s/%s", name, name);
  int code = job_run_deck(&j, deck, words);
  ck_assert_msg(code == 0, "%s: exit %d: %s", name, code, j.errors);
  check(&j);
}

TEST(half_width_grows_like_the_compliance) {
  run_other("lee_radok", "", lee_radok);
}

TEST(tube_of_another_power_law_becomes_steady) {
  run_other("norton_ring", "-D EXPONENT=3 -D A=1E-11", norton_ring_3);
}

UNIT_MAIN("examples")
