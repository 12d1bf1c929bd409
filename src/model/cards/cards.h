/*
 * What the cards of a deck mean: a function for each that needs one, with the
 * card as the keyword table (model/keyword/keyword.h) describes it. Errors of
 * the deck go to the log; a status is of memory.
 */
#pragma once

#include "model/model.h"

/* The options of the cards; the rows of the keyword table say which of them a
 * card has. */
typedef struct card_options {
  const char *name, *group, *file, *amplitude, *contact, *law;
  int type; /* also MODE, FORM, GENERATE, LAW of *CREEP */
  int time, op, frequency;
  double radius, max_memory, tol;
  double value[EFFECT_VALUES]; /* of an effect */
  law_shift shift;
  struct {
    const char *length, *force, *time;
  } units; /* labels */
  struct {
    const char *elset, *material;
    int moduli, formulation, incompatible;
    double scale, zero, thickness;
  } body; /* of the mesh, materials, sections and the start */
  struct {
    const char *obstacle;
    int normal, side, slave, adjust, update, table;
  } surface; /* of obstacles, contacts, pairs, friction */
  struct {
    const char *integrator;
    int iteration, substeps;
    double theta, tolerance;
  } visco;
  struct {
    const char *method;
    int max_iter, limit_max_iter, check, stiffness, nested;
    double share;
  } solver;
  struct {
    int mesh, max_passes, solver, theorems;
    double max_cpu, target, time_share;
  } accuracy;
  struct {
    const char *crack, *from, *target;
    int quantity, component;
  } goal;
  struct {
    const char *points;
    int hdf5, condensed, print[PRINT_COUNT];
  } output;
} card_options;
enum { CREEP_STRAIN, CREEP_TIME, CREEP_NORTON, CREEP_HYPERBOLIC };
#define CREEP_WORDS "STRAIN|TIME|NORTON|HYPERB"
enum { TIME_NO, TIME_YES, TIME_BALANCED }; /* TIME= of *ACCURACY */

/* State of reading a deck, card by card. */
typedef struct reading {
  model *m;
  const card *card;          /* the current card */
  const card_options *param; /* its options */
  const void *plugin; /* options of the law or solver it names, or NULL */
  size_t plugin_size;
  int material_id; /* open *MATERIAL, or -1 */
  int misread;     /* a parameter of the card was refused */
  int lost;        /* a card was refused, it may be what is missing */
  int in_step;     /* inside *STEP ... *END STEP */
  /* names of variables, or NULL */
  const char *const *axisymmetric;
  int lost_material,
      lost_step; /* 1: an unknown card seems to have opened one */
  /* 1: such a card has the name, its absence is not reported; NULL: there is
   * none */
  int (*is_lost)(const model *m, const char *name);
} reading;

/* Names of the variables of expressions if some *SOLID SECTION of the deck is
 * axisymmetric: r and z too, but R where it is a *PARAMETER; else NULL. */
const char *const *axisymmetric_names(const deck *d);

/* Options of a law or solver that a card names; NULL: none. */
typedef struct plugin {
  const option *options;
  size_t size;
  const char *parameter, *name; /* METHOD, newton; NULL: not known */
} plugin;

enum { PARAM_SIZE = 512 }; /* space for the options of any plug-in */

/* What a card means, of which the options are r->param. */
typedef status apply_card(reading *r);
/* part.c: title, units, mesh, sections, amplitudes, times */
apply_card apply_heading, apply_units, apply_mesh, apply_condensed_problem,
    apply_section, apply_amplitude, apply_time_points, apply_effects;
/* material.c */
apply_card apply_material, apply_elastic, apply_density, apply_expansion,
    apply_inelastic, apply_creep, apply_viscoelastic, apply_trs;
/* reference.c */
apply_card apply_reference, apply_goal;
/* contact.c; apply_effect: any whose options are CONTACT= and numbers */
apply_card apply_obstacle, apply_contact, apply_contact_pair, apply_tie,
    apply_crack, apply_friction, apply_contact_force, apply_effect;
/* procedure.c */
apply_card apply_step, apply_end_step, apply_static, apply_quasistatic,
    apply_visco, apply_solver, apply_accuracy, apply_print, apply_output,
    apply_restart;
/* load.c */
apply_card apply_boundary, apply_dsload, apply_dload, apply_cload,
    apply_temperature, apply_initial;

/* The options of what a card names. */
plugin names_inelastic(const reading *r);
plugin names_law(const reading *r);
plugin names_solver(const reading *r);
/* Once all cards are read: the law of a material together with its
 * elasticity. */
status material_resolve_law(const model *m, material *mat);
/* Place of a component of *REFERENCE in "value", -1: there is none of that name
 * in such a model. */
int reference_place(const char *name, int dim, int axisymmetric);
/* Id of a contact, or -1 and the error that this card names none. */
int find_contact(const reading *r, const char *name);

/* 0 if the line has min..max fields. */
int record_fields(const reading *r, const record *line, int min, int max,
                  const char *expected);
int field_real(const reading *r, const field *f, double min, const char *what,
               double *out);
int field_int(const reading *r, const field *f, int min, int max,
              const char *what, int *out);
int field_quantity(const reading *r, const field *f, quantity *out);
/* Path of the FILE= of the card from where the deck stands; NULL: not given. */
status field_file(const reading *r, const char **path);
/* Field of pair number i of the lines of a card: its first or second. */
const field *pair_field(const card *c, int i, int second);
/* Pairs over all lines (any number per line) as a table; arrays are new. */
status read_pairs(reading *r, int variable, value_table *out);
/* Compare words without regard to case. */
int same_word(const char *a, const char *b);
/* Place of a parameter's value, or of the card. */
const place *value_place(const reading *r, const char *parameter);
/* Warn that a parameter, which is not its default, counts only with another. */
void report_idle(const reading *r, const char *name, const char *with);
/* Report NAME= given twice; 1 if "old" has it. */
int name_taken(const reading *r, const char *name, const char *old);
/* The same, or that the tables show both as one name. */
void shown_name_taken(const reading *r, const char *name, const char *old);
/* Report a word that names nothing, with the nearest of those there are, or
 * all: "text" precedes it, as "there is no *MATERIAL, NAME=". */
void unknown_word(message_log *log, message_id id, const place *at,
                  const char *text, const char *word,
                  const char *(*next)(const void *ctx, int i), const void *ctx);
/* Id of a name, case ignored, or -1; find_name: and an error that names the
 * card to write. */
int rank_of_name(const name_list *names, const char *name);
int find_name(const model *m, const char *name, const char *title,
              const name_list *names, const place *at);
/* Id of an amplitude, or -1 and an error. */
int find_amplitude(const model *m, const char *name, const place *at);
/* The step that is being read. */
step *open_step(const reading *r);
