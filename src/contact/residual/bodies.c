/* Parts of the contact problem that its matrix does not join (contact.h). */
#include "contact/contact.h"

#include "base/memory.h"

#include <math.h>

static const double JOINED = 0x1p-30; /* -, entry over those of the diagonal */

void contact_bodies_free(contact_bodies *b) {
  if (b == NULL) return;
  RELEASE(b->of, b->size, b);
}

static const double *matrix_of(const contact_problem *cp) {
  return cp->A != NULL ? cp->A : cp->W;
}

/* Root of the largest diagonal entry of a node. */
static double root_of(const contact_problem *cp, int node_id) {
  double most = 0.0;
  for (int i = node_id * cp->dim; i < (node_id + 1) * cp->dim; ++i)
    most = fmax(most, matrix_of(cp)[(size_t)i * (size_t)(cp->m + 1)]);
  return sqrt(most);
}

/* 1: an entry of columns a and rows b is above "least". */
static int joined(const contact_problem *cp, int a, int b, double least) {
  for (int j = a * cp->dim; j < (a + 1) * cp->dim; ++j) {
    const double *column = matrix_of(cp) + (size_t)j * (size_t)cp->m;
    for (int i = b * cp->dim; i < (b + 1) * cp->dim; ++i)
      if (fabs(column[i]) > least) return 1;
  }
  return 0;
}

/* Bodies, each from one node on: list[n] holds the nodes found, then the
 * remaining ones. */
static void find_bodies(const contact_problem *cp, const double *root,
                        int *list, contact_bodies *b) {
  int found = 0;
  for (int i = 0; i < cp->n; ++i) list[i] = i;
  for (int next = 0; next < cp->n; ++next) {
    int a = list[next];
    if (next == found) {
      b->of[a] = b->n++;
      ++found;
    }
    for (int k = found; k < cp->n; ++k) {
      int other = list[k];
      if (!joined(cp, a, other, JOINED * root[a] * root[other])) continue;
      b->of[other] = b->of[a];
      list[k] = list[found];
      list[found++] = other;
    }
  }
}

status contact_bodies_new(const contact_problem *cp, contact_bodies **out) {
  status st = OK;
  contact_bodies *b = NULL;
  double *root = NULL;
  int *list = NULL;
  NEW(b, 1);
  NEW(b->of, cp->n);
  NEW(root, cp->n);
  NEW(list, cp->n);
  for (int i = 0; i < cp->n; ++i) root[i] = root_of(cp, i);
  find_bodies(cp, root, list, b);
  NEW(b->size, b->n);
  *out = b;
  b = NULL;
done:
  contact_bodies_free(b);
  RELEASE(root, list);
  return st;
}
