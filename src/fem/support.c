/*
 * Rigid motions that the prescribed components leave to each set of bodies.
 *
 * A motion is a vector of rotations and translations per rigid piece (rigid.h).
 * Every prescribed component, every hinge between pieces, every tied node and,
 * in turn, every contact normal and tangent is one linear condition on the
 * pieces that it meets. The conditions are gathered by Givens rotations in a
 * triangle whose null space (singular values below rank_limit of the largest)
 * is what stays free.
 *
 * Bodies that supports and ties hold are at rest and leave the sets.
 */
#include "base/base.h"
#include "fem/rigid.h"

#include <cblas.h>
#include <lapacke.h>

/* Lever arms below this part of the body's size give no support. */
static const double rank_limit = 1e-8;
/* Motions below this part strain nothing: they are free to rounding. */
static const double exact_limit = 1e-12;
/* Motions that only gaps of ties resist, by less than this part: the factor
 * needs springs for them. */
static const double weak_limit = 1e-3;

/* ---- pieces -------------------------------------------------------------- */

/*
 * Bodies and their rigid pieces, by union-find over the elements. Elements that
 * share a face move as one rigid piece when nothing is strained; pieces that
 * share less (a vertex, in 3-D an edge) form one body with a hinge.
 */
typedef struct pieces {
  int n_body, n_piece;
  int *piece;      /* [n_elem] piece of the element */
  int *body;       /* [n_piece] body of the piece, ascending */
  int *piece_elem; /* [n_piece] its first element */
  size_t *start;   /* [n_node+1] elements round the node */
  int *elem;       /* [start[n_node]] */
} pieces;

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
  OWNED int *count = NULL, *number = NULL, *first = NULL;
  PASS_NEW_ALL(OF(count, p->n_body + 1), OF(number, p->n_piece),
               OF(first, p->n_piece), OF(p->body, p->n_piece),
               OF(p->piece_elem, p->n_piece));
  for (int e = m->n_elem; e-- > 0;) first[p->piece[e]] = e;
  for (int q = 0; q < p->n_piece; ++q) ++count[body_of[first[q]] + 1];
  for (int b = 0; b < p->n_body; ++b) count[b + 1] += count[b];
  for (int q = 0; q < p->n_piece; ++q) {
    const int b = body_of[first[q]], k = number[q] = count[b]++;
    p->body[k] = b;
    p->piece_elem[k] = first[q];
  }
  for (int e = 0; e < m->n_elem; ++e) p->piece[e] = number[p->piece[e]];
  return OK;
}

static status pieces_find(const mesh *m, pieces *p) {
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

/* ---- sets of bodies ------------------------------------------------------ */

/* What joins bodies. */
typedef enum { NOTHING, TIES, TIES_AND_PAIRS } joint;

/* Sets of bodies that move with each other. A motion of a set has the
 * coefficients of the pieces of its bodies, one after the other. */
typedef struct body_sets {
  const domain *d; /* borrowed */
  pieces p;
  int *first_piece;   /* [n_body+1] */
  rigid_modes *at;    /* [n_body] about its own centre */
  int *body;          /* [n_node] body of a node, -1: of no element */
  int *contact, *tie; /* [n_node] contact node, row of the ties; -1 */
  int *set;           /* [n_body] first body of its set, -1: at rest */
  int *column;        /* [n_body] its first coefficient in those of the set */
  int *n;            /* [n_body] coefficients of the set with this first body */
  int *start, *node; /* [n_body+1] nodes of that set: its own, and nodes at
                        rest that have masters in it, ascending */
} body_sets;

static void find_nodes(body_sets *s) {
  const domain *d = s->d;
  const pieces *p = &s->p;
  for (int i = 0; i < d->mesh->n_node; ++i) {
    s->contact[i] = s->tie[i] = s->body[i] = -1;
    if (p->start[i] < p->start[i + 1])
      s->body[i] = p->body[p->piece[p->elem[p->start[i]]]];
  }
  for (int q = 0; d->surface != NULL && q < d->surface->n; ++q)
    s->contact[d->surface->node_id[q]] = q;
  for (int q = 0; d->ties != NULL && q < d->ties->n; ++q)
    s->tie[d->ties->node_id[q]] = q;
}

/* Centre and extent of the nodes of each body; low, high[3*n_body]. */
static void measure_bodies(body_sets *s, double *low, double *high) {
  const mesh *m = s->d->mesh;
  const int n = s->p.n_body;
  for (int k = 0; k < 3 * n; ++k) {
    low[k] = HUGE_VAL;
    high[k] = -HUGE_VAL;
  }
  for (int i = 0; i < m->n_node; ++i)
    for (int c = 0; c < m->dim && s->body[i] >= 0; ++c) {
      const double x = m->x[(size_t)m->dim * i + c];
      const int at = 3 * s->body[i] + c;
      low[at] = fmin(low[at], x);
      high[at] = fmax(high[at], x);
    }
  for (int b = 0; b < n; ++b) {
    rigid_modes *r = &s->at[b];
    const int section = s->d->section_id[s->p.piece_elem[s->first_piece[b]]];
    r->dim = m->dim;
    r->modes = m->dim == 3 ? 6 : s->d->kin[section] == AXISYMMETRIC ? 1 : 3;
    for (int c = 0; c < m->dim; ++c) {
      r->centre[c] = 0.5 * (low[3 * b + c] + high[3 * b + c]);
      r->size = fmax(r->size, high[3 * b + c] - low[3 * b + c]);
    }
  }
}

/* Bodies and pieces, each body a set. */
static status sets_find(const domain *d, body_sets *s) {
  const int n_node = d->mesh->n_node;
  *s = (body_sets){.d = d};
  PASS(pieces_find(d->mesh, &s->p));
  const int n_body = s->p.n_body;
  OWNED_NEW(double, box, 6 * n_body);
  PASS_NEW_ALL(OF(s->first_piece, n_body + 1), OF(s->at, n_body),
               OF(s->body, n_node), OF(s->contact, n_node), OF(s->tie, n_node),
               OF(s->set, n_body), OF(s->column, n_body), OF(s->n, n_body),
               OF(s->start, n_body + 2), OF(s->node, n_node));
  /* Pieces of the bodies in their order. */
  const pieces *p = &s->p;
  for (int q = 0; q < p->n_piece; ++q) ++s->first_piece[p->body[q] + 1];
  for (int b = 0; b < p->n_body; ++b)
    s->first_piece[b + 1] += s->first_piece[b];
  find_nodes(s);
  measure_bodies(s, box, box + 3 * n_body);
  for (int b = 0; b < n_body; ++b) s->set[b] = b;
  return OK;
}

/* 1: some nodes move with others. */
static int sets_linked(const body_sets *s) {
  const domain *d = s->d;
  return d->ties != NULL || (d->surface != NULL && d->surface->master != NULL);
}

/* Component c of node i, relative where the node moves with others. */
static component sets_component(const body_sets *s, int i, int c) {
  component x = node_component(s->d, i, s->contact[i], c);
  if (s->tie[i] >= 0) {
    x.links = &s->d->ties->to;
    x.row = s->tie[i];
  }
  return x;
}

/* Join (or not) the sets that a node meets; that of the node or else one of its
 * masters, -1: all are at rest. */
static int join_round(body_sets *s, int i, int join) {
  int id = -1, node;
  for (int c = 0; c < s->d->mesh->dim; ++c) {
    const component x = sets_component(s, i, c);
    const int n = component_terms(&x);
    for (int t = 0; t < n; ++t) {
      if (component_term(&x, t, &node) == 0) continue;
      /* Set of a node, -1: at rest. */
      const int b = s->body[node];
      const int other = b < 0 || s->set[b] < 0 ? -1 : forest_root(s->set, b);
      if (join && id >= 0 && other >= 0) forest_join(s->set, id, other);
      if (id < 0) id = other;
    }
  }
  return id;
}

/* Nodes by set: a count, then the list. */
static void list_nodes(body_sets *s) {
  const int n_node = s->d->mesh->n_node, n_body = s->p.n_body;
  CLEAR(s->start, (n_body + 2));
  for (int pass = 0; pass < 2; ++pass) {
    for (int i = 0; i < n_node; ++i) {
      const int id = join_round(s, i, 0);
      if (id < 0) continue;
      if (pass == 0)
        ++s->start[id + 2];
      else
        s->node[s->start[id + 1]++] = i;
    }
    for (int b = 0; pass == 0 && b < n_body; ++b)
      s->start[b + 2] += s->start[b + 1];
  }
}

/* Coefficients of a body: the pieces of a turned one move alike. */
static int sets_columns(const body_sets *s, int b) {
  const int modes = s->at[b].modes;
  return modes == 1 ? 1 : modes * (s->first_piece[b + 1] - s->first_piece[b]);
}

/* Join the sets of moving bodies, number coefficients, list their nodes. */
static void sets_join(body_sets *s, joint by) {
  const int n_body = s->p.n_body;
  for (int i = 0; i < s->d->mesh->n_node; ++i)
    if ((by >= TIES && s->tie[i] >= 0) ||
        (by == TIES_AND_PAIRS && s->contact[i] >= 0))
      join_round(s, i, 1);
  CLEAR(s->n, n_body);
  for (int b = 0; b < n_body; ++b) {
    if (s->set[b] < 0) continue;
    const int id = s->set[b] = forest_root(s->set, b);
    s->column[b] = s->n[id];
    s->n[id] += sets_columns(s, b);
  }
  list_nodes(s);
}

/* First coefficient of the piece of an element, -1: at rest. */
static int sets_elem_column(const body_sets *s, int elem_id) {
  const int piece = s->p.piece[elem_id], b = s->p.body[piece];
  const int modes = s->at[b].modes;
  if (s->set[b] < 0) return -1;
  return s->column[b] + (modes == 1 ? 0 : modes * (piece - s->first_piece[b]));
}

static int sets_node_column(const body_sets *s, int i) {
  return s->body[i] < 0 ? -1 : sets_elem_column(s, s->p.elem[s->p.start[i]]);
}

/* Conditions on the coefficients of one set, upper triangle, row major. */
typedef struct triangle {
  const body_sets *s;
  int id;       /* of the set */
  int closed;   /* 1: joined surfaces touch. A turn of them all strains nothing
                   then, whatever the gaps between them */
  int n, n_row; /* coefficients; conditions */
  double *r;    /* [n*n] */
  int *end;     /* [n] row k of r is zero from end[k] on */
  int *owner;   /* [n] body of a coefficient */
  double *row;  /* [n] the next condition, zero but from "first" to "last" */
  int first, last;
  double most; /* the largest term of an entry of it */
} triangle;

/* Orthonormal motions Z[n*rank] up to a limit; the last "exact" ones up to
 * exact_limit. */
typedef struct null_basis {
  int rank, exact;
  double weakest; /* singular value above exact_limit, of the largest; 1 */
  double *Z;
} null_basis;

static status triangle_new(const body_sets *s, int id, int closed,
                           triangle *t) {
  const int n = s->n[id];
  *t = (triangle){.s = s, .id = id, .closed = closed, .n = n, .first = n};
  PASS_NEW_ALL(OF(t->r, (size_t)n * n), OF(t->end, n), OF(t->owner, n),
               OF(t->row, n));
  for (int b = id, k = 0; k < n; ++b)
    for (int a = s->set[b] == id ? sets_columns(s, b) : 0; a > 0; --a)
      t->owner[k++] = b;
  return OK;
}

/* Rotate the next condition into the triangle. */
static void add_row(triangle *t) {
  double *row = t->row;
  /* Is the condition more than rounding? A pair within one piece has none. */
  double most = 0;
  for (int k = t->first; k < t->last; ++k) most = fmax(most, fabs(t->row[k]));
  const int adds = most > exact_limit * t->most;
  t->n_row += adds;
  for (int k = t->first; adds && k < t->last; ++k) {
    double *r = t->r + (size_t)k * t->n;
    if (row[k] == 0) continue;
    const double h = hypot(r[k], row[k]), c = r[k] / h, s = row[k] / h;
    if (t->end[k] > t->last) t->last = t->end[k];
    t->end[k] = t->last;
    for (int j = k; j < t->last; ++j) {
      const double a = r[j], b = row[j];
      r[j] = c * a + s * b;
      row[j] = c * b - s * a;
    }
  }
  for (int k = t->first; k < t->last; ++k) row[k] = 0;
  t->first = t->n;
  t->last = 0;
  t->most = 0;
}

/* To the next condition: factor times the displacement along "direction" at
 * node x in the motion of a piece of body b with this first coefficient. */
static void add_term(triangle *t, int b, int column, int x, double factor,
                     const double *direction) {
  const mesh *m = t->s->d->mesh;
  const rigid_modes *at = &t->s->at[b];
  double row[6];
  modes_row(at, m->x + (size_t)m->dim * x, direction, row);
  for (int a = 0; a < at->modes; ++a) {
    t->row[column + a] += factor * row[a];
    t->most = fmax(t->most, fabs(factor * row[a]));
  }
  if (column < t->first) t->first = column;
  if (column + at->modes > t->last) t->last = column + at->modes;
}

/* 1: the component does not move with bodies of other sets. */
static int is_within(const triangle *t, const component *x) {
  const int n = component_terms(x);
  int node;
  for (int k = 0; k < n; ++k) {
    const double factor = component_term(x, k, &node);
    const int id = t->s->set[t->s->body[node]];
    if (factor != 0 && id >= 0 && id != t->id) return 0;
  }
  return 1;
}

static void add_condition(triangle *t, int i, int c) {
  const component x = sets_component(t->s, i, c);
  const int n = is_within(t, &x) ? component_terms(&x) : 0;
  int node;
  for (int k = 0; k < n; ++k) {
    const double factor = component_term(&x, k, &node);
    const int column = sets_node_column(t->s, node);
    if (factor != 0 && column >= 0)
      add_term(t, t->s->body[node], column, t->closed ? i : node, factor,
               x.direction);
  }
  add_row(t);
}

/* Pieces that meet at a node move it alike. */
static void add_hinges(triangle *t, int i) {
  const body_sets *s = t->s;
  const pieces *p = &s->p;
  const int first = sets_node_column(s, i);
  for (size_t q = p->start[i] + 1; q < p->start[i + 1]; ++q) {
    const int other = sets_elem_column(s, p->elem[q]);
    for (int c = 0; c < s->d->mesh->dim && other != first; ++c) {
      double direction[3] = {0};
      direction[c] = 1;
      add_term(t, s->body[i], first, i, 1, direction);
      add_term(t, s->body[i], other, i, -1, direction);
      add_row(t);
    }
  }
}

/* Is component c of node i prescribed? Tied ones are, relative to masters. */
static int is_prescribed(const body_sets *s, int i, int c) {
  const domain *d = s->d;
  const int dim = d->mesh->dim, q = s->contact[i];
  return q >= 0 ? d->surface->held[dim * q + c]
                : s->tie[i] >= 0 || d->fixed[(size_t)dim * i + c];
}

static void add_supports(triangle *t) {
  const body_sets *s = t->s;
  for (int k = s->start[t->id]; k < s->start[t->id + 1]; ++k) {
    const int i = s->node[k];
    if (s->set[s->body[i]] >= 0) add_hinges(t, i);
    for (int c = 0; c < s->d->mesh->dim; ++c)
      if (is_prescribed(s, i, c)) add_condition(t, i, c);
  }
}

static motion_hold holds_as(const domain *d, int q, int c) {
  const contact_surface *f = d->surface;
  if (c == 0 || f->side_id[(f->dim - 1) * q + c - 1] >= 0)
    return HELD_BY_CONTACT;
  return d->rubs == NULL || d->rubs[f->contact_id[q]] ? HELD_BY_FRICTION
                                                      : HELD_BY_TANGENTS;
}

/* Contact unknowns by what they hold as they are: normals are one-sided. */
static void add_contact(triangle *t, motion_hold by) {
  const body_sets *s = t->s;
  const contact_surface *f = s->d->surface;
  for (int k = s->start[t->id]; k < s->start[t->id + 1]; ++k) {
    const int i = s->node[k], q = s->contact[i];
    for (int c = 0; q >= 0 && c < f->dim; ++c)
      if (!f->held[f->dim * q + c] && holds_as(s->d, q, c) == by)
        add_condition(t, i, c);
  }
}

/* 1: surely no singular value below the limit, of the largest. The square of
 * their least ratio is not below the product of the reciprocal condition
 * numbers in the 1-norm and the infinity norm, whose estimates may miss by a
 * factor. */
static status is_regular(const triangle *t, double limit, int *regular) {
  enum { MISSED = 10 };
  const int n = t->n;
  double one, infinity;
  OWNED_NEW(double, work, 3 * n);
  OWNED_NEW(lapack_int, number, n);
  if (LAPACKE_dtrcon_work(LAPACK_COL_MAJOR, '1', 'L', 'N', n, t->r, n, &one,
                          work, number) != 0 ||
      LAPACKE_dtrcon_work(LAPACK_COL_MAJOR, 'I', 'L', 'N', n, t->r, n,
                          &infinity, work, number) != 0)
    RAISE(ERR_INTERNAL, "condition of the supports not found");
  *regular = sqrt(one * infinity) > MISSED * limit;
  return OK;
}

/* Null space of the triangle: the left singular vectors of its transpose, in
 * column major order. Z stays NULL if there is none. */
static status find_null_space(const triangle *t, double limit, double *u,
                              null_basis *z) {
  const int n = t->n;
  OWNED double *a = NULL, *s = NULL, *work = NULL;
  double none;
  PASS_NEW_ALL(OF(a, (size_t)n * n), OF(s, n), OF(work, 16 * n));
  COPY(a, t->r, (size_t)n * n);
  if (LAPACKE_dgesvd_work(LAPACK_COL_MAJOR, 'A', 'N', n, n, a, n, s, u, n,
                          &none, 1, work, 16 * n) != 0)
    RAISE(ERR_INTERNAL, "singular values of the supports not found");
  for (int k = 0; k < n; ++k) {
    z->rank += !(s[k] > limit * s[0]);
    z->exact += !(s[k] > exact_limit * s[0]);
    if (s[k] > exact_limit * s[0]) z->weakest = s[k] / s[0];
  }
  memmove(u, u + (size_t)(n - z->rank) * n, (size_t)z->rank * n * sizeof *u);
  return OK;
}

static status null_space(const triangle *t, double limit, null_basis *z) {
  const int n = t->n;
  int regular = 0;
  *z = (null_basis){.weakest = 1};
  if (t->n_row >= n) PASS(is_regular(t, limit, &regular));
  if (regular) return OK;
  PASS_NEW(z->Z, (size_t)n * n);
  if (t->n_row > 0) return find_null_space(t, limit, z->Z, z);
  z->rank = z->exact = n;
  for (int k = 0; k < n; ++k) z->Z[(size_t)k * (n + 1)] = 1;
  return OK;
}

/* Reduced row echelon form, so that motions come out along the axes. */
static void reduce_rows(size_t n_row, size_t n, double *Z) {
  size_t done = 0;
  for (size_t col = 0; col < n && done < n_row; ++col) {
    size_t best = done;
    for (size_t i = done; i < n_row; ++i)
      if (fabs(Z[i * n + col]) > fabs(Z[best * n + col])) best = i;
    if (fabs(Z[best * n + col]) < 1e-6) continue;
    for (size_t j = 0; j < n; ++j) {
      const double v = Z[best * n + j];
      Z[best * n + j] = Z[done * n + j];
      Z[done * n + j] = v;
    }
    const double pivot = Z[done * n + col];
    for (size_t j = 0; j < n; ++j) Z[done * n + j] /= pivot;
    for (size_t i = 0; i < n_row; ++i) {
      const double factor = Z[i * n + col];
      if (i == done || factor == 0) continue;
      for (size_t j = 0; j < n; ++j) Z[i * n + j] -= factor * Z[done * n + j];
    }
    ++done;
  }
}

typedef struct motion_list {
  int n, capacity;
  free_motion *item;
} motion_list;

/* Modes of the piece with a coefficient. */
static int modes_at(const triangle *t, int k) {
  return t->s->at[t->owner[k]].modes;
}

/* Name the motion z by the piece that moves most. */
static void describe(const triangle *t, const double *z, free_motion *f) {
  const body_sets *s = t->s;
  double largest = -1;
  int most = 0;
  for (int k = 0; k < t->n; k += modes_at(t, k)) {
    const double norm = cblas_ddot(modes_at(t, k), z + k, 1, z + k, 1);
    if (!(norm > largest * (1 + 1e-6))) continue;
    largest = norm;
    most = k;
  }
  const int b = t->owner[most];
  const int piece = s->first_piece[b] + (most - s->column[b]) / s->at[b].modes;
  f->set_id = t->id;
  f->body_id = b;
  f->elem_no = s->d->mesh->elem_no[s->p.piece_elem[piece]];
  modes_text(&s->at[b], z + most, f->text, sizeof f->text);
}

static int turns(const triangle *t, const double *z) {
  double most = 0;
  for (int k = 0; k < t->n; k += modes_at(t, k))
    for (int a = 0; a < modes_at(t, k) / 2; ++a) /* 3-D: 3, 2-D: 1 */
      most = fmax(most, fabs(z[k + a]));
  return most > 1e-6;
}

/* Motions of one set, as they are found. */
typedef struct finder {
  triangle t;
  null_basis of[HELD_BY_CONTACT + 1]; /* what is left without that and less */
  double *known;                      /* [n*n] orthonormal rows */
  double *rest, *part;                /* [n] */
  int n_known;
} finder;

/* Add z to the known rows unless it depends on them. */
static int is_new_motion(finder *f, const double *z) {
  const int n = f->t.n, m = f->n_known;
  double *rest = f->rest;
  COPY(rest, z, n);
  for (int pass = 0; pass < 2; ++pass) {
    cblas_dgemv(CblasColMajor, CblasTrans, n, m, 1, f->known, n, rest, 1, 0,
                f->part, 1);
    cblas_dgemv(CblasColMajor, CblasNoTrans, n, m, -1, f->known, n, f->part, 1,
                1, rest, 1);
  }
  const double left = cblas_ddot(n, rest, 1, rest, 1);
  if (!(left > 1e-12 * cblas_ddot(n, z, 1, z, 1))) return 0;
  cblas_dscal(n, 1 / sqrt(left), rest, 1);
  COPY(f->known + (size_t)m * n, rest, n);
  ++f->n_known;
  return 1;
}

/* Append the motions of a null space that are new, translations first. */
static status append_motions(finder *f, motion_hold hold, motion_list *list) {
  const null_basis *of = &f->of[hold];
  const size_t n = f->t.n;
  reduce_rows(of->rank, n, of->Z);
  for (int rotation = 0; rotation < 2; ++rotation)
    for (int i = 0; i < of->rank; ++i) {
      const double *z = of->Z + i * n;
      if (turns(&f->t, z) != rotation || !is_new_motion(f, z)) continue;
      PASS_GROW(list->item, list->n, list->capacity);
      list->item[list->n].held_by = hold;
      describe(&f->t, z, &list->item[list->n++]);
    }
  return OK;
}

/* What supports, hinges and ties leave a set. */
static status supported_space(const body_sets *s, int id, int closed,
                              triangle *t, null_basis *z) {
  PASS(triangle_new(s, id, closed, t));
  add_supports(t);
  return null_space(t, closed ? rank_limit : weak_limit, z);
}

static status find_spaces(const body_sets *s, int id, motion_hold most,
                          finder *f) {
  PASS(supported_space(s, id, 1, &f->t, &f->of[HELD_BY_CONTACT]));
  const int n = f->t.n;
  if (f->of[HELD_BY_CONTACT].rank == 0) return OK;
  for (int by = HELD_BY_CONTACT; by > HELD_BY_NOTHING; --by) {
    add_contact(&f->t, (motion_hold)by);
    if (by - 1 <= (int)most)
      PASS(null_space(&f->t, rank_limit, &f->of[by - 1]));
  }
  PASS_NEW_ALL(OF(f->known, (size_t)n * n), OF(f->rest, n), OF(f->part, n));
  return OK;
}

static status set_motions(const body_sets *s, int id, motion_hold most,
                          motion_list *list, int *n_free) {
  OWNED_PARTS(finder, f, find_spaces(s, id, most, &f));
  *n_free += f.of[HELD_BY_CONTACT].rank;
  if (f.of[HELD_BY_CONTACT].rank == 0) return OK;
  for (int hold = HELD_BY_NOTHING; hold <= (int)most; ++hold)
    PASS(append_motions(&f, (motion_hold)hold, list));
  return OK;
}

/* 1: supports, hinges and ties leave the set no motion. */
static status is_at_rest(const body_sets *s, int id, unsigned char *rest) {
  null_basis z;
  OWNED_PARTS(triangle, t, supported_space(s, id, 1, &t, &z));
  *rest = z.rank == 0;
  return OK;
}

/* Bodies that their supports hold leave first, then those tied to them. */
static status drop_bodies_at_rest(body_sets *s) {
  OWNED_NEW(unsigned char, rest, s->p.n_body);
  for (int by = NOTHING; by <= TIES; ++by) {
    sets_join(s, (joint)by);
    for (int id = 0; id < s->p.n_body; ++id)
      if (s->set[id] == id) PASS(is_at_rest(s, id, &rest[id]));
    for (int b = 0; b < s->p.n_body; ++b)
      if (s->set[b] >= 0 && rest[s->set[b]]) s->set[b] = -1;
  }
  return OK;
}

static status moving_sets(const domain *d, body_sets *s) {
  PASS(sets_find(d, s));
  if (sets_linked(s)) PASS(drop_bodies_at_rest(s));
  sets_join(s, TIES_AND_PAIRS);
  return OK;
}

status domain_free_motions(const domain *d, motion_hold most, int *n_free,
                           int *n, free_motion **list) {
  motion_list found = {0};
  *n = *n_free = 0;
  *list = NULL;
  OWNED_PARTS(body_sets, s, moving_sets(d, &s));
  for (int id = 0; id < s.p.n_body; ++id) {
    const status st =
        s.set[id] == id ? set_motions(&s, id, most, &found, n_free) : OK;
    *list = found.item;
    if (st != OK) return st;
  }
  *n = found.n;
  return OK;
}

/* ---- motions for the condensed problem ----------------------------------- */

static status keep_places(const body_sets *s, rigid_motions *r) {
  const size_t n_body = s->p.n_body;
  const int n_node = s->d->mesh->n_node;
  r->n_body = s->p.n_body;
  PASS_NEW_ALL(OF(r->at, n_body), OF(r->body, n_node), OF(r->column, n_node));
  COPY(r->at, s->at, n_body);
  COPY(r->body, s->body, n_node);
  for (int i = 0; i < n_node; ++i) r->column[i] = sets_node_column(s, i);
  return OK;
}

static status add_set(const triangle *t, const null_basis *z,
                      rigid_motions *r) {
  const body_sets *s = t->s;
  const int *node = s->node + s->start[t->id];
  const size_t n = t->n;
  ADDED(rigid_set, to, r->set, r->n_set, r->capacity);
  *to = (rigid_set){.n = t->n,
                    .n_motion = z->rank,
                    .k = z->exact,
                    .weakest = z->weakest,
                    .n_node = s->start[t->id + 1] - s->start[t->id]};
  PASS_NEW_ALL(OF(to->Y, n * to->k), OF(to->owner, n),
               OF(to->node, to->n_node));
  COPY(to->Y, z->Z + n * (z->rank - z->exact), n * to->k);
  COPY(to->owner, t->owner, n);
  COPY(to->node, node, to->n_node);
  return OK;
}

/* The gaps of ties count: their masters pull where they are. */
static status add_motions(const body_sets *s, int id, rigid_motions *r) {
  null_basis z;
  OWNED_PARTS(triangle, t, supported_space(s, id, s->d->ties == NULL, &t, &z));
  return z.rank > 0 ? add_set(&t, &z, r) : OK;
}

status rigid_find(const domain *d, rigid_motions *r) {
  OWNED_PARTS(body_sets, s, moving_sets(d, &s));
  PASS(keep_places(&s, r));
  for (int id = 0; id < s.p.n_body; ++id)
    if (s.set[id] == id) PASS(add_motions(&s, id, r));
  return OK;
}
