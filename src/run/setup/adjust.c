/*
 * ADJUST=YES: slave nodes are moved onto the master before the run. The gap
 * vector of a node follows from the normals, which follow from the places: a
 * few passes leave a moment of about 1e-9 of tangential forces.
 */
#include "run/setup/setup.h"

enum { PASSES = 3 };

/* The places once the slave of a pair is on its master, into x[dim*n_node]:
 * what the first step fixes, as on a plane of symmetry, stays. */
static status move_slave(const surface_input *in, surface_pair *p, double *x) {
  const mesh *msh = in->mesh;
  const int dim = msh->dim;
  OWNED mortar *m = NULL;
  PASS(surfaces_couple(in, msh->x, &msh->group[p->slave_id],
                       &msh->group[p->master_id], COUPLE_FLAT, NULL, &m));
  COPY(x, msh->x, (size_t)dim * msh->n_node);
  for (int q = 0; q < m->n; ++q)
    for (int c = 0; c < dim; ++c) {
      const size_t k = (size_t)dim * m->node_id[q] + c;
      const int held = in->fixed[m->node_id[q]] >> c & 1;
      const double d = held ? 0.0 : m->gap[dim * q + c];
      x[k] += d;
      p->moved = fmax(p->moved, fabs(d));
    }
  return OK;
}

/* ERR_DECK with an error in the log: an element has no volume left. */
static status check_elements(const model *m, const mesh *msh,
                             const surface_pair *p) {
  for (int e = 0; e < msh->n_elem; ++e) {
    if (mesh_elem_measure(msh, e) > 0.0) continue;
    message_add(m->log, P4026, &p->group_at[0],
                "ADJUST=YES turns element %zu inside out: surfaces %s and %s "
                "are up to %.3g apart",
                msh->elem_no[e], p->group[0], p->group[1], p->moved);
    break;
  }
  return message_status(m->log, ERR_DECK);
}

static status adjust(const model *m, const surface_input *in, surface_pair *p,
                     mesh *msh) {
  const size_t n = (size_t)msh->dim * msh->n_node;
  if (!p->adjust) return OK;
  OWNED_NEW(double, x, n);
  for (int pass = 0; pass < PASSES; ++pass) {
    PASS(move_slave(in, p, x));
    COPY(msh->x, x, n);
  }
  return check_elements(m, msh, p);
}

/* bits[n_node]: the components that the first step fixes. */
static status find_fixed(const model *m, const mesh *msh, unsigned char *bits) {
  OWNED_NEW(unsigned char, fixed, (size_t)msh->dim * msh->n_node);
  load_fixed(msh, &m->steps[0], fixed);
  for (int i = 0; i < msh->n_node; ++i)
    for (int c = 0; c < msh->dim; ++c)
      bits[i] |= (unsigned char)((fixed[msh->dim * i + c] != 0) << c);
  return OK;
}

status setup_adjust(model *m, mesh *msh) {
  int any = 0;
  for (int i = 0; i < m->n.contact; ++i) any |= m->contacts[i].pair.adjust;
  for (int i = 0; i < m->n.tie; ++i) any |= m->ties[i].pair.adjust;
  if (!any) return OK;
  surface_input in = {.mesh = msh,
                      .axisymmetric = m->sections[0].kin == AXISYMMETRIC};
  OWNED_OF(double, weight, setup_face_weights(m, msh, &weight));
  in.face_weight = weight;
  OWNED_NEW(unsigned char, fixed, msh->n_node);
  if (m->n.step > 0) PASS(find_fixed(m, msh, fixed));
  in.fixed = fixed;
  for (int i = 0; i < m->n.tie; ++i)
    PASS(adjust(m, &in, &m->ties[i].pair, msh));
  for (int i = 0; i < m->n.contact; ++i)
    PASS(adjust(m, &in, &m->contacts[i].pair, msh));
  return OK;
}
