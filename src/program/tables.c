/* Tables of a finished job for other programs: JOB.dat as csv or tsv. */
#include "program/command.h"

#include "base/base.h"

#include <errno.h>
#include <strings.h>
#include <unistd.h>

enum { WORDS = 80, NAME_SIZE = 160 };

/* Heading of a block of the table. */
typedef struct heading {
  char step[16], increment[16], time[40], table[32], group[NAME_SIZE];
} heading;

typedef struct extract {
  const char *path; /* of JOB.dat */
  char name[32];    /* of the table wanted */
  char separator;
  int last; /* 1: only blocks of the last time */
  FILE *f;
  char *line; /* of getline */
  size_t size;
  long line_no;
  int cut;          /* 1: the last line is not whole */
  heading now, end; /* of the block read, of the last one wanted */
  int n_word;
  char *word[WORDS]; /* of the line; into it */
  int n_column, n_place, grouped;
  char column[WORDS][NAME_SIZE]; /* of all blocks */
  int place[WORDS];              /* [n_place] of the words in column; -1 */
} extract;

/* The columns that every row begins with, and what they are called in the
 * tables that have them too. */
static const char *const keys[] = {"step", "increment", "time"};

static int is_key(const char *name) {
  for (int i = 0; i < 3; ++i)
    if (strcmp(name, keys[i]) == 0) return 1;
  return 0;
}

static int split(extract *e) {
  char *rest = e->line;
  e->n_word = 0;
  for (char *w; (w = strtok_r(rest, " \t\r\n", &rest)) != NULL;)
    if (e->n_word < WORDS) e->word[e->n_word++] = w;
  return e->n_word;
}

static int at_end(extract *e) {
  const int c = getc(e->f);
  return c == EOF || ungetc(c, e->f) == EOF;
}

/* 0: no more; the last one that is cut is none. */
static int next_line(extract *e) {
  const ssize_t n = getline(&e->line, &e->size, e->f);
  ++e->line_no;
  if (n > 0 && e->line[n - 1] != '\n') e->cut = 1;
  return n > 0 && !e->cut;
}

static void begin(extract *e) {
  rewind(e->f);
  e->line_no = e->cut = 0;
}

static int same_time(const heading *a, const heading *b) {
  return strcmp(a->step, b->step) == 0 &&
         strcmp(a->increment, b->increment) == 0 &&
         strcmp(a->time, b->time) == 0;
}

/* 1: the line opens a block, whose heading is then known. */
static int read_heading(extract *e) {
  heading h = {.group = ""};
  const int n =
      sscanf(e->line,
             "# step %15s increment %15s time %39s table %31s group %159[^\n]",
             h.step, h.increment, h.time, h.table, h.group);
  if (n >= 4) e->now = h;
  return n >= 4;
}

/* The names of the columns, without units; new ones are added. */
static void read_columns(extract *e) {
  const int n = split(e);
  e->n_place = n - 1;
  for (int i = 1; i < n; ++i) {
    char *unit = strchr(e->word[i], '[');
    int k = 0;
    if (unit != NULL) *unit = '\0';
    e->place[i - 1] = -1;
    if (is_key(e->word[i])) continue;
    while (k < e->n_column && strcmp(e->column[k], e->word[i]) != 0) ++k;
    if (k == WORDS) continue;
    if (k == e->n_column)
      snprintf(e->column[e->n_column++], NAME_SIZE, "%s", e->word[i]);
    e->place[i - 1] = k;
  }
}

/* Words with a comma or a quote are quoted (RFC 4180). */
static void put_word(const extract *e, const char *word, char before) {
  const int quoted = e->separator == ',' && strpbrk(word, ",\"") != NULL;
  if (before != '\0') putchar(before);
  if (quoted) putchar('"');
  for (; *word != '\0'; ++word) {
    if (quoted && *word == '"') putchar('"');
    putchar(*word);
  }
  if (quoted) putchar('"');
}

/* The column in place k: the name of the contact comes first. */
static int shown_at(const extract *e, int k) {
  int first = 0;
  while (first < e->n_column && strcmp(e->column[first], "contact") != 0)
    ++first;
  if (first == e->n_column) return k;
  if (k == 0) return first;
  return k <= first ? k - 1 : k;
}

static void put_row(const extract *e, const char *const *value) {
  const char *const all[] = {e->now.step, e->now.increment, e->now.time};
  for (int i = 0; i < 3; ++i)
    put_word(e, value == NULL ? keys[i] : all[i], i > 0 ? e->separator : '\0');
  if (e->grouped)
    put_word(e, value == NULL ? "group" : e->now.group, e->separator);
  for (int k = 0; k < e->n_column; ++k) {
    const int c = shown_at(e, k);
    put_word(e, value == NULL ? e->column[c] : value[c], e->separator);
  }
  putchar('\n');
}

/* Blank lines part the blocks. */
static status copy_row(extract *e) {
  const char *value[WORDS];
  const int n = split(e);
  if (n == 0) return OK;
  if (n != e->n_place && at_end(e)) {
    e->cut = 1;
    return OK;
  }
  if (n != e->n_place)
    RAISE(ERR_FILE, "%s:%ld: %d value%s in a row of %d columns", e->path,
          e->line_no, n, n == 1 ? "" : "s", e->n_place);
  for (int k = 0; k < e->n_column; ++k) value[k] = "";
  for (int i = 0; i < e->n_place; ++i)
    if (e->place[i] >= 0) value[e->place[i]] = e->word[i];
  put_row(e, value);
  return OK;
}

/* All lines once: to know columns and end ("print" 0), or to print. */
static status pass(extract *e, int print) {
  int inside = 0; /* 1: before the names, 2: rows */
  begin(e);
  while (next_line(e))
    if (read_heading(e)) {
      inside = strcasecmp(e->now.table, e->name) == 0;
      if (inside && !print) e->end = e->now;
      if (inside && e->now.group[0] != '\0') e->grouped = 1;
      if (inside && print && e->last) inside = same_time(&e->now, &e->end);
    } else if (inside == 1 && e->line[0] == '#') {
      read_columns(e);
      inside = 2;
    } else if (inside == 2 && print) {
      PASS(copy_row(e));
    }
  return OK;
}

/* The tables of the file, each once. */
static void list_tables(extract *e, char *text, size_t size) {
  size_t used = 0;
  text[0] = '\0';
  begin(e);
  while (next_line(e)) {
    char word[40];
    if (!read_heading(e)) continue;
    snprintf(word, sizeof word, " %s", e->now.table);
    if (strstr(text, word) == NULL && used + strlen(word) < size)
      used += snprintf(text + used, size - used, "%s", word);
  }
}

static status print_all(extract *e) {
  char there[400];
  PASS(pass(e, 0));
  if (e->end.step[0] == '\0') {
    list_tables(e, there, sizeof there);
    RAISE(ERR_DECK,
          "%s has no table %s; it has%s; *PRINT of the deck requests others",
          e->path, e->name, there[0] != '\0' ? there : " none");
  }
  put_row(e, NULL);
  PASS(pass(e, 1));
  if (ferror(e->f)) PASS(text_failed(e->path, "read", errno));
  return OK;
}

/* NAME, NAME:last or NAME:all. */
static status read_name(const char *text, extract *e) {
  const size_t n = strcspn(text, ":");
  if (n == 0 || n >= sizeof e->name ||
      (text[n] == ':' && strcasecmp(text + n, ":last") != 0 &&
       strcasecmp(text + n, ":all") != 0))
    RAISE(ERR_DECK, "--table needs NAME, NAME:last or NAME:all, not %s", text);
  snprintf(e->name, sizeof e->name, "%.*s", (int)n, text);
  e->last = strcasecmp(text + n, ":last") == 0;
  return OK;
}

/* The name of the job of a deck JOB.inp or a table JOB.dat. */
static char *job_name(const char *file) {
  const char *slash = strrchr(file, '/');
  char *name = memory_text(slash != NULL ? slash + 1 : file);
  const size_t n = name != NULL ? strlen(name) : 0;
  if (n > 4 && (strcasecmp(name + n - 4, ".inp") == 0 ||
                strcasecmp(name + n - 4, ".dat") == 0))
    name[n - 4] = '\0';
  return name;
}

/* JOB.json is written at the end, where the lock goes. */
static status is_finished(const command *c, const char *name, int *finished) {
  OWNED char *record = NULL, *lock = NULL;
  PASS_GET(record, text_path(c->dir, name, "json"));
  PASS_GET(lock, text_path(c->dir, name, "lock"));
  *finished = access(record, F_OK) == 0 && access(lock, F_OK) != 0;
  return OK;
}

static status tell_end(const command *c, const char *name, const extract *e) {
  int finished = 0;
  PASS(is_finished(c, name, &finished));
  if (!finished)
    fprintf(stderr, "protis: warning: the run of %s has not finished\n", name);
  if (e->cut)
    fprintf(stderr, "protis: warning: %s:%ld: the last row is cut\n", e->path,
            e->line_no);
  return OK;
}

status tables_print(const command *c) {
  status st = OK;
  OWNED char *name = job_name(c->deck_file), *path = NULL;
  if (name != NULL) path = text_path(c->dir, name, "dat");
  if (path == NULL) RAISE(ERR_MEMORY, "memory exhausted: name of a file");
  OWNED_NEW(extract, e, 1);
  PASS(read_name(c->table, e));
  e->path = path;
  e->separator =
      c->format != NULL && strcmp(c->format, "tsv") == 0 ? '\t' : ',';
  e->f = fopen(path, "r");
  if (e->f == NULL) PASS(text_failed(path, "read", errno));
  st = print_all(e);
  if (st == OK) st = tell_end(c, name, e);
  fclose(e->f);
  free(e->line);
  return st;
}
