/*
 * R(p) of nonlocal friction by plain quadrature over pieces of the faces:
 * with g_ij the integral of the kernel round node i against the function of
 * node j and l_i that of the function,
 *   l_i G_ij = (l_i g_ij + l_j g_ji)/2,  G_ii = W_i - sum of the others,
 * W_i = 1 where the disc lies on the contact, else the part of its mass there.
 */
#include "decks/judge.h"

#include "base/base.h"

enum {
  LINE_PIECES = 64,
  SIDE_PIECES = 16,
  RING_PIECES = 64,
  MASS_PIECES = 4096
};

static double profile(int kernel, double s) {
  double a = 1 - s;
  if (s >= 1) return 0;
  switch (kernel) {
    case 0:
      return exp(1 / (s * s - 1));
    case 1:
      return a;
    case 2:
      return 1 - s * s;
    case 3:
      return a * a * a * a * (1 + 4 * s);
    default:
      return 1;
  }
}

typedef struct averager {
  const random_deck *d;
  const deck_friction *f;
  int group, n;
  const int *node;
  double scale; /* makes the mass of the kernel 1                          */
  double *x;    /* [3*n_node] places, along the line if geodesic           */
  double *g, *l, *W;
  double low[3], high[3]; /* box of the contact                             */
} averager;

static double weight(const averager *a, double r) {
  return a->scale * profile(a->f->kernel, r / a->f->radius);
}

static void find_scale(averager *a) {
  double sum = 0, h = 1.0 / MASS_PIECES;
  int line = a->d->kind < AXISYMMETRIC_;
  for (int k = 0; k < MASS_PIECES; ++k) {
    double s = (k + 0.5) * h;
    sum += h * profile(a->f->kernel, s) * (line ? 2 : 2 * acos(-1.0) * s);
  }
  a->scale = 1 / (sum * pow(a->f->radius, line ? 1 : 2));
}

static int place_of(const averager *a, int node) {
  for (int i = 0; i < a->n; ++i)
    if (a->node[i] == node) return i;
  return -1;
}

/* Nodes laid out along their line: faces of a foot or wall run on from one to
 * the next in the order in which they were made. */
static void lay_out(averager *a) {
  const solid *s = &a->d->mesh;
  double at = 0;
  for (int f = 0; f < s->n_face; ++f) {
    const int *v = s->face + 2 * f;
    if (s->face_group[f] != a->group) continue;
    at += hypot(s->x[2 * v[1]] - s->x[2 * v[0]],
                s->x[2 * v[1] + 1] - s->x[2 * v[0] + 1]);
    a->x[3 * v[1]] = at;
    a->x[3 * v[1] + 1] = 0;
    if (a->x[3 * v[0]] == -1e30) a->x[3 * v[0]] = a->x[3 * v[0] + 1] = 0;
  }
}

static void find_places(averager *a) {
  const solid *s = &a->d->mesh;
  for (int c = 0; c < 3; ++c) a->low[c] = HUGE_VAL, a->high[c] = -HUGE_VAL;
  for (int i = 0; i < s->n_node; ++i) {
    for (int c = 0; c < 3; ++c)
      a->x[3 * i + c] = c < s->dim ? s->x[s->dim * i + c] : 0;
    if (!solid_in(s, a->group, i)) continue;
    for (int c = 0; c < 3; ++c) {
      a->low[c] = fmin(a->low[c], a->x[3 * i + c]);
      a->high[c] = fmax(a->high[c], a->x[3 * i + c]);
    }
  }
  for (int i = 0; i < s->n_node && a->f->geodesic; ++i) a->x[3 * i] = -1e30;
  if (a->f->geodesic) lay_out(a);
}

/* What a node, or one of its images, sees: a face after the other. */
typedef struct view {
  averager *a;
  int row;
  const int *face;
  double from[3];
  double seen, lost; /* mass on nodes that carry pressure, on others        */
} view;

/* Add the piece of a face: measure dA at y with the functions at[]. */
static void add_piece(view *v, const double *at, const double *y, double dA) {
  averager *a = v->a;
  double r = 0;
  for (int c = 0; c < 3; ++c) r += (y[c] - v->from[c]) * (y[c] - v->from[c]);
  double w = dA * weight(a, sqrt(r));
  for (int k = 0; k < a->d->mesh.dim && w > 0; ++k) {
    int j = place_of(a, v->face[k]);
    if (j >= 0) a->g[v->row * a->n + j] += w * at[k];
    *(j >= 0 ? &v->seen : &v->lost) += w * at[k];
  }
}

/* Half the angle of the circle of radius r that can lie within reach. */
static double half_angle(const view *v, double r) {
  double across = 2 * sqrt(r * v->from[0]);
  if (across <= v->a->f->radius) return acos(-1.0);
  return 2 * asin(v->a->f->radius / across);
}

static void add_circle(view *v, const double *at, const double *y, double ds) {
  double half = half_angle(v, y[0]), r = y[0];
  for (int m = 0; m < RING_PIECES; ++m) {
    double phi = half * (m + 0.5) / RING_PIECES;
    double z[3] = {r * cos(phi), y[1], r * sin(phi)};
    add_piece(v, at, z, ds * 2 * r * half / RING_PIECES);
  }
}

static void add_line(view *v) {
  const double *p = v->a->x + 3 * v->face[0], *q = v->a->x + 3 * v->face[1];
  double ds = hypot(q[0] - p[0], q[1] - p[1]) / LINE_PIECES;
  for (int k = 0; k < LINE_PIECES; ++k) {
    double s = (k + 0.5) / LINE_PIECES, at[2] = {1 - s, s};
    double y[3] = {at[0] * p[0] + s * q[0], at[0] * p[1] + s * q[1], 0};
    if (v->a->d->kind == AXISYMMETRIC_)
      add_circle(v, at, y, ds);
    else
      add_piece(v, at, y, ds);
  }
}

/* By the centroids of small triangles, upright and turned. */
static void add_triangle(view *v, int id) {
  double normal[3], size = 0;
  int n = SIDE_PIECES;
  face_vector(&v->a->d->mesh, id, normal);
  for (int c = 0; c < 3; ++c) size += normal[c] * normal[c];
  size = sqrt(size) / (n * n);
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < 2 * (n - i) - 1; ++k) {
      double third = (k % 2 ? 2 : 1) / 3.0, y[3] = {0, 0, 0};
      double b = (k / 2 + third) / n, c = (i + third) / n;
      double at[3] = {1 - b - c, b, c};
      for (int m = 0; m < 3; ++m)
        for (int e = 0; e < 3; ++e) y[e] += at[m] * v->a->x[3 * v->face[m] + e];
      add_piece(v, at, y, size);
    }
}

static void look(view *v) {
  const solid *s = &v->a->d->mesh;
  for (int f = 0; f < s->n_face; ++f) {
    v->face = s->face + s->dim * f;
    if (s->face_group[f] != v->a->group) continue;
    if (s->dim == 3)
      add_triangle(v, f);
    else
      add_line(v);
  }
}

/* Image of node i by a mask of mirrors; 0: there is no such image. */
static int image_of(const averager *a, int i, int mask, double *from) {
  const double *x = a->x + 3 * a->node[i];
  int there = 1;
  for (int c = 0; c < 3; ++c) {
    int kind = a->f->mirror[c], turned = mask >> c & 1;
    double plane = kind == 1 ? a->low[c] : a->high[c];
    from[c] = turned ? 2 * plane - x[c] : x[c];
    there &= !turned || kind != 0;
  }
  return there;
}

static view look_from_all(averager *a, int row) {
  view v = {.a = a, .row = row};
  for (int mask = 0; mask < 8; ++mask)
    if (image_of(a, row, mask, v.from)) look(&v);
  return v;
}

/* ---- the rim ------------------------------------------------------------ */

static double to_segment(const double *p, const double *q, const double *x) {
  double l2 = 0, to = 0, r = 0;
  for (int c = 0; c < 3; ++c) {
    l2 += (q[c] - p[c]) * (q[c] - p[c]);
    to += (q[c] - p[c]) * (x[c] - p[c]);
  }
  double s = l2 > 0 ? fmin(fmax(to / l2, 0), 1) : 0;
  for (int c = 0; c < 3; ++c) {
    double e = x[c] - p[c] - s * (q[c] - p[c]);
    r += e * e;
  }
  return sqrt(r);
}

/* 1: both ends lie on a mirror, or on the axis. */
static int on_mirror(const averager *a, int p, int q) {
  for (int c = 0; c < 3; ++c) {
    double plane = a->f->mirror[c] == 1 ? a->low[c] : a->high[c];
    if (a->f->mirror[c] && fabs(a->x[3 * p + c] - plane) < 1e-9 &&
        fabs(a->x[3 * q + c] - plane) < 1e-9)
      return 1;
  }
  return a->d->kind == AXISYMMETRIC_ && a->x[3 * p] < 1e-9;
}

/* Faces of the group that have both nodes. */
static int count_faces(const averager *a, int p, int q) {
  const solid *s = &a->d->mesh;
  int n = 0;
  for (int f = 0; f < s->n_face; ++f) {
    int found = 0;
    for (int k = 0; k < s->dim && s->face_group[f] == a->group; ++k)
      found |=
          (s->face[s->dim * f + k] == p) | (s->face[s->dim * f + k] == q) * 2;
    n += found == 3;
  }
  return n;
}

/* Distance from node i to the edge of the contact. */
static double to_rim(const averager *a, int i) {
  const solid *s = &a->d->mesh;
  const double *x = a->x + 3 * a->node[i];
  double least = HUGE_VAL;
  for (int f = 0; f < s->n_face; ++f)
    for (int k = 0; k < s->dim && s->face_group[f] == a->group; ++k) {
      int p = s->face[s->dim * f + k];
      int q = s->dim == 2 ? p : s->face[3 * f + (k + 1) % 3];
      if (count_faces(a, p, q) == 1 && !on_mirror(a, p, q))
        least = fmin(least, to_segment(a->x + 3 * p, a->x + 3 * q, x));
    }
  return least;
}

/* ---- the matrix --------------------------------------------------------- */

/* 1: no other node lies within the radius. */
static int is_alone(const averager *a, int i) {
  double from[3];
  for (int mask = 0; mask < 8; ++mask)
    for (int j = 0; j < a->n && image_of(a, i, mask, from); ++j) {
      double r = to_segment(from, from, a->x + 3 * a->node[j]);
      if (j != i && r < a->f->radius * (1 - 1e-9)) return 0;
    }
  return 1;
}

static void find_rows(averager *a, unsigned char *open) {
  int n = a->n;
  for (int i = 0; i < n; ++i) {
    double rim = to_rim(a, i), radius = a->f->radius;
    view v = look_from_all(a, i);
    int whole = v.lost == 0 && rim > radius * (1 - 1e-9);
    open[i] = fabs(rim - radius) < 1e-6 * radius;
    a->W[i] = whole ? 1 : fmin(1, v.seen);
    for (int j = 0; j < n; ++j) a->g[i * n + j] *= a->W[i] / v.seen;
  }
}

static double pair(const averager *a, const double *part, int i, int j) {
  double one = a->l[i] * a->g[i * a->n + j],
         other = a->l[j] * a->g[j * a->n + i];
  return 0.5 * (one + other) * fmin(part[i], part[j]);
}

/* R(p) of node i; *left: what its own pressure gets, times l_i. */
static double row_mean(const averager *a, const double *part,
                       const unsigned char *alone, int i, const double *p,
                       double *left) {
  double sum = 0;
  *left = a->l[i] * (alone[i] ? 1 : a->W[i]);
  for (int j = 0; j < a->n; ++j) {
    if (j == i || alone[i] || alone[j]) continue;
    double v = pair(a, part, i, j);
    *left -= v;
    sum += v * p[j];
  }
  sum += fmax(*left, 0) * p[i];
  double by = a->l[i];
  if (a->f->normalized && !alone[i]) by *= a->W[i];
  return sum / by;
}

static void *need(size_t n, size_t size) {
  void *p = calloc(n + 1, size);
  if (p == NULL) abort();
  return p;
}

static void find_shares(averager *a) {
  const solid *s = &a->d->mesh;
  for (int f = 0; f < s->n_face; ++f) {
    double w[3];
    if (s->face_group[f] != a->group) continue;
    face_shares(a->d, f, w);
    for (int k = 0; k < s->dim; ++k) {
      int i = place_of(a, s->face[s->dim * f + k]);
      if (i >= 0) a->l[i] += w[k];
    }
  }
}

/* Pairs are less where they would leave a node less than nothing. */
static void find_means(averager *a, const double *p, double *mean) {
  size_t n = (size_t)a->n;
  unsigned char *alone = need(n, 1);
  double left, *full = need(n, sizeof *full), *part = need(n, sizeof *part);
  for (int i = 0; i < a->n; ++i) full[i] = 1;
  for (int i = 0; i < a->n; ++i) alone[i] = (unsigned char)is_alone(a, i);
  for (int i = 0; i < a->n; ++i) {
    double all = a->l[i] * (alone[i] ? 1 : a->W[i]);
    row_mean(a, full, alone, i, p, &left);
    part[i] = left < 0 ? all / (all - left) : 1;
  }
  for (int i = 0; i < a->n; ++i)
    mean[i] = row_mean(a, part, alone, i, p, &left);
  free(full);
  free(part);
  free(alone);
}

void judge_average(const averaged_contact *in, double *mean,
                   unsigned char *open) {
  size_t n = (size_t)in->n;
  averager a = {
      .d = in->d, .f = in->f, .group = in->group, .n = in->n, .node = in->node};
  a.x = need(3 * (size_t)in->d->mesh.n_node, sizeof *a.x);
  a.g = need(n * n, sizeof *a.g);
  a.l = need(n, sizeof *a.l);
  a.W = need(n, sizeof *a.W);
  find_scale(&a);
  find_places(&a);
  find_shares(&a);
  find_rows(&a, open);
  find_means(&a, in->p, mean);
  free(a.x);
  free(a.g);
  free(a.l);
  free(a.W);
}
