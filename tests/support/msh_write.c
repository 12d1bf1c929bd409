#include "support/msh_write.h"

#include "base/base.h"

static void write_element(FILE *to, const mesh *m, const mesh_group *g,
                          int id) {
  const int *v =
      g->dim == m->dim ? m->elem + (g->dim + 1) * id : m->face + m->dim * id;
  for (int a = 0; a <= g->dim; ++a) fprintf(to, " %d", v[a] + 1);
  fputc('\n', to);
}

void msh_write(const char *path, const mesh *m) {
  static const int type[] = {15, 1, 2, 4};
  FILE *to = fopen(path, "w");
  int n = 0, no = 0;
  if (to == NULL) abort();
  fprintf(to, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n%d\n",
          m->n_group);
  for (int k = 0; k < m->n_group; ++k) {
    fprintf(to, "%d %d \"%s\"\n", m->group[k].dim, k + 1, m->group[k].name);
    n += m->group[k].n_item;
  }
  fprintf(to, "$EndPhysicalNames\n$Nodes\n%d\n", m->n_node);
  for (int i = 0; i < m->n_node; ++i)
    fprintf(to, "%d %.17g %.17g %.17g\n", i + 1, m->x[m->dim * i],
            m->x[m->dim * i + 1], m->dim == 3 ? m->x[3 * i + 2] : 0.0);
  fprintf(to, "$EndNodes\n$Elements\n%d\n", n);
  for (int k = 0; k < m->n_group; ++k)
    for (int i = 0; i < m->group[k].n_item; ++i) {
      fprintf(to, "%d %d 2 %d 1", ++no, type[m->group[k].dim], k + 1);
      write_element(to, m, &m->group[k], m->group[k].item_id[i]);
    }
  fprintf(to, "$EndElements\n");
  if (fclose(to) != 0) abort();
}
