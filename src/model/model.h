/*
 * The model: everything the deck asks for, checked. Names and strings are
 * borrowed from the deck, which lives longer.
 */
#ifndef PROTIS_MODEL_MODEL_H
#define PROTIS_MODEL_MODEL_H

#include "contact/friction.h"
#include "contact/surface.h"
#include "deck/deck.h"
#include "material/material.h"
#include "mesh/mesh.h"
#include "solver/solver.h"

typedef struct amplitude {
  const char *name;
  int total_time; /* times are total (1) or step time (0)                */
  int n;
  double *t, *a;    /* [n] pairs, t ascending; s, -                        */
  quantity formula; /* used if n == 0                                      */
} amplitude;

typedef struct material {
  const char *name;
  place at;
  elastic_type type;
  int n_constant; /* 0: no *ELASTIC                                      */
  double constant[ELASTIC_MAX]; /* Pa, -                                      */
  double C[36];   /* Pa                                                  */
  double density; /* kg/m3; 0 if absent                                  */
} material;

typedef struct section {
  const char *elset, *material_name;
  place at;
  int kin;          /* kinematics                                          */
  double thickness; /* m                                                   */
  int material_id, group_id;
} section;

typedef struct contact {
  const char *name, *group, *obstacle_name;
  place at;
  int obstacle_id, group_id;
  const friction_ops *law; /* NULL: frictionless                              */
  void *law_param; /* owned                                               */
  quantity value;  /* mu or g                                             */
  int friction_amplitude; /* amplitude id or -1                               */
  place friction_at;
} contact;

typedef enum {
  LOAD_PRESSURE, /* P: force/length^2, pushes into the body             */
  LOAD_TRACTION, /* TX TY TZ                                            */
  LOAD_BODY,     /* BX BY BZ: force/length^3                            */
  LOAD_GRAVITY,  /* GRAV, g, direction                                  */
  LOAD_POINT     /* CLOAD: force on each node of the group              */
} load_kind;

/* A load or prescribed displacement in force during one step. */
typedef struct load {
  int kind; /* load_kind                                           */
  const char *group;
  int group_id;
  int component; /* 0..dim-1 of TX.., BX.., *CLOAD                      */
  quantity value;
  quantity before;     /* value at the end of the step before (ramp start)    */
  double direction[3]; /* LOAD_GRAVITY                                        */
  int amplitude_id;    /* -1: linear from "before" to "value" over the step   */
  place at;
} load;

typedef struct fixing { /* *BOUNDARY                                         */
  const char *group;
  int group_id;
  int first, last; /* components 0..dim-1                                 */
  quantity value, before;
  int amplitude_id;
  place at;
} fixing;

typedef enum { STEP_NONE, STEP_STATIC, STEP_QUASISTATIC } step_kind;

enum {
  PRINT_CONTACT = 1,
  PRINT_TOTALS = 2,
  PRINT_NODES = 4,
  PRINT_ELEMENTS = 8,
  PRINT_ENERGY = 16,
  PRINT_REACTIONS = 32
};

typedef struct print_request { /* one table of *PRINT                         */
  int table;         /* one bit of PRINT_*                                  */
  const char *group; /* nodes or elements of a group only; NULL: all        */
  int group_id;
  int frequency; /* every n-th increment and the last; 0: last only     */
  place at;
} print_request;

typedef struct step {
  const char *name;
  place at;
  int kind; /* step_kind                                           */
  double dt, total, dt_min, dt_max; /* s                                      */
  int n_load, n_fixing, n_print;
  load *loads;     /* [n_load] all in force, kept ones included           */
  fixing *fixings; /* [n_fixing]                                          */
  print_request *prints;
  int output_frequency; /* HDF5 fields: every n-th increment; 0: last only;
                           -1: no HDF5                                        */
  solver_choice solver;
  void *solver_param; /* owned                                               */
} step;

typedef struct model {
  deck *deck;
  message_log *log;
  const char *title; /* first line of *HEADING or ""                        */
  const char *job;   /* name without .inp and folders                       */
  const char *mesh_file;
  double mesh_scale;
  place mesh_at;
  const char *length_unit, *force_unit, *time_unit; /* labels or NULL         */
  int n_amplitude, n_material, n_section, n_obstacle, n_contact, n_step;
  amplitude *amplitudes;
  material *materials;
  section *sections;
  obstacle *obstacles;
  contact *contacts;
  step *steps;
  unsigned effects; /* bits EFFECT_*, set by model_check                   */
  int dim, ns;      /* from the mesh                                       */
} model;

/* clang-format off */
#define EFFECT_LIST(X)                                                        \
  X(CONTACT,  "unilateral contact")                                           \
  X(FRICTION, "friction")                                                     \
  X(NONLOCAL, "nonlocal average")                                             \
  X(HISTORY,  "history of slip")                                              \
  X(INELASTIC,"inelastic strain")                                             \
  X(THERMAL,  "thermal strain")                                               \
  X(BODY,     "body forces")                                                  \
  X(ESTIMATES,"error estimates")
/* clang-format on */
#define EFFECT_BIT(name, text) EFFECT_BIT_##name,
enum { EFFECT_LIST(EFFECT_BIT) EFFECT_COUNT };
#define EFFECT_MASK(name, text) EFFECT_##name = 1 << EFFECT_BIT_##name,
enum { EFFECT_LIST(EFFECT_MASK) EFFECT_ALL = (1 << EFFECT_COUNT) - 1 };

/* Everything the deck says, names not yet compared with the mesh. Errors go
 * to the log; *out is valid (free it) unless ERR_MEMORY. */
status model_from_deck(deck *d, message_log *log, model **out);
/* Compare with the mesh: groups, sections, supports; fill the _id fields and
 * the effects. Errors go to the log: ERR_DECK or ERR_MESH. */
status model_check(model *m, const mesh *msh);
void model_free(model *m);

/* Value of a load or amplitude; step time is t minus the start of the step. */
double amplitude_value(const amplitude *a, double step_t, double t);

#endif
