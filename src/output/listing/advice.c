/*
 * Which error to improve next, and its price: in one sentence.
 *
 * Elements of half the length have half the error where no edge is singular;
 * their unknowns are 2^dim times as many, and the CPU seconds grow like a power
 * of them, 1.2 in the plane and 1.75 in space (target.c), at most: meshing and
 * output grow less. Increments of half the length have half the error or less.
 */
#include "base/timer.h"
#include "output/listing/parts.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

static const double GROWTH_2D = 1.2, GROWTH_3D = 1.75; /* -, of the CPU */
static const double EXACT = 1e-3; /* -, of the others: far more than needed */
static const double WORTH = 0.05; /* -, of the CPU */

/* The row of that name: its last error, %, NAN: none or unknown. */
static double last_of(const budget_row *rows, int n, const char *name) {
  for (int i = 0; i < n; ++i)
    if (strcmp(rows[i].name, name) == 0) return rows[i].last;
  return NAN;
}

static size_t add(char *text, size_t size, size_t used, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
static size_t add(char *text, size_t size, size_t used, const char *format,
                  ...) {
  va_list list;
  va_start(list, format);
  int n = used < size ? vsnprintf(text + used, size - used, format, list) : 0;
  va_end(list);
  return used + (size_t)(n > 0 ? n : 0);
}

static int is_balanced(const model *m) {
  int any = 0;
  for (int i = 0; i < m->n.step; ++i) any |= m->steps[i].balanced;
  return any;
}

/* What the solver does in vain. */
static size_t add_solver(const job *j, double others, double solver, char *text,
                         size_t size, size_t used) {
  if (!(solver >= 0.0 && solver < EXACT * others) || is_balanced(j->m))
    return used;
  if (solver > 0.0)
    used = add(text, size, used, "; the solver is %.0e times more exact",
               others / solver);
  else
    used = add(text, size, used, "; the solver is exact");
  if (j->o->no_timing || j->m->n.contact == 0) return used;
  double share = timer_cost(STAGE_CONTACT).cpu / timer_cpu();
  if (share < WORTH) return used;
  return add(text, size, used, ", TOL=BALANCED saves up to %.0f %% of the CPU",
             ceil(100 * share));
}

void job_advice(const job *j, char *text, size_t size) {
  budget_row rows[BUDGET_ROWS];
  const int n = job_budget(j, rows);
  const double in_mesh = last_of(rows, n, "mesh");
  const double in_steps = last_of(rows, n, "steps");
  size_t used = 0;
  text[0] = '\0';
  if (j->run->n_increment == 0 || isnan(in_mesh)) return;
  if (in_steps > in_mesh)
    used =
        add(text, size, used,
            "the increments: half their length gives %.2g %% or less of %.2g "
            "%% for 2 times the CPU",
            0.5 * in_steps, in_steps);
  else if (in_mesh > 0.0)
    used = add(text, size, used,
               "the mesh: half the length of the elements gives about %.2g %% "
               "for up to %.0f times the CPU",
               0.5 * in_mesh,
               j->m->dim < 3 ? pow(4.0, GROWTH_2D) : pow(8.0, GROWTH_3D));
  else
    return;
  used = add_solver(j, fmax(in_mesh, in_steps), last_of(rows, n, "solver"),
                    text, size, used);
  if (isnan(in_steps) && job_path_counts(j->m))
    add(text, size, used, "; of the steps no error is known without TIME=YES");
}

void listing_advice(const job *j, FILE *f) {
  char advice[ADVICE_SIZE], *at = advice, *end;
  job_advice(j, advice, sizeof advice);
  if (advice[0] == '\0') return;
  fputs("  improve next: ", f);
  for (; (end = strstr(at, "; ")) != NULL; at = end + 2)
    fprintf(f, "%.*s;\n    ", (int)(end - at), at);
  fprintf(f, "%s\n", at);
}
