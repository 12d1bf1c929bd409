/*
 * The plan as text, and the measured costs of the run.
 */
#include "base/memory.h"
#include "effects/plan/plan.h"

#include <string.h>

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
  char text[120];
  snprintf(text, sizeof text, "%s%s%s", r->name, r->of[0] != '\0' ? ", " : "",
           r->of);
  fprintf(f, "%s%-26s %-3s", lead, text, r->on ? "on" : "off");
}

void plan_print(const effect_plan *p, const char *lead, FILE *f) {
  fprintf(f, "%s%-26s %-3s %18s %7s  %s\n", lead, "effect", "", "size",
          "cpu[%]", "called for by");
  for (int i = 0; i < p->n; ++i) {
    const plan_row *r = &p->rows[i];
    char size[40] = "";
    print_name(r, lead, f);
    if (r->on && r->work.kind != NULL)
      snprintf(size, sizeof size, "%.0f %s", r->work.items, r->work.kind);
    fprintf(f, " %18s", size);
    if (r->on)
      fprintf(f, " %7.1f", 100 * r->share);
    else
      fprintf(f, " %7s", "");
    fprintf(f, "  %s\n", r->why);
  }
}

static void print_row(const plan_row *r, double cpu, int cost, FILE *f) {
  stage_cost c = plan_cost(r);
  char calls[24] = "", expected[24] = "";
  if (r->on) snprintf(expected, sizeof expected, "%.1f", 100 * r->share);
  if (r->on && r->work.calls >= 0 && r->n_stage > 0)
    snprintf(calls, sizeof calls, "%.0f", r->work.calls);
  print_name(r, "  ", f);
  fprintf(f, " %11s", expected);
  if (r->n_stage == 0 && r->on) {
    fprintf(f, "  part of %s\n", r->within);
    return;
  }
  if (cost) fprintf(f, " %8.1f", cpu > 0.0 ? 100 * c.cpu / cpu : 0.0);
  fprintf(f, " %9s %7ld", calls, c.calls);
  if (cost) fprintf(f, " %10.3f %14zu", c.cpu, c.bytes);
  fputc('\n', f);
}

void plan_print_cost(const effect_plan *p, int cost, FILE *f) {
  double cpu = plan_cpu(p);
  fprintf(f, "  %-26s %-3s %11s", "effect", "", "foreseen[%]");
  if (cost) fprintf(f, " %8s", "cpu[%]");
  fprintf(f, " %9s %7s", "foreseen", "calls");
  fprintf(f, cost ? " %10s %14s\n" : "\n", "cpu[s]", "bytes");
  for (int i = 0; i < p->n; ++i) print_row(&p->rows[i], cpu, cost, f);
}
