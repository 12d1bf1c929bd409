/*
 * JOB.sta: one line per attempt at an increment, for tail -f and scripts.
 * JOB.cvg: one line per contact iteration.
 * The line on the terminal, and those at the end.
 */
#include "output/writers.h"

status sta_header(const output_options *o, text_file *sta) {
  fprintf(sta->f,
          "%-6s %5s %3s %11s %11s %7s %7s %7s %-9s %7s %10s %9s %9s %9s",
          "#step", "inc", "att", "time", "dt", "open", "slip", "stick",
          "solver", "iter", "residual", "mesh[%]", "steps[%]", "error[%]");
  if (!o->no_timing) fprintf(sta->f, " %9s", "cpu[s]");
  fprintf(sta->f, " reason\n");
  return text_check(sta);
}

/* What CHECK= found, after the reason. */
static const char *check_text(const state *s, char text[32]) {
  text[0] = '\0';
  if (s->errors.solutions == NULL) return text;
  if (s->errors.solutions->n_found > 1)
    snprintf(text, 32, " SOLUTIONS=%d", s->errors.solutions->n_found);
  else if (!solution_set_confirmed(s->errors.solutions))
    snprintf(text, 32, " UNCONFIRMED");
  return text;
}

/*
 * OK (JUMP; AFTER_UNSETTLED: solved, but from a history that holds one that is
 * not), UNSETTLED (taken although it did not converge) or CUT, then the code of
 * the outcome of the contact solver, BOUND if its error may be above 10 %, then
 * words.
 */
static void print_reason(const state *s, const char *why, FILE *f) {
  char check[32];
  outcome o = s->report.outcome;
  const char *code = o < 0                ? outcome_code(o)
                     : s->errors.in_doubt ? "BOUND"
                                          : "";
  const char *blank = code[0] != '\0' ? " " : "";
  if (why != NULL)
    fprintf(f, " CUT%s%s %s\n", blank, code, why);
  else if (!s->settled)
    fprintf(f, " UNSETTLED%s%s%s\n", blank, code, check_text(s, check));
  else
    fprintf(f, " OK%s%s%s\n", s->errors.jumps ? " JUMP" : "",
            s->errors.after_miss ? " AFTER_UNSETTLED" : "",
            check_text(s, check));
}

/* An estimate in %, "-": not required, or unknown. */
static const char *share_text(int asked, double relative) {
  return !asked || isnan(relative) ? "-" : text_number(100 * relative, 1);
}

status sta_line(const output_options *o, const state *s, const char *why,
                text_file *sta) {
  const solver_report *r = &s->report;
  const state_errors *e = &s->errors;
  fprintf(sta->f, "%6d %5d %3d %11s %11s %7d %7d %7d %-9s %7d %10s %9s %9s %9s",
          s->step_no, s->increment_no, s->attempt, text_number(s->t, 4),
          text_number(s->dt, 4), s->contacts.n_open, s->contacts.n_slip,
          s->contacts.n_stick, r->solver != NULL ? r->solver : "-",
          r->iterations, text_number(r->residual, 3),
          share_text(e->mesh_error.asked, e->mesh_error.relative),
          share_text(e->time_error.asked, e->time_error.relative),
          share_text(e->error.asked, e->error.relative));
  if (!o->no_timing) fprintf(sta->f, " %9.3f", s->cpu);
  print_reason(s, why, sta->f);
  return text_check(sta);
}

void cvg_header(const output_options *o, text_file *cvg) {
  fprintf(cvg->f, "%-7s %3s %-9s %6s %6s %10s %8s %12s %5s %10s %10s %6s",
          "#total", "att", "solver", "iter", "limit", "residual", "changes",
          "limit_change", "cycle", "unknowns", "entries", "solves");
  fprintf(cvg->f, "%s\n", o->no_timing ? "" : "    cpu[s]");
}

/* The linear system of an iteration, or "-" in each column. */
static void cvg_linear(const output_options *o, const linear_work *w,
                       text_file *cvg) {
  if (w->unknowns > 0.0)
    fprintf(cvg->f, " %10.0f %10.0f %6d", w->unknowns, w->entries, w->solves);
  else
    fprintf(cvg->f, " %10s %10s %6s", "-", "-", "-");
  if (!o->no_timing && w->unknowns > 0.0)
    fprintf(cvg->f, " %9.6f", w->cpu);
  else if (!o->no_timing)
    fprintf(cvg->f, " %9s", "-");
  fputc('\n', cvg->f);
}

static const char *cvg_number(double value) {
  return isnan(value) ? "-" : text_number(value, 3);
}

/* Unknown values are "-". */
void cvg_line(const output_options *o, cvg_place at, const solver_step *s,
              text_file *cvg) {
  const int changes = s->status_changes;
  fprintf(cvg->f, "%7d %3d %-9s %6d %6d %10s %8s %12s %5s", at.total_no,
          at.attempt, s->solver != NULL ? s->solver : "-", s->iteration,
          s->limit_update, cvg_number(s->residual),
          changes < 0 ? "-" : text_of("%d", changes),
          cvg_number(s->limit_change), s->cycle ? "YES" : "no");
  cvg_linear(o, &s->linear, cvg);
}

void cvg_end(int total_no, int attempt, const state *s, text_file *cvg) {
  if (s->contacts.surface == NULL) return;
  fprintf(cvg->f, "# total %d att %d ended: %s %s (%s), residual %s\n",
          total_no, attempt, s->report.solver != NULL ? s->report.solver : "-",
          outcome_code(s->report.outcome), outcome_text(s->report.outcome),
          text_number(s->report.residual, 3));
}

void progress_line(const char *text) {
  fprintf(stderr, "\r%s\033[K", text);
  fflush(stderr);
}

/* Increments after this one: of its step at its dt, of the steps after it. */
static double increments_left(const model *m, const state *s) {
  const step *now = &m->steps[s->step_no - 1];
  double n = step_increments_left(now, s->t, s->dt, s->increment_no);
  if (s->end_of_step || !(now->start + now->total - s->t > 1e-9 * now->total))
    n = 0.0;
  for (int i = s->step_no; i < m->n.step; ++i)
    n += step_increments(&m->steps[i]);
  return n;
}

void progress_show(const model *m, const state *s, double seconds, int done) {
  char text[160];
  const double left = increments_left(m, s), rest = seconds / done * left;
  const char *unit = rest < 120 ? "s" : rest < 7200 ? "min" : "h";
  const double per = rest < 120 ? 1 : rest < 7200 ? 60 : 3600;
  snprintf(text, sizeof text,
           "step %d of %d, time %.4g, increment %d of %.0f, %.0f %s left",
           s->step_no, m->n.step, s->t, s->total_no, s->total_no + left,
           ceil(rest / per), unit);
  progress_line(text);
}

enum { MOST_SHOWN = 20 }; /* contacts */

/* The unit with a blank before it; nothing if *UNITS gives it no label. */
static const char *unit_after(const char *unit, const model *m) {
  const char *label = model_unit(m, unit);
  return strcmp(label, unit) == 0 ? "" : text_of(" %s", label);
}

/* A contact at the last increment: the values of job_end_column. */
static const double *close_contact(const job *j, int id, const double *value,
                                   FILE *f) {
  fprintf(f, "%-9s ", j->m->contacts[id].name);
  const char *before = "";
  const column *c;
  for (column_walk w = columns_of(PER_CONTACT);
       (c = job_end_column(j->m, &w)) != NULL; ++value)
    if (strncmp(c->name, "force_", 6) == 0 || c->form == AS_COUNT) {
      fprintf(f, "%s%s %.6g%s", before, c->name, *value,
              unit_after(c->unit, j->m));
      before = ", ";
    }
  fputc('\n', f);
  return value;
}

static void close_contacts(const job *j, FILE *f) {
  const run_summary *run = j->run;
  const increment_summary *last = &run->increments[run->n_increment - 1];
  const int shown = j->m->n.contact < MOST_SHOWN ? j->m->n.contact : MOST_SHOWN;
  const double *value =
      run->ends + (last->step_no - 1) * job_end_size(j->m) + 2;
  for (int i = 0; i < shown; ++i) value = close_contact(j, i, value, f);
  if (shown < j->m->n.contact)
    fprintf(f, "%-9s and %d more in JOB.json\n", "", j->m->n.contact - shown);
  if (shown == 0)
    fprintf(f, "%-9s open %d, slip %d, stick %d\n", "contact", last->count.open,
            last->count.slip, last->count.stick);
}

static void close_goals(const job *j, FILE *f) {
  for (int i = 0; i < j->m->n.goal && job_goal(j, i) != NULL; ++i) {
    const goal_result *g = job_goal(j, i);
    fprintf(f, "%-9s ", j->m->accuracy.goals[i].name);
    if (!isnan(g->value))
      fprintf(f, "%.7g %s, ", g->value, model_goal_unit(j->m, i));
    if (!isnan(g->error))
      fprintf(f, "error %.2g: %.7g within %.1g, ", g->error,
              g->value + g->error, g->band);
    fprintf(f, "%s\n", goal_verdict_text(g->verdict));
  }
}

/* The worst of the estimates; "-": not required, or unknown. */
static void close_errors(const job *j, FILE *f) {
  static const char *const names[] = {"mesh", "steps", "solver"};
  budget_row rows[BUDGET_ROWS];
  const int n = job_budget(j, rows);
  fprintf(f, "%-9s ", "error");
  for (int k = 0; k < 3; ++k) {
    double worst = NAN;
    for (int i = 0; i < n; ++i)
      if (strcmp(rows[i].name, names[k]) == 0) worst = rows[i].worst;
    fprintf(f, k > 0 ? ", %s " : "%s ", names[k]);
    fprintf(f, isnan(worst) ? "-" : "%.2g %%", worst);
  }
  fputs(" of the energy norm\n", f);
  char advice[ADVICE_SIZE];
  job_advice(j, advice, sizeof advice);
  if (advice[0] != '\0') fprintf(f, "%-9s %s\n", "next", advice);
}

void closing_lines(const job *j, const char *files, FILE *f) {
  const run_summary *run = j->run;
  fprintf(f, "%-9s %s\n%-9s %d: %s; increments %d, attempts cut %d\n",
          "results", files, "exit", status_exit_code(run->verdict),
          run->verdict == OK ? "done" : status_text(run->verdict),
          run->n_increment, run->n_rejected);
  if (run->n_increment > 0) {
    close_contacts(j, f);
    fprintf(f, "%-9s residual %.1e, penetration %.2g%s\n", "worst",
            run->residual_worst, run->penetration_worst,
            unit_after("length", j->m));
    close_goals(j, f);
    close_errors(j, f);
  }
  fprintf(f, "%-9s %.2f s CPU, %.1f MB of arrays\n", "cost", timer_cpu(),
          1e-6 * (double)memory_peak());
}
