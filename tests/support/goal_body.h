/*
 * Decks with *GOAL on bodies of scenes/mesh.h, and what they tell.
 */
#pragma once

#include "scenes/mesh.h"
#include "support/job.h"

#define PLANE "PLANE\n0., 0.\n0., 1."
#define NORMAL "*GOAL, NAME=N, QUANTITY=FORCE, CONTACT=C\n"
#define CONTACT "\n*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"

/* block.msh of the job. */
void body_write_mesh(const job *j, const char *words,
                     const mesh_change *change);
/* A body of these words on an obstacle with cards; type: more of *SOLID
 * SECTION. */
job body_of_type(const char *type, const char *words, const char *cards);
job body_of(const char *words, const char *cards);
/* A block of 2 x 1 with n x n squares on an obstacle. */
job body_of_block(int n, const char *on, const char *cards);
/* A goal: its estimate is from "least" to "most" of its error, which is in the
 * band, and the band at most "wide" of the error. */
void goal_check_row(const job *j, int row, double exact, double least,
                    double most, double wide);
void goal_check(const job *j, double exact, double least, double most,
                double wide);
int goal_has_verdict(const job *j, const char *goal, const char *word);
