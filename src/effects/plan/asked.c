/*
 * The cards that ask for outputs and forms of a run that are no effect of the
 * model.
 */
#include "effects/plan/rows.h"

static int asks_table(const model *m, int table, char *why, size_t size) {
  static const char *const words[] = {"CONTACT",  "TOTALS", "NODES",
                                      "ELEMENTS", "ENERGY", "REACTIONS",
                                      "ZONES",    "LOOP"};
  int k = 0;
  while (table >> k != 1) ++k;
  for (int i = 0; i < m->n_step; ++i)
    for (int q = 0; q < m->steps[i].n_print; ++q) {
      const print_request *p = &m->steps[i].prints[q];
      if (p->table != table) continue;
      snprintf(why, size, "*PRINT, %s, %s:%d", words[k], PLACE(p->at));
      return 1;
    }
  snprintf(why, size, "no *PRINT, %s", words[k]);
  return 0;
}

static int asks_fields(const model *m, int none, char *why, size_t size) {
  (void)none;
  for (int i = 0; i < m->n_step; ++i) {
    const step *s = &m->steps[i];
    if (s->output_frequency < 0) continue;
    if (s->has_output)
      snprintf(why, size, "*OUTPUT, %s:%d", PLACE(s->output_at));
    else
      snprintf(why, size, "default; *OUTPUT, HDF5=NO leaves them out");
    return 1;
  }
  snprintf(why, size, "*OUTPUT, HDF5=NO");
  return 0;
}

static int asks_condensed(const model *m, int none, char *why, size_t size) {
  (void)none;
  for (int i = 0; i < m->n_step; ++i) {
    const step *s = &m->steps[i];
    if (s->condensed_frequency < 0) continue;
    snprintf(why, size, "*OUTPUT, CONDENSED=FCLIB, %s:%d", PLACE(s->output_at));
    return 1;
  }
  snprintf(why, size, "no *OUTPUT, CONDENSED=FCLIB");
  return 0;
}

static int asks_restart(const model *m, int none, char *why, size_t size) {
  (void)none;
  for (int i = 0; i < m->n_step; ++i) {
    const step *s = &m->steps[i];
    if (s->restart_frequency < 0) continue;
    snprintf(why, size, "*RESTART, %s:%d", PLACE(s->restart_at));
    return 1;
  }
  snprintf(why, size, "no *RESTART card");
  return 0;
}

static int asks_velocity(const model *m, int none, char *why, size_t size) {
  (void)none;
  for (int i = 0; i < m->n_step; ++i) {
    if (m->steps[i].form != FORM_VELOCITY) continue;
    snprintf(why, size, "*QUASISTATIC, FORM=VELOCITY of %s:%d",
             PLACE(m->steps[i].at));
    return 1;
  }
  snprintf(why, size, "no *QUASISTATIC, FORM=VELOCITY");
  return 0;
}

/* Jumps are looked for where friction makes a path of increments. */
static int asks_check(const model *m, int none, char *why, size_t size) {
  (void)none;
  for (int i = 0; i < m->n_step; ++i) {
    const step *s = &m->steps[i];
    if (s->check == CHECK_NONE) continue;
    snprintf(why, size, "*SOLVER, CHECK=, %s:%d", PLACE(s->solver_at));
    return 1;
  }
  for (int i = 0; i < m->n_step && (m->effects & EFFECT_FRICTION); ++i) {
    const step *s = &m->steps[i];
    if (s->kind != STEP_QUASISTATIC) continue;
    snprintf(why, size, "friction in *QUASISTATIC of %s:%d may jump",
             PLACE(s->at));
    return 1;
  }
  snprintf(why, size, "no *SOLVER, CHECK=, no path of friction");
  return 0;
}

static int asks_always(const model *m, int none, char *why, size_t size) {
  (void)m;
  (void)none;
  snprintf(why, size, "always");
  return 1;
}

int asked(asked_kind kind, const model *m, int table, char *why, size_t size) {
  static int (*const asks[])(const model *m, int table, char *why,
                             size_t size) = {
      [ASKED_ALWAYS] = asks_always,   [ASKED_TABLE] = asks_table,
      [ASKED_FIELDS] = asks_fields,   [ASKED_CONDENSED] = asks_condensed,
      [ASKED_RESTART] = asks_restart, [ASKED_VELOCITY] = asks_velocity,
      [ASKED_CHECK] = asks_check};
  return asks[kind](m, table, why, size);
}
