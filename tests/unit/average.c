/* src/contact/average: kernels, search, rows of the nonlocal average. Expected
 * values: closed forms, and sums over dense regular points that share nothing
 * with the quadrature of the program. */
#include "contact/average/average.h"
#include "support/unit.h"

/* A patch that owns its arrays. */
typedef struct owned {
  average_patch p;
  double *x;
  int *face;
  unsigned char *active;
} owned;

static owned owned_new(int dim, int n_node, int n_face) {
  owned o = {.x = calloc((size_t)(dim * n_node), sizeof *o.x),
             .face = calloc((size_t)(dim * n_face), sizeof *o.face),
             .active = malloc((size_t)n_node)};
  memset(o.active, 1, (size_t)n_node);
  o.p = (average_patch){.dim = dim,
                        .n_node = n_node,
                        .n_face = n_face,
                        .x = o.x,
                        .face = o.face,
                        .active = o.active};
  return o;
}

static void owned_free(owned *o) {
  free(o->x);
  free(o->face);
  free(o->active);
}

/* n segments over [x0, x0 + length], the inner nodes moved by up to jitter/2 of
 * a segment. */
static owned line(int n, double x0, double length, double jitter) {
  owned o = owned_new(2, n + 1, n);
  unsigned seed = 7;
  for (int i = 0; i <= n; ++i) {
    seed = seed * 1103515245u + 12345u;
    double r = i > 0 && i < n ? (seed >> 16 & 1023) / 1023.0 - 0.5 : 0.0;
    o.x[2 * i] = x0 + length * (i + jitter * r) / n;
  }
  for (int i = 0; i < n; ++i) {
    o.face[2 * i] = i;
    o.face[2 * i + 1] = i + 1;
  }
  return o;
}

/* The unit square z = 0 in 2 n^2 triangles. */
static owned square(int n, double jitter) {
  owned o = owned_new(3, (n + 1) * (n + 1), 2 * n * n);
  unsigned seed = 11;
  int f = 0;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      double *x = o.x + 3 * (i + (n + 1) * j);
      int inside = i > 0 && i < n && j > 0 && j < n;
      for (int c = 0; c < 2; ++c) {
        seed = seed * 1103515245u + 12345u;
        double r = inside ? (seed >> 16 & 1023) / 1023.0 - 0.5 : 0.0;
        x[c] = ((c == 0 ? i : j) + jitter * r) / n;
      }
    }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      int a = i + (n + 1) * j, b = a + n + 1;
      const int corner[6] = {a, a + 1, b + 1, a, b + 1, b};
      for (int k = 0; k < 6; ++k) o.face[f++] = corner[k];
    }
  return o;
}

static sparse_rows build(const owned *o, kernel k, double radius,
                         int normalized, int geodesic, average_facts *facts) {
  const average_rule rule = {.kernel = k,
                             .radius = radius,
                             .normalized = normalized,
                             .geodesic = geodesic};
  average_facts other;
  sparse_rows G;
  ck_assert_int_eq(
      average_build(&o->p, &rule, &G, facts == NULL ? &other : facts), OK);
  return G;
}

static double entry(const sparse_rows *G, int i, int j) {
  for (int k = G->start[i]; k < G->start[i + 1]; ++k)
    if (G->col[k] == j) return G->val[k];
  return 0.0;
}

/* ---- kernels ----------------------------------------------------------- */

/* Sum of |z|^power w over a fine grid of the line: the trapezoidal rule, of
 * any order for the bump. */
static double line_moment(const mollifier *m, int power) {
  enum { STEPS = 200000 };
  double sum = 0.0;
  for (int i = -STEPS; i <= STEPS; ++i) {
    double z = m->radius * i / STEPS;
    sum += pow(fabs(z / m->radius), power) * mollifier_value(m, z * z);
  }
  return sum * m->radius / STEPS;
}

TEST(bump_has_the_constants_of_the_literature) {
  mollifier m = mollifier_make(KERNEL_BUMP, 2.5, 1);
  ck_assert_double_eq_tol(1.0 / (m.scale * 2.5), 0.44399381616808, 1e-13);
  ck_assert_double_eq_tol(line_moment(&m, 0), 1.0, 1e-12);
  ck_assert_double_eq_tol(line_moment(&m, 1), 0.33445399770998, 1e-10);
  ck_assert_double_eq_tol(line_moment(&m, 2), 0.15811363626380, 1e-12);
  m = mollifier_make(KERNEL_BUMP, 2.5, 2);
  ck_assert_double_eq_tol(1.0 / (m.scale * 2.5 * 2.5), 0.46651239317833, 1e-13);
}

/* c of the polynomial kernels: 1/c = integral of k. */
TEST(kernels_have_mass_one) {
  static const double line[] = {0, 1, 4.0 / 3, 2.0 / 3, 2},
                      disc[] = {0, 1.0 / 3, 0.5, 1.0 / 7, 1};
  for (int k = KERNEL_CONE; k < KERNEL_COUNT; ++k) {
    mollifier m = mollifier_make((kernel)k, 0.5, 1);
    ck_assert_double_eq_tol(m.scale * 0.5 * line[k], 1.0, 1e-13);
    m = mollifier_make((kernel)k, 0.5, 2);
    ck_assert_double_eq_tol(m.scale * 0.25 * acos(-1.0) * disc[k], 1.0, 1e-13);
  }
  for (int k = 0; k < KERNEL_COUNT; ++k) {
    mollifier m = mollifier_make((kernel)k, 0.5, 2);
    ck_assert_double_eq(mollifier_value(&m, 0.25), 0.0);
    ck_assert_double_eq(mollifier_value(&m, 7.0), 0.0);
    ck_assert(mollifier_value(&m, 0.2) > 0.0);
  }
}

/* ---- integrals over faces ---------------------------------------------- */

/* The same by a product of midpoint rules. */
static void triangle_by_sums(const mollifier *m, const double *a,
                             const double *x, double w[3]) {
  const int steps = unit_whole() ? 600 : 150;
  double n[3], area = 0.0;
  for (int c = 0; c < 3; ++c) {
    int d = (c + 1) % 3, e = (c + 2) % 3;
    n[c] = (a[3 + d] - a[d]) * (a[6 + e] - a[e]) -
           (a[3 + e] - a[e]) * (a[6 + d] - a[d]);
    area += 0.25 * n[c] * n[c];
  }
  area = sqrt(area) / (steps * steps);
  memset(w, 0, 3 * sizeof *w);
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < 2 * (steps - i) - 1; ++j) {
      double s[3], r2 = 0.0, third = j % 2 ? 2.0 / 3 : 1.0 / 3;
      s[1] = (i + third) / steps;
      s[2] = (j / 2 + third) / steps;
      s[0] = 1.0 - s[1] - s[2];
      for (int c = 0; c < 3; ++c) {
        double y = s[0] * a[c] + s[1] * a[3 + c] + s[2] * a[6 + c];
        r2 += (y - x[c]) * (y - x[c]);
      }
      for (int k = 0; k < 3; ++k) w[k] += area * s[k] * mollifier_value(m, r2);
    }
}

TEST(triangle_is_integrated_wherever_the_point_is) {
  static const double corner[9] = {0.1, 0.2, 0.3, 0.9, 0.1, 0.5, 0.4, 0.8, 0.1},
                      at[][3] = {{0.1, 0.2, 0.3}, {0.5, 0.4, 0.3},
                                 {0.5, 0.4, 0.6}, {0.0, 0.0, 0.0},
                                 {1.3, 0.0, 0.4}, {0.5, 0.15, 0.4},
                                 {0.2, 0.9, 0.2}, {9.0, 0.0, 0.0}};
  static const double radius[] = {0.2, 0.5, 3.0};
  for (int k = 0; k < KERNEL_COUNT; ++k)
    for (size_t q = 0; q < sizeof at / sizeof *at; ++q)
      for (int r = 0; r < 3; ++r) {
        mollifier m = mollifier_make((kernel)k, radius[r], 2);
        double w[3], v[3];
        face_triangle(&m, corner, at[q], w);
        triangle_by_sums(&m, corner, at[q], v);
        for (int c = 0; c < 3; ++c)
          ck_assert_msg(
              fabs(w[c] - v[c]) < (k == KERNEL_CONSTANT ? 1e-3 : 3e-5),
              "kernel %d, point %zu, radius %g: %.9g, %.9g", k, q, radius[r],
              w[c], v[c]);
      }
}

/* A ring against the triangles of the same annulus. */
TEST(ring_is_the_surface_of_revolution) {
  static const double meridian[4] = {0.6, 0.1, 0.9, 0.4};
  static const double at[][2] = {
      {0.6, 0.1}, {0.75, 0.2}, {0.0, 0.1}, {1.2, 0.5}};
  enum { SECTORS = 720, LAYERS = 8 };
  for (int k = 0; k < KERNEL_COUNT; ++k)
    for (int q = 0; q < 4; ++q) {
      mollifier m = mollifier_make((kernel)k, q == 2 ? 1.0 : 0.5, 2);
      double w[2], whole = 0.0, first = 0.0, part[3];
      const double x[3] = {at[q][0], 0.0, at[q][1]};
      face_ring(&m, m.radius, meridian, at[q], w);
      for (int s = 0; s < SECTORS * LAYERS; ++s)
        for (int half = 0; half < 2; ++half) {
          double corner[9], share[3];
          for (int c = 0; c < 3; ++c) {
            int l = s % LAYERS + (c == 2 - half), t = s / LAYERS + (c > 0) * 1;
            if (half == 1 && c == 2) l = s % LAYERS + 1, t = s / LAYERS;
            if (half == 1 && c == 1) l = s % LAYERS + 1, t = s / LAYERS + 1;
            double u = (double)l / LAYERS, a = 2 * acos(-1.0) * t / SECTORS;
            double r = (1 - u) * meridian[0] + u * meridian[2];
            corner[3 * c] = r * cos(a);
            corner[3 * c + 1] = r * sin(a);
            corner[3 * c + 2] = (1 - u) * meridian[1] + u * meridian[3];
            share[c] = 1 - u;
          }
          face_triangle(&m, corner, x, part);
          for (int c = 0; c < 3; ++c) {
            whole += part[c];
            first += share[c] * part[c];
          }
        }
      double tolerance = k == KERNEL_CONSTANT ? 3e-3 : 1e-4;
      ck_assert_msg(fabs(w[0] + w[1] - whole) < tolerance &&
                        fabs(w[0] - first) < tolerance,
                    "kernel %d, point %d: %.9g %.9g, %.9g %.9g", k, q,
                    w[0] + w[1], whole, w[0], first);
    }
}

/* ---- rows -------------------------------------------------------------- */

/* Part of the mass of the line kernel within [0, infinity[ of a point at x >= 0
 * from the edge. */
static double half_line(int k, double s) {
  if (s >= 1.0) return 1.0;
  switch (k) {
    case KERNEL_CONE:
      return 0.5 + s - 0.5 * s * s;
    case KERNEL_PARABOLA:
      return 0.5 + 0.75 * s - 0.25 * s * s * s;
    case KERNEL_WENDLAND:
      return 0.5 +
             1.5 * (s + s * s * s *
                            (-10.0 / 3 + s * (5 + s * (-3 + s * (2.0 / 3)))));
    default:
      return 0.5 + 0.5 * s;
  }
}

TEST(uniform_pressure_falls_to_one_half_at_an_edge) {
  static const double bump[] = {0.5, 0.7027446459, 0.8770327167, 0.9839947499,
                                1.0};
  for (int fine = 1; fine <= 8; fine *= 2)
    for (int k = 0; k < KERNEL_COUNT; ++k) {
      owned o = line(40 * fine, 0.0, 1.0, 0.0);
      sparse_rows G = build(&o, (kernel)k, 0.1, 0, 0, NULL);
      for (int q = 0; q <= 4; ++q) {
        double expected = k == KERNEL_BUMP ? bump[q] : half_line(k, q / 4.0);
        ck_assert_double_eq_tol(row_sum(&G, q * fine), expected, 4e-7);
        ck_assert_double_eq_tol(row_sum(&G, (40 - q) * fine), expected, 4e-7);
      }
      for (int i = 4 * fine; i <= 36 * fine; ++i)
        ck_assert_double_eq_tol(row_sum(&G, i), 1.0, 1e-13);
      sparse_free(&G);
      owned_free(&o);
    }
}

/* T/(mu p L) = 1 - m1 rho/L; the trapezoidal sum over the nodes errs by
 * 0.14 (h/rho)^2 rho/L. */
TEST(edges_lose_the_first_moment) {
  static const double ratio[] = {0.01, 0.05, 0.1, 0.2},
                      expected[] = {0.996655460, 0.983277300, 0.966554600,
                                    0.933109200};
  for (int q = 0; q < 4; ++q)
    for (int fine = 4; fine <= 16; fine *= 2) {
      int n = (int)(fine / ratio[q] + 0.5);
      owned o = line(n, 0.0, 3.0, 0.0);
      sparse_rows G = build(&o, KERNEL_BUMP, 3.0 * ratio[q], 0, 0, NULL);
      double total = 0.0;
      for (int i = 0; i <= n; ++i)
        total += row_sum(&G, i) * (i == 0 || i == n ? 0.5 : 1.0) / n;
      double error = 0.14 * ratio[q] / (fine * fine);
      ck_assert_double_eq_tol(total, expected[q], error + 1e-8);
      sparse_free(&G);
      owned_free(&o);
    }
}

/* Any mesh, any kernel: what the header promises. */
static void expect_sound(const owned *o, const double *share, int k,
                         double radius) {
  for (int normalized = 0; normalized < 2; ++normalized) {
    sparse_rows G = build(o, (kernel)k, radius, normalized, 0, NULL);
    for (int i = 0; i < G.n; ++i) {
      double sum = row_sum(&G, i);
      if (normalized) ck_assert_double_eq_tol(sum, 1.0, 1e-13);
      ck_assert(sum > 0.0 && sum < 1.0 + 1e-13);
      for (int e = G.start[i]; e < G.start[i + 1]; ++e) {
        int j = G.col[e];
        ck_assert(G.val[e] >= 0.0);
        ck_assert(e == G.start[i] || G.col[e - 1] < j);
        if (!normalized)
          ck_assert_double_eq_tol(share[i] * G.val[e],
                                  share[j] * entry(&G, j, i),
                                  1e-13 * (share[i] + share[j]));
      }
    }
    sparse_free(&G);
  }
}

TEST(rows_are_symmetric_by_mass_and_keep_constants) {
  const double ratio = unit_whole() ? 1.7 : 2.9;
  for (int k = 0; k < KERNEL_COUNT; ++k) {
    owned o = line(60, 0.0, 1.0, 0.9), s = square(unit_whole() ? 9 : 6, 0.7);
    double share[100] = {0.0};
    for (int f = 0; f < 60; ++f)
      for (int c = 0; c < 2; ++c)
        share[f + c] += 0.5 * (o.x[2 * f + 2] - o.x[2 * f]);
    for (double radius = 0.01; radius < 2.0; radius *= ratio)
      expect_sound(&o, share, k, radius);
    owned_free(&o);
    memset(share, 0, sizeof share);
    for (int f = 0; f < s.p.n_face; ++f) {
      const int *v = s.face + 3 * f;
      double *a = s.x + 3 * v[0], *b = s.x + 3 * v[1], *c = s.x + 3 * v[2];
      double area =
          0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
      for (int q = 0; q < 3; ++q) share[v[q]] += area / 3;
    }
    for (double radius = 0.05; radius < 1.0; radius *= 2.1)
      expect_sound(&s, share, k, radius);
    owned_free(&s);
  }
}

/* The second moment of a row inside, the curvature that friction sees: that of
 * the kernel and 1/6 h^2 of the P1 function. */
TEST(rows_have_the_second_moment_of_the_kernel) {
  static const double m2[] = {0.15811363626380, 1.0 / 6, 0.2, 1.0 / 14,
                              1.0 / 3};
  for (int k = 0; k < KERNEL_COUNT; ++k) {
    owned o = line(200, 0.0, 1.0, 0.0);
    sparse_rows G = build(&o, (kernel)k, 0.1, 0, 0, NULL);
    double sum = 0.0, mean = 0.0;
    for (int e = G.start[100]; e < G.start[101]; ++e) {
      double z = o.x[2 * G.col[e]] - o.x[200];
      mean += z * G.val[e];
      sum += z * z * G.val[e];
    }
    ck_assert_double_eq_tol(mean, 0.0, 1e-14);
    ck_assert_double_eq_tol(sum, m2[k] * 0.01 + 0.005 * 0.005 / 6, 1e-9);
    sparse_free(&G);
    owned_free(&o);
  }
}

/* In the plane the edge of a half plane sees the kernel of the disc, whose
 * part beyond a line at distance s is a one-dimensional integral. */
static double half_plane(const mollifier *m, double s) {
  const int steps = unit_whole() ? 1000 : 400;
  double sum = 0.0, h = 2.0 * m->radius / steps;
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < steps / 2; ++j) { /* y > 0 */
      double x = -m->radius + (i + 0.5) * h, y = (j + 0.5) * h;
      if (x > -s) sum += mollifier_value(m, x * x + y * y) * 2.0 * h * h;
    }
  return sum;
}

TEST(surface_loses_mass_at_its_edges) {
  owned o = square(16, 0.0);
  for (int k = 0; k < KERNEL_COUNT; ++k) {
    mollifier m = mollifier_make((kernel)k, 0.25, 2);
    sparse_rows G = build(&o, (kernel)k, 0.25, 0, 0, NULL);
    for (int i = 0; i < 4; i += 2)
      ck_assert_double_eq_tol(row_sum(&G, i + 17 * 8), half_plane(&m, i / 16.0),
                              2e-3);
    ck_assert_double_eq_tol(row_sum(&G, 17 * 8), 0.5, 1e-6);
    ck_assert_double_eq_tol(row_sum(&G, 0), 0.25, 1e-6);
    ck_assert_double_eq_tol(row_sum(&G, 4 + 17 * 8), 1.0, 1e-13);
    ck_assert_double_eq_tol(row_sum(&G, 8 + 17 * 8), 1.0, 1e-13);
    sparse_free(&G);
  }
  owned_free(&o);
}

/* Least distance of x from a face by dense regular points of it, m. */
static double face_sampled(const owned *o, int face, const double *x) {
  enum { STEPS = 8 };
  double least = HUGE_VAL;
  for (int i = 0; i <= STEPS; ++i)
    for (int j = 0; i + j <= STEPS; ++j) {
      const double s[3] = {(double)i / STEPS, (double)j / STEPS,
                           (double)(STEPS - i - j) / STEPS};
      double sum = 0.0;
      for (int c = 0; c < 3; ++c) {
        double y = -x[c];
        for (int k = 0; k < 3; ++k)
          y += s[k] * o->x[3 * o->face[3 * face + k] + c];
        sum += y * y;
      }
      least = fmin(least, sqrt(sum));
    }
  return least;
}

/* Least distance of node i from a face with a node that is left out, m. */
static double left_out_sampled(const owned *o, int i) {
  double least = HUGE_VAL;
  for (int f = 0; f < o->p.n_face; ++f) {
    const int *node = o->face + 3 * f;
    if (o->active[node[0]] && o->active[node[1]] && o->active[node[2]])
      continue;
    least = fmin(least, face_sampled(o, f, o->x + 3 * i));
  }
  return least;
}

/* On a cap of a sphere whose outer part is left out, a disc that keeps clear of
 * that part by 3 % of its radius is whole. */
TEST(disc_clear_of_nodes_left_out_is_whole) {
  enum { SIDE = 16, NODES = (SIDE + 1) * (SIDE + 1) };
  owned o = square(SIDE, 0.3);
  double clear[NODES];
  int whole = 0;
  for (int i = 0; i < o.p.n_node; ++i) {
    double *x = o.x + 3 * i, a = x[0] - 0.5, b = x[1] - 0.5;
    x[2] = 1.0 - sqrt(1.0 - a * a - b * b);
    o.active[i] = a * a + b * b < 0.16;
  }
  for (int i = 0; i < NODES; ++i) clear[i] = left_out_sampled(&o, i);
  for (int k = 0; k < KERNEL_COUNT; ++k)
    for (double radius = 0.2; radius < 0.3;
         radius += unit_whole() ? 0.02 : 0.06) {
      sparse_rows G = build(&o, (kernel)k, radius, 0, 0, NULL);
      for (int i = 0; i < o.p.n_node; ++i) {
        if (!o.active[i] || clear[i] < 1.03 * radius) continue;
        ck_assert_double_eq_tol(row_sum(&G, i), 1.0, 1e-13);
        ++whole;
      }
      sparse_free(&G);
    }
  ck_assert_int_gt(whole, 100);
  owned_free(&o);
}

/* A disc of radius 1 turned around its axis; far from the axis a ring is a
 * straight strip of the plane. */
TEST(axisymmetric_rows) {
  owned o = line(40, 0.0, 1.0, 0.0);
  o.p.axisymmetric = 1;
  sparse_rows G = build(&o, KERNEL_BUMP, 0.2, 0, 0, NULL);
  for (int i = 0; i <= 32; ++i)
    ck_assert_double_eq_tol(row_sum(&G, i), 1.0, 1e-13);
  for (int i = 33; i <= 40; ++i) ck_assert(row_sum(&G, i) < 1.0);
  ck_assert(row_sum(&G, 40) < 0.5);
  /* A pressure r^2 grows by the second moment in the plane: sum of y^2. */
  double moment = 0.0;
  for (int e = G.start[0]; e < G.start[1]; ++e)
    moment += G.val[e] * o.x[2 * G.col[e]] * o.x[2 * G.col[e]];
  ck_assert_double_eq_tol(moment, 2 * 0.1307 * 0.04, 0.02 * 0.04);
  sparse_free(&G);
  owned_free(&o);
  owned ring = line(20, 1e4, 1.0, 0.0), strip = square(20, 0.0);
  ring.p.axisymmetric = 1;
  sparse_rows R = build(&ring, KERNEL_BUMP, 0.3, 0, 0, NULL);
  sparse_rows S = build(&strip, KERNEL_BUMP, 0.3, 0, 0, NULL);
  for (int i = 0; i <= 20; ++i)
    ck_assert_double_eq_tol(row_sum(&R, i), row_sum(&S, i + 21 * 10), 1e-4);
  sparse_free(&R);
  sparse_free(&S);
  owned_free(&ring);
  owned_free(&strip);
}

/* ---- local limit ------------------------------------------------------- */

TEST(radius_below_the_mesh_is_local) {
  owned a = line(30, 0.0, 1.0, 0.5), b = square(8, 0.5),
        c = line(9, 0.0, 1.0, 0);
  double half[31]; /* of the faces has the pressure, which is local anyhow */
  for (int i = 0; i < 31; ++i) half[i] = 0.5;
  ck_assert_int_eq(a.p.n_node, 31);
  a.p.part = half;
  c.p.axisymmetric = 1;
  const owned *all[] = {&a, &b, &c};
  static const double radius[] = {1e-300, 1e-12, 1e-3, 0.01};
  for (int q = 0; q < 3; ++q)
    for (int r = 0; r < 4; ++r) {
      average_facts facts;
      sparse_rows G = build(all[q], KERNEL_BUMP, radius[r], 0, 0, &facts);
      ck_assert_int_eq(G.start[G.n], G.n);
      for (int i = 0; i < G.n; ++i) {
        ck_assert_int_eq(G.col[i], i);
        ck_assert_double_eq(G.val[i], 1.0);
      }
      ck_assert_int_eq(facts.n_local, G.n);
      ck_assert_int_eq(facts.n_coarse, G.n);
      sparse_free(&G);
    }
  owned_free(&a);
  owned_free(&b);
  owned_free(&c);
}

/* Whatever rounding makes of each edge. */
TEST(radius_of_an_edge_is_local) {
  owned o = line(10, 0.0, 1.0, 0.0);
  average_facts facts;
  sparse_rows G = build(&o, KERNEL_CONSTANT, 0.1, 0, 0, &facts);
  ck_assert_int_eq(facts.n_local, G.n);
  sparse_free(&G);
  G = build(&o, KERNEL_CONSTANT, 0.10001, 0, 0, &facts);
  ck_assert_int_eq(facts.n_local, 0);
  sparse_free(&G);
  owned_free(&o);
}

TEST(coarse_nodes_are_counted) {
  owned o = line(10, 0.0, 1.0, 0.0);
  average_facts facts;
  o.x[2 * 10] = 1.05; /* the last segment is 0.15 long */
  sparse_rows G = build(&o, KERNEL_BUMP, 0.4, 0, 0, &facts);
  ck_assert_double_eq_tol(facts.longest, 0.15, 1e-12);
  ck_assert_int_eq(facts.n_active, 11);
  ck_assert_int_eq(facts.n_coarse, 2);
  ck_assert_int_eq(facts.n_local, 0);
  sparse_free(&G);
  G = build(&o, KERNEL_BUMP, 0.12, 0, 0, &facts);
  ck_assert_int_eq(facts.n_coarse, 11);
  ck_assert_int_eq(facts.n_local, 1);
  ck_assert_double_eq(entry(&G, 10, 10), 1.0);
  ck_assert_double_eq(entry(&G, 9, 10), 0.0);
  sparse_free(&G);
  owned_free(&o);
}

/* ---- distances --------------------------------------------------------- */

/* A right angle: straight, the two sides see each other across the corner;
 * along the line it is as if there were no corner. A node left out is an edge.
 */
TEST(geodesic_distance_unbends_the_line) {
  owned flat = line(40, 0.0, 2.0, 0.0), bent = line(40, 0.0, 2.0, 0.0);
  for (int i = 21; i <= 40; ++i) {
    bent.x[2 * i + 1] = bent.x[2 * i] - 1.0;
    bent.x[2 * i] = 1.0;
  }
  for (int k = 0; k < KERNEL_COUNT; ++k) {
    sparse_rows F = build(&flat, (kernel)k, 0.3, 0, 0, NULL);
    sparse_rows G = build(&bent, (kernel)k, 0.3, 0, 1, NULL);
    sparse_rows S = build(&bent, (kernel)k, 0.3, 0, 0, NULL);
    ck_assert_int_eq(F.start[41], G.start[41]);
    for (int e = 0; e < F.start[41]; ++e)
      ck_assert_double_eq_tol(F.val[e], G.val[e], 1e-12);
    ck_assert(entry(&S, 17, 23) > entry(&G, 17, 23));
    ck_assert_double_eq_tol(row_sum(&S, 20), 1.0, 1e-13);
    sparse_free(&F);
    sparse_free(&G);
    sparse_free(&S);
  }
  bent.active[8] = 0;
  sparse_rows G = build(&bent, KERNEL_BUMP, 0.3, 0, 1, NULL);
  ck_assert_int_eq(G.start[9], G.start[8]);
  ck_assert_double_eq(entry(&G, 7, 8), 0.0);
  ck_assert(row_sum(&G, 7) < 0.95);
  ck_assert_double_eq_tol(row_sum(&G, 20), 1.0, 1e-13);
  sparse_free(&G);
  owned_free(&flat);
  owned_free(&bent);
}

/* Around a circle every row is the first one turned. */
TEST(closed_line_has_no_edge) {
  enum { N = 48 };
  owned o = owned_new(2, N, N);
  for (int i = 0; i < N; ++i) {
    o.x[2 * i] = cos(2 * acos(-1.0) * i / N);
    o.x[2 * i + 1] = sin(2 * acos(-1.0) * i / N);
    o.face[2 * i] = i;
    o.face[2 * i + 1] = (i + 1) % N;
  }
  static const double radius[] = {0.5, 1.9, 50.0};
  for (int geodesic = 0; geodesic < 2; ++geodesic)
    for (int r = 0; r < 3; ++r) {
      sparse_rows G = build(&o, KERNEL_BUMP, radius[r], 0, geodesic, NULL);
      for (int i = 0; i < N; ++i) {
        ck_assert_double_eq_tol(row_sum(&G, i), 1.0, 1e-13);
        for (int j = 0; j < N; ++j)
          ck_assert_double_eq_tol(entry(&G, i, j),
                                  entry(&G, 0, (j + N - i) % N), 1e-9);
      }
      if (radius[r] > 10.0)
        ck_assert_double_eq_tol(entry(&G, 3, 20), 1.0 / N, 1e-3);
      sparse_free(&G);
    }
  owned_free(&o);
}

/* ---- mirrors ----------------------------------------------------------- */

/* Half of a symmetric line or a quarter of a square with mirrors has the rows
 * of the whole, with the columns of the images added up. */
TEST(mirrors_stand_for_the_other_half) {
  enum { N = 12 };
  for (int k = 0; k < KERNEL_COUNT; ++k)
    for (int max = 0; max < 2; ++max) {
      owned whole = line(2 * N, -1.0, 2.0, 0.0);
      owned half = line(N, max ? -1.0 : 0.0, 1.0, 0.0);
      average_facts facts;
      sparse_rows W = build(&whole, (kernel)k, 0.4, 0, 0, NULL), H;
      const average_rule rule = {.kernel = (kernel)k,
                                 .radius = 0.4,
                                 .mirror = {max ? MIRROR_MAX : MIRROR_MIN}};
      ck_assert_int_eq(average_build(&half.p, &rule, &H, &facts), OK);
      int first = max ? 0 : N;
      for (int i = 0; i <= N; ++i)
        for (int j = 0; j <= N; ++j) {
          int a = first + i, b = first + j, image = 2 * N - b;
          double sum = entry(&W, a, b) + (b != image ? entry(&W, a, image) : 0);
          ck_assert_double_eq_tol(entry(&H, i, j), sum, 1e-9);
        }
      sparse_free(&W);
      sparse_free(&H);
      owned_free(&whole);
      owned_free(&half);
    }
}

TEST(quarter_of_a_square_has_no_edge_at_its_mirrors) {
  owned o = square(10, 0.4);
  average_facts facts;
  sparse_rows G;
  const average_rule rule = {.kernel = KERNEL_BUMP,
                             .radius = 0.35,
                             .mirror = {MIRROR_MIN, MIRROR_MAX}};
  ck_assert_int_eq(average_build(&o.p, &rule, &G, &facts), OK);
  for (int i = 0; i < G.n; ++i) {
    double x = o.x[3 * i], y = o.x[3 * i + 1], sum = row_sum(&G, i);
    if (x <= 0.65 && y >= 0.35)
      ck_assert_double_eq_tol(sum, 1.0, 1e-13);
    else
      ck_assert(sum < 1.0);
  }
  ck_assert_double_eq_tol(row_sum(&G, 10), 0.25, 1e-5);
  ck_assert_double_eq_tol(row_sum(&G, 0), 0.5, 1e-5);
  ck_assert_double_eq_tol(row_sum(&G, 120), 0.5, 1e-5);
  sparse_free(&G);
  owned_free(&o);
}

/* Points above a triangle and outside of it, in any unit. */
TEST(distance_of_a_face_is_to_its_foot_or_edge) {
  static const double at[][4] = {/* x, y, z, distance */
                                 {0.5, 0.5, 0.7, 0.7},  {0.5, 1.0, -0.2, 0.2},
                                 {-3.0, 1.0, 4.0, 5.0}, {1.0, -0.6, 0.8, 1.0},
                                 {5.0, 0.0, 4.0, 5.0},  {0.3, 0.4, 0.0, 0.0}};
  for (double size = 1e-3; size < 1e4; size *= 10) {
    const double corner[9] = {0, 0, 0, 2 * size, 0, 0, 0, 3 * size, 0};
    for (size_t k = 0; k < sizeof at / sizeof *at; ++k) {
      const double x[3] = {size * at[k][0], size * at[k][1], size * at[k][2]};
      ck_assert_double_eq_tol(face_distance(3, corner, x) / size, at[k][3],
                              1e-14);
    }
  }
}

/* ---- units ------------------------------------------------------------- */

TEST(factors_of_two_change_no_bit) {
  static const int powers[] = {40, -33, 3};
  for (int k = 0; k < KERNEL_COUNT; ++k)
    for (int q = 0; q < 3; ++q) {
      owned a = q == 1 ? square(7, 0.6) : line(30, 0.0, 1.0, 0.6);
      owned b = q == 1 ? square(7, 0.6) : line(30, 0.0, 1.0, 0.6);
      a.p.axisymmetric = b.p.axisymmetric = q == 2;
      for (int i = 0; i < b.p.dim * b.p.n_node; ++i)
        b.x[i] = ldexp(b.x[i], powers[q]);
      sparse_rows G = build(&a, (kernel)k, 0.3, 0, q == 0, NULL);
      sparse_rows H =
          build(&b, (kernel)k, ldexp(0.3, powers[q]), 0, q == 0, NULL);
      ck_assert_int_eq(G.start[G.n], H.start[H.n]);
      for (int e = 0; e < G.start[G.n]; ++e) {
        ck_assert_int_eq(G.col[e], H.col[e]);
        ck_assert_double_eq(G.val[e], H.val[e]);
      }
      sparse_free(&G);
      sparse_free(&H);
      owned_free(&a);
      owned_free(&b);
    }
}

/* ---- radius, memory ---------------------------------------------------- */

/* No entry jumps where the mass of a node no longer holds its pairs. */
TEST(entries_are_continuous_in_the_radius) {
  const int steps = unit_whole() ? 1000 : 150;
  owned o = square(3, 0.4);
  const int n = o.p.n_node;
  sparse_rows before = build(&o, KERNEL_BUMP, 0.4, 0, 0, NULL);
  double most = 0;
  for (int k = 1; k <= steps; ++k) {
    sparse_rows G = build(&o, KERNEL_BUMP, 0.4 + 0.0005 * k, 0, 0, NULL);
    for (int i = 0; i < n * n; ++i)
      most = fmax(most,
                  fabs(entry(&G, i / n, i % n) - entry(&before, i / n, i % n)));
    sparse_free(&before);
    before = G;
  }
  sparse_free(&before);
  owned_free(&o);
  ck_assert_double_le(most, 2e-3);
}

TEST(refused_memory_is_given_back) {
  owned o = line(20, 0.0, 1.0, 0.0);
  const average_rule rule = {
      .kernel = KERNEL_BUMP, .radius = 0.2, .geodesic = 1};
  sparse_rows G;
  average_facts facts;
  UNIT_REFUSED(20, average_build(&o.p, &rule, &G, &facts), sparse_free(&G));
  owned_free(&o);
}

UNIT_MAIN("average")
