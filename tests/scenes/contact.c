/*
 * Contact: none, all, just touching, from afar, from within, in corners and
 * hollows, and bodies that contact alone holds or nothing does.
 */
#include "scenes/cards.h"
#include "scenes/scenes.h"

/* nu = 0, E = 1000: the top of a block above a plane at -gap goes down. */
#define LOWERED(gap, dt, down)                \
  MATERIAL("1000.", "0.")                     \
  PLANE("C", "BOTTOM", "0., -" gap, "0., 1.") \
  COULOMB("C", "0.3")                         \
  QUASI(dt, "1.") "*BOUNDARY\nLEFT, 1\nTOP, 2, 2, -" down "\n" END
/* Pressed by 10 (and pushed from the left) without any support. */
#define LYING(mu, loads) \
  MATERIAL("1000.", "0.") FLOOR(mu) QUASI("0.5", "1.") "*DSLOAD\n" loads END
/* Between a ceiling and a plane 1e-3 below, heated by dT = 1000. */
#define HEATED(alpha, plane)                                           \
  "*MATERIAL, NAME=M\n*ELASTIC\n2.E5, 0.\n*EXPANSION\n" alpha          \
  "\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n" PLANE(                  \
      "C", "BOTTOM", "0., " plane, "0., 1.") COULOMB("C", "0.") STATIC \
      "*BOUNDARY\nTOP, 2\nCORNER, 1\n*TEMPERATURE\nBODY, 1000.\n" END
/* Pulled down by 5 towards a plane that it does not reach. */
#define HANGING(step)                        \
  MATERIAL("1000.", "0.")                    \
  PLANE("C", "BOTTOM", "0., -0.1", "0., 1.") \
  COULOMB("C", "0.4")                        \
  step "*BOUNDARY\nTOP, 2\nLEFT, 1\n*DSLOAD\nBOTTOM, P, -5.\n" END
#define ROUND(side, radius, height)                                 \
  "*OBSTACLE, NAME=O, TYPE=CYLINDER, RADIUS=" radius ", SIDE=" side \
  "\n0., " height "\n*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"

/* clang-format off */
const scene_row contact_scenes[] = {
  {.name = "grazes without force", .hard = "gap and force zero",
   .flags = NO_LAWS, .mesh = "rect 4 4 1 1",
   .deck = LOWERED("0.125", "0.5", "0.125"),
   .expect = "NODES u_y = -0.125 ~ 1e-12; CONTACT ^f_n = 0 ~ 1e-9;"
     "CONTACT gap = 0 ~ 1e-12"},
  {.name = "first touch at the end of an increment", .hard = "degenerate time",
   .flags = QUICK, .mesh = "rect 4 4 1 1",
   .deck = LOWERED("0.125", "0.25", "0.25"),
   .expect = "NODES.1 u_y = -0.125 ~ 1e-12; TOTALS.1 normal = 0 ~ 1e-9;"
     "TOTALS.2 normal = 62.5 ~ 1e-7; TOTALS.3 normal = 125 ~ 1e-7"},
  {.name = "gap 1e-12", .hard = "gap of the size of rounding",
   .mesh = "rect 4 4 1 1", .deck = LOWERED("1.E-12", "1.", "1.E-3"),
   .expect = "TOTALS normal = 1 ~ 1e-8"},
  {.name = "gap 1e-6", .hard = "small gap", .mesh = "rect 4 4 1 1",
   .deck = LOWERED("1.E-6", "1.", "1.E-3"),
   .expect = "TOTALS normal = 0.999 ~ 1e-8"},
  {.name = "gap of the size of the body", .hard = "large motion",
   .mesh = "rect 4 4 1 1", .deck = LOWERED("1.", "0.5", "1.001"),
   .expect = "CONTACT.0 ^f_n = 0 ~ 0; CONTACT.0 ^f_t = 0 ~ 0;"
     "TOTALS normal = 1 ~ 1e-7"},
  {.name = "gap of a thousand sizes", .hard = "strain is what is left of 1e3",
   .flags = QUICK, .mesh = "rect 4 4 1 1",
   .deck = LOWERED("1000.", "0.5", "1000.001"),
   .expect = "TOTALS normal = 1 ~ 1e-5"},
  {.name = "gap of a million sizes", .hard = "strain is what is left of 1e6",
   .mesh = "rect 4 4 1 1", .deck = LOWERED("1048576.", "0.5", "1048576.001"),
   .expect = "TOTALS normal = 1 ~ 1e-4"},
  {.name = "gap of 2^40 sizes", .hard = "no digit of the strain is left",
   .mesh = "rect 4 4 1 1",
   .deck = LOWERED("1099511627776.", "0.5", "1099511627776.001"),
   .verdict = 6, .expect = "errors has rounding leaves no correct digit"},
  {.name = "all open", .hard = "contact that plays no part",
   .mesh = "rect 4 4 1 1", .deck = HANGING("*STEP\n*STATIC\n"),
   .expect = "NODES u_y = -0.005*(1 - y) ~ 5e-15; CONTACT ^f_n = 0 ~ 5e-12;"
     "NODES u_x = 0 ~ 5e-15"},
  /* those that sweep stop at their tolerance, 1e-8 of the load of 5 */
  {.name = "all open, every method", .hard = "contact that plays no part",
   .mesh = "rect 4 4 1 1", .deck = HANGING(STATIC),
   .expect = "NODES u_y = -0.005*(1 - y) ~ 5e-11; CONTACT ^f_n = 0 ~ 5e-8;"
     "NODES u_x = 0 ~ 5e-11"},
  {.name = "all closed, 10000 contact nodes", .hard = "3.2 GB, ties",
   .flags = LARGE,
   .mesh = "rect 9999 1 9999 1", .deck = MATERIAL("1000.", "0.")
     FLOOR("0.5") "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\n*DSLOAD\n"
     "TOP, P, 10.\n" END,
   .expect = "NODES u_y = -0.01*y ~ 1e-9; TOTALS normal = 99990 ~ 1e-3"},
  {.name = "all closed, 4e7 long and 1 high", .flags = QUICK,
   .hard = "supports alone would not hold it", .mesh = "rect 40 1 4e7 1",
   .deck = MATERIAL("1000.", "0.") FLOOR("0.5") "*STEP\n*STATIC\n"
     "*BOUNDARY\nLEFT, 1\n*DSLOAD\nTOP, P, 10.\n" END,
   .expect = "NODES u_y = -0.01*y ~ 1e-9; TOTALS normal = 4e8 ~ 1"},
  {.name = "all closed, 10201 nodes", .hard = "ties at every node",
   .mesh = "rect 100 100 1 1 alternate", .deck = MATERIAL("1000.", "0.")
     FLOOR("0.5") STATIC "*BOUNDARY\nLEFT, 1\n*DSLOAD\nTOP, P, 10.\n" END,
   .expect = "NODES u_y = -0.01*y ~ 1e-10; TOTALS normal = 10 ~ 1e-8"},
  {.name = "all closed, 401 contact nodes", .hard = "long and flat, ties",
   .mesh = "rect 400 2 400 2", .deck = MATERIAL("1000.", "0.")
     FLOOR("0.5") STATIC "*BOUNDARY\nLEFT, 1\n*DSLOAD\nTOP, P, 10.\n" END,
   .expect = "NODES u_y = -0.01*y ~ 1e-9; TOTALS normal = 4000 ~ 1e-5"},
  {.name = "initial penetration", .hard = "forces at zero load",
   .mesh = "rect 4 4 1 1", .deck = MATERIAL("1000.", "0.")
     PLANE("C", "BOTTOM", "0., 0.001", "0., 1.") COULOMB("C", "0.3") STATIC
     "*BOUNDARY\nTOP, 2\nLEFT, 1\n" END,
   .expect = "NODES u_y = 0.001*(1 - y) ~ 1e-11; TOTALS normal = 1 ~ 1e-8"},
  {.name = "heated until it touches", .hard = "zero force, zero gap",
   .mesh = "rect 4 4 1 1", .deck = HEATED("1.0E-6", "-1.E-3"),
   .expect = "NODES u_y = -0.001*(1 - y) ~ 1e-11; CONTACT ^f_n = 0 ~ 1e-6"},
  {.name = "heated beyond the gap", .hard = "thermal contact",
   .flags = QUICK, .mesh = "rect 4 4 1 1", .deck = HEATED("1.2E-6", "-1.E-3"),
   .expect = "TOTALS normal = 40 ~ 1e-6"},
  {.name = "penetrates before it is heated", .hard = "forces at zero load",
   .mesh = "rect 4 4 1 1", .deck = HEATED("0.", "1.E-4"),
   .expect = "TOTALS normal = 20 ~ 1e-6"},
  {.name = "corner node on two obstacles", .hard = "one node, two contacts",
   .flags = QUICK, .mesh = "rect 4 4 1 1", .deck = MATERIAL("1000.", "0.3")
     PLANE("C", "BOTTOM", "0., 0.", "0., 1.")
     PLANE("W", "LEFT", "0., 0.", "1., 0.") STATIC
     "*DSLOAD\nTOP, P, 10.\nRIGHT, P, 4.\n" END,
   .expect = "NODES u_x = -0.0013*(0.7*4 - 0.3*10)*x ~ 1e-9;"
     "NODES u_y = -0.0013*(0.7*10 - 0.3*4)*y ~ 1e-9;"
     "TOTALS +normal = 14 ~ 1e-8"},
  {.name = "hollow of nearly its own radius", .hard = "conforming contact",
   .mesh = "rect 8 4 1 1 alternate",
   .change = {.map = {"x - 0.5", "y + (1 - y)*(2 - sqrt(4 - (x-0.5)^2))"}},
   .deck = MATERIAL("1000.", "0.3") ROUND("INSIDE", "2.01", "2.01")
     COULOMB("C", "0.3") STATIC "*DSLOAD\nTOP, P, 10.\n" END,
   .expect = "TOTALS force_y = 10 ~ 1e-8; TOTALS force_x = 0 ~ 1e-8;"
     "TOTALS moment_z = 0 ~ 1e-8"},
  {.name = "hollow of twice the curvature", .hard = "two edges carry",
   .mesh = "rect 8 4 1 1 alternate",
   .change = {.map = {"x - 0.5", NULL}},
   .deck = MATERIAL("1000.", "0.3") ROUND("INSIDE", "1.", "1.118034")
     COULOMB("C", "0.3") STATIC "*DSLOAD\nTOP, P, 1.\n" END,
   .expect = "TOTALS force_y = 1 ~ 1e-9; TOTALS force_x = 0 ~ 1e-9"},
  {.name = "on a bump", .hard = "contact alone, one node first",
   .mesh = "rect 8 4 1 1 alternate", .flags = MAY_REFUSE,
   .change = {.map = {"x - 0.5", NULL}},
   .deck = MATERIAL("1000.", "0.3") ROUND("OUTSIDE", "5.", "-5.")
     COULOMB("C", "0.5") STATIC "*DSLOAD\nTOP, P, 10.\n" END,
   .expect = "TOTALS force_y = 10 ~ 1e-8; TOTALS force_x = 0 ~ 1e-8"},
  {.name = "lies on its contact", .hard = "three free motions",
   .flags = QUICK, .mesh = "rect 4 4 1 1",
   .deck = LYING("0.5", "TOP, P, 10.\n"),
   .expect = "TOTALS force_y = 10 ~ 1e-8; TOTALS moment_z = 5 ~ 1e-8;"
     "NODES u_y = -0.01*y ~ 1e-9; TOTALS force_x = 0 ~ 1e-8"},
  {.name = "lies and is pushed", .hard = "held by friction",
   .mesh = "rect 4 4 1 1", .deck = LYING("0.5", "TOP, P, 10.\nLEFT, P, 2.\n"),
   .expect = "TOTALS force_y = 10 ~ 1e-8; TOTALS force_x = -2 ~ 1e-8;"
     "TOTALS moment_z = 6 ~ 1e-8"},
  {.name = "lies in 3-D and is pushed", .hard = "six free motions",
   .mesh = "box 3 3 2 1 1 1", .deck = MATERIAL("1000.", "0.")
     PLANE("C", "BOTTOM", "0., 0., 0.", "0., 0., 1.") COULOMB("C", "0.5")
     STATIC "*DSLOAD\nTOP, P, 10.\nLEFT, P, 2.\n" END,
   .expect = "TOTALS force_z = 10 ~ 1e-8; TOTALS force_x = -2 ~ 1e-8;"
     "TOTALS force_y = 0 ~ 1e-8"},
  {.name = "lies without friction", .hard = "its place is not determined",
   .mesh = "rect 4 4 1 1", .deck = LYING("0.", "TOP, P, 10.\n"),
   .verdict = 6},
  {.name = "lifted", .hard = "no equilibrium", .mesh = "rect 4 4 1 1",
   .flags = QUICK, .deck = LYING("0.5", "TOP, P, -10.\n"), .verdict = 6},
  {.name = "pushed too hard", .hard = "no equilibrium, slides",
   .mesh = "rect 4 4 1 1", .deck = LYING("0.5", "TOP, P, 10.\nLEFT, P, 6.\n"),
   .verdict = 6},
  {.name = "tips over", .hard = "no equilibrium, turns",
   .mesh = "rect 4 4 1 1", .deck = LYING("9.", "TOP, P, 10.\nLEFT, P, 12.\n"),
   .verdict = 6},
  {.name = "resultant outside the base", .hard = "no equilibrium, turns",
   .mesh = "rect 4 4 1 1", .deck = LYING("0.5", "TOP, P, \"120*x-50\"\n"),
   .verdict = 6},
  {.name = "one of two bodies floats free", .hard = "nothing holds it",
   .flags = QUICK, .mesh = "rect 3 3 1 1 + rect 3 3 1 1 at 2 1",
   .deck = MATERIAL("1000.", "0.")
     "*SOLID SECTION, ELSET=BODY2, MATERIAL=M\n" FLOOR("0.5") STATIC
     "*BOUNDARY\nLEFT, 1\n*DSLOAD\nTOP, P, 10.\n" END, .verdict = 6},
  {.name = "one of two bodies lies on its contact", .hard = "free among held",
   .mesh = "rect 3 3 1 1 + rect 3 3 1 1 at 2 0",
   .deck = MATERIAL("1000.", "0.")
     "*SOLID SECTION, ELSET=BODY2, MATERIAL=M\n" FLOOR("0.5")
     PLANE("C2", "BOTTOM2", "0., 0.", "0., 1.") COULOMB("C2", "0.5") STATIC
     "*BOUNDARY\nLEFT, 1\n*DSLOAD\nTOP, P, 10.\nTOP2, P, 5.\n" END,
   .expect = "NODES u_y = -0.01*y*if(x<1.5, 1, 0.5) ~ 1e-9"},
  {.name = NULL}
};
/* clang-format on */
