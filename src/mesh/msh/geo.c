/*
 * Words of a .geo. Comments are skipped; text in quotes counts, as in
 * GetNumber("h").
 */
#include "mesh/msh/geo.h"

#include "base/base.h"
#include "base/file.h"
#include "base/system/input.h"

#include <ctype.h>
#include <errno.h>
#include <strings.h>

enum { MOST_BYTES = 1 << 26 };

static status add_file(geo_text *g, const char *folder, size_t n_folder,
                       const char *name, int merged) {
  int i = 0;
  if (g->n_file >= GEO_FILES) {
    g->is_open = 1;
    return OK;
  }
  if (name[0] == '/') n_folder = 0;
  OWNED_NEW(char, path, n_folder + strlen(name) + 1);
  if (n_folder > 0) memcpy(path, folder, n_folder);
  strcpy(path + n_folder, name);
  while (i < g->n_file && strcmp(g->file[i], path) != 0) ++i;
  g->merged[i] = (char)(g->merged[i] | merged);
  if (i < g->n_file) return OK;
  int capacity = g->file_capacity;
  PASS_GROW(g->file, g->n_file, capacity);
  PASS_GROW(g->text, g->n_file, g->file_capacity);
  g->file[g->n_file++] = path;
  path = NULL;
  return OK;
}

/* The whole file as text, NULL if it cannot be opened or is too long. */
static status load(const char *path, char **text) {
  const char *why;
  ENDS_BY(file_leave) FILE *in = input_stream(path, &why);
  if (in == NULL) return OK;
  long size = fseek(in, 0, SEEK_END) == 0 ? ftell(in) : -1;
  if (size < 0 || fseek(in, 0, SEEK_SET) != 0)
    PASS(text_failed(path, "read", errno));
  if (size < MOST_BYTES) {
    PASS_NEW(*text, size + 1);
    (*text)[fread(*text, 1, size, in)] = '\0';
    if (ferror(in)) PASS(text_failed(path, "read", errno));
  }
  return OK;
}

static int starts_name(char c) { return isalpha((unsigned char)c) || c == '_'; }
static int in_name(char c) { return isalnum((unsigned char)c) || c == '_'; }

/* After Include, Merge or ShapeFromFile: the file, if its name is in quotes. */
static status include(geo_text *g, const char *path, const char *p,
                      int merged) {
  const char *slash = strrchr(path, '/');
  p += strspn(p, " \t\r\n(");
  size_t n = *p == '"' ? strcspn(p + 1, "\"\n") : 0;
  g->is_open |= n == 0;
  if (n == 0) return OK;
  OWNED_NEW(char, name, n + 1);
  memcpy(name, p + 1, n);
  return add_file(g, path, slash != NULL ? (size_t)(slash - path) + 1 : 0, name,
                  merged);
}

/* The end of a comment or number that begins at p, or p. */
static char *pass_over(char *p, int in_quotes) {
  if (!in_quotes && strncmp(p, "//", 2) == 0) return p + strcspn(p, "\n");
  if (!in_quotes && strncmp(p, "/*", 2) == 0) {
    char *end = strstr(p + 2, "*/");
    return end != NULL ? end + 2 : p + strlen(p);
  }
  if (isdigit((unsigned char)*p))
    while (in_name(*p) || *p == '.') ++p;
  return p;
}

static status find_names(geo_text *g, const char *path, char *text) {
  int in_quotes = 0;
  for (char *p = text, *q; *p != '\0';) {
    if ((q = pass_over(p, in_quotes)) > p) {
      p = q;
      continue;
    }
    if (!starts_name(*p)) {
      in_quotes ^= *p++ == '"';
      continue;
    }
    for (q = p; in_name(*q);) ++q;
    char after = *q, *rest = pass_over(q, in_quotes);
    if (rest == q) rest += after != '\0';
    *q = '\0'; /* of the name; of the word that was there before */
    PASS_GROW(g->name, g->n_name, g->name_capacity);
    g->name[g->n_name++] = p;
    int merged = strcmp(p, "Merge") == 0 || strcmp(p, "MergeFile") == 0;
    int loads =
        merged || strcmp(p, "Include") == 0 || strcmp(p, "ShapeFromFile") == 0;
    if (after == '"') g->is_open |= loads;
    if (loads && after != '\0' && after != '"')
      PASS(include(g, path, q + 1, merged));
    in_quotes ^= after == '"';
    p = rest;
  }
  return OK;
}

status geo_read(const char *file, geo_text *g) {
  *g = (geo_text){0};
  PASS(add_file(g, NULL, 0, file, 0));
  for (int i = 0; i < g->n_file; ++i) {
    const char *path = g->file[i], *dot = strrchr(path, '.');
    if (i > 0 && (dot == NULL || strcasecmp(dot, ".geo") != 0)) continue;
    PASS(load(path, &g->text[i]));
    g->is_open |= g->text[i] == NULL; /* gmsh reports the reason */
    if (g->text[i] != NULL) PASS(find_names(g, path, g->text[i]));
  }
  return OK;
}

/* The character of a statement after a name, with the list it may be. */
static const char *after_name(const char *q) {
  q += strspn(q, " \t");
  if (strncmp(q, "[]", 2) == 0 || strncmp(q, "()", 2) == 0) q += 2;
  return q + strspn(q, " \t");
}

/* 1: the name stands in the text up to "end" and to the statement's end. */
static int has_name(const char *q, const char *end, const char *name) {
  const size_t n = strlen(name);
  for (int in_quotes = 0; q < end && *q != ';'; ++q)
    if ((in_quotes ^= *q == '"') == 0 && strncmp(q, name, n) == 0 &&
        !in_name(q[-1]) && !in_name(q[n]))
      return 1;
  return 0;
}

/* Of a name that ends at q, behind the character "before". */
static geo_setting setting_at(char before, const char *q, const char *name) {
  const char *at = after_name(q);
  const int counts = (*at == '+' || *at == '-') && at[1] == *at;
  if (counts || (*at != '\0' && strchr("+-*/", *at) != NULL && at[1] == '='))
    return GEO_CHANGES;
  if (*at != '=' || at[1] == '=' || before == '[' || before == ',')
    return GEO_SETS_NOT;
  return has_name(at, at + strlen(at), name) ? GEO_CHANGES : GEO_SETS;
}

static int lines_of(const char *p, const char *end) {
  int n = 0;
  for (; p < end; ++p) n += *p == '\n';
  return n;
}

typedef struct search { /* of what sets a name */
  const char *name;
  char before;      /* character before the word */
  int depth, asked; /* of If; of the outermost that has the name, or 0 */
  geo_setting how;
  int line; /* of the last such */
} search;

static int is_word(const char *p, const char *q, const char *word) {
  return strlen(word) == (size_t)(q - p) && strncmp(p, word, q - p) == 0;
}

/* The ) of the condition at q, or the end of the text. */
static const char *condition_end(const char *q) {
  int depth = 0;
  for (; *q != '\0'; ++q) {
    depth += (*q == '(') - (*q == ')');
    if (*q == ')' && depth == 0) break;
  }
  return q;
}

/* A word from p to q. */
static void take_word(search *s, const char *p, const char *q, int line) {
  const int begins = is_word(p, q, "If");
  geo_setting is = GEO_SETS_NOT;
  s->depth += begins;
  if ((begins || is_word(p, q, "ElseIf")) && s->asked == 0 &&
      has_name(q, condition_end(q), s->name))
    s->asked = s->depth;
  if (is_word(p, q, "EndIf") && s->depth-- == s->asked) s->asked = 0;
  if (is_word(p, q, s->name)) is = setting_at(s->before, q, s->name);
  if (is == GEO_SETS && s->depth > 0)
    is = s->asked > 0 ? GEO_CHANGES : GEO_MAY_SET;
  if (is == GEO_SETS_NOT || is < s->how) return;
  s->how = is;
  s->line = line;
}

static void find_setting(char *text, search *s) {
  int in_quotes = 0, now = 1;
  s->before = ';';
  for (char *p = text, *q; *p != '\0'; p = q) {
    if ((q = pass_over(p, in_quotes)) == p && starts_name(*p) && !in_quotes) {
      while (in_name(*q)) ++q;
      take_word(s, p, q, now);
      s->before = 'a';
    } else if (q == p) {
      in_quotes ^= *q++ == '"';
      if (!isspace((unsigned char)*p)) s->before = *p;
    }
    now += lines_of(p, q);
  }
}

status geo_sets(const geo_text *g, const char *name, geo_setting *how,
                const char **file, int *line) {
  *how = GEO_SETS_NOT;
  for (int i = 0; i < g->n_file; ++i) {
    OWNED char *text = NULL;
    search s = {.name = name};
    if (g->text[i] == NULL) continue;
    PASS(load(g->file[i], &text));
    if (text != NULL) find_setting(text, &s);
    if (s.how == GEO_SETS_NOT || s.how < *how) continue;
    *how = s.how;
    *file = g->file[i];
    *line = s.line;
  }
  return OK;
}

void geo_free(geo_text *g) {
  for (int i = 0; i < g->n_file; ++i) RELEASE(g->file[i], g->text[i]);
  RELEASE(g->file, g->text, g->name);
  *g = (geo_text){0};
}

int geo_has(const geo_text *g, const char *name) {
  for (int i = 0; i < g->n_name; ++i)
    if (strcmp(g->name[i], name) == 0) return 1;
  return g->is_open;
}

const char *geo_name(const void *geo, int i) {
  const geo_text *g = geo;
  return i < g->n_name ? g->name[i] : NULL;
}
