/*
 * *GOAL: quantities of the solution with their errors. For each of them the
 * contact problem linearised at the solution is solved once more, transposed:
 * a solve with the dense factor, which all share, and one with that of the
 * body.
 */
#include "base/memory.h"
#include "base/timer.h"
#include "effects/goal/parts.h"
#include "effects/plan/plan.h"
#include "effects/rows.h"

#include <math.h>
#include <string.h>

static const double ROUNDING = 1e-12; /* -, of the value: no error at all */

typedef struct goal_state {
  int n;
  goal_result *result;      /* [n] */
  double *product;          /* [n*n_elem] of goal_estimate_find, or NULL */
  space_recovery *recovery; /* NULL until the first estimate */
  long elastic_no;          /* of the run, that it is made of */
} goal_state;

static status goals_new(run *r, void **self) {
  goal_state *own = NULL;
  PASS_NEW(own, 1);
  *self = own;
  own->n = r->m->n.goal;
  PASS_NEW(own->result, own->n);
  if (r->m->accuracy.goal_products)
    PASS_NEW(own->product, (size_t)own->n * (size_t)r->msh->n_elem);
  return OK;
}

static void release(void *self) {
  goal_state *own = self;
  if (own == NULL) return;
  space_recovery_free(own->recovery);
  RELEASE(own->result, own->product, own);
}

/* ---- what the estimate covers -------------------------------------------- */

/* Friction rules whose position of stick holds the errors of the increments
 * before. */
static int has_history(const run *r) {
  return run_remembers(r) && r->course.total_no > 1;
}

static int is_covered(const run *r) {
  return !model_has_pairs(r->m) && r->body.d.cluster == NULL &&
         r->strains.visco == NULL && effects_sum_up(r) == NULL &&
         r->problem.given == NULL && r->m->mesh.corner_id < 0 &&
         (r->nodes.n == 0 || r->problem.cp.A != NULL) &&
         r->solving.report.outcome > 0;
}

/* ---- an increment -------------------------------------------------------- */

/* What all goals of the increment share. */
typedef struct shared {
  goal_surface surface;
  goal_estimator *estimator;
  contact_adjoint *adjoint; /* NULL: no contact, or singular */
  goal_form form;
  double *y;                    /* [dim*n_node] */
  double *j, *more, *psi, *y_c; /* [n_row] */
} shared;

static void shared_free(shared *s) {
  goal_surface_free(&s->surface);
  goal_estimator_free(s->estimator);
  contact_adjoint_free(s->adjoint);
  goal_form_free(&s->form);
  RELEASE(s->y, s->j, s->more, s->psi, s->y_c);
}

static status recover(const run *r, goal_state *own) {
  if (own->recovery != NULL && own->elastic_no == r->body.elastic_no) return OK;
  space_recovery_free(own->recovery);
  own->recovery = NULL;
  own->elastic_no = r->body.elastic_no;
  return space_recovery_new(&r->body.d, &own->recovery);
}

static status prepare(run *r, goal_state *own, shared *s) {
  const int n = r->nodes.n_row;
  PASS(goal_surface_new(r, &s->surface));
  PASS(recover(r, own));
  const goal_solution found = {.d = &r->body.d,
                               .u = r->now.u,
                               .sigma = r->result.stress,
                               .n_edge = s->surface.n_edge,
                               .edge = s->surface.edge,
                               .ends = s->surface.ends};
  PASS(goal_estimator_new(&found, own->recovery, &s->estimator));
  PASS_NEW(s->y, r->n_dof);
  PASS_NEW(s->j, n);
  PASS_NEW(s->more, n);
  PASS_NEW(s->psi, n);
  PASS_NEW(s->y_c, n);
  if (n == 0) return OK;
  return contact_adjoint_new(&r->problem.cp, run_rows(r, 0, r->now.uc),
                             run_rows(r, 1, r->now.rc), &s->adjoint);
}

/* The adjoint of s->form: s->y, *solver. */
static status solve(run *r, shared *s, double *solver) {
  *solver = 0.0;
  PASS(condense_load(r->c, s->form.load, NULL, s->j));
  if (s->adjoint != NULL) {
    run_take_rows(r, s->form.rows, s->more);
    run_take_rows(r, s->form.psi, s->psi);
    for (int k = 0; k < r->nodes.n_row; ++k) s->j[k] += s->more[k];
    contact_adjoint_solve(s->adjoint, s->j, s->psi, s->y_c, solver);
  }
  return condense_recover(r->c, s->y_c, s->y);
}

/* product[n_elem] or NULL */
static status estimate(run *r, shared *s, double *product, goal_result *out) {
  const goal_form *f = &s->form;
  const double value = f->value, cpu = out->cpu;
  goal_estimate e;
  double solver;
  PASS(solve(r, s, &solver));
  PASS(goal_estimate_find(s->estimator, s->y, f->has_tau ? f->tau : NULL,
                          product, &e));
  e.error += f->curved;
  e.magnitude += fabs(f->curved);
  if (f->is_square) e.error += 0.5 * goal_estimator_energy(s->estimator);
  *out = goal_judge(&e, s->surface.n_closed);
  out->value = value;
  out->solver = solver;
  out->cpu = cpu;
  if (e.magnitude <= ROUNDING * fabs(value)) out->verdict = GOAL_RELIABLE;
  if (has_history(r)) out->verdict = GOAL_NO_HISTORY;
  return OK;
}

static status find_goal(run *r, shared *s, int id, goal_state *own) {
  const size_t n = (size_t)r->msh->n_elem;
  goal_result *out = &own->result[id];
  double *product = own->product != NULL ? own->product + n * (size_t)id : NULL;
  if (product != NULL) memset(product, 0, n * sizeof *product);
  PASS(goal_form_set(r, &r->m->accuracy.goals[id], &s->form));
  *out =
      (goal_result){s->form.value, NAN, NAN, NAN, NAN, out->cpu, s->form.why};
  if (s->form.why != GOAL_RELIABLE) return OK;
  out->verdict = GOAL_NOT_COVERED;
  if (s->estimator == NULL || (r->nodes.n_row > 0 && s->adjoint == NULL))
    return OK;
  return estimate(r, s, product, out);
}

/* The time that all share counts with the first. */
static status find_goals(run *r, void *self) {
  goal_state *own = self;
  shared s = {.estimator = NULL};
  double cpu = timer_cpu();
  status st = OK;
  TRY(goal_form_new(r, &s.form));
  domain_stress(&r->body.d, r->now.u, NULL, r->result.stress);
  if (is_covered(r)) TRY(prepare(r, own, &s));
  for (int k = 0; k < own->n; ++k) {
    TRY(find_goal(r, &s, k, own));
    own->result[k].cpu += timer_cpu() - cpu;
    cpu = timer_cpu();
  }
done:
  shared_free(&s);
  return st;
}

static void show(const void *self, state *s) {
  const goal_state *own = self;
  s->errors.n_goal = own->n;
  s->errors.goals = own->result;
  s->errors.goal_products = own->product;
}

/* ---- the row ------------------------------------------------------------- */

static status expected(const plan_sizes *s, effect_work *w) {
  const double m = plan_contact_unknowns(s), n = s->m->n.goal;
  const double passes = s->is_flat ? 6.0 : 12.0;
  const double factor = m * m * m / 3.0 / PLAN_DENSE;
  const double each = s->elements * passes * plan_element_work(s) +
                      2.0 * work_factor_entries(s) + 4.0 * m * m;
  *w = (effect_work){n, "goals", s->increments,
                     s->increments * (factor + (1.0 + n) * each)};
  return OK;
}

static int requires_goals(const model *m, char *why, size_t size) {
  if (m->n.goal == 0) return plan_says(0, why, size, "no *GOAL card");
  return plan_says(1, why, size, "*GOAL, NAME=%s, %s:%d",
                   m->accuracy.goals[0].name, PLACE(m->accuracy.goals[0].at));
}

static int goal_items(const void *self) {
  return ((const goal_state *)self)->n;
}

#include "run/column_row.h"

static const goal_result *result_of(const view *v, int id) {
  return &v->s->errors.goals[id];
}

VALUE(goal_no, id + 1)
VALUE(goal_value, result_of(v, id)->value)
VALUE(goal_error, result_of(v, id)->error)
VALUE(goal_corrected, result_of(v, id)->value + result_of(v, id)->error)
VALUE(goal_band, result_of(v, id)->band)
VALUE(goal_solver, result_of(v, id)->solver)
VALUE(goal_ends, 100 * result_of(v, id)->ends)

static const char *goal_name(const view *v, int id) {
  return v->m->accuracy.goals[id].name;
}

static const char *goal_unit_word(const view *v, int id) {
  return goal_unit(&v->m->accuracy.goals[id]);
}

static const char *goal_word(const view *v, int id) {
  return goal_verdict_word(result_of(v, id)->verdict);
}

/* clang-format off */
#define GOAL PER_GOAL, AS_REAL, PRINT_GOALS, 0, SCENE_ALL, 0, NULL, 0
#define WORD PER_GOAL, AS_WORD, PRINT_GOALS, 0, SCENE_ALL, 0, NULL, 0
#define OWN "unit"
static const column columns[] = {
{"goal", "-", WORD, goal_no, goal_name, "NAME= of the *GOAL"},
{"unit", "-", WORD, goal_no, goal_unit_word, "of the values of the row"},
{"value", OWN, GOAL, goal_value, NULL, "on this mesh"},
{"error", OWN, GOAL, goal_error, NULL,
 "by the mesh, with its sign: estimate of the exact value less that on this "
 "mesh"},
{"corrected", OWN, GOAL, goal_corrected, NULL, "value + error"},
{"band", OWN, GOAL, goal_band, NULL,
 "the exact value is within it round the corrected one"},
{"solver_error", OWN, GOAL, goal_solver, NULL,
 "by the contact solver, with its sign"},
{"contact_ends", "%", GOAL, goal_ends, NULL,
 "share of the elements where the contact ends or changes between slip and "
 "stick"},
{"verdict", "-", WORD, goal_no, goal_word,
 "reliable, or why not"}};
/* clang-format on */

const effect_ops goals_effect = {
    .name = "errors of goals",
    .bit = NO_BIT,
    .required = requires_goals,
    .expected = expected,
    .table = {PRINT_GOALS, PER_GOAL, STAGE_TABLE_GOALS},
    .on.create = goals_new,
    .on.accept = find_goals,
    .on.show = show,
    .on.release = release,
    .columns = columns,
    .n_column = COLUMNS(columns),
    .items = goal_items};
