/*
 * Condensation to the contact unknowns: the unknowns of K fall into bodies
 * (connected through K), each with its own factor; A collects their parts. A
 * contact unknown prescribed by *BOUNDARY has an uncoupled row in A, with f_c
 * such that r = 0 gives the prescribed value.
 */
#include "base/base.h"
#include "base/system/blas.h"
#include "fem/element.h"
#include "fem/operator.h"

#include <limits.h>
#include <cblas.h>
#include <lapacke.h>

/* The condition number of a plain mesh is a few times to 200 times its number
 * of unknowns. Beyond this multiple, digits are lost by contrast, slivers or
 * weak supports, and iterative refinement recovers them. */
static const double refine_excess = 1e4;

struct condensed {
  const stiffness *k; /* borrowed */
  domain d;           /* arrays borrowed */
  int n_contact, m, n_body;
  double *A;               /* [m*m], NULL: not formed */
  sparse_operator *sparse; /* in its place and that of the bodies, or NULL */
  body_factor *body;
  rigid_motions rigid;   /* those that only contact holds */
  unsigned char *pinned; /* [m] contact unknowns with a spring in the factor;
                            NULL: no body needs one */
  int just_held;         /* 1: the springs hold those motions and nothing
                            else */
  double *load;          /* [dim*n_node] in local components */
  double *prescribed;    /* [dim*n_node] local components, of the last load */
  double condition;      /* 0: not yet known */
  double stiffest;       /* largest entry of K, N/m */
  double *F;             /* [dim*n_node] load condensed last, or NULL */
  double *rest;          /* [dim*n_node] its residual, likewise */
  const char *ordering;
  cholmod_common *cm; /* owned */
};

/* The connected set of the graph that holds "first": list[0..) and its size;
 * its nodes are marked. */
static int connected_set(const graph *g, int first, unsigned char *seen,
                         int *list) {
  int n = 0;
  list[n++] = first;
  seen[first] = 1;
  for (int q = 0; q < n; ++q)
    for (size_t p = g->start[list[q]]; p < g->start[list[q] + 1]; ++p)
      if (!seen[g->next[p]]) {
        seen[g->next[p]] = 1;
        list[n++] = g->next[p];
      }
  return n;
}

/* f->node: the interior ordered, then the contact nodes in descending order,
 * which have an interior too where their tangents are not condensed.
 * list[n] ascending in, destroyed. */
static status order_body(condensed *c, const graph *g, int n, int *list,
                         body_factor *f) {
  const stiffness *k = c->k;
  int twice = k->rows < k->dim, contact = 0, last;
  for (int q = 0; q < n; ++q) contact += k->first_row[list[q]] >= 0;
  f->n_own = n;
  f->n_inner = twice ? n : n - contact;
  last = f->n_node = f->n_inner + contact;
  PASS_NEW(f->node, f->n_node);
  for (int q = 0, inner = 0; q < n; ++q) {
    const int is_contact = k->first_row[list[q]] >= 0;
    if (is_contact) f->node[--last] = list[q];
    if (!is_contact || twice) f->node[inner++] = list[q];
  }
  return order_nodes(g, k->dim, c->d.mesh->x, f->n_inner, f->node, c->cm,
                     &c->ordering);
}

/* The failure of one body, with the node where it broke down. */
static status name_body(const condensed *c, const body_factor *f, status code) {
  if (code != ERR_SINGULAR) return code;
  RAISE(ERR_SINGULAR, "body with node %zu: %s", c->d.mesh->node_no[f->bad_node],
        status_message());
}

/* Springs on contact unknowns of sets of bodies that contact alone holds: as
 * many as the motions of the set, on all if they are not exactly known. */
static status pin_sets(condensed *c) {
  const stiffness *k = c->k;
  c->just_held = 1;
  if (c->rigid.n_set == 0) return OK;
  PASS(rigid_orthonormalise(k, &c->d, &c->rigid));
  PASS_NEW(c->pinned, c->m);
  for (EACH(const rigid_set, s, c->rigid.set, c->rigid.n_set)) {
    if (s->k == s->n_motion) {
      PASS(rigid_pin(&c->rigid, s, c->pinned));
      continue;
    }
    c->just_held = 0;
    for (int j = 0; j < s->n_node; ++j)
      if (k->first_row[s->node[j]] >= 0)
        memset(c->pinned + k->first_row[s->node[j]], 1, k->rows);
  }
  return OK;
}

static status factor_bodies(condensed *c) {
  const stiffness *k = c->k;
  ENDS_BY(graph_release) graph g = {0};
  int capacity = 0;
  TIMED(STAGE_ORDERING);
  OWNED_NEW(int, list, k->n_node);
  OWNED_NEW(unsigned char, seen, k->n_node);
  OWNED_NEW(long, number, (size_t)k->dim * k->n_node);
  PASS(graph_of_unknowns(k, &g));
  for (int i = 0; i < k->n_node; ++i) {
    if (k->free[i] == 0 || seen[i]) continue;
    ADDED(body_factor, f, c->body, c->n_body, capacity);
    const int n = connected_set(&g, i, seen, list);
    f->bad_node = i;
    PASS(order_body(c, &g, n, list, f));
    body_factor_number(k, f, number);
    f->pinned = c->pinned;
    PASS(name_body(c, f, body_factor_build(k, number, c->cm, f)));
  }
  return OK;
}

/* The contact node of a row of A. */
static int contact_of(const condensed *c, int row) {
  const int q = row / c->k->rows;
  return c->d.in != NULL ? c->d.in[q] : q;
}

/* Component of a row of A among those of all nodes. */
static size_t component_of(const condensed *c, int row) {
  const int i = c->d.surface->node_id[contact_of(c, row)];
  return (size_t)c->k->dim * i + row % c->k->rows;
}

static int is_held(const condensed *c, int row) {
  return c->d.surface->held[c->k->dim * contact_of(c, row) + row % c->k->rows];
}

/* The factors of the whole matrix: one of each body, or the operator's. */
static int n_factor(const condensed *c) {
  return c->sparse != NULL ? 1 : c->n_body;
}

static body_factor *factor_at(const condensed *c, int q) {
  return c->sparse != NULL ? &c->sparse->f : &c->body[q];
}

/* Stiffness in the row of a held unknown, N/m. */
static double held_stiffness(const condensed *c, int q) {
  return c->sparse != NULL ? c->sparse->seen.diagonal[q]
                           : c->A[(size_t)q * (c->m + 1)];
}

/* The factor is that of all rows. */
static status want_all_rows(const condensed *c) {
  return c->sparse != NULL ? sparse_operator_all_rows(c->sparse) : OK;
}

/* Rows of prescribed contact unknowns: the largest diagonal entry among the
 * unknowns of the node, or of A. */
static void fill_held(condensed *c) {
  const int rows = c->k->rows;
  const size_t m = c->m;
  double most = 0;
  for (size_t i = 0; i < m; ++i) most = fmax(most, c->A[i * (m + 1)]);
  if (most == 0) most = 1;
  for (int q = 0; q < c->m; ++q) {
    const int node = q / rows;
    double own = 0;
    if (!is_held(c, q)) continue;
    for (int t = node * rows; t < (node + 1) * rows; ++t)
      if (!is_held(c, t)) own = fmax(own, c->A[t * (m + 1)]);
    c->A[q * (m + 1)] = own > 0 ? own : most;
  }
}

static status estimate_condition(condensed *c) {
  double condition = 0;
  c->condition = 1;
  for (EACH(const rigid_set, s, c->rigid.set, c->rigid.n_set))
    if (s->k < s->n_motion)
      c->condition = fmax(c->condition, 1 / (s->weakest * s->weakest));
  for (int q = 0; q < n_factor(c); ++q) {
    PASS(body_factor_condition(c->k, factor_at(c, q), c->cm, &condition));
    c->condition = fmax(c->condition, condition);
  }
  return OK;
}

static status form_matrix(condensed *c) {
  if (c->m == 0) return OK;
  TIMED(STAGE_CONDENSE);
  PASS_NEW(c->A, (size_t)c->m * c->m);
  for (int q = 0; q < c->n_body; ++q)
    PASS(body_factor_condense(c->k, &c->body[q], c->m, c->A));
  PASS(rigid_project(&c->rigid, c->A));
  fill_held(c);
  return OK;
}

/* Body of each row of A by connected sets, of[m/rows]; counts them. */
static status find_bodies(condensed *c, int *of) {
  const stiffness *k = c->k;
  ENDS_BY(graph_release) graph g = {0};
  OWNED_NEW(int, list, k->n_node);
  OWNED_NEW(unsigned char, seen, k->n_node);
  PASS(graph_of_unknowns(k, &g));
  for (int i = 0; i < k->n_node; ++i) {
    if (k->free[i] == 0 || seen[i]) continue;
    const int n = connected_set(&g, i, seen, list);
    for (int q = 0; q < n; ++q)
      if (k->first_row[list[q]] >= 0)
        of[k->first_row[list[q]] / k->rows] = c->n_body;
    ++c->n_body;
  }
  return OK;
}

/* The whole matrix in the place of those of the bodies. */
static status make_operator(condensed *c) {
  OWNED_NEW(int, body, c->m);
  OWNED_NEW(unsigned char, held, c->m);
  PASS(find_bodies(c, body));
  for (int q = 0; q < c->m; ++q) held[q] = (unsigned char)is_held(c, q);
  const operator_data data = {.k = c->k,
                              .x = c->d.mesh->x,
                              .order = c->d.order,
                              .held = held,
                              .body = body,
                              .n_body = c->n_body,
                              .pinned = c->pinned,
                              .rigid = &c->rigid,
                              .cm = c->cm};
  status st = sparse_operator_new(&data, &c->ordering, &c->sparse);
  return c->sparse == NULL ? st : name_body(c, &c->sparse->f, st);
}

static double largest_diagonal(const stiffness *k) {
  double most = 0;
  for (int i = 0; i < k->n_node; ++i)
    for (int a = 0; a < k->dim; ++a)
      if (k->free[i] >> a & 1)
        most = fmax(most,
                    k->block[k->dim * k->dim * k->start[i] + a * (k->dim + 1)]);
  return most;
}

status condense(const stiffness *k, const domain *d, condensed **out) {
  status st = OK;
  condensed *c = NULL;
  *out = NULL;
  memory_count_suitesparse();
  PASS_NEW(c, 1);
  const int rows = blas_rows(INT_MAX);
  OWNS(c);
  NEW(c->cm, 1);
  cholmod_l_start(c->cm);
  c->cm->print = 0;
  c->k = k;
  c->stiffest = largest_diagonal(k);
  c->d = *d;
  c->n_contact = d->surface != NULL ? d->surface->n : 0;
  c->m = k->n_row;
  c->ordering = "natural";
  NEW(c->load, (size_t)k->dim * k->n_node);
  NEW(c->prescribed, (size_t)k->dim * k->n_node);
  timer_enter_as(STAGE_ORDERING, STAGE_NO_CALL);
  st = rigid_find(&c->d, &c->rigid);
  if (st == OK) st = pin_sets(c);
  timer_leave(STAGE_ORDERING);
  TRY(st);
  if (d->sparse && c->m > 0) {
    TRY(make_operator(c));
  } else {
    TRY(factor_bodies(c));
    TRY(form_matrix(c));
  }
  TRY(estimate_condition(c));
done:
  blas_rows(rows);
  if (st != OK) {
    condensed_free(c);
    c = NULL;
  }
  *out = c;
  return st;
}

void condensed_free(condensed *c) {
  if (c == NULL) return;
  for (int q = 0; c->body != NULL && q < c->n_body; ++q)
    body_factor_release(&c->body[q], c->cm);
  sparse_operator_free(c->sparse);
  if (c->cm != NULL) cholmod_l_finish(c->cm);
  memory_free(c);
}

/* The local components of the prescribed displacements: prescribed[]. */
static int set_prescribed(condensed *c, const double *ud) {
  const stiffness *k = c->k;
  const int dim = k->dim;
  int any = 0;
  for (int i = 0; i < k->n_node; ++i) {
    const unsigned char *fixed = c->d.fixed + (size_t)dim * i;
    double *p = c->prescribed + (size_t)dim * i;
    for (int a = 0; a < dim; ++a) {
      p[a] = 0;
      if (ud == NULL || (k->free[i] >> a & 1)) continue;
      const double *u = ud + (size_t)dim * i;
      if (k->contact[i] < 0) {
        p[a] = fixed[a] ? u[a] : 0;
      } else {
        p[a] =
            surface_prescribed(c->d.surface, c->d.fixed, ud, k->contact[i], a);
      }
      any |= p[a] != 0;
    }
  }
  return any;
}

/* Vectors u of contact nodes by their basis, or forces by its transpose. */
static void turn_nodes(const condensed *c, int transposed, double *u) {
  const int dim = c->k->dim;
  for (int q = 0; q < c->n_contact; ++q) {
    double *v = u + (size_t)dim * c->d.surface->node_id[q], a[3];
    const double *T = c->d.surface->basis + dim * dim * q;
    COPY(a, v, dim);
    for (int r = 0; r < dim; ++r) {
      v[r] = 0;
      for (int s = 0; s < dim; ++s)
        v[r] += T[transposed ? dim * r + s : dim * s + r] * a[s];
    }
  }
}

/* Forces at the unknowns: what acts on a node acts on those it moves with, and
 * contact nodes turn by their basis. */
static void set_load(condensed *c, const double *F) {
  COPY(c->load, F, (size_t)c->k->dim * c->k->n_node);
  if (c->k->moved != NULL) coupling_load(c->k->moved, c->load);
  turn_nodes(c, 1, c->load);
}

/* load -= K prescribed over the blocks that couple them. */
static void move_prescribed(condensed *c) {
  const stiffness *k = c->k;
  const size_t dim = k->dim;
  for (size_t t = 0; t < k->n_coupling; ++t) {
    const size_t p = k->coupling[t];
    const size_t i = dim * k->row[p];
    const size_t j = dim * k->coupling_column[t];
    const double *b = k->block + dim * dim * p;
    for (size_t s = 0; s < dim; ++s)
      for (size_t r = 0; r < dim; ++r) {
        c->load[i + r] -= b[dim * s + r] * c->prescribed[j + s];
        if (i != j) c->load[j + s] -= b[dim * s + r] * c->prescribed[i + r];
      }
  }
}

/* f_c of the load in local components; the forward solve is stored. */
static status forward(condensed *c, double *f_c) {
  for (int q = 0; q < c->m; ++q)
    if (is_held(c, q))
      f_c[q] = held_stiffness(c, q) * c->prescribed[component_of(c, q)];
  if (c->sparse != NULL) sparse_operator_forward(c->sparse, c->load, f_c);
  for (int q = 0; c->sparse == NULL && q < c->n_body; ++q)
    PASS(body_factor_forward(&c->body[q], c->load, f_c, c->cm));
  return OK;
}

/* Displacements from the unknowns: contact nodes from their frame to global
 * components, relative ones with those of their masters. */
static void to_global(const condensed *c, double *u) {
  turn_nodes(c, 0, u);
  if (c->k->moved != NULL) coupling_move(c->k->moved, u);
}

/* Interior displacements from the stored forward solve. */
static status back(const condensed *c, const double *u_c, double *u) {
  COPY(u, c->prescribed, (size_t)c->k->dim * c->k->n_node);
  if (c->sparse != NULL) sparse_operator_back(c->sparse, u_c, u);
  for (int q = 0; c->sparse == NULL && q < c->n_body; ++q)
    PASS(body_factor_back(&c->body[q], u_c, u, c->cm));
  to_global(c, u);
  return OK;
}

/* c->load: what is missing to equilibrium at u, in local components. */
static void set_residual(condensed *c, const double *u) {
  domain_residual(&c->d, u, c->F, c->rest);
  set_load(c, c->rest);
}

/* Iterative refinement of the interior of u for the load last condensed. */
static status refine(condensed *c, double *u) {
  enum { PASSES = 2 };
  const size_t n = (size_t)c->k->dim * c->k->n_node;
  double *more = c->rest; /* free once the residual is in c->load */
  for (int pass = 0; pass < PASSES; ++pass) {
    set_residual(c, u);
    CLEAR(more, n);
    if (c->sparse != NULL) sparse_operator_interior(c->sparse, c->load, more);
    for (int q = 0; c->sparse == NULL && q < c->n_body; ++q)
      PASS(body_factor_interior(&c->body[q], c->load, more, c->cm));
    to_global(c, more);
    for (size_t i = 0; i < n; ++i) u[i] += more[i];
  }
  return OK;
}

/* f_c again: the reactions of the refined solution for u_c = 0, with opposite
 * sign. */
static status refine_load(condensed *c, const double *F, double *f_c) {
  const size_t n = (size_t)c->k->dim * c->k->n_node;
  OWNED double *u = NULL, *zero = NULL;
  PASS_NEW_ALL(OF(u, n), OF(zero, c->m));
  OWNS(c);
  if (c->rest == NULL) PASS_NEW(c->rest, n);
  if (c->F == NULL) PASS_NEW(c->F, n);
  COPY(c->F, F, n);
  PASS(back(c, zero, u));
  PASS(refine(c, u));
  set_residual(c, u);
  for (int q = 0; q < c->m; ++q)
    if (!is_held(c, q)) f_c[q] = c->load[component_of(c, q)];
  return OK;
}

int condensed_costs_digits(const condensed *c) {
  long n = 0;
  for (int q = 0; q < n_factor(c); ++q) n += factor_at(c, q)->n;
  return condensed_condition(c) > refine_excess * (double)n;
}

status condense_load(condensed *c, const double *F, const double *ud,
                     double *f_c) {
  TIMED(STAGE_RECOVERY);
  set_load(c, F);
  rigid_loads(c->k, &c->d, &c->rigid, c->load);
  if (set_prescribed(c, ud)) move_prescribed(c);
  PASS(forward(c, f_c));
  if (condensed_costs_digits(c)) PASS(refine_load(c, F, f_c));
  rigid_balance(&c->rigid, f_c);
  return OK;
}

status condense_recover(condensed *c, const double *u_c, double *u) {
  TIMED(STAGE_RECOVERY);
  PASS(back(c, u_c, u));
  if (c->F != NULL) PASS(refine(c, u));
  return OK;
}

/* u[m] = inv(A) f by the factors of the whole matrix; *square += u.f of those
 * that are not held. */
static status solve_rows(const condensed *c, const double *f, double *u,
                         double *square) {
  const size_t n = (size_t)c->k->dim * c->k->n_node;
  OWNED double *load = NULL, *w = NULL;
  PASS_NEW_ALL(OF(load, n), OF(w, n));
  for (int q = 0; q < c->m; ++q)
    if (!is_held(c, q)) load[component_of(c, q)] = f[q];
  PASS(want_all_rows(c));
  for (int q = 0; q < n_factor(c); ++q)
    PASS(body_factor_solve(factor_at(c, q), load, w, square, c->cm));
  for (int q = 0; q < c->m; ++q)
    u[q] = is_held(c, q) ? f[q] / held_stiffness(c, q) : w[component_of(c, q)];
  return OK;
}

status condensed_force_energy(condensed *c, const double *d, double *square) {
  *square = 0;
  if (c->sparse != NULL) {
    OWNED_NEW(double, u, c->m);
    PASS(solve_rows(c, d, u, square));
  }
  for (int q = 0; c->sparse == NULL && q < c->n_body; ++q)
    if (c->body[q].nc > 0) PASS(body_factor_energy(&c->body[q], d, square));
  for (int q = 0; q < c->m; ++q)
    if (is_held(c, q)) *square += d[q] * (d[q] / held_stiffness(c, q));
  return OK;
}

status condensed_untouched(condensed *c, const double *f, double *u) {
  double square = 0;
  return solve_rows(c, f, u, &square);
}

status condensed_misfit(condensed *c, const double *rest, const double *rc,
                        double *w, double *square) {
  *square = 0;
  CLEAR(w, (size_t)c->k->dim * c->k->n_node);
  set_load(c, rest);
  for (int q = 0; q < c->m; ++q) c->load[component_of(c, q)] += rc[q];
  PASS(want_all_rows(c));
  for (int q = 0; q < n_factor(c); ++q)
    PASS(body_factor_solve(factor_at(c, q), c->load, w, square, c->cm));
  to_global(c, w);
  return OK;
}

/* The same by the operator. */
static status solve_sparse(const condensed *c, const unsigned char *held,
                           const double *f, double *u, int *good) {
  const contact_operator *op = &c->sparse->seen;
  const known_rows rows = {.known = held};
  int singular = 0;
  OWNED_NEW(double, Au, c->m);
  PASS(op->set_rows(op->ctx, &rows, &singular));
  *good = !singular;
  CLEAR(u, c->m);
  if (*good) op->solve(op->ctx, f, u, Au);
  return OK;
}

/* u[m] = inv(A_oo) f_o at the unknowns o that are not held, else 0; *good 0:
 * A_oo is not positive definite. */
static status solve_open(const condensed *c, const unsigned char *held,
                         const double *f, double *u, int *good) {
  OWNED double *A = NULL, *x = NULL;
  int n = 0;
  if (c->sparse != NULL) return solve_sparse(c, held, f, u, good);
  OWNED_NEW(int, open, c->m);
  for (int q = 0; q < c->m; ++q) {
    u[q] = 0;
    if (!held[q]) open[n++] = q;
  }
  PASS_NEW_ALL(OF(A, (size_t)n * n), OF(x, n));
  for (int b = 0; b < n; ++b) {
    x[b] = f[open[b]];
    for (int a = 0; a < n; ++a)
      A[(size_t)b * n + a] = c->A[(size_t)open[b] * c->m + open[a]];
  }
  *good = n == 0 ||
          LAPACKE_dposv_work(LAPACK_COL_MAJOR, 'L', n, 1, A, n, x, n) == 0;
  for (int b = 0; b < n && *good; ++b) u[open[b]] = x[b];
  return OK;
}

status condensed_misfit_held(condensed *c, const double *rest, const double *rc,
                             const unsigned char *held, double *w,
                             double *square) {
  const size_t n = (size_t)c->k->dim * c->k->n_node;
  OWNED double *f_c = NULL, *u_c = NULL;
  int good = 0;
  PASS_NEW_ALL(OF(f_c, c->m), OF(u_c, c->m));
  *square = HUGE_VAL;
  set_prescribed(c, NULL);
  set_load(c, rest);
  for (int q = 0; q < c->m; ++q) c->load[component_of(c, q)] += rc[q];
  PASS(forward(c, f_c));
  PASS(solve_open(c, held, f_c, u_c, &good));
  if (!good) return OK;
  PASS(back(c, u_c, w));
  *square = 0;
  for (size_t i = 0; i < n; ++i) *square += rest[i] * w[i];
  for (int q = 0; q < c->m; ++q) *square += rc[q] * u_c[q];
  *square = fmax(0, *square);
  return OK;
}

const double *condensed_matrix(const condensed *c) { return c->A; }

const contact_operator *condensed_operator(const condensed *c) {
  return c->sparse != NULL ? &c->sparse->seen : NULL;
}

status condensed_keep(condensed *c, archive *a) {
  return c->sparse != NULL ? sparse_operator_keep(c->sparse, a) : OK;
}

void condensed_product(const condensed *c, const double *u, double *Au) {
  const contact_operator *op = condensed_operator(c);
  if (op != NULL)
    op->apply(op->ctx, u, Au, NULL);
  else if (c->m > 0)
    cblas_dgemv(CblasColMajor, CblasNoTrans, c->m, c->m, 1, c->A, c->m, u, 1, 0,
                Au, 1);
}

int condensed_floating(const condensed *c) { return c->rigid.n_set > 0; }

double condensed_stiffest(const condensed *c) { return c->stiffest; }

int condensed_motions(const condensed *c, const double **R) {
  *R = c->rigid.Q;
  return c->rigid.k;
}

int condensed_kernel(const condensed *c, const double **kernel) {
  *kernel = c->rigid.Q;
  return c->just_held ? c->rigid.k : -1;
}

void condensed_diagonal(const condensed *c, double *diagonal) {
  const size_t dim = c->k->dim;
  for (int q = 0; q < c->m; ++q) {
    const size_t at = component_of(c, q);
    const double *block = c->k->block + dim * dim * c->k->start[at / dim];
    diagonal[q] =
        is_held(c, q) ? held_stiffness(c, q) : block[at % dim * (dim + 1)];
  }
}

double condensed_condition(const condensed *c) { return c->condition; }

double condensed_digits(const condensed *c) {
  return fmax(0, -log10(0.5 * DBL_EPSILON * condensed_condition(c)));
}

condense_info condensed_info(const condensed *c) {
  condense_info info = {.bodies = c->rigid.n_body,
                        .contact_unknowns = c->m,
                        .ordering = c->ordering};
  for (int q = 0; q < n_factor(c); ++q) {
    const body_factor *f = factor_at(c, q);
    info.unknowns += f->n;
    info.factor_entries += (long)f->L->xsize;
    info.flops += f->flops;
    info.bytes +=
        f->L->xsize * sizeof(double) + f->L->ssize * sizeof(SuiteSparse_long);
  }
  if (c->A != NULL) info.bytes += (size_t)c->m * c->m * sizeof(double);
  if (c->sparse != NULL) info.bytes += c->sparse->n_own * sizeof(double);
  return info;
}
