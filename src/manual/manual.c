/*
 * The chapters of the manual in their order, and what tables add to them.
 */
#include "manual/manual.h"

#include "base/message.h"
#include "manual/embedded.h"
#include "model/keyword/keyword.h"

#include <string.h>
#include <strings.h>

const embedded_file *embedded_find(const char *folder, const char *name) {
  for (const embedded_file *f = embedded_files; f->folder != NULL; ++f)
    if (strcmp(f->folder, folder) == 0 && strcmp(f->name, name) == 0) return f;
  return NULL;
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

/* The same of the pattern decks. */
static const char *find_card(const char *name) {
  const char *found = NULL;
  for (const embedded_file *f = embedded_files; f->folder && !found; ++f)
    if (strcmp(f->folder, "manual") == 0 && strstr(f->name, ".inp") != NULL)
      found = find_card_in(f->text, name);
  return found;
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
    const char *example = find_card(k->name);
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

static void print_messages(FILE *out) {
  fputs("\n```\n", out);
  message_explain(NULL, out);
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
                {"messages", "messages.md", print_messages},
                {"gallery", "gallery.md", NULL},
                {"verification", "verification.md", NULL},
                {"changes", "changes.md", NULL}};
enum { CHAPTERS = sizeof chapters / sizeof *chapters };

const char *manual_chapter(const void *ctx, int i) {
  (void)ctx;
  return i < CHAPTERS ? chapters[i].name : NULL;
}

/* Name and title, which is the first line. */
static void print_title(int i, FILE *out) {
  const embedded_file *f = embedded_find("manual", chapters[i].file);
  const char *text = f->text + strspn(f->text, "# ");
  fprintf(out, "  %-13s %.*s\n", chapters[i].name, (int)strcspn(text, "\n"),
          text);
}

int manual_print(const char *chapter, FILE *out) {
  if (chapter == NULL) fputs("protis --manual CHAPTER, one of\n", out);
  for (int i = 0; i < CHAPTERS; ++i) {
    if (chapter == NULL) print_title(i, out);
    if (chapter == NULL || strcasecmp(chapter, chapters[i].name) != 0) continue;
    fputs(embedded_find("manual", chapters[i].file)->text, out);
    if (chapters[i].more != NULL) chapters[i].more(out);
    return 1;
  }
  return chapter == NULL;
}
