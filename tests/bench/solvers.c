/*
 * What each digit costs: every row of the solver table on condensed blocks.
 *
 *   solvers [m ...]     default: m = 100 500 1000 in 2-D and about 300 in 3-D
 *
 * The block (unit square or cube, plane strain, nu = 0.3) is held at its top,
 * pressed on the floor and pushed from one side, so that a part of the floor
 * opens, a part slips and a part sticks. Columns: iterations, passes of the
 * fixed point on the sliding limit, CPU with and without what is kept per
 * matrix, residual, and the largest error of u over the largest u, against the
 * solution at a residual of 1e-13. Rows start from zero each time.
 */
#include "base/base.h"
#include "base/system/blas.h"
#include "fem/fem.h"
#include "solver/solver.h"
#include "support/pressed_block.h"

#include <lapacke.h>

enum { PARAM_SIZE = 512 };
static const double FREE_SIDE = 0.15; /* pressure that pushes over E          */
static const double PRESSED = 0.1;    /* top moved down over the height       */

/* A row with an option other than its default. */
static const struct variant {
  const char *solver, *option, *value;
} variants[] = {{"aitken", "ACCELERATION", "ANDERSON"},
                {"pcg", "PRECONDITIONER", "DIAGONAL"},
                {"auglag", "VARIANT", "UZAWA"}};

typedef struct block {
  pressed_block body;
  double *u, *r, *exact;
} block;

static void must(status st) {
  if (st == OK) return;
  fprintf(stderr, "solvers: %s\n", status_message());
  exit(EXIT_FAILURE);
}

static double *numbers(int n) { return calloc((size_t)n + 1, sizeof(double)); }

static void block_new(block *b, int dim, int nodes) {
  pressed_block_new(&b->body, dim, nodes, nodes);
  pressed_block_load(&b->body, FREE_SIDE, PRESSED);
  b->u = numbers(b->body.cp.m);
  b->r = numbers(b->body.cp.m);
  b->exact = numbers(b->body.cp.m);
}

static void block_free(block *b) {
  pressed_block_free(&b->body);
  free(b->u);
  free(b->r);
  free(b->exact);
}

/* Condition of A in the 1-norm. */
static double condition_of(const block *b) {
  int m = b->body.cp.m;
  double *L = numbers(m * m), rcond = 0.0;
  memcpy(L, b->body.cp.A, (size_t)m * (size_t)m * sizeof *L);
  double norm = LAPACKE_dlansy(LAPACK_COL_MAJOR, '1', 'L', m, L, m);
  if (LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', m, L, m) == 0)
    LAPACKE_dpocon(LAPACK_COL_MAJOR, 'L', m, L, m, norm, &rcond);
  free(L);
  return 1.0 / rcond;
}

static double error_of(const block *b) {
  double size = 0.0, apart = 0.0;
  for (int i = 0; i < b->body.cp.m; ++i) {
    size = fmax(size, fabs(b->exact[i]));
    apart = fmax(apart, fabs(b->u[i] - b->exact[i]));
  }
  return size > 0.0 ? apart / size : apart;
}

static solver_report run(block *b, contact_solver *s) {
  solver_report rep;
  memset(b->u, 0, (size_t)b->body.cp.m * sizeof *b->u);
  memset(b->r, 0, (size_t)b->body.cp.m * sizeof *b->r);
  must(contact_solve(s, &b->body.cp, NULL, b->u, b->r, &rep));
  return rep;
}

static void print_states(const block *b) {
  contact_status *state = calloc((size_t)b->body.cp.n, sizeof *state);
  int count[3] = {0, 0, 0};
  contact_classify(&b->body.cp, b->exact, b->r, state);
  for (int i = 0; i < b->body.cp.n; ++i) ++count[state[i]];
  printf("# open %d, slip %d, stick %d nodes\n", count[CONTACT_OPEN],
         count[CONTACT_SLIP], count[CONTACT_STICK]);
  free(state);
}

static void reference(block *b) {
  solver_choice choice = {.tol = 1e-13};
  contact_solver *s = NULL;
  must(contact_solver_new(&choice, &s));
  solver_report rep = run(b, s);
  memcpy(b->exact, b->u, (size_t)b->body.cp.m * sizeof *b->u);
  print_states(b);
  if (rep.outcome != CONVERGED)
    printf("# reference: residual %.1e only\n", rep.residual);
  contact_solver_free(&s);
}

/* One line: row (ops NULL: AUTO) with an option set, or v NULL. */
static void line(block *b, const solver_ops *ops, const struct variant *v,
                 double mu, double tol) {
  double param[PARAM_SIZE / sizeof(double)] = {0.0};
  char why[160], name[64];
  solver_choice choice = {.ops = ops, .param = param, .tol = tol};
  contact_solver *s = NULL;
  snprintf(name, sizeof name, "%s%s%s", ops == NULL ? "auto" : ops->name,
           v == NULL ? "" : "/", v == NULL ? "" : v->value);
  if (ops != NULL) option_defaults(ops->options, param);
  if (v != NULL && option_read(option_find(ops->options, v->option), v->value,
                               param, why, sizeof why))
    exit(EXIT_FAILURE);
  must(contact_solver_new(&choice, &s));
  solver_report first = run(b, s);
  solver_report rep = first.cpu < 0.2 ? run(b, s) : first;
  printf("%-16s %dD %5d %4.1f %7.0e %7d %6d %9.6f %9.6f %9.1e %9.1e  %s\n",
         name, b->body.cp.dim, b->body.cp.m, mu, tol, rep.iterations,
         rep.limit_updates, first.cpu, rep.cpu, rep.residual, error_of(b),
         outcome_text(rep.outcome));
  fflush(stdout);
  contact_solver_free(&s);
}

static void lines(block *b, double mu, double tol) {
  for (int i = 0;; ++i) {
    const solver_ops *ops = solver_list[i];
    if (ops == NULL || b->body.cp.dim == 2 || (ops->handles & SOLVES_3D))
      line(b, ops, NULL, mu, tol);
    if (ops == NULL) return;
    for (size_t k = 0; k < sizeof variants / sizeof *variants; ++k)
      if (strcmp(variants[k].solver, ops->name) == 0)
        line(b, ops, &variants[k], mu, tol);
  }
}

static void size(int dim, int m) {
  static const double mus[] = {0.0, 0.3, 0.8}, tols[] = {1e-4, 1e-8, 1e-12};
  block b;
  block_new(&b, dim, m / dim);
  for (int i = 0; i < 3; ++i) {
    pressed_block_friction(&b.body, mus[i]);
    printf("\n# %dD, m = %d, mu = %g, condition of A %.1e\n", dim, b.body.cp.m,
           mus[i], condition_of(&b));
    reference(&b);
    for (int k = 0; k < 3; ++k) lines(&b, mus[i], tols[k]);
  }
  block_free(&b);
}

int main(int argc, char **argv) {
  blas_choose_kernel(argv);
  printf(
      "# %-14s dim     m   mu     tol   iter. passes   CPU s 1 "
      "CPU s 2   residual error of u\n",
      "method");
  for (int i = 1; i < argc; ++i) size(2, atoi(argv[i]));
  if (argc > 1) return EXIT_SUCCESS;
  size(2, 100);
  size(2, 500);
  size(2, 1000);
  size(3, 300);
  return EXIT_SUCCESS;
}
