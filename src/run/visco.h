/*
 * Elements whose law flows, in the running state; shared by points.c,
 * tangent.c, visco.c, shadow.c, path.c and src/run/history/theorems.c only.
 */
#pragma once

#include "run/run.h"

enum { SLOTS = 4 };

/* Sums over the points for an increment and its end, computed during a step of
 * constant laws. */
typedef struct point_sums {
  int known;                 /* 1: those of r->strains.visco->old and now,
                                r->old and r->now */
  double thermal, inelastic; /* J, work of the middle stress on the strains */
  double held;               /* J, what the strains would store if they were
                                held */
  double strain;             /* J, energy of the stresses */
  double stored;             /* J, stored by the laws */
  double elastic;            /* m3, square of the elastic strains */
} point_sums;

struct visco {
  flow x;
  int *place; /* [x.n] of a point in r->strains.eigen */
  int *elem;  /* [x.n] */
  flow_state old, now;
  flow_state middle; /* between two halves of a step */
  double *fine;      /* [ns*x.n] e^i after them */
  point_sums sums;
  scheme_work *work;
  scheme_result result;
  matrices slot[SLOTS]; /* constant tangents; the last used are kept */
  matrices fresh;       /* a tangent of its own */
  long clock;
  double length[SLOTS]; /* of the last different steps, s */
  unsigned n_length;
  double *E;         /* [ns*ns*(r->body.moduli.n + x.n)] of "fresh" */
  double *stress;    /* [ns*r->strains.eigen.n] Pa */
  int E_is_fresh;    /* that of "fresh" */
  int *section_id;   /* [n_elem] sections of their own for the points */
  kinematics *kin;   /* [r->body.moduli.n + x.n] */
  double *thickness; /* the same */
  double stages;     /* fastest rate of stages that were not stable since the
                        last increment, 1/s; or 0 */
  double largest;    /* largest norm of the elastic strains so far */
  struct {
    const step *ringing; /* of this step */
    int locking, stuck;  /* 1: P4016, P4017 */
  } reported;            /* so far */
};

/* Where the components of item k start among [ns*n]. */
static inline size_t visco_at(const run *r, int k) {
  return (size_t)r->m->ns * (size_t)k;
}

/* What an increment starts from, of the contact. */
typedef struct start_point {
  double t;
  double *uc, *rc, *motion; /* [m] m, N, m */
} start_point;

/* visco.c. Workspace; that of an equilibrium; r->old is at the point until the
 * returned state is restored. */
status start_point_new(const run *r, start_point *p);
void start_point_copy(const run *r, const equilibrium *e, start_point *p);
equilibrium start_point_use(run *r, const start_point *p);

/* visco.c: by the integrator of the step from another state than that of the
 * run (its t is not read: r->old.t counts) to t, into r->now and *to. */
status visco_advance_from(run *r, flow_state *from, double t, flow_state *to);
/* The same of an increment in which nothing flows. */
status visco_settle_from(run *r, const flow_state *from, double t,
                         flow_state *to);
/* Order of the integrator of a *VISCO step: that of THETA depends on theta. */
int visco_order(const step *s);
/* (*d)[ns*x.n], new: the trapezoidal rule less r->now of points that flow at
 * one end of the increment alone, else zero; NULL where the integrator takes a
 * rate at the end. */
status visco_turning(const run *r, double **d);
status visco_keep_flow(const flow *x, flow_state *s, archive *a,
                       const char *group);

/* points.c: temperatures of the points of an equilibrium into s. */
void visco_temperatures(const run *r, const equilibrium *e, flow_state *s);
/* Strains, less the thermal ones, of an equilibrium into s->e; stresses. */
void visco_strains(run *r, const equilibrium *e, flow_state *s);
/* Items item, ..., item + n_item - 1 of r->strains.eigen and the points among
 * them, which are points in turn from "point" on. */
typedef struct visco_part {
  int item, n_item, point, n_point;
} visco_part;
/* The next part of all items, from a part of zeros; 0 if there is none. Few
 * enough for the cache; all at once where clusters average. */
int visco_next_part(const run *r, visco_part *p);
/* v->now.e of the points from r->now.u: less the thermal strains. */
void visco_part_strains(run *r, const visco_part *p);
/* Of a part whose v->now is known: e0 and sigma of r->now, v->sums. */
status visco_part_sums(run *r, const visco_part *p);
/* Warns, once, when v->now has crept until its elements lock. */
void visco_warn_locking(run *r);
/* points.c: the first increment that is taken though the law of an element has
 * found no state is reported. */
void visco_warn_stuck(run *r);

/* tangent.c: equilibrium of r->now with the linear law of the points, with a
 * matrix of that tangent; read r->solving.report. */
status tangent_solve(run *r, const flow_tangent *law);
/* The same for a step of constant laws, with v->sums. */
status tangent_step(run *r, const flow_tangent *law, const scheme_call *a);
/* The keys of the constant tangents, which are made again when they are used,
 * and which of the matrices is in use. */
status tangent_keep(run *r, archive *a);
