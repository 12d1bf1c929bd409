/*
 * Two and more bodies against each other, whose meshes do not match.
 */
#include "scenes/cards.h"
#include "scenes/scenes.h"

#define BODIES(E1, E2, nu)                      \
  "*MATERIAL, NAME=M\n*ELASTIC\n" E1 ", " nu    \
  "\n*MATERIAL, NAME=M2\n*ELASTIC\n" E2 ", " nu \
  "\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"  \
  "*SOLID SECTION, ELSET=BODY2, MATERIAL=M2\n"
#define PAIR(name, lower, upper, words) \
  "*CONTACT PAIR, NAME=" name words "\n" lower ", " upper "\n"
#define JOINT PAIR("P", "TOP", "BOTTOM2", "")
#define SIDES "*BOUNDARY\nBOTTOM, 2\nLEFT, 1\nLEFT2, 1\n"
#define CLAMP "*BOUNDARY\nBOTTOM, 1, 2\n"
#define STACK "rect 4 4 1 1 + rect 3 5 1 1 at 0 1"

/* clang-format off */
const scene_row pair_scenes[] = {
  {.name = "block on block", .hard = "meshes that do not match",
   .flags = QUICK, .mesh = STACK,
   .deck = BODIES("1000.", "1000.", "0.3") JOINT STATIC SIDES
     "*DSLOAD\nTOP2, P, 10.\n" END,
   .expect = "NODES u_y = -0.0091*y ~ 1e-10; NODES u_x = 0.0039*x ~ 1e-10;"
     "TOTALS normal = 10 ~ 1e-10; CONTACT pressure = 10 ~ 1e-9"},
  {.name = "block that only lies on another", .hard = "held by friction",
   .flags = QUICK, .mesh = STACK,
   .deck = BODIES("1000.", "1000.", "0.") JOINT COULOMB("P", "0.3")
     QUASI("0.25", "1.") CLAMP
     "*DSLOAD\nTOP2, P, 10.\nTOP2, TX, 2.\nRIGHT, TY, 2.\nRIGHT2, TY, 2.\n"
     "LEFT, TY, -2.\nLEFT2, TY, -2.\n" END,
   .expect = "NODES u_y = -0.01*y ~ 1e-10; NODES u_x = 0.004*y ~ 1e-10;"
     "TOTALS normal = 10 ~ 1e-9; TOTALS force_x = -2 ~ 1e-9"},
  {.name = "block that is pushed off", .hard = "no equilibrium",
   .mesh = STACK, .verdict = 6,
   .deck = BODIES("1000.", "1000.", "0.") JOINT COULOMB("P", "0.3")
     QUASI("0.25", "1.") CLAMP "*DSLOAD\nTOP2, P, 10.\nTOP2, TX, 4.\n" END},
  {.name = "block above a block", .hard = "falls before it touches",
   .mesh = STACK,
   .deck = BODIES("1000.", "1000.", "0.3") JOINT "CLEARANCE, 0.01\n" STATIC
     SIDES "*DSLOAD\nTOP2, P, 10.\n" END,
   .expect = "NODES u_x = 0.0039*x ~ 1e-9; TOTALS normal = 10 ~ 1e-9"},
  {.name = "soft block on hard block", .hard = "ratio 1e6", .mesh = STACK,
   .deck = BODIES("1.E9", "1000.", "0.") JOINT COULOMB("P", "0.3") STATIC
     SIDES "*DSLOAD\nTOP2, P, 10.\n" END,
   .expect = "NODES u_y = -1e-8*min(y, 1) - 0.01*max(0, y - 1) ~ 1e-10;"
     "TOTALS normal = 10 ~ 1e-9"},
  {.name = "hard block on soft block", .hard = "contact alone holds the hard",
   .mesh = STACK,
   .deck = BODIES("1000.", "1.E9", "0.") JOINT COULOMB("P", "0.3") STATIC
     SIDES "*DSLOAD\nTOP2, P, 10.\n" END,
   .expect = "NODES u_y = -0.01*min(y, 1) - 1e-8*max(0, y - 1) ~ 1e-7;"
     "TOTALS normal = 10 ~ 1e-7"},
  {.name = "interference of two blocks", .hard = "no load but the gap",
   .mesh = STACK,
   .deck = BODIES("1000.", "2000.", "0.") JOINT "INTERFERENCE, 0.003\n" STATIC
     "*BOUNDARY\nBOTTOM, 2\nLEFT, 1\nLEFT2, 1\nTOP2, 2\n" END,
   .expect = "CONTACT pressure = 2 ~ 1e-9; TOTALS normal = 2 ~ 1e-9"},
  {.name = "narrow block on a wide one", .hard = "nodes without partner",
   .mesh = "rect 12 4 3 1 + rect 5 5 1 1 at 1 1", .flags = QUICK,
   .deck = BODIES("1000.", "1000.", "0.3")
     PAIR("P", "TOP", "BOTTOM2", ", SLAVE=FIRST") COULOMB("P", "0.3")
     QUASI("0.25", "1.") CLAMP "*DSLOAD\nTOP2, P, 10.\nTOP2, TX, 1.\n" END,
   .expect = "TOTALS normal = 10 ~ 1e-8; TOTALS force_x = 1 ~ 1e-8"},
  {.name = "corner of pair and wall", .hard = "one node, two normals",
   .mesh = STACK,
   .deck = BODIES("1000.", "1000.", "0.3") JOINT
     PLANE("W", "LEFT", "0., 0.", "1., 0.")
     PLANE("V", "LEFT2", "0., 0.", "1., 0.") STATIC
     "*BOUNDARY\nBOTTOM, 2\n*DSLOAD\nTOP2, P, 10.\nRIGHT, P, 4.\n"
     "RIGHT2, P, 4.\n" END,
   .expect = "NODES u_x = -0.0013*(0.7*4 - 0.3*10)*x ~ 1e-9;"
     "NODES u_y = -0.0013*(0.7*10 - 0.3*4)*y ~ 1e-9"},
  {.name = "three blocks on the floor", .hard = "master and slave in a chain",
   .mesh = "rect 4 4 1 1 + rect 3 5 1 1 at 0 1 + rect 5 2 1 1 at 0 2",
   .deck = BODIES("1000.", "1000.", "0.")
     "*SOLID SECTION, ELSET=BODY3, MATERIAL=M\n"
     PLANE("C", "BOTTOM", "0., 0.", "0., 1.") COULOMB("C", "0.5")
     PAIR("P", "TOP", "BOTTOM2", "") COULOMB("P", "0.5")
     PAIR("Q", "TOP2", "BOTTOM3", "") COULOMB("Q", "0.5") STATIC
     "*DSLOAD\nTOP3, P, 10.\n" END,
   .expect = "NODES u_y = -0.01*y ~ 1e-9; TOTALS normal = 10 ~ 1e-8"},
  {.name = "tied blocks on the floor", .hard = "tie and contact",
   .mesh = STACK, .flags = QUICK,
   .deck = BODIES("1000.", "1000.", "0.3")
     "*TIE, NAME=T\nTOP, BOTTOM2\n"
     PLANE("C", "BOTTOM", "0., 0.", "0., 1.") STATIC
     "*BOUNDARY\nLEFT, 1\nLEFT2, 1\n*DSLOAD\nTOP2, P, 10.\n" END,
   .expect = "TOTALS force_y = 10 ~ 1e-9; NODES u_y = -0.0091*y ~ 1e-9;"
     "NODES contact_y = if(y > 0, 0, if(x*(1 - x) > 0, 2.5, 1.25)) ~ 1e-9"},
  {.name = "blocks in space", .hard = "clipped triangles",
   .mesh = "box 2 2 2 1 1 1 + box 3 2 2 1 1 1 at 0 0 1",
   .deck = BODIES("1000.", "2000.", "0.") JOINT COULOMB("P", "0.4")
     QUASI("0.5", "1.") "*BOUNDARY\nBOTTOM, 1, 3\n"
     "*DSLOAD\nTOP2, P, 10.\nTOP2, TX, 2.\nRIGHT, TZ, 2.\nRIGHT2, TZ, 2.\n"
     "LEFT, TZ, -2.\nLEFT2, TZ, -2.\n" END,
   .expect = "TOTALS normal = 10 ~ 1e-8; CONTACT pressure = 10 ~ 1e-8;"
     "NODES u_x = 0.004*min(z, 1) + 0.002*max(0, z - 1) ~ 1e-9"},
  {.name = "creeping block on an elastic one", .hard = "creep below a pair",
   .mesh = STACK,
   .deck = "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*INELASTIC, LAW=MAXWELL\n"
     "5.\n*MATERIAL, NAME=M2\n*ELASTIC\n1000., 0.3\n"
     "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
     "*SOLID SECTION, ELSET=BODY2, MATERIAL=M2\n" JOINT COULOMB("P", "0.3")
     VISCO("@I", "0.25", "1.") SIDES
     "*DSLOAD\nTOP2, P, 10.\n" END,
   .expect = "TOTALS normal = 10 ~ 1e-8"},
  {0}};
/* clang-format on */
