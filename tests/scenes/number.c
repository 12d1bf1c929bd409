/*
 * The same scene in other units, at another place, turned, mirrored and with
 * other numbers: clamped on the right, pressed from above and from the left,
 * friction 1 on a floor along its lower side.
 */
#include "scenes/cards.h"
#include "scenes/scenes.h"

#define HELD(mu, top, side)                                           \
  "*PARAMETER\nSTRESS = 1\n*MATERIAL, NAME=M\n*ELASTIC\n"             \
  "\"1000*<STRESS>\", 0.2\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"  \
  "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"                              \
  "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n" COULOMB("C", mu)     \
      QUASI("0.5", "1.") "*BOUNDARY\nRIGHT, 1, " top                  \
                         "\n*DSLOAD\n"                                \
                         "TOP, P, \"5*t*<STRESS>\"\nLEFT, P, \"" side \
                         "*t*<STRESS>\"\n" END
#define PLANE_BLOCK "rect 6 6 1 1 alternate"
#define TWIN(...) \
  &(const scene_twin) { __VA_ARGS__ }
#define TWO_TO_40 "--no-timing -D STRESS=1099511627776"
#define TWO_TO_MINUS_40 \
  "--no-timing -D STRESS=9.094947017729282379150390625E-13"

/* Creep of a sheared block in increments by the size of its error; it is held
 * and moved along its own axis, turned by the angle TURN. */
#define CREEPING                                                               \
  "*PARAMETER\nTURN = 0\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"            \
  "*INELASTIC, LAW=MAXWELL, TYPE=DEVIATORIC\n1.\n*SOLID SECTION, ELSET=BODY, " \
  "MATERIAL=M\n"                                                               \
  "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"                                       \
  "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"                               \
  "*STEP\n*VISCO, INTEGRATOR=HEUN, TOLERANCE=0.01\n1E-3, 1.\n@S"               \
  "*BOUNDARY\nRIGHT, 1, 2\nTOP, 1, 1, \"0.01*cos(<TURN>)\"\n"                  \
  "TOP, 2, 2, \"0.01*sin(<TURN>)\"\n" END
/* The lower block is stiff across the joint, soft along it. */
#define GRAINED                                                           \
  "*PARAMETER\nTURN = 0\n*MATERIAL, NAME=M\n*ELASTIC, TYPE=ORTHO\n"       \
  "\"2000 - 1800*cos(<TURN>)\", \"2000 - 1800*sin(<TURN>)\", 1000., 0., " \
  "0., 0., 500., 500., 500.\n*MATERIAL, NAME=M2\n*ELASTIC\n1000., 0.3\n"  \
  "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"                              \
  "*SOLID SECTION, ELSET=BODY2, MATERIAL=M2\n"                            \
  "*CONTACT PAIR, NAME=P\nTOP, BOTTOM2\n" COULOMB("P", "0.21") STATIC     \
      "*BOUNDARY\nBOTTOM, 1, 2\n*DSLOAD\nTOP2, P, 10.\nLEFT2, P, 2.\n" END

/* clang-format off */
#define SAME_BLOCK .mesh = PLANE_BLOCK, .deck = HELD("1.", "2", "15")
#define SAME_BOX .mesh = "box 3 3 2 1 1 1", .deck = HELD("0.5", "3", "6")

const scene_row number_scenes[] = {
  {.name = "numbered at random", .hard = "order of sums", SAME_BLOCK,
   .flags = QUICK, .twin = TWIN(.change = {.shuffle = 7}, .tol = 1e-9)},
  {.name = "numbered at random again", .hard = "order of sums", SAME_BLOCK,
   .twin = TWIN(.change = {.shuffle = 12345}, .tol = 1e-9)},
  {.name = "mirrored", .hard = "sign of the tangent", SAME_BLOCK,
   .twin = TWIN(.change = {.mirror = 1}, .tol = 1e-9)},
  {.name = "turned by 0.3", .hard = "oblique frames", SAME_BLOCK,
   .flags = QUICK, .twin = TWIN(.change = {.turn = 0.3}, .tol = 1e-9)},
  {.name = "turned by 2", .hard = "hangs below its floor", SAME_BLOCK,
   .twin = TWIN(.change = {.turn = 2.0}, .tol = 1e-9)},
  {.name = "mirrored, turned and renumbered", .hard = "all at once",
   SAME_BLOCK, .twin = TWIN(.change = {.turn = 1.0, .mirror = 1,
   .shuffle = 99}, .tol = 1e-9)},
  {.name = "creep turned by 0.7", .hard = "norm of strains", .flags = QUICK,
   .mesh = PLANE_BLOCK, .deck = CREEPING,
   .twin = TWIN(.change = {.turn = 0.7}, .words = "--no-timing -D TURN=0.7",
   .tol = 1e-8)},
  {.name = "grained pair turned by pi/2", .hard = "moduli by direction",
   .mesh = "rect 5 5 1 1 + rect 4 4 1 1 at 0 1", .flags = QUICK,
   .deck = GRAINED, .twin = TWIN(.change = {.turn = 1.5707963267948966},
   .words = "--no-timing -D TURN=1.5707963267948966", .tol = 1e-8)},
  {.name = "box turned by 0.7", .hard = "tangents in 3-D", SAME_BOX,
   .twin = TWIN(.change = {.turn = 0.7}, .tol = 1e-8)},
  {.name = "box mirrored", .hard = "left-handed frames", SAME_BOX,
   .twin = TWIN(.change = {.mirror = 1}, .tol = 1e-8)},
  {.name = "box renumbered", .hard = "order of sums", SAME_BOX,
   .twin = TWIN(.change = {.shuffle = 5}, .tol = 1e-8)},
  {.name = "1e3 sizes from the origin", .hard = "digits of coordinates",
   SAME_BLOCK, .twin = TWIN(.change = {.shift = 1e3}, .tol = 1e-9)},
  {.name = "1e6 sizes from the origin", .hard = "digits of coordinates",
   SAME_BLOCK, .flags = QUICK,
   .twin = TWIN(.change = {.shift = 1e6}, .tol = 1e-7)},
  {.name = "millimetres", .hard = "units of length", SAME_BLOCK,
   .twin = TWIN(.change = {.scale = 1e3}, .length = 1e3, .force = 1e3,
   .tol = 1e-9)},
  {.name = "micrometres for metres", .hard = "units of length", SAME_BLOCK,
   .twin = TWIN(.change = {.scale = 1e-6}, .length = 1e-6, .force = 1e-6,
   .tol = 1e-9)},
  {.name = "metres and pascals", .hard = "units of stress", SAME_BLOCK,
   .twin = TWIN(.change = {.scale = 1e-3}, .length = 1e-3, .force = 1e3,
   .words = "--no-timing -D STRESS=1E6", .tol = 1e-9)},
  {.name = "forces 1e-12", .hard = "absolute tolerances", SAME_BLOCK,
   .twin = TWIN(.words = "--no-timing -D STRESS=1E-12", .force = 1e-12,
   .tol = 1e-9)},
  {.name = "forces 1e12", .hard = "absolute tolerances", SAME_BLOCK,
   .twin = TWIN(.words = "--no-timing -D STRESS=1E12", .force = 1e12,
   .tol = 1e-9)},
  {.name = "forces 2^40, every bit", .hard = "any absolute number",
   SAME_BLOCK, .flags = QUICK, .twin = TWIN(.words = TWO_TO_40,
   .force = 1099511627776.0)},
  {.name = "forces 2^-40, every bit", .hard = "any absolute number",
   SAME_BLOCK, .twin = TWIN(.words = TWO_TO_MINUS_40,
   .force = 1 / 1099511627776.0)},
  {.name = "lengths 2^10, every bit", .hard = "any absolute number",
   SAME_BLOCK, .twin = TWIN(.change = {.scale = 1024.0}, .length = 1024.0,
   .force = 1024.0)},
  {.name = "lengths 2^-30, every bit", .hard = "any absolute number",
   SAME_BLOCK, .twin = TWIN(.change = {.scale = 1 / 1073741824.0},
   .length = 1 / 1073741824.0, .force = 1 / 1073741824.0)},
  {.name = NULL}
};
/* clang-format on */
