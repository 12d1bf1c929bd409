/* src/base/box_tree: search of items near a point and along a line,
 * against all items one by one. */
#include "base/box_tree.h"
#include "support/unit.h"

TEST(search_finds_what_is_near) {
  enum { N = 300 };
  double x[6 * N];
  int found[N];
  unsigned seed = 3;
  for (int i = 0; i < 6 * N; ++i) {
    seed = seed * 1103515245u + 12345u;
    x[i] = (seed >> 16) / 65536.0 + (i / 6 % 7 == 0 ? i % 3 : 0);
  }
  for (int n = 0; n <= N; n += n < 12 ? 1 : 48) {
    box_tree t;
    ck_assert_int_eq(box_tree_new(3, n, 2, x, &t), OK);
    for (int q = 0; q < 50; ++q) {
      const double *p = x + 6 * (q * 5 % N);
      double r = 0.02 * q;
      int count = box_tree_near(&t, p, r, found), expected = 0;
      for (int i = 0; i < n; ++i) {
        double sum = 0.0;
        for (int c = 0; c < 3; ++c) {
          double a = fmin(x[6 * i + c], x[6 * i + 3 + c]);
          double b = fmax(x[6 * i + c], x[6 * i + 3 + c]);
          double d = fmax(fmax(a - p[c], p[c] - b), 0.0);
          sum += d * d;
        }
        expected += sum < r * r;
      }
      ck_assert_int_eq(count, expected);
    }
    RELEASE(t.item, t.of, t.box);
  }
}

/* Points as items: those between the planes of each slab, and on them, as many
 * of these numbers of three binary digits are. */
TEST(search_finds_what_is_along_a_beam) {
  enum { N = 400 };
  double x[3 * N];
  int found[N];
  unsigned seed = 5;
  for (int i = 0; i < 3 * N; ++i) {
    seed = seed * 1103515245u + 12345u;
    x[i] = (seed >> 29) / 8.0;
  }
  box_tree t;
  ck_assert_int_eq(box_tree_new(3, N, 1, x, &t), OK);
  for (int q = 0; q < 60; ++q) {
    box_beam b = {.n_slab = q % 4};
    for (int k = 0; k < b.n_slab; ++k) {
      for (int c = 0; c < 3; ++c) b.axis[k][c] = x[9 * q + 3 * k + c] - 0.5;
      b.low[k] = 0.5 * x[q + k] - 0.25;
      b.high[k] = b.low[k] + q / 64.0;
    }
    if (q % 5 == 1) { /* as thin as a point, which is in it */
      memcpy(b.axis[0], (double[]){1, 0, 0}, sizeof b.axis[0]);
      b.low[0] = b.high[0] = x[3 * q];
    }
    int expected = 0;
    for (int i = 0; i < N; ++i) {
      int inside = 1;
      for (int k = 0; k < b.n_slab; ++k) {
        double at = 0;
        for (int c = 0; c < 3; ++c) at += b.axis[k][c] * x[3 * i + c];
        inside &= at >= b.low[k] && at <= b.high[k];
      }
      expected += inside;
    }
    ck_assert_int_eq(box_tree_along(&t, &b, found), expected);
  }
  RELEASE(t.item, t.of, t.box);
}

UNIT_MAIN("box_tree")
