/*
 * What contact forces do between the nodes: along the surface, by a friction
 * value given by a formula, by a gap that is rougher than the parabola in an
 * edge, where friction turns back.
 */
#include "base/base.h"
#include "effects/goal/parts.h"

#include <cblas.h>

static const double FULL = 1e-6; /* -, of the limit: friction has reached it */
static const double HALT = 2.0; /* -, edges over which slip may go on falling */

int goal_slides(const run *r, int q) {
  const int dim = r->msh->dim;
  const double g = r->result.g == NULL ? 0.0 : r->result.g[q];
  if (r->result.contact[q] != CONTACT_OPEN || !(g > 0.0))
    return r->result.contact[q] == CONTACT_SLIP;
  return cblas_dnrm2(dim - 1, r->now.rc + dim * q + 1, 1) >= (1.0 - FULL) * g;
}

void goal_take_line(double *d) {
  const double first = d[0], rise = d[GOAL_PIECES] - d[0];
  for (int k = 0; k <= GOAL_PIECES; ++k) d[k] -= first + rise * k / GOAL_PIECES;
}

void goal_point_of(int dim, const double *a, const double *b, const double *out,
                   int k, double *x) {
  const double at = (double)k / GOAL_PIECES;
  double chord = 0.0, height = 0.0;
  CLEAR(x, 3);
  for (int c = 0; c < dim; ++c) {
    x[c] = (1.0 - at) * a[c] + at * b[c];
    chord = hypot(chord, b[c] - a[c]);
    height = hypot(height, out[c]);
  }
  if (!(height > 0.0)) return;
  const double radius = 0.5 * height + chord * chord / (8.0 * height);
  const double off = (at - 0.5) * chord;
  const double below = off * off / (radius + sqrt(radius * radius - off * off));
  add_scaled(dim, 1.0 - below / height, out, x);
}

double goal_parabola(const double *d, double *rough) {
  enum { N = GOAL_PIECES };
  double sum = 0.0;
  *rough = 0.0;
  for (int k = 1; k < N; ++k) sum += (k % 2 == 1 ? 4.0 : 2.0) * d[k];
  const double middle = 0.5 * sum / N;
  for (int k = 1; k < N; ++k)
    *rough += 1.5 / N * fabs(d[k] - 4.0 * middle * k * (N - k) / (N * N));
  return middle;
}

/* Direction v[dim] of the traction of contact node q along its normal, or along
 * its slip; returns it, Pa. */
static double traction_of(const run *r, int q, int along, double *v) {
  const contact_surface *s = r->surface;
  const int dim = s->dim, first = along ? 1 : 0, last = along ? dim : 1;
  CLEAR(v, 3);
  for (int a = first; a < last; ++a) {
    const double part = r->now.rc[dim * q + a] / s->area[q];
    for (int c = 0; c < dim; ++c)
      v[c] += part * s->frame[dim * (dim * q + a) + c];
  }
  return goal_make_unit(dim, v);
}

/* v[2][dim] at the ends: v in the middle times the mean of y and "more" less
 * the mean of both at the ends; 0 where v turns by a right angle. */
static double product_between(int dim, double v[2][3], const double *ya,
                              const double *yb, const double *more) {
  double middle[3] = {0.0}, size = 0.0, sum = 0.0;
  for (int c = 0; c < dim; ++c) {
    middle[c] = 0.5 * (v[0][c] + v[1][c]);
    size = hypot(size, middle[c]);
  }
  if (!(size > 0.7)) return 0.0;
  for (int c = 0; c < dim; ++c)
    sum += middle[c] / size * (0.5 * (ya[c] + yb[c]) + more[c]) -
           0.5 * (v[0][c] * ya[c] + v[1][c] * yb[c]);
  return sum;
}

/* Length of an arc less that of its chord, over the integral of its bubble. */
static double longer(const mesh *m, const contact_edge *e) {
  double out = 0.0, chord = 0.0;
  for (int c = 0; c < m->dim; ++c) {
    out = hypot(out, e->out[c]);
    chord = hypot(chord, m->x[m->dim * e->b + c] - m->x[m->dim * e->a + c]);
  }
  return m->dim == 2 ? 4.0 * (out / chord) * (out / chord) : 0.0;
}

status goal_work_between(const run *r, const goal_surface *s, const double *y,
                         const double *z, const double *spin, double *turn,
                         double *area) {
  const int dim = r->msh->dim;
  *turn = *area = 0.0;
  OWNED_OF(int, where, goal_places(r, &where));
  for (EACH(const contact_edge, e, s->edge, s->n_edge)) {
    if (!e->closed || e->other[0] >= 0) continue;
    for (int along = 0; along < (e->stuck ? 1 : 2); ++along) {
      double v[2][3], more[3] = {0.0}, sum = 0.0;
      const double force = 0.5 * e->weight *
                           (traction_of(r, where[e->a], along, v[0]) +
                            traction_of(r, where[e->b], along, v[1]));
      if (along) cross(spin, e->out, more);
      *turn +=
          force * product_between(dim, v, y + dim * e->a, y + dim * e->b, more);
      const int is_given = along && r->problem.limit != NULL &&
                           r->problem.limit->g0[where[e->a]] > 0.0;
      for (int c = 0; c < dim && is_given; ++c)
        sum +=
            0.5 * (v[0][c] * z[dim * e->a + c] + v[1][c] * z[dim * e->b + c]);
      *area += force * longer(r->msh, e) * sum;
    }
  }
  return OK;
}

/* Opposed tractions of friction at the ends q[2] of an edge. */
static int turns_back(const run *r, const int *q) {
  double v[2][3];
  traction_of(r, q[0], 1, v[0]);
  traction_of(r, q[1], 1, v[1]);
  return dot(r->msh->dim, v[0], v[1]) < 0.0;
}

/* Of an edge whose nodes q[2] slip, its friction value a formula: by what that
 * is else than linear, along z; *rough, by what it is else than a parabola. */
static double value_of(const run *r, const contact_edge *e, const int *q,
                       const double *z, double *rough) {
  const int dim = r->msh->dim;
  const friction_rule *rule =
      friction_in_force(r->m, run_step_id(r), r->surface->contact_id[q[0]]);
  double d[GOAL_PIECES + 1], v[2][3], along = 0.0;
  *rough = 0.0;
  if (rule->law == NULL || (quantity_variables(&rule->card.value) & 7u) == 0)
    return 0.0;
  for (int k = 0; k <= GOAL_PIECES; ++k) {
    double x[3];
    goal_point_of(dim, r->surface->x + dim * q[0], r->surface->x + dim * q[1],
                  e->out, k, x);
    d[k] = quantity_value(&rule->card.value, x, r->now.t);
    if (!isfinite(d[k])) return 0.0;
  }
  const double traction =
      traction_of(r, q[0], 1, v[0]) + traction_of(r, q[1], 1, v[1]);
  const double value = d[0] + d[GOAL_PIECES];
  for (int c = 0; c < dim; ++c) v[0][c] += v[1][c];
  goal_make_unit(dim, v[0]);
  for (int c = 0; c < dim; ++c)
    along += 0.5 * v[0][c] * (z[dim * e->a + c] + z[dim * e->b + c]);
  if (!(value > 0.0)) return 0.0;
  along *= e->weight * traction / value;
  goal_take_line(d);
  const double part = along * goal_parabola(d, rough);
  *rough *= fabs(along);
  return part;
}

/* The slip of contact node q, m; 0: its friction is below the limit. */
static double slip_of(const run *r, int q) {
  const int n = r->msh->dim - 1;
  return goal_slides(r, q) ? cblas_dnrm2(n, r->result.slip + n * q, 1) : 0.0;
}

/* rise[q]: by how much the slip grows from node q to a neighbour, where it
 * falls to none; 0: it falls to one, which may have stopped or turned. */
static void find_rises(const run *r, const goal_surface *s, const int *where,
                       double *rise) {
  for (int q = 0; q < r->nodes.n; ++q) rise[q] = -1.0;
  for (EACH(const contact_edge, e, s->edge, s->n_edge)) {
    if (e->other[0] >= 0) continue;
    const int q[2] = {where[e->a], where[e->b]};
    const double more = slip_of(r, q[1]) - slip_of(r, q[0]);
    const int turned = turns_back(r, q);
    for (int k = 0; k < 2; ++k) {
      double *own = &rise[q[k]], by = k == 0 ? more : -more;
      *own = turned || by < 0.0 || *own == 0.0 ? 0.0 : fmax(*own, by);
    }
  }
}

/* 1: a closed node of a line in a plane of symmetry, which has no friction. */
static int is_in_plane(const run *r, int q) {
  return r->msh->dim == 2 && r->result.contact[q] != CONTACT_OPEN &&
         goal_is_mirrored(r, q);
}

/* 1: nodes q[2] of an edge slide, and one has the least slip of all round it,
 * so little that it may be zero next to it, as in a plane of symmetry. */
static int may_stop(const run *r, const int *q, const double *rise) {
  int halts = 0;
  for (int k = 0; k < 2; ++k) {
    const double slip = slip_of(r, q[k]);
    if (!(slip > 0.0) && !is_in_plane(r, q[k])) return 0;
    halts |= slip < HALT * rise[q[k]];
  }
  return halts;
}

/* 1: friction ends with the contact, ZONE=CONTACT, between nodes q[2]. */
static int leaves_zone(const run *r, const int *q) {
  const friction_limit *limit = r->problem.limit;
  const int open = r->result.contact[q[0]] == CONTACT_OPEN;
  return limit != NULL && limit->in_zone != NULL && limit->in_zone[q[0]] &&
         open != (r->result.contact[q[1]] == CONTACT_OPEN);
}

/* Of an edge within which friction turns back: the nodes have that in the
 * middle, and it may be at either end. So it may where the nodes stop: there
 * friction may be anything. Where it ends with the contact the nodes have half
 * of it, and it may reach all along or not. */
static double reversal_of(const run *r, const contact_edge *e, const int *q,
                          const double *rise, const double *z) {
  const int dim = r->msh->dim, turns = turns_back(r, q);
  double v[2][3], part = 0.0;
  if (!turns && !leaves_zone(r, q) && !may_stop(r, q, rise)) return 0.0;
  const double t[2] = {traction_of(r, q[0], 1, v[0]),
                       (turns ? -1.0 : 1.0) * traction_of(r, q[1], 1, v[1])};
  for (int c = 0; c < dim; ++c)
    part += 0.25 * (t[0] * v[0][c] + t[1] * v[1][c]) *
            (z[dim * e->a + c] + z[dim * e->b + c]);
  return fabs(part) * e->weight * (dim == 2 ? 1.5 : 1.0);
}

/* 1: both nodes q[2] of an edge slip on an obstacle. */
static int slips(const run *r, const contact_edge *e, const int *q) {
  return e->other[0] < 0 && goal_slides(r, q[0]) && goal_slides(r, q[1]);
}

status goal_value_between(const run *r, const goal_surface *s, const double *z,
                          double *sum) {
  *sum = 0.0;
  OWNED_OF(int, where, goal_places(r, &where));
  for (EACH(const contact_edge, e, s->edge, s->n_edge)) {
    const int q[2] = {where[e->a], where[e->b]};
    double rough;
    if (slips(r, e, q)) *sum += value_of(r, e, q, z, &rough);
  }
  return OK;
}

/* What an edge may lack: see goal_add_doubts. */
static double doubt_of(const run *r, const contact_edge *e, const int *q,
                       const double *rise, const double *z, const double *F) {
  const contact_surface *s = r->surface;
  const int dim = s->dim;
  double rough = 0.0;
  if (e->other[0] >= 0) return 0.0;
  if (slips(r, e, q)) value_of(r, e, q, z, &rough);
  for (int k = 0; k < 2 && e->closed; ++k)
    rough +=
        0.5 * e->weight * e->rough / s->area[q[k]] *
        fabs(dot(dim, s->frame + dim * dim * q[k], F + dim * s->node_id[q[k]]));
  return rough + (e->stuck ? 0.0 : reversal_of(r, e, q, rise, z));
}

status goal_add_doubts(const run *r, const goal_surface *s, const double *z,
                       const double *F, double *product, double *sum) {
  const mesh *m = r->msh;
  const int dim = m->dim;
  *sum = 0.0;
  OWNED_OF(int, where, goal_places(r, &where));
  OWNED_NEW(double, part, s->n_edge);
  OWNED_NEW(double, rise, r->nodes.n);
  find_rises(r, s, where, rise);
  for (int k = 0; k < s->n_edge; ++k) {
    const contact_edge *e = &s->edge[k];
    const int q[2] = {where[e->a], where[e->b]};
    part[k] = doubt_of(r, e, q, rise, z, F);
    *sum += part[k];
  }
  for (int k = 0; k < m->n_elem && product != NULL; ++k)
    for (int a = 0; a < dim; ++a)
      for (int b = a + 1; b <= dim; ++b) {
        const int *v = m->elem + (dim + 1) * k;
        if (where[v[a]] < 0 || where[v[b]] < 0) continue;
        const contact_edge *e = PAIR_FIND(s->edge, s->n_edge, v[a], v[b]);
        if (e != NULL) product[k] += part[e - s->edge];
      }
  return OK;
}
