#include "support/faces.h"

#include "support/unit.h"

void faces_begin(face_scene *c, int dim) {
  memset(c, 0, sizeof *c);
  c->m = (mesh){.dim = dim,
                .x = c->x,
                .node_no = c->node_no,
                .face = c->face,
                .face_other = c->face_other,
                .group = c->group,
                .size = 1};
  c->in = (surface_input){.mesh = &c->m,
                          .pairs = c->pair,
                          .fixed = c->fixed,
                          .face_weight = c->weight};
  ck_assert_int_eq(message_log_new(&c->log), OK);
}

void faces_end(face_scene *c) {
  pairs_release(&c->in);
  memory_free(c->s);
  memory_free(c->log);
}

int faces_node(face_scene *c, double x, double y, double z) {
  int i = c->m.n_node++, dim = c->m.dim;
  ck_assert_int_lt(i, FACES_MAX);
  c->x[dim * i] = x;
  c->x[dim * i + 1] = y;
  if (dim == 3) c->x[dim * i + 2] = z;
  c->node_no[i] = (size_t)(1000 + i);
  return i;
}

int faces_face(face_scene *c, int a, int b, int d) {
  int f = c->m.n_face++, dim = c->m.dim;
  ck_assert_int_lt(f, FACES_MAX);
  c->face[dim * f] = a;
  c->face[dim * f + 1] = b;
  if (dim == 3) c->face[dim * f + 2] = d;
  c->face_other[f] = -1;
  c->weight[f] = 1;
  return f;
}

void faces_contact(face_scene *c, const char *name, int from, int to) {
  int p = c->in.n_pair++, dim = c->m.dim;
  mesh_group *g = &c->group[p];
  unsigned char used[FACES_MAX] = {0};
  g->name = name;
  g->dim = dim - 1;
  g->item_id = c->item[p];
  g->node_id = c->group_node[p];
  for (int f = from; f < to; ++f) {
    g->item_id[g->n_item++] = f;
    for (int k = 0; k < dim; ++k) used[c->face[dim * f + k]] = 1;
  }
  for (int i = 0; i < c->m.n_node; ++i)
    if (used[i]) g->node_id[g->n_node++] = i;
  c->m.n_group = p + 1;
  c->support[p] = (obstacle){.name = "SUPPORT", .shape = OBSTACLE_CONFORMING};
  c->pair[p] = (contact_pair){
      .card = "*CONTACT", .name = name, .group = g, .support = &c->support[p]};
}

status faces_build(face_scene *c) {
  return surface_build(&c->in, c->log, &c->s);
}

int faces_said(const face_scene *c, const char *text) {
  char *all = NULL;
  size_t size = 0;
  int n = 0;
  FILE *out = open_memstream(&all, &size);
  ck_assert_ptr_nonnull(out);
  message_print(c->log, out);
  fclose(out);
  const char *end = strstr(all, "; protis --explain");
  for (const char *p = all; (p = strstr(p, text)) != NULL; ++p)
    n += end == NULL || p < end;
  free(all);
  return n;
}

double faces_area(const contact_surface *s) {
  double sum = 0;
  for (int i = 0; i < s->n; ++i) sum += s->area[i];
  return sum;
}

void faces_flat_bottom(face_scene *c, int n) {
  faces_begin(c, 2);
  for (int i = 0; i <= n; ++i) faces_node(c, (double)i / n, 0, 0);
  for (int i = 0; i < n; ++i) faces_face(c, i, i + 1, 0);
}

void faces_two_sides(face_scene *c) {
  faces_begin(c, 2);
  faces_node(c, 0, 1, 0);
  faces_node(c, 0, 0.5, 0);
  faces_node(c, 0, 0, 0);
  faces_node(c, 0.25, 0, 0);
  faces_node(c, 1, 0, 0);
  for (int i = 0; i < 4; ++i) faces_face(c, i, i + 1, 0);
  faces_contact(c, "WALL", 0, 2);
  faces_contact(c, "FLOOR", 2, 4);
}
