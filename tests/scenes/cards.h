/*
 * Cards that many scenes share.
 */
#pragma once

#define MATERIAL(E, nu)                     \
  "*MATERIAL, NAME=M\n*ELASTIC\n" E ", " nu \
  "\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
#define PLANE(name, group, point, normal)                     \
  "*OBSTACLE, NAME=O" name ", TYPE=PLANE\n" point "\n" normal \
  "\n*CONTACT, NAME=" name ", GROUP=" group ", OBSTACLE=O" name "\n"
#define COULOMB(contact, mu) \
  "*FRICTION, CONTACT=" contact ", LAW=COULOMB\n" mu "\n"
/* The plane y = 0 below BOTTOM with friction mu. */
#define FLOOR(mu) PLANE("C", "BOTTOM", "0., 0.", "0., 1.") COULOMB("C", mu)
#define STATIC "*STEP\n*STATIC\n@S"
#define QUASI(dt, total) "*STEP\n*QUASISTATIC@V\n" dt ", " total "\n@S"
#define VISCO(words, dt, total) \
  "*STEP\n*VISCO, " words "\n" dt ", " total "\n@S"
#define PRINT "*PRINT, CONTACT, NODES, TOTALS, ENERGY\n"
#define END PRINT "*END STEP\n"
#define LAST "*PRINT, CONTACT, NODES, TOTALS, ENERGY, FREQUENCY=0\n*END STEP\n"
