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
  int own_moduli; /* 1: those of r, and r.elastic */
};

/* Arrays that the copy changes and the run still needs. */
static status copy_arrays(run *b) {
  equilibrium *e = &b->now;
  const size_t n = b->nodes.n, n_c = b->nodes.n_c, dofs = b->n_dof;
  const size_t sides = n_c - n, elements = b->msh->n_elem;
  const size_t strains = strains_kept(b);
  const struct {
    double **at;
    size_t n;
  } own[] = {{&e->u, dofs},
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
  for (size_t i = 0; i < sizeof own / sizeof *own; ++i) {
    const double *from = *own[i].at;
    if (from == NULL) continue;
    PASS_NEW(*own[i].at, own[i].n);
    COPY(*own[i].at, from, own[i].n);
  }
  return OK;
}

void shadow_leave(shadow **p) {
  shadow *b = *p;
  if (b == NULL) return;
  if (b->own_moduli) matrices_free(&b->r.elastic);
  if (b->r.problem.given != NULL) contact_solver_free(&b->r.elastic.solver);
  memory_free(b);
}

/* Moduli that follow the temperature, and their matrix, are the copy's own. */
static status own_moduli(const run *r, shadow *s) {
  run *b = &s->r;
  if (r->body.moduli.n_own == 0) return OK;
  s->own_moduli = 1;
  b->c = NULL;
  b->body.stale = 1;
  b->elastic = (matrices){0};
  b->body.moduli = (moduli){0};
  PASS(moduli_new(r->m, r->msh, r->now.temperature, &b->body.moduli));
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
  OWNS(b);
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
  PASS(copy_arrays(own));
  PASS(own_points(r, b));
  PASS(own_moduli(r, b));
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
