/*
 * Decks that ask for other tables, fields and estimates: the answer stays.
 */
#pragma once

#include "support/job.h"

/* What a deck asks for in each step, in the place of its own cards. */
typedef struct asked {
  const char *print;    /* words of *PRINT, "": none; NULL: those of the deck */
  const char *output;   /* the same of *OUTPUT                               */
  const char *accuracy; /* the same of *ACCURACY                             */
} asked;

/* Number of combinations of tables, fields and estimates, and number k. */
int asked_count(void);
asked asked_number(int k);
/* As text, for messages. */
void asked_text(const asked *a, char text[200]);

/* A deck with other requests; caller frees. */
char *asked_deck(const char *deck, const asked *a);
/* What JOB.json tells of the increments whatever is asked for: times, states,
 * iterations, residuals, energy defects; caller frees. NULL: no JOB.json. */
char *asked_answer(const job *j);
/* 1: the answer of the deck does not depend on these requests, bit for bit:
 * estimates of the increments share the contact solver with them, and balanced
 * ones decide. */
int asked_keeps(const char *deck, const asked *a);
