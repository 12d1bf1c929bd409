/*
 * Obstacles that are in the body between its nodes. The stress of the bodies is
 * the same everywhere, so that nothing else is an error of the mesh: what it is
 * said to be gives the energy of what enters, which has a closed form in the
 * depth (E11/2 width depth^2, or force depth under forces alone).
 */
#include "support/block_file.h"
#include "support/job.h"
#include "support/msh_write.h"
#include "support/grid.h"
#include "support/unit.h"

const int job_without_fields = 1;

/* nu = 0.3 where it is not zero. */
static const double E11 = 1000.0 * 0.7 / (1.3 * 0.4);

#define MATERIAL(name, young, nu) \
  "*MATERIAL, NAME=" name "\n*ELASTIC\n" young ", " nu "\n"
#define OBSTACLE "*OBSTACLE, NAME=O, TYPE="
#define TOUCHES "\n*CONTACT, NAME=C, OBSTACLE=O, GROUP="
/* 0.02 deep at x = 0.3 or 1.3, and not at nodes. */
#define BUMP(x) "GAP\n\"0.03-0.05*exp(-50*(x-" x ")^2)\""

/* The energy of what enters over that of the stress. */
static double entered_share(job *j, const char *cards) {
  job_write(j, "block.inp",
            "*MESH, FILE=block.msh\n%s*ACCURACY, MESH=YES\n*END STEP\n", cards);
  CK_EXIT(job_run(j, ""), 0, *j);
  const double share = job_told(j, "mesh_error_percent") / 100;
  return share * share / (1.0 - share * share);
}

static double share_of_block(int two, const char *cards) {
  JOB j = job_begin("block");
  block_file_write(&j, (int[]){2, 2}, (double[]){2.0, 1.0}, two);
  return entered_share(&j, cards);
}

/* Layers 1 % shorter grow to the bump below; the energy is that of the material
 * there and of its thickness. */
TEST(bump_in_a_plane_layer) {
  const double depth = 0.02 + 0.3 / 0.7 * 0.01;
  const double stress = 0.5 * (1000 + 500) / 0.91 * 0.01 * 0.01;
  const double share = share_of_block(
      1, MATERIAL("H", "500.", "0.3") MATERIAL("M", "1000.", "0.3")
             "*SOLID SECTION, ELSET=UPPER, MATERIAL=H, THICKNESS=2.\n"
             "*SOLID SECTION, ELSET=BODY, MATERIAL=M, THICKNESS=2.\n" OBSTACLE
                 BUMP("0.3") TOUCHES
             "CONTACT\n*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\nTOP, 2\n"
             "SYMMETRY, 1, 1, -0.02\n");
  ck_assert_double_eq_tol(share, 0.5 * E11 * depth * depth / stress,
                          1e-6 * share);
}

/* A disk under pressure at its rim, between a wall that does not enter and the
 * bumps of two floors on its second ring of 1 to 2. */
static const char disk[] =
    MATERIAL("M", "1000.", "0.3")
    "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=CAX3\n"
    "*OBSTACLE, NAME=P, TYPE=PLANE\n3., 0.\n-1., 0.\n"
    OBSTACLE BUMP("1.3") TOUCHES "CONTACT\n*OBSTACLE, NAME=Q, TYPE=GAP\n"
    "\"0.04-0.06*exp(-50*(x-1.7)^2)\"\n"
    "*CONTACT, NAME=E, GROUP=CONTACT, OBSTACLE=Q\n"
    "*CONTACT, NAME=D, GROUP=SYMMETRY, OBSTACLE=P\n"
    "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\nTOP, 2\n*DSLOAD\nSYMMETRY, P, 10.\n";

TEST(bumps_in_a_disk) {
  const double q = 10, depth = 0.02 + 0.6 * q / 1000;
  const double share = share_of_block(0, disk);
  const double energy = 2 * 0.5 * E11 * 2 * M_PI * 1.5 * depth * depth;
  ck_assert_double_eq_tol(share, energy / (0.7 * q * q / 1000 * 4 * M_PI),
                          1e-6 * share);
}

/* A box of 2 x 1 x 3 that is pressed along x; the floor is two triangles, one
 * with a bump or both with one along x. */
TEST(bumps_in_a_box) {
  const double q = 10, depth = 0.02 + 0.3 * q / 1000;
  for (int n = 1; n <= 2; ++n) {
    JOB j = job_begin("block");
    OWNED mesh *m = make_grid_3d((int[]){1, 1, 1}, (double[]){2.0, 1.0, 3.0});
    PRINTED(path, "%s/block.msh", j.dir);
    msh_write(path, m);
    PRINTED(cards,
            MATERIAL("M", "1000.",
                     "0.3") "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n" OBSTACLE
                            "GAP\n\"0.03-0.05*exp(-50*(z-0.9)^2%s)\"" TOUCHES
                            "BOTTOM\n*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\nTOP, "
                            "2\nFRONT, 3\n"
                            "*DSLOAD\nRIGHT, P, 10.\n",
            n == 1 ? "-50*(x-1.3)^2" : "");
    const double share = entered_share(&j, cards);
    const double energy = n * 0.5 * E11 * sqrt(3.0) * depth * depth;
    ck_assert_double_eq_tol(share, energy / (0.5 * q * q / 1000 * 6),
                            1e-6 * share);
  }
}

/* A block under pressure on its three nodes; energy: J. */
static void check_pressed(const char *gap, const char *more, const char *step,
                          double energy) {
  PRINTED(cards,
          MATERIAL("M", "1000.",
                   "0.") "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n" OBSTACLE
                         "GAP\n\"%s\"" TOUCHES
                         "CONTACT\n%s*STEP\n%s*DSLOAD\nTOP, P, 1.\n",
          gap, more, step);
  const double share = share_of_block(0, cards);
  ck_assert_double_eq_tol(share, energy / (0.5 / 1000 * 2),
                          1e-6 * share + 1e-12);
}

/* A bump below each edge: forces do no more work than they have. Wear takes as
 * much off the body between the nodes as there. */
TEST(bumps_below_a_block_that_contact_holds) {
  check_pressed("-0.01*sin(pi*x)^2", "", "*STATIC\n*BOUNDARY\nLEFT, 1\n",
                2 * 2.0 * 0.01);
  check_pressed("-0.01*sin(pi*x)^2", "*WEAR, CONTACT=C, COEFFICIENT=0.01\n",
                "*QUASISTATIC\n0.5, 1.\n*BOUNDARY\nLEFT, 1, 1, 0.1\n"
                "TOP, 1, 1, 0.1\n",
                2 * 2.0 * 0.01);
}

/* A support holds it, which has a node 0.003 in the obstacle: that is no error
 * of the edge next to it. */
TEST(bumps_below_a_block_that_supports_hold) {
  double depth = 0.0;
  for (double x = 0.0; x < 1.0; x += 1e-5)
    depth = fmax(depth, 0.01 * pow(sin(M_PI * x), 2) + 0.003 * (x - 1.0));
  check_pressed("0.1-0.01*sin(pi*x)^2-0.003*exp(-900*x^2)", "",
                "*STATIC\n*BOUNDARY\nLEFT, 1\nLEFT, 2, 2, \"-0.1-0.001*y\"\n",
                0.5 * 1000 * (depth * depth + 0.01 * 0.01));
}

/* Under a given force the nodes are in the obstacle too. */
TEST(given_forces_enter_without_an_error) {
  check_pressed("-0.01*sin(pi*x)^2", "*CONTACT FORCE, CONTACT=C\n1.\n",
                "*STATIC\n*BOUNDARY\nLEFT, 1\nTOP, 2\n", 0.0);
}

/* ---- round floors ---------------------------------------------------------
 */

enum { CHORD = 1, HOLLOW = 2 }; /* a cylinder; a body */
static const double R = 4.0, TURN = 0.25, Q = 5.0, TALL = 2.0;

typedef struct floor_case {
  double x[2][2], n[2][2]; /* of the ends of the first edge */
  double out[2];           /* from its middle to that of the arc */
  double at[2];            /* middle of the bump or centre of the obstacle */
} floor_case;

/* Along a unit vector from x to a circle of radius 1. */
static double circle_from(const double *x, const double *n, const double *at) {
  double along = 0.0, square = -1.0;
  for (int c = 0; c < 2; ++c) {
    along += (at[c] - x[c]) * n[c];
    square += (at[c] - x[c]) * (at[c] - x[c]);
  }
  return along - sqrt(along * along - square);
}

/* How deep the obstacle is at a part b of the edge, in the body under the
 * pressure Q. */
static double depth_at(const floor_case *f, int kind, double b) {
  double free = 0.0, x[2] = {0.0}, n[2] = {0.0};
  for (int c = 0; c < 2; ++c) {
    for (int i = 0; i < 2; ++i) {
      const double part = i == 0 ? 1.0 - b : b;
      x[c] += part * f->x[i][c];
      n[c] += part * f->n[i][c];
      free += part * f->n[i][c] * Q / 1000 * (f->x[i][c] - (c == 1) * TALL);
    }
    if (!(kind & CHORD)) x[c] += 4 * b * (1 - b) * f->out[c];
  }
  const double size = hypot(n[0], n[1]);
  const double away = hypot(x[0] - f->at[0], x[1] - f->at[1]);
  for (int c = 0; c < 2; ++c) n[c] /= size;
  return (kind & CHORD ? -circle_from(x, n, f->at)
                       : 0.05 * exp(-200 * away * away) - 0.03) -
         free;
}

/* The floor is two chords of an arc from its axis of symmetry on. */
static double floor_mesh(const job *j, int kind, floor_case *f) {
  OWNED mesh *m = make_grid_2d((int[]){2, 1}, (double[]){2.0, TALL});
  const double way = kind & HOLLOW ? -1.0 : 1.0;
  double area = 0.0, high[3];
  for (int i = 0; i < 3; ++i) {
    m->x[2 * i] = m->x[2 * i + 6] = R * sin(i * TURN);
    m->x[2 * i + 1] = high[i] = way * R * (1 - cos(i * TURN));
  }
  for (int i = 0; i < 2; ++i) {
    area += (m->x[2 * i + 2] - m->x[2 * i]) *
            (TALL - 0.5 * (high[i] + high[i + 1]));
    COPY(f->x[i], m->x + 2 * i, 2);
    f->n[i][0] = way * sin(i * TURN);
    f->n[i][1] = -cos(i * TURN);
  }
  for (int c = 0; c < 2; ++c) {
    f->at[c] = c == 0 ? R * sin(TURN / 2) : way * R * (1 - cos(TURN / 2));
    f->out[c] = f->at[c] - 0.5 * (f->x[0][c] + f->x[1][c]);
  }
  PRINTED(path, "%s/block.msh", j->dir);
  msh_write(path, m);
  return area;
}

/* Of one floor; the obstacle enters its chord by 0.02 or its arc. */
static void check_floor(int kind) {
  JOB j = job_begin("block");
  floor_case f;
  char obstacle[200];
  const double area = floor_mesh(&j, kind, &f);
  double depth = 0.0;
  if (kind & CHORD) {
    f.at[0] += -f.out[0] + 0.98 * sin(TURN / 2) * (kind & HOLLOW ? -1 : 1);
    f.at[1] += -f.out[1] - 0.98 * cos(TURN / 2);
    /* Beside the plane of symmetry it has no image: the normal is the edge's.
     */
    f.n[0][0] = sin(TURN / 2);
    f.n[0][1] = -cos(TURN / 2);
    snprintf(obstacle, sizeof obstacle,
             "CYLINDER, RADIUS=1.\n%.17g, %.17g\nMOVE, \"0*t\", 0.", f.at[0],
             f.at[1]);
  } else {
    snprintf(obstacle, sizeof obstacle,
             "GAP\n\"0.03-0.05*exp(-200*((x-%.17g)^2+(y-%.17g)^2))\"", f.at[0],
             f.at[1]);
  }
  PRINTED(cards,
          MATERIAL("M", "1000.",
                   "0.") "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n" OBSTACLE
                         "%s" TOUCHES
                         "BOTTOM\n*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\nTOP, 2\n"
                         "*DSLOAD\nBOTTOM, P, 5.\nRIGHT, P, 5.\n",
          obstacle);
  for (double b = 0.0; b < 1.0; b += 1e-5)
    depth = fmax(depth, depth_at(&f, kind, b));
  if (kind == (CHORD | HOLLOW)) depth = 0.0;
  const double share = entered_share(&j, cards);
  const double right = 0.5 * 1000 * depth * depth / (Q * Q / 1000 * area);
  ck_assert_msg(fabs(share - right) <= 1e-6 * right + 1e-12, "%d: %g for %g",
                kind, share, right);
}

/* A formula is at the arc that the edge stands for, a cylinder at the edge,
 * which passes it where the body is hollow. */
TEST(obstacles_below_round_floors) {
  for (int kind = 0; kind < 4; ++kind) check_floor(kind);
}

UNIT_MAIN("entered")
