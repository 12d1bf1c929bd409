/*
 * Large contacts: both kinds of stiffness, CPU seconds and memory of whole runs
 * next to what --check foresees (its row of the kind, the rest of its line
 * "memory" and PROGRAM for the program itself).
 *
 * BIG in the environment adds the rows that take minutes or gigabytes; ROW, a
 * number from 1, is one of all of them alone.
 *
 * Strips whose cells double in size away from a rough floor, one of cells of
 * one size, cubes, and a block whose cells grow away from the floor, pressed
 * and sheared, from a cold start, mu = 0.3. The same problems by GetFEM where
 * python3-getfem is installed (tests/peers/getfem_contact.py).
 */
#include "mesh/mesh.h"
#include "support/job.h"
#include "support/unit.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

typedef enum { GRADED, UNIFORM } spacing;

enum { KINDS = 5 };

/* Another program in the place of a kind. */
#define GETFEM "GetFEM"

typedef struct bench_case {
  int dim, cells; /* at the contact, along an edge */
  spacing how;
  const char *kinds[KINDS]; /* STIFFNESS=, and METHOD= */
  int large;                /* 1: only with BIG */
} bench_case;

#define BOTH \
  { "FACTOR", "DENSE" }
#define METHODS                                              \
  {                                                          \
    "FACTOR", "FACTOR, METHOD=PCG", "FACTOR, METHOD=AUGLAG", \
        "FACTOR, METHOD=PROXIMAL", GETFEM                    \
  }
static const bench_case cases[] = {
    {2, 512, GRADED, BOTH, 0},
    {2, 1024, GRADED, BOTH, 0},
    {2, 2048, GRADED, BOTH, 0},
    {2, 4096, GRADED, METHODS, 0},
    {2, 32768, GRADED, {"FACTOR"}, 1},
    {2, 8192, UNIFORM, {"FACTOR"}, 1},
    {3, 12, UNIFORM, {"FACTOR", "DENSE", GETFEM}, 0},
    {3, 20, UNIFORM, BOTH, 0},
    {3, 33, UNIFORM, {"DENSE", GETFEM}, 1},
    {3, 52, UNIFORM, {"DENSE"}, 1},
    {3, 200, GRADED, {"FACTOR"}, 1}};

enum { LEAST = 8, LAYERS = 122 };
static const double PROGRAM = 10; /* MB */

/* ---- meshes ----------------------------------------------------------------
 */

typedef struct row {
  int first, n; /* first node, cells */
  double y;
} row;

/* Rows of nodes of a strip: two of cells of one size, then one that joins two
 * cells of it to each of the next. */
static int strip_rows(int cells, row *r) {
  int n = 0, node = 0, size = cells;
  double y = 0;
  r[n++] = (row){0, size, 0};
  while (y < 0.999) {
    int halve = size > LEAST && n % 3 == 0;
    node += r[n - 1].n + 1;
    y += (halve ? 1.5 : 1.0) / size;
    if (halve) size /= 2;
    if (size <= LEAST && y > 1) y = 1;
    r[n++] = (row){node, size, y};
  }
  return n;
}

static int layers(int cells, row *r) {
  for (int k = 0; k <= LAYERS; ++k)
    r[k] = (row){k * (cells + 1), cells, (double)k / cells};
  return LAYERS + 1;
}

static void triangle(FILE *f, int *no, int a, int b, int c) {
  fprintf(f, "%d 2 2 1 1 %d %d %d\n", ++*no, a + 1, b + 1, c + 1);
}

/* Triangles between two rows; returns how many; f NULL: counts. */
static int between(FILE *f, int *no, const row *a, const row *b) {
  if (f == NULL) return a->n == b->n ? 2 * a->n : 3 * b->n;
  for (int i = 0; i < b->n; ++i) {
    int p = a->first + (a->n == b->n ? i : 2 * i), q = b->first + i;
    if (a->n == b->n) {
      triangle(f, no, p, p + 1, q + 1);
      triangle(f, no, p, q + 1, q);
    } else {
      triangle(f, no, p, p + 1, q);
      triangle(f, no, p + 1, q + 1, q);
      triangle(f, no, p + 1, p + 2, q + 1);
    }
  }
  return 0;
}

static void write_strip(FILE *f, int cells, spacing how) {
  FREED row *r = calloc(200, sizeof *r);
  int n = how == GRADED ? strip_rows(cells, r) : layers(cells, r);
  int no = 0, elements = cells + r[n - 1].n;
  fprintf(f,
          "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n"
          "1 2 \"BOTTOM\"\n1 3 \"TOP\"\n2 1 \"BODY\"\n$EndPhysicalNames\n"
          "$Nodes\n%d\n",
          r[n - 1].first + r[n - 1].n + 1);
  for (int k = 0; k < n; ++k)
    for (int i = 0; i <= r[k].n; ++i)
      fprintf(f, "%d %.17g %.17g 0\n", r[k].first + i + 1, (double)i / r[k].n,
              r[k].y);
  for (int k = 1; k < n; ++k) elements += between(NULL, NULL, r + k - 1, r + k);
  fprintf(f, "$EndNodes\n$Elements\n%d\n", elements);
  for (int i = 0; i < cells; ++i)
    fprintf(f, "%d 1 2 2 2 %d %d\n", ++no, i + 1, i + 2);
  for (int i = 0, at = r[n - 1].first; i < r[n - 1].n; ++i)
    fprintf(f, "%d 1 2 3 3 %d %d\n", ++no, at + i + 1, at + i + 2);
  for (int k = 1; k < n; ++k) between(f, &no, r + k - 1, r + k);
  fprintf(f, "$EndElements\n");
}

static void write_cube(FILE *f, int cells) {
  fprintf(f,
          "Point(1) = {0, 0, 0};\n"
          "l[] = Extrude {1, 0, 0} { Point{1}; Layers{%d}; };\n"
          "s[] = Extrude {0, 1, 0} { Line{l[1]}; Layers{%d}; };\n"
          "v[] = Extrude {0, 0, 1} { Surface{s[1]}; Layers{%d}; };\n"
          "Physical Surface(\"BOTTOM\") = {s[1]};\n"
          "Physical Surface(\"TOP\") = {v[0]};\n"
          "Physical Volume(\"BODY\") = {v[1]};\n",
          cells, cells, cells);
}

/* A block with cells of size 1/cells on the floor. */
static void write_block(FILE *f, int cells) {
  fprintf(f,
          "Point(1) = {0, 0, 0, 1};\n"
          "l[] = Extrude {1, 0, 0} { Point{1}; };\n"
          "s[] = Extrude {0, 1, 0} { Line{l[1]}; };\n"
          "v[] = Extrude {0, 0, 0.5} { Surface{s[1]}; };\n"
          "Field[1] = MathEval;\nField[1].F = \"1/%d + 0.5*z\";\n"
          "Background Field = 1;\n"
          "Mesh.CharacteristicLengthExtendFromBoundary = 0;\n"
          "Mesh.CharacteristicLengthFromPoints = 0;\n"
          "Physical Surface(\"BOTTOM\") = {s[1]};\n"
          "Physical Surface(\"TOP\") = {v[0]};\n"
          "Physical Volume(\"BODY\") = {v[1]};\n",
          cells);
}

static void write_mesh(const mesh *m, const char *path) {
  FILE *f = fopen(path, "w");
  int no = 0, items = 0;
  for (int g = 0; g < m->n_group; ++g) items += m->group[g].n_item;
  fprintf(f, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n%d\n",
          m->n_group);
  for (int g = 0; g < m->n_group; ++g)
    fprintf(f, "%d %d \"%s\"\n", m->group[g].dim, g + 1, m->group[g].name);
  fprintf(f, "$EndPhysicalNames\n$Nodes\n%d\n", m->n_node);
  for (int i = 0; i < m->n_node; ++i)
    fprintf(f, "%d %.17g %.17g %.17g\n", i + 1, m->x[3 * i], m->x[3 * i + 1],
            m->x[3 * i + 2]);
  fprintf(f, "$EndNodes\n$Elements\n%d\n", items);
  for (int g = 0; g < m->n_group; ++g)
    for (int k = 0; k < m->group[g].n_item; ++k) {
      const int id = m->group[g].item_id[k], n = m->group[g].dim + 1;
      const int *node = (n == 4 ? m->elem : m->face) + n * id;
      fprintf(f, "%d %d 2 %d %d", ++no, n == 4 ? 4 : 2, g + 1, g + 1);
      for (int c = 0; c < n; ++c) fprintf(f, " %d", node[c] + 1);
      fputc('\n', f);
    }
  fprintf(f, "$EndElements\n");
  fclose(f);
}

/* The mesh of a .geo, so that no run counts gmsh; by a process of its own,
 * whose memory would count too. */
static void mesh_block(const char *geo, const char *msh) {
  const pid_t child = fork();
  if (child == 0) {
    const mesh_source from = {.file = geo, .scale = 1};
    const place at = {0};
    mesh *m = NULL;
    message_log *log = NULL;
    if (message_log_new(&log) != OK) _exit(1);
    if (mesh_read_gmsh(&from, &at, log, &m) != OK) _exit(1);
    write_mesh(m, msh);
    _exit(0);
  }
  waitpid(child, NULL, 0);
}

/* ---- runs
 * -------------------------------------------------------------------- */

static job make_job(const bench_case *c, const char *kind) {
  job j = job_begin("size");
  const int is_msh = c->dim == 2;
  const char *file = is_msh || c->how == GRADED ? "size.msh" : "size.geo";
  PRINTED(path, "%s/size.%s", j.dir, is_msh ? "msh" : "geo");
  PRINTED(made, "%s/size.msh", j.dir);
  FILE *f = fopen(path, "w");
  if (c->dim == 2)
    write_strip(f, c->cells, c->how);
  else if (c->how == UNIFORM)
    write_cube(f, c->cells);
  else
    write_block(f, c->cells);
  fclose(f);
  if (!is_msh && c->how == GRADED) mesh_block(path, made);
  job_write(&j, "size.inp",
            "*MESH, FILE=%s\n*MATERIAL, NAME=M\n*ELASTIC\n1., 0.3\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=GAP\n"
            "\"0.002*(1 + cos(6.283*%s + 1)%s) + 0.001*(1 + cos(31.4*x))\"\n"
            "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
            "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n*STEP\n*STATIC\n"
            "*BOUNDARY\nTOP, 1, 1, 0.0015\n%sTOP, %d, %d, -0.004\n"
            "*SOLVER, STIFFNESS=%s\n*ACCURACY, SOLVER=NO, MESH=NO\n"
            "*OUTPUT, HDF5=NO\n*PRINT, TOTALS\n*END STEP\n",
            file, "x", c->dim == 3 ? "*cos(6.283*y)" : "",
            c->dim == 3 ? "TOP, 2, 2, 0.\n" : "", c->dim, c->dim, kind);
  return j;
}

/* Seconds and megabytes of a process whose output goes into a file; 0: it
 * failed. */
static int run(const char *const *words, const char *output, double *cpu,
               double *mega) {
  struct rusage used;
  int state;
  fflush(stdout); /* or the child prints it again */
  const pid_t child = fork();
  if (child == 0) {
    if (freopen(output, "w", stdout) != NULL)
      execv(words[0], (char *const *)words);
    _exit(127);
  }
  wait4(child, &state, 0, &used);
  *cpu = (double)(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
         1e-6 * (double)(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
  *mega = (double)used.ru_maxrss * 1024 / 1e6;
  return WIFEXITED(state) && WEXITSTATUS(state) == 0;
}

static int run_protis(const job *j, double *cpu, double *mega) {
  const char *program = getenv("PROTIS");
  PRINTED(deck, "%s/size.inp", j->dir);
  if (program == NULL) program = "build/release/protis";
  return run((const char *const[]){program, deck, "--quiet", NULL}, "/dev/null",
             cpu, mega);
}

/* Also by how much the normal force differs from that of Protis. */
static void row_of_getfem(const bench_case *c) {
  static const char python[] = "/usr/bin/python3";
  double cpu, mega, force;
  JOB j = make_job(c, "AUTO");
  PRINTED(msh, "%s/size.msh", j.dir);
  PRINTED(geo, "%s/size.geo", j.dir);
  PRINTED(output, "%s/size.txt", j.dir);
  if (access(msh, F_OK) != 0) mesh_block(geo, msh);
  printf("%d-D %-7s %6d %-23s ", c->dim,
         c->how == GRADED ? "graded" : "uniform", c->cells, GETFEM);
  if (!run((const char *const[]){python, "-c", "import getfem", NULL},
           "/dev/null", &cpu, &mega))
    puts("is not installed");
  else if (!run_protis(&j, &cpu, &mega) ||
           !run((const char *const[]){python, "tests/peers/getfem_contact.py",
                                      msh, NULL},
                output, &cpu, &mega))
    puts("failed");
  else {
    FREED char *text = job_file(&j, "txt");
    ck_assert_ptr_nonnull(text);
    force = strtod(text, NULL);
    printf("%9.2f %9.1f   force differs by %.1e\n", cpu, mega,
           force / job_value(&j, "TOTALS", 0, "normal") - 1);
  }
}

/* What --check foresees of a kind, s and MB. */
static void expected(job *j, const char *kind, double *cpu, double *mega) {
  *cpu = *mega = 0;
  if (job_run(j, "--check") != 0) return;
  PRINTED(key, "stiffness %.*s", (int)strcspn(kind, ","), kind);
  const char *at = strstr(j->text, key);
  if (at == NULL) return;
  at += strcspn(at, "0123456789");
  sscanf(at, "%lf s, %lf MB", cpu, mega);
  const char *rest = strstr(at, "for the contact, ");
  if (rest != NULL)
    *mega += PROGRAM + strtod(rest + strlen("for the contact, "), NULL);
}

static void row_of(const bench_case *c, const char *kind) {
  double cpu, mega, cpu_before, mega_before;
  if (strcmp(kind, GETFEM) == 0) {
    row_of_getfem(c);
    return;
  }
  JOB j = make_job(c, kind);
  expected(&j, kind, &cpu_before, &mega_before);
  if (run_protis(&j, &cpu, &mega))
    printf("%d-D %-7s %6d %-23s %9.2f %9.1f %12.2g %12.1f\n", c->dim,
           c->how == GRADED ? "graded" : "uniform", c->cells, kind, cpu, mega,
           cpu_before, mega_before);
  else
    printf("%d-D %6d %-23s failed\n", c->dim, c->cells, kind);
  fflush(stdout);
}

TEST(both_kinds_of_stiffness) {
  const char *one = getenv("ROW");
  const int all = getenv("BIG") != NULL, only = one != NULL ? atoi(one) : 0;
  puts(
      "mesh           cells kind                        cpu[s]   mem[MB]  "
      "expected[s] "
      "expected[MB]");
  for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
    if (only > 0 ? i + 1 != (size_t)only : cases[i].large && !all) continue;
    for (int k = 0; k < KINDS && cases[i].kinds[k] != NULL; ++k)
      row_of(&cases[i], cases[i].kinds[k]);
  }
}

UNIT_MAIN("size")
