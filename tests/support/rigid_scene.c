/* Rigid bodies in contact (rigid_scene.h). */
#include "support/rigid_scene.h"

#include "base/base.h"
#include "support/fclib_file.h"

/* A body: mass, moment of inertia, centre; a contact: body above, body below or
 * FLOOR, point, normal from below to above and tangents. */
enum { MOST_BODIES = 400, MOST_CONTACTS = 1200, FLOOR = -1 };
typedef struct body {
  double mass, inertia, x[3];
} body;
typedef struct joint {
  int above, below;
  double p[3], frame[3][3]; /* rows: N, T1, T2                                */
} joint;
typedef struct layout {
  int dim, n_body, n_joint;
  body bodies[MOST_BODIES];
  joint joints[MOST_CONTACTS];
} layout;

static int add_body(layout *l, double mass, double size, const double *x) {
  body *b = &l->bodies[l->n_body];
  b->mass = mass;
  b->inertia = mass * size * size / 6.0;
  memcpy(b->x, x, sizeof b->x);
  return l->n_body++;
}

static void add_joint(layout *l, int above, int below, const double *p,
                      const double *normal) {
  joint *j = &l->joints[l->n_joint++];
  j->above = above;
  j->below = below;
  memcpy(j->p, p, sizeof j->p);
  double a[3] = {0.0, 0.0, 0.0};
  a[l->dim == 2 || fabs(normal[0]) > 0.7 ? 2 : 0] = 1.0;
  /* T2 = N x a normalised, T1 = T2 x N; plane: T1 = N turned */
  const double *n = normal;
  double t[3] = {n[1] * a[2] - n[2] * a[1], n[2] * a[0] - n[0] * a[2],
                 n[0] * a[1] - n[1] * a[0]};
  double size = sqrt(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]);
  for (int k = 0; k < 3; ++k) {
    j->frame[0][k] = n[k];
    j->frame[1][k] = t[k] / size;
  }
  for (int k = 0; k < 3; ++k)
    j->frame[2][k] = n[(k + 1) % 3] * j->frame[1][(k + 2) % 3] -
                     n[(k + 2) % 3] * j->frame[1][(k + 1) % 3];
}

/* Contacts at the corners of a face: centre c, half width "half" along "along",
 * half a unit along z in space. */
static void add_face(layout *l, int above, int below, const double *c,
                     const double *along, double half, const double *normal) {
  for (int k = 0; k < (l->dim == 2 ? 2 : 4); ++k) {
    double p[3], side = k & 1 ? half : -half, z = k & 2 ? 0.5 : -0.5;
    for (int a = 0; a < 3; ++a) p[a] = c[a] + side * along[a];
    p[2] += l->dim == 3 ? z : 0.0;
    add_joint(l, above, below, p, normal);
  }
}

static const double UP[3] = {0.0, 1.0, 0.0}, RIGHT[3] = {1.0, 0.0, 0.0};

static void lay_box(layout *l, int size) {
  const double centre[3] = {0.0, 0.5, 0.0};
  int box = add_body(l, 1.0, 1.0, centre);
  for (int i = 0; i < size; ++i) {
    double x = size > 1 ? i / (size - 1.0) - 0.5 : 0.0;
    double p[3] = {x, 0.0, l->dim == 3 ? 0.5 * cos(7.0 * i) : 0.0};
    add_joint(l, box, FLOOR, p, UP);
  }
}

static void lay_tower(layout *l, int size) {
  for (int i = 0; i < size; ++i) {
    const double centre[3] = {0.0, i + 0.5, 0.0}, foot[3] = {0.0, i, 0.0};
    int box = add_body(l, 1.0, 1.0, centre);
    add_face(l, box, i == 0 ? FLOOR : box - 1, foot, RIGHT, 0.5, UP);
  }
}

static void lay_wall(layout *l, int size) {
  int rows = 1;
  while ((rows + 1) * (rows + 2) / 2 <= size) ++rows;
  for (int row = 0, under = 0; row < rows; ++row) {
    int first = l->n_body, count = rows - row;
    for (int i = 0; i < count; ++i) {
      double x = i + 0.5 * row;
      const double centre[3] = {x, row + 0.5, 0.0};
      int box = add_body(l, 1.0, 1.0, centre);
      for (int side = 0; side < (row == 0 ? 1 : 2); ++side) {
        double at = row == 0 ? x : x - 0.25 + 0.5 * side;
        const double foot[3] = {at, row, 0.0};
        add_face(l, box, row == 0 ? FLOOR : under + i + side, foot, RIGHT,
                 row == 0 ? 0.5 : 0.25, UP);
      }
    }
    under = first;
  }
}

static void lay_arch(layout *l, int size) {
  const double pi = acos(-1.0), radius = size / pi + 0.5;
  for (int i = 0; i <= size; ++i) {
    double joint_at = pi * i / size, middle = pi * (i + 0.5) / size;
    const double out[3] = {cos(joint_at), sin(joint_at), 0.0};
    const double onward[3] = {-sin(joint_at), cos(joint_at), 0.0};
    const double back[3] = {sin(joint_at), -cos(joint_at), 0.0};
    const double centre[3] = {radius * cos(middle), radius * sin(middle), 0.0};
    const double c[3] = {radius * out[0], radius * out[1], 0.0};
    int wedge = i < size ? add_body(l, 1.0, 1.0, centre) : FLOOR;
    if (i < size)
      add_face(l, wedge, i - 1, c, out, 0.5, onward);
    else
      add_face(l, i - 1, FLOOR, c, out, 0.5, back);
  }
}

/* Round bodies on a shaken grid; neighbours touch with a likelihood. */
static void lay_heap(layout *l, int size, unsigned long long *seed) {
  int side = l->dim == 2 ? (int)ceil(sqrt(size)) : (int)ceil(cbrt(size));
  for (int i = 0; i < size; ++i) {
    double x[3] = {i % side, l->dim == 2 ? i / side : i / (side * side),
                   l->dim == 2 ? 0.0 : i / side % side};
    for (int k = 0; k < l->dim; ++k) x[k] += 0.4 * (case_random(seed) - 0.5);
    int ball = add_body(l, 0.5 + case_random(seed), 1.0, x);
    double p[3] = {x[0], x[1] - 0.5, x[2]};
    if (i < (l->dim == 2 ? side : side * side))
      add_joint(l, ball, FLOOR, p, UP);
    for (int j = 0; j < i; ++j) {
      double d[3], size2 = 0.0;
      for (int k = 0; k < 3; ++k) {
        d[k] = x[k] - l->bodies[j].x[k];
        size2 += d[k] * d[k];
      }
      if (size2 > 1.4 || case_random(seed) > 0.8) continue;
      for (int k = 0; k < 3; ++k) {
        d[k] /= sqrt(size2);
        p[k] = 0.5 * (x[k] + l->bodies[j].x[k]);
      }
      if (l->n_joint < MOST_CONTACTS) add_joint(l, ball, j, p, d);
    }
  }
}

/* What a body's velocities do along direction d at point p, into one column of
 * H; the body's: x, y and the turn about z, or all six. */
static void add_column(const layout *l, int who, double sign, const double *p,
                       const double *d, double *column) {
  if (who == FLOOR) return;
  const double *x = l->bodies[who].x;
  double arm[3] = {p[0] - x[0], p[1] - x[1], p[2] - x[2]};
  int first = who * (l->dim == 2 ? 3 : 6), dim = l->dim;
  for (int k = 0; k < dim; ++k) column[first + k] += sign * d[k];
  for (int k = dim == 2 ? 2 : 0; k < 3; ++k)
    column[first + (dim == 2 ? 2 : 3 + k)] +=
        sign *
        (arm[(k + 1) % 3] * d[(k + 2) % 3] - arm[(k + 2) % 3] * d[(k + 1) % 3]);
}

static void set_matrices(const layout *l, rigid_scene *s) {
  int per = l->dim == 2 ? 3 : 6;
  size_t nv = (size_t)s->n_v;
  for (int i = 0; i < s->n_v; ++i) {
    const body *b = &l->bodies[i / per];
    s->M[i] = i % per < l->dim ? b->mass : b->inertia;
  }
  for (int j = 0; j < s->m; ++j) {
    const joint *at = &l->joints[j / l->dim];
    const double *d = at->frame[j % l->dim];
    double *column = s->H + nv * (size_t)j;
    add_column(l, at->above, 1.0, at->p, d, column);
    add_column(l, at->below, -1.0, at->p, d, column);
  }
  for (size_t j = 0; j < (size_t)s->m; ++j)
    for (size_t k = 0; k < nv; ++k) {
      double h = s->H[k + nv * j] / s->M[k];
      s->q[j] += h * s->f[k];
      for (size_t i = 0; i < (size_t)s->m && h != 0.0; ++i)
        s->W[i + (size_t)s->m * j] += h * s->H[k + nv * i];
    }
}

/* Weight; a third of the scenes at rest, the others pushed or moving. */
static void set_load(const layout *l, rigid_scene *s, int how,
                     unsigned long long *seed) {
  int per = l->dim == 2 ? 3 : 6;
  for (int i = 0; i < s->n_v; ++i) {
    const body *b = &l->bodies[i / per];
    double mass = i % per < l->dim ? b->mass : b->inertia;
    if (i % per == 1) s->f[i] = -0.01 * mass;
    if (how == 1 && i % per == 0) s->f[i] += 0.003 * mass * case_random(seed);
    if (how == 2) s->f[i] += 0.1 * mass * (case_random(seed) - 0.5);
  }
}

static double *zeros(int n) { return calloc((size_t)n + 1, sizeof(double)); }

rigid_scene rigid_new(rigid_kind kind, int dim, int size, double mu,
                      unsigned long long seed) {
  rigid_scene s = {.dim = dim};
  layout *l = calloc(1, sizeof *l);
  int how = (int)(seed % 3);
  seed = seed * 2654435761u + 88172645463325252u;
  for (int i = 0; i < 20; ++i) case_random(&seed);
  l->dim = dim;
  if (kind == RIGID_BOX) lay_box(l, size);
  if (kind == RIGID_TOWER) lay_tower(l, size);
  if (kind == RIGID_WALL) lay_wall(l, size);
  if (kind == RIGID_ARCH) lay_arch(l, size);
  if (kind == RIGID_HEAP) lay_heap(l, size, &seed);
  s.n = l->n_joint;
  s.m = dim * s.n;
  s.n_v = l->n_body * (dim == 2 ? 3 : 6);
  s.M = zeros(s.n_v);
  s.f = zeros(s.n_v);
  s.H = zeros(s.n_v * s.m);
  s.W = zeros(s.m * s.m);
  s.q = zeros(s.m);
  s.w = zeros(s.m);
  s.mu = zeros(s.n);
  for (int i = 0; i < s.n; ++i) s.mu[i] = mu;
  set_load(l, &s, how, &seed);
  set_matrices(l, &s);
  free(l);
  return s;
}

void rigid_free(rigid_scene *s) {
  free(s->M);
  free(s->f);
  free(s->H);
  free(s->W);
  free(s->q);
  free(s->w);
  free(s->mu);
}

const char *rigid_name(rigid_kind kind) {
  static const char *const names[RIGID_KINDS] = {"box", "tower", "wall", "arch",
                                                 "heap"};
  return names[kind];
}

contact_case rigid_case(const rigid_scene *s) {
  double most = 0.0;
  for (int i = 0; i < s->n; ++i) most = fmax(most, s->mu[i]);
  contact_case c = case_new(s->dim, s->n, most);
  for (int i = 0; i < s->n; ++i) c.B->val[i] = s->mu[i];
  for (int j = 0; j < s->m; ++j) {
    double sign = j % s->dim == 0 ? -1.0 : 1.0;
    c.f[j] = sign * s->q[j];
    for (int i = 0; i < s->m; ++i) {
      size_t at = (size_t)i + (size_t)s->m * (size_t)j;
      c.A[at] = (i % s->dim == 0 ? -sign : sign) * s->W[at];
    }
  }
  c.cp.A = NULL;
  c.cp.W = c.A;
  return c;
}

void rigid_disturb(rigid_scene *s, double share, unsigned long long seed) {
  seed += 77;
  for (int k = 0; k < s->m * s->m; ++k)
    s->W[k] *= 1.0 + share * (case_random(&seed) - 0.5);
}

double rigid_violation(const rigid_scene *s, const contact_case *c) {
  double *u = zeros(s->m), *r = zeros(s->m);
  for (int j = 0; j < s->m; ++j) {
    double sign = j % s->dim == 0 ? -1.0 : 1.0;
    u[j] = sign * c->u[j];
    r[j] = sign * c->r[j];
  }
  double bad = fclib_violation(s->dim, s->n, s->W, s->q, s->mu, u, r);
  free(u);
  free(r);
  return bad;
}
