/*
 * What a seed gives: bodies, materials, supports and loads. Lengths are near 1,
 * moduli 1000, strains 1e-3, steps last 1 to 2.
 */
#include "decks/deck.h"

#include "base/base.h"

/* How the bodies are held. */
typedef enum { CLAMPED, PRESSED, HELD_LEFT, LYING } hold;

static int sign(random_source *r) { return random_chance(r, 0.5) ? 1 : -1; }

static void draw_plan(const random_deck *d, solid_plan *p, random_source *r) {
  int space = p->dim == 3;
  for (int c = 0; c < p->dim; ++c) {
    int up = c == p->dim - 1;
    p->n[c] = space    ? 2 + random_pick(r, up ? 2 : 3)
              : c == 0 ? 4 + random_pick(r, 6)
                       : 2 + random_pick(r, 3);
    p->length[c] = up ? random_real(r, 0.4, 0.8) : random_real(r, 0.8, 1.2);
  }
  p->shake = random_chance(r, 0.7) ? 0.15 : 0.0;
  p->bend = random_chance(r, 0.4) ? random_real(r, 0.0, 0.02) : 0.0;
  if (d->kind == AXISYMMETRIC_ && p->at[0] == 0 && random_chance(r, 0.5))
    p->at[0] = 0.5;
}

static void draw_mesh(random_deck *d, hold h, random_source *r) {
  solid_plan p = {.dim = d->kind == SOLID_ ? 3 : 2};
  d->n_body = h != LYING && random_chance(r, 0.25) ? 2 : 1;
  p.layers = random_chance(r, 0.35);
  for (int b = 0; b < d->n_body; ++b) {
    draw_plan(d, &p, r);
    solid_add(&d->mesh, &p, b, r);
    p.at[0] += p.length[0] + 1.0;
  }
}

static double tau(random_source *r) { return random_real(r, 0.3, 3.0); }

/* Springs and dashpots. */
static void draw_units(deck_material *m, random_source *r) {
  double E = m->E[0], (*t)[4] = m->term;
  m->n_term = m->law == KELVIN ? 1 + random_pick(r, 2) : 1;
  for (int k = 0; k < m->n_term; ++k) {
    t[k][0] = E * random_real(r, 0.5, 3.0);
    t[k][1] = t[k][0] * tau(r);
  }
  if (m->law == MAXWELL || m->law == DEVIATORIC) t[0][0] = tau(r);
  if (m->law != BURGERS) return;
  t[0][2] = t[0][1];
  t[0][1] = t[0][0];
  t[0][0] = E * tau(r);
}

static void draw_series(deck_material *m, random_source *r) {
  m->n_term = 1 + random_pick(r, TERMS);
  for (int k = 0; k < m->n_term; ++k) {
    double *t = m->term[k];
    t[0] = random_real(r, 0.0, 0.9 / m->n_term);
    t[1] = random_chance(r, 0.5) ? random_real(r, 0, 0.5 / m->n_term) : 0;
    t[2] = tau(r) * (k == 0 ? 1.0 : 0.1);
  }
}

/* Near a strain of 1e-3 in the time 1 at the stress q. */
static void draw_creep(deck_material *m, double q, random_source *r) {
  double n = 2.0 + random_pick(r, 3), *t = m->term[0];
  m->n_term = 1;
  t[0] = random_real(r, 0.2, 2.0) * 1e-3;
  if (m->law == CREEP_HYPERB) {
    t[1] = 0.5 / q;
    t[2] = n;
    return;
  }
  t[0] /= pow(q, n);
  t[1] = n;
  t[2] = random_chance(r, 0.5) ? -random_real(r, 0.0, 0.5) : 0.0;
}

static void draw_threshold(deck_material *m, double q, random_source *r) {
  double E = m->E[0], *t = m->term[0];
  m->n_term = m->law == CHABOCHE ? 2 : 1;
  t[0] = random_real(r, 0.5, 2.0) * q;
  t[1] = m->law == BINGHAM ? E * tau(r) : 10.0 * q;
  t[2] = m->law == PERZYNA ? 0.1 * E : 2.0;
  t[3] = m->law == PERZYNA ? 1.5 : q;
  m->term[1][0] = 0.1 * E;
  m->term[1][1] = 50.0;
}

/* Terms of a law whose rates are near one strain in a step. */
static void draw_terms(deck_material *m, random_source *r) {
  double q = 5.0;
  if (m->law >= BINGHAM)
    draw_threshold(m, q, r);
  else if (m->law >= NORTON)
    draw_creep(m, q, r);
  else if (m->law >= PRONY)
    draw_series(m, r);
  else if (m->law != NO_LAW)
    draw_units(m, r);
}

static void draw_material(deck_material *m, int flows, int warm,
                          random_source *r) {
  m->n_set = warm && random_chance(r, 0.5) ? 2 : 1;
  for (int k = 0; k < 2; ++k) {
    m->E[k] = random_real(r, 500, 2000);
    m->nu[k] = random_real(r, 0.0, 0.42);
    m->at[k] = 150.0 * k - 20.0;
  }
  if (warm) m->alpha = random_real(r, 0.5e-5, 2e-5);
  if (random_chance(r, 0.3)) m->zero = 20.0;
  m->density = random_real(r, 0.5, 1.5);
  m->law = flows ? (law_kind)(1 + random_pick(r, LAWS - 1)) : NO_LAW;
  if (m->n_set == 2 && flows && random_chance(r, 0.6))
    m->law = random_chance(r, 0.5) ? PRONY : MAXWELL;
  draw_terms(m, r);
  m->shift = flows && warm && m->law != CREEP_HYPERB && random_chance(r, 0.4);
  m->t_ref = 20.0;
  m->c1 = random_real(r, 0.5, 3.0);
  m->c2 = 200.0;
}

/* 0.85 and 0.85: nearly incompressible and averaged. */
static void draw_materials(random_deck *d, random_source *r) {
  int flows = random_chance(r, 0.55), warm = random_chance(r, 0.4);
  d->averaged = random_chance(r, 0.2);
  d->n_material = 1 + random_chance(r, 0.5);
  for (int k = 0; k < d->n_material; ++k)
    draw_material(&d->material[k], flows && (k == 0 || random_chance(r, 0.5)),
                  warm, r);
  for (int k = 0; k < d->n_material && d->averaged; ++k)
    for (int i = 0; i < 2; ++i)
      d->material[k].nu[i] = random_real(r, 0.41, 0.4999);
  for (int g = 0; g < d->mesh.n_group; ++g)
    d->material_of[g] =
        d->mesh.group[g].dim < d->mesh.dim ? -1 : random_pick(r, d->n_material);
  for (int b = 0; b < d->n_body && warm; ++b)
    if (random_chance(r, 0.5)) d->warm[b] = random_real(r, 0, 40);
  d->field = calloc((size_t)d->mesh.n_node, sizeof *d->field);
  if (d->field == NULL) abort();
  for (int i = 0; i < d->mesh.n_node; ++i) d->field[i] = random_real(r, 0, 100);
}

int deck_has_heat(const random_deck *d) { return d->material[0].alpha > 0; }

int deck_flows(const random_deck *d) {
  for (int k = 0; k < d->n_material; ++k)
    if (d->material[k].law != NO_LAW) return 1;
  return 0;
}

/* Courses 0 to 3 in step or total time for loads, 4 and 5 never below 0. */
static void draw_courses(random_deck *d, random_source *r) {
  d->n_course = COURSES;
  for (int k = 0; k < COURSES; ++k) {
    course *c = &d->courses[k];
    int positive = k >= 4;
    c->formula = random_chance(r, 0.3);
    c->total = positive || random_chance(r, 0.4);
    c->n = 2 + random_pick(r, POINTS - 1);
    for (int i = 0; i < c->n; ++i) {
      c->t[i] = i == 0 ? 0 : c->t[i - 1] + random_real(r, 0.2, 0.8);
      c->a[i] = random_real(r, positive ? 0.2 : -0.3, 1.0);
    }
    if (!positive && random_chance(r, 0.6)) c->a[0] = 0;
    if (!c->formula) continue;
    c->n = 3;
    c->a[0] = random_real(r, 0.4, 0.6);
    c->a[1] = random_real(r, -0.4, 0.4);
    c->a[2] = random_real(r, 1.0, 6.0);
  }
}

/* ---- steps -------------------------------------------------------------- */

static deck_load *new_load(deck_step *s, load_kind_ kind, int group,
                           int component, double value, random_source *r) {
  if (s->n_load == LOADS) abort();
  deck_load *l = &s->load[s->n_load++];
  *l = (deck_load){.kind = kind, .group = group, .component = component};
  l->course = random_chance(r, 0.45) ? random_pick(r, 4) : -1;
  l->value.at0 = value;
  return l;
}

static int group_of(const random_deck *d, const char *name, int body) {
  char full[32];
  snprintf(full, sizeof full, "%s%d", name, body + 1);
  return solid_find(&d->mesh, full);
}

/* 1: nodes on the axis, which cannot move from it. */
static int touches_axis(const random_deck *d, int b) {
  return d->kind == AXISYMMETRIC_ && b == 0 && d->mesh.x[0] == 0;
}

static void clamp_body(random_deck *d, deck_step *s, int b, int first,
                       random_source *r) {
  int dim = d->mesh.dim, axis = touches_axis(d, b), top = group_of(d, "TOP", b);
  if (axis && first) new_load(s, FIX, group_of(d, "LEFT", b), 0, 0, r);
  for (int c = axis; c < dim; ++c)
    if (first || random_chance(r, 0.7))
      new_load(s, FIX, top, c,
               c == dim - 1 ? -random_real(r, 0.001, 0.01)
                            : sign(r) * random_real(r, 0, 0.006),
               r);
}

static void hold_body(random_deck *d, deck_step *s, hold h, int b, int first,
                      random_source *r) {
  int dim = d->mesh.dim, left = group_of(d, "LEFT", b);
  if (h == CLAMPED) {
    clamp_body(d, s, b, first, r);
    return;
  }
  int last = h == HELD_LEFT ? dim : h == PRESSED;
  for (int c = 0; c < last && first; ++c) new_load(s, FIX, left, c, 0, r);
  if (first && h == PRESSED && dim == 3)
    new_load(s, FIX, group_of(d, "FRONT", b), 1, 0, r);
  deck_load *l =
      new_load(s, PRESSURE, group_of(d, "TOP", b), 0, random_real(r, 1, 6), r);
  if (h != HELD_LEFT) l->course = -1;
  if (random_chance(r, 0.4))
    for (int c = 0; c < dim; ++c)
      l->value.slope[c] = random_real(r, -0.1, 0.1) * l->value.at0;
}

/* Weight and forces on nodes. */
static void weigh_body(random_deck *d, deck_step *s, hold h, int b,
                       random_source *r) {
  int dim = d->mesh.dim, body = group_of(d, "BODY", b);
  double size = h == LYING ? 0.05 : 1.0;
  if (random_chance(r, 0.2))
    new_load(s, BODY_FORCE, body, random_pick(r, dim - (h != CLAMPED)),
             size * sign(r) * random_real(r, 0, 1), r);
  if (random_chance(r, 0.2) && b == 0) {
    deck_load *l = new_load(s, GRAVITY, body, 0, random_real(r, 0, 1), r);
    l->direction[dim - 1] = -1;
  }
  if (random_chance(r, 0.15) && h == CLAMPED)
    new_load(s, POINT, group_of(d, "RIGHT", b), random_pick(r, dim),
             sign(r) * random_real(r, 0, 0.05), r);
}

static void push_body(random_deck *d, deck_step *s, hold h, int b,
                      random_source *r) {
  double size = h == LYING ? 0.05 : 1.0;
  if (random_chance(r, 0.5))
    new_load(s, TRACTION, group_of(d, "RIGHT", b),
             h == LYING ? 0 : random_pick(r, d->mesh.dim),
             size * sign(r) * random_real(r, 0, 1.0), r);
  if (h == CLAMPED && random_chance(r, 0.3))
    new_load(s, PRESSURE, group_of(d, "LEFT", b), 0, random_real(r, 0, 2), r);
  weigh_body(d, s, h, b, r);
  /* what contact holds is pushed no earlier than it is pressed */
  for (int k = 0; (h == LYING || h == PRESSED) && k < s->n_load; ++k)
    s->load[k].course = -1;
}

static void heat_body(random_deck *d, deck_step *s, int b, random_source *r) {
  if (!deck_has_heat(d) || !random_chance(r, 0.7)) return;
  deck_load *l =
      new_load(s, HEAT, group_of(d, "BODY", b), 0, random_real(r, -20, 100), r);
  if (random_chance(r, 0.4)) l->value.slope[0] = random_real(r, -20, 20);
  if (!random_chance(r, 0.4)) return;
  l->field = 1;
  l->value = (linear){.at0 = random_real(r, 0.2, 1.2)};
}

static int is_linear(const random_deck *d) {
  for (int k = 0; k < d->n_material; ++k) {
    const deck_material *m = &d->material[k];
    if (m->law > VISCOELASTIC || m->shift || m->n_set > 1) return 0;
  }
  return 1;
}

static void draw_integrator(const random_deck *d, deck_step *s,
                            random_source *r) {
  static const char *const name[] = {
      "BACKWARD", "MIDPOINT", "THETA", "EULER", "HEUN", "RK4", "EXPONENTIAL"};
  int k = random_pick(r, is_linear(d) ? 7 : 6);
  s->integrator = name[k];
  s->theta = k == 2 ? random_real(r, 0.55, 1.0) : 0;
  s->substeps = k >= 3 && k <= 5;
  s->initial_tangent = k < 3 && random_chance(r, 0.1);
  if (k != 3 && k < 6 && random_chance(r, 0.15)) s->tolerance = 1e-2;
}

static void draw_step(random_deck *d, int i, hold h, random_source *r) {
  deck_step *s = &d->step[i];
  s->start = i == 0 ? 0 : d->step[i - 1].start + d->step[i - 1].total;
  s->total = random_chance(r, 0.5) ? 1.0 : 1.5;
  s->dt = s->total / (2 + random_pick(r, 3));
  s->kind = deck_flows(d) && random_chance(r, 0.8) ? IS_VISCO
            : random_chance(r, 0.15)               ? IS_STATIC
                                                   : IS_QUASISTATIC;
  if (s->kind == IS_STATIC) s->dt = s->total;
  s->velocity = s->kind == IS_QUASISTATIC && random_chance(r, 0.3);
  if (s->kind == IS_VISCO) draw_integrator(d, s, r);
  for (int b = 0; b < d->n_body; ++b) {
    if (i == 0 || random_chance(r, 0.6)) hold_body(d, s, h, b, i == 0, r);
    if (random_chance(r, 0.6)) push_body(d, s, h, b, r);
    heat_body(d, s, b, r);
  }
}

static deck_kind draw_kind(random_source *r) {
  int k = random_pick(r, 20);
  return k < 6    ? PLANE_STRAIN_
         : k < 9  ? PLANE_STRESS_
         : k < 13 ? AXISYMMETRIC_
                  : SOLID_;
}

static hold draw_hold(const random_deck *d, random_source *r) {
  int k = random_pick(r, 20);
  hold h = k < 10 ? CLAMPED : k < 15 ? PRESSED : k < 18 ? HELD_LEFT : LYING;
  return d->kind == AXISYMMETRIC_ && h == LYING ? PRESSED : h;
}

void deck_draw(unsigned long long seed, random_deck *d) {
  random_source r = {seed * 7919 + 17};
  memset(d, 0, sizeof *d);
  d->seed = seed;
  d->kind = draw_kind(&r);
  hold h = draw_hold(d, &r);
  d->floats = h == LYING || h == PRESSED;
  d->thickness = d->kind < AXISYMMETRIC_ && random_chance(&r, 0.3) ? 0.5 : 1.0;
  draw_mesh(d, h, &r);
  draw_materials(d, &r);
  draw_courses(d, &r);
  d->n_step = 1 + random_pick(&r, STEPS);
  for (int i = 0; i < d->n_step; ++i) draw_step(d, i, h, &r);
  d->balanced = random_chance(&r, 0.08);
  d->relax = h == CLAMPED && random_chance(&r, 0.12);
  for (int c = 0; c < d->mesh.dim && d->relax; ++c)
    d->start[c] = random_real(&r, -1e-3, 1e-3);
  d->fields = random_chance(&r, 0.3);
  deck_draw_contacts(d, &r);
}

void deck_release(random_deck *d) {
  solid_free(&d->mesh);
  free(d->field);
  d->field = NULL;
}
