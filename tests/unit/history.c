/* src/run/history: increments that are cut, rolled back, given up; energies. */
#include "effects/rows.h"
#include "run/history/history.h"
#include "support/text_model.h"
#include "support/unit.h"

/* Pressed on a rough floor and pushed to and fro: path dependent. */
#define DECK(dt)                                                    \
  "*MESH, FILE=none.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n" \
  "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"                        \
  "*AMPLITUDE, NAME=FRO\n0., 0., 0.25, 1., 1., -2.\n"               \
  "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"                            \
  "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"                    \
  "*FRICTION, CONTACT=C, LAW=COULOMB\n0.4\n"                        \
  "*STEP\n*QUASISTATIC\n" #dt                                       \
  ", 1.\n*DSLOAD\nTOP, P, 10.\nLEFT, TX, 0.6, FRO\n"                \
  "RIGHT, TX, 0.6, FRO\n*OUTPUT, HDF5=NO\n*END STEP\n"

static mesh *block(void) {
  const int n[] = {6, 4};
  const double length[] = {6.0, 4.0};
  return make_grid_2d(n, length);
}

/* What the run left: accepted times, rejected attempts, last displacements. */
typedef struct run_record {
  int accepted, rejected, unsettled, n_dof;
  double t[64], worst_defect;
  double u[256];
} run_record;

/* If not 0, increments longer than this fail; the current one is try_dt. */
static double picky_dt, try_dt;

static status keep(void *ctx, const state *s) {
  run_record *r = ctx;
  ck_assert_int_lt(r->accepted, 64);
  r->t[r->accepted++] = s->t;
  memcpy(r->u, s->body.u, (size_t)r->n_dof * sizeof *r->u);
  if (s->t == 0.5) try_dt = 0.5;
  double scale = fabs(s->energy.external) + fabs(s->energy.strain);
  r->worst_defect = fmax(r->worst_defect, fabs(s->energy.defect) / scale);
  if (s->settled) ck_assert_double_ge(s->energy.friction_end, 0.0);
  return OK;
}

/* Errors of an attempt are not those of the increment before. */
static status count(void *ctx, const state *s, const char *why) {
  run_record *r = ctx;
  ck_assert_ptr_nonnull(why);
  ck_assert(s->errors.error.energy == 0.0);
  ++r->rejected;
  try_dt = ldexp(0.5, -s->attempt);
  return OK;
}

/* A solver that gives up, leaving rubbish, when the load has grown by more
 * than picky_step since its last answer; otherwise newton. */
static double picky_step, picky_last;
static outcome picky_outcome = STOPPED_ITERATIONS;

static double load_size(const contact_problem *cp) {
  double sum = 0.0;
  for (int i = 0; i < cp->n; ++i) sum += fabs(cp->f[cp->dim * i]);
  return sum;
}

static status picky_solve(const contact_problem *cp, const void *par,
                          void *work, const solver_control *control, double *u,
                          double *r, solver_report *rep) {
  double size = load_size(cp);
  if (fabs(size - picky_last) > picky_step * (1 + 1e-9) ||
      (picky_dt > 0.0 && try_dt > picky_dt)) {
    for (int i = 0; i < cp->m; ++i) u[i] = r[i] = 1e3 * (i + 1);
    rep->outcome = picky_outcome;
    return OK;
  }
  picky_last = size;
  return newton_solver.solve(cp, par, work, control, u, r, rep);
}

static run_record run_deck(const char *text, double picky) {
  solver_ops ops = newton_solver;
  run_record r = {0};
  TEXT_MODEL s = text_model_read(text, block());
  ck_assert_int_eq(s.st, OK);
  ops.solve = picky_solve;
  picky_step = picky;
  picky_last = 0.0;
  try_dt = 0.5;
  s.m->steps[0].solver.ops = picky > 0 ? &ops : &newton_solver;
  FREED void *param = calloc(1, newton_solver.param_size + 1);
  if (newton_solver.options != NULL)
    option_defaults(newton_solver.options, param);
  s.m->steps[0].solver.param = param;
  r.n_dof = 2 * s.msh->n_node;
  ck_assert_int_le(r.n_dof, 256);
  history_sink sink = {.ctx = &r, .increment = keep, .rejected = count};
  ck_assert_int_eq(history_run(s.m, s.msh, effect_table, &sink, &r.unsettled),
                   OK);
  return r;
}

TEST(cut_increments_are_the_small_increments) {
  /* The pressure grows by 60 in all: 7.5 an eighth of the step. */
  run_record fine = run_deck(DECK(0.125), 0.0);
  run_record cut = run_deck(DECK(0.5), 60.0 / 8);
  ck_assert_int_eq(fine.accepted, 8);
  ck_assert_int_eq(cut.accepted, 8);
  ck_assert_int_gt(cut.rejected, 2);
  ck_assert_int_eq(cut.unsettled, 0);
  for (int i = 0; i < 8; ++i) ck_assert_double_eq(cut.t[i], fine.t[i]);
  for (int i = 0; i < fine.n_dof; ++i)
    ck_assert_double_eq_tol(cut.u[i], fine.u[i], 1e-15);
  /* The path counts: one coarse increment ends elsewhere. */
  run_record coarse = run_deck(DECK(0.5), 0.0);
  double differ = 0.0;
  for (int i = 0; i < fine.n_dof; ++i)
    differ = fmax(differ, fabs(coarse.u[i] - fine.u[i]));
  ck_assert_double_gt(differ, 1e-6);
}

/* The same for all that keeps a history: the deck from *MATERIAL on. */
#define HISTORY(law, friction, more, move, procedure)                   \
  "*MESH, FILE=none.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n" law \
  "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"                            \
  "*AMPLITUDE, NAME=FRO\n0., 0., 0.25, 1., 1., -2.\n" move              \
  "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"                        \
  "*FRICTION, CONTACT=C, " friction "\n0.4\n*STEP\n" procedure          \
  "\n%s, 1.\n*DSLOAD\nTOP, P, 10.\nLEFT, TX, 0.6, FRO\n"                \
  "RIGHT, TX, 0.6, FRO\n" more "*OUTPUT, HDF5=NO\n*END STEP\n"
#define STILL "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
#define LOCAL "LAW=COULOMB"
#define NORTON "*INELASTIC, LAW=NORTON\n1.E-6, 3.\n"
#define MAXWELL "*INELASTIC, LAW=MAXWELL, TYPE=DEVIATORIC\n2.\n"

/* clang-format off */
static const char *const with_history[] = {
  HISTORY("", LOCAL, "", STILL, "*QUASISTATIC"),
  HISTORY("", LOCAL, "", STILL, "*QUASISTATIC, FORM=VELOCITY"),
  HISTORY("", "LAW=NONLOCAL, RADIUS=2.", "", STILL, "*QUASISTATIC"),
  HISTORY("", LOCAL, "", "*OBSTACLE, NAME=O, TYPE=CONFORMING\nMOVE, "
          "\"0.01*t\", \"0.004*sin(5*t)\"\n", "*QUASISTATIC"),
  HISTORY("*EXPANSION\n1.E-5\n", LOCAL, "*TEMPERATURE\nBODY, 300., FRO\n",
          STILL, "*QUASISTATIC"),
  HISTORY(MAXWELL, LOCAL, "", STILL, "*VISCO, INTEGRATOR=BACKWARD"),
  HISTORY(MAXWELL, LOCAL, "", STILL, "*VISCO, INTEGRATOR=HEUN"),
  HISTORY(MAXWELL, LOCAL, "", STILL, "*VISCO, INTEGRATOR=EXPONENTIAL"),
  HISTORY(NORTON, LOCAL, "", STILL, "*VISCO, INTEGRATOR=MIDPOINT"),
  HISTORY(NORTON, LOCAL, "", STILL, "*VISCO, INTEGRATOR=RK4"),
};
/* clang-format on */
enum { HISTORIES = sizeof with_history / sizeof *with_history };

/* _i: the deck */
TESTS(cut_increments_leave_no_trace, HISTORIES) {
  PRINTED(small, with_history[_i], "0.125");
  PRINTED(large, with_history[_i], "0.5");
  run_record fine = run_deck(small, 0.0), coarse = run_deck(large, 0.0);
  picky_dt = 0.125;
  run_record cut = run_deck(large, HUGE_VAL);
  picky_dt = 0.0;
  ck_assert_int_eq(cut.accepted, fine.accepted);
  ck_assert_int_eq(cut.rejected, 4);
  ck_assert_int_eq(cut.unsettled, 0);
  double scale = 0.0, differ = 0.0, apart = 0.0;
  for (int i = 0; i < fine.n_dof; ++i) {
    scale = fmax(scale, fabs(fine.u[i]));
    differ = fmax(differ, fabs(cut.u[i] - fine.u[i]));
    apart = fmax(apart, fabs(coarse.u[i] - fine.u[i]));
  }
  ck_assert_msg(differ <= 1e-12 * scale, "%g of %g", differ, scale);
  ck_assert_double_gt(apart, 1e-6 * scale);
}

TEST(increment_that_cannot_be_cut_further_is_unsettled) {
  run_record r = run_deck(DECK(0.5), 1e-3);
  ck_assert_int_eq(r.unsettled, r.accepted);
  ck_assert_int_gt(r.rejected, 0);
  ck_assert_double_eq(r.t[r.accepted - 1], 1.0);
}

/* Where a method stagnates, adapted increments are cut once, fixed ones not. */
TESTS(cuts_end_where_they_do_not_help, 2) {
  PRINTED(adapted,
          HISTORY(MAXWELL, LOCAL, "", STILL,
                  "*VISCO, INTEGRATOR=HEUN, TOLERANCE=1."),
          "0.5");
  picky_outcome = STOPPED_STAGNATION;
  run_record r = run_deck(_i == 0 ? DECK(0.5) : adapted, 1e-3);
  ck_assert_int_eq(r.rejected, _i == 1);
  ck_assert_int_eq(r.unsettled, r.accepted);
}

TEST(energies_balance_at_every_increment) {
  run_record r = run_deck(DECK(0.0625), 0.0);
  ck_assert_int_eq(r.accepted, 16);
  ck_assert_double_le(r.worst_defect, 1e-12);
}

TEST(step_ends_at_the_time_asked_for) {
  run_record r = run_deck(DECK(0.3), 0.0);
  ck_assert_int_eq(r.accepted, 4);
  ck_assert_double_eq(r.t[3], 1.0);
  r = run_deck(DECK(0.1), 0.0);
  ck_assert_int_eq(r.accepted, 10);
  ck_assert_double_eq(r.t[9], 1.0);
}

/* _i: the deck, 0 with as few effects as can be, the others with many. */
TESTS(every_refused_request_is_reported, HISTORIES) {
  enum { FEW = 120 };
  static const char goals[] =
      "*GOAL, NAME=E, QUANTITY=ENERGY\n"
      "*GOAL, NAME=F, QUANTITY=FORCE, CONTACT=C\n"
      "*GOAL, NAME=W, QUANTITY=FRICTION WORK\n"
      "*WEAR, CONTACT=C, COEFFICIENT=1e-9\n";
  static const char errors[] =
      "*ACCURACY, MESH=YES, TIME=YES, THEORY=YES\n"
      "*PRINT, CONTACT, TOTALS, NODES, ELEMENTS, ENERGY, ZONES, LOOP, WEAR, "
      "GOALS, REACTIONS\n";
  run_record r = {0};
  PRINTED(whole, with_history[_i], "0.5");
  const char *begin = strstr(whole, "*STEP\n"), *at = strstr(whole, "*OUTPUT");
  PRINTED(text, "%.*s%s%.*s%s%s", (int)(begin - whole), whole,
          _i > 0 ? goals : "", (int)(at - begin), begin, _i > 0 ? errors : "",
          at);
  TEXT_MODEL s = text_model_read(text, block());
  ck_assert_int_eq(s.st, OK);
  r.n_dof = 2 * s.msh->n_node;
  history_sink sink = {.ctx = &r, .increment = keep, .rejected = count};
  /* Once for its warnings, once to count its requests. */
  ck_assert_int_eq(history_run(s.m, s.msh, effect_table, &sink, &r.unsettled),
                   OK);
  const size_t before = memory_in_use();
  const long first = memory_requests();
  r.accepted = 0;
  history_run(s.m, s.msh, effect_table, &sink, &r.unsettled);
  const long all = memory_requests() - first;
  int refused = 0;
  for (long k = 1; k <= all; k += k < FEW || unit_whole() ? 1 : k / 20) {
    r.accepted = 0;
    memory_refuse(k, 0);
    status st = history_run(s.m, s.msh, effect_table, &sink, &r.unsettled);
    memory_refuse(0, 0);
    ck_assert_msg(st == OK || st == ERR_MEMORY, "request %ld: %s", k,
                  status_message());
    ck_assert_msg(memory_in_use() == before, "request %ld: %zu bytes left; %s",
                  k, memory_in_use() - before, status_message());
    refused += st == ERR_MEMORY;
  }
  ck_assert_int_gt(refused, 50);
}

/* |e|_A = 2, of a body whose norm is sqrt(2 8) = 4. */
TEST(error_of_the_solver_is_half_its_square_and_its_part) {
  error_bound e;
  solver_error found = {.norm = 2, .rate = 0.3};
  error_bound_set(&found, 8, &e);
  ck_assert_double_eq(e.energy, 2);
  ck_assert_double_eq(e.relative, 0.5);
  ck_assert_double_eq(e.rate, 0.3);
  error_bound_set(&found, 0, &e);
  ck_assert(isnan(e.relative));
  found.norm = 0;
  error_bound_set(&found, 0, &e);
  ck_assert_double_eq(e.relative, 0);
}

UNIT_MAIN("history")
