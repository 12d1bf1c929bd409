/*
 * Elasticity matrices from engineering constants, the check of ellipticity
 * (CPR98 2.2) and the reductions to two dimensions.
 *
 * No square root and no constant with a dimension: scaling the moduli by a
 * power of two scales every entry exactly.
 */
#include "material/material.h"

#include "base/base.h"
#include "deck/deck.h"

/*
 * Constants of *ELASTIC over the temperature: read from the data lines, linear
 * between two temperatures, constant outside.
 */

enum { XX, YY, ZZ, XY, YZ, ZX };

/* A pivot below this part of its diagonal entry counts as zero. */
static const double pivot_limit = 1e-14;

/* C[i + 6 j] */
static double *entry(double *C, int i, int j) { return &C[i + 6 * j]; }

/* Schur complement: eliminate component p under the condition sigma_p = 0. */
static void eliminate(double C[36], int p) {
  const double pivot = C[7 * p];
  for (int j = 0; j < 6; ++j) {
    if (j == p) continue;
    const double factor = C[p + 6 * j] / pivot;
    for (int i = 0; i < 6; ++i)
      if (i != p) C[i + 6 * j] -= C[i + 6 * p] * factor;
  }
  for (int i = 0; i < 6; ++i) C[i + 6 * p] = C[p + 6 * i] = 0;
}

/* Order of the first leading block that is not positive definite, or 0. */
static int not_definite(const double C[36]) {
  double D[36];
  memcpy(D, C, sizeof D);
  for (int p = 0; p < 6; ++p) {
    if (!(C[7 * p] > 0 && D[7 * p] > pivot_limit * C[7 * p])) return p + 1;
    eliminate(D, p);
  }
  return 0;
}

static const char *isotropic(const double *c, double C[36], char *text,
                             size_t size) {
  const double E = c[0], nu = c[1];
  if (!(E > 0)) {
    snprintf(text, size, "E = %g is not positive", E);
    return text;
  }
  if (!(nu > -1 && nu < 0.5)) {
    snprintf(text, size, "nu = %g outside ]-1, 0.5[", nu);
    return text;
  }
  const double lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
  const double shear = E / (2 * (1 + nu));
  for (int i = XX; i <= ZZ; ++i) {
    for (int j = XX; j <= ZZ; ++j) *entry(C, i, j) = lambda;
    *entry(C, i, i) = lambda + 2 * shear;
    *entry(C, 3 + i, 3 + i) = shear;
  }
  return NULL;
}

/*
 * E1 E2 E3 nu12 nu13 nu23 G12 G13 G23 with e_22 = -nu12/E1 sigma_11 and so on.
 * The 3x3 compliance is inverted by its cofactors; with
 *   a = 1 - nu23 nu32, b = 1 - nu13 nu31, c = 1 - nu12 nu21,
 *   d = 1 - nu12 nu21 - nu23 nu32 - nu31 nu13 - 2 nu21 nu32 nu13.
 */
static const char *orthotropic(const double *k, double C[36], char *text,
                               size_t size) {
  static const char *const names[] = {"E1",   "E2",  "E3",  "nu12", "nu13",
                                      "nu23", "G12", "G13", "G23"};
  static const int first[] = {0, 0, 1}, second[] = {1, 2, 2};
  for (int i = 0; i < 9; ++i)
    if ((i < 3 || i > 5) && !(k[i] > 0)) {
      snprintf(text, size, "%s = %g is not positive", names[i], k[i]);
      return text;
    }
  double back[3], product[3]; /* nu21, nu31, nu32 and nu12 nu21, ... */
  for (int i = 0; i < 3; ++i) {
    back[i] = k[3 + i] * (k[second[i]] / k[first[i]]);
    product[i] = k[3 + i] * back[i];
    if (!(product[i] < 1)) {
      snprintf(text, size, "%s = %g: the magnitude must be below sqrt(%s/%s)",
               names[3 + i], k[3 + i], names[first[i]], names[second[i]]);
      return text;
    }
  }
  const double nu12 = k[3], nu13 = k[4], nu23 = k[5];
  const double nu21 = back[0], nu31 = back[1], nu32 = back[2];
  const double d =
      1 - product[0] - product[1] - product[2] - 2 * nu21 * nu32 * nu13;
  if (!(d > 0)) {
    snprintf(text, size,
             "1 - nu12 nu21 - nu23 nu32 - nu31 nu13 - 2 nu21 nu32 nu13 = %g "
             "is not positive",
             d);
    return text;
  }
  *entry(C, XX, XX) = k[0] * (1 - product[2]) / d;
  *entry(C, YY, YY) = k[1] * (1 - product[1]) / d;
  *entry(C, ZZ, ZZ) = k[2] * (1 - product[0]) / d;
  *entry(C, XX, YY) = *entry(C, YY, XX) = k[0] * (nu21 + nu31 * nu23) / d;
  *entry(C, XX, ZZ) = *entry(C, ZZ, XX) = k[0] * (nu31 + nu21 * nu32) / d;
  *entry(C, YY, ZZ) = *entry(C, ZZ, YY) = k[1] * (nu32 + nu12 * nu31) / d;
  *entry(C, XY, XY) = k[6];
  *entry(C, ZX, ZX) = k[7];
  *entry(C, YZ, YZ) = k[8];
  return NULL;
}

/* Columns of the upper triangle in the order 11 22 33 12 13 23:
 * D1111, D1122, D2222, D1133, D2233, D3333, D1112, ..., D2323. */
static void anisotropic(const double *k, double C[36]) {
  static const int at[6] = {XX, YY, ZZ, XY, ZX, YZ};
  for (int j = 0; j < 6; ++j)
    for (int i = 0; i <= j; ++i)
      *entry(C, at[i], at[j]) = *entry(C, at[j], at[i]) = *k++;
}

const char *elastic_matrix(elastic_type type, int n, const double *constants,
                           double C[36], char *text, int text_size) {
  static const int expected[] = {2, 9, 21};
  const size_t size = text_size;
  const char *wrong = NULL;
  memset(C, 0, 36 * sizeof *C);
  if (n != expected[type]) {
    snprintf(text, size, "%d constants, %d expected", n, expected[type]);
    return text;
  }
  for (int i = 0; i < n; ++i)
    if (!isfinite(constants[i])) {
      snprintf(text, size, "constant %d is not a finite number", i + 1);
      return text;
    }
  if (type == ELASTIC_ISO) wrong = isotropic(constants, C, text, size);
  if (type == ELASTIC_ORTHO) wrong = orthotropic(constants, C, text, size);
  if (type == ELASTIC_ANISO) anisotropic(constants, C);
  if (wrong != NULL) return wrong;
  const int order = not_definite(C);
  if (order == 0) return NULL;
  snprintf(text, size,
           "the elasticity matrix is not positive definite (leading block of "
           "order %d, components xx yy zz xy yz zx)",
           order);
  return text;
}

void elastic_reduce(const double C[36], kinematics kin, double *E) {
  static const int plane[4] = {XX, YY, ZZ, XY};
  double D[36];
  memcpy(D, C, sizeof D);
  if (kin == SOLID_3D) {
    memcpy(E, C, sizeof D);
    return;
  }
  if (kin == PLANE_STRESS) {
    eliminate(D, YZ);
    eliminate(D, ZX);
    eliminate(D, ZZ);
  }
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) E[i + 4 * j] = D[plane[i] + 6 * plane[j]];
}

void elastic_zz_strain(const double C[36], double e[4]) {
  double D[36];
  memcpy(D, C, sizeof D);
  eliminate(D, YZ);
  eliminate(D, ZX);
  e[2] =
      -(D[ZZ + 6 * XX] * e[0] + D[ZZ + 6 * YY] * e[1] + D[ZZ + 6 * XY] * e[3]) /
      D[7 * ZZ];
}

/*
 * Thermal strain from a table of secant coefficients, as Abaqus defines it:
 *   e = alpha(T) (T - zero) - alpha(T0) (T0 - zero)
 * so that the body at its initial temperature T0 has none, whatever "zero".
 */

/* Number of constants of each elastic_type. */
static const int constants_of[] = {2, 9, 21};

/* Reading the lines of a card. */
typedef struct lines {
  const card *c;
  message_log *log;
  elastic_table *table;
  double set[ELASTIC_MAX + 1]; /* of the current set */
  int n;                       /* in it */
  int has_temperature;         /* the first set ends with one; all do, then */
  int capacity;                /* of the table */
  int wrong;                   /* an error is in the log */
} lines;

static void count_error(lines *r, const place *at, const char *found) {
  message_add(r->log, P2009, at, "*ELASTIC: %d constants expected%s, %s",
              r->table->n_constant,
              r->has_temperature ? " and a temperature" : "", found);
  r->wrong = 1;
}

/* One set is whole: its constants and temperature into the table. */
static status close_set(lines *r, const place *at) {
  elastic_table *t = r->table;
  const int n = t->n_constant, has = r->n == n + 1;
  const double T = has ? r->set[n] : 0.0;
  if (t->n == 0) r->has_temperature = has;
  if (has != r->has_temperature || (t->n > 0 && !has)) {
    count_error(r, at,
                "more found: several sets each end with their temperature");
    return OK;
  }
  if (t->n > 0 && !(T > t->set[t->n - 1].temperature)) {
    message_add(r->log, P2029, at,
                "*ELASTIC: the temperatures must ascend, but %.15g follows "
                "%.15g",
                T, t->set[t->n - 1].temperature);
    r->wrong = 1;
    return OK;
  }
  PASS_GROW(t->set, t->n, r->capacity);
  memcpy(t->set[t->n].constant, r->set, n * sizeof *r->set);
  t->set[t->n++].temperature = T;
  r->n = 0;
  return OK;
}

/* A line goes on with the current set; one that fills it ends it. */
static status add_line(lines *r, const record *line) {
  const int n = r->table->n_constant;
  for (int k = 0; k < line->n_field && !r->wrong; ++k) {
    const field *f = &line->fields[k];
    if (r->n == n + 1)
      count_error(r, &f->at, "more found: a set begins on a line of its own");
    else
      r->wrong |= deck_real(f, r->log, &r->set[r->n++]) != 0;
  }
  if (!r->wrong && r->n >= n) PASS(close_set(r, &line->at));
  return OK;
}

/* Every set alone is an elasticity. */
static void check_sets(lines *r, const char *material_name) {
  double C[36];
  char text[256];
  const elastic_table *t = r->table;
  for (int i = 0; i < t->n; ++i) {
    const char *wrong = elastic_matrix(
        t->type, t->n_constant, t->set[i].constant, C, text, (int)sizeof text);
    if (wrong == NULL) continue;
    message_add(r->log, P2013, &r->c->records[0].at, "material %s: %s",
                material_name, wrong);
    return;
  }
}

status elastic_table_read(const card *c, elastic_type type,
                          const char *material_name, message_log *log,
                          elastic_table *table) {
  lines r = {.c = c, .log = log, .table = table};
  table->type = type;
  table->n_constant = constants_of[type];
  for (int i = 0; i < c->n_record && !r.wrong; ++i)
    PASS(add_line(&r, &c->records[i]));
  if (!r.wrong && r.n > 0)
    count_error(&r, table->n == 0 ? &c->at : &c->records[c->n_record - 1].at,
                text_of("%d found", r.n));
  if (r.wrong) {
    memory_free(table->set);
    *table = (elastic_table){0};
  } else {
    check_sets(&r, material_name);
  }
  return OK;
}

/* E, nu of G/(1 - relaxed[0]), K/(1 - relaxed[1]). */
static void make_whole(const double relaxed[2], double *constant) {
  const double E = constant[0], nu = constant[1];
  const double G = E / (2 * (1 + nu)) / (1 - relaxed[0]);
  const double K = E / (3 * (1 - 2 * nu)) / (1 - relaxed[1]);
  constant[0] = 9 * K * G / (3 * K + G);
  constant[1] = (3 * K - 2 * G) / (2 * (3 * K + G));
}

/* What is given is linear between the sets, so that they stay as they are. */
void elastic_table_relaxed(elastic_table *t, const double relaxed[2]) {
  if (t->n == 1)
    make_whole(relaxed, t->set[0].constant);
  else
    memcpy(t->relaxed, relaxed, sizeof t->relaxed);
}

const char *elastic_at(const elastic_table *t, double T, double C[36],
                       char *text, int text_size) {
  double constant[ELASTIC_MAX];
  int k = 0;
  while (k + 1 < t->n && T >= t->set[k + 1].temperature) ++k;
  const elastic_constants *low = &t->set[k];
  memcpy(constant, low->constant, sizeof constant);
  if (k + 1 < t->n && T > low->temperature) {
    const elastic_constants *high = &t->set[k + 1];
    const double part =
        (T - low->temperature) / (high->temperature - low->temperature);
    for (int i = 0; i < t->n_constant; ++i)
      constant[i] += part * (high->constant[i] - low->constant[i]);
  }
  if (t->relaxed[0] > 0 || t->relaxed[1] > 0) make_whole(t->relaxed, constant);
  return elastic_matrix(t->type, t->n_constant, constant, C, text, text_size);
}

double elastic_table_most(const elastic_table *t, int i) {
  double most = -HUGE_VAL;
  for (int k = 0; k < t->n; ++k) {
    double constant[ELASTIC_MAX];
    memcpy(constant, t->set[k].constant, sizeof constant);
    if (t->relaxed[0] > 0 || t->relaxed[1] > 0)
      make_whole(t->relaxed, constant);
    most = fmax(most, constant[i]);
  }
  return most;
}

/* The tables of deck/expression.h know the temperature as their variable t. */
static double secant(const value_table *alpha, double T) {
  static const double origin[3];
  return table_value(alpha, origin, T);
}

void expansion_strain(const expansion *x, double T, double T0, double e[3]) {
  for (int c = 0; c < 3; ++c) {
    const value_table *alpha = &x->alpha[x->type == EXPANSION_ORTHO ? c : 0];
    e[c] =
        secant(alpha, T) * (T - x->zero) - secant(alpha, T0) * (T0 - x->zero);
  }
}
