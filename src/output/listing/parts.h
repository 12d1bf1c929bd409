/*
 * The parts of the listing: an increment (increment.c), the solutions of CHECK=
 * (solutions.c), the theorems of THEORY= (theory.c), the budget of the errors
 * (budget.c), the passes towards a target (passes.c). Each writes nothing where
 * it is not required. Private to src/output/listing.
 */
#ifndef PROTIS_LISTING_PARTS_H
#define PROTIS_LISTING_PARTS_H

#include "output/listing/listing.h"

#include <stdio.h>

enum { DIGITS = 5 }; /* after the point */

/* ---- solutions.c ---- */
/* The solutions that CHECK= found. */
void listing_solutions(const state *s, FILE *f);

/* ---- theory.c ---- */
/* The theorems of an increment. */
void listing_theory(const job *j, const state *s, FILE *f);

/* ---- budget.c ---- */
/* Errors reached, their cost, and the cost of the estimates. */
void listing_budget(const job *j, FILE *f);
/* ---- goals.c ---- */
/* Those of an increment; at the end of the listing. */
void listing_goals_now(const job *j, const state *s, FILE *f);
void listing_goals(const job *j, FILE *f);

/* ---- passes.c ---- */
/* The passes towards the target, and what a digit more would cost. */
void listing_passes(const job *j, FILE *f);

/* ---- advice.c ---- */
/* job_advice, a line for each of its parts. */
void listing_advice(const job *j, FILE *f);

#endif
