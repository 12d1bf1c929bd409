/*
 * Runs whose mesh is read once.
 */
#include "support/kept_mesh.h"

#include <stdio.h>
#include <stdlib.h>

void kept_mesh(const job *j) {
  char path[200];
  unsetenv("MESH_KEPT");
  if (j == NULL) return;
  snprintf(path, sizeof path, "%s/mesh.kept", j->dir);
  setenv("MESH_KEPT", path, 1);
}

void kept_mesh_preload(const char *others) {
  char all[1024];
  const char *mesh = getenv("PROTIS_MESH");
  if (mesh == NULL || getenv("MESH_KEPT") == NULL) mesh = "";
  snprintf(all, sizeof all, "%s%s%s", others, mesh[0] != '\0' ? ":" : "", mesh);
  if (all[0] != '\0') setenv("LD_PRELOAD", all, 1);
}
