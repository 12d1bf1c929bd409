/*
 * mesh_read_gmsh: a .geo is a program that gmsh runs, all else is data that
 * is read here; then the steps from the raw mesh to the mesh, and how their
 * messages are made.
 */
#include "base/file.h"
#include "mesh/build.h"
#include "mesh/refine/refine.h"

#include "base/memory.h"
#include "base/system/input.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

static void release(builder *b) {
  RELEASE(b->by_no.slot, b->node_id, b->corner, b->elem_of_top, b->face_of_low,
          b->first);
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
  NEW_ALL(OF(b.m, 1), OF(b.first, raw->n_block));
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

enum { HEAD_SIZE = 4096, TAIL_SIZE = 256 };

/* gmsh does not distinguish a missing file from an empty one: check first. The
 * first bytes go to head, with a zero after them. */
static status read_head(const char *file, char head[HEAD_SIZE + 1],
                        const place *at, message_log *log) {
  const char *why = NULL;
  ENDS_BY(file_leave) FILE *in = input_stream(file, &why);
  if (in != NULL) {
    why = NULL;
    size_t n = fread(head, 1, HEAD_SIZE, in);
    head[n] = '\0';
    if (ferror(in))
      why = strerror(errno);
    else if (n == 0)
      why = "it is empty";
  }
  if (why != NULL) {
    message_add(log, P3001, at, "mesh file \"%s\" cannot be read: %s", file,
                why);
    RAISE(ERR_FILE, "mesh file \"%s\" cannot be read: %s", file, why);
  }
  return OK;
}

/* The version of the format from the head of a .msh, "" if it has none. */
static void find_version(const char *head, char version[8]) {
  static const char start[] = "$MeshFormat";
  version[0] = '\0';
  const char *p = strstr(head, start);
  if (p == NULL || (p != head && p[-1] != '\n')) return;
  p += sizeof start - 1;
  p += strspn(p, " \t\r\n");
  snprintf(version, 8, "%.*s", (int)strspn(p, "0123456789."), p);
}

static status check_format(const char *file, const char *head, const place *at,
                           message_log *log) {
  char version[8];
  find_version(head, version);
  const char *start = head + strspn(head, " \t\r\n");
  if (strncmp(start, "$NOD", 4) == 0) strcpy(version, "1");
  if (*start != '$') version[0] = '\0';
  if (strcmp(version, "2.1") == 0 || strncmp(version, "2.2", 3) == 0 ||
      strncmp(version, "4.1", 3) == 0)
    return OK;
  if (version[0] != '\0')
    message_add(log, P3002, at,
                "\"%s\" is a mesh of version %s; 2.2 and 4.1 are read", file,
                version);
  else
    message_add(log, P3002, at,
                "\"%s\" is no .geo and does not start with $MeshFormat", file);
  RAISE(ERR_MESH, "\"%s\" is not a mesh of gmsh", file);
  return OK;
}

/* The last bytes of the file, *n of them, with a zero after. */
static status read_tail(const char *file, char tail[TAIL_SIZE + 1], size_t *n) {
  const char *why;
  ENDS_BY(file_leave) FILE *in = input_stream(file, &why);
  if (in == NULL) RAISE(ERR_FILE, "\"%s\": %s", file, why);
  int sought = fseek(in, -TAIL_SIZE, SEEK_END) == 0;
  int shorter = !sought && errno == EINVAL;
  if (shorter) rewind(in);
  *n = sought || shorter ? fread(tail, 1, TAIL_SIZE, in) : 0;
  tail[*n] = '\0';
  if ((!sought && !shorter) || ferror(in))
    RAISE(ERR_FILE, "\"%s\": %s", file, strerror(errno));
  return OK;
}

/* Of a last line without newline gmsh executes the first statement only. */
static status check_geo_tail(const char *file, const place *at,
                             message_log *log) {
  char tail[TAIL_SIZE + 1];
  size_t n = 0;
  PASS(read_tail(file, tail, &n));
  if (n > 0 && (tail[n - 1] == '\n' || tail[n - 1] == '\r')) return OK;
  const char *line = strrchr(tail, '\n');
  const char *first = strchr(line != NULL ? line : tail, ';');
  if (first != NULL && strchr(first + 1, ';') != NULL) {
    message_add(log, P3005, at,
                "\"%s\" ends without a newline after several statements", file);
    RAISE(ERR_MESH, "\"%s\" ends without a newline", file);
  }
  return OK;
}

/* gmsh itself reports a name given twice in one dimension as an error. */
static message_id number_of(const char *text) {
  return strstr(text, "Physical ") != NULL && strstr(text, "already exists")
             ? P3012
             : P3003;
}

/* gmsh runs the geometry as a program. */
static status read_geo(const mesh_source *source, const char *head,
                       const place *at, message_log *log, raw_mesh **raw) {
  int is_solid = strstr(head, "OpenCASCADE") != NULL;
  PASS(check_geo_tail(source->file, at, log));
  const status st = raw_read(&(raw_request){source, is_solid}, raw);
  if (st == ERR_MESH)
    message_add(log, number_of(status_message()), at, "mesh file \"%s\": %s",
                source->file, status_message());
  return st;
}

/* A .msh is data only. */
static status read_msh(const mesh_source *source, const char *head,
                       const place *at, message_log *log, raw_mesh **raw) {
  const char *file = source->file;
  PASS(check_format(file, head, at, log));
  const status st = msh_read(file, raw);
  if (st == ERR_MESH)
    message_add(log, P3006, at, "mesh file %s", status_message());
  return st;
}

static status refine(const mesh_source *source, raw_mesh *raw) {
  const mesh *of = source->sizes[0].of;
  const refine_request request = {
      {of->dim, of->n_node, of->n_elem, of->x, of->elem, source->sizes[0].at},
      source->scale,
      source->n_round,
      source->rounds};
  return raw_refine(raw, &request);
}

int mesh_is_program(const char *file) {
  size_t n = strlen(file);
  return n >= 4 && strcasecmp(file + n - 4, ".geo") == 0;
}

status mesh_read_gmsh(const mesh_source *source, const place *at,
                      message_log *log, mesh **out) {
  char head[HEAD_SIZE + 1];
  ENDS_BY(raw_free) raw_mesh *raw = NULL;
  *out = NULL;
  PASS(read_head(source->file, head, at, log));
  if (mesh_is_program(source->file))
    PASS(read_geo(source, head, at, log, &raw));
  else
    PASS(read_msh(source, head, at, log, &raw));
  if (source->sizes[0].of != NULL && !mesh_is_program(source->file))
    PASS(refine(source, raw));
  raw->meets = source->meets;
  raw->made = mesh_is_program(source->file);
  return build_mesh(raw, source->scale, at, log, out);
}
