/*
 * The middle of an edge of a surface that is known at its nodes: on the cubic
 * through both ends with the tangents there, which are those of circles through
 * neighbours and of spheres (Max, J. Graphics Tools 4 (1999)). At the border of
 * the surface, and where it has an edge, that of the curve of this edge; at the
 * end of a curve the tangent is the mirror image of that at the other end.
 */
#include "mesh/refine/parts.h"

#include "base/base.h"

static const double SMOOTH = 0.5; /* -, sine of the largest turn */
static const double FLAT = 1e-6;  /* -, the same of what is flat */

enum { ON_CURVE = 1, IS_SHARP = 2 };
enum { CURVE_FLAT = 1, SURFACE_FLAT = 2 };

struct round_surface {
  const double *x;
  surface_faces f;
  key_table edges;       /* of the faces */
  int *face;             /* [2*edges] faces of an edge, -1: none */
  unsigned char *kind;   /* [edges] of the edge */
  int *next;             /* [2*n_all] neighbours along curves, -1 */
  unsigned char *number; /* [n_all] of curves' edges, up to 3 */
  unsigned char *flat;   /* [n_all] */
  unsigned char *sharp;  /* [n_all] 1: on an edge of the surface */
  double *tangent;       /* [3*n_all] of the curve; 0: none */
  double *normal;        /* [3*n_all] of the surface; 0: none */
  double *face_normal;   /* [3*f.n] times twice the area */
};

/* ---- vectors ------------------------------------------------------------- */

/* Sine of the angle between two directions, 2 beyond a right angle. */
static double turn(const double *a, const double *b) {
  double c[3];
  cross(a, b, c);
  if (!(dot(3, a, b) > 0.0)) return 2.0;
  return sqrt(dot(3, c, c) / (dot(3, a, a) * dot(3, b, b)));
}

static void between(const round_surface *s, int a, int b, double *e) {
  for (int k = 0; k < 3; ++k) e[k] = s->x[3 * b + k] - s->x[3 * a + k];
}

/* ---- edges --------------------------------------------------------------- */

static status add_edge(round_surface *s, int face, int a, int b) {
  int id;
  PASS(table_add(&s->edges, key_of(a, b), &id));
  s->face[2 * id + (s->face[2 * id] >= 0)] = face;
  return OK;
}

static void add_curve(round_surface *s, int a, int b, int is_sharp) {
  const int end[2] = {a, b};
  for (int k = 0; k < 2; ++k) {
    const int i = end[k];
    if (s->number[i] < 2) s->next[2 * i + s->number[i]] = end[1 - k];
    if (s->number[i] < 3) ++s->number[i];
    s->sharp[i] |= (unsigned char)is_sharp;
  }
}

/* Which edges are on curves: of a line, of one face, or sharp. */
static void find_curves(round_surface *s) {
  const int n = s->f.n_node;
  for (int i = 0; i < s->f.n; ++i)
    for (int a = 0; a < n; ++a) {
      const int p = s->f.node[n * i + a], q = s->f.node[n * i + (a + 1) % n];
      const int id = table_find(&s->edges, key_of(p, q));
      const int *f = s->face + 2 * id;
      int is_sharp = 0;
      if (f[0] != i || (n == 2 && a > 0)) continue;
      if (n == 3 && f[1] >= 0) {
        double other[3];
        memcpy(other, s->face_normal + 3 * f[1], sizeof other);
        if (dot(3, other, s->face_normal + 3 * f[0]) < 0.0)
          for (int k = 0; k < 3; ++k) other[k] = -other[k];
        is_sharp = turn(other, s->face_normal + 3 * f[0]) > SMOOTH;
        if (!is_sharp) continue;
      }
      s->kind[id] = ON_CURVE | (is_sharp ? IS_SHARP : 0);
      add_curve(s, p, q, is_sharp);
    }
}

/* ---- tangents and normals ------------------------------------------------ */

static void set_tangents(round_surface *s, int n_all) {
  for (int i = 0; i < n_all; ++i) {
    double e[2][3], *t = s->tangent + 3 * i;
    if (s->number[i] != 2) continue;
    between(s, s->next[2 * i], i, e[0]);
    between(s, i, s->next[2 * i + 1], e[1]);
    const double sine = turn(e[0], e[1]);
    if (sine > SMOOTH) continue;
    if (sine < FLAT) s->flat[i] |= CURVE_FLAT;
    for (int k = 0; k < 2; ++k)
      add_scaled(3, 1.0 / dot(3, e[k], e[k]), e[k], t);
    make_unit(3, t);
  }
  /* Where a curve goes over into a line it has no circle through both. */
  for (int i = 0; i < n_all; ++i)
    if (s->number[i] == 2 && !(s->flat[i] & CURVE_FLAT) &&
        (s->flat[s->next[2 * i]] | s->flat[s->next[2 * i + 1]]) & CURVE_FLAT)
      CLEAR(s->tangent + 3 * i, 3);
}

/* c less twice its part across: t at the other end of the chord c, both along
 * it. */
static void mirror(const double *c, double *t) {
  const double along = dot(3, t, c);
  for (int k = 0; k < 3; ++k) t[k] = 2.0 * along * c[k] - t[k];
}

/* Unit tangent at node a of the curve towards b; 0: none. */
static int curve_tangent(const round_surface *s, int a, int b, double *t) {
  double c[3];
  between(s, a, b, c);
  make_unit(3, c);
  const int other =
      dot(3, s->tangent + 3 * a, s->tangent + 3 * a) > 0.0 ? a : b;
  COPY(t, s->tangent + 3 * other, 3);
  if (!(dot(3, t, t) > 0.0)) return 0;
  if (dot(3, t, c) < 0.0)
    for (int k = 0; k < 3; ++k) t[k] = -t[k];
  if (other == b) mirror(c, t);
  return 1;
}

/* The sum of the normals of the faces round each node, by the lengths of their
 * sides there; flat where all are one. */
static void set_normals(round_surface *s, unsigned char *bent) {
  for (int i = 0; i < s->f.n; ++i)
    for (int a = 0; a < 3; ++a) {
      const int *v = s->f.node + 3 * i;
      const int at = v[a];
      double e[2][3], n[3], *sum = s->normal + 3 * at;
      between(s, at, v[(a + 1) % 3], e[0]);
      between(s, at, v[(a + 2) % 3], e[1]);
      cross(e[0], e[1], n);
      const double sign = dot(3, n, sum) < 0.0 ? -1.0 : 1.0;
      if (dot(3, sum, sum) > 0.0) {
        for (int k = 0; k < 3; ++k) n[k] *= sign;
        if (turn(n, sum) > FLAT) bent[at] = 1;
      }
      add_scaled(3, 1.0 / (dot(3, e[0], e[0]) * dot(3, e[1], e[1])), n, sum);
    }
}

/* At the border: across the curves that meet there; none on a sharp edge. */
static void set_border_normal(round_surface *s, int i) {
  double *n = s->normal + 3 * i, t[2][3], c[3] = {0.0};
  int known = 0;
  if (s->sharp[i] || s->number[i] > 2) {
    n[0] = n[1] = n[2] = 0.0;
    return;
  }
  for (int k = 0; k < s->number[i]; ++k)
    known += curve_tangent(s, i, s->next[2 * i + k], t[known]);
  if (known == 2) cross(t[0], t[1], c);
  if (dot(3, c, c) > SMOOTH * SMOOTH)
    memcpy(n, c, sizeof c);
  else if (known > 0)
    add_scaled(3, -dot(3, n, t[0]), t[0], n);
  make_unit(3, n);
}

/* Unit tangent at node a of the surface towards b; 0: none. */
static int surface_tangent(const round_surface *s, int a, int b, double *t) {
  const double *n = s->normal + 3 * a;
  if (!(dot(3, n, n) > 0.0)) return 0;
  between(s, a, b, t);
  add_scaled(3, -dot(3, t, n), n, t);
  return make_unit(3, t) > 0.0;
}

/* Of a border node the mean of the mirror images of normals within. */
static void improve_border(round_surface *s, const double *within) {
  const int *v = s->f.node;
  for (int i = 0; i < s->f.n; ++i, v += 3)
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) {
        const double *n = within + 3 * v[b];
        double c[3], m[3];
        if (s->number[v[a]] == 0 || !(dot(3, n, n) > 0.0)) continue;
        between(s, v[a], v[b], c);
        make_unit(3, c);
        memcpy(m, n, sizeof m);
        add_scaled(3, -2.0 * dot(3, n, c), c, m);
        double *sum = s->normal + 3 * v[a];
        add_scaled(3, dot(3, sum, m) < 0.0 ? -1.0 : 1.0, m, sum);
      }
}

static status set_surface(round_surface *s, int n_all) {
  if (s->f.n_node == 2) return OK;
  OWNED_NEW(unsigned char, bent, n_all);
  OWNED_NEW(double, within, 3 * n_all);
  set_normals(s, bent);
  for (int i = 0; i < n_all; ++i) {
    make_unit(3, s->normal + 3 * i);
    if (!bent[i]) s->flat[i] |= SURFACE_FLAT;
    if (s->number[i] == 0) COPY(within + 3 * i, s->normal + 3 * i, 3);
  }
  /* Only neighbours count, if there are any. */
  for (int i = 0; i < n_all; ++i)
    for (int k = 0; k < 3 && s->number[i] > 0; ++k)
      s->normal[3 * i + k] *= 1e-3;
  improve_border(s, within);
  for (int i = 0; i < n_all; ++i)
    if (s->number[i] > 0) set_border_normal(s, i);
  return OK;
}

status round_surface_new(const surface_faces *f, int n_all, const double *x,
                         round_surface **out) {
  *out = NULL;
  if (f->n == 0) return OK;
  MAKES(round_surface, s, out);
  s->f = *f;
  s->x = x;
  PASS_NEW_ALL(OF(s->next, 2 * n_all), OF(s->number, n_all), OF(s->flat, n_all),
               OF(s->sharp, n_all));
  PASS_NEW_REALS(3 * n_all, &s->tangent, &s->normal);
  PASS_NEW(s->face_normal, 3 * f->n);
  for (int i = 0; i < s->f.n && s->f.n_node == 3; ++i) {
    const int *v = s->f.node + 3 * i;
    double e[2][3];
    between(s, v[0], v[1], e[0]);
    between(s, v[0], v[2], e[1]);
    cross(e[0], e[1], s->face_normal + 3 * i);
  }
  const int n = s->f.n_node;
  PASS_NEW_ALL(OF(s->face, 2 * n * s->f.n), OF(s->kind, n * s->f.n));
  for (int k = 0; k < 2 * n * s->f.n; ++k) s->face[k] = -1;
  for (int i = 0; i < s->f.n; ++i)
    for (int a = 0; a < n; ++a)
      if (n == 3 || a == 0)
        PASS(add_edge(s, i, s->f.node[n * i + a],
                      s->f.node[n * i + (a + 1) % n]));
  find_curves(s);
  set_tangents(s, n_all);
  return set_surface(s, n_all);
}

/* ---- the middle ---------------------------------------------------------- */

/* Tangents of both ends towards the other; 0: it is straight. */
static int tangents_of(const round_surface *s, int id, int a, int b, double *ta,
                       double *tb) {
  const int on_curve = s->kind[id] & ON_CURVE;
  const unsigned char bit = on_curve ? CURVE_FLAT : SURFACE_FLAT;
  double c[3];
  int known[2];
  if ((s->flat[a] | s->flat[b]) & bit) return 0;
  if (on_curve) return curve_tangent(s, a, b, ta) && curve_tangent(s, b, a, tb);
  known[0] = surface_tangent(s, a, b, ta);
  known[1] = surface_tangent(s, b, a, tb);
  if (!known[0] && !known[1]) return 0;
  if (known[0] && known[1]) return 1;
  between(s, a, b, c);
  make_unit(3, c);
  memcpy(known[0] ? tb : ta, known[0] ? ta : tb, sizeof c);
  for (int k = 0; k < 3; ++k) (known[0] ? tb : ta)[k] *= -1.0;
  mirror(c, known[0] ? tb : ta);
  return 1;
}

int round_surface_middle(const round_surface *s, int a, int b, double *middle) {
  double ta[3], tb[3], c[3];
  const int id = s == NULL ? -1 : table_find(&s->edges, key_of(a, b));
  if (id < 0 || !tangents_of(s, id, a, b, ta, tb)) return 0;
  between(s, a, b, c);
  const double length = make_unit(3, c);
  const double cosine = 0.5 * (dot(3, ta, c) - dot(3, tb, c));
  add_scaled(3, 1.0, tb, ta); /* ta less the tangent at b in the same sense */
  add_scaled(3, -dot(3, ta, c), c, ta);
  for (int k = 0; k < 3; ++k)
    middle[k] = 0.5 * (s->x[3 * a + k] + s->x[3 * b + k]) +
                length / (4.0 * (1.0 + cosine)) * ta[k];
  return 1;
}
