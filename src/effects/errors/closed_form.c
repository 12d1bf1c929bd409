/*
 * *REFERENCE: the true error of each increment against a closed form, in the
 * norms of the estimates.
 *
 * Integrals over the elements by Gauss-Legendre points of the unit cube, which
 * the map x = a, y = b (1 - a), z = c (1 - a)(1 - b) takes to the simplex.
 * Where the closed form has displacements alone, its strains are central
 * differences of fourth order over a small part of the element.
 */
#include "effects/plan/effect.h"

#include "material/voigt.h"
#include "run/column_row.h"

enum { MAX_NS = 6, RULE = 4 };
static const double PART = 1e-3; /* -, of the element, for differences */
/* Gauss-Legendre on [0, 1]. */
static const double rule_at[RULE] = {0.06943184420297371, 0.33000947820757187,
                                     0.66999052179242813, 0.93056815579702629};
static const double rule_weight[RULE] = {
    0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
    0.17392742256872693};

/* Squares of errors, and of the closed form. */
typedef struct squares {
  double energy, energy_all, u, u_all, stress, stress_all;
} squares;

typedef struct element_at_work {
  const closed_form *ref;
  const domain *d;
  const equilibrium *a;
  const double *stress; /* [ns*n_elem] of the solution, Pa; or NULL */
  const double *S;      /* [ns*ns] 1/Pa, inv(E) of its section */
  const double *E;      /* [ns*ns] Pa */
  int elem_id;
  double size;           /* m */
  const double *elastic; /* [ns] stress of all the strain of the solution, Pa */
  squares *sum;
} element_at_work;

static double product(int ns, const double *M, const double *t) {
  double sum = 0.0;
  for (int j = 0; j < ns; ++j)
    for (int i = 0; i < ns; ++i) sum += t[i] * M[i + ns * j] * t[j];
  return sum;
}

static const double *node_values(const element_at_work *e, int vertex) {
  const mesh *m = e->d->mesh;
  int node = m->elem[(m->dim + 1) * e->elem_id + vertex];
  return e->a->u + (size_t)m->dim * node;
}

/* Strains of the closed form at x, by differences of its displacements. */
static void exact_strain(const element_at_work *e, const double x[3],
                         double *strain) {
  int dim = e->d->mesh->dim;
  double grad[3][3] = {{0.0}}, h = PART * e->size;
  for (int c = 0; c < dim; ++c)
    for (int k = 0; k < dim; ++k) {
      double f[4];
      for (int i = 0; i < 4; ++i) {
        double at[3] = {x[0], x[1], x[2]};
        at[k] += (i < 2 ? i - 2 : i - 1) * h;
        f[i] = quantity_value(&e->ref->value[REFERENCE_U + c], at, e->a->t);
      }
      grad[c][k] = (8.0 * (f[2] - f[1]) - (f[3] - f[0])) / (12.0 * h);
    }
  CLEAR(strain, MAX_NS);
  strain[0] = grad[0][0];
  strain[1] = grad[1][1];
  strain[3] = grad[0][1] + grad[1][0];
  if (dim == 3) {
    strain[2] = grad[2][2];
    strain[4] = grad[1][2] + grad[2][1];
    strain[5] = grad[2][0] + grad[0][2];
  } else if (e->d->kin[e->d->section_id[e->elem_id]] == AXISYMMETRIC) {
    strain[2] = quantity_value(&e->ref->value[REFERENCE_U], x, e->a->t) / x[0];
  }
}

/* weight: measure of the part of the element that the point stands for. */
static void add_displacement(const element_at_work *e, const double x[3],
                             const double *shape, double weight) {
  int dim = e->d->mesh->dim;
  for (int c = 0; c < dim; ++c) {
    double exact = quantity_value(&e->ref->value[REFERENCE_U + c], x, e->a->t);
    double found = 0.0;
    for (int v = 0; v <= dim; ++v) found += shape[v] * node_values(e, v)[c];
    e->sum->u += weight * (found - exact) * (found - exact);
    e->sum->u_all += weight * exact * exact;
  }
}

/* Stresses, Pa. */
static void add_energy(const element_at_work *e, const double *found,
                       const double *exact, double weight) {
  const int ns = e->d->ns;
  double error[MAX_NS];
  vector_of(ns, exact, found, error);
  e->sum->energy += weight * product(ns, e->S, error);
  e->sum->energy_all += weight * product(ns, e->S, exact);
}

/* out[ns]: stresses "of" the element, and in axisymmetry what its hoop strain,
 * which is that of the centroid in them, is more at x. */
static void add_hoop(const element_at_work *e, const double *of,
                     const double x[3], const double *shape, double *out) {
  const domain *d = e->d;
  const cluster_set *c = d->cluster;
  double more = 0.0, r = 0.0, mean = 0.0, v[4];
  COPY(out, of, d->ns);
  if (d->kin[d->section_id[e->elem_id]] != AXISYMMETRIC) return;
  for (int a = 0; a < 3; ++a) {
    const double u_r = node_values(e, a)[0];
    more += shape[a] * u_r / x[0];
    mean += u_r / 3.0;
    r += d->mesh->x[2 * d->mesh->elem[3 * e->elem_id + a]] / 3.0;
  }
  more -= mean / r;
  const int cluster = c != NULL ? c->of[e->elem_id] : -1;
  cluster_hoop(cluster >= 0 ? c->share[cluster] : 0.0, v);
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) out[i] += more * e->E[i + 4 * j] * v[j];
}

static void add_stress(const element_at_work *e, const double x[3],
                       const double *shape, double weight) {
  const double *found = e->stress + (size_t)e->d->ns * e->elem_id;
  double exact[MAX_NS], at_x[MAX_NS];
  for (int i = 0; i < e->d->ns; ++i) {
    const quantity *q = &e->ref->value[REFERENCE_STRESS + i];
    exact[i] = quantity_value(q, x, e->a->t);
    double error = found[i] - exact[i];
    double twice = i < 3 ? weight : 2.0 * weight;
    e->sum->stress += twice * error * error;
    e->sum->stress_all += twice * exact[i] * exact[i];
  }
  add_hoop(e, found, x, shape, at_x);
  add_energy(e, at_x, exact, weight);
}

/* One point of the element: shape functions and share of the measure. */
static void add_point(const element_at_work *e, const double *shape,
                      double share) {
  const domain *d = e->d;
  const mesh *m = d->mesh;
  int id = d->section_id[e->elem_id], dim = m->dim;
  double x[3] = {0.0, 0.0, dim == 2 ? m->z : 0.0};
  for (int v = 0; v <= dim; ++v)
    for (int c = 0; c < dim; ++c)
      x[c] += shape[v] * m->x[dim * m->elem[(dim + 1) * e->elem_id + v] + c];
  double weight = share * mesh_elem_measure(m, e->elem_id);
  weight *=
      d->kin[id] == AXISYMMETRIC ? 2.0 * acos(-1.0) * x[0] : d->thickness[id];
  if (e->ref->has_u) add_displacement(e, x, shape, weight);
  if (e->ref->has_stress)
    add_stress(e, x, shape, weight);
  else if (e->ref->has_u) {
    /* The stresses that the strains of the closed form have without expansion
     * and inelastic strains; those of the solution likewise. */
    double strain[MAX_NS], exact[MAX_NS], at_x[MAX_NS];
    exact_strain(e, x, strain);
    voigt_product(e->d->ns, e->E, strain, exact);
    add_hoop(e, e->elastic, x, shape, at_x);
    add_energy(e, at_x, exact, weight);
  }
}

static void add_triangle(const element_at_work *e) {
  for (int i = 0; i < RULE; ++i)
    for (int j = 0; j < RULE; ++j) {
      double a = rule_at[i], b = rule_at[j] * (1.0 - a);
      double shape[3] = {1.0 - a - b, a, b};
      add_point(e, shape, 2.0 * rule_weight[i] * rule_weight[j] * (1.0 - a));
    }
}

static void add_tetrahedron(const element_at_work *e) {
  for (int i = 0; i < RULE; ++i)
    for (int j = 0; j < RULE; ++j)
      for (int k = 0; k < RULE; ++k) {
        double a = rule_at[i], b = rule_at[j] * (1.0 - a);
        double left = (1.0 - a) * (1.0 - rule_at[j]), c = rule_at[k] * left;
        double shape[4] = {1.0 - a - b - c, a, b, c};
        double share = 6.0 * rule_weight[i] * rule_weight[j] * rule_weight[k];
        add_point(e, shape, share * (1.0 - a) * left);
      }
}

static status sum_elements(const run *r, squares *sum) {
  const domain *d = &r->body.d;
  const int ns = d->ns, square = ns * ns;
  int n_section = 0;
  domain plain = *d;
  OWNED double *S = NULL, *elastic = NULL;
  element_at_work e = {.ref = &r->m->accuracy.ref,
                       .d = d,
                       .a = &r->now,
                       .stress = r->result.stress,
                       .sum = sum};
  for (int k = 0; k < d->mesh->n_elem; ++k)
    if (d->section_id[k] >= n_section) n_section = d->section_id[k] + 1;
  PASS_NEW(S, square * n_section);
  for (int i = 0; i < n_section; ++i)
    PASS(space_compliance(d, i, S + square * i));
  plain.eigen = NULL;
  PASS_NEW(elastic, (size_t)ns * d->mesh->n_elem);
  domain_stress(&plain, r->now.u, NULL, elastic);
  for (int k = 0; k < d->mesh->n_elem; ++k) {
    e.S = S + square * d->section_id[k];
    e.E = d->E + square * d->section_id[k];
    e.elem_id = k;
    e.elastic = elastic + (size_t)ns * k;
    e.size = pow(mesh_elem_measure(d->mesh, k), 1.0 / d->mesh->dim);
    if (d->mesh->dim == 2)
      add_triangle(&e);
    else
      add_tetrahedron(&e);
  }
  return OK;
}

/* |found - exact| over |exact|; without a closed form of that kind NAN. */
static double relative(int has, double square, double all) {
  if (!has) return NAN;
  return all > 0.0 ? sqrt(square / all) : square > 0.0 ? HUGE_VAL : 0.0;
}

static double pressure_error(const run *r) {
  const quantity *exact = &r->m->accuracy.ref.value[REFERENCE_PRESSURE];
  const contact_surface *s = r->body.d.surface;
  double sum = 0.0, all = 0.0;
  for (int i = 0; s != NULL && i < s->n; ++i) {
    double x[3] = {0.0, 0.0, 0.0};
    if (!(s->area[i] > 0.0)) continue;
    COPY(x, s->x + s->dim * i, s->dim);
    double p = quantity_value(exact, x, r->now.t);
    double error = -r->now.rc[s->dim * i] / s->area[i] - p;
    sum += s->area[i] * error * error;
    all += s->area[i] * p * p;
  }
  return relative(1, sum, all);
}

/* All parts of *REFERENCE into out->energy .. pressure. ERR_DECK: a value of
 * the closed form is not finite. */
static status find_error(const run *r, true_error *out) {
  const closed_form *ref = &r->m->accuracy.ref;
  squares sum = {0};
  out->pressure = NAN;
  if (ref->has_u || ref->has_stress) PASS(sum_elements(r, &sum));
  out->energy =
      relative(ref->has_u || ref->has_stress, sum.energy, sum.energy_all);
  out->displacement = relative(ref->has_u, sum.u, sum.u_all);
  out->stress = relative(ref->has_stress, sum.stress, sum.stress_all);
  if (ref->has_pressure) out->pressure = pressure_error(r);
  if (!isfinite(sum.energy + sum.u) ||
      (ref->has_pressure && isnan(out->pressure)))
    RAISE(ERR_DECK,
          "*REFERENCE: a value is not finite at time %g; an expression must be "
          "so at all points of the body (if(...) for singular ones)",
          r->now.t);
  return OK;
}

static int requires_reference(const model *m, const reason *why) {
  if (m->accuracy.ref.n == 0) return plan_says(0, why, "no *REFERENCE card");
  return plan_at(why, &m->accuracy.ref.at, "*REFERENCE");
}

/* Formulas at many points of each element. */
static effect_work expected(const plan_sizes *s) {
  return (effect_work){
      s->elements, "elements", s->increments,
      s->increments * s->elements * 600.0 * plan_element_work(s)};
}

static status exact_new(run *r, void **self) {
  ((true_error *)*self)->asked = 1;
  return OK;
}

static status find(run *r, void *self) {
  true_error *own = self;
  const double cpu = timer_cpu();
  const status st = find_error(r, own);
  own->cpu += timer_cpu() - cpu;
  if (st != ERR_DECK) return st;
  message_add(r->m->log, P2041, &r->m->accuracy.ref.at, "%s", status_message());
  RAISE(ERR_DECK, "%s:%d: %s", PLACE(r->m->accuracy.ref.at), status_message());
}

static void show(const void *own, state *s) {
  s->errors.exact = *(const true_error *)own;
}

static const true_error *exact_of(const view *v) {
  return effect_state(v->s->effects, &closed_form_effect);
}

VALUE(true_energy, 100 * exact_of(v)->energy)
VALUE(true_displacement, 100 * exact_of(v)->displacement)
VALUE(true_stress, 100 * exact_of(v)->stress)
VALUE(true_pressure, 100 * exact_of(v)->pressure)

/* clang-format off */
static const column columns[] = {
{"true_error", "%", INC, 0, ON(REFERENCE), ANY, "true_error", 0, true_energy,
 NULL, "error against *REFERENCE in that norm; NaN: it has no displacement and "
 "no stress"},
{"true_displacement_error", "%", INC, 0, ON(REFERENCE), ANY,
 "true_displacement_error", 0, true_displacement, NULL,
 "the same of the displacement in the L2 norm"},
{"true_stress_error", "%", INC, 0, ON(REFERENCE), ANY, "true_stress_error",
 0, true_stress, NULL, "the same of the stress in the L2 norm"},
{"true_pressure_error", "%", INC, 0, ON(REFERENCE), ANY,
 "true_pressure_error", 0, true_pressure, NULL,
 "the same of the contact pressure in the L2 norm"}};

const effect_ops closed_form_effect = {
  .name = "closed form", .bit = EFFECT_BIT_REFERENCE,
  .required = requires_reference, .expected = expected, .own = STAGE_REFERENCE,
  .size = sizeof(true_error),
  .on = {.create = exact_new, .accept = find, .show = show},
  COLUMNS_OF(columns)};
/* clang-format on */
