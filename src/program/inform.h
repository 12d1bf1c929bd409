/* Information without solving: version, lists, the check of a deck. */
#pragma once

#include "base/status.h"

/* As in src/manual/changes.md: a change of the second number may change what a
 * deck means or what its files hold. */
#define PROTIS_VERSION "0.2.0"

struct exchange_problem;
struct mesh;
struct model;

/* "commit" of the sources, or "unknown". */
void inform_version(const char *commit);
/* All cards, or one in full; 0: there is no card of that name, *near is the one
 * whose name is nearest, or NULL. */
int inform_keywords(const char *name, const char **near);

/* nearest_word, for files that include getopt.h: of the words next(ctx, i),
 * NULL at their end; or NULL. */
typedef const char *next_word(const void *ctx, int i);
const char *inform_nearest(const char *word, next_word *next, const void *ctx);

/* protis JOB --check: sizes, memory, effect plan, motions that nothing or only
 * contact holds; solves nothing. ERR_SINGULAR if a body is free. */
status inform_check(const struct model *m, const struct mesh *msh);
/* The same for a deck with *CONDENSED PROBLEM: sizes and effect plan. */
status inform_check_problem(const struct model *m,
                            const struct exchange_problem *p);
