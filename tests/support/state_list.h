/*
 * All answers of a small plane problem, by trying every state (open, stick,
 * slip to either side) of every node: nothing shared with the program.
 */
#pragma once

#include "support/contact_case.h"

enum { MOST_LISTED_NODES = 4 };
typedef struct state_list {
  int n;     /* answers, each once                                            */
  double *u; /* [n*m]                                                         */
} state_list;

/* 0: not plane, too many nodes, or a set of states with a singular matrix (the
 * list, now empty, could miss an answer); release it all the same. Stiffness
 * form, without held nodes or second obstacles. */
int state_list_new(const contact_case *c, state_list *list);
void state_list_free(state_list *list);
