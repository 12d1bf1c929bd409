/* src/mesh/sort.c */
#include "mesh/sort.h"
#include "support/unit.h"

enum { N = 5000 };

/* Numbers without pattern (Marsaglia, xorshift). */
static uint64_t next(uint64_t *s) {
  *s ^= *s << 13;
  *s ^= *s >> 7;
  return *s ^= *s << 17;
}

typedef struct pair {
  uint64_t key;
  int second, id;
} pair;

static int by_pair(const void *p, const void *q) {
  const pair *a = p, *b = q;
  if (a->key != b->key) return a->key < b->key ? -1 : 1;
  if (a->second != b->second) return a->second < b->second ? -1 : 1;
  return (a->id > b->id) - (a->id < b->id);
}

static int by_second(const void *ctx, int a, int b) {
  const pair *p = ctx;
  if (p[a].second != p[b].second) return p[a].second < p[b].second ? -1 : 1;
  return (a > b) - (a < b);
}

/* Keys of few or all bits; the C library sorts the same pairs. */
TEST(order_is_that_of_qsort) {
  static pair p[N], q[N];
  static sort_item item[N];
  uint64_t s = 88172645463325252u;
  for (int bits = 1; bits <= 64; bits += 7)
    for (int n = 0; n <= N; n = n * 3 + 1) {
      for (int i = 0; i < n; ++i) {
        item[i] = (sort_item){next(&s) >> (64 - bits), i};
        p[i] = (pair){item[i].key, (int)(next(&s) % 5), i};
        q[i] = p[i];
      }
      ck_assert_int_eq(sort_items(n, item, by_second, p), OK);
      qsort(q, (size_t)n, sizeof *q, by_pair);
      for (int i = 0; i < n; ++i) {
        ck_assert_int_eq(item[i].id, q[i].id);
        ck_assert(item[i].key == q[i].key);
      }
    }
}

TEST(equal_keys_stay_in_order_without_compare) {
  static sort_item a[N];
  uint64_t s = 88172645463325252u;
  for (int i = 0; i < N; ++i) a[i] = (sort_item){(next(&s) & 3) << 40, i};
  ck_assert_int_eq(sort_items(N, a, NULL, NULL), OK);
  for (int i = 1; i < N; ++i)
    ck_assert(a[i - 1].key < a[i].key ||
              (a[i - 1].key == a[i].key && a[i - 1].id < a[i].id));
}

TEST(refused_memory_is_told_and_given_back) {
  static int id[N];
  size_t before = memory_in_use();
  int refusals = 0;
  for (int k = 1;; ++k) {
    for (int i = 0; i < N; ++i) id[i] = N - i;
    memory_refuse(k, 0);
    status st = sort_ids(N, id);
    memory_refuse(0, 0);
    ck_assert_uint_eq(memory_in_use(), before);
    if (st == OK) break;
    ck_assert_int_eq(st, ERR_MEMORY);
    ++refusals;
  }
  ck_assert_int_eq(refusals, 2);
  for (int i = 0; i < N; ++i) ck_assert_int_eq(id[i], i + 1);
}

UNIT_MAIN("sort")
