/* JOB.json: the outcome and the figures of the run for programs. */
#include "effects/rows.h"
#include "output/writers.h"

/* RFC 8259, UTF-8, value after value. A comma is due: a flag a depth. */
typedef struct json {
  FILE *f;
  int depth;
  int filled[8];
  char end[8]; /* bracket that closes */
} json;

static void json_text(FILE *f, const char *text) {
  char piece[PIECE_SIZE];
  fputc('"', f);
  for (;;) {
    for (; *text == '\n'; ++text) fputs("\\n", f);
    if (text_piece(&text, piece) == 0) break;
    for (const char *p = piece; *p != '\0'; ++p) {
      if (strchr("\t\"\\", *p) != NULL) fputc('\\', f);
      fputc(*p == '\t' ? 't' : *p, f);
    }
  }
  fputc('"', f);
}

static void json_line(const json *w) {
  fputc('\n', w->f);
  for (int k = 0; k < w->depth; ++k) fputs("  ", w->f);
}

static void json_next(json *w, const char *name) {
  if (w->filled[w->depth]++ > 0) fputc(',', w->f);
  json_line(w);
  if (name == NULL) return;
  fputc('"', w->f);
  fputs(name, w->f);
  fputs("\": ", w->f);
}

/* name NULL: an item of an array. */
static json *json_open(json *w, const char *name, const char *brackets) {
  if (w->depth > 0) json_next(w, name);
  fputc(brackets[0], w->f);
  w->filled[++w->depth] = 0;
  w->end[w->depth] = brackets[1];
  return w;
}

static void json_close(json *const *at) {
  json *w = *at;
  const char end = w->end[w->depth--];
  json_line(w);
  fputc(end, w->f);
}

/* To the end of the block; an item of an array is an object. */
#define ENDS_JSON __attribute__((cleanup(json_close), unused))
#define OBJECT(w, name) json *const object_ ENDS_JSON = json_open(w, name, "{}")
#define ARRAY(w, name) json *const array_ ENDS_JSON = json_open(w, name, "[]")
#define ITEM(w) json *const item_ ENDS_JSON = json_open(w, NULL, "{}")

static void json_string(json *w, const char *name, const char *text) {
  json_next(w, name);
  json_text(w->f, text != NULL ? text : "");
}

/* null if not finite. */
static void json_real(json *w, const char *name, double value) {
  json_next(w, name);
  if (isfinite(value))
    fprintf(w->f, "%.17g", value == 0 ? 0.0 : value);
  else
    fputs("null", w->f);
}

static void json_count(json *w, const char *name, double value) {
  json_next(w, name);
  fprintf(w->f, "%.0f", value);
}

static void json_flag(json *w, const char *name, int value) {
  json_next(w, name);
  fputs(value ? "true" : "false", w->f);
}

/* The name in one word: "contact nodes" -> "contact_nodes". */
static void json_named_count(json *w, const char *name, double value) {
  char word[80];
  text_word(word, sizeof word, name);
  json_count(w, word, value);
}

static void write_exit(json *w, const run_summary *run) {
  OBJECT(w, "exit");
  json_count(w, "code", status_exit_code(run->verdict));
  json_string(w, "name", status_name(run->verdict));
  json_string(w, "text", status_text(run->verdict));
  json_string(w, "message", run->message);
}

/* Expected and measured costs of an effect. */
static void write_effect(json *w, const plan_row *r, double cpu,
                         const output_options *o) {
  stage_cost c = plan_cost(r);
  ITEM(w);
  json_string(w, "effect", r->name);
  if (r->of[0] != '\0') json_string(w, "of", r->of);
  json_flag(w, "on", r->on);
  json_string(w, "why", r->why);
  if (r->work.kind != NULL) json_named_count(w, r->work.kind, r->work.items);
  json_real(w, "expected_cpu_percent", 100 * r->share);
  if (r->on && r->work.calls >= 0 && r->n_stage > 0)
    json_count(w, "expected_calls", r->work.calls);
  if (r->n_stage == 0 && r->on) {
    json_string(w, "part_of", r->within);
  } else {
    json_count(w, "calls", (double)c.calls);
    if (!o->no_timing) {
      json_real(w, "cpu_percent", cpu > 0.0 ? 100 * c.cpu / cpu : 0.0);
      json_real(w, "cpu", c.cpu);
      json_count(w, "bytes", (double)c.bytes);
    }
  }
}

static void write_effects(json *w, const job *j) {
  const effect_plan *p = j->plan;
  double cpu = plan_cpu(p);
  ARRAY(w, "effects");
  for (int i = 0; i < p->n; ++i) write_effect(w, &p->rows[i], cpu, j->o);
}

/* What *EFFECTS, MODE=AUTO left out or restored. */
static void write_omitted(json *w, const model *m) {
  if (!m->reduction.is_auto) return;
  ARRAY(w, "left_out");
  for (int i = 0; i < m->reduction.n; ++i) {
    const omitted *n = &m->reduction.row[i];
    ITEM(w);
    json_string(w, "effect", effect_name(n->bit));
    json_string(w, "why", n->why);
    json_flag(w, "taken_back", n->back);
    json_flag(w, "not_solved", n->lost);
    json_real(w, "bound", n->bound);
    json_real(w, "stress", n->local);
    json_real(w, "change", n->change);
    json_count(w, "increments", (double)n->checked);
    json_count(w, "solved_again", (double)n->again);
  }
}

static void write_sizes(json *w, const job *j) {
  size_row rows[SIZE_ROWS];
  job_sizes(j, rows);
  OBJECT(w, "sizes");
  for (int i = 0; rows[i].name != NULL; ++i)
    json_named_count(w, rows[i].name, rows[i].value);
}

static void json_error(json *w, const budget_row *r, const char *what,
                       double value) {
  json_real(w, text_of("%s_error_%s", r->json, what), value);
}

static void write_budget(json *w, const job *j) {
  budget_row rows[BUDGET_ROWS];
  const int n = job_budget(j, rows);
  for (const budget_row *r = rows; r < rows + n; ++r) {
    json_error(w, r, "percent", r->last);
    json_error(w, r, "worst_percent", r->worst);
    if (j->o->no_timing) continue;
    json_error(w, r, "reached_cpu", r->reached);
    json_error(w, r, "estimate_cpu", r->estimated);
  }
}

static void write_saved(json *w, const job *j) {
  balance_sum sum = job_balance(j);
  int made;
  double of_deck = job_increments_of_deck(j, &made);
  if (of_deck > 0) {
    json_count(w, "balanced_increments", made);
    json_count(w, "balanced_increments_of_deck", of_deck);
  }
  if (!sum.asked) return;
  json_real(w, "balanced_iterations", sum.iterations);
  json_real(w, "balanced_saved_iterations", sum.saved_iterations);
  if (!j->o->no_timing) json_real(w, "balanced_saved_cpu", sum.saved_cpu);
}

static void write_accuracy(json *w, const job *j) {
  const run_summary *run = j->run;
  OBJECT(w, "accuracy");
  json_count(w, "increments", run->n_increment);
  json_count(w, "attempts_cut", run->n_rejected);
  json_count(w, "tolerance_missed", run->n_unsettled);
  json_real(w, "residual_worst", run->residual_worst);
  write_budget(w, j);
  write_saved(w, j);
  char advice[ADVICE_SIZE];
  job_advice(j, advice, sizeof advice);
  if (advice[0] != '\0') json_string(w, "improve_next", advice);
  if (j->m->effects & EFFECT_REFERENCE)
    json_real(w, "effectivity", job_effectivity(j));
  if (j->m->n.contact > 0)
    json_real(w, "penetration_worst", run->penetration_worst);
  json_real(w, "energy_defect_worst", run->defect_worst);
  if (run->facts_known) json_real(w, "condition", run->facts.condition);
  if (run->facts_known) json_real(w, "digits_left", run->facts.digits);
}

/* A contact at the end of a step; returns what follows its values. */
static const double *write_contact(json *w, const model *m, int id,
                                   const double *value) {
  json_string(w, "contact", m->contacts[id].name);
  const column *c;
  for (column_walk k = columns_of(PER_CONTACT);
       (c = job_end_column(m, &k)) != NULL; ++value)
    if (c->form == AS_COUNT && isfinite(*value))
      json_count(w, c->name, *value);
    else
      json_real(w, c->name, *value);
  return value;
}

static void write_contacts(json *w, const job *j) {
  const size_t size = job_end_size(j->m);
  ARRAY(w, "contacts");
  for (int k = 0; k < j->m->n.step; ++k) {
    const double *end = j->run->ends + k * size, *value = end + 2;
    for (int i = 0; i < j->m->n.contact && end[0] > 0; ++i) {
      ITEM(w);
      json_count(w, "step", k + 1);
      json_count(w, "increment", end[0]);
      json_real(w, "time", end[1]);
      value = write_contact(w, j->m, i, value);
    }
  }
}

/* Those of the last increment. */
static void write_goals(json *w, const job *j) {
  if (j->m->n.goal == 0 || job_goal(j, 0) == NULL) return;
  ARRAY(w, "goals");
  for (int i = 0; i < j->m->n.goal; ++i) {
    const goal_result *g = job_goal(j, i);
    ITEM(w);
    json_string(w, "goal", j->m->accuracy.goals[i].name);
    json_string(w, "unit", model_goal_unit(j->m, i));
    json_real(w, "value", g->value);
    json_real(w, "error", g->error);
    json_real(w, "corrected", g->value + g->error);
    json_real(w, "band", g->band);
    json_real(w, "solver_error", g->solver);
    json_real(w, "contact_ends_percent", 100 * g->ends);
    json_string(w, "verdict", goal_verdict_word(g->verdict));
    if (!j->o->no_timing) json_real(w, "cpu", g->cpu);
  }
}

static void write_pass_goals(json *w, const job *j, const pass_goal *g) {
  ARRAY(w, "goals");
  for (int i = 0; i < j->m->n.goal; ++i) {
    ITEM(w);
    json_string(w, "goal", j->m->accuracy.goals[i].name);
    json_string(w, "unit", model_goal_unit(j->m, i));
    json_real(w, "value", g[i].found.value);
    json_real(w, "error", g[i].found.error);
    json_real(w, "band", g[i].found.band);
    json_real(w, "solver_error", g[i].found.solver);
    json_real(w, "error_at_most", g[i].off);
    if (j->m->accuracy.goals[i].target > 0.0)
      json_real(w, "target", g[i].allowed);
    json_string(w, "verdict", goal_verdict_word(g[i].found.verdict));
  }
}

static void write_pass(json *w, const job *j, int i) {
  const pass_table *t = &j->run->passes;
  const pass_row *r = &t->rows[i];
  ITEM(w);
  json_count(w, "unknowns", r->unknowns);
  json_real(w, "mesh_error_percent", r->mesh);
  json_real(w, "time_error_percent", r->time);
  json_real(w, "solver_error_percent", r->solver);
  json_real(w, "total_error_percent", r->total);
  if (t->goals != NULL) write_pass_goals(w, j, t->goals + i * j->m->n.goal);
  if (!j->o->no_timing) json_real(w, "cpu", r->cpu);
  json_string(w, "changed_next", r->change);
}

static void write_passes(json *w, const job *j) {
  const pass_table *t = &j->run->passes;
  if (t->n == 0) return;
  OBJECT(w, "target");
  if (t->target > 0.0) json_real(w, "percent", t->target);
  json_flag(w, "reached", t->why[0] == '\0');
  ARRAY(w, "passes");
  for (int i = 0; i < t->n; ++i) write_pass(w, j, i);
}

static void write_stages(json *w, const output_options *o) {
  ARRAY(w, "stages");
  for (int i = 0; i < STAGE_COUNT; ++i) {
    if (timer_name((stage)i) == NULL) continue;
    stage_cost c = timer_cost((stage)i);
    ITEM(w);
    json_string(w, "stage", timer_name((stage)i));
    json_count(w, "calls", (double)c.calls);
    if (o->no_timing) continue;
    json_real(w, "cpu", c.cpu);
    json_count(w, "bytes", (double)c.bytes);
  }
}

static void write_cost(json *w, const output_options *o) {
  OBJECT(w, "cost");
  write_stages(w, o);
  if (o->no_timing) return;
  json_real(w, "cpu", timer_cpu());
  json_count(w, "peak_bytes", (double)memory_peak());
}

static void write_solutions(json *w, const increment_summary *s) {
  if (!s->checked) return;
  ARRAY(w, "solutions");
  for (EACH(const solution_facts, a, s->solutions, s->n_solution)) {
    ITEM(w);
    json_real(w, "residual", a->residual);
    json_real(w, "distance_percent", 100 * a->distance);
    json_count(w, "open", a->n_open);
    json_count(w, "slip", a->n_slip);
    json_count(w, "stick", a->n_stick);
    json_real(w, "u_n_lowest", a->lowest[0]);
    json_real(w, "u_n_highest", a->highest[0]);
    json_real(w, "u_t_lowest", a->lowest[1]);
    json_real(w, "u_t_highest", a->highest[1]);
    json_count(w, "found_times", a->patterns);
    json_count(w, "continuum_with", a->joined);
  }
}

static void write_theory_contacts(json *w, const model *m,
                                  const theorems_report *t) {
  ARRAY(w, "contacts");
  for (EACH(const theorems_contact, c, t->contacts, t->n_contact)) {
    ITEM(w);
    json_string(w, "contact",
                c->contact_id < 0 ? "" : m->contacts[c->contact_id].name);
    json_real(w, "mu", c->mu);
    json_real(w, "mu_unique", c->limit);
    json_real(w, "factor", c->factor);
    json_real(w, "contraction", c->rate);
    json_real(w, "mu_contraction", c->suggested);
    json_real(w, "normal_eigenvalue", c->normal);
    json_real(w, "tangential_eigenvalue", c->tangent);
    json_string(w, "mu_is", mu_regime_text(c->regime));
  }
}

static void write_bound(json *w, const char *name, const theorems_bound *b) {
  OBJECT(w, name);
  if (b->why != NULL) {
    json_string(w, "missing", b->why);
  } else {
    json_real(w, "left", b->left);
    json_real(w, "right", b->right);
    json_flag(w, "violated", b->violated);
  }
}

static void write_path(json *w, const theorems_path *p) {
  if (!p->asked) return;
  OBJECT(w, "theorem_3_2");
  if (p->why != NULL)
    json_string(w, "missing", p->why);
  else
    json_real(w, "stress_contraction", p->rate);
  json_real(w, "stress_bound", p->bound);
  json_real(w, "lipschitz", p->speed);
  json_real(w, "dt_contraction", p->longest);
  json_real(w, "step_time", p->span);
  json_real(w, "maps_to_contract", p->passes);
  json_flag(w, "violated", p->violated);
}

static void write_theory(json *w, const model *m, const theorems_report *t) {
  if (!t->asked) return;
  OBJECT(w, "theory");
  write_theory_contacts(w, m, t);
  write_bound(w, "bound_3_9", &t->total);
  write_bound(w, "bound_3_10", &t->change);
  write_path(w, &t->path);
  json_real(w, "inequality_least", t->inequality);
  json_count(w, "inequality_fields", t->n_field);
  if (t->has_start) json_real(w, "start_least", t->start);
  json_flag(w, "violated", t->violated);
}

static void write_increment(json *w, const model *m,
                            const increment_summary *s) {
  ITEM(w);
  json_count(w, "step", s->step_no);
  json_count(w, "increment", s->increment_no);
  json_count(w, "attempt", s->attempt);
  json_real(w, "time", s->t);
  json_real(w, "dt", s->dt);
  json_count(w, "open", s->count.open);
  json_count(w, "slip", s->count.slip);
  json_count(w, "stick", s->count.stick);
  json_count(w, "iterations", s->iterations);
  json_real(w, "residual", s->residual);
  if (s->mesh_error.asked)
    json_real(w, "mesh_error_percent", 100 * s->mesh_error.relative);
  if (s->mesh_error.asked && s->mesh_error.why != NULL)
    json_flag(w, "coarse_mesh", 1);
  if (s->time_error.asked)
    json_real(w, "time_error_percent", 100 * s->time_error.relative);
  if (s->balance.asked) {
    json_real(w, "balanced_wanted_percent", 100 * s->balance.wanted);
    json_real(w, "balanced_residual", s->balance.tol);
    json_count(w, "balanced_passes", s->balance.passes);
  }
  if (s->exact.asked) {
    json_real(w, "true_error_percent", 100 * s->exact.energy);
    json_real(w, "true_displacement_error_percent",
              100 * s->exact.displacement);
    json_real(w, "true_stress_error_percent", 100 * s->exact.stress);
    json_real(w, "true_pressure_error_percent", 100 * s->exact.pressure);
  }
  if (s->error.asked) {
    json_real(w, "solver_error_percent", 100 * s->error.relative);
    json_real(w, "solver_error_energy", s->error.energy);
    json_real(w, "contraction", s->error.rate);
    if (s->error.why != NULL)
      json_string(w, "solver_error_missing", s->error.why);
  }
  if (s->rounding.found) {
    json_real(w, "rounding_energy_percent", 100 * s->rounding.energy);
    json_real(w, "rounding_stress_percent", 100 * s->rounding.stress);
    json_real(w, "rounding_displacement_percent", 100 * s->rounding.u);
  }
  if (!s->settled && s->error.hidden > 0.1)
    json_real(w, "rounding_hidden_percent", 100 * s->error.hidden);
  json_real(w, "energy_defect", s->defect);
  json_flag(w, "settled", s->settled);
  if (s->after_miss) json_flag(w, "after_unsettled", 1);
  json_string(w, "outcome", outcome_code((outcome)s->outcome));
  if (s->jumps) json_real(w, "jump_time", s->jump_t);
  write_solutions(w, s);
  write_theory(w, m, &s->theorems);
}

static void write_resting(json *w, const flow_tally *t) {
  if (!(t->asked > 0.0)) return;
  json_real(w, "threshold_evaluations", t->asked);
  json_real(w, "threshold_resting", t->resting);
}

static void write_warnings(json *w, const message_log *log) {
  message_view v;
  ARRAY(w, "warnings");
  for (int k = 0; log != NULL && message_get(log, k, &v); ++k) {
    if (v.level != WARNING) continue;
    ITEM(w);
    json_string(w, "number", text_of("P%d", (int)v.id));
    json_count(w, "line", v.at != NULL ? v.at->line_no : 0);
    json_string(w, "text", v.text);
  }
}

/* All that the run has read, the deck first, as seen from its folder. */
static void write_files(json *w, const deck *d) {
  if (d == NULL) return;
  const char *slash = strrchr(d->inputs[0], '/');
  const size_t n = slash != NULL ? (size_t)(slash - d->inputs[0]) + 1 : 0;
  ARRAY(w, "files");
  for (int i = 0; i < d->n_input; ++i) {
    const int within = strncmp(d->inputs[i], d->inputs[0], n) == 0;
    json_string(w, NULL, d->inputs[i] + (within ? n : 0));
  }
}

static void write_increments(json *w, const job *j) {
  ARRAY(w, "increments");
  for (int i = 0; i < j->run->n_increment; ++i)
    write_increment(w, j->m, &j->run->increments[i]);
}

static void write_job(json *w, const job *j) {
  ITEM(w);
  json_string(w, "program", "protis");
  json_string(w, "version", j->o->version);
  json_string(w, "job", j->m->name.job);
  json_string(w, "title", j->m->name.title);
  json_string(w, "blas_kernel", j->o->kernel);
  json_count(w, "threads", j->o->threads);
  write_exit(w, j->run);
  write_files(w, j->m->deck);
  write_warnings(w, j->m->log);
  write_effects(w, j);
  write_omitted(w, j->m);
  write_sizes(w, j);
  write_accuracy(w, j);
  write_goals(w, j);
  write_contacts(w, j);
  write_passes(w, j);
  write_cost(w, j->o);
  write_resting(w, &j->run->tally);
  write_increments(w, j);
}

static void write_all(FILE *f, const void *what) {
  write_job(&(json){.f = f}, what);
  fputc('\n', f);
}

status json_write(const job *j, const char *path) {
  return text_replace(path, j, write_all);
}
