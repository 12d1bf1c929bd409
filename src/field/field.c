/*
 * Nodal fields: $NodeData of gmsh, or two datasets of HDF5.
 */
#include "field/field.h"

#include "base/memory.h"
#include "exchange/dataset.h"
#include "system/input.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Values beyond those of the mesh that a file may have: FOREIGN a node, and
 * FEW. */
enum { LINE = 512, MOST_TAGS = 64, FOREIGN = 8, FEW = 100000 };

typedef struct pairs { /* as the file has them                                */
  long n;
  long *node_no;
  double *value;
} pairs;

typedef struct reader {
  FILE *f;
  const char *path;
  int binary;
  long most; /* values                                                       */
} reader;

static int next_line(reader *r, char line[LINE]) {
  return fgets(line, LINE, r->f) != NULL;
}

/* An integer that stands on a line of its own. */
static status line_int(reader *r, int least, int most, int *value) {
  status st = OK;
  char line[LINE];
  if (!next_line(r, line) || sscanf(line, "%d", value) != 1 || *value < least ||
      *value > most)
    FAIL(ERR_DECK, "%s: $NodeData is cut short or damaged", r->path);
done:
  return st;
}

/* The tags before the values: *n of them, of one component. */
static status read_tags(reader *r, int *n) {
  status st = OK;
  char line[LINE];
  int count, component = 0;
  for (int kind = 0; kind < 2; ++kind) { /* names, then times                 */
    TRY(line_int(r, 0, MOST_TAGS, &count));
    for (int i = 0; i < count; ++i)
      if (!next_line(r, line))
        FAIL(ERR_DECK, "%s: $NodeData is cut short", r->path);
  }
  TRY(line_int(r, 3, MOST_TAGS, &count));
  for (int i = 0; i < count; ++i) {
    int tag;
    TRY(line_int(r, INT32_MIN, INT32_MAX, &tag));
    if (i == 1) component = tag;
    if (i == 2) *n = tag;
  }
  if (component != 1 || *n < 0)
    FAIL(ERR_DECK, "%s: $NodeData has %d components, one is needed", r->path,
         component);
  if (*n > r->most)
    FAIL(ERR_DECK, "%s: $NodeData has %d values, expected at most %ld", r->path,
         *n, r->most);
done:
  return st;
}

static int read_pair(reader *r, long *node_no, double *value) {
  int32_t number;
  if (!r->binary) return fscanf(r->f, "%ld %lf", node_no, value) == 2;
  if (fread(&number, sizeof number, 1, r->f) != 1) return 0;
  *node_no = number;
  return fread(value, sizeof *value, 1, r->f) == 1;
}

static void pairs_free(pairs *p) {
  memory_free(p->node_no);
  memory_free(p->value);
  *p = (pairs){0};
}

static status read_node_data(reader *r, pairs *p) {
  status st = OK;
  int n = 0;
  pairs_free(p);
  TRY(read_tags(r, &n));
  NEW(p->node_no, n);
  NEW(p->value, n);
  for (p->n = 0; p->n < n; ++p->n)
    if (!read_pair(r, &p->node_no[p->n], &p->value[p->n]))
      FAIL(ERR_DECK, "%s: $NodeData ends after %ld of %d values", r->path, p->n,
           n);
done:
  return st;
}

static status read_gmsh(reader *r, pairs *p) {
  status st = OK;
  char line[LINE];
  int found = 0, binary;
  while (next_line(r, line)) {
    if (strncmp(line, "$MeshFormat", 11) == 0 && next_line(r, line) &&
        sscanf(line, "%*f %d", &binary) == 1)
      r->binary = binary == 1;
    if (strncmp(line, "$NodeData", 9) != 0) continue;
    TRY(read_node_data(r, p));
    found = 1;
  }
  if (!found)
    FAIL(ERR_DECK, "%s: there is no $NodeData, and it is not HDF5", r->path);
done:
  return st;
}

static status read_hdf5(const char *path, long most, pairs *p) {
  status st = OK;
  hdf5_source s;
  int *number = NULL;
  long n_value = 0;
  TRY(dataset_open(path, &s));
  TRY(source_ints(&s, "/node_no", 0, most, &p->n, &number));
  TRY(source_reals(&s, "/temperature", 0, most, &n_value, &p->value));
  if (n_value != p->n)
    FAIL(ERR_DECK, "%s: /node_no has %ld items, /temperature %ld", path, p->n,
         n_value);
  NEW(p->node_no, p->n);
  for (long i = 0; i < p->n; ++i) p->node_no[i] = number[i];
done:
  memory_free(number);
  dataset_close(&s);
  return st;
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

static status to_mesh(const char *path, const pairs *p, const mesh *msh,
                      double *value) {
  status st = OK;
  numbered *node = NULL;
  unsigned char *known = NULL;
  NEW(node, msh->n_node);
  NEW(known, msh->n_node);
  for (int i = 0; i < msh->n_node; ++i)
    node[i] = (numbered){msh->node_no[i], i};
  qsort(node, (size_t)msh->n_node, sizeof *node, compare_no);
  for (long i = 0; i < p->n; ++i) {
    const numbered key = {(size_t)p->node_no[i], 0};
    const numbered *at =
        bsearch(&key, node, (size_t)msh->n_node, sizeof key, compare_no);
    if (at == NULL) continue;
    if (!isfinite(p->value[i]))
      FAIL(ERR_DECK, "%s: the value of node %ld is not a finite number", path,
           p->node_no[i]);
    value[at->id] = p->value[i];
    known[at->id] = 1;
  }
  for (int i = 0; i < msh->n_node; ++i)
    if (!known[i])
      FAIL(ERR_DECK, "%s: node %zu of the mesh has no value", path,
           msh->node_no[i]);
done:
  memory_free(node);
  memory_free(known);
  return st;
}

status nodal_field_read(const char *path, const mesh *msh, double **value) {
  status st = OK;
  static const char signature[8] = "\211HDF\r\n\032\n";
  char first[8] = "";
  pairs p = {0};
  const char *why = NULL;
  reader r = {.path = path, .most = FEW + (1L + FOREIGN) * msh->n_node};
  *value = NULL;
  r.f = input_stream(path, &why);
  if (r.f == NULL) FAIL(ERR_FILE, "%s: cannot be read: %s", path, why);
  int hdf5 = fread(first, 1, 8, r.f) == 8 && memcmp(first, signature, 8) == 0;
  rewind(r.f);
  if (hdf5)
    TRY(read_hdf5(path, r.most, &p));
  else
    TRY(read_gmsh(&r, &p));
  NEW(*value, msh->n_node);
  TRY(to_mesh(path, &p, msh, *value));
done:
  if (r.f != NULL) fclose(r.f);
  pairs_free(&p);
  if (st != OK) {
    memory_free(*value);
    *value = NULL;
  }
  return st;
}
