/*
 * Nonlocal Coulomb friction: |sigma_T| <= mu(x, t) R(p) with R the average of
 * the contact pressure by a kernel of radius rho (CPR98, 2.7).
 *
 * Nodal forces and pressures go together by the tributary areas, as in the
 * local law: p_j = -r_n,j / a_j and g_i = mu_i a_i R(p)(x_i), so that
 * B_ij = mu_i a_i G_ij / a_j with G of contact/average/average.h; G = 1 is
 * local friction. p is zero outside of the contact: at its edges R(p) is less
 * than p.
 */
#include "contact/average/average.h"
#include "base/memory.h"
#include "contact/friction.h"

#include <float.h>

typedef struct nonlocal {
  double radius;                    /* rho, m */
  int kernel, edge, zone, distance; /* ranks of the words below */
  int mirror_x, mirror_y, mirror_z; /* average_mirror */
} nonlocal;

/* clang-format off */
static const option nonlocal_options[] = {
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
                "the same for z in 3-D"),
  OPTION_END
};
/* clang-format on */

/* The faces of a contact as a patch of the average. */
typedef struct patch {
  average_patch p;
  double *x;
  int *face;
  unsigned char *active;
  int *contact_node; /* [n_node] of the surface, or -1 */
} patch;

static void patch_free(patch *a) {
  RELEASE(a->x, a->face, a->active, a->contact_node);
}

/* Place of a mesh node in the group, whose ids ascend. */
static int place_in(const mesh_group *g, int node_id) {
  int first = 0, last = g->n_node - 1;
  while (first < last) {
    int half = first + (last - first) / 2;
    if (g->node_id[half] < node_id)
      first = half + 1;
    else
      last = half;
  }
  return first;
}

/* A node whose normal force belongs to another contact has none for this. */
static int carries(const contact_surface *s, int i, int contact_id) {
  return s->contact_id[i] == contact_id || !surface_is_corner(s, i);
}

static status patch_new(const contact_surface *s, const surface_input *in,
                        int contact_id, patch *a) {
  const mesh *m = in->mesh;
  const mesh_group *g = in->pairs[contact_id].group;
  size_t dim = (size_t)m->dim;
  PASS_NEW(a->x, dim * (size_t)g->n_node);
  PASS_NEW(a->face, m->dim * g->n_item);
  PASS_NEW(a->active, g->n_node);
  PASS_NEW(a->contact_node, g->n_node);
  for (int k = 0, i = 0; k < g->n_node; ++k) {
    for (size_t c = 0; c < dim; ++c)
      a->x[dim * (size_t)k + c] = m->x[dim * (size_t)g->node_id[k] + c];
    while (i < s->n && s->node_id[i] < g->node_id[k]) ++i;
    int there = i < s->n && s->node_id[i] == g->node_id[k];
    a->contact_node[k] = there ? i : -1;
    a->active[k] = (unsigned char)(there && carries(s, i, contact_id));
  }
  for (int k = 0; k < g->n_item; ++k)
    for (int c = 0; c < m->dim; ++c)
      a->face[m->dim * k + c] =
          place_in(g, m->face[m->dim * g->item_id[k] + c]);
  a->p = (average_patch){.dim = m->dim,
                         .axisymmetric = in->axisymmetric,
                         .n_node = g->n_node,
                         .n_face = g->n_item,
                         .x = a->x,
                         .face = a->face,
                         .active = a->active};
  return OK;
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

/* Rows of the nodes whose friction is that of this contact, for forces: times
 * the tributary areas. */
static status to_surface(const contact_surface *s, int contact_id,
                         const patch *a, const sparse_rows *G,
                         sparse_rows *out) {
  status st = OK;
  int n = 0;
  NEW(out->start, s->n + 1);
  NEW(out->col, G->start[G->n]);
  NEW(out->val, G->start[G->n]);
  out->n = s->n;
  for (int k = 0; k < G->n; ++k) {
    int i = a->contact_node[k];
    if (i < 0 || s->contact_id[i] != contact_id) continue;
    for (int e = G->start[k]; e < G->start[k + 1]; ++e) {
      int j = a->contact_node[G->col[e]];
      out->col[n] = j;
      out->val[n++] = G->val[e] * (s->area[i] / s->area[j]);
    }
    out->start[i + 1] = n;
  }
  for (int i = 0; i < s->n; ++i)
    if (out->start[i + 1] < out->start[i]) out->start[i + 1] = out->start[i];
done:
  return st;
}

static status nonlocal_average(const friction_card *card,
                               const contact_surface *s,
                               const surface_input *in, int contact_id,
                               const place *at, message_log *log,
                               sparse_rows *out) {
  status st = OK;
  const nonlocal *own = card->param;
  const average_rule rule = {
      .kernel = (kernel)own->kernel,
      .radius = own->radius,
      .normalized = own->edge,
      .geodesic = own->distance,
      .mirror = {(average_mirror)own->mirror_x, (average_mirror)own->mirror_y,
                 (average_mirror)own->mirror_z}};
  patch a = {.x = NULL};
  sparse_rows G = {.n = 0};
  average_facts facts;
  TRY(patch_new(s, in, contact_id, &a));
  TRY(average_build(&a.p, &rule, &G, &facts));
  TRY(to_surface(s, contact_id, &a, &G, out));
  warn(own->radius, in->pairs[contact_id].name, &facts, at, log);
done:
  sparse_free(&G);
  patch_free(&a);
  return st;
}

static const char *nonlocal_misfit(const void *param, int dim,
                                   int axisymmetric) {
  const nonlocal *own = param;
  int mirrors = own->mirror_x || own->mirror_y || own->mirror_z;
  if (own->distance && (dim == 3 || axisymmetric))
    return "DISTANCE=GEODESIC is for plane models; use STRAIGHT";
  if (own->distance && mirrors)
    return "MIRROR_X, MIRROR_Y need DISTANCE=STRAIGHT";
  if (own->mirror_x && axisymmetric)
    return "MIRROR_X would mirror the radius; the axis needs no mirror";
  if (own->mirror_z && dim == 2) return "MIRROR_Z is for 3-D";
  return NULL;
}

static status nonlocal_limit(const friction_card *card,
                             const contact_surface *s, int n_node,
                             const int *node, double t, friction_limit *out) {
  status st = OK;
  const nonlocal *own = card->param;
  TRY(friction_pressure_limit(card, s, n_node, node, t, out));
  if (!own->zone) goto done;
  if (out->in_zone == NULL) NEW(out->in_zone, s->n);
  for (int k = 0; k < n_node; ++k) out->in_zone[node[k]] = 1;
done:
  return st;
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
