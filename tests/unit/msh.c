/* src/mesh: the reader of .msh files takes what the format says and no more */
#include "mesh/msh/raw_mesh.h"
#include "mesh/msh/scan.h"
#include "support/mesh_file.h"
#include "support/unit.h"

/* A unit square of two triangles, its lower side and a corner, twice. */
static const char text_22[] =
    MSH("3\n0 3 \"P\"\n1 2 \"SIDE\"\n2 1 \"BODY\"\n",
        "4\n1 0 0 0\n2 1. 0e0 0\n3 1.0E+00 1 0\n4 -0 1 0\n",
        "4\n7 2 2 1 5 1 2 3\n8 2 2 1 5 1 3 4\n9 1 2 2 6 1 2\n10 15 2 3 1 1\n");
static const char text_41[] =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
    "$PhysicalNames\n3\n0 3 \"P\"\n1 2 \"SIDE\"\n2 1 \"BODY\"\n"
    "$EndPhysicalNames\n"
    "$Entities\n1 1 1 0\n1 0 0 0 1 3\n6 0 0 0 1 0 0 1 -2 0\n"
    "5 0 0 0 1 1 0 1 1 1 6\n$EndEntities\n"
    "$Nodes\n3 4 1 4\n0 1 1 1\n1\n0 0 0\n1 6 1 1\n2\n1 0 0 .5\n2 5 1 2\n3\n4\n"
    "1 1 0 .5 .5\n0 1 0 .5 .5\n$EndNodes\n"
    "$Elements\n3 4 7 10\n2 5 2 2\n7 1 2 3\n8 1 3 4\n1 6 1 1\n9 1 2\n"
    "0 1 15 1\n10 1\n$EndElements\n";
static const char *const texts[] = {text_22, text_41};

/* ---- binary files, in either order of bytes -------------------------------
 */

typedef struct bytes {
  char data[4096];
  size_t n;
  int swap;
} bytes;

static void put(bytes *b, const void *from, size_t size) {
  const char *p = from;
  for (size_t i = 0; i < size; ++i)
    b->data[b->n++] = p[b->swap ? size - 1 - i : i];
}

static void put_text(bytes *b, const char *text) {
  memcpy(b->data + b->n, text, strlen(text));
  b->n += strlen(text);
}

static void put_ints(bytes *b, int n, const int32_t *v) {
  for (int i = 0; i < n; ++i) put(b, &v[i], sizeof v[i]);
}

static void put_sizes(bytes *b, int n, const uint64_t *v) {
  for (int i = 0; i < n; ++i) put(b, &v[i], sizeof v[i]);
}

static void put_reals(bytes *b, int n, const double *v) {
  for (int i = 0; i < n; ++i) put(b, &v[i], sizeof v[i]);
}

#define INTS(...)                                                        \
  put_ints(b, (int)(sizeof((int32_t[]){__VA_ARGS__}) / sizeof(int32_t)), \
           (const int32_t[]){__VA_ARGS__})
#define SIZES(...)                                                          \
  put_sizes(b, (int)(sizeof((uint64_t[]){__VA_ARGS__}) / sizeof(uint64_t)), \
            (const uint64_t[]){__VA_ARGS__})
#define DOUBLES(...)                                                    \
  put_reals(b, (int)(sizeof((double[]){__VA_ARGS__}) / sizeof(double)), \
            (const double[]){__VA_ARGS__})

static const char names[] =
    "$PhysicalNames\n3\n0 3 \"P\"\n1 2 \"SIDE\"\n2 1 \"BODY\"\n"
    "$EndPhysicalNames\n";

static void binary_22(bytes *b) {
  put_text(b, "$MeshFormat\n2.2 1 8\n");
  INTS(1);
  put_text(b, "\n$EndMeshFormat\n");
  put_text(b, names);
  put_text(b, "$Nodes\n4\n");
  for (int i = 0; i < 4; ++i) {
    INTS(i + 1);
    DOUBLES(i == 1 || i == 2, i > 1, 0.0);
  }
  put_text(b, "\n$EndNodes\n$Elements\n4\n");
  INTS(2, 2, 2, 7, 1, 5, 1, 2, 3, 8, 1, 5, 1, 3, 4);
  INTS(1, 1, 2, 9, 2, 6, 1, 2);
  INTS(15, 1, 2, 10, 3, 1, 1);
  put_text(b, "\n$EndElements\n");
}

static void binary_41(bytes *b) {
  put_text(b, "$MeshFormat\n4.1 1 8\n");
  INTS(1);
  put_text(b, "\n$EndMeshFormat\n");
  put_text(b, names);
  put_text(b, "$Entities\n");
  SIZES(1, 1, 1, 0);
  INTS(1);
  DOUBLES(0.0, 0.0, 0.0);
  SIZES(1);
  INTS(3, 6);
  DOUBLES(0.0, 0.0, 0.0, 1.0, 0.0, 0.0);
  SIZES(1);
  INTS(-2);
  SIZES(0);
  INTS(5);
  DOUBLES(0.0, 0.0, 0.0, 1.0, 1.0, 0.0);
  SIZES(1);
  INTS(1);
  SIZES(1);
  INTS(6);
  put_text(b, "\n$EndEntities\n$Nodes\n");
  SIZES(1, 4, 1, 4);
  INTS(2, 5, 0);
  SIZES(4, 1, 2, 3, 4);
  DOUBLES(0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0);
  put_text(b, "\n$EndNodes\n$Elements\n");
  SIZES(3, 4, 7, 10);
  INTS(2, 5, 2);
  SIZES(2, 7, 1, 2, 3, 8, 1, 3, 4);
  INTS(1, 6, 1);
  SIZES(1, 9, 1, 2);
  INTS(0, 1, 15);
  SIZES(1, 10, 1);
  put_text(b, "\n$EndElements\n");
}

/* All six as bytes: two texts, each version in both orders. */
static void variant(int i, bytes *b) {
  memset(b, 0, sizeof *b);
  b->swap = i % 2;
  if (i < 2) {
    b->swap = 0;
    put_text(b, texts[i]);
  } else if (i < 4) {
    binary_22(b);
  } else {
    binary_41(b);
  }
}

TEST(all_variants_give_the_same_mesh) {
  MESH_FILE f = mesh_file_open();
  bytes b;
  OWNED mesh *first = NULL;
  const char *what;
  for (int i = 0; i < 6; ++i) {
    variant(i, &b);
    mesh_file_write(&f, "v.msh", b.data, b.n);
    mesh *m = mesh_file_read(&f, "v.msh", 1.0, 0, NULL);
    ck_assert_msg(m != NULL, "%d: %s", i, f.messages);
    ck_assert_int_eq(m->n_elem, 2);
    ck_assert_int_eq(m->n_face, 1);
    ck_assert_uint_eq(m->elem_no[0] + m->elem_no[1], 7 + 8);
    if (first == NULL) first = m;
    ck_assert_msg(mesh_same(first, m, 0.0, &what), "%d: %s", i, what);
    if (m != first) memory_free(m);
  }
}

/* The last byte is a newline, the only one that may be lost. */
TEST(file_cut_anywhere_is_refused) {
  MESH_FILE f = mesh_file_open();
  bytes b;
  for (int i = 0; i < 6; ++i) {
    variant(i, &b);
    for (size_t cut = 1; cut + 1 < b.n; ++cut) {
      mesh_file_write(&f, "cut.msh", b.data, cut);
      mesh *m = mesh_file_read(&f, "cut.msh", 1.0, 0, NULL);
      ck_assert_msg(m == NULL && f.answer == ERR_MESH, "%d: byte %zu: %s", i,
                    cut, f.messages);
    }
  }
}

/* Each line left out, then each twice; and each word in the last lines of the
 * nodes shortened to nothing by its line. */
TEST(file_without_a_line_or_with_one_twice_is_refused) {
  MESH_FILE f = mesh_file_open();
  for (int i = 0; i < 2; ++i)
    for (const char *p = texts[i], *q; *p != '\0'; p = q) {
      char text[2048];
      q = strchr(p, '\n') + 1;
      for (int twice = 0; twice < 2; ++twice) {
        snprintf(text, sizeof text, "%.*s%s", (int)(p - texts[i]), texts[i], q);
        if (twice)
          snprintf(text, sizeof text, "%.*s%s", (int)(q - texts[i]), texts[i],
                   p);
        ck_assert_msg(mesh_file_text(&f, "line.msh", text) == NULL &&
                          f.answer == ERR_MESH,
                      "%d: %d: %.*s", i, twice, (int)(q - p), p);
      }
    }
}

/* Each word in the place of every number of the file: no large block of
 * memory, whatever it says. */
TEST(counts_are_compared_with_the_file_first) {
  static const char *const word[] = {"999999999", "2305843009213693952",
                                     "9223372036854775807", "-1", "1e9"};
  MESH_FILE f = mesh_file_open();
  for (int i = 0; i < 2; ++i)
    for (size_t at = 0; texts[i][at] != '\0'; ++at) {
      if (at == 0 || strchr(" \n", texts[i][at - 1]) == NULL) continue;
      size_t n = strcspn(texts[i] + at, " \n");
      for (size_t k = 0; k < sizeof word / sizeof *word; ++k) {
        PRINTED(text, "%.*s%s%s", (int)at, texts[i], word[k],
                texts[i] + at + n);
        size_t before = memory_allocated();
        memory_free(mesh_file_text(&f, "n.msh", text));
        ck_assert_msg(memory_allocated() - before < 200000, "%s", text);
      }
    }
}

/* Each byte of the binary files with all bits turned, likewise. */
TEST(damaged_bytes_take_no_memory) {
  MESH_FILE f = mesh_file_open();
  bytes b;
  for (int i = 2; i < 6; ++i) {
    variant(i, &b);
    for (size_t at = 0; at < b.n; ++at) {
      b.data[at] = (char)~b.data[at];
      size_t before = memory_allocated();
      mesh_file_write(&f, "bits.msh", b.data, b.n);
      memory_free(mesh_file_read(&f, "bits.msh", 1.0, 0, NULL));
      ck_assert_uint_lt(memory_allocated() - before, 200000);
      b.data[at] = (char)~b.data[at];
    }
  }
}

/* clang-format off */
#define DIGITS_40 "1234567890123456789012345678901234567890"
static const struct { const char *from, *to, *message; } damages[] = {
  {"4\n1 0 0 0", "5\n1 0 0 0", ":16: \"$EndNodes\" where a whole number"},
  {"4\n1 0 0 0", "3\n1 0 0 0", ":15: \"4\" where $EndNodes"},
  {"4\n7 2", "3\n7 2", ":22: \"10\" where $EndElements"},
  {"1 0 0 0", "1 0 0", ":12: the line ends where a number is expected"},
  {"1 0 0 0", "1 0 0 0 0", ":12: \"0\" where the end of the line is expected"},
  {"1 0 0 0", "1 0 0 0x1", ":12: \"0x1\" where a number is expected"},
  {"1 0 0 0", "1 0 0 1e", ":12: \"1e\" where a number is expected"},
  {"1 0 0 0", "1 0 0 1,5", ":12: \"1,5\" where a number is expected"},
  {"1 0 0 0", "1 0 0 1.5+3", ":12: \"1.5+3\" where a number is expected"},
  {"1 0 0 0", "1 0 0 " DIGITS_40 DIGITS_40 DIGITS_40 "12345678",
   ":12: \"123456789012345678901234\" where a number of fewer digits"},
  {"1 0 0 0", "1.0 0 0 0", ":12: \"1.0\" where a whole number"},
  {"1 0 0 0", "0 0 0 0", ":12: a number is not above zero"},
  {"4\n1 0 0 0", "1000000000000000000\n1 0 0 0",
   ":11: \"1000000000000000000\" where a whole number of at most 18 digits"},
  {"7 2 2 1", "7 2 2 3000000000",
   ":19: \"3000000000\" where a whole number up to 2147483647"},
  {"1 0 0 0", "-1 0 0 0", ":12: \"-1\" where a whole number not below zero"},
  {"1 0 0 0", "1 0 0 \033[2J", ":12: \"?[2J\" where a number is expected"},
  /* \001: a zero byte. */
  {"1 0 0 0", "1 0 0 0\001", ":12: a zero byte where the end of the line is"},
  {"1 0 0 0", "1 0 \0010 0", ":12: a zero byte where a number is expected"},
  {"2 1 \"BODY\"", "1 2 \"BODY\"", ":8: the group 2 of dimension 1 is named"},
  {"2 1 \"BODY\"", "2 1 \"BODY", ":8: a name has no end"},
  {"7 2 2 1 5 1 2 3", "7 2 2 1 5 1 2", ":19: the line ends where a whole"},
  {"7 2 2", "7 99 2", ":19: elements of type 99 are not known"},
  {"7 2 2", "7 2 -2", ":19: a number of tags below zero"},
  {"$EndNodes\n", "$EndNodes\n$Nodes\n0\n$EndNodes\n",
   ":18: $Nodes is given twice"},
  {"$Nodes", "SystemCall \"id\";\n$Nodes", ":10: \"SystemCall\" where $ and"},
  {"$Nodes", "$Other\n1 2\n$Nodes", ":11: $Other has no $EndOther"},
  {"2.2 0 8", "2.2 0 4", ":3: $MeshFormat has file type 0, data size 4"},
  {"2.2 0 8", "2.2 7 8", ": byte 20: $MeshFormat has file type 7, data size 8"},
  {"$MeshFormat", "$Other\n$MeshFormat",
   ":2: $MeshFormat is to stand before $Other"},
  /* Version 4.1. */
  {"1 1 1 0\n1 0 0 0 1 3\n", "2 1 1 0\n1 0 0 0 1 3\n1 0 0 0 1 3\n",
   ":14: the entity 1 of dimension 0 is listed twice"},
  {"0 1 3\n6", "0 1 0\n6", ":12: a group has the number 0"},
  {"10 1\n$EndElements\n", "10 1\n$EndElements\n$PartitionedEntities\n",
   ":41: entities are to stand before $Elements"},
  {"3 4 1 4", "3 4 1 3", ":26: number 4 is outside of 1 to 3, the limits of"},
  {"2 5 2 2", "2 5 1 2",
   ":33: elements \"Line 2\" on an entity of dimension 2"},
  {"2 5 2 2", "2 6 2 2", ":33: elements lie on the entity 6 of dimension 2, "
   "which $Entities does not list"},
  {"2 5 2 2", "4 5 2 2", ":32: a block of dimension 4"},
  {"2 5 2 2", "2 5 2 5", ":32: a block of 5 where 4 of the section are left"},
  {"3 4 7 10", "3 5 7 10", ":39: the blocks of the section lack 1 of the "
   "elements that its first line says"},
};
/* clang-format on */

TEST(damage_is_told_with_its_line) {
  MESH_FILE f = mesh_file_open();
  for (size_t i = 0; i < sizeof damages / sizeof *damages; ++i) {
    const char *whole = text_22, *at = strstr(whole, damages[i].from);
    if (at == NULL) at = strstr(whole = text_41, damages[i].from);
    ck_assert_ptr_nonnull(at);
    PRINTED(text, "%.*s%s%s", (int)(at - whole), whole, damages[i].to,
            at + strlen(damages[i].from));
    const size_t n = strlen(text);
    for (char *c = text; (c = strchr(c, 1)) != NULL;) *c = '\0';
    mesh_file_write(&f, "d.msh", text, n);
    ck_assert_ptr_null(mesh_file_read(&f, "d.msh", 1.0, 0, NULL));
    PRINTED(wanted, "P3006: mesh file %s%s", mesh_file_path(&f, "d.msh"),
            damages[i].message);
    ck_assert_msg(strstr(f.messages, wanted) != NULL, "wanted %s\ngot %s",
                  wanted, f.messages);
  }
}

/* Other sections, CRLF, comments, empty lines, blanks and a byte order mark
 * change nothing. */
TEST(what_is_no_mesh_is_passed_over) {
  MESH_FILE f = mesh_file_open();
  char text[4096];
  int n = snprintf(text, sizeof text,
                   "\xEF\xBB\xBF$Comments\n$Nodes are below\n$EndComments\n\n%s"
                   "$Periodic\n1\n0 2 1\n1\n4 1\n$EndPeriodic\n"
                   "$NodeData\n1\n\"T\"\n$EndNodeData\n\n \n",
                   text_22);
  char crlf[8192];
  int k = 0;
  for (int i = 0; i < n; ++i) {
    if (text[i] == '\n') crlf[k++] = '\r';
    crlf[k++] = text[i];
  }
  OWNED mesh *plain = mesh_file_text(&f, "plain.msh", text_22);
  OWNED mesh *m = mesh_file_text(&f, "other.msh", text);
  ck_assert_msg(m != NULL && f.messages[0] == '\0', "%s", f.messages);
  mesh_file_write(&f, "crlf.msh", crlf, (size_t)k);
  OWNED mesh *dos = mesh_file_read(&f, "crlf.msh", 1.0, 0, NULL);
  ck_assert_msg(dos != NULL && f.messages[0] == '\0', "%s", f.messages);
  const char *what;
  ck_assert_msg(mesh_same(plain, m, 0.0, &what), "%s", what);
  ck_assert_msg(mesh_same(plain, dos, 0.0, &what), "%s", what);
}

/* Elements on entities of partitions belong to the groups of those; what parts
 * them, here a point, has the groups of the whole in the file and is in none.
 */
TEST(partitions_have_their_groups) {
  static const char parts[] =
      "$PartitionedEntities\n1\n1\n9 1\n2 1 1 0\n1 0 1 1 1 0 0 0 1 3\n"
      "7 2 5 2 1 2 0 0 0 1 1\n"
      "6 1 6 1 1 0 0 0 1 0 0 1 2 0\n5 2 5 1 1 0 0 0 1 1 0 1 1 1 6\n"
      "$EndPartitionedEntities\n";
  MESH_FILE f = mesh_file_open();
  char text[4096];
  const char *from = strstr(text_41, "$Entities"),
             *to = strstr(text_41, "$Nodes");
  snprintf(text, sizeof text, "%.*s%s%s", (int)(from - text_41), text_41, parts,
           to);
  OWNED mesh *plain = mesh_file_text(&f, "plain.msh", text_41);
  OWNED mesh *m = mesh_file_text(&f, "parts.msh", text);
  ck_assert_msg(m != NULL, "%s", f.messages);
  const char *what;
  ck_assert_msg(mesh_same(plain, m, 0.0, &what), "%s", what);
  snprintf(text, sizeof text, "%.*s%s", (int)(from - text_41), text_41, to);
  ck_assert_ptr_null(mesh_file_text(&f, "none.msh", text));
  ck_assert_ptr_nonnull(strstr(f.messages, "the file has no $Entities"));
}

/* What gmsh -parametric writes: dimension and tag of the entity of a node, and
 * its place there. */
TEST(parameters_of_nodes_are_passed_over) {
  MESH_FILE f = mesh_file_open();
  const char *what, *from = strstr(text_22, "$Nodes"),
                    *to = strstr(text_22, "$EndNodes");
  PRINTED(text,
          "%.*s$ParametricNodes\n4\n1 0 0 0 0 1\n2 1 0 0 1 6 0.5\n"
          "3 1 1 0 2 5 0.5 1\n4 0 1 0 3 1\n$EndParametricNodes%s",
          (int)(from - text_22), text_22, to + strlen("$EndNodes"));
  OWNED mesh *plain = mesh_file_text(&f, "plain.msh", text_22);
  OWNED mesh *m = mesh_file_text(&f, "places.msh", text);
  ck_assert_msg(m != NULL, "%s", f.messages);
  ck_assert_msg(mesh_same(plain, m, 0.0, &what), "%s", what);
}

/* Tags behind the second are partitions; a group of negative number is that of
 * turned elements; an entity may have several groups. */
TEST(tags_choose_the_groups) {
  static const char tagged[] =
      MSH("3\n0 3 \"P\"\n1 2 \"SIDE\"\n2 1 \"BODY\"\n",
          "4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n",
          "4\n7 2 5 1 5 2 3 4 1 2 3\n8 2 5 1 5 2 3 4 1 3 4\n"
          "9 1 4 -2 6 1 3 1 2\n10 15 2 3 1 1\n");
  MESH_FILE f = mesh_file_open();
  OWNED mesh *plain = mesh_file_text(&f, "plain.msh", text_22);
  mesh *m = mesh_file_text(&f, "tags.msh", tagged);
  ck_assert_msg(m != NULL, "%s", f.messages);
  const char *what;
  ck_assert_msg(mesh_same(plain, m, 0.0, &what), "%s", what);
  memory_free(m);
  const char *at = strstr(text_41, "1 -2 0\n");
  PRINTED(text, "%.*s2 -2 3 0\n%s", (int)(at - text_41), text_41, at + 7);
  m = mesh_file_text(&f, "two.msh", text);
  ck_assert_msg(m != NULL, "%s", f.messages);
  int lines = 0;
  for (int i = 0; i < m->n_group; ++i) {
    lines += m->group[i].dim == 1;
    if (m->group[i].dim == 1) ck_assert_int_eq(m->group[i].n_node, 2);
  }
  ck_assert_int_eq(lines, 2);
  memory_free(m);
}

/* Correctly rounded, whatever the number of digits; with a sign or without. */
TEST(coordinates_are_the_nearest_doubles) {
  MESH_FILE f = mesh_file_open();
  unsigned long random = 1;
  char line[65536];
  double wanted[1000];
  int n = 0;
  for (int i = 0; i < 1000; ++i) {
    char word[400];
    random = random * 6364136223846793005u + 1442695040888963407u;
    double v = (double)(random >> 11) * ldexp(1.0, (int)(random % 200) - 150);
    int digits = i % 7 == 0 ? 300 : 1 + i % 22;
    word[0] = i % 4 == 0 ? '+' : '-';
    snprintf(word + (i % 2 == 0), sizeof word - 1, i % 3 ? "%.*e" : "%.*g",
             digits > 100 ? 100 : digits, i % 5 ? v : 0.5 + 1.0 / (i + 1));
    wanted[i] = strtod(word, NULL);
    n += snprintf(line + n, sizeof line - (size_t)n, "%s ", word);
  }
  mesh_file_write(&f, "numbers", line, (size_t)n);
  scan s;
  ck_assert_int_eq(scan_open(&s, mesh_file_path(&f, "numbers"), ERR_MESH), OK);
  for (int i = 0; i < 1000; ++i) {
    double v;
    ck_assert_int_eq(scan_real(&s, &v), OK);
    ck_assert_msg(v == wanted[i], "%d: %.17g, not %.17g", i, v, wanted[i]);
  }
  scan_close(&s);
}

TEST(reader_gives_back_all_when_refused) {
  MESH_FILE f = mesh_file_open();
  for (int i = 0; i < 2; ++i) {
    mesh_file_write(&f, "m.msh", texts[i], strlen(texts[i]));
    raw_mesh *raw;
    UNIT_REFUSED(15, msh_read(mesh_file_path(&f, "m.msh"), &raw),
                 memory_free(raw));
  }
}

UNIT_MAIN("msh")
