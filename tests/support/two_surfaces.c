#include "support/two_surfaces.h"

#include "base/base.h"

#include <check.h>

enum { MOST_NODES = 4000, MOST_FACES = 8000 };

pair two_new(int dim) {
  pair p = {.m.dim = dim};
  p.m.x = calloc(3 * MOST_NODES, sizeof *p.m.x);
  p.m.face = calloc(3 * MOST_FACES, sizeof *p.m.face);
  p.slave = calloc(MOST_FACES, sizeof *p.slave);
  p.master = calloc(MOST_FACES, sizeof *p.master);
  p.weight = calloc(MOST_FACES, sizeof *p.weight);
  p.dropped = calloc(MOST_NODES, 1);
  for (int i = 0; i < MOST_FACES; ++i) p.weight[i] = 1;
  return p;
}

void two_free(pair *p) {
  free(p->m.x);
  free(p->m.face);
  free(p->slave);
  free(p->master);
  free(p->weight);
  free(p->dropped);
}

mortar *two_couple(pair *p) {
  mortar *out = NULL;
  p->in.mesh = &p->m;
  p->in.slave = p->slave;
  p->in.master = p->master;
  if (p->in.x == NULL) p->in.x = p->m.x;
  p->in.face_weight = p->weight;
  p->in.dropped = p->dropped;
  ck_assert_int_eq(mortar_couple(&p->in, &out), OK);
  return out;
}

void two_add_face(pair *p, int of_slave, const int *node) {
  memcpy(p->m.face + p->m.dim * p->m.n_face, node,
         (size_t)p->m.dim * sizeof *node);
  if (of_slave)
    p->slave[p->in.n_slave++] = p->m.n_face++;
  else
    p->master[p->in.n_master++] = p->m.n_face++;
}

int two_add_node(pair *p, double x, double y, double z) {
  double *at = p->m.x + p->m.dim * p->m.n_node;
  at[0] = x;
  at[1] = y;
  if (p->m.dim == 3) at[2] = z;
  return p->m.n_node++;
}

static unsigned seed = 1;

void two_seed(unsigned n) { seed = n; }

double two_noise(void) {
  seed = seed * 1103515245u + 12345u;
  return ((seed >> 8) & 0xffff) / 65535.0 - 0.5;
}

void two_add_line(pair *p, int of_slave, int n, double x0, double x1,
                  double jitter) {
  const int first = p->m.n_node;
  for (int i = 0; i <= n; ++i)
    two_add_node(
        p, x0 + (x1 - x0) * (i + (i % n == 0 ? 0 : jitter * two_noise())) / n,
        0, 0);
  for (int i = 0; i < n; ++i)
    two_add_face(p, of_slave,
                 of_slave ? (int[]){first + i, first + i + 1}
                          : (int[]){first + i + 1, first + i});
}

void two_add_square(pair *p, int of_slave, int n, double x0, double x1,
                    double jitter) {
  const int first = p->m.n_node;
  const double h = (x1 - x0) / n;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
      two_add_node(p, x0 + h * (i + (i % n == 0 ? 0 : jitter * two_noise())),
                   x0 + h * (j + (j % n == 0 ? 0 : jitter * two_noise())), 0);
  for (int k = 0; k < n * n; ++k) {
    const int a = first + k / n * (n + 1) + k % n, b = a + 1, c = a + n + 2,
              d = a + n + 1;
    const int up[2][3] = {{a, b, c}, {a, c, d}};
    for (int t = 0; t < 2; ++t)
      two_add_face(p, of_slave,
                   of_slave ? (int[]){up[t][0], up[t][2], up[t][1]} : up[t]);
  }
}

double two_part_sum(const mortar *m, int q) {
  double sum = 0;
  for (size_t e = m->to.start[q]; e < m->to.start[q + 1]; ++e)
    sum += m->to.part[(size_t)m->to.dim * e];
  return sum;
}
