/*
 * The input deck as text: cards with parameters and data lines, each with its
 * place. Knows the grammar and the language cards (*INCLUDE, *PARAMETER,
 * *LEGACY), and no mechanics. The meaning of the cards is in model/keywords.c.
 *
 * All strings belong to the deck and live until deck_free.
 */
#ifndef PROTIS_DECK_DECK_H
#define PROTIS_DECK_DECK_H

#include "base/message.h"
#include "deck/quantity.h"

typedef struct field {
  const char *text; /* blanks around it cut, <NAME> replaced; "" if empty    */
  int quoted;       /* stood in "...": an expression                         */
  place at;
} field;

typedef struct record {
  int n_field;
  field *fields;   /* [n_field]; a last empty field (comma at end) is cut    */
  const char *raw; /* the line as it stands in the file (first if continued) */
  place at;
} record;

typedef struct parameter {
  const char *name; /* upper case, inner blanks single                       */
  field value;      /* text "" if the name stands alone                      */
  int has_value;
  place at;
} parameter;

typedef struct card {
  const char *name; /* without *, upper case, inner blanks single            */
  int n_parameter, n_record;
  parameter *parameters; /* [n_parameter] in the order of the deck           */
  record *records;       /* [n_record]                                       */
  place at;
} card;

typedef struct symbol {
  const char *name; /* upper case                                            */
  double value;
  int overridden; /* by -D on the command line                             */
} symbol;

typedef struct deck {
  const char *file; /* as given                                              */
  int n_card, n_symbol;
  card *cards;
  symbol *symbols;       /* [n_symbol] *PARAMETER and -D                     */
  struct deck_text *own; /* strings, files, expressions: private             */
} deck;

/* Read a deck and its includes. "defines": "NAME=VALUE" texts of -D, each of
 * which wins over *PARAMETER; one that no *PARAMETER names still counts.
 * Errors of grammar go to the log and reading goes on; *out is valid (free
 * it) unless the answer is ERR_MEMORY or ERR_FILE (the deck itself cannot be
 * read: message in the log too). */
status deck_read(const char *file, int n_define, const char *const *defines,
                 message_log *log, deck **out);
void deck_free(deck *d);

const parameter *card_parameter(const card *c, const char *name); /* or NULL */
/* Value field as number or expression: a quoted field is compiled with the
 * symbols of the deck. Anything wrong goes to the log; 0 if fine, else -1. */
int deck_quantity(deck *d, const field *f, message_log *log, quantity *out);
int deck_real(const field *f, message_log *log, double *out);
int deck_int(const field *f, message_log *log, int *out);
/* Name of a file in a card, relative to the file the card stands in; owned by
 * the deck. NULL without memory. */
const char *deck_path(deck *d, const field *f);
/* Symbol by name for expressions: a symbol_value_fn whose ctx is the deck. */
int deck_symbol(const void *deck_, const char *name, double *value);

#endif
