#include "support/pressed_block.h"

#include "base/base.h"

static void must(status st) {
  if (st == OK) return;
  fprintf(stderr, "pressed block: %s\n", status_message());
  exit(EXIT_FAILURE);
}

static double *numbers(int n) {
  double *x = calloc((size_t)n + 1, sizeof *x);
  if (x == NULL) abort();
  return x;
}

static int *integers(int n) {
  int *x = calloc((size_t)n + 1, sizeof *x);
  if (x == NULL) abort();
  return x;
}

static void make_body(pressed_block *b, int dim, int nodes, int layers) {
  const double length[3] = {1, 1, 1};
  if (dim == 2) {
    int cells[2] = {nodes - 1, nodes - 1 < layers ? nodes - 1 : layers};
    b->s = scene_new(make_grid_2d(cells, length), PLANE_STRAIN, 1);
    scene_contact(b->s, "BOTTOM", (double[]){0, -1}, 0);
  } else {
    int side = (int)lround(sqrt(nodes)) - 1;
    int cells[3] = {side, side, side < layers ? side : layers};
    b->s = scene_new(make_grid_3d(cells, length), SOLID_3D, 1);
    scene_contact(b->s, "FRONT", (double[]){0, 0, -1}, 0);
  }
  for (int i = 0; i < dim; ++i) scene_fix(b->s, dim == 2 ? "TOP" : "BACK", i);
  must(stiffness_assemble(&b->s->d, &b->k));
  must(condense(b->k, &b->s->d, &b->c));
}

void pressed_block_new(pressed_block *b, int dim, int nodes, int layers) {
  memset(b, 0, sizeof *b);
  make_body(b, dim, nodes, layers);
  int n = b->s->surface.n, m = dim * n, all = dim * b->s->m->n_node;
  b->F = numbers(all);
  b->ud = numbers(all);
  b->f = numbers(m);
  b->gap = numbers(n);
  b->g0 = numbers(n);
  b->ut0 = numbers(m - n);
  b->B = (sparse_rows){n, integers(n), integers(n), numbers(n)};
  for (int i = 0; i < n; ++i) {
    b->B.start[i + 1] = i + 1;
    b->B.col[i] = i;
  }
  b->cp = (contact_problem){.dim = dim,
                            .n = n,
                            .m = m,
                            .A = condensed_matrix(b->c),
                            .f = b->f,
                            .gap = b->gap};
}

void pressed_block_free(pressed_block *b) {
  condensed_free(b->c);
  memory_free(b->k);
  scene_free(b->s);
  free(b->F);
  free(b->ud);
  free(b->f);
  free(b->gap);
  free(b->g0);
  free(b->ut0);
  free(b->B.start);
  free(b->B.col);
  free(b->B.val);
}

void pressed_block_load(pressed_block *b, double side, double down) {
  const mesh *m = b->s->m;
  int dim = m->dim;
  const char *top = dim == 2 ? "TOP" : "BACK";
  memset(b->F, 0, (size_t)(dim * m->n_node) * sizeof *b->F);
  for (int g = 0; g < m->n_group; ++g) {
    const mesh_group *group = &m->group[g];
    for (int i = 0; i < group->n_item && !strcmp(group->name, "LEFT"); ++i) {
      int face_id = group->item_id[i];
      double share = 1.0 / group->n_item / dim; /* the side measures 1 */
      for (int k = 0; k < dim; ++k)
        b->F[dim * m->face[dim * face_id + k]] += side * share;
    }
    for (int i = 0; i < group->n_node && !strcmp(group->name, top); ++i)
      b->ud[dim * group->node_id[i] + dim - 1] = -down;
  }
  must(condense_load(b->c, b->F, b->ud, b->f));
}

void pressed_block_friction(pressed_block *b, double mu) {
  for (int i = 0; i < b->cp.n; ++i) b->B.val[i] = mu;
  b->cp.ut0 = mu > 0.0 ? b->ut0 : NULL;
  b->cp.g0 = mu > 0.0 ? b->g0 : NULL;
  b->cp.B = mu > 0.0 ? &b->B : NULL;
}
