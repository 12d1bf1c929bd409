/* src/fem/coupling.c and the stiffness of nodes that move with others: against
 * the definition of their displacements, row by row, and works by both. */
#include "fem/cluster/cluster.h"
#include "fem/stiffness.h"
#include "support/scene.h"
#include "support/unit.h"

/* Nodes of a grid that move with others, whatever their places: contact nodes
 * whose frames are oblique and whose components have parts of their own, and
 * tied nodes. */
enum { MOST = 4, ROWS = 8 };
typedef struct row {
  int node, n, master[MOST];
} row;

typedef struct linked {
  scene *s;
  node_links pair;
  tie_set ties;
  size_t start[2][ROWS + 1];
  int master[2][MOST * ROWS], tied[ROWS];
  double part[2][3 * MOST * ROWS], share[3 * ROWS];
  unsigned seed;
} linked;

static void set_links(linked *l, int which, const row *rows, node_links *to) {
  *to = (node_links){l->s->m->dim, 0, l->start[which], l->master[which],
                     l->part[which]};
  for (; rows[to->n].n >= 0; ++to->n) {
    const row *r = &rows[to->n];
    to->start[to->n + 1] = to->start[to->n] + (size_t)r->n;
    for (int e = 0; e < r->n; ++e) {
      const size_t at = to->start[to->n] + (size_t)e;
      to->master[at] = r->master[e];
      for (size_t c = 0; c < (size_t)to->dim; ++c)
        to->part[(size_t)to->dim * at + c] = scene_random(&l->seed);
    }
  }
}

/* Each row is divided by a number of its own. */
static void set_shares(linked *l) {
  contact_surface *s = &l->s->surface;
  const int dim = s->dim;
  for (int k = 0; k < dim * s->n; ++k) {
    l->share[k] = 1 + 0.5 * scene_random(&l->seed);
    for (int c = 0; c < dim; ++c) s->basis[dim * k + c] *= l->share[k];
  }
  s->share = l->share;
}

/* Both lists by node and with {.n = -1} at the end; pairs may be NULL. */
static void linked_new(linked *l, int dim, const row *pairs, const row *ties) {
  mesh *m = dim == 2 ? make_grid_2d((int[]){3, 3}, (double[]){3, 3})
                     : make_grid_3d((int[]){1, 1, 3}, (double[]){1, 1, 3});
  *l = (linked){.s = scene_new(m, dim == 2 ? PLANE_STRAIN : SOLID_3D, 1),
                .seed = 3};
  if (pairs != NULL) {
    mesh_group *g = &m->group[0];
    for (g->n_node = 0; pairs[g->n_node].n >= 0; ++g->n_node)
      g->node_id[g->n_node] = pairs[g->n_node].node;
    scene_contact(l->s, "BODY", (double[]){0.6, -0.8, 0}, 0.3);
    set_links(l, 0, pairs, &l->pair);
    l->s->surface.master = &l->pair;
    set_shares(l);
  }
  set_links(l, 1, ties, &l->ties.to);
  l->ties.n = l->ties.to.n;
  l->ties.node_id = l->tied;
  for (int q = 0; q < l->ties.n; ++q) l->tied[q] = ties[q].node;
  if (l->ties.n > 0) l->s->d.ties = &l->ties;
}

/* Chains of up to four, against and along the order of the nodes, two ways to
 * one master, a contact node without any. */
static const row pairs[] = {{0, 3, {5, 9, 10}}, {1, 2, {2, 6}}, {2, 2, {3, 9}},
                            {3, 1, {14}},       {12, 0, {0}},   {.n = -1}};
static const row ties[] = {
    {4, 3, {0, 8, 9}}, {7, 2, {4, 1}}, {11, 1, {12}}, {.n = -1}};
static const row none[] = {{.n = -1}};

static double *randoms(linked *l, size_t n) {
  double *v = calloc(n, sizeof *v);
  for (size_t i = 0; i < n; ++i) v[i] = scene_random(&l->seed);
  return v;
}

static size_t dofs(const linked *l) {
  return (size_t)(l->s->m->dim * l->s->m->n_node);
}

/* The relative displacements of u are those of v alone. */
static void check_rows(const linked *l, const double *u, const double *v) {
  const contact_surface *s = &l->s->surface;
  const node_links *t = &l->ties.to;
  const int dim = l->s->m->dim;
  double w[3 * ROWS];
  char moved[100] = {0};
  surface_relative(s, u, w);
  for (int q = 0; q < s->n; ++q)
    for (int a = 0; a < dim; ++a) {
      double own = 0;
      for (int c = 0; c < dim; ++c)
        own += s->frame[dim * (dim * q + a) + c] * v[dim * s->node_id[q] + c];
      ck_assert_double_eq_tol(w[dim * q + a], own / s->share[dim * q + a],
                              1e-14);
      moved[s->node_id[q]] = 1;
    }
  for (int q = 0; q < t->n; ++q)
    for (int c = 0; c < dim; ++c) {
      double own = u[dim * l->tied[q] + c];
      for (size_t e = t->start[q]; e < t->start[q + 1]; ++e)
        own -= t->part[(size_t)dim * e + (size_t)c] * u[dim * t->master[e] + c];
      ck_assert_double_eq_tol(own, v[dim * l->tied[q] + c], 1e-14);
      moved[l->tied[q]] = 1;
    }
  for (int k = 0; k < dim * l->s->m->n_node; ++k)
    if (!moved[k / dim]) ck_assert_double_eq(u[k], v[k]);
}

TESTS(displacements_are_relative_to_the_masters, 4) {
  linked l;
  OWNED coupling *c = NULL;
  linked_new(&l, 2 + _i % 2, pairs, _i < 2 ? none : ties);
  const size_t n = dofs(&l);
  FREED double *v = randoms(&l, n), *u = calloc(n, sizeof *u);
  memcpy(u, v, n * sizeof *u);
  ck_assert_int_eq(coupling_new(&l.s->d, &c), OK);
  ck_assert_int_eq(c->n, _i < 2 ? 4 : 7);
  coupling_move(c, u);
  check_rows(&l, u, v);
  scene_free(l.s);
}

TESTS(loads_do_the_same_work_on_the_unknowns, 4) {
  linked l;
  OWNED coupling *c = NULL;
  linked_new(&l, 2 + _i % 2, pairs, _i < 2 ? none : ties);
  const size_t n = dofs(&l);
  double *v = randoms(&l, n), *F = randoms(&l, n), work = 0, moved = 0;
  FREED double *u = calloc(n, sizeof *u), *to = calloc(n, sizeof *to);
  memcpy(u, v, n * sizeof *u);
  memcpy(to, F, n * sizeof *to);
  ck_assert_int_eq(coupling_new(&l.s->d, &c), OK);
  coupling_move(c, u);
  coupling_load(c, to);
  for (size_t i = 0; i < n; ++i) {
    work += F[i] * u[i];
    moved += to[i] * v[i];
  }
  ck_assert_double_eq_tol(moved, work, 1e-13);
  free(F);
  free(v);
  scene_free(l.s);
}

/* Against the basis: the same at all others, nothing left at tied nodes but
 * where a support holds a component. */
TESTS(tied_nodes_pass_on_what_acts_on_them, 2) {
  linked l;
  OWNED coupling *c = NULL;
  linked_new(&l, 2 + _i, NULL, ties);
  const size_t n = dofs(&l), dim = (size_t)(2 + _i);
  const size_t held = dim * 4 + 1; /* the first tied node, of three masters */
  for (size_t e = 0; e < 3; ++e) l.part[1][dim * e + 1] = 0;
  FREED double *F = randoms(&l, n), *to = calloc(n, sizeof *to);
  memcpy(to, F, n * sizeof *to);
  ck_assert_int_eq(coupling_new(&l.s->d, &c), OK);
  coupling_load(c, to);
  ties_share(&l.ties, F);
  for (size_t i = 0; i < n; ++i) {
    const int tied = c->of[i / dim] >= 0 && i != held;
    ck_assert_double_eq_tol(F[i], tied ? 0 : to[i], 1e-14);
  }
  scene_free(l.s);
}

/* a'K b of the lower triangle. */
static double form(const stiffness *k, const double *a, const double *b) {
  const int dim = k->dim;
  double sum = 0;
  for (int j = 0; j < k->n_node; ++j)
    for (size_t p = k->start[j]; p < k->start[j + 1]; ++p)
      for (int s = 0; s < dim; ++s)
        for (int r = 0; r < dim; ++r) {
          const int i = k->row[p];
          const double K =
              k->block[(size_t)(dim * dim) * p + (size_t)(dim * s + r)];
          sum += a[dim * i + r] * K * b[dim * j + s];
          if (i != j) sum += a[dim * j + s] * K * b[dim * i + r];
        }
  return sum;
}

/* The unknowns of v: contact nodes in their frames. */
static double *in_frames(const linked *l, const double *v) {
  const contact_surface *s = &l->s->surface;
  const int dim = l->s->m->dim;
  double *a = calloc(dofs(l), sizeof *a);
  memcpy(a, v, dofs(l) * sizeof *a);
  for (int q = 0; q < s->n; ++q)
    for (int r = 0; r < dim; ++r) {
      double *to = &a[dim * s->node_id[q] + r];
      *to = 0;
      for (int c = 0; c < dim; ++c)
        *to += s->frame[dim * (dim * q + r) + c] * v[dim * s->node_id[q] + c] /
               s->share[dim * q + r];
    }
  return a;
}

/* Elements alone, and with changes of volume that are averaged. */
TESTS(stiffness_does_the_same_work_on_the_unknowns, 4) {
  linked l;
  OWNED cluster_set *clusters = NULL;
  stiffness *plain, *k;
  linked_new(&l, 2 + _i % 2, pairs, ties);
  const cluster_input in = {l.s->m, 0, 1, l.s->section_id, (double[]){0.7}};
  if (_i > 1) ck_assert_int_eq(cluster_new(&in, &clusters), OK);
  l.s->d.cluster = clusters;
  domain alone = l.s->d;
  alone.surface = NULL;
  alone.ties = NULL;
  ck_assert_int_eq(stiffness_assemble(&alone, &plain), OK);
  ck_assert_int_eq(stiffness_assemble(&l.s->d, &k), OK);
  const size_t n = dofs(&l);
  for (int t = 0; t < 5; ++t) {
    double *v[2], *a[2];
    for (int i = 0; i < 2; ++i) {
      v[i] = randoms(&l, n);
      a[i] = in_frames(&l, v[i]);
      coupling_move(k->moved, v[i]);
    }
    const double work = form(plain, v[0], v[1]);
    ck_assert_double_eq_tol(form(k, a[0], a[1]), work, 1e-11);
    for (int i = 0; i < 2; ++i) {
      free(v[i]);
      free(a[i]);
    }
  }
  memory_free(plain);
  memory_free(k);
  scene_free(l.s);
}

TEST(nodes_that_move_with_each_other_are_an_error) {
  static const row circle[] = {
      {2, 1, {6}}, {3, 2, {1, 2}}, {6, 2, {0, 3}}, {.n = -1}};
  linked l;
  OWNED coupling *c = NULL;
  linked_new(&l, 2, NULL, circle);
  ck_assert_int_eq(coupling_new(&l.s->d, &c), ERR_MESH);
  ck_assert_ptr_nonnull(strstr(status_message(), "node 7 moves with"));
  scene_free(l.s);
}

UNIT_MAIN("coupling")
