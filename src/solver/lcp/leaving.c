/*
 * Who leaves the basis: the first to vanish, ties by the lexicographic rule
 * (lcp.c).
 */
#include "solver/lcp/parts.h"

#include <math.h>
#include <stddef.h>

static const double SMALL = 0x1p-38;   /* no pivot below                      */
static const double UNEQUAL = 0x1p-26; /* pivots of tied rows not considered  */
static const double MOST_NOISE = 0x1p-28; /* no more is taken for noise       */

/* What counts as zero, of each kind (z0, z, w): values, changes. */
typedef struct sizes {
  double value[3], change[3];
} sizes;

static int kind_of(const lcp_work *w, int candidate) {
  if (candidate >= w->cap) return 2;
  return w->var[candidate] == w->n ? 0 : 1;
}

static double value_of(const lcp_work *w, int candidate) {
  double x = candidate < w->cap ? w->z[candidate] : w->w[candidate - w->cap];
  return x > 0.0 ? x : 0.0;
}

static double change_of(const lcp_work *w, int candidate) {
  return candidate < w->cap ? w->dz[candidate] : w->dw[candidate - w->cap];
}

double lcp_zero(double share, double size, double noise) {
  return fmax(share * size, fmin(noise, MOST_NOISE * size));
}

static sizes measure(const lcp_work *w) {
  double value[3] = {w->z0_start, 0.0, 1.0}, change[3];
  sizes k;
  for (int a = 0; a < w->s; ++a) {
    int kind = kind_of(w, a);
    value[kind] = fmax(value[kind], fabs(w->z[a]));
  }
  value[2] = fmax(value[2], lcp_largest(w->n, w->w));
  double moved = fmax(lcp_largest(w->s, w->dz), w->entering >= 0 ? 1.0 : 0.0);
  change[0] = change[1] = moved;
  change[2] = fmax(lcp_largest(w->n, w->dw), moved);
  double noise = ROUNDING * w->size_K;
  for (int i = 0; i < 3; ++i) {
    k.value[i] = lcp_zero(TIE, value[i], noise * fmax(1.0, value[1]));
    k.change[i] = lcp_zero(SMALL, change[i], noise * moved);
  }
  return k;
}

/* List the rows that reach zero first. Returns how many; *step. */
static int first_to_vanish(lcp_work *w, const sizes *k, double *step) {
  int n_candidate = 0, n_tie = 0;
  double pivot[3] = {0.0, 0.0, 0.0};
  *step = HUGE_VAL;
  for (int c = 0; c < w->cap + w->n; ++c) {
    if (c < w->cap ? c >= w->s : w->at_w[c - w->cap] >= 0) continue;
    double change = change_of(w, c);
    if (!(change < -k->change[kind_of(w, c)])) continue;
    w->tie[n_candidate++] = c;
    *step = fmin(*step, value_of(w, c) / -change);
  }
  for (int i = 0; i < n_candidate; ++i) {
    int c = w->tie[i], kind = kind_of(w, c);
    double left = value_of(w, c) + change_of(w, c) * *step;
    if (left > k->value[kind]) continue;
    pivot[kind] = fmax(pivot[kind], -change_of(w, c));
    w->tie[n_tie++] = c;
  }
  n_candidate = n_tie;
  n_tie = 0;
  for (int i = 0; i < n_candidate; ++i) {
    int c = w->tie[i];
    if (-change_of(w, c) >= UNEQUAL * pivot[kind_of(w, c)]) w->tie[n_tie++] = c;
  }
  return n_tie;
}

/* Keep the tied rows whose entry in the column of e^(j+1) is least. */
static int split_ties(lcp_work *w, const lcp_problem *p, int j, int n_tie) {
  int b = w->at_w[j], kept = 0, any_w = 0;
  double least = HUGE_VAL, noise = 0.0, size_z, size_w;
  if (b < 0) { /* a unit column */
    for (int i = 0; i < n_tie; ++i)
      if (w->tie[i] != w->cap + j) w->tie[kept++] = w->tie[i];
    return kept > 0 ? kept : n_tie;
  }
  for (int a = 0; a < w->s; ++a)
    w->lz[a] = -w->K[(size_t)a + (size_t)b * (size_t)w->cap];
  for (int i = 0; i < n_tie; ++i) any_w = any_w || w->tie[i] >= w->cap;
  size_w = size_z = lcp_largest(w->s, w->lz);
  if (any_w) {
    lcp_expand(w, p, w->lz, w->lw);
    size_w = fmax(size_w, lcp_largest(w->n, w->lw));
  }
  for (int i = 0; i < n_tie; ++i) {
    int c = w->tie[i], is_w = c >= w->cap;
    double entry = is_w ? w->lw[c - w->cap] : w->lz[c];
    w->key[i] = entry / -change_of(w, c);
    least = fmin(least, w->key[i]);
    noise = fmax(noise, (is_w ? size_w : size_z) / -change_of(w, c));
  }
  for (int i = 0; i < n_tie; ++i)
    if (w->key[i] <= least + TIE * noise) w->tie[kept++] = w->tie[i];
  return kept;
}

int lcp_leaving(lcp_work *w, const lcp_problem *p, double *step) {
  sizes k = measure(w);
  int n_tie = first_to_vanish(w, &k, step);
  if (n_tie == 0) return -1;
  for (int i = 0; i < n_tie; ++i)
    if (kind_of(w, w->tie[i]) == 0) return w->tie[i];
  for (int j = 0; j < w->n && n_tie > 1; ++j)
    n_tie = split_ties(w, p, j, n_tie);
  return w->tie[0];
}
