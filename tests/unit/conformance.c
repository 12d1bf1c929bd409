/*
 * Every row of the solver table, and AUTO, on the same problems, their
 * stiffness given by its entries and, to the rows that need no more, by its
 * products and solves: 150 of them, of 1 to 150 nodes
 * (PROTIS_PROBLEMS: another number, of 1 to 300; PROTIS_SEED: another thousand)
 * in two and three dimensions, friction from 0 to 2, a part of them
 * degenerate. Whoever claims an answer must have one by a check of its own;
 * small plane problems are answered by trying all states of all nodes. Problems
 * of many bodies, with a sparse compliance that may be singular or badly
 * scaled, have a planted answer and a natural map of their own.
 */
#include "support/operated_case.h"
#include "support/planted.h"
#include "support/points.h"
#include "support/solver_rows.h"
#include "support/state_list.h"
#include "support/unit.h"

#include <lapacke.h>

static const double TOL = 1e-11; /* asked of the rows                     */
static const double TOL_SOFT = 1e-10; /* by an inverse for some of them */
static const double TOL_WEAK = 1e-8; /* nearly singular                       */
static const double CLAIM = 100.0;   /* violation of a claim, of that         */
static const double AGREE = 1e-8; /* answers of two rows, of the largest u  */
enum {
  MOST_ROWS = 16,
  SLICES = 4,
  SMALL = 30 /* nodes, by products         */
};

static int asked(const char *name, int otherwise) {
  const char *text = getenv(name);
  int n = text == NULL ? 0 : atoi(text);
  return n > 0 ? n : otherwise;
}

/* ---- the problems ---------------------------------------------------------
 */

typedef enum {
  USUAL,
  MIXED,    /* sliding limit partly given, partly from neighbours             */
  TOUCHING, /* half of the nodes touch without force                          */
  TIED,     /* all nodes alike                                                */
  SOFT,     /* compliance alone given                                         */
  WEAK,     /* nearly singular: condition 1e8 and more                        */
  VARIANTS
} variant;

typedef struct problem {
  contact_case c;
  variant kind;
  double mu;
  double *W, *q; /* of SOFT                                                   */
} problem;

/* Mostly small, one in a hundred large. */
static int size_of(int k) {
  if (k % 100 == 50) return k % 200 > 50 ? 100 : unit_whole() ? 300 : 80;
  if (k % 20 == 7) return 20 + (k * 13) % 50;
  return 1 + (k * 7) % 12;
}

static void mix_limits(problem *p, unsigned long long *seed) {
  contact_case *c = &p->c;
  for (int i = 0; i < c->cp.n && c->cp.g0 != NULL; ++i) {
    c->g0[i] = 0.3 * floor(2.0 * case_random(seed));
    c->B->col[i] = (i + 1) % c->cp.n;
  }
}

/* f += A u - f at half of the nodes, u_n = gap: their force is zero. */
static void let_touch(problem *p, unsigned long long *seed) {
  contact_case *c = &p->c;
  int d = c->cp.dim, m = c->cp.m;
  FREED double *u = calloc((size_t)m, sizeof *u);
  for (int j = 0; j < m; ++j) {
    double less = j / d % 2 == 0 ? 0.0 : 0.2;
    u[j] = j % d == 0 ? c->gap[j / d] - less : case_random(seed) - 0.5;
  }
  contact_product(m, c->A, u, c->f);
}

static void tie(problem *p) {
  contact_case *c = &p->c;
  int m = c->cp.m;
  for (int i = 0; i < m; ++i) {
    c->f[i] = i % c->cp.dim == 0 ? 1.0 : 0.25;
    if (i % c->cp.dim == 0) c->gap[i / c->cp.dim] = 0.0;
    for (int j = 0; j < m; ++j) c->A[i + m * j] = i == j ? 2.0 : 0.5 / m;
  }
  memset(c->ut0, 0, (size_t)(m - c->cp.n) * sizeof *c->ut0);
}

/* A = G G' of half the rank plus very little. */
static void weaken(problem *p, unsigned long long *seed) {
  contact_case *c = &p->c;
  int m = c->cp.m, rank = m / 2 + 1;
  ck_assert_int_gt(m, 0);
  FREED double *G = calloc((size_t)(m * rank), sizeof *G);
  for (int i = 0; i < m * rank; ++i) G[i] = case_random(seed) - 0.5;
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < m; ++j) {
      double sum = i == j ? 1e-8 : 0.0;
      for (int k = 0; k < rank; ++k) sum += G[i + m * k] * G[j + m * k];
      c->A[i + m * j] = sum;
    }
  /* a load that moves are not infinite under: A times something */
  FREED double *u = calloc((size_t)m, sizeof *u);
  for (int i = 0; i < m; ++i) u[i] = case_random(seed) - 0.3;
  contact_product(m, c->A, u, c->f);
}

static void give_compliance(problem *p) {
  contact_case *c = &p->c;
  int m = c->cp.m;
  p->W = calloc((size_t)m * (size_t)m, sizeof *p->W);
  p->q = calloc((size_t)m, sizeof *p->q);
  ck_assert(case_inverse(m, c->A, p->W));
  contact_product(m, p->W, c->f, p->q);
  c->cp.W = p->W;
  c->cp.A = NULL;
  c->cp.f = p->q;
}

static problem make(int k) {
  unsigned long long number =
      (unsigned)k + 1000003u * (unsigned long long)asked("PROTIS_SEED", 0);
  static const double mus[] = {0.0, 0.05, 0.1, 0.3, 0.5, 1.0, 2.0};
  static const variant kinds[] = {USUAL, MIXED, USUAL, TOUCHING, USUAL,
                                  TIED,  SOFT,  WEAK,  USUAL,    MIXED,
                                  USUAL, SOFT,  USUAL, TIED,     USUAL};
  unsigned long long seed = 2685821657736338717u * (number + 1u);
  int n = size_of(k);
  problem p = {.kind = n > 90 ? USUAL : kinds[k / 2 % 15],
               .mu = mus[k / 3 % 7]};
  p.c = case_any(2 + (k + k / 10) % 2, n, p.mu, k / 5 % 2, number);
  if (p.kind == MIXED) mix_limits(&p, &seed);
  if (p.kind == TOUCHING) let_touch(&p, &seed);
  if (p.kind == TIED) tie(&p);
  if (p.kind == WEAK) weaken(&p, &seed);
  if (p.kind == SOFT) give_compliance(&p);
  return p;
}

static void unmake(problem *p) {
  free(p->W);
  free(p->q);
  case_free(&p->c);
}

/* mu with which the fixed point on the sliding limit contracts: |dp| <=
 * sqrt(largest/least eigenvalue) |dg|. 0: not worked out. */
static double guaranteed_mu(const contact_case *c) {
  int m = c->cp.m;
  if (m > 40) return 0.0;
  double V[1600], e[40] = {0.0};
  memcpy(V, c->A, sizeof *V * (size_t)(m * m));
  ck_assert_int_eq(LAPACKE_dsyev(LAPACK_COL_MAJOR, 'N', 'L', m, V, m, e), 0);
  return e[0] > 0.0 ? sqrt(e[0] / e[m - 1]) : 0.0;
}

/* ---- all rows -------------------------------------------------------------
 */

/* Difference over the size of the displacements, or of what the load would
 * make of them without the other nodes. */
static double apart(const contact_case *c, const double *u, const double *v) {
  double size = 0.0, most = 0.0;
  int m = c->cp.m;
  for (int j = 0; j < m; ++j) {
    size = fmax(size, fmax(fabs(u[j]), fabs(c->f[j]) / c->A[j + m * j]));
    most = fmax(most, fabs(u[j] - v[j]));
  }
  return most > 0.0 ? most / size : 0.0;
}

/* In other units the row does bit by bit the same. */
static void same_in_units(const solver_ops *ops, int k, problem *p, double tol,
                          const solver_report *rep) {
  static const int powers[][2] = {{-90, 170}, {80, -210}};
  const int length = powers[k / 4 % 2][0], force = powers[k / 4 % 2][1];
  const contact_case *c = &p->c;
  const size_t size = (size_t)c->cp.m * sizeof *c->u;
  FREED double *answer = malloc(2 * size);
  memcpy(answer, c->u, size);
  memcpy(answer + c->cp.m, c->r, size);
  case_units(&p->c, length, force);
  case_cold(&p->c);
  solver_report other = solve_by(ops, c, tol, c->u, c->r);
  case_units(&p->c, -length, -force);
  ck_assert_msg(other.outcome == rep->outcome &&
                    other.iterations == rep->iterations &&
                    memcmp(answer, c->u, size) == 0 &&
                    memcmp(answer + c->cp.m, c->r, size) == 0,
                "%s: problem %d in other units", row_name(ops), k);
}

/* 1: solved, and the claim holds. */
static int claims(const solver_ops *ops, int k, problem *p) {
  contact_case *c = &p->c;
  double tol = p->kind == WEAK ? TOL_WEAK : p->kind == SOFT ? TOL_SOFT : TOL;
  case_cold(c);
  solver_report rep = solve_by(ops, c, tol, c->u, c->r);
  ck_assert_msg(rep.outcome == CONVERGED || rep.outcome < 0, "%s: problem %d",
                row_name(ops), k);
  if (k % 4 == 0 && c->cp.op == NULL) same_in_units(ops, k, p, tol, &rep);
  double residual = contact_residual(&c->cp, c->u, c->r);
  ck_assert(rep.residual == residual || (isnan(residual) && rep.outcome < 0));
  if (rep.outcome != CONVERGED) return 0;
  ck_assert_msg(residual <= tol, "%s: problem %d", row_name(ops), k);
  const double *f = c->cp.f;
  c->cp.f = c->f; /* the check knows the stiffness form                       */
  double bad = case_violation(c, c->u, c->r);
  c->cp.f = f;
  ck_assert_msg(bad <= CLAIM * tol, "%s: problem %d: violation %g",
                row_name(ops), k, bad);
  return 1;
}

/* 1: it is one of the answers of all states of all nodes. */
static int is_listed(const state_list *list, const contact_case *c) {
  for (int i = 0; i < list->n; ++i)
    if (apart(c, list->u + (size_t)(i * c->cp.m), c->u) <= AGREE) return 1;
  return 0;
}

typedef struct tally {
  int tried, solved[MOST_ROWS]; /* without the weak ones                      */
  int operated, by_products[MOST_ROWS]; /* of them, small ones                */
  int compared, listed, others; /* unique; by all states; two answers         */
} tally;

/* One row on it. 1: solved; c->u is the answer. */
static int run_row(const solver_ops *ops, int k, problem *p,
                   const state_list *list) {
  int steep = p->mu > 0.5 || p->kind == WEAK, solved = claims(ops, k, p);
  ck_assert_msg(solved || (steep && ops != NULL),
                "%s: problem %d is not solved", row_name(ops), k);
  ck_assert_msg(!solved || list->n == 0 || is_listed(list, &p->c),
                "%s: problem %d: none of the %d answers", row_name(ops), k,
                list->n);
  return solved;
}

/* All rows on one problem. */
typedef struct all_rows {
  state_list list;
  int have;      /* 1: one has solved it */
  double *first; /* [m] its answer */
  double most;   /* apart from it */
} all_rows;

static void run_rows(int k, problem *p, all_rows *x, int *solved) {
  const contact_case *c = &p->c;
  EACH_SOLVER(i, ops) {
    if (c->cp.op != NULL && ops != NULL && ops->entries != NULL) continue;
    if (!run_row(ops, k, p, &x->list)) continue;
    solved[i] += p->kind != WEAK;
    if (x->have) x->most = fmax(x->most, apart(c, c->u, x->first));
    if (!x->have) memcpy(x->first, c->u, (size_t)c->cp.m * sizeof *x->first);
    x->have = 1;
  }
}

static void run_problem(int k, tally *t) {
  problem p = make(k);
  contact_case *c = &p.c;
  const int weak = p.kind == WEAK;
  all_rows x = {.first = calloc((size_t)c->cp.m, sizeof *x.first)};
  if (p.kind != SOFT && !weak) t->listed += state_list_new(c, &x.list);
  t->tried += !weak;
  run_rows(k, &p, &x, t->solved);
  if (p.kind != SOFT && c->cp.n <= SMALL) {
    operated_case *o = operated_new(c);
    run_rows(k, &p, &x, t->by_products);
    t->operated += !weak;
    operated_free(o, c);
  }
  int unique = x.list.n == 1 || p.mu == 0.0 || p.mu < guaranteed_mu(c);
  if (!weak && unique) {
    ck_assert_msg(x.most <= AGREE, "problem %d: apart by %g", k, x.most);
    ++t->compared;
  }
  t->others += !weak && x.most > AGREE;
  state_list_free(&x.list);
  free(x.first);
  unmake(&p);
}

/* Nearly all are solved by the row. */
static void must_solve(const char *name, int solved, int tried) {
  ck_assert_msg(solved >= tried - 1 - tried / 20, "%s: %d of %d", name, solved,
                tried);
}

/* The slices are tests of their own: the checks of one that fails name it. */
TESTS(every_row_is_right_or_says_so, SLICES) {
  tally t = {0};
  for (int k = _i; k < asked("PROTIS_PROBLEMS", 150); k += SLICES)
    run_problem(k, &t);
  ck_assert_int_ge(t.listed * 20, t.tried);
  ck_assert_int_ge(t.compared * 3, t.tried);
  ck_assert_int_le(t.others * 20, t.tried);
  EACH_SOLVER(i, ops) {
    must_solve(row_name(ops), t.solved[i], t.tried);
    if (ops == NULL || ops->entries == NULL)
      must_solve(row_name(ops), t.by_products[i], t.operated);
  }
  points_end(&(points){.kind = "random contact problems", .tried = t.tried});
}

/* ---- sparse compliances ---------------------------------------------------
 */

/* 1: solved; a claim is right. */
static int solves_planted(const solver_ops *ops, const planted *p, int k) {
  double param[PARAM_SIZE / sizeof(double)] = {0.0};
  solver_choice choice = {.ops = ops, .param = param, .tol = TOL_SOFT};
  ENDS_BY(contact_solver_free) contact_solver *s = NULL;
  solver_report rep;
  if (ops != NULL) option_defaults(ops->options, param);
  memset(p->r, 0, sizeof *p->r * (size_t)p->cp.m);
  memcpy(p->u, p->q, sizeof *p->u * (size_t)p->cp.m);
  ck_assert_int_eq(contact_solver_new(&choice, &s), OK);
  ck_assert_int_eq(contact_solve(s, &p->cp, NULL, p->u, p->r, &rep), OK);
  if (rep.outcome != CONVERGED) return 0;
  double map = planted_map(p, p->u, p->r);
  ck_assert_msg(map <= CLAIM * TOL_SOFT, "%s: planted %d: natural map %g",
                row_name(ops), k, map);
  return 1;
}

static void run_planted(int k, int *solved) {
  const int sizes[] = {6, 24, 45, unit_whole() ? 90 : 30};
  static const double mus[] = {0.1, 0.3, 0.7};
  planted p = planted_new((planted_kind)((k + k / SLICES) % 4), 2 + k / 3 % 2,
                          sizes[k % 4], mus[k / 2 % 3], (unsigned long long)k);
  ck_assert_double_le(planted_map(&p, p.u, p.r), 1e-12);
  EACH_SOLVER(i, ops)
  if (ops == NULL || k % 4 < 2 || (ops->handles & SPARSE_COMPLIANCE))
    solved[i] += solves_planted(ops, &p, k);
  planted_free(&p);
}

/* DRIFTS: forces in equilibrium with one another drift on, by less and less. */
TESTS(planted_answer_of_many_bodies_is_found, SLICES) {
  enum { DRIFTS = 994 };
  const int most = asked("PROTIS_PROBLEMS", 150) / 6;
  int solved[MOST_ROWS] = {0}, tried = 0;
  for (int k = _i; k < most; k += SLICES, ++tried) run_planted(k, solved);
  if (most <= DRIFTS && _i == DRIFTS % SLICES) {
    run_planted(DRIFTS, solved);
    ++tried;
  }
  EACH_SOLVER(i, ops)
  if (ops == NULL || ops == &proximal_solver)
    ck_assert_msg(solved[i] == tried, "%s: %d of %d", row_name(ops), solved[i],
                  tried);
  points_end(&(points){.kind = "planted problems of bodies", .tried = tried});
}

UNIT_MAIN_FOR("conformance", 10 * UNIT_SECONDS)
