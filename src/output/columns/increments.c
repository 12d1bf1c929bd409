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
OF_EFFECTS(1),
{"residual", "-", INC, 0, C, ANY, "residual", 0, residual, NULL,
 "residual of the contact problem"},
OF_EFFECTS(0),
OF_EFFECTS(2),
{"strain_energy", J, INC, PRINT_ENERGY, 0, ANY, "strain_energy", 0,
 strain_energy, NULL, "elastic energy stored"},
{"external_work", J, INC, PRINT_ENERGY, 0, ANY, "external_work", 0,
 external_work, NULL, "work of loads and supports so far"},
OF_EFFECTS(3),
{"normal_work", J, INC, PRINT_ENERGY, C, ANY, "normal_work", 0,
 normal_work, NULL, "work of the normal contact forces so far, trapezoidal: "
 "moving obstacles, and gaps that open or close within an increment"},
OF_EFFECTS(4),
OF_EFFECTS(5),
{"energy_defect", J, INC, PRINT_ENERGY, 0, ANY, "energy_defect", 0,
 energy_defect, NULL,
 "external + normal - friction - thermal - inelastic work - strain"},
{"energy_defect_relative", "-", INC, PRINT_ENERGY, 0, ANY,
 "energy_defect_relative", 0, defect_relative, NULL,
 "the defect over the largest of the energies so far"},
NO_COLUMN};
/* clang-format on */
