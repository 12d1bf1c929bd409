/*
 * Columns of the contacts: their resultants.
 */
#include "run/column_row.h"

/* Contacts */
VALUE(total_torque, v->s->contacts.torque[id])
VALUE(contact_no, id + 1)
VALUE(total_force, v->s->contacts.totals[id].force[part])
VALUE(total_moment, v->s->contacts.totals[id].moment[part])
VALUE(total_normal, -v->s->contacts.totals[id].normal)
VALUE(total_tangential, v->s->contacts.totals[id].tangential[part])
VALUE(total_area, v->s->contacts.totals[id].area)
VALUE(total_pressure, v->s->contacts.totals[id].pressure)
VALUE(total_open, v->s->contacts.totals[id].n_open)
VALUE(total_slip, v->s->contacts.totals[id].n_slip)
VALUE(total_stick, v->s->contacts.totals[id].n_stick)

static const char *contact_name(const view *v, int id) {
  return v->m->contacts[id].name;
}

/* clang-format off */
#define TOT   PER_CONTACT, AS_REAL
#define TOT_N PER_CONTACT, AS_COUNT
#define TOTAL(scenes) PRINT_TOTALS, C, scenes, NEEDS_TOTALS
#define FORCE(scenes) PRINT_TOTALS | PRINT_LOOP, C, scenes, NEEDS_TOTALS
const column contact_columns[] = {
{"contact", "-", PER_CONTACT, AS_WORD, PRINT_TOTALS | PRINT_LOOP, C, SCENE_ALL,
 NEEDS_TOTALS, NULL, 0, contact_no, contact_name, "name of the *CONTACT"},
{"force_x", "force", TOT, TOTAL(CART), "force_x", 0,
 total_force, NULL, "force of the obstacle on the body"},
{"force_r", "force", TOT, TOTAL(SCENE_AXI), "force_r", 0, total_force, NULL,
 "sum of the radial nodal forces"},
{"force_y", "force", TOT, TOTAL(CART), "force_y", 1,
 total_force, NULL, "force of the obstacle on the body"},
{"force_z", "force", TOT, TOTAL(SCENE_AXI), "force_z", 1, total_force, NULL,
 "force of the obstacle on the body"},
{"force_z", "force", TOT, TOTAL(SCENE_SOLID), "force_z", 2, total_force, NULL,
 "force of the obstacle on the body"},
{"moment_x", J, TOT, TOTAL(SCENE_SOLID), "moment_x", 0, total_moment, NULL,
 "moment of the obstacle on the body about the origin"},
{"moment_y", J, TOT, TOTAL(SCENE_SOLID), "moment_y", 1, total_moment, NULL,
 "moment of the obstacle on the body about the origin"},
{"moment_z", J, TOT, TOTAL(CART), "moment_z", 2,
 total_moment, NULL, "moment of the obstacle on the body about the origin"},
{"normal", "force", TOT, FORCE(SCENE_ALL), "normal", 0, total_normal, NULL,
 "sum of the normal forces, positive when pressed"},
{"tangential", "force", TOT, FORCE(SCENE_FLAT), "tangential", 0,
 total_tangential, NULL, "sum of the tangential forces"},
{"tangential_1", "force", TOT, FORCE(SCENE_SOLID), "tangential_1", 0,
 total_tangential, NULL, "sum of the tangential forces"},
{"tangential_2", "force", TOT, FORCE(SCENE_SOLID), "tangential_2", 1,
 total_tangential, NULL, "sum of the tangential forces"},
{"torque", J, PER_CONTACT, AS_REAL, PRINT_TOTALS | PRINT_LOOP, C, CART,
 NEEDS_TORQUE, "torque", 0, total_torque, NULL,
 "torque of the obstacle on the body about the axis of the contact"},
OF_EFFECTS(0),
{"closed_area", "length^2", TOT, TOTAL(SCENE_ALL), "closed_area", 0,
 total_area, NULL, "tributary area of the closed nodes"},
{"open", "-", TOT_N, TOTAL(SCENE_ALL), "open", 0, total_open, NULL,
 "open nodes"},
{"slip", "-", TOT_N, TOTAL(SCENE_ALL), "slip", 0, total_slip, NULL,
 "slipping nodes"},
{"stick", "-", TOT_N, TOTAL(SCENE_ALL), "stick", 0, total_stick, NULL,
 "sticking nodes"},
{"pressure_max", PA, TOT, TOTAL(SCENE_ALL), "pressure_max", 0, total_pressure,
 NULL, "the largest of its nodes"},
NO_COLUMN};
/* clang-format on */
