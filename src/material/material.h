/*
 * Material laws: sigma = E e^e, e = e^e + e^i (CPR98 3.14-3.16). One law per
 * file, one row in MATERIAL_LIST.
 *
 * Components: plane and axisymmetric ns = 4: xx, yy, zz, xy (axisymmetric rr,
 * zz, theta, rz); 3-D ns = 6: xx, yy, zz, xy, yz, zx. Engineering shear strain.
 */
#pragma once

#include "base/message.h"
#include "deck/expression.h"

typedef enum { PLANE_STRAIN, PLANE_STRESS, AXISYMMETRIC, SOLID_3D } kinematics;
#define KINEMATICS_WORDS \
  "PLANE STRAIN|PLANE STRESS|AXISYMMETRIC|3D|CPE3|CPS3|CAX3|C3D4"

typedef enum { ELASTIC_ISO, ELASTIC_ORTHO, ELASTIC_ANISO } elastic_type;
#define ELASTIC_WORDS "ISO|ORTHO|ANISO"
enum { ELASTIC_MAX = 21 };

/*
 * The 6x6 elasticity matrix (xx, yy, zz, xy, yz, zx; column major), Pa:
 *   ISO    E, nu
 *   ORTHO  E1, E2, E3, nu12, nu13, nu23, G12, G13, G23 (Abaqus ENGINEERING)
 *   ANISO  21 constants of the symmetric matrix in the order of Abaqus
 * Ellipticity (CPR98 2.2): the matrix must be positive definite. NULL, or what
 * is wrong with the constants ("nu = 0.5 outside ]-1, 0.5[", ...); "text" may
 * be used for the answer.
 */
const char *elastic_matrix(elastic_type type, int n, const double *constants,
                           double C[36], char *text, int text_size);
/* ns*ns matrix for the kinematics: plane stress gives sigma_zz = 0. */
void elastic_reduce(const double C[36], kinematics kin, double *E);
/* Strain zz of plane stress from the in-plane strains: e[4] in and out. */
void elastic_zz_strain(const double C[36], double e[4]);

/* Constants over the temperature: linear between, constant outside. */
typedef struct elastic_constants {
  double temperature;
  double constant[ELASTIC_MAX]; /* Pa, - */
} elastic_constants;
typedef struct elastic_table {
  elastic_type type;
  int n_constant;
  int n;                  /* sets; 0: none is valid, 1: the same everywhere */
  elastic_constants *set; /* [n] their temperatures ascend, owned */
  double relaxed[2];      /* parts of G and K that the sets are without: those
                             of elastic_at are whole, - */
} elastic_table;
struct card; /* deck/deck.h */
/* From the data lines of a card: the constants of a set over any number of
 * lines, then its temperature (may be left out if there is one set). Errors go
 * to the log (n = 0 if a set is not whole); ERR_MEMORY. */
status elastic_table_read(const struct card *c, elastic_type type,
                          const char *material_name, message_log *log,
                          elastic_table *table);
/* elastic_matrix() of the constants at a temperature. */
const char *elastic_at(const elastic_table *t, double temperature, double C[36],
                       char *text, int text_size);
/* The sets of E, nu are what is left after the parts relaxed[2] of G and K have
 * relaxed. */
void elastic_table_relaxed(elastic_table *t, const double relaxed[2]);
/* Largest value of constant number i in any set. */
double elastic_table_most(const elastic_table *t, int i);

/* Thermal expansion along the axes xx, yy, zz (rr, zz, theta). */
typedef enum { EXPANSION_ISO, EXPANSION_ORTHO } expansion_type;
#define EXPANSION_WORDS "ISO|ORTHO"
typedef struct expansion {
  int given;            /* 0: the material does not expand */
  int type;             /* expansion_type */
  double zero;          /* temperature at which the secants start */
  value_table alpha[3]; /* 1/temperature over the temperature, which stands for
                           t; ISO: the first only; arrays owned */
} expansion;
/* Strain e[3] (no shear) at temperature T of what has none at T0, -. */
void expansion_strain(const expansion *x, double T, double T0, double e[3]);
