/* From cards to the model: the driver over the keyword table. */
#include "model/keyword/keyword.h"

/* ---- decks with *CONDENSED PROBLEM: what is allowed with it ------------- */

/* Cards allowed with *CONDENSED PROBLEM. */
static int goes_with_problem(const char *name) {
  static const char *const names[] = {
      "HEADING", "PARAMETER", "INCLUDE",  "LEGACY", "UNITS",  "STEP",
      "STATIC",  "SOLVER",    "ACCURACY", "PRINT",  "OUTPUT", "END STEP"};
  if (strcmp(name, "CONDENSED PROBLEM") == 0) return 1;
  for (size_t k = 0; k < sizeof names / sizeof *names; ++k)
    if (strcmp(name, names[k]) == 0) return 1;
  return 0;
}

static void check_problem_cards(const reading *r) {
  const model *m = r->m;
  for (EACH(const card, c, m->deck->cards, m->deck->n_card)) {
    const keyword *row = keyword_find(c->name);
    if (row != NULL && !goes_with_problem(c->name))
      message_add(m->log, P2034, &c->at,
                  "*%s is not allowed with *CONDENSED PROBLEM, line %d",
                  c->name, m->problem.at.line_no);
  }
  for (int i = 1; i < m->n.step; ++i)
    message_add(m->log, P2034, &m->steps[i].at,
                "a condensed problem is solved in one step, this is number %d",
                i + 1);
}

/* The bound of the error factors the matrix, which costs more than many
 * solutions: only on request. */
static void check_problem_accuracy(const reading *r, step *s) {
  int others = s->accuracy.mesh == MESH_ERROR_YES || s->accuracy.time ||
               s->accuracy.theorems || r->m->accuracy.target.percent > 0.0;
  if (!s->accuracy.given)
    s->accuracy.no_solver = 1;
  else if (others)
    message_add(r->m->log, P2034, &s->accuracy.at,
                "a condensed problem has no mesh: of *ACCURACY only SOLVER= is "
                "allowed with it");
  s->accuracy.mesh = MESH_ERROR_NO;
}

/* problem.c: what a deck with *CONDENSED PROBLEM may hold; its one step and
 * table if it has none. After model_resolve. */
static status model_finish_problem(reading *r) {
  check_problem_cards(r);
  step *s = &r->m->steps[0];
  for (int i = 0; i < s->print.n; ++i)
    if (s->print.requests[i].table != PRINT_CONTACT ||
        s->print.requests[i].group != NULL)
      message_add(r->m->log, P2034, &s->print.requests[i].at,
                  "a condensed problem has no mesh: only *PRINT, CONTACT "
                  "without GROUP= has rows");
  check_problem_accuracy(r, s);
  s->kind = STEP_STATIC;
  if (!(s->total > 0.0)) s->total = 1.0;
  s->dt = s->dt_min = s->total;
  s->output.frequency = -1;
  s->restart.frequency = -1;
  if (s->print.n > 0 || (s->print.ended & PRINT_CONTACT)) return OK;
  PASS_GROW(s->print.requests, s->print.n, s->print.cap);
  s->print.requests[s->print.n++] =
      (print_request){.table = PRINT_CONTACT, .frequency = 1, .at = s->at};
  return OK;
}

/* Name of row i of two tables one after the other. */
typedef struct two_tables {
  const option *first, *second;
} two_tables;

static const char *either_name(const void *ctx, int i) {
  const two_tables *t = ctx;
  for (const option *o = t->first; o != NULL && o->name != NULL; ++o)
    if (i-- == 0) return o->name;
  return t->second == NULL ? NULL : t->second[i].name;
}

/* Read one parameter into the struct its row belongs to. */
static void read_parameter(reading *r, const option *row, const parameter *p,
                           void *into) {
  char why[256];
  if (option_read(row, p->has_value ? p->value.text : NULL, into, why,
                  sizeof why) == 0)
    return;
  r->misread = 1;
  message_add(r->m->log, P2004, p->has_value ? &p->value.at : &p->at,
              "*%s, %s: %s", r->card->name, p->name, why);
}

/* A name that no row has: not reported with a law or method that is not
 * known, whose option it may be. */
static void unknown_parameter(reading *r, const parameter *p,
                              const two_tables *all, const plugin *named) {
  char text[256], of[128] = "";
  r->misread = 1;
  if (named->parameter != NULL && named->name == NULL &&
      card_parameter(r->card, named->parameter) != NULL)
    return;
  if (named->name != NULL)
    snprintf(of, sizeof of, ", %s=%.80s", named->parameter, named->name);
  snprintf(text, sizeof text, "*%.80s%s has no parameter ", r->card->name, of);
  unknown_word(r->m->log, P2003, &p->at, text, p->name, either_name, all);
}

/* A parameter is not missing where another one was not understood. */
static void report_missing(const reading *r, const option *table) {
  if (r->misread) return;
  for (const option *o = table; o != NULL && o->name != NULL; ++o)
    if (o->initial == NULL && card_parameter(r->card, o->name) == NULL)
      message_add(r->m->log, P2005, &r->card->at,
                  "*%s needs the parameter %s= (%s)", r->card->name, o->name,
                  o->help);
}

void keyword_parameters(const keyword *row, reading *r, card_options *param,
                        void *plugin_param) {
  const card *c = r->card;
  memset(param, 0, sizeof *param);
  memset(plugin_param, 0, PARAM_SIZE);
  r->param = param;
  r->plugin = NULL;
  if (row->options != NULL) option_defaults(row->options, param);
  r->misread = c->damaged;
  for (int i = 0; i < c->n_parameter; ++i) {
    const option *o = option_find(row->options, c->parameters[i].name);
    if (o != NULL) read_parameter(r, o, &c->parameters[i], param);
  }
  plugin named = {NULL, 0, NULL, NULL};
  if (row->names != NULL) {
    named = row->names(r);
    r->plugin_size = named.size;
    if (named.options != NULL) option_defaults(named.options, plugin_param);
    if (named.size > 0) r->plugin = plugin_param;
  }
  two_tables all = {row->options, named.options};
  for (EACH(const parameter, p, c->parameters, c->n_parameter)) {
    if (option_find(row->options, p->name) != NULL) continue;
    const option *o = option_find(named.options, p->name);
    if (o != NULL)
      read_parameter(r, o, p, plugin_param);
    else
      unknown_parameter(r, p, &all, &named);
  }
  report_missing(r, row->options);
  report_missing(r, named.options);
}

/* 1 if the card may stand here; opens and closes the blocks. */
static int right_place(reading *r, const keyword *row) {
  message_log *log = r->m->log;
  const card *c = r->card;
  if (r->in_step) {
    if (row->where & IN_STEP) return 1;
    message_add(log, P2006, &c->at,
                "*%s does not belong inside a step; end the step first with "
                "*END STEP",
                c->name);
    return 0;
  }
  if (row->where & IN_MATERIAL) {
    if (r->material_id >= 0) return 1;
    if (r->lost_material) return 0;
    message_add(log, P2006, &c->at, "*%s must follow its *MATERIAL card",
                c->name);
    return 0;
  }
  r->material_id = -1;
  r->lost_material = 0;
  if (row->where & IN_MODEL) {
    if (r->m->n.step == 0 || strcmp(row->name, "STEP") == 0) return 1;
    message_add(log, P2006, &c->at, "*%s must stand before the first *STEP",
                c->name);
    return 0;
  }
  if (r->lost_step) {
    r->lost_step = strcmp(row->name, "END STEP") != 0;
    return 0;
  }
  message_add(log, P2006, &c->at, "*%s belongs between *STEP and *END STEP",
              c->name);
  return 0;
}

static int right_lines(const reading *r, const keyword *row) {
  const card *c = r->card;
  if (c->n_record < row->min_line) {
    message_add(r->m->log, P2007, &c->at, "*%s needs %d data line%s: %s",
                c->name, row->min_line, row->min_line == 1 ? "" : "s",
                row->data);
    return 0;
  }
  if (row->max_line < 0 || c->n_record <= row->max_line) return 1;
  if (row->max_line == 0)
    message_add(r->m->log, P2008, &c->records[0].at, "*%s has no data lines",
                c->name);
  else
    message_add(r->m->log, P2008, &c->records[row->max_line].at,
                "*%s has at most %d data line%s: %s", c->name, row->max_line,
                row->max_line == 1 ? "" : "s", row->data);
  return 0;
}

static void unknown_card(reading *r) {
  const card *c = r->card;
  const char *near =
      message_wanted(r->m->log)
          ? nearest_word(c->name, candidate_name, NAMES(keyword_table, INT_MAX))
          : NULL;
  place at = c->at; /* a file that is included may be no deck at all */
  at.hidden |= near == NULL && at.from != NULL;
  message_add(r->m->log, P1003, &at, "unknown card *%s%s%s%s", c->name,
              near == NULL ? "" : "; did you mean *", near == NULL ? "" : near,
              near == NULL ? "" : "?");
  if (near == NULL || r->in_step) return;
  if (strcmp(near, "STEP") == 0) r->lost_step = 1;
  if (strcmp(near, "MATERIAL") == 0) {
    r->lost_material = 1;
    r->material_id = -1;
  }
}

static status read_card(reading *r) {
  card_options param;
  _Alignas(16) char plugin_param[PARAM_SIZE];
  const keyword *row = keyword_find(r->card->name);
  if (row == NULL) unknown_card(r);
  if (row != NULL && row->where & LANGUAGE) return OK;
  if (row == NULL || !right_place(r, row)) {
    r->lost = 1;
    return OK;
  }
  keyword_parameters(row, r, &param, plugin_param);
  /* A card that has no lines means the same with some. */
  if (right_lines(r, row) || row->max_line == 0)
    PASS(row->apply(r));
  else
    r->lost = 1;
  return OK;
}

/* Name of the job: the file without folder and .inp. */
static status name_job(model *m) {
  const char *slash = strrchr(m->deck->file, '/');
  const char *base = slash == NULL ? m->deck->file : slash + 1;
  PASS_GET(m->name.job, memory_text(base));
  size_t length = strlen(m->name.job);
  if (length > 4 && same_word(m->name.job + length - 4, ".inp"))
    m->name.job[length - 4] = '\0';
  return OK;
}

/* What the deck lacks; not after a refused card, which may be the one. */
static void report_absent(const reading *r) {
  const model *m = r->m;
  place at = {.file = m->deck->file};
  if (r->lost) return;
  if (m->deck->n_card > 0) at = m->deck->cards[m->deck->n_card - 1].at;
  if (!m->mesh.given && !m->problem.given)
    message_add(m->log, P2015, &at, "the deck has no *MESH card");
  if (m->n.section == 0 && !m->problem.given)
    message_add(
        m->log, P2016, &at,
        "the deck has no *SOLID SECTION: the elements have no material");
  if (m->n.step == 0 && !m->problem.given)
    message_add(m->log, P2017, &at, "the deck has no *STEP: nothing to solve");
  if (r->in_step)
    message_add(m->log, P2019, &m->steps[m->n.step - 1].at,
                "this *STEP is not closed by *END STEP");
}

status model_from_deck(deck *d, message_log *log, model **out) {
  MAKES(model, m, out);
  m->deck = d;
  m->log = log;
  m->name.title = "";
  PASS(name_job(m));
  reading r = {.m = m,
               .material_id = -1,
               .axisymmetric = axisymmetric_names(d),
               .is_lost = name_is_lost,
               .lost = message_count(log, ERROR) > 0};
  for (int i = 0; i < d->n_card; ++i) {
    r.card = &d->cards[i];
    PASS(read_card(&r));
  }
  report_absent(&r);
  if (m->problem.given && m->n.step == 0) {
    /* A problem from a file needs no *STEP. */
    PASS_GROW(m->steps, m->n.step, m->cap.step);
    m->steps[m->n.step++] = (step){.name = "", .at = m->problem.at};
  }
  PASS(model_resolve(m, r.lost));
  if (m->problem.given) PASS(model_finish_problem(&r));
  return message_status(log, ERR_DECK);
}
