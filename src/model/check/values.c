/*
 * Values: loads and initial conditions against the mesh, expressions that give
 * numbers where steps begin and end, supports that agree where groups meet;
 * input without effect; increments of *VISCO steps against the laws.
 */
#include "base/base.h"
#include "model/check/parts.h"

/* ---- names of groups to their ids in the mesh ---------------------------- */

/* The lip that is meant by the name of a *CRACK with a sign; NULL: none. */
static const char *lip_meant(const model *m, const char *name) {
  for (EACH(const crack, k, m->mesh.cracks, m->n.crack)) {
    const size_t n = strlen(k->name);
    if (strncmp(name, k->name, n) != 0) continue;
    if (strcmp(name + n, "-") == 0) return k->lip[0];
    if (strcmp(name + n, "+") == 0) return k->lip[1];
  }
  return NULL;
}

int check_group(const model *m, const mesh *msh, const char *name,
                const place *at) {
  const mesh_group *g = mesh_find_group(msh, name);
  if (g != NULL) return (int)(g - msh->group);
  const char *near = lip_meant(m, name);
  if (near == NULL && message_wanted(m->log))
    near = mesh_nearest_group(msh, name);
  if (near != NULL) {
    message_add(m->log, P2021, at, "the mesh has no group %s; did you mean %s?",
                name, near);
    return -1;
  }
  char all[400] = "";
  size_t n = 0;
  for (int i = 0; i < msh->n_group && n < sizeof all / 2; ++i)
    n += snprintf(all + n, sizeof all - n, "%s%.60s", i == 0 ? "" : ", ",
                  msh->group[i].name);
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
  const int on_faces = l->kind == LOAD_PRESSURE || l->kind == LOAD_TRACTION;
  if (l->kind == LOAD_POINT || l->kind == LOAD_FIXING)
    return check_group(m, msh, l->group, &l->at);
  return check_group_of(m, msh, l->group, msh->dim - on_faces, &l->at);
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

/* An earlier line gives the same another value. */
static void check_repeated(const model *m, const initial *c) {
  for (const initial *o = m->initial.lines; o < c; ++o)
    if (o->type == c->type && o->component == c->component &&
        strcmp(o->group, c->group) == 0 &&
        (o->value.formula != c->value.formula ||
         o->value.number != c->value.number))
      message_add(m->log, P2040, &o->at,
                  "line %d of *INITIAL CONDITIONS gives group %s another "
                  "value, which counts",
                  c->at.line_no, c->group);
}

void check_initials(model *m, const mesh *msh) {
  for (EACH(initial, c, m->initial.lines, m->n.initial)) {
    check_repeated(m, c);
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

/* The field of a file, read once; NULL after a message. */
static status find_field(model *m, const mesh *msh, const char *file,
                         const place *at, const double **out) {
  *out = NULL;
  if (file == NULL) return OK;
  for (int i = 0; i < m->n.field && *out == NULL; ++i)
    if (strcmp(m->load.fields[i].file, file) == 0)
      *out = m->load.fields[i].value;
  if (*out != NULL) return OK;
  OWNS(m);
  PASS_GROW(m->load.fields, m->n.field, m->cap.field);
  nodal_field *f = &m->load.fields[m->n.field];
  const status st = nodal_field_read(file, msh, m->mesh.scale, &f->value);
  if (st == ERR_FILE || st == ERR_DECK) {
    message_add(m->log, P2053, at, "%s", status_message());
    return st == ERR_FILE ? st : OK;
  }
  PASS(st);
  f->file = file;
  *out = f->value;
  ++m->n.field;
  return OK;
}

status check_fields(model *m, const mesh *msh) {
  for (int i = 0; i < m->n.step; ++i)
    for (EACH(load, l, m->steps[i].loads.item, m->steps[i].loads.n))
      PASS(find_field(m, msh, l->file, &l->file_at, &l->field));
  return OK;
}

/* 1 if an earlier step has this load from the same line: checked there. */
static int checked_before(const model *m, int step_id, load *l) {
  for (int i = 0; i < step_id; ++i)
    for (EACH(const load, old, m->steps[i].loads.item, m->steps[i].loads.n)) {
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
    for (EACH(print_request, p, s->print.requests, s->print.n)) {
      if (p->group == NULL) continue;
      p->group_id = p->table == PRINT_ELEMENTS
                        ? check_group_of(m, msh, p->group, msh->dim, &p->at)
                        : check_group(m, msh, p->group, &p->at);
    }
  }
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
    size_t node = g->node_id[k], dim = msh->dim;
    COPY(x, msh->x + dim * node, dim);
    double value = quantity_value(v.value, x, t);
    if (value >= 0.0 && value <= NUMBER_MOST) continue;
    message_add(m->log, P2041, v.at,
                "*%s: %s is %s at node %zu (%g, %g, %g), time %g", v.card,
                v.name,
                isnan(value)   ? "not a number"
                : value < 0.0  ? "negative"
                : isinf(value) ? "infinite"
                               : "too large, above 3e144,",
                msh->node_no[node], x[0], x[1], x[2], t);
    return 0;
  }
  return 1;
}

static void check_contact_values(const model *m, const mesh *msh, int id) {
  const contact *c = &m->contacts[id];
  int good = 1, fine = 1, sound = 1;
  for (int k = 0; k < m->n.step; ++k) {
    double t = step_end(&m->steps[k]);
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
    double t = step_end(&m->steps[k]), tilt = obstacle_tilt(o, t);
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
      good = motion_finite(m, i, step_end(&m->steps[k]));
    if (good) check_tilt(m, i);
  }
  for (int i = 0; i < m->n.contact; ++i) check_contact_values(m, msh, i);
  for (int i = 0; i < m->n.step; ++i)
    for (int k = 0; k < m->steps[i].loads.n; ++k)
      if (m->steps[i].loads.item[k].run != RUN_HELD)
        load_finite(m, msh, &m->steps[i], &m->steps[i].loads.item[k],
                    step_end(&m->steps[i]));
}

status check_agreement(const model *m, const mesh *msh, int step_id) {
  const step *s = &m->steps[step_id];
  size_t n_dof = (size_t)msh->dim * msh->n_node;
  OWNED_NEW(int, owner, n_dof);
  OWNED_NEW(double, ud, n_dof);
  for (int i = 0; i < s->loads.n; ++i) {
    const load *l = &s->loads.item[i];
    const mesh_group *g = &msh->group[l->group_id];
    int reported = 0;
    for (int k = 0; k < g->n_node && l->kind == LOAD_FIXING; ++k) {
      size_t node = g->node_id[k];
      size_t dof = msh->dim * node + l->component;
      double value = load_at_node(l, msh, s, (int)node, step_end(s));
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

/* ---- input without effect is seldom intended ---------------------------- */

/* 1 if the temperature changes something of the material. */
static int feels_heat(const material *mat) {
  return mat->expand.given || mat->elastic.n > 1 ||
         (mat->law.ops != NULL &&
          (law_varies(&mat->law) & LAW_VARIES_TEMPERATURE));
}

/* Data of a material over temperature where no temperature is given. */
static void check_material(const model *m, const material *mat) {
  if (!mat->used || (m->effects & EFFECT_THERMAL)) return;
  if (mat->expand.given)
    message_add(m->log, P2058, &mat->at,
                "material %s: *EXPANSION does nothing, as no temperature is "
                "given",
                mat->name);
  if (mat->law.ops != NULL &&
      (law_varies(&mat->law) & LAW_VARIES_TEMPERATURE) != 0)
    message_add(m->log, P2049, &mat->at,
                "material %s: its law depends on temperature, but no "
                "temperature is given: what it is at 0 is taken",
                mat->name);
}

/* A step in which strains could flow. */
static void check_flow(const model *m, const step *s) {
  if (s->kind != STEP_VISCO) return;
  for (int i = 0; i < m->n.material; ++i)
    if (m->materials[i].used && m->materials[i].law.ops != NULL) return;
  message_add(m->log, P2058, &s->at,
              "*VISCO: no material has a law that flows; the step is "
              "*QUASISTATIC");
}

/* 1 if some element of a group depends on the temperature. */
static int group_feels_heat(const model *m, const mesh_group *g) {
  for (int k = 0; k < g->n_item; ++k) {
    const section *s = &m->sections[m->elem_section[g->item_id[k]]];
    if (feels_heat(&m->materials[s->material_id])) return 1;
  }
  return 0;
}

/* A temperature that a card gives to a group. */
static void check_heat(const model *m, const mesh *msh, const char *name,
                       int group_id, const place *at) {
  if (group_id < 0 || group_feels_heat(m, &msh->group[group_id])) return;
  message_add(m->log, P2058, at,
              "*%s on group %s does nothing: no material there has "
              "*EXPANSION, *TRS or moduli over temperature",
              name, msh->group[group_id].name);
}

/* z is zero in the plane, whatever the mesh has. */
static void check_z(const model *m, const mesh *msh, const quantity *q,
                    const char *name, const place *at) {
  if (msh->dim == 3 || (quantity_variables(q) & 4u) == 0) return;
  message_add(
      m->log, P2058, at,
      "*%s: the value depends on z, which is the same everywhere in 2-D", name);
}

/* On the axis u_r = 0, or the hoop strain u_r/r is without limit. */
static void check_axis(const model *m, const mesh *msh, const step *s,
                       const load *l) {
  static const double rounding = 1e-9; /* of the size of the mesh */
  if (l->kind != LOAD_FIXING || l->component != 0 || l->group_id < 0) return;
  const mesh_group *g = &msh->group[l->group_id];
  for (int k = 0; k < g->n_node; ++k) {
    int node = g->node_id[k];
    if (msh->x[(size_t)msh->dim * node] > rounding * msh->size) continue;
    double u = load_at_node(l, msh, s, node, step_end(s));
    if (u == 0.0) continue;
    message_add(m->log, P2059, &l->at,
                "*BOUNDARY: u_r = %g at node %zu on the axis of symmetry", u,
                msh->node_no[node]);
    return;
  }
}

/* 1: an increment may end at time t of the step, counted from "first" on, or
 * pass it; at its start where the state jumps there. */
static int is_reached(const model *m, const step *s, double first, double t) {
  const double rounding = 1e-12 * (fabs(s->start) + s->total);
  const int jumps =
      s->kind == STEP_VISCO || (s == m->steps && m->initial.start.given);
  if (fabs(t - first) <= rounding) return jumps;
  return fabs(t - first - s->total) <= rounding ||
         (s->kind != STEP_STATIC && t > first && t < first + s->total);
}

/* 1 if a step that prints at these times reaches one. */
static int is_printed(const model *m, const time_points *p, double t) {
  for (EACH(const step, s, m->steps, m->n.step)) {
    if (!is_reached(m, s, p->total_time ? s->start : 0.0, t)) continue;
    for (int k = 0; k < s->print.n; ++k)
      if (s->print.requests[k].points == p) return 1;
  }
  return 0;
}

static void check_times(const model *m, const time_points *p) {
  int missed = 0, first = -1;
  if (!p->used) return;
  for (int i = 0; i < p->n; ++i) {
    if (is_printed(m, p, p->t[i])) continue;
    if (missed++ == 0) first = i;
  }
  if (missed > 0)
    message_add(m->log, P2058, &p->at,
                "*TIME POINTS, NAME=%s: %d of %d times, the first %g, that no "
                "increment of a step with these tables ends at or passes",
                p->name, missed, p->n, p->t[first]);
}

static void check_friction(const model *m, const mesh *msh,
                           const friction_rule *rule) {
  if (rule->law == NULL) return;
  check_z(m, msh, &rule->card.value, "FRICTION", &rule->value_at);
  if (rule->law->value_name != NULL && !rule_has_friction(rule))
    message_add(m->log, P2058, &rule->value_at,
                "*FRICTION, LAW=%s: %s = 0 is no friction", rule->law->name,
                rule->law->value_name);
}

static void check_contact(const model *m, const mesh *msh, const contact *c) {
  check_friction(m, msh, &c->friction);
  if (c->force.given)
    check_z(m, msh, &c->force.value, "CONTACT FORCE", &c->force.value_at);
  if (c->change.given)
    check_z(m, msh, &c->change.value, "CONTACT PAIR", &c->change.at);
}

static void check_tables(const model *m, const step *s) {
  const effect_card *wear = model_effect_card(m, "WEAR", -1);
  if (wear != NULL && s->accuracy.time_balanced)
    message_add(m->log, P2058, &s->accuracy.at,
                "*ACCURACY, TIME=BALANCED: the increments stay those of the "
                "step, as their error under *WEAR, line %d, is not known",
                wear->at.line_no);
  const struct {
    int table, empty;
    const char *why;
  } row[] = {{PRINT_WEAR, wear == NULL, "WEAR: no contact has *WEAR"},
             {PRINT_GOALS, m->n.goal == 0, "GOALS: there is no *GOAL"},
             {PRINT_SIF, m->n.crack == 0, "SIF: there is no *CRACK"},
             {PRINT_SIF, m->n.crack > 0 && model_is_axisymmetric(m),
              "SIF: there are no factors of axisymmetric bodies"}};
  for (EACH(const print_request, p, s->print.requests, s->print.n))
    for (size_t i = 0; i < sizeof row / sizeof *row; ++i)
      if (p->table == row[i].table && row[i].empty)
        message_add(m->log, P2058, &p->at, "*PRINT, %s", row[i].why);
}

void check_no_effect(const model *m, const mesh *msh) {
  for (int i = 0; i < m->n.points; ++i) check_times(m, &m->time.points[i]);
  for (int i = 0; i < m->n.material; ++i) check_material(m, &m->materials[i]);
  for (int i = 0; i < m->n.initial; ++i)
    if (m->initial.lines[i].type == INITIAL_TEMPERATURE)
      check_heat(m, msh, "INITIAL CONDITIONS", m->initial.lines[i].group_id,
                 &m->initial.lines[i].at);
  for (int i = 0; i < m->n.contact; ++i) check_contact(m, msh, &m->contacts[i]);
  for (EACH(const step, s, m->steps, m->n.step)) {
    check_flow(m, s);
    check_tables(m, s);
    for (int k = 0; k < s->friction.n; ++k)
      check_friction(m, msh, &s->friction.changes[k].rule);
    for (EACH(const load, l, s->loads.item, s->loads.n)) {
      if (l->removed) continue;
      if (l->kind == LOAD_TEMPERATURE)
        check_heat(m, msh, "TEMPERATURE", l->group_id, &l->at);
      check_z(m, msh, &l->value, load_card(l), &l->at);
      if (model_is_axisymmetric(m)) check_axis(m, msh, s, l);
    }
  }
}

/* ---- increments of *VISCO steps: stability, ringing, locking ------------- */

int step_has_limit(const step *s) {
  return !s->visco.integrator->linear_only && s->visco.theta < 1.0;
}

/* THETA < 1 turns the sign of what is much faster than dt at each step. */
static void report_ringing(const model *m, const step *s, double t, double dt,
                           double rate) {
  double theta = s->visco.theta, z = rate * dt;
  if (s->visco.integrator->limit > 0.0 || (1.0 - theta) * z <= 1.0) return;
  message_add(m->log, P2051, &s->at,
              "step %d, time %g: dt = %.6g is %.4g times the shortest "
              "relaxation time: THETA = %g multiplies what relaxes so fast by "
              "%.4f at each increment",
              (int)(s - m->steps) + 1, t, dt, z, theta,
              (1.0 - (1.0 - theta) * z) / (1.0 + theta * z));
}

/* Ends of increments are sums: dt is known to the rounding of the time. */
static double rounding_of(double t, double dt) {
  return 4e-16 * (fabs(t) + dt);
}

double step_fastest(const step *s, double t, double dt) {
  const double least = dt - 2.0 * rounding_of(t, dt);
  const double limit = scheme_limit(s->visco.integrator, s->visco.theta);
  return least > 0.0 ? limit / least : HUGE_VAL;
}

int step_level(const model *m, const step *s, double t, double dt, double rate,
               int notify) {
  enum { DEEPEST = 30 };
  int level = 0;
  double limit = scheme_limit(s->visco.integrator, s->visco.theta) / rate;
  double rounding = rounding_of(t, dt);
  if (notify) report_ringing(m, s, t, dt, rate);
  if (!(limit > 0.0)) {
    message_add(m->log, P2050, &s->at,
                "step %d, time %g: %s is stable with no dt: the rates of the "
                "laws at these stresses leave the range of the numbers; give "
                "INTEGRATOR=BACKWARD, or smaller loads and increments before",
                (int)(s - m->steps) + 1, t, s->visco.integrator->name);
    return -1;
  }
  while (ldexp(dt, -level) > limit + rounding && level < DEEPEST) ++level;
  if (level == 0 || (s->visco.substeps && level < DEEPEST)) return level;
  message_add(m->log, P2050, &s->at,
              "step %d, time %g: %s is stable up to dt = %.9g (fastest rate "
              "%.9g), not with dt = %.9g%s; give a smaller dt, %sor "
              "INTEGRATOR=BACKWARD",
              (int)(s - m->steps) + 1, t, s->visco.integrator->name, limit,
              rate, dt, s->visco.substeps ? ", nor in 2^29 parts of it" : "",
              s->visco.substeps ? "" : "SUBSTEPS=AUTO, ");
  return -1;
}

static int is_constant(const material *mat) {
  return mat->law.ops->linear && law_varies(&mat->law) == 0 &&
         mat->elastic.n == 1;
}

/* Laws of the bodies under an integrator that is exact for constant ones. */
static void check_exact(const model *m, int step_id) {
  const step *s = &m->steps[step_id];
  for (int i = 0; i < m->n.section; ++i) {
    const material *mat = &m->materials[m->sections[i].material_id];
    const law_card *law = &mat->law;
    if (law->ops == NULL || is_constant(mat)) continue;
    message_add(m->log, P2054, &s->at,
                "step %d: INTEGRATOR=%s, but %s of material %s %s", step_id + 1,
                s->visco.integrator->name, law->ops->name, mat->name,
                !law->ops->linear ? "is not linear"
                : law_varies(law) & LAW_VARIES_TIME
                    ? "has coefficients that vary in time"
                : law_varies(law) != 0 ? "depends on temperature"
                                       : "has moduli that do");
  }
}

/* The fastest rate of the laws whose Jacobian is the same for ever, 1/s. */
static status constant_rate(const model *m, double *fastest) {
  static const double zero[6];
  ENDS_BY(law_sample_free) law_sample x = {0};
  *fastest = 0.0;
  for (int i = 0; i < m->n.section; ++i) {
    const material *mat = &m->materials[m->sections[i].material_id];
    double rate;
    if (mat->law.ops == NULL || !is_constant(mat)) continue;
    PASS(law_sample_at(&mat->elastic, &mat->law, (kinematics)m->sections[i].kin,
                       0.0, &x));
    x.p.sigma = zero;
    PASS(law_fastest_rate(&x.p, &rate));
    *fastest = fmax(*fastest, rate);
  }
  return OK;
}

/* 1: a mean stress alone makes nothing flow, as far as a shear does. */
static status keeps_volume(const section *s, const material *mat, int *answer) {
  double alpha_rate[FLOW_VALUE_MAX], ei_rate[6];
  ENDS_BY(law_sample_free) law_sample x = {0};
  PASS(law_sample_at(&mat->elastic, &mat->law, (kinematics)s->kin, 0.0, &x));
  const double size = 1e-3 * x.kind.elastic.young;
  const double mean[6] = {size, size, size}, shear[6] = {0, 0, 0, size};
  x.p.speed = 1.0; /* whatever the temperature */
  x.p.sigma = mean;
  law_rate(&x.p, ei_rate, alpha_rate);
  double swelling = fabs(tensor_trace(ei_rate));
  x.p.sigma = shear;
  law_rate(&x.p, ei_rate, alpha_rate);
  *answer = swelling <= 1e-9 * fabs(ei_rate[3]);
  return OK;
}

/* Bodies that creep at constant volume become incompressible. */
static status check_creep(const model *m) {
  for (EACH(const section, s, m->sections, m->n.section)) {
    const material *mat = &m->materials[s->material_id];
    int locks = 0;
    if (mat->law.ops == NULL || s->kin == PLANE_STRESS || s->averaged) continue;
    PASS(keeps_volume(s, mat, &locks));
    if (locks)
      message_add(m->log, P2055, &s->at,
                  "law %s of material %s creeps at constant volume: where its "
                  "strains outgrow the elastic ones, linear elements lock",
                  mat->law.ops->name, mat->name);
  }
  return OK;
}

status check_visco(const model *m) {
  double rate;
  if (!(m->effects & EFFECT_INELASTIC)) return OK;
  PASS(constant_rate(m, &rate));
  if (has_card(m, "VISCO")) PASS(check_creep(m));
  for (int i = 0; i < m->n.step; ++i) {
    const step *s = &m->steps[i];
    if (s->kind != STEP_VISCO) continue;
    if (s->visco.integrator->linear_only) check_exact(m, i);
    if (step_has_limit(s) && rate > 0.0)
      step_level(m, s, s->start, s->dt, rate, 1);
  }
  return OK;
}
