/*
 * METHOD=AUTO against the kernels of Siconos on problems from FCLIB files, one
 * run, one processor, one measure.
 *
 *   files [-v] FILE...
 *
 * The compliance is given to the kernels by blocks where most of it is zero.
 * Each is given the coarsest of its own tolerances with which the natural map
 * of its forces is at most 1e-8, the tolerance of AUTO, whose own may be up to
 * ten times that. CPU of the solution alone, least of repeated ones in a
 * process of its own. At the end the geometric mean of AUTO over the best
 * kernel, of all and of those where the kernel takes 0.1 ms or more.
 */
#include "base/base.h"
#include "base/sparse.h"
#include "base/system/blas.h"
#include "exchange/exchange.h"
#include "peers/kernels.h"
#include "solver/solver.h"
#include "support/natural_map.h"

#include <FrictionContactProblem.h>
#include <NonSmoothDrivers.h>
#include <NumericsMatrix.h>
#include <SparseBlockMatrix.h>

enum { LADDER = 9, MAX_REPEATS = 200 };
static const double TOL = 1e-8, ENOUGH = 0.2, SHORT = 1e-4; /* -; s; s */
static const double HOPELESS = 5.0; /* times slower than AUTO */

static struct peers {
  FrictionContactProblem p;
  const contact_problem *cp;
  NumericsMatrix *blocks, *whole; /* blocks NULL: most of it is not zero */
  double *z, *w, *u, *r;          /* [m] */
  int verbose;
} peers;

static void must(status st) {
  if (st == OK) return;
  fprintf(stderr, "files: %s\n", status_message());
  exit(EXIT_FAILURE);
}

static double *numbers(int n) {
  double *x = calloc((size_t)n + 1, sizeof *x);
  if (x == NULL) abort();
  return x;
}

/* Normal forces push the other way there. */
static double sign(int dim, int i, int j) {
  return (i % dim == 0) == (j % dim == 0) ? 1.0 : -1.0;
}

static NumericsMatrix *dense_matrix(const contact_problem *cp) {
  double *M = numbers(cp->m * cp->m);
  if (cp->blocks != NULL)
    sparse_blocks_dense(cp->blocks, M);
  else
    memcpy(M, cp->W, sizeof *M * (size_t)cp->m * (size_t)cp->m);
  for (int j = 0; j < cp->m; ++j)
    for (int i = 0; i < cp->m; ++i) M[i + cp->m * j] *= sign(cp->dim, i, j);
  return NM_create_from_data(NM_DENSE, cp->m, cp->m, M);
}

/* Of the kernel: those of the plane, and of whole systems, have no blocks. */
static NumericsMatrix *matrix_of(const struct kernel *k) {
  const int sweeps = k->kind == SOLID && k->id != SICONOS_FRICTION_3D_ADMM;
  return peers.blocks != NULL && sweeps ? peers.blocks : peers.whole;
}

/* By rows of blocks: those of the columns, across the diagonal. */
static NumericsMatrix *block_matrix(const sparse_blocks *b) {
  int size = b->dim * b->dim, n = b->start[b->n];
  SparseBlockStructuredMatrix *s = SBM_new();
  double *values = numbers(n * size);
  s->nbblocks = (unsigned)n;
  s->blocknumber0 = s->blocknumber1 = (unsigned)b->n;
  s->filled1 = (size_t)b->n + 1;
  s->filled2 = (size_t)n;
  s->block = calloc((size_t)n, sizeof *s->block);
  s->blocksize0 = calloc((size_t)b->n, sizeof *s->blocksize0);
  s->blocksize1 = s->blocksize0;
  s->index1_data = calloc((size_t)b->n + 1, sizeof *s->index1_data);
  s->index2_data = calloc((size_t)n, sizeof *s->index2_data);
  s->diagonal_blocks = calloc((size_t)b->n, sizeof *s->diagonal_blocks);
  for (int i = 0; i < b->n; ++i) {
    s->blocksize0[i] = (unsigned)(b->dim * (i + 1));
    s->diagonal_blocks[i] = (unsigned)b->own[i];
    s->index1_data[i + 1] = (size_t)b->start[i + 1];
    for (int p = b->start[i]; p < b->start[i + 1]; ++p) {
      s->index2_data[p] = (size_t)b->row[p];
      s->block[p] = values + p * size;
      for (int k = 0; k < size; ++k)
        s->block[p][k] = sign(b->dim, k % b->dim, k / b->dim) *
                         b->val[b->mate[p] * size + k];
    }
  }
  return NM_create_from_data(NM_SPARSE_BLOCK, b->dim * b->n, b->dim * b->n, s);
}

static void hand_over(const contact_problem *cp) {
  peers.cp = cp;
  peers.p = (FrictionContactProblem){.dimension = cp->dim,
                                     .numberOfContacts = cp->n,
                                     .q = numbers(cp->m),
                                     .mu = numbers(cp->n)};
  peers.blocks = cp->blocks != NULL ? block_matrix(cp->blocks) : NULL;
  peers.whole = dense_matrix(cp);
  for (int i = 0; i < cp->m; ++i)
    peers.p.q[i] =
        i % cp->dim
            ? cp->f[i] - (cp->ut0 != NULL ? cp->ut0[i - i / cp->dim - 1] : 0.0)
            : cp->gap[i / cp->dim] - cp->f[i];
  for (int i = 0; cp->B != NULL && i < cp->n; ++i)
    peers.p.mu[i] = cp->B->val[i];
  double **const arrays[] = {&peers.z, &peers.w, &peers.u, &peers.r};
  for (int i = 0; i < 4; ++i) *arrays[i] = numbers(cp->m);
}

static double run_auto(const struct kernel *k, double tol) {
  solver_choice choice = {.tol = tol};
  solver_report rep;
  contact_solver *s = NULL;
  const contact_problem *cp = peers.cp;
  memset(peers.r, 0, (size_t)cp->m * sizeof *peers.r);
  memcpy(peers.u, cp->f, (size_t)cp->m * sizeof *peers.u);
  double start = cpu();
  must(contact_solver_new(&choice, &s));
  must(contact_solve(s, cp, NULL, peers.u, peers.r, &rep));
  contact_solver_free(&s);
  return cpu() - start;
}

static double run_kernel(const struct kernel *k, double tol) {
  const contact_problem *cp = peers.cp;
  size_t bytes = (size_t)cp->m * sizeof *peers.z;
  SolverOptions *o = kernel_options(k, tol);
  peers.p.M = matrix_of(k);
  memset(peers.z, 0, bytes);
  memcpy(peers.w, peers.p.q, bytes);
  double start = cpu();
  if (cp->dim == 2)
    fc2d_driver(&peers.p, peers.z, peers.w, o);
  else
    fc3d_driver(&peers.p, peers.z, peers.w, o);
  start = cpu() - start;
  solver_options_delete(o);
  for (int i = 0; i < cp->m; ++i)
    peers.r[i] = i % cp->dim ? peers.z[i] : -peers.z[i];
  return start;
}

typedef double timed(const struct kernel *k, double tol); /* CPU, s */

static double least(timed *run, const struct kernel *k, double tol) {
  double best = HUGE_VAL, sum = 0.0;
  for (int n = 0; n < MAX_REPEATS && (n < 3 || sum < ENOUGH); ++n) {
    double t = run(k, tol);
    sum += t;
    best = fmin(best, t);
  }
  return best;
}

static result try_kernel(const struct kernel *k, double most) {
  result a = {HUGE_VAL, HUGE_VAL};
  double spent = 0.0, tol = 1e-4;
  for (int i = 0; i < LADDER && spent < 3.0 * most; ++i, tol *= 0.1) {
    spent += run_kernel(k, tol);
    a.measure = natural_map(peers.cp, peers.u, peers.r);
    if (!(a.measure <= TOL)) continue;
    a.cpu = least(run_kernel, k, tol);
    break;
  }
  return a;
}

static struct sum {
  double logs;
  int n, above;
} all, longer;

static void count(struct sum *s, double ratio) {
  s->logs += log(ratio);
  s->above += ratio > 2.0;
  ++s->n;
}

static void line(const char *name) {
  const contact_problem *cp = peers.cp;
  double own = least(run_auto, NULL, TOL);
  double map = natural_map(cp, peers.u, peers.r);
  result best = {HUGE_VAL, HUGE_VAL};
  const char *who = "-";
  for (int i = 0; i < N_KERNEL; ++i) {
    if (kernels[i].kind != (cp->dim == 2 ? PLANE : SOLID)) continue;
    result a = kernel_apart(try_kernel, &kernels[i],
                            fmin(HOPELESS * own, 2.0 * best.cpu));
    if (peers.verbose)
      printf("    %-8s %10.6f %8.1e\n", kernels[i].name, a.cpu, a.measure);
    if (!(a.cpu < best.cpu)) continue;
    best = a;
    who = kernels[i].name;
  }
  printf("%-40.40s %dD %5d %10.6f %8.1e  %-8s %10.6f %8.1e %7.2f\n", name,
         cp->dim, cp->n, own, map, who, best.cpu, best.measure, own / best.cpu);
  fflush(stdout);
  if (!(map <= 10.0 * TOL) || !(best.cpu < HUGE_VAL)) return;
  count(&all, own / best.cpu);
  if (best.cpu >= SHORT) count(&longer, own / best.cpu);
}

static void file(const char *path) {
  exchange_problem *p = NULL;
  message_log *log = NULL;
  const char *at = strrchr(path, '/');
  must(message_log_new(&log));
  if (exchange_read(path, EXCHANGE_FCLIB, NULL, log, &p) != OK)
    printf("%s: not read: %s\n", path, status_message());
  else if (p->n > 0 && !contact_has_stiffness(&p->cp)) {
    hand_over(&p->cp);
    line(at == NULL ? path : at + 1);
  }
  memory_free(p);
  memory_free(log);
}

static void tell(const char *what, const struct sum *s) {
  if (s->n > 0)
    printf("# AUTO over the best kernel, %s: %.2f (%d problems, %d above 2)\n",
           what, exp(s->logs / s->n), s->n, s->above);
}

int main(int argc, char **argv) {
  int at = 1;
  blas_choose_kernel(argv);
  if (argc > at && strcmp(argv[at], "-v") == 0) peers.verbose = at++;
  printf("# CPU s, natural map at most %g\n# %-43s %-5s %10s %8s  %-8s\n", TOL,
         "problem", "n", "AUTO", "map", "kernel");
  for (; at < argc; ++at) file(argv[at]);
  tell("all", &all);
  tell("0.1 ms or more", &longer);
  return EXIT_SUCCESS;
}
