/*
 * The model against the mesh: groups, dimensions, sections, kinematics.
 */
#include "model/keyword.h"

#include "base/memory.h"
#include "field/field.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char *const dim_words[] = {"points", "curves", "surfaces",
                                        "volumes"};

/* Id of a group, or -1 and an error with the nearest name. */
static int find_group(const model *m, const mesh *msh, const char *name,
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
    if (s->averaged && s->kin == PLANE_STRESS)
      message_add(m->log, P2037, &s->at,
                  "*SOLID SECTION: FORMULATION=AVERAGED does nothing in plane "
                  "stress, which does not lock");
    if (s->kin != AXISYMMETRIC && s->kin != SOLID_3D) continue;
    s->thickness = 1.0;
    if (s->has_thickness)
      message_add(
          m->log, P2037, &s->at,
          "*SOLID SECTION: a thickness counts in plane strain and plane "
          "stress only");
  }
}

/*
 * P1 elements lock where nu comes near 1/2 in plane strain, axisymmetry and
 * 3-D. Lame's tube (radii 1 and 2, unstructured mesh with n elements through
 * its wall): the displacement is too small by about 0.55/(1 + 5 (1 - 2 nu)
 * n^2), within a third of the errors observed for nu = 0.49 to 0.4999 and n = 8
 * to 64.
 */
double model_locking_error(double nu, int n) {
  return 0.55 / (1.0 + 5.0 * (1.0 - 2.0 * nu) * n * n);
}

static void check_locking(const model *m) {
  enum { COARSE = 16, FINE = 64 };
  for (int i = 0; i < m->n_section; ++i) {
    const section *s = &m->sections[i];
    const material *mat =
        s->material_id < 0 || s->kin == PLANE_STRESS || s->averaged
            ? NULL
            : &m->materials[s->material_id];
    if (mat == NULL || mat->elastic.n == 0 || mat->elastic.type != ELASTIC_ISO)
      continue;
    double nu = elastic_table_most(&mat->elastic, 1);
    if (nu <= 0.49) continue;
    message_add(m->log, P2055, &s->at,
                "nu = %g of material %s: linear elements lock; expect "
                "displacements too small by some %.2g %% with %d elements "
                "across a wall, %.2g %% with %d",
                nu, mat->name, 100.0 * model_locking_error(nu, COARSE), COARSE,
                100.0 * model_locking_error(nu, FINE), FINE);
  }
}

/* The radius x of an axisymmetric model is not negative. */
static void check_radius(const model *m, const mesh *msh) {
  static const double rounding = 1e-9; /* of the size of the mesh            */
  if (m->n_section == 0 || m->sections[0].kin != AXISYMMETRIC) return;
  for (int i = 0; i < msh->n_node; ++i) {
    const double *x = msh->x + (size_t)msh->dim * (size_t)i;
    if (x[0] >= -rounding * msh->size) continue;
    message_add(m->log, P2039, &m->sections[0].at,
                "axisymmetric, but node %zu is at radius x = %g",
                msh->node_no[i], x[0]);
    return;
  }
}

/* Each element in one section. */
static status check_sections(model *m, const mesh *msh) {
  status st = OK;
  NEW(m->elem_section, msh->n_elem);
  for (int e = 0; e < msh->n_elem; ++e) m->elem_section[e] = -1;
  for (int i = 0; i < m->n_section; ++i) {
    section *s = &m->sections[i];
    s->group_id = find_group_of(m, msh, s->elset, msh->dim, &s->elset_at);
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

/* A group meets an obstacle once: twice would count its areas twice. */
static void check_twice(const model *m, int contact_id) {
  const contact *c = &m->contacts[contact_id];
  for (int i = 0; i < contact_id; ++i)
    if (c->group_id >= 0 && m->contacts[i].group_id == c->group_id &&
        m->contacts[i].obstacle_id == c->obstacle_id) {
      message_add(m->log, P2011, &c->group_at,
                  "contact %s has the group and the obstacle of contact %s",
                  c->name, m->contacts[i].name);
      return;
    }
}

/* In the plane an obstacle turns in the plane, and not about r = 0. */
static void check_turn(const model *m, int dim, int obstacle_id) {
  const obstacle *o = &m->obstacles[obstacle_id];
  const place *at = &m->moves[obstacle_id].rotate_at;
  if (!o->turns || dim == 3) return;
  if (m->n_section > 0 && m->sections[0].kin == AXISYMMETRIC)
    message_add(m->log, P2043, at,
                "*OBSTACLE %s: an axisymmetric model has no displacement "
                "around its axis that could follow ROTATE",
                o->name);
  else if (o->axis[0] != 0.0 || o->axis[1] != 0.0)
    message_add(m->log, P2043, at,
                "*OBSTACLE %s: the axis of ROTATE is (%g, %g, %g); in a plane "
                "model it is along z",
                o->name, o->axis[0], o->axis[1], o->axis[2]);
}

static void check_torque_axis(const model *m, int dim, const contact *c) {
  if (!c->has_axis || c->axis_of_obstacle || dim == 3) return;
  if (m->n_section > 0 && m->sections[0].kin == AXISYMMETRIC)
    message_add(m->log, P2037, &c->axis_at,
                "*CONTACT %s: AXIS counts for plane models and in 3-D only",
                c->name);
  else if (c->axis[0] != 0.0 || c->axis[1] != 0.0)
    message_add(m->log, P2037, &c->axis_at,
                "*CONTACT %s: forces in the plane have a torque about z only",
                c->name);
}

/* Options of a friction law that are not for every model. */
static void check_law(const model *m, const char *contact_name,
                      const friction_rule *rule) {
  int axisymmetric = m->n_section > 0 && m->sections[0].kin == AXISYMMETRIC;
  if (rule->law == NULL || rule->law->misfit == NULL) return;
  const char *why = rule->law->misfit(rule->card.param, m->dim, axisymmetric);
  if (why != NULL)
    message_add(m->log, P2045, &rule->at, "*FRICTION, LAW=%s on contact %s: %s",
                rule->law->name, contact_name, why);
}

static void check_laws(const model *m) {
  for (int i = 0; i < m->n_contact; ++i)
    check_law(m, m->contacts[i].name, &m->contacts[i].friction);
  for (int k = 0; k < m->n_step; ++k)
    for (int i = 0; i < m->steps[k].n_change; ++i) {
      const friction_change *f = &m->steps[k].changes[i];
      check_law(m, m->contacts[f->contact_id].name, &f->rule);
    }
}

/* Points and directions of an obstacle in 3-D have three numbers; a sphere of
 * an axisymmetric model stays on the axis. */
static void check_obstacle_fields(const model *m, const mesh *msh, int id) {
  const obstacle *o = &m->obstacles[id];
  const quantity *radial = &o->motion[0];
  if (msh->dim == 3 && m->moves[id].short_at.file != NULL)
    message_add(m->log, P2009, &m->moves[id].short_at,
                "2 numbers on this line of *OBSTACLE; a mesh in 3-D needs 3");
  if (m->n_section > 0 && m->sections[0].kin == AXISYMMETRIC &&
      o->shape == OBSTACLE_SPHERE &&
      (radial->formula != NULL || radial->number != 0.0))
    message_add(m->log, P4009, &m->moves[id].move_at,
                "*OBSTACLE %s: MOVE leads the sphere off the axis of symmetry",
                o->name);
}

static void check_contacts(model *m, const mesh *msh) {
  for (int i = 0; i < m->n_contact; ++i) {
    contact *c = &m->contacts[i];
    c->group_id = find_group_of(m, msh, c->group, msh->dim - 1, &c->group_at);
    check_twice(m, i);
    if (c->obstacle_id < 0) continue;
    const obstacle *o = &m->obstacles[c->obstacle_id];
    int no_axis = o->direction[0] == 0.0 && o->direction[1] == 0.0 &&
                  o->direction[2] == 0.0;
    check_obstacle_fields(m, msh, c->obstacle_id);
    if (msh->dim == 3 && o->shape == OBSTACLE_CYLINDER && no_axis)
      message_add(m->log, P2007, &m->moves[c->obstacle_id].at,
                  "*OBSTACLE: a cylinder in 3-D needs a line with the "
                  "direction of its axis");
    if (msh->dim == 2 && o->shape == OBSTACLE_PLANE && o->direction[0] == 0.0 &&
        o->direction[1] == 0.0)
      message_add(m->log, P2027, &m->moves[c->obstacle_id].at,
                  "*OBSTACLE: the normal has no part in the plane of the mesh");
    check_turn(m, msh->dim, c->obstacle_id);
    check_torque_axis(m, msh->dim, c);
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
      return find_group_of(m, msh, l->group, msh->dim - 1, &l->at);
    case LOAD_BODY:
    case LOAD_GRAVITY:
    case LOAD_TEMPERATURE:
      return find_group_of(m, msh, l->group, msh->dim, &l->at);
    case LOAD_POINT:
    case LOAD_FIXING:
      break;
  }
  return find_group(m, msh, l->group, &l->at);
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

static void check_initials(model *m, const mesh *msh) {
  for (int i = 0; i < m->n_initial; ++i) {
    initial *c = &m->initials[i];
    int nodal = c->type == INITIAL_DISPLACEMENT;
    c->group_id = nodal ? find_group(m, msh, c->group, &c->at)
                        : find_group_of(m, msh, c->group, msh->dim, &c->at);
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
  for (int i = 0; i < s->n_print; ++i) {
    print_request *p = &s->prints[i];
    if (p->group == NULL) continue;
    p->group_id = p->table == PRINT_ELEMENTS
                      ? find_group_of(m, msh, p->group, msh->dim, &p->at)
                      : find_group(m, msh, p->group, &p->at);
  }
}

/* The field of a file, read once; NULL after a message. */
static status find_field(model *m, const mesh *msh, const char *file,
                         const place *at, const double **out) {
  status st = OK;
  *out = NULL;
  if (file == NULL) goto done;
  for (int i = 0; i < m->n_field && *out == NULL; ++i)
    if (strcmp(m->fields[i].file, file) == 0) *out = m->fields[i].value;
  if (*out != NULL) goto done;
  GROW(m->fields, m->n_field, m->cap_field);
  nodal_field *f = &m->fields[m->n_field];
  st = nodal_field_read(file, msh, &f->value);
  if (st == ERR_FILE || st == ERR_DECK) {
    message_add(m->log, P2053, at, "%s", status_message());
    st = OK;
    goto done;
  }
  TRY(st);
  f->file = file;
  *out = f->value;
  ++m->n_field;
done:
  return st;
}

static status check_fields(model *m, const mesh *msh) {
  status st = OK;
  for (int i = 0; i < m->n_step; ++i)
    for (int k = 0; k < m->steps[i].loads.n; ++k) {
      load *l = &m->steps[i].loads.item[k];
      TRY(find_field(m, msh, l->file, &l->file_at, &l->field));
      TRY(find_field(m, msh, l->before_file, &l->file_at, &l->before_field));
    }
done:
  return st;
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

static double step_time(const step *s, int end) {
  return end ? s->start + s->total : s->start;
}

/* A value of a contact that must be at least zero, as the cards say it. */
typedef struct contact_value {
  const char *card, *name; /* "FRICTION", "mu"; NULL: there is none           */
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
  int good = 1, fine = 1;
  for (int k = 0; k < m->n_step; ++k) {
    double t = step_time(&m->steps[k], 1);
    const friction_rule *rule = friction_in_force(m, k, id);
    contact_value friction = {"FRICTION",
                              rule->law == NULL ? NULL : rule->law->value_name,
                              &rule->card.value, &rule->value_at};
    contact_value force = {"CONTACT FORCE", c->force.given ? "p" : NULL,
                           &c->force.value, &c->force.value_at};
    good = good && contact_finite(m, msh, c, friction, t);
    fine = fine && contact_finite(m, msh, c, force, t);
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

/* Contact acts along the normals of time 0: told at the first step end where a
 * plane has left them by more than a tenth. */
static void check_tilt(const model *m, int obstacle_id) {
  const obstacle *o = &m->obstacles[obstacle_id];
  for (int k = 0; k < m->n_step; ++k) {
    double t = step_time(&m->steps[k], 1), tilt = obstacle_tilt(o, t);
    if (!(tilt > 0.1)) continue;
    message_add(m->log, P2052, &m->moves[obstacle_id].rotate_at,
                "*OBSTACLE %s: ROTATE has tilted the plane by %.3g rad at time "
                "%g; contact acts along the normals of time 0",
                o->name, tilt, t);
    return;
  }
}

/* Where each step begins and ends, what the expressions give is a number; in
 * between it is seen when it is needed. */
static void check_values(const model *m, const mesh *msh) {
  int good = 1;
  for (int i = 0; i < m->n_obstacle; ++i) {
    good = motion_finite(m, i, 0.0);
    for (int k = 0; k < m->n_step && good; ++k)
      good = motion_finite(m, i, step_time(&m->steps[k], 1));
    if (good) check_tilt(m, i);
  }
  for (int i = 0; i < m->n_contact; ++i) check_contact_values(m, msh, i);
  for (int i = 0; i < m->n_step; ++i)
    for (int k = 0; k < m->steps[i].loads.n; ++k)
      if (m->steps[i].loads.item[k].run != RUN_HELD)
        load_finite(m, msh, &m->steps[i], &m->steps[i].loads.item[k],
                    step_time(&m->steps[i], 1));
}

/* Two groups that share nodes prescribe the same displacement there. */
static status check_agreement(const model *m, const mesh *msh, int step_id) {
  status st = OK;
  const step *s = &m->steps[step_id];
  int *owner = NULL;
  double *ud = NULL;
  size_t n_dof = (size_t)msh->dim * (size_t)msh->n_node;
  NEW(owner, n_dof);
  NEW(ud, n_dof);
  for (int i = 0; i < s->loads.n; ++i) {
    const load *l = &s->loads.item[i];
    const mesh_group *g = &msh->group[l->group_id];
    int told = 0;
    for (int k = 0; k < g->n_node && l->kind == LOAD_FIXING; ++k) {
      size_t node = (size_t)g->node_id[k];
      size_t dof = (size_t)msh->dim * node + (size_t)l->component;
      double value = load_at_node(l, msh, s, (int)node, step_time(s, 1));
      const load *first =
          owner[dof] > 0 ? &s->loads.item[owner[dof] - 1] : NULL;
      if (first != NULL && value != ud[dof] && !told++)
        message_add(m->log, P2038, &l->at,
                    "node %zu of group %s: component %d is %g here and %g on "
                    "line %d, group %s",
                    msh->node_no[node], l->group, l->component + 1, value,
                    ud[dof], first->at.line_no, first->group);
      owner[dof] = i + 1;
      ud[dof] = value;
    }
  }
done:
  memory_free(owner);
  memory_free(ud);
  return st;
}

int step_has_limit(const step *s) {
  return !s->integrator->linear_only && s->theta < 1.0;
}

/* THETA < 1 turns the sign of what is much faster than dt at each step. */
static void tell_ringing(const model *m, const step *s, double t, double dt,
                         double rate) {
  double theta = s->theta, z = rate * dt;
  if (s->integrator->limit > 0.0 || (1.0 - theta) * z <= 1.0) return;
  message_add(m->log, P2051, &s->at,
              "step %d, time %g: dt = %.6g is %.4g times the shortest "
              "relaxation time: THETA = %g multiplies what relaxes so fast by "
              "%.4f at each increment",
              (int)(s - m->steps) + 1, t, dt, z, theta,
              (1.0 - (1.0 - theta) * z) / (1.0 + theta * z));
}

int step_level(const model *m, const step *s, double t, double dt, double rate,
               int tell) {
  enum { DEEPEST = 30 };
  int level = 0;
  double limit = scheme_limit(s->integrator, s->theta) / rate;
  /* Ends of increments are sums: dt is known to the rounding of the time. */
  double rounding = 4e-16 * (fabs(t) + dt);
  if (tell) tell_ringing(m, s, t, dt, rate);
  while (ldexp(dt, -level) > limit + rounding && level < DEEPEST) ++level;
  if (level == 0 || (s->substeps && level < DEEPEST)) return level;
  message_add(m->log, P2050, &s->at,
              "step %d, time %g: %s is stable up to dt = %.9g (fastest rate "
              "%.9g), not with dt = %.9g; give a smaller dt, SUBSTEPS=AUTO, or "
              "INTEGRATOR=BACKWARD",
              (int)(s - m->steps) + 1, t, s->integrator->name, limit, rate, dt);
  return -1;
}

static int is_constant(const material *mat) {
  return mat->law.ops->linear && law_varies(&mat->law) == 0 &&
         mat->elastic.n == 1;
}

/* Laws of the bodies under an integrator that is exact for constant ones. */
static void check_exact(const model *m, int step_id) {
  const step *s = &m->steps[step_id];
  for (int i = 0; i < m->n_section; ++i) {
    const material *mat = &m->materials[m->sections[i].material_id];
    const law_card *law = &mat->law;
    if (law->ops == NULL || is_constant(mat)) continue;
    message_add(m->log, P2054, &s->at,
                "step %d: INTEGRATOR=%s, but %s of material %s %s", step_id + 1,
                s->integrator->name, law->ops->name, mat->name,
                !law->ops->linear ? "is not linear"
                : law_varies(law) & LAW_VARIES_TIME
                    ? "has coefficients that vary in time"
                : law_varies(law) != 0 ? "depends on temperature"
                                       : "has moduli that do");
  }
}

/* The fastest rate of the laws whose Jacobian is the same for ever, 1/s. */
static status constant_rate(const model *m, double *fastest) {
  status st = OK;
  static const double zero[FLOW_VALUE_MAX];
  flow_kind kind = {0};
  *fastest = 0.0;
  for (int i = 0; i < m->n_section; ++i) {
    const material *mat = &m->materials[m->sections[i].material_id];
    law_elastic elastic;
    law_point p;
    double rate;
    if (mat->law.ops == NULL || !is_constant(mat)) continue;
    TRY(law_elastic_read(&mat->elastic, 0.0, (kinematics)m->sections[i].kin,
                         &elastic));
    TRY(flow_new_kind(&kind, &mat->law, &elastic));
    TRY(flow_coefficients(&kind, 0.0, 0.0, NULL, &p));
    p.sigma = p.ei = p.alpha = zero;
    TRY(law_fastest_rate(&p, &rate));
    *fastest = fmax(*fastest, rate);
    flow_kind_free(&kind);
  }
done:
  flow_kind_free(&kind);
  return st;
}

/* 1: a mean stress alone makes nothing flow, as far as a shear does. */
static status keeps_volume(const section *s, const material *mat, int *answer) {
  status st = OK;
  static const double zero[FLOW_VALUE_MAX];
  double value[FLOW_VALUE_MAX], alpha_rate[FLOW_VALUE_MAX], ei_rate[6];
  flow_kind kind = {0};
  law_elastic elastic;
  law_point p;
  TRY(law_elastic_read(&mat->elastic, 0.0, (kinematics)s->kin, &elastic));
  TRY(flow_new_kind(&kind, &mat->law, &elastic));
  TRY(flow_coefficients(&kind, 0.0, 0.0, value, &p));
  const double size = 1e-3 * elastic.young;
  const double mean[6] = {size, size, size}, shear[6] = {0, 0, 0, size};
  p.ei = p.alpha = zero;
  p.speed = 1.0; /* whatever the temperature                                  */
  p.sigma = mean;
  law_rate(&p, ei_rate, alpha_rate);
  double swelling = fabs(tensor_trace(ei_rate));
  p.sigma = shear;
  law_rate(&p, ei_rate, alpha_rate);
  *answer = swelling <= 1e-9 * fabs(ei_rate[3]);
done:
  flow_kind_free(&kind);
  return st;
}

/* Bodies that creep at constant volume become incompressible. */
static status check_creep(const model *m) {
  status st = OK;
  for (int i = 0; i < m->n_section; ++i) {
    const section *s = &m->sections[i];
    const material *mat = &m->materials[s->material_id];
    int locks = 0;
    if (mat->law.ops == NULL || s->kin == PLANE_STRESS || s->averaged) continue;
    TRY(keeps_volume(s, mat, &locks));
    if (locks)
      message_add(m->log, P2055, &s->at,
                  "law %s of material %s creeps at constant volume: where its "
                  "strains outgrow the elastic ones, linear elements lock",
                  mat->law.ops->name, mat->name);
  }
done:
  return st;
}

/* Increments of *VISCO steps against the laws that do not change. */
static status check_visco(const model *m) {
  status st = OK;
  double rate;
  if (!(m->effects & EFFECT_INELASTIC)) return OK;
  TRY(constant_rate(m, &rate));
  if (has_card(m, "VISCO")) TRY(check_creep(m));
  for (int i = 0; i < m->n_step; ++i) {
    const step *s = &m->steps[i];
    if (s->kind != STEP_VISCO) continue;
    if (s->integrator->linear_only) check_exact(m, i);
    if (step_has_limit(s) && rate > 0.0)
      step_level(m, s, s->start, s->dt, rate, 1);
  }
done:
  return st;
}

static void check_whole(const model *m, const char *what, int n, int all) {
  if (n > 0 && n < all)
    message_add(m->log, P2056, &m->ref.at,
                "*REFERENCE: %d of %d components of the %s", n, all, what);
}

/* Components of *REFERENCE to their places; of u and of the stresses all. */
static void check_reference(model *m) {
  closed_form *ref = &m->ref;
  int axi = m->n_section > 0 && m->sections[0].kin == AXISYMMETRIC;
  int n_u = 0, n_stress = 0;
  for (int i = 0; i < ref->n; ++i) {
    const reference_line *l = &ref->line[i];
    int at = reference_place(l->name, m->dim, axi);
    if (at < 0) {
      message_add(m->log, P2024, &l->at, "*REFERENCE: %s has no %s",
                  m->dim == 3 ? "a body in 3-D"
                  : axi       ? "an axisymmetric body"
                              : "a plane body",
                  l->name);
      continue;
    }
    ref->value[at] = l->value;
    n_u += at < REFERENCE_STRESS;
    n_stress += at >= REFERENCE_STRESS && at < REFERENCE_PRESSURE;
    ref->has_pressure |= at == REFERENCE_PRESSURE;
  }
  check_whole(m, "displacement", n_u, m->dim);
  check_whole(m, "stress", n_stress, m->ns);
  ref->has_u = n_u > 0;
  ref->has_stress = n_stress > 0;
}

/* Moduli over the temperature where there is none. */
static void check_moduli(const model *m) {
  for (int i = 0; i < m->n_material; ++i) {
    const material *mat = &m->materials[i];
    if (!mat->used || mat->elastic.n < 2 || (m->effects & EFFECT_THERMAL))
      continue;
    message_add(m->log, P2049, &mat->at,
                "material %s: *ELASTIC depends on temperature, but no "
                "temperature is given: its constants at 0 are taken",
                mat->name);
  }
}

status model_check(model *m, const mesh *msh) {
  status st = OK;
  m->dim = msh->dim;
  m->ns = msh->dim == 3 ? 6 : 4;
  check_kinematics(m, msh);
  check_radius(m, msh);
  TRY(check_sections(m, msh));
  check_locking(m);
  check_contacts(m, msh);
  check_laws(m);
  check_initials(m, msh);
  check_steps(m, msh);
  TRY(check_fields(m, msh));
  check_reference(m);
  TRY(model_find_corner(m, msh));
  model_find_effects(m);
  check_moduli(m);
  TRY(message_status(m->log, ERR_DECK));
  check_values(m, msh);
  for (int i = 0; i < m->n_step; ++i) TRY(check_agreement(m, msh, i));
  TRY(check_visco(m));
  TRY(message_status(m->log, ERR_DECK));
done:
  return st;
}
