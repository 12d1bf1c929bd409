/*
 * Hard scenes: a table of decks with what is expected of them, each run with
 * every method, form and integrator that applies, through the program in a
 * folder of its own.
 */
#pragma once

#include "scenes/mesh.h"
#include "support/job.h"

#include <stdio.h>

enum {
  QUICK = 1, /* part of the short run                                     */
  MAY_REFUSE = 2, /* AUTO too may end with exit 1 or 6 */
  NO_LAWS = 4,    /* no unilateral contact: its laws are not tested           */
  LARGE = 8       /* minutes each time: not with all kinds of outputs         */
};

/* Another way to put the same scene, and what it does to the answer. */
typedef struct scene_twin {
  mesh_change change;
  const char *words; /* of its command line, or NULL                        */
  double length, force; /* factors on u and on forces; 0: 1 */
  double tol; /* -, of the largest of a column; 0: bit for bit       */
} scene_twin;

typedef struct scene_row {
  const char *name, *hard; /* which scene, what is hard about it */
  const char *mesh;   /* words of scenes/mesh.h                           */
  const char *deck;   /* without *MESH. @S: *SOLVER stands here, in every
                         step; @V: FORM= of *QUASISTATIC; @I: INTEGRATOR=
                         of *VISCO. What a deck lacks is not tried        */
  const char *expect; /* tests of scenes/expect.h, or NULL                */
  mesh_change change;
  int verdict; /* exit code                                        */
  unsigned flags;
  const scene_twin *twin; /* or NULL */
} scene_row;

/* A family ends with a row without a name. */
extern const scene_row friction_scenes[], contact_scenes[], pair_scenes[],
    body_scenes[], number_scenes[], time_scenes[];

enum { SCENES = 500, SCENE_DECK = 9000 };

/* The rows of all families, or those with the flag QUICK; their number. */
int scenes_list(int quick, const scene_row *row[SCENES]);
/* scene.msh into the folder of a job and its deck with METHOD=AUTO. */
void scene_prepare(const scene_row *s, const job *j, char text[SCENE_DECK]);

/* Run all scenes, or those with the flag QUICK; print the matrix and what went
 * wrong. Number of fails. $SCENE: only scenes whose name has that in it;
 * $METHOD: only the column of that label; $JOBS: that many rows at a time. */
int scenes_run(int quick, FILE *out);
