/*
 * src/output/hdf5: JOB.h5 read back with the library; growth
 * and cutting; kills, full disks and refused memory.
 */
#include "output/hdf5/file.h"
#include "support/folder.h"
#include "support/made_up.h"
#include "support/unit.h"

#include <hdf5.h>
#include <dirent.h>
#include <fcntl.h>
#include <linux/sched.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static const output_options plain = {.version = "1.2.3", .threads = 1};

/* All numbers of a dataset (caller frees), its sizes in dims; NULL: none. */
static double *dataset(const char *dir, const char *name, int dims[2]) {
  PRINTED(path, "%s/block.h5", dir);
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0) return NULL;
  hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
  double *x = NULL;
  if (set >= 0) {
    hid_t space = H5Dget_space(set);
    hsize_t sizes[2] = {1, 1};
    const int rank = H5Sget_simple_extent_dims(space, sizes, NULL);
    ck_assert_msg((rank == 2) == (sizes[1] > 1), "%s: rank %d", name, rank);
    for (int k = 0; k < 2; ++k) dims[k] = (int)sizes[k];
    x = calloc((size_t)(sizes[0] * sizes[1]), sizeof *x);
    if (H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, x) < 0)
      ck_abort_msg("cannot read %s", name);
    H5Sclose(space);
    H5Dclose(set);
  }
  H5Fclose(file);
  return x;
}

static void attribute_is(const char *dir, const char *object, const char *name,
                         const char *wanted) {
  char path[100], got[200] = "";
  snprintf(path, sizeof path, "%s/block.h5", dir);
  hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  hid_t a = H5Aopen_by_name(file, object, name, H5P_DEFAULT, H5P_DEFAULT);
  ck_assert_msg(a >= 0, "%s of %s", name, object);
  hid_t type = H5Aget_type(a);
  ck_assert_uint_le(H5Tget_size(type), sizeof got);
  ck_assert_int_ge(H5Aread(a, type, got), 0);
  ck_assert_str_eq(got, wanted);
  H5Tclose(type);
  H5Aclose(a);
  H5Fclose(file);
}

/* A run of "told" increments as far as JOB.h5 is concerned. */
static status write_file(made_up *made, const char *dir, int told,
                         int finished) {
  output_options o = plain;
  hdf5_file *h = NULL;
  o.dir = dir;
  status st = hdf5_open(&made->m, made->msh, &o, NULL, &h);
  for (int i = 1; i <= told && st == OK; ++i) {
    made_up_advance(made, i);
    st = hdf5_increment(h, &made->s);
  }
  status closed = hdf5_close(h, finished && st == OK);
  return st != OK ? st : closed;
}

/* Record i (from 1) of a vector field against the formula. */
static void vector_is(const char *dir, const char *group, int array, int n,
                      int dim, int i) {
  int dims[2];
  PRINTED(name, "%s/%05d", group, i);
  FREED double *x = dataset(dir, name, dims);
  ck_assert_msg(x != NULL, "%s", name);
  ck_assert_int_eq(dims[0], n);
  ck_assert_int_eq(dims[1], 3);
  for (int id = 0; id < n; ++id)
    for (int k = 0; k < 3; ++k)
      ck_assert(x[3 * id + k] ==
                (k < dim ? made_up_value(array, dim * id + k, i) : 0));
}

/* Everything of increment i that depends on it. */
static void increment_is(const made_up *made, const char *dir, int i) {
  int dims[2];
  double *t = dataset(dir, "/history/time", dims);
  ck_assert_ptr_nonnull(t);
  ck_assert_int_ge(dims[0], i);
  ck_assert(t[i - 1] == 0.5 * i);
  free(t);
  t = dataset(dir, "/history/residual", dims);
  ck_assert(t[i - 1] == 1e-12 * i);
  free(t);
  t = dataset(dir, "/totals/FOOT/normal", dims);
  ck_assert(t[i - 1] == 2.5 * i);
  free(t);
  t = dataset(dir, "/fields/time", dims);
  ck_assert(t[i - 1] == 0.5 * i);
  free(t);
  vector_is(dir, "/fields/u", MADE_U, made->msh->n_node, made->m.dim, i);
  vector_is(dir, "/fields/reaction", MADE_REACTION, made->msh->n_node,
            made->m.dim, i);
}

/* Increments whose time is there. */
static int count_reached(const char *dir) {
  int dims[2] = {0, 0}, n = 0;
  FREED double *t = dataset(dir, "/history/time", dims);
  while (t != NULL && n < dims[0] && !isnan(t[n])) ++n;
  return n;
}

static void rows_are(const char *dir, int n) {
  int dims[2];
  FREED double *t = dataset(dir, "/history/time", dims);
  ck_assert_int_eq(dims[0], n);
  for (int i = 0; i < n; ++i) ck_assert(t[i] == 0.5 * (i + 1));
}

TEST(fields_read_back_exactly) {
  for (int dim = 2; dim <= 3; ++dim) {
    int dims[2];
    FOLDER(dir);
    MADE_UP *made = made_up_new(dim, 3, 4);
    ck_assert_int_eq(write_file(made, dir, 4, 1), OK);
    for (int i = 1; i <= 4; ++i) increment_is(made, dir, i);
    rows_are(dir, 4);
    double *x = dataset(dir, "/fields/stress/00003", dims);
    const int order[] = {0, 3, dim == 2 ? 99 : 5, 1, dim == 2 ? 99 : 4, 2};
    ck_assert_int_eq(dims[1], 6);
    for (int id = 0; id < made->msh->n_elem; ++id)
      for (int k = 0; k < 6; ++k)
        ck_assert(
            x[6 * id + k] ==
            (order[k] == 99
                 ? 0
                 : made_up_value(MADE_STRESS, made->m.ns * id + order[k], 3)));
    free(x);
    x = dataset(dir, "/contact/u/00003", dims);
    for (int i = 0; i < made->surface.n; ++i)
      for (int k = 0; k < 3; ++k)
        ck_assert(x[3 * i + k] ==
                  (k == dim
                       ? 0
                       : made_up_value(MADE_U,
                                       dim * made->surface.node_id[i] + k, 3)));
    free(x);
    x = dataset(dir, "/contact/pressure/00002", dims);
    ck_assert_int_eq(dims[0], made->surface.n);
    for (int id = 0; id < made->surface.n; ++id)
      ck_assert(x[id] == -made_up_value(MADE_RC, dim * id, 2) / 0.25);
    free(x);
  }
}

TEST(mesh_and_surface_stand_in_the_file) {
  int dims[2];
  FOLDER(dir);
  MADE_UP *made = made_up_new(3, 2, 1);
  const mesh *m = made->msh;
  made->m.unit.length = "mm";
  made->m.unit.force = "N";
  ck_assert_int_eq(write_file(made, dir, 1, 1), OK);
  double *x = dataset(dir, "/mesh/nodes", dims);
  for (int i = 0; i < 3 * m->n_node; ++i) ck_assert(x[i] == m->x[i]);
  free(x);
  x = dataset(dir, "/mesh/elements", dims);
  ck_assert_int_eq(dims[1], 4);
  for (int i = 0; i < 4 * m->n_elem; ++i) ck_assert(x[i] == m->elem[i]);
  free(x);
  x = dataset(dir, "/mesh/node_no", dims);
  for (int i = 0; i < m->n_node; ++i) ck_assert(x[i] == (double)m->node_no[i]);
  free(x);
  x = dataset(dir, "/mesh/groups/TOP/nodes", dims);
  ck_assert_int_eq(dims[0], 9);
  free(x);
  x = dataset(dir, "/contact/normal/00001", dims);
  ck_assert(x[0] == 0 && x[1] == -1 && x[2] == 0);
  free(x);
  FREED double *faces = dataset(dir, "/contact/faces", dims);
  FREED double *points = dataset(dir, "/contact/points", (int[2]){0, 0});
  ck_assert_int_eq(dims[0], 8); /* 2 x 2 squares of two triangles           */
  for (int i = 0; i < 24; ++i) ck_assert(points[3 * (int)faces[i] + 1] == 0);
  attribute_is(dir, "/", "version", "1.2.3");
  attribute_is(dir, "/", "title", made->m.name.title);
  attribute_is(dir, "/contact/pressure", "unit", "N/mm^2");
  attribute_is(dir, "/history/strain_energy", "unit", "N*mm");
}

/* A side of two contacts, and an edge of theirs: each node bears the number of
 * its first contact, and the faces are those of the contacts, one by one. */
TEST(contacts_have_their_nodes_and_faces) {
  static const char *const sides[] = {"TOP", "BOTTOM", "LEFT"};
  for (int dim = 2; dim <= 3; ++dim) {
    int dims[2], n = 0;
    FOLDER(dir);
    MADE_UP *made = made_up_new(dim, 2, 1);
    const mesh *m = made->msh;
    contact three[3];
    made->m.n.contact = 3;
    made->m.contacts = three;
    for (int c = 0; c < 3; ++c) {
      three[c] = made->foot;
      three[c].name = sides[c];
      for (three[c].group_id = 0;
           strcmp(m->group[three[c].group_id].name, sides[c]) != 0;)
        ++three[c].group_id;
    }
    made->m.effects = EFFECT_CONTACT;
    hdf5_file *h = NULL;
    output_options o = plain;
    o.dir = dir;
    ck_assert_int_eq(hdf5_open(&made->m, m, &o, NULL, &h), OK);
    ck_assert_int_eq(hdf5_close(h, 1), OK);
    FREED double *no = dataset(dir, "/contact/node_no", dims);
    FREED double *first = dataset(dir, "/contact/contact_no", dims);
    FREED double *faces = dataset(dir, "/contact/faces", (int[2]){0, 0});
    ck_assert(no != NULL && first != NULL && faces != NULL);
    const int nodes = dims[0];
    for (int c = 0; c < 3; ++c) {
      const mesh_group *g = &m->group[three[c].group_id];
      for (int i = 0; i < g->n_item; ++i)
        for (int k = 0; k < dim; ++k, ++n)
          ck_assert(no[(int)faces[n]] ==
                    (double)m->node_no[m->face[dim * g->item_id[i] + k]]);
      for (int i = 0; i < g->n_node; ++i)
        for (int p = 0; p < nodes; ++p)
          if (no[p] == (double)m->node_no[g->node_id[i]])
            ck_assert_double_le(first[p], c + 1);
    }
    for (int p = 0; p < nodes; ++p) {
      const mesh_group *g = &m->group[three[(int)first[p] - 1].group_id];
      int on = 0;
      for (int i = 0; i < g->n_node; ++i)
        on += no[p] == (double)m->node_no[g->node_id[i]];
      ck_assert_int_eq(on, 1);
    }
  }
}

TEST(more_increments_than_expected_are_kept) {
  FOLDER(dir);
  MADE_UP *made = made_up_new(2, 2, 3);
  ck_assert_int_eq(write_file(made, dir, 60, 1), OK);
  for (int i = 1; i <= 60; ++i) increment_is(made, dir, i);
  rows_are(dir, 60);
}

/* As if so many stood there: their places are that of the first one. */
static void claim_records(hdf5_file *h, int n) {
  off_t *room = memory_new((size_t)h->n_field * (size_t)n, sizeof *room);
  ck_assert_ptr_nonnull(room);
  for (int i = 0; i < h->n_field * n; ++i)
    room[i] = h->now.record[i / n * h->now.n_record];
  memory_free(h->now.record);
  h->now.record = room;
  h->now.n_record = n;
}

TEST(records_of_six_digits_are_kept) {
  enum { BEFORE = 99998, ALL = 100002 };
  char name[40];
  FOLDER(dir);
  MADE_UP *made = made_up_new(2, 1, 4);
  output_options o = plain;
  hdf5_file *h = NULL;
  o.dir = dir;
  ck_assert_int_eq(hdf5_open(&made->m, made->msh, &o, NULL, &h), OK);
  claim_records(h, ALL);
  h->n_record = h->cap_time = BEFORE;
  h->times = memory_new(BEFORE, sizeof *h->times);
  for (int i = 1; i <= ALL - BEFORE; ++i) {
    made_up_advance(made, i);
    ck_assert_int_eq(hdf5_increment(h, &made->s), OK);
  }
  ck_assert_int_eq(h->n_record, ALL);
  ck_assert(h->times[ALL - 1] == made->s.t);
  hdf5_record_name(name, sizeof name, ALL - 1);
  ck_assert_str_eq(name, "100002");
  ck_assert_int_eq(hdf5_close(h, 0), OK);
}

TEST(room_not_used_is_cut_at_the_end) {
  int dims[2];
  FOLDER(dir);
  MADE_UP *made = made_up_new(2, 2, 50);
  ck_assert_int_eq(write_file(made, dir, 7, 1), OK);
  rows_are(dir, 7);
  increment_is(made, dir, 7);
  ck_assert_ptr_null(dataset(dir, "/fields/u/00008", dims));
  ck_assert_int_eq(write_file(made, dir, 7, 0), OK); /* a failed run          */
  FREED double *t = dataset(dir, "/history/time", dims);
  ck_assert_int_eq(dims[0], 50);
  ck_assert(t[6] == 3.5 && isnan(t[7]) && isnan(t[49]));
}

/* All records are there, of the end alone, and not all rows. */
TEST(rows_not_used_are_cut_at_the_end) {
  int dims[2];
  FOLDER(dir);
  MADE_UP *made = made_up_new(2, 2, 8);
  output_options o = plain;
  hdf5_file *h = NULL;
  o.dir = dir;
  made->steps[0].output.frequency = 100;
  ck_assert_int_eq(hdf5_open(&made->m, made->msh, &o, NULL, &h), OK);
  for (int i = 1; i <= 5; ++i) {
    made_up_advance(made, i);
    made->s.end_of_step = i == 5;
    ck_assert_int_eq(hdf5_increment(h, &made->s), OK);
  }
  ck_assert_int_eq(hdf5_close(h, 1), OK);
  rows_are(dir, 5);
  FREED double *total = dataset(dir, "/fields/total", dims);
  ck_assert_int_eq(dims[0], 1);
}

TEST(frequency_chooses_the_records) {
  int dims[2];
  FOLDER(dir);
  MADE_UP *made = made_up_new(2, 2, 5);
  made->steps[0].output.frequency = 2;
  ck_assert_int_eq(write_file(made, dir, 5, 1), OK);
  FREED double *total = dataset(dir, "/fields/total", dims);
  ck_assert_int_eq(dims[0], 3);
  ck_assert(total[0] == 2 && total[1] == 4 && total[2] == 5);
  rows_are(dir, 5);
  made->steps[0].output.frequency = -1;
  hdf5_file *h = NULL;
  ck_assert_int_eq(hdf5_open(&made->m, made->msh, &plain, NULL, &h), OK);
  ck_assert_ptr_null(h);
}

TEST(missing_arrays_are_not_zero) {
  int dims[2];
  FOLDER(dir);
  MADE_UP *made = made_up_new(2, 2, 1);
  made->s.body.stress = NULL;
  ck_assert_int_eq(write_file(made, dir, 1, 1), OK);
  FREED double *x = dataset(dir, "/fields/mises/00001", dims);
  ck_assert(isnan(x[0]) && isnan(x[made->msh->n_elem - 1]));
}

TEST(scene_without_contact_has_no_surface) {
  int dims[2];
  FOLDER(dir);
  MADE_UP *made = made_up_new(2, 2, 1);
  hdf5_file *h = NULL;
  output_options o = plain;
  o.dir = dir;
  made->m.effects = 0;
  made->m.n.contact = 0;
  made->s.contacts.surface = NULL;
  ck_assert_int_eq(hdf5_open(&made->m, made->msh, &o, NULL, &h), OK);
  made_up_advance(made, 1);
  ck_assert_int_eq(hdf5_increment(h, &made->s), OK);
  ck_assert_int_eq(hdf5_close(h, 1), OK);
  ck_assert_ptr_null(dataset(dir, "/contact/points", dims));
  FREED double *u = dataset(dir, "/fields/u/00001", dims);
  ck_assert_ptr_nonnull(u);
}

/* Supports that change from step to step change the contact surface. */
TEST(node_that_leaves_the_surface_has_no_value) {
  int dims[2];
  FOLDER(dir);
  MADE_UP *made = made_up_new(2, 3, 2);
  hdf5_file *h = NULL;
  output_options o = plain;
  o.dir = dir;
  ck_assert_int_eq(hdf5_open(&made->m, made->msh, &o, NULL, &h), OK);
  made_up_advance(made, 1);
  ck_assert_int_eq(hdf5_increment(h, &made->s), OK);
  for (int i = 1; i < 3; ++i) /* node 1 of 4 goes                            */
    made->surface.node_id[i] = made->surface.node_id[i + 1];
  made->surface.n = 3;
  made_up_advance(made, 2);
  ck_assert_int_eq(hdf5_increment(h, &made->s), OK);
  ck_assert_int_eq(hdf5_close(h, 1), OK);
  FREED double *first = dataset(dir, "/contact/gap/00001", dims);
  FREED double *second = dataset(dir, "/contact/gap/00002", dims);
  ck_assert_int_eq(dims[0], 4);
  const int item[] = {0, -1, 1, 2};
  for (int i = 0; i < 4; ++i) {
    ck_assert(first[i] == made_up_value(MADE_GAP, i, 1));
    if (item[i] < 0)
      ck_assert(isnan(second[i]));
    else
      ck_assert(second[i] == made_up_value(MADE_GAP, item[i], 2));
  }
}

TEST(group_names_with_slashes_and_twins_are_kept) {
  int dims[2];
  FOLDER(dir);
  MADE_UP *made = made_up_new(2, 2, 1);
  const char *kept[2] = {made->msh->group[1].name, made->msh->group[2].name};
  made->msh->group[1].name = "a/b";
  made->msh->group[2].name = "BODY"; /* also the name of the surface         */
  ck_assert_int_eq(write_file(made, dir, 1, 1), OK);
  double *x = dataset(dir, "/mesh/groups/a|b/nodes", dims);
  ck_assert_ptr_nonnull(x);
  free(x);
  x = dataset(dir, "/mesh/groups/BODY_1/nodes", dims);
  ck_assert_int_eq(dims[0], 3);
  free(x);
  made->msh->group[1].name = kept[0];
  made->msh->group[2].name = kept[1];
}

/* ---- kills ------------------------------------------------------------ */

/* The child acknowledges each increment by one byte in the pipe. */
static void child_run(const char *dir, int pipe_end, int expected) {
  made_up *made = made_up_new(2, 4, expected);
  output_options o = plain;
  hdf5_file *h = NULL;
  o.dir = dir;
  if (hdf5_open(&made->m, made->msh, &o, NULL, &h) != OK) _exit(1);
  for (int i = 1; i <= 1000; ++i) {
    made_up_advance(made, i);
    if (hdf5_increment(h, &made->s) != OK) _exit(1);
    if (write(pipe_end, "+", 1) != 1) _exit(1);
  }
  _exit(0);
}

/* Kill some microseconds after increment "until" was acknowledged (0: after
 * the start); the number of increments acknowledged. */
static int run_and_kill(const char *dir, int expected, int until,
                        long microseconds) {
  int ends[2], n = 0;
  char c;
  ck_assert_int_eq(pipe(ends), 0);
  pid_t pid = fork();
  ck_assert_int_ge(pid, 0);
  if (pid == 0) {
    close(ends[0]);
    child_run(dir, ends[1], expected);
  }
  close(ends[1]);
  struct timespec pause = {0, microseconds * 1000};
  while (n < until && read(ends[0], &c, 1) == 1) ++n;
  nanosleep(&pause, NULL);
  kill(pid, SIGKILL);
  waitpid(pid, NULL, 0);
  while (read(ends[0], &c, 1) == 1) ++n;
  close(ends[0]);
  return n;
}

TEST(killed_at_any_moment_keeps_every_acknowledged_increment) {
  int runs_with_results = 0, runs_grown = 0;
  MADE_UP *made = made_up_new(2, 4, 3);
  const int runs = getenv("PROTIS_POINTS") != NULL ? 60 : 18;
  for (int k = 0; k < runs; ++k) {
    FOLDER(dir);
    /* Small forecasts: some kills fall into the making of a larger file. */
    int expected = k % 2 ? 3 : 500;
    int n = run_and_kill(dir, expected, k % 30, 137 * k % 3000);
    if (n > 0) ++runs_with_results;
    if (n > expected) ++runs_grown;
    for (int i = 1; i <= n; i += i < n - 3 && n > 20 ? 7 : 1)
      increment_is(made, dir, i);
    int reached = count_reached(dir); /* perhaps one more than told          */
    ck_assert_int_ge(reached, n);
    if (reached > 0) increment_is(made, dir, reached);
  }
  ck_assert_int_ge(runs_with_results, runs - 2);
  ck_assert_int_ge(runs_grown, runs / 3);
}

/* ---- disks ------------------------------------------------------------ */

static int open_files(void) {
  int n = 0;
  DIR *d = opendir("/proc/self/fd");
  while (d != NULL && readdir(d) != NULL) ++n;
  if (d != NULL) closedir(d);
  return n;
}

/* In a child: the status of a run in a folder with files of at most "most"
 * bytes. */
static int run_with_limit(const char *dir, rlim_t most) {
  pid_t pid = fork();
  ck_assert_int_ge(pid, 0);
  if (pid == 0) {
    struct rlimit limit = {most, most};
    signal(SIGXFSZ, SIG_IGN);
    made_up *made = made_up_new(2, 4, 3);
    if (setrlimit(RLIMIT_FSIZE, &limit) != 0) _exit(99);
    int files = open_files();
    status st = write_file(made, dir, 20, 1);
    if (open_files() != files) _exit(97);
    int named = strstr(status_message(), "block.h5") != NULL &&
                strstr(status_message(), "unknown") == NULL;
    _exit(st == ERR_FILE && !named ? 98 : (int)st);
  }
  int code;
  waitpid(pid, &code, 0);
  return WIFEXITED(code) ? WEXITSTATUS(code) : 1000 + WTERMSIG(code);
}

static long size_of(const char *dir, const char *name) {
  struct stat info;
  PRINTED(path, "%s/%s", dir, name);
  return stat(path, &info) == 0 ? (long)info.st_size : -1;
}

/* The first increment tells nothing of how many there will be. */
TEST(adapted_increments_take_room_as_they_come) {
  char dir[64];
  MADE_UP *made = made_up_new(2, 4, 3);
  hdf5_file *h = NULL;
  output_options o = plain;
  o.dir = folder_new(dir);
  made->m.steps[0].visco.tolerance = 1e-3;
  made->m.steps[0].dt = 1e-12;
  made->m.steps[0].total = 1e20;
  made_up_advance(made, 1);
  made->s.dt = 1e-12;
  made->s.end_of_step = 0;
  ck_assert_int_eq(hdf5_open(&made->m, made->msh, &o, NULL, &h), OK);
  const long expected = size_of(dir, "block.h5");
  ck_assert_int_lt(expected, 1000000);
  for (int i = 1; i <= 200; ++i)
    ck_assert_int_eq(hdf5_increment(h, &made->s), OK);
  ck_assert_int_lt(size_of(dir, "block.h5"), 5 * expected);
  ck_assert_int_eq(hdf5_close(h, 1), OK);
  folder_remove(dir);
}

TEST(disk_full_at_any_size_is_told_and_loses_nothing) {
  char dir[64];
  int dims[2];
  MADE_UP *made = made_up_new(2, 4, 3);
  folder_new(dir);
  ck_assert_int_eq(run_with_limit(dir, RLIM_INFINITY), OK);
  long full = size_of(dir, "block.h5");
  folder_remove(dir);
  int failures = 0;
  for (long most = 0; most < full; most += full / 40) {
    folder_new(dir);
    int st = run_with_limit(dir, (rlim_t)most);
    ck_assert_msg(st == OK || st == ERR_FILE, "limit %ld: %d", most, st);
    if (st == ERR_FILE) ++failures;
    ck_assert_int_eq(size_of(dir, "block.h5.tmp"), -1);
    FREED double *t = dataset(dir, "/history/time", dims);
    if (t != NULL) /* the file of the forecast was made and has its rows     */
      for (int i = 1; i <= 3; ++i) increment_is(made, dir, i);
    folder_remove(dir);
  }
  ck_assert_int_gt(failures, 20);
}

static int put_text(const char *path, const char *text) {
  FILE *f = fopen(path, "w");
  if (f == NULL) return -1;
  fputs(text, f);
  return fclose(f);
}

/* A file system of its own with so many pages below dir, for this process and
 * its children; -1: not allowed on this machine. */
static int small_file_system(const char *dir, int pages) {
  PRINTED(user, "0 %d 1", (int)getuid());
  PRINTED(group, "0 %d 1", (int)getgid());
  if (syscall(SYS_unshare, CLONE_NEWUSER | CLONE_NEWNS) != 0) return -1;
  if (put_text("/proc/self/uid_map", user) != 0) return -1;
  if (put_text("/proc/self/setgroups", "deny") != 0) return -1;
  if (put_text("/proc/self/gid_map", group) != 0) return -1;
  PRINTED(size, "size=%dk", 4 * pages);
  return mount("none", dir, "tmpfs", 0, size);
}

enum { NOT_ALLOWED = 90, NOT_TOLD, LEFT_OPEN, LEFT_ASIDE, LOST };

/* In the child: what went wrong, or the status of the run. */
static int run_on_small_disk(made_up *made, const char *dir, int pages) {
  int dims[2];
  if (small_file_system(dir, pages) != 0) return NOT_ALLOWED;
  int files = open_files();
  status st = write_file(made, dir, 20, 1);
  if (st == ERR_FILE && strstr(status_message(), "No space left") == NULL)
    return NOT_TOLD;
  if (open_files() != files) return LEFT_OPEN;
  if (size_of(dir, "block.h5.tmp") != -1) return LEFT_ASIDE;
  double *t = dataset(dir, "/history/time", dims);
  int n = t == NULL ? 0 : count_reached(dir);
  free(t);
  if (t != NULL && n < 3) return LOST; /* what was expected has its room     */
  if (st == OK && n != 20) return LOST;
  for (int i = 1; i <= n; ++i) increment_is(made, dir, i);
  return (int)st;
}

TEST(full_file_system_of_any_size_is_told) {
  made_up *made = made_up_new(2, 16, 3); /* a field fills pages of its own */
  int code = 0, failures = 0, pages = 0;
  const int steps = getenv("PROTIS_POINTS") != NULL ? 5 : 4;
  for (; pages < 1500 && code != NOT_ALLOWED; pages += 1 + pages / steps) {
    FOLDER(dir);
    fflush(NULL);
    pid_t pid = fork();
    if (pid == 0) _exit(run_on_small_disk(made, dir, pages + 1));
    waitpid(pid, &code, 0);
    ck_assert_msg(WIFEXITED(code), "signal %d", WTERMSIG(code));
    code = WEXITSTATUS(code);
    ck_assert_msg(code == OK || code == ERR_FILE || code == NOT_ALLOWED,
                  "%d pages: %d", pages + 1, code);
    if (code == ERR_FILE) ++failures;
  }
  if (code == NOT_ALLOWED)
    fprintf(stderr, "no file system of its own on this machine\n");
  else
    ck_assert(failures > 15 && code == OK);
  made_up_free(made);
}

/* A file that takes nothing, or gives nothing back when it has to grow. */
TEST(failed_writes_and_copies_are_told) {
  FOLDER(dir);
  MADE_UP *made = made_up_new(2, 2, 2);
  output_options o = plain;
  o.dir = dir;
  const char *const devices[] = {"/dev/full", "/dev/null"};
  const char *const wanted[] = {"No space left", "read back"};
  for (int k = 0; k < 2; ++k) {
    hdf5_file *h = NULL;
    int files = open_files();
    ck_assert_int_eq(hdf5_open(&made->m, made->msh, &o, NULL, &h), OK);
    for (int i = 1; i <= 2 * k; ++i) {
      made_up_advance(made, i);
      ck_assert_int_eq(hdf5_increment(h, &made->s), OK);
    }
    int device = open(devices[k], O_RDWR);
    dup2(device, h->fd);
    close(device);
    made_up_advance(made, 2 * k + 1);
    ck_assert_int_eq(hdf5_increment(h, &made->s), ERR_FILE);
    ck_assert_ptr_nonnull(strstr(status_message(), wanted[k]));
    ck_assert_ptr_nonnull(strstr(status_message(), "block.h5"));
    hdf5_close(h, 0);
    ck_assert_int_eq(open_files(), files);
    ck_assert_int_eq(size_of(dir, "block.h5.tmp"), -1);
    ck_assert_int_eq(count_reached(dir), 2 * k);
  }
}

TEST(missing_folder_is_told) {
  MADE_UP *made = made_up_new(2, 1, 1);
  ck_assert_int_eq(write_file(made, "/no/such/folder", 1, 1), ERR_FILE);
  ck_assert_ptr_nonnull(strstr(status_message(), "/no/such/folder/block.h5"));
  ck_assert_ptr_nonnull(strstr(status_message(), "No such file"));
}

/* A run goes on after two of its rows, in its file alone. */
TEST(file_of_another_mesh_is_refused) {
  for (int cells = 2; cells <= 3; ++cells) {
    char dir[64];
    output_options o = plain;
    hdf5_file *h = NULL;
    MADE_UP *made = made_up_new(2, 2, 3), *now = made_up_new(2, cells, 3);
    o.dir = folder_new(dir);
    ck_assert_int_eq(write_file(made, dir, 3, 1), OK);
    const status st = hdf5_open(&now->m, now->msh, &o, &(hdf5_count){2, 2}, &h);
    ck_assert_int_eq(st, cells == 2 ? OK : ERR_FILE);
    ck_assert(st == OK || strstr(status_message(), "is not that of the run"));
    ck_assert_int_eq(hdf5_close(h, 0), OK);
    folder_remove(dir);
  }
}

/* ---- memory ----------------------------------------------------------- */

TEST(every_refused_request_is_told_and_leaves_nothing) {
  int refused = 0;
  FOLDER(dir);
  MADE_UP *made = made_up_new(2, 2, 2);
  ck_assert_int_eq(write_file(made, dir, 12, 1), OK);
  size_t bytes = memory_in_use();
  int files = open_files();
  for (long k = 1;; ++k) {
    long first = memory_requests();
    memory_refuse(k, 0);
    status st = write_file(made, dir, 12, 1);
    memory_refuse(0, 0);
    ck_assert_msg(st == OK || st == ERR_MEMORY, "%s", status_message());
    ck_assert_uint_eq(memory_in_use(), bytes);
    ck_assert_int_eq(open_files(), files);
    ck_assert_int_eq(size_of(dir, "block.h5.tmp"), -1);
    if (st == ERR_MEMORY) ++refused;
    if (memory_requests() - first < k) break;
  }
  ck_assert_int_gt(refused, 20);
}

UNIT_MAIN("hdf5")
