/*
 * The command line of protis.
 */
#ifndef PROTIS_COMMAND_H
#define PROTIS_COMMAND_H

typedef struct command {
  char *deck_file; /* owned                                              */
  char *dir;       /* folder of the results; owned                       */
  int n_define;
  const char **defines; /* [n_define] NAME=VALUE; array owned                 */
  int check_only, estimate_cost, quiet, no_timing, restart;
  int threads; /* of the dense algebra; 0: not said                  */
} command;

/* Read it. 1: run *c. 0: all is done (help, version, lists) or the words are
 * wrong and told on stderr; end with *exit_code. */
int command_read(int argc, char **argv, command *c, int *exit_code);
void command_free(command *c);

#endif
