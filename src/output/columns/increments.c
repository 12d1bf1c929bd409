/*
 * Columns with one value an increment.
 */
#include "run/column_row.h"

#include <math.h>

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
VALUE(limit_updates, v->s->report.limit_updates)
VALUE(residual, v->s->report.residual)
VALUE(bound_error, 100 * v->s->errors.error.relative)
VALUE(solver_error_energy, v->s->errors.error.energy)
VALUE(contraction, v->s->errors.error.rate)
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

/* clang-format off */
#define INC_N PER_INCREMENT, AS_COUNT
const column increment_columns[] = {
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
OF_EFFECTS,
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
 "dissipated of it by the laws so far, in the quadrature of the integrator"},
{"inelastic_stored", J, INC, PRINT_ENERGY, ON(INELASTIC), ANY,
 "inelastic_stored", 0, inelastic_stored, NULL,
 "stored of it by the internal variables"},
{"energy_defect", J, INC, PRINT_ENERGY, 0, ANY, "energy_defect", 0,
 energy_defect, NULL,
 "external + normal - friction - thermal - inelastic work - strain"},
{"energy_defect_relative", "-", INC, PRINT_ENERGY, 0, ANY,
 "energy_defect_relative", 0, defect_relative, NULL,
 "the defect over the largest of the energies so far"},
NO_COLUMN};
/* clang-format on */
