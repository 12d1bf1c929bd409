/*
 * The model against the mesh: kinematics, sections, contacts, goals, pairs of
 * surfaces, and the parts in order.
 */
#include "base/base.h"
#include "mesh/crack/crack.h"
#include "model/cards/cards.h"
#include "model/check/parts.h"
#include "model/facts.h"

/* ---- *REFERENCE: components to their places ------------------------------ */

static void check_whole(const model *m, const char *what, int n, int all) {
  if (n > 0 && n < all)
    message_add(m->log, P2056, &m->accuracy.ref.at,
                "*REFERENCE: %d of %d components of the %s", n, all, what);
}

/* Components of *REFERENCE to their places; of u and of the stresses all. */
static void check_reference(model *m) {
  closed_form *ref = &m->accuracy.ref;
  const int axi = model_is_axisymmetric(m);
  int n_u = 0, n_stress = 0;
  for (EACH(const reference_line, l, ref->line, ref->n)) {
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

/* ---- Contacts, their obstacles and their friction laws against the mesh. - */

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
  if (!o->turns || dim == 3) return;
  if (model_is_axisymmetric(m))
    message_add(m->log, P2043, &m->moves[obstacle_id].rotate_at,
                "*OBSTACLE %s: an axisymmetric model has no displacement "
                "around its axis that could follow ROTATE",
                o->name);
  else if (o->axis[0] != 0.0 || o->axis[1] != 0.0)
    message_add(m->log, P2043, &m->moves[obstacle_id].rotate_at,
                "*OBSTACLE %s: the axis of ROTATE is (%g, %g, %g); in a plane "
                "model it is along z",
                o->name, o->axis[0], o->axis[1], o->axis[2]);
}

static void check_torque_axis(const model *m, int dim, const contact *c) {
  if (!c->has_axis || c->axis_of_obstacle || dim == 3) return;
  if (model_is_axisymmetric(m))
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
  if (rule->law == NULL || rule->law->misfit == NULL) return;
  const char *why =
      rule->law->misfit(rule->card.param, m->dim, model_is_axisymmetric(m));
  if (why != NULL)
    message_add(m->log, P2045, &rule->at, "*FRICTION, LAW=%s on contact %s: %s",
                rule->law->name, contact_name, why);
}

/* Points and directions of an obstacle in 3-D have three numbers; a sphere of
 * an axisymmetric model stays on the axis. */
static void check_obstacle_fields(const model *m, const mesh *msh, int id) {
  int off = facts_leaves_axis(m, id, 0.0);
  if (msh->dim == 3 && m->moves[id].short_at.file != NULL)
    message_add(m->log, P2009, &m->moves[id].short_at,
                "2 numbers on this line of *OBSTACLE; a mesh in 3-D needs 3");
  const obstacle *o = &m->obstacles[id];
  if (msh->dim == 2 && o->shape == OBSTACLE_PLANE &&
      fabs(o->direction[2]) >
          DBL_EPSILON * hypot(o->direction[0], o->direction[1]))
    message_add(m->log, P2025, &m->moves[id].at,
                "*OBSTACLE %s: the normal has a part along z, but the mesh is "
                "2-D",
                o->name);
  if (msh->dim == 2 && o->motion[2].formula == NULL &&
      o->motion[2].number != 0.0)
    message_add(m->log, P2025, &m->moves[id].move_at,
                "*OBSTACLE %s: MOVE along z, but the mesh is 2-D", o->name);
  for (int k = 0; k < m->n.step; ++k)
    if (facts_leaves_axis(m, id, step_end(&m->steps[k]))) off = 1;
  if (off)
    message_add(m->log, P4009, &m->moves[id].move_at,
                "*OBSTACLE %s: MOVE leads the sphere off the axis of symmetry",
                m->obstacles[id].name);
}

/* Groups, obstacles and their axes, torques. */
static void check_contacts(model *m, const mesh *msh) {
  for (int i = 0; i < m->n.contact; ++i) {
    contact *c = &m->contacts[i];
    if (c->is_pair) {
      check_torque_axis(m, msh->dim, c);
      continue;
    }
    c->group_id = check_group_of(m, msh, c->group, msh->dim - 1, &c->group_at);
    check_twice(m, i);
    if (c->obstacle_id < 0) continue;
    const obstacle *o = &m->obstacles[c->obstacle_id];
    int no_axis = o->direction[0] == 0.0 && o->direction[1] == 0.0 &&
                  o->direction[2] == 0.0;
    int first = 0;
    while (m->contacts[first].obstacle_id != c->obstacle_id) ++first;
    if (first == i) check_obstacle_fields(m, msh, c->obstacle_id);
    if (msh->dim == 3 && o->shape == OBSTACLE_CYLINDER && no_axis)
      message_add(m->log, P2007, &m->moves[c->obstacle_id].at,
                  "*OBSTACLE: a cylinder in 3-D needs a line with the "
                  "direction of its axis");
    check_turn(m, msh->dim, c->obstacle_id);
    check_torque_axis(m, msh->dim, c);
  }
}

static void check_kinematics(model *m, const mesh *msh) {
  for (EACH(section, s, m->sections, m->n.section)) {
    if (s->kin < 0) s->kin = msh->dim == 3 ? SOLID_3D : PLANE_STRAIN;
    if ((s->kin == SOLID_3D) != (msh->dim == 3))
      message_add(
          m->log, P2024, &s->at,
          "*SOLID SECTION: this TYPE does not fit a mesh in %d-D; expected %s",
          msh->dim,
          msh->dim == 3 ? "3D" : "PLANE STRAIN, PLANE STRESS or AXISYMMETRIC");
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
double model_locking_error(double nu, double n) {
  return 0.55 / (1.0 + 5.0 * (1.0 - 2.0 * nu) * n * n);
}

double model_locking_nu(const model *m, const section *s) {
  if (s->material_id < 0 || s->kin == PLANE_STRESS || s->averaged) return 0.0;
  const elastic_table *of = &m->materials[s->material_id].elastic;
  if (of->n == 0 || of->type != ELASTIC_ISO) return 0.0;
  const double nu = elastic_table_most(of, 1);
  return nu > 0.49 ? nu : 0.0;
}

static void check_locking(const model *m) {
  enum { COARSE = 16, FINE = 64 };
  for (EACH(const section, s, m->sections, m->n.section)) {
    const double nu = model_locking_nu(m, s);
    if (!(nu > 0.0)) continue;
    message_add(m->log, P2055, &s->at,
                "nu = %g of material %s: linear elements lock; expect "
                "displacements too small by some %.2g %% with %d elements "
                "across a wall, %.2g %% with %d",
                nu, m->materials[s->material_id].name,
                100.0 * model_locking_error(nu, COARSE), COARSE,
                100.0 * model_locking_error(nu, FINE), FINE);
  }
}

/* The radius x of an axisymmetric model is not negative. */
static void check_radius(const model *m, const mesh *msh) {
  static const double rounding = 1e-9; /* of the size of the mesh */
  if (!model_is_axisymmetric(m)) return;
  for (int i = 0; i < msh->n_node; ++i) {
    const double *x = msh->x + (size_t)msh->dim * i;
    if (x[0] >= -rounding * msh->size) continue;
    message_add(m->log, P2039, &m->sections[0].at,
                "axisymmetric, but node %zu is at radius x = %g",
                msh->node_no[i], x[0]);
    return;
  }
}

/* Each element in one section. */
static status check_sections(model *m, const mesh *msh) {
  OWNS(m);
  PASS_NEW(m->elem_section, msh->n_elem);
  for (int e = 0; e < msh->n_elem; ++e) m->elem_section[e] = -1;
  for (int i = 0; i < m->n.section; ++i) {
    section *s = &m->sections[i];
    s->group_id = check_group_of(m, msh, s->elset, msh->dim, &s->elset_at);
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
  if (message_count(m->log, ERROR) > 0) return OK;
  int missing = 0, first = -1;
  for (int e = 0; e < msh->n_elem; ++e)
    if (m->elem_section[e] < 0) {
      if (missing++ == 0) first = e;
    }
  if (missing > 0)
    message_add(m->log, P2023, &m->sections[0].at,
                "%d element%s, the first number %zu, without *SOLID SECTION",
                missing, missing == 1 ? "" : "s", msh->elem_no[first]);
  return OK;
}

/* Moduli over the temperature where there is none. */
static void check_moduli(const model *m) {
  for (EACH(const material, mat, m->materials, m->n.material)) {
    if (!mat->used || mat->elastic.n < 2 || (m->effects & EFFECT_THERMAL))
      continue;
    message_add(m->log, P2049, &mat->at,
                "material %s: *ELASTIC depends on temperature, but no "
                "temperature is given: its constants at 0 are taken",
                mat->name);
  }
}

/* STIFFNESS=FACTOR next to what needs the entries of the matrix. */
static void check_entries(const model *m) {
  for (EACH(const step, s, m->steps, m->n.step)) {
    const char *reads = facts_reads_entries(m, s);
    if (s->solver.stiffness != STIFFNESS_FACTOR || reads == NULL) continue;
    message_add(m->log, P2061, &s->solver_at,
                "*SOLVER, STIFFNESS=FACTOR: %s needs the entries of the "
                "condensed stiffness",
                reads);
    return;
  }
}

/* ---- the places of *GOAL ------------------------------------------------ */

static const double NEAR = 1e-6; /* -, of the size of the mesh */

static double distance_to(const mesh *msh, int node_id, const double *x) {
  double d = 0.0;
  for (int c = 0; c < msh->dim; ++c)
    d = hypot(d, msh->x[msh->dim * node_id + c] - x[c]);
  return d;
}

/* The node nearest to a point, and how far it is, m. */
static int nearest_node(const mesh *msh, const double *x, double *distance) {
  int best = -1;
  *distance = HUGE_VAL;
  for (int i = 0; i < msh->n_node; ++i) {
    const double d = distance_to(msh, i, x);
    if (d >= *distance) continue;
    *distance = d;
    best = i;
  }
  return best;
}

/* 1: a node of the lip above of a crack. */
static int is_above(const mesh *msh, int node_id) {
  for (int c = 0; c < msh->n_crack; ++c)
    for (int f = 0; f < msh->crack[c].n; ++f)
      for (int i = 0; i < msh->dim; ++i)
        if (mesh_face_nodes(msh, msh->crack[c].plus[f])[i] == node_id) return 1;
  return 0;
}

/* Of the nodes at one place, which the lips of a crack or bodies that touch
 * have, the one above, whatever their numbers are; else the first. */
static int choose_side(const model *m, const mesh *msh, const goal_card *g,
                       int k, int id) {
  int best = id, n = 0;
  for (int i = 0; i < msh->n_node; ++i) {
    if (distance_to(msh, i, msh->x + msh->dim * id) > NEAR * NEAR * msh->size)
      continue;
    ++n;
    if (is_above(msh, i) > is_above(msh, best)) best = i;
  }
  if (n > 1)
    message_add(m->log, P2068, &g->point_at[k],
                "*GOAL %s: %d nodes are at this point; node %zu counts%s",
                g->name, n, msh->node_no[best],
                is_above(msh, best) ? ", of the lip above" : "");
  return best;
}

/* The node of point k of a goal. */
static int find_point(const model *m, const mesh *msh, const goal_card *g,
                      int k) {
  double distance;
  const int id = nearest_node(msh, g->point[k], &distance);
  const double *x = msh->x + msh->dim * id;
  if (distance > NEAR * msh->size && g->quantity == GOAL_DISPLACEMENT)
    message_add(m->log, P2021, &g->point_at[k],
                "*GOAL %s: no node of the mesh is at this point, the nearest "
                "is %zu at (%g, %g, %g)%s",
                g->name, msh->node_no[id], x[0], x[1],
                msh->dim == 3 ? x[2] : msh->z,
                model_has_target(m) ? "; TARGET= meshes again: make it a "
                                      "Point of the .geo"
                                    : "");
  return g->quantity == GOAL_DISPLACEMENT ? choose_side(m, msh, g, k, id) : id;
}

/* The node of the front nearest to the point of a goal; P2021 if the point is
 * further from it than the next node is. */
static int find_front(const model *m, const mesh *msh, const goal_card *g) {
  const mesh_crack *c = &msh->crack[g->crack_id];
  const int dim = msh->dim, n = c->front_start[c->n_front];
  int best = -1;
  double least = HUGE_VAL, reach = NEAR * msh->size;
  for (int i = 0; i < n; ++i) {
    const double d = distance_to(msh, c->front_node[i], g->point[0]);
    if (d < least) best = i;
    least = fmin(d, least);
  }
  for (int i = best < 1 ? 0 : best - 1; dim == 3 && i <= best && i < n - 1; ++i)
    if (best >= 0 && c->front_face[i] >= 0)
      reach = fmax(reach, distance_to(msh, c->front_node[i],
                                      msh->x + dim * c->front_node[i + 1]));
  if (best >= 0 && least <= reach) return c->front_node[best];
  message_add(m->log, P2021, &g->point_at[0],
              "*GOAL %s: the front of *CRACK %s does not pass this point",
              g->name, m->mesh.cracks[g->crack_id].name);
  return -1;
}

/* 1: a mesh of this dimension has the component; in the plane moments turn
 * about z, and on an axis there are none. */
static int has_component(const model *m, const mesh *msh, const goal_card *g) {
  if (g->component - GOAL_TENSOR >= m->ns) return 0;
  if (g->component >= GOAL_NORMAL) return 1;
  if (g->quantity == GOAL_MOMENT && msh->dim == 2 && m->n.section > 0)
    return g->component == 2;
  return g->component < msh->dim;
}

/* The moment in the plane if none is given. */
static void check_moment(const model *m, const mesh *msh, goal_card *g) {
  if (g->quantity != GOAL_MOMENT || g->component != GOAL_NORMAL) return;
  g->component = 2;
  if (msh->dim == 3)
    message_add(m->log, P2007, &g->at,
                "*GOAL, QUANTITY=MOMENT needs COMPONENT= in space");
}

/* What axisymmetric bodies have none of; NULL: another goal. */
static const char *round_the_axis(const goal_card *g) {
  return g->quantity == GOAL_SIF      ? "stress intensity factors"
         : g->quantity == GOAL_MOMENT ? "moments"
                                      : NULL;
}

static void check_goal(const model *m, const mesh *msh, goal_card *g) {
  if (g->quantity == GOAL_SIF && g->crack_id < 0) return;
  check_moment(m, msh, g);
  if (g->n_point > 0)
    g->node_id = g->quantity == GOAL_SIF ? find_front(m, msh, g)
                                         : find_point(m, msh, g, 0);
  if (g->n_point > 1) g->from_node_id = find_point(m, msh, g, 1);
  if (g->from != NULL) g->from_id = check_group(m, msh, g->from, &g->from_at);
  if (g->group != NULL && g->quantity == GOAL_STRESS)
    g->group_id = check_group_of(m, msh, g->group, msh->dim, &g->group_at);
  else if (g->group != NULL)
    g->group_id = check_group(m, msh, g->group, &g->group_at);
  if (model_is_axisymmetric(m) && round_the_axis(g) != NULL)
    message_add(m->log, P2024, &g->at,
                "*GOAL %s: there are no %s of axisymmetric bodies", g->name,
                round_the_axis(g));
  else if (!has_component(m, msh, g))
    message_add(m->log, P2024, &g->at,
                "*GOAL %s: a mesh in %d-D has no such component", g->name,
                msh->dim);
}

/* ---- surfaces of *CONTACT PAIR and *TIE, and which is the slave --------- */

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
  unsigned all;   /* bit c: supports hold component c of all nodes */
} surface_facts;

/* C_nnnn, the modulus of uniaxial strain, in the mean over all directions n:
 * (C_iijj + 2 C_ijij)/15, the same in any axes (Voigt 1889), Pa. */
static double mean_modulus(const double C[36]) {
  double sum = 0.0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) sum += C[i + 6 * j];
    sum += 2.0 * C[7 * i] + 4.0 * C[7 * (3 + i)];
  }
  return sum / 15.0;
}

/* Bit c: supports hold component c of a node. */
static unsigned held_bits(const mesh *msh, const unsigned char *fixed,
                          int node_id) {
  unsigned bits = 0;
  for (int c = 0; c < msh->dim; ++c)
    bits |= (fixed[msh->dim * node_id + c] != 0) << c;
  return bits;
}

static surface_facts facts_of(const model *m, const mesh *msh,
                              const unsigned char *fixed, int group_id) {
  const mesh_group *g = &msh->group[group_id];
  surface_facts f = {.all = (1u << msh->dim) - 1};
  double area = 0.0, normal[3];
  for (int k = 0; k < g->n_item; ++k) {
    const int face = g->item_id[k];
    const section *s = &m->sections[m->elem_section[msh->face_elem[face]]];
    area += mesh_face_normal(msh, face, normal) / g->n_item;
    f.modulus += mean_modulus(m->materials[s->material_id].C) / g->n_item;
  }
  f.size = msh->dim == 2 ? area : sqrt(area);
  for (int k = 0; k < g->n_node; ++k)
    f.all &= held_bits(msh, fixed, g->node_id[k]);
  return f;
}

/* 1: a has all bits of b and more; -1: the other way. */
static int has_more(unsigned a, unsigned b) {
  if (a == b) return 0;
  return (a & b) == b ? 1 : (a & b) == a ? -1 : 0;
}

/* Nodes of which supports hold a component that they do not hold of the other
 * surface there: of its node next to it, no further than "near". */
static int held_alone(const mesh *msh, const unsigned char *fixed,
                      const mesh_group *of, const mesh_group *other,
                      double near) {
  int n = 0;
  for (int i = 0; i < of->n_node; ++i) {
    const unsigned own = held_bits(msh, fixed, of->node_id[i]);
    const double *x = &msh->x[(size_t)msh->dim * of->node_id[i]];
    double least = near;
    int best = -1;
    for (int k = 0; own != 0 && k < other->n_node; ++k) {
      const double d = distance_to(msh, other->node_id[k], x);
      if (d <= least) best = other->node_id[k], least = d;
    }
    n += best >= 0 && (own & ~held_bits(msh, fixed, best)) != 0;
  }
  return n;
}

/* Supports hold more of the first surface, 1, or of the second, -1: what they
 * hold of a slave is relative to its place, not to the master. */
static int held_more(const mesh *msh, const unsigned char *fixed,
                     const int *group, const surface_facts *f) {
  const double near = fmax(f[0].size, f[1].size);
  const mesh_group *a = &msh->group[group[0]], *b = &msh->group[group[1]];
  const int all = has_more(f[0].all, f[1].all);
  if (all != 0) return all;
  const int more =
      held_alone(msh, fixed, a, b, near) - held_alone(msh, fixed, b, a, near);
  return (more > 0) - (more < 0);
}

/* touching: of a tie, 1 where it meets a contact. */
static void choose(const model *m, const mesh *msh, const unsigned char *fixed,
                   const int *group, int touching, surface_pair *p) {
  surface_facts f[2];
  for (int k = 0; k < 2; ++k) f[k] = facts_of(m, msh, fixed, group[k]);
  const double ratio = f[1].modulus / f[0].modulus;
  const int held =
      p->choice == SLAVE_AUTO ? held_more(msh, fixed, group, f) : 0;
  const int differ = fabs(f[1].size - f[0].size) > rounding * f[0].size;
  const char *why = "of equal size: the first";
  p->slave = 0;
  if (p->choice != SLAVE_AUTO) {
    p->slave = p->choice == SLAVE_SECOND;
    why = "by SLAVE=";
  } else if (held != 0) {
    p->slave = held > 0;
    why = "the other is held";
  } else if (touching && differ) {
    p->slave = f[1].size < f[0].size;
    why = "finer, at a contact";
  } else if (fmax(ratio, 1.0 / ratio) >= stiff_ratio * (1.0 - rounding)) {
    p->slave = ratio < 1.0;
    why = "softer";
  } else if (differ) {
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
  OWNED_NEW(unsigned char, seen, msh->n_face);
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

static void refuse_same(const model *m, const pair_card *of,
                        const surface_pair *a, const surface_pair *b,
                        const char *name) {
  if (a->slave_id + a->master_id == b->slave_id + b->master_id &&
      (a->slave_id == b->slave_id || a->slave_id == b->master_id))
    message_add(m->log, P2011, of->at, "*%s %s has the surfaces of *%s %s",
                of->card, of->name, of->card, name);
}

static status check_contact_pair(model *m, const mesh *msh,
                                 const unsigned char *fixed, int id) {
  contact *c = &m->contacts[id];
  const pair_card of = {"CONTACT PAIR", c->name, &c->at};
  int group[2] = {-1, -1};
  if (!c->is_pair) return OK;
  PASS(check_surfaces(m, msh, &of, &c->pair, group));
  if (is_lost(m)) return OK;
  choose(m, msh, fixed, group, 0, &c->pair);
  c->group_id = c->pair.slave_id;
  c->group = msh->group[c->group_id].name;
  c->obstacle_name = msh->group[c->pair.master_id].name;
  for (EACH(const contact, old, m->contacts, id))
    if (old->is_pair) refuse_same(m, &of, &c->pair, &old->pair, old->name);
  return OK;
}

status model_open_cracks(model *m, mesh *msh) {
  const int n = m->n.crack;
  if (n == 0 || msh->n_crack > 0) return OK;
  OWNED_NEW(mesh_cut, cut, n);
  for (int i = 0; i < n; ++i) {
    crack *k = &m->mesh.cracks[i];
    const int id = check_group(m, msh, k->group, &k->group_at);
    if (id < 0) return message_status(m->log, ERR_DECK);
    cut[i] = (mesh_cut){&msh->group[id], &k->group_at};
  }
  OWNS(msh);
  PASS_NEW(msh->crack, n);
  msh->n_crack = n;
  return mesh_open(msh, n, cut, m->log, msh->crack);
}

/* 1: a surface of a tie has a node of a contact, whose forces at the joint need
 * the finer side as slave (P4035). */
static int meets_contact(const mesh *msh, const int *group,
                         const unsigned char *touches) {
  for (int k = 0; k < 2; ++k)
    for (int i = 0; i < msh->group[group[k]].n_node; ++i)
      if (touches[msh->group[group[k]].node_id[i]]) return 1;
  return 0;
}

static void mark_nodes(const mesh_group *g, unsigned char *touches) {
  for (int i = 0; i < g->n_node; ++i) touches[g->node_id[i]] = 1;
}

static status check_ties(model *m, const mesh *msh,
                         const unsigned char *fixed) {
  if (m->n.tie == 0) return OK;
  OWNED_NEW(unsigned char, touches, msh->n_node);
  for (int i = 0; i < m->n.contact && !is_lost(m); ++i) {
    const contact *c = &m->contacts[i];
    mark_nodes(&msh->group[c->group_id], touches);
    if (c->is_pair) mark_nodes(&msh->group[c->pair.master_id], touches);
  }
  for (EACH(tie, t, m->ties, m->n.tie)) {
    const pair_card of = {"TIE", t->name, &t->at};
    int group[2] = {-1, -1};
    PASS(check_surfaces(m, msh, &of, &t->pair, group));
    if (is_lost(m)) continue;
    choose(m, msh, fixed, group, meets_contact(msh, group, touches), &t->pair);
    for (const tie *old = m->ties; old < t; ++old)
      refuse_same(m, &of, &t->pair, &old->pair, old->name);
  }
  return OK;
}

static status check_pairs(model *m, const mesh *msh) {
  if (!model_has_pairs(m)) return OK;
  OWNED_NEW(unsigned char, fixed, (size_t)msh->dim * msh->n_node);
  if (!is_lost(m) && m->n.step > 0) load_fixed(msh, &m->steps[0], fixed);
  for (int i = 0; i < m->n.contact; ++i)
    PASS(check_contact_pair(m, msh, fixed, i));
  return check_ties(m, msh, fixed);
}

/* What the layout of FCLIB has in the place of a contact, or NULL. */
static const char *other_layout(const model *m, int step_id, int contact_id) {
  const friction_rule *rule = friction_in_force(m, step_id, contact_id);
  if (m->contacts[contact_id].force.given)
    return "unilateral contact only, no given forces";
  if (rule_has_average(rule))
    return "friction of each node by itself only, no average";
  if (rule_has_friction(rule) && rule->law != &coulomb_friction)
    return "Coulomb friction only, no given sliding limit";
  return m->mesh.corner_id == contact_id
             ? "nodes that touch one obstacle only, not those of two contacts"
             : NULL;
}

/* Condensed problems, which are written from the first step on that has one. */
static void check_condensed(const model *m) {
  for (int i = 0; i < m->n.step; ++i)
    for (int k = 0; k < m->n.contact; ++k) {
      const char *why = other_layout(m, i, k);
      if (m->steps[i].output.condensed < 0 || why == NULL) continue;
      message_add(m->log, P2064, &m->steps[i].output.at,
                  "*OUTPUT, CONDENSED=FCLIB: contact %s: the layout has %s",
                  m->contacts[k].name, why);
      return;
    }
}

#define OF_GOALS "the error of a goal"

static void refuse_target(const model *m, const place *at, const char *with,
                          const char *error) {
  message_add(m->log, P2066, at,
              "%s: TARGET= cannot be reached, for there is no estimate of %s "
              "with it",
              with, error);
}

/* What goals on a contact have no estimate with, or NULL; *at. */
static const char *without_estimate(const model *m, const mesh *msh, int id,
                                    const place **at) {
  const contact *c = &m->contacts[id];
  *at = c->force.given ? &c->force.at : &c->at;
  if (c->force.given) return "*CONTACT FORCE";
  if (c->is_crack)
    return model_is_interface(m, msh, id) ? "*CRACK between two materials"
                                          : NULL;
  if (c->is_pair) return "*CONTACT PAIR";
  return m->mesh.corner_id == id ? "*CONTACT with nodes of another one" : NULL;
}

static void check_sections_of_goals(const model *m) {
  for (EACH(const section, s, m->sections, m->n.section))
    if (s->averaged && s->kin != PLANE_STRESS)
      refuse_target(m, &s->at, "FORMULATION=AVERAGED", OF_GOALS);
  if (facts_has_inelastic(m))
    refuse_target(m, &m->materials[facts_first_inelastic(m)->material_id].at,
                  "inelastic strain", OF_GOALS);
}

/* Targets that no mesh can reach: their error has no estimate. */
static void check_targets(const model *m, const mesh *msh) {
  const effect_card *worn = model_effect_card(m, "WEAR", -1);
  if (worn != NULL && model_has_target(m))
    refuse_target(m, &worn->at, "*WEAR", "the error");
  if (model_targeted_goal(m) == NULL) return;
  for (int i = 0; i < m->n.tie; ++i)
    refuse_target(m, &m->ties[i].at, "*TIE", OF_GOALS);
  for (int i = 0; i < m->n.contact; ++i) {
    const place *at;
    const char *with = without_estimate(m, msh, i, &at);
    if (with != NULL) refuse_target(m, at, with, OF_GOALS);
  }
  check_sections_of_goals(m);
  for (EACH(const goal_card, g, m->accuracy.goals, m->n.goal))
    if (g->target > 0.0 && g->quantity == GOAL_WIDTH && msh->dim == 3)
      refuse_target(m, &g->at, "QUANTITY=WIDTH in space", OF_GOALS);
}

status model_check(model *m, const mesh *msh, effect_finder *find) {
  m->dim = msh->dim;
  m->ns = msh->dim == 3 ? 6 : 4;
  check_kinematics(m, msh);
  check_radius(m, msh);
  PASS(check_sections(m, msh));
  check_locking(m);
  check_contacts(m, msh);
  /* Options of friction laws that are not for every model. */
  for (int i = 0; i < m->n.contact; ++i)
    check_law(m, m->contacts[i].name, &m->contacts[i].friction);
  for (int k = 0; k < m->n.step; ++k)
    for (EACH(const friction_change, f, m->steps[k].friction.changes,
              m->steps[k].friction.n))
      check_law(m, m->contacts[f->contact_id].name, &f->rule);
  check_initials(m, msh);
  check_steps(m, msh);
  PASS(check_pairs(m, msh));
  PASS(check_fields(m, msh));
  PASS(check_start_file(m));
  check_reference(m);
  for (int i = 0; i < m->n.goal; ++i) check_goal(m, msh, &m->accuracy.goals[i]);
  PASS(model_find_corner(m, msh));
  m->effects = find(m);
  check_targets(m, msh);
  check_moduli(m);
  check_entries(m);
  check_condensed(m);
  PASS(message_status(m->log, ERR_DECK));
  check_values(m, msh);
  check_no_effect(m, msh);
  for (int i = 0; i < m->n.step; ++i) PASS(check_agreement(m, msh, i));
  PASS(check_visco(m));
  return message_status(m->log, ERR_DECK);
}
