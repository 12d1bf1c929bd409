/*
 * Options: the parameters of keywords, solvers and laws, described in tables
 * that are used for reading, range checks, help, the echo of defaults and the
 * tests.
 *
 * OPTIONS(table, row, ...) is a table. Each row is written with OPTION_REAL and
 * its kin; the macro compares pointer types inside sizeof, so a row whose field
 * has another type does not compile.
 */
#pragma once

#include <limits.h>
#include <stddef.h>
#include <stdio.h>

typedef enum { OPT_INT, OPT_REAL, OPT_FLAG, OPT_NAME, OPT_CHOICE } option_type;

typedef struct option {
  const char *name; /* as in the deck, upper case */
  option_type type;
  size_t offset;       /* offsetof() in the parameter struct */
  double min, max;     /* closed range; OPT_INT and OPT_REAL */
  const char *initial; /* text of the value if absent; NULL: must be given;
                          OPTION_ABSENT: may be left out, field stays zero */
  const char *unit;    /* dimension: "length", "force/length^2", "-" */
  const char *choices; /* OPT_CHOICE: words joined by |, field = their rank */
  const char *help;    /* one line */
} option;

#define OPTION_ABSENT "(none)"

#define OPTION_OFFSET(struct_, field, type) \
  (offsetof(struct_, field) + 0 * sizeof(&((struct_ *)0)->field == (type *)0))
/* clang-format off */
#define OPTION_INT(struct_, field, name, min, max, initial, unit, help)       \
  {name, OPT_INT, OPTION_OFFSET(struct_, field, int), min, max, initial,      \
   unit, NULL, help}
#define OPTION_REAL(struct_, field, name, min, max, initial, unit, help)      \
  OPTION_REAL_WORD(struct_, field, name, min, max, initial, unit, NULL, help)
/* The same, or one of the words of "choices": then OPTION_WORD(rank). */
#define OPTION_WORD(rank) (-1.0 - (rank))
#define OPTION_REAL_WORD(struct_, field, name, min, max, initial, unit,       \
                         choices, help)                                       \
  {name, OPT_REAL, OPTION_OFFSET(struct_, field, double), min, max, initial,  \
   unit, choices, help}
/* YES or NO; the bare name means YES. Field: int 0 or 1. */
#define OPTION_FLAG(struct_, field, name, initial, help)                      \
  {name, OPT_FLAG, OPTION_OFFSET(struct_, field, int), 0, 1, initial, "-",    \
   NULL, help}
/* Any text, case kept. Field: const char *, borrowed from the caller. */
#define OPTION_NAME(struct_, field, name, initial, help)                      \
  {name, OPT_NAME, OPTION_OFFSET(struct_, field, const char *), 0, 0,         \
   initial, "-", NULL, help}
/* One of the words of "choices", case ignored. Field: int, rank from 0. */
#define OPTION_CHOICE(struct_, field, name, choices, initial, help)           \
  {name, OPT_CHOICE, OPTION_OFFSET(struct_, field, int), 0, 0, initial, "-",  \
   choices, help}
#define OPTION_END {NULL, OPT_INT, 0, 0, 0, NULL, NULL, NULL, NULL}
#define OPTIONS(table, ...) \
  static const option table[] = {__VA_ARGS__, OPTION_END}
/* clang-format on */

/* Row of that name (exact, upper case), or NULL. */
const option *option_find(const option *table, const char *name);
/* Store every initial value that has one. */
void option_defaults(const option *table, void *parameters);
/* Read text into the field of one row; 0, or -1 and a message of what is
 * wrong in "why": "2.5 outside [0, 2]", "not a number: 'x'". NULL text: the
 * name stood alone (a flag then means YES). */
int option_read(const option *row, const char *text, void *parameters,
                char *why, size_t why_size);
/* The value of a field as text that option_read takes back exactly. */
void option_write(const option *row, const void *parameters, char *text,
                  size_t size);
/* The rows for a manual: kind, range, unit, default and help. Accepts NULL. */
void option_print(const option *table, FILE *out);
/* What is wrong with x outside [min, max]: "-1 is not positive", "2.5 outside
 * [0, 2]"; a limit that no number can pass is not shown. */
void range_text(double x, double min, double max, char *why, size_t why_size);
/* Word of that rank in "A|B|C" into text; rank of a word, or -1. */
void choice_word(const char *choices, int rank, char *text, size_t size);
int choice_rank(const char *choices, const char *word);
/* The candidate nearest to a misspelled word, or NULL if none is near.
 * next(ctx, i) gives candidate i, NULL at the end. */
const char *nearest_word(const char *word,
                         const char *(*next)(const void *ctx, int i),
                         const void *ctx);

/* Candidates: the member "name" of n rows, or of the rows that pointers of a
 * list point to; NULL ends both. */
typedef struct name_list {
  const void *first;
  int n;
  size_t size;   /* of a row */
  size_t behind; /* 0, or 1 + offset of the name behind the pointer */
  size_t offset; /* of what a row has to show */
} name_list;
/* rows may be NULL where there are none. */
#define NAMES(rows, n)                              \
  (&(const name_list){(rows), n, sizeof *(rows), 0, \
                      offsetof(__typeof__(*(rows)), name)})
#define LISTED(list)                                   \
  (&(const name_list){(list), INT_MAX, sizeof *(list), \
                      1 + offsetof(__typeof__(**(list)), name), 0})
/* Name i of a name_list: for nearest_word. */
const char *candidate_name(const void *names, int i);
