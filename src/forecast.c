/*
 * Cost as a function of the error. The error of the mesh goes like N^(-p), p
 * from the two runs; the CPU seconds of each stage like a power of N, the
 * number of unknowns: linear but for the ordering and factorisation (1.2 in the
 * plane, 1.75 in space: nested dissection as measured with condense from 1e4 to
 * 1e6 unknowns) and the dense work on the contact unknowns, of which there are
 * N^((dim-1)/dim) and whose cube it costs in part: N^1.25 and N^1.7. What gmsh
 * takes to start is told from its work by the two runs.
 */
#include "forecast.h"

#include "accuracy/space.h"
#include "base/memory.h"
#include "base/timer.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct trial {
  double unknowns, energy, error; /* -, J, - at the largest energy            */
  double cpu[STAGE_COUNT], bytes; /* s; at most held                         */
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
  return OK;
}

/* One run whose results nobody writes. */
static status run_trial(job_input *in, trial *t) {
  status st = OK;
  int unsettled = 0;
  const history_sink sink = {
      .ctx = t, .ready = see_ready, .increment = see_increment};
  t->energy = -1.0;
  for (int i = 0; i < in->m->n_step; ++i) in->m->steps[i].mesh_error = 1;
  in->m->effects |= EFFECT_MESH_ERROR;
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

typedef struct model_of_cost {
  int dim;
  trial coarse, fine;
  double order; /* of the error in N                                          */
} model_of_cost;

/* CPU seconds for N unknowns. */
static double cpu_at(const model_of_cost *c, double unknowns) {
  const trial *a = &c->coarse, *b = &c->fine;
  double sum = 0.0;
  for (int i = 0; i < STAGE_COUNT; ++i) {
    double start = 0.0;
    if (i == STAGE_MESH) /* a + b N through both runs */
      start = (a->cpu[i] * b->unknowns - b->cpu[i] * a->unknowns) /
              (b->unknowns - a->unknowns);
    start = fmin(fmax(start, 0.0), b->cpu[i]);
    sum += start + (b->cpu[i] - start) *
                       pow(unknowns / b->unknowns, power_of((stage)i, c->dim));
  }
  return sum;
}

static double bytes_at(const model_of_cost *c, double unknowns) {
  double ratio = unknowns / c->fine.unknowns;
  double power = c->dim == 2 ? 1.05 : 4.0 / 3.0;
  return c->fine.bytes * pow(ratio, power);
}

static void print_row(const model_of_cost *c, const char *what,
                      double unknowns) {
  double error = c->fine.error * pow(unknowns / c->fine.unknowns, -c->order);
  printf("  %-22s %12.3g %10.3g %10.3g %12.3g\n", what, unknowns, 100 * error,
         cpu_at(c, unknowns), bytes_at(c, unknowns) / 1048576.0);
}

static void print_table(const model_of_cost *c) {
  static const double wanted[] = {10, 3, 1, 0.3, 0.1};
  char text[40];
  printf("  %-22s %12s %10s %10s %12s\n", "", "unknowns", "error[%]", "cpu[s]",
         "memory[MB]");
  print_row(c, "mesh of the deck", c->fine.unknowns);
  for (int k = 1; k <= 3; ++k) {
    snprintf(text, sizeof text, "%d times finer", 1 << k);
    print_row(c, text, c->fine.unknowns * pow(2.0, c->dim * k));
  }
  for (size_t k = 0; k < sizeof wanted / sizeof *wanted; ++k) {
    snprintf(text, sizeof text, "error %g %%", wanted[k]);
    print_row(c, text,
              c->fine.unknowns *
                  pow(100 * c->fine.error / wanted[k], 1.0 / c->order));
  }
  printf(
      "  error ~ unknowns^(-%.2f) (size^%.2f), from runs with %.0f and %.0f\n",
      c->order, c->order * c->dim, c->coarse.unknowns, c->fine.unknowns);
}

/* The job on a mesh twice as coarse; *in gives the sizes. */
static status run_coarse(const command *c, const job_input *in, trial *t) {
  status st = OK;
  double *size = NULL, *eta = NULL;
  job_input coarse = {0};
  NEW(size, in->msh->n_node);
  NEW(eta, in->msh->n_elem);
  TRY(message_log_new(&coarse.log));
  space_sizes(in->msh, eta, 1.0,
              size); /* no error at all: as coarse as it gets */
  trial before = {0};
  stage_costs(NULL, &before);
  TRY(job_read(c, &(job_mesh){.old = in->msh, .size = size}, coarse.log,
               &coarse));
  TRY(run_trial(&coarse, t));
  stage_costs(&before, t);
done:
  if (st != OK && coarse.log != NULL) message_print(coarse.log, stderr);
  job_input_free(&coarse);
  memory_free(size);
  memory_free(eta);
  return st;
}

status forecast_print(const command *c, job_input *in) {
  status st = OK;
  model_of_cost cost = {.dim = in->m != NULL ? in->m->dim : 2};
  if (in->problem != NULL || !job_is_geo(in->m))
    FAIL(ERR_DECK,
         "--estimate-cost meshes the geometry anew: the deck must name "
         "a .geo in *MESH, FILE=");
  TRY(run_trial(in, &cost.fine));
  stage_costs(NULL, &cost.fine);
  TRY(run_coarse(c, in, &cost.coarse));
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
  return st;
}
