/* The condensed stiffness as an operator (operator.h). */
#include "fem/operator.h"

#include "base/base.h"

static const double NO_PIVOT = 0x1p-42; /* -, of the diagonal: singular */

static int n_contact(const sparse_operator *o) {
  return o->k->n_row / o->k->rows;
}

static int contact_node(const sparse_operator *o, int id) {
  return (int)o->unknown[id * o->k->rows] / o->k->dim;
}

/* Place in the factor of component c of a node, -1: prescribed. */
static long place_of(const sparse_operator *o, int node, int c) {
  return o->number[(size_t)o->k->dim * node + c];
}

/* ---- the factors --------------------------------------------------------- */

typedef struct filling {
  const sparse_operator *o;
  const supernodal *s;
  const int *inside; /* o->inside: of the interior; NULL: of all unknowns */
  double scale;
} filling;

/* Place in the factor that is filled. */
static long filled_at(const filling *w, int node, int c) {
  const long at = place_of(w->o, node, c);
  return at < 0 || w->inside == NULL ? at : w->inside[at];
}

/* Entry (r, c) of the block of nodes i and j, a row of which is in contact. */
static double contact_entry(const filling *w, int i, int r, int j, int c,
                            double entry) {
  const sparse_operator *o = w->o;
  const row_state *rows = &o->rows;
  const int a = contact_row(o->k, i, r), b = contact_row(o->k, j, c);
  if (a != b && ((a >= 0 && rows->known[a]) || (b >= 0 && rows->known[b])))
    return 0.0;
  entry *= w->scale;
  if (i != j || a < 0 || b < 0) return entry;
  if (a == b && rows->springs)
    entry += body_factor_spring(o->k, &o->f, (long)o->k->dim * i + r);
  return entry + w->scale * rows->added[o->k->rows * a + b % o->k->rows];
}

/* What block p of nodes i >= j has in the columns first to last - 1. */
static void put_block(const filling *w, size_t p, int j, const long *columns,
                      const int *position, size_t lead, double *x) {
  const stiffness *k = w->o->k;
  const int dim = k->dim, i = k->row[p];
  const int touches = k->first_row[i] >= 0 || k->first_row[j] >= 0;
  const double *block = k->block + dim * dim * p;
  for (int c = 0; c < dim; ++c)
    for (int r = i == j ? c : 0; r < dim; ++r) {
      const long at = filled_at(w, i, r), bt = filled_at(w, j, c);
      const long column = at < bt ? at : bt, row = at < bt ? bt : at;
      const double entry = block[dim * c + r];
      if (column < columns[0] || column >= columns[1]) continue;
      x[lead * (column - columns[0]) + position[row]] =
          touches ? contact_entry(w, i, r, j, c, entry) : w->scale * entry;
    }
}

static void put_columns(void *ctx, int supernode, const int *position,
                        double *x) {
  const filling *w = ctx;
  const supernodal *s = w->s;
  const block_lists *list = &w->o->columns;
  const size_t lead = s->start[supernode + 1] - s->start[supernode];
  for (size_t t = list->start[supernode]; t < list->start[supernode + 1]; ++t)
    put_block(w, list->item[t].block, list->item[t].node, s->first + supernode,
              position, lead, x);
}

/* The first place without a pivot, -1: none, of the marked supernodes. */
static long factor(sparse_operator *o, supernodal *s, const int *inside,
                   double **x) {
  filling w = {o, s, inside, ldexp(1.0, -o->f.exponent)};
  TIMED(STAGE_FACTOR);
  return supernodal_factor(s, o->part.mark, put_columns, &w, x);
}

static status broke(sparse_operator *o, long at) {
  return body_factor_broke(&o->f, (int)(o->f.unknown[at] / o->k->dim));
}

/* Mark the supernodes with entries of a contact node. */
static void mark_node(sparse_operator *o, int id, unsigned char *mark) {
  const int a = contact_node(o, id), dim = o->k->dim;
  for (size_t t = o->touched.start[id]; t < o->touched.start[id + 1]; ++t)
    for (int r = 0; r < dim; ++r)
      for (int c = 0; c < dim; ++c) {
        const long at = place_of(o, a, r);
        const long bt = place_of(o, o->touched.item[t].node, c);
        if (at >= 0 && bt >= 0) mark[o->s->of[at < bt ? at : bt]] = 1;
      }
}

/* 1: what the factor follows at a contact node is other than that. */
static int differs(const sparse_operator *o, int id, const known_rows *rows,
                   int springs) {
  const size_t dim = o->k->rows, first = dim * id;
  for (size_t q = first; q < first + dim; ++q) {
    const int known = rows->known != NULL && rows->known[q];
    if (o->rows.known[q] != known) return 1;
    if (springs != o->rows.springs && o->pinned != NULL && o->pinned[q])
      return 1;
  }
  for (size_t i = dim * first; i < dim * (first + dim); ++i)
    if (o->rows.added[i] != (rows->added != NULL ? rows->added[i] : 0.0))
      return 1;
  return 0;
}

/* Mark what is to be made again for the rows; returns 0 if nothing is. */
static int mark_changes(sparse_operator *o, const known_rows *rows,
                        int springs) {
  unsigned char *mark = o->part.mark;
  int any = o->state != FACTORED;
  const size_t count = o->s->count;
  if (o->state == BROKEN)
    memcpy(mark, o->part.touches, count);
  else
    memset(mark, o->state == NO_FACTOR, count);
  for (int i = 0; o->state == FACTORED && i < n_contact(o); ++i) {
    if (!differs(o, i, rows, springs)) continue;
    mark_node(o, i, mark);
    any = 1;
  }
  if (any) supernodal_close(o->s, mark);
  return any;
}

/* The factor of the rows, springs or not, in o->x. ERR_SINGULAR. */
static status refactor(sparse_operator *o, const known_rows *rows,
                       int springs) {
  if (!mark_changes(o, rows, springs)) return OK;
  const size_t m = o->k->n_row, size = o->k->rows * m;
  for (size_t q = 0; q < m; ++q)
    o->rows.known[q] = rows->known != NULL && rows->known[q];
  for (size_t i = 0; i < size; ++i)
    o->rows.added[i] = rows->added != NULL ? rows->added[i] : 0.0;
  o->rows.springs = springs;
  if (o->state == FACTORED) o->state = BROKEN;
  const long bad = factor(o, o->s, NULL, o->x);
  if (bad >= 0) return broke(o, bad);
  o->state = FACTORED;
  return OK;
}

status sparse_operator_all_rows(sparse_operator *o) {
  return refactor(o, &(known_rows){0}, 1);
}

status sparse_operator_keep(sparse_operator *o, archive *a) {
  const size_t m = o->k->n_row, size = o->k->rows * m;
  const int reads = archive_reads(a);
  int springs = o->rows.springs, whole = o->state == FACTORED;
  OWNED_NEW(unsigned char, known, m);
  OWNED_NEW(double, added, size);
  PASS(archive_ints(a, "springs", &springs, 1));
  PASS(archive_ints(a, "whole", &whole, 1));
  PASS(archive_bytes(a, "known", reads ? known : o->rows.known, m));
  PASS(archive_reals(a, "added", reads ? added : o->rows.added, size));
  const known_rows rows = {.known = known, .added = added};
  if (!reads) return OK;
  if (whole) return refactor(o, &rows, springs);
  COPY(o->rows.known, known, m);
  COPY(o->rows.added, added, size);
  o->rows.springs = springs;
  o->state = BROKEN;
  return OK;
}

/* ---- products and solves ------------------------------------------------- */

static void clear(const sparse_operator *o) {
  const supernodal_part *part = &o->part.contact;
  for (int t = 0; t < part->n; ++t) {
    const long first = o->s->first[part->list[t]];
    const long n = o->s->first[part->list[t] + 1] - first;
    CLEAR(o->work.v + first, n);
  }
}

/* Forces v at the places of the part become displacements of the factor x;
 * there are forces in the supernodes of the contact only. */
static void solve_rows(const sparse_operator *o, const supernodal_part *part,
                       double *v) {
  const supernodal_part *forces = &o->part.contact;
  const double scale = ldexp(1.0, -o->f.exponent);
  for (int t = 0; t < forces->n; ++t)
    for (long p = o->s->first[forces->list[t]];
         p < o->s->first[forces->list[t] + 1]; ++p)
      v[p] *= scale;
  supernodal_forward(o->s, o->x, forces, v);
  supernodal_back(o->s, o->x, part, v);
}

/* The same of the interior, into its part; forces: of contact, or all. */
static void solve_interior(const sparse_operator *o,
                           const supernodal_part *forces,
                           const supernodal_part *part, double *v) {
  const double scale = ldexp(1.0, -o->f.exponent);
  const SuiteSparse_long *first = o->s->first;
  for (int t = 0; t < part->n; ++t)
    for (long p = first[part->list[t]]; p < first[part->list[t] + 1]; ++p)
      if (o->inside[p] >= 0) o->work.z[o->inside[p]] = scale * v[p];
  supernodal_forward(o->interior, o->inner, forces, o->work.z);
  supernodal_back(o->interior, o->inner, part, o->work.z);
  for (int t = 0; t < part->n; ++t)
    for (long p = first[part->list[t]]; p < first[part->list[t] + 1]; ++p)
      if (o->inside[p] >= 0) v[p] = o->work.z[o->inside[p]];
}

/* o->work.v less K u of contact unknowns u[m], that of held ones left out. */
static void spread(const sparse_operator *o, const double *u) {
  const stiffness *k = o->k;
  const size_t dim = k->dim;
  for (int q = 0; q < k->n_row; ++q) {
    const int id = q / k->rows, r = q % k->rows;
    const double move = -u[q];
    if (o->held[q] || move == 0.0) continue;
    const int a = contact_node(o, id);
    for (size_t t = o->touched.start[id]; t < o->touched.start[id + 1]; ++t) {
      const block_at *b = &o->touched.item[t];
      const double *block = k->block + dim * dim * b->block;
      const int of_row = k->row[b->block] == a;
      for (int c = 0; c < k->dim; ++c) {
        const long at = place_of(o, b->node, c);
        if (at < 0) continue;
        o->work.v[at] += move * block[of_row ? k->dim * c + r : k->dim * r + c];
      }
    }
  }
}

/* Forces f[rows] of v at a contact node, sums of magnitudes or NULL. */
static void gather_node(const sparse_operator *o, int id, const double *v,
                        double *f, double *size) {
  const stiffness *k = o->k;
  const size_t dim = k->dim;
  const int a = contact_node(o, id);
  for (int r = 0; r < k->rows; ++r) {
    f[r] = 0.0;
    if (size != NULL) size[r] = 0.0;
  }
  for (size_t t = o->touched.start[id]; t < o->touched.start[id + 1]; ++t) {
    const block_at *b = &o->touched.item[t];
    const double *block = k->block + dim * dim * b->block;
    const int of_row = k->row[b->block] == a;
    for (int c = 0; c < k->dim; ++c) {
      const long at = place_of(o, b->node, c);
      if (at < 0) continue;
      for (int r = 0; r < k->rows; ++r) {
        const double part =
            v[at] * block[of_row ? k->dim * c + r : k->dim * r + c];
        f[r] += part;
        if (size != NULL) size[r] += fabs(part);
      }
    }
  }
}

/* v -= Q Q'v: no force by a rigid motion, no motion of forces. */
static void project(const sparse_operator *o, double *v) {
  const size_t m = o->k->n_row;
  for (int c = 0; c < o->rigid->k; ++c) {
    const double *q = o->rigid->Q + m * c;
    add_scaled((int)m, -dot((int)m, q, v), q, v);
  }
}

/* Au[m] from o->work.v; held unknowns have u and their own stiffness. */
static void gather(const sparse_operator *o, const double *u, double *Au,
                   double *size) {
  const int rows = o->k->rows;
  for (int i = 0; i < n_contact(o); ++i)
    gather_node(o, i, o->work.v, Au + rows * i,
                size != NULL ? size + rows * i : NULL);
  for (int q = 0; q < o->k->n_row; ++q)
    if (o->held[q]) Au[q] = o->diagonal[q] * u[q];
  project(o, Au);
}

static void apply(void *ctx, const double *u, double *Au, double *size) {
  sparse_operator *o = ctx;
  COPY(Au, u, o->k->n_row);
  project(o, Au);
  /* The contact unknowns have u[m]: o->work.v at them and next to them. */
  clear(o);
  spread(o, Au);
  solve_interior(o, &o->part.contact, &o->part.contact, o->work.v);
  for (int q = 0; q < o->k->n_row; ++q)
    if (!o->held[q]) o->work.v[o->number[o->unknown[q]]] = Au[q];
  gather(o, u, Au, size);
  for (int q = 0; size != NULL && q < o->k->n_row; ++q)
    if (o->held[q]) size[q] = fabs(Au[q]);
}

static status set_rows(void *ctx, const known_rows *rows, int *singular) {
  sparse_operator *o = ctx;
  *singular = 0;
  if (rows->known == NULL) return sparse_operator_all_rows(o);
  const status st = refactor(o, rows, 0);
  if (st == ERR_SINGULAR) {
    status_clear();
    *singular = 1;
    return OK;
  }
  PASS(st);
  *singular =
      o->rigid->n_set > 0 && !(body_factor_least_pivot(o->k, &o->f) > NO_PIVOT);
  return OK;
}

static void solve(void *ctx, const double *b, double *x, double *Ax) {
  sparse_operator *o = ctx;
  const int m = o->k->n_row;
  for (int q = 0; q < m; ++q)
    Ax[q] = o->rows.known[q] && !o->held[q] ? x[q] : 0.0;
  clear(o);
  spread(o, Ax);
  for (int q = 0; q < m; ++q) {
    if (o->held[q]) continue;
    double *v = o->work.v + o->number[o->unknown[q]];
    *v = o->rows.known[q] ? 0.0 : *v + b[q];
  }
  solve_rows(o, &o->part.contact, o->work.v);
  for (int q = 0; q < m; ++q) {
    if (o->held[q]) continue;
    double *v = o->work.v + o->number[o->unknown[q]];
    if (o->rows.known[q])
      *v = x[q];
    else
      x[q] = *v;
  }
  gather(o, x, Ax, NULL);
}

static void set_response(void *ctx, const unsigned char *at) {
  sparse_operator *o = ctx;
  const int rows = o->k->rows;
  o->part.n = 0;
  memset(o->part.mark, 0, o->s->count);
  for (int i = 0; i < n_contact(o); ++i) {
    const int a = contact_node(o, i);
    if (memchr(at + rows * i, 1, rows) == NULL) continue;
    o->part.node[o->part.n++] = i;
    for (size_t t = o->touched.start[i]; t < o->touched.start[i + 1]; ++t)
      for (int c = 0; c < o->k->dim; ++c) {
        const long next = place_of(o, o->touched.item[t].node, c);
        const long own = place_of(o, a, c);
        if (next >= 0) o->part.mark[o->s->of[next]] = 1;
        if (own >= 0) o->part.mark[o->s->of[own]] = 1;
      }
  }
  supernodal_close(o->s, o->part.mark);
  supernodal_list(o->s, o->part.mark, &o->part.response);
}

static void response(void *ctx, const double *b, double *x, double *Ax) {
  sparse_operator *o = ctx;
  const int m = o->k->n_row, rows = o->k->rows;
  clear(o);
  for (int q = 0; q < m; ++q)
    if (b[q] != 0.0 && !o->held[q] && !o->rows.known[q])
      o->work.v[o->number[o->unknown[q]]] = b[q];
  solve_rows(o, &o->part.response, o->work.v);
  for (int t = 0; t < o->part.n; ++t) {
    const int first = rows * o->part.node[t];
    gather_node(o, o->part.node[t], o->work.v, Ax + first, NULL);
    for (int q = first; q < first + rows; ++q)
      if (!o->held[q]) x[q] = o->work.v[o->number[o->unknown[q]]];
  }
}

/* ---- loads and recovery -------------------------------------------------- */

/* Forces v by place of load[dim*n_node] in the interior. */
static void take_load(const sparse_operator *o, const double *load, double *v) {
  for (long p = 0; p < o->f.n; ++p) v[p] = load[o->f.unknown[p]];
  for (int q = 0; q < o->k->n_row; ++q)
    if (!o->held[q]) v[o->number[o->unknown[q]]] = 0.0;
}

void sparse_operator_forward(sparse_operator *o, const double *load,
                             double *f_c) {
  const int rows = o->k->rows;
  take_load(o, load, o->work.y);
  solve_interior(o, &o->part.all, &o->part.all, o->work.y);
  for (int i = 0; i < n_contact(o); ++i) {
    double f[3];
    gather_node(o, i, o->work.y, f, NULL);
    for (int q = rows * i; q < rows * (i + 1); ++q)
      if (!o->held[q]) f_c[q] = load[o->unknown[q]] - f[q - rows * i];
  }
}

void sparse_operator_back(sparse_operator *o, const double *u_c, double *u) {
  CLEAR(o->work.v, o->f.n);
  spread(o, u_c);
  solve_interior(o, &o->part.contact, &o->part.all, o->work.v);
  for (long p = 0; p < o->f.n; ++p)
    u[o->f.unknown[p]] = o->work.y[p] + o->work.v[p];
  for (int q = 0; q < o->k->n_row; ++q)
    if (!o->held[q]) u[o->unknown[q]] = u_c[q];
}

void sparse_operator_interior(sparse_operator *o, const double *load,
                              double *u) {
  take_load(o, load, o->work.v);
  solve_interior(o, &o->part.all, &o->part.all, o->work.v);
  for (long p = 0; p < o->f.n; ++p) u[o->f.unknown[p]] += o->work.v[p];
}

/* ---- building ------------------------------------------------------------ */

/* Entries without the rows and columns of the contact unknowns: their share of
 * the rows is taken as that of the columns. */
static double interior_entries(const stiffness *k, const order_cost *c) {
  const double left = 1.0 - (double)k->rows / k->dim * c->marked_entries /
                                fmax(1.0, c->reached_entries);
  return left * left * c->reached_entries;
}

status stiffness_order(const stiffness *k, const double *x, whole_order *o) {
  status st = OK;
  graph g = {0};
  cholmod_common cm;
  order_cost cost;
  unsigned char *mark = NULL;
  const double dim = k->dim;
  *o = (whole_order){0};
  memory_count_suitesparse();
  cholmod_l_start(&cm);
  cm.print = 0;
  TIMED(STAGE_ORDERING);
  TRY(graph_of_unknowns(k, &g));
  NEW(o->node, k->n_node);
  for (int i = 0; i < k->n_node; ++i)
    if (k->free[i] != 0) o->node[o->n++] = i;
  TRY(order_nodes(&g, k->dim, x, o->n, o->node, &cm, &o->name));
  NEW(mark, k->n_node);
  for (int i = 0; i < k->n_node; ++i) mark[i] = k->first_row[i] >= 0;
  TRY(order_cost_of(&g, o->n, o->node, mark, &cm, &cost));
  o->flops = cost.flops * dim * dim * dim;
  o->entries = cost.entries * dim * dim;
  o->contact_flops = cost.reached_flops * dim * dim * dim;
  o->contact_entries = cost.reached_entries * dim * dim;
  o->interior_entries = interior_entries(k, &cost) * dim * dim;
done:
  graph_release(&g);
  memory_free(mark);
  cholmod_l_finish(&cm);
  return st;
}

/* All nodes with unknowns, in the order given or a new one. */
static status order_whole(sparse_operator *o, const double *x,
                          const whole_order *given, const char **ordering) {
  whole_order own = {0};
  body_factor *f = &o->f;
  if (given == NULL) {
    status st = stiffness_order(o->k, x, &own);
    f->node = own.node;
    PASS(st);
    f->n_node = own.n;
    *ordering = own.name;
  } else {
    PASS_NEW(f->node, given->n);
    COPY(f->node, given->node, given->n);
    f->n_node = given->n;
    *ordering = given->name;
  }
  f->n_own = f->n_inner = f->n_node;
  f->whole = 1;
  return OK;
}

/* Held unknowns get the largest diagonal entry of their node, or of all. */
static void fill_diagonal(sparse_operator *o) {
  const stiffness *k = o->k;
  const size_t dim = k->dim;
  double most = 0.0;
  for (int q = 0; q < k->n_row; ++q) {
    const size_t at = o->unknown[q];
    const double *block = k->block + dim * dim * k->start[at / dim];
    o->diagonal[q] = o->held[q] ? 0.0 : block[at % dim * (dim + 1)];
    most = fmax(most, o->diagonal[q]);
  }
  for (int q = 0; q < k->n_row; ++q) {
    double own = 0.0;
    if (!o->held[q]) continue;
    for (int t = q / k->rows * k->rows; t < (q / k->rows + 1) * k->rows; ++t)
      if (!o->held[t]) own = fmax(own, o->diagonal[t]);
    o->diagonal[q] = own > 0.0 ? own : most > 0.0 ? most : 1.0;
  }
}

/* Calls `take` for each block that has unknowns at both nodes. */
typedef void block_taker(sparse_operator *o, size_t p, int j);
static void each_block(sparse_operator *o, block_taker *take) {
  const stiffness *k = o->k;
  for (int j = 0; j < k->n_node; ++j)
    for (size_t p = k->start[j]; k->free[j] && p < k->start[j + 1]; ++p)
      if (k->free[k->row[p]]) take(o, p, j);
}

/* Each item counted in start, or stored at start[of]++. */
static void list_item(block_lists *list, int of, size_t p, int node) {
  const size_t at = list->start[of]++;
  if (list->item != NULL) list->item[at] = (block_at){p, node};
}

/* By the supernodes of the columns of its entries. */
static void list_by_column(sparse_operator *o, size_t p, int j) {
  const int dim = o->k->dim, i = o->k->row[p];
  int seen[9], n = 0;
  for (int e = 0; e < dim * dim; ++e) {
    const long at = place_of(o, i, e % dim), bt = place_of(o, j, e / dim);
    if (at < 0 || bt < 0) continue;
    const int of = o->s->of[at < bt ? at : bt];
    int met = 0;
    for (int t = 0; t < n; ++t) met |= seen[t] == of;
    if (met) continue;
    seen[n++] = of;
    list_item(&o->columns, of, p, j);
  }
}

/* By its contact nodes. */
static void list_by_contact(sparse_operator *o, size_t p, int j) {
  const stiffness *k = o->k;
  const int i = k->row[p];
  if (k->first_row[i] >= 0)
    list_item(&o->touched, k->first_row[i] / k->rows, p, j);
  if (i != j && k->first_row[j] >= 0)
    list_item(&o->touched, k->first_row[j] / k->rows, p, i);
}

static status list_blocks(sparse_operator *o, int n, block_taker *take,
                          block_lists *list) {
  size_t sum = 0;
  PASS_NEW(list->start, n + 1);
  each_block(o, take);
  for (int q = 0; q <= n; ++q) {
    const size_t own = list->start[q];
    list->start[q] = sum;
    sum += own;
  }
  PASS_NEW(list->item, sum);
  each_block(o, take);
  memmove(list->start + 1, list->start, n * sizeof *list->start);
  list->start[0] = 0;
  return OK;
}

/* The supernodes in which contact unknowns have part. */
static status divide(sparse_operator *o) {
  const int count = o->s->count;
  PASS_NEW_ALL(OF(o->part.mark, count), OF(o->part.touches, count),
               OF(o->part.all.list, count), OF(o->part.contact.list, count),
               OF(o->part.response.list, count));
  memset(o->part.mark, 1, count);
  supernodal_list(o->s, o->part.mark, &o->part.all);
  for (int i = 0; i < n_contact(o); ++i) mark_node(o, i, o->part.touches);
  supernodal_close(o->s, o->part.touches);
  supernodal_list(o->s, o->part.touches, &o->part.contact);
  return OK;
}

/* The columns of both factors. */
static status new_columns(sparse_operator *o) {
  const int count = o->s->count;
  const SuiteSparse_long *px = o->f.L->px;
  if (!cholmod_l_change_factor(CHOLMOD_REAL, 1, 1, 1, 1, o->f.L, o->cm))
    RAISE(ERR_MEMORY, "memory exhausted: factor of %ld unknowns", o->f.n);
  PASS_NEW_ALL(OF(o->x, count), OF(o->inner, count));
  for (int q = 0; q < count; ++q)
    if (o->part.touches[q]) o->n_own += supernodal_entries(o->interior, q);
  PASS_NEW(o->own, o->n_own);
  double *at = o->own;
  for (int q = 0; q < count; ++q) {
    o->x[q] = o->inner[q] = (double *)o->f.L->x + px[q];
    if (!o->part.touches[q]) continue;
    o->inner[q] = at;
    at += supernodal_entries(o->interior, q);
  }
  return OK;
}

static status factor_both(sparse_operator *o) {
  o->f.pinned = o->pinned;
  body_factor_number(o->k, &o->f, o->number);
  PASS(body_factor_analyse(o->k, o->number, o->cm, &o->f));
  memory_return_before(o->f.L->xsize * sizeof(double));
  /* Unknowns numbered by their place in the factor: its matrix then needs no
   * permutation each time. */
  SuiteSparse_long *perm = o->f.L->Perm;
  for (long p = 0; p < o->f.n; ++p) {
    o->number[o->f.unknown[p]] = p;
    perm[p] = p;
  }
  o->f.L->ordering = CHOLMOD_NATURAL;
  PASS(supernodal_new(o->f.L, &o->s));
  PASS(list_blocks(o, o->s->count, list_by_column, &o->columns));
  PASS(list_blocks(o, n_contact(o), list_by_contact, &o->touched));
  PASS(divide(o));
  PASS_NEW_ALL(OF(o->work.v, o->f.n), OF(o->work.y, o->f.n));
  int n = 0;
  PASS_NEW(o->inside, o->f.n);
  for (int q = 0; q < o->k->n_row; ++q)
    if (!o->held[q]) o->inside[o->number[o->unknown[q]]] = -1;
  for (long p = 0; p < o->f.n; ++p)
    if (o->inside[p] == 0) o->inside[p] = n++;
  PASS_NEW(o->work.z, n);
  PASS(supernodal_restrict(o->s, o->inside, &o->interior));
  PASS(new_columns(o));
  PASS(sparse_operator_all_rows(o));
  /* The factor of the interior, where contact unknowns have part in it; the
   * rest is that of the factor of all rows. */
  memcpy(o->part.mark, o->part.touches, o->s->count);
  const long bad = factor(o, o->interior, o->inside, o->inner);
  for (long p = 0; bad >= 0 && p < o->f.n; ++p)
    if (o->inside[p] == bad) return broke(o, p);
  return OK;
}

status sparse_operator_new(const operator_data *d, const char **ordering,
                           sparse_operator **out) {
  const stiffness *k = d->k;
  MAKES(sparse_operator, o, out);
  o->k = k;
  o->rigid = d->rigid;
  o->cm = d->cm;
  o->pinned = d->pinned;
  /* Arrays by contact row, before there is a factor. */
  const size_t m = o->k->n_row, size = o->k->rows * m;
  PASS_NEW_ALL(OF(o->number, (size_t)o->k->dim * o->k->n_node),
               OF(o->unknown, m), OF(o->held, m), OF(o->rows.known, m),
               OF(o->rows.added, size), OF(o->diagonal, m),
               OF(o->workspace, 2 * m), OF(o->body, m / o->k->rows),
               OF(o->part.node, m / o->k->rows));
  memcpy(o->held, d->held, k->n_row);
  COPY(o->body, d->body, k->n_row / k->rows);
  for (int i = 0; i < o->k->n_node; ++i)
    for (int c = 0; c < o->k->dim; ++c)
      if (contact_row(o->k, i, c) >= 0)
        o->unknown[contact_row(o->k, i, c)] = o->k->dim * i + c;
  fill_diagonal(o);
  PASS(order_whole(o, d->x, d->order, ordering));
  PASS(factor_both(o));
  o->seen = (contact_operator){.ctx = o,
                               .diagonal = o->diagonal,
                               .body = o->body,
                               .n_body = d->n_body,
                               .kernel = d->rigid->Q,
                               .n_kernel = d->rigid->k,
                               .workspace = o->workspace,
                               .unknowns = (double)o->f.n,
                               .entries = (double)o->f.L->xsize,
                               .apply = apply,
                               .set_rows = set_rows,
                               .solve = solve,
                               .set_response = set_response,
                               .response = response};
  return OK;
}

void sparse_operator_free(sparse_operator *o) {
  if (o == NULL) return;
  body_factor_release(&o->f, o->cm);
  memory_free(o);
}
