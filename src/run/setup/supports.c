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

/* 1 if a contact with friction acts on the body of an element. */
static status has_body_friction(const run *r, int elem_id, int *answer) {
  status st = OK;
  const model *m = r->m;
  const mesh *msh = r->msh;
  int *body = NULL, n = 0;
  *answer = 0;
  NEW(body, msh->n_elem);
  TRY(mesh_bodies(msh, &n, body));
  for (int i = 0; i < m->n.contact; ++i) {
    const contact *c = &m->contacts[i];
    if (!rule_has_friction(friction_in_force(m, run_step_id(r), i))) continue;
    *answer |=
        is_at(msh, c->group_id, body, body[elem_id]) ||
        (c->is_pair && is_at(msh, c->pair.master_id, body, body[elem_id]));
  }
done:
  memory_free(body);
  return st;
}

/* 1 if nothing resists: no contact there, or tangential contact of a body
 * without friction. */
static status is_unheld(const run *r, const free_motion *f, int *unheld) {
  status st = OK;
  int friction = 0;
  *unheld = f->held_by == HELD_BY_NOTHING;
  if (f->held_by != HELD_BY_FRICTION) goto done;
  for (int e = 0; e < r->msh->n_elem; ++e)
    if (r->msh->elem_no[e] == f->elem_no)
      TRY(has_body_friction(r, e, &friction));
  *unheld = !friction;
done:
  return st;
}

/* Motions that nothing resists go to the log and are ERR_SINGULAR. */
static status refuse_unheld(const run *r, int n, const free_motion *list) {
  status st = OK;
  int unheld = 0, step_no = run_step_id(r) + 1;
  for (int i = 0; i < n; ++i) {
    int free;
    TRY(is_unheld(r, &list[i], &free));
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
    FAIL(ERR_SINGULAR, "step %d: a body is free to move", step_no);
done:
  return st;
}

status run_check_supports(const run *r, int *n) {
  status st = OK;
  free_motion *list = NULL;
  TRY(domain_free_motions(&r->body.d, n, &list));
  TRY(refuse_unheld(r, *n, list));
done:
  memory_free(list);
  return st;
}

status run_motions(run *r, int *n, free_motion **list) {
  status st = OK;
  load_fixed(r->m, r->msh, r->step, r->body.fixed);
  TRY(run_build_ties(r));
  if (r->m->effects & EFFECT_CONTACT) TRY(run_build_surface(r));
  r->body.d.surface = r->surface;
  TRY(domain_free_motions(&r->body.d, n, list));
  TRY(refuse_unheld(r, *n, *list));
  TRY(effects_prepare(r));
done:
  return st;
}
