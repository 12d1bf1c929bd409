/*
 * AUTO against every row of the solver table on condensed blocks.
 *
 *   auto [-t TOL] [-r REPEATS] [-x ROW]... [-m MU] [-w WAY] [dim nodes]...
 *
 * Default: blocks in 2-D and 3-D; -x leaves a row out, -m and -w take one
 * coefficient and one way alone.
 *
 * For each block, friction coefficient and load (most of the floor open, mixed,
 * most of it stuck) three ways of solving:
 *   cold      one problem, start from zero
 *   warm      one problem, start from the solution at 0.9 of the load
 *   sequence  ten increments of the load on one matrix, the position of stick
 *             following, what the matrix allows kept
 * CPU of the solver, median of repeated runs in this process; a row that was
 * 20 times slower than AUTO or failed is left out of the other ways of the same
 * load, and, where that was so for all cases of a block, of larger blocks. Last
 * column: AUTO over the best row.
 */
#include "base/base.h"
#include "base/system/blas.h"
#include "fem/fem.h"
#include "solver/solver.h"
#include "support/pressed_block.h"

enum { PARAM_SIZE = 512, MAX_ROWS = 16, INCREMENTS = 10, MAX_REPEATS = 15 };
typedef enum { COLD, WARM, SEQUENCE, N_WAY } way;
static const char *const way_name[N_WAY] = {"cold", "warm", "sequence"};
static const double HOPELESS = 20.0; /* times slower than AUTO              */

static const struct loading {
  const char *name;
  double side, down;
} loadings[] = {
    {"open", 0.3, 0.01}, {"mixed", 0.15, 0.1}, {"stick", 0.02, 0.1}};

static struct bench {
  pressed_block b;
  double tol;
  int repeats;
  double *u, *r, *start_u, *start_r; /* [m] */
  double fastest[MAX_ROWS];          /* of a row over AUTO, this block     */
  int slow[MAX_ROWS];                /* 1: left out for this load          */
  int out[4][MAX_ROWS];              /* by dim: left out                   */
  double mu;                         /* -1: all                            */
  const char *way;                   /* NULL: all                          */
} bench;

static void must(status st) {
  if (st == OK) return;
  fprintf(stderr, "auto: %s\n", status_message());
  exit(EXIT_FAILURE);
}

static contact_solver *solver_of(const solver_ops *ops, double *param) {
  solver_choice choice = {.ops = ops, .param = param, .tol = bench.tol};
  contact_solver *s = NULL;
  if (ops != NULL) option_defaults(ops->options, param);
  must(contact_solver_new(&choice, &s));
  return s;
}

static void stick_at(const double *u) {
  int dim = bench.b.cp.dim;
  for (int i = 0; i < bench.b.cp.m; ++i)
    if (i % dim > 0)
      bench.b.ut0[i / dim * (dim - 1) + i % dim - 1] = u == NULL ? 0.0 : u[i];
}

/* CPU of the solver alone, s; HUGE_VAL: not solved. */
static double increments(contact_solver *s, const struct loading *l) {
  double cpu = 0.0;
  for (int k = 1; k <= INCREMENTS && cpu < HUGE_VAL; ++k) {
    solver_report rep;
    pressed_block_load(&bench.b, l->side * k / INCREMENTS, l->down);
    stick_at(k > 1 ? bench.u : NULL);
    must(contact_solve(s, &bench.b.cp, NULL, bench.u, bench.r, &rep));
    cpu = rep.outcome == CONVERGED ? cpu + rep.cpu : HUGE_VAL;
  }
  return cpu;
}

/* CPU of one run, s; HUGE_VAL: not solved. */
static double once(const solver_ops *ops, way how, const struct loading *l) {
  double param[PARAM_SIZE / sizeof(double)] = {0.0};
  size_t bytes = (size_t)bench.b.cp.m * sizeof *bench.u;
  solver_report rep;
  memset(bench.u, 0, bytes);
  memset(bench.r, 0, bytes);
  if (how == WARM) {
    memcpy(bench.u, bench.start_u, bytes);
    memcpy(bench.r, bench.start_r, bytes);
  }
  contact_solver *s = solver_of(ops, param);
  if (how == SEQUENCE) {
    rep.cpu = increments(s, l);
  } else {
    must(contact_solve(s, &bench.b.cp, NULL, bench.u, bench.r, &rep));
    if (rep.outcome != CONVERGED) rep.cpu = HUGE_VAL;
  }
  contact_solver_free(&s);
  return rep.cpu;
}

static int ascending(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Median; runs that are long, or much longer than "enough", are not repeated.
 */
static double median(const solver_ops *ops, way how, const struct loading *l,
                     double enough) {
  double cpu[MAX_REPEATS], sum = 0.0;
  int n = 0;
  while (n < bench.repeats) {
    cpu[n] = once(ops, how, l);
    sum += cpu[n++];
    if (!(cpu[n - 1] < 2.0 * enough) || (sum > 4.0 && n >= 3)) break;
  }
  qsort(cpu, (size_t)n, sizeof *cpu, ascending);
  return cpu[n / 2];
}

static void reference(const struct loading *l) {
  double param[1];
  solver_report rep;
  stick_at(NULL);
  memset(bench.start_u, 0, (size_t)bench.b.cp.m * sizeof *bench.start_u);
  memset(bench.start_r, 0, (size_t)bench.b.cp.m * sizeof *bench.start_r);
  pressed_block_load(&bench.b, 0.9 * l->side, 0.9 * l->down);
  contact_solver *s = solver_of(NULL, param);
  must(contact_solve(s, &bench.b.cp, NULL, bench.start_u, bench.start_r, &rep));
  contact_solver_free(&s);
  pressed_block_load(&bench.b, l->side, l->down);
}

static void line(double mu, const struct loading *l, way how) {
  const contact_problem *cp = &bench.b.cp;
  double best = HUGE_VAL, first = median(NULL, how, l, HUGE_VAL);
  contact_status *state = calloc((size_t)cp->n, sizeof *state);
  int count[3] = {0, 0, 0};
  const char *name = "-";
  contact_classify(cp, bench.u, bench.r, state);
  for (int i = 0; i < cp->n; ++i) ++count[state[i]];
  free(state);
  printf("%dD %5d %4.1f %-6s %-9s %5d %5d %5d %9.5f", cp->dim, cp->n, mu,
         l->name, way_name[how], count[CONTACT_OPEN], count[CONTACT_SLIP],
         count[CONTACT_STICK], first);
  for (int i = 0; solver_list[i] != NULL; ++i) {
    const solver_ops *ops = solver_list[i];
    double cpu = HUGE_VAL;
    if (!bench.out[cp->dim][i] && !bench.slow[i] &&
        (cp->dim == 2 || (ops->handles & SOLVES_3D)))
      cpu = median(ops, how, l, fmin(best, first));
    bench.slow[i] = bench.slow[i] || cpu > HOPELESS * first;
    bench.fastest[i] = fmin(bench.fastest[i], cpu / first);
    printf(cpu < HUGE_VAL ? " %9.5f" : "         -", cpu);
    if (cpu < best) name = ops->name;
    best = fmin(best, cpu);
  }
  printf("  %-8s %6.2f%s\n", name, first / best,
         first > 1.5 * best ? "  <--" : "");
  fflush(stdout);
}

static void load_case(double mu, const struct loading *l) {
  pressed_block_friction(&bench.b, mu);
  memset(bench.slow, 0, sizeof bench.slow);
  for (way how = COLD; how < N_WAY; ++how) {
    if (bench.way != NULL && strcmp(bench.way, way_name[how]) != 0) continue;
    reference(l);
    line(mu, l, how);
  }
}

static void size(int dim, int nodes) {
  static const double mus[] = {0.0, 0.1, 0.3, 1.0};
  pressed_block *b = &bench.b;
  pressed_block_new(b, dim, nodes, dim == 2 ? 128 : 8);
  size_t m = (size_t)b->cp.m;
  double **const arrays[] = {&bench.u, &bench.r, &bench.start_u,
                             &bench.start_r};
  for (int i = 0; i < 4; ++i) *arrays[i] = calloc(m, sizeof **arrays[i]);
  for (int i = 0; i < MAX_ROWS; ++i) bench.fastest[i] = HUGE_VAL;
  for (int i = 0; i < 4; ++i)
    for (size_t k = 0; k < sizeof loadings / sizeof *loadings; ++k)
      if (bench.mu < 0.0 || bench.mu == mus[i]) load_case(mus[i], &loadings[k]);
  for (int i = 0; i < MAX_ROWS; ++i)
    bench.out[dim][i] = bench.out[dim][i] || bench.fastest[i] > HOPELESS;
  for (int i = 0; i < 4; ++i) free(*arrays[i]);
  pressed_block_free(b);
}

static void head(void) {
  printf(
      "# tolerance %g, median of %d\n# dim n   mu load   way        open"
      "  slip stick      AUTO",
      bench.tol, bench.repeats);
  for (int i = 0; solver_list[i] != NULL; ++i)
    printf(" %9s", solver_list[i]->name);
  printf("  best     AUTO/best\n");
}

static void leave_out(const char *name) {
  for (int i = 0; solver_list[i] != NULL; ++i)
    if (solver_list[i] == solver_find(name))
      bench.out[2][i] = bench.out[3][i] = 1;
}

int main(int argc, char **argv) {
  static const int sizes[][2] = {{2, 64}, {2, 256}, {2, 1000}, {2, 2000},
                                 {3, 64}, {3, 256}, {3, 1024}};
  int at = 1;
  blas_choose_kernel(argv);
  bench.tol = 1e-8;
  bench.repeats = 5;
  bench.mu = -1.0;
  for (; at + 1 < argc && argv[at][0] == '-'; at += 2) {
    if (argv[at][1] == 't') bench.tol = atof(argv[at + 1]);
    if (argv[at][1] == 'x') leave_out(argv[at + 1]);
    if (argv[at][1] == 'm') bench.mu = atof(argv[at + 1]);
    if (argv[at][1] == 'w') bench.way = argv[at + 1];
    if (argv[at][1] == 'r') bench.repeats = atoi(argv[at + 1]);
  }
  if (bench.repeats < 1 || bench.repeats > MAX_REPEATS)
    bench.repeats = MAX_REPEATS;
  head();
  if (at + 1 < argc) {
    for (; at + 1 < argc; at += 2) size(atoi(argv[at]), atoi(argv[at + 1]));
    return EXIT_SUCCESS;
  }
  for (size_t i = 0; i < sizeof sizes / sizeof *sizes; ++i)
    size(sizes[i][0], sizes[i][1]);
  return EXIT_SUCCESS;
}
