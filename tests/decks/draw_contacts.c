/*
 * What a seed gives: obstacles, how they move, friction.
 */
#include "decks/deck.h"

#include "base/base.h"

/* Box of a group of faces. */
static void find_box(const solid *s, int group, double low[3], double high[3]) {
  for (int c = 0; c < 3; ++c) low[c] = HUGE_VAL, high[c] = -HUGE_VAL;
  for (int f = 0; f < s->n_face; ++f)
    for (int v = 0; s->face_group[f] == group && v < s->dim; ++v)
      for (int c = 0; c < s->dim; ++c) {
        double x = s->x[s->dim * s->face[s->dim * f + v] + c];
        low[c] = fmin(low[c], x);
        high[c] = fmax(high[c], x);
      }
}

static obstacle_kind draw_obstacle_kind(const random_deck *d,
                                        random_source *r) {
  int axi = d->kind == AXISYMMETRIC_;
  obstacle_kind kind = (obstacle_kind)random_pick(r, 5);
  if (kind == SPHERE && d->mesh.dim == 2 && !axi) kind = CYLINDER;
  return kind == CYLINDER && (d->floats || axi) ? PLANE : kind;
}

/* An obstacle below a foot whose box is given, "gap" away. */
static void draw_shape(const random_deck *d, deck_obstacle *o,
                       const double *low, const double *high, double gap,
                       random_source *r) {
  int dim = d->mesh.dim, up = dim - 1, axi = d->kind == AXISYMMETRIC_;
  double tilt = d->floats || axi ? 0.0 : random_real(r, -0.02, 0.02);
  o->kind = draw_obstacle_kind(d, r);
  for (int c = 0; c < dim; ++c) o->point[c] = 0.5 * (low[c] + high[c]);
  o->point[up] = low[up] - gap;
  o->direction[up] = cos(tilt);
  o->direction[0] = sin(tilt);
  o->gap0 = gap;
  o->gap2 = random_real(r, 0, 0.05);
  o->gap_at = o->point[0];
  if (o->kind != CYLINDER && o->kind != SPHERE) return;
  if (axi) o->point[0] = 0;
  o->radius = random_real(r, 3, 20) * (axi ? 4 : 1);
  o->point[up] -= o->radius;
  o->direction[0] = 0.05 * tilt;
  o->direction[1] = 1;
  o->direction[2] = 0;
}

static void draw_turn(const random_deck *d, deck_obstacle *o,
                      random_source *r) {
  int dim = d->mesh.dim, round = o->kind == CYLINDER;
  memcpy(o->pivot, o->point, sizeof o->pivot);
  o->axis[2] = 1;
  o->angle = random_real(r, -0.003, 0.003);
  if (dim == 3) {
    memcpy(o->axis, o->direction, sizeof o->axis);
    if (o->kind == SPHERE || random_chance(r, 0.5))
      for (int c = 0; c < 3; ++c) o->axis[c] = random_real(r, -1, 1);
    else if (o->kind == PLANE)
      o->angle *= 5;
  }
  if (round && dim == 2) o->angle *= 2;
  if (random_chance(r, 0.3)) o->pivot[0] += random_real(r, -0.5, 0.5);
}

static void draw_motion(const random_deck *d, deck_obstacle *o,
                        random_source *r) {
  int dim = d->mesh.dim, axi = d->kind == AXISYMMETRIC_;
  if (random_chance(r, 0.4) || (axi && o->kind == SPHERE)) return;
  o->motion = (motion_kind)(1 + random_pick(r, 3));
  o->course = random_pick(r, 4);
  o->omega = random_real(r, 1, 5);
  if (random_chance(r, 0.7))
    for (int c = axi ? 1 : 0; c < dim; ++c)
      o->move[c] = random_real(r, -0.005, 0.005);
  if (!axi && o->kind != GAP && random_chance(r, 0.6)) draw_turn(d, o, r);
  if (o->angle == 0 && o->move[dim - 1] == 0) o->motion = STANDS;
}

/* ---- friction ----------------------------------------------------------- */

/* Mirrors along the contact, never of the radius. */
static void draw_average(const random_deck *d, int wall, deck_friction *f,
                         random_source *r) {
  int dim = d->mesh.dim, flat = d->kind < AXISYMMETRIC_;
  f->radius = random_real(r, 0.2, 0.7);
  f->kernel = random_pick(r, KERNELS);
  f->normalized = random_chance(r, 0.3);
  f->zone = random_chance(r, 0.25);
  f->geodesic = flat && random_chance(r, 0.4);
  for (int c = wall; c < dim - !wall && !f->geodesic; ++c)
    if ((d->kind != AXISYMMETRIC_ || wall) && random_chance(r, 0.3))
      f->mirror[c] = 1 + random_pick(r, 2);
}

/* By a table, or linear in x. */
static void draw_value(const random_deck *d, deck_friction *f,
                       random_source *r) {
  f->value.at0 = random_real(r, 0.05, 0.6);
  if (random_chance(r, 0.25)) {
    f->course = 4 + random_pick(r, 2);
  } else if (random_chance(r, 0.5)) {
    f->table = "XYZT"[random_pick(r, 4)];
    if (f->table == 'Z' && d->mesh.dim == 2) f->table = 'Y';
    f->pairs.n = 2 + random_pick(r, POINTS - 1);
  } else if (random_chance(r, 0.3)) {
    f->value.slope[0] = 0.1 * f->value.at0;
  }
  for (int i = 0; i < f->pairs.n; ++i) {
    f->pairs.t[i] =
        (i == 0 ? -0.2 : f->pairs.t[i - 1]) + random_real(r, 0.1, 0.7);
    f->pairs.a[i] = random_real(r, 0.05, 0.6);
  }
}

static void draw_friction(const random_deck *d, int wall, deck_friction *f,
                          random_source *r) {
  int k = random_pick(r, 20), free = !d->floats;
  *f = (deck_friction){.course = -1};
  f->law = k < 2 && free ? FRICTIONLESS
           : k < 5       ? TRESCA
           : k < 11      ? COULOMB
                         : NONLOCAL;
  if (free)
    draw_value(d, f, r);
  else
    f->value.at0 = random_real(r, 0.4, 0.6);
  if (f->law == NONLOCAL) draw_average(d, wall, f, r);
  if (f->law != TRESCA) return;
  f->value.at0 *= 5;
  f->value.slope[0] *= 5;
  for (int i = 0; i < f->pairs.n; ++i) f->pairs.a[i] *= 5;
}

/* ---- contacts ----------------------------------------------------------- */

static void draw_given(const random_deck *d, deck_contact *c,
                       random_source *r) {
  c->course = -1;
  if (d->floats || !random_chance(r, 0.2)) return;
  c->given = 1;
  c->pressure.at0 = random_real(r, 0.5, 5);
  if (random_chance(r, 0.5)) c->pressure.slope[0] = 0.1 * c->pressure.at0;
  if (random_chance(r, 0.5)) c->course = 4 + random_pick(r, 2);
}

static void draw_contact(random_deck *d, const char *group, int wall,
                         random_source *r) {
  deck_contact *c = &d->contact[d->n_contact];
  double low[3], high[3], gap = 0;
  memset(c, 0, sizeof *c);
  c->group = solid_find(&d->mesh, group);
  find_box(&d->mesh, c->group, low, high);
  if (!d->floats || random_chance(r, 0.15))
    if (random_chance(r, 0.5)) gap = random_real(r, 0, 0.003);
  if (wall) {
    c->obstacle.kind = random_chance(r, 0.5) ? CONFORMING : GAP;
    c->obstacle.gap0 = gap;
  } else {
    draw_shape(d, &c->obstacle, low, high, gap, r);
    if (!d->floats) draw_motion(d, &c->obstacle, r);
  }
  if (c->obstacle.kind == CYLINDER || c->obstacle.kind == SPHERE)
    c->normal = 1 + random_chance(r, 0.6);
  draw_given(d, c, r);
  int k = d->n_contact++;
  for (int s = 0; s < d->n_step; ++s) {
    if (s > 0 && !random_chance(r, 0.3)) continue;
    d->step[s].has_friction[k] = 1;
    draw_friction(d, wall, &d->step[s].friction[k], r);
  }
}

void deck_draw_contacts(random_deck *d, random_source *r) {
  draw_contact(d, "FOOT1", 0, r);
  if (d->n_body == 2)
    draw_contact(d, "FOOT2", 0, r);
  else if (!d->floats && random_chance(r, 0.3))
    draw_contact(d, "RIGHT1", 1, r);
}
