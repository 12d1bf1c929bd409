/*
 * What is derived from the forces and motions of the contact nodes, made once
 * more from the table CONTACT of all increments: works, slip distance and
 * direction, resultants and torques, loops. A plate and a block, turned as a
 * whole, above an obstacle that moves and turns, touch it and partly leave it.
 * The same runs stopped and gone on with.
 */
#include "support/grid.h"
#include "support/job.h"
#include "support/traced.h"
#include "support/turned_mesh.h"
#include "support/unit.h"

#include <signal.h>

enum { INCREMENTS = 10, NODES = 64 };
static const double mu = 0.4, angle_rate = 0.3;
static const turn whole_turn[] = {{{0, 0, 1}, 0.7}, {{0.48, 0.6, 0.64}, 1.1}};
static const double pivot[3] = {0.4, 0.1, 0.3}, axis_at[3] = {0.3, -0.4, 0.7};

/* Vectors of the scene in the turned one. */
static void turned(int dim, double x, double y, double z, double v[3]) {
  v[0] = x;
  v[1] = y;
  v[2] = z;
  turn_vector(&whole_turn[dim - 2], v);
}

/* Where MOVE has brought the obstacle by time t: up, along. */
static void moved_by(double t, double *up, double *along) {
  *up = 0.008 * fmin(4 * t, 1) - 0.006 * fmax(t - 1, 0);
  *along = 0.03 * sin(3 * fmax(t - 0.5, 0));
}

/* The axis of the torque, at[3] and a[3] of length 1: in the plane that of the
 * obstacle, which moves with it. */
static void torque_axis(int dim, double t, double at[3], double a[3]) {
  double up, along, length = 0;
  moved_by(t, &up, &along);
  if (dim == 2) {
    turned(2, pivot[0] + along, pivot[1] + up, 0, at);
    turned(2, 0, 0, 1, a);
  } else {
    turned(3, axis_at[0], axis_at[1], axis_at[2], at);
    turned(3, 2, -6, 3, a);
  }
  for (int c = 0; c < 3; ++c) length = hypot(length, a[c]);
  for (int c = 0; c < 3; ++c) a[c] /= length;
}

static void write_deck(const job *j, int dim) {
  double n[3], e[3], p[3], a[3], at[3], along[3];
  turned(dim, 0, dim == 2, dim == 3, n);
  turned(dim, 1, 0, 0, e);
  turned(dim, pivot[0], pivot[1], dim == 3 ? pivot[2] : 0, p);
  turned(dim, dim == 3 ? 0.005 : 0, dim == 3 ? -0.005 : 0, 1, a);
  turned(dim, axis_at[0], axis_at[1], axis_at[2], at);
  turned(dim, 2, -6, 3, along);
  char move[3][160], axis[240] = "", rotate[160] = "";
  for (int c = 0; c < 3; ++c)
    snprintf(move[c], sizeof move[c],
             "\"(0.008*min(4*t,1) - 0.006*max(t-1,0))*(%.17g) + "
             "0.03*sin(3*max(t-0.5,0))*(%.17g)\"",
             n[c], e[c]);
  if (dim == 3) {
    snprintf(axis, sizeof axis,
             "AXIS, %.17g, %.17g, %.17g, %.17g, %.17g, %.17g\n", at[0], at[1],
             at[2], along[0], along[1], along[2]);
    snprintf(rotate, sizeof rotate, ", %.17g, %.17g, %.17g, %.17g", p[2], a[0],
             a[1], a[2]);
  }
  job_write(
      j, "turned.inp",
      "*MESH, FILE=turned.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
      "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
      "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0., 0.\n%.17g, %.17g, %.17g\n"
      "MOVE, %s,\n%s%s%s\nROTATE, %.17g, %.17g%s, \"%s%g*max(t - 0.5, 0)\"\n"
      "*CONTACT, NAME=C, GROUP=FOOT, OBSTACLE=O, NORMAL=OBSTACLE\n"
      "%s*FRICTION, CONTACT=C, LAW=COULOMB\n%g\n"
      "*STEP\n*QUASISTATIC\n0.2, 2.\n*BOUNDARY\nHEAD, 1, %d\n"
      "*SOLVER, TOL=1E-13\n*RESTART\n"
      "*PRINT, CONTACT, ENERGY, TOTALS, LOOP, REACTIONS, ZONES\n*END STEP\n",
      n[0], n[1], n[2], move[0], move[1], dim == 3 ? ",\n" : "",
      dim == 3 ? move[2] : "", p[0], p[1], rotate, dim == 3 ? "" : "0.01*",
      angle_rate, axis, mu, dim);
}

/* Tributary areas of the nodes of the foot, in the order of their numbers. */
static void foot_areas(const mesh *m, double *area) {
  const int dim = m->dim;
  const mesh_group *g = mesh_find_group(m, dim == 3 ? "FRONT" : "BOTTOM");
  for (int k = 0; k < g->n_item; ++k) {
    const int *node = m->face + dim * g->item_id[k];
    const double *a = m->x + dim * node[0], *b = m->x + dim * node[1];
    const double *c = m->x + dim * node[dim - 1];
    const double whole = dim == 2 ? fabs(b[0] - a[0])
                                  : 0.5 * fabs((b[0] - a[0]) * (c[1] - a[1]) -
                                               (b[1] - a[1]) * (c[0] - a[0]));
    for (int i = 0; i < g->n_node; ++i)
      for (int v = 0; v < dim; ++v)
        if (g->node_id[i] == node[v]) area[i] += whole / dim;
  }
}

static job scene_new_job(int dim, double *area) {
  const int n2[] = {6, 2}, n3[] = {3, 3, 1};
  const double length2[] = {2, 1}, length3[] = {2, 1.5, 1};
  job j = job_begin("turned");
  OWNED mesh *m =
      dim == 3 ? make_grid_3d(n3, length3) : make_grid_2d(n2, length2);
  turned_mesh_write(&j, m, &whole_turn[dim - 2]);
  foot_areas(m, area);
  write_deck(&j, dim);
  return j;
}

/* One increment of the table CONTACT; components n, t1, t2. */
typedef struct node {
  double x[3], f[3], r[3], u[3], slip[2], distance, direction[3], status;
} node;

static double cell(const dat *d, int row, int dim, const char *name, int c) {
  static const char *const letters[] = {"x", "y", "z"};
  if (c >= dim) return 0;
  PRINTED(text, "%s%s", name, letters[c]);
  return dat_at(d, row, text);
}

/* In the plane a tangential column has no number. */
static double tangent(const dat *d, int row, int dim, const char *name,
                      const char *between, int a) {
  char text[40];
  if (a >= dim - 1) return 0;
  if (dim == 2)
    snprintf(text, sizeof text, "%s", name);
  else
    snprintf(text, sizeof text, "%s%s%d", name, between, a + 1);
  return dat_at(d, row, text);
}

static int read_nodes(const job *j, int dim, int k, node *p) {
  DAT d = job_table(j, "CONTACT", k);
  ck_assert_int_le(d.n_row, NODES);
  for (int i = 0; i < d.n_row; ++i, ++p) {
    for (int c = 0; c < 3; ++c) {
      p->x[c] = cell(&d, i, dim, "", c);
      p->f[c] = cell(&d, i, dim, "f_", c);
      p->direction[c] = cell(&d, i, dim, "slip_dir_", c);
    }
    p->u[0] = dat_at(&d, i, "u_n");
    p->r[0] = -dat_at(&d, i, "f_n");
    for (int a = 0; a < 2; ++a) {
      p->u[a + 1] = tangent(&d, i, dim, "u_t", "", a);
      p->r[a + 1] = tangent(&d, i, dim, "f_t", "", a);
      p->slip[a] = tangent(&d, i, dim, "slip", "_", a);
    }
    p->distance = dat_at(&d, i, "slip_distance");
    p->status = dat_at(&d, i, "status");
  }
  return d.n_row;
}

/* What adds up over the increments. */
typedef struct sums {
  double trapezoidal, end, normal, distance[NODES], way[NODES][2];
} sums;

static void add_increment(const node *old, const node *now, int n, sums *s) {
  for (int i = 0; i < n; ++i) {
    const node *a = &old[i], *b = &now[i];
    for (int c = 0; c < 3; ++c)
      s->normal += 0.5 * (a->r[c] + b->r[c]) * (b->u[c] - a->u[c]);
    for (int c = 0; c < 2; ++c) {
      double mean = 0.5 * (a->r[c + 1] + b->r[c + 1]);
      s->trapezoidal -= mean * b->slip[c];
      s->normal -= mean * b->slip[c];
      s->end -= b->r[c + 1] * b->slip[c];
      s->way[i][c] += b->u[c + 1] - a->u[c + 1] - b->slip[c];
    }
    if (b->status == 1) s->distance[i] += hypot(b->slip[0], b->slip[1]);
  }
}

#define NEAR(a, b, scale) ck_assert_double_eq_tol(a, b, 1e-10 * (scale))

/* Friction acts along the slip, against it: in space it is what the force has
 * beside its normal part. */
static void check_node(int dim, const node *p, double distance, double scale) {
  double n[3], t[3], size = 0;
  turned(dim, 0, dim == 2, dim == 3, n);
  for (int c = 0; c < 3; ++c) {
    t[c] = p->f[c] + p->r[0] * n[c];
    size = hypot(size, t[c]);
  }
  NEAR(size, hypot(p->r[1], p->r[2]), scale);
  NEAR(p->distance, distance, 1);
  for (int c = 0; c < 3; ++c)
    if (p->status == 1 && size > 1e-6 * scale)
      ck_assert_double_eq_tol(p->direction[c], -t[c] / size, 1e-6);
    else if (p->status != 1)
      ck_assert_double_eq(p->direction[c], 0);
}

static void check_works(const job *j, int k, const sums *s) {
  DAT e = job_table(j, "ENERGY", k), l = job_table(j, "LOOP", k);
  double scale = fmax(fabs(s->normal), s->end);
  NEAR(dat_at(&e, 0, "friction_work"), s->trapezoidal, scale);
  NEAR(dat_at(&e, 0, "friction_work_end"), s->end, scale);
  NEAR(dat_at(&e, 0, "normal_work"), s->normal, scale);
  NEAR(dat_at(&l, 0, "friction_work"), s->trapezoidal, scale);
  NEAR(dat_at(&l, 0, "friction_work_end"), s->end, scale);
  NEAR(dat_at(&l, 0, "loop_area"), s->end, scale);
  ck_assert_double_le(fabs(dat_at(&e, 0, "energy_defect_relative")), 1e-10);
}

/* All of the contact; of a loop the mean motions too. */
static void check_totals(const job *j, int dim, int k, const node *p, int n,
                         const double *area, double scale) {
  DAT t = job_table(j, "TOTALS", k);
  double f[3] = {0}, m[3] = {0}, r[3] = {0}, count[3] = {0}, closed = 0;
  double a[3], at[3], torque = 0;
  torque_axis(dim, 0.2 * (k + 1), at, a);
  for (int i = 0; i < n; ++i, ++p) {
    for (int c = 0; c < 3; ++c) {
      int d = (c + 1) % 3, e = (c + 2) % 3;
      f[c] += p->f[c];
      r[c] += p->r[c];
      m[c] += p->x[d] * p->f[e] - p->x[e] * p->f[d];
      torque +=
          a[c] * ((p->x[d] - at[d]) * p->f[e] - (p->x[e] - at[e]) * p->f[d]);
    }
    count[(int)p->status] += 1;
    if (p->status > 0) closed += area[i];
  }
  NEAR(dat_at(&t, 0, "normal"), -r[0], scale);
  NEAR(dat_at(&t, 0, "torque"), torque, scale);
  NEAR(dat_at(&t, 0, "closed_area"), closed, 1);
  for (int c = 0; c < dim; ++c)
    NEAR(cell(&t, 0, dim, "force_", c), f[c], scale);
  for (int c = 0; c < dim - 1; ++c)
    NEAR(tangent(&t, 0, dim, "tangential", "_", c), r[c + 1], scale);
  if (dim == 2) NEAR(dat_at(&t, 0, "moment_z"), m[2], scale);
  for (int c = 0; c < dim && dim == 3; ++c)
    NEAR(cell(&t, 0, dim, "moment_", c), m[c], scale);
  static const char *const word[] = {"open", "slip", "stick"};
  for (int c = 0; c < 3; ++c)
    ck_assert_double_eq(dat_at(&t, 0, word[c]), count[c]);
}

static void check_loop(const job *j, int dim, int k, const node *p, int n,
                       const double *area, const sums *s) {
  DAT l = job_table(j, "LOOP", k);
  double whole = 0, way[2] = {0}, u[2] = {0};
  for (int i = 0; i < n; ++i) {
    whole += area[i];
    for (int c = 0; c < 2; ++c) {
      way[c] += area[i] * s->way[i][c];
      u[c] += area[i] * p[i].u[c + 1];
    }
  }
  for (int c = 0; c < dim - 1; ++c) {
    NEAR(tangent(&l, 0, dim, "way", "_", c), way[c] / whole, 1);
    NEAR(tangent(&l, 0, dim, "mean_u_t", "", c), u[c] / whole, 1);
  }
  NEAR(dat_at(&l, 0, "angle"),
       (dim == 3 ? 1 : 0.01) * angle_rate * fmax(0.2 * (k + 1) - 0.5, 0), 1);
}

/* The zones cover the foot. */
static void check_zones(const job *j, int dim, int k) {
  NEAR(job_sum(j, "ZONES", k, "area"), dim == 2 ? 2 : 3, 1);
}

/* Nothing else acts on the body. */
static void check_balance(const job *j, int dim, int k, const node *p, int n,
                          double scale) {
  DAT d = job_table(j, "REACTIONS", k);
  for (int c = 0; c < dim; ++c) {
    double sum = 0;
    for (int i = 0; i < d.n_row; ++i) sum += cell(&d, i, dim, "reaction_", c);
    for (int i = 0; i < n; ++i) sum += p[i].f[c];
    NEAR(sum, 0, scale);
  }
}

/* The line of an increment in JOB.sta counts the nodes. */
static void check_counts(const job *j, int k, const node *p, int n) {
  char *sta = job_file(j, "sta"), *line = sta;
  int told[3], count[3] = {0};
  for (int i = 0; i <= k && line != NULL; ++i)
    if ((line = strchr(line, '\n')) != NULL) ++line;
  ck_assert_ptr_nonnull(line);
  ck_assert_int_eq(
      sscanf(line, "%*d %*d %*d %*s %*s %d %d %d", told, told + 1, told + 2),
      3);
  for (int i = 0; i < n; ++i) ++count[(int)p[i].status];
  for (int c = 0; c < 3; ++c) ck_assert_int_eq(told[c], count[c]);
  free(sta);
}

TESTS(results_are_those_of_the_nodes, 2) {
  const int dim = 2 + _i;
  static node nodes[INCREMENTS + 1][NODES];
  static sums sum;
  double area[NODES] = {0}, seen[3] = {0};
  int n = 0;
  memset(nodes, 0, sizeof nodes);
  memset(&sum, 0, sizeof sum);
  JOB j = scene_new_job(dim, area);
  CK_EXIT(job_run(&j, ""), 0, j);
  for (int k = 1; k <= INCREMENTS; ++k)
    n = read_nodes(&j, dim, k - 1, nodes[k]);
  for (int k = 1; k <= INCREMENTS; ++k) {
    const node *p = nodes[k];
    double scale = 0;
    for (int i = 0; i < n; ++i) scale += fabs(p[i].r[0]);
    add_increment(nodes[k - 1], p, n, &sum);
    check_works(&j, k - 1, &sum);
    check_totals(&j, dim, k - 1, p, n, area, scale);
    check_loop(&j, dim, k - 1, p, n, area, &sum);
    check_balance(&j, dim, k - 1, p, n, scale);
    check_zones(&j, dim, k - 1);
    check_counts(&j, k - 1, p, n);
    for (int i = 0; i < n; ++i) {
      check_node(dim, &p[i], sum.distance[i], scale);
      seen[(int)p[i].status] += 1;
    }
  }
  for (int c = 0; c < 3; ++c) ck_assert_double_gt(seen[c], 3);
}

UNIT_MAIN_FOR("derived", 10 * UNIT_SECONDS)
