/* src/mesh: what is wrong with a mesh or its file, and how it is told */
#include "base/memory.h"
#include "mesh/raw.h"
#include "support/mesh_file.h"
#include "support/unit.h"

#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#define SQUARE "4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n"
#define BODY "1\n2 1 \"BODY\"\n"
#define SIDE "2\n1 2 \"SIDE\"\n2 1 \"BODY\"\n"
#define BODY_3D "1\n3 1 \"BODY\"\n"
/* Above and below the triangle 1 2 3. */
#define TETS \
  "7\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n6 0 0 -1\n7 1 1 -1\n"
#define TWO "1 2 2 1 1 1 2 3\n2 2 2 1 1 1 3 4\n"

typedef struct bad_mesh {
  const char *name, *text;
  const char *message; /* after "job.inp:4:1: "                            */
} bad_mesh;

/* One square with its upper side outside of everything. */
#define PLATE                                                               \
  "Point(1)={0,0,0}; Point(2)={1,0,0}; Point(3)={1,1,0}; Point(4)={0,1,0};" \
  "Line(1)={1,2}; Line(2)={2,3}; Line(3)={3,4}; Line(4)={4,1};"             \
  "Curve Loop(1)={1:4}; Plane Surface(1)={1}; Transfinite Curve{1:4}=2;\n"

/* clang-format off */
static const bad_mesh errors[] = {
  {"a.msh", MSH("0\n", SQUARE, "2\n1 2 2 0 1 1 2 3\n2 2 2 0 1 1 3 4\n"),
   "error P3010: the mesh has 0 point(s), 0 curve(s), 1 surface(s), 0 "
   "volume(s), but no physical group"},
  {"a.geo", PLATE,
   "error P3010: the mesh has 4 point(s), 4 curve(s), 1 surface(s), 0 "
   "volume(s), but no physical group"},
  {"b.geo", PLATE "Physical Curve(\"SIDE\")={1}; Physical Point(\"P\")={1};\n",
   "error P3011: the 2 physical group(s) name points or curves only; the mesh "
   "has 1 surface(s) and 0 volume(s)"},
  {"c.geo", PLATE
   "Physical Curve(\"A\", 5)={1}; Physical Surface(\"A\", 9)={1};\n",
   "error P3012: \"A\" names the physical curve 5 and the physical surface 9"},
  {"d.geo", PLATE "Physical Curve(7)={1}; Physical Surface(7)={1};\n",
   "error P3012: \"7\" names the physical curve 7 and the physical surface 7"},
  {"e.geo", PLATE
   "Physical Surface(\"A\")={1};\nPhysical Surface(\"A\")={1};\n",
   "error P3012: mesh file \"%s\": gmsh fails to read the file: Physical "
   "surface 1 already exists"},
  {"f.msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n"
   "1 5 \"SIDE\"\n2 1 \"BODY\"\n$EndPhysicalNames\n$Entities\n0 1 1 0\n"
   "1 0 0 0 1 0 0 1 5 0\n1 0 0 0 1 1 0 1 1 0\n$EndEntities\n$Nodes\n"
   "1 3 1 3\n2 1 0 3\n1\n2\n3\n0 0 0\n1 0 0\n1 1 0\n$EndNodes\n$Elements\n"
   "1 1 1 1\n2 1 2 1\n1 1 2 3\n$EndElements\n",
   "error P3013: physical curve \"SIDE\" (number 5) holds no element"},
  {"g.geo", PLATE "Physical Surface(\"BODY\")={1}; Recombine Surface{1};\n",
   "error P3020: 1 element(s) of type \"Quadrilateral 4\"; the first is no. 1 "
   "in group \"BODY\""},
  {"h.msh", MSH(BODY, "6\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 .5 0 0\n5 .5 .5 0\n"
                "6 0 .5 0\n", "1\n8 9 2 1 1 1 2 3 4 5 6\n"),
   "error P3021: 1 element(s) of type \"Triangle 6\"; the first is no. 8 in "
   "group \"BODY\""},
  {"i.msh", MSH(BODY, "5\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 2 0 0\n",
                "3\n" TWO "3 2 2 1 1 1 2 5\n"),
   "error P3022: 1 element(s) have no area: 3 at (1, 0)"},
  {"j.msh", MSH(BODY_3D, "5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 0\n",
                "2\n1 4 2 1 1 1 2 3 4\n2 4 2 1 1 1 2 3 5\n"),
   "error P3022: 1 element(s) have no volume: 2 at (0.5, 0.5, 0)"},
  {"k.msh", MSH(BODY, SQUARE, "3\n" TWO "3 2 2 1 1 1 2 2\n"),
   "error P3022: 1 element(s) have no area: 3 at (0.666667, 0)"},
  {"z.msh", MSH(BODY, "6\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 .8 .5 0\n"
                "6 .7 .5 0\n",
                "6\n1 2 2 1 1 1 2 5\n2 2 2 1 1 2 6 5\n3 2 2 1 1 2 3 6\n"
                "4 2 2 1 1 3 4 6\n5 2 2 1 1 4 5 6\n6 2 2 1 1 4 1 5\n"),
   "error P3032: 4 face(s) have two elements on one side: 5 and 4 at "
   "(0.35, 0.75), 6 and 5 at (0.4, 0.75), 2 and 3 at (0.85, 0.25), 1 and 2 at "
   "(0.9, 0.25)"},
  {"l.msh", MSH(BODY, "4\n1 0 0 0\n2 nan 0 0\n3 1 inf 0\n4 0 1 0\n", "2\n" TWO),
   "error P3023: 2 node(s) without finite coordinates: 2 at (nan, 0, 0), 3 at "
   "(1, inf, 0)"},
  {"m.msh", MSH(BODY, "4\n1 0 2 0\n2 1 2 0\n3 1 2 1\n4 0 2 1\n", "2\n" TWO),
   "error P3024: the surfaces lie in the plane y = 2, not in z = const"},
  {"n.msh", MSH(BODY, "4\n1 0 0 0\n2 1 0 0\n3 1 1 .5\n4 0 1 .5\n", "2\n" TWO),
   "error P3024: the surfaces are not plane: z runs from 0 to 0.5"},
  {"o.geo", PLATE
   "Extrude{0,0,1}{ Surface{1}; } Physical Surface(\"S\")={1, 13, 17, 21, "
   "25, 26};\n",
   "error P3024: the surfaces are not plane: z runs from 0 to 1; the "
   "volumes of "
   "the file are in no group"},
  {"p.msh", MSH(SIDE, SQUARE, "4\n" TWO "7 1 2 2 1 1 2\n8 1 2 2 1 2 4\n"),
   "error P3030: 1 face(s) bound no element: 8 at (0.5, 0.5)"},
  {"q.msh", MSH(SIDE, "5\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 3 1 0\n",
                "3\n" TWO "7 1 2 2 1 3 5\n"),
   "error P3030: 1 face(s) bound no element: 7 at (2, 1)"},
  {"r.msh", MSH(SIDE, "5\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 .1 .9 0\n",
                "4\n" TWO "3 2 2 1 1 1 3 5\n7 1 2 2 1 1 3\n"),
   "error P3032: 1 face(s) have two elements on one side: 2 and 3 at (0.5, "
   "0.5)"},
  {"three.msh", MSH(BODY, "5\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 .1 .9 0\n",
                "3\n" TWO "3 2 2 1 1 1 3 5\n"),
   "error P3032: 1 face(s) have two elements on one side: 2 and 3 at (0.5, "
   "0.5)"},
  {"side.msh", MSH(BODY, "4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 1 1 0\n",
                   "2\n1 2 2 1 1 1 2 3\n2 2 2 1 1 1 4 2\n"),
   "error P3032: 1 face(s) have two elements on one side: 1 and 2 at (0.5, 0)"},
  {"side3.msh", MSH(BODY_3D, TETS, "2\n1 4 2 1 1 1 2 3 4\n2 4 2 1 1 1 2 3 5\n"),
   "error P3032: 1 face(s) have two elements on one side: 1 and 2 at "
   "(0.333333, 0.333333, 0)"},
  {"three3.msh", MSH(BODY_3D, TETS, "3\n1 4 2 1 1 1 2 3 4\n"
                     "2 4 2 1 1 1 2 3 6\n3 4 2 1 1 1 2 3 7\n"),
   "error P3032: 1 face(s) have two elements on one side: 2 and 3 at "
   "(0.333333, 0.333333, 0)"},
  {"over.msh", MSH(BODY, "5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 1 .1 0\n5 .1 1 0\n",
                   "2\n1 2 2 1 1 1 2 3\n2 2 2 1 1 1 4 5\n"),
   "error P3034: elements overlap: 1 and 2 at (0.333333, 0.333333)"},
  {"over3.msh", MSH(BODY_3D, "7\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n"
                    "5 1 .1 .1\n6 .1 1 .1\n7 .1 .1 1\n",
                    "2\n1 4 2 1 1 1 2 3 4\n2 4 2 1 1 1 5 6 7\n"),
   "error P3034: elements overlap: 2 and 1 at (0.3, 0.3, 0.3)"},
  {"in.msh", MSH(BODY, "6\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 .2 .2 0\n5 .4 .2 0\n"
                 "6 .2 .4 0\n", "2\n1 2 2 1 1 1 2 3\n2 2 2 1 1 4 5 6\n"),
   "error P3034: elements overlap: 1 and 2 at (0.333333, 0.333333)"},
  {"in3.msh", MSH(BODY_3D, "8\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n"
                  "5 .1 .1 .1\n6 .2 .1 .1\n7 .1 .2 .1\n8 .1 .1 .2\n",
                  "2\n1 4 2 1 1 1 2 3 4\n2 4 2 1 1 5 6 7 8\n"),
   "error P3034: elements overlap: 1 and 2 at (0.25, 0.25, 0.25)"},
  {"deep.msh", MSH(BODY, "9\n1 0 0 0\n2 9 0 0\n3 0 9 0\n4 2 2 0\n5 4 2 0\n"
                   "6 2 4 0\n7 2.5 2.5 0\n8 3 2.5 0\n9 2.5 3 0\n",
                   "8\n1 2 2 1 1 1 2 4\n2 2 2 1 1 2 5 4\n3 2 2 1 1 2 3 5\n"
                   "4 2 2 1 1 3 6 5\n5 2 2 1 1 3 1 6\n6 2 2 1 1 1 4 6\n"
                   "7 2 2 1 1 4 5 6\n8 2 2 1 1 7 8 9\n"),
   "error P3034: elements overlap: 7 and 8 at (2.66667, 2.66667)"},
  {"edges.msh", MSH(BODY_3D, "8\n1 -1 0 0\n2 1 0 0\n3 0 -1 -1\n4 0 1 -1\n"
                    "5 0 -1 -.8\n6 0 1 -.8\n7 -1 0 1\n8 1 0 1\n",
                    "2\n1 4 2 1 1 1 2 3 4\n2 4 2 1 1 5 6 7 8\n"),
   "error P3034: elements overlap: 1 and 2 at (0, 0, -0.5)"},
  {"twice.msh", MSH(BODY, SQUARE, "3\n" TWO "3 2 2 1 2 2 1 3\n"),
   "error P3028: 1 element(s) have the nodes of another one of their group: 1 "
   "and 3"},
  {"twice3.msh", MSH(BODY_3D, TETS,
                     "2\n1 4 2 1 1 1 2 3 4\n2 4 2 1 1 1 2 4 3\n"),
   "error P3028: 1 element(s) have the nodes of another one of their group: 1 "
   "and 2"},
  {"no.msh", MSH(BODY, SQUARE, "2\n2 2 2 1 1 1 2 3\n2 2 2 1 1 1 3 4\n"),
   "error P3029: 1 element(s) have the number of another one: 2"},
  {"face.msh", MSH(SIDE, SQUARE, "4\n" TWO "5 1 2 2 1 1 2\n5 1 2 2 1 2 3\n"),
   "error P3029: 1 face(s) have the number of another one: 5"},
  {"node.msh", MSH(BODY, "5\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n3 2 1 0\n",
                   "2\n" TWO),
   "error P3029: 1 node(s) have the number of another one: 3"},
  {"s.geo", PLATE "Point(9)={5,5,0}; Physical Point(\"P\")={9};"
   "Physical Surface(\"BODY\")={1};\n",
   "error P3033: physical point \"P\": 1 node(s) in no element of the mesh: 5"},
  {"t.msh", "$NOD\n1\n1 0 0 0\n$ENDNOD\n",
   "error P3002: \"%s\" is a mesh of version 1; 2.2 and 4.1 are read"},
  {"u.msh", "$MeshFormat\n5.3 0 8\n$EndMeshFormat\n",
   "error P3002: \"%s\" is a mesh of version 5.3; 2.2 and 4.1 are read"},
  {"v.msh", "solid cube\n",
   "error P3002: \"%s\" is no .geo and does not start with $MeshFormat"},
  {"w.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 0 0 0.5",
   "error P3006: mesh file %s:6: the file ends where $EndNodes (its nodes are "
   "complete) is expected"},
  {"y.msh", MSH(BODY, SQUARE, "2\n1 2 2 1 1 1 2 3\n2 2 2 1 1 1 3 77\n"),
   "error P3025: 1 corner(s) are missing: node 77 of element 2"},
  {"z.geo", "Point(1) = {0, 0;\n",
   "error P3003: mesh file \"%s\": gmsh fails to read the file: '%s', line 1: "
   "syntax error (;)"},
  {"half.geo", "Point(1) = {0, 0, 0};\nPoint(2) = {1, 0, 0}; Line(1) = {1, 2};",
   "error P3005: \"%s\" ends without a newline after several statements"},
  {"empty.geo", "", "error P3001: mesh file \"%s\" cannot be read: it is "
   "empty"},
};

static const bad_mesh remarks[] = {
  {"a.msh", MSH(BODY, SQUARE, "1\n1 2 2 1 1 1 2 3\n"),
   "note P3040: 1 node(s) of the file are in no element"},
  {"x.geo", PLATE "Warning(\"coarse\");\nPhysical Surface(\"BODY\")={1};\n",
   "warning P3004: gmsh warns: coarse"},
  {"b.msh", MSH(BODY, SQUARE, "3\n1 2 2 1 1 1 2 3\n2 2 2 0 2 1 3 4\n"
                "3 1 2 0 3 1 2\n"),
   "warning P3014: 1 element(s) in no physical group are left out"},
  {"c.msh", MSH(SIDE, SQUARE, "5\n" TWO "1 2 2 3 1 3 1 2\n4 1 2 2 1 1 2\n"
                "5 1 2 2 1 2 1\n"),
   "note P3026: 1 element(s) are listed more than once\n"
   "job.inp:4:1: note P3031: 1 face(s) are listed more than once"},
  {"d.msh", MSH(BODY, "5\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 1 1 0\n",
                "2\n1 2 2 1 1 1 2 3\n2 2 2 1 1 1 5 4\n"),
   "warning P3041: 1 node(s) lie on another node of the same body: 5 at (1, "
   "1)"},
  {"e.msh", MSH(BODY, "6\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 1 1 0\n"
                "5 1.00000000000001 0 0\n6 0 1 0\n",
                "2\n1 2 2 1 1 1 2 3\n2 2 2 1 1 4 5 6\n"),
   "warning P3042: 2 node(s) lie on a node of another body: "},
  {"f.msh", MSH("2\n2 1 \"BODY\"\n2 2 \"OTHER\"\n",
                "6\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 .2 .2 0\n5 .9 .2 0\n"
                "6 .2 .9 0\n",
                "2\n1 2 2 1 1 1 2 3\n2 2 2 2 1 4 5 6\n"),
   "warning P3043: elements of two bodies overlap: 1 and 2 at (0.333333, "
   "0.333333)"},
  /* one group, by less than an element: what curves do that touch */
  {"grazed.msh", MSH(BODY_3D, "8\n1 -1 0 0\n2 1 0 0\n3 0 -1 -1\n4 0 1 -1\n"
                    "5 0 -1 -.1\n6 0 1 -.1\n7 -1 0 1\n8 1 0 1\n",
                    "2\n1 4 2 1 1 1 2 3 4\n2 4 2 1 1 5 6 7 8\n"),
   "warning P3043: elements of two bodies overlap: 1 and 2 at (0, 0, "
   "-0.5)"},
  {"g.msh", MSH(BODY, "6\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 1 1 0\n5 .45 .5 0\n"
                "6 .5 .45 0\n",
                "2\n1 2 2 1 1 1 2 3\n2 2 2 1 1 4 5 6\n"),
   "warning P3043: elements of two bodies overlap: 1 and 2 at (0.333333, "
   "0.333333)"},
};
/* clang-format on */

static int count_descriptors(void) {
  int n = 0;
  DIR *folder = opendir("/proc/self/fd");
  ck_assert_ptr_nonnull(folder);
  while (readdir(folder) != NULL) ++n;
  closedir(folder);
  return n;
}

/* The text of a case with %s for the path of its file. */
static void expand(const char *text, const char *path, char *out, size_t size) {
  size_t n = 0;
  while (*text != '\0' && n + 1 < size) {
    if (strncmp(text, "%s", 2) != 0) {
      out[n++] = *text++;
      continue;
    }
    n += (size_t)snprintf(out + n, size - n, "%s", path);
    text += 2;
  }
  out[n] = '\0';
}

static void check_message(mesh_file *f, const bad_mesh *c) {
  char wanted[1024] = "job.inp:4:1: ";
  size_t n = strlen(wanted);
  expand(c->message, mesh_file_path(f, c->name), wanted + n, sizeof wanted - n);
  ck_assert_msg(strstr(f->messages, wanted) != NULL, "%s: wanted\n%s\ngot\n%s",
                c->name, wanted, f->messages);
}

START_TEST(every_error_has_its_text_and_no_mesh) {
  mesh_gmsh_load();
  mesh_file f;
  mesh_file_open(&f);
  size_t before = memory_in_use();
  int descriptors = count_descriptors();
  for (size_t i = 0; i < sizeof errors / sizeof *errors; ++i) {
    mesh *m = mesh_file_text(&f, errors[i].name, errors[i].text);
    check_message(&f, &errors[i]);
    ck_assert_msg(m == NULL && f.n_error == 1, "%s", f.messages);
    ck_assert_int_eq(f.answer,
                     strstr(f.messages, "P3001") ? ERR_FILE : ERR_MESH);
    ck_assert_uint_eq(memory_in_use(), before);
    ck_assert_int_eq(count_descriptors(), descriptors);
    ck_assert(waitpid(-1, NULL, WNOHANG) == -1 && errno == ECHILD);
  }
  mesh_file_close(&f);
}
END_TEST

START_TEST(every_remark_has_its_text_and_a_mesh) {
  mesh_gmsh_load();
  mesh_file f;
  mesh_file_open(&f);
  for (size_t i = 0; i < sizeof remarks / sizeof *remarks; ++i) {
    mesh *m = mesh_file_text(&f, remarks[i].name, remarks[i].text);
    check_message(&f, &remarks[i]);
    ck_assert_msg(m != NULL && f.n_error == 0, "%s", f.messages);
    mesh_free(m);
  }
  mesh_file_close(&f);
}
END_TEST

/* A sliver of aspect 1e4 is computed with in any unit, off the origin too;
 * one that is flat to rounding, of its edges or of its coordinates (1.2e-10
 * is the last bit of 1e6), is refused in any unit. */
START_TEST(flatness_has_no_unit) {
  static const struct {
    double y, height;
    int good;
  } cases[] = {{0, 1e-4, 1}, {0, 6e-13, 0}, {1e6, 1e-4, 1}, {1e6, 1.2e-10, 0}};
  mesh_file f;
  mesh_file_open(&f);
  for (int power = -40; power <= 40; power += 40)
    for (int k = 0; k < 4; ++k) {
      char text[1024];
      double unit =
          power < 0 ? 1.0 / (double)(1L << -power) : (double)(1L << power);
      double y = cases[k].y * unit, top = (cases[k].y + cases[k].height) * unit;
      ck_assert(top > y);
      snprintf(
          text, sizeof text,
          MSH(BODY, "3\n1 %.17g %.17g 0\n2 %.17g %.17g 0\n3 %.17g %.17g 0\n",
              "1\n1 2 2 1 1 1 2 3\n"),
          100 * unit, y, 101 * unit, y, 100.5 * unit, top);
      mesh *m = mesh_file_text(&f, "s.msh", text);
      ck_assert_msg((m != NULL) == cases[k].good, "2^%d, case %d: %s", power, k,
                    f.messages);
      ck_assert((strstr(f.messages, "P3022") == NULL) == cases[k].good);
      mesh_free(m);
    }
  mesh_file_close(&f);
}
END_TEST

/* A triangle on the line y = 0, the other below it but for a part of its width:
 * coordinates of few digits touch, more is an overlap. */
START_TEST(bodies_that_hardly_enter_each_other_touch) {
  static const double part[] = {0, 1e-9, 5e-7, 1e-5, 1e-3};
  mesh_file f;
  mesh_file_open(&f);
  for (int k = 0; k < 5; ++k) {
    char text[1024];
    snprintf(text, sizeof text,
             MSH(BODY,
                 "6\n1 0 0 0\n2 1 0 0\n3 0.5 1 0\n"
                 "4 0.1 %.17g 0\n5 0.5 -1 0\n6 0.9 %.17g 0\n",
                 "2\n1 2 2 1 1 1 2 3\n2 2 2 1 1 4 5 6\n"),
             part[k], part[k]);
    mesh *m = mesh_file_text(&f, "t.msh", text);
    const int told = strstr(f.messages, "overlap") != NULL;
    ck_assert_msg(told == (k > 2), "%g: %s", part[k], f.messages);
    mesh_free(m);
  }
  mesh_file_close(&f);
}
END_TEST

/* A triangle in an element of a square that has no side on its boundary. */
START_TEST(body_inside_of_another_is_seen) {
  mesh_file f;
  mesh_file_open(&f);
  mesh *m = mesh_file_text(
      &f, "t.msh",
      MSH(BODY,
          "11\n1 0 0 0\n2 3 0 0\n3 3 3 0\n4 0 3 0\n5 1 1 0\n6 2 1 0\n"
          "7 2 2 0\n8 1 2 0\n9 1.5 1.2 0\n10 1.7 1.2 0\n11 1.7 1.4 0\n",
          "11\n1 2 2 1 1 1 2 6\n2 2 2 1 1 1 6 5\n3 2 2 1 1 2 3 7\n"
          "4 2 2 1 1 2 7 6\n5 2 2 1 1 3 4 8\n6 2 2 1 1 3 8 7\n"
          "7 2 2 1 1 4 1 5\n8 2 2 1 1 4 5 8\n9 2 2 1 1 5 6 7\n"
          "10 2 2 1 1 5 7 8\n11 2 2 1 1 9 10 11\n"));
  ck_assert_ptr_nonnull(strstr(f.messages, "overlap"));
  mesh_free(m);
  mesh_file_close(&f);
}
END_TEST

/* Two slivers along a slanted line far from the origin, on both sides of it,
 * without common nodes. */
START_TEST(bodies_that_touch_do_not_overlap) {
  mesh_file f;
  mesh_file_open(&f);
  for (int k = 0; k < 24; ++k) {
    char text[1024];
    double a = 0.1 + k, c = cos(a), s = sin(a), far = k % 2 ? 1e6 : 0.0;
    double h = k % 2 ? 1e-3 : 1e-6;
    snprintf(text, sizeof text,
             MSH(BODY,
                 "6\n1 %.17g %.17g 0\n2 %.17g %.17g 0\n3 %.17g %.17g 0\n"
                 "4 %.17g %.17g 0\n5 %.17g %.17g 0\n6 %.17g %.17g 0\n",
                 "2\n1 2 2 1 1 1 2 3\n2 2 2 1 1 4 5 6\n"),
             far, far, far + c, far + s, far - h * s, far + h * c,
             far + 0.3 * c, far + 0.3 * s, far + 0.8 * c, far + 0.8 * s,
             far + h * s, far - h * c);
    mesh *m = mesh_file_text(&f, "t.msh", text);
    ck_assert_msg(m != NULL && strstr(f.messages, "P3034") == NULL, "%d: %s", k,
                  f.messages);
    mesh_free(m);
  }
  mesh_file_close(&f);
}
END_TEST

START_TEST(files_that_cannot_be_read_are_told) {
  mesh_file f;
  mesh_file_open(&f);
  mesh_file_read(&f, "missing.msh", 1.0, 0, NULL);
  ck_assert_int_eq(f.answer, ERR_FILE);
  ck_assert_ptr_nonnull(strstr(f.messages, "No such file or directory"));
  ck_assert_int_eq(mkdir(mesh_file_path(&f, "folder.geo"), 0700), 0);
  mesh_file_read(&f, "folder.geo", 1.0, 0, NULL);
  ck_assert_int_eq(f.answer, ERR_FILE);
  ck_assert_ptr_nonnull(strstr(f.messages, "it is a folder"));
  ck_assert_int_eq(mkfifo(mesh_file_path(&f, "pipe.msh"), 0600), 0);
  mesh_file_read(&f, "pipe.msh", 1.0, 0, NULL); /* must not wait for a writer */
  ck_assert_int_eq(f.answer, ERR_FILE);
  ck_assert_ptr_nonnull(strstr(f.messages, "it is no plain file"));
  if (geteuid() != 0) { /* the administrator may read everything */
    mesh_file_write(&f, "locked.msh", "x", 1);
    ck_assert_int_eq(chmod(mesh_file_path(&f, "locked.msh"), 0), 0);
    mesh_file_read(&f, "locked.msh", 1.0, 0, NULL);
    ck_assert_int_eq(f.answer, ERR_FILE);
    ck_assert_ptr_nonnull(strstr(f.messages, "Permission denied"));
  }
  mesh_file_close(&f);
}
END_TEST

static const char good_msh[] = MSH(BODY, SQUARE, "2\n" TWO);

/* gmsh reads nothing after a failure in the same process. */
START_TEST(good_file_is_read_after_bad_ones) {
  mesh_file f;
  mesh_file_open(&f);
  static const char *const bad[] = {
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\nrubbish\n$EndNodes\n",
      "$MeshFormat\n4.1 1 8\nrubbish\n$EndRubbish\n"};
  for (int i = 0; i < 2; ++i) {
    ck_assert_ptr_null(mesh_file_text(&f, "bad.msh", bad[i]));
    ck_assert_int_eq(f.answer, ERR_MESH);
    mesh *m = mesh_file_text(&f, "good.msh", good_msh);
    ck_assert_msg(m != NULL && m->n_elem == 2, "%s", f.messages);
    mesh_free(m);
  }
  mesh_file_close(&f);
}
END_TEST

/* SystemCall runs a shell below gmsh: its parent is the reader. */
START_TEST(reader_that_dies_is_told) {
  mesh_gmsh_load();
  static const struct {
    const char *geo, *text;
    status answer;
  } cases[] = {
      {"SystemCall \"kill -SEGV $PPID\";\n", "gmsh was ended by signal 11",
       ERR_MESH},
      {"Exit;\n", "gmsh ended by itself", ERR_MESH},
      {"Error(\"no h given\");\n", "gmsh fails to read the file: no h given",
       ERR_MESH},
      /* the surface is not closed: gmsh throws what nobody catches */
      {"Point(1)={0,0,0}; Point(2)={1,0,0}; Point(3)={1,1,0}; Line(1)={1,2};"
       "Line(2)={2,3}; Curve Loop(1)={1,2}; Plane Surface(1)={1};"
       "Physical Surface(1)={1};\n",
       "gmsh", ERR_MESH},
  };
  mesh_file f;
  mesh_file_open(&f);
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
  mesh_file_close(&f);
}
END_TEST

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
START_TEST(reader_dies_with_the_program) {
  mesh_file f;
  mesh_file_open(&f);
  char text[400], path[80];
  snprintf(path, sizeof path, "%s/pid", f.folder);
  snprintf(text, sizeof text,
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
  mesh_file_close(&f);
}
END_TEST

static void on_alarm(int signal) { (void)signal; }

/* Signals that the program handles must not break the reading, and what is
 * ignored by the program (SIGCHLD) must not lose the mesh. */
START_TEST(signals_do_not_disturb) {
  mesh_gmsh_load();
  mesh_file f;
  mesh_file_open(&f);
  struct sigaction often = {.sa_handler = on_alarm}; /* no SA_RESTART */
  ck_assert_int_eq(sigaction(SIGALRM, &often, NULL), 0);
  static const char wait_geo[] =
      "SystemCall \"sleep 0.3\";" PLATE "Physical Surface(1)={1};\n";
  ualarm(2000, 2000);
  mesh *m = mesh_file_text(&f, "w.geo", wait_geo);
  ualarm(0, 0);
  ck_assert_msg(m != NULL && m->n_elem > 0, "%s", f.messages);
  mesh_free(m);
  signal(SIGCHLD, SIG_IGN);
  m = mesh_file_text(&f, "w.geo", wait_geo);
  signal(SIGCHLD, SIG_DFL);
  ck_assert_msg(m != NULL && m->n_elem > 0, "%s", f.messages);
  mesh_free(m);
  mesh_file_close(&f);
}
END_TEST

/* With little address space libgmsh cannot be loaded, or runs out later. */
START_TEST(want_of_memory_in_gmsh_is_told) {
#if defined(__SANITIZE_ADDRESS__)
  return; /* it needs terabytes of addresses itself */
#endif
  mesh_file f;
  mesh_file_open(&f);
  static const char geo[] = PLATE
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
  mesh_file_close(&f);
}
END_TEST

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
START_TEST(want_of_memory_is_never_taken_for_a_bad_mesh) {
#if defined(__SANITIZE_ADDRESS__)
  return;
#endif
  char geo[192];
  mesh_file f;
  mesh_file_open(&f);
  write_square(&f, "large.msh", unit_whole() ? 400 : 200);
  snprintf(geo, sizeof geo, "Merge \"%s/large.msh\";\n", f.folder);
  mesh_file_write(&f, "large.geo", geo, strlen(geo));
  struct rlimit old;
  getrlimit(RLIMIT_AS, &old);
  int in_gmsh = 0;
  status answer = ERR_MEMORY;
  for (rlim_t mb = 80; answer == ERR_MEMORY && mb < 2000;
       mb += unit_whole() ? 25 : 10) {
    struct rlimit less = {mb << 20, old.rlim_max};
    ck_assert_int_eq(setrlimit(RLIMIT_AS, &less), 0);
    mesh *m = mesh_file_read(&f, "large.geo", 1.0, 0, NULL);
    setrlimit(RLIMIT_AS, &old);
    answer = f.answer;
    in_gmsh += strstr(status_message(), "gmsh ran out of memory") != NULL;
    ck_assert_msg(answer == OK || answer == ERR_MEMORY, "%d MB: %s", (int)mb,
                  f.messages);
    mesh_free(m);
  }
  ck_assert_int_eq(answer, OK);
  ck_assert_int_gt(in_gmsh, 0);
  mesh_file_close(&f);
}
END_TEST

/* What gmsh prints does not reach the user. */
START_TEST(nothing_is_printed) {
  mesh_gmsh_load();
  mesh_file f;
  mesh_file_open(&f);
  fflush(NULL);
  int out = dup(1), err = dup(2);
  FILE *log = tmpfile();
  dup2(fileno(log), 1);
  dup2(fileno(log), 2);
  printf("mine"); /* buffered: must come out once */
  mesh_file_text(&f, "e.geo", "Printf(\"hello\"); Error(\"bad\"); Exit;\n");
  mesh *m = mesh_file_text(&f, "g.geo", PLATE "Physical Surface(1)={1};\n");
  fflush(NULL);
  dup2(out, 1);
  dup2(err, 2);
  rewind(log);
  char text[64] = "";
  size_t n = fread(text, 1, sizeof text - 1, log);
  ck_assert_uint_eq(n, 4);
  ck_assert_str_eq(text, "mine");
  mesh_free(m);
  fclose(log);
  close(out);
  close(err);
  mesh_file_close(&f);
}
END_TEST

/* Options files of the .geo or in the home, and the environment, have no
 * effect; the home is left as it is. */
START_TEST(geometry_alone_makes_the_mesh) {
  static const char *const hidden[] = {"g.geo.opt", ".gmshrc", ".gmsh-options"};
  mesh_file f;
  mesh_file_open(&f);
  char text[256], home[256], ran[192];
  snprintf(ran, sizeof ran, "%s", mesh_file_path(&f, "ran"));
  snprintf(text, sizeof text,
           "Mesh.ElementOrder = 2; SystemCall \"touch %s\";\n", ran);
  for (int i = 0; i < 3; ++i)
    mesh_file_write(&f, hidden[i], text, strlen(text));
  snprintf(home, sizeof home, "%s", getenv("HOME") ? getenv("HOME") : "/");
  ck_assert_int_eq(setenv("HOME", f.folder, 1), 0);
  mesh *m = mesh_file_text(
      &f, "g.geo",
      PLATE
      "Physical Surface(1)={1};\n"
      "If (StrFind(GetEnv(\"HOME\"), \"protis\")) Error(\"home\"); EndIf\n");
  setenv("HOME", home, 1);
  ck_assert_msg(m != NULL && f.messages[0] == '\0', "%s", f.messages);
  mesh_free(m);
  ck_assert_int_ne(access(ran, F_OK), 0);
  int n = 0;
  DIR *folder = opendir(f.folder);
  while (readdir(folder) != NULL) ++n;
  closedir(folder);
  ck_assert_int_eq(n, 2 + 3 + 1); /* what was written above */
  mesh_file_close(&f);
}
END_TEST

/* gmsh executes the options files of merged files, however they are named. */
START_TEST(options_of_merged_files_are_refused) {
  mesh_gmsh_load();
  static const char *const ways[] = {"Include \"in.geo\";", "Merge \"in.geo\";",
                                     "Merge StrCat(\"in\", \".geo\");"};
  mesh_file f;
  mesh_file_open(&f);
  mesh_file_write(&f, "in.geo", PLATE, strlen(PLATE));
  mesh_file_write(&f, "in.geo.opt", "Mesh.ElementOrder = 2;\n", 23);
  for (int i = 0; i < 3; ++i) {
    char text[256];
    snprintf(text, sizeof text, "%s\nPhysical Surface(1)={1};\n", ways[i]);
    mesh *m = mesh_file_text(&f, "g.geo", text);
    ck_assert_msg((m != NULL) == (i == 0), "%s", f.messages);
    ck_assert_int_eq(strstr(f.messages, "options file of gmsh") != NULL, i > 0);
    mesh_free(m);
  }
  mesh_file_close(&f);
}
END_TEST

/* Pipes do not take the place of standard streams. */
START_TEST(closed_streams_do_not_disturb) {
  mesh_file f;
  mesh_file_open(&f);
  int kept[3];
  for (int i = 0; i < 3; ++i) {
    kept[i] = dup(i);
    close(i);
  }
  mesh *m = mesh_file_text(&f, "g.geo", PLATE "Physical Surface(1)={1};\n");
  for (int i = 0; i < 3; ++i) {
    dup2(kept[i], i);
    close(kept[i]);
  }
  ck_assert_msg(m != NULL && m->n_elem > 0, "%s", f.messages);
  mesh_free(m);
  mesh_file_close(&f);
}
END_TEST

static char left_behind[192];

static void leave_a_file(void) {
  FILE *out = fopen(left_behind, "w");
  if (out != NULL) fclose(out);
}

/* Handlers of the program belong to the program, also if gmsh calls exit. */
START_TEST(exit_of_gmsh_runs_no_handler_of_the_program) {
  mesh_file f;
  mesh_file_open(&f);
  snprintf(left_behind, sizeof left_behind, "%s", mesh_file_path(&f, "left"));
  ck_assert_int_eq(atexit(leave_a_file), 0);
  ck_assert_ptr_null(mesh_file_text(&f, "exit.geo", "Exit;\n"));
  ck_assert_int_ne(access(left_behind, F_OK), 0);
  mesh_file_close(&f);
}
END_TEST

/* Records that are none, do not fit or stop: refused, nothing is kept. */
START_TEST(rubbish_from_the_reader_is_refused) {
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
    ck_assert_int_eq(stopped, n == 3); /* the last one is cut off */
    raw_free(&raw);
    close(ends[0]);
    ck_assert_uint_eq(memory_in_use(), before);
  }
}
END_TEST

/* What gmsh itself would not let through: the builder checks it again. */
START_TEST(builder_trusts_nothing) {
  size_t node_no[3] = {1, 2, 3}, elem_no = 7, node[3] = {1, 2, 99};
  double xyz[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  char name[] = "BODY", type[] = "Triangle 3";
  int physical = 1;
  raw_block block = {2, 2, type, 1, &physical, 1, 3, &elem_no, node};
  raw_group group = {2, 1, name};
  raw_mesh raw = {.n_node = 3,
                  .node_no = node_no,
                  .xyz = xyz,
                  .n_block = 1,
                  .n_group = 1,
                  .block = &block,
                  .group = &group};
  for (int i = 0; i < 2; ++i) {
    message_log *log;
    mesh *m;
    char text[256] = "";
    if (i == 1) block.n = (size_t)1 << 40;
    ck_assert_int_eq(message_log_new(&log), OK);
    ck_assert_int_eq(build_mesh(&raw, 1.0, NULL, log, &m), ERR_MESH);
    FILE *out = fmemopen(text, sizeof text - 1, "w");
    message_print(log, out);
    fclose(out);
    ck_assert_msg(
        strncmp(text,
                i == 0 ? "error P3025: 1 corner(s) are missing: node 99 "
                         "of element 7"
                       : "error P3027: 3 nodes, 1099511627776 elements, 0 "
                         "faces",
                40) == 0,
        "%s", text);
    message_log_free(log);
  }
}
END_TEST

UNIT_MAIN("mesh_errors", every_error_has_its_text_and_no_mesh,
          every_remark_has_its_text_and_a_mesh, flatness_has_no_unit,
          bodies_that_touch_do_not_overlap,
          bodies_that_hardly_enter_each_other_touch,
          body_inside_of_another_is_seen, files_that_cannot_be_read_are_told,
          good_file_is_read_after_bad_ones, reader_that_dies_is_told,
          reader_dies_with_the_program, signals_do_not_disturb,
          want_of_memory_in_gmsh_is_told,
          want_of_memory_is_never_taken_for_a_bad_mesh, nothing_is_printed,
          geometry_alone_makes_the_mesh, options_of_merged_files_are_refused,
          closed_streams_do_not_disturb,
          exit_of_gmsh_runs_no_handler_of_the_program,
          rubbish_from_the_reader_is_refused, builder_trusts_nothing)
