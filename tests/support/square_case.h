/*
 * Decks of inelastic strains on the unit square of square.geo, a *STATIC step
 * and the steps from *VISCO on; E = 1000, nu = 0.3, relaxation time 2 unless
 * said otherwise.
 */
#pragma once

#include "support/job.h"

typedef struct square_case {
  const char *elastic, *law; /* line of *ELASTIC; *INELASTIC with its lines  */
  const char *section, *model; /* TYPE=; cards before the first step */
  const char *load;  /* cards of the first step, *STATIC             */
  const char *visco; /* from *VISCO on, its line and cards           */
} square_case;

#define STEEL "1000., 0.3"
#define PROPORTIONAL "*INELASTIC, LAW=MAXWELL\n2.\n"
#define DEVIATORIC "*INELASTIC, LAW=MAXWELL, TYPE=DEVIATORIC\n2.\n"
#define SYMMETRY "*BOUNDARY\nLEFT, 1\nBOTTOM, 2\n"
#define HELD SYMMETRY "TOP, 2, 2, 1.E-3\n"
#define FLOOR(mu)                                \
  "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"         \
  "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n" \
  "*FRICTION, CONTACT=C, LAW=COULOMB\n" #mu "\n"
#define PRESS(p) "*BOUNDARY\nLEFT, 1\n*DSLOAD\nTOP, P, " #p "\n"

/* Tables of ELEMENTS, ENERGY, NODES, with contact CONTACT, of every increment
 * unless the case says otherwise; check fails if it does not end with that exit
 * code. */
job square_run(const square_case *s, int expected);
/* Table number k of the elements: all have that value. */
void square_all_have(const job *j, int k, const char *column, double expected,
                     double tolerance);
/* Column of table number k of the energies. */
double square_energy(const job *j, int k, const char *column);
