/*
 * The mesh of a .geo as gmsh sends it. Inside src/mesh only.
 *
 * gmsh meshes a .geo in a child process that ends with it: it may crash, run
 * out of memory or exit by itself, and its libraries take no memory later. The
 * child sends records through a pipe: a head, then n items of one size.
 */
#pragma once

#include "mesh/mesh.h"
#include "mesh/msh/raw_mesh.h"

#include <stdint.h>
#include <sys/types.h>

/* clang-format off */
#define WIRE_LIST(X)                                                          \
  X(CENSUS,    int)     /* entities of dimension 0, 1, 2, 3 */ \
  X(NODE_NO,   size_t)                                                        \
  X(NODE_X,    double)                                                        \
  X(GROUP,     char)    /* name; head: dim, tag */ \
  X(BLOCK,     char)    /* type name; head: dim, type as tag */ \
  X(PHYSICAL,  int)     /* of the last block; likewise the next two */ \
  X(ELEM_NO,   size_t)                                                        \
  X(ELEM_NODE, size_t)                                                        \
  X(LOOSE,     size_t)                                                        \
  X(WARNING,   char)                                                          \
  X(FAILURE,   char)    /* reason why there is no mesh; head: status as tag */ \
  X(END,       char)

/* What is called of libgmsh: first those that say what is to be meshed. */
#define GMSH_BEFORE_MESH(X)                                                   \
  X(Initialize) X(LoggerStart) X(OptionSetNumber) X(Open)                     \
  X(ModelMeshRemoveConstraints) X(Write) X(Clear) X(ViewAdd)                  \
  X(ViewAddListData) X(ModelMeshFieldAdd) X(ModelMeshFieldSetNumber)          \
  X(ModelMeshFieldSetNumbers) X(ModelMeshFieldSetAsBackgroundMesh)            \
  X(ModelGetPhysicalGroups)
#define GMSH_CALLS(X)                                                         \
  X(LoggerGet) X(LoggerGetLastError) X(ModelGetEntities)                      \
  X(ModelGetPhysicalName) X(ModelGetPhysicalGroupsForEntity)                  \
  X(ModelMeshGenerate) X(ModelMeshGetNodes) X(ModelMeshGetElements)           \
  X(ModelMeshGetElementProperties) X(Merge) X(Free)
/* clang-format on */

/* In the message of a number that a .geo replaces. */
#define NO_EFFECT "of *PARAMETER or -D has no effect"
#define OWN_VALUE "is that of the deck alone"

#define WIRE_ENUM(name, type) WIRE_##name,
typedef enum { WIRE_LIST(WIRE_ENUM) WIRE_COUNT } wire_kind;

typedef struct wire_head {
  uint32_t magic, kind;
  int32_t dim, tag;
  uint64_t n; /* items that follow */
} wire_head;

enum { WIRE_MAGIC = 0x50524d31 }; /* "PRM1" */

typedef struct raw_request {
  const mesh_source *source;
  int is_solid; /* of the kernel OpenCASCADE */
} raw_request;

/* Let a child process mesh a .geo. The record says what failed: ERR_MEMORY for
 * lack of memory on either side, else ERR_MESH. */
status raw_read(const raw_request *request, raw_mesh **out);
/* Parent's end of the pipe: everything up to END. ERR_MESH if the stream
 * stops before (*stopped = 1) or holds what is no record. */
status raw_receive(int fd, raw_mesh *raw, int *stopped);

/* Child's end: gmsh from the request to the pipe. Never returns. */
void child_run(const raw_request *request, int fd, int error_fd);
/* 1: a text of gmsh says that there was no memory. */
int child_tells_of_memory(const char *text);

/* Check the raw mesh and make the mesh of it; messages go to the log. */
status build_mesh(const raw_mesh *raw, double scale, const place *at,
                  message_log *log, mesh **out);
