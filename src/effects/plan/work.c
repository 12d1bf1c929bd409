/*
 * Expected work: operations of each effect from the sizes alone, without
 * anything solved. An operation is about a nanosecond of one core: one
 * multiplication and addition of scattered data, SPARSE of them in a
 * supernode of the sparse factor, DENSE of them in a product of dense
 * matrices, and the move of one double that is read in passing.
 *
 * Orders: nested dissection leaves 7 n log2 n entries and 60 n^1.5 operations
 * in the factor in the plane, 25 n^(4/3) and 28 n^2 in space; a solve goes
 * through the entries twice; the condensed matrix is dense. Constants were
 * fitted to the examples; they are good to a factor of two or three, as is the
 * number of iterations that a contact problem needs.
 */
#include "effects/plan/plan.h"

#include <math.h>
#include <string.h>

static const double SPARSE = 4.0, DENSE = 10.0; /* flops an operation         */
static const double CONTACT_STEPS = 5.0; /* of Newton's method a problem      */
static const double TEXT = 250.0; /* operations to write a number           */

typedef effect_work work_fn(const plan_sizes *s, double items);

static double contact_unknowns(const plan_sizes *s) {
  return s->contact + s->tangents;
}

double work_factor_flops(const plan_sizes *s) {
  double n = s->unknowns;
  return s->is_flat ? 60.0 * pow(n, 1.5) : 28.0 * n * n;
}

double work_factor_entries(const plan_sizes *s) {
  double n = fmax(2.0, s->unknowns);
  return s->is_flat ? 7.0 * n * log2(n) : 25.0 * n * cbrt(n);
}

static double element_work(const plan_sizes *s) {
  return s->is_flat ? 60.0 : 200.0;
}

static effect_work elements(const plan_sizes *s, double items) {
  double assembly = items * (s->is_flat ? 500.0 : 2500.0);
  double ordering = s->nodes * (s->is_flat ? 700.0 : 3000.0);
  double factor = work_factor_flops(s) / SPARSE + work_factor_entries(s);
  double solves = s->equilibria * 2.0 * work_factor_entries(s);
  double energy = s->increments * items * element_work(s);
  return (effect_work){s->factors, s->factors * (assembly + ordering + factor) +
                                       solves + energy};
}

/* Condensed matrix of m unknowns, and the problems solved with it. */
static double contact_work(const plan_sizes *s, double m) {
  double condense = m * m * m / 3.0 / DENSE + 4.0 * m * m;
  double factor = m * m * m / 3.0 / DENSE;
  return s->factors * condense +
         s->equilibria * (CONTACT_STEPS * 2.0 * m * m + 0.5 * factor);
}

static effect_work unilateral(const plan_sizes *s, double items) {
  return (effect_work){s->equilibria, contact_work(s, items) + 500.0 * items};
}

static effect_work tangents(const plan_sizes *s, double items) {
  double all = contact_work(s, contact_unknowns(s));
  (void)items;
  return (effect_work){s->equilibria, all - contact_work(s, s->contact)};
}

static effect_work friction(const plan_sizes *s, double items) {
  (void)s;
  return (effect_work){1.0, 100.0 * items};
}

static effect_work average(const plan_sizes *s, double items) {
  (void)s;
  return (effect_work){1.0, 1000.0 * items + items * items};
}

static effect_work each_problem(const plan_sizes *s, double items) {
  return (effect_work){s->equilibria, 20.0 * s->equilibria * items};
}

static effect_work history(const plan_sizes *s, double items) {
  return (effect_work){s->equilibria + s->increments,
                       20.0 * (s->equilibria + s->increments) * items};
}

static effect_work start(const plan_sizes *s, double items) {
  (void)items;
  return (effect_work){2.0, 4.0 * s->elements * element_work(s)};
}

static effect_work inelastic(const plan_sizes *s, double items) {
  double law = s->flows_linearly ? 4.0 : 40.0;
  return (effect_work){-1.0, law * s->equilibria * items * element_work(s)};
}

static effect_work thermal(const plan_sizes *s, double items) {
  return (effect_work){1.0 + s->equilibria,
                       s->equilibria * items * 2.0 * element_work(s)};
}

static effect_work body(const plan_sizes *s, double items) {
  return (effect_work){-1.0, s->equilibria * items * 4.0 * element_work(s)};
}

static effect_work stresses(const plan_sizes *s, double items) {
  return (effect_work){s->shown, s->shown * items * element_work(s)};
}

static effect_work reactions(const plan_sizes *s, double items) {
  (void)items;
  return (effect_work){s->increments,
                       s->increments * s->elements * element_work(s)};
}

/* Products with the condensed matrix in each increment. */
static effect_work products(const plan_sizes *s, double items) {
  double m = contact_unknowns(s);
  (void)items;
  return (effect_work){-1.0, s->increments * 3.0 * m * m};
}

static effect_work theorems(const plan_sizes *s, double items) {
  double m = contact_unknowns(s);
  return (effect_work){s->increments, m * m * m + s->increments * 80.0 *
                                                      (m * m + 100.0 * items)};
}

static effect_work mesh_error(const plan_sizes *s, double items) {
  return (effect_work){1.0 + s->increments,
                       s->increments * items * 9.0 * element_work(s)};
}

/* Formulas at many points of each element. */
static effect_work closed_form_work(const plan_sizes *s, double items) {
  return (effect_work){s->increments,
                       s->increments * items * 600.0 * element_work(s)};
}

static effect_work time_error(const plan_sizes *s, double items) {
  double m = contact_unknowns(s);
  (void)items;
  return (effect_work){s->increments, 2.0 * s->increments *
                                          (4.0 * work_factor_entries(s) +
                                           CONTACT_STEPS * 2.0 * m * m)};
}

static effect_work solver_error(const plan_sizes *s, double items) {
  double m = contact_unknowns(s), solve = 0.5 * work_factor_entries(s);
  double factor = s->tangents > 0.0 ? 0.1 * m * m * m / 3.0 / DENSE : 0.0;
  (void)items;
  return (effect_work){s->increments,
                       s->increments * (3.0 * m * m + solve + factor)};
}

static effect_work table(const plan_sizes *s, double items) {
  return (effect_work){s->shown, s->shown * items * 10.0 * TEXT};
}

static effect_work zones(const plan_sizes *s, double items) {
  return (effect_work){s->shown, s->shown * items * 100.0};
}

static effect_work fields(const plan_sizes *s, double items) {
  return (effect_work){-1.0, 4e6 + s->shown * (4e5 + 20.0 * items)};
}

static effect_work condensed_problems(const plan_sizes *s, double items) {
  double m = contact_unknowns(s);
  (void)items;
  return (effect_work){-1.0, s->increments * (1e6 + 3.0 * m * m)};
}

static effect_work restart(const plan_sizes *s, double items) {
  return (effect_work){-1.0, s->increments * (1e6 + 50.0 * items)};
}

static effect_work listing(const plan_sizes *s, double items) {
  (void)items;
  return (effect_work){-1.0, 2e5 + s->increments * 60.0 * TEXT};
}

/* clang-format off */
static const struct { const char *name; work_fn *of; } rows[] = {
  {"finite elements", elements},
  {"unilateral contact", unilateral},
  {"friction", friction},
  {"tangential unknowns", tangents},
  {"nonlocal average", average},
  {"given contact forces", each_problem},
  {"history of slip", history},
  {"velocity form", each_problem},
  {"initial state", start},
  {"inelastic strain", inelastic},
  {"thermal strain", thermal},
  {"body forces", body},
  {"stresses", stresses},
  {"reactions", reactions},
  {"second solutions, jumps", products},
  {"theory checks", theorems},
  {"error of mesh", mesh_error},
  {"error of steps", time_error},
  {"error of solver", solver_error},
  {"closed form", closed_form_work},
  {"table of zones", zones},
  {"fields in JOB.h5", fields},
  {"condensed problems", condensed_problems},
  {"restart", restart},
  {"listing, .sta, .cvg", listing},
};
/* clang-format on */

effect_work work_of(const char *row, const plan_sizes *s, double items) {
  for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k)
    if (strcmp(rows[k].name, row) == 0) return rows[k].of(s, items);
  return table(s, items);
}
