/*
 * The chapters of the manual in their order; what the tables of the program add
 * to them and list: methods, laws, integrators, columns; the examples.
 */
#include "manual/manual.h"

#include "base/base.h"
#include "model/keyword/keyword.h"
#include "output/columns/columns.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

/* The deck that has the name of its folder. */
static int is_main_deck(const embedded_file *f) {
  const size_t n = strlen(f->folder);
  return strncmp(f->name, f->folder, n) == 0 &&
         strcmp(f->name + n, ".inp") == 0;
}

const char *example_name(const void *ctx, int i) {
  for (const embedded_file *f = embedded_files; f->folder != NULL; ++f)
    if (is_main_deck(f) && i-- == 0) return f->folder;
  return NULL;
}

static void examples_print(FILE *out) {
  static const char heading[] = "*HEADING\n";
  for (const embedded_file *f = embedded_files; f->folder != NULL; ++f) {
    if (!is_main_deck(f)) continue;
    const char *at = strstr(f->text, heading);
    const char *title = at == NULL ? "" : at + sizeof heading - 1;
    fprintf(out, "%-18s %.*s\n", f->folder, (int)strcspn(title, "\n"), title);
  }
  fputs("protis --example NAME copies one into the current folder\n", out);
}

/* As a file of the current folder, which must not be there. */
static status write_new(const embedded_file *f) {
  int fd = open(f->name, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW, 0666);
  if (fd < 0) RAISE(ERR_FILE, "%s: cannot write: %s", f->name, strerror(errno));
  FILE *out = fdopen(fd, "w");
  size_t n = out == NULL ? 0 : fwrite(f->text, 1, f->size, out);
  int failed = out == NULL ? close(fd) != 0 : fclose(out) != 0;
  if (n != f->size || failed)
    RAISE(ERR_FILE, "%s: cannot write: %s", f->name, strerror(errno));
  return OK;
}

status example_copy(const char *name, FILE *out) {
  struct stat info;
  int found = 0;
  for (const embedded_file *f = embedded_files; f->folder != NULL; ++f) {
    if (strcmp(f->folder, name) != 0) continue;
    found |= is_main_deck(f);
    if (lstat(f->name, &info) == 0)
      RAISE(ERR_FILE, "%s is there already; nothing is copied", f->name);
  }
  if (!found) RAISE(ERR_DECK, "there is no example %s", name);
  for (const embedded_file *f = embedded_files; f->folder != NULL; ++f) {
    if (strcmp(f->folder, name) != 0) continue;
    PASS(write_new(f));
    fprintf(out, "%s\n", f->name);
  }
  return OK;
}

static const embedded_file *embedded_find(const char *name) {
  for (const embedded_file *f = embedded_files; f->folder != NULL; ++f)
    if (strcmp(f->folder, "manual") == 0 && strcmp(f->name, name) == 0)
      return f;
  return NULL;
}

/* Name in capitals, source, manual text and options of a plug-in. */
static void list_plugin(const char *name, const char *reference,
                        const char *help, const option *options, FILE *out) {
  for (const char *p = name; *p != '\0'; ++p)
    fputc(toupper((unsigned char)*p), out);
  fprintf(out, "  (%s)\n  ", reference);
  for (const char *p = help; *p != '\0'; ++p) {
    fputc(*p, out);
    if (*p == '\n') fputs("  ", out);
  }
  fputc('\n', out);
  option_print(options, out);
}

/* The part of methods.txt that begins with the name; an empty line ends it. */
static void print_method(const char *name, FILE *out) {
  const char *p = embedded_find("methods.txt")->text;
  const size_t n = strlen(name);
  while (strncasecmp(p, name, n) != 0 || p[n] != ' ') p = strstr(p, "\n\n") + 2;
  fprintf(out, "%.*s\n", (int)(strstr(p, "\n\n") - p), p);
}

static void list_solvers(FILE *out) {
  print_method("auto", out);
  for (int i = 0; solver_list[i] != NULL; ++i) {
    const solver_ops *s = solver_list[i];
    fputc('\n', out);
    print_method(s->name, out);
    option_print(s->options, out);
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

/* The scenes that have a column, if not all; its dataset, if named apart. */
static void print_column(const column *c, FILE *out) {
  static const struct {
    unsigned bit;
    const char *name;
  } scenes[] = {{SCENE_PLANE, "plane"},
                {SCENE_AXI, "axisymmetric"},
                {SCENE_SOLID, "3-D"},
                {SCENE_LCP, "LCP"}};
  char text[800];
  size_t n = snprintf(text, sizeof text, "%s", c->help);
  unsigned of = c->scenes & ~SCENE_LCP ? c->scenes : SCENE_LCP;
  for (int i = 0; i < 4 && (c->scenes & SCENE_ALL) != SCENE_ALL; ++i)
    if (of & scenes[i].bit && n < sizeof text)
      n += snprintf(text + n, sizeof text - n, "; %s", scenes[i].name);
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

/* The line of a deck that opens a card, or NULL. */
static const char *find_card_in(const char *text, const char *name) {
  const size_t n = strlen(name);
  for (const char *p = text; p != NULL; p = strchr(p, '\n')) {
    if (*p == '\n') ++p;
    if (*p == '*' && strncmp(p + 1, name, n) == 0 &&
        (p[n + 1] == ',' || p[n + 1] == '\n'))
      return p;
  }
  return NULL;
}

/* A card and its data lines: to the next card or comment. */
static void print_card(const char *p, FILE *out) {
  do {
    const int n = (int)strcspn(p, "\n");
    fprintf(out, "%.*s\n", n, p);
    p += n + (p[n] == '\n');
  } while (*p != '*' && *p != '\0');
}

static void print_kind(const char *title, const char *kind, FILE *out) {
  fprintf(out, "\n## %s\n\n```\n", title);
  list_print(kind, out);
  fputs("```\n", out);
}

/* Every card with its example, then what cards can name. */
static void print_cards(FILE *out) {
  for (const keyword *k = keyword_table; k->name != NULL; ++k) {
    const char *example = NULL;
    for (const embedded_file *f = embedded_files; f->folder && !example; ++f)
      if (strcmp(f->folder, "manual") == 0 && strstr(f->name, ".inp") != NULL)
        example = find_card_in(f->text, k->name);
    fprintf(out, "\n### \\*%s\n\n```\n", k->name);
    keywords_print(k->name, out);
    fputs("```\n", out);
    if (example == NULL) continue;
    fputs("\nFor example\n\n```\n", out);
    print_card(example, out);
    fputs("```\n", out);
  }
  print_kind("Methods of the contact solver", "solvers", out);
  print_kind("Laws of materials", "materials", out);
  print_kind("Friction laws", "friction", out);
  print_kind("Integrators of \\*VISCO", "integrators", out);
}

static void print_columns(FILE *out) {
  fputs("\n```\n", out);
  list_print("columns", out);
  fputs("```\n", out);
}

static const struct {
  const char *name, *file;
  void (*more)(FILE *out); /* what follows the file, or NULL */
} chapters[] = {{"tutorial", "tutorial.md", NULL},
                {"deck", "deck.md", print_cards},
                {"results", "results.md", print_columns},
                {"theory", "theory.md", NULL},
                {"axisymmetry", "axisymmetry.md", NULL},
                {"accuracy", "accuracy.md", NULL},
                {"effects", "effects.md", NULL},
                {"batch", "batch.md", NULL},
                {"abaqus", "abaqus.md", NULL},
                {"trouble", "trouble.md", NULL},
                {"messages", "messages.md", NULL},
                {"gallery", "gallery.md", NULL},
                {"verification", "verification.md", NULL},
                {"changes", "changes.md", NULL}};
enum { CHAPTERS = sizeof chapters / sizeof *chapters };

const char *manual_chapter(const void *ctx, int i) {
  return i < CHAPTERS ? chapters[i].name : NULL;
}

void manual_file(const char *name, FILE *out) {
  fputs(embedded_find(name)->text, out);
}

/* Name and title, which is the first line. */
static void print_title(int i, FILE *out) {
  const embedded_file *f = embedded_find(chapters[i].file);
  const char *text = f->text + strspn(f->text, "# ");
  fprintf(out, "  %-13s %.*s\n", chapters[i].name, (int)strcspn(text, "\n"),
          text);
}

int manual_print(const char *chapter, FILE *out) {
  if (chapter == NULL) fputs("protis --manual CHAPTER, one of\n", out);
  for (int i = 0; i < CHAPTERS; ++i) {
    if (chapter == NULL) print_title(i, out);
    if (chapter == NULL || strcasecmp(chapter, chapters[i].name) != 0) continue;
    manual_file(chapters[i].file, out);
    if (chapters[i].more != NULL) chapters[i].more(out);
    return 1;
  }
  return chapter == NULL;
}
