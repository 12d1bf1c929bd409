/*
 * Disks that are full for open files of this process.
 */
#pragma once

/* The open file of that name takes no more. */
void disk_fill(const char *name);
/* The same once the file "after" has been given its name; NULL: never. */
void disk_fill_after(const char *name, const char *after);

/* In the place of that of the C library. */
int rename(const char *from, const char *to);
