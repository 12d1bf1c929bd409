/* src/mesh: what is wrong with a mesh or its file, and how it is told */
#include "mesh/raw.h"
#include "support/mesh_file.h"
#include "support/unit.h"

#include <dirent.h>
#include <errno.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#define SIDE "2\n1 2 \"SIDE\"\n2 1 \"BODY\"\n"
#define BODY_3D "1\n3 1 \"BODY\"\n"
/* Above and below the triangle 1 2 3. */
#define TETS \
  "7\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n6 0 0 -1\n7 1 1 -1\n"

typedef struct bad_mesh {
  const char *name, *text;
  const char *message; /* after "job.inp:4:1: "                            */
} bad_mesh;

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
  {"thrice.msh", MSH(BODY, SQUARE, "4\n" TWO "3 2 2 2 1 2 3 1\n"
                     "4 2 2 1 1 3 1 2\n"),
   "error P3028: 1 element(s) have the nodes of another one of their group: 1 "
   "and 4"},
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

TEST(every_error_has_its_text_and_no_mesh) {
  mesh_gmsh_load();
  MESH_FILE f = mesh_file_open();
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
}

TEST(every_remark_has_its_text_and_a_mesh) {
  mesh_gmsh_load();
  MESH_FILE f = mesh_file_open();
  for (size_t i = 0; i < sizeof remarks / sizeof *remarks; ++i) {
    OWNED mesh *m = mesh_file_text(&f, remarks[i].name, remarks[i].text);
    check_message(&f, &remarks[i]);
    ck_assert_msg(m != NULL && f.n_error == 0, "%s", f.messages);
  }
}

/* A sliver of aspect 1e4 is computed with in any unit, off the origin too;
 * one that is flat to rounding, of its edges or of its coordinates (1.2e-10
 * is the last bit of 1e6), is refused in any unit. */
TEST(flatness_has_no_unit) {
  static const struct {
    double y, height;
    int good;
  } cases[] = {{0, 1e-4, 1},
               {0, 6e-13, 0},
               {1e6, 1e-4, 1},
               {1e6, 1.2e-10, 0},
               {-1e6, 1.2e-10, 0}};
  MESH_FILE f = mesh_file_open();
  for (int power = -40; power <= 40; power += 40)
    for (int k = 0; k < 5; ++k) {
      double unit =
          power < 0 ? 1.0 / (double)(1L << -power) : (double)(1L << power);
      double y = cases[k].y * unit, top = (cases[k].y + cases[k].height) * unit;
      ck_assert(top > y);
      PRINTED(
          text,
          MSH(BODY, "3\n1 %.17g %.17g 0\n2 %.17g %.17g 0\n3 %.17g %.17g 0\n",
              "1\n1 2 2 1 1 1 2 3\n"),
          100 * unit, y, 101 * unit, y, 100.5 * unit, top);
      OWNED mesh *m = mesh_file_text(&f, "s.msh", text);
      ck_assert_msg((m != NULL) == cases[k].good, "2^%d, case %d: %s", power, k,
                    f.messages);
      ck_assert((strstr(f.messages, "P3022") == NULL) == cases[k].good);
    }
}

/* A triangle on the line y = 0, the other below it but for a part of its width:
 * coordinates of few digits touch, more is an overlap. */
TEST(bodies_that_hardly_enter_each_other_touch) {
  static const double part[] = {0, 1e-9, 5e-7, 1e-5, 1e-3};
  MESH_FILE f = mesh_file_open();
  for (int k = 0; k < 5; ++k) {
    PRINTED(text,
            MSH(BODY,
                "6\n1 0 0 0\n2 1 0 0\n3 0.5 1 0\n"
                "4 0.1 %.17g 0\n5 0.5 -1 0\n6 0.9 %.17g 0\n",
                "2\n1 2 2 1 1 1 2 3\n2 2 2 1 1 4 5 6\n"),
            part[k], part[k]);
    OWNED mesh *m = mesh_file_text(&f, "t.msh", text);
    const int told = strstr(f.messages, "overlap") != NULL;
    ck_assert_msg(told == (k > 2), "%g: %s", part[k], f.messages);
  }
}

/* Only the plane of two edges that cross, or of one side below a corner, is
 * between them; oblique, so that their boxes overlap; pushed into each other.
 */
TEST(tetrahedra_apart_by_one_plane_alone) {
  static const double below[2][4][3] = {
      {{-1, 0, 0}, {1, 0, 0}, {0, -1, -1}, {0, 1, -1}},
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}}};
  static const double above[2][4][3] = {
      {{0, -1, 0}, {0, 1, 0}, {-1, 0, 1}, {1, 0, 1}},
      {{0.25, 0.25, 0}, {0.2, 0.2, 5}, {0.3, 0.2, 5.7}, {0.2, 0.3, 6.1}}};
  MESH_FILE f = mesh_file_open();
  for (int k = 0; k < 4; ++k) {
    char nodes[800] = "8\n";
    for (int i = 0; i < 8; ++i) {
      const double *x = i < 4 ? below[k / 2][i] : above[k / 2][i - 4];
      const double lift = i < 4 ? 0 : k % 2 ? -0.01 : 0.01;
      sprintf(nodes + strlen(nodes), "%d %.17g %.17g %.17g\n", i + 1, x[0],
              x[1], x[2] + lift + 0.5 * x[0] + 0.5 * x[1]);
    }
    PRINTED(text,
            MSH(BODY_3D, "%s", "2\n1 4 2 1 1 1 2 3 4\n2 4 2 1 1 5 6 7 8\n"),
            nodes);
    OWNED mesh *m = mesh_file_text(&f, "t.msh", text);
    ck_assert_msg((strstr(f.messages, "overlap") != NULL) == k % 2, "%d: %s", k,
                  f.messages);
  }
}

/* A triangle in an element of a square that has no side on its boundary. */
TEST(body_inside_of_another_is_seen) {
  MESH_FILE f = mesh_file_open();
  OWNED mesh *m = mesh_file_text(
      &f, "t.msh",
      MSH(BODY,
          "11\n1 0 0 0\n2 3 0 0\n3 3 3 0\n4 0 3 0\n5 1 1 0\n6 2 1 0\n"
          "7 2 2 0\n8 1 2 0\n9 1.5 1.2 0\n10 1.7 1.2 0\n11 1.7 1.4 0\n",
          "11\n1 2 2 1 1 1 2 6\n2 2 2 1 1 1 6 5\n3 2 2 1 1 2 3 7\n"
          "4 2 2 1 1 2 7 6\n5 2 2 1 1 3 4 8\n6 2 2 1 1 3 8 7\n"
          "7 2 2 1 1 4 1 5\n8 2 2 1 1 4 5 8\n9 2 2 1 1 5 6 7\n"
          "10 2 2 1 1 5 7 8\n11 2 2 1 1 9 10 11\n"));
  ck_assert_ptr_nonnull(strstr(f.messages, "overlap"));
}

/* Two slivers along a slanted line far from the origin, on both sides of it,
 * without common nodes. */
TEST(bodies_that_touch_do_not_overlap) {
  MESH_FILE f = mesh_file_open();
  for (int k = 0; k < 24; ++k) {
    double a = 0.1 + k, c = cos(a), s = sin(a), far = k % 2 ? 1e6 : 0.0;
    double h = k % 2 ? 1e-5 : 1e-6, up = k % 4 == 3 ? 0.0 : far;
    PRINTED(text,
            MSH(BODY,
                "6\n1 %.17g %.17g 0\n2 %.17g %.17g 0\n3 %.17g %.17g 0\n"
                "4 %.17g %.17g 0\n5 %.17g %.17g 0\n6 %.17g %.17g 0\n",
                "2\n1 2 2 1 1 1 2 3\n2 2 2 1 1 4 5 6\n"),
            far, up, far + c, up + s, far - h * s, up + h * c, far + 0.3 * c,
            up + 0.3 * s, far + 0.8 * c, up + 0.8 * s, far + h * s, up - h * c);
    OWNED mesh *m = mesh_file_text(&f, "t.msh", text);
    ck_assert_msg(m != NULL && strstr(f.messages, "overlap") == NULL, "%d: %s",
                  k, f.messages);
  }
}

TEST(files_that_cannot_be_read_are_told) {
  MESH_FILE f = mesh_file_open();
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
}

/* What gmsh itself would not let through: the builder checks it again. */
TEST(builder_trusts_nothing) {
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
    OWNED message_log *log = NULL;
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
  }
}

UNIT_MAIN("mesh_errors")
