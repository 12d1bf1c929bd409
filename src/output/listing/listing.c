/*
 * JOB.lst: the listing. Deck with defaults, model, effect plan, one block per
 * increment, accuracy and cost. It has no date, time of day or path; the cost
 * columns (CPU seconds and bytes, which depend on the length of names) are left
 * out on request, and then two runs give the same bytes.
 */
#include "output/listing/job.h"

#include "effects/rows.h"
#include "model/keyword/keyword.h"

int job_sizes(const job *j, size_row rows[SIZE_ROWS]) {
  const condense_info *info = &j->run->facts.info;
  int n = 0;
  rows[n++] = (size_row){"dimension", j->m->dim};
  if (!j->m->problem.given) {
    rows[n++] = (size_row){"nodes", j->msh->n_node};
    rows[n++] = (size_row){"elements", j->msh->n_elem};
    rows[n++] = (size_row){"groups", j->msh->n_group};
    rows[n++] = (size_row){"materials", j->m->n.material};
    rows[n++] = (size_row){"sections", j->m->n.section};
    rows[n++] = (size_row){"contacts", j->m->n.contact};
  }
  rows[n++] = (size_row){"steps", j->m->n.step};
  int model_rows = n;
  if (j->run->facts_known) {
    if (!j->m->problem.given) rows[n++] = (size_row){"bodies", info->bodies};
    rows[n++] = (size_row){"unknowns", (double)info->unknowns};
    rows[n++] = (size_row){"contact nodes", j->run->facts.n_contact_node};
    if (j->run->facts.n_left_out > 0)
      rows[n++] = (size_row){"  out of reach", j->run->facts.n_left_out};
    rows[n++] = (size_row){"contact unknowns", (double)info->contact_unknowns};
    if (!j->m->problem.given)
      rows[n++] = (size_row){"factor entries", (double)info->factor_entries};
    if (j->m->effects & EFFECT_NONLOCAL)
      rows[n++] = (size_row){"average entries", j->run->facts.average_entries};
  }
  rows[n] = (size_row){NULL, 0};
  return model_rows;
}

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

static void print_pair(const surface_pair *p, const char *what,
                       const char *name, const mesh *msh, FILE *f) {
  fprintf(f, "  %-8s %-20s slave %s (%s), master %s", what, name,
          msh->group[p->slave_id].name, p->why, msh->group[p->master_id].name);
  if (p->adjust) fprintf(f, ", nodes moved by up to %.3g", p->moved);
}

static void print_model(const job *j, FILE *f) {
  const model *m = j->m;
  for (EACH(const mesh_group, g, j->msh->group, j->msh->n_group))
    fprintf(f, "  group    %-20s dimension %d  items %8d  nodes %8d\n", g->name,
            g->dim, g->n_item, g->n_node);
  for (int i = 0; i < m->n.section; ++i)
    fprintf(f, "  section  %-20s %s, material %s%s\n", m->sections[i].elset,
            kinematics_text(m->sections[i].kin), m->sections[i].material_name,
            m->sections[i].averaged ? ", volume averaged" : "");
  for (EACH(const contact, c, m->contacts, m->n.contact)) {
    if (c->is_pair)
      print_pair(&c->pair, "contact", c->name, j->msh, f);
    else
      fprintf(f, "  contact  %-20s group %s, obstacle %s", c->name, c->group,
              c->obstacle_name);
    fprintf(f, ", friction %s\n", law_text(&c->friction));
  }
  for (int i = 0; i < m->n.tie; ++i) {
    print_pair(&m->ties[i].pair, "tie", m->ties[i].name, j->msh, f);
    fputc('\n', f);
  }
  for (int i = 0; i < m->n.step; ++i)
    for (EACH(const friction_change, change, m->steps[i].friction.changes,
              m->steps[i].friction.n))
      fprintf(f, "  contact  %-20s from step %d on friction %s\n",
              m->contacts[change->contact_id].name, i + 1,
              law_text(&change->rule));
}

/* Effects that *EFFECTS, MODE=AUTO leaves out, or had to restore. */
static void print_left_out(const model *m, FILE *f) {
  for (int i = 0; i < m->reduction.n; ++i) {
    const omitted *n = &m->reduction.row[i];
    fprintf(f, "  %s %s: %s\n",
            n->back ? "not left out:" : "left out:", effect_name(n->bit),
            n->why);
    if (n->back && !n->lost)
      fprintf(f,
              "    without it: at most %.1e of the energy norm, %.1e of the "
              "largest stress,\n    solved again with it: %.1e of the largest "
              "displacement or force, after %ld\n    increments; too much for "
              "TOL=%g, this is the run with it\n",
              n->bound, n->local, n->change, n->checked, m->reduction.tol);
    else if (n->back)
      fputs(
          "    without it an increment was not solved to its tolerance, this "
          "is "
          "the run\n    with it\n",
          f);
  }
}

/* The proof at the end: the bound of the change. */
static void print_proof(const model *m, FILE *f) {
  for (int i = 0; i < m->reduction.n; ++i) {
    const omitted *n = &m->reduction.row[i];
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
          j->m->name.title != NULL ? j->m->name.title : "");
  heading(f, "DECK");
  if (j->m->deck != NULL) PASS(model_echo(f, j->m));
  heading(f, "MODEL");
  print_sizes(j, 0, f);
  print_model(j, f);
  heading(f, "EFFECTS");
  plan_print(j->plan, "  ", f);
  print_left_out(j->m, f);
  return text_check(lst);
}

status listing_again(const job *j, const char *was, text_file *lst) {
  OWNED char *now = NULL;
  PASS(text_made(&now, j->m, model_echo));
  if (strcmp(now, was) == 0) return OK;
  heading(lst->f, "DECK OF THE RESTART");
  fputs(now, lst->f);
  return text_check(lst);
}

status listing_ready(const job *j, text_file *lst) {
  const setup_facts *facts = &j->run->facts;
  heading(lst->f, "EQUATIONS");
  print_sizes(j, 1, lst->f);
  if (facts->info.ordering != NULL)
    fprintf(lst->f, "  %-18s %14s\n", "ordering", facts->info.ordering);
  if (facts->choice.dense.bytes > 0.0)
    fprintf(lst->f, "  %-18s %14s  %s\n", "stiffness",
            facts->choice.sparse ? "FACTOR" : "DENSE", facts->choice.why);
  if (!isnan(facts->condition))
    fprintf(lst->f, "  %-18s %14s\n", "condition",
            text_number(facts->condition, 1));
  if (!isnan(facts->condition))
    fprintf(lst->f, "  %-18s %14.1f of 16, at worst\n", "digits left",
            facts->digits);
  if (facts->floating)
    fprintf(lst->f, "  contact alone holds at least one body\n");
  heading(lst->f, "INCREMENTS");
  return text_check(lst);
}

/* Stages that were never entered are shown too: 0 calls, 0 bytes. */
static void print_stages(const job *j, FILE *f) {
  int cost = !j->o->no_timing;
  double cpu = 0;
  const flow_tally *t = &j->run->tally;
  fprintf(f, "  %-30s %8s", "stage", "calls");
  fprintf(f, cost ? " %12s %14s\n" : "\n", "cpu[s]", "bytes");
  for (int i = 0; i < STAGE_COUNT; ++i) {
    if (timer_name((stage)i) == NULL) continue;
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

status listing_summary(const job *j, text_file *lst) {
  FILE *f = lst->f;
  if (j->m->log != NULL && message_count(j->m->log, WARNING) > 0) {
    heading(f, "WARNINGS");
    message_list(j->m->log, WARNING, f);
  }
  heading(f, "ACCURACY");
  const run_summary *run = j->run;
  fprintf(f, "  %-26s %12d\n", "increments", run->n_increment);
  fprintf(f, "  %-26s %12d\n", "attempts cut", run->n_rejected);
  fprintf(f, "  %-26s %12d\n", "tolerance missed", run->n_unsettled);
  fprintf(f, "  %-26s %12s\n", "largest residual",
          text_number(run->residual_worst, 2));
  fprintf(f, "  %-26s %12s\n", "largest energy defect",
          text_number(run->defect_worst, 2));
  listing_accuracy(j, f);
  heading(f, "COST");
  print_stages(j, f);
  heading(f, "COST OF THE EFFECTS");
  plan_print_cost(j->plan, !j->o->no_timing, f);
  print_proof(j->m, f);
  return text_check(lst);
}

status listing_end(const job *j, text_file *lst) {
  char end[4096];
  const int n =
      snprintf(end, sizeof end, "\nEND\n---\n  exit %d: %s\n",
               status_exit_code(j->run->verdict), status_text(j->run->verdict));
  if (j->run->message[0] != '\0')
    snprintf(end + n, sizeof end - (size_t)n, "  %s\n", j->run->message);
  fputs(end, lst->f);
  return text_check(lst);
}
