/*
 * METHOD=AUTO against every row of the solver table on problems from files.
 *
 *   fclib [-t TOL] [-r REPEATS] [-s SECONDS] FILE...
 *
 * A line for each file and method: CPU of the solver alone, median of repeated
 * runs from zero in a process of their own that ends after SECONDS, data ready;
 * the natural map of the forces found, worked out here from the matrix and the
 * load alone, over the largest force or load; the ratio to the fastest row of
 * the table; what AUTO tried. At the end the geometric mean and the largest of
 * AUTO's ratios.
 */
#include "base/base.h"
#include "base/system/blas.h"
#include "exchange/exchange.h"
#include "solver/solver.h"
#include "support/natural_map.h"

#include <sys/time.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { PARAM_SIZE = 512, MAX_ROWS = 16, MAX_REPEATS = 25, TRIED = 160 };
static const double ENOUGH = 1.0;  /* s of one measurement                    */
static const double RIGHT = 100.0; /* natural map of an answer, of TOL        */

typedef struct result {
  double cpu, map; /* s; -                                                   */
  int iterations;
  outcome outcome;
  char tried[TRIED];
} result;

static struct bench {
  double tol, seconds;
  int repeats;
  double sum, worst; /* of log(AUTO/best); largest ratio                    */
  int counted, failed;
} bench;

static void must(status st) {
  if (st == OK) return;
  fprintf(stderr, "fclib: %s\n", status_message());
  exit(EXIT_FAILURE);
}

/* CPU of this thread, s: the clock of a process under a limit moves by ticks.
 */
static double cpu_now(void) {
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void once(const contact_problem *cp, const solver_ops *ops, double *u,
                 double *r, result *x) {
  double param[PARAM_SIZE / sizeof(double)] = {0.0};
  solver_choice choice = {.ops = ops, .param = param, .tol = bench.tol};
  contact_solver *s = NULL;
  solver_report rep;
  memset(r, 0, (size_t)cp->m * sizeof *r);
  memset(u, 0, (size_t)cp->m * sizeof *u);
  if (cp->A == NULL) memcpy(u, cp->f, (size_t)cp->m * sizeof *u);
  if (ops != NULL) option_defaults(ops->options, param);
  double start = cpu_now();
  must(contact_solver_new(&choice, &s));
  must(contact_solve(s, cp, NULL, u, r, &rep));
  x->cpu = cpu_now() - start;
  snprintf(x->tried, sizeof x->tried, "%s", contact_solver_log(s));
  if (x->tried[0] == '\0')
    snprintf(x->tried, sizeof x->tried, "%s", rep.solver);
  contact_solver_free(&s);
  x->iterations = rep.iterations;
  x->outcome = rep.outcome;
}

static int ascending(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static void measure(const contact_problem *cp, const solver_ops *ops,
                    result *x) {
  double cpu[MAX_REPEATS], sum = 0.0;
  double *u = calloc((size_t)cp->m + 1, sizeof *u);
  double *r = calloc((size_t)cp->m + 1, sizeof *r);
  int n = 0;
  while (n < bench.repeats && (n == 0 || sum < ENOUGH)) {
    once(cp, ops, u, r, x);
    sum += cpu[n++] = x->cpu;
  }
  qsort(cpu, (size_t)n, sizeof *cpu, ascending);
  x->cpu = cpu[n / 2];
  x->map = natural_map(cp, u, r);
  if (!(x->map <= RIGHT * bench.tol) && x->outcome == CONVERGED)
    x->outcome = STOPPED_NAN;
  free(u);
  free(r);
}

/* In a process of its own: what takes too long is ended. */
static result apart(const contact_problem *cp, const solver_ops *ops) {
  result x = {.cpu = HUGE_VAL, .map = NAN, .outcome = RUNNING};
  struct itimerval limit = {.it_value.tv_sec =
                                (long)ceil(bench.seconds + ENOUGH)};
  int ends[2];
  fflush(stdout);
  if (pipe(ends) != 0) return x;
  pid_t child = fork();
  if (child == 0) {
    setitimer(ITIMER_PROF, &limit, NULL);
    measure(cp, ops, &x);
    _exit(write(ends[1], &x, sizeof x) != (ssize_t)sizeof x);
  }
  close(ends[1]);
  if (child < 0 || read(ends[0], &x, sizeof x) != (ssize_t)sizeof x)
    snprintf(x.tried, sizeof x.tried, "ended after %g s", bench.seconds);
  close(ends[0]);
  if (child > 0) waitpid(child, NULL, 0);
  return x;
}

static void line(const char *name, const result *x, double best) {
  printf("  %-9s", name);
  if (x->outcome == CONVERGED)
    printf(" %11.6f %9.1e %7d %7.2f", x->cpu, x->map, x->iterations,
           x->cpu / best);
  else
    printf("           -         - %7d       -", x->iterations);
  printf("  %s\n", x->tried);
}

static void problem(const char *name, const contact_problem *cp) {
  result rows[MAX_ROWS], chosen = apart(cp, NULL);
  double best = HUGE_VAL;
  const char *at = strrchr(name, '/');
  int n = 0;
  for (; solver_list[n] != NULL; ++n) {
    rows[n] = apart(cp, solver_list[n]);
    if (rows[n].outcome == CONVERGED) best = fmin(best, rows[n].cpu);
  }
  printf("%s: %dD, %d contacts, %s\n", at == NULL ? name : at + 1, cp->dim,
         cp->n, cp->A != NULL ? "stiffness" : "compliance");
  line("AUTO", &chosen, best);
  for (int i = 0; i < n; ++i) line(solver_list[i]->name, &rows[i], best);
  bench.failed += chosen.outcome != CONVERGED;
  if (chosen.outcome != CONVERGED || !(best < HUGE_VAL)) return;
  ++bench.counted;
  bench.sum += log(chosen.cpu / best);
  bench.worst = fmax(bench.worst, chosen.cpu / best);
}

static void file(const char *path) {
  exchange_problem *p = NULL;
  message_log *log = NULL;
  must(message_log_new(&log));
  if (exchange_read(path, EXCHANGE_FCLIB, NULL, log, &p) != OK)
    printf("%s: not read: %s\n", path, status_message());
  else if (p->n > 0)
    problem(path, &p->cp);
  memory_free(p);
  memory_free(log);
}

int main(int argc, char **argv) {
  int at = 1;
  blas_choose_kernel(argv);
  bench = (struct bench){.tol = 1e-8, .seconds = 20.0, .repeats = 9};
  for (; at + 1 < argc && argv[at][0] == '-'; at += 2) {
    if (argv[at][1] == 't') bench.tol = atof(argv[at + 1]);
    if (argv[at][1] == 's') bench.seconds = atof(argv[at + 1]);
    if (argv[at][1] == 'r') bench.repeats = atoi(argv[at + 1]);
  }
  if (bench.repeats < 1 || bench.repeats > MAX_REPEATS)
    bench.repeats = MAX_REPEATS;
  printf(
      "# tolerance %g\n# method        CPU s       map  iter.  to best"
      "  tried\n",
      bench.tol);
  for (; at < argc; ++at) file(argv[at]);
  if (bench.counted > 0)
    printf(
        "# AUTO over the best row: geometric mean %.2f of %d, largest "
        "%.2f; AUTO without an answer: %d\n",
        exp(bench.sum / bench.counted), bench.counted, bench.worst,
        bench.failed);
  return EXIT_SUCCESS;
}
