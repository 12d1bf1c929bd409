/* Nodal fields: $NodeData of gmsh, or two datasets of HDF5. */
#include "model/check/parts.h"

#include "base/archive/dataset.h"
#include "base/base.h"
#include "base/system/input.h"
#include "mesh/msh/raw_mesh.h"
#include "mesh/msh/scan.h"

/* Values beyond those of the mesh that a file may have: FOREIGN a node, and
 * FEW. */
enum { FOREIGN = 8, FEW = 100000 };
static const double SAME_PLACE = 1e-6; /* -, of the size of the mesh */

typedef struct pairs { /* as the file has them */
  long n;
  long *node_no;
  double *value;
  int has_nodes; /* 1: and their places */
} pairs;

static void pairs_free(pairs *p) {
  RELEASE(p->node_no, p->value);
  *p = (pairs){.has_nodes = p->has_nodes};
}

/* A count on a line of its own. */
static status read_count(scan *s, size_t *n) {
  PASS(scan_size(s, n));
  return scan_line(s);
}

/* The tags before the values: *n of them, of one component. */
static status read_tags(scan *s, size_t *n) {
  size_t count, length, component = 0;
  const char *name;
  double time;
  PASS(read_count(s, &count));
  for (size_t i = 0; i < count; ++i) {
    PASS(scan_quoted(s, &name, &length));
    PASS(scan_line(s));
  }
  PASS(read_count(s, &count));
  for (size_t i = 0; i < count; ++i) {
    PASS(scan_real(s, &time));
    PASS(scan_line(s));
  }
  PASS(read_count(s, &count));
  for (size_t i = 0; i < count; ++i) {
    int tag;
    PASS(scan_int(s, &tag));
    PASS(scan_line(s));
    if (i == 1) component = tag;
    if (i == 2) *n = tag < 0 ? SIZE_MAX : (size_t)tag;
  }
  if (count < 3) return scan_fail(s, "$NodeData needs three integer tags");
  if (component != 1)
    return scan_fail(s, "$NodeData has %zu components, one is needed",
                     component);
  return OK;
}

static status read_node_data(scan *s, pairs *p) {
  size_t n = 0;
  int no;
  pairs_free(p);
  PASS(read_tags(s, &n));
  scan_start_binary(s);
  PASS(scan_fits(s, n, sizeof "1 0", 12, "values"));
  PASS_NEW_ALL(OF(p->node_no, n), OF(p->value, n));
  for (size_t i = 0; i < n; ++i) {
    PASS(scan_int(s, &no));
    PASS(scan_real(s, &p->value[i]));
    PASS(scan_line(s));
    p->node_no[i] = no;
  }
  p->n = n;
  return scan_end(s, "NodeData", "its values");
}

static status read_gmsh(scan *s, pairs *p) {
  char name[SCAN_NAME];
  int found = 0;
  for (;;) {
    PASS(scan_section(s, name));
    if (name[0] == '\0') break;
    p->has_nodes |= strstr(name, "Nodes") != NULL;
    if (strcmp(name, "NodeData") != 0) {
      PASS(scan_skip(s, name));
      continue;
    }
    if (s->version == 0.0)
      return scan_fail(s, "$MeshFormat is to stand before $NodeData");
    PASS(read_node_data(s, p));
    found = 1;
  }
  if (!found)
    RAISE(ERR_DECK, "%s: there is no $NodeData, and it is not HDF5", s->path);
  return OK;
}

static status read_hdf5(const char *path, long most, pairs *p) {
  ENDS_BY(dataset_close) hdf5_source s = {0};
  long n_value = 0;
  PASS(dataset_open(path, &s));
  OWNED_OF(int, number, source_ints(&s, "/node_no", 0, most, &p->n, &number));
  PASS(source_reals(&s, "/temperature", 0, most, &n_value, &p->value));
  if (n_value != p->n)
    RAISE(ERR_DECK, "%s: /node_no has %ld items, /temperature %ld", path, p->n,
          n_value);
  PASS_NEW(p->node_no, p->n);
  for (long i = 0; i < p->n; ++i) p->node_no[i] = number[i];
  return OK;
}

/* A node of the mesh with its place, sorted by number. */
typedef struct numbered {
  size_t no;
  int id;
} numbered;

static int compare_no(const void *a, const void *b) {
  const size_t x = ((const numbered *)a)->no, y = ((const numbered *)b)->no;
  return (x > y) - (x < y);
}

static const numbered *find_node(const mesh *msh, const numbered *node,
                                 size_t no) {
  const numbered key = {no, 0};
  return bsearch(&key, node, msh->n_node, sizeof key, compare_no);
}

/* Nodes of one number are at one place. */
static status check_places(const char *path, const mesh *msh, double scale,
                           const numbered *node) {
  OWNED_OF(raw_mesh, raw, msh_read_nodes(path, &raw));
  for (size_t i = 0; i < raw->n_node; ++i) {
    const numbered *at = find_node(msh, node, raw->node_no[i]);
    for (int c = 0; at != NULL && c < msh->dim; ++c) {
      const double there = scale * raw->xyz[3 * i + c],
                   here = msh->x[msh->dim * at->id + c];
      if (fabs(there - here) > SAME_PLACE * msh->size)
        RAISE(ERR_DECK,
              "%s has another mesh: node %zu is at %c = %.9g there and %.9g "
              "here",
              path, at->no, "xyz"[c], there, here);
    }
  }
  return OK;
}

static status to_mesh(const char *path, const pairs *p, const mesh *msh,
                      double scale, double *value) {
  OWNED_NEW(numbered, node, msh->n_node);
  OWNED_NEW(unsigned char, known, msh->n_node);
  for (int i = 0; i < msh->n_node; ++i)
    node[i] = (numbered){msh->node_no[i], i};
  qsort(node, msh->n_node, sizeof *node, compare_no);
  if (p->has_nodes) PASS(check_places(path, msh, scale, node));
  for (long i = 0; i < p->n; ++i) {
    const numbered *at = find_node(msh, node, p->node_no[i]);
    if (at == NULL) continue;
    if (!isfinite(p->value[i]))
      RAISE(ERR_DECK, "%s: the value of node %ld is not a finite number", path,
            p->node_no[i]);
    if (known[at->id])
      RAISE(ERR_DECK, "%s: node %ld is listed twice", path, p->node_no[i]);
    value[at->id] = p->value[i];
    known[at->id] = 1;
  }
  for (int i = 0; i < msh->n_node; ++i) {
    const int from = msh->origin == NULL ? i : msh->origin[i];
    if (!known[from])
      RAISE(ERR_DECK, "%s: node %zu of the mesh has no value", path,
            msh->node_no[from]);
    if (!known[i]) value[i] = value[from];
  }
  return OK;
}

/* 1 if the file has the first bytes of one of HDF5. */
static status find_kind(const char *path, int *is_hdf5) {
  static const char signature[8] = "\211HDF\r\n\032\n";
  char first[8];
  const char *why;
  FILE *f = input_stream(path, &why);
  if (f == NULL) RAISE(ERR_FILE, "%s: cannot be read: %s", path, why);
  *is_hdf5 = fread(first, 1, 8, f) == 8 && memcmp(first, signature, 8) == 0;
  fclose(f);
  return OK;
}

status check_start_file(const model *m) {
  const start_card *from = &m->initial.start;
  int is_hdf5;
  if (from->file == NULL) return OK;
  const status st = find_kind(from->file, &is_hdf5);
  if (st == ERR_FILE)
    message_add(m->log, P5003, &from->file_at, "%s", status_message());
  return st;
}

status nodal_field_read(const char *path, const mesh *msh, double scale,
                        double **value) {
  ENDS_BY(pairs_free) pairs p = {0};
  ENDS_BY(scan_close) scan s = {0};
  int is_hdf5 = 0;
  PASS(find_kind(path, &is_hdf5));
  if (is_hdf5) {
    PASS(read_hdf5(path, FEW + (1L + FOREIGN) * msh->n_node, &p));
  } else {
    PASS(scan_open(&s, path, ERR_DECK));
    PASS(read_gmsh(&s, &p));
  }
  PASS_NEW(*value, msh->n_node);
  return to_mesh(path, &p, msh, scale, *value);
}
