#include "contact/mortar/links.h"

#include "base/memory.h"

/* Component c of row q; 1: there was something to move. */
static int share(const tie_set *t, int q, int c, double *F) {
  const node_links *l = &t->to;
  double *own = F + (ptrdiff_t)l->dim * t->node_id[q] + c, f = *own;
  int moves = 0;
  for (size_t e = l->start[q]; e < l->start[q + 1] && f != 0.0; ++e) {
    const double part = l->part[(size_t)l->dim * e + (size_t)c];
    F[(ptrdiff_t)l->dim * l->master[e] + c] += part * f;
    moves |= part != 0.0;
  }
  if (moves) *own = 0.0;
  return moves;
}

/* Masters that are tied themselves pass it on: a pass for each link of a
 * chain. */
void ties_share(const tie_set *t, double *F) {
  for (int more = 1; more;) {
    more = 0;
    for (int k = 0; k < t->to.dim * t->n; ++k)
      more |= share(t, k / t->to.dim, k % t->to.dim, F);
  }
}

void links_release(node_links *l) {
  RELEASE(l->start, l->master, l->part);
  *l = (node_links){0};
}
