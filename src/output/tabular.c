/*
 * JOB.dat: the tables required by *PRINT.
 *
 *   # step 1 increment 3 time 3.0000000000000000E-001 table CONTACT
 *   # node_no[-] x[mm] ...
 *     17 1.2500000000000000E+000 ...
 *
 * Blocks are separated by two empty lines (gnuplot: index). Rows are in the
 * order of the user's numbers. Seventeen digits read back exactly.
 */
#include "base/base.h"
#include "effects/rows.h"
#include "output/writers.h"

enum { DIGITS = 16 };

struct tabular {
  const model *m;
  const mesh *msh;
  text_file dat;
  int n_block;           /* written so far */
  int *node_order;       /* [n_node] ids by node_no */
  int *elem_order;       /* [n_elem] ids by elem_no */
  unsigned char *wanted; /* [items] rows of the current table */
};

static const mesh_group *request_group(const mesh *msh,
                                       const print_request *p) {
  if (p->group == NULL) return NULL;
  return &msh->group[p->group_id];
}

static void want_nodes(tabular *t, const mesh_group *g) {
  for (int i = 0; i < g->n_node; ++i) t->wanted[g->node_id[i]] = 1;
}

/* Nodes of a table: of the group, of the supports, or all. */
static void choose_nodes(tabular *t, const print_request *p, const step *now) {
  const mesh_group *g = request_group(t->msh, p);
  memset(t->wanted, g == NULL && p->table == PRINT_NODES, t->msh->n_node);
  if (p->table == PRINT_REACTIONS && g == NULL)
    for (int i = 0; i < now->loads.n; ++i)
      if (now->loads.item[i].kind == LOAD_FIXING)
        want_nodes(t, &t->msh->group[now->loads.item[i].group_id]);
  if (g != NULL) want_nodes(t, g);
}

static void choose_elements(tabular *t, const print_request *p) {
  const mesh_group *g = request_group(t->msh, p);
  memset(t->wanted, g == NULL, t->msh->n_elem);
  if (g != NULL && g->dim == t->msh->dim)
    for (int i = 0; i < g->n_item; ++i) t->wanted[g->item_id[i]] = 1;
}

static void ordered_rows(const table *columns, const tabular *t, const view *v,
                         int n, const int *order) {
  for (int i = 0; i < n; ++i)
    if (t->wanted[order[i]]) table_row(columns, v, order[i], t->dat.f);
}

/* A number and the id it belongs to, for qsort. */
typedef struct numbered {
  size_t no;
  int id;
} numbered;

static int by_number(const void *a_, const void *b_) {
  const numbered *a = a_, *b = b_;
  return (a->no > b->no) - (a->no < b->no);
}

static status order_by_number(int n, const size_t *no, int **order) {
  PASS_NEW(*order, n);
  OWNED_NEW(numbered, list, n);
  for (int i = 0; i < n; ++i) list[i] = (numbered){no[i], i};
  qsort(list, n, sizeof *list, by_number);
  for (int i = 0; i < n; ++i) (*order)[i] = list[i].id;
  return OK;
}

/* The contact nodes in the order of their node_no. */
static status contact_rows(const table *columns, tabular *t, const view *v,
                           const mesh_group *g) {
  const contact_surface *surface = v->s->contacts.surface;
  if (surface == NULL) return OK;
  OWNED_OF(int, order, order_by_number(surface->n, surface->node_no, &order));
  for (int i = 0; i < surface->n; ++i)
    if (g == NULL ||
        number_find(surface->node_id[order[i]], g->node_id, g->n_node) >= 0)
      table_row(columns, v, order[i], t->dat.f);
  return OK;
}

static status table_rows(const table *columns, tabular *t, const view *v,
                         const print_request *p) {
  const step *now = &t->m->steps[v->s->step_no - 1];
  switch (columns->of) {
    case PER_CONTACT_NODE:
      return contact_rows(columns, t, v, request_group(t->msh, p));
    case PER_NODE:
      choose_nodes(t, p, now);
      ordered_rows(columns, t, v, t->msh->n_node, t->node_order);
      return OK;
    case PER_ELEMENT:
      choose_elements(t, p);
      ordered_rows(columns, t, v, t->msh->n_elem, t->elem_order);
      return OK;
    default:
      for (int i = 0; columns->n > 0 && i < column_items(columns->col[0], v);
           ++i)
        table_row(columns, v, i, t->dat.f);
      return OK;
  }
}

static status write_table(tabular *t, const view *v, const print_request *p) {
  table columns;
  table_choose(&columns, effect_of_table(p->table)->table.of, p->table, v,
               DIGITS);
  fprintf(t->dat.f, "%s# step %d increment %d time %s table %s%s%s\n",
          t->n_block++ > 0 ? "\n\n" : "", v->s->step_no, v->s->increment_no,
          text_number(v->s->t, DIGITS), print_word(p->table),
          p->group != NULL ? " group " : "", p->group != NULL ? p->group : "");
  table_header(&columns, t->m, "#", t->dat.f);
  PASS(table_rows(&columns, t, v, p));
  return text_check(&t->dat);
}

/* 1: request i of a step prints here, and none before it the same rows. */
static int is_due(const step *now, int i, const state *s) {
  const print_request *all = now->print.requests, *own = &all[i];
  const int increment_no = s->within ? -1 : s->increment_no;
  for (int k = 0; k < i; ++k)
    if (all[k].table == own->table &&
        (own->group == NULL) == (all[k].group == NULL) &&
        (own->group == NULL || strcmp(all[k].group, own->group) == 0) &&
        print_shows(&all[k], now, s->t, increment_no, s->end_of_step))
      return 0;
  return print_shows(own, now, s->t, increment_no, s->end_of_step);
}

status tabular_increment(tabular *t, const state *s) {
  if (t == NULL) return OK;
  view v = {t->m, t->msh, s};
  const step *now = &t->m->steps[s->step_no - 1];
  for (int i = 0; i < now->print.n; ++i)
    if (is_due(now, i, s)) {
      TIMED(effect_stage(effect_of_table(now->print.requests[i].table)));
      PASS(write_table(t, &v, &now->print.requests[i]));
    }
  return OK;
}

static unsigned tables_asked(const model *m) {
  unsigned bits = 0;
  for (int i = 0; i < m->n.step; ++i)
    for (int k = 0; k < m->steps[i].print.n; ++k)
      bits |= m->steps[i].print.requests[k].table;
  return bits;
}

static status make_orders(tabular *t, unsigned tables) {
  const mesh *msh = t->msh;
  const unsigned by_node = PRINT_NODES | PRINT_REACTIONS;
  int items = 0;
  if (tables & by_node) {
    PASS(order_by_number(msh->n_node, msh->node_no, &t->node_order));
    items = msh->n_node;
  }
  if (tables & PRINT_ELEMENTS) {
    PASS(order_by_number(msh->n_elem, msh->elem_no, &t->elem_order));
    if (items < msh->n_elem) items = msh->n_elem;
  }
  PASS_NEW(t->wanted, items);
  return OK;
}

static status open_file(tabular *t, const char *dir, long length) {
  PASS(make_orders(t, tables_asked(t->m)));
  OWNED_GET(char, path, text_path(dir, t->m->name.job, "dat"));
  t->n_block = length > 0;
  return length < 0 ? text_open(&t->dat, path, 0)
                    : text_reopen(&t->dat, path, 0, length);
}

status tabular_open(const model *m, const mesh *msh, const char *dir,
                    long length, tabular **out) {
  *out = NULL;
  if (tables_asked(m) == 0) return OK;
  tabular *t = NULL;
  PASS_NEW(t, 1);
  *t = (tabular){.m = m, .msh = msh};
  status st = open_file(t, dir, length);
  if (st != OK)
    tabular_close(t);
  else
    *out = t;
  return st;
}

status tabular_sync(tabular *t, long *length) {
  *length = -1;
  return t == NULL ? OK : text_sync(&t->dat, length);
}

status tabular_close(tabular *t) {
  if (t == NULL) return OK;
  status st = text_close(&t->dat);
  RELEASE(t->node_order, t->elem_order, t->wanted, t);
  return st;
}
