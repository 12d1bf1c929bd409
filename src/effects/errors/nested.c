/*
 * Contact problems that start from the solution on a coarser mesh: the states
 * of its nearest nodes, their tractions over the areas here, their slip. It is
 * a start alone: what the solver returns satisfies the equations of this mesh.
 *
 * The first increment of the run starts there, which else starts cold; another
 * one where fewer nodes were found in another state than on the coarser mesh at
 * the increment before than change their state there within this one.
 */
#include "effects/plan/effect.h"
#include "run/start/coarser.h"

typedef struct nested {
  double *u, *rc;          /* [n_c] m, N; NULL: none yet */
  contact_status *state;   /* [n] nearest on the coarser mesh */
  contact_status *before;  /* [n] the same at r->old */
  int *nearest;            /* [n] node of the coarser mesh */
  const coarser_state *of; /* of these; or NULL */
  int missed;              /* nodes in another state at r->old; -1: unknown */
} nested;

static void forget(run *r, void *self) {
  nested *x = self;
  r->solving.start_u = r->solving.start_r = NULL;
  RELEASE(x->u, x->rc, x->state, x->before, x->nearest);
  *x = (nested){.missed = -1};
}

static status nested_new(run *r, void **self) {
  ((nested *)*self)->missed = -1;
  return OK;
}

static status make_arrays(const run *r, nested *x) {
  if (x->u != NULL) return OK;
  PASS_NEW_REALS(r->nodes.n_c, &x->u, &x->rc);
  PASS_NEW_ALL(OF(x->state, r->nodes.n), OF(x->before, r->nodes.n),
               OF(x->nearest, r->nodes.n));
  return OK;
}

/* The states of an increment of the coarser mesh. */
static status match(const run *r, nested *x, const coarser_state *of) {
  PASS(make_arrays(r, x));
  if (of == x->of) return OK;
  PASS(coarser_match(of, r->surface, x->nearest));
  for (int i = 0; i < r->nodes.n; ++i)
    x->state[i] = coarser_contact(of, x->nearest[i]);
  x->of = of;
  return OK;
}

static int count_other(int n, const contact_status *a,
                       const contact_status *b) {
  int other = 0;
  for (int i = 0; i < n; ++i) other += a[i] != b[i];
  return other;
}

/* Node i starts as a node of the coarser mesh; forces and slip times "part". */
static void start_node(const run *r, nested *x, int i, double part) {
  const contact_surface *s = r->surface;
  const int dim = s->dim;
  const int *side = s->side_id + (dim - 1) * i;
  double *u = x->u + dim * i, *rc = x->rc + dim * i;
  coarser_node from;
  coarser_read(x->of, x->nearest[i], s, i, &from);
  u[0] = r->problem.gap[i] - from.gap;
  rc[0] = part * s->area[i] * from.traction[0];
  for (int a = 1; a < dim; ++a) {
    if (s->held[dim * i + a] || side[a - 1] >= 0) continue;
    rc[a] = part * s->area[i] * from.traction[a];
    if (r->problem.ut0 != NULL)
      u[a] = r->problem.ut0[(dim - 1) * i + a - 1] + part * from.slip[a - 1];
  }
}

/* 1: contact starts from x->of: nothing was in contact, or more nodes change
 * their state there than were found in another one. */
static int is_nearer(const run *r, const nested *x) {
  if (r->course.total_no == 0)
    return largest_entry(r->nodes.n_c, r->old.rc) == 0.0;
  return x->missed >= 0 &&
         count_other(r->nodes.n, x->before, x->state) > x->missed;
}

static status pose(run *r, void *self, double t) {
  nested *x = self;
  const coarser_state *of =
      coarser_at(r->m->accuracy.coarser, t, r->course.total_no == 0);
  if (r->course.shadow) return OK;
  r->solving.start_u = r->solving.start_r = NULL;
  if (of == NULL || !(t > 0.0)) return OK;
  PASS(match(r, x, of));
  if (!is_nearer(r, x)) return OK;
  COPY(x->u, r->old.uc, r->nodes.n_c);
  COPY(x->rc, r->old.rc, r->nodes.n_c);
  const double part = fmin(1.0, t / coarser_time(of));
  for (int i = 0; i < r->nodes.n; ++i)
    if (x->nearest[i] >= 0) start_node(r, x, i, part);
  r->solving.start_u = x->u;
  r->solving.start_r = x->rc;
  return OK;
}

static void note_start(run *r, const nested *x) {
  RUN_NOTE(r,
           "  started from the coarser mesh (%d contact node%s): %d of %d "
           "contact nodes end in another state\n",
           coarser_nodes(x->of), coarser_nodes(x->of) == 1 ? "" : "s",
           count_other(r->nodes.n, x->state, r->result.contact), r->nodes.n);
}

static status compare(run *r, void *self) {
  nested *x = self;
  const coarser_state *of = coarser_at(r->m->accuracy.coarser, r->now.t, 0);
  if (r->solving.start_u != NULL) note_start(r, x);
  x->missed = -1;
  if (of == NULL || r->nodes.n == 0) return OK;
  PASS(match(r, x, of));
  COPY(x->before, x->state, r->nodes.n);
  x->missed = count_other(r->nodes.n, x->before, r->result.contact);
  return OK;
}

static int requires_start(const model *m, const reason *why) {
  return m->accuracy.coarser != NULL;
}

/* clang-format off */
const effect_ops nested_effect = {
  .name = "nested start", .bit = NO_BIT, .required = requires_start,
  .own = STAGE_NONE, .size = sizeof(nested),
  .on = {.create = nested_new, .pose = pose, .accept = compare,
         .forget = forget}};
/* clang-format on */
