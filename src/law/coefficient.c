/*
 * Coefficients of a law at a time and temperature: numbers or expressions of
 * t, linear between the temperatures of the table and constant outside, and
 * the clock of the temperature shifts.
 */
#include "law/law.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

int law_n_field(const option *table) {
  int n = 0;
  if (table == NULL) return 0;
  while (table[n].name != NULL) ++n;
  return n;
}

int law_n_value(const law_card *law) {
  return law_n_field(law->ops->fields) +
         law->n_term * law_n_field(law->ops->terms);
}

/* Row of value number i, and the term it belongs to (from 1; 0: none). */
static const option *row_of(const law_card *law, int i, int *term) {
  const int n_field = law_n_field(law->ops->fields);
  const int n_term = law_n_field(law->ops->terms);
  *term = i < n_field ? 0 : 1 + (i - n_field) / n_term;
  return i < n_field ? &law->ops->fields[i]
                     : &law->ops->terms[(i - n_field) % n_term];
}

/* Set below the temperature and weight of the one above. */
static int find_set(const law_card *law, double temperature, double *weight) {
  const double *T = law->temperature;
  const int last = law->n_set - 1;
  int k = 0;
  *weight = 0;
  if (last == 0 || temperature <= T[0]) return 0;
  if (temperature >= T[last]) return last;
  while (temperature >= T[k + 1]) ++k;
  *weight = (temperature - T[k]) / (T[k + 1] - T[k]);
  return k;
}

status law_values(const law_card *law, double t, double temperature,
                  double *value) {
  status st = OK;
  static const double origin[3] = {0, 0, 0};
  const int n = law_n_value(law);
  double weight;
  const quantity *low =
      law->value + (size_t)n * (size_t)find_set(law, temperature, &weight);
  for (int i = 0; i < n; ++i) {
    int term;
    const option *row = row_of(law, i, &term);
    value[i] = quantity_value(&low[i], origin, t);
    if (weight > 0)
      value[i] += weight * (quantity_value(&low[n + i], origin, t) - value[i]);
    if (value[i] >= row->min && value[i] <= row->max) continue;
    char why[128];
    range_text(value[i], row->min, row->max, why, sizeof why);
    FAIL(ERR_DECK, "law %s: %s = %s, line %d of its data, time %g",
         law->ops->name, row->name, why, term + (law->ops->fields != NULL), t);
  }
done:
  return st;
}

double law_speed(const law_card *law, double temperature) {
  const law_shift *s = &law->shift;
  const double over = temperature - s->reference;
  if (s->kind == SHIFT_WLF) {
    if (!(s->c2 + over > 0)) return 0; /* below the glass: no flow            */
    return pow(10, s->c1 * over / (s->c2 + over));
  }
  if (s->kind == SHIFT_ARRHENIUS)
    return exp(s->activation * over /
               ((temperature - s->zero) * (s->reference - s->zero)));
  return 1;
}

unsigned law_varies(const law_card *law) {
  unsigned bits = 0;
  const int n = law->n_set * law_n_value(law);
  for (int i = 0; i < n; ++i)
    if (quantity_variables(&law->value[i]) != 0) bits |= LAW_VARIES_TIME;
  if (law->n_set > 1 || law->shift.kind != SHIFT_NONE)
    bits |= LAW_VARIES_TEMPERATURE;
  return bits;
}

void law_card_free(law_card *law) {
  if (law == NULL) return;
  memory_free((void *)law->param);
  memory_free(law->temperature);
  memory_free(law->value);
  memset(law, 0, sizeof *law);
}
