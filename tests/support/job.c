/*
 * Runs of the program for the tests.
 */
#define _GNU_SOURCE /* posix_spawn_file_actions_addchdir_np */
#include "support/job.h"

#include "support/folder.h"
#include "support/kept_mesh.h"
#include "support/unit.h"

#include <ctype.h>
#include <fcntl.h>
#include <glob.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum { PATH = 512, LINE = 8192, WORDS = 64 };

job job_begin(const char *name) {
  job j = {.dir = ""};
  folder_new(j.dir);
  snprintf(j.name, sizeof j.name, "%s", name);
  return j;
}

void job_end(job *j) {
  folder_remove(j->dir);
  free(j->errors);
  free(j->text);
  j->errors = j->text = NULL;
}

static void write_deck(FILE *f, const char *deck) {
  const char *end = strstr(deck, "*END STEP");
  if (&job_without_fields == NULL || strstr(deck, "*OUTPUT") != NULL)
    end = NULL;
  if (end == NULL) end = deck;
  fwrite(deck, 1, (size_t)(end - deck), f);
  if (end > deck) fputs("*OUTPUT, HDF5=NO\n", f);
  fputs(end, f);
}

static void write_file(const job *j, const char *file, const char *format,
                       va_list args) {
  char path[PATH], *text = NULL;
  size_t size;
  snprintf(path, sizeof path, "%s/%s", j->dir, file);
  FILE *f = fopen(path, "w"), *memory = open_memstream(&text, &size);
  ck_assert(f != NULL && memory != NULL);
  vfprintf(memory, format, args);
  fclose(memory);
  write_deck(f, text);
  free(text);
  ck_assert_int_eq(fclose(f), 0);
}

void job_write(const job *j, const char *file, const char *format, ...) {
  va_list args;
  va_start(args, format);
  write_file(j, file, format, args);
  va_end(args);
}

void job_copy(const job *j, const char *path) { folder_copy(j->dir, path); }

job job_with(const char *name, const char *mesh, const char *format, ...) {
  job j = job_begin(name);
  char deck[64];
  va_list args;
  if (mesh != NULL) job_copy(&j, mesh);
  snprintf(deck, sizeof deck, "%s.inp", name);
  va_start(args, format);
  write_file(&j, deck, format, args);
  va_end(args);
  return j;
}

void job_copy_meshes(const job *j, const char *deck) {
  static const char *const patterns[] = {"*.geo", "*.msh"};
  int length = (int)(strrchr(deck, '/') + 1 - deck);
  for (int k = 0; k < 2; ++k) {
    char all[PATH];
    glob_t files;
    snprintf(all, sizeof all, "%.*s%s", length, deck, patterns[k]);
    if (glob(all, 0, NULL, &files) == 0)
      for (size_t i = 0; i < files.gl_pathc; ++i)
        job_copy(j, files.gl_pathv[i]);
    globfree(&files);
  }
}

void job_coarsen(const char *deck, char *words, size_t size) {
  char line[LINE], name[8];
  double value, parts;
  FILE *f = fopen(deck, "r");
  ck_assert_ptr_nonnull(f);
  words[0] = '\0';
  while (fgets(line, sizeof line, f) != NULL) {
    const size_t n = strlen(words);
    if (sscanf(line, "DT = \"1/%lf\"", &parts) == 1)
      snprintf(words + n, size - n, " -D DT=%g", 4 / parts);
    if (sscanf(line, "%7[A-Z0-9] = %lf", name, &value) != 2) continue;
    if (strcmp(name, "DT") == 0)
      snprintf(words + n, size - n, " -D DT=%g", 4 * value);
    else if (strcmp(name, "CYCLES") == 0 || strcmp(name, "PERIODS") == 0 ||
             strcmp(name, "END") == 0)
      snprintf(words + n, size - n, " -D %s=%g", name, value / 5);
    else if (strspn(name, "NC12") == strlen(name) && value >= 8)
      snprintf(words + n, size - n, " -D %s=%g", name,
               value / (value > 15 ? 4 : 2));
  }
  fclose(f);
}

char *job_deck_text(const char *deck) {
  char path[PATH];
  snprintf(path, sizeof path, "%s.inp", deck);
  char *text = file_read(path, NULL);
  ck_assert_msg(text != NULL, "%s", path);
  return text;
}

char *job_file(const job *j, const char *suffix) {
  char path[PATH];
  snprintf(path, sizeof path, "%s/%s.%s", j->dir, j->name, suffix);
  return file_read(path, NULL);
}

int job_has(const job *j, const char *suffix) {
  char path[PATH];
  snprintf(path, sizeof path, "%s/%s.%s", j->dir, j->name, suffix);
  return access(path, F_OK) == 0;
}

void job_clear(const job *j) {
  char files[PATH];
  glob_t found;
  snprintf(files, sizeof files, "%s/%s.[!ig]*", j->dir, j->name);
  if (glob(files, 0, NULL, &found) == 0)
    for (size_t i = 0; i < found.gl_pathc; ++i)
      ck_assert_int_eq(remove(found.gl_pathv[i]), 0);
  globfree(&found);
}

/* The CPU of all stages is the sum of theirs, as far as it is printed. */
static void check_sum(const char *stages) {
  const char *all = strstr(stages, "all stages"), *at = stages;
  double cpu, sum = 0.0, most = 5e-4;
  long calls, bytes;
  if (all == NULL || sscanf(all + 10, "%lf", &cpu) != 1) return;
  for (double of; (at = strchr(at, '\n')) < all; ++at)
    if (strlen(at) > 33 &&
        sscanf(at + 33, "%ld %lf %ld", &calls, &of, &bytes) == 3 && calls > 0) {
      sum += of;
      most += 5e-4;
    }
  ck_assert(cpu >= 0.0);
  ck_assert_double_le(fabs(cpu - sum), most);
}

long job_stage(const job *j, const char *name, long *bytes) {
  char *text = job_file(j, "lst"), *end;
  ck_assert_ptr_nonnull(text);
  const char *all = strstr(text, "COST\n"),
             *at = all == NULL ? NULL : strstr(all, name);
  ck_assert_msg(at != NULL, "no stage '%s'", name);
  check_sum(all);
  long calls = strtol(at + strlen(name), &end, 10);
  strtod(end, &end);
  if (bytes != NULL) *bytes = strtol(end, NULL, 10);
  free(text);
  return calls;
}

const char *job_program(void) {
  const char *p = getenv("PROTIS");
  return p == NULL ? "build/release/protis" : p;
}

/* Cut a command into its words, ended by NULL; 0: only a shell can. */
static int cut(char *command, char *words[WORDS]) {
  char *to = command;
  int n = 0;
  if (strpbrk(command, "\\$`*?[|&;<>~#\n") != NULL) return 0;
  for (const char *at = command; *(at += strspn(at, " ")) != '\0';) {
    char quote = '\0';
    if (n == WORDS - 1) return 0;
    words[n++] = to;
    for (; *at != '\0' && (quote != '\0' || *at != ' '); ++at)
      if (*at == quote)
        quote = '\0';
      else if (quote == '\0' && (*at == '\'' || *at == '"'))
        quote = *at;
      else
        *to++ = *at;
    at += *at != '\0';
    *to++ = '\0';
  }
  words[n] = NULL;
  return n;
}

/* Start a program in "dir": what waitpid says of its end. */
static int spawn(char *const *words, const char *dir, const char *out,
                 const char *errors) {
  enum { FLAGS = O_WRONLY | O_CREAT | O_TRUNC };
  posix_spawn_file_actions_t to;
  pid_t pid;
  int code;
  posix_spawn_file_actions_init(&to);
  posix_spawn_file_actions_addopen(&to, STDOUT_FILENO, out, FLAGS, 0666);
  posix_spawn_file_actions_addopen(&to, STDERR_FILENO, errors, FLAGS, 0666);
  posix_spawn_file_actions_addchdir_np(&to, dir);
  ck_assert_int_eq(posix_spawn(&pid, words[0], &to, NULL, words, environ), 0);
  posix_spawn_file_actions_destroy(&to);
  ck_assert_int_eq(waitpid(pid, &code, 0), pid);
  return code;
}

/* Run a command of the shell in "dir" and keep what it printed; the shell is
 * started where the command needs one. Where meshes are kept for all programs,
 * by tools/run_tests, they are read once. */
static int run_command(job *j, const char *dir, const char *command) {
  char text[8 * PATH], out[PATH], errors[PATH], *words[WORDS];
  char *shell[] = {"/bin/sh", "-c", (char *)command, NULL};
  char *old = getenv("LD_PRELOAD");
  snprintf(text, sizeof text, "%s", command);
  snprintf(out, sizeof out, "%s/stdout.txt", j->dir);
  snprintf(errors, sizeof errors, "%s/stderr.txt", j->dir);
  const int alone = cut(text, words) > 0 && words[0][0] == '/';
  if (old != NULL) old = strdup(old);
  kept_mesh_preload(old != NULL ? old : "");
  const int code = spawn(alone ? words : shell, dir, out, errors);
  if (old != NULL)
    setenv("LD_PRELOAD", old, 1);
  else
    unsetenv("LD_PRELOAD");
  free(old);
  free(j->errors);
  j->errors = file_read(errors, NULL);
  free(j->text);
  j->text = file_read(out, NULL);
  const char *none = j->errors == NULL ? NULL : strstr(j->errors, "(null)");
  ck_assert_msg(none == NULL, "a name is missing: %s", j->errors);
  return WIFEXITED(code) ? WEXITSTATUS(code) : 1000 + WTERMSIG(code);
}

/* What identifies a file and its contents; 0 where there is none. */
static struct stat about_file(const job *j, const char *suffix) {
  char path[PATH];
  struct stat about = {0};
  snprintf(path, sizeof path, "%s/%s.%s", j->dir, j->name, suffix);
  stat(path, &about);
  return about;
}

static int is_same(const struct stat *a, const struct stat *b) {
  return a->st_ino == b->st_ino && a->st_mtim.tv_sec == b->st_mtim.tv_sec &&
         a->st_mtim.tv_nsec == b->st_mtim.tv_nsec;
}

const char *job_contradiction(const job *j, int code) {
  static const char *const files[][3] = {{"lst", "\nEND\n---\n", "exit "},
                                         {"json", "\"exit\": {", "\"code\": "}};
  for (int k = 0; k < 2; ++k) {
    char *text = job_file(j, files[k][0]);
    const char *at = text != NULL ? strstr(text, files[k][1]) : NULL;
    if (at != NULL) at = strstr(at, files[k][2]);
    const int other = at != NULL && atoi(at + strlen(files[k][2])) != code;
    free(text);
    if (other) return files[k][0];
  }
  return NULL;
}

/* The same for the program alone: the files of a run have its exit code. */
static int run_program(job *j, const char *dir, const char *command) {
  const struct stat before = about_file(j, "lst");
  const int code = run_command(j, dir, command);
  const struct stat after = about_file(j, "lst");
  if (is_same(&before, &after)) return code;
  const char *other = job_contradiction(j, code);
  ck_assert_msg(other == NULL, "exit %d, another in %s.%s", code, j->name,
                other);
  return code;
}

/* The program with its full path. */
static void find_program(char *path) {
  char cwd[PATH];
  const char *p = job_program();
  if (p[0] == '/') {
    snprintf(path, PATH, "%s", p);
    return;
  }
  ck_assert_ptr_nonnull(getcwd(cwd, sizeof cwd));
  snprintf(path, PATH, "%.250s/%.250s", cwd, p);
}

void job_preload(const char *name) {
  char program[PATH], path[2 * PATH];
  find_program(program);
  snprintf(path, sizeof path, "%.*stests/preload/%s.so",
           (int)(strrchr(program, '/') + 1 - program), program, name);
  ck_assert_msg(access(path, R_OK) == 0, "%s is not there", path);
  setenv("LD_PRELOAD", path, 1);
}

int job_run(job *j, const char *words) {
  char path[PATH], command[4 * PATH];
  find_program(path);
  snprintf(command, sizeof command, "'%s' %s %s", path, j->name, words);
  return run_program(j, j->dir, command);
}

int job_shell(job *j, const char *command) {
  char path[PATH], all[8 * PATH];
  const char *old = getenv("PATH");
  find_program(path);
  snprintf(all, sizeof all, "%.*s:%s", (int)(strrchr(path, '/') - path), path,
           old);
  setenv("PATH", all, 1);
  int code = run_command(j, j->dir, command);
  setenv("PATH", old, 1);
  return code;
}

int job_run_deck(job *j, const char *deck, const char *words) {
  char path[PATH], command[4 * PATH];
  const char *slash = strrchr(deck, '/');
  snprintf(j->name, sizeof j->name, "%s", slash == NULL ? deck : slash + 1);
  find_program(path);
  snprintf(command, sizeof command, "'%s' '%s' -o '%s' %s", path, deck, j->dir,
           words);
  return run_program(j, ".", command);
}

job job_deck(const char *deck, const char *words) {
  job j = job_begin("deck");
  int code = job_run_deck(&j, deck, words);
  ck_assert_msg(code == 0, "%s %s: exit %d: %s", deck, words, code, j.errors);
  return j;
}

int job_run_with(job *j, const char *deck, const char *cards, int without,
                 const char *words) {
  char path[PATH], text[LINE];
  char *all = job_deck_text(deck);
  int fields = &job_without_fields == NULL || strstr(all, "*OUTPUT") != NULL ||
               strstr(cards, "*OUTPUT") != NULL;
  free(all);
  *j = job_begin(strrchr(deck, '/') + 1);
  job_copy_meshes(j, deck);
  snprintf(path, sizeof path, "%s.inp", deck);
  FILE *from = fopen(path, "r");
  ck_assert_msg(from != NULL, "%s: not there", path);
  snprintf(path, sizeof path, "%s/%s.inp", j->dir, j->name);
  FILE *to = fopen(path, "w");
  ck_assert_ptr_nonnull(to);
  while (fgets(text, sizeof text, from) != NULL) {
    if (without && strncmp(text, "*ACCURACY", 9) == 0) continue;
    if (strncmp(text, "*END STEP", 9) == 0) {
      if (!fields) fputs("*OUTPUT, HDF5=NO\n", to);
      fputs(cards, to);
      fields = 1; /* said once, it holds for later steps */
    }
    fputs(text, to);
  }
  fclose(from);
  ck_assert_int_eq(fclose(to), 0);
  return job_run(j, words);
}

static double read_cell(const char *cell) {
  static const char *const words[] = {"OPEN", "SLIP", "STICK"};
  for (int i = 0; i < 3; ++i)
    if (strcmp(cell, words[i]) == 0) return i;
  char *end;
  double value = strtod(cell, &end);
  return *end == '\0' ? value : NAN;
}

/* Names of the header line "# node_no[-] x[length]". */
static void read_header(char *line, dat *d) {
  d->name = calloc(64, sizeof *d->name);
  char *save = NULL, *word = strtok_r(line + 1, " \t\n", &save);
  for (; word != NULL && d->n_col < 64; word = strtok_r(NULL, " \t\n", &save)) {
    char *unit = strchr(word, '[');
    if (unit != NULL) *unit = '\0';
    snprintf(d->name[d->n_col++], sizeof *d->name, "%s", word);
  }
}

static void read_rows(FILE *f, dat *d) {
  char line[LINE];
  int capacity = 0;
  while (fgets(line, sizeof line, f) != NULL && line[0] != '\n' &&
         line[0] != '#') {
    if (d->n_row == capacity) {
      capacity = capacity == 0 ? 64 : 2 * capacity;
      d->value =
          realloc(d->value, (size_t)(capacity * d->n_col) * sizeof *d->value);
      ck_assert_ptr_nonnull(d->value);
    }
    char *save = NULL, *word = strtok_r(line, " \t\n", &save);
    for (int c = 0; c < d->n_col; ++c) {
      ck_assert_ptr_nonnull(word);
      d->value[d->n_row * d->n_col + c] = read_cell(word);
      word = strtok_r(NULL, " \t\n", &save);
    }
    ++d->n_row;
  }
}

/* 1 if the line opens a block of that kind: "# step ... table KIND". */
static int opens_block(const char *line, const char *kind) {
  const char *word =
      strncmp(line, "# step ", 7) == 0 ? strstr(line, " table ") : NULL;
  size_t n = strlen(kind);
  return word != NULL && strncmp(word + 7, kind, n) == 0 &&
         !isalnum((unsigned char)word[7 + n]);
}

/* Where a file was read to: the next of its tables is looked for from there. */
typedef struct reached {
  char path[PATH], kind[32];
  struct stat file;
  int k; /* tables of the kind that were passed */
  long at;
} reached;

static int goes_on(const reached *r, const reached *now) {
  return strcmp(r->path, now->path) == 0 && strcmp(r->kind, now->kind) == 0 &&
         r->k <= now->k && r->file.st_ino == now->file.st_ino &&
         r->file.st_size == now->file.st_size &&
         r->file.st_mtim.tv_sec == now->file.st_mtim.tv_sec &&
         r->file.st_mtim.tv_nsec == now->file.st_mtim.tv_nsec;
}

/* Start of block k of the kind, k < 0: of the last; -1: there is none. */
static long find_block(FILE *f, reached *now) {
  static reached last;
  char line[LINE];
  long wanted = -1;
  int found = 0, k = now->k;
  if (fstat(fileno(f), &now->file) == 0 && goes_on(&last, now)) {
    found = last.k;
    fseek(f, last.at, SEEK_SET);
  }
  while ((wanted < 0 || k < 0) && fgets(line, sizeof line, f) != NULL)
    if (opens_block(line, now->kind) && (found++ == k || k < 0))
      wanted = ftell(f);
  if (wanted < 0 || k < 0) return wanted;
  last = *now;
  last.k = found;
  last.at = wanted;
  return wanted;
}

dat job_table(const job *j, const char *kind, int k) {
  char line[LINE];
  reached now = {.k = k};
  snprintf(now.path, sizeof now.path, "%s/%s.dat", j->dir, j->name);
  snprintf(now.kind, sizeof now.kind, "%s", kind);
  FILE *f = fopen(now.path, "r");
  ck_assert_msg(f != NULL, "no %s; stderr: %s", now.path, j->errors);
  long wanted = find_block(f, &now);
  ck_assert_msg(wanted >= 0, "no block %d of table %s in %s", k, kind,
                now.path);
  dat d = {0};
  fseek(f, wanted, SEEK_SET);
  ck_assert_ptr_nonnull(fgets(line, sizeof line, f));
  read_header(line, &d);
  read_rows(f, &d);
  fclose(f);
  return d;
}

void dat_free(dat *d) {
  free(d->name);
  free(d->value);
  *d = (dat){0};
}

int dat_column(const dat *d, const char *name) {
  for (int c = 0; c < d->n_col; ++c)
    if (strcmp(d->name[c], name) == 0) return c;
  ck_abort_msg("no column %s", name);
  return -1;
}

int dat_has(const dat *d, const char *name) {
  for (int c = 0; c < d->n_col; ++c)
    if (strcmp(d->name[c], name) == 0) return 1;
  return 0;
}

double dat_at(const dat *d, int row, const char *name) {
  ck_assert(row >= 0 && row < d->n_row);
  return d->value[row * d->n_col + dat_column(d, name)];
}

int dat_row_near(const dat *d, const char *name, double value) {
  int best = 0, c = dat_column(d, name);
  for (int i = 1; i < d->n_row; ++i)
    if (fabs(d->value[i * d->n_col + c] - value) <
        fabs(d->value[best * d->n_col + c] - value))
      best = i;
  return best;
}

double dat_sum(const dat *d, const char *name) {
  double sum = 0.0;
  for (int i = 0; i < d->n_row; ++i) sum += dat_at(d, i, name);
  return sum;
}

double dat_max(const dat *d, const char *name) {
  double most = 0.0;
  for (int i = 0; i < d->n_row; ++i)
    most = fmax(most, fabs(dat_at(d, i, name)));
  return most;
}

double job_told(const job *j, const char *name) {
  char wanted[80], *json = job_file(j, "json"), *last = NULL;
  double value = NAN;
  snprintf(wanted, sizeof wanted, "\"%s\": ", name);
  for (char *at = json; (at = strstr(at, wanted)) != NULL;)
    last = at += strlen(wanted);
  ck_assert_msg(last != NULL, "%s is not told", name);
  sscanf(last, "%lf", &value);
  free(json);
  return value;
}

double job_difference(const job *a, const job *b, int k) {
  dat x = job_table(a, "CONTACT", k), y = job_table(b, "CONTACT", k);
  dat e = job_table(b, "ENERGY", k);
  double sum = 0.0;
  for (int i = 0; i < x.n_row; ++i) {
    sum += (dat_at(&x, i, "gap") - dat_at(&y, i, "gap")) *
           (dat_at(&x, i, "f_n") - dat_at(&y, i, "f_n"));
    sum += (dat_at(&x, i, "u_t") - dat_at(&y, i, "u_t")) *
           (dat_at(&x, i, "f_t") - dat_at(&y, i, "f_t"));
  }
  double energy = dat_at(&e, 0, "strain_energy");
  dat_free(&x);
  dat_free(&y);
  dat_free(&e);
  return 100.0 * sqrt(fabs(sum) / (2.0 * energy));
}

int dat_zone(const dat *z, int kind) {
  int row = 0;
  while (row < z->n_row && dat_at(z, row, "zone") != kind) ++row;
  ck_assert_int_lt(row, z->n_row);
  return row;
}

double job_unknowns(const job *j) {
  char *json = job_file(j, "json"), *last = NULL;
  for (char *at = strstr(json, "\"passes\""); at != NULL;
       at = strstr(at + 1, "\"unknowns\": "))
    if (strncmp(at, "\"unknowns\": ", 12) == 0 &&
        strstr(at, "\"changed_next\"") != NULL)
      last = at;
  ck_assert_ptr_nonnull(last);
  const double value = atof(last + 12);
  free(json);
  return value;
}

double job_value(const job *j, const char *kind, int k, const char *name) {
  DAT d = job_table(j, kind, k);
  return dat_at(&d, 0, name);
}

double job_sum(const job *j, const char *kind, int k, const char *name) {
  DAT d = job_table(j, kind, k);
  return dat_sum(&d, name);
}

double job_max(const job *j, const char *kind, int k, const char *name) {
  DAT d = job_table(j, kind, k);
  return dat_max(&d, name);
}

double job_potential(const job *j, double *strain) {
  DAT e = job_table(j, "ENERGY", -1);
  *strain = dat_at(&e, 0, "strain_energy");
  return *strain - 2.0 * dat_at(&e, 0, "external_work");
}

int job_tells(const job *j, const char *text) {
  FREED char *lst = job_file(j, "lst");
  ck_assert_ptr_nonnull(lst);
  return strstr(lst, text) != NULL;
}

double job_cpu(void) {
  struct rusage r;
  ck_assert_int_eq(getrusage(RUSAGE_CHILDREN, &r), 0);
  return (double)(r.ru_utime.tv_sec + r.ru_stime.tv_sec) +
         1e-6 * (double)(r.ru_utime.tv_usec + r.ru_stime.tv_usec);
}
