/*
 * Queries of the rows of the effects about the deck. "First" is in the order of
 * the deck, NULL if there is none.
 */
#pragma once

#include "model/model.h"

/* The first rule in any step that is like that, and its contact. */
const friction_rule *facts_first_rule(const model *m,
                                      int (*is)(const friction_rule *rule),
                                      const contact **of);
const contact *facts_first_given(const model *m); /* of *CONTACT FORCE */
const load *facts_first_body_load(const model *m);
const load *facts_first_temperature(const model *m);
/* A support that does work: it moves, or is removed under load. */
const load *facts_moving_support(const model *m);

/* Step with a *PRINT of these tables, and where; with fields in JOB.h5. */
const step *facts_first_print(const model *m, int tables, place *at);
const step *facts_first_fields(const model *m);
/* That shows, tries or checks the whole condensed problem. */
const step *facts_first_whole(const model *m);
/* That "is"; what of *ACCURACY it may be. */
const step *facts_first_step(const model *m, int (*is)(const step *s));
int facts_asks_mesh_error(const step *s);
int facts_asks_time_error(const step *s);
int facts_asks_theory(const step *s);
/* What in the step needs the entries of the condensed stiffness; NULL: nothing
 * does. */
const char *facts_reads_entries(const model *m, const step *s);

/* Section whose material has an inelastic law. */
const section *facts_first_inelastic(const model *m);
int facts_has_inelastic(const model *m); /* 1: its strains may change */
/* 1: inelastic strains before the first step, given or by their units. */
int facts_starts_strained(const model *m);
int facts_has_expansion(const model *m); /* 1: a material in use has it */
/* Material whose law depends on temperature; whose moduli do. */
const material *facts_first_warm_law(const model *m);
const material *facts_first_warm_moduli(const model *m);
int facts_has_warm_law(const model *m); /* 1: and temperatures are given */
int facts_has_warm_moduli(const model *m);

/* 1: *EFFECTS leaves friction out and bounds what it would have changed. */
int facts_omits_friction(const model *m);
