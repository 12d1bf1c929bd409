/* src/output/tabular.c: JOB.dat of a made-up run, read back word by word. */
#include "output/writers.h"
#include "support/folder.h"
#include "support/made_up.h"
#include "support/unit.h"

/* The whole JOB.dat of "told" increments, closed after "cut" of them and opened
 * again where it ended; caller frees. */
static char *write_cut(made_up *made, int told, int cut) {
  long length = -1;
  tabular *t = NULL;
  FOLDER(dir);
  for (int from = 0, to = cut; from < told; from = to, to = told) {
    ck_assert_int_eq(tabular_open(&made->m, made->msh, dir, length, &t), OK);
    for (int i = from + 1; i <= to; ++i) {
      made_up_advance(made, i);
      ck_assert_int_eq(tabular_increment(t, &made->s), OK);
    }
    ck_assert_int_eq(tabular_sync(t, &length), OK);
    ck_assert_int_eq(tabular_close(t), OK);
    if (to == told) break;
  }
  return folder_file(dir, "block.dat", NULL);
}

static char *write_tables(made_up *made, int told) {
  return write_cut(made, told, told);
}

/* Text of block number k of a kind, ended by the first empty line. */
static char *block_of(const char *text, const char *kind, int k) {
  PRINTED(head, " table %s", kind);
  const char *p = text;
  for (int i = 0; i <= k; ++i) {
    p = strstr(p, head);
    if (p == NULL) return NULL;
    p = strchr(p, '\n') + 1;
  }
  const char *end = strstr(p, "\n\n");
  size_t size = end != NULL ? (size_t)(end - p) : strlen(p);
  char *block = calloc(size + 2, 1);
  memcpy(block, p, size);
  return block;
}

/* Word number place_no of row number "row" (0: the header, without its #). */
static char *cell(const char *block, int row, int place_no, char word[80]) {
  for (int i = 0; i < row; ++i) {
    block = strchr(block, '\n');
    if (block == NULL) return NULL;
    ++block;
  }
  if (row == 0) ++block;
  for (int i = 0; i <= place_no; ++i) {
    int used = 0;
    if (sscanf(block, "%79s%n", word, &used) != 1) return NULL;
    if (memchr(block, '\n', (size_t)used) != NULL && i > 0) return NULL;
    block += used;
  }
  return word;
}

static int column_named(const char *block, const char *name) {
  char word[80];
  for (int c = 0; cell(block, 0, c, word) != NULL; ++c)
    if (strcmp(word, name) == 0) return c;
  ck_abort_msg("no column %s in:\n%s", name, block);
  return -1;
}

static double number(const char *block, int row, const char *name) {
  char word[80];
  ck_assert_ptr_nonnull(cell(block, row, column_named(block, name), word));
  return strtod(word, NULL);
}

static int count_rows(const char *block) {
  char word[80];
  int n = 0;
  while (cell(block, n + 1, 0, word) != NULL) ++n;
  return n;
}

TEST(nodes_read_back_exactly_in_the_order_of_their_numbers) {
  MADE_UP *made = made_up_new(3, 2, 2);
  FREED char *text = write_tables(made, 2), *block = block_of(text, "NODES", 1);
  int n = made->msh->n_node;
  ck_assert_int_eq(count_rows(block), n);
  for (int row = 1; row <= n; ++row) {
    int id = n - row; /* the numbers run against the ids                     */
    ck_assert(number(block, row, "node_no[-]") == 3 * row);
    ck_assert(number(block, row, "z[length]") == made->msh->x[3 * id + 2]);
    ck_assert(number(block, row, "u_x[length]") ==
              made_up_value(MADE_U, 3 * id, 2));
    ck_assert(number(block, row, "u_z[length]") ==
              made_up_value(MADE_U, 3 * id + 2, 2));
  }
}

TEST(contact_table_has_signs_and_words) {
  char word[80];
  const char *const words[] = {"OPEN", "SLIP", "STICK"};
  MADE_UP *made = made_up_new(2, 3, 2);
  FREED char *text = write_tables(made, 2),
             *block = block_of(text, "CONTACT", 0);
  int n = made->surface.n;
  ck_assert_int_eq(count_rows(block), n);
  for (int row = 1; row <= n; ++row) {
    int id = n - row;
    double f_n = -made_up_value(MADE_RC, 2 * id, 1);
    ck_assert(number(block, row, "f_n[force]") == f_n);
    ck_assert(number(block, row, "pressure[force/length^2]") == f_n / 0.25);
    ck_assert(number(block, row, "u_t[length]") ==
              made_up_value(MADE_UC, 2 * id + 1, 1));
    ck_assert(number(block, row, "slip[length]") ==
              made_up_value(MADE_SLIP, id, 1));
    cell(block, row, column_named(block, "status[-]"), word);
    ck_assert_str_eq(word, words[(id + 1) % 3]);
  }
}

TEST(element_table_names_components_by_scene) {
  MADE_UP *made = made_up_new(2, 2, 1);
  char *text = write_tables(made, 1), *block = block_of(text, "ELEMENTS", 0);
  ck_assert_int_eq(count_rows(block), made->msh->n_elem);
  ck_assert(number(block, 3, "stress_xy[force/length^2]") ==
            made_up_value(MADE_STRESS, 4 * 2 + 3, 1));
  ck_assert_ptr_null(strstr(block, "stress_yz"));
  free(block);
  free(text);
  made->body.kin = AXISYMMETRIC;
  text = write_tables(made, 1);
  block = block_of(text, "ELEMENTS", 0);
  ck_assert(number(block, 3, "stress_tt[force/length^2]") ==
            made_up_value(MADE_STRESS, 4 * 2 + 2, 1));
  ck_assert_ptr_nonnull(strstr(text, " r[length]"));
  free(block);
  free(text);
}

TEST(labels_stand_in_the_header) {
  MADE_UP *made = made_up_new(2, 1, 1);
  made->m.unit.length = "mm";
  made->m.unit.force = "kN";
  made->m.unit.time = "s";
  FREED char *text = write_tables(made, 1);
  ck_assert_ptr_nonnull(strstr(text, " pressure[kN/mm^2]"));
  ck_assert_ptr_nonnull(strstr(text, " strain_energy[kN*mm]"));
  ck_assert_ptr_nonnull(strstr(text, " time[s]"));
  ck_assert_ptr_null(strstr(text, "length"));
}

static int count_blocks(const char *text, const char *kind) {
  int n = 0;
  for (char *block; (block = block_of(text, kind, n)) != NULL; ++n) free(block);
  return n;
}

TEST(frequency_means_every_nth_and_the_last) {
  MADE_UP *made = made_up_new(2, 1, 5);
  made->prints[0].frequency = 2; /* CONTACT: 2, 4, 5                         */
  made->prints[1].frequency = 0; /* TOTALS: 5                                */
  FREED char *text = write_tables(made, 5);
  ck_assert_int_eq(count_blocks(text, "CONTACT"), 3);
  ck_assert_int_eq(count_blocks(text, "TOTALS"), 1);
  ck_assert_int_eq(count_blocks(text, "ENERGY"), 5);
  ck_assert_ptr_nonnull(
      strstr(text,
             "# step 1 increment 5 time 2.5000000000000000E+000 table "
             "TOTALS\n"));
}

TEST(groups_and_supports_choose_the_rows) {
  MADE_UP *made = made_up_new(2, 3, 1);
  int right = 0;
  while (strcmp(made->msh->group[right].name, "RIGHT") != 0) ++right;
  for (int i = 0; i < 3; ++i) { /* CONTACT, TOTALS, NODES                    */
    made->prints[i].group = "RIGHT";
    made->prints[i].group_id = right;
  }
  FREED char *text = write_tables(made, 1);
  FREED char *feet = block_of(text, "CONTACT", 0);
  FREED char *nodes = block_of(text, "NODES", 0);
  FREED char *reactions = block_of(text, "REACTIONS", 0);
  ck_assert_int_eq(count_rows(feet), 1); /* the corner                    */
  ck_assert(number(feet, 1, "x[length]") == 1);
  ck_assert_int_eq(count_rows(nodes), 4);
  for (int row = 1; row <= 4; ++row)
    ck_assert(number(nodes, row, "x[length]") == 1);
  ck_assert_int_eq(count_rows(reactions), 4); /* the support TOP             */
  for (int row = 1; row <= 4; ++row)
    ck_assert(number(reactions, row, "y[length]") == 1);
}

TEST(missing_arrays_leave_their_columns_out) {
  MADE_UP *made = made_up_new(2, 2, 1);
  made->s.body.stress = NULL;
  made->s.body.reaction = NULL;
  made->s.contacts.limit = NULL;
  FREED char *text = write_tables(made, 1);
  ck_assert_ptr_null(strstr(text, "stress_xx"));
  ck_assert_ptr_null(strstr(text, "reaction_x"));
  ck_assert_ptr_null(strstr(text, "limit["));
  ck_assert_ptr_nonnull(strstr(text, "strain_xx"));
}

TEST(every_line_keeps_blanks_between_fields) {
  MADE_UP *made = made_up_new(3, 2, 1);
  for (int i = 0; i < made->msh->n_node; ++i)
    made->msh->node_no[i] = (size_t)99999999999 - (size_t)i;
  char *text = write_tables(made, 1), word[80];
  FREED char *block = block_of(text, "NODES", 0);
  int columns = 0;
  while (cell(block, 0, columns, word) != NULL) ++columns;
  ck_assert_int_eq(columns, 7);
  for (int row = 1; row <= made->msh->n_node; ++row) {
    ck_assert_ptr_nonnull(cell(block, row, columns - 1, word));
    ck_assert_ptr_null(cell(block, row, columns, word));
  }
  free(text);
}

/* Also where nothing had been written yet. */
TEST(a_file_that_goes_on_is_that_of_one_run) {
  enum { TOLD = 3 };
  MADE_UP *made = made_up_new(2, 1, TOLD);
  FREED char *whole = write_tables(made, TOLD);
  ck_assert_ptr_nonnull(strstr(whole, " table CONTACT"));
  for (int cut = 0; cut < TOLD; ++cut) {
    FREED char *text = write_cut(made, TOLD, cut);
    ck_assert_msg(strcmp(text, whole) == 0, "cut after %d", cut);
  }
}

TEST(no_print_no_file) {
  MADE_UP *made = made_up_new(2, 1, 1);
  tabular *t = NULL;
  made->steps[0].print.n = 0;
  ck_assert_int_eq(tabular_open(&made->m, made->msh, "/nowhere", -1, &t), OK);
  ck_assert_ptr_null(t);
  ck_assert_int_eq(tabular_increment(t, &made->s), OK);
  ck_assert_int_eq(tabular_close(t), OK);
}

UNIT_MAIN("tabular")
