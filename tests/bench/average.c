/*
 * What the nonlocal average costs: CPU seconds for surfaces of n and 4 n nodes
 * with the same neighbours for each, the ratio (4 if the cost is linear), and
 * the time per pair. Medians of the runs of this process.
 */
#include "base/base.h"
#include "contact/average/average.h"

enum { RUNS = 5 };

static int compare(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static void *need(size_t n, size_t size) {
  void *p = calloc(n, size);
  if (p == NULL) abort();
  return p;
}

/* n nodes along the axis x. */
static average_patch make_line(int axisymmetric, int n) {
  double *x = need((size_t)(2 * n), sizeof *x);
  int *face = need((size_t)(2 * n), sizeof *face);
  unsigned char *active = need((size_t)n, 1);
  memset(active, 1, (size_t)n);
  for (int i = 0; i < n; ++i) {
    x[2 * i] = i;
    face[2 * i] = i;
    face[2 * i + 1] = i + 1;
  }
  return (average_patch){2, axisymmetric, n, n - 1, x, face, active, NULL};
}

/* A square of about n nodes. */
static average_patch make_square(int n) {
  int side = 1, f = 0;
  while (side * side < n) ++side;
  int cells = (side - 1) * (side - 1);
  double *x = need((size_t)(3 * side * side), sizeof *x);
  int *face = need((size_t)(6 * cells), sizeof *face);
  unsigned char *active = need((size_t)(side * side), 1);
  memset(active, 1, (size_t)(side * side));
  for (int i = 0; i < side * side; ++i) {
    x[3 * i] = i % side;
    x[3 * i + 1] = (double)(i / side);
  }
  for (int i = 0; i < cells; ++i) {
    int a = i % (side - 1) + side * (i / (side - 1)), b = a + side;
    const int corner[6] = {a, a + 1, b + 1, a, b + 1, b};
    for (int k = 0; k < 6; ++k) face[f++] = corner[k];
  }
  return (average_patch){3, 0, side * side, 2 * cells, x, face, active, NULL};
}

static double cost(const average_patch *p, double radius, int *pairs) {
  const average_rule rule = {.kernel = KERNEL_BUMP, .radius = radius};
  double cpu[RUNS];
  for (int r = 0; r < RUNS; ++r) {
    sparse_rows G;
    average_facts facts;
    double start = timer_cpu();
    if (average_build(p, &rule, &G, &facts) != OK) {
      fprintf(stderr, "average: %s\n", status_message());
      exit(EXIT_FAILURE);
    }
    cpu[r] = timer_cpu() - start;
    *pairs = G.start[G.n];
    sparse_free(&G);
  }
  qsort(cpu, RUNS, sizeof *cpu, compare);
  return cpu[RUNS / 2];
}

static void run(const char *name, int dim, int axisymmetric, int n,
                double radius) {
  average_patch p[2];
  for (int k = 0; k < 2; ++k)
    p[k] = dim == 3 ? make_square(n << 2 * k)
                    : make_line(axisymmetric, n << 2 * k);
  double cpu[2];
  int pairs[2];
  for (int k = 0; k < 2; ++k) cpu[k] = cost(&p[k], radius, &pairs[k]);
  printf("%-8s %7d %9.1f %9.3f %9.3f %7.2f %9.2f\n", name, p[0].n_node,
         (double)pairs[0] / p[0].n_node, cpu[0], cpu[1], cpu[1] / cpu[0],
         1e6 * cpu[1] / pairs[1]);
  for (int k = 0; k < 2; ++k) {
    free((void *)p[k].x);
    free((void *)p[k].face);
    free((void *)p[k].active);
  }
}

int main(void) {
  puts("nonlocal average: CPU seconds of n and 4 n nodes");
  puts("surface    nodes  per node      n[s]    4n[s]   ratio  us/pair");
  run("line", 2, 0, 10000, 25.0);
  run("ring", 2, 1, 2500, 25.0);
  run("surface", 3, 0, 1000, 4.0);
  return EXIT_SUCCESS;
}
