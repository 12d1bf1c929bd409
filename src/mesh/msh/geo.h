/* The text of a .geo and of the files that it includes: which names it has. */
#pragma once

#include "base/status.h"

enum { GEO_FILES = 64 };

typedef struct geo_text {
  int n_file, file_capacity;
  char **file; /* [n_file] paths */
  char **text; /* [n_file] their bytes, a zero after each name */
  int n_name, name_capacity;
  const char **name;      /* [n_name] in text, as often as they stand there */
  int is_open;            /* it has files whose names gmsh evaluates */
  char merged[GEO_FILES]; /* [n_file] 1: gmsh executes its options file */
} geo_text;

/* Files that cannot be opened are skipped: gmsh reports them. ERR_MEMORY,
 * ERR_FILE. */
status geo_read(const char *file, geo_text *g);
void geo_free(geo_text *g); /* accepts an all-zero object */
/* 1 if the text has the name, letter by letter, or may have it. */
int geo_has(const geo_text *g, const char *name);
/* How statements set the name, besides DefineConstant: where a condition on
 * other names holds; by what it was, or where a condition on it holds; to
 * another value. */
typedef enum { GEO_SETS_NOT, GEO_MAY_SET, GEO_CHANGES, GEO_SETS } geo_setting;
/* The last of them that the text has; *file, *line: where, if any. */
status geo_sets(const geo_text *g, const char *name, geo_setting *how,
                const char **file, int *line);
/* Name number i, or NULL: for nearest_word. */
const char *geo_name(const void *geo, int i);
