/*
 * Names of groups to their ids in the mesh.
 */
#include "model/check/parts.h"

#include <stdio.h>

static const char *const dim_words[] = {"points", "curves", "surfaces",
                                        "volumes"};

int check_group(const model *m, const mesh *msh, const char *name,
                const place *at) {
  const mesh_group *g = mesh_find_group(msh, name);
  if (g != NULL) return (int)(g - msh->group);
  const char *near =
      message_wanted(m->log, ERROR) ? mesh_nearest_group(msh, name) : NULL;
  if (near != NULL) {
    message_add(m->log, P2021, at, "the mesh has no group %s; did you mean %s?",
                name, near);
    return -1;
  }
  char all[400] = "";
  size_t n = 0;
  for (int i = 0; i < msh->n_group && n < sizeof all / 2; ++i)
    n += (size_t)snprintf(all + n, sizeof all - n, "%s%.60s",
                          i == 0 ? "" : ", ", msh->group[i].name);
  message_add(m->log, P2021, at, "the mesh has no group %s; it has %s", name,
              all);
  return -1;
}

int check_group_of(const model *m, const mesh *msh, const char *name, int dim,
                   const place *at) {
  int id = check_group(m, msh, name, at);
  if (id < 0 || msh->group[id].dim == dim) return id;
  message_add(m->log, P2022, at,
              "group %s is made of %s; %s are needed here in %d-D", name,
              dim_words[msh->group[id].dim], dim_words[dim], msh->dim);
  return -1;
}
