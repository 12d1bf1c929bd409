/*
 * The list of friction laws and their common limit g = g0 + B p.
 */
#include "contact/friction.h"

#include "base/base.h"
#include "contact/average/average.h"
#include "contact/parts.h"

#include <strings.h>

/* ---- * No friction: the sliding limit is zero --------------------------- */

#define FRICTION_ROW(name) &name##_friction,
const friction_ops *const friction_list[] = {FRICTION_LIST(FRICTION_ROW) NULL};
const option friction_no_options[] = {OPTION_END};

const friction_ops *friction_find(const char *name) {
  for (int k = 0; friction_list[k] != NULL; ++k)
    if (strcasecmp(friction_list[k]->name, name) == 0) return friction_list[k];
  return NULL;
}

status friction_limit_new(int n, friction_limit *out) {
  memset(out, 0, sizeof *out);
  PASS_NEW(out->g0, n);
  return OK;
}

void friction_limit_free(friction_limit *limit) {
  if (limit == NULL) return;
  RELEASE(limit->g0, limit->in_zone);
  sparse_free(&limit->B);
  memset(limit, 0, sizeof *limit);
}

status friction_value(const friction_card *card, const contact_surface *s,
                      int i, double t, double *value) {
  double x[3] = {0.0};
  COPY(x, s->x + s->dim * i, s->dim);
  *value = quantity_value(&card->value, x, t);
  if (!(*value >= 0.0 && *value <= NUMBER_MOST))
    RAISE(ERR_DECK,
          "*FRICTION: value %g at node %zu (%g, %g, %g), time %g; expected a "
          "number that is not negative, up to 3e144",
          *value, s->node_no[i], x[0], x[1], x[2], t);
  return OK;
}

/* g = mu(x, t) times the normal force, or its average (card->average), in the
 * rows of node[n_node], which have none yet. */
static status friction_pressure_limit(const friction_card *card,
                                      const contact_surface *s, int n_node,
                                      const int *node, double t,
                                      friction_limit *out) {
  const sparse_rows *mean = card->average;
  const int most = (out->B.start == NULL ? 0 : out->B.start[s->n]) +
                   (mean == NULL ? n_node : mean->start[mean->n]);
  ENDS_BY(sparse_free) sparse_rows all = {.n = s->n};
  OWNED_NEW(double, mu, s->n);
  PASS_NEW_ALL(OF(all.start, s->n + 1), OF(all.col, most), OF(all.val, most));
  for (int i = 0; i < s->n; ++i) mu[i] = -1.0;
  for (int k = 0; k < n_node; ++k)
    if (!surface_is_corner(s, node[k]))
      PASS(friction_value(card, s, node[k], t, &mu[node[k]]));
  for (int i = 0, n = 0; i < s->n; ++i) {
    const int is_new = mu[i] >= 0.0;
    const sparse_rows *from = is_new ? mean : &out->B;
    if (from == NULL) {
      all.col[n] = i;
      all.val[n++] = mu[i];
    }
    for (int e = row_begin(from, i); e < row_end(from, i); ++e, ++n) {
      all.col[n] = from->col[e];
      all.val[n] = is_new ? mu[i] * from->val[e] : from->val[e];
    }
    all.start[i + 1] = n;
  }
  sparse_free(&out->B);
  out->B = all;
  all = (sparse_rows){0};
  return OK;
}

/*
 * Given sliding limit (Tresca): |sigma_T| <= g(x, t), per node g times the
 * tributary area. The problem of one pass of the fixed point (CPR98, 2.3).
 */

static status no_limit(const friction_card *card, const contact_surface *s,
                       int n_node, const int *node, double t,
                       friction_limit *out) {
  return OK;
}

const friction_ops none_friction = {
    .name = "NONE",
    .reference = "Cocu, Pratt, Raous 1998, (2.6) with F_T = 0",
    .help = "frictionless: the obstacle carries no tangential force",
    .options = friction_no_options,
    .limit = no_limit};

/*
 * Coulomb friction, local: |R_T| <= mu(x, t) p with the normal force p of the
 * same node, so that B is diagonal (CPR98, 2.6 with the identity for R).
 */

static status tresca_limit(const friction_card *card, const contact_surface *s,
                           int n_node, const int *node, double t,
                           friction_limit *out) {
  for (int k = 0; k < n_node; ++k) {
    int i = node[k];
    double g;
    if (surface_is_corner(s, i)) continue;
    PASS(friction_value(card, s, i, t, &g));
    out->g0[i] = g * s->area[i];
  }
  return OK;
}

const friction_ops tresca_friction = {
    .name = "TRESCA",
    .reference = "Cocu, Pratt, Raous 1998, problem (2.14) with given g",
    .help =
        "given sliding limit g(x, t), whatever the pressure, at open nodes too",
    .value_name = "g",
    .value_unit = "force/length^2",
    .options = friction_no_options,
    .limit = tresca_limit};

/*
 * Nonlocal Coulomb friction: |sigma_T| <= mu(x, t) R(p) with R the average of
 * the contact pressure by a kernel of radius rho (CPR98, 2.7).
 *
 * Nodal forces and pressures go together by the tributary areas, as in the
 * local law: p_j = -r_n,j / a_j and g_i = mu_i a_i R(p)(x_i), so that B_ij =
 * mu_i a_i G_ij / a_j with G of contact/average/average.h; G = 1 is local
 * friction. p is zero outside of the contact: at its edges R(p) is less than p.
 */

const friction_ops coulomb_friction = {
    .name = "COULOMB",
    .reference = "Cocu, Pratt, Raous 1998, (2.6) with R = identity",
    .help = "sliding limit mu(x, t) times the normal force of the node",
    .value_name = "mu",
    .value_unit = "-",
    .options = friction_no_options,
    .limit = friction_pressure_limit};

typedef struct nonlocal {
  double radius;                    /* rho, m */
  int kernel, edge, zone, distance; /* ranks of the words below */
  int mirror_x, mirror_y, mirror_z; /* average_mirror */
} nonlocal;

OPTIONS(
    nonlocal_options,
    OPTION_REAL(nonlocal, radius, "RADIUS", DBL_MIN, DBL_MAX, NULL, "length",
                "rho: the pressure is averaged over what is nearer"),
    OPTION_CHOICE(nonlocal, kernel, "KERNEL", KERNEL_WORDS, "BUMP",
                  "weight over the distance r" KERNEL_HELP),
    OPTION_CHOICE(nonlocal, edge, "EDGE", "FREE|NORMALIZED", "FREE",
                  "FREE: no pressure beyond the edges of the contact; "
                  "NORMALIZED: divide by the part of the weight inside"),
    OPTION_CHOICE(nonlocal, zone, "ZONE", "SURFACE|CONTACT", "SURFACE",
                  "SURFACE: friction also at separated points within RADIUS of "
                  "the pressed zone; CONTACT: at touching points only"),
    OPTION_CHOICE(nonlocal, distance, "DISTANCE", "STRAIGHT|GEODESIC",
                  "STRAIGHT", "r in space, or along the contact line (plane)"),
    OPTION_CHOICE(nonlocal, mirror_x, "MIRROR_X", "NONE|MIN|MAX", "NONE",
                  "plane of symmetry at the least or largest x of the contact: "
                  "the pressure goes on behind it as its mirror image"),
    OPTION_CHOICE(nonlocal, mirror_y, "MIRROR_Y", "NONE|MIN|MAX", "NONE",
                  "the same for y (z of an axisymmetric model)"),
    OPTION_CHOICE(nonlocal, mirror_z, "MIRROR_Z", "NONE|MIN|MAX", "NONE",
                  "the same for z in 3-D"));

/* The faces of a contact as a patch of the average. */
typedef struct patch {
  average_patch p;
  double *x;
  int *face;
  unsigned char *active;
  double *part;
  int *contact_node; /* [n_node] of the surface, or -1 */
  sparse_rows mean;  /* pressures at its nodes by those of the surface */
  int has_means;     /* 1: those of some are of other nodes */
} patch;

/* A node whose normal force belongs to another contact has none for this. */
static int carries(const contact_surface *s, int i, int contact_id) {
  return s->contact_id[i] == contact_id || !surface_is_corner(s, i);
}

/* A row of the matrix, by the nodes of the surface. */
typedef struct line {
  int n, *col;   /* its entries */
  double *value; /* [n] of the surface */
  int *in_row;   /* [n] the last row that had it, from 1 */
  int row;
} line;

static void add_to_line(line *l, int j, double value) {
  if (l->in_row[j] != l->row) {
    l->in_row[j] = l->row;
    l->value[j] = 0.0;
    l->col[l->n++] = j;
  }
  l->value[j] += value;
}

/* The masters of a node of *TIE in the contact, by their parts along its
 * normal: to a line, if any. Returns one of them, a node of the surface; -1:
 * none is in it. */
static int add_masters(const contact_surface *s, const surface_input *in,
                       int contact_id, int node_id, line *to) {
  const int tied = surface_tied(in, node_id), dim = s->dim;
  const node_links *l = tied < 0 ? NULL : &in->ties->to;
  int one = -1;
  if (l == NULL) return -1;
  for (size_t e = l->start[tied]; e < l->start[tied + 1]; ++e) {
    const int i = number_find(l->master[e], s->node_id, s->n);
    double part = 0.0;
    if (i < 0 || s->contact_id[i] != contact_id) continue;
    const double *normal = s->frame + dim * dim * i;
    for (int c = 0; c < dim; ++c)
      part += normal[c] * normal[c] * l->part[dim * e + c];
    if (!(part > 0.0)) continue;
    if (to != NULL) add_to_line(to, i, part);
    one = i;
  }
  return one;
}

/* Those that carry the part of a node of the front of a crack: the others on
 * its faces. */
static void add_others(const patch *a, int k, line *to) {
  const average_patch *p = &a->p;
  for (int f = 0; f < p->n_face; ++f) {
    const int *v = p->face + p->dim * f;
    int on = 0;
    for (int c = 0; c < p->dim; ++c) on |= v[c] == k;
    for (int c = 0; c < p->dim && on; ++c)
      if (a->contact_node[v[c]] >= 0)
        add_to_line(to, a->contact_node[v[c]], 1.0);
  }
}

/* The pressure at a node of the patch is a mean of those of the surface. */
static status find_means(const contact_surface *s, const surface_input *in,
                         int contact_id, patch *a) {
  const mesh_group *g = in->pairs[contact_id].group;
  const int is_crack = strcmp(in->pairs[contact_id].card, "*CRACK") == 0;
  int n = 0, cap[2] = {0, 0};
  OWNED double *value = NULL;
  OWNED int *col = NULL, *in_row = NULL;
  PASS_NEW_ALL(OF(value, s->n), OF(col, s->n), OF(in_row, s->n));
  line l = {0, col, value, in_row, 0};
  OWNS(a);
  PASS_NEW(a->mean.start, g->n_node + 1);
  a->mean.n = g->n_node;
  for (int k = 0; k < g->n_node; ++k) {
    double sum = 0.0;
    l.n = 0;
    l.row = k + 1;
    if (a->contact_node[k] >= 0)
      add_to_line(&l, a->contact_node[k], 1.0);
    else if (s->dim == 3 && surface_tied(in, g->node_id[k]) >= 0)
      add_masters(s, in, contact_id, g->node_id[k], &l);
    else if (is_crack)
      add_others(a, k, &l);
    if (a->contact_node[k] < 0) {
      a->active[k] = l.n > 0;
      a->has_means |= l.n > 0;
    }
    for (int e = 0; e < l.n; ++e) sum += value[col[e]];
    for (int e = 0; e < l.n; ++e) {
      PASS_GROW(a->mean.col, n, cap[0]);
      PASS_GROW(a->mean.val, n, cap[1]);
      a->mean.col[n] = col[e];
      a->mean.val[n++] = value[col[e]] / sum;
    }
    a->mean.start[k + 1] = n;
  }
  return OK;
}

/* A node of the patch. In the plane a node of *TIE is the only master of it in
 * the contact, so that lines go on there. */
static int patch_node(const contact_surface *s, const surface_input *in,
                      int contact_id, int node_id) {
  const mesh_group *g = in->pairs[contact_id].group;
  const int one =
      s->dim == 2 ? add_masters(s, in, contact_id, node_id, NULL) : -1;
  return number_find(one < 0 ? node_id : s->node_id[one], g->node_id,
                     g->n_node);
}

static status patch_new(const contact_surface *s, const surface_input *in,
                        int contact_id, patch *a) {
  const mesh *m = in->mesh;
  const mesh_group *g = in->pairs[contact_id].group;
  size_t dim = m->dim;
  OWNS(a);
  PASS_NEW_ALL(OF(a->x, dim * g->n_node), OF(a->face, m->dim * g->n_item),
               OF(a->active, g->n_node), OF(a->contact_node, g->n_node));
  if (s->covered != NULL) PASS_NEW(a->part, g->n_node);
  for (int k = 0, i = 0; k < g->n_node; ++k) {
    for (size_t c = 0; c < dim; ++c)
      a->x[dim * k + c] = m->x[dim * g->node_id[k] + c];
    while (i < s->n && s->node_id[i] < g->node_id[k]) ++i;
    int there = i < s->n && s->node_id[i] == g->node_id[k];
    a->contact_node[k] = there ? i : -1;
    a->active[k] = there && carries(s, i, contact_id);
    if (a->part != NULL) a->part[k] = there ? s->covered[i] : 1.0;
  }
  for (int k = 0; k < g->n_item; ++k)
    for (int c = 0; c < m->dim; ++c)
      a->face[m->dim * k + c] =
          patch_node(s, in, contact_id, m->face[m->dim * g->item_id[k] + c]);
  a->p = (average_patch){.dim = m->dim,
                         .axisymmetric = in->axisymmetric,
                         .n_node = g->n_node,
                         .n_face = g->n_item,
                         .x = a->x,
                         .face = a->face,
                         .active = a->active,
                         .part = a->part};
  return find_means(s, in, contact_id, a);
}

static void warn(double radius, const char *contact_name,
                 const average_facts *f, const place *at, message_log *log) {
  if (f->n_coarse == 0) return;
  message_add(log, P4013, at,
              "*FRICTION on contact %s: edges up to %.3g long, RADIUS/4 is "
              "%.3g; %d of %d nodes have a longer edge, friction is local at "
              "%d",
              contact_name, f->longest, 0.25 * radius, f->n_coarse, f->n_active,
              f->n_local);
}

/* Row k of G. */
static void set_line(const patch *a, const sparse_rows *G, int k, line *to) {
  to->n = 0;
  to->row = k + 1;
  for (int e = G->start[k]; e < G->start[k + 1]; ++e)
    for (int h = row_begin(&a->mean, G->col[e]);
         h < row_end(&a->mean, G->col[e]); ++h)
      add_to_line(to, a->mean.col[h], G->val[e] * a->mean.val[h]);
  if (a->has_means) qsort(to->col, to->n, sizeof *to->col, number_order);
}

/* Rows of the nodes whose friction is that of this contact, for forces: times
 * the tributary areas. */
static status to_surface(const contact_surface *s, int contact_id,
                         const patch *a, const sparse_rows *G,
                         sparse_rows *out) {
  int n = 0, cap[2] = {0, 0};
  OWNED double *value = NULL;
  OWNED int *col = NULL, *in_row = NULL;
  PASS_NEW_ALL(OF(out->start, s->n + 1), OF(value, s->n), OF(col, s->n),
               OF(in_row, s->n));
  line l = {0, col, value, in_row, 0};
  out->n = s->n;
  for (int k = 0; k < G->n; ++k) {
    int i = a->contact_node[k];
    if (i < 0 || s->contact_id[i] != contact_id) continue;
    set_line(a, G, k, &l);
    for (int e = 0; e < l.n; ++e) {
      const int j = col[e];
      PASS_GROW(out->col, n, cap[0]);
      PASS_GROW(out->val, n, cap[1]);
      out->col[n] = j;
      out->val[n++] = value[j] * (s->area[i] / s->area[j]);
    }
    out->start[i + 1] = n;
  }
  for (int i = 0; i < s->n; ++i)
    if (out->start[i + 1] < out->start[i]) out->start[i + 1] = out->start[i];
  return OK;
}

static status nonlocal_average(const friction_card *card,
                               const contact_surface *s,
                               const surface_input *in, int contact_id,
                               const place *at, message_log *log,
                               sparse_rows *out) {
  const nonlocal *own = card->param;
  const average_rule rule = {
      .kernel = (kernel)own->kernel,
      .radius = own->radius,
      .normalized = own->edge,
      .geodesic = own->distance,
      .mirror = {(average_mirror)own->mirror_x, (average_mirror)own->mirror_y,
                 (average_mirror)own->mirror_z}};
  OWNED_NEW(patch, a, 1);
  ENDS_BY(sparse_free) sparse_rows G = {.n = 0};
  average_facts facts;
  PASS(patch_new(s, in, contact_id, a));
  PASS(average_build(&a->p, &rule, &G, &facts));
  PASS(to_surface(s, contact_id, a, &G, out));
  warn(own->radius, in->pairs[contact_id].name, &facts, at, log);
  return OK;
}

static const char *nonlocal_misfit(const void *param, int dim,
                                   int axisymmetric) {
  const nonlocal *own = param;
  int mirrored = own->mirror_x || own->mirror_y || own->mirror_z;
  if (own->distance && (dim == 3 || axisymmetric))
    return "DISTANCE=GEODESIC is for plane models; use STRAIGHT";
  if (own->distance && mirrored)
    return "MIRROR_X, MIRROR_Y need DISTANCE=STRAIGHT";
  if (own->mirror_x && axisymmetric)
    return "MIRROR_X would mirror the radius; the axis needs no mirror";
  if (own->mirror_z && dim == 2) return "MIRROR_Z is for 3-D";
  return NULL;
}

static status nonlocal_limit(const friction_card *card,
                             const contact_surface *s, int n_node,
                             const int *node, double t, friction_limit *out) {
  const nonlocal *own = card->param;
  PASS(friction_pressure_limit(card, s, n_node, node, t, out));
  if (!own->zone) return OK;
  if (out->in_zone == NULL) PASS_NEW(out->in_zone, s->n);
  for (int k = 0; k < n_node; ++k) out->in_zone[node[k]] = 1;
  return OK;
}

const friction_ops nonlocal_friction = {
    .name = "NONLOCAL",
    .reference = "Cocu, Pratt, Raous 1998, (2.7)",
    .help = "sliding limit mu(x, t) times an average of the pressure around",
    .value_name = "mu",
    .value_unit = "-",
    .param_size = sizeof(nonlocal),
    .options = nonlocal_options,
    .misfit = nonlocal_misfit,
    .average = nonlocal_average,
    .limit = nonlocal_limit};
