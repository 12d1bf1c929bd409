/*
 * The nodes of *TIE: each moves with the master surface, but for the components
 * that supports hold. A node of several ties belongs to the first.
 */
#include "run/setup/setup.h"

#include "base/memory.h"

#include <string.h>

void run_free_ties(run *r) {
  memory_free(r->body.ties.node_id);
  links_release(&r->body.ties.to);
  r->body.ties = (tie_set){0};
  r->body.d.ties = NULL;
}

/* Nodes that all their components hold, or an earlier tie has, are left out. */
static void find_dropped(const run *r, unsigned char *dropped) {
  const int dim = r->msh->dim;
  for (int i = 0; i < r->msh->n_node; ++i) {
    int all = 1;
    for (int c = 0; c < dim; ++c) all &= r->body.fixed[dim * i + c] != 0;
    dropped[i] |= (unsigned char)all;
  }
}

static status couple(const run *r, const tie *t, const unsigned char *dropped,
                     mortar **out) {
  const mesh_group *slave = &r->msh->group[t->pair.slave_id],
                   *master = &r->msh->group[t->pair.master_id];
  PASS(surfaces_couple(&r->faces.input, r->msh->x, slave, master, 1, dropped,
                       out));
  if ((*out)->n == 0)
    message_add(r->m->log, P4023, &t->at,
                "*TIE %s: no face of %s meets a face of %s along its normal",
                t->name, slave->name, master->name);
  else if ((*out)->n_uncovered + (*out)->n_scant > 0)
    message_add(r->m->log, P4025, &t->at,
                "*TIE %s: %d of %d nodes of %s have no partner on %s", t->name,
                (*out)->n_uncovered + (*out)->n_scant, slave->n_node,
                slave->name, master->name);
  return message_status(r->m->log, ERR_DECK);
}

/* Row of node q of m, the last of ties. */
static void add_node(const run *r, const mortar *m, int q, tie_set *t) {
  const int dim = r->msh->dim, row = t->n++;
  const size_t n = m->to.start[q + 1] - m->to.start[q];
  t->node_id[row] = m->node_id[q];
  t->to.start[row + 1] = t->to.start[row] + n;
  for (size_t e = 0; e < n; ++e) {
    const size_t from = m->to.start[q] + e, to = t->to.start[row] + e;
    t->to.master[to] = m->to.master[from];
    for (int c = 0; c < dim; ++c)
      t->to.part[(size_t)dim * to + (size_t)c] =
          r->body.fixed[dim * m->node_id[q] + c]
              ? 0.0
              : m->to.part[(size_t)dim * from + (size_t)c];
  }
}

/* The couplings of all ties as one set, by node. */
static status join(run *r, mortar *const *m) {
  const int n_tie = r->m->n.tie;
  tie_set *t = &r->body.ties;
  OWNED int *next = NULL;
  size_t n_row = 0, n_part = 0;
  PASS_NEW(next, n_tie);
  for (int i = 0; i < n_tie; ++i) {
    n_row += (size_t)m[i]->n;
    n_part += m[i]->to.start[m[i]->n];
  }
  PASS_NEW_ALL(OF(t->node_id, n_row), OF(t->to.start, n_row + 1),
               OF(t->to.master, n_part),
               OF(t->to.part, (size_t)r->msh->dim * n_part));
  t->to.dim = r->msh->dim;
  while ((size_t)t->n < n_row) {
    int least = -1;
    for (int i = 0; i < n_tie; ++i)
      if (next[i] < m[i]->n &&
          (least < 0 ||
           m[i]->node_id[next[i]] < m[least]->node_id[next[least]]))
        least = i;
    add_node(r, m[least], next[least]++, t);
  }
  t->to.n = t->n;
  return OK;
}

status run_build_ties(run *r) {
  status st = OK;
  const int n = r->m->n.tie;
  mortar **m = NULL;
  unsigned char *dropped = NULL;
  run_free_ties(r);
  if (n == 0) return OK;
  timer_enter(STAGE_COUPLING);
  NEW_ALL(OF(m, n), OF(dropped, r->msh->n_node));
  find_dropped(r, dropped);
  for (int i = 0; i < n; ++i) {
    TRY(couple(r, &r->m->ties[i], dropped, &m[i]));
    for (int q = 0; q < m[i]->n; ++q) dropped[m[i]->node_id[q]] = 1;
  }
  TRY(join(r, m));
  r->body.d.ties = &r->body.ties;
done:
  timer_leave(STAGE_COUPLING);
  for (int i = 0; m != NULL && i < n; ++i) mortar_free(m[i]);
  RELEASE(m, dropped);
  return st;
}
