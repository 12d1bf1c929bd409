/*
 * src/output/listing: blocks of the listing of a made-up run in which no number
 * is there twice, as they are to be read.
 */
#include "output/listing/job.h"
#include "output/writers.h"
#include "support/folder.h"
#include "support/made_up.h"
#include "support/unit.h"

static made_up *made;
static run_summary summary;

/* What "write" prints has the text. */
static void must_print(status (*write)(const job *j, text_file *to),
                       const char *text) {
  static const output_options plain = {.no_timing = 1};
  text_file to = {0};
  static effect_plan none;
  job j = {.m = &made->m,
           .msh = made->msh,
           .o = &plain,
           .run = &summary,
           .plan = &none};
  FOLDER(dir);
  PRINTED(path, "%s/text", dir);
  ck_assert_int_eq(text_open(&to, path, 0), OK);
  ck_assert_int_eq(write(&j, &to), OK);
  ck_assert_int_eq(text_close(&to), OK);
  FREED char *told = folder_file(dir, "text", NULL);
  ck_assert_msg(strstr(told, text) != NULL, "wanted\n%s\nin\n%s", text, told);
}

/* ---- an increment -------------------------------------------------------- */

static status write_increment(const job *j, text_file *to) {
  return listing_increment(j, &made->s, to);
}

static status write_others(const job *j, text_file *to) {
  listing_between(&made->s, to);
  return listing_rejected(&made->s, "too long", to);
}

static state *make_increment(void) {
  made = made_up_new(2, 1, 1);
  made_up_advance(made, 1);
  state *s = &made->s;
  s->step_no = 1;
  s->increment_no = 14;
  s->attempt = 2;
  s->t = 1.5;
  s->dt = 0.25;
  s->contacts.n_open = 5;
  s->contacts.n_slip = 6;
  s->contacts.n_stick = 7;
  s->report = (solver_report){.outcome = CONVERGED,
                              .iterations = 8,
                              .limit_updates = 9,
                              .residual = 1.1e-11,
                              .solver = "newton"};
  return s;
}

/* clang-format off */
#define HEAD \
  "\nstep 1  increment 14  time 1.500000000E+000  dt 2.500000000E-001  " \
  "attempt 2\n" \
  "  contact nodes: open 5, slip 6, stick 7\n" \
  "  solver newton: converged, iterations 8, limit updates 9, residual " \
  "1.10E-011\n"
/* clang-format on */

TEST(errors_of_an_increment) {
  goal_result goal = {6.0, -0.5, 0.01, 0.02, 0.03, 0.0, 0, 0, GOAL_RELIABLE};
  goal_card sink = {.name = "SINK", .quantity = GOAL_DISPLACEMENT};
  state *s = make_increment();
  state_errors *e = &s->errors;
  made->m.n.goal = 1;
  made->m.accuracy.goals = &sink;
  e->rounding = (rounding_loss){1, 9.0, 0.01, 0.02, 0.03};
  e->error = (error_bound){.asked = 1,
                           .before = 9.0,
                           .energy = 0.5,
                           .relative = 0.06,
                           .rate = 0.75,
                           .hidden = 0.2};
  e->in_doubt = e->after_miss = 1;
  e->balance = (balance_report){1, 0.001, 3e-5, 9, 12.0, 9.0};
  e->mesh_error = (error_share){1, 0.04, 9.0, NULL, 0.0, 0.0};
  e->time_error = (error_share){1, 0.05, 9.0, "no order is seen", 0.0, 0.0};
  e->exact = (true_error){1, 0.011, 0.012, 0.013, 0.014, 9.0};
  e->n_goal = 1;
  e->goals = &goal;
  s->solver_log = "newton: cycle";
  must_print(write_increment, HEAD
             "  rounding: 1.0E+000 % of the energy norm, 2.0E+000 % of the "
             "largest stress, 3.0E+000 %\n    of the largest displacement\n"
             "  rounding may be 2.0E+001 % of the contact forces\n"
             "  error of the solver: at most 6.0E+000 % of the energy norm, "
             "5.0E-001 force*length; contraction 7.50E-001\n"
             "  balanced: 1.0E-001 % is enough, stopped below residual "
             "3.0E-005; saved about 12 iterations\n"
             "  tried: newton: cycle\n"
             "  THE ERROR OF THE SOLVER MAY BE ABOVE 10 %\n"
             "  AN INCREMENT BEFORE, FROM WHICH THIS ONE GOES ON, DID NOT "
             "CONVERGE\n");
  must_print(
      write_increment,
      "\n  error of the mesh: about 4.0E+000 % of the energy norm\n"
      "  error of the steps: about 5.0E+000 % of the energy norm, no order "
      "is seen\n"
      "  true error: energy norm 1.10E+000 %, displacement 1.20E+000 %, "
      "stress 1.30E+000 %, contact pressure 1.40E+000 %\n"
      "  goal                      value        error      corrected       "
      "band     solver  ends%  unit; verdict\n"
      "  SINK              6.000000E+000  -5.000E-001  5.500000E+000   "
      "2.0E-002   1.0E-002      3  length; reliable\n");
  must_print(write_others,
             "\nstep 1  within increment 14  time 1.500000000E+000  tables\n"
             "\nstep 1  increment 14  time 1.500000000E+000  dt "
             "2.500000000E-001  attempt 2\n  cut: too long\n");
  made_up_free(made);
}

/* Two solutions of an enumeration on two nodes, and attempts by solvers. */
TEST(solutions_of_an_increment) {
  double u[] = {0.1, 0.2, 0.3, 0.4}, r[] = {0.5, 0.6, 0.7, 0.8};
  contact_status status_of[] = {CONTACT_SLIP, CONTACT_OPEN};
  solution found[2] = {
      {u, r, status_of, {1e-12, 9.0, 1, 2, 3, {4, 5}, {6, 7}, 9, 0}},
      {u, r, status_of, {2e-12, 0.25, 4, 5, 6, {8, 9}, {10, 11}, 9, 1}}};
  solution_attempt attempts[] = {
      {"newton", "direct", "stick", CONVERGED, 9.0, 1},
      {"newton", "direct", "open", CONVERGED, 9.0, 1},
      {"sor", "sweeps", "slip", CONVERGED, 9.0, 2},
      {"pcg", "descent", "last", STOPPED_STAGNATION, 3e-4, 0}};
  solution_set set = {.n = 2,

                      .n_found = 2,
                      .found = found,
                      .n_pattern = 81,
                      .n_undecided = 17};
  state *s = make_increment();
  s->errors.solutions = &set;
  must_print(write_increment, HEAD
             "  check: 81 combinations of statuses, 2 solutions\n"
             "     1  residual 1.0E-012  open 1  slip 2  stick 3  u_n "
             "4.0000E+000 to 6.0000E+000  u_t 5.0000E+000 to 7.0000E+000\n"
             "         node_no status          u_n          u_t          f_n "
             "         f_t\n"
             "              12 SLIP   1.0000E-001 2.0000E-001 -5.0000E-001 "
             "6.0000E-001\n"
             "               9 OPEN   3.0000E-001 4.0000E-001 -7.0000E-001 "
             "8.0000E-001\n"
             "     2  residual 2.0E-012  open 4  slip 5  stick 6  u_n "
             "8.0000E+000 to 1.0000E+001  u_t 9.0000E+000 to 1.1000E+001\n"
             "        2.50E+001 % of the energy norm away from solution 1\n"
             "        all states between solutions 1 and 2 are solutions: a "
             "continuum\n");
  must_print(write_increment,
             "    the run goes on with solution 1\n"
             "    17 singular combinations have solutions of unknown extent\n");
  set.n_pattern = set.n_undecided = 0;
  set.n_attempt = 4;
  set.attempts = attempts;
  must_print(write_increment, HEAD
             "  check: 4 attempts, 2 solutions\n"
             "     1  residual");
  must_print(write_increment,
             "7.0000E+000\n"
             "        by newton (direct) from: stick, open\n"
             "     2  residual");
  must_print(write_increment,
             "a continuum\n"
             "        by sor (sweeps) from: slip\n"
             "    the run goes on with solution 1\n"
             "    pcg (descent), start last: no further progress, residual "
             "3.0E-004\n");
  made_up_free(made);
}

TEST(theorems_of_an_increment) {
  theorems_contact foot = {0, 0.1, 9.0, 0.2, 0.3, 0.4, 5.0, 6.0, MU_UNDER};
  state *s = make_increment();
  theorems_report *t = &s->errors.theorems;
  *t = (theorems_report){.asked = 1,
                         .fresh = 1,
                         .n_contact = 1,
                         .contacts = &foot,
                         .total = {1.0, 2.0, 0, NULL},
                         .change = {4.0, 3.0, 1, NULL},
                         .inequality = -1e-3,
                         .n_field = 31,
                         .has_start = 1,
                         .start = -2e-3,
                         .path = {.asked = 1,
                                  .rate = 0.7,
                                  .bound = 0.8,
                                  .speed = 11.0,
                                  .longest = 12.0,
                                  .span = 9.0,
                                  .passes = 13.0}};
  must_print(
      write_increment, HEAD
      "  theory: (3.8) of the initial state: least -2.0E-003\n"
      "  theory: FOOT: largest eigenvalues of A_nn 5.0000E+000 force/length, "
      "of inv(A)_tt 6.0000E+000 length/force\n"
      "  theory: contact             mu[-]     1/C_h[-]  contraction "
      "mu/contr.[-]  mu is\n"
      "  FOOT                  1.0000E-001  2.0000E-001  3.0000E-001  "
      "4.0000E-001  unique: under 1/C_h\n"
      "  theory: (3.9) |u|: 1.0000E+000 <= 2.0000E+000 sqrt(force*length)  "
      "ok\n"
      "  theory: (3.10) |du|: 4.0000E+000 <= 3.0000E+000 sqrt(force*length)  "
      "VIOLATED\n"
      "  theory: S_i^n over 31 test fields: least -1.0E-003  ok\n"
      "  theory: (3.2) stress: contraction 7.0000E-001 <= 8.0000E-001  ok\n"
      "  theory: (3.2) constant of the laws 1.1000E+001 1/time, below 1 for dt "
      "< 1.2000E+001 time; over the step after 13 passes\n");
  t->inequality_violated = t->path.violated = 1;
  t->total.why = "friction alone resists";
  must_print(write_increment,
             "  theory: (3.9) |u|: no bound, friction alone resists\n");
  must_print(write_increment,
             "least -1.0E-003  VIOLATED\n"
             "  theory: (3.2) stress: contraction 7.0000E-001 <= 8.0000E-001  "
             "VIOLATED\n");
  made_up_free(made);
}

/* ---- the start ----------------------------------------------------------- */

static start_report report;

static status write_start(const job *j, text_file *to) {
  return listing_start(j, &report, to);
}

/* The largest defects first, with the numbers of their nodes. */
TEST(initial_state_has_its_worst_nodes) {
  double defect[] = {0.0, 3.0, 1.0, 4.0};
  unsigned char kind[] = {0, 1, 2, 3};
  made = made_up_new(2, 1, 1);
  ck_assert_int_eq(made->msh->n_node, 4);
  report = (start_report){.defect = defect,
                          .kind = kind,
                          .worst = 4.0,
                          .scale = 8.0,
                          .ratio = 0.5,
                          .n_bad = 3,
                          .source = "other.h5",
                          .source_time = 2.5};
  must_print(write_start,
             "\ninitial state: end of other.h5, time 2.500000000E+000\n"
             "  largest force              8.00000E+000 force\n"
             "  largest defect             4.00000E+000 force\n"
             "  defect, relative           5.00000E-001 -\n"
             "  nodes out of equilibrium              3, above 1E-006\n"
             "  node 3                     4.00000E+000 force: unilateral "
             "condition not met\n"
             "  node 9                     3.00000E+000 force: not in "
             "equilibrium with the loads\n"
             "  node 6                     1.00000E+000 force: not at its "
             "support\n"
             "  REFUSED\n");
  made_up_free(made);
}

/* ---- model and equations ------------------------------------------------- */

static int group_named(const char *name) {
  return (int)(mesh_find_group(made->msh, name) - made->msh->group);
}

TEST(model_and_its_sizes) {
  static const friction_ops coulomb = {.name = "COULOMB"},
                            bowl = {.name = "BOWL"};
  made = made_up_new(2, 1, 1);
  model *m = &made->m;
  friction_change change = {.contact_id = 0, .rule.law = &bowl};
  const surface_pair two = {.slave_id = group_named("LEFT"),
                            .master_id = group_named("RIGHT"),
                            .adjust = 1,
                            .moved = 0.125,
                            .why = "finer"};
  tie glue = {.name = "GLUE", .pair = two};
  m->n.material = 9;
  m->n.tie = 1;
  m->ties = &glue;
  m->steps[0].friction.n = 1;
  m->steps[0].friction.changes = &change;
  made->foot.friction.law = &coulomb;
  made->body.averaged = 1;
  must_print(listing_open,
             "\nMODEL\n-----\n"
             "  dimension                       2\n"
             "  nodes                           4\n"
             "  elements                        2\n"
             "  groups                          5\n"
             "  materials                       9\n"
             "  sections                        1\n"
             "  contacts                        1\n"
             "  steps                           1\n"
             "  group    ");
  must_print(listing_open,
             "  section  BODY                 plane strain, material STEEL, "
             "volume averaged\n"
             "  contact  FOOT                 group BOTTOM, obstacle FLOOR, "
             "friction COULOMB\n"
             "  tie      GLUE                 slave LEFT (finer), master "
             "RIGHT, nodes moved by up to 0.125\n"
             "  contact  FOOT                 from step 1 on friction BOWL\n"
             "\nEFFECTS\n");
  made->body.kin = AXISYMMETRIC;
  made->foot.is_pair = 1;
  made->foot.pair = two;
  made->foot.pair.adjust = made->body.averaged = 0;
  made->foot.friction.law = NULL;
  must_print(listing_open,
             "  section  BODY                 axisymmetric, material STEEL\n"
             "  contact  FOOT                 slave LEFT (finer), master "
             "RIGHT, friction none\n");
  made_up_free(made);
}

TEST(equations_and_end) {
  made = made_up_new(2, 1, 1);
  summary = (run_summary){
      .facts_known = 1,
      .facts = {.choice = {.dense.bytes = 1.0, .why = "fewer bytes"},
                .info = {.bodies = 2,
                         .unknowns = 31,
                         .contact_unknowns = 32,
                         .factor_entries = 33,
                         .ordering = "AMD"},
                .condition = 1.5e3,
                .digits = 12.5,
                .n_contact_node = 34,
                .n_left_out = 35,
                .average_entries = 36},
      .verdict = ERR_UNSETTLED,
      .message = "why"};
  made->m.effects |= EFFECT_NONLOCAL;
  must_print(listing_ready,
             "\nEQUATIONS\n---------\n"
             "  bodies                          2\n"
             "  unknowns                       31\n"
             "  contact nodes                  34\n"
             "    out of reach                 35\n"
             "  contact unknowns               32\n"
             "  factor entries                 33\n"
             "  average entries                36\n"
             "  ordering                      AMD\n"
             "  stiffness                   DENSE  fewer bytes\n"
             "  condition                1.5E+003\n"
             "  digits left                  12.5 of 16, at worst\n"
             "\nINCREMENTS\n");
  must_print(
      listing_end,
      "\nEND\n---\n  exit 1: finished, but an increment did not converge "
      "to its tolerance\n  why\n");
  summary.facts.choice.sparse = summary.facts.floating = 1;
  summary.facts.condition = NAN;
  summary.facts.n_left_out = 0;
  summary.message = "";
  made->m.effects &= ~EFFECT_NONLOCAL;
  made->m.problem.given = 1;
  must_print(listing_ready,
             "\nEQUATIONS\n---------\n"
             "  unknowns                       31\n"
             "  contact nodes                  34\n"
             "  contact unknowns               32\n"
             "  ordering                      AMD\n"
             "  stiffness                  FACTOR  fewer bytes\n"
             "  contact alone holds at least one body\n"
             "\nINCREMENTS\n");
  summary.facts.choice.dense.bytes = 0;
  must_print(listing_ready,
             "  ordering                      AMD\n"
             "  contact alone holds at least one body\n");
  made_up_free(made);
}

/* What *EFFECTS, MODE=AUTO left out: each in another way. */
TEST(effects_left_out) {
  made = made_up_new(2, 1, 1);
  model *m = &made->m;
  summary = (run_summary){.message = ""};
  m->reduction.n = 3;
  m->reduction.tol = 0.25;
  const omitted base = {.bit = EFFECT_BIT_THERMAL,
                        .why = "small",
                        .bound = 0.1,
                        .local = 0.2,
                        .change = 0.3,
                        .checked = 14,
                        .again = 15};
  for (int i = 0; i < 3; ++i) m->reduction.row[i] = base;
  m->reduction.row[1].back = m->reduction.row[2].back = 1;
  m->reduction.row[2].lost = 1;
  m->reduction.row[0].checked = 16;
  m->reduction.row[0].again = 17;
  must_print(listing_open,
             "  left out: thermal strain: small\n"
             "  not left out: thermal strain: small\n"
             "    without it: at most 1.0e-01 of the energy norm, 2.0e-01 of "
             "the largest stress,\n    solved again with it: 3.0e-01 of the "
             "largest displacement or force, after 14\n    increments; too "
             "much for TOL=0.25, this is the run with it\n"
             "  not left out: thermal strain: small\n"
             "    without it an increment was not solved to its tolerance, "
             "this is the run\n    with it\n");
  must_print(listing_summary,
             "  without thermal strain: changes the answer by at most "
             "1.0e-01 of the energy norm,\n    2.0e-01 of the largest "
             "stress, at each of 16 increments\n    17 of them solved again "
             "with it: 3.0e-01 of the largest displacement or force\n");
  made_up_free(made);
}

/* ---- accuracy of the run ------------------------------------------------- */

static status write_accuracy(const job *j, text_file *to) {
  listing_accuracy(j, to->f);
  return OK;
}

static status write_closing(const job *j, text_file *to) {
  closing_lines(j, "files", to->f);
  return OK;
}

TEST(counts_of_the_run) {
  static increment_summary all[11];
  made = made_up_new(2, 1, 1);
  summary = (run_summary){.n_increment = 11,
                          .n_rejected = 12,
                          .n_unsettled = 13,
                          .residual_worst = 1.4e-11,
                          .penetration_worst = 0.15,
                          .defect_worst = 1.6e-12,
                          .increments = all,
                          .message = "",
                          .verdict = ERR_UNSETTLED};
  must_print(listing_summary,
             "  increments                           11\n"
             "  attempts cut                         12\n"
             "  tolerance missed                     13\n"
             "  largest residual              1.40E-011\n"
             "  largest energy defect         1.60E-012\n");
  summary.n_increment = 0;
  must_print(write_closing, "; increments 0, attempts cut 12\n");
  made_up_free(made);
}

TEST(budget_goals_and_passes) {
  static goal_card cards[2] = {
      {.name = "SINK",
       .quantity = GOAL_DISPLACEMENT,
       .target = 0.125,
       .in_percent = 0},
      {.name = "PULL", .quantity = GOAL_FORCE, .target = 3, .in_percent = 1}};
  increment_summary all[3] = {
      {.step_no = 1,
       .iterations = 20,
       .error = {.asked = 1, .relative = 0.05},
       .balance = {1, 9.0, 9.0, 9, 100.0, 9.0},
       .mesh_error = {1, 0.06, 9.0, NULL},
       .time_error = {1, 0.07, 9.0, NULL},
       .exact = {1, 0.08, 9.0, 9.0, 9.0, 9.0}},
      {.step_no = 1,
       .iterations = 3,
       .error = {.asked = 1, .relative = 0.015},
       .balance = {1, 9.0, 9.0, 9, 1000.0, 9.0},
       .mesh_error = {1, 0.02, 9.0, NULL},
       .time_error = {1, 0.01, 9.0, NULL},
       .exact = {1, 0.03, 9.0, 9.0, 9.0, 9.0}},
      {.step_no = 1, .count = {31, 32, 33}, .iterations = 9}};
  goal_result goals[2] = {
      {6.0, -0.5, 0.01, 0.02, 0.03, 0.0, 0, 0, GOAL_RELIABLE},
      {7.0, 0.25, 0.04, 0.05, 0.06, 0.0, 0, 0, GOAL_RELIABLE}};
  pass_row rows[2] = {{100, 1, NAN, 3, 4, 9, "finer"},
                      {200, 5, 6, 7, 8, 9, ""}};
  pass_row forecast = {300, 9, 9, 9, 0.5, 9, ""};
  pass_goal of_pass[4] = {{goals[0], NAN, 0.125},
                          {goals[1], 0.29, 9.0},
                          {goals[0], 0.22, 0.125},
                          {goals[1], 0.58, 9.0}};
  made = made_up_new(2, 1, 2);
  model *m = &made->m;
  m->n.goal = 2;
  m->accuracy.goals = cards;
  m->effects |= EFFECT_HISTORY;
  summary = (run_summary){.n_increment = 3, .increments = all, .goals = goals};
  summary.passes = (pass_table){10, 2, rows, &forecast, of_pass, ""};
  must_print(
      write_accuracy,
      "\n  error in the energy norm        last[%]   largest[%]\n"
      "  mesh                          2.00E+000    6.00E+000\n"
      "  steps                         1.00E+000    7.00E+000\n"
      "  solver                        1.50E+000    5.00E+000\n"
      "  true, by *REFERENCE           3.00E+000    8.00E+000\n"
      "  estimated over true error: 1.50\n"
      "  stopping balanced with the other errors saved about 1100 of 1123 "
      "iterations (to residual 1E-10)\n"
      "\n  goal                      value        error      corrected       "
      "band     solver  ends%  unit; verdict\n"
      "  SINK              6.000000E+000  -5.000E-001  5.500000E+000   "
      "2.0E-002   1.0E-002      3  length; reliable\n"
      "  PULL              7.000000E+000   2.500E-001  7.250000E+000   "
      "5.0E-002   4.0E-002      6  force; reliable\n"
      "  improve next: the mesh: half the length of the elements gives about 1 "
      "% for up to 5 times the CPU\n"
      "\n  target 10 % of the energy norm, 0.125 length SINK, 3 % of PULL: "
      "reached\n"
      "  pass         unknowns    mesh[%]   steps[%]  solver[%]   total[%] "
      "SINK[length]    PULL[%]  next pass\n"
      "  1                 100  1.00E+000          -  3.00E+000  4.00E+000    "
      "        -  4.00E+000  finer\n"
      "  2                 200  5.00E+000  6.00E+000  7.00E+000  8.00E+000    "
      "2.20E-001  8.00E+000  \n"
      "  next digit        300                                   5.00E-001    "
      "                      forecast\n");
  double ends[40];
  for (int k = 0; k < 40; ++k) ends[k] = 10 + k;
  ck_assert_int_le(job_end_size(m), 40);
  summary.ends = ends;
  summary.n_rejected = 12;
  summary.penetration_worst = 0.15;
  summary.residual_worst = 1.4e-11;
  must_print(
      write_closing,
      "exit      0: done; increments 3, attempts cut 12\n"
      "FOOT      force_x 12, force_y 13, open 19, slip 20, stick 21\n"
      "worst     residual 1.4e-11, penetration 0.15\n"
      "SINK      6 length, error -0.5: 5.5 within 0.02, reliable\n"
      "PULL      7 force, error 0.25: 7.25 within 0.05, reliable\n"
      "error     mesh 6 %, steps 7 %, solver 5 % of the energy norm\n"
      "next      the mesh: half the length of the elements gives about 1 % for "
      "up to 5 times the CPU\n"
      "cost      ");
  m->n.contact = 0;
  must_print(write_closing, "\ncontact   open 31, slip 32, stick 33\n");
  m->n.contact = 1;
  m->dim = 3;
  must_print(write_accuracy, " gives about 1 % for up to 38 times the CPU\n");
  m->dim = 2;
  made->m.steps[0].accuracy.time_balanced = 1;
  all[1].time_error.relative = 0.04;
  all[1].error.relative = 1e-6;
  summary.passes.why = "no memory";
  must_print(write_accuracy,
             "  increments balanced with the error of the mesh: 3 in the place "
             "of 2 of the deck\n");
  must_print(write_accuracy,
             "  improve next: the increments: half their length gives 2 % or "
             "less of 4 % for 2 times the CPU;\n    the solver is 4e+04 times "
             "more exact\n");
  must_print(write_accuracy, " % of PULL: missed\n");
  made_up_free(made);
}

UNIT_MAIN("listing")
