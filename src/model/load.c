/*
 * Loads and prescribed displacements of a step at a time: nodal forces are
 * the exact integrals of data that is linear between the nodes (CPR98 2.5:
 * phi_1 in the body, phi_2 on Gamma_2).
 */
#include "base/base.h"
#include "model/model.h"

enum { MAX_NODE = 4 };

const char *load_card(const load *l) {
  static const char *const cards[] = {[LOAD_PRESSURE] = "DSLOAD",
                                      [LOAD_TRACTION] = "DSLOAD",
                                      [LOAD_BODY] = "DLOAD",
                                      [LOAD_GRAVITY] = "DLOAD",
                                      [LOAD_TEMPERATURE] = "TEMPERATURE",
                                      [LOAD_POINT] = "CLOAD",
                                      [LOAD_FIXING] = "BOUNDARY"};
  return cards[l->kind];
}

/* Time at which the value of a load of an earlier step counts. */
static double value_time(const load *l, double t) {
  return l->run == RUN_HELD ? l->before_t : t;
}

double step_end(const step *s) { return s->start + s->total; }

/* Share of its own value that a load has reached at t. */
static double share_at(const load *l, const step *s, double t) {
  if (l->run != RUN_RAMP || t >= step_end(s)) return 1.0;
  return (t - s->start) / s->total;
}

/* 0 where a value passes zero but for the rounding of t and of its terms: a
 * pressure of -1e-17 would lift a body. */
static double value_at(const quantity *q, const double x[3], double t) {
  static const double small = 16 * DBL_EPSILON, share = 0.25;
  const double v = quantity_value(q, x, t);
  if (v == 0.0 || !(quantity_variables(q) & 1u << TABLE_T)) return v;
  const double near = fmin(fabs(quantity_value(q, x, t * (1.0 - small))),
                           fabs(quantity_value(q, x, t * (1.0 + small))));
  return fabs(v) < share * near ? 0.0 : v;
}

double load_at_point(const load *l, const step *s, const double x[3],
                     double t) {
  const double now = value_at(&l->value, x, value_time(l, t));
  const double w = share_at(l, s, t);
  if (w >= 1.0) return now;
  double from = l->has_before ? value_at(&l->before, x, l->before_t) : 0.0;
  return (1.0 - w) * from + w * now;
}

static void node_position(const mesh *msh, int node, double x[3]) {
  x[2] = 0.0;
  for (int c = 0; c < msh->dim; ++c) x[c] = msh->x[(size_t)msh->dim * node + c];
}

double load_at_node(const load *l, const mesh *msh, const step *s, int node,
                    double t) {
  double x[3];
  node_position(msh, node, x);
  return load_at_point(l, s, x, t);
}

/* Report where a value is not finite. */
static void report_value(const model *m, const mesh *msh, const load *l,
                         double t, int node, double value) {
  double x[3];
  node_position(msh, node, x);
  message_add(m->log, P2041, &l->at,
              "the value on group %s is %s at node %zu (%g, %g, %g), time %g",
              l->group, isnan(value) ? "not a number" : "infinite",
              msh->node_no[node], x[0], x[1], x[2], t);
}

/* Value at a node, or the error that it is not finite. */
static status node_value(const model *m, const mesh *msh, const load *l,
                         const step *s, double t, int node, double *value) {
  *value = load_at_node(l, msh, s, node, t);
  if (isfinite(*value)) return OK;
  report_value(m, msh, l, t, node, *value);
  RAISE(ERR_DECK, "%s:%d: a value is not finite", l->at.file, l->at.line_no);
}

int load_finite(const model *m, const mesh *msh, const step *s, const load *l,
                double t) {
  const mesh_group *g = &msh->group[l->group_id];
  if (!quantity_variables(&l->value)) return 1;
  for (int k = 0; k < g->n_node; ++k) {
    double value = load_at_node(l, msh, s, g->node_id[k], t);
    if (isfinite(value)) continue;
    report_value(m, msh, l, t, g->node_id[k], value);
    return 0;
  }
  return 1;
}

/*
 * M_ij = integral of N_i N_j w over a simplex of n nodes and given measure;
 * w = 1, or the P1 function of the nodal values r (axisymmetric: 2 pi r).
 * Integral of a product of barycentric coordinates: d! a! b! c! / (a+b+c+d)!
 * times the measure, d = n - 1.
 */
static void simplex_mass(int n, double measure, const double *r, double *M) {
  double d2 = n * (n + 1), d3 = d2 * (n + 2);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      double sum = 0.0;
      if (r == NULL) {
        M[i + n * j] = measure * (i == j ? 2.0 : 1.0) / d2;
        continue;
      }
      for (int k = 0; k < n; ++k) {
        int same = (i == j) + (j == k) + (i == k);
        sum += r[k] * (same == 3 ? 6.0 : same == 1 ? 2.0 : 1.0);
      }
      M[i + n * j] = measure * sum / d3;
    }
}

/* A face or an element and the load on it. */
typedef struct patch {
  int n, node[MAX_NODE]; /* its nodes */
  double measure;        /* length^(n-1), thickness included */
  double direction[3];   /* force per measure over the value of the load */
} patch;

static status add_patch(const model *m, const mesh *msh, const load *l,
                        const step *s, double t, const patch *p, double *F) {
  double value[MAX_NODE], r[MAX_NODE], M[MAX_NODE * MAX_NODE];
  int axisymmetric = model_is_axisymmetric(m);
  for (int i = 0; i < p->n; ++i) {
    PASS(node_value(m, msh, l, s, t, p->node[i], &value[i]));
    r[i] = 2.0 * M_PI * msh->x[(size_t)msh->dim * p->node[i]];
  }
  simplex_mass(p->n, p->measure, axisymmetric ? r : NULL, M);
  for (int i = 0; i < p->n; ++i) {
    double force = 0.0;
    for (int j = 0; j < p->n; ++j) force += M[i + p->n * j] * value[j];
    double *Fi = F + (size_t)msh->dim * p->node[i];
    for (int c = 0; c < msh->dim; ++c) Fi[c] += force * p->direction[c];
  }
  return OK;
}

double model_thickness(const model *m, int elem_id) {
  return m->sections[m->elem_section[elem_id]].thickness;
}

static status add_faces(const model *m, const mesh *msh, const load *l,
                        const step *s, double t, double *F) {
  const mesh_group *g = &msh->group[l->group_id];
  for (int k = 0; k < g->n_item; ++k) {
    int face = g->item_id[k];
    double normal[3];
    patch p = {.n = msh->dim};
    COPY(p.node, msh->face + (size_t)msh->dim * face, msh->dim);
    p.measure = mesh_face_normal(msh, face, normal) *
                model_thickness(m, msh->face_elem[face]);
    for (int c = 0; c < msh->dim; ++c)
      p.direction[c] = l->kind == LOAD_PRESSURE ? -normal[c]
                       : c == l->component      ? 1.0
                                                : 0.0;
    PASS(add_patch(m, msh, l, s, t, &p, F));
  }
  return OK;
}

void load_per_value(const model *m, const load *l, int elem_id, double f[3]) {
  const section *sec = &m->sections[m->elem_section[elem_id]];
  for (int c = 0; c < 3; ++c)
    f[c] = l->kind == LOAD_GRAVITY
               ? m->materials[sec->material_id].density * l->direction[c]
               : c == l->component;
}

/* An element under a load on bodies. */
static patch body_patch(const model *m, const mesh *msh, const load *l, int e) {
  patch p = {.n = msh->dim + 1};
  COPY(p.node, msh->elem + (size_t)p.n * e, p.n);
  p.measure = mesh_elem_measure(msh, e) * model_thickness(m, e);
  load_per_value(m, l, e, p.direction);
  return p;
}

static status add_elements(const model *m, const mesh *msh, const load *l,
                           const step *s, double t, double *F) {
  const mesh_group *g = &msh->group[l->group_id];
  TIMED(STAGE_BODY);
  for (int k = 0; k < g->n_item; ++k) {
    const patch p = body_patch(m, msh, l, g->item_id[k]);
    PASS(add_patch(m, msh, l, s, t, &p, F));
  }
  return OK;
}

static int is_body(const load *l) {
  return l->kind == LOAD_BODY || l->kind == LOAD_GRAVITY;
}

int load_has_body(const model *m) {
  for (int i = 0; i < m->n.step; ++i)
    for (EACH(const load, l, m->steps[i].loads.item, m->steps[i].loads.n))
      if (is_body(l)) return 1;
  return 0;
}

status load_body(const model *m, const mesh *msh, const step *s, double t,
                 double *F, double *b) {
  const int dim = msh->dim;
  CLEAR(F, (size_t)dim * msh->n_node);
  CLEAR(b, (size_t)dim * msh->n_elem);
  for (EACH(const load, l, s->loads.item, s->loads.n)) {
    const mesh_group *g = &msh->group[l->group_id];
    if (!is_body(l)) continue;
    PASS(add_elements(m, msh, l, s, t, F));
    for (int k = 0; k < g->n_item; ++k) {
      const patch p = body_patch(m, msh, l, g->item_id[k]);
      double sum = 0.0;
      for (int i = 0; i < p.n; ++i)
        sum += load_at_node(l, msh, s, p.node[i], t) / p.n;
      for (int c = 0; c < dim; ++c)
        b[(size_t)dim * g->item_id[k] + c] += sum * p.direction[c];
    }
  }
  return OK;
}

static status add_points(const model *m, const mesh *msh, const load *l,
                         const step *s, double t, double *F) {
  const mesh_group *g = &msh->group[l->group_id];
  for (int k = 0; k < g->n_node; ++k) {
    double value;
    PASS(node_value(m, msh, l, s, t, g->node_id[k], &value));
    F[(size_t)msh->dim * g->node_id[k] + l->component] += value;
  }
  return OK;
}

status load_points(const model *m, const mesh *msh, const step *s, double t,
                   double *F) {
  CLEAR(F, (size_t)msh->dim * msh->n_node);
  for (EACH(const load, l, s->loads.item, s->loads.n))
    if (l->kind == LOAD_POINT) PASS(add_points(m, msh, l, s, t, F));
  return OK;
}

status load_forces(const model *m, const mesh *msh, const step *s, double t,
                   double *F) {
  CLEAR(F, (size_t)msh->dim * msh->n_node);
  for (EACH(const load, l, s->loads.item, s->loads.n)) {
    switch ((load_kind)l->kind) {
      case LOAD_PRESSURE:
      case LOAD_TRACTION:
        PASS(add_faces(m, msh, l, s, t, F));
        break;
      case LOAD_BODY:
      case LOAD_GRAVITY:
        PASS(add_elements(m, msh, l, s, t, F));
        break;
      case LOAD_POINT:
        PASS(add_points(m, msh, l, s, t, F));
        break;
      case LOAD_TEMPERATURE:
      case LOAD_FIXING:
        break;
    }
  }
  return OK;
}

status load_prescribed(const model *m, const mesh *msh, const step *s, double t,
                       const double *start, double *ud) {
  for (EACH(const load, l, s->loads.item, s->loads.n)) {
    if (l->kind != LOAD_FIXING) continue;
    const mesh_group *g = &msh->group[l->group_id];
    const double w = share_at(l, s, t);
    for (int k = 0; k < g->n_node; ++k) {
      double own;
      size_t dof = (size_t)msh->dim * g->node_id[k] + l->component;
      PASS(node_value(m, msh, l, s, l->run == RUN_RAMP ? step_end(s) : t,
                      g->node_id[k], &own));
      ud[dof] = w < 1.0 ? (1.0 - w) * start[dof] + w * own : own;
    }
  }
  return OK;
}

/* A quantity in an element times a nodal field times[n_node] if it is not NULL:
 * its value at the point of barycentric coordinates b[dim+1], with that of the
 * field, which is P1; b NULL: the mean of its nodes. */
static double elem_value(const quantity *q, const double *times,
                         const mesh *msh, int elem_id, const double *b,
                         double t) {
  const int n = msh->dim + 1, *v = msh->elem + n * elem_id;
  double sum = 0.0, x[3], at[3] = {0.0}, scale = 0.0;
  for (int a = 0; a < n; ++a) {
    const double factor = times != NULL ? times[v[a]] : 1.0;
    node_position(msh, v[a], x);
    if (b == NULL) sum += quantity_value(q, x, t) * factor / n;
    for (int c = 0; c < 3 && b != NULL; ++c) at[c] += b[a] * x[c];
    scale += b != NULL ? b[a] * factor : 0.0;
  }
  return b != NULL ? quantity_value(q, at, t) * scale : sum;
}

status load_initial(const model *m, const mesh *msh, const initial *c,
                    int elem_id, double *value) {
  *value = elem_value(&c->value, NULL, msh, elem_id, NULL, 0.0);
  if (isfinite(*value)) return OK;
  message_add(m->log, P2041, &c->at,
              "the initial value in element %zu is not a finite number",
              msh->elem_no[elem_id]);
  RAISE(ERR_DECK, "%s:%d: an initial value is not finite", c->at.file,
        c->at.line_no);
}

static status refuse_temperature(const model *m, const mesh *msh,
                                 const place *at, int elem_id) {
  message_add(m->log, P2041, at,
              "the temperature of element %zu is not a finite number",
              msh->elem_no[elem_id]);
  RAISE(ERR_DECK, "%s:%d: a temperature is not finite", at->file, at->line_no);
}

void load_temperature_initial_at(const model *m, const mesh *msh,
                                 const double *b, double *T) {
  CLEAR(T, msh->n_elem);
  for (EACH(const initial, c, m->initial.lines, m->n.initial)) {
    if (c->type != INITIAL_TEMPERATURE) continue;
    const mesh_group *g = &msh->group[c->group_id];
    for (int k = 0; k < g->n_item; ++k)
      T[g->item_id[k]] =
          elem_value(&c->value, NULL, msh, g->item_id[k], b, 0.0);
  }
}

status load_temperature_initial(const model *m, const mesh *msh, double *T) {
  CLEAR(T, msh->n_elem);
  for (EACH(const initial, c, m->initial.lines, m->n.initial)) {
    if (c->type != INITIAL_TEMPERATURE) continue;
    const mesh_group *g = &msh->group[c->group_id];
    for (int k = 0; k < g->n_item; ++k) {
      int e = g->item_id[k];
      PASS(load_initial(m, msh, c, e, &T[e]));
    }
  }
  return OK;
}

/* What a load gives an element; OP=NEW returns to the initial temperature. */
static double temperature_of(const load *l, const mesh *msh, double t,
                             int elem_id, const double *b, double T0) {
  if (l->removed) return T0;
  return elem_value(&l->value, l->field, msh, elem_id, b, value_time(l, t));
}

status load_temperature_at(const model *m, const mesh *msh, const step *s,
                           double t, const double *b, const double *T0,
                           double *T) {
  OWNED_NEW(double, start, msh->n_elem);
  memcpy(start, T0, msh->n_elem * sizeof *T);
  COPY(T, T0, msh->n_elem);
  if (s > m->steps && t < step_end(s))
    PASS(load_temperature_at(m, msh, s - 1, step_end(s - 1), b, T0, start));
  for (EACH(const load, l, s->loads.item, s->loads.n)) {
    if (l->kind != LOAD_TEMPERATURE) continue;
    const mesh_group *g = &msh->group[l->group_id];
    const double w = share_at(l, s, t);
    for (int k = 0; k < g->n_item; ++k) {
      int e = g->item_id[k];
      T[e] = (1.0 - w) * start[e] + w * temperature_of(l, msh, t, e, b, T0[e]);
      if (!isfinite(T[e]) && b == NULL)
        PASS(refuse_temperature(m, msh, &l->at, e));
    }
  }
  return OK;
}

status load_temperature(const model *m, const mesh *msh, const step *s,
                        double t, const double *T0, double *T) {
  return load_temperature_at(m, msh, s, t, NULL, T0, T);
}

static int same_table(const value_table *a, const value_table *b) {
  if (a->n != b->n || a->formula != b->formula) return 0;
  for (int k = 0; k < a->n; ++k)
    if (a->at[k] != b->at[k] || a->value[k] != b->value[k]) return 0;
  return 1;
}

static int same_expansion(const expansion *a, const expansion *b) {
  if (!a->given || !b->given) return a->given == b->given;
  if (a->type != b->type || a->zero != b->zero) return 0;
  for (int c = 0; c < 3; ++c)
    if (!same_table(&a->alpha[c], &b->alpha[c])) return 0;
  return 1;
}

/* The first section that expands as section i. */
static int first_expansion(const model *m, int i) {
  int k = 0;
  while (!same_expansion(&m->materials[m->sections[k].material_id].expand,
                         &m->materials[m->sections[i].material_id].expand))
    ++k;
  return k;
}

static int same_quantity(const quantity *a, const quantity *b) {
  return a->formula == b->formula && a->factor == b->factor &&
         (a->formula != NULL || a->number == b->number);
}

/* last[n_elem]: from 1 the cards of step s that an element has its temperature
 * from, those of equal numbers as one; 0: none. */
static void cards_of_step(const mesh *msh, const step *s, int *last) {
  CLEAR(last, msh->n_elem);
  for (int i = 0; i < s->loads.n; ++i) {
    const load *l = &s->loads.item[i];
    if (l->kind != LOAD_TEMPERATURE) continue;
    const mesh_group *g = &msh->group[l->group_id];
    int first = 0;
    for (; first < i; ++first) {
      const load *o = &s->loads.item[first];
      if (o->kind == l->kind && o->removed == l->removed &&
          o->field == l->field && o->run == l->run &&
          same_quantity(&o->value, &l->value))
        break;
    }
    for (int k = 0; k < g->n_item; ++k) last[g->item_id[k]] = first + 1;
  }
}

/* The same of the initial conditions. */
static void initial_cards(const model *m, const mesh *msh, int *last) {
  CLEAR(last, msh->n_elem);
  for (EACH(const initial, c, m->initial.lines, m->n.initial)) {
    if (c->type != INITIAL_TEMPERATURE) continue;
    const mesh_group *g = &msh->group[c->group_id];
    int first = 0;
    while (m->initial.lines[first].type != c->type ||
           !same_quantity(&m->initial.lines[first].value, &c->value))
      ++first;
    for (int k = 0; k < g->n_item; ++k) last[g->item_id[k]] = first + 1;
  }
}

/* zone[n] from 0 becomes that of the pair of it and by[n], below n_by. */
static status split_zones(int n, const int *by, int n_by, int *zone) {
  int n_zone = 0, n_new = 0;
  for (int k = 0; k < n; ++k)
    if (zone[k] >= n_zone) n_zone = zone[k] + 1;
  OWNED_NEW(int, of, ((size_t)n_zone * n_by));
  for (int k = 0; k < n; ++k) {
    int *at = &of[(size_t)n_by * zone[k] + by[k]];
    if (*at == 0) *at = ++n_new;
    zone[k] = *at - 1;
  }
  return OK;
}

status load_temperature_zones(const model *m, const mesh *msh, int *zone) {
  OWNED_NEW(int, by, msh->n_elem);
  CLEAR(zone, msh->n_elem);
  for (int k = 0; k < msh->n_elem; ++k)
    by[k] = first_expansion(m, m->elem_section[k]);
  PASS(split_zones(msh->n_elem, by, m->n.section, zone));
  initial_cards(m, msh, by);
  PASS(split_zones(msh->n_elem, by, m->n.initial + 1, zone));
  for (int i = 0; i < m->n.step; ++i) {
    cards_of_step(msh, &m->steps[i], by);
    PASS(split_zones(msh->n_elem, by, m->steps[i].loads.n + 1, zone));
  }
  return OK;
}

void load_fixed(const mesh *msh, const step *s, unsigned char *fixed) {
  memset(fixed, 0, (size_t)msh->dim * msh->n_node);
  for (EACH(const load, l, s->loads.item, s->loads.n)) {
    if (l->kind != LOAD_FIXING) continue;
    const mesh_group *g = &msh->group[l->group_id];
    for (int k = 0; k < g->n_node; ++k)
      fixed[(size_t)msh->dim * g->node_id[k] + l->component] = 1;
  }
}
