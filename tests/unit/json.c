/*
 * src/output/json.c and what src/output/saved.c remembers for it: a made-up run
 * in which no number is there twice, as it is to be read.
 */
#include "output/output.h"

#include "support/folder.h"
#include "support/made_up.h"
#include "support/unit.h"

/* JOB.json of a run of one increment after three cuts, with times where there
 * are passes; the caller frees. */
static char *write(made_up *made, const pass_table *passes) {
  FOLDER(dir);
  const output_options o = {.dir = dir, .no_timing = passes->n == 0};
  output *out = NULL;
  ck_assert_int_eq(output_open(&made->m, made->msh, &o, &out), OK);
  const history_sink sink = output_sink(out);
  ck_assert_int_eq(sink.ready(sink.ctx, &made->facts, &made->surface), OK);
  for (int i = 0; i < 3; ++i)
    ck_assert_int_eq(sink.rejected(sink.ctx, &made->s, "too long"), OK);
  ck_assert_int_eq(sink.increment(sink.ctx, &made->s), OK);
  output_passes(out, passes);
  ck_assert_int_eq(output_close(out, OK, 1), ERR_UNSETTLED);
  char *text = folder_file(dir, "block.json", NULL);
  ck_assert_ptr_nonnull(text);
  return text;
}

/* Blanks at the beginning of lines and line ends do not count. */
static void must_have(made_up *made, const pass_table *passes,
                      const char *wanted) {
  char *text = write(made, passes), *to = text;
  for (const char *from = text; *from != '\0'; ++from) {
    if (*from == '\n')
      from += strspn(from, "\n ") - 1;
    else
      *to++ = *from;
  }
  *to = '\0';
  ck_assert_msg(strstr(text, wanted) != NULL, "wanted\n%s\nin\n%s", wanted,
                text);
  free(text);
}

static made_up *make_increment(void) {
  made_up *made = made_up_new(2, 1, 1);
  made_up_advance(made, 1);
  state *s = &made->s;
  made->facts.digits = 12.5;
  s->increment_no = 14;
  s->attempt = 2;
  s->t = 1.5;
  s->dt = 0.25;
  s->settled = 0;
  s->contacts.n_open = 5;
  s->contacts.n_slip = 6;
  s->contacts.n_stick = 7;
  s->report = (solver_report){.outcome = STOPPED_STAGNATION,
                              .iterations = 8,
                              .limit_updates = 99,
                              .residual = 0.0625};
  made->totals[0] = (contact_total){.force = {71, 72, 73},
                                    .moment = {74, 75, 76},
                                    .normal = 77,
                                    .tangential = {78, 79},
                                    .area = 80,
                                    .pressure = 81,
                                    .penetration = 82,
                                    .n_open = 83,
                                    .n_slip = 84,
                                    .n_stick = 85};
  s->energy.defect = 10;
  s->energy.largest = 16;
  return made;
}

#define HEAD                                               \
  "\"increments\": [{\"step\": 1,\"increment\": 14,"       \
  "\"attempt\": 2,\"time\": 1.5,\"dt\": 0.25,\"open\": 5," \
  "\"slip\": 6,\"stick\": 7,\"iterations\": 8,"            \
  "\"residual\": 0.0625,"

static const pass_table none;

TEST(errors_of_an_increment) {
  MADE_UP *made = make_increment();
  state_errors *e = &made->s.errors;
  e->rounding = (rounding_loss){1, 99, 0.125, 0.375, 0.75};
  e->error = (error_bound){1, 99, 0.5, 0.25, 99, 0.875, "none", 2};
  e->in_doubt = e->after_miss = e->jumps = 1;
  e->jump_t = 1.375;
  e->balance = (balance_report){1, 3, 3.5, 9, 99, 99};
  e->mesh_error = (error_share){1, 4, 99, "coarse", 99, 0};
  e->time_error = (error_share){1, 5, 99, "no order", 99, 0};
  e->exact = (true_error){1, 6, 7, 8, 9, 99};
  must_have(made, &none,
            HEAD
            "\"mesh_error_percent\": 400,\"coarse_mesh\": true,"
            "\"time_error_percent\": 500,"
            "\"balanced_wanted_percent\": 300,\"balanced_residual\": 3.5,"
            "\"balanced_passes\": 9,\"true_error_percent\": 600,"
            "\"true_displacement_error_percent\": 700,"
            "\"true_stress_error_percent\": 800,"
            "\"true_pressure_error_percent\": 900,"
            "\"solver_error_percent\": 25,\"solver_error_energy\": 0.5,"
            "\"contraction\": 0.875,\"solver_error_missing\": \"none\","
            "\"rounding_energy_percent\": 12.5,"
            "\"rounding_stress_percent\": 37.5,"
            "\"rounding_displacement_percent\": 75,"
            "\"rounding_hidden_percent\": 200,\"energy_defect\": 0.625,"
            "\"settled\": false,\"after_unsettled\": true,"
            "\"outcome\": \"STAGNATION\",\"jump_time\": 1.375}]}");
  must_have(made, &none,
            "\"accuracy\": {\"increments\": 1,\"attempts_cut\": 3,"
            "\"tolerance_missed\": 1,\"residual_worst\": 0.0625,"
            "\"mesh_error_percent\": 400,"
            "\"mesh_error_worst_percent\": 400,"
            "\"time_error_percent\": 500,"
            "\"time_error_worst_percent\": 500,"
            "\"solver_error_percent\": 25,"
            "\"solver_error_worst_percent\": 25,"
            "\"true_error_percent\": 600,"
            "\"true_error_worst_percent\": 600,"
            "\"balanced_iterations\": 8,"
            "\"balanced_saved_iterations\": 99,"
            "\"improve_next\": \"the increments: half their length gives "
            "2.5e+02 % or less of 5e+02 % for 2 times the CPU\","
            "\"penetration_worst\": 82,\"energy_defect_worst\": 0.625,"
            "\"condition\": 1000,\"digits_left\": 12.5},"
            "\"contacts\": [{\"step\": 1,\"increment\": 14,\"time\": 1.5,"
            "\"contact\": \"FOOT\",\"force_x\": 71,\"force_y\": 72,"
            "\"moment_z\": 76,\"normal\": -77,\"tangential\": 78,"
            "\"torque\": 0.125,\"closed_area\": 80,\"open\": 83,"
            "\"slip\": 84,\"stick\": 85,\"pressure_max\": 81}],");
}

TEST(solutions_and_theorems_of_an_increment) {
  double u[] = {0, 0, 0, 0};
  contact_status status_of[] = {CONTACT_SLIP, CONTACT_OPEN};
  solution found[2] = {
      {u, u, status_of, {0.5, 0.25, 1, 2, 3, {4, 5}, {6, 7}, 8, 0}},
      {u, u, status_of, {1.5, 1.25, 14, 15, 16, {17, 18}, {19, 20}, 21, 1}}};
  solution_set set = {.n = 2, .n_found = 2, .found = found};
  theorems_contact rows[2] = {{0, 31, 32, 33, 34, 35, 36, 37, MU_UNDER},
                              {-1, 41, 42, 43, 44, 45, 46, 47, MU_ABOVE}};
  MADE_UP *made = make_increment();
  made->s.errors.solutions = &set;
  made->s.errors.theorems =
      (theorems_report){.asked = 1,
                        .n_contact = 2,
                        .contacts = rows,
                        .total = {51, 52, 0, NULL},
                        .change = {53, 54, 1, NULL},
                        .inequality = -55,
                        .n_field = 56,
                        .has_start = 1,
                        .start = -57,
                        .path = {1, NULL, 61, 62, 63, 64, 65, 66, 0}};
  must_have(made, &none,
            HEAD
            "\"energy_defect\": 0.625,\"settled\": false,"
            "\"outcome\": \"STAGNATION\","
            "\"solutions\": [{\"residual\": 0.5,\"distance_percent\": 25,"
            "\"open\": 1,\"slip\": 2,\"stick\": 3,\"u_n_lowest\": 4,"
            "\"u_n_highest\": 6,\"u_t_lowest\": 5,\"u_t_highest\": 7,"
            "\"found_times\": 8,\"continuum_with\": 0},"
            "{\"residual\": 1.5,\"distance_percent\": 125,\"open\": 14,"
            "\"slip\": 15,\"stick\": 16,\"u_n_lowest\": 17,"
            "\"u_n_highest\": 19,\"u_t_lowest\": 18,\"u_t_highest\": 20,"
            "\"found_times\": 21,\"continuum_with\": 1}],"
            "\"theory\": {\"contacts\": [{\"contact\": \"FOOT\","
            "\"mu\": 31,\"mu_unique\": 33,\"factor\": 32,"
            "\"contraction\": 34,\"mu_contraction\": 35,"
            "\"normal_eigenvalue\": 36,\"tangential_eigenvalue\": 37,"
            "\"mu_is\": \"unique: under 1/C_h\"},{\"contact\": \"\","
            "\"mu\": 41,\"mu_unique\": 43,\"factor\": 42,"
            "\"contraction\": 44,\"mu_contraction\": 45,"
            "\"normal_eigenvalue\": 46,\"tangential_eigenvalue\": 47,"
            "\"mu_is\": \"above both: does not contract\"}],"
            "\"bound_3_9\": {\"left\": 51,\"right\": 52,"
            "\"violated\": false},\"bound_3_10\": {\"left\": 53,"
            "\"right\": 54,\"violated\": true},"
            "\"theorem_3_2\": {\"stress_contraction\": 61,"
            "\"stress_bound\": 62,\"lipschitz\": 63,"
            "\"dt_contraction\": 64,\"step_time\": 65,"
            "\"maps_to_contract\": 66,\"violated\": false},"
            "\"inequality_least\": -55,\"inequality_fields\": 56,"
            "\"start_least\": -57,\"violated\": false}}]}");
  made->s.errors.theorems.total.why = "friction alone resists";
  made->s.errors.theorems.violated = 1;
  made->s.errors.theorems.path.violated = 1;
  made->s.errors.theorems.path.why = "nothing flows";
  must_have(made, &none,
            "\"bound_3_9\": {\"missing\": \"friction alone resists\"},"
            "\"bound_3_10\": {\"left\": 53,\"right\": 54,"
            "\"violated\": true},"
            "\"theorem_3_2\": {\"missing\": \"nothing flows\","
            "\"stress_bound\": 62,\"lipschitz\": 63,"
            "\"dt_contraction\": 64,\"step_time\": 65,"
            "\"maps_to_contract\": 66,\"violated\": true},"
            "\"inequality_least\": -55,\"inequality_fields\": 56,"
            "\"start_least\": -57,\"violated\": true}}]}");
}

TEST(sums_goals_and_passes_of_the_run) {
  static goal_card cards[2] = {
      {.name = "SINK", .quantity = GOAL_DISPLACEMENT, .target = 0.125},
      {.name = "PULL", .quantity = GOAL_FORCE}};
  goal_result goals[2] = {
      {6, -0.5, 0.0625, 0.25, 0.125, 18, 0, 0, GOAL_RELIABLE},
      {7, 8, 9, 10, 11, 19, 0, 0, GOAL_CANCELS}};
  const pass_row rows[2] = {{100, 1, 2, 3, 4, 20, "finer"},
                            {200, 5, 6, 7, 8, 21, ""}};
  const pass_goal of_pass[4] = {{goals[0], 12, 13},
                                {goals[1], 14, 99},
                                {goals[1], 15, 16},
                                {goals[0], 17, 99}};
  MADE_UP *made = make_increment();
  made->m.n.goal = 2;
  made->m.accuracy.goals = cards;
  made->s.errors.n_goal = 2;
  made->s.errors.goals = goals;
  made->steps[0].accuracy.time_balanced = 1;
  made->s.errors.balance = (balance_report){1, 3, 3.5, 9, 99, 22};
  const pass_table passes = {10, 2, rows, NULL, of_pass, "late"};
  must_have(made, &passes,
            "\"balanced_increments\": 1,"
            "\"balanced_increments_of_deck\": 1,"
            "\"balanced_iterations\": 8,"
            "\"balanced_saved_iterations\": 99,\"balanced_saved_cpu\": 22,");
  must_have(
      made, &passes,
      "\"goals\": [{\"goal\": \"SINK\",\"unit\": \"length\","
      "\"value\": 6,\"error\": -0.5,\"corrected\": 5.5,"
      "\"band\": 0.25,\"solver_error\": 0.0625,"
      "\"contact_ends_percent\": 12.5,\"verdict\": \"reliable\",\"cpu\": 18},"
      "{\"goal\": \"PULL\",\"unit\": \"force\",\"value\": 7,"
      "\"error\": 8,\"corrected\": 15,\"band\": 10,"
      "\"solver_error\": 9,\"contact_ends_percent\": 1100,"
      "\"verdict\": \"cancels\",\"cpu\": 19}],");
  must_have(
      made, &passes,
      "\"target\": {\"percent\": 10,\"reached\": false,"
      "\"passes\": [{\"unknowns\": 100,\"mesh_error_percent\": 1,"
      "\"time_error_percent\": 2,\"solver_error_percent\": 3,"
      "\"total_error_percent\": 4,\"goals\": [{\"goal\": \"SINK\","
      "\"unit\": \"length\",\"value\": 6,\"error\": -0.5,"
      "\"band\": 0.25,\"solver_error\": 0.0625,"
      "\"error_at_most\": 12,\"target\": 13,"
      "\"verdict\": \"reliable\"},{\"goal\": \"PULL\","
      "\"unit\": \"force\",\"value\": 7,\"error\": 8,\"band\": 10,"
      "\"solver_error\": 9,\"error_at_most\": 14,"
      "\"verdict\": \"cancels\"}],\"cpu\": 20,\"changed_next\": \"finer\"},"
      "{\"unknowns\": 200,\"mesh_error_percent\": 5,"
      "\"time_error_percent\": 6,\"solver_error_percent\": 7,"
      "\"total_error_percent\": 8,\"goals\": [{\"goal\": \"SINK\","
      "\"unit\": \"length\",\"value\": 7,\"error\": 8,\"band\": 10,"
      "\"solver_error\": 9,\"error_at_most\": 15,\"target\": 16,"
      "\"verdict\": \"cancels\"},{\"goal\": \"PULL\","
      "\"unit\": \"force\",\"value\": 6,\"error\": -0.5,"
      "\"band\": 0.25,\"solver_error\": 0.0625,"
      "\"error_at_most\": 17,\"verdict\": \"reliable\"}],"
      "\"cpu\": 21,\"changed_next\": \"\"}]},");
}

UNIT_MAIN("json")
