/*
 * Messages to the user about the input: collected, so that one pass shows all
 * of them, each with its place, a caret under it, a stable number and advice.
 *
 *   block.inp:14:1: error P1003: unknown card *FRICTON; did you mean *FRICTION?
 *       14 | *FRICTON, CONTACT=FOOT
 *          | ^
 *
 * The numbers are stable: a row may be added, no number gets another meaning.
 * P1: grammar of the deck; P2: cards and model; P3: mesh; P4: contact and
 * supports; P5: results and files.
 */
#pragma once

#include "base/status.h"

#include <stdio.h>

typedef struct place {
  const char *file;         /* as the user named it; NULL: no file */
  int line_no, column_no;   /* from 1; 0: unknown. Columns count bytes */
  const char *line;         /* text of the line for the caret, or NULL */
  const struct place *from; /* place of the *INCLUDE of this file, or NULL */
  int hidden;               /* 1: messages show nothing of it: no deck */
} place;

typedef enum { NOTE, WARNING, ERROR } severity;

typedef struct message_log message_log;

/* MESSAGE_LIST(X), a row X(number, severity, title, remedy) each: made of
 * src/manual/messages.md by tools/list_messages. */
#include "base/messages.h"
#define MESSAGE_ENUM(number, severity, title, remedy) P##number = number,
typedef enum { MESSAGE_LIST(MESSAGE_ENUM) P_END } message_id;

status message_log_new(message_log **log);
/* Add one; the texts are copied. "at" may be NULL (no place). A note or warning
 * that is there already, with its place and text, is not added again. After 100
 * of a severity the rest is only counted. Never fails: without memory the
 * message is counted, and message_status returns ERR_MEMORY. */
void message_add(message_log *log, message_id id, const place *at,
                 const char *format, ...) __attribute__((format(printf, 4, 5)));
/* Memory ran out while the input was read: message_status returns
 * ERR_MEMORY. */
void message_memory(message_log *log);
int message_count(const message_log *log, severity s);
/* How many there are now, and back to that many: those of a trial that was
 * given up are not those of the run. */
typedef struct message_mark {
  int n, count[3]; /* stored; by severity */
} message_mark;
message_mark message_now(const message_log *log);
void message_forget(message_log *log, message_mark since);
/* Add those of another log. */
void message_take(message_log *log, const message_log *from);
/* Number k, from 0, of those stored, as they were added; all borrowed. 0: no
 * more. */
typedef struct message_view {
  message_id id;
  severity level;
  const place *at; /* or NULL */
  const char *text;
} message_view;
int message_get(const message_log *log, int k, message_view *out);
/* 1 while one more error would be stored: a search for advice (nearest_word) is
 * not needed once they are only counted. */
int message_wanted(const message_log *log);
/* Print all of them, in the order of the files and lines (at one place the
 * errors first), and the totals. */
void message_print(const message_log *log, FILE *out);
/* Print those of one severity without source line, for the listing. */
void message_list(const message_log *log, severity s, FILE *out);
/* Manual entry of "P1003" or "1003", or of all if NULL; 0 if unknown. */
int message_explain(const char *number, FILE *out);
/* OK without errors; else "code" (the record then gives the number). */
status message_status(const message_log *log, status code);
