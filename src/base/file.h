/*
 * Files by what they are: plain ones are opened, others refused before they
 * block or never end; two names of one file are known by device and inode. What
 * a run writes stays in its folder: links are not followed, and what bears the
 * name of a result is replaced and not written over.
 */
#ifndef PROTIS_BASE_FILE_H
#define PROTIS_BASE_FILE_H

#include "base/status.h"

/* A plain file below the folder (AT_FDCWD: the present one), opened without
 * waiting; -1 and the reason if it is none. */
int file_descriptor(int folder, const char *path, int flags, const char **why);
/* 1: both names lead to one file, which is there; -1, errno: not known. */
int file_same(const char *a, const char *b);

/* Remove what bears the name of a result: a regular file or a link, not what
 * the link leads to; none is fine. ERR_FILE: it is neither, or stays. */
status file_clear(const char *path);
/* Names of a folder reach the disk: that of the file; best effort. */
void file_sync_folder(const char *path);

#endif
