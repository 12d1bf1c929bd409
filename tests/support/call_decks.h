/*
 * Decks of small runs that between them call for most effects, methods and
 * files: for tests of what happens when a call fails.
 */
#pragma once

#include "support/job.h"

typedef struct call_deck {
  const char *kind;
  const char *first; /* deck of a run before, first.inp, or NULL             */
  const char *text;
  const char *words; /* of the command line                                  */
} call_deck;

extern const call_deck call_decks[];
extern const int n_call_deck;

/* A folder with both decks and all they read. */
job call_deck_write(const call_deck *d);
