/*
 * The domain integrals of fracture.h: elements, lips, and the length of front.
 */
#include "fracture/parts.h"

#include "base/base.h"

/* Size of the domains over the radius. In 3-D a domain is a tube, whose radius
 * and half length are the sides of a right angle. */
static const double domain_size[DOMAINS] = {1.0, 0.8, 0.6};
static const double tube_radius = 0.8, tube_length = 0.6;
/* r1 over r2. */
static const double inner_part = 0.5;
/* Contact tractions scatter within so many elements from the front, or in that
 * part of the radius if it is less: a line through the others up to "smooth"
 * elements away stands for them. */
static const double scattering = 4, scattering_part = 0.25, smooth = 16;
/* Distances that differ by less are equal, as of nodes of a regular mesh, -. */
static const double rounding = 1e-9;

typedef struct corner {
  double x[3];
  double q[DOMAINS], Q[DOMAINS][3]; /* virtual growth, global components */
  double traction[3];               /* in the frame of its place */
} corner;

/* Sums for a line over the distance behind the front. */
typedef struct trend {
  double n, x, xx, t[3], xt[3];
} trend;

typedef struct work {
  const fracture *f; /* after gather_elements */
  const mesh *m;
  const mesh_crack *crack;
  const fracture_state *state;
  const fracture_point *p;
  const elasticity *x;
  integrals *sum;
  double scatter; /* distance from the front in which tractions scatter, m */
  trend side[2];  /* of the lips below and above */
  /* The current element or face */
  int n, above; /* corners; 1: a lip with the body above it */
  corner at[4];
  double measure;
  double stress[3][3], slope[3][3]; /* and du_i/dx_l, global */
  double turn[3][3]; /* of the lips near the point, which slope is without */
} work;

/* ---- places and fields --------------------------------------------------- */

static void set_growth(const work *w, corner *c) {
  local at;
  locate(w->p, c->x, &at);
  const double r = hypot(at.x[0], at.x[1]);
  for (int k = 0; k < DOMAINS; ++k) {
    const double size = domain_size[k] * w->p->radius;
    const double outer = w->m->dim == 3 ? tube_radius * size : size;
    double q = fmin(1, (outer - r) / (outer * (1 - inner_part)));
    if (w->m->dim == 3) q *= fmax(0, 1 - fabs(at.s) / (tube_length * size));
    c->q[k] = q > rounding ? q : 0;
    for (int i = 0; i < 3; ++i) c->Q[k][i] = c->q[k] * at.axis[i];
  }
}

/* Corners with their growth; 0: it is zero at all. */
static int set_corners(work *w, int n, const int *node) {
  int grows = 0, near = 0;
  for (int k = 0; k < n; ++k) near |= w->f->node_seen[node[k]] == w->f->mark;
  if (!near) return 0;
  w->n = n;
  for (int k = 0; k < n; ++k) {
    place_of(w->m, node[k], w->at[k].x);
    set_growth(w, &w->at[k]);
    for (int i = 0; i < DOMAINS; ++i) grows |= w->at[k].q[i] > 0;
  }
  return grows;
}

/* Displacement gradient of an element; g: gradients of its P1 functions.
 * Returns its measure. */
static double set_slope(work *w, int elem, double g[12]) {
  const int dim = w->m->dim;
  const int *v = w->m->elem + (size_t)(dim + 1) * elem;
  const double determinant = mesh_elem_gradients(w->m, elem, g);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) w->slope[i][j] = -w->turn[i][j];
  for (int k = 0; k <= dim; ++k) {
    const double *u = w->state->u + (size_t)dim * v[k];
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j) w->slope[i][j] += u[i] * g[dim * k + j];
  }
  return determinant / (dim == 2 ? 2 : 6);
}

/* With the stress. */
static double set_fields(work *w, int elem, double g[12]) {
  static const int voigt[2][3][3] = {{{0, 3, -1}, {3, 1, -1}, {-1, -1, 2}},
                                     {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}}};
  const int dim = w->m->dim;
  const double *sigma = w->state->sigma + (size_t)(2 * dim) * elem;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int at = voigt[dim - 2][i][j];
      w->stress[i][j] = at < 0 ? 0 : sigma[at];
    }
  return set_slope(w, elem, g);
}

static void place_at(const work *w, const double *phi, local *at) {
  double x[3] = {0, 0, 0};
  for (int k = 0; k < w->n; ++k)
    for (int c = 0; c < 3; ++c) x[c] += phi[k] * w->at[k].x[c];
  locate(w->p, x, at);
}

/* Q of a domain in the frame of the place. */
static void growth_at(const work *w, const double *phi, const local *at,
                      int domain, double Q[3]) {
  double sum[3] = {0, 0, 0};
  for (int k = 0; k < w->n; ++k)
    for (int c = 0; c < 3; ++c) sum[c] += phi[k] * w->at[k].Q[domain][c];
  field_turn_vector(at, sum, Q);
}

static void growth_slope(const work *w, const double *g, const local *at,
                         int domain, field_tensor *out) {
  const int dim = w->m->dim;
  double sum[3][3] = {{0}};
  for (int k = 0; k <= dim; ++k)
    for (int l = 0; l < dim; ++l)
      for (int j = 0; j < dim; ++j)
        sum[l][j] += w->at[k].Q[domain][l] * g[dim * k + j];
  field_turn(at, sum, out);
}

/* Vector i of of[dim*n], in the frame of a place. */
static void turned_vector(const work *w, const double *of, int i,
                          const local *at, double to[3]) {
  const size_t dim = w->m->dim;
  double given[3] = {0, 0, 0};
  COPY(given, of + dim * i, dim);
  field_turn_vector(at, given, to);
}

/* (sig_ij X_ij,l + saux_ij,j u_i,l) Q_l */
static double lack(const field_tensor *s, const field_tensor *d,
                   const auxiliary *x, const double *Q) {
  double sum = field_product(s, &x->X) * Q[0];
  for (int l = 0; l < 3; ++l)
    for (int i = 0; i < 3; ++i) sum += x->div[i] * d->of[i][l] * Q[l];
  return sum;
}

/* -b_i d_i,l Q_l */
static double body_work(const double b[3], const field_tensor *d,
                        const double *Q) {
  double sum = 0;
  for (int i = 0; i < 3; ++i)
    for (int l = 0; l < 3; ++l) sum -= b[i] * d->of[i][l] * Q[l];
  return sum;
}

/* By the slope and by the stress at a place, of one domain, in its frame. */
static void add_integrand(const auxiliary *x, const field_tensor *grow,
                          const double *Q, double by_d[3][3],
                          double by_s[3][3]) {
  const double trace = grow->of[0][0] + grow->of[1][1] + grow->of[2][2];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 3; ++k) {
        by_d[i][j] += x->s.of[i][k] * grow->of[j][k];
        by_s[i][j] += x->d.of[i][k] * grow->of[k][j];
      }
      by_s[i][j] += x->X.of[i][j] * Q[0] - x->e.of[i][j] * trace;
      by_d[i][j] += x->div[i] * Q[j];
    }
}

/* To global components, out[dim*dim]. */
static void turn_back(const local *at, int dim, double by[3][3], double *out) {
  for (int b = 0; b < dim; ++b)
    for (int c = 0; c < dim; ++c) {
      out[dim * b + c] = 0;
      for (int i = 0; i < 3; ++i)
        for (int l = 0; l < 3; ++l)
          out[dim * b + c] +=
              at->axis[3 * i + b] * by[i][l] * at->axis[3 * l + c];
    }
}

/* ---- rotation of the body ------------------------------------------------ */

/*
 * A rotation of the whole body has no part in the integrals, but by their
 * quadrature: the slope of u is taken without that of the lips near the point.
 * It is the mean over both of du_2/dx_1, du_2/dx_3 and half of du_1/dx_3 less
 * du_3/dx_1, in which the fields of K and stresses along the lips have none.
 */

/* A lip that q of the largest domain is on: its part, m^dim, and its element;
 * -1: another lip. */
static int set_turning(work *w, int i, double *part) {
  const mesh_crack *c = w->crack;
  const int face = i < c->n ? c->plus[i] : c->minus[i - c->n];
  double normal[3];
  if (!set_corners(w, w->m->dim, w->m->face + w->m->dim * face)) return -1;
  *part = 0;
  for (int k = 0; k < w->n; ++k) *part += w->at[k].q[0];
  *part *= mesh_face_normal(w->m, face, normal);
  return w->m->face_elem[face];
}

static double all_turning(work *w) {
  double sum = 0, part;
  for (int i = 0; i < 2 * w->crack->n; ++i)
    if (set_turning(w, i, &part) >= 0) sum += part;
  return sum;
}

/* Rotation of a lip by the slope there, both in the frame of the point. */
static void turn_of(double d[3][3], double to[3][3]) {
  memset(to, 0, 9 * sizeof **to);
  to[1][0] = d[1][0];
  to[1][2] = d[1][2];
  to[0][2] = (d[0][2] - d[2][0]) / 2;
  to[0][1] = -to[1][0];
  to[2][1] = -to[1][2];
  to[2][0] = -to[0][2];
}

/* Its transpose. */
static void by_turn(double by[3][3], double to[3][3]) {
  memset(to, 0, 9 * sizeof **to);
  to[1][0] = by[1][0] - by[0][1];
  to[1][2] = by[1][2] - by[2][1];
  to[0][2] = (by[0][2] - by[2][0]) / 2;
  to[2][0] = -to[0][2];
}

/* A tensor t[dim*dim] in the frame of the point. */
static void to_frame(const work *w, const double *t, local *at,
                     field_tensor *out) {
  double in[3][3] = {{0}};
  for (int i = 0; i < w->m->dim; ++i)
    for (int j = 0; j < w->m->dim; ++j) in[i][j] = t[w->m->dim * i + j];
  locate(w->p, w->p->origin, at);
  field_turn(at, in, out);
}

static void find_turn(work *w) {
  const int dim = w->m->dim;
  const double all = all_turning(w);
  double mean[9] = {0}, turn[3][3], g[12], part;
  field_tensor own;
  local at;
  for (int i = 0; i < 2 * w->crack->n; ++i) {
    const int elem = set_turning(w, i, &part);
    if (elem < 0) continue;
    set_slope(w, elem, g);
    for (int k = 0; k < dim * dim; ++k)
      mean[k] += part / all * w->slope[k / dim][k % dim];
  }
  to_frame(w, mean, &at, &own);
  turn_of(own.of, turn);
  turn_back(&at, dim, turn, mean);
  for (int k = 0; k < dim * dim; ++k) w->turn[k / dim][k % dim] = mean[k];
}

/* Takes off by_u what by_slope[dim*dim], a derivative by the slope of all
 * elements, has by the rotation. */
static void derive_turn(work *w, const double *by_slope, double *by_u) {
  const int dim = w->m->dim;
  const double all = all_turning(w);
  double turned[3][3], by[9], g[12], part;
  field_tensor own;
  local at;
  to_frame(w, by_slope, &at, &own);
  by_turn(own.of, turned);
  turn_back(&at, dim, turned, by);
  for (int i = 0; i < 2 * w->crack->n; ++i) {
    const int elem = set_turning(w, i, &part);
    if (elem < 0) continue;
    const int *v = w->m->elem + (dim + 1) * elem;
    mesh_elem_gradients(w->m, elem, g);
    for (int a = 0; a <= dim; ++a)
      for (int k = 0; k < dim * dim; ++k)
        by_u[dim * v[a] + k / dim] -= part / all * by[k] * g[dim * a + k % dim];
  }
}

/* ---- elements ------------------------------------------------------------ */

/* The derivative of the integrand by du_i/dx_j, global, out[dim*dim], at a
 * place of the current element, where the stress is that of the slope. */
static void flux_at(const work *w, const double *phi, const double *g, int mode,
                    const double *part, double *out) {
  const double lambda = w->x->G * (3 - w->x->kappa) / (w->x->kappa - 1);
  double by_d[3][3] = {{0}}, by_s[3][3] = {{0}};
  auxiliary x;
  local at;
  place_at(w, phi, &at);
  auxiliary_set(w->x, &at, mode, &x);
  for (int k = 0; k < DOMAINS; ++k) {
    field_tensor grow;
    double Q[3];
    growth_at(w, phi, &at, k, Q);
    growth_slope(w, g, &at, k, &grow);
    for (int l = 0; l < 3; ++l) {
      Q[l] *= part[k];
      for (int j = 0; j < 3; ++j) grow.of[l][j] *= part[k];
    }
    add_integrand(&x, &grow, Q, by_d, by_s);
  }
  const double trace = by_s[0][0] + by_s[1][1] + by_s[2][2];
  for (int i = 0; i < 3; ++i) {
    by_d[i][i] += lambda * trace;
    for (int l = 0; l < 3; ++l)
      by_d[i][l] += w->x->G * (by_s[i][l] + by_s[l][i]);
  }
  turn_back(&at, w->m->dim, by_d, out);
}

/* The fields are constant in an element, and the auxiliary ones at its centroid
 * are as accurate. */
static const double centre[2][4] = {{1.0 / 3, 1.0 / 3, 1.0 / 3, 0},
                                    {0.25, 0.25, 0.25, 0.25}};
static void add_element(work *w, int elem) {
  const double *phi = centre[w->m->dim - 2];
  const int n = w->m->dim + 1;
  double g[12], Q[DOMAINS][3], b[3] = {0, 0, 0};
  field_tensor s, d, grow[DOMAINS], P;
  local at;
  if (!set_corners(w, n, w->m->elem + (size_t)n * elem)) return;
  w->measure = set_fields(w, elem, g);
  place_at(w, phi, &at);
  if (w->state->force != NULL) turned_vector(w, w->state->force, elem, &at, b);
  field_turn(&at, w->stress, &s);
  field_turn(&at, w->slope, &d);
  energy_flux(&s, &d, w->state->share, &P);
  for (int k = 0; k < DOMAINS; ++k) {
    growth_at(w, phi, &at, k, Q[k]);
    growth_slope(w, g, &at, k, &grow[k]);
    w->sum->I[k][MODES] +=
        w->measure * (field_product(&P, &grow[k]) + body_work(b, &d, Q[k]));
  }
  for (int mode = 0; mode < MODES && w->x->G > 0; ++mode) {
    auxiliary x;
    auxiliary_set(w->x, &at, mode, &x);
    interaction_flux(&s, &d, &x, &P);
    for (int k = 0; k < DOMAINS; ++k)
      w->sum->I[k][mode] +=
          w->measure * (field_product(&P, &grow[k]) + lack(&s, &d, &x, Q[k]) +
                        body_work(b, &x.d, Q[k]));
  }
}

/* Sums of derivatives by the slope over the elements, [dim*dim]. */
typedef struct by_slopes {
  double centre[9], flux[9]; /* at centroids, and at the points of flux */
} by_slopes;

/* Adds what an element has; 1: it has a part. */
static int derive_element(work *w, int elem, int mode, const double *part,
                          double *by_u, double *flux, by_slopes *sum) {
  const int dim = w->m->dim, *v = w->m->elem + (dim + 1) * elem;
  const double own = fracture_corner(dim);
  double g[12], slope[9];
  if (!set_corners(w, dim + 1, v)) return 0;
  const double measure = set_fields(w, elem, g);
  flux_at(w, centre[dim - 2], g, mode, part, slope);
  for (int k = 0; k < dim * dim; ++k) sum->centre[k] += measure * slope[k];
  for (int a = 0; a <= dim; ++a)
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j)
        by_u[dim * v[a] + i] += measure * slope[dim * i + j] * g[dim * a + j];
  for (int a = 0; a <= dim; ++a, flux += dim * dim) {
    double phi[4];
    for (int b = 0; b <= dim; ++b) phi[b] = (1 - own) / dim;
    phi[a] = own;
    flux_at(w, phi, g, mode, part, flux);
    for (int k = 0; k < dim * dim; ++k)
      sum->flux[k] += measure / (dim + 1) * flux[k];
  }
  return 1;
}

/* ---- lips ---------------------------------------------------------------- */

/* Corners of lip number i, the plus lips first, and on which side its body is;
 * returns its face id, -1: it is in no domain. */
static int set_lip(work *w, int i) {
  const mesh_crack *c = w->crack;
  const int face = i < c->n ? c->plus[i] : c->minus[i - c->n];
  double normal[3] = {0, 0, 0};
  if (!set_corners(w, w->m->dim, w->m->face + w->m->dim * face)) return -1;
  w->measure = mesh_face_normal(w->m, face, normal);
  w->above = dot(3, normal, w->p->frame + 3) < 0;
  return face;
}

static void add_to_trend(trend *to, double x, const double t[3]) {
  to->n += 1;
  to->x += x;
  to->xx += x * x;
  for (int c = 0; c < 3; ++c) {
    to->t[c] += t[c];
    to->xt[c] += x * t[c];
  }
}

/* 1: a line goes through the tractions at that distance behind the front. */
static int is_smooth(const work *w, double behind) {
  return behind >= w->scatter && behind <= (1 + rounding) * smooth * w->p->size;
}

/* Lines through the tractions that do not scatter, on each side. */
static void find_trends(work *w) {
  const int dim = w->m->dim;
  w->scatter = (1 - rounding) *
               fmin(scattering * w->p->size, scattering_part * w->p->radius);
  for (int i = 0; i < 2 * w->crack->n; ++i) {
    const int face = set_lip(w, i);
    for (int k = 0; k < dim && face >= 0; ++k) {
      local at;
      double t[3];
      locate(w->p, w->at[k].x, &at);
      if (!is_smooth(w, -at.x[0])) continue;
      turned_vector(w, w->state->traction, w->m->face[dim * face + k], &at, t);
      add_to_trend(&w->side[w->above], -at.x[0], t);
    }
  }
}

/* The line at x; the mean where the places do not spread enough for one. */
static void trend_at(const trend *of, double x, double scatter, double t[3]) {
  const double spread = of->n * of->xx - of->x * of->x;
  const int is_line = 4 * spread > of->n * of->n * scatter * scatter;
  for (int c = 0; c < 3; ++c) {
    const double slope =
        is_line ? (of->n * of->xt[c] - of->x * of->t[c]) / spread : 0;
    t[c] = (of->t[c] + slope * (of->n * x - of->x)) / of->n;
  }
}

/* Traction at a corner, given or from the line; returns how far it is behind
 * the front. */
static double set_traction(work *w, corner *c, int node) {
  const trend *of = &w->side[w->above];
  local at;
  locate(w->p, c->x, &at);
  const double behind = -at.x[0];
  if (behind < w->scatter && of->n > 0)
    trend_at(of, behind, w->scatter, c->traction);
  else
    turned_vector(w, w->state->traction, node, &at, c->traction);
  return behind;
}

static void place_on_lip(const work *w, const double *phi, local *at) {
  place_at(w, phi, at);
  at->x[0] = -fabs(at->x[0]);
  at->x[1] = w->above ? 0.0 : -0.0;
}

static void add_lip_point(work *w, const rule_point *point) {
  const double part = point->part * w->measure;
  double t[3] = {0, 0, 0}, Q[3];
  field_tensor d[MODES + 1] = {0};
  local at;
  place_on_lip(w, point->phi, &at);
  for (int k = 0; k < w->n; ++k)
    for (int c = 0; c < 3; ++c) t[c] += point->phi[k] * w->at[k].traction[c];
  for (int mode = 0; mode < MODES && w->x->G > 0; ++mode) {
    auxiliary x;
    auxiliary_set(w->x, &at, mode, &x);
    d[mode] = x.d;
  }
  field_turn(&at, w->slope, &d[MODES]);
  for (int k = 0; k < DOMAINS; ++k) {
    growth_at(w, point->phi, &at, k, Q);
    for (int mode = 0; mode <= MODES; ++mode)
      for (int i = 0; i < 3; ++i)
        for (int l = 0; l < 3; ++l)
          w->sum->I[k][mode] -= part * t[i] * d[mode].of[i][l] * Q[l];
  }
}

static void add_lips(work *w) {
  const mesh *m = w->m;
  find_trends(w);
  for (int i = 0; i < 2 * w->crack->n; ++i) {
    const int face = set_lip(w, i);
    double g[12], behind[3];
    rule_point rule[RULE_MOST];
    if (face < 0) continue;
    for (int k = 0; k < m->dim; ++k)
      behind[k] = set_traction(w, &w->at[k], m->face[m->dim * face + k]);
    set_fields(w, m->face_elem[face], g);
    const int n = lip_rule(m->dim - 1, behind, rule);
    for (int k = 0; k < n; ++k) add_lip_point(w, &rule[k]);
  }
}

/* ---- forces at nodes ----------------------------------------------------- */

/* Forces are rounding below that part of the stress over an element at the
 * front, their works below that of their largest, -. */
static const double no_force = 1e-6;

/* The mean slope of the elements round a node, *size their mean stress; returns
 * 1: they are above the crack. */
static int slope_round(work *w, int node, double mean[3][3], double *size) {
  const size_t *at = w->f->start + node;
  const int n = w->m->dim + 1;
  double sum = 0, height = 0, g[12];
  memset(mean, 0, 9 * sizeof **mean);
  *size = 0;
  for (size_t k = at[0]; k < at[1]; ++k) {
    const int elem = w->f->elem[k];
    const double measure = set_fields(w, elem, g);
    local c;
    set_corners(w, n, w->m->elem + (size_t)n * elem);
    place_at(w, centre[w->m->dim - 2], &c);
    sum += measure;
    height += measure * c.x[1];
    for (int i = 0; i < 9; ++i) {
      mean[i / 3][i % 3] += measure * w->slope[i / 3][i % 3];
      *size += measure * fabs(w->stress[i / 3][i % 3]);
    }
  }
  for (int i = 0; i < 9; ++i) mean[i / 3][i % 3] /= sum;
  *size /= sum;
  return height > 0;
}

/* -t_i d_il Q_l, 0: by rounding. */
static double force_work(const double t[3], const field_tensor *d,
                         const double *Q) {
  const double is = body_work(t, d, Q);
  const double most = dot(3, t, t) * field_product(d, d) * dot(3, Q, Q);
  return fabs(is) <= no_force * sqrt(most) ? 0 : is;
}

/* Of the force t[3] in the frame of a place. At the front it moves by symmetry
 * with the field of one mode alone, which is infinite there. The slope under it
 * is so too: where it works there is no energy release rate. */
static void add_force(work *w, const corner *c, const local *at,
                      const double t[3], const field_tensor *slope) {
  const int front = hypot(at->x[0], at->x[1]) <= rounding * w->p->size;
  const double most = no_force * sqrt(dot(3, t, t));
  double Q[DOMAINS][3];
  for (int k = 0; k < DOMAINS; ++k) {
    field_turn_vector(at, c->Q[k], Q[k]);
    if (fabs(force_work(t, slope, Q[k])) > 0) w->sum->I[k][MODES] = NAN;
  }
  for (int mode = 0; mode < MODES && w->x->G > 0; ++mode) {
    auxiliary x;
    const double none = front && mode < 2 && fabs(t[mode]) > most ? NAN : 0;
    if (!front) auxiliary_set(w->x, at, mode, &x);
    for (int k = 0; k < DOMAINS; ++k) {
      const double share = front ? none : force_work(t, &x.d, Q[k]);
      if (share != 0) w->sum->pointed |= 1u << mode;
      w->sum->I[k][mode] += share;
    }
  }
}

static void add_node(work *w, int node) {
  double mean[3][3], t[3], size;
  field_tensor slope;
  corner c;
  local at;
  const int above = slope_round(w, node, mean, &size);
  place_of(w->m, node, c.x);
  set_growth(w, &c);
  locate(w->p, c.x, &at);
  turned_vector(w, w->state->point, node, &at, t);
  field_turn(&at, mean, &slope);
  if (fabs(at.x[1]) <= rounding * hypot(at.x[0], at.x[1]))
    at.x[1] = above ? 0.0 : -0.0;
  size *= no_force * pow(w->p->size, w->m->dim - 1);
  if (c.q[0] > 0 && dot(3, t, t) > size * size)
    add_force(w, &c, &at, t, &slope);
}

static void add_nodes(work *w) {
  const int dim = w->m->dim;
  for (int i = 0; i < w->m->n_node; ++i)
    if (w->f->node_seen[i] == w->f->mark &&
        largest_entry(dim, w->state->point + dim * i) > 0)
      add_node(w, i);
}

/* ---- their derivative by tractions --------------------------------------- */

/* What a line takes: by the tractions that it is made of. */
typedef struct taken {
  double level[3], slope[3];
} taken;

/* Adds the force t[3] in the frame of a place to a node. */
static void add_turned(const work *w, const local *at, const double *t,
                       int node, double *by) {
  for (int c = 0; c < w->m->dim; ++c)
    for (int i = 0; i < 3; ++i)
      by[w->m->dim * node + c] += at->axis[3 * i + c] * t[i];
}

/* By the traction t[3] of a corner: add_lip_point transposed. */
static void corner_share(work *w, int own, int mode, const double *part, int n,
                         const rule_point *rule, double *t) {
  t[0] = t[1] = t[2] = 0;
  for (int p = 0; p < n; ++p) {
    const double size = rule[p].part * w->measure * rule[p].phi[own];
    auxiliary x;
    local at;
    place_on_lip(w, rule[p].phi, &at);
    auxiliary_set(w->x, &at, mode, &x);
    for (int k = 0; k < DOMAINS; ++k) {
      double Q[3];
      growth_at(w, rule[p].phi, &at, k, Q);
      for (int i = 0; i < 3; ++i)
        for (int l = 0; l < 3; ++l)
          t[i] -= part[k] * size * x.d.of[i][l] * Q[l];
    }
  }
}

/* A corner whose traction is given, or of a line: set_traction transposed. */
static void derive_corner(work *w, const corner *c, int node, const double *t,
                          taken *side, double *by) {
  const trend *of = &w->side[w->above];
  taken *to = &side[w->above];
  local at;
  locate(w->p, c->x, &at);
  const double behind = -at.x[0];
  if (!(behind < w->scatter && of->n > 0)) {
    add_turned(w, &at, t, node, by);
    return;
  }
  const double spread = of->n * of->xx - of->x * of->x;
  const int is_line = 4 * spread > of->n * of->n * w->scatter * w->scatter;
  for (int i = 0; i < 3; ++i) {
    to->level[i] += t[i] / of->n;
    if (is_line)
      to->slope[i] += t[i] * (of->n * behind - of->x) / (of->n * spread);
  }
}

/* Those that lines are made of: find_trends transposed. */
static void derive_trends(work *w, const taken *side, double *by) {
  const int dim = w->m->dim;
  for (int i = 0; i < 2 * w->crack->n; ++i) {
    const int face = set_lip(w, i);
    for (int k = 0; k < dim && face >= 0; ++k) {
      const trend *of = &w->side[w->above];
      const taken *from = &side[w->above];
      local at;
      double t[3];
      locate(w->p, w->at[k].x, &at);
      if (!is_smooth(w, -at.x[0])) continue;
      for (int c = 0; c < 3; ++c)
        t[c] = from->level[c] + from->slope[c] * (of->n * -at.x[0] - of->x);
      add_turned(w, &at, t, w->m->face[dim * face + k], by);
    }
  }
}

static void derive_lips(work *w, int mode, const double *part, double *by) {
  const mesh *m = w->m;
  taken side[2] = {{{0}, {0}}, {{0}, {0}}};
  find_trends(w);
  for (int i = 0; i < 2 * w->crack->n; ++i) {
    const int face = set_lip(w, i);
    double behind[3], t[3];
    rule_point rule[RULE_MOST];
    if (face < 0) continue;
    const int *v = m->face + m->dim * face;
    for (int k = 0; k < m->dim; ++k)
      behind[k] = set_traction(w, &w->at[k], v[k]);
    const int n = lip_rule(m->dim - 1, behind, rule);
    for (int k = 0; k < m->dim; ++k) {
      corner_share(w, k, mode, part, n, rule, t);
      derive_corner(w, &w->at[k], v[k], t, side, by);
    }
  }
  derive_trends(w, side, by);
}

/* ---- a point ------------------------------------------------------------- */

static int is_near(const fracture *f, int node, const fracture_point *p) {
  double x[3], square = 0;
  place_of(f->body.mesh, node, x);
  for (int k = 0; k < 3; ++k)
    square += (x[k] - p->origin[k]) * (x[k] - p->origin[k]);
  return square < p->radius * p->radius;
}

/* Nodes of an element that are new and near go to the list. */
static int list_nodes(fracture *f, int elem, const fracture_point *p, int n) {
  const mesh *m = f->body.mesh;
  const int *v = m->elem + (size_t)(m->dim + 1) * elem;
  for (int c = 0; c <= m->dim; ++c) {
    if (f->node_seen[v[c]] == f->mark || !is_near(f, v[c], p)) continue;
    f->node_seen[v[c]] = f->mark;
    f->node_list[n++] = v[c];
  }
  return n;
}

/* All elements with a node within the radius, from the point on. */
static int gather_elements(fracture *f, const fracture_point *p) {
  int n_elem = 0, n_node = 0;
  ++f->mark;
  f->node_list[n_node++] = p->node;
  f->node_seen[p->node] = f->mark;
  for (int i = 0; i < n_node; ++i) {
    const size_t *at = f->start + f->node_list[i];
    for (size_t k = at[0]; k < at[1]; ++k) {
      const int e = f->elem[k];
      if (f->elem_seen[e] == f->mark) continue;
      f->elem_seen[e] = f->mark;
      f->elem_list[n_elem++] = e;
      n_node = list_nodes(f, e, p, n_node);
    }
  }
  return n_elem;
}

/* int q ds over the edges of the front. */
static void measure_front(work *w, int n) {
  const mesh_crack *c = w->crack;
  for (int k = 0; k < DOMAINS; ++k) w->sum->length[k] = w->m->dim == 2;
  for (int i = 0; w->m->dim == 3 && i < n; ++i) {
    if (c->front_face[i] < 0 || !set_corners(w, 2, c->front_node + i)) continue;
    double square = 0;
    for (int k = 0; k < 3; ++k)
      square +=
          (w->at[1].x[k] - w->at[0].x[k]) * (w->at[1].x[k] - w->at[0].x[k]);
    for (int k = 0; k < DOMAINS; ++k)
      w->sum->length[k] += sqrt(square) * (w->at[0].q[k] + w->at[1].q[k]) / 2;
  }
}

void integrals_find(fracture *f, const fracture_state *s,
                    const fracture_point *p, const elasticity *x,
                    integrals *out) {
  work w = {
      .f = f, .m = f->body.mesh, .crack = &f->body.crack[p->crack], .p = p};
  memset(out, 0, sizeof *out);
  w.state = s;
  w.x = x;
  w.sum = out;
  const int n = gather_elements(f, p);
  find_turn(&w);
  for (int i = 0; i < n; ++i) add_element(&w, f->elem_list[i]);
  if (s->traction != NULL) add_lips(&w);
  if (s->point != NULL) add_nodes(&w);
  measure_front(&w, f->n);
}

status integrals_derive(fracture *f, const fracture_state *s,
                        const fracture_point *p, const elasticity *x, int mode,
                        const double *part, fracture_linear *out) {
  work w = {
      .f = f, .m = f->body.mesh, .crack = &f->body.crack[p->crack], .p = p};
  const int dim = w.m->dim;
  const size_t each = (dim + 1) * dim * dim;
  by_slopes sum = {{0}, {0}};
  w.state = s;
  w.x = x;
  const int n = gather_elements(f, p);
  find_turn(&w);
  PASS_NEW_ALL(OF(out->elem, n), OF(out->flux, each * n));
  for (int i = 0; i < n; ++i)
    if (derive_element(&w, f->elem_list[i], mode, part, out->by_u,
                       out->flux + each * out->n, &sum))
      out->elem[out->n++] = f->elem_list[i];
  derive_turn(&w, sum.centre, out->by_u);
  for (int k = 0; k < dim * dim; ++k)
    out->turned += sum.flux[k] * w.turn[k / dim][k % dim];
  if (s->traction != NULL) derive_lips(&w, mode, part, out->by_traction);
  return OK;
}
