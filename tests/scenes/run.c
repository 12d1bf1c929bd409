/*
 * Rows times columns: decks, runs, verdicts, the matrix.
 */
#include "base/base.h"
#include "material/scheme/scheme.h"
#include "scenes/expect.h"
#include "scenes/scenes.h"
#include "solver/solver.h"

#include <strings.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

enum { COLUMNS = 32, NOTES = 16000, JOBS = 16, CPU_SECONDS = 1800 };

typedef struct column {
  char label[4];
  char solver[32], integrator[24];
  int velocity;
} column;

static int make_columns(column *c) {
  int n = 0;
  c[n++] = (column){"AUT", "AUTO", "", 0};
  for (int i = 0; solver_list[i] != NULL; ++i, ++n)
    snprintf(c[n].solver, sizeof c->solver, "%s", solver_list[i]->name);
  c[n++] = (column){"Fac", "AUTO, STIFFNESS=FACTOR", "", 0};
  c[n++] = (column){"Fau", "AUGLAG, STIFFNESS=FACTOR", "", 0};
  c[n++] = (column){"Fpr", "PROXIMAL, STIFFNESS=FACTOR", "", 0};
  c[n++] = (column){"Fpc", "PCG, STIFFNESS=FACTOR", "", 0};
  c[n++] = (column){"Vel", "AUTO", "", 1};
  for (int i = 0; scheme_list[i] != NULL; ++i, ++n) {
    snprintf(c[n].solver, sizeof c->solver, "AUTO");
    snprintf(c[n].integrator, sizeof c->integrator, "%s", scheme_list[i]->name);
  }
  for (int i = 0; i < n; ++i)
    if (c[i].label[0] == '\0')
      snprintf(c[i].label, sizeof c->label, "%.3s",
               c[i].integrator[0] != '\0' ? c[i].integrator : c[i].solver);
  return n;
}

static int applies(const column *c, const char *text) {
  const char *only = getenv("METHOD");
  if (only != NULL && strcasecmp(only, c->label) != 0) return 0;
  if (c->velocity) return strstr(text, "@V") != NULL;
  if (c->integrator[0] != '\0') return strstr(text, "@I") != NULL;
  return strcmp(c->solver, "AUTO") == 0 || strstr(text, "@S") != NULL;
}

/* The deck of a column: marks replaced. */
static void fill_deck(const char *from, const column *c, char *out) {
  size_t n = 0;
  for (const char *p = from; *p != '\0' && n < SCENE_DECK - 100;) {
    if (*p != '@') {
      out[n++] = *p++;
      continue;
    }
    if (p[1] == 'S')
      n += (size_t)snprintf(out + n, SCENE_DECK - n, "*SOLVER, METHOD=%s\n",
                            c->solver);
    else if (p[1] == 'V')
      n += (size_t)snprintf(out + n, SCENE_DECK - n, "%s",
                            c->velocity ? ", FORM=VELOCITY" : "");
    else
      n += (size_t)snprintf(
          out + n, SCENE_DECK - n, "INTEGRATOR=%s",
          c->integrator[0] != '\0' ? c->integrator : "MIDPOINT");
    p += 2;
  }
  out[n] = '\0';
}

static void write_mesh(const scene_row *s, const mesh_change *change,
                       const job *j, int **number) {
  char path[100];
  snprintf(path, sizeof path, "%s/scene.msh", j->dir);
  FILE *out = fopen(path, "w");
  if (out == NULL || !scene_mesh_write(out, s->mesh, change, number)) abort();
  fclose(out);
}

void scene_prepare(const scene_row *s, const job *j, char text[SCENE_DECK]) {
  static const column usual = {"AUT", "AUTO", "", 0};
  int *number = NULL;
  write_mesh(s, &s->change, j, &number);
  free(number);
  snprintf(text, SCENE_DECK, "*MESH, FILE=scene.msh\n");
  fill_deck(s->deck, &usual, text + strlen(text));
}

/* A finished run, its exit code and the file numbers of its nodes. */
typedef struct finished {
  job j;
  int code;
  int *number;
} finished;

static finished run_one(const scene_row *s, const column *c,
                        const mesh_change *change, const char *words) {
  finished f = {.j = job_begin("scene")};
  char text[SCENE_DECK];
  write_mesh(s, change, &f.j, &f.number);
  fill_deck(s->deck, c, text);
  job_write(&f.j, "scene.inp", "*MESH, FILE=scene.msh\n%s", text);
  f.code = job_run(&f.j, words == NULL ? "--no-timing" : words);
  return f;
}

static void finish(finished *f) {
  if (getenv("KEEP") == NULL) job_end(&f->j);
  free(f->number);
}

/* Row of the contact node that is the same in both tables. */
static int same_node(const finished *a, const dat *p, int row,
                     const finished *b, const dat *q) {
  int no = (int)dat_at(p, row, "node_no"), i = 0;
  while (a->number[i] != no) ++i;
  for (int k = 0; k < q->n_row; ++k)
    if ((int)dat_at(q, k, "node_no") == b->number[i]) return k;
  return -1;
}

static double size_of(const dat *d, int row, const char *name) {
  char first[40], second[40];
  if (dat_has(d, name)) return fabs(dat_at(d, row, name));
  snprintf(first, sizeof first, "%s1", name);
  snprintf(second, sizeof second, "%s2", name);
  if (!dat_has(d, first)) return 0.0;
  return hypot(dat_at(d, row, first), dat_at(d, row, second));
}

/* Sizes of forces and displacements of both runs agree node by node, over the
 * largest force or displacement. */
static int twins_agree(const finished *a, const finished *b,
                       const scene_twin *t, char *why) {
  static const struct {
    const char *name;
    int force;
  } col[] = {{"f_n", 1}, {"f_t", 1}, {"limit", 1},
             {"u_n", 0}, {"u_t", 0}, {"gap", 0}};
  dat p = job_table(&a->j, "CONTACT", -1), q = job_table(&b->j, "CONTACT", -1);
  double length = t->length == 0.0 ? 1.0 : t->length;
  double force = t->force == 0.0 ? 1.0 : t->force;
  int good = 1;
  for (size_t c = 0; c < sizeof col / sizeof *col && good; ++c) {
    double factor = col[c].force ? force : length, scale = 0.0;
    for (size_t k = 0; k < sizeof col / sizeof *col; ++k)
      for (int i = 0; i < p.n_row && col[k].force == col[c].force; ++i)
        scale = fmax(scale, size_of(&p, i, col[k].name));
    for (int i = 0; i < p.n_row && good; ++i) {
      int k = same_node(a, &p, i, b, &q);
      double x = factor * size_of(&p, i, col[c].name);
      double y = k < 0 ? NAN : size_of(&q, k, col[c].name);
      good = fabs(x - y) <= t->tol * scale * factor;
      if (!good)
        snprintf(why, WHY, "twin differs: node %g %s %.15g, %.15g",
                 dat_at(&p, i, "node_no"), col[c].name, x, y);
    }
  }
  dat_free(&p);
  dat_free(&q);
  return good;
}

/* '.', 'r' or 'F' of a run; why[WHY]. */
static char judge(const scene_row *s, const column *c, const finished *f,
                  char *why) {
  const char *errors = f->j.errors == NULL ? "" : f->j.errors;
  int must = strcmp(c->solver, "AUTO") == 0 && !(s->flags & MAY_REFUSE);
  why[0] = '\0';
  if (f->code == s->verdict) {
    int good = s->expect == NULL || expect_all(&f->j, s->expect, why);
    if (good && f->code == 0 && !(s->flags & NO_LAWS))
      good = expect_laws(&f->j, why);
    return good ? '.' : 'F';
  }
  int refuses = (f->code == 1 || f->code == 6) && errors[0] != '\0';
  snprintf(why, WHY, "exit %d instead of %d: %.300s", f->code, s->verdict,
           errors);
  return refuses && !must ? 'r' : 'F';
}

static char run_cell(const scene_row *s, const column *c, char *why) {
  finished f = run_one(s, c, &s->change, NULL);
  char mark = judge(s, c, &f, why);
  if (mark == '.' && s->twin != NULL && f.code == 0) {
    finished g = run_one(s, c, &s->twin->change, s->twin->words);
    mark = judge(s, c, &g, why);
    if (mark == '.' && !twins_agree(&f, &g, s->twin, why)) mark = 'F';
    finish(&g);
  }
  if (getenv("KEEP") != NULL) fprintf(stderr, "%s %s\n", c->label, f.j.dir);
  finish(&f);
  return mark;
}

/* What the short run tries: the choice of the program in all forms and
 * integrators, and one method that goes another way. */
static int is_quick(const column *c) {
  return strcmp(c->solver, "AUTO") == 0 || strcmp(c->solver, "sor") == 0;
}

/* All columns of a row, in a process of its own: marks, newline, notes. */
static void run_row(const scene_row *s, int n, const column *c, int quick,
                    FILE *out) {
  struct rlimit limit = {CPU_SECONDS, CPU_SECONDS};
  char marks[COLUMNS + 1] = "", notes[NOTES] = "", why[WHY];
  size_t used = 0;
  setrlimit(RLIMIT_CPU, &limit);
  for (int k = 0; k < n; ++k) {
    marks[k] = ' ';
    if (!applies(&c[k], s->deck)) continue;
    if (quick && !is_quick(&c[k])) continue;
    marks[k] = run_cell(s, &c[k], why);
    if (marks[k] == '.' || used > NOTES - 2 * WHY) continue;
    if (marks[k] == 'r' && getenv("SCENE") == NULL) continue;
    for (char *p = why; *p != '\0'; ++p)
      if (*p == '\n') *p = ' ';
    used += (size_t)snprintf(notes + used, NOTES - used, "  %s %s: %s\n",
                             s->name, c[k].label, why);
  }
  fprintf(out, "%s\n%s", marks, notes);
}

typedef struct running {
  pid_t pid;
  FILE *from;
} running;

static running start_row(const scene_row *s, int n, const column *c,
                         int quick) {
  int ends[2];
  fflush(NULL);
  if (pipe(ends) != 0) abort();
  running r = {.pid = fork()};
  if (r.pid == 0) {
    close(ends[0]);
    FILE *out = fdopen(ends[1], "w");
    run_row(s, n, c, quick, out);
    fclose(out);
    _exit(0);
  }
  close(ends[1]);
  r.from = fdopen(ends[0], "r");
  return r;
}

/* Wait for a row, print its line, keep its notes; count the marks. */
static void end_row(const scene_row *s, running *r, int n, int *count,
                    FILE *out, FILE *notes) {
  char line[1000] = "", marks[COLUMNS + 1];
  if (fgets(line, COLUMNS + 2, r->from) == NULL || (int)strlen(line) < n) {
    memset(line, 'F', (size_t)n);
    fprintf(notes, "  %s: the test itself ended early\n", s->name);
  }
  snprintf(marks, sizeof marks, "%.*s", n, line);
  fprintf(out, "%-34.34s", s->name);
  for (int k = 0; k < n; ++k) {
    fprintf(out, "  %c ", marks[k]);
    count[0] += marks[k] == '.';
    count[1] += marks[k] == 'r';
    count[2] += marks[k] == 'F';
  }
  fprintf(out, "\n");
  fflush(out);
  while (fgets(line, sizeof line, r->from) != NULL) fputs(line, notes);
  fclose(r->from);
  waitpid(r->pid, NULL, 0);
}

static int chosen(const scene_row *s, int quick) {
  const char *only = getenv("SCENE");
  if (only != NULL) return strstr(s->name, only) != NULL;
  return !quick || (s->flags & QUICK) != 0;
}

int scenes_list(int quick, const scene_row *row[SCENES]) {
  static const scene_row *const family[] = {friction_scenes, contact_scenes,
                                            pair_scenes,     body_scenes,
                                            number_scenes,   time_scenes};
  int n = 0;
  for (size_t f = 0; f < sizeof family / sizeof *family; ++f)
    for (const scene_row *s = family[f]; s->name != NULL; ++s)
      if (chosen(s, quick)) row[n++] = s;
  return n;
}

int scenes_run(int quick, FILE *out) {
  column c[COLUMNS] = {0};
  const scene_row *row[SCENES];
  running r[JOBS];
  char *text = NULL;
  size_t size = 0;
  int n = make_columns(c), n_row = scenes_list(quick, row), count[3] = {0};
  const char *wanted = getenv("JOBS");
  int jobs = wanted == NULL ? 1 : atoi(wanted);
  if (jobs < 1 || jobs > JOBS) jobs = 1;
  FILE *notes = open_memstream(&text, &size);
  fprintf(out, "%-34s", "scene");
  for (int k = 0; k < n; ++k) fprintf(out, " %s", c[k].label);
  fprintf(out, "\n");
  for (int i = 0; i < n_row + jobs; ++i) {
    if (i >= jobs && i - jobs < n_row)
      end_row(row[i - jobs], &r[i % jobs], n, count, out, notes);
    if (i < n_row) r[i % jobs] = start_row(row[i], n, c, quick);
  }
  fclose(notes);
  fprintf(out, "%d scenes: %d passed, %d refused, %d failed\n%s", n_row,
          count[0], count[1], count[2], text);
  fflush(out);
  free(text);
  return count[2];
}
