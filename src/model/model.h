/*
 * The model: the contents of the deck, checked. Names and strings are
 * borrowed from the deck, which must outlive it.
 */
#pragma once

#include "contact/friction.h"
#include "material/scheme/scheme.h"
#include "solver/solver.h"

typedef struct amplitude {
  const char *name;
  place at;
  int used;          /* something refers to it */
  int total_time;    /* its times are total (1) or step time (0) */
  value_table table; /* s, -; arrays owned */
} amplitude;

typedef struct material {
  const char *name;
  place at;
  int used;              /* a section refers to it */
  int has_elastic;       /* its *ELASTIC was seen, valid or not */
  elastic_table elastic; /* n = 0: no valid *ELASTIC */
  double C[36];          /* at the temperature 0, Pa */
  double density;        /* kg/m3 */
  int has_density;
  expansion expand;
  int moduli;      /* of *ELASTIC: MODULI_..., -1: not given */
  law_card law;    /* ops NULL: elastic; owned */
  law_shift clock; /* *TRS; kind SHIFT_NONE: not given */
  place clock_at;
  const law_ops *law_aside; /* ops of the law while it is left out, or NULL */
  /* of *ELASTIC while others represent the final state of the law */
  elastic_constants elastic_aside;
  double relaxed[36];  /* [ns*ns] e^i over the stress then, 1/Pa */
  int is_relaxed;      /* 1: they do */
  int is_still;        /* 1: the law is left out as model.still says */
  int is_abaqus_prony; /* *VISCOELASTIC: long-term moduli if not given */
} material;
enum { MODULI_LONG_TERM, MODULI_INSTANTANEOUS };

typedef struct section {
  const char *elset, *material_name;
  place at, elset_at, material_at;
  int kin;           /* kinematics; -1: not given */
  double thickness;  /* m */
  int has_thickness; /* given, not the default */
  int averaged;      /* FORMULATION=AVERAGED */
  int material_id, group_id;
} section;

/* One *FRICTION card: the law of a contact, until another takes its place. */
typedef struct friction_rule {
  const friction_ops *law;   /* NULL: frictionless */
  const friction_ops *aside; /* the law while it is left out, or NULL */
  friction_card card;        /* its value and options (owned) */
  value_table position;      /* TABLE= of the value; arrays owned */
  const char *amplitude_name;
  place at, value_at, amplitude_at;
} friction_rule;

/* *CONTACT FORCE: pressure p >= 0 of the obstacle, force/length^2, in the place
 * of the unilateral condition. */
typedef struct given_force {
  int given;
  quantity value;
  value_table position; /* TABLE= of the value; arrays owned */
  const char *amplitude_name;
  place at, value_at, amplitude_at;
} given_force;

/* Two surfaces of the mesh, of *CONTACT PAIR or *TIE. */
typedef struct surface_pair {
  const char *group[2];
  place group_at[2];
  int choice;              /* SLAVE=: SLAVE_... */
  int slave_id, master_id; /* groups; -1: not known */
  int slave;               /* 0 or 1: which of the two is the slave */
  double moved;            /* by ADJUST=YES at most, m */
  int adjust;              /* 1: slave nodes are moved onto the master */
  char why[64];            /* reason of the choice */
} surface_pair;
#define SLAVE_WORDS "AUTO|FIRST|SECOND"
enum { SLAVE_AUTO, SLAVE_FIRST, SLAVE_SECOND };

/* CLEARANCE or INTERFERENCE: added to the gap of a pair or taken off. */
typedef struct gap_change {
  int given, interferes;
  quantity value; /* m */
  const char *amplitude_name;
  place at, amplitude_at;
} gap_change;

typedef struct tie {
  const char *name;
  place at;
  surface_pair pair;
} tie;

/* *CRACK: a group of inner faces that is opened; its lips are a pair. */
typedef struct crack {
  const char *name, *group;
  place at, group_at;
  int contact_id;
  char *lip[2]; /* names of the groups of its lips, owned */
} crack;

typedef struct contact {
  const char *name, *group, *obstacle_name; /* of a pair slave, master */
  place at, group_at, obstacle_at;
  int obstacle_id, group_id;
  int is_crack; /* 1: the pair is that of *CRACK */
  int is_pair;  /* 1: *CONTACT PAIR or *CRACK, without obstacle */
  surface_pair pair;
  gap_change change;             /* of a pair */
  int update;                    /* 1: UPDATE=STEP of a pair */
  int slave_normal;              /* 1: NORMAL=SLAVE of a pair */
  int obstacle_normal;           /* 1: NORMAL=OBSTACLE; -1: not given */
  int has_axis;                  /* line AXIS, or ROTATE of the obstacle */
  int axis_of_obstacle;          /* 1: of the obstacle, shifted with it */
  double axis_point[3], axis[3]; /* m, of unit length; for the torque */
  place axis_at;
  friction_rule friction; /* from the first step on */
  given_force force;
} contact;

typedef enum {
  LOAD_PRESSURE,    /* P: force/length^2, pushes into the body */
  LOAD_TRACTION,    /* TX TY TZ: force/length^2 */
  LOAD_BODY,        /* BX BY BZ: force/length^3 */
  LOAD_GRAVITY,     /* GRAV: acceleration along direction[3] */
  LOAD_POINT,       /* *CLOAD: force on each node of the group */
  LOAD_TEMPERATURE, /* *TEMPERATURE of a group of elements */
  LOAD_FIXING       /* *BOUNDARY: prescribed displacement, length */
} load_kind;

/* How the value of a load runs over a step. */
typedef enum {
  RUN_RAMP,   /* linear from "before" to "value" over the step */
  RUN_DIRECT, /* value at the time itself (amplitude, expression of t) */
  RUN_HELD    /* value at before_t: of an earlier step */
} load_run;

/* A load or prescribed displacement in force during one step. */
typedef struct load {
  int kind; /* load_kind */
  int run;  /* load_run */
  const char *group;
  int group_id;
  int component;       /* 0..dim-1: of TX.., BX.., *CLOAD, *BOUNDARY */
  double direction[3]; /* LOAD_GRAVITY, unit length */
  quantity value, before;
  /* RUN_RAMP: from "before" at before_t, else from 0; *TEMPERATURE and
   * *BOUNDARY from what elements and nodes have at the start of the step */
  int has_before;
  double before_t; /* s, total time */
  /* *TEMPERATURE, FILE=: nodal field that the value multiplies; NULL: 1 */
  const char *file;
  const double *field; /* [n_node] borrowed from the model */
  place file_at;
  const char *amplitude_name;
  int amplitude_id; /* -1: none */
  int removed;      /* ends: by OP=NEW; dropped after its ramp to zero */
  place amplitude_at;
  place at;
} load;

typedef struct nodal_field { /* values read from a file */
  const char *file;
  double *value; /* [n_node] owned */
} nodal_field;

typedef struct load_list {
  int n, cap;
  load *item; /* [n] owned */
} load_list;

typedef enum { STEP_NONE, STEP_STATIC, STEP_QUASISTATIC, STEP_VISCO } step_kind;
/* Unknown of an increment: the displacement (CPR98, N2) or its change (N3). */
typedef enum { FORM_DISPLACEMENT, FORM_VELOCITY } step_form;
#define STEP_FORMS "DISPLACEMENT|VELOCITY"

/* The tables of *PRINT. */
/* clang-format off */
#define PRINT_LIST(X)                                                 \
  X(CONTACT,   "contact nodes")                                       \
  X(TOTALS,    "resultants per contact")                              \
  X(NODES,     "nodal displacements")                                 \
  X(ELEMENTS,  "strains and stresses")                                \
  X(ENERGY,    "energies, their balance")                             \
  X(REACTIONS, "forces of supports")                                  \
  X(ZONES,     "zones of stick, slip, separation with their ends")    \
  X(LOOP,      "force and motion per contact: loops of friction")     \
  X(WEAR,      "depth and volume worn off at the nodes of *WEAR")     \
  X(SIF,       "stress intensity factors at the fronts of *CRACK")    \
  X(GOALS,     "quantities of *GOAL and their errors")
/* clang-format on */
#define PRINT_NUMBER(name, help) PRINT_NUMBER_##name,
enum { PRINT_LIST(PRINT_NUMBER) PRINT_COUNT };
#define PRINT_BIT(name, help) PRINT_##name = 1 << PRINT_NUMBER_##name,
enum { PRINT_LIST(PRINT_BIT) };

/* One line of *INITIAL CONDITIONS. */
typedef struct initial {
  int type; /* initial_type */
  const char *group;
  int group_id;
  int component; /* of a displacement, strain or internal variable, from 0 */
  quantity value;
  place at;
} initial;
typedef enum {
  INITIAL_TEMPERATURE,
  INITIAL_DISPLACEMENT,
  INITIAL_STRAIN,
  INITIAL_INTERNAL
} initial_type;
#define INITIAL_WORDS "TEMPERATURE|DISPLACEMENT|INELASTIC STRAIN|INTERNAL"

/* *INITIAL CONDITIONS, TYPE=DISPLACEMENT: u_0, tested for compatibility. */
typedef struct start_card {
  int given;
  int relax;             /* 1: an incompatible start is relaxed, 0: refused */
  const char *file;      /* JOB.h5 of another run, or NULL */
  const char *file_name; /* as the deck has it */
  place at, file_at;
} start_card;

typedef struct time_points {
  const char *name;
  int total_time; /* 0: counted from the start of each step */
  int n, used;
  double *t; /* [n] ascending, s */
  place at;
} time_points;

typedef struct print_request { /* one table of *PRINT */
  int table;                   /* one bit of PRINT_* */
  const char *group;       /* nodes or elements of a group only; NULL: all */
  int group_id;            /* of group */
  int frequency;           /* every n-th increment and the last; 0: last only */
  const char *points_name; /* NULL: frequency counts */
  const time_points *points; /* the same, borrowed */
  place at, points_at;
} print_request;

typedef struct friction_change { /* *FRICTION in a step */
  int contact_id;
  friction_rule rule; /* from the start of the step on */
} friction_change;

/* CHECK= of *SOLVER */
typedef enum { CHECK_NONE, CHECK_SOLVERS, CHECK_ALL } solution_check;

/* MESH= of *ACCURACY, as the words stand there: at every increment; at the last
 * of the step. */
typedef enum { MESH_ERROR_NO, MESH_ERROR_YES, MESH_ERROR_END } mesh_error_at;

typedef struct step {
  const char *name;
  place at;
  int kind; /* step_kind */
  int form; /* step_form */
  struct {
    const scheme *integrator; /* of *VISCO, else NULL */
    double theta;             /* of the integrator, - */
    int initial;              /* ITERATION=INITIAL */
    int substeps;             /* explicit increments are cut as needed */
    double tolerance;         /* of strains over elastic ones; 0: dt stays */
  } visco;
  double start;                     /* total time, s */
  double dt, total, dt_min, dt_max; /* s */
  load_list loads;  /* all in force, those of earlier steps included */
  unsigned renewed; /* bit of each load_kind that OP=NEW ends */
  struct {
    int n, cap;
    friction_change *changes; /* [n] owned */
  } friction;
  struct {
    int n, cap;
    print_request *requests; /* [n] owned */
    int given;               /* 1: those of the step before end */
    int ended;               /* bits of PRINT_*: or these alone, by =NO */
  } print;
  struct {
    int frequency; /* HDF5: every n-th increment; 0: last; -1: none */
    int condensed; /* the same of the condensed problems */
    int given;
    place at;
  } output;
  struct {
    int frequency; /* of JOB.rst.h5, as above; -1: none */
    int given;
    place at;
  } restart;
  struct {
    int given;
    place at;
    int no_solver;     /* 1: the error of the solver is not required */
    int mesh;          /* mesh_error_at: where its error is */
    int time;          /* 1: the error of the steps is */
    int time_balanced; /* 1: TIME=BALANCED */
    double time_share; /* -, of the error of the mesh */
    int theorems;      /* 1: the theorems of CPR98 are checked */
  } accuracy;
  int check;            /* solution_check, comes with *SOLVER */
  int balanced;         /* TOL=BALANCED */
  double share;         /* -, of the errors it is balanced with */
  int nested;           /* 1: NESTED=YES, of the first step */
  solver_choice solver; /* its param is owned by the step it came with */
  void *solver_param;   /* owned, or NULL */
  place solver_at;
} step;

/* *REFERENCE: the solution in closed form. Parts of "value"; components as in
 * u and in the stresses (axisymmetry: r, z; rr, zz, tt, rz). */
enum {
  REFERENCE_U,
  REFERENCE_STRESS = 3,
  REFERENCE_PRESSURE = 9,
  REFERENCE_SIZE
};
typedef struct reference_line {
  const char *name; /* u_x, stress_xx, pressure, ... */
  quantity value;
  place at;
} reference_line;
typedef struct closed_form {
  int n; /* 0: none */
  reference_line line[REFERENCE_SIZE];
  place at;
  /* Set by model_check. */
  int has_u, has_stress, has_pressure;
  quantity value[REFERENCE_SIZE];
} closed_form;

typedef struct accuracy_target { /* *ACCURACY, TARGET= */
  double percent;                /* of the energy norm; 0: none */
  double max_cpu, max_memory;    /* s, MB; 0: no limit */
  int max_passes;                /* 0: the default */
} accuracy_target;
enum { MAX_PASSES_DEFAULT = 8 };

/* *GOAL: a quantity whose error the user wants to know. */
typedef enum {
  GOAL_FORCE,
  GOAL_PRESSURE,
  GOAL_WIDTH,
  GOAL_DISPLACEMENT,
  GOAL_STRESS,
  GOAL_ENERGY,
  GOAL_FRICTION,
  GOAL_MOMENT,
  GOAL_SIF
} goal_quantity;
#define GOAL_QUANTITIES \
  "FORCE|PRESSURE|WIDTH|DISPLACEMENT|STRESS|ENERGY|FRICTION WORK|MOMENT|SIF"
/* Of COMPONENT=: 1 to 3 are global ones, from 0. */
enum { GOAL_NORMAL = 3, GOAL_TANGENT, GOAL_TENSOR };
#define GOAL_COMPONENTS "1|2|3|NORMAL|TANGENT|XX|YY|ZZ|XY|YZ|ZX"
typedef struct goal_card {
  const char *name;
  goal_quantity quantity;
  int contact_id;        /* -1: none */
  int crack_id;          /* of SIF; -1: none */
  const char *group;     /* or NULL */
  int group_id, node_id; /* set by model_check; -1: none */
  /* Of a difference of displacements: place whose mean is taken off. */
  const char *from;          /* group, or NULL */
  int from_id, from_node_id; /* as above */
  int component;
  double radius; /* of the mean of a pressure, m; 0: chosen */
  double target; /* error to reach, its unit or % of its value; 0: none */
  int in_percent;
  int n_point;
  double point[2][3]; /* m; the second is taken off */
  place at, group_at, from_at, point_at[2];
} goal_card;

/* The card of an effect, interpreted by the file of the effect. */
enum { EFFECT_VALUES = 4 };
typedef struct effect_card {
  const char *keyword;
  int contact_id;              /* -1: all */
  double value[EFFECT_VALUES]; /* in the order of its row of keywords */
  place at;
} effect_card;

/* What *EFFECTS, MODE=AUTO leaves out, and what that would have changed. */
typedef struct omitted {
  int bit, id;   /* EFFECT_BIT_..., material of a law or -1 */
  char why[160]; /* reason of the trial */
  double bound;  /* -, of the energy norm of the solution, at most */
  double local;  /* -, stress in one element over the scale of stresses */
  double change; /* -, largest change by an increment with it */
  long checked;  /* increments */
  long again;    /* of them solved again */
  int some;      /* > 0: of the law at so many elements only, m->still */
  double time;   /* s, > 0: the law is near its final state, exp(-t/time) */
  int back;      /* 1: it matters, the run was repeated with it */
  int lost;      /* 1: the run without it was not solved to its tolerance */
} omitted;
enum { OMITTED_MAX = 16 };

typedef struct model {
  deck *deck;
  message_log *log;
  struct {
    char *job;         /* name of the deck without folder and .inp */
    const char *title; /* first line of *HEADING or "" */
  } name;
  struct {
    const char *file;
    double scale;
    place at;
    int given;
    crack *cracks; /* [n.crack] in the order of mesh->crack */
    int corner_id; /* a contact with nodes of another one before it, or -1 */
  } mesh;
  struct { /* *CONDENSED PROBLEM, in the place of a mesh */
    const char *file;
    int type;     /* exchange_type */
    int friction; /* 1: some mu > 0; known when it is read */
    place at;
    int given;
  } problem;
  struct {
    int given;
    const char *length, *force, *time; /* labels or NULL */
  } unit;
  struct model_count {
    int amplitude, points, material, section, obstacle, contact, tie, crack,
        step, field, initial, effect_card, goal;
  } n, cap; /* of the arrays below; allocated */
  struct {
    amplitude *amplitudes;
    time_points *points;
    value_table first_step; /* 0 to 1 over the first step; arrays owned */
  } time;
  material *materials;
  section *sections;
  obstacle *obstacles;
  struct move *moves; /* [n.obstacle] amplitude names of the obstacles */
  contact *contacts;
  tie *ties;
  struct {
    load_list supports;  /* *BOUNDARY before the first step */
    nodal_field *fields; /* [n.field] of all FILE= of *TEMPERATURE */
  } load;
  struct {
    initial *lines; /* [n.initial] in the order of the deck */
    start_card start;
  } initial;
  step *steps;
  struct {
    accuracy_target target;
    closed_form ref;
    goal_card *goals;  /* [n.goal] in the order of the deck */
    int goal_products; /* 1: shares of the elements are saved for sizes */
    double mesh_price; /* -, share of the run for which an error of the mesh
                          that no card requires is left out; 0: it is not */
    const struct coarser *coarser; /* start of contact, borrowed; or NULL */
  } accuracy;
  struct {              /* *EFFECTS */
    int given, is_auto; /* is_auto: MODE=AUTO */
    double tol;         /* - */
    place at;
    int n;
    omitted row[OMITTED_MAX]; /* [n] */
    unsigned char *still; /* [n_elem] material.is_still; NULL: nowhere, owned */
  } reduction;
  effect_card *effect_cards; /* [n.effect_card] in the order of the deck */
  unsigned effects;          /* bits EFFECT_*, set by model_check */
  int dim, ns;               /* from the mesh */
  int *elem_section;         /* [n_elem] section of each element */
} model;

typedef struct move { /* *OBSTACLE, AMPLITUDE= */
  const char *amplitude_name;
  int used;               /* a contact refers to it */
  place at, amplitude_at; /* of the card, the name */
  place short_at; /* first geometry line with two numbers; file NULL: none */
  place move_at, rotate_at; /* of the lines MOVE, ROTATE */
} move;

/* Bits of m->effects: what a model requires and other files ask for. */
/* clang-format off */
#define EFFECT_LIST(X)                                                \
  X(CONTACT) X(FRICTION) X(NONLOCAL) X(TANGENTS) X(GIVEN) X(HISTORY)  \
  X(START) X(INELASTIC) X(THERMAL) X(BODY) X(STRESS) X(REACTION)      \
  X(MESH_ERROR) X(TIME_ERROR) X(ESTIMATES) X(REFERENCE) X(THEORY)     \
  X(MESH)
/* clang-format on */
#define EFFECT_BIT(name) EFFECT_BIT_##name,
enum { EFFECT_LIST(EFFECT_BIT) };
#define EFFECT_MASK(name) EFFECT_##name = 1 << EFFECT_BIT_##name,
enum { EFFECT_LIST(EFFECT_MASK) };
/* Name of the file of a place, without folder. */
const char *place_file(const place *at);
/* For "%s:%d": file without folder, line. */
#define PLACE(at) place_file(&(at)), (at).line_no
/* The rule of a contact in force during a step. */
const friction_rule *friction_in_force(const model *m, int step_id,
                                       int contact_id);
/* A friction value that is zero everywhere and always is no friction. */
int rule_has_friction(const friction_rule *rule);
/* 1: a crack between two sections. */
int model_is_interface(const model *m, const mesh *msh, int contact_id);
/* "*CONTACT", "*CONTACT PAIR" or "*CRACK" */
const char *contact_card(const contact *c);
/* 1 if the deck has such a card. */
int has_card(const model *m, const char *name);
int model_writes_fields(const model *m); /* 1: JOB.h5 is written */
/* Increments of a step as the deck has them, at least 1; with a tolerance,
 * which chooses them, no more than 50. */
double step_increments(const step *s);
/* Those after time t (s) at its dt, "n_done" being done; with a tolerance no
 * more than make 50 in all, or half as many again as are done. */
double step_increments_left(const step *s, double t, double dt, int n_done);
/* 1: an increment, -1 within one, is shown by "every n-th and the last; 0: the
 * last"; negative: none. */
int frequency_shows(int frequency, int increment_no, int last);
/* The name of a table, PRINT_*. */
const char *print_word(int table);
/* 1 if a table shows the increment that ends at t: its number within the step,
 * -1 if t is within one, 1 if it is the last; of time points the times alone
 * count. */
int print_shows(const print_request *p, const step *s, double t,
                int increment_no, int last);
/* Its first time point after one time and before another, neither to
 * rounding; HUGE_VAL: none. */
double print_next(const print_request *p, const step *s, double after,
                  double before);
/* 1: *CONTACT PAIR or *TIE: surfaces of the mesh meet. */
int model_has_pairs(const model *m);
/* 1: some are coupled again at each step, where the bodies are then. */
int model_updates_pairs(const model *m);
double model_thickness(const model *m, int elem_id); /* m */
/* 1 if some contact has an axis for its torque. */
int model_has_axis(const model *m);
int model_is_axisymmetric(const model *m);
/* Unit with the labels of *UNITS: "force/length^2" -> "N/mm^2", one word
 * without brackets; in a text_buffer. */
const char *model_unit(const model *m, const char *unit);
/* That of a goal. */
const char *model_goal_unit(const model *m, int id);
/* The first *GOAL with TARGET=, or NULL; 1: some error is to be reached. */
const goal_card *model_targeted_goal(const model *m);
int model_has_target(const model *m);
/* 1: the law of an element counts. */
int model_flows(const model *m, int elem_id);
/* The last of an effect's cards for a contact, -1: for any; NULL: none. */
const effect_card *model_effect_card(const model *m, const char *keyword,
                                     int contact_id);
/* 1: its limit is an average over the surface. */
int rule_has_average(const friction_rule *rule);
/* 1: tangential unknowns are there for friction alone, which acts in all steps
 * on touching nodes and against their displacement. */
int model_rubs_locally(const model *m);

/* Bits EFFECT_* of what the deck requires: passed in by the caller
 * (effects_required of src/effects). */
typedef unsigned effect_finder(const model *m);
/* m->mesh.corner_id. ERR_MEMORY. */
status model_find_corner(model *m, const mesh *msh);
/* In the place of model_check for a deck with *CONDENSED PROBLEM, once it is
 * read: dimension (1: LCP), 1 if it has friction. */
void model_fit_problem(model *m, int dim, int friction, effect_finder *find);

/* load.c */
/* Nodal forces F[dim*n_node] (global components, N) of a step at total time t:
 * the exact integrals of P1 data (values at the nodes, linear between).
 * ERR_DECK if a value is not finite (the record names card, node and time). */
status load_forces(const model *m, const mesh *msh, const step *s, double t,
                   double *F);
/* 1: a step has loads on bodies. What a step has of them: their part of
 * load_forces, and their mean over each element, b[dim*n_elem], N/m3. */
int load_has_body(const model *m);
status load_body(const model *m, const mesh *msh, const step *s, double t,
                 double *F, double *b);
/* Force per volume in an element, N/m3 over the value of such a load. */
void load_per_value(const model *m, const load *l, int elem_id, double f[3]);
/* The part of *CLOAD of load_forces. */
status load_points(const model *m, const mesh *msh, const step *s, double t,
                   double *F);
/* Total time at the end of a step. */
double step_end(const step *s);
const char *load_card(const load *l); /* "DLOAD" */
/* Value of a load at a point, at a node, and total time t of the step. */
double load_at_point(const load *l, const step *s, const double x[3], double t);
double load_at_node(const load *l, const mesh *msh, const step *s, int node,
                    double t);
/* 1 if that is finite at the nodes of its group; else the log has the first
 * node where it is not. */
int load_finite(const model *m, const mesh *msh, const step *s, const load *l,
                double t);

/* Prescribed displacements ud[dim*n_node] at t, written where fixed; errors as
 * load_forces. start[dim*n_node]: displacements at the start of the step, from
 * which all move to their values; not read at its end. */
status load_prescribed(const model *m, const mesh *msh, const step *s, double t,
                       const double *start, double *ud);
/* Value of an initial condition in an element, mean of its nodes; ERR_DECK if
 * it is not finite. */
status load_initial(const model *m, const mesh *msh, const initial *c,
                    int elem_id, double *value);
/* Temperatures T[n_elem] before the first step, mean of the nodes. ERR_DECK if
 * one is not finite. */
status load_temperature_initial(const model *m, const mesh *msh, double *T);
/* Temperatures T[n_elem] at time t of a step of the model, T0[n_elem] before
 * the first step; errors as above. */
status load_temperature(const model *m, const mesh *msh, const step *s,
                        double t, const double *T0, double *T);
/* The same at a point of each element, by its barycentric coordinates b[dim+1];
 * not finite where a formula is not. ERR_MEMORY. */
void load_temperature_initial_at(const model *m, const mesh *msh,
                                 const double *b, double *T);
status load_temperature_at(const model *m, const mesh *msh, const step *s,
                           double t, const double *b, const double *T0,
                           double *T);
/* zone[n_elem] from 0: within one all elements expand alike and have their
 * temperatures from the same cards, or equal numbers, in all steps; between two
 * of them temperature and thermal strain may jump. ERR_MEMORY. */
status load_temperature_zones(const model *m, const mesh *msh, int *zone);
/* fixed[dim*n_node] = 1 where a *BOUNDARY of the step holds the component. */
void load_fixed(const mesh *msh, const step *s, unsigned char *fixed);
