/*
 * Increments without load, of no length, at the limit of stability, far below
 * and above the relaxation time.
 */
#include "scenes/cards.h"
#include "scenes/scenes.h"

#define MAXWELL(tau)                                 \
  "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n"         \
  "*INELASTIC, LAW=MAXWELL, TYPE=PROPORTIONAL\n" tau \
  "\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
/* Pressed by 1: the strain grows by itself in each tau = 2. */
#define CREEPS(words, dt, total)                                          \
  MAXWELL("2.")                                                           \
  FLOOR("0.3")                                                            \
  STATIC "*BOUNDARY\nLEFT, 1\n*DSLOAD\nTOP, P, 1.\n" END VISCO(words, dt, \
                                                               total) LAST
/* Strain held at 1e-3 from the first step on; a wall stands far away. */
#define RELAXES(words, dt, total) \
  MAXWELL("2.") PLANE("C", "LEFT", "-1., 0.", "1., 0.")                 \
  COULOMB("C", "0.3") STATIC "*BOUNDARY\nBOTTOM, 2\nCORNER, 1\n"        \
  "TOP, 2, 2, -0.001\n" END VISCO(words, dt, total)                     \
  "*PRINT, CONTACT, NODES, ENERGY, ELEMENTS, FREQUENCY=0\n*END STEP\n"
/* Two layers side by side under a strain of 1e-3, which relax in 1e-15 and
 * 1e15; a floor far below. */
#define DECADES(words) \
  "*MATERIAL, NAME=S\n*ELASTIC\n1000., 0.\n*INELASTIC, LAW=MAXWELL\n1.E-15\n" \
  "*MATERIAL, NAME=H\n*ELASTIC\n1000., 0.\n*INELASTIC, LAW=MAXWELL\n1.E15\n"  \
  "*SOLID SECTION, ELSET=SOFT, MATERIAL=S\n"                                 \
  "*SOLID SECTION, ELSET=HARD, MATERIAL=H\n"                                 \
  PLANE("C", "BOTTOM", "0., -1.", "0., 1.") COULOMB("C", "0.3") STATIC       \
  "*BOUNDARY\nLEFT, 1\nCORNER, 2\nRIGHT, 1, 1, -0.001\n" END                 \
  VISCO(words, "1.", "10.") "*PRINT, CONTACT, NODES, ENERGY, ELEMENTS, "     \
  "FREQUENCY=0\n*END STEP\n"
/* One layer on the other under a pressure of 1; the lower relaxes in 1. */
#define SINKS(dt) \
  "*MATERIAL, NAME=S\n*ELASTIC\n1000., 0.\n*INELASTIC, LAW=MAXWELL, "       \
  "TYPE=PROPORTIONAL\n1.\n*MATERIAL, NAME=H\n*ELASTIC\n1000., 0.\n"        \
  "*SOLID SECTION, ELSET=SOFT, MATERIAL=S\n"                                \
  "*SOLID SECTION, ELSET=HARD, MATERIAL=H\n" FLOOR("0.3") STATIC            \
  "*BOUNDARY\nLEFT, 1\n*DSLOAD\nTOP, P, 1.\n*END STEP\n"                   \
  VISCO("INTEGRATOR=BACKWARD", dt, dt) "*PRINT, CONTACT, NODES, ENERGY, "    \
  "ELEMENTS, FREQUENCY=0\n*END STEP\n"
#define LAYER_STRESS "ELEMENTS stress_xx = if(y < 0.5, 0, -1) ~ 1e-9"
#define STRESS(value, tol) "ELEMENTS stress_yy = -(" value ") ~ " tol

/* clang-format off */
const scene_row time_scenes[] = {
  {.name = "increments without load", .hard = "nothing happens",
   .flags = QUICK, .mesh = "rect 4 4 1 1", .deck = MATERIAL("1000.", "0.3")
     FLOOR("0.5") QUASI("0.25", "1.") "*BOUNDARY\nLEFT, 1\n" END,
   .expect = "NODES u_x = 0 ~ 0; NODES u_y = 0 ~ 0; CONTACT f_n = 0 ~ 0"},
  {.name = "load repeated 100 times", .hard = "nothing changes",
   .mesh = "rect 4 4 1 1", .deck = MATERIAL("1000.", "0.")
     FLOOR("0.3") QUASI("1.", "1.") "*BOUNDARY\nTOP, 1, 1, 0.01\n"
     "TOP, 2, 2, -0.01\n*DSLOAD\nRIGHT, TY, 3.\nLEFT, TY, -3.\n*END STEP\n"
     QUASI("0.01", "1.") LAST,
   .expect = "NODES u_x = 0.01 + 3*(y - 1)/500 ~ 1e-9;"
     "CONTACT slip_distance = 0.004 ~ 1e-9"},
  {.name = "increment of no length", .hard = "refused", .flags = QUICK,
   .mesh = "rect 2 2 1 1", .verdict = 2,
   .deck = MATERIAL("1000.", "0.3") FLOOR("0.5") QUASI("0.", "1.")
     "*BOUNDARY\nLEFT, 1\n" END, .expect = "errors has P20"},
  {.name = "step of no length", .hard = "refused",
   .mesh = "rect 2 2 1 1", .verdict = 2,
   .deck = MATERIAL("1000.", "0.3") FLOOR("0.5") QUASI("0.1", "0.")
     "*BOUNDARY\nLEFT, 1\n" END, .expect = "errors has P20"},
  {.name = "creep under constant load", .hard = "exact for all integrators",
   .flags = QUICK, .mesh = "rect 3 3 1 1", .deck = CREEPS("@I", "0.5", "2."),
   .expect = "NODES u_y = -0.002*y ~ 1e-10; TOTALS normal = 1 ~ 1e-8"},
  {.name = "creep, 1000 increments", .hard = "drift of sums",
   .mesh = "rect 2 2 1 1", .deck = CREEPS("@I", "0.01", "10."),
   .expect = "NODES u_y = -0.006*y ~ 1e-9;"
     "ENERGY energy_defect_relative = 0 ~ 1e-9"},
  {.name = "creep, 10000 increments", .hard = "drift of the balance",
   .mesh = "rect 2 2 1 1",
   .deck = CREEPS("INTEGRATOR=MIDPOINT", "0.001", "10."),
   .expect = "NODES u_y = -0.006*y ~ 1e-8;"
     "ENERGY energy_defect_relative = 0 ~ 1e-9"},
  {.name = "30 decades of relaxation times", .hard = "1e-15 and 1e15 times dt",
   .flags = QUICK, .mesh = "rect 4 4 1 1 layers",
   .deck = DECADES("INTEGRATOR=BACKWARD"), .expect = LAYER_STRESS},
  {.name = "30 decades, exact steps", .hard = "1e-15 and 1e15 times dt",
   .mesh = "rect 4 4 1 1 layers", .deck = DECADES("INTEGRATOR=EXPONENTIAL"),
   .expect = LAYER_STRESS},
  {.name = "30 decades, explicit", .hard = "no increment is small enough",
   .mesh = "rect 4 4 1 1 layers", .verdict = 2,
   .deck = DECADES("INTEGRATOR=HEUN"),
   .expect = "errors has P2050"},
  {.name = "sinks by 1e9 elastic strains", .hard = "seven digits left",
   .mesh = "rect 6 8 1 1 layers", .deck = SINKS("1.E9"), .flags = QUICK,
   .expect = "ELEMENTS stress_yy = -1 ~ 1e-5; lst has rounding:"},
  {.name = "sinks by 1e13 elastic strains", .hard = "two digits left",
   .mesh = "rect 6 8 1 1 layers", .deck = SINKS("1.E13"), .flags = NO_LAWS,
   .expect = "ELEMENTS stress_yy = -1 ~ 0.03; lst has E-001 % of the largest|"
     "E-002 % of the largest"},
  {.name = "sinks by 1e16 elastic strains", .hard = "no digit left",
   .mesh = "rect 6 8 1 1 layers", .deck = SINKS("1.E16"), .flags = QUICK,
   .verdict = 6, .expect = "errors has rounding leaves no correct digit"},
  {.name = "led to the touch by every integrator", .hard = "no stress at all",
   .mesh = "rect 3 3 1 1", .flags = QUICK | NO_LAWS,
   .deck = MAXWELL("2.") PLANE("C", "BOTTOM", "0., -0.125", "0., 1.")
     COULOMB("C", "0.3") VISCO("@I", "0.25", "0.5") "*BOUNDARY\nLEFT, 1\n"
     "TOP, 2, 2, -0.125\n" LAST,
   .expect = "NODES u_y = -0.125 ~ 1e-12; CONTACT ^f_n = 0 ~ 1e-9"},
  {.name = "led to the touch, TOLERANCE", .hard = "strains are rounding",
   .mesh = "rect 3 3 1 1", .flags = QUICK | NO_LAWS,
   .change = {.map = {"x + 0.1*x*(1 - x)*y", "y + 0.1*y*(1 - y)*x"}},
   .deck = MAXWELL("2.") PLANE("C", "BOTTOM", "0., -0.7", "0., 1.")
     COULOMB("C", "0.3") VISCO("@I, TOLERANCE=1.E-4", "0.25", "1.")
     "*BOUNDARY\nTOP, 1, 1, 0.3\nTOP, 2, 2, -0.7\n" LAST,
   .expect = "NODES u_y = -0.7 ~ 1e-12; CONTACT ^f_n = 0 ~ 1e-9"},
  {.name = "led to the contact, TIME=BALANCED", .hard = "strains are rounding",
   .mesh = "rect 3 3 1 1 alternate", .flags = QUICK,
   .deck = MATERIAL("1000.", "0.") PLANE("C", "BOTTOM", "0., -0.7", "0., 1.")
     COULOMB("C", "0.3") "*STEP\n*QUASISTATIC@V\n0.3, 1., 1.E-4\n@S"
     "*ACCURACY, MESH=YES, TIME=BALANCED\n*BOUNDARY\nTOP, 1, 1, 0.\n"
     "TOP, 2, 2, -0.75\n" LAST,
   .expect = "NODES u_y = -0.7 - 0.05*y ~ 1e-9; TOTALS normal = 50 ~ 1e-5"},
  {.name = "shortest increment, error above", .hard = "0.03 is not 0.33 - 0.3",
   .mesh = "rect 3 3 1 1", .flags = QUICK, .verdict = 1,
   .deck = MAXWELL("2.") FLOOR("0.3")
     "*STEP\n*VISCO, INTEGRATOR=BACKWARD, TOLERANCE=1.E-9\n0.25, 1., 0.03\n"
     "*BOUNDARY\nTOP, 1\nTOP, 2, 2, -0.01\n" LAST,
   .expect = "errors has missed the tolerance; NODES u_y = -0.01*y ~ 1e-12"},
  {.name = "shortest increment, balanced", .hard = "0.03 is not 0.33 - 0.3",
   .mesh = "rect 6 4 1 1 alternate", .flags = QUICK,
   .deck = MATERIAL("1000.", "0.3") FLOOR("0.3")
     "*STEP\n*QUASISTATIC@V\n0.25, 1., 0.03\n@S"
     "*ACCURACY, MESH=YES, TIME=BALANCED, TIME_SHARE=0.001\n*BOUNDARY\n"
     "TOP, 1, 1, \"0.02*sin(9*t)\"\nTOP, 2, 2, -0.02\n" LAST},
  {.name = "Euler at 1.99 tau", .hard = "just stable",
   .mesh = "rect 2 2 1 1",
   .deck = RELAXES("INTEGRATOR=EULER", "3.98", "398."),
   .expect = STRESS("0.99^100", "1e-8")},
  {.name = "Euler at 2.01 tau", .hard = "just not stable",
   .mesh = "rect 2 2 1 1", .verdict = 2,
   .deck = RELAXES("INTEGRATOR=EULER", "4.02", "402."),
   .expect = "errors has P2050"},
  {.name = "Heun at 1.99 tau", .hard = "just stable",
   .mesh = "rect 2 2 1 1",
   .deck = RELAXES("INTEGRATOR=HEUN", "3.98", "398."),
   .expect = STRESS("(1 - 1.99 + 1.99^2/2)^100", "1e-8")},
  {.name = "Heun at 2.01 tau", .hard = "just not stable",
   .mesh = "rect 2 2 1 1", .verdict = 2,
   .deck = RELAXES("INTEGRATOR=HEUN", "4.02", "402."),
   .expect = "errors has P2050"},
  {.name = "implicit Euler, dt = 1e-6 tau", .hard = "tiny increment",
   .mesh = "rect 2 2 1 1",
   .deck = RELAXES("INTEGRATOR=BACKWARD", "2.E-6", "2.E-5"),
   .expect = STRESS("(1 + 1e-6)^(-10)", "1e-10")},
  {.name = "implicit Euler, dt = tau", .hard = "large increment",
   .mesh = "rect 2 2 1 1",
   .deck = RELAXES("INTEGRATOR=BACKWARD", "2.", "20."),
   .expect = STRESS("2^(-10)", "1e-10")},
  {.name = "implicit Euler, dt = 1e6 tau", .hard = "huge increment",
   .mesh = "rect 2 2 1 1", .flags = QUICK,
   .deck = RELAXES("INTEGRATOR=BACKWARD", "2.E6", "2.E6"),
   .expect = STRESS("1/(1 + 1e6)", "1e-10")},
  {.name = "midpoint, dt = 1e-6 tau", .hard = "tiny increment",
   .mesh = "rect 2 2 1 1",
   .deck = RELAXES("INTEGRATOR=MIDPOINT", "2.E-6", "2.E-5"),
   .expect = STRESS("((1 - 0.5e-6)/(1 + 0.5e-6))^10", "1e-10")},
  {.name = "midpoint, dt = 10 tau", .hard = "stress rings",
   .mesh = "rect 2 2 1 1",
   .deck = RELAXES("INTEGRATOR=MIDPOINT", "20.", "60."),
   .expect = STRESS("-(4/6)^3", "1e-9") ";errors has P2051"},
  {.name = "midpoint, dt = 1e6 tau", .hard = "stress rings undamped",
   .mesh = "rect 2 2 1 1",
   .deck = RELAXES("INTEGRATOR=MIDPOINT", "2.E6", "4.E6"),
   .expect = STRESS("((1 - 0.5e6)/(1 + 0.5e6))^2", "1e-8")
     ";errors has P2051"},
  {.name = "exponential, dt = 10 tau", .hard = "exact at any increment",
   .mesh = "rect 2 2 1 1",
   .deck = RELAXES("INTEGRATOR=EXPONENTIAL", "20.", "20."),
   .expect = STRESS("exp(-10)", "1e-10")},
  {.name = NULL}
};
/* clang-format on */
