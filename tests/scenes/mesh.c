/*
 * Grids, their groups and the file.
 */
#include "scenes/mesh.h"

#include "base/base.h"
#include "deck/expression.h"

enum { GROUPS = 64, NAME = 24 };

typedef struct cell {
  int n, group, node[4]; /* 1, 2, 3 or 4 nodes                                */
} cell;

typedef struct grid_file {
  int n_node, n_cell, n_group, dim;
  double *x; /* [3*n_node] */
  cell *cells;
  char name[GROUPS][NAME];
  int group_dim[GROUPS];
} grid_file;

/* A body that is being built. */
typedef struct body {
  int n[3], first, number, dim, layers, alternate, simplex_group;
  double length[3], at[3];
} body;

static int group_of(grid_file *g, const body *b, const char *name, int dim) {
  char full[NAME];
  if (b->number == 1)
    snprintf(full, sizeof full, "%s", name);
  else
    snprintf(full, sizeof full, "%s%d", name, b->number);
  for (int i = 0; i < g->n_group; ++i)
    if (strcmp(g->name[i], full) == 0) return i;
  snprintf(g->name[g->n_group], NAME, "%s", full);
  g->group_dim[g->n_group] = dim;
  return g->n_group++;
}

static void add_cell(grid_file *g, int n, const int *node, int group) {
  if ((g->n_cell & (g->n_cell - 1)) == 0) {
    size_t room = g->n_cell == 0 ? 1 : 2 * (size_t)g->n_cell;
    g->cells = realloc(g->cells, room * sizeof *g->cells);
    if (g->cells == NULL) abort();
  }
  cell c = {.n = n, .group = group};
  memcpy(c.node, node, (size_t)n * sizeof *node);
  g->cells[g->n_cell++] = c;
}

static void add_nodes(grid_file *g, int n) {
  g->n_node += n;
  g->x = realloc(g->x, 3 * (size_t)g->n_node * sizeof *g->x);
  if (g->x == NULL) abort();
}

static int at(const body *b, int i, int j, int k) {
  return b->first + i + (b->n[0] + 1) * (j + (b->n[1] + 1) * k);
}

static void grid_nodes(grid_file *g, body *b) {
  b->first = g->n_node;
  int nz = b->dim == 3 ? b->n[2] + 1 : 1;
  add_nodes(g, (b->n[0] + 1) * (b->n[1] + 1) * nz);
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j <= b->n[1]; ++j)
      for (int i = 0; i <= b->n[0]; ++i) {
        double *x = &g->x[3 * at(b, i, j, k)];
        x[0] = b->at[0] + b->length[0] * i / b->n[0];
        x[1] = b->at[1] + b->length[1] * j / b->n[1];
        x[2] = b->dim == 3 ? b->at[2] + b->length[2] * k / b->n[2] : 0.0;
      }
  int low = b->first, high = g->n_node - 1;
  add_cell(g, 1, &low, group_of(g, b, "CORNER", 0));
  add_cell(g, 1, &high, group_of(g, b, "TIP", 0));
}

static void add_rect(grid_file *g, body *b) {
  grid_nodes(g, b);
  for (int j = 0; j < b->n[1]; ++j)
    for (int i = 0; i < b->n[0]; ++i) {
      int c[4] = {at(b, i, j, 0), at(b, i + 1, j, 0), at(b, i + 1, j + 1, 0),
                  at(b, i, j + 1, 0)};
      int turn = b->alternate && (i + j) % 2 != 0;
      const char *name = !b->layers        ? "BODY"
                         : 2 * j < b->n[1] ? "SOFT"
                                           : "HARD";
      int group = group_of(g, b, name, 2);
      add_cell(g, 3, (int[]){c[turn], c[turn + 1], c[turn + 2]}, group);
      add_cell(g, 3, (int[]){c[turn], c[turn + 2], c[(turn + 3) % 4]}, group);
    }
  for (int i = 0; i < b->n[0]; ++i) {
    add_cell(g, 2, (int[]){at(b, i, 0, 0), at(b, i + 1, 0, 0)},
             group_of(g, b, "BOTTOM", 1));
    add_cell(g, 2, (int[]){at(b, i, b->n[1], 0), at(b, i + 1, b->n[1], 0)},
             group_of(g, b, "TOP", 1));
  }
  for (int j = 0; j < b->n[1]; ++j) {
    add_cell(g, 2, (int[]){at(b, 0, j, 0), at(b, 0, j + 1, 0)},
             group_of(g, b, "LEFT", 1));
    add_cell(g, 2, (int[]){at(b, b->n[0], j, 0), at(b, b->n[0], j + 1, 0)},
             group_of(g, b, "RIGHT", 1));
  }
}

/* The six tetrahedra of Kuhn: paths along the edges from corner 0 to 7. */
static const int axis_order[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2},
                                     {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};

static void add_tetrahedra(grid_file *g, const body *b, const int *ijk) {
  int group = group_of(g, b, "BODY", 3);
  for (int p = 0; p < 6; ++p) {
    int at_[3] = {ijk[0], ijk[1], ijk[2]}, node[4];
    for (int v = 0; v < 4; ++v) {
      node[v] = at(b, at_[0], at_[1], at_[2]);
      if (v < 3) ++at_[axis_order[p][v]];
    }
    add_cell(g, 4, node, group);
  }
}

/* Two triangles of the cell (i, j) on the side "end" of an axis, along the
 * diagonal from the least to the largest corner as the tetrahedra have it. */
static void add_side(grid_file *g, const body *b, int axis, int end) {
  static const char *const side[3][2] = {
      {"LEFT", "RIGHT"}, {"FRONT", "BACK"}, {"BOTTOM", "TOP"}};
  int p = (axis + 1) % 3, q = (axis + 2) % 3;
  int group = group_of(g, b, side[axis][end], 2);
  for (int j = 0; j < b->n[q]; ++j)
    for (int i = 0; i < b->n[p]; ++i) {
      int node[4];
      for (int v = 0; v < 4; ++v) {
        int c[3];
        c[axis] = end ? b->n[axis] : 0;
        c[p] = i + (v == 1 || v == 2);
        c[q] = j + (v >= 2);
        node[v] = at(b, c[0], c[1], c[2]);
      }
      add_cell(g, 3, (int[]){node[0], node[1], node[2]}, group);
      add_cell(g, 3, (int[]){node[0], node[2], node[3]}, group);
    }
}

static void add_box(grid_file *g, body *b) {
  grid_nodes(g, b);
  for (int k = 0; k < b->n[2]; ++k)
    for (int j = 0; j < b->n[1]; ++j)
      for (int i = 0; i < b->n[0]; ++i) add_tetrahedra(g, b, (int[]){i, j, k});
  for (int axis = 0; axis < 3; ++axis)
    for (int end = 0; end < 2; ++end) add_side(g, b, axis, end);
}

static void add_triangle(grid_file *g, const body *b, const double *x) {
  int first = g->n_node;
  add_nodes(g, 3);
  for (int v = 0; v < 3; ++v) {
    g->x[3 * (first + v)] = x[2 * v];
    g->x[3 * (first + v) + 1] = x[2 * v + 1];
    g->x[3 * (first + v) + 2] = 0.0;
  }
  int a = first, c = first + 2;
  add_cell(g, 3, (int[]){a, a + 1, c}, group_of(g, b, "BODY", 2));
  add_cell(g, 2, (int[]){a, a + 1}, group_of(g, b, "CLAMPED", 1));
  add_cell(g, 2, (int[]){a, c}, group_of(g, b, "FOOT", 1));
  add_cell(g, 2, (int[]){a + 1, c}, group_of(g, b, "SIDE", 1));
  add_cell(g, 1, &c, group_of(g, b, "TIP", 0));
}

static void read_options(const char *words, body *b) {
  const char *place = strstr(words, " at ");
  if (place != NULL)
    sscanf(place, " at %lf %lf %lf", &b->at[0], &b->at[1], &b->at[2]);
  b->layers = strstr(words, " layers") != NULL;
  b->alternate = strstr(words, " alternate") != NULL;
}

static int add_body(grid_file *g, const char *words, int number) {
  body b = {.number = number, .dim = 2};
  double x[6];
  while (*words == ' ') ++words;
  if (sscanf(words, "triangle %lf %lf %lf %lf %lf %lf", &x[0], &x[1], &x[2],
             &x[3], &x[4], &x[5]) == 6) {
    add_triangle(g, &b, x);
  } else if (sscanf(words, "rect %d %d %lf %lf", &b.n[0], &b.n[1], &b.length[0],
                    &b.length[1]) == 4) {
    read_options(words, &b);
    add_rect(g, &b);
  } else if (sscanf(words, "box %d %d %d %lf %lf %lf", &b.n[0], &b.n[1],
                    &b.n[2], &b.length[0], &b.length[1], &b.length[2]) == 6) {
    b.dim = 3;
    read_options(words, &b);
    add_box(g, &b);
  } else {
    return 0;
  }
  g->dim = b.dim;
  return 1;
}

static int map_nodes(grid_file *g, const mesh_change *c) {
  for (int k = 0; k < 3; ++k) {
    if (c->map[k] == NULL) continue;
    expression *e = NULL;
    int column;
    if (expression_compile(c->map[k], NULL, NULL, &e, &column) != OK) return 0;
    for (int i = 0; i < g->n_node; ++i)
      g->x[3 * i + k] = expression_value(e, &g->x[3 * i], 0.0);
    memory_free(e);
  }
  return 1;
}

static void move_nodes(grid_file *g, const mesh_change *c) {
  double s = c->scale == 0.0 ? 1.0 : c->scale;
  double co = cos(c->turn), si = sin(c->turn);
  for (int i = 0; i < g->n_node; ++i) {
    double *x = &g->x[3 * i];
    double a = s * (c->mirror ? -x[0] : x[0]), b = s * x[1];
    x[0] = co * a - si * b + c->shift;
    x[1] = si * a + co * b + c->shift;
    x[2] *= s;
  }
}

/* A permutation of 0 .. n-1, the identity for seed 0 (Knuth's shuffle). */
static int *permutation(int n, unsigned long long seed) {
  int *p = malloc((size_t)n * sizeof *p);
  if (p == NULL) abort();
  for (int i = 0; i < n; ++i) p[i] = i;
  for (int i = n - 1; seed != 0 && i > 0; --i) {
    seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
    int j = (int)((seed >> 33) % (unsigned)(i + 1)), t = p[i];
    p[i] = p[j];
    p[j] = t;
  }
  return p;
}

static void write_file(FILE *f, const grid_file *g, const int *number,
                       unsigned seed) {
  static const int type[] = {0, 15, 1, 2, 4};
  int *order = permutation(g->n_cell, seed);
  fprintf(f, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n%d\n",
          g->n_group);
  for (int i = 0; i < g->n_group; ++i)
    fprintf(f, "%d %d \"%s\"\n", g->group_dim[i], i + 1, g->name[i]);
  fprintf(f, "$EndPhysicalNames\n$Nodes\n%d\n", g->n_node);
  for (int i = 0; i < g->n_node; ++i)
    fprintf(f, "%d %.17g %.17g %.17g\n", number[i], g->x[3 * i],
            g->x[3 * i + 1], g->x[3 * i + 2]);
  fprintf(f, "$EndNodes\n$Elements\n%d\n", g->n_cell);
  for (int i = 0; i < g->n_cell; ++i) {
    const cell *c = &g->cells[order[i]];
    fprintf(f, "%d %d 2 %d %d", i + 1, type[c->n], c->group + 1, c->group + 1);
    for (int v = 0; v < c->n; ++v) fprintf(f, " %d", number[c->node[v]]);
    fprintf(f, "\n");
  }
  fprintf(f, "$EndElements\n");
  free(order);
}

int scene_mesh_write(FILE *f, const char *words, const mesh_change *change,
                     int **number) {
  grid_file g = {0};
  char text[400];
  int good = 1, body_no = 0;
  snprintf(text, sizeof text, "%s", words);
  for (char *w = strtok(text, "+"); w != NULL && good; w = strtok(NULL, "+"))
    good = add_body(&g, w, ++body_no);
  good = good && map_nodes(&g, change);
  *number = permutation(g.n_node, change->shuffle);
  for (int i = 0; i < g.n_node; ++i) ++(*number)[i];
  move_nodes(&g, change);
  if (good) write_file(f, &g, *number, change->shuffle);
  free(g.x);
  free(g.cells);
  return good;
}
