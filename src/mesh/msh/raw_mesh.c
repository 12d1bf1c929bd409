/*
 * Release of a raw mesh.
 */
#include "mesh/msh/raw_mesh.h"

#include "base/memory.h"

void raw_free(raw_mesh *raw) {
  if (raw == NULL) return;
  for (int i = 0; i < raw->n_block; ++i) {
    memory_free(raw->block[i].type_name);
    memory_free(raw->block[i].physical);
    memory_free(raw->block[i].no);
    memory_free(raw->block[i].node);
  }
  for (int i = 0; i < raw->n_group; ++i) memory_free(raw->group[i].name);
  for (int i = 0; i < raw->n_warning; ++i) memory_free(raw->warning[i]);
  memory_free(raw->block);
  memory_free(raw->group);
  memory_free(raw->warning);
  memory_free(raw->node_no);
  memory_free(raw->xyz);
  memory_free(raw);
}
