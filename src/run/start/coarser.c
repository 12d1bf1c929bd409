/*
 * Increments of a coarser mesh (coarser.h). Forces become tractions, by the
 * tributary areas, in global components: frames of neighbours differ.
 */
#include "run/start/coarser.h"

#include "base/base.h"

struct coarser_state {
  int dim, n;
  double t;                /* s */
  double *x;               /* [dim*n] m */
  int *contact_id;         /* [n] */
  double *gap;             /* [n] left open, m */
  double *traction;        /* [dim*n] N/m2, global components */
  double *slip;            /* [dim*n] m, global components */
  contact_status *contact; /* [n] */
};

struct coarser {
  int n, capacity;
  coarser_state *state; /* [n] in the order of time */
};

status coarser_new(coarser **out) {
  PASS_NEW(*out, 1);
  return OK;
}

/* Traction and slip of node i. */
static void fill_node(const contact_surface *s, const contact_view *v, int i,
                      coarser_state *x) {
  const int dim = s->dim;
  for (int c = 0; c < dim; ++c) {
    double force = 0.0, slip = 0.0;
    for (int a = 0; a < dim; ++a) {
      const double *frame = s->frame + dim * (dim * i + a);
      force += frame[c] * v->rc[dim * i + a];
      if (a > 0) slip += frame[c] * v->slip[(dim - 1) * i + a - 1];
    }
    x->traction[dim * i + c] = s->area[i] > 0.0 ? force / s->area[i] : 0.0;
    x->slip[dim * i + c] = slip;
  }
}

status coarser_add(coarser *c, const contact_surface *s,
                   const contact_view *v) {
  OWNS(c);
  ADDED(coarser_state, x, c->state, c->n, c->capacity);
  *x = (coarser_state){.dim = s->dim, .n = s->n, .t = v->t};
  const size_t n = s->n, all = s->dim * n;
  PASS_NEW_ALL(OF(x->x, all), OF(x->contact_id, n), OF(x->gap, n));
  PASS_NEW_REALS(all, &x->traction, &x->slip);
  PASS_NEW(x->contact, n);
  COPY(x->x, s->x, all);
  COPY(x->contact_id, s->contact_id, n);
  COPY(x->gap, v->gap, s->n);
  COPY(x->contact, v->contact, s->n);
  for (int i = 0; i < s->n; ++i) fill_node(s, v, i, x);
  return OK;
}

const coarser_state *coarser_at(const coarser *c, double t, int next) {
  static const double SAME = 0x1p-30; /* -, of the time */
  for (int i = 0; i < c->n; ++i) {
    const double over = c->state[i].t - t;
    if (fabs(over) <= SAME * fabs(t) || (next && over > 0.0))
      return &c->state[i];
  }
  return NULL;
}

double coarser_time(const coarser_state *x) { return x->t; }
int coarser_nodes(const coarser_state *x) { return x->n; }

typedef struct along {
  double at; /* m, along the longest extent */
  int id;
} along;

static int by_place(const void *a_, const void *b_) {
  const along *a = a_, *b = b_;
  if (a->at != b->at) return a->at < b->at ? -1 : 1;
  return (a->id > b->id) - (a->id < b->id);
}

static int longest_axis(const coarser_state *x) {
  int longest = 0;
  double most = -1.0;
  for (int c = 0; c < x->dim; ++c) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (int i = 0; i < x->n; ++i) {
      low = fmin(low, x->x[x->dim * i + c]);
      high = fmax(high, x->x[x->dim * i + c]);
    }
    if (high - low > most) {
      most = high - low;
      longest = c;
    }
  }
  return longest;
}

/* The first of n sorted places that is not before "at". */
static int place_of(const along *list, int n, double at) {
  int low = 0, high = n;
  while (low < high) {
    const int middle = low + (high - low) / 2;
    if (list[middle].at < at)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

typedef struct search {
  const coarser_state *of;
  const along *list; /* [of->n] */
  const double *x;   /* [dim] m, the node looked for */
  double at;         /* its place along the axis */
  int contact_id;
  double best; /* m2 */
  int found;
} search;

/* Looks at place k; 0: those beyond are farther than the best. */
static int look(search *s, int k) {
  const coarser_state *of = s->of;
  const double off = s->list[k].at - s->at;
  const int id = s->list[k].id;
  double square = 0.0;
  if (off * off > s->best) return 0;
  if (of->contact_id[id] != s->contact_id) return 1;
  for (int c = 0; c < of->dim; ++c) {
    const double d = of->x[of->dim * id + c] - s->x[c];
    square += d * d;
  }
  if (square < s->best || (square == s->best && id < s->found)) {
    s->best = square;
    s->found = id;
  }
  return 1;
}

static int nearest_of(const coarser_state *x, const along *list, int axis,
                      const contact_surface *s, int i) {
  search q = {.of = x,
              .list = list,
              .x = s->x + s->dim * i,
              .at = s->x[s->dim * i + axis],
              .contact_id = s->contact_id[i],
              .best = HUGE_VAL,
              .found = -1};
  const int from = place_of(list, x->n, q.at);
  int down = from - 1, up = from;
  while (down >= 0 || up < x->n) {
    if (down >= 0 && !look(&q, down--)) down = -1;
    if (up < x->n && !look(&q, up++)) up = x->n;
  }
  return q.found;
}

status coarser_match(const coarser_state *x, const contact_surface *s,
                     int *nearest) {
  const int axis = longest_axis(x);
  OWNED_NEW(along, list, x->n);
  for (int i = 0; i < x->n; ++i) list[i] = (along){x->x[x->dim * i + axis], i};
  qsort(list, x->n, sizeof *list, by_place);
  for (int i = 0; i < s->n; ++i) nearest[i] = nearest_of(x, list, axis, s, i);
  return OK;
}

contact_status coarser_contact(const coarser_state *x, int node) {
  return node < 0 ? CONTACT_OPEN : x->contact[node];
}

void coarser_read(const coarser_state *x, int node, const contact_surface *s,
                  int i, coarser_node *out) {
  const int dim = x->dim;
  const contact_status is = x->contact[node];
  *out = (coarser_node){.gap = is == CONTACT_OPEN ? x->gap[node] : 0.0};
  for (int a = 0; a < dim && is != CONTACT_OPEN; ++a) {
    const double *frame = s->frame + dim * (dim * i + a);
    for (int c = 0; c < dim; ++c) {
      out->traction[a] += frame[c] * x->traction[dim * node + c];
      if (a > 0 && is == CONTACT_SLIP)
        out->slip[a - 1] += frame[c] * x->slip[dim * node + c];
    }
  }
}
