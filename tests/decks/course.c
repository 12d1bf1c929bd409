/*
 * Values of a deck in time, by the rules of the manual: what is said without
 * an amplitude grows over its step, stays then, and goes on from there when it
 * is said again; step times hold to the end of their step.
 */
#include "decks/deck.h"

#include "base/base.h"

static double between(int n, const double *t, const double *a, double at) {
  if (at <= t[0]) return a[0];
  for (int i = 1; i < n; ++i)
    if (at <= t[i])
      return a[i - 1] + (a[i] - a[i - 1]) * (at - t[i - 1]) / (t[i] - t[i - 1]);
  return a[n - 1];
}

double course_value(const course *c, double t) {
  if (c->formula) return c->a[0] + c->a[1] * sin(c->a[2] * t);
  return between(c->n, c->t, c->a, t);
}

double linear_value(const linear *v, int dim, const double *x) {
  double sum = v->at0;
  for (int c = 0; c < dim; ++c) sum += v->slope[c] * x[c];
  return sum;
}

int deck_step_at(const random_deck *d, double t) {
  int s = 0;
  while (s < d->n_step - 1 &&
         t > d->step[s].start + d->step[s].total * (1 + 1e-9))
    ++s;
  return s;
}

static int same_load(const deck_load *a, const deck_load *b) {
  return a->kind == b->kind && a->group == b->group &&
         a->component == b->component;
}

/* The last step up to "step" that says this load, or -1. */
static const deck_load *find_load(const random_deck *d, int *step,
                                  const deck_load *l) {
  for (; *step >= 0; --*step) {
    const deck_step *s = &d->step[*step];
    for (int k = s->n_load - 1; k >= 0; --k)
      if (same_load(&s->load[k], l)) return &s->load[k];
  }
  return NULL;
}

/* Value of what step "owner" says, while that step is in progress. */
static double own_value(const random_deck *d, int owner, const deck_load *l,
                        const double *x, double t, double from) {
  const deck_step *s = &d->step[owner];
  double v = linear_value(&l->value, d->mesh.dim, x);
  if (l->field) v *= x[3];
  if (l->course >= 0) {
    const course *c = &d->courses[l->course];
    return v * course_value(c, c->total ? t : t - s->start);
  }
  int before = owner - 1;
  const deck_load *old = find_load(d, &before, l);
  if (old != NULL) from = deck_load_value(d, owner - 1, old, x, s->start, from);
  double w = fmin(1.0, (t - s->start) / s->total);
  return (1 - w) * from + w * v;
}

double deck_load_value(const random_deck *d, int step, const deck_load *l,
                       const double *x, double t, double from) {
  int owner = step;
  const deck_load *now = find_load(d, &owner, l);
  int total = now->course >= 0 && d->courses[now->course].total;
  double end = d->step[owner].start + d->step[owner].total;
  return own_value(d, owner, now, x, owner == step || total ? t : end, from);
}

int deck_loads(const random_deck *d, int step, deck_load *out, int *owner) {
  int n = 0;
  for (int s = step; s >= 0; --s)
    for (int k = 0; k < d->step[s].n_load; ++k) {
      const deck_load *l = &d->step[s].load[k];
      int known = 0;
      for (int i = 0; i < n; ++i) known |= same_load(&out[i], l);
      for (int i = k + 1; i < d->step[s].n_load; ++i)
        known |= same_load(&d->step[s].load[i], l);
      if (known) continue;
      owner[n] = s;
      out[n++] = *l;
    }
  return n;
}

const deck_friction *deck_friction_at(const random_deck *d, int step, int c) {
  while (step > 0 && !d->step[step].has_friction[c]) --step;
  return &d->step[step].friction[c];
}

double deck_friction_value(const random_deck *d, const deck_friction *f,
                           const double *x, double t) {
  double v = linear_value(&f->value, d->mesh.dim, x);
  if (f->table != 0)
    v = between(f->pairs.n, f->pairs.t, f->pairs.a,
                f->table == 'T' ? t : x[f->table - 'X']);
  return f->course < 0 ? v : v * course_value(&d->courses[f->course], t);
}

void deck_motion(const random_deck *d, const deck_obstacle *o, double t,
                 double shift[3], double *angle) {
  double f = 0;
  if (o->motion == TO_END) f = fmin(1.0, t / d->step[0].total);
  if (o->motion == BY_COURSE) f = course_value(&d->courses[o->course], t);
  if (o->motion == BY_FORMULA) f = sin(o->omega * t);
  for (int c = 0; c < 3; ++c) shift[c] = f * o->move[c];
  *angle = f * o->angle;
}
