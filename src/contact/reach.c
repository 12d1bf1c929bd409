/* Contact nodes within reach (reach.h). */
#include "contact/reach.h"

#include "base/memory.h"

#include <string.h>

enum { MOST_PASSES = 2 };
static const double LONGER = 4.0; /* -, after a way that was too short       */

void reach_free(contact_reach *x) {
  memory_free(x->in);
  x->in = NULL;
  x->n_in = 0;
}

int reach_count(const contact_reach *x, int n) {
  return x->in != NULL ? x->n_in : n;
}

int reach_is_same(const contact_reach *a, const contact_reach *b) {
  if (a->in == NULL || b->in == NULL) return a->in == b->in;
  return a->n_in == b->n_in &&
         memcmp(a->in, b->in, (size_t)a->n_in * sizeof *a->in) == 0;
}

/* keep[n]: 1 of the nodes to be taken. */
static status take(contact_reach *x, int n, const unsigned char *keep) {
  status st = OK;
  int count = 0;
  for (int i = 0; i < n; ++i) count += keep[i];
  reach_free(x);
  if (2 * count > n) return OK;
  NEW(x->in, n);
  for (int i = 0; i < n; ++i)
    if (keep[i]) x->in[x->n_in++] = i;
done:
  return st;
}

status reach_choose(contact_reach *x, int n, const double *gap) {
  status st = OK;
  unsigned char *keep = NULL;
  int nearest = 0;
  NEW(keep, n);
  for (int i = 0; i < n; ++i) {
    keep[i] = gap[i] <= x->way;
    if (gap[i] < gap[nearest]) nearest = i;
  }
  if (n > 0) keep[nearest] = 1;
  TRY(take(x, n, keep));
done:
  memory_free(keep);
  return st;
}

int reach_misses(const contact_reach *x, int n, const double *gap,
                 const double *u_n, int stride) {
  for (int i = 0, next = 0; x->in != NULL && i < n; ++i) {
    if (next < x->n_in && x->in[next] == i)
      ++next;
    else if (!(u_n[stride * i] <= gap[i]))
      return 1;
  }
  return 0;
}

status reach_extend(contact_reach *x, int n, const double *gap,
                    const double *u_n, int stride, int all) {
  status st = OK;
  unsigned char *keep = NULL;
  NEW(keep, n);
  all = all || x->passes >= MOST_PASSES;
  x->way *= LONGER;
  ++x->passes;
  for (int i = 0; i < n; ++i)
    keep[i] = all || gap[i] <= x->way || !(u_n[stride * i] <= gap[i]);
  for (int k = 0; k < x->n_in; ++k) keep[x->in[k]] = 1;
  TRY(take(x, n, keep));
done:
  memory_free(keep);
  return st;
}
