#include "support/block_file.h"

#include <stdio.h>

enum { ROOM = 200000 };

typedef struct text {
  char at[ROOM];
  int used, items;
} text;

static void add_line(text *t, int a, int b, int group) {
  t->used += snprintf(t->at + t->used, (size_t)(ROOM - t->used),
                      "%d 1 2 %d %d %d %d\n", ++t->items, group, group, a, b);
}

static void add_triangle(text *t, int a, int b, int c, int group) {
  t->used +=
      snprintf(t->at + t->used, (size_t)(ROOM - t->used),
               "%d 2 2 %d %d %d %d %d\n", ++t->items, group, group, a, b, c);
}

void block_file_write(const job *j, const int n[2], const double length[2],
                      int two) {
  static text nodes, elements;
  int across = n[0] + 1;
  nodes.used = nodes.items = elements.used = elements.items = 0;
  for (int k = 0; k <= n[1]; ++k)
    for (int i = 0; i <= n[0]; ++i)
      nodes.used += snprintf(nodes.at + nodes.used, (size_t)(ROOM - nodes.used),
                             "%d %.17g %.17g 0\n", ++nodes.items,
                             length[0] * i / n[0], length[1] * k / n[1]);
  for (int i = 1; i <= n[0]; ++i) {
    add_line(&elements, i, i + 1, 1);
    add_line(&elements, across * n[1] + i, across * n[1] + i + 1, 2);
  }
  for (int k = 0; k < n[1]; ++k) {
    add_line(&elements, across * k + 1, across * (k + 1) + 1, 3);
    add_line(&elements, across * (k + 1), across * (k + 2), 4);
  }
  for (int k = 0; k < n[1]; ++k)
    for (int i = 0; i < n[0]; ++i) {
      int a = across * k + i + 1, b = a + 1, c = b + across, d = a + across;
      int group = two && 2 * k >= n[1] ? 6 : 5;
      if ((i + k) % 2 == 0) {
        add_triangle(&elements, a, b, c, group);
        add_triangle(&elements, a, c, d, group);
      } else {
        add_triangle(&elements, a, b, d, group);
        add_triangle(&elements, b, c, d, group);
      }
    }
  job_write(j, "block.msh",
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n%d\n"
            "1 1 \"CONTACT\"\n1 2 \"TOP\"\n1 3 \"LEFT\"\n1 4 \"SYMMETRY\"\n"
            "2 5 \"BODY\"\n%s$EndPhysicalNames\n$Nodes\n%d\n%s$EndNodes\n"
            "$Elements\n%d\n%s$EndElements\n",
            two ? 6 : 5, two ? "2 6 \"UPPER\"\n" : "", nodes.items, nodes.at,
            elements.items, elements.at);
}
