/*
 * Goals of a pressure, as linear functions of the normal contact forces.
 *
 * The pressure at a point is a mean over the radius rho, t = distance/rho,
 *
 *   w = 105/(64 rho) (1 - 3 t^2) (1 - t^2)^2       on a line,
 *   w = 8/(pi rho^2) (1 - 5/2 t^2) (1 - t^2)^2     on a disc,
 *
 * which are 1 over all and 0 times t^2: the error for a smooth pressure is of
 * the order rho^4 (Hertz, rho half the half width: 2.6e-4 of the peak). A line
 * where the contact is one, and a disc in space and, within rho of it, on the
 * axis. What is beyond a plane of symmetry is on the other side of it. The
 * largest in space is where a paraboloid has its top that fits the pressures
 * within rho, of which the largest alone may be far from there. Without RADIUS=
 * rho is halved while that changes the mean by more than NARROW.
 *
 * The width of a zone is that of the pressure c sqrt(a - x) at its end,
 *
 *   a = x0 + 7/4 N2/N1,   Nk = integral of p (x - x0)^k over x > x0,
 *
 * with x0 at three quarters from the middle to a (Hertz: .0016 a too much), or
 * closer to a until a is where nodes begin to be open.
 */
#include "base/base.h"
#include "effects/goal/parts.h"

#include <lapacke.h>

/* The derivative of J by a normal force at x. */
typedef struct weight {
  double (*at)(const struct weight *w, const double *x, double s);
  int dim, axi;
  double thickness;
  double origin[3], t[3]; /* m; unit tangent of a line */
  const double *s;        /* [contact nodes] along a line, m; NULL: a disc */
  double from;            /* s of the origin, m */
  double radius;          /* m */
  double plane[3];        /* of symmetry, by its coordinate, m; HUGE_VAL */
  double mirror[2];       /* planes of symmetry along a line, m; HUGE_VAL */
  double x0, N1, N2;      /* m, N, N m: of an end */
  double sign;            /* of the side of the end */
  double most;            /* sign times the coordinate where the zone ends, m */
  int n;                  /* closed nodes beyond x0 */
} weight;

/* Coordinate of a contact node along the line, from the origin, m. */
static double along(const weight *w, int q) {
  return w->s == NULL ? 0.0 : w->s[q] - w->from;
}

/* From a force to one of unit thickness, or of unit length round the axis. */
static double per_length(const weight *w, const double *x) {
  return w->axi ? 1.0 / (2.0 * M_PI * x[0]) : 1.0 / w->thickness;
}

static double line_weight(double s, double radius) {
  const double t = s / radius, q = 1.0 - t * t;
  return q > 0.0 ? 105.0 / 64.0 / radius * (1.0 - 3.0 * t * t) * q * q : 0.0;
}

static double on_line(const weight *w, const double *x, double s) {
  double sum = line_weight(s, w->radius);
  for (int k = 0; k < 2; ++k)
    if (isfinite(w->mirror[k]))
      sum += line_weight(2.0 * w->mirror[k] - s, w->radius);
  return sum > 0.0 || sum < 0.0 ? -sum * per_length(w, x) : 0.0;
}

static double disc_weight(double square, double radius) {
  const double t2 = square / (radius * radius), q = 1.0 - t2;
  if (!(q > 0.0)) return 0.0;
  return 8.0 / (M_PI * radius * radius) * (1.0 - 2.5 * t2) * q * q;
}

/* Square of the distance of x, or of its image in the planes of symmetry of the
 * bits of "image", to the middle; infinite without a plane. away[dim]. */
static double image_of(const weight *w, const double *x, int image,
                       double *away) {
  double square = 0.0;
  for (int c = 0; c < w->dim; ++c) {
    const double at = image >> c & 1 ? 2.0 * w->plane[c] - x[c] : x[c];
    away[c] = at - w->origin[c];
    square += away[c] * away[c];
  }
  return square;
}

/* Of x and its images. */
static double on_disc(const weight *w, const double *x, double s) {
  double sum = 0.0, away[3];
  (void)s;
  for (int image = 0; image < 1 << w->dim; ++image)
    sum += disc_weight(image_of(w, x, image, away), w->radius);
  return -sum;
}

/* Distance from x0 towards the end, m; 0: not between both. */
static double beyond(const weight *w, double s) {
  return w->sign * s > w->most ? 0.0 : fmax(w->sign * (s - w->x0), 0.0);
}

static double at_end(const weight *w, const double *x, double s) {
  const double L = beyond(w, s);
  if (!(L > 0.0)) return 0.0;
  return -1.75 * (L * L / w->N1 - L * w->N2 / (w->N1 * w->N1)) *
         per_length(w, x);
}

/* ---- sums over the surface ----------------------------------------------- */

static int is_on(const run *r, const goal_card *g, int q) {
  return r->surface->contact_id[q] == g->contact_id;
}

/* Adds to psi, unless NULL; J of the linear function. */
static double add_nodes(const run *r, const goal_card *g, const weight *w,
                        double *psi) {
  const int dim = w->dim;
  double sum = 0.0;
  for (int q = 0; q < r->nodes.n; ++q) {
    if (!is_on(r, g, q)) continue;
    const double v = w->at(w, r->surface->x + dim * q, along(w, q));
    if (psi != NULL) psi[dim * q] += v;
    sum += v * r->now.rc[dim * q];
  }
  return sum;
}

/* Integral over a face between contact nodes q[dim] of the traction times the
 * weight less its P1 function. */
static double face_rest(const run *r, const weight *w, const int *q,
                        double measure) {
  const int dim = w->dim;
  const face_rule *rule = &mesh_face_rule[dim == 3];
  double sum = 0.0;
  for (int p = 0; p < rule->n; ++p) {
    double b[3], x[3] = {0.0}, s = 0.0, traction = 0.0, linear = 0.0;
    const double part = face_rule_point(rule, dim, p, b);
    for (int k = 0; k < dim; ++k) {
      const double *at = r->surface->x + dim * q[k];
      for (int c = 0; c < dim; ++c) x[c] += b[k] * at[c];
      traction += b[k] * r->now.rc[dim * q[k]] / r->surface->area[q[k]];
      linear += b[k] * w->at(w, at, along(w, q[k]));
      s += b[k] * along(w, q[k]);
    }
    const double turn = w->axi ? 2.0 * M_PI * x[0] : w->thickness;
    sum += part * measure * turn * traction * (w->at(w, x, s) - linear);
  }
  return sum;
}

static status add_faces(const run *r, const goal_card *g, const weight *w,
                        double *sum) {
  const mesh *m = r->msh;
  const mesh_group *of = r->faces.pairs[g->contact_id].group;
  double normal[3];
  OWNED_OF(int, where, goal_places(r, &where));
  for (int k = 0; k < of->n_item; ++k) {
    const int *v = m->face + m->dim * of->item_id[k];
    int q[3] = {0}, all = 1;
    for (int a = 0; a < m->dim; ++a) {
      q[a] = where[v[a]];
      all = all && q[a] >= 0 && r->surface->area[q[a]] > 0.0;
    }
    if (!all) continue;
    *sum += face_rest(r, w, q, mesh_face_normal(m, of->item_id[k], normal));
  }
  return OK;
}

/* ---- the zone ------------------------------------------------------------ */

static double pressure_of(const run *r, int q) {
  const double area = r->surface->area[q];
  return area > 0.0 ? -r->now.rc[r->msh->dim * q] / area : 0.0;
}

/* How many planes of symmetry a node stands on. */
static int mirrors_of(const run *r, int q) {
  const unsigned char *held = r->surface->held + r->msh->dim * q;
  return r->msh->dim == 2 ? goal_is_mirrored(r, q) : held[1] + held[2];
}

/* Contact node nearest to the point of the goal, or that of the largest
 * pressure, by a small margin one in a plane of symmetry; -1: nothing is
 * closed. */
static int peak_of(const run *r, const goal_card *g) {
  static const double margin = 0.01; /* -, for each plane */
  int best = -1;
  double most = 0.0;
  for (int q = 0; q < r->nodes.n; ++q) {
    double d = 0.0;
    double value = pressure_of(r, q) * (1.0 + margin * mirrors_of(r, q));
    if (!is_on(r, g, q)) continue;
    for (int c = 0; g->n_point > 0 && c < r->msh->dim; ++c)
      d = hypot(d, r->surface->x[r->msh->dim * q + c] - g->point[0][c]);
    if (g->n_point > 0) value = 1.0 / (d + 1e-12 * r->msh->size);
    if (value <= most) continue;
    most = value;
    best = q;
  }
  return best;
}

static int is_closed(const run *r, const goal_line *l, int k) {
  return k >= 0 && k < l->n && r->result.contact[l->node[k]] != CONTACT_OPEN;
}

/* First and last closed node of the zone that holds the peak. */
static void zone_of(const run *r, const goal_line *l, int *first, int *last) {
  *first = *last = l->peak;
  while (is_closed(r, l, *first - 1)) --*first;
  while (is_closed(r, l, *last + 1)) ++*last;
}

/* Frame and place of a weight at a contact node. */
static weight weight_at(const run *r, const goal_card *g, int q) {
  const contact_surface *s = r->surface;
  const int dim = s->dim;
  const mesh_group *of = r->faces.pairs[g->contact_id].group;
  weight w = {.dim = dim,
              .axi = r->faces.input.axisymmetric,
              .plane = {HUGE_VAL, HUGE_VAL, HUGE_VAL},
              .thickness = r->faces.face_weight[of->item_id[0]]};
  for (int c = 0; c < dim; ++c) {
    w.origin[c] = s->x[dim * q + c];
    w.t[c] = s->frame[dim * dim * q + dim + c];
  }
  return w;
}

/* ---- the pressure at a point --------------------------------------------- */

/* The top of the parabola through the peak, above both its neighbours, and
 * these. */
static void refine_peak(const run *r, const goal_line *l, weight *w) {
  const int k = l->peak;
  const double a = l->s[k - 1], b = l->s[k + 1];
  const double p = pressure_of(r, l->node[k]);
  const double pa = pressure_of(r, l->node[k - 1]) - p;
  const double pb = pressure_of(r, l->node[k + 1]) - p;
  const double bend = (pb / b - pa / a) / (b - a), slope = pa / a - bend * a;
  if (!(bend < 0.0)) return;
  add_scaled(w->dim, -0.5 * slope / bend, w->t, w->origin);
}

/* Planes of symmetry at the ends of the line. */
static void set_mirrors(const run *r, const goal_line *l, weight *w) {
  const int end[2] = {0, l->n - 1};
  for (int k = 0; k < 2; ++k)
    w->mirror[k] = goal_is_mirrored(r, l->node[end[k]]) ? l->s[end[k]] - w->from
                                                        : HUGE_VAL;
}

/* Behind a plane of symmetry a zone goes on as far as the pressure of its node
 * there is the largest, and not where it is zero, as if it had opened; -. */
static double part_behind(const run *r, int q, double largest) {
  return largest > 0.0 ? fmax(0.0, fmin(1.0, pressure_of(r, q) / largest))
                       : 0.0;
}

/* Half the half width of a zone, m. */
static double half_of(const run *r, const goal_line *l, int first, int last) {
  const int end[2] = {l->node[first], l->node[last]};
  double largest = 0.0, behind = 0.0;
  for (int k = first; k <= last; ++k)
    largest = fmax(largest, pressure_of(r, l->node[k]));
  for (int k = 0; k < 2; ++k)
    if (goal_is_mirrored(r, end[k]))
      behind = fmax(behind, part_behind(r, end[k], largest));
  return 0.25 * (1.0 + behind) * (l->s[last] - l->s[first]);
}

/* Near the axis the mean is over a disc, which has its middle there. */
static void set_disc_of_axis(const goal_card *g, weight *w, goal_form *f) {
  if (!(w->origin[0] < w->radius)) return;
  if (g->n_point > 0 && w->origin[0] > 0.0) {
    if (g->radius > 0.0) f->why = GOAL_NO_END;
    w->radius = w->origin[0];
    return;
  }
  w->origin[0] = 0.0;
  w->at = on_disc;
}

/* Lengths that differ by less, -, are the same: a node or an end of the surface
 * that far away has no weight in the mean. */
static const double SAME = 1e-9;

static double within(const weight *w) { return w->radius * (1.0 - SAME); }

/* A mean takes nodes on both sides of its middle, which lies on the surface. */
static void evaluate_mean(const goal_card *g, const weight *w,
                          const double *near, double longest, goal_form *f) {
  const double away =
      g->n_point > 0 ? distance_of(w->dim, g->point[0], near) : 0.0;
  const double least = longest * (1.0 - SAME);
  f->is_coarse = w->radius < 2.0 * least;
  if (f->why == GOAL_RELIABLE && (w->radius < least || away > w->radius))
    f->why = GOAL_NO_ZONE;
}

/* The longest edge within the radius, and whether it is cut by an end of the
 * surface that carries. */
static void evaluate_line(const run *r, const goal_card *g, const goal_line *l,
                          const weight *w, goal_form *f) {
  double longest = 0.0;
  for (int k = 1; k < l->n; ++k)
    if (l->s[k] - w->from > -within(w) && l->s[k - 1] - w->from < within(w))
      longest = fmax(longest, l->s[k] - l->s[k - 1]);
  evaluate_mean(g, w, r->surface->x + w->dim * l->node[l->peak], longest, f);
  for (int k = 0; k<l->n; k += l->n> 1 ? l->n - 1 : 1)
    if (fabs(l->s[k] - w->from) < within(w) && is_closed(r, l, k) &&
        !goal_is_mirrored(r, l->node[k]) && f->why == GOAL_RELIABLE)
      f->why = GOAL_NO_END;
}

/* Where the largest pressure may be infinite there is no peak. */
static void place_on_line(const run *r, const goal_card *g, const goal_line *l,
                          weight *w, goal_form *f) {
  int first, last;
  double moved[2];
  const int peak = l->node[l->peak], mirrored = goal_is_mirrored(r, peak);
  const int at_border = l->peak == 0 || l->peak == l->n - 1;
  zone_of(r, l, &first, &last);
  w->radius = g->radius > 0.0 ? g->radius : half_of(r, l, first, last);
  if (at_border && !mirrored)
    f->why = GOAL_NO_PEAK;
  else if (last == first)
    f->why = GOAL_NO_ZONE;
  else if (!at_border && g->n_point == 0)
    refine_peak(r, l, w);
  if (g->n_point > 0)
    for (int c = 0; c < w->dim; ++c) w->origin[c] = g->point[0][c];
  vector_of(2, r->surface->x + 2 * peak, w->origin, moved);
  w->from = l->s[l->peak] + dot(2, moved, w->t);
  w->s = l->at;
  set_mirrors(r, l, w);
  w->at = on_line;
  if (w->axi) set_disc_of_axis(g, w, f);
  evaluate_line(r, g, l, w, f);
}

/* ---- a disc in space ----------------------------------------------------- */

/* Sides of the faces of a group, sorted; new. */
static status sides_of(const mesh *m, const mesh_group *of, number_pair **out) {
  PASS_NEW(*out, 3 * of->n_item);
  for (int k = 0; k < of->n_item; ++k)
    for (int a = 0; a < 3; ++a) {
      const int *v = m->face + 3 * of->item_id[k];
      (*out)[3 * k + a] = number_pair_of(v[a], v[(a + 1) % 3]);
    }
  PAIR_SORT(*out, 3 * of->n_item);
  return OK;
}

enum { TERMS = 6 };              /* of a paraboloid */
static const double NEAR = 1e-3; /* -, of the radius, to its top */

/* What a disc meets. */
typedef struct rim {
  int cut;        /* 1: by a border that carries and is on no plane */
  double longest; /* side of a face, m */
} rim;

/* 1: a side of the border lies in a plane of symmetry normal to axis c. */
static int lies_in_plane(const run *r, const number_pair *e, int c) {
  const mesh *m = r->msh;
  const unsigned char *fixed = r->body.d.fixed;
  const int i = 3 * e->a + c, j = 3 * e->b + c;
  return fixed[i] && fixed[j] && fabs(m->x[i] - m->x[j]) <= 1e-9 * m->size;
}

/* The planes of symmetry that a side of the border lies in; 0: none. */
static int add_planes(const run *r, const number_pair *e, weight *w) {
  int any = 0;
  for (int c = 0; c < 3; ++c) {
    if (!lies_in_plane(r, e, c)) continue;
    w->plane[c] = r->msh->x[3 * e->a + c];
    any = 1;
  }
  return any;
}

static int is_near(const run *r, int node, const weight *w, double radius) {
  return distance_of(3, r->msh->x + 3 * node, w->origin) <= radius;
}

static int carries(const run *r, const int *where, int node) {
  return where[node] >= 0 && r->result.contact[where[node]] != CONTACT_OPEN;
}

/* The sides that have a node within a radius of the middle. */
static status look_round(const run *r, const goal_card *g, double radius,
                         weight *w, rim *out) {
  const mesh_group *of = r->faces.pairs[g->contact_id].group;
  const int n = 3 * of->n_item;
  OWNED_OF(number_pair, e, sides_of(r->msh, of, &e));
  OWNED_OF(int, where, goal_places(r, &where));
  *out = (rim){0, 0.0};
  for (int k = 0, last; k < n; k = last) {
    const int v[2] = {e[k].a, e[k].b};
    last = PAIR_END(e, n, k);
    if (!is_near(r, v[0], w, radius) && !is_near(r, v[1], w, radius)) continue;
    out->longest = fmax(out->longest, distance_of(3, r->msh->x + 3 * v[0],
                                                  r->msh->x + 3 * v[1]));
    if (last == k + 1 && !add_planes(r, e + k, w))
      out->cut |= carries(r, where, v[0]) || carries(r, where, v[1]);
  }
  return OK;
}

/* behind[3]: part_behind of the planes of symmetry normal to each axis. */
static status parts_behind(const run *r, const goal_card *g, double largest,
                           double *behind) {
  const mesh_group *of = r->faces.pairs[g->contact_id].group;
  OWNED_OF(number_pair, e, sides_of(r->msh, of, &e));
  OWNED_OF(int, where, goal_places(r, &where));
  for (int k = 0; k < 3 * of->n_item; ++k)
    for (int c = 0; c < 3; ++c) {
      if (!lies_in_plane(r, e + k, c)) continue;
      const int q[2] = {where[e[k].a], where[e[k].b]};
      for (int i = 0; i < 2; ++i)
        if (q[i] >= 0)
          behind[c] = fmax(behind[c], part_behind(r, q[i], largest));
    }
  return OK;
}

/* Half the radius of a disc of the area that is closed, m. */
static status set_half_of_disc(const run *r, const goal_card *g, weight *w) {
  double area = 0.0, largest = 0.0, behind[3] = {0.0};
  for (int q = 0; q < r->nodes.n; ++q)
    if (is_on(r, g, q) && r->result.contact[q] != CONTACT_OPEN) {
      area += r->surface->area[q];
      largest = fmax(largest, pressure_of(r, q));
    }
  PASS(parts_behind(r, g, largest, behind));
  w->radius = 0.5 * sqrt(area / M_PI);
  for (int c = 0; c < 3; ++c) w->radius *= sqrt(1.0 + behind[c]);
  return OK;
}

/* Adds the row 1, s, t, s s, s t, t t of a point with the pressure p to the
 * normal equations A x = b, places in radii. */
static void add_point(double s, double t, double p, double *A, double *b) {
  const double row[TERMS] = {1.0, s, t, s * s, s * t, t * t};
  for (int i = 0; i < TERMS; ++i) {
    b[i] += row[i] * p;
    for (int j = 0; j < TERMS; ++j) A[i + TERMS * j] += row[i] * row[j];
  }
}

/* top[2], from the middle to the top of the paraboloid, in radii; 0: none. */
static int find_top(const run *r, const goal_card *g, const weight *w,
                    const double *frame, double *top) {
  double A[TERMS * TERMS] = {0.0}, b[TERMS] = {0.0}, away[3];
  for (int q = 0; q < r->nodes.n; ++q)
    for (int image = 0; image < 8 && is_on(r, g, q); ++image) {
      double at[2] = {0.0};
      if (!(image_of(w, r->surface->x + 3 * q, image, away) <
            within(w) * within(w)))
        continue;
      for (int a = 0; a < 2; ++a)
        for (int c = 0; c < 3; ++c)
          at[a] += away[c] * frame[3 * (a + 1) + c] / w->radius;
      add_point(at[0], at[1], pressure_of(r, q), A, b);
    }
  if (LAPACKE_dposv_work(LAPACK_COL_MAJOR, 'L', TERMS, 1, A, TERMS, b, TERMS))
    return 0;
  const double det = 4.0 * b[3] * b[5] - b[4] * b[4];
  if (!(b[3] < 0.0 && det > 0.0)) return 0;
  top[0] = (b[4] * b[2] - 2.0 * b[5] * b[1]) / det;
  top[1] = (b[4] * b[1] - 2.0 * b[3] * b[2]) / det;
  return 1;
}

/* Moves the middle from a contact node to the top. */
static void climb(const run *r, const goal_card *g, int peak, weight *w) {
  enum { STEPS = 20 };
  const double *frame = r->surface->frame + 9 * peak;
  double top[2], size = 1.0;
  for (int k = 0; k < STEPS && size > NEAR; ++k) {
    if (!find_top(r, g, w, frame, top)) return;
    size = hypot(top[0], top[1]);
    const double part = w->radius * fmin(1.0, 0.5 / size);
    for (int c = 0; c < 3; ++c)
      w->origin[c] += part * (top[0] * frame[3 + c] + top[1] * frame[6 + c]);
  }
}

static status place_on_disc(const run *r, const goal_card *g, int peak,
                            weight *w, goal_form *f) {
  const double *at = r->surface->x + 3 * peak;
  rim border;
  PASS(look_round(r, g, 1e-9 * r->msh->size, w, &border));
  if (border.cut) f->why = GOAL_NO_PEAK;
  w->at = on_disc;
  w->radius = g->radius;
  if (!(g->radius > 0.0)) PASS(set_half_of_disc(r, g, w));
  PASS(look_round(r, g, within(w), w, &border));
  if (g->n_point > 0)
    memcpy(w->origin, g->point[0], sizeof w->origin);
  else
    climb(r, g, peak, w);
  PASS(look_round(r, g, within(w), w, &border));
  evaluate_mean(g, w, at, border.longest, f);
  if (border.cut && f->why == GOAL_RELIABLE) f->why = GOAL_NO_END;
  return OK;
}

/* l: through the peak, of plane contacts. */
static status place_mean(const run *r, const goal_card *g, int peak,
                         const goal_line *l, weight *w, goal_form *f) {
  *w = weight_at(r, g, peak);
  if (w->dim == 3) return place_on_disc(r, g, peak, w, f);
  place_on_line(r, g, l, w, f);
  return OK;
}

/* Of nodes with about the pressure of the peak the one where the mean over the
 * same radius is the largest. */
static void choose_peak(const run *r, const goal_card *g, goal_line *l,
                        weight *w) {
  static const double ABOUT = 0.95; /* -, of the pressure of the peak */
  double most = add_nodes(r, g, w, NULL);
  const double least = fmax(most, ABOUT * pressure_of(r, l->node[l->peak]));
  goal_card same = *g;
  same.radius = w->radius;
  for (int k = 0; k < l->n; ++k) {
    goal_form f = {.why = GOAL_RELIABLE};
    weight other = weight_at(r, g, l->node[k]);
    goal_line at = *l;
    at.peak = k;
    if (!(pressure_of(r, l->node[k]) > least)) continue;
    place_on_line(r, &same, &at, &other, &f);
    const double mean = add_nodes(r, g, &other, NULL);
    if (f.why != GOAL_RELIABLE || !(mean > most)) continue;
    most = mean;
    *w = other;
    l->peak = k;
  }
}

/* -, of the mean; half the radius changes that of Hertz by 0.002. */
static const double NARROW = 0.01;

/* A radius over which the pressure goes like a parabola, while its half has two
 * elements; what the mean may be off. */
static status narrow(const run *r, const goal_card *g, int peak,
                     const goal_line *l, weight *w, goal_form *f) {
  for (double mean = add_nodes(r, g, w, NULL);;) {
    weight half;
    goal_card closer = *g;
    goal_form of_half = {.why = GOAL_RELIABLE};
    closer.radius = 0.5 * w->radius;
    PASS(place_mean(r, &closer, peak, l, &half, &of_half));
    if (of_half.why != GOAL_RELIABLE || of_half.is_coarse) {
      f->is_coarse |= f->rough > 0.0;
      if (!(f->rough > 0.0) && g->n_point == 0)
        f->rough = fabs(pressure_of(r, peak) - mean);
      return OK;
    }
    const double next = add_nodes(r, g, &half, NULL);
    const double change = fabs(next - mean);
    const int ends = change <= NARROW * fabs(next);
    if (!ends || f->rough > 0.0) f->rough = change;
    if (ends) return OK;
    *w = half;
    mean = next;
  }
}

/* Next to a corner of the gap the pressure is infinite, or higher than the mesh
 * has it: twice what the corner makes within an edge if it is rounded over an
 * eighth of that. */
static status sharpen(const run *r, const weight *w, goal_form *f, int id) {
  double most;
  PASS(goal_sharpest(r, id, w->origin, within(w), &most));
  f->is_coarse |= most > 0.0;
  f->rough += 2.0 * most * fabs(f->value);
  return OK;
}

status goal_set_pressure(const run *r, const goal_card *g, goal_form *f) {
  int peak = peak_of(r, g);
  f->value = NAN;
  if (peak < 0) f->why = GOAL_NO_ZONE;
  if (!goal_has_one_thickness(r, g->contact_id)) f->why = GOAL_NOT_COVERED;
  if (f->why != GOAL_RELIABLE) return OK;
  weight w;
  OWNED_PARTS(goal_line, l, goal_line_new(r, g, peak, &l));
  PASS(place_mean(r, g, peak, &l, &w, f));
  if (f->why != GOAL_RELIABLE) return OK;
  if (g->n_point == 0 && l.n > 0) {
    choose_peak(r, g, &l, &w);
    peak = l.node[l.peak];
  }
  if (!(g->radius > 0.0)) PASS(narrow(r, g, peak, &l, &w, f));
  f->value = add_nodes(r, g, &w, f->psi);
  PASS(sharpen(r, &w, f, g->contact_id));
  return add_faces(r, g, &w, &f->curved);
}

/* ---- the width of a zone ------------------------------------------------- */

/* w->N1, N2 for x0; returns the end along the line, m. */
static double end_for(const run *r, const goal_line *l, weight *w, double x0) {
  w->x0 = x0;
  w->N1 = w->N2 = 0.0;
  w->n = 0;
  for (int k = 0; k < l->n; ++k) {
    const double *x = r->surface->x + 2 * l->node[k];
    const double L = beyond(w, l->s[k]);
    if (!(L > 0.0)) continue;
    const double p = -r->now.rc[2 * l->node[k]] * per_length(w, x);
    w->n += is_closed(r, l, k);
    w->N1 += p * L;
    w->N2 += p * L * L;
  }
  return x0 + w->sign * 1.75 * w->N2 / w->N1;
}

/* The two ends of a zone, 0 before and 1 after it. */
typedef struct zone_ends {
  weight w[2];
  int mirrored[2];
  double at[2];             /* m, along the line */
  double part[2];           /* -, of the half width, from x0 to the end */
  double least[2], most[2]; /* sign times at that nodes allow, m */
} zone_ends;

/* The ends for x0 that follows from them. */
static void find_ends(const run *r, const goal_line *l, zone_ends *z) {
  enum { PASSES = 12 };
  for (int pass = 0; pass < PASSES; ++pass) {
    const double middle = z->mirrored[0]   ? z->at[0]
                          : z->mirrored[1] ? z->at[1]
                                           : 0.5 * (z->at[0] + z->at[1]);
    for (int k = 0; k < 2; ++k)
      if (!z->mirrored[k])
        z->at[k] = end_for(r, l, &z->w[k],
                           middle + (1.0 - z->part[k]) * (z->at[k] - middle));
  }
}

enum { LEAST = 2 }; /* closed nodes beyond x0 */

/* 1: an end is where it cannot be. */
static int is_off(const zone_ends *z, int k) {
  const double at = z->w[k].sign * z->at[k];
  return !z->mirrored[k] && !(at >= z->least[k] && at <= z->most[k]);
}

/* Halves the parts at ends that are off; 1: there are. */
static int move_x0(const goal_line *l, const int *end, zone_ends *z) {
  int any = 0;
  for (int k = 0; k < 2; ++k) {
    if (!is_off(z, k) || z->w[k].n <= LEAST) continue;
    z->part[k] *= 0.5;
    any = 1;
  }
  for (int k = 0; k < 2 && any; ++k) z->at[k] = l->s[end[k]];
  return any;
}

static const double QUARTER = 0.25; /* -, of the half width */

/* End k of the zone from its last closed node; 0: at the end of the surface. */
static int start_end(const run *r, const goal_line *l, int k, int at,
                     const weight *w, zone_ends *z) {
  const int border = at == 0 || at == l->n - 1;
  z->w[k] = *w;
  z->w[k].at = at_end;
  z->w[k].sign = k == 0 ? -1.0 : 1.0;
  z->at[k] = l->s[at];
  z->part[k] = QUARTER;
  if (!border) {
    const int out = k == 0 ? -1 : 1;
    z->w[k].most = z->w[k].sign * l->s[at + out];
    z->least[k] = z->w[k].sign * l->s[at - out];
    z->most[k] = 2.0 * z->w[k].most - z->w[k].sign * l->s[at];
  }
  z->mirrored[k] = border && goal_is_mirrored(r, l->node[at]);
  return z->mirrored[k] || !border;
}

/* What an end may be off: twice what half of its part changes, as where the
 * pressure goes like the distance, but an edge over the closed nodes of its
 * part where these are few (2 to 7 of them: up to 0.8 of that), and an edge
 * where its part is less than a quarter. */
static double roughness_of(const zone_ends *z, const zone_ends *half, int k,
                           double edge) {
  const int n = half->w[k].n;
  const double change = n < LEAST ? 0.0 : 2.0 * fabs(half->at[k] - z->at[k]);
  const double least = n < 2 * LEAST ? edge / z->w[k].n : 0.0;
  return fmax(change, z->part[k] < QUARTER ? edge : least);
}

static status set_ends(const run *r, const goal_card *g, const goal_line *l,
                       const weight *w, goal_form *f) {
  enum { HALVINGS = 30 };
  int end[2];
  zone_ends z;
  zone_of(r, l, &end[0], &end[1]);
  if (end[1] == end[0]) f->why = GOAL_NO_ZONE;
  for (int k = 0; k < 2; ++k)
    if (!start_end(r, l, k, end[k], w, &z)) f->why = GOAL_NO_END;
  if (f->why != GOAL_RELIABLE) return OK;
  find_ends(r, l, &z);
  for (int n = 0; n < HALVINGS && move_x0(l, end, &z); ++n) find_ends(r, l, &z);
  zone_ends half = z;
  for (int k = 0; k < 2; ++k) half.part[k] *= 0.5;
  find_ends(r, l, &half);
  f->value = z.at[1] - z.at[0];
  for (int k = 0; k < 2; ++k) {
    if (z.mirrored[k]) continue;
    if (z.w[k].n < LEAST || is_off(&z, k)) {
      f->value = NAN;
      f->why = GOAL_NO_ZONE;
      return OK;
    }
    f->rough +=
        roughness_of(&z, &half, k, z.w[k].most - z.w[k].sign * l->s[end[k]]);
    add_nodes(r, g, &z.w[k], f->psi);
    PASS(add_faces(r, g, &z.w[k], &f->curved));
  }
  return OK;
}

status goal_set_width(const run *r, const goal_card *g, goal_form *f) {
  const int peak = peak_of(r, g);
  f->value = NAN;
  if (r->msh->dim == 3 || !goal_has_one_thickness(r, g->contact_id))
    f->why = GOAL_NOT_COVERED;
  if (peak < 0) f->why = GOAL_NO_ZONE;
  if (f->why != GOAL_RELIABLE) return OK;
  weight w = weight_at(r, g, peak);
  OWNED_PARTS(goal_line, l, goal_line_new(r, g, peak, &l));
  w.s = l.at;
  return set_ends(r, g, &l, &w, f);
}
