/* src/output/columns: over the tables, so that a new row is tested too. */
#include "effects/rows.h"
#include "output/columns/columns.h"
#include "support/made_up.h"
#include "support/unit.h"

#include <stddef.h>

TEST(every_row_has_unit_help_scene_and_value) {
  const column *c;
  for (column_walk k = {0}; (c = column_next(&k)) != NULL;) {
    ck_assert_msg(c->unit != NULL && c->unit[0] != '\0', "%s", c->name);
    ck_assert_msg(c->help != NULL && c->help[0] != '\0', "%s", c->name);
    ck_assert_msg((c->scenes & (SCENE_ALL | SCENE_LCP)) != 0, "%s", c->name);
    ck_assert_msg(c->value != NULL, "%s", c->name);
    ck_assert_msg((c->form == AS_WORD) == (c->word != NULL), "%s", c->name);
    ck_assert_msg(strpbrk(c->name, " []#/") == NULL, "%s", c->name);
  }
}

TEST(every_column_of_an_effect_is_listed_once) {
  for (int e = 0; effect_table[e] != NULL; ++e)
    for (int i = 0; i < effect_table[e]->n_column; ++i) {
      const column *c;
      int times = 0;
      for (column_walk k = {0}; (c = column_next(&k)) != NULL;)
        times += c == &effect_table[e]->columns[i];
      ck_assert_int_eq(times, 1);
    }
}

TEST(names_are_unique_within_entity_and_scene) {
  const column *a, *b;
  for (column_walk k = {0}; (a = column_next(&k)) != NULL;)
    for (column_walk l = k; (b = column_next(&l)) != NULL;)
      ck_assert_msg(a->of != b->of || (a->scenes & b->scenes) == 0 ||
                        strcmp(a->name, b->name) != 0,
                    "%s", a->name);
}

/* Components of one field of HDF5 have places of their own. */
TEST(fields_have_distinct_components) {
  const column *a, *b;
  for (column_walk k = {0}; (a = column_next(&k)) != NULL;)
    for (column_walk l = k; (b = column_next(&l)) != NULL;) {
      if (a->of != b->of || (a->scenes & b->scenes) == 0) continue;
      if (a->field == NULL || b->field == NULL) continue;
      if (strcmp(a->field, b->field) == 0) ck_assert_int_ne(a->part, b->part);
    }
}

static int count_finite(const made_up *made) {
  int n = 0;
  view v = {&made->m, made->msh, &made->s};
  const column *c;
  for (column_walk k = {0}; (c = column_next(&k)) != NULL;) {
    if (!column_visible(c, &made->m)) continue;
    ck_assert(column_ready(c, &made->s));
    for (int id = 0; id < column_items(c, &v); ++id) {
      ck_assert_msg(isfinite(c->value(&v, id, c->part)), "%s", c->name);
      if (c->form == AS_WORD) ck_assert_str_ne(c->word(&v, id), "?");
      ++n;
    }
  }
  return n;
}

TEST(every_value_is_finite) {
  for (int dim = 2; dim <= 3; ++dim) {
    MADE_UP *made = made_up_new(dim, 2, 3);
    made_up_advance(made, 2);
    ck_assert_int_gt(count_finite(made), 100);
  }
  MADE_UP *axi = made_up_new(2, 2, 3);
  axi->body.kin = AXISYMMETRIC;
  made_up_advance(axi, 2);
  ck_assert_int_eq(scene_of(&axi->m), SCENE_AXI);
  ck_assert_int_gt(count_finite(axi), 100);
}

TEST(columns_follow_the_effects) {
  MADE_UP *made = made_up_new(2, 1, 1);
  made->m.effects = 0;
  const column *c;
  for (column_walk k = {0}; (c = column_next(&k)) != NULL;)
    if (column_visible(c, &made->m)) {
      ck_assert_int_ne(c->of, PER_CONTACT_NODE);
      ck_assert_int_ne(c->of, PER_CONTACT);
      ck_assert_ptr_null(strstr(c->name, "stress"));
      ck_assert_ptr_null(strstr(c->name, "friction"));
    }
}

/* Of all effects that have one: without it no column is read. */
TEST(columns_of_an_effect_wait_for_its_state) {
  int n = 0;
  MADE_UP *made = made_up_new(3, 2, 3);
  made_up_advance(made, 2);
  made->s.effects = NULL;
  for (int k = 0; effect_table[k] != NULL; ++k) {
    const effect_ops *e = effect_table[k];
    if (e->size == 0 || e->of_state) continue;
    for (int i = 0; i < e->n_column; ++i, ++n)
      ck_assert_msg(!column_ready(&e->columns[i], &made->s), "%s of %s",
                    e->columns[i].name, e->name);
  }
  ck_assert_int_gt(n, 0);
}

/* Without one array of the state, those columns alone wait that need it. */
TEST(columns_wait_for_what_they_need_alone) {
#define WITHOUT(array, bits) \
  { offsetof(state, array), bits }
  static const struct {
    size_t at;
    unsigned bits;
  } rows[] = {
      WITHOUT(body.strain, NEEDS_STRAIN),
      WITHOUT(body.stress, NEEDS_STRESS),
      WITHOUT(body.reaction, NEEDS_REACTION),
      WITHOUT(contacts.surface, NEEDS_SURFACE | NEEDS_PLACE | NEEDS_SEVERAL),
      WITHOUT(contacts.limit, NEEDS_LIMIT),
      WITHOUT(contacts.totals, NEEDS_TOTALS),
      WITHOUT(contacts.distance, NEEDS_DISTANCE),
      WITHOUT(contacts.torque, NEEDS_TORQUE),
      WITHOUT(errors.elem_error, NEEDS_ELEM_ERROR),
      WITHOUT(body.flow, NEEDS_FLOW | NEEDS_ALPHA)};
  MADE_UP *made = made_up_new(3, 2, 3);
  made_up_advance(made, 2);
  for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
    state s = made->s;
    const column *c;
    memset((char *)&s + rows[k].at, 0, sizeof(void *));
    for (column_walk w = {0}; (c = column_next(&w)) != NULL;)
      ck_assert_msg(!column_visible(c, &made->m) ||
                        column_ready(c, &s) == !(c->needs & rows[k].bits),
                    "%s", c->name);
  }
}

static const column *named(const made_up *made, entity of, const char *name) {
  const column *c;
  for (column_walk k = {0}; (c = column_next(&k)) != NULL;)
    if (c->of == of && column_visible(c, &made->m) &&
        strcmp(c->name, name) == 0)
      return c;
  ck_abort_msg("no column %s", name);
  return NULL;
}

static double value_of(const made_up *made, entity of, const char *name,
                       int id) {
  view v = {&made->m, made->msh, &made->s};
  const column *c = named(made, of, name);
  return c->value(&v, id, c->part);
}

/* n = -y, t1 = x, t2 = z; area 0.25: force (r_t1, -r_n, r_t2). */
TEST(contact_signs_and_directions) {
  MADE_UP *made = made_up_new(3, 2, 3);
  made_up_advance(made, 1);
  double *r = made->array[MADE_RC] + 3 * 4;
  r[0] = -2;
  r[1] = 0.5;
  r[2] = -0.25;
  ck_assert(value_of(made, PER_CONTACT_NODE, "f_n", 4) == 2);
  ck_assert(value_of(made, PER_CONTACT_NODE, "pressure", 4) == 8);
  ck_assert(value_of(made, PER_CONTACT_NODE, "traction_t1", 4) == 2);
  ck_assert(value_of(made, PER_CONTACT_NODE, "traction_t2", 4) == -1);
  ck_assert(value_of(made, PER_CONTACT_NODE, "f_x", 4) == 0.5);
  ck_assert(value_of(made, PER_CONTACT_NODE, "f_y", 4) == 2);
  ck_assert(value_of(made, PER_CONTACT_NODE, "f_z", 4) == -0.25);
  ck_assert(value_of(made, PER_CONTACT, "normal", 0) == 2.5);
  made->m.n.contact = 2; /* the column is there for several               */
  ck_assert(value_of(made, PER_CONTACT_NODE, "contact_no", 4) == 1);
  made->m.n.contact = 1;
}

/* Stresses with known principal values: turned ones, equal ones, none. */
TEST(principal_stresses_are_those_of_the_tensor) {
  static const struct {
    double stress[6], principal[3]; /* xx yy zz xy yz zx                      */
  } tensors[] = {{{0}, {0, 0, 0}},
                 {{2, 2, 2, 0, 0, 0}, {2, 2, 2}},
                 {{-3, 5, 1, 0, 0, 0}, {5, 1, -3}},
                 {{0, 0, 0, 4, 0, 0}, {4, 0, -4}},
                 {{1, 1, 1, 1, 1, 1}, {3, 0, 0}},
                 {{2, 2, 2, -1, -1, -1}, {3, 3, 0}},
                 {{2, 3, 4, -2, -2, 0}, {6, 3, 0}}};
  MADE_UP *made = made_up_new(3, 2, 3);
  made_up_advance(made, 1);
  for (size_t i = 0; i < sizeof tensors / sizeof *tensors; ++i) {
    memcpy(made->array[MADE_STRESS], tensors[i].stress, sizeof(double[6]));
    for (int k = 0; k < 3; ++k) {
      PRINTED(name, "principal_%d", k + 1);
      ck_assert_double_eq_tol(value_of(made, PER_ELEMENT, name, 0),
                              tensors[i].principal[k], 1e-14);
    }
  }
}

/* In a corner the rows of the second obstacle, whatever its number, are no
 * friction. */
TEST(force_of_a_second_obstacle_is_no_friction) {
  MADE_UP *made = made_up_new(3, 2, 3);
  made_up_advance(made, 1);
  FREED int *side = calloc(2 * (size_t)made->surface.n, sizeof *side);
  for (int i = 0; i < 2 * made->surface.n; ++i) side[i] = i % 3 - 1;
  made->surface.side_id = side;
  for (int i = 0; i < made->surface.n; ++i)
    for (int k = 0; k < 2; ++k) {
      const double force = made->array[MADE_RC][3 * i + 1 + k];
      const double wanted = side[2 * i + k] < 0 ? force : 0;
      ck_assert(value_of(made, PER_CONTACT_NODE, k == 0 ? "f_t1" : "f_t2", i) ==
                wanted);
      ck_assert(value_of(made, PER_CONTACT_NODE,
                         k == 0 ? "traction_t1" : "traction_t2",
                         i) == 4 * wanted);
    }
  made->surface.side_id = NULL;
}

/* Uniaxial: the stress itself; pure shear: sqrt(3) of it; pressure: 0. */
TEST(mises_of_simple_states) {
  MADE_UP *made = made_up_new(3, 1, 3);
  made_up_advance(made, 1);
  double *s = made->array[MADE_STRESS];
  memset(s, 0, 18 * sizeof *s);
  s[2] = -7;
  s[6 + 3] = 2 * sqrt(2.0 / 3);
  s[6 + 5] = 2 / sqrt(3.0);
  s[12] = s[13] = s[14] = -5;
  ck_assert_double_eq_tol(value_of(made, PER_ELEMENT, "mises", 0), 7, 1e-14);
  ck_assert_double_eq_tol(value_of(made, PER_ELEMENT, "mises", 1), 2 * sqrt(3),
                          1e-14);
  ck_assert(value_of(made, PER_ELEMENT, "mises", 2) == 0);
}

/* Three elements flow, with 2, 1 and 3 variables. */
TEST(internal_variables_of_unlike_laws) {
  MADE_UP *made = made_up_new(2, 2, 3);
  made_up_advance(made, 1);
  const size_t start[] = {0, 2, 3, 6};
  const int elem[] = {1, 3, 4};
  double alpha[] = {10, 11, 20, 30, 31, 32}, ei[12];
  const double expected[3][3] = {{10, 11, 0}, {20, 0, 0}, {30, 31, 32}};
  for (int i = 0; i < 12; ++i) ei[i] = 100 + i;
  flow x = {.ns = 4, .n = 3, .alpha_at = (size_t *)start};
  flow_state inelastic = {.alpha = alpha, .ei = ei};
  made->s.body.flow = &x;
  made->s.body.flow_elem = elem;
  made->s.body.inelastic = &inelastic;
  view v = {&made->m, made->msh, &made->s};
  int seen = 0;
  const column *c;
  for (column_walk k = {0}; (c = column_next(&k)) != NULL;) {
    if (c->of != PER_ELEMENT) continue;
    if (strncmp(c->name, "alpha_", 6) == 0)
      for (int i = 0; i < 3; ++i, ++seen)
        ck_assert_double_eq(c->value(&v, elem[i], c->part),
                            c->part < 3 ? expected[i][c->part] : 0);
    if (strncmp(c->name, "alpha_", 6) == 0 || strncmp(c->name, "ei_", 3) == 0)
      ck_assert_double_eq(c->value(&v, 2, c->part), 0);
    if (strcmp(c->name, "ei_yy") == 0)
      ck_assert_double_eq(c->value(&v, 4, c->part), 100 + 2 * 4 + 1);
  }
  ck_assert_int_eq(seen, 3 * 12);
  made->s.body.flow = NULL;
}

/* n = -y, t1 = x, t2 = z; slip (3, 4) in them. */
TEST(slip_has_a_direction) {
  MADE_UP *made = made_up_new(3, 2, 3);
  made_up_advance(made, 1);
  double *slip = made->array[MADE_SLIP] + 2 * 4;
  slip[0] = 3e-3;
  slip[1] = -4e-3;
  made->status[4] = CONTACT_SLIP;
  ck_assert_double_eq_tol(value_of(made, PER_CONTACT_NODE, "slip_dir_x", 4),
                          0.6, 1e-14);
  ck_assert_double_eq(value_of(made, PER_CONTACT_NODE, "slip_dir_y", 4), 0);
  ck_assert_double_eq_tol(value_of(made, PER_CONTACT_NODE, "slip_dir_z", 4),
                          -0.8, 1e-14);
  made->status[4] = CONTACT_STICK;
  ck_assert_double_eq(value_of(made, PER_CONTACT_NODE, "slip_dir_x", 4), 0);
}

/* The column of that name in a scene, whether visible or not. */
static double told(const made_up *made, entity of, unsigned scene,
                   const char *name) {
  view v = {&made->m, made->msh, &made->s};
  const column *c;
  for (column_walk k = {0}; (c = column_next(&k)) != NULL;)
    if (c->of == of && (c->scenes & scene) != 0 && strcmp(c->name, name) == 0)
      return c->value(&v, 0, c->part);
  ck_abort_msg("no column %s", name);
  return NAN;
}

typedef struct named_value {
  const char *name;
  double value;
} named_value;

static void check_told(const made_up *made, entity of, unsigned scene, size_t n,
                       const named_value *list) {
  for (size_t i = 0; i < n; ++i)
    ck_assert_msg(told(made, of, scene, list[i].name) == list[i].value, "%s",
                  list[i].name);
}
#define CHECK_TOLD(of, scene, list) \
  check_told(made, of, scene, sizeof list / sizeof *list, list)

/* Every figure of a contact and of an increment is that of its name. */
TEST(figures_stand_under_their_names) {
  MADE_UP *made = made_up_new(3, 1, 3);
  made_up_advance(made, 1);
  made->totals[0] = (contact_total){.force = {1, 2, 3},
                                    .moment = {4, 5, 6},
                                    .normal = -7,
                                    .tangential = {8, 9},
                                    .area = 10,
                                    .n_open = 11,
                                    .n_slip = 12,
                                    .n_stick = 13};
  made->loops[0] = (contact_loop){.way = {21, 22},
                                  .mean_u_t = {23, 24},
                                  .angle = 25,
                                  .friction = 26,
                                  .friction_end = 27,
                                  .start_end = 20.5};
  made->torque[0] = 28;
  made->zones[0] = (contact_zone){
      .from = {31, 32}, .to = {33, 34}, .length = 35, .area = 36};
  made->s.energy = (energies){.strain = 41,
                              .external = 42,
                              .friction = 43,
                              .friction_end = 44,
                              .normal = 45,
                              .thermal = 46,
                              .inelastic = 47,
                              .dissipated = 48,
                              .stored = 49,
                              .defect = 50,
                              .largest = 100};
  made->s.errors.error =
      (error_bound){.energy = 51, .relative = 0.52, .rate = 53};
  made->s.errors.mesh_error = (error_share){.asked = 1, .relative = 0.54};
  made->s.errors.time_error = (error_share){.asked = 1, .relative = 0.55};
  made->s.errors.exact = (true_error){
      .energy = 0.56, .displacement = 0.57, .stress = 0.58, .pressure = 0.59};
  static const named_value solid[] = {
      {"force_x", 1},        {"force_y", 2},
      {"force_z", 3},        {"moment_x", 4},
      {"moment_y", 5},       {"moment_z", 6},
      {"normal", 7},         {"tangential_1", 8},
      {"tangential_2", 9},   {"closed_area", 10},
      {"open", 11},          {"slip", 12},
      {"stick", 13},         {"way_1", 21},
      {"way_2", 22},         {"mean_u_t1", 23},
      {"mean_u_t2", 24},     {"angle", 25},
      {"friction_work", 26}, {"friction_work_end", 27},
      {"loop_area", 6.5},    {"torque", 28}};
  static const named_value turned[] = {{"force_r", 1},
                                       {"force_z", 2},
                                       {"tangential", 8},
                                       {"way", 21},
                                       {"mean_u_t", 23}};
  static const named_value zones[] = {{"r_from", 31}, {"z_from", 32},
                                      {"r_to", 33},   {"z_to", 34},
                                      {"extent", 35}, {"area", 36}};
  static const named_value plane[] = {
      {"x_from", 31}, {"y_from", 32}, {"x_to", 33}, {"y_to", 34}};
  static const named_value increment[] = {
      {"strain_energy", 41},
      {"external_work", 42},
      {"friction_work", 43},
      {"friction_work_end", 44},
      {"normal_work", 45},
      {"thermal_work", 46},
      {"inelastic_work", 47},
      {"viscous_dissipation", 48},
      {"inelastic_stored", 49},
      {"energy_defect", 50},
      {"energy_defect_relative", 0.5},
      {"solver_error_energy", 51},
      {"solver_error", 100 * 0.52},
      {"contraction", 53},
      {"mesh_error", 100 * 0.54},
      {"time_error", 100 * 0.55},
      {"true_error", 100 * 0.56},
      {"true_displacement_error", 100 * 0.57},
      {"true_stress_error", 100 * 0.58},
      {"true_pressure_error", 100 * 0.59}};
  CHECK_TOLD(PER_CONTACT, SCENE_SOLID, solid);
  CHECK_TOLD(PER_CONTACT, SCENE_AXI, turned);
  CHECK_TOLD(PER_ZONE, SCENE_AXI, zones);
  CHECK_TOLD(PER_ZONE, SCENE_PLANE, plane);
  CHECK_TOLD(PER_INCREMENT, SCENE_SOLID, increment);
}

enum { CARTESIAN = SCENE_PLANE | SCENE_SOLID };

/* Components by their letters, of vectors and tensors: in a body of revolution
 * r, z, then the hoop. */
TEST(components_are_those_of_their_letters) {
  static const struct {
    const char *end;
    unsigned scenes;
    int part;
  } letters[] = {
      {"_xx", CARTESIAN, 0},  {"_yy", CARTESIAN, 1},   {"_zz", CARTESIAN, 2},
      {"_xy", CARTESIAN, 3},  {"_yz", SCENE_SOLID, 4}, {"_zx", SCENE_SOLID, 5},
      {"_rr", SCENE_AXI, 0},  {"_zz", SCENE_AXI, 1},   {"_tt", SCENE_AXI, 2},
      {"_rz", SCENE_AXI, 3},  {"_x", CARTESIAN, 0},    {"_y", CARTESIAN, 1},
      {"_r", SCENE_AXI, 0},   {"_z", SCENE_AXI, 1},    {"_z", SCENE_SOLID, 2},
      {"t1", SCENE_SOLID, 0}, {"t2", SCENE_SOLID, 1},  {"_1", SCENE_SOLID, 0},
      {"_2", SCENE_SOLID, 1}};
  int seen = 0;
  const column *c;
  for (column_walk k = {0}; (c = column_next(&k)) != NULL;)
    for (size_t i = 0; i < sizeof letters / sizeof *letters; ++i) {
      const size_t n = strlen(c->name), m = strlen(letters[i].end);
      if (n < m || strcmp(c->name + n - m, letters[i].end) != 0) continue;
      if (strncmp(c->name, "alpha", 5) == 0 ||
          (c->scenes & letters[i].scenes) == 0)
        continue;
      ck_assert_msg(c->part == letters[i].part, "%s: %d", c->name, c->part);
      ++seen;
    }
  ck_assert_int_gt(seen, 70);
}

TEST(units_are_composed_from_the_labels) {
  model m = {.unit.length = "mm", .unit.force = "N"};
  ck_assert_str_eq(model_unit(&m, "force/length^2"), "N/mm^2");
  ck_assert_str_eq(model_unit(&m, "force*length"), "N*mm");
  ck_assert_str_eq(model_unit(&m, "time"), "time");
  ck_assert_str_eq(model_unit(&m, "-"), "-");
  char label[2 * TEXT_BUFFER] = "";
  memset(label, 'm', sizeof label - 1);
  m.unit.length = label;
  ck_assert_uint_eq(strlen(model_unit(&m, "length")), 79);
}

UNIT_MAIN("columns")
