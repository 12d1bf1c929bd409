/*
 * *WEAR: a body wears where it slides on an obstacle (Archard 1953): depth += k
 * p |slip|, after each increment from its pressure p and slip, and the gap is
 * opened by it from the next one on. At a corner each obstacle wears off along
 * its own normal, by the slip over it.
 *
 * This is Euler's method for the pressures: with A the stiffness of the normals
 * of the nodes and D = k |slip|/area, the wear of an increment reduces the
 * forces r by A D r, and their error is multiplied by I - A D: it changes its
 * sign once an eigenvalue of A D is above 1, and grows above 2, which is
 * refused.
 */
#include "effects/plan/effect.h"
#include "effects/shared.h"

#include "run/column_row.h"

/* depth[dim*n_node] of the mesh, along the normals of the rows of a contact
 * node, m; behind them 1 once wear beyond 1 is told. */

static int requires_wear(const model *m, const reason *why) {
  const effect_card *c = model_effect_card(m, "WEAR", -1);
  if (c == NULL) return plan_says(0, why, "no *WEAR card");
  return plan_at(why, &c->at, "*WEAR on contact %s",
                 m->contacts[c->contact_id].name);
}

static effect_work expected(const plan_sizes *s) {
  enum { PRODUCTS = 20 };
  const double n = s->contact;
  return (effect_work){n, "nodes", s->increments,
                       s->increments * PRODUCTS * n * n / PLAN_DENSE};
}

static size_t length_of(const run *r) {
  return (size_t)r->msh->dim * r->msh->n_node + 1;
}

/* Tributary area of that normal, m2. */
static double area_of(const contact_surface *s, int i, int a) {
  return a == 0 ? s->area[i] : s->side_area[(s->dim - 1) * i + a - 1];
}

static status open_gaps(run *r, void *self, double t) {
  const double *depth = self;
  const int dim = r->msh->dim;
  for (int i = 0; i < r->nodes.n; ++i)
    for (int a = 0; a < dim; ++a) {
      if (surface_normal_of(r->surface, i, a) < 0) continue;
      double *gap = a == 0 ? &r->problem.gap[i]
                           : &r->problem.side_gap[(dim - 1) * i + a - 1];
      *gap += depth[dim * r->surface->node_id[i] + a];
    }
  return OK;
}

/* Slip of the increment of a node over what its row a, a normal, meets, m;
 * rounding of the motion where it sticks. */
static double slip_of(const run *r, int i, int a) {
  const int dim = r->msh->dim;
  double sum = 0.0, v[3] = {0.0, 0.0, 0.0};
  if (surface_is_corner(r->surface, i))
    run_slide(r, i, a, 0, v);
  else
    for (int k = 1; k < dim; ++k) v[k] = run_motion_over(r, dim * i + k);
  for (int c = 0; c < dim; ++c) sum = hypot(sum, v[c]);
  return sum;
}

/* The largest eigenvalue of the symmetric root A root from below, of the roots
 * of D[m], the wear of a force in the rows of r->problem.cp, m/N. */
static status overshoot(const run *r, const double *D, double *largest) {
  enum { PRODUCTS = 20 };
  const int m = r->problem.cp.m;
  OWNED double *x = NULL, *y = NULL, *root = NULL;
  double norm = 0.0;
  PASS_NEW_REALS(m, &x, &y, &root);
  *largest = 0.0;
  for (int i = 0; i < m; ++i) norm = hypot(norm, y[i] = root[i] = sqrt(D[i]));
  for (int k = 0; k < PRODUCTS && norm > 0.0; ++k) {
    for (int i = 0; i < m; ++i) x[i] = root[i] * y[i] / norm;
    contact_apply(&r->problem.cp, x, y);
    norm = 0.0;
    for (int i = 0; i < m; ++i) norm = hypot(norm, y[i] *= root[i]);
    *largest = norm;
  }
  return OK;
}

static void tell(const run *r, const effect_card *c, double factor) {
  const double dt = r->now.t - r->old.t;
  const int whole = r->step->kind == STEP_STATIC;
  const int grows = factor > 2.0;
  char shorter[80] = "";
  if (dt > 0.0)
    snprintf(shorter, sizeof shorter, "give %sincrements of dt <= %.3g, or ",
             whole ? "*QUASISTATIC " : "", dt / factor);
  message_add(r->m->log, grows ? P2050 : P2051, &c->at,
              "step %d, time %g: the wear of an increment of dt = %g reduces "
              "the forces of a node by %.3g times their value, above %s: "
              "%slet what acts at once grow over the step",
              run_step_id(r) + 1, r->now.t, dt, factor,
              grows ? "2 they grow without bound" : "1 the wear overshoots",
              shorter);
}

/* D[dim*n] of the increment; the card of a node that wears. */
static const effect_card *find_wear(const run *r, double *D) {
  const contact_surface *s = r->surface;
  const effect_card *worn = NULL;
  for (int i = 0; i < r->nodes.n; ++i)
    for (int a = 0; a < r->msh->dim; ++a) {
      const int id = surface_normal_of(s, i, a), k = r->msh->dim * i + a;
      const effect_card *c =
          id < 0 ? NULL : model_effect_card(r->m, "WEAR", id);
      if (c == NULL || !(r->now.rc[k] < 0.0)) continue;
      if (!(area_of(s, i, a) > 0.0)) continue;
      D[k] = c->value[0] * slip_of(r, i, a) / area_of(s, i, a);
      worn = c;
    }
  return worn;
}

static void take_off(const run *r, const double *D, double *depth) {
  const int dim = r->msh->dim;
  for (int i = 0; i < r->nodes.n; ++i)
    for (int a = 0; a < dim; ++a)
      depth[dim * r->surface->node_id[i] + a] -=
          D[dim * i + a] * r->now.rc[dim * i + a];
}

/* An increment that did not converge, or goes on from one, may slip by
 * anything: it is not the wear that is refused, and none is taken. */
static status wear_off(run *r, void *self) {
  double *depth = self, factor = 0.0;
  OWNED_NEW(double, D, r->nodes.n_c);
  const effect_card *worn = find_wear(r, D);
  PASS(overshoot(r, run_rows(r, 0, D), &factor));
  double *told = &depth[length_of(r) - 1];
  const int solved = r->solving.report.outcome > 0 && r->course.unsettled == 0;
  if (factor > 2.0 && !solved) return OK;
  if (factor > 2.0 || (factor > 1.0 && *told == 0.0)) tell(r, worn, factor);
  if (factor > 2.0)
    RAISE(ERR_DECK, "%s:%d: the increment is not stable", PLACE(worn->at));
  if (factor > 1.0) *told = 1.0;
  take_off(r, D, depth);
  return OK;
}

double *wear_depths(const run *r, size_t *n) {
  *n = length_of(r);
  return effect_state(&r->effects, &wear_effect);
}

status wear_take(run *r, int *known) {
  OWNED_NEW(double, D, r->nodes.n_c);
  for (int i = 0; i < r->nodes.n; ++i)
    *known &= !surface_is_corner(r->surface, i);
  find_wear(r, D);
  take_off(r, D, effect_state(&r->effects, &wear_effect));
  return OK;
}

double wear_difference(const run *r, const double *depth) {
  const double *own = effect_state(&r->effects, &wear_effect);
  double sum = 0.0, whole = 0.0;
  for (int k = 0; k < r->msh->dim * r->nodes.n; ++k) {
    const int i = k / r->msh->dim, a = k % r->msh->dim;
    const int at = r->msh->dim * r->surface->node_id[i] + a;
    if (surface_normal_of(r->surface, i, a) < 0) continue;
    const double area = area_of(r->surface, i, a), less = depth[at] - own[at];
    sum += area * less * less;
    whole += area * own[at] * own[at];
  }
  return whole > 0.0 ? sqrt(sum / whole) : 0.0;
}

static status keep(run *r, void *self, archive *a) {
  return archive_reals(a, "depth", self, length_of(r));
}

/* Depth of row a of contact node i, m. */
static double depth_of(const view *v, int i, int a) {
  const double *depth = effect_state(v->s->effects, &wear_effect);
  return depth[v->s->contacts.surface->dim *
                   v->s->contacts.surface->node_id[i] +
               a];
}

/* Volume that node i has lost, to a contact or, < 0, to all, m3. */
static double volume_of(const view *v, int i, int contact_id) {
  const contact_surface *s = v->s->contacts.surface;
  double sum = 0.0;
  for (int a = 0; a < s->dim; ++a) {
    const int id = surface_normal_of(s, i, a);
    if (id >= 0 && (contact_id < 0 || id == contact_id))
      sum += area_of(s, i, a) * depth_of(v, i, a);
  }
  return sum;
}

static double contact_volume(const view *v, int id, int part) {
  double sum = 0.0;
  for (int i = 0; i < v->s->contacts.surface->n; ++i)
    sum += volume_of(v, i, id);
  return sum;
}

VALUE(wear_depth, depth_of(v, id, 0))
VALUE(wear_volume, volume_of(v, id, -1))

/* clang-format off */
static const column columns[] = {
{"depth", "length", PER_CONTACT_NODE, AS_REAL, PRINT_WEAR, C, SCENE_ALL,
 NEEDS_PLACE, "wear_depth", 0, wear_depth, NULL,
 "worn off so far along the normal; the gap is opened by it from the next "
 "increment on"},
{"volume", "length^3", PER_CONTACT_NODE, AS_REAL, PRINT_WEAR, C, SCENE_ALL,
 NEEDS_PLACE, NULL, 0, wear_volume, NULL,
 "the same times the tributary area"},
{"worn_volume", "length^3", PER_CONTACT, AS_REAL, PRINT_TOTALS, C, SCENE_ALL,
 NEEDS_TOTALS, "worn_volume", 0, contact_volume, NULL,
 "volume worn off so far"}};

const effect_ops wear_effect = {
  .name = "wear", .bit = NO_BIT, .required = requires_wear,
  .expected = expected, .table = {PRINT_WEAR, PER_CONTACT_NODE},
  .sums_up = 1,
  .size = sizeof(double), .count = length_of, .copy_as = COPY_IS_EQUAL,
  .on = {.pose = open_gaps, .accept = wear_off, .keep = keep},
  COLUMNS_OF(columns)};
/* clang-format on */
