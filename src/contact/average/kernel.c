/*
 * The table of kernels and their normalisation.
 */
#include "contact/average/average.h"

#include "base/base.h"

enum { GAUSS_COARSE = 4, GAUSS_FINE = 8 };

typedef struct gauss_point {
  double at, weight;
} gauss_point;

static const gauss_point gauss_coarse[GAUSS_COARSE] = {
    {0.069431844202973714, 0.17392742256872687},
    {0.33000947820757187, 0.32607257743127305},
    {0.66999052179242813, 0.32607257743127305},
    {0.93056815579702623, 0.17392742256872687}};

static const gauss_point gauss_fine[GAUSS_FINE] = {
    {0.019855071751231856, 0.050614268145188088},
    {0.10166676129318658, 0.11119051722668723},
    {0.2372337950418355, 0.15685332293894369},
    {0.40828267875217511, 0.181341891689181},
    {0.59171732124782495, 0.181341891689181},
    {0.7627662049581645, 0.15685332293894369},
    {0.89833323870681348, 0.11119051722668723},
    {0.9801449282487682, 0.050614268145188088}};

enum { PANELS = 64 }; /* of [0, 1] for the normalisation: exact to rounding */

static double bump(double s2) { return exp(1.0 / (s2 - 1.0)); }

static double cone(double s2) { return 1.0 - sqrt(s2); }

static double parabola(double s2) { return 1.0 - s2; }

static double wendland(double s2) {
  double s = sqrt(s2), a = 1.0 - s;
  return a * a * a * a * (1.0 + 4.0 * s);
}

static double constant(double s2) { return 1.0; }

#define KERNEL_PROFILE(name, function, help) function,
static double (*const profiles[])(double) = {KERNEL_LIST(KERNEL_PROFILE)};

/* Integral of k(s) over [-1, 1], or of k(|s|) over the unit disc. */
static double unit_mass(double (*profile)(double), int dim) {
  double sum = 0.0;
  for (int p = 0; p < PANELS; ++p)
    for (int g = 0; g < GAUSS_FINE; ++g) {
      double s = (p + gauss_fine[g].at) / PANELS;
      sum += gauss_fine[g].weight / PANELS * profile(s * s) *
             (dim == 1 ? 2.0 : 2.0 * acos(-1.0) * s);
    }
  return sum;
}

mollifier mollifier_make(kernel k, double radius, int dim) {
  double unit = dim == 1 ? radius : radius * radius;
  return (mollifier){.profile = profiles[k],
                     .radius = radius,
                     .scale = 1.0 / (unit * unit_mass(profiles[k], dim))};
}

double mollifier_value(const mollifier *m, double r2) {
  double s2 = r2 / (m->radius * m->radius);
  return s2 < 1.0 ? m->scale * m->profile(s2) : 0.0;
}

/*
 * Lines: Gauss rules between the foot of the point and the ends of the disc.
 * Rings: the same with the kernel integrated over the angle. Triangles: sums of
 * sectors around the foot of the point, exact where the disc cuts the face.
 */

static const double PIECE = 0.25;  /* of the radius, longest for a fine rule */
static const double SHORT = 0.125; /* up to this the coarse rule is enough */

/* Which rule serves an interval, cut in how many pieces. */
typedef struct rule {
  const gauss_point *point;
  int n, pieces;
} rule;

static rule rule_for(double length, double radius) {
  if (length <= SHORT * radius) return (rule){gauss_coarse, GAUSS_COARSE, 1};
  return (rule){gauss_fine, GAUSS_FINE, (int)ceil(length / (PIECE * radius))};
}

/* ---- distances --------------------------------------------------------- */

static double distance2(int dim, const double *x, const double *y) {
  double sum = 0.0;
  for (int c = 0; c < dim; ++c) sum += (x[c] - y[c]) * (x[c] - y[c]);
  return sum;
}

double face_segment_distance(int dim, const double *a, const double *b,
                             const double *x) {
  double along2 = distance2(dim, a, b), to = 0.0, s, y[3];
  for (int c = 0; c < dim; ++c) to += (b[c] - a[c]) * (x[c] - a[c]);
  s = along2 > 0.0 ? fmin(fmax(to / along2, 0.0), 1.0) : 0.0;
  for (int c = 0; c < dim; ++c) y[c] = a[c] + s * (b[c] - a[c]);
  return sqrt(distance2(dim, x, y));
}

/* Distance of the foot of x in the plane of a triangle; HUGE_VAL if it is
 * outside of the triangle. */
static double height(const double *corner, const double *x) {
  double n[3], a[3], b[3], side[3];
  triangle_normal(corner, n);
  for (int k = 0; k < 3; ++k) {
    vector_of(3, corner + 3 * k, corner + 3 * ((k + 1) % 3), a);
    vector_of(3, corner + 3 * k, x, b);
    cross(a, b, side);
    if (!(dot(3, side, n) > 0.0)) return HUGE_VAL;
  }
  return fabs(dot(3, b, n)) / sqrt(dot(3, n, n));
}

double face_distance(int dim, const double *corner, const double *x) {
  double least = dim == 3 ? height(corner, x) : HUGE_VAL;
  for (int k = 0; k < 2 * dim - 3; ++k)
    least =
        fmin(least, face_segment_distance(dim, corner + dim * k,
                                          corner + dim * ((k + 1) % dim), x));
  return least;
}

/* ---- lines ------------------------------------------------------------- */

/* The kernel at a point y of a line: over the line, or around the axis. */
typedef double density(const mollifier *m, const double *x, const double *y);

static double line_density(const mollifier *m, const double *x,
                           const double *y) {
  return mollifier_value(m, distance2(2, x, y));
}

/* Integral over the circle through y of w, seen from x: the squared distance
 * at the angle t is d2 + 4 r(x) r(y) sin(t/2)^2. */
static double ring_density(const mollifier *m, const double *x,
                           const double *y) {
  double d2 = distance2(2, x, y), across = 4.0 * x[0] * y[0], sum = 0.0;
  double rest = m->radius * m->radius - d2;
  if (rest <= 0.0 || y[0] <= 0.0) return 0.0;
  double end = rest < across ? 2.0 * asin(sqrt(rest / across)) : acos(-1.0);
  rule q = rule_for(0.5 * end * sqrt(fmax(0.25 * across, 0.0)), m->radius);
  for (int p = 0; p < q.pieces; ++p)
    for (int g = 0; g < q.n; ++g) {
      double s = sin(0.5 * end * (p + q.point[g].at) / q.pieces);
      sum += q.point[g].weight * mollifier_value(m, d2 + across * s * s);
    }
  return 2.0 * y[0] * end / q.pieces * sum;
}

typedef struct line {
  const mollifier *m;
  density *w;
  const double *corner, *x;
  double length;
} line;

/* The part of the line from t = first to last, m from corner 0. */
static void add_part(const line *l, double first, double last,
                     double weight[2]) {
  if (!(last > first)) return;
  rule q = rule_for(last - first, l->m->radius);
  double step = (last - first) / q.pieces;
  for (int p = 0; p < q.pieces; ++p)
    for (int g = 0; g < q.n; ++g) {
      double s = (first + step * (p + q.point[g].at)) / l->length, y[2];
      for (int c = 0; c < 2; ++c)
        y[c] = l->corner[c] + s * (l->corner[2 + c] - l->corner[c]);
      double w = step * q.point[g].weight * l->w(l->m, l->x, y);
      weight[0] += (1.0 - s) * w;
      weight[1] += s * w;
    }
}

static void integrate_line(line *l, double reach, double weight[2]) {
  const double *a = l->corner, *b = l->corner + 2;
  double along[2] = {b[0] - a[0], b[1] - a[1]};
  double to[2] = {l->x[0] - a[0], l->x[1] - a[1]};
  weight[0] = weight[1] = 0.0;
  l->length = sqrt(along[0] * along[0] + along[1] * along[1]);
  if (!(l->length > 0.0)) return;
  double foot = (to[0] * along[0] + to[1] * along[1]) / l->length;
  double off = (to[0] * along[1] - to[1] * along[0]) / l->length;
  if (!(fabs(off) < reach)) return;
  double half = sqrt((reach - off) * (reach + off));
  double first = fmax(0.0, foot - half), last = fmin(l->length, foot + half);
  add_part(l, first, fmin(foot, last), weight);
  add_part(l, fmax(foot, first), last, weight);
}

void face_line(const mollifier *m, double reach, const double *corner,
               const double *x, double weight[2]) {
  line l = {.m = m, .w = line_density, .corner = corner, .x = x};
  integrate_line(&l, reach, weight);
}

void face_ring(const mollifier *m, double reach, const double *corner,
               const double *x, double weight[2]) {
  line l = {.m = m, .w = ring_density, .corner = corner, .x = x};
  integrate_line(&l, reach, weight);
}

/* ---- triangles --------------------------------------------------------- */

/* A triangle in its plane, the foot of the point as origin. */
typedef struct flat {
  const mollifier *m;
  double p[3][2]; /* corners, m */
  double off2;    /* squared distance of the point from the plane, m2 */
  double rim2;    /* squared radius of the disc in the plane, m2 */
  double sum[3];  /* integrals of w, w y0, w y1: -, m, m */
} flat;

/* Radial means: *flux of w v dv, *moment of w v^2 dv over v in [0, 1], the
 * distance from the foot being v s. */
static void radial(const flat *f, double s, double *flux, double *moment) {
  rule q = rule_for(s, f->m->radius);
  *flux = *moment = 0.0;
  for (int p = 0; p < q.pieces; ++p)
    for (int g = 0; g < q.n; ++g) {
      double v = (p + q.point[g].at) / q.pieces;
      double w = v * q.point[g].weight / q.pieces *
                 mollifier_value(f->m, f->off2 + v * v * s * s);
      *flux += w;
      *moment += v * w;
    }
}

/* An edge of the triangle: distance h of its line from the foot (with the sign
 * of the orientation), unit vectors across and along. */
typedef struct edge {
  double h, across[2], along[2];
} edge;

/* Sectors over the edge from t = first to last inside of the disc. */
static void add_inner(flat *f, const edge *e, double first, double last) {
  if (!(last > first)) return;
  rule q = rule_for(last - first, f->m->radius);
  double step = (last - first) / q.pieces;
  for (int p = 0; p < q.pieces; ++p)
    for (int g = 0; g < q.n; ++g) {
      double t = first + step * (p + q.point[g].at), flux, moment;
      double weight = e->h * step * q.point[g].weight;
      radial(f, sqrt(e->h * e->h + t * t), &flux, &moment);
      f->sum[0] += weight * flux;
      for (int c = 0; c < 2; ++c)
        f->sum[1 + c] +=
            weight * moment * (e->h * e->across[c] + t * e->along[c]);
    }
}

/* Sectors that the disc ends before the edge is reached. */
static void add_outer(flat *f, const edge *e, double first, double last) {
  double flux, moment, rim = sqrt(f->rim2);
  if (!(last > first)) return;
  double s0 = sqrt(e->h * e->h + first * first);
  double s1 = sqrt(e->h * e->h + last * last);
  double angle = atan2(e->h * (last - first), e->h * e->h + first * last);
  double sine = last / s1 - first / s0, cosine = e->h * (1.0 / s0 - 1.0 / s1);
  radial(f, rim, &flux, &moment);
  f->sum[0] += angle * f->rim2 * flux;
  for (int c = 0; c < 2; ++c)
    f->sum[1 + c] +=
        f->rim2 * rim * moment * (sine * e->across[c] + cosine * e->along[c]);
}

static void add_edge(flat *f, const double *a, const double *b) {
  double d[2] = {b[0] - a[0], b[1] - a[1]};
  double length = sqrt(d[0] * d[0] + d[1] * d[1]);
  if (!(length > 0.0)) return;
  edge e = {.along = {d[0] / length, d[1] / length}};
  e.h = (a[0] * b[1] - a[1] * b[0]) / length;
  e.across[0] = e.along[1];
  e.across[1] = -e.along[0];
  if (e.h == 0.0) return;
  double first = a[0] * e.along[0] + a[1] * e.along[1], last = first + length;
  double cut2 = f->rim2 - e.h * e.h, cut = cut2 > 0.0 ? sqrt(cut2) : 0.0;
  double in0 = fmin(fmax(first, -cut), last), in1 = fmax(fmin(last, cut), in0);
  add_outer(f, &e, first, in0);
  add_inner(f, &e, in0, fmin(0.0, in1));
  add_inner(f, &e, fmax(0.0, in0), in1);
  add_outer(f, &e, in1, last);
}

/* Values at the foot and gradients of the P1 functions turn the integrals of w
 * and w y into weights; twice the area. */
static void to_weights(const flat *f, double twice, double weight[3]) {
  for (int k = 0; k < 3; ++k) {
    const double *a = f->p[(k + 1) % 3], *b = f->p[(k + 2) % 3];
    double at_foot = a[0] * b[1] - a[1] * b[0];
    weight[k] = (at_foot * f->sum[0] + (a[1] - b[1]) * f->sum[1] +
                 (b[0] - a[0]) * f->sum[2]) /
                twice;
    /* The rounding of cancelling sectors. */
    if (weight[k] < 0.0) weight[k] = 0.0;
  }
}

/* A product rule, for a small triangle inside of the disc and away from x. */
static void product_rule(const mollifier *m, const double *corner,
                         const double *x, double twice_area, double weight[3]) {
  for (int g = 0; g < GAUSS_COARSE; ++g)
    for (int h = 0; h < GAUSS_COARSE; ++h) {
      double u = gauss_coarse[g].at, y[3];
      double s[3] = {0.0, u, (1.0 - u) * gauss_coarse[h].at};
      s[0] = 1.0 - s[1] - s[2];
      for (int c = 0; c < 3; ++c)
        y[c] = s[0] * corner[c] + s[1] * corner[3 + c] + s[2] * corner[6 + c];
      double w = twice_area * gauss_coarse[g].weight * gauss_coarse[h].weight *
                 (1.0 - u) * mollifier_value(m, distance2(3, x, y));
      for (int k = 0; k < 3; ++k) weight[k] += s[k] * w;
    }
}

/* 1 if a product rule does: the face is small, inside, and not at the point. */
static int is_plain(const mollifier *m, const double *corner, const double *x) {
  double longest = 0.0, near = HUGE_VAL, far = 0.0;
  for (int k = 0; k < 3; ++k) {
    double d2 = distance2(3, corner + 3 * k, x);
    near = fmin(near, d2);
    far = fmax(far, d2);
    longest =
        fmax(longest, distance2(3, corner + 3 * k, corner + 3 * ((k + 1) % 3)));
  }
  double r2 = m->radius * m->radius;
  return far < r2 && longest < 0.16 * r2 && near > 0.25 * longest;
}

void face_triangle(const mollifier *m, const double *corner, const double *x,
                   double weight[3]) {
  flat f = {.m = m};
  double n[3], to[3], e0[3], e1[3], twice = triangle_normal(corner, n);
  CLEAR(weight, 3);
  if (!(twice > 0.0)) return;
  if (is_plain(m, corner, x)) {
    product_rule(m, corner, x, twice, weight);
    return;
  }
  for (int c = 0; c < 3; ++c) n[c] /= twice;
  vector_of(3, corner, corner + 3, e0);
  make_unit(3, e0);
  cross(n, e0, e1);
  vector_of(3, corner, x, to);
  double off = dot(3, to, n);
  f.off2 = off * off;
  f.rim2 = (m->radius - fabs(off)) * (m->radius + fabs(off));
  if (!(f.rim2 > 0.0)) return;
  for (int k = 0; k < 3; ++k) {
    double d[3];
    vector_of(3, x, corner + 3 * k, d);
    f.p[k][0] = dot(3, d, e0);
    f.p[k][1] = dot(3, d, e1);
  }
  for (int k = 0; k < 3; ++k) add_edge(&f, f.p[k], f.p[(k + 1) % 3]);
  to_weights(&f, twice, weight);
}
