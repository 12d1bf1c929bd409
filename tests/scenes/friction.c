/*
 * Friction from none to sticking, above the limit of uniqueness, wedged, on
 * paths that jump, reversed, and cycled. G = 500 in the sheared block: it
 * sticks up to a shear of mu p and slides as one above (uniform strain).
 */
#include "scenes/cards.h"
#include "scenes/scenes.h"

/* Block, nu = 0, pressed by 10 and moved by 0.01 at its top; the shear tau on
 * its sides belongs to the answer u_x = 0.01 + tau (y - 1) / 500. */
#define SHEARED(mu, tau)  \
  MATERIAL("1000.", "0.") \
  FLOOR(mu) QUASI("0.5", "1.") "*BOUNDARY\nTOP, 1, 1, 0.01\n"       \
  "TOP, 2, 2, -0.01\n*DSLOAD\nRIGHT, TY, " tau "\nLEFT, TY, -" tau  \
  "\n" END
#define SHEARED_TO(tau)                                \
  "NODES u_x = 0.01 + " tau                            \
  "*(y - 1)/500 ~ 1e-9;"                               \
  "NODES u_y = -0.01*y ~ 1e-9; TOTALS force_x = -" tau \
  " ~ 1e-6;"                                           \
  "TOTALS force_y = 10 ~ 1e-6"

#define COS17 "0.9563047559630354"
#define SIN17 "0.2923717047227367"

/* Two clamped vertices, the third on the plane, E = 1, nu = 0.3:
 * K = [[45, -25], [-25, 45]]/52. */
#define ONE_TRIANGLE "triangle -1 1 1 3 0 0"
#define TRIANGLE_ON(height, mu)                                              \
  MATERIAL("1.", "0.3")                                                      \
  "*OBSTACLE, NAME=O, TYPE=PLANE\n0., " height                               \
  "\n0., 1.\n"                                                               \
  "*CONTACT, NAME=C, GROUP=FOOT, OBSTACLE=O, NORMAL=OBSTACLE\n" COULOMB("C", \
                                                                        mu)
#define TRIANGLE(mu, fx, fy)           \
  TRIANGLE_ON("0.", mu)                \
  STATIC                               \
  "*BOUNDARY\nCLAMPED, 1, 2\n*CLOAD\n" \
  "TIP, 1, " fx "\nTIP, 2, " fy "\n" END
#define TIP_AT(x) "NODES u_x @y=0 = " x " ~ 1e-8"

/* The triangle of Hild with one element: uniform strain, all its base slides;
 * unique below mu = 3. */
#define HILD(mu) \
  "*PARAMETER\nTXX = -0.02400456223855\nTYY = -0.00158113883008\n"  \
  MATERIAL("1.", "0.1")                                               \
  "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n"                   \
  "*CONTACT, NAME=C, GROUP=FOOT, OBSTACLE=O, NORMAL=OBSTACLE\n"       \
  COULOMB("C", mu) STATIC                                             \
  "*BOUNDARY\nCLAMPED, 1, 1, \"0.002*x-0.055*y-0.02\"\n"              \
  "CLAMPED, 2, 2, \"-0.01*y\"\n*DSLOAD\nSIDE, TX, <TXX>\n"            \
  "SIDE, TY, <TYY>\n" END
#define HILD_MESH "triangle 1 0 0.8 0.26666666666666666 0 0"

/* The top goes to and fro by 0.01, the shear on the sides follows the loop of
 * a slider of limit 3 behind a spring 500; ends at its right end. */
#define CYCLES(total) \
  "*AMPLITUDE, NAME=MOVE\n\"if(mod(t+1, 4) < 2, mod(t+1, 4)-1, "         \
  "3-mod(t+1, 4))\"\n*AMPLITUDE, NAME=SHEAR\n"                           \
  "\"if(t<1, min(3, 5*t), if(mod(t+1, 4)<2, min(3, 5*mod(t+1, 4)-3), "   \
  "max(-3, 3-5*(mod(t+1, 4)-2))))\"\n" MATERIAL("1000.", "0.")           \
  FLOOR("0.3") QUASI("1.", "1.") "*BOUNDARY\nTOP, 1, 1, 0.\n"            \
  "TOP, 2, 2, -0.01\n*END STEP\n" QUASI("0.2", total)                    \
  "*BOUNDARY\nTOP, 1, 1, 0.01, MOVE\n*DSLOAD\nRIGHT, TY, 1., SHEAR\n"    \
  "LEFT, TY, -1., SHEAR\n" LAST

/* clang-format off */
const scene_row friction_scenes[] = {
  {.name = "shear mu=0", .hard = "no friction",
   .mesh = "rect 4 4 1 1", .deck = SHEARED("0.", "0."),
   .expect = SHEARED_TO("0")},
  {.name = "shear mu=1e-8", .hard = "friction of the size of rounding",
   .mesh = "rect 4 4 1 1", .deck = SHEARED("1.E-8", "1.E-7"),
   .expect = SHEARED_TO("1e-7")},
  {.name = "shear mu=0.3 slides", .hard = "every node at its limit",
   .flags = QUICK, .mesh = "rect 4 4 1 1", .deck = SHEARED("0.3", "3."),
   .expect = SHEARED_TO("3")},
  {.name = "shear mu=0.5 exactly at the limit", .hard = "zero slip at limit",
   .flags = QUICK, .mesh = "rect 4 4 1 1", .deck = SHEARED("0.5", "5."),
   .expect = SHEARED_TO("5")},
  {.name = "shear mu=1", .hard = "stick", .mesh = "rect 4 4 1 1 alternate",
   .deck = SHEARED("1.", "5."), .expect = SHEARED_TO("5")},
  {.name = "shear mu=5", .hard = "stick, large friction",
   .mesh = "rect 4 4 1 1", .deck = SHEARED("5.", "5."),
   .expect = SHEARED_TO("5")},
  {.name = "shear mu=20", .hard = "stick, large friction",
   .mesh = "rect 4 4 1 1", .deck = SHEARED("20.", "5."),
   .expect = SHEARED_TO("5")},
  {.name = "shear mu=1e6", .hard = "stick at any price", .flags = QUICK,
   .mesh = "rect 4 4 1 1", .deck = SHEARED("1.E6", "5."),
   .expect = SHEARED_TO("5")},
  {.name = "shear 3-D at 17 degrees", .hard = "cone, no pyramid",
   .mesh = "box 3 3 2 1 1 1", .flags = QUICK,
   .deck = MATERIAL("1000.", "0.")
     PLANE("C", "BOTTOM", "0., 0., 0.", "0., 0., 1.") COULOMB("C", "0.3")
     QUASI("1.", "1.") "*BOUNDARY\nTOP, 1, 1, \"0.01*" COS17 "\"\n"
     "TOP, 2, 2, \"0.01*" SIN17 "\"\nTOP, 3, 3, -0.01\n"
     "*DSLOAD\nRIGHT, TZ, \"3*" COS17 "*t\"\nLEFT, TZ, \"-3*" COS17 "*t\"\n"
     "BACK, TZ, \"3*" SIN17 "*t\"\nFRONT, TZ, \"-3*" SIN17 "*t\"\n" END,
   .expect = "NODES u_x = (0.004+0.006*z)*" COS17 " ~ 1e-9;"
     "NODES u_y = (0.004+0.006*z)*" SIN17 " ~ 1e-9;"
     "TOTALS force_z = 10 ~ 1e-6"},
  {.name = "one triangle sticks", .hard = "one node",
   .flags = NO_LAWS, .mesh = ONE_TRIANGLE, .deck = TRIANGLE("1.", "0.", "-1."),
   .expect = "NODES u_x = 0 ~ 1e-10; TOTALS force_y = 1 ~ 1e-9"},
  {.name = "one triangle slides back", .hard = "slip against a lifting force",
   .flags = QUICK, .mesh = ONE_TRIANGLE, .deck = TRIANGLE("1.", "-1.", "0.3"),
   .expect = TIP_AT("-0.9657142857142857")
     ";TOTALS force_y = 0.1642857142857143 ~ 1e-8"},
  {.name = "one triangle opens", .hard = "contact lost by shear",
   .mesh = ONE_TRIANGLE, .deck = TRIANGLE("1.", "1.9", "-1."),
   .expect = TIP_AT("2.2471428571428571")},
  {.name = "one triangle, no load", .hard = "zero load",
   .mesh = ONE_TRIANGLE, .deck = TRIANGLE("1.", "0.", "0."),
   .expect = "NODES u_x = 0 ~ 0; NODES u_y = 0 ~ 0; CONTACT f_n = 0 ~ 0"},
  {.name = "one triangle grazes", .hard = "closed with zero force",
   .flags = QUICK, .mesh = ONE_TRIANGLE,
   .deck = TRIANGLE("1.", "0.865384615384615385", "-0.480769230769230769"),
   .expect = TIP_AT("1") ";NODES u_y = 0 ~ 1e-9; CONTACT ^f_n = 0 ~ 1e-9"},
  {.name = "one triangle mu=1.7, below critical", .hard = "nearly not unique",
   .mesh = ONE_TRIANGLE, .deck = TRIANGLE("1.7", "1.9", "-1."),
   .expect = TIP_AT("2.2471428571428571")},
  {.name = "one triangle mu=2, three solutions", .hard = "not unique",
   .flags = QUICK, .mesh = ONE_TRIANGLE, .deck = TRIANGLE("2.", "1.9", "-1."),
   .expect = TIP_AT("2.2471428571428571 or 0 or 1.04")},
  {.name = "one triangle mu=3, three solutions", .hard = "not unique",
   .mesh = ONE_TRIANGLE, .deck = TRIANGLE("3.", "1.9", "-1."),
   .expect = TIP_AT("2.2471428571428571 or 0 or 1.9066666666666667")},
  {.name = "one triangle mu=20, three solutions", .hard = "not unique",
   .mesh = ONE_TRIANGLE, .deck = TRIANGLE("20.", "1.9", "-1."),
   .expect = TIP_AT("2.2471428571428571 or 0 or 18.1/8.75")},
  {.name = "one triangle mu=1e6, three solutions", .hard = "not unique",
   .mesh = ONE_TRIANGLE, .deck = TRIANGLE("1.E6", "1.9", "-1."),
   .expect = TIP_AT("2.2471428571428571 or 0 or "
     "(1E6 - 1.9)/(25E6/52 - 45/52)")},
  {.name = "wedged at mu=1", .hard = "forces without load", .flags = QUICK,
   .mesh = ONE_TRIANGLE, .deck = TRIANGLE_ON("0.1", "1.") STATIC
     "*BOUNDARY\nCLAMPED, 1, 2\n" END,
   .expect = TIP_AT("0") ";TOTALS force_y = 4.5/52 ~ 1e-9;"
     "TOTALS force_x = -2.5/52 ~ 1e-9"},
  {.name = "not wedged at mu=0.3", .hard = "penetration that slides off",
   .mesh = ONE_TRIANGLE, .deck = TRIANGLE_ON("0.1", "0.3") STATIC
     "*BOUNDARY\nCLAMPED, 1, 2\n" END,
   .expect = TIP_AT("1.15/37.5")},
  {.name = "jump on a path, mu=2", .hard = "no path of equilibria",
   .mesh = ONE_TRIANGLE, .flags = QUICK,
   .deck = TRIANGLE_ON("0.", "2.") QUASI("1.", "1.")
     "*BOUNDARY\nCLAMPED, 1, 2\n*CLOAD\nTIP, 2, -1.\n*END STEP\n"
     QUASI("0.05", "1.") "*CLOAD\nTIP, 1, 3.3\n" LAST,
   .expect = TIP_AT("(45*3.3 - 25)*52/1400") ";sta has OK JUMP"},
  {.name = "no jump below critical, mu=1.7", .hard = "opens on a path",
   .mesh = ONE_TRIANGLE, .flags = QUICK,
   .deck = TRIANGLE_ON("0.", "1.7") QUASI("1.", "1.")
     "*BOUNDARY\nCLAMPED, 1, 2\n*CLOAD\nTIP, 2, -1.\n*END STEP\n"
     QUASI("0.05", "1.") "*CLOAD\nTIP, 1, 3.3\n" LAST,
   .expect = TIP_AT("(45*3.3 - 25)*52/1400") ";sta lacks JUMP"},
  {.name = "Hild mu=0.5", .hard = "slips all along", .mesh = HILD_MESH,
   .deck = HILD("0.5"), .expect = "NODES u_x @x=0 = -0.0904 ~ 1e-9"},
  {.name = "Hild mu=1", .hard = "slips all along", .mesh = HILD_MESH,
   .deck = HILD("1."),
   .expect = "NODES u_x @x=0 = -0.086 ~ 1e-9"},
  {.name = "Hild mu=2", .hard = "near the limit of uniqueness",
   .mesh = HILD_MESH, .deck = HILD("2."),
   .expect = "NODES u_x @x=0 = -0.064 ~ 1e-9"},
  {.name = "Hild mu=2.59", .hard = "nearly sticks, nearly not unique",
   .mesh = HILD_MESH, .deck = HILD("2.59"),
   .expect = "NODES u_x @x=0 = -0.02 - 0.8*11*0.01*0.09/"
     "(2.59 - 3) ~ 1e-9"},
  {.name = "Hild mu=5", .hard = "above the limit of uniqueness",
   .mesh = HILD_MESH, .deck = HILD("5.")},
  {.name = "Hild mu=20", .hard = "above the limit of uniqueness",
   .mesh = HILD_MESH, .deck = HILD("20.")},
  {.name = "reversal, half a cycle", .hard = "unloads, slides back",
   .flags = QUICK, .mesh = "rect 2 2 1 1", .deck = CYCLES("3."),
   .expect = "NODES u_x = -0.01 - 3*(y - 1)/500 ~ 1e-9;"
     "CONTACT slip_distance = 0.012 ~ 1e-9;"
     "ENERGY energy_defect_relative = 0 ~ 1e-9"},
  {.name = "unloaded to no motion", .hard = "stress stays",
   .mesh = "rect 2 2 1 1", .deck = CYCLES("2."),
   .expect = "NODES u_x = 2*(1 - y)/500 ~ 1e-9"},
  {.name = "1005 increments of cycles", .hard = "drift over 50 cycles",
   .mesh = "rect 2 2 1 1", .deck = CYCLES("201."),
   .expect = "NODES u_x = 0.01 + 3*(y - 1)/500 ~ 1e-9;"
     "CONTACT slip_distance = 0.804 ~ 1e-7;"
     "ENERGY friction_work_end = 2.412 ~ 1e-6;"
     "ENERGY energy_defect_relative = 0 ~ 1e-9"},
  {.name = "10005 increments of cycles", .hard = "drift over 500 cycles",
   .mesh = "rect 2 2 1 1", .deck = CYCLES("2001."),
   .expect = "NODES u_x = 0.01 + 3*(y - 1)/500 ~ 1e-9;"
     "CONTACT slip_distance = 8.004 ~ 1e-6;"
     "ENERGY friction_work_end = 24.012 ~ 1e-5;"
     "ENERGY energy_defect_relative = 0 ~ 1e-9"},
  {.name = NULL}
};
/* clang-format on */
