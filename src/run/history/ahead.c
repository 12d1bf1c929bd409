/*
 * The steps of a run before the first is solved: what deck and mesh alone tell
 * of each that the run would end with, after the steps before it.
 */
#include "model/facts.h"
#include "run/setup/setup.h"

/* 1: motions that friction may not allow, or statuses that are all tried. */
static int effects_have_to_look(const model *m) {
  int any = 0;
  for (int i = 0; i < m->n.step; ++i) any |= m->steps[i].check == CHECK_ALL;
  if (m->dim < 3 || !(m->effects & EFFECT_FRICTION)) return any;
  for (int i = 0; i < m->n.obstacle; ++i)
    any |= obstacle_moves(&m->obstacles[i]);
  return any || facts_moving_support(m) != NULL;
}

/* The supports of r->step; *other: they are not those of the step before. */
static status take_supports(run *r, int *other) {
  OWNED_NEW(unsigned char, fixed, r->n_dof);
  load_fixed(r->msh, r->step, fixed);
  *other = memcmp(fixed, r->body.fixed, r->n_dof) != 0;
  memcpy(r->body.fixed, fixed, r->n_dof);
  return OK;
}

/* Its surface, and whether all bodies are held. */
static status build_step(run *r) {
  int motions = 0;
  PASS(run_build_ties(r));
  if (r->m->effects & EFFECT_CONTACT) PASS(run_build_surface(r));
  r->body.d.surface = r->surface;
  return run_check_supports(r, &motions);
}

/* *any = 1: some step has other supports than the one before. */
static status change_supports(const model *m, const mesh *msh, int *any) {
  const size_t n = (size_t)msh->dim * msh->n_node;
  OWNED unsigned char *first = NULL, *fixed = NULL;
  PASS_NEW_ALL(OF(first, n), OF(fixed, n));
  load_fixed(msh, &m->steps[0], first);
  for (int i = 1; i < m->n.step && !*any; ++i) {
    load_fixed(msh, &m->steps[i], fixed);
    *any = memcmp(first, fixed, n) != 0;
  }
  return OK;
}

/* The first n steps. */
static status check_steps(run *r, int n, int look) {
  COPY(r->loads.start, r->old.u, r->n_dof);
  for (int i = 0; i < n; ++i) {
    int other = 0;
    r->step = &r->m->steps[i];
    PASS(take_supports(r, &other));
    if (i == 0 || other) PASS(build_step(r));
    PASS(effects_check(r));
    if (look) {
      /* The displacements that the next step starts from: those of supports. */
      PASS(load_prescribed(r->m, r->msh, r->step, step_end(r->step), NULL,
                           r->loads.start));
      for (size_t k = 0; k < r->n_dof; ++k)
        if (!r->body.fixed[k]) r->loads.start[k] = NAN;
    }
  }
  return OK;
}

status history_check(const model *m, const mesh *msh,
                     const effect_ops *const *effects) {
  static const history_sink nobody;
  const int look = effects_have_to_look(m);
  const int n = model_updates_pairs(m) && m->n.step > 1 ? 1 : m->n.step;
  int any = look;
  ENDS_BY(run_free)
  run r = {.m = m, .msh = msh, .sink = &nobody, .step = &m->steps[0]};
  if (n > 1 && !any) PASS(change_supports(m, msh, &any));
  if (n == 0 || !any) return OK;
  timer_enter_as(STAGE_SURFACE, STAGE_WHOLE | STAGE_NO_CALL);
  status st = run_new(&r, effects);
  if (st == OK) st = check_steps(&r, n, look);
  timer_leave(STAGE_SURFACE);
  return st;
}

status history_ranges(const model *m, const mesh *msh,
                      const effect_ops *const *effects) {
  static const history_sink nobody;
  ENDS_BY(run_free)
  run r = {.m = m, .msh = msh, .sink = &nobody, .step = &m->steps[0]};
  if (m->n.step == 0) return OK;
  PASS(run_new(&r, effects));
  for (int i = 0; i < m->n.step; ++i) {
    r.step = &m->steps[i];
    load_fixed(msh, r.step, r.body.fixed);
    PASS(run_check_range(&r));
    COPY(r.old.F, r.now.F, r.n_dof);
  }
  return OK;
}
