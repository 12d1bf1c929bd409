/*
 * A model from the text of a deck, checked against a mesh made in memory.
 */
#pragma once

#include "base/memory.h"
#include "model/check/check.h"
#include "model/keyword/keyword.h"
#include "support/grid.h"

typedef struct text_model {
  message_log *log;
  deck *d;
  model *m;
  mesh *msh; /* owned                                                         */
  status st; /* of model_from_deck and model_check                            */
} text_model;

/* Reads it; messages go to stdout if it fails. "msh" is then its own. */
text_model text_model_read(const char *text, mesh *msh);
void text_model_close(text_model *s);
/* TEXT_MODEL s = ...: closed where the name ends. */
#define TEXT_MODEL ENDS_BY(text_model_close) text_model
