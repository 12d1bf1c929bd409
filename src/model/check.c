/*
 * The model against the mesh: groups, dimensions, sections, kinematics.
 */
#include "model/keyword.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

static const char *const dim_words[] = {"points", "curves", "surfaces",
                                        "volumes"};

/* Id of a group, or -1 and an error with the nearest name. */
static int find_group(const model *m, const mesh *msh, const char *name,
                      const place *at) {
  const mesh_group *g = mesh_find_group(msh, name);
  if (g != NULL) return (int)(g - msh->group);
  const char *near = mesh_nearest_group(msh, name);
  message_add(m->log, P2021, at, "the mesh has no group %s%s%s%s", name,
              near == NULL ? "" : "; did you mean ", near == NULL ? "" : near,
              near == NULL ? "" : "?");
  return -1;
}

/* The same, of a wanted dimension. */
static int find_group_of(const model *m, const mesh *msh, const char *name,
                         int dim, const place *at) {
  int id = find_group(m, msh, name, at);
  if (id < 0 || msh->group[id].dim == dim) return id;
  message_add(m->log, P2022, at,
              "group %s is made of %s; %s are needed here in %d-D", name,
              dim_words[msh->group[id].dim], dim_words[dim], msh->dim);
  return -1;
}

static void check_kinematics(model *m, const mesh *msh) {
  for (int i = 0; i < m->n_section; ++i) {
    section *s = &m->sections[i];
    if (s->kin < 0) s->kin = msh->dim == 3 ? SOLID_3D : PLANE_STRAIN;
    if ((s->kin == SOLID_3D) != (msh->dim == 3))
      message_add(m->log, P2024, &s->at,
                  "*SOLID SECTION: this TYPE does not fit a mesh in %d-D",
                  msh->dim);
    if ((s->kin == AXISYMMETRIC) != (m->sections[0].kin == AXISYMMETRIC))
      message_add(m->log, P2026, &s->at,
                  "axisymmetric and plane sections cannot stand in one model");
    if (s->kin == AXISYMMETRIC || s->kin == SOLID_3D) s->thickness = 1.0;
  }
}

/* Each element in one section. */
static status check_sections(model *m, const mesh *msh) {
  status st = OK;
  NEW(m->elem_section, msh->n_elem);
  for (int e = 0; e < msh->n_elem; ++e) m->elem_section[e] = -1;
  for (int i = 0; i < m->n_section; ++i) {
    section *s = &m->sections[i];
    s->group_id = find_group_of(m, msh, s->elset, msh->dim, &s->at);
    if (s->group_id < 0) continue;
    const mesh_group *g = &msh->group[s->group_id];
    for (int k = 0; k < g->n_item; ++k) {
      int *of = &m->elem_section[g->item_id[k]];
      if (*of >= 0 && *of != i) {
        message_add(m->log, P2023, &s->at,
                    "element %zu belongs to section %s and to section %s",
                    msh->elem_no[g->item_id[k]], m->sections[*of].elset,
                    s->elset);
        break;
      }
      *of = i;
    }
  }
  if (message_count(m->log, ERROR) > 0) goto done;
  int missing = 0, first = -1;
  for (int e = 0; e < msh->n_elem; ++e)
    if (m->elem_section[e] < 0) {
      if (missing++ == 0) first = e;
    }
  if (missing > 0)
    message_add(m->log, P2023, &m->sections[0].at,
                "%d element%s, the first number %zu, without *SOLID SECTION",
                missing, missing == 1 ? "" : "s", msh->elem_no[first]);
done:
  return st;
}

static void check_contacts(model *m, const mesh *msh) {
  for (int i = 0; i < m->n_contact; ++i) {
    contact *c = &m->contacts[i];
    c->group_id = find_group_of(m, msh, c->group, msh->dim - 1, &c->at);
    if (c->obstacle_id < 0) continue;
    const obstacle *o = &m->obstacles[c->obstacle_id];
    int no_axis = o->direction[0] == 0.0 && o->direction[1] == 0.0 &&
                  o->direction[2] == 0.0;
    if (msh->dim == 3 && o->shape == OBSTACLE_CYLINDER && no_axis)
      message_add(m->log, P2007, &m->moves[c->obstacle_id].at,
                  "*OBSTACLE: a cylinder in 3-D needs a line with the "
                  "direction of its axis");
    if (msh->dim == 2 && o->shape == OBSTACLE_PLANE && o->direction[0] == 0.0 &&
        o->direction[1] == 0.0)
      message_add(m->log, P2027, &m->moves[c->obstacle_id].at,
                  "*OBSTACLE: the normal has no part in the plane of the mesh");
  }
}

/* Gravity needs a density wherever it acts. */
static void check_density(const model *m, const mesh *msh, const load *l) {
  const mesh_group *g = &msh->group[l->group_id];
  for (int k = 0; k < g->n_item; ++k) {
    int s = m->elem_section[g->item_id[k]];
    if (s < 0 || m->sections[s].material_id < 0) continue;
    const material *mat = &m->materials[m->sections[s].material_id];
    if (mat->has_density) continue;
    message_add(m->log, P2014, &l->at,
                "GRAV on group %s: material %s has no *DENSITY", l->group,
                mat->name);
    return;
  }
}

static void check_load(const model *m, const mesh *msh, load *l) {
  switch ((load_kind)l->kind) {
    case LOAD_PRESSURE:
    case LOAD_TRACTION:
      l->group_id = find_group_of(m, msh, l->group, msh->dim - 1, &l->at);
      break;
    case LOAD_BODY:
    case LOAD_GRAVITY:
      l->group_id = find_group_of(m, msh, l->group, msh->dim, &l->at);
      break;
    case LOAD_POINT:
    case LOAD_FIXING:
      l->group_id = find_group(m, msh, l->group, &l->at);
      break;
  }
  if (l->component >= msh->dim)
    message_add(m->log, P2025, &l->at,
                "component %d on group %s, but the mesh is %d-D",
                l->component + 1, l->group, msh->dim);
  if (l->kind == LOAD_GRAVITY && msh->dim == 2 && l->direction[2] != 0.0)
    message_add(m->log, P2025, &l->at, "GRAV along z, but the mesh is 2-D");
  if (l->kind == LOAD_GRAVITY && l->group_id >= 0) check_density(m, msh, l);
}

static void check_prints(const model *m, const mesh *msh, step *s) {
  for (int i = 0; i < s->n_print; ++i) {
    print_request *p = &s->prints[i];
    if (p->group == NULL) continue;
    p->group_id = p->table == PRINT_ELEMENTS
                      ? find_group_of(m, msh, p->group, msh->dim, &p->at)
                      : find_group(m, msh, p->group, &p->at);
  }
}

/* 1 if an earlier step has this load from the same line: checked there. */
static int checked_before(const model *m, int step_id, load *l) {
  for (int i = 0; i < step_id; ++i)
    for (int k = 0; k < m->steps[i].loads.n; ++k) {
      const load *old = &m->steps[i].loads.item[k];
      if (old->at.file != l->at.file || old->at.line_no != l->at.line_no ||
          old->component != l->component)
        continue;
      l->group_id = old->group_id;
      return 1;
    }
  return 0;
}

static void check_steps(model *m, const mesh *msh) {
  for (int i = 0; i < m->n_step; ++i) {
    step *s = &m->steps[i];
    for (int k = 0; k < s->loads.n; ++k)
      if (!checked_before(m, i, &s->loads.item[k]))
        check_load(m, msh, &s->loads.item[k]);
    check_prints(m, msh, s);
  }
}

status model_check(model *m, const mesh *msh) {
  status st = OK;
  m->dim = msh->dim;
  m->ns = msh->dim == 3 ? 6 : 4;
  check_kinematics(m, msh);
  TRY(check_sections(m, msh));
  check_contacts(m, msh);
  check_steps(m, msh);
  model_find_effects(m);
  TRY(message_status(m->log, ERR_DECK));
done:
  return st;
}
