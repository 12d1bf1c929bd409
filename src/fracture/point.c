/*
 * Coordinates that follow the front, quadrature on lips that end at it, and the
 * points of a front: frames, curvature, and how far the crack is straight,
 * alone and in one material.
 */
#include "fracture/parts.h"

#include "base/base.h"

void place_of(const mesh *m, int node, double x[3]) {
  x[2] = 0;
  COPY(x, m->x + (size_t)m->dim * node, m->dim);
}

/* The front is a circle of curvature k through the point, its centre behind it
 * for k > 0: with (y1, y3) in its plane, k times the vector from the centre is
 * (a, b) = (1 + k y1, k y3), and rho - 1/k is free of 1/k. */
void locate(const fracture_point *p, const double x[3], local *at) {
  const double *e1 = p->frame, *e3 = p->frame + 6, k = p->curvature;
  double y[3] = {0, 0, 0};
  for (int i = 0; i < 3; ++i)
    for (int c = 0; c < 3; ++c)
      y[i] += p->frame[3 * i + c] * (x[c] - p->origin[c]);
  const double a = 1 + k * y[0], b = k * y[2], h = hypot(a, b);
  at->x[0] = (2 * y[0] + k * (y[0] * y[0] + y[2] * y[2])) / (h + 1);
  at->x[1] = y[1];
  at->s = fabs(b) > 0 ? y[2] * (atan2(b, a) / b) : y[2];
  at->turn = k / h;
  memcpy(at->axis, p->frame, sizeof at->axis);
  for (int c = 0; c < 3; ++c) {
    at->axis[c] = (a * e1[c] + b * e3[c]) / h;
    at->axis[6 + c] = (a * e3[c] - b * e1[c]) / h;
  }
}

/* Gauss, on [0, 1]. */
enum { GAUSS = 4 };
static const double gauss_at[GAUSS] = {0.06943184420297371, 0.33000947820757187,
                                       0.6699905217924281, 0.9305681557970263};
static const double gauss_part[GAUSS] = {
    0.17392742256872692, 0.32607257743127307, 0.32607257743127307,
    0.17392742256872692};

/* Corners by their distance from the front. */
static void order_corners(int n, const double *behind, int *at) {
  for (int i = 0; i <= n; ++i) {
    int k = i;
    for (; k > 0 && behind[at[k - 1]] > behind[i]; --k) at[k] = at[k - 1];
    at[k] = i;
  }
}

/* From the nearest corner, xi = sigma^2 towards the opposite edge and eta =
 * tau^2 along it, away from its nearer end: the distance is xi (or xi eta)
 * where one corner (two) are at the front. */
int lip_rule(int n, const double *behind, rule_point *to) {
  int at[3], count = 0;
  order_corners(n, behind, at);
  for (int i = 0; i < GAUSS; ++i)
    for (int k = 0; k < (n == 2 ? GAUSS : 1); ++k) {
      const double sigma = gauss_at[i], tau = n == 2 ? gauss_at[k] : 0;
      const double xi = sigma * sigma, eta = tau * tau;
      rule_point *p = &to[count++];
      memset(p->phi, 0, sizeof p->phi);
      p->part = gauss_part[i] * 2 * sigma;
      if (n == 2) p->part *= gauss_part[k] * 2 * tau * 2 * xi;
      p->phi[at[0]] = 1 - xi;
      p->phi[at[1]] = xi * (1 - eta);
      if (n == 2) p->phi[at[2]] = xi * eta;
    }
  return count;
}

double fracture_corner(int dim) {
  return dim == 2 ? 2.0 / 3.0 : 0.58541019662496845446;
}

/* ---- points: frames, curvature, how far the crack is straight ---- */

/* A node of a lip that is behind the front is where the crack is straight if
 * its height over the distance and the turn of its normal are below this, -. */
static const double straight = 0.02;
/* A domain spans at least so many elements, -. */
static const double fewest = 2.0;

/* 1: the same elastic constants. */
static int same_material(const fracture_material *a,
                         const fracture_material *b) {
  return a->E == b->E && a->nu == b->nu && a->plane_stress == b->plane_stress;
}

static double distance(const mesh *m, int a, int b) {
  double x[3], y[3];
  place_of(m, a, x);
  place_of(m, b, y);
  return distance_of(3, x, y);
}

typedef struct obstacles {
  int n;
  int *node;      /* [n] on the boundary, lips too, or between materials */
  double *normal; /* [3*n] mean outward normal of the boundary; 0: inside */
  char *mixed;    /* [n_node] 1: elements of different materials meet there */
} obstacles;

static void release(obstacles *o) { RELEASE(o->node, o->normal, o->mixed); }

/* int grad phi dV = int phi n dS: zero inside, and at the front, where both
 * lips cancel. sum[4*n_node]: it and, as a measure of rounding, the sum of the
 * lengths. */
static void add_normals(const mesh *m, double *sum) {
  for (int e = 0; e < m->n_elem; ++e) {
    const int *v = m->elem + (size_t)(m->dim + 1) * e;
    double g[12];
    const double w = mesh_elem_gradients(m, e, g);
    for (int a = 0; a <= m->dim; ++a) {
      double *to = sum + 4 * (size_t)v[a], square = 0;
      for (int c = 0; c < m->dim; ++c) {
        to[c] += w * g[m->dim * a + c];
        square += w * g[m->dim * a + c] * w * g[m->dim * a + c];
      }
      to[3] += sqrt(square);
    }
  }
}

static status find_mixed(const fracture_body *b, obstacles *o) {
  const mesh *m = b->mesh;
  OWNED int *of = NULL;
  PASS_NEW_ALL(OF(of, m->n_node), OF(o->mixed, m->n_node));
  for (int i = 0; i < m->n_node; ++i) of[i] = -1;
  for (int e = 0; e < m->n_elem; ++e)
    for (int a = 0; a <= m->dim; ++a) {
      int node = m->elem[(size_t)(m->dim + 1) * e + a];
      int here = b->section_id[e];
      if (of[node] < 0) of[node] = here;
      if (!same_material(&b->material[of[node]], &b->material[here]))
        o->mixed[node] = 1;
    }
  return OK;
}

static status find_obstacles(const fracture_body *b, obstacles *o) {
  static const double rounding = 1e-6;
  const mesh *m = b->mesh;
  int n = 0;
  OWNED_NEW(double, sum, 4 * (size_t)m->n_node);
  add_normals(m, sum);
  PASS(find_mixed(b, o));
  for (int i = 0; i < m->n_node; ++i) {
    double *at = sum + 4 * (size_t)i, length = sqrt(dot(3, at, at));
    const double part = length > rounding * at[3] ? 1 / length : 0;
    for (int k = 0; k < 3; ++k) at[k] *= part;
    o->n += o->mixed[i] || part > 0;
  }
  PASS_NEW_ALL(OF(o->node, o->n), OF(o->normal, 3 * o->n));
  for (int i = 0; i < m->n_node; ++i) {
    const double *at = sum + 4 * (size_t)i;
    if (!o->mixed[i] && dot(3, at, at) == 0) continue;
    COPY(o->normal + 3 * n, at, 3);
    o->node[n++] = i;
  }
  return OK;
}

/* On the lips behind the point, in the plane of the crack there. */
static int on_crack(const fracture_point *p, const double *x,
                    const double *normal, double away) {
  local at;
  double side[3];
  locate(p, x, &at);
  cross(normal, p->frame + 3, side);
  return at.x[0] < away / 2 && fabs(at.x[1]) <= straight * away &&
         sqrt(dot(3, side, side)) <= straight;
}

/* A point between two materials has no others. */
static int ends_domain(const obstacles *o, int i, const fracture_point *p,
                       const double *x, double away) {
  const double *normal = o->normal + 3 * i;
  if (o->mixed[o->node[i]] && p->section >= 0) return 1;
  return dot(3, normal, normal) > 0 && !on_crack(p, x, normal, away);
}

/* Distance of the nearest obstacle, at most "radius". */
static double free_radius(const mesh *m, const obstacles *o,
                          const fracture_point *p, double radius) {
  for (int i = 0; i < o->n; ++i) {
    const double away = distance(m, o->node[i], p->node);
    double x[3];
    if (away >= radius) continue;
    place_of(m, o->node[i], x);
    if (ends_domain(o, i, p, x, away)) radius = away;
  }
  return radius;
}

/* Half the distance of other tips, or of parts of the front that run elsewhere,
 * at most "radius". */
static double half_way(const fracture *f, const fracture_point *p,
                       double radius) {
  const mesh *m = f->body.mesh;
  for (EACH(const fracture_point, other, f->point, f->n)) {
    if (other->crack != p->crack || other->node == p->node) continue;
    if (m->dim == 3 && dot(3, other->frame + 6, p->frame + 6) > 0.5) continue;
    radius = fmin(radius, distance(m, other->node, p->node) / 2);
  }
  return radius;
}

/* Mean length of the edges at the node; its section, -1 if they differ. */
static void look_round(const fracture *f, fracture_point *p) {
  const fracture_body *b = &f->body;
  const mesh *m = b->mesh;
  const int first = f->elem[f->start[p->node]];
  double sum = 0;
  p->section = b->section_id[first];
  for (size_t k = f->start[p->node]; k < f->start[p->node + 1]; ++k) {
    const int e = f->elem[k];
    const int *v = m->elem + (size_t)(m->dim + 1) * e;
    for (int a = 0; a <= m->dim; ++a) sum += distance(m, v[a], p->node);
    if (!same_material(&b->material[b->section_id[e]],
                       &b->material[b->section_id[first]]))
      p->section = -1;
  }
  p->size = sum / (double)(f->start[p->node + 1] - f->start[p->node]) / m->dim;
}

/* That of the minus lip points to the plus side. */
static void add_normal(const mesh *m, const mesh_crack *c, int face,
                       double *sum) {
  double normal[3] = {0.0};
  const double area = mesh_face_normal(m, c->minus[face], normal);
  for (int k = 0; k < 3; ++k) sum[k] += area * normal[k];
}

/* From the other node of the last face to the tip. */
static void set_frame_2d(const mesh *m, const mesh_crack *c, int i,
                         fracture_point *p) {
  double *e1 = p->frame, *e2 = e1 + 3, *e3 = e1 + 6, x[3];
  const int *v = m->face + 2 * (size_t)c->plus[c->front_face[i]];
  place_of(m, v[0] == p->node ? v[1] : v[0], x);
  for (int k = 0; k < 3; ++k) e1[k] = p->origin[k] - x[k];
  make_unit(3, e1);
  add_normal(m, c, c->front_face[i], e2);
  make_unit(3, e2);
  cross(e1, e2, e3);
}

/* Positions in front_node of the neighbours "step" away along the chain; -1:
 * beyond its end. */
static int along(const mesh_crack *c, int chain, int i, int step) {
  const int from = c->front_start[chain], last = c->front_start[chain + 1] - 1;
  const int n = last - from, to = i + step;
  if (to >= from && to <= last) return to;
  if (c->front_node[from] != c->front_node[last] || n < 1) return -1;
  return from + ((to - from) % n + n) % n;
}

/* y1 = c y3 - k/2 y3^2 through two neighbours on both sides, by least squares:
 * turns the frame by c and gives the curvature k. */
static void fit_circle(const mesh *m, const mesh_crack *crack, int chain, int i,
                       fracture_point *p) {
  double s2 = 0, s3 = 0, s4 = 0, r1 = 0, r2 = 0;
  for (int step = -2; step <= 2; ++step) {
    const int j = along(crack, chain, i, step);
    double x[3];
    if (j < 0 || step == 0) continue;
    place_of(m, crack->front_node[j], x);
    for (int k = 0; k < 3; ++k) x[k] -= p->origin[k];
    const double y1 = dot(3, x, p->frame), y3 = dot(3, x, p->frame + 6);
    s2 += y3 * y3;
    s3 += y3 * y3 * y3;
    s4 += y3 * y3 * y3 * y3;
    r1 += y3 * y1;
    r2 += y3 * y3 * y1;
  }
  const double determinant = s2 * s4 - s3 * s3;
  if (!(determinant > 1e-6 * s2 * s4)) return;
  const double c = (r1 * s4 - r2 * s3) / determinant;
  p->curvature = -2 * (r2 * s2 - r1 * s3) / determinant;
  for (int k = 0; k < 3; ++k) p->frame[6 + k] += c * p->frame[k];
  make_unit(3, p->frame + 6);
  cross(p->frame + 3, p->frame + 6, p->frame);
}

static void set_frame_3d(const mesh *m, const mesh_crack *c, int chain, int i,
                         fracture_point *p) {
  double *e1 = p->frame, *e2 = e1 + 3, *e3 = e1 + 6, x[3];
  const int before = along(c, chain, i, -1), after = along(c, chain, i, 1);
  place_of(m, c->front_node[before < 0 ? i : before], x);
  place_of(m, c->front_node[after < 0 ? i : after], e3);
  for (int k = 0; k < 3; ++k) e3[k] -= x[k];
  make_unit(3, e3);
  if (before >= 0) add_normal(m, c, c->front_face[before], e2);
  if (after >= 0) add_normal(m, c, c->front_face[after - 1], e2);
  const double part = dot(3, e2, e3);
  for (int k = 0; k < 3; ++k) e2[k] -= part * e3[k];
  make_unit(3, e2);
  cross(e2, e3, e1);
  fit_circle(m, c, chain, i, p);
}

/* Node i of a front. */
static void set_point(const fracture *f, int crack, int chain, int i,
                      fracture_point *p) {
  const mesh *m = f->body.mesh;
  const mesh_crack *c = &f->body.crack[crack];
  p->crack = crack;
  p->node = c->front_node[i];
  place_of(m, p->node, p->origin);
  look_round(f, p);
  if (m->dim == 2)
    set_frame_2d(m, c, i, p);
  else
    set_frame_3d(m, c, chain, i, p);
}

status points_find(fracture *f) {
  const mesh *m = f->body.mesh;
  fracture_point *p = f->point;
  ENDS_BY(release) obstacles o = {0};
  PASS(find_obstacles(&f->body, &o));
  for (int k = 0; k < f->body.n_crack; ++k) {
    const mesh_crack *c = &f->body.crack[k];
    for (int chain = 0; chain < c->n_front; ++chain)
      for (int i = c->front_start[chain]; i < c->front_start[chain + 1]; ++i)
        set_point(f, k, chain, i, p++);
  }
  for (p = f->point; p < f->point + f->n; ++p) {
    double most = p->curvature != 0 ? 0.5 / fabs(p->curvature) : m->size;
    p->radius = half_way(f, p, fmin(most, m->size));
    p->radius = free_radius(m, &o, p, p->radius);
    if (p->radius < fewest * p->size) p->radius = 0;
  }
  return OK;
}
