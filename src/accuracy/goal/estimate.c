/*
 * The error of a goal by the mesh (goal.h). With the contact as it is and the
 * edges of the contact surface where the gap is curved,
 *
 *   J(u) - J(u_h) = residual of the adjoint at u - u_h,
 *
 * and u - u_h is taken in the bubbles of the edges. The adjoint is singular
 * where the contact ends and u is not: recovering the adjoint instead is worse.
 *
 * An element has the bubble of an edge with the integral of its gradient
 * 4 (grad la + grad lb)/(dim + 1) times its volume.
 *
 * The energy a(u, u)/2 has, with e = u - u_h, the error a(u_h, e) + a(e, e)/2.
 * Its adjoint y is what of u_h the loads do; the rest, z = u_h - y, is what
 * supports and gaps prescribe and has no residual, so that
 *
 *   a(u_h, e) = a(z, e) = -a(e_z, e) + a(z, x) = a(e_y, e) - a(e, e) + a(z, x),
 *
 * x what is prescribed between the nodes. The error is half of a(e_w, e) with
 * w = 2 y - u_h, by recovered stresses, and half of what x does to u_h - w:
 * loads alone (w = u_h) make the energy of the mesh too small by a(e, e)/2,
 * supports alone (w = -u_h) too large by it. Where nodes slip by friction that
 * follows the pressure, z is singular too: that counts as far as z has the
 * energy, and else the residual of z in the bubbles.
 *
 * Strains without stress e0 count with z: its stress s_z is that of u_h, E (e -
 * e0), less that of y, and the same holds for it. Where they vary within an
 * element by d0 from their mean there, the error e_z of its stress has a part
 * E d0, which does no work on the mean: less the integral of e_z : d0. Where
 * the hoop strains of s_y, by the residual of z those of s_u, vary in an
 * axisymmetric element, they do work on it.
 */
#include "accuracy/goal/goal.h"

#include "base/base.h"

/* A field in the bubbles. */
typedef struct bubbles {
  double *strain; /* [ns*n_elem] its mean strains, but for the hoop, - */
  double *part;   /* [edges*dim*n_elem] at each edge, m; NULL: not needed */
} bubbles;

/* An edge of elements of several regions, node ids a < b. What u is in its
 * bubble is one field: the mean of what the regions find. */
typedef struct joint_edge {
  int a, b;
  int n, region;             /* regions so far, the last of them */
  double whole[3], given[3]; /* sums of bubble_of, m */
  double contact[3];         /* the same of goal_estimator.edge */
} joint_edge;

struct goal_estimator {
  goal_solution s;
  space_recovery *recovery; /* borrowed */
  int n_region;
  double **stress;    /* [n_region][ns*n_node] recovered of u, Pa */
  bubbles all;        /* u in the bubbles */
  bubbles given;      /* what supports and contact give of it */
  double *w;          /* [dim*n_node] of the energy; workspace, NULL: none */
  double by_given;    /* -, share of the energy that z has */
  double *eigen;      /* [ns*n_elem] E e0 of the energy, Pa; NULL: none */
  double *node_eigen; /* [ns*n_node] recovered; workspace */
  double *edge;       /* [dim*n_edge] u in the bubbles of contact edges, m */
  double *own;        /* [n_elem] |e_u|^2, J */
  int n_joint;
  joint_edge *joint;         /* [n_joint] sorted by a, b */
  unsigned char *is_joint;   /* [n_node] 1: of elements of several regions */
  unsigned char *on_surface; /* [n_node] 1: of an edge of the contact */
  double *sigma_y;           /* [ns*n_elem] of the adjoint; workspace */
  double *node_y;            /* [ns*n_node] recovered; workspace */
};

/* q[dim*dim*n_elem]: du_c/dx_k at c*dim + k. */
static void gradients(const goal_solution *s, double *q) {
  const mesh *m = s->d->mesh;
  const int dim = m->dim;
  double g[12];
  for (int e = 0; e < m->n_elem; ++e, q += dim * dim) {
    mesh_elem_gradients(m, e, g);
    for (int a = 0; a <= dim; ++a) {
      const double *v = s->u + (size_t)dim * m->elem[(dim + 1) * e + a];
      for (int c = 0; c < dim; ++c)
        for (int k = 0; k < dim; ++k) q[c * dim + k] += v[c] * g[dim * a + k];
    }
  }
}

/* ---- the part of u in the bubble of an edge ------------------------------ */

static const contact_edge *find_edge(const goal_estimator *e, int a, int b) {
  if (!e->on_surface[a] || !e->on_surface[b]) return NULL;
  return PAIR_FIND(e->s.surface->edge, e->s.surface->n_edge, a, b);
}

/* v[dim] with another part along n[dim]. */
static void set_along(int dim, const double *n, double part, double *v) {
  add_scaled(dim, part - dot(dim, n, v), n, v);
}

/* u[dim] at the surface of the body less that in the middle of its edge a, b,
 * by the recovered gradient G. */
static void outside(const goal_solution *s, const double *G, int a, int b,
                    const double *out, double *u) {
  const int dim = s->d->mesh->dim, n = dim * dim;
  const double *ga = G + (size_t)n * a, *gb = G + (size_t)n * b;
  for (int c = 0; c < dim; ++c) {
    u[c] = 0.0;
    for (int k = 0; k < dim; ++k)
      u[c] += 0.5 * (ga[c * dim + k] + gb[c * dim + k]) * out[k];
  }
}

/* d[dim] on a closed edge: along n that of the gap at the surface, across it as
 * it began to stick; x[dim] what of it is given. */
static void hold(const goal_solution *s, const double *G, const contact_edge *c,
                 double *d, double *x) {
  const int dim = s->d->mesh->dim;
  double u[3], along = c->excess;
  outside(s, G, c->a, c->b, c->out, u);
  for (int k = 0; k < dim; ++k) along -= c->n[k] * u[k];
  for (int k = 0; k < dim && c->stuck; ++k) d[k] = x[k] = c->stick[k];
  set_along(dim, c->n, along, d);
  set_along(dim, c->n, along, x);
}

/* d[dim], x[dim] where a support holds both ends of an edge. */
static void support(const goal_solution *s, const double *G, int a, int b,
                    double *d, double *x) {
  const int dim = s->d->mesh->dim;
  const given_edge *g = PAIR_FIND(s->surface->given, s->surface->n_given, a, b);
  const bent_edge *bent = PAIR_FIND(s->surface->bent, s->surface->n_bent, a, b);
  double u[3] = {0.0};
  int any = 0;
  for (int c = 0; c < dim; ++c)
    any |= s->d->fixed[dim * a + c] && s->d->fixed[dim * b + c];
  if (!any) return;
  if (bent != NULL) outside(s, G, a, b, bent->out, u);
  for (int c = 0; c < dim; ++c)
    if (s->d->fixed[dim * a + c] && s->d->fixed[dim * b + c])
      d[c] = x[c] = (g != NULL ? g->bend[c] : 0.0) - u[c];
}

/* From the front of a crack at node a to b, u is a root of the distance and
 * linear: with their slope at b the root is twice what the slope lacks, and its
 * part in the bubble sqrt(1/2) - 1/2 of that. */
static void root_bubble(const goal_solution *s, const double *G, int a, int b,
                        double *d) {
  static const double ROOT = 0.41421356237309505;
  const mesh *m = s->d->mesh;
  const int dim = m->dim;
  const double *xa = m->x + dim * a, *xb = m->x + dim * b;
  const double *g = G + (size_t)(dim * dim) * b;
  for (int c = 0; c < dim; ++c) {
    double lacks = s->u[dim * b + c] - s->u[dim * a + c];
    for (int k = 0; k < dim; ++k) lacks -= g[c * dim + k] * (xb[k] - xa[k]);
    d[c] = ROOT * lacks;
  }
}

/* d[dim] of the edge from node a to b by G alone. */
static void free_bubble(const goal_solution *s, const double *G, int a, int b,
                        double *d) {
  const mesh *m = s->d->mesh;
  const int dim = m->dim, n = dim * dim;
  const unsigned char *front = s->surface->front;
  if (front != NULL && front[a] != front[b]) {
    root_bubble(s, G, front[a] ? a : b, front[a] ? b : a, d);
    return;
  }
  const double *xa = m->x + dim * a, *xb = m->x + dim * b;
  const double *ga = G + (size_t)n * a, *gb = G + (size_t)n * b;
  for (int c = 0; c < dim; ++c) {
    d[c] = 0.0;
    for (int k = 0; k < dim; ++k)
      d[c] += (ga[c * dim + k] - gb[c * dim + k]) * (xb[k] - xa[k]) / 8.0;
  }
}

/* d[dim] of the edge from node a to b by the recovered gradient of a region,
 * G[dim*dim*n_node]; x[dim] what of it is given. */
static void bubble_of(goal_estimator *e, const double *G, int a, int b,
                      double *d, double *x) {
  const goal_solution *s = &e->s;
  const int dim = s->d->mesh->dim;
  double rest[3] = {0.0};
  CLEAR(x, 3);
  free_bubble(s, G, a, b, d);
  const contact_edge *contact = find_edge(e, a, b);
  if (contact != NULL) {
    if (contact->other[0] >= 0) {
      free_bubble(s, G, contact->other[0], contact->other[1], rest);
      for (int c = 0; c < dim; ++c) rest[c] = 0.5 * (rest[c] + d[c]);
    }
    for (int c = 0; c < dim; ++c) d[c] -= rest[c];
    if (contact->closed) hold(s, G, contact, d, x);
    COPY(e->edge + dim * (contact - s->surface->edge), d, dim);
    for (int c = 0; c < dim; ++c) d[c] += rest[c];
  }
  support(s, G, a, b, d, x);
}

/* Mean radius of an element, m. */
static double radius_of(const mesh *m, int elem_id) {
  const int *v = m->elem + 3 * elem_id;
  return (m->x[2 * v[0]] + m->x[2 * v[1]] + m->x[2 * v[2]]) / 3.0;
}

/* Adds the strain of a field with the gradient g[dim] times d[dim]. */
static void add_strain(int dim, const double *g, const double *d, double *e) {
  for (int c = 0; c < dim; ++c) e[c] += g[c] * d[c];
  e[3] += g[0] * d[1] + g[1] * d[0];
  if (dim == 2) return;
  e[4] += g[1] * d[2] + g[2] * d[1];
  e[5] += g[2] * d[0] + g[0] * d[2];
}

static int edges_of(int dim) { return dim == 2 ? 3 : 6; }

/* Adds edge (a, b), number "edge", d in its bubble; g: gradients of P1. */
static void add_bubble(const domain *d, int elem_id, const int *edge,
                       const double *g, const double *of, bubbles *to) {
  const int dim = d->mesh->dim, a = edge[0], b = edge[1];
  double *e = to->strain + (size_t)d->ns * elem_id;
  double grad[3] = {0.0};
  const size_t at = edges_of(dim) * elem_id + edge[2];
  if (to->part != NULL) COPY(to->part + dim * at, of, dim);
  for (int k = 0; k < dim; ++k)
    grad[k] = 4.0 / (dim + 1) * (g[dim * a + k] + g[dim * b + k]);
  add_strain(dim, grad, of, e);
}

/* ---- edges of several regions -------------------------------------------- */

/* NULL: all elements of the edge are of one region. */
static joint_edge *find_joint(const goal_estimator *e, int a, int b) {
  if (!e->is_joint[a] || !e->is_joint[b]) return NULL;
  return PAIR_FIND(e->joint, e->n_joint, a, b);
}

/* Writes the edges between marked nodes, element by element, or counts them. */
static int list_joints(const goal_estimator *e, joint_edge *to) {
  const mesh *m = e->s.d->mesh;
  int n = 0;
  for (int k = 0; k < m->n_elem; ++k) {
    const int *v = m->elem + (m->dim + 1) * k;
    for (int a = 0; a < m->dim; ++a)
      for (int b = a + 1; b <= m->dim; ++b) {
        if (!e->is_joint[v[a]] || !e->is_joint[v[b]]) continue;
        const number_pair is = number_pair_of(v[a], v[b]);
        const int region = space_region(e->recovery, k);
        if (to != NULL) to[n] = (joint_edge){is.a, is.b, .region = region};
        ++n;
      }
  }
  return n;
}

/* Keeps one of each edge that has several regions. */
static int unite_joints(joint_edge *j, int n) {
  int kept = 0;
  for (int i = 0, last; i < n; i = last) {
    int several = 0;
    last = PAIR_END(j, n, i);
    for (int k = i; k < last; ++k) several |= j[k].region != j[i].region;
    if (several) j[kept++] = j[i];
  }
  return kept;
}

static status find_joints(goal_estimator *e) {
  const int n_node = e->s.d->mesh->n_node;
  OWNED int *region = NULL;
  PASS_NEW_ALL(OF(e->is_joint, n_node), OF(region, n_node));
  const mesh *m = e->s.d->mesh;
  for (int k = 0; k < (m->dim + 1) * m->n_elem; ++k) {
    const int of = space_region(e->recovery, k / (m->dim + 1)) + 1;
    int *at = &region[m->elem[k]];
    if (*at != 0 && *at != of) e->is_joint[m->elem[k]] = 1;
    *at = of;
  }
  const int n = list_joints(e, NULL);
  if (n == 0) return OK;
  PASS_NEW(e->joint, n);
  list_joints(e, e->joint);
  PAIR_SORT(e->joint, n);
  e->n_joint = unite_joints(e->joint, n);
  return OK;
}

/* Once by each region. */
static void add_joint(goal_estimator *e, const double *G, int region,
                      joint_edge *j) {
  const int dim = e->s.d->mesh->dim;
  double whole[3] = {0.0}, given[3], contact[3] = {0.0};
  if (j->n > 0 && j->region == region) return;
  j->region = region;
  ++j->n;
  bubble_of(e, G, j->a, j->b, whole, given);
  add_scaled(3, 1.0, whole, j->whole);
  add_scaled(3, 1.0, given, j->given);
  const contact_edge *of = find_edge(e, j->a, j->b);
  if (of == NULL) return;
  COPY(contact, e->edge + dim * (of - e->s.surface->edge), dim);
  add_scaled(3, 1.0, contact, j->contact);
}

/* From sums to means. */
static void finish_joint(goal_estimator *e, joint_edge *j) {
  const int dim = e->s.d->mesh->dim;
  for (int c = 0; c < 3; ++c) {
    j->whole[c] /= j->n;
    j->given[c] /= j->n;
    j->contact[c] /= j->n;
  }
  const contact_edge *of = find_edge(e, j->a, j->b);
  if (of != NULL)
    COPY(e->edge + dim * (of - e->s.surface->edge), j->contact, dim);
}

/* The bubbles of the edges of an element; G NULL: of those of several
 * regions, which else count for later. */
static void bubbles_of(goal_estimator *of, const double *G, int elem_id) {
  const domain *d = of->s.d;
  const int dim = d->mesh->dim, *v = d->mesh->elem + (dim + 1) * elem_id;
  const int region = space_region(of->recovery, elem_id);
  double g[12], whole[3], given[3];
  int edge[3] = {0};
  mesh_elem_gradients(d->mesh, elem_id, g);
  for (edge[0] = 0; edge[0] < dim; ++edge[0])
    for (edge[1] = edge[0] + 1; edge[1] <= dim; ++edge[1], ++edge[2]) {
      joint_edge *j = find_joint(of, v[edge[0]], v[edge[1]]);
      if (G != NULL && j != NULL) add_joint(of, G, region, j);
      if ((G != NULL) == (j != NULL)) continue;
      if (j == NULL) bubble_of(of, G, v[edge[0]], v[edge[1]], whole, given);
      add_bubble(d, elem_id, edge, g, j != NULL ? j->whole : whole, &of->all);
      add_bubble(d, elem_id, edge, g, j != NULL ? j->given : given, &of->given);
    }
}

static void add_joints(goal_estimator *e) {
  const mesh *m = e->s.d->mesh;
  for (int k = 0; k < e->n_joint; ++k) finish_joint(e, &e->joint[k]);
  for (int k = 0; k < m->n_elem && e->n_joint > 0; ++k) bubbles_of(e, NULL, k);
}

/* ---- what belongs to u --------------------------------------------------- */

/* In one region; q[dim*dim*n_elem] gradients, G[dim*dim*n_node] workspace. */
static status recover_region(goal_estimator *e, int region, const double *q,
                             double *G) {
  const mesh *m = e->s.d->mesh;
  PASS_NEW(e->stress[region], (size_t)e->s.d->ns * m->n_node);
  space_recover(e->recovery, region, m->dim * m->dim, q, G);
  space_recover(e->recovery, region, e->s.d->ns, e->s.sigma, e->stress[region]);
  const space_field f = {e->s.sigma, e->stress[region]};
  for (int k = 0; k < m->n_elem; ++k) {
    if (space_region(e->recovery, k) != region) continue;
    space_product(e->recovery, k, &f, &f, &e->own[k]);
    bubbles_of(e, G, k);
  }
  return OK;
}

static status new_bubbles(const goal_solution *s, int parts, bubbles *b) {
  const mesh *m = s->d->mesh;
  const size_t n = edges_of(m->dim) * m->dim;
  PASS_NEW(b->strain, (size_t)s->d->ns * m->n_elem);
  if (parts) PASS_NEW(b->part, n * m->n_elem);
  return OK;
}

/* E e0: the stress of all strains less that of u. */
static status new_eigen(goal_estimator *e) {
  domain d = *e->s.d;
  const size_t n = (size_t)d.ns * d.mesh->n_elem;
  if (d.eigen == NULL) return OK;
  PASS_NEW_ALL(OF(e->eigen, n), OF(e->node_eigen, d.ns * d.mesh->n_node));
  d.eigen = NULL;
  domain_stress(&d, e->s.u, NULL, e->eigen);
  for (size_t k = 0; k < n; ++k) e->eigen[k] -= e->s.sigma[k];
  return OK;
}

static status new_fields(goal_estimator *e) {
  const goal_solution *s = &e->s;
  const int axi = s->d->kin[0] == AXISYMMETRIC;
  PASS(new_bubbles(s, s->has_flux || s->has_mean || axi, &e->all));
  PASS(new_bubbles(s, axi, &e->given));
  if (!s->has_energy) return OK;
  PASS_NEW(e->w, s->d->mesh->dim * s->d->mesh->n_node);
  return new_eigen(e);
}

status goal_estimator_new(const goal_solution *s, space_recovery *recovery,
                          goal_estimator **out) {
  const mesh *m = s->d->mesh;
  OWNED double *q = NULL, *G = NULL;
  const size_t n = m->dim * m->dim;
  const goal_surface *on = s->surface;
  MAKES(goal_estimator, e, out);
  e->s = *s;
  e->recovery = recovery;
  PASS_NEW_ALL(OF(q, n * m->n_elem), OF(G, n * m->n_node));
  gradients(s, q);
  e->n_region = space_regions(recovery);
  PASS_NEW_ALL(OF(e->stress, e->n_region), OF(e->own, m->n_elem),
               OF(e->edge, m->dim * on->n_edge), OF(e->on_surface, m->n_node));
  for (int k = 0; k < on->n_edge; ++k)
    e->on_surface[on->edge[k].a] = e->on_surface[on->edge[k].b] = 1;
  PASS(new_fields(e));
  PASS_NEW(e->sigma_y, (size_t)s->d->ns * m->n_elem);
  PASS_NEW(e->node_y, (size_t)s->d->ns * m->n_node);
  PASS(space_moduli(recovery));
  PASS(space_keep(recovery));
  PASS(find_joints(e));
  for (int k = 0; k < e->n_region; ++k) PASS(recover_region(e, k, q, G));
  add_joints(e);
  return OK;
}

void goal_estimator_bubble(const goal_estimator *e, int elem_id, int a, int b,
                           double *d) {
  const mesh *m = e->s.d->mesh;
  const int dim = m->dim, *v = m->elem + (dim + 1) * elem_id;
  const double *of = e->all.part + (size_t)(edges_of(dim) * dim) * elem_id;
  for (int i = 0; i < dim; ++i)
    for (int k = i + 1; k <= dim; ++k, of += dim)
      if ((v[i] == a && v[k] == b) || (v[i] == b && v[k] == a))
        COPY(d, of, dim);
}

/* At a point of an element: T : grad of u, that in the bubbles too, by the
 * gradients of the P1 functions. */
static double flux_part(const goal_estimator *e, int elem_id, const double *phi,
                        const double *g, const double *T) {
  const int dim = e->s.d->mesh->dim;
  const double *d = e->all.part + (size_t)(edges_of(dim) * dim) * elem_id;
  const int *v = e->s.d->mesh->elem + (dim + 1) * elem_id;
  double sum = 0.0;
  for (int i = 0; i < dim; ++i)
    for (int k = 0; k < dim; ++k) {
      double slope = 0.0;
      const double *of = d + i;
      for (int a = 0; a <= dim; ++a) {
        slope += e->s.u[dim * v[a] + i] * g[dim * a + k];
        for (int b = a + 1; b <= dim; ++b, of += dim)
          slope +=
              *of * 4.0 * (phi[a] * g[dim * b + k] + phi[b] * g[dim * a + k]);
      }
      sum += T[dim * i + k] * slope;
    }
  return sum;
}

double goal_estimator_flux(const goal_estimator *e, const goal_flux *f) {
  const mesh *m = e->s.d->mesh;
  const int dim = m->dim;
  const double *T = f->at;
  double sum = 0.0, g[12], phi[4];
  for (int i = 0; i < f->n; ++i) {
    const double part = mesh_elem_gradients(m, f->elem[i], g) /
                        (dim == 2 ? 2.0 : 6.0) / (dim + 1);
    for (int k = 0; k <= dim; ++k, T += dim * dim) {
      for (int a = 0; a <= dim; ++a) phi[a] = (1.0 - f->corner) / dim;
      phi[k] = f->corner;
      sum += part * flux_part(e, f->elem[i], phi, g, T);
    }
  }
  return sum;
}

const double *goal_estimator_edges(const goal_estimator *e) { return e->edge; }

double goal_estimator_energy(const goal_estimator *e) {
  double sum = 0.0;
  for (int k = 0; k < e->s.d->mesh->n_elem; ++k) sum += e->own[k];
  return sum;
}

/* ---- the sums ------------------------------------------------------------ */

static const double AXI_RULE[2] = {1.0 / 6.0, 2.0 / 3.0};

/* At a point of an axisymmetric element: radius, strain of the nodes' values
 * v[2*n_node], and that of bubbles b. */
static double axi_strains(const goal_estimator *e, int elem_id, int point,
                          const double *v, const bubbles *b, double *of_v,
                          double *of_b) {
  const mesh *m = e->s.d->mesh;
  const int *node = m->elem + 3 * elem_id;
  const double *d = b->part + 6 * (size_t)elem_id;
  double g[12], phi[3], r = 0.0, up[2] = {0.0};
  mesh_elem_gradients(m, elem_id, g);
  CLEAR(of_v, 4);
  CLEAR(of_b, 4);
  for (int a = 0; a < 3; ++a) {
    phi[a] = AXI_RULE[a == point];
    r += phi[a] * m->x[2 * node[a]];
    up[0] += phi[a] * v[2 * node[a]];
    add_strain(2, g + 2 * a, v + 2 * node[a], of_v);
  }
  for (int a = 0; a < 3; ++a)
    for (int c = a + 1; c < 3; ++c, d += 2) {
      double grad[2];
      for (int k = 0; k < 2; ++k)
        grad[k] = 4.0 * (phi[a] * g[2 * c + k] + phi[c] * g[2 * a + k]);
      add_strain(2, grad, d, of_b);
      up[1] += 4.0 * phi[a] * phi[c] * d[0];
    }
  of_v[2] = up[0] / r;
  of_b[2] = up[1] / r;
  return r;
}

/* Integral of (tau - sigma(y)) : e(b) over an axisymmetric element, where hoop
 * strains and the turn vary; tau[4] of u and w at each point, or NULL. */
static double axi_residual(const goal_estimator *e, int elem_id,
                           const double *y, const double *tau, int of_u,
                           const bubbles *b) {
  const domain *d = e->s.d;
  const double *eigen =
      of_u && e->eigen != NULL ? e->eigen + 4 * elem_id : NULL;
  const double share =
      element_weight(d, elem_id) / (3.0 * radius_of(d->mesh, elem_id));
  double sum = 0.0;
  for (int p = 0; p < 3; ++p) {
    double of_y[4], of_b[4], of_own[4], t[4];
    const double r = axi_strains(e, elem_id, p, y, b, of_y, of_b);
    if (of_u) axi_strains(e, elem_id, p, e->s.u, b, of_own, of_b);
    for (int k = 0; k < 4; ++k) of_y[k] -= of_u ? of_own[k] : 0.0;
    element_stress(d, elem_id, of_y, t);
    for (int k = 0; k < 4; ++k) {
      if (tau != NULL && !of_u) t[k] -= tau[k];
      if (eigen != NULL) t[k] += 2.0 * eigen[k];
      sum -= share * r * t[k] * of_b[k];
    }
  }
  return sum;
}

/* The hoop strain of v[2*n_node] at a point of an axisymmetric element less
 * that at its mean radius; r: of the point. */
static double axi_hoop(const mesh *m, int elem_id, int point, const double *v,
                       double *r) {
  const int *node = m->elem + 3 * elem_id;
  double at = 0.0, mean = 0.0;
  *r = 0.0;
  for (int a = 0; a < 3; ++a) {
    at += AXI_RULE[a == point] * v[2 * node[a]];
    *r += AXI_RULE[a == point] * m->x[2 * node[a]];
    mean += v[2 * node[a]] / 3.0;
  }
  return at / *r - mean / radius_of(m, elem_id);
}

/* At a point of an axisymmetric element: what is recovered of a stress less
 * that of v[2*n_node], whose hoop strain varies there and is no error. */
static double axi_difference(const goal_estimator *e, int elem_id, int point,
                             const space_field *f, const double *v, double *d) {
  const mesh *m = e->s.d->mesh;
  const int *node = m->elem + 3 * elem_id;
  const double *E = e->s.d->E + 16 * e->s.d->section_id[elem_id];
  double r;
  const double hoop = axi_hoop(m, elem_id, point, v, &r);
  for (int i = 0; i < 4; ++i) {
    d[i] = -f->element[4 * elem_id + i] - E[i + 8] * hoop;
    for (int a = 0; a < 3; ++a)
      d[i] += AXI_RULE[a == point] * f->node[4 * node[a] + i];
  }
  return r;
}

/* Integral of d_u' inv(E) d_w over an axisymmetric element; that of d_u' inv(E)
 * d_u in *own. */
static double axi_product(const goal_estimator *e, int elem_id,
                          const space_field *u, const space_field *of_w,
                          const double *w, double *own) {
  const double *S = space_compliance_of(e->recovery, elem_id);
  const double share = element_weight(e->s.d, elem_id) /
                       (3.0 * radius_of(e->s.d->mesh, elem_id));
  double sum = 0.0;
  *own = 0.0;
  for (int p = 0; p < 3; ++p) {
    double a[4], b[4];
    const double r = axi_difference(e, elem_id, p, u, e->s.u, a);
    axi_difference(e, elem_id, p, of_w, w, b);
    for (int i = 0; i < 4; ++i)
      for (int k = 0; k < 4; ++k) {
        sum += share * r * a[i] * S[i + 4 * k] * b[k];
        *own += share * r * a[i] * S[i + 4 * k] * a[k];
      }
  }
  return sum;
}

static int is_axi(const goal_estimator *e, int elem_id) {
  return e->s.d->kin[e->s.d->section_id[elem_id]] == AXISYMMETRIC;
}

/* Integral of (tau - sigma(y)) : e(b) over an element, b in bubbles. */
static double residual_of(const goal_estimator *e, int elem_id, const double *y,
                          const double *tau, int of_u, const bubbles *in) {
  const size_t ns = e->s.d->ns, at = ns * elem_id;
  const double *b = in->strain + at;
  double sum = 0.0;
  if (is_axi(e, elem_id))
    return axi_residual(e, elem_id, y, tau != NULL ? tau + at : NULL, of_u, in);
  for (size_t k = 0; k < ns; ++k)
    sum += ((tau != NULL ? tau[at + k] : 0.0) - e->sigma_y[at + k]) * b[k];
  return sum * element_weight(e->s.d, elem_id);
}

/* Twice less the integral of e_z : d0 of the head of this file. */
static double eigen_product(const goal_estimator *e, int elem_id,
                            const space_field *u, const space_field *of_w) {
  const space_field eigen = {e->eigen, e->node_eigen};
  double square;
  if (e->eigen == NULL) return 0.0;
  return space_product(e->recovery, elem_id, of_w, &eigen, &square) -
         space_product(e->recovery, elem_id, u, &eigen, &square);
}

/* Less the integral of the stress of v[2*n_node] by what its hoop strain varies
 * : d0. */
static double axi_varied(const goal_estimator *e, int elem_id,
                         const double *v) {
  const mesh *m = e->s.d->mesh;
  const int *node = m->elem + 3 * elem_id;
  double sum = 0.0;
  if (!is_axi(e, elem_id) || e->eigen == NULL) return 0.0;
  for (int p = 0; p < 3; ++p) {
    double r, d0 = -e->eigen[4 * elem_id + 2];
    const double hoop = axi_hoop(m, elem_id, p, v, &r);
    for (int a = 0; a < 3; ++a)
      d0 += AXI_RULE[a == p] * e->node_eigen[4 * node[a] + 2];
    sum -= r * hoop * d0;
  }
  return sum * element_weight(e->s.d, elem_id) / (3.0 * radius_of(m, elem_id));
}

/* Returns |e_u| |e_y| of the element. */
static double add_element(goal_estimator *e, int elem_id, const double *y,
                          const double *tau, int of_u, goal_estimate *out) {
  const int region = space_region(e->recovery, elem_id);
  const space_field u = {e->s.sigma, e->stress[region]};
  const space_field of_y = {e->sigma_y, e->node_y};
  double square, own = e->own[elem_id];
  double product = space_product(e->recovery, elem_id, &u, &of_y, &square);
  const double both = sqrt(fmax(e->own[elem_id] * square, 0.0));
  const double residual = residual_of(e, elem_id, y, tau, of_u, &e->all);
  const double given = residual_of(e, elem_id, y, tau, of_u, &e->given);
  const double like = is_axi(e, elem_id)
                          ? axi_product(e, elem_id, &u, &of_y, y, &own)
                          : product;
  if (of_u) {
    const double varied = eigen_product(e, elem_id, &u, &of_y);
    const double of_w = axi_varied(e, elem_id, y);
    const double of_own = axi_varied(e, elem_id, e->s.u);
    product = like;
    out->error +=
        0.5 * (e->by_given * (given + product + varied + of_w) +
               (1.0 - e->by_given) * (residual + own + of_own) + of_own);
    out->magnitude += fabs(given) + fabs(varied);
  } else {
    out->error += residual;
  }
  out->magnitude += fabs(product);
  out->product += both;
  const mesh *m = e->s.d->mesh;
  int ends = 0;
  for (int a = 0; a <= m->dim; ++a)
    ends |= e->s.surface->ends[m->elem[(m->dim + 1) * elem_id + a]];
  const double lacks = like + given - residual;
  if ((ends & ~GOAL_FEW_EDGES) == GOAL_HOLLOW && !of_u) {
    out->twice += lacks;
    if (ends != GOAL_HOLLOW) out->hollow += fabs(lacks);
  }
  ends &= ~(GOAL_HOLLOW | GOAL_FEW_EDGES);
  if (ends == GOAL_NEAR_SUPPORT) out->near += both;
  ends &= ~GOAL_NEAR_SUPPORT;
  if (ends != 0) out->ends += both;
  if (ends == GOAL_END_OF_SUPPORT) out->supports += both;
  if ((ends & GOAL_END_OF_SUPPORT) != 0) out->sharp += of_u ? 0.5 * both : both;
  return both;
}

/* The stiffness takes the hoop at the mean radius r of an element: what u'E y
 * has there more than its integral, E A (u y/r - mean of u y/r), J. */
static double hoop_of(const goal_estimator *e, int elem_id, const double *y) {
  const domain *d = e->s.d;
  const mesh *m = d->mesh;
  const int *v = m->elem + 3 * elem_id;
  double mean[3] = {0.0}, sum = 0.0;
  if (!is_axi(e, elem_id)) return 0.0;
  for (int p = 0; p < 3; ++p) {
    double at[3] = {0.0};
    for (int a = 0; a < 3; ++a) {
      const double all[3] = {e->s.u[2 * v[a]], y[2 * v[a]], m->x[2 * v[a]]};
      for (int k = 0; k < 3; ++k) {
        at[k] += AXI_RULE[a == p] * all[k];
        if (p == 0) mean[k] += all[k] / 3.0;
      }
    }
    sum += at[0] * at[1] / at[2] / 3.0;
  }
  return element_weight(d, elem_id) * d->E[16 * d->section_id[elem_id] + 10] *
         (mean[0] * mean[1] / mean[2] - sum) / mean[2];
}

/* Of an axisymmetric element: F'y is what y gives. zero[2*n_node] stays. */
static void add_axi_force(const goal_estimator *e, int elem_id, double *zero,
                          double *F) {
  const int *v = e->s.d->mesh->elem + 3 * elem_id;
  for (int k = 0; k < 6; ++k) {
    const int dof = 2 * v[k / 2] + k % 2;
    zero[dof] = 1.0;
    F[dof] += axi_residual(e, elem_id, zero, NULL, 0, &e->all) +
              hoop_of(e, elem_id, zero);
    zero[dof] = 0.0;
  }
}

void goal_estimator_force(goal_estimator *e, double *F) {
  const domain *d = e->s.d;
  const size_t ns = d->ns;
  const size_t n = (size_t)d->mesh->dim * d->mesh->n_node;
  if (d->kin[0] == AXISYMMETRIC) {
    CLEAR(F, n);
    CLEAR(e->node_y, n);
    for (int k = 0; k < d->mesh->n_elem; ++k) add_axi_force(e, k, e->node_y, F);
    return;
  }
  for (int k = 0; k < d->mesh->n_elem; ++k)
    element_stress(d, k, e->all.strain + ns * k, e->sigma_y + ns * k);
  domain_internal_force(d, e->sigma_y, F);
  for (size_t k = 0; k < n; ++k) F[k] = -F[k];
}

/* e->by_given: where friction rubs 1 - integral of sigma : e(y) over twice the
 * energy. */
static void set_share(goal_estimator *e, const double *y) {
  const double whole = 2.0 * domain_strain_energy(e->s.d, e->s.u);
  e->by_given = 1.0;
  if (!e->s.rubs) return;
  double loads = 0.0;
  domain_internal_force(e->s.d, e->s.sigma, e->w);
  for (int k = 0; k < e->s.d->mesh->dim * e->s.d->mesh->n_node; ++k)
    loads += e->w[k] * y[k];
  e->by_given = whole > 0.0 ? 1.0 - loads / whole : 0.0;
  e->by_given = fmax(0.0, fmin(1.0, e->by_given));
}

/* The stress of y; of the energy, y becomes w. */
static void set_adjoint(goal_estimator *e, int of_u, const double **y) {
  domain d = *e->s.d;
  d.eigen = NULL;
  domain_stress(&d, *y, NULL, e->sigma_y);
  if (!of_u) return;
  set_share(e, *y);
  for (int k = 0; k < d.mesh->dim * d.mesh->n_node; ++k)
    e->w[k] = 2.0 * (*y)[k] - e->s.u[k];
  for (int k = 0; k < d.ns * d.mesh->n_elem; ++k)
    e->sigma_y[k] = 2.0 * e->sigma_y[k] - e->s.sigma[k];
  *y = e->w;
}

status goal_estimate_find(goal_estimator *e, const double *y, const double *tau,
                          int of_u, double *product, goal_estimate *out) {
  *out = (goal_estimate){0};
  set_adjoint(e, of_u, &y);
  for (int region = 0; region < e->n_region; ++region) {
    space_recover(e->recovery, region, e->s.d->ns, e->sigma_y, e->node_y);
    if (of_u && e->eigen != NULL)
      space_recover(e->recovery, region, e->s.d->ns, e->eigen, e->node_eigen);
    for (int k = 0; k < e->s.d->mesh->n_elem; ++k) {
      if (space_region(e->recovery, k) != region) continue;
      const double both = add_element(e, k, y, tau, of_u, out);
      if (product != NULL) product[k] = both;
      out->hoop += (of_u ? 0.5 : 1.0) * hoop_of(e, k, y);
    }
  }
  return OK;
}

void goal_estimator_adjoint_force(const goal_estimator *e, double *F) {
  domain_internal_force(e->s.d, e->sigma_y, F);
}
