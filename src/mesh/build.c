/*
 * The steps from the raw mesh to the mesh, and how their messages are made.
 */
#include "mesh/build.h"

#include "base/memory.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void culprit_add(culprits *c, const char *format, ...) {
  if (++c->n > SHOWN + 1) return;
  size_t used = strlen(c->text), room = sizeof c->text - used;
  if (c->n > SHOWN) {
    snprintf(c->text + used, room, ", ...");
    return;
  }
  if (c->n > 1) {
    int n = snprintf(c->text + used, room, ", ");
    used += (size_t)n < room ? (size_t)n : room - 1;
    room = sizeof c->text - used;
  }
  va_list args;
  va_start(args, format);
  vsnprintf(c->text + used, room, format, args);
  va_end(args);
}

void culprit_at(culprits *c, int dim, size_t no, const double *x) {
  if (dim == 2)
    culprit_add(c, "%zu at (%.6g, %.6g)", no, x[0], x[1]);
  else
    culprit_add(c, "%zu at (%.6g, %.6g, %.6g)", no, x[0], x[1], x[2]);
}

status build_check(const builder *b) {
  status st = OK;
  int n = message_count(b->log, ERROR) - b->errors;
  if (n > 0) FAIL(ERR_MESH, "the mesh is not valid: %d error(s)", n);
done:
  return st;
}

static void release(builder *b) {
  memory_free(b->by_no.slot);
  memory_free(b->node_id);
  memory_free(b->corner);
  memory_free(b->elem_of_top);
  memory_free(b->face_of_low);
  memory_free(b->first);
}

static void tell_warnings(const builder *b) {
  const raw_mesh *raw = b->raw;
  for (int i = 0; i < raw->n_warning; ++i)
    message_add(b->log, P3004, b->at, "gmsh warns: %s", raw->warning[i]);
  if (raw->n_loose > 0)
    message_add(b->log, P3014, b->at,
                "%zu %s(s) in no physical group are left out", raw->n_loose,
                b->m->dim == 3 ? "volume element" : "element");
}

status build_mesh(const raw_mesh *raw, double scale, const place *at,
                  message_log *log, mesh **out) {
  status st = OK;
  builder b = {.raw = raw, .scale = scale, .at = at, .log = log};
  b.errors = message_count(log, ERROR);
  *out = NULL;
  NEW(b.m, 1);
  NEW(b.first, raw->n_block);
  TRY(groups_check(&b));
  tell_warnings(&b);
  TRY(elements_gather(&b));
  TRY(nodes_order(&b));
  TRY(elements_finish(&b));
  TRY(faces_finish(&b));
  TRY(groups_fill(&b));
  TRY(overlap_check(&b));
  TRY(nodes_coincident(&b));
done:
  release(&b);
  if (st != OK)
    mesh_free(b.m);
  else
    *out = b.m;
  return st;
}
