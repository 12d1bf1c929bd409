/*
 * Cards of a material: elasticity, density, thermal strain, inelastic laws and
 * their time-temperature shift.
 */
#include "base/base.h"
#include "model/cards/cards.h"

status apply_material(reading *r) {
  const card_options *p = r->param;
  model *m = r->m;
  for (int i = 0; i < m->n.material; ++i)
    name_taken(r, p->name, m->materials[i].name);
  PASS_GROW(m->materials, m->n.material, m->cap.material);
  r->material_id = m->n.material++;
  m->materials[r->material_id].name = p->name == NULL ? "" : p->name;
  m->materials[r->material_id].at = *value_place(r, "NAME");
  return OK;
}

/* An open material that has this card already. */
static void report_twice(const reading *r) {
  message_add(r->m->log, P2011, &r->card->at, "material %s has *%s twice",
              r->m->materials[r->material_id].name, r->card->name);
}

status apply_elastic(reading *r) {
  const card_options *p = r->param;
  material *mat = &r->m->materials[r->material_id];
  char text[256];
  if (mat->has_elastic++) {
    report_twice(r);
    return OK;
  }
  mat->moduli = card_parameter(r->card, "MODULI") == NULL ? -1 : p->body.moduli;
  PASS(elastic_table_read(r->card, (elastic_type)p->type, mat->name, r->m->log,
                          &mat->elastic));
  if (mat->elastic.n > 0)
    (void)elastic_at(&mat->elastic, 0.0, mat->C, text, (int)sizeof text);
  return OK;
}

status apply_density(reading *r) {
  material *mat = &r->m->materials[r->material_id];
  const record *line = &r->card->records[0];
  if (mat->has_density) report_twice(r);
  if (record_fields(r, line, 1, 1, "rho") != 0) return OK;
  if (field_real(r, &line->fields[0], 0.0, "rho", &mat->density) == 0)
    mat->has_density = 1;
  return OK;
}

/* One line of *EXPANSION into place i of the tables; 0 if fine. */
static int read_expansion(const reading *r, const record *line, int i,
                          expansion *x) {
  static const char *const expected[] = {
      "alpha [, temperature]", "alpha1, alpha2, alpha3 [, temperature]"};
  int n = x->type == EXPANSION_ORTHO ? 3 : 1, several = r->card->n_record > 1;
  double T = 0.0;
  if (record_fields(r, line, n + several, n + 1, expected[x->type]) != 0)
    return -1;
  if (line->n_field > n &&
      field_real(r, &line->fields[n], -DBL_MAX, "temperature", &T) != 0)
    return -1;
  for (int c = 0; c < n; ++c) {
    if (deck_real(&line->fields[c], r->m->log, &x->alpha[c].value[i]) != 0)
      return -1;
    x->alpha[c].at[i] = T;
  }
  if (i == 0 || T > x->alpha[0].at[i - 1]) return 0;
  message_add(r->m->log, P2029, &line->fields[n].at,
              "*EXPANSION: the table must ascend, but %.15g follows %.15g", T,
              x->alpha[0].at[i - 1]);
  return -1;
}

status apply_expansion(reading *r) {
  const card_options *p = r->param;
  expansion *x = &r->m->materials[r->material_id].expand;
  int n = r->card->n_record, lines = 0;
  if (x->given++) {
    report_twice(r);
    return OK;
  }
  x->type = p->type;
  x->zero = p->body.zero;
  for (int c = 0; c < 3; ++c) {
    x->alpha[c].variable = TABLE_T;
    PASS_NEW_REALS(n, &x->alpha[c].at, &x->alpha[c].value);
  }
  while (lines < n &&
         read_expansion(r, &r->card->records[lines], lines, x) == 0)
    ++lines;
  for (int c = 0; c < 3; ++c) x->alpha[c].n = lines;
  return OK;
}

plugin names_inelastic(const reading *r) {
  const card_options *p = r->param;
  const law_ops *ops = p->law == NULL ? NULL : law_find(p->law);
  if (ops != NULL)
    return (plugin){ops->options, ops->param_size, "LAW", ops->name};
  if (p->law != NULL)
    unknown_word(r->m->log, P2012, value_place(r, "LAW"),
                 "*INELASTIC: there is no LAW=", p->law, candidate_name,
                 LISTED(law_list));
  return (plugin){NULL, 0, "LAW", NULL};
}

/* The parameters of the shift are given, and none of another one. */
static void check_shift(const reading *r, const law_ops *ops,
                        const law_shift *s) {
  static const struct {
    const char *name;
    unsigned needed, known; /* bits 1 << shift_kind */
  } rows[] = {{"T_REF", 6, 6},
              {"C1", 2, 2},
              {"C2", 2, 2},
              {"ACTIVATION", 4, 4},
              {"T_ZERO", 0, 4}};
  char word[16];
  choice_word(SHIFT_WORDS, s->kind, word, sizeof word);
  for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
    const int given = card_parameter(r->card, rows[i].name) != NULL;
    const int own = ops->is_warm != NULL && strcmp(rows[i].name, "T_ZERO") == 0;
    if (!given && rows[i].needed >> s->kind & 1u)
      message_add(r->m->log, P2005, &r->card->at,
                  "*%s, SHIFT=%s needs the parameter %s=", r->card->name, word,
                  rows[i].name);
    if (given && !own && !(rows[i].known >> s->kind & 1u))
      message_add(r->m->log, P2037, value_place(r, rows[i].name),
                  "*%s: %s= with SHIFT=%s", r->card->name, rows[i].name, word);
  }
  if (s->kind == SHIFT_ARRHENIUS && !r->misread && !(s->reference > s->zero))
    message_add(r->m->log, P2004, value_place(r, "T_REF"),
                "*%s: T_REF = %.15g is not above T_ZERO = %.15g", r->card->name,
                s->reference, s->zero);
}

/* The law of the open material, with its words (NULL: all defaults). */
static status read_law(reading *r, const law_ops *ops, const void *words,
                       const law_shift *shift) {
  material *mat = &r->m->materials[r->material_id];
  void *param = NULL;
  if (mat->law.ops != NULL) {
    message_add(r->m->log, P2011, &r->card->at,
                "material %s has its inelastic law already, line %d", mat->name,
                mat->law.at.line_no);
    return OK;
  }
  mat->law.ops = ops;
  mat->law.at = r->card->at;
  mat->law.material = mat->name;
  mat->law.shift = *shift;
  check_shift(r, ops, shift);
  if (ops->param_size > 0) {
    PASS_GET(param, memory_new(1, ops->param_size));
    mat->law.param = param;
    if (words != NULL)
      memcpy(param, words, ops->param_size);
    else
      option_defaults(ops->options, param);
  }
  return law_card_read(r->m->deck, r->card, r->m->log, &mat->law);
}

status apply_inelastic(reading *r) {
  const card_options *p = r->param;
  const law_ops *ops = p->law == NULL ? NULL : law_find(p->law);
  return ops == NULL ? OK : read_law(r, ops, r->plugin, &p->shift);
}

status apply_creep(reading *r) {
  _Alignas(16) char words[PARAM_SIZE] = {0};
  char why[64];
  const card_options *p = r->param;
  if (p->type == CREEP_HYPERBOLIC)
    return read_law(r, &hyperbolic_law, NULL, &p->shift);
  const option *row = option_find(norton_law.options, "HARDENING");
  option_defaults(norton_law.options, words);
  (void)option_read(row, p->type == CREEP_STRAIN ? "STRAIN" : "TIME", words,
                    why, sizeof why);
  return read_law(r, &norton_law, words, &p->shift);
}

status apply_viscoelastic(reading *r) {
  const card_options *p = r->param;
  r->m->materials[r->material_id].is_abaqus_prony = 1;
  return read_law(r, &prony_law, NULL, &p->shift);
}

/* Matrix of the moduli at once from those after all terms have relaxed:
 * G0 = G/(1 - sum g_i), K0 = K/(1 - sum k_i). */
static void stiffen(const model *m, material *mat) {
  double sum[2] = {0, 0};
  char text[256];
  const law_card *law = &mat->law;
  int varies = law->n_set > 1;
  for (int i = 0; i < law->n_term; ++i)
    for (int k = 0; k < 2; ++k) {
      varies |= law->value[3 * i + k].formula != NULL;
      sum[k] += law->value[3 * i + k].number;
    }
  if (varies || !(sum[0] < 1 && sum[1] < 1)) {
    message_add(m->log, P2046, &law->at,
                "material %s: MODULI=LONG TERM needs constant g_i and k_i with "
                "sums below 1, as here %g and %g",
                mat->name, sum[0], sum[1]);
    return;
  }
  elastic_table_relaxed(&mat->elastic, sum);
  (void)elastic_at(&mat->elastic, 0.0, mat->C, text, (int)sizeof text);
}

status apply_trs(reading *r) {
  const record *line = &r->card->records[0];
  material *mat = &r->m->materials[r->material_id];
  law_shift s = {.kind = SHIFT_WLF};
  if (mat->clock.kind != SHIFT_NONE) report_twice(r);
  if (record_fields(r, line, 3, 3, "T_REF, C1, C2") != 0 ||
      deck_real(&line->fields[0], r->m->log, &s.reference) != 0 ||
      field_real(r, &line->fields[1], 0.0, "C1", &s.c1) != 0 ||
      field_real(r, &line->fields[2], DBL_MIN, "C2", &s.c2) != 0)
    return OK;
  mat->clock = s;
  mat->clock_at = r->card->at;
  return OK;
}

/* The shift of *TRS into the law it belongs to. */
static void set_clock(const model *m, material *mat) {
  if (mat->clock.kind == SHIFT_NONE) return;
  if (mat->law.ops == NULL)
    message_add(m->log, P2014, &mat->clock_at,
                "*TRS: material %s has no *VISCOELASTIC or *INELASTIC",
                mat->name);
  else if (mat->law.shift.kind != SHIFT_NONE)
    message_add(m->log, P2011, &mat->clock_at,
                "material %s has *TRS and SHIFT=, line %d", mat->name,
                mat->law.at.line_no);
  else
    mat->law.shift = mat->clock;
}

status material_resolve_law(const model *m, material *mat) {
  const law_card *law = &mat->law;
  set_clock(m, mat);
  if (law->ops == NULL || law->n_set == 0 || mat->elastic.n == 0) return OK;
  const int errors = message_count(m->log, ERROR);
  PASS(law_card_check(law, mat->elastic.type, m->log));
  if (mat->moduli < 0) {
    mat->moduli =
        mat->is_abaqus_prony ? MODULI_LONG_TERM : MODULI_INSTANTANEOUS;
    if (mat->is_abaqus_prony && message_count(m->log, ERROR) == 0)
      message_add(m->log, P2047, &law->at,
                  "material %s: *ELASTIC holds the long-term moduli",
                  mat->name);
  } else if (law->ops != &prony_law) {
    message_add(m->log, P2037, &law->at,
                "material %s: MODULI= of *ELASTIC with the law %s", mat->name,
                law->ops->name);
  }
  if (law->ops == &prony_law && mat->moduli == MODULI_LONG_TERM &&
      message_count(m->log, ERROR) == errors)
    stiffen(m, mat);
  return OK;
}
