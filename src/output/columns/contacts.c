/*
 * Columns of the contact nodes, of the rows of a plain LCP, and of the
 * contacts: their resultants.
 */
#include "run/column_row.h"

/* Contact nodes: unknowns node by node n, t1[, t2] */
#define SURFACE (v->s->contacts.surface)
VALUE(contact_node_no, SURFACE->node_no[id])
VALUE(contact_no, SURFACE->contact_id[id] + 1)
static const char *contact_name(const view *v, int id) {
  return v->m->contacts[SURFACE->contact_id[id]].name;
}

VALUE(contact_x, SURFACE->x[at(SURFACE->dim, id, part)])
VALUE(contact_u_n, v->s->contacts.uc[at(SURFACE->dim, id, 0)])
VALUE(contact_u_t, v->s->contacts.uc[at(SURFACE->dim, id, part + 1)])
VALUE(contact_gap, v->s->contacts.gap[id])
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
  double area = SURFACE->area[id];
  return area > 0 ? force / area : 0;
}

VALUE(contact_pressure, per_area(v, id, contact_f_n(v, id, 0)))
VALUE(contact_traction, per_area(v, id, contact_f_t(v, id, part)))

/* F = frame' r_c, as u_c = frame u keeps the work. */
static double contact_force(const view *v, int id, int part) {
  int dim = SURFACE->dim;
  const double *frame = SURFACE->frame + at(dim * dim, id, 0);
  const double *r = v->s->contacts.rc + at(dim, id, 0);
  double sum = 0;
  for (int k = 0; k < dim; ++k) sum += frame[dim * k + part] * r[k];
  return sum;
}

static double contact_pull(const view *v, int id, int part) {
  return per_area(v, id, contact_force(v, id, part));
}

static const char *contact_word(const view *v, int id) {
  return status_word(v->s->contacts.contact[id]);
}

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
const column contact_node_columns[] = {
{"node_no", "-", PER_CONTACT_NODE, AS_COUNT, PLACES, C, SUR, NULL, 0,
 contact_node_no, NULL, "number in the mesh"},
VECTOR("", "length", CON, PLACES, C, NEEDS_PLACE, NULL, contact_x,
       "coordinate"),
{"area", "length^2", CON, 0, C, PLACED, "area", 0, contact_area, NULL,
 "tributary area"},
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

static const char *own_name(const view *v, int id) {
  return v->m->contacts[id].name;
}

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
const column contact_columns[] = {
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
