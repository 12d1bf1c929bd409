/* src/output: all files of a made-up run, and what happens when one fails. */
#include "output/output.h"
#include "output/hdf5/file.h"

#include "output/writers.h"
#include "support/disk.h"
#include "support/folder.h"
#include "support/made_up.h"
#include "support/unit.h"

#include <ctype.h>
#include <fcntl.h>
#include <hdf5.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

static output_options quiet(const char *dir) {
  return (output_options){.dir = dir,
                          .no_timing = 1,
                          .version = "1.2.3",
                          .kernel = "Generic",
                          .threads = 1};
}

static status tell(made_up *made, const history_sink *sink, int told) {
  solver_step iteration = {.solver = "newton",
                           .iteration = 1,
                           .residual = 0.5,
                           .limit_change = NAN,
                           .status_changes = -1};
  status st = sink->ready(sink->ctx, &made->facts, &made->surface);
  for (int i = 1; i <= told && st == OK; ++i) {
    made_up_advance(made, i);
    sink->iteration(sink->ctx, &iteration);
    if (i == 2) st = sink->rejected(sink->ctx, &made->s, "no \"convergence\"");
    if (st == OK) st = sink->increment(sink->ctx, &made->s);
  }
  return st;
}

/* The run as history_run would tell it. */
static status run(made_up *made, const output_options *o, int told) {
  output *out = NULL;
  timer_reset();
  status st = output_open(&made->m, made->msh, o, &out);
  if (st != OK) return st;
  history_sink sink = output_sink(out);
  return output_close(out, tell(made, &sink, told), 0);
}

static const char *const names[] = {"block.lst", "block.sta", "block.cvg",
                                    "block.dat", "block.h5",  "block.xdmf"};
enum { NAMES = sizeof names / sizeof *names };

TEST(two_runs_give_the_same_bytes) {
  char dir[2][64];
  for (int k = 0; k < 2; ++k) {
    folder_new(dir[k]);
    if (k == 1) { /* a longer name, and another second                       */
      strcat(dir[k], "/longer");
      ck_assert_int_eq(mkdir(dir[k], 0700), 0);
      nanosleep(&(struct timespec){1, 100000000}, NULL);
    }
    MADE_UP *made = made_up_new(2, 3, 3);
    output_options o = quiet(dir[k]);
    ck_assert_int_eq(run(made, &o, 5), OK);
  }
  for (int i = 0; i < NAMES; ++i) {
    size_t na, nb;
    FREED char *a = folder_file(dir[0], names[i], &na);
    FREED char *b = folder_file(dir[1], names[i], &nb);
    ck_assert_msg(a != NULL && na > 100, "%s", names[i]);
    ck_assert_msg(b != NULL && na == nb && memcmp(a, b, na) == 0, "%s",
                  names[i]);
    for (size_t k = 0; k + 7 < na; ++k)
      ck_assert_msg(memcmp(a + k, "protis-", 7) != 0, "path in %s", names[i]);
  }
  *strrchr(dir[1], '/') = '\0';
  folder_remove(dir[0]);
  folder_remove(dir[1]);
}

TEST(status_file_has_a_line_per_attempt) {
  FOLDER(dir);
  MADE_UP *made = made_up_new(2, 2, 3);
  output_options o = quiet(dir);
  output *out = NULL;
  ck_assert_int_eq(output_open(&made->m, made->msh, &o, &out), OK);
  history_sink sink = output_sink(out);
  ck_assert_int_eq(tell(made, &sink, 3), OK);
  /* Before the job is closed: the lines are there already. */
  char *text = folder_file(dir, "block.sta", NULL), *line = text;
  int lines = 0;
  for (; (line = strchr(line, '\n')) != NULL; ++line) ++lines;
  ck_assert_int_eq(lines, 1 + 3 + 1);
  ck_assert_ptr_nonnull(strstr(text, " CUT no \"convergence\"\n"));
  ck_assert_ptr_nonnull(strstr(text, " OK\n"));
  ck_assert_ptr_null(strstr(text, "cpu"));
  free(text);
  text = folder_file(dir, "block.cvg", NULL);
  /* total 2 was cut: the next line is its second attempt.                   */
  ck_assert_ptr_nonnull(strstr(text, "\n      2   1 newton"));
  ck_assert_ptr_nonnull(strstr(text, "\n      3   1 newton"));
  free(text);
  ck_assert_int_eq(output_close(out, OK, 0), OK);
}

/* Each word of the header ends where the numbers below it end, those of words
 * (solver, reason) begin there, and awk counts as many. */
TEST(header_of_the_status_file_stands_over_its_columns) {
  FOLDER(dir);
  MADE_UP *made = made_up_new(2, 2, 3);
  output_options o = quiet(dir);
  output *out = NULL;
  o.no_timing = 0;
  ck_assert_int_eq(output_open(&made->m, made->msh, &o, &out), OK);
  history_sink sink = output_sink(out);
  ck_assert_int_eq(sink.ready(sink.ctx, &made->facts, &made->surface), OK);
  made_up_advance(made, 1);
  made->s.report.residual = NAN;
  ck_assert_int_eq(sink.increment(sink.ctx, &made->s), OK);
  ck_assert_int_eq(output_close(out, OK, 0), OK);
  char *text = folder_file(dir, "block.sta", NULL);
  const char *head = text, *row = strchr(text, '\n') + 1;
  int words = 0;
  ck_assert(head[0] == '#' && head[1] == 's');
  for (int i = 0; head[i] != '\n' && row[i] != '\n'; ++i) {
    const int here = head[i] != ' ', next = head[i + 1] > ' ';
    words += here && !next;
    if (words < 2) continue; /* "#step" is flush with the margin */
    if (here && !next && head + i < strstr(head, " reason") &&
        strncmp(head + i - 5, "solver", 6) != 0)
      ck_assert_msg(row[i] != ' ' && row[i + 1] == ' ', "at %d:\n%s", i, text);
  }
  ck_assert_int_eq(words, 15); /* without the last */
  ck_assert(row[strstr(head, "solver") - head] == 'n');
  ck_assert(row[strstr(head, "reason") - head] == 'O');
  free(text);
}

TEST(unsettled_increment_is_seen_everywhere) {
  FOLDER(dir);
  MADE_UP *made = made_up_new(2, 2, 1);
  output_options o = quiet(dir);
  output *out = NULL;
  ck_assert_int_eq(output_open(&made->m, made->msh, &o, &out), OK);
  history_sink sink = output_sink(out);
  ck_assert_int_eq(sink.ready(sink.ctx, &made->facts, &made->surface), OK);
  made_up_advance(made, 1);
  made->s.settled = 0;
  ck_assert_int_eq(sink.increment(sink.ctx, &made->s), OK);
  ck_assert_int_eq(output_close(out, OK, 1), ERR_UNSETTLED);
  const char *const wanted[][2] = {
      {"block.sta", " UNSETTLED\n"},
      {"block.lst", "THE TOLERANCE WAS NOT REACHED"},
      {"block.lst", "exit 1: "},
      {"block.json", "\"name\": \"ERR_UNSETTLED\""},
      {"block.json", "\"settled\": false"}};
  for (size_t i = 0; i < sizeof wanted / sizeof *wanted; ++i) {
    FREED char *text = folder_file(dir, wanted[i][0], NULL);
    ck_assert_msg(strstr(text, wanted[i][1]) != NULL, "%s in %s", wanted[i][1],
                  wanted[i][0]);
  }
}

/* ---- JSON, by the grammar of RFC 8259 --------------------------------- */

static const char *value_end(const char *p);

static const char *blanks(const char *p) {
  while (*p == ' ' || *p == '\n' || *p == '\t' || *p == '\r') ++p;
  return p;
}

/* Behind the string that starts at p, or NULL. */
static const char *string_end(const char *p) {
  if (*p++ != '"') return NULL;
  for (; *p != '"'; ++p) {
    if ((unsigned char)*p < 0x20) return NULL;
    if (*p != '\\') continue;
    ++p;
    if (*p == 'u')
      for (int i = 0; i < 4; ++i) {
        if (!isxdigit((unsigned char)*++p)) return NULL;
      }
    else if (strchr("\"\\/bfnrt", *p) == NULL)
      return NULL;
  }
  return p + 1;
}

static const char *number_end(const char *p) {
  if (*p == '-') ++p;
  if (!isdigit((unsigned char)*p)) return NULL;
  if (*p == '0' && isdigit((unsigned char)p[1])) return NULL;
  char *end;
  strtod(p, &end);
  return end;
}

static const char *list_end(const char *p, char close, int named) {
  p = blanks(p + 1);
  if (*p == close) return p + 1;
  for (;;) {
    if (named) {
      p = string_end(blanks(p));
      if (p == NULL) return NULL;
      p = blanks(p);
      if (*p++ != ':') return NULL;
    }
    p = value_end(blanks(p));
    if (p == NULL) return NULL;
    p = blanks(p);
    if (*p == close) return p + 1;
    if (*p++ != ',') return NULL;
  }
}

static const char *value_end(const char *p) {
  const char *const words[] = {"true", "false", "null"};
  if (*p == '{') return list_end(p, '}', 1);
  if (*p == '[') return list_end(p, ']', 0);
  if (*p == '"') return string_end(p);
  for (int i = 0; i < 3; ++i)
    if (strncmp(p, words[i], strlen(words[i])) == 0)
      return p + strlen(words[i]);
  return number_end(p);
}

static char *checked_json(const char *dir) {
  char *text = folder_file(dir, "block.json", NULL);
  ck_assert_ptr_nonnull(text);
  const char *end = value_end(text);
  ck_assert_msg(end != NULL && *blanks(end) == '\0', "%s", text);
  return text;
}

TEST(json_is_valid_whatever_the_texts_and_numbers) {
  FOLDER(dir);
  MADE_UP *made = made_up_new(2, 2, 2);
  output_options o = quiet(dir);
  output *out = NULL;
  made->m.name.title =
      "tab\t quote\" back\\ \xC3\xA9 latin \xE9 bad \xED\xA0\x80\x01";
  made->facts.condition = INFINITY;
  ck_assert_int_eq(output_open(&made->m, made->msh, &o, &out), OK);
  history_sink sink = output_sink(out);
  ck_assert_int_eq(sink.ready(sink.ctx, &made->facts, &made->surface), OK);
  made_up_advance(made, 1);
  made->s.report.residual = NAN;
  ck_assert_int_eq(sink.increment(sink.ctx, &made->s), OK);
  status st = status_fail(ERR_SINGULAR, "f", 1, "body \"A\"\nfree");
  ck_assert_int_eq(output_close(out, st, 0), ERR_SINGULAR);
  ck_assert_str_eq(status_message(), "body \"A\"\nfree");
  FREED char *text = checked_json(dir);
  ck_assert_ptr_nonnull(
      strstr(text,
             "\"title\": \"tab\\t quote\\\" back\\\\ \xC3\xA9 latin "
             "\\\\xE9 bad \\\\xED\\\\xA0\\\\x80\\\\x01\""));
  ck_assert_ptr_nonnull(strstr(text, "\"message\": \"body \\\"A\\\"\\nfree\""));
  ck_assert_ptr_nonnull(strstr(text, "\"code\": 6"));
  ck_assert_ptr_nonnull(strstr(text, "\"residual\": null"));
  ck_assert_ptr_nonnull(strstr(text, "\"residual_worst\": null"));
  ck_assert_ptr_nonnull(strstr(text, "\"condition\": null"));
  ck_assert_ptr_null(strstr(text, "\"cpu\""));
}

/* No number is there twice. */
TEST(json_tells_what_was_left_out) {
  static const char *const row[] = {
      "\"why\": \"small\",\n      \"taken_back\": true,\n"
      "      \"not_solved\": false,\n      \"bound\": 0.125,\n"
      "      \"stress\": 0.25,\n      \"change\": 0.375,\n"
      "      \"increments\": 4,\n      \"solved_again\": 5\n",
      "\"why\": \"none\",\n      \"taken_back\": false,\n"
      "      \"not_solved\": true,\n      \"bound\": 1.5,\n"
      "      \"stress\": 2.5,\n      \"change\": 3.5,\n"
      "      \"increments\": 8,\n      \"solved_again\": 9\n"};
  FOLDER(dir);
  MADE_UP *made = made_up_new(2, 1, 1);
  output_options o = quiet(dir);
  model *m = &made->m;
  m->reduction.is_auto = 1;
  m->reduction.n = 2;
  m->reduction.row[0] = (omitted){
      EFFECT_BIT_THERMAL, -1, "small", 0.125, 0.25, 0.375, 4, 5, 6, 7.0, 1, 0};
  m->reduction.row[1] = (omitted){
      EFFECT_BIT_FRICTION, -1, "none", 1.5, 2.5, 3.5, 8, 9, 0, 0.0, 0, 1};
  ck_assert_int_eq(run(made, &o, 1), OK);
  FREED char *text = checked_json(dir);
  ck_assert_ptr_nonnull(strstr(text, row[0]));
  ck_assert_ptr_nonnull(strstr(text, row[1]));
}

TEST(cost_is_shown_unless_left_out) {
  FOLDER(dir);
  MADE_UP *made = made_up_new(2, 2, 2);
  output_options o = quiet(dir);
  o.no_timing = 0;
  ck_assert_int_eq(run(made, &o, 2), OK);
  char *text = checked_json(dir);
  ck_assert_ptr_nonnull(strstr(text, "\"cpu\": "));
  free(text);
  text = folder_file(dir, "block.lst", NULL);
  ck_assert_ptr_nonnull(strstr(text, "cpu[s]"));
  free(text);
  text = folder_file(dir, "block.sta", NULL);
  ck_assert_ptr_nonnull(strstr(text, "cpu[s]"));
  free(text);
}

/* Rows of /history/time in block.h5. */
static long rows_of(const char *dir) {
  PRINTED(path, "%s/block.h5", dir);
  hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  hid_t set = H5Dopen2(file, "/history/time", H5P_DEFAULT);
  hid_t space = H5Dget_space(set);
  const long n = (long)H5Sget_simple_extent_npoints(space);
  H5Sclose(space);
  H5Dclose(set);
  H5Fclose(file);
  return n;
}

TEST(xdmf_names_every_record_of_its_file) {
  char name[80];
  FOLDER(dir);
  MADE_UP *made = made_up_new(3, 2, 3);
  output_options o = quiet(dir);
  ck_assert_int_eq(run(made, &o, 5), OK);
  ck_assert_int_eq(rows_of(dir), 5);
  char *text = folder_file(dir, "block.xdmf", NULL);
  for (int i = 1; i <= 5; ++i) {
    snprintf(name, sizeof name, ">block.h5:/fields/u/%05d<", i);
    ck_assert_ptr_nonnull(strstr(text, name));
    snprintf(name, sizeof name, ">block.h5:/contact/pressure/%05d<", i);
    ck_assert_ptr_nonnull(strstr(text, name));
  }
  snprintf(name, sizeof name, "Dimensions=\"%d 3\">block.h5:/fields/u/",
           made->msh->n_node);
  ck_assert_ptr_nonnull(strstr(text, name));
  snprintf(name, sizeof name, "Dimensions=\"%d 6\">block.h5:/fields/stress/",
           made->msh->n_elem);
  ck_assert_ptr_nonnull(strstr(text, name));
  ck_assert_ptr_nonnull(
      strstr(text, "Name=\"u\" AttributeType=\"Vector\" Center=\"Node\""));
  ck_assert_ptr_nonnull(
      strstr(text, "Name=\"mises\" AttributeType=\"Scalar\" Center=\"Cell\""));
  ck_assert_ptr_nonnull(strstr(
      text, "Name=\"stress\" AttributeType=\"Tensor6\" Center=\"Cell\""));
  ck_assert_ptr_null(strstr(text, dir));
  ck_assert_ptr_null(strstr(text, "/00006"));
  ck_assert_ptr_nonnull(strstr(text, "<Grid Name=\"contact\" GridType=\"Coll"));
  ck_assert_ptr_nonnull(strstr(text, "<Grid Name=\"body\" GridType=\"Coll"));
  ck_assert_ptr_nonnull(strstr(text, "</Xdmf>"));
  free(text);
  text = folder_file(dir, "block.contact.xdmf", NULL);
  ck_assert_ptr_nonnull(strstr(text, ">block.h5:/contact/u/00005<"));
  ck_assert_ptr_null(strstr(text, "Time"));
  ck_assert_ptr_null(strstr(text, "/fields/"));
  free(text);
  text = folder_file(dir, "block.body.xdmf", NULL);
  ck_assert_ptr_nonnull(strstr(text, ">block.h5:/fields/u/00005<"));
  ck_assert_ptr_null(strstr(text, "Collection"));
  free(text);
}

/* The grid of the contact surface as the format has it, in the plane and in
 * 3-D; its nodes alone where every neighbour of it was left out. */
TEST(xdmf_names_the_cells_of_the_contact) {
#define ITEM "<DataItem Format=\"HDF\" NumberType="
#define INTS ITEM "\"Int\" Precision=\"4\" Dimensions="
  static const struct {
    int faces, corners;
    const char *text;
  } surface[] = {
      {0, 2,
       "Polyvertex\" NumberOfElements=\"5\" NodesPerElement=\"1\">" INTS
       "\"5\">a.h5:/contact/index"},
      {4, 2,
       "Polyline\" NumberOfElements=\"4\" NodesPerElement=\"2\">" INTS
       "\"4 2\">a.h5:/contact/faces"},
      {6, 3,
       "Triangle\" NumberOfElements=\"6\">" INTS
       "\"6 3\">a.h5:/contact/faces"}};
  double time = 0.5;
  char path[96], want[600], name[] = "out/a.h5";
  FOLDER(dir);
  snprintf(path, sizeof path, "%s/a.xdmf", dir);
  for (int k = 0; k < 3; ++k) {
    const mesh msh = {.dim = surface[k].corners, .n_node = 9, .n_elem = 7};
    const hdf5_file h = {.msh = &msh,
                         .path = name,
                         .n_contact_node = 5,
                         .n_contact_face = surface[k].faces,
                         .n_record = 1,
                         .times = &time};
    ck_assert_int_eq(xdmf_write(&h, path), OK);
    FREED char *text = folder_file(dir, "a.xdmf", NULL);
    snprintf(want, sizeof want,
             "<Topology TopologyType=\"%s</DataItem>\n</Topology>\n"
             "<Geometry GeometryType=\"XYZ\">" ITEM
             "\"Float\" Precision=\"8\" Dimensions=\"5 3\">"
             "a.h5:/contact/points</DataItem>\n</Geometry>\n</Grid>\n",
             surface[k].text);
    ck_assert_msg(strstr(text, want) != NULL, "%s\nhas no\n%s", text, want);
    ck_assert_ptr_nonnull(strstr(text, "<Time Value=\""));
  }
}

TEST(files_of_an_earlier_run_do_not_stay) {
  FOLDER(dir);
  MADE_UP *made = made_up_new(2, 2, 2);
  output_options o = quiet(dir);
  output *out = NULL;
  ck_assert_int_eq(run(made, &o, 2), OK);
  made->steps[0].print.n = 0;
  ck_assert_int_eq(output_open(&made->m, made->msh, &o, &out), OK);
  const char *const gone[] = {"block.dat", "block.xdmf", "block.json"};
  for (int i = 0; i < 3; ++i)
    ck_assert_msg(folder_file(dir, gone[i], NULL) == NULL, "%s", gone[i]);
  ck_assert_int_eq(output_close(out, OK, 0), OK);
}

TEST(run_that_never_became_ready_has_a_verdict) {
  FOLDER(dir);
  MADE_UP *made = made_up_new(2, 2, 2);
  output_options o = quiet(dir);
  output *out = NULL;
  ck_assert_int_eq(output_open(&made->m, made->msh, &o, &out), OK);
  status st = status_fail(ERR_SINGULAR, "f", 1, "nothing holds body 1");
  ck_assert_int_eq(output_close(out, st, 0), ERR_SINGULAR);
  char *text = checked_json(dir);
  ck_assert_ptr_nonnull(strstr(text, "nothing holds body 1"));
  free(text);
  text = folder_file(dir, "block.lst", NULL);
  ck_assert_ptr_nonnull(strstr(text, "nothing holds body 1"));
  free(text);
  ck_assert_int_eq(output_close(NULL, ERR_MESH, 0), ERR_MESH);
}

/* ---- failures --------------------------------------------------------- */

TEST(full_disk_of_any_text_file_is_told_and_the_others_are_kept) {
  const char *const files[] = {"block.lst", "block.sta", "block.cvg",
                               "block.dat"};
  for (int k = 0; k < 4; ++k) {
    FOLDER(dir);
    MADE_UP *made = made_up_new(2, 2, 2);
    output_options o = quiet(dir);
    output *out = NULL;
    ck_assert_int_eq(output_open(&made->m, made->msh, &o, &out), OK);
    disk_fill(files[k]);
    history_sink sink = output_sink(out);
    status st = output_close(out, tell(made, &sink, 2), 0);
    ck_assert_msg(st == ERR_FILE, "%s", files[k]);
    ck_assert_msg(strstr(status_message(), files[k]) != NULL, "%s: %s",
                  files[k], status_message());
    ck_assert_ptr_nonnull(strstr(status_message(), "No space left"));
    FREED char *text = checked_json(dir);
    ck_assert_ptr_nonnull(strstr(text, "\"name\": \"ERR_FILE\""));
  }
}

/* Listing and JSON, as far as they are whole, have that exit code. */
static void ck_code(const char *dir, int code) {
  static const char *const files[][2] = {{"block.lst", "\n  exit "},
                                         {"block.json", "\"code\": "}};
  for (int k = 0; k < 2; ++k) {
    FREED char *text = folder_file(dir, files[k][0], NULL);
    const char *at = text != NULL ? strstr(text, files[k][1]) : NULL;
    if (at != NULL)
      ck_assert_msg(atoi(at + strlen(files[k][1])) == code, "%s: not %d",
                    files[k][0], code);
  }
}

/* The listing takes no more when all else is written, or, late, but its end,
 * and JSON may not be written (again): the k-th request is refused. 1: it was.
 */
static int end_on_full_disk(made_up *made, int late, long k) {
  FOLDER(dir);
  output_options o = quiet(dir);
  output *out = NULL;
  ck_assert_int_eq(output_open(&made->m, made->msh, &o, &out), OK);
  history_sink sink = output_sink(out);
  ck_assert_int_eq(tell(made, &sink, 2), OK);
  if (!late) disk_fill("block.lst");
  disk_fill_after("block.lst", late ? "block.json" : NULL);
  const long first = memory_requests();
  memory_refuse(k, 0);
  const status st = output_close(out, OK, 0);
  memory_refuse(0, 0);
  disk_fill_after(NULL, NULL);
  ck_assert_msg(st == ERR_FILE || st == ERR_MEMORY, "%s", status_message());
  ck_code(dir, status_exit_code(st));
  FREED char *text = k > 0 ? NULL : checked_json(dir);
  if (k == 0) ck_assert_ptr_nonnull(strstr(text, "block.lst: cannot write"));
  return k <= memory_requests() - first;
}

TEST(full_disk_at_the_end_is_told) {
  MADE_UP *made = made_up_new(2, 2, 2);
  for (int late = 0; late < 2; ++late)
    for (long k = 0; end_on_full_disk(made, late, k);) ++k;
}

/* What bears the name of a file that is made aside. */
TEST(files_made_aside_are_told) {
  const char *const files[] = {"block.json.tmp", "block.xdmf.tmp"};
  for (int k = 0; k < 2; ++k) {
    FOLDER(dir);
    PRINTED(path, "%s/%s", dir, files[k]);
    ck_assert_int_eq(mkdir(path, 0700), 0);
    MADE_UP *made = made_up_new(2, 2, 2);
    output_options o = quiet(dir);
    ck_assert_msg(run(made, &o, 2) == ERR_FILE, "%s", files[k]);
    ck_assert_msg(strstr(status_message(), files[k]) != NULL, "%s: %s",
                  files[k], status_message());
    ck_code(dir, 4);
  }
}

TEST(folder_that_cannot_be_written_is_told) {
  MADE_UP *made = made_up_new(2, 2, 2);
  const char *const dirs[] = {"/no/such/folder", "/proc", "/dev/null"};
  for (int k = 0; k < 3; ++k) {
    output_options o = quiet(dirs[k]);
    output *out = NULL;
    size_t before = memory_in_use();
    ck_assert_int_eq(output_open(&made->m, made->msh, &o, &out), ERR_FILE);
    ck_assert_ptr_null(out);
    ck_assert_ptr_nonnull(strstr(status_message(), dirs[k]));
    ck_assert_uint_eq(memory_in_use(), before);
  }
}

TEST(every_refused_request_is_told_and_leaves_nothing) {
  int refused = 0;
  FOLDER(dir);
  MADE_UP *made = made_up_new(2, 2, 2);
  output_options o = quiet(dir);
  size_t before = memory_in_use();
  for (long k = 1;; ++k) {
    long first = memory_requests();
    memory_refuse(k, 0);
    status st = run(made, &o, 10);
    memory_refuse(0, 0);
    ck_assert_msg(st == OK || st == ERR_MEMORY, "%ld: %s", k, status_message());
    ck_assert_uint_eq(memory_in_use(), before);
    ck_code(dir, status_exit_code(st));
    if (st == ERR_MEMORY) ++refused;
    if (memory_requests() - first < k) break;
  }
  ck_assert_int_gt(refused, 40);
}

TEST(output_changes_nothing_it_is_given) {
  FOLDER(dir);
  MADE_UP *made = made_up_new(3, 2, 2);
  output_options o = quiet(dir);
  ck_assert_int_eq(run(made, &o, 2), OK);
  for (int a = 0; a < MADE_ARRAYS; ++a)
    for (int i = 0; i < made->count[a]; ++i)
      ck_assert(made->array[a][i] == made_up_value(a, i, 2));
}

/* stderr is a file here, as in a batch job. */
/* What is left takes as long an increment as what is done. */
TEST(progress_foresees_the_time_left) {
  static const struct {
    double seconds;
    int done;
    const char *told;
  } cases[] = {{30.0, 3, "increment 3 of 10, 70 s left"},
               {3000.0, 30, "increment 3 of 10, 12 min left"},
               {10800.0, 3, "increment 3 of 10, 7 h left"}};
  step only = {.total = 10.0};
  const model m = {.n.step = 1, .steps = &only};
  const state s = {
      .t = 3.0, .dt = 1.0, .step_no = 1, .increment_no = 3, .total_no = 3};
  FOLDER(dir);
  PRINTED(path, "%s/errors", dir);
  fflush(stderr);
  int kept = dup(STDERR_FILENO);
  FILE *errors = fopen(path, "w");
  dup2(fileno(errors), STDERR_FILENO);
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k)
    progress_show(&m, &s, cases[k].seconds, cases[k].done);
  dup2(kept, STDERR_FILENO);
  close(kept);
  fclose(errors);
  char *text = folder_file(dir, "errors", NULL), *at = text;
  for (size_t k = 0; k < sizeof cases / sizeof *cases && at != NULL; ++k)
    at = strstr(at, cases[k].told);
  ck_assert_msg(at != NULL, "%s", text);
  free(text);
}

TEST(no_progress_line_where_there_is_no_terminal) {
  FOLDER(dir);
  PRINTED(path, "%s/errors", dir);
  MADE_UP *made = made_up_new(2, 2, 2);
  output_options o = quiet(dir);
  o.progress = 1;
  fflush(stderr);
  int kept = dup(STDERR_FILENO);
  FILE *errors = fopen(path, "w");
  dup2(fileno(errors), STDERR_FILENO);
  status st = run(made, &o, 2);
  fflush(stderr);
  dup2(kept, STDERR_FILENO);
  close(kept);
  fclose(errors);
  ck_assert_int_eq(st, OK);
  FREED char *text = folder_file(dir, "errors", NULL);
  ck_assert_str_eq(text, "");
}

/* Each way a solver can stop has a code of its own in .sta, .cvg and JSON, for
 * an increment that is taken and for one that is cut. */
TEST(reasons_of_stopping_are_told_apart) {
  static const struct {
    outcome o;
    const char *code;
  } ends[] = {{STOPPED_ITERATIONS, "ITERATIONS"},
              {STOPPED_NAN, "NAN"},
              {STOPPED_STAGNATION, "STAGNATION"},
              {STOPPED_RAY, "RAY"},
              {STOPPED_CYCLE, "CYCLE"},
              {STOPPED_SINGULAR, "SINGULAR"},
              {STOPPED_UNFIT, "UNFIT"}};
  enum { ENDS = sizeof ends / sizeof *ends };
  char line[64];
  FOLDER(dir);
  MADE_UP *made = made_up_new(2, 2, ENDS);
  output_options o = quiet(dir);
  output *out = NULL;
  ck_assert_int_eq(output_open(&made->m, made->msh, &o, &out), OK);
  history_sink sink = output_sink(out);
  ck_assert_int_eq(sink.ready(sink.ctx, &made->facts, &made->surface), OK);
  for (int k = 0; k < ENDS; ++k) {
    made_up_advance(made, k + 1);
    made->s.settled = 0;
    made->s.report.outcome = ends[k].o;
    ck_assert_int_eq(sink.rejected(sink.ctx, &made->s, "in words"), OK);
    ck_assert_int_eq(sink.increment(sink.ctx, &made->s), OK);
  }
  ck_assert_int_eq(output_close(out, OK, ENDS), ERR_UNSETTLED);
  for (int k = 0; k < ENDS; ++k) {
    static const char *const forms[][2] = {
        {"block.sta", " UNSETTLED %s\n"},
        {"block.sta", " CUT %s in words\n"},
        {"block.cvg", " ended: newton %s ("},
        {"block.json", "\"outcome\": \"%s\""}};
    for (size_t f = 0; f < sizeof forms / sizeof *forms; ++f) {
      FREED char *text = folder_file(dir, forms[f][0], NULL);
      const char *mark = strstr(forms[f][1], "%s");
      snprintf(line, sizeof line, "%.*s%s%s", (int)(mark - forms[f][1]),
               forms[f][1], ends[k].code, mark + 2);
      ck_assert_msg(strstr(text, line) != NULL, "no '%s' in %s", line,
                    forms[f][0]);
    }
  }
}

UNIT_MAIN("output")
