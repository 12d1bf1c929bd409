/* Tables of a finished job for other programs: JOB.dat as csv or tsv. */
#ifndef PROTIS_TABLES_H
#define PROTIS_TABLES_H

#include "program/command.h"

/*
 * protis JOB --table NAME[:last|:all]: all blocks of that name in JOB.dat as
 * one table on stdout, a header and a row a line: step, increment, time, group
 * (if some have one), contact (if they have it), then the other columns. A
 * column that a block does not have is empty there. Numbers as they stand.
 *
 * Errors: ERR_FILE (no JOB.dat, or stdout cannot be written), ERR_DECK (no such
 * table; the message names those there are), ERR_MEMORY.
 */
status tables_print(const command *c);

#endif
