/*
 * src/contact/nonlocal.c: the law on surfaces of a mesh, closed forms of Hertz;
 * and every solver row on problems whose limit is an average (B not diagonal).
 */
#include "contact/friction.h"
#include "solver/fixed_point.h"
#include "support/grid.h"
#include "support/solver_rows.h"
#include "support/unit.h"

/* ---- solver rows -------------------------------------------------------- */

static double apart(const contact_case *c, const double *u) {
  double worst = 0.0, size = 0.0;
  for (int j = 0; j < c->cp.m; ++j) {
    worst = fmax(worst, fabs(c->u[j] - u[j]));
    size = fmax(size, fabs(u[j]));
  }
  return worst / size;
}

/* Every row must solve it and give the same answer. */
static void all_agree(contact_case *c, const char *what) {
  FREED double *u = calloc((size_t)c->cp.m, sizeof *u);
  case_cold(c);
  ck_assert_int_eq(solve_by(NULL, c, 1e-12, c->u, c->r).outcome, CONVERGED);
  memcpy(u, c->u, (size_t)c->cp.m * sizeof *u);
  EACH_SOLVER(i, ops) {
    if (!row_handles(ops, &c->cp)) continue;
    case_cold(c);
    solver_report rep = solve_by(ops, c, 1e-11, c->u, c->r);
    ck_assert_msg(rep.outcome == CONVERGED, "%s: %s: %s", what, row_name(ops),
                  outcome_text(rep.outcome));
    double v = case_violation(c, c->u, c->r), d = apart(c, u);
    ck_assert_msg(v <= 1e-9, "%s: %s: violation %g", what, row_name(ops), v);
    ck_assert_msg(d <= 1e-8, "%s: %s: apart by %g", what, row_name(ops), d);
  }
}

/* Moderate friction: one answer, and every row finds it. */
TEST(every_row_solves_averages) {
  static const double mus[] = {0.05, 0.2, 0.4};
  char what[40];
  for (int k = 0; k < 90; ++k) {
    int dim = 2 + k % 2, n = 2 + (k * 7) % 23;
    CONTACT_CASE c =
        case_any(dim, n, 0.5, k / 2 % 2, (unsigned long long)(4000 + k));
    case_average(&c, 1 + k % 7, mus[k % 3]);
    for (int i = 0; i < n && k % 5 == 0; ++i) c.g0[i] = 0.05 * (i % 3);
    snprintf(what, sizeof what, "problem %d", k);
    all_agree(&c, what);
  }
}

/* The block with open, slipping and sticking nodes. */
TEST(every_row_solves_the_block) {
  for (int reach = 1; reach <= 8; reach *= 2) {
    CONTACT_CASE c = case_published(32, 1.0);
    case_average(&c, reach, 0.8);
    all_agree(&c, "block");
  }
}

/* Large friction: AUTO answers, and who claims an answer has one. */
TEST(large_friction_on_averages) {
  static const double mus[] = {1.0, 2.0, 5.0, 50.0};
  const solver_ops *ops;
  for (int k = 0; k < 8; ++k) {
    CONTACT_CASE c = case_published(32, 1.0);
    case_average(&c, k % 2 ? 6 : 1, mus[k / 2]);
    for (int i = 0; solver_row(i, &ops); ++i) {
      case_cold(&c);
      solver_report rep = solve_by(ops, &c, 1e-11, c.u, c.r);
      if (ops == NULL)
        ck_assert_msg(rep.outcome == CONVERGED, "mu = %g: %s", mus[k / 2],
                      outcome_text(rep.outcome));
      if (rep.outcome != CONVERGED) continue;
      double v = case_violation(&c, c.u, c.r);
      ck_assert_msg(v <= 1e-9, "mu = %g: %s: violation %g", mus[k / 2],
                    row_name(ops), v);
    }
  }
}

/* The loop of AUTO along a friction path scales every entry of B. */
TEST(friction_path_follows_averages) {
  for (int k = 0; k < 3; ++k) {
    const solver_ops *ops = &newton_solver;
    double param[PARAM_SIZE / sizeof(double)] = {0.0};
    CONTACT_CASE c = case_published(32, 1.0);
    case_average(&c, 3, k == 0 ? 0.1 : 2.0 * k);
    FREED double *u = calloc((size_t)c.cp.m, sizeof *u);
    solver_report rep;
    OWNED void *work = NULL;
    OWNED friction_path *path = NULL;
    solver_control control = {.tol = 1e-11};
    ck_assert_int_eq(solve_by(NULL, &c, 1e-12, c.u, c.r).outcome, CONVERGED);
    memcpy(u, c.u, (size_t)c.cp.m * sizeof *u);
    option_defaults(ops->options, param);
    ck_assert_int_eq(solver_set_up(ops, &c.cp, param, &work), OK);
    ck_assert_int_eq(friction_path_new(&c.cp, &path), OK);
    inner_solver inner = {ops, param, work};
    case_cold(&c);
    ck_assert_int_eq(
        friction_path_solve(path, &c.cp, &inner, &control, c.u, c.r, &rep), OK);
    ck_assert_int_eq(rep.outcome, CONVERGED);
    ck_assert_double_lt(case_violation(&c, c.u, c.r), 1e-9);
    if (k == 0) ck_assert_double_lt(apart(&c, u), 1e-8);
  }
}

/* The same problem as a compliance. */
TEST(averages_in_compliance_form) {
  const solver_ops *ops;
  for (int k = 0; k < 10; ++k) {
    CONTACT_CASE c =
        case_any(2 + k % 2, 9, 0.3, 0, (unsigned long long)(4200 + k));
    case_average(&c, k < 6 ? 2 : 9, 0.3);
    size_t m = (size_t)c.cp.m;
    FREED double *W = calloc(m * m, sizeof *W), *q = calloc(m, sizeof *q),
                 *r = calloc(m, sizeof *r);
    ck_assert(case_inverse(c.cp.m, c.A, W));
    ck_assert_int_eq(solve_by(NULL, &c, 1e-12, c.u, c.r).outcome, CONVERGED);
    memcpy(r, c.r, m * sizeof *r);
    contact_product(c.cp.m, W, c.f, q);
    c.cp.W = W;
    c.cp.A = NULL;
    c.cp.f = q;
    for (int i = 0; solver_row(i, &ops); ++i) {
      if (!row_handles(ops, &c.cp)) continue;
      case_cold(&c);
      solver_report rep = solve_by(ops, &c, 1e-11, c.u, c.r);
      ck_assert_msg(rep.outcome == CONVERGED, "%s: %s", row_name(ops),
                    outcome_text(rep.outcome));
      for (size_t j = 0; j < m; ++j)
        ck_assert_double_eq_tol(c.r[j], r[j], 1e-7);
    }
  }
}

/* ---- the law on a surface ------------------------------------------------ */

/* The side BOTTOM of a grid in contact with a conforming obstacle. */
typedef struct scene {
  mesh *m;
  obstacle support;
  contact_pair pair;
  surface_input in;
  contact_surface *s;
  message_log *log;
  unsigned char *fixed;
  double *weight;
} scene;

static void scene_open(scene *c, mesh *m, double thickness, int axisymmetric) {
  memset(c, 0, sizeof *c);
  c->m = m;
  c->fixed = calloc((size_t)m->n_node, 1);
  c->weight = calloc((size_t)m->n_face, sizeof *c->weight);
  for (int i = 0; i < m->n_face; ++i) c->weight[i] = thickness;
  c->support = (obstacle){.name = "FLOOR", .shape = OBSTACLE_CONFORMING};
  c->pair = (contact_pair){.card = "*CONTACT",
                           .name = "FOOT",
                           .group = mesh_find_group(m, "BOTTOM"),
                           .support = &c->support};
  c->in = (surface_input){.mesh = m,
                          .n_pair = 1,
                          .pairs = &c->pair,
                          .fixed = c->fixed,
                          .face_weight = c->weight,
                          .axisymmetric = axisymmetric};
  ck_assert_int_eq(message_log_new(&c->log), OK);
  ck_assert_int_eq(surface_build(&c->in, c->log, &c->s), OK);
}

static void scene_close(scene *c) {
  memory_free(c->s);
  memory_free(c->log);
  free(c->fixed);
  free(c->weight);
  memory_free(c->m);
}

static void *law_options(const char *radius) {
  const friction_ops *law = &nonlocal_friction;
  char why[160];
  void *param = calloc(1, law->param_size);
  option_defaults(law->options, param);
  ck_assert_int_eq(option_read(option_find(law->options, "RADIUS"), radius,
                               param, why, sizeof why),
                   0);
  return param;
}

static sparse_rows average(scene *c, const friction_card *card) {
  sparse_rows G = {.n = 0};
  ck_assert_int_eq(
      nonlocal_friction.average(card, c->s, &c->in, 0, &c->pair.at, c->log, &G),
      OK);
  return G;
}

/* Forces in, limits out: with uniform pressure the limit of an inner node is
 * its force, whatever areas and thickness; the sum over all columns of mu times
 * the forces is what the mass at the nodes says. */
TEST(limit_of_uniform_pressure_is_the_force) {
  static const int cells[3] = {12, 12, 2};
  static const double length[3] = {1, 2, 0.5};
  for (int k = 0; k < 3; ++k) {
    scene c;
    mesh *m = k == 2 ? make_grid_3d((int[]){12, 1, 12}, (double[]){1, 0.2, 1})
                     : make_grid_2d(cells, length);
    scene_open(&c, m, k == 0 ? 2.5 : 1.0, k == 1);
    void *param = law_options("0.34");
    friction_card card = {.value.number = 0.5, .param = param};
    sparse_rows G = average(&c, &card);
    card.average = &G;
    friction_limit g;
    int *node = calloc((size_t)c.s->n, sizeof *node), inner = 0;
    for (int i = 0; i < c.s->n; ++i) node[i] = i;
    ck_assert_int_eq(friction_limit_new(c.s->n, &g), OK);
    ck_assert_int_eq(nonlocal_friction.limit(&card, c.s, c.s->n, node, 0, &g),
                     OK);
    for (int i = 0; i < c.s->n; ++i) {
      const double *x = c.s->x + c.s->dim * i;
      double limit = 0.0;
      int rim = x[0] > 0.65 || (k != 1 && x[0] < 0.35);
      if (k == 2) rim = rim || x[2] < 0.35 || x[2] > 0.65;
      for (int e = g.B.start[i]; e < g.B.start[i + 1]; ++e)
        limit += g.B.val[e] * 3.0 * c.s->area[g.B.col[e]];
      inner += !rim;
      if (rim)
        ck_assert(limit <= 1.5 * c.s->area[i] * (1 + 1e-12));
      else
        ck_assert_double_eq_tol(limit, 1.5 * c.s->area[i], 1e-13);
    }
    ck_assert_int_gt(inner, 2);
    ck_assert_ptr_null(g.in_zone);
    friction_limit_free(&g);
    sparse_free(&G);
    free(node);
    free(param);
    scene_close(&c);
  }
}

/* Separated points within rho carry friction too: however the pressure lies
 * inside, the total of the limits is mu times the total of the forces. */
TEST(total_limit_is_mu_times_the_force) {
  scene c;
  scene_open(&c, make_grid_2d((int[]){50, 1}, (double[]){5, 1}), 1.0, 0);
  void *param = law_options("0.7");
  friction_card card = {.value.number = 0.5, .param = param};
  sparse_rows G = average(&c, &card);
  for (int j = 15; j < 35; ++j) {
    double column = 0.0;
    for (int i = 0; i < c.s->n; ++i)
      for (int e = G.start[i]; e < G.start[i + 1]; ++e)
        if (G.col[e] == j) column += G.val[e];
    ck_assert_double_eq_tol(column, 1.0, 1e-13);
  }
  sparse_free(&G);
  free(param);
  scene_close(&c);
}

/* Hertz pressure sqrt(1 - x^2) on [-1, 1], friction in the contact only:
 * T/(mu P) and R(p) at its edge. */
TEST(hertz_pressure_has_its_closed_form) {
  static const char *const radius[] = {"0.02", "0.05", "0.1", "0.2", "0.5"};
  static const double total[] = {0.99962028, 0.99850253, 0.99578114, 0.98816209,
                                 0.95435634},
                      edge[] = {0.05391, 0.08498, 0.11955, 0.16726, 0.25564};
  const int N = unit_whole() ? 1600 : 800;
  for (int k = 0; k < 5; ++k) {
    scene c;
    scene_open(&c, make_grid_2d((int[]){2 * N, 1}, (double[]){4, 1}), 1.0, 0);
    FREED void *param = law_options(radius[k]);
    friction_card card = {.param = param};
    sparse_rows G = average(&c, &card);
    double T = 0.0, P = 0.0, at_edge = 0.0;
    for (int i = 0; i < c.s->n; ++i) {
      double x = c.s->x[2 * i] - 2.0, R = 0.0;
      for (int e = G.start[i]; e < G.start[i + 1]; ++e) {
        int j = G.col[e];
        double y = c.s->x[2 * j] - 2.0, p = sqrt(fmax(0.0, 1.0 - y * y));
        R += G.val[e] * p * c.s->area[j];
      }
      P += sqrt(fmax(0.0, 1.0 - x * x)) * c.s->area[i];
      double share = fabs(fabs(x) - 1.0) < 1e-9 ? 0.5 : fabs(x) < 1.0;
      T += share * R;
      if (share == 0.5) at_edge = R / c.s->area[i];
    }
    double h = 2.0 / N / strtod(radius[k], NULL);
    ck_assert_double_eq_tol(T / P, total[k], 2e-3 * h * h + 2e-5);
    ck_assert_double_eq_tol(at_edge, edge[k], 0.2 * edge[k] * h + 2e-5);
    sparse_free(&G);
    scene_close(&c);
  }
}

TEST(refused_memory_is_given_back) {
  scene c;
  scene_open(&c, make_grid_2d((int[]){8, 1}, (double[]){1, 1}), 1.0, 0);
  void *param = law_options("0.3");
  friction_card card = {.value.number = 0.5, .param = param};
  size_t before = memory_in_use();
  status st = ERR_MEMORY;
  for (long k = 1; st == ERR_MEMORY; ++k) {
    sparse_rows G = {.n = 0};
    memory_refuse(k, 0);
    st = nonlocal_friction.average(&card, c.s, &c.in, 0, &c.pair.at, c.log, &G);
    memory_refuse(0, 0);
    sparse_free(&G);
    ck_assert(st == OK || st == ERR_MEMORY);
    ck_assert_uint_eq(memory_in_use(), before);
    if (st == OK) ck_assert_int_gt(k, 20);
  }
  free(param);
  scene_close(&c);
}

UNIT_MAIN("nonlocal")
