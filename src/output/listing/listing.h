/* JOB.lst, block by block. ERR_FILE if it cannot be written. */
#ifndef PROTIS_LISTING_LISTING_H
#define PROTIS_LISTING_LISTING_H

#include "base/text.h"
#include "output/listing/job.h"

/* Deck, model, effects. */
status listing_open(const job *j, text_file *lst);
/* The equations, once they are factored. */
status listing_ready(const job *j, text_file *lst);
/* An initial state that is given. */
status listing_start(const job *j, const start_report *s, text_file *lst);
/* An increment taken; tables at a time within one; an attempt cut. */
status listing_increment(const job *j, const state *s, text_file *lst);
status listing_between(const state *s, text_file *lst);
status listing_rejected(const state *s, const char *why, text_file *lst);
/* Warnings, accuracy, cost, exit code. */
status listing_verdict(const job *j, text_file *lst);

/* budget.c, for the files of this folder: the goals of an increment; at the end
 * budget of the errors, goals, what to improve, passes. */
void listing_goals_now(const job *j, const state *s, FILE *f);
void listing_accuracy(const job *j, FILE *f);

#endif
