/*
 * Opening a mesh along cracks, groups of faces inside the bodies (2-D: lines,
 * 3-D: triangles).
 *
 * The elements round a node fall into fans, connected through faces that
 * contain the node and belong to no crack. One fan keeps the node, every other
 * one gets a copy: a node with one fan is a tip (2-D) or on the front (3-D) and
 * stays as it is; kinks have two fans, branches three, crossings four, the
 * mouth at the surface two. A cut through a body makes two bodies of it.
 *
 * Each face becomes two lips, boundary faces with opposite normals. "Plus" is
 * the lip of the body above, towards the end of the last axis (2-D: y, 3-D: z)
 * in which the normal of the crack, on average, has a part. That holds for each
 * piece of the crack up to branches; in a closed one (all parts are zero) minus
 * is the side of face_elem of its first face.
 */
#pragma once

#include "mesh/mesh.h"

typedef struct mesh_cut { /* a crack to be opened */
  const mesh_group *group;
  const place *at; /* for messages */
} mesh_cut;

/*
 * Open all cracks of a mesh at once, so that they may meet and cross.
 *
 * Copies stand behind the other nodes; mesh->origin names what they are copies
 * of. Of a group NAME the lips make the groups NAME+ and NAME-, and NAME gets
 * both. Other groups: elements and faces keep their ids, a face stays that of
 * face_elem; groups of points (3-D: curves) get all copies, said by P3055.
 * Faces with all nodes on the front stay closed and leave the group (P3054).
 *
 *   m       in,out  after a failure only to be freed
 *   n, cut  in      [n]
 *   crack   out     [n] their arrays belong to the mesh
 *
 * ERR_MESH with errors in the log: P2022, P3012, P3050 to P3053. ERR_MEMORY.
 * Cost: a few passes over the mesh, else linear in the elements round the
 * cracks.
 */
status mesh_open(mesh *m, int n, const mesh_cut *cut, message_log *log,
                 mesh_crack *crack);
