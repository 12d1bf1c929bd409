/*
 * Initial displacements from the deck (*INITIAL CONDITIONS, TYPE=DISPLACEMENT)
 * and from the end of an earlier run: mesh and last record of /fields in its
 * JOB.h5; whether they fit: the residual of (3.8) node by node, in N.
 */
#include "run/start/start.h"

#include "base/archive/dataset.h"
#include "base/base.h"

static const double SAME_PLACE = 1e-9; /* -, of the size of the mesh */

/* Items of a node in a dataset of n numbers: at least dim of them. */
static status width_of(const hdf5_source *s, const char *name, long n,
                       const mesh *msh, size_t *width) {
  *width = (size_t)n / (size_t)msh->n_node;
  if (n % msh->n_node != 0 || *width < (size_t)msh->dim)
    RAISE(
        ERR_DECK,
        "%s has another mesh: %s has %ld numbers, which does not fit %d nodes "
        "in %d-D",
        s->path, name, n, msh->n_node, msh->dim);
  return OK;
}

static status check_mesh(const hdf5_source *s, const mesh *msh) {
  static const char name[] = "/mesh/nodes";
  size_t width, dim = msh->dim;
  long n = 0;
  OWNED_OF(double, x, source_reals(s, name, 0, 3L * msh->n_node, &n, &x));
  PASS(width_of(s, name, n, msh, &width));
  for (size_t i = 0; i < (size_t)msh->n_node; ++i)
    for (size_t c = 0; c < width; ++c) {
      double here = c < dim ? msh->x[dim * i + c] : 0.0;
      if (fabs(x[width * i + c] - here) > SAME_PLACE * msh->size)
        RAISE(ERR_DECK,
              "%s has another mesh: node %zu is at %c = %.9g there and %.9g "
              "here",
              s->path, msh->node_no[i], "xyz"[c < 3 ? c : 2], x[width * i + c],
              here);
    }
  return OK;
}

static status read_last(const hdf5_source *s, const mesh *msh, double *u,
                        double *t) {
  OWNED double *time = NULL, *all = NULL;
  size_t width, dim = msh->dim;
  long n = 0, items = 0;
  PASS(source_reals(s, "/fields/time", 0, MOST_ITEMS, &n, &time));
  if (n < 1) RAISE(ERR_DECK, "%s has no record of fields", s->path);
  *t = time[n - 1];
  const char *name = text_of("/fields/u/%05ld", n);
  PASS(source_reals(s, name, 0, 3L * msh->n_node, &items, &all));
  PASS(width_of(s, name, items, msh, &width));
  for (size_t i = 0; i < (size_t)msh->n_node; ++i)
    for (size_t c = 0; c < dim; ++c) u[dim * i + c] = all[width * i + c];
  return OK;
}

/*
 * Displacements u[dim*n_node] (m) of the last record, its time *t (s). ERR_FILE
 * or ERR_DECK with an error in the log at "at": the file cannot be read, has no
 * record, was cut short, or has another mesh (nodes are compared in number and
 * place).
 */
static status end_state_read(const char *path, const mesh *msh, const place *at,
                             message_log *log, double *u, double *t) {
  status st = OK;
  hdf5_source s;
  TRY(dataset_open(path, &s));
  TRY(check_mesh(&s, msh));
  TRY(read_last(&s, msh, u, t));
done:
  dataset_close(&s);
  if (st == ERR_FILE || st == ERR_DECK)
    message_add(log, P5003, at, "%s", status_message());
  return st;
}

static status set_line(const model *m, const mesh *msh, const initial *line,
                       double *u) {
  const mesh_group *g = &msh->group[line->group_id];
  size_t dim = msh->dim;
  for (int k = 0; k < g->n_node; ++k) {
    size_t node = g->node_id[k];
    double x[3] = {0.0, 0.0, 0.0};
    COPY(x, msh->x + dim * node, dim);
    double value = quantity_value(&line->value, x, 0.0);
    u[dim * node + line->component] = value;
    if (isfinite(value)) continue;
    message_add(m->log, P2041, &line->at,
                "*INITIAL CONDITIONS: component %d is %g at node %zu (%g, %g, "
                "%g)",
                line->component + 1, value, msh->node_no[node], x[0], x[1],
                x[2]);
    RAISE(ERR_DECK, "an initial displacement is no number");
  }
  return OK;
}

status start_displacements(const model *m, const mesh *msh, double *u,
                           start_report *report) {
  const start_card *asked = &m->initial.start;
  if (asked->file != NULL) {
    PASS(end_state_read(asked->file, msh, &asked->file_at, m->log, u,
                        &report->source_time));
    report->source = asked->file_name;
  }
  for (int i = 0; i < m->n.initial; ++i)
    if (m->initial.lines[i].type == INITIAL_DISPLACEMENT)
      PASS(set_line(m, msh, &m->initial.lines[i], u));
  return OK;
}

/* A start from the end of another run contains its solver's tolerance; one from
 * expressions in equilibrium contains rounding. */
const double start_tolerance = 1e-6;

const char *defect_text(defect_kind kind) {
  static const char *const text[] = {
      "none", "not in equilibrium with the loads", "not at its support",
      "unilateral condition not met",
      "tangential force above the sliding limit"};
  return text[kind];
}

void start_stiffness(const domain *d, double *diagonal) {
  double B[6 * 12];
  int dim = d->mesh->dim, ns = d->ns, n_u = dim * (dim + 1);
  CLEAR(diagonal, (size_t)dim * d->mesh->n_node);
  for (int e = 0; e < d->mesh->n_elem; ++e) {
    const double *E = d->E + (size_t)(ns * ns) * d->section_id[e];
    double w = element_strain(d, e, B);
    for (int k = 0; k < n_u; ++k) {
      const double *b = B + ns * k;
      double sum = 0.0;
      for (int i = 0; i < ns; ++i)
        for (int j = 0; j < ns; ++j) sum += b[i] * E[i + ns * j] * b[j];
      int node = d->mesh->elem[(dim + 1) * e + k / dim];
      diagonal[dim * node + k % dim] += w * sum;
    }
  }
}

static void add_defect(start_report *report, int node_id, double size,
                       defect_kind kind) {
  if (!(size > report->defect[node_id])) return;
  report->defect[node_id] = size;
  report->kind[node_id] = (unsigned char)kind;
}

/* Remainder of K u - F at each component: free ones must have none. */
static void test_balance(const start_input *in, const double *rc,
                         double *reaction, start_report *report) {
  size_t n_dof = (size_t)in->mesh->dim * in->mesh->n_node;
  COPY(reaction, in->R, n_dof);
  if (in->surface != NULL) surface_spread(in->surface, -1.0, rc, reaction);
  if (in->ties != NULL) ties_share(in->ties, reaction);
  for (size_t k = 0; k < n_dof; ++k) {
    int node_id = (int)(k / in->mesh->dim);
    if (in->fixed[k]) {
      add_defect(report, node_id, in->stiffness[k] * fabs(in->u[k] - in->ud[k]),
                 DEFECT_SUPPORT);
      continue;
    }
    add_defect(report, node_id, fabs(reaction[k]), DEFECT_INTERIOR);
    reaction[k] = 0.0;
  }
}

/* max(r_n, c (u_n - gap)), or the distance to the given force. */
static double normal_defect(const start_input *in, const double *rc, int i) {
  const contact_problem *cp = in->cp;
  size_t k = (size_t)in->surface->dim * i;
  double c = contact_diagonal(cp, cp->dim * i);
  if (in->given != NULL && in->given[i] >= 0.0)
    return fabs(rc[k] + in->given[i]);
  return fabs(fmax(rc[k], c * (in->uc[k] - cp->gap[i])));
}

/* The same for the second obstacle of a corner. */
static double side_defect(const contact_problem *cp, const double *uc,
                          const double *rc, int i) {
  double worst = 0.0;
  for (int a = 1; a < cp->dim; ++a) {
    size_t k = cp->dim * i + a;
    double bound = cp->side_gap[(cp->dim - 1) * i + a - 1];
    double c = contact_diagonal(cp, (int)k), part = fabs(rc[k]);
    if (bound < HUGE_VAL) part = fabs(fmax(rc[k], c * (uc[k] - bound)));
    worst = fmax(worst, part);
  }
  return worst;
}

/* |r_t| - g where it is positive. */
static double sliding_defect(const start_input *in, const double *rc, int i) {
  int dim = in->surface->dim;
  double size = 0.0;
  for (int a = 1; a < dim; ++a) size = hypot(size, rc[dim * i + a]);
  return fmax(0.0, size - contact_node_limit(in->cp, rc, i));
}

static void test_contact(const start_input *in, const double *rc,
                         start_report *report) {
  const contact_problem *cp = in->cp;
  for (int i = 0; i < cp->n; ++i) {
    int node_id = in->surface->node_id[i];
    int corner = surface_is_corner(in->surface, i);
    add_defect(report, node_id, normal_defect(in, rc, i), DEFECT_NORMAL);
    if (corner && cp->side_gap != NULL)
      add_defect(report, node_id, side_defect(cp, in->uc, rc, i),
                 DEFECT_NORMAL);
    else
      add_defect(report, node_id, sliding_defect(in, rc, i), DEFECT_SLIDING);
  }
}

status start_test(const start_input *in, double *rc, double *reaction,
                  start_report *report) {
  if (in->surface != NULL) {
    /* Contact forces of the start: r = basis' (K u - F); a held unknown has
     * none, its force is the support's. */
    const contact_surface *s = in->surface;
    PASS(surface_forces(s, in->mesh->n_node, in->R, rc));
    for (int k = 0; k < s->dim * s->n; ++k)
      if (s->held[k]) rc[k] = 0.0;
  }
  test_balance(in, rc, reaction, report);
  if (in->surface != NULL) test_contact(in, rc, report);
  report->scale = in->load;
  for (int i = 0; i < in->mesh->n_node; ++i)
    if (report->defect[i] > report->worst) {
      report->worst = report->defect[i];
      report->node_id = i;
    }
  report->scale = fmax(report->scale, report->worst);
  report->ratio = report->scale > 0.0 ? report->worst / report->scale : 0.0;
  for (int i = 0; i < in->mesh->n_node; ++i)
    report->n_bad += report->defect[i] > start_tolerance * report->scale;
  return OK;
}
