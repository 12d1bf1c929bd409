/*
 * The goals of an increment, and those of the last one of the run.
 */
#include "output/listing/parts.h"

#include "output/columns/columns.h"

#include <math.h>

const char *job_goal_unit(const model *m, int id, char *text, size_t size) {
  column_unit(goal_unit(&m->accuracy.goals[id]), m, text, size);
  return text;
}

const goal_result *job_goal(const job *j, int id) {
  const run_summary *run = j->run;
  if (run->n_increment == 0 || run->goals == NULL) return NULL;
  const int last = run->increments[run->n_increment - 1].step_no - 1;
  return &run->goals[last * j->m->n.goal + id];
}

static void print_goal(const job *j, int id, const goal_result *g, int cost,
                       FILE *f) {
  char value[NUMBER_SIZE], error[NUMBER_SIZE], band[NUMBER_SIZE];
  char corrected[NUMBER_SIZE], solver[NUMBER_SIZE], unit[64];
  fprintf(f, "  %-16s %14s", j->m->accuracy.goals[id].name,
          text_number(value, g->value, 6));
  if (!isnan(g->error))
    fprintf(f, " %12s %14s %10s %10s %6.2g", text_number(error, g->error, 3),
            text_number(corrected, g->value + g->error, 6),
            text_number(band, g->band, 1), text_number(solver, g->solver, 1),
            100 * g->ends);
  else
    fprintf(f, " %12s %14s %10s %10s %6s", "-", "-", "-", "-", "-");
  if (cost) fprintf(f, " %9.3f", g->cpu);
  fprintf(f, "  %s; %s\n", job_goal_unit(j->m, id, unit, sizeof unit),
          goal_verdict_text(g->verdict));
}

static void print_heading(int cost, FILE *f) {
  fprintf(f, "  %-16s %14s %12s %14s %10s %10s %6s", "goal", "value", "error",
          "corrected", "band", "solver", "ends%");
  if (cost) fprintf(f, " %9s", "cpu[s]");
  fputs("  unit; verdict\n", f);
}

void listing_goals_now(const job *j, const state *s, FILE *f) {
  if (s->errors.goals == NULL) return;
  print_heading(0, f);
  for (int i = 0; i < s->errors.n_goal; ++i)
    print_goal(j, i, &s->errors.goals[i], 0, f);
}

void listing_goals(const job *j, FILE *f) {
  const int cost = !j->o->no_timing;
  if (j->m->n.goal == 0 || job_goal(j, 0) == NULL) return;
  fputc('\n', f);
  print_heading(cost, f);
  for (int i = 0; i < j->m->n.goal; ++i)
    print_goal(j, i, job_goal(j, i), cost, f);
}
