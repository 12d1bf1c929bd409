/*
 * Private to src/deck: what the stages of the deck reader share.
 *
 *   line.c     physical lines of the files, includes as a stack of sources;
 *              logical lines: comments cut, continuation joined, split at
 *              commas
 *   value.c    *PARAMETER, -D, <NAME> replaced, fields and their values
 *   legacy.c   formats of fixed columns
 *   deck.c     cards and records
 *   store.c    the memory of a deck
 */
#pragma once

#include "base/text.h"
#include "deck/deck.h"

enum {
  LINE_MAX_BYTES = 4096,
  INCLUDE_DEPTH = 16,
  INCLUDE_TOTAL = 1000,
  PARAMETER_MAX = 64, /* parameters of one card */
  FORMAT_MAX = 4096   /* columns and fields of a format */
};

/* store.c ---------------------------------------------------------------- */

typedef struct chunk chunk;

struct deck_text {
  chunk *last; /* strings, places and fields, newest chunk first */
  int card_capacity, symbol_capacity, file_capacity, input_capacity;
  int n_slot; /* size of the hash table: a power of two, or 0 */
  int *slot;  /* [n_slot] symbol number from 1; 0: free */
};

/* Zeroed memory that is valid until memory_free; NULL if refused. */
void *store_new(deck *d, size_t n, size_t size);
/* Copy of n bytes, terminated by a NUL; NULL if refused. */
char *store_text(deck *d, const char *text, size_t n);
const place *store_place(deck *d, const place *p);

/* A growing text. */
typedef struct buffer {
  char *text; /* NULL while empty */
  int n, capacity;
} buffer;

/* Append n bytes; the text stays terminated by a NUL. */
status buffer_add(buffer *b, const char *text, size_t n);

int is_name_start(char c);
int is_name_part(char c);
/* Without the blanks at both ends: first character and length. */
const char *trim(const char *text, size_t n, size_t *length);
/* Upper case, each run of blanks one blank. */
char *store_name(deck *d, const char *text, size_t n);

/* line.c: physical lines ------------------------------------------------- */

/* A physical line that is neither blank nor comment, as text_shown writes it.
 * Valid until the next call for the same source. */
typedef struct physical {
  const char *text;
  int length, line_no;
} physical;

typedef struct source source;

/* Push a file on the stack *top. "at": place of the *INCLUDE; NULL: the deck.
 * A file that cannot be read is a message and leaves the stack as it is. */
status source_open(deck *d, message_log *log, const char *file, const place *at,
                   source **top);
/* Next line; *line NULL at the end of this file. */
status source_next(source *s, message_log *log, const physical **line);
void source_pop(source **top);
/* A place in it. */
place source_place(const source *s, int line_no, int column, const char *line);
/* 1: messages show nothing of it. */
int source_hidden(const source *s);

/* line.c: logical lines -------------------------------------------------- */

typedef struct segment {
  int start; /* of the physical line in the logical one */
  place at;  /* column 0; line text in the deck */
} segment;

/* A logical line: physical ones joined, comments cut. */
typedef struct logical {
  buffer all;
  int n_segment, segment_capacity;
  segment *segments;
} logical;

typedef struct reader {
  deck *d;
  message_log *log;
  source *top;
  int n_include;
  logical line;
  buffer scratch;      /* text with names replaced */
  int mode;            /* how data lines are read: deck.c */
  int record_capacity; /* of the last card */
  /* of *LEGACY: in use, for the next card */
  struct format *format, *waiting_format;
  const char *waiting_text; /* of waiting_format */
  place legacy_at;
  int stray_seen, excess_seen; /* reported once for the lines below a card */
} reader;

/* Under *PARAMETER a ** that could be meant as a power is an error. */
typedef enum { LINE_FREE, LINE_DEFINITION } line_kind;

/* Fill r->line from the line given and its continuation lines. */
status logical_read(reader *r, const physical *first, line_kind kind);
/* Place of a byte of the logical line. */
place logical_place(const logical *l, int byte);

/* Piece of the logical line between separators, blanks cut. */
typedef struct piece {
  int start, length;
  int next; /* byte after the comma, or -1 at the end of the line */
} piece;

/* Cut at the next comma outside quotes, and outside parentheses if "nested".
 * Blanks around are cut. */
piece logical_piece(const logical *l, int from, int nested);

/* value.c: a field from a piece: quotes taken off, names replaced. "on_card":
 * value of a parameter, where a quoted name alone is text and not an
 * expression. */
status field_read(reader *r, piece p, int on_card, field *out);

/* value.c ---------------------------------------------------------------- */

/* store.c: the symbol of that name, case ignored, or NULL; symbol_use marks it
 * as used. A new symbol. */
symbol *symbol_find(const deck *d, const char *name, size_t n);
symbol *symbol_use(const deck *d, const char *name, size_t n);
status symbol_add(deck *d, const char *name, size_t n, symbol **out);
/* Replace each <NAME>. What stands in quotes is an expression: a negative
 * value is put in parentheses there, and x y z t are left alone. "lenient":
 * unknown names are left alone and are no error. *out belongs to the deck. */
typedef enum { REPLACE_PLAIN, REPLACE_EXPRESSION, REPLACE_LENIENT } replacing;
status symbols_replace(reader *r, const char *text, size_t n, replacing how,
                       const place *at, const char **out);
/* One line under *PARAMETER, in r->line. */
status symbols_define(reader *r);
status symbols_from_command(reader *r, const char *define);

/* legacy.c --------------------------------------------------------------- */

typedef struct format format;

/* ERR_DECK: the record says what is wrong. */
status format_read(const char *text, format **out);
/* Cut a physical line into a record. */
status format_record(reader *r, const format *f, const physical *line,
                     record *out);
