/*
 * A pass gives three errors in the same norm: mesh, increments, solver. The
 * next one changes only errors above their share of the target: the mesh to
 * sizes that give it with the fewest elements (space_sizes), the increments and
 * the tolerance in proportion. The answer of a pass is taken if the sum of the
 * three is below the target.
 *
 * Estimated costs of a pass: the unknowns grow like error^(-dim) (P1: order 1
 * in the energy norm), the CPU seconds of the mesh like the unknowns, without
 * what gmsh costs to load, the rest like a power of them, 1.2 in the plane and
 * 1.75 in space, measured with the nested dissection of condense.
 */
#include "program/job.h"

#include "base/interrupt.h"

#include <cblas.h>

/* Shares of the target, -: errors allowed to the mesh, the increments and the
 * solver; the next pass aims at AIM of that. */
static const double MESH_SHARE = 0.85, TIME_SHARE = 0.1, SOLVER_SHARE = 0.05;
static const double AIM = 0.93;
/* -, of the error, or a pass had no effect. */
static const double LEAST_GAIN = 0.95;
/* -, of what a coarse mesh estimates; what the next one is to have of it. */
static const double COARSE = 2.0, FINER = 0.6;
enum { GROWN = 2 }; /* -, of the unknowns: a mesh is finer */
enum { BLIND = 2 }; /* what is estimated tells nothing: half the length */
static const double GROWTH_2D = 1.2, GROWTH_3D = 1.75; /* -, of the CPU */
static const double EXACT = 1e-10; /* -, errors of rounding alone */
static const double LEAST_TOL = 1e-14, SHORTEST = 1.0 / 16; /* - */

/* Data of a pass from its increments, and the decision. */
typedef struct pass {
  const command *c;
  const accuracy_target *target;
  job_input *in, next; /* of this pass; of the next, once it is read */
  pass_row rows[MAX_PASS_ROWS], forecast;
  int n;                     /* rows, this pass included */
  double energy;             /* J, largest strain energy that counts */
  double mesh, time, solver; /* -, errors there */
  int coarse; /* 1: that of the mesh may be twice as large; 2: any */
  struct {
    int n;         /* in a row whose mesh hardly had a smaller error */
    double gained; /* unknowns of the last one before these */
  } vain;          /* passes */
  double *eta;     /* [n_elem] shares of the elements there */
  double *size;    /* [n_node] of the next mesh, m */
  aims *goals;     /* or NULL: there are none */
  coarser *contact, *before; /* of this pass, of the one before */
  struct {
    mesh *msh;    /* of the deck, with targets of goals: its lengths */
    double *size; /* [msh->n_node] are the largest of all passes, m */
  } first;
  double unknowns; /* of this pass */
  struct {
    double dt, tol; /* on increments and tolerances */
    double shorter; /* on the increments, in the next pass */
  } factor;         /* -, of those of the deck; of this pass */
  struct {
    double mesh, last_mesh; /* of meshing; of the pass before */
    double start;           /* of the process when the pass began */
    double meshed;          /* of that on meshes */
  } cpu;                    /* s */
  int done;                 /* 1: no other pass */
  int aside;                /* pass whose files are aside, 0: none */
  char why[256];            /* why the target is missed; or "" */
} pass;

/* ---- observing ----------------------------------------------------------- */

static status see_ready(void *ctx, const setup_facts *facts,
                        const contact_surface *surface) {
  pass *p = ctx;
  p->unknowns = (double)facts->info.unknowns;
  return OK;
}

static status see_increment(void *ctx, const state *s) {
  pass *p = ctx;
  PASS(job_keep_contact(p->contact, s));
  aims_see(p->goals, p->in->msh, s);
  const double energy = s->energy.strain + s->errors.mesh_error.entered;
  if (!s->errors.mesh_error.asked || energy < p->energy) return OK;
  p->energy = energy;
  p->mesh = s->errors.mesh_error.relative;
  p->coarse = s->errors.mesh_error.why != NULL;
  if (error_is_unseen(&s->errors.mesh_error)) p->coarse = BLIND;
  p->time = s->errors.time_error.relative;
  p->solver = s->errors.error.asked ? s->errors.error.relative : 0.0;
  COPY(p->eta, s->errors.elem_error, p->in->msh->n_elem);
  return OK;
}

double target_at_most(double estimate, int is_coarse) {
  return is_coarse ? COARSE * estimate : estimate;
}

double target_next(double estimate, int is_coarse, double goal) {
  return fmin(AIM * goal, is_coarse ? FINER * estimate : HUGE_VAL);
}

static double at_most(const pass *p) {
  return p->coarse == BLIND ? HUGE_VAL : target_at_most(p->mesh, p->coarse);
}

static double total(const pass *p) { return at_most(p) + p->time + p->solver; }

/* 1: the energy norm has a target. */
static int has_norm(const pass *p) { return p->target->percent > 0.0; }

static int norm_is_met(const pass *p) {
  return !has_norm(p) || total(p) <= p->target->percent / 100.0;
}

/* ---- deciding ------------------------------------------------------------ */

static void miss(pass *p, const char *why) {
  p->done = 1;
  snprintf(p->why, sizeof p->why, "%s", why);
}

/* Error allowed to the mesh: the rest of the target, if the others are within
 * their shares. */
static double mesh_goal(const pass *p) {
  double goal = p->target->percent / 100.0;
  if (p->time > TIME_SHARE * goal || p->solver > SOLVER_SHARE * goal)
    return MESH_SHARE * goal;
  return goal - p->time - p->solver;
}

static int norm_wants_mesh(const pass *p) {
  return has_norm(p) && at_most(p) > mesh_goal(p);
}

static void halve(const mesh *msh, double *size) {
  space_lengths(msh, size);
  for (int i = 0; i < msh->n_node; ++i) size[i] *= 0.5;
}

/* Sizes of the next mesh, and the factor by which the unknowns grow until the
 * error of the mesh is the one wanted. */
static status find_sizes(pass *p, double *factor) {
  const mesh *msh = p->in->msh;
  /* What gained nothing was too little. */
  const double wanted =
      target_next(p->mesh, p->coarse, mesh_goal(p)) * pow(0.5, 0.5 * p->vain.n);
  *factor = 1.0;
  PASS_NEW(p->size, msh->n_node);
  for (int i = 0; i < msh->n_node; ++i) p->size[i] = HUGE_VAL;
  if (has_norm(p) && p->coarse != BLIND)
    space_sizes(msh, p->eta, wanted, p->size);
  if (has_norm(p) && p->coarse == BLIND) halve(msh, p->size);
  if (norm_wants_mesh(p))
    *factor = p->coarse == BLIND ? space_growth(msh, p->size)
                                 : space_growth_to(msh, p->eta, wanted);
  if (!aims_count(p->goals)) return OK;
  PASS(aims_sizes(p->goals, p->in->m, msh, p->energy >= 0.0 ? p->eta : NULL,
                  p->size));
  *factor = fmax(*factor, space_growth(msh, p->size));
  return OK;
}

/* Estimated CPU seconds of meshing that many times the unknowns: linear from
 * pass to pass, from the first on through zero. */
static double price_of_mesh(const pass *p, double factor) {
  double last = p->n > 1 ? p->rows[p->n - 2].unknowns : 0.0;
  double more = p->unknowns - last, later = p->cpu.mesh - p->cpu.last_mesh;
  double slope;
  if (p->n > 1 && more > 0.0 && later >= 0.0)
    slope = later / more;
  else
    slope = p->cpu.mesh / p->unknowns;
  return p->cpu.mesh + slope * (factor - 1.0) * p->unknowns;
}

/* Estimated CPU seconds of a run with that many times the unknowns, and the
 * increments of the next pass. */
static double price(const pass *p, double factor) {
  double power = p->in->m->dim == 2 ? GROWTH_2D : GROWTH_3D;
  double rest = p->rows[p->n - 1].cpu - p->cpu.mesh - p->in->library_cpu;
  return price_of_mesh(p, factor) +
         fmax(rest, 0.0) * pow(factor, power) / p->factor.shorter;
}

/* A limit that a mesh of that many times the unknowns would exceed, or "". */
static void limit_of(const pass *p, double factor, char *text, size_t size) {
  const accuracy_target *t = p->target;
  const double cpu = timer_cpu() + price(p, factor);
  const double bytes = (double)memory_peak() * factor;
  text[0] = '\0';
  if (t->max_cpu > 0.0 && cpu > t->max_cpu)
    snprintf(text, size,
             "its mesh would be done after about %.3g s of CPU, MAX_CPU is %g",
             cpu, t->max_cpu);
  else if (bytes - (double)memory_in_use() > memory_left())
    snprintf(text, size,
             "its mesh would need about %.3g MB more than %s leaves",
             (bytes - (double)memory_in_use() - memory_left()) / 1e6,
             memory_limit_of());
  else if (t->max_memory > 0.0 && bytes > t->max_memory * 1048576.0)
    snprintf(text, size, "its mesh would need about %.3g MB, MAX_MEMORY is %g",
             bytes / 1048576.0, t->max_memory);
}

/* The error, %, that a mesh within the limits may reach, where one of "factor"
 * times the unknowns reaches the target; HUGE_VAL: none. */
static double within_limits(const pass *p, double factor) {
  enum { HALVINGS = 30 };
  double low = 1.0, high = factor;
  char text[200];
  limit_of(p, low, text, sizeof text);
  if (text[0] != '\0') return HUGE_VAL;
  for (int k = 0; k < HALVINGS; ++k) {
    const double middle = sqrt(low * high);
    limit_of(p, middle, text, sizeof text);
    *(text[0] == '\0' ? &low : &high) = middle;
  }
  return p->target->percent * pow(factor / low, 1.0 / p->in->m->dim);
}

/* Limits that a mesh of that many times the unknowns would exceed. */
static void check_limits(pass *p, double factor) {
  char text[200];
  const accuracy_target *t = p->target;
  const int most = t->max_passes > 0 ? t->max_passes : MAX_PASSES_DEFAULT;
  limit_of(p, factor, text, sizeof text);
  if (p->n >= most) miss(p, "MAX_PASSES is reached");
  if (p->done || text[0] == '\0') return;
  miss(p, text);
  const double error = within_limits(p, factor);
  if (norm_wants_mesh(p) && !aims_count(p->goals) &&
      error < LEAST_GAIN * 100.0 * total(p))
    snprintf(p->why, sizeof p->why, "%s; about %.2g %% is within that", text,
             error);
}

/* Factor on the tolerance of the solver, 1: it stays. */
static double change_of_tol(const pass *p) {
  double over = aims_solver(p->goals, p->in->m, SOLVER_SHARE);
  if (has_norm(p))
    over = fmax(over, p->solver / (SOLVER_SHARE * p->target->percent / 100.0));
  return over > 1.0 && p->factor.tol > LEAST_TOL ? AIM / over : 1.0;
}

/* Changes of the next pass; "" if none is possible. */
static void choose(pass *p, char *text, size_t size) {
  double goal = p->target->percent / 100.0, tol = change_of_tol(p);
  size_t used = 0;
  text[0] = '\0';
  if (norm_wants_mesh(p) || !aims_are_met(p->goals, p->in->m)) {
    used = snprintf(text, size, "mesh");
    used += aims_name(p->goals, p->in->m, text + used, size - used);
  }
  if (has_norm(p) && p->time > TIME_SHARE * goal &&
      p->factor.dt > SHORTEST * SHORTEST) {
    p->factor.shorter = fmax(AIM * TIME_SHARE * goal / p->time, SHORTEST);
    p->factor.dt *= p->factor.shorter;
    used += snprintf(text + used, size - used, "%sdt * %.2g",
                     used > 0 ? ", " : "", p->factor.shorter);
  }
  if (tol < 1.0) {
    p->factor.tol *= tol;
    snprintf(text + used, size - used, "%stol * %.2g", used > 0 ? ", " : "",
             tol);
  }
}

static int refines(const pass_row *row) {
  return strncmp(row->change, "mesh", 4) == 0;
}

/* Did the last pass gain nothing although the mesh was to change? One tells
 * nothing, nor do those of a mesh that has hardly grown: errors scatter from
 * mesh to mesh. */
static void see_gain(pass *p) {
  const int vain = p->n > 1 && refines(&p->rows[p->n - 2]) &&
                   norm_wants_mesh(p) && !p->coarse &&
                   p->rows[p->n - 1].mesh > LEAST_GAIN * p->rows[p->n - 2].mesh;
  p->vain.n = vain ? p->vain.n + 1 : 0;
  if (!vain) p->vain.gained = p->unknowns;
}

static int was_in_vain(const pass *p) {
  if (p->n < 2 || !refines(&p->rows[p->n - 2])) return 0;
  return (p->vain.n > 1 && p->unknowns > GROWN * p->vain.gained) ||
         aims_stand_still(p->goals);
}

/* Errors that no other pass can change. */
static void check_known(pass *p) {
  char why[256];
  aims_check(p->goals, p->in->m, 0, why, sizeof why);
  if (has_norm(p) && isnan(total(p)))
    miss(p, isnan(p->time)
                ? "the error of the steps is unknown, see the listing"
                : "the solver has no bound of its error, see the "
                  "listing");
  else if (why[0] != '\0')
    miss(p, why);
}

/* A goal without a value has no error. */
static void miss_in_vain(pass *p) {
  char why[256] = "";
  if (aims_stand_still(p->goals))
    aims_check(p->goals, p->in->m, 1, why, sizeof why);
  miss(p,
       why[0] != '\0' ? why : "a mesh asked to be finer has no smaller error");
}

/* After the increments of a pass: is it the last? */
static status decide(pass *p) {
  pass_row *row = &p->rows[p->n - 1];
  double factor = 1.0;
  p->done = norm_is_met(p) && aims_are_met(p->goals, p->in->m);
  if (!p->done) check_known(p);
  if (p->done) return OK;
  see_gain(p);
  PASS(find_sizes(p, &factor));
  choose(p, row->change, sizeof row->change);
  int finer = refines(row);
  if (row->change[0] == '\0')
    miss(p, "no error has more than its share, their sum is above the target");
  else if (finer && job_keeps_mesh(p->in->m))
    miss(p,
         "a .msh with values at its nodes (FILE=) is not refined: give them as "
         "expressions");
  else if (was_in_vain(p))
    miss_in_vain(p);
  else
    check_limits(p, finer ? factor : 1.0);
  if (p->done) row->change[0] = '\0';
  return OK;
}

/* ---- one pass ------------------------------------------------------------ */

static status report_pass(const pass *p) {
  const pass_row *r = &p->rows[p->n - 1];
  const char *next = r->change[0] != '\0' ? r->change
                     : p->why[0] != '\0'  ? p->why
                                          : "done";
  if (p->c->quiet) return OK;
  if (p->n == 1) {
    printf("%4s %10s", "pass", "unknowns");
    if (has_norm(p))
      printf(" %9s %9s %9s %9s", "mesh[%]", "steps[%]", "solver[%]",
             "total[%]");
    if (p->goals != NULL) passes_goal_heads(p->in->m, stdout);
    printf(" %9s  %s\n", "cpu[s]", "next");
  }
  printf("%4d %10.0f", p->n, r->unknowns);
  if (has_norm(p))
    printf(" %9.2e %9.2e %9.2e %9.2e", r->mesh, r->time, r->solver, r->total);
  if (p->goals != NULL)
    passes_goals(p->in->m, aims_rows(p->goals), p->n - 1, stdout);
  printf(" %9.3g  %s\n", r->cpu, next);
  return text_flush_output();
}

/* Forecast of a tenth of the error; goals are of second order. */
static pass_row next_digit(const pass *p) {
  const pass_row *r = &p->rows[p->n - 1];
  const int dim = p->in->m->dim;
  double factor = pow(10.0, has_norm(p) ? dim : 0.5 * dim);
  pass_row row = {.unknowns = r->unknowns * factor,
                  .total = r->total / 10.0,
                  .cpu = price(p, factor)};
  return row;
}

/* Before a pass with that input. */
static status begin(pass *p, const job_input *in) {
  RELEASE(p->eta, p->size);
  p->eta = p->size = NULL;
  p->energy = -1.0;
  p->factor.shorter = 1.0;
  p->mesh = p->time = p->solver = 0.0;
  /* The contact of the last pass is the start of this one. */
  memory_free(p->before);
  p->before = p->contact;
  p->contact = NULL;
  if (p->before != NULL) in->m->accuracy.coarser = p->before;
  PASS(coarser_new(&p->contact));
  PASS_NEW(p->eta, in->msh->n_elem);
  PASS(aims_begin(p->goals, in->msh));
  /* Increments and tolerances of the deck times the factors of the pass. */
  for (int i = 0; i < in->m->n.step; ++i) {
    in->m->steps[i].dt *= p->factor.dt;
    in->m->steps[i].dt_min *= p->factor.dt;
    in->m->steps[i].solver.tol =
        fmax(in->m->steps[i].solver.tol * p->factor.tol, LEAST_TOL);
  }
  return OK;
}

static void drop_next(pass *p) {
  if (p->next.msh == p->in->msh) p->next.msh = NULL;
  job_input_free(&p->next);
}

/* Its messages are told at the end of the run, or at once if something is
 * wrong. gmsh may fail with some sizes and not with others near them. */
static status read_next(pass *p) {
  enum { TRIES = 3 };
  job_mesh other = {0};
  status st = ERR_MESH;
  p->cpu.start = timer_cpu();
  p->cpu.meshed = timer_cost(STAGE_MESH).cpu;
  p->cpu.last_mesh = p->cpu.mesh;
  if (refines(&p->rows[p->n - 1]))
    other = (job_mesh){
        .sizes = {{p->in->msh, p->size}, {p->first.msh, p->first.size}}};
  else
    other.same = p->in->msh;
  for (int k = 0; k < TRIES && st == ERR_MESH; ++k) {
    if (k > 0) {
      drop_next(p);
      status_clear();
      cblas_dscal(p->in->msh->n_node, AIM, p->size, 1);
    }
    PASS(message_log_new(&p->next.log));
    st = job_read(p->c, &other, p->next.log, &p->next);
  }
  if (st != OK) message_print(p->next.log, stderr);
  PASS(st);
  return begin(p, &p->next);
}

static status stop_asked(const pass *p) {
  const status st = interrupt_asked();
  if (st == OK) return OK;
  return status_fail(st, __func__, __LINE__,
                     "interrupted by %s: the files are those of pass %d",
                     interrupt_name(), p->n);
}

/* While the files of the pass are open, for the code of a failure. */
static status prepare_next(pass *p) {
  status st = stop_asked(p);
  if (st == OK) st = read_next(p);
  if (st == OK) st = stop_asked(p); /* meshes take long */
  if (st != OK) miss(p, status_message());
  return st;
}

/* The input of the next pass in the place of the last. */
static void take_next(pass *p) {
  job_input *in = p->in;
  p->next.first = in->first != NULL ? in->first : in->d;
  if (in->first == NULL) in->d = NULL;
  in->first = NULL;
  if (in->msh == p->first.msh || in->msh == p->next.msh) in->msh = NULL;
  job_input_free(in);
  *in = p->next;
  p->next = (job_input){0};
}

/* A pass that did not end leaves the files of the one before aside. */
static status tell_aside(pass *p, status st) {
  char why[1024];
  const int of = p->aside;
  if (of == 0 || st == OK) return st;
  p->aside = 0;
  snprintf(why, sizeof why, "%s", status_message());
  OWNED_GET(char, aside, text_path(p->c->dir, p->in->m->name.job, "pass"));
  return status_fail(st, __func__, __LINE__,
                     "%s; the files of pass %d are in %s", why, p->n, aside);
}

static void drop_aside(pass *p) {
  if (p->aside > 0) output_drop_aside(p->in->m, p->c->dir);
  p->aside = 0;
}

static status see_finished(void *ctx, status st, output *out) {
  pass *p = ctx;
  if (st != OK) return tell_aside(p, st);
  aims_evaluate(p->goals, p->in->m);
  pass_row *row = &p->rows[p->n++];
  *row = (pass_row){.unknowns = p->unknowns,
                    .mesh = 100.0 * p->mesh,
                    .time = 100.0 * p->time,
                    .solver = 100.0 * p->solver,
                    .total = 100.0 * total(p),
                    .cpu = timer_cpu() - p->cpu.start};
  p->cpu.mesh = timer_cost(STAGE_MESH).cpu - p->cpu.meshed - p->in->library_cpu;
  PASS(decide(p));
  p->forecast = next_digit(p);
  output_passes(out, &(pass_table){p->target->percent, p->n, p->rows,
                                   total(p) > EXACT ? &p->forecast : NULL,
                                   aims_rows(p->goals), p->why});
  PASS(report_pass(p));
  if (p->why[0] != '\0' && !has_norm(p))
    RAISE(ERR_UNSETTLED,
          "a target of *GOAL is missed: %s; the files are those of pass %d",
          p->why, p->n);
  char error[32] = "unknown";
  if (isfinite(row->total))
    snprintf(error, sizeof error, "%.3g %%", row->total);
  if (p->why[0] != '\0')
    RAISE(ERR_UNSETTLED,
          "the error is %s, the target %g %%: %s; the files are those of "
          "pass %d",
          error, p->target->percent, p->why, p->n);
  return p->done ? OK : prepare_next(p);
}

static status keep_first(pass *p) {
  PASS_NEW(p->first.size, p->in->msh->n_node);
  p->first.msh = p->in->msh;
  space_lengths(p->first.msh, p->first.size);
  return OK;
}

status target_reach(const command *c, job_input *in, int *unsettled) {
  status st = OK;
  const accuracy_target target = in->m->accuracy.target;
  pass p = {.c = c, .target = &target, .in = in, .factor = {1.0, 1.0, 1.0}};
  const job_watch watch = {
      {.ctx = &p, .increment = see_increment, .ready = see_ready},
      see_finished};
  TRY(aims_new(in->m, 0, &p.goals));
  if (aims_count(p.goals)) TRY(keep_first(&p));
  TRY(begin(&p, in));
  for (;;) {
    *unsettled = 0;
    st = job_solve(c, in, &watch, NULL, unsettled);
    if (p.n > p.aside && st != ERR_FILE) drop_aside(&p);
    TRY(st);
    if (p.done) break;
    TRY(output_set_aside(in->m, c->dir));
    p.aside = p.n;
    take_next(&p);
  }
done:
  st = tell_aside(&p, st);
  drop_next(&p);
  if (p.first.msh != in->msh) memory_free(p.first.msh);
  RELEASE(p.eta, p.size, p.first.size, p.before, p.contact, p.goals);
  return st;
}
