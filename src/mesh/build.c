/*
 * mesh_read_gmsh: a .geo is a program that gmsh runs, all else is data that
 * is read here; then the steps from the raw mesh to the mesh, and how their
 * messages are made.
 */
#include "mesh/build.h"

#include "base/base.h"
#include "base/file.h"
#include "base/system/input.h"
#include "mesh/refine/refine.h"
#include "mesh/sort.h"

#include <errno.h>
#include <strings.h>

/* ---- groups: names and dimension before, contents after the rest ---- */

static const char *const kind[] = {"point", "curve", "surface", "volume"};

/* The group's name as it may be shown, or its tag as text. */
static status copy_name(const raw_group *g, const char **name) {
  char tag[16], *shown = NULL;
  snprintf(tag, sizeof tag, "%d", g->tag);
  const char *text = g->name[0] != '\0' ? g->name : tag;
  size_t size = 4 * strlen(text) + 1;
  PASS_NEW(shown, size);
  text_shown(shown, size, text);
  *name = shown;
  return OK;
}

static int block_in_group(const raw_block *p, int dim, int tag) {
  if (p->dim != dim) return 0;
  for (int i = 0; i < p->n_physical; ++i)
    if (p->physical[i] == tag) return 1;
  return 0;
}

static void check_empty(const builder *b, const mesh_group *g) {
  for (int i = 0; i < b->raw->n_block; ++i)
    if (block_in_group(&b->raw->block[i], g->dim, g->tag)) return;
  message_add(b->log, P3013, b->at,
              "physical %s \"%s\" (number %d) holds no element", kind[g->dim],
              g->name, g->tag);
}

static int by_name(const void *p, const void *q) {
  const mesh_group *a = *(const mesh_group *const *)p,
                   *b = *(const mesh_group *const *)q;
  int order = strcmp(a->name, b->name);
  if (order != 0) return order;
  if (a->dim != b->dim) return a->dim - b->dim;
  return (a->tag > b->tag) - (a->tag < b->tag);
}

static status check_names(const builder *b) {
  const mesh *m = b->m;
  OWNED_NEW(const mesh_group *, sorted, m->n_group);
  for (int i = 0; i < m->n_group; ++i) sorted[i] = &m->group[i];
  qsort(sorted, m->n_group, sizeof *sorted, by_name);
  for (int i = 1; i < m->n_group; ++i) {
    const mesh_group *a = sorted[i - 1], *g = sorted[i];
    if (strcmp(a->name, g->name) == 0)
      message_add(b->log, P3012, b->at,
                  "\"%s\" names the physical %s %d and the physical %s %d",
                  a->name, kind[a->dim], a->tag, kind[g->dim], g->tag);
  }
  return OK;
}

static void tell_no_group(const builder *b) {
  const int *n = b->raw->n_entity;
  if (b->raw->n_group == 0)
    message_add(b->log, P3010, b->at,
                "the mesh has %d point(s), %d curve(s), %d surface(s), %d "
                "volume(s), but no physical group",
                n[0], n[1], n[2], n[3]);
  else
    message_add(b->log, P3011, b->at,
                "the %d physical group(s) name points or curves only; the mesh "
                "has %d surface(s) and %d volume(s)",
                b->raw->n_group, n[2], n[3]);
}

static status groups_check(builder *b) {
  mesh *m = b->m;
  PASS_NEW(m->group, b->raw->n_group);
  for (int i = 0; i < b->raw->n_group; ++i) {
    const raw_group *g = &b->raw->group[i];
    if (g->dim < 0 || g->dim > 3)
      RAISE(ERR_MESH, "physical group of dimension %d", g->dim);
    m->group[i] = (mesh_group){.dim = g->dim, .tag = g->tag};
    m->n_group = i + 1;
    PASS(copy_name(g, &m->group[i].name));
    if (g->dim > m->dim) m->dim = g->dim;
  }
  if (m->dim < 2) {
    tell_no_group(b);
    PASS(build_check(b));
  }
  PASS(check_names(b));
  for (int i = 0; i < m->n_group; ++i) check_empty(b, &m->group[i]);
  return build_check(b);
}

typedef struct filling { /* marks are all 0 between two groups */
  char *node_mark;       /* [n_node] */
  char *item_mark;       /* [max of n_elem, n_face] */
  int *node, *item;      /* lists of the current group */
  int n_node, n_item;
} filling;

static void add(char *mark, int *list, int *n, int id) {
  if (mark[id]) return;
  mark[id] = 1;
  list[(*n)++] = id;
}

/* Elements or faces of a block, and their nodes. */
static void add_items(const builder *b, int block, filling *f) {
  const mesh *m = b->m;
  const raw_block *p = &b->raw->block[block];
  int top = p->dim == m->dim;
  size_t n = p->n_per;
  for (size_t i = 0; i < p->n; ++i) {
    size_t raw_item = b->first[block] + i;
    int id = top ? b->elem_of_top[raw_item] : b->face_of_low[raw_item];
    const int *v = (top ? m->elem : m->face) + n * id;
    if (f->item_mark[id]) continue;
    add(f->item_mark, f->item, &f->n_item, id);
    for (size_t k = 0; k < n; ++k) add(f->node_mark, f->node, &f->n_node, v[k]);
  }
}

/* Nodes of a block of points or, in 3-D, of curves. */
static void add_nodes(const builder *b, const raw_block *p, filling *f,
                      faults *outside) {
  for (size_t i = 0; i < p->n_per * p->n; ++i) {
    int r = nodes_find(b, p->node[i]);
    int id = r < 0 ? -1 : b->node_id[r];
    if (id >= 0)
      add(f->node_mark, f->node, &f->n_node, id);
    else
      fault_add(outside, "%zu", p->node[i]);
  }
}

static status take_list(int n, const int *list, char *mark, int **out) {
  for (int i = 0; i < n; ++i) mark[list[i]] = 0;
  PASS_NEW(*out, n);
  COPY(*out, list, n);
  return sort_ids(n, *out);
}

static status fill_group(builder *b, mesh_group *g, filling *f) {
  faults outside = {0};
  f->n_node = f->n_item = 0;
  for (int i = 0; i < b->raw->n_block; ++i) {
    if (!block_in_group(&b->raw->block[i], g->dim, g->tag)) continue;
    if (g->dim >= b->m->dim - 1)
      add_items(b, i, f);
    else
      add_nodes(b, &b->raw->block[i], f, &outside);
  }
  g->n_node = f->n_node;
  g->n_item = f->n_item;
  PASS(take_list(f->n_node, f->node, f->node_mark, &g->node_id));
  if (g->dim >= b->m->dim - 1)
    PASS(take_list(f->n_item, f->item, f->item_mark, &g->item_id));
  if (outside.n > 0)
    message_add(b->log, P3033, b->at,
                "physical %s \"%s\": %d node(s) in no element of the mesh: %s",
                kind[g->dim], g->name, outside.n, outside.text);
  return OK;
}

static status groups_fill(builder *b) {
  mesh *m = b->m;
  const int n_item = m->n_elem > m->n_face ? m->n_elem : m->n_face;
  OWNED_NEW(char, mark, m->n_node + n_item);
  OWNED_NEW(int, list, m->n_node + n_item);
  filling f = {mark, mark + m->n_node, list, list + m->n_node, 0, 0};
  for (int i = 0; i < m->n_group; ++i) PASS(fill_group(b, &m->group[i], &f));
  return build_check(b);
}

static void release(builder *b) {
  RELEASE(b->by_no.slot, b->node_id, b->corner, b->elem_of_top, b->face_of_low,
          b->first);
}

static void tell_warnings(const builder *b) {
  const raw_mesh *raw = b->raw;
  for (int i = 0; i < raw->n_warning; ++i)
    if (strstr(raw->warning[i], OWN_VALUE) != NULL)
      message_add(b->log, P2065, b->at, "%s", raw->warning[i]);
    else
      message_add(b->log, P3004, b->at, "gmsh warns: %s", raw->warning[i]);
  if (raw->n_loose > 0)
    message_add(b->log, P3014, b->at,
                "%zu %s(s) in no physical group are left out", raw->n_loose,
                b->m->dim == 3 ? "volume element" : "element");
}

status build_mesh(const raw_mesh *raw, double scale, const place *at,
                  message_log *log, mesh **out) {
  *out = NULL;
  OWNED_NEW(mesh, m, 1);
  ENDS_BY(release)
  builder b = {.raw = raw, .scale = scale, .at = at, .log = log, .m = m};
  b.errors = message_count(log, ERROR);
  OWNS(m);
  PASS_NEW(b.first, raw->n_block);
  PASS(groups_check(&b));
  tell_warnings(&b);
  PASS(elements_gather(&b));
  PASS(nodes_order(&b));
  PASS(elements_finish(&b));
  PASS(faces_finish(&b));
  PASS(groups_fill(&b));
  PASS(overlap_check(&b));
  PASS(nodes_coincident(&b));
  *out = m;
  m = NULL;
  return OK;
}

enum { HEAD_SIZE = 4096, TAIL_SIZE = 256 };

/* gmsh does not distinguish a missing file from an empty one: check first. The
 * first bytes go to head, with a zero after them, but for a byte order mark. */
static status read_head(const char *file, char head[HEAD_SIZE + 1],
                        const place *at, message_log *log) {
  const char *why = NULL;
  ENDS_BY(file_leave) FILE *in = input_stream(file, &why);
  if (in != NULL) {
    why = NULL;
    size_t n = fread(head, 1, HEAD_SIZE, in);
    head[n] = '\0';
    if (strncmp(head, "\xEF\xBB\xBF", 3) == 0) memmove(head, head + 3, n - 2);
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
  if (strstr(text, NO_EFFECT) != NULL) return P2042;
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
  if (st == OK) return st;
  if (st == ERR_MESH || st == ERR_FILE)
    message_add(log, number_of(status_message()), at, "mesh file \"%s\": %s",
                source->file, status_message());
  RAISE(st, "mesh file \"%s\": %s", source->file, status_message());
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

int mesh_is_program(const char *file) {
  size_t n = strlen(file);
  return n >= 4 && strcasecmp(file + n - 4, ".geo") == 0;
}

status mesh_read_gmsh(const mesh_source *source, const place *at,
                      message_log *log, mesh **out) {
  char head[HEAD_SIZE + 1];
  OWNED raw_mesh *raw = NULL;
  *out = NULL;
  PASS(read_head(source->file, head, at, log));
  if (mesh_is_program(source->file))
    PASS(read_geo(source, head, at, log, &raw));
  else
    PASS(read_msh(source, head, at, log, &raw));
  if (source->sizes[0].of != NULL && !mesh_is_program(source->file)) {
    const mesh *of = source->sizes[0].of;
    const refine_request request = {
        {of->dim, of->n_elem, of->x, of->elem, source->sizes[0].at},
        source->scale,
        source->n_round,
        source->rounds};
    PASS(raw_refine(raw, &request));
  }
  raw->meets = source->meets;
  raw->made = mesh_is_program(source->file);
  return build_mesh(raw, source->scale, at, log, out);
}
