#include "support/tips.h"

#include "base/base.h"

static const char triangles[] =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n6\n"
    "0 1 \"CLAMPED\"\n0 2 \"TIPS\"\n1 3 \"FOOT1\"\n1 4 \"FOOT2\"\n"
    "1 5 \"SIDE1\"\n2 6 \"BODY\"\n$EndPhysicalNames\n$Nodes\n6\n"
    "1 -1 1 0\n2 1 1 0\n3 0 0 0\n4 3 1 0\n5 5 1 0\n6 4 0 0\n$EndNodes\n"
    "$Elements\n11\n1 15 2 1 1 1\n2 15 2 1 2 2\n3 15 2 1 4 4\n4 15 2 1 5 5\n"
    "5 15 2 2 3 3\n6 15 2 2 6 6\n7 1 2 3 1 1 3\n8 1 2 4 2 4 6\n"
    "9 1 2 5 3 3 2\n10 2 2 6 1 3 2 1\n11 2 2 6 2 6 5 4\n$EndElements\n";

job tips_new(double G, const char *mesh, const char *cards) {
  job j = job_begin("tips");
  job_write(&j, "tips.msh", "%s", triangles);
  job_write(&j, "tips.inp",
            "*MESH, FILE=tips.msh%s\n*MATERIAL, NAME=M\n*ELASTIC\n%.17g, 0.3\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n%s",
            mesh, 2.6 * G, cards);
  return j;
}

void tips_material(const job *j, const char *cards) {
  char *deck = job_file(j, "inp"), *at = strstr(deck, "*SOLID SECTION");
  *at = '\0';
  job_write(j, "tips.inp", "%s%s*%s", deck, cards, at + 1);
  free(deck);
}
