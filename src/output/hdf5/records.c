/*
 * The records of a group of JOB.h5. HDF5 makes the first dataset; the others
 * have the same header but for their name and the address of their data, and
 * are written here: HDF5 takes 20 us for each, 50 s for 25 fields of 1e5
 * records. Old format of groups (HDF5 File Format Specification 3.0, II.A
 * superblock, III.A B-trees, III.B symbol table nodes, III.D local heaps, IV.A
 * object headers), which every version of HDF5 reads:
 *   heap      the names
 *   node      symbols (name, header of the dataset) in the order of strcmp
 *   tree      over the nodes; its root and the head of the heap are where HDF5
 *             has made them
 */
#include "output/hdf5/file.h"

#include <errno.h>
#include <fcntl.h>
#include <unistd.h>

enum {
  EOF_PLACE = 40,     /* in the superblock: address behind the last byte */
  K_PLACE = 16,       /* half the symbols of a node, half the children of one of
                         the tree; 2 bytes each */
  SUPERBLOCK = 48,    /* bytes of it that are read */
  HEADER_MOST = 4096, /* bytes of a header */
  LAYOUT = 0x08,      /* kinds of messages in a header */
  CONTINUED = 0x10,
  SYMBOL_TABLE = 0x11,
  NAME = 16, /* bytes of a name in the heap */
  SYMBOL = 40,
  NODE_HEAD = 8,
  TREE_HEAD = 24,
  HEAP_HEAD = 32
};
static const uint64_t NOWHERE = UINT64_MAX, NO_FREE_BLOCK = 1;

typedef struct stream { /* bytes written one after the other */
  int fd;
  const char *path;
  uint64_t at; /* address of part[0] */
  size_t used;
  unsigned char part[1 << 16];
} stream;

typedef struct places {   /* where the parts of a group stand */
  int n;                  /* records */
  const int *order;       /* [n] records in the order of their names */
  int per_node, per_tree; /* symbols, children */
  uint64_t heap, header, node, tree, end;
  size_t header_size;
} places;

static uint64_t number(const unsigned char *at, int bytes) {
  uint64_t v = 0;
  for (int i = bytes; i-- > 0;) v = v << 8 | at[i];
  return v;
}

static void set_number(unsigned char *at, int bytes, uint64_t v) {
  for (int i = 0; i < bytes; ++i) at[i] = (unsigned char)(v >> 8 * i);
}

static status other_format(const char *path) {
  return status_fail(ERR_FILE, __func__, __LINE__,
                     "%s: this version of HDF5 makes another format of groups",
                     path);
}

static status get(const stream *s, uint64_t at, void *to, size_t n) {
  errno = 0;
  if (pread(s->fd, to, n, (off_t)at) == (ssize_t)n) return OK;
  return text_failed(s->path, "read back", errno);
}

static status flush(stream *s) {
  PASS(hdf5_put(s->fd, s->path, s->part, s->used, (off_t)s->at));
  s->at += s->used;
  s->used = 0;
  return OK;
}

static status emit(stream *s, const void *data, size_t n) {
  if (s->used + n > sizeof s->part) PASS(flush(s));
  memcpy(s->part + s->used, data, n);
  s->used += n;
  return OK;
}

static status emit_number(stream *s, int bytes, uint64_t v) {
  unsigned char text[8];
  set_number(text, bytes, v);
  return emit(s, text, bytes);
}

static status go_to(stream *s, uint64_t at) {
  status st = flush(s);
  s->at = at;
  return st;
}

status hdf5_put(int fd, const char *path, const void *data, size_t bytes,
                off_t offset) {
  const char *at = data;
  while (bytes > 0) {
    errno = 0;
    ssize_t n = pwrite(fd, at, bytes, offset);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return text_failed(path, "write", n < 0 ? errno : ENOSPC);
    at += n;
    offset += n;
    bytes -= n;
  }
  return OK;
}

/* ---- headers ------------------------------------------------------------- */

/* Place of the message of that kind among those in chunk[n], or 0. */
static size_t find_message(const unsigned char *chunk, size_t from, size_t n,
                           unsigned kind) {
  for (size_t i = from; i + 8 <= n;) {
    size_t length = number(chunk + i + 2, 2);
    if (number(chunk + i, 2) == kind && i + 8 + length <= n) return i + 8;
    i += 8 + length;
  }
  return 0;
}

/* The header of an object and its length. */
static status get_header(const stream *s, uint64_t at,
                         unsigned char header[HEADER_MOST], size_t *n) {
  PASS(get(s, at, header, 16));
  *n = 16 + number(header + 8, 4);
  if (header[0] != 1 || *n > HEADER_MOST) PASS(other_format(s->path));
  return get(s, at, header, *n);
}

/* Root of the tree and head of the heap of a group. */
static status find_tables(const stream *s, uint64_t group, uint64_t *tree,
                          uint64_t *heap) {
  unsigned char header[HEADER_MOST];
  size_t n, more, from = 16, at;
  PASS(get_header(s, group, header, &n));
  while ((at = find_message(header, from, n, SYMBOL_TABLE)) == 0) {
    more = find_message(header, from, n, CONTINUED);
    if (more == 0) PASS(other_format(s->path));
    uint64_t next = number(header + more, 8);
    n = number(header + more + 8, 8);
    if (n > HEADER_MOST) PASS(other_format(s->path));
    PASS(get(s, next, header, n));
    from = 0;
  }
  *tree = number(header + at, 8);
  *heap = number(header + at + 8, 8);
  return OK;
}

static status emit_headers(stream *s, const places *p, uint64_t set,
                           const record_group *g) {
  unsigned char header[HEADER_MOST];
  size_t n;
  PASS(get_header(s, set, header, &n));
  size_t at = find_message(header, 16, n, LAYOUT);
  if (at == 0 || number(header + at + 2, 8) != (uint64_t)g->offset[0])
    PASS(other_format(s->path));
  for (int i = 1; i < p->n; ++i) {
    set_number(header + at + 2, 8, (uint64_t)g->offset[i]);
    PASS(emit(s, header, n));
  }
  return OK;
}

/* ---- names, nodes and tree ----------------------------------------------- */

static uint64_t name_place(int record_id) {
  return 8 + NAME * (uint64_t)record_id;
}

static status emit_names(stream *s, const places *p) {
  PASS(emit_number(s, 8, 0)); /* the empty name */
  for (int i = 0; i < p->n; ++i) {
    char name[NAME] = "";
    hdf5_record_name(name, sizeof name, i);
    PASS(emit(s, name, sizeof name));
  }
  return OK;
}

static status emit_nodes(stream *s, const places *p, uint64_t set) {
  static const unsigned char none[SYMBOL];
  for (int i = 0; i < p->n; i += p->per_node) {
    int n = p->n - i < p->per_node ? p->n - i : p->per_node;
    PASS(emit(s, "SNOD\1", 6));
    PASS(emit_number(s, 2, (uint64_t)n));
    for (int k = 0; k < p->per_node; ++k) {
      int id = k < n ? p->order[i + k] : 0;
      uint64_t header =
          id == 0 ? set : p->header + p->header_size * (uint64_t)(id - 1);
      PASS(emit_number(s, 8, k < n ? name_place(id) : 0));
      PASS(emit_number(s, 8, k < n ? header : 0));
      PASS(emit(s, none, SYMBOL - 16));
    }
  }
  return OK;
}

static size_t node_size(const places *p) {
  return NODE_HEAD + SYMBOL * (size_t)p->per_node;
}

static size_t tree_size(const places *p) {
  return TREE_HEAD + 16 * (size_t)p->per_tree + 8;
}

/* Key: the last name below a child, here those below names ]0, end]. */
static uint64_t key(const places *p, int64_t end) {
  if (end == 0) return 0;
  return name_place(p->order[(end < p->n ? end : p->n) - 1]);
}

static int parts(int n, int size) { return (n + size - 1) / size; }

typedef struct tree_level {
  int level, n, n_child;
  uint64_t at, child; /* the first node, the first child */
  size_t child_size;
  int64_t span; /* names below a child */
} tree_level;

/* Node i of a level. */
static status emit_tree(stream *s, const places *p, const tree_level *l,
                        int i) {
  int first = i * p->per_tree, end = first + p->per_tree;
  uint64_t self = l->at + tree_size(p) * (uint64_t)i;
  if (end > l->n_child) end = l->n_child;
  PASS(emit(s, "TREE", 5));
  PASS(emit_number(s, 1, (uint64_t)l->level));
  PASS(emit_number(s, 2, (uint64_t)(end - first)));
  PASS(emit_number(s, 8, i > 0 ? self - tree_size(p) : NOWHERE));
  PASS(emit_number(s, 8, i + 1 < l->n ? self + tree_size(p) : NOWHERE));
  for (int k = first; k <= first + p->per_tree; ++k) {
    PASS(emit_number(s, 8, k <= end ? key(p, k * l->span) : 0));
    if (k == first + p->per_tree) break;
    PASS(emit_number(s, 8,
                     k < end ? l->child + l->child_size * (uint64_t)k : 0));
  }
  return OK;
}

/* Level after level, at last the root. */
static status emit_levels(stream *s, const places *p, uint64_t root) {
  tree_level l = {.n = parts(p->n, p->per_node),
                  .at = p->node,
                  .child_size = node_size(p),
                  .span = p->per_node};
  uint64_t next = p->tree;
  do {
    l.n_child = l.n;
    l.n = parts(l.n_child, p->per_tree);
    l.child = l.at;
    l.at = l.n > 1 ? next : root;
    PASS(go_to(s, l.at));
    for (int i = 0; i < l.n; ++i) PASS(emit_tree(s, p, &l, i));
    next += tree_size(p) * (uint64_t)l.n;
    l.child_size = tree_size(p);
    l.span *= p->per_tree;
    ++l.level;
  } while (l.n > 1);
  return OK;
}

/* ---- a group ------------------------------------------------------------- */

static status fill_group(stream *s, places *p, const record_group *g) {
  unsigned char header[HEADER_MOST];
  uint64_t tree, heap;
  PASS(find_tables(s, g->group, &tree, &heap));
  PASS(get_header(s, g->set, header, &p->header_size));
  PASS(get(s, heap, header, HEAP_HEAD));
  if (memcmp(header, "HEAP", 5) != 0) PASS(other_format(s->path));
  p->heap = p->end;
  p->header = p->heap + name_place(p->n);
  p->node = p->header + p->header_size * (uint64_t)(p->n - 1);
  int n = parts(p->n, p->per_node);
  p->tree = p->node + node_size(p) * (uint64_t)n;
  p->end = p->tree;
  while ((n = parts(n, p->per_tree)) > 1) p->end += tree_size(p) * (uint64_t)n;
  PASS(go_to(s, p->heap));
  PASS(emit_names(s, p));
  PASS(emit_headers(s, p, g->set, g));
  PASS(emit_nodes(s, p, g->set));
  PASS(emit_levels(s, p, tree));
  PASS(go_to(s, heap + 8));
  PASS(emit_number(s, 8, p->header - p->heap));
  PASS(emit_number(s, 8, NO_FREE_BLOCK));
  PASS(emit_number(s, 8, p->heap));
  return flush(s);
}

/* Records no. 1 to n by name: 10000, 100000, 100001, ..., 10001, 100010, ... */
static void order_names(int n, int no, int *order, int *used) {
  order[(*used)++] = no - 1;
  for (int64_t k = 10 * (int64_t)no; no >= 10000 && k < 10 * (int64_t)no + 10;
       ++k)
    if (k <= n) order_names(n, (int)k, order, used);
}

/* What HDF5 has made; then the records 2 to n. */
static status make_records(stream *s, int n, const int *order, int n_group,
                           const record_group *groups) {
  unsigned char head[SUPERBLOCK];
  PASS(get(s, 0, head, sizeof head));
  if (memcmp(head, "\211HDF\r\n\032\n", 9) != 0 || head[13] != 8)
    return other_format(s->path);
  places p = {.n = n,
              .order = order,
              .per_node = 2 * (int)number(head + K_PLACE, 2),
              .per_tree = 2 * (int)number(head + K_PLACE + 2, 2),
              .end = (number(head + EOF_PLACE, 8) + 7) / 8 * 8};
  /* What is written at one time stands together: record after record. */
  for (int i = 1; i < p.n; ++i)
    for (int k = 0; k < n_group; ++k) {
      if (groups[k].set == 0) continue;
      groups[k].offset[i] = (off_t)p.end;
      p.end += groups[k].bytes;
    }
  for (int i = 0; i < n_group; ++i)
    if (groups[i].set != 0) PASS(fill_group(s, &p, &groups[i]));
  PASS(go_to(s, EOF_PLACE));
  PASS(emit_number(s, 8, p.end));
  PASS(flush(s));
  if (ftruncate(s->fd, (off_t)p.end) != 0)
    return text_failed(s->path, "write", errno);
  return OK;
}

status hdf5_records_make(const char *path, int n, int n_group,
                         const record_group *groups) {
  int used = 0;
  OWNED_NEW(int, order, n);
  OWNED_NEW(stream, s, 1);
  for (int no = 1; no <= n && no < 100000; ++no)
    order_names(n, no, order, &used);
  s->path = path;
  s->fd = open(path, O_RDWR | O_CLOEXEC);
  if (s->fd < 0) return text_failed(path, "open", errno);
  status st = make_records(s, n, order, n_group, groups);
  close(s->fd);
  return st;
}
