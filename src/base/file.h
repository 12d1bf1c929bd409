/*
 * Kinds of files: plain files are opened, others are refused before they block
 * or never end; two names of one file are recognised by device and inode. What
 * a run writes stays in its folder: links are not followed, and a file with the
 * name of a result is replaced, not overwritten.
 */
#pragma once

#include "base/status.h"

#include <stdio.h>

/* A plain file below the folder (AT_FDCWD: the present one), opened without
 * waiting; -1 and the reason if it is none. */
int file_descriptor(int folder, const char *path, int flags, const char **why);
/* 1: both names refer to one existing file; -1, errno: not known. */
int file_same(const char *a, const char *b);

/* What has the name of a result may be replaced: a regular file that is not
 * write-protected, a link; none is fine. ERR_FILE: it is something else. */
status file_may_go(const char *path);
/* Remove it, not the target of a link. ERR_FILE: it may or can not go. */
status file_clear(const char *path);
/* Close what is open, of locals by ENDS_BY. */
void file_leave(FILE **f);
void descriptor_leave(const int *fd);
/* Synchronise the folder of the file; best effort. */
void file_sync_folder(const char *path);
