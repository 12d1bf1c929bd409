/*
 * STIFFNESS=AUTO: whether the condensed matrix is formed (DENSE) or known by
 * solves with the sparse matrix of the body (FACTOR), by foreseen seconds and
 * bytes. The seconds are of one core that does some ten billion operations a
 * second: only their ratio counts.
 */
#include "run/setup/setup.h"

#include "base/memory.h"
#include "model/facts.h"

#include <math.h>
#include <stdio.h>

enum {
  COLD = 14,    /* steps of NEWTON of the first problem */
  WARM = 5,     /* of one that starts from the last */
  SOLVES = 7,   /* of a step of FACTOR */
  OTHERS = 3,   /* factors of an increment besides: errors, rounding */
  VECTORS = 150 /* bytes of an unknown of the body */
};
static const double DENSE_COLD = 1e-10; /* s, times m^3: the first problem */
static const double DENSE_WARM = 3e-11; /* s, times m^3: one more */
static const double FLOP = 1.6e-11;     /* s, of a sparse factor */
static const double ENTRY = 5e-9;       /* s, of its entries */
static const double READ = 1.6e-9;      /* s, of an entry in a solve */
static const double UNKNOWN = 5e-6;     /* s, mesh, assembly and order */
static const double ZEROS = 1.25;    /* -, entries with those of supernodes */
static const double MATRICES = 2.75; /* of the size of the condensed one,
                                        that DENSE holds at most */
static const double FLAT_FILL = 25.0, SPATIAL_FILL = 150.0;
/* -, least entries of the factor over unknowns */
static const double SHARE = 0.8; /* -, of the memory there is */

/* Seconds of FACTOR: its factors, of which a step makes again what contact
 * unknowns reach, and solves. */
static double factor_seconds(double problems, const whole_order *o) {
  const double steps = COLD + WARM * (problems - 1.0);
  return FLOP * o->flops + ENTRY * o->entries +
         (1.0 + steps + OTHERS * (problems - 1.0)) *
             (FLOP * o->contact_flops + ENTRY * o->contact_entries) +
         steps * SOLVES * READ * o->contact_entries;
}

static double factor_bytes(double n, const whole_order *o) {
  return ZEROS * sizeof(double) * (o->entries + o->contact_entries) +
         VECTORS * n;
}

static double problems_of(const run *r) {
  double n = 0.0;
  for (int i = 0; i < r->m->n.step; ++i) n += step_increments(&r->m->steps[i]);
  return fmax(1.0, n);
}

static double unknowns_of(const run *r) {
  double n = 0.0;
  for (size_t i = 0; i < r->n_dof; ++i) n += !r->body.fixed[i];
  return n;
}

/* The row of DENSE, its factor as of a compact body, and of FACTOR what it
 * takes at least. */
static void bound(const run *r, stiffness_choice *c) {
  const double m = r->nodes.n_row, problems = problems_of(r);
  const double n = unknowns_of(r);
  const double fill = r->msh->dim == 2 ? FLAT_FILL : SPATIAL_FILL;
  const double entries =
      r->msh->dim == 2 ? 7.0 * n * log2(n + 2.0) : 25.0 * n * cbrt(n);
  const double flops = r->msh->dim == 2 ? 60.0 * pow(n, 1.5) : 28.0 * n * n;
  c->dense.seconds = (DENSE_COLD + DENSE_WARM * (problems - 1.0)) * m * m * m +
                     ENTRY * entries + FLOP * flops;
  c->dense.bytes = (MATRICES * m * m + entries) * sizeof(double);
  const whole_order least = {.entries = fill * n, .contact_entries = fill * m};
  c->dense.seconds += UNKNOWN * n;
  c->factor.seconds = factor_seconds(problems, &least) + UNKNOWN * n;
  c->factor.bytes = factor_bytes(n, &least);
}

static void forget_order(run *r) {
  memory_free(r->body.order.node);
  r->body.order = (whole_order){0};
  r->body.d.order = NULL;
}

/* The row of FACTOR, from its order. */
static status find_factor(run *r, stiffness_choice *c) {
  status st = OK;
  stiffness *k = NULL;
  whole_order *o = &r->body.order;
  TRY(stiffness_assemble(&r->body.d, &k));
  TRY(stiffness_order(k, r->msh->x, o));
  r->body.d.order = o;
  c->factor.seconds =
      factor_seconds(problems_of(r), o) + UNKNOWN * unknowns_of(r);
  c->factor.bytes = factor_bytes(unknowns_of(r), o);
  c->exact = 1;
done:
  stiffness_free(k);
  return st;
}

static void say(stiffness_choice *c, int sparse, const char *why) {
  c->sparse = sparse;
  snprintf(c->why, sizeof c->why, "%s", why);
}

/* By seconds, where both fit; where one does not, the other. */
static void compare(stiffness_choice *c, double most) {
  const int dense_fits = c->dense.bytes <= most;
  const int factor_fits = c->factor.bytes <= most;
  if (dense_fits != factor_fits)
    say(c, factor_fits, "the other needs more memory than there is");
  else if (!dense_fits)
    say(c, c->factor.bytes < c->dense.bytes, "it needs less memory");
  else
    say(c, c->factor.seconds < c->dense.seconds, "it is foreseen to be faster");
}

status run_choose_stiffness(run *r, stiffness_choice *c) {
  const solver_choice *s = &r->step->solver;
  const double given = 1e6 * s->max_memory, left = SHARE * memory_left();
  const double most = given > 0.0 ? fmin(given, left) : left;
  *c = (stiffness_choice){0};
  forget_order(r);
  if (r->nodes.n_row == 0) return OK;
  bound(r, c);
  const char *reads = facts_reads_entries(r->m, r->step);
  if (s->stiffness != STIFFNESS_AUTO) {
    say(c, s->stiffness == STIFFNESS_FACTOR, "STIFFNESS of *SOLVER");
    return c->sparse ? find_factor(r, c) : OK;
  }
  if (reads != NULL) {
    c->sparse = 0;
    snprintf(c->why, sizeof c->why, "%s needs its entries", reads);
    return OK;
  }
  if (c->dense.seconds > c->factor.seconds || c->dense.bytes > most)
    PASS(find_factor(r, c));
  compare(c, most);
  if (!c->sparse) forget_order(r);
  return OK;
}

/* Matrices of the step before stay only where a new choice would be the same: a
 * restart within the step makes that choice. */
int run_asks_for_other_stiffness(const run *r) {
  const stiffness_choice *c = &r->body.choice;
  if (r->step == r->m->steps || r->nodes.n_row == 0) return 0;
  const solver_choice *s = &r->step->solver, *old = &r->step[-1].solver;
  const int reads = facts_reads_entries(r->m, r->step) != NULL;
  const int read = facts_reads_entries(r->m, r->step - 1) != NULL;
  if (s->stiffness == old->stiffness && s->max_memory == old->max_memory &&
      reads == read)
    return 0;
  if (s->stiffness == STIFFNESS_FACTOR) return !c->sparse;
  if (s->stiffness == STIFFNESS_DENSE || reads) return c->sparse;
  return c->sparse || s->max_memory > 0.0 ||
         c->dense.seconds > c->factor.seconds;
}
