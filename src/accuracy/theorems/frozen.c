/* A contact problem with part of its sliding limit and of its normal forces
 * given (theorems.h). */
#include "accuracy/theorems/theorems.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

static int is_given(const unsigned char *given, int i) {
  return given != NULL && given[i];
}

/* Entries of B that are left out become part of g0. */
static status freeze_limit(const contact_problem *cp, const double *r,
                           const unsigned char *keep_row,
                           const unsigned char *given, frozen_problem *out) {
  status st = OK;
  const sparse_rows *B = cp->B;
  memcpy(out->g0, cp->g0, (size_t)cp->n * sizeof *out->g0);
  if (B == NULL) goto done;
  out->B = (sparse_rows){B->n, B->start, B->col, NULL};
  NEW(out->B.val, B->start[B->n]);
  for (int i = 0; i < cp->n; ++i)
    for (int e = B->start[i]; e < B->start[i + 1]; ++e) {
      int j = B->col[e];
      int keep = (keep_row == NULL || keep_row[i]) && !is_given(given, j);
      if (keep)
        out->B.val[e] = B->val[e];
      else
        out->g0[i] += B->val[e] * fmax(0.0, -r[cp->dim * j]);
    }
  out->cp.B = &out->B;
done:
  return st;
}

status frozen_new(const contact_problem *cp, const double *r,
                  const unsigned char *keep_row, const unsigned char *given,
                  frozen_problem *out) {
  status st = OK;
  *out = (frozen_problem){.cp = *cp};
  NEW(out->f, cp->m);
  NEW(out->gap, cp->n);
  NEW(out->g0, cp->n);
  NEW(out->r, cp->m);
  memcpy(out->f, cp->f, (size_t)cp->m * sizeof *out->f);
  memcpy(out->r, r, (size_t)cp->m * sizeof *out->r);
  for (int i = 0; i < cp->n; ++i) {
    int k = cp->dim * i;
    out->gap[i] = is_given(given, i) ? HUGE_VAL : cp->gap[i];
    if (!is_given(given, i)) continue;
    out->f[k] += r[k];
    out->r[k] = 0.0;
  }
  if (cp->g0 != NULL) {
    TRY(freeze_limit(cp, r, keep_row, given, out));
    out->cp.g0 = out->g0;
  }
  out->cp.f = out->f;
  out->cp.gap = out->gap;
done:
  return st;
}

void frozen_free(frozen_problem *p) {
  RELEASE(p->B.val, p->f, p->gap, p->g0, p->r);
  *p = (frozen_problem){0};
}
