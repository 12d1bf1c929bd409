/*
 * The motions are chosen so that R_c = Q is orthonormal: a step of modified
 * Gram-Schmidt on R_c goes through their coefficients Y too, and R_c is then
 * computed again from them. So each column is a rigid motion to rounding, also
 * where the contact nodes are few or close together and the motions are nearly
 * dependent on them.
 */
#include "fem/rigid.h"

#include "base/memory.h"
#include "fem/factor.h"
#include "fem/pieces.h"

#include <cblas.h>
#include <math.h>
#include <string.h>

/* ---- * Bodies and rigid pieces by union-find over the elements ---------- */

static int root(int *up, int e) {
  while (up[e] != e) {
    up[e] = up[up[e]];
    e = up[e];
  }
  return e;
}

/* The smaller root wins, so that a set is named by its first element. */
static void unite(int *up, int a, int b) {
  a = root(up, a);
  b = root(up, b);
  if (a < b)
    up[b] = a;
  else
    up[a] = b;
}

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
      if (last[v] >= 0) unite(up, last[v], p->elem[q]);
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
          unite(up, list[k].elem, c.elem);
        else
          list[n++] = c;
      }
  }
}

static status unite_by_faces(const mesh *m, const pieces *p, int *up) {
  OWNED int *last = NULL;
  OWNED corner *list = NULL;
  size_t most = 0;
  for (int j = 0; j < m->n_node; ++j)
    if (p->start[j + 1] - p->start[j] > most)
      most = p->start[j + 1] - p->start[j];
  PASS_NEW(last, m->n_node);
  PASS_NEW(list, 3 * most);
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
    const int r = root(up, e);
    id[e] = r == e ? n++ : id[r];
  }
  return n;
}

/* Number the pieces body by body; body_of[n_elem]. */
static status sort_pieces(const mesh *m, const int *body_of, pieces *p) {
  OWNED int *count = NULL, *number = NULL;
  PASS_NEW(count, p->n_body + 1);
  PASS_NEW(number, p->n_piece);
  PASS_NEW(p->body, p->n_piece);
  PASS_NEW(p->piece_elem, p->n_piece);
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
  status st = OK;
  int *up = NULL, *body = NULL;
  *p = (pieces){0};
  TRY(mesh_node_elements(m, &p->start, &p->elem));
  NEW(up, m->n_elem);
  NEW(body, m->n_elem);
  NEW(p->piece, m->n_elem);
  for (int e = 0; e < m->n_elem; ++e) up[e] = e;
  TRY(unite_by_faces(m, p, up));
  p->n_piece = number_sets(m->n_elem, up, p->piece);
  for (int j = 0; j < m->n_node; ++j)
    for (size_t q = p->start[j] + 1; q < p->start[j + 1]; ++q)
      unite(up, p->elem[q - 1], p->elem[q]);
  p->n_body = number_sets(m->n_elem, up, body);
  TRY(sort_pieces(m, body, p));
done:
  RELEASE(up, body);
  if (st != OK) pieces_release(p);
  return st;
}

void pieces_release(pieces *p) {
  RELEASE(p->piece, p->body, p->piece_elem, p->start, p->elem);
  *p = (pieces){0};
}

/* Motions that move the contact unknowns less than this part of what they
 * share with the motions before them are left out. */
static const double least_part = 1e-10;
/* Leverages that count as equal: the first unknown is taken. */
static const double tie = 1e-6;

void rigid_row(const rigid_modes *r, const double *x, const double *direction,
               double *row) {
  double p[3], *v = row;
  for (int c = 0; c < r->dim; ++c) p[c] = (x[c] - r->centre[c]) / r->size;
  if (r->modes == 1) {
    row[0] = direction[1];
  } else if (r->dim == 2) {
    *v++ = p[0] * direction[1] - p[1] * direction[0];
    memcpy(v, direction, 2 * sizeof *v);
  } else {
    for (int c = 0; c < 3; ++c) {
      const int i = (c + 1) % 3, j = (c + 2) % 3;
      *v++ = p[i] * direction[j] - p[j] * direction[i];
    }
    memcpy(v, direction, 3 * sizeof *v);
  }
}

void rigid_release(rigid_set *r) {
  for (int b = 0; b < r->n_body; ++b) {
    RELEASE(r->body[b].Y, r->body[b].node, r->body[b].column, r->body[b].load);
  }
  RELEASE(r->body, r->Q);
  *r = (rigid_set){0};
}

/* Row of the motions for component c of node i, in the frame of a contact
 * node; 0: prescribed. */
static int unknown_row(const stiffness *k, const domain *d, const rigid_body *b,
                       int i, int c, double *row) {
  const int dim = k->dim, q = k->contact[i];
  double direction[3] = {0};
  if (!(k->free[i] >> c & 1)) return 0;
  direction[c] = 1;
  if (q >= 0)
    memcpy(direction, d->surface->frame + dim * (dim * q + c),
           (size_t)dim * sizeof *direction);
  rigid_row(&b->at, d->mesh->x + (size_t)dim * (size_t)i, direction, row);
  return 1;
}

/* Centre and extent of the contact nodes; the extent is that of the body if
 * there is but one. 0: no contact node. */
static int measure_contact(const stiffness *k, const domain *d,
                           const rigid_body *b, rigid_modes *at) {
  const int dim = k->dim;
  double low[3], high[3];
  int found = 0;
  *at = b->at;
  for (int t = 0; t < b->n_node; ++t) {
    const double *x = d->mesh->x + (size_t)dim * (size_t)b->node[t];
    if (k->contact[b->node[t]] < 0) continue;
    for (int c = 0; c < dim; ++c) {
      if (!found || x[c] < low[c]) low[c] = x[c];
      if (!found || x[c] > high[c]) high[c] = x[c];
    }
    found = 1;
  }
  if (!found) return 0;
  double size = 0;
  for (int c = 0; c < dim; ++c) {
    at->centre[c] = 0.5 * (low[c] + high[c]);
    size = fmax(size, high[c] - low[c]);
  }
  if (size > 0) at->size = size;
  return 1;
}

/* The same motion of a piece about another centre. */
static void move_centre(const rigid_modes *from, const rigid_modes *to,
                        double *y) {
  const double turn = to->size / from->size;
  double e[3];
  if (from->modes == 1) return;
  for (int c = 0; c < from->dim; ++c)
    e[c] = (to->centre[c] - from->centre[c]) / from->size;
  if (from->dim == 2) {
    y[1] -= y[0] * e[1];
    y[2] += y[0] * e[0];
    y[0] *= turn;
    return;
  }
  for (int c = 0; c < 3; ++c) {
    const int i = (c + 1) % 3, j = (c + 2) % 3;
    y[3 + c] += y[i] * e[j] - y[j] * e[i];
  }
  for (int c = 0; c < 3; ++c) y[c] *= turn;
}

/* R_c of the motions of a body: its columns of Q. */
static void contact_motions(const stiffness *k, const domain *d,
                            const rigid_set *r, const rigid_body *b) {
  const size_t m = (size_t)r->m, n = (size_t)b->n;
  for (int t = 0; t < b->n_node; ++t) {
    const int first = k->first_row[b->node[t]];
    double row[6];
    for (int c = 0; first >= 0 && c < k->rows; ++c) {
      if (!unknown_row(k, d, b, b->node[t], c, row)) continue;
      double *to = r->Q + m * (size_t)b->first + (size_t)(first + c);
      for (int j = 0; j < b->k; ++j) {
        const double *y = b->Y + n * (size_t)j + b->column[t];
        double sum = 0;
        for (int a = 0; a < b->at.modes; ++a) sum += row[a] * y[a];
        to[m * (size_t)j] = sum;
      }
    }
  }
}

static double dot(int n, const double *a, const double *b) {
  return cblas_ddot(n, a, 1, b, 1);
}

/* Make the columns of a body orthonormal; the motions follow. */
static void gram_schmidt(const rigid_set *r, rigid_body *b) {
  const size_t m = (size_t)r->m, n = (size_t)b->n;
  double *Q = r->Q + m * (size_t)b->first;
  int kept = 0;
  for (int j = 0; j < b->k; ++j) {
    double *q = Q + m * (size_t)kept, *y = b->Y + n * (size_t)kept;
    memmove(q, Q + m * (size_t)j, m * sizeof *q);
    memmove(y, b->Y + n * (size_t)j, n * sizeof *y);
    const double before = dot(r->m, q, q);
    for (int i = 0; i < kept; ++i) {
      const double part = dot(r->m, Q + m * (size_t)i, q);
      cblas_daxpy(r->m, -part, Q + m * (size_t)i, 1, q, 1);
      cblas_daxpy(b->n, -part, b->Y + n * (size_t)i, 1, y, 1);
    }
    const double norm = sqrt(dot(r->m, q, q));
    if (!(norm > least_part * sqrt(before))) continue;
    cblas_dscal(r->m, 1 / norm, q, 1);
    cblas_dscal(b->n, 1 / norm, y, 1);
    ++kept;
  }
  for (int j = kept; j < b->k; ++j) memset(Q + m * (size_t)j, 0, m * sizeof *Q);
  b->k = kept;
}

status rigid_orthonormalise(const stiffness *k, const domain *d, rigid_set *r) {
  enum { PASSES = 3 };
  r->m = k->n_row;
  for (int t = 0; t < r->n_body; ++t) {
    r->body[t].first = r->k;
    r->k += r->body[t].k;
  }
  PASS_NEW(r->Q, (size_t)r->m * (size_t)r->k);
  for (int t = 0; t < r->n_body; ++t) {
    rigid_body *b = &r->body[t];
    rigid_modes at;
    PASS_NEW(b->load, b->n);
    if (!measure_contact(k, d, b, &at)) {
      b->k = 0;
      continue;
    }
    for (int i = 0; i < b->n * b->k; i += at.modes)
      move_centre(&b->at, &at, b->Y + i);
    b->at = at;
    for (int pass = 0; pass < PASSES; ++pass) {
      contact_motions(k, d, r, b);
      gram_schmidt(r, b);
    }
  }
  return OK;
}

/* The unknown with the largest displacement by the motions left in the rows of
 * rest[m*k]. */
static int most_moved(int m, int k, const double *rest) {
  double most = 0;
  int at = 0;
  for (int i = 0; i < m; ++i) {
    const double moved = cblas_dnrm2(k, rest + i, m);
    if (moved <= most * (1 + tie)) continue;
    most = moved;
    at = i;
  }
  return at;
}

/* Gauss elimination with pivots: a pinned motion is eliminated from the
 * others. */
status rigid_pin(const rigid_set *r, const rigid_body *b,
                 unsigned char *pinned) {
  const int m = r->m, k = b->k;
  OWNED double *rest = NULL, *moved = NULL, *axis = NULL;
  PASS_NEW(rest, (size_t)m * (size_t)k);
  PASS_NEW(moved, m);
  PASS_NEW(axis, k);
  memcpy(rest, r->Q + (size_t)m * (size_t)b->first,
         (size_t)m * (size_t)k * sizeof *rest);
  for (int j = 0; j < k; ++j) {
    const int at = most_moved(m, k, rest);
    cblas_dcopy(k, rest + at, m, axis, 1);
    cblas_dscal(k, 1 / cblas_dnrm2(k, axis, 1), axis, 1);
    cblas_dgemv(CblasColMajor, CblasNoTrans, m, k, 1, rest, m, axis, 1, 0,
                moved, 1);
    cblas_dger(CblasColMajor, m, k, -1, moved, 1, axis, 1, rest, m);
    pinned[at] = 1;
  }
  return OK;
}

/* With V = A Q - Q (Q' A Q)/2:  A <- A - V Q' - Q V'. */
status rigid_project(const rigid_set *r, double *A) {
  const int m = r->m, k = r->k;
  OWNED double *V = NULL, *S = NULL;
  if (m == 0 || k == 0) return OK;
  PASS_NEW(V, (size_t)m * (size_t)k);
  PASS_NEW(S, (size_t)k * (size_t)k);
  cblas_dsymm(CblasColMajor, CblasLeft, CblasUpper, m, k, 1, A, m, r->Q, m, 0,
              V, m);
  cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, k, k, m, 1, r->Q, m, V,
              m, 0, S, k);
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, m, k, k, -0.5, r->Q, m,
              S, k, 1, V, m);
  cblas_dsyr2k(CblasColMajor, CblasUpper, CblasNoTrans, m, k, -1, V, m, r->Q, m,
               1, A, m);
  symmetric_fill((size_t)m, A);
  return OK;
}

/* Resultants of the loads on each piece. */
static void add_loads(const stiffness *k, const domain *d, const double *load,
                      rigid_body *b) {
  memset(b->load, 0, (size_t)b->n * sizeof *b->load);
  for (int t = 0; t < b->n_node; ++t) {
    const double *f = load + (size_t)k->dim * (size_t)b->node[t];
    double row[6], *to = b->load + b->column[t];
    for (int c = 0; c < k->dim; ++c) {
      if (f[c] == 0 || !unknown_row(k, d, b, b->node[t], c, row)) continue;
      for (int a = 0; a < b->at.modes; ++a) to[a] += row[a] * f[c];
    }
  }
}

void rigid_loads(const stiffness *k, const domain *d, rigid_set *r,
                 const double *load) {
  for (int t = 0; t < r->n_body; ++t)
    if (r->body[t].k > 0) add_loads(k, d, load, &r->body[t]);
}

void rigid_balance(const rigid_set *r, double *f_c) {
  for (int t = 0; t < r->n_body; ++t) {
    const rigid_body *b = &r->body[t];
    const double *Q = r->Q + (size_t)r->m * (size_t)b->first;
    for (int j = 0; j < b->k; ++j, Q += r->m) {
      const double given = dot(b->n, b->Y + (size_t)b->n * (size_t)j, b->load);
      cblas_daxpy(r->m, given - dot(r->m, Q, f_c), Q, 1, f_c, 1);
    }
  }
}
