/*
 * Twins of a deck and the comparison of their tables.
 */
#include "decks/twin.h"

#include "base/base.h"
#include "support/same_json.h"
#include "support/traced.h"

#include <check.h>
#include <signal.h>
#include <sys/resource.h>

const char *const twin_name[TWINS] = {"threads",     "units, powers of two",
                                      "units, 1000", "numbering",
                                      "axes",        "methods"};

enum { CPU_SECONDS = 60 };

/* Programs started from now on end after some CPU seconds; 0: no limit. */
static void limit_time(int on) {
  struct rusage own;
  struct rlimit limit;
  getrusage(RUSAGE_SELF, &own);
  getrlimit(RLIMIT_CPU, &limit);
  limit.rlim_cur = on ? (rlim_t)own.ru_utime.tv_sec +
                            (rlim_t)own.ru_stime.tv_sec + CPU_SECONDS
                      : limit.rlim_max;
  setrlimit(RLIMIT_CPU, &limit);
}

int twin_run(job *j, const char *words) {
  char all[200];
  snprintf(all, sizeof all, "--no-timing --quiet %s", words);
  limit_time(1);
  int code = job_run(j, all);
  limit_time(0);
  return code;
}

/* DECKS_KEEP: what is not the same stays, and "what" tells where. */
static void put_away(job *j, int lost, char what[400]) {
  size_t used = strlen(what);
  if (!lost || getenv("DECKS_KEEP") == NULL)
    job_end(j);
  else
    snprintf(what + used, 400 - used, " [%s]", j->dir);
}

/* ---- tables ------------------------------------------------------------- */

/* Displacements are 1e-3 in base units, forces 1: what is below is compared
 * with the first; for another method, whose tolerance leaves forces on open
 * nodes, with the second. */
static const double smallest[2] = {1e-5, 1e-3};

/* 1: in axes of a contact, or a variable of a law that may be a component. */
static int has_own_axes(const char *name) {
  const size_t n = strlen(name);
  return (n > 2 && name[n - 1] >= '0' && name[n - 1] <= '9') ||
         strcmp(name, "torque") == 0;
}

/* 1: what two right answers may differ in, a coordinate, or a name. */
static int is_left_out(const char *name, const deck_text *how) {
  static const char *const out[] = {"status", "slip_dir", "open",  "slip[",
                                    "stick",  "closed",   "defect"};
  if (name[0] != '\0' && name[1] == '\0') return 1;
  if (how->turned && has_own_axes(name)) return 1;
  if (strcmp(name, "slip") == 0) return 0;
  if (strcmp(name, "contact") == 0) return 1;
  for (size_t k = 0; k < sizeof out / sizeof *out; ++k)
    if (strstr(name, out[k]) != NULL) return 1;
  return 0;
}

/* What the unit of a column is of the base unit. */
static double unit_factor(const table *t, int c, const deck_units *u) {
  return pow(u->length, t->unit[c][0]) * pow(u->force, t->unit[c][1]) *
         pow(u->time, t->unit[c][2]);
}

/* The column of c in a turned table, whose last letters are the axes. */
static int turned_column(const table *t, const deck_text *how, int dim, int c) {
  char name[2][24];
  size_t n = strlen(t->name[c]), at = n;
  while (at > 0 && strchr("xyz", t->name[c][at - 1]) != NULL) --at;
  if (at == 0 || n - at > 2 || t->name[c][at - 1] != '_') return c;
  for (int k = 0; k < 2; ++k) memcpy(name[k], t->name[c], n + 1);
  for (size_t i = at; i < n; ++i)
    name[0][i] = name[1][at + n - 1 - i] =
        (char)('x' + deck_axis(how, dim, t->name[c][i] - 'x'));
  const int to = table_column(t, name[0]);
  return to >= 0 ? to : table_column(t, name[1]);
}

/* 1: of the other sign, where x and y change places. */
static int is_around(const char *name) {
  static const char *const names[] = {"u_t",       "f_t",      "tangential",
                                      "slip",      "moment_z", "moment_of_both",
                                      "traction_t"};
  for (size_t k = 0; k < sizeof names / sizeof *names; ++k)
    if (strcmp(name, names[k]) == 0) return 1;
  return 0;
}

static void turn_back(table *t, const deck_text *how, int dim) {
  double of[COLUMNS_];
  for (int row = 0; row < t->n_row; ++row) {
    double *v = t->value + row * t->n_col;
    for (int c = 0; c < t->n_col; ++c) {
      const int to = turned_column(t, how, dim, c);
      of[c] = to < 0 ? NAN : v[to];
      const int counts = t->unit[c][0] == 0 && t->unit[c][1] == 0;
      if (dim == 2 && is_around(t->name[c]) && !counts) of[c] = -of[c];
    }
    memcpy(v, of, (size_t)t->n_col * sizeof *v);
  }
}

/* Back into base units, and to the numbers and the axes of the deck. */
static void restore(const random_deck *d, const deck_text *how, tables *all) {
  const solid *s = &d->mesh;
  int *node = deck_numbers(s->n_node, how->shuffle);
  int *elem = deck_numbers(s->n_elem, how->shuffle);
  int *of_node = calloc((size_t)s->n_node + 1, sizeof *of_node);
  int *of_elem = calloc((size_t)s->n_elem + 1, sizeof *of_elem);
  if (of_node == NULL || of_elem == NULL) abort();
  for (int i = 0; i < s->n_node; ++i) of_node[node[i] - 1] = i + 1;
  for (int e = 0; e < s->n_elem; ++e) of_elem[elem[e] - 1] = e + 1;
  for (int i = 0; i < all->n; ++i) {
    all->at[i].t /= how->units.time;
    for (int k = 0; k < TABLES; ++k) {
      table *t = &all->at[i].of[k];
      if (how->turned) turn_back(t, how, s->dim);
      int nodes = k == T_CONTACT || k == T_NODES || k == T_REACTIONS;
      for (int row = 0; row < t->n_row; ++row) {
        double *v = t->value + row * t->n_col;
        for (int c = 0; c < t->n_col; ++c)
          v[c] /= unit_factor(t, c, &how->units);
        if (nodes) v[0] = of_node[(int)v[0] - 1];
        if (k == T_ELEMENTS)
          v[0] = s->n_face + of_elem[(int)v[0] - s->n_face - 1];
      }
    }
  }
  free(node);
  free(elem);
  free(of_node);
  free(of_elem);
}

/* Largest magnitude among the columns of the unit of column c. */
static double scale_of(const table *t, int c, const deck_text *how) {
  double most = smallest[how->method != NULL];
  for (int k = 0; k < t->n_col; ++k) {
    if (memcmp(t->unit[k], t->unit[c], sizeof *t->unit) != 0) continue;
    if (k == 0 || is_left_out(t->name[k], how)) continue;
    for (int row = 0; row < t->n_row; ++row)
      most = fmax(most, fabs(table_at(t, row, k)));
  }
  return most;
}

/* Of the largest, over what rows and columns a table differs. */
static double table_difference(const table *a, const table *b, int by_number,
                               const deck_text *how, const char **name) {
  double worst = 0;
  if (a->n_row != b->n_row || a->n_col != b->n_col) return HUGE_VAL;
  int most = 0;
  for (int row = 0; row < b->n_row && by_number; ++row)
    most = (int)fmax(most, fmax(table_at(a, row, 0), table_at(b, row, 0)));
  int *row_of = table_rows(b, most);
  for (int c = by_number; c < a->n_col; ++c) {
    double scale = scale_of(a, c, how);
    if (is_left_out(a->name[c], how)) continue;
    for (int row = 0; row < a->n_row; ++row) {
      int other = by_number ? row_of[(int)table_at(a, row, 0)] : row;
      double x = table_at(a, row, c);
      double y = other < 0 ? NAN : table_at(b, other, c);
      double off = isnan(x) && !by_number ? 0 : fabs(x - y) / scale;
      if (isnan(off)) off = HUGE_VAL;
      if (off > worst) *name = a->name[c];
      worst = fmax(worst, off);
    }
  }
  free(row_of);
  return worst;
}

static double difference(const tables *a, const tables *b, const deck_text *how,
                         char what[400]) {
  double worst = 0;
  snprintf(what, 400, "%d increments, not %d", b->n, a->n);
  for (int i = 0; i < a->n && i < b->n; ++i)
    for (int k = 0; k < TABLES; ++k) {
      int numbers =
          k == T_CONTACT || k == T_NODES || k == T_REACTIONS || k == T_ELEMENTS;
      const char *name = "rows";
      double off = table_difference(&a->at[i].of[k], &b->at[i].of[k], numbers,
                                    how, &name);
      if (fabs(a->at[i].t - b->at[i].t) > 1e-9) off = HUGE_VAL;
      if (off <= worst) continue;
      worst = off;
      snprintf(what, 400, "%s of step %d increment %d is %.3g off", name,
               a->at[i].step, a->at[i].increment, off);
    }
  return a->n == b->n ? worst : HUGE_VAL;
}

/* ---- twins -------------------------------------------------------------- */

/* Laws without powers and exponentials. */
static int is_exact(const random_deck *d) {
  for (int k = 0; k < d->n_material; ++k)
    if (d->material[k].law > VISCOELASTIC || d->material[k].shift) return 0;
  for (int i = 0; i < d->n_step; ++i)
    if (d->step[i].kind == IS_VISCO) return 0;
  return 1;
}

static int is_given(const random_deck *d) {
  int given = 0;
  for (int k = 0; k < d->n_contact; ++k) given |= d->contact[k].given;
  return given;
}

/* Another method, or the stiffness as an operator. */
static const char *method_of(const random_deck *d) {
  static const char *const name[] = {"NEWTON", "SOR",      "AUGLAG",
                                     "LEMKE",  "PROXIMAL", "AITKEN",
                                     "PCG",    "LAGRANGE"};
  if (d->seed % 2 == 1 && !is_given(d)) return "AUTO, STIFFNESS=FACTOR";
  return name[d->seed / 3 % 8];
}

static int adapts(const random_deck *d) {
  for (int i = 0; i < d->n_step; ++i)
    if (d->step[i].tolerance > 0) return 1;
  return 0;
}

/* Friction that follows the pressure may leave more than one answer, and so
 * may a body that nothing presses yet. */
static int may_branch(const random_deck *d) {
  if (d->floats) return 1;
  for (int i = 0; i < d->n_step; ++i)
    for (int c = 0; c < d->n_contact; ++c)
      if (d->step[i].has_friction[c] && d->step[i].friction[c].law >= COULOMB)
        return 1;
  return adapts(d);
}

static twin_answer compare(const random_deck *d, const deck_text *how, job *j,
                           double tol, const tables *own, char what[400]) {
  judgement q;
  tables t = tables_read(j);
  twin_answer answer = TWIN_SAME;
  restore(d, how, &t);
  if (difference(own, &t, how, what) > tol) {
    char *sta = job_file(j, "sta");
    answer = d->balanced ? TWIN_SAME : may_branch(d) ? TWIN_OTHER : TWIN_LOST;
    judge(d, &t, sta, &q);
    for (int k = 0; k < CHECKS; ++k) {
      if (q.worst[k] <= 1) continue;
      answer = TWIN_LOST;
      snprintf(what, 400, "%s is %.3g tolerances off: %.300s", check_name[k],
               q.worst[k], q.where[k]);
    }
    free(sta);
  }
  tables_free(&t);
  return answer;
}

/* A method may give up, but not say that there is nothing to find; what nothing
 * but touch holds may be known to rounding alone, and then is told. */
static twin_answer refused(const random_deck *d, twin_kind kind, int code,
                           const job *j, char what[400]) {
  int false_proof = j->errors != NULL && strstr(j->errors, "no equilibrium");
  snprintf(what, 400, "exit %d: %.300s", code, j->errors);
  int may = kind == METHODS ? code == 1 || code == 6 : d->floats && code == 1;
  return may && !false_proof ? TWIN_REFUSED : TWIN_LOST;
}

/* Of the largest; 0: bit for bit. */
static double tolerance_of(const random_deck *d, twin_kind kind) {
  if (kind == POWERS && is_exact(d)) return 0;
  return kind == METHODS ? 1e-4 : kind == THREADS_ ? 1e-7 : 1e-6;
}

/* 1: of errors and goals too: bit for bit; with two threads, renumbered, and
 * turned. */
static int tells_same(const random_deck *d, twin_kind kind, double tol,
                      const job *base, const job *j, char what[400]) {
  if (tol == 0) return same_json_bits(base, j, what, 400);
  if (kind == TURNS && (d->balanced || is_given(d))) return 1;
  return (kind != NUMBERS && kind != THREADS_ && kind != TURNS) ||
         same_json_errors(base, j, 1e-5, 1e-8, what, 400);
}

twin_answer twin_check(const random_deck *d, twin_kind kind, const job *base,
                       const tables *own, char what[400]) {
  deck_text how = {.units = {1, 1, 1}};
  job j = job_begin(base->name);
  const double tol = tolerance_of(d, kind);
  if (kind == POWERS) how.units = (deck_units){1024, 1 / 64., 4};
  if (kind == THOUSANDS) how.units = (deck_units){1000, 1e-3, 60};
  if (kind == NUMBERS) how.shuffle = (unsigned)d->seed % 1000 + 1;
  how.turned = kind == TURNS;
  if (kind == METHODS) how.method = method_of(d);
  deck_write(d, &how, &j);
  int code = twin_run(&j, kind == THREADS_ ? "--threads 2" : "");
  twin_answer answer = code == 0 ? compare(d, &how, &j, tol, own, what)
                                 : refused(d, kind, code, &j, what);
  if (code == 0 && answer == TWIN_SAME &&
      !tells_same(d, kind, tol, base, &j, what))
    answer = TWIN_LOST;
  if (kind == METHODS)
    snprintf(what + strlen(what), 400 - strlen(what), " (%s)", how.method);
  put_away(&j, answer == TWIN_LOST || answer == TWIN_OTHER, what);
  return answer;
}

/* ---- restart ------------------------------------------------------------ */

static int run_traced(job *j, const char *word, int at, int *changes) {
  const char *words[] = {word, NULL};
  struct traced t = {.action = at > 0 ? TRACE_SIGNAL : TRACE_COUNT,
                     .at = at,
                     .number = SIGINT};
  limit_time(1);
  int code = traced_run(j, words, &t);
  limit_time(0);
  *changes = t.changes;
  return code;
}

int twin_restart(const random_deck *d, char what[400]) {
  deck_text how = {.units = {1, 1, 1}};
  job whole = job_begin("twin"), j = job_begin("twin");
  const char *file = NULL;
  int changes, unused;
  deck_write(d, &how, &whole);
  deck_write(d, &how, &j);
  int code = run_traced(&whole, NULL, 0, &changes);
  int stopped = run_traced(&j, NULL, changes / 2 + 1, &unused), again = code;
  if (stopped == 130) again = run_traced(&j, "--restart", 0, &unused);
  if (again == code) file = traced_difference(&whole, &j);
  snprintf(what, 400,
           "stopped at change %d of %d: exit %d, restart %d not %d, "
           "other file: %s",
           changes / 2 + 1, changes, stopped, again, code,
           file == NULL ? "none" : file);
  int same =
      (stopped == 130 || stopped == code) && again == code && file == NULL;
  put_away(&whole, !same, what);
  put_away(&j, !same, what);
  return same;
}
