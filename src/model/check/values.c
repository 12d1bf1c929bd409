/*
 * Values: expressions give numbers where steps begin and end, supports agree
 * where groups meet.
 */
#include "base/memory.h"
#include "model/check/parts.h"
#include "model/field/field.h"

#include <math.h>
#include <string.h>

/* ---- names of groups to their ids in the mesh ---------------------------- */

int check_group(const model *m, const mesh *msh, const char *name,
                const place *at) {
  const mesh_group *g = mesh_find_group(msh, name);
  if (g != NULL) return (int)(g - msh->group);
  const char *near =
      message_wanted(m->log, ERROR) ? mesh_nearest_group(msh, name) : NULL;
  if (near != NULL) {
    message_add(m->log, P2021, at, "the mesh has no group %s; did you mean %s?",
                name, near);
    return -1;
  }
  char all[400] = "";
  size_t n = 0;
  for (int i = 0; i < msh->n_group && n < sizeof all / 2; ++i)
    n += (size_t)snprintf(all + n, sizeof all - n, "%s%.60s",
                          i == 0 ? "" : ", ", msh->group[i].name);
  message_add(m->log, P2021, at, "the mesh has no group %s; it has %s", name,
              all);
  return -1;
}

int check_group_of(const model *m, const mesh *msh, const char *name, int dim,
                   const place *at) {
  int id = check_group(m, msh, name, at);
  if (id < 0 || msh->group[id].dim == dim) return id;
  message_add(m->log, P2022, at,
              "group %s is made of %s; %s are needed here in %d-D", name,
              mesh_words[msh->group[id].dim], mesh_words[dim], msh->dim);
  return -1;
}

/* ---- loads, initial conditions and tables against the mesh --------------- */

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

/* A pressure needs an outside. */
static void check_outside(const model *m, const mesh *msh, const load *l) {
  const mesh_group *g = &msh->group[l->group_id];
  for (int k = 0; k < g->n_item; ++k) {
    if (msh->face_other[g->item_id[k]] < 0) continue;
    message_add(
        m->log, P2035, &l->at,
        "P on group %s: a face between elements %zu and %zu lies inside "
        "the body",
        l->group, msh->elem_no[msh->face_elem[g->item_id[k]]],
        msh->elem_no[msh->face_other[g->item_id[k]]]);
    return;
  }
}

/* Id of the group a load acts on, or -1 and the error. */
static int load_group(const model *m, const mesh *msh, const load *l) {
  switch ((load_kind)l->kind) {
    case LOAD_PRESSURE:
    case LOAD_TRACTION:
      return check_group_of(m, msh, l->group, msh->dim - 1, &l->at);
    case LOAD_BODY:
    case LOAD_GRAVITY:
    case LOAD_TEMPERATURE:
      return check_group_of(m, msh, l->group, msh->dim, &l->at);
    case LOAD_POINT:
    case LOAD_FIXING:
      break;
  }
  return check_group(m, msh, l->group, &l->at);
}

static void check_load(const model *m, const mesh *msh, load *l) {
  l->group_id = load_group(m, msh, l);
  if (l->kind == LOAD_PRESSURE && l->group_id >= 0) check_outside(m, msh, l);
  if (l->component >= msh->dim)
    message_add(m->log, P2025, &l->at,
                "component %d on group %s, but the mesh is %d-D",
                l->component + 1, l->group, msh->dim);
  if (l->kind == LOAD_GRAVITY && msh->dim == 2 && l->direction[2] != 0.0)
    message_add(m->log, P2025, &l->at, "GRAV along z, but the mesh is 2-D");
  if (l->kind == LOAD_GRAVITY && l->group_id >= 0) check_density(m, msh, l);
}

/* Strains and internal variables belong to elements whose law has them. */
static void check_initial_law(const model *m, const mesh *msh,
                              const initial *c) {
  const mesh_group *g = &msh->group[c->group_id];
  for (int k = 0; k < g->n_item; ++k) {
    int s = m->elem_section[g->item_id[k]];
    if (s < 0 || m->sections[s].material_id < 0) continue;
    const material *mat = &m->materials[m->sections[s].material_id];
    int n = m->ns;
    if (mat->law.ops == NULL) {
      message_add(m->log, P2014, &c->at,
                  "*INITIAL CONDITIONS on group %s: material %s has no "
                  "*INELASTIC",
                  c->group, mat->name);
      return;
    }
    if (c->type == INITIAL_INTERNAL) n = law_n_alpha(&mat->law, m->ns);
    if (c->component < n) continue;
    message_add(m->log, P2025, &c->at,
                "*INITIAL CONDITIONS: component %d on group %s; law %s has %d "
                "here",
                c->component + 1, c->group, mat->law.ops->name, n);
    return;
  }
}

void check_initials(model *m, const mesh *msh) {
  for (int i = 0; i < m->n.initial; ++i) {
    initial *c = &m->initial.lines[i];
    int nodal = c->type == INITIAL_DISPLACEMENT;
    c->group_id = nodal ? check_group(m, msh, c->group, &c->at)
                        : check_group_of(m, msh, c->group, msh->dim, &c->at);
    if (nodal && c->component >= msh->dim)
      message_add(m->log, P2025, &c->at,
                  "component %d on group %s, but the mesh is %d-D",
                  c->component + 1, c->group, msh->dim);
    if (c->group_id >= 0 &&
        (c->type == INITIAL_STRAIN || c->type == INITIAL_INTERNAL))
      check_initial_law(m, msh, c);
  }
}

static void check_prints(const model *m, const mesh *msh, step *s) {
  for (int i = 0; i < s->print.n; ++i) {
    print_request *p = &s->print.requests[i];
    if (p->group == NULL) continue;
    p->group_id = p->table == PRINT_ELEMENTS
                      ? check_group_of(m, msh, p->group, msh->dim, &p->at)
                      : check_group(m, msh, p->group, &p->at);
  }
}

/* The field of a file, read once; NULL after a message. */
static status find_field(model *m, const mesh *msh, const char *file,
                         const place *at, const double **out) {
  status st = OK;
  *out = NULL;
  if (file == NULL) goto done;
  for (int i = 0; i < m->n.field && *out == NULL; ++i)
    if (strcmp(m->load.fields[i].file, file) == 0)
      *out = m->load.fields[i].value;
  if (*out != NULL) goto done;
  GROW(m->load.fields, m->n.field, m->cap.field);
  nodal_field *f = &m->load.fields[m->n.field];
  st = nodal_field_read(file, msh, &f->value);
  if (st == ERR_FILE || st == ERR_DECK) {
    message_add(m->log, P2053, at, "%s", status_message());
    st = OK;
    goto done;
  }
  TRY(st);
  f->file = file;
  *out = f->value;
  ++m->n.field;
done:
  return st;
}

status check_fields(model *m, const mesh *msh) {
  for (int i = 0; i < m->n.step; ++i)
    for (int k = 0; k < m->steps[i].loads.n; ++k) {
      load *l = &m->steps[i].loads.item[k];
      PASS(find_field(m, msh, l->file, &l->file_at, &l->field));
      PASS(find_field(m, msh, l->before_file, &l->file_at, &l->before_field));
    }
  return OK;
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

void check_steps(model *m, const mesh *msh) {
  for (int i = 0; i < m->n.step; ++i) {
    step *s = &m->steps[i];
    for (int k = 0; k < s->loads.n; ++k)
      if (!checked_before(m, i, &s->loads.item[k]))
        check_load(m, msh, &s->loads.item[k]);
    check_prints(m, msh, s);
  }
}

static double step_time(const step *s, int end) {
  return end ? s->start + s->total : s->start;
}

/* A value of a contact that must be at least zero, as the cards say it. */
typedef struct contact_value {
  const char *card, *name; /* "FRICTION", "mu"; NULL: there is none */
  const quantity *value;
  const place *at;
} contact_value;

/* That value at the nodes of the contact at t; 0 after a message. */
static int contact_finite(const model *m, const mesh *msh, const contact *c,
                          contact_value v, double t) {
  const mesh_group *g = &msh->group[c->group_id];
  for (int k = 0; k < g->n_node && v.name != NULL; ++k) {
    double x[3] = {0.0, 0.0, 0.0};
    size_t node = (size_t)g->node_id[k], dim = (size_t)msh->dim;
    memcpy(x, msh->x + dim * node, dim * sizeof *x);
    double value = quantity_value(v.value, x, t);
    if (isfinite(value) && value >= 0.0) continue;
    message_add(m->log, P2041, v.at,
                "*%s: %s is %s at node %zu (%g, %g, %g), time %g", v.card,
                v.name,
                isnan(value)  ? "not a number"
                : value < 0.0 ? "negative"
                              : "infinite",
                msh->node_no[node], x[0], x[1], x[2], t);
    return 0;
  }
  return 1;
}

static void check_contact_values(const model *m, const mesh *msh, int id) {
  const contact *c = &m->contacts[id];
  int good = 1, fine = 1, sound = 1;
  for (int k = 0; k < m->n.step; ++k) {
    double t = step_time(&m->steps[k], 1);
    const friction_rule *rule = friction_in_force(m, k, id);
    contact_value friction = {"FRICTION",
                              rule->law == NULL ? NULL : rule->law->value_name,
                              &rule->card.value, &rule->value_at};
    contact_value force = {"CONTACT FORCE", c->force.given ? "p" : NULL,
                           &c->force.value, &c->force.value_at};
    good = good && contact_finite(m, msh, c, friction, t);
    contact_value change = {"CONTACT PAIR",
                            !c->change.given       ? NULL
                            : c->change.interferes ? "INTERFERENCE"
                                                   : "CLEARANCE",
                            &c->change.value, &c->change.at};
    fine = fine && contact_finite(m, msh, c, force, t);
    sound = sound && contact_finite(m, msh, c, change, t);
  }
}

static int motion_finite(const model *m, int obstacle_id, double t) {
  double d[3];
  obstacle_motion(&m->obstacles[obstacle_id], t, d);
  for (int c = 0; c < 3; ++c)
    if (!isfinite(d[c])) {
      message_add(m->log, P2041, &m->moves[obstacle_id].move_at,
                  "*OBSTACLE %s: component %d of MOVE is %s at time %g",
                  m->obstacles[obstacle_id].name, c + 1,
                  isnan(d[c]) ? "not a number" : "infinite", t);
      return 0;
    }
  double angle = obstacle_angle(&m->obstacles[obstacle_id], t);
  if (isfinite(angle)) return 1;
  message_add(m->log, P2041, &m->moves[obstacle_id].rotate_at,
              "*OBSTACLE %s: the angle of ROTATE is %s at time %g",
              m->obstacles[obstacle_id].name,
              isnan(angle) ? "not a number" : "infinite", t);
  return 0;
}

/* Contact acts along the normals of time 0: reported at the first step end
 * where a plane deviates from them by more than a tenth. */
static void check_tilt(const model *m, int obstacle_id) {
  const obstacle *o = &m->obstacles[obstacle_id];
  for (int k = 0; k < m->n.step; ++k) {
    double t = step_time(&m->steps[k], 1), tilt = obstacle_tilt(o, t);
    if (!(tilt > 0.1)) continue;
    message_add(m->log, P2052, &m->moves[obstacle_id].rotate_at,
                "*OBSTACLE %s: ROTATE has tilted the plane by %.3g rad at time "
                "%g; contact acts along the normals of time 0",
                o->name, tilt, t);
    return;
  }
}

void check_values(const model *m, const mesh *msh) {
  for (int i = 0; i < m->n.obstacle; ++i) {
    int good = motion_finite(m, i, 0.0);
    for (int k = 0; k < m->n.step && good; ++k)
      good = motion_finite(m, i, step_time(&m->steps[k], 1));
    if (good) check_tilt(m, i);
  }
  for (int i = 0; i < m->n.contact; ++i) check_contact_values(m, msh, i);
  for (int i = 0; i < m->n.step; ++i)
    for (int k = 0; k < m->steps[i].loads.n; ++k)
      if (m->steps[i].loads.item[k].run != RUN_HELD)
        load_finite(m, msh, &m->steps[i], &m->steps[i].loads.item[k],
                    step_time(&m->steps[i], 1));
}

status check_agreement(const model *m, const mesh *msh, int step_id) {
  const step *s = &m->steps[step_id];
  OWNED int *owner = NULL;
  OWNED double *ud = NULL;
  size_t n_dof = (size_t)msh->dim * (size_t)msh->n_node;
  PASS_NEW(owner, n_dof);
  PASS_NEW(ud, n_dof);
  for (int i = 0; i < s->loads.n; ++i) {
    const load *l = &s->loads.item[i];
    const mesh_group *g = &msh->group[l->group_id];
    int reported = 0;
    for (int k = 0; k < g->n_node && l->kind == LOAD_FIXING; ++k) {
      size_t node = (size_t)g->node_id[k];
      size_t dof = (size_t)msh->dim * node + (size_t)l->component;
      double value = load_at_node(l, msh, s, (int)node, step_time(s, 1));
      const load *first =
          owner[dof] > 0 ? &s->loads.item[owner[dof] - 1] : NULL;
      if (first != NULL && value != ud[dof] && !reported++)
        message_add(m->log, P2038, &l->at,
                    "node %zu of group %s: component %d is %g here and %g on "
                    "line %d, group %s",
                    msh->node_no[node], l->group, l->component + 1, value,
                    ud[dof], first->at.line_no, first->group);
      owner[dof] = i + 1;
      ud[dof] = value;
    }
  }
  return OK;
}
