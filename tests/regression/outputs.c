/*
 * What a deck asks for beside its answer (*PRINT, *OUTPUT, *ACCURACY) changes
 * no number of it and ends no run: short decks of every effect that has arrays
 * of its own, and where rounding is in doubt, with some or none of it.
 */
#include "scenes/mesh.h"
#include "support/asked.h"
#include "support/unit.h"

#define ELASTIC(E) "*MATERIAL, NAME=M\n*ELASTIC\n" E "\n"
#define SECTION "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
#define MAXWELL ELASTIC("1000., 0.3") "*INELASTIC, LAW=MAXWELL\n2.\n" SECTION
#define FLOOR(y, friction)                       \
  "*OBSTACLE, NAME=O, TYPE=PLANE\n0., " y        \
  "\n0., 1.\n"                                   \
  "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n" \
  "*FRICTION, CONTACT=C, LAW=" friction "\n0.3\n"
#define LEFT_HELD "*BOUNDARY\nLEFT, 1\n"
#define PRESSED LEFT_HELD "*DSLOAD\nTOP, P, 1.\n"
#define ALL                                                             \
  "*PRINT, CONTACT, TOTALS, NODES, ELEMENTS, ENERGY, REACTIONS, ZONES," \
  "\nLOOP\n*END STEP\n"

/* clang-format off */
static const struct {
  const char *name, *mesh, *deck;
} decks[] = {
  {"two layers, contrast 1e6, no contact", "rect 4 4 1 1 layers",
   "*MATERIAL, NAME=S\n*ELASTIC\n1., 0.\n*MATERIAL, NAME=H\n*ELASTIC\n1.E6, 0."
   "\n*SOLID SECTION, ELSET=SOFT, MATERIAL=S\n*SOLID SECTION, ELSET=HARD, "
   "MATERIAL=H\n*STEP\n*STATIC\n*BOUNDARY\nBOTTOM, 2\nLEFT, 1\n"
   "*DSLOAD\nTOP, P, 1.\n*PRINT, NODES, ELEMENTS, ENERGY\n*END STEP\n"},
  {"steel block of 10 mm above a floor, SI", "rect 4 4 0.01 0.01",
   ELASTIC("2.1E11, 0.3") SECTION FLOOR("-1.E-5", "COULOMB")
   "*STEP\n*QUASISTATIC\n0.25, 1.\n" PRESSED ALL},
  {"Maxwell bar after 1e7 relaxation times", "rect 4 2 2 1",
   MAXWELL "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\nBOTTOM, 2\n*DSLOAD\n"
   "RIGHT, P, 1.\n*PRINT, NODES, ELEMENTS, ENERGY\n*END STEP\n"
   "*STEP\n*VISCO, INTEGRATOR=BACKWARD\n2.E7, 2.E7\n*END STEP\n"},
  {"creep, error of the increments", "rect 4 4 1 1",
   MAXWELL FLOOR("0.", "COULOMB") "*STEP\n*VISCO, INTEGRATOR=MIDPOINT\n"
   "0.5, 1.\n" PRESSED "*ACCURACY, TIME=YES\n" ALL},
  {"adaptive creep", "rect 3 3 1 1", MAXWELL FLOOR("0.", "COULOMB")
   "*STEP\n*VISCO, INTEGRATOR=HEUN, TOLERANCE=1.E-3\n0.25, 1.\n" PRESSED ALL},
  {"heat, moduli over temperature", "rect 4 4 1 1",
   "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3, 0.\n500., 0.3, 100.\n"
   "*EXPANSION\n1.E-4\n" SECTION FLOOR("0.", "COULOMB")
   "*STEP\n*QUASISTATIC\n0.5, 1.\n" PRESSED "*TEMPERATURE\nBODY, \"50*x*t\"\n"
   ALL},
  {"clusters of the volume", "rect 6 6 1 1",
   ELASTIC("1000., 0.4999")
   "*SOLID SECTION, ELSET=BODY, MATERIAL=M, FORMULATION=AVERAGED\n"
   FLOOR("0.", "COULOMB") "*STEP\n*STATIC\n" PRESSED ALL},
  {"nonlocal friction, FORM=VELOCITY", "rect 6 4 1 1",
   ELASTIC("1000., 0.3") SECTION FLOOR("0.", "NONLOCAL, RADIUS=0.4")
   "*STEP\n*QUASISTATIC, FORM=VELOCITY\n0.5, 1.\n*BOUNDARY\nTOP, 1, 1, 0.01\n"
   "TOP, 2, 2, -0.01\n" ALL},
  {"given forces", "rect 6 4 1 1",
   ELASTIC("1000., 0.3") SECTION FLOOR("0.", "COULOMB")
   "*CONTACT FORCE, CONTACT=C\n\"2 + x\"\n*STEP\n*QUASISTATIC\n0.5, 1.\n"
   "*BOUNDARY\nTOP, 1, 1, 0.01\nTOP, 2\n" ALL},
  {"balanced increments and stopping", "rect 4 4 1 1",
   ELASTIC("1000., 0.3") SECTION FLOOR("0.", "COULOMB")
   "*STEP\n*QUASISTATIC\n0.25, 1., 0.01\n*SOLVER, TOL=BALANCED\n"
   "*ACCURACY, MESH=YES, TIME=BALANCED\n*BOUNDARY\nTOP, 1, 1, 0.01\n"
   "TOP, 2, 2, -0.01\n" ALL},
  {"an obstacle that turns, in space", "box 2 2 2 1 1 1",
   ELASTIC("1000., 0.3") SECTION
   "*OBSTACLE, NAME=O, TYPE=PLANE\n0.5, 0.5, 0.\n0., 0., 1.\n"
   "ROTATE, 0.5, 0.5, 0., 0., 0., 1., 0.01\n*CONTACT, NAME=C, GROUP=BOTTOM, "
   "OBSTACLE=O\nAXIS, 0.5, 0.5, 0., 0., 0., 1.\n*FRICTION, CONTACT=C, "
   "LAW=COULOMB\n0.3\n*STEP\n*QUASISTATIC\n0.5, 1.\n*BOUNDARY\n"
   "TOP, 1\nTOP, 2\nTOP, 3, 3, -0.01\n" ALL},
  {"a start, time points", "rect 4 4 1 1",
   ELASTIC("1000., 0.3") SECTION FLOOR("0.", "COULOMB")
   "*INITIAL CONDITIONS, TYPE=DISPLACEMENT, INCOMPATIBLE=RELAX\n"
   "TOP, 2, -0.001\n*TIME POINTS, NAME=T\n0.3, 0.8\n*STEP\n*QUASISTATIC\n"
   "0.5, 1.\n" PRESSED "*PRINT, CONTACT, ELEMENTS, TIME POINTS=T\n*END STEP\n"},
  {"no contact, moved support", "rect 4 4 1 1",
   ELASTIC("1000., 0.3") SECTION "*STEP\n*QUASISTATIC\n0.5, 1.\n"
   "*BOUNDARY\nBOTTOM, 2\nLEFT, 1\nTOP, 2, 2, -0.01\n"
   "*PRINT, NODES, ELEMENTS, ENERGY, REACTIONS\n*END STEP\n"}};
/* clang-format on */
enum { N_DECK = sizeof decks / sizeof *decks };

/* A deck as it is (NULL) or with other requests; the exit code. */
static int run_deck(job *j, int k, const asked *a) {
  static const mesh_change none;
  FREED int *number = NULL;
  *j = job_begin("deck");
  PRINTED(path, "%s/deck.msh", j->dir);
  FILE *f = fopen(path, "w");
  ck_assert_ptr_nonnull(f);
  ck_assert_int_eq(scene_mesh_write(f, decks[k].mesh, &none, &number), 1);
  fclose(f);
  PRINTED(text, "*MESH, FILE=deck.msh\n%s", decks[k].deck);
  FREED char *other = a == NULL ? NULL : asked_deck(text, a);
  job_write(j, "deck.inp", "%s", other == NULL ? text : other);
  return job_run(j, "--no-timing --quiet");
}

/* Nothing at all, and one combination after the other over the decks. */
TESTS(requests_change_no_number, N_DECK) {
  const asked some[] = {{"", "HDF5=NO", "SOLVER=NO"},
                        {NULL, "HDF5=NO", NULL},
                        asked_number((5 * _i + 1) % asked_count()),
                        asked_number((11 * _i + 3) % asked_count())};
  job whole, j;
  const int code = run_deck(&whole, _i, NULL);
  char *answer = asked_answer(&whole), text[200];
  ck_assert_msg(code == 0, "%s: exit %d: %s", decks[_i].name, code,
                whole.errors);
  for (size_t k = 0; k < sizeof some / sizeof *some; ++k) {
    const int found = run_deck(&j, _i, &some[k]);
    FREED char *other = asked_answer(&j);
    asked_text(&some[k], text);
    ck_assert_msg(found == code, "%s: %s: exit %d: %s", decks[_i].name, text,
                  found, j.errors);
    if (asked_keeps(decks[_i].deck, &some[k])) ck_assert_str_eq(other, answer);
    job_end(&j);
  }
  free(answer);
  job_end(&whole);
}

UNIT_MAIN_FOR("outputs", 10 * UNIT_SECONDS)
