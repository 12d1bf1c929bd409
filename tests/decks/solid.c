/*
 * Bodies of triangles or tetrahedra on a grid.
 */
#include "decks/deck.h"

#include "base/base.h"

static void *grow(void *p, size_t n, size_t size) {
  p = realloc(p, (n + 1) * size);
  if (p == NULL) abort();
  return p;
}

static int add_group(solid *s, const char *name, int dim, int body) {
  char full[32];
  snprintf(full, sizeof full, "%s%d", name, body + 1);
  for (int g = 0; g < s->n_group; ++g)
    if (strcmp(s->group[g].name, full) == 0) return g;
  solid_group *g = &s->group[s->n_group];
  memcpy(g->name, full, sizeof full);
  g->dim = dim;
  g->body = body;
  return s->n_group++;
}

int solid_find(const solid *s, const char *name) {
  for (int g = 0; g < s->n_group; ++g)
    if (strcmp(s->group[g].name, name) == 0) return g;
  abort();
}

int solid_in(const solid *s, int group, int node) {
  int faces = s->group[group].dim < s->dim, per = s->dim + !faces;
  const int *item = faces ? s->face : s->elem;
  const int *of = faces ? s->face_group : s->elem_group;
  for (int k = 0; k < (faces ? s->n_face : s->n_elem); ++k)
    for (int v = 0; of[k] == group && v < per; ++v)
      if (item[per * k + v] == node) return 1;
  return 0;
}

/* A grid that is being added. */
typedef struct grid {
  solid *s;
  const solid_plan *p;
  int body, first;
} grid;

static int node_at(const grid *g, int i, int j, int k) {
  return g->first + i + (g->p->n[0] + 1) * (j + (g->p->n[1] + 1) * k);
}

/* The axis that points up is the last. */
static void place(const grid *g, const int *ijk, random_source *r, double *x) {
  const solid_plan *p = g->p;
  int up = p->dim - 1, inside = 1;
  double side = 0;
  for (int c = 0; c < p->dim; ++c) inside &= ijk[c] > 0 && ijk[c] < p->n[c];
  for (int c = 0; c < p->dim; ++c) {
    double move = random_real(r, -1, 1) * p->shake;
    double at = ijk[c] + (inside ? move : 0.0);
    x[c] = p->length[c] * at / p->n[c];
    if (c < up) side += pow(2.0 * ijk[c] / p->n[c] - 1.0, 2);
  }
  x[up] += p->bend * side * (1.0 - (double)ijk[up] / p->n[up]);
  for (int c = 0; c < p->dim; ++c) x[c] += p->at[c];
}

static void add_nodes(grid *g, random_source *r) {
  const int *n = g->p->n, dim = g->p->dim;
  int last = dim == 3 ? n[2] : 0, ijk[3];
  g->first = g->s->n_node;
  for (ijk[2] = 0; ijk[2] <= last; ++ijk[2])
    for (ijk[1] = 0; ijk[1] <= n[1]; ++ijk[1])
      for (ijk[0] = 0; ijk[0] <= n[0]; ++ijk[0]) {
        size_t at = (size_t)(dim * g->s->n_node++);
        g->s->x = grow(g->s->x, at + 3, sizeof(double));
        place(g, ijk, r, g->s->x + at);
      }
}

static void add_element(grid *g, const int *node, int upper) {
  solid *s = g->s;
  int per = s->dim + 1;
  size_t n = (size_t)s->n_elem++;
  s->elem = grow(s->elem, (size_t)per * (n + 1), sizeof(int));
  s->elem_group = grow(s->elem_group, n + 1, sizeof(int));
  memcpy(s->elem + (size_t)per * n, node, (size_t)per * sizeof(int));
  s->elem_group[n] =
      add_group(s, g->p->layers && upper ? "UPPER" : "BODY", s->dim, g->body);
}

static void add_face(grid *g, const int *node, const char *name) {
  solid *s = g->s;
  size_t dim = (size_t)s->dim, n = (size_t)s->n_face++;
  s->face = grow(s->face, dim * (n + 1), sizeof(int));
  s->face_group = grow(s->face_group, n + 1, sizeof(int));
  memcpy(s->face + dim * n, node, dim * sizeof(int));
  s->face_group[n] = add_group(s, name, s->dim - 1, g->body);
}

static void fill_2d(grid *g) {
  const int *n = g->p->n;
  for (int j = 0; j < n[1]; ++j)
    for (int i = 0; i < n[0]; ++i) {
      int c[4] = {node_at(g, i, j, 0), node_at(g, i + 1, j, 0),
                  node_at(g, i + 1, j + 1, 0), node_at(g, i, j + 1, 0)};
      int t = (i + j) % 2, upper = 2 * j >= n[1];
      add_element(g, (int[]){c[t], c[t + 1], c[t + 2]}, upper);
      add_element(g, (int[]){c[t], c[t + 2], c[(t + 3) % 4]}, upper);
    }
  for (int i = 0; i < n[0]; ++i) {
    add_face(g, (int[]){node_at(g, i, 0, 0), node_at(g, i + 1, 0, 0)}, "FOOT");
    add_face(g, (int[]){node_at(g, i + 1, n[1], 0), node_at(g, i, n[1], 0)},
             "TOP");
  }
  for (int j = 0; j < n[1]; ++j) {
    add_face(g, (int[]){node_at(g, 0, j + 1, 0), node_at(g, 0, j, 0)}, "LEFT");
    add_face(g, (int[]){node_at(g, n[0], j, 0), node_at(g, n[0], j + 1, 0)},
             j == 0 ? "HEEL" : "RIGHT");
  }
}

/* The six tetrahedra of Kuhn along the diagonal of the cell. */
static void fill_cell(grid *g, const int *ijk) {
  static const int axis[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1},
                                 {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  for (int p = 0; p < 6; ++p) {
    int at[3] = {ijk[0], ijk[1], ijk[2]}, node[4];
    for (int v = 0; v < 4; ++v) {
      node[v] = node_at(g, at[0], at[1], at[2]);
      if (v < 3) ++at[axis[p][v]];
    }
    int turned = p >= 3, b = node[1];
    if (turned) node[1] = node[2], node[2] = b;
    add_element(g, node, 2 * ijk[2] >= g->p->n[2]);
  }
}

/* Two triangles of a cell of a side, outward. */
static void fill_side(grid *g, int axis, int end, const char *name) {
  const int *n = g->p->n;
  int p = (axis + 1) % 3, q = (axis + 2) % 3;
  for (int j = 0; j < n[q]; ++j)
    for (int i = 0; i < n[p]; ++i) {
      int v[4], c[3];
      const char *own = axis == 0 && end && j == 0 ? "HEEL" : name;
      for (int k = 0; k < 4; ++k) {
        c[axis] = end ? n[axis] : 0;
        c[p] = i + (k == 1 || k == 2);
        c[q] = j + (k >= 2);
        v[k] = node_at(g, c[0], c[1], c[2]);
      }
      add_face(g, (int[]){v[0], v[end ? 1 : 2], v[end ? 2 : 1]}, own);
      add_face(g, (int[]){v[0], v[end ? 2 : 3], v[end ? 3 : 2]}, own);
    }
}

static void fill_3d(grid *g) {
  static const char *const name[3][2] = {
      {"LEFT", "RIGHT"}, {"FRONT", "BACK"}, {"FOOT", "TOP"}};
  int ijk[3];
  for (ijk[2] = 0; ijk[2] < g->p->n[2]; ++ijk[2])
    for (ijk[1] = 0; ijk[1] < g->p->n[1]; ++ijk[1])
      for (ijk[0] = 0; ijk[0] < g->p->n[0]; ++ijk[0]) fill_cell(g, ijk);
  for (int axis = 0; axis < 3; ++axis)
    for (int end = 0; end < 2; ++end) fill_side(g, axis, end, name[axis][end]);
}

/* 1: all nodes of the face are nodes of the element. */
static int has_face(const solid *s, int e, const int *face) {
  for (int k = 0; k < s->dim; ++k) {
    int there = 0;
    for (int v = 0; v <= s->dim; ++v)
      there |= s->elem[(s->dim + 1) * e + v] == face[k];
    if (!there) return 0;
  }
  return 1;
}

static void find_face_elements(solid *s) {
  s->face_elem = grow(s->face_elem, (size_t)s->n_face, sizeof(int));
  for (int f = 0; f < s->n_face; ++f) {
    int e = 0;
    while (!has_face(s, e, s->face + s->dim * f)) ++e;
    s->face_elem[f] = e;
  }
}

void solid_add(solid *s, const solid_plan *p, int body, random_source *r) {
  grid g = {.s = s, .p = p, .body = body};
  s->dim = p->dim;
  add_nodes(&g, r);
  if (p->dim == 2)
    fill_2d(&g);
  else
    fill_3d(&g);
  find_face_elements(s);
}

void solid_free(solid *s) {
  free(s->x);
  free(s->elem);
  free(s->elem_group);
  free(s->face);
  free(s->face_group);
  free(s->face_elem);
  memset(s, 0, sizeof *s);
}
