/*
 * Whether supports and contact hold every body, checked before anything is
 * solved.
 */
#include "run/setup/setup.h"

#include "base/memory.h"

/* Name of the section an element belongs to, by the element's number. */
static const char *body_name(const run *r, size_t elem_no) {
  for (int e = 0; e < r->msh->n_elem; ++e)
    if (r->msh->elem_no[e] == elem_no)
      return r->m->sections[r->m->elem_section[e]].elset;
  return "?";
}

/* 1: a group has faces of a body. */
static int is_at(const mesh *msh, int group_id, const int *body, int body_id) {
  const mesh_group *g = &msh->group[group_id];
  for (int k = 0; k < g->n_item; ++k)
    if (body[msh->face_elem[g->item_id[k]]] == body_id) return 1;
  return 0;
}

/* 1 if a contact with friction acts on the body of an element; any contact,
 * where pairs and ties may join the bodies. */
static status has_friction(const run *r, size_t elem_no, int *answer) {
  const model *m = r->m;
  const mesh *msh = r->msh;
  OWNED int *body = NULL;
  int n = 0, e = 0;
  *answer = 0;
  PASS_NEW(body, msh->n_elem);
  PASS(mesh_bodies(msh, &n, body));
  while (msh->elem_no[e] != elem_no) ++e;
  for (int i = 0; i < m->n.contact; ++i)
    if (rule_has_friction(friction_in_force(m, run_step_id(r), i)))
      *answer |= model_has_pairs(m) ||
                 is_at(msh, m->contacts[i].group_id, body, body[e]);
  return OK;
}

/* 1 if nothing resists: no contact there, or tangential contact of a body
 * without friction. */
static status is_unheld(const run *r, const free_motion *f, int *unheld) {
  int friction = 0;
  if (f->held_by == HELD_BY_FRICTION)
    PASS(has_friction(r, f->elem_no, &friction));
  *unheld = f->held_by != HELD_BY_CONTACT && !friction;
  return OK;
}

/* Motions that nothing resists go to the log and are ERR_SINGULAR. */
static status refuse_unheld(const run *r, int n, const free_motion *list) {
  int unheld = 0, step_no = run_step_id(r) + 1;
  for (int i = 0; i < n; ++i) {
    int free;
    PASS(is_unheld(r, &list[i], &free));
    if (!free) continue;
    ++unheld;
    message_add(r->m->log, P4011, &r->step->at,
                "step %d: body %d (%s, element %zu) is free to move: %s; "
                "neither *BOUNDARY nor %s holds it",
                step_no, list[i].body_id + 1, body_name(r, list[i].elem_no),
                list[i].elem_no, list[i].text,
                list[i].held_by == HELD_BY_FRICTION ? "frictionless contact"
                                                    : "contact");
  }
  if (unheld > 0)
    RAISE(ERR_SINGULAR, "step %d: a body is free to move", step_no);
  return OK;
}

status run_check_supports(const run *r, int *n) {
  OWNED free_motion *list = NULL;
  PASS(domain_free_motions(&r->body.d, n, &list));
  return refuse_unheld(r, *n, list);
}

status run_motions(run *r, int *n, free_motion **list) {
  load_fixed(r->m, r->msh, r->step, r->body.fixed);
  PASS(run_build_ties(r));
  if (r->m->effects & EFFECT_CONTACT) PASS(run_build_surface(r));
  r->body.d.surface = r->surface;
  PASS(domain_free_motions(&r->body.d, n, list));
  PASS(refuse_unheld(r, *n, *list));
  return effects_prepare(r);
}
