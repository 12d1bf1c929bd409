/*
 * Gauss-Legendre rules on [0, 1]. Inside src/contact/average only.
 */
#ifndef PROTIS_AVERAGE_GAUSS_H
#define PROTIS_AVERAGE_GAUSS_H

enum { GAUSS_COARSE = 4, GAUSS_FINE = 8 };

typedef struct gauss_point {
  double at, weight;
} gauss_point;

extern const gauss_point gauss_coarse[GAUSS_COARSE];
extern const gauss_point gauss_fine[GAUSS_FINE];

#endif
