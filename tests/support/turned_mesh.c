#include "support/turned_mesh.h"

#include "base/base.h"

#include <check.h>

void turn_vector(const turn *t, double v[3]) {
  const double *a = t->axis;
  double w[3], along = a[0] * v[0] + a[1] * v[1] + a[2] * v[2];
  for (int c = 0; c < 3; ++c) {
    int d = (c + 1) % 3, e = (c + 2) % 3;
    w[c] = cos(t->angle) * v[c] + sin(t->angle) * (a[d] * v[e] - a[e] * v[d]) +
           (1 - cos(t->angle)) * along * a[c];
  }
  memcpy(v, w, sizeof w);
}

static void write_items(FILE *f, int type, int tag, int corners, int n,
                        const int *node, int *no) {
  for (int i = 0; i < n; ++i) {
    fprintf(f, "%d %d 2 %d %d", ++*no, type, tag, tag);
    for (int k = 0; k < corners; ++k)
      fprintf(f, " %d", node[corners * i + k] + 1);
    fputc('\n', f);
  }
}

void turned_mesh_write(const job *j, const mesh *m, const turn *t) {
  char path[128];
  int no = 0, dim = m->dim;
  const mesh_group *foot = mesh_find_group(m, dim == 3 ? "FRONT" : "BOTTOM");
  const mesh_group *head = mesh_find_group(m, dim == 3 ? "BACK" : "TOP");
  snprintf(path, sizeof path, "%s/turned.msh", j->dir);
  FILE *f = fopen(path, "w");
  ck_assert_ptr_nonnull(f);
  fprintf(f,
          "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n"
          "%d 1 \"FOOT\"\n%d 2 \"HEAD\"\n%d 3 \"BODY\"\n$EndPhysicalNames\n"
          "$Nodes\n%d\n",
          dim - 1, dim - 1, dim, m->n_node);
  for (int i = 0; i < m->n_node; ++i) {
    double x[3] = {0, 0, 0};
    memcpy(x, m->x + dim * i, (size_t)dim * sizeof *x);
    turn_vector(t, x);
    fprintf(f, "%d %.17g %.17g %.17g\n", i + 1, x[0], x[1], x[2]);
  }
  fprintf(f, "$EndNodes\n$Elements\n%d\n",
          foot->n_item + head->n_item + m->n_elem);
  for (int k = 0; k < foot->n_item; ++k)
    write_items(f, dim - 1, 1, dim, 1, m->face + dim * foot->item_id[k], &no);
  for (int k = 0; k < head->n_item; ++k)
    write_items(f, dim - 1, 2, dim, 1, m->face + dim * head->item_id[k], &no);
  write_items(f, dim == 3 ? 4 : 2, 3, dim + 1, m->n_elem, m->elem, &no);
  fprintf(f, "$EndElements\n");
  ck_assert_int_eq(fclose(f), 0);
}
