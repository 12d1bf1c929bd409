/*
 * STIFFNESS=AUTO: whether the condensed matrix is formed (DENSE) or known by
 * solves with the sparse matrix of the body (FACTOR), by expected seconds and
 * bytes. The seconds are of one core that does some ten billion operations a
 * second: only their ratio counts.
 */
#include "run/run.h"

#include "model/facts.h"

enum {
  COLD = 14,    /* linear systems of the first increment */
  WARM = 5,     /* of one that starts from the last */
  SOLVES = 7,   /* with each of FACTOR */
  OTHERS = 3,   /* factors of an increment besides: errors, rounding */
  VECTORS = 150 /* bytes of an unknown of the body */
};
static const double DENSE_FORM = 1.6e-11; /* s, times m^3 */
static const double DENSE_STEP = 6e-12;   /* s, times m^3: a linear system */
static const double FLOP = 1.6e-11;       /* s, of a sparse factor */
static const double ENTRY = 5e-9;         /* s, of its entries */
static const double READ = 1.6e-9;        /* s, of an entry in a solve */
static const double UNKNOWN = 5e-6;       /* s, mesh, assembly and order */
static const double ZEROS = 1.25;    /* -, entries with those of supernodes */
static const double MATRICES = 2.75; /* of the size of the condensed one,
                                        that DENSE holds at most */
static const double FLAT_FILL = 25.0, SPATIAL_FILL = 150.0;
/* -, least entries of the factor over unknowns */
static const double SHARE = 0.8; /* -, of the memory there is */

/* What is ahead: by the counts of the run so far, which are the same in every
 * run of a deck, unlike seconds. */
typedef struct work_ahead {
  double increments, systems, solves; /* -; solves with a system of FACTOR */
} work_ahead;

static double increments_ahead(const run *r) {
  const step *first = r->m->steps, *end = first + r->m->n.step;
  const int within = r->at.step_id == r->step - first;
  double n = within ? -fmin((double)r->at.i, step_increments(r->step)) : 0.0;
  for (const step *s = r->step; s < end; ++s) n += step_increments(s);
  return fmax(1.0, n);
}

/* Systems of an increment that starts from the last. */
static double systems_of_increment(const observed_work *seen) {
  if (seen->increments > 1) return seen->later / (seen->increments - 1.0);
  return seen->increments == 1 ? (double)WARM * seen->first / COLD : WARM;
}

static work_ahead look_ahead(const run *r) {
  const observed_work *seen = &r->solving.seen;
  const double n = increments_ahead(r), each = systems_of_increment(seen);
  const double first = r->course.total_no == 0 ? COLD : each;
  return (work_ahead){.increments = n,
                      .systems = first + each * (n - 1.0),
                      .solves = seen->factors > 0
                                    ? (double)seen->solves / seen->factors
                                    : SOLVES};
}

/* Seconds of FACTOR: its first factor unless it is there, those of which a
 * system makes again what contact unknowns reach, and solves. */
static double factor_seconds(const work_ahead *w, const whole_order *o,
                             int there) {
  const double others = OTHERS * (w->increments - (there ? 0.0 : 1.0));
  const double again = FLOP * o->contact_flops + ENTRY * o->contact_entries;
  const double first = FLOP * o->flops + ENTRY * o->entries + again;
  return (there ? 0.0 : first) + (w->systems + others) * again +
         w->systems * w->solves * READ * o->contact_entries;
}

static double factor_bytes(double n, const whole_order *o) {
  return ZEROS * sizeof(double) * (o->entries + o->interior_entries) +
         VECTORS * n;
}

static double unknowns_of(const run *r) {
  double n = 0.0;
  for (size_t i = 0; i < r->n_dof; ++i) n += !r->body.fixed[i];
  return n;
}

/* Kinds whose matrices are there. */
typedef struct made_kinds {
  int dense, factor;
} made_kinds;

/* The row of DENSE, its factor as of a compact body, and of FACTOR what it
 * takes at least. */
static void bound(const run *r, made_kinds made, stiffness_choice *c) {
  const double m = r->nodes.n_row, n = unknowns_of(r);
  const work_ahead w = look_ahead(r);
  const double fill = r->msh->dim == 2 ? FLAT_FILL : SPATIAL_FILL;
  const double entries =
      r->msh->dim == 2 ? 7.0 * n * log2(n + 2.0) : 25.0 * n * cbrt(n);
  const double flops = r->msh->dim == 2 ? 60.0 * pow(n, 1.5) : 28.0 * n * n;
  const whole_order least = {.entries = fill * n, .contact_entries = fill * m};
  c->dense.bytes = (MATRICES * m * m + entries) * sizeof(double);
  c->dense.seconds = DENSE_STEP * w.systems * m * m * m;
  if (!made.dense)
    c->dense.seconds +=
        DENSE_FORM * m * m * m + ENTRY * entries + FLOP * flops + UNKNOWN * n;
  c->factor.bytes = factor_bytes(n, &least);
  c->factor.seconds = factor_seconds(&w, &least, made.factor) +
                      (made.factor ? 0.0 : UNKNOWN * n);
}

static void forget_order(run *r) {
  memory_free(r->body.order.node);
  r->body.order = (whole_order){0};
  r->body.d.order = NULL;
}

static status make_order(run *r) {
  forget_order(r);
  OWNED_OF(stiffness, k, stiffness_assemble(&r->body.d, &k));
  PASS(stiffness_order(k, r->msh->x, &r->body.order));
  r->body.d.order = &r->body.order;
  return OK;
}

/* The row of FACTOR, from its order. */
static status find_factor(run *r, int made, stiffness_choice *c) {
  const whole_order *o = &r->body.order;
  const work_ahead w = look_ahead(r);
  const double n = unknowns_of(r);
  if (o->n == 0) PASS(make_order(r));
  c->factor.seconds = factor_seconds(&w, o, made) + (made ? 0.0 : UNKNOWN * n);
  c->factor.bytes = factor_bytes(n, o);
  c->exact = 1;
  return OK;
}

static void say(stiffness_choice *c, int sparse, const char *why) {
  c->sparse = sparse;
  snprintf(c->why, sizeof c->why, "%s", why);
}

/* By seconds, where both fit; where one does not, the other. */
static void compare(const run *r, double most, stiffness_choice *c) {
  const int dense_fits = c->dense.bytes <= most;
  const int factor_fits = c->factor.bytes <= most;
  if (dense_fits != factor_fits)
    say(c, factor_fits, "the other needs more memory than there is");
  else if (!dense_fits)
    say(c, c->factor.bytes < c->dense.bytes, "it needs less memory");
  else
    say(c, c->factor.seconds < c->dense.seconds, "it is expected to be faster");
  if (dense_fits && factor_fits && r->solving.seen.increments > 0)
    snprintf(c->why + strlen(c->why), sizeof c->why - strlen(c->why),
             ", by %.1f systems an increment and %.1f solves each",
             systems_of_increment(&r->solving.seen), look_ahead(r).solves);
}

/* made: kinds whose matrices are there, for the current supports and nodes. */
static status choose(run *r, made_kinds made, stiffness_choice *c) {
  const solver_choice *s = &r->step->solver;
  const double held = made.dense ? c->dense.bytes : c->factor.bytes;
  const double given = 1e6 * s->max_memory,
               left = SHARE * (memory_left() +
                               (made.dense || made.factor ? held : 0.0));
  const double most = given > 0.0 ? fmin(given, left) : left;
  *c = (stiffness_choice){0};
  if (r->nodes.n_row == 0) return OK;
  bound(r, made, c);
  const char *reads = facts_reads_entries(r->m, r->step);
  if (s->stiffness != STIFFNESS_AUTO) {
    say(c, s->stiffness == STIFFNESS_FACTOR, "STIFFNESS of *SOLVER");
    return c->sparse ? find_factor(r, made.factor, c) : OK;
  }
  if (reads != NULL) {
    c->sparse = 0;
    snprintf(c->why, sizeof c->why, "%s needs its entries", reads);
    return OK;
  }
  if (made.factor || c->dense.seconds > c->factor.seconds ||
      c->dense.bytes > most)
    PASS(find_factor(r, made.factor, c));
  compare(r, most, c);
  return OK;
}

status run_take_stiffness(run *r) {
  r->body.d.sparse = r->body.choice.sparse;
  return r->body.choice.sparse && r->body.order.n == 0 ? make_order(r) : OK;
}

status run_choose_stiffness(run *r) {
  if (r->course.shadow) return OK;
  forget_order(r);
  if (r->course.from == NULL)
    PASS(choose(r, (made_kinds){0, 0}, &r->body.choice));
  return run_take_stiffness(r);
}

status run_asks_for_other_stiffness(run *r, int *other) {
  const int sparse = r->body.choice.sparse;
  *other = 0;
  if (r->nodes.n_row == 0) return OK;
  PASS(choose(r, (made_kinds){!sparse, sparse}, &r->body.choice));
  *other = r->body.choice.sparse != sparse;
  return OK;
}
