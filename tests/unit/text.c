/* src/base/text.c */
#define _GNU_SOURCE /* fopencookie */
#include "support/folder.h"
#include "support/unit.h"

#include <errno.h>
#include <fcntl.h>
#include <unistd.h>

TEST(seventeen_digits_read_back_exactly) {
  const double special[] = {0.1,    -1.0 / 3, DBL_MAX, DBL_MIN,
                            5e-324, 1e100,    -1e-100, 9.9999999999999999e22};
  for (size_t i = 0; i < sizeof special / sizeof *special; ++i)
    ck_assert(strtod(text_number(special[i], 16), NULL) == special[i]);
  double x = 1e-200;
  for (int i = 0; i < 3000; ++i) {
    x *= -(1.3 + 0.1 * sin(i));
    ck_assert(strtod(text_number(x, 16), NULL) == x);
  }
}

TEST(exponents_have_three_digits_and_zero_no_sign) {
  ck_assert_str_eq(text_number(1.5, 4), "1.5000E+000");
  ck_assert_str_eq(text_number(-1.5e-7, 1), "-1.5E-007");
  ck_assert_str_eq(text_number(2e-300, 2), "2.00E-300");
  ck_assert_str_eq(text_number(2e300, 2), "2.00E+300");
  ck_assert_str_eq(text_number(-0.0, 2), "0.00E+000");
  ck_assert_str_eq(text_number(NAN, 2), "NaN");
  ck_assert_str_eq(text_number(-NAN, 2), "NaN");
  ck_assert_str_eq(text_number(INFINITY, 2), "Inf");
  ck_assert_str_eq(text_number(-INFINITY, 2), "-Inf");
}

TEST(wrapped_words_keep_their_order_and_the_indent) {
  char written[2000] = "", words[1000] = "", *line = written;
  for (int i = 0; i < 60; ++i)
    sprintf(words + strlen(words), "%.*s%d ", i % 9, "xxxxxxxxx", i);
  FILE *f = fmemopen(written, sizeof written, "w");
  fprintf(f, "%7s", "");
  text_wrap(f, words, 7);
  fclose(f);
  int i = 0, lines = 0;
  for (char *end; (end = strchr(line, '\n')) != NULL; line = end + 1, ++lines) {
    ck_assert_int_le(end - line, 78);
    ck_assert_int_eq((int)strspn(line, " "), 7);
  }
  ck_assert_int_ge(lines, 4);
  for (char *word = strtok(written, " \n"); word != NULL;
       word = strtok(NULL, " \n"), ++i)
    ck_assert_int_eq(atoi(word + strspn(word, "x")), i);
  ck_assert_int_eq(i, 60);
}

TEST(a_word_has_no_blank) {
  char word[6];
  text_word(word, sizeof word, "a\tb c d");
  ck_assert_str_eq(word, "a_b_c");
}

TEST(paths_are_joined_once) {
  const char *const dirs[] = {NULL, "", "out", "out/"};
  const char *const wanted[] = {"job.lst", "job.lst", "out/job.lst",
                                "out/job.lst"};
  for (int i = 0; i < 4; ++i) {
    OWNED char *path = text_path(dirs[i], "job", "lst");
    ck_assert_str_eq(path, wanted[i]);
  }
}

/* A file of a disk that is full. */
static void open_full(text_file *t, const char *path, int by_line) {
  ck_assert_int_eq(text_open(t, path, by_line), OK);
  int full = open("/dev/full", O_RDWR);
  ck_assert_int_eq(dup2(full, fileno(t->f)), fileno(t->f));
  close(full);
}

TEST(full_disk_is_told_with_file_and_reason) {
  text_file t = {0};
  FOLDER(dir);
  PRINTED(path, "%s/a.lst", dir);
  open_full(&t, path, 1);
  fprintf(t.f, "one line\n");
  ck_assert_int_eq(text_check(&t), ERR_FILE);
  ck_assert_ptr_nonnull(strstr(status_message(), path));
  ck_assert_ptr_nonnull(strstr(status_message(), "No space left"));
  text_close(&t);
  open_full(&t, path, 0);
  fprintf(t.f, "kept in the buffer until it is closed\n");
  ck_assert_int_eq(text_close(&t), ERR_FILE);
  ck_assert_ptr_nonnull(strstr(status_message(), "No space left"));
}

static ssize_t refuse_blocks(void *file, const char *bytes, size_t n) {
  errno = EDQUOT;
  return -1;
}

/* A write that fails while the file is checked names its own reason, not that
 * of a second one. */
TEST(reason_of_a_failed_write_is_the_first) {
  cookie_io_functions_t refuse = {.write = refuse_blocks};
  text_file t = {.f = fopencookie(NULL, "w", refuse), .path = "a.lst"};
  fprintf(t.f, "in the buffer\n");
  ck_assert_int_eq(text_check(&t), ERR_FILE);
  ck_assert_ptr_nonnull(strstr(status_message(), strerror(EDQUOT)));
  fclose(t.f);
}

TEST(missing_folder_is_told) {
  text_file t = {0};
  size_t before = memory_in_use();
  ck_assert_int_eq(text_open(&t, "/no/such/folder/a.lst", 1), ERR_FILE);
  ck_assert_ptr_nonnull(strstr(status_message(), "/no/such/folder/a.lst"));
  ck_assert_ptr_nonnull(strstr(status_message(), "No such file"));
  ck_assert_int_eq(text_close(&t), OK);
  ck_assert_uint_eq(memory_in_use(), before);
}

TEST(lines_are_handed_over_as_they_end) {
  FOLDER(dir);
  PRINTED(path, "%s/a.sta", dir);
  text_file t = {0};
  ck_assert_int_eq(text_open(&t, path, 1), OK);
  fprintf(t.f, "first\nsec");
  FREED char *seen = folder_file(dir, "a.sta", NULL);
  ck_assert_ptr_nonnull(strstr(seen, "first\n"));
  ck_assert_int_eq(text_close(&t), OK);
}

/* What is shown, and the way back to the bytes. */
TEST(text_from_outside_is_shown_without_control_characters) {
  static const char *const rows[][2] = {
      {"", ""},
      {"plain\ttab \303\251 \342\202\254 \360\237\230\200",
       "plain\ttab \303\251 \342\202\254 \360\237\230\200"},
      {"\033[2J\r\n\b\177", "\\x1B[2J\\x0D\\x0A\\x08\\x7F"},
      {"\302\205\302\240", "\\xC2\\x85\302\240"},
      {"\342\200\256\342\201\246\330\234",
       "\\xE2\\x80\\xAE\\xE2\\x81\\xA6\\xD8\\x9C"},
      {"\355\240\200\300\200\377\303", "\\xED\\xA0\\x80\\xC0\\x80\\xFF\\xC3"},
      {"\\x1B \\x41", "\\x1B \\x41"}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
    char shown[200], back[200];
    ck_assert_uint_eq(text_shown(shown, sizeof shown, rows[i][0]),
                      strlen(rows[i][1]));
    ck_assert_str_eq(shown, rows[i][1]);
    text_shown(back, sizeof back, shown);
    ck_assert_str_eq(back, shown);
    text_plain(back);
    if (strstr(rows[i][0], "\\x") == NULL && strchr(rows[i][0], '\n') == NULL)
      ck_assert_str_eq(back, rows[i][0]);
  }
  char cut[5];
  ck_assert_uint_eq(text_shown(cut, sizeof cut, "ab\033c"), 2);
  ck_assert_str_eq(cut, "ab");
}

/* Fortran: what is longer is cut, what is shorter filled with blanks. */
TEST(joined_as_in_fortran) {
  for (size_t n = 0; n <= 6; ++n) {
    char to[] = "-------";
    _gfortran_concat_string(n, to, 2, "ab", 2, "cd");
    ck_assert(memcmp(to, "abcd  ", n) == 0 && to[n] == '-');
  }
}

UNIT_MAIN("text")
