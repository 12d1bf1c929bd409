/*
 * THE table of output columns: what tables, fields and histories show, each
 * with its unit. Signs as in the manual: pressure p = -r_n/area >= 0, forces
 * are those of the obstacle on the body, so f_n = -r_n >= 0 presses, and f_t
 * is opposite to the slip.
 */
#include "columns/columns.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A value is one expression of the view v, the item id and the component. */
#define VALUE(name, expression)                         \
  static double name(const view *v, int id, int part) { \
    (void)v, (void)id, (void)part;                      \
    return (double)(expression);                        \
  }

static size_t at(int stride, int id, int part) {
  return (size_t)stride * (size_t)id + (size_t)part;
}

/* Increments */
VALUE(step_no, v->s->step_no)
VALUE(increment_no, v->s->increment_no)
VALUE(total_no, v->s->total_no)
VALUE(attempt, v->s->attempt)
VALUE(time_now, v->s->t)
VALUE(time_step, v->s->dt)
VALUE(settled, v->s->settled)
VALUE(n_open, v->s->n_open)
VALUE(n_slip, v->s->n_slip)
VALUE(n_stick, v->s->n_stick)
VALUE(iterations, v->s->report.iterations)
VALUE(limit_updates, v->s->report.limit_updates)
VALUE(residual, v->s->report.residual)
VALUE(mesh_error,
      v->s->mesh_error.asked ? 100 * v->s->mesh_error.relative : NAN)
VALUE(time_error,
      v->s->time_error.asked ? 100 * v->s->time_error.relative : NAN)
VALUE(true_energy, 100 * v->s->truth.energy)
VALUE(true_displacement, 100 * v->s->truth.displacement)
VALUE(true_stress, 100 * v->s->truth.stress)
VALUE(true_pressure, 100 * v->s->truth.pressure)
VALUE(elem_error, 100 * v->s->elem_error[id])
VALUE(bound_error, 100 * v->s->error.relative)
VALUE(solver_error_energy, v->s->error.energy)
VALUE(contraction, v->s->error.rate)
VALUE(strain_energy, v->s->energy.strain)
VALUE(external_work, v->s->energy.external)
VALUE(friction_work, v->s->energy.friction)
VALUE(friction_end, v->s->energy.friction_end)
VALUE(normal_work, v->s->energy.normal)
VALUE(thermal_work, v->s->energy.thermal)
VALUE(inelastic_work, v->s->energy.inelastic)
VALUE(dissipated, v->s->energy.dissipated)
VALUE(inelastic_stored, v->s->energy.stored)
VALUE(energy_defect, v->s->energy.defect)

double energy_defect_relative(const energies *e) {
  return e->largest > 0 ? e->defect / e->largest : 0;
}
VALUE(defect_relative, energy_defect_relative(&v->s->energy))

/* Nodes */
VALUE(node_no, v->msh->node_no[id])
VALUE(node_x, v->msh->x[at(v->msh->dim, id, part)])
VALUE(node_u, v->s->u[at(v->msh->dim, id, part)])
VALUE(reaction, v->s->reaction[at(v->msh->dim, id, part)])

/* Elements */
VALUE(elem_no, v->msh->elem_no[id])

static double elem_x(const view *v, int id, int part) {
  const int dim = v->msh->dim, *node = v->msh->elem + (dim + 1) * id;
  double sum = 0;
  for (int k = 0; k <= dim; ++k) sum += v->msh->x[at(dim, node[k], part)];
  return sum / (dim + 1);
}

VALUE(temperature, v->s->temperature[id])
VALUE(strain, v->s->strain[at(v->m->ns, id, part)])
VALUE(stress, v->s->stress[at(v->m->ns, id, part)])

static int compare_id(const void *a, const void *b) {
  const int x = *(const int *)a, y = *(const int *)b;
  return (x > y) - (x < y);
}

/* Point of an element whose law flows, or -1. */
static int point_of(const view *v, int elem_id) {
  const int *found = bsearch(&elem_id, v->s->flow_elem, (size_t)v->s->flow->n,
                             sizeof elem_id, compare_id);
  return found == NULL ? -1 : (int)(found - v->s->flow_elem);
}

/* Inelastic strain; 0 where no law flows. */
static double inelastic(const view *v, int id, int part) {
  int k = point_of(v, id);
  return k < 0 ? 0 : v->s->inelastic->ei[at(v->m->ns, k, part)];
}

/* Internal variable; 0 where the law has fewer. */
static double internal(const view *v, int id, int part) {
  int k = point_of(v, id);
  const size_t *start = v->s->flow->alpha_at;
  if (k < 0 || start[k] + (size_t)part >= start[k + 1]) return 0;
  return v->s->inelastic->alpha[start[k] + (size_t)part];
}

static double mises(const view *v, int id, int part) {
  const double *s = v->s->stress + at(v->m->ns, id, 0);
  (void)part;
  double shear = s[3] * s[3];
  if (v->m->ns == 6) shear += s[4] * s[4] + s[5] * s[5];
  double a = s[0] - s[1], b = s[1] - s[2], c = s[2] - s[0];
  return sqrt(0.5 * (a * a + b * b + c * c) + 3 * shear);
}

/* Contact nodes: unknowns node by node n, t1[, t2] */
#define SURFACE (v->s->surface)
VALUE(contact_node_no, SURFACE->node_no[id])
VALUE(contact_x, SURFACE->x[at(SURFACE->dim, id, part)])
VALUE(contact_u_n, v->s->uc[at(SURFACE->dim, id, 0)])
VALUE(contact_u_t, v->s->uc[at(SURFACE->dim, id, part + 1)])
VALUE(contact_gap, v->s->gap[id])
VALUE(contact_f_n, -v->s->rc[at(SURFACE->dim, id, 0)])
/* The side row of a corner node is a normal force of another obstacle. A
 * problem from a file has no corners. */
static int is_side(const view *v, int id, int part) {
  const int *side = SURFACE->side_id;
  return side != NULL && side[at(SURFACE->dim - 1, id, part)] >= 0;
}

VALUE(contact_f_t,
      is_side(v, id, part) ? 0 : v->s->rc[at(SURFACE->dim, id, part + 1)])
VALUE(contact_slip, v->s->slip[at(SURFACE->dim - 1, id, part)])
VALUE(sliding_limit, v->s->limit[id])
VALUE(contact_normal, SURFACE->frame[at(SURFACE->dim * SURFACE->dim, id, part)])
VALUE(contact_area, SURFACE->area[id])
VALUE(contact_state, v->s->contact[id])

/* A plain LCP: z stands for r, w for u. */
VALUE(lcp_z, v->s->rc[id])
VALUE(lcp_w, v->s->uc[id])

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
  const double *r = v->s->rc + at(dim, id, 0);
  double sum = 0;
  for (int k = 0; k < dim; ++k) sum += frame[dim * k + part] * r[k];
  return sum;
}

static const char *status_word(unsigned k) {
  static const char *const words[] = {"OPEN", "SLIP", "STICK"};
  return k < 3 ? words[k] : "?";
}

static const char *contact_word(const view *v, int id) {
  return status_word(v->s->contact[id]);
}

VALUE(slip_distance, v->s->distance[id])

/* Unit vector of the slip, global components; 0 where the node does not slip */
static double slip_direction(const view *v, int id, int part) {
  int dim = SURFACE->dim;
  const double *frame = SURFACE->frame + at(dim * dim, id, 0);
  const double *slip = v->s->slip + at(dim - 1, id, 0);
  double sum = frame[dim + part] * slip[0], length = fabs(slip[0]);
  if (dim == 3) {
    sum += frame[2 * dim + part] * slip[1];
    length = hypot(slip[0], slip[1]);
  }
  if (v->s->contact[id] != CONTACT_SLIP || !(length > 0)) return 0;
  return sum / length;
}

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
/* Needs an effect, also in a build that knows nothing of it. */
#define ON(effect) (1u << EFFECT_BIT_##effect)
#define C ON(CONTACT)
#define F (ON(CONTACT) | ON(FRICTION))
#define INC   PER_INCREMENT, AS_REAL
#define INC_N PER_INCREMENT, AS_COUNT
#define NODE  PER_NODE, AS_REAL
#define ELEM  PER_ELEMENT, AS_REAL
#define CON   PER_CONTACT_NODE, AS_REAL
#define TOT   PER_CONTACT, AS_REAL
#define TOT_N PER_CONTACT, AS_COUNT
#define NODES (PRINT_NODES | PRINT_REACTIONS)
#define CART (SCENE_PLANE | SCENE_SOLID)
#define ANY SCENE_ALL, 0
#define SUR SCENE_ALL, NEEDS_SURFACE
#define PLACE SCENE_ALL, NEEDS_PLACE
#define STRAIN(scenes) PRINT_ELEMENTS, ON(STRESS), scenes, NEEDS_STRAIN
#define STRESS(scenes) PRINT_ELEMENTS, ON(STRESS), scenes, NEEDS_STRESS
#define FLOW(scenes) \
  PRINT_ELEMENTS, ON(STRESS) | ON(INELASTIC), scenes, NEEDS_FLOW
#define ALPHA \
  PRINT_ELEMENTS, ON(STRESS) | ON(INELASTIC), SCENE_ALL, \
  NEEDS_FLOW | NEEDS_ALPHA
#define REACT(scenes) PRINT_REACTIONS, ON(REACTION), scenes, NEEDS_REACTION
#define TOTAL(scenes) PRINT_TOTALS, C, scenes, NEEDS_TOTALS
#define ZONE PER_ZONE, AS_REAL, PRINT_ZONES, C
#define LOOP PER_CONTACT, AS_REAL, PRINT_LOOP, C
#define SLIDES(scenes) PRINT_CONTACT, F, scenes, NEEDS_PLACE
#define FORCE(scenes) PRINT_TOTALS | PRINT_LOOP, C, scenes, NEEDS_TOTALS
#define PA "force/length^2"
#define J "force*length"
const column column_table[] = {
/* name, unit, entity and form, tables, effects, scenes, needs, field, part,
 * value, word, help */
{"step", "-", INC_N, PRINT_ENERGY, 0, ANY, "step", 0, step_no, NULL,
 "number of the step"},
{"increment", "-", INC_N, PRINT_ENERGY, 0, ANY, "increment", 0, increment_no,
 NULL, "increment within the step"},
{"total", "-", INC_N, 0, 0, ANY, "total", 0, total_no, NULL,
 "increments since the start"},
{"attempt", "-", INC_N, 0, 0, ANY, "attempt", 0, attempt, NULL,
 "1: the increment was not cut"},
{"time", "time", INC, PRINT_ENERGY, 0, ANY, "time", 0, time_now, NULL,
 "end of the increment"},
{"dt", "time", INC, 0, 0, ANY, "dt", 0, time_step, NULL, "time step"},
{"settled", "-", INC_N, 0, 0, ANY, "settled", 0, settled, NULL,
 "1: the increment reached its tolerance"},
{"open", "-", INC_N, 0, C, ANY, "open", 0, n_open, NULL, "open nodes"},
{"slip", "-", INC_N, 0, C, ANY, "slip", 0, n_slip, NULL, "slipping nodes"},
{"stick", "-", INC_N, 0, C, ANY, "stick", 0, n_stick, NULL, "sticking nodes"},
{"iterations", "-", INC_N, 0, C, ANY, "iterations", 0, iterations, NULL,
 "iterations of the contact solver"},
{"limit_updates", "-", INC_N, 0, F, ANY, "limit_updates", 0, limit_updates,
 NULL, "passes of the fixed point on the sliding limit"},
{"residual", "-", INC, 0, C, ANY, "residual", 0, residual, NULL,
 "residual of the contact problem"},
{"mesh_error", "%", INC, 0, ON(MESH_ERROR), ANY, "mesh_error", 0, mesh_error,
 NULL, "estimate of the error of the mesh in the energy norm, of that of the "
 "solution; NaN: not asked for"},
{"time_error", "%", INC, 0, ON(TIME_ERROR), ANY, "time_error", 0, time_error,
 NULL, "estimate of the error of the increments in that norm; NaN: not asked "
 "for, or unknown"},
{"true_error", "%", INC, 0, ON(REFERENCE), ANY, "true_error", 0, true_energy,
 NULL, "error against *REFERENCE in that norm; NaN: it has no displacement and "
 "no stress"},
{"true_displacement_error", "%", INC, 0, ON(REFERENCE), ANY,
 "true_displacement_error", 0, true_displacement, NULL,
 "the same of the displacement in the L2 norm"},
{"true_stress_error", "%", INC, 0, ON(REFERENCE), ANY, "true_stress_error",
 0, true_stress, NULL, "the same of the stress in the L2 norm"},
{"true_pressure_error", "%", INC, 0, ON(REFERENCE), ANY,
 "true_pressure_error", 0, true_pressure, NULL,
 "the same of the contact pressure in the L2 norm"},
{"solver_error", "%", INC, 0, C | ON(ESTIMATES), ANY, "solver_error", 0,
 bound_error, NULL, "bound of the error of the contact solver in the energy "
 "norm, of that of the solution; NaN: no bound"},
{"solver_error_energy", J, INC, 0, C | ON(ESTIMATES), ANY,
 "solver_error_energy", 0, solver_error_energy, NULL,
 "bound of the energy of that error"},
{"contraction", "-", INC, 0, F | ON(ESTIMATES), ANY, "contraction", 0,
 contraction, NULL, "rate of the fixed point on the sliding limit"},
{"strain_energy", J, INC, PRINT_ENERGY, 0, ANY, "strain_energy", 0,
 strain_energy, NULL, "elastic energy stored"},
{"external_work", J, INC, PRINT_ENERGY, 0, ANY, "external_work", 0,
 external_work, NULL, "work of loads and supports so far"},
{"friction_work", J, INC, PRINT_ENERGY, F, ANY, "friction_work", 0,
 friction_work, NULL, "dissipated by friction so far, trapezoidal"},
{"friction_work_end", J, INC, PRINT_ENERGY, F, ANY, "friction_work_end", 0,
 friction_end, NULL, "the same with the forces at the end of increments"},
{"normal_work", J, INC, PRINT_ENERGY, C, ANY, "normal_work", 0,
 normal_work, NULL, "work of the normal contact forces so far, trapezoidal: "
 "moving obstacles, and gaps that open or close within an increment"},
{"thermal_work", J, INC, PRINT_ENERGY, ON(THERMAL), ANY, "thermal_work", 0,
 thermal_work, NULL, "work of the stresses on thermal strains so far"},
{"inelastic_work", J, INC, PRINT_ENERGY, ON(INELASTIC), ANY,
 "inelastic_work", 0, inelastic_work, NULL,
 "work of the stresses on inelastic strains so far, trapezoidal"},
{"viscous_dissipation", J, INC, PRINT_ENERGY, ON(INELASTIC), ANY,
 "viscous_dissipation", 0, dissipated, NULL,
 "lost of it by the laws so far, in the quadrature of the integrator"},
{"inelastic_stored", J, INC, PRINT_ENERGY, ON(INELASTIC), ANY,
 "inelastic_stored", 0, inelastic_stored, NULL,
 "kept of it by the internal variables"},
{"energy_defect", J, INC, PRINT_ENERGY, 0, ANY, "energy_defect", 0,
 energy_defect, NULL,
 "external + normal - friction - thermal - inelastic work - strain"},
{"energy_defect_relative", "-", INC, PRINT_ENERGY, 0, ANY,
 "energy_defect_relative", 0, defect_relative, NULL,
 "the defect over the largest of the energies so far"},

{"node_no", "-", PER_NODE, AS_COUNT, NODES, 0, ANY, NULL, 0, node_no, NULL,
 "number in the mesh"},
{"x", "length", NODE, NODES, 0, CART, 0, NULL, 0, node_x,
 NULL, "coordinate"},
{"r", "length", NODE, NODES, 0, SCENE_AXI, 0, NULL, 0, node_x, NULL,
 "coordinate"},
{"y", "length", NODE, NODES, 0, CART, 0, NULL, 1, node_x,
 NULL, "coordinate"},
{"z", "length", NODE, NODES, 0, SCENE_AXI, 0, NULL, 1, node_x, NULL,
 "coordinate"},
{"z", "length", NODE, NODES, 0, SCENE_SOLID, 0, NULL, 2, node_x, NULL,
 "coordinate"},
{"u_x", "length", NODE, PRINT_NODES, 0, CART, 0, "u", 0,
 node_u, NULL, "displacement"},
{"u_r", "length", NODE, PRINT_NODES, 0, SCENE_AXI, 0, "u", 0, node_u, NULL,
 "displacement"},
{"u_y", "length", NODE, PRINT_NODES, 0, CART, 0, "u", 1,
 node_u, NULL, "displacement"},
{"u_z", "length", NODE, PRINT_NODES, 0, SCENE_AXI, 0, "u", 1, node_u, NULL,
 "displacement"},
{"u_z", "length", NODE, PRINT_NODES, 0, SCENE_SOLID, 0, "u", 2, node_u, NULL,
 "displacement"},
{"reaction_x", "force", NODE, REACT(CART), "reaction", 0,
 reaction, NULL, "force of the support on the body"},
{"reaction_r", "force", NODE, REACT(SCENE_AXI), "reaction", 0, reaction, NULL,
 "force of the support on the body"},
{"reaction_y", "force", NODE, REACT(CART), "reaction", 1,
 reaction, NULL, "force of the support on the body"},
{"reaction_z", "force", NODE, REACT(SCENE_AXI), "reaction", 1, reaction, NULL,
 "force of the support on the body"},
{"reaction_z", "force", NODE, REACT(SCENE_SOLID), "reaction", 2, reaction,
 NULL, "force of the support on the body"},

{"elem_no", "-", PER_ELEMENT, AS_COUNT, PRINT_ELEMENTS, 0, ANY, NULL, 0,
 elem_no, NULL, "number in the mesh"},
{"x", "length", ELEM, PRINT_ELEMENTS, 0, CART, 0, NULL, 0, elem_x, NULL,
 "centre"},
{"r", "length", ELEM, PRINT_ELEMENTS, 0, SCENE_AXI, 0, NULL, 0, elem_x, NULL,
 "centre"},
{"y", "length", ELEM, PRINT_ELEMENTS, 0, CART, 0, NULL, 1, elem_x, NULL,
 "centre"},
{"z", "length", ELEM, PRINT_ELEMENTS, 0, SCENE_AXI, 0, NULL, 1, elem_x, NULL,
 "centre"},
{"z", "length", ELEM, PRINT_ELEMENTS, 0, SCENE_SOLID, 0, NULL, 2, elem_x, NULL,
 "centre"},
{"temperature", "temperature", ELEM, PRINT_ELEMENTS,
 ON(STRESS) | ON(THERMAL), ANY, "temperature", 0, temperature, NULL,
 "mean of the element"},
{"mesh_error", "%", ELEM, PRINT_ELEMENTS, ON(MESH_ERROR), SCENE_ALL,
 NEEDS_ELEM_ERROR, "mesh_error", 0, elem_error, NULL, "share of the element in "
 "the error of the mesh, whose square is the sum of their squares"},
{"strain_xx", "-", ELEM, STRAIN(CART), "strain_xx", 0,
 strain, NULL, "strain"},
{"strain_yy", "-", ELEM, STRAIN(CART), "strain_yy", 1,
 strain, NULL, "strain"},
{"strain_zz", "-", ELEM, STRAIN(CART), "strain_zz", 2,
 strain, NULL, "strain"},
{"gamma_xy", "-", ELEM, STRAIN(CART), "gamma_xy", 3,
 strain, NULL, "engineering shear strain"},
{"gamma_yz", "-", ELEM, STRAIN(SCENE_SOLID), "gamma_yz", 4, strain, NULL,
 "engineering shear strain"},
{"gamma_zx", "-", ELEM, STRAIN(SCENE_SOLID), "gamma_zx", 5, strain, NULL,
 "engineering shear strain"},
{"strain_rr", "-", ELEM, STRAIN(SCENE_AXI), "strain_rr", 0, strain, NULL,
 "strain"},
{"strain_zz", "-", ELEM, STRAIN(SCENE_AXI), "strain_zz", 1, strain, NULL,
 "strain"},
{"strain_tt", "-", ELEM, STRAIN(SCENE_AXI), "strain_tt", 2, strain, NULL,
 "hoop strain"},
{"gamma_rz", "-", ELEM, STRAIN(SCENE_AXI), "gamma_rz", 3, strain, NULL,
 "engineering shear strain"},
{"stress_xx", PA, ELEM, STRESS(CART), "stress_xx", 0,
 stress, NULL, "stress"},
{"stress_yy", PA, ELEM, STRESS(CART), "stress_yy", 1,
 stress, NULL, "stress"},
{"stress_zz", PA, ELEM, STRESS(CART), "stress_zz", 2,
 stress, NULL, "stress"},
{"stress_xy", PA, ELEM, STRESS(CART), "stress_xy", 3,
 stress, NULL, "shear stress"},
{"stress_yz", PA, ELEM, STRESS(SCENE_SOLID), "stress_yz", 4, stress, NULL,
 "shear stress"},
{"stress_zx", PA, ELEM, STRESS(SCENE_SOLID), "stress_zx", 5, stress, NULL,
 "shear stress"},
{"stress_rr", PA, ELEM, STRESS(SCENE_AXI), "stress_rr", 0, stress, NULL,
 "stress"},
{"stress_zz", PA, ELEM, STRESS(SCENE_AXI), "stress_zz", 1, stress, NULL,
 "stress"},
{"stress_tt", PA, ELEM, STRESS(SCENE_AXI), "stress_tt", 2, stress, NULL,
 "hoop stress"},
{"stress_rz", PA, ELEM, STRESS(SCENE_AXI), "stress_rz", 3, stress, NULL,
 "shear stress"},
{"mises", PA, ELEM, STRESS(SCENE_ALL), "mises", 0, mises, NULL,
 "von Mises stress"},
{"ei_xx", "-", ELEM, FLOW(CART), "ei_xx", 0, inelastic, NULL,
 "inelastic strain"},
{"ei_yy", "-", ELEM, FLOW(CART), "ei_yy", 1, inelastic, NULL,
 "inelastic strain"},
{"ei_zz", "-", ELEM, FLOW(CART), "ei_zz", 2, inelastic, NULL,
 "inelastic strain"},
{"ei_xy", "-", ELEM, FLOW(CART), "ei_xy", 3, inelastic, NULL,
 "inelastic shear strain, engineering"},
{"ei_yz", "-", ELEM, FLOW(SCENE_SOLID), "ei_yz", 4, inelastic, NULL,
 "inelastic shear strain, engineering"},
{"ei_zx", "-", ELEM, FLOW(SCENE_SOLID), "ei_zx", 5, inelastic, NULL,
 "inelastic shear strain, engineering"},
{"ei_rr", "-", ELEM, FLOW(SCENE_AXI), "ei_rr", 0, inelastic, NULL,
 "inelastic strain"},
{"ei_zz", "-", ELEM, FLOW(SCENE_AXI), "ei_zz", 1, inelastic, NULL,
 "inelastic strain"},
{"ei_tt", "-", ELEM, FLOW(SCENE_AXI), "ei_tt", 2, inelastic, NULL,
 "inelastic strain"},
{"ei_rz", "-", ELEM, FLOW(SCENE_AXI), "ei_rz", 3, inelastic, NULL,
 "inelastic shear strain, engineering"},
{"alpha_1", "-", ELEM, ALPHA, "alpha_1", 0, internal, NULL,
 "internal variable of the law, in its unit"},
{"alpha_2", "-", ELEM, ALPHA, "alpha_2", 1, internal, NULL,
 "internal variable of the law, in its unit"},
{"alpha_3", "-", ELEM, ALPHA, "alpha_3", 2, internal, NULL,
 "internal variable of the law, in its unit"},
{"alpha_4", "-", ELEM, ALPHA, "alpha_4", 3, internal, NULL,
 "internal variable of the law, in its unit"},
{"alpha_5", "-", ELEM, ALPHA, "alpha_5", 4, internal, NULL,
 "internal variable of the law, in its unit"},
{"alpha_6", "-", ELEM, ALPHA, "alpha_6", 5, internal, NULL,
 "internal variable of the law, in its unit"},
{"alpha_7", "-", ELEM, ALPHA, "alpha_7", 6, internal, NULL,
 "internal variable of the law, in its unit"},
{"alpha_8", "-", ELEM, ALPHA, "alpha_8", 7, internal, NULL,
 "internal variable of the law, in its unit"},
{"alpha_9", "-", ELEM, ALPHA, "alpha_9", 8, internal, NULL,
 "internal variable of the law, in its unit"},
{"alpha_10", "-", ELEM, ALPHA, "alpha_10", 9, internal, NULL,
 "internal variable of the law, in its unit"},
{"alpha_11", "-", ELEM, ALPHA, "alpha_11", 10, internal, NULL,
 "internal variable of the law, in its unit"},
{"alpha_12", "-", ELEM, ALPHA, "alpha_12", 11, internal, NULL,
 "internal variable of the law, in its unit"},

{"node_no", "-", PER_CONTACT_NODE, AS_COUNT, PRINT_CONTACT, C, SUR, NULL, 0,
 contact_node_no, NULL, "number in the mesh"},
{"x", "length", CON, PRINT_CONTACT, C, CART,
 NEEDS_PLACE, NULL, 0, contact_x, NULL, "coordinate"},
{"r", "length", CON, PRINT_CONTACT, C, SCENE_AXI, NEEDS_PLACE, NULL, 0,
 contact_x, NULL, "coordinate"},
{"y", "length", CON, PRINT_CONTACT, C, CART,
 NEEDS_PLACE, NULL, 1, contact_x, NULL, "coordinate"},
{"z", "length", CON, PRINT_CONTACT, C, SCENE_AXI, NEEDS_PLACE, NULL, 1,
 contact_x, NULL, "coordinate"},
{"z", "length", CON, PRINT_CONTACT, C, SCENE_SOLID, NEEDS_PLACE, NULL, 2,
 contact_x, NULL, "coordinate"},
{"area", "length^2", CON, 0, C, PLACE, "area", 0, contact_area, NULL,
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
{"pressure", PA, CON, PRINT_CONTACT, C, PLACE, "pressure", 0, contact_pressure,
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
{"slip", "length", CON, PRINT_CONTACT, F, SCENE_FLAT, NEEDS_SURFACE, "slip",
 0, contact_slip, NULL,
 "slip of the increment; *STATIC: from the origin"},
{"slip_1", "length", CON, PRINT_CONTACT, F, SCENE_SOLID, NEEDS_SURFACE,
 "slip_1", 0, contact_slip, NULL,
 "slip of the increment; *STATIC: from the origin"},
{"slip_2", "length", CON, PRINT_CONTACT, F, SCENE_SOLID, NEEDS_SURFACE,
 "slip_2", 1, contact_slip, NULL,
 "slip of the increment; *STATIC: from the origin"},
{"slip_distance", "length", CON, PRINT_CONTACT, F, SCENE_ALL, NEEDS_DISTANCE,
 "slip_distance", 0, slip_distance, NULL, "length of all slip so far"},
{"slip_dir_x", "-", CON, SLIDES(CART), NULL, 0, slip_direction, NULL,
 "direction of the slip, 0 where there is none"},
{"slip_dir_r", "-", CON, SLIDES(SCENE_AXI), NULL, 0, slip_direction, NULL,
 "direction of the slip, 0 where there is none"},
{"slip_dir_y", "-", CON, SLIDES(CART), NULL, 1, slip_direction, NULL,
 "direction of the slip, 0 where there is none"},
{"slip_dir_z", "-", CON, SLIDES(SCENE_AXI), NULL, 1, slip_direction, NULL,
 "direction of the slip, 0 where there is none"},
{"slip_dir_z", "-", CON, SLIDES(SCENE_SOLID), NULL, 2, slip_direction, NULL,
 "direction of the slip, 0 where there is none"},
{"limit", "force", CON, PRINT_CONTACT, F, SCENE_ALL,
 NEEDS_SURFACE | NEEDS_LIMIT, "limit", 0, sliding_limit, NULL,
 "sliding limit"},
{"status", "-", PER_CONTACT_NODE, AS_WORD, PRINT_CONTACT, C, SUR, "status", 0,
 contact_state, contact_word, "OPEN, SLIP, STICK; as number 0, 1, 2"},

{"row_no", "-", PER_CONTACT_NODE, AS_COUNT, PRINT_CONTACT, C, SCENE_LCP,
 NEEDS_SURFACE, NULL, 0, contact_node_no, NULL, "row of the matrix"},
{"z", "-", CON, PRINT_CONTACT, C, SCENE_LCP, NEEDS_SURFACE, NULL, 0, lcp_z,
 NULL, "unknown of w = q + M z"},
{"w", "-", CON, PRINT_CONTACT, C, SCENE_LCP, NEEDS_SURFACE, NULL, 0, lcp_w,
 NULL, "q + M z"},

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
{"time", "time", LOOP, SCENE_ALL, NEEDS_LOOP, NULL, 0, time_now, NULL,
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
{NULL, NULL, INC, 0, 0, 0, 0, NULL, 0, NULL, NULL, NULL}};
/* clang-format on */

unsigned scene_of(const model *m) {
  if (m->dim == 3) return SCENE_SOLID;
  if (m->dim == 1) return SCENE_LCP;
  for (int i = 0; i < m->n_section; ++i)
    if (m->sections[i].kin % 4 == AXISYMMETRIC) return SCENE_AXI;
  return SCENE_PLANE;
}

/* The most internal variables that a law of the model has. */
static int most_internal(const model *m) {
  int most = 0;
  for (int i = 0; i < m->n_material; ++i) {
    const law_card *law = &m->materials[i].law;
    if (!m->materials[i].used || law->ops == NULL) continue;
    int n = law_n_alpha(law, m->ns);
    if (n > most) most = n;
  }
  return most;
}

/* 1 unless its tables are ones that only *PRINT brings about. */
static int is_asked(const column *c, const model *m) {
  const unsigned extra = PRINT_ZONES | PRINT_LOOP;
  if ((c->needs & NEEDS_TORQUE) != 0 && !model_has_axis(m)) return 0;
  if ((c->needs & NEEDS_ALPHA) != 0 && c->part >= most_internal(m)) return 0;
  if (c->tables == 0 || (c->tables & ~extra) != 0) return 1;
  return model_prints(m, (int)c->tables);
}

int column_visible(const column *c, const model *m) {
  return is_asked(c, m) && (c->effects & ~m->effects) == 0 &&
         (c->scenes & scene_of(m)) != 0;
}

static unsigned if_there(const void *p, unsigned bits) {
  return p != NULL ? bits : 0;
}

int column_ready(const column *c, const state *s) {
  unsigned have = 0;
  have |= if_there(s->strain, NEEDS_STRAIN);
  have |= if_there(s->stress, NEEDS_STRESS);
  have |= if_there(s->reaction, NEEDS_REACTION);
  have |= if_there(s->surface, NEEDS_SURFACE);
  if (s->surface != NULL && s->surface->x != NULL) have |= NEEDS_PLACE;
  have |= if_there(s->limit, NEEDS_LIMIT);
  have |= if_there(s->totals, NEEDS_TOTALS);
  have |= if_there(s->distance, NEEDS_DISTANCE);
  have |= if_there(s->torque, NEEDS_TORQUE);
  have |= if_there(s->loops, NEEDS_LOOP);
  have |= if_there(s->zones, NEEDS_ZONES);
  have |= if_there(s->elem_error, NEEDS_ELEM_ERROR);
  have |= if_there(s->flow, NEEDS_FLOW | NEEDS_ALPHA);
  return (c->needs & ~have) == 0;
}

int column_items(entity of, const view *v) {
  switch (of) {
    case PER_NODE:
      return v->msh->n_node;
    case PER_ELEMENT:
      return v->msh->n_elem;
    case PER_CONTACT_NODE:
      return v->s->surface != NULL ? v->s->surface->n : 0;
    case PER_CONTACT:
      return v->m->n_contact;
    case PER_ZONE:
      return v->s->n_zone;
    default:
      return 1;
  }
}

void column_unit(const char *unit, const model *m, char *text, size_t size) {
  const char *const words[] = {"length", "force", "time"};
  const char *const labels[] = {m->length_unit, m->force_unit, m->time_unit};
  size_t used = 0;
  text[0] = '\0';
  while (*unit != '\0' && used + 1 < size) {
    int k = 0;
    while (k < 3 && strncmp(unit, words[k], strlen(words[k])) != 0) ++k;
    int known = k < 3 && labels[k] != NULL;
    int n = known ? snprintf(text + used, size - used, "%s", labels[k])
                  : snprintf(text + used, size - used, "%c", *unit);
    unit += known ? strlen(words[k]) : 1;
    used += (size_t)n;
  }
}
