/* Domains for tests; memory failures end the test program. */
#include "support/scene.h"

#include "base/base.h"

static void *get(size_t n, size_t size) {
  void *p = calloc(n + 1, size);
  if (p == NULL) abort();
  return p;
}

scene *scene_new(mesh *m, kinematics kin, double young) {
  char why[160];
  scene *s = get(1, sizeof *s);
  if (m == NULL) abort();
  s->m = m;
  s->section_id = get((size_t)m->n_elem, sizeof *s->section_id);
  s->fixed = get((size_t)(m->dim * m->n_node), 1);
  s->kin[0] = kin;
  s->thickness[0] = 1;
  if (elastic_matrix(ELASTIC_ISO, 2, (double[]){young, 0.3}, s->C, why, 160))
    abort();
  elastic_reduce(s->C, kin, s->E);
  s->d = (domain){.mesh = m,
                  .ns = m->dim == 3 ? 6 : 4,
                  .section_id = s->section_id,
                  .kin = s->kin,
                  .thickness = s->thickness,
                  .E = s->E,
                  .C = s->C,
                  .fixed = s->fixed};
  return s;
}

void scene_free(scene *s) {
  contact_surface *c = &s->surface;
  free(c->node_id);
  free(c->contact_id);
  free(c->side_id);
  free(c->x);
  free(c->area);
  free(c->frame);
  free(c->basis);
  free(c->gap0);
  free(c->held);
  free(s->section_id);
  free(s->fixed);
  memory_free(s->m);
  free(s);
}

void scene_leave(scene *const *s) { scene_free(*s); }

static const mesh_group *find(const scene *s, const char *group) {
  for (int g = 0; g < s->m->n_group; ++g)
    if (strcmp(s->m->group[g].name, group) == 0) return &s->m->group[g];
  abort();
}

void scene_fix_node(scene *s, int node_id, int c) {
  s->fixed[s->m->dim * node_id + c] = 1;
}

void scene_fix(scene *s, const char *group, int c) {
  const mesh_group *g = find(s, group);
  for (int i = 0; i < g->n_node; ++i) scene_fix_node(s, g->node_id[i], c);
}

/* Inverse of rows [dim*dim] (row major) as a column major matrix. */
static void invert(int dim, const double *a, double *b) {
  if (dim == 2) {
    const double det = a[0] * a[3] - a[1] * a[2];
    b[0] = a[3] / det;
    b[1] = -a[2] / det;
    b[2] = -a[1] / det;
    b[3] = a[0] / det;
    return;
  }
  double det = 0;
  for (int k = 0; k < 3; ++k) {
    const double *p = a + 3 * ((k + 1) % 3), *q = a + 3 * ((k + 2) % 3);
    for (int c = 0; c < 3; ++c) {
      const int i = (c + 1) % 3, j = (c + 2) % 3;
      b[3 * k + c] = p[i] * q[j] - p[j] * q[i];
    }
  }
  for (int c = 0; c < 3; ++c) det += a[c] * b[c];
  for (int i = 0; i < 9; ++i) b[i] /= det;
}

void scene_frame(scene *s, int q, const double *rows) {
  const int dim = s->m->dim;
  memcpy(s->surface.frame + dim * dim * q, rows,
         (size_t)(dim * dim) * sizeof *rows);
  invert(dim, rows, s->surface.basis + dim * dim * q);
}

static void make_frame(int dim, const double *n, double slant, double *rows) {
  memcpy(rows, n, (size_t)dim * sizeof *n);
  if (dim == 2) {
    rows[2] = -n[1] + slant * n[0];
    rows[3] = n[0] + slant * n[1];
    return;
  }
  const int a = fabs(n[0]) < 0.9 ? 0 : 1;
  double *t1 = rows + 3, *t2 = rows + 6, norm = 0;
  for (int c = 0; c < 3; ++c) t1[c] = (c == a) - n[a] * n[c];
  for (int c = 0; c < 3; ++c) norm += t1[c] * t1[c];
  for (int c = 0; c < 3; ++c) t1[c] /= sqrt(norm);
  for (int c = 0; c < 3; ++c) {
    const int i = (c + 1) % 3, j = (c + 2) % 3;
    t2[c] = n[i] * t1[j] - n[j] * t1[i];
  }
  for (int c = 0; c < 3; ++c) t1[c] += slant * n[c];
}

void scene_contact(scene *s, const char *group, const double *n, double slant) {
  const mesh_group *g = find(s, group);
  contact_surface *c = &s->surface;
  const int dim = s->m->dim, old = c->n;
  const size_t most = (size_t)(c->n + g->n_node), d = (size_t)dim;
  contact_surface all = {.dim = dim};
  all.node_id = get(most, sizeof *all.node_id);
  all.contact_id = get(most, sizeof *all.contact_id);
  all.side_id = get(most * d, sizeof *all.side_id);
  all.x = get(most * d, sizeof *all.x);
  all.area = get(most, sizeof *all.area);
  all.frame = get(most * d * d, sizeof *all.frame);
  all.basis = get(most * d * d, sizeof *all.basis);
  all.gap0 = get(most, sizeof *all.gap0);
  all.held = get(most * d, 1);
  for (int i = 0, p = 0, q = 0; p < old || q < g->n_node;) {
    const int take_old =
        q == g->n_node || (p < old && c->node_id[p] <= g->node_id[q]);
    all.node_id[i] = take_old ? c->node_id[p] : g->node_id[q];
    for (int t = 0; t < dim - 1; ++t) all.side_id[(dim - 1) * i + t] = -1;
    double *f = all.frame + dim * dim * i;
    if (take_old) {
      memcpy(f, c->frame + dim * dim * p, d * d * sizeof *f);
      memcpy(all.held + dim * i, c->held + dim * p, d);
      if (q < g->n_node && c->node_id[p] == g->node_id[q]) ++q;
      ++p;
    } else {
      make_frame(dim, n, slant, f);
      ++q;
    }
    invert(dim, f, all.basis + dim * dim * i);
    memcpy(all.x + dim * i, s->m->x + dim * all.node_id[i], d * sizeof *all.x);
    all.area[i] = 1;
    all.n = ++i;
  }
  contact_surface before = *c;
  *c = all;
  s->d.surface = c;
  free(before.node_id);
  free(before.contact_id);
  free(before.side_id);
  free(before.x);
  free(before.area);
  free(before.frame);
  free(before.basis);
  free(before.gap0);
  free(before.held);
}

double scene_random(unsigned *seed) {
  *seed = *seed * 1664525u + 1013904223u;
  return (double)(*seed >> 8) / (double)(1 << 23) - 1;
}

void scene_unknowns(const scene *s, unsigned char *unknown) {
  const int dim = s->m->dim;
  for (int i = 0; i < dim * s->m->n_node; ++i) unknown[i] = !s->fixed[i];
  for (int q = 0; q < dim * s->surface.n; ++q)
    unknown[dim * s->surface.node_id[q / dim] + q % dim] = !s->surface.held[q];
}

static void add_dense_element(const scene *s, int e, size_t N, double *K) {
  const int dim = s->m->dim, ns = s->d.ns, n = dim * (dim + 1);
  double B[6 * 12], S[6 * 12];
  const double w = element_strain(&s->d, e, B);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < ns; ++i) {
      S[ns * j + i] = 0;
      for (int k = 0; k < ns; ++k)
        S[ns * j + i] += s->E[ns * k + i] * B[ns * j + k];
    }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int *v = s->m->elem + (dim + 1) * e;
      const size_t row = (size_t)(dim * v[i / dim] + i % dim);
      const size_t col = (size_t)(dim * v[j / dim] + j % dim);
      for (int k = 0; k < ns; ++k)
        K[row + N * col] += w * B[ns * i + k] * S[ns * j + k];
    }
}

void scene_dense(const scene *s, double *K) {
  const int dim = s->m->dim;
  const size_t N = (size_t)(dim * s->m->n_node);
  memset(K, 0, N * N * sizeof *K);
  for (int e = 0; e < s->m->n_elem; ++e) add_dense_element(s, e, N, K);
  for (int q = 0; q < s->surface.n; ++q) {
    const double *T = s->surface.basis + dim * dim * q;
    const size_t at = (size_t)(dim * s->surface.node_id[q]);
    for (int side = 0; side < 2; ++side)
      for (size_t j = 0; j < N; ++j) {
        double v[3] = {0};
        const size_t step = side ? N : 1,
                     first = side ? j + N * at : at + N * j;
        for (int a = 0; a < dim; ++a)
          for (int b = 0; b < dim; ++b)
            v[a] += T[dim * a + b] * K[first + step * (size_t)b];
        for (int a = 0; a < dim; ++a) K[first + step * (size_t)a] = v[a];
      }
  }
}

scene *scene_two_bodies(void) {
  OWNED mesh *a = make_grid_2d((int[]){3, 3}, (double[]){1, 1});
  mesh *b = grid_join(a, a, (double[]){2, 0.25});
  scene *s = scene_new(b, PLANE_STRAIN, 2);
  const int contact[] = {1, 2, 17, 18, 19}; /* feet of both */
  b->group[0].n_node = 5;
  memcpy(b->group[0].node_id, contact, sizeof contact);
  scene_contact(s, "BODY", (double[]){0, -1}, 0);
  for (int c = 0; c < 2; ++c) {
    scene_fix_node(s, 12, c);
    scene_fix_node(s, 15, c);
  }
  scene_fix_node(s, 16, 0);
  return s;
}

scene *scene_floating_3d(void) {
  scene *s = scene_new(make_grid_3d((int[]){3, 2, 2}, (double[]){1, 1, 2}),
                       SOLID_3D, 5);
  scene_contact(s, "FRONT", (double[]){0, 0, -1}, 0);
  return s;
}

status scene_whole_way(const domain *d, double *work, double *condition) {
  OWNED stiffness *k = NULL;
  condensed *c = NULL;
  const int n = d->mesh->dim * d->mesh->n_node;
  status st = stiffness_assemble(d, &k);
  if (st == OK) st = condense(k, d, &c);
  if (st == OK) st = condense_load(c, work, NULL, work + n);
  if (st == OK) st = condense_recover(c, work + n, work + 2 * n);
  if (st == OK && condition != NULL) *condition = condensed_condition(c);
  condensed_free(c);
  return st;
}
