/*
 * The manual and the examples that the program carries with it. A chapter is a
 * file of this folder, NAME.md, and for some what the tables of the program
 * add: cards, laws, methods, columns, messages.
 */
#pragma once

#include "base/status.h"

#include <stddef.h>
#include <stdio.h>

/* A chapter as Markdown, or, with NULL, the names and titles of all; 0 if there
 * is none of that name. */
int manual_print(const char *chapter, FILE *out);
/* Name of chapter i, from 0; NULL at the end. For nearest_word. */
const char *manual_chapter(const void *ctx, int i);

/* A file of this folder as it is. */
void manual_file(const char *name, FILE *out);

/* What --list can show, one after another for nearest_word; NULL at the end. */
const char *list_kind(const void *ctx, int i);
/* One of them; 0 if there is no such kind. */
int list_print(const char *kind, FILE *out);

/* Name of example i, from 0; NULL at the end. */
const char *example_name(const void *ctx, int i);
/* Copy decks and geometries of an example into the current folder and tell
 * their names. ERR_DECK: no such example; ERR_FILE: one of the files is there
 * already, then none is written, or cannot be written. */
status example_copy(const char *name, FILE *out);

/* The files: chapters, decks and geometries, a table made by tools/embed. */
typedef struct embedded_file {
  const char *folder; /* where it stands: "manual", or name of the example */
  const char *name;   /* "deck.md" */
  const char *text;   /* ends with a NUL that does not count */
  size_t size;        /* bytes */
} embedded_file;

/* Folder after folder; folder NULL at the end. */
extern const embedded_file embedded_files[];
