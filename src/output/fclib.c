/*
 * JOB_condensed_NNNNN.h5: the condensed problem of an increment in the layout
 * of FCLIB (exchange.h), one problem a file, NNNNN the increments since the
 * start.
 *
 *   /fclib_local    W = S inv(A) S, q = S inv(A) f + d;  S = diag(-1, 1[, 1])
 *                   per node, d_N = gap, d_T = -ut0
 *   /fclib_global   where A is singular (contact alone holds a body): M = A,
 *                   H = S, f, w = d; v is the displacement
 *   /solution       u, r [, v] if the increment reached its tolerance
 *   /node_no        of the contacts; not of the layout, whose readers skip it
 *
 * Only Coulomb friction of each node by itself fits this layout. A prescribed
 * tangential unknown has no force and no motion: q_T = 0 there.
 */
#include "base/archive/dataset.h"
#include "base/file.h"
#include "output/writers.h"

#include <errno.h>
#include <lapacke.h>
#include <unistd.h>

enum { TRIPLETS = 0, BY_ROW = -2 };

/* What is written; arrays owned. */
typedef struct written {
  const contact_problem *cp;
  const size_t *node_no; /* [n] or NULL */
  const char *path;
  hid_t file;
  int local;
  double *M;        /* [m*m] W or A, by rows, in the signs of FCLIB */
  double *q, *mu;   /* [m], [n] */
  int *start, *col; /* indices of the matrix */
  double *u, *r;    /* [m] */
} written;

static double sign_of(int dim, int dof) { return dof % dim == 0 ? -1.0 : 1.0; }

static status check_friction(const contact_problem *cp) {
  const char *why = NULL;
  for (int i = 0; i < cp->n && cp->g0 != NULL; ++i)
    if (cp->g0[i] != 0.0)
      why = "holds Coulomb friction only, no given sliding limit";
  for (int i = 0; i < cp->n && cp->B != NULL; ++i)
    for (int k = cp->B->start[i]; k < cp->B->start[i + 1]; ++k)
      if (cp->B->col[k] != i && cp->B->val[k] != 0.0)
        why = "holds friction of each node by itself only, no average";
  for (int k = 0; k < cp->n * (cp->dim - 1) && cp->side_gap != NULL; ++k)
    if (cp->side_gap[k] < HUGE_VAL)
      why = "has no place for nodes that touch two obstacles";
  if (why != NULL)
    RAISE(ERR_DECK, "*OUTPUT, CONDENSED=FCLIB: the layout %s", why);
  return OK;
}

/* gap for the normal, -ut0 for a tangential unknown. */
static double offset_of(const contact_problem *cp, int dof) {
  int i = dof / cp->dim, k = dof % cp->dim - 1;
  if (k < 0) return cp->gap[i];
  return cp->ut0 == NULL ? 0.0 : -cp->ut0[i * (cp->dim - 1) + k];
}

/* inv(A) in place of the copy of A, both triangles; 0: A is singular.
 * work[3 m], iwork[m]: workspace. */
static int invert(int m, double *a, double *work, int *iwork) {
  double rcond = 0.0;
  const size_t n = m;
  if (m == 0) return 1;
  const double norm = LAPACKE_dlange(LAPACK_COL_MAJOR, '1', m, m, a, m);
  if (LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'U', m, a, m) != 0) return 0;
  if (LAPACKE_dpocon_work(LAPACK_COL_MAJOR, 'U', m, a, m, norm, &rcond, work,
                          iwork) != 0 ||
      !(rcond > 1e-13))
    return 0;
  if (LAPACKE_dpotri(LAPACK_COL_MAJOR, 'U', m, a, m) != 0) return 0;
  for (size_t j = 0; j < n; ++j)
    for (size_t i = 0; i < j; ++i) a[j + n * i] = a[i + n * j];
  return 1;
}

/* W or A by rows, signs turned. M holds it by columns. */
static void turn_matrix(const contact_problem *cp, double *M) {
  size_t m = cp->m;
  for (int j = 0; j < cp->m; ++j)
    for (int i = 0; i <= j; ++i) {
      size_t above = i + m * j, below = j + m * i;
      double s = sign_of(cp->dim, i) * sign_of(cp->dim, j), swap = M[above];
      M[above] = s * M[below];
      M[below] = s * swap;
    }
}

static status make_matrix(written *f) {
  const contact_problem *cp = f->cp;
  size_t size = (size_t)cp->m * cp->m;
  double *a = NULL;
  PASS_NEW(a, size);
  f->M = a;
  f->local = 1;
  if (cp->A == NULL) {
    contact_dense(cp, a);
    return OK;
  }
  COPY(a, cp->A, size);
  OWNED_NEW(double, work, 3 * (size_t)cp->m);
  OWNED_NEW(int, iwork, cp->m);
  if (!cp->floating && invert(cp->m, a, work, iwork)) return OK;
  COPY(a, cp->A, size);
  f->local = 0;
  return OK;
}

/* q of the local problem; w of the global one. M is still W by columns. */
static status make_vectors(written *f) {
  const contact_problem *cp = f->cp;
  PASS_NEW_ALL(OF(f->q, cp->m), OF(f->mu, cp->n));
  if (f->local && !contact_has_stiffness(cp))
    COPY(f->q, cp->f, cp->m);
  else if (f->local)
    contact_product(cp->m, f->M, cp->f, f->q);
  for (int k = 0; k < cp->m; ++k) {
    f->q[k] = sign_of(cp->dim, k) * f->q[k] + offset_of(cp, k);
    if (contact_held(cp, k) && f->local) f->q[k] = 0.0;
  }
  for (int i = 0; i < cp->n && cp->B != NULL; ++i)
    for (int k = cp->B->start[i]; k < cp->B->start[i + 1]; ++k)
      if (cp->B->col[k] == i) f->mu[i] += cp->B->val[k];
  return OK;
}

static status failed(const written *f, const char *name) {
  return status_fail(ERR_FILE, __func__, __LINE__, "%s: %s cannot be written",
                     f->path, name);
}

static status put_group(const written *f, const char *name) {
  hid_t group =
      H5Gcreate2(f->file, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  if (group < 0 || H5Gclose(group) < 0) return failed(f, name);
  return OK;
}

/* GROUP/NAME: "data" has the type "as" in memory. */
static status put_data(const written *f, const char *group, const char *name,
                       hid_t type, hid_t as, hid_t space, const void *data) {
  const char *full = text_of("%s/%s", group, name);
  HELD hid_t plan = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_obj_track_times(plan, 0);
  hid_t set =
      H5Dcreate2(f->file, full, type, space, H5P_DEFAULT, plan, H5P_DEFAULT);
  int bad =
      set < 0 || (H5Sget_simple_extent_npoints(space) > 0 &&
                  H5Dwrite(set, as, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0);
  if (set >= 0 && H5Dclose(set) < 0) bad = 1;
  return bad ? failed(f, full) : OK;
}

static status put_reals(const written *f, const char *group, const char *name,
                        size_t n, const double *x) {
  HELD hid_t space = H5Screate_simple(1, &(hsize_t){n}, NULL);
  return put_data(f, group, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, space, x);
}

static status put_ints(const written *f, const char *group, const char *name,
                       size_t n, const int *x) {
  HELD hid_t space = H5Screate_simple(1, &(hsize_t){n}, NULL);
  return put_data(f, group, name, H5T_STD_I32LE, H5T_NATIVE_INT, space, x);
}

static status put_numbers(const written *f) {
  HELD hid_t space = H5Screate_simple(1, &(hsize_t){(hsize_t)f->cp->n}, NULL);
  if (f->node_no == NULL) return OK;
  return put_data(f, "", "node_no", H5T_STD_I64LE, H5T_NATIVE_ULONG, space,
                  f->node_no);
}

static status put_text(const written *f, const char *group, const char *name,
                       const char *text) {
  HELD hid_t type = H5Tcopy(H5T_C_S1);
  HELD hid_t space = H5Screate(H5S_SCALAR);
  H5Tset_size(type, strlen(text) + 1);
  H5Tset_strpad(type, H5T_STR_NULLTERM);
  return put_data(f, group, name, type, type, space, text);
}

static status put_matrix(const written *f, const char *group, int nz, size_t n,
                         const double *x) {
  const int m = f->cp->m;
  PASS(put_group(f, group));
  PASS(put_ints(f, group, "nzmax", 1, &(int){(int)n}));
  PASS(put_ints(f, group, "m", 1, &m));
  PASS(put_ints(f, group, "n", 1, &m));
  PASS(put_ints(f, group, "nz", 1, &nz));
  PASS(put_ints(f, group, "p", nz == BY_ROW ? (size_t)m + 1 : n, f->start));
  PASS(put_ints(f, group, "i", n, f->col));
  return put_reals(f, group, "x", n, x);
}

static status write_local(written *f) {
  size_t m = f->cp->m;
  PASS_NEW_ALL(OF(f->start, m + 1), OF(f->col, m * m));
  for (size_t i = 0; i <= m; ++i) f->start[i] = (int)(m * i);
  for (size_t k = 0; k < m * m; ++k) f->col[k] = (int)(k % m);
  PASS(put_group(f, "/fclib_local"));
  PASS(put_ints(f, "/fclib_local", "spacedim", 1, &f->cp->dim));
  PASS(put_matrix(f, "/fclib_local/W", BY_ROW, m * m, f->M));
  PASS(put_group(f, "/fclib_local/vectors"));
  PASS(put_reals(f, "/fclib_local/vectors", "q", m, f->q));
  return put_reals(f, "/fclib_local/vectors", "mu", f->cp->n, f->mu);
}

/* M and f keep the signs of contact.h: H turns them. */
static status write_global(written *f) {
  const contact_problem *cp = f->cp;
  size_t m = cp->m;
  OWNED double *h = NULL;
  PASS_NEW_ALL(OF(f->start, m * m), OF(f->col, m * m), OF(h, m));
  PASS(put_group(f, "/fclib_global"));
  PASS(put_ints(f, "/fclib_global", "spacedim", 1, &cp->dim));
  for (size_t k = 0; k < m * m; ++k) {
    f->start[k] = (int)(k / m);
    f->col[k] = (int)(k % m);
  }
  PASS(put_matrix(f, "/fclib_global/M", (int)(m * m), m * m, cp->A));
  for (size_t k = 0; k < m; ++k) {
    f->start[k] = f->col[k] = (int)k;
    h[k] = sign_of(cp->dim, (int)k);
  }
  PASS(put_matrix(f, "/fclib_global/H", (int)m, m, h));
  PASS(put_group(f, "/fclib_global/vectors"));
  PASS(put_reals(f, "/fclib_global/vectors", "f", m, cp->f));
  PASS(put_reals(f, "/fclib_global/vectors", "w", m, f->q));
  return put_reals(f, "/fclib_global/vectors", "mu", cp->n, f->mu);
}

static status write_solution(const written *f, const double *v) {
  size_t m = f->cp->m;
  if (f->u == NULL) return OK;
  PASS(put_group(f, "/solution"));
  PASS(put_reals(f, "/solution", "u", m, f->u));
  PASS(put_reals(f, "/solution", "r", m, f->r));
  if (!f->local) PASS(put_reals(f, "/solution", "v", m, v));
  return OK;
}

static status write_info(const written *f, const char *title,
                         const char *description) {
  const char *root = f->local ? "/fclib_local/info" : "/fclib_global/info";
  PASS(put_group(f, root));
  PASS(put_text(f, root, "title", title));
  PASS(put_text(f, root, "description", description));
  return put_text(f, root, "math_info",
                  "quasistatic increment: u_N is the gap, u_T the slip of the "
                  "increment, r nodal forces");
}

static status write_open(written *f, const double *v, const char *title,
                         const char *description) {
  PASS(f->local ? write_local(f) : write_global(f));
  PASS(write_info(f, title, description));
  PASS(put_numbers(f));
  PASS(write_solution(f, v));
  return H5Fflush(f->file, H5F_SCOPE_LOCAL) < 0 ? failed(f, "the file") : OK;
}

static status write_all(written *f, const double *v, const char *title,
                        const char *description) {
  if (f->local) turn_matrix(f->cp, f->M);
  PASS(file_clear(f->path));
  errno = 0;
  f->file = H5Fcreate(f->path, H5F_ACC_EXCL, H5P_DEFAULT, H5P_DEFAULT);
  if (f->file < 0) return text_failed(f->path, "write", errno);
  status st = write_open(f, v, title, description);
  if (H5Fclose(f->file) < 0 && st == OK) st = failed(f, "the file");
  return st;
}

static status make_file(written *f, const double *u, const double *r) {
  if (f->cp->m > 46340)
    RAISE(ERR_DECK, "%s: %d unknowns are too many for the layout of FCLIB",
          f->path, f->cp->m);
  PASS(check_friction(f->cp));
  PASS(make_matrix(f));
  PASS(make_vectors(f));
  const contact_problem *cp = f->cp;
  if (u == NULL) return OK;
  PASS_NEW_REALS(cp->m, &f->u, &f->r);
  for (int k = 0; k < cp->m; ++k) {
    f->u[k] = sign_of(cp->dim, k) * u[k] + offset_of(cp, k);
    f->r[k] = contact_held(cp, k) ? 0.0 : sign_of(cp->dim, k) * r[k];
  }
  return OK;
}

status fclib_write(const contact_problem *cp, const size_t *node_no,
                   const double *u, const double *r, const char *title,
                   const char *description, const char *path) {
  written f = {.cp = cp, .node_no = node_no, .file = -1};
  H5E_auto2_t print;
  void *print_data;
  SCRATCH;
  OWNED_GET(char, aside, text_path("", path, "tmp"));
  f.path = path;
  PASS(make_file(&f, u, r));
  f.path = aside;
  H5dont_atexit();
  H5Eget_auto2(H5E_DEFAULT, &print, &print_data);
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  status st = write_all(&f, u, title, description);
  H5Eset_auto2(H5E_DEFAULT, print, print_data);
  if (st == OK && rename(aside, path) != 0)
    st = text_failed(path, "replace", errno);
  if (st != OK) unlink(aside);
  return st;
}
