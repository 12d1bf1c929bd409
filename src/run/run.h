/*
 * The running state of history_run, shared by the files of this folder, of
 * src/run/setup and of src/run/history.
 */
#pragma once

#include "base/text.h"
#include "contact/active.h"
#include "run/effect.h"

/* One equilibrium: displacements, contact forces, loads, and its time. */
typedef struct equilibrium {
  double t;         /* s */
  double *u;        /* [dim*n_node] m */
  double *F;        /* [dim*n_node] loads, N */
  double *reaction; /* [dim*n_node] forces of the supports, N */
  double *uc, *rc;  /* [dim*n] contact frame, m, N */
  double *motion;   /* [dim*n] of the obstacles at the nodes since 0 s, contact
                       frame, m; NULL: none moves */
  double *temperature; /* [n_elem] or NULL: no thermal strain */
  /* [ns*n] of r->strains.eigen; NULL where nothing but laws flows: the points
   * have e^i and stress (visco.h). */
  double *thermal;    /* thermal strains, - */
  double *e0, *sigma; /* all strains without stress, -; Pa */
  double *elastic;    /* [ns*n] the rest; NULL: moduli stay */
  energies energy;
  /* J, Pa, -: largest so far; the last two, of stresses and of strains without
   * stress, where rounding was looked at. */
  double peak_energy, peak_stress, peak_strain;
  double kept; /* J, of laws in elastic constants */
} equilibrium;

typedef struct shadow shadow; /* shadow.c */
typedef struct visco visco;   /* visco.h */

/* A condensed stiffness with its contact solver. */
typedef struct matrices {
  double key; /* of the tangent (scheme.h); 0: none */
  int exact;  /* the same */
  long used;  /* when it was last used */
  stiffness *k;
  condensed *c;
  double *E;              /* [ns*ns*body.moduli.n] of a constant tangent, which
                             c goes on reading, Pa; NULL: those of others */
  contact_solver *solver; /* NULL until needed */
  archive *from;          /* borrowed: saved data of the solver, or NULL */
  char group[40];         /* in it */
} matrices;

/* In the place of a key: no rate has been read; one of a released matrix; the
 * matrix of tangents of one solve. */
#define RUN_NO_KEY (-1.0)
#define RUN_OTHER_KEY (-2.0)
#define RUN_FRESH_KEY (-3.0)

/* Progress of the run: the next attempt. */
typedef struct progress {
  int step_id, level, attempt, increment_no;
  int cut;      /* of "level", by attempts that failed; the rest: stability */
  long i, part; /* increment of the step's grid, piece of 2^level of it */
  double dt;    /* of an adaptive step, to be tried, s */
  double error; /* of the increments before the step, sqrt(J) */
  double residual; /* -, of the attempt before at the same increment */
  int last;        /* 1: the current increment ends the step */
  int violated;    /* 1: and violates the theorems */
} progress;

/* The contact nodes, and those of them that r->problem.cp has. */
typedef struct contact_nodes {
  int n, n_c;          /* contact nodes; dim*n */
  int rows, n_row;     /* unknowns of a node in cp: 1 or dim; of all of them */
  active_nodes active; /* the contact nodes of cp */
  int n_reported;      /* how many the output has */
} contact_nodes;

/* Elasticity of the elements: one entry for each section, and one for each
 * element whose constants follow its temperature (*ELASTIC with several sets,
 * and temperatures in the deck). */
typedef struct moduli {
  int n;           /* entries: sections, then the elements */
  int n_own;       /* elements with an entry of their own */
  int *elem_id;    /* [n_own] ascending */
  double *at;      /* [n_own] temperature of their entry */
  int *section_id; /* [n_elem] entry, or NULL: section, of an element */
  int *origin;     /* [n] section of an entry */
  kinematics *kin; /* [n] */
  double *thickness, *E, *C; /* [n] m, [ns*ns*n], [36*n] Pa */
} moduli;

/* What the elements are made of. */
typedef struct body_state {
  domain d;
  moduli moduli;           /* at the temperatures of r->now */
  int stale;               /* 1: r->elastic was made with others */
  long elastic_no;         /* counts the matrices that r->elastic was */
  unsigned char *fixed;    /* [dim*n_node] */
  tie_set ties;            /* of d, all-zero without *TIE */
  whole_order order;       /* of d where it is needed, else all-zero */
  stiffness_choice choice; /* of the step */
} body_state;

/* Elements with strains that have no stress. */
typedef struct strain_state {
  visco *visco;               /* NULL: no law flows */
  eigenstrain eigen;          /* e0 is that of the current equilibrium */
  int *elem;                  /* [eigen.n] */
  const double *temperature0; /* [n_elem] at first, borrowed; or NULL */
  double *load;               /* [dim*n_node] F with the forces of eigen, N */
} strain_state;

/* Input of a contact surface. */
typedef struct contact_faces {
  surface_input input;
  contact_pair *pairs;       /* [n_contact] */
  double *face_weight;       /* [n_face] */
  unsigned char *node_fixed; /* [n_node] bits */
} contact_faces;

/* Contact problem of the increment. */
typedef struct posed_problem {
  double *f_load;             /* [n_row] f without motion of supports, N */
  double *f, *gap, *side_gap; /* [n_row], [n], [n*(dim-1)] */
  /* Borrowed from effects, NULL: no friction, no given force. */
  double *ut0;                 /* [n*(dim-1)] m */
  const friction_limit *limit; /* of the time posed last */
  const sparse_rows *B;        /* [n*n] -, of limit, or in its place */
  const double *given;         /* [n] given normal forces, N; < 0: none */
  double *row[2];              /* [rows*n] workspace of run_rows, or NULL */
  active_part part;            /* data of cp where it does not have all nodes */
  contact_problem cp;
  double *f_before; /* [n_row] condensed load of r->old, N */
  int n_before;     /* its n_row */
} posed_problem;

typedef struct load_state {
  double *start;  /* [dim*n_node] displacements at the start of the step, m */
  double largest; /* N, at a node at the ends of the step */
  double *ud;     /* [dim*n_node] prescribed displacements, m */
} load_state;

/* What is derived from r->now (result.c). */
typedef struct derived {
  double *strain, *stress; /* [ns*n_elem] or NULL */
  double *open_gap, *slip; /* [n], [n*(dim-1)] */
  double *g;               /* [n] limit, N, borrowed from friction */
  contact_status *contact; /* [n] */
  unsigned char *closed;   /* [n_c] contact_stops, or NULL: no sides */
  contact_total *totals;   /* [n_contact] */
  double *distance;        /* [n] as in state, borrowed likewise; or NULL */
  double *torque;          /* [n_contact] as in state, or NULL */
} derived;

/* Errors of r->now. */
typedef struct error_state {
  error_bound error;
  rounding_loss rounding;
  error_share mesh_error, time_error;
  double *elem_error; /* [n_elem] borrowed, or NULL */
  double left;   /* -, of an unloaded body: part of the largest energy so far,
                    to which its errors are relative; 0: rounding alone */
  int strained;  /* 1: supports strain a body, found if motions are large or
                    nothing loads it */
  int carried;   /* 1: contact carries its loads straight, found if motions are
                    large */
  int noise;     /* 1: strains are rounding of the motion, found likewise */
  double lost;   /* N, largest rounding of a contact force, found likewise */
  double misfit; /* J, of what does not balance the loads, found likewise */
  int evaluated; /* 1: those of mesh and solver are of r->now */
  int astray;    /* 1: its start contains an increment without convergence */
} error_state;

/* Linear systems of the contact problems so far, without those of shadow runs:
 * what the choice of the stiffness expects of the increments ahead. */
typedef struct observed_work {
  int increments;      /* accepted, of which each solve told its systems */
  int first, later;    /* systems of the first of them, of the others */
  int factors, solves; /* systems of STIFFNESS=FACTOR, solves with them */
  int now, untold;     /* systems since the last accepted increment; 1: a
                          method did not tell its own */
} observed_work;

/* How the contact problem is solved. */
typedef struct solving {
  solver_report report;
  double tol;                /* of the contact solver, in force, - */
  double *guess_u, *guess_r; /* [m] borrowed, if nearer than r->old; or NULL */
  double *start_u, *start_r; /* [m] borrowed, instead of r->old; NULL: none */
  known_rate rate;
  double known_key; /* of the matrix that "rate" was read for */
  long matrix_no;   /* counts the matrices taken into use */
  int placed;       /* 1: bodies that no force holds were put to their place */
  observed_work seen;
} solving;

/* Counters, messages and saved data of the run. */
typedef struct course_state {
  int total_no, unsettled, in_a_row; /* in_a_row: the last, not settled */
  int unsolved;  /* of those unsettled: without convergence */
  int missed;    /* 1: the increment missed the tolerance of its step */
  int shadow;    /* 1: no step of the run: a finer path or a copy is solved */
  int relaxing;  /* the current increment relaxes the start to equilibrium */
  int due, kept; /* a checkpoint is due; has just been made */
  archive *from; /* borrowed: what the step in progress starts from, or NULL */
  stage_cost costs[STAGE_COUNT]; /* at the checkpoint */
  char note[512]; /* what changed abruptly in the increment, "" or lines of
                     RUN_NOTE */
} course_state;

struct run {
  char *owner; /* of all that run_new requests */
  const model *m;
  const mesh *msh;
  const history_sink *sink;
  const step *step;
  size_t n_dof; /* dim*n_node */
  body_state body;
  strain_state strains;

  /* Contact surface and condensed stiffness: while "fixed" is unchanged. */
  contact_faces faces;
  contact_surface *surface;
  contact_nodes nodes;
  matrices elastic;
  condensed *c;           /* in use, borrowed from elastic or visco */
  contact_solver *solver; /* the same */
  posed_problem problem;
  solving solving;

  load_state loads;
  equilibrium old, now;
  derived result;
  error_state errors;
  effect_list effects;
  progress at;
  course_state course;
};

typedef struct run run;

int run_step_id(const run *r); /* from 0 */

/* effect.c: the hooks of all effects of a run, in the order of the table. */
status effects_create(run *r, const effect_ops *const *table);
/* 1: some have sums_up. */
int effects_sum_up(const run *r);
/* history/history.c: 1: slip or inelastic strains of the increments before have
 * a part in this one. */
int run_remembers(const run *r);
/* The same, or steps before in strains that are held or an effect sums up. */
int run_inherits(const run *r);
/* result.c: 1: the error of the mesh is that of this increment too. */
int run_finds_mesh_error(const run *r);
status effects_check(run *r);
status effects_prepare(run *r);
void effects_describe(const run *r, setup_facts *f);
status effects_begin_step(run *r);
status effects_initial(run *r);
status effects_load(run *r, double t);
status effects_pose(run *r, double t);
status effects_rewrite(run *r, contact_problem *cp, double **u, double *force);
void effects_restore(run *r, contact_problem *cp, double *u, double *force);
status effects_start(run *r);
status effects_make_step(run *r, int *made);
status effects_attempt(run *r, double t);
status effects_solve(run *r, double t, int *made);
status effects_estimate(run *r);
void effects_end(run *r);
status effects_found(run *r, int *again); /* *again = 0 before */
status effects_examine(run *r, double t);
status effects_accept(run *r);
void effects_forget(run *r);
/* 1: one gives the element strains without stress. */
int effects_strain(const run *r, int elem_id);
int effects_reach_far(const run *r); /* 1: one is "far" */
void effects_show(const run *r, state *s);
status effects_keep(run *r, archive *a);
/* List of "from" for its copy. */
status effects_copy(const run *from, run *copy);

/* matrices.c: use m for the next equilibria; its solver is made if there is
 * none, and r->elastic again if temperatures have changed the moduli. */
status run_use(run *r, matrices *m);
const material *run_material(const run *r, int elem_id);
/* E[ns*ns] of an element at the temperatures of r->now, Pa. */
const double *run_elasticity(const run *r, int elem_id);
/* The elastic matrix of the current moduli and nodes. */
status run_renew_elastic(run *r);
/* Data of the estimates of the matrix in use. */
void run_forget_estimates(run *r);
void matrices_free(matrices *m);
/* Saved data of the solver, in a group of this name; reading: for the solver
 * that is made next. */
status matrices_keep(matrices *m, archive *a, const char *group);
/* The operator that is made again follows what the one before a restart did. */
status matrices_follow(matrices *m);

/* The contact nodes of r->problem.cp are those of r->nodes.active; allocates
 * their part and unknowns. */
void run_take_nodes(run *r);
status run_room_for_part(run *r);
/* 1: a contact node that was left out of r->problem.cp is beyond its gap in
 * r->now, or no equilibrium was found without those. */
int run_misses_nodes(const run *r);
/* Those and more nodes for r->problem.cp, with a matrix and a solver of their
 * own. */
status run_add_nodes(run *r);
/* A stiffness, chosen again, and a solver for the nodes that r->nodes.active
 * now has. */
status run_renew_nodes(run *r);

/* stiffness.c: how the contact problem of the current supports and nodes knows
 * the condensed stiffness, r->body.choice, and r->body.order for it; as it was
 * where the run goes on from r->course.from. ERR_MEMORY. */
status run_choose_stiffness(run *r);
/* r->body.choice of the step, where matrices for its supports and nodes exist;
 * *other = 1: they are of the other kind. ERR_MEMORY. */
status run_asks_for_other_stiffness(run *r, int *other);
/* r->body.order for r->body.choice. ERR_MEMORY. */
status run_take_stiffness(run *r);

/* moduli.c. At the temperatures T[n_elem]; T NULL: none is given, no element
 * has an entry of its own. ERR_DECK: constants between two temperatures that
 * are no elasticity; ERR_MEMORY. */
status moduli_new(const model *m, const mesh *msh, const double *T,
                  moduli *out);
/* To other temperatures; *changed = 1 if an entry is another one now, else it
 * stays. ERR_DECK likewise. */
status moduli_heat(moduli *x, const model *m, const double *T, int *changed);
/* What d knows of its elements, borrowed from x and m. */
void moduli_domain(const moduli *x, const model *m, domain *d);
/* 1 if the stiffness of the element can change. */
int moduli_follows(const model *m, int elem_id);

/* strains.c: strains that carry no stress. */
status strains_new(run *r);
/* Components of them that an equilibrium has arrays for. */
size_t strains_kept(const run *r);
/* r->strains.eigen.e0 from the current strains. */
void strains_collect(run *r);
/* The loads with the forces of the strains of r->now: r->now.F itself if there
 * are none. */
const double *strains_load(run *r);
/* Strains of r->now and stresses of e, from which the works count. */
void strains_start(run *r, equilibrium *e);
/* Stresses of these elements, and the work on their strains since r->old, J;
 * e->largest at least what the strains would store if they were held. */
void strains_work(run *r, energies *e);
double strains_energy(const run *r); /* of the stresses of r->now, J */
/* -, displacements and forces in u and A u, by rounding */
#define RUN_CARRIED (4 * DBL_EPSILON)
/* Error of the largest displacement of r->now, m; what an error u of all
 * displacements stores, J. */
double strains_lost(const run *r);
double strains_rounding(const run *r, double u);

/* Inelastic strains. points.c: of the elements whose law flows. */
status visco_new(run *r);
void visco_add_strains(const run *r,
                       double *e0);      /* e0[ns*r->strains.eigen.n] */
void visco_show(const run *r, state *s); /* view of the outputs */
/* tangent.c */
/* The moduli of elements are others: the matrices are made again. */
void run_change_moduli(run *r);
void visco_new_solvers(run *r); /* for a step with the same supports */
void visco_forget(run *r);      /* matrices are made again */
/* visco.c, at the start of a step: the strains of r->now are those of r->old.
 */
void visco_rest(run *r);
/* At the start of a *VISCO step: stresses of r->old. */
status visco_begin_step(run *r);
/* From r->old to r->now at time t by the integrator of the step; read
 * r->solving.report. */
status visco_advance(run *r, double t);
/* The same with an estimate of the error of its strains over the largest
 * elastic strains so far: from the integrator, or from two steps of half the
 * length, made in addition. */
status visco_try(run *r, double t, double *error);
/* Increments of 2^level pieces that an explicit integrator needs: the level
 * for a step dt from r->old; ERR_DECK if the deck forbids to cut it. */
status visco_level(run *r, double dt, int *level);
status visco_energies(run *r, energies *e);
/* Strains of the step just made at a time within it into s, and what the laws
 * have dissipated from its start to there, J. */
status visco_between(run *r, double t, flow_state *s, double *dissipated);
/* Temperatures, strains and stresses of the points from r->now. */
void visco_take(run *r);
status visco_accept(run *r);
status visco_keep(run *r, archive *a);

/* increment.c: equilibrium at time t into r->now; read r->solving.report. */
status increment_solve(run *r, double t);
/* Largest of the loads F[dim*n_node] that no support bears at once, N. */
double increment_free_load(const run *r, const double *F);
/* The same with those of heat and inelastic strains, whose rounding is left
 * where they cancel, N; 0: no such strains. */
double increment_strain_load(const run *r);
/* v[dim*n] of the contact frames, displacements (k = 0) or forces (1), as a
 * vector of r->problem.cp: v itself, or in r->problem.row[k] where that has not
 * all unknowns, or not the friction of those that supports hold. */
double *run_rows(const run *r, int k, double *v);
/* The same into rows[n_row]. */
void run_take_rows(const run *r, const double *v, double *rows);
/* Loads and contact problem of time t without solving. */
status increment_pose(run *r, double t);
/* Its parts: loads, temperatures and thermal strains at t; with all strains
 * that carry no stress; then the equilibrium with the matrix in use under the
 * forces F[dim*n_node]. */
status increment_load(run *r, double t);
status increment_begin(run *r, double t);
status increment_equilibrium(run *r, const double *F);

/* result.c: stresses, reactions, totals, energies of r->now as far as the
 * effects and "due" require. */
status result_evaluate(run *r, int due);

/* shadow.c: the state at t within the increment made from r->old to r->now;
 * *out is new. Read its report. */
status shadow_at(run *r, double t, shadow **out);
run *shadow_run(shadow *b);
/* The increment in r->now once more, with forces added to its loads:
 * more[dim*n_node] N; u[dim*n_node] m, rc[dim*n] N of the contact frame;
 * *solved 0: not to its tolerance. The run itself is unchanged. */
status shadow_with(run *r, const double *more, double *u, double *rc,
                   int *solved);
void shadow_leave(shadow **b); /* frees it; accepts NULL */

/* Displacement of the obstacle at a contact unknown since 0 s, m. */
static inline double run_drift(const equilibrium *e, int k) {
  return e->motion == NULL ? 0.0 : e->motion[k];
}
/* Motion of a contact unknown against the obstacle in the increment, m. */
double run_motion_over(const run *r, int k);
/* Slip v[dim] of contact node i over what its row a, a normal, meets, of the
 * increment, or from the origin, m. */
void run_slide(const run *r, int i, int a, int from_origin, double *v);
/* Of motions, that of their differences. */
#define RUN_ROUNDING 1e-12
/* Motion that is rounding of displacements and places, m: to it comes that of
 * the motions it is the difference of. */
double run_still(const run *r);
/* Energies of e as those the run starts with. */
void result_start(run *r, equilibrium *e);
/* r->now becomes r->old. */
status result_accept(run *r);
#define RUN_NOTE(r, ...) \
  text_add((r)->course.note, sizeof(r)->course.note, __VA_ARGS__)
