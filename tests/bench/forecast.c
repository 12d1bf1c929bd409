/*
 * --estimate-cost beside the passes that reach the target: CPU seconds and
 * memory, their ratio, and the factor within which the forecast expects them.
 * Runs $PROTIS, else build/release/protis.
 */
#include "support/job.h"
#include "support/unit.h"

static const struct {
  const char *deck, *words;
  double target; /* % */
} scenes[] = {{"input/greco/greco_static", "", 3},
              {"input/greco/greco_static", "", 1},
              {"input/greco/greco_static", "", 0.3},
              {"input/hertz_line/hertz_line", "-D NC=4", 3},
              {"input/hertz_line/hertz_line", "", 1},
              {"input/hertz_line/hertz_line_friction", "-D NC=4", 3},
              {"input/hertz_line/hertz_block", "", 1},
              {"input/hertz_sphere/hertz_sphere", "-D NC=4", 3},
              {"input/hertz_sphere/hertz_sphere", "", 1},
              {"input/crack/crack", "-D N=10", 0.3},
              {"input/crack/partly_closed", "-D N=10", 3},
              {"input/press_fit/press_fit", "", 0.3},
              {"input/roller/roller", "", 1},
              {"input/tempered_strip/tempered_strip", "", 3},
              {"input/arch/arch", "", 1},
              {"input/spence/spence", "-D NC=4", 3},
              {"input/block_shear_3d/block_shear_3d", "", 10},
              {"input/hertz_sphere/hertz_sphere_3d", "-D NC=2", 7},
              {"input/hertz_sphere/hertz_sphere_3d", "-D NC=3", 7},
              {"input/lying_block/lying_block_3d", "", 7}};

typedef struct price {
  double cpu, memory; /* s, MB */
} price;

/* The row of an error in %, with its two factors, or NAN: not known. */
static int forecast_of(const job *j, double target, price *is, price *within) {
  double error, unknowns, times;
  *within = (price){NAN, NAN};
  for (const char *at = j->text; at != NULL; at = strchr(at + 1, '\n')) {
    const int n =
        sscanf(at, "%lf %lf %lf %lf %lf %lf %lf", &error, &unknowns, &times,
               &is->cpu, &is->memory, &within->cpu, &within->memory);
    if (n >= 5 && fabs(error - target) < 1e-9) return 1;
  }
  return 0;
}

/* Of all passes. */
static price price_of(const job *j) {
  static const char cpu[] = "\"cpu\": ", peak[] = "\"peak_bytes\": ";
  char *json = job_file(j, "json"), *end = strstr(json, peak), *last = NULL;
  ck_assert_ptr_nonnull(end);
  const double bytes = atof(end + sizeof peak - 1);
  *end = '\0';
  for (char *at = json; (at = strstr(at, cpu)) != NULL; ++at) last = at;
  const price p = {atof(last + sizeof cpu - 1), bytes / 1048576.0};
  free(json);
  return p;
}

static int is_near(double a, double b, double factor) {
  return a < b * factor && b < a * factor;
}

TEST(forecasts_beside_the_passes) {
  int n = 0, near[2] = {0, 0}, all = 0, told[2] = {0, 0};
  printf("%-38s %6s %9s %9s %7s %7s %9s %9s %7s %7s\n", "--estimate-cost",
         "target", "cpu[s]", "real", "ratio", "within", "MB", "real", "ratio",
         "within");
  for (size_t k = 0; k < sizeof scenes / sizeof *scenes; ++k) {
    job j;
    price expected, within;
    PRINTED(words, "%s --estimate-cost", scenes[k].words);
    job_run_with(&j, scenes[k].deck, "", 0, words);
    const int known = forecast_of(&j, scenes[k].target, &expected, &within);
    job_end(&j);
    PRINTED(card, "*ACCURACY, TARGET=%g\n", scenes[k].target);
    const int code = job_run_with(&j, scenes[k].deck, card, 0, scenes[k].words);
    if (known && code == 0) {
      const price is = price_of(&j);
      printf("%-38s %6g %9.3g %9.3g %7.2f %7.2g %9.3g %9.3g %7.2f %7.2g\n",
             scenes[k].deck, scenes[k].target, expected.cpu, is.cpu,
             is.cpu / expected.cpu, within.cpu, expected.memory, is.memory,
             is.memory / expected.memory, within.memory);
      ++n;
      all += isfinite(within.cpu);
      near[0] += is_near(is.cpu, expected.cpu, 2.0);
      near[1] += is_near(is.memory, expected.memory, 1.5);
      told[0] += is_near(is.cpu, expected.cpu, within.cpu);
      told[1] += is_near(is.memory, expected.memory, within.memory);
    } else {
      printf("%-38s %6g  %s, exit %d\n", scenes[k].deck, scenes[k].target,
             known ? "forecast" : "no forecast", code);
    }
    fflush(stdout);
    job_end(&j);
  }
  printf(
      "%d scenes: seconds within 2 in %d, memory within 1.5 in %d; of %d told "
      "as told in %d and %d\n",
      n, near[0], near[1], all, told[0], told[1]);
}

UNIT_MAIN("forecast")
