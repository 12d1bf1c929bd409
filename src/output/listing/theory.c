/*
 * THEORY= of *ACCURACY: constants, limits of mu, bounds of CPR98.
 */
#include "output/listing/parts.h"

#include <math.h>

static const char *row_name(const model *m, const theorems_contact *c) {
  return c->contact_id < 0 ? "(all)" : m->contacts[c->contact_id].name;
}

/* The eigenvalues, when they have been found again. */
static void print_constants(const job *j, const theorems_report *t, FILE *f) {
  char text[2][NUMBER_SIZE], stiff[64], soft[64];
  column_unit("force/length", j->m, stiff, sizeof stiff);
  column_unit("length/force", j->m, soft, sizeof soft);
  for (int i = 0; t->fresh && i < t->n_contact; ++i) {
    const theorems_contact *c = &t->contacts[i];
    fprintf(f, "  theory: %s: largest eigenvalues of A_nn %s %s, ",
            row_name(j->m, c), text_number(text[0], c->normal, 4), stiff);
    if (c->tangent < HUGE_VAL)
      fprintf(f, "of inv(A)_tt %s %s\n", text_number(text[1], c->tangent, 4),
              soft);
    else
      fputs("inv(A)_tt is not bounded\n", f);
  }
}

static void print_limits(const job *j, const theorems_report *t, FILE *f) {
  char text[4][NUMBER_SIZE];
  if (t->n_contact == 0) return;
  fprintf(f, "  %-20s %12s %12s %12s %12s  %s\n", "theory: contact", "mu[-]",
          "1/C_h[-]", "contraction", "mu/contr.[-]", "mu is");
  for (int i = 0; i < t->n_contact; ++i) {
    const theorems_contact *c = &t->contacts[i];
    fprintf(
        f, "  %-20s %12s %12s %12s %12s  %s\n", row_name(j->m, c),
        text_number(text[0], c->mu, 4), text_number(text[1], c->limit, 4),
        text_number(text[2], c->rate, 4),
        c->suggested < HUGE_VAL ? text_number(text[3], c->suggested, 4) : "-",
        mu_regime_text(c->regime));
  }
}

static void print_bound(const job *j, const char *what, const theorems_bound *b,
                        FILE *f) {
  char text[2][NUMBER_SIZE], unit[64];
  if (b->why != NULL) {
    fprintf(f, "  theory: %s: no bound, %s\n", what, b->why);
    return;
  }
  column_unit("force*length", j->m, unit, sizeof unit);
  fprintf(f, "  theory: %s: %s <= %s sqrt(%s)  %s\n", what,
          text_number(text[0], b->left, 4), text_number(text[1], b->right, 4),
          unit, b->violated ? "VIOLATED" : "ok");
}

/* Theorem 3.2: laws that flow under given friction. */
static void print_path(const job *j, const theorems_path *p, FILE *f) {
  static const char *const word[] = {"ok", "ok, but not below 1", "VIOLATED"};
  char text[2][NUMBER_SIZE], unit[64], time[64];
  if (!p->asked) return;
  column_unit("1/time", j->m, unit, sizeof unit);
  column_unit("time", j->m, time, sizeof time);
  fputs("  theory: (3.2) stress: ", f);
  if (p->why != NULL)
    fprintf(f, "no rate, %s\n", p->why);
  else
    fprintf(f, "contraction %s <= %s  %s\n", text_number(text[0], p->rate, 4),
            text_number(text[1], p->bound, 4),
            word[p->violated ? 2 : p->bound >= 1.0]);
  if (p->bound > 0.0)
    fprintf(f,
            "  theory: (3.2) constant of the laws %s %s, below 1 for dt < %s "
            "%s; over the step after %.0f passes\n",
            text_number(text[0], p->speed, 4), unit,
            text_number(text[1], p->longest, 4), time, p->passes);
}

void listing_theory(const job *j, const state *s, FILE *f) {
  char text[NUMBER_SIZE];
  const theorems_report *t = &s->errors.theorems;
  if (!t->asked) return;
  if (t->has_start && s->total_no == 1)
    fprintf(f, "  theory: (3.8) of the initial state: least %s\n",
            text_number(text, t->start, 1));
  print_constants(j, t, f);
  print_limits(j, t, f);
  print_bound(j, "(3.9) |u|", &t->total, f);
  print_bound(j, "(3.10) |du|", &t->change, f);
  fprintf(f, "  theory: S_i^n over %d test fields: least %s  %s\n", t->n_field,
          text_number(text, t->inequality, 1),
          t->inequality_violated ? "VIOLATED" : "ok");
  print_path(j, &t->path, f);
}
