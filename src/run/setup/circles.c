/*
 * Slave nodes of pairs and ties that move with each other in a circle: no node
 * is left that the others follow. Nodes all of whose masters have their place
 * are done, from pass to pass; who waits for ever waits for a node of a circle.
 */
#include "base/base.h"
#include "run/setup/setup.h"

/* Rows of the surface, then of the ties. */
typedef struct finder {
  const contact_surface *s; /* NULL: none with masters */
  const tie_set *ties;
  int n_s, n;
  int *row;            /* [n_node] -1: none */
  unsigned char *done; /* [n] */
} finder;

/* A master of row q that has masters and is not done; -1. */
static int waits_for(const finder *f, int q) {
  const node_links *l = q < f->n_s ? f->s->master : &f->ties->to;
  const int at = q < f->n_s ? q : q - f->n_s;
  for (size_t e = l->start[at]; e < l->start[at + 1]; ++e) {
    const int k = f->row[l->master[e]];
    if (k >= 0 && !f->done[k]) return k;
  }
  return -1;
}

/* A row on a circle, -1: there is none. */
static int find_row(finder *f) {
  int left, before = -1;
  do {
    left = 0;
    for (int q = 0; q < f->n; ++q) {
      f->done[q] |= waits_for(f, q) < 0;
      left += !f->done[q];
    }
    if (left == before) break;
    before = left;
  } while (left > 0);
  int q = 0;
  if (left == 0) return -1;
  while (f->done[q]) ++q;
  for (int k = 0; k < f->n; ++k) q = waits_for(f, q);
  return q;
}

static int node_of(const finder *f, int q) {
  return q < f->n_s ? f->s->node_id[q] : f->ties->node_id[q - f->n_s];
}

/* The card behind normal k of row q; NULL: none, or an obstacle. */
static const place *card_of(const run *r, const finder *f, int q, int k,
                            const char **name) {
  if (q >= f->n_s) {
    const tie *t = &r->m->ties[f->ties->tie_id[q - f->n_s]];
    *name = t->name;
    return &t->at;
  }
  const int id = surface_normal_of(f->s, q, k);
  const contact_pair *p = id < 0 ? NULL : &r->faces.input.pairs[id];
  if (p == NULL || p->support != NULL) return NULL;
  *name = p->name;
  return &p->at;
}

/* Those of row q that the text lacks. */
static void add_names(const run *r, const finder *f, int q, char *text,
                      size_t size) {
  for (int k = 0; k < (q < f->n_s ? f->s->dim : 1); ++k) {
    const char *word;
    const place *at = card_of(r, f, q, k, &word);
    char name[80];
    if (at == NULL) continue;
    snprintf(name, sizeof name, ", %s of line %d", word, at->line_no);
    if (strstr(text, name) == NULL && strlen(text) + strlen(name) < size)
      strcat(text, name);
  }
}

status setup_check_circles(const run *r) {
  const contact_surface *s = r->surface;
  const int n_s = s == NULL || s->master == NULL ? 0 : s->n;
  const tie_set *ties = &r->body.ties;
  const int n = n_s + ties->n;
  char text[480] = "";
  const char *name;
  if (n == 0) return OK;
  OWNED_NEW(int, row, r->msh->n_node);
  OWNED_NEW(unsigned char, done, n);
  finder f = {s, ties, n_s, n, row, done};
  for (int i = 0; i < r->msh->n_node; ++i) row[i] = -1;
  for (int q = 0; q < n; ++q) row[node_of(&f, q)] = q;
  const int first = find_row(&f);
  if (first < 0) return OK;
  for (int q = first, k = 0; k == 0 || q != first; q = waits_for(&f, q), ++k)
    add_names(r, &f, q, text, sizeof text);
  message_add(r->m->log, P4027, card_of(r, &f, first, 0, &name),
              "nodes of the slaves move with each other in a circle, node %zu "
              "among them: %s; give one of them the other slave (SLAVE=), "
              "cracks that meet one *CRACK",
              r->msh->node_no[node_of(&f, first)], text + 2);
  return message_status(r->m->log, ERR_DECK);
}
