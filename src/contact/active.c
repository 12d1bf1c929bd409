/* Active contact nodes (active.h). */
#include "contact/active.h"

#include "base/base.h"

enum { MOST_PASSES = 2 };
static const double LONGER = 4.0; /* -, after a distance that was too short */

void active_free(active_nodes *x) {
  FORGET(x->in);
  x->n_in = 0;
}

int active_count(const active_nodes *x, int n) {
  return x->in != NULL ? x->n_in : n;
}

int active_is_same(const active_nodes *a, const active_nodes *b) {
  if (a->in == NULL || b->in == NULL) return a->in == b->in;
  return a->n_in == b->n_in &&
         memcmp(a->in, b->in, a->n_in * sizeof *a->in) == 0;
}

/* keep[n]: 1 of the nodes to be taken. */
static status take(active_nodes *x, int n, const unsigned char *keep) {
  int count = 0;
  for (int i = 0; i < n; ++i) count += keep[i];
  active_free(x);
  if (2 * count > n) return OK;
  PASS_NEW(x->in, n);
  for (int i = 0; i < n; ++i)
    if (keep[i]) x->in[x->n_in++] = i;
  return OK;
}

status active_choose(active_nodes *x, int n, const double *gap) {
  int nearest = 0;
  OWNED_NEW(unsigned char, keep, n);
  for (int i = 0; i < n; ++i) {
    keep[i] = gap[i] <= x->distance;
    if (gap[i] < gap[nearest]) nearest = i;
  }
  if (n > 0) keep[nearest] = 1;
  return take(x, n, keep);
}

int active_too_few(const active_nodes *x, int n, const double *gap,
                   const double *u_n, int stride) {
  for (int i = 0, next = 0; x->in != NULL && i < n; ++i)
    if (next < x->n_in && x->in[next] == i)
      ++next;
    else if (!(u_n[stride * i] <= gap[i]))
      return 1;
  return 0;
}

status active_extend(active_nodes *x, int n, const double *gap,
                     const double *u_n, int stride, int all) {
  OWNED_NEW(unsigned char, keep, n);
  all = all || x->passes >= MOST_PASSES;
  x->distance *= LONGER;
  ++x->passes;
  for (int i = 0; i < n; ++i)
    keep[i] = all || gap[i] <= x->distance || !(u_n[stride * i] <= gap[i]);
  for (int k = 0; k < x->n_in; ++k) keep[x->in[k]] = 1;
  return take(x, n, keep);
}

/* ---- the problem of the active nodes ------------------------------ */

void active_part_free(active_part *p) {
  RELEASE(p->gap, p->ut0, p->g0, p->held);
  sparse_free(&p->B);
  *p = (active_part){0};
}

status active_part_new(int n, int dim, active_part *out) {
  *out = (active_part){0};
  PASS_NEW(out->gap, n);
  if (dim == 1) return OK;
  PASS_NEW_ALL(OF(out->ut0, n * (dim - 1)), OF(out->g0, n),
               OF(out->held, n * dim), OF(out->B.start, n + 1),
               OF(out->B.col, n), OF(out->B.val, n));
  return OK;
}

/* Of the diagonal "from", a row a node at most one entry. */
static void cut_limit(const active_nodes *x, const sparse_rows *from,
                      const sparse_rows *to) {
  int n = 0;
  for (int k = 0; k < x->n_in; ++k) {
    const int i = x->in[k];
    to->start[k] = n;
    for (int e = from->start[i]; e < from->start[i + 1]; ++e) {
      to->col[n] = k;
      to->val[n++] = from->val[e];
    }
  }
  to->start[x->n_in] = n;
}

/* Size values a node; NULL stays NULL. */
static const double *cut_reals(const active_nodes *x, int size,
                               const double *from, double *to) {
  for (int k = 0; from != NULL && k < x->n_in; ++k)
    COPY(to + size * k, from + size * x->in[k], size);
  return from != NULL ? to : NULL;
}

void active_cut(const active_nodes *x, active_part *part, contact_problem *cp) {
  const int dim = cp->dim;
  const unsigned char *held = cp->held;
  cp->gap = cut_reals(x, 1, cp->gap, part->gap);
  cp->ut0 = cut_reals(x, dim - 1, cp->ut0, part->ut0);
  cp->g0 = cut_reals(x, 1, cp->g0, part->g0);
  for (int k = 0; held != NULL && k < x->n_in; ++k)
    memcpy(part->held + dim * k, held + dim * x->in[k], dim);
  if (held != NULL) cp->held = part->held;
  if (cp->B == NULL) return;
  part->B.n = x->n_in;
  cut_limit(x, cp->B, &part->B);
  cp->B = &part->B;
}

void active_spread(const active_nodes *x, int n, double *a) {
  int k = x->n_in - 1;
  for (int i = n - 1; x->in != NULL && i >= 0; --i)
    a[i] = k >= 0 && x->in[k] == i ? a[k--] : 0.0;
}
