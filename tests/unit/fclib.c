/* src/output/fclib.c: what stands in the file, what is refused; of files read,
 * the shapes. */
#include "exchange/exchange.h"
#include "output/writers.h"
#include "support/contact_case.h"
#include "support/fclib_file.h"
#include "support/folder.h"
#include "support/unit.h"

#include <unistd.h>

static char folder[64], path[128];

static void enter(void) {
  folder_new(folder);
  snprintf(path, sizeof path, "%s/out.h5", folder);
}

static void leave(void) { folder_remove(folder); }

/* One node: A = diag(4, 2), W = diag(1/4, 1/2). */
static contact_case one_node(void) {
  contact_case c = case_new(2, 1, 0.3);
  c.A[0] = 4.0;
  c.A[3] = 2.0;
  c.f[0] = 8.0;
  c.f[1] = 3.0;
  c.gap[0] = 0.5;
  c.ut0[0] = 0.25;
  c.u[0] = 0.5;
  c.u[1] = 0.75;
  c.r[0] = -6.0;
  c.r[1] = -1.5;
  return c;
}

static void expect(const char *name, int n, const double *value) {
  int items;
  FREED double *x = fclib_take(path, name, &items);
  ck_assert_msg(x != NULL, "%s is missing", name);
  ck_assert_int_eq(items, n);
  for (int k = 0; k < n; ++k)
    ck_assert_msg(fabs(x[k] - value[k]) <= 1e-15, "%s[%d] = %g", name, k, x[k]);
}

#define EXPECT(name, ...)                                             \
  expect(name, (int)(sizeof(double[]){__VA_ARGS__} / sizeof(double)), \
         (double[]){__VA_ARGS__})

static void expect_text(const char *name, const char *text) {
  char is[80] = "";
  hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  hid_t set = H5Dopen2(file, name, H5P_DEFAULT), type = H5Dget_type(set);
  ck_assert_uint_eq(H5Tget_size(type), strlen(text) + 1);
  ck_assert(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, is) >= 0);
  ck_assert_str_eq(is, text);
  H5Tclose(type);
  H5Dclose(set);
  H5Fclose(file);
}

/* u_n = W_n (8 + r_n): gap left 0.5 - 2 = -1.5 without force. */
TEST(signs_are_those_of_the_layout) {
  enter();
  CONTACT_CASE c = one_node();
  const size_t number = 17;
  ck_assert_int_eq(
      fclib_write(&c.cp, &number, c.u, c.r, "title", "about", path), OK);
  EXPECT("/node_no", 17);
  EXPECT("/fclib_local/spacedim", 2);
  EXPECT("/fclib_local/W/nz", -2);
  EXPECT("/fclib_local/W/m", 2);
  EXPECT("/fclib_local/W/p", 0, 2, 4);
  EXPECT("/fclib_local/W/i", 0, 1, 0, 1);
  EXPECT("/fclib_local/W/x", 0.25, 0, 0, 0.5);
  EXPECT("/fclib_local/vectors/q", -1.5, 1.25);
  EXPECT("/fclib_local/vectors/mu", 0.3);
  EXPECT("/solution/u", 0, 0.5);
  EXPECT("/solution/r", 6, -1.5);
  expect_text("/fclib_local/info/title", "title");
  expect_text("/fclib_local/info/description", "about");
  leave();
}

/* Nothing but contact holds the normal direction: no inverse. */
TEST(singular_stiffness_is_written_as_global) {
  enter();
  CONTACT_CASE c = one_node();
  c.A[0] = 0.0;
  c.cp.floating = 1;
  ck_assert_int_eq(fclib_write(&c.cp, NULL, NULL, NULL, "", "", path), OK);
  EXPECT("/fclib_global/M/nz", 4);
  EXPECT("/fclib_global/M/x", 0, 0, 0, 2);
  EXPECT("/fclib_global/H/p", 0, 1);
  EXPECT("/fclib_global/H/x", -1, 1);
  EXPECT("/fclib_global/vectors/f", 8, 3);
  EXPECT("/fclib_global/vectors/w", 0.5, -0.25);
  int n;
  ck_assert_ptr_null(fclib_take(path, "/solution/u", &n));
  OWNED message_log *log = NULL;
  OWNED exchange_problem *p = NULL;
  const place at = {.file = "a.inp", .line_no = 1};
  ck_assert_int_eq(message_log_new(&log), OK);
  ck_assert_int_eq(exchange_read(path, EXCHANGE_FCLIB, &at, log, &p), OK);
  ck_assert_int_eq(p->cp.floating, 1);
  ck_assert_mem_eq(p->cp.A, c.A, 4 * sizeof *c.A);
  ck_assert_mem_eq(p->cp.f, c.f, 2 * sizeof *c.f);
  ck_assert_double_eq(p->cp.gap[0], 0.5);
  ck_assert_double_eq(p->cp.ut0[0], 0.25);
  leave();
}

/* As other programs leave room for what is theirs before HDF5. */
TEST(layout_behind_a_user_block_is_read) {
  const place at = {.file = "a.inp", .line_no = 1};
  enter();
  CONTACT_CASE c = one_node();
  OWNED message_log *log = NULL;
  exchange_problem *p;
  ck_assert_int_eq(message_log_new(&log), OK);
  for (hsize_t size = 512; size <= 2048; size *= 2) {
    ck_assert_int_eq(fclib_write(&c.cp, NULL, NULL, NULL, "", "", path), OK);
    hid_t plain = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    ck_assert_int_eq(unlink(path), 0);
    hid_t how = H5Pcreate(H5P_FILE_CREATE);
    ck_assert_int_ge(H5Pset_userblock(how, size), 0);
    hid_t file = H5Fcreate(path, H5F_ACC_EXCL, how, H5P_DEFAULT);
    ck_assert_int_ge(H5Ocopy(plain, "fclib_local", file, "fclib_local",
                             H5P_DEFAULT, H5P_DEFAULT),
                     0);
    H5Pclose(how);
    H5Fclose(file);
    H5Fclose(plain);
    ck_assert_int_eq(exchange_read(path, EXCHANGE_BY_CONTENT, &at, log, &p),
                     OK);
    ck_assert_double_eq_tol(p->cp.f[0], 1.5, 1e-15);
    ck_assert_double_eq_tol(p->cp.f[1], 1.25, 1e-15);
    memory_free(p);
  }
  leave();
}

/* A matrix of ones in the place of one of a problem with one contact in the
 * plane; of the local one also R of one row, where "row" is set; no group: an
 * empty file. */
static const struct misfit {
  const char *group;
  int rows, columns, row;
  const char *text;
} misfits[] = {{"/fclib_local/V", 3, 1, 1, "V is 3 x 1"},
               {"/fclib_local/V", 2, 2, 1, "V is 2 x 2"},
               {"/fclib_local/V", 2, 1, 0, "one is missing"},
               {"/fclib_local/X", 1, 1, 1, "one is missing"},
               {"/fclib_global/M", 2, 3, 0, "M is not square"},
               {"/fclib_global/H", 3, 2, 0, "H has 3 rows, M has 2"},
               {"/fclib_global/G", 3, 1, 0, "G has 3 rows, M has 2"},
               {"/fclib_global/G", 0, -1, 0, "G is 0 x -1"},
               {NULL, 0, 0, 0, "neither a group"}};

TEST(matrices_that_do_not_fit_are_refused) {
  const place at = {.file = "a.inp", .line_no = 1};
  const double one[] = {1, 1, 1, 1, 1, 1}, mu[] = {0.3};
  const fclib_global_data g = {2, 1, 2, one, one, one, one, mu};
  OWNED message_log *log = NULL;
  enter();
  ck_assert_int_eq(message_log_new(&log), OK);
  for (size_t k = 0; k < sizeof misfits / sizeof *misfits; ++k) {
    const struct misfit *x = &misfits[k];
    exchange_problem *p;
    if (x->group == NULL)
      fclib_end(fclib_begin(path));
    else if (strncmp(x->group, "/fclib_local", 12) == 0)
      fclib_local(path, STORE_TRIPLET, 2, 1, one, one, mu);
    else
      fclib_global(path, STORE_TRIPLET, &g);
    hid_t file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
    if (x->row) fclib_matrix(file, "/fclib_local/R", STORE_ROWS, 1, 1, one);
    if (x->group != NULL && H5Lexists(file, x->group, H5P_DEFAULT) > 0)
      ck_assert_int_ge(H5Ldelete(file, x->group, H5P_DEFAULT), 0);
    if (x->group != NULL)
      fclib_matrix(file, x->group, STORE_ROWS, x->rows, x->columns, one);
    fclib_end(file);
    ck_assert_int_eq(exchange_read(path, EXCHANGE_FCLIB, &at, log, &p),
                     ERR_DECK);
    ck_assert_msg(strstr(status_message(), x->text) != NULL, "%s: %s", x->text,
                  status_message());
  }
  leave();
}

/* No file is left, not even the one aside. */
TEST(problems_without_a_place_are_refused) {
  enter();
  for (int k = 0; k < 3; ++k) {
    CONTACT_CASE c = case_new(2, 2, 0.3);
    for (int i = 0; i < 4; ++i) c.A[5 * i] = 1.0;
    if (k == 0) c.g0[1] = 1.0;
    if (k == 1) c.B->col[0] = 1;
    double side[2] = {HUGE_VAL, 1.0};
    if (k == 2) c.cp.side_gap = side;
    ck_assert_int_eq(fclib_write(&c.cp, NULL, NULL, NULL, "", "", path),
                     ERR_DECK);
    ck_assert_ptr_nonnull(strstr(status_message(), "CONDENSED=FCLIB"));
    ck_assert_ptr_null(folder_file(folder, "out.h5.tmp", &(size_t){0}));
  }
  CONTACT_CASE c = one_node();
  ck_assert_int_eq(
      fclib_write(&c.cp, NULL, NULL, NULL, "", "", "/nowhere/at/all.h5"),
      ERR_FILE);
  ck_assert_ptr_nonnull(strstr(status_message(), "/nowhere/at/all.h5"));
  leave();
}

TEST(every_refused_request_is_reported) {
  enter();
  for (int floating = 0; floating <= 1; ++floating) {
    CONTACT_CASE c = one_node();
    c.cp.floating = floating;
    UNIT_REFUSED(4, fclib_write(&c.cp, NULL, c.u, c.r, "", "", path), );
  }
  leave();
}

UNIT_MAIN("fclib")
