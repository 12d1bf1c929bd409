/*
 * The blocks of the initial state and of an increment: solver, solutions of
 * CHECK=, theorems of THEORY= (constants, limits of mu, bounds of CPR98),
 * errors, forces, energies.
 */
#include "output/listing/job.h"

enum { WORST_NODES = 10, DIGITS = 5 /* after the point */ };

/* The node with the largest defect below that of "last"; -1: none. */
static int next_defect(const start_report *s, int n, int last) {
  int next = -1;
  for (int i = 0; i < n; ++i) {
    int after = last < 0 || s->defect[i] < s->defect[last] ||
                (s->defect[i] == s->defect[last] && i > last);
    if (after && (next < 0 || s->defect[i] > s->defect[next])) next = i;
  }
  return next >= 0 && s->defect[next] > 0.0 ? next : -1;
}

status listing_start(const job *j, const start_report *s, text_file *lst) {
  FILE *f = lst->f;
  int node = -1;
  const char *unit = model_unit(j->m, "force");
  fputs("\ninitial state: ", f);
  if (s->source != NULL)
    fprintf(f, "end of %s, time %s\n", s->source,
            text_number(s->source_time, 9));
  else
    fputs("displacements of the deck\n", f);
  fprintf(f, "  %-24s %14s %s\n", "largest force",
          text_number(s->scale, DIGITS), unit);
  fprintf(f, "  %-24s %14s %s\n", "largest defect",
          text_number(s->worst, DIGITS), unit);
  fprintf(f, "  %-24s %14s -\n", "defect, relative",
          text_number(s->ratio, DIGITS));
  fprintf(f, "  %-24s %14d, above %s\n", "nodes out of equilibrium", s->n_bad,
          text_number(start_tolerance, 0));
  for (int k = 0; k < WORST_NODES && k < s->n_bad; ++k) {
    node = next_defect(s, j->msh->n_node, node);
    if (node < 0) break;
    fprintf(f, "  node %-19zu %14s %s: %s\n", j->msh->node_no[node],
            text_number(s->defect[node], DIGITS), unit,
            defect_text(s->kind[node]));
  }
  fprintf(f, "  %s\n",
          s->relaxed     ? "relaxed to the equilibrium of time 0, increment 0"
          : s->n_bad > 0 ? "REFUSED"
                         : "compatible");
  return text_check(lst);
}

static void print_solution(const solution_set *set, int i, FILE *f) {
  const solution_facts *a = &set->found[i].facts;
  fprintf(f, "    %2d  residual %s  open %d  slip %d  stick %d  ", i + 1,
          text_number(a->residual, 1), a->n_open, a->n_slip, a->n_stick);
  fprintf(f, "u_n %s to %s  u_t %s to %s\n", text_number(a->lowest[0], 4),
          text_number(a->highest[0], 4), text_number(a->lowest[1], 4),
          text_number(a->highest[1], 4));
  if (i > 0)
    fprintf(f, "        %s %% of the energy norm away from solution 1\n",
            text_number(100 * a->distance, 2));
  if (a->joined > 0)
    fprintf(f,
            "        all states between solutions %d and %d are solutions: a "
            "continuum\n",
            a->joined, i + 1);
}

/* Nodal values of one solution of an enumeration. */
static void print_values(const state *s, const solution *a, FILE *f) {
  static const char *const words[] = {"OPEN", "SLIP", "STICK"};
  fprintf(f, "        %8s %-6s %12s %12s %12s %12s\n", "node_no", "status",
          "u_n", "u_t", "f_n", "f_t");
  for (int i = 0; i < s->errors.solutions->n; ++i)
    fprintf(f, "        %8zu %-6s %s %s %s %s\n",
            s->contacts.surface->node_no[i], words[a->status[i]],
            text_number(a->u[2 * i], 4), text_number(a->u[2 * i + 1], 4),
            text_number(-a->r[2 * i], 4), text_number(a->r[2 * i + 1], 4));
}

/* The attempts that found solution number i + 1: a line for each solver. */
static void print_finders(const solution_set *set, int i, FILE *f) {
  const char *last = "";
  for (EACH(const solution_attempt, a, set->attempts, set->n_attempt)) {
    if (a->solution_no != i + 1) continue;
    if (strcmp(last, a->solver) != 0)
      fprintf(f, "%s        by %s (%s) from: ", last[0] == '\0' ? "" : "\n",
              a->solver, a->family);
    else
      fputs(", ", f);
    fputs(a->start, f);
    last = a->solver;
  }
  if (last[0] != '\0') fputc('\n', f);
}

static void print_solutions(const state *s, FILE *f) {
  const solution_set *set = s->errors.solutions;
  if (set == NULL) return;
  if (set->n_pattern > 0)
    fprintf(f, "  check: %ld combinations of statuses, ", set->n_pattern);
  else
    fprintf(f, "  check: %d attempts, ", set->n_attempt);
  fprintf(f, "%d solution%s\n", set->n_found, set->n_found == 1 ? "" : "s");
  for (int i = 0; i < set->n_found; ++i) {
    print_solution(set, i, f);
    if (set->n_pattern > 0)
      print_values(s, &set->found[i], f);
    else
      print_finders(set, i, f);
  }
  if (set->n_found > 1) fprintf(f, "    the run goes on with solution 1\n");
  if (set->n_undecided > 0)
    fprintf(f,
            "    %d singular combinations have solutions of unknown extent\n",
            set->n_undecided);
  for (EACH(const solution_attempt, a, set->attempts, set->n_attempt)) {
    if (a->solution_no > 0) continue;
    fprintf(f, "    %s (%s), start %s: %s, residual %s\n", a->solver, a->family,
            a->start, outcome_text(a->outcome), text_number(a->residual, 1));
  }
}

static const char *row_name(const model *m, const theorems_contact *c) {
  return c->contact_id < 0 ? "(all)" : m->contacts[c->contact_id].name;
}

/* The eigenvalues, when they have been found again. */
static void print_constants(const job *j, const theorems_report *t, FILE *f) {
  for (int i = 0; t->fresh && i < t->n_contact; ++i) {
    const theorems_contact *c = &t->contacts[i];
    fprintf(f, "  theory: %s: largest eigenvalues of A_nn %s %s, ",
            row_name(j->m, c), text_number(c->normal, 4),
            model_unit(j->m, "force/length"));
    if (c->tangent < HUGE_VAL)
      fprintf(f, "of inv(A)_tt %s %s\n", text_number(c->tangent, 4),
              model_unit(j->m, "length/force"));
    else
      fputs("inv(A)_tt is not bounded\n", f);
  }
}

static void print_limits(const job *j, const theorems_report *t, FILE *f) {
  if (t->n_contact == 0) return;
  fprintf(f, "  %-20s %12s %12s %12s %12s  %s\n", "theory: contact", "mu[-]",
          "1/C_h[-]", "contraction", "mu/contr.[-]", "mu is");
  for (EACH(const theorems_contact, c, t->contacts, t->n_contact))
    fprintf(f, "  %-20s %12s %12s %12s %12s  %s\n", row_name(j->m, c),
            text_number(c->mu, 4), text_number(c->limit, 4),
            text_number(c->rate, 4),
            c->suggested < HUGE_VAL ? text_number(c->suggested, 4) : "-",
            mu_regime_text(c->regime));
}

static void print_bound(const job *j, const char *what, const theorems_bound *b,
                        FILE *f) {
  if (b->why != NULL) {
    fprintf(f, "  theory: %s: no bound, %s\n", what, b->why);
    return;
  }
  fprintf(f, "  theory: %s: %s <= %s sqrt(%s)  %s\n", what,
          text_number(b->left, 4), text_number(b->right, 4),
          model_unit(j->m, "force*length"), b->violated ? "VIOLATED" : "ok");
}

/* Theorem 3.2: laws that flow under given friction. */
static void print_path(const job *j, const theorems_path *p, FILE *f) {
  static const char *const word[] = {"ok", "ok, but not below 1", "VIOLATED"};
  if (!p->asked) return;
  fputs("  theory: (3.2) stress: ", f);
  if (p->why != NULL)
    fprintf(f, "no rate, %s\n", p->why);
  else
    fprintf(f, "contraction %s <= %s  %s\n", text_number(p->rate, 4),
            text_number(p->bound, 4), word[p->violated ? 2 : p->bound >= 1.0]);
  if (p->bound > 0.0)
    fprintf(f,
            "  theory: (3.2) constant of the laws %s %s, below 1 for dt < %s "
            "%s; over the step after %.0f pass%s\n",
            text_number(p->speed, 4), model_unit(j->m, "1/time"),
            text_number(p->longest, 4), model_unit(j->m, "time"), p->passes,
            p->passes == 1.0 ? "" : "es");
}

static void print_theory(const job *j, const state *s, FILE *f) {
  const theorems_report *t = &s->errors.theorems;
  if (!t->asked) return;
  if (t->has_start && s->total_no == 1)
    fprintf(f, "  theory: (3.8) of the initial state: least %s\n",
            text_number(t->start, 1));
  print_constants(j, t, f);
  print_limits(j, t, f);
  print_bound(j, "(3.9) |u|", &t->total, f);
  print_bound(j, "(3.10) |du|", &t->change, f);
  fprintf(f, "  theory: S_i^n over %d test fields: least %s  %s\n", t->n_field,
          text_number(t->inequality, 1),
          t->inequality_violated ? "VIOLATED" : "ok");
  print_path(j, &t->path, f);
}

static void print_totals(const job *j, const view *v, FILE *f) {
  table t;
  table_choose(&t, PER_CONTACT, PRINT_TOTALS, v, DIGITS);
  if (j->m->n.contact == 0 || t.n == 0) return;
  table_header(&t, j->m, " ", f);
  for (int i = 0; i < j->m->n.contact; ++i) table_row(&t, v, i, f);
}

/* One line per energy; step, increment and time stand above already. */
static void print_energies(const job *j, const view *v, FILE *f) {
  table t;
  table_choose(&t, PER_INCREMENT, PRINT_ENERGY, v, DIGITS);
  for (int k = 0; k < t.n; ++k) {
    const column *c = t.col[k];
    if (strstr(c->unit, "force") == NULL && strstr(c->name, "relative") == NULL)
      continue;
    fprintf(f, "  %-24s %14s %s\n", c->name,
            text_number(c->value(v, 0, c->part), DIGITS),
            model_unit(j->m, c->unit));
  }
}

/* Where the condition number requires it. */
static void print_rounding(const state *s, FILE *f) {
  if (!s->errors.rounding.found) return;
  fprintf(f,
          "  rounding: %s %% of the energy norm, %s %% of the largest stress, "
          "%s %%\n    of the largest displacement\n",
          text_number(100 * s->errors.rounding.energy, 1),
          text_number(100 * s->errors.rounding.stress, 1),
          text_number(100 * s->errors.rounding.u, 1));
}

static void print_error(const job *j, const state *s, FILE *f) {
  const error_bound *e = &s->errors.error;
  if (!e->asked) return;
  fprintf(f, "  error of the solver: ");
  if (e->why != NULL) {
    fprintf(f, "no bound, %s", e->why);
  } else {
    fprintf(f, "at most ");
    if (!isnan(e->relative))
      fprintf(f, "%s %% of the energy norm, ",
              text_number(100 * e->relative, 1));
    fprintf(f, "%s %s", text_number(e->energy, 1),
            model_unit(j->m, "force*length"));
  }
  if (e->rate > 0) fprintf(f, "; contraction %s", text_number(e->rate, 2));
  fputc('\n', f);
}

/* One estimate: "about 1.2E+000 %", or why it is zero or unknown. */
static void print_share(const char *of, const error_share *e, FILE *f) {
  if (!e->asked) return;
  fprintf(f, "  error of the %s: ", of);
  if (isnan(e->relative))
    fputs("unknown", f);
  else
    fprintf(f, "about %s %% of the energy norm",
            text_number(100 * e->relative, 1));
  fprintf(f, "%s%s\n", e->why != NULL ? ", " : "",
          e->why != NULL ? e->why : "");
}

/* Against *REFERENCE, as far as it goes. */
static void print_closed_form(const state *s, FILE *f) {
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
              text_number(100 * part[i].value, 2));
  fputs(n > 0 ? "\n" : "", f);
}

/* TOL=BALANCED: where the solver stopped. */
static void print_balance(const job *j, const state *s, FILE *f) {
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
          "about %.0f iteration%s",
          text_number(100 * b->wanted, 1), text_number(b->tol, 1),
          b->saved_iterations, round(b->saved_iterations) == 1.0 ? "" : "s");
  if (!j->o->no_timing) fprintf(f, ", %.3f s", b->saved_cpu);
  fputc('\n', f);
}

static void print_solver(const job *j, const state *s, FILE *f) {
  const solver_report *r = &s->report;
  if (s->contacts.surface == NULL) return;
  if (j->m->dim > 1)
    fprintf(f, "  contact nodes: open %d, slip %d, stick %d\n",
            s->contacts.n_open, s->contacts.n_slip, s->contacts.n_stick);
  fprintf(f, "  solver %s: %s, iterations %d, limit updates %d, residual %s",
          r->solver != NULL ? r->solver : "-", outcome_text(r->outcome),
          r->iterations, r->limit_updates, text_number(r->residual, 2));
  if (!j->o->no_timing) fprintf(f, ", cpu %.3f s", r->cpu);
  fputc('\n', f);
}

/* What was reached, of jobs without contact too. */
static void print_verdict(const job *j, const state *s, FILE *f) {
  if (s->note != NULL) fputs(s->note, f);
  print_solver(j, s, f);
  print_rounding(s, f);
  if (s->errors.in_doubt && s->errors.error.hidden > 0.1)
    fprintf(f, "  rounding may be %s %% of the contact forces\n",
            text_number(100 * s->errors.error.hidden, 1));
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
  fprintf(f, "\nstep %d  increment %d  time %s  dt %s", s->step_no,
          s->increment_no, text_number(s->t, 9), text_number(s->dt, 9));
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
    print_solutions(s, lst->f);
    print_theory(j, s, lst->f);
    print_totals(j, &v, lst->f);
  }
  print_share("mesh", &s->errors.mesh_error, lst->f);
  print_share("steps", &s->errors.time_error, lst->f);
  print_closed_form(s, lst->f);
  listing_goals_now(j, s, lst->f);
  if (!j->m->problem.given) print_energies(j, &v, lst->f);
  return text_check(lst);
}

status listing_between(const state *s, text_file *lst) {
  fprintf(lst->f, "\nstep %d  within increment %d  time %s  tables%s%s\n",
          s->step_no, s->increment_no, text_number(s->t, 9),
          s->settled ? "" : ", tolerance missed: ",
          s->settled ? "" : outcome_text(s->report.outcome));
  return text_check(lst);
}

status listing_rejected(const state *s, const char *why, text_file *lst) {
  print_when(s, lst->f);
  fprintf(lst->f, "\n  cut: %s\n", why);
  return text_check(lst);
}
