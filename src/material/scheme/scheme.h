/*
 * Integrators of inelastic strains: for the points (elements) whose law flows,
 *   d(e^i)/dt = Phi_1(sigma, e^i, alpha), d(alpha)/dt = Phi_2(sigma, alpha)
 * where sigma of a given e^i is the equilibrium of the whole body with its
 * contacts (CPR98 3.14-3.20). An integrator works on points and calls the body;
 * the body has elements, contact and friction, with the position of stick of
 * the last accepted state in all stages of a step.
 *
 * One row in scheme_list per integrator.
 */
#pragma once

#include "material/law/law.h"

/* Points of one material and elasticity. */
typedef struct flow_kind {
  const law_card *law; /* borrowed */
  law_elastic elastic; /* at the last temperature requested: flow_heat() */
  int n_alpha;
  unsigned varies; /* law_varies(), and whether the elasticity depends on
                      temperature; 0: all of it holds for ever */
  double *value;   /* [law_n_value()] */
  double speed;
} flow_kind;

/* Work on points whose law has a threshold, "flows" in its row. */
typedef struct flow_tally {
  double asked;   /* times that one was to be evaluated */
  double resting; /* of these, left out: exactly no rate */
} flow_tally;

typedef struct flow {
  int n, ns, n_kind;
  int most_alpha;    /* of a point */
  flow_kind *kind;   /* [n_kind] */
  int *kind_id;      /* [n] */
  size_t *alpha_at;  /* [n+1] where alpha of a point starts */
  double *weight;    /* [n] volume, m3 */
  flow_tally *tally; /* so far, owned */
} flow;

/* The state of the points at a time. e = total less thermal strain, so that
 * sigma = E (e - ei). */
typedef struct flow_state {
  double t;                       /* s */
  double *e, *ei, *sigma, *alpha; /* [ns*n] -, -, Pa; [alpha_at[n]] */
  double *temperature;            /* [n] */
} flow_state;

/* flow.c. Kinds are filled by the caller: n_kind rows, then flow_new_kind for
 * each, flow_new_points once kind_id is known. What they request is the
 * caller's, who OWNS it. */
status flow_new_kind(flow_kind *k, const law_card *law,
                     const law_elastic *elastic);
status flow_new_points(flow *x, int n, const int *kind_id);
status flow_state_new(const flow *x, flow_state *s);
void flow_state_copy(const flow *x, const flow_state *from, flow_state *to);
/* The elasticity of a kind at a temperature, into kind->elastic. ERR_DECK: the
 * constants are none there. */
status flow_heat(flow_kind *kind, double temperature);
/* A law at a time and temperature, without the state; "value" has space for
 * FLOW_VALUE_MAX coefficients. */
enum { FLOW_VALUE_MAX = 512 };
status flow_coefficients(flow_kind *kind, double t, double temperature,
                         double *value, law_point *p);
/* The same at the temperature of a point; ERR_DECK: it is not above absolute
 * zero, which the law counts from. */
status flow_at_point(flow_kind *kind, double t, double temperature,
                     double *value, law_point *p);
/* A law without strain at time t under a stress p.sigma that is still to be
 * set, in the place of the one before (all-zero: none). */
typedef struct law_sample {
  flow_kind kind;
  double value[FLOW_VALUE_MAX];
  law_point p;
} law_sample;
status law_sample_at(const elastic_table *elastic, const law_card *law,
                     kinematics kin, double t, law_sample *x);
void law_sample_free(law_sample *x);
/* Test of a point: 1 if it flows, counted. */
int flow_goes_on(const flow *x, const law_point *p);
/* Rates at a state: ei_rate[ns*n], alpha_rate[alpha_at[n]]; *power gets what is
 * dissipated, W. dt: step being made. */
status flow_rates(const flow *x, const flow_state *s, double dt,
                  double *ei_rate, double *alpha_rate, double *power);
/* Points that flow at one end of a step alone: the trapezoidal rule less what
 * has flowed, d[ns*n], -; zero elsewhere. */
status flow_turning(const flow *x, const flow_state *old, const flow_state *now,
                    double *d);
/* The fastest rate of all points for a step dt, 1/s. */
status flow_fastest(const flow *x, const flow_state *s, double dt,
                    double *rate);
/* Root mean square over the volume of [ns*n] values. */
double flow_norm(const flow *x, const double *v);
/* Of the points from, ..., to - 1: energy stored by alpha and ei, J; the square
 * of the elastic strains over their volume, m3, for flow_root. */
status flow_add_stored(const flow *x, const flow_state *s, int from, int to,
                       double *energy);
status flow_add_elastic(const flow *x, const flow_state *s, int from, int to,
                        double *sum);
/* Root of a sum over the volume of all points. */
double flow_root(const flow *x, double sum);

/* Law of the points for one linear solve: sigma = sigma_k + D (e - e_k). */
typedef struct flow_tangent {
  double key;              /* > 0: D is constant, and the same whenever key and
                              exact are; 0: of this solve alone */
  int exact;               /* D of EXPONENTIAL, else of THETA */
  int elastic;             /* D = E: the matrix of the elastic body */
  const double *D;         /* key > 0: [ns*ns*n_kind], else [ns*ns*n]; Pa */
  const double *sigma, *e; /* [ns*n] sigma_k, e_k; key > 0: those that
                              linear_predict makes, and of scheme_call.old */
  double tol;              /* that the contact is solved to at least, -; 0: that
                              of the deck */
} flow_tangent;

struct scheme_call;

/* What an integrator requires of the body. *settled: 0 if the contact problem
 * was not solved to its tolerance. */
typedef struct flow_body {
  void *ctx;
  /* Equilibrium at s->t with s->ei: e, sigma, temperature. */
  status (*equilibrium)(void *ctx, flow_state *s, int *settled);
  /* Loads and temperatures at s->t, before "linear". */
  status (*begin)(void *ctx, flow_state *s);
  /* Equilibrium with the linear law: e. */
  status (*linear)(void *ctx, const flow_tangent *law, flow_state *s,
                   int *settled);
  /* One step of constant laws: linear_predict of all points, the equilibrium
   * with the linear law, e of it, linear_follow. */
  status (*step)(void *ctx, const flow_tangent *law,
                 const struct scheme_call *a, int *settled);
  /* Energy of strains that are rounding of the displacements, J. */
  double (*rounding)(void *ctx);
} flow_body;

typedef struct scheme_step {
  double t;         /* end of the step: old->t + dt to rounding, s */
  double dt, theta; /* s, - */
  double fastest;   /* rate up to which an explicit step is stable, 1/s */
  int initial;      /* 1: iterate with the elastic matrix */
  double tol;       /* of the contact; most of the iteration on stresses, - */
} scheme_step;

typedef struct scheme_result {
  int settled;       /* 0: no result to continue with */
  double unstable;   /* rate of a stage beyond what p->fastest allows, 1/s, not
                        settled then; or 0 */
  int stuck;         /* point that has no state at the end, from 1; or 0 */
  int iterations;    /* linear solves of an implicit step */
  double error;      /* of strains, root mean square, -; < 0: not estimated */
  double dissipated; /* J, in the quadrature of the scheme */
} scheme_result;

typedef struct scheme_work scheme_work;

/* One step: from old, which stays, to now. */
typedef struct scheme_call {
  const flow *x;
  const scheme_step *p;
  const flow_body *b;
  scheme_work *w;
  const flow_state *old;
  flow_state *now;
  scheme_result *out;
} scheme_call;

/* Points from, ..., to - 1 in a step of constant laws: e^i, alpha, sigma of now
 * as if e of old stayed; and what e of now adds to them, with the energy
 * dissipated into a->out. */
void linear_predict(const scheme_call *a, int from, int to);
void linear_follow(const scheme_call *a, int from, int to);

typedef struct scheme {
  const char *name, *reference, *help;
  int order;
  int linear_only; /* laws with a constant Jacobian only */
  double theta;    /* fixed by the row; 0: THETA=, or no such parameter */
  double limit;    /* stable |rate| dt; 0: none, or theta */
  int has_theta;
  int estimates; /* scheme_result.error is set */
  status (*advance)(const scheme_call *a);
  /* Within a step that has been made, old->t < mid->t < now->t: e^i and alpha
   * of mid to the order of the scheme. */
  status (*between)(const scheme_call *a, flow_state *mid);
} scheme;

extern const scheme *const scheme_list[];    /* NULL at the end */
const scheme *scheme_find(const char *name); /* case ignored; or NULL */
status scheme_work_new(scheme_work **out);   /* memory_free */
/* What the laws have dissipated in a step up to mid->t, J. */
status scheme_dissipated(const scheme_call *a, double t, double *energy);
/* Largest |rate| dt that the scheme damps; HUGE_VAL: no limit. */
double scheme_limit(const scheme *s, double theta);
/*
 * Q[ns*ns*n] = d(e^i)/d(sigma) of the ends of a step from old to now by the
 * rule of THETA, for given stresses, 1/Pa; *largest of the points, in the norms
 * |e^i|^2 = e^i E e^i and |sigma|^2 = sigma inv(E) sigma, -. Both states have
 * their stresses and temperatures. ERR_SINGULAR, ERR_MEMORY.
 */
status flow_compliance(const flow *x, const scheme_step *p,
                       const flow_state *old, const flow_state *now, double *Q,
                       double *largest);
/* 1 if all laws of the points are linear with constant coefficients. */
int flow_is_constant(const flow *x);
