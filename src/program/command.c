/* The command line: options, their help, and queries without a job. */
#include "program/command.h"

#include "base/base.h"
#include "base/system/blas.h"
#include "base/system/input.h"
#include "base/system/limits.h"
#include "manual/manual.h"
#include "program/inform.h"

#include <getopt.h>
#include <sys/resource.h>
#include <sys/stat.h>

enum {
  ASK_THREADS = 256,
  ASK_MEMORY,
  ASK_TABLE,
  ASK_FORMAT,
  ASK_KEYWORDS,
  ASK_LIST,
  ASK_EXPLAIN,
  ASK_MANUAL,
  ASK_EXAMPLE
};

static void print_help(void) {
  manual_file("help.txt", stdout);
  for (int k = 0; k < STATUS_COUNT; ++k)
    printf("  %-3d %s\n", status_exit_code((status)k), status_text((status)k));
}

/* near: what may have been meant, NULL: "seek" lists what there is. */
static int refuse(const char *what, const char *word, const char *near,
                  const char *seek) {
  fprintf(stderr, "protis: error: %s", what);
  text_put(stderr, word);
  if (near != NULL)
    fprintf(stderr, "; did you mean %s%s?\n", word[0] == '-' ? "--" : "", near);
  else
    fprintf(stderr, "; see protis %s\n", seek);
  return 2;
}

static int wrong(const char *what, const char *word) {
  return refuse(what, word, NULL, "--help");
}

static int no_memory(void) {
  fputs("protis: error: memory exhausted: the command line\n", stderr);
  return 5;
}

static int print_keywords(const char *card) {
  const char *near;
  if (inform_keywords(card, &near)) return 0;
  return refuse("there is no card ", card, near, "--help");
}

static int print_list(const char *kind) {
  if (list_print(kind, stdout)) return 0;
  return refuse("there is no list ", kind,
                inform_nearest(kind, list_kind, NULL), "--help");
}

static int print_manual(const char *chapter) {
  if (manual_print(chapter, stdout)) return 0;
  int code = refuse("there is no chapter ", chapter,
                    inform_nearest(chapter, manual_chapter, NULL), "--manual");
  manual_print(NULL, stderr);
  return code;
}

static int copy_example(const char *name) {
  status st = example_copy(name, stdout);
  if (st == ERR_DECK)
    return refuse("there is no example ", name,
                  inform_nearest(name, example_name, NULL), "--list examples");
  if (st != OK) fprintf(stderr, "protis: error: %s\n", status_message());
  return status_exit_code(st);
}

static int print_explain(const char *number) {
  if (message_explain(number, stdout)) return 0;
  return wrong("there is no message ", number);
}

static int read_threads(const char *text, command *c) {
  char *end;
  long n = strtol(text, &end, 10);
  if (*end != '\0' || end == text || n < 1 || n > 1024) return 0;
  c->threads = (int)n;
  return 1;
}

static int read_memory(const char *text, command *c) {
  return number_real(text, &c->max_memory) == NULL && c->max_memory > 0.0;
}

static const char *long_option(const void *words, int i) {
  return ((const struct option *)words)[i].name;
}

static int file_exists(const char *name) {
  struct stat info;
  return stat(name, &info) == 0;
}

static int unknown_option(const char *given, const struct option *words) {
  if (file_exists(given)) {
    fprintf(stderr,
            "protis: error: there is no option %s; a deck of that name is "
            "./%s, or stands after --\n",
            given, given);
    return 2;
  }
  return refuse("there is no option ", given,
                inform_nearest(given + strspn(given, "-"), long_option, words),
                "--help");
}

/* A word of the command line as getopt has read it. */
typedef struct given_option {
  int what;
  const char *value, *given, *next; /* next: the word after it, or NULL */
} given_option;

/* Queries without a job: the exit code. */
static int answer(const given_option *o, const struct option *words,
                  const command *c) {
  switch (o->what) {
    case 'h':
      print_help();
      return 0;
    case 'V':
      inform_version(c->commit);
      return 0;
    case ASK_KEYWORDS:
      return print_keywords(o->next);
    case ASK_LIST:
      return print_list(o->value);
    case ASK_EXPLAIN:
      return print_explain(o->next);
    case ASK_MANUAL:
      return print_manual(o->next);
    case ASK_EXAMPLE:
      return copy_example(o->value);
    case ':':
      return wrong("a value is missing after ", o->given);
    default:
      return unknown_option(o->given, words);
  }
}

/* An option whose value is the empty text; -1: it is not. */
static int refuse_empty(const given_option *o, const struct option *words) {
  char what[80];
  if (o->value == NULL || o->value[0] != '\0') return -1;
  while (words->name != NULL && words->val != o->what) ++words;
  if (words->name != NULL)
    snprintf(what, sizeof what, "the value after --%s is empty", words->name);
  else
    snprintf(what, sizeof what, "the value after -%c is empty", o->what);
  return wrong(what, "");
}

static int take_table(const char *value, command *c) {
  if (c->table != NULL) return wrong("one --table at a time", "");
  c->table = value;
  return -1;
}

/* -1: go on, else the exit code. */
static int take_option(const given_option *o, const struct option *words,
                       command *c) {
  const char *value = o->value;
  switch (o->what) {
    case 0: /* a switch, set by getopt */
      return -1;
    case 'o':
      memory_free(c->dir);
      c->dir = memory_text(value);
      return c->dir == NULL ? no_memory() : -1;
    case 'D':
      if (strchr(value, '=') == NULL)
        return wrong("-D needs NAME=VALUE, not ", value);
      c->defines[c->n_define++] = value;
      return -1;
    case ASK_TABLE:
      return take_table(value, c);
    case ASK_FORMAT:
      c->format = value;
      if (strcmp(value, "csv") == 0 || strcmp(value, "tsv") == 0) return -1;
      return wrong("--format knows csv and tsv, not ", value);
    case ASK_THREADS:
      if (read_threads(value, c)) return -1;
      return wrong("--threads needs a number from 1 to 1024, not ", value);
    case ASK_MEMORY:
      if (read_memory(value, c)) return -1;
      return wrong("--max-memory needs a number of MB above 0, not ", value);
    default:
      return answer(o, words, c);
  }
}

/* JOB or JOB.inp: the name as given if there is such a file, else with .inp. */
static char *find_deck(const char *name) {
  size_t length = strlen(name);
  char *with = memory_new(length + 5, 1);
  if (with == NULL) return NULL;
  memcpy(with, name, length + 1);
  int has = length > 4 && strcmp(name + length - 4, ".inp") == 0;
  if (!has) {
    memcpy(with + length, ".inp", 5);
    if (!file_exists(with) && file_exists(name)) with[length] = '\0';
  }
  return with;
}

/* The folder the deck stands in. */
static char *folder_of(const char *file) {
  const char *slash = strrchr(file, '/');
  if (slash == NULL) return memory_text(".");
  size_t length = slash == file ? 1 : slash - file;
  char *dir = memory_new(length + 1, 1);
  if (dir != NULL) memcpy(dir, file, length);
  return dir;
}

/* Options of which one would have no effect; -1: there are none. */
static int check_together(const command *c) {
  if (c->check_only && c->estimate_cost)
    return wrong("--estimate-cost has no effect with --check", "");
  if (c->table == NULL)
    return c->format == NULL
               ? -1
               : wrong("--format is of --table, which is not given", "");
  if (c->check_only) return wrong("--check has no effect with --table", "");
  if (c->estimate_cost)
    return wrong("--estimate-cost has no effect with --table", "");
  if (c->restart) return wrong("--restart has no effect with --table", "");
  if (c->n_define > 0) return wrong("-D has no effect with --table", "");
  return -1;
}

/* The job itself; -1: run it. */
static int take_job(int n, char **job, command *c) {
  if (n == 0 || job[0][0] == '\0') return wrong("no job given", "");
  if (n > 1) return wrong("one job at a time; not expected: ", job[1]);
  const char *slash = strrchr(job[0], '/');
  if (strchr(slash == NULL ? job[0] : slash, ':') != NULL)
    return wrong("a colon in the name of a job, which ends the name of a file "
                 "in .xdmf: ",
                 job[0]);
  c->deck_file = find_deck(job[0]);
  if (c->deck_file == NULL) return no_memory();
  if (c->dir == NULL) c->dir = folder_of(c->deck_file);
  return c->dir == NULL ? no_memory() : -1;
}

/* The word that getopt has read, or reads letter by letter. */
static const char *word_read(int argc, char **argv) {
  int at = optind < argc && optopt != 0 && argv[optind][0] == '-' &&
           argv[optind][1] == optopt;
  return argv[at ? optind : optind - 1];
}

/* Options and queries; -1: go on with the job. */
static int read_options(int argc, char **argv, command *c) {
  const struct option words[] = {
      {"check", no_argument, &c->check_only, 1},
      {"estimate-cost", no_argument, &c->estimate_cost, 1},
      {"threads", required_argument, NULL, ASK_THREADS},
      {"max-memory", required_argument, NULL, ASK_MEMORY},
      {"safe", no_argument, &c->safe, 1},
      {"restart", no_argument, &c->restart, 1},
      {"table", required_argument, NULL, ASK_TABLE},
      {"format", required_argument, NULL, ASK_FORMAT},
      {"quiet", no_argument, &c->quiet, 1},
      {"no-timing", no_argument, &c->no_timing, 1},
      {"help", no_argument, NULL, 'h'},
      {"version", no_argument, NULL, 'V'},
      {"keywords", no_argument, NULL, ASK_KEYWORDS},
      {"list", required_argument, NULL, ASK_LIST},
      {"explain", no_argument, NULL, ASK_EXPLAIN},
      {"manual", no_argument, NULL, ASK_MANUAL},
      {"example", required_argument, NULL, ASK_EXAMPLE},
      {NULL, 0, NULL, 0}};
  int what, code = -1;
  while (code < 0 &&
         (what = getopt_long(argc, argv, ":o:D:hV", words, NULL)) != -1) {
    const given_option o = {what, optarg, word_read(argc, argv),
                            optind < argc ? argv[optind] : NULL};
    code = refuse_empty(&o, words);
    if (code < 0) code = take_option(&o, words, c);
  }
  return code;
}

int command_read(int argc, char **argv, command *c, int *exit_code) {
  *c = (command){.commit = c->commit};
  opterr = 0; /* told here */
  c->defines = memory_new(argc, sizeof *c->defines);
  int code = c->defines == NULL ? no_memory() : read_options(argc, argv, c);
  if (code < 0) code = check_together(c);
  if (code < 0) code = take_job(argc - optind, argv + optind, c);
  if (code < 0) return 1;
  *exit_code = code;
  command_free(c);
  return 0;
}

/* More threads than cores wait for each other; where addresses are limited the
 * linear algebra would wait forever for buffers of its threads. */
static void set_threads(int cores, command *c, message_log *log) {
  struct rlimit addresses;
  int asked = c->threads > 0 ? c->threads : 1;
  int confined = getrlimit(RLIMIT_AS, &addresses) == 0 &&
                 addresses.rlim_cur != RLIM_INFINITY;
  int most = confined ? 1 : cores;
  c->threads = asked < most ? asked : most;
  if (c->threads < asked)
    message_add(log, P5020, NULL, "--threads %d: more than %s", asked,
                confined ? "one, with a limit of addresses (ulimit -v)"
                         : "the cores that this process may use");
  blas_set_threads(c->threads);
}

status command_apply(command *c, message_log *log) {
  limits system;
  limits_read("", &system);
  set_threads(system.cores, c, log);
  /* The settings hold for the whole process, libraries included. */
  const char *who = c->max_memory > 0.0 ? "--max-memory" : system.who;
  double bytes =
      c->max_memory > 0.0 ? 1e6 * c->max_memory - limits_held() : system.memory;
  if (bytes < 1e18) memory_limit((size_t)fmax(bytes, 0.0), who);
  if (!c->safe) return OK;
  OWNED_GET(char, folder, folder_of(c->deck_file));
  return input_confine(folder);
}

void command_free(command *c) {
  input_confine(NULL);
  RELEASE(c->deck_file, c->dir, c->defines);
  memset(c, 0, sizeof *c);
}
