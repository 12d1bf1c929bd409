/*
 * The input deck as text: cards with parameters and data lines, each with its
 * place. It handles the grammar and the language cards (*INCLUDE, *PARAMETER,
 * *LEGACY), no mechanics. The meaning of the cards is in model/keywords.c.
 *
 * The language cards are processed here and do not appear in deck.card; their
 * results are in deck.symbols, deck.files and card.format. A card whose name
 * cannot be read is reported and left out together with its data lines.
 *
 * Grammar, beyond what README says:
 * - ** starts a comment wherever it stands outside quotes; under *HEADING only
 *   at the start of a line. Blank lines mean nothing anywhere.
 * - A line ending in a comma is continued, but a data line before a card or
 *   before the end of its file just ends. Under *HEADING each line is a record
 *   of one field, commas and quotes are text, and unknown <NAME> are unchanged.
 * - *INCLUDE does not end a card: the file may continue its data lines.
 * - NAME = VALUE under *PARAMETER is an expression: 3+1 is 4. A value such as
 *   1.5+03, which could be a number with exponent, is an error.
 * - The text of a quoted field without x y z t is its value, in full digits.
 *   On a card what is no expression, or a name alone, is taken as it is: so a
 *   name of a file may have commas and blanks.
 * - Fixed columns: a blank numeric field is 0 as in Fortran, but the line ends
 *   with its last filled field; blanks inside a number are an error; a real
 *   without a point gets that of Fw.d. Text after the last column: warning.
 *
 * All strings belong to the deck and are valid until memory_free.
 */
#pragma once

#include "base/message.h"
#include "deck/expression.h"

typedef struct field {
  const char *text; /* blanks around it cut, <NAME> replaced; "" if empty */
  int quoted;       /* stood in "...": an expression */
  place at;
} field;

typedef struct record {
  int n_field;
  field *fields;   /* [n_field]; a last empty field (comma at end) is cut */
  const char *raw; /* the line as it stands in the file (first if continued) */
  place at;
} record;

typedef struct parameter {
  const char *name; /* upper case, inner blanks single */
  field value;      /* text "" if the name stands alone */
  int has_value;
  place at;
} parameter;

typedef struct card {
  const char *name; /* without *, upper case, inner blanks single */
  int n_parameter, n_record;
  parameter *parameters; /* [n_parameter] in the order of the deck */
  record *records;       /* [n_record] */
  const char *format;    /* of the *LEGACY before it, or NULL */
  int damaged;           /* a parameter was refused, it may be a missing one */
  place at;
} card;

typedef struct symbol {
  const char *name; /* upper case */
  double value;
  const char *typed; /* as *PARAMETER, else as -D, spells it */
  int overridden;    /* by -D on the command line */
  int used;          /* the deck refers to it */
  int in_geometry;   /* the .geo has it */
  place at;          /* of its *PARAMETER line; at.file NULL: by -D alone */
} symbol;

typedef struct deck {
  const char *file; /* as given */
  int n_card, n_symbol;
  card *cards;
  symbol *symbols; /* [n_symbol] *PARAMETER and -D */
  int n_file;
  const char **files; /* [n_file] the deck and its includes, as read */
  int n_input;
  const char **inputs;   /* [n_input] all files the deck names, itself first */
  struct deck_text *own; /* strings, files, expressions: private */
} deck;

/* Read a deck and its includes. "defines": "NAME=VALUE" texts of -D, each of
 * which wins over *PARAMETER; one that no *PARAMETER names still counts. Errors
 * of grammar go to the log and reading continues; *out is valid (free it)
 * unless the status is ERR_MEMORY or ERR_FILE (the deck itself cannot be read:
 * message in the log too). The status is OK with grammar errors. */
status deck_read(const char *file, int n_define, const char *const *defines,
                 message_log *log, deck **out);

const parameter *card_parameter(const card *c, const char *name); /* or NULL */
/* Value field as number or expression: a quoted field is compiled with the
 * symbols of the deck; "names" of the variables as in expression_compile_in,
 * NULL: x y z t. Anything wrong goes to the log; 0 if fine, else -1. */
int deck_quantity(deck *d, const field *f, const char *const names[4],
                  message_log *log, quantity *out);
/* The same for an expression of other variables than x y z t: "names" as in
 * expression_compile_in. The deck owns it. */
int deck_formula(deck *d, const field *f, const char *const names[4],
                 message_log *log, const expression **out);
int deck_real(const field *f, message_log *log, double *out);
int deck_int(const field *f, message_log *log, int *out);
/* Name of a file in a card, relative to the file the card stands in; one of the
 * inputs from now on, owned by the deck. NULL without memory. */
const char *deck_path(deck *d, const field *f);
/* Another file that is read: the text is borrowed. ERR_MEMORY. */
status deck_input(deck *d, const char *path);
status deck_input_copy(deck *d, const char *path); /* the text is copied */
/* Symbol by name for expressions: a symbol_value_fn whose ctx is the deck. */
int deck_symbol(const void *deck_, const char *name, double *value);
