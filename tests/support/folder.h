/*
 * Folders and files of the tests; check fails where the system refuses.
 */
#pragma once

#include "base/memory.h"

#include <stddef.h>

/* A new empty folder below $TMPDIR or /tmp; removed with all in it. */
char *folder_new(char path[64]);
void folder_remove(const char *path);
/* A new folder, removed where the name ends. */
void folder_leave(char (*path)[64]);
#define FOLDER(path)                   \
  ENDS_BY(folder_leave) char path[64]; \
  folder_new(path)
/* Copy a file into the folder under its own name. */
void folder_copy(const char *path, const char *file);
/* The bytes of a file (caller frees) with a zero after them, or NULL; size may
 * be NULL. */
char *file_read(const char *path, size_t *size);
/* The same of PATH/NAME. */
char *folder_file(const char *path, const char *name, size_t *size);
