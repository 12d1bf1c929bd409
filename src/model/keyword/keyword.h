/*
 * The table of deck keywords and its users: reading a deck, its echo, the help.
 * A card is one row of keyword_table; most rows need a function for their data
 * lines (model/cards/cards.h).
 */
#pragma once

#include "model/cards/cards.h"

#include <stdio.h>

/* Where a card is allowed. */
enum {
  IN_MODEL = 1,    /* before the first *STEP */
  IN_MATERIAL = 2, /* after *MATERIAL, up to the next card of the model */
  IN_STEP = 4,     /* between *STEP and *END STEP */
  LANGUAGE = 8     /* read by the deck reader; allowed anywhere */
};

typedef struct keyword {
  const char *name;
  unsigned where;        /* IN_... or LANGUAGE */
  const option *options; /* of card_options, or NULL */
  /* Options of what the card names; an unknown name goes to the log. */
  plugin (*names)(const reading *r);
  apply_card *apply;      /* ERR_MEMORY only: the rest goes to the log */
  int min_line, max_line; /* data lines; max -1: any number */
  const char *data;       /* what the data lines hold */
  const char *help;
} keyword;

extern const keyword keyword_table[];          /* name NULL at the end */
const keyword *keyword_find(const char *name); /* or NULL */

/* Read the parameters of r->card into param and plugin_param[PARAM_SIZE]; fills
 * r->param and r->plugin. Errors go to the log. */
void keyword_parameters(const keyword *row, reading *r, card_options *param,
                        void *plugin_param);

/*
 * The contents of the deck; names are compared with each other, not yet with
 * the mesh. Errors go to the log (ERR_DECK); *out is valid (free it) unless
 * ERR_MEMORY. The model borrows deck and log.
 */
status model_from_deck(deck *d, message_log *log, model **out);

/* resolve.c: names to ids once all cards are read. "lost": a card was refused,
 * missing or unused names are not reported. */
status model_resolve(model *m, int lost);
/* 1: an unknown card has NAME= this. */
int name_is_lost(const model *m, const char *name);

/* The deck of a model with all defaults written out, includes and parameters
 * resolved; reading it gives the same model. For text_made, too. */
status model_echo(FILE *out, const void *of);
/* Help from the keyword table: all cards in short, or one in full; 0 if there
 * is no card of that name. */
int keywords_print(const char *name, FILE *out);
