/*
 * The end of an earlier run: mesh and last record of /fields in its JOB.h5.
 */
#include "run/start/end_state.h"

#include "base/memory.h"
#include "base/archive/dataset.h"

#include <math.h>
#include <stdio.h>

static const double SAME_PLACE = 1e-9; /* -, of the size of the mesh */

/* Items of a node in a dataset of n numbers: at least dim of them. */
static status width_of(const hdf5_source *s, const char *name, long n,
                       const mesh *msh, size_t *width) {
  *width = (size_t)n / (size_t)msh->n_node;
  if (n % msh->n_node != 0 || *width < (size_t)msh->dim)
    RAISE(
        ERR_DECK,
        "%s has another mesh: %s has %ld numbers, which does not fit %d nodes "
        "in %d-D",
        s->path, name, n, msh->n_node, msh->dim);
  return OK;
}

static status check_mesh(const hdf5_source *s, const mesh *msh) {
  static const char name[] = "/mesh/nodes";
  OWNED double *x = NULL;
  size_t width, dim = (size_t)msh->dim;
  long n = 0;
  PASS(source_reals(s, name, 0, 3L * msh->n_node, &n, &x));
  PASS(width_of(s, name, n, msh, &width));
  for (size_t i = 0; i < (size_t)msh->n_node; ++i)
    for (size_t c = 0; c < width; ++c) {
      double here = c < dim ? msh->x[dim * i + c] : 0.0;
      if (fabs(x[width * i + c] - here) > SAME_PLACE * msh->size)
        RAISE(ERR_DECK,
              "%s has another mesh: node %zu is at %c = %.9g there and %.9g "
              "here",
              s->path, msh->node_no[i], "xyz"[c < 3 ? c : 2], x[width * i + c],
              here);
    }
  return OK;
}

static status read_last(const hdf5_source *s, const mesh *msh, double *u,
                        double *t) {
  char name[64];
  OWNED double *time = NULL, *all = NULL;
  size_t width, dim = (size_t)msh->dim;
  long n = 0, items = 0;
  PASS(source_reals(s, "/fields/time", 0, MOST_ITEMS, &n, &time));
  if (n < 1) RAISE(ERR_DECK, "%s has no record of fields", s->path);
  *t = time[n - 1];
  snprintf(name, sizeof name, "/fields/u/%05ld", n);
  PASS(source_reals(s, name, 0, 3L * msh->n_node, &items, &all));
  PASS(width_of(s, name, items, msh, &width));
  for (size_t i = 0; i < (size_t)msh->n_node; ++i)
    for (size_t c = 0; c < dim; ++c) u[dim * i + c] = all[width * i + c];
  return OK;
}

status end_state_read(const char *path, const mesh *msh, const place *at,
                      message_log *log, double *u, double *t) {
  status st = OK;
  hdf5_source s;
  TRY(dataset_open(path, &s));
  TRY(check_mesh(&s, msh));
  TRY(read_last(&s, msh, u, t));
done:
  dataset_close(&s);
  if (st == ERR_FILE || st == ERR_DECK)
    message_add(log, P5003, at, "%s", status_message());
  return st;
}
