/*
 * The residual by which all solvers are checked, and the status of the nodes
 * (contact.h): natural map and equation, each node in the scale of the forces
 * and displacements of its own body.
 *
 * Products with the matrix run over blocks of CHUNK rows, so that nothing but
 * the search of the bodies allocates.
 */
#include "base/base.h"
#include "contact/parts.h"

#include <cblas.h>

/* ---- parts that the matrix of the problem does not join (contact.h) ------ */

static const double JOINED = 0x1p-30; /* -, entry over those of the diagonal */

/* Root of the largest diagonal entry of a node. */
static double root_of(const contact_problem *cp, int node_id) {
  double most = 0.0;
  for (int i = node_id * cp->dim; i < (node_id + 1) * cp->dim; ++i)
    most = fmax(most, contact_diagonal(cp, i));
  return sqrt(most);
}

/* 1: an entry of columns a and rows b is above "least"; a compliance from a
 * file may be unsymmetric. */
static int joined(const contact_problem *cp, int a, int b, double least) {
  for (int j = a * cp->dim; j < (a + 1) * cp->dim; ++j) {
    const double *column = contact_matrix(cp) + (size_t)j * cp->m;
    for (int i = b * cp->dim; i < (b + 1) * cp->dim; ++i)
      if (fabs(column[i]) > least) return 1;
  }
  return 0;
}

/* Bodies, each from one node on: list[n] holds the nodes found, then the
 * remaining ones. */
static void find_bodies(const contact_problem *cp, const double *root,
                        int *list, contact_bodies *b) {
  int found = 0;
  for (int i = 0; i < cp->n; ++i) list[i] = i;
  for (int next = 0; next < cp->n; ++next) {
    int a = list[next];
    if (next == found) {
      b->of[a] = b->n++;
      ++found;
    }
    for (int k = found; k < cp->n; ++k) {
      int other = list[k];
      const double least = JOINED * root[a] * root[other];
      if (!joined(cp, a, other, least) && !joined(cp, other, a, least))
        continue;
      b->of[other] = b->of[a];
      list[k] = list[found];
      list[found++] = other;
    }
  }
}

/* The same of sparse blocks, all at places that are joined. */
static void find_sparse_bodies(const contact_problem *cp, const double *root,
                               int *list, contact_bodies *b) {
  const sparse_blocks *W = cp->blocks;
  const size_t size = cp->dim * cp->dim;
  for (int i = 0; i < cp->n; ++i) b->of[i] = -1;
  for (int first = 0; first < cp->n; ++first) {
    int found = 0;
    if (b->of[first] >= 0) continue;
    b->of[first] = b->n;
    list[found++] = first;
    while (found > 0) {
      const int a = list[--found];
      for (int k = W->start[a]; k < W->start[a + 1]; ++k) {
        const int other = W->row[k];
        const double most =
            fmax(largest_entry(size, W->val + size * k),
                 largest_entry(size, W->val + size * W->mate[k]));
        if (b->of[other] >= 0 || !(most > JOINED * root[a] * root[other]))
          continue;
        b->of[other] = b->n;
        list[found++] = other;
      }
    }
    ++b->n;
  }
}

/* A node of an iterate; c, k, root follow from the matrix. */
typedef struct measured {
  node_step c;          /* N/m */
  double k;             /* the larger of c, N/m */
  double root;          /* of k, or of 1/k where the matrix is a compliance */
  double rounding;      /* what rounding can have put into a row, N */
  double drift;         /* the same, by motion not of the data, N */
  double normal, slide; /* scale along the normal, in the tangent plane, N */
  double q[3];          /* the nearest forces of an obstacle, N */
} measured;

enum { N_KEY = 4 }; /* see find_steps */

status contact_bodies_new(const contact_problem *cp, contact_bodies **out) {
  OWNED double *root = NULL;
  OWNED int *list = NULL;
  MAKES(contact_bodies, b, out);
  PASS_NEW(b->of, cp->n);
  if (cp->op != NULL) {
    b->n = cp->op->n_body;
    COPY(b->of, cp->op->body, cp->n);
  } else {
    PASS_NEW_ALL(OF(root, cp->n), OF(list, cp->n));
    for (int i = 0; i < cp->n; ++i) root[i] = root_of(cp, i);
    if (cp->blocks != NULL)
      find_sparse_bodies(cp, root, list, b);
    else
      find_bodies(cp, root, list, b);
  }
  PASS_NEW_ALL(OF(b->size, b->n), OF(b->bent, 2 * (size_t)cp->m),
               OF(b->node, cp->n), OF(b->matrix, N_KEY));
  return OK;
}

static const double ROUNDING = 0x1p-47; /* -, of the terms of a row */
static const double LEAST = 0x1p-37;    /* -, of them: scale */
static const double FLOOR = 0x1p-14;    /* -, of loads to come, of a fall */
static const double LEVER = 0x1p10;     /* -, motion over force/stiffness */
static const double STATUS_MARGIN = 0x1p-30; /* -, of the scale */

/* Of a constant dim, loops over it are unrolled. */
#define INLINED inline __attribute__((always_inline))

/* An iterate and the scales of its errors. */
typedef struct measure {
  const contact_problem *cp;
  int dim;      /* a constant where loops over it are to be unrolled */
  int is_stiff; /* contact_has_stiffness */
  const double *u, *r;
  double scale, largest; /* contact_scale; largest diagonal, where it is not in
                            what follows from the matrix */
  body_size one;         /* where no bodies are known */
  measured own;          /* a node where no bodies are known */
  const double *bent; /* [m] u without the rigid motions, m; NULL: not known */
} measure;

static INLINED body_size *body_at(measure *x, int body_id) {
  return x->cp->bodies == NULL ? &x->one : x->cp->bodies->size + body_id;
}

static INLINED body_size *body_of(measure *x, int node_id) {
  return body_at(x, x->cp->bodies == NULL ? 0 : x->cp->bodies->of[node_id]);
}

/* Position of stick along tangent k, m; 0 along the normal, k = 0. */
static INLINED double stick_of(const measure *x, int node_id, int k) {
  const double *stick = x->cp->ut0;
  if (k == 0 || stick == NULL) return 0.0;
  return stick[node_id * (x->dim - 1) + k - 1];
}

/* ---- natural map --------------------------------------------------------- */

static double pushing(double z) { return z < 0.0 || isnan(z) ? z : 0.0; }

/* Frictionless node: no force along a free tangent, unilateral where a second
 * obstacle bounds it. */
static INLINED void project_sides(const measure *x, int node_id, double c,
                                  double *q) {
  for (int k = 1; k < x->dim; ++k) {
    int dof = node_id * x->dim + k;
    double bound = contact_bound(x->cp, dof);
    if (bound < HUGE_VAL) q[k] = pushing(x->r[dof] - c * (x->u[dof] - bound));
  }
}

/* P_g(r_t - c (u_t - ut0)) in the directions friction acts in; its length. */
static INLINED double project_friction(const measure *x, int node_id, double c,
                                       double *q) {
  const double g = contact_node_limit(x->cp, x->r, node_id);
  if (g == 0.0) return 0.0;
  for (int k = 1; k < x->dim; ++k) {
    int dof = node_id * x->dim + k;
    if (!contact_held(x->cp, dof))
      q[k] = x->r[dof] - c * (x->u[dof] - stick_of(x, node_id, k));
  }
  double size = contact_length(x->dim - 1, q + 1);
  for (int k = 1; k < x->dim && !(size <= g); ++k) q[k] *= g / size;
  return smaller(size, g);
}

/* What follows from the matrix. */
static measured step_of(const contact_problem *cp, int node_id,
                        double largest) {
  const node_step c = contact_step(cp, node_id, largest);
  const double k = larger(c.n, c.t);
  const double root = sqrt(contact_has_stiffness(cp) ? k : 1.0 / k);
  return (measured){.c = c, .k = k, .root = root};
}

/* The steps of all nodes, where those found last are of another matrix; the
 * largest diagonal where no bodies are known. */
static double find_steps(const contact_problem *cp) {
  const contact_bodies *b = cp->bodies;
  const void *key[N_KEY] = {contact_matrix(cp), cp->op, cp->blocks, cp->held};
  if (b != NULL && memcmp(b->matrix, key, sizeof key) == 0) return 0.0;
  const double largest = contact_largest_diagonal(cp);
  if (b == NULL) return largest;
  memcpy(b->matrix, key, sizeof key);
  for (int i = 0; i < cp->n; ++i) b->node[i] = step_of(cp, i, largest);
  return 0.0;
}

/* The node in its place, its step known. */
static INLINED measured *node_of(measure *x, int node_id) {
  if (x->cp->bodies != NULL) return x->cp->bodies->node + node_id;
  x->own = step_of(x->cp, node_id, x->largest);
  return &x->own;
}

/* q of a node whose c is known; its length in the tangent plane. */
static INLINED double project(const measure *x, int node_id, measured *node) {
  int n = node_id * x->dim;
  node->q[1] = node->q[2] = 0.0;
  node->q[0] = pushing(x->r[n] - node->c.n * (x->u[n] - x->cp->gap[node_id]));
  if (!contact_has_side(x->cp, node_id))
    return project_friction(x, node_id, node->c.t, node->q);
  project_sides(x, node_id, node->c.t, node->q);
  return contact_length(x->dim - 1, node->q + 1);
}

/* ---- scale --------------------------------------------------------------- */

/* Of n > 0 numbers. */
static double largest_of(int n, const double *v) {
  double most = fabs(v[0]);
  for (int i = 1; i < n; ++i) most = larger(most, fabs(v[i]));
  return most;
}

/* Bound of the motion by loads, obstacles and where it was: displacements that
 * drift off and forces that grow without bound are no solution, however large
 * their rounding is. */
static INLINED void add_reach(const measure *x, int node_id,
                              const measured *node, body_size *b) {
  const contact_problem *cp = x->cp;
  double reach = x->scale;
  if (x->is_stiff) {
    reach = largest_of(x->dim, cp->f + node_id * x->dim);
    b->root = larger(b->root, node->root);
    b->position = larger(b->position, cp->moved);
  }
  for (int k = 0; k < x->dim && x->is_stiff; ++k) {
    const double bound = contact_bound(cp, node_id * x->dim + k);
    const double at = bound < HUGE_VAL ? bound : stick_of(x, node_id, k);
    b->position = larger(b->position, fabs(at));
  }
  b->reach = larger(b->reach, LEVER * reach / node->root);
}

/* Force of the load at a node that nothing else holds, N. */
static INLINED double load_of(const measure *x, int node_id,
                              const measured *node) {
  const contact_problem *cp = x->cp;
  const double *load = cp->f_load != NULL ? cp->f_load : cp->f;
  int first = node_id * x->dim;
  double most = 0.0;
  if (!x->is_stiff)
    return node->c.n * larger(0.0, cp->f[first] - cp->gap[node_id]);
  for (int k = 0; k < x->dim; ++k)
    if (!contact_held(cp, first + k))
      most = larger(most, fabs(load[first + k]));
  return most;
}

/* u without the rigid motions, NULL: not known. */
static const double *find_bent(const contact_problem *cp, const double *u) {
  const int m = cp->m, k = cp->n_motion;
  if (k == 0 || cp->bodies == NULL) return NULL;
  double *bent = cp->bodies->bent, *part = bent + m;
  COPY(bent, u, m);
  cblas_dgemv(CblasColMajor, CblasTrans, m, k, 1.0, cp->motion, m, u, 1, 0.0,
              part, 1);
  cblas_dgemv(CblasColMajor, CblasNoTrans, m, k, -1.0, cp->motion, m, part, 1,
              1.0, bent, 1);
  return bent;
}

/* What bounds the rounding of a body. */
static INLINED void add_motion(const measure *x, int node_id,
                               const measured *node, body_size *b) {
  const int dim = x->dim, first = node_id * dim;
  const double *v = (x->is_stiff ? x->u : x->r) + first, root = node->root;
  b->carried = larger(b->carried, root * largest_of(dim, v));
  if (x->bent != NULL)
    b->bent = larger(b->bent, root * largest_of(dim, x->bent + first));
  if (b->reach < HUGE_VAL) add_reach(x, node_id, node, b);
}

static INLINED void add_forces(const measure *x, int node_id, measured *node,
                               body_size *b) {
  const int n = node_id * x->dim;
  const double tangential = project(x, node_id, node);
  const double force = larger(fabs(node->q[0]), tangential);
  const double load = load_of(x, node_id, node);
  b->contact = larger(b->contact, force);
  b->load = larger(b->load, load);
  b->displacement = larger(b->displacement, larger(force, load) / node->k);
  double moved = smaller(fabs(x->u[n]), fabs(x->cp->gap[node_id]));
  b->fallen = larger(b->fallen, node->c.n * moved);
}

/* Forces of the bodies, once those of their nodes are known. */
static INLINED void end_forces(measure *x, int n_body) {
  double most = 0.0;
  for (int b = 0; b < n_body; ++b) {
    body_size *s = body_at(x, b);
    s->forces = larger(s->load, s->contact);
    most = larger(most, s->forces);
  }
  for (int b = 0; b < n_body && x->is_stiff; ++b) {
    body_size *s = body_at(x, b);
    double to_come = x->cp->load;
    if (most > 0.0) to_come = s->forces / most * to_come;
    s->least = FLOOR * larger(to_come, s->fallen);
  }
}

/* What errors are compared with; without "forces" their roundings alone. */
static INLINED void measure_part(measure *x, int forces) {
  const contact_problem *cp = x->cp;
  const int n_body = cp->bodies == NULL ? 1 : cp->bodies->n;
  x->is_stiff = contact_has_stiffness(cp);
  x->largest = find_steps(cp);
  x->bent = find_bent(cp, x->u);
  for (int b = 0; b < n_body; ++b)
    *body_at(x, b) =
        (body_size){.reach = x->is_stiff && !cp->floating ? HUGE_VAL : 0.0};
  for (int i = 0; i < cp->n; ++i) {
    body_size *b = body_of(x, i);
    measured *node = node_of(x, i);
    add_motion(x, i, node, b);
    if (forces) add_forces(x, i, node, b);
  }
  for (int b = 0; b < n_body; ++b) {
    body_size *s = body_at(x, b);
    s->reach = larger(s->reach, 2.0 * s->root * s->position) + s->bent;
    s->drift = s->carried > s->reach ? DBL_EPSILON * s->carried : 0.0;
    s->carried = smaller(s->carried, s->reach);
  }
  if (forces) end_forces(x, n_body);
}

/* Forces that a part of a node, of stiffness c, is compared with. */
static INLINED double forces_of(const measure *x, const measured *node,
                                const body_size *b, double c) {
  double most = x->is_stiff ? x->scale : c * x->scale;
  double own = smaller(b->forces, node->k * b->displacement);
  return smaller(most, own);
}

/* Scale of them: not below rounding. */
static INLINED double scale_of(const measure *x, const body_size *b,
                               const measured *node, double c) {
  const double least = larger(b->least, LEAST / ROUNDING * node->rounding);
  return larger(forces_of(x, node, b, c), least);
}

/* The node, its rounding and drift until the next one or the next iterate. */
static INLINED measured *round_node(measure *x, int node_id) {
  const body_size *b = body_of(x, node_id);
  measured *node = node_of(x, node_id);
  const int first = node_id * x->dim;
  double terms = largest_of(x->dim, x->cp->f + first), weight = node->root;
  if (!x->is_stiff) {
    terms = node->k * (terms + largest_of(x->dim, x->u + first));
    weight = 1.0 / weight;
  }
  node->rounding = ROUNDING * (terms + weight * b->carried);
  node->drift = weight * b->drift;
  return node;
}

static void measure_set(const contact_problem *cp, double scale,
                        const double *u, const double *r, measure *x) {
  *x = (measure){.cp = cp, .dim = cp->dim, .u = u, .r = r, .scale = scale};
  measure_part(x, 1);
  for (int i = 0; i < cp->n; ++i) {
    body_size *b = body_of(x, i);
    b->rounding = larger(b->rounding, round_node(x, i)->rounding);
  }
}

/* The same, and what is compared with it. */
static INLINED const measured *measure_node(measure *x, int node_id) {
  const body_size *b = body_of(x, node_id);
  measured *node = round_node(x, node_id);
  if (x->cp->bodies == NULL) project(x, node_id, node);
  node->normal = scale_of(x, b, node, node->c.n);
  node->slide = x->is_stiff ? node->normal : scale_of(x, b, node, node->c.t);
  return node;
}

/* An error over its scale, less that of rounding, or of a drift. */
static INLINED double beyond(const measured *node, double error, double scale) {
  double more = error <= node->rounding ? 0.0 : error - node->rounding;
  more = larger(more, node->drift);
  if (scale > 0.0 || isnan(scale)) return more / scale;
  return more > 0.0 ? HUGE_VAL : more;
}

/* ---- residual ------------------------------------------------------------ */

/* Residual of the natural map along the normal, in the tangent plane. */
static INLINED node_step map_errors(const measure *x, int node_id,
                                    const measured *node) {
  const double *r = x->r + node_id * x->dim;
  double e[3] = {0.0, 0.0, 0.0};
  for (int k = 0; k < x->dim; ++k) e[k] = r[k] - node->q[k];
  return (node_step){fabs(e[0]), contact_length(x->dim - 1, e + 1)};
}

static INLINED double map_of(const measure *x, int node_id,
                             const measured *node) {
  const node_step e = map_errors(x, node_id, node);
  if (x->is_stiff) return beyond(node, larger(e.n, e.t), node->normal);
  return larger(beyond(node, e.n, node->normal),
                beyond(node, e.t, node->slide));
}

/* d[dim]: defect of the equation at the node, N (m). */
static INLINED double equation_of(const measure *x, const measured *node,
                                  const double *d) {
  double worst = 0.0;
  for (int k = 0; k < x->dim; ++k) {
    double c = k == 0 ? node->c.n : node->c.t;
    double e = x->is_stiff ? fabs(d[k]) : c * fabs(d[k]);
    worst = larger(worst, beyond(node, e, k == 0 ? node->normal : node->slide));
  }
  return worst;
}

/* d[rows] = A u - f - r, or W r + q - u, from row "first"; A u of an operator
 * is in its place. */
static void equation_rows(const contact_problem *cp, const double *u,
                          const double *r, int first, int rows, double *d) {
  const double *M = contact_matrix(cp);
  const double *v = contact_has_stiffness(cp) ? u : r,
               *y = contact_has_stiffness(cp) ? r : u;
  double sign = contact_has_stiffness(cp) ? 1.0 : -1.0;
  for (int i = 0; i < rows; ++i) d[i] = y[first + i] + sign * cp->f[first + i];
  if (is_zero(cp->m, v)) {
    for (int i = 0; i < rows; ++i) d[i] = -d[i];
    return;
  }
  if (cp->op != NULL) {
    for (int i = 0; i < rows; ++i) d[i] = cp->op->workspace[first + i] - d[i];
    return;
  }
  if (cp->blocks != NULL) {
    for (int i = 0; i < rows; i += cp->dim) {
      double own[3];
      sparse_blocks_row(cp->blocks, (first + i) / cp->dim, v, own);
      for (int k = 0; k < cp->dim; ++k) d[i + k] = own[k] - d[i + k];
    }
    return;
  }
  cblas_dgemv(CblasColMajor, CblasNoTrans, rows, cp->m, 1.0, M + first, cp->m,
              v, 1, -1.0, d, 1);
}

static INLINED double residual_of(const contact_problem *cp, int dim,
                                  double scale, const double *u,
                                  const double *r) {
  measure x = {.cp = cp, .dim = dim, .u = u, .r = r, .scale = scale};
  double worst = 0.0, d[3 * CHUNK];
  measure_part(&x, 1);
  if (cp->op != NULL) contact_apply(cp, u, cp->op->workspace);
  for (int first = 0; first < cp->n; first += CHUNK) {
    int count = cp->n - first < CHUNK ? cp->n - first : CHUNK;
    equation_rows(cp, u, r, first * dim, count * dim, d);
    for (int i = 0; i < count; ++i) {
      const measured *node = measure_node(&x, first + i);
      worst = larger(worst, map_of(&x, first + i, node));
      worst = larger(worst, equation_of(&x, node, d + i * dim));
    }
  }
  return isnan(scale) ? NAN : worst;
}

double contact_residual_at(const contact_problem *cp, double scale,
                           const double *u, const double *r) {
  if (cp->dim == 2) return residual_of(cp, 2, scale, u, r);
  if (cp->dim == 3) return residual_of(cp, 3, scale, u, r);
  return residual_of(cp, 1, scale, u, r);
}

double contact_residual(const contact_problem *cp, const double *u,
                        const double *r) {
  contact_problem apart = *cp;
  contact_bodies *found = NULL;
  if (cp->bodies == NULL && contact_bodies_new(cp, &found) == OK)
    apart.bodies = found;
  double residual = contact_residual_at(&apart, contact_scale(cp), u, r);
  memory_free(found);
  return residual;
}

static INLINED double mismatch(const contact_problem *cp, int dim, double scale,
                               const double *u, const double *r,
                               const double *raw) {
  measure x = {.cp = cp, .dim = dim, .u = u, .r = r, .scale = scale};
  const double *of = contact_has_stiffness(cp) ? r : u;
  double worst = 0.0, d[3];
  measure_part(&x, 1);
  for (int i = 0; i < cp->n; ++i) {
    const measured *node = measure_node(&x, i);
    worst = larger(worst, map_of(&x, i, node));
    if (raw == NULL) continue;
    for (int k = 0; k < dim; ++k) d[k] = of[i * dim + k] - raw[i * dim + k];
    worst = larger(worst, equation_of(&x, node, d));
  }
  return isnan(scale) ? NAN : worst;
}

double contact_mismatch(const contact_problem *cp, double scale,
                        const double *u, const double *r, const double *raw) {
  if (cp->dim == 2) return mismatch(cp, 2, scale, u, r, raw);
  if (cp->dim == 3) return mismatch(cp, 3, scale, u, r, raw);
  return mismatch(cp, 1, scale, u, r, raw);
}

/* ---- status ------------------------------------------------------------ */

/* 1: no load acts on the body but for the rounding of all loads, and its
 * contact forces are rounding: that of some node, of which a soft one has less.
 */
static int has_no_force(const measure *x, const body_size *b) {
  return b->load <= ROUNDING * x->cp->load && !(b->contact > b->rounding);
}

static INLINED void find_roundings(const contact_problem *cp, int dim,
                                   const double *u, const double *r,
                                   double *rounding) {
  measure x = {.cp = cp, .dim = dim, .u = u, .r = r};
  measure_part(&x, 0);
  for (int i = 0; i < cp->n; ++i) rounding[i] = round_node(&x, i)->rounding;
}

void contact_roundings(const contact_problem *cp, const double *u,
                       const double *r, double *rounding) {
  if (cp->dim == 2)
    find_roundings(cp, 2, u, r, rounding);
  else if (cp->dim == 3)
    find_roundings(cp, 3, u, r, rounding);
  else
    find_roundings(cp, 1, u, r, rounding);
}

void contact_errors(const contact_problem *cp, double tol, const double *u,
                    const double *r, double *error) {
  measure x;
  measure_set(cp, contact_scale(cp), u, r, &x);
  for (int i = 0; i < cp->n; ++i) {
    const measured *node = measure_node(&x, i);
    error[i] = fmax(node->rounding, tol * fmax(node->normal, node->slide));
  }
}

static const double SLIGHT = 0x1p-30; /* -, friction that moves nothing */

double contact_hidden(const contact_problem *cp, const double *u,
                      const double *r, const double *own) {
  measure x;
  double worst = 0.0;
  measure_set(cp, 0.0, u, r, &x);
  for (int i = 0; i < cp->n; ++i) {
    const body_size *b = body_of(&x, i);
    const measured *node = measure_node(&x, i);
    const node_step e = map_errors(&x, i, node);
    double most = larger(b->load, b->contact), side = 1.0;
    if (own != NULL) most = larger(most, own[i]);
    if (has_no_force(&x, b)) continue;
    if (cp->g0 != NULL && node->q[0] < 0.0)
      side = smaller(1.0, contact_node_limit(cp, r, i) / -node->q[0]);
    if (side > 0.0) side = larger(side, SLIGHT);
    if (e.n > 0.0) worst = larger(worst, smaller(e.n, node->rounding) / most);
    if (e.t > 0.0 && side > 0.0)
      worst = larger(worst, smaller(e.t, node->rounding) / (side * most));
  }
  return worst;
}

void contact_drop_roundings(const contact_problem *cp, const double *u,
                            double *r) {
  measure x = {.cp = cp, .dim = cp->dim, .u = u, .r = r};
  int known = 0;
  for (int i = 0; i < cp->n; ++i) {
    const int n = cp->dim * i;
    if ((r[n] <= 0.0 && u[n] >= cp->gap[i]) || is_zero(cp->dim, r + n))
      continue;
    if (!known++) measure_part(&x, 0);
    const measured *node = round_node(&x, i);
    for (int k = cp->dim - 1; k >= 0 && fabs(r[n]) <= node->rounding; --k)
      if (fabs(r[n + k]) <= node->rounding) r[n + k] = 0.0;
  }
}

/* |r_t - c (u_t - ut0)| in the directions friction acts in, N. */
static double trial_friction(const measure *x, int node_id, double c) {
  double z[2] = {0.0, 0.0};
  for (int k = 1; k < x->dim; ++k) {
    int dof = node_id * x->dim + k;
    if (!contact_held(x->cp, dof))
      z[k - 1] = x->r[dof] - c * (x->u[dof] - contact_stick(x->cp, dof));
  }
  return contact_length(x->dim - 1, z);
}

/* 1: unknown k of a node, of stiffness c, is at its obstacle. */
static int is_closed(measure *x, int node_id, const measured *node, int k,
                     double c) {
  const int dof = node_id * x->dim + k;
  const body_size *b = body_of(x, node_id);
  const double least = STATUS_MARGIN * forces_of(x, node, b, c);
  double push = c * (x->u[dof] - contact_bound(x->cp, dof)) - x->r[dof];
  return push > least && !has_no_force(x, b);
}

/* 1: friction holds a node; at its limit, where it rests, as "rests" says. */
static int is_stuck(measure *x, int node_id, const measured *node, int rests) {
  const double g = contact_node_limit(x->cp, x->r, node_id), c = node->c.t;
  const double least =
      STATUS_MARGIN * forces_of(x, node, body_of(x, node_id), c);
  const double more = trial_friction(x, node_id, c) - g;
  return g != 0.0 && !(more > (rests ? least : -least));
}

void contact_stops(const contact_problem *cp, const double *u, const double *r,
                   int rests, double *force, unsigned char *stopped) {
  measure x;
  measure_set(cp, contact_scale(cp), u, r, &x);
  if (force != NULL) COPY(force, r, cp->m);
  for (int i = 0; i < cp->n; ++i) {
    const int first = cp->dim * i;
    const measured *node = measure_node(&x, i);
    for (int k = 0; k < cp->dim; ++k)
      stopped[first + k] =
          contact_bound(cp, first + k) < HUGE_VAL &&
          is_closed(&x, i, node, k, k == 0 ? node->c.n : node->c.t);
    if (force != NULL && !stopped[first]) force[first] = 0.0;
  }
  if (force != NULL) x.r = force;
  for (int i = 0; i < cp->n && cp->g0 != NULL; ++i) {
    const measured *node = measure_node(&x, i);
    if (contact_has_side(cp, i) || !is_stuck(&x, i, node, rests)) continue;
    for (int k = 1; k < cp->dim; ++k) stopped[i * cp->dim + k] = 1;
  }
}

void contact_classify(const contact_problem *cp, const double *u,
                      const double *r, contact_status *state) {
  measure x;
  measure_set(cp, contact_scale(cp), u, r, &x);
  for (int i = 0; i < cp->n; ++i) {
    const measured *node = measure_node(&x, i);
    state[i] = !is_closed(&x, i, node, 0, node->c.n) ? CONTACT_OPEN
               : is_stuck(&x, i, node, 1)            ? CONTACT_STICK
                                                     : CONTACT_SLIP;
  }
}
