/*
 * A body whose elasticity couples all components, and the same with its axes in
 * another order and direction and in other units: all tables of both, component
 * by component.
 */
#include "scenes/mesh.h"
#include "support/job.h"
#include "support/unit.h"

#include <ctype.h>

const int job_without_fields = 1;

/* Axis i is axis to[i] of the turned scene, in the direction sign[i]; numbers
 * of a length and of a force are so many powers of two larger there. */
typedef struct turning {
  int to[3], sign[3], length, force;
} turning;

typedef struct scene {
  const char *mesh, *section;
  int dim, creeps;
  turning turned;
} scene;

static const turning still = {{0, 1, 2}, {1, 1, 1}, 0, 0};

/* What axis i has become: "y", and "(-8*y)" for its coordinate. */
static char axis_of(const turning *t, int i) { return (char)('x' + t->to[i]); }
static const char *place_of(const turning *t, int i) {
  static char text[12][40];
  static int k;
  char *to = text[k++ % 12];
  sprintf(to, "(%.17g*%c)", ldexp(t->sign[i], -t->length), axis_of(t, i));
  return to;
}

/* A number of that many powers of the units. */
static double in_units(const turning *t, double x, int lengths, int forces) {
  return ldexp(x, lengths * t->length + forces * t->force);
}

static const int pairs[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}};

/* The component xx yy zz xy yz zx of the turned scene, and its sign. */
static int tensor_of(const turning *t, int k, int *sign) {
  const int a = t->to[pairs[k][0]], b = t->to[pairs[k][1]];
  int of = 0;
  *sign = t->sign[pairs[k][0]] * t->sign[pairs[k][1]];
  while (!((pairs[of][0] == a && pairs[of][1] == b) ||
           (pairs[of][0] == b && pairs[of][1] == a)))
    ++of;
  return of;
}

/* The 21 constants in the order of *ELASTIC, 11 22 33 12 13 23. */
static void write_elastic(const turning *t, char *text) {
  static const double C[6][6] = {{110, 42, 38, 9, -4, 6}, {0, 90, 35, -5, 7, 3},
                                 {0, 0, 130, 4, 2, -8},   {0, 0, 0, 31, 5, -3},
                                 {0, 0, 0, 0, 37, 4},     {0, 0, 0, 0, 0, 43}};
  static const int order[] = {0, 1, 2, 3, 5, 4};
  double turned[6][6];
  int n = 0, sign[2];
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) {
      const int a = tensor_of(t, i, &sign[0]), b = tensor_of(t, j, &sign[1]);
      turned[a][b] = turned[b][a] = sign[0] * sign[1] * C[i][j];
    }
  for (int j = 0; j < 6; ++j)
    for (int i = 0; i <= j; ++i, ++n)
      text += sprintf(text, "%.17g%s",
                      in_units(t, turned[order[i]][order[j]], -2, 1),
                      n == 20      ? "\n"
                      : n % 7 == 6 ? ",\n"
                                   : ", ");
}

/* Of a length. */
static void write_vector(const turning *t, int dim, const double *v,
                         char *text) {
  double turned[3] = {0};
  for (int i = 0; i < dim; ++i)
    turned[t->to[i]] = in_units(t, t->sign[i] * v[i], 1, 0);
  for (int i = 0; i < dim; ++i)
    text += sprintf(text, "%s%.17g", i > 0 ? ", " : "", turned[i]);
}

/* The lines of nodes with their coordinates turned; all edges are oblique. */
static void write_mesh(const job *j, const scene *s, const turning *t) {
  const mesh_change bent = {.map = {"x+0.1*y*y", "y*(1+0.2*x)+0.05*z*x",
                                    s->dim == 3 ? "z*(1+0.1*x*y)" : NULL}};
  char line[300];
  int *number = NULL, no;
  double x[3];
  PRINTED(path, "%s/turned.msh", j->dir);
  FILE *from = tmpfile(), *to = fopen(path, "w");
  ck_assert(from != NULL && to != NULL);
  ck_assert(scene_mesh_write(from, s->mesh, &bent, &number));
  rewind(from);
  for (int nodes = 0; fgets(line, sizeof line, from) != NULL;) {
    if (line[0] == '$') nodes = strcmp(line, "$Nodes\n") == 0;
    if (nodes &&
        sscanf(line, "%d %lf %lf %lf", &no, &x[0], &x[1], &x[2]) == 4) {
      char turned[120];
      write_vector(t, 3, x, turned);
      for (char *c = turned; (c = strchr(c, ',')) != NULL;) *c = ' ';
      snprintf(line, sizeof line, "%d %s\n", no, turned);
    }
    fputs(line, to);
  }
  fclose(from);
  fclose(to);
  free(number);
}

/* Goals of each component; their numbers, of a vector and of a tensor. */
static void write_goals(const scene *s, const turning *t, char *text) {
  static const char *const words[] = {"XX", "YY", "ZZ", "XY", "YZ", "ZX"};
  int sign;
  text += sprintf(text, "*GOAL, NAME=E, QUANTITY=ENERGY\n");
  for (int i = 0; i < s->dim; ++i)
    text += sprintf(text,
                    "*GOAL, NAME=U%d, QUANTITY=DISPLACEMENT, COMPONENT=%d, "
                    "GROUP=RIGHT\n"
                    "*GOAL, NAME=F%d, QUANTITY=FORCE, COMPONENT=%d, CONTACT=C"
                    "\n",
                    i, t->to[i] + 1, i, t->to[i] + 1);
  for (int k = 0; k < 6; ++k)
    if (s->dim == 3 || k < 2 || k == 3)
      text += sprintf(text,
                      "*GOAL, NAME=S%d, QUANTITY=STRESS, COMPONENT=%s, "
                      "GROUP=BODY\n",
                      k, words[tensor_of(t, k, &sign)]);
}

static job run(const scene *s, const turning *t) {
  const int solid = s->dim == 3;
  const double point[] = {0.5, solid ? 0.4 : -0.01, -0.01};
  const double up[] = {0.1, solid ? -0.2 : 1, 1};
  const double shift[] = {0.06, solid ? 0.05 : -0.04, -0.04};
  char elastic[900], goals[2000] = "", at[120], normal[120], law[90] = "",
                     tops[500] = "";
  job j = job_begin("turned");
  write_mesh(&j, s, t);
  write_elastic(t, elastic);
  write_vector(t, s->dim, point, at);
  write_vector(t, s->dim, up, normal);
  if (!s->creeps) write_goals(s, t, goals);
  for (int i = 0; i < s->dim; ++i)
    sprintf(strchr(tops, '\0'), "TOP, %d, %d, \"%.17g*(1+0.5*%s)\"\n",
            t->to[i] + 1, t->to[i] + 1,
            in_units(t, t->sign[i] * shift[i], 1, 0), place_of(t, 0));
  if (s->creeps)
    sprintf(law, "*INELASTIC, LAW=NORTON\n%.17g, 2.\n",
            in_units(t, 1e-4, 4, -2));
  const double alpha[] = {1e-3, 2e-3, 4e-3};
  double along[3];
  for (int i = 0; i < 3; ++i) along[t->to[i]] = alpha[i];
  job_write(
      &j, "turned.inp",
      "*MESH, FILE=turned.msh\n*MATERIAL, NAME=M\n*ELASTIC, TYPE=ANISO\n%s"
      "*EXPANSION, TYPE=ORTHO\n%g, %g, %g\n%s"
      "*SOLID SECTION, ELSET=BODY, MATERIAL=M%s, THICKNESS=%.17g\n"
      "*OBSTACLE, NAME=O, TYPE=PLANE\n%s\n%s\n"
      "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
      "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n%s"
      "*STEP\n*%s\n0.5, 1.\n*BOUNDARY\n%s*DLOAD\nBODY, B%c, %.17g\n"
      "*DSLOAD\nRIGHT, P, \"%.17g*(1+%s)\"\nRIGHT, T%c, \"%.17g*%s\"\n"
      "*TEMPERATURE\nBODY, \"5*%s+4*%s-3*%s*%s\"\n"
      "*SOLVER, TOL=1E-13\n*ACCURACY, MESH=YES\n"
      "*PRINT, CONTACT, TOTALS, NODES, ELEMENTS, REACTIONS, ENERGY%s\n"
      "*END STEP\n",
      elastic, along[0], along[1], along[2], law, s->section,
      in_units(t, 1, 1, 0), at, normal, goals,
      s->creeps ? "VISCO, INTEGRATOR=EULER" : "QUASISTATIC", tops,
      toupper(axis_of(t, 0)), in_units(t, -3 * t->sign[0], -3, 1),
      in_units(t, 1, -2, 1), place_of(t, 1), toupper(axis_of(t, 1)),
      in_units(t, -2 * t->sign[1], -2, 1), place_of(t, 0), place_of(t, 0),
      place_of(t, 1), place_of(t, 0), place_of(t, s->dim - 1),
      s->creeps ? "" : ", GOALS");
  CK_EXIT(job_run(&j, ""), 0, j);
  return j;
}

/* The column of the turned scene of one that ends in letters of axes; 0: it
 * hangs on the choice of tangents, or is rounding. */
static int column_of(const turning *t, const char *name, char *turned,
                     int *sign) {
  static const char *const skipped[] = {"_t",     "tangential", "dir_",
                                        "defect", "solver",     "slip_"};
  const char *end = strrchr(name, '_');
  const int n = (int)strlen(end != NULL ? ++end : (end = name));
  const int first = end[0] - 'x', second = end[1] - 'x';
  *sign = 1;
  strcpy(turned, name);
  char *to = turned + (end - name);
  for (size_t i = 0; i < sizeof skipped / sizeof *skipped; ++i)
    if (strstr(name, skipped[i]) != NULL) return 0;
  if (n == 1 && first >= 0 && first < 3) {
    *sign = t->sign[first];
    to[0] = axis_of(t, first);
    return 1;
  }
  for (int k = 0; n == 2 && k < 6; ++k)
    if (first == pairs[k][0] && second == pairs[k][1]) {
      const int of = tensor_of(t, k, sign);
      to[0] = (char)('x' + pairs[of][0]);
      to[1] = (char)('x' + pairs[of][1]);
    }
  return 1;
}

/* The unit of a column as the powers of two of the turned scene: its factors
 * are words, numbers and exponents. */
static int unit_of(const turning *t, const char *dat_text, const char *table,
                   const char *name) {
  char key[60];
  int sum = 0, side = 1;
  snprintf(key, sizeof key, " table %s", table);
  const char *at = strstr(dat_text, key);
  ck_assert_ptr_nonnull(at);
  snprintf(key, sizeof key, " %s[", name);
  at = strstr(at, key);
  ck_assert_msg(at != NULL, "%s: no %s", table, name);
  for (at += strlen(key); *at != ']' && strcmp(table, "GOALS") != 0; ++at) {
    const int of = strncmp(at, "length", 6) == 0  ? t->length
                   : strncmp(at, "force", 5) == 0 ? t->force
                                                  : 0;
    if (*at == '/') side = -1;
    if (of == 0) continue;
    at += strcspn(at, "*/^]");
    sum += side * of * (*at == '^' ? at[1] - '0' : 1);
    if (*at != '^') --at;
  }
  return sum;
}

static void compare_columns(const dat *a, const dat *b, const scene *s,
                            const char *text, const char *table) {
  const double exact = strcmp(table, "GOALS") == 0 ? 1e-7 : 1e-9;
  ck_assert(a->n_row == b->n_row && a->n_col == b->n_col && a->n_row > 0);
  for (int c = 0; c < a->n_col; ++c) {
    char turned[32];
    int sign;
    if (!column_of(&s->turned, a->name[c], turned, &sign)) continue;
    const int unit = unit_of(&s->turned, text, table, a->name[c]);
    const double most = dat_max(a, a->name[c]);
    for (int i = 0; i < a->n_row; ++i) {
      const double is = dat_at(a, i, a->name[c]);
      const double found = ldexp(sign * dat_at(b, i, turned), -unit);
      ck_assert_msg(isnan(is) || fabs(found - is) <= exact * most,
                    "%s, row %d: %s %.12g, but %s %.12g", table, i, a->name[c],
                    is, turned, found);
    }
  }
}

/* Goals are signed as their components and have units of their own. */
static void compare_goals(const dat *a, dat *b, const scene *s,
                          const char *text) {
  static const char *const columns[] = {"value", "error", "corrected", "band"};
  const int length = s->turned.length, force = s->turned.force;
  for (int i = 0; i < b->n_row; ++i) {
    int sign = 1, k = i - 1 - 2 * s->dim;
    if (i > 0 && k < 0) sign = s->turned.sign[(i - 1) / 2];
    if (k >= 0) tensor_of(&s->turned, s->dim == 2 && k == 2 ? 3 : k, &sign);
    const int unit = i == 0   ? force + length
                     : k >= 0 ? force - 2 * length
                     : i % 2  ? length
                              : force;
    for (size_t c = 0; c < 4; ++c) {
      double *to = &b->value[b->n_col * i + dat_column(b, columns[c])];
      *to = ldexp(c < 3 ? sign * *to : *to, -unit);
    }
  }
  compare_columns(a, b, s, text, "GOALS");
}

#define RECT "rect 5 3 1 0.7 alternate"
static const scene scenes[] = {
    {"box 3 2 2 1 0.7 0.8", "", 3, 0, {{1, 2, 0}, {-1, 1, -1}, -17, 9}},
    {"box 2 2 2 1 0.7 0.8",
     ", FORMULATION=AVERAGED",
     3,
     1,
     {{2, 0, 1}, {1, -1, -1}, 13, -8}},
    {RECT, ", TYPE=CPE3", 2, 0, {{1, 0, 2}, {1, -1, 1}, -14, 21}},
    {RECT, ", TYPE=CPS3", 2, 1, {{1, 0, 2}, {-1, 1, 1}, 18, 6}}};

TESTS(axes_have_no_order, sizeof scenes / sizeof *scenes) {
  static const char *const tables[] = {"CONTACT",  "TOTALS",    "NODES",
                                       "ELEMENTS", "REACTIONS", "ENERGY"};
  const scene *s = &scenes[_i];
  JOB a = run(s, &still), b = run(s, &s->turned);
  FREED char *text = job_file(&a, "dat");
  for (size_t k = 0; k < sizeof tables / sizeof *tables; ++k) {
    dat of[2] = {job_table(&a, tables[k], -1), job_table(&b, tables[k], -1)};
    compare_columns(&of[0], &of[1], s, text, tables[k]);
    for (int i = 0; i < 2; ++i) dat_free(&of[i]);
  }
  if (!s->creeps) {
    dat of[2] = {job_table(&a, "GOALS", -1), job_table(&b, "GOALS", -1)};
    compare_goals(&of[0], &of[1], s, text);
    for (int i = 0; i < 2; ++i) dat_free(&of[i]);
  }
}

UNIT_MAIN_FOR("turned", 10 * UNIT_SECONDS)
