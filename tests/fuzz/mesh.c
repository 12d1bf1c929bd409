/*
 * libFuzzer: a .msh if the first byte is "$", else records from the process
 * that meshes a .geo, with any heads; then the mesh of it: it is refused with
 * an error or made, and what was made is inside its own bounds. Of records the
 * first byte tells whether the rest are the bytes of the pipe or choices. The
 * memory of a .msh is bounded by its size.
 */
#include "base/memory.h"
#include "mesh/raw.h"
#include "support/fuzz.h"
#include "support/fuzz_file.h"

#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { ROOM = 1 << 16, MOST = 40, TIMES = 100 };

typedef struct stream {
  uint8_t data[ROOM];
  size_t n;
} stream;

static void put(stream *s, const void *data, size_t n) {
  if (n > ROOM - s->n) n = ROOM - s->n;
  memcpy(s->data + s->n, data, n);
  s->n += n;
}

/* An item of a record as the kind wants it, or another. */
static void put_item(stream *s, fuzz_bytes *b, uint32_t kind) {
  int whole = fuzz_int(b);
  size_t no = (size_t)(long)whole;
  double x;
  char c;
  switch (kind) {
    case WIRE_CENSUS:
    case WIRE_PHYSICAL:
      put(s, &whole, sizeof whole);
      break;
    case WIRE_NODE_X:
      x = fuzz_real(b);
      put(s, &x, sizeof x);
      break;
    case WIRE_GROUP:
    case WIRE_BLOCK:
    case WIRE_WARNING:
    case WIRE_FAILURE:
    case WIRE_END:
      c = (char)('A' + whole % 26);
      put(s, &c, 1);
      break;
    default:
      put(s, &no, sizeof no);
  }
}

static void put_records(stream *s, fuzz_bytes *b) {
  while (b->left > 0 && s->n < ROOM) {
    wire_head head = {WIRE_MAGIC, (uint32_t)fuzz_below(b, WIRE_COUNT),
                      fuzz_below(b, 5), fuzz_int(b),
                      (uint64_t)fuzz_below(b, MOST)};
    put(s, &head, sizeof head);
    for (uint64_t k = 0; k < head.n; ++k) put_item(s, b, head.kind);
  }
}

static void use_mesh(const mesh *m) {
  if (m->dim < 2 || m->dim > 3 || m->n_node <= 0 || m->n_elem <= 0) abort();
  for (int k = 0; k < m->n_elem * (m->dim + 1); ++k)
    if (m->elem[k] < 0 || m->elem[k] >= m->n_node) abort();
}

/* Bytes of the pipe, or choices of records, to a raw mesh. */
static status receive(fuzz_bytes *b, raw_mesh **out) {
  static stream s;
  int stopped;
  s.n = 0;
  if (fuzz_byte(b) % 4 == 0)
    put(&s, b->at, b->left);
  else
    put_records(&s, b);
  int fd = open(fuzz_file("pipe", s.data, s.n), O_RDONLY);
  raw_mesh *raw = memory_new(1, sizeof *raw);
  if (raw == NULL) abort();
  status st = raw_receive(fd, raw, &stopped);
  close(fd);
  *out = raw;
  return st;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  fuzz_bytes b = {data, size};
  raw_mesh *raw = NULL;
  mesh *m = NULL;
  message_log *log;
  if (message_log_new(&log) != OK) abort();
  int is_msh = size > 0 && data[0] == '$';
  memory_limit(is_msh ? ROOM + TIMES * size : SIZE_MAX, "the size");
  status st =
      is_msh ? msh_read(fuzz_file("msh", data, size), &raw) : receive(&b, &raw);
  if (st == OK) st = build_mesh(raw, 1.0, &(place){.file = "m"}, log, &m);
  if (is_msh && st == ERR_MEMORY) abort();
  if ((st == OK) != (m != NULL)) abort();
  if (m != NULL) use_mesh(m);
  memory_free(m);
  memory_free(raw);
  memory_free(log);
  status_clear();
  if (memory_in_use() != 0) abort();
  return 0;
}
