/*
 * A state within a solved increment: the inelastic strains there by the rule of
 * the integrator, and their equilibrium under the loads of that time, with the
 * slip counted from the start of the increment. A shadow run, a copy of the run
 * with arrays of its own, solves it; the increment is unchanged. Shared arrays
 * are those that result_evaluate computes again.
 */
#include "run/visco.h"

struct shadow {
  run r;
  visco v;
};

enum { OWN = 16 };

typedef struct own_array {
  double **at;
  size_t n;
} own_array;

/* Arrays that the copy changes and the run still needs. */
static void list_own(run *b, own_array list[OWN]) {
  equilibrium *e = &b->now;
  const size_t n = b->nodes.n, n_c = b->nodes.n_c, dofs = b->n_dof;
  const size_t sides = n_c - n, elements = b->msh->n_elem;
  const size_t strains = strains_kept(b);
  const own_array all[OWN] = {{&e->u, dofs},
                              {&e->F, dofs},
                              {&e->reaction, dofs},
                              {&e->uc, n_c},
                              {&e->rc, n_c},
                              {&e->motion, n_c},
                              {&e->thermal, strains},
                              {&e->e0, strains},
                              {&e->sigma, strains},
                              {&b->problem.f, b->nodes.n_row},
                              {&b->problem.f_load, b->nodes.n_row},
                              {&b->problem.gap, n},
                              {&b->problem.side_gap, sides},
                              {&e->elastic, strains},
                              {&b->loads.ud, dofs},
                              {&e->temperature, elements}};
  memcpy(list, all, sizeof all);
}

static status copy_arrays(run *b) {
  own_array list[OWN];
  const double *from[OWN];
  list_own(b, list);
  for (int i = 0; i < OWN; ++i) {
    from[i] = *list[i].at;
    *list[i].at = NULL;
  }
  for (int i = 0; i < OWN; ++i) {
    if (from[i] == NULL) continue;
    PASS_NEW(*list[i].at, list[i].n);
    COPY(*list[i].at, from[i], list[i].n);
  }
  return OK;
}

void shadow_leave(shadow **p) {
  shadow *b = *p;
  own_array list[OWN];
  if (b == NULL) return;
  list_own(&b->r, list);
  for (int i = 0; i < OWN; ++i) memory_free(*list[i].at);
  effects_release(&b->r);
  if (b->r.body.moduli.n_own > 0) {
    matrices_free(&b->r.elastic);
    moduli_free(&b->r.body.moduli);
  }
  if (b->r.problem.given != NULL) contact_solver_free(&b->r.elastic.solver);
  memory_free(b);
}

/* Moduli that follow the temperature, and their matrix, are the copy's own. */
static status own_moduli(const run *r, run *b) {
  if (r->body.moduli.n_own == 0) return OK;
  b->c = NULL;
  b->body.stale = 1;
  b->elastic = (matrices){0};
  b->body.moduli = (moduli){0};
  status st = moduli_new(r->m, r->msh, r->now.temperature, &b->body.moduli);
  b->body.moduli.n_own = r->body.moduli.n_own; /* owned also after a failure */
  PASS(st);
  moduli_domain(&b->body.moduli, r->m, &b->body.d);
  return OK;
}

static status own_points(const run *r, shadow *b) {
  visco *v = &b->v;
  if (r->strains.visco == NULL) return OK;
  *v = *r->strains.visco;
  v->now = (flow_state){0};
  v->sums.known = 0;
  for (int i = 0; i < SLOTS; ++i) v->slot[i] = (matrices){0};
  v->fresh = (matrices){0};
  b->r.strains.visco = v;
  OWNS(b);
  PASS(flow_state_new(&v->x, &v->now));
  flow_state_copy(&v->x, &r->strains.visco->old, &v->now);
  return OK;
}

/* *out is valid (free it) also after a failure. Given forces make a matrix of
 * their own in each run: the solver, which has its factors and what else the
 * problem borrows from it, is the copy's own too. */
static status shadow_new(const run *r, shadow **out) {
  shadow *b = NULL;
  PASS_NEW(b, 1);
  *out = b;
  run *own = &b->r;
  *own = *r;
  own->course.shadow = 1;
  own->c = r->elastic.c;
  if (own->problem.given != NULL) own->elastic.solver = NULL;
  own->solver = own->elastic.solver;
  own->solving.known_key = RUN_NO_KEY;
  own->solving.rate = (known_rate){0};
  own->course.note[0] = '\0';
  if (r->body.d.eigen != NULL) own->body.d.eigen = &own->strains.eigen;
  own->effects.n = 0;
  own->body.moduli.n_own = 0; /* not owned yet */
  PASS(copy_arrays(own));
  PASS(own_points(r, b));
  PASS(own_moduli(r, own));
  return effects_copy(r, own);
}

static status solve(run *r, run *b, double t) {
  if (r->strains.visco != NULL && r->step->kind == STEP_VISCO)
    PASS(visco_between(r, t, &b->strains.visco->now,
                       &b->strains.visco->result.dissipated));
  PASS(increment_solve(b, t));
  if (b->strains.visco != NULL) visco_take(b);
  return result_evaluate(b, 1);
}

status shadow_at(run *r, double t, shadow **out) {
  TIMED(STAGE_BETWEEN);
  *out = NULL;
  PASS(shadow_new(r, out));
  return solve(r, &(*out)->r, t);
}

static status solve_with(run *r, run *b, const double *more) {
  if (b->strains.visco != NULL)
    flow_state_copy(&b->strains.visco->x, &r->strains.visco->now,
                    &b->strains.visco->now);
  PASS(increment_begin(b, r->now.t));
  for (size_t i = 0; i < b->n_dof; ++i) b->now.F[i] += more[i];
  PASS(run_use(b, &b->elastic));
  return increment_equilibrium(b, strains_load(b));
}

status shadow_with(run *r, const double *more, double *u, double *rc,
                   int *solved) {
  ENDS_BY(shadow_leave) shadow *b = NULL;
  TIMED(STAGE_BETWEEN);
  PASS(shadow_new(r, &b));
  PASS(solve_with(r, &b->r, more));
  *solved = b->r.solving.report.outcome > 0;
  COPY(u, b->r.now.u, r->n_dof);
  if (r->nodes.n_c > 0) COPY(rc, b->r.now.rc, r->nodes.n_c);
  return OK;
}

run *shadow_run(shadow *b) { return &b->r; }
