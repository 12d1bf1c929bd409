/*
 * The motions are chosen so that R_c = Q is orthonormal: a step of modified
 * Gram-Schmidt on R_c goes through their coefficients Y too, and R_c is then
 * computed again from them. So each column is a rigid motion to rounding, also
 * where few or close contact nodes make the motions nearly dependent.
 */
#include "fem/rigid.h"

#include "base/base.h"
#include "fem/factor.h"

#include <cblas.h>
#include <lapacke.h>

/* Motions that move the contact unknowns less than this part of what they
 * share with the motions before them are free. */
static const double least_part = 1e-10;
/* Leverages that count as equal: the first unknown is taken. */
static const double tie = 1e-6;

component node_component(const domain *d, int i, int q, int c) {
  const int dim = d->mesh->dim;
  component x = {.node = i, .c = c};
  x.direction[c] = 1;
  if (q < 0) return x;
  for (int k = 0; k < dim; ++k)
    x.direction[k] = d->surface->frame[dim * (dim * q + c) + k] /
                     surface_share(d->surface, q, c);
  x.links = d->surface->master;
  x.row = q;
  return x;
}

int component_terms(const component *x) {
  return x->links == NULL
             ? 1
             : 1 + (int)(x->links->start[x->row + 1] - x->links->start[x->row]);
}

double component_term(const component *x, int t, int *node) {
  *node = x->node;
  if (t == 0) return 1;
  const node_links *l = x->links;
  const size_t e = l->start[x->row] + t - 1;
  *node = l->master[e];
  return -l->part[l->dim * e + x->c];
}

/* Is component c of node i unknown? Prescribed ones do not move. */
static int is_unknown(const stiffness *k, int i, int c) {
  return k->free[i] >> c & 1;
}

/* Term t of a component: its factor, coefficients row[modes] and the first of
 * them in the set, which is returned; -1: it does not move. */
static int term_row(const domain *d, const rigid_motions *r, const component *x,
                    int t, double *factor, double *row) {
  int node;
  *factor = component_term(x, t, &node);
  if (*factor == 0 || r->column[node] < 0) return -1;
  modes_row(&r->at[r->body[node]], d->mesh->x + (size_t)d->mesh->dim * node,
            x->direction, row);
  return r->column[node];
}

typedef struct box {
  double low[3], high[3];
  int found;
} box;

static void extend(const domain *d, int node, box *b) {
  const double *x = d->mesh->x + (size_t)d->mesh->dim * node;
  for (int c = 0; c < d->mesh->dim; ++c) {
    if (!b->found || x[c] < b->low[c]) b->low[c] = x[c];
    if (!b->found || x[c] > b->high[c]) b->high[c] = x[c];
  }
  b->found = 1;
}

/* Boxes round the nodes of each body that move contact unknowns of the set. */
static void measure_contact(const stiffness *k, const domain *d,
                            const rigid_motions *r, const rigid_set *s,
                            box *of) {
  int node;
  for (int t = 0; t < s->n_node; ++t) {
    const int q = k->contact[s->node[t]];
    const component x = node_component(d, s->node[t], q, 0);
    const int n = component_terms(&x);
    for (int e = 0; q >= 0 && e < n; ++e) {
      component_term(&x, e, &node);
      if (r->column[node] >= 0) extend(d, node, &of[r->body[node]]);
    }
  }
}

/* About the centre of the box; the extent is that of the body if the box has
 * none. */
static rigid_modes modes_about(const rigid_modes *old, const box *b) {
  rigid_modes at = *old;
  double size = 0;
  for (int c = 0; c < at.dim; ++c) {
    at.centre[c] = 0.5 * (b->low[c] + b->high[c]);
    size = fmax(size, b->high[c] - b->low[c]);
  }
  if (size > 0) at.size = size;
  return at;
}

/* Contact unknown x of the motions of a set: to[m*k], row by row. */
static void contact_motion(const domain *d, const rigid_motions *r,
                           const rigid_set *s, const component *x, double *to) {
  const int n = component_terms(x);
  double row[6], factor;
  for (int j = 0; j < s->k; ++j) to[(size_t)r->m * j] = 0;
  for (int t = 0; t < n; ++t) {
    const int column = term_row(d, r, x, t, &factor, row);
    for (int j = 0; column >= 0 && j < s->k; ++j) {
      const double *y = s->Y + (size_t)s->n * j + column;
      double sum = 0;
      for (int a = 0; a < r->at[s->owner[column]].modes; ++a)
        sum += row[a] * y[a];
      to[(size_t)r->m * j] += factor * sum;
    }
  }
}

/* R_c of the motions of a set: its columns of Q. */
static void contact_motions(const stiffness *k, const domain *d,
                            const rigid_motions *r, const rigid_set *s) {
  for (int t = 0; t < s->n_node; ++t) {
    const int i = s->node[t], first = k->first_row[i];
    for (int c = 0; first >= 0 && c < k->rows; ++c) {
      const component x = node_component(d, i, k->contact[i], c);
      if (is_unknown(k, i, c))
        contact_motion(d, r, s, &x,
                       r->Q + (size_t)r->m * s->first + (first + c));
    }
  }
}

static double inner(int n, const double *a, const double *b) {
  return cblas_ddot(n, a, 1, b, 1);
}

enum { PANEL = 64 }; /* columns at a time, of sets of many bodies */

/* What the columns before a panel, n_from of them, share with its n_to: W. */
static void subtract(int rows, double *from, int n_from, const double *W,
                     int n_to) {
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, rows, n_to, n_from, -1,
              from, rows, W, n_from, 1, from + (size_t)rows * n_from, rows);
}

/* Columns first to end of a set orthogonal to those before; W[first*PANEL]. */
static void leave_span(const rigid_motions *r, const rigid_set *s, int first,
                       int end, double *W) {
  const int m = r->m, n = end - first;
  double *Q = r->Q + (size_t)m * s->first;
  if (first == 0) return;
  cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, first, n, m, 1, Q, m,
              Q + (size_t)m * first, m, 0, W, first);
  subtract(m, Q, first, W, n);
  subtract(s->n, s->Y, first, W, n);
}

/* Make the columns of a set orthonormal; the motions follow. */
static status gram_schmidt(const rigid_motions *r, const rigid_set *s) {
  const size_t m = r->m, n = s->n;
  double *Q = r->Q + m * s->first;
  OWNED double *W = NULL, *before = NULL; /* squares of the lengths */
  PASS_NEW_ALL(OF(W, (size_t)s->k * PANEL), OF(before, s->k));
  for (int j = 0; j < s->k; ++j) before[j] = inner(r->m, Q + m * j, Q + m * j);
  for (int j = 0, first = 0; j < s->k; ++j) {
    double *q = Q + m * j, *y = s->Y + n * j;
    if (j % PANEL == 0) {
      first = j;
      leave_span(r, s, first, s->k - j < PANEL ? s->k : j + PANEL, W);
    }
    for (int i = first; i < j; ++i) {
      const double part = inner(r->m, Q + m * i, q);
      cblas_daxpy(r->m, -part, Q + m * i, 1, q, 1);
      cblas_daxpy(s->n, -part, s->Y + n * i, 1, y, 1);
    }
    const double norm = sqrt(inner(r->m, q, q));
    if (!(norm > least_part * sqrt(before[j])))
      RAISE(ERR_SINGULAR,
            "body %d is not held: neither *BOUNDARY nor contact resists one "
            "of its motions",
            s->owner[0] + 1);
    cblas_dscal(r->m, 1 / norm, q, 1);
    cblas_dscal(s->n, 1 / norm, y, 1);
  }
  return OK;
}

/* The motion y[modes] about the centre and with the size of another, "to". */
static void move(const rigid_modes *from, const rigid_modes *to, double *y) {
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

/* The motions of a set about the box of the contact nodes of each body. */
static void centre_motions(const rigid_motions *r, const box *of,
                           rigid_set *s) {
  for (int j = 0; j < s->k; ++j)
    for (int i = 0; i < s->n; i += r->at[s->owner[i]].modes) {
      const int b = s->owner[i];
      const rigid_modes at = modes_about(&r->at[b], &of[b]);
      if (of[b].found) move(&r->at[b], &at, s->Y + (size_t)s->n * j + i);
    }
}

status rigid_orthonormalise(const stiffness *k, const domain *d,
                            rigid_motions *r) {
  enum { PASSES = 3 };
  OWNED box *of = NULL;
  r->m = k->n_row;
  for (int t = 0; t < r->n_set; ++t) {
    r->set[t].first = r->k;
    r->k += r->set[t].k;
  }
  PASS_NEW_ALL(OF(r->Q, (size_t)r->m * r->k), OF(of, r->n_body));
  for (EACH(rigid_set, s, r->set, r->n_set)) {
    PASS_NEW(s->load, s->n);
    measure_contact(k, d, r, s, of);
    centre_motions(r, of, s);
  }
  for (int b = 0; b < r->n_body; ++b)
    if (of[b].found) r->at[b] = modes_about(&r->at[b], &of[b]);
  for (int pass = 0; pass < PASSES; ++pass)
    for (int t = 0; t < r->n_set; ++t) {
      contact_motions(k, d, r, &r->set[t]);
      PASS(gram_schmidt(r, &r->set[t]));
    }
  return OK;
}

/* The rows of Q that a QR decomposition of Q' with column pivoting takes. */
status rigid_pin(const rigid_motions *r, const rigid_set *s,
                 unsigned char *pinned) {
  const int m = r->m, k = s->k, n_work = (m + 1) * (PANEL + 2);
  const double *Q = r->Q + (size_t)m * s->first;
  OWNED double *T = NULL, *tau = NULL, *work = NULL;
  OWNED_NEW(lapack_int, row, m);
  PASS_NEW_ALL(OF(T, (size_t)k * m), OF(tau, k), OF(work, n_work));
  for (int i = 0; i < m; ++i)
    cblas_daxpy(k, 1 - tie * i / m, Q + i, m, T + (size_t)k * i, 1);
  if (LAPACKE_dgeqp3_work(LAPACK_COL_MAJOR, k, m, T, k, row, tau, work,
                          n_work) != 0)
    RAISE(ERR_INTERNAL, "unknowns that hold the motions not found");
  for (int j = 0; j < k; ++j) pinned[row[j] - 1] = 1;
  return OK;
}

/* With V = A Q - Q (Q' A Q)/2:  A <- A - V Q' - Q V'. */
status rigid_project(const rigid_motions *r, double *A) {
  const int m = r->m, k = r->k;
  OWNED double *V = NULL, *S = NULL;
  if (m == 0 || k == 0) return OK;
  PASS_NEW_ALL(OF(V, (size_t)m * k), OF(S, (size_t)k * k));
  cblas_dsymm(CblasColMajor, CblasLeft, CblasUpper, m, k, 1, A, m, r->Q, m, 0,
              V, m);
  cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, k, k, m, 1, r->Q, m, V,
              m, 0, S, k);
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, m, k, k, -0.5, r->Q, m,
              S, k, 1, V, m);
  cblas_dsyr2k(CblasColMajor, CblasUpper, CblasNoTrans, m, k, -1, V, m, r->Q, m,
               1, A, m);
  symmetric_fill(m, A);
  return OK;
}

/* The force f at a contact unknown or another one, as resultants of pieces. */
static void add_load(const domain *d, const rigid_motions *r,
                     const component *x, double f, rigid_set *s) {
  const int n = component_terms(x);
  double row[6], factor;
  for (int t = 0; t < n; ++t) {
    const int column = term_row(d, r, x, t, &factor, row);
    for (int a = 0; column >= 0 && a < r->at[s->owner[column]].modes; ++a)
      s->load[column + a] += factor * row[a] * f;
  }
}

/* Resultants of the loads on each piece. */
static void add_loads(const stiffness *k, const domain *d,
                      const rigid_motions *r, const double *load,
                      rigid_set *s) {
  CLEAR(s->load, s->n);
  for (int t = 0; t < s->n_node; ++t) {
    const int i = s->node[t];
    const double *f = load + (size_t)k->dim * i;
    for (int c = 0; c < k->dim; ++c) {
      const component x = node_component(d, i, k->contact[i], c);
      if (f[c] != 0 && is_unknown(k, i, c)) add_load(d, r, &x, f[c], s);
    }
  }
}

void rigid_loads(const stiffness *k, const domain *d, rigid_motions *r,
                 const double *load) {
  for (int t = 0; t < r->n_set; ++t)
    if (r->set[t].k > 0) add_loads(k, d, r, load, &r->set[t]);
}

void rigid_balance(const rigid_motions *r, double *f_c) {
  for (EACH(const rigid_set, s, r->set, r->n_set)) {
    const double *Q = r->Q + (size_t)r->m * s->first;
    for (int j = 0; j < s->k; ++j, Q += r->m) {
      const double given = inner(s->n, s->Y + (size_t)s->n * j, s->load);
      cblas_daxpy(r->m, given - inner(r->m, Q, f_c), Q, 1, f_c, 1);
    }
  }
}

/* ---- motions of one piece ---- */

void modes_row(const rigid_modes *r, const double *x, const double *direction,
               double *row) {
  double p[3], *v = row;
  for (int c = 0; c < r->dim; ++c) p[c] = (x[c] - r->centre[c]) / r->size;
  if (r->modes == 1) {
    row[0] = direction[1];
  } else if (r->dim == 2) {
    *v++ = p[0] * direction[1] - p[1] * direction[0];
    COPY(v, direction, 2);
  } else {
    for (int c = 0; c < 3; ++c) {
      const int i = (c + 1) % 3, j = (c + 2) % 3;
      *v++ = p[i] * direction[j] - p[j] * direction[i];
    }
    COPY(v, direction, 3);
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
  text[0] = '\0';
  for (int c = 0; c < dim; ++c)
    text_add(text, size, "%s%.6g", c == 0 ? "(" : ", ",
             direction ? v[c] / sqrt(norm) : v[c]);
  text_add(text, size, ")");
}

/* A coordinate from one relative to centre and size. */
static double to_coordinate(const rigid_modes *at, int c, double relative) {
  const double x = at->centre[c] + at->size * relative;
  return fabs(x) < 1e-9 * at->size ? 0 : x;
}

static void write_rotation_3d(const rigid_modes *at, const double *w,
                              const double *t, char *text, size_t size) {
  char axis[64], through[64];
  double ww = 0, tw = 0, point[3];
  for (int c = 0; c < 3; ++c) {
    ww += w[c] * w[c];
    tw += t[c] * w[c];
  }
  for (int c = 0; c < 3; ++c) {
    const int i = (c + 1) % 3, j = (c + 2) % 3;
    point[c] = to_coordinate(at, c, (w[i] * t[j] - w[j] * t[i]) / ww);
  }
  write_vector(3, w, 1, axis, sizeof axis);
  write_vector(3, point, 0, through, sizeof through);
  snprintf(text, size, "%s about %s through %s",
           fabs(tw) > 1e-6 * ww ? "screw motion" : "rotation", axis, through);
}

void modes_text(const rigid_modes *at, const double *v, char *text,
                size_t size) {
  const int dim = at->dim;
  char vector[64];
  if (at->modes == 1) {
    snprintf(text, size, "translation along y");
  } else if (dim == 2 && fabs(v[0]) > 1e-6 * hypot(v[1], v[2])) {
    const double point[2] = {to_coordinate(at, 0, -v[2] / v[0]),
                             to_coordinate(at, 1, v[1] / v[0])};
    write_vector(2, point, 0, vector, sizeof vector);
    snprintf(text, size, "rotation about %s", vector);
  } else if (dim == 3 &&
             v[0] * v[0] + v[1] * v[1] + v[2] * v[2] >
                 1e-12 * (v[3] * v[3] + v[4] * v[4] + v[5] * v[5])) {
    write_rotation_3d(at, v, v + 3, text, size);
  } else {
    write_vector(dim, v + (dim == 2 ? 1 : 3), 1, vector, sizeof vector);
    snprintf(text, size, "translation along %s", vector);
  }
}
