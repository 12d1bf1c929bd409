/*
 * A contact group of more faces than those that face the obstacle: the whole
 * surface of a block gives the answer of its foot. Two blocks that are mirror
 * images, with a crack between them: each is one on a plane.
 */
#include "support/grid.h"
#include "support/inner_group.h"
#include "support/job.h"
#include "support/msh_write.h"
#include "support/unit.h"

const int job_without_fields = 1;

static int is_outer(const mesh *m, const int *node) {
  for (int f = 0; f < m->n_face; ++f) {
    int same = 0;
    for (int k = 0; k < m->dim; ++k)
      for (int l = 0; l < m->dim; ++l)
        same += m->face[m->dim * f + k] == node[l];
    if (same == m->dim && m->face_other[f] < 0) return 1;
  }
  return 0;
}

static int is_below(const mesh *m, const int *node) {
  for (int k = 0; k < m->dim; ++k)
    if (m->x[m->dim * node[k] + 1] > 1e-9) return 0;
  return 1;
}

static int is_at_zero(const mesh *m, const int *node) {
  return m->x[2 * node[0] + 1] == 0 && m->x[2 * node[1] + 1] == 0;
}

static void write_block(const job *j, int dim, double slant) {
  const double length[3] = {2, 1, 1};
  OWNED mesh *m = dim == 2 ? make_grid_2d((int[2]){8, 4}, length)
                           : make_grid_3d((int[3]){5, 3, 3}, length);
  ck_assert_ptr_nonnull(m);
  for (int i = 0; i < m->n_node; ++i)
    m->x[dim * i] += slant * (m->x[dim * i] - 1) * m->x[dim * i + 1];
  add_side_group(m, "ALL", is_outer);
  add_side_group(m, "FOOT", is_below);
  PRINTED(path, "%s/block.msh", j->dir);
  msh_write(path, m);
}

/* slant < 0: of revolution, and upright. */
static job run_block(int dim, double slant, const char *group,
                     const char *shape, const char *law) {
  job j = job_begin("facing");
  write_block(&j, dim, fmax(slant, 0));
  job_write(&j, "facing.inp",
            "*MESH, FILE=block.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M%s\n*OBSTACLE, NAME=O, %s\n"
            "*CONTACT, NAME=C, GROUP=%s, OBSTACLE=O\n"
            "*GOAL, NAME=FORCE, QUANTITY=FORCE, CONTACT=C\n"
            "*FRICTION, CONTACT=C, LAW=%s\n"
            "*STEP\n*QUASISTATIC\n0.5, 1.\n*BOUNDARY\n%sTOP, 2, %d\n"
            "*SOLVER, TOL=1E-13\n"
            "*PRINT, TOTALS, GOALS, ENERGY\n*END STEP\n",
            slant < 0 ? ", TYPE=CAX3" : "", shape, group, law,
            slant < 0 ? "LEFT, 1\n" : "TOP, 1, 1, 0.002\n", dim);
  const int code = job_run(&j, "");
  ck_assert_msg(code == 0, "%s: exit %d: %s", group, code, j.errors);
  return j;
}

static void compare(const job *a, const job *b, const char *table, int row,
                    const char *column) {
  DAT p = job_table(a, table, -1), q = job_table(b, table, -1);
  const double x = dat_at(&p, row, column), y = dat_at(&q, row, column);
  ck_assert_msg(fabs(x - y) <= 1e-9 * fabs(x), "%s: %.12g, foot %.12g", column,
                y, x);
}

static void compare_groups(int dim, double slant, const char *shape,
                           const char *law) {
  static const char *const column[] = {"normal", "closed_area", "pressure_max"};
  JOB a = run_block(dim, slant, "FOOT", shape, law);
  JOB b = run_block(dim, slant, "ALL", shape, law);
  for (int k = 0; k < 3; ++k) compare(&a, &b, "TOTALS", 0, column[k]);
  compare(&a, &b, "GOALS", 0, "error");
  compare(&a, &b, "ENERGY", 0, "strain_energy");
}

static const char plane[2][80] = {
    "TYPE=PLANE\n0., 0.\n0., 1.\nMOVE, 0., 0.01",
    "TYPE=PLANE\n0., 0., 0.\n0., 1., 0.\nMOVE, 0., 0.01, 0."};
static const char round_one[4][120] = {
    "TYPE=CYLINDER, RADIUS=1000\n0.3, -1000.\nMOVE, 0., 0.01",
    "TYPE=CYLINDER, RADIUS=1000\n0.3, -1000., 0.\n0., 0., 1.\n"
    "MOVE, 0., 0.01, 0.",
    "TYPE=CYLINDER, RADIUS=1000, SIDE=INSIDE\n1., 1000.\nMOVE, 0., 0.01",
    "TYPE=SPHERE, RADIUS=1000\n0.3, -1000., 0.2\nMOVE, 0., 0.01, 0."};

/* Upright and, of a trapezoid, by 10 degrees off. */
/* The whole surface has the axis, where there is no face. */
TEST(sides_of_a_body_of_revolution_neither) {
  compare_groups(2, -1, plane[0], "COULOMB\n0.3\n");
  compare_groups(2, -1, "TYPE=SPHERE, RADIUS=1000\n0., -1000.\nMOVE, 0., 0.01",
                 "COULOMB\n0.3\n");
}

TEST(sides_of_a_block_have_no_part_in_its_foot) {
  for (int dim = 2; dim <= 3; ++dim) {
    compare_groups(dim, 0.18, plane[dim - 2], "COULOMB\n0.3\n");
    compare_groups(dim, 0, plane[dim - 2], "TRESCA\n1.\n");
  }
  for (int c = 0; c < 4; ++c)
    compare_groups(2 + c % 2, 0.18 * (c / 2), round_one[c], "COULOMB\n0.3\n");
}

/* Cells above y = 0, and their mirror images below: diagonals alternate. */
static void write_mirrored(const job *j, int with_image) {
  const int below = with_image ? 4 : 0;
  OWNED mesh *m =
      make_grid_2d((int[2]){8, 4 + below}, (double[2]){2, 1 + below / 4});
  ck_assert_ptr_nonnull(m);
  for (int i = 0; i < m->n_node; ++i) m->x[2 * i + 1] -= 0.25 * below;
  add_side_group(m, "LINE", is_at_zero);
  PRINTED(path, "%s/block.msh", j->dir);
  msh_write(path, m);
}

static job run_mirrored(int with_image) {
  job j = job_begin("facing");
  write_mirrored(&j, with_image);
  job_write(&j, "facing.inp",
            "*MESH, FILE=block.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n%s"
            "*GOAL, NAME=FORCE, QUANTITY=FORCE, CONTACT=C\n"
            "*GOAL, NAME=PEAK, QUANTITY=PRESSURE, CONTACT=C, RADIUS=0.6\n"
            "1., 0.\n"
            "*STEP\n*STATIC\n*BOUNDARY\nTOP, 1\nTOP, 2, 2, \"-0.01*x\"\n%s"
            "*DSLOAD\nRIGHT, P, \"1+x\"\n"
            "*PRINT, GOALS\n*END STEP\n",
            with_image ? "*CRACK, NAME=C, GROUP=LINE\n"
                       : "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n"
                         "*CONTACT, NAME=C, GROUP=LINE, OBSTACLE=O\n",
            with_image ? "BOTTOM, 1\nBOTTOM, 2, 2, \"0.01*x\"\n" : "");
  CK_EXIT(job_run(&j, ""), 0, j);
  return j;
}

TEST(crack_between_mirror_images_is_a_plane) {
  JOB a = run_mirrored(0), b = run_mirrored(1);
  for (int goal = 0; goal < 2; ++goal) {
    compare(&a, &b, "GOALS", goal, "value");
    compare(&a, &b, "GOALS", goal, "error");
  }
}

UNIT_MAIN("facing")
