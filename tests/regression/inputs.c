/*
 * What a run reads, against what it writes: no result takes the place of an
 * input, whatever its name; results stay in their folder; what is no plain file
 * is refused and not waited for.
 */
#include "support/job.h"
#include "support/small_job.h"
#include "support/unit.h"

enum { TEXT = 4096 };

static const char lcp[] = "1\n2.\n-1.\n";
static const char triangle[] =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n1 1 \"BOTTOM\"\n"
    "2 2 \"BODY\"\n$EndPhysicalNames\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n"
    "$EndNodes\n$Elements\n2\n1 1 2 1 1 1 2\n2 2 2 2 1 1 2 3\n$EndElements\n"
    "$NodeData\n1\n\"T\"\n1\n0.0\n3\n0\n1\n3\n1 5.\n2 6.\n3 7.\n$EndNodeData\n";

#define PROBLEM "*CONDENSED PROBLEM, FILE=%s\n*STEP\n*END STEP\n"
#define INCLUDE \
  "*CONDENSED PROBLEM, FILE=one.lcp\n*INCLUDE, INPUT=%s\n*END STEP\n"
#define BODY                                                                 \
  "*MATERIAL, NAME=M\n*ELASTIC\n1., 0.\n*EXPANSION\n1.E-5\n*SOLID SECTION, " \
  "ELSET=BODY, MATERIAL=M\n"
#define PLATE                                                         \
  "Point(1)={0,0,0}; Point(2)={1,0,0}; Point(3)={0,1,0};"             \
  "Line(1)={1,2}; Line(2)={2,3}; Line(3)={3,1}; Curve Loop(1)={1:3};" \
  "Plane Surface(1)={1}; Transfinite Curve{1:3}=2;\n"
#define STEP \
  "*STEP\n*STATIC\n1.\n*BOUNDARY\nBOTTOM, 1, 2\n*OUTPUT\n*PRINT, NODES\n"
#define BLOCK "*MESH, FILE=%s\n" BODY STEP "*END STEP\n"
#define FIELD \
  "*MESH, FILE=one.msh\n" BODY STEP "*TEMPERATURE, FILE=%s\nBODY\n*END STEP\n"
#define START                  \
  "*MESH, FILE=one.msh\n" BODY \
  "*INITIAL CONDITIONS, TYPE=DISPLACEMENT, FILE=%s\n" STEP "*END STEP\n"

static const struct {
  const char *deck, *content; /* of the file                                 */
} readers[] = {{PROBLEM, lcp},
               {INCLUDE, "*STEP\n"},
               {BLOCK, triangle},
               {FIELD, triangle},
               {START, "no matter"}};
enum { READERS = sizeof readers / sizeof *readers };

static job begin(void) {
  job j = job_begin("job");
  job_write(&j, "one.lcp", "%s", lcp);
  job_write(&j, "one.msh", "%s", triangle);
  return j;
}

static void shell(const job *j, const char *command) {
  PRINTED(line, "cd '%s' && %s", j->dir, command);
  ck_assert_int_eq(system(line), 0);
}

static void write_deck(const job *j, int reader, const char *file) {
  char text[TEXT];
  ck_assert_int_lt(
      snprintf(text, sizeof text, readers[reader].deck, file, file), TEXT);
  job_write(j, "job.inp", "%s", text);
}

static void still_there(const job *j, const char *name, const char *content) {
  job other = *j;
  char base[32];
  snprintf(base, sizeof base, "%s", name);
  char *suffix = strrchr(base, '.');
  *suffix = '\0';
  snprintf(other.name, sizeof other.name, "%s", base);
  FREED char *text = job_file(&other, suffix + 1);
  ck_assert_msg(text != NULL && strcmp(text, content) == 0, "%s is now %.80s",
                name, text == NULL ? "gone" : text);
}

/* Refused before anything is touched: the input and a result of before stay. */
static void refused(job *j, int reader, const char *name) {
  job_write(j, "job.sta", "of before\n");
  int code = job_run(j, "");
  ck_assert_msg(code == 2 && strstr(j->errors, "would overwrite") != NULL &&
                    strstr(j->errors, "use -o") != NULL,
                "%s: exit %d: %s", name, code, j->errors);
  still_there(j, name, readers[reader].content);
  still_there(j, "job.sta", "of before\n");
}

TEST(results_named_like_inputs_are_refused) {
  static const char *const names[] = {
      "job.lst",        "job.dat",      "job.cvg",
      "job.h5",         "job.h5.tmp",   "job.xdmf",
      "job.json",       "job.xdmf.tmp", "job.json.tmp",
      "job.rst.h5",     "job.lock",     "job.rst.h5.tmp",
      "job.rst.old.h5", "job.rst.inc",  "job_condensed_00007.h5"};
  for (size_t k = 0; k < sizeof names / sizeof *names; ++k) {
    int reader = (int)k % READERS;
    JOB j = begin();
    write_deck(&j, reader, names[k]);
    job_write(&j, names[k], "%s", readers[reader].content);
    refused(&j, reader, names[k]);
  }
}

/* Another name of the file that a result would replace. */
TEST(inputs_are_known_by_what_they_are) {
  static const char *const ways[][2] = {
      {"ln data.txt job.h5", "data.txt"},
      {"ln -s data.txt job.h5", "data.txt"},
      {"ln -s data.txt job.h5", "job.h5"},
      {"mv data.txt job.h5; ln -s job.h5 data.txt", "data.txt"},
      {"mkdir sub; mv data.txt job.h5; ln -s job.h5 data.txt",
       "sub/../job.h5"}};
  for (size_t k = 0; k < sizeof ways / sizeof *ways; ++k) {
    int reader = (int)k % READERS;
    JOB j = begin();
    job_write(&j, "data.txt", "%s", readers[reader].content);
    shell(&j, ways[k][0]);
    write_deck(&j, reader, ways[k][1]);
    refused(&j, reader, "data.txt");
  }
}

/* Of a .geo the files too that it includes: as the deck's own, they are not
 * overwritten and a restart knows them. */
TEST(what_a_geometry_includes_is_an_input) {
  static const char *const ways[] = {
      PLATE "If (0)\nv() = ShapeFromFile( \"job.lst\" );\nEndIf",
      "Include \"job.lst\";"};
  JOB j = begin();
  job_write(&j, "job.inp", "%s",
            "*MESH, FILE=one.geo\n" BODY STEP "*RESTART\n*END STEP\n");
  job_write(&j, "job.lst", "%s", PLATE);
  for (int k = 0; k < 2; ++k) {
    job_write(
        &j, "one.geo",
        "%s\nPhysical Curve(\"BOTTOM\")={1}; Physical Surface(\"BODY\")={1};\n",
        ways[k]);
    ck_assert_int_eq(job_run(&j, ""), 2);
    ck_assert_msg(strstr(j.errors, "would overwrite") != NULL, "%s", j.errors);
    still_there(&j, "job.lst", PLATE);
  }
  shell(&j, "mv job.lst part.geo; sed -i s/job.lst/part.geo/ one.geo");
  ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
  shell(&j, "sed -i 's/=2;/=3;/' part.geo");
  ck_assert_int_eq(job_run(&j, "--restart"), 2);
  ck_assert_msg(strstr(j.errors, "FILE=part.geo: has other contents") != NULL,
                "%s", j.errors);
}

/* Links to a file of another folder, of each name that is written. */
TEST(results_stay_in_their_folder) {
  static const char *const names[] = {
      "job.lst",    "job.sta",        "job.dat",
      "job.cvg",    "job.h5",         "job.xdmf",
      "job.json",   "job.xdmf.tmp",   "job.json.tmp",
      "job.h5.tmp", "job.rst.h5.tmp", "job_condensed_00001.h5.tmp"};
  static const char *const links[] = {
      "ln -s away/%s %s", "echo precious > away/%s; ln -s away/%s %s",
      "echo precious > away/%s; ln away/%s %s"};
  for (int way = 0; way < 3; ++way) {
    JOB j = begin();
    char command[TEXT];
    write_deck(&j, 2, "one.msh");
    shell(&j,
          "mkdir away; sed -i "
          "'s/^[*]OUTPUT/*RESTART\\n*OUTPUT, CONDENSED=FCLIB/' job.inp");
    for (size_t k = 0; k < sizeof names / sizeof *names; ++k) {
      snprintf(command, sizeof command, links[way], names[k], names[k],
               names[k]);
      shell(&j, command);
    }
    CK_EXIT(job_run(&j, ""), 0, j);
    shell(&j, way == 0 ? "test -z \"$(ls away)\""
                       : "test $(cat away/* | sort -u) = precious");
    shell(&j,
          "for s in lst sta dat cvg h5 xdmf json rst.h5; do "
          "test -s job.$s && ! test -L job.$s || exit 1; done");
  }
}

/* Those of a longer run before are gone, at a restart those after it, and all
 * where there shall be none. */
TEST(condensed_problems_are_of_one_run) {
  static const char make[] =
      "touch block_condensed_00009.h5 block_condensed_00042.h5.tmp "
      "block_condensed_x.h5 block_condensed_7.h5.old; ";
  static const char count[] =
      "test \"$(ls | grep condensed | xargs)\" = \"$(echo "
      "block_condensed_0000[1-8].h5 block_condensed_7.h5.old "
      "block_condensed_x.h5)\"";
  JOB j = small_flat(0.5, "*OUTPUT, CONDENSED=FCLIB\n*RESTART\n", "AUTO");
  for (int again = 0; again < 2; ++again) {
    shell(&j, make);
    ck_assert_msg(job_run(&j, again ? "--restart" : "") == 0, "%s", j.errors);
    shell(&j, count);
  }
  shell(&j, "sed -i 's/, CONDENSED=FCLIB/, HDF5=NO/' block.inp");
  ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
  shell(&j, "test -z \"$(ls | grep 'condensed_0')\"");
}

TEST(stop_file_of_others_stays) {
  JOB j = begin();
  write_deck(&j, 3, "job.stop");
  job_write(&j, "job.stop", "%s", triangle);
  ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
  still_there(&j, "job.stop", triangle);
}

/* ---- what is no file ----------------------------------------------------- */

static void refused_kind(job *j, const char *what, const char *words) {
  int code = job_run(j, words);
  ck_assert_msg((code >= 2 && code <= 4) && strstr(j->errors, "error") != NULL,
                "%s: exit %d: %s", what, code, j->errors);
}

TEST(no_plain_file_is_no_input) {
  static const char *const kinds[] = {
      "mkfifo odd.msh", "ln -s /dev/zero odd.msh", "mkdir odd.msh"};
  for (size_t k = 0; k < sizeof kinds / sizeof *kinds; ++k) {
    JOB j = begin();
    shell(&j, kinds[k]);
    for (int reader = 0; reader < READERS; ++reader) {
      write_deck(&j, reader, "odd.msh");
      refused_kind(&j, kinds[k], "");
    }
    shell(&j, "mv odd.msh job.rst.h5");
    write_deck(&j, 2, "one.msh");
    refused_kind(&j, kinds[k], "--restart");
    shell(&j, "rm job.inp; mv job.rst.h5 job.inp");
    refused_kind(&j, kinds[k], "");
  }
}

/* Nor is what is protected; the results of before stay. */
TEST(no_plain_file_is_no_result) {
  static const char *const names[] = {"lst",    "h5",       "json", "dat",
                                      "h5.tmp", "json.tmp", "lock"};
  static const char *const ways[] = {"mkdir", "mkfifo",
                                     "install -m 444 job.inp"};
  for (size_t k = 0; k < sizeof names / sizeof *names; ++k)
    for (int way = 0; way < (k == 6 ? 2 : 3); ++way) {
      JOB j = begin();
      char name[16];
      write_deck(&j, 2, "one.msh");
      snprintf(name, sizeof name, "job.%s", names[k]);
      PRINTED(command,
              "for r in lst sta cvg json; do echo old > job.$r; done; "
              "rm -f %s; %s %s",
              name, ways[way], name);
      shell(&j, command);
      int code = job_run(&j, "");
      ck_assert_msg(code == 4 && strstr(j.errors, name) != NULL,
                    "%s: exit %d: %s", names[k], code, j.errors);
      for (int old = 0; old < 4; ++old) {
        const char *result =
            ((const char *[]){"lst", "sta", "cvg", "json"})[old];
        snprintf(name, sizeof name, "job.%s", result);
        if (strcmp(result, names[k]) != 0) still_there(&j, name, "old\n");
      }
    }
}

/* Before anything is made, not at its end. */
TEST(results_whose_names_are_too_long_are_refused_at_once) {
  JOB j = begin();
  write_deck(&j, 2, "one.msh");
  int code = job_shell(&j,
                       "n=$(printf '%0240d' 7) && cp job.inp $n.inp && "
                       "protis $n -o new");
  ck_assert_msg(code == 4 && strstr(j.errors, "name is too long") != NULL,
                "exit %d: %s", code, j.errors);
  shell(&j, "test ! -e new");
}

UNIT_MAIN("inputs")
