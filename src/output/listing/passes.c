/*
 * The passes towards the targets of *ACCURACY and *GOAL: what each had as
 * errors and seconds, and what it changed next.
 */
#include "output/listing/parts.h"

#include <math.h>

/* Of a goal, %: of its value, or where its target is not in %. */
double pass_goal_percent(const pass_goal *g) {
  return 100.0 * g->off / fabs(g->found.value + g->found.error);
}

static int is_absolute(const goal_card *g) {
  return g->target > 0.0 && !g->in_percent;
}

void passes_goal_heads(const model *m, FILE *f) {
  for (int i = 0; i < m->n.goal; ++i) {
    char head[80], unit[64] = "%";
    if (is_absolute(&m->accuracy.goals[i]))
      job_goal_unit(m, i, unit, sizeof unit);
    snprintf(head, sizeof head, "%s[%s]", m->accuracy.goals[i].name, unit);
    fprintf(f, " %10s", head);
  }
}

void passes_goals(const model *m, const pass_goal *goals, int pass, FILE *f) {
  for (int i = 0; i < m->n.goal; ++i) {
    const pass_goal *g = &goals[pass * m->n.goal + i];
    char number[NUMBER_SIZE], head[80], unit[64] = "%";
    const int absolute = is_absolute(&m->accuracy.goals[i]);
    if (absolute) job_goal_unit(m, i, unit, sizeof unit);
    const int width =
        snprintf(head, sizeof head, "%s[%s]", m->accuracy.goals[i].name, unit);
    fprintf(f, " %*s", width > 10 ? width : 10,
            text_number(number, absolute ? g->off : pass_goal_percent(g), 2));
  }
}

/* Errors in the energy norm, where they have a target. */
static void print_norm(const pass_row *r, int is_pass, FILE *f) {
  char number[4][NUMBER_SIZE];
  if (is_pass)
    fprintf(f, " %10s %10s %10s", text_number(number[0], r->mesh, 2),
            text_number(number[1], r->time, 2),
            text_number(number[2], r->solver, 2));
  else
    fprintf(f, " %10s %10s %10s", "", "", "");
  fprintf(f, " %10s", text_number(number[3], r->total, 2));
}

static void print_pass(const job *j, int no, FILE *f) {
  const pass_table *t = &j->run->passes;
  const pass_row *r = &t->rows[no - 1];
  fprintf(f, "  %-10d %10.0f", no, r->unknowns);
  if (t->target > 0.0) print_norm(r, 1, f);
  if (t->goals != NULL) passes_goals(j->m, t->goals, no - 1, f);
  if (!j->o->no_timing) fprintf(f, " %9.3g", r->cpu);
  fprintf(f, "  %s\n", r->change);
}

static void print_forecast(const job *j, FILE *f) {
  const pass_table *t = &j->run->passes;
  fprintf(f, "  %-10s %10.0f", "next digit", t->forecast->unknowns);
  if (t->target > 0.0) print_norm(t->forecast, 0, f);
  for (int i = 0; t->goals != NULL && i < j->m->n.goal; ++i)
    fprintf(f, " %10s", "");
  if (!j->o->no_timing) fprintf(f, " %9.3g", t->forecast->cpu);
  fprintf(f, "  forecast\n");
}

/* "target 1 % of the energy norm, 2 % of PEAK: reached" */
static void print_targets(const job *j, FILE *f) {
  const pass_table *t = &j->run->passes;
  const char *comma = "";
  fprintf(f, "\n  target ");
  if (t->target > 0.0) {
    fprintf(f, "%g %% of the energy norm", t->target);
    comma = ", ";
  }
  for (int i = 0; i < j->m->n.goal; ++i) {
    const goal_card *g = &j->m->accuracy.goals[i];
    char unit[64] = "% of";
    if (!(g->target > 0.0)) continue;
    if (!g->in_percent) job_goal_unit(j->m, i, unit, sizeof unit);
    fprintf(f, "%s%g %s %s", comma, g->target, unit, g->name);
    comma = ", ";
  }
  fprintf(f, ": %s\n", t->why[0] == '\0' ? "reached" : "missed");
}

void listing_passes(const job *j, FILE *f) {
  const pass_table *t = &j->run->passes;
  if (t->n == 0) return;
  print_targets(j, f);
  fprintf(f, "  %-10s %10s", "pass", "unknowns");
  if (t->target > 0.0)
    fprintf(f, " %10s %10s %10s %10s", "mesh[%]", "steps[%]", "solver[%]",
            "total[%]");
  if (t->goals != NULL) passes_goal_heads(j->m, f);
  if (!j->o->no_timing) fprintf(f, " %9s", "cpu[s]");
  fprintf(f, "  changed next\n");
  for (int i = 0; i < t->n; ++i) print_pass(j, i + 1, f);
  if (t->forecast != NULL) print_forecast(j, f);
  if (t->goals != NULL)
    fputs(
        "  of goals: |error| + band + |error of the solver|, the first two "
        "twice where\n  the estimate is not reliable for the contact ends\n",
        f);
}
