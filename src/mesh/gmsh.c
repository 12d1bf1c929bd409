/*
 * mesh_read_gmsh: look at the file, let gmsh read it, build the mesh.
 */
#include "mesh/raw.h"

#include "base/memory.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

enum { HEAD_SIZE = 4096, TAIL_SIZE = 256 };

static int ends_in(const char *text, const char *end) {
  size_t n = strlen(text), k = strlen(end);
  return n >= k && strcasecmp(text + n - k, end) == 0;
}

/* gmsh does not tell a missing file from an empty one: look first. The first
 * bytes go to head, with a zero after them. */
static status read_head(const char *file, char head[HEAD_SIZE + 1],
                        const place *at, message_log *log) {
  status st = OK;
  struct stat about;
  const char *why = NULL;
  FILE *in = NULL;
  if (stat(file, &about) != 0)
    why = strerror(errno);
  else if (S_ISDIR(about.st_mode))
    why = "it is a folder";
  else if (!S_ISREG(about.st_mode))
    why = "it is not a plain file";
  else if ((in = fopen(file, "rb")) == NULL)
    why = strerror(errno);
  if (why == NULL) {
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
    FAIL(ERR_FILE, "mesh file \"%s\" cannot be read: %s", file, why);
  }
done:
  if (in != NULL) fclose(in);
  return st;
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
  status st = OK;
  char version[8];
  find_version(head, version);
  if (version[0] == '2' || strncmp(version, "4.", 2) == 0) return OK;
  if (strncmp(head, "$NOD", 4) == 0) strcpy(version, "1");
  if (version[0] != '\0')
    message_add(log, P3002, at,
                "\"%s\" is a mesh of version %s; 2.2 and 4.1 are read", file,
                version);
  else
    message_add(log, P3002, at,
                "\"%s\" is no .geo and does not start with $MeshFormat", file);
  FAIL(ERR_MESH, "\"%s\" is not a mesh of gmsh", file);
done:
  return st;
}

/* One line 'dimension number "name"' of $PhysicalNames; the line after it, or
 * NULL if this is none. */
static const char *read_name(const char *line, int *dim, int *tag,
                             const char **name, int *length) {
  int n = 0;
  if (sscanf(line, "%d %d \"%n", dim, tag, &n) != 2 || n == 0) return NULL;
  *name = line + n;
  *length = (int)strcspn(*name, "\"\n");
  const char *end = strchr(*name, '\n');
  return end == NULL ? NULL : end + 1;
}

/* A name that two groups of one dimension bear: gmsh drops the second without
 * a word. Seen in the head of the file, where the names stand. */
static status check_names(const char *head, const place *at, message_log *log) {
  status st = OK;
  static const char start[] = "$PhysicalNames";
  static const char *const kind[] = {"point", "curve", "surface", "volume"};
  const char *first = strstr(head, start), *a, *b;
  int dim[2], tag[2], length[2], wrong = 0;
  for (int i = 0; i < 2 && first != NULL; ++i)
    if ((first = strchr(first, '\n')) != NULL) ++first;
  for (const char *p = first, *q; p != NULL; p = q) {
    if ((q = read_name(p, &dim[0], &tag[0], &a, &length[0])) == NULL) break;
    for (const char *r = q; r != NULL;) {
      r = read_name(r, &dim[1], &tag[1], &b, &length[1]);
      if (r == NULL || dim[0] != dim[1] || length[0] != length[1] ||
          strncmp(a, b, (size_t)length[0]) != 0 || dim[0] < 0 || dim[0] > 3)
        continue;
      message_add(log, P3012, at,
                  "\"%.*s\" names the physical %s %d and the physical %s %d",
                  length[0], a, kind[dim[0]], tag[0], kind[dim[0]], tag[1]);
      wrong = 1;
    }
  }
  if (wrong) FAIL(ERR_MESH, "names of groups are repeated");
done:
  return st;
}

/* The last bytes of the file, *n of them, with a zero after. */
static status read_tail(const char *file, char tail[TAIL_SIZE + 1], size_t *n) {
  status st = OK;
  FILE *in = fopen(file, "rb");
  if (in == NULL) FAIL(ERR_FILE, "\"%s\": %s", file, strerror(errno));
  if (fseek(in, -TAIL_SIZE, SEEK_END) != 0) rewind(in); /* it is shorter */
  *n = fread(tail, 1, TAIL_SIZE, in);
  tail[*n] = '\0';
done:
  if (in != NULL) fclose(in);
  return st;
}

/* gmsh takes half a number for a number: a .msh ends with $End..., or it was
 * cut short. */
static status check_msh_tail(const char *file, const place *at,
                             message_log *log) {
  status st = OK;
  char tail[TAIL_SIZE + 1];
  size_t n = 0;
  TRY(read_tail(file, tail, &n));
  while (n > 0 && strchr(" \t\r\n", tail[n - 1]) != NULL) --n;
  size_t line = n;
  while (line > 0 && tail[line - 1] != '\n') --line;
  if (n - line < 4 || strncmp(tail + line, "$End", 4) != 0) {
    message_add(log, P3003, at,
                "mesh file \"%s\" is cut short: it does not end with $End...",
                file);
    FAIL(ERR_MESH, "mesh file \"%s\" is cut short", file);
  }
done:
  return st;
}

/* Of a last line without newline gmsh obeys the first statement only. */
static status check_geo_tail(const char *file, const place *at,
                             message_log *log) {
  status st = OK;
  char tail[TAIL_SIZE + 1];
  size_t n = 0;
  TRY(read_tail(file, tail, &n));
  if (n > 0 && (tail[n - 1] == '\n' || tail[n - 1] == '\r')) return OK;
  const char *line = strrchr(tail, '\n');
  const char *first = strchr(line != NULL ? line : tail, ';');
  if (first != NULL && strchr(first + 1, ';') != NULL) {
    message_add(log, P3005, at,
                "\"%s\" ends without a newline after several statements", file);
    FAIL(ERR_MESH, "\"%s\" ends without a newline", file);
  }
done:
  return st;
}

/* gmsh calls a name given twice in one dimension an error of its own. */
static message_id number_of(const char *text) {
  return strstr(text, "Physical ") != NULL && strstr(text, "already exists")
             ? P3012
             : P3003;
}

status mesh_read_gmsh(const mesh_source *source, const place *at,
                      message_log *log, mesh **out) {
  status st = OK;
  const char *file = source->file;
  char head[HEAD_SIZE + 1];
  raw_mesh *raw = NULL;
  raw_request request = {source, ends_in(file, ".geo"), 0};
  *out = NULL;
  TRY(read_head(file, head, at, log));
  request.is_solid = strstr(head, "OpenCASCADE") != NULL;
  if (request.is_geo) {
    TRY(check_geo_tail(file, at, log));
  } else {
    TRY(check_format(file, head, at, log));
    TRY(check_names(head, at, log));
    TRY(check_msh_tail(file, at, log));
  }
  st = raw_read(&request, &raw);
  if (st == ERR_MESH)
    message_add(log, number_of(status_message()), at, "mesh file \"%s\": %s",
                file, status_message());
  TRY(st);
  TRY(build_mesh(raw, source->scale, at, log, out));
done:
  raw_free(raw);
  return st;
}
