#include "support/fclib_file.h"

#include "support/unit.h"

hid_t fclib_begin(const char *path) {
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  ck_assert(file >= 0);
  return file;
}

void fclib_end(hid_t file) { ck_assert(H5Fclose(file) >= 0); }

static void put(hid_t file, const char *name, hid_t type, int n,
                const void *value) {
  hsize_t size = (hsize_t)n;
  hid_t links = H5Pcreate(H5P_LINK_CREATE);
  H5Pset_create_intermediate_group(links, 1);
  hid_t space = H5Screate_simple(1, &size, NULL);
  hid_t set =
      H5Dcreate2(file, name, type, space, links, H5P_DEFAULT, H5P_DEFAULT);
  ck_assert_msg(set >= 0, "%s", name);
  if (n > 0)
    ck_assert(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, value) >= 0);
  H5Dclose(set);
  H5Sclose(space);
  H5Pclose(links);
}

void fclib_ints(hid_t file, const char *name, int n, const int *value) {
  put(file, name, H5T_NATIVE_INT, n, value);
}

void fclib_int(hid_t file, const char *name, int value) {
  fclib_ints(file, name, 1, &value);
}

void fclib_reals(hid_t file, const char *name, int n, const double *value) {
  put(file, name, H5T_NATIVE_DOUBLE, n, value);
}

static const char *item(char *text, const char *group, const char *name) {
  sprintf(text, "%s/%s", group, name);
  return text;
}

typedef struct lists {
  int n;
  int *p, *i, *start; /* lines written out, indices, starts of the lines      */
  double *x;
} lists;

/* Nonzero entries line by line: columns, or rows. */
static lists collect(int rows, int columns, const double *a, int by_rows) {
  lists l = {0};
  size_t room = (size_t)(rows * columns + 1);
  int lines = by_rows ? rows : columns, across = by_rows ? columns : rows;
  l.p = calloc(room, sizeof *l.p);
  l.i = calloc(room, sizeof *l.i);
  l.x = calloc(room, sizeof *l.x);
  l.start = calloc((size_t)lines + 1, sizeof *l.start);
  for (int p = 0; p < lines; ++p) {
    for (int i = 0; i < across; ++i) {
      double value = by_rows ? a[p + rows * i] : a[i + rows * p];
      if (value == 0.0) continue;
      l.p[l.n] = p;
      l.i[l.n] = i;
      l.x[l.n++] = value;
    }
    l.start[p + 1] = l.n;
  }
  return l;
}

static void make_triplets(lists *l) {
  for (int a = 0, b = l->n - 1; a < b; ++a, --b) {
    int p = l->p[a], i = l->i[a];
    double x = l->x[a];
    l->p[a] = l->p[b], l->i[a] = l->i[b], l->x[a] = l->x[b];
    l->p[b] = p, l->i[b] = i, l->x[b] = x;
  }
  if (l->n == 0) return;
  l->x[0] *= 0.5;
  l->p[l->n] = l->p[0];
  l->i[l->n] = l->i[0];
  l->x[l->n++] = l->x[0];
}

void fclib_matrix(hid_t file, const char *group, int store, int rows,
                  int columns, const double *a) {
  char name[200];
  lists l = collect(rows, columns, a, store == STORE_ROWS);
  int triplet = store == STORE_TRIPLET;
  if (triplet) make_triplets(&l);
  int lines = store == STORE_ROWS ? rows : columns;
  fclib_int(file, item(name, group, "nzmax"), l.n + 7 * triplet);
  fclib_int(file, item(name, group, "m"), rows);
  fclib_int(file, item(name, group, "n"), columns);
  fclib_int(file, item(name, group, "nz"), triplet ? l.n : store);
  fclib_ints(file, item(name, group, "p"), triplet ? l.n : lines + 1,
             triplet ? l.p : l.start);
  fclib_ints(file, item(name, group, "i"), l.n, l.i);
  fclib_reals(file, item(name, group, "x"), l.n, l.x);
  free(l.p);
  free(l.i);
  free(l.x);
  free(l.start);
}

void fclib_local(const char *path, int store, int dim, int n, const double *W,
                 const double *q, const double *mu) {
  hid_t file = fclib_begin(path);
  fclib_int(file, "/fclib_local/spacedim", dim);
  fclib_matrix(file, "/fclib_local/W", store, dim * n, dim * n, W);
  fclib_reals(file, "/fclib_local/vectors/q", dim * n, q);
  fclib_reals(file, "/fclib_local/vectors/mu", n, mu);
  fclib_end(file);
}

void fclib_global(const char *path, int store, const fclib_global_data *g) {
  hid_t file = fclib_begin(path);
  int m = g->dim * g->n;
  fclib_int(file, "/fclib_global/spacedim", g->dim);
  fclib_matrix(file, "/fclib_global/M", store, g->n_v, g->n_v, g->M);
  fclib_matrix(file, "/fclib_global/H", store, g->n_v, m, g->H);
  fclib_reals(file, "/fclib_global/vectors/f", g->n_v, g->f);
  fclib_reals(file, "/fclib_global/vectors/w", m, g->w);
  fclib_reals(file, "/fclib_global/vectors/mu", g->n, g->mu);
  fclib_end(file);
}

double *fclib_take(const char *path, const char *name, int *n) {
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  *n = 0;
  hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0) return NULL;
  double *value = NULL;
  hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
  if (set >= 0) {
    hid_t space = H5Dget_space(set);
    *n = (int)H5Sget_simple_extent_npoints(space);
    value = calloc((size_t)*n + 1, sizeof *value);
    ck_assert(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                      value) >= 0);
    H5Sclose(space);
    H5Dclose(set);
  }
  H5Fclose(file);
  return value;
}

/* Miss of one contact; forces times c have the unit of displacements. */
static double contact_miss(int dim, double mu, double c, const double *u,
                           const double *r) {
  double r_t = dim == 3 ? hypot(r[1], r[2]) : fabs(r[1]);
  double u_t = dim == 3 ? hypot(u[1], u[2]) : fabs(u[1]);
  double miss = fmax(-u[0], -c * r[0]);
  miss = fmax(miss, fmin(fabs(u[0]), fabs(c * r[0])));
  miss = fmax(miss, c * (r_t - mu * r[0]));
  if (!(u_t > 0.0)) return miss;
  /* Slip takes the whole force, against its direction: no slip, the force of
   * the slip, or the slip turned to a force at its limit, whatever is nearest.
   */
  double force = 0.0, turn = r_t > 0.0 ? 0.0 : HUGE_VAL;
  for (int k = 1; k < dim; ++k) {
    force = fmax(force, c * fabs(r[k] + mu * r[0] * u[k] / u_t));
    if (r_t > 0.0) turn = fmax(turn, fabs(u[k] + u_t * r[k] / r_t));
  }
  turn = fmax(turn, c * fabs(mu * r[0] - r_t));
  miss = fmax(miss, fmin(u_t, fmin(force, turn)));
  return miss;
}

double fclib_violation(int dim, int n, const double *W, const double *q,
                       const double *mu, const double *u, const double *r) {
  int m = dim * n;
  double scale = 0.0, c = 0.0, worst = 0.0;
  for (int k = 0; k < m; ++k) scale = fmax(scale, fabs(q[k]));
  for (int k = 0; k < m * m; ++k) c = fmax(c, fabs(W[k]));
  for (int i = 0; i < m; ++i) {
    double sum = q[i] - u[i];
    for (int j = 0; j < m; ++j) sum += W[i + m * j] * r[j];
    worst = fmax(worst, fabs(sum));
    if (!isfinite(u[i]) || !isfinite(r[i])) return HUGE_VAL;
  }
  for (int i = 0; i < n; ++i)
    worst = fmax(worst, contact_miss(dim, mu[i], c, u + dim * i, r + dim * i));
  return scale > 0.0 ? worst / scale : worst;
}
