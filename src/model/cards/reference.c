/*
 * *REFERENCE: the components of a closed form.
 */
#include "model/cards/cards.h"

/* clang-format off */
static const struct {
  const char *name;
  int plane, axisymmetric, solid; /* place in "value"; -1: none */
} components[] = {
  {"u_x", 0, -1, 0},  {"u_y", 1, -1, 1},  {"u_r", -1, 0, -1}, {"u_z", -1, 1, 2},
  {"stress_xx", 3, -1, 3},  {"stress_yy", 4, -1, 4},  {"stress_zz", 5, 4, 5},
  {"stress_xy", 6, -1, 6},  {"stress_yz", -1, -1, 7}, {"stress_zx", -1, -1, 8},
  {"stress_rr", -1, 3, -1}, {"stress_tt", -1, 5, -1}, {"stress_rz", -1, 6, -1},
  {"pressure", 9, 9, 9}};
/* clang-format on */

enum { N_COMPONENT = sizeof components / sizeof *components };

static const char *component_name(const void *ctx, int i) {
  (void)ctx;
  return i < N_COMPONENT ? components[i].name : NULL;
}

int reference_place(const char *name, int dim, int axisymmetric) {
  for (int i = 0; i < N_COMPONENT; ++i) {
    if (!same_word(name, components[i].name)) continue;
    if (dim == 3) return components[i].solid;
    return axisymmetric ? components[i].axisymmetric : components[i].plane;
  }
  return -1;
}

static int is_component(const char *name) {
  for (int i = 0; i < N_COMPONENT; ++i)
    if (same_word(name, components[i].name)) return 1;
  return 0;
}

status apply_reference(reading *r) {
  closed_form *ref = &r->m->accuracy.ref;
  message_log *log = r->m->log;
  if (ref->n > 0)
    message_add(log, P2011, &r->card->at,
                "a deck has one *REFERENCE, the first is in line %d",
                ref->at.line_no);
  ref->at = r->card->at;
  for (int i = 0; i < r->card->n_record; ++i) {
    const record *line = &r->card->records[i];
    const field *f = line->fields;
    quantity value = {0};
    if (record_fields(r, line, 2, 2, "name, value") != 0) continue;
    if (!is_component(f[0].text)) {
      unknown_word(log, P2012, &f[0].at, "*REFERENCE: there is no component ",
                   f[0].text, component_name, NULL);
      continue;
    }
    if (field_quantity(r, &f[1], &value) != 0) continue;
    for (int k = 0; k < ref->n; ++k)
      if (same_word(ref->line[k].name, f[0].text))
        message_add(log, P2011, &f[0].at, "%s is given twice", f[0].text);
    if (ref->n < REFERENCE_SIZE)
      ref->line[ref->n++] = (reference_line){f[0].text, value, f[0].at};
  }
  return OK;
}
