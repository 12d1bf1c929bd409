/* The command line of protis. */
#pragma once

#include "base/message.h"

typedef struct command {
  const char *commit; /* of the sources; borrowed, set before command_read */
  char *deck_file;    /* owned */
  char *dir;          /* folder of the results; owned */
  int n_define;
  const char **defines; /* [n_define] NAME=VALUE; array owned */
  int check_only, estimate_cost, quiet, no_timing, restart, safe;
  const char *table;  /* NAME[:last|:all] of a finished job; NULL: run it */
  const char *format; /* of it: csv or tsv; NULL: not given, csv */
  int threads;        /* of the dense algebra; 0: not given */
  double max_memory;  /* MB the process may hold; 0: not said */
} command;

/* Read it. 1: run *c. 0: all is done (help, version, lists) or the words are
 * wrong, with a message on stderr; end with *exit_code. */
int command_read(int argc, char **argv, command *c, int *exit_code);
/* Apply it: threads, no more than there are cores (c->threads is then their
 * number), the memory that may be taken, and with --safe the folder of the deck
 * as the only one that is read. ERR_FILE: it cannot be opened. */
status command_apply(command *c, message_log *log);
void command_free(command *c);

/*
 * tables.c, protis JOB --table NAME[:last|:all]: all blocks of that name in
 * JOB.dat as one table on stdout, a header and a row a line: step, increment,
 * time, group (if some have one), contact (if they have it), then the other
 * columns. A column that a block does not have is empty there. Numbers as they
 * stand.
 *
 * Errors: ERR_FILE (no JOB.dat, or stdout cannot be written), ERR_DECK (no such
 * table; the message names those there are), ERR_MEMORY.
 */
status tables_print(const command *c);
