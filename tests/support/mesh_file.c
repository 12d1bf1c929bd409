#include "support/mesh_file.h"

#include "base/base.h"
#include "support/folder.h"

static void must(int held, const char *what) {
  if (held) return;
  fprintf(stderr, "test: %s failed\n", what);
  abort();
}

mesh_file mesh_file_open(void) {
  mesh_file f = {.answer = OK};
  folder_new(f.folder);
  return f;
}

void mesh_file_close(mesh_file *f) { folder_remove(f->folder); }

const char *mesh_file_path(const mesh_file *f, const char *name) {
  static char path[192];
  snprintf(path, sizeof path, "%s/%s", f->folder, name);
  return path;
}

void mesh_file_write(const mesh_file *f, const char *name, const void *data,
                     size_t size) {
  FILE *out = fopen(mesh_file_path(f, name), "wb");
  must(out != NULL, "open");
  must(fwrite(data, 1, size, out) == size && fclose(out) == 0, "write");
}

mesh *mesh_file_read(mesh_file *f, const char *name, double scale, int n_number,
                     const mesh_number *numbers) {
  const mesh_source source = {.file = mesh_file_path(f, name),
                              .scale = scale,
                              .n_number = n_number,
                              .numbers = numbers};
  return mesh_file_from(f, &source);
}

mesh *mesh_file_from(mesh_file *f, const mesh_source *source) {
  message_log *log;
  mesh *m = NULL;
  const place at = {.file = "job.inp", .line_no = 4, .column_no = 1};
  memset(f->messages, 0, sizeof f->messages);
  must(message_log_new(&log) == OK, "log");
  f->answer = mesh_read_gmsh(source, &at, log, &m);
  f->n_error = message_count(log, ERROR);
  FILE *out = fmemopen(f->messages, sizeof f->messages - 1, "w");
  must(out != NULL, "text");
  message_print(log, out);
  fclose(out);
  memory_free(log);
  return m;
}

mesh *mesh_file_text(mesh_file *f, const char *name, const char *text) {
  mesh_file_write(f, name, text, strlen(text));
  return mesh_file_read(f, name, 1.0, 0, NULL);
}

static int same_group(const mesh_group *a, const mesh_group *b) {
  size_t item = (size_t)a->n_item * sizeof(int);
  size_t node = (size_t)a->n_node * sizeof(int);
  return strcmp(a->name, b->name) == 0 && a->dim == b->dim &&
         a->tag == b->tag && a->n_item == b->n_item && a->n_node == b->n_node &&
         (item == 0 || memcmp(a->item_id, b->item_id, item) == 0) &&
         (node == 0 || memcmp(a->node_id, b->node_id, node) == 0);
}

int mesh_same(const mesh *a, const mesh *b, double digits, const char **what) {
  size_t dim = (size_t)a->dim, n = (size_t)a->n_node, e = (size_t)a->n_elem,
         f = (size_t)a->n_face;
#define CHECK_SAME(condition)   \
  do {                          \
    *what = #condition;         \
    if (!(condition)) return 0; \
  } while (0)
  CHECK_SAME(a->dim == b->dim && a->n_node == b->n_node);
  CHECK_SAME(a->n_elem == b->n_elem && a->n_face == b->n_face);
  CHECK_SAME(a->n_group == b->n_group);
  CHECK_SAME(fabs(a->size - b->size) <= digits * a->size);
  for (size_t i = 0; i < dim * n; ++i)
    CHECK_SAME(fabs(a->x[i] - b->x[i]) <= digits * a->size);
  CHECK_SAME(memcmp(a->node_no, b->node_no, n * sizeof *a->node_no) == 0);
  CHECK_SAME(memcmp(a->elem, b->elem, (dim + 1) * e * sizeof(int)) == 0);
  CHECK_SAME(memcmp(a->face, b->face, dim * f * sizeof(int)) == 0);
  CHECK_SAME(memcmp(a->face_elem, b->face_elem, f * sizeof(int)) == 0);
  CHECK_SAME(memcmp(a->face_other, b->face_other, f * sizeof(int)) == 0);
  for (int i = 0; i < a->n_group; ++i)
    CHECK_SAME(same_group(&a->group[i], &b->group[i]));
  return 1;
}
