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
#include "base/timer.h"
#include "fem/fem.h"
#include "solver/solver.h"
#include "support/scene.h"

#include <lapacke.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PARAM_SIZE = 512 };
static const double FREE_SIDE = 0.15; /* pressure that pushes over E */

/* A row with an option other than its default. */
static const struct variant {
  const char *solver, *option, *value;
} variants[] = {{"aitken", "ACCELERATION", "ANDERSON"},
                {"pcg", "PRECONDITIONER", "DIAGONAL"},
                {"auglag", "VARIANT", "UZAWA"}};

typedef struct block {
  scene *s;
  stiffness *k;
  condensed *c;
  double *F, *ud, *f, *zero, *u, *r, *exact;
  sparse_rows B;
  contact_problem cp;
} block;

static void must(status st) {
  if (st == OK) return;
  fprintf(stderr, "solvers: %s\n", status_message());
  exit(EXIT_FAILURE);
}

static double *numbers(int n) { return calloc((size_t)n + 1, sizeof(double)); }

/* Pressure on LEFT along x, and the top moved down, both about E/1000. */
static void load(block *b) {
  const mesh *m = b->s->m;
  for (int g = 0; g < m->n_group; ++g) {
    const mesh_group *group = &m->group[g];
    for (int i = 0; i < group->n_item && !strcmp(group->name, "LEFT"); ++i) {
      int face_id = group->item_id[i];
      double share = 1.0 / group->n_item / m->dim; /* the side measures 1 */
      for (int k = 0; k < m->dim; ++k)
        b->F[m->dim * m->face[m->dim * face_id + k]] += FREE_SIDE * share;
    }
    int down = m->dim - 1;
    const char *top = m->dim == 2 ? "TOP" : "BACK";
    for (int i = 0; i < group->n_node && !strcmp(group->name, top); ++i)
      b->ud[m->dim * group->node_id[i] + down] = -0.1;
  }
}

static void block_new(block *b, int dim, int nodes) {
  memset(b, 0, sizeof *b);
  if (dim == 2) {
    int cells[2] = {nodes - 1, nodes - 1};
    b->s = scene_new(make_grid_2d(cells, (double[]){1, 1}), PLANE_STRAIN, 1);
    scene_contact(b->s, "BOTTOM", (double[]){0, -1}, 0);
  } else {
    int side = (int)lround(sqrt(nodes)) - 1, cells[3] = {side, side, side};
    b->s = scene_new(make_grid_3d(cells, (double[]){1, 1, 1}), SOLID_3D, 1);
    scene_contact(b->s, "FRONT", (double[]){0, 0, -1}, 0);
  }
  for (int i = 0; i < dim; ++i) scene_fix(b->s, dim == 2 ? "TOP" : "BACK", i);
  must(stiffness_assemble(&b->s->d, &b->k));
  must(condense(b->k, &b->s->d, &b->c));
  int n = b->s->surface.n, m = dim * n, all = dim * b->s->m->n_node;
  b->F = numbers(all);
  b->ud = numbers(all);
  b->f = numbers(m);
  b->zero = numbers(m);
  b->u = numbers(m);
  b->r = numbers(m);
  b->exact = numbers(m);
  load(b);
  must(condense_load(b->c, b->F, b->ud, b->f));
  b->B = (sparse_rows){n, calloc((size_t)n + 1, sizeof(int)),
                       calloc((size_t)n, sizeof(int)), numbers(n)};
  for (int i = 0; i < n; ++i) {
    b->B.start[i + 1] = i + 1;
    b->B.col[i] = i;
  }
  b->cp = (contact_problem){.dim = dim,
                            .n = n,
                            .m = m,
                            .A = condensed_matrix(b->c),
                            .f = b->f,
                            .gap = b->zero};
}

static void block_friction(block *b, double mu) {
  for (int i = 0; i < b->cp.n; ++i) b->B.val[i] = mu;
  b->cp.ut0 = b->cp.g0 = mu > 0.0 ? b->zero : NULL;
  b->cp.B = mu > 0.0 ? &b->B : NULL;
}

static void block_free(block *b) {
  condensed_free(b->c);
  stiffness_free(b->k);
  scene_free(b->s);
  free(b->F);
  free(b->ud);
  free(b->f);
  free(b->zero);
  free(b->u);
  free(b->r);
  free(b->exact);
  free(b->B.start);
  free(b->B.col);
  free(b->B.val);
}

/* Condition of A in the 1-norm. */
static double condition_of(const block *b) {
  int m = b->cp.m;
  double *L = numbers(m * m), rcond = 0.0;
  memcpy(L, b->cp.A, (size_t)m * (size_t)m * sizeof *L);
  double norm = LAPACKE_dlansy(LAPACK_COL_MAJOR, '1', 'L', m, L, m);
  if (LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', m, L, m) == 0)
    LAPACKE_dpocon(LAPACK_COL_MAJOR, 'L', m, L, m, norm, &rcond);
  free(L);
  return 1.0 / rcond;
}

static double error_of(const block *b) {
  double size = 0.0, apart = 0.0;
  for (int i = 0; i < b->cp.m; ++i) {
    size = fmax(size, fabs(b->exact[i]));
    apart = fmax(apart, fabs(b->u[i] - b->exact[i]));
  }
  return size > 0.0 ? apart / size : apart;
}

static solver_report run(block *b, contact_solver *s) {
  solver_report rep;
  memset(b->u, 0, (size_t)b->cp.m * sizeof *b->u);
  memset(b->r, 0, (size_t)b->cp.m * sizeof *b->r);
  must(contact_solve(s, &b->cp, NULL, b->u, b->r, &rep));
  return rep;
}

static void print_states(const block *b) {
  contact_status *state = calloc((size_t)b->cp.n, sizeof *state);
  int count[3] = {0, 0, 0};
  contact_classify(&b->cp, b->exact, b->r, state);
  for (int i = 0; i < b->cp.n; ++i) ++count[state[i]];
  printf("# open %d, slip %d, stick %d nodes\n", count[CONTACT_OPEN],
         count[CONTACT_SLIP], count[CONTACT_STICK]);
  free(state);
}

static void reference(block *b) {
  solver_choice choice = {.tol = 1e-13};
  contact_solver *s = NULL;
  must(contact_solver_new(&choice, &s));
  solver_report rep = run(b, s);
  memcpy(b->exact, b->u, (size_t)b->cp.m * sizeof *b->u);
  print_states(b);
  if (rep.outcome != CONVERGED)
    printf("# reference: residual %.1e only\n", rep.residual);
  contact_solver_free(s);
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
  printf("%-16s %dD %5d %4.1f %7.0e %7d %6d %9.4f %9.4f %9.1e %9.1e  %s\n",
         name, b->cp.dim, b->cp.m, mu, tol, rep.iterations, rep.limit_updates,
         first.cpu, rep.cpu, rep.residual, error_of(b),
         outcome_text(rep.outcome));
  fflush(stdout);
  contact_solver_free(s);
}

static void lines(block *b, double mu, double tol) {
  for (int i = 0;; ++i) {
    const solver_ops *ops = solver_list[i];
    if (ops == NULL || b->cp.dim == 2 || (ops->handles & SOLVES_3D))
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
    block_friction(&b, mus[i]);
    printf("\n# %dD, m = %d, mu = %g, condition of A %.1e\n", dim, b.cp.m,
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
