/*
 * METHOD=AUTO against the solver kernels of Siconos on condensed blocks, one
 * run, one processor, one measure.
 *
 *   peers [-v] [dim nodes]...
 *
 * Every kernel of the library that treats the problem tries it; it is given the
 * coarsest of its own tolerances with which its forces have a residual of
 * contact_residual, in the compliance form, of at most 1e-8, the tolerance of
 * AUTO. Other answers and crashes do not count, nor does what takes HOPELESS
 * times as long as AUTO: a ratio of HOPELESS says that no kernel was as near.
 * Above LARGE nodes only those try that were among the best below. CPU of the
 * solution alone, median of repeated solutions in one child process, options
 * and data ready; AUTO: from nothing to the answer.
 *
 * The kernels need the compliance W, a deck gives the stiffness A. Ratios,
 * above 1: AUTO is faster.
 *   from A  the best kernel and the making of W, over AUTO with A
 *   from W  the best kernel, over AUTO with W: the same data for both
 *   strict  the best kernel without the making of W, over AUTO with A
 * Without friction only the part W_nn is made.
 */
#include "base/base.h"
#include "base/system/blas.h"
#include "fem/fem.h"
#include "peers/kernels.h"
#include "solver/solver.h"
#include "support/pressed_block.h"

#include <FrictionContactProblem.h>
#include <LinearComplementarityProblem.h>
#include <NonSmoothDrivers.h>
#include <NumericsMatrix.h>
#include <cblas.h>
#include <lapacke.h>

enum {
  LARGE = 300,
  MAX_REPEATS = 25,
  MAX_LINES = 1000,
  LADDER = 9,
  N_RATIO = 3
};
static const double TOL = 1e-8, ENOUGH = 1.0; /* -; s of one measurement      */
static const double HOPELESS = 5.0;           /* times slower than AUTO       */

/* clang-format off */
static const struct loading {
  const char *name;
  double side, down;
} loadings[] = {{"open", 0.3, 0.01},
                {"mixed", 0.15, 0.1},
                {"stick", 0.02, 0.1},
                {"graze", 0.15, 0.0},
                {"flat", 0.0, 0.1}};
/* clang-format on */
enum { N_LOAD = sizeof loadings / sizeof *loadings };

static struct peers {
  pressed_block b;
  double mu;
  double *W, *M, *q;     /* compliance; signs of Siconos; W f              */
  double *Mq, *mus;      /* [m], [n] of the problem of Siconos             */
  double *z, *w, *u, *r; /* [m]                                            */
  int verbose;
} peers;

static void must(status st) {
  if (st == OK) return;
  fprintf(stderr, "peers: %s\n", status_message());
  exit(EXIT_FAILURE);
}

static double *numbers(size_t n) {
  double *x = calloc(n + 1, sizeof *x);
  if (x == NULL) abort();
  return x;
}

static int ascending(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* The problem by its compliance. */
static contact_problem by_compliance(void) {
  contact_problem cp = peers.b.cp;
  cp.A = NULL;
  cp.W = peers.W;
  cp.f = peers.q;
  return cp;
}

/* Of the forces r alone, u = W r + q. */
static double residual_of_forces(void) {
  contact_problem cp = by_compliance();
  contact_product(cp.m, cp.W, peers.r, peers.u);
  cblas_daxpy(cp.m, 1.0, cp.f, 1, peers.u, 1);
  return contact_residual(&cp, peers.u, peers.r);
}

/* ---- a measurement ------------------------------------------------------- */

typedef double timed(void *what); /* CPU of one run, s                        */

/* Least of repeated runs: the one other processes disturbed least. */
static double least(timed *run, void *what) {
  double best = HUGE_VAL, sum = 0.0;
  for (int n = 0; n < MAX_REPEATS && (n < 3 || sum < ENOUGH); ++n) {
    double t = run(what);
    sum += t;
    best = fmin(best, t);
    if (sum > 4.0 * ENOUGH) break;
  }
  return best;
}

static double run_auto(void *what) {
  contact_problem cp = *(const int *)what ? by_compliance() : peers.b.cp;
  solver_choice choice = {.tol = TOL};
  solver_report rep;
  contact_solver *s = NULL;
  size_t bytes = (size_t)cp.m * sizeof *peers.u;
  memset(peers.u, 0, bytes);
  memset(peers.r, 0, bytes);
  double start = cpu();
  must(contact_solver_new(&choice, &s));
  must(contact_solve(s, &cp, NULL, peers.u, peers.r, &rep));
  contact_solver_free(&s);
  return rep.outcome == CONVERGED ? cpu() - start : HUGE_VAL;
}

/* W, or W_nn in its first rows, from A; the inverse itself by Cholesky. */
static double run_inverse(void *what) {
  const contact_problem *cp = &peers.b.cp;
  int m = cp->m, n = cp->n, dim = cp->dim, part = *(const int *)what;
  size_t size = (size_t)m, at = part ? size - (size_t)n : 0;
  double *L = numbers(size * size), start = cpu();
  for (size_t j = 0; j < size; ++j) {
    size_t from = !part    ? j
                  : j < at ? j / (size_t)(dim - 1) * (size_t)dim + 1 +
                                 j % (size_t)(dim - 1)
                           : (j - at) * (size_t)dim;
    const double *column = cp->A + size * from;
    for (size_t i = j; i < size; ++i) {
      size_t row = !part    ? i
                   : i < at ? i / (size_t)(dim - 1) * (size_t)dim + 1 +
                                  i % (size_t)(dim - 1)
                            : (i - at) * (size_t)dim;
      L[i + size * j] = column[row];
    }
  }
  LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', m, L, m);
  int last = m - (int)at;
  double *corner = L + at * (size + 1);
  LAPACKE_dpotri_work(LAPACK_COL_MAJOR, 'L', last, corner, m);
  for (int j = 0; j < last; ++j)
    for (int i = 0; i < j; ++i)
      corner[(size_t)i + size * (size_t)j] =
          corner[(size_t)j + size * (size_t)i];
  start = cpu() - start;
  free(L);
  return start;
}

/* ---- kernels ------------------------------------------------------------- */

typedef struct kernel_run {
  const struct kernel *k;
  double tol; /* of its own measure                                          */
} kernel_run;

/* u_t of the normal forces: part of the answer that an LCP leaves out. */
static void displace_tangents(void) {
  const contact_problem *cp = &peers.b.cp;
  for (int k = 1; k < cp->dim; ++k)
    cblas_dgemv(CblasColMajor, CblasTrans, cp->n, cp->n, -1.0,
                peers.W + (size_t)cp->m * (size_t)k, cp->m * cp->dim, peers.z,
                cp->dim, 0.0, peers.w + k, cp->dim);
}

static double run_lcp(const kernel_run *c, double *M) {
  int n = peers.b.cp.n, dim = peers.b.cp.dim;
  size_t m = (size_t)peers.b.cp.m;
  double *q = numbers((size_t)n), *z = numbers((size_t)n),
         *w = numbers((size_t)n);
  for (int j = 0; j < n; ++j) {
    q[j] = peers.Mq[j * dim];
    for (int i = 0; i < n; ++i)
      M[(size_t)i + (size_t)n * (size_t)j] =
          peers.M[(size_t)(i * dim) + m * (size_t)(j * dim)];
  }
  LinearComplementarityProblem p = {
      .size = n, .M = NM_create_from_data(NM_DENSE, n, n, M), .q = q};
  SolverOptions *o = kernel_options(c->k, c->tol);
  double start = cpu();
  linearComplementarity_driver(&p, z, w, o);
  memset(peers.z, 0, m * sizeof *peers.z);
  for (int i = 0; i < n; ++i) peers.z[i * dim] = z[i];
  displace_tangents();
  start = cpu() - start;
  free(q);
  free(z);
  free(w);
  solver_options_delete(o);
  return start;
}

static double run_friction(const kernel_run *c, double *M) {
  const contact_problem *cp = &peers.b.cp;
  size_t m = (size_t)cp->m;
  memcpy(M, peers.M, m * m * sizeof *M);
  memset(peers.z, 0, m * sizeof *peers.z);
  memset(peers.w, 0, m * sizeof *peers.w);
  FrictionContactProblem p = {
      .dimension = cp->dim,
      .numberOfContacts = cp->n,
      .M = NM_create_from_data(NM_DENSE, cp->m, cp->m, M),
      .q = peers.Mq,
      .mu = peers.mus};
  SolverOptions *o = kernel_options(c->k, c->tol);
  double start = cpu();
  if (cp->dim == 2)
    fc2d_driver(&p, peers.z, peers.w, o);
  else
    fc3d_driver(&p, peers.z, peers.w, o);
  start = cpu() - start;
  solver_options_delete(o);
  return start;
}

/* The matrix is a fresh copy each time: kernels may overwrite it. */
static double run_kernel(void *what) {
  const kernel_run *c = what;
  size_t m = (size_t)peers.b.cp.m;
  double *M = numbers(m * m);
  double t = c->k->kind == LCP ? run_lcp(c, M) : run_friction(c, M);
  free(M);
  for (int i = 0; i < peers.b.cp.m; ++i)
    peers.r[i] = i % peers.b.cp.dim ? peers.z[i] : -peers.z[i];
  return t;
}

/* The cheapest tolerance that does; in the child. */
static result try_kernel(const struct kernel *k, double most) {
  result a = {HUGE_VAL, HUGE_VAL};
  kernel_run c = {k, 1e-5};
  double spent = 0.0;
  for (int i = 0; i < LADDER && spent < 3.0 * most; ++i, c.tol *= 0.1) {
    double t = run_kernel(&c);
    spent += t;
    a.measure = residual_of_forces();
    if (!(a.measure <= TOL)) continue;
    a.cpu = t < most ? least(run_kernel, &c) : t;
    break;
  }
  return a;
}

static int treats(const struct kernel *k) {
  if (peers.b.cp.n > LARGE && !k->large) return 0;
  if (peers.mu == 0.0) return k->kind == LCP;
  return k->kind == (peers.b.cp.dim == 2 ? PLANE : SOLID);
}

/* ---- table --------------------------------------------------------------- */

static struct line {
  int dim, n;
  double ratio[N_RATIO];
} lines[MAX_LINES];
static int n_line;

static result fastest(double own, const char **name) {
  result best = {HUGE_VAL, HUGE_VAL};
  *name = "-";
  for (size_t i = 0; i < sizeof kernels / sizeof *kernels; ++i) {
    if (!treats(&kernels[i])) continue;
    double most = fmin(HOPELESS * own, 2.0 * best.cpu);
    result a = kernel_apart(try_kernel, &kernels[i], most);
    if (peers.verbose)
      fprintf(stderr, "    %-8s %10.6f %8.1e\n", kernels[i].name, a.cpu,
              a.measure);
    if (!(a.cpu < best.cpu)) continue;
    best = a;
    *name = kernels[i].name;
  }
  return best;
}

static void print_line(const struct loading *l) {
  int from_A = 0, from_W = 1, part = peers.mu == 0.0;
  const char *name;
  double own_a = least(run_auto, &from_A), own_w = least(run_auto, &from_W),
         inverse = least(run_inverse, &part);
  double mine = residual_of_forces();
  result best = fastest(fmax(own_a, own_w), &name);
  own_a = fmin(own_a, least(run_auto, &from_A)); /* the machine changes    */
  own_w = fmin(own_w, least(run_auto, &from_W));
  struct line *at = &lines[n_line < MAX_LINES - 1 ? n_line++ : n_line];
  *at = (struct line){
      peers.b.cp.dim,
      peers.b.cp.n,
      {fmin((best.cpu + inverse) / own_a, HOPELESS),
       fmin(best.cpu / own_w, HOPELESS), fmin(best.cpu / own_a, HOPELESS)}};
  printf(
      "%dD %5d %4.1f %-6s %9.6f %9.6f %8.1e %9.6f %-8s %9.6f %8.1e "
      "%7.2f %7.2f %7.2f\n",
      at->dim, at->n, peers.mu, l->name, own_a, own_w, mine, inverse, name,
      best.cpu, best.measure, at->ratio[0], at->ratio[1], at->ratio[2]);
  fflush(stdout);
}

/* Lowest, middle, highest of one ratio over the lines of a size. */
static void summarise(void) {
  static const char *const names[N_RATIO] = {"from A", "from W", "strict"};
  double x[MAX_LINES];
  printf("\n# ratio  dim n     cases    worst   median     best\n");
  for (int k = 0; k < N_RATIO; ++k)
    for (int i = 0; i < n_line; ++i) {
      size_t n = 0;
      if (i > 0 && lines[i].dim == lines[i - 1].dim &&
          lines[i].n == lines[i - 1].n)
        continue;
      for (int j = i; j < n_line; ++j)
        if (lines[j].dim == lines[i].dim && lines[j].n == lines[i].n)
          x[n++] = lines[j].ratio[k];
      qsort(x, n, sizeof *x, ascending);
      printf("%-8s %dD %5d %5zu %8.2f %8.2f %8.2f\n", names[k], lines[i].dim,
             lines[i].n, n, x[0], x[n / 2], x[n - 1]);
    }
}

/* ---- problems ------------------------------------------------------------ */

static void block_new(int dim, int nodes) {
  pressed_block *b = &peers.b;
  pressed_block_new(b, dim, nodes, dim == 2 ? 128 : 8);
  size_t m = (size_t)b->cp.m;
  peers.W = numbers(m * m);
  peers.M = numbers(m * m);
  peers.mus = numbers((size_t)b->cp.n);
  double **const arrays[] = {&peers.q, &peers.Mq, &peers.z,
                             &peers.w, &peers.u,  &peers.r};
  for (int i = 0; i < 6; ++i) *arrays[i] = numbers(m);
  memcpy(peers.W, b->cp.A, m * m * sizeof *peers.W);
  LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', b->cp.m, peers.W, b->cp.m);
  LAPACKE_dpotri(LAPACK_COL_MAJOR, 'L', b->cp.m, peers.W, b->cp.m);
  size_t d = (size_t)dim;
  for (size_t j = 0; j < m; ++j)
    for (size_t i = 0; i < m; ++i) {
      if (i < j) peers.W[i + m * j] = peers.W[j + m * i];
      int same = (i % d == 0) == (j % d == 0);
      double entry = i < j ? peers.W[j + m * i] : peers.W[i + m * j];
      peers.M[i + m * j] = same ? entry : -entry;
    }
}

static void block_free(void) {
  double *const arrays[] = {peers.W, peers.M, peers.q, peers.Mq, peers.mus,
                            peers.z, peers.w, peers.u, peers.r};
  for (size_t i = 0; i < sizeof arrays / sizeof *arrays; ++i) free(arrays[i]);
  pressed_block_free(&peers.b);
}

static void size(int dim, int nodes) {
  static const double mus[] = {0.0, 0.1, 0.3, 1.0};
  block_new(dim, nodes);
  const contact_problem *cp = &peers.b.cp;
  for (int i = 0; i < 4; ++i)
    for (int k = 0; k < N_LOAD; ++k) {
      peers.mu = mus[i];
      pressed_block_friction(&peers.b, peers.mu);
      pressed_block_load(&peers.b, loadings[k].side, loadings[k].down);
      contact_product(cp->m, peers.W, cp->f, peers.q);
      for (int j = 0; j < cp->m; ++j)
        peers.Mq[j] = j % dim ? peers.q[j] : -peers.q[j];
      for (int j = 0; j < cp->n; ++j) peers.mus[j] = peers.mu;
      print_line(&loadings[k]);
    }
  block_free();
}

int main(int argc, char **argv) {
  static const int sizes[][2] = {{2, 64},   {2, 128},  {2, 256}, {2, 512},
                                 {2, 1000}, {2, 2000}, {3, 64},  {3, 121},
                                 {3, 256},  {3, 529},  {3, 1024}};
  int at = 1;
  blas_choose_kernel(argv);
  if (argc > at && strcmp(argv[at], "-v") == 0) peers.verbose = at++;
  printf(
      "# CPU s at a residual of %g; ratios above 1: AUTO is faster\n"
      "# dim n   mu load    AUTO(A)   AUTO(W) residual W from A  best kernel"
      "        residual  from A  from W  strict\n",
      TOL);
  if (at + 1 < argc) {
    for (; at + 1 < argc; at += 2) size(atoi(argv[at]), atoi(argv[at + 1]));
  } else {
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; ++i)
      size(sizes[i][0], sizes[i][1]);
  }
  summarise();
  return EXIT_SUCCESS;
}
