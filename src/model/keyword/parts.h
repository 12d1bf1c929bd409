/*
 * The parts of model_from_deck after the cards are read. Errors of names go to
 * the log; a status is of memory. Private to src/model/keyword.
 */
#ifndef PROTIS_KEYWORD_PARTS_H
#define PROTIS_KEYWORD_PARTS_H

#include "model/keyword/keyword.h"

/* resolve.c: names to ids once all cards are read, then steps.c. "lost": a card
 * was refused, missing or unused names are not reported. */
status model_resolve(model *m, int lost);
/* 1: an unknown card has NAME= this. */
int name_is_lost(const model *m, const char *name);

#endif
