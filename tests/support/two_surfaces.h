/*
 * Two surfaces without bodies behind them, for the tests of src/contact/mortar:
 * faces of one mesh.
 */
#pragma once

#include "base/memory.h"
#include "contact/mortar/mortar.h"

typedef struct pair {
  mesh m;
  mortar_input in;
  int *slave, *master;
  double *weight;
  unsigned char *dropped;
} pair;

/* Room for 4000 nodes and 8000 faces. */
pair two_new(int dim);
void two_free(pair *p);
/* OWN_PAIR p = ...: freed where the name ends. */
#define OWN_PAIR ENDS_BY(two_free) pair
/* Their coupling, new (memory_free); at in.x, or where it is NULL at rest. */
mortar *two_couple(pair *p);
void two_add_face(pair *p, int of_slave, const int *node);
/* Its id; z in 3-D alone. */
int two_add_node(pair *p, double x, double y, double z);
/* n edges on y = 0 from x0 to x1, inner nodes moved by part jitter of an edge;
 * the slave is above (normal down). */
void two_add_line(pair *p, int of_slave, int n, double x0, double x1,
                  double jitter);
/* n x n squares of two triangles each on z = 0 over [x0, x1]^2. */
void two_add_square(pair *p, int of_slave, int n, double x0, double x1,
                    double jitter);
/* Reproducible numbers in [-1/2, 1/2]. */
double two_noise(void);
void two_seed(unsigned n);
/* The sum of the parts of row q. */
double two_part_sum(const mortar *m, int q);
