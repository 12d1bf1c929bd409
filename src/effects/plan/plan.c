/*
 * The rows of the plan: the table of the effects, and which are active;
 * the plan as text, and the measured costs of the run.
 */
#include "effects/plan/plan.h"

#include "effects/plan/effect.h"

#include <stdarg.h>

int plan_says(int on, const reason *why, const char *format, ...) {
  va_list list;
  va_start(list, format);
  if (why != NULL) vsnprintf(why->text, why->size, format, list);
  va_end(list);
  return on;
}

int plan_at(const reason *why, const place *at, const char *format, ...) {
  va_list list;
  va_start(list, format);
  const int n = why == NULL ? 0 : vsnprintf(why->text, why->size, format, list);
  va_end(list);
  if (why != NULL && n >= 0 && (size_t)n < why->size)
    snprintf(why->text + n, why->size - n, ", %s:%d", PLACE(*at));
  return 1;
}

/* 1: *EFFECTS leaves out an effect that the deck requires. */
static int is_omitted(const model *m, int bit) {
  int any = 0;
  for (int i = 0; i < m->reduction.n; ++i)
    any |= m->reduction.row[i].bit == bit && !m->reduction.row[i].back;
  return any && !(m->effects >> bit & 1u);
}

/* The reason of a row with a bit in a deck with *CONDENSED PROBLEM. */
static void say_of_problem(const model *m, const effect_ops *e,
                           const reason *why) {
  if (e->bit == EFFECT_BIT_CONTACT)
    plan_at(why, &m->problem.at, "*CONDENSED PROBLEM");
  else if (e->bit == EFFECT_BIT_FRICTION)
    plan_says(1, why, "mu of *CONDENSED PROBLEM, %s:%d, is %s",
              PLACE(m->problem.at),
              m->problem.friction ? "not zero" : "zero or not there");
  else if (e->bit != EFFECT_BIT_ESTIMATES || m->dim == 1)
    plan_says(1, why, "not part of a condensed problem");
}

static void row_of(const plan_sizes *s, const effect_ops *e, plan_row *r) {
  const model *m = s->m;
  *r = (plan_row){
      .name = e->name, .on = effect_is_on(e, m), .within = e->within};
  const reason why = {r->why, sizeof r->why};
  e->required(m, &why);
  if (e->bit != NO_BIT && m->problem.given)
    say_of_problem(m, e, &why);
  else if (e->bit != NO_BIT && is_omitted(m, e->bit))
    plan_at(&why, &m->reduction.at, "left out by *EFFECTS, MODE=AUTO");
  if (effect_stage(e) != STAGE_NONE) r->stages[r->n_stage++] = effect_stage(e);
  for (int k = 0; e->more[k] != 0; ++k) r->stages[r->n_stage++] = e->more[k];
  r->work = e->expected(s);
  if (!r->on) r->work = (effect_work){.kind = r->work.kind};
}

static status add_row(effect_plan *p, int *capacity, const plan_row *r) {
  PASS_GROW(p->rows, p->n, *capacity);
  p->rows[p->n++] = *r;
  return OK;
}

/* Elements of a section whose law counts. */
static double flowing_elements(const model *m, const mesh *msh, int id) {
  int n = 0;
  for (int e = 0; e < msh->n_elem; ++e)
    n += m->elem_section[e] == id && model_flows(m, e);
  return n;
}

/* One row for each group whose material has a law; the first has the stage. */
static status add_laws(const model *m, const mesh *msh, effect_plan *p,
                       int *capacity, const plan_row *all) {
  int first = 1;
  for (int i = 0; i < m->n.section && msh != NULL; ++i) {
    const material *mat = plan_material(m, i);
    plan_row r = *all;
    if (mat->law.ops == NULL) continue;
    snprintf(r.of, sizeof r.of, "%s", m->sections[i].elset);
    if (r.on)
      plan_at(&(reason){r.why, sizeof r.why}, &mat->law.at, "%s of material %s",
              mat->law.ops->name, mat->name);
    r.work.items = r.on ? flowing_elements(m, msh, i) : 0.0;
    r.work.operations *= r.work.items / fmax(1.0, all->work.items);
    if (!first) {
      r.n_stage = 0;
      r.within = "the first group";
    }
    first = 0;
    PASS(add_row(p, capacity, &r));
  }
  if (first) PASS(add_row(p, capacity, all));
  return OK;
}

double plan_output(const plan_sizes *s) {
  double sum = 0.0;
  for (int k = 0; effect_table[k] != NULL; ++k) {
    const effect_ops *e = effect_table[k];
    const int writes = e->table.bit != 0 || e->own == STAGE_HDF5 ||
                       e->own == STAGE_FCLIB || e->own == STAGE_LISTING;
    if (writes && e->expected != NULL && effect_is_on(e, s->m))
      sum += e->expected(s).operations;
  }
  return sum;
}

status plan_new(const model *m, const mesh *msh, int n, effect_plan **out) {
  int capacity = 0;
  MAKES(effect_plan, p, out);
  PASS(plan_sizes_find(m, msh, n, &p->sizes));
  for (int k = 0; effect_table[k] != NULL; ++k) {
    plan_row r;
    if (effect_table[k]->expected == NULL) continue;
    row_of(&p->sizes, effect_table[k], &r);
    if (effect_table[k]->bit == EFFECT_BIT_INELASTIC)
      PASS(add_laws(m, msh, p, &capacity, &r));
    else
      PASS(add_row(p, &capacity, &r));
  }
  double sum = 0.0;
  for (int i = 0; i < p->n; ++i) sum += p->rows[i].work.operations;
  for (int i = 0; i < p->n && sum > 0.0; ++i)
    p->rows[i].share = p->rows[i].work.operations / sum;
  return OK;
}

static int is_default(const step *s) {
  return s->accuracy.mesh == MESH_ERROR_END;
}

status plan_leave_out(model *m, const mesh *msh) {
  if (facts_first_step(m, is_default) == NULL || model_targeted_goal(m) != NULL)
    return OK;
  OWNED_OF(effect_plan, p, plan_new(m, msh, 0, &p));
  double share = 0.0;
  for (int i = 0; i < p->n; ++i)
    if (p->rows[i].name == mesh_error_effect.name) share = p->rows[i].share;
  if (share <= PLAN_CHEAP) return OK;
  m->accuracy.mesh_price = share;
  for (int i = 0; i < m->n.step; ++i)
    if (is_default(&m->steps[i])) m->steps[i].accuracy.mesh = MESH_ERROR_NO;
  m->effects = effects_required(m);
  return OK;
}

stage_cost plan_cost(const plan_row *r) {
  stage_cost sum = {0, 0.0, 0};
  for (int k = 0; k < r->n_stage; ++k) {
    stage_cost c = timer_cost(r->stages[k]);
    if (k == 0) sum.calls = c.calls;
    sum.cpu += c.cpu;
    sum.bytes += c.bytes;
  }
  return sum;
}

double plan_cpu(const effect_plan *p) {
  double cpu = 0.0;
  for (int i = 0; i < p->n; ++i) cpu += plan_cost(&p->rows[i]).cpu;
  return cpu;
}

static void print_name(const plan_row *r, const char *lead, FILE *f) {
  fprintf(f, "%s%-26s %-3s", lead,
          text_of("%s%s%s", r->name, r->of[0] != '\0' ? ", " : "", r->of),
          r->on ? "on" : "off");
}

void plan_print(const effect_plan *p, const char *lead, FILE *f) {
  fprintf(f, "%s%-26s %-3s %18s %7s  %s\n", lead, "effect", "", "size",
          "cpu[%]", "required by");
  for (EACH(const plan_row, r, p->rows, p->n)) {
    print_name(r, lead, f);
    fprintf(f, " %18s %7s  %s\n",
            r->on && r->work.kind != NULL
                ? text_of("%.0f %.*s", r->work.items,
                          (int)strlen(r->work.kind) - (r->work.items == 1.0),
                          r->work.kind)
                : "",
            r->on ? text_of("%.1f", 100 * r->share) : "", r->why);
  }
}

static void print_row(const plan_row *r, double cpu, int cost, FILE *f) {
  stage_cost c = plan_cost(r);
  print_name(r, "  ", f);
  fprintf(f, " %11s", r->on ? text_of("%.1f", 100 * r->share) : "");
  if (r->n_stage == 0 && r->on) {
    fprintf(f, "  part of %s\n", r->within);
    return;
  }
  if (cost) fprintf(f, " %8.1f", cpu > 0.0 ? 100 * c.cpu / cpu : 0.0);
  fprintf(f, " %9s %7ld",
          r->on && r->work.calls >= 0 && r->n_stage > 0
              ? text_of("%.0f", r->work.calls)
              : "",
          c.calls);
  if (cost) fprintf(f, " %10.3f %14zu", c.cpu, c.bytes);
  fputc('\n', f);
}

void plan_print_cost(const effect_plan *p, int cost, FILE *f) {
  double cpu = plan_cpu(p);
  fprintf(f, "  %-26s %-3s %11s", "effect", "", "expected[%]");
  if (cost) fprintf(f, " %8s", "cpu[%]");
  fprintf(f, " %9s %7s", "expected", "calls");
  fprintf(f, cost ? " %10s %14s\n" : "\n", "cpu[s]", "bytes");
  for (int i = 0; i < p->n; ++i) print_row(&p->rows[i], cpu, cost, f);
}
