/* src/base/message.c: order, caret, chain of includes, totals, manual. */
#include "base/message.h"
#include "support/unit.h"

static char text[20000]; /* what was printed last                             */

static const char *printed(const message_log *log) {
  memset(text, 0, sizeof text);
  FILE *f = fmemopen(text, sizeof text - 1, "w");
  message_print(log, f);
  fclose(f);
  return text;
}

static message_log *new_log(void) {
  message_log *log = NULL;
  ck_assert_int_eq(message_log_new(&log), OK);
  return log;
}

TEST(a_message_shows_place_line_and_caret) {
  OWNED message_log *log = new_log();
  place at = {"block.inp", 14, 12, "*FRICTON, CONTACT=FOOT", NULL, 0};
  message_add(log, P1003, &at, "unknown card *%s", "FRICTON");
  ck_assert_str_eq(printed(log),
                   "block.inp:14:12: error P1003: unknown card *FRICTON\n"
                   "      14 | *FRICTON, CONTACT=FOOT\n"
                   "         |            ^\n"
                   "1 error; protis --explain P1003 says what to do\n");
}

TEST(the_caret_stands_below_tabs_and_letters_of_two_bytes) {
  OWNED message_log *log = new_log();
  place at = {"a", 1, 8, "\tA\xC3\xA4,\tB", NULL, 0};
  message_add(log, P1003, &at, "x");
  at.column_no = 1;
  message_add(log, P1003, &at, "y");
  ck_assert_str_eq(printed(log),
                   "a:1:1: error P1003: y\n"
                   "       1 | \tA\xC3\xA4,\tB\n"
                   "         | ^\n"
                   "a:1:8: error P1003: x\n"
                   "       1 | \tA\xC3\xA4,\tB\n"
                   "         | \t   \t ^\n"
                   "2 errors; protis --explain P1003 says what to do\n");
}

TEST(a_place_may_lack_column_line_or_file) {
  OWNED message_log *log = new_log();
  place no_column = {"a", 3, 0, "text", NULL, 0},
        no_line = {"a", 0, 5, NULL, NULL, 0};
  message_add(log, P1003, &no_column, "one");
  message_add(log, P1003, &no_line, "two");
  message_add(log, P1003, NULL, "three");
  ck_assert_str_eq(printed(log),
                   "a: error P1003: two\n"
                   "a:3: error P1003: one\n"
                   "       3 | text\n"
                   "error P1003: three\n"
                   "3 errors; protis --explain P1003 says what to do\n");
}

/* In the order in which the input is read: an include stands where its card
 * stands, whatever the order of the messages. */
/* As after --restart, which keeps no place for one without a file. */
TEST(a_warning_or_note_without_a_place_is_told_once) {
  OWNED message_log *log = new_log();
  const place nowhere = {0};
  message_add(log, P2058, NULL, "one");
  message_add(log, P2058, &nowhere, "one");
  ck_assert_int_eq(message_count(log, WARNING), 1);
  message_add(log, P4003, &nowhere, "two");
  message_add(log, P4003, NULL, "two");
  ck_assert_int_eq(message_count(log, NOTE), 1);
}

TEST(messages_come_in_the_order_of_the_input) {
  OWNED message_log *log = new_log();
  place include = {"a", 5, 2, NULL, NULL, 0},
        deeper = {"b", 2, 1, NULL, &include, 0};
  place at[] = {{"a", 5, 3, NULL, NULL, 0},     {"a", 9, 1, NULL, NULL, 0},
                {"a", 4, 7, NULL, NULL, 0},     {"b", 8, 1, NULL, &include, 0},
                {"b", 1, 1, NULL, &include, 0}, {"c", 90, 1, NULL, &deeper, 0},
                {"a", 4, 2, NULL, NULL, 0},     {"m.msh", 1, 1, NULL, NULL, 0}};
  static const char *const names[] = {"3", "7", "2", "6", "4", "5", "1", "8"};
  for (size_t i = 0; i < sizeof at / sizeof *at; ++i)
    message_add(log, P1003, &at[i], "[%s]", names[i]);
  const char *p = printed(log);
  for (char c = '1'; c <= '8'; ++c) {
    const char wanted[] = {'[', c, ']', '\0'};
    const char *found = strstr(p, wanted);
    ck_assert_msg(found != NULL, "%s missing or out of order:\n%s", wanted,
                  text);
    p = found;
  }
  ck_assert_ptr_nonnull(strstr(text,
                               "c:90:1: error P1003: [5]\n"
                               "           included from b:2\n"
                               "           included from a:5\n"));
}

TEST(the_texts_are_copies) {
  OWNED message_log *log = new_log();
  char file[] = "a.inp", line[] = "*STEP";
  place at = {file, 1, 1, line, NULL, 0};
  message_add(log, P1003, &at, "x");
  memset(file, '#', sizeof file - 1);
  memset(line, '#', sizeof line - 1);
  ck_assert_ptr_nonnull(strstr(printed(log), "a.inp:1:1"));
  ck_assert_ptr_nonnull(strstr(text, "| *STEP\n"));
}

TEST(a_long_line_is_cut_around_the_column) {
  OWNED message_log *log = new_log();
  char line[4001];
  for (int i = 0; i < 4000; ++i) line[i] = (char)('a' + i % 10);
  line[4000] = '\0';
  line[2000] = '#';
  place at = {"a", 1, 2001, line, NULL, 0};
  message_add(log, P1003, &at, "x");
  const char *shown = strchr(printed(log), '|');
  const char *hash = strchr(shown, '#'), *below = strchr(shown + 1, '|');
  ck_assert_ptr_nonnull(strstr(shown, "..."));
  ck_assert_int_eq((int)(hash - shown), (int)(strchr(below, '^') - below));
  ck_assert_uint_lt(strlen(text), 500);
}

TEST(control_characters_are_not_printed) {
  OWNED message_log *log = new_log();
  place at = {"a", 1, 1, "x\x1b[2J\x07", NULL, 0};
  message_add(log, P1003, &at, "bad \x1b[31m");
  for (const char *p = printed(log); *p != '\0'; ++p)
    ck_assert((unsigned char)*p >= ' ' || *p == '\n');
}

TEST(a_text_longer_than_the_room_is_cut) {
  OWNED message_log *log = new_log();
  char name[4000];
  memset(name, 'N', sizeof name - 1);
  name[sizeof name - 1] = '\0';
  message_add(log, P1003, NULL, "unknown card *%s", name);
  ck_assert_ptr_nonnull(strstr(printed(log), "NNN...\n"));
}

TEST(after_a_hundred_errors_the_rest_is_counted) {
  OWNED message_log *log = new_log();
  message_add(log, P1030, NULL, "of the run");
  const message_mark before = message_now(log);
  for (int i = 1; i <= 250; ++i) {
    ck_assert_int_eq(message_wanted(log), i <= 100);
    place at = {"a", i, 1, "x", NULL, 0};
    message_add(log, P1003, &at, "number %d", i);
  }
  place at = {"a", 999, 1, "x", NULL, 0};
  message_add(log, P1030, &at, "a warning");
  ck_assert_int_eq(message_count(log, ERROR), 250);
  ck_assert_int_eq(message_count(log, WARNING), 2);
  ck_assert_ptr_nonnull(strstr(printed(log), "number 100\n"));
  ck_assert_ptr_null(strstr(text, "number 101\n"));
  ck_assert_ptr_nonnull(strstr(text,
                               "\n250 errors (100 shown), 2 warnings; protis "
                               "--explain P1003 says what to do\n"));
  ck_assert_int_eq(message_status(log, ERR_MESH), ERR_MESH);
  ck_assert_str_eq(status_message(), "250 errors in the input");
  /* of a trial that was given up */
  message_forget(log, before);
  ck_assert_int_eq(message_status(log, ERR_MESH), OK);
  ck_assert_str_eq(printed(log), "warning P1030: of the run\n1 warning\n");
  message_add(log, P1003, NULL, "of the run");
  message_forget(log, message_now(log));
  OWNED message_log *other = new_log();
  message_take(other, log);
  ck_assert_int_eq(message_count(log, ERROR), 1);
  ck_assert_int_eq(message_count(other, ERROR), 1);
  ck_assert_int_eq(message_count(other, WARNING), 1);
}

TEST(an_empty_log_prints_nothing_and_is_ok) {
  OWNED message_log *log = new_log();
  ck_assert_str_eq(printed(log), "");
  ck_assert_int_eq(message_status(log, ERR_DECK), OK);
  message_add(log, P1030, NULL, "only a warning");
  ck_assert_int_eq(message_status(log, ERR_DECK), OK);
  ck_assert_str_eq(printed(log), "warning P1030: only a warning\n1 warning\n");
  memory_free(NULL);
}

/* The listing must not depend on the folder. */
TEST(the_list_for_the_listing_has_no_folder_and_no_source) {
  OWNED message_log *log = new_log();
  place at = {"/some/where/a.inp", 2, 3, "text", NULL, 0};
  message_add(log, P1030, &at, "one");
  message_add(log, P1003, &at, "two");
  memset(text, 0, sizeof text);
  FILE *f = fmemopen(text, sizeof text - 1, "w");
  message_list(log, WARNING, f);
  fclose(f);
  ck_assert_str_eq(text, "a.inp:2:3: warning P1030: one\n");
}

static int explained(const char *number) {
  memset(text, 0, sizeof text);
  FILE *f = fmemopen(text, sizeof text - 1, "w");
  int known = message_explain(number, f);
  fclose(f);
  return known;
}

TEST(each_number_has_a_manual_entry) {
#define NUMBER(number, severity, title, remedy) number,
#define TITLE(number, severity, title, remedy) title,
#define REMEDY(number, severity, title, remedy) remedy,
  static const int numbers[] = {MESSAGE_LIST(NUMBER)};
  static const char *const titles[] = {MESSAGE_LIST(TITLE)};
  static const char *const remedies[] = {MESSAGE_LIST(REMEDY)};
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; ++i) {
    PRINTED(number, "P%d", numbers[i]);
    ck_assert(explained(number));
    ck_assert_ptr_nonnull(strstr(text, titles[i]));
    ck_assert_ptr_nonnull(strstr(text, number));
    ck_assert(explained(number + 1));
    ck_assert_uint_gt(strlen(remedies[i]), 15);
    for (size_t j = 0; j < i; ++j) ck_assert_int_ne(numbers[i], numbers[j]);
    for (const char *p = strtok(text, "\n"); p; p = strtok(NULL, "\n"))
      ck_assert_msg(strlen(p) <= 80, "%s", p);
  }
}

TEST(an_unknown_number_is_not_explained) {
  ck_assert(!explained("P9999"));
  ck_assert(!explained("P10030"));
  ck_assert(!explained("P100"));
  ck_assert(!explained(""));
  ck_assert(!explained("PP1003"));
  ck_assert(!explained("1003x"));
  ck_assert(explained(NULL));
  ck_assert_ptr_nonnull(strstr(text, "P1001"));
  ck_assert_ptr_nonnull(strstr(text, "P2003"));
}

TEST(without_memory_messages_are_counted_and_reported) {
  place include = {"a", 5, 2, "x", NULL, 0}, at = {"b", 2, 1, "y", &include, 0};
  size_t before = memory_in_use();
  for (long k = 1, refused = 1; refused; ++k) {
    message_log *log = new_log();
    long start = memory_requests();
    memory_refuse(k, 0);
    for (int i = 0; i < 20; ++i) message_add(log, P1003, &at, "number %d", i);
    refused = k <= memory_requests() - start;
    memory_refuse(0, 0);
    ck_assert_int_eq(message_count(log, ERROR), 20);
    ck_assert_int_eq(message_status(log, ERR_DECK),
                     refused ? ERR_MEMORY : ERR_DECK);
    ck_assert_ptr_nonnull(strstr(printed(log), "20 errors"));
    memory_free(log);
    ck_assert_uint_eq(memory_in_use(), before);
  }
}

TEST(printing_does_without_memory) {
  OWNED message_log *log = new_log();
  message_add(log, P1003, NULL, "one");
  memory_refuse(1, 1);
  ck_assert_str_eq(printed(log), "error P1003: one\n1 error\n");
  memory_refuse(0, 0);
}

UNIT_MAIN("message")
