/* The set of solutions found, distinguished by their distance in energy. */
#include "accuracy/solutions.h"

#include "base/memory.h"

#include <cblas.h>
#include <math.h>
#include <string.h>

static const double SAME = 1e-6; /* -, relative distance of one state */
static const double UNIT = 1e-3; /* -, of the energy of the scale: counts as
                                    the norm of a state without deformation */

static void free_solution(solution *s) { RELEASE(s->u, s->r, s->status); }

int solution_set_confirmed(const solution_set *s) {
  const char *family = NULL;
  if (s->n_found == 0) return 0;
  if (s->n_pattern > 0) return s->found[0].facts.patterns > 0;
  for (int k = 0; k < s->n_attempt; ++k) {
    const solution_attempt *a = &s->attempts[k];
    if (a->solution_no != 1) continue;
    if (family != NULL && strcmp(family, a->family) != 0) return 1;
    family = a->family;
  }
  return 0;
}

void solution_set_free(solution_set *s) {
  if (s == NULL) return;
  for (int i = 0; i < s->n_found; ++i) free_solution(&s->found[i]);
  RELEASE(s->found, s->attempts);
  *s = (solution_set){0};
}

/* ---- distance ----------------------------------------------------------- */

/* x' M x of the difference of two states, b NULL: of one; t[2m] workspace. */
static double energy(const contact_problem *cp, const double *a,
                     const double *b, double *t) {
  for (int i = 0; i < cp->m; ++i) t[i] = b == NULL ? a[i] : a[i] - b[i];
  contact_product(cp->m, cp->A != NULL ? cp->A : cp->W, t, t + cp->m);
  return fmax(0.0, cblas_ddot(cp->m, t, 1, t + cp->m, 1));
}

/* Energy of an unknown that moves (is pushed) by the scale of the problem. */
static double unit_energy(const contact_problem *cp) {
  const double *M = cp->A != NULL ? cp->A : cp->W;
  double scale = contact_scale(cp), most = 0.0;
  for (int i = 0; i < cp->m; ++i)
    most = fmax(most, M[(size_t)i * (size_t)(cp->m + 1)]);
  return most > 0.0 ? UNIT * UNIT * scale * (scale / most) : 0.0;
}

static status find_distance(const contact_problem *cp, const double *a,
                            const double *b, double *distance) {
  OWNED double *t = NULL;
  PASS_NEW(t, 2 * cp->m);
  double size = fmax(energy(cp, a, NULL, t), energy(cp, b, NULL, t));
  size = fmax(size, unit_energy(cp));
  double apart = energy(cp, a, b, t);
  *distance = size > 0.0 ? sqrt(apart / size) : 0.0;
  return OK;
}

/* ---- adding ------------------------------------------------------------- */

static void find_facts(const contact_problem *cp, solution *s) {
  solution_facts *f = &s->facts;
  *f = (solution_facts){.residual = contact_residual(cp, s->u, s->r),
                        .patterns = 1};
  for (int i = 0; i < cp->n; ++i) {
    f->n_open += s->status[i] == CONTACT_OPEN;
    f->n_slip += s->status[i] == CONTACT_SLIP;
    f->n_stick += s->status[i] == CONTACT_STICK;
    for (int k = 0; k < 2; ++k) {
      double u = s->u[i * cp->dim + k];
      f->lowest[k] = i == 0 ? u : fmin(f->lowest[k], u);
      f->highest[k] = i == 0 ? u : fmax(f->highest[k], u);
    }
  }
}

static status copy_solution(const contact_problem *cp, const double *u,
                            const double *r, solution *s) {
  status st = OK;
  size_t bytes = (size_t)cp->m * sizeof *u;
  *s = (solution){0};
  NEW(s->u, cp->m);
  NEW(s->r, cp->m);
  NEW(s->status, cp->n);
  memcpy(s->u, u, bytes);
  memcpy(s->r, r, bytes);
  contact_classify(cp, u, r, s->status);
  find_facts(cp, s);
done:
  if (st != OK) free_solution(s);
  return st;
}

status solution_set_add(const contact_problem *cp, double tol, const double *u,
                        const double *r, solution_set *s, int *no) {
  const double *x = cp->A != NULL ? u : r;
  double distance = 0.0;
  *no = 0;
  s->n = cp->n;
  s->m = cp->m;
  if (!(contact_residual(cp, u, r) <= tol)) return OK;
  for (int i = 0; i < s->n_found; ++i) {
    const solution *old = &s->found[i];
    PASS(find_distance(cp, x, cp->A != NULL ? old->u : old->r, &distance));
    if (distance > SAME) continue;
    ++s->found[i].facts.patterns;
    *no = i + 1;
    return OK;
  }
  if (s->n_found > 0)
    PASS(find_distance(cp, x, cp->A != NULL ? s->found[0].u : s->found[0].r,
                       &distance));
  PASS_GROW(s->found, s->n_found, s->cap_found);
  PASS(copy_solution(cp, u, r, &s->found[s->n_found]));
  s->found[s->n_found].facts.distance = distance;
  *no = ++s->n_found;
  return OK;
}
