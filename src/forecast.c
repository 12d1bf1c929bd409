/*
 * What *ACCURACY, TARGET= would cost, from a run on the mesh of the deck and
 * two on meshes that its errors ask for (space_sizes), some finer each. The
 * error of the mesh goes like N^(-p) on such meshes, p from the two; the CPU
 * seconds of each stage like a power of N, the number of unknowns: linear but
 * for the ordering and factorisation (1.2 in the plane, 1.75 in space: nested
 * dissection as measured with condense from 1e4 to 1e6 unknowns) and the dense
 * work on the contact unknowns, of which there are N^((dim-1)/dim) and whose
 * cube it costs in part: N^1.25 and N^1.7. Where the increments have more than
 * their share, their number, and what each costs, grows like their error falls.
 * To this come the passes before: the first, and one more if the target is far.
 */
#include "forecast.h"

#include "accuracy/space.h"
#include "base/memory.h"
#include "base/timer.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct trial {
  double unknowns, energy, error, time; /* -, J, -, - at the largest energy   */
  double cpu[STAGE_COUNT], bytes; /* s; at most held                         */
  double *eta; /* [n_elem] shares of the elements there, or NULL; borrowed    */
  int n_elem;
} trial;

static status see_ready(void *ctx, const setup_facts *facts,
                        const contact_surface *surface) {
  trial *t = ctx;
  (void)surface;
  t->unknowns = (double)facts->info.unknowns;
  return OK;
}

static status see_increment(void *ctx, const state *s) {
  trial *t = ctx;
  if (s->energy.strain < t->energy) return OK;
  t->energy = s->energy.strain;
  t->error = s->mesh_error.relative;
  if (t->eta != NULL)
    memcpy(t->eta, s->elem_error, (size_t)t->n_elem * sizeof *t->eta);
  t->time = isfinite(s->time_error.relative) ? s->time_error.relative : 0.0;
  return OK;
}

/* One run whose results nobody writes; eta[n_elem] or NULL: shares of the
 * elements in its error. */
static status run_trial(job_input *in, trial *t, double *eta) {
  status st = OK;
  int unsettled = 0;
  const history_sink sink = {
      .ctx = t, .ready = see_ready, .increment = see_increment};
  t->energy = -1.0;
  t->eta = eta;
  t->n_elem = in->msh->n_elem;
  for (int i = 0; i < in->m->n_step; ++i)
    in->m->steps[i].mesh_error = in->m->steps[i].time_error = 1;
  in->m->effects |= EFFECT_MESH_ERROR | EFFECT_TIME_ERROR;
  TRY(history_run(in->m, in->msh, &sink, &unsettled));
  t->bytes = (double)memory_peak();
done:
  return st;
}

/* CPU seconds of the stages since "before". */
static void stage_costs(const trial *before, trial *t) {
  for (int i = 0; i < STAGE_COUNT; ++i)
    t->cpu[i] =
        timer_cost((stage)i).cpu - (before != NULL ? before->cpu[i] : 0);
}

/* 1: paid once a run, not once an increment. */
static int is_of_run(int s) {
  switch (s) {
    case STAGE_DECK:
    case STAGE_MESH:
    case STAGE_SURFACE:
    case STAGE_ASSEMBLY:
    case STAGE_ORDERING:
    case STAGE_FACTOR:
    case STAGE_CONDENSE:
      return 1;
    default:
      return 0;
  }
}

static double power_of(stage s, int dim) {
  switch (s) {
    case STAGE_ORDERING:
    case STAGE_FACTOR:
    case STAGE_CONDENSE:
      return dim == 2 ? 1.2 : 1.75;
    case STAGE_CONTACT:
    case STAGE_ESTIMATE:
      return dim == 2 ? 1.25 : 1.7;
    default:
      return 1.0;
  }
}

/* As in target.c: what the increments may leave of the target, what the mesh is
 * aimed at, how far a pass goes. */
static const double TIME_SHARE = 0.1, AIM = 0.93, REACH = 8.0, PASS = 4.0;

static const double MOST_UNKNOWNS = 1e9;

typedef struct model_of_cost {
  int dim;
  trial deck, coarse, fine;
  double order; /* of the error in N                                          */
} model_of_cost;

/* Unknowns of a mesh with that error. */
static double unknowns_at(const model_of_cost *c, double error) {
  return c->fine.unknowns * pow(c->fine.error / error, 1.0 / c->order);
}

/* How many times the increments of the deck the target asks for. */
static double increments_at(const model_of_cost *c, double error) {
  double share = TIME_SHARE * error;
  return c->fine.time > share ? c->fine.time / (AIM * share) : 1.0;
}

/* CPU seconds of a run with N unknowns and that many times the increments. */
static double cpu_at(const model_of_cost *c, double unknowns, double times) {
  const trial *b = &c->fine;
  double sum = 0.0, ratio = unknowns / b->unknowns;
  for (int i = 0; i < STAGE_COUNT; ++i)
    sum += b->cpu[i] * pow(ratio, power_of((stage)i, c->dim)) *
           (is_of_run(i) ? 1.0 : times);
  return sum;
}

static double sum_of(const trial *t) {
  double sum = 0.0;
  for (int i = 0; i < STAGE_COUNT; ++i) sum += t->cpu[i];
  return sum;
}

/* CPU seconds of all passes to that error. */
static double price_of(const model_of_cost *c, double error) {
  double cpu = sum_of(&c->deck), times = increments_at(c, error);
  double aim = AIM * error, now = c->deck.error;
  if (now <= error && times <= 1.0) return cpu;
  while (now > REACH * aim) {
    now /= PASS;
    cpu += cpu_at(c, unknowns_at(c, now), times);
  }
  double unknowns = now > error ? unknowns_at(c, aim) : c->deck.unknowns;
  return cpu + cpu_at(c, unknowns, times);
}

static double bytes_at(const model_of_cost *c, double unknowns) {
  double ratio = unknowns / c->fine.unknowns;
  double power = c->dim == 2 ? 1.05 : 4.0 / 3.0;
  return c->fine.bytes * pow(ratio, power);
}

static void print_row(const model_of_cost *c, double error) {
  int there = error >= c->deck.error;
  double unknowns = there ? c->deck.unknowns : unknowns_at(c, AIM * error);
  if (unknowns > MOST_UNKNOWNS) {
    printf("  %8.3g %12s\n", 100 * error, "out of reach");
    return;
  }
  printf("  %8.3g %12.3g %12.3g %10.3g %12.3g%s\n", 100 * error, unknowns,
         increments_at(c, error), price_of(c, error),
         there ? c->deck.bytes / 1048576.0 : bytes_at(c, unknowns) / 1048576.0,
         there ? "  the mesh of the deck does" : "");
}

static void print_table(const model_of_cost *c) {
  static const double wanted[] = {0.1, 0.03, 0.01, 0.003, 0.001};
  printf("  %8s %12s %12s %10s %12s\n", "error[%]", "unknowns", "increments*",
         "cpu[s]", "memory[MB]");
  for (size_t k = 0; k < sizeof wanted / sizeof *wanted; ++k)
    print_row(c, wanted[k]);
  printf(
      "  * times those of the deck. CPU of all passes of TARGET=.\n"
      "  mesh of the deck: %.3g %% with %.0f unknowns; increments: %.3g %%\n"
      "  error ~ unknowns^(-%.2f) (size^%.2f), fitted to %.3g %% with %.0f "
      "and %.3g %% with %.0f\n",
      100 * c->deck.error, c->deck.unknowns, 100 * c->fine.time, c->order,
      c->order * c->dim, 100 * c->coarse.error, c->coarse.unknowns,
      100 * c->fine.error, c->fine.unknowns);
}

/* The job on a mesh that is to have the error "wanted"; eta[n_elem] of *in. */
static status run_adapted(const command *c, const job_input *in,
                          const double *eta, double wanted, trial *t) {
  status st = OK;
  double *size = NULL;
  job_input other = {0};
  trial before = {0};
  NEW(size, in->msh->n_node);
  TRY(message_log_new(&other.log));
  space_sizes(in->msh, eta, wanted, size);
  stage_costs(NULL, &before);
  TRY(job_read(c, &(job_mesh){.old = in->msh, .size = size}, other.log,
               &other));
  TRY(run_trial(&other, t, NULL));
  stage_costs(&before, t);
done:
  if (st != OK && other.log != NULL) message_print(other.log, stderr);
  job_input_free(&other);
  memory_free(size);
  return st;
}

status forecast_print(const command *c, job_input *in) {
  status st = OK;
  double *eta = NULL;
  model_of_cost cost = {.dim = in->m != NULL ? in->m->dim : 2};
  if (in->problem != NULL || !job_is_geo(in->m))
    FAIL(ERR_DECK,
         "--estimate-cost meshes the geometry anew: the deck must name "
         "a .geo in *MESH, FILE=");
  mesh_gmsh_load();
  NEW(eta, in->msh->n_elem);
  TRY(run_trial(in, &cost.deck, eta));
  stage_costs(NULL, &cost.deck);
  int plane = cost.dim == 2;
  double now = cost.deck.error;
  TRY(run_adapted(c, in, eta, now / (plane ? 1.5 : 1.2), &cost.coarse));
  TRY(run_adapted(c, in, eta, now / (plane ? 3.0 : 1.6), &cost.fine));
  cost.order = log(cost.coarse.error / cost.fine.error) /
               log(cost.fine.unknowns / cost.coarse.unknowns);
  if (!(cost.order > 0.05))
    FAIL(
        ERR_UNSETTLED,
        "the error of the mesh does not fall: %.3g %% with %.0f unknowns, %.3g "
        "%% with %.0f; no forecast",
        100 * cost.coarse.error, cost.coarse.unknowns, 100 * cost.fine.error,
        cost.fine.unknowns);
  print_table(&cost);
done:
  memory_free(eta);
  return st;
}
