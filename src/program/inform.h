/*
 * Information without solving: version, lists, the check of a deck.
 */
#ifndef PROTIS_INFORM_H
#define PROTIS_INFORM_H

#include "base/status.h"

/* As in src/manual/changes.md: a change of the second number may change what a
 * deck means or what its files hold. */
#define PROTIS_VERSION "0.2.0"

struct exchange_problem;
struct mesh;
struct model;

/* "commit" of the sources, or "unknown". */
void inform_version(const char *commit);
/* All cards, or one in full; 0 if there is no card of that name. */
int inform_keywords(const char *name);
/* The card whose name is nearest, or NULL. */
const char *inform_nearest_card(const char *name);

/* protis JOB --check: sizes, memory, effect plan, motions that nothing or only
 * contact holds; solves nothing. ERR_SINGULAR if a body is free. */
status inform_check(const struct model *m, const struct mesh *msh);
/* The same for a deck with *CONDENSED PROBLEM: sizes and effect plan. */
status inform_check_problem(const struct model *m,
                            const struct exchange_problem *p);

/* The nearest of the words next(NULL, i), NULL at their end; or NULL. */
const char *inform_nearest(const char *word,
                           const char *(*next)(const void *ctx, int i));

#endif
