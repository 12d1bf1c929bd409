/*
 * Columns of the contact nodes, and of the rows of a plain LCP.
 */
#include "run/column_row.h"

#include <math.h>

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
const column contact_node_columns[] = {
{"node_no", "-", PER_CONTACT_NODE, AS_COUNT, PLACES, C, SUR, NULL, 0,
 contact_node_no, NULL, "number in the mesh"},
{"x", "length", CON, PLACES, C, CART,
 NEEDS_PLACE, NULL, 0, contact_x, NULL, "coordinate"},
{"r", "length", CON, PLACES, C, SCENE_AXI, NEEDS_PLACE, NULL, 0,
 contact_x, NULL, "coordinate"},
{"y", "length", CON, PLACES, C, CART,
 NEEDS_PLACE, NULL, 1, contact_x, NULL, "coordinate"},
{"z", "length", CON, PLACES, C, SCENE_AXI, NEEDS_PLACE, NULL, 1,
 contact_x, NULL, "coordinate"},
{"z", "length", CON, PLACES, C, SCENE_SOLID, NEEDS_PLACE, NULL, 2,
 contact_x, NULL, "coordinate"},
{"area", "length^2", CON, 0, C, PLACED, "area", 0, contact_area, NULL,
 "tributary area"},
{"n_x", "-", CON, 0, C, CART, NEEDS_PLACE, "normal", 0, contact_normal, NULL,
 "outward normal"},
{"n_r", "-", CON, 0, C, SCENE_AXI, NEEDS_PLACE, "normal", 0, contact_normal,
 NULL, "outward normal"},
{"n_y", "-", CON, 0, C, CART, NEEDS_PLACE, "normal", 1, contact_normal, NULL,
 "outward normal"},
{"n_z", "-", CON, 0, C, SCENE_AXI, NEEDS_PLACE, "normal", 1, contact_normal,
 NULL, "outward normal"},
{"n_z", "-", CON, 0, C, SCENE_SOLID, NEEDS_PLACE, "normal", 2,
 contact_normal, NULL, "outward normal"},
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
{"f_t", "force", CON, PRINT_CONTACT, C, SCENE_FLAT, NEEDS_SURFACE, "f_t", 0,
 contact_f_t, NULL, "tangential force of the obstacle on the body"},
{"f_t1", "force", CON, PRINT_CONTACT, C, SCENE_SOLID, NEEDS_SURFACE, "f_t1",
 0, contact_f_t, NULL, "tangential force of the obstacle on the body"},
{"f_t2", "force", CON, PRINT_CONTACT, C, SCENE_SOLID, NEEDS_SURFACE, "f_t2",
 1, contact_f_t, NULL, "tangential force of the obstacle on the body"},
{"f_x", "force", CON, PRINT_CONTACT, C, CART,
 NEEDS_PLACE, "force", 0, contact_force, NULL,
 "force of the obstacle on the body"},
{"f_r", "force", CON, PRINT_CONTACT, C, SCENE_AXI, NEEDS_PLACE, "force", 0,
 contact_force, NULL, "force of the obstacle on the body"},
{"f_y", "force", CON, PRINT_CONTACT, C, CART,
 NEEDS_PLACE, "force", 1, contact_force, NULL,
 "force of the obstacle on the body"},
{"f_z", "force", CON, PRINT_CONTACT, C, SCENE_AXI, NEEDS_PLACE, "force", 1,
 contact_force, NULL, "force of the obstacle on the body"},
{"f_z", "force", CON, PRINT_CONTACT, C, SCENE_SOLID, NEEDS_PLACE, "force",
 2, contact_force, NULL, "force of the obstacle on the body"},
{"pressure", PA, CON, PRINT_CONTACT, C, PLACED, "pressure", 0, contact_pressure,
 NULL, "normal force over tributary area, >= 0"},
{"traction_t", PA, CON, PRINT_CONTACT, C, SCENE_FLAT, NEEDS_PLACE,
 "traction_t", 0, contact_traction, NULL,
 "tangential force over tributary area"},
{"traction_t1", PA, CON, PRINT_CONTACT, C, SCENE_SOLID, NEEDS_PLACE,
 "traction_t1", 0, contact_traction, NULL,
 "tangential force over tributary area"},
{"traction_t2", PA, CON, PRINT_CONTACT, C, SCENE_SOLID, NEEDS_PLACE,
 "traction_t2", 1, contact_traction, NULL,
 "tangential force over tributary area"},
OF_EFFECTS(1),
{"traction_x", PA, CON, 0, C, CART, NEEDS_PLACE, "traction", 0, contact_pull,
 NULL, "force of the obstacle over tributary area"},
{"traction_r", PA, CON, 0, C, SCENE_AXI, NEEDS_PLACE,
 "traction", 0, contact_pull,
 NULL, "force of the obstacle over tributary area"},
{"traction_y", PA, CON, 0, C, CART, NEEDS_PLACE, "traction", 1, contact_pull,
 NULL, "force of the obstacle over tributary area"},
{"traction_z", PA, CON, 0, C, SCENE_AXI, NEEDS_PLACE,
 "traction", 1, contact_pull,
 NULL, "force of the obstacle over tributary area"},
{"traction_z", PA, CON, 0, C, SCENE_SOLID, NEEDS_PLACE,
 "traction", 2, contact_pull,
 NULL, "force of the obstacle over tributary area"},
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
