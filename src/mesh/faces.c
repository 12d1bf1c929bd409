/*
 * Faces of the groups: one id for each set of nodes, turned outward from the
 * element they bound, with the element on the other side.
 */
#include "base/base.h"
#include "mesh/build.h"
#include "mesh/sort.h"

typedef struct face_list {
  int dim;
  int *low;     /* [dim*n_low] mesh nodes ascending, -1: not in the mesh */
  size_t *no;   /* [n_low] number in the file */
  int *start;   /* [n_node+1] faces whose lowest node is i */
  int *corner;  /* [dim*n_face] ascending */
  int *example; /* [n_face] a low element of the face */
} face_list;

static void release(face_list *f) {
  RELEASE(f->low, f->no, f->start, f->corner, f->example);
}

/* By the third corner, then by place in the file; the key holds two. */
static int by_corners(const void *ctx, int a, int b) {
  const face_list *f = ctx;
  if (f->dim == 3) {
    int v = f->low[3 * (size_t)a + 2], w = f->low[3 * (size_t)b + 2];
    if (v != w) return v < w ? -1 : 1;
  }
  return (f->no[a] > f->no[b]) - (f->no[a] < f->no[b]);
}

/* Number and place of low element j, for a message. */
static void note_missing(const builder *b, int j, faults *bad) {
  int i = 0;
  while (b->raw->block[i].dim != b->m->dim - 1 || j < b->first[i] ||
         (size_t)(j - b->first[i]) >= b->raw->block[i].n)
    ++i;
  const raw_block *p = &b->raw->block[i];
  size_t item = j - b->first[i];
  double x[3];
  CLEAR(x, 3);
  for (size_t k = 0; k < p->n_per; ++k) {
    int r = nodes_find(b, p->node[p->n_per * item + k]);
    for (size_t d = 0; d < 3 && r >= 0; ++d)
      x[d] += b->raw->xyz[3 * (size_t)r + d] * b->scale / (double)p->n_per;
  }
  fault_at(bad, b->m->dim, p->no[item], x);
}

/* Corners as mesh nodes; faces with nodes outside of the mesh go to bad. */
static status gather(builder *b, face_list *f, faults *bad) {
  size_t dim = f->dim;
  PASS_NEW_ALL(OF(f->low, dim * b->n_low), OF(f->no, b->n_low));
  for (int i = 0; i < b->raw->n_block; ++i) {
    const raw_block *p = &b->raw->block[i];
    if (p->dim != f->dim - 1) continue;
    COPY(f->no + b->first[i], p->no, p->n);
    int *v = f->low + dim * b->first[i];
    for (size_t j = 0; j < dim * p->n; ++j) {
      int r = nodes_find(b, p->node[j]);
      v[j] = r < 0 ? -1 : b->node_id[r];
    }
  }
  for (int j = 0; j < b->n_low; ++j) {
    int *v = f->low + dim * j;
    sort_few(f->dim, v);
    if (v[0] < 0) note_missing(b, j, bad);
  }
  return OK;
}

/* Sort the low elements and give every set of corners one id. */
static status number_faces(builder *b, face_list *f) {
  mesh *m = b->m;
  OWNED sort_item *item = NULL;
  size_t dim = f->dim, bytes = dim * sizeof(int);
  PASS_NEW_ALL(OF(item, b->n_low), OF(b->face_of_low, b->n_low),
               OF(f->corner, dim * b->n_low), OF(f->example, b->n_low));
  int n = 0;
  for (int j = 0; j < b->n_low; ++j) {
    const int *v = f->low + dim * j;
    b->face_of_low[j] = -1;
    if (v[0] >= 0) item[n++] = (sort_item){sort_key(v[0], v[1]), j};
  }
  PASS(sort_items(n, item, by_corners, f));
  for (int i = 0; i < n; ++i) {
    const int id = item[i].id, *v = f->low + dim * id;
    int last = m->n_face - 1;
    if (last < 0 || memcmp(f->corner + dim * last, v, bytes) != 0) {
      memcpy(f->corner + dim * ++last, v, bytes);
      f->example[m->n_face++] = id;
    }
    b->face_of_low[id] = last;
  }
  if (m->n_face < n)
    message_add(b->log, P3031, b->at, "%d face(s) are listed more than once",
                n - m->n_face);
  return OK;
}

/* The face with these ascending corners, or -1. */
static int find_face(const face_list *f, const int *v) {
  for (int i = f->start[v[0]]; i < f->start[v[0] + 1]; ++i)
    if (memcmp(f->corner + (size_t)f->dim * i, v, f->dim * sizeof(int)) == 0)
      return i;
  return -1;
}

void mesh_side_nodes(const mesh *m, int id, int *v) {
  static const int side_2d[3][2] = {{0, 1}, {1, 2}, {2, 0}};
  static const int side_3d[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  const int *w = mesh_elem_nodes(m, id / (m->dim + 1));
  const int side = id % (m->dim + 1);
  if (m->dim == 2) {
    for (int k = 0; k < 2; ++k) v[k] = w[side_2d[side][k]];
    return;
  }
  int s[3], k = 0;
  for (int i = 0; i < 3; ++i) {
    s[i] = w[side_3d[side][i]];
    if (s[i] < s[k]) k = i;
  }
  for (int i = 0; i < 3; ++i) v[i] = s[(k + i) % 3];
}

/* One side of an element. */
static void meet(mesh *m, face_list *f, int elem, int side) {
  size_t dim = f->dim;
  int outward[3], v[3];
  mesh_side_nodes(m, (m->dim + 1) * elem + side, outward);
  int low = outward[dim == 2 && outward[1] < outward[0]];
  if (f->start[low] == f->start[low + 1]) return;
  COPY(v, outward, dim);
  sort_few(f->dim, v);
  int face = find_face(f, v);
  if (face < 0) return;
  if (m->face_elem[face] >= 0) {
    m->face_other[face] = elem;
    return;
  }
  memcpy(m->face + dim * face, outward, dim * sizeof(int));
  m->face_elem[face] = elem;
}

static status find_elements(builder *b, face_list *f) {
  mesh *m = b->m;
  size_t dim = f->dim;
  PASS_NEW_ALL(OF(m->face, dim * m->n_face), OF(m->face_elem, m->n_face),
               OF(m->face_other, m->n_face), OF(f->start, m->n_node + 1));
  for (int i = 0; i < m->n_face; ++i) {
    m->face_elem[i] = m->face_other[i] = -1;
    ++f->start[f->corner[dim * i] + 1];
  }
  for (int i = 0; i < m->n_node; ++i) f->start[i + 1] += f->start[i];
  for (int e = 0; e < m->n_elem; ++e)
    for (int side = 0; side <= m->dim; ++side) meet(m, f, e, side);
  return OK;
}

status faces_finish(builder *b) {
  ENDS_BY(release) face_list f = {.dim = b->m->dim};
  faults alone = {0};
  PASS(gather(b, &f, &alone));
  PASS(number_faces(b, &f));
  PASS(numbers_check(b, "face", b->n_low, f.no, b->face_of_low));
  PASS(find_elements(b, &f));
  for (int i = 0; i < b->m->n_face; ++i)
    if (b->m->face_elem[i] < 0) note_missing(b, f.example[i], &alone);
  if (alone.n > 0)
    message_add(b->log, P3030, b->at, "%d face(s) bound no element: %s",
                alone.n, alone.text);
  return build_check(b);
}
