/*
 * Runs whose mesh is read once.
 */
#include "support/kept_mesh.h"

#include "base/base.h"

void kept_mesh(const job *j) {
  const char *all = getenv("PROTIS_MESHES"); /* of tools/run_tests */
  if (j == NULL)
    unsetenv("MESH_KEPT");
  else
    setenv("MESH_KEPT", all != NULL ? all : j->dir, 1);
}

void kept_mesh_preload(const char *others) {
  char all[1024];
  const char *mesh = getenv("PROTIS_MESH");
  if (mesh == NULL || getenv("MESH_KEPT") == NULL) mesh = "";
  snprintf(all, sizeof all, "%s%s%s", others, mesh[0] != '\0' ? ":" : "", mesh);
  if (all[0] != '\0') setenv("LD_PRELOAD", all, 1);
}
