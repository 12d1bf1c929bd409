/*
 * Boundary meshes made by hand for the tests of the contact surface, which
 * reads no elements.
 */
#pragma once

#include "base/memory.h"
#include "contact/surface.h"

enum { FACES_MAX = 600, FACES_GROUPS = 8 };

typedef struct face_scene {
  mesh m;
  double x[3 * FACES_MAX], weight[FACES_MAX];
  size_t node_no[FACES_MAX];
  int face[3 * FACES_MAX], face_other[FACES_MAX], item[FACES_GROUPS][FACES_MAX],
      group_node[FACES_GROUPS][FACES_MAX];
  unsigned char fixed[FACES_MAX];
  mesh_group group[FACES_GROUPS];
  contact_pair pair[4];
  obstacle support[4];
  surface_input in;
  message_log *log;
  contact_surface *s;
} face_scene;

void faces_begin(face_scene *c, int dim);
void faces_end(face_scene *c);
/* FACE_SCENE c = ...: ends where the name does. */
#define FACE_SCENE ENDS_BY(faces_end) face_scene
/* Their ids. */
int faces_node(face_scene *c, double x, double y, double z);
int faces_face(face_scene *c, int a, int b, int d);
/* The faces from..to-1 are a group in contact with a conforming obstacle. */
void faces_contact(face_scene *c, const char *name, int from, int to);
status faces_build(face_scene *c);
/* How often a text stands in the messages of the log. */
int faces_said(const face_scene *c, const char *text);
double faces_area(const contact_surface *s);
/* Bottom y = 0 of a block, x from 0 to 1 in n segments, body above. */
void faces_flat_bottom(face_scene *c, int n);
/* Bottom y = 0 and the face x = 0 of a block; node 2 is the corner. */
void faces_two_sides(face_scene *c);
