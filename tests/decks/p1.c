/*
 * Linear elements of the test: volumes, strains, forces; and its judgement of
 * the body: temperatures, strains, stresses, equilibrium.
 */
#include "decks/judge.h"

#include "base/base.h"

int simplex_gauss(int n, double weight[GAUSS_MOST], double at[GAUSS_MOST][4]) {
  static const double x[3] = {0.11270166537925831, 0.5, 0.88729833462074169};
  static const double w[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
  int count = n == 2 ? 3 : n == 3 ? 9 : 27;
  double sum = 0;
  for (int k = 0; k < count; ++k) {
    double left = 1;
    weight[k] = 1;
    for (int c = 0, q = k; c < n - 1; ++c, q /= 3) {
      at[k][c] = left * x[q % 3];
      weight[k] *= w[q % 3] * left;
      left -= at[k][c];
    }
    at[k][n - 1] = left;
    sum += weight[k];
  }
  for (int k = 0; k < count; ++k) weight[k] /= sum;
  return count;
}

static const double *node_x(const solid *s, int node) {
  return s->x + s->dim * node;
}

void face_vector(const solid *s, int face, double v[3]) {
  const int *n = s->face + s->dim * face;
  const double *a = node_x(s, n[0]), *b = node_x(s, n[1]);
  if (s->dim == 2) {
    v[0] = b[1] - a[1];
    v[1] = a[0] - b[0];
    v[2] = 0;
    return;
  }
  const double *c = node_x(s, n[2]);
  for (int k = 0; k < 3; ++k) {
    int i = (k + 1) % 3, j = (k + 2) % 3;
    v[k] =
        0.5 * ((b[i] - a[i]) * (c[j] - a[j]) - (b[j] - a[j]) * (c[i] - a[i]));
  }
}

/* Thickness, or the circumference at a point of a face or element. */
static double depth(const random_deck *d, int n, const int *node,
                    const double *at) {
  double r = 0;
  if (d->kind < AXISYMMETRIC_) return d->thickness;
  if (d->kind == SOLID_) return 1;
  for (int a = 0; a < n; ++a) r += at[a] * node_x(&d->mesh, node[a])[0];
  return 2 * acos(-1.0) * r;
}

void face_shares(const random_deck *d, int face, double w[3]) {
  const solid *s = &d->mesh;
  const int *node = s->face + s->dim * face;
  double weight[GAUSS_MOST], at[GAUSS_MOST][4], v[3], size = 0;
  int n = simplex_gauss(s->dim, weight, at);
  face_vector(s, face, v);
  for (int c = 0; c < s->dim; ++c) size += v[c] * v[c];
  for (int a = 0; a < s->dim; ++a) w[a] = 0;
  for (int k = 0; k < n; ++k)
    for (int a = 0; a < s->dim; ++a)
      w[a] += sqrt(size) * weight[k] * at[k][a] * depth(d, s->dim, node, at[k]);
}

/* ---- elements ----------------------------------------------------------- */

typedef struct element {
  const int *node;
  double volume, grad[4][3], hoop; /* hoop: of each node, 1/length           */
} element;

/* Gradients by the inverse of the edges. */
static element element_of(const random_deck *d, int e) {
  const solid *s = &d->mesh;
  int dim = s->dim;
  element x = {.node = s->elem + (dim + 1) * e};
  double edge[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, det = 0;
  static const double centre[2][4] = {{1 / 3., 1 / 3., 1 / 3.},
                                      {0.25, 0.25, 0.25, 0.25}};
  for (int k = 0; k < dim; ++k)
    for (int c = 0; c < dim; ++c)
      edge[k][c] = node_x(s, x.node[k + 1])[c] - node_x(s, x.node[0])[c];
  for (int k = 0; k < 3; ++k)
    for (int c = 0; c < 3; ++c) {
      const double *p = edge[(k + 1) % 3], *q = edge[(k + 2) % 3];
      int i = (c + 1) % 3, j = (c + 2) % 3;
      double minor = p[i] * q[j] - p[j] * q[i];
      if (k == 0) det += edge[0][c] * minor;
      if (k < dim && c < dim) x.grad[k + 1][c] = minor;
    }
  for (int k = 1; k <= dim; ++k)
    for (int c = 0; c < dim; ++c) {
      x.grad[k][c] /= det;
      x.grad[0][c] -= x.grad[k][c];
    }
  x.volume =
      det / (dim == 2 ? 2 : 6) * depth(d, dim + 1, x.node, centre[dim - 2]);
  if (d->kind == AXISYMMETRIC_)
    for (int a = 0; a < 3; ++a) x.hoop += node_x(s, x.node[a])[0];
  if (x.hoop > 0) x.hoop = 1 / x.hoop;
  return x;
}

/* Voigt: xx yy zz xy yz zx with the double shears; axisymmetric rr zz tt rz. */
static void strain_of(const random_deck *d, const element *x, const double *u,
                      double e[6]) {
  int dim = d->mesh.dim;
  memset(e, 0, 6 * sizeof *e);
  for (int a = 0; a <= dim; ++a) {
    const double *v = u + dim * x->node[a], *g = x->grad[a];
    for (int c = 0; c < dim; ++c) e[c] += g[c] * v[c];
    e[3] += g[0] * v[1] + g[1] * v[0];
    if (dim == 2) e[2] += x->hoop * v[0];
    if (dim == 2) continue;
    e[4] += g[1] * v[2] + g[2] * v[1];
    e[5] += g[2] * v[0] + g[0] * v[2];
  }
}

static void add_forces(const random_deck *d, const element *x,
                       const double sigma[6], judged *j) {
  int dim = d->mesh.dim;
  for (int a = 0; a <= dim; ++a) {
    const double *g = x->grad[a];
    double f[3] = {g[0] * sigma[0] + g[1] * sigma[3],
                   g[1] * sigma[1] + g[0] * sigma[3], 0};
    if (dim == 2) f[0] += x->hoop * sigma[2];
    if (dim == 3) {
      f[0] += g[2] * sigma[5];
      f[1] += g[2] * sigma[4];
      f[2] = g[2] * sigma[2] + g[1] * sigma[4] + g[0] * sigma[5];
    }
    for (int c = 0; c < dim; ++c) {
      j->force[dim * x->node[a] + c] += x->volume * f[c];
      j->size[x->node[a]] += fabs(x->volume * f[c]);
    }
  }
}

/* ---- materials ---------------------------------------------------------- */

typedef struct moduli {
  double lambda, G, K;
} moduli;

/* Between the sets; a series of Prony may be given with its last moduli. */
static moduli moduli_at(const deck_material *m, double T) {
  double w = (T - m->at[0]) / (m->at[1] - m->at[0]), g = 1, k = 1;
  w = m->n_set < 2 || w < 0 ? 0 : w > 1 ? 1 : w;
  double E = (1 - w) * m->E[0] + w * m->E[1];
  double nu = (1 - w) * m->nu[0] + w * m->nu[1];
  for (int i = 0; m->law == VISCOELASTIC && i < m->n_term; ++i) {
    g -= m->term[i][0];
    k -= m->term[i][1];
  }
  moduli x = {.G = E / (2 + 2 * nu) / g, .K = E / (3 - 6 * nu) / k};
  x.lambda = x.K - 2 * x.G / 3;
  return x;
}

static double thermal_strain(const deck_material *m, double T, double T0) {
  return m->alpha * (T - m->zero) - m->alpha * (T0 - m->zero);
}

/* Temperature of an element by the cards. */
static double temperature_of(const judged *j, int e) {
  const random_deck *d = j->d;
  const solid *s = &d->mesh;
  deck_load all[LOADS * STEPS];
  int owner[LOADS * STEPS], per = s->dim + 1, g = s->elem_group[e];
  double T0 = d->warm[s->group[g].body], T = T0;
  int n = deck_loads(d, j->step, all, owner);
  for (int k = 0; k < n; ++k) {
    if (all[k].kind != HEAT || all[k].group != g) continue;
    T = 0;
    for (int a = 0; a < per; ++a) {
      int node = s->elem[per * e + a];
      double x[4] = {0, 0, 0, d->field[node]};
      memcpy(x, node_x(s, node), (size_t)s->dim * sizeof *x);
      T += deck_load_value(d, j->step, &all[k], x, j->now->t, T0) / per;
    }
  }
  return T;
}

/* ---- strains and stresses ----------------------------------------------- */

/* Columns of the components of an element; -1: not printed. */
typedef struct element_columns {
  int temperature, e[6], ei[6], sigma[6];
} element_columns;

static element_columns columns_of(const random_deck *d, const table *t) {
  static const char *const flat[] = {"xx", "yy", "zz", "xy", "yz", "zx"};
  static const char *const ring[] = {"rr", "zz", "tt", "rz", "", ""};
  element_columns c = {.temperature = table_column(t, "temperature")};
  for (int i = 0; i < 6; ++i) {
    char name[24];
    const char *part = (d->kind == AXISYMMETRIC_ ? ring : flat)[i];
    snprintf(name, sizeof name, "%s_%s", i < 3 ? "strain" : "gamma", part);
    c.e[i] = table_column(t, name);
    snprintf(name, sizeof name, "ei_%s", part);
    c.ei[i] = table_column(t, name);
    snprintf(name, sizeof name, "stress_%s", part);
    c.sigma[i] = table_column(t, name);
  }
  return c;
}

static void take(const table *t, int row, const int col[6], double v[6]) {
  for (int i = 0; i < 6; ++i) v[i] = col[i] < 0 ? 0 : table_at(t, row, col[i]);
}

static double largest(const double *v, int n) {
  double most = 0;
  for (int i = 0; i < n; ++i) most = fmax(most, fabs(v[i]));
  return most;
}

/* The stress of an elastic strain. */
static void stress_of(deck_kind kind, moduli m, const double e[6],
                      double sigma[6]) {
  double lambda = m.lambda, trace = e[0] + e[1] + e[2];
  if (kind == PLANE_STRESS_) {
    lambda = 2 * m.lambda * m.G / (m.lambda + 2 * m.G);
    trace = e[0] + e[1];
  }
  for (int i = 0; i < 6; ++i)
    sigma[i] = i < 3 ? lambda * trace + 2 * m.G * e[i] : m.G * e[i];
  if (kind == PLANE_STRESS_) sigma[2] = 0;
}

/* Leaves the deviator: of strains averaged over clusters nothing else is the
 * element's own. */
static void deviator(double v[6]) {
  double mean = (v[0] + v[1] + v[2]) / 3;
  for (int i = 0; i < 3; ++i) v[i] -= mean;
}

/* Scales of a table: the largest strain, inelastic strain, modulus. */
typedef struct body_scale {
  double e, K, growth, printed;
} body_scale;

static void judge_element(judged *j, const element_columns *c, int e, int row,
                          body_scale *s) {
  const random_deck *d = j->d;
  const table *t = &j->now->of[T_ELEMENTS];
  const deck_material *m = &d->material[d->material_of[d->mesh.elem_group[e]]];
  int averaged = d->averaged && d->kind != PLANE_STRESS_;
  double own[6], printed[6], ei[6], sigma[6], elastic[6], stress[6];
  double T = temperature_of(j, e);
  element x = element_of(d, e);
  if (c->temperature >= 0)
    judge_note(j->q, OF_TEMPERATURE, T - table_at(t, row, c->temperature),
               fabs(T) + 100, j->now, row);
  moduli E = moduli_at(m, T);
  strain_of(d, &x, j->u, own);
  take(t, row, c->e, printed);
  take(t, row, c->ei, ei);
  take(t, row, c->sigma, sigma);
  add_forces(d, &x, sigma, j);
  s->growth += x.volume * (own[0] + own[1] + own[2]);
  s->printed += x.volume * (printed[0] + printed[1] + printed[2]);
  double warm =
      thermal_strain(m, T, d->warm[d->mesh.group[d->mesh.elem_group[e]].body]);
  for (int i = 0; i < 6; ++i)
    elastic[i] = printed[i] - ei[i] - (i < 3 ? warm : 0);
  stress_of(d->kind, E, elastic, stress);
  double scale = fmax(E.K, E.G) * (s->e + largest(ei, 6) + fabs(warm));
  if (averaged) {
    deviator(own);
    deviator(printed);
    deviator(sigma);
    deviator(stress);
  }
  for (int i = 0; i < 6; ++i) {
    if (i == 2 && d->kind == PLANE_STRESS_) printed[2] = own[2];
    judge_note(j->q, OF_STRAIN, printed[i] - own[i], s->e, j->now, row);
    judge_note(j->q, OF_STRESS, sigma[i] - stress[i], scale, j->now, row);
  }
  for (int a = 0; a <= d->mesh.dim; ++a)
    for (int i = 0; i < d->mesh.dim; ++i)
      j->stiffness[x.node[a]] +=
          x.volume * (E.lambda + 2 * E.G) * x.grad[a][i] * x.grad[a][i];
}

/* The largest gradient of u that a table of strains can stem from. */
static double strain_scale(const judged *j, const element_columns *c) {
  const table *t = &j->now->of[T_ELEMENTS];
  double most = 0, v[6];
  for (int row = 0; row < t->n_row; ++row) {
    take(t, row, c->e, v);
    most = fmax(most, largest(v, 6));
  }
  return most + 1e-5 * largest(j->u, j->d->mesh.dim * j->d->mesh.n_node);
}

static void judge_elements(judged *j) {
  const solid *s = &j->d->mesh;
  const table *t = &j->now->of[T_ELEMENTS];
  element_columns c = columns_of(j->d, t);
  body_scale scale = {.e = strain_scale(j, &c)};
  int *row = table_rows(t, s->n_face + s->n_elem);
  double volume = 0;
  for (int e = 0; e < s->n_elem; ++e) {
    int at = row[s->n_face + e + 1];
    if (at < 0) {
      judge_note(j->q, OF_STRAIN, NAN, 1, j->now, e);
      continue;
    }
    judge_element(j, &c, e, at, &scale);
    volume += element_of(j->d, e).volume;
  }
  if (j->d->kind != PLANE_STRESS_)
    judge_note(j->q, OF_STRAIN, scale.growth - scale.printed, volume * scale.e,
               j->now, 0);
  free(row);
}

/* ---- loads and supports ------------------------------------------------- */

static double value_at(const judged *j, const deck_load *l, int node,
                       double from) {
  double x[4] = {0, 0, 0, 0};
  memcpy(x, node_x(&j->d->mesh, node), (size_t)j->d->mesh.dim * sizeof *x);
  return deck_load_value(j->d, j->step, l, x, j->now->t, from);
}

static void push(judged *j, int node, int c, double f) {
  j->force[j->d->mesh.dim * node + c] -= f;
  j->size[node] += fabs(f);
}

/* Integral of the load over a face or element of n nodes. */
static void add_load(judged *j, const deck_load *l, int n, const int *node,
                     double measure, const double direction[3]) {
  double weight[GAUSS_MOST], at[GAUSS_MOST][4], value[4];
  int count = simplex_gauss(n, weight, at);
  for (int a = 0; a < n; ++a) value[a] = value_at(j, l, node[a], 0);
  for (int k = 0; k < count; ++k) {
    double p = 0, w = measure * weight[k] * depth(j->d, n, node, at[k]);
    for (int a = 0; a < n; ++a) p += at[k][a] * value[a];
    for (int a = 0; a < n; ++a)
      for (int c = 0; c < j->d->mesh.dim; ++c)
        push(j, node[a], c, w * p * at[k][a] * direction[c]);
  }
}

static void load_face(judged *j, const deck_load *l, int f) {
  const solid *s = &j->d->mesh;
  double v[3], size = 0, direction[3] = {0, 0, 0};
  face_vector(s, f, v);
  for (int c = 0; c < s->dim; ++c) size += v[c] * v[c];
  size = sqrt(size);
  direction[l->component] = 1;
  for (int c = 0; c < s->dim && l->kind == PRESSURE; ++c)
    direction[c] = -v[c] / size;
  add_load(j, l, s->dim, s->face + s->dim * f, size, direction);
}

static void load_element(judged *j, const deck_load *l, int e) {
  const solid *s = &j->d->mesh;
  element x = element_of(j->d, e);
  double direction[3] = {0, 0, 0}, measure = 1;
  const double *centre = (const double[]){1 / 3., 1 / 3., 1 / 3., 0};
  if (s->dim == 3) centre = (const double[]){.25, .25, .25, .25};
  measure = x.volume / depth(j->d, s->dim + 1, x.node, centre);
  if (l->kind == GRAVITY) {
    double rho = j->d->material[j->d->material_of[l->group]].density;
    for (int c = 0; c < 3; ++c) direction[c] = rho * l->direction[c];
  } else {
    direction[l->component] = 1;
  }
  add_load(j, l, s->dim + 1, x.node, measure, direction);
}

static void judge_support(judged *j, const deck_load *l, int node,
                          unsigned char *fixed, double scale) {
  int dim = j->d->mesh.dim, c = l->component;
  double value = value_at(j, l, node, j->d->start[c]);
  fixed[dim * node + c] = 1;
  judge_note(j->q, OF_SUPPORT, j->u[dim * node + c] - value, scale, j->now,
             node + 1);
}

static void apply(judged *j, const deck_load *l, unsigned char *fixed,
                  double scale) {
  const solid *s = &j->d->mesh;
  for (int i = 0; i < s->n_node; ++i) {
    if ((l->kind != FIX && l->kind != POINT) || !solid_in(s, l->group, i))
      continue;
    if (l->kind == FIX)
      judge_support(j, l, i, fixed, scale);
    else
      push(j, i, l->component, value_at(j, l, i, 0));
  }
  for (int f = 0; f < s->n_face; ++f)
    if (s->face_group[f] == l->group &&
        (l->kind == PRESSURE || l->kind == TRACTION))
      load_face(j, l, f);
  for (int e = 0; e < s->n_elem; ++e)
    if (s->elem_group[e] == l->group &&
        (l->kind == BODY_FORCE || l->kind == GRAVITY))
      load_element(j, l, e);
}

/* ---- energies ----------------------------------------------------------- */

typedef struct energy_sums {
  double strain, internal, thermal, inelastic, scale;
} energy_sums;

static double power(const double sigma[6], const double e[6]) {
  double sum = 0;
  for (int i = 0; i < 6; ++i) sum += sigma[i] * e[i];
  return sum;
}

/* Strain, inelastic strain, thermal strain and stress of an element. */
typedef struct element_state {
  double e[6], ei[6], warm[6], sigma[6];
} element_state;

static element_state state_of(const judged *j, const snapshot *s, int e) {
  const random_deck *d = j->d;
  const table *t = &s->of[T_ELEMENTS];
  const deck_material *m = &d->material[d->material_of[d->mesh.elem_group[e]]];
  element_columns c = columns_of(d, t);
  element_state x = {.warm = {0}};
  int *row = table_rows(t, d->mesh.n_face + d->mesh.n_elem);
  const int at = row[d->mesh.n_face + e + 1];
  take(t, at, c.e, x.e);
  take(t, at, c.ei, x.ei);
  take(t, at, c.sigma, x.sigma);
  for (int i = 0; i < 3 && c.temperature >= 0; ++i)
    x.warm[i] =
        thermal_strain(m, table_at(t, at, c.temperature),
                       d->warm[d->mesh.group[d->mesh.elem_group[e]].body]);
  free(row);
  return x;
}

static void add_energy(const judged *j, int e, energy_sums *sum) {
  const double volume = element_of(j->d, e).volume;
  const element_state now = state_of(j, j->now, e),
                      old = state_of(j, j->before, e);
  double elastic[6], sigma[6], by[3][6];
  for (int i = 0; i < 6; ++i) {
    elastic[i] = now.e[i] - now.ei[i] - now.warm[i];
    sigma[i] = 0.5 * (now.sigma[i] + old.sigma[i]);
    by[0][i] = now.e[i] - old.e[i];
    by[1][i] = now.warm[i] - old.warm[i];
    by[2][i] = now.ei[i] - old.ei[i];
  }
  sum->strain += 0.5 * volume * power(now.sigma, elastic);
  sum->internal += volume * power(sigma, by[0]);
  sum->thermal += volume * power(sigma, by[1]);
  sum->inelastic += volume * power(sigma, by[2]);
  for (int i = 0; i < 6; ++i)
    sum->scale +=
        volume * (fabs(now.sigma[i]) + fabs(old.sigma[i])) *
        (fabs(now.e[i]) + fabs(old.e[i]) + fabs(now.ei[i]) + fabs(now.warm[i]));
}

/* A column of the energies, here and one increment before; 0: absent. */
static double energy_at(const snapshot *s, const char *name) {
  const int col = table_column(&s->of[T_ENERGY], name);
  return col < 0 ? 0 : table_at(&s->of[T_ENERGY], 0, col);
}

static double gain(const judged *j, const char *name) {
  return energy_at(j->now, name) - energy_at(j->before, name);
}

/* The energy of the elastic strains, and the works of an increment by the
 * stresses at its ends: that of the strains is what loads, supports and
 * contacts do. Averaged, the printed strains and stresses of an element are no
 * pair of one energy; moduli that change with the temperature do work too. */
static void judge_energy(judged *j) {
  energy_sums sum = {0};
  int warmed = 0; /* moduli that change with the temperature */
  if (j->before == NULL || (j->d->averaged && j->d->kind != PLANE_STRESS_))
    return;
  for (int k = 0; k < MATERIALS; ++k) warmed |= j->d->material[k].n_set > 1;
  for (int e = 0; e < j->d->mesh.n_elem; ++e) add_energy(j, e, &sum);
  const double off[] = {energy_at(j->now, "strain_energy") - sum.strain,
                        gain(j, "thermal_work") - sum.thermal,
                        gain(j, "inelastic_work") - sum.inelastic,
                        gain(j, "external_work") + gain(j, "normal_work") -
                            gain(j, "friction_work") - sum.internal,
                        gain(j, "energy_defect") + gain(j, "strain_energy") +
                            gain(j, "thermal_work") +
                            gain(j, "inelastic_work") - sum.internal};
  const double moved = largest(j->u, j->d->mesh.dim * j->d->mesh.n_node),
               scale = sum.scale + 1e-6 * LEAST_FORCE +
                       1e9 * fmax(j->residual, j->old_residual) *
                           (sum.scale + j->largest * moved);
  for (int k = 0; k < 5; ++k)
    if (k != 1 || !warmed)
      judge_note(j->q, OF_ENERGY, off[k], scale, j->now, k);
}

/* ---- equilibrium -------------------------------------------------------- */

/* The forces of a table whose columns begin at "first". */
static void take_forces(judged *j, const table *t, const char *first,
                        const unsigned char *only) {
  int dim = j->d->mesh.dim, at = table_column(t, first);
  for (int row = 0; row < t->n_row && at >= 0; ++row)
    for (int c = 0; c < dim; ++c) {
      int node = (int)table_at(t, row, 0) - 1;
      double f = table_at(t, row, at + c);
      if (only == NULL || only[dim * node + c]) push(j, node, c, f);
    }
}

void judge_body(judged *j) {
  const random_deck *d = j->d;
  int ring = d->kind == AXISYMMETRIC_, dim = d->mesh.dim, owner[LOADS * STEPS];
  size_t n = (size_t)(dim * d->mesh.n_node);
  deck_load all[LOADS * STEPS];
  unsigned char *fixed = calloc(n, 1);
  if (fixed == NULL) abort();
  judge_elements(j);
  int count = deck_loads(d, j->step, all, owner);
  double scale = largest(j->u, (int)n);
  for (int k = 0; k < count; ++k) apply(j, &all[k], fixed, scale + 1e-12);
  take_forces(j, &j->now->of[T_REACTIONS], ring ? "reaction_r" : "reaction_x",
              fixed);
  take_forces(j, &j->now->of[T_CONTACT], ring ? "f_r" : "f_x", NULL);
  /* what TOL=BALANCED leaves of an implicit increment */
  int loose = d->balanced && d->step[j->step].kind == IS_VISCO;
  double most = LEAST_FORCE + largest(j->size, d->mesh.n_node) +
                1e-6 * scale * largest(j->stiffness, d->mesh.n_node);
  j->largest = most;
  judge_energy(j);
  for (size_t k = 0; k < n; ++k)
    judge_note(j->q, OF_BALANCE, j->force[k],
               most * (1 + j->residual * 1e9) * (loose ? 1e7 : 1), j->now,
               (int)k / dim + 1);
  free(fixed);
}
