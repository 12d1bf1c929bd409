/* src/run/effect.c: which hooks of a table are called, in which order and with
 * what, by effects that write down their names. */
#include "run/run.h"
#include "support/unit.h"

/* "a.pose b.pose ..." of the calls since it was cleared; the letter of one that
 * fails; hooks that have *made do it where "making" is their letter. */
static char said[2000];
static char failing, making;
static int is_due;

typedef struct own {
  char letter;
} own;

static status say(const void *of, const char *hook) {
  const char letter = of == NULL ? '-' : ((const own *)of)->letter;
  const size_t used = strlen(said);
  snprintf(said + used, sizeof said - used, " %c.%s", letter, hook);
  for (int k = letter == 'b' ? 2 : 1; k > 0; --k) {
    timer_enter(STAGE_STRESS);
    timer_leave(STAGE_STRESS);
  }
  return letter == failing ? ERR_DECK : OK;
}

static status make(void *of, const char *hook, int *made) {
  const status st = say(of, hook);
  *made = of != NULL && ((own *)of)->letter == making;
  return st;
}

#define OF_RUN(name)                         \
  static status on_##name(run *r, void *o) { \
    (void)r;                                 \
    return say(o, #name);                    \
  }
#define AT_TIME(name)                                  \
  static status on_##name(run *r, void *o, double t) { \
    (void)r;                                           \
    return t == 2.5 ? say(o, #name) : ERR_FILE;        \
  }
OF_RUN(check)
OF_RUN(prepare)
OF_RUN(begin_step)
OF_RUN(start)
OF_RUN(initial)
OF_RUN(estimate)
OF_RUN(accept)
AT_TIME(attempt)
AT_TIME(load)
AT_TIME(pose)
AT_TIME(examine)

static status on_make_step(run *r, void *o, int *made) {
  (void)r;
  return make(o, "make_step", made);
}

static status on_solve(run *r, void *o, double t, int *made) {
  (void)r;
  return t == 2.5 ? make(o, "solve", made) : ERR_FILE;
}

static status on_found(run *r, void *o, int *again) {
  (void)r;
  return make(o, "found", again);
}

static status on_rewrite(run *r, void *o, contact_problem *cp, double **u,
                         double *force) {
  (void)r;
  ck_assert(cp->m == 7 && **u == 1.0 && *force == 2.0);
  return say(o, "rewrite");
}

static void on_restore(run *r, void *o, contact_problem *cp, double *u,
                       double *force) {
  (void)r;
  ck_assert(cp->m == 7 && *u == 1.0 && *force == 2.0);
  say(o, "restore");
}

static void on_describe(const run *r, const void *o, setup_facts *f) {
  (void)r;
  (void)f;
  say(o, "describe");
}

static void on_show(const void *o, state *s) {
  (void)s;
  say(o, "show");
}

static void on_end(run *r, void *o) {
  (void)r;
  say(o, "end");
}

static void on_forget(run *r, void *o) {
  (void)r;
  say(o, "forget");
}

static status on_keep(run *r, void *o, archive *a) {
  (void)r;
  return say(o, archive_group(a));
}

static int on_due(const run *r) {
  (void)r;
  return is_due;
}

/* A block that the state is to own. */
static status begin(void *o, char letter, const char *hook) {
  double *more;
  PASS_NEW(more, 3);
  ((own *)o)->letter = letter;
  return say(o, hook);
}

static status create_a(run *r, void **o) {
  (void)r;
  return begin(*o, 'a', "create");
}

static status create_b(run *r, void **o) {
  (void)r;
  ((own *)*o)[1].letter = 'y';
  return begin(*o, 'b', "create");
}

static status create_d(run *r, void **o) {
  (void)r;
  return begin(*o, 'd', "create");
}

static status on_copy(const run *r, const void *o, run *other, void **out) {
  (void)r;
  (void)other;
  ck_assert_int_eq(((const own *)o)->letter, 'b');
  return begin(*out, 'B', "copy");
}

static int yes(const model *m, const reason *why) {
  (void)m;
  (void)why;
  return 1;
}

static int no(const model *m, const reason *why) {
  (void)m;
  (void)why;
  return 0;
}

static int strains(const model *m, int elem_id) {
  (void)m;
  return elem_id == 3;
}

static size_t twice(const run *r) {
  (void)r;
  return 2;
}

#define ALL(...)                                                           \
  {                                                                        \
    .check = on_check, .prepare = on_prepare, .begin_step = on_begin_step, \
    .start = on_start, .initial = on_initial, .estimate = on_estimate,     \
    .accept = on_accept, .attempt = on_attempt, .load = on_load,           \
    .pose = on_pose, .examine = on_examine, .make_step = on_make_step,     \
    .solve = on_solve, .found = on_found, .rewrite = on_rewrite,           \
    .restore = on_restore, .describe = on_describe, .show = on_show,       \
    .end = on_end, .forget = on_forget, .keep = on_keep, __VA_ARGS__       \
  }

/* With a state, due now and then; with two, always due, timed; without hooks,
 * the only one that is far, sums up and has strains; without a state, timed
 * with all it enters; timed by itself, new in a copy; off, by its bit and by
 * its word. */
static const effect_ops a = {.name = "first",
                             .size = sizeof(own),
                             .bit = NO_BIT,
                             .required = yes,
                             .own = STAGE_NONE,
                             .on = ALL(.create = create_a, .due = on_due)};
static const effect_ops b = {.name = "second",
                             .size = sizeof(own),
                             .count = twice,
                             .bit = 5,
                             .own = STAGE_ZONES,
                             .copy_as = COPY_IS_EQUAL,
                             .on = ALL(.create = create_b, .copy = on_copy)};
static const effect_ops c = {.name = "third",
                             .bit = NO_BIT,
                             .required = yes,
                             .own = STAGE_CHECK,
                             .shadow = 1,
                             .on = ALL(.create = NULL)};
static const effect_ops d = {.name = "fourth",
                             .size = sizeof(own),
                             .bit = NO_BIT,
                             .required = yes,
                             .own = STAGE_BETWEEN,
                             .inside = 1,
                             .copy_as = COPY_IS_NEW,
                             .on = ALL(.create = create_d)};
static const effect_ops off = {
    .name = "off", .bit = 4, .on = ALL(.due = on_due)};
static const effect_ops out = {
    .name = "out", .bit = NO_BIT, .required = no, .on = ALL(.due = on_due)};
static const effect_ops bare = {.name = "bare",
                                .bit = NO_BIT,
                                .required = yes,
                                .own = STAGE_NONE,
                                .sums_up = 1,
                                .far = 1,
                                .strains = strains};
static const effect_ops *const table[] = {&a,   &off, &b, &bare,
                                          &out, &c,   &d, NULL};

static contact_problem posed = {.m = 7};
static double start_u = 1.0, start_force = 2.0;

static status call_restore(run *r) {
  effects_restore(r, &posed, &start_u, &start_force);
  return OK;
}

static status call_describe(run *r) {
  effects_describe(r, NULL);
  return OK;
}

static status call_show(run *r) {
  effects_show(r, NULL);
  return OK;
}

static status call_end(run *r) {
  effects_end(r);
  return OK;
}

static status call_forget(run *r) {
  effects_forget(r);
  return OK;
}

#define CALL(name, arguments) \
  static status call_##name(run *r) { return effects_##name arguments; }
CALL(attempt, (r, 2.5))
CALL(load, (r, 2.5))
CALL(pose, (r, 2.5))
CALL(examine, (r, 2.5))
CALL(make_step, (r, &(int){0}))
CALL(solve, (r, 2.5, &(int){0}))
CALL(found, (r, &(int){0}))
CALL(rewrite, (r, &posed, &(double *){&start_u}, &start_force))

/* As src/run/effect.h has it: DUE: of effects that are due; OWN: of those that
 * a copy of the run does not borrow, as are those of DUE; T: in their stage;
 * FAILS: an error ends it; MAKES: and one that has made it. */
enum { DUE = 1, OWN = 2, T = 4, FAILS = 8, MAKES = 16, SETS_UP = 32 };
static const struct {
  const char *name;
  status (*call)(run *r);
  int is;
} hooks[] = {{"check", effects_check, SETS_UP | FAILS},
             {"prepare", effects_prepare, SETS_UP | FAILS},
             {"describe", call_describe, 0},
             {"begin_step", effects_begin_step, T | FAILS},
             {"start", effects_start, T | FAILS},
             {"initial", effects_initial, DUE | OWN | T | FAILS},
             {"make_step", call_make_step, T | FAILS | MAKES},
             {"attempt", call_attempt, T | FAILS},
             {"solve", call_solve, T | FAILS | MAKES},
             {"load", call_load, T | FAILS},
             {"pose", call_pose, T | FAILS},
             {"rewrite", call_rewrite, DUE | OWN | T | FAILS},
             {"restore", call_restore, DUE | OWN},
             {"found", call_found, T | FAILS | MAKES},
             {"examine", call_examine, T | FAILS},
             {"estimate", effects_estimate, OWN | T | FAILS},
             {"accept", effects_accept, DUE | OWN | T | FAILS},
             {"show", call_show, DUE | OWN},
             {"end", call_end, 0},
             {"forget", call_forget, 0}};

/* Hook k calls those of the letters, in their order, and returns that. */
static void says(run *r, size_t k, const char *letters, status returns) {
  char want[200] = "";
  const int turned = strcmp(hooks[k].name, "restore") == 0;
  const size_t n = strlen(letters);
  for (size_t i = 0; i < n; ++i)
    snprintf(want + strlen(want), sizeof want - strlen(want), " %c.%s",
             letters[turned ? n - 1 - i : i], hooks[k].name);
  said[0] = '\0';
  const status st = hooks[k].call(r);
  ck_assert_str_eq(said, want);
  ck_assert_int_eq(st, returns);
}

static model words = {.effects = 1u << 5};

TEST(every_hook_is_called_in_order) {
  OWNED char *all = memory_new(0, 1);
  OWNS(all);
  run r = {.m = &words};
  failing = 0;
  ck_assert_int_eq(effects_create(&r, table), OK);
  ck_assert_int_eq(r.effects.n, 5);
  for (size_t k = 0; k < sizeof hooks / sizeof *hooks; ++k) {
    const int is = hooks[k].is;
    const long calls = timer_cost(STAGE_ZONES).calls;
    const long inner = timer_cost(STAGE_STRESS).calls;
    failing = making = 0;
    is_due = 1;
    says(&r, k, "ab-d", OK);
    ck_assert_int_eq(timer_cost(STAGE_ZONES).calls, calls + ((is & T) != 0));
    ck_assert_int_eq(timer_cost(STAGE_STRESS).calls,
                     inner + (is & (T | SETS_UP) ? 4 : 5));
    is_due = 0;
    says(&r, k, is & DUE ? "b-d" : "ab-d", OK);
    failing = 'b';
    is_due = 1;
    says(&r, k, is & FAILS ? "ab" : "ab-d", is & FAILS ? ERR_DECK : OK);
    failing = 0;
    making = 'a';
    says(&r, k, is & MAKES ? "a" : "ab-d", OK);
  }
  ck_assert_int_eq(timer_cost(STAGE_BETWEEN).calls, 0);
}

TEST(copy_borrows_what_accepts_nothing) {
  OWNED char *all = memory_new(0, 1);
  OWNS(all);
  run r = {.m = &words}, other;
  failing = 0;
  ck_assert_int_eq(effects_create(&r, table), OK);
  ((own *)effect_state(&r.effects, &d))->letter = 'x';
  other = r;
  failing = making = said[0] = '\0';
  ck_assert_int_eq(effects_copy(&r, &other), OK);
  ck_assert_str_eq(said, " B.copy d.create");
  is_due = 1;
  for (size_t k = 0; k < sizeof hooks / sizeof *hooks; ++k) {
    says(&r, k, "ab-x", OK);
    says(&other, k, hooks[k].is & OWN ? "Bd" : "aB-d", OK);
  }
  ck_assert_ptr_eq(effect_state(&other.effects, &a),
                   effect_state(&r.effects, &a));
  ck_assert_int_eq(((own *)effect_state(&other.effects, &b))[1].letter, 'y');
  ck_assert_ptr_null(effect_state(&r.effects, &off));
}

TEST(each_keeps_its_own_group) {
  OWNED char *all = memory_new(0, 1);
  OWNS(all);
  run r = {.m = &words};
  archive *file;
  ck_assert_int_eq(archive_new(&file), OK);
  failing = 0;
  ck_assert_int_eq(effects_create(&r, table), OK);
  failing = said[0] = '\0';
  ck_assert_int_eq(effects_keep(&r, file), OK);
  ck_assert_str_eq(said, " a.first/ b.second/ -.third/ d.fourth/");
  failing = 'b';
  ck_assert_int_eq(effects_keep(&r, file), ERR_DECK);
  archive_free(&file);
}

/* Memory was refused in its "create". */
TEST(nothing_is_forgotten_that_was_not_made) {
  static const effect_ops row = {.on = ALL(.create = create_a)};
  run r = {.effects = {1, {{.ops = &row}}}};
  said[0] = '\0';
  effects_forget(&r);
  ck_assert_str_eq(said, "");
}

TEST(rows_are_asked_for_what_they_say) {
  OWNED char *all = memory_new(0, 1);
  OWNS(all);
  run r = {.m = &words};
  failing = 0;
  ck_assert_int_eq(effects_create(&r, table), OK);
  ck_assert(effects_sum_up(&r));
  ck_assert_int_eq(effects_reach_far(&r), 1);
  ck_assert_int_eq(effects_strain(&r, 3), 1);
  ck_assert_int_eq(effects_strain(&r, 2), 0);
  r = (run){.m = &words};
  ck_assert_int_eq(effects_create(&r, (const effect_ops *[]){&a, NULL}), OK);
  ck_assert(!effects_sum_up(&r));
  ck_assert_int_eq(effects_reach_far(&r), 0);
  ck_assert_int_eq(effects_strain(&r, 3), 0);
}

UNIT_MAIN("effect")
