/*
 * A random deck as data: what the text of its cards says and what the checks
 * recompute. Base units; the text may be in others.
 */
#pragma once

#include "support/job.h"

#include <stdio.h>

enum {
  POINTS = 5,  /* pairs of a table                                         */
  COURSES = 6, /* amplitudes                                               */
  BODIES = 2,  /* apart from one another                                   */
  MATERIALS = 2,
  CONTACTS = 2,
  LOADS = 16, /* in a step                                                */
  STEPS = 3,
  GROUPS = 32,
  TERMS = 3, /* of a law                                                 */
  DECK_TEXT = 16384
};

typedef struct random_source {
  unsigned long long state;
} random_source;
unsigned long long random_next(random_source *r);
double random_real(random_source *r, double from, double to);
int random_pick(random_source *r, int n);          /* 0 .. n-1               */
int random_chance(random_source *r, double share); /* 1 with that probability */

/* ---- values ------------------------------------------------------------- */

/* A factor in time: pairs, or a[0] + a[1] sin(a[2] t). */
typedef struct course {
  int formula, total, n; /* total: TIME=TOTAL TIME                          */
  double t[POINTS], a[POINTS];
} course;
double course_value(const course *c, double t);

/* Linear in place: at0 + slope . x */
typedef struct linear {
  double at0, slope[3];
} linear;
double linear_value(const linear *v, int dim, const double *x);

/* ---- the mesh ----------------------------------------------------------- */

typedef struct solid_group {
  char name[32];
  int dim, body;
} solid_group;

/* Triangles or tetrahedra, faces of the groups, all in order of creation. */
typedef struct solid {
  int dim, n_node, n_elem, n_face, n_group;
  double *x;              /* [dim*n_node]                             */
  int *elem, *elem_group; /* [(dim+1)*n_elem], [n_elem]               */
  int *face, *face_group; /* [dim*n_face] outward, [n_face]           */
  int *face_elem;         /* [n_face]                                 */
  solid_group group[GROUPS];
} solid;

/* A grid of cells over a box, its bottom curved and its nodes moved a little.
 */
typedef struct solid_plan {
  int dim, n[3], layers; /* layers: the upper half is another group         */
  double at[3], length[3];
  double bend;  /* height of the bottom at its ends, length        */
  double shake; /* of an edge, by how much nodes are moved         */
} solid_plan;
void solid_add(solid *s, const solid_plan *p, int body, random_source *r);
void solid_free(solid *s);
int solid_find(const solid *s,
               const char *name); /* group id; abort if absent */
/* 1: the node belongs to the group (faces or elements). */
int solid_in(const solid *s, int group, int node);

/* ---- the deck ----------------------------------------------------------- */

typedef enum { PLANE_STRAIN_, PLANE_STRESS_, AXISYMMETRIC_, SOLID_ } deck_kind;

typedef enum {
  NO_LAW,
  MAXWELL,
  DEVIATORIC,
  ZENER,
  KELVIN,
  BURGERS,
  PRONY,
  VISCOELASTIC,
  NORTON,
  CREEP_STRAIN,
  CREEP_TIME,
  CREEP_HYPERB,
  BINGHAM,
  PERZYNA,
  CHABOCHE,
  LAWS
} law_kind;

typedef struct deck_material {
  double E[2], nu[2], at[2]; /* at: temperatures of the sets              */
  int n_set;
  double alpha, zero, density; /* alpha 0: no *EXPANSION                    */
  law_kind law;
  int n_term, shift;     /* shift: 1 *TRS or SHIFT=WLF                */
  double term[TERMS][4]; /* in the units of its fields                */
  double t_ref, c1, c2;
} deck_material;

typedef enum { CONFORMING, PLANE, CYLINDER, SPHERE, GAP } obstacle_kind;
typedef enum { STANDS, TO_END, BY_COURSE, BY_FORMULA } motion_kind;

typedef struct deck_obstacle {
  obstacle_kind kind;
  double point[3], direction[3], radius;
  double gap0, gap2, gap_at; /* GAP: gap0 + gap2 (x - gap_at)^2           */
  motion_kind motion;
  double move[3], pivot[3], axis[3], angle, omega; /* formula: sin(omega t) */
  int course;
} deck_obstacle;

enum { CONSTANT_KERNEL = 4, KERNELS };

typedef enum { FRICTIONLESS, TRESCA, COULOMB, NONLOCAL } friction_kind;

typedef struct deck_friction {
  friction_kind law;
  linear value;
  char table;   /* 0, X, Y, Z, T                            */
  course pairs; /* of the table                             */
  int course;   /* -1: none                                 */
  double radius;
  int kernel, normalized, zone, geodesic, mirror[3];
} deck_friction;

typedef struct deck_contact {
  int group, normal; /* 0: not said, 1 BODY, 2 OBSTACLE          */
  deck_obstacle obstacle;
  int given, course; /* given: *CONTACT FORCE                    */
  linear pressure;
} deck_contact;

typedef enum {
  FIX,
  PRESSURE,
  TRACTION,
  BODY_FORCE,
  GRAVITY,
  POINT,
  HEAT
} load_kind_;

typedef struct deck_load {
  load_kind_ kind;
  int group, component, course; /* course -1: grows over the step           */
  linear value;
  double direction[3];
  int field; /* HEAT: 1 by FILE=, value a factor         */
} deck_load;

typedef enum { IS_STATIC, IS_QUASISTATIC, IS_VISCO } step_kind_;

typedef struct deck_step {
  step_kind_ kind;
  double start, dt, total;
  int velocity, substeps, initial_tangent, n_load;
  const char *integrator;
  double theta, tolerance; /* 0: not said                              */
  deck_load load[LOADS];
  int has_friction[CONTACTS]; /* 1: *FRICTION in this step                */
  deck_friction friction[CONTACTS];
} deck_step;

typedef struct random_deck {
  unsigned long long seed;
  int n_body, n_material, n_contact, n_step, n_course, averaged;
  deck_kind kind;
  double thickness;
  solid mesh;
  deck_material material[MATERIALS];
  int material_of[GROUPS]; /* of the groups of elements, -1            */
  course courses[COURSES];
  deck_contact contact[CONTACTS];
  deck_step step[STEPS];
  double warm[BODIES]; /* initial temperatures                     */
  double *field;       /* [n_node] temperatures of the file        */
  int relax;           /* 1: INCOMPATIBLE=RELAX from start[]       */
  double start[3];     /* u_0 of all nodes but fixed ones          */
  int balanced;        /* TOL=BALANCED                             */
  int fields; /* 1: JOB.h5 is written                                   */
  int floats; /* contact alone holds a body               */
} random_deck;

void deck_draw(unsigned long long seed, random_deck *d);
void deck_draw_contacts(random_deck *d, random_source *r);
void deck_release(random_deck *d);
int deck_has_heat(const random_deck *d);
int deck_flows(const random_deck *d); /* some material has a law             */

/* ---- values in time ----------------------------------------------------- */

/* Step in which t lies (its end belongs to it). */
int deck_step_at(const random_deck *d, double t);
/* Value of load l of step s at x[4] (the temperature of the file is x[3]) and
 * time t, with those it replaces; "from" is where a first value starts. */
double deck_load_value(const random_deck *d, int step, const deck_load *l,
                       const double *x, double t, double from);
/* All loads in force in a step: those of the last step that names them. */
int deck_loads(const random_deck *d, int step, deck_load *out, int *owner);
const deck_friction *deck_friction_at(const random_deck *d, int step, int c);
double deck_friction_value(const random_deck *d, const deck_friction *f,
                           const double *x, double t);
/* Shift and angle of an obstacle. */
void deck_motion(const random_deck *d, const deck_obstacle *o, double t,
                 double shift[3], double *angle);

/* ---- text --------------------------------------------------------------- */

typedef struct deck_units {
  double length, force, time;
} deck_units;

typedef struct deck_text {
  deck_units units;
  const char *method; /* NULL: that of the deck                   */
  unsigned shuffle;   /* 0: nodes and elements in order           */
  int turned;         /* 1: the axes change places, deck_axis()           */
} deck_text;

/* What the axis c, from 0, is in the text: x y, or x y z go round. */
int deck_axis(const deck_text *how, int dim, int c);

/* JOB.inp, deck.msh and field.msh into the folder of the job. */
void deck_write(const random_deck *d, const deck_text *how, const job *j);
void deck_write_mesh(const random_deck *d, const deck_text *how, FILE *f);
void deck_write_field(const random_deck *d, const deck_text *how, FILE *f);
/* Numbers in the file, from 1, of n items: [n], the caller frees. */
int *deck_numbers(int n, unsigned shuffle);
