/*
 * Blocks of unit size on top of each other, from y = 0 on, plane strain. What
 * joins a block to the one below (the first: to the ground) is one letter:
 *   P  pair, its lower side is the slave      M  pair, its lower side is the
 *   T  tie, its lower side moves with the        master
 *      side below                             O  obstacle; -  nothing
 * The displacement of the other side is interpolated linearly.
 */
#pragma once

#include "support/scene.h"

enum { STACK_MOST = 400 };

typedef struct stack {
  scene *s;                           /* owned */
  int n_block, first[STACK_MOST + 1]; /* nodes of block b: first[b] .. */
  int cells[STACK_MOST];              /* of its sides */
  node_links pair;
  tie_set ties;
} stack;

/* cells[n_block]; "gap" between the blocks. */
stack *stack_new(const char *joints, const int *cells, double gap);
void stack_free(stack *k);
/* Fix the lower side of the first block. */
void stack_fix(stack *k, int c);
