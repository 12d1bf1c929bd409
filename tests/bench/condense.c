/*
 * What condensation costs against one plain factorisation and solve of the
 * same stiffness, and assembly against the factorisation. CPU seconds, one
 * thread, medians of the runs of this process.
 *
 *   condense [all]   "all" adds the squares with 5e5 and 1e6 nodes (minutes)
 *   condense threads   the factor of a cube alone, by one thread and by two
 *
 * Plain: the best of AMD, METIS and coordinate cuts on the node graph, contact
 * not set apart; order, symbolic and numeric factor, one solve. Column by
 * column: the factor of K_ii and one solve per contact unknown, measured on a
 * sample of columns and extrapolated.
 */
#include "base/base.h"
#include "base/system/blas.h"
#include "fem/factor.h"
#include "support/scene.h"

#include <malloc.h>
#include <time.h>

enum { MAX_RUNS = 5, SAMPLE = 20, METHODS = 3 };

typedef struct bench_case {
  const char *name;
  int dim, cells, runs;
  int large; /* only with "all" */
} bench_case;

static const bench_case cases[] = {
    {"2-D 1e5 nodes", 2, 315, 3, 0}, {"3-D 1e4 nodes", 3, 21, 3, 0},
    {"3-D 5e4 nodes", 3, 36, 1, 0},  {"2-D 1e6 triangles", 2, 707, 1, 1},
    {"2-D 1e6 nodes", 2, 999, 1, 1},
};

static int compare(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static double median(int n, double *v) {
  qsort(v, (size_t)n, sizeof *v, compare);
  return n % 2 ? v[n / 2] : 0.5 * (v[n / 2 - 1] + v[n / 2]);
}

static void check(status st) {
  if (st == OK) return;
  fprintf(stderr, "condense: %s\n", status_message());
  exit(EXIT_FAILURE);
}

static scene *make_case(const bench_case *b) {
  const int n[] = {b->cells, b->cells, b->cells};
  const double one[] = {1, 1, 1}, down[] = {0, -1, 0};
  mesh *m = b->dim == 2 ? make_grid_2d(n, one) : make_grid_3d(n, one);
  scene *s = scene_new(m, b->dim == 2 ? PLANE_STRAIN : SOLID_3D, 1);
  for (int c = 0; c < b->dim; ++c) scene_fix(s, "TOP", c);
  scene_contact(s, "BOTTOM", down, 0);
  return s;
}

/* Order and factor the unknowns that "contact" does not take out, then solve
 * "solves" times. Returns the CPU of all, *per_solve that of one solve. */
static double plain_run(const stiffness *k, const scene *s, order_method method,
                        int solves, double *per_solve) {
  const size_t n = (size_t)k->n_node, N = n * (size_t)k->dim;
  cholmod_common cm;
  body_factor f = {0};
  graph g = {0};
  double *load = calloc(N, sizeof *load);
  long *number = calloc(N, sizeof *number);
  for (size_t i = 0; i < N; ++i) load[i] = 1;
  cholmod_l_start(&cm);
  f.node = memory_new(n, sizeof *f.node);
  for (int i = 0; i < k->n_node; ++i)
    if (k->free[i]) f.node[f.n_node++] = i;
  f.n_inner = f.n_own = f.n_node;
  double begin = timer_cpu();
  check(graph_of_unknowns(k, &g));
  check(order_by(method, &g, k->dim, s->m->x, f.n_node, f.node, &cm));
  body_factor_number(k, &f, number);
  check(body_factor_build(k, number, &cm, &f));
  double cpu = timer_cpu() - begin;
  begin = timer_cpu();
  for (int q = 0; q < solves; ++q) {
    check(body_factor_forward(&f, load, NULL, &cm));
    check(body_factor_back(&f, NULL, load, &cm));
  }
  *per_solve = (timer_cpu() - begin) / solves;
  cpu += *per_solve;
  graph_release(&g);
  body_factor_release(&f, &cm);
  cholmod_l_finish(&cm);
  free(load);
  free(number);
  return cpu;
}

/* The same stiffness without contact, or without the contact unknowns. */
static stiffness without_contact(const stiffness *k, int drop) {
  stiffness same = *k;
  const size_t n = (size_t)k->n_node;
  same.contact = malloc(n * sizeof *same.contact);
  same.first_row = malloc(n * sizeof *same.first_row);
  same.free = malloc(n);
  for (size_t i = 0; i < n; ++i) {
    same.contact[i] = same.first_row[i] = -1;
    same.free[i] = drop && k->contact[i] >= 0 ? 0 : k->free[i];
  }
  return same;
}

/* ---- threads --------------------------------------------------------------
 */

static double seconds(clockid_t clock) {
  struct timespec t;
  clock_gettime(clock, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Seconds of the factor without its analysis, which one thread makes: by the
 * clock on the wall, and of the processor of the first thread, which works or
 * waits for the other, so that its time is that of an idle machine at most. */
static void factor_seconds(const stiffness *k, const scene *s, double t[2]) {
  static const clockid_t clocks[] = {CLOCK_MONOTONIC, CLOCK_THREAD_CPUTIME_ID};
  const size_t n = (size_t)k->n_node;
  cholmod_common cm;
  graph g = {0};
  long *number = calloc(n * (size_t)k->dim, sizeof *number);
  cholmod_l_start(&cm);
  check(graph_of_unknowns(k, &g));
  t[0] = t[1] = 0;
  for (int numeric = 0; numeric < 2; ++numeric) {
    body_factor f = {.node = memory_new(n, sizeof *f.node)};
    double begin[2];
    for (int i = 0; i < k->n_node; ++i)
      if (k->free[i]) f.node[f.n_node++] = i;
    f.n_inner = f.n_own = f.n_node;
    check(order_by(ORDER_METIS, &g, k->dim, s->m->x, f.n_node, f.node, &cm));
    body_factor_number(k, &f, number);
    for (int c = 0; c < 2; ++c) begin[c] = seconds(clocks[c]);
    check(numeric ? body_factor_build(k, number, &cm, &f)
                  : body_factor_analyse(k, number, &cm, &f));
    for (int c = 0; c < 2; ++c)
      t[c] += (numeric ? 1 : -1) * (seconds(clocks[c]) - begin[c]);
    body_factor_release(&f, &cm);
  }
  graph_release(&g);
  cholmod_l_finish(&cm);
  free(number);
}

static void compare_threads(void) {
  enum { RUNS = 3, CELLS = 33 };
  const bench_case cube = {.dim = 3, .cells = CELLS};
  double v[4][RUNS], m[4];
  scene *s = make_case(&cube);
  stiffness *k;
  check(stiffness_assemble(&s->d, &k));
  stiffness same = without_contact(k, 0);
  for (int q = 0; q < RUNS; ++q)
    for (int threads = 1; threads <= 2; ++threads) {
      double t[2];
      blas_set_threads(threads);
      factor_seconds(&same, s, t);
      for (int c = 0; c < 2; ++c) v[2 * (threads - 1) + c][q] = t[c];
    }
  for (int i = 0; i < 4; ++i) m[i] = median(RUNS, v[i]);
  printf("factor of %d nodes, s    one thread   two   times\n", k->n_node);
  printf("%-24s %10.2f %5.2f %7.2f\n", "wall clock", m[0], m[2], m[0] / m[2]);
  printf("%-24s %10.2f %5.2f %7.2f\n", "CPU of the first thread", m[1], m[3],
         m[1] / m[3]);
  free(same.contact);
  free(same.first_row);
  free(same.free);
  memory_free(k);
  scene_free(s);
}

typedef struct figures {
  double assembly, factor, condense, plain[METHODS], column_wise;
  condense_info info;
} figures;

static void one_run(const scene *s, int columns, figures *r) {
  stiffness *k;
  condensed *c;
  double solve = 0;
  double begin = timer_cpu(), before = timer_cost(STAGE_FACTOR).cpu;
  check(stiffness_assemble(&s->d, &k));
  r->assembly = timer_cpu() - begin;
  begin = timer_cpu();
  check(condense(k, &s->d, &c));
  r->condense = timer_cpu() - begin;
  r->factor = timer_cost(STAGE_FACTOR).cpu - before;
  r->info = condensed_info(c);
  condensed_free(c);
  stiffness same = without_contact(k, 0);
  for (int q = 0; q < METHODS; ++q)
    r->plain[q] = s->m->dim == 3 && q == ORDER_AMD
                      ? 0
                      : plain_run(&same, s, (order_method)q, 1, &solve);
  free(same.contact);
  free(same.first_row);
  free(same.free);
  if (columns) {
    same = without_contact(k, 1);
    const order_method m = s->m->dim == 2 ? ORDER_CUTS : ORDER_METIS;
    r->column_wise = plain_run(&same, s, m, SAMPLE, &solve);
    r->column_wise += ((double)r->info.contact_unknowns - 1) * solve;
    free(same.contact);
    free(same.first_row);
    free(same.free);
  }
  memory_free(k);
}

static void warm_up(const scene *s) {
  stiffness *k;
  double solve;
  check(stiffness_assemble(&s->d, &k));
  stiffness same = without_contact(k, 0);
  plain_run(&same, s, ORDER_CUTS, 1, &solve);
  free(same.contact);
  free(same.free);
  memory_free(k);
}

static void run_case(const bench_case *b) {
  scene *s = make_case(b);
  figures r[MAX_RUNS] = {{0}};
  double v[METHODS + 4][MAX_RUNS], best = 0;
  for (int q = b->runs == 1 ? -1 : 0; q < b->runs; ++q) {
    if (q < 0) { /* memory is slow when touched first: warm up */
      warm_up(s);
      continue;
    }
    one_run(s, !b->large, &r[q]);
    for (int t = 0; t < METHODS; ++t) v[t][q] = r[q].plain[t];
    v[METHODS][q] = r[q].condense;
    v[METHODS + 1][q] = r[q].assembly;
    v[METHODS + 2][q] = r[q].factor;
    v[METHODS + 3][q] = r[q].column_wise;
  }
  double m[METHODS + 4];
  for (int t = 0; t < METHODS + 4; ++t) m[t] = median(b->runs, v[t]);
  for (int t = 0; t < METHODS; ++t)
    if (m[t] > 0 && (best == 0 || m[t] < best)) best = m[t];
  const double cond = m[METHODS], assembly = m[METHODS + 1];
  printf("%-18s %8ld %6ld %7.2f %7.2f %7.2f %8.2f %6.2f", b->name,
         r[0].info.unknowns, r[0].info.contact_unknowns, m[ORDER_CUTS],
         m[ORDER_METIS], m[ORDER_AMD], cond, cond / best);
  if (m[METHODS + 3] > 0)
    printf(" %8.2f %6.1f", m[METHODS + 3], m[METHODS + 3] / cond);
  else
    printf(" %8s %6s", "-", "-");
  printf(" %7.3f %6.1f %%  %s\n", assembly, 100 * assembly / m[METHODS + 2],
         r[0].info.ordering);
  fflush(stdout);
  scene_free(s);
}

int main(int argc, char **argv) {
  const int all = argc > 1 && strcmp(argv[1], "all") == 0;
  const char *only = argc > 2 ? argv[2] : "";
  blas_choose_kernel(argv);
  if (argc > 1 && strcmp(argv[1], "threads") == 0) {
    compare_threads();
    return EXIT_SUCCESS;
  }
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, -1);
  printf(
      "condensation, CPU s; BLAS kernel %s, one thread; column-wise from "
      "%d columns, extrapolated\n",
      blas_kernel(), SAMPLE);
  printf("%-18s %8s %6s %7s %7s %7s %8s %6s %8s %6s %7s %8s  %s\n", "case",
         "unknowns", "contact", "cuts", "METIS", "AMD", "condense", "ratio",
         "columns", "times", "assembly", "/factor", "order");
  for (size_t q = 0; q < sizeof cases / sizeof *cases; ++q)
    if ((all || !cases[q].large || *only) && strstr(cases[q].name, only))
      run_case(&cases[q]);
  for (int q = 0; q < STAGE_COUNT; ++q)
    if (timer_cost((stage)q).calls > 0)
      printf("%-32s %6ld %9.3f s\n", timer_name((stage)q),
             timer_cost((stage)q).calls, timer_cost((stage)q).cpu);
  return EXIT_SUCCESS;
}
