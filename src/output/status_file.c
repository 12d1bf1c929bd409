/*
 * JOB.sta: one line per attempt at an increment, for tail -f and scripts.
 * JOB.cvg: one line per contact iteration.
 * The line on the terminal.
 */
#include "output/writers.h"

#include <math.h>

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
 * OK, OK JUMP, UNSETTLED (taken although it did not converge) or CUT, then
 * the code of what stopped the contact solver, BOUND if its error may be above
 * 10 %, then words.
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
    fprintf(f, " OK%s%s\n", s->errors.jumps ? " JUMP" : "",
            check_text(s, check));
}

/* Error of the solver in %, "-": not asked for, or no bound. */
static const char *error_text(const state *s, char text[NUMBER_SIZE]) {
  if (!s->errors.error.asked || isnan(s->errors.error.relative)) return "-";
  return text_number(text, 100 * s->errors.error.relative, 1);
}

/* An estimate in %, "-": not asked for, or unknown. */
static const char *share_text(const error_share *e, char text[NUMBER_SIZE]) {
  if (!e->asked || isnan(e->relative)) return "-";
  return text_number(text, 100 * e->relative, 1);
}

status sta_line(const output_options *o, const state *s, const char *why,
                text_file *sta) {
  char t[NUMBER_SIZE], dt[NUMBER_SIZE], residual[NUMBER_SIZE];
  char error[NUMBER_SIZE], in_mesh[NUMBER_SIZE], in_steps[NUMBER_SIZE];
  const solver_report *r = &s->report;
  fprintf(sta->f, "%6d %5d %3d %11s %11s %7d %7d %7d %-9s %7d %10s %9s %9s %9s",
          s->step_no, s->increment_no, s->attempt, text_number(t, s->t, 4),
          text_number(dt, s->dt, 4), s->contacts.n_open, s->contacts.n_slip,
          s->contacts.n_stick, r->solver != NULL ? r->solver : "-",
          r->iterations, text_number(residual, r->residual, 3),
          share_text(&s->errors.mesh_error, in_mesh),
          share_text(&s->errors.time_error, in_steps), error_text(s, error));
  if (!o->no_timing) fprintf(sta->f, " %9.3f", s->cpu);
  print_reason(s, why, sta->f);
  return text_check(sta);
}

void cvg_header(text_file *cvg) {
  fprintf(cvg->f, "%-7s %3s %-9s %6s %6s %10s %8s %12s %5s\n", "#total", "att",
          "solver", "iter", "limit", "residual", "changes", "limit_change",
          "cycle");
}

/* Unknown values are "-". */
void cvg_line(int total_no, int attempt, const solver_step *s, text_file *cvg) {
  char residual[NUMBER_SIZE] = "-", change[NUMBER_SIZE] = "-";
  char changes[16] = "-";
  if (!isnan(s->residual)) text_number(residual, s->residual, 3);
  if (!isnan(s->limit_change)) text_number(change, s->limit_change, 3);
  if (s->status_changes >= 0)
    snprintf(changes, sizeof changes, "%d", s->status_changes);
  fprintf(cvg->f, "%7d %3d %-9s %6d %6d %10s %8s %12s %5s\n", total_no, attempt,
          s->solver != NULL ? s->solver : "-", s->iteration, s->limit_update,
          residual, changes, change, s->cycle ? "YES" : "no");
}

void cvg_end(int total_no, int attempt, const state *s, text_file *cvg) {
  char residual[NUMBER_SIZE];
  if (s->contacts.surface == NULL) return;
  fprintf(cvg->f, "# total %d att %d ended: %s %s (%s), residual %s\n",
          total_no, attempt, s->report.solver != NULL ? s->report.solver : "-",
          outcome_code(s->report.outcome), outcome_text(s->report.outcome),
          text_number(residual, s->report.residual, 3));
}

void progress_line(const char *text) {
  fprintf(stderr, "\r%s\033[K", text);
  fflush(stderr);
}

void progress_show(const state *s) {
  char text[160];
  snprintf(text, sizeof text,
           "step %d  increment %d  time %.4g  open %d  slip %d  stick %d  "
           "iterations %d  residual %.1e",
           s->step_no, s->increment_no, s->t, s->contacts.n_open,
           s->contacts.n_slip, s->contacts.n_stick, s->report.iterations,
           s->report.residual);
  progress_line(text);
}
