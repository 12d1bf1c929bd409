/*
 * The text of a deck, its mesh and its field of temperatures, in any units.
 */
#include "decks/deck.h"

#include "base/base.h"

#include <check.h>

typedef struct writer {
  FILE *f;
  const random_deck *d;
  const deck_text *how;
} writer;

/* A value of dimension length^L force^F time^T in the units of the text. */
static double in(const writer *w, double v, double L, double F, double T) {
  const deck_units *u = &w->how->units;
  return v * pow(u->length, L) * pow(u->force, F) * pow(u->time, T);
}

static int axis(const writer *w, int c) {
  return deck_axis(w->how, w->d->mesh.dim, c);
}

static double stress(const writer *w, double v) { return in(w, v, -2, 1, 0); }

static void put(const writer *w, const char *before, double v) {
  fprintf(w->f, "%s%.17g", before, v);
}

/* A linear value: a number, or an expression of x y z. */
static void put_linear(const writer *w, const linear *v, double L, double F) {
  int varies = 0;
  for (int c = 0; c < 3; ++c) varies |= v->slope[c] != 0;
  if (!varies) {
    put(w, "", in(w, v->at0, L, F, 0));
    return;
  }
  put(w, "\"", in(w, v->at0, L, F, 0));
  for (int c = 0; c < w->d->mesh.dim; ++c)
    fprintf(w->f, " + (%.17g)*%c", in(w, v->slope[c], L - 1, F, 0),
            'x' + axis(w, c));
  fprintf(w->f, "\"");
}

static void put_vector(const writer *w, const char *before, const double *v,
                       double L) {
  double of[3];
  fprintf(w->f, "%s", before);
  for (int c = 0; c < w->d->mesh.dim; ++c)
    of[axis(w, c)] = in(w, v[c], L, 0, 0);
  for (int c = 0; c < w->d->mesh.dim; ++c) put(w, c == 0 ? "" : ", ", of[c]);
}

/* ---- before the steps --------------------------------------------------- */

static void write_courses(const writer *w) {
  for (int k = 0; k < w->d->n_course; ++k) {
    const course *c = &w->d->courses[k];
    fprintf(w->f, "*AMPLITUDE, NAME=A%d%s\n", k,
            c->total ? ", TIME=TOTAL TIME" : "");
    if (c->formula)
      fprintf(w->f, "\"%.17g + (%.17g)*sin(%.17g*t)\"\n", c->a[0], c->a[1],
              in(w, c->a[2], 0, 0, -1));
    for (int i = 0; !c->formula && i < c->n; ++i)
      fprintf(w->f, "%.17g, %.17g\n", in(w, c->t[i], 0, 0, 1), c->a[i]);
  }
}

/* Exponents of length, force and time of the fields of a law. */
typedef struct law_row {
  const char *card;
  int n_field;
  double unit[4][3];
} law_row;

/* clang-format off */
#define STRESS_ {-2, 1, 0}
#define VISCOSITY_ {-2, 1, 1}
#define TIME_ {0, 0, 1}
#define NONE_ {0, 0, 0}
static const law_row laws[LAWS] = {
    [MAXWELL] = {"*INELASTIC, LAW=MAXWELL", 1, {TIME_}},
    [DEVIATORIC] = {"*INELASTIC, LAW=MAXWELL, TYPE=DEVIATORIC", 1, {TIME_}},
    [ZENER] = {"*INELASTIC, LAW=ZENER", 2, {STRESS_, VISCOSITY_}},
    [KELVIN] = {"*INELASTIC, LAW=KELVIN", 2, {STRESS_, VISCOSITY_}},
    [BURGERS] = {"*INELASTIC, LAW=BURGERS", 3,
                 {VISCOSITY_, STRESS_, VISCOSITY_}},
    [PRONY] = {"*INELASTIC, LAW=PRONY", 3, {NONE_, NONE_, TIME_}},
    [VISCOELASTIC] = {"*VISCOELASTIC, TIME=PRONY", 3, {NONE_, NONE_, TIME_}},
    [NORTON] = {"*INELASTIC, LAW=NORTON", 3, {NONE_, NONE_, NONE_}},
    [CREEP_STRAIN] = {"*CREEP, LAW=STRAIN", 3, {NONE_, NONE_, NONE_}},
    [CREEP_TIME] = {"*CREEP, LAW=TIME", 3, {NONE_, NONE_, NONE_}},
    [CREEP_HYPERB] = {"*CREEP, LAW=HYPERB", 3,
                      {{0, 0, -1}, {2, -1, 0}, NONE_}},
    [BINGHAM] = {"*INELASTIC, LAW=BINGHAM", 2, {STRESS_, VISCOSITY_}},
    [PERZYNA] = {"*INELASTIC, LAW=PERZYNA", 4,
                 {STRESS_, {-2, 1, 1 / 1.5}, STRESS_, NONE_}},
    [CHABOCHE] = {"*INELASTIC, LAW=CHABOCHE", 4,
                  {STRESS_, {-2, 1, 0.5}, NONE_, STRESS_}}};
/* clang-format on */

static void write_term(const writer *w, const deck_material *m, int k) {
  const law_row *row = &laws[m->law];
  int back = m->law == CHABOCHE && k > 0, n = back ? 2 : row->n_field;
  for (int i = 0; i < n; ++i) {
    const double *unit = back ? laws[BINGHAM].unit[0] : row->unit[i];
    double v = m->term[k][i];
    if (!back || i == 0) v = in(w, v, unit[0], unit[1], unit[2]);
    if (i == 0 && m->law >= NORTON && m->law <= CREEP_TIME)
      v = in(w, v, 2 * m->term[0][1], -m->term[0][1], -1 - m->term[0][2]);
    put(w, i == 0 ? "" : ", ", v);
  }
  fprintf(w->f, "%s\n",
          m->law == CHABOCHE && !back ? ", 20."
          : m->law == CREEP_HYPERB    ? ", 0., 8.314"
                                      : "");
}

static void write_law(const writer *w, const deck_material *m) {
  if (m->law == NO_LAW) return;
  int trs = m->shift && m->law == VISCOELASTIC;
  fprintf(w->f, "%s", laws[m->law].card);
  if (m->law == NORTON && m->term[0][2] != 0) fprintf(w->f, ", HARDENING=TIME");
  if (m->shift && !trs)
    fprintf(w->f, ", SHIFT=WLF, T_REF=%.17g, C1=%.17g, C2=%.17g", m->t_ref,
            m->c1, m->c2);
  fprintf(w->f, "\n");
  for (int k = 0; k < m->n_term; ++k) write_term(w, m, k);
  if (trs) fprintf(w->f, "*TRS\n%.17g, %.17g, %.17g\n", m->t_ref, m->c1, m->c2);
}

static void write_materials(const writer *w) {
  for (int k = 0; k < w->d->n_material; ++k) {
    const deck_material *m = &w->d->material[k];
    fprintf(w->f, "*MATERIAL, NAME=M%d\n*ELASTIC\n", k);
    for (int i = 0; i < m->n_set; ++i) {
      fprintf(w->f, "%.17g, %.17g", stress(w, m->E[i]), m->nu[i]);
      if (m->n_set > 1) put(w, ", ", m->at[i]);
      fprintf(w->f, "\n");
    }
    fprintf(w->f, "*DENSITY\n%.17g\n", in(w, m->density, -4, 1, 2));
    if (m->alpha > 0)
      fprintf(w->f, "*EXPANSION, ZERO=%.17g\n%.17g\n", m->zero, m->alpha);
    write_law(w, m);
  }
}

static void write_sections(const writer *w) {
  static const char *const type[] = {"CPE3", "CPS3", "CAX3", "C3D4"};
  const random_deck *d = w->d;
  for (int g = 0; g < d->mesh.n_group; ++g) {
    if (d->material_of[g] < 0) continue;
    fprintf(w->f, "*SOLID SECTION, ELSET=%s, MATERIAL=M%d, TYPE=%s",
            d->mesh.group[g].name, d->material_of[g], type[d->kind]);
    if (d->kind < AXISYMMETRIC_)
      put(w, ", THICKNESS=", in(w, d->thickness, 1, 0, 0));
    fprintf(w->f, "%s\n", d->averaged ? ", FORMULATION=AVERAGED" : "");
  }
}

static void write_motion(const writer *w, const deck_obstacle *o) {
  int dim = w->d->mesh.dim, moves = 0, formula = o->motion == BY_FORMULA;
  double omega = in(w, o->omega, 0, 0, -1), move[3];
  if (o->motion == STANDS) return;
  for (int c = 0; c < dim; ++c) {
    moves |= o->move[c] != 0;
    move[axis(w, c)] = in(w, o->move[c], 1, 0, 0);
  }
  if (moves) fprintf(w->f, "MOVE");
  for (int c = 0; c < dim && moves; ++c) {
    double v = move[c];
    if (formula)
      fprintf(w->f, ", \"(%.17g)*sin(%.17g*t)\"", v, omega);
    else
      put(w, ", ", v);
  }
  if (moves) fprintf(w->f, "\n");
  if (o->angle == 0) return;
  const double angle = w->how->turned && dim == 2 ? -o->angle : o->angle;
  put_vector(w, "ROTATE, ", o->pivot, 1);
  if (dim == 3) put_vector(w, ", ", o->axis, 0);
  if (formula)
    fprintf(w->f, ", \"(%.17g)*sin(%.17g*t)\"\n", angle, omega);
  else
    fprintf(w->f, ", %.17g\n", angle);
}

static void write_obstacle(const writer *w, int k) {
  static const char *const type[] = {"CONFORMING", "PLANE", "CYLINDER",
                                     "SPHERE", "GAP"};
  const deck_obstacle *o = &w->d->contact[k].obstacle;
  fprintf(w->f, "*OBSTACLE, NAME=O%d, TYPE=%s", k, type[o->kind]);
  if (o->kind == CYLINDER || o->kind == SPHERE)
    put(w, ", RADIUS=", in(w, o->radius, 1, 0, 0));
  if (o->motion == BY_COURSE) fprintf(w->f, ", AMPLITUDE=A%d", o->course);
  fprintf(w->f, "\n");
  if (o->kind == GAP)
    fprintf(w->f, "\"%.17g + %.17g*(%c - (%.17g))^2\"\n",
            in(w, o->gap0, 1, 0, 0), in(w, o->gap2, -1, 0, 0), 'x' + axis(w, 0),
            in(w, o->gap_at, 1, 0, 0));
  if (o->kind == PLANE || o->kind == CYLINDER || o->kind == SPHERE) {
    put_vector(w, "", o->point, 1);
    fprintf(w->f, "\n");
  }
  if (o->kind == PLANE || (o->kind == CYLINDER && w->d->mesh.dim == 3)) {
    put_vector(w, "", o->direction, 0);
    fprintf(w->f, "\n");
  }
  write_motion(w, o);
}

static void write_contacts(const writer *w) {
  static const char *const normal[] = {"", ", NORMAL=BODY",
                                       ", NORMAL=OBSTACLE"};
  for (int k = 0; k < w->d->n_contact; ++k) {
    const deck_contact *c = &w->d->contact[k];
    write_obstacle(w, k);
    fprintf(w->f, "*CONTACT, NAME=C%d, GROUP=%s, OBSTACLE=O%d%s\n", k,
            w->d->mesh.group[c->group].name, k, normal[c->normal]);
    if (!c->given) continue;
    fprintf(w->f, "*CONTACT FORCE, CONTACT=C%d", k);
    if (c->course >= 0) fprintf(w->f, ", AMPLITUDE=A%d", c->course);
    fprintf(w->f, "\n");
    put_linear(w, &c->pressure, -2, 1);
    fprintf(w->f, "\n");
  }
}

static void write_average(const writer *w, const deck_friction *f) {
  static const char *const kernel[] = {"BUMP", "CONE", "PARABOLA", "WENDLAND",
                                       "CONSTANT"};
  fprintf(w->f, ", RADIUS=%.17g, KERNEL=%s%s%s%s", in(w, f->radius, 1, 0, 0),
          kernel[f->kernel], f->normalized ? ", EDGE=NORMALIZED" : "",
          f->zone ? ", ZONE=CONTACT" : "",
          f->geodesic ? ", DISTANCE=GEODESIC" : "");
  for (int c = 0; c < 3; ++c)
    if (f->mirror[c])
      fprintf(w->f, ", MIRROR_%c=%s", 'X' + axis(w, c),
              f->mirror[c] == 1 ? "MIN" : "MAX");
}

static void write_friction(const writer *w, int k, const deck_friction *f) {
  static const char *const law[] = {"NONE", "TRESCA", "COULOMB", "NONLOCAL"};
  double L = f->law == TRESCA ? -2 : 0, F = f->law == TRESCA;
  int in_time = f->table == 'T';
  fprintf(w->f, "*FRICTION, CONTACT=C%d, LAW=%s", k, law[f->law]);
  if (f->law == NONLOCAL) write_average(w, f);
  if (f->law == FRICTIONLESS) {
    fprintf(w->f, "\n");
    return;
  }
  if (f->table)
    fprintf(w->f, ", TABLE=%c", in_time ? 'T' : 'X' + axis(w, f->table - 'X'));
  if (f->course >= 0) fprintf(w->f, ", AMPLITUDE=A%d", f->course);
  fprintf(w->f, "\n");
  for (int i = 0; i < f->pairs.n; ++i)
    fprintf(w->f, "%.17g, %.17g\n", in(w, f->pairs.t[i], !in_time, 0, in_time),
            in(w, f->pairs.a[i], L, F, 0));
  if (f->table) return;
  put_linear(w, &f->value, L, F);
  fprintf(w->f, "\n");
}

/* ---- steps -------------------------------------------------------------- */

/* Group and what of it: the fields before the value. */
static void write_place(const writer *w, const deck_load *l) {
  static const char *const label[] = {"", "P", "T", "B", "GRAV", "", ""};
  int c = axis(w, l->component);
  fprintf(w->f, "%s, ", w->d->mesh.group[l->group].name);
  if (l->kind == FIX) fprintf(w->f, "%d, %d, ", c + 1, c + 1);
  if (l->kind == POINT) fprintf(w->f, "%d, ", c + 1);
  if (l->kind == TRACTION || l->kind == BODY_FORCE)
    fprintf(w->f, "%s%c, ", label[l->kind], 'X' + c);
  if (l->kind == PRESSURE || l->kind == GRAVITY)
    fprintf(w->f, "%s, ", label[l->kind]);
}

static void write_load(const writer *w, const deck_load *l) {
  static const char *const card[] = {"*BOUNDARY",   "*DSLOAD", "*DSLOAD",
                                     "*DLOAD",      "*DLOAD",  "*CLOAD",
                                     "*TEMPERATURE"};
  static const double unit[][2] = {{1, 0}, {-2, 1}, {-2, 1}, {-3, 1},
                                   {0, 0}, {0, 1},  {0, 0}};
  fprintf(w->f, "%s%s\n", card[l->kind], l->field ? ", FILE=field.msh" : "");
  write_place(w, l);
  if (l->kind == GRAVITY) {
    put(w, "", in(w, l->value.at0, 1, 0, -2));
    put_vector(w, ", ", l->direction, 0);
    if (l->course >= 0 && w->d->mesh.dim == 2) fprintf(w->f, ", ");
  } else {
    put_linear(w, &l->value, unit[l->kind][0], unit[l->kind][1]);
  }
  if (l->course >= 0) fprintf(w->f, ", A%d", l->course);
  fprintf(w->f, "\n");
}

static void write_head(const writer *w, const deck_step *s) {
  static const char *const card[] = {"*STATIC", "*QUASISTATIC", "*VISCO"};
  double dt = in(w, s->dt, 0, 0, 1), total = in(w, s->total, 0, 0, 1);
  fprintf(w->f, "*STEP\n%s%s", card[s->kind],
          s->velocity ? ", FORM=VELOCITY" : "");
  if (s->kind == IS_VISCO) {
    fprintf(w->f, ", INTEGRATOR=%s", s->integrator);
    if (s->theta > 0) put(w, ", THETA=", s->theta);
    if (s->tolerance > 0) put(w, ", TOLERANCE=", s->tolerance);
    if (s->substeps) fprintf(w->f, ", SUBSTEPS=AUTO");
    if (s->initial_tangent) fprintf(w->f, ", ITERATION=INITIAL");
  }
  if (s->kind == IS_STATIC)
    fprintf(w->f, "\n%.17g\n", total);
  else
    fprintf(w->f, "\n%.17g, %.17g\n", dt, total);
}

/* Of four in five decks errors of all kinds are estimated. */
static int has_goals(const random_deck *d) { return d->seed % 5 != 0; }

static void write_step(const writer *w, int i) {
  const random_deck *d = w->d;
  const deck_step *s = &d->step[i];
  write_head(w, s);
  for (int k = 0; k < s->n_load; ++k) write_load(w, &s->load[k]);
  for (int k = 0; k < d->n_contact && i > 0; ++k)
    if (s->has_friction[k]) write_friction(w, k, &s->friction[k]);
  if (has_goals(d)) fprintf(w->f, "*ACCURACY, MESH=YES, TIME=YES\n");
  if (i == 0)
    fprintf(w->f, "*SOLVER, METHOD=%s%s\n",
            w->how->method != NULL ? w->how->method : "AUTO",
            d->balanced ? ", TOL=BALANCED" : "");
  fprintf(w->f,
          "*PRINT, CONTACT, TOTALS, NODES, ELEMENTS, REACTIONS, ENERGY\n"
          "*OUTPUT, HDF5=NO\n*END STEP\n");
}

static void write_initial(const writer *w) {
  const random_deck *d = w->d;
  for (int g = 0; g < d->mesh.n_group; ++g) {
    if (d->material_of[g] < 0) continue;
    if (d->warm[d->mesh.group[g].body] != 0)
      fprintf(w->f, "*INITIAL CONDITIONS, TYPE=TEMPERATURE\n%s, %.17g\n",
              d->mesh.group[g].name, d->warm[d->mesh.group[g].body]);
  }
  if (!d->relax) return;
  fprintf(w->f, "*INITIAL CONDITIONS, TYPE=DISPLACEMENT, INCOMPATIBLE=RELAX\n");
  for (int g = 0; g < d->mesh.n_group; ++g)
    for (int c = 0; c < d->mesh.dim && d->material_of[g] >= 0; ++c)
      fprintf(w->f, "%s, %d, %.17g\n", d->mesh.group[g].name, axis(w, c) + 1,
              in(w, d->start[c], 1, 0, 0));
}

static void write_goals(const writer *w) {
  const random_deck *d = w->d;
  int of = 0;
  while (d->material_of[of] < 0) ++of;
  fprintf(w->f,
          "*GOAL, NAME=E, QUANTITY=ENERGY\n"
          "*GOAL, NAME=S, QUANTITY=STRESS, COMPONENT=%s, GROUP=%s\n",
          axis(w, 0) == 1 && axis(w, 1) == 2 ? "YZ" : "XY",
          d->mesh.group[of].name);
  if (d->n_contact == 0) return;
  fprintf(w->f,
          "*GOAL, NAME=U, QUANTITY=DISPLACEMENT, COMPONENT=%d, GROUP=%s\n"
          "*GOAL, NAME=N, QUANTITY=FORCE, CONTACT=C0\n"
          "*GOAL, NAME=T, QUANTITY=FORCE, CONTACT=C0, COMPONENT=%d\n"
          "*GOAL, NAME=P, QUANTITY=PRESSURE, CONTACT=C0\n"
          "*GOAL, NAME=W, QUANTITY=FRICTION WORK\n",
          axis(w, 0) + 1, d->mesh.group[d->contact[0].group].name,
          axis(w, 0) + 1);
}

static void write_deck(const writer *w) {
  const random_deck *d = w->d;
  fprintf(w->f, "** random deck %llu\n*MESH, FILE=deck.msh\n", d->seed);
  write_courses(w);
  write_materials(w);
  write_sections(w);
  write_contacts(w);
  for (int k = 0; k < d->n_contact; ++k)
    write_friction(w, k, &d->step[0].friction[k]);
  write_initial(w);
  if (has_goals(d)) write_goals(w);
  for (int i = 0; i < d->n_step; ++i) write_step(w, i);
}

int deck_axis(const deck_text *how, int dim, int c) {
  return how->turned && c < dim ? (c + 1) % dim : c;
}

static FILE *open_file(const job *j, const char *name) {
  char path[200];
  snprintf(path, sizeof path, "%s/%s", j->dir, name);
  FILE *f = fopen(path, "w");
  ck_assert_ptr_nonnull(f);
  return f;
}

void deck_write(const random_deck *d, const deck_text *how, const job *j) {
  char name[48];
  snprintf(name, sizeof name, "%s.inp", j->name);
  writer w = {.f = open_file(j, name), .d = d, .how = how};
  write_deck(&w);
  ck_assert_int_eq(fclose(w.f), 0);
  FILE *mesh = open_file(j, "deck.msh");
  deck_write_mesh(d, how, mesh);
  ck_assert_int_eq(fclose(mesh), 0);
  FILE *field = open_file(j, "field.msh");
  deck_write_field(d, how, field);
  ck_assert_int_eq(fclose(field), 0);
}
