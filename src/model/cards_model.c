/*
 * Cards of the model: title, units, mesh, materials, sections, amplitudes.
 */
#include "model/keyword.h"

#include "base/memory.h"

#include <float.h>
#include <string.h>

status apply_heading(reading *r) {
  const card *c = r->card;
  if (c->n_record > 0 && r->m->title[0] == '\0')
    r->m->title = c->records[0].raw;
  return OK;
}

status apply_units(reading *r) {
  const units_param *p = r->param;
  if (r->m->has_units++)
    message_add(r->m->log, P2011, &r->card->at, "a deck has one *UNITS card");
  r->m->length_unit = p->length;
  r->m->force_unit = p->force;
  r->m->time_unit = p->time;
  return OK;
}

status apply_mesh(reading *r) {
  status st = OK;
  const mesh_param *p = r->param;
  model *m = r->m;
  if (m->has_mesh) {
    message_add(m->log, P2015, &r->card->at, "a deck has one *MESH card");
    goto done;
  }
  m->has_mesh = 1;
  m->mesh_at = *value_place(r, "FILE");
  m->mesh_scale = p->scale;
  const parameter *file = card_parameter(r->card, "FILE");
  if (file == NULL || !file->has_value) goto done;
  m->mesh_file = deck_path(m->deck, &file->value);
  if (m->mesh_file == NULL) FAIL(ERR_MEMORY, "memory exhausted: mesh file");
done:
  return st;
}

status apply_condensed_problem(reading *r) {
  status st = OK;
  const problem_param *p = r->param;
  model *m = r->m;
  if (m->has_problem) {
    message_add(m->log, P2011, &r->card->at,
                "a deck has one *CONDENSED PROBLEM card");
    goto done;
  }
  m->has_problem = 1;
  m->problem_at = *value_place(r, "FILE");
  m->problem_type = card_parameter(r->card, "TYPE") == NULL ? -1 : p->type;
  const parameter *file = card_parameter(r->card, "FILE");
  if (file == NULL || !file->has_value) goto done;
  m->problem_file = deck_path(m->deck, &file->value);
  if (m->problem_file == NULL)
    FAIL(ERR_MEMORY, "memory exhausted: file of the condensed problem");
done:
  return st;
}

/* Cards that may stand beside *CONDENSED PROBLEM. */
static int goes_with_problem(const char *name) {
  static const char *const names[] = {
      "HEADING", "PARAMETER", "INCLUDE", "LEGACY", "UNITS",   "STEP",
      "STATIC",  "SOLVER",    "PRINT",   "OUTPUT", "END STEP"};
  if (strcmp(name, "CONDENSED PROBLEM") == 0) return 1;
  for (size_t k = 0; k < sizeof names / sizeof *names; ++k)
    if (strcmp(name, names[k]) == 0) return 1;
  return 0;
}

static void check_problem_cards(const reading *r) {
  const model *m = r->m;
  for (int i = 0; i < m->deck->n_card; ++i) {
    const card *c = &m->deck->cards[i];
    const keyword *row = keyword_find(c->name);
    if (row != NULL && !goes_with_problem(c->name))
      message_add(m->log, P2034, &c->at,
                  "*%s has no place beside *CONDENSED PROBLEM, line %d",
                  c->name, m->problem_at.line_no);
  }
  for (int i = 1; i < m->n_step; ++i)
    message_add(m->log, P2034, &m->steps[i].at,
                "a condensed problem is solved in one step, this is number %d",
                i + 1);
}

static void check_problem_tables(const reading *r, const step *s) {
  for (int i = 0; i < s->n_print; ++i)
    if (s->prints[i].table != PRINT_CONTACT || s->prints[i].group != NULL)
      message_add(r->m->log, P2034, &s->prints[i].at,
                  "a condensed problem has no mesh: only *PRINT, CONTACT "
                  "without GROUP= has rows");
}

status model_finish_problem(reading *r) {
  status st = OK;
  check_problem_cards(r);
  step *s = &r->m->steps[0];
  check_problem_tables(r, s);
  s->kind = STEP_STATIC;
  if (!(s->total > 0.0)) s->total = 1.0;
  s->dt = s->dt_min = s->total;
  s->output_frequency = -1;
  s->restart_frequency = -1;
  if (s->n_print > 0) goto done;
  GROW(s->prints, s->n_print, s->cap_print);
  s->prints[s->n_print++] = (print_request){
      .table = PRINT_CONTACT, .group_id = -1, .frequency = 1, .at = s->at};
done:
  return st;
}

status apply_material(reading *r) {
  status st = OK;
  const name_param *p = r->param;
  model *m = r->m;
  for (int i = 0; i < m->n_material; ++i)
    name_taken(r, p->name, m->materials[i].name);
  GROW(m->materials, m->n_material, m->cap_material);
  r->material_id = m->n_material++;
  m->materials[r->material_id].name = p->name == NULL ? "" : p->name;
  m->materials[r->material_id].at = *value_place(r, "NAME");
done:
  return st;
}

status apply_elastic(reading *r) {
  status st = OK;
  const elastic_param *p = r->param;
  const card *c = r->card;
  material *mat = &r->m->materials[r->material_id];
  char text[256];
  if (mat->has_elastic++) {
    message_add(r->m->log, P2011, &c->at, "material %s has *ELASTIC twice",
                mat->name);
    goto done;
  }
  mat->moduli = card_parameter(c, "MODULI") == NULL ? -1 : p->moduli;
  TRY(elastic_table_read(c, (elastic_type)p->type, mat->name, r->m->log,
                         &mat->elastic));
  if (mat->elastic.n > 0)
    (void)elastic_at(&mat->elastic, 0.0, mat->C, text, (int)sizeof text);
done:
  return st;
}

status apply_density(reading *r) {
  material *mat = &r->m->materials[r->material_id];
  const record *line = &r->card->records[0];
  if (mat->has_density)
    message_add(r->m->log, P2011, &r->card->at,
                "material %s has *DENSITY twice", mat->name);
  if (record_fields(r, line, 1, 1, "rho") != 0) return OK;
  if (field_real(r, &line->fields[0], 0.0, DBL_MAX, "rho", &mat->density) == 0)
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
  if (line->n_field > n && field_real(r, &line->fields[n], -DBL_MAX, DBL_MAX,
                                      "temperature", &T) != 0)
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
  status st = OK;
  const expansion_param *p = r->param;
  expansion *x = &r->m->materials[r->material_id].expand;
  int n = r->card->n_record, lines = 0;
  if (x->given++) {
    message_add(r->m->log, P2011, &r->card->at,
                "material %s has *EXPANSION twice",
                r->m->materials[r->material_id].name);
    goto done;
  }
  x->type = p->type;
  x->zero = p->zero;
  for (int c = 0; c < 3; ++c) {
    x->alpha[c].variable = TABLE_T;
    NEW(x->alpha[c].at, n);
    NEW(x->alpha[c].value, n);
  }
  while (lines < n &&
         read_expansion(r, &r->card->records[lines], lines, x) == 0)
    ++lines;
  for (int c = 0; c < 3; ++c) x->alpha[c].n = lines;
done:
  return st;
}

static const char temperature_line[] = "group of elements, value";
static const char displacement_line[] = "group, dof, value";

/* One line of each type into *c; 0 if fine. */
static int read_temperature_line(const reading *r, const record *line,
                                 initial *c) {
  if (record_fields(r, line, 2, 2, temperature_line) != 0) return -1;
  return field_quantity(r, &line->fields[1], &c->value);
}

static int read_displacement_line(const reading *r, const record *line,
                                  initial *c) {
  int dof = 1;
  if (record_fields(r, line, 3, 3, displacement_line) != 0 ||
      field_int(r, &line->fields[1], 1, 3, "dof", &dof) != 0)
    return -1;
  c->component = dof - 1;
  return field_quantity(r, &line->fields[2], &c->value);
}

static const char strain_line[] =
    "group of elements, component (xx yy zz xy yz zx: 1 to 6), value";
static const char internal_line[] =
    "group of elements, number of the internal variable, value";

static int read_numbered(const reading *r, const record *line, int most,
                         const char *expected, initial *c) {
  int number = 1;
  if (record_fields(r, line, 3, 3, expected) != 0 ||
      field_int(r, &line->fields[1], 1, most, "component", &number) != 0)
    return -1;
  c->component = number - 1;
  return field_quantity(r, &line->fields[2], &c->value);
}

static int read_strain_line(const reading *r, const record *line, initial *c) {
  return read_numbered(r, line, 6, strain_line, c);
}

static int read_internal_line(const reading *r, const record *line,
                              initial *c) {
  return read_numbered(r, line, FLOW_VALUE_MAX, internal_line, c);
}

/* By initial_type. */
static const struct {
  const char *line; /* what a line holds                                      */
  int (*read)(const reading *r, const record *line, initial *c);
  int starts; /* 1: FILE= and INCOMPATIBLE= count, lines need not be there    */
} initial_rows[] = {
    [INITIAL_TEMPERATURE] = {temperature_line, read_temperature_line, 0},
    [INITIAL_DISPLACEMENT] = {displacement_line, read_displacement_line, 1},
    [INITIAL_STRAIN] = {strain_line, read_strain_line, 0},
    [INITIAL_INTERNAL] = {internal_line, read_internal_line, 0}};

/* What stands on the card beside TYPE=. */
static status open_initial(reading *r) {
  status st = OK;
  const initial_param *p = r->param;
  model *m = r->m;
  const parameter *file = card_parameter(r->card, "FILE");
  if (!initial_rows[p->type].starts) {
    if (file != NULL || p->incompatible)
      message_add(m->log, P2004, &r->card->at,
                  "*INITIAL CONDITIONS: FILE= and INCOMPATIBLE= belong to "
                  "TYPE=DISPLACEMENT");
    if (r->card->n_record == 0)
      message_add(m->log, P2007, &r->card->at,
                  "*INITIAL CONDITIONS needs a data line: %s",
                  initial_rows[p->type].line);
    goto done;
  }
  if (m->start.given)
    message_add(m->log, P2011, &r->card->at,
                "a deck has one *INITIAL CONDITIONS, TYPE=DISPLACEMENT; the "
                "other is at line %d",
                m->start.at.line_no);
  m->start.given = 1;
  m->start.relax = p->incompatible;
  m->start.at = r->card->at;
  if (file == NULL || !file->has_value) goto done;
  m->start.file_at = file->value.at;
  m->start.file_name = p->file;
  m->start.file = deck_path(m->deck, &file->value);
  if (m->start.file == NULL)
    FAIL(ERR_MEMORY, "memory exhausted: initial state");
done:
  return st;
}

status apply_initial(reading *r) {
  status st = OK;
  const initial_param *p = r->param;
  model *m = r->m;
  if (r->misread) goto done;
  TRY(open_initial(r));
  for (int i = 0; i < r->card->n_record; ++i) {
    const record *line = &r->card->records[i];
    initial c = {.type = p->type, .group_id = -1};
    if (initial_rows[p->type].read(r, line, &c) != 0) continue;
    c.group = line->fields[0].text;
    c.at = line->fields[0].at;
    if (quantity_variables(&c.value) & 8u)
      message_add(m->log, P2033, &line->fields[line->n_field - 1].at,
                  "*INITIAL CONDITIONS: the expression must not depend on t");
    GROW(m->initials, m->n_initial, m->cap_initial);
    m->initials[m->n_initial++] = c;
  }
done:
  return st;
}

static const char *law_name(const void *ctx, int i) {
  (void)ctx;
  return law_list[i] == NULL ? NULL : law_list[i]->name;
}

plugin names_inelastic(const reading *r) {
  const inelastic_param *p = r->param;
  const law_ops *ops = p->law == NULL ? NULL : law_find(p->law);
  if (ops != NULL)
    return (plugin){ops->options, ops->param_size, "LAW", ops->name};
  if (p->law != NULL)
    unknown_word(r->m->log, P2012, value_place(r, "LAW"),
                 "*INELASTIC: there is no LAW=", p->law, law_name, NULL);
  return (plugin){NULL, 0, "LAW", NULL};
}

/* What the shift needs is there, and nothing that another one has. */
static void check_shift(const reading *r, const law_ops *ops,
                        const law_shift *s) {
  static const struct {
    const char *name;
    unsigned needed, known; /* bits 1 << shift_kind                           */
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
  status st = OK;
  material *mat = &r->m->materials[r->material_id];
  void *param = NULL;
  if (mat->law.ops != NULL) {
    message_add(r->m->log, P2011, &r->card->at,
                "material %s has its inelastic law already, line %d", mat->name,
                mat->law.at.line_no);
    goto done;
  }
  mat->law.ops = ops;
  mat->law.at = r->card->at;
  mat->law.shift = *shift;
  check_shift(r, ops, shift);
  if (ops->param_size > 0) {
    param = memory_new(1, ops->param_size);
    if (param == NULL) FAIL(ERR_MEMORY, "memory exhausted: words of a law");
    mat->law.param = param;
    if (words != NULL)
      memcpy(param, words, ops->param_size);
    else
      option_defaults(ops->options, param);
  }
  TRY(law_card_read(r->m->deck, r->card, r->m->log, &mat->law));
done:
  return st;
}

status apply_inelastic(reading *r) {
  const inelastic_param *p = r->param;
  const law_ops *ops = p->law == NULL ? NULL : law_find(p->law);
  return ops == NULL ? OK : read_law(r, ops, r->plugin, &p->shift);
}

status apply_creep(reading *r) {
  _Alignas(16) char words[PARAM_SIZE] = {0};
  char why[64];
  const creep_param *p = r->param;
  if (p->law == CREEP_HYPERBOLIC)
    return read_law(r, &hyperbolic_law, NULL, &p->shift);
  const option *row = option_find(norton_law.options, "HARDENING");
  option_defaults(norton_law.options, words);
  (void)option_read(row, p->law == CREEP_STRAIN ? "STRAIN" : "TIME", words, why,
                    sizeof why);
  return read_law(r, &norton_law, words, &p->shift);
}

status apply_viscoelastic(reading *r) {
  const viscoelastic_param *p = r->param;
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
  for (int i = 0; i < mat->elastic.n; ++i) {
    double *constant = mat->elastic.set[i].constant;
    const double E = constant[0], nu = constant[1];
    const double G = E / (2 * (1 + nu)) / (1 - sum[0]);
    const double K = E / (3 * (1 - 2 * nu)) / (1 - sum[1]);
    constant[0] = 9 * K * G / (3 * K + G);
    constant[1] = (3 * K - 2 * G) / (2 * (3 * K + G));
  }
  (void)elastic_at(&mat->elastic, 0.0, mat->C, text, (int)sizeof text);
}

status apply_trs(reading *r) {
  const record *line = &r->card->records[0];
  material *mat = &r->m->materials[r->material_id];
  law_shift s = {.kind = SHIFT_WLF};
  if (mat->clock.kind != SHIFT_NONE)
    message_add(r->m->log, P2011, &r->card->at, "material %s has *TRS twice",
                mat->name);
  if (record_fields(r, line, 3, 3, "T_REF, C1, C2") != 0 ||
      deck_real(&line->fields[0], r->m->log, &s.reference) != 0 ||
      field_real(r, &line->fields[1], 0.0, DBL_MAX, "C1", &s.c1) != 0 ||
      field_real(r, &line->fields[2], DBL_MIN, DBL_MAX, "C2", &s.c2) != 0)
    return OK;
  mat->clock = s;
  mat->clock_at = r->card->at;
  return OK;
}

/* The clock of *TRS into the law it belongs to. */
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
  status st = OK;
  const law_card *law = &mat->law;
  set_clock(m, mat);
  if (law->ops == NULL || law->n_set == 0 || mat->elastic.n == 0) goto done;
  const int errors = message_count(m->log, ERROR);
  TRY(law_card_check(law, mat->elastic.type, m->log));
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
done:
  return st;
}

/* ---- *REFERENCE --------------------------------------------------------- */

/* clang-format off */
static const struct {
  const char *name;
  int plane, axisymmetric, solid; /* place in "value"; -1: none               */
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
  closed_form *ref = &r->m->ref;
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

status apply_section(reading *r) {
  status st = OK;
  const section_param *p = r->param;
  model *m = r->m;
  GROW(m->sections, m->n_section, m->cap_section);
  section *s = &m->sections[m->n_section++];
  s->elset = p->elset == NULL ? "" : p->elset;
  s->material_name = p->material == NULL ? "" : p->material;
  s->at = r->card->at;
  s->elset_at = *value_place(r, "ELSET");
  s->material_at = *value_place(r, "MATERIAL");
  s->material_id = -1;
  s->group_id = -1;
  s->thickness = p->thickness;
  /* The words of Abaqus repeat the four kinematics. */
  s->kin = card_parameter(r->card, "TYPE") == NULL ? -1 : p->type % 4;
  s->averaged = p->formulation;
  s->has_thickness =
      r->card->n_record > 0 || card_parameter(r->card, "THICKNESS") != NULL;
  if (r->card->n_record > 0) {
    const record *line = &r->card->records[0];
    if (card_parameter(r->card, "THICKNESS") != NULL)
      message_add(m->log, P2011, &line->at,
                  "*SOLID SECTION: the thickness is given by THICKNESS= and by "
                  "a data line");
    else if (record_fields(r, line, 1, 1, "thickness") == 0)
      field_real(r, &line->fields[0], DBL_MIN, DBL_MAX, "thickness",
                 &s->thickness);
  }
done:
  return st;
}

/* One pair: the same at all times. */
static status constant_table(double value, value_table *t) {
  status st = OK;
  NEW(t->at, 1);
  NEW(t->value, 1);
  t->value[0] = value;
  t->n = 1;
done:
  return st;
}

status apply_amplitude(reading *r) {
  status st = OK;
  const amplitude_param *p = r->param;
  model *m = r->m;
  const card *c = r->card;
  for (int i = 0; i < m->n_amplitude; ++i)
    name_taken(r, p->name, m->amplitudes[i].name);
  GROW(m->amplitudes, m->n_amplitude, m->cap_amplitude);
  amplitude *a = &m->amplitudes[m->n_amplitude++];
  a->name = p->name == NULL ? "" : p->name;
  a->at = *value_place(r, "NAME");
  a->total_time = p->time;
  a->table.variable = TABLE_T;
  if (c->records[0].n_field == 1 && c->n_record == 1) {
    quantity q = {0};
    if (field_quantity(r, &c->records[0].fields[0], &q) != 0) goto done;
    a->table.formula = q.formula;
    if (q.formula == NULL && !c->records[0].fields[0].quoted)
      message_add(m->log, P2009, &c->records[0].at,
                  "*AMPLITUDE needs pairs t, a or one expression in quotes");
    else if (q.formula == NULL)
      TRY(constant_table(q.number, &a->table));
    else if (expression_variables(q.formula) & 7u)
      message_add(m->log, P2033, &c->records[0].at,
                  "*AMPLITUDE: the expression may depend on t only");
    goto done;
  }
  TRY(read_pairs(r, 0, TABLE_T, &a->table));
done:
  return st;
}
