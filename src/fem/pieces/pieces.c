/* By union-find over the elements. */
#include "fem/pieces/pieces.h"

#include "base/memory.h"

/* 2-D: elements round node j that share a second vertex share an edge. */
static void unite_round_node_2d(const mesh *m, const pieces *p, int j,
                                int *last, int *up) {
  for (size_t q = p->start[j]; q < p->start[j + 1]; ++q)
    for (int a = 0; a < 3; ++a) {
      const int v = m->elem[3 * p->elem[q] + a];
      if (v > j) last[v] = -1;
    }
  for (size_t q = p->start[j]; q < p->start[j + 1]; ++q)
    for (int a = 0; a < 3; ++a) {
      const int v = m->elem[3 * p->elem[q] + a];
      if (v <= j) continue;
      if (last[v] >= 0) forest_join(up, last[v], p->elem[q]);
      last[v] = p->elem[q];
    }
}

typedef struct corner {
  int v, w, elem; /* the other two vertices of a face, v < w; its element */
} corner;

/* 3-D: faces whose lowest vertex is j, compared pair by pair. */
static void unite_round_node_3d(const mesh *m, const pieces *p, int j,
                                corner *list, int *up) {
  int n = 0;
  for (size_t q = p->start[j]; q < p->start[j + 1]; ++q) {
    const int *e = m->elem + 4 * (size_t)p->elem[q];
    for (int a = 0; a < 4; ++a)
      for (int b = a + 1; b < 4; ++b) {
        if (e[a] <= j || e[b] <= j) continue;
        corner c = {e[a] < e[b] ? e[a] : e[b], e[a] < e[b] ? e[b] : e[a],
                    p->elem[q]};
        int k = 0;
        while (k < n && (list[k].v != c.v || list[k].w != c.w)) ++k;
        if (k < n)
          forest_join(up, list[k].elem, c.elem);
        else
          list[n++] = c;
      }
  }
}

static status unite_by_faces(const mesh *m, const pieces *p, int *up) {
  size_t most = 0;
  for (int j = 0; j < m->n_node; ++j)
    if (p->start[j + 1] - p->start[j] > most)
      most = p->start[j + 1] - p->start[j];
  OWNED_NEW(int, last, m->n_node);
  OWNED_NEW(corner, list, 3 * most);
  for (int j = 0; j < m->n_node; ++j)
    if (m->dim == 2)
      unite_round_node_2d(m, p, j, last, up);
    else
      unite_round_node_3d(m, p, j, list, up);
  return OK;
}

/* Number the sets by their first element: id[n_elem], returns how many. */
static int number_sets(int n_elem, int *up, int *id) {
  int n = 0;
  for (int e = 0; e < n_elem; ++e) {
    const int r = forest_root(up, e);
    id[e] = r == e ? n++ : id[r];
  }
  return n;
}

/* Number the pieces body by body; body_of[n_elem]. */
static status sort_pieces(const mesh *m, const int *body_of, pieces *p) {
  OWNED int *count = NULL, *number = NULL;
  PASS_NEW_ALL(OF(count, p->n_body + 1), OF(number, p->n_piece),
               OF(p->body, p->n_piece), OF(p->piece_elem, p->n_piece));
  for (int q = 0; q < p->n_piece; ++q) number[q] = -1;
  for (int pass = 0; pass < 2; ++pass) {
    for (int e = 0; e < m->n_elem; ++e) {
      int *q = &number[p->piece[e]];
      if (pass == 0 && *q < 0) {
        *q = body_of[e];
        ++count[*q + 1];
      } else if (pass == 1 && *q < 0) {
        *q = count[body_of[e]]++;
        p->body[*q] = body_of[e];
        p->piece_elem[*q] = e;
      }
    }
    if (pass == 1) break;
    for (int b = 0; b < p->n_body; ++b) count[b + 1] += count[b];
    for (int q = 0; q < p->n_piece; ++q) number[q] = -1;
  }
  for (int e = 0; e < m->n_elem; ++e) p->piece[e] = number[p->piece[e]];
  return OK;
}

status pieces_find(const mesh *m, pieces *p) {
  OWNED int *up = NULL, *body = NULL;
  *p = (pieces){0};
  PASS(mesh_node_elements(m, &p->start, &p->elem));
  PASS_NEW_ALL(OF(up, m->n_elem), OF(body, m->n_elem), OF(p->piece, m->n_elem));
  for (int e = 0; e < m->n_elem; ++e) up[e] = e;
  PASS(unite_by_faces(m, p, up));
  p->n_piece = number_sets(m->n_elem, up, p->piece);
  for (int j = 0; j < m->n_node; ++j)
    for (size_t q = p->start[j] + 1; q < p->start[j + 1]; ++q)
      forest_join(up, p->elem[q - 1], p->elem[q]);
  p->n_body = number_sets(m->n_elem, up, body);
  return sort_pieces(m, body, p);
}

void pieces_release(pieces *p) {
  RELEASE(p->piece, p->body, p->piece_elem, p->start, p->elem);
  *p = (pieces){0};
}
