/*
 * What the tables of the program list: methods, laws, integrators, columns.
 */
#include "base/option.h"
#include "base/text.h"
#include "manual/manual.h"
#include "output/columns/columns.h"
#include "run/run.h"

#include <ctype.h>
#include <string.h>

/* Name in capitals, source and manual text. */
static void print_entry(const char *name, const char *reference,
                        const char *help, FILE *out) {
  for (const char *p = name; *p != '\0'; ++p)
    fputc(toupper((unsigned char)*p), out);
  fprintf(out, "  (%s)\n  ", reference);
  for (const char *p = help; *p != '\0'; ++p) {
    fputc(*p, out);
    if (*p == '\n') fputs("  ", out);
  }
  fputc('\n', out);
}

/* The same with the options of a plug-in. */
static void list_plugin(const char *name, const char *reference,
                        const char *help, const option *options, FILE *out) {
  print_entry(name, reference, help, out);
  option_print(options, out);
}

static void list_solvers(FILE *out) {
  print_entry("AUTO", "the default", auto_help, out);
  for (int i = 0; solver_list[i] != NULL; ++i) {
    const solver_ops *s = solver_list[i];
    fputc('\n', out);
    list_plugin(s->name, s->reference, s->help, s->options, out);
    if (s->entries == NULL)
      fputs("  works with STIFFNESS=DENSE and FACTOR\n", out);
    else
      fprintf(out, "  %s needs the entries: STIFFNESS=DENSE\n", s->entries);
  }
}

static void list_friction(FILE *out) {
  for (int i = 0; friction_list[i] != NULL; ++i) {
    const friction_ops *f = friction_list[i];
    if (i > 0) fputc('\n', out);
    list_plugin(f->name, f->reference, f->help, f->options, out);
    if (f->value_name != NULL)
      fprintf(out, "  data line: %s, unit %s\n", f->value_name, f->value_unit);
  }
}

/* Rows of a data line of a law: name, unit, what it is if absent, help. */
static void list_fields(const option *rows, const char *title, FILE *out) {
  char text[200];
  if (rows == NULL) return;
  fprintf(out, "  %s: %s\n", title, law_line_text(rows, text, sizeof text));
  for (const option *o = rows; o->name != NULL; ++o) {
    fprintf(out, "    %-10s %s", o->name, o->help);
    if (strcmp(o->unit, "-") != 0) fprintf(out, ", unit %s", o->unit);
    if (o->initial != NULL && strcmp(o->initial, OPTION_ABSENT) != 0)
      fprintf(out, "; %s if absent", o->initial);
    fputc('\n', out);
  }
}

static void list_materials(FILE *out) {
  fputs(
      "elastic  (CPR98 2.2)\n  *ELASTIC, TYPE=ISO, ORTHO or ANISO: linear "
      "elasticity, any symmetric and\n  positive definite a_ijkl\n\n"
      "With *INELASTIC, LAW=:\n",
      out);
  for (int i = 0; law_list[i] != NULL; ++i) {
    const law_ops *law = law_list[i];
    fputc('\n', out);
    list_plugin(law->name, law->reference, law->help, law->options, out);
    list_fields(law->fields,
                law->terms == NULL ? "data line" : "first data line", out);
    list_fields(law->terms,
                law->fields == NULL ? "data lines" : "then, a term a line",
                out);
    for (const char *p = law->example; *p != '\0';) {
      const int n = (int)strcspn(p, "\n");
      fprintf(out, "  %s %.*s\n",
              p == law->example ? "for example" : "           ", n, p);
      p += n + (p[n] != '\0');
    }
  }
}

static void list_integrators(FILE *out) {
  for (int i = 0; scheme_list[i] != NULL; ++i)
    fprintf(out, "%s  (%s)\n  %s\n", scheme_list[i]->name,
            scheme_list[i]->reference, scheme_list[i]->help);
}

/* The scenes that have a column, if not all; its dataset, if of another name.
 */
static void print_column(const column *c, FILE *out) {
  static const struct {
    unsigned bit;
    const char *name;
  } scenes[] = {{SCENE_PLANE, "plane"},
                {SCENE_AXI, "axisymmetric"},
                {SCENE_SOLID, "3-D"},
                {SCENE_LCP, "LCP"}};
  char text[800];
  size_t n = (size_t)snprintf(text, sizeof text, "%s", c->help);
  unsigned of = c->scenes & ~(unsigned)SCENE_LCP ? c->scenes : SCENE_LCP;
  for (int i = 0; i < 4 && (c->scenes & SCENE_ALL) != SCENE_ALL; ++i)
    if (of & scenes[i].bit && n < sizeof text)
      n += (size_t)snprintf(text + n, sizeof text - n, "; %s", scenes[i].name);
  if (c->field != NULL && strcmp(c->field, c->name) != 0 && n < sizeof text)
    snprintf(text + n, sizeof text - n, "; JOB.h5: %s", c->field);
  fprintf(out, "  %-18s %-14s ", c->name, c->unit);
  text_wrap(out, text, 36);
}

/* The columns of a table of *PRINT; with bit 0 those of JOB.h5 alone. */
static void list_table(const char *name, const char *help, unsigned bit,
                       FILE *out) {
  fprintf(out, "%s: %s\n", name, help);
  const column *c;
  for (column_walk k = {0}; (c = column_next(&k)) != NULL;)
    if (bit == 0 ? (c->tables & COLUMN_TABLES) == 0 : (c->tables & bit) != 0)
      print_column(c, out);
}

static void list_columns(FILE *out) {
  fputs(
      "name, unit (- for none), meaning and sign; where not all scenes have "
      "the\ncolumn those that do\n\n",
      out);
#define LIST_TABLE(name, help)                \
  list_table(#name, help, PRINT_##name, out); \
  fputc('\n', out);
  PRINT_LIST(LIST_TABLE)
  list_table("JOB.h5", "what stands in no table", 0, out);
}

static const struct {
  const char *name;
  void (*print)(FILE *out);
} kinds[] = {{"solvers", list_solvers},   {"materials", list_materials},
             {"friction", list_friction}, {"integrators", list_integrators},
             {"columns", list_columns},   {"examples", examples_print}};
enum { KINDS = sizeof kinds / sizeof *kinds };

const char *list_kind(const void *ctx, int i) {
  (void)ctx;
  return i < KINDS ? kinds[i].name : NULL;
}

int list_print(const char *kind, FILE *out) {
  for (int i = 0; i < KINDS; ++i)
    if (strcmp(kind, kinds[i].name) == 0) {
      kinds[i].print(out);
      return 1;
    }
  return 0;
}
