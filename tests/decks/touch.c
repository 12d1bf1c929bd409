/*
 * The contacts: normals, areas, gaps and the motion of the obstacles from the
 * geometry, then the unilateral and the friction condition of every node.
 */
#include "decks/judge.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static double dot(const double *a, const double *b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double *a, const double *b, double *c) {
  for (int k = 0; k < 3; ++k)
    c[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

/* v turned by an angle about an axis of any length. */
static void turn(const double *axis, double angle, double *v) {
  double length = sqrt(dot(axis, axis)), a[3], across[3];
  if (angle == 0 || length == 0) return;
  for (int c = 0; c < 3; ++c) a[c] = axis[c] / length;
  double along = dot(a, v);
  cross(a, v, across);
  for (int c = 0; c < 3; ++c)
    v[c] = along * a[c] + cos(angle) * (v[c] - along * a[c]) +
           sin(angle) * across[c];
}

/* Where the point of the obstacle now at x was before it moved. */
static void move_back(const random_deck *d, const deck_obstacle *o, double t,
                      const double *x, double *y) {
  double shift[3], angle;
  deck_motion(d, o, t, shift, &angle);
  for (int c = 0; c < 3; ++c) y[c] = x[c] - shift[c] - o->pivot[c];
  turn(o->axis, -angle, y);
  for (int c = 0; c < 3; ++c) y[c] += o->pivot[c];
}

/* ---- the gap ------------------------------------------------------------ */

/* y and n without their part along the axis of a cylinder. */
static void flatten(const random_deck *d, const deck_obstacle *o, double *v) {
  if (o->kind != CYLINDER || d->mesh.dim == 2) return;
  double part = dot(v, o->direction) / dot(o->direction, o->direction);
  for (int c = 0; c < 3; ++c) v[c] -= part * o->direction[c];
}

/* From x along n to the obstacle where it lies at time t. */
static double gap_to(const random_deck *d, const deck_obstacle *o, double t,
                     const double *x, const double *n) {
  double y[3], m[3], shift[3], angle, along, s;
  move_back(d, o, t, x, y);
  deck_motion(d, o, t, shift, &angle);
  if (o->kind == CONFORMING) {
    for (int c = 0; c < 3; ++c) m[c] = x[c] - y[c];
    return dot(n, m);
  }
  if (o->kind == GAP) {
    along = dot(n, shift);
    s = x[0] - (shift[0] - along * n[0]) - o->gap_at;
    return o->gap0 + o->gap2 * s * s + along;
  }
  memcpy(m, n, sizeof m);
  turn(o->axis, -angle, m);
  for (int c = 0; c < 3; ++c) y[c] -= o->point[c];
  if (o->kind == PLANE) return -dot(y, o->direction) / dot(m, o->direction);
  flatten(d, o, y);
  flatten(d, o, m);
  double a = dot(m, m), b = dot(y, m), c2 = dot(y, y) - o->radius * o->radius;
  return (-b - sqrt(b * b - a * c2)) / a;
}

/* Displacement of the surface of the obstacle past x from t0 to t. */
static void drift(const random_deck *d, const deck_obstacle *o, double t0,
                  double t, const double *x, const double *n, double *way) {
  enum { PIECES = 16 };
  double from[3], to[3], a0, a1, start = gap_to(d, o, t0, x, n);
  double end = gap_to(d, o, t, x, n), arm[3], across[3], axis[3];
  deck_motion(d, o, t0, from, &a0);
  deck_motion(d, o, t, to, &a1);
  double length = sqrt(dot(o->axis, o->axis));
  for (int c = 0; c < 3; ++c) {
    way[c] = to[c] - from[c];
    axis[c] = length > 0 ? o->axis[c] / length : 0;
  }
  for (int k = 0; k < PIECES; ++k) {
    double w = (k + 0.5) / PIECES, gap = (1 - w) * start + w * end;
    for (int c = 0; c < 3; ++c)
      arm[c] =
          x[c] + gap * n[c] - ((1 - w) * from[c] + w * to[c]) - o->pivot[c];
    cross(axis, arm, across);
    for (int c = 0; c < 3; ++c) way[c] += (a1 - a0) / PIECES * across[c];
  }
}

/* ---- nodes -------------------------------------------------------------- */

typedef struct contact_node {
  int row, node, fixed; /* fixed: bits of prescribed components             */
  double x[3], n[3], area, u[3], moved[3], force[3];
  double f_n, gap, limit;
  int status;
} contact_node;

/* Components of a node that supports of any step prescribe. */
static int fixed_bits(const random_deck *d, int node) {
  int bits = 0;
  for (int s = 0; s < d->n_step; ++s)
    for (int k = 0; k < d->step[s].n_load; ++k) {
      const deck_load *l = &d->step[s].load[k];
      if (l->kind == FIX && solid_in(&d->mesh, l->group, node))
        bits |= 1 << l->component;
    }
  return bits;
}

/* The obstacle's own normal towards the body, turned round, at time 0. */
static void obstacle_normal(const random_deck *d, const deck_obstacle *o,
                            const double *x, double *n) {
  double y[3], shift[3], angle;
  deck_motion(d, o, 0, shift, &angle);
  move_back(d, o, 0, x, y);
  for (int c = 0; c < 3; ++c)
    n[c] = o->kind == PLANE ? -o->direction[c] : o->point[c] - y[c];
  flatten(d, o, n);
  turn(o->axis, angle, n);
}

static void find_normal(const random_deck *d, const deck_contact *c,
                        contact_node *q) {
  const solid *s = &d->mesh;
  for (int f = 0; f < s->n_face; ++f) {
    double w[3], v[3] = {0, 0, 0}, size;
    if (s->face_group[f] != c->group) continue;
    for (int a = 0; a < s->dim; ++a) {
      if (s->face[s->dim * f + a] != q->node) continue;
      face_shares(d, f, w);
      face_vector(s, f, v);
      size = sqrt(dot(v, v));
      q->area += w[a];
      for (int k = 0; k < 3; ++k) q->n[k] += w[a] * v[k] / size;
    }
  }
  if (c->obstacle.kind == PLANE || c->normal == 2)
    obstacle_normal(d, &c->obstacle, q->x, q->n);
  /* On the axis a body lies on a round obstacle as on its mirror. */
  if (d->kind == AXISYMMETRIC_ && c->obstacle.kind == SPHERE && q->x[0] == 0)
    q->n[0] = 0;
  double size = sqrt(dot(q->n, q->n));
  for (int k = 0; k < 3; ++k) q->n[k] /= size;
}

static double cell(const judged *j, int row, const char *name) {
  const table *t = &j->now->of[T_CONTACT];
  int col = table_column(t, name);
  return col < 0 ? 0 : table_at(t, row, col);
}

static contact_node take_node(const judged *j, const deck_contact *c, int row) {
  const random_deck *d = j->d;
  int dim = d->mesh.dim, ring = d->kind == AXISYMMETRIC_;
  const table *t = &j->now->of[T_CONTACT];
  contact_node q = {.row = row, .node = (int)table_at(t, row, 0) - 1};
  int force = table_column(t, ring ? "f_r" : "f_x");
  for (int k = 0; k < dim; ++k) {
    q.x[k] = d->mesh.x[dim * q.node + k];
    q.u[k] = j->u[dim * q.node + k];
    q.moved[k] = q.u[k] - j->old_u[dim * q.node + k];
    q.force[k] = table_at(t, row, force + k);
  }
  q.fixed = fixed_bits(d, q.node);
  find_normal(d, c, &q);
  q.f_n = cell(j, row, "f_n");
  q.gap = cell(j, row, "gap");
  q.limit = cell(j, row, "limit");
  q.status = (int)cell(j, row, "status");
  return q;
}

/* What is left of v in the tangent plane without fixed components, which is at
 * a right angle to what is left of the normal. */
static void tangential(const contact_node *q, double *v) {
  double n[3];
  for (int c = 0; c < 3; ++c) {
    if (q->fixed >> c & 1) v[c] = 0;
    n[c] = q->fixed >> c & 1 ? 0 : q->n[c];
  }
  const double size = dot(n, n), along = size > 0 ? dot(v, n) / size : 0;
  for (int c = 0; c < 3; ++c) v[c] -= along * n[c];
}

/* ---- conditions --------------------------------------------------------- */

/* Scales of a contact: largest force and displacement; force with what the
 * residual of the program allows. */
typedef struct touch_scale {
  double force, length, slack;
} touch_scale;

static void judge_frame(const judged *j, const contact_node *q,
                        const touch_scale *s) {
  double pressure = cell(j, q->row, "pressure"), n[3];
  int no = q->node + 1;
  /* A force along what is fixed is friction, oblique to a normal that leans. */
  for (int c = 0; c < 3; ++c) n[c] = q->fixed >> c & 1 ? 0 : q->n[c];
  judge_note(j->q, OF_FRAME, dot(q->n, q->u) - cell(j, q->row, "u_n"),
             s->length, j->now, no);
  judge_note(j->q, OF_FRAME, pressure * q->area - q->f_n, s->force, j->now, no);
  judge_note(j->q, OF_FRAME, dot(n, q->force) + q->f_n * dot(n, n), s->force,
             j->now, no);
}

static double given_force(const judged *j, const deck_contact *c,
                          const contact_node *q) {
  double p = linear_value(&c->pressure, j->d->mesh.dim, q->x);
  if (c->course >= 0) p *= course_value(&j->d->courses[c->course], j->now->t);
  return p * q->area;
}

static void judge_normal(const judged *j, const deck_contact *c,
                         const contact_node *q, const touch_scale *s) {
  double gap = gap_to(j->d, &c->obstacle, j->now->t, q->x, q->n);
  double stiff = j->stiffness[q->node], own = gap - dot(q->n, q->u), miss;
  /* The tolerance, 1e-7, of this is a few roundings of the coordinates. */
  const double rounded = 1e-8 * sqrt(dot(q->x, q->x));
  judge_note(j->q, OF_GAP, own - q->gap, s->length + fabs(gap) + rounded,
             j->now, q->node + 1);
  miss = q->f_n - fmax(0, q->f_n - stiff * own);
  if (c->given) miss = q->f_n - given_force(j, c, q);
  judge_note(j->q, OF_NORMAL, miss, s->slack + 1e-7 * stiff * s->length, j->now,
             q->node + 1);
}

/* Slip since the last equilibrium, or from the origin in *STATIC: past the
 * obstacle that has moved by the increments of the run. */
static void find_slip(const judged *j, const deck_contact *c,
                      const contact_node *q, double *slip) {
  const random_deck *d = j->d;
  int fresh = d->step[j->step].kind == IS_STATIC && j->now->increment > 0;
  for (int k = 0; k < 3; ++k) slip[k] = fresh ? q->u[k] : q->moved[k];
  for (const snapshot *s = fresh ? j->first : j->now; s <= j->now; ++s) {
    double t0 = s == j->first ? 0 : s[-1].t, way[3];
    drift(d, &c->obstacle, t0, s->t, q->x, q->n, way);
    for (int k = 0; k < 3; ++k) slip[k] -= way[k];
  }
  tangential(q, slip);
}

/* r_t - P_g(r_t - c slip) = 0 on the disc of radius g. */
static void judge_friction(const judged *j, const deck_contact *c,
                           const contact_node *q, const touch_scale *s) {
  double slip[3], trial[3], miss[3], stiff = j->stiffness[q->node], size;
  double force[3] = {q->force[0], q->force[1], q->force[2]};
  double floor = 1e-7 * stiff * s->length;
  find_slip(j, c, q, slip);
  if ((q->fixed & ((1 << j->d->mesh.dim) - 1)) != 0 && j->d->mesh.dim == 2)
    return;
  tangential(q, force);
  for (int k = 0; k < 3; ++k) trial[k] = force[k] - stiff * slip[k];
  size = sqrt(dot(trial, trial));
  for (int k = 0; k < 3; ++k)
    miss[k] =
        force[k] - (size > q->limit ? trial[k] * q->limit / size : trial[k]);
  judge_note(j->q, OF_FRICTION, sqrt(dot(miss, miss)), s->slack + floor, j->now,
             q->node + 1);
  double told = hypot(cell(j, q->row, "slip_1"), cell(j, q->row, "slip_2"));
  if (j->d->mesh.dim == 2) told = fabs(cell(j, q->row, "slip"));
  if (q->fixed == 0 && table_column(&j->now->of[T_CONTACT], "limit") >= 0)
    judge_note(j->q, OF_SLIP, told - sqrt(dot(slip, slip)), s->length, j->now,
               q->node + 1);
}

/* ---- limits ------------------------------------------------------------- */

/* What mu or g multiplies at each node, and where zero is right as well. */
static void find_means(const judged *j, const deck_contact *c,
                       const deck_friction *f, int n, const contact_node *q,
                       double *mean, unsigned char *open) {
  double *p = calloc((size_t)n + 1, sizeof *p);
  int *node = calloc((size_t)n + 1, sizeof *node);
  if (p == NULL || node == NULL) abort();
  for (int i = 0; i < n; ++i) {
    open[i] = 0;
    node[i] = q[i].node;
    p[i] = q[i].f_n / q[i].area;
    mean[i] = f->law == TRESCA ? 1 : f->law == COULOMB ? p[i] : 0;
  }
  averaged_contact in = {j->d, f, c->group, n, node, p};
  if (f->law == NONLOCAL) judge_average(&in, mean, open);
  free(p);
  free(node);
}

static void judge_limits(const judged *j, const deck_contact *c,
                         const deck_friction *f, int n, const contact_node *q,
                         const touch_scale *s) {
  double *mean = calloc((size_t)n + 1, sizeof *mean), most = 0;
  unsigned char *open = calloc((size_t)n + 1, 1);
  check_kind kind = f->law != NONLOCAL             ? OF_LIMIT
                    : f->kernel == CONSTANT_KERNEL ? OF_MEAN
                                                   : OF_AVERAGE;
  if (mean == NULL || open == NULL) abort();
  find_means(j, c, f, n, q, mean, open);
  for (int i = 0; i < n; ++i) {
    mean[i] *= q[i].area * deck_friction_value(j->d, f, q[i].x, j->now->t);
    mean[i] = fmax(mean[i], 0);
    most = fmax(most, mean[i]);
  }
  for (int i = 0; i < n; ++i) {
    int away = f->law == NONLOCAL && f->zone && q[i].f_n <= 0.2 * s->force;
    if (away && q[i].limit == 0) continue;
    if (open[i] && q[i].limit > mean[i] * 0.9) continue;
    judge_note(j->q, kind, q[i].limit - mean[i], most + 1e-6 * s->slack, j->now,
               q[i].node + 1);
  }
  free(mean);
  free(open);
}

static void judge_contact(judged *j, int k, double sum[4]) {
  const random_deck *d = j->d;
  const deck_contact *c = &d->contact[k];
  const table *t = &j->now->of[T_CONTACT];
  const deck_friction *f = deck_friction_at(d, j->step, k);
  contact_node *q = calloc((size_t)t->n_row + 1, sizeof *q);
  touch_scale s = {.force = LEAST_FORCE, .length = 1e-9};
  int n = 0;
  if (q == NULL) abort();
  for (int row = 0; row < t->n_row; ++row)
    if (solid_in(&d->mesh, c->group, (int)table_at(t, row, 0) - 1))
      q[n++] = take_node(j, c, row);
  for (int i = 0; i < n; ++i) {
    s.force = fmax(s.force, sqrt(dot(q[i].force, q[i].force)));
    s.length = fmax(s.length, sqrt(dot(q[i].u, q[i].u)));
    for (int a = 0; a < 3; ++a) sum[a] += q[i].force[a];
    sum[3] = fmax(sum[3], s.force);
    j->q->touching += q[i].status > 0;
    j->q->slipping += q[i].status == 1;
    j->q->sticking += q[i].status == 2;
  }
  s.slack = s.force + 1e8 * j->residual * fmax(s.force, j->largest);
  if (f->law != FRICTIONLESS) judge_limits(j, c, f, n, q, &s);
  for (int i = 0; i < n; ++i) {
    judge_frame(j, &q[i], &s);
    judge_normal(j, c, &q[i], &s);
    judge_friction(j, c, &q[i], &s);
  }
  free(q);
}

void judge_contacts(judged *j) {
  const table *t = &j->now->of[T_TOTALS];
  int ring = j->d->kind == AXISYMMETRIC_;
  int at = table_column(t, ring ? "force_z" : "force_x");
  double sum[4] = {0, 0, 0, 0}; /* the last: largest force of a node        */
  for (int k = 0; k < j->d->n_contact; ++k) judge_contact(j, k, sum);
  for (int c = ring; c < j->d->mesh.dim && at >= 0; ++c) {
    double told = 0;
    for (int row = 0; row < t->n_row; ++row)
      told += table_at(t, row, ring ? at : at + c);
    judge_note(j->q, OF_TOTAL, told - sum[c], sum[3], j->now, c);
  }
}
