/*
 * The block of an increment: solver, errors, forces, energies.
 */
#include "output/listing/parts.h"

#include <math.h>
#include <string.h>

static void print_totals(const job *j, const view *v, FILE *f) {
  table t;
  table_choose(&t, PER_CONTACT, PRINT_TOTALS, v, DIGITS);
  if (j->m->n.contact == 0 || t.n == 0) return;
  table_header(&t, j->m, " ", f);
  for (int i = 0; i < j->m->n.contact; ++i) table_row(&t, v, i, f);
}

/* One line per energy; step, increment and time stand above already. */
static void print_energies(const job *j, const view *v, FILE *f) {
  char text[NUMBER_SIZE], unit[64];
  table t;
  table_choose(&t, PER_INCREMENT, PRINT_ENERGY, v, DIGITS);
  for (int k = 0; k < t.n; ++k) {
    const column *c = t.col[k];
    if (strstr(c->unit, "force") == NULL && strstr(c->name, "relative") == NULL)
      continue;
    column_unit(c->unit, j->m, unit, sizeof unit);
    fprintf(f, "  %-24s %14s %s\n", c->name,
            text_number(text, c->value(v, 0, c->part), DIGITS), unit);
  }
}

/* Where the condition number requires it. */
static void print_rounding(const state *s, FILE *f) {
  char norm[NUMBER_SIZE], stress[NUMBER_SIZE], u[NUMBER_SIZE];
  if (!s->errors.rounding.found) return;
  fprintf(f,
          "  rounding: %s %% of the energy norm, %s %% of the largest stress, "
          "%s %%\n    of the largest displacement\n",
          text_number(norm, 100 * s->errors.rounding.energy, 1),
          text_number(stress, 100 * s->errors.rounding.stress, 1),
          text_number(u, 100 * s->errors.rounding.u, 1));
}

static void print_hidden(const state *s, FILE *f) {
  char text[NUMBER_SIZE];
  if (s->errors.in_doubt && s->errors.error.hidden > 0.1)
    fprintf(f, "  rounding of the motion may be %s %% of the contact forces\n",
            text_number(text, 100 * s->errors.error.hidden, 1));
}

static void print_error(const job *j, const state *s, FILE *f) {
  char text[NUMBER_SIZE], unit[64];
  const error_bound *e = &s->errors.error;
  if (!e->asked) return;
  fprintf(f, "  error of the solver: ");
  if (e->why != NULL) {
    fprintf(f, "no bound, %s", e->why);
  } else {
    column_unit("force*length", j->m, unit, sizeof unit);
    fprintf(f, "at most ");
    if (!isnan(e->relative))
      fprintf(f, "%s %% of the energy norm, ",
              text_number(text, 100 * e->relative, 1));
    fprintf(f, "%s %s", text_number(text, e->energy, 1), unit);
  }
  if (e->rate > 0)
    fprintf(f, "; contraction %s", text_number(text, e->rate, 2));
  fputc('\n', f);
}

/* One estimate: "about 1.2E+000 %", or why it is zero or unknown. */
static void print_share(const char *of, const error_share *e, FILE *f) {
  char text[NUMBER_SIZE];
  if (!e->asked) return;
  fprintf(f, "  error of the %s: ", of);
  if (isnan(e->relative))
    fputs("unknown", f);
  else
    fprintf(f, "about %s %% of the energy norm",
            text_number(text, 100 * e->relative, 1));
  fprintf(f, "%s%s\n", e->why != NULL ? ", " : "",
          e->why != NULL ? e->why : "");
}

/* Against *REFERENCE, as far as it goes. */
static void print_truth(const state *s, FILE *f) {
  char text[NUMBER_SIZE];
  const true_error *e = &s->errors.exact;
  const struct {
    const char *text;
    double value;
  } part[] = {{"energy norm", e->energy},
              {"displacement", e->displacement},
              {"stress", e->stress},
              {"contact pressure", e->pressure}};
  int n = 0;
  if (!e->asked) return;
  for (size_t i = 0; i < sizeof part / sizeof *part; ++i)
    if (!isnan(part[i].value))
      fprintf(f, "%s%s %s %%", n++ > 0 ? ", " : "  true error: ", part[i].text,
              text_number(text, 100 * part[i].value, 2));
  fputs(n > 0 ? "\n" : "", f);
}

/* TOL=BALANCED: where the solver stopped. */
static void print_balance(const job *j, const state *s, FILE *f) {
  char text[2][NUMBER_SIZE];
  const balance_report *b = &s->errors.balance;
  if (!b->asked) return;
  if (isnan(b->wanted)) {
    fprintf(f,
            "  balanced: the error of the solver has no bound, solved to "
            "the default\n");
    return;
  }
  fprintf(f,
          "  balanced: %s %% is enough, stopped below residual %s; saved "
          "about %.0f iterations",
          text_number(text[0], 100 * b->wanted, 1),
          text_number(text[1], b->tol, 1), b->saved_iterations);
  if (!j->o->no_timing) fprintf(f, ", %.3f s", b->saved_cpu);
  fputc('\n', f);
}

static void print_solver(const job *j, const state *s, FILE *f) {
  char text[NUMBER_SIZE];
  const solver_report *r = &s->report;
  if (s->contacts.surface == NULL) return;
  if (j->m->dim > 1)
    fprintf(f, "  contact nodes: open %d, slip %d, stick %d\n",
            s->contacts.n_open, s->contacts.n_slip, s->contacts.n_stick);
  fprintf(f, "  solver %s: %s, iterations %d, limit updates %d, residual %s",
          r->solver != NULL ? r->solver : "-", outcome_text(r->outcome),
          r->iterations, r->limit_updates, text_number(text, r->residual, 2));
  if (!j->o->no_timing) fprintf(f, ", cpu %.3f s", r->cpu);
  fputc('\n', f);
}

/* What was reached, of jobs without contact too. */
static void print_verdict(const job *j, const state *s, FILE *f) {
  if (s->note != NULL) fputs(s->note, f);
  print_solver(j, s, f);
  print_rounding(s, f);
  print_hidden(s, f);
  print_error(j, s, f);
  print_balance(j, s, f);
  if (s->solver_log != NULL && s->solver_log[0] != '\0')
    fprintf(f, "  tried: %s\n", s->solver_log);
  if (s->errors.in_doubt)
    fprintf(f, "  THE ERROR OF THE SOLVER MAY BE ABOVE 10 %%\n");
  else if (!s->settled)
    fprintf(f, "  THE TOLERANCE WAS NOT REACHED\n");
  if (s->errors.after_miss)
    fprintf(f,
            "  AN INCREMENT BEFORE, FROM WHICH THIS ONE GOES ON, DID NOT "
            "CONVERGE\n");
}

static void print_when(const state *s, FILE *f) {
  char t[NUMBER_SIZE], dt[NUMBER_SIZE];
  fprintf(f, "\nstep %d  increment %d  time %s  dt %s", s->step_no,
          s->increment_no, text_number(t, s->t, 9), text_number(dt, s->dt, 9));
  if (s->attempt > 1) fprintf(f, "  attempt %d", s->attempt);
}

status listing_increment(const job *j, const state *s, text_file *lst) {
  view v = {j->m, j->msh, s};
  print_when(s, lst->f);
  fputc('\n', lst->f);
  if (s->body.flow != NULL && s->increment_no == 1 &&
      j->m->steps[s->step_no - 1].kind != STEP_VISCO)
    fputs("  no inelastic strain grows in this step: it is not *VISCO\n",
          lst->f);
  print_verdict(j, s, lst->f);
  if (s->contacts.surface != NULL) {
    listing_solutions(s, lst->f);
    listing_theory(j, s, lst->f);
    print_totals(j, &v, lst->f);
  }
  print_share("mesh", &s->errors.mesh_error, lst->f);
  print_share("steps", &s->errors.time_error, lst->f);
  print_truth(s, lst->f);
  listing_goals_now(j, s, lst->f);
  if (!j->m->problem.given) print_energies(j, &v, lst->f);
  return text_check(lst);
}

status listing_between(const state *s, text_file *lst) {
  char t[NUMBER_SIZE];
  fprintf(lst->f, "\nstep %d  within increment %d  time %s  tables%s%s\n",
          s->step_no, s->increment_no, text_number(t, s->t, 9),
          s->settled ? "" : ", tolerance missed: ",
          s->settled ? "" : outcome_text(s->report.outcome));
  return text_check(lst);
}

status listing_rejected(const state *s, const char *why, text_file *lst) {
  print_when(s, lst->f);
  fprintf(lst->f, "\n  cut: %s\n", why);
  return text_check(lst);
}
