/*
 * The loop over steps and increments: time grid, step cutting with exact
 * rollback, verdict of each increment, hand-over to the outputs.
 */
#include "accuracy/verdict.h"
#include "history/run.h"

#include "base/interrupt.h"
#include "base/memory.h"
#include "base/timer.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

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

/* 1: reached its tolerance and violates no theorem. */
static int is_settled(const run *r) {
  return r->report.outcome > 0 && !r->missed && !r->theorems.violated;
}

/* What the outputs see of an increment. */
static state make_state(run *r, int attempt, int increment_no) {
  const equilibrium *e = &r->now;
  state s = {.step_no = run_step_id(r) + 1,
             .increment_no = increment_no,
             .total_no = r->total_no,
             .attempt = attempt,
             .t = e->t,
             .dt = e->t - r->old.t,
             .u = e->u,
             .strain = r->strain,
             .stress = r->stress,
             .temperature = e->temperature,
             .reaction = e->reaction,
             .problem = r->n > 0 ? &r->cp : NULL,
             .surface = r->surface,
             .uc = e->uc,
             .rc = e->rc,
             .gap = r->open_gap,
             .slip = r->slip,
             .limit = r->g,
             .contact = r->contact,
             .totals = r->totals,
             .distance = r->distance,
             .torque = r->torque,
             .loops = r->loops,
             .n_zone = r->n_zone,
             .zones = r->zones,
             .energy = e->energy,
             .report = r->report,
             .note = r->note,
             .error = r->error,
             .jumps = r->jumps,
             .jump_t = r->jump_t,
             .theory = r->theorems,
             .solutions = r->step->check != CHECK_NONE ? &r->solutions : NULL,
             .mesh_error = r->mesh_error,
             .time_error = r->time_error,
             .elem_error = r->mesh_error.asked ? r->elem_error : NULL,
             .solver_log = contact_solver_log(r->solver),
             .settled = is_settled(r)};
  if (r->visco != NULL) visco_show(r, &s);
  if (!(r->m->effects & EFFECT_STRESS)) s.stress = NULL;
  if (!(r->m->effects & EFFECT_REACTION)) s.reaction = NULL;
  for (int i = 0; i < r->n; ++i) {
    s.n_open += r->contact[i] == CONTACT_OPEN;
    s.n_slip += r->contact[i] == CONTACT_SLIP;
    s.n_stick += r->contact[i] == CONTACT_STICK;
  }
  return s;
}

static int is_due(int frequency, int increment_no, int last) {
  return last || (frequency > 0 && increment_no % frequency == 0);
}

/* 1 if one of these tables (bits PRINT_*) shows this increment. */
static int table_is_due(const step *s, int tables, int increment_no, int last) {
  for (int i = 0; i < s->n_print; ++i)
    if ((s->prints[i].table & tables) &&
        is_due(s->prints[i].frequency, increment_no, last))
      return 1;
  return 0;
}

/* 1 if some output wants the stresses of this increment. */
static int stress_is_due(const step *s, int increment_no, int last) {
  int f = s->output_frequency;
  if (f >= 0 && is_due(f, increment_no, last)) return 1;
  return table_is_due(s, ~0, increment_no, last);
}

/* Where an increment that is taken missed its tolerance. */
static status note_misfit(run *r) {
  status st = OK;
  char text[400];
  size_t used = strlen(r->note);
  if (r->n == 0 || r->report.outcome > 0) goto done;
  TRY(verdict_misfit(&r->cp, r->surface, r->now.uc, r->now.rc, text,
                     sizeof text));
  if (text[0] != '\0')
    snprintf(r->note + used, sizeof r->note - used, "  %s\n", text);
done:
  return st;
}

static status accept(run *r, int attempt, int increment_no, int last,
                     double cpu) {
  status st = OK;
  ++r->total_no;
  TRY(theory_increment(r));
  if (!is_settled(r)) ++r->unsettled;
  TRY(result_evaluate(r, stress_is_due(r->step, increment_no, last)));
  TRY(estimate_increment(r));
  r->n_zone = 0;
  if (table_is_due(r->step, PRINT_ZONES, increment_no, last))
    TRY(zones_find(r));
  TRY(check_increment(r));
  TRY(note_misfit(r));
  path_compare(r);
  state s = make_state(r, attempt, increment_no);
  s.end_of_step = last;
  s.cpu = timer_cpu() - cpu;
  if (r->sink->increment != NULL) TRY(r->sink->increment(r->sink->ctx, &s));
  result_accept(r);
  r->due = r->step->restart_frequency >= 0 &&
           is_due(r->step->restart_frequency, increment_no, last);
done:
  return st;
}

static status reject(run *r, int attempt, int increment_no, const char *why) {
  r->error = (error_bound){0};
  r->mesh_error.asked = r->time_error.asked = 0;
  r->theorems = (theory_report){0};
  r->jumps = 0;
  state s = make_state(r, attempt, increment_no);
  s.n_open = s.n_slip = s.n_stick = 0;
  if (r->sink->rejected == NULL) return OK;
  return r->sink->rejected(r->sink->ctx, &s, why);
}

static status no_equilibrium(run *r) {
  status st = OK;
  char why[1024] = "";
  const char *tried = contact_solver_log(r->solver);
  int bracket = tried[0] != '\0';
  verdict_scene scene = {r->m,   r->msh,    r->step,   r->now.t, r->surface,
                         &r->cp, r->now.uc, r->now.rc, r->c};
  if (r->report.outcome == STOPPED_UNFIT)
    FAIL(ERR_SINGULAR,
         "step %d, time %g: the method cannot treat this problem: %s; use "
         "METHOD=AUTO, NEWTON, AUGLAG or SOR",
         run_step_id(r) + 1, r->now.t, contact_solver_log(r->solver));
  TRY(verdict_text(&scene, why, sizeof why));
  FAIL(ERR_SINGULAR,
       "step %d, time %g: no equilibrium found: %s%s%s%s%s%s; the last state "
       "written is that of time %g",
       run_step_id(r) + 1, r->now.t, outcome_text(r->report.outcome),
       bracket ? " (" : "", tried, bracket ? ")" : "",
       why[0] == '\0' ? "" : "; ", why, r->old.t);
done:
  return st;
}

/* ---- between two attempts ------------------------------------------------ */

static status keep_all(void *run_, archive *a) { return run_keep(run_, a); }

static status checkpoint(run *r) {
  status st = OK;
  const run_memory memory = {r, keep_all, r->at.step_id + 1};
  int planned = r->due; /* others are no stage of the run that goes on        */
  r->due = 0;
  if (r->sink->checkpoint == NULL) return OK;
  if (planned) timer_enter(STAGE_RESTART);
  st = r->sink->checkpoint(r->sink->ctx, &memory);
  if (planned) timer_leave(STAGE_RESTART);
  return st;
}

static status stop(run *r, status why) {
  status st = OK;
  const progress *p = &r->at;
  const char *by = interrupt_name();
  const char *on =
      r->sink->checkpoint != NULL ? "; protis --restart goes on" : "";
  if (r->total_no == 0)
    FAIL(why, "interrupted by %s before the first increment", by);
  if (!r->kept) TRY(checkpoint(r));
  if (p->increment_no == 0)
    FAIL(why, "interrupted by %s before step %d, at time %g%s", by,
         p->step_id + 1, r->old.t, on);
  FAIL(why, "interrupted by %s after step %d, increment %d, time %g%s", by,
       p->step_id + 1, p->increment_no, r->old.t, on);
done:
  return st;
}

/* What is due where the run could go on from; ends it if that was asked for. */
static status pause(run *r) {
  status st = OK, why = interrupt_asked();
  r->kept = r->due;
  if (r->due) TRY(checkpoint(r));
  if (why != OK) TRY(stop(r, why));
done:
  return st;
}

/* ---- increments ---------------------------------------------------------- */

/* 1 if an attempt that found no equilibrium is made again in halves. */
static int can_cut(const run *r) {
  const step *s = r->step;
  int level = r->at.level + 1;
  return s->kind != STEP_STATIC && level <= DEEPEST_CUT &&
         ldexp(s->dt, -level) >= s->dt_min &&
         r->report.outcome != STOPPED_STAGNATION &&
         r->report.outcome != STOPPED_UNFIT;
}

/* The next piece of n increments has been taken. */
static status accept_piece(run *r, long n, double cpu) {
  status st = OK;
  progress *p = &r->at;
  int attempt = p->attempt, end = p->part + 1 == 1L << p->level;
  int last = p->i == n - 1 && end;
  ++p->part;
  ++p->increment_no;
  p->attempt = 1;
  if (end) {
    ++p->i;
    p->part = p->level = 0;
  }
  TRY(accept(r, attempt, p->increment_no, last, cpu));
done:
  return st;
}

/* One attempt at the next piece of n increments: taken, or cut into halves. */
static status attempt_piece(run *r, long n) {
  status st = OK;
  const step *s = r->step;
  progress *p = &r->at;
  double cpu = timer_cpu(), t = piece_end(s, n, p->i, p->part + 1, p->level);
  int deeper;
  TRY(visco_level(r, t - r->old.t, &deeper));
  if (deeper > 0) {
    p->part <<= deeper;
    p->level += deeper;
    goto done;
  }
  TRY(path_try(r, t));
  TRY(s->kind == STEP_VISCO ? visco_advance(r, t) : increment_solve(r, t));
  int settled = r->report.outcome > 0, finer = !settled && can_cut(r);
  if (finer || (!settled && outcome_is_fatal(r->report.outcome)))
    TRY(reject(r, p->attempt, p->increment_no + 1,
               outcome_text(r->report.outcome)));
  if (finer) {
    p->part *= 2;
    ++p->level;
    ++p->attempt;
    goto done;
  }
  if (!settled && outcome_is_fatal(r->report.outcome)) TRY(no_equilibrium(r));
  r->jumps = 0;
  if (settled) TRY(jump_check(r, t));
  TRY(accept_piece(r, n, cpu));
done:
  return st;
}

static status run_fixed(run *r) {
  status st = OK;
  long n = increments_of(r->step);
  while (r->at.i < n) {
    TRY(pause(r));
    TRY(attempt_piece(r, n));
  }
done:
  return st;
}

/* ---- initial state ------------------------------------------------------ */

/* K u_0 - F into R, the largest of both into *largest; diagonal of K. */
static status start_forces(run *r, double *R, double *diagonal,
                           double *largest) {
  status st = OK;
  double *sigma = NULL;
  NEW(sigma, (size_t)r->m->ns * (size_t)r->msh->n_elem);
  domain_stress(&r->d, r->old.u, NULL, sigma);
  domain_internal_force(&r->d, sigma, R);
  for (size_t k = 0; k < r->n_dof; ++k) {
    *largest = fmax(*largest, fmax(fabs(R[k]), fabs(r->now.F[k])));
    R[k] -= r->now.F[k];
  }
  start_stiffness(&r->d, diagonal);
done:
  memory_free(sigma);
  return st;
}

/* The start is the old equilibrium of the first increment. */
static void accept_start(run *r) {
  memcpy(r->old.F, r->now.F, r->n_dof * sizeof *r->old.F);
  result_start(r, &r->old);
}

static status relax_start(run *r) {
  status st = OK;
  double cpu = timer_cpu();
  r->relaxing = 1;
  TRY(increment_solve(r, 0.0));
  if (r->report.outcome <= 0 && outcome_is_fatal(r->report.outcome)) {
    TRY(reject(r, 1, 0, outcome_text(r->report.outcome)));
    TRY(no_equilibrium(r));
  }
  TRY(accept(r, 1, 0, 0, cpu));
  memcpy(r->start, r->old.u, r->n_dof * sizeof *r->start);
done:
  r->relaxing = 0;
  return st;
}

static status judge_start(run *r) {
  status st = OK;
  const start_card *asked = &r->m->start;
  start_report *s = &r->first;
  s->relaxed = s->n_bad > 0 && asked->relax;
  if (r->sink->start != NULL) TRY(r->sink->start(r->sink->ctx, s));
  if (s->n_bad > 0 && !s->relaxed) {
    message_add(r->m->log, P4014, &asked->at,
                "the start is not compatible: defect %.3g (%.2g of the largest "
                "force) at node %zu, %s; %d node%s above %.0e",
                s->worst, s->ratio, r->msh->node_no[s->node_id],
                defect_text(s->kind[s->node_id]), s->n_bad,
                s->n_bad == 1 ? "" : "s", start_tolerance);
    FAIL(ERR_DECK, "the initial displacements are not compatible");
  }
  if (s->relaxed)
    TRY(relax_start(r));
  else
    accept_start(r);
done:
  return st;
}

/* Test the initial displacements against the loads of time 0. */
static status test_start(run *r) {
  status st = OK;
  double *R = NULL, *diagonal = NULL, *given = NULL, largest = 0.0;
  timer_enter(STAGE_START);
  NEW(R, r->n_dof);
  NEW(diagonal, r->n_dof);
  NEW(given, r->n);
  TRY(increment_pose(r, 0.0));
  TRY(start_forces(r, R, diagonal, &largest));
  if (r->n > 0) TRY(forms_given(r, 0.0, given));
  const start_input in = {.mesh = r->msh,
                          .fixed = r->fixed,
                          .u = r->old.u,
                          .ud = r->ud,
                          .R = R,
                          .stiffness = diagonal,
                          .surface = r->n > 0 ? r->surface : NULL,
                          .cp = &r->cp,
                          .uc = r->old.uc,
                          .given = given,
                          .load = largest};
  start_test(&in, r->old.rc, r->old.reaction, &r->first);
  TRY(theory_initial(r));
done:
  timer_leave(STAGE_START);
  memory_free(R);
  memory_free(diagonal);
  memory_free(given);
  return st;
}

status run_read_start(run *r) {
  status st = OK;
  if (!(r->m->effects & EFFECT_START)) goto done;
  timer_enter(STAGE_START);
  st = start_report_new(r->msh, &r->first);
  if (st == OK) st = start_displacements(r->m, r->msh, r->old.u, &r->first);
  timer_leave(STAGE_START);
done:
  return st;
}

/* 1 if a is b to rounding. */
static int same_vector(size_t n, const double *a, const double *b) {
  double largest = 0.0, worst = 0.0;
  for (size_t i = 0; i < n; ++i) {
    largest = fmax(largest, fmax(fabs(a[i]), fabs(b[i])));
    worst = fmax(worst, fabs(a[i] - b[i]));
  }
  return worst <= 1e-12 * largest;
}

/* 1 if nothing acts at the start of the step that did not act before. */
static int starts_smoothly(const run *r) {
  if (r->total_no == 0 && r->n > 0) return 0;
  for (size_t i = 0; i < r->n_dof; ++i)
    if (r->fixed[i] && fabs(r->ud[i] - r->old.u[i]) > 1e-12 * fabs(r->ud[i]))
      return 0;
  return same_vector(r->n_dof, r->now.F, r->old.F) &&
         same_vector((size_t)r->m->ns * (size_t)r->eigen.n, r->now.e0,
                     r->old.e0);
}

/*
 * The body answers at once to what is applied suddenly at the start of a *VISCO
 * step: an increment without length of its own.
 */
static status start_visco(run *r, int *increment_no) {
  status st = OK;
  double cpu = timer_cpu();
  if (r->step->kind != STEP_VISCO || r->visco == NULL) return OK;
  TRY(increment_begin(r, r->step->start));
  if (!starts_smoothly(r)) {
    TRY(increment_solve(r, r->step->start));
    if (outcome_is_fatal(r->report.outcome)) TRY(no_equilibrium(r));
    if (!same_vector(r->n_dof, r->now.u, r->old.u))
      TRY(accept(r, 1, ++*increment_no, 0, cpu));
  }
  TRY(visco_begin_step(r));
done:
  return st;
}

/* The next increment after one of length dt with this error; implicit
 * integrators keep to halves and doubles, which they have factored. */
static double next_length(const step *s, double dt, double error) {
  const scheme *of = s->integrator;
  int order = of->estimates ? 1 : of->order;
  double factor = 4.0;
  if (s->theta == 0.5 && of->has_theta) order = 2;
  if (error > 0.0) factor = 0.9 * pow(s->tolerance / error, 1.0 / (order + 1));
  factor = fmin(4.0, fmax(0.2, factor));
  if (of->limit == 0.0) factor = ldexp(1.0, (int)floor(log2(factor)));
  return fmin(dt * factor, s->dt_max);
}

/* End of the next increment: not a sliver before the end of the step. */
static double next_end(const run *r, double dt) {
  double end = r->step->start + r->step->total, left = end - r->old.t;
  if (dt >= left * (1.0 - 1e-9)) return end;
  return r->old.t + (dt > 0.5 * left && r->step->integrator->limit > 0.0
                         ? 0.5 * left
                         : dt);
}

/* One attempt at an increment of a step with a tolerance. */
static status attempt_adapted(run *r) {
  status st = OK;
  const step *s = r->step;
  progress *p = &r->at;
  double end = s->start + s->total, error = 0.0;
  double cpu = timer_cpu(), t = next_end(r, p->dt), tried;
  int deeper, attempt = p->attempt;
  TRY(visco_level(r, t - r->old.t, &deeper));
  if (deeper > 0) t = next_end(r, ldexp(t - r->old.t, -deeper));
  tried = t - r->old.t;
  TRY(visco_try(r, t, &error));
  int settled = r->report.outcome > 0;
  r->missed = settled && error > s->tolerance;
  if ((!settled || r->missed) && tried > s->dt_min) {
    TRY(reject(r, attempt, p->increment_no + 1,
               settled ? "strain error above TOLERANCE"
                       : outcome_text(r->report.outcome)));
    p->dt = fmax(s->dt_min, fmin(0.5 * tried, next_length(s, tried, error)));
    ++p->attempt;
    goto done;
  }
  if (outcome_is_fatal(r->report.outcome)) TRY(no_equilibrium(r));
  p->attempt = 1;
  ++p->increment_no;
  TRY(accept(r, attempt, p->increment_no, t == end, cpu));
  p->dt = fmax(s->dt_min, next_length(s, tried, error));
done:
  r->missed = 0;
  return st;
}

static status run_adaptive(run *r) {
  status st = OK;
  double end = r->step->start + r->step->total;
  while (r->old.t < end) {
    TRY(pause(r));
    TRY(attempt_adapted(r));
  }
done:
  return st;
}

/* What comes before the increments of a step. */
static status begin_step(run *r) {
  status st = OK;
  if (run_step_id(r) == 0 && (r->m->effects & EFFECT_START)) {
    TRY(test_start(r));
    TRY(judge_start(r));
  }
  TRY(start_visco(r, &r->at.increment_no));
done:
  return st;
}

static status run_step(run *r) {
  status st = OK;
  TRY(run_prepare(r));
  if (r->from != NULL) {
    TRY(run_keep(r, r->from));
    r->from = NULL;
  } else {
    r->at =
        (progress){.step_id = run_step_id(r), .attempt = 1, .dt = r->step->dt};
    TRY(begin_step(r));
  }
  if (r->step->tolerance > 0.0 && r->visco != NULL)
    TRY(run_adaptive(r));
  else
    TRY(run_fixed(r));
  if (r->due) TRY(checkpoint(r));
done:
  return st;
}

/* The step in progress. */
static status read_progress(run *r) {
  status st = OK;
  if (r->from == NULL) goto done;
  archive_enter(r->from, "run");
  st = archive_bytes(r->from, "at", &r->at, sizeof r->at);
  archive_leave(r->from);
  TRY(st);
  if (r->at.step_id < 0 || r->at.step_id >= r->m->n_step)
    FAIL(ERR_FILE, "the restart file is of a deck with other steps");
done:
  return st;
}

status history_continue(const model *m, const mesh *msh, archive *from,
                        const history_sink *sink, int *unsettled) {
  status st = OK;
  run r = {.m = m, .msh = msh, .sink = sink, .from = from};
  *unsettled = 0;
  TRY(run_new(&r));
  TRY(read_progress(&r));
  if (from == NULL) TRY(run_read_start(&r));
  for (int i = r.at.step_id; i < m->n_step; ++i) {
    r.step = &m->steps[i];
    TRY(run_step(&r));
  }
done:
  *unsettled = r.unsettled;
  run_free(&r);
  return st;
}

status history_run(const model *m, const mesh *msh, const history_sink *sink,
                   int *unsettled) {
  return history_continue(m, msh, NULL, sink, unsettled);
}
