/*
 * Materials and meshes: nearly incompressible, far apart in stiffness, thin,
 * graded, of one element.
 */
#include "scenes/cards.h"
#include "scenes/scenes.h"

/* Frictionless, pressed by 10 in plane strain: uniform. */
#define PRESSED(nu)     \
  MATERIAL("1000.", nu) \
  FLOOR("0.") STATIC "*BOUNDARY\nLEFT, 1\n*DSLOAD\nTOP, P, 10.\n" END
#define PRESSED_TO(nu, tol)                       \
  "NODES u_x = 0.01*" nu "*(1 + " nu ")*x ~ " tol \
  ";"                                             \
  "NODES u_y = -0.01*(1 - " nu "^2)*y ~ " tol
#define WARNED ";errors has P2055"
#define NOT_WARNED ";errors lacks P2055"
#define AVERAGED_MATERIAL(nu, law)                   \
  "*MATERIAL, NAME=M\n*ELASTIC\n1000., " nu "\n" law \
  "*SOLID SECTION, ELSET=BODY, MATERIAL=M, FORMULATION=AVERAGED\n"
#define AVERAGED(nu)        \
  AVERAGED_MATERIAL(nu, "") \
  FLOOR("0.") STATIC "*BOUNDARY\nLEFT, 1\n*DSLOAD\nTOP, P, 10.\n" END
#define WAVY                                       \
  {                                                \
    .map = {                                       \
      "x + 0.05*sin(3.14159265358979*x)*sin(9*y)", \
      "y + 0.05*sin(3.14159265358979*y)*cos(7*x)"  \
    }                                              \
  }
/* The middle of the layers stays where it is. */
#define WAVY_LAYERS                                \
  {                                                \
    .map = {                                       \
      "x + 0.05*sin(3.14159265358979*x)*sin(9*y)", \
      "y + 0.05*sin(6.28318530717959*y)*cos(7*x)"  \
    }                                              \
  }
#define LAYERS(contrast, support)                                        \
  "*MATERIAL, NAME=S\n*ELASTIC\n1., 0.\n*MATERIAL, "                     \
  "NAME=H\n*ELASTIC\n" contrast                                          \
  ", 0.\n*SOLID SECTION, ELSET=SOFT, MATERIAL=S\n"                       \
  "*SOLID SECTION, ELSET=HARD, MATERIAL=H\n" FLOOR("0.3") STATIC support \
      "*DSLOAD\nTOP, P, 1.\n" END
#define ORTHO(E1, E2)                                            \
  "*MATERIAL, NAME=M\n*ELASTIC, TYPE=ORTHO\n" E1 ", " E2         \
  ", 1000., 0., 0., 0., 500., 500., 500.\n"                      \
  "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n" FLOOR("0.3") STATIC \
      "*BOUNDARY\nLEFT, 1\n*DSLOAD\nTOP, P, 10.\n" END

/* clang-format off */
const scene_row body_scenes[] = {
  {.name = "nu=0.49", .hard = "nearly incompressible, uniform strain",
   .mesh = "rect 6 6 1 1", .deck = PRESSED("0.49"),
   .expect = PRESSED_TO("0.49", "1e-10")},
  {.name = "nu=0.499", .hard = "nearly incompressible, uniform strain",
   .mesh = "rect 6 6 1 1", .deck = PRESSED("0.499"), .flags = QUICK,
   .expect = PRESSED_TO("0.499", "1e-9") WARNED},
  {.name = "nu=0.4999", .hard = "nearly incompressible, uniform strain",
   .mesh = "rect 6 6 1 1", .deck = PRESSED("0.4999"),
   .expect = PRESSED_TO("0.4999", "1e-9") WARNED},
  {.name = "nu=0.49999", .hard = "nearly incompressible, uniform strain",
   .mesh = "rect 6 6 1 1 alternate", .deck = PRESSED("0.49999"),
   .expect = PRESSED_TO("0.49999", "1e-8") WARNED},
  {.name = "nu=0.4999 averaged", .hard = "clusters of unequal triangles",
   .mesh = "rect 6 6 1 1", .change = WAVY, .deck = AVERAGED("0.4999"),
   .flags = QUICK, .expect = PRESSED_TO("0.4999", "1e-9") NOT_WARNED},
  {.name = "nu=0.4999 averaged, numbered at random", .hard = "other clusters?",
   .mesh = "rect 12 8 2 1", .change = {.map = {"x - 1", NULL}},
   .deck = AVERAGED_MATERIAL("0.4999", "")
     "*OBSTACLE, NAME=O, TYPE=GAP\n\"0.02*x^2\"\n"
     "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n" COULOMB("C", "0.3")
     STATIC "*BOUNDARY\nTOP, 1, 1, 0.\n*DSLOAD\nTOP, P, 10.\n" END,
   .expect = "TOTALS force_y = 20 ~ 1e-7",
   .twin = &(const scene_twin){.change = {.map = {"x - 1", NULL},
   .shuffle = 7}, .tol = 1e-9}},
  {.name = "nu=0.49999 averaged", .hard = "clusters of unequal triangles",
   .mesh = "rect 7 5 1 1", .change = WAVY, .deck = AVERAGED("0.49999"),
   .expect = PRESSED_TO("0.49999", "1e-8") NOT_WARNED},
  {.name = "nu=0.4999 averaged, one element thick", .hard = "no inner node",
   .mesh = "rect 9 1 9 1", .deck = AVERAGED("0.4999"),
   .expect = PRESSED_TO("0.4999", "1e-9")},
  {.name = "nu=0.4999 averaged, two elements", .hard = "one cluster",
   .mesh = "rect 1 1 1 1", .deck = AVERAGED("0.4999"),
   .expect = PRESSED_TO("0.4999", "1e-9")},
  {.name = "nu=0.4999 averaged, tetrahedra", .hard = "clusters in 3-D",
   .mesh = "box 4 4 3 1 1 1", .deck = AVERAGED_MATERIAL("0.4999", "")
     PLANE("C", "BOTTOM", "0., 0., 0.", "0., 0., 1.") COULOMB("C", "0.")
     STATIC "*BOUNDARY\nLEFT, 1\nFRONT, 2\n*DSLOAD\nTOP, P, 10.\n" END,
   .expect = "NODES u_x = 4.999e-3*x ~ 1e-9; NODES u_z = -1e-2*z ~ 1e-9"},
  {.name = "nu=0.4999 averaged, parabola", .hard = "moving edge, friction",
   .mesh = "rect 24 12 2 1", .flags = QUICK,
   .change = {.map = {"x - 1", NULL}}, .deck = AVERAGED_MATERIAL("0.4999", "")
     "*OBSTACLE, NAME=O, TYPE=GAP\n\"0.02*x^2\"\n"
     "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n" COULOMB("C", "0.3")
     QUASI("0.25", "1.") "*BOUNDARY\nTOP, 1, 1, 0.\n*DSLOAD\n"
     "TOP, P, 10.\n" END,
   .expect = "TOTALS force_y = 20 ~ 1e-7; ENERGY energy_defect_relative = 0 "
     "~ 1e-9"},
  {.name = "nu=0.49999 averaged, held by contact", .hard = "singular, stiff",
   .mesh = "rect 8 6 1 1", .deck = AVERAGED_MATERIAL("0.49999", "")
     FLOOR("0.5") STATIC "*DSLOAD\nTOP, P, 10.\n" END,
   .expect = "TOTALS force_y = 10 ~ 1e-7; TOTALS moment_z = 5 ~ 1e-7"},
  {.name = "averaged, creeps to no shear", .hard = "nu = 1/2 in the end",
   .mesh = "rect 6 6 1 1",
   .deck = AVERAGED_MATERIAL("0.3",
     "*INELASTIC, LAW=MAXWELL, TYPE=DEVIATORIC\n2.\n")
     FLOOR("0.") STATIC "*BOUNDARY\nLEFT, 1\nRIGHT, 1\n*DSLOAD\n"
     "TOP, P, 1.\n" END VISCO("@I", "0.5", "60.") LAST,
   .expect = "NODES u_y = -y*1.2e-3 ~ 1e-8"},
  {.name = "nu=-0.99", .hard = "nearly without shear energy",
   .mesh = "rect 6 6 1 1", .deck = PRESSED("-0.99"),
   .expect = PRESSED_TO("(-0.99)", "1e-9")},
  {.name = "contrast 1e8", .hard = "digits of the soft part",
   .mesh = "rect 4 4 1 1 layers", .flags = QUICK,
   .deck = LAYERS("1.E8", "*BOUNDARY\nLEFT, 1\n"),
   .expect = "TOTALS normal = 1 ~ 1e-9; NODES u_y @y=1 = -0.5 - 0.5e-8 ~ 1e-8"},
  {.name = "contrast 1e-8", .hard = "digits of the hard part",
   .mesh = "rect 4 4 1 1 layers",
   .deck = LAYERS("1.E-8", "*BOUNDARY\nLEFT, 1\n"),
   .expect = "TOTALS normal = 1 ~ 1e-8; NODES u_y @y=0.5 = -0.5 ~ 1e-6"},
  {.name = "contrast 1e8, held by contact alone",
   .hard = "singular, two scales", .mesh = "rect 4 4 1 1 layers",
   .deck = LAYERS("1.E8", ""),
   .expect = "TOTALS normal = 1 ~ 1e-9; TOTALS moment_z = 0.5 ~ 1e-8"},
  {.name = "hard body on a soft base, 1e6", .hard = "unequal triangles",
   .mesh = "rect 6 8 1 1 layers", .change = WAVY_LAYERS,
   .deck = LAYERS("1.E6", "*BOUNDARY\nLEFT, 1\n"),
   .expect = "TOTALS normal = 1 ~ 1e-10; NODES u_y @y=1 = -0.5 - 0.5e-6 "
     "~ 1e-10; NODES u_x = 0 ~ 1e-10"},
  {.name = "hard body on a soft base, lying", .hard = "held by contact",
   .mesh = "rect 6 8 1 1 layers", .change = WAVY_LAYERS, .flags = QUICK,
   .deck = LAYERS("1.E6", ""),
   .expect = "TOTALS normal = 1 ~ 1e-9; TOTALS moment_z = 0.5 ~ 1e-9;"
     "NODES u_y @y=1 = -0.5 - 0.5e-6 ~ 1e-8"},
  {.name = "contrast 1e12, unequal triangles", .hard = "four digits left",
   .mesh = "rect 6 8 1 1 layers", .change = WAVY_LAYERS,
   .deck = LAYERS("1.E12", "*BOUNDARY\nLEFT, 1\n"),
   .expect = "TOTALS normal = 1 ~ 1e-8; NODES u_y @y=1 = -0.5 ~ 1e-6;"
     "lst has rounding:"},
  {.name = "contrast 1e15", .hard = "no digit left", .verdict = 6,
   .mesh = "rect 6 8 1 1 layers", .change = WAVY_LAYERS, .flags = QUICK,
   .deck = LAYERS("1.E15", "*BOUNDARY\nLEFT, 1\n"),
   .expect = "errors has rounding leaves no correct digit"},
  {.name = "contrast 1e15, lying", .hard = "no digit left", .verdict = 6,
   .mesh = "rect 6 8 1 1 layers", .change = WAVY_LAYERS,
   .deck = LAYERS("1.E15", ""),
   .expect = "errors has rounding leaves no correct digit"},
  {.name = "averaged, contrast 1e15", .hard = "no digit left", .verdict = 6,
   .mesh = "rect 4 4 1 1 layers",
   .deck = "*MATERIAL, NAME=S\n*ELASTIC\n1., 0.\n*MATERIAL, NAME=H\n"
     "*ELASTIC\n1.E15, 0.\n*SOLID SECTION, ELSET=SOFT, MATERIAL=S, "
     "FORMULATION=AVERAGED\n*SOLID SECTION, ELSET=HARD, MATERIAL=H, "
     "FORMULATION=AVERAGED\n" FLOOR("0.3") STATIC
     "*BOUNDARY\nLEFT, 1\n*DSLOAD\nTOP, P, 1.\n" END,
   .expect = "errors has rounding leaves no correct digit|supports lose "
     "digits"},
  {.name = "needles of aspect 1e8", .hard = "no digit left", .verdict = 6,
   .mesh = "rect 6 6 1 1e8", .deck = PRESSED("0.3"),
   .expect = "errors has rounding leaves no correct digit"},
  /* or that the stiffness is nearly singular, where the inverse is needed */
  {.name = "slivers, flat, aspect 1e8", .hard = "no digit left", .verdict = 6,
   .mesh = "rect 6 6 1e8 1", .deck = PRESSED("0.3"),
   .expect = "errors has error: step 1, time 1: "},
  {.name = "orthotropic 1e4 along the floor", .hard = "stiff in one direction",
   .mesh = "rect 4 4 1 1", .deck = ORTHO("1.E7", "1000."),
   .expect = "NODES u_y = -0.01*y ~ 1e-9; NODES u_x = 0 ~ 1e-9"},
  {.name = "orthotropic 1e4 upright", .hard = "stiff in one direction",
   .mesh = "rect 4 4 1 1", .deck = ORTHO("1000.", "1.E7"),
   .expect = "NODES u_y = -1e-6*y ~ 1e-12"},
  {.name = "slivers, flat, aspect 1e4", .hard = "angles of 1e-4",
   .mesh = "rect 6 6 1e4 1", .deck = PRESSED("0.3"), .flags = QUICK,
   .expect = "NODES u_x = 3.9e-3*x ~ 3.9e-5; NODES u_y = -9.1e-3*y ~ 9.1e-9"},
  {.name = "slivers, upright, aspect 1e4", .hard = "angles of 1e-4",
   .mesh = "rect 6 6 1 1e4", .deck = PRESSED("0.3"),
   .expect = "NODES u_x = 3.9e-3*x ~ 3.9e-9; NODES u_y = -9.1e-3*y ~ 9.1e-5"},
  {.name = "one layer of slivers among good ones", .hard = "thin layer",
   .mesh = "rect 6 6 1 1",
   .change = {.map = {NULL, "if(y < 0.1, y, if(y < 0.2, 1e-5, y))"}},
   .deck = PRESSED("0.3"), .expect = PRESSED_TO("0.3", "1e-8")},
  {.name = "sizes from 1e-6 to 0.9 side by side", .hard = "graded to the edge",
   .mesh = "rect 12 4 1 1",
   .change = {.map = {"(10^(6*x) - 1)/(1e6 - 1)", NULL}},
   .deck = PRESSED("0.3"), .expect = PRESSED_TO("0.3", "1e-8")},
  {.name = "graded both ways to a corner", .hard = "sizes 1e-4 to 0.9",
   .mesh = "rect 10 10 1 1",
   .change = {.map = {"(10^(4*x) - 1)/9999", "(10^(4*y) - 1)/9999"}},
   .deck = PRESSED("0.3"), .expect = PRESSED_TO("0.3", "1e-8")},
  {.name = "two elements", .hard = "the least block", .mesh = "rect 1 1 1 1",
   .deck = PRESSED("0.3"),
   .expect = PRESSED_TO("0.3", "1e-10")},
  {.name = "six tetrahedra", .hard = "the least block in 3-D",
   .mesh = "box 1 1 1 1 1 1", .deck = MATERIAL("1000.", "0.3")
     PLANE("C", "BOTTOM", "0., 0., 0.", "0., 0., 1.") COULOMB("C", "0.")
     STATIC "*BOUNDARY\nLEFT, 1\nFRONT, 2\n*DSLOAD\nTOP, P, 10.\n" END,
   .expect = "NODES u_x = 3e-3*x ~ 1e-10; NODES u_y = 3e-3*y ~ 1e-10;"
     "NODES u_z = -1e-2*z ~ 1e-10"},
  {.name = "tetrahedra as thin as 1e4", .hard = "slivers in 3-D",
   .mesh = "box 3 3 2 1e4 1 1", .deck = MATERIAL("1000.", "0.3")
     PLANE("C", "BOTTOM", "0., 0., 0.", "0., 0., 1.") COULOMB("C", "0.")
     STATIC "*BOUNDARY\nLEFT, 1\nFRONT, 2\n*DSLOAD\nTOP, P, 10.\n" END,
   .expect = "NODES u_x = 3e-3*x ~ 3e-5; NODES u_y = 3e-3*y ~ 3e-9;"
     "NODES u_z = -1e-2*z ~ 1e-8"},
  {.name = NULL}
};
/* clang-format on */
