/*
 * What other programs and people read of a run: the contacts by name in tables
 * and JOB.json, tables as csv, the lines on a terminal.
 */
#include "support/job.h"
#include "support/tips.h"
#include "support/unit.h"

#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

static const double area = 0.70710678118654752; /* of a tip: half an edge */

/* Two tips, each in a contact of its own, pressed by 10 and 4, then by twice
 * that: a smooth floor bears what presses. */
static job pressed(const char *prints) {
  PRINTED(text,
          "*UNITS, LENGTH=\"US ft, [long]\"\n"
          "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n"
          "*CONTACT, NAME=LEFT, GROUP=FOOT1, OBSTACLE=O, NORMAL=OBSTACLE\n"
          "*CONTACT, NAME=\"RIGHT, OUTER\", GROUP=FOOT2, OBSTACLE=O, "
          "NORMAL=OBSTACLE\n"
          "*STEP\n*QUASISTATIC\n0.5, 1.\n*BOUNDARY\nCLAMPED, 1, 2\n"
          "*CLOAD\nTIPS, 2, -4.\nFOOT1, 2, -6.\n*SOLVER, TOL=1E-13\n"
          "%s*END STEP\n"
          "*STEP\n*QUASISTATIC\n0.5, 1.\n*CLOAD\nTIPS, 2, -8.\nFOOT1, 2, -12.\n"
          "*END STEP\n",
          prints);
  job j = tips_new(500, "", text);
  CK_EXIT(job_run(&j, "--no-timing"), 0, j);
  return j;
}

/* What two cards ask for is there once. */
static job two_contacts(void) {
  return pressed("*PRINT, CONTACT, TOTALS\n*PRINT, TOTALS, FREQUENCY=0\n");
}

/* The next number of that name after *at. */
static double next_number(const char **at, const char *name) {
  PRINTED(key, "\"%s\": ", name);
  *at = strstr(*at, key);
  ck_assert_msg(*at != NULL, "no %s", name);
  *at += strlen(key);
  return strtod(*at, NULL);
}

TEST(json_has_the_contacts_at_the_end_of_each_step) {
  static const double force[] = {10, 4, 20, 8};
  JOB j = two_contacts();
  FREED char *text = job_file(&j, "json");
  const char *at = strstr(text, "\"contacts\": [");
  ck_assert_ptr_nonnull(at);
  for (int i = 0; i < 4; ++i) {
    ck_assert(next_number(&at, "step") == 1 + i / 2);
    ck_assert(next_number(&at, "increment") == 2);
    ck_assert_double_eq_tol(next_number(&at, "time"), 1 + i / 2, 1e-12);
    next_number(&at, "contact");
    ck_assert_int_eq(strncmp(at, i % 2 ? "\"RIGHT, OUTER\"" : "\"LEFT\"", 6),
                     0);
    ck_assert_double_eq_tol(next_number(&at, "force_y"), force[i], 1e-9);
    ck_assert_double_eq_tol(next_number(&at, "closed_area"), area, 1e-12);
    ck_assert(next_number(&at, "open") == 0);
    ck_assert_double_eq_tol(next_number(&at, "pressure_max"), force[i] / area,
                            1e-9);
  }
}

/* The last word of each row of CONTACT. */
TEST(nodes_have_the_name_of_their_contact) {
  JOB j = two_contacts();
  FREED char *text = job_file(&j, "dat");
  const char *at = strstr(text, "table CONTACT");
  ck_assert_ptr_nonnull(strstr(at, " contact[-]\n"));
  at = strstr(at, " LEFT\n");
  ck_assert_ptr_nonnull(at);
  ck_assert_ptr_nonnull(strstr(at, " RIGHT,_OUTER\n"));
  ck_assert_ptr_nonnull(strstr(text, " gap[US_ft,__long_] "));
}

/* protis JOB --table words, through a command that reads it; what that says. */
static char *read_by(const job *j, const char *words, const char *command) {
  char text[600], *said = calloc(4000, 1);
  snprintf(text, sizeof text, "'%s' '%s/%s' --table %s 2>&1 | %s",
           getenv("PROTIS"), j->dir, j->name, words, command);
  FILE *f = popen(text, "r");
  ck_assert_ptr_nonnull(f);
  ck_assert_uint_gt(fread(said, 1, 3999, f), 0);
  ck_assert_int_eq(pclose(f), 0);
  return said;
}

TEST(tables_are_read_by_other_programs) {
  static const struct {
    const char *words, *command, *said;
  } ways[] = {
      {"totals", "sed -n 's/,.*contact,.*/ &/;1p' | cut -d, -f1-5",
       "step ,increment,time,contact,force_x\n"},
      {"TOTALS", "wc -l | tr -d ' '", "9\n"},
      {"TOTALS:last", "wc -l | tr -d ' '", "3\n"},
      {"TOTALS:last", "grep -c '\"RIGHT,_OUTER\",'", "1\n"},
      {"CONTACT:last --format tsv",
       "awk -F '\\t' 'NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i } "
       "NR > 1 { print $4, $at[\"status\"], "
       "int($at[\"f_n\"] + 0.5) }'",
       "LEFT SLIP 20\nRIGHT,_OUTER SLIP 8\n"},
      {"CONTACT --format tsv",
       "gnuplot -e \"set datafile separator tab; stats '/dev/stdin' using "
       "'f_n' nooutput; print sprintf('%d %.9g', STATS_records, STATS_sum)\" "
       "2>&1",
       "8 70\n"},
      {"CONTACT --format tsv",
       "head -n 1 | tr '\\t' '\\n' | sort | uniq -d | wc -l | tr -d ' '",
       "0\n"},
      {"CONTACT --format tsv", "wc -l | tr -d ' '", "9\n"},
      {"NODES", "sed 's/.*dat has/has/; s/ \\*PRINT.*//'",
       "has no table NODES; it has CONTACT TOTALS;\n"}};
  JOB j = two_contacts();
  for (size_t i = 0; i < sizeof ways / sizeof *ways; ++i) {
    FREED char *said = read_by(&j, ways[i].words, ways[i].command);
    ck_assert_msg(strcmp(said, ways[i].said) == 0, "--table %s: %s",
                  ways[i].words, said);
  }
}

/* Tables of one kind of several groups are one. */
TEST(rows_have_the_name_of_their_group) {
  JOB j = pressed("*PRINT, NODES, GROUP=FOOT1\n*PRINT, NODES, GROUP=FOOT2\n");
  FREED char *said = read_by(&j, "NODES:last", "cut -d, -f1,2,4 | uniq");
  ck_assert_str_eq(said, "step,increment,group\n2,2,FOOT1\n2,2,FOOT2\n");
}

/* What a change of the results makes of --table: its code, the lines of the
 * table, what it says. */
TEST(tables_that_are_not_whole_are_told) {
  static const struct {
    const char *change;
    int code, lines;
    const char *said;
  } cases[] = {
      {"true", 0, 9, ""},
      {"rm J.json", 0, 9, "protis: warning: the run of J has not finished\n"},
      {"touch J.lock", 0, 9, "warning: the run of J has not finished\n"},
      {"truncate -s -5 J.dat", 0, 8, "the last row is cut\n"},
      {"sed -i '$s/ [^ ]*$//' J.dat", 0, 8, "the last row is cut\n"},
      {"sed -i '/table TOTALS/{n;n;s/ [^ ]*$//}' J.dat", 4, 1,
       " values in a row of "}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
    JOB j = two_contacts();
    PRINTED(command,
            "for f in %s.*; do mv $f J.${f##*.}; done; %s; "
            "protis J --table TOTALS 2>said > table; code=$?; "
            "cat said >&2; "
            "test $(wc -l < table) = %d && exit $code",
            j.name, cases[i].change, cases[i].lines);
    ck_assert_msg(job_shell(&j, command) == cases[i].code &&
                      strstr(j.errors, cases[i].said) != NULL &&
                      (cases[i].said[0] != '\0' || j.errors[0] == '\0'),
                  "%s: %s", cases[i].change, j.errors);
  }
}

TEST(what_cannot_be_printed_is_an_error) {
  static const char *const words[] = {
      "--help",    "--version",      "--manual deck", "--keywords",
      "--explain", "--list columns", "$J --check",    "$J --table TOTALS"};
  char command[120];
  JOB j = two_contacts();
  for (size_t i = 0; i < sizeof words / sizeof *words; ++i) {
    snprintf(command, sizeof command, "J=%s; protis %s > /dev/full", j.name,
             words[i]);
    ck_assert_msg(job_shell(&j, command) == 4, "%s", words[i]);
    ck_assert_ptr_nonnull(strstr(j.errors, "standard output: cannot write"));
    snprintf(command, sizeof command,
             "J=%s; { protis %s; echo $? >&2; } | true", j.name, words[i]);
    job_shell(&j, command);
    ck_assert_ptr_null(strstr(j.errors, "error"));
    ck_assert_str_eq(j.errors + strlen(j.errors) - 2, "0\n");
  }
}

/* What a run with stderr on a terminal writes there; caller frees. */
static char *on_a_terminal(const job *j, const char *words) {
  char path[120], *said = calloc(20000, 1);
  size_t n = 0;
  int fd, code;
  snprintf(path, sizeof path, "%s/%s.inp", j->dir, j->name);
  const pid_t pid = forkpty(&fd, NULL, NULL, NULL);
  ck_assert_int_ge(pid, 0);
  if (pid == 0) {
    execl(getenv("PROTIS"), "protis", path, words, (char *)NULL);
    _exit(127);
  }
  for (ssize_t got; (got = read(fd, said + n, 19999 - n)) > 0;)
    n += (size_t)got;
  close(fd);
  ck_assert_int_eq(waitpid(pid, &code, 0), pid);
  ck_assert_msg(WIFEXITED(code) && WEXITSTATUS(code) == 0, "%s", said);
  return said;
}

/* N = 20 and 8 on frictionless tips. */
TEST(run_on_a_terminal_ends_with_what_matters) {
  static const char *const lines[] = {
      "step 1 of 2, time 0.5, increment 1 of 4, ",
      "\nresults   ",
      "/tips.lst .sta .cvg .dat .h5 .xdmf .json\r\n",
      "exit      0: done; increments 4, attempts cut 0\r\n",
      "LEFT      force_x 0, force_y 20, open 0, slip 1, stick 0\r\n",
      "RIGHT, OUTER force_x 0, force_y 8, open 0, slip 1, stick 0\r\n",
      "worst     residual ",
      ", penetration ",
      "error     mesh ",
      " %, steps 0 %, solver ",
      " % of the energy norm\r\n",
      "cost      ",
      " MB of arrays\r\n"};
  JOB j = two_contacts();
  ck_assert_ptr_null(strpbrk(j.errors, "\r\033"));
  ck_assert_ptr_null(strstr(j.errors, "results "));
  ck_assert_str_eq(j.text, "");
  char *said = on_a_terminal(&j, "--no-timing"), *at = said;
  for (size_t i = 0; i < sizeof lines / sizeof *lines; ++i) {
    at = strstr(at, lines[i]);
    ck_assert_msg(at != NULL, "no %s in:\n%s", lines[i], said);
  }
  free(said);
  said = on_a_terminal(&j, "--quiet");
  ck_assert_ptr_null(strstr(said, "step 1 of"));
  ck_assert_ptr_null(strstr(said, "results "));
  free(said);
}

/* A strip on 21 contacts, each of a unit of length under a pressure of 1: each
 * has the node at its end, the first both. A goal without a value is none. */
TEST(end_shows_twenty_contacts) {
  char cards[2000] = "";
  for (int i = 0; i < 21; ++i)
    snprintf(strchr(cards, '\0'), 90,
             "*CONTACT, NAME=C%d, GROUP=B%d, OBSTACLE=O, NORMAL=OBSTACLE\n", i,
             i);
  JOB j = job_begin("strip");
  job_write(&j, "strip.geo",
            "For i In {0:21}\nPoint(i+1) = {i, 0, 0};\nEndFor\n"
            "Point(23) = {21, 1, 0}; Point(24) = {0, 1, 0};\n"
            "For i In {1:23}\nLine(i) = {i, i+1};\nEndFor\n"
            "Line(24) = {24, 1}; Curve Loop(1) = {1:24};\n"
            "Plane Surface(1) = {1}; Physical Surface(\"BODY\") = {1};\n"
            "Physical Curve(\"TOP\") = {23}; Physical Curve(\"SIDE\") = {24};\n"
            "For i In {0:20}\nPhysical Curve(Sprintf(\"B%%g\", i)) = {i+1};\n"
            "EndFor\nMesh.MeshSizeMax = 1;\n");
  job_write(&j, "strip.inp",
            "*MESH, FILE=strip.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n%s"
            "*GOAL, NAME=W, QUANTITY=WIDTH, CONTACT=C0\n"
            "*GOAL, NAME=G, QUANTITY=FORCE, CONTACT=C0\n"
            "*STEP\n*STATIC\n*BOUNDARY\nSIDE, 1\n*DSLOAD\nTOP, P, 1.\n"
            "*END STEP\n",
            cards);
  FREED char *said = on_a_terminal(&j, "--no-timing");
  ck_assert_msg(
      strstr(said, "\nC0        force_x 0, force_y 1.5, open 0, slip 2, ") !=
              NULL &&
          strstr(said,
                 "\nC19       force_x 0, force_y 1, open 0, slip 1, "
                 "stick 0\r\n          and 1 more in JOB.json\r\n") != NULL &&
          strstr(said, "\nW         none: ") != NULL &&
          strstr(said, "\nG         1.5 force, no estimate: ") != NULL,
      "%s", said);
}

UNIT_MAIN("results")
