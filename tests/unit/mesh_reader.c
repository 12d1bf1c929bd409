/* src/mesh/child.c, raw.c: the process in which gmsh reads and meshes: how it
 * ends, what it leaves, what it must not do. */
#include "mesh/msh/geo.h"
#include "mesh/raw.h"
#include "support/mesh_file.h"
#include "support/unit.h"

#include <dirent.h>
#include <errno.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

static const char good_msh[] = MSH(BODY, SQUARE, "2\n" TWO);

/* gmsh reads nothing after a failure in the same process. */
/* Once for all tests, which are processes of their own. */
__attribute__((constructor)) static void load(void) { mesh_gmsh_load(); }

TEST(good_file_is_read_after_bad_ones) {
  MESH_FILE f = mesh_file_open();
  static const char *const bad[] = {
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\nrubbish\n$EndNodes\n",
      "$MeshFormat\n4.1 1 8\nrubbish\n$EndRubbish\n"};
  for (int i = 0; i < 2; ++i) {
    ck_assert_ptr_null(mesh_file_text(&f, "bad.msh", bad[i]));
    ck_assert_int_eq(f.answer, ERR_MESH);
    OWNED mesh *m = mesh_file_text(&f, "good.msh", good_msh);
    ck_assert_msg(m != NULL && m->n_elem == 2, "%s", f.messages);
  }
}

/* SystemCall runs a shell below gmsh: its parent is the reader. */
TEST(reader_that_dies_is_told) {
  static const struct {
    const char *geo, *text;
    status answer;
  } cases[] = {
      {"SystemCall \"kill -SEGV $PPID\";\n", "gmsh was ended by signal 11",
       ERR_MESH},
      {"Exit;\n", "gmsh ended by itself", ERR_MESH},
      {"Error(\"no h given\");\n", "gmsh fails to read the file: no h given",
       ERR_MESH},
      {"Merge \"none.stl\";\n", "Unable to open file", ERR_FILE},
      {"SetFactory(\"OpenCASCADE\");\na() = ShapeFromFile(\"none.step\");\n",
       "Could not read file", ERR_FILE},
      {"SetFactory(\"OpenCASCADE\");\na() = ShapeFromFile(\"x.step\");\n",
       "Could not read file", ERR_MESH},
      /* the surface is not closed: gmsh throws what nobody catches */
      {"Point(1)={0,0,0}; Point(2)={1,0,0}; Point(3)={1,1,0}; Line(1)={1,2};"
       "Line(2)={2,3}; Curve Loop(1)={1,2}; Plane Surface(1)={1};"
       "Physical Surface(1)={1};\n",
       "gmsh", ERR_MESH},
  };
  MESH_FILE f = mesh_file_open();
  mesh_file_write(&f, "x.step", "no shape", 8);
  for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
    ck_assert_ptr_null(mesh_file_text(&f, "dies.geo", cases[i].geo));
    ck_assert_int_eq(f.answer, cases[i].answer);
    ck_assert_msg(strstr(f.messages, cases[i].text) != NULL, "%s", f.messages);
    ck_assert_ptr_nonnull(strstr(f.messages, "P3003"));
    ck_assert(waitpid(-1, NULL, WNOHANG) == -1 && errno == ECHILD);
  }
  ck_assert_ptr_null(
      mesh_file_text(&f, "killed.geo", "SystemCall \"kill -KILL $PPID\";\n"));
  ck_assert_int_eq(f.answer, ERR_MEMORY);
  ck_assert_ptr_nonnull(strstr(status_message(), "gmsh was killed"));
  /* what its scanner says before it exits */
  ck_assert_ptr_null(mesh_file_text(
      &f, "scanner.geo",
      "SystemCall \"echo out of dynamic memory in a buffer >&2\"; Exit;\n"));
  ck_assert_int_eq(f.answer, ERR_MEMORY);
  ck_assert_ptr_nonnull(strstr(status_message(), "gmsh ran out of memory"));
  ck_assert_ptr_nonnull(strstr(status_message(), "/scanner.geo"));
  ck_assert_ptr_nonnull(strstr(status_message(), "--max-memory"));
}

/* The process of a file in the folder that a shell writes; 0: none in time. */
static pid_t told_process(const char *path) {
  int pid = 0;
  for (int i = 0; i < 1000 && pid == 0; ++i) {
    FILE *told = fopen(path, "r");
    if (told != NULL && fscanf(told, "%d\n", &pid) != 1) pid = 0;
    if (told != NULL) fclose(told);
    usleep(10000);
  }
  return pid;
}

/* A program that is killed leaves no mesher: here the shell below it lives
 * until the mesher does not. */
TEST(reader_dies_with_the_program) {
  MESH_FILE f = mesh_file_open();
  PRINTED(path, "%s/pid", f.folder);
  PRINTED(text,
          "SystemCall \"exec > %s 2>&1; echo $PPID; while kill -0 $PPID; do "
          "sleep 0.01; "
          "done\";\n",
          path);
  fflush(NULL);
  const pid_t program = fork();
  if (program == 0) {
    mesh_file_text(&f, "waits.geo", text);
    _exit(0);
  }
  const pid_t reader = told_process(path);
  kill(program, SIGKILL);
  waitpid(program, NULL, 0);
  for (int i = 0; i < 1000 && kill(reader, 0) == 0; ++i) usleep(10000);
  const int lives = kill(reader, 0) == 0;
  if (lives && reader > 0) kill(reader, SIGKILL);
  ck_assert_int_gt(reader, 0);
  ck_assert(!lives);
}

static void on_alarm(int signal) { (void)signal; }

/* Signals that the program handles must not break the reading, and what is
 * ignored by the program (SIGCHLD) must not lose the mesh. */
TEST(signals_do_not_disturb) {
  MESH_FILE f = mesh_file_open();
  struct sigaction often = {.sa_handler = on_alarm}; /* no SA_RESTART */
  ck_assert_int_eq(sigaction(SIGALRM, &often, NULL), 0);
  static const char wait_geo[] =
      "SystemCall \"sleep 0.3\";" PLATE "Physical Surface(1)={1};\n";
  ualarm(2000, 2000);
  mesh *m = mesh_file_text(&f, "w.geo", wait_geo);
  ualarm(0, 0);
  ck_assert_msg(m != NULL && m->n_elem > 0, "%s", f.messages);
  memory_free(m);
  signal(SIGCHLD, SIG_IGN);
  m = mesh_file_text(&f, "w.geo", wait_geo);
  signal(SIGCHLD, SIG_DFL);
  ck_assert_msg(m != NULL && m->n_elem > 0, "%s", f.messages);
  memory_free(m);
}

/* With little address space libgmsh cannot be loaded, or runs out later. */
TEST(want_of_memory_in_gmsh_is_told) {
#if defined(__SANITIZE_ADDRESS__)
  return; /* it needs terabytes of addresses itself */
#endif
  MESH_FILE f = mesh_file_open();
  static const char geo[] = PLATE
      "// Merge: tests/preload leaves it to gmsh\n"
      "Transfinite Curve{1:4}=1200; Transfinite Surface{1};"
      "Physical Surface(1)={1};\n";
  static const rlim_t megabytes[] = {60, 400};
  struct rlimit old;
  getrlimit(RLIMIT_AS, &old);
  for (int i = 0; i < 2; ++i) {
    struct rlimit less = {megabytes[i] << 20, old.rlim_max};
    ck_assert_int_eq(setrlimit(RLIMIT_AS, &less), 0);
    mesh *m = mesh_file_text(&f, "large.geo", geo);
    setrlimit(RLIMIT_AS, &old);
    ck_assert_ptr_null(m);
    ck_assert_msg(f.answer == ERR_MEMORY, "%s %s", f.messages,
                  status_message());
  }
}

/* n x n cells of the unit square as a .msh. */
static void write_square(const mesh_file *f, const char *name, int n) {
  FILE *out = fopen(mesh_file_path(f, name), "w");
  ck_assert_ptr_nonnull(out);
  fprintf(out, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n",
          (n + 1) * (n + 1));
  for (int k = 0; k < (n + 1) * (n + 1); ++k)
    fprintf(out, "%d %d %d 0\n", k + 1, k % (n + 1), k / (n + 1));
  fprintf(out, "$EndNodes\n$Elements\n%d\n", 2 * n * n);
  for (int k = 0; k < n * n; ++k) {
    int a = k % n + (n + 1) * (k / n) + 1, d = a + n + 1;
    fprintf(out, "%d 2 2 1 1 %d %d %d\n%d 2 2 1 1 %d %d %d\n", 2 * k + 1, a,
            a + 1, d, 2 * k + 2, a + 1, d + 1, d);
  }
  fprintf(out, "$EndElements\n");
  fclose(out);
}

/* Wherever the memory ends while a file is read, that is what is told: gmsh
 * swallows some of its own failures. */
TEST(want_of_memory_is_never_taken_for_a_bad_mesh) {
#if defined(__SANITIZE_ADDRESS__)
  return;
#endif
  MESH_FILE f = mesh_file_open();
  write_square(&f, "large.msh", unit_whole() ? 400 : 200);
  PRINTED(geo, "Merge \"%s/large.msh\";\n", f.folder);
  mesh_file_write(&f, "large.geo", geo, strlen(geo));
  struct rlimit old;
  getrlimit(RLIMIT_AS, &old);
  int in_gmsh = 0;
  status answer = ERR_MEMORY;
  for (rlim_t mb = 80; answer == ERR_MEMORY && mb < 2000;
       mb += unit_whole() ? 25 : 10) {
    struct rlimit less = {mb << 20, old.rlim_max};
    ck_assert_int_eq(setrlimit(RLIMIT_AS, &less), 0);
    OWNED mesh *m = mesh_file_read(&f, "large.geo", 1.0, 0, NULL);
    setrlimit(RLIMIT_AS, &old);
    answer = f.answer;
    in_gmsh += strstr(status_message(), "gmsh ran out of memory") != NULL;
    ck_assert_msg(answer == OK || answer == ERR_MEMORY, "%d MB: %s", (int)mb,
                  f.messages);
  }
  ck_assert_int_eq(answer, OK);
  ck_assert_int_gt(in_gmsh, 0);
}

/* What gmsh prints does not reach the user. */
TEST(nothing_is_printed) {
  MESH_FILE f = mesh_file_open();
  fflush(NULL);
  int out = dup(1), err = dup(2);
  FILE *log = tmpfile();
  dup2(fileno(log), 1);
  dup2(fileno(log), 2);
  printf("mine"); /* buffered: must come out once */
  mesh_file_text(&f, "e.geo", "Printf(\"hello\"); Error(\"bad\"); Exit;\n");
  OWNED mesh *m =
      mesh_file_text(&f, "g.geo", PLATE "Physical Surface(1)={1};\n");
  fflush(NULL);
  dup2(out, 1);
  dup2(err, 2);
  rewind(log);
  char text[64] = "";
  size_t n = fread(text, 1, sizeof text - 1, log);
  ck_assert_uint_eq(n, 4);
  ck_assert_str_eq(text, "mine");
  fclose(log);
  close(out);
  close(err);
}

/* Options files of the .geo or in the home, and the environment, have no
 * effect; the home is left as it is. */
TEST(geometry_alone_makes_the_mesh) {
  static const char *const hidden[] = {"g.geo.opt", ".gmshrc", ".gmsh-options"};
  MESH_FILE f = mesh_file_open();
  PRINTED(ran, "%s", mesh_file_path(&f, "ran"));
  PRINTED(text, "Mesh.ElementOrder = 2; SystemCall \"touch %s\";\n", ran);
  for (int i = 0; i < 3; ++i)
    mesh_file_write(&f, hidden[i], text, strlen(text));
  PRINTED(home, "%s", getenv("HOME") ? getenv("HOME") : "/");
  ck_assert_int_eq(setenv("HOME", f.folder, 1), 0);
  mesh *m = mesh_file_text(
      &f, "g.geo",
      PLATE
      "Physical Surface(1)={1};\n"
      "If (StrFind(GetEnv(\"HOME\"), \"protis\")) Error(\"home\"); EndIf\n");
  setenv("HOME", home, 1);
  ck_assert_msg(m != NULL && f.messages[0] == '\0', "%s", f.messages);
  memory_free(m);
  ck_assert_int_ne(access(ran, F_OK), 0);
  int n = 0;
  DIR *folder = opendir(f.folder);
  while (readdir(folder) != NULL) ++n;
  closedir(folder);
  ck_assert_int_eq(n, 2 + 3 + 1); /* what was written above */
}

/* gmsh executes the options files of merged files, however they are named. */
TEST(options_of_merged_files_are_refused) {
  static const char *const ways[] = {"Include \"in.geo\";", "Merge \"in.geo\";",
                                     "Merge StrCat(\"in\", \".geo\");"};
  MESH_FILE f = mesh_file_open();
  mesh_file_write(&f, "in.geo", PLATE, strlen(PLATE));
  mesh_file_write(&f, "in.geo.opt", "Mesh.ElementOrder = 2;\n", 23);
  for (int i = 0; i < 3; ++i) {
    PRINTED(text, "%s\nPhysical Surface(1)={1};\n", ways[i]);
    OWNED mesh *m = mesh_file_text(&f, "g.geo", text);
    ck_assert_msg((m != NULL) == (i == 0), "%s", f.messages);
    ck_assert_int_eq(strstr(f.messages, "options file of gmsh") != NULL, i > 0);
  }
}

/* A file that only gmsh can name or that cannot be read may have any name,
 * whatever follows it. */
TEST(files_without_a_name_may_have_any_word) {
  static const char *const texts[] = {
      "// Merge h;\n Include \"in.geo\"; Printf(\"a\");",
      "Merge StrCat(\"x\", \".geo\"); Include \"in.geo\"; Printf(\"a\");",
      "Merge\"x.msh\"; Printf(\"a\"); Include \"in.geo\";",
      "Include \"none.geo\"; Include \"in.geo\"; Printf(\"a\");"};
  MESH_FILE f = mesh_file_open();
  mesh_file_write(&f, "in.geo", PLATE, strlen(PLATE));
  for (int i = 0; i < 4; ++i) {
    geo_text g;
    mesh_file_write(&f, "g.geo", texts[i], strlen(texts[i]));
    PRINTED(path, "%s/g.geo", f.folder);
    ck_assert_int_eq(geo_read(path, &g), OK);
    ck_assert_int_eq(g.n_file, i == 3 ? 3 : 2);
    ck_assert_int_eq(geo_has(&g, "Surface"), 1);
    ck_assert_int_eq(geo_has(&g, "h"), i > 0);
    geo_free(&g);
  }
}

/* Pipes do not take the place of standard streams. */
TEST(closed_streams_do_not_disturb) {
  MESH_FILE f = mesh_file_open();
  int kept[3];
  for (int i = 0; i < 3; ++i) {
    kept[i] = dup(i);
    close(i);
  }
  OWNED mesh *m =
      mesh_file_text(&f, "g.geo", PLATE "Physical Surface(1)={1};\n");
  for (int i = 0; i < 3; ++i) {
    dup2(kept[i], i);
    close(kept[i]);
  }
  ck_assert_msg(m != NULL && m->n_elem > 0, "%s", f.messages);
}

static char left_behind[192];

static void leave_a_file(void) {
  FILE *out = fopen(left_behind, "w");
  if (out != NULL) fclose(out);
}

/* Handlers of the program belong to the program, also if gmsh calls exit. */
TEST(exit_of_gmsh_runs_no_handler_of_the_program) {
  MESH_FILE f = mesh_file_open();
  snprintf(left_behind, sizeof left_behind, "%s", mesh_file_path(&f, "left"));
  ck_assert_int_eq(atexit(leave_a_file), 0);
  ck_assert_ptr_null(mesh_file_text(&f, "exit.geo", "Exit;\n"));
  ck_assert_int_ne(access(left_behind, F_OK), 0);
}

/* Records that are none, do not fit or stop: refused, nothing is kept. */
TEST(rubbish_from_the_reader_is_refused) {
  static const wire_head heads[][3] = {
      {{0, WIRE_END, 0, 0, 0}},
      {{WIRE_MAGIC, WIRE_COUNT, 0, 0, 0}},
      {{WIRE_MAGIC, WIRE_NODE_NO, 0, 0, (uint64_t)1 << 60}},
      {{WIRE_MAGIC, WIRE_ELEM_NO, 0, 0, 0}},
      {{WIRE_MAGIC, WIRE_CENSUS, 0, 0, 0}},
      {{WIRE_MAGIC, WIRE_LOOSE, 0, 0, 0}},
      {{WIRE_MAGIC, WIRE_END, 0, 0, 0}},
      {{WIRE_MAGIC, WIRE_NODE_NO, 0, 0, 0},
       {WIRE_MAGIC, WIRE_NODE_NO, 0, 0, 0}},
      {{WIRE_MAGIC, WIRE_BLOCK, 2, 2, 0},
       {WIRE_MAGIC, WIRE_ELEM_NODE, 0, 0, 0}},
      {{WIRE_MAGIC, WIRE_NODE_NO, 0, 0, 0},
       {WIRE_MAGIC, WIRE_NODE_X, 0, 0, 0},
       {WIRE_MAGIC, WIRE_BLOCK, 2, 2, 0}},
  };
  size_t before = memory_in_use();
  for (size_t i = 0; i < sizeof heads / sizeof *heads; ++i) {
    int ends[2], stopped, n = 1;
    ck_assert_int_eq(pipe(ends), 0);
    while (n < 3 && heads[i][n].magic != 0) ++n;
    for (int k = 0; k < n; ++k)
      ck_assert(write(ends[1], &heads[i][k], sizeof heads[i][k]) ==
                sizeof heads[i][k]);
    close(ends[1]);
    raw_mesh *raw = memory_new(1, sizeof *raw);
    ck_assert_int_eq(raw_receive(ends[0], raw, &stopped), ERR_MESH);
    if (i < 3) /* by its head */
      ck_assert_msg(strstr(status_message(), "what is no mesh") != NULL, "%s",
                    status_message());
    ck_assert_int_eq(stopped, n == 3); /* the last one is cut off */
    memory_free(raw);
    close(ends[0]);
    ck_assert_uint_eq(memory_in_use(), before);
  }
}

UNIT_MAIN("mesh_reader")
