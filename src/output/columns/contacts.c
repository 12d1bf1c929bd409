/*
 * Columns of the contacts (resultants, loops) and of their zones.
 */
#include "output/columns/rows.h"

VALUE(loop_time, v->s->t)

/* Zones */
VALUE(zone_kind, v->s->zones[id].kind)
VALUE(zone_contact_no, v->s->zones[id].contact_id + 1)
VALUE(zone_direction, v->s->zones[id].direction)
VALUE(zone_from, v->s->zones[id].from[part])
VALUE(zone_to, v->s->zones[id].to[part])
VALUE(zone_length, v->s->zones[id].length)
VALUE(zone_area, v->s->zones[id].area)

/* Contacts */
VALUE(total_torque, v->s->torque[id])
VALUE(loop_way, v->s->loops[id].way[part])
VALUE(loop_u_t, v->s->loops[id].mean_u_t[part])
VALUE(loop_angle, v->s->loops[id].angle)
VALUE(loop_friction, v->s->loops[id].friction)
VALUE(loop_friction_end, v->s->loops[id].friction_end)
VALUE(loop_area, v->s->loops[id].friction_end - v->s->loops[id].start_end)
VALUE(contact_no, id + 1)
VALUE(total_force, v->s->totals[id].force[part])
VALUE(total_moment, v->s->totals[id].moment[part])
VALUE(total_normal, -v->s->totals[id].normal)
VALUE(total_tangential, v->s->totals[id].tangential[part])
VALUE(total_area, v->s->totals[id].area)
VALUE(total_open, v->s->totals[id].n_open)
VALUE(total_slip, v->s->totals[id].n_slip)
VALUE(total_stick, v->s->totals[id].n_stick)

static const char *contact_name(const view *v, int id) {
  return v->m->contacts[id].name;
}

static const char *zone_word(const view *v, int id) {
  return status_word((unsigned)v->s->zones[id].kind);
}

static const char *zone_contact_name(const view *v, int id) {
  return contact_name(v, v->s->zones[id].contact_id);
}

/* clang-format off */
#define TOT   PER_CONTACT, AS_REAL
#define TOT_N PER_CONTACT, AS_COUNT
#define TOTAL(scenes) PRINT_TOTALS, C, scenes, NEEDS_TOTALS
#define ZONE PER_ZONE, AS_REAL, PRINT_ZONES, C
#define LOOP PER_CONTACT, AS_REAL, PRINT_LOOP, C
#define FORCE(scenes) PRINT_TOTALS | PRINT_LOOP, C, scenes, NEEDS_TOTALS
const column zone_columns[] = {
{"contact", "-", PER_ZONE, AS_WORD, PRINT_ZONES, C, SCENE_ALL, NEEDS_ZONES,
 NULL, 0, zone_contact_no, zone_contact_name, "name of the *CONTACT"},
{"zone", "-", PER_ZONE, AS_WORD, PRINT_ZONES, C, SCENE_ALL, NEEDS_ZONES, NULL,
 0, zone_kind, zone_word, "OPEN, SLIP, STICK; as number 0, 1, 2"},
{"direction", "-", PER_ZONE, AS_COUNT, PRINT_ZONES, F, SCENE_FLAT, NEEDS_ZONES,
 NULL, 0, zone_direction, NULL, "sign of the slip along the tangent"},
{"x_from", "length", ZONE, SCENE_PLANE, NEEDS_ZONES, NULL, 0, zone_from, NULL,
 "where the zone begins"},
{"y_from", "length", ZONE, SCENE_PLANE, NEEDS_ZONES, NULL, 1, zone_from, NULL,
 "where the zone begins"},
{"x_to", "length", ZONE, SCENE_PLANE, NEEDS_ZONES, NULL, 0, zone_to, NULL,
 "where the zone ends"},
{"y_to", "length", ZONE, SCENE_PLANE, NEEDS_ZONES, NULL, 1, zone_to, NULL,
 "where the zone ends"},
{"r_from", "length", ZONE, SCENE_AXI, NEEDS_ZONES, NULL, 0, zone_from, NULL,
 "where the zone begins"},
{"z_from", "length", ZONE, SCENE_AXI, NEEDS_ZONES, NULL, 1, zone_from, NULL,
 "where the zone begins"},
{"r_to", "length", ZONE, SCENE_AXI, NEEDS_ZONES, NULL, 0, zone_to, NULL,
 "where the zone ends"},
{"z_to", "length", ZONE, SCENE_AXI, NEEDS_ZONES, NULL, 1, zone_to, NULL,
 "where the zone ends"},
{"extent", "length", ZONE, SCENE_FLAT, NEEDS_ZONES, NULL, 0, zone_length, NULL,
 "length along the contact line"},
{"area", "length^2", ZONE, SCENE_ALL, NEEDS_ZONES, NULL, 0, zone_area, NULL,
 "area of the zone, of the whole turn in axisymmetry"},
NO_COLUMN};
/* clang-format on */

/* clang-format off */
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
{"time", "time", LOOP, SCENE_ALL, NEEDS_LOOP, NULL, 0, loop_time, NULL,
 "end of the increment"},
{"way", "length", LOOP, SCENE_FLAT, NEEDS_LOOP, NULL, 0, loop_way, NULL,
 "mean way of the obstacle past the nodes"},
{"way_1", "length", LOOP, SCENE_SOLID, NEEDS_LOOP, NULL, 0, loop_way, NULL,
 "mean way of the obstacle past the nodes"},
{"way_2", "length", LOOP, SCENE_SOLID, NEEDS_LOOP, NULL, 1, loop_way, NULL,
 "mean way of the obstacle past the nodes"},
{"angle", "rad", LOOP, CART, NEEDS_LOOP | NEEDS_TORQUE, NULL, 0, loop_angle,
 NULL, "angle of the obstacle"},
{"mean_u_t", "length", LOOP, SCENE_FLAT, NEEDS_LOOP, NULL, 0, loop_u_t, NULL,
 "mean tangential displacement of the contact nodes"},
{"mean_u_t1", "length", LOOP, SCENE_SOLID, NEEDS_LOOP, NULL, 0, loop_u_t, NULL,
 "mean tangential displacement of the contact nodes"},
{"mean_u_t2", "length", LOOP, SCENE_SOLID, NEEDS_LOOP, NULL, 1, loop_u_t, NULL,
 "mean tangential displacement of the contact nodes"},
{"friction_work", J, LOOP, SCENE_ALL, NEEDS_LOOP, NULL, 0, loop_friction, NULL,
 "dissipated by friction so far, trapezoidal"},
{"friction_work_end", J, LOOP, SCENE_ALL, NEEDS_LOOP, NULL, 0,
 loop_friction_end, NULL, "the same with the forces at the end of increments"},
{"loop_area", J, LOOP, SCENE_ALL, NEEDS_LOOP, NULL, 0, loop_area, NULL,
 "friction_work_end since the step began: the area of a loop that closes"},
{"closed_area", "length^2", TOT, TOTAL(SCENE_ALL), "closed_area", 0,
 total_area, NULL, "tributary area of the closed nodes"},
{"open", "-", TOT_N, TOTAL(SCENE_ALL), "open", 0, total_open, NULL,
 "open nodes"},
{"slip", "-", TOT_N, TOTAL(SCENE_ALL), "slip", 0, total_slip, NULL,
 "slipping nodes"},
{"stick", "-", TOT_N, TOTAL(SCENE_ALL), "stick", 0, total_stick, NULL,
 "sticking nodes"},
NO_COLUMN};
/* clang-format on */
