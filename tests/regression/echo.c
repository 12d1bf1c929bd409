/*
 * The deck that JOB.lst echoes, with all defaults and without includes, is
 * read back to the same echo, and running it gives the same tables to the last
 * byte.
 */
#include "model/keyword/keyword.h"
#include "support/job.h"
#include "support/unit.h"

#include <glob.h>

enum { TEXT = 4096 };

/* Echo of a deck; the caller frees it. */
static char *echo_of(const char *path) {
  OWNED message_log *log = NULL;
  OWNED deck *d = NULL;
  OWNED model *m = NULL;
  char *text = NULL;
  size_t size;
  ck_assert_int_eq(message_log_new(&log), OK);
  status st = deck_read(path, 0, NULL, log, &d);
  if (st == OK) st = model_from_deck(d, log, &m);
  if (st != OK) message_print(log, stderr);
  ck_assert_msg(st == OK, "%s", path);
  FILE *out = open_memstream(&text, &size);
  model_echo(out, m);
  fclose(out);
  return text;
}

/* The echo of the echo; "echo" is read from the folder of j. */
static void reads_back(const job *j, const char *what, const char *echo) {
  PRINTED(path, "%s/echo.inp", j->dir);
  job_write(j, "echo.inp", "%s", echo);
  FREED char *again = echo_of(path);
  ck_assert_msg(strcmp(echo, again) == 0, "%s:\n%s\n----\n%s", what, echo,
                again);
}

TEST(echo_of_every_example_reads_back) {
  glob_t found;
  JOB j = job_begin("echo");
  ck_assert_int_eq(glob("input/*/*.inp", 0, NULL, &found), 0);
  ck_assert_int_eq(
      glob("tests/regression/bad/bad.inp", GLOB_APPEND, NULL, &found), 0);
  ck_assert_uint_ge(found.gl_pathc, 8);
  for (size_t i = 0; i < found.gl_pathc; ++i) {
    FREED char *echo = echo_of(found.gl_pathv[i]);
    reads_back(&j, found.gl_pathv[i], echo);
  }
  globfree(&found);
}

/* Names with commas, equals signs, blanks and stars; an include in a folder of
 * its own; fixed columns; continued lines; negative values in expressions. */
TEST(echo_of_odd_spellings_reads_back) {
  JOB j = job_begin("odd");
  PRINTED(sub, "mkdir '%s/sub'", j.dir);
  ck_assert_int_eq(system(sub), 0);
  job_write(&j, "sub/mesh.inc", "*MESH, FILE=\"a, b=c.msh\", SCALE=1.D-3\n");
  job_write(&j, "odd.inp",
            "*Heading\nOne, two = \"three\", <H> <Q>\n  and a second line,\n"
            "*parameter\nH = -0.5\nLong = 1/3\n"
            "*include, input=sub/mesh.inc\n"
            "*material, name=\"Steel, mild = soft ** x\"\n*elastic\n1.5+03,\n"
            "0.3\n*density\n\"2*pi\"\n"
            "*material, name=Glass\n*elastic, moduli=long   term\n1e5, .2\n"
            "*inelastic, law=prony, shift=wlf, t_ref=20, c1=17.4, c2=51.6\n"
            ".3, 0., \"2 + t\"\n.2, .1,\n3e4\n"
            "*material, name=Ice\n*elastic\n9e9, .3\n*creep, law=time\n"
            "1e-20, 3, , -10\n3e-20, 3, , -5\n"
            "*material, name=Wax\n*elastic\n9e3, .3\n*inelastic, law=user\n"
            "\"<Long>*(q/100)^3*exp(-50/temp)\"\n"
            "*solid section, elset=\"My body\", type=plane   strain,\n"
            "material=\"Steel, mild = soft ** x\"\n"
            "*amplitude, name=A B\n\"1 - <H>*t\"\n"
            "*obstacle, name=O, type=gap\n\"h*x + <H> + long\"\n"
            "MOVE, 0., \"-t\"\n"
            "*contact, name=C, group=F-1, obstacle=O\n"
            "*friction, contact=c, law=coulomb, table=x\n0., .3, 1., .4,\n"
            "2., 1D-1\n"
            "*step\n*static\n*legacy, format=(A8,I5,F10.2)\n*cload\n"
            "A,B=C       1       250\n"
            "*boundary, amplitude=\"A B\"\n"
            "\"G, 1\", 1, , \"x*y\"\nF-1, 2, 2, , A B\n"
            "*solver, method=newton\n*print, contact, group=F-1, nodes\n"
            "*end step\n");
  PRINTED(path, "%s/odd.inp", j.dir);
  FREED char *echo = echo_of(path);
  ck_assert_ptr_nonnull(strstr(echo, "FILE=\"sub/a, b=c.msh\""));
  ck_assert_ptr_nonnull(strstr(echo, "One, two = \"three\", <H> <Q>"));
  ck_assert_ptr_nonnull(strstr(echo, "NAME=\"Steel, mild = soft ** x\""));
  ck_assert_ptr_nonnull(strstr(echo, "\"A,B=C\", 1, 2.5"));
  ck_assert_ptr_nonnull(strstr(echo, "*CREEP, LAW=TIME, SHIFT=NONE\n"));
  ck_assert_ptr_nonnull(strstr(echo, "SHIFT=WLF, T_REF=20, C1=17.4"));
  reads_back(&j, "odd", echo);
}

/* An absolute name in an include in a folder of its own is left as it is. */
TEST(echo_leaves_absolute_names_alone) {
  JOB j = job_begin("absolute");
  PRINTED(sub, "mkdir '%s/sub'", j.dir);
  ck_assert_int_eq(system(sub), 0);
  job_write(&j, "sub/problem.inc", "*CONDENSED PROBLEM, FILE=/a/b.txt\n");
  job_write(&j, "absolute.inp", "*INCLUDE, INPUT=sub/problem.inc\n");
  PRINTED(path, "%s/absolute.inp", j.dir);
  FREED char *echo = echo_of(path);
  ck_assert_msg(strstr(echo, "FILE=/a/b.txt") != NULL, "%s", echo);
}

/* The part of a listing that is the deck; the caller frees it. */
static char *listed_deck(const job *j) {
  static const char start[] = "DECK\n----\n", end[] = "\nMODEL\n-----\n";
  FREED char *listing = job_file(j, "lst");
  ck_assert_ptr_nonnull(listing);
  char *from = strstr(listing, start);
  ck_assert_ptr_nonnull(from);
  from += strlen(start);
  char *to = strstr(from, end);
  ck_assert_ptr_nonnull(to);
  *to = '\0';
  return strdup(from);
}

typedef struct example {
  const char *folder, *name, *mesh, *words;
} example;

static const example examples[] = {
    {"tests/regression/bad", "bad", "square.msh", ""},
    {"input/greco", "greco", "greco.geo", "-D N=8 -D SIDE=100"},
    {"input/lying_block", "lying_block", "lying_block.geo", "-D N=4"},
    {"input/lying_block", "lying_block_3d", "lying_block_3d.geo", ""},
    {"input/block_shear_3d", "block_shear_3d", "block_shear_3d.geo", "-D N=4"},
    {"input/hertz_line", "disc", "disc.geo", ""},
    {"input/hertz_line", "hertz_line_friction", "hertz_line.geo", ""},
    {"input/hertz_sphere", "hertz_sphere", "hertz_sphere.geo", ""}};

static void copy_file(const job *j, const char *folder, const char *name) {
  PRINTED(path, "%s/%s", folder, name);
  job_copy(j, path);
}

TEST(running_the_echo_gives_the_same_tables) {
  for (size_t i = 0; i < sizeof examples / sizeof *examples; ++i) {
    const example *e = &examples[i];
    char name[64];
    JOB first = job_begin(e->name), second = job_begin(e->name);
    snprintf(name, sizeof name, "%s.inp", e->name);
    copy_file(&first, e->folder, name);
    copy_file(&first, e->folder, e->mesh);
    copy_file(&second, e->folder, e->mesh);
    PRINTED(words, "%s --no-timing", e->words);
    ck_assert_msg(job_run(&first, words) == 0, "%s", first.errors);
    FREED char *deck_text = listed_deck(&first);
    job_write(&second, name, "%s", deck_text);
    ck_assert_msg(job_run(&second, "--no-timing") == 0, "%s", second.errors);
    char *table[] = {job_file(&first, "dat"), job_file(&second, "dat")};
    ck_assert_uint_gt(strlen(table[0]), 500);
    ck_assert_msg(strcmp(table[0], table[1]) == 0, "%s", e->name);
    FREED char *again = listed_deck(&second);
    ck_assert_str_eq(deck_text, again);
    free(table[0]);
    free(table[1]);
  }
}

UNIT_MAIN("echo")
