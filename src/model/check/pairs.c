/*
 * Two surfaces of *CONTACT PAIR or *TIE: groups of boundary faces without a
 * common face, and which of them is the slave.
 */
#include "base/memory.h"
#include "mesh/crack/crack.h"
#include "model/check/parts.h"

#include <math.h>
#include <stdio.h>

/* The deck's card of two surfaces. */
typedef struct pair_card {
  const char *card, *name;
  const place *at;
} pair_card;

/* From this ratio of the moduli on the softer surface is the slave: a stiff
 * slave that the pair alone holds costs digits. */
static const double stiff_ratio = 3.0;
/* Sizes and moduli that differ less are equal. */
static const double rounding = 1e-9;

/* Mean over the faces of a group. */
typedef struct surface_facts {
  double size;    /* of a face, m */
  double modulus; /* Pa */
  int held;       /* 1: supports hold all of it */
} surface_facts;

/* E of the isotropic material with the means of C over all directions (Voigt
 * 1889), the same in any axes: K = C_iijj/9, G = (3 C_ijij - C_iijj)/30, Pa. */
static double mean_young(const double C[36]) {
  double normal = 0.0, shear = 0.0, diagonal = 0.0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) normal += C[i + 6 * j];
    diagonal += C[7 * i];
    shear += C[7 * (3 + i)];
  }
  const double K = normal / 9.0;
  const double G = (3.0 * (diagonal + 2.0 * shear) - normal) / 30.0;
  return 9.0 * K * (G / (3.0 * K + G));
}

static surface_facts facts_of(const model *m, const mesh *msh,
                              const unsigned char *fixed, int group_id) {
  const mesh_group *g = &msh->group[group_id];
  const int dim = msh->dim;
  surface_facts f = {.held = 1};
  double area = 0.0, normal[3];
  for (int k = 0; k < g->n_item; ++k) {
    const int face = g->item_id[k];
    const section *s = &m->sections[m->elem_section[msh->face_elem[face]]];
    area += mesh_face_normal(msh, face, normal) / g->n_item;
    f.modulus += mean_young(m->materials[s->material_id].C) / g->n_item;
  }
  f.size = dim == 2 ? area : sqrt(area);
  for (int k = 0; k < g->n_node; ++k)
    for (int c = 0; c < dim; ++c) f.held &= fixed[dim * g->node_id[k] + c];
  return f;
}

static void choose(const model *m, const mesh *msh, const unsigned char *fixed,
                   const int *group, surface_pair *p) {
  surface_facts f[2];
  for (int k = 0; k < 2; ++k) f[k] = facts_of(m, msh, fixed, group[k]);
  const double ratio = f[1].modulus / f[0].modulus;
  const char *why = "of equal size: the first";
  p->slave = 0;
  if (p->choice != SLAVE_AUTO) {
    p->slave = p->choice == SLAVE_SECOND;
    why = "by SLAVE=";
  } else if (f[0].held != f[1].held) {
    p->slave = f[0].held;
    why = "the other is held";
  } else if (fmax(ratio, 1.0 / ratio) >= stiff_ratio * (1.0 - rounding)) {
    p->slave = ratio < 1.0;
    why = "softer";
  } else if (fabs(f[1].size - f[0].size) > rounding * f[0].size) {
    p->slave = f[1].size > f[0].size;
    why = "coarser";
  }
  snprintf(p->why, sizeof p->why, "%s", why);
  p->slave_id = group[p->slave];
  p->master_id = group[1 - p->slave];
}

static int shared_faces(const mesh_group *a, const mesh_group *b,
                        unsigned char *seen) {
  int n = 0;
  for (int k = 0; k < a->n_item; ++k) seen[a->item_id[k]] = 1;
  for (int k = 0; k < b->n_item; ++k) n += seen[b->item_id[k]];
  return n;
}

static void check_inner(const model *m, const mesh *msh, const pair_card *c,
                        int group_id, const place *at) {
  const mesh_group *g = &msh->group[group_id];
  for (int k = 0; k < g->n_item; ++k) {
    const int face = g->item_id[k];
    if (msh->face_other[face] < 0) continue;
    message_add(m->log, P4001, at,
                "*%s %s: a face of group %s lies inside the body, at node %zu",
                c->card, c->name, g->name,
                msh->node_no[msh->face[msh->dim * face]]);
    return;
  }
}

/* Groups of the two surfaces into group[2]. */
static status check_surfaces(const model *m, const mesh *msh,
                             const pair_card *c, const surface_pair *p,
                             int *group) {
  OWNED unsigned char *seen = NULL;
  PASS_NEW(seen, msh->n_face);
  for (int k = 0; k < 2; ++k) {
    if (p->group[k][0] == '\0') return OK;
    group[k] =
        check_group_of(m, msh, p->group[k], msh->dim - 1, &p->group_at[k]);
    if (group[k] < 0) return OK;
    check_inner(m, msh, c, group[k], &p->group_at[k]);
  }
  const mesh_group *a = &msh->group[group[0]], *b = &msh->group[group[1]];
  const int n = shared_faces(a, b, seen);
  if (n > 0)
    message_add(m->log, P2060, c->at,
                "*%s %s: groups %s and %s have %d common face%s", c->card,
                c->name, a->name, b->name, n, n == 1 ? "" : "s");
  return OK;
}

static int is_lost(const model *m) { return message_count(m->log, ERROR) > 0; }

static void check_twice(const model *m, int id) {
  const contact *c = &m->contacts[id];
  for (int i = 0; i < id; ++i) {
    const contact *old = &m->contacts[i];
    const surface_pair *a = &c->pair, *b = &old->pair;
    if (!old->is_pair ||
        a->slave_id + a->master_id != b->slave_id + b->master_id)
      continue;
    if (a->slave_id == b->slave_id || a->slave_id == b->master_id)
      message_add(m->log, P2011, &c->at,
                  "contact pair %s has the surfaces of contact pair %s",
                  c->name, old->name);
  }
}

static status check_contact_pair(model *m, const mesh *msh,
                                 const unsigned char *fixed, int id) {
  contact *c = &m->contacts[id];
  const pair_card of = {"CONTACT PAIR", c->name, &c->at};
  int group[2] = {-1, -1};
  if (!c->is_pair) return OK;
  PASS(check_surfaces(m, msh, &of, &c->pair, group));
  if (is_lost(m)) return OK;
  choose(m, msh, fixed, group, &c->pair);
  c->group_id = c->pair.slave_id;
  c->group = msh->group[c->group_id].name;
  c->obstacle_name = msh->group[c->pair.master_id].name;
  check_twice(m, id);
  return OK;
}

status model_open_cracks(model *m, mesh *msh) {
  const int n = m->n.crack;
  OWNED mesh_cut *cut = NULL;
  if (n == 0 || msh->n_crack > 0) return OK;
  PASS_NEW(cut, n);
  for (int i = 0; i < n; ++i) {
    crack *k = &m->mesh.cracks[i];
    const int id = check_group(m, msh, k->group, &k->group_at);
    if (id < 0) return message_status(m->log, ERR_DECK);
    cut[i] = (mesh_cut){&msh->group[id], &k->group_at};
  }
  PASS_NEW(msh->crack, n);
  msh->n_crack = n;
  return mesh_open(msh, n, cut, m->log, msh->crack);
}

status check_pairs(model *m, const mesh *msh) {
  OWNED unsigned char *fixed = NULL;
  if (!model_has_pairs(m)) return OK;
  PASS_NEW(fixed, (size_t)msh->dim * (size_t)msh->n_node);
  if (!is_lost(m) && m->n.step > 0) load_fixed(m, msh, &m->steps[0], fixed);
  for (int i = 0; i < m->n.contact; ++i)
    PASS(check_contact_pair(m, msh, fixed, i));
  for (int i = 0; i < m->n.tie; ++i) {
    tie *t = &m->ties[i];
    const pair_card of = {"TIE", t->name, &t->at};
    int group[2] = {-1, -1};
    PASS(check_surfaces(m, msh, &of, &t->pair, group));
    if (!is_lost(m)) choose(m, msh, fixed, group, &t->pair);
  }
  return OK;
}
