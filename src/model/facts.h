/*
 * Queries of the rows of the effects about the deck. "First" is in the order of
 * the deck, NULL if there is none.
 */
#pragma once

#include "model/model.h"

/* A support that does work: it moves, or is removed under load. */
const load *facts_moving_support(const model *m);

/* Step that shows, tries or checks the whole condensed problem. */
const step *facts_first_whole(const model *m);
const step *facts_first_step(const model *m, int (*is)(const step *s));
/* What in the step needs the entries of the condensed stiffness; NULL: nothing
 * does. */
const char *facts_reads_entries(const model *m, const step *s);

/* Section whose material has an inelastic law. */
const section *facts_first_inelastic(const model *m);
int facts_has_inelastic(const model *m); /* 1: its strains may change */
/* 1: inelastic strains before the first step, given or by their units. */
int facts_starts_strained(const model *m);
/* 1: *INITIAL CONDITIONS has lines of an initial_type. */
int facts_has_initial(const model *m, int type);
/* 1: MOVE has the sphere off the axis of an axisymmetric model at time t. */
int facts_leaves_axis(const model *m, int obstacle_id, double t);
