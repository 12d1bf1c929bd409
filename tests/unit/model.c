/* src/model: decks to models, loads of the steps, the echo of a deck. */
#include "effects/rows.h"
#include "model/check/check.h"
#include "model/facts.h"
#include "model/keyword/keyword.h"
#include "support/text_model.h"
#include "support/unit.h"

static mesh *square(void) {
  const int n[] = {3, 2};
  const double length[] = {6.0, 4.0};
  return make_grid_2d(n, length);
}

static mesh *box(void) {
  const int n[] = {2, 2, 2};
  const double length[] = {2.0, 3.0, 4.0};
  return make_grid_3d(n, length);
}

#define HEAD                                                        \
  "*MESH, FILE=none.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n" \
  "*DENSITY\n2.5\n"

/* Sum of the forces along c and moment about z of the nodal forces. */
static double resultant(const mesh *msh, const double *F, int c) {
  double sum = 0.0;
  for (int i = 0; i < msh->n_node; ++i) sum += F[msh->dim * i + c];
  return sum;
}

static double moment_z(const mesh *msh, const double *F) {
  double sum = 0.0;
  for (int i = 0; i < msh->n_node; ++i) {
    const double *x = msh->x + msh->dim * i, *f = F + msh->dim * i;
    sum += x[0] * f[1] - x[1] * f[0];
  }
  return sum;
}

/* One row per load: its card, and the resultant from the closed form. */
typedef struct load_case {
  const char *section, *cards;
  int dim;
  double force[3], moment;
} load_case;

/* Rectangle 6 x 4 thickness 0.5; box 2 x 3 x 4. Axisymmetric: radii 0 to 6. */
static const load_case load_cases[] = {
    {"THICKNESS=0.5", "*DSLOAD\nTOP, P, 3.\n", 2, {0, -9.0, 0}, -27.0},
    {"THICKNESS=0.5", "*DSLOAD\nRIGHT, TY, 2.\n", 2, {0, 4.0, 0}, 24.0},
    /* p = x on the top: 18*0.5, at x = 4 */
    {"THICKNESS=0.5", "*DSLOAD\nTOP, P, \"x\"\n", 2, {0, -9.0, 0}, -36.0},
    {"THICKNESS=0.5", "*DLOAD\nBODY, BX, 2.\n", 2, {24.0, 0, 0}, -48.0},
    {"THICKNESS=0.5",
     "*DLOAD\nBODY, GRAV, 10., 0., -2.\n",
     2,
     {0, -300.0, 0},
     -900.0},
    {"", "*CLOAD\nLEFT, 1, 7.\n", 2, {21.0, 0, 0}, -42.0},
    /* Whole turn: pressure 3 on the disc of radius 6; moment is no matter. */
    {"TYPE=AXISYMMETRIC",
     "*DSLOAD\nTOP, P, 3.\n",
     2,
     {0, -339.29200658769764},
     NAN},
    /* Volume pi 36 4, force 2 per volume along z. */
    {"TYPE=AXISYMMETRIC",
     "*DLOAD\nBODY, BY, 2.\n",
     2,
     {0, 904.7786842338604},
     NAN},
    /* p = r on the disc: 2 pi 6^3 / 3 */
    {"TYPE=CAX3", "*DSLOAD\nTOP, P, \"x\"\n", 2, {0, -452.3893421169302}, NAN},
    {"", "*DSLOAD\nTOP, P, 3.\n", 3, {0, -24.0, 0}, -24.0},
    {"", "*DSLOAD\nBACK, TX, \"y\"\n", 3, {9.0, 0, 0}, NAN},
    {"", "*DLOAD\nBODY, BZ, 5.\n", 3, {0, 0, 120.0}, 0.0},
    {"",
     "*DLOAD\nBODY, GRAV, 10., 3., 0., -4.\n",
     3,
     {360.0, 0, -480.0},
     -540.0}};

TEST(resultant_is_the_integral_of_the_load) {
  for (size_t k = 0; k < sizeof load_cases / sizeof *load_cases; ++k) {
    const load_case *c = &load_cases[k];
    PRINTED(text,
            HEAD
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M%s%s\n*STEP\n*STATIC\n"
            "%s*END STEP\n",
            c->section[0] ? ", " : "", c->section, c->cards);
    TEXT_MODEL s = text_model_read(text, c->dim == 2 ? square() : box());
    ck_assert_int_eq(s.st, OK);
    FREED double *F = calloc((size_t)(c->dim * s.msh->n_node), sizeof *F);
    ck_assert_int_eq(load_forces(s.m, s.msh, &s.m->steps[0], 1.0, F), OK);
    for (int a = 0; a < c->dim; ++a)
      if (!(c->section[0] == 'T' && c->section[1] == 'Y' && a == 0))
        ck_assert_double_eq_tol(resultant(s.msh, F, a), c->force[a], 1e-10);
    if (!isnan(c->moment))
      ck_assert_double_eq_tol(moment_z(s.msh, F), c->moment, 1e-10);
  }
}

/* Value of the first load of a step at time t at the origin, as the force on
 * the group of one corner... here: all nodes of LEFT carry the same force. */
static double point_force(const text_model *s, int step_id, double t) {
  FREED double *F = calloc((size_t)(2 * s->msh->n_node), sizeof *F);
  ck_assert_int_eq(load_forces(s->m, s->msh, &s->m->steps[step_id], t, F), OK);
  return F[2 * s->msh->group[1].node_id[0]];
}

TEST(loads_ramp_stay_change_and_end) {
  TEXT_MODEL s = text_model_read(
      HEAD
      "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
      "*AMPLITUDE, NAME=UP\n0., 0., 1., 1., 3., 5.\n"
      "*STEP\n*QUASISTATIC\n0.5, 2.\n*CLOAD\nLEFT, 1, 8.\n*END STEP\n"
      "*STEP\n*QUASISTATIC\n1., 1.\n*END STEP\n"
      "*STEP\n*QUASISTATIC\n1., 2.\n*CLOAD\nLEFT, 1, 2.\n*END STEP\n"
      "*STEP\n*QUASISTATIC\n1., 2.\n*CLOAD\nLEFT, 1, 2., UP\n*END STEP\n"
      "*STEP\n*QUASISTATIC\n1., 1.\n*END STEP\n"
      "*STEP\n*QUASISTATIC\n1., 1.\n*CLOAD, OP=NEW\n*END STEP\n"
      "*STEP\n*QUASISTATIC\n1., 1.\n*END STEP\n",
      square());
  ck_assert_int_eq(s.st, OK);
  ck_assert_str_eq(s.msh->group[1].name, "LEFT");
  ck_assert_double_eq(point_force(&s, 0, 0.5), 2.0); /* ramp 0 to 8 over 2 */
  ck_assert_double_eq(point_force(&s, 0, 2.0), 8.0);
  ck_assert_double_eq(point_force(&s, 1, 2.5), 8.0); /* stays               */
  ck_assert_double_eq(point_force(&s, 2, 4.0), 5.0); /* ramp 8 to 2          */
  ck_assert_double_eq(point_force(&s, 3, 6.0), 2.0); /* step time 1: 2 * 1   */
  ck_assert_double_eq(point_force(&s, 3, 7.0), 6.0); /* step time 2: 2 * 3   */
  ck_assert_double_eq(point_force(&s, 4, 7.5), 6.0); /* held at the end      */
  ck_assert_double_eq(point_force(&s, 5, 8.5), 3.0); /* OP=NEW: down to zero */
  ck_assert_int_eq(s.m->steps[6].loads.n, 0);
}

/* In axisymmetry r and z are the coordinates, as x and y of the mesh are; r of
 * a *PARAMETER is that; elsewhere r is no name. */
TEST(expressions_have_the_coordinates_of_the_section) {
  static const struct {
    const char *parameter, *type, *expression;
    double value; /* at (2, 3) after 5 s; NAN: refused */
  } rows[] = {{"", "CAX3", "r + 10*z + 100*t", 532},
              {"", "CAX3", "x + 10*y", 32},
              {"*PARAMETER\nR = 7\n", "CAX3", "r + 10*z", 37},
              {"*PARAMETER\nR = 7\n", "CAX3", "x + 10*z + 0*r", 32},
              {"", "CPE3", "x + 10*y + 100*t", 532},
              {"", "CPE3", "r", NAN},
              {"", "CAX3", "10*q", NAN}};
  static const double at[3] = {2, 3, 0};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
    PRINTED(text,
            "%s" HEAD
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=%s\n"
            "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
            "*CONTACT, NAME=C, GROUP=LEFT, OBSTACLE=O\n"
            "*FRICTION, CONTACT=C, LAW=COULOMB, TABLE=%s\n"
            "0., 0., 6., 3.\n"
            "*STEP\n*STATIC\n*DSLOAD\nBOTTOM, P, \"%s\"\n*END STEP\n",
            rows[i].parameter, rows[i].type,
            strcmp(rows[i].type, "CAX3") == 0 ? "Z" : "Y", rows[i].expression);
    TEXT_MODEL s = text_model_read(text, square());
    ck_assert_int_eq(s.st, isnan(rows[i].value) ? ERR_DECK : OK);
    if (s.st == OK) {
      const quantity *q = &s.m->steps[0].loads.item[0].value;
      const value_table *mu = &s.m->contacts[0].friction.position;
      ck_assert_double_eq(quantity_value(q, at, 5), rows[i].value);
      ck_assert_double_eq(table_value(mu, at, 5), 1.5);
    }
  }
}

TEST(echo_reads_back_to_the_same_echo) {
  static const char text[] =
      "*HEADING\nA title, with a comma\n*PARAMETER\nH = 0.1\n"
      "*UNITS, LENGTH=mm\n" HEAD
      "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=CPS3, THICKNESS=<H>\n"
      "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\nMOVE, 0., \"0.1*t\"\n"
      "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
      "*FRICTION, CONTACT=C, LAW=COULOMB\n\"0.3 + h*x\"\n"
      "*STEP\n*QUASISTATIC\n0.1, 1.\n*BOUNDARY\nTOP, 1, 2, 0.\n"
      "*SOLVER, METHOD=SOR, TOL=1.D-9\n*PRINT, CONTACT\n*END STEP\n";
  char *echo[2] = {NULL, NULL};
  for (int pass = 0; pass < 2; ++pass) {
    size_t size;
    TEXT_MODEL s = text_model_read(pass == 0 ? text : echo[0], square());
    ck_assert_int_eq(s.st, OK);
    FILE *f = open_memstream(&echo[pass], &size);
    model_echo(f, s.m);
    fclose(f);
  }
  ck_assert_str_eq(echo[0], echo[1]);
  ck_assert_ptr_nonnull(strstr(echo[0], "THICKNESS=0.1"));
  ck_assert_ptr_nonnull(strstr(echo[0], "LIMIT_MAX_ITER=1000"));
  ck_assert_ptr_nonnull(strstr(echo[0], "A title, with a comma"));
  free(echo[0]);
  free(echo[1]);
}

/* Of any length, also one whose square is no number. */
TEST(directions_have_unit_length) {
  static const char *const given[] = {"3E-200, 4E-200", "3E200, 4E200",
                                      "0.3, 0.4"};
  for (size_t k = 0; k < sizeof given / sizeof *given; ++k) {
    PRINTED(text,
            HEAD
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=CPS3\n"
            "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n%s\n"
            "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
            "*STEP\n*STATIC\n*BOUNDARY\nTOP, 1, 2, 0.\n*END STEP\n",
            given[k]);
    TEXT_MODEL s = text_model_read(text, square());
    ck_assert_int_eq(s.st, OK);
    const double *n = s.m->obstacles[0].direction;
    ck_assert_double_eq_tol(n[0], 0.6, 1e-15);
    ck_assert_double_eq_tol(n[1], 0.8, 1e-15);
  }
}

TEST(effects_are_what_the_deck_calls_for) {
  TEXT_MODEL s =
      text_model_read(HEAD
                      "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
                      "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
                      "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
                      "*FRICTION, CONTACT=C, LAW=COULOMB\n0.\n"
                      "*STEP\n*STATIC\n*DSLOAD\nTOP, P, 1.\n*OUTPUT, HDF5=NO\n"
                      "*ACCURACY, SOLVER=NO, MESH=NO\n*END STEP\n",
                      square());
  ck_assert_int_eq(s.st, OK);
  ck_assert_uint_eq(s.m->effects, EFFECT_CONTACT | EFFECT_MESH);
}

/* Of a step, or of the last of two: held at rest, moved, let go, taken later.
 */
TEST(supports_that_move_are_found) {
  static const struct {
    const char *first, *last;
    int moves;
  } cases[] = {{"*BOUNDARY\nTOP, 1, 2\n", "", 0},
               {"*BOUNDARY\nTOP, 1, 2, 0.1\n", "", 1},
               {"*BOUNDARY\nTOP, 1, 2, \"t - 1\"\n", "", 1},
               {"*BOUNDARY\nTOP, 1, 2\n", "*BOUNDARY\nTOP, 1, 1, 0.1\n", 1},
               {"*BOUNDARY\nTOP, 1, 2\n", "*BOUNDARY, OP=NEW\n", 1},
               {"*BOUNDARY\nTOP, 1, 2\n", "*BOUNDARY\nLEFT, 1\n", 1}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    PRINTED(text,
            HEAD
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*STEP\n*STATIC\n%s*END STEP\n*STEP\n*STATIC\n%s*END STEP\n",
            cases[k].first, cases[k].last);
    TEXT_MODEL s = text_model_read(text, square());
    ck_assert_int_eq(s.st, OK);
    ck_assert_msg((facts_moving_support(s.m) != NULL) == cases[k].moves, "%s",
                  text);
  }
}

/* xx yy zz xy yz zx. */
TEST(initial_strains_have_the_components_of_the_space) {
  for (int c = 0; c <= 7; ++c) {
    PRINTED(text,
            HEAD
            "*INELASTIC, LAW=MAXWELL\n2.\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*INITIAL CONDITIONS, TYPE=INELASTIC STRAIN\nBODY, %d, 1.E-3\n"
            "*STEP\n*VISCO, INTEGRATOR=RK4\n0.5, 1.\n*BOUNDARY\nTOP, 1, "
            "3\n*END STEP\n",
            c);
    TEXT_MODEL s = text_model_read(text, box());
    ck_assert_int_eq(s.st, c >= 1 && c <= 6 ? OK : ERR_DECK);
  }
}

/* A static step keeps the strains that a body starts with; it has none else. */
TEST(strains_of_the_start_need_a_value) {
  static const char *const cards[] = {
      "", "*INITIAL CONDITIONS, TYPE=INTERNAL\nBODY, 1, 1.E-3\n"};
  for (int k = 0; k < 2; ++k) {
    PRINTED(text,
            HEAD
            "*INELASTIC, LAW=KELVIN\n500., 3.\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "%s*STEP\n*STATIC\n*BOUNDARY\nTOP, 1, 2\n*END STEP\n",
            cards[k]);
    TEXT_MODEL s = text_model_read(text, square());
    ck_assert_int_eq(s.st, OK);
    ck_assert_int_eq(facts_has_inelastic(s.m), k);
  }
}

/* Zones of a body and some of its elements, whose temperatures are those of one
 * expression or not. */
TEST(zones_have_one_temperature) {
  static const struct {
    const char *initial, *heat;
    int n;
  } cases[] = {{"", "BODY, 20.\nLEFT, 20.\n", 1},
               {"", "BODY, 20.\nLEFT, 30.\n", 2},
               {"", "BODY, 20., A\nLEFT, 20., A\n", 1},
               {"", "BODY, 20., A\nLEFT, 20., B\n", 2},
               {"", "BODY, 20.\nLEFT, 20., B\n", 2},
               {"", "BODY, \"x\"\nLEFT, \"y\"\n", 2},
               {"", "LEFT, 20.\n", 2},
               {"LEFT, 5.\n", "BODY, 20.\n", 2},
               {"BODY, 5.\nLEFT, 5.\n", "BODY, 20.\n", 1},
               {"BODY, 5.\nLEFT, 6.\n", "BODY, 20.\n", 2},
               {"BODY, 5.\nLEFT, 6.\n", "BODY, 20.\nLEFT, 7.\n", 2}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    mesh *msh = square();
    int zone[12], others = 0;
    ck_assert_int_eq(msh->n_elem, 12);
    for (int i = 0; i < msh->n_group; ++i)
      if (strcmp(msh->group[i].name, "LEFT") == 0) msh->group[i].dim = 2;
    PRINTED(text,
            HEAD
            "*EXPANSION\n1E-5\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*AMPLITUDE, NAME=A\n0., 0., 1., 1.\n"
            "*AMPLITUDE, NAME=B\n0., 0., 1., 0.5\n"
            "%s%s*STEP\n*STATIC\n*TEMPERATURE\n%s"
            "*BOUNDARY\nTOP, 1, 2\n*END STEP\n",
            cases[k].initial[0] != '\0'
                ? "*INITIAL CONDITIONS, TYPE=TEMPERATURE\n"
                : "",
            cases[k].initial, cases[k].heat);
    TEXT_MODEL s = text_model_read(text, msh);
    ck_assert_int_eq(s.st, OK);
    ck_assert_int_eq(load_temperature_zones(s.m, s.msh, zone), OK);
    for (int i = 0; i < 12; ++i) others |= zone[i] != zone[0];
    ck_assert_msg(1 + others == cases[k].n, "%s", cases[k].heat);
  }
}

TEST(every_refused_request_is_reported) {
  static const char text[] = HEAD
      "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
      "*AMPLITUDE, NAME=A\n0., 0., 1., 1.\n"
      "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
      "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
      "*FRICTION, CONTACT=C, LAW=COULOMB, TABLE=X\n0., 0.1, 1., 0.2\n"
      "*STEP\n*STATIC\n*BOUNDARY\nTOP, 1, 2\n*DSLOAD\nRIGHT, P, 1., A\n"
      "*SOLVER, METHOD=SOR\n*PRINT, CONTACT, NODES\n*END STEP\n"
      "*STEP\n*STATIC\n*END STEP\n";
  TEXT_MODEL s = text_model_read(text, square());
  ck_assert_int_eq(s.st, OK);
  memory_free(s.m);
  size_t before = memory_in_use();
  int refused = 0, done = 0;
  for (long k = 1; !done; ++k) {
    s.m = NULL;
    memory_refuse(k, 0);
    status st = model_from_deck(s.d, s.log, &s.m);
    if (st == OK) st = model_check(s.m, s.msh, effects_required);
    done = st == OK;
    memory_refuse(0, 0);
    refused += st == ERR_MEMORY;
    ck_assert(st == OK || st == ERR_MEMORY);
    memory_free(s.m);
  }
  s.m = NULL;
  ck_assert_int_gt(refused, 10);
  ck_assert_uint_le(memory_in_use(), before + 64);
}

UNIT_MAIN("model")
