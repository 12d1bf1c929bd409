/*
 * The loop over steps and increments: grid of a fixed increment, its cutting
 * with exact rollback, outcome of each increment, outputs.
 */
#include "accuracy/verdict.h"
#include "base/interrupt.h"
#include "run/history/loop.h"
#include "run/setup/setup.h"
#include "run/visco.h"

enum { DEEPEST_CUT = 30 };

/* End of piece "part" of 2^level pieces of increment number i (from 0) of n;
 * computed from the ends of the step, so that no error adds up and the last
 * one is the end of the step itself. */
static double piece_end(const step *s, long n, long i, long part, int level) {
  double pieces = ldexp(1.0, level);
  double done = (double)i + (double)part / pieces;
  if (i == n - 1 && part == (long)pieces) return s->start + s->total;
  if (i < n - 1) return s->start + done * s->dt;
  /* The last increment is what is left of the step. */
  double left = s->total - (double)(n - 1) * s->dt;
  return s->start + (double)(n - 1) * s->dt + (double)part / pieces * left;
}

static long increments_of(const step *s) {
  double n = s->total / s->dt;
  long whole = (long)floor(n + 0.5);
  /* A step that is a multiple of dt up to rounding has no sliver at the end. */
  if (whole >= 1 && fabs(n - (double)whole) <= 1e-9 * n) return whole;
  return (long)ceil(n);
}

/* 1: converged to its tolerance, is not in doubt and violates no theorem. */
static int is_settled(const run *r) {
  return r->solving.report.outcome > 0 && !r->course.missed &&
         !r->at.violated &&
         !error_bound_doubts(&r->errors.error, share_of_step(r));
}

int run_remembers(const run *r) {
  const int kind = r->step->kind;
  const int slips = r->nodes.n > 0 && r->problem.ut0 != NULL;
  if (kind == STEP_VISCO) return slips || r->strains.visco != NULL;
  return slips && kind == STEP_QUASISTATIC;
}

/* 1: inelastic strains are those of a step before, which this one holds. */
static int holds_strains(const run *r) {
  for (int i = 0; i < run_step_id(r) && r->strains.visco != NULL; ++i)
    if (r->m->steps[i].kind == STEP_VISCO) return 1;
  return 0;
}

int run_inherits(const run *r) {
  return run_remembers(r) || holds_strains(r) || effects_sum_up(r);
}

/* 1: the start state of this increment contains one that did not converge. */
static int is_after_miss(const run *r) {
  return r->course.unsettled > 0 && run_inherits(r);
}

/* View of r->now for the outputs. */
static state loop_state(run *r, int attempt, int increment_no) {
  const equilibrium *e = &r->now;
  const derived *d = &r->result;
  /* clang-format off */
  state s = {
      .step_no = run_step_id(r) + 1, .increment_no = increment_no,
      .total_no = r->course.total_no, .attempt = attempt,
      .t = e->t, .dt = e->t - r->old.t, .energy = e->energy,
      .body = {.u = e->u, .strain = d->strain, .stress = d->stress,
               .temperature = e->temperature, .reaction = e->reaction},
      .contacts = {.problem = r->nodes.n > 0 ? &r->problem.cp : NULL,
                   .surface = r->surface, .uc = e->uc, .rc = e->rc,
                   .gap = d->open_gap, .slip = d->slip, .limit = d->g,
                   .contact = d->contact, .totals = d->totals,
                   .distance = d->distance, .torque = d->torque},
      .effects = &r->effects, .report = r->solving.report,
      .note = r->course.note, .solver_log = contact_solver_log(r->solver),
      .settled = is_settled(r), .again = r,
      .errors = {.error = r->errors.error, .rounding = r->errors.rounding,
                 .mesh_error = r->errors.mesh_error,
                 .time_error = r->errors.time_error,
                 .elem_error =
                     r->errors.mesh_error.asked ? r->errors.elem_error : NULL,
                 .in_doubt =
                     error_bound_doubts(&r->errors.error, share_of_step(r)),
                 .after_miss = is_after_miss(r)}};
  /* clang-format on */
  if (r->strains.visco != NULL) visco_show(r, &s);
  if (!(r->m->effects & EFFECT_STRESS)) s.body.stress = NULL;
  if (!(r->m->effects & EFFECT_REACTION)) s.body.reaction = NULL;
  for (int i = 0; i < r->nodes.n; ++i) {
    s.contacts.n_open += r->result.contact[i] == CONTACT_OPEN;
    s.contacts.n_slip += r->result.contact[i] == CONTACT_SLIP;
    s.contacts.n_stick += r->result.contact[i] == CONTACT_STICK;
  }
  return s;
}

int table_is_due(const step *s, int tables, double t, int increment_no,
                 int last) {
  for (int i = 0; i < s->print.n; ++i)
    if ((s->print.requests[i].table & tables) &&
        print_shows(&s->print.requests[i], s, t, increment_no, last))
      return 1;
  return 0;
}

int table_is_due_now(const run *r, int tables) {
  const int within = r->course.shadow;
  return table_is_due(r->step, tables, r->now.t,
                      within ? -1 : r->at.increment_no,
                      within ? 0 : r->at.last);
}

/* ---- tables at time points that no increment ends at -------------------- */

/* The first time point of a table after "after" within the increment. */
static double next_point(const run *r, double after) {
  double next = HUGE_VAL;
  for (int i = 0; i < r->step->print.n; ++i)
    next = fmin(next, print_next(&r->step->print.requests[i], r->step, after,
                                 r->now.t));
  return next;
}

static status show_within(run *r, double t, int increment_no) {
  ENDS_BY(shadow_leave) shadow *b = NULL;
  PASS(shadow_at(r, t, &b));
  run *own = shadow_run(b);
  if (table_is_due(own->step, PRINT_ELEMENTS, t, -1, 0))
    PASS(estimate_within(own));
  PASS(effects_accept(own));
  if (own->solving.report.outcome <= 0) ++r->course.unsettled;
  state s = loop_state(own, 1, increment_no);
  s.within = 1;
  effects_show(own, &s);
  return r->sink->between(r->sink->ctx, &s);
}

static status dense_show(run *r, int increment_no) {
  double t = next_point(r, r->old.t);
  if (r->sink->between == NULL || r->step->kind == STEP_STATIC) return OK;
  for (; isfinite(t); t = next_point(r, t))
    PASS(show_within(r, t, increment_no));
  return OK;
}

/* ---- an increment is accepted or rejected -------------------------------- */

/* 1 if some output needs the stresses of this increment. */
static int stress_is_due(const step *s, double t, int increment_no, int last) {
  if (frequency_shows(s->output.frequency, increment_no, last)) return 1;
  return table_is_due(s, ~0, t, increment_no, last);
}

static verdict_scene scene_of(run *r) {
  return (verdict_scene){.m = r->m,
                         .msh = r->msh,
                         .step = r->step,
                         .t = r->now.t,
                         .surface = r->surface,
                         .cp = &r->problem.cp,
                         .given = r->problem.given,
                         .u = run_rows(r, 0, r->now.uc),
                         .r = run_rows(r, 1, r->now.rc),
                         .c = r->c};
}

/* What moves, once a run: neither an equilibrium nor a proof was found. */
static status tell_motion(run *r) {
  char why[1024] = "";
  if (r->course.unsolved > 0 || !r->problem.cp.floating) return OK;
  const verdict_scene scene = scene_of(r);
  PASS(verdict_motion(&scene, why, sizeof why));
  if (why[0] != '\0')
    message_add(r->m->log, P4040, &r->step->at,
                "step %d, increment %d, time %g: no equilibrium found: %s; the "
                "last equilibrium is that of time %g",
                run_step_id(r) + 1, r->at.increment_no, r->now.t, why,
                r->old.t);
  return OK;
}

/* Where an accepted increment did not converge to its tolerance. */
static status note_misfit(run *r) {
  char text[400] = "";
  if (r->solving.report.outcome > 0) return OK;
  visco_warn_stuck(r);
  if (r->nodes.n == 0) return OK;
  PASS(verdict_misfit(&r->problem.cp, r->surface, run_rows(r, 0, r->now.uc),
                      run_rows(r, 1, r->now.rc), text, sizeof text));
  if (text[0] != '\0') RUN_NOTE(r, "  %s\n", text);
  return tell_motion(r);
}

/* Where nodes were added in the increment. */
static void note_nodes(run *r) {
  const int now = active_count(&r->nodes.active, r->nodes.n);
  if (r->nodes.n == 0 || now == r->nodes.n_reported) return;
  RUN_NOTE(r,
           "  inactive contact nodes touch: solved again with %d node%s, "
           "not %d, of %d\n",
           now, now == 1 ? "" : "s", r->nodes.n_reported, r->nodes.n);
  r->nodes.n_reported = now;
}

/* The energies have the squares of all that is in the state. */
static status check_finite(const run *r) {
  const energies *e = &r->now.energy;
  const double u = largest_entry(r->n_dof, r->now.u);
  const double rc = largest_entry(r->nodes.n_c, r->now.rc);
  if (isfinite(e->strain) && isfinite(e->external + e->defect) &&
      isfinite(u * u) && isfinite(rc * rc))
    return OK;
  RAISE(
      ERR_SINGULAR,
      "step %d, time %g: the energies of displacements of %.3g leave the range "
      "of the numbers; use other units or smaller loads; the last state "
      "written is that of time %g",
      run_step_id(r) + 1, r->now.t, u, r->old.t);
}

enum { IN_A_ROW = 100 };
static const double MOST_INCREMENTS = 1e8; /* as of a deck (P2020) */

/* Increments that do not settle do not go on for ever. */
static status check_progress(const run *r) {
  const double end = r->step->start + r->step->total;
  const double dt = r->now.t - r->old.t, n = (end - r->now.t) / dt;
  if (r->course.in_a_row < IN_A_ROW || !(n > MOST_INCREMENTS)) return OK;
  RAISE(ERR_SINGULAR,
        "step %d, time %g: %d increments in a row are not settled, and there "
        "are %.2g more of %.3g to the end of the step; a larger dt_min ends "
        "sooner, smaller loads or rates may settle",
        run_step_id(r) + 1, r->now.t, r->course.in_a_row, n, dt);
}

status loop_accept(run *r, int attempt, int increment_no, int last,
                   double cpu) {
  PASS(dense_show(r, increment_no));
  ++r->course.total_no;
  /* The systems of an increment, unless a method did not tell its own. */
  if (!r->solving.seen.untold) {
    if (r->solving.seen.increments++ == 0)
      r->solving.seen.first = r->solving.seen.now;
    else
      r->solving.seen.later += r->solving.seen.now;
  }
  r->solving.seen.now = r->solving.seen.untold = 0;
  r->at.last = last;
  r->errors.astray = r->course.unsolved > 0 && run_inherits(r);
  PASS(
      result_evaluate(r, stress_is_due(r->step, r->now.t, increment_no, last)));
  PASS(check_finite(r));
  PASS(estimate_increment(r));
  PASS(check_finite(r));
  r->at.violated = 0;
  note_nodes(r);
  PASS(effects_accept(r));
  PASS(note_misfit(r));
  state s = loop_state(r, attempt, increment_no);
  r->course.unsettled += !s.settled;
  r->course.unsolved += r->solving.report.outcome <= 0;
  r->course.in_a_row = s.settled ? 0 : r->course.in_a_row + 1;
  s.end_of_step = last;
  s.cpu = timer_cpu() - cpu;
  effects_show(r, &s);
  if (r->sink->increment != NULL) PASS(r->sink->increment(r->sink->ctx, &s));
  PASS(check_progress(r));
  PASS(result_accept(r));
  r->course.due =
      frequency_shows(r->step->restart.frequency, increment_no, last);
  return OK;
}

int loop_cut_helps(const run *r) {
  const outcome o = r->solving.report.outcome;
  if (o == STOPPED_STAGNATION && r->course.in_a_row > 0) return 0;
  if (o == STOPPED_STAGNATION && r->at.attempt > 1)
    return r->solving.report.residual < r->at.residual;
  return o != STOPPED_UNFIT;
}

status loop_reject(run *r, int attempt, int increment_no, const char *why) {
  r->at.residual = r->solving.report.residual;
  r->errors.error = (error_bound){0};
  r->errors.rounding = (rounding_loss){0};
  r->errors.mesh_error.asked = r->errors.time_error.asked = 0;
  r->at.violated = 0;
  state s = loop_state(r, attempt, increment_no);
  s.contacts.n_open = s.contacts.n_slip = s.contacts.n_stick = 0;
  if (r->sink->rejected == NULL) return OK;
  return r->sink->rejected(r->sink->ctx, &s, why);
}

status loop_no_equilibrium(run *r) {
  char why[1024] = "";
  const outcome o = r->solving.report.outcome;
  const char *tried = contact_solver_log(r->solver);
  const char *const by = tried[0] == '\0' ? "" : "tried ";
  const verdict_scene scene = scene_of(r);
  if (o == STOPPED_UNFIT)
    RAISE(ERR_SINGULAR,
          "step %d, time %g: the method cannot treat this problem: %s; use "
          "METHOD=AUTO, NEWTON, AUGLAG or SOR",
          run_step_id(r) + 1, r->now.t, tried);
  PASS(verdict_text(&scene, why, sizeof why));
  if (tried[0] == '\0' && (why[0] == '\0' || o != STOPPED_RAY))
    tried = outcome_text(o);
  RAISE(ERR_SINGULAR,
        "step %d, time %g: no equilibrium found: %s%s%s%s; the last state "
        "written is that of time %g",
        run_step_id(r) + 1, r->now.t, why,
        why[0] == '\0' || tried[0] == '\0' ? "" : "; ", by, tried, r->old.t);
}

/* ---- before the increments of a step: effects, sudden loads of *VISCO ---- */

/* 1 if a is b to rounding. */
static int same_vector(size_t n, const double *a, const double *b) {
  double largest = 0.0, worst = 0.0;
  for (size_t i = 0; i < n; ++i) {
    largest = fmax(largest, fmax(fabs(a[i]), fabs(b[i])));
    worst = fmax(worst, fabs(a[i] - b[i]));
  }
  return worst <= 1e-12 * largest;
}

/* 1 if a contact that no given force presses has moved the body by no more than
 * the rounding of the coordinates, which its gaps have. */
static int touched_by_rounding(const run *r) {
  const double least = rounding_of_gaps(r);
  for (int i = 0; i < r->m->n.contact; ++i)
    if (r->m->contacts[i].force.given) return 0;
  for (size_t i = 0; i < r->n_dof; ++i)
    if (fabs(r->now.u[i] - r->old.u[i]) > least) return 0;
  return 1;
}

/* 1: temperatures of laws, moduli or strains jump at the start of the step. */
static int starts_hotter(const run *r) {
  return r->now.temperature != NULL &&
         !same_vector(r->msh->n_elem, r->now.temperature, r->old.temperature);
}

/* 1: temperatures jump, or supports, loads or friction end: at once, whether
 * the body moves or not, or would with effects that are left out. */
static int starts_again(const run *r) {
  const int ends = r->step->renewed != 0 || r->step->friction.n > 0;
  return starts_hotter(r) || (ends && run_step_id(r) > 0);
}

/* A held slave follows its masters up to their rounding. */
int loop_starts_smoothly(const run *r) {
  if (starts_again(r)) return 0;
  const double moved = largest_entry(r->n_dof, r->old.u);
  for (size_t i = 0; i < r->n_dof; ++i)
    if (r->body.fixed[i] && fabs(r->loads.ud[i] - r->old.u[i]) >
                                1e-12 * fmax(moved, fabs(r->loads.ud[i])))
      return 0;
  return same_vector(r->n_dof, r->now.F, r->old.F) &&
         same_vector(strains_kept(r), r->now.e0, r->old.e0);
}

/* 1: a law flows, or would without *EFFECTS. */
static int has_law(const run *r) {
  int any = r->strains.visco != NULL;
  for (int i = 0; i < r->m->n.material; ++i)
    any |= r->m->materials[i].law_aside != NULL;
  return any;
}

/*
 * The body responds at once to what is applied suddenly at the start of a
 * *VISCO step: an increment without length of its own.
 */
static status start_visco(run *r, int *increment_no) {
  double cpu = timer_cpu();
  if (r->step->kind != STEP_VISCO) return OK;
  if (!has_law(r)) return OK;
  PASS(increment_begin(r, r->step->start));
  int smooth = loop_starts_smoothly(r);
  if (!smooth || (r->course.total_no == 0 && r->nodes.n > 0)) {
    PASS(increment_solve(r, r->step->start));
    if (outcome_is_fatal(r->solving.report.outcome))
      PASS(loop_no_equilibrium(r));
    const int moved = !same_vector(r->n_dof, r->now.u, r->old.u) &&
                      !(r->nodes.n > 0 && touched_by_rounding(r));
    if (moved || starts_again(r))
      PASS(loop_accept(r, 1, ++*increment_no, 0, cpu));
  }
  return visco_begin_step(r);
}

/* ---- between two attempts ------------------------------------------------ */

static status checkpoint(run *r) {
  int planned = r->course.due; /* others are no stage of the continued run */
  r->course.due = 0;
  if (r->sink->checkpoint == NULL) return OK;
  TIMED(planned ? STAGE_RESTART : STAGE_NONE);
  return r->sink->checkpoint(r->sink->ctx, r);
}

static status stop(run *r, status why) {
  const progress *p = &r->at;
  const char *by = interrupt_name();
  const char *on =
      r->sink->checkpoint != NULL ? "; protis --restart goes on" : "";
  if (r->course.total_no == 0)
    RAISE(why, "interrupted by %s before the first increment", by);
  if (!r->course.kept) PASS(checkpoint(r));
  if (p->increment_no == 0)
    RAISE(why, "interrupted by %s before step %d, at time %g%s", by,
          p->step_id + 1, r->old.t, on);
  RAISE(why, "interrupted by %s after step %d, increment %d, time %g%s", by,
        p->step_id + 1, p->increment_no, r->old.t, on);
}

/* The checkpoint that is due between two attempts; ends the run on request. */
status loop_pause(run *r) {
  const status why = interrupt_asked();
  r->course.kept = r->course.due;
  if (r->course.due) PASS(checkpoint(r));
  return why != OK ? stop(r, why) : OK;
}

/* ---- increments ---------------------------------------------------------- */

status loop_solve_once(run *r, double t) {
  return r->step->kind == STEP_VISCO ? visco_advance(r, t)
                                     : increment_solve(r, t);
}

status loop_solve(run *r, double t) {
  int made = 0;
  r->errors.evaluated = 0;
  PASS(effects_solve(r, t, &made));
  return made ? OK : loop_solve_once(r, t);
}

/* 1 if an attempt without equilibrium is repeated in halves. */
static int can_cut(const run *r) {
  const step *s = r->step;
  int level = r->at.level + 1;
  return s->kind != STEP_STATIC && level <= DEEPEST_CUT &&
         ldexp(s->dt, -level) >= s->dt_min &&
         r->solving.report.outcome != STOPPED_STAGNATION &&
         r->solving.report.outcome != STOPPED_UNFIT;
}

/* The next piece of n increments was accepted. */
static status accept_piece(run *r, long n, double cpu) {
  progress *p = &r->at;
  int attempt = p->attempt, end = p->part + 1 == 1L << p->level;
  int last = p->i == n - 1 && end;
  ++p->part;
  ++p->increment_no;
  p->attempt = 1;
  if (end) {
    ++p->i;
    p->part = p->level = p->cut = 0;
  }
  return loop_accept(r, attempt, p->increment_no, last, cpu);
}

/* End of the next piece of n increments: the longest that starts here and is
 * stable. */
static status choose_piece(run *r, long n, double *t) {
  progress *p = &r->at;
  int deeper;
  while (p->level > p->cut && p->part % 2 == 0) {
    p->part /= 2;
    --p->level;
  }
  *t = piece_end(r->step, n, p->i, p->part + 1, p->level);
  PASS(visco_level(r, *t - r->old.t, &deeper));
  p->part <<= deeper;
  p->level += deeper;
  *t = piece_end(r->step, n, p->i, p->part + 1, p->level);
  return OK;
}

/* One attempt at the next piece of n increments: accepted, or cut into
 * halves. */
static status attempt_piece(run *r, long n) {
  progress *p = &r->at;
  double cpu = timer_cpu(), t;
  PASS(choose_piece(r, n, &t));
  PASS(effects_attempt(r, t));
  PASS(loop_solve(r, t));
  int settled = r->solving.report.outcome > 0;
  int unstable = r->solving.report.outcome == STOPPED_UNSTABLE;
  int finer = unstable || (!settled && can_cut(r));
  if (finer || (!settled && outcome_is_fatal(r->solving.report.outcome)))
    PASS(loop_reject(r, p->attempt, p->increment_no + 1,
                     outcome_text(r->solving.report.outcome)));
  if (finer) {
    ++p->attempt;
    if (unstable) return OK; /* choose_piece cuts */
    p->part *= 2;
    p->cut = ++p->level;
    return OK;
  }
  if (!settled && outcome_is_fatal(r->solving.report.outcome))
    PASS(loop_no_equilibrium(r));
  PASS(effects_examine(r, t));
  return accept_piece(r, n, cpu);
}

static status run_fixed(run *r) {
  long n = increments_of(r->step);
  while (r->at.i < n) {
    PASS(loop_pause(r));
    PASS(attempt_piece(r, n));
  }
  return OK;
}

static status run_step(run *r) {
  int made = 0;
  PASS(run_prepare(r));
  if (r->course.from != NULL) {
    PASS(run_keep(r, r->course.from));
    r->course.from = NULL;
  } else {
    r->at =
        (progress){.step_id = run_step_id(r), .attempt = 1, .dt = r->step->dt};
    visco_rest(r);
    PASS(effects_start(r));
    PASS(start_visco(r, &r->at.increment_no));
  }
  PASS(effects_make_step(r, &made));
  if (!made) PASS(run_fixed(r));
  if (r->course.due) PASS(checkpoint(r));
  return OK;
}

/* The step in progress. */
static status read_progress(run *r) {
  if (r->course.from == NULL) return OK;
  IN_GROUP(r->course.from, "run");
  PASS(archive_bytes(r->course.from, "at", &r->at, sizeof r->at));
  if (r->at.step_id < 0 || r->at.step_id >= r->m->n.step)
    RAISE(ERR_FILE, "the restart file is of a deck with other steps");
  return OK;
}

status history_continue(const model *m, const mesh *msh,
                        const effect_ops *const *effects, archive *from,
                        const history_sink *sink, int *unsettled) {
  status st = OK;
  run r = {.m = m, .msh = msh, .sink = sink, .course.from = from};
  *unsettled = 0;
  TRY(history_check(m, msh, effects));
  TRY(run_new(&r, effects));
  TRY(read_progress(&r));
  for (int i = r.at.step_id; i < m->n.step; ++i) {
    r.step = &m->steps[i];
    TRY(run_step(&r));
  }
  effects_end(&r);
done:
  *unsettled = r.course.unsettled;
  run_free(&r);
  return st;
}

status history_run(const model *m, const mesh *msh,
                   const effect_ops *const *effects, const history_sink *sink,
                   int *unsettled) {
  return history_continue(m, msh, effects, NULL, sink, unsettled);
}

status history_stiffness(const model *m, const mesh *msh,
                         const effect_ops *const *effects,
                         stiffness_choice *choice) {
  static const history_sink nobody;
  ENDS_BY(run_free)
  run r = {.m = m, .msh = msh, .sink = &nobody, .step = &m->steps[0]};
  *choice = (stiffness_choice){0};
  PASS(run_new(&r, effects));
  load_fixed(msh, r.step, r.body.fixed);
  PASS(run_build_ties(&r));
  if (m->effects & EFFECT_CONTACT) PASS(run_build_surface(&r));
  r.body.d.surface = r.surface;
  PASS(run_choose_stiffness(&r));
  *choice = r.body.choice;
  return OK;
}

status history_motions(const model *m, const mesh *msh,
                       const effect_ops *const *effects, int step_id, int *n,
                       free_motion **list) {
  static const history_sink nobody;
  ENDS_BY(run_free)
  run r = {.m = m, .msh = msh, .sink = &nobody, .step = &m->steps[step_id]};
  PASS(run_new(&r, effects));
  return run_motions(&r, n, list);
}
