/*
 * The list of integrators and their workspace.
 *
 * The theta-method takes the rates at the theta-point, x_th = (1 - theta) x_old
 * + theta x_new: theta = 1/2 is the implicit midpoint rule on the line between
 * the ends of the step (MIDPOINT), theta = 1 implicit Euler (BACKWARD).
 */
#include "material/scheme/work.h"

#include "base/memory.h"

#include <math.h>
#include <strings.h>

void add_scaled(size_t n, const double *x, double a, const double *v,
                double *y) {
  for (size_t i = 0; i < n; ++i) y[i] = x[i] + a * v[i];
}

status need(double **array, size_t n) {
  if (*array == NULL) PASS_NEW(*array, n);
  return OK;
}

status scheme_work_new(scheme_work **out) {
  PASS_NEW(*out, 1);
  return OK;
}

void linear_map_free(linear_map *m) { RELEASE(m->P, m->Q0, m->Q1, m->Q); }

void scheme_work_free(scheme_work *w) {
  if (w == NULL) return;
  for (int i = 0; i < STAGES; ++i) {
    RELEASE(w->ei_rate[i], w->alpha_rate[i]);
  }
  for (int i = 0; w->map != NULL && i < w->n_kind; ++i)
    linear_map_free(&w->map[i]);
  RELEASE(w->map, w->D_kind, w->sigma_k, w->e_k, w->linear, w->D, w);
}

static status theta_advance(const scheme_call *a) {
  if (!flow_is_constant(a->x) || a->p->initial) return newton_advance(a);
  return linear_advance(a, 0);
}

static status exponential_advance(const scheme_call *a) {
  return linear_advance(a, 1);
}

/* The real interval of stability of the classical Runge-Kutta method: the root
 * of 1 - z + z^2/2 - z^3/6 + z^4/24 = 1. */
static const double rk4_limit = 2.78529356340528;

static const scheme euler = {
    .name = "EULER",
    .reference = "CPR98 3.2",
    .help = "explicit, order 1: one equilibrium a step",
    .order = 1,
    .limit = 2.0,
    .advance = euler_advance,
    .between = hermite_between};
static const scheme heun = {
    .name = "HEUN",
    .reference = "Heun 1900",
    .help = "explicit, order 2, with an estimate of its error: two equilibria",
    .order = 2,
    .limit = 2.0,
    .estimates = 1,
    .advance = heun_advance,
    .between = hermite_between};
static const scheme rk4 = {.name = "RK4",
                           .reference = "Kutta 1901",
                           .help = "explicit, order 4: four equilibria",
                           .order = 4,
                           .limit = rk4_limit,
                           .advance = rk4_advance,
                           .between = hermite_between};
static const scheme theta = {
    .name = "THETA",
    .reference = "Dahlquist 1975, one-leg methods",
    .help = "implicit, rates at (1 - THETA) old + THETA new; order 2 if 0.5",
    .order = 1,
    .has_theta = 1,
    .advance = theta_advance,
    .between = hermite_between};
static const scheme midpoint = {
    .name = "MIDPOINT",
    .reference = "Dahlquist 1975, one-leg methods",
    .help = "THETA with 0.5: order 2, no damping of what is fast",
    .order = 2,
    .theta = 0.5,
    .advance = theta_advance,
    .between = hermite_between};
static const scheme backward = {
    .name = "BACKWARD",
    .reference = "implicit Euler",
    .help = "THETA with 1: order 1, damps all that is fast",
    .order = 1,
    .theta = 1.0,
    .advance = theta_advance,
    .between = hermite_between};
static const scheme exponential = {
    .name = "EXPONENTIAL",
    .reference =
        "Zienkiewicz, Watson, King 1968; Taylor, Pister, Goudreau 1970",
    .help = "exact for linear laws if strains are linear over a step; order 2",
    .order = 2,
    .linear_only = 1,
    .theta = 0.5,
    .advance = exponential_advance,
    .between = exponential_between};

const scheme *const scheme_list[] = {&euler,    &heun,     &rk4,         &theta,
                                     &midpoint, &backward, &exponential, NULL};

const scheme *scheme_find(const char *name) {
  for (int k = 0; scheme_list[k] != NULL; ++k)
    if (strcasecmp(scheme_list[k]->name, name) == 0) return scheme_list[k];
  return NULL;
}

double scheme_limit(const scheme *s, double th) {
  if (s->limit > 0.0) return s->limit;
  if (s->linear_only || th >= 0.5) return HUGE_VAL;
  return 2.0 / (1.0 - 2.0 * th);
}
