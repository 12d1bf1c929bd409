/*
 * The mesh of a deck and its nodal temperatures as .msh 2.2.
 */
#include "decks/deck.h"

#include <stdlib.h>

int *deck_numbers(int n, unsigned shuffle) {
  random_source r = {shuffle};
  int *p = malloc(((size_t)n + 1) * sizeof *p);
  if (p == NULL) abort();
  for (int i = 0; i < n; ++i) p[i] = i + 1;
  for (int i = n - 1; shuffle != 0 && i > 0; --i) {
    int k = random_pick(&r, i + 1), t = p[i];
    p[i] = p[k];
    p[k] = t;
  }
  return p;
}

/* Item numbers run on over faces and elements: faces first. */
static void write_items(FILE *f, const solid *s, const deck_text *how,
                        const int *node_no) {
  int all = s->n_face + s->n_elem,
      *item_no = deck_numbers(s->n_elem, how->shuffle);
  int *at = malloc(((size_t)s->n_elem + 1) * sizeof *at);
  if (at == NULL) abort();
  for (int e = 0; e < s->n_elem; ++e) at[item_no[e] - 1] = e;
  fprintf(f, "$Elements\n%d\n", all);
  for (int k = 0; k < all; ++k) {
    int face = k < s->n_face, id = face ? k : at[k - s->n_face];
    int per = s->dim + !face,
        group = face ? s->face_group[id] : s->elem_group[id];
    const int *node = (face ? s->face : s->elem) + per * id;
    fprintf(f, "%d %d 2 %d %d", k + 1, per == 4 ? 4 : per - 1, group + 1,
            group + 1);
    for (int v = 0; v < per; ++v) fprintf(f, " %d", node_no[node[v]]);
    fprintf(f, "\n");
  }
  fprintf(f, "$EndElements\n");
  free(at);
  free(item_no);
}

void deck_write_mesh(const random_deck *d, const deck_text *how, FILE *f) {
  const solid *s = &d->mesh;
  int *node_no = deck_numbers(s->n_node, how->shuffle);
  fprintf(f, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n%d\n",
          s->n_group);
  for (int g = 0; g < s->n_group; ++g)
    fprintf(f, "%d %d \"%s\"\n", s->group[g].dim, g + 1, s->group[g].name);
  fprintf(f, "$EndPhysicalNames\n$Nodes\n%d\n", s->n_node);
  for (int i = 0; i < s->n_node; ++i) {
    fprintf(f, "%d", node_no[i]);
    double x[3] = {0};
    for (int c = 0; c < s->dim; ++c)
      x[deck_axis(how, s->dim, c)] = s->x[s->dim * i + c] * how->units.length;
    for (int c = 0; c < 3; ++c) fprintf(f, " %.17g", x[c]);
    fprintf(f, "\n");
  }
  fprintf(f, "$EndNodes\n");
  write_items(f, s, how, node_no);
  free(node_no);
}

void deck_write_field(const random_deck *d, const deck_text *how, FILE *f) {
  int n = d->mesh.n_node, *node_no = deck_numbers(n, how->shuffle);
  fprintf(f,
          "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$NodeData\n1\n\"T\"\n1\n"
          "0.0\n3\n0\n1\n%d\n",
          n);
  for (int i = 0; i < n; ++i) fprintf(f, "%d %.17g\n", node_no[i], d->field[i]);
  fprintf(f, "$EndNodeData\n");
  free(node_no);
}
