/* The set of solutions found, distinguished by their distance in energy. */
#include "accuracy/solutions.h"

#include <assert.h>
#include <cblas.h>

/*
 * Solutions by several solvers: one of each family, from different starts:
 * sticking, all open, and sliding in both directions. Where friction allows
 * several states, methods and starts converge to different ones.
 */

static const double SAME = 1e-6; /* -, relative distance of one state */
static const double UNIT = 1e-3; /* -, of the energy of the scale: counts as
                                    the norm of a state without deformation */

int solution_set_confirmed(const solution_set *s) {
  const char *family = NULL;
  if (s->n_found == 0) return 0;
  if (s->n_pattern > 0) return s->found[0].facts.patterns > 0;
  for (EACH(const solution_attempt, a, s->attempts, s->n_attempt)) {
    if (a->solution_no != 1) continue;
    if (family != NULL && strcmp(family, a->family) != 0) return 1;
    family = a->family;
  }
  return 0;
}

void solution_set_free(solution_set *s) {
  if (s == NULL) return;
  for (EACH(const solution, f, s->found, s->n_found))
    RELEASE(f->u, f->r, f->status);
  RELEASE(s->found, s->attempts);
  *s = (solution_set){0};
}

/* x' M x of the difference of two states, b NULL: of one; t[2m] workspace. */
static double energy(const contact_problem *cp, const double *a,
                     const double *b, double *t) {
  for (int i = 0; i < cp->m; ++i) t[i] = b == NULL ? a[i] : a[i] - b[i];
  contact_apply(cp, t, t + cp->m);
  return fmax(0.0, cblas_ddot(cp->m, t, 1, t + cp->m, 1));
}

/* Energy of an unknown that moves (is pushed) by the scale of the problem. */
static double unit_energy(const contact_problem *cp) {
  const double *M = contact_matrix(cp);
  double scale = contact_scale(cp), most = 0.0;
  for (int i = 0; i < cp->m; ++i) most = fmax(most, M[(size_t)i * (cp->m + 1)]);
  return most > 0.0 ? UNIT * UNIT * scale * (scale / most) : 0.0;
}

static status find_distance(const contact_problem *cp, const double *a,
                            const double *b, double *distance) {
  OWNED_NEW(double, t, 2 * cp->m);
  double size = fmax(energy(cp, a, NULL, t), energy(cp, b, NULL, t));
  size = fmax(size, unit_energy(cp));
  double apart = energy(cp, a, b, t);
  *distance = size > 0.0 ? sqrt(apart / size) : 0.0;
  return OK;
}

static void find_facts(const contact_problem *cp, solution *s) {
  solution_facts *f = &s->facts;
  *f = (solution_facts){.residual = contact_residual(cp, s->u, s->r),
                        .patterns = 1};
  for (int i = 0; i < cp->n; ++i) {
    f->n_open += s->status[i] == CONTACT_OPEN;
    f->n_slip += s->status[i] == CONTACT_SLIP;
    f->n_stick += s->status[i] == CONTACT_STICK;
    for (int k = 0; k < 2 && k < cp->dim; ++k) {
      double u = s->u[i * cp->dim + k];
      f->lowest[k] = i == 0 ? u : fmin(f->lowest[k], u);
      f->highest[k] = i == 0 ? u : fmax(f->highest[k], u);
    }
  }
}

static status copy_solution(const contact_problem *cp, const double *u,
                            const double *r, solution *s) {
  PASS_NEW_REALS(cp->m, &s->u, &s->r);
  PASS_NEW(s->status, cp->n);
  COPY(s->u, u, cp->m);
  COPY(s->r, r, cp->m);
  contact_classify(cp, u, r, s->status);
  find_facts(cp, s);
  return OK;
}

status solution_set_add(const contact_problem *cp, double tol, const double *u,
                        const double *r, solution_set *s, int *no) {
  const double *x = contact_has_stiffness(cp) ? u : r;
  double distance = 0.0;
  *no = 0;
  s->n = cp->n;
  if (!(contact_residual(cp, u, r) <= tol)) return OK;
  for (int i = 0; i < s->n_found; ++i) {
    const solution *old = &s->found[i];
    PASS(find_distance(cp, x, contact_has_stiffness(cp) ? old->u : old->r,
                       &distance));
    if (distance > SAME) continue;
    ++s->found[i].facts.patterns;
    *no = i + 1;
    return OK;
  }
  if (s->n_found > 0)
    PASS(find_distance(
        cp, x, contact_has_stiffness(cp) ? s->found[0].u : s->found[0].r,
        &distance));
  ADDED(solution, new, s->found, s->n_found, s->cap_found);
  PASS(copy_solution(cp, u, r, new));
  new->facts.distance = distance;
  *no = s->n_found;
  return OK;
}

enum { PARAM_SIZE = 512 };
static const double FAR = 16.0; /* -, of the displacement that the scale of the
                                   forces makes: distance of a start */

typedef enum { STICKING, OPEN_START, SLIDING, SLIDING_BACK, N_START } start;
static const char *const start_text[] = {
    "sticking", "all open", "sliding along t", "sliding against t"};

/* Displacement of the size that the forces of the problem cause, m. */
static double reach(const contact_problem *cp) {
  double least = HUGE_VAL, scale = contact_scale(cp);
  if (!contact_has_stiffness(cp)) return FAR * scale;
  for (int i = 0; i < cp->m; ++i) least = fmin(least, contact_diagonal(cp, i));
  return least > 0.0 ? FAR * scale / least : 0.0;
}

/* +1, -1, 0: how a start slides along t1. */
static double direction_of(start kind) {
  return kind == SLIDING ? 1.0 : kind == SLIDING_BACK ? -1.0 : 0.0;
}

static void set_start(const contact_problem *cp, start kind, double *u,
                      double *r) {
  double far = reach(cp),
         force = !contact_has_stiffness(cp) ? 0.0 : contact_scale(cp);
  int open = kind == OPEN_START;
  for (int i = 0; i < cp->n; ++i) {
    int first = i * cp->dim;
    u[first] = cp->gap[i] - (open ? far : 0.0);
    r[first] = open ? 0.0 : -force;
    for (int k = 0; k < cp->dim - 1; ++k) {
      u[first + 1 + k] = cp->ut0 == NULL ? 0.0 : cp->ut0[i * (cp->dim - 1) + k];
      r[first + 1 + k] = 0.0;
    }
    if (cp->dim > 1) u[first + 1] += direction_of(kind) * far;
  }
  for (int i = 0; i < cp->n && cp->dim > 1; ++i)
    r[i * cp->dim + 1] = -direction_of(kind) * contact_node_limit(cp, r, i);
}

/* Workspace for one start and its solution. */
typedef struct trial {
  double *u, *r; /* [m] */
} trial;

static status attempt(const contact_problem *cp, double tol,
                      contact_solver *solver, const char *name, start kind,
                      const trial *x, solution_set *s) {
  double *u = x->u, *r = x->r;
  solver_report rep;
  int no = 0;
  set_start(cp, kind, u, r);
  PASS(contact_solve(solver, cp, NULL, u, r, &rep));
  if (rep.outcome > 0) PASS(solution_set_add(cp, tol, u, r, s, &no));
  PASS_GROW(s->attempts, s->n_attempt, s->cap_attempt);
  s->attempts[s->n_attempt++] =
      (solution_attempt){.solver = name,
                         .family = solver_family(name),
                         .start = start_text[kind],
                         .outcome = rep.outcome,
                         .residual = rep.residual,
                         .solution_no = no};
  return OK;
}

static int can_solve(const contact_problem *cp, const solver_ops *ops) {
  return cp->dim == 2 || (ops->handles & SOLVES_3D) != 0;
}

/* 1: row i represents its family: no row before it of the same kind can. */
static int is_chosen(const contact_problem *cp, int i) {
  for (int k = 0; k < i; ++k)
    if (strcmp(solver_list[k]->family, solver_list[i]->family) == 0 &&
        can_solve(cp, solver_list[k]))
      return 0;
  return can_solve(cp, solver_list[i]);
}

static status try_solver(const contact_problem *cp, double tol,
                         const solver_ops *ops, const trial *x,
                         solution_set *s) {
  _Alignas(16) char param[PARAM_SIZE] = {0};
  ENDS_BY(contact_solver_free) contact_solver *solver = NULL;
  assert(ops->param_size <= PARAM_SIZE);
  option_defaults(ops->options, param);
  solver_choice choice = {.ops = ops, .param = param, .tol = tol};
  PASS(contact_solver_new(&choice, &solver));
  for (int k = 0; k < N_START; ++k)
    PASS(attempt(cp, tol, solver, ops->name, (start)k, x, s));
  return OK;
}

status solutions_by_solvers(const contact_problem *cp, double tol,
                            const solver_report *report, const double *u,
                            const double *r, solution_set *out) {
  OWNED_NEW(double, at_start, 2 * cp->m);
  trial x = {.u = at_start, .r = at_start + cp->m};
  int no = 0;
  PASS(solution_set_add(cp, tol, u, r, out, &no));
  PASS_GROW(out->attempts, out->n_attempt, out->cap_attempt);
  out->attempts[out->n_attempt++] =
      (solution_attempt){.solver = report->solver,
                         .family = solver_family(report->solver),
                         .start = "last increment",
                         .outcome = report->outcome,
                         .residual = report->residual,
                         .solution_no = no};
  for (int i = 0; solver_list[i] != NULL; ++i)
    if (is_chosen(cp, i)) PASS(try_solver(cp, tol, solver_list[i], &x, out));
  return OK;
}
