/*
 * Release of a raw mesh.
 */
#include "mesh/msh/raw_mesh.h"

#include "base/memory.h"

void raw_free(raw_mesh *raw) {
  if (raw == NULL) return;
  for (int i = 0; i < raw->n_block; ++i) {
    RELEASE(raw->block[i].type_name, raw->block[i].physical, raw->block[i].no,
            raw->block[i].node);
  }
  for (int i = 0; i < raw->n_group; ++i) memory_free(raw->group[i].name);
  for (int i = 0; i < raw->n_warning; ++i) memory_free(raw->warning[i]);
  RELEASE(raw->block, raw->group, raw->warning, raw->node_no, raw->xyz, raw);
}
