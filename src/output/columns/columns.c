/*
 * The columns one after another, which of them a model and a state have, their
 * units; those with one value an increment; tables as text.
 */
#include "output/columns/columns.h"

#include "base/base.h"
#include "effects/rows.h"
#include "run/column_row.h"

/* ---- contact nodes, rows of a plain LCP, resultants of contacts ---- */

/* Contact nodes: unknowns node by node n, t1[, t2] */
#define SURFACE (v->s->contacts.surface)
VALUE(contact_node_no, SURFACE->node_no[id])
VALUE(contact_no, SURFACE->contact_id[id] + 1)
WORD_OF(contact_name, v->m->contacts[SURFACE->contact_id[id]].name)
VALUE(contact_x, SURFACE->x[at(SURFACE->dim, id, part)])
VALUE(contact_u_n,
      view_opening(v, id, 0) * v->s->contacts.uc[at(SURFACE->dim, id, 0)])
VALUE(contact_u_t,
      view_opening(v, id, part + 1) *
          surface_along(SURFACE, v->s->body.u, v->s->contacts.uc, id, part + 1))
VALUE(contact_gap, view_opening(v, id, 0) * v->s->contacts.gap[id])
VALUE(contact_f_n, -v->s->contacts.rc[at(SURFACE->dim, id, 0)])
/* The side row of a corner node is a normal force of another obstacle. A
 * problem from a file has no corners. */
static int is_side(const view *v, int id, int part) {
  const int *side = SURFACE->side_id;
  return side != NULL && side[at(SURFACE->dim - 1, id, part)] >= 0;
}

VALUE(contact_f_t, is_side(v, id, part)
                       ? 0
                       : v->s->contacts.rc[at(SURFACE->dim, id, part + 1)])
VALUE(contact_normal, SURFACE->frame[at(SURFACE->dim * SURFACE->dim, id, part)])
VALUE(contact_area, SURFACE->area[id])
VALUE(contact_state, v->s->contacts.contact[id])

/* A plain LCP: z stands for r, w for u. */
VALUE(lcp_z, v->s->contacts.rc[id])
VALUE(lcp_w, v->s->contacts.uc[id])

/* Force over tributary area; a node without area carries none. */
static double per_area(const view *v, int id, double force) {
  double area = contact_area(v, id, 0);
  return area > 0 ? force / area : 0;
}

VALUE(contact_pressure, per_area(v, id, contact_f_n(v, id, 0)))
VALUE(contact_traction, per_area(v, id, contact_f_t(v, id, part)))

/* F = frame' r_c, as u_c = frame u keeps the work. */
static double contact_force(const view *v, int id, int part) {
  int dim = SURFACE->dim;
  const double *frame = SURFACE->frame + at(dim * dim, id, 0);
  double sum = 0;
  for (int k = 0; k < dim; ++k)
    sum += frame[dim * k + part] * v->s->contacts.rc[at(dim, id, k)];
  return sum;
}

VALUE(contact_pull, per_area(v, id, contact_force(v, id, part)))
WORD_OF(contact_word, status_word(v->s->contacts.contact[id]))
/* clang-format off */
#define CON   PER_CONTACT_NODE, AS_REAL
#define SUR SCENE_ALL, NEEDS_SURFACE
#define PLACED SCENE_ALL, NEEDS_PLACE
#define PLACES PRINT_CONTACT | PRINT_WEAR
/* The component in the plane, or the two in space. */
#define TANGENT(name, unit, needs, value, help)                           \
  {name, unit, CON, PRINT_CONTACT, C, SCENE_FLAT, needs, name, 0, value,  \
   NULL, help},                                                           \
  {name "1", unit, CON, PRINT_CONTACT, C, SCENE_SOLID, needs, name "1", 0, \
   value, NULL, help},                                                    \
  {name "2", unit, CON, PRINT_CONTACT, C, SCENE_SOLID, needs, name "2", 1, \
   value, NULL, help}
static const column contact_node_columns[] = {
{"node_no", "-", PER_CONTACT_NODE, AS_COUNT, PLACES, C, SUR, NULL, 0,
 contact_node_no, NULL, "number in the mesh"},
VECTOR("", "length", CON, PLACES, C, NEEDS_PLACE, NULL, contact_x,
       "coordinate"),
{"area", "length^2", CON, 0, C, PLACED, "area", 0, contact_area, NULL,
 "tributary area, that of neighbours that it carries for included"},
VECTOR("n_", "-", CON, 0, C, NEEDS_PLACE, "normal", contact_normal,
       "outward normal"),
{"u_n", "length", CON, PRINT_CONTACT, C, SUR, "u_n", 0, contact_u_n, NULL,
 "displacement along the outward normal"},
{"u_t", "length", CON, PRINT_CONTACT, C, SCENE_FLAT, NEEDS_SURFACE, "u_t", 0,
 contact_u_t, NULL, "displacement along the tangent"},
{"u_t1", "length", CON, PRINT_CONTACT, C, SCENE_SOLID, NEEDS_SURFACE, "u_t1",
 0, contact_u_t, NULL, "displacement along the first tangent"},
{"u_t2", "length", CON, PRINT_CONTACT, C, SCENE_SOLID, NEEDS_SURFACE, "u_t2",
 1, contact_u_t, NULL, "displacement along the second tangent"},
{"gap", "length", CON, PRINT_CONTACT, C, SUR, "gap", 0, contact_gap, NULL,
 "gap left open"},
{"f_n", "force", CON, PRINT_CONTACT, C, SUR, "f_n", 0, contact_f_n, NULL,
 "normal force, positive when pressed"},
TANGENT("f_t", "force", NEEDS_SURFACE, contact_f_t,
        "tangential force of the obstacle on the body"),
VECTOR("f_", "force", CON, PRINT_CONTACT, C, NEEDS_PLACE, "force",
       contact_force, "force of the obstacle on the body"),
{"pressure", PA, CON, PRINT_CONTACT, C, PLACED, "pressure", 0, contact_pressure,
 NULL, "normal force over tributary area, >= 0"},
TANGENT("traction_t", PA, NEEDS_PLACE, contact_traction,
        "tangential force over tributary area"),
OF_EFFECTS(1),
VECTOR("traction_", PA, CON, 0, C, NEEDS_PLACE, "traction", contact_pull,
       "force of the obstacle over tributary area"),
OF_EFFECTS(2),
{"status", "-", PER_CONTACT_NODE, AS_WORD, PRINT_CONTACT, C, SUR, "status", 0,
 contact_state, contact_word, "OPEN, SLIP, STICK; as number 0, 1, 2"},
{"contact_no", "-", PER_CONTACT_NODE, AS_COUNT, PRINT_CONTACT, C, SCENE_ALL,
 NEEDS_PLACE | NEEDS_SEVERAL, NULL, 0, contact_no, NULL,
 "number of the *CONTACT"},

{"row_no", "-", PER_CONTACT_NODE, AS_COUNT, PRINT_CONTACT, C, SCENE_LCP,
 NEEDS_SURFACE, NULL, 0, contact_node_no, NULL, "row of the matrix"},
{"z", "-", CON, PRINT_CONTACT, C, SCENE_LCP, NEEDS_SURFACE, NULL, 0, lcp_z,
 NULL, "unknown of w = q + M z"},
{"w", "-", CON, PRINT_CONTACT, C, SCENE_LCP, NEEDS_SURFACE, NULL, 0, lcp_w,
 NULL, "q + M z"},
OF_EFFECTS(0),
{"contact", "-", PER_CONTACT_NODE, AS_WORD, PLACES, C, PLACED, NULL, 0,
 contact_no, contact_name, "name of the *CONTACT"},
NO_COLUMN};
/* clang-format on */

/* Contacts */
VALUE(total_torque, v->s->contacts.torque[id])
VALUE(own_no, id + 1)
VALUE(total_force, v->s->contacts.totals[id].force[part])
VALUE(total_moment, v->s->contacts.totals[id].moment[part])
VALUE(total_normal, -v->s->contacts.totals[id].normal)
VALUE(total_tangential, v->s->contacts.totals[id].tangential[part])
VALUE(total_area, v->s->contacts.totals[id].area)
VALUE(total_pressure, v->s->contacts.totals[id].pressure)
VALUE(total_open, v->s->contacts.totals[id].n_open)
VALUE(total_slip, v->s->contacts.totals[id].n_slip)
VALUE(total_stick, v->s->contacts.totals[id].n_stick)

WORD_OF(own_name, v->m->contacts[id].name)
/* clang-format off */
#define TOTAL(name, unit, form, scenes, part, value, help)                    \
  {name, unit, PER_CONTACT, form, PRINT_TOTALS, C, scenes, NEEDS_TOTALS, name, \
   part, value, NULL, help}
#define SUM(name, scenes, part, value, help)                                  \
  {name, "force", PER_CONTACT, AS_REAL, PRINT_TOTALS | PRINT_LOOP, C, scenes, \
   NEEDS_TOTALS, name, part, value, NULL, help}
#define FORCE(name, scenes, part) TOTAL(name, "force", AS_REAL, scenes, part, \
  total_force, "force of the obstacle on the body")
#define MOMENT(name, scenes, part) TOTAL(name, J, AS_REAL, scenes, part, \
  total_moment, "moment of the obstacle on the body about the origin")
static const column contact_columns[] = {
{"contact", "-", PER_CONTACT, AS_WORD, PRINT_TOTALS | PRINT_LOOP, C, SCENE_ALL,
 NEEDS_TOTALS, NULL, 0, own_no, own_name, "name of the *CONTACT"},
FORCE("force_x", CART, 0),
TOTAL("force_r", "force", AS_REAL, SCENE_AXI, 0, total_force,
      "sum of the radial nodal forces"),
FORCE("force_y", CART, 1),
FORCE("force_z", SCENE_AXI, 1),
FORCE("force_z", SCENE_SOLID, 2),
MOMENT("moment_x", SCENE_SOLID, 0),
MOMENT("moment_y", SCENE_SOLID, 1),
MOMENT("moment_z", CART, 2),
SUM("normal", SCENE_ALL, 0, total_normal,
    "sum of the normal forces, positive when pressed"),
SUM("tangential", SCENE_FLAT, 0, total_tangential,
    "sum of the tangential forces"),
SUM("tangential_1", SCENE_SOLID, 0, total_tangential,
    "sum of the tangential forces"),
SUM("tangential_2", SCENE_SOLID, 1, total_tangential,
    "sum of the tangential forces"),
{"torque", J, PER_CONTACT, AS_REAL, PRINT_TOTALS | PRINT_LOOP, C, CART,
 NEEDS_TORQUE, "torque", 0, total_torque, NULL,
 "torque of the obstacle on the body about the axis of the contact"},
OF_EFFECTS(0),
TOTAL("closed_area", "length^2", AS_REAL, SCENE_ALL, 0, total_area,
      "tributary area of the closed nodes"),
TOTAL("open", "-", AS_COUNT, SCENE_ALL, 0, total_open, "open nodes"),
TOTAL("slip", "-", AS_COUNT, SCENE_ALL, 0, total_slip, "slipping nodes"),
TOTAL("stick", "-", AS_COUNT, SCENE_ALL, 0, total_stick, "sticking nodes"),
TOTAL("pressure_max", PA, AS_REAL, SCENE_ALL, 0, total_pressure,
      "the largest of its nodes"),
NO_COLUMN};
/* clang-format on */

/* ---- nodes and elements ---- */

/* Nodes */
VALUE(node_no, v->msh->node_no[id])
VALUE(node_x, v->msh->x[at(v->msh->dim, id, part)])
VALUE(node_u, v->s->body.u[at(v->msh->dim, id, part)])

/* Elements */
VALUE(elem_no, v->msh->elem_no[id])

static double elem_x(const view *v, int id, int part) {
  const int dim = v->msh->dim, *node = v->msh->elem + (dim + 1) * id;
  double sum = 0;
  for (int k = 0; k <= dim; ++k) sum += v->msh->x[at(dim, node[k], part)];
  return sum / (dim + 1);
}

VALUE(elem_error, 100 * v->s->errors.elem_error[id])
VALUE(temperature, v->s->body.temperature[id])
VALUE(strain, v->s->body.strain[at(v->m->ns, id, part)])
VALUE(stress, v->s->body.stress[at(v->m->ns, id, part)])

static double mises(const view *v, int id, int part) {
  const double *s = v->s->body.stress + at(v->m->ns, id, 0);
  double shear = s[3] * s[3];
  if (v->m->ns == 6) shear += s[4] * s[4] + s[5] * s[5];
  double a = s[0] - s[1], b = s[1] - s[2], c = s[2] - s[0];
  return sqrt(0.5 * (a * a + b * b + c * c) + 3 * shear);
}

/* The larger (sign 1) or the smaller (-1) eigenvalue of [a c; c b]. */
static double of_two(double a, double b, double c, int sign) {
  return (a + b) / 2 + sign * hypot((a - b) / 2, c);
}

/* Of d, symmetric without trace, the eigenvalue farthest from the others. */
static double lone_value(double d[3][3]) {
  const double r =
      sqrt((dot(3, d[0], d[0]) + dot(3, d[1], d[1]) + dot(3, d[2], d[2])) / 6);
  const double normal[3] = {d[1][1] * d[2][2] - d[1][2] * d[2][1],
                            d[1][2] * d[2][0] - d[1][0] * d[2][2],
                            d[1][0] * d[2][1] - d[1][1] * d[2][0]};
  const double ratio = dot(3, d[0], normal) / (2 * r * r * r);
  const double angle = acos(fmax(-1, fmin(1, ratio))) / 3, pi = acos(-1);
  return 2 * r * cos(angle < pi / 6 ? angle : angle + 2 * pi / 3);
}

/* Unit vectors s, t of the plane normal to the eigenvector of "lone", from the
 * columns of d - lone I: the longest, and of the others what is normal. */
static void plane_of(double d[3][3], double lone, double *s, double *t) {
  double c[3][3];
  int p = 0;
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < 3; ++i) c[k][i] = d[k][i] - (i == k ? lone : 0);
    if (norm(3, c[k]) > norm(3, c[p])) p = k;
  }
  double *q = c[(p + 1) % 3], *other = c[(p + 2) % 3];
  const double size = norm(3, c[p]);
  for (int i = 0; i < 3; ++i) s[i] = c[p][i] / size;
  const double along[2] = {dot(3, s, q), dot(3, s, other)};
  for (int i = 0; i < 3; ++i) {
    q[i] -= along[0] * s[i];
    other[i] -= along[1] * s[i];
  }
  if (norm(3, other) > norm(3, q)) q = other;
  const double rest = norm(3, q);
  for (int i = 0; i < 3; ++i) t[i] = q[i] / rest;
}

/* Principal stress number part, the largest first, in space: the lone one by
 * its angle, the others normal to its direction. W. M. Scherzinger, C. R.
 * Dohrmann, Comput. Methods Appl. Mech. Engrg. 197 (2008) 4007. */
static double principal_in_space(const double *stress, int part) {
  double d[3][3], s[3], t[3], ds[3], dt[3];
  const double scale = largest_entry(6, stress);
  const double mean = (stress[0] + stress[1] + stress[2]) / 3;
  for (int k = 0; k < 3; ++k) {
    d[k][k] = (stress[k] - mean) / scale;
    d[k][(k + 1) % 3] = d[(k + 1) % 3][k] = stress[3 + k] / scale;
  }
  if (!(norm(3, d[0]) + norm(3, d[1]) + norm(3, d[2]) > 0)) return mean;
  const double lone = lone_value(d);
  plane_of(d, lone, s, t);
  for (int k = 0; k < 3; ++k) {
    ds[k] = dot(3, d[k], s);
    dt[k] = dot(3, d[k], t);
  }
  const double a = dot(3, s, ds), b = dot(3, t, dt), c = dot(3, s, dt);
  double e[3] = {lone, of_two(a, b, c, 1), of_two(a, b, c, -1)};
  if (lone < e[1]) {
    e[0] = e[1];
    e[1] = e[2];
    e[2] = lone;
  }
  return mean + scale * e[part];
}

static double principal(const view *v, int id, int part) {
  const double *s = v->s->body.stress + at(v->m->ns, id, 0);
  if (v->m->ns == 6) return principal_in_space(s, part);
  const double high = of_two(s[0], s[1], s[3], 1);
  const double low = of_two(s[0], s[1], s[3], -1);
  if (part == 0) return fmax(high, s[2]);
  if (part == 2) return fmin(low, s[2]);
  return fmax(low, fmin(high, s[2]));
}

/* clang-format off */
#define NODE  PER_NODE, AS_REAL
#define ELEM  PER_ELEMENT, AS_REAL
#define NODES (PRINT_NODES | PRINT_REACTIONS)
#define OF_STRAIN(name, scenes, part, help)                               \
  {name, "-", ELEM, PRINT_ELEMENTS, ON(STRESS), scenes, NEEDS_STRAIN, name, \
   part, strain, NULL, help}
#define OF_STRESS(name, tables, scenes, field, part, value, help)            \
  {name, PA, ELEM, tables, ON(STRESS), scenes, NEEDS_STRESS, field, part,    \
   value, NULL, help}
#define STRESS(name, scenes, part, help) \
  OF_STRESS(name, PRINT_ELEMENTS, scenes, "stress", part, stress, help)
static const column node_columns[] = {
{"node_no", "-", PER_NODE, AS_COUNT, NODES, 0, ANY, NULL, 0, node_no, NULL,
 "number in the mesh"},
VECTOR("", "length", NODE, NODES, 0, 0, NULL, node_x, "coordinate"),
VECTOR("u_", "length", NODE, PRINT_NODES, 0, 0, "u", node_u, "displacement"),
OF_EFFECTS(0),
NO_COLUMN};

static const column element_columns[] = {
{"elem_no", "-", PER_ELEMENT, AS_COUNT, PRINT_ELEMENTS, 0, ANY, NULL, 0,
 elem_no, NULL, "number in the mesh"},
VECTOR("", "length", ELEM, PRINT_ELEMENTS, 0, 0, NULL, elem_x, "centre"),
{"temperature", "temperature", ELEM, PRINT_ELEMENTS,
 ON(STRESS) | ON(THERMAL), ANY, "temperature", 0, temperature, NULL,
 "mean of the element"},
{"mesh_error", "%", ELEM, PRINT_ELEMENTS, ON(MESH_ERROR), SCENE_ALL,
 NEEDS_ELEM_ERROR, "mesh_error", 0, elem_error, NULL, "share of the element in "
 "the error of the mesh, whose square is the sum of their squares"},
OF_STRAIN("strain_xx", CART, 0, "strain"),
OF_STRAIN("strain_yy", CART, 1, "strain"),
OF_STRAIN("strain_zz", CART, 2, "strain"),
OF_STRAIN("gamma_xy", CART, 3, "engineering shear strain"),
OF_STRAIN("gamma_yz", SCENE_SOLID, 4, "engineering shear strain"),
OF_STRAIN("gamma_zx", SCENE_SOLID, 5, "engineering shear strain"),
OF_STRAIN("strain_rr", SCENE_AXI, 0, "strain"),
OF_STRAIN("strain_zz", SCENE_AXI, 1, "strain"),
OF_STRAIN("strain_tt", SCENE_AXI, 2, "hoop strain"),
OF_STRAIN("gamma_rz", SCENE_AXI, 3, "engineering shear strain"),
STRESS("stress_xx", CART, 0, "stress"),
STRESS("stress_yy", CART, 1, "stress"),
STRESS("stress_zz", CART, 2, "stress"),
STRESS("stress_xy", CART, 3, "shear stress"),
STRESS("stress_yz", SCENE_SOLID, 4, "shear stress"),
STRESS("stress_zx", SCENE_SOLID, 5, "shear stress"),
STRESS("stress_rr", SCENE_AXI, 0, "stress"),
STRESS("stress_zz", SCENE_AXI, 1, "stress"),
STRESS("stress_tt", SCENE_AXI, 2, "hoop stress"),
STRESS("stress_rz", SCENE_AXI, 3, "shear stress"),
OF_STRESS("mises", PRINT_ELEMENTS, SCENE_ALL, "mises", 0, mises,
          "von Mises stress"),
OF_STRESS("principal_1", 0, SCENE_ALL, "principal_1", 0, principal,
          "largest principal stress"),
OF_STRESS("principal_2", 0, SCENE_ALL, "principal_2", 1, principal,
          "second principal stress"),
OF_STRESS("principal_3", 0, SCENE_ALL, "principal_3", 2, principal,
          "least principal stress"),
OF_EFFECTS(0),
NO_COLUMN};
/* clang-format on */

VALUE(step_no, v->s->step_no)
VALUE(increment_no, v->s->increment_no)
VALUE(total_no, v->s->total_no)
VALUE(attempt, v->s->attempt)
VALUE(time_now, v->s->t)
VALUE(time_step, v->s->dt)
VALUE(settled, v->s->settled)
VALUE(n_open, v->s->contacts.n_open)
VALUE(n_slip, v->s->contacts.n_slip)
VALUE(n_stick, v->s->contacts.n_stick)
VALUE(iterations, v->s->report.iterations)
VALUE(residual, v->s->report.residual)
VALUE(strain_energy, v->s->energy.strain)
VALUE(external_work, v->s->energy.external)
VALUE(normal_work, v->s->energy.normal)
VALUE(energy_defect, v->s->energy.defect)

double energy_defect_relative(const energies *e) {
  return e->largest > 0 ? e->defect / e->largest : 0;
}
VALUE(defect_relative, energy_defect_relative(&v->s->energy))

/* clang-format off */
#define COUNT(name, tables, effects, value, help)                           \
  {name, "-", PER_INCREMENT, AS_COUNT, tables, effects, ANY, name, 0, value, \
   NULL, help}
#define ENERGY(name, unit, effects, value, help) \
  {name, unit, INC, PRINT_ENERGY, effects, ANY, name, 0, value, NULL, help}
static const column increment_columns[] = {
COUNT("step", PRINT_ENERGY, 0, step_no, "number of the step"),
COUNT("increment", PRINT_ENERGY, 0, increment_no, "increment within the step"),
COUNT("total", 0, 0, total_no, "increments since the start"),
COUNT("attempt", 0, 0, attempt, "1: the increment was not cut"),
ENERGY("time", "time", 0, time_now, "end of the increment"),
{"dt", "time", INC, 0, 0, ANY, "dt", 0, time_step, NULL, "time step"},
COUNT("settled", 0, 0, settled, "1: the increment reached its tolerance"),
COUNT("open", 0, C, n_open, "open nodes"),
COUNT("slip", 0, C, n_slip, "slipping nodes"),
COUNT("stick", 0, C, n_stick, "sticking nodes"),
COUNT("iterations", 0, C, iterations, "iterations of the contact solver"),
OF_EFFECTS(1),
{"residual", "-", INC, 0, C, ANY, "residual", 0, residual, NULL,
 "residual of the contact problem"},
OF_EFFECTS(0),
OF_EFFECTS(2),
ENERGY("strain_energy", J, 0, strain_energy, "elastic energy stored"),
ENERGY("external_work", J, 0, external_work,
       "work of loads and supports so far"),
OF_EFFECTS(3),
ENERGY("normal_work", J, C, normal_work,
       "work of the normal contact forces so far, trapezoidal: "
       "moving obstacles, and gaps that open or close within an increment"),
OF_EFFECTS(4),
OF_EFFECTS(5),
ENERGY("energy_defect", J, 0, energy_defect,
       "external + normal - friction - thermal - inelastic work - strain"),
ENERGY("energy_defect_relative", "-", 0, defect_relative,
       "the defect over the largest of the energies so far"),
NO_COLUMN};
/* clang-format on */

static const column effect_columns[] = {OF_EFFECTS(0), NO_COLUMN};

static const struct {
  entity of;
  const column *column;
} parts[] = {{PER_INCREMENT, increment_columns},
             {PER_NODE, node_columns},
             {PER_ELEMENT, element_columns},
             {PER_CONTACT_NODE, contact_node_columns},
             {PER_ZONE, effect_columns},
             {PER_TIP, effect_columns},
             {PER_GOAL, effect_columns},
             {PER_CONTACT, contact_columns}};

enum { N_PART = sizeof parts / sizeof *parts };

/* The next of the effects at a place in the list of an entity, or NULL. */
static const column *next_of_effects(column_walk *w, int nth) {
  for (; effect_table[w->effect] != NULL; ++w->effect, w->k = 0)
    while (w->k < effect_table[w->effect]->n_column) {
      const column *c = &effect_table[w->effect]->columns[w->k++];
      if (c->of == parts[w->part].of && (int)(c->tables >> COLUMN_PLACE) == nth)
        return c;
    }
  w->effect = 0;
  return NULL;
}

column_walk columns_of(entity of) {
  column_walk w = {0};
  while (parts[w.part].of != of) ++w.part;
  return w;
}

const column *column_next(column_walk *w) {
  const column *c = NULL;
  while (c == NULL && w->part < N_PART) {
    const column *own = &parts[w->part].column[w->at];
    if (own->name == NULL) {
      ++w->part;
      w->at = 0;
      continue;
    }
    c = own->name[0] != '\0' ? own : next_of_effects(w, own->part);
    if (c == own || c == NULL) ++w->at;
  }
  return c;
}

unsigned scene_of(const model *m) {
  if (m->dim == 3) return SCENE_SOLID;
  if (m->dim == 1) return SCENE_LCP;
  for (int i = 0; i < m->n.section; ++i)
    if (m->sections[i].kin % 4 == AXISYMMETRIC) return SCENE_AXI;
  return SCENE_PLANE;
}

/* The most internal variables that a law of the model has. */
static int most_internal(const model *m) {
  int most = 0;
  for (int i = 0; i < m->n.material; ++i) {
    if (!m->materials[i].used || m->materials[i].law.ops == NULL) continue;
    int n = law_n_alpha(&m->materials[i].law, m->ns);
    if (n > most) most = n;
  }
  return most;
}

/* 1: the model has what it is of. */
static int is_asked(const column *c, const model *m) {
  if ((c->needs & NEEDS_TORQUE) != 0 && !model_has_axis(m)) return 0;
  if ((c->needs & NEEDS_SEVERAL) != 0 && m->n.contact < 2) return 0;
  return (c->needs & NEEDS_ALPHA) == 0 || c->part < most_internal(m);
}

int column_visible(const column *c, const model *m) {
  const effect_ops *e = effect_of_column(c);
  if (e != NULL && !effect_is_on(e, m)) return 0;
  return is_asked(c, m) && (c->effects & ~m->effects) == 0 &&
         (c->scenes & scene_of(m)) != 0;
}

static unsigned if_there(const void *p, unsigned bits) {
  return p != NULL ? bits : 0;
}

int column_ready(const column *c, const state *s) {
  const effect_ops *e = effect_of_column(c);
  unsigned have = 0;
  if (e != NULL && (e->on.create != NULL || e->size > 0) && !e->of_state &&
      effect_state(s->effects, e) == NULL)
    return 0;
  have |= if_there(s->body.strain, NEEDS_STRAIN);
  have |= if_there(s->body.stress, NEEDS_STRESS);
  have |= if_there(s->body.reaction, NEEDS_REACTION);
  have |= if_there(s->contacts.surface, NEEDS_SURFACE);
  if (s->contacts.surface != NULL && s->contacts.surface->x != NULL)
    have |= NEEDS_PLACE | NEEDS_SEVERAL;
  have |= if_there(s->contacts.limit, NEEDS_LIMIT);
  have |= if_there(s->contacts.totals, NEEDS_TOTALS);
  have |= if_there(s->contacts.distance, NEEDS_DISTANCE);
  have |= if_there(s->contacts.torque, NEEDS_TORQUE);
  have |= if_there(s->errors.elem_error, NEEDS_ELEM_ERROR);
  have |= if_there(s->body.flow, NEEDS_FLOW | NEEDS_ALPHA);
  return (c->needs & ~have) == 0;
}

int column_items(const column *c, const view *v) {
  const effect_ops *e = effect_of_column(c);
  if (c->of == PER_NODE) return v->msh->n_node;
  if (c->of == PER_ELEMENT) return v->msh->n_elem;
  if (c->of == PER_CONTACT) return v->m->n.contact;
  if (c->of == PER_CONTACT_NODE)
    return v->s->contacts.surface != NULL ? v->s->contacts.surface->n : 0;
  if (c->of == PER_INCREMENT) return 1;
  const char *own = effect_state(v->s->effects, e);
  return *(const int *)(own + e->items);
}

enum { COLUMNS = sizeof((table *)0)->col / sizeof(column *) };

static void cell_name(const column *c, const model *m, char *text,
                      size_t size) {
  snprintf(text, size, "%s[%s]", c->name, model_unit(m, c->unit));
}

/* Sign, point, E and three digits of the exponent: digits + 8. */
static int cell_width(const column *c, const model *m, int digits) {
  char name[160];
  cell_name(c, m, name, sizeof name);
  const int least = c->form == AS_REAL ? digits + 8 : 11;
  const int width = (int)strlen(name);
  return (width > least ? width : least) + 1;
}

void table_choose(table *t, entity of, unsigned print_bit, const view *v,
                  int digits) {
  t->n = 0;
  t->of = of;
  t->digits = digits;
  const column *c;
  for (column_walk w = columns_of(of);
       (c = column_next(&w)) != NULL && c->of == of;) {
    if ((c->tables & print_bit) == 0) continue;
    if (!column_visible(c, v->m) || !column_ready(c, v->s)) continue;
    if (t->n == COLUMNS) break;
    t->width[t->n] = cell_width(c, v->m, digits);
    t->col[t->n++] = c;
  }
}

void table_header(const table *t, const model *m, const char *lead, FILE *f) {
  fputs(lead, f);
  for (int k = 0; k < t->n; ++k) {
    char name[160];
    cell_name(t->col[k], m, name, sizeof name);
    text_cell(f, name, t->width[k]);
  }
  fputc('\n', f);
}

static void row_cell(const table *t, int k, const view *v, int id, FILE *f) {
  const column *c = t->col[k];
  char word[160];
  if (c->form == AS_WORD) {
    text_word(word, sizeof word, c->word(v, id));
    text_cell(f, word, t->width[k]);
    return;
  }
  double value = c->value(v, id, c->part);
  if (c->form == AS_COUNT) snprintf(word, sizeof word, "%.0f", value);
  text_cell(f, c->form == AS_COUNT ? word : text_number(value, t->digits),
            t->width[k]);
}

void table_row(const table *t, const view *v, int id, FILE *f) {
  fputc(' ', f);
  for (int k = 0; k < t->n; ++k) row_cell(t, k, v, id, f);
  fputc('\n', f);
}
