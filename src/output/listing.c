/*
 * JOB.lst: the listing. Deck with defaults, model, effect plan, one block per
 * increment, accuracy and cost. No date, time of day or path stands in it; the
 * cost columns (CPU seconds and bytes, which depend on the length of names)
 * are left out on request, and then two runs give the same bytes.
 */
#include "base/timer.h"
#include "output/writers.h"

#include <math.h>
#include <string.h>

enum { DIGITS = 5, WORST_NODES = 10 };

static void heading(FILE *f, const char *text) {
  fprintf(f, "\n%s\n", text);
  for (size_t i = 0; i < strlen(text); ++i) fputc('-', f);
  fputc('\n', f);
}

/* Those known before the equations, or those after. */
static void print_sizes(const job *j, int equations, FILE *f) {
  size_row rows[SIZE_ROWS];
  int known = job_sizes(j, rows);
  for (int i = equations ? known : 0; rows[i].name != NULL; ++i)
    fprintf(f, "  %-18s %14.0f\n", rows[i].name, rows[i].value);
}

static const char *kinematics_text(int kin) {
  static const char *const words[] = {"plane strain", "plane stress",
                                      "axisymmetric", "3-D"};
  return kin >= 0 ? words[kin % 4] : "?";
}

static const char *law_text(const friction_rule *rule) {
  return rule->law != NULL ? rule->law->name : "none";
}

static void print_model(const job *j, FILE *f) {
  const model *m = j->m;
  for (int i = 0; i < j->msh->n_group; ++i) {
    const mesh_group *g = &j->msh->group[i];
    fprintf(f, "  group    %-20s dimension %d  items %8d  nodes %8d\n", g->name,
            g->dim, g->n_item, g->n_node);
  }
  for (int i = 0; i < m->n_section; ++i)
    fprintf(f, "  section  %-20s %s, material %s%s\n", m->sections[i].elset,
            kinematics_text(m->sections[i].kin), m->sections[i].material_name,
            m->sections[i].averaged ? ", volume averaged" : "");
  for (int i = 0; i < m->n_contact; ++i) {
    const contact *c = &m->contacts[i];
    fprintf(f, "  contact  %-20s group %s, obstacle %s, friction %s\n", c->name,
            c->group, c->obstacle_name, law_text(&c->friction));
  }
  for (int i = 0; i < m->n_step; ++i)
    for (int k = 0; k < m->steps[i].n_change; ++k) {
      const friction_change *change = &m->steps[i].changes[k];
      fprintf(f, "  contact  %-20s from step %d on friction %s\n",
              m->contacts[change->contact_id].name, i + 1,
              law_text(&change->rule));
    }
}

/* What *EFFECTS, MODE=AUTO tries without, or had to take back. */
static void print_left_out(const model *m, FILE *f) {
  for (int i = 0; i < m->n_neglected; ++i) {
    const neglected *n = &m->neglected[i];
    fprintf(f, "  %s %s: %s\n",
            n->back ? "not left out:" : "left out:", effect_name(n->bit),
            n->why);
    if (n->back && !n->lost)
      fprintf(f,
              "    without it: at most %.1e of the energy norm, %.1e of the "
              "largest stress,\n    solved again with it: %.1e of the largest "
              "displacement or force, after %ld\n    increments; too much for "
              "TOL=%g, this is the run with it\n",
              n->bound, n->local, n->change, n->checked, m->effects_tol);
    else if (n->back)
      fputs(
          "    without it an increment was not solved to its tolerance, this "
          "is "
          "the run\n    with it\n",
          f);
  }
}

/* The proof at the end: what would have changed at most. */
static void print_proof(const model *m, FILE *f) {
  for (int i = 0; i < m->n_neglected; ++i) {
    const neglected *n = &m->neglected[i];
    if (n->back) continue;
    fprintf(f,
            "  without %s: changes the answer by at most %.1e of the energy "
            "norm,\n    %.1e of the largest stress, at each of %ld "
            "increments\n",
            effect_name(n->bit), n->bound, n->local, n->checked);
    if (n->again > 0)
      fprintf(f,
              "    %ld of them solved again with it: %.1e of the largest "
              "displacement or force\n",
              n->again, n->change);
  }
}

status listing_open(const job *j, text_file *lst) {
  FILE *f = lst->f;
  const char *version = j->o->version != NULL ? j->o->version : "";
  fprintf(f, "PROTIS %s\n\n%s\n", version,
          j->m->title != NULL ? j->m->title : "");
  heading(f, "DECK");
  if (j->m->deck != NULL) model_echo(j->m, f);
  heading(f, "MODEL");
  print_sizes(j, 0, f);
  print_model(j, f);
  heading(f, "EFFECTS");
  plan_print(j->plan, "  ", f);
  print_left_out(j->m, f);
  return text_check(lst);
}

status listing_ready(const job *j, text_file *lst) {
  char text[NUMBER_SIZE];
  const setup_facts *facts = &j->run->facts;
  heading(lst->f, "EQUATIONS");
  print_sizes(j, 1, lst->f);
  if (facts->info.ordering != NULL)
    fprintf(lst->f, "  %-18s %14s\n", "ordering", facts->info.ordering);
  if (!isnan(facts->condition))
    fprintf(lst->f, "  %-18s %14s\n", "condition",
            text_number(text, facts->condition, 1));
  if (!isnan(facts->condition))
    fprintf(lst->f, "  %-18s %14.1f of 16, at worst\n", "digits left",
            facts->digits);
  if (facts->floating)
    fprintf(lst->f, "  contact alone holds at least one body\n");
  heading(lst->f, "INCREMENTS");
  return text_check(lst);
}

static void print_totals(const job *j, const view *v, FILE *f) {
  table t;
  table_choose(&t, PER_CONTACT, PRINT_TOTALS, v, DIGITS);
  if (j->m->n_contact == 0 || t.n == 0) return;
  table_header(&t, j->m, " ", f);
  for (int i = 0; i < j->m->n_contact; ++i) table_row(&t, v, i, f);
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

/* Where the condition gives reason to look. */
static void print_rounding(const state *s, FILE *f) {
  char norm[NUMBER_SIZE], stress[NUMBER_SIZE];
  if (!s->rounding.found) return;
  fprintf(f,
          "  rounding: %s %% of the energy norm, %s %% of the largest stress\n",
          text_number(norm, 100 * s->rounding.energy, 1),
          text_number(stress, 100 * s->rounding.stress, 1));
}

static void print_error(const job *j, const state *s, FILE *f) {
  char text[NUMBER_SIZE], unit[64];
  const error_bound *e = &s->error;
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
  const true_error *e = &s->truth;
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
  const balance_report *b = &s->balance;
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
  if (j->m->dim > 1)
    fprintf(f, "  contact nodes: open %d, slip %d, stick %d\n", s->n_open,
            s->n_slip, s->n_stick);
  fprintf(f, "  solver %s: %s, iterations %d, limit updates %d, residual %s",
          r->solver != NULL ? r->solver : "-", outcome_text(r->outcome),
          r->iterations, r->limit_updates, text_number(text, r->residual, 2));
  if (!j->o->no_timing) fprintf(f, ", cpu %.3f s", r->cpu);
  fputc('\n', f);
  print_rounding(s, f);
  print_error(j, s, f);
  print_balance(j, s, f);
  if (s->solver_log != NULL && s->solver_log[0] != '\0')
    fprintf(f, "  tried: %s\n", s->solver_log);
  if (!s->settled) fprintf(f, "  THE TOLERANCE WAS NOT REACHED\n");
}

/* ---- CHECK= ------------------------------------------------------------- */

static void print_solution(const solution_set *set, int i, FILE *f) {
  char text[4][NUMBER_SIZE];
  const solution_facts *a = &set->found[i].facts;
  fprintf(f, "    %2d  residual %s  open %d  slip %d  stick %d  ", i + 1,
          text_number(text[0], a->residual, 1), a->n_open, a->n_slip,
          a->n_stick);
  fprintf(f, "u_n %s to %s  u_t %s to %s\n",
          text_number(text[0], a->lowest[0], 4),
          text_number(text[1], a->highest[0], 4),
          text_number(text[2], a->lowest[1], 4),
          text_number(text[3], a->highest[1], 4));
  if (i > 0)
    fprintf(f, "        %s %% of the energy norm away from solution 1\n",
            text_number(text[0], 100 * a->distance, 2));
  if (a->joined > 0)
    fprintf(f,
            "        all states between solutions %d and %d are solutions: a "
            "continuum\n",
            a->joined, i + 1);
}

/* Nodal values of one solution of an enumeration. */
static void print_values(const state *s, const solution *a, FILE *f) {
  static const char *const words[] = {"OPEN", "SLIP", "STICK"};
  char text[4][NUMBER_SIZE];
  fprintf(f, "        %8s %-6s %12s %12s %12s %12s\n", "node_no", "status",
          "u_n", "u_t", "f_n", "f_t");
  for (int i = 0; i < s->solutions->n; ++i)
    fprintf(f, "        %8zu %-6s %s %s %s %s\n", s->surface->node_no[i],
            words[a->status[i]], text_number(text[0], a->u[2 * i], 4),
            text_number(text[1], a->u[2 * i + 1], 4),
            text_number(text[2], -a->r[2 * i], 4),
            text_number(text[3], a->r[2 * i + 1], 4));
}

/* What did not end with a solution. */
static void print_failures(const solution_set *set, FILE *f) {
  char text[NUMBER_SIZE];
  for (int k = 0; k < set->n_attempt; ++k) {
    const solution_attempt *a = &set->attempts[k];
    if (a->solution_no > 0) continue;
    fprintf(f, "    %s (%s), start %s: %s, residual %s\n", a->solver, a->family,
            a->start, outcome_text(a->outcome),
            text_number(text, a->residual, 1));
  }
}

/* Who led to solution number i + 1: a line for each solver. */
static void print_finders(const solution_set *set, int i, FILE *f) {
  const char *last = "";
  for (int k = 0; k < set->n_attempt; ++k) {
    const solution_attempt *a = &set->attempts[k];
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

static void print_check(const state *s, FILE *f) {
  const solution_set *set = s->solutions;
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
  print_failures(set, f);
}

/* ---- THEORY= ------------------------------------------------------------ */

static const char *row_name(const model *m, const theory_contact *c) {
  return c->contact_id < 0 ? "(all)" : m->contacts[c->contact_id].name;
}

/* The eigenvalues, when they have been found anew. */
static void print_constants(const job *j, const theory_report *t, FILE *f) {
  char text[2][NUMBER_SIZE], stiff[64], soft[64];
  column_unit("force/length", j->m, stiff, sizeof stiff);
  column_unit("length/force", j->m, soft, sizeof soft);
  for (int i = 0; t->fresh && i < t->n_contact; ++i) {
    const theory_contact *c = &t->contacts[i];
    fprintf(f, "  theory: %s: largest eigenvalues of A_nn %s %s, ",
            row_name(j->m, c), text_number(text[0], c->normal, 4), stiff);
    if (c->tangent < HUGE_VAL)
      fprintf(f, "of inv(A)_tt %s %s\n", text_number(text[1], c->tangent, 4),
              soft);
    else
      fputs("inv(A)_tt is not bounded\n", f);
  }
}

static void print_limits(const job *j, const theory_report *t, FILE *f) {
  char text[4][NUMBER_SIZE];
  if (t->n_contact == 0) return;
  fprintf(f, "  %-20s %12s %12s %12s %12s  %s\n", "theory: contact", "mu[-]",
          "1/C_h[-]", "contraction", "mu/contr.[-]", "mu is");
  for (int i = 0; i < t->n_contact; ++i) {
    const theory_contact *c = &t->contacts[i];
    fprintf(
        f, "  %-20s %12s %12s %12s %12s  %s\n", row_name(j->m, c),
        text_number(text[0], c->mu, 4), text_number(text[1], c->limit, 4),
        text_number(text[2], c->rate, 4),
        c->suggested < HUGE_VAL ? text_number(text[3], c->suggested, 4) : "-",
        mu_regime_text(c->regime));
  }
}

static void print_bound(const job *j, const char *what, const theory_bound *b,
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
static void print_path(const job *j, const theory_path *p, FILE *f) {
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

static void print_theory(const job *j, const state *s, FILE *f) {
  char text[NUMBER_SIZE];
  const theory_report *t = &s->theory;
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

static void print_when(const state *s, FILE *f) {
  char t[NUMBER_SIZE], dt[NUMBER_SIZE];
  fprintf(f, "\nstep %d  increment %d  time %s  dt %s", s->step_no,
          s->increment_no, text_number(t, s->t, 9), text_number(dt, s->dt, 9));
  if (s->attempt > 1) fprintf(f, "  attempt %d", s->attempt);
}

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
  char text[NUMBER_SIZE], unit[64];
  int node = -1;
  column_unit("force", j->m, unit, sizeof unit);
  fputs("\ninitial state: ", f);
  if (s->source != NULL)
    fprintf(f, "end of %s, time %s\n", s->source,
            text_number(text, s->source_time, 9));
  else
    fputs("displacements of the deck\n", f);
  fprintf(f, "  %-24s %14s %s\n", "largest force",
          text_number(text, s->scale, DIGITS), unit);
  fprintf(f, "  %-24s %14s %s\n", "largest defect",
          text_number(text, s->worst, DIGITS), unit);
  fprintf(f, "  %-24s %14s -\n", "defect, relative",
          text_number(text, s->ratio, DIGITS));
  fprintf(f, "  %-24s %14d, above %s\n", "nodes out of balance", s->n_bad,
          text_number(text, start_tolerance, 0));
  for (int k = 0; k < WORST_NODES && k < s->n_bad; ++k) {
    node = next_defect(s, j->msh->n_node, node);
    if (node < 0) break;
    fprintf(f, "  node %-19zu %14s %s: %s\n", j->msh->node_no[node],
            text_number(text, s->defect[node], DIGITS), unit,
            defect_text(s->kind[node]));
  }
  fprintf(f, "  %s\n",
          s->relaxed     ? "relaxed to the equilibrium of time 0, increment 0"
          : s->n_bad > 0 ? "REFUSED"
                         : "compatible");
  return text_check(lst);
}

status listing_increment(const job *j, const state *s, text_file *lst) {
  view v = {j->m, j->msh, s};
  print_when(s, lst->f);
  fputc('\n', lst->f);
  if (s->flow != NULL && s->increment_no == 1 &&
      j->m->steps[s->step_no - 1].kind != STEP_VISCO)
    fputs("  no inelastic strain grows in this step: it is not *VISCO\n",
          lst->f);
  if (s->surface != NULL) {
    if (s->note != NULL) fputs(s->note, lst->f);
    print_solver(j, s, lst->f);
    print_check(s, lst->f);
    print_theory(j, s, lst->f);
    print_totals(j, &v, lst->f);
  }
  print_share("mesh", &s->mesh_error, lst->f);
  print_share("steps", &s->time_error, lst->f);
  print_truth(s, lst->f);
  if (!j->m->has_problem) print_energies(j, &v, lst->f);
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

static void print_accuracy(const job *j, FILE *f) {
  char text[NUMBER_SIZE];
  const run_summary *run = j->run;
  fprintf(f, "  %-26s %12d\n", "increments", run->n_increment);
  fprintf(f, "  %-26s %12d\n", "attempts cut", run->n_rejected);
  fprintf(f, "  %-26s %12d\n", "tolerance missed", run->n_unsettled);
  fprintf(f, "  %-26s %12s\n", "largest residual",
          text_number(text, run->residual_worst, 2));
  fprintf(f, "  %-26s %12s\n", "largest energy defect",
          text_number(text, run->defect_worst, 2));
}

/* ---- error budget: each error with the stages whose work decides it --------
 */

static const stage mesh_stages[] = {STAGE_MESH,     STAGE_SURFACE,
                                    STAGE_ASSEMBLY, STAGE_ORDERING,
                                    STAGE_FACTOR,   STAGE_CONDENSE};
static const stage time_stages[] = {
    STAGE_LOAD,   STAGE_LIMIT,  STAGE_NONLOCAL,  STAGE_VELOCITY, STAGE_RECOVERY,
    STAGE_STRESS, STAGE_ENERGY, STAGE_INELASTIC, STAGE_THERMAL};
static const stage solver_stages[] = {STAGE_CONTACT};

static double cpu_of(const stage *list, size_t n) {
  double cpu = 0;
  for (size_t i = 0; i < n; ++i) cpu += timer_cost(list[i]).cpu;
  return cpu;
}
#define STAGES(list) list, sizeof list / sizeof *list

/* NAN, an increment without estimate, stays. */
static double worse(double a, double b) { return isnan(a) || a >= b ? a : b; }

typedef error_share share_of(const increment_summary *i);
static error_share mesh_share(const increment_summary *i) {
  return i->mesh_error;
}
static error_share time_share(const increment_summary *i) {
  return i->time_error;
}
static error_share true_share(const increment_summary *i) {
  int asked = i->truth.asked && !isnan(i->truth.energy);
  return (error_share){asked, i->truth.energy, i->truth.cpu, NULL};
}
static error_share solver_share(const increment_summary *i) {
  const error_bound *e = &i->error;
  return (error_share){e->asked, e->relative, e->cpu, e->why};
}

/* Last and largest of the increments that were asked; 0 if none was. */
static int collect(const run_summary *run, share_of *of, budget_row *row) {
  int n = 0;
  for (int k = 0; k < run->n_increment; ++k) {
    error_share e = of(&run->increments[k]);
    if (!e.asked) continue;
    row->last = 100 * e.relative;
    row->worst = n++ == 0 ? row->last : worse(row->worst, row->last);
    row->estimated = e.cpu;
  }
  return n > 0;
}

/* clang-format off */
static const struct {
  const char *name, *json;
  share_of *of;
  const stage *stages;
  size_t n_stage;
} budget_table[BUDGET_ROWS] = {
  {"mesh",   "mesh",   mesh_share,   STAGES(mesh_stages)},
  {"steps",  "time",   time_share,   STAGES(time_stages)},
  {"solver", "solver", solver_share, STAGES(solver_stages)},
  {"true, by *REFERENCE", "true", true_share, NULL, 0}};
/* clang-format on */

int job_budget(const job *j, budget_row rows[BUDGET_ROWS]) {
  int n = 0;
  for (int k = 0; k < BUDGET_ROWS; ++k) {
    rows[n] = (budget_row){
        .name = budget_table[k].name,
        .json = budget_table[k].json,
        .reached = cpu_of(budget_table[k].stages, budget_table[k].n_stage)};
    n += collect(j->run, budget_table[k].of, &rows[n]);
    if (n == BUDGET_ROWS) break;
  }
  return n;
}

double job_effectivity(const job *j) {
  budget_row rows[BUDGET_ROWS];
  int n = job_budget(j, rows);
  double sum = 0;
  if (n < 2 || strcmp(rows[0].json, "mesh") != 0 ||
      strcmp(rows[n - 1].json, "true") != 0)
    return NAN;
  for (int i = 0; i < n - 1; ++i) sum += rows[i].last;
  return rows[n - 1].last > 0 ? sum / rows[n - 1].last : NAN;
}

balance_sum job_balance(const job *j) {
  balance_sum sum = {0};
  for (int i = 0; i < j->run->n_increment; ++i) {
    const increment_summary *s = &j->run->increments[i];
    if (!s->balance.asked) continue;
    sum.asked = 1;
    sum.iterations += s->iterations;
    sum.saved_iterations += s->balance.saved_iterations;
    sum.saved_cpu += s->balance.saved_cpu;
  }
  return sum;
}

double job_increments_of_deck(const job *j, int *made) {
  double sum = 0;
  *made = 0;
  for (int i = 0; i < j->m->n_step; ++i) {
    const step *s = &j->m->steps[i];
    if (s->time_balanced) sum += ceil(s->total / s->dt - 1e-9);
  }
  for (int i = 0; i < j->run->n_increment; ++i)
    *made += j->m->steps[j->run->increments[i].step_no - 1].time_balanced;
  return sum;
}

static void print_saved(const job *j, FILE *f) {
  balance_sum sum = job_balance(j);
  int made;
  double of_deck = job_increments_of_deck(j, &made);
  if (of_deck > 0)
    fprintf(f,
            "  increments balanced with the error of the mesh: %d in the "
            "place of %.0f of the deck\n",
            made, of_deck);
  if (!sum.asked) return;
  fprintf(f,
          "  stopping balanced with the other errors saved about %.0f of "
          "%.0f iterations",
          sum.saved_iterations, sum.iterations + sum.saved_iterations);
  if (!j->o->no_timing) fprintf(f, ", %.3f s of CPU", sum.saved_cpu);
  fputs(" (to residual 1E-10)\n", f);
}

/* What was reached, what it cost, and what it cost to know it. */
static void print_budget(const job *j, FILE *f) {
  char last[NUMBER_SIZE], worst[NUMBER_SIZE];
  budget_row rows[BUDGET_ROWS];
  int n = job_budget(j, rows), cost = !j->o->no_timing;
  if (n == 0) return;
  fprintf(f, "\n  %-26s %12s %12s", "error in the energy norm", "last[%]",
          "largest[%]");
  fprintf(f, cost ? " %13s %15s\n" : "\n", "work cpu[s]", "estimate cpu[s]");
  for (int i = 0; i < n; ++i) {
    fprintf(f, "  %-26s %12s %12s", rows[i].name,
            text_number(last, rows[i].last, 2),
            text_number(worst, rows[i].worst, 2));
    if (cost && rows[i].reached > 0)
      fprintf(f, " %13.3f", rows[i].reached);
    else if (cost)
      fprintf(f, " %13s", "");
    if (cost) fprintf(f, " %15.3f", rows[i].estimated);
    fputc('\n', f);
  }
  double effectivity = job_effectivity(j);
  if (!isnan(effectivity))
    fprintf(f, "  estimated over true error: %.2f\n", effectivity);
  print_saved(j, f);
}

static void print_pass(const job *j, int no, const pass_row *r, FILE *f) {
  char number[4][NUMBER_SIZE];
  if (no > 0)
    fprintf(f, "  %-10d", no);
  else
    fprintf(f, "  %-10s", "next digit");
  fprintf(f, " %10.0f", r->unknowns);
  if (no > 0)
    fprintf(f, " %10s %10s %10s", text_number(number[0], r->mesh, 2),
            text_number(number[1], r->time, 2),
            text_number(number[2], r->solver, 2));
  else
    fprintf(f, " %10s %10s %10s", "", "", "");
  fprintf(f, " %10s", text_number(number[3], r->total, 2));
  if (!j->o->no_timing) fprintf(f, " %9.3g", r->cpu);
  fprintf(f, "  %s\n", no > 0 ? r->change : "forecast");
}

/* The passes towards the target, and what a digit more would cost. */
static void print_passes(const job *j, FILE *f) {
  const pass_table *t = &j->run->passes;
  if (t->n == 0) return;
  fprintf(f, "\n  target %g %% of the energy norm: %s\n", t->target,
          t->why[0] == '\0' ? "reached" : "missed");
  fprintf(f, "  %-10s %10s %10s %10s %10s %10s", "pass", "unknowns", "mesh[%]",
          "steps[%]", "solver[%]", "total[%]");
  if (!j->o->no_timing) fprintf(f, " %9s", "cpu[s]");
  fprintf(f, "  changed next\n");
  for (int i = 0; i < t->n; ++i) print_pass(j, i + 1, &t->rows[i], f);
  if (t->forecast != NULL) print_pass(j, 0, t->forecast, f);
}

/* Stages that were never entered are shown too: 0 calls, 0 bytes. */
static void print_stages(const job *j, FILE *f) {
  int cost = !j->o->no_timing;
  double cpu = 0;
  const flow_tally *t = &j->run->tally;
  fprintf(f, "  %-30s %8s", "stage", "calls");
  fprintf(f, cost ? " %12s %14s\n" : "\n", "cpu[s]", "bytes");
  for (int i = 0; i < STAGE_COUNT; ++i) {
    stage_cost c = timer_cost((stage)i);
    cpu += c.cpu;
    fprintf(f, "  %-30s %8ld", timer_name((stage)i), c.calls);
    if (cost) fprintf(f, " %12.3f %14zu", c.cpu, c.bytes);
    fputc('\n', f);
  }
  if (cost) fprintf(f, "  %-30s %8s %12.3f\n", "all stages", "", cpu);
  if (t->asked > 0.0)
    fprintf(f, "  %-30s %8.0f of %.0f looked at\n",
            "points below their threshold", t->resting, t->asked);
}

status listing_verdict(const job *j, text_file *lst) {
  FILE *f = lst->f;
  if (j->m->log != NULL && message_count(j->m->log, WARNING) > 0) {
    heading(f, "WARNINGS");
    message_list(j->m->log, WARNING, f);
  }
  heading(f, "ACCURACY");
  print_accuracy(j, f);
  print_budget(j, f);
  print_passes(j, f);
  heading(f, "COST");
  print_stages(j, f);
  heading(f, "COST OF THE EFFECTS");
  plan_print_cost(j->plan, !j->o->no_timing, f);
  print_proof(j->m, f);
  heading(f, "END");
  fprintf(f, "  exit %d: %s\n", status_exit_code(j->run->verdict),
          status_text(j->run->verdict));
  if (j->run->message[0] != '\0') fprintf(f, "  %s\n", j->run->message);
  return text_check(lst);
}
