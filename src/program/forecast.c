/*
 * What *ACCURACY, TARGET= would cost, from a run on the mesh of the deck and
 * two on finer meshes from its errors (space_sizes).
 *
 * The error of the mesh goes like N^(-p) on such meshes, N unknowns, p from the
 * two. P1 has p = 1/dim; where an edge is so sharp that the mesh cannot follow
 * it, p is less, on uniform meshes down to half of that (stress like r^(-1/2));
 * p is limited to this range. The passes of target.c are simulated with it:
 * each aims at the remaining part of the target, makes (error/aim)^dim times
 * the unknowns, or the share of that which the fine run had, and reaches the
 * error of that mesh. In space, where the first errors do not resolve the
 * edges, later passes also redistribute unknowns: the same share holds for
 * them, and the error falls from the one before by the order of the element
 * size. Meshes with few elements across the body, a number that goes like
 * N^(1/dim), count their error twice as there.
 *
 * CPU seconds of a pass: those of the stages of the fine run, each by its own
 * size. The factor and its solves go with N (1.2 and 1.05 in the plane, 1.75
 * and 4/3 in space: nested dissection as measured with condense from 1e4 to 1e6
 * unknowns), dense work with the m contact unknowns, m^2.5 (between the
 * products and the factors of Newton's method, as measured from 100 to 8000), m
 * like a power of N found from the two runs. The shadow run for the error of
 * the increments costs as much as these. The rest is linear in N. All costs but
 * those paid once a run are proportional to the number of increments, which
 * grows as their error is to fall.
 *
 * For the goals there are two runs more, on meshes refined for all of them
 * (aims.c). The error of a goal goes like N^(-p), p from these two near that of
 * its second order, 2/dim, in space not less: there the first meshes do not
 * resolve edges and ends of contact, and later passes gain more; where it does
 * not fall nothing is told. Of the finer mesh it takes the share of the
 * elements that it needs for itself. The passes of its target cost that of the
 * deck and two like the last one.
 */
#include "effects/rows.h"
#include "program/job.h"

typedef struct trial {
  double unknowns, contact;       /* of the body, of the contact */
  double energy, error, time;     /* J, -, - at the largest energy */
  double cpu[STAGE_COUNT], bytes; /* s; at most held */
  const job_input *in;
  double *eta; /* [n_elem] shares of the elements; borrowed or NULL */
  int n_elem;
  int is_coarse; /* its estimate may have half of the error */
  double depth;  /* elements across the body */
  aims *goals;   /* or NULL */
} trial;

static status see_sizes(void *ctx, int n_node, const stiffness_choice *choice) {
  const trial *t = ctx;
  return plan_expect(t->in->m, t->in->msh, n_node, choice);
}

static status see_ready(void *ctx, const setup_facts *facts,
                        const contact_surface *surface) {
  trial *t = ctx;
  t->unknowns = (double)facts->info.unknowns;
  t->contact = (double)facts->info.contact_unknowns;
  return OK;
}

static status see_increment(void *ctx, const state *s) {
  trial *t = ctx;
  aims_see(t->goals, t->in->msh, s);
  const double energy = s->energy.strain + s->errors.mesh_error.entered;
  if (energy < t->energy) return OK;
  t->energy = energy;
  t->error = s->errors.mesh_error.relative;
  t->is_coarse = s->errors.mesh_error.why != NULL;
  t->depth = s->errors.mesh_error.depth;
  if (t->eta != NULL) COPY(t->eta, s->errors.elem_error, t->n_elem);
  t->time = isfinite(s->errors.time_error.relative)
                ? s->errors.time_error.relative
                : 0.0;
  return OK;
}

/* CPU seconds of the stages since "before". */
static void stage_costs(const trial *before, trial *t) {
  for (int i = 0; i < STAGE_COUNT; ++i)
    t->cpu[i] =
        timer_cost((stage)i).cpu - (before != NULL ? before->cpu[i] : 0);
}

/* One run without output, with its error of the mesh in the energy norm, and
 * that of the increments if "time". */
static status run_trial(job_input *in, int time, trial *t) {
  int unsettled = 0;
  for (int i = 0; i < in->m->n.step; ++i) {
    in->m->steps[i].accuracy.mesh = MESH_ERROR_YES;
    if (time) in->m->steps[i].accuracy.time = 1;
  }
  in->m->effects |= EFFECT_MESH_ERROR | (time ? EFFECT_TIME_ERROR : 0);
  const history_sink sink = {.ctx = t,
                             .expect = see_sizes,
                             .ready = see_ready,
                             .increment = see_increment};
  t->energy = -1.0;
  t->in = in;
  t->n_elem = in->msh->n_elem;
  PASS(aims_begin(t->goals, in->msh));
  in->m->accuracy.goal_products = t->goals != NULL;
  PASS(history_run(in->m, in->msh, effect_table, &sink, &unsettled));
  t->bytes = (double)memory_peak();
  aims_evaluate(t->goals, in->m);
  return OK;
}

/* 1: paid once a run, not once an increment. */
static int is_of_run(int s) {
  return s == STAGE_DECK || s == STAGE_MESH || s == STAGE_SURFACE ||
         s == STAGE_COUPLING || s == STAGE_ASSEMBLY || s == STAGE_ORDERING ||
         s == STAGE_FACTOR || s == STAGE_CONDENSE;
}

/* As in target.c: the share of the increments in the target, the aim of the
 * next pass, its limit. */
static const double MESH_SHARE = 0.85, TIME_SHARE = 0.1, AIM = 0.93;
static const double REACH = 8.0, FINEST = 0.25, FINEST_LAST = 0.1;
static const double SHORTEST = 1.0 / 16;
enum { MOST_PASSES = 20 };
enum { MORE = 2 }; /* meshes, where the error of the first two does not fall */

static const double MOST_UNKNOWNS = 1e9;
static const double DENSE = 2.5; /* power of m */
/* -, of the powers of N that costs grow with, in space of that of the memory,
 * whose contact may be dense or not; least factors of a forecast, of seconds,
 * of memory in the plane and in space (make bench: tests/bench/forecast.c). */
static const double DOUBT = 0.1, MEMORY_DOUBT = 0.5;
static const double LEAST_DOUBT = 2.0, LEAST_MEMORY[2] = {1.5, 2.0};
/* -, least factor that the seconds of a goal are expected within (1.7
 * measured), and the one more where its parts cancel (tenfold measured). */
static const double LEAST_GOAL_DOUBT = 1.7, CANCELS_DOUBT = 6.0;

typedef struct model_of_cost {
  int dim;
  trial deck, coarse, fine;
  plan_sizes sizes; /* of the deck */
  double order;     /* of the error in N */
  double contact;   /* power of N that m is like */
  double share;     /* of the unknowns that P1 would need, on the first mesh */
} model_of_cost;

/* Passes towards a target. */
typedef struct course {
  double unknowns, error, time; /* of the last pass */
  int is_coarse;                /* its mesh, as in trial */
  double times;                 /* the increments of the deck */
  double cpu;                   /* s, all passes */
} course;

static double within(double least, double x, double most) {
  return fmin(fmax(x, least), most);
}

static double exponent(double y0, double y1, double x0, double x1) {
  return log(y1 / y0) / log(x1 / x0);
}

/* ---- cost ---------------------------------------------------------------- */

/* Growth of the CPU of a stage when N is that many times those of fine. */
static double growth(const model_of_cost *c, stage s, double ratio) {
  int plane = c->dim == 2;
  if (s == STAGE_FACTOR) return pow(ratio, plane ? 1.2 : 1.75);
  if (s == STAGE_ORDERING) return pow(ratio, 1.2);
  if (s == STAGE_RECOVERY) return pow(ratio, plane ? 1.05 : 4.0 / 3.0);
  if (s == STAGE_CONDENSE || s == STAGE_CONTACT || s == STAGE_ESTIMATE)
    return pow(ratio, DENSE * c->contact);
  return ratio;
}

/* CPU seconds of the stages of the shadow run too. */
static double of_shadow_run(const model_of_cost *c, double ratio) {
  static const stage shared[] = {STAGE_CONTACT, STAGE_RECOVERY, STAGE_INELASTIC,
                                 STAGE_STRESS};
  double sum = 0.0;
  for (size_t i = 0; i < sizeof shared / sizeof *shared; ++i)
    sum += c->fine.cpu[shared[i]] * growth(c, shared[i], ratio);
  return sum;
}

/* CPU seconds of tables and fields, which the three runs do not write. */
static double of_files(const model_of_cost *c, double unknowns, double times) {
  static const double OPERATION = 1e-9; /* s */
  const double ratio = unknowns / c->deck.unknowns;
  plan_sizes s = c->sizes;
  s.nodes *= ratio;
  s.elements *= ratio;
  s.held *= pow(ratio, c->contact);
  s.contact *= pow(ratio, c->contact);
  return OPERATION * times * plan_output(&s);
}

/* CPU seconds of a run with N unknowns and that many times the increments. */
static double cpu_at(const model_of_cost *c, double unknowns, double times) {
  double sum = 0.0, ratio = unknowns / c->fine.unknowns;
  double shadow = of_shadow_run(c, 1.0);
  for (int i = 0; i < STAGE_COUNT; ++i) {
    double by = growth(c, (stage)i, ratio);
    if (i == STAGE_TIME_ERROR && shadow > 0.0)
      by = of_shadow_run(c, ratio) / shadow;
    sum += c->fine.cpu[i] * by * (is_of_run(i) ? 1.0 : times);
  }
  return sum + of_files(c, unknowns, times);
}

static double cpu_of_deck(const model_of_cost *c) {
  double sum = of_files(c, c->deck.unknowns, 1.0);
  for (int i = 0; i < STAGE_COUNT; ++i) sum += c->deck.cpu[i];
  return sum;
}

static double bytes_at(const model_of_cost *c, double unknowns) {
  double ratio = unknowns / c->fine.unknowns;
  double power = c->dim == 2 ? 1.05 : fmax(4.0 / 3.0, 2.0 * c->contact);
  return c->fine.bytes * pow(ratio, power);
}

/* ---- passes -------------------------------------------------------------- */

/* The next mesh, whose error is to be "aim". */
static void refine(const model_of_cost *c, double aim, course *at) {
  double least = at->error <= REACH * aim ? FINEST_LAST : FINEST;
  double length = within(least, aim / at->error, 1.0);
  int first = at->unknowns <= c->deck.unknowns, moves = c->dim == 3;
  double more = pow(length, -c->dim) * (first || moves ? c->share : 1.0);
  double moved = at->error * pow(length, c->order * c->dim);
  at->unknowns *= fmax(more, 1.0);
  double error = c->fine.error * pow(c->fine.unknowns / at->unknowns, c->order);
  if (!first && moves) error = fmin(error, moved);
  at->error = fmin(error, at->error);
  at->is_coarse = space_is_coarse(
      c->fine.depth * pow(at->unknowns / c->fine.unknowns, 1.0 / c->dim));
}

static double error_of(const course *at) {
  return target_at_most(at->error, at->is_coarse);
}

/* All passes to that error. */
static course go(const model_of_cost *c, double goal) {
  course at = {.unknowns = c->deck.unknowns,
               .error = c->deck.error,
               .time = c->deck.time,
               .is_coarse = c->deck.is_coarse,
               .times = 1.0,
               .cpu = cpu_of_deck(c)};
  for (int k = 1; error_of(&at) + at.time > goal && k < MOST_PASSES; ++k) {
    int late = at.time > TIME_SHARE * goal;
    double mesh_goal = late ? MESH_SHARE * goal : goal - at.time;
    if (error_of(&at) > mesh_goal)
      refine(c, target_next(at.error, at.is_coarse, mesh_goal), &at);
    if (late) {
      double shorter = fmax(AIM * TIME_SHARE * goal / at.time, SHORTEST);
      at.times /= shorter;
      at.time *= shorter;
    }
    if (at.unknowns > MOST_UNKNOWNS) break;
    at.cpu += cpu_at(c, at.unknowns, at.times);
  }
  return at;
}

/* Factors that seconds and bytes are expected within, by the order of the error
 * from each pair of the three runs, and of the powers that they grow with. */
static void find_doubt(const model_of_cost *c, double error, const course *end,
                       double *cpu, double *bytes) {
  const trial *runs[3][2] = {
      {&c->deck, &c->coarse}, {&c->coarse, &c->fine}, {&c->deck, &c->fine}};
  const double full = 1.0 / c->dim;
  const double grown = pow(fmax(end->unknowns / c->fine.unknowns, 1.0), DOUBT);
  const double held_more = pow(fmax(end->unknowns / c->fine.unknowns, 1.0),
                               c->dim == 3 ? MEMORY_DOUBT : DOUBT);
  *cpu = LEAST_DOUBT;
  *bytes = LEAST_MEMORY[c->dim == 3] * (c->dim == 3 ? held_more : 1.0);
  if (end->unknowns <= c->deck.unknowns) return;
  for (int k = 0; k < 3; ++k) {
    model_of_cost other = *c;
    other.order = within(0.5 * full,
                         -exponent(runs[k][0]->error, runs[k][1]->error,
                                   runs[k][0]->unknowns, runs[k][1]->unknowns),
                         1.1 * full);
    const course its = go(&other, error);
    const double held = bytes_at(c, its.unknowns) / bytes_at(c, end->unknowns);
    *cpu = fmax(*cpu, grown * fmax(its.cpu / end->cpu, end->cpu / its.cpu));
    *bytes = fmax(*bytes, held_more * fmax(held, 1.0 / held));
  }
}

/* In 3-D, where a digit is expensive, the levels are closer. */
static const double wanted_errors[] = {0.1,  0.07,  0.05, 0.03,
                                       0.01, 0.003, 0.001};
enum { N_WANTED = sizeof wanted_errors / sizeof *wanted_errors };

/* Passes to a smaller error do too: those of coarse meshes leap. */
static course cheapest(const model_of_cost *c, int level) {
  course best = go(c, wanted_errors[level]);
  for (int k = level + 1; k < N_WANTED; ++k) {
    const course other = go(c, wanted_errors[k]);
    if (other.cpu < best.cpu) best = other;
  }
  return best;
}

static void print_row(const model_of_cost *c, int level) {
  const double error = wanted_errors[level];
  const course end = cheapest(c, level);
  const int there =
      target_at_most(c->deck.error, c->deck.is_coarse) + c->deck.time <= error;
  if (end.unknowns > MOST_UNKNOWNS) {
    printf("  %8.3g %12s\n", 100 * error, "out of reach");
    return;
  }
  double bytes = there ? c->deck.bytes : bytes_at(c, end.unknowns);
  double doubt[2];
  find_doubt(c, error, &end, &doubt[0], &doubt[1]);
  printf("  %8.3g %12.3g %12.3g %10.3g %12.3g", 100 * error, end.unknowns,
         end.times, end.cpu, bytes / 1048576.0);
  for (int k = 0; k < 2; ++k)
    if (c->fine.is_coarse)
      printf(" %9s", "-");
    else
      printf(" %9.2g", doubt[k]);
  puts(there ? "  the mesh of the deck does" : "");
}

static void print_table(const model_of_cost *c) {
  printf("  %8s %12s %12s %10s %12s %9s %9s\n", "error[%]", "unknowns",
         "increments*", "cpu[s]", "memory[MB]", "cpu:", "memory:");
  for (int k = 0; k < N_WANTED; ++k)
    if (c->dim == 3 || k == 0 || k > 2) print_row(c, k);
  printf(
      "  * times those of the deck. CPU of all passes of TARGET=. Behind cpu: "
      "and memory:\n    the factor within which they are expected\n"
      "  mesh of the deck: %.3g %% with %.0f unknowns; increments: %.3g %%\n",
      100 * c->deck.error, c->deck.unknowns, 100 * c->deck.time);
  if (c->fine.is_coarse)
    puts(
        "  few nodes inside the body: the factors are not known, the mesh may "
        "have twice the error");
}

/* Basis of the rows. */
static void print_fit(const model_of_cost *c) {
  printf(
      "  error ~ unknowns^(-%.2f) (size^%.2f), fitted to %.3g %% with %.0f "
      "and %.3g %% with %.0f\n"
      "  contact unknowns: %.0f, %.0f and %.0f, taken as unknowns^%.2f\n",
      c->order, c->order * c->dim, 100 * c->coarse.error, c->coarse.unknowns,
      100 * c->fine.error, c->fine.unknowns, c->deck.contact, c->coarse.contact,
      c->fine.contact, c->contact);
}

/* Order of the error in N, from the two meshes that are much alike; where that
 * is less than "full", from all three, by least squares: so near to one another
 * meshes scatter. */
static double order_of(const model_of_cost *c, double full) {
  const trial *runs[] = {&c->deck, &c->coarse, &c->fine};
  double x = 0.0, xx = 0.0, xy = 0.0;
  double two = -exponent(c->coarse.error, c->fine.error, c->coarse.unknowns,
                         c->fine.unknowns);
  for (int i = 0; i < 3; ++i) x += log(runs[i]->unknowns) / 3.0;
  for (int i = 0; i < 3; ++i) {
    double dx = log(runs[i]->unknowns) - x;
    xx += dx * dx;
    xy += dx * log(runs[i]->error);
  }
  double order = two >= full ? two : fmax(two, fmin(-xy / xx, full));
  return within(0.5 * full, order, 1.1 * full);
}

/* Coarse meshes may not see the error that finer ones have. */
static int falls(const model_of_cost *c) {
  return c->fine.error < 0.99 * c->coarse.error;
}

/* Power of N that the contact unknowns are like, from two runs. */
static double contact_power(const trial *a, const trial *b, int dim) {
  const double full = 1.0 - 1.0 / dim;
  if (!(a->contact > 0.0 && b->contact > a->contact)) return full;
  return within(0.5 * full,
                exponent(a->contact, b->contact, a->unknowns, b->unknowns),
                1.0);
}

/* Results of the three runs; wanted: the error intended for the fine one, -. */
static status fit(model_of_cost *c, double wanted) {
  const trial *a = &c->coarse, *b = &c->fine;
  double full = 1.0 / c->dim;
  if (!falls(c))
    RAISE(ERR_UNSETTLED,
          "the error of the mesh does not fall: %.3g %% with %.0f unknowns, "
          "%.3g %% with %.0f; no forecast",
          100 * a->error, a->unknowns, 100 * b->error, b->unknowns);
  c->order = order_of(c, full);
  c->contact = contact_power(a, b, c->dim);
  c->share =
      b->unknowns / c->deck.unknowns * pow(wanted / c->deck.error, c->dim);
  return OK;
}

/* The job on a mesh of those sizes, read into *in; eta: NULL, or *eta is new,
 * [n_elem] as in trial, and the increments have no estimate. */
static status run_other(const command *c, const job_mesh *on, job_input *in,
                        double **eta, trial *t) {
  trial before = {0};
  PASS(message_log_new(&in->log));
  stage_costs(NULL, &before);
  status st = job_read(c, on, in->log, in);
  if (st == OK && eta != NULL) PASS_NEW(*eta, in->msh->n_elem);
  t->eta = eta != NULL ? *eta : NULL;
  if (st == OK) st = run_trial(in, eta == NULL, t);
  if (st != OK) message_print(in->log, stderr);
  stage_costs(&before, t);
  return st;
}

/* The job on a mesh that is to have the error "wanted"; eta[n_elem] of *in. */
static status run_adapted(const command *c, const job_input *in,
                          const double *eta, double wanted, trial *t) {
  job_input other ENDS_BY(job_input_free) = {0};
  OWNED_NEW(double, size, in->msh->n_node);
  space_sizes(in->msh, eta, wanted, size);
  return run_other(c, &(job_mesh){.sizes = {{in->msh, size}}}, &other, NULL, t);
}

static status forecast_norm(const command *c, job_input *in, const double *eta,
                            model_of_cost *cost) {
  const int plane = cost->dim == 2;
  const double now = cost->deck.error;
  if (cost->deck.is_coarse && cost->deck.depth < 1.0)
    RAISE(ERR_UNSETTLED,
          "the estimate of the error of the mesh sees nothing, make it finer: "
          "no forecast");
  if (now + cost->deck.time <= wanted_errors[N_WANTED - 1]) {
    print_table(cost);
    return OK;
  }
  double wanted = now / (plane ? 3.0 : 1.6);
  PASS(run_adapted(c, in, eta, now / (plane ? 1.5 : 1.2), &cost->coarse));
  PASS(run_adapted(c, in, eta, wanted, &cost->fine));
  for (int k = 0; k < MORE && !falls(cost); ++k) {
    cost->coarse = cost->fine;
    wanted /= plane ? 2.0 : 1.3;
    PASS(run_adapted(c, in, eta, wanted, &cost->fine));
  }
  PASS(fit(cost, wanted));
  print_table(cost);
  print_fit(cost);
  return OK;
}

/* ---- goals --------------------------------------------------------------- */

/* A mesh for the goals, the run on it. */
typedef struct stand {
  job_input in;
  double *eta; /* [n_elem] as in trial; owned */
  trial t;
} stand;

static void stand_free(stand *s) {
  memory_free(s->eta);
  job_input_free(&s->in);
  *s = (stand){.eta = NULL};
}

/* The job on a mesh whose goals have that part of the errors of "at". */
static status run_for_goals(const command *c, const mesh_sizes *first,
                            const job_input *at, const double *eta, double part,
                            stand *s) {
  const mesh *msh = at->msh;
  OWNED_NEW(double, size, msh->n_node);
  for (int i = 0; i < msh->n_node; ++i) size[i] = HUGE_VAL;
  aims_ask(s->t.goals, part);
  PASS(aims_sizes(s->t.goals, at->m, msh, eta, size));
  return run_other(c, &(job_mesh){.sizes = {{msh, size}, *first}}, &s->in,
                   &s->eta, &s->t);
}

/* A goal on the meshes of the deck and of the last two runs, and the share of
 * the elements of the last one that it needs. */
typedef struct goal_fit {
  const pass_goal *now, *coarse, *fine;
  double share;
} goal_fit;

/* The factor that its seconds are expected within: by the order against that of
 * the second order, and where its parts cancel by their magnitude. */
static double doubt_of_goal(const model_of_cost *c, const goal_fit *g,
                            double off, double order, double unknowns) {
  const double by =
      fabs(log(g->fine->off / off)) * fabs(1.0 / order - 0.5 * c->dim);
  const double ratio =
      cpu_at(c, unknowns * exp(by), 1.0) / cpu_at(c, unknowns, 1.0);
  const double grown = pow(fmax(unknowns / c->fine.unknowns, 1.0), DOUBT);
  return LEAST_GOAL_DOUBT * grown * ratio *
         (g->fine->found.verdict == GOAL_CANCELS ? CANCELS_DOUBT : 1.0);
}

static const double levels[] = {1.0, 0.1, 0.01}; /* % */

/* 1: the error of a goal falls from pass to pass, or is less than any level. */
static int goal_falls(const pass_goal *before, const pass_goal *now) {
  return now->off < 0.99 * before->off || pass_goal_percent(now) <= levels[2];
}

/* What an error of so many % would cost. */
static void print_level(const model_of_cost *c, const goal_fit *g,
                        double percent) {
  const double full = 2.0 / c->dim;
  const double off = AIM * percent / 100.0 * fabs(g->fine->found.value);
  double order = -exponent(g->coarse->off, g->fine->off, c->coarse.unknowns,
                           c->fine.unknowns);
  order = order > 0.0 ? within(0.5 * full, order, 1.1 * full) : full;
  const double later = c->dim == 3 ? fmax(order, full) : order;
  double unknowns =
      c->fine.unknowns * g->share * pow(g->fine->off / off, 1.0 / later);
  unknowns = fmax(unknowns, c->deck.unknowns);
  printf("; %g %%: ", percent);
  if (pass_goal_percent(g->now) <= percent)
    printf("reached already");
  else if (!goal_falls(g->coarse, g->fine))
    printf("not known from meshes so coarse");
  else if (unknowns > MOST_UNKNOWNS)
    printf("out of reach");
  else
    printf("%.2g s, %.2g MB, %.2g unknowns, within %.2g",
           cpu_of_deck(c) + 2.0 * cpu_at(c, unknowns, 1.0),
           bytes_at(c, unknowns) / 1048576.0, unknowns,
           doubt_of_goal(c, g, off, order, unknowns));
}

/* n: runs after that of the deck. */
static status print_goals(const model_of_cost *c, aims *a, const model *m,
                          const mesh *msh, int n) {
  printf("  goals: TARGET= of each alone\n");
  for (int i = 0; i < m->n.goal; ++i) {
    const pass_goal *row = aims_rows(a) + i;
    goal_fit g = {row, row + (n - 1) * m->n.goal, row + n * m->n.goal, 1.0};
    printf("  %s: ", m->accuracy.goals[i].name);
    if (isnan(g.fine->off)) {
      printf("%s\n", goal_verdict_text(g.fine->found.verdict));
      continue;
    }
    PASS(aims_share(a, msh, i, &g.share));
    if (isnan(g.now->off))
      printf("no estimate now");
    else
      printf("%.2g %% now", pass_goal_percent(g.now));
    for (size_t k = 0; k < sizeof levels / sizeof *levels; ++k)
      print_level(c, &g, levels[k]);
    printf("\n");
  }
  return OK;
}

/* 1: before the last of n passes some goal had no estimate, or its error is no
 * smaller since. */
static int is_too_early(const aims *a, const model *m, int n) {
  const pass_goal *last = aims_rows(a) + n * m->n.goal;
  int early = 0;
  for (int i = 0; i < m->n.goal; ++i)
    early |= !goal_falls(last + i - m->n.goal, last + i);
  return early;
}

/* now: of the mesh of the deck, with its goals. Where some goal had no
 * estimate, or the error of one does not fall, another mesh follows, up to
 * GROWN times the first. */
static status forecast_goals(const command *c, job_input *in, trial *now) {
  enum { LEAST = 2, MOST = 4, GROWN = 8 };
  static const double part = 0.3;
  status st = OK;
  OWNED_NEW(double, length, in->msh->n_node);
  stand s[2] = {{.t.goals = now->goals}, {.t.goals = now->goals}};
  model_of_cost cost = {.dim = in->m->dim, .deck = *now};
  PASS(plan_sizes_find(in->m, in->msh, 0, &cost.sizes));
  int n = 0;
  space_lengths(in->msh, length);
  const mesh_sizes first = {in->msh, length};
  while (n < LEAST || (n < MOST && is_too_early(now->goals, in->m, n) &&
                       s[(n + 1) % 2].t.unknowns < GROWN * now->unknowns)) {
    stand *to = &s[n % 2], *from = &s[(n + 1) % 2];
    stand_free(to);
    to->t.goals = now->goals;
    TRY(run_for_goals(c, &first, n > 0 ? &from->in : in,
                      n > 0 ? from->eta : now->eta, part, to));
    ++n;
  }
  cost.coarse = s[n % 2].t;
  cost.fine = s[(n + 1) % 2].t;
  cost.contact = contact_power(&cost.coarse, &cost.fine, cost.dim);
  TRY(print_goals(&cost, now->goals, in->m, s[(n + 1) % 2].in.msh, n));
done:
  stand_free(&s[0]);
  stand_free(&s[1]);
  return st;
}

status forecast_print(const command *c, job_input *in) {
  OWNED aims *goals = NULL;
  model_of_cost cost = {.dim = in->m != NULL ? in->m->dim : 2};
  if (in->problem != NULL)
    RAISE(ERR_DECK,
          "--estimate-cost refines the mesh: the deck must name one in *MESH, "
          "FILE=");
  if (job_keeps_mesh(in->m))
    RAISE(ERR_DECK,
          "--estimate-cost refines the mesh: a .msh with values at its nodes "
          "(FILE=) is not refined, give them as expressions");
  if (job_is_geo(in->m)) mesh_gmsh_load();
  OWNED_NEW(double, eta, in->msh->n_elem);
  if (in->m->n.goal > 0) PASS(aims_new(in->m, 1, &goals));
  PASS(plan_sizes_find(in->m, in->msh, 0, &cost.sizes));
  cost.deck.goals = goals;
  cost.deck.eta = eta;
  PASS(run_trial(in, 1, &cost.deck));
  stage_costs(NULL, &cost.deck);
  PASS(forecast_norm(c, in, eta, &cost));
  return in->m->n.goal > 0 ? forecast_goals(c, in, &cost.deck) : OK;
}
