/* src/contact/friction.c, none.c, tresca.c, coulomb.c: every law of the list.
 */
#include "contact/friction.h"
#include "support/unit.h"

enum { N = 5 };

/* Five contact nodes on a line; the third is a corner. */
typedef struct line {
  contact_surface s;
  int contact_id[N], side_id[N];
  size_t node_no[N];
  double x[2 * N], area[N];
} line;

static void line_init(line *l) {
  static const double area[N] = {0.5, 1, 1, 2, 0.25};
  memset(l, 0, sizeof *l);
  for (int i = 0; i < N; ++i) {
    l->side_id[i] = i == 2 ? 1 : -1;
    l->node_no[i] = (size_t)(100 + i);
    l->x[2 * i] = i;
    l->area[i] = area[i];
  }
  l->s = (contact_surface){.dim = 2,
                           .n = N,
                           .contact_id = l->contact_id,
                           .side_id = l->side_id,
                           .node_no = l->node_no,
                           .x = l->x,
                           .area = l->area};
}

static status apply(const friction_ops *law, const friction_card *card,
                    const line *l, double t, friction_limit *out) {
  static const int node[] = {0, 2, 3, 4};
  return law->limit(card, &l->s, 4, node, t, out);
}

static void expect_sound(const friction_ops *law, const friction_limit *g) {
  for (int i = 0; i < N; ++i) {
    ck_assert(g->g0[i] >= 0);
    if (g->B.start == NULL) continue;
    ck_assert_msg(g->g0[i] == 0, "%s: a limit without pressure", law->name);
    for (int k = g->B.start[i]; k < g->B.start[i + 1]; ++k) {
      ck_assert(g->B.val[k] >= 0);
      ck_assert(g->B.col[k] >= 0 && g->B.col[k] < N);
      ck_assert(k == g->B.start[i] || g->B.col[k - 1] < g->B.col[k]);
    }
  }
  ck_assert_double_eq(g->g0[1] + row_sum(&g->B, 1), 0);
  ck_assert_double_eq(g->g0[2] + row_sum(&g->B, 2), 0);
}

TEST(every_law_is_sound) {
  line l;
  line_init(&l);
  for (int k = 0; friction_list[k] != NULL; ++k) {
    const friction_ops *law = friction_list[k];
    void *param = memory_new(1, law->param_size + 1);
    friction_card card = {.value.number = 0.3, .param = param};
    friction_limit g;
    if (law->param_size > 0) option_defaults(law->options, param);
    ck_assert(law->reference[0] != 0 && law->help[0] != 0);
    ck_assert_ptr_eq(friction_find(law->name), law);
    ck_assert_int_eq(friction_limit_new(N, &g), OK);
    ck_assert_int_eq(apply(law, &card, &l, 0, &g), OK);
    expect_sound(law, &g);
    int has_limit = g.g0[0] + row_sum(&g.B, 0) > 0;
    ck_assert_int_eq(has_limit, law->value_name != NULL);
    friction_limit_free(&g);
    memory_free(param);
  }
}

TEST(wrong_value_names_node_and_time) {
  static const double wrong[] = {-0.1, NAN, HUGE_VAL};
  line l;
  line_init(&l);
  for (int k = 0; friction_list[k] != NULL; ++k) {
    const friction_ops *law = friction_list[k];
    if (law->value_name == NULL || law->param_size > 0) continue;
    for (int w = 0; w < 3; ++w) {
      friction_card card = {.value.number = wrong[w]};
      friction_limit g;
      ck_assert_int_eq(friction_limit_new(N, &g), OK);
      ck_assert_int_eq(apply(law, &card, &l, 2.5, &g), ERR_DECK);
      ck_assert_ptr_nonnull(strstr(status_message(), "node 100"));
      ck_assert_ptr_nonnull(strstr(status_message(), "2.5"));
      friction_limit_free(&g);
    }
  }
}

TEST(name_is_found_in_full_and_in_any_case) {
  ck_assert_ptr_eq(friction_find("coulomb"), &coulomb_friction);
  ck_assert_ptr_eq(friction_find("None"), &none_friction);
  ck_assert_ptr_null(friction_find("COUL"));
  ck_assert_ptr_null(friction_find(""));
}

TEST(tresca_limit_is_traction_times_area) {
  line l;
  friction_limit g;
  friction_card card = {0};
  OWNED expression *e = NULL;
  int column;
  line_init(&l);
  ck_assert_int_eq(expression_compile("10*x + t", NULL, NULL, &e, &column), OK);
  card.value.formula = e;
  ck_assert_int_eq(friction_limit_new(N, &g), OK);
  ck_assert_int_eq(apply(&tresca_friction, &card, &l, 4, &g), OK);
  ck_assert_double_eq(g.g0[0], 4 * 0.5);
  ck_assert_double_eq(g.g0[1], 0);
  ck_assert_double_eq(g.g0[2], 0);
  ck_assert_double_eq(g.g0[3], 34 * 2.0);
  ck_assert_double_eq(g.g0[4], 44 * 0.25);
  ck_assert_ptr_null(g.B.start);
  friction_limit_free(&g);
}

/* Two cards on one surface: each fills its own rows, whatever the order. */
TEST(coulomb_cards_share_one_matrix) {
  static const int some[] = {4, 1}, others[] = {3};
  line l;
  friction_limit g;
  friction_card low = {.value.number = 0.25}, high = {.value.number = 1.5};
  line_init(&l);
  ck_assert_int_eq(friction_limit_new(N, &g), OK);
  ck_assert_int_eq(coulomb_friction.limit(&low, &l.s, 2, some, 0, &g), OK);
  ck_assert_int_eq(coulomb_friction.limit(&high, &l.s, 1, others, 0, &g), OK);
  static const double mu[N] = {0, 0.25, 0, 1.5, 0.25};
  ck_assert_int_eq(g.B.n, N);
  for (int i = 0; i < N; ++i) {
    ck_assert_double_eq(row_sum(&g.B, i), mu[i]);
    if (mu[i] > 0) ck_assert_int_eq(g.B.col[g.B.start[i]], i);
  }
  ck_assert_int_eq(g.B.start[N], 3);
  friction_limit_free(&g);
}

static status both_cards(const line *l, friction_limit *g) {
  static const int some[] = {0}, others[] = {1, 3};
  friction_card card = {.value.number = 0.25};
  status st = OK;
  TRY(friction_limit_new(N, g));
  TRY(coulomb_friction.limit(&card, &l->s, 1, some, 0, g));
  TRY(coulomb_friction.limit(&card, &l->s, 2, others, 0, g));
done:
  return st;
}

TEST(refused_memory_is_reported_and_given_back) {
  line l;
  line_init(&l);
  friction_limit g = {0};
  UNIT_REFUSED(9, both_cards(&l, &g), friction_limit_free(&g));
}

UNIT_MAIN("friction")
