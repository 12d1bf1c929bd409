/*
 * The files that the program carries with it: chapters of the manual, decks and
 * geometries of the examples. The table is made by tools/embed.
 */
#pragma once

#include <stddef.h>

typedef struct embedded_file {
  const char *folder; /* where it stands: "manual", or name of the example */
  const char *name;   /* "deck.md" */
  const char *text;   /* ends with a NUL that does not count */
  size_t size;        /* bytes */
} embedded_file;

/* Folder after folder; folder NULL at the end. */
extern const embedded_file embedded_files[];
