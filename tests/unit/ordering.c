/* src/fem/ordering.c: orders are permutations of few operations. */
#include "fem/ordering.h"

#include "support/scene.h"
#include "support/unit.h"

typedef struct setting {
  scene *s;
  stiffness *k;
  graph g;
  cholmod_common cm;
  int n, *node;
} setting;

static setting begin(mesh *m) {
  setting t = {.s = scene_new(m, m->dim == 2 ? PLANE_STRAIN : SOLID_3D, 1)};
  t.n = m->n_node;
  ck_assert_int_eq(stiffness_assemble(&t.s->d, &t.k), OK);
  ck_assert_int_eq(graph_of_unknowns(t.k, &t.g), OK);
  cholmod_l_start(&t.cm);
  t.node = calloc((size_t)t.n, sizeof *t.node);
  for (int i = 0; i < t.n; ++i) t.node[i] = i;
  return t;
}

static void end(setting *t) {
  free(t->node);
  graph_release(&t->g);
  cholmod_l_finish(&t->cm);
  memory_free(t->k);
  scene_free(t->s);
}

static void is_permutation(int n, const int *node) {
  FREED char *seen = calloc((size_t)n, 1);
  for (int i = 0; i < n; ++i) {
    ck_assert(node[i] >= 0 && node[i] < n && !seen[node[i]]);
    seen[node[i]] = 1;
  }
}

static status order_flops(const graph *g, int n, const int *node,
                          cholmod_common *cm, double *flops) {
  order_cost cost;
  status st = order_cost_of(g, n, node, NULL, cm, &cost);
  *flops = cost.flops;
  return st;
}

TEST(graph_has_both_directions_of_every_element_edge) {
  setting t = begin(make_grid_2d((int[]){2, 2}, (double[]){1, 1}));
  /* 9 nodes, 16 edges (12 sides of cells, 4 diagonals). */
  ck_assert_uint_eq(t.g.start[9], 32);
  for (int i = 0; i < 9; ++i)
    for (size_t p = t.g.start[i]; p < t.g.start[i + 1]; ++p) {
      int back = 0;
      const int j = t.g.next[p];
      for (size_t q = t.g.start[j]; q < t.g.start[j + 1]; ++q)
        back += t.g.next[q] == i;
      ck_assert_int_eq(back, 1);
    }
  end(&t);
}

TEST(every_method_gives_a_permutation_cheaper_than_the_natural_one) {
  setting t = begin(make_grid_2d((int[]){40, 40}, (double[]){1, 1}));
  double natural, flops;
  ck_assert_int_eq(order_flops(&t.g, t.n, t.node, &t.cm, &natural), OK);
  for (int m = ORDER_CUTS; m <= ORDER_AMD; ++m) {
    for (int i = 0; i < t.n; ++i) t.node[i] = i;
    ck_assert_int_eq(
        order_by((order_method)m, &t.g, 2, t.s->m->x, t.n, t.node, &t.cm), OK);
    is_permutation(t.n, t.node);
    ck_assert_int_eq(order_flops(&t.g, t.n, t.node, &t.cm, &flops), OK);
    ck_assert_double_lt(flops, natural / 2);
  }
  end(&t);
}

/* A path of n nodes from the left: each column holds 2 entries but the last:
 * 4 (n - 1) + 1 operations. */
TEST(count_of_a_path_is_exact) {
  setting t = begin(make_grid_2d((int[]){1, 1}, (double[]){1, 1}));
  int start_next[] = {1, 0, 2, 1, 3, 2};
  size_t start[] = {0, 1, 3, 5, 6};
  graph path = {.n = 4, .start = start, .next = start_next};
  double flops;
  ck_assert_int_eq(order_flops(&path, 4, (int[]){0, 1, 2, 3}, &t.cm, &flops),
                   OK);
  ck_assert_double_eq(flops, 13);
  end(&t);
}

/* Of the same path: the columns of a marked node and of those before it that
 * have an entry in its row, and all above. */
TEST(marked_nodes_reach_what_is_above_them) {
  setting t = begin(make_grid_2d((int[]){1, 1}, (double[]){1, 1}));
  int start_next[] = {1, 0, 2, 1, 3, 2};
  size_t start[] = {0, 1, 3, 5, 6};
  graph path = {.n = 4, .start = start, .next = start_next};
  const int node[] = {0, 1, 2, 3};
  order_cost cost;
  unsigned char mark[] = {1, 0, 0, 0};
  ck_assert_int_eq(order_cost_of(&path, 4, node, mark, &t.cm, &cost), OK);
  ck_assert_double_eq(cost.reached_entries, cost.entries);
  ck_assert_double_eq(cost.reached_flops, 13);
  ck_assert_double_eq(cost.marked_entries, 2);
  mark[0] = 0;
  mark[3] = 1;
  ck_assert_int_eq(order_cost_of(&path, 4, node, mark, &t.cm, &cost), OK);
  ck_assert_double_eq(cost.entries, 7);
  ck_assert_double_eq(cost.reached_entries, 3);
  ck_assert_double_eq(cost.reached_flops, 5);
  ck_assert_double_eq(cost.marked_entries, 1);
  end(&t);
}

TEST(squares_are_cut_and_bodies_that_cuts_do_not_suit_go_to_metis) {
  setting t = begin(make_grid_2d((int[]){60, 60}, (double[]){1, 1}));
  const char *name = NULL;
  double good, mended;
  unsigned seed = 1;
  ck_assert_int_eq(order_nodes(&t.g, 2, t.s->m->x, t.n, t.node, &t.cm, &name),
                   OK);
  ck_assert_str_eq(name, "coordinate cuts");
  ck_assert_int_eq(order_flops(&t.g, t.n, t.node, &t.cm, &good), OK);
  /* Coordinates that say nothing about the graph. */
  FREED double *x = calloc(2 * (size_t)t.n, sizeof *x);
  for (int i = 0; i < 2 * t.n; ++i) x[i] = scene_random(&seed);
  ck_assert_int_eq(order_nodes(&t.g, 2, x, t.n, t.node, &t.cm, &name), OK);
  ck_assert_str_eq(name, "METIS");
  is_permutation(t.n, t.node);
  ck_assert_int_eq(order_flops(&t.g, t.n, t.node, &t.cm, &mended), OK);
  ck_assert_double_lt(mended, 1.5 * good);
  end(&t);
}

/* A long strip rolled up: cuts cross all turns and still cost no more than a
 * square of as many nodes. */
TEST(rolled_strip_costs_less_than_a_square) {
  setting square = begin(make_grid_2d((int[]){60, 60}, (double[]){1, 1}));
  setting strip = begin(make_grid_2d((int[]){600, 5}, (double[]){60, 0.6}));
  const char *name = NULL;
  double a, b;
  for (int i = 0; i < strip.n; ++i) {
    double *x = strip.s->m->x + 2 * i;
    const double angle = x[0] / 2, r = 1 + 0.15 * angle + 0.8 * x[1];
    x[0] = r * cos(angle);
    x[1] = r * sin(angle);
  }
  ck_assert_int_eq(order_nodes(&square.g, 2, square.s->m->x, square.n,
                               square.node, &square.cm, &name),
                   OK);
  ck_assert_int_eq(order_nodes(&strip.g, 2, strip.s->m->x, strip.n, strip.node,
                               &strip.cm, &name),
                   OK);
  is_permutation(strip.n, strip.node);
  ck_assert_int_eq(
      order_flops(&square.g, square.n, square.node, &square.cm, &a), OK);
  ck_assert_int_eq(order_flops(&strip.g, strip.n, strip.node, &strip.cm, &b),
                   OK);
  ck_assert_double_lt(b, a);
  end(&square);
  end(&strip);
}

/* A strip of many nodes whose cells are stretched until it looks square: the
 * extents mislead, the separators do not. */
TEST(large_bodies_are_cut_where_the_separator_is_shortest) {
  setting t = begin(make_grid_2d((int[]){899, 229}, (double[]){4, 1}));
  double flops[2];
  for (int pass = 0; pass < 2; ++pass) {
    for (int i = 0; i < t.n; ++i) {
      t.node[i] = i;
      if (pass == 1) t.s->m->x[2 * i + 1] *= 4.1;
    }
    ck_assert_int_eq(
        order_by(ORDER_CUTS, &t.g, 2, t.s->m->x, t.n, t.node, &t.cm), OK);
    is_permutation(t.n, t.node);
    ck_assert_int_eq(order_flops(&t.g, t.n, t.node, &t.cm, &flops[pass]), OK);
  }
  ck_assert_double_lt(flops[1], 2 * flops[0]);
  end(&t);
}

UNIT_MAIN("ordering")
