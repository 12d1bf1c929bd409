/*
 * Points whose law flows, before anything is solved: the temperatures of the
 * steps in which they do.
 */
#include "base/memory.h"
#include "run/setup/setup.h"
#include "run/visco.h"

#include <math.h>

/* 1: rates of some law depend on the absolute temperature. */
static int counts_from_zero(const flow *x) {
  int any = 0;
  for (int i = 0; i < x->n_kind; ++i)
    any |= law_too_cold(x->kind[i].law, -HUGE_VAL) != NULL;
  return any;
}

/* The first point that is too cold, with temperatures T[n_elem] at a time. */
static status check_cold(const run *r, int step_id, double t, const double *T) {
  const visco *v = r->strains.visco;
  for (int k = 0; k < v->x.n; ++k) {
    const law_card *law = v->x.kind[v->x.kind_id[k]].law;
    const char *wrong = law_too_cold(law, T[v->elem[k]]);
    if (wrong == NULL) continue;
    message_add(r->m->log, P2062, &law->at,
                "material %s, step %d, time %g, element %zu: %s", law->material,
                step_id + 1, t, r->msh->elem_no[v->elem[k]], wrong);
    return message_status(r->m->log, ERR_DECK);
  }
  return OK;
}

/* Temperatures are between those of the ends of the step, or expressions. */
static status check_temperatures(const run *r) {
  const double *T0 = r->strains.temperature0;
  OWNED double *T = NULL;
  if (!counts_from_zero(&r->strains.visco->x)) return OK;
  PASS_NEW(T, r->msh->n_elem);
  for (int i = 0; i < 2 * r->m->n.step; ++i) {
    const step *s = &r->m->steps[i / 2];
    const double t = s->start + (i % 2) * s->total;
    if (s->kind != STEP_VISCO) continue;
    if (T0 != NULL) PASS(load_temperature(r->m, r->msh, s, t, T0, T));
    PASS(check_cold(r, i / 2, t, T));
  }
  return OK;
}

status setup_flow(const run *r) {
  return r->strains.visco == NULL ? OK : check_temperatures(r);
}
