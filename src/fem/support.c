/*
 * Rigid motions that the prescribed components leave to each body.
 *
 * A motion is a vector of rotations and translations per rigid piece (rigid.h).
 * Every prescribed component, every hinge between pieces and, in turn, every
 * contact normal and tangent is one linear condition on it. The conditions are
 * gathered by Givens rotations in a triangle whose null space (singular values
 * below rank_limit of the largest) is what stays free.
 */
#include "base/memory.h"
#include "fem/pieces.h"
#include "fem/rigid.h"

#include <lapacke.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Lever arms below this part of the body's size give no support. */
static const double rank_limit = 1e-8;
/* Motions below this part strain nothing: they are free to rounding. */
static const double exact_limit = 1e-12;
/* Bodies with more rigid pieces are taken as one rigid piece. */
enum { MAX_PIECES = 16, MAX_COLUMNS = 6 * MAX_PIECES };

typedef struct body {
  const domain *d;
  const pieces *p;
  const int *contact;                   /* [n_node] contact node or -1 */
  int id, first_piece, n_piece, joined; /* joined: pieces count as one */
  int n;                                /* columns: motions of all pieces */
  int n_node;
  const int *node; /* [n_node] of this body */
  rigid_modes at;
} body;

typedef struct triangle { /* upper, row major */
  int n;
  double r[MAX_COLUMNS * MAX_COLUMNS];
} triangle;

/* One more condition: rotate the row into the triangle; row is destroyed. */
static void add_row(triangle *t, double *row) {
  for (int k = 0; k < t->n; ++k) {
    double *r = t->r + (size_t)k * (size_t)t->n;
    if (row[k] == 0) continue;
    const double h = hypot(r[k], row[k]), c = r[k] / h, s = row[k] / h;
    for (int j = k; j < t->n; ++j) {
      const double a = r[j], b = row[j];
      r[j] = c * a + s * b;
      row[j] = c * b - s * a;
    }
  }
}

/* Coefficients of the displacement along "direction" at a node in the motion
 * of one piece. */
static void motion_row(const body *b, int node, const double *direction,
                       double *row) {
  const mesh *m = b->d->mesh;
  rigid_row(&b->at, m->x + (size_t)m->dim * (size_t)node, direction, row);
}

static int column_of(const body *b, int elem_id) {
  return b->joined ? 0 : b->at.modes * (b->p->piece[elem_id] - b->first_piece);
}

static void add_condition(const body *b, int node, const double *direction,
                          triangle *t) {
  double row[MAX_COLUMNS] = {0};
  motion_row(b, node, direction,
             row + column_of(b, b->p->elem[b->p->start[node]]));
  add_row(t, row);
}

/* Pieces that meet at a node move it alike. */
static void add_hinges(const body *b, int node, triangle *t) {
  const pieces *p = b->p;
  const int dim = b->d->mesh->dim,
            first = column_of(b, p->elem[p->start[node]]);
  for (size_t q = p->start[node] + 1; q < p->start[node + 1]; ++q) {
    const int other = column_of(b, p->elem[q]);
    if (other == first) continue;
    for (int c = 0; c < dim; ++c) {
      double row[MAX_COLUMNS] = {0}, direction[3] = {0};
      direction[c] = 1;
      motion_row(b, node, direction, row + first);
      motion_row(b, node, direction, row + other);
      for (int k = 0; k < b->at.modes; ++k) row[other + k] = -row[other + k];
      add_row(t, row);
    }
  }
}

static void add_supports(const body *b, triangle *t) {
  const domain *d = b->d;
  const int dim = d->mesh->dim;
  for (int k = 0; k < b->n_node; ++k) {
    const int i = b->node[k], q = b->contact[i];
    if (!b->joined && b->n_piece > 1) add_hinges(b, i, t);
    for (int c = 0; c < dim; ++c) {
      double direction[3] = {0};
      for (int j = 0; j < dim; ++j)
        direction[j] =
            q < 0 ? j == c : d->surface->frame[dim * (dim * q + c) + j];
      if (q < 0 ? d->fixed[(size_t)dim * (size_t)i + (size_t)c]
                : d->surface->held[dim * q + c])
        add_condition(b, i, direction, t);
    }
  }
}

/* Contact unknowns that are normals of an obstacle, or the other ones. */
static void add_contact(const body *b, int normals, triangle *t) {
  const contact_surface *s = b->d->surface;
  if (s == NULL) return;
  for (int k = 0; k < b->n_node; ++k) {
    const int q = b->contact[b->node[k]];
    if (q < 0) continue;
    for (int c = 0; c < s->dim; ++c) {
      const int one_sided = c == 0 || s->side_id[(s->dim - 1) * q + c - 1] >= 0;
      double direction[3] = {0};
      if (s->held[s->dim * q + c] || one_sided != normals) continue;
      memcpy(direction, s->frame + s->dim * (s->dim * q + c),
             (size_t)s->dim * sizeof *direction);
      add_condition(b, s->node_id[q], direction, t);
    }
  }
}

/* Orthonormal null space of the triangle, singular values up to a part "limit"
 * of the largest: rows of Z; its dimension. */
static status null_space(const triangle *t, double limit, double *Z,
                         int *rank) {
  const int n = t->n;
  OWNED double *a = NULL, *u = NULL, *work = NULL;
  double s[MAX_COLUMNS], none;
  PASS_NEW(a, n * n);
  PASS_NEW(u, n * n);
  PASS_NEW(work, 16 * n);
  /* The transpose in column major order: its left vectors are wanted. */
  memcpy(a, t->r, (size_t)(n * n) * sizeof *a);
  if (LAPACKE_dgesvd_work(LAPACK_COL_MAJOR, 'A', 'N', n, n, a, n, s, u, n,
                          &none, 1, work, 16 * n) != 0)
    RAISE(ERR_INTERNAL, "singular values of the supports not found");
  *rank = 0;
  for (int k = 0; k < n; ++k) {
    if (s[0] > 0 && s[k] > limit * s[0]) continue;
    memcpy(Z + (size_t)(*rank)++ * (size_t)n, u + (size_t)k * (size_t)n,
           (size_t)n * sizeof *Z);
  }
  return OK;
}

/* Reduced row echelon form, so that motions come out along the axes. */
static void reduce_rows(int n_row, int n, double *Z) {
  int done = 0;
  for (int col = 0; col < n && done < n_row; ++col) {
    int best = done;
    for (int i = done; i < n_row; ++i)
      if (fabs(Z[i * n + col]) > fabs(Z[best * n + col])) best = i;
    if (fabs(Z[best * n + col]) < 1e-6) continue;
    for (int j = 0; j < n; ++j) {
      const double v = Z[best * n + j];
      Z[best * n + j] = Z[done * n + j];
      Z[done * n + j] = v;
    }
    const double pivot = Z[done * n + col];
    for (int j = 0; j < n; ++j) Z[done * n + j] /= pivot;
    for (int i = 0; i < n_row; ++i) {
      const double factor = Z[i * n + col];
      if (i == done || factor == 0) continue;
      for (int j = 0; j < n; ++j) Z[i * n + j] -= factor * Z[done * n + j];
    }
    ++done;
  }
}

/* "x" or "(0.6, 0.8, 0)" for a direction; "(1, 2)" for a point. */
static void write_vector(int dim, const double *v, int direction, char *text,
                         size_t size) {
  double most = 0, norm = 0;
  int at = 0, single = direction;
  for (int c = 0; c < dim; ++c) {
    norm += v[c] * v[c];
    if (fabs(v[c]) > most) {
      most = fabs(v[c]);
      at = c;
    }
  }
  for (int c = 0; c < dim; ++c)
    if (c != at && fabs(v[c]) > 1e-6 * most) single = 0;
  if (single) {
    snprintf(text, size, "%c", "xyz"[at]);
    return;
  }
  size_t used = 0;
  for (int c = 0; c < dim && used < size; ++c)
    used += (size_t)snprintf(text + used, size - used, "%s%.6g",
                             c == 0 ? "(" : ", ",
                             direction ? v[c] / sqrt(norm) : v[c]);
  if (used < size) snprintf(text + used, size - used, ")");
}

/* A coordinate of the body from one relative to its centre and size. */
static double to_coordinate(const body *b, int c, double relative) {
  const double x = b->at.centre[c] + b->at.size * relative;
  return fabs(x) < 1e-9 * b->at.size ? 0 : x;
}

static void write_rotation_3d(const body *b, const double *w, const double *t,
                              char *text, size_t size) {
  char axis[64], through[64];
  double ww = 0, tw = 0, point[3];
  for (int c = 0; c < 3; ++c) {
    ww += w[c] * w[c];
    tw += t[c] * w[c];
  }
  for (int c = 0; c < 3; ++c) {
    const int i = (c + 1) % 3, j = (c + 2) % 3;
    point[c] = to_coordinate(b, c, (w[i] * t[j] - w[j] * t[i]) / ww);
  }
  write_vector(3, w, 1, axis, sizeof axis);
  write_vector(3, point, 0, through, sizeof through);
  snprintf(text, size, "%s about %s through %s",
           fabs(tw) > 1e-6 * ww ? "screw motion" : "rotation", axis, through);
}

/* Name the motion v of one piece. */
static void write_motion(const body *b, const double *v, char *text,
                         size_t size) {
  const int dim = b->d->mesh->dim;
  char vector[64];
  if (b->at.modes == 1) {
    snprintf(text, size, "translation along y");
  } else if (dim == 2 && fabs(v[0]) > 1e-6 * hypot(v[1], v[2])) {
    const double point[2] = {to_coordinate(b, 0, -v[2] / v[0]),
                             to_coordinate(b, 1, v[1] / v[0])};
    write_vector(2, point, 0, vector, sizeof vector);
    snprintf(text, size, "rotation about %s", vector);
  } else if (dim == 3 &&
             v[0] * v[0] + v[1] * v[1] + v[2] * v[2] >
                 1e-12 * (v[3] * v[3] + v[4] * v[4] + v[5] * v[5])) {
    write_rotation_3d(b, v, v + 3, text, size);
  } else {
    write_vector(dim, v + (dim == 2 ? 1 : 3), 1, vector, sizeof vector);
    snprintf(text, size, "translation along %s", vector);
  }
}

static void describe(const body *b, const double *z, free_motion *f) {
  int most = 0;
  double largest = -1;
  for (int q = 0; q < (b->joined ? 1 : b->n_piece); ++q) {
    double norm = 0;
    for (int k = 0; k < b->at.modes; ++k)
      norm += z[b->at.modes * q + k] * z[b->at.modes * q + k];
    if (norm > largest * (1 + 1e-6)) {
      largest = norm;
      most = q;
    }
  }
  const mesh *m = b->d->mesh;
  f->body_id = b->id;
  f->elem_no = m->elem_no[b->p->piece_elem[b->first_piece + most]];
  write_motion(b, z + b->at.modes * most, f->text, sizeof f->text);
}

typedef struct motion_list {
  int n, capacity;
  free_motion *item;
} motion_list;

static int turns(const body *b, const double *z) {
  const int rotations = b->at.modes == 6 ? 3 : b->at.modes == 3 ? 1 : 0;
  double most = 0;
  for (int k = 0; k < b->n; ++k)
    if (k % b->at.modes < rotations) most = fmax(most, fabs(z[k]));
  return most > 1e-6;
}

/* Add z to the orthonormal rows of "known" unless it depends on them. */
static int is_new_motion(int n, const double *z, double *known, int *n_known) {
  double rest[MAX_COLUMNS], norm = 0, left = 0;
  memcpy(rest, z, (size_t)n * sizeof *rest);
  for (int j = 0; j < n; ++j) norm += rest[j] * rest[j];
  for (int pass = 0; pass < 2; ++pass)
    for (int q = 0; q < *n_known; ++q) {
      double dot = 0;
      for (int j = 0; j < n; ++j) dot += known[q * n + j] * rest[j];
      for (int j = 0; j < n; ++j) rest[j] -= dot * known[q * n + j];
    }
  for (int j = 0; j < n; ++j) left += rest[j] * rest[j];
  if (!(left > 1e-12 * norm)) return 0;
  for (int j = 0; j < n; ++j) known[*n_known * n + j] = rest[j] / sqrt(left);
  ++*n_known;
  return 1;
}

/* Append the motions of Z[n_row*n] that are new, translations first. */
static status append_motions(const body *b, motion_hold hold, int n_row,
                             double *Z, double *known, int *n_known,
                             motion_list *list) {
  status st = OK;
  reduce_rows(n_row, b->n, Z);
  for (int rotation = 0; rotation < 2; ++rotation)
    for (int i = 0; i < n_row; ++i) {
      const double *z = Z + i * b->n;
      if (turns(b, z) != rotation || !is_new_motion(b->n, z, known, n_known))
        continue;
      GROW(list->item, list->n, list->capacity);
      list->item[list->n].held_by = hold;
      describe(b, z, &list->item[list->n++]);
    }
done:
  return st;
}

/* Store what the supports in t leave free to rounding. */
static status keep_motions(const body *b, const triangle *t, rigid_set *r) {
  int rank = 0;
  OWNED double *Z = NULL;
  PASS_NEW(Z, b->n * b->n);
  PASS(null_space(t, exact_limit, Z, &rank));
  if (rank == 0) return OK;
  PASS_GROW(r->body, r->n_body, r->capacity);
  rigid_body *to = &r->body[r->n_body++];
  *to = (rigid_body){
      .id = b->id, .at = b->at, .n = b->n, .k = rank, .n_node = b->n_node};
  PASS_NEW(to->node, b->n_node);
  PASS_NEW(to->column, b->n_node);
  memcpy(to->node, b->node, (size_t)b->n_node * sizeof *to->node);
  for (int i = 0; i < b->n_node; ++i)
    to->column[i] = column_of(b, b->p->elem[b->p->start[b->node[i]]]);
  to->Y = Z;
  Z = NULL;
  return OK;
}

static status body_motions(const body *b, motion_list *list, rigid_set *r) {
  status st = OK;
  triangle *t = NULL;
  double *Z[3] = {NULL, NULL, NULL}, *known = NULL;
  int rank[3], n_known = 0;
  NEW(t, 1);
  NEW(known, b->n * b->n);
  t->n = b->n;
  add_supports(b, t);
  if (r != NULL) TRY(keep_motions(b, t, r));
  for (int hold = HELD_BY_CONTACT; hold >= HELD_BY_NOTHING; --hold) {
    NEW(Z[hold], b->n * b->n);
    TRY(null_space(t, rank_limit, Z[hold], &rank[hold]));
    if (hold > HELD_BY_NOTHING) add_contact(b, hold == HELD_BY_CONTACT, t);
  }
  for (int hold = HELD_BY_NOTHING; hold <= HELD_BY_CONTACT; ++hold)
    TRY(append_motions(b, (motion_hold)hold, rank[hold], Z[hold], known,
                       &n_known, list));
done:
  RELEASE(t, known);
  for (int i = 0; i < 3; ++i) memory_free(Z[i]);
  return st;
}

/* Centre and extent of the nodes of the body. */
static void measure_body(body *b) {
  const mesh *m = b->d->mesh;
  double low[3], high[3];
  for (int i = 0; i < b->n_node; ++i) {
    const double *x = m->x + (size_t)m->dim * (size_t)b->node[i];
    for (int c = 0; c < m->dim; ++c) {
      if (i == 0 || x[c] < low[c]) low[c] = x[c];
      if (i == 0 || x[c] > high[c]) high[c] = x[c];
    }
  }
  for (int c = 0; c < m->dim; ++c) {
    b->at.centre[c] = 0.5 * (low[c] + high[c]);
    b->at.size = fmax(b->at.size, high[c] - low[c]);
  }
}

/* Nodes sorted by body: node[start[b] .. start[b+1]). */
static status nodes_by_body(const mesh *m, const pieces *p, int **start,
                            int **node) {
  status st = OK;
  int *s = NULL, *list = NULL;
  NEW(s, p->n_body + 2);
  NEW(list, m->n_node);
  for (int pass = 0; pass < 2; ++pass) {
    for (int i = 0; i < m->n_node; ++i) {
      if (p->start[i] == p->start[i + 1]) continue;
      const int b = p->body[p->piece[p->elem[p->start[i]]]];
      if (pass == 0)
        ++s[b + 2];
      else
        list[s[b + 1]++] = i;
    }
    for (int b = 0; pass == 0 && b < p->n_body; ++b) s[b + 2] += s[b + 1];
  }
done:
  *start = s;
  *node = list;
  return st;
}

status support_motions(const domain *d, int *n, free_motion **list,
                       unsigned char *floating, rigid_set *r) {
  status st = OK;
  const mesh *m = d->mesh;
  pieces p = {0};
  motion_list found = {0};
  int *contact = NULL, *start = NULL, *node = NULL;
  NEW(contact, m->n_node);
  TRY(pieces_find(m, &p));
  TRY(nodes_by_body(m, &p, &start, &node));
  for (int i = 0; i < m->n_node; ++i) contact[i] = -1;
  for (int q = 0; d->surface != NULL && q < d->surface->n; ++q)
    contact[d->surface->node_id[q]] = q;
  for (int q = 0; q < p.n_piece;) {
    body b = {.d = d, .p = &p, .contact = contact, .id = p.body[q]};
    b.first_piece = q;
    while (q < p.n_piece && p.body[q] == b.id) ++q;
    b.n_piece = q - b.first_piece;
    b.n_node = start[b.id + 1] - start[b.id];
    b.node = node + start[b.id];
    const int section = d->section_id[p.piece_elem[b.first_piece]];
    b.at.dim = m->dim;
    b.at.modes = m->dim == 3 ? 6 : d->kin[section] == AXISYMMETRIC ? 1 : 3;
    b.joined = b.n_piece > MAX_PIECES || b.at.modes == 1;
    b.n = b.at.modes * (b.joined ? 1 : b.n_piece);
    measure_body(&b);
    const int before = found.n;
    TRY(body_motions(&b, &found, r));
    for (int i = 0; floating != NULL && i < b.n_node; ++i)
      floating[b.node[i]] = found.n > before;
  }
done:
  pieces_release(&p);
  RELEASE(contact, start, node);
  if (st != OK) {
    memory_free(found.item);
    found = (motion_list){0};
  }
  *n = found.n;
  *list = found.item;
  return st;
}

status domain_free_motions(const domain *d, int *n, free_motion **list) {
  return support_motions(d, n, list, NULL, NULL);
}
